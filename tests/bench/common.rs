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

/// The processor time in seconds that the work takes on this thread and those it starts and ends; elsewhere than on Linux
/// the time that passes.
pub fn processor_time<T>(work: impl FnOnce() -> T) -> f64 {
    let start = now();
    std::hint::black_box(work());
    now() - start
}

#[cfg(target_os = "linux")]
fn now() -> f64 {
    unsafe extern "C" {
        fn clock_gettime(clock: i32, time: *mut [i64; 2]) -> i32;
    }
    let mut time = [0; 2];
    // Safety: 2 is the clock of the process, and a time is two words, seconds and nanoseconds.
    assert_eq!(unsafe { clock_gettime(2, &mut time) }, 0);
    time[0] as f64 + 1e-9 * time[1] as f64
}

#[cfg(not(target_os = "linux"))]
fn now() -> f64 {
    use std::sync::OnceLock;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}
