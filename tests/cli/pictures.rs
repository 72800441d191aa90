//! Pictures explain themselves: each thing has one name in their keys, and words beside them are told.

use super::support::Desk;

/// How often a label says these words.
fn says(svg: &str, words: &str) -> usize {
    svg.matches(&format!("aria-label=\"{words}\"")).count()
}

fn drawn(args: &[&str]) -> String {
    let desk = Desk::new();
    let ended = desk.run(args);
    assert_eq!(ended.code, Some(0), "{args:?}: {}", ended.stderr);
    String::from_utf8(desk.read("a.svg")).unwrap()
}

const PERIODS: [&str; 5] = ["advise", "--period", "OH=10fs", "--period", "40fs"];

#[test]
fn a_family_of_curves_and_its_tongues_are_one_entry() {
    let window = ["--h1-range", "0..2/pi", "--h2-range", "0..7/2", "--width", "85mm", "--output", "a.svg"];
    let args = ["tongues", "--max-sum", "9", "--lambda1", "pi^2", "--lambda2", "pi^2/25"];
    let svg = drawn(&[&args[..], &window].concat());
    let entries: Vec<usize> =
        ["0", "1", "2", "3", "−1", "−2", "−3"].map(|a| says(&svg, &format!("family a = {a}"))).into();
    assert_eq!((entries, svg.matches("curves a = ").count()), (vec![1; 7], 0));
    assert!(svg.contains("pale: curves 1/T"), "what is pale has no name");
}

#[test]
fn panels_that_show_the_same_name_it_once() {
    let side = ["compare", "--methods", "impulse,gautschi", "--lambda1", "pi^2/25", "--h-range", "0..16"];
    let rest = ["--h-step", "1", "--rho-range", "0..1/4", "--rho-step", "1/8", "--output", "a.svg"];
    assert_eq!(says(&drawn(&[&side[..], &rest].concat()), "unstable"), 1);
    let trace = ["tongues", "--ratio", "5/3", "--rho", "1/25", "--figure", "trace", "--output", "a.svg"];
    let svg = drawn(&trace);
    assert_eq!(["tongue, between certified edges", "|Tr Q| = 2"].map(|words| says(&svg, words)), [1, 1]);
}

/// A judgement stood beside its step without a word on what it means.
#[test]
fn a_judgement_beside_a_step_is_explained_below() {
    for (step, status, meaning) in [
        ("0.5fs,3fs", "safe", "below what is published"),
        ("0.5fs,4fs", "caution", "beyond a published limit"),
        ("0.5fs,4.5fs", "near", "not for all in the band"),
        ("0.5fs,5fs", "island", "above an unstable interval"),
    ] {
        let svg = drawn(&[&PERIODS[..], &["--steps", step, "--output", "a.svg"]].concat());
        assert!(svg.contains(&format!(": {status}\"")), "{step} is not {status}");
        let foot = svg.split("aria-label=\"").find(|label| label.starts_with("OH (T = ")).unwrap();
        assert!(foot.contains(&format!("{status}: ")) && foot.contains(meaning), "{foot}");
    }
}

/// A dashed line at 3 fs stood in a row in which 0.9 fs is proven.
#[test]
fn no_step_is_recommended_in_a_row_where_it_is_not_proven() {
    for (steps, said) in [("0.5fs,4fs", 1), ("0.5fs,4.8fs", 0)] {
        let svg = drawn(&[&PERIODS[..], &["--steps", steps, "--output", "a.svg"]].concat());
        assert_eq!(says(&svg, "recommended"), said, "{steps}");
    }
}

/// Fifteen ratios within 2 % of each other were fifteen rows.
#[test]
fn levers_that_reach_as_far_are_one_row() {
    let args = [&PERIODS[..], &["--steps", "0.5fs,4fs", "--levers", "a.svg"]].concat();
    let svg = drawn(&args);
    let rows = [
        "equilibrium MOLLY or implicit-explicit",
        "ratio 5 or 9 others",
        "long-average MOLLY (no unstable step)",
    ];
    assert_eq!(rows.map(|words| says(&svg, words)), [1, 1, 1]);
    assert_eq!(says(&svg, "ratio 9"), 0);
}

#[test]
fn dots_of_strengths_have_a_key() {
    let args = ["tongues", "--max-sum", "9", "--lambda1", "10", "--lambda2", "2/5", "--figure", "strength"];
    assert_eq!(says(&drawn(&[&args[..], &["--output", "a.svg"]].concat()), "a tongue, shaded by its q"), 1);
}

/// A figure, a caption and a line said `masses.0`.
#[test]
fn a_number_that_is_varied_is_named_in_words() {
    let desk = Desk::new();
    desk.write(
        "system.json",
        r#"{"schema": "kickdrift/system/1", "masses": [1], "potentials": [
            {"step": "1/10", "springs": [[0, null, 4]]}, {"step": "1/5", "springs": [[0, null, 1]]}]}"#,
    );
    for (args, name, words) in [
        (["--intervals", "masses.0=1/2..1"], "mass of particle 0", ["of the ", " from 1/2 to 1\""]),
        (["--scan", "potentials.1.step=1/10..1/5:1/10"], "step of potential 1", ["over the ", " by 1/10\""]),
    ] {
        let run = |rest: &[&str]| desk.run(&[&["system", "system.json"], &args[..], rest].concat()).stdout;
        let [text, latex] = ["text", "latex"].map(|format| run(&["--format", format]));
        run(&["--output", "a.svg"]);
        // The command that made it is no caption.
        let svg = String::from_utf8(desk.read("a.svg")).unwrap();
        let svg = svg.lines().filter(|line| line.contains("aria-label")).collect::<String>();
        let path = args[1].split('=').next().unwrap();
        for (shown, words) in [(text, words[0]), (latex, name), (svg, words[1])] {
            assert!(shown.contains(name) && shown.contains(words) && !shown.contains(path), "{shown}");
        }
    }
}
