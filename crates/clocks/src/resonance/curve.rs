//! The curves (a, b) of eq. (10), sampled for tables and figures.

use std::cmp::Ordering;

use number::{Ball, Error, ExactSign, Laurent, Real, Result, Sign};

/// The part of the (h1, h2) plane in which curves are wanted; closed ranges.
#[derive(Clone, Debug, PartialEq)]
pub struct Window {
    pub h1: (f64, f64),
    pub h2: (f64, f64),
}

impl Window {
    /// The window of two closed ranges, widened to doubles.
    pub fn new(h1: &(Laurent, Laurent), h2: &(Laurent, Laurent)) -> Window {
        let ends = |(lo, hi): &(Laurent, Laurent)| (lo.enclose_f64().0, hi.enclose_f64().1);
        Window { h1: ends(h1), h2: ends(h2) }
    }

    /// The window of two closed ranges, its ends the nearest doubles: as points are written.
    pub fn nearest(h1: &(Laurent, Laurent), h2: &(Laurent, Laurent)) -> Window {
        let ends = |(lo, hi): &(Laurent, Laurent)| (lo.to_f64(), hi.to_f64());
        Window { h1: ends(h1), h2: ends(h2) }
    }
}

/// A curve 1/T½(h1) = a/h1 + b/h2 within a window: its pieces from left to right.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    pub a: i64,
    pub b: i64,
    pub pieces: Vec<Vec<CurvePoint>>,
}

/// A point of a curve: h1 a double, h2 and θ/π the doubles nearest to the exact values there, so that θ/π =
/// a + b h1/h2 up to 2^-53 (|a| + 2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    pub h1: f64,
    pub h2: f64,
    pub theta_over_pi: f64,
}

/// Working precisions of a point, up to the first that leaves no doubt which doubles are the nearest: beside
/// the fast clock's limit the arcsine loses half of them.
const BITS: [u32; 3] = [96, 192, 384];

/// The most points of all curves together: some gigabytes of rows.
pub(super) const MOST_POINTS: usize = 20_000_000;

/// Steps begin here: below, h2 would leave the doubles of full precision.
const LEAST: f64 = f64::from_bits(64 << 52);

/// The curve (a, b) in the window, with some `samples` points evenly spaced in θ over its pieces there, their
/// ends among them. Empty where it does not pass through the window: for 0 < θ/π < 1 that includes all curves
/// with a = 0, b ≤ 0, with a ≥ 1, b ≥ 0, and with a ≤ −1, b ≤ 0.
///
/// No curve through the window is missing, however small that is. Along h1, h2 = b h1/(θ/π − a) rises where
/// a ≥ 1, falls where a = 0, and where a ≤ −1 rises until g = (π/2) cos(θ/2) (θ/π − a) − sin(θ/2) falls
/// through 0, and falls from there: on each of these branches the part in the window is one interval, whose
/// ends are found by bisection over the doubles h1. Rounding is monotone and the window's ends are doubles,
/// so an exact h2 in the window is also in it when rounded. Where the curve passes the window between two
/// neighbouring doubles, the lower one of them is its point there.
///
/// # Errors
/// Where L1 ≤ 0, or fewer than 2 samples are asked for, or too many.
pub fn curve(a: i64, b: i64, lambda1: &Laurent, window: &Window, samples: usize) -> Result<Curve> {
    if lambda1.sign() != Sign::Positive {
        return Err(Error::input("lambda1", lambda1, "the fast stiffness must be positive"));
    }
    if !(2..=MOST_POINTS).contains(&samples) {
        return Err(Error::input("samples", samples, format!("choose at least 2, at most {MOST_POINTS}")));
    }
    let roots = BITS.map(|bits| lambda1.enclosure(bits).sqrt(bits).expect("lambda1 > 0"));
    let path = Path { a, b, roots };
    let spans = path.spans(window);
    let share = |h1: f64| path.at(h1).map_or(1.0, |point| point.theta_over_pi);
    let ends: Vec<_> = spans.iter().map(|&(first, last)| (share(first), share(last))).collect();
    let length: f64 = ends.iter().map(|(from, to)| to - from).sum();
    let piece = |(span, (from, to)): (&(f64, f64), &(f64, f64))| {
        let part = if length > 0.0 { (to - from) / length } else { 0.0 };
        path.piece(*span, (*from, *to), (part * samples as f64).round().max(2.0) as usize)
    };
    let pieces = spans.iter().zip(&ends).map(piece).filter(|piece| !piece.is_empty()).collect();
    Ok(Curve { a, b, pieces })
}

/// A curve along h1, and √L1.
struct Path {
    a: i64,
    b: i64,
    roots: [Ball; 3],
}

impl Path {
    /// The point at h1; `None` beyond the fast clock's limit, and where h2 is no positive double.
    fn at(&self, h1: f64) -> Option<CurvePoint> {
        let exact = Ball::from_f64(h1)?;
        let within = |bits: u32, root: &Ball| {
            let sine = exact.mul(root, bits).scale2(-1);
            let over_pi = sine.asin(bits)?.scale2(1).div(&Ball::pi(bits), bits)?;
            let is_before_limit = over_pi.compare(&Ball::one()) == Some(Ordering::Less);
            let h2 = exact.mul(&integer(self.b), bits).div(&over_pi.sub(&integer(self.a), bits), bits)?;
            is_before_limit.then_some((h2, over_pi))
        };
        let all = BITS.iter().zip(&self.roots).filter_map(|(&bits, root)| within(bits, root));
        let mut best = None;
        for (h2, over_pi) in all {
            best = Some((h2.mid_f64(), over_pi.mid_f64()));
            if h2.has_nearest_f64() && over_pi.has_nearest_f64() {
                break;
            }
        }
        let (h2, theta_over_pi) = best?;
        (h2 > 0.0 && h2.is_finite()).then_some(CurvePoint { h1, h2, theta_over_pi })
    }

