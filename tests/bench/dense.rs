//! The obvious way to a system's multipliers, for comparison.

use faer::Mat;
use kickdrift::number::rational::to_f64;
use kickdrift::schedule::{Event, Weight};
use kickdrift::system::System;

/// One dense product for each kick time of the full period, then all 2n eigenvalues: their moduli.
pub fn multipliers(system: &System) -> Vec<f64> {
    let n = system.size();
    let tick = to_f64(system.tick());
    let mut product = Mat::<f64>::identity(2 * n, 2 * n);
    for event in system.schedule().symmetric_period() {
        product = dense_event(system, event, tick) * &product;
    }
    let eigenvalues = product.eigenvalues().expect("an iteration that converges");
    eigenvalues.into_iter().map(|z| z.norm()).collect()
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
