//! Systems: the verdict on the half period with sparse kicks against the obvious way, the dense 2n x 2n propagator of
//! the full period and a general eigenvalue routine; and the rate of kicks of the simulation.
//!
//! Run with `cargo bench --bench system`. Fails where a promise is broken: a second, a factor of 8 (where kicks are
//! many), 10^7 kicks/s. With few kicks a period there is little to compose, and the eigenvalues remain: those of the
//! 2n x 2n matrix alone cost some five times those of the n x n one with the vectors that prove them.

use kickdrift::avi::{Clocks, Ends, Linear, Simulation, State};
use kickdrift::number::Rational;
use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::system::{Limits, System, builders, decide_system};

mod common;
mod dense;

use common::least;
use dense::multipliers;

/// At least `promised` times faster than the dense way.
fn compare(name: &str, system: &System, dense_runs: u32, promised: f64) {
    let (own, analysis) = least(5, 0.0, || decide_system(system, &Limits::default()).expect("a verdict"));
    assert!(analysis.is_proof(), "{name}: {:?}", analysis.warnings);
    assert!(own < 1.0, "{name}: {own} s");
    let (dense, largest) = least(dense_runs, 0.0, || multipliers(system).into_iter().fold(0.0, f64::max));
    let factor = dense / own;
    let predicted = (analysis.growth_rate() * to_f64(&system.period())).exp();
    println!(
        "{name}: {} kicks a period, {} in {:.1} ms; dense {:.1} ms, {factor:.0} times; |lambda| {predicted:.9} and {largest:.9}",
        system.schedule().strikes(),
        analysis.kind.name(),
        1e3 * own,
        1e3 * dense,
    );
    assert!(factor >= promised, "{name}: only {factor} times faster");
    assert!((predicted - largest).abs() < 1e-5 * largest, "{name}: {predicted} against {largest}");
}

fn chain(steps: [Rational; 3]) -> System {
    builders::periodic_chain(200, &[ratio(4, 1), ratio(2, 1), ratio(1, 2)], &steps).expect("a chain")
}

fn simulation() {
    let springs = vec![Linear::tether(0, 9.8696), Linear::tether(0, 0.39478)];
    let clocks = Clocks::new(&[ratio(2, 5), ratio(1, 1)], &[ratio(0, 1), ratio(0, 1)]).expect("clocks");
    let ticks = clocks.period() * 20_000;
    let mut simulation = Simulation::new(&[ratio(1, 1)], springs, clocks, State::new(vec![1.0], vec![0.0]))
        .expect("two springs");
    let (time, kicks) = least(100, 0.0, || simulation.run(ticks, Ends::Staggered));
    let rate = kicks as f64 / time;
    println!("two springs through the queue: {:.1} million kicks a second", rate / 1e6);
    assert!(rate >= 1e7, "{rate} kicks a second");
}

fn main() {
    for (steps, kicks, promised) in [
        ([ratio(1, 4), ratio(3, 10), ratio(7, 20)], 107, 8.0),
        ([ratio(1, 8), ratio(1, 4), ratio(1, 1)], 13, 1.5),
        ([ratio(1, 4), ratio(1, 2), ratio(1, 1)], 7, 1.5),
    ] {
        let chain = chain(steps);
        assert_eq!(chain.schedule().strikes(), kicks);
        compare("chain of 200, 3 clocks", &chain, 2, promised);
    }
    compare(
        "bar of 100 elements, 10 classes",
        &builders::graded_bar(100, 10, &ratio(1, 4)).expect("a bar"),
        1,
        8.0,
    );
    simulation();
}
