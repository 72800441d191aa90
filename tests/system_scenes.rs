//! System files: the ones that ship, and what is wrong with others.

use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::scene::SystemScene;
use kickdrift::system::{Limits, decide_system};

fn shipped(name: &str) -> SystemScene {
    let path = format!("{}/data/scenes/{name}.json", env!("CARGO_MANIFEST_DIR"));
    SystemScene::read(&std::fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn shipped_systems_are_read_and_proven() {
    for (name, size, clocks) in [
        ("chain200", 200, 3),
        ("fpu", 6, 2),
        ("bar100", 100, 10),
        ("diatomic-tether", 2, 2),
        ("lennard-jones", 2, 2),
    ] {
        let scene = shipped(name);
        let system = scene.system();
        assert_eq!((system.size(), system.clocks().len()), (size, clocks), "{name}");
        assert!(!scene.title().is_empty());
        let analysis = decide_system(system, &Limits::default()).unwrap();
        assert!(analysis.is_proof(), "{name}: {:?}", analysis.warnings);
    }
}

#[test]
fn hessians_are_taken_at_the_equilibrium() {
    let scene = shipped("lennard-jones");
    let x = scene.equilibrium().unwrap();
    assert!((x[1] - 2f64.powf(1.0 / 6.0)).abs() < 1e-12);
    let curvature = to_f64(&scene.system().clocks()[0].stiffness.get(0, 1));
    assert!((curvature + 72.0 / 2f64.powf(1.0 / 3.0)).abs() < 1e-9);
    let mut run = scene.nonlinear_simulation(x.to_vec(), vec![0.0; 2]).unwrap().unwrap();
    let samples = kickdrift::avi::series(&mut run, 50, 1000);
    // It stays at its equilibrium but for roundoff.
    assert!(samples.iter().all(|s| (s.amplitude - x[1]).abs() < 1e-10));
}

#[test]
fn springs_and_matrices_say_the_same() {
    let read = |potential: &str| {
        let text = format!(
            r#"{{"schema": "kickdrift/system/1", "masses": [1, "3/2"], "potentials": [{{"step": "0.25", {potential}}}]}}"#
        );
        SystemScene::read(&text).unwrap().system().clocks()[0].stiffness.clone()
    };
    let springs = read(r#""springs": [[0, 1, "10"], [1, null, "1/2"]]"#);
    assert_eq!(springs, read(r#""stiffness": [["10", "-10"], [-10, "21/2"]]"#));
    assert_eq!(springs.get(1, 1), ratio(21, 2));
    let bonds = r#""bonds": [{"i": 0, "j": 1, "form": "harmonic", "k": "10"}, {"i": 1, "form": "harmonic", "k": "0.5"}]"#;
    assert_eq!(springs, read(bonds));
}

#[test]
fn errors_name_the_entry() {
    let with = |fields: &str| SystemScene::read(&format!(r#"{{"schema": "kickdrift/system/1", {fields}}}"#));
    let masses = r#""masses": ["1", "2"]"#;
    for (fields, message) in [
        (r#""masses": ["1"]"#.to_string(), "potentials = missing"),
        (r#""potentials": []"#.to_string(), "masses = missing"),
        (
            format!(r#"{masses}, "potentials": [{{"step": "1", "springs": [[0, 2, "1"]]}}]"#),
            "potentials[0].springs[0] = 2: indices are 0 to 1",
        ),
        (
            format!(r#"{masses}, "potentials": [{{"step": "pi", "springs": [[0, 1, "1"]]}}]"#),
            "potentials[0].step = pi: must be rational",
        ),
        (
            format!(r#"{masses}, "potentials": [{{"step": "-1", "springs": [[0, 1, "1"]]}}]"#),
            "potentials[0].step = -1: a step must be positive",
        ),
        (
            format!(r#"{masses}, "potentials": [{{"step": "1", "stiffness": [["1", "2"], ["3", "1"]]}}]"#),
            "potentials[0].stiffness[1][0] = 3: differs",
        ),
        (
            format!(r#"{masses}, "potentials": [{{"step": "1", "stiffness": [["1"]]}}]"#),
            "potentials[0].stiffness = 1 x 1",
        ),
        (
            r#""masses": ["1", "-2"], "potentials": [{"step": "1", "springs": [[0, 1, "1"]]}]"#.to_string(),
            "masses[1] = -2: a mass must be positive",
        ),
        (
            format!(r#"{masses}, "potentials": [{{"step": "1", "bonds": [{{"i": 0, "form": "morse"}}]}}]"#),
            "potentials[0].bonds[0].form = morse",
        ),
        (
            r#""build": {"kind": "chain", "masses": 100000, "stiffness": [1], "steps": [1]}"#.to_string(),
            "build.masses = 100000",
        ),
    ] {
        let error = with(&fields).map(|_| ()).unwrap_err().to_string();
        assert!(error.starts_with(message), "{error}\nexpected {message}");
    }
    assert!(SystemScene::read("{}").is_err());
    assert!(with(r#""mass": 1"#).is_err());
}
