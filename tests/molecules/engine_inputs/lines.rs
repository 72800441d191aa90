//! LAMMPS, GROMACS, NAMD: the steps are those that the engine itself takes, or the text is refused with the
//! reason. What LAMMPS takes was asked of LAMMPS (22 Jul 2025, the files in `lammps` run by it); what GROMACS
//! and NAMD take are the rules of their sources (`readir.cpp` and `multipletimestepping.cpp`,
//! `SimParameters.C`).

use std::time::Duration;

use kickdrift::advise::Constraints;
use kickdrift::advise::engine::Engine;
use kickdrift::number::rational::ratio;

use super::{of, steps, thread_time};

macro_rules! lammps {
    ($($name:literal $steps:literal $forces:literal,)*) => {
        [$(($name, include_str!(concat!("lammps/", $name, ".in")), $steps, $forces)),*]
    };
}

/// Inputs that LAMMPS runs, its steps in fs ("Time steps" as a run begins), and its forces on each level less
/// those that have no style.
const LAMMPS: [(&str, &str, &str, &str); 17] = lammps![
    "two_levels" "0.5,4" "bond, angle; pair",
    "default_levels" "0.5,2" "bond, angle; pair",
    "four_levels" "0.5,1,4" "bond; angle; pair",
    "empty_levels" "0.5,4" "bond, angle; pair",
    "pair_below_the_top" "1,2" "bond, angle; pair",
    "inner_outer" "0.5,1.5,3" "bond, angle; inner; outer",
    "hybrid" "0.5,2" "lj/cut, bond, angle; morse",
    "no_bonds" "2" "angle, pair",
    "metal_default" "1" "all forces",
    "electron_default" "0.001" "all forces",
    "nano" "2" "all forces",
    "variable" "0.5,2" "bond, angle; pair",
    "clear" "0.25,1" "bond, angle; pair",
    "two_runs" "0.5,2" "bond, angle; pair",
    "back_to_verlet" "1.5" "all forces",
    "given_twice" "0.5,2" "bond, angle; pair",
    "fix_on_a_level" "1,2,4" "bond, angle; fix s; pair",
];

#[test]
fn the_steps_of_lammps_are_those_that_lammps_shows() {
    for (name, text, expected, forces) in LAMMPS {
        let reading = of(text).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!((reading.engine, steps(&reading).as_str()), (Engine::Lammps, expected), "{name}");
        let all = |own: &str| own.split(", ").map(String::from).collect::<std::collections::BTreeSet<_>>();
        let own: Vec<_> = reading.forces.iter().map(|own| all(own)).collect();
        assert_eq!(own, forces.split("; ").map(all).collect::<Vec<_>>(), "{name}");
    }
}

/// grompp's rules: `dt` in ps is the inner step, 0.001 by default; two levels, factor 2 by default.
const GROMACS: [(&str, &str); 12] = [
    ("integrator = md\nnsteps = 10\ndt = 0.002\n", "2"),
    ("integrator = md-vv\nnsteps = 10\n", "1"),
    ("Integrator = SD\ndt = .0005 ; ps\ntau_t = 1\ntc-grps = System\n", "0.5"),
    ("dt = 0.002\nmts = yes\ncoulombtype = PME\n", "2,4"),
    ("dt = 0.002\nmts = yes\nmts_level2_factor = 3\ncoulombtype = PME\n", "2,6"),
    ("dt = 0.002\nMTS = no\nmts-level2-factor = 3\nnstlist = 10\n", "2"),
    (
        "dt = 0.001\nmts = yes\nmts-levels = 2\nmts-level2-factor = 4\nmts-level2-forces = longrange-nonbonded pair dihedral\nrcoulomb = 1\n",
        "1,4",
    ),
    // As grompp's mdout.mdp has it: every key, some without a value.
    (
        "; VARIOUS PREPROCESSING OPTIONS\ninclude = \ndefine = \n; RUN CONTROL PARAMETERS\nintegrator = md\ntinit = 0\ndt = 0.002\nnsteps = 100\nmts = no\nmass-repartition-factor = 1\nnstlist = 20\ntc-grps = \n",
        "2",
    ),
    ("title = a run\nintegrator=md\ndt=2.0e-3\ncutoff-scheme = Verlet\n", "2"),
    (
        "pull = yes\npull-ncoords = 1\npull-coord1-k = 100\ndt = 0.004\nconstraints = h-bonds\ntcoupl = no\n",
        "4",
    ),
    ("dt = 0.001\ndt = 0.002\nnstxout = 100\n", "2"),
    ("integrator = bd\nbd-fric = 100\ndt = +0.01\n", "10"),
];

