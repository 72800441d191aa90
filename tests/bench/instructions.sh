#!/usr/bin/env bash
# Counts the instructions of each kernel, in its AVX2 and in its portable form, under callgrind and compares them with
# those kept in instructions.txt:
#
#     tests/bench/instructions.sh            compares; ends with 1 where a kernel needs 2 % more than before
#     tests/bench/instructions.sh --keep     keeps the new counts
#
# Counts do not depend on the machine's load, but on the compiler: instructions.txt names the one it was made with, and
# under another one the counts are shown but not judged. valgrind knows no AVX-512. Needs valgrind (Debian: apt-get
# install valgrind) and a processor with AVX2.
set -euo pipefail
cd "$(dirname "$0")/../.."

kept=tests/bench/instructions.txt
if ! command -v valgrind > /dev/null; then
    echo "valgrind is missing: install it (Debian: apt-get install valgrind) and try again" >&2
    exit 2
fi
cargo bench --bench kernels --no-run
program=$(cargo bench --bench kernels --no-run 2>&1 | sed -n 's/.*Executable .*(\(.*\))/\1/p')

count() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$program" "$@" 2>&1 | sed -n 's/.*Collected : *//p'
}

new=$(mktemp)
trap 'rm -f "$new"' EXIT
{
    echo "# $(rustc --version); instructions beyond the program's start"
    for form in avx2 portable; do
        start=$(count start "$form")
        for kernel in $("$program" | grep -v start); do
            echo "$kernel/$form $(($(count "$kernel" "$form") - start))"
        done
    done
} > "$new"
if [ "${1:-}" = --keep ]; then
    cp "$new" "$kept"
    cat "$kept"
    exit
fi
# 2 %: what allocation and hashing of addresses may change from run to run is far below, a lost optimization far above.
awk '
    /^#/ { if (NR == FNR) compiler = $0; else if ($0 != compiler) { other = 1; print "kept with", compiler }; next }
    NR == FNR { before[$1] = $2; next }
    !($1 in before) { printf "%-20s %14s %14.0f  new: --keep it\n", $1, "", $2; worse++; next }
    {
        change = 100 * ($2 / before[$1] - 1)
        slower = (change > 2)
        printf "%-20s %14.0f %14.0f %+8.2f %%%s\n", $1, before[$1], $2, change, slower ? "  slower" : ""
        worse += slower
    }
    END {
        if (other) print "another compiler than kept: not judged"
        exit worse > 0 && !other
    }
' "$kept" "$new"
