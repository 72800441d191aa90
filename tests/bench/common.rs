//! What the benchmarks share. Each uses its part of it.
#![allow(dead_code)]

use std::time::Instant;

use kickdrift::map::Grid;
use kickdrift::number::parse::parse;
use nalgebra::DMatrix;

/// The least time in seconds of at least `runs` runs, and as many more as `seconds` hold; with the last
/// result.
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

/// Numbers that repeat, in [−1, 1).
pub struct Numbers(pub u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// G Gᵀ/n plus a multiple of the identity, G random.
    pub fn definite(&mut self, n: usize, scale: f64) -> Vec<Vec<f64>> {
        let g: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| self.next()).collect()).collect();
        let entry = |i: usize, j: usize| {
            let (i, j) = (i.max(j), i.min(j));
            let product: f64 = g[i].iter().zip(&g[j]).map(|(x, y)| x * y).sum();
            scale * (product / n as f64 + f64::from(u8::from(i == j)) * 0.1)
        };
        (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
    }

    /// The same as a matrix.
    pub fn matrix(&mut self, n: usize, scale: f64) -> DMatrix<f64> {
        let rows = self.definite(n, scale);
        DMatrix::from_fn(n, n, |i, j| rows[i][j])
    }
}

/// Figure 1 of the paper with steps of 1/n.
pub fn figure_1(n: u64) -> Grid {
    let x = |text: &str| parse("x", text).expect("a number");
    let d = format!("1/{n}");
    Grid::new(x("pi^2"), x("pi^2/25"), [x(&d), x(&d)], (x(&d), x("2/pi")), (x(&d), x("7/2"))).expect("a grid")
}

/// The processor time in seconds that the work takes on this thread and those it starts and ends; elsewhere
/// than on Linux the time that passes.
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
