//! The further columns of a tongue's row: growth, the predicted point, the law of first order.

use std::f64::consts::{LN_10, PI};

use num_traits::{Signed, Zero as _};

use super::edge::Zero;
use crate::verify::context::{Checked, Fault, holds};
use crate::verify::exact::{ZeroOf, between, fraction, ln_multiplier_at, resonance};
use clocks::propagator::{TwoClocks, half_period};
use clocks::tongue::{Law, Peak, Predicted, Resonance, Side, Stiffness, Tongue};
use number::{Ball, Rational, rational};

/// Rounded numbers are right to nine digits: some are the end of a few hundred operations in doubles.
const ROUNDED: f64 = 1e-9;

fn near(said: f64, truth: f64) -> bool {
    (said - truth).abs() <= ROUNDED * truth.abs()
}

fn exact(x: f64) -> Checked<Rational> {
    rational::from_f64_exact(x).ok_or_else(|| Fault::Wrong(format!("{x} is no number")))
}

/// The growth is that of its place, and falls on both sides of it.
pub fn growth(
    peak: &Peak,
    tongue: &Tongue,
    given: &Stiffness,
    (lower, upper): (&ZeroOf, &ZeroOf),
) -> Checked {
    const BITS: u32 = 256;
    let s = exact(peak.s)?;
    let ends = tongue.upper.as_ref().map_or(f64::INFINITY, |upper| upper.s.hi);
    let inside = (tongue.lower.s.lo..=ends).contains(&peak.s);
    holds(inside, || format!("its fastest growth is written outside of it, at s = {}", peak.s))?;
    let ln = |s: &Rational| ln_multiplier_at(&lower.clocks(s.clone()), BITS);
    // ln μ/√s, the rate but for a factor.
    let rate = |s: &Rational| {
        let root = Ball::from_rational(s, BITS).sqrt(BITS)?;
        ln(s).filter(|_| lower.lo <= *s && *s <= upper.hi)?.div(&root, BITS)
    };
    let width = &upper.lo - &lower.hi;
    // A place is written to nine digits. Where it lies inside with them, growth is compared there.
    let (far, close) = (&s * fraction(1, 1_000_000_000), &s * fraction(1, 20_000_000_000));
    let points = [&s - &far, &s - &close, &s + &close, &s + &far];
    let truth = if lower.hi < points[0] && points[3] < upper.lo {
        let [before, left, right, after] = points.map(|s| rate(&s));
        let rises = |a: Option<Ball>, b: Option<Ball>| Some(a?.compare(&b?)? == std::cmp::Ordering::Less);
        let is_peak = rises(before, left) == Some(true) && rises(after, right) == Some(true);
        holds(is_peak, || format!("growth is faster beside s = {}", peak.s))?;
        ln(&s).map_or(0.0, |ln| ln.mid_f64())
    } else {
        thin(lower, &width)?
    };
    holds(near(peak.ln_multiplier, truth), || format!("ln of the multiplier is {truth}"))?;
    let (p, q) = tongue.row.ratio.terms();
    let rate = truth / (p as f64 * peak.s.sqrt());
    holds(near(peak.rate, rate), || format!("the rate is {rate}"))?;
    let steps = LN_10 * q as f64 / truth;
    holds(near(peak.slow_steps_to_tenfold, steps), || format!("tenfold takes {steps} slow steps"))?;
    let truth = given.lambda1.as_ref().map(|lambda1| rate * lambda1.to_f64().sqrt());
    match (tongue.growth_rate, truth) {
        (Some(said), Some(truth)) => holds(near(said, truth), || format!("the growth rate is {truth}")),
        (None, None) => Ok(()),
        _ => Err(Fault::Wrong("growth_rate is there where lambda1 is".into())),
    }
}

