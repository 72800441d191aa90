//! Integrators side by side: counted again by traces in doubles.

use super::again::{Recheck, asked};
use super::context::{Checked, Context, Outcome, holds};
use crate::error::Result;
use crate::number::rational::to_f64;
use crate::number::{Radical, Real};
use crate::question::{CompareMethods, Side};
use crate::word::{Bounded, Force, Integrator, Letter, Trigonometric};

const ROUTE: &str = "the trace at every point in doubles, letter by letter; points within 1e-7 of an edge may fall on either side";

/// A trace this near to ±2 tells nothing in doubles.
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
        let [steps, ratios] = self.input.grid()?;
        let squares: Vec<f64> = self.input.squares(&steps).iter().map(|s| s.to_f64()).collect();
        let ratios: Vec<f64> = ratios.iter().map(to_f64).collect();
        context.outcome(ROUTE, ("the grid", Ok(())), &self.methods, |row| {
            let own = sides.iter().find(|own| own.name == row.method);
            holds(own.is_some(), || format!("{} is not among the methods", row.method))?;
            own.map_or(Ok(()), |own| row.holds(own, &squares, &ratios))
        })
    }
}

impl Row {
    fn holds(&self, own: &Side, squares: &[f64], ratios: &[f64]) -> Checked {
        let (mut stable, mut unstable) = (0u64, 0u64);
        for rho in ratios {
            for s in squares {
                let excess = trace(&own.integrator, *s, *rho).abs() - 2.0;
                stable += u64::from(excess < -NEAR);
                unstable += u64::from(excess > NEAR);
            }
        }
        let points = (squares.len() * ratios.len()) as u64;
        holds(self.stable + self.unstable + self.edge == points, || format!("there are {points} points"))?;
        let right =
            self.stable >= stable && self.unstable >= unstable && own.count(Bounded::Stable) == self.stable;
        holds(right, || format!("{stable} points are stable and {unstable} are not, away from edges"))
    }
}

fn trace(integrator: &Integrator, s: f64, rho: f64) -> f64 {
    let word = match integrator {
        Integrator::Trigonometric(own) => {
            let x = s.sqrt();
            let sinc = |x: f64| x.sin() / x;
            let (whole, half) = (sinc(x), sinc(x / 2.0));
            let g = match own {
                Trigonometric::Impulse => whole,
                Trigonometric::Gautschi => half.powi(2),
                Trigonometric::Short => whole * half.powi(2),
                Trigonometric::Linear => whole * half.powi(4),
                Trigonometric::Long => whole.powi(3),
                Trigonometric::HairerLubich => whole.powi(2),
            };
            return 2.0 * x.cos() - s * rho * g;
        }
        Integrator::Word(word) => word,
    };
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
            match letter {
                Letter::Drift(time) => *x += number(time) * *v,
                Letter::Kick { force, powers } => {
                    let f = strength(*force);
                    let kick = powers.iter().rev().fold(0.0, |sum, c| (sum + number(c)) * f);
                    *v -= kick * *x;
                }
                Letter::Midpoint { force, time } => {
                    let (c, f) = (number(time), strength(*force));
                    let q = c * c * f / 4.0;
                    let before = (*x, *v);
                    *x = ((1.0 - q) * before.0 + c * before.1) / (1.0 + q);
                    *v = (-c * f * before.0 + (1.0 - q) * before.1) / (1.0 + q);
                }
            }
        }
    }
    columns[0][0] + columns[1][1]
}
