//! `run`: the products a scene wants, all of them and no other.

use serde_json::{Value, json};

use super::support::{Desk, Ended};

fn scene(want: &[&str]) -> Value {
    json!({
        "schema": "kickdrift/scene/1",
        "lambda1": "pi^2",
        "lambda2": "pi^2/25",
        "grid": {"step": "1/10", "h1": "1/10..2/pi", "h2": "1/10..2"},
        "families": {"a": "0..1", "b": "-2..2", "samples": 20},
        "ratio": "3/2",
        "max": 4,
        "want": want
    })
}

fn run(desk: &Desk, scene: &Value, more: &[&str]) -> Ended {
    desk.write("tiny.json", &scene.to_string());
    desk.run(&[&["run", "tiny.json"], more].concat())
}

#[test]
fn a_scene_writes_what_it_wants_and_no_more() {
    let all = [
        "map.json",
        "map.csv",
        "map.tex",
        "map.txt",
        "curves.csv",
        "compare.json",
        "proposition.txt",
        "polynomial.tex",
        "figure.svg",
        "figure.png",
        "overlay.svg",
        "overlay.png",
    ];
    for want in [&all[..], &all[..1], &["figure.png"], &["polynomial"], &[]] {
        let desk = Desk::new();
        let ended = run(&desk, &scene(want), &["--output", "here"]);
        assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
        let mut expected: Vec<String> = want
            .iter()
            .map(|name| format!("here/{name}{}", if name.contains('.') { "" } else { ".json" }))
            .chain(["tiny.json".to_string()])
            .collect();
        expected.sort();
        assert_eq!(desk.files(), expected);
    }
}

#[test]
fn without_an_output_folder_the_products_lie_in_out_under_the_name_of_the_scene() {
    let desk = Desk::new();
    let ended = run(&desk, &scene(&["map"]), &[]);
    assert_eq!(ended.code, Some(0));
    assert_eq!(desk.files(), ["out/tiny/map.json", "tiny.json"]);
    assert!(ended.stdout.contains("out/tiny/map.json") && ended.stdout.contains("pairs, each decided"));
}

#[test]
fn figures_are_what_their_names_say() {
    let desk = Desk::new();
    run(&desk, &scene(&["figure.svg", "figure.png"]), &["--output", "f"]);
    let svg = String::from_utf8(desk.read("f/figure.svg")).unwrap();
    assert!(svg.starts_with("<svg") || svg.starts_with("<?xml"), "{}", &svg[..60]);
    assert!(svg.trim_end().ends_with("</svg>"));
    let png = desk.read("f/figure.png");
    assert!(png.starts_with(b"\x89PNG\r\n\x1a\n") && png.len() > 10_000, "{} bytes", png.len());
}

#[test]
fn a_scene_gives_the_same_bytes_on_one_thread_and_on_two_and_when_run_again() {
    let desk = Desk::new();
    let want = ["map.csv", "curves.json", "compare.json", "overlay.svg", "figure.png"];
    for (folder, threads) in [("one", "1"), ("two", "2"), ("one", "2")] {
        assert_eq!(run(&desk, &scene(&want), &["--output", folder, "--threads", threads]).code, Some(0));
    }
    for name in want {
        assert_eq!(desk.read(&format!("one/{name}")), desk.read(&format!("two/{name}")), "{name}");
    }
}

#[test]
fn a_product_of_a_scene_is_what_the_command_of_its_name_prints() {
    let desk = Desk::new();
    run(&desk, &scene(&["map.json", "polynomial.json"]), &["--output", "p"]);
    let map = "map --lambda1 pi^2 --lambda2 pi^2/25 --step 0.1 --h1-range 0.1..2/pi --h2-range 0.1..2";
    for (file, line) in [("p/map.json", map), ("p/polynomial.json", "polynomial --ratio 3/2 --format json")] {
        let ended = desk.run(&line.split(' ').collect::<Vec<_>>());
        assert_eq!(String::from_utf8(desk.read(file)).unwrap(), ended.stdout);
    }
}

