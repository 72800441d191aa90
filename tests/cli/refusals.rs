//! Bad input: one line that names field, value and remedy, exit code 2, and nothing written.

use super::support::Desk;

/// Processor time that a refusal may take, s: far beyond what any needs, far below the work that it refuses.
const PATIENCE: u32 = 20;

/// Runs and expects a refusal with all of `parts` in its one line.
fn refused(desk: &Desk, args: &[&str], parts: &[&str]) {
    let before = desk.files();
    let ended = desk.run_within(PATIENCE, &[args, &["--output", "nothing"]].concat());
    let line = &ended.stderr;
    assert_eq!((ended.code, ended.stdout.as_str()), (Some(2), ""), "{args:?}: {line}");
    assert!(line.starts_with("kickdrift: ") && line.ends_with('\n') && line.lines().count() == 1, "{line}");
    assert!(line.len() < 1000 && !line.trim_end().contains(char::is_control), "{line}");
    for part in parts {
        assert!(line.contains(part), "{args:?}: no {part:?} in {line}");
    }
    assert_eq!(desk.files(), before, "{args:?} wrote something");
    assert!(!desk.path().join("nothing").exists(), "{args:?} left a folder");
}

fn verdict<'a>(lambda1: &'a str, lambda2: &'a str, h1: &'a str, h2: &'a str) -> Vec<&'a str> {
    vec!["verdict", "--lambda1", lambda1, "--lambda2", lambda2, "--h1", h1, "--h2", h2]
}

#[test]
fn steps_without_a_rational_ratio() {
    let parts = ["h2/h1 = (pi/10)/(1/10)", "irrational", "commensurable"];
    refused(&Desk::new(), &verdict("10", "1", "1/10", "pi/10"), &parts);
}

#[test]
fn steps_and_stiffnesses_out_of_range() {
    let desk = Desk::new();
    refused(&desk, &verdict("10", "1", "0", "1"), &["h1 = 0: ", "positive"]);
    refused(&desk, &verdict("10", "1", "1", "-1/2"), &["h2 = -1/2: ", "positive"]);
    refused(&desk, &verdict("10", "1", "pi-pi", "1"), &["h1 = 0: ", "positive"]);
    refused(&desk, &verdict("0", "1", "1", "1"), &["lambda1 = 0: ", "positive"]);
    refused(&desk, &verdict("3-pi", "1", "1", "1"), &["lambda1 = ", "positive"]);
}

#[test]
fn texts_that_are_no_numbers() {
    let desk = Desk::new();
    for (text, parts) in [
        ("1/0", ["lambda2 = 1/0: ", "zero"]),
        ("1/(1+pi)", ["lambda2 = 1/(1+pi): ", "divide by a rational multiple"]),
        ("NaN", ["lambda2 = NaN: ", "finite"]),
        ("inf", ["lambda2 = inf: ", "finite"]),
        ("", ["lambda2 = : ", "empty"]),
        ("2 pi", ["lambda2 = 2 pi: ", "*"]),
        ("1,5", ["lambda2 = 1,5: ", "','"]),
        ("0x10", ["lambda2 = 0x10: ", "'x'"]),
        ("5.", ["lambda2 = 5.: ", "leave the point out"]),
        ("2^(1/2)", ["lambda2 = 2^(1/2): ", "integer"]),
        ("9^9^9", ["lambda2 = 9^9^9: ", "parentheses"]),
        ("9^999999999", ["lambda2 = 9^999999999: ", "smaller power"]),
        ("1+\nx", ["lambda2 = 1+ x: ", "have none but pi"]),
        ("\u{1b}[31m", ["lambda2 = ", "unexpected"]),
    ] {
        refused(&desk, &verdict("10", text, "1", "1"), &parts);
    }
}

#[test]
fn a_number_of_a_hundred_thousand_digits_is_refused_at_once() {
    let digits = "7".repeat(100_000);
    refused(&Desk::new(), &verdict("10", "1", &digits, "1"), &["h1 = 777", "100000 characters", "shorter"]);
    let threads = ["--threads", &digits];
    refused(&Desk::new(), &[&verdict("10", "1", "1", "1")[..], &threads].concat(), &["threads = 777"]);
}

