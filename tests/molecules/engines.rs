//! What simulation engines write about their steps: read as they read it, rewritten, and read again; damaged
//! texts are refused in one line.

use kickdrift::advise::engine::{Engine, Reading, not_nested, read};
use kickdrift::advise::unit::TimeUnit;
use kickdrift::advise::unit::decimal;
use kickdrift::error::{Error, Kind};
use kickdrift::number::Rational;
use kickdrift::number::rational::ratio;

macro_rules! inner {
    () => {
        concat!(
            "<Computation computationExpression=\"v+0.5*(dt/4)*f2/m\" computationType=\"1\" computationVariable=\"v\"/>",
            "<Computation computationExpression=\"x+(dt/4)*v\" computationType=\"1\" computationVariable=\"x\"/>",
            "<Computation computationExpression=\"v+0.5*(dt/4)*f2/m\" computationType=\"1\" computationVariable=\"v\"/>"
        )
    };
}

macro_rules! middle {
    () => {
        concat!(
            "<Computation computationExpression=\"v+0.5*(dt/2)*f1/m\" computationType=\"1\" computationVariable=\"v\"/>",
            inner!(),
            inner!(),
            "<Computation computationExpression=\"v+0.5*(dt/2)*f1/m\" computationType=\"1\" computationVariable=\"v\"/>"
        )
    };
}

macro_rules! langevin {
    () => {
        concat!(
            "<Computation computationExpression=\"v+0.5*(dt/2)*f1/m\" computationVariable=\"v\"/>\n",
            "<Computation computationExpression=\"x+(dt/4)*v\" computationVariable=\"x\"/>\n",
            "<Computation computationExpression=\"a*v + b*sqrt(kT/m)*gaussian\" computationVariable=\"v\"/>\n",
            "<Computation computationExpression=\"x+(dt/4)*v\" computationVariable=\"x\"/>\n",
            "<Computation computationExpression=\"v+0.5*(dt/2)*f1/m\" computationVariable=\"v\"/>\n"
        )
    };
}

/// A text of each notation, and its steps.
const TEXTS: [(Engine, &str, &str); 16] = [
    (
        Engine::Ipi,
        "<simulation><motion mode='dynamics'><dynamics mode='nve'><timestep units='femtosecond'>4</timestep><nmts>[1, 2, 4]</nmts></dynamics></motion></simulation>",
        "0.5,2,4",
    ),
    (Engine::Tinker, "integrator vrespa\nrespa-inner 16\n", "0.25,4"),
    (Engine::OpenMm, MTS, "1,2,4"),
    (Engine::OpenMm, LANGEVIN, "2,4"),
    (
        Engine::OpenMm,
        "from openmm import *\nintegrator = MTSIntegrator(4*femtoseconds, [(0,1), (1,2), (2,8)])\n",
        "0.5,2,4",
    ),
    (
        Engine::OpenMm,
        "force.setForceGroup(1)\ni = MTSLangevinIntegrator(300*kelvin, 1/picosecond, 0.004*unit.picoseconds, groups=[(1,8),\n  (0,1)])\n",
        "0.5,4",
    ),
    (Engine::OpenMm, "<Integrator stepSize=\".002\" type=\"VerletIntegrator\" version=\"1\"/>", "2"),
    (
        Engine::Lammps,
        "units real # kcal\npair_style lj/cut 10\ntimestep 4.0\nrun_style respa 4 2 2 2 &\n bond 1 dihedral 2 pair 3 kspace 4\n",
        "0.5,1,2,4",
    ),
    (Engine::Lammps, "units metal\ntimestep 0.001\nrun_style verlet\n", "1"),
    (
        Engine::Gromacs,
        "; comment\nintegrator = md\ndt = 0.002\nmts = yes\nmts-levels = 2\nmts_level2_factor = 2\nmts-level2-forces = longrange-nonbonded pair\nconstraints = h-bonds\n",
        "2,4",
    ),
    (Engine::Gromacs, "dt=0.001\nmts=yes", "1,2"),
    (Engine::Gromacs, "integrator = md\ndt = 0.0005\n", "0.5"),
    (
        Engine::Namd,
        "structure a.psf\nPME on\ntimestep 1.0 # fs\nnonbondedFreq 2\nfullElectFrequency = 4\nstepspercycle 20\n",
        "1,2,4",
    ),
    (Engine::Tinker, "parameters amoeba\nINTEGRATOR RESPA\nRESPA-INNER 0.5\n", "0.5,4"),
    (
        Engine::Ipi,
        "<simulation><system><motion mode='dynamics'><dynamics mode='nve'><timestep units='femtosecond'> 4.0 </timestep><nmts> [1, 8] </nmts></dynamics></motion></system></simulation>",
        "0.5,4",
    ),
    (
        Engine::Ipi,
        "<simulation><motion mode='dynamics'><dynamics>\n<timestep units=\"picosecond\">0.001</timestep></dynamics></motion></simulation>",
        "1",
    ),
];

