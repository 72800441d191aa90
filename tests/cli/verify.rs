//! `verify`: what kickdrift wrote holds; what was changed does not, and the row is named.

use kickdrift::recheck::{CheckedDocument, Options, Outcome};
use serde_json::{Value, json};

use super::support::{Desk, words};

/// One document of every kind that can be rechecked, with all columns.
const DOCUMENTS: [&str; 33] = [
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
    "advise --bond OH:poly:k2=254049kJ/mol/nm^2,k3=-5810111kJ/mol/nm^3,k4=77511731kJ/mol/nm^4,15.999,1.008 --period slow=40fs --steps 0.5fs,2fs --temperature 310K --bonds 1000 --no-levers",
    "advise --period 19.45fs --steps 2fs,4fs",
    // Nine inner steps are taken where two would end before them.
    "advise --period OH=14.1fs --period 34.1fs --steps 0.5fs,1fs --band 0.2",
    "advise --period 10fs --period 40fs --period 100fs --steps 0.7fs,1fs,3fs",
    "bands --lambda1 pi^2 --lambda2 pi^2/25 --h1-range 1/5..1/4 --h2-range 9/10..1 --sectors 200",
    "aperture --bond OH:poly:k2=254049.483068kJ/mol/nm^2,k3=-5810111.67776516kJ/mol/nm^3,k4=77511731.54111870kJ/mol/nm^4,15.999,1.008 --steps 1.5fs,1.95fs --method baoab",
    "word --method avi-3-2 --lambda1 pi^2 --lambda2 pi^2/25 --h 1 --h-range 0..3",
    "word --method forest-ruth",
    "word --list",
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

/// An array of NumPy's of doubles.
fn npy(shape: &str, values: &[f64]) -> Vec<u8> {
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({shape}), }}");
    let mut bytes = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    bytes.extend(format!("{header:<117}\n").bytes());
    bytes.extend(values.iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

/// Rigid motions that roundings make a little stiff are projected out by both routes.
#[test]
fn measured_stiffnesses_of_three_clocks_hold() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.2, 1.1, 0.1], [0.3, 0.2, 0.9]];
    let springs = |pairs: &[(usize, usize)]| {
        let mut k = vec![0.0; 144];
        for &(i, j) in pairs {
            let apart: [f64; 3] = std::array::from_fn(|a| corners[i][a] - corners[j][a]);
            let square: f64 = apart.iter().map(|x| x * x).sum();
            for (a, b) in (0..3).flat_map(|a| (0..3).map(move |b| (a, b))) {
                for (from, to, sign) in [(i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)] {
                    k[12 * (3 * from + a) + 3 * to + b] += sign * apart[a] * apart[b] / square;
                }
            }
        }
        k
    };
    let desk = Desk::new();
    let put = |name: &str, bytes: Vec<u8>| std::fs::write(desk.path().join(name), bytes).unwrap();
    put("m.npy", npy("4,", &[1.0, 2.0, 3.0, 1.5]));
    put("x.npy", npy("4, 3", corners.as_flattened()));
    for (name, pairs) in
        [("a.npy", [(0, 1), (1, 2)]), ("b.npy", [(0, 2), (2, 3)]), ("c.npy", [(0, 3), (1, 3)])]
    {
        put(name, npy("12, 12", &springs(&pairs)));
    }
    let potential =
        |(name, step): (&str, &str)| json!({"step": step, "stiffness": {"npy": format!("{name}.npy")}});
    for steps in [["1/8", "1/4", "1/2"], ["1/2", "1", "2"]] {
        let potentials: Vec<Value> = ["a", "b", "c"].into_iter().zip(steps).map(potential).collect();
        let system = json!({"schema": "kickdrift/system/1", "title": "a tetrahedron", "masses": {"npy": "m.npy"},
            "positions": {"npy": "x.npy"}, "potentials": potentials});
        desk.write("s.json", &system.to_string());
        write(&desk, "system s.json --friction 1/10", "d.json");
        let ended = desk.run(&["verify", "d.json"]);
        assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""), "{steps:?}");
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
        (DOCUMENTS[13], "row", |d, _| d["input"]["max_sum"] = json!("9")),
        (DOCUMENTS[14], "row", |d, _| d["input"]["h2_range"] = json!("1/10..3")),
        (DOCUMENTS[13], "row 0", |d, _| d["unstable"] = json!(d["unstable"].as_u64().unwrap() + 1)),
        (DOCUMENTS[16], "row 0 polynomials.C is", |d, _| d["polynomials"]["C"] = json!("(-1/2*rho - 1/2)*s")),
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
    let options = Options::default();
    for (i, (line, row, change)) in changes.into_iter().enumerate() {
        let mut document = write(&desk, line, "d.json");
        change(&mut document, &moved);
        let found =
            |outcome: Outcome| outcome.failures.first().map(|own| format!("row {} {}", own.row, own.why));
        let checked = CheckedDocument::read(&document.to_string());
        let told = match checked.and_then(|checked| checked.verify(&options, None)) {
            Ok(outcome) => found(outcome).unwrap_or_else(|| panic!("change {i} of {line} passes")),
            Err(error) => error.to_string(),
        };
        assert!(told.contains(row), "change {i} of {line}: {told}");
    }
}

