//! One verdict, tier against tier: `cargo bench --bench verdict`. Minima over repetitions; ratios count.

use std::process::Command;

use kickdrift::number::Rational;
use kickdrift::number::parse::parse;
use kickdrift::propagator::{Oscillator, TwoClocks};
use kickdrift::verdict::{Limits, Tier, decide_from, exact_trace};

mod common;

/// The least time of `work` in seconds over `rounds` runs.
fn least(rounds: u32, work: impl FnMut()) -> f64 {
    common::least(rounds, 0.0, work).0
}

fn clocks() -> TwoClocks<Rational> {
    let x = |text| parse("quantity", text).expect("a number");
    let oscillator = Oscillator::new(x("10"), x("2/5"), x("0.631"), x("3.499")).expect("an oscillator");
    oscillator.clocks().as_rational().expect("rational strengths")
}

/// The whole process, from start to exit.
fn process(flags: &[&str]) -> f64 {
    let pair = ["verdict", "--lambda1", "10", "--lambda2", "2/5", "--h1", "0.631", "--h2", "3.499"];
    let run = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_kickdrift")).args(arguments).output();
        assert!(output.expect("the binary runs").status.success());
    };
    least(20, || run(&[&pair, flags].concat())) - least(20, || run(&["--version"]))
}

fn main() {
    let (clocks, limits) = (clocks(), Limits::default());
    let tier = |first| least(20, || drop(decide_from(first, &clocks, &limits)));
    let (filter, refine, exact) = (tier(Tier::Filter), tier(Tier::Refine), tier(Tier::Exact));
    let trace = least(5, || drop(exact_trace(&clocks)));
    println!(
        "p/q = 3499/631, lambda1 = 10, lambda2 = 2/5, h1 = 0.631: seconds, and ratios to the exact tier"
    );
    for (name, seconds) in [
        ("filter (certified doubles)", filter),
        ("refine (128 bits)", refine),
        ("exact (product tree, half period)", exact),
        ("exact trace in lowest terms", trace),
        ("process, beyond its start", process(&[])),
        ("process --exact, beyond its start", process(&["--exact"])),
    ] {
        println!("{name:<40} {seconds:>10.6} s   x {:>9.3}", seconds / exact);
    }
}