#[test]
fn a_ratio_that_costs_too_much_names_the_flag_that_allows_it() {
    let desk = Desk::new();
    // Both clocks are beyond their own limits, so every kick would be followed; few of them are slow, so no
    // return map helps.
    refused(&desk, &verdict("1000", "10", "0.12345", "100003"), &["kicks", "--budget", " s;"]);
    // Its verdict is known, and its growth over a period has 2^84 digits.
    refused(
        &desk,
        &verdict("10", "1", "1", "1.000000000000000000000001"),
        &["hyperbolic", "digits", "simpler ratio"],
    );
    let frugal = [&verdict("10", "1", "0.01", "1.01")[..], &["--exact", "--budget", "50"]].concat();
    refused(&desk, &frugal, &["kicks", "--budget 77"]);
    let exact = [&verdict("1", "1/10", "1", "300003")[..], &["--exact"]].concat();
    refused(&desk, &exact, &["exact tier", " s;", "--budget"]);
    refused(&desk, &["polynomial", "--ratio", "1000/7"], &["1000/7", "--budget 2776299"]);
}

#[test]
fn flags_that_are_missing_unknown_or_given_twice() {
    let desk = Desk::new();
    refused(&desk, &["verdict", "--lambda1", "1"], &["lambda2, h1, h2 missing", "--h1 <A>"]);
    refused(&desk, &["polynomial"], &["ratio missing", "--ratio <P/Q>"]);
    refused(&desk, &["run"], &["SCENE.json"]);
    refused(&desk, &["curves", "--sample", "3"], &["--sample", "did you mean --samples?"]);
    refused(&desk, &["advise", "water.json"], &["water.json", "cannot read the system"]);
    refused(
        &desk,
        &[&verdict("10", "1", "1", "1")[..], &["--period", "3"]].concat(),
        &["unknown; --help lists all flags"],
    );
    refused(&desk, &["curves", "--samples", "3", "--samples", "4"], &["samples", "once"]);
    refused(&desk, &["curves", "--format", "yaml"], &["format = yaml", "latex"]);
    refused(&desk, &["curves", "--samples", "3.5"], &["samples = 3.5", "whole number"]);
    refused(&desk, &["curves", "--threads", "0"], &["threads = 0", "1 to"]);
    refused(&desk, &["curves", "--threads", "1000000000"], &["threads = 1000000000", "1 to"]);
    refused(&desk, &["curves", "--samples", "-5"], &["samples = -5", "whole number"]);
    refused(&desk, &[&verdict("10", "1", "1", "1")[..], &["--budget", "-1"]].concat(), &["budget = -1"]);
    refused(&desk, &["curves", "--quiet=1"], &["quiet = 1", "takes no value"]);
    refused(&desk, &["tongues", "--digits", "99999999999"], &["digits = 99999999999", "smaller number"]);
    refused(&desk, &["gadget"], &["command = gadget", "verdict, curves"]);
    refused(&desk, &[], &["command missing", "verdict, curves"]);
    refused(&desk, &["compare"], &["--max-sum"]);
    refused(&desk, &["compare", "--max-sum", "5", "--rho", "1", "--lambda1", "1"], &["--max-sum"]);
}

