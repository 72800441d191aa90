//! `compare --methods`.

use super::support::Desk;

const GRID: &str = "--lambda1 pi^2/25 --h-range 0..16 --h-step 1/2 --rho-range 0..1/4 --rho-step 1/16";

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

#[test]
fn integrators_stand_side_by_side_and_their_counts_are_verified() {
    let desk = Desk::new();
    let line = format!("compare --methods impulse,molly-long,implicit-explicit,pefrl {GRID}");
    let told = desk.run(&words(&line));
    assert_eq!((told.code, told.stderr.as_str()), (Some(0), ""));
    // Periods 10 and 40 are ρ = 1/16: 32 steps of four ratios.
    assert!(told.stdout.contains("128 points") && told.stdout.contains("molly-long"), "{}", told.stdout);
    let free = told.stdout.lines().find(|line| line.starts_with("molly-long")).unwrap();
    assert_eq!(free.split_whitespace().collect::<Vec<_>>(), ["molly-long", "128", "0", "0", "4", "0"]);
    for form in ["json", "csv", "tex", "svg", "png"] {
        let file = format!("side.{form}");
        assert_eq!(desk.run(&[words(&line), vec!["--output", &file]].concat()).code, Some(0), "{form}");
    }
    assert_eq!(desk.run(&["verify", "side.json"]).code, Some(0));
    // A count that is told off by one.
    let text =
        String::from_utf8(desk.read("side.json")).unwrap().replacen("\"stable\":128", "\"stable\":127", 1);
    desk.write("side.json", &text);
    assert_eq!(desk.run(&["verify", "side.json"]).code, Some(2));
}

#[test]
fn what_is_no_integrator_or_no_grid_is_refused_in_a_line() {
    let desk = Desk::new();
    for (line, part) in [
        ("--methods rk4 --h-range 0..1 --h-step 1/4 --rho-range 0..1 --rho-step 1/4", "methods = rk4"),
        ("--methods impulse --h-range 0..1 --h-step 0 --rho-range 0..1 --rho-step 1/4", "h_step = 0"),
        (
            "--methods impulse --h-range 1..1 --h-step 2 --rho-range 0..1 --rho-step 1/4",
            "no positive multiple",
        ),
        (
            "--methods impulse --lambda1 -1 --h-range 0..1 --h-step 1/4 --rho-range 0..1 --rho-step 1/4",
            "lambda1 = -1",
        ),
        ("--methods pefrl --h-range 0..1 --h-step 1/9999 --rho-range 0..1 --rho-step 1/9999", "--budget"),
        ("--methods impulse", "h-range"),
    ] {
        let told = desk.run(&words(&format!("compare {line}")));
        assert!(
            told.code == Some(2) && told.stderr.lines().count() == 1 && told.stderr.contains(part),
            "{line}: {}",
            told.stderr
        );
    }
}
