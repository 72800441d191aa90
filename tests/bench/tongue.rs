//! All edges of all coprime p + q <= N at rho = 1/25, certified, one thread and all threads; all tongues,
//! proven open and their widths known; one edge of a long period; closings; the survey.
//!
//!     cargo bench --bench tongue -- 100        beside it: tests/bench/peers/tongue.py 100
//!
//! `--edges` stops after the edges on one thread, `--quick` after the tongues.

use std::time::Instant;

use kickdrift::number::{Ratio, Rational, rational::ratio};
use kickdrift::tongue::{Edge, Entry, Search, Tongues, closings, survey};
use rayon::prelude::*;

mod common;

use common::least;

/// How many tongues one ratio has, and how many edges needed more bits than doubles have.
fn all(ratio: Ratio, rho: &Rational) -> (usize, u64) {
    let tongues = Tongues::new(ratio, rho).unwrap();
    (tongues.all().unwrap().len(), tongues.effort().precise)
}

/// The edges of one ratio, all four problems, and how many needed more bits than doubles have.
fn edges(ratio: Ratio, rho: &Rational) -> (Vec<Edge>, u64) {
    let tongues = Tongues::new(ratio, rho).unwrap();
    let all = tongues.all_edges().unwrap().concat();
    (all, tongues.effort().precise)
}

fn report(name: &str, seconds: f64, found: &[(Vec<Edge>, u64)]) {
    let mut widths = [0u64; 4];
    let all: Vec<&Edge> = found.iter().flat_map(|(edges, _)| edges).collect();
    all.iter().for_each(|edge| widths[(edge.hi.to_bits() - edge.lo.to_bits()).min(3) as usize] += 1);
    let precise: u64 = found.iter().map(|(_, precise)| precise).sum();
    println!(
        "{name}: {} edges, {seconds:.3} s; width in ulps 0/1/2/more: {widths:?}; {precise} with more bits",
        all.len()
    );
}

fn main() {
    let asked = |flag: &str| std::env::args().any(|x| x == flag);
    let (quick, only_edges) = (asked("--quick"), asked("--edges"));
    let max_sum = std::env::args().find_map(|x| x.parse().ok()).unwrap_or(100);
    let (rho, ratios) = (ratio(1, 25), Ratio::up_to(max_sum).collect::<Vec<_>>());
    let one = |&pair: &Ratio| edges(pair, &rho);
    let (seconds, found) = least(3, 1.0, || ratios.iter().map(one).collect::<Vec<_>>());
    report(&format!("p + q <= {max_sum}, one thread"), seconds, &found);
    if only_edges {
        return;
    }
    let (seconds, found) = least(3, 1.0, || ratios.par_iter().map(one).collect::<Vec<_>>());
    report(&format!("p + q <= {max_sum}, all threads"), seconds, &found);
    let (seconds, found) = least(3, 1.0, || ratios.iter().map(|&pair| all(pair, &rho)).collect::<Vec<_>>());
    let (count, precise) = found.iter().fold((0, 0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
    println!(
        "all tongues, widths and all, one thread: {count}, {seconds:.3} s; {precise} edges with more bits"
    );
    if quick {
        return;
    }

    let start = Instant::now();
    let one = Tongues::new(Ratio::new(61_803, 38_197).unwrap(), &rho)
        .unwrap()
        .edges(Entry::B, 12_345, 12_345)
        .unwrap();
    println!("one edge of 61803/38197: {:?}, {:.3} s", one[0], start.elapsed().as_secs_f64());
    let start = Instant::now();
    let found = closings("7/4".parse().unwrap(), &Search::default()).unwrap();
    println!("closings of 7/4: {}, {:.3} s", found.closings.len(), start.elapsed().as_secs_f64());
    let start = Instant::now();
    let survey = survey(max_sum, &rho, 5).unwrap();
    println!("survey: {:.3} s\n{survey:#?}", start.elapsed().as_secs_f64());
}