/// As OpenMM 8.6 serializes `MTSIntegrator(4*femtoseconds, [(0,1),(1,2),(2,4)])`, on one line.
const MTS: &str = concat!(
    "<?xml version=\"1.0\" ?><Integrator constraintTolerance=\"1e-05\" kineticEnergyExpression=\"m*v*v/2\" randomSeed=\"0\" stepSize=\".004\" ",
    "type=\"CustomIntegrator\" version=\"3\"><GlobalVariables/><Computations>",
    "<Computation computationExpression=\"\" computationType=\"5\" computationVariable=\"\"/>",
    "<Computation computationExpression=\"v+0.5*(dt/1)*f0/m\" computationType=\"1\" computationVariable=\"v\"/>",
    middle!(),
    middle!(),
    "<Computation computationExpression=\"v+0.5*(dt/1)*f0/m\" computationType=\"1\" computationVariable=\"v\"/>",
    "<Computation computationExpression=\"\" computationType=\"4\" computationVariable=\"\"/></Computations><Functions/></Integrator>",
);

/// Two steps of a learned potential as LAMMPS with metatomic takes them: direct forces often, what corrects
/// them every eighth time.
const METATOMIC: &str = "units metal
pair_style hybrid/overlay &
  metatomic_1 model.pt device cpu non_conservative on scale 1.0 &
  metatomic_2 model.pt device cpu non_conservative on scale -1.0 &
  metatomic_3 model.pt device cpu non_conservative off scale 1.0
pair_coeff * * metatomic_1 6 1
pair_coeff * * metatomic_2 6 1
pair_coeff * * metatomic_3 6 1
timestep 0.004
run_style respa 2 8 hybrid 1 2 2 kspace 2
";

/// The same of i-PI.
const DIRECT: &str = "<simulation>
<ffdirect name='nc'><pes>metatomic</pes><parameters>{model: model.pt, non_conservative: True}</parameters></ffdirect>
<ffdirect name='c'><pes>metatomic</pes><parameters>{model: model.pt, non_conservative:False}</parameters></ffdirect>
<system><forces>
<force forcefield='c'><mts_weights>[1.0, 0]</mts_weights></force>
<force forcefield='nc'><mts_weights> [-1,1] </mts_weights></force>
</forces><motion mode='dynamics'><dynamics mode='nve'><timestep units='femtosecond'> 4.0 </timestep><nmts>[1,8]</nmts></dynamics></motion>
</system></simulation>";

#[test]
fn forces_that_are_predicted_directly_are_named() {
    for (text, forces, remark) in [
        (
            METATOMIC,
            ["metatomic_1", "metatomic_2, metatomic_3, kspace"],
            "metatomic_1, metatomic_2 are predicted directly",
        ),
        (DIRECT, ["nc", "c, -1 nc"], "nc is predicted directly"),
    ] {
        let reading = of(text).unwrap();
        assert_eq!((steps(&reading).as_str(), &reading.forces[..]), ("0.5,4", &forces.map(String::from)[..]));
        assert!(
            reading.remarks.len() == 1 && reading.remarks[0].starts_with(remark),
            "{:?}",
            reading.remarks
        );
        let potential = text.replace("non_conservative on", "non_conservative off").replace("True", "False");
        assert!(of(&potential).unwrap().remarks.is_empty());
    }
    // Distances behind a level belong to it; names that no coefficient has are numbered.
    let text = "units metal\ntimestep 0.004\nrun_style respa 3 2 2 inner 1 4.0 6.0 outer 3 hybrid 2 3\n";
    assert_eq!(of(text).unwrap().forces, ["inner", "pair 1", "outer, pair 2"]);
}

/// `MTSLangevinIntegrator(300*kelvin, 1/picosecond, 4*femtoseconds, [(0,1),(1,2)])`; a and b belong to the
/// innermost step.
const LANGEVIN: &str = concat!(
    "<Integrator stepSize=\".004\" type=\"CustomIntegrator\" version=\"3\"><GlobalVariables><Variable name=\"a\" value=\".9980019986673331\"/>",
    "</GlobalVariables><Computations>\n<Computation computationExpression=\"v+0.5*(dt/1)*f0/m\" computationVariable=\"v\"/>\n",
    langevin!(),
    langevin!(),
    "<Computation computationExpression=\"v+0.5*(dt/1)*f0/m\" computationVariable=\"v\"/>\n</Computations></Integrator>",
);

