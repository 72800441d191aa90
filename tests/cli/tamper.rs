//! Every leaf of every kind of document changed: `verify` finds the change, or names the leaf as one that it
//! does not recheck.

use std::path::Path;

use kickdrift::recheck::{CheckedDocument, Options};
use serde_json::{Value, json};

use super::support::Desk;

/// Other runs and frictions with the same answer: whether growth is tenfold within the run, and whether
/// friction masks it. Advice echoes what it was asked in other words than the arguments', so [`is_asked_for`]
/// cannot ask again.
const STILL_TRUE: [(&str, &str); 7] = [
    // The schemes of steps replace those of the file.
    ("advise tiny.json", ".input.system.potentials.1.step a digit"),
    ("advise learned.json", ".input.system.potentials.0.step a digit"),
    ("advise learned.json", ".input.system.potentials.1.step a digit"),
    ("advise", ".input.length a digit"),
    ("advise", ".input.friction a digit"),
    ("advise", ".input.length nudged"),
    ("advise", ".input.friction nudged"),
];

/// Three masses; at a soft step of 3/4 in place of 1/8 something grows.
const SYSTEM: &str = r#"{"schema": "kickdrift/system/1", "title": "three masses", "masses": ["1", "3/2", "2"], "potentials": [
    {"step": "1/8", "springs": [[0, 1, "10"], [1, 2, "20"]]}, {"step": "1/4", "springs": [[0, null, "5"], [2, null, "7"]]}]}"#;

/// Three clocks on one oscillator, a stiffness with pi.
const ONE_MASS: &str = r#"{"schema": "kickdrift/system/1", "title": "", "masses": ["1"], "potentials": [
    {"step": "1/10", "stiffness": [["pi^2"]]}, {"step": "1/4", "stiffness": [["1/2"]]}, {"step": "1/6", "stiffness": [["2"]]}]}"#;

/// A step longer than the other, about its own orbit.
const BARS: &str = include_str!("../../data/scenes/two-bars.json");
const LOCAL_STEPS: &str = include_str!("../../data/scenes/local-steps.json");
const NO_GRADIENT: &str = include_str!("../../data/scenes/no-gradient.json");
const TENSION: &str = include_str!("../../data/scenes/tension.json");
const LENNARD_JONES: &str = include_str!("../../data/scenes/lennard-jones.json");

const ENGINE: &str = "integrator = md\ndt = 0.0005\nmts = yes\nmts-levels = 2\nmts-level2-forces = longrange-nonbonded\n\
                      mts-level2-factor = 8\nconstraints = none\n";

/// The arrays of tiny.json on three clocks, where both rest on one; and as Jacobians, in steps whose ratio
/// stays short when a digit is another one.
const TINY_LEVELS: &str = r#"{"schema": "kickdrift/system/1", "title": "", "mass_weighted": true, "accuracy": 1e-5, "potentials": [
    {"name": "a", "step": "1/2000", "stiffness": {"npy": "tiny-fast.npy"}},
    {"name": "b", "step": "1/500", "scale": "1/3", "stiffness": {"npy": "tiny-slow.npy"}},
    {"name": "c", "step": "1/250", "scale": "2/3", "stiffness": {"npy": "tiny-slow.npy"}}]}"#;
const TINY_JACOBIANS: &str = r#"{"schema": "kickdrift/system/1", "title": "", "mass_weighted": true, "accuracy": 1e-5, "symmetric": false,
    "potentials": [{"step": "0.0005", "stiffness": {"npy": "tiny-fast.npy"}}, {"step": "0.004", "stiffness": {"npy": "tiny-slow.npy"}}]}"#;

const SCENE: &str = r#"{"schema": "kickdrift/scene/1", "title": "small", "lambda1": "16", "lambda2": "16/25",
    "grid": {"step": "1/10", "h1": "1/10..3/5", "h2": "1/10..1"}, "families": {"a": "0..1", "b": "-2..2", "samples": 9},
    "ratio": "5/3", "max": 3, "max_sum": 5, "want": ["map", "curves", "compare", "proposition", "polynomial", "tongues", "closings",
    "survey"]}"#;

