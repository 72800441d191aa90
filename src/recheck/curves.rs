//! Curves: θ of each h1 by an arctangent, and h2 from the symmetric form 1/T½ = a/h1 + b/h2; the samples, evenly spaced
//! in θ, laid out again in doubles.

use std::f64::consts::FRAC_PI_2;

use serde_json::Value;

use super::again::{Left, Recheck};
use super::context::{Checked, Context, Fault, Outcome, Place, holds};
use super::written::{Range, Written};
use crate::error::Result;
use crate::number::{Ball, ExactSign, Laurent, Rational, Sign, rational};
use crate::report::curves as report;
use crate::resonance::{self, Angle, Families};

const ROUTE: &str = "theta of every h1 by an arctangent, h2 from 1/T_half = a/h1 + b/h2, both enclosed; which samples lie \
                     in the window, in doubles";

rows! {
    /// `kickdrift/curves/1`.
    pub struct Claim {
        input: Input,
        curves: Vec<Curve>,
    }

    #[serde(deny_unknown_fields)]
    struct Input {
        lambda1: Written<Laurent>,
        #[serde(rename = "step1")]
        _step1: Option<Written<Laurent>>,
        #[serde(rename = "step2")]
        _step2: Option<Written<Laurent>>,
        h1_range: Written<Range>,
        h2_range: Written<Range>,
        a: Written<(i64, i64)>,
        b: Written<(i64, i64)>,
        samples: Written<u64>,
    }

    struct Curve {
        a: i64,
        b: i64,
        points: Vec<Point>,
    }

    #[derive(Copy)]
    struct Point {
        h1: f64,
        h2: f64,
        theta_over_pi: f64,
        piece: u64,
    }
}

impl Place for Curve {
    fn place(&self) -> String {
        format!("a = {}, b = {}", self.a, self.b)
    }
}

/// The most curves and points that a document can hold.
const MOST: i128 = 20_000_000;

/// Doubles of the samples are right to some units in the last place; a point this near the border may lie on either side.
const NEAR: f64 = 1e-9;

impl Recheck for Claim {
    const TABLE: &'static str = "curves";
    const LEFT: &'static [Left] = &[
        ("input.step1", "curves do not depend on the spacing of a grid"),
        ("input.step2", "curves do not depend on the spacing of a grid"),
    ];
    type Found = ();

    fn again(&self, _: &Context) -> Result<(Value, ())> {
        let Input { lambda1, h1_range, h2_range, a, b, samples, .. } = &self.input;
        let families = Families { a: a.0, b: b.0, samples: usize::try_from(samples.0).unwrap_or(usize::MAX) };
        let curves = families.curves(lambda1, &resonance::Window::new(h1_range, h2_range))?;
        Ok((report::document(&curves).value(), ()))
    }

    fn check(&self, (): (), context: &Context) -> Result<Outcome> {
        let window = Window::new(&self.input);
        let whole = self.complete(&window);
        context.outcome(ROUTE, ("the list", whole), &self.curves, |curve| {
            window.samples(curve)?;
            curve.points.iter().try_for_each(|point| point.holds(curve, &self.input.lambda1))
        })
    }
}

impl Claim {
    /// All curves with a sample in the window are there, by a, then b.
    fn complete(&self, window: &Window) -> Checked {
        let ((a0, a1), (b0, b1), samples) = (*self.input.a, *self.input.b, *self.input.samples);
        let count = |lo: i64, hi: i64| i128::from(hi) - i128::from(lo) + 1;
        let points = count(a0, a1).saturating_mul(count(b0, b1)).saturating_mul(samples.into());
        holds(points <= MOST && samples >= 2, || "more points than a document holds, or none".into())?;
        holds(self.input.lambda1.sign() == Sign::Positive, || "lambda1 is not positive".into())?;
        let mut told = self.curves.iter().map(|curve| (curve.a, curve.b)).peekable();
        for (a, b) in (a0..=a1).flat_map(|a| (b0..=b1).map(move |b| (a, b))) {
            let there = told.next_if_eq(&(a, b)).is_some();
            let has = || (1..samples).any(|k| window.place(a, b, k) == Some(true));
            holds(there || !has(), || {
                format!("the curve a = {a}, b = {b} passes through the window and is missing")
            })?;
        }
        let next = told.next();
        holds(next.is_none(), || format!("the curve {:?} does not belong here", next.unwrap_or_default()))
    }
}

/// The window in doubles, and the samples.
struct Window {
    h1: (f64, f64),
    h2: (f64, f64),
    root: f64,
    samples: u64,
}

impl Window {
    fn new(input: &Input) -> Window {
        let ends = |(lo, hi): &Range| (lo.to_f64(), hi.to_f64());
        let root = input.lambda1.to_f64().sqrt();
        Window { h1: ends(&input.h1_range), h2: ends(&input.h2_range), root, samples: *input.samples }
    }

