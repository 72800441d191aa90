#!/usr/bin/env bash
# A map as a job array on a real Slurm (Debian's slurmctld, slurmd and munge, started here for as long as it takes): a task is
# killed, its number is submitted again, and the parts merge to the bytes of a single run. As root, outside CI; what it printed
# is kept in data/published/slurm.txt:
#
#     apt-get install slurmctld slurmd slurm-client munge && tests/slurm.sh target/release/kickdrift
set -euo pipefail
program=$(realpath "$1")
scratch=$(mktemp -d)
chmod 755 "$scratch"
export SLURM_CONF=$scratch/slurm.conf PATH=$PATH:/usr/sbin
started=()
trap 'kill "${started[@]}" 2> /dev/null; wait; rm -rf "$scratch"' EXIT

host=$(hostname -s)
cpus=$(nproc)
mkdir "$scratch"/{state,spool,work}
cat > "$SLURM_CONF" << END
ClusterName=kickdrift
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=16817
SlurmdPort=16818
SlurmUser=root
AuthInfo=socket=$scratch/munge.socket
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobRequeue=0
ReturnToService=2
StateSaveLocation=$scratch/state
SlurmdSpoolDir=$scratch/spool
SlurmctldPidFile=$scratch/slurmctld.pid
SlurmdPidFile=$scratch/slurmd.pid
NodeName=$host NodeAddr=127.0.0.1 CPUs=$cpus
PartitionName=all Nodes=$host Default=YES
END
dd if=/dev/urandom of="$scratch/munge.key" bs=1 count=1024 status=none
chmod 400 "$scratch/munge.key"
munged --foreground --force --key-file="$scratch/munge.key" --socket="$scratch/munge.socket" \
    --pid-file="$scratch/munge.pid" --log-file="$scratch/munge.log" --seed-file="$scratch/munge.seed" &> "$scratch/munge.out" &
started+=($!)
until [ -S "$scratch/munge.socket" ]; do sleep 0.2; done
slurmctld -D &> "$scratch/slurmctld.log" &
started+=($!)
slurmd -D -N "$host" &> "$scratch/slurmd.log" &
started+=($!)

# Waits until a command succeeds, two minutes at most.
until_true() {
    for _ in $(seq 600); do
        if "$@" &> /dev/null; then return 0; fi
        sleep 0.2
    done
    echo "never: $*"
    tail "$scratch"/*.log
    return 1
}

is_up() { [ "$(sinfo -h -o %T)" = idle ]; }
has_bands() { [ "$(find part-3 -type f | wc -l)" -ge 2 ] && [ -s pid-3 ]; }
is_over() { [ -z "$(squeue -h -o %i)" ]; }
state() { scontrol show job "$1" | grep -o 'JobState=[A-Z]*'; }

cd "$scratch/work"
map=(map --lambda1 'pi^2' --lambda2 'pi^2/25' --step 1/1000 --h1-range '1/1000..2/pi' --h2-range '1/1000..7/2' --growth --quiet)
cat > job.sh << END
#!/bin/bash
#SBATCH --cpus-per-task=1
echo \$\$ > pid-\$SLURM_ARRAY_TASK_ID
exec "$program" ${map[*]@Q} --threads 1 --shard \$SLURM_ARRAY_TASK_ID/4 --resume part-\$SLURM_ARRAY_TASK_ID --output counts-\$SLURM_ARRAY_TASK_ID.json
END

slurmctld -V
until_true is_up
sinfo
job=$(sbatch --parsable --array=1-4 job.sh)
echo "job array $job: four parts of a map of 2.2 million pairs"
until_true has_bands
kill -KILL "$(cat pid-3)"
until_true is_over
for task in 1 2 3 4; do echo "task $task: $(state "${job}_$task")"; done
[ "$(state "${job}_3")" = JobState=FAILED ]
find part-3 -type f -name '*' -printf '%f %T@\n' | sort > before
if "$program" merge part-1 part-2 part-3 part-4 --quiet --output early.csv 2> refused; then exit 1; fi
echo "merged too early: $(cat refused)"

job=$(sbatch --parsable --array=3 job.sh)
until_true is_over
echo "task 3 again: $(state "${job}_3")"
find part-3 -type f -printf '%f %T@\n' | sort > after
echo "bands of part 3: $(wc -l < before) before it was killed, $(comm -12 before after | wc -l) of them untouched, $(wc -l < after) now"
"$program" merge part-1 part-2 part-3 part-4 --quiet --output merged.csv
"$program" "${map[@]}" --output single.csv
sha256sum merged.csv single.csv
cmp merged.csv single.csv
echo "the same bytes"
