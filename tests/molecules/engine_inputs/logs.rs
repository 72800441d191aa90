//! What engines write about a run, read: LAMMPS's log and screen, NAMD's log, GROMACS's log or `gmx dump`.

use kickdrift::advise::Constraints;
use kickdrift::number::rational::ratio;

use super::{of, steps};

/// A log: lines with names are followed by the same ones with values, conditions by what was done.
const LOG: &str = "LAMMPS (22 Jul 2025 - Update 4)
OMP_NUM_THREADS environment is not set. Defaulting to 1 thread.
units real
variable ts equal 2.0
bond_style harmonic
pair_style lj/cut 8
timestep ${ts}
timestep 2
if \"1 == 1\" then \"run_style respa 4 2 2 2 bond 1 pair 4\"
run_style respa 4 2 2 2 bond 1 pair 4
Respa levels:
  1 = bond angle dihedral improper
  2 =
  3 =
  4 = pair kspace
WARNING: One or more respa levels compute no forces (src/src/respa.cpp:239)
run 2
Loop time of 4.0696e-05 on 1 procs for 2 steps with 2 atoms
";

/// What LAMMPS shows where it does not echo commands.
const SCREEN: &str = "LAMMPS (22 Jul 2025 - Update 4)
Respa levels:
  1 = bond angle dihedral improper
  2 =
  3 = pair kspace
Setting up r-RESPA run ...
  Unit style    : metal
  Current step  : 0
  Time steps    : 1:0.00025 2:0.0005 3:0.002
  r-RESPA fixes : 2:spring/self[s]
";

/// NAMD's log, as SimParameters.C writes it.
const NAMD_LOG: &str = "Charm++> Running in non-SMP mode
Info: NAMD 3.0 for Linux-x86_64-multicore
Info: SIMULATION PARAMETERS:
Info: TIMESTEP               2
Info: NUMBER OF STEPS        500
Info: STEPS PER CYCLE        20
Info: PARTICLE MESH EWALD (PME) ACTIVE
Info: FULL ELECTROSTATIC EVALUATION FREQUENCY      4
Info: USING VERLET I (r-RESPA) MTS SCHEME.
Info: RIGID BONDS TO HYDROGEN : ALL
Info: NONBONDED FORCES EVALUATED EVERY 2 STEPS
";

/// The part of GROMACS's log, or of `gmx dump`, that says what grompp understood.
const GROMACS_LOG: &str = "                      :-) GROMACS - gmx mdrun, 2025.1 (-:

Input Parameters:
   integrator                     = md
   tinit                          = 0
   dt                             = 0.002
   nsteps                         = 5000
   mts                            = true
   mts-level2-forces              = longrange-nonbonded nonbonded
   mts-level2-factor              = 3
   mass-repartition-factor        = 1
   comm-mode                      = Linear
   nstlist                        = 30
   coulombtype                    = PME
grpopts:
   nrdf:          45
";

#[test]
fn logs_are_read_and_say_which_input_to_change() {
    for (text, expected, forces) in
        [(LOG, "0.25,2", 2), (SCREEN, "0.25,0.5,2", 3), (NAMD_LOG, "2,4,8", 3), (GROMACS_LOG, "2,6", 2)]
    {
        let reading = of(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!((steps(&reading).as_str(), reading.forces.len()), (expected, forces), "{text}");
        let outer = reading.scheme.last_but_one() * ratio(3, 1);
        let error = reading.changed_lines(&outer).unwrap_err();
        assert!(["change", "write"].iter().any(|word| error.remedy().contains(word)), "{error}");
    }
    assert_eq!(of(NAMD_LOG).unwrap().constraints, Some(Constraints::HBonds));
    let empty = &of(LOG).unwrap().remarks;
    assert!(empty.iter().any(|own| own.contains("no force is on level 2, 3")), "{empty:?}");
}