#[test]
fn the_closing_document_echoes_the_scene_as_exact_strings() {
    let desk = Desk::new();
    let mut scene = scene(&["map.txt", "figure"]);
    scene["tolerance"] = "0.05".into();
    let ended = run(&desk, &scene, &["--output", "o", "--format", "json"]);
    let document: Value = serde_json::from_str(&ended.stdout).unwrap();
    let input = &document["input"];
    let expected = json!({
        "title": "", "lambda1": "pi^2", "lambda2": "pi^2/25", "step1": "1/10", "step2": "1/10",
        "h1_range": "1/10..2/pi", "h2_range": "1/10..2", "a": "0..1", "b": "-2..2", "samples": "20",
        "tolerance": "1/20", "ratio": "3/2", "max": "4", "want": "map.txt, figure.svg"
    });
    assert_eq!(*input, expected);
    assert_eq!(document["products"][1], json!({"product": "figure", "file": "o/figure.svg"}));
}

#[test]
fn a_json_number_is_the_exact_number_that_stands_there() {
    let desk = Desk::new();
    let long = "0.1000000000000000055511151231257827021181583404541015625";
    for (number, exact) in [("0.1", "1/10"), ("1e-1", "1/10"), ("10", "10"), (long, long)] {
        let text = r#"{"schema": "kickdrift/scene/1", "rho": NUMBER, "want": []}"#;
        desk.write("number.json", &text.replace("NUMBER", number));
        desk.write("text.json", &text.replace("NUMBER", &format!("\"{exact}\"")));
        let echo = |file| desk.run(&["run", file, "--format", "json"]).stdout;
        assert!(
            echo("number.json").contains(r#""rho":""#) && echo("number.json") == echo("text.json"),
            "{number}"
        );
    }
    let system = r#"{"schema": "kickdrift/system/1", "masses": [1], "potentials": [
        {"step": 0.1, "springs": [[0, null, LAMBDA]]}, {"step": 3e-1, "springs": [[0, null, 2.50]]}]}"#;
    desk.write("number.json", &system.replace("LAMBDA", "0.3"));
    desk.write(
        "text.json",
        &system.replace("LAMBDA", "\"3/10\"").replace("0.1", "\"1/10\"").replace("3e-1", "\"3/10\""),
    );
    let verdict = |file| desk.run(&["system", file, "--exact"]);
    assert_eq!(
        (verdict("number.json").code, verdict("number.json").stdout),
        (Some(0), verdict("text.json").stdout)
    );
    let scan = |file| {
        let axes = ["--scan", "potentials.1.step=1/10..3/10:1/10", "--scan", "potentials.0.scale=1/2..1:1/2"];
        let json = desk.run(&[&["system", file], &axes[..]].concat());
        assert_eq!(json.code, Some(0), "{}", json.stderr);
        let mut document: Value = serde_json::from_str(&json.stdout).unwrap();
        // The document holds the file as it is written.
        document["input"] = Value::Null;
        document
    };
    assert_eq!(scan("number.json"), scan("text.json"));
}

/// The polynomial alone would do; the Proposition's bound is out of range. Neither is written.
#[test]
fn an_error_in_a_late_product_leaves_no_early_one_and_no_folder() {
    let desk = Desk::new();
    let mut scene = scene(&["polynomial.json", "proposition.json"]);
    scene["max"] = 100_000.into();
    let ended = run(&desk, &scene, &["--output", "deep/er/folder"]);
    assert_eq!(ended.code, Some(2));
    assert_eq!(ended.stderr.lines().count(), 1);
    assert!(ended.stderr.contains("max = 100000"), "{}", ended.stderr);
    assert_eq!(desk.files(), ["tiny.json"]);
    assert!(!desk.path().join("deep").exists());
}
