//! Systems: the verdict on the half period with sparse kicks against the obvious way, the dense 2n x 2n
//! propagator of the full period and a general eigenvalue routine; and the rate of kicks of the simulation.
//!
//! Run with `cargo bench --bench system`. Dense random systems come first: n = 66 within 50 ms, a map of 182
//! points of n = 12 within a second, n = 1,000 in two levels within 5 s and 50 outer steps of it within 60 s;
//! others within a second, a factor of 8 (where kicks are many), 10^7 kicks/s. What a run does not keep it
//! says beside the figure, for on a busy machine that may be the machine's fault: it ends with an error for
//! wrong answers alone. With few kicks a period there is little to compose, and the eigenvalues remain: those
//! of the 2n x 2n matrix alone cost some five times those of the n x n one with the vectors that prove them.

use kickdrift::avi::{Clocks, Ends, Linear, Simulation, State};
use kickdrift::number::Rational;
use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::scene::{Axis, Scan, SystemScene};
use kickdrift::system::levels::{Hessians, Kernel, Outer};
use kickdrift::system::scan::scan;
use kickdrift::system::{Holds, Limits, Route, System, builders, decide_system, middle};
use rayon::prelude::*;

mod common;
mod dense;

use common::{Numbers, least};
use dense::multipliers;

/// Says where a promise is not kept.
fn promise(kept: bool, what: &str) {
    if !kept {
        println!("    NOT KEPT: {what}");
    }
}

/// At least `promised` times faster than the dense way.
fn compare(name: &str, system: &System, dense_runs: u32, promised: f64) {
    let (own, analysis) = least(5, 0.0, || decide_system(system, &Limits::default()).expect("a verdict"));
    assert!(analysis.is_proof(), "{name}: {:?}", analysis.warnings);
    let (dense, largest) = least(dense_runs, 0.0, || multipliers(system).into_iter().fold(0.0, f64::max));
    let factor = dense / own;
    let predicted = (middle(analysis.growth_rate().expect("enclosed")) * to_f64(&system.period())).exp();
    println!(
        "{name}: {} kicks a period, {} in {:.1} ms; dense {:.1} ms, {factor:.0} times; |lambda| {predicted:.9} and {largest:.9}",
        system.schedule().strikes(),
        analysis.kind_name(),
        1e3 * own,
        1e3 * dense,
    );
    promise(own < 1.0, "a second");
    promise(factor >= promised, &format!("{promised} times faster"));
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
    promise(rate >= 1e7, "10^7 kicks a second");
}

/// The file of a random dense system of two levels, `inner` inner steps in the outer one.
fn dense_file(n: usize, seed: u64, inner: u64, outer: &str) -> String {
    let mut numbers = Numbers(seed);
    let rows = |k: Vec<Vec<f64>>| format!("{k:?}");
    let (fast, slow) = (rows(numbers.definite(n, 1.0)), rows(numbers.definite(n, 0.05)));
    format!(
        r#"{{"schema": "kickdrift/system/1", "masses": {:?}, "potentials": [
        {{"name": "fast", "step": "{outer}/{inner}", "stiffness": {fast}}}, {{"name": "slow", "step": "{outer}", "stiffness": {slow}}}]}}"#,
        vec![1; n],
    )
}

/// Dense files as people have them: a whole verdict, from the text on; the verdict alone beside the dense
/// way; a map.
fn dense() {
    for (n, promised) in [(10, 0.01), (12, 0.01), (66, 0.05)] {
        for outer in ["1", "14/5"] {
            let text = dense_file(n, 7, 4, outer);
            let read = || SystemScene::read(&text).expect("a system");
            let decide = |scene: &SystemScene| {
                scene.model().decide(Route::Cheapest, &Limits::default()).expect("a verdict")
            };
            let (own, analysis) = least(3, 1.0, || decide(&read()));
            let scene = read();
            let (alone, _) = least(3, 1.0, || decide(&scene));
            let (other, _) = least(3, 1.0, || multipliers(scene.model().system()));
            println!(
                "dense {n}, outer step {outer}: {} by {} in {:.2} ms; alone {:.3} ms, dense way {:.3} ms",
                analysis.kind_name(),
                analysis.parts[0].evidence.name(),
                1e3 * own,
                1e3 * alone,
                1e3 * other
            );
            assert!(analysis.is_proof(), "{:?}", analysis.warnings);
            promise(own < promised, &format!("{promised} s"));
            promise(alone <= other, "as fast as the dense way");
        }
    }
    let text = dense_file(12, 7, 4, "1");
    let axis = |text: &str| text.parse::<Axis>().expect("an axis");
    let (x, y) = ("potentials.slow.step=4/20..52/20:4/20", "potentials.slow.scale=1/10..14/10:1/10");
    let scene = SystemScene::read(&text).expect("a system");
    let axes = Scan::new(scene, axis(x), Some(axis(y))).expect("a map");
    let (xs, ys, limits) = (axes.x.values(), axes.ys(), Limits::default());
    let decide = |x: &_, y: &_| axes.at(x, y)?.model().decide(Route::Cheapest, &limits);
    let (own, points) = least(3, 0.0, || scan(&xs, &ys, decide, || ()).expect("a map"));
    println!("map of {} points, n = 12: {:.0} ms", points.len(), 1e3 * own);
    assert!(points.len() == 182);
    promise(own < 1.0, "a second");
}

/// Two levels of 1,000 degrees of freedom: a whole verdict, and those at 50 outer steps.
fn levels() {
    let n = 1000;
    let mut numbers = Numbers(5);
    let (fast, slow) = (numbers.matrix(n, 1.0), numbers.matrix(n, 0.05));
    let hessians = || Hessians::new(&fast, &slow, 1e-6).expect("two Hessians");
    let (making, kernel) = least(1, 0.0, || Kernel::new(&hessians()).expect("a basis"));
    let (first, analysis) = least(1, 0.0, || {
        let outer = Outer::new(4.0, 4).expect("a step");
        kernel.decide(&outer, &ratio(4, 1), 1e-6)
    });
    println!("n = 1000: basis {making:.2} s, {} with its margin {first:.2} s", analysis.kind_name());
    assert!(analysis.is_proof(), "{:?}", analysis.warnings);
    let (lo, hi) = analysis.measured.and_then(|own| own.first_unstable).expect("a first unstable step");
    let steps: Vec<f64> = (1..=50).map(|k| (0.8 + 0.005 * f64::from(k)) * lo).collect();
    let (own, verdicts) = least(1, 0.0, || {
        let verdict = |&step: &f64| kernel.verdict_within(&Outer::new(step, 4).expect("a step"), 1e-6);
        steps.par_iter().map(verdict).collect::<Vec<_>>()
    });
    let stable = verdicts.iter().filter(|own| **own == Holds::Stable).count();
    println!("    first unstable {lo:.6} to {hi:.6}; 50 outer steps, {stable} stable, in {own:.1} s");
    promise(making + first < 5.0, "5 s for a verdict");
    promise(own < 60.0, "60 s for 50 steps");
}

fn main() {
    dense();
    levels();
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
