//! One verdict: `cargo bench --bench verdict [-- DIRECTORY]`. First tier against tier, minima over
//! repetitions; then the verdicts of random pairs as their periods grow from 10^2 to 10^17 kicks, drawn as
//! verdict.svg in DIRECTORY, target unless given. Only ratios count.

use std::path::PathBuf;
use std::process::Command;

use kickdrift::number::parse::parse;
use kickdrift::number::rational::ratio;
use kickdrift::number::{Ratio, Rational};
use kickdrift::plot::palette::{GREY, INK};
use kickdrift::plot::{Axis, Dash, Figure, Layer, Panel, Place, Shape, Stroke};
use kickdrift::propagator::{Oscillator, TwoClocks};
use kickdrift::verdict::{Limits, Tier, decide, decide_from, exact_trace, filter_trace};

mod common;

/// The least time of `work` in seconds over `rounds` runs.
fn least(rounds: u32, work: impl FnMut()) -> f64 {
    common::least(rounds, 0.0, work).0
}

fn clocks() -> TwoClocks<Rational> {
    let x = |text| parse("quantity", text).expect("a number");
    let oscillator = Oscillator::new(x("10"), x("2/5"), x("0.631"), x("3.499")).expect("an oscillator");
    oscillator.clocks().unwrap().as_rational().expect("rational strengths")
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

/// Pairs of one length of period at each step.
const PAIRS: usize = 60;

/// The filter alone is followed up to so many kicks.
const FOLLOWED: u64 = 100_000_000;

/// The times of one length of period, in seconds, sorted.
struct Times {
    kicks: u64,
    ladder: Vec<f64>,
    filter: Vec<f64>,
    /// Pairs that doubles decided.
    in_doubles: usize,
}

/// The next of numbers that repeat, below `end`.
fn next(state: &mut u64, end: u64) -> u64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    ((u128::from(*state) * u128::from(end)) >> 64) as u64
}

/// p + q = `kicks` or a little more, 1 < p/q < 6, 0 < s < 4, rho = 1/25.
fn any_pair(state: &mut u64, kicks: u64) -> TwoClocks<Rational> {
    loop {
        let q = kicks / 7 + next(state, kicks / 2 - kicks / 7);
        let Ok(steps) = Ratio::new(kicks - q, q) else { continue };
        if steps.kicks() == kicks {
            let s = ratio(1 + next(state, 3999) as i64, 1000);
            return TwoClocks::with_rho(steps, s, ratio(1, 25));
        }
    }
}

fn measured(kicks: u64, state: &mut u64) -> Times {
    let limits = Limits::default();
    let mut times = Times { kicks, ladder: Vec::new(), filter: Vec::new(), in_doubles: 0 };
    for _ in 0..PAIRS {
        let clocks = any_pair(state, kicks);
        let (seconds, answer) = common::least(5, 0.0, || decide(&clocks, &limits).expect("a verdict"));
        times.ladder.push(seconds);
        times.in_doubles += usize::from(answer.decided_by == Tier::Filter);
        if kicks <= FOLLOWED {
            let rounds = if kicks > 1_000_000 { 1 } else { 5 };
            times.filter.push(least(rounds, || drop(filter_trace(&clocks))));
        }
    }
    times.ladder.sort_by(f64::total_cmp);
    times.filter.sort_by(f64::total_cmp);
    times
}

fn median(sorted: &[f64]) -> f64 {
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

fn periods() -> Vec<Times> {
    let mut state = 1;
    println!("\nrandom pairs, 1 < p/q < 6, rho = 1/25: microseconds a verdict");
    println!("{:>8} {:>10} {:>10} {:>12} {:>11}", "kicks", "median", "largest", "filter alone", "in doubles");
    let of = |log10| {
        let times = measured(10u64.pow(log10), &mut state);
        let (half, most) = (median(&times.ladder), times.ladder[PAIRS - 1]);
        let alone = median(&times.filter);
        let [half, most, alone] = [half, most, alone].map(|seconds| 1e6 * seconds);
        println!(
            "{:>8} {half:>10.2} {most:>10.1} {alone:>12.1} {:>8}/{PAIRS}",
            format!("10^{log10}"),
            times.in_doubles
        );
        times
    };
    (2..=17).map(of).collect()
}

fn figure(all: &[Times]) -> Figure {
    let line = |of: &dyn Fn(&Times) -> f64| -> Vec<[f64; 2]> {
        all.iter().map(|own| [own.kicks as f64, of(own)]).filter(|point| point[1].is_finite()).collect()
    };
    let ladder = Layer::lines(vec![line(&|own| median(&own.ladder))], Stroke::THICK);
    let thin = |dash| Stroke { colour: INK, width: 0.9, dash };
    let slowest = Layer::lines(vec![line(&|own| own.ladder[PAIRS - 1])], thin(Dash::Dashed));
    let filter = Stroke { colour: GREY, ..thin(Dash::Solid) };
    let filter = Layer::lines(vec![line(&|own| median(&own.filter))], filter);
    let panel = Panel::new(
        Axis::log("kicks a period, *p* + *q*", 50.0, 2e17),
        Axis::log("time of a verdict (s)", 1e-7, 1.0),
    )
    .titled("A verdict as the period grows")
    .with(ladder.marked(Shape::Disc, 3.4).labelled("kickdrift, median"))
    .with(slowest.labelled("slowest of 60"))
    .with(filter.marked(Shape::Square, 3.4).labelled("every kick, in doubles"));
    Figure::new(90.0, 75.0).named("The time of a verdict over its period").with(panel.legend(Place::Above))
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
    let directory = std::env::args().skip(1).find(|argument| !argument.starts_with("--"));
    let path = directory.map_or_else(|| PathBuf::from("target"), PathBuf::from).join("verdict.svg");
    let figure = figure(&periods());
    let figure =
        figure.made_by(concat!("kickdrift ", env!("CARGO_PKG_VERSION")), "cargo bench --bench verdict");
    std::fs::write(&path, figure.svg()).expect("the directory can be written to");
    println!("{}", path.display());
}
