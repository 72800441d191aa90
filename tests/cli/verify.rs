//! `verify`: what kickdrift wrote holds; what was changed does not, and the row is named.

use kickdrift::recheck::{Claim, Options};
use serde_json::{Value, json};

use super::support::{Desk, words};

/// One document of every kind that can be rechecked, with all columns.
const DOCUMENTS: [&str; 26] = [
    "tongues --ratio 7/3 --rho 1/25",
    "tongues --max-sum 12 --lambda1 pi^2 --lambda2 pi^2/25",
    "tongues --ratio 5/3 --rho 114/55 --digits 40",
    "tongues --ratio 23/20 --rho 1/1000 --columns exact,predicted",
    "tongues --max-sum 6 --rho 0",
    "tongues --ratio 9/4 --rho 2 --m 2,5 --lambda1 3",
    "closings --max-sum 10",
    "verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 1/100 --h2 0.98",
    "verdict --lambda1 11/4 --lambda2 57/10 --h1 1 --h2 5/3",
    "verdict --lambda1 10 --lambda2 2/5 --h1 0.631 --h2 3.499",
    "verdict --lambda1 1 --lambda2 1e400 --h1 1 --h2 1",
    "verdict --lambda1 3*pi^2-pi+1/2 --lambda2 1/pi --h1 1/9 --h2 1/7",
    "map --label --growth --lambda1 10 --lambda2 -2/5 --step 1/10 --h1-range 1/10..1/2 --h2-range 1/10..3",
    "compare --max-sum 8 --rho 1/25 --samples 20",
    "compare --lambda1 16 --lambda2 16/25 --step 1/10 --h1-range 1/10..3/5 --h2-range 1/10..2",
    "curves --samples 50",
    "polynomial --ratio 5/4",
    "proposition --max 6",
    "tongues --survey --max-sum 20 --rho 1/25",
    "tongues --max-sum 9 --rho 1e-12",
    "closings --max-sum 9 --digits 3",
    "tongues --ratio 3/2 --rho 1/25 --lambda1 2 --digits 20",
    "advise --period OH=10fs --period 40fs --steps 0.5fs,4fs --steps 0.5fs,4.8fs --steps 0.5fs,5fs --length 10ns",
    "advise --bond OH:K=450kcal/mol/A^2,15.999,1.008 --period CH=3000/cm --period slow=40fs --steps 1fs,2fs",
    "advise --period 19.45fs --steps 2fs,4fs",
    "advise --period 10fs --period 40fs --period 100fs --steps 0.7fs,1fs,3fs",
];

fn write(desk: &Desk, line: &str, name: &str) -> Value {
    let ended = desk.run(&words(line, &["--format", "json", "--quiet", "--output", name]));
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""), "{line}");
    serde_json::from_slice(&desk.read(name)).unwrap()
}

#[test]
fn what_kickdrift_wrote_holds() {
    let desk = Desk::new();
    for line in DOCUMENTS {
        write(&desk, line, "d.json");
        let ended = desk.run(&["verify", "d.json"]);
        assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""), "{line}");
        assert!(ended.stdout.contains(" rows hold\n"), "{line}: {}", ended.stdout);
    }
}