/// NAMD's rules: `timestep` in fs is the inner step, 1 by default; no full electrostatics without a method
/// for them.
const NAMD: [(&str, &str); 15] = [
    ("structure a.psf\ncoordinates a.pdb\ntimestep 2.0\noutputEnergies 100\n", "2"),
    ("structure a.psf\ncutoff 12.0\noutputname b\n", "1"),
    ("structure a.psf\nPME yes\ntimestep 2.0\nfullElectFrequency 2\nstepspercycle 20\n", "2,4"),
    ("structure a.psf\nPME on ;# always\ntimestep 1; fullElectFrequency 4\n", "1,4"),
    ("structure a.psf\nGBIS on\ntimestep 1\nnonbondedFreq 2\nfullElectFrequency 4\n", "1,2,4"),
    ("structure a.psf\nFullDirect yes\ntimestep 1\nnonbondedFreq 2\n", "1,2"),
    ("structure a.psf\nPME no\ntimestep 1\nnonbondedFreq 2\nfullElectFrequency 4\n", "1,2"),
    ("parmfile a.prmtop\nambercoor a.crd\namber on\ntimestep=2\nPME = yes\nfullElectFrequency = 2\n", "2,4"),
    ("set dt 2.0\nset n 2\nstructure a.psf\nPME yes\ntimestep $dt\nfullElectFrequency ${n}\n", "2,4"),
    ("structure a.psf\nPME yes\nTimestep 2\nFULLELECTFREQUENCY 3\nmtsalgorithm verletI\n", "2,6"),
    ("structure a.psf\nif {$argc > 1} {\n  margin 3\n}\nPME yes\ntimestep 2\nfullElectFrequency 2\n", "2,4"),
    ("structure a.psf\nrigidBonds none\ntimestep 0.5\nlangevin on\nlangevinDamping 1\n", "0.5"),
    ("structure a.psf\nMSM yes\ntimestep 1\nfullElectFrequency 3\nnonbondedFreq 3\n", "1,3"),
    ("structure a.psf\nLCPO on\nGBISSer on\ntimestep 1 ;\nfullElectFrequency 2 ;\n", "1,2"),
    ("structure a.psf\nsource pme.conf\ntimestep 1\nfullElectFrequency 1\n", "1"),
];

