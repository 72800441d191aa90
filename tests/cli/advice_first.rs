//! Answers come first, and the rest where it is asked for.

use super::support::{run, stdout, words};

const WATER: &str = "advise --period OH=10fs --period slow=40fs --steps 0.5fs,4fs --steps 0.5fs,5fs";

/// On periods and on molecules, whatever is asked beside.
#[test]
fn an_answer_has_twelve_lines_and_says_where_the_rest_is() {
    let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes");
    let many: String = (2..=14).map(|n| format!(" --steps 0.5fs,{}fs", f64::from(n) / 2.0)).collect();
    for line in [
        WATER.to_string(),
        format!("advise --period OH=10fs --period 40fs{many}"),
        format!("advise {scenes}/water4.json --steps 0.5fs,4.5fs --friction 1/ps --hmr 1.5"),
        format!("advise {scenes}/no-gradient.json --steps 20fs,60fs --friction 1/10/ps"),
    ] {
        let (few, all) = (stdout(&words(&line, &[])), stdout(&words(&line, &["--details"])));
        let lines: Vec<&str> = few.lines().collect();
        assert!(lines.len() <= 12 && lines.iter().any(|line| line.starts_with("advice: ")), "{few}");
        assert!(lines.last().unwrap().ends_with("--details") && all.lines().count() > 20, "{few}{all}");
        // Nothing is in the answer that is not in all there is to say, but for how many schemes are left out.
        let told = |line: &&&str| !all.lines().any(|other| other == **line);
        assert!(lines.iter().filter(told).count() <= 2, "{few}{all}");
    }
    let ended = run(&words(WATER, &["--details", "--format", "json"]));
    assert!(ended.code == Some(2) && ended.stderr.contains("other forms have all"), "{}", ended.stderr);
}

#[test]
fn levers_that_gain_the_same_within_two_hundredths_are_one() {
    let text = stdout(&words(WATER, &[]));
    let longer = text.lines().find(|line| line.starts_with("longer: ")).unwrap();
    assert_eq!(
        longer,
        "longer: 6.36 fs by equilibrium MOLLY or implicit-explicit (1.91 times the 3.33 fs of kicks and drifts at their best); 4.74 fs by long-average MOLLY or linear-average MOLLY (1.42 times); 4.62 fs by short-average MOLLY (1.39 times)"
    );
}

/// A verdict stood below nine lines on a word, its steps below its error; a table of forty rows below counts.
#[test]
fn a_verdict_comes_first_and_what_stands_behind_it_with_details() {
    let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes");
    for (line, second, hidden) in [
        (
            "word --method respa-4 --lambda1 pi^2 --lambda2 pi^2/25 --h 1".to_string(),
            "  verdict      stable at h = 1",
            "  error",
        ),
        ("word --method mclachlan-atela-4".into(), "  stable       0 < omega h", "  frequency"),
        (format!("system {scenes}/bar-resonant.json"), "  24 degrees of freedom", "-0.950498"),
        (format!("system {scenes}/water4.json"), "  36 degrees of freedom", "rigid motions projected out"),
        ("compare --max-sum 8 --rho 1/25 --samples 20".into(), "tan criterion: agrees everywhere", "44/21"),
    ] {
        let (few, all) = (stdout(&words(&line, &[])), stdout(&words(&line, &["--details"])));
        let lines: Vec<&str> = few.lines().collect();
        assert!(lines.len() <= 12 && lines[1].starts_with(second), "{few}");
        assert!(lines.last().unwrap().ends_with("--details") && !few.contains(hidden), "{few}");
        assert!(all.contains(hidden) && !all.contains("--details"), "{all}");
        let ended = run(&words(&line, &["--details", "--format", "json"]));
        assert!(ended.code == Some(2) && ended.stderr.contains("other forms have all"), "{}", ended.stderr);
    }
    // What is asked for by name is shown.
    let columns = stdout(&words("compare --max-sum 4 --rho 1/25 --samples 9 --columns p,q,offence", &[]));
    assert!(columns.contains("\np  q  offence\n"), "{columns}");
}