#[test]
fn every_change_is_found_and_its_row_named() {
    let desk = Desk::new();
    let moved = |value: &Value, by: f64| json!(value.as_f64().unwrap() * (1.0 + by));
    type Change = fn(&mut Value, &dyn Fn(&Value, f64) -> Value);
    let changes: [(&str, &str, Change); 57] = [
        (DOCUMENTS[22], "row 1", |d, by| d["rows"][0]["trace"] = by_both(&d["rows"][0]["trace"], by, 1e-9)),
        (DOCUMENTS[22], "row 2", |d, by| {
            d["rows"][1]["masked_above"] = by_both(&d["rows"][1]["masked_above"], by, 1e-2);
        }),
        (DOCUMENTS[22], "row 2", |d, by| {
            d["rows"][1]["inside_upper"] = by_both(&d["rows"][1]["inside_upper"], by, 1e-6);
        }),
        (DOCUMENTS[22], "row 0", |d, _| d["schemes"][0]["largest"] = json!("9/2")),
        (DOCUMENTS[22], "row 0", |d, _| d["schemes"][2]["status"] = json!("caution")),
        (DOCUMENTS[22], "row 0", |d, by| {
            d["intervals"][0]["lower"] = by_both(&d["intervals"][0]["lower"], by, 1e-6)
        }),
        (DOCUMENTS[22], "row 0", |d, by| d["modes"][0]["third"] = by_both(&d["modes"][0]["third"], by, 1e-9)),
        (DOCUMENTS[0], "row 4", |d, _| d["tongues"][3]["m"] = json!(5)),
        (DOCUMENTS[0], "row 4", |d, by| {
            let lo = by(&d["tongues"][3]["lower"]["lo"], 1e-15);
            d["tongues"][3]["lower"]["lo"] = lo.clone();
            d["tongues"][3]["lower"]["hi"] = json!(lo.as_f64().unwrap().next_up());
        }),
        (DOCUMENTS[0], "row 2", |d, _| d["tongues"][1]["upper"]["entry"] = json!("C")),
        (DOCUMENTS[0], "row 1", |d, by| {
            d["tongues"][0]["width"] = by_both(&d["tongues"][0]["width"], by, 1e-9)
        }),
        (DOCUMENTS[0], "row 5", |d, _| d["tongues"][4]["closed"] = json!(true)),
        (DOCUMENTS[0], "row 3", |d, by| {
            d["tongues"][2]["growth"]["ln_multiplier"] =
                by(&d["tongues"][2]["growth"]["ln_multiplier"], 1e-6);
        }),
        (DOCUMENTS[0], "row 3", |d, by| {
            d["tongues"][2]["growth"]["s"] = by(&d["tongues"][2]["growth"]["s"], 1e-3)
        }),
        (DOCUMENTS[0], "row 6", |d, _| d["tongues"][5]["predicted"]["position"] = json!("below")),
        (DOCUMENTS[0], "row 7", |d, _| drop(d["tongues"].as_array_mut().unwrap().remove(6))),
        (DOCUMENTS[0], "row 9", |d, _| d["tongues"][8]["a"] = json!(1)),
        (DOCUMENTS[1], "row 10", |d, by| {
            d["tongues"][9]["lower"]["h2"] = by_both(&d["tongues"][9]["lower"]["h2"], by, 1e-12);
        }),
        (DOCUMENTS[2], "row 4", |d, _| {
            d["tongues"][3]["lower"]["exact"] = json!("2749999999999999/1000000000000000")
        }),
        (DOCUMENTS[2], "row 1", |d, _| {
            let text = d["tongues"][0]["lower"]["decimal"]["hi"].as_str().unwrap().to_string();
            d["tongues"][0]["lower"]["decimal"] = json!({"lo": text, "hi": format!("{text}9")});
        }),
        (DOCUMENTS[6], "row 2", |d, _| d["closings"][1]["m"] = json!(4)),
        (DOCUMENTS[6], "row 2", |d, _| d["closings"][1]["m"] = json!(3)),
        (DOCUMENTS[6], "row 4", |d, _| d["closings"][3]["below_verlet"] = json!(false)),
        (DOCUMENTS[6], "row 5", |d, _| {
            let hi = d["closings"][4]["rho"]["decimal"]["hi"].clone();
            d["closings"][4]["rho"]["decimal"]["lo"] = json!(format!("{}5", hi.as_str().unwrap()));
            d["closings"][4]["rho"]["decimal"]["hi"] = json!(format!("{}9", hi.as_str().unwrap()));
        }),
        (DOCUMENTS[6], "row 1", |d, _| d["closings"][0]["rho"]["exact"] = json!("4/19")),
        (DOCUMENTS[7], "row 1", |d, _| {
            d["kind"] = json!("elliptic");
            d["stable"] = json!(true);
            d["side"] = json!(0);
        }),
        (DOCUMENTS[8], "row 1", |d, _| d["trace"] = json!({"lo": 2.1, "hi": 2.2})),
        (DOCUMENTS[12], "row 0", |d, _| d["unstable"] = json!(d["unstable"].as_u64().unwrap() + 1)),
        (DOCUMENTS[15], "row 1", |d, by| {
            d["curves"][0]["points"][3]["h2"] = by(&d["curves"][0]["points"][3]["h2"], 1e-14);
        }),
        (DOCUMENTS[16], "row", |d, _| d["terms"][2]["coefficient"] = json!("1/3")),
        (DOCUMENTS[17], "row 5", |d, _| d["witnesses"][4]["b"] = json!(17)),
        (DOCUMENTS[18], "row 2", |d, by| {
            d["thinnest"][1]["width"] = by_both(&d["thinnest"][1]["width"], by, 1e-2)
        }),
        (DOCUMENTS[18], "row 0", |d, _| d["open"] = json!(d["open"].as_u64().unwrap() + 1)),
        (DOCUMENTS[9], "row 1", |d, by| d["trace"] = by_both(&d["trace"], by, 1e-12)),
        (DOCUMENTS[9], "row 1", |d, _| d["trace"] = json!({"lo": null, "hi": null})),
        (DOCUMENTS[9], "row 1", |d, by| d["growth_rate"] = by_both(&d["growth_rate"], by, 1e-12)),
        (DOCUMENTS[9], "row 1", |d, _| d["resonance"] = json!(null)),
        (DOCUMENTS[9], "decided_by", |d, _| d["decided_by"] = json!("chance")),
        (DOCUMENTS[8], "row 1", |d, _| d["trace"]["exact"] = json!("21/10")),
        (DOCUMENTS[12], "row 0", |d, _| {
            d["decided_by"]["exact"] = json!(d["decided_by"]["exact"].as_u64().unwrap() + 1);
        }),
        (DOCUMENTS[13], "row 2", |d, _| d["offenders"][1]["offence"] = json!("quiet")),
        (DOCUMENTS[13], "row 2", |d, _| d["offenders"][1]["tan"] = json!("parabolic")),
        (DOCUMENTS[13], "row 2", |d, _| d["offenders"][1]["rho"] = json!("1/26")),
        (DOCUMENTS[13], "row 2", |d, _| d["offenders"][1]["q"] = json!(0)),
        (DOCUMENTS[13], "row 0", |d, _| d["input"]["max_sum"] = json!("9")),
        (DOCUMENTS[14], "not the next offender", |d, _| d["input"]["h2_range"] = json!("1/10..3")),
        (DOCUMENTS[13], "row 0", |d, _| d["unstable"] = json!(d["unstable"].as_u64().unwrap() + 1)),
        (DOCUMENTS[16], "row 3", |d, _| d["polynomials"]["C"] = json!("(-1/2*rho - 1/2)*s")),
        (DOCUMENTS[17], "row 0", |d, _| d["holds"] = json!(false)),
        (DOCUMENTS[0], "row 0", |d, _| d["open"] = json!(d["open"].as_u64().unwrap() + 1)),
        (DOCUMENTS[0], "row 0", |d, _| d["predicted_points"]["inside"] = json!(1)),
        (DOCUMENTS[0], "row 9", |d, _| d["tongues"][8]["closed"] = json!(true)),
        (DOCUMENTS[0], "row 2", |d, by| {
            d["tongues"][1]["predicted"]["s"] = by(&d["tongues"][1]["predicted"]["s"], 1e-15);
        }),
        (DOCUMENTS[0], "row 2", |d, by| {
            d["tongues"][1]["predicted"]["distance"] = by(&d["tongues"][1]["predicted"]["distance"], 1e-2);
        }),
        (DOCUMENTS[0], "row 1", |d, by| {
            d["tongues"][0]["growth"]["s"] = by(&d["tongues"][0]["growth"]["s"], 1e-3)
        }),
        (DOCUMENTS[21], "row 2", |d, by| {
            let growth = &mut d["tongues"][1]["growth"];
            growth["growth_rate"] = by(&growth["growth_rate"], 1e-6);
        }),
        (DOCUMENTS[21], "row 2", |d, _| {
            let decimal = &mut d["tongues"][1]["upper"]["h2"]["decimal"];
            decimal["lo"] = json!(format!("1{}", decimal["lo"].as_str().unwrap()));
            decimal["hi"] = json!(format!("1{}", decimal["hi"].as_str().unwrap()));
        }),
    ];
    for (i, (line, row, change)) in changes.into_iter().enumerate() {
        let mut document = write(&desk, line, "d.json");
        change(&mut document, &moved);
        desk.write("d.json", &document.to_string());
        let ended = desk.run(&["verify", "d.json"]);
        assert_eq!((ended.code, ended.stdout.as_str()), (Some(2), ""), "change {i} of {line}");
        assert!(ended.stderr.contains(row) && ended.stderr.lines().count() == 1, "{i}: {}", ended.stderr);
    }
}

