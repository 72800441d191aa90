//! Curves: θ of each h1 by an arctangent, and h2 from the symmetric form 1/T½ = a/h1 + b/h2; which pieces lie
//! in the window, from the heights of each branch at its ends, in doubles along θ.

use std::f64::consts::FRAC_PI_2;

use super::again::Excluded;
use super::context::{Checked, Context, Fault, Outcome, holds};
use super::kind::Verify;
use crate::question::Curves;
use clocks::resonance::{Angle, Curve, CurvePoint};
use number::{Ball, Laurent, Rational, Result, rational};

const ROUTE: &str = "theta of every h1 by an arctangent, h2 from 1/T_half = a/h1 + b/h2, both enclosed; which pieces lie \
                     in the window, from the heights of the branches' ends, in doubles";

/// Heights in doubles are right to some units in the last place; what is this near the border may lie on
/// either side.
const BORDER_ROOM: f64 = 1e-9;

/// The fast clock's limit, θ = π: curves end before it.
const LIMIT: f64 = 1.0 - 1e-7;

impl Verify for Curves {
    const EXCLUDED: &'static [Excluded] = &[
        ("input.step1", "curves do not depend on the spacing of a grid"),
        ("input.step2", "curves do not depend on the spacing of a grid"),
    ];

    fn check(&self, curves: &Vec<Curve>, context: &Context) -> Result<Outcome> {
        let window = Window::new(self);
        let shown: Vec<&Curve> = curves.iter().filter(|curve| !curve.pieces.is_empty()).collect();
        context.outcome(ROUTE, complete(self, &window, &shown), &shown, |curve| {
            window.pieces(curve)?;
            curve.pieces.iter().flatten().try_for_each(|point| is_on(point, curve, &self.lambda1))
        })
    }
}

/// All curves through the window are there, by a, then b.
fn complete(question: &Curves, window: &Window, curves: &[&Curve]) -> Checked {
    let ((a0, a1), (b0, b1)) = (question.a, question.b);
    let mut found = curves.iter().map(|curve| (curve.a, curve.b)).peekable();
    for (a, b) in (a0..=a1).flat_map(|a| (b0..=b1).map(move |b| (a, b))) {
        let there = found.next_if_eq(&(a, b)).is_some();
        let passes = || window.expected(a, b).is_some_and(|pieces| pieces > 0);
        holds(there || !passes(), || {
            format!("the curve a = {a}, b = {b} passes through the window and is missing")
        })?;
    }
    let next = found.next();
    holds(next.is_none(), || format!("the curve {:?} does not belong here", next.unwrap_or_default()))
}

/// The window in doubles.
struct Window {
    h1: (f64, f64),
    h2: (f64, f64),
    /// θ/π at the ends of h1, where the fast clock has one.
    share: (f64, f64),
    root: f64,
}

impl Window {
    fn new(question: &Curves) -> Window {
        let ends = |(lo, hi): &(Laurent, Laurent)| (lo.to_f64(), hi.to_f64());
        let (h1, root) = (ends(&question.h1_range), question.lambda1.to_f64().sqrt());
        let share = |h1: f64| (h1 * root / 2.0).clamp(0.0, 1.0).asin() / FRAC_PI_2;
        // Neither end itself: a = 0 has a limit there, and a = 1 none.
        let share = |h1: f64| share(h1).clamp(1e-300, 1.0 - 1e-15);
        Window { share: (share(h1.0), share(h1.1)), h1, h2: ends(&question.h2_range), root }
    }

