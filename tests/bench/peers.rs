//! Our side of tests/bench/peers/peers.py: the same work, timed inside the process, answers written to a
//! folder.
//!
//! `cargo bench --bench peers -- FOLDER` prints `name seconds` line by line, minima over repetitions.

use std::fmt::Write as _;
use std::path::Path;

use kickdrift::map::Map;
use kickdrift::number::Ratio;
use kickdrift::number::rational::{from_f64_exact, ratio};
use kickdrift::propagator::TwoClocks;
use kickdrift::system::levels::{Hessians, Kernel, Outer};
use kickdrift::tongue::{Edge, Tongues};
use kickdrift::verdict::{Limits, decide, exact_trace};
use rayon::prelude::*;

mod common;

use common::{Numbers, figure_1, least};

/// Repeats the work until a second has passed, at least three times, and prints the least time.
fn timed<T>(name: &str, work: impl FnMut() -> T) -> T {
    let (seconds, result) = least(3, 1.0, work);
    println!("{name} {seconds:.9}");
    result
}

fn main() {
    let folder = std::env::args().skip(1).find(|argument| !argument.starts_with("--"));
    let Some(folder) = folder else { return println!("usage: cargo bench --bench peers -- FOLDER") };
    let folder = Path::new(&folder);
    for n in [40, 200, 1000] {
        write(folder, &format!("figure_{n}"), &figure(n));
    }
    long_period(folder);
    for max_sum in [30, 100] {
        edges(folder, max_sum);
    }
    levels(folder);
}

/// Two dense levels of 288 degrees of freedom, four inner steps: a verdict from the matrices on, and ten
/// outer steps in one eigenbasis.
fn levels(folder: &Path) {
    let n = 288;
    let mut numbers = Numbers(5);
    let (fast, slow) = (numbers.matrix(n, 1.0), numbers.matrix(n, 0.05));
    for (name, matrix) in [("fast", &fast), ("slow", &slow)] {
        let rows = matrix.row_iter().map(|row| row.iter().map(f64::to_string).collect::<Vec<_>>().join(" "));
        write(folder, name, &rows.collect::<Vec<_>>().join("\n"));
    }
    let hessians = || Hessians::new(&fast, &slow, 1e-9).expect("two Hessians");
    let outer = |step: f64| Outer::new(step, 4).expect("a step");
    let one = timed("levels_288", || hessians().verdict(&outer(1.0)).expect("a verdict").name());
    let in_basis = |kernel: &Kernel, step: f64| kernel.verdict_within(&outer(step), 0.0).name();
    let basis = || Kernel::new(&hessians()).expect("a basis");
    let from_basis = timed("levels_288_basis", || in_basis(&basis(), 1.0));
    assert_eq!(one, from_basis);
    let ten = timed("levels_288_ten", || {
        let kernel = basis();
        (1..=10).map(|k| in_basis(&kernel, 0.3 * f64::from(k))).collect::<Vec<_>>()
    });
    write(folder, "levels_288", &[vec![one], ten].concat().join("\n"));
}

fn write(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).expect("a folder to write to");
}

/// Figure 1 with steps of 1/n, one character a pair: whether it is unstable.
fn figure(n: u64) -> String {
    let grid = figure_1(n);
    let map = |see: &mut dyn FnMut(&[u8])| {
        let bands = Map::of(&grid).for_each_band(|_, band| {
            see(&band.verdicts);
            Ok(())
        });
        bands.expect("within the budget");
    };
    timed(&format!("figure_{n}"), || map(&mut |_| {}));
    let mut text = String::new();
    map(&mut |verdicts| text.extend(verdicts.iter().map(|&verdict| if verdict == 0 { '0' } else { '1' })));
    text
}

/// h2/h1 = 1751/317, s = h1² L1 with h1 = 0.317 and L1 = 10, rho = 1/25: trace and verdict.
fn long_period(folder: &Path) {
    let clocks = TwoClocks::with_rho("1751/317".parse().unwrap(), ratio(317 * 317, 100_000), ratio(1, 25));
    let trace = timed("exact_trace", || exact_trace(&clocks));
    write(folder, "exact_trace", &trace.to_string());
    let verdict =
        timed("verdict", || decide(&clocks, &Limits::default()).expect("within the budget").verdict);
    write(folder, "verdict", &verdict.side().to_string());
}

/// Every edge of all coprime p + q <= max_sum at rho = 1/25, one a line; thirty digits of those of 13/7.
fn edges(folder: &Path, max_sum: u64) {
    let (rho, ratios) = (ratio(1, 25), Ratio::up_to(max_sum).collect::<Vec<_>>());
    let one = |&ratio: &Ratio| Tongues::new(ratio, &rho).and_then(|x| x.all_edges()).expect("edges");
    timed(&format!("edges_{max_sum}_one_thread"), || ratios.iter().map(one).collect::<Vec<_>>());
    let all = timed(&format!("edges_{max_sum}"), || ratios.par_iter().map(one).collect::<Vec<_>>());
    let mut text = String::new();
    for edge in all.iter().flatten().flatten() {
        writeln!(text, "{:.17e} {:.17e}", edge.lo, edge.hi).expect("a string");
    }
    write(folder, &format!("edges_{max_sum}"), &text);
    let digits = timed("edges_30_digits", || {
        let tongues = Tongues::new("13/7".parse().unwrap(), &rho).expect("a string");
        let edges: Vec<Edge> = tongues.all_edges().expect("edges").concat();
        edges.iter().map(|edge| tongues.refine(edge, 30).expect("digits").middle()).collect::<Vec<_>>()
    });
    // Forty decimals.
    let scale = from_f64_exact(10.0).expect("finite").pow(40);
    let text: Vec<String> = digits.iter().map(|x| (x * &scale).round().to_string()).collect();
    write(folder, "edges_30_digits", &text.join("\n"));
}
