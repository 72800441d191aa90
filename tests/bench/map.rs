//! Figure 1 side by side: certified, by the same kernel without certificates, and by the loop in C that anyone would
//! write (tests/bench/peers/full_period.c, built here if gcc is there). Minima over repetitions; ratios count.
//!
//! `cargo bench --bench map [-- N]`: steps of 1/N, 1000 unless given; with `curve`, the cost for N up to 4000.

use std::path::PathBuf;
use std::process::Command;

use kickdrift::map::{Counters, Grid, Map, uncertified_unstable};

mod common;

use common::{figure_1, least};

fn main() {
    let arguments: Vec<String> =
        std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    if arguments.iter().any(|argument| argument == "curve") {
        return curve();
    }
    side_by_side(arguments.first().and_then(|n| n.parse().ok()).unwrap_or(1000));
}

fn certified(grid: &Grid) -> (u64, Counters) {
    let mut unstable = 0;
    let counters = Map::of(grid).for_each_band(|_, band| {
        unstable += band.verdicts.iter().filter(|&&verdict| verdict != 0).count() as u64;
        Ok(())
    });
    (unstable, counters.expect("within the budget"))
}

fn side_by_side(n: u64) {
    let (grid, peer) = (figure_1(n), build_peer());
    let (mut ours, mut bare, mut loops) = (f64::INFINITY, f64::INFINITY, f64::INFINITY);
    for round in 0..5 {
        for _ in 0..5 {
            let (seconds, (unstable, counters)) = least(1, 0.0, || certified(&grid));
            if ours.is_infinite() {
                println!("{} pairs, {unstable} unstable, {} kicks composed", counters.pairs, counters.kicks);
                println!("{} pairs left the groups for the ladder", counters.escalated);
            }
            ours = ours.min(seconds);
            bare = bare.min(least(1, 0.0, || uncertified_unstable(&grid, 0)).0);
        }
        if let (Some(peer), true) = (&peer, round < 2) {
            loops = loops.min(run_peer(peer, n));
        }
    }
    let kicks = certified(&grid).1.kicks as f64;
    let threads = std::thread::available_parallelism().map_or(1, usize::from) as f64;
    println!(
        "certified          {:8.1} ms, {:.3} ns a kick and thread",
        ours * 1e3,
        ours * threads / kicks * 1e9
    );
    println!("uncertified kernel {:8.1} ms, certification costs a factor {:.2}", bare * 1e3, ours / bare);
    println!("full period in C   {:8.1} ms, a factor {:.1}", loops * 1e3, loops / ours);
    let limit = fused_operations_a_second();
    // An update needs 6 fused operations, 1 product and 1 comparison where fused operations are done.
    println!(
        "fused operations at their limit: {:.1} ms for 8 an update",
        kicks * 8.0 / limit / threads * 1e3
    );
}

fn curve() {
    println!("{:>6} {:>12} {:>14} {:>10} {:>12}", "1/d", "pairs", "kicks", "seconds", "ns a kick");
    for n in [250, 500, 1000, 2000, 4000] {
        let grid = figure_1(n);
        let best = (0..3).map(|_| least(1, 0.0, || certified(&grid))).min_by(|a, b| a.0.total_cmp(&b.0));
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

/// Its seconds for steps of 1/n.
fn run_peer(program: &PathBuf, n: u64) -> f64 {
    let output = Command::new(program).arg(n.to_string()).output().expect("the peer runs");
    let text = String::from_utf8(output.stdout).expect("text");
    text.split_whitespace().nth(2).and_then(|seconds| seconds.parse().ok()).expect("seconds")
}

/// What one core does: fused operations on doubles that stay in registers.
fn fused_operations_a_second() -> f64 {
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,fma")]
    fn wide(x: &mut [f64; 96], n: u64) {
        narrow(x, n);
    }
    #[inline(always)]
    fn narrow(x: &mut [f64; 96], n: u64) {
        let mut lanes = *x;
        for _ in 0..n {
            for lane in &mut lanes {
                *lane = lane.mul_add(0.999, 0.001);
            }
        }
        *x = lanes;
    }
    let (n, mut x) = (1_000_000, [1.5; 96]);
    let seconds = (0..5).map(|_| {
        least(1, 0.0, || {
            #[cfg(target_arch = "x86_64")]
            if is_x86_feature_detected!("avx512f") {
                // Safety: just detected.
                return unsafe { wide(&mut x, n) };
            }
            narrow(&mut x, n)
        })
        .0
    });
    let best = seconds.fold(f64::INFINITY, f64::min);
    std::hint::black_box(x);
    (96 * n) as f64 / best
}
