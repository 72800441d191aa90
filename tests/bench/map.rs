//! Figure 1 side by side: certified, by the same kernel without certificates, and by the loop in C that
//! anyone would write (tests/bench/peers/full_period.c, built here if gcc is there), with each instruction
//! set that the processor has and beside the time of its fused operations alone. Minima over repetitions;
//! ratios count.
//!
//! `cargo bench --bench map [-- N]`: steps of 1/N, 1000 unless given; with `curve`, the cost for N up to
//! 4000; with `scattered`, pairs on no grid beside the grid.

use std::path::PathBuf;
use std::process::Command;

use kickdrift::map::{Counters, Grid, Map, Pairs, Resources, instruction_sets, uncertified_unstable};
use kickdrift::number::parse::parse;
use kickdrift::number::rational::ratio;
use kickdrift::number::{Laurent, Ratio, Rational};

mod common;

use common::{figure_1, least, processor_time};

fn main() {
    let arguments: Vec<String> =
        std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    if arguments.iter().any(|argument| argument == "curve") {
        return curve();
    }
    if arguments.iter().any(|argument| argument == "scattered") {
        return scattered();
    }
    side_by_side(arguments.first().and_then(|n| n.parse().ok()).unwrap_or(1000));
}

fn certified(grid: &Grid, resources: Resources) -> (u64, Counters) {
    let mut unstable = 0;
    let counters = Map::of(grid).within(resources).for_each_band(|_, band| {
        unstable += band.verdicts.iter().filter(|&&verdict| verdict != 0).count() as u64;
        Ok(())
    });
    (unstable, counters.expect("within the budget"))
}

fn side_by_side(n: u64) {
    let (grid, peer) = (figure_1(n), build_peer());
    // Processor time of one thread each, so that a busy machine tells the same: minima over rounds that
    // alternate.
    let one = Resources { threads: 1, ..Resources::default() };
    let sets = instruction_sets();
    let (mut ours, mut bare, mut loops) =
        (vec![f64::INFINITY; sets.len()], vec![f64::INFINITY; sets.len()], f64::INFINITY);
    let (unstable, counters) = certified(&grid, one);
    println!("{} pairs, {unstable} unstable, {} kicks composed", counters.pairs, counters.kicks);
    println!("{} pairs left the groups for the ladder", counters.escalated);
    for round in 0..8 {
        // Without fused operations in hardware the portable form takes minutes.
        for set in (0..sets.len()).filter(|&set| sets[set] != "Portable") {
            assert!(kickdrift::force_instructions(&sets[set]));
            ours[set] = ours[set].min(processor_time(|| certified(&grid, one)));
            bare[set] = bare[set].min(processor_time(|| uncertified_unstable(&grid, 1)));
        }
        if let (Some(peer), true) = (&peer, round < 2) {
            loops = loops.min(run_peer(peer, n));
        }
    }
    println!("full period in C {:9.1} ms", loops * 1e3);
    for set in (0..sets.len()).filter(|&set| sets[set] != "Portable") {
        let (ours, bare, kicks) = (ours[set], bare[set], counters.kicks as f64);
        // 8 operations an update, 6 of them fused.
        let limit = 8.0 * kicks * seconds_a_fused_operation(&sets[set]);
        println!(
            "{:8} certified {:7.1} ms, {:.3} ns a kick, C / {:.1}; certification costs a factor {:.2}; {:.2} times the {:.1} ms \
             of fused operations alone, the kernel {:.2}",
            sets[set],
            ours * 1e3,
            ours / kicks * 1e9,
            loops / ours,
            ours / bare,
            ours / limit,
            limit * 1e3,
            bare / limit
        );
    }
}

fn curve() {
    println!("{:>6} {:>12} {:>14} {:>10} {:>12}", "1/d", "pairs", "kicks", "seconds", "ns a kick");
    for n in [250, 500, 1000, 2000, 4000] {
        let grid = figure_1(n);
        let best = (0..3)
            .map(|_| least(1, 0.0, || certified(&grid, Resources::default())))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let (seconds, (_, counters)) = best.expect("three runs");
        let each = seconds / counters.kicks as f64 * 1e9;
        println!("{n:>6} {:>12} {:>14} {seconds:>10.3} {each:>12.4}", counters.pairs, counters.kicks);
    }
}