#[test]
fn ranges_and_grids_without_a_pair() {
    let desk = Desk::new();
    let map = |step: &str, h1: &str, h2: &str, parts: &[&str]| {
        let flags =
            ["map", "--lambda1", "10", "--lambda2", "1", "--step", step, "--h1-range", h1, "--h2-range", h2];
        refused(&desk, &flags, parts);
    };
    map("1/10", "1..1/2", "1..2", &["h1-range = 1..1/2", "smaller number first"]);
    map("1/10", "1..2", "1", &["h2-range = 1: ", "LO..HI"]);
    map("1/10", "1..", "1..2", &["h1-range = 1..: ", "LO..HI"]);
    map("1/10", "1..2", "..2", &["h2-range = ..2: ", "LO..HI"]);
    map("1/10", "1..2", "0.01..0.09", &["h2-range = 1/100..9/100", "1/10"]);
    map("0", "1..2", "1..2", &["step1 = 0", "positive"]);
    map("-1/10", "1..2", "1..2", &["step1 = -1/10", "positive"]);
    map("1e-30", "1..2", "1..2", &["h1-range", "larger step"]);
    let none = ["map", "--lambda1", "1", "--lambda2", "1"];
    refused(&desk, &none, &["step1, step2", "missing", "--h1-range <LO..HI>"]);
    let apart = "map --lambda1 1 --lambda2 1 --step1 1 --step2 pi --h1-range 1..9 --h2-range 1..9";
    refused(&desk, &apart.split(' ').collect::<Vec<_>>(), &["step2/step1", "commensurable"]);
    refused(&desk, &["curves", "--a", "3..1"], &["a = 3..1", "smaller number first"]);
    refused(&desk, &["curves", "--a", "1/2..1"], &["a = 1/2", "integer"]);
    refused(&desk, &["curves", "--h1-range", "-2..-1"], &["h1-range = -2..-1", "positive"]);
    refused(&desk, &["curves", "--samples", "1"], &["samples = 1", "at least 2"]);
    refused(&desk, &["curves", "--samples", "99999999999"], &["samples = 99999999999", "fewer"]);
    refused(&desk, &["curves", "--b", "-9999999..9999999"], &["choose smaller ranges"]);
    refused(&desk, &["compare", "--max-sum", "1", "--rho", "1"], &["max-sum = 1", "2 to"]);
    refused(&desk, &["compare", "--max-sum", "5", "--rho", "pi"], &["rho = pi", "rational"]);
    refused(&desk, &["compare", "--max-sum", "5", "--rho", "1", "--tolerance", "-1"], &["tolerance = -1"]);
    refused(&desk, &["proposition", "--max", "0"], &["max = 0", "1 to"]);
    refused(&desk, &["polynomial", "--ratio", "-1/2"], &["ratio = -1/2", "positive"]);
}

#[test]
fn tongues_that_are_none() {
    let desk = Desk::new();
    let tongues = |line: &str, parts: &[&str]| {
        let flags: Vec<&str> = line.split_whitespace().collect();
        refused(&desk, &flags, parts);
    };
    tongues("tongues --ratio 7/3 --rho -1/25", &["rho = -1/25", "`map`"]);
    tongues("tongues --ratio 7/3 --lambda1 10 --lambda2 -2/5", &["rho = -1/25", "`map`"]);
    tongues("tongues --ratio 7/3 --lambda1 -10 --rho 1", &["lambda1 = -10", "positive"]);
    tongues("tongues --ratio 7/3 --lambda1 pi^2 --lambda2 1", &["lambda2/lambda1 = (1)/(pi^2)", "rational"]);
    tongues("tongues --ratio 7/3", &["rho missing", "lambda1 and lambda2"]);
    tongues("tongues --rho 1", &["ratio missing", "--max-sum"]);
    tongues("tongues --ratio 7/3 --rho 1 --lambda2 1", &["rho = given with lambda2"]);
    tongues("tongues --ratio 7/3 --max-sum 9 --rho 1", &["--max-sum"]);
    tongues("tongues --ratio 7/3 --rho 1 --m 10", &["m = 10", "1 to 9"]);
    tongues("tongues --ratio 7/3 --rho 1 --m 0", &["m = 0", "begin at 1"]);
    tongues("tongues --ratio 7/3 --rho 1 --m 4..2", &["m = 4..2", "smaller number first"]);
    tongues("tongues --ratio 7/3 --rho 1 --m 1,,2", &["m = 1,,2", "empty item"]);
    tongues("tongues --ratio 7/3 --rho 1 --h1-range 1..2", &["lambda1 missing", "s = h1^2 lambda1"]);
    tongues("tongues --ratio 7/3 --rho 1 --digits 0", &["digits = 0", "1 to 10000"]);
    tongues("tongues --ratio 7/3 --rho 1e40", &["rho = 1", "1e16"]);
    tongues("tongues --ratio 99999999/1 --rho 1 --m 1", &["99999999/1", "kicks"]);
    tongues("tongues --max-sum 1 --rho 1", &["max-sum = 1", "2 to"]);
    tongues("tongues --max-sum 9 --rho 1 --columns widths", &["columns = widths", "did you mean width?"]);
    tongues("tongues --max-sum 9 --rho 1 --colour growth", &["--colour = given", ".svg"]);
    tongues("tongues --max-sum 9 --rho 1 --survey --m 3", &["--m = given", "all tongues"]);
    tongues("tongues --ratio 7/3 --rho 1 --survey", &["max-sum missing"]);
    tongues("tongues --max-sum 9 --rho 1 --thinnest 3", &["--thinnest = given", "--survey"]);
    tongues("closings --ratio 5/3 --rho-range -1..2", &["rho-range = -1..2", "0 < LO"]);
    tongues("closings --ratio 5/3 --rho-range 1e400..1e401", &["rho-range = 1000", "range of doubles"]);
    tongues("closings --ratio 5/3 --m 7", &["m = 7", "1 to 6"]);
    tongues("closings --max-sum 9 --m 3", &["m = given", "--ratio"]);
    tongues("closings --max-sum 9 --samples 1", &["samples = 1", "choose 2"]);
}