fn desk() -> Desk {
    let desk = Desk::new();
    desk.copy(&["tiny.json", "tiny-fast.npy", "tiny-slow.npy"]);
    desk.write("system.json", SYSTEM);
    desk.write("resonant.json", &SYSTEM.replace("\"1/8\"", "\"3/4\""));
    desk.write("one-mass.json", ONE_MASS);
    desk.write("bars.json", BARS);
    desk.write("local.json", LOCAL_STEPS);
    desk.write("learned.json", NO_GRADIENT);
    desk.write("tension.json", TENSION);
    desk.write("lennard-jones.json", LENNARD_JONES);
    desk.write("tiny-levels.json", TINY_LEVELS);
    desk.write("tiny-jacobians.json", TINY_JACOBIANS);
    for (folder, name) in [("tests/golden/input", "past.json"), ("tests/golden/input", "past.npz")] {
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder).join(name);
        std::fs::copy(from, desk.path().join(name)).unwrap();
    }
    desk.write("run.mdp", ENGINE);
    desk.write("scene.json", SCENE);
    desk.write("claims.toml", CLAIMS);
    desk
}

const CLAIMS: &str =
    "[[word]]\nname = \"a\"\nmethod = \"velocity-verlet\"\norder = 4\nsymmetric = false\nlimit = 2\n";

const VERDICTS_MAPS_CURVES: &[&str] = &[
    "verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 1/100 --h2 0.98",
    "verdict --lambda1 11/4 --lambda2 57/10 --h1 1 --h2 5/3",
    "verdict --lambda1 11/4 --lambda2 57/10 --h1 1 --h2 5/3 --exact",
    "verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 1/2 --h2 1 --friction 1/2",
    "verdict --lambda1 3*pi^2-pi+1/2 --lambda2 1/pi --h1 1/9 --h2 1/7",
    "map --lambda1 10 --lambda2 2/5 --step 1/10 --h1-range 1/10..1/2 --h2-range 1/10..3",
    "map --label --growth --lambda1 10 --lambda2 2/5 --step 1/10 --h1-range 1/10..1/2 --h2-range 1/10..3",
    "compare --max-sum 6 --rho 1/25 --samples 12",
    "compare --lambda1 16 --lambda2 16/25 --step 1/10 --h1-range 1/10..3/5 --h2-range 1/10..2",
    "compare --methods impulse,molly-long,respa-4 --lambda1 pi^2/25 --h-range 0..8 --h-step 1 --rho-range 0..1/4 --rho-step 1/16",
    "curves --samples 12 --a 0..2 --b -2..2",
    "polynomial --ratio 5/4",
    "half --ratio 5/4 --s 3/2 --rho 1/7",
    "bands --lambda1 pi^2 --lambda2 pi^2/25 --h1-range 1/5..1/4 --h2-range 9/10..1 --sectors 60",
    "aperture --bond OH:morse:D=485.72kJ/mol,a=22.87/nm,15.999,1.008 --steps 1.95fs",
    "proposition --max 3",
    "word --method 2mn-velocity --lambda1 1 --h 2",
    "word --list",
    "word --check claims.toml",
    "compare --methods pefrl,velocity-verlet --by-cost --h-range 0..2 --h-step 1/4",
];

const TONGUES_SURVEYS_CLOSINGS: &[&str] = &[
    "tongues --ratio 7/3 --rho 1/25",
    "tongues --ratio 5/3 --rho 114/55 --lambda1 pi^2 --digits 20",
    "tongues --max-sum 5 --rho 0",
    "tongues --max-sum 6 --lambda1 pi^2 --lambda2 pi^2/25 --h1-range 1/10..3/5 --h2-range 1/10..2 --columns growth",
    "tongues --ratio 23/20 --rho 1/1000 --m 3..6,22 --columns exact,predicted,growth,first-order",
    "tongues --ratio 9/4 --rho 2 --m 2..5 --a 0..2 --b -2..2 --columns edges",
    "tongues --survey --max-sum 9 --rho 1/25 --thinnest 5",
    "closings --max-sum 6",
    "closings --ratio 9/5 --m 3..9 --samples 60 --digits 12",
];