    /// How many pieces of a curve lie in the window; `None` where doubles leave it open, a height being near
    /// the border.
    fn expected(&self, a: i64, b: i64) -> Option<usize> {
        let ((from, to), (low, high)) = (self.share, self.h2);
        // h2 √L1/2 along x = θ/π, and where it turns: (π/2) cos(πx/2) (x − a) = sin(πx/2).
        let height = |x: f64| b as f64 * (FRAC_PI_2 * x).sin() / (x - a as f64);
        let rises = |x: f64| FRAC_PI_2 * (FRAC_PI_2 * x).cos() * (x - a as f64) > (FRAC_PI_2 * x).sin();
        if from >= LIMIT || to - from <= BORDER_ROOM * to {
            return None;
        }
        let turn = match (a, b) {
            (1.., ..0) => to,
            (0, 1..) => from,
            (..0, 1..) => {
                (0..60)
                    .fold((from, to), |(lo, hi), _| {
                        let middle = (lo + hi) / 2.0;
                        if rises(middle) { (middle, hi) } else { (lo, middle) }
                    })
                    .0
            }
            _ => return Some(0),
        };
        let beside = |x: f64, end: f64| (x - end).abs() <= BORDER_ROOM * end.abs();
        let [first, middle, last] = [from, turn, to].map(|x| 2.0 / self.root * height(x));
        // A branch from its lower height to its higher one.
        let branch = |bottom: f64, top: f64| match () {
            () if beside(bottom, high) || beside(top, low) => None,
            () => Some(bottom < high && top > low),
        };
        let up = if turn > from { branch(first, middle)? } else { false };
        let down = if turn < to { branch(last, middle)? } else { false };
        let (rising, falling) = (turn > from, turn < to);
        match rising && falling {
            true if beside(middle, high) => None,
            // The peak itself lies in the window.
            true if up && down && middle < high => Some(1),
            _ => Some(usize::from(up) + usize::from(down)),
        }
    }

    /// There are as many pieces as there should be, each from one border to the next, its points inside.
    fn pieces(&self, curve: &Curve) -> Checked {
        let (expected, count) = (self.expected(curve.a, curve.b), curve.pieces.len());
        holds(expected.is_none_or(|expected| expected == count), || {
            format!("it has {count} pieces, not {}", expected.unwrap_or_default())
        })?;
        let points: Vec<&CurvePoint> = curve.pieces.iter().flatten().collect();
        let is_ordered = points.windows(2).all(|pair| pair[0].h1 < pair[1].h1);
        holds(is_ordered, || "its points or pieces are out of order".into())?;
        curve.pieces.iter().try_for_each(|piece| self.is_whole(piece))
    }

    fn is_whole(&self, piece: &[CurvePoint]) -> Checked {
        let [Some(first), Some(last)] = [piece.first(), piece.last()] else {
            return holds(false, || "a piece has no points".into());
        };
        let on = |x: f64, end: f64| (x - end).abs() <= BORDER_ROOM * end.abs();
        let leaves = |x: &CurvePoint| on(x.h2, self.h2.0) || on(x.h2, self.h2.1);
        let left =
            |point: &CurvePoint| format!("beside h1 = {} the crossing of the border is missing", point.h1);
        // Where the window reaches h1 = 0 a curve begins at the least double.
        let begins = self.h1.0 <= 0.0 && first.h1 < f64::MIN_POSITIVE / BORDER_ROOM.powi(4);
        holds(begins || on(first.h1, self.h1.0) || leaves(first), || left(first))?;
        holds(last.theta_over_pi >= LIMIT || on(last.h1, self.h1.1) || leaves(last), || left(last))?;
        let within =
            |x: f64, (lo, hi): (f64, f64)| x >= lo * (1.0 - BORDER_ROOM) && x <= hi * (1.0 + BORDER_ROOM);
        let outside = piece.iter().find(|point| !(within(point.h1, self.h1) && within(point.h2, self.h2)));
        holds(outside.is_none(), || {
            format!("h1 = {} lies outside the window", outside.map_or(0.0, |point| point.h1))
        })
    }
}

fn is_on(point: &CurvePoint, curve: &Curve, lambda1: &Laurent) -> Checked {
    const BITS: u32 = 128;
    let CurvePoint { h1, h2, theta_over_pi: said } = *point;
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
    let near = |said: f64, x: &Ball| {
        let (lo, hi) = x.to_f64_enclosure();
        lo.next_down() <= said && said <= hi.next_up()
    };
    holds(near(said, &share), || format!("theta/pi at h1 = {h1} is {}, not {said}", share.mid_f64()))?;
    holds(near(h2, &step), || format!("h2 at h1 = {h1} is {}, not {h2}", step.mid_f64()))
}
