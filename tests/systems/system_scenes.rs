//! System files: the ones that ship, and what is wrong with others.

use kickdrift::avi::{self, Ends};
use kickdrift::number::rational::{from_f64_exact, ratio, to_f64};
use kickdrift::number::{Ball, Laurent, Real};
use kickdrift::scene::{Array, Arrays, Axis, Scan, Span, SystemScene};
use kickdrift::system::friction::Damping;
use kickdrift::system::{Analysis, Evidence, Holds, Limits, ManyClocks, Part, Route, decide_system, middle};
use kickdrift::verdict::{Kind, Tier};
use nalgebra::DMatrix;

fn shipped(name: &str) -> SystemScene {
    let path = format!("{}/data/scenes/{name}.json", env!("CARGO_MANIFEST_DIR"));
    SystemScene::read(&std::fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn shipped_systems_are_read_and_proven() {
    for (name, size, clocks, stable) in [
        ("chain200", 200, 3, true),
        ("fpu", 6, 2, true),
        ("fpu-quartic", 4, 2, false),
        ("bar100", 100, 10, true),
        ("bar-resonant", 24, 4, false),
        ("diatomic-tether", 2, 2, true),
        ("lennard-jones", 2, 2, true),
        ("lennard-jones-resonant", 2, 2, false),
        ("ring24", 24, 2, true),
        ("three-clocks", 1, 3, false),
    ] {
        let scene = shipped(name);
        let analysis = scene.model().decide(Route::Cheapest, &Limits::default()).unwrap();
        assert_eq!((analysis.size, analysis.clocks), (size, clocks), "{name}");
        assert!(!scene.title().is_empty());
        assert!(analysis.is_proof(), "{name}: {:?}", analysis.warnings);
        assert_eq!(analysis.is_stable(), stable, "{name}");
    }
}

#[test]
fn growth_of_small_deviations_is_that_of_the_hessians() {
    // Beside the simulated nonlinear forces: size² is lost, and roundoff/size is small.
    for name in ["fpu-quartic", "lennard-jones-resonant"] {
        let scene = shipped(name);
        let analysis = scene.model().decide(Route::Cheapest, &Limits::default()).unwrap();
        let predicted = middle(analysis.growth_rate().unwrap());
        let centre = scene.equilibrium().unwrap();
        assert!(!scene.is_linear());
        let start: Vec<f64> = centre.iter().enumerate().map(|(i, x)| x + 1e-6 * (i as f64 - 0.4)).collect();
        for ends in [Ends::Symmetric, Ends::Staggered] {
            let mut run = scene.nonlinear_simulation(start.clone(), vec![0.0; start.len()]).unwrap().unwrap();
            let time = 2000.0 * to_f64(run.clocks().tick()) * run.clocks().period() as f64;
            let measured = avi::growth_rate(&mut run, centre, 1e-6, (4000, ends));
            // The shape turns with a collision's beat: its length changes by a factor of some units over the
            // time.
            let off = (measured - predicted).abs();
            assert!(off < 2e-5 * predicted + 4.0 / time, "{name} {ends:?}: {measured} {predicted}");
            assert!(predicted > 40.0 / time);
        }
    }
}

#[test]
fn clocks_with_pi_are_enclosed_about_exact_ones() {
    // Three clocks over Q[pi]: the trace that the file's answer encloses is the exact polynomial's value.
    let analysis = shipped("three-clocks").model().decide(Route::Cheapest, &Limits::default()).unwrap();
    let own = analysis.parts[0].oscillator.as_ref().unwrap();
    assert_eq!(own.strikes.len(), 3);
    let file = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/three-clocks.json"))
        .unwrap();
    let file: serde_json::Value = serde_json::from_str(&file).unwrap();
    let x = |text: &str| kickdrift::number::parse::parse("x", text).unwrap();
    let potentials = file["potentials"].as_array().unwrap();
    let step = |p: &serde_json::Value| x(p["step"].as_str().unwrap()).as_rational().unwrap();
    let first = step(&potentials[0]);
    let steps: Vec<_> = potentials.iter().map(|p| step(p) / &first).collect();
    let phases: Vec<_> =
        potentials.iter().map(|p| p["phase"].as_str().map_or(ratio(0, 1), |_| ratio(1, 2))).collect();
    let strength = |p: &serde_json::Value| {
        &x(p["springs"][0][2].as_str().unwrap()) * &Laurent::from_rational(&first * step(p))
    };
    let exact = ManyClocks::new(&steps, &phases, potentials.iter().map(strength).collect()).unwrap();
    let trace: Ball = exact.trace().enclosure(200);
    let difference = trace.sub(&own.trace, 200);
    assert!(difference.contains_zero(), "{:?} {:?}", trace.to_f64_enclosure(), own.trace.to_f64_enclosure());
    assert_eq!(exact.half_signs().verdict().kind(), analysis.kind.unwrap());
    assert_eq!(exact.label(), own.label);
    let m = own.label.unwrap() as i64;
    assert!(!own.families.is_empty());
    for family in &own.families {
        assert_eq!(family.iter().zip(&own.strikes).map(|(a, &n)| a * n as i64).sum::<i64>(), m);
    }
}

#[test]
fn the_unit_of_time_may_hold_pi() {
    let read = |mass: &str, k: [&str; 2], h: [&str; 2]| {
        let text = format!(
            r#"{{"schema": "kickdrift/system/1", "masses": ["{mass}"], "potentials": [
                {{"step": "{}", "springs": [[0, null, "{}"]]}}, {{"step": "{}", "stiffness": [["{}"]]}}]}}"#,
            h[0], k[0], h[1], k[1]
        );
        SystemScene::read(&text)
            .map(|scene| scene.model().decide(Route::Cheapest, &Limits::default()).unwrap())
    };
    // The same system in three units: h sqrt(K/m) is what counts.
    let one = read("1", ["11/4", "57/10"], ["1", "5/3"]).unwrap();
    let two = read("pi^2", ["11/4", "57/10"], ["pi", "5*pi/3"]).unwrap();
    let three = read("1", ["11/4*pi^2", "57/10*pi^2"], ["1/pi", "5/(3*pi)"]).unwrap();
    for other in [&two, &three] {
        assert_eq!((other.kind.unwrap(), one.kind.unwrap()), (Kind::Coexistence, Kind::Coexistence));
        assert_eq!(other.parts[0].evidence, Evidence::Scalar(Tier::Exact));
    }
    assert_eq!((two.period.to_string().as_str(), three.period.to_string().as_str()), ("5*pi", "5/pi"));
    let error = read("1", ["1", "1"], ["1", "pi"]).unwrap_err().to_string();
    assert!(error.starts_with("potentials[1].step = pi: its ratio to the step 1 is irrational"), "{error}");
    let error = read("-pi", ["1", "1"], ["1", "2"]).unwrap_err().to_string();
    assert!(error.starts_with("masses[0] = -pi: a mass must be positive"), "{error}");
    let error = read("1+pi", ["1", "1"], ["1", "2"]).unwrap_err().to_string();
    assert!(error.starts_with("masses[0] = "), "{error}");
}