const SYSTEMS: &[&str] = &[
    "system system.json",
    "system resonant.json --exact",
    "system one-mass.json",
    "system bars.json --friction 1/10",
    "system local.json",
    "system learned.json",
    "system tension.json --friction 1/2",
    "system resonant.json --nearest --resolution 0.1",
    "system system.json --intervals outer=1/8..1/2 --resolution 1e-2",
    "system system.json --scan potentials.0.step=1/8..3/4:1/8 --scan potentials.1.scale=1..2:1/2",
];

const MEASURED_SYSTEMS: &[&str] = &[
    "system tiny.json",
    "system tiny.json --friction 1 --accuracy 1e-7",
    "system tiny.json --keep-rigid",
    "system tiny.json --nearest --resolution 0.1",
    "system tiny.json --intervals outer=0.004..0.005 --resolution 1e-2",
    "system tiny.json --scan accuracy=1/1000000..1/100000:9/1000000",
    "system tiny.json --intervals potentials.1.scale=1..3/2 --resolution 1e-2",
    "system tiny.json --intervals potentials.1.step=0.004..0.006",
    "system tiny.json --method molly-short",
    "system tiny-levels.json",
    "system tiny-levels.json --intervals outer=0.0048..0.0049 --resolution 0.1",
    "system tiny-jacobians.json",
    "system past.json",
    "system past.json --accuracy 1e-3",
];

const SIMULATIONS: &[&str] = &[
    "simulate resonant.json --periods 4",
    "simulate tension.json --periods 3",
    "simulate lennard-jones.json --periods 3 --staggered",
];

const ADVICE: &[&str] = &[
    "advise --period OH=10fs --period 40fs --steps 2fs,4fs --steps 2.2fs,4.4fs --length 10ns --friction 1/ps --no-levers",
    "advise --bond OH:K=450kcal/mol/A^2,15.999,1.008 --bond CH:k=680kcal/mol/A^2,12.011,1.008,3 --period 3000/cm --hmr 3.024 \
     --on 3000/cm=1 --steps 1fs,2fs",
    "advise --period 19.45fs --steps 2fs,4fs",
    "advise --period 10fs --period 40fs --period 100fs --steps 1fs,2fs,4fs --no-levers",
    // Levers of every kind, friction among them.
    "advise --bond OH:K=450kcal/mol/A^2,15.999,1.008 --period angle=13fs --period 40fs --constraints OH --steps 1fs,2fs \
     --friction 1/ps",
    "advise --period OH=10fs --period 40fs --engine run.mdp --no-levers",
];

const ADVICE_ON_HESSIANS: &[&str] = &[
    "advise tiny.json --steps 2.2fs,4.4fs --length 1ns --friction 1/ps",
    "advise tiny.json --engine run.mdp",
    "advise learned.json --steps 40fs,80fs --length 1ns --friction 1/ps",
];

/// The document that a line of arguments makes; the line of an error where it makes none.
fn document(desk: &Desk, line: &str) -> Result<Value, String> {
    let words = line.split_whitespace().chain(["--format", "json", "--quiet"]);
    let ended = desk.run(&words.collect::<Vec<_>>());
    serde_json::from_str(&ended.stdout).map_err(|_| ended.stderr)
}

/// Whether kickdrift writes these rows when it is asked what the input says: a question with another wording,
/// or another question with the same answer, is no lie.
fn is_asked_for(desk: &Desk, line: &str, tampered: &Value) -> bool {
    let asked = arguments(desk, line, tampered).and_then(|line| document(desk, &line).ok());
    let rows = |whole: &Value| {
        let mut rows = whole.clone();
        rows.as_object_mut().unwrap().shift_remove("input");
        rows
    };
    asked.is_some_and(|asked| rows(&asked) == rows(tampered))
}