#[test]
fn a_serialized_integrator_is_rewritten_turn_by_turn() {
    let reading = of(MTS).unwrap();
    assert_eq!(reading.forces, ["group 2", "group 1", "group 0"]);
    let new = reading.rewritten(&ratio(6, 1)).unwrap();
    let count = |text: &str, part: &str| text.matches(part).count();
    assert!(new.contains("stepSize=\"0.006\"") && !new.contains("dt/2") && !new.contains("dt/4"));
    assert_eq!([count(MTS, "(dt/2)*f1"), count(&new, "(dt/3)*f1"), count(&new, "(dt/6)*f2")], [4, 6, 12]);
    assert_eq!(count(&new, "(dt/1)*f0"), 2);
    assert_eq!(of(&new).unwrap().rewritten(&ratio(4, 1)).unwrap(), MTS.replace(".004", "0.004"));
}

fn steps(reading: &Reading) -> String {
    reading.scheme.steps().iter().map(decimal).collect::<Vec<_>>().join(",")
}

fn of(text: &str) -> Result<Reading, Error> {
    started_with(text, &ratio(4, 1))
}

/// An engine that takes its outer step when a run starts gets this one.
fn started_with(text: &str, outer: &Rational) -> Result<Reading, Error> {
    read(&[text], Some(outer))
}