/// A system of unit masses from its potentials.
fn of_unit_masses(n: usize, potentials: &str) -> Result<SystemScene, kickdrift::error::Error> {
    let masses = vec!["\"1\""; n].join(", ");
    SystemScene::read(&format!(
        r#"{{"schema": "kickdrift/system/1", "masses": [{masses}], "potentials": [{potentials}]}}"#
    ))
}

#[test]
fn stiffnesses_of_several_masses_may_hold_pi() {
    let decide = |n: usize, potentials: &str| {
        of_unit_masses(n, potentials).unwrap().model().decide(Route::Cheapest, &Limits::default()).unwrap()
    };
    // A = 1 − (K_1 + 2 K_2)/2 vanishes, whatever pi is: a tie.
    let scene = shipped("edge-pi");
    let edge = scene.source()["potentials"].to_string();
    let edge = edge.trim_matches(['[', ']']);
    let analysis = scene.model().decide(Route::Cheapest, &Limits::default()).unwrap();
    assert_eq!((analysis.kind, analysis.parts[0].evidence), (None, Evidence::Estimate));
    // A hair more or less of it: unstable and stable, proven in doubles.
    for (factor, kind) in [("1.00001", Kind::Hyperbolic), ("0.99999", Kind::Elliptic)] {
        let scaled = edge.replace(r#""step":"2""#, &format!(r#""step":"2","scale":"{factor}""#));
        assert_ne!(scaled, edge);
        let analysis = decide(2, &scaled);
        assert!(analysis.kind.unwrap() == kind && analysis.is_proof());
    }
    // One mass by itself, at Verlet's limit whatever pi is: its rational neighbour is no proof of it.
    let limit =
        decide(2, r#"{"step": "1", "springs": [[0, null, "4 + pi"], [0, null, "-pi"], [1, null, "pi/4"]]}"#);
    assert_eq!(limit.kind, None);
    // A rigid shift beside what vibrates.
    let chain = r#"{"step": "1/10", "springs": [[0, 1, "pi^2"], [1, 2, "pi^2"]]}, {"step": "3/10", "springs": [[0, 2, "1/pi"]]}"#;
    let analysis = decide(3, chain);
    assert_eq!(
        (analysis.rigid_modes.len(), analysis.parts.len(), analysis.kind),
        (1, 1, Some(Kind::Elliptic))
    );
    assert!(analysis.is_proof());
    let error =
        of_unit_masses(3, chain).unwrap().model().decide(Route::Exact, &Limits::default()).unwrap_err();
    assert!(error.to_string().contains("write them without pi"), "{error}");
    // A negative direction of all stiffnesses is told.
    let falls = decide(2, r#"{"step": "1/10", "springs": [[0, 1, "pi"], [1, null, "-1/pi"]]}"#);
    assert!(falls.is_unstable() && falls.warnings.iter().any(|own| own.contains("indefinite")));
    let rational = chain.replace("pi^2", "9.8696044").replace("1/pi", "0.31830989");
    let near = decide(3, &rational);
    // Stiffnesses with pi are not split into parts, which have shorter periods: all are compared over the
    // longest.
    let all = |of: &Analysis| {
        let longest = of.parts.iter().map(|part| part.period.to_f64()).fold(0.0, f64::max);
        let over_longest = |part: &Part, mu: f64| {
            let turn = (1.0 + 2.0 * mu).acos() * (longest / part.period.to_f64()).round();
            (turn.cos() - 1.0) / 2.0
        };
        let each = |part: &Part| {
            part.multipliers.iter().map(|own| over_longest(part, own.mu.re)).collect::<Vec<_>>()
        };
        let mut mu: Vec<f64> = of.parts.iter().flat_map(each).collect();
        mu.sort_by(f64::total_cmp);
        mu
    };
    let (own, near) = (all(&analysis), all(&near));
    // Seven digits of pi are left.
    assert!(own.len() == 2 && own.iter().zip(&near).all(|(a, b)| (a - b).abs() < 1e-6), "{own:?} {near:?}");
}

#[test]
fn what_pi_may_not_be_in_is_refused() {
    let refused = |potentials: &str| {
        let scene = of_unit_masses(2, potentials);
        scene
            .and_then(|scene| scene.model().decide(Route::Cheapest, &Limits::default()))
            .unwrap_err()
            .to_string()
    };
    for (potentials, message) in [
        (
            r#"{"step": "1", "stiffness": [["pi^2", "pi"], ["2*pi", "1"]]}"#,
            "potentials[0].stiffness[1][0] = 2*pi: differs",
        ),
        (r#"{"step": "1", "stiffness": [["pi^2", "pi"], ["pi"]]}"#, "potentials[0].stiffness[1] = 1 entries"),
        (r#"{"step": "1", "stiffness": [["pi^2"]]}"#, "potentials[0].stiffness = 1 x 1: there are 2"),
        (r#"{"step": "pi", "springs": [[0, 1, "pi"]]}"#, "potentials[0].step = pi: must be rational"),
        (r#"{"step": "1", "springs": [[0, 1, "pie"]]}"#, "potentials[0].springs[0] = "),
        (r#"{"step": "1", "springs": [[0, 1, "pi^100"]]}"#, "potentials[0].stiffness = pi^100: powers of pi"),
        // The vector (1, −pi).
        (
            r#"{"step": "1", "stiffness": [["pi^2", "pi"], ["pi", "1"]]}"#,
            "stiffness = all potentials have a null vector",
        ),
    ] {
        let error = refused(potentials);
        assert!(error.starts_with(message), "{error}\nexpected {message}");
    }
    let scene = of_unit_masses(2, r#"{"step": "1/2", "springs": [[0, 1, "pi"], [0, null, "1"]]}"#).unwrap();
    let error = scene
        .clone()
        .asked(None, false, Some(&ratio(1, 2)), None)
        .unwrap()
        .friction(&Limits::default())
        .unwrap_err();
    assert!(error.to_string().contains("friction on several degrees of freedom needs rational numbers"));
    assert!(scene.nearest_unstable(1e-3, &Limits::default()).is_err());
    // One outer step after another is no matter: 4/h² is passed between.
    let kinds = [ratio(1, 2), ratio(1, 1)]
        .map(|step| scene.model().decide_at(&step, &Limits::default()).unwrap().kind);
    assert_eq!(kinds, [Kind::Elliptic, Kind::Hyperbolic].map(Some));
}

#[test]
fn scans_vary_any_number_of_the_file() {
    let text =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/diatomic-tether.json"))
            .unwrap();
    let axis = |text: &str| text.parse::<Axis>().unwrap();
    let scene = SystemScene::read(&text).unwrap();
    let scan = Scan::new(
        scene.clone(),
        axis("potentials.tether.step=1/10..1:3/10"),
        Some(axis("potentials.0.scale=1/2..1:1/2")),
    )
    .unwrap();
    assert_eq!(scan.x.values(), [ratio(1, 10), ratio(4, 10), ratio(7, 10), ratio(1, 1)]);
    let system = scan.at(&ratio(7, 10), &ratio(1, 2)).unwrap();
    let clocks = system.model().system().clocks();
    assert_eq!((&clocks[1].step, clocks[0].stiffness.get(0, 0)), (&ratio(7, 10), ratio(25, 1)));
    // Points in parallel are those one by one.
    let decide = |x: &_, y: &_| scan.at(x, y)?.model().decide(Route::Cheapest, &Limits::default());
    let (xs, ys) = (scan.x.values(), scan.ys());
    let points = kickdrift::system::scan::scan(&xs, &ys, decide, || {}).unwrap();
    assert_eq!(points.len(), 8);
    for point in points {
        let alone = scan.at(&point.at.0, &point.at.1).unwrap();
        let alone = decide_system(alone.model().system(), &Limits::default()).unwrap();
        assert_eq!((point.kind, point.growth_rate), (alone.kind, alone.growth_rate()));
    }
    let refused = |text: &str, start: &str| {
        let error = text.parse::<Axis>().unwrap_err().to_string();
        assert!(error.starts_with(start), "{error}");
    };
    refused("potentials.1.step", "scan = potentials.1.step: write PATH=LO..HI:BY");
    refused("a=1..2:0", "scan = a=1..2:0: the spacing");
    refused("a=2..1:1", "scan = a=2..1:1: the range is empty");
    refused("a=0..1:1e-9", "scan = a=0..1:1e-9: at most");
    for (path, message) in [
        ("potentials.7.step", "scan = potentials.7.step: 7 is not in the file"),
        ("potentials.0.colour", "potentials[0] = this file: unknown field `colour`"),
        ("masses", "scan = masses: such a number is not in the file"),
    ] {
        let wrong = Scan::new(
            scene.clone(),
            axis(&format!("{path}=1..2:1")),
            Some(axis("potentials.0.scale=1..2:1")),
        );
        let error = wrong.map(|_| ()).unwrap_err().to_string();
        assert!(error.starts_with(message), "{error}");
    }
}

#[test]
fn hessians_are_taken_at_the_equilibrium() {
    let scene = shipped("lennard-jones");
    let x = scene.equilibrium().unwrap();
    assert!((x[1] - 2f64.powf(1.0 / 6.0)).abs() < 1e-12);
    let curvature = to_f64(&scene.model().system().clocks()[0].stiffness.get(0, 1));
    assert!((curvature + 72.0 / 2f64.powf(1.0 / 3.0)).abs() < 1e-9);
    let mut run = scene.nonlinear_simulation(x.to_vec(), vec![0.0; 2]).unwrap().unwrap();
    let samples = avi::series(&mut run, x, 50, (1000, Ends::Symmetric));
    // It stays at its equilibrium but for roundoff.
    assert!(samples.iter().all(|s| s.amplitude < 1e-10));
}

#[test]
fn springs_and_matrices_say_the_same() {
    let read = |potential: &str| {
        let text = format!(
            r#"{{"schema": "kickdrift/system/1", "masses": [1, "3/2"], "potentials": [{{"step": "0.25", {potential}}}]}}"#
        );
        SystemScene::read(&text).unwrap().model().system().clocks()[0].stiffness.clone()
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
            format!(r#"{masses}, "potentials": [{{"step": true, "springs": [[0, 1, "1"]]}}]"#),
            "potentials[0].step = true: write an exact number",
        ),
        (
            format!(r#"{masses}, "potentials": [{{"step": "1", "springs": [[-1, 1, "1"]]}}]"#),
            "potentials[0].springs[0] = -1: indices are 0 to 1",
        ),
        (
            format!(r#"{masses}, "potentials": [{{"step": "1", "springs": [[1, 1, "1"]]}}]"#),
            "potentials[0].springs[0] = 1: joins two different indices",
        ),
        (
            format!(r#"{masses}, "potentials": [{{"step": "1", "bonds": [{{"i": 1, "j": 1, "form": "harmonic", "k": 1}}]}}]"#),
            "potentials[0].bonds[0] = 1: joins two different indices",
        ),
        (
            format!(r#"{masses}, "potentials": [{{"step": "1", "phase": "1/3", "springs": [[0, 1, "1"]]}}]"#),
            "potentials[0].phase = 1/3: must be 0 or 1/2",
        ),
        (
            format!(r#"{masses}, "potentials": [{{"step": "1", "stiffness": [["1", "2"], ["2"]]}}]"#),
            "potentials[0].stiffness[1] = 1 entries",
        ),
        (
            r#""mass_matrix": [["1", "2"], ["2", "1"]], "potentials": [{"step": "1", "springs": [[0, 1, "1"]]}]"#.to_string(),
            "masses = the mass matrix: must be positive definite",
        ),
        (
            r#""mass_matrix": [["1", "2"], ["3", "9"]], "potentials": [{"step": "1", "springs": [[0, 1, "1"]]}]"#.to_string(),
            "mass_matrix[1][0] = 3: differs",
        ),
        (
            r#""masses": ["1", "0"], "potentials": [{"step": "1", "springs": [[0, 1, "1"]]}]"#.to_string(),
            "masses[1] = 0: a mass must be positive",
        ),
        (
            r#""masses": ["pi"], "potentials": [{"step": "1", "springs": [[0, 1, "1"]]}]"#.to_string(),
            "potentials[0].springs[0] = 1: indices are 0 to 0",
        ),
        (
            r#""build": {"kind": "chain", "masses": "1/2", "stiffness": [1], "steps": [1]}"#.to_string(),
            "build.masses = 1/2: write a whole number",
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

/// The program on a line of arguments.
fn kickdrift(line: &str) -> std::process::Output {
    std::process::Command::new(env!("CARGO_BIN_EXE_kickdrift"))
        .args(line.split_whitespace())
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap()
}

#[test]
fn maps_are_the_same_bytes_whatever_the_threads() {
    let folder = tempfile::tempdir().unwrap();
    let scan = "system data/scenes/fpu-quartic.json --scan potentials.soft.step=1/2..1:1/40 \
                --scan potentials.soft.scale=1/2..2:1/4";
    let written = |threads: usize, name: &str| {
        let path = folder.path().join(format!("{threads}-{name}"));
        let output = kickdrift(&format!("{scan} --threads {threads} --output {}", path.display()));
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        std::fs::read(path).unwrap()
    };
    for name in ["map.csv", "map.json", "map.svg"] {
        assert_eq!(written(1, name), written(2, name), "{name}");
    }
    let rows = String::from_utf8(written(1, "map.csv")).unwrap();
    assert!(
        rows.starts_with("x,y,kind,proven,growth_rate_lo,growth_rate_hi\r\n1/2,1/2,elliptic,true,0.0,0.0"),
        "{rows}"
    );
    assert!(rows.contains("11/20,1,hyperbolic,true,0.0665734"), "{rows}");
}

#[test]
fn a_scan_of_one_number_has_one_axis() {
    let output =
        kickdrift("system data/scenes/diatomic-tether.json --scan potentials.tether.step=19/10..21/10:1/10");
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let rows = answer["verdicts"].as_array().unwrap();
    let told: Vec<_> = rows.iter().map(|row| (row["x"].as_str(), row["kind"].as_str())).collect();
    let expected = [("19/10", "elliptic"), ("2", "hyperbolic"), ("21/10", "elliptic")];
    assert_eq!(told, expected.map(|(x, kind)| (Some(x), Some(kind))));
    assert!(rows.iter().all(|row| row.get("y").is_none()));
}

#[test]
fn modes_are_drawn_and_flags_that_do_nothing_refused() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["modes.svg", "modes.png"] {
        let path = folder.path().join(name);
        let output = kickdrift(&format!("system data/scenes/bar-resonant.json --output {}", path.display()));
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let bytes = std::fs::read(path).unwrap();
        assert!(bytes.starts_with(b"<svg") || bytes[1..].starts_with(b"PNG"), "{name}");
    }
    for (line, message) in [
        ("system data/scenes/fpu.json --colour growth", "--colour = given: is for maps"),
        (
            "system data/scenes/fpu.json --scan build.stiff=1..2:1 --scan build.soft=1..2:1 --scan build.pairs=1..2:1",
            "--scan = given 3 times: a map has two axes",
        ),
        ("system data/scenes/ring24.json --exact --budget 10", "exact arithmetic on 23 degrees of freedom"),
        ("simulate data/scenes/fpu.json --displace 0", "displace = 0: nothing would move"),
    ] {
        let output = kickdrift(line);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{line}");
        assert!(error.contains(message), "{error}");
    }
}

/// The program on a system that is written to a file of its own.
fn on_a_file(system: &str, command: &str, flags: &str) -> (Option<i32>, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("system.json");
    std::fs::write(&path, system).unwrap();
    let output = kickdrift(&format!("{command} {} {flags}", path.display()));
    let text =
        String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    (output.status.code(), text)
}

#[test]
fn a_stiffness_with_pi_beyond_doubles_is_decided_and_not_a_panic() {
    for (stiffness, verdict) in [("pi^2/1e400", "stable: elliptic"), ("pi^2*1e400", "unstable: hyperbolic")] {
        let system = format!(
            r#"{{"schema": "kickdrift/system/1", "masses": ["1"], "potentials": [
                {{"step": "1/10", "stiffness": [["{stiffness}"]]}}, {{"step": "1/4", "stiffness": [["2"]]}}]}}"#
        );
        let (code, text) = on_a_file(&system, "system", "");
        assert_eq!(code, Some(0), "{text}");
        assert!(text.starts_with(verdict), "{text}");
        let (code, text) = on_a_file(&system, "simulate", "--periods 3");
        assert!(code == Some(0) || code == Some(2), "{text}");
        assert!(!text.contains("panicked"), "{text}");
    }
}

#[test]
fn cancelling_potentials_are_no_rigid_mode() {
    let system = r#"{"schema": "kickdrift/system/1", "masses": ["1"], "potentials": [
        {"step": "1", "stiffness": [["4"]]}, {"step": "1", "stiffness": [["-4"]]}]}"#;
    let (_, text) = on_a_file(system, "system", "");
    assert!(text.starts_with("unstable: parabolic (proven)") && !text.contains("rigid"), "{text}");
    assert!(text.contains("  1 degree of freedom, 1 clock, period T = 1"), "{text}");
}

#[test]
fn long_periods_are_refused_with_their_cost_and_allowed_by_a_budget() {
    let scene = |name: &str, from: &str, to: &str| {
        let text =
            std::fs::read_to_string(format!("{}/data/scenes/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap();
        assert!(text.contains(from), "{name} has no {from}");
        text.replacen(from, to, 1)
    };
    let long = scene("diatomic-tether.json", "\"3/10\"", "\"3/4294967296\"");
    for command in ["system", "simulate"] {
        let (code, text) = on_a_file(&long, command, "");
        assert_eq!(code, Some(2), "{text}");
        assert!(
            text.contains("products of machine words, up to some ")
                && text.contains(" s, the limit is 5.0e10"),
            "{text}"
        );
    }
    let (_, fine) = on_a_file(&scene("fpu.json", "2500", "2500"), "system", "--budget 1");
    assert!(fine.contains("the limit is 1.0e0"), "{fine}");
    let (code, text) =
        on_a_file(&scene("fpu.json", "2500", "2500"), "simulate", "--periods 1000000 --budget 100000");
    assert!(code == Some(2) && text.contains("1000000 periods of"), "{text}");
}

/// Bonds, angles and the rest of four waters, each on a clock of its own: margin, first unstable step and the
/// verdict within the accuracy are those that advice has.
#[test]
fn a_system_on_three_clocks_stands_as_far_as_the_advice_on_it_says() {
    let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes"));
    let text = std::fs::read_to_string(folder.join("water4-levels.json")).unwrap();
    let scene = SystemScene::read_in(folder, &text).unwrap();
    let levels = scene.model().measured().unwrap().levels().unwrap();
    let steps = scene.model().steps();
    let advised = levels.source.decide(&steps, levels.accuracy).unwrap();
    let found = scene.model().decide(Route::Cheapest, &Limits::default()).unwrap();
    let measured = found.measured.as_ref().unwrap();
    assert!(found.is_stable() && measured.holds == Holds::Stable && !measured.is_above_unstable);
    assert!(measured.margin.is_some_and(|margin| margin > 1e-5) && measured.margin == advised.margin);
    assert_eq!((measured.holds, measured.accuracy), (advised.holds, levels.accuracy));
    assert!(measured.first_unstable.is_some());
    assert_eq!(measured.first_unstable, levels.source.at(&steps).unwrap().first_unstable());
    assert_eq!(measured.removed.as_ref().map(|removed| removed.count), Some(6));
    // Known to a hundredth only, it is not proven of all.
    let roughly = scene.clone().asked(Some(1e-2), false, None, None).unwrap();
    let roughly = roughly.model().decide(Route::Cheapest, &Limits::default()).unwrap();
    assert_eq!(roughly.measured.as_ref().unwrap().holds, Holds::Undecided);
    assert_eq!((roughly.within(0.0), roughly.within(1.0)), (Holds::Stable, Holds::Undecided));
    // Above the first unstable step.
    let (_, hi) = measured.first_unstable.unwrap();
    let axis: Axis = format!("outer={}..{}:1", 1.01 * hi, 1.01 * hi).parse().unwrap();
    let above = Scan::new(scene, axis.clone(), None).unwrap().at(&axis.lo, &axis.lo).unwrap();
    let above = above.model().decide(Route::Cheapest, &Limits::default()).unwrap();
    assert!(above.measured.as_ref().unwrap().is_above_unstable);
}

/// Bonds, angles and the rest on a clock each, at steps where four pairs and more of multipliers are off the
/// circle and none of them is real.
#[test]
fn where_pairs_leave_the_circle_together_stretches_are_proven_for_measured_levels() {
    let name = "data/scenes/water4-levels.json";
    let scene =
        SystemScene::read_in(std::path::Path::new("data/scenes"), &std::fs::read_to_string(name).unwrap());
    let scene = scene.unwrap();
    let (lo, hi) = (5.5e-3, 5.6e-3);
    let asked = format!("outer={lo}..{hi}");
    let found = scene.intervals(&asked.parse().unwrap(), 1e-4, &Limits::default()).unwrap();
    let (mut open, mut unstable) = (0.0, 0);
    for own in &found.stretches {
        if own.verdict == Holds::Undecided {
            open += own.hi - own.lo;
            continue;
        }
        let middle = from_f64_exact(own.lo + (own.hi - own.lo) / 2.0).unwrap();
        let truth = scene.model().decide_at(&middle, &Limits::default()).unwrap();
        assert!(truth.is_proof() && truth.is_stable() == (own.verdict == Holds::Stable), "{middle}");
        unstable += usize::from(own.verdict == Holds::Unstable);
    }
    // Discs of kicks in one scale left all of it open; what is left are changes of the pairs that grow.
    assert!(unstable > 0 && open < 0.1 * (hi - lo), "{:?}", found.stretches);
}

#[test]
fn intervals_of_any_number_cover_their_range_and_each_point_agrees_with_its_own_verdict() {
    let shipped = shipped("diatomic-tether");
    for (text, path) in [
        ("outer=3/10..173/500", "outer"),
        ("potentials.0.scale=1..133/100", "potentials.0.scale"),
        ("potentials.bond.springs.0.2=60..133/2", "potentials.bond.springs.0.2"),
        ("masses.0=67/100..1", "masses.0"),
    ] {
        let found = shipped.intervals(&text.parse().unwrap(), 1e-3, &Limits::default()).unwrap();
        let all = &found.stretches;
        // An edge lies between two neighbouring doubles, and nothing is left open.
        assert!(all.windows(2).all(|pair| pair[0].hi.next_up() == pair[1].lo), "{text}: {all:?}");
        let is = |verdict| all.iter().filter(|own| own.verdict == verdict).count();
        let seen = (is(Holds::Stable), is(Holds::Unstable), is(Holds::Undecided));
        assert_eq!(seen, (1, 1, 0), "{text}: {all:?}");
        if let Some((lo, hi)) = found.first_unstable() {
            assert!(hi == lo.next_up(), "{text}: {lo} to {hi}");
        }
        for own in all {
            for part in [0.01, 0.5, 0.99] {
                let value = from_f64_exact(own.lo + part * (own.hi - own.lo)).unwrap();
                let mut file = shipped.source().clone();
                if path == "outer" {
                    file["potentials"][0]["step"] = (&value / ratio(3, 1)).to_string().into();
                    file["potentials"][1]["step"] = value.to_string().into();
                } else {
                    let pointer = format!("/{}", path.replace("bond", "0").replace('.', "/"));
                    match file.pointer_mut(&pointer) {
                        Some(place) => *place = value.to_string().into(),
                        None => file["potentials"][0]["scale"] = value.to_string().into(),
                    }
                }
                let scene = SystemScene::from_json_in("", file).unwrap();
                let analysis = scene.model().decide(Route::Cheapest, &Limits::default()).unwrap();
                assert_eq!(analysis.is_stable(), own.verdict == Holds::Stable, "{text} at {value}");
            }
        }
    }
    let steps = shipped
        .intervals(&"potentials.tether.step=1/10..3".parse().unwrap(), 1e-4, &Limits::default())
        .unwrap();
    assert_eq!(steps.first_unstable(), Some((2.0, 2.0)));
    for (text, message) in [
        ("outer", "intervals = outer: write PATH=LO..HI"),
        ("masses.0=2..2", "intervals = masses.0=2..2: the range is empty"),
    ] {
        let error = text.parse::<Span>().unwrap_err().to_string();
        assert!(error.starts_with(message), "{error}");
    }
    for (text, message) in [
        ("potentials.0.phase=1..2", "intervals = potentials.0.phase: name outer"),
        ("outer=0..1", "intervals = outer=0..1: steps are positive"),
        ("potentials.9.scale=1..2", "intervals = potentials.9.scale: 9 is not in the file"),
    ] {
        let asked = shipped.intervals(&text.parse().unwrap(), 1e-2, &Limits::default());
        let error = asked.unwrap_err().to_string();
        assert!(error.starts_with(message), "{error}");
    }
}

/// Arrays in memory by their names, and a system of these with more fields.
fn held(
    arrays: &[(&str, &[usize], Vec<f64>)],
    more: serde_json::Value,
) -> kickdrift::error::Result<SystemScene> {
    let array = |(name, shape, values): &(&str, &[usize], Vec<f64>)| {
        (name.to_string(), Array::new(shape.to_vec(), values.clone()).unwrap())
    };
    let arrays = Arrays::Held(std::sync::Arc::new(arrays.iter().map(array).collect()));
    let mut source = serde_json::json!({"schema": "kickdrift/system/1"});
    more.as_object().unwrap().iter().for_each(|(key, value)| source[key] = value.clone());
    SystemScene::from_json_in(arrays, source)
}

/// Four particles off all axes, and the stiffness of unit springs between these pairs, not mass-weighted.
const CORNERS: [[f64; 3]; 4] = [[0.0, 0.1, 0.2], [1.1, 0.3, -0.1], [0.2, 0.9, 0.4], [0.3, 0.2, 1.3]];

fn springs(pairs: &[(usize, usize)]) -> Vec<f64> {
    let mut k = vec![0.0; 144];
    for &(i, j) in pairs {
        let apart = [0, 1, 2].map(|a| CORNERS[i][a] - CORNERS[j][a]);
        let square: f64 = apart.iter().map(|x| x * x).sum();
        for (a, b) in (0..3).flat_map(|a| (0..3).map(move |b| (a, b))) {
            let own = apart[a] * apart[b] / square;
            k[(3 * i + a) * 12 + 3 * i + b] += own;
            k[(3 * j + a) * 12 + 3 * j + b] += own;
            k[(3 * i + a) * 12 + 3 * j + b] -= own;
            k[(3 * j + a) * 12 + 3 * i + b] -= own;
        }
    }
    k
}

/// The springs in three potentials, of these steps.
fn tetrahedron(steps: [&str; 3], more: serde_json::Value) -> kickdrift::error::Result<SystemScene> {
    let pairs: [&[(usize, usize)]; 3] = [&[(0, 1), (1, 2)], &[(0, 2), (2, 3)], &[(0, 3), (1, 3)]];
    let names = ["a", "b", "c"];
    let mut arrays: Vec<(&str, &[usize], Vec<f64>)> = vec![
        ("masses", &[4], vec![1.0, 2.0, 3.0, 1.5]),
        ("positions", &[4, 3], CORNERS.as_flattened().to_vec()),
    ];
    arrays.extend(names.iter().zip(pairs).map(|(name, pairs)| (*name, &[12, 12][..], springs(pairs))));
    let potential =
        |(name, step): (&&str, &str)| serde_json::json!({"step": step, "stiffness": {"npy": name}});
    let potentials: Vec<_> = names.iter().zip(steps).map(potential).collect();
    let mut fields = serde_json::json!({"masses": {"npy": "masses"}, "potentials": potentials});
    more.as_object().unwrap().iter().for_each(|(key, value)| fields[key] = value.clone());
    held(&arrays, fields)
}

#[test]
fn three_clocks_have_their_rigid_motions_projected_out_as_two_have() {
    let positions = serde_json::json!({"positions": {"npy": "positions"}});
    let limits = Limits::default();
    for (steps, stable) in [(["1/8", "1/4", "1/2"], true), (["1/2", "1", "2"], false)] {
        let scene = tetrahedron(steps, positions.clone()).unwrap();
        let analysis = scene.model().decide(Route::Cheapest, &limits).unwrap();
        assert!(analysis.is_proof() && analysis.is_stable() == stable, "{steps:?} {:?}", analysis.kind);
        let removed = analysis.measured.as_ref().unwrap().removed.as_ref().unwrap();
        assert_eq!((removed.count, removed.found_by), (6, "positions"));
        // Twelve coordinates, six multipliers; shapes without the centre of mass, in the coordinates given.
        let count: usize = analysis.parts.iter().map(|part| part.multipliers.len()).sum();
        assert_eq!((analysis.size, count), (12, 6));
        for own in analysis.parts.iter().flat_map(|part| &part.instabilities) {
            let momentum: f64 = (0..4).map(|i| own.shape[3 * i] * [1.0_f64, 2.0, 3.0, 1.5][i].sqrt()).sum();
            assert!(own.shape.len() == 12 && momentum.abs() < 1e-12, "{momentum}");
        }
    }
    // By the null space as well, and two clocks as before.
    let bare = tetrahedron(["1/8", "1/4", "1/2"], serde_json::json!({})).unwrap();
    let bare = bare.model().decide(Route::Cheapest, &limits).unwrap();
    assert!(bare.is_proof() && bare.is_stable());
    assert_eq!(bare.measured.unwrap().removed.unwrap().found_by, "common null space");
    let two = tetrahedron(["1/8", "1/8", "1/4"], positions)
        .unwrap()
        .model()
        .decide(Route::Cheapest, &limits)
        .unwrap();
    assert_eq!(two.measured.unwrap().removed.unwrap().count, 6);
}

/// A fast frequency is beyond the inner step's own limit, where discs reach as far as the polynomials grow
/// there.
#[test]
fn the_neighbours_of_a_stable_step_do_not_hold_it_and_end_where_a_mode_is_at_rest_at_kicks() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/input");
    let text = std::fs::read_to_string(folder.join("own.json")).unwrap();
    let scene = SystemScene::read_in(Arrays::from(&folder), &text).unwrap();
    let found = scene.nearest_unstable(1e-4, &Limits::default()).unwrap();
    assert!(found.number == 7.5 && found.own.is_none(), "{found:?}");
    let (below, above) = (found.below.unwrap().proven, found.above.unwrap().proven);
    // The dense period grows at both, and is still at 7.5, between 6.0 and 8.09, and above 6 √2, where six
    // inner steps turn the fast mode by 3 π.
    assert!((5.71..5.72).contains(&below.0) && (5.99..6.0001).contains(&below.1), "{below:?}");
    assert!((8.09..8.10).contains(&above.0) && (above.1 - 72f64.sqrt()).abs() < 1e-6, "{above:?}");
}

/// ln ρ/T of whole kicks and drifts with v → exp(−γ t) v in their middle, steps 1/2, 1 and 2, rigid motions
/// apart.
fn damped_growth_of_the_tetrahedron(rate: f64) -> f64 {
    let pairs: [&[(usize, usize)]; 3] = [&[(0, 1), (1, 2)], &[(0, 2), (2, 3)], &[(0, 3), (1, 3)]];
    let masses = [1.0_f64, 2.0, 3.0, 1.5];
    let weighted = |pairs: &[(usize, usize)]| {
        let k = springs(pairs);
        DMatrix::from_fn(12, 12, |i, j| k[12 * i + j] / (masses[i / 3] * masses[j / 3]).sqrt())
    };
    let stiffness = pairs.map(weighted);
    let mut period = DMatrix::<f64>::identity(24, 24);
    let (tick, decay) = (0.5, (-0.5 * rate).exp());
    for k in 0..4 {
        for (own, every) in stiffness.iter().zip([1, 2, 4]).filter(|(_, every)| k % every == 0) {
            let change = own * period.rows(0, 12) * (tick * f64::from(every));
            period.rows_mut(12, 12).zip_apply(&change, |v, dv| *v -= dv);
        }
        for half in 0..2 {
            let change = period.rows(12, 12) * (tick / 2.0);
            period.rows_mut(0, 12).zip_apply(&change, |x, dx| *x += dx);
            if half == 0 {
                period.rows_mut(12, 12).apply(|v| *v *= decay);
            }
        }
    }
    // Six rigid motions stay where they are.
    let multipliers = faer::Mat::from_fn(24, 24, |i, j| period[(i, j)]).eigenvalues().unwrap();
    let is_rigid = |x: &&faer::c64| (*x - 1.0).norm() < 1e-6;
    assert_eq!(multipliers.iter().filter(is_rigid).count(), 6, "{multipliers:?}");
    let apart = multipliers.iter().filter(|x| !is_rigid(x)).map(|x| x.norm());
    apart.fold(0.0, f64::max).ln() / 2.0
}

#[test]
fn friction_on_measured_stiffnesses_of_three_clocks_is_that_of_the_plain_product() {
    let positions = serde_json::json!({"positions": {"npy": "positions"}});
    let scene = tetrahedron(["1/2", "1", "2"], positions).unwrap();
    let mut signs = Vec::new();
    for (rate, rounded) in [(ratio(1, 100), 0.01), (ratio(5, 1), 5.0)] {
        let found = scene.model().friction(&rate, &Limits::default()).unwrap();
        let ((lo, hi), plain) = (found.growth.unwrap(), damped_growth_of_the_tetrahedron(rounded));
        assert!(lo - 1e-9 <= plain && plain <= hi + 1e-9 && hi - lo < 1e-6, "{lo} {plain} {hi}");
        signs.push(found.damping.unwrap());
    }
    assert_eq!(signs[0], Damping::Growing, "without friction it grows");
}

#[test]
fn a_null_space_larger_than_that_of_rigid_motions_is_refused() {
    // A chain of three springs: three directions of twelve are stiff.
    let chain = |more: serde_json::Value| {
        let arrays: [(&str, &[usize], Vec<f64>); 3] = [
            ("masses", &[4], vec![1.0; 4]),
            ("positions", &[4, 3], CORNERS.as_flattened().to_vec()),
            ("k", &[12, 12], springs(&[(0, 1), (1, 2), (2, 3)])),
        ];
        let potentials = serde_json::json!([{"step": "1/4", "stiffness": {"npy": "k"}}]);
        let mut fields = serde_json::json!({"masses": {"npy": "masses"}, "potentials": potentials});
        more.as_object().unwrap().iter().for_each(|(key, value)| fields[key] = value.clone());
        held(&arrays, fields)?.model().decide(Route::Cheapest, &Limits::default())
    };
    let error = chain(serde_json::json!({})).unwrap_err().to_string();
    assert!(
        error.starts_with("total stiffness = zero within 1.0e-6 of the norms in 9 directions: "),
        "{error}"
    );
    assert!(error.contains("rigid motions are at most 6"), "{error}");
    let by_positions = chain(serde_json::json!({"positions": {"npy": "positions"}})).unwrap();
    assert_eq!(by_positions.measured.unwrap().removed.unwrap().count, 6);
    // In a box three translations, which need no positions.
    for more in [serde_json::json!({}), serde_json::json!({"positions": {"npy": "positions"}})] {
        let mut more = more;
        more["periodic"] = true.into();
        let removed = chain(more).unwrap().measured.unwrap().removed.unwrap();
        assert_eq!((removed.count, removed.found_by), (3, "periodic box"));
        assert!(removed.held.iter().all(|part| *part < 1e-15), "{:?}", removed.held);
    }
    // Springs to all corners and a coarse accuracy: soft is not rigid.
    let coarse = serde_json::json!({"accuracy": 0.09});
    let error = tetrahedron(["1/8", "1/8", "1/4"], coarse)
        .unwrap()
        .model()
        .decide(Route::Cheapest, &Limits::default());
    let found = error.map(|own| own.measured.unwrap().removed.unwrap().count);
    assert!(found.is_err() || found.unwrap() == 6);
}

#[test]
fn numbers_that_are_not_finite_are_refused_where_they_stand() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for (name, at, message) in [
            ("positions", 7, "positions of atom 2 (from 0), y = "),
            ("masses", 3, "masses[3] = "),
            ("k", 14, "potentials[0].stiffness[1, 2] = "),
            ("force", 5, "potentials[0].force[5] = "),
        ] {
            let mut arrays: [(&str, &[usize], Vec<f64>); 4] = [
                ("masses", &[4], vec![1.0, 12.0, 12.0, 1.0]),
                ("positions", &[4, 3], CORNERS.as_flattened().to_vec()),
                ("k", &[12, 12], springs(&[(0, 1), (1, 2), (2, 3)])),
                ("force", &[12], vec![0.0; 12]),
            ];
            arrays.iter_mut().find(|own| own.0 == name).unwrap().2[at] = bad;
            let fields = serde_json::json!({
                "masses": {"npy": "masses"}, "positions": {"npy": "positions"}, "constraints": "h-bonds",
                "potentials": [{"step": "1/4", "stiffness": {"npy": "k"}, "force": {"npy": "force"}}]
            });
            let error = held(&arrays, fields).unwrap_err().to_string();
            assert!(error.starts_with(message) && error.ends_with("every number must be finite"), "{error}");
        }
    }
}

#[test]
fn what_is_no_reference_is_said_in_words_of_its_own() {
    for (fields, message) in [
        (
            serde_json::json!({"masses": {"npz": "a"}, "potentials": [{"step": "1", "stiffness": {"npy": "k"}}]}),
            "masses = this file: {\"npz\":\"a\"} names no array: write {\"npy\"",
        ),
        (
            serde_json::json!({"potentials": [{"step": "1", "stiffness": {"npy": 3}}]}),
            "potentials[0].stiffness = this file: {\"npy\":3} names no array",
        ),
        (
            serde_json::json!({"constraints": 5, "potentials": [{"step": "1", "stiffness": {"npy": "k"}}]}),
            "constraints = this file: 5 are no constraints: write \"h-bonds\"",
        ),
    ] {
        let error = held(&[], fields).unwrap_err().to_string();
        assert!(error.starts_with(message) && !error.contains("untagged"), "{error}");
    }
}

#[test]
fn a_key_that_stands_twice_in_a_file_is_an_error_and_a_byte_order_mark_is_none() {
    let text = r#"{"schema": "kickdrift/system/1", "masses": ["1"],
        "potentials": [{"step": "1", "step": "2", "springs": [[0, null, "1"]]}]}"#;
    let error = SystemScene::read(text).unwrap_err().to_string();
    assert!(error.contains("line 2") && error.contains("the key \"step\" stands twice"), "{error}");
    let once = text.replace(r#""step": "2", "#, "");
    assert!(SystemScene::read(&format!("\u{feff}{once}")).is_ok());
    let error = SystemScene::read(&once.replace("\"step\"", "\"st\u{202e}ep\"")).unwrap_err().to_string();
    assert!(error.contains("st\\u{202e}ep"), "{error}");
    let scene =
        kickdrift::question::Scene::from_json(r#"{"schema": "a", "schema": "b"}"#).unwrap_err().to_string();
    assert!(scene.contains("the key \"schema\" stands twice"), "{scene}");
}

#[test]
fn heavy_hydrogens_are_held_as_the_pairs_that_they_are() {
    let with = |constraints: serde_json::Value| {
        let arrays: [(&str, &[usize], Vec<f64>); 4] = [
            ("masses", &[4], vec![1.0, 12.0, 14.0, 1.0]),
            ("positions", &[4, 3], CORNERS.as_flattened().to_vec()),
            ("k", &[12, 12], springs(&[(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)])),
            ("force", &[12], vec![0.0; 12]),
        ];
        let fields = serde_json::json!({
            "masses": {"npy": "masses"}, "positions": {"npy": "positions"}, "constraints": constraints, "hydrogen_mass": "3.024",
            "potentials": [{"step": "1/4", "stiffness": {"npy": "k"}, "force": {"npy": "force"}}]
        });
        let analysis = held(&arrays, fields)?.model().decide(Route::Cheapest, &Limits::default())?;
        Ok::<_, kickdrift::error::Error>((analysis.parts[0].multipliers.clone(), analysis.measured))
    };
    // Both are nearest to particle 2.
    let named = with(serde_json::json!("h-bonds")).unwrap();
    assert_eq!(named, with(serde_json::json!([[0, 2], [3, 2]])).unwrap());
    assert_eq!(named.1.unwrap().removed.unwrap().count, 8);
    assert_ne!(named.0, with(serde_json::json!([[0, 1], [3, 2]])).unwrap().0);
}