/// An enclosure moved as a whole.
fn by_both(enclosure: &Value, moved: &dyn Fn(&Value, f64) -> Value, by: f64) -> Value {
    json!({"lo": moved(&enclosure["lo"], by), "hi": moved(&enclosure["hi"], by)})
}

#[test]
fn what_cannot_be_rechecked_is_told() {
    let desk = Desk::new();
    desk.write("run.json", r#"{"schema": "kickdrift/run/1"}"#);
    desk.write("text.json", "no JSON");
    desk.write("bare.json", r#"{"schema": "kickdrift/tongues/1"}"#);
    for (file, parts) in [
        ("run.json", &["kickdrift/run/1", "one of tongues, closings, survey"][..]),
        ("text.json", &["document = no JSON", "as kickdrift wrote them"]),
        ("bare.json", &["missing field `input`"]),
        ("none.json", &["none.json", "cannot read it"]),
    ] {
        let ended = desk.run(&["verify", file]);
        assert_eq!((ended.code, ended.stdout.as_str()), (Some(2), ""), "{file}");
        assert!(parts.iter().all(|part| ended.stderr.contains(part)), "{file}: {}", ended.stderr);
    }
}

/// What is done to the values of a document.
struct Tamper<'a> {
    /// Shown each tampered document, with the path and what was done there.
    see: &'a mut dyn FnMut(Value, String),
}

/// Another word of the same kind.
const WORDS: [[&str; 2]; 12] = [
    ["elliptic", "hyperbolic"],
    ["hyperbolic", "elliptic"],
    ["parabolic", "coexistence"],
    ["coexistence", "parabolic"],
    ["A", "D"],
    ["D", "A"],
    ["B", "C"],
    ["C", "B"],
    ["outside", "inside"],
    ["above", "below"],
    ["miss", "false alarm"],
    ["false alarm", "miss"],
];

impl Tamper<'_> {
    /// Everything that is done to a value, put back into the whole by `back`.
    fn value(&mut self, value: &Value, path: &str, back: &dyn Fn(Value) -> Value) {
        let mut tell = |what: &str, value: Value| (self.see)(back(value), format!("{path} {what}"));
        match value {
            Value::Null => tell("null -> 1", json!(1)),
            Value::Bool(truth) => tell("flipped", json!(!truth)),
            Value::Number(number) => {
                tell("-> null", json!(null));
                if let Some(n) = number.as_i64().filter(|_| !number.is_f64()) {
                    tell("+ 1", json!(n + 1));
                    tell("- 1", json!(n - 1));
                } else {
                    let x = number.as_f64().unwrap();
                    tell("+ 1 %", json!(if x == 0.0 { 0.01 } else { x * 1.01 }));
                }
            }
            Value::String(text) => {
                tell("-> null", json!(null));
                if let Some([_, other]) = WORDS.iter().find(|words| words[0] == text) {
                    tell("-> another word", json!(other));
                } else if text.contains(|c: char| c.is_ascii_digit()) {
                    // The first and the last digit.
                    for at in
                        [text.find(|c: char| c.is_ascii_digit()), text.rfind(|c: char| c.is_ascii_digit())]
                    {
                        let (at, mut bytes) = (at.unwrap(), text.clone().into_bytes());
                        bytes[at] = b'1' + (bytes[at] - b'0' + 1) % 9;
                        tell("digit", json!(String::from_utf8(bytes).unwrap()));
                    }
                }
            }
            Value::Array(items) => {
                for i in [0, items.len() / 2, items.len().saturating_sub(1)] {
                    if i < items.len() {
                        let mut fewer = items.clone();
                        fewer.remove(i);
                        tell(&format!("without {i}"), json!(fewer));
                        let mut more = items.clone();
                        more.insert(i, items[i].clone());
                        tell(&format!("twice {i}"), json!(more));
                    }
                }
                if items.len() > 1 {
                    tell("all but one gone", json!(items[..1]));
                    let mut other = items.clone();
                    other.swap(0, 1);
                    tell("exchanged", json!(other));
                }
                // The first two of a list stand for all.
                for (i, item) in items.iter().enumerate().take(2) {
                    self.value(item, &format!("{path}.{i}"), &|changed| {
                        let mut whole = items.clone();
                        whole[i] = changed;
                        back(json!(whole))
                    });
                }
            }
            Value::Object(map) => {
                let with = |changes: &[(&str, Value)]| {
                    let mut whole = map.clone();
                    changes.iter().for_each(|(key, value)| whole[*key] = value.clone());
                    Value::Object(whole)
                };
                let ends = map.get("lo").zip(map.get("hi"));
                if let Some((lo, hi)) = ends.and_then(|(lo, hi)| Some((lo.as_f64()?, hi.as_f64()?))) {
                    // A wider enclosure would be true, so both ends go.
                    let moved = |x: f64| json!(if x == 0.0 { 0.01 } else { x * 1.01 });
                    tell("moved", with(&[("lo", moved(lo)), ("hi", moved(hi))]));
                    tell("empty", with(&[("lo", json!(hi + 1.0)), ("hi", json!(lo))]));
                } else if let Some((lo, hi)) = ends.and_then(|(lo, hi)| Some((lo.as_str()?, hi.as_str()?))) {
                    let moved = |text: &str| json!(format!("1{text}"));
                    tell("moved", with(&[("lo", moved(lo)), ("hi", moved(hi))]));
                }
                for (key, inner) in map {
                    let mut without = map.clone();
                    without.shift_remove(key);
                    (self.see)(back(Value::Object(without)), format!("{path}.{key} gone"));
                    if ends.is_none() || !["lo", "hi"].contains(&key.as_str()) {
                        self.value(inner, &format!("{path}.{key}"), &|changed| back(with(&[(key, changed)])));
                    }
                }
            }
        }
    }
}