#[test]
fn each_notation_is_read_as_its_engine_reads_it() {
    for (engine, text, expected) in TEXTS {
        let reading = of(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!((reading.engine, steps(&reading).as_str()), (engine, expected), "{text}");
        assert!(!reading.used.is_empty() && !engine.dt().is_empty());
        assert_eq!(reading.forces.len(), reading.scheme.steps().len(), "{text}: {:?}", reading.forces);
    }
}

#[test]
fn what_is_rewritten_reads_as_the_new_steps_and_goes_back() {
    let mut rewritten = 0;
    for (engine, text, _) in TEXTS {
        let reading = of(text).unwrap();
        let before = reading.scheme.last_but_one().clone();
        let outer = &before * ratio(3, 1);
        let new = reading.rewritten(&outer).unwrap_or_else(|error| panic!("{text}: {error}"));
        let again = started_with(&new, &outer).unwrap();
        let (old, own) = (reading.scheme.steps(), again.scheme.steps());
        assert_eq!(*again.scheme.outer(), outer, "{new}");
        assert_eq!((old.len(), &old[..old.len() - 1]), (own.len(), &own[..own.len() - 1]), "{new}");
        let back = of(&again.rewritten(reading.scheme.outer()).unwrap()).unwrap();
        assert_eq!(steps(&back), steps(&reading));
        // The outer step of Tinker is no part of its key file.
        if old.len() > 1 && engine != Engine::Tinker {
            assert!(!reading.changed_lines(&outer).unwrap().is_empty());
            assert!(reading.rewritten(&(&before * ratio(5, 2))).is_err(), "no multiple: {text}");
        }
        rewritten += 1;
    }
    assert_eq!(rewritten, TEXTS.len());
}

#[test]
fn only_the_numbers_change() {
    let (_, text, _) = TEXTS[7];
    let new = of(text).unwrap().rewritten(&ratio(6, 1)).unwrap();
    assert_eq!(new, text.replace("timestep 4.0", "timestep 6").replace("respa 4 2 2 2", "respa 4 2 2 3"));
    let new = of(TEXTS[5].1).unwrap().rewritten(&ratio(3, 1)).unwrap();
    assert_eq!(new, TEXTS[5].1.replace("0.004", "0.003").replace("(1,8)", "(1,6)"));
    assert_eq!(
        of(TEXTS[10].1).unwrap().rewritten(&ratio(4, 1)).unwrap(),
        "dt=0.001\nmts=yes\nmts-level2-factor = 4\n"
    );
}

#[test]
fn forces_that_openmm_would_silently_drop_are_an_error() {
    let groups: String = (0..8).map(|group| format!("forces[{group}].setForceGroup({group})\n")).collect();
    let error =
        of(&format!("{groups}integrator = MTSIntegrator(4*femtoseconds, [(1,1),(0,2)])")).unwrap_err();
    assert_eq!(error.field(), "force groups");
    assert!(error.remedy().contains("groups 2, 3, 4, 5, 6, 7 would never be integrated"), "{error}");
    // Groups by variables are not followed, which is told.
    let reading =
        of("f.setForceGroup(i)\nintegrator = MTSIntegrator(4*femtoseconds, [(1,1),(0,2)])").unwrap();
    assert!(reading.remarks[0].contains("variables"));
}

#[test]
fn what_an_engine_refuses_is_said_and_what_is_not_symplectic_is_refused() {
    let error = of("structure a.psf\ntimestep 1\nnonbondedFreq 2\nMTSAlgorithm naive\n").unwrap_err();
    assert!(error.field() == "MTSAlgorithm" && error.remedy().contains("not symplectic"), "{error}");
    // 1, 2 and 3 fs: NAMD wants multiples; the scheme is answered all the same.
    let reading =
        of("structure a.psf\nPME yes\ntimestep 1\nnonbondedFreq 2\nfullElectFrequency 3\nstepspercycle 6\n")
            .unwrap();
    assert_eq!(steps(&reading), "1,2,3");
    assert_eq!(reading.remarks, ["NAMD itself refuses this: 3 fs is no multiple of 2 fs"]);
    assert!(not_nested(&of(TEXTS[4].1).unwrap().scheme, TimeUnit::Femtoseconds).is_none());
    for (text, field) in [
        ("units furlongs\npair_style lj/cut 2.5\ntimestep 0.005\n", "units"),
        ("dt = 0.002\nmts = yes\nmts-levels = 3\n", "mts-levels"),
        ("units real\ntimestep ${dt}\n", "timestep"),
        ("i = MTSIntegrator(dt, [(0,1)])", "dt"),
        ("i = MTSIntegrator(4*femtoseconds, [(0,2),(1,3)])", "groups"),
        ("i = MTSIntegrator(4*femtoseconds, groups)", "groups"),
        ("hello", "engine"),
    ] {
        assert_eq!(of(text).unwrap_err().field(), field, "{text}");
    }
    assert!(read(&[TEXTS[13].1], None).unwrap_err().to_string().starts_with("outer step missing"));
}

#[test]
fn unknown_keys_are_passed_over_and_what_was_used_is_listed() {
    let text = "; my run\nnstxout = 100\ndt = 0.001\nmts = yes\ngen-vel = no\nmts-level2-factor = 4\nrcoulomb = 1.0\n";
    let reading = of(text).unwrap();
    assert_eq!(
        reading.used,
        ["dt = 0.001", "mts-level2-factor = 4", "mts-level2-forces = longrange-nonbonded"]
    );
}

/// A line that each engine passes over; where it goes.
const UNKNOWN: [(Engine, &str, &str); 6] = [
    (Engine::Gromacs, "dt", "nstxout = 7\ndt"),
    (Engine::Lammps, "timestep", "thermo 7\ntimestep"),
    (Engine::Namd, "timestep", "outputName run7\ntimestep"),
    (Engine::Tinker, "integrator", "vdw-cutoff 7\nintegrator"),
    (Engine::Ipi, "<dynamics", "<fixcom>True</fixcom><dynamics"),
    (Engine::OpenMm, "integrator = ", "temperature = 7\nintegrator = "),
];

#[test]
fn a_line_that_an_engine_passes_over_changes_nothing() {
    for (engine, at, with) in UNKNOWN {
        let mut seen = 0;
        for (_, text, _) in TEXTS.iter().filter(|(own, ..)| *own == engine) {
            let more = text.replacen(at, with, 1);
            if more == *text {
                continue;
            }
            let (plain, own) =
                (of(text).unwrap(), of(&more).unwrap_or_else(|error| panic!("{more}: {error}")));
            assert_eq!(
                (steps(&plain), &plain.used, &plain.remarks),
                (steps(&own), &own.used, &own.remarks),
                "{more}"
            );
            seen += 1;
        }
        assert!(seen > 0, "{at}");
    }
}

#[test]
fn ten_thousand_damaged_texts_are_read_or_refused_in_one_line() {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = |n: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % n.max(1) as u64) as usize
    };
    let bits = [
        "0",
        "-1",
        "1e999",
        "99999999999999999999",
        "(",
        ")",
        "[",
        "]",
        ",",
        "=",
        "<",
        "/>",
        "&",
        "#",
        ";",
        "\n",
        "\u{e9}",
        "*",
        "respa",
        "yes",
        "",
        "\0",
        "0x",
        "1d0",
    ];
    let (mut good, mut bad) = (0, 0);
    for _ in 0..10_000 {
        let mut text: Vec<char> = TEXTS[random(TEXTS.len())].1.chars().collect();
        for _ in 0..=random(3) {
            let (at, until) = (random(text.len() + 1), random(8));
            let upto = (at + until).min(text.len());
            match random(3) {
                0 => drop(text.drain(at..upto)),
                1 => drop(text.splice(at..at, bits[random(bits.len())].chars().collect::<Vec<_>>())),
                _ => drop(text.splice(at..upto, bits[random(bits.len())].chars().collect::<Vec<_>>())),
            }
        }
        let text: String = text.into_iter().collect();
        match of(&text) {
            Ok(reading) => {
                good += 1;
                assert!(!reading.used.is_empty(), "{text:?}");
                // What is read can be rewritten or says why not.
                let outer = reading.scheme.last_but_one() * ratio(2, 1);
                if let Ok(new) = reading.rewritten(&outer) {
                    let again = started_with(&new, &outer).map(|again| again.scheme.outer().clone());
                    // A step that needs more digits is a little shorter.
                    let near = |again: &Rational| *again <= outer && *again > &outer * ratio(99_999, 100_000);
                    assert!(again.is_err() || near(&again.unwrap()), "{text:?}\n{new:?}");
                }
            }
            Err(error) => {
                bad += 1;
                let message = error.to_string();
                assert!(!message.contains('\n') && error.kind() != Kind::Io, "{message}");
                assert!(!error.field().is_empty() && !error.remedy().is_empty(), "{text:?}: {message}");
                // What was given, or that nothing was.
                let told =
                    error.value().is_some() || message.contains(" missing: ") || error.kind() == Kind::Budget;
                assert!(told, "{text:?}: {message}");
            }
        }
    }
    assert!(good > 1000 && bad > 1000, "{good} {bad}");
}

