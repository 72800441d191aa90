//! Systems: the verdict on the half period with sparse kicks against the obvious way, the dense 2n x 2n propagator of
//! the full period and a general eigenvalue routine; and the rate of kicks of the simulation.
//!
//! Run with `cargo bench --bench system`. Fails where a promise is broken: a second, a factor of 8 (where kicks are
//! many), 10^7 kicks/s. With few kicks a period there is little to compose, and the eigenvalues remain: those of the
//! 2n x 2n matrix alone cost some five times those of the n x n one with the vectors that prove them.

use std::time::{Duration, Instant};

use faer::Mat;
use kickdrift::avi::{Clocks, Ends, Linear, Simulation, State};
use kickdrift::number::Rational;
use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::propagator::{Event, Weight};
use kickdrift::system::{Limits, System, builders, decide_system};

/// The shortest of several runs: other work on the machine only lengthens them.
fn shortest<T>(runs: usize, mut work: impl FnMut() -> T) -> (Duration, T) {
    let mut timed = || {
        let start = Instant::now();
        let result = work();
        (start.elapsed(), result)
    };
    (1..runs).fold(timed(), |best, _| {
        let next = timed();
        if next.0 < best.0 { next } else { best }
    })
}

/// One dense product for each kick time of the full period, then all 2n eigenvalues: their largest modulus.
fn dense_way(system: &System) -> f64 {
    let n = system.size();
    let tick = to_f64(system.tick());
    let mut product = Mat::<f64>::identity(2 * n, 2 * n);
    for event in system.schedule().symmetric_period() {
        product = dense_event(system, event, tick) * &product;
    }
    let eigenvalues = product.eigenvalues().expect("an iteration that converges");
    eigenvalues.into_iter().map(|z| z.norm()).fold(0.0, f64::max)
}

/// Drift, then the kicks of the event.
fn dense_event(system: &System, event: Event, tick: f64) -> Mat<f64> {
    let n = system.size();
    let mut m = Mat::<f64>::identity(2 * n, 2 * n);
    for i in 0..n {
        m[(i, n + i)] = event.drift as f64 * tick / to_f64(&system.mass().get(i, i));
    }
    let weight = if event.weight == Weight::Full { 1.0 } else { 0.5 };
    for (_, clock) in system.clocks().iter().enumerate().filter(|(k, _)| event.kicks >> k & 1 == 1) {
        let strength = weight * to_f64(&clock.step);
        for i in 0..n {
            for (&j, k) in clock.stiffness.row(i) {
                let force = strength * to_f64(k);
                m[(n + i, j)] -= force;
                m[(n + i, n + j)] -= force * m[(j, n + j)];
            }
        }
    }
    m
}

/// At least `least` times faster than the dense way.
fn compare(name: &str, system: &System, dense_runs: usize, least: f64) {
    let (own, analysis) = shortest(5, || decide_system(system, &Limits::default()).expect("a verdict"));
    assert!(analysis.is_proof(), "{name}: {:?}", analysis.warnings);
    assert!(own < Duration::from_secs(1), "{name}: {own:?}");
    let (dense, largest) = shortest(dense_runs, || dense_way(system));
    let factor = dense.as_secs_f64() / own.as_secs_f64();
    let predicted = (analysis.growth_rate() * to_f64(&system.period())).exp();
    println!(
        "{name}: {} kicks a period, {} in {:.1} ms; dense {:.1} ms, {factor:.0} times; |lambda| {predicted:.9} and {largest:.9}",
        system.schedule().strikes(),
        analysis.kind.name(),
        1e3 * own.as_secs_f64(),
        1e3 * dense.as_secs_f64(),
    );
    assert!(factor >= least, "{name}: only {factor} times faster");
    assert!((predicted - largest).abs() < 1e-5 * largest, "{name}: {predicted} against {largest}");
}

fn chain(steps: [Rational; 3]) -> System {
    builders::periodic_chain(200, &[ratio(4, 1), ratio(2, 1), ratio(1, 2)], &steps).expect("a chain")
}

fn simulation() {
    let springs = vec![Linear::tether(0, 9.8696), Linear::tether(0, 0.39478)];
    let clocks = Clocks::new(&[ratio(2, 5), ratio(1, 1)], &[ratio(0, 1), ratio(0, 1)]).expect("clocks");
    let ticks = clocks.period * 20_000;
    let mut simulation = Simulation::new(&[ratio(1, 1)], springs, clocks, State::new(vec![1.0], vec![0.0]))
        .expect("two springs");
    let (time, kicks) = shortest(100, || simulation.run(ticks, Ends::Staggered));
    let rate = kicks as f64 / time.as_secs_f64();
    println!("two springs through the queue: {:.1} million kicks a second", rate / 1e6);
    assert!(rate >= 1e7, "{rate} kicks a second");
}

fn main() {
    for (steps, kicks, least) in [
        ([ratio(1, 4), ratio(3, 10), ratio(7, 20)], 107, 8.0),
        ([ratio(1, 8), ratio(1, 4), ratio(1, 1)], 13, 1.5),
        ([ratio(1, 4), ratio(1, 2), ratio(1, 1)], 7, 1.5),
    ] {
        let chain = chain(steps);
        assert_eq!(chain.schedule().strikes(), kicks);
        compare("chain of 200, 3 clocks", &chain, 2, least);
    }
    compare(
        "bar of 100 elements, 10 classes",
        &builders::graded_bar(100, 10, &ratio(1, 4)).expect("a bar"),
        1,
        8.0,
    );
    simulation();
}