/// Tamperings after which what is written is still true: it says less, or asks another question to which the same answer
/// belongs (all of them computed again for the new question).
const STILL_TRUE: [(&str, &str); 34] = [
    // The usual accuracy; the steps that the schemes replace.
    ("advise tiny", ".input.system.accuracy gone"),
    ("advise tiny", ".input.system.accuracy -> null"),
    ("advise tiny", ".input.system.potentials.1.step digit"),
    // Whether it is tenfold within the run, and whether friction masks it, are the same for runs and frictions not far off.
    ("advise", ".input.length digit"),
    ("advise", ".input.friction digit"),
    ("advise tiny", ".input.system.title -> null"),
    ("advise tiny", ".input.system.title gone"),
    ("advise tiny", ".name -> null"),
    ("advise tiny", ".name gone"),
    ("advise tiny", ".input.system.potentials exchanged"),
    ("verdict", ".trace.exact gone"),
    ("verdict", ".trace.exact -> null"),
    ("tongues", ".input.lambda2 gone"),
    ("tongues", ".input.lambda2 -> null"),
    ("closings", ".complete flipped"),
    // The nine thinnest are a list, too.
    ("tongues --survey", ".thinnest without 9"),
    ("tongues --survey", ".thinnest all but one gone"),
    ("closings", ".input.rho_range digit"),
    ("closings --ratio", ".input.m digit"),
    ("compare --max-sum", ".input.tolerance digit"),
    ("curves", ".input.h1_range digit"),
    ("curves", ".input.h2_range digit"),
    // The order of potentials, springs and ends of a spring means nothing.
    ("system", ".input.system.potentials exchanged"),
    ("system", ".springs exchanged"),
    ("system", ".springs.0 exchanged"),
    ("system", ".springs.1 exchanged"),
    ("simulate", ".input.system.potentials exchanged"),
    ("simulate", ".springs exchanged"),
    ("simulate", ".springs.0 exchanged"),
    ("simulate", ".springs.1 exchanged"),
    // Zeros of a real pair.
    ("system", ".quadrature exchanged"),
    // A mass at rest that nothing is tied to.
    ("system system.json --scan", ".input.system.masses twice 2"),
    ("simulate", ".input.system.masses twice 2"),
    // What the scan replaces.
    ("system system.json --scan", ".potentials.0.step digit"),
];

