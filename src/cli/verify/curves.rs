//! Curves: θ of each h1 by an arctangent, and h2 from the symmetric form 1/T½ = a/h1 + b/h2.

use serde_json::Value;

use super::read::{Checked, Fault, Row, holds, whole};
use super::{Context, Outcome};
use crate::error::Result;
use crate::number::{Ball, Laurent, Rational, rational};
use crate::resonance::Angle;

const ROUTE: &str = "theta of every h1 by an arctangent, h2 from 1/T_half = a/h1 + b/h2, both enclosed";

pub fn check(document: &Value, context: &Context) -> Result<Outcome> {
    let all = Row::new(document);
    let lambda1 = whole(whole(all.object("input"))?.quantity("lambda1"))?;
    let curves = whole(all.rows("curves"))?;
    context.rows(curves, ROUTE, |curve| {
        let (a, b) = (curve.integer("a")?, curve.integer("b")?);
        curve.rows("points")?.iter().try_for_each(|point| check_point(&Row::new(point), a, b, &lambda1))
    })
}

fn check_point(point: &Row, a: i64, b: i64, lambda1: &Laurent) -> Checked<()> {
    const BITS: u32 = 128;
    let (h1, h2, told) = (point.float("h1")?, point.float("h2")?, point.float("theta_over_pi")?);
    let exact = rational::from_f64_exact(h1).filter(|_| h1 > 0.0);
    let exact = exact.ok_or_else(|| Fault::Wrong(format!("h1 = {h1} is no step")))?;
    let s = &Laurent::from_rational(&exact * &exact) * lambda1;
    let angle =
        Angle::new(s).ok_or_else(|| Fault::Wrong(format!("h1 = {h1} lies beyond the Verlet limit")))?;
    let share = angle.over_pi(BITS);
    let integer = |n: i64| Ball::from_rational(&Rational::from_integer(n.into()), BITS);
    let denominator = share.sub(&integer(a), BITS);
    let step = Ball::from_rational(&exact, BITS).mul(&integer(b), BITS).div(&denominator, BITS);
    let step = step.ok_or_else(|| Fault::Wrong(format!("h1 = {h1} is where the curve has no point")))?;
    // Told as the nearest doubles, to within one unit in the last place.
    let near = |told: f64, x: &Ball| {
        let (lo, hi) = x.to_f64_enclosure();
        lo.next_down() <= told && told <= hi.next_up()
    };
    holds(near(told, &share), || format!("theta/pi at h1 = {h1} is {}, not {told}", share.mid_f64()))?;
    holds(near(h2, &step), || format!("h2 at h1 = {h1} is {}, not {h2}", step.mid_f64()))
}
