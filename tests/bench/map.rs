//! Figure 1 side by side: certified, by the same kernel without certificates, and by the loop in C that anyone would
//! write (tests/bench/peers/full_period.c, built here if gcc is there), with each instruction set that the processor has
//! and beside the time of its fused operations alone. Minima over repetitions; ratios count.
//!
//! `cargo bench --bench map [-- N]`: steps of 1/N, 1000 unless given; with `curve`, the cost for N up to 4000.

use std::path::PathBuf;
use std::process::Command;

use kickdrift::map::{Counters, Grid, Map, Resources, instruction_sets, uncertified_unstable};

mod common;

use common::{figure_1, least, processor_time};

fn main() {
    let arguments: Vec<String> =
        std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    if arguments.iter().any(|argument| argument == "curve") {
        return curve();
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
    // Processor time of one thread each, so that a busy machine tells the same: minima over rounds that alternate.
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

/// Seconds for each fused operation on a double that stays in a register, on one core with these instructions: the
/// limit that no kernel passes. NaN where it is not measured.
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