    /// Whether h2 rises with h1, for a ≤ −1: the sign of g. Where 96 bits leave it open, the curve is level
    /// to far below a double.
    fn rises(&self, h1: f64) -> bool {
        let bits = BITS[0];
        let sign = || {
            let h1 = Ball::from_f64(h1)?;
            let sine = h1.mul(&self.roots[0], bits).scale2(-1);
            let over_pi = sine.asin(bits)?.scale2(1).div(&Ball::pi(bits), bits)?;
            let cosine = Ball::one().sub(&sine.square(bits), bits).sqrt_clipped(bits)?;
            let slope = Ball::pi(bits).scale2(-1).mul(&cosine, bits);
            slope.mul(&over_pi.sub(&integer(self.a), bits), bits).sub(&sine, bits).sign()
        };
        sign() == Some(Sign::Positive)
    }

    /// The branches of the curve from `lo` to `hi`: their ends, and whether h2 rises.
    fn branches(&self, lo: f64, hi: f64) -> Vec<(f64, f64, bool)> {
        match (self.a, self.b) {
            (1.., ..0) => vec![(lo, hi, true)],
            (0, 1..) => vec![(lo, hi, false)],
            (..0, 1..) => match last(lo, hi, |h1| self.rises(h1)) {
                None => vec![(lo, hi, false)],
                Some(peak) if peak == hi => vec![(lo, hi, true)],
                Some(peak) => vec![(lo, peak, true), (peak.next_up(), hi, false)],
            },
            _ => Vec::new(),
        }
    }

    /// The intervals of h1 in which the curve lies in the window.
    fn spans(&self, window: &Window) -> Vec<(f64, f64)> {
        let lo = window.h1.0.max(LEAST);
        // The limit 2/√L1 in doubles is right to a unit or two.
        let limit = 2.0 / self.roots[0].mid_f64();
        let hi = last(lo, window.h1.1.min(limit.next_up().next_up()), |h1| self.is_before_limit(h1));
        let mut spans: Vec<(f64, f64)> = Vec::new();
        for branch in hi.map_or_else(Vec::new, |hi| self.branches(lo, hi)) {
            let Some((from, to)) = self.span(branch, window.h2) else { continue };
            match spans.last_mut() {
                Some(before) if before.1.next_up() >= from => before.1 = to,
                _ => spans.push((from, to)),
            }
        }
        spans
    }

    fn is_before_limit(&self, h1: f64) -> bool {
        let (bits, one) = (BITS[2], Ball::one());
        let sine = Ball::from_f64(h1).map(|h1| h1.mul(&self.roots[2], bits).scale2(-1));
        sine.and_then(|sine| sine.compare(&one)) == Some(Ordering::Less)
    }

    /// The part of a branch with h2 in a closed range.
    fn span(&self, (lo, hi, rises): (f64, f64, bool), (low, high): (f64, f64)) -> Option<(f64, f64)> {
        // Without a point h2 is too large for a double, beside the limit of a = 1.
        let h2 = |h1: f64| self.at(h1).map_or(f64::INFINITY, |point| point.h2);
        let (above, below) = (|h1: f64| h2(h1) >= low, |h1: f64| h2(h1) <= high);
        let (outside, inside): (&dyn Fn(f64) -> bool, &dyn Fn(f64) -> bool) =
            if rises { (&|h1| !above(h1), &below) } else { (&|h1| !below(h1), &above) };
        if outside(hi) {
            return None;
        }
        let end = last(lo, hi, inside)?;
        let begin = last(lo, hi, outside).map_or(lo, f64::next_up);
        // Between two neighbours it may come from below the window and be above it.
        Some((begin.min(end), end))
    }

    /// So many points, evenly spaced in θ between the ends, or as many as there are doubles.
    fn piece(&self, (first, last): (f64, f64), (from, to): (f64, f64), count: usize) -> Vec<CurvePoint> {
        let root = self.roots[0].mid_f64();
        let step = |k: usize| match k {
            0 => first,
            _ if k + 1 == count => last,
            _ => {
                let x = from + (to - from) * (k as f64 / (count - 1) as f64);
                (2.0 * (std::f64::consts::FRAC_PI_2 * x).sin() / root).clamp(first, last)
            }
        };
        let mut steps: Vec<f64> = (0..count).map(step).collect();
        steps.sort_by(f64::total_cmp);
        steps.dedup();
        steps.into_iter().filter_map(|h1| self.at(h1)).collect()
    }
}

/// The last double from `lo` to `hi`, both positive, of those at the beginning that are so; by bisection.
fn last(lo: f64, hi: f64, is_so: impl Fn(f64) -> bool) -> Option<f64> {
    if !(lo <= hi && is_so(lo)) {
        return None;
    }
    if is_so(hi) {
        return Some(hi);
    }
    let (mut yes, mut no) = (lo.to_bits(), hi.to_bits());
    while no - yes > 1 {
        let middle = yes + (no - yes) / 2;
        if is_so(f64::from_bits(middle)) { yes = middle } else { no = middle }
    }
    Some(f64::from_bits(yes))
}

fn integer(n: i64) -> Ball {
    Ball::from_integer(&n.into())
}
