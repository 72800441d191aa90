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

/// At the price of a step of Verlet's rule the others take a third and a fourth of their own.
#[test]
fn words_of_one_force_are_compared_by_cost_and_the_least_unstable_share_comes_first() {
    let desk = Desk::new();
    let line = "compare --methods forest-ruth,pefrl,velocity-verlet --by-cost --h-range 0..2 --h-step 1/100";
    let told = desk.run(&words(line));
    assert_eq!((told.code, told.stderr.as_str()), (Some(0), ""));
    let rows = told.stdout.lines().skip_while(|line| !line.starts_with("--")).skip(1);
    let rows: Vec<Vec<&str>> = rows.map(|line| line.split_whitespace().take(2).collect()).collect();
    assert_eq!(rows, [["velocity-verlet", "1"], ["pefrl", "4"], ["forest-ruth", "3"]]);
    // h = 2 alone is unstable of Verlet's 200 steps.
    assert!(
        told.stdout.contains("velocity-verlet            1           0.005     199         1     0\n"),
        "{}",
        told.stdout
    );
    assert_eq!(desk.run(&[words(line), vec!["--output", "side.json"]].concat()).code, Some(0));
    assert_eq!(desk.run(&["verify", "side.json"]).code, Some(0));
    // Without it all take the same steps, and the rows stand as they were asked for.
    let same = desk.run(&words(&line.replace("--by-cost ", "")));
    assert!(
        same.stdout.contains("\nforest-ruth ") && !same.stdout.contains("evaluations"),
        "{}",
        same.stdout
    );
}

#[test]
fn steps_that_cost_the_same_are_compared_beside_a_second_force() {
    let desk = Desk::new();
    let line = format!("compare --methods impulse,respa-4,implicit-explicit --by-cost {GRID}");
    for form in ["json", "svg"] {
        let file = format!("side.{form}");
        assert_eq!(desk.run(&[words(&line), vec!["--output", &file]].concat()).code, Some(0), "{form}");
    }
    assert_eq!(desk.run(&["verify", "side.json"]).code, Some(0));
}

#[test]
fn what_is_no_integrator_or_no_grid_is_refused_in_a_line() {
    let desk = Desk::new();
    for (line, part) in [
        ("--methods rk4 --h-range 0..1 --h-step 1/4 --rho-range 0..1 --rho-step 1/4", "methods = rk4"),
        ("--methods impulse --h-range 0..1 --h-step 0 --rho-range 0..1 --rho-step 1/4", "h-step = 0"),
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
        ("--methods impulse --h-range 0..1 --h-step 1/4", "rho-range missing"),
    ] {
        let told = desk.run(&words(&format!("compare {line}")));
        assert!(
            told.code == Some(2) && told.stderr.lines().count() == 1 && told.stderr.contains(part),
            "{line}: {}",
            told.stderr
        );
    }
}