#[test]
fn a_lie_is_one_line_on_standard_error() {
    let desk = Desk::new();
    let mut document = write(&desk, DOCUMENTS[0], "d.json");
    document["tongues"][3]["lower"]["lo"] = json!(0.25);
    desk.write("d.json", &document.to_string());
    let ended = desk.run(&["verify", "d.json"]);
    assert_eq!((ended.code, ended.stdout.as_str()), (Some(2), ""));
    let told = ["row 4 of tongues", "p = 7, q = 3, m = 4", "lower.lo is", "1 of 9 rows"];
    assert!(told.iter().all(|part| ended.stderr.contains(part)), "{}", ended.stderr);
    assert_eq!(ended.stderr.lines().count(), 1, "{}", ended.stderr);
}

/// The input names the columns, so rows that all lack one answer another question.
#[test]
fn a_column_that_is_gone_from_every_row_is_missed() {
    let desk = Desk::new();
    let mut document = write(&desk, "tongues --ratio 7/3 --rho 1/25", "d.json");
    for row in document["tongues"].as_array_mut().unwrap() {
        row.as_object_mut().unwrap().shift_remove("growth").unwrap();
    }
    desk.write("d.json", &document.to_string());
    let ended = desk.run(&["verify", "d.json"]);
    assert_eq!(ended.code, Some(2));
    let told = ["growth is missing", "9 of 9 rows"];
    assert!(told.iter().all(|part| ended.stderr.contains(part)), "{}", ended.stderr);
    // What was asked for stands in the input: without growth it is another question.
    let ended = desk.run(&words(
        "tongues --ratio 7/3 --rho 1/25",
        &["--columns", "exact,predicted,first-order", "--output", "e.json"],
    ));
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    assert_eq!(desk.run(&["verify", "e.json"]).code, Some(0));
}

/// A document of one row has no other rows to count, and is named itself.
#[test]
fn a_lie_in_a_document_without_rows_names_the_document_and_counts_its_values() {
    let desk = Desk::new();
    let mut document = write(&desk, "verdict --lambda1 10 --lambda2 2/5 --h1 1/100 --h2 9/10", "d.json");
    (document["p"], document["q"]) = (json!(5), json!(7));
    desk.write("d.json", &document.to_string());
    let told = desk.run(&["verify", "d.json"]).stderr;
    assert!(
        told.starts_with("kickdrift: document = ") && told.contains("(2 values of d.json differ)"),
        "{told}"
    );
    assert!(!told.contains("rows") && !told.contains("= :"), "{told}");
}

