//! What the benchmarks share. Each uses its part of it.
#![allow(dead_code)]

use std::time::Instant;

use kickdrift::map::Grid;
use kickdrift::number::parse::parse;

/// The least time in seconds of at least `runs` runs, and as many more as `seconds` hold; with the last result.
pub fn least<T>(runs: u32, seconds: f64, mut work: impl FnMut() -> T) -> (f64, T) {
    let (begin, mut least, mut done) = (Instant::now(), f64::INFINITY, 0);
    loop {
        let start = Instant::now();
        let result = std::hint::black_box(work());
        least = least.min(start.elapsed().as_secs_f64());
        done += 1;
        if done >= runs && begin.elapsed().as_secs_f64() >= seconds {
            return (least, result);
        }
    }
}

/// Figure 1 of the paper with steps of 1/n.
pub fn figure_1(n: u64) -> Grid {
    let x = |text: &str| parse("x", text).expect("a number");
    let d = format!("1/{n}");
    Grid::new(x("pi^2"), x("pi^2/25"), [x(&d), x(&d)], (x(&d), x("2/pi")), (x(&d), x("7/2"))).expect("a grid")
}
