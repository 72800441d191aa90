//! What the program writes and reads is what data/schema says.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

use kickdrift::question::Scene;
use kickdrift::scene::{Array, Arrays, SystemFile, SystemScene};
use serde_json::{Value, json};

#[path = "schema/validator.rs"]
mod validator;
use validator::Validator;

fn data(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(folder);
    let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut paths: Vec<PathBuf> =
        paths.filter(|path| path.extension().is_some_and(|e| e == "json")).collect();
    paths.sort();
    assert!(!paths.is_empty());
    paths
}

fn read(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// The schema of `kickdrift/NAME/1`.
fn schema(name: &str) -> Value {
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("data/schema/{name}.json")))
}

fn validator(name: &str) -> Validator {
    Validator::new(schema(name)).unwrap()
}

/// The NAME by which a document calls itself.
fn name(document: &Value) -> String {
    let schema = document["schema"].as_str().unwrap();
    schema.strip_prefix("kickdrift/").and_then(|rest| rest.strip_suffix("/1")).unwrap().to_string()
}

/// Valid, or all that is wrong.
fn check(document: &Value) {
    let wrong = validator(&name(document)).errors(document);
    assert!(wrong.is_empty(), "{}\n{}", wrong.join("\n"), document["input"]);
}

/// What a command prints as JSON.
fn output(line: &str) -> Value {
    let output = Command::new(env!("CARGO_BIN_EXE_kickdrift"))
        .args(line.split_whitespace())
        .args(["--format", "json"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// One line for every shape that a command's answer can take.
const LINES: &[&str] = &[
    "verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 1/100 --h2 0.98",
    "verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 1/100 --h2 1/2",
    "verdict --lambda1 11/4 --lambda2 57/10 --h1 1 --h2 5/3",
    "verdict --lambda1 1 --lambda2 1/10 --h1 1 --h2 3",
    "verdict --lambda1 10 --lambda2 2/5 --h1 0.631 --h2 3.499 --exact",
    "verdict --lambda1 1 --lambda2 1e400 --h1 1 --h2 1",
    "verdict --lambda1 1 --lambda2 -5 --h1 pi/4 --h2 pi",
    "verdict --lambda1 3*pi^2-pi+1/2 --lambda2 1/pi --h1 1/9 --h2 1/7",
    "curves",
    "curves --lambda1 10 --a -3..5 --b -4..4 --samples 7 --h1-range 0..1 --h2-range 1..2",
    "curves --a 1..1 --b 5..5",
    "compare --max-sum 8 --rho 1/25 --samples 20",
    "compare --lambda1 16 --lambda2 16/25 --step 1/10 --h1-range 1/10..3/5 --h2-range 1/10..2",
    "compare --methods respa-4,implicit-explicit,molly-long,gautschi --lambda1 pi^2/25 --h-range 0..16 --h-step 1/2 --rho-range 0..1/4 --rho-step 1/16",
    "compare --methods forest-ruth,velocity-verlet --by-cost --h-range 0..4 --h-step 1/10",
    "proposition --max 7",
    "polynomial --ratio 7/4",
    "polynomial --ratio 1",
    "half --ratio 5/3 --s 11/4 --rho -1/25",
    "map --label --growth --lambda1 10 --lambda2 -2/5 --step 1/10 --h1-range 1/10..1/2 --h2-range 1/10..3",
    "map --lambda1 pi^2 --lambda2 pi^2/25 --step1 1/10 --step2 1/7 --h1-range 1/10..2/pi --h2-range 1/20..7/2",
    "system data/scenes/diatomic-tether.json",
    "simulate data/scenes/diatomic-tether.json --periods 5",
    "simulate data/scenes/lennard-jones.json --periods 5",
    "simulate data/scenes/bar-resonant.json --periods 5 --staggered",
    "verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 1/100 --h2 0.98 --friction 1/2",
    "system data/scenes/two-bars.json --friction 1/10",
    "system data/scenes/tension.json --friction 1/2",
    "simulate data/scenes/tension.json --periods 20",
    "system data/scenes/three-clocks.json",
    "system data/scenes/bar-resonant.json",
    "system data/scenes/water4.json --accuracy 1e-7 --friction 1",
    "system data/scenes/water4.json --method molly-short",
    "system data/scenes/water4-orbit.json",
    "system data/scenes/water4.json --method implicit-explicit --intervals outer=1/100..1/70 --resolution 1e-3",
    "system data/scenes/two-bars.json --nearest --resolution 1e-3",
    "system data/scenes/no-gradient.json",
    "system data/scenes/local-steps.json",
    "system data/scenes/local-steps.json --intervals outer=1..5/2",
    "system data/scenes/bar-avi.json",
    "system data/scenes/membrane.json",
    "system data/scenes/water4.json --intervals outer=0.0043..0.0045 --resolution 1e-3",
    "system data/scenes/diatomic-tether.json --intervals masses.0=1/2..1 --resolution 1e-2",
    "system data/scenes/water4.json --accuracy 1e-5 --scan potentials.1.scale=9/10..1:1/10",
    "system data/scenes/fpu-quartic.json --exact",
    "system data/scenes/fpu-quartic.json --scan potentials.soft.step=1/2..3/5:1/40 --scan potentials.soft.scale=1/2..1:1/2",
    "tongues --ratio 7/3 --rho 1/25",
    "tongues --max-sum 7 --lambda1 pi^2 --lambda2 pi^2/25 --h1-range 0..2/pi --h2-range 0..7/2 --digits 25",
    "tongues --ratio 5/3 --rho 114/55 --m 3..5,7 --a -9..9 --b -9..9 --columns edges",
    "tongues --max-sum 5 --rho 0",
    "tongues --survey --max-sum 12 --rho 1/25",
    "closings --ratio 5/3 --m 4",
    "word --method forest-ruth",
    "word --method respa-4",
    "word --method respa-4 --lambda1 pi^2 --lambda2 pi^2/25 --h 1 --h-range 0..3",
    "aperture --bond OH:morse:D=485.72kJ/mol,a=22.87/nm,15.999,1.008 --steps 1.95fs,2.8fs --h-range 2.3fs..2.31fs",
    "aperture --bond CH:k=340kcal/mol/A^2,12.011,1.008 --substeps 2 --slow 40fs --steps 1fs",
    "word --list",
    "word K(b)D(1/2)K(1-2*b)D(1/2)K(b) --parameter b=0.15..0.25:1/20 --minimize error",
    "word K2(b)D(1/2)K1(1)D(c)K2(1-b) --parameter b=1/5..4/5:1/5,c=1/4..1/2:1/4",
    "word --method symplectic-euler --lambda1 1 --h 3",
    "word --check data/words/claims.toml",
    "word --method impulse --lambda1 pi^2/25 --lambda2 pi^2/400 --h 4 --h-range 0..16",
    "word --method mts-baoab-4 --lambda1 pi^2/25 --lambda2 pi^2/400 --h 4 --friction 1/100",
    "word --method molly-long --lambda1 pi^2/25 --lambda2 pi^2/400 --h 5",
    "compare --methods respa-4,impulse --h1-range 0..4 --h2-range 0..2 --step 1/2",
    "bands --lambda1 pi^2 --lambda2 pi^2/25 --h1-range 0..2/pi --h2-range 0..7/2 --area 1/200 --sectors 9000",
    "closings --max-sum 9 --samples 50",
    "advise --period OH=10fs --period 40fs --steps 0.5fs,4fs --steps 0.5fs,4.8fs --steps 0.5fs,5fs --length 10ns",
    "advise --bond OH:K=450kcal/mol/A^2,15.999,1.008 --bond CH:k=680kcal/mol/A^2,12.011,1.008,3 --period 3000/cm --hmr 3.024 --on 3000/cm=1 --steps 1fs,2fs",
    "advise --period 10fs --period 40fs --period 100fs --steps 0.7fs,1fs,3fs --band 0",
    "advise --bond OH:K=450kcal/mol/A^2,15.999,1.008 --period angle=13fs --period 40fs --constraints OH --friction 1/ps --steps 0.5fs,6fs --all-modes",
    "advise --bond OH:poly:k2=254049kJ/mol/nm^2,k3=-5810111kJ/mol/nm^3,k4=77511731kJ/mol/nm^4,15.999,1.008 --period slow=40fs --steps 0.5fs,2fs --temperature 310K --bonds 1000 --no-levers",
    "advise data/scenes/water4.json --length 1ns",
    "advise data/scenes/water4.json --steps 0.5fs,4.5fs --friction 1/ps --hmr 1.5",
    "advise data/scenes/no-gradient.json --steps 20fs,60fs --friction 1/10/ps --length 1ns",
    "advise data/scenes/water4-levels.json --steps 1.1fs,2.2fs,4.4fs --no-levers",
];

#[test]
fn every_schema_is_a_schema_and_is_named_like_its_file() {
    for path in data("schema") {
        let schema = read(&path);
        if let Err(why) = Validator::new(schema.clone()) {
            panic!("{}: {why}", path.display());
        }
        assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
        let id = format!("kickdrift/{}/1", path.file_stem().unwrap().to_str().unwrap());
        assert_eq!(schema["$id"], id);
        assert_eq!(schema["properties"]["schema"]["const"], id);
    }
}

/// JSON whose objects and arrays stand on one line where they are short.
fn readable(value: &Value, depth: usize) -> String {
    const COLUMNS: usize = 120;
    let line = one_line(value);
    let inside: Vec<String> = match value {
        Value::Object(map) if depth == 0 || line.len() + 2 * depth > COLUMNS => {
            map.iter().map(|(key, value)| format!("\"{key}\": {}", readable(value, depth + 1))).collect()
        }
        Value::Array(all) if line.len() + 2 * depth > COLUMNS => {
            all.iter().map(|value| readable(value, depth + 1)).collect()
        }
        _ => return line,
    };
    let (open, close) = if value.is_object() { ('{', '}') } else { ('[', ']') };
    let (step, end) = ("  ".repeat(depth + 1), "  ".repeat(depth));
    format!("{open}\n{step}{}\n{end}{close}", inside.join(&format!(",\n{step}")))
}

/// JSON on one line, with spaces behind colons and commas.
fn one_line(value: &Value) -> String {
    match value {
        Value::Object(map) => {
            let members: Vec<String> =
                map.iter().map(|(key, value)| format!("\"{key}\": {}", one_line(value))).collect();
            format!("{{{}}}", members.join(", "))
        }
        Value::Array(all) => format!("[{}]", all.iter().map(one_line).collect::<Vec<_>>().join(", ")),
        plain => plain.to_string(),
    }
}

/// `GOLDEN=write cargo test --test schema schemas_are_written` writes them anew.
#[test]
fn schemas_are_written_from_questions_and_records() {
    let mut written = kickdrift::question::schemas();
    written.extend([kickdrift::recheck::schema(), Scene::file_schema(), SystemFile::file_schema()]);
    for (name, schema) in &written {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("data/schema/{name}.json"));
        let text = readable(schema, 0) + "\n";
        if std::env::var("GOLDEN").is_ok_and(|value| value == "write") {
            // Other tests read it meanwhile.
            fs::write(path.with_extension("new"), &text).unwrap();
            fs::rename(path.with_extension("new"), &path).unwrap();
        }
        let kept = fs::read_to_string(&path).unwrap_or_default();
        assert!(kept == text, "{} is not as written: GOLDEN=write cargo test --test schema", path.display());
    }
    let is_written = |path: &Path| written.iter().any(|(name, _)| path.file_stem().unwrap() == *name);
    assert!(data("schema").iter().all(|path| is_written(path)), "a schema is kept by hand");
}

/// Calls `see` with every schema inside a schema.
fn walk(schema: &Value, see: &mut impl FnMut(&Value)) {
    see(schema);
    match schema {
        Value::Object(map) => map.values().for_each(|value| walk(value, see)),
        Value::Array(items) => items.iter().for_each(|value| walk(value, see)),
        _ => {}
    }
}

#[test]
fn every_float_says_whether_it_is_rounded_or_an_end_of_an_enclosure() {
    let mut floats = 0;
    for path in data("schema") {
        walk(&read(&path), &mut |schema| {
            let kinds = &schema["type"];
            if kinds == "number" || kinds.as_array().is_some_and(|kinds| kinds.contains(&"number".into())) {
                floats += 1;
                let description = schema["description"].as_str().unwrap_or("");
                let told = description.contains("double") || description.starts_with("As ");
                assert!(told, "{}: {schema}", path.display());
            }
        });
    }
    assert!(floats >= 7, "only {floats} floats found: is the walk complete?");
}

#[test]
fn what_every_command_prints_is_valid() {
    LINES.iter().for_each(|line| check(&output(line)));
    let huge = output(LINES[5]);
    assert!(huge["trace"]["lo"].is_null() && huge["trace"]["hi"].is_f64(), "{huge}");
}

#[test]
fn a_recheck_is_valid() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("verdict.json");
    fs::write(&file, output(LINES[0]).to_string()).unwrap();
    check(&output(&format!("verify {}", file.display())));
}

#[test]
fn every_scene_is_valid_and_read() {
    for path in data("scenes") {
        let scene = read(&path);
        check(&scene);
        let text = fs::read_to_string(&path).unwrap();
        match name(&scene).as_str() {
            "scene" => drop(Scene::from_json(&text).unwrap()),
            other => {
                assert_eq!(other, "system");
                SystemScene::read_in(path.parent().unwrap(), &text).unwrap();
            }
        }
    }
}

#[test]
fn the_small_scene_runs_and_all_that_it_writes_is_valid() {
    let folder = tempfile::tempdir().unwrap();
    let run = output(&format!("run data/scenes/small.json --output {}", folder.path().display()));
    check(&run);
    let mut tables = 0;
    for product in run["products"].as_array().unwrap() {
        let file = Path::new(product["file"].as_str().unwrap());
        assert!(fs::metadata(file).unwrap().len() > 0, "{}", file.display());
        if file.extension().is_some_and(|extension| extension == "json") {
            let document = read(file);
            assert_eq!(product["product"], name(&document));
            check(&document);
            tables += 1;
        }
    }
    assert_eq!(tables, 8);
}

/// The reader and the schema refuse the same scenes; what only arithmetic can tell is the reader's alone.
#[test]
fn the_schema_refuses_the_scenes_that_the_reader_refuses() {
    let scenes = data("scenes");
    let good = read(scenes.iter().find(|path| path.ends_with("figure1.json")).unwrap());
    let mut scenes = Vec::new();
    for (key, value) in [
        ("schema", json!("kickdrift/scene/2")),
        ("want", json!(["maps"])),
        ("want", json!(["map.png"])),
        ("want", json!("map")),
        ("want", Value::Null),
        ("lambda1", json!(true)),
        ("lambda1", json!("")),
        ("grid", json!({"h1": "1..2", "h2": "1..2"})),
        ("grid", json!({"step1": "1", "h1": "1..2", "h2": "1..2"})),
        ("grid", json!({"step": "1", "h1": "12", "h2": "1..2"})),
        ("grid", json!({"step": "1", "h1": "1..2"})),
        ("families", json!({"a": 3})),
        ("families", json!({"samples": -1})),
        ("max", json!("sixty")),
        ("max_sum", json!(-1)),
        ("rho", json!([0.04])),
        ("window", json!({"h1": "1..2"})),
        ("colour", json!("red")),
    ] {
        let mut scene = good.clone();
        scene[key] = value;
        scenes.push(scene);
    }
    let validator = validator("scene");
    for scene in scenes {
        assert!(!validator.is_valid(&scene), "{scene}");
        assert!(Scene::from_json(&scene.to_string()).is_err(), "{scene}");
    }
}

/// As for scenes: what numbers mean together, and which indices there are, is the reader's alone.
#[test]
fn the_schema_refuses_the_systems_that_the_reader_refuses() {
    let validator = validator("system");
    let spring = json!({"masses": [1, 2], "potentials": [{"step": "1", "springs": [[0, 1, 10]]}]});
    let matrix = json!({"masses": [1, 2], "potentials": [{"step": "1", "stiffness": {"npy": "k"}}]});
    let mesh = json!({"mesh": {"nodes": [[0], [3]], "elements": [[0, 1]], "fixed": [0], "young": 1, "density": 1, "step": "1/2"}});
    let build = json!({"build": {"kind": "stiff-soft", "pairs": 2, "stiff": 100, "steps": ["1/4", "1/2"]}});
    let array = [("k", Array::new(vec![2, 2], vec![1.0, 0.0, 0.0, 2.0]).unwrap())];
    let arrays = Arrays::Held(Arc::new(array.map(|(name, array)| (name.to_string(), array)).into()));
    let read = |system: &Value| SystemScene::from_json_in(arrays.clone(), system.clone());
    for (good, changes) in [
        (
            spring,
            vec![
                ("/schema", json!("kickdrift/system/2")),
                ("/colour", json!("red")),
                ("/masses", json!("m.npy")),
                ("/masses", json!({"npy": "k"})),
                ("/masses/0", json!(true)),
                ("/mass_matrix", json!([[1, 0], [0, 1]])),
                ("/build", json!({"kind": "stiff-soft", "pairs": 2, "stiff": 100, "steps": [1, 2]})),
                ("/positions", json!({"npy": "x"})),
                ("/accuracy", json!("1e-6")),
                ("/mass_weighted", json!(false)),
                ("/labels", json!([1, 2])),
                ("/near", json!("0")),
                ("/scheme", json!("leapfrog")),
                ("/method", json!("verlet")),
                ("/potentials", json!([])),
                ("/potentials", json!({})),
                ("/potentials/0/colour", json!("red")),
                ("/potentials/0/step", json!([1])),
                ("/potentials/0/force", json!({"npy": "f"})),
                ("/potentials/0/stiffness", json!([1, 2])),
                ("/potentials/0/springs/0", json!([0, 1])),
                ("/potentials/0/springs/0/0", json!(-1)),
                ("/potentials/0/springs/0/1", json!("1")),
                ("/potentials/0/springs/0/2", json!(null)),
                ("/potentials/0/bonds", json!([{"i": 0, "j": 1, "form": "morse"}])),
                ("/potentials/0/bonds", json!([{"i": 0, "j": 1, "form": "quartic", "k": 1}])),
            ],
        ),
        (
            matrix,
            vec![
                ("/near", json!([0, 0])),
                ("/friction", json!("1/10")),
                ("/mass_matrix", json!([[1, 0], [0, 1]])),
                ("/masses", json!({"npz": "a"})),
                ("/positions", json!([[0, 0, 0]])),
                ("/constraints", json!("all-bonds")),
                ("/bonded", json!([[0, 1, 2]])),
                ("/periodic", json!("yes")),
                ("/potentials/0/stiffness", json!({"npy": 3})),
                ("/potentials/0/stiffness", json!({"npz": "k.npz"})),
                ("/potentials/0/phase", json!("1/2")),
                ("/potentials/0/springs", json!([[0, 1, 10]])),
                ("/potentials/1", json!({"step": "2", "stiffness": [[1, 0], [0, 1]]})),
                ("/potentials/1", json!({"step": "2"})),
            ],
        ),
        (
            mesh,
            vec![
                ("/masses", json!([1, 2])),
                ("/mesh/colour", json!("red")),
                ("/mesh/nodes/0", json!(0)),
                ("/mesh/elements/0", json!([0])),
                ("/mesh/fixed/0", json!([0, 0, 0])),
                ("/mesh/plane", json!("bent")),
                ("/mesh/steps", json!(["1/2"])),
                ("/mesh/classes", json!([0])),
                ("/levels", json!([])),
                ("/levels", json!([{"elements": [0]}])),
            ],
        ),
        (
            build,
            vec![
                ("/build/kind", json!("ring")),
                ("/build/pairs", json!("1/2")),
                ("/build/steps", json!(["1/4"])),
                ("/build/colour", json!("red")),
                ("/potentials", json!([{"step": "1"}])),
            ],
        ),
    ] {
        let mut good = good;
        good["schema"] = json!("kickdrift/system/1");
        assert!(validator.is_valid(&good), "{:?}", validator.errors(&good));
        read(&good).unwrap();
        for (pointer, value) in changes {
            let mut bad = good.clone();
            let (place, key) = pointer.rsplit_once('/').unwrap();
            match bad.pointer_mut(place).unwrap() {
                Value::Array(all) if key == all.len().to_string() => all.push(value),
                Value::Array(all) => all[key.parse::<usize>().unwrap()] = value,
                object => object[key] = value,
            }
            assert!(!validator.is_valid(&bad), "{pointer}: {bad}");
            assert!(read(&bad).is_err(), "{pointer}: {bad}");
        }
    }
}

#[test]
fn a_document_with_a_key_missing_or_of_the_wrong_kind_is_refused() {
    for line in LINES {
        let document = output(line);
        let (name, validator) = (name(&document), validator(&name(&document)));
        for key in document.as_object().unwrap().keys() {
            let mut broken = document.clone();
            broken.as_object_mut().unwrap().remove(key);
            let optional = [
                "between_periods",
                "families",
                "fastest",
                "friction",
                "levers",
                "levers_left_out",
                "local_steps",
                "measured",
                "moving",
                "nearest_unstable",
                "no_gradient",
                "own_orbit",
                "predicted_points",
                "time_unit",
            ]
            .contains(&key.as_str())
                && name != "system-map";
            assert_eq!(validator.is_valid(&broken), optional, "{name} without {key}");
            let mut broken = document.clone();
            broken[key] = json!({"surprise": 1.5});
            assert!(!validator.is_valid(&broken), "{name} with a strange {key}");
        }
        for key in document["input"].as_object().unwrap().keys() {
            let mut broken = document.clone();
            broken["input"][key] = json!(0.5);
            assert!(!validator.is_valid(&broken), "{name} with a float for {key}");
        }
    }
}

#[test]
fn verdicts_that_contradict_themselves_are_refused() {
    let validator = validator("verdict");
    for (key, value) in [
        ("stable", json!(true)),
        ("side", json!(0)),
        ("kind", json!("elliptic")),
        ("trace", json!(-2.5)),
        ("trace", json!({"lo": -2.5})),
        ("decided_by", json!("guess")),
        ("surprise", json!(1)),
    ] {
        let mut verdict = output(LINES[0]);
        assert!(validator.is_valid(&verdict));
        verdict[key] = value;
        assert!(!validator.is_valid(&verdict), "{verdict}");
    }
}
