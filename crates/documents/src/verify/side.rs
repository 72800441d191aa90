//! Integrators side by side: counted again by traces in doubles.

use super::again::{Recheck, asked};
use super::context::{Checked, Context, Outcome, holds};
use crate::question::{CompareMethods, Side};
use number::error::Result;
use number::rational::to_f64;
use number::{Radical, Real};
use words::{Bounded, Force, Integrator, Letter, Word};

const ROUTE: &str = "the trace at every point in doubles, letter by letter; points within 1e-7 of an edge may fall on either side";

/// A trace this near to ±2 decides nothing in doubles.
const NEAR: f64 = 1e-7;

rows! {
    /// `kickdrift/compare-methods/1`.
    pub struct Claim {
        input: CompareMethods,
        methods: Vec<Row>,
    }

    struct Row [method] {
        method: String,
        stable: u64,
        unstable: u64,
        edge: u64,
    }
}

impl Recheck for Claim {
    const TABLE: &'static str = "methods";
    asked!(CompareMethods);

    fn check(&self, sides: Vec<Side>, context: &Context) -> Result<Outcome> {
        let ([steps, ups], ratio) = (self.input.grid()?, self.input.ratio()?);
        let squares = self.input.squares(&steps);
        // (h² Λ1, Λ2/Λ1)
        let points: Vec<(f64, f64)> = ups
            .iter()
            .flat_map(|up| {
                steps
                    .iter()
                    .zip(&squares)
                    .map(|(h, s)| (s.to_f64(), to_f64(&ratio(h, up))))
                    .collect::<Vec<_>>()
            })
            .collect();
        context.outcome(ROUTE, ("the grid", Ok(())), &self.methods, |row| {
            let side = sides.iter().find(|side| side.name == row.method);
            holds(side.is_some(), || format!("{} is not among the methods", row.method))?;
            side.map_or(Ok(()), |side| row.holds(side, &points))
        })
    }
}

impl Row {
    fn holds(&self, side: &Side, points: &[(f64, f64)]) -> Checked {
        let (mut stable, mut unstable) = (0u64, 0u64);
        for (s, rho) in points {
            let excess = trace(&side.integrator, *s, *rho).abs() - 2.0;
            stable += u64::from(excess < -NEAR);
            unstable += u64::from(excess > NEAR);
        }
        let points = points.len() as u64;
        holds(self.stable + self.unstable + self.edge == points, || format!("there are {points} points"))?;
        let right =
            self.stable >= stable && self.unstable >= unstable && side.count(Bounded::Stable) == self.stable;
        holds(right, || format!("{stable} points are stable and {unstable} are not, away from edges"))
    }
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
                Letter::Friction(time) => *v *= (-friction * number(time)).exp(),
                Letter::Kick { force, filter, powers } => {
                    let f = strength(*force);
                    let kick = powers.iter().rev().fold(0.0, |sum, c| (sum + number(c)) * f);
                    let half = s.sqrt() / 2.0;
                    let g = half.cos().powi(filter.cos) * sinc(half).powi(filter.sinc);
                    *v -= if filter.zero { 0.0 } else { kick * g } * *x;
                }
                Letter::Flow { force, time } => {
                    let (c, f) = (number(time), strength(*force));
                    let y = c.abs() * f.sqrt();
                    *x = y.cos() * before.0 + c * sinc(y) * before.1;
                    *v = -c * f * sinc(y) * before.0 + y.cos() * before.1;
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