/// The largest ln μ of a tongue that is thin against nine digits of s: sinh² (ln μ/2) is a parabola there, by
/// three points of it.
fn thin(lower: &ZeroOf, width: &Rational) -> Checked<f64> {
    const BITS: u32 = 256;
    let square = |quarter: u64| -> Option<Ball> {
        let s = &lower.hi + width * fraction(quarter, 4);
        let ln = ln_multiplier_at(&lower.clocks(s), BITS + 2 * width.denom().bits() as u32)?;
        let half = ln.scale2(-1).exp(BITS);
        let sinh = half.sub(&Ball::one().div(&half, BITS)?, BITS).scale2(-1);
        Some(sinh.square(BITS))
    };
    let [Some(a), Some(b), Some(c)] = [square(1), square(2), square(3)] else {
        return Err(Fault::Wrong("nothing grows inside".into()));
    };
    // Vertex of the parabola through (-1, a), (0, b), (1, c): b - (c - a)^2/(8 (a - 2b + c)).
    let slope = c.sub(&a, BITS).square(BITS);
    let bend = a.add(&c, BITS).sub(&b.scale2(1), BITS).scale2(3);
    let top = slope.div(&bend, BITS).map(|x| b.sub(&x, BITS));
    let ln = top.and_then(|top| top.sqrt(BITS)).map(|root| root.asinh(BITS).scale2(1).mid_f64());
    ln.ok_or_else(|| Fault::Wrong("nothing grows inside".into()))
}

/// The point lies where it is said to lie: on an edge by theory or in cyclotomic numbers, else edge and point
/// part.
pub fn predicted(point: &Predicted, m: u64, lower: &Zero, upper: &Zero) -> Checked {
    let p = lower.zero.ratio.p();
    let (position, distance) = (point.side, point.distance);
    let s = resonance(p, m, BITS);
    let (least, most) = s.to_f64_enclosure();
    holds((least.next_down()..=most.next_up()).contains(&point.s), || {
        format!("p theta = m pi is s = {}", s.mid_f64())
    })?;
    let on = (lower.sits(Resonance::Fast, m), upper.sits(Resonance::Fast, m));
    let (mut below, mut above) = (lower.zero.clone(), upper.zero.clone());
    let truth = match on {
        (Some(true), _) => Side::OnLower,
        (_, Some(true)) => Side::OnUpper,
        (Some(false), Some(false)) => place(p, m, &mut below, &mut above)?,
        // Too long a period for the field: what the enclosures leave open is taken as it is written.
        _ if matches!(position, Side::OnLower | Side::OnUpper) => position,
        _ => place(p, m, &mut below, &mut above)?,
    };
    holds(truth == position, || format!("p theta = m pi is {}", truth.name()))?;
    let truth = match truth {
        Side::OnLower | Side::OnUpper => return holds(distance == 0.0, || "its distance is 0".into()),
        Side::Below => apart(p, m, &mut below),
        Side::Above => apart(p, m, &mut above),
        Side::Inside => -apart(p, m, &mut below).min(apart(p, m, &mut above)),
    };
    // Both ends are rounded where they are doubles: of a larger distance that takes less than a
    // millionth.
    let slack = 1e-6 * truth.abs();
    holds((distance - truth).abs() <= slack, || {
        format!("the distance to its tongue is {truth}, not {distance}")
    })
}

const BITS: u32 = 128;

/// Where the point lies that is on neither edge: halved until they part.
fn place(p: u64, m: u64, lower: &mut ZeroOf, upper: &mut ZeroOf) -> Checked<Side> {
    let mut bits = BITS;
    for _ in 0..64 {
        let s = resonance(p, m, bits);
        match () {
            () if s.upper() < lower.lo => return Ok(Side::Below),
            () if upper.hi < s.lower() => return Ok(Side::Above),
            () if lower.hi < s.lower() && s.upper() < upper.lo => return Ok(Side::Inside),
            () => {}
        }
        for _ in 0..32 {
            lower.halve();
            upper.halve();
        }
        bits += 32;
    }
    Err(Fault::Wrong("the predicted point and an edge do not part".into()))
}