/// Three masses; at a soft step of 3/4 in place of 1/8 something grows.
const SYSTEM: &str = r#"{"schema": "kickdrift/system/1", "title": "three masses", "masses": ["1", "3/2", "2"], "potentials": [
    {"step": "1/8", "springs": [[0, 1, "10"], [1, 2, "20"]]}, {"step": "1/4", "springs": [[0, null, "5"], [2, null, "7"]]}]}"#;

/// Three clocks on one oscillator, a stiffness with pi.
const ONE_MASS: &str = r#"{"schema": "kickdrift/system/1", "title": "", "masses": ["1"], "potentials": [
    {"step": "1/10", "stiffness": [["pi^2"]]}, {"step": "1/4", "stiffness": [["1/2"]]}, {"step": "1/6", "stiffness": [["2"]]}]}"#;

#[test]
fn every_field_is_rechecked_or_said_not_to_be() {
    let desk = Desk::new();
    let lines = [
        "tongues --ratio 7/3 --rho 1/25",
        "tongues --ratio 5/3 --rho 114/55 --lambda1 pi^2 --digits 20",
        "tongues --max-sum 5 --rho 0",
        "tongues --max-sum 6 --lambda1 pi^2 --lambda2 pi^2/25 --h1-range 1/10..3/5 --h2-range 1/10..2 --columns growth",
        "tongues --ratio 23/20 --rho 1/1000 --m 3..6,22 --columns exact,predicted,growth",
        "tongues --survey --max-sum 14 --rho 1/25",
        "closings --max-sum 9",
        "closings --ratio 9/5 --m 3..9 --samples 60",
        "verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 1/100 --h2 0.98",
        "verdict --lambda1 11/4 --lambda2 57/10 --h1 1 --h2 5/3",
        "map --label --growth --lambda1 10 --lambda2 2/5 --step 1/10 --h1-range 1/10..1/2 --h2-range 1/10..3",
        "compare --max-sum 8 --rho 1/25 --samples 20",
        "compare --lambda1 16 --lambda2 16/25 --step 1/10 --h1-range 1/10..3/5 --h2-range 1/10..2",
        "curves --samples 40 --a 0..2 --b -3..3",
        "polynomial --ratio 5/4",
        "proposition --max 6",
        "system system.json",
        "system resonant.json --exact",
        "system one-mass.json",
        "system system.json --scan potentials.0.step=1/8..3/4:1/8 --scan potentials.1.scale=1..2:1/2",
        "simulate resonant.json --periods 20",
    ];
    desk.write("system.json", SYSTEM);
    desk.write("resonant.json", &SYSTEM.replace("\"1/8\"", "\"3/4\""));
    desk.write("one-mass.json", ONE_MASS);
    let count = tampered(&desk, &lines);
    assert!(count > 2000, "{count}");
}