/// The line of arguments that asks what a document's input says.
fn arguments(desk: &Desk, line: &str, tampered: &Value) -> Option<String> {
    let input = tampered["input"].as_object()?;
    let file = || {
        desk.write("asked.json", &input["system"].to_string());
        line.split_whitespace().map(|word| if word.ends_with(".json") { "asked.json" } else { word })
    };
    let schema = tampered["schema"].as_str()?;
    if ["kickdrift/advise-system/1", "kickdrift/advise-direct/1"].contains(&schema) {
        return Some(file().collect::<Vec<_>>().join(" "));
    }
    if schema == "kickdrift/word-check/1" {
        let line = |(key, value): (&String, &Value)| format!("{key} = {value}\n");
        let lines = |word: &Value| word.as_object().into_iter().flatten().map(line).collect::<String>();
        let words = input["words"].as_array()?.iter().map(|word| format!("[[word]]\n{}", lines(word)));
        desk.write("asked.toml", &words.collect::<String>());
        return Some("word --check asked.toml".into());
    }
    let mut words = vec![tampered["kickdrift"]["command"].as_str()?.to_string()];
    words.extend((schema == "kickdrift/survey/1").then(|| "--survey".to_string()));
    for (key, value) in input {
        let given = value.as_str().unwrap_or_default();
        match key.as_str() {
            "file" | "title" => {}
            "rho" if input.contains_key("lambda2") => {}
            "step1" | "step2" if schema == "kickdrift/curves/1" => {}
            "form" if given == "symmetric" => {}
            "form" => words.push("--staggered".into()),
            "system" => words.push(file().find(|word| *word == "asked.json")?.into()),
            "scan_x" | "scan_y" => words.push(format!("--scan {given}")),
            "width" => words.push(format!("--resolution {given}")),
            _ if given == "true" => words.push(format!("--{}", key.replace('_', "-"))),
            _ => words.push(format!("--{} {given}", key.replace('_', "-"))),
        }
    }
    Some(words.join(" "))
}

/// Everything that is done to a value. `see` is shown each tampered document, with the path and what was done
/// there; `back` puts a value into the whole.
fn tamper(value: &Value, path: &str, back: &dyn Fn(Value) -> Value, see: &mut dyn FnMut(Value, &str, &str)) {
    let mut now = |what: &str, value: Value| see(back(value), path, what);
    match value {
        Value::Null => {
            now("null -> 1", json!(1));
            now("null -> word", json!("word"));
        }
        Value::Bool(truth) => now("flipped", json!(!truth)),
        Value::Number(number) => {
            now("-> null", json!(null));
            if let Some(n) = number.as_i64() {
                now("+ 1", json!(n + 1));
                now("- 1", json!(n - 1));
            } else {
                let x = number.as_f64().unwrap();
                // Enclosures may be as narrow as the last place of a double, which is 1e-16 of it.
                now("+ 1e-9", json!(if x == 0.0 { 1e-9 } else { x * (1.0 + 1e-9) }));
                now("* -1", json!(if x == 0.0 { -1e-9 } else { -x }));
            }
        }
        Value::String(text) => {
            now("-> null", json!(null));
            now("-> empty", json!(""));
            now("a letter more", json!(format!("{text}x")));
            let letter = text.char_indices().find(|(_, c)| c.is_ascii_alphabetic());
            if let Some((at, c)) = letter {
                let other = if c == 'e' { "a" } else { "e" };
                now("a letter", json!(format!("{}{other}{}", &text[..at], &text[at + 1..])));
            }
            // The first and the last digit.
            let digits = [text.find(|c: char| c.is_ascii_digit()), text.rfind(|c: char| c.is_ascii_digit())];
            for at in digits.into_iter().flatten() {
                let mut bytes = text.clone().into_bytes();
                bytes[at] = b'1' + (bytes[at] - b'0' + 1) % 9;
                now("a digit", json!(String::from_utf8(bytes).unwrap()));
            }
        }
        Value::Array(items) => {
            now("-> null", json!(null));
            for i in [0, items.len() / 2, items.len().saturating_sub(1)] {
                if i < items.len() {
                    let mut fewer = items.clone();
                    fewer.remove(i);
                    now(&format!("without {i}"), json!(fewer));
                    let mut more = items.clone();
                    more.insert(i, items[i].clone());
                    now(&format!("twice {i}"), json!(more));
                }
            }
            now("one more", json!(items.iter().cloned().chain([json!(1)]).collect::<Vec<_>>()));
            if items.len() > 1 {
                now("emptied", json!([]));
            }
            // 0 and -0 are one number.
            if items.len() > 1 && (items[0].as_f64().is_none() || items[0].as_f64() != items[1].as_f64()) {
                let mut other = items.clone();
                other.swap(0, 1);
                now("exchanged", json!(other));
            }
            for (i, item) in items.iter().enumerate() {
                let back = |changed| {
                    let mut whole = items.clone();
                    whole[i] = changed;
                    back(json!(whole))
                };
                // Of long lists the first two stand for all in everything but small numbers.
                let path = format!("{path}.{i}");
                if i < 2 { tamper(item, &path, &back, see) } else { nudge(item, &path, &back, see) }
            }
        }
        Value::Object(map) => {
            let with = |key: &str, value: Value| {
                let mut whole = map.clone();
                whole.insert(key.into(), value);
                Value::Object(whole)
            };
            now("a key more", with("extra", json!(1)));
            for (key, inner) in map {
                let mut without = map.clone();
                without.shift_remove(key);
                let path = format!("{path}.{key}");
                see(back(Value::Object(without)), &path, "gone");
                tamper(inner, &path, &|changed| back(with(key, changed)), see);
            }
        }
    }
}