#[test]
fn a_file_of_another_kind_names_the_command_that_reads_it() {
    let desk = Desk::new();
    desk.write("scene.json", r#"{"schema": "kickdrift/scene/1", "want": []}"#);
    desk.write("system.json", r#"{"schema": "kickdrift/system/1", "masses": []}"#);
    write(&desk, "half --ratio 5/3 --s 11/4 --rho 1/25", "half.json");
    for (line, part) in [
        ("run system.json", "is a system: kickdrift system FILE"),
        ("system scene.json", "is a scene: kickdrift run FILE"),
        ("advise scene.json", "is a scene: kickdrift run FILE"),
        ("run half.json", "is an answer of kickdrift: kickdrift verify FILE"),
        ("system half.json", "is an answer of kickdrift: kickdrift verify FILE"),
    ] {
        let ended = desk.run(&words(line, &[]));
        assert!(ended.code == Some(2) && ended.stderr.contains(part), "{line}: {}", ended.stderr);
    }
}

/// An enclosure moved as a whole.
fn by_both(enclosure: &Value, moved: &dyn Fn(&Value, f64) -> Value, by: f64) -> Value {
    json!({"lo": moved(&enclosure["lo"], by), "hi": moved(&enclosure["hi"], by)})
}

#[test]
fn what_cannot_be_rechecked_is_told() {
    let desk = Desk::new();
    desk.write("verify.json", r#"{"schema": "kickdrift/verify/1"}"#);
    desk.write("text.json", "no JSON");
    desk.write("scene.json", r#"{"schema": "kickdrift/scene/1", "want": []}"#);
    desk.write("system.json", r#"{"schema": "kickdrift/system/1", "masses": []}"#);
    desk.write("bare.json", r#"{"schema": "kickdrift/tongues/1"}"#);
    for (file, parts) in [
        ("verify.json", &["kickdrift/verify/1", "one of tongues, closings, survey"][..]),
        ("text.json", &["document = no JSON", "as kickdrift wrote them"]),
        ("bare.json", &["document = not as kickdrift writes it: missing field `input`"]),
        ("none.json", &["none.json", "cannot read it"]),
        ("scene.json", &["is a scene: kickdrift run FILE"]),
        ("system.json", &["is a system: kickdrift system FILE"]),
    ] {
        let ended = desk.run(&["verify", file]);
        assert_eq!((ended.code, ended.stdout.as_str()), (Some(2), ""), "{file}");
        assert!(parts.iter().all(|part| ended.stderr.contains(part)), "{file}: {}", ended.stderr);
    }
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
    let mut refused = 0;
    for line in lines {
        let document = write(&desk, line, "d.json");
        for strange in &strange {
            mutants(&document, strange, &mut |mutant| {
                let checked = CheckedDocument::read(&mutant.to_string());
                if let Err(error) = checked.and_then(|checked| checked.verify(&Options::default(), None)) {
                    refused += 1;
                    assert_eq!(error.to_string().lines().count(), 1, "{strange} in {mutant}: {error}");
                }
            });
        }
    }
    // What stands in rows is compared and not read, so inputs and heads alone are refused.
    assert!(refused > 400, "{refused}");
}

#[test]
fn an_input_that_makes_no_sense_is_an_error_that_names_its_field() {
    let desk = Desk::new();
    let line = "advise --bond OH:K=450kcal/mol/A^2,15.999,1.008 --period angle=13fs --period 40fs --constraints OH --steps 1fs,2fs";
    let sound = write(&desk, line, "d.json");
    let told = |change: &dyn Fn(&mut Value)| {
        let mut document = sound.clone();
        change(&mut document);
        let checked = CheckedDocument::read(&document.to_string());
        checked.and_then(|checked| checked.verify(&Options::default(), None)).unwrap_err().to_string()
    };
    type Change = fn(&mut Value);
    let cases: [(&str, Change); 6] = [
        ("friction = -1/1000", |d| d["input"]["friction"] = json!("-1/1000")),
        ("length = -7", |d| d["input"]["length"] = json!("-7")),
        ("constrained[0].stiffness = 1/7466200x", |d| {
            d["input"]["constrained"][0]["stiffness"] = json!("1/7466200x")
        }),
        ("constrained[0].stiffness = -1", |d| d["input"]["constrained"][0]["stiffness"] = json!("-1")),
        ("kickdrift = null", |d| drop(d.as_object_mut().unwrap().shift_remove("kickdrift"))),
        ("length = null", |d| d["input"]["length"] = json!(null)),
    ];
    for (part, change) in cases {
        let told = told(&change);
        assert!(told.contains(part), "{part}: {told}");
    }
}

#[test]
fn a_second_route_that_costs_too_much_is_left_out_and_named() {
    let desk = Desk::new();
    desk.copy(&["tiny.json", "tiny-fast.npy", "tiny-slow.npy"]);
    let left = |line: &str, more: &[&str]| {
        write(&desk, line, "document.json");
        let told = desk.run(&[&["verify", "document.json"], more].concat());
        assert_eq!((told.code, told.stderr.as_str()), (Some(0), ""), "{line}");
        let named = told.stdout.lines().filter(|line| line.contains("by another route"));
        named.map(String::from).collect::<Vec<_>>()
    };
    // The actions of a scheme of many inner steps cost the cube of their number.
    let advice = "advise tiny.json --steps 1/20fs,4fs --no-levers";
    let costly = left(advice, &["--budget", "10000000"]);
    assert!(
        costly.len() == 1 && costly[0].contains("row ") && costly[0].contains("a budget of "),
        "{costly:?}"
    );
    assert_eq!(left(advice, &[]), Vec::<String>::new());
    let small = left("system tiny.json", &["--budget", "170"]);
    assert!(small.len() == 1 && small[0].contains("a budget of 313 allows it"), "{small:?}");
    assert_eq!(left("system tiny.json", &[]), Vec::<String>::new());
}