#[test]
fn the_steps_of_gromacs_and_namd_are_those_of_their_rules() {
    let all =
        GROMACS.map(|own| (Engine::Gromacs, own)).into_iter().chain(NAMD.map(|own| (Engine::Namd, own)));
    for (engine, (text, expected)) in all {
        let reading = of(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!((reading.engine, steps(&reading).as_str()), (engine, expected), "{text}");
    }
    // A default is named as one.
    let default = |text: &str| of(text).unwrap().used.iter().any(|own| own.contains("the default"));
    assert!(default(GROMACS[1].0) && default(NAMD[1].0) && !default(NAMD[0].0));
}

/// Few lines of each kind that was misread, and the right steps in fs.
const MISREAD: [(&str, &str); 14] = [
    ("units real\npair_style lj/cut 9\nread_data d\ntimestep 1.0\n", "1"),
    ("structure a.psf\ncoordinates a.pdb\nPME yes\ntimestep 2.0; # fs\nfullElectFrequency 2;\n", "2,4"),
    (
        "structure a.psf\ncoordinates a.pdb\nPME yes\ntimestep 2.0\nrigidBonds all; # held\nfullElectFrequency 2\n",
        "2,4",
    ),
    (
        "structure a.psf\ncoordinates a.pdb\ntimestep 1.5\nnonbondedFreq 3\nfullElectFrequency 6\nstepspercycle 18\n",
        "1.5,4.5",
    ),
    (
        "structure a.psf\ncoordinates a.pdb\nPME yes\ntimestep 1.0\nfullElectFrequency 4\nstepspercycle 20\noutputEnergies 100\n",
        "1,4",
    ),
    (
        "integrator = md\ndt = 0.0005\nmts = yes\nmts-level2-forces = longrange-nonbonded nonbonded\nmts-level2-factor = 10\nnstlist = 20\nnstcalcenergy = 10\n",
        "0.5,5",
    ),
    (
        "integrator = md\ndt = 0.0005\nmts = yes\nmts-level2-factor = 4\npcoupl = C-rescale\nnstpcouple = 20\n",
        "0.5,2",
    ),
    ("integrator = md\ndt = 0.002\nmts = yes\nmts-level2-factor = 2\n", "2,4"),
    (
        "integrator = sd\ndt = 0.0005\nmts = yes\nmts-level2-forces = nonbonded\nmts-level2-factor = 4\ncoulombtype = PME\n",
        "0.5,2",
    ),
    ("integrator = md\ndt = 0.002\nmts = yes\nmts-level2-factor = 2\nmass-repartition-factor = 3\n", "2,4"),
    ("units electron\npair_style eff/cut 10\nrun_style respa 2 4 bond 1 pair 2\n", "0.00025,0.001"),
    (
        "units real\natom_style full\npair_style lj/cut 9\nfix s all shake 1e-6 100 0 b 1 a 1\ntimestep 4.0\nrun_style respa 2 2 bond 1 pair 2\n",
        "2,4",
    ),
    (
        "units real\npair_style lj/cut 9\nvariable ts equal 2.0\ntimestep ${ts}\nrun_style respa 2 4 bond 1 pair 2\n",
        "0.5,2",
    ),
    ("structure a.psf\ncoordinates a.pdb\nPME on\nset dt 2.0\ntimestep $dt\nfullElectFrequency 2\n", "2,4"),
];

#[test]
fn what_was_misread_has_its_right_steps() {
    for (text, expected) in MISREAD {
        let reading = of(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(steps(&reading), expected, "{text}");
        // Whatever line is written, the engine reads it: no fraction.
        let outer = reading.scheme.last_but_one() * ratio(6, 1);
        if let Ok(lines) = reading.changed_lines(&outer) {
            assert!(!lines.is_empty() && lines.iter().all(|line| !line.contains('/')), "{lines:?}");
        }
    }
}

/// Texts that are refused, and words of the message.
const REFUSED: [(&str, &str); 27] = [
    (
        "structure a.psf\nsource pme.conf\ntimestep 1\nfullElectFrequency 4\n",
        "may be on in a text that is sourced",
    ),
    // Other engines, by name.
    (
        "[INPUT]\ntopfile = a.psf\n[DYNAMICS]\nintegrator = VRES\ntimestep = 0.0025\nelec_long_period = 2\n",
        "GENESIS",
    ),
    (
        "app = mdsim\nintegrator = {\n  dt = 0.002\n  respa = {\n near_timesteps = 1\n far_timesteps = 3\n }\n}\n",
        "Desmond",
    ),
    (" &cntrl\n  nstlim = 100\n  dt = 0.001\n  nrespa = 4\n /\n", "AMBER"),
    ("&GLOBAL\n RUN_TYPE MD\n&END\n&MOTION\n&MD\nTIMESTEP 0.5\n&END\n&END\n", "CP2K"),
    ("&control\n calculation = 'md'\n dt = 20\n/\n&system\n/\n", "Quantum ESPRESSO"),
    ("import numpy as np\ndt = 0.1\nx = dt\n", "Python"),
    ("def f(x):\n    return x\ndt = 0.002\n", "Python"),
    // Nobody's.
    ("x = 1.0\ndt = 0.1\ny = x + dt\n", "no engine"),
    ("dt = 0.002\nintegrator = leapfrog\nnsteps = 10\n", "no engine"),
    ("timestep 2.0\nrun 1000\n", "no engine"),
    // Words that the engine does not know, and no step.
    ("nstlist = 10\nfoo = 3\n", "its default of 0.001 ps is not taken"),
    // What decides on the steps and is not followed.
    (
        "units real\nread_data d\ntimestep 4.0\nif \"$(is_active(pair,respa))\" then \"run_style respa 2 8 inner 1 5 7 outer 2\" else \"run_style respa 2 8\"\n",
        "log",
    ),
    ("units real\nread_data d\nvariable ts equal 2*3\ntimestep ${ts}\n", "log"),
    ("units real\nread_data d\nvariable ts equal 2\nvariable ts equal 3\ntimestep ${ts}\n", "log"),
    ("units real\npair_style lj/cut 9\ninclude settings.in\n", "log"),
    ("structure a.psf\nPME yes\nif {$x} {\n timestep 2\n}\n", "log"),
    ("structure a.psf\noutputname b\nsource more.conf\n", "log"),
    ("structure a.psf\nPME yes\nset dt 1\nincr dt\ntimestep $dt\n", "log"),
    ("structure a.psf\nPME yes\ntimestep [expr 2*1]\nfullElectFrequency 2\n", "log"),
    // What the engine refuses, and runs without steps.
    ("units real\nread_data d\nrun_style respa 2 4 pair 2 bogus 3\n", "no such word"),
    ("units real\nread_data d\nrun_style respa 2 4 bond 1 pair 3\n", "levels 1 to 2"),
    (
        "units real\nread_data d\nrun_style respa 3 2 2 inner 3 4.0 5.0 outer 1\n",
        "refuses outer on a level below",
    ),
    ("units real\nread_data d\nrun_style respa 2 2 bond 2 pair 1\n", "refuses pair on a level below"),
    ("integrator = steep\nemtol = 100\nnstlist = 10\n", "no steps of time"),
    ("integrator = md\nmts = perhaps\n", "write yes or no"),
    ("integrator = md\ndt = 1d-3\nnstlist = 10\n", "positive number"),
];

#[test]
fn what_is_not_known_for_certain_is_refused_with_a_remedy() {
    for (text, words) in REFUSED {
        let error = of(text).map(|own| steps(&own)).expect_err(text).to_string();
        assert!(error.contains(words), "{text}\n{error}");
    }
    // With the step in the text the strange word is told, and no more.
    let reading = of("nstlist = 10\nfoo = 3\ndt = 0.002\n").unwrap();
    assert_eq!(reading.remarks, ["not understood, since GROMACS has no such words: foo"]);
}

/// Texts, a step in fs, and the lines that change to take it; none where the engine refuses the text anyway.
const LINES: [(&str, (i64, i64), &[&str]); 15] = [
    (
        "units real\nread_data d\ntimestep 1.0\n",
        (6_809_316_352_826_907, 2_251_799_813_685_248),
        &["timestep 3.02394"],
    ),
    ("integrator = md\ndt = 0.001\n", (22, 7), &["dt = 0.00314285"]),
    ("structure a.psf\noutputname b\ntimestep 1.0\n", (22, 7), &["timestep 3.14285"]),
    ("units si\nread_data d\ntimestep 1e-15\n", (2, 1), &["timestep 2e-15"]),
    (
        "units real\nread_data d\ntimestep 2.0\nbond_style harmonic\nrun_style respa 2 7\n",
        (22, 7),
        &["timestep 3.14285", "run_style respa 2 11"],
    ),
    (
        "units real\nread_data d\nvariable dt equal 2.0\ntimestep ${dt}\nbond_style harmonic\nrun_style respa 2 4\n",
        (3, 1),
        &["variable dt equal 3", "run_style respa 2 6"],
    ),
    // NAMD: both frequencies divide the cycle, energies are written at full electrostatics or the other way
    // round.
    (
        "structure a.psf\nPME yes\ntimestep 1\nfullElectFrequency 4\nstepspercycle 20\noutputEnergies 100\n",
        (3, 1),
        &["fullElectFrequency 3", "stepspercycle 21", "outputEnergies 102"],
    ),
    (
        "structure a.psf\nPME yes\ntimestep 1\nfullElectFrequency 4\nstepspercycle 20\noutputEnergies 2\n",
        (2, 1),
        &["fullElectFrequency 2"],
    ),
    (
        "structure a.psf\nPME yes\ntimestep 1\nfullElectFrequency 4\nstepspercycle 20\nrun 100000\n",
        (3, 1),
        &["fullElectFrequency 3", "stepspercycle 21", "run 100002"],
    ),
    // GROMACS: multiples of the factor.
    (
        "dt = 0.0005\nmts = yes\nmts-level2-forces = longrange-nonbonded nonbonded\nmts-level2-factor = 10\nnstlist = 20\nnstcalcenergy = 10\nnstenergy = 100\nnstlog = 0\n",
        (3, 1),
        &["mts-level2-factor = 6", "nstlist = 24", "nstcalcenergy = 12", "nstenergy = 108"],
    ),
    (
        "dt = 0.001\nmts = yes\nmts-level2-forces = nonbonded longrange-nonbonded\nmts-level2-factor = 2\nnstcalcenergy = 12\nnstenergy = 12\nnstlog = 12\n",
        (3, 1),
        &["mts-level2-factor = 3", "nstlist = 12"],
    ),
    (
        "dt = 0.0005\nmts = yes\nmts-level2-factor = 4\npcoupl = C-rescale\nnstpcouple = 20\nfree-energy = yes\nnstdhdl = 60\nnstcalcenergy = 60\nnstenergy = 60\nnstlog = 60\n",
        (4, 1),
        &[
            "mts-level2-factor = 8",
            "nstpcouple = 24",
            "nstdhdl = 64",
            "nstcalcenergy = 64",
            "nstenergy = 64",
            "nstlog = 64",
        ],
    ),
    ("dt = 0.002\nmts = yes\nmts-level2-factor = 2\n", (2, 1), &["mts = no"]),
    (
        "integrator = sd\ndt = 0.0005\nmts = yes\nmts-level2-forces = longrange-nonbonded\nmts-level2-factor = 4\n",
        (1, 1),
        &[],
    ),
    (
        "dt = 0.0005\nmts = yes\nmts-level2-forces = nonbonded\nmts-level2-factor = 4\ncoulombtype = PME\n",
        (1, 1),
        &[],
    ),
];

#[test]
fn lines_that_are_written_are_lines_that_the_engine_takes() {
    for (text, (over, under), expected) in LINES {
        let reading = of(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        let outer = ratio(over, under);
        if expected.is_empty() {
            let error = reading.changed_lines(&outer).unwrap_err();
            assert!(error.remedy().starts_with("grompp refuses this text"), "{text}\n{error}");
            assert!(reading.remarks.iter().any(|own| own == error.remedy()), "{text}");
            continue;
        }
        let mut written = reading.changed_lines(&outer).unwrap();
        let mut expected = expected.to_vec();
        written.sort_unstable();
        expected.sort_unstable();
        assert_eq!(written, expected, "{text}");
        // Read again it is that step, or one a little shorter; nothing is left to change.
        let again = of(&reading.rewritten(&outer).unwrap()).unwrap();
        assert!(
            *again.scheme.outer() <= outer && *again.scheme.outer() > &outer * ratio(99_999, 100_000),
            "{text}"
        );
        assert_eq!(again.changed_lines(again.scheme.outer()).unwrap(), Vec::<String>::new(), "{text}");
    }
}

/// What a text says of bonds, masses and forces, and the answer has to say.
const SAID: [(&str, &str); 16] = [
    ("structure a.psf\ntimestep 1\nif {$hold} {\n rigidBonds all\n}\n", "rigidBonds stands in a condition"),
    (
        "dt = 0.002\nmts = yes\nmts-level2-factor = 3\ncoulombtype = PME\n",
        "nstcalcenergy = 100 (the default)",
    ),
    (
        "dt = 0.002\nmts = yes\nmts-level2-factor = 3\nmts-level2-forces = longrange-nonbonded nonbonded\nnstenergy = 9\nnstlog = 9\n",
        "nstlist = 10 (the default)",
    ),
    (
        "structure a.psf\nPME yes\ntimestep 1\nfullElectFrequency 3\n",
        "NAMD refuses this text as it stands: stepspercycle = 20 (the default)",
    ),
    (
        "structure a.psf\nPME yes\ntimestep 1\nfullElectFrequency 4\noutputEnergies 10\n",
        "outputEnergies = 10",
    ),
    (
        "structure a.psf\nPME yes\ntimestep 1\nfullElectFrequency 2\nnonbondedFreq 4\n",
        "fullElectFrequency has to be a multiple of nonbondedFreq",
    ),
    (
        "units real\nread_data d\nbond_style harmonic\nfix s all shake 1e-6 100 0 b 1 a 1\ntimestep 4.0\nrun_style respa 2 2\n",
        "fix shake holds bonds by their types",
    ),
    ("units real\nread_data d\nfix r all rigid/nvt molecule\ntimestep 2\n", "makes bodies rigid"),
    (
        "units real\nread_data d\nfix d all dt/reset 10 NULL NULL 0.1\ntimestep 2\n",
        "changes the step in the run",
    ),
    ("units real\nread_data d\ninclude more.in\ntimestep 2\n", "log.lammps"),
    ("units real\nread_data d\nrun 10\ntimestep 2\ntimestep 3\nrun 10\n", "timestep is given 2 times"),
    ("dt = 0.0005\nmts = yes\nmts-level2-factor = 4\n", "no force is on the second level"),
    (
        "dt = 0.0005\nmts = yes\nmts-level2-factor = 4\nnstlog = 10\n",
        "grompp refuses this text as it stands: nstlog = 10 is no multiple of 4",
    ),
    ("dt = 0.002\nconstraints = all-angles\nnstlist = 10\n", "angles that constraints hold"),
    ("structure a.psf\nPME yes\ntimestep 2\nrigidBonds water\nfullElectFrequency 2\n", "water alone"),
    ("structure a.psf\ntimestep 1\nfullElectFrequency 6\n", "takes fullElectFrequency for 0"),
];

#[test]
fn a_line_for_namd_is_added_before_its_first_run() {
    let text = "structure a.psf\nPME yes\ntimestep 1\nfullElectFrequency 4\nminimize 1000\nrun 20000\n";
    let reading = of(text).unwrap();
    let new = reading.rewritten(&ratio(3, 1)).unwrap();
    assert!(new.contains("fullElectFrequency 3\nstepspercycle = 21\nminimize 1008\nrun 20013\n"), "{new}");
    let lines = ["fullElectFrequency 3", "stepspercycle = 21", "minimize 1008", "run 20013"];
    assert_eq!(reading.changed_lines(&ratio(3, 1)).unwrap(), lines);
}

#[test]
fn a_step_that_no_line_has_is_not_rewritten_and_the_line_to_add_is_said() {
    for text in
        ["units real\nread_data d\nbond_style harmonic\nrun_style respa 2 4\n", GROMACS[1].0, NAMD[1].0]
    {
        let reading = of(text).unwrap();
        let outer = reading.scheme.last_but_one() * ratio(2, 1);
        let error = reading.changed_lines(&outer).unwrap_err();
        assert!(
            error.remedy().starts_with("the text has no") && error.remedy().contains(": write "),
            "{error}"
        );
    }
}

#[test]
fn what_bears_on_the_answer_is_read_or_said() {
    for (text, words) in SAID {
        let remarks = of(text).unwrap_or_else(|error| panic!("{text}: {error}")).remarks;
        assert!(remarks.iter().any(|own| own.contains(words)), "{text}\n{remarks:?}");
    }
    for (text, held) in [
        (
            "units real\nread_data d\nfix s all rattle 1e-6 100 0 m 1.0\ntimestep 2\n",
            Some(Constraints::HBonds),
        ),
        ("units real\nread_data d\nfix s all shake 1e-6 100 0 m 1.0\nunfix s\ntimestep 2\n", None),
        ("structure a.psf\ntimestep 2.0\nrigidBonds all; # held\noutputname b\n", Some(Constraints::HBonds)),
        ("dt = 0.002\nconstraints = H_bonds ; all\nnstlist = 10\n", Some(Constraints::HBonds)),
        ("dt = 0.002\nconstraints = h-bonds ; all\nnstlist = 10\n", Some(Constraints::HBonds)),
        ("dt = 0.002\nconstraints = all-bonds\nnstlist = 10\n", Some(Constraints::AllBonds)),
    ] {
        assert_eq!(of(text).unwrap().constraints, held, "{text}");
    }
    let heavy = of("dt = 0.004\nmass-repartition-factor = 3\nconstraints = h-bonds\n").unwrap().hydrogen;
    assert_eq!(heavy, Some(ratio(3024, 1000)));
}

#[test]
fn a_byte_order_mark_is_no_part_of_the_first_line() {
    let all = [GROMACS[0].0, NAMD[0].0, LAMMPS[0].1, "dt = 0.004\nmts = yes\nconstraints = none\n"];
    for text in all {
        for mark in ["\u{feff}", "\u{ef}\u{bb}\u{bf}"] {
            let marked = of(&format!("{mark}{text}")).unwrap();
            assert_eq!((steps(&marked), marked.used), (steps(&of(text).unwrap()), of(text).unwrap().used));
        }
    }
    assert_eq!(steps(&of("\u{feff}dt = 0.004\nnstlist = 10\n").unwrap()), "4");
}

/// Texts of a length that grows with n.
fn large(n: usize) -> [String; 6] {
    let counted = |line: &dyn Fn(usize) -> String| (0..n).map(line).collect::<String>();
    let parts = counted(&|k| format!(" s{k}"));
    let coefficients = counted(&|k| format!("pair_coeff * * s{k}\n"));
    let head = "units real\ntimestep 1\n";
    [
        format!(
            "{head}pair_style hybrid{parts}\n{coefficients}run_style respa 2 2 hybrid{}\n",
            " 1".repeat(n)
        ),
        format!("{head}{}", "fix a all shake 1 2 3 b 1\nunfix b\n".repeat(n)),
        format!("{head}run_style respa 2 2{}\n", " bond 1".repeat(n)),
        format!("structure a.psf\ntimestep 1\n{}", "set a 1;".repeat(n)),
        format!("nstlist = 10\ndt = 0.001\n{}", counted(&|k| format!("k{k} = 1\n"))),
        format!("{head}variable{}\n", " &\n a".repeat(n)),
    ]
}

#[test]
fn large_texts_are_read_or_refused_in_time_that_grows_with_their_length() {
    let fastest = |text: &str| {
        let once = |_| {
            let begun = thread_time();
            let answer = of(text).map(|own| steps(&own));
            (thread_time() - begun, answer.is_ok())
        };
        (0..3).map(once).min().unwrap().0
    };
    for (short, long) in large(10_000).iter().zip(large(40_000)) {
        let [short, long] = [short, &long].map(|text| fastest(text));
        // Four times as long: a quadratic reader takes sixteen times as long. Short times are hardly
        // measured.
        assert!(long < 10 * short.max(Duration::from_millis(50)), "{short:?} {long:?}");
    }
}