/// Every leaf changed once, by as little as may be.
fn nudge(value: &Value, path: &str, back: &dyn Fn(Value) -> Value, see: &mut dyn FnMut(Value, &str, &str)) {
    match value {
        Value::Null => see(back(json!(0)), path, "null -> 0"),
        Value::Bool(truth) => see(back(json!(!truth)), path, "flipped"),
        Value::Number(number) => {
            let x = number.as_f64().unwrap();
            let other = number
                .as_i64()
                .map_or(json!(if x == 0.0 { 1e-9 } else { x * (1.0 + 1e-9) }), |n| json!(n + 1));
            see(back(other), path, "nudged");
        }
        Value::String(text) => {
            let at = text.rfind(|c: char| c.is_ascii_alphanumeric()).unwrap_or(0);
            let other = if text[at..].starts_with('7') { "3" } else { "7" };
            let end = text.get(at + 1..).unwrap_or_default();
            see(back(json!(format!("{}{other}{end}", &text[..at]))), path, "nudged");
        }
        Value::Array(items) => {
            for (i, item) in items.iter().enumerate() {
                let back = |changed| {
                    let mut whole = items.clone();
                    whole[i] = changed;
                    back(json!(whole))
                };
                nudge(item, &format!("{path}.{i}"), &back, see);
            }
        }
        Value::Object(map) => {
            for (key, inner) in map {
                let back = |changed| {
                    let mut whole = map.clone();
                    whole.insert(key.clone(), changed);
                    back(Value::Object(whole))
                };
                nudge(inner, &format!("{path}.{key}"), &back, see);
            }
        }
    }
}

/// Whether `path` (`.modes.0.before`) lies at or below what is named as not rechecked (`modes.*.before:
/// why`).
fn is_below(path: &str, named: &str) -> bool {
    let named: Vec<&str> = named.split(':').next().unwrap().split('.').collect();
    let path: Vec<&str> = path.split('.').skip(1).collect();
    path.len() >= named.len() && named.iter().zip(&path).all(|(name, own)| *name == "*" || name == own)
}

/// Where time is short, one in three changes to an input is made: each costs a question asked again. All
/// changes to answers are made.
const ONE_IN_THREE: usize = 3;

/// Changes a document in every way, its input in one way of so many: how many changes were made, and those
/// that `verify` did not find.
fn passed(desk: &Desk, name: &str, whole: &Value, one_in: usize) -> (usize, Vec<String>) {
    // Without a number of sectors bands are another question, of a thousand times the work.
    let budget = name.starts_with("bands").then_some(100);
    let options = Options { folder: desk.path().into(), budget, ..Options::default() };
    let checked = CheckedDocument::read(&whole.to_string()).unwrap();
    let sound = checked.verify(&options, None).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(sound.failures, [], "{name}");
    let again = checked.recompute(&options).unwrap();
    // A check begins with the document computed again from its input. It is the same for all changes beside
    // the input: where it shows the change, there is no need to compute it once more; where it does not, the
    // whole check follows.
    let passes = |tampered: &Value| {
        let Ok(checked) = CheckedDocument::read(&tampered.to_string()) else { return false };
        let differences = again.as_ref().and_then(|again| checked.differences(again)).unwrap_or_default();
        differences.is_empty()
            && checked.verify(&options, None).is_ok_and(|outcome| outcome.failures.is_empty())
    };
    let (mut count, mut to_input, mut passed) = (0, 0, Vec::new());
    let mut see = |tampered: Value, path: &str, what: &str| {
        let is_to_input = path.starts_with(".input");
        to_input += usize::from(is_to_input);
        if is_to_input && to_input % one_in != 0 {
            return;
        }
        let what = format!("{path} {what}");
        let still_true = |(of, end): &(&str, &str)| name.starts_with(of) && what.ends_with(end);
        let named = sound.not_rechecked.iter().any(|own| is_below(path, own));
        if tampered != *whole && !named && !STILL_TRUE.iter().any(still_true) {
            count += 1;
            if passes(&tampered) && !(is_to_input && is_asked_for(desk, name, &tampered)) {
                passed.push(format!("{name}: {what}"));
            }
        }
    };
    tamper(whole, "", &|changed| changed, &mut see);
    (count, passed)
}

