//! Names that others gave stand in figures as they are: stars are no italics, bars no indices.

use super::support::Desk;

const SYSTEM: &str = r#"{"schema": "kickdrift/system/1", "title": "Runs of a*b*c and k_1", "masses": [1], "potentials": [
    {"name": "a*b*c", "step": "1/10", "springs": [[0, null, 4]]}, {"name": "k_1", "step": "1/5", "springs": [[0, null, 1]]}]}"#;

/// What a label says to those who listen: its letters, after the notation was read.
fn says(desk: &Desk, args: &[&str], figure: &str, words: &[&str]) {
    let ended = desk.run(args);
    assert_eq!(ended.code, Some(0), "{args:?}: {}", ended.stderr);
    let svg = String::from_utf8(desk.read(figure)).unwrap();
    for own in words {
        assert!(svg.contains(&format!("aria-label=\"{own}\"")), "{args:?}: no {own}");
    }
}

#[test]
fn a_word_with_stars_is_the_title_of_its_panel() {
    let methods = "2*(K(1/4) D(1/2) K(1/4)),impulse";
    let grid = ["--h-range", "0..4", "--h-step", "1/2", "--rho-range", "0..1", "--rho-step", "1/2"];
    let args = [&["compare", "--methods", methods], &grid[..], &["--output", "side.svg"]].concat();
    says(&Desk::new(), &args, "side.svg", &["2*(K(1/4) D(1/2) K(1/4)): 68.8 % stable"]);
}

#[test]
fn modes_of_advice_keep_their_stars_and_bars() {
    let periods = ["--period", "a*b*c=10fs", "--period", "k_1=11fs", "--period", "slow=40fs"];
    let args = [&["advise"], &periods[..], &["--steps", "0.5fs,4fs", "--output", "advice.svg"]].concat();
    says(&Desk::new(), &args, "advice.svg", &["a*b*c", "k_1"]);
}

#[test]
fn the_title_of_a_run_keeps_its_stars_and_bars() {
    let desk = Desk::new();
    desk.write("system.json", SYSTEM);
    let args = ["simulate", "system.json", "--periods", "5", "--figure", "run.svg"];
    says(&desk, &args, "run.svg", &["Runs of a*b*c and k_1"]);
}

/// Bars of names became spaces with those of keys.
#[test]
fn axes_of_scans_and_intervals_keep_the_stars_and_bars_of_potentials() {
    let desk = Desk::new();
    desk.write("system.json", SYSTEM);
    let scans = ["--scan", "potentials.a*b*c.scale=1..2:1/2", "--scan", "potentials.k_1.scale=1..2:1/2"];
    let args = [&["system", "system.json"], &scans[..], &["--output", "map.svg"]].concat();
    says(&desk, &args, "map.svg", &["scale of a*b*c", "scale of k_1"]);
    let intervals = ["--intervals", "potentials.k_1.scale=1..2", "--output", "line.svg"];
    let args = [&["system", "system.json"], &intervals[..]].concat();
    says(&desk, &args, "line.svg", &["scale of k_1"]);
}