#[test]
fn scenes_that_cannot_be_read_or_meant() {
    let desk = Desk::new();
    refused(&desk, &["run", "no.json"], &["no.json", "cannot read the scene", "name a scene file"]);
    refused(&desk, &["run", "."], &["cannot read the scene", "name a scene file"]);
    let plane = r#""lambda1": "1", "lambda2": "1", "grid": {"step": "1", "h1": "1..9", "h2": "1..9"}"#;
    for (text, parts) in [
        ("", &["line", "JSON object"][..]),
        ("{", &["line 1 of the scene = {", "JSON object"]),
        ("[1, 2]", &["line 1 of the scene = [1, 2]", "JSON object"]),
        (r#"{"want": ["map"]}"#, &["schema"]),
        (
            r#"{"schema": "kickdrift/scene/2", "want": []}"#,
            &["schema = kickdrift/scene/2", "kickdrift/scene/1"],
        ),
        (r#"{"schema": "kickdrift/scene/1"}"#, &["want"]),
        (r#"{"schema": "kickdrift/scene/1", "want": ["maps"]}"#, &["want = maps", "map, curves"]),
        (r#"{"schema": "kickdrift/scene/1", "want": ["map.png"]}"#, &["want = map.png", "csv"]),
        (r#"{"schema": "kickdrift/scene/1", "want": ["map"]}"#, &["grid missing", "add"]),
        (r#"{"schema": "kickdrift/scene/1", "want": ["polynomial"]}"#, &["ratio missing", "7/2"]),
        (r#"{"schema": "kickdrift/scene/1", "want": ["tongues"]}"#, &["ratio missing", "7/2"]),
        (r#"{"schema": "kickdrift/scene/1", "want": ["survey"], "rho": "1"}"#, &["max_sum missing", "40"]),
        (r#"{"schema": "kickdrift/scene/1", "want": [], "colour": "red"}"#, &["colour = red", "growth"]),
        (r#"{"schema": "kickdrift/scene/1", "lamda1": "1", "want": []}"#, &["lamda1", "lambda1"]),
        (r#"{"schema": "kickdrift/scene/1", "lambda1": true, "want": []}"#, &["true", "write a number"]),
        (r#"{"schema": "kickdrift/scene/1", "lambda1": "1/0", "want": []}"#, &["lambda1 = 1/0", "zero"]),
        (r#"{"schema": "kickdrift/scene/1", "want": ["\u001b\n"]}"#, &["want = "]),
        (&format!(r#"{{"schema": "kickdrift/scene/1", "{}": 1}}"#, "x".repeat(100_000)), &["unknown field"]),
        (
            &format!(r#"{{"schema": "kickdrift/scene/1", {plane}, "want": ["compare"], "tolerance": "x"}}"#),
            &["tolerance = x"],
        ),
        (&"[".repeat(100_000), &["line 1"]),
        (&"x".repeat(2_000_000), &["1 MiB"]),
    ] {
        desk.write("bad.json", text);
        refused(&desk, &["run", "bad.json"], parts);
    }
    std::fs::write(desk.path().join("bad.json"), b"\xff\xfe{}").unwrap();
    refused(&desk, &["run", "bad.json"], &["bad.json", "UTF-8", "name a scene file"]);
}

#[test]
fn a_negative_stiffness_that_outweighs_the_fast_one_is_no_bad_input() {
    let ended = Desk::new().run(&[&verdict("1", "-5", "1", "5/3")[..], &["--format", "json"]].concat());
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    assert!(ended.stdout.contains(r#""resonance": {"m":0,"a":0,"b":0}"#), "{}", ended.stdout);
}

const GRID: &str = "--lambda1 10 --lambda2 1 --step 1/10 --h1-range 1/10..1/2 --h2-range 1/10..1";

fn words(text: &str) -> Vec<&str> {
    text.split_whitespace().collect()
}

#[test]
fn a_directory_of_parts_that_cannot_be_one() {
    let desk = Desk::new();
    desk.write("file", "");
    refused(&desk, &words(&format!("map {GRID} --resume file")), &["file: ", "name another one"]);
    let negative = format!("map {GRID} --shard -1/2 --resume parts");
    refused(&desk, &words(&negative), &["shard = -1/2", "2/16"]);
    refused(&desk, &words("merge file"), &["file/map.json", "--resume"]);
}

#[test]
fn systems_that_cannot_be_read_or_meant() {
    let desk = Desk::new();
    let oscillator = r#"{"schema": "kickdrift/system/1", "masses": ["1"], "potentials": [
        {"name": "only", "step": "1/10", "springs": [[0, null, "1"]]}]}"#;
    desk.write("system.json", oscillator);
    desk.write("wrong.json", &oscillator.replace("masses", "mases"));
    let system = |line: &str, parts: &[&str]| refused(&desk, &words(line), parts);
    system("system none.json", &["none.json", "cannot read the system", "name a system file"]);
    system("system wrong.json", &["system = line 1", "unknown field `mases`", "`masses`", "JSON object"]);
    let twice = "--scan potentials.only.step=1/10..1:1/10 --scan potentials.0.step=1/10..1:1/10";
    system(&format!("system system.json {twice}"), &["potentials.0.step", "both axes"]);
    let clock = |step: &str| format!(r#"{{"step": "{step}", "springs": [[0, null, "1"]]}}"#);
    let clocks = ["1/10", "1/3", "999999999999"].map(clock).join(", ");
    let endless = format!(r#"{{"schema": "kickdrift/system/1", "masses": ["1"], "potentials": [{clocks}]}}"#);
    desk.write("endless.json", &endless);
    system("system endless.json", &["kicks", "simpler ratios"]);
    system("simulate endless.json", &["kicks", "simpler ratios"]);
    let springs = r#""springs": [[0, null, "1"], [0, 1, "2"]]"#;
    let wide =
        endless.replace(r#""springs": [[0, null, "1"]]"#, springs).replace(r#"["1"]"#, r#"["1", "2"]"#);
    desk.write("wide.json", &wide.replacen(springs, r#""springs": [[1, null, "1"]]"#, 1));
    system("system wide.json", &["kicks", "simpler ratios"]);
    system("simulate system.json --periods 99999999999", &["periods = 99999999999", "smaller number"]);
    system("simulate system.json --displace 1e200", &["displace = 1e200", "smaller displacement"]);
}

#[test]
fn forms_that_a_result_has_not() {
    let desk = Desk::new();
    desk.write("scene.json", r#"{"schema": "kickdrift/scene/1", "want": []}"#);
    refused(&desk, &["run", "scene.json", "--format", "csv"], &["format = csv", "text or json"]);
}

#[test]
fn a_file_name_that_ends_in_no_form_of_the_result_is_refused_with_those_that_it_has() {
    let desk = Desk::new();
    desk.write("system.json", &std::fs::read_to_string(SYSTEM).unwrap());
    let tables = ".json, .csv, .tex or .txt";
    let drawn = ".json, .csv, .tex, .txt, .svg, .pdf or .png";
    let map = format!("map {GRID}");
    for (line, forms) in [
        ("verdict --lambda1 1 --lambda2 1 --h1 1 --h2 1", tables),
        ("curves", drawn),
        ("compare --max-sum 5 --rho 1", tables),
        ("proposition", tables),
        ("polynomial --ratio 1", tables),
        ("closings --ratio 5/3 --m 4", tables),
        ("tongues --survey --max-sum 5 --rho 1", tables),
        ("tongues --ratio 5/3 --rho 1", drawn),
        ("system system.json", ".json, .csv, .tex, .txt, .svg, .pdf, .png, .xyz or .vtu"),
        ("simulate system.json", tables),
        (&map, ".json, .csv, .tex, .txt, .svg, .pdf, .png or .npz"),
    ] {
        for name in ["x.ps", "x.eps", "x.jpg"] {
            let ended = desk.run(&[&words(line)[..], &["--output", name]].concat());
            assert_eq!((ended.code, ended.stdout.as_str()), (Some(2), ""), "{line} {name}");
            assert!(
                ended.stderr.contains(name) && ended.stderr.trim_end().ends_with(forms),
                "{}",
                ended.stderr
            );
        }
    }
    assert_eq!(desk.files(), ["system.json"]);
}

const SYSTEM: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/diatomic-tether.json");

#[test]
fn an_output_that_no_file_can_be_is_refused_before_the_work() {
    let desk = Desk::new();
    std::fs::create_dir(desk.path().join("folder")).unwrap();
    // Half an hour, if it began.
    let work = "bands --lambda1 pi^2 --lambda2 pi^2/25 --h1-range 0..2/pi --h2-range 0..7/2 --sectors 20000000 --output";
    for (output, remedy) in
        [("folder", "name a file in it"), ("none/bands.json", "there is no folder none: make it first")]
    {
        let ended = desk.run(&words(&format!("{work} {output}")));
        assert_eq!(ended.code, Some(2), "{output}");
        assert!(ended.stderr.contains(remedy), "{}", ended.stderr);
    }
    for share in ["2", "0", "-1/2"] {
        let ended = desk.run(&words(&format!("{work} bands.json --area {share}")));
        assert!(ended.stderr.contains("share of the window"), "{share}: {}", ended.stderr);
    }
    let beyond = "bands --lambda1 1 --lambda2 1 --h1-range 1/1000..1/500 --h2-range 10..20";
    refused(&desk, &words(beyond), &["h2-range = 10..20: ", "from 1/4096 to 4096"]);
}

#[test]
fn numbers_whose_squares_are_no_doubles_are_no_steps() {
    let desk = Desk::new();
    let scene = |name: &str| format!("{}/data/scenes/{name}.json", env!("CARGO_MANIFEST_DIR"));
    for (name, number) in [("local-steps", "outer"), ("two-bars", "outer"), ("bar-avi", "potentials.0.scale")]
    {
        for range in ["1..1e151", "1..1e400", "1e-400..1"] {
            let asked = format!("{number}={range}");
            refused(
                &desk,
                &["system", &scene(name), "--intervals", &asked],
                &["intervals = ", "1e-150 to 1e150"],
            );
        }
    }
    let spring = r#"{"schema": "kickdrift/system/1", "masses": [1], "potentials": [{"step": "1e400", "springs": [[0, null, 1]]}]}"#;
    desk.write("spring.json", spring);
    for asked in ["--nearest", "--quiet"] {
        refused(&desk, &["system", "spring.json", asked], &["step = ", "1e-150 to 1e150"]);
    }
    let frozen = ["word", "K(1/2) O(1) K(1/2)", "--lambda1", "1", "--friction", "1"];
    refused(&desk, &frozen, &["word = K(1/2) O(1) K(1/2)", "every step is on an edge"]);
}

#[test]
fn work_beyond_the_budget_is_refused_with_its_cost_before_it_begins() {
    let desk = Desk::new();
    desk.write(
        "n2.namd",
        "structure a.psf\nPME yes\ntimestep 1\nnonbondedFreq 2\nfullElectFrequency 99999\n",
    );
    desk.copy(&["tiny.json", "tiny-fast.npy", "tiny-slow.npy"]);
    let advised = desk.run(&words("advise tiny.json --steps 2.2fs,4.4fs --quiet --output advice.json"));
    assert_eq!((advised.code, advised.stderr.as_str()), (Some(0), ""));
    for line in [
        "verdict --lambda1 pi^2 --lambda2 1 --h1 1 --h2 1000001/1000000 --friction 1 --budget 1500000",
        "proposition --max 30 --budget 1000",
        "closings --ratio 501/499 --budget 1000000",
        "advise --period 10fs --period 40fs --steps 3fs,3.0001fs --budget 1000000",
        "advise --period 10fs --period 20fs --period 40fs --engine n2.namd",
        "advise tiny.json --steps 1/10000000fs,4fs",
        concat!(
            "system ",
            env!("CARGO_MANIFEST_DIR"),
            "/data/scenes/chain200.json --intervals outer=7/20..1"
        ),
        concat!(
            "system ",
            env!("CARGO_MANIFEST_DIR"),
            "/data/scenes/bar-resonant.json --nearest --resolution 1e-7"
        ),
        // Wide cells, but twelve ranges one after the other, each with edges that are sharpened.
        concat!(
            "system ",
            env!("CARGO_MANIFEST_DIR"),
            "/data/scenes/chain200.json --nearest --resolution 1e-1"
        ),
        // Rational masses of what is left beside rigid motions.
        concat!(
            "system ",
            env!("CARGO_MANIFEST_DIR"),
            "/data/scenes/ring24.json --nearest --resolution 1e-3"
        ),
        concat!(
            "system ",
            env!("CARGO_MANIFEST_DIR"),
            "/data/scenes/water4.json --intervals outer=0.001..0.005 --budget 30000000"
        ),
        "verify advice.json --budget 100",
        concat!("advise ", env!("CARGO_MANIFEST_DIR"), "/data/scenes/water4.json --budget 1000000"),
        concat!(
            "advise ",
            env!("CARGO_MANIFEST_DIR"),
            "/data/scenes/water4.json --friction 1/ps --budget 30000000"
        ),
    ] {
        let ended = desk.run(&words(line));
        assert_eq!((ended.code, ended.stdout.as_str()), (Some(2), ""), "{line}");
        assert!(ended.stderr.contains("allow it with --budget"), "{line}: {}", ended.stderr);
    }
}

/// A resolution of 0 was ignored; "not told" and the name of a type stood for values.
#[test]
fn resolutions_and_levels_that_make_no_sense() {
    let desk = Desk::new();
    let here = env!("CARGO_MANIFEST_DIR");
    let scene = |name: &str| format!("{here}/data/scenes/{name}");
    for name in ["local-steps.json", "bar-avi.json", "two-bars.json"] {
        for width in ["0", "-1", "1e-30", "2"] {
            let file = scene(name);
            let args = ["system", &file, "--intervals", "outer=1/2..1", "--resolution", width];
            refused(&desk, &args, &["resolution = ", "choose 1e-9 to 0.1"]);
        }
    }
    let text = std::fs::read_to_string(scene("local-steps.json")).unwrap();
    desk.write("both.json", &text.replace(r#""elements": [2, 3],"#, r#""elements": [2, 3], "fine": [1],"#));
    refused(&desk, &["system", "both.json"], &["levels[0] = both: ", "one of them"]);
    let text = std::fs::read_to_string(scene("membrane.json")).unwrap();
    let text = text.replace("../hessians", &format!("{here}/data/hessians"));
    let fine = text.split(r#"{"fine": "#).nth(1).unwrap().split('}').next().unwrap().to_string() + "}";
    desk.write("fine.json", &text.replace(&fine, "[-1]"));
    refused(&desk, &["system", "fine.json"], &["levels[0].fine = ", "indices are 0 to 99"]);
}