/// No change to the documents of these lines passes; more than `least` are made.
fn no_change_passes(lines: &[&str], one_in: usize, least: usize) {
    let desk = desk();
    let (mut count, mut all) = (0, Vec::new());
    for line in lines {
        let begin = std::time::Instant::now();
        let (made, passed) = passed(&desk, line, &document(&desk, line).unwrap(), one_in);
        eprintln!("{made} changes, {:.1} s: {line}", begin.elapsed().as_secs_f64());
        (count, all) = (count + made, [all, passed].concat());
    }
    assert!(all.is_empty(), "{} of {count} pass:\n{}", all.len(), all.join("\n"));
    assert!(count > least, "{count}");
}

#[test]
fn no_change_to_a_verdict_a_map_or_a_curve_passes() {
    no_change_passes(VERDICTS_MAPS_CURVES, ONE_IN_THREE, 1000);
}

#[test]
fn no_change_to_tongues_surveys_or_closings_passes() {
    no_change_passes(TONGUES_SURVEYS_CLOSINGS, ONE_IN_THREE, 1000);
}

#[test]
fn no_change_to_a_system_passes() {
    no_change_passes(SYSTEMS, ONE_IN_THREE, 1000);
}

#[test]
fn no_change_to_a_measured_system_passes() {
    no_change_passes(MEASURED_SYSTEMS, ONE_IN_THREE, 500);
}

#[test]
fn no_change_to_a_simulation_passes() {
    no_change_passes(SIMULATIONS, ONE_IN_THREE, 300);
}

#[test]
fn no_change_to_advice_passes() {
    no_change_passes(ADVICE, ONE_IN_THREE, 1000);
}

#[test]
fn no_change_to_advice_on_hessians_passes() {
    no_change_passes(ADVICE_ON_HESSIANS, ONE_IN_THREE, 300);
}

#[test]
#[ignore = "minutes: every change to the input of every document"]
fn no_change_to_any_input_passes() {
    let all = [
        VERDICTS_MAPS_CURVES,
        TONGUES_SURVEYS_CLOSINGS,
        SYSTEMS,
        MEASURED_SYSTEMS,
        SIMULATIONS,
        ADVICE,
        ADVICE_ON_HESSIANS,
    ];
    for lines in all {
        no_change_passes(lines, 1, 300);
    }
}

#[test]
fn no_change_to_a_product_of_a_scene_passes() {
    let desk = desk();
    let ended = desk.run(&["run", "scene.json", "--output", "out", "--quiet", "--format", "json"]);
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    let summary: Value = serde_json::from_str(&ended.stdout).unwrap();
    let (mut count, mut all) = passed(&desk, "run", &summary, 1);
    // The only part of a summary's input that the rest of it follows from.
    let mut other = summary;
    other["input"]["want"] = json!("map.json, curves.json");
    let checked = CheckedDocument::read(&other.to_string()).unwrap();
    let outcome = checked.verify(&Options::default(), None).unwrap();
    assert!(!outcome.failures.is_empty());
    for product in ["map", "curves", "compare", "proposition", "polynomial", "tongues", "closings", "survey"]
    {
        let whole = serde_json::from_slice(&desk.read(&format!("out/{product}.json"))).unwrap();
        let (made, passed) = passed(&desk, product, &whole, ONE_IN_THREE);
        (count, all) = (count + made, [all, passed].concat());
    }
    assert!(all.is_empty(), "{} of {count} pass:\n{}", all.len(), all.join("\n"));
    assert!(count > 1000, "{count}");
}
