//! Integrators side by side: counted again by traces in doubles.

use super::context::{Checked, Context, Outcome, TRACE_ROOM, holds};
use super::kind::Verify;
use crate::question::{CompareMethods, Side};
use number::{Radical, Real, Result, to_f64};
use words::{Bounded, Damping, Force, Integrator, Letter, Word};

const ROUTE: &str = "the trace at every point in doubles, letter by letter; points within 1e-7 of an edge may fall on either side";

impl Verify for CompareMethods {
    fn check(&self, sides: &Vec<Side>, context: &Context) -> Result<Outcome> {
        let ([steps, ups], ratio) = (self.grid()?, self.ratio()?);
        // (h² Λ1, Λ2/Λ1), row by row.
        let rows = |side: &Side| -> Vec<Vec<(f64, f64)>> {
            let squares = self.squares(&steps, side.evaluations);
            let row =
                |up| steps.iter().zip(&squares).map(|(h, s)| (s.to_f64(), to_f64(&ratio(h, up)))).collect();
            ups.iter().map(row).collect()
        };
        context.outcome(ROUTE, Ok(()), sides, |side| is_so_at(side, &rows(side)))
    }
}

/// Each point, unless it is near to an edge.
fn is_so_at(side: &Side, rows: &[Vec<(f64, f64)>]) -> Checked {
    let are_all_there = rows.iter().map(Vec::len).eq(side.rows.iter().map(Vec::len));
    holds(are_all_there, || format!("there are {} points", rows.iter().map(Vec::len).sum::<usize>()))?;
    for (&(s, rho), bounded) in rows.iter().flatten().zip(side.rows.iter().flatten()) {
        let excess = trace(&side.integrator, s, rho).abs() - 2.0;
        let is_so = match bounded {
            Bounded::Stable => excess < TRACE_ROOM,
            Bounded::Unstable => excess > -TRACE_ROOM,
            Bounded::Edge => excess.abs() < TRACE_ROOM,
        };
        holds(is_so, || format!("at h^2 lambda1 = {s}, lambda2/lambda1 = {rho} |trace| - 2 is {excess}"))?;
    }
    Ok(())
}

fn trace(integrator: &Integrator, s: f64, rho: f64) -> f64 {
    match integrator {
        Integrator::Trigonometric(shape) => {
            let x = s.sqrt();
            let (cos, sinc) = ((x / 2.0).cos(), sinc(x / 2.0));
            let g = cos.powi(shape.cos as i32) * sinc.powi(shape.sinc as i32);
            2.0 * x.cos() - if shape.felt { s * rho * g } else { 0.0 }
        }
        Integrator::Word(word) => step(word, s, rho, 0.0).0,
    }
}

fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}

fn sinhc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sinh() / x }
}

/// Trace and determinant of a word, letter by letter in doubles, at h² Λ1 = s, Λ2 = ρ Λ1, γ h = `friction`.
pub(super) fn step(word: &Word, s: f64, rho: f64, friction: f64) -> (f64, f64) {
    let number = |c: &Radical| c.enclosure(64).mid_f64();
    let strength = |force: Force| match force {
        Force::All => s * (1.0 + rho),
        Force::First => s,
        Force::Second => s * rho,
    };
    // The columns of the product.
    let mut columns = [[1.0, 0.0], [0.0, 1.0]];
    for letter in word.letters() {
        for [x, v] in &mut columns {
            let before = (*x, *v);
            match letter {
                Letter::Drift(time) => *x += number(time) * *v,
                Letter::Friction { damping, time } => {
                    let rate = friction * number(time);
                    *v *= match damping {
                        Damping::Exact => (-rate).exp(),
                        Damping::Explicit => 1.0 - rate,
                        Damping::Implicit => 1.0 / (1.0 + rate),
                    };
                }
                Letter::Kick { force, filter, powers } => {
                    let f = strength(*force);
                    let kick = powers.iter().rev().fold(0.0, |sum, c| (sum + number(c)) * f);
                    let half = s.sqrt() / 2.0;
                    let g = half.cos().powi(filter.cos) * sinc(half).powi(filter.sinc);
                    *v -= if filter.zero { 0.0 } else { kick * g } * *x;
                }
                Letter::Flow { force, time } => {
                    let (c, f) = (number(time), strength(*force));
                    let y = c.abs() * f.abs().sqrt();
                    let (cos, sinc) = if f < 0.0 { (y.cosh(), sinhc(y)) } else { (y.cos(), sinc(y)) };
                    *x = cos * before.0 + c * sinc * before.1;
                    *v = -c * f * sinc * before.0 + cos * before.1;
                }
                Letter::Midpoint { force, time } => {
                    let (c, f) = (number(time), strength(*force));
                    let q = c * c * f / 4.0;
                    *x = ((1.0 - q) * before.0 + c * before.1) / (1.0 + q);
                    *v = (-c * f * before.0 + (1.0 - q) * before.1) / (1.0 + q);
                }
            }
        }
    }
    let [[a, c], [b, d]] = columns;
    (a + d, a * d - b * c)
}