/// The distance of the point from an edge, to ten digits.
fn apart(p: u64, m: u64, edge: &mut ZeroOf) -> f64 {
    let mut bits = BITS;
    loop {
        let s = resonance(p, m, bits);
        let [least, most] = if s.upper() < edge.lo {
            [&edge.lo - s.upper(), &edge.hi - s.lower()]
        } else {
            [s.lower() - &edge.hi, s.upper() - &edge.lo]
        };
        if least.is_positive() && most <= &least * fraction(10_000_000_001, 10_000_000_000) {
            return rational::to_f64(&least);
        }
        (0..16).for_each(|_| edge.halve());
        bits += 16;
    }
}

/// The law by the edges' slopes in ρ at ρ = 0, −X_ρ/X_s for either entry X: with no sum over the slow kicks.
pub fn first_order(law: &Law, m: u64, lower: &Zero, upper: &Zero, width: (f64, f64)) -> Checked {
    let (p, rho) = (lower.zero.ratio.p(), lower.zero.rho);
    // Differences of 2^-80 in exact arithmetic: slopes to 2^-70 or so.
    let (near_s, small) = (resonance(p, m, 200).lower(), fraction(1, 1 << 40) * fraction(1, 1 << 40));
    let at = |s: Rational, rho: Rational| {
        let half = half_period(&TwoClocks::with_rho(lower.zero.ratio, s, rho));
        [lower, upper].map(|edge| half.matrix().transpose()[edge.zero.entry as usize].clone())
    };
    let here = at(near_s.clone(), Rational::zero());
    let (beside, stronger) = (at(&near_s + &small, Rational::zero()), at(near_s.clone(), small));
    let slope = |k: usize| -((&stronger[k] - &here[k]) / (&beside[k] - &here[k]));
    let shifts = [rho * slope(0), rho * slope(1)];
    let two = Rational::from_integer(2.into());
    let (centre, found) = (&near_s + (&shifts[0] + &shifts[1]) / &two, (&shifts[0] - &shifts[1]).abs());
    // What the slopes leave open.
    let off = (shifts[0].abs() + shifts[1].abs()) * fraction(1, 1 << 60);
    let [s, width_of_law, slack] = [&near_s, &found, &off].map(rational::to_f64);
    let close = |said: f64, truth: f64, by: f64| (said - truth).abs() <= by;
    let middle = rational::to_f64(&centre);
    holds(close(law.centre, middle, f64::EPSILON * s), || format!("the law's centre is {middle}"))?;
    let by = slack + f64::EPSILON * width_of_law;
    holds(close(law.width, width_of_law, by), || format!("the law's width is {width_of_law}"))?;
    // Half the width in p θ: ds = 2 sin θ dθ.
    let turn = p as f64 / (4.0 * (PI * m as f64 / p as f64).sin());
    let ln = width_of_law * turn;
    holds(close(law.ln_multiplier, ln, slack * turn + ROUNDED * ln), || format!("the law's growth is {ln}"))?;
    // What is enclosed meets what this route finds, and is no wider than the edges and the width are
    // known.
    let meets = |name: &str, said: (f64, f64), [least, most]: [Rational; 2], widest: f64| {
        let (lo, hi) = between(said.0, said.1)?;
        let is_close = said.1 - said.0 <= widest;
        holds(lo <= most && least <= hi && is_close, || {
            format!("{name} lies between {} and {}", rational::to_f64(&least), rational::to_f64(&most))
        })
    };
    let [lower, upper] = [&lower.zero, &upper.zero];
    let middles = [(&lower.lo + &upper.lo) / &two, (&lower.hi + &upper.hi) / &two];
    let [least, most] = middles.map(|middle| middle - &centre);
    meets("centre_error", law.centre_error, [least - &off, most + &off], 16.0 * f64::EPSILON * s)?;
    let (lo, hi) = between(width.0, width.1)?;
    // Radii of balls are rounded up in the last of 30 bits.
    let widest = (1.0 + 1e-6) * (width.1 - width.0) + 4.0 * f64::EPSILON * (width.1 + width_of_law);
    meets("width_error", law.width_error, [&lo - &found - &off, &hi - &found + &off], widest)?;
    let ends = [lo / (&found + &off), hi / (&found - &off)];
    meets("width_ratio", law.width_ratio, ends, 2.0 * widest / width_of_law)
}