#[test]
fn every_field_of_advice_is_rechecked_or_said_not_to_be() {
    let desk = Desk::new();
    desk.copy(&["tiny.json", "tiny-fast.npy", "tiny-slow.npy"]);
    let lines = [
        "advise --period OH=10fs --period 40fs --steps 2fs,4fs --steps 2.2fs,4.4fs --length 10ns --friction 1/ps",
        "advise --bond OH:K=450kcal/mol/A^2,15.999,1.008 --period CH=3000/cm --period slow=40fs --steps 1fs,2fs",
        "advise --period 19.45fs --steps 2fs,4fs",
        "advise tiny.json --steps 2.2fs,4.4fs --length 1ns --friction 1/ps",
    ];
    let count = tampered(&desk, &lines);
    assert!(count > 1000, "{count}");
}

/// The number of changes made to the documents of these lines, each of which is found.
fn tampered(desk: &Desk, lines: &[&str]) -> usize {
    let (mut count, mut passed) = (0, Vec::new());
    let options = Options { folder: desk.path().into(), ..Options::default() };
    for line in lines {
        let document = write(desk, line, "d.json");
        let recheck = |value: &Value| {
            let claim = Claim::read(&value.to_string())?;
            claim.recheck(&options, None)
        };
        let sound = recheck(&document).unwrap();
        assert_eq!(sound.failures, [], "{line}");
        let skipped = |path: &str| {
            let named =
                |field: &&str| field.split(':').next().unwrap().split(", ").any(|name| path.contains(name));
            sound.not_rechecked.iter().any(named)
        };
        let mut see = |tampered: Value, what: String| {
            let still_true = |(of, end): &(&str, &str)| line.starts_with(of) && what.ends_with(end);
            let exempt = STILL_TRUE.iter().any(still_true) || what.contains(".kickdrift") // who wrote it is no claim
                || skipped(&what);
            if tampered != document && !exempt {
                count += 1;
                if recheck(&tampered).is_ok_and(|outcome| outcome.failures.is_empty()) {
                    passed.push(format!("{line}: {what}"));
                }
            }
        };
        Tamper { see: &mut see }.value(&document, "", &|changed| changed);
    }
    assert!(passed.is_empty(), "{} of {count} pass:\n{}", passed.len(), passed.join("\n"));
    count
}