/// A million pairs of the window of Figure 1, each on a grid of its own: steps of 1/d with d between 500
/// and 2000.
fn scattered() {
    const COUNT: u64 = 1_000_000;
    let (grid, one) = (figure_1(1000), Resources { threads: 1, ..Resources::default() });
    let mut state = 20_261_122u64;
    let mut below = |n: u64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % n
    };
    let steps: Vec<[Rational; 2]> = (0..COUNT)
        .map(|_| {
            let d = 500 + below(1500);
            [2 * d * 1000 / 3142, 7 * d / 2].map(|most| ratio(1 + below(most) as i64, d as i64))
        })
        .collect();
    let kicks: u64 = steps
        .iter()
        .map(|[h1, h2]| {
            let ratio = Ratio::try_from(&(h2 / h1)).expect("small");
            ratio.p().min(ratio.q()) / 2 + 1
        })
        .sum();
    let x = |text| parse("x", text).expect("a number");
    let (mut ours, mut theirs, mut made) = (f64::INFINITY, f64::INFINITY, f64::INFINITY);
    for _ in 0..4 {
        theirs = theirs.min(processor_time(|| certified(&grid, one)));
        let laurent =
            || steps.iter().map(|pair| pair.clone().map(Laurent::from_rational)).collect::<Vec<_>>();
        let (given, mut pairs) = (laurent(), None);
        made = made.min(processor_time(|| pairs = Pairs::of_steps(x("pi^2"), x("pi^2/25"), given).ok()));
        let pairs = pairs.expect("positive steps");
        ours = ours.min(processor_time(|| pairs.verdicts(&one).expect("within the budget")));
    }
    let all = certified(&grid, one).1;
    let (ours, theirs) = (ours * 1e9, theirs * 1e9);
    println!(
        "grid      {:8.1} ns a pair, {:.3} ns a kick, {:.0} kicks a pair",
        theirs / all.pairs as f64,
        theirs / all.kicks as f64,
        all.kicks as f64 / all.pairs as f64
    );
    println!(
        "scattered {:8.1} ns a pair, {:.3} ns a kick, {:.0} kicks a pair; {:.2} times the grid's cost a kick; read in {:.1} ns a pair",
        ours / COUNT as f64,
        ours / kicks as f64,
        kicks as f64 / COUNT as f64,
        ours / kicks as f64 / (theirs / all.kicks as f64),
        made * 1e9 / COUNT as f64
    );
}

/// The peer's program, where there is a gcc.
fn build_peer() -> Option<PathBuf> {
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/bench/peers/full_period.c");
    let program = std::env::temp_dir().join(format!("full_period_{}", std::process::id()));
    let built = Command::new("gcc")
        .args(["-O3", "-march=native", "-fopenmp", "-o"])
        .arg(&program)
        .arg(source)
        .arg("-lm")
        .status();
    built.is_ok_and(|status| status.success()).then_some(program)
}

/// Its seconds of processor time for steps of 1/n on one thread.
fn run_peer(program: &PathBuf, n: u64) -> f64 {
    let output =
        Command::new(program).env("OMP_NUM_THREADS", "1").arg(n.to_string()).output().expect("the peer runs");
    let text = String::from_utf8(output.stdout).expect("text");
    text.split_whitespace().nth(3).and_then(|seconds| seconds.parse().ok()).expect("seconds")
}

/// A loop of independent fused operations on so many doubles, compiled with these features.
macro_rules! fused_operations {
    ($name:ident, $features:literal, $lanes:literal) => {
        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = $features)]
        fn $name(n: u64) -> [f64; $lanes] {
            let mut lanes = [1.5f64; $lanes];
            for _ in 0..n {
                for lane in &mut lanes {
                    *lane = lane.mul_add(0.999, 0.001);
                }
            }
            lanes
        }
    };
}

// Twelve registers, which leaves AVX2 some for the constants.
fused_operations!(avx512, "avx512f,fma", 96);
fused_operations!(avx2, "avx2,fma", 48);

/// Seconds for each fused operation on a double that stays in a register, on one core with these
/// instructions: the limit that no kernel passes. NaN where it is not measured.
fn seconds_a_fused_operation(set: &str) -> f64 {
    const N: u64 = 1_000_000;
    let once = || match set {
        // Safety: the processor has these instructions, or the set would not be named.
        #[cfg(target_arch = "x86_64")]
        "Avx512" => processor_time(|| unsafe { avx512(N) }) / (96 * N) as f64,
        #[cfg(target_arch = "x86_64")]
        "Avx2" => processor_time(|| unsafe { avx2(N) }) / (48 * N) as f64,
        _ => f64::NAN,
    };
    (0..9).map(|_| once()).fold(f64::INFINITY, f64::min)
}