#[test]
fn what_an_engine_wants_to_be_multiples_of_the_factor_is_rewritten_with_it() {
    let text = "dt = 0.001\nmts = yes\nmts-level2-factor = 2\nnstcalcenergy = 10 ; energies\nnstenergy = 500\nnstlog = 35\nnstfout = 0\n";
    let new = of(text).unwrap().rewritten(&ratio(3, 1)).unwrap();
    let expected =
        text.replace("= 2\n", "= 3\n").replace("= 10 ", "= 12 ").replace("500", "504").replace("35", "36");
    assert_eq!(new, expected);
    // By default 100, 1000 and 1000: those that are no multiples are added, energies still where they are
    // computed.
    let bare = of("dt = 0.001\nmts = yes\nmts-level2-factor = 2").unwrap();
    assert_eq!(bare.rewritten(&ratio(4, 1)).unwrap(), "dt = 0.001\nmts = yes\nmts-level2-factor = 4");
    let mut added = bare.changed_lines(&ratio(3, 1)).unwrap();
    added.sort();
    assert_eq!(added, ["mts-level2-factor = 3", "nstcalcenergy = 102", "nstenergy = 1020", "nstlog = 1020"]);
    for factor in 2..30 {
        let again = of(&bare.rewritten(&ratio(factor, 1)).unwrap()).unwrap();
        assert_eq!(*again.scheme.outer(), ratio(factor, 1));
    }
    // NAMD: electrostatics every whole number of nonbonded evaluations, a cycle every whole number of both.
    let both =
        of("structure a.psf\nPME yes\ntimestep 1\nnonbondedFreq 2\nfullElectFrequency 2\nstepspercycle 20\n")
            .unwrap();
    let new = both.rewritten(&ratio(3, 1)).unwrap();
    assert_eq!(
        new,
        "structure a.psf\nPME yes\ntimestep 1\nnonbondedFreq 3\nfullElectFrequency 3\nstepspercycle 21\n"
    );
}

#[test]
fn an_outer_step_that_no_engine_runs_is_answered_by_those_beside_it() {
    use kickdrift::advise::Scheme;
    use kickdrift::advise::engine::nested_beside;
    let beside = |inner: Rational, outer: Rational| {
        nested_beside(&Scheme::new(vec![inner, outer]).unwrap(), TimeUnit::Femtoseconds)
    };
    assert_eq!(
        beside(ratio(1, 2), ratio(21, 5)).unwrap(),
        "4.2 fs is no multiple of 0.5 fs, so no engine runs it: ask for 4 fs (8 of 0.5 fs) or 4.5 fs (9 of 0.5 fs)"
    );
    assert!(beside(ratio(1, 2), ratio(4, 1)).is_none());
}

#[test]
fn a_serialized_step_that_was_computed_is_the_short_one_that_was_meant() {
    for (size, expected) in [(".009000000000000001", "9"), (".0030000000000000005", "3"), (".004", "4")] {
        let text = format!("<Integrator stepSize=\"{size}\" type=\"VerletIntegrator\" version=\"1\"/>");
        assert_eq!(steps(&of(&text).unwrap()), expected, "{size}");
    }
}