#[test]
fn a_map_is_sampled_unless_all_is_asked_for() {
    let desk = Desk::new();
    write(
        &desk,
        "map --lambda1 10 --lambda2 2/5 --step 1/100 --h1-range 1/100..1/2 --h2-range 1/100..1",
        "map.json",
    );
    let told = |args: &[&str]| {
        let ended = desk.run(&[args, &["--format", "json"]].concat());
        assert_eq!(ended.code, Some(0), "{}", ended.stderr);
        serde_json::from_str::<Value>(&ended.stdout).unwrap()["sample"].clone()
    };
    assert_eq!(told(&["verify", "map.json"]), json!({"drawn": 2000, "of": 5000}));
    assert_eq!(told(&["verify", "map.json", "--all"]), json!({"drawn": 5000, "of": 5000}));
}

/// Puts `strange` at every leaf below, one at a time.
fn mutants(value: &Value, strange: &Value, see: &mut dyn FnMut(Value)) {
    match value {
        Value::Object(map) => {
            for (key, inner) in map {
                mutants(inner, strange, &mut |changed| {
                    let mut whole = map.clone();
                    whole[key] = changed;
                    see(Value::Object(whole));
                });
            }
        }
        Value::Array(items) => {
            // The first two of a list stand for all.
            for (i, inner) in items.iter().enumerate().take(2) {
                mutants(inner, strange, &mut |changed| {
                    let mut whole = items.clone();
                    whole[i] = changed;
                    see(Value::Array(whole));
                });
            }
        }
        _ => see(strange.clone()),
    }
}

#[test]
fn nonsense_in_a_document_is_an_error_and_never_a_panic() {
    let desk = Desk::new();
    let lines = [
        "tongues --ratio 5/3 --rho 114/55 --lambda1 2 --digits 20",
        "tongues --max-sum 4 --rho 0",
        "closings --ratio 5/3",
        "tongues --survey --max-sum 5 --rho 1",
        "polynomial --ratio 2/1",
        "proposition --max 2",
        "verdict --lambda1 2 --lambda2 1 --h1 1 --h2 3",
        "compare --max-sum 5 --rho 1/25 --samples 3",
        "compare --lambda1 16 --lambda2 16/25 --step 1/10 --h1-range 1/10..3/5 --h2-range 1/10..1",
        "curves --samples 5 --a 0..1 --b 1..1",
    ];
    let strange =
        [json!(null), json!(-1), json!(0), json!(1e300), json!(1u64 << 62), json!("1/0"), json!([])];
    let mut runs = 0;
    for line in lines {
        let document = write(&desk, line, "d.json");
        for strange in &strange {
            mutants(&document, strange, &mut |mutant| {
                runs += 1;
                desk.write("d.json", &mutant.to_string());
                let ended = desk.run(&["verify", "d.json"]);
                let told = format!("{strange} in {mutant}: {}", ended.stderr);
                assert!(matches!(ended.code, Some(0 | 2)) && !ended.stderr.contains("panicked"), "{told}");
                assert!(ended.stderr.lines().count() <= 1, "{told}");
            });
        }
    }
    assert!(runs > 500, "{runs}");
}