    /// Whether sample k of a curve lies in the window: θ/π = k/samples; `None` on its border.
    fn place(&self, a: i64, b: i64, k: u64) -> Option<bool> {
        let x = k as f64 / self.samples as f64;
        let h1 = 2.0 * (FRAC_PI_2 * x).sin() / self.root;
        // θ/π − a cancels where the curve leaves for h2 = ∞.
        let h2 = b as f64 * h1 / (x - a as f64);
        let inside = |x: f64, (lo, hi): (f64, f64)| match () {
            () if x > lo * (1.0 + NEAR) && x < hi * (1.0 - NEAR) => Some(true),
            () if !(x >= lo * (1.0 - NEAR) && x <= hi * (1.0 + NEAR)) => Some(false),
            () => None,
        };
        match (inside(h1, self.h1), inside(h2, self.h2).filter(|_| h2 > 0.0 || b == 0)) {
            _ if !(h2 > 0.0 && h2.is_finite()) => Some(false),
            (Some(false), _) | (_, Some(false)) => Some(false),
            (Some(true), Some(true)) => Some(true),
            _ => None,
        }
    }

    /// A point is a sample, or stands on the border where its curve crosses it; no sample in the window is missing, and
    /// pieces are runs of samples.
    fn samples(&self, curve: &Curve) -> Checked {
        let on =
            |x: f64, (lo, hi): (f64, f64)| [lo, hi].iter().any(|end| (x - end).abs() <= NEAR * end.abs());
        let outside =
            |k: u64| (1..self.samples).contains(&k) && self.place(curve.a, curve.b, k) == Some(false);
        let missing = |from: u64, upto: u64| match (from..upto)
            .find(|&k| self.place(curve.a, curve.b, k) == Some(true))
        {
            None => Ok(()),
            Some(k) => Err(Fault::Wrong(format!("sample {k} is missing"))),
        };
        let left = |h1: f64| format!("beside h1 = {h1} the crossing of the border is missing");
        // The first sample not yet seen, and the last point with its sample, if it is one.
        let (mut next, mut last): (u64, Option<(Point, Option<u64>)>) = (1, None);
        for point in &curve.points {
            let (h1, share) = (point.h1, point.theta_over_pi * self.samples as f64);
            let crossing = on(h1, self.h1) || on(point.h2, self.h2);
            let is_sample = (share - share.round()).abs() <= NEAR * self.samples as f64;
            holds(is_sample || crossing, || format!("h1 = {h1} is neither a sample nor on the border"))?;
            let upto = if is_sample { share.round() } else { share.ceil() } as u64;
            holds(upto >= next && upto <= self.samples, || format!("h1 = {h1} is out of order"))?;
            missing(next, upto)?;
            holds(crossing || !outside(upto), || format!("h1 = {h1} lies outside the window"))?;
            let begins = last.is_none_or(|(last, _)| last.piece != point.piece);
            let expected = last.map_or(0, |(last, _)| last.piece + u64::from((next..upto).any(outside)));
            // Whether a sample on the border lies inside doubles may not tell.
            let right =
                point.piece == expected || (crossing && point.piece == expected + 1 && last.is_some());
            holds(right, || format!("h1 = {h1} belongs to piece {expected}"))?;
            if begins {
                holds(crossing || !outside(upto - 1), || left(h1))?;
                let ended = last.and_then(|(last, k)| Some((last.h1, k?)));
                holds(ended.is_none_or(|(_, k)| !outside(k + 1)), || left(ended.map_or(h1, |(h1, _)| h1)))?;
            }
            next = if is_sample { upto + 1 } else { upto };
            last = Some((*point, Some(upto).filter(|_| !crossing)));
        }
        missing(next, self.samples)?;
        match last {
            Some((last, k)) => holds(k.is_none_or(|k| !outside(k + 1)), || left(last.h1)),
            None => Err(Fault::Wrong("it has no points".into())),
        }
    }
}

impl Point {
    fn holds(&self, curve: &Curve, lambda1: &Laurent) -> Checked {
        const BITS: u32 = 128;
        let Point { h1, h2, theta_over_pi: told, .. } = *self;
        let exact = rational::from_f64_exact(h1).filter(|_| h1 > 0.0);
        let exact = exact.ok_or_else(|| Fault::Wrong(format!("h1 = {h1} is no step")))?;
        let s = &Laurent::from_rational(&exact * &exact) * lambda1;
        let angle =
            Angle::new(s).ok_or_else(|| Fault::Wrong(format!("h1 = {h1} lies beyond the Verlet limit")))?;
        let share = angle.over_pi(BITS);
        let integer = |n: i64| Ball::from_rational(&Rational::from_integer(n.into()), BITS);
        let denominator = share.sub(&integer(curve.a), BITS);
        let step = Ball::from_rational(&exact, BITS).mul(&integer(curve.b), BITS).div(&denominator, BITS);
        let step = step.ok_or_else(|| Fault::Wrong(format!("h1 = {h1} is where the curve has no point")))?;
        // Written as the nearest doubles, to within one unit in the last place.
        let near = |told: f64, x: &Ball| {
            let (lo, hi) = x.to_f64_enclosure();
            lo.next_down() <= told && told <= hi.next_up()
        };
        holds(near(told, &share), || format!("theta/pi at h1 = {h1} is {}, not {told}", share.mid_f64()))?;
        holds(near(h2, &step), || format!("h2 at h1 = {h1} is {}, not {h2}", step.mid_f64()))
    }
}
