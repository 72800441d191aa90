//! Sectors of a tongue: between two first steps, for all ratios of a range (proofs/BANDS.md, "Between two
//! steps").

use super::frame::{Base, Frame};
use super::taylor::Taylor;
use crate::propagator::Oscillator;
use crate::verdict::{Limits, decide};
use number::parallel::go_on;
use number::{Ball, Laurent, Rational, Result, U, rational};

/// h2/h1 = p/q.
pub type Ratio = (u64, u64);

/// h1 at either end of a range of ratios in units of [`Sector::decimals`], affine in the ratio between them.
pub type Line = [i64; 2];

/// Frames are tried for families |a| ≤ this.
const FAMILIES: i64 = 8;

/// Beyond this distortion the coordinates that no angle enters are tried, too: where kicks are strong,
/// turning frames are not near 1.
const STRONG: f64 = 0.3;

/// Bits of areas.
const BITS: u32 = 128;

/// All (h1, h2) with from ≤ h2/h1 ≤ to and lower ≤ h1 ≤ upper, both affine in h2/h1: every ratio there is
/// unstable, rational or not.
///
/// It is a part of the tongue of the paper's curve (a, b): the growing solution of a rational ratio p/q makes
/// a p + b q half turns a period.
#[derive(Clone, Debug, PartialEq)]
pub struct Sector {
    /// a and b.
    pub family: [i64; 2],
    /// The ratios h2/h1 between which it is, as (p, q).
    pub ratios: [Ratio; 2],
    /// h1 at both ratios, on the lower and on the upper side, in units of 10^-`decimals`.
    pub sides: [Line; 2],
    /// The decimal digits of steps behind the point.
    pub decimals: i32,
}

impl Sector {
    /// h1 on the lower and on the upper side at a ratio between its ends, exactly.
    pub fn sides_at(&self, ratio: &Rational) -> [Rational; 2] {
        let [from, to] = self.ratios.map(exact);
        let share = (ratio - &from) / (&to - &from);
        self.sides.map(|side| {
            let [first, last] = side.map(|n| step(n, self.decimals));
            &first + &share * (&last - &first)
        })
    }

    /// Its area in the plane of steps, (to − from) ((c² + c d + d²) − (a² + a b + b²))/6 with a, b on the
    /// lower side and c, d on the upper one: enclosed.
    pub fn area(&self) -> Ball {
        // Below 3 · 10^36.
        let of = |[a, b]: Line| {
            [(a, a), (a, b), (b, b)].map(|(x, y)| i128::from(x) * i128::from(y)).iter().sum::<i128>()
        };
        let [lower, upper] = self.sides.map(of);
        let [from, to] = self.ratios.map(exact);
        let unit = step(1, self.decimals);
        let exact = (to - from) * Rational::from_integer((upper - lower).into()) * &unit * &unit;
        Ball::from_rational(&(exact / Rational::from_integer(6.into())), BITS)
    }
}

/// n 10^-`decimals`.
pub fn step(n: i64, decimals: i32) -> Rational {
    Rational::from_integer(n.into()) * Rational::from_integer(10.into()).pow(-decimals)
}

fn exact((p, q): Ratio) -> Rational {
    Rational::new(p.into(), q.into())
}

/// p/q in doubles.
pub fn value((p, q): Ratio) -> f64 {
    p as f64 / q as f64
}

/// [`Sector::area`] in doubles, rounded.
pub fn area(ratios: [Ratio; 2], [lower, upper]: [[f64; 2]; 2]) -> f64 {
    let [from, to] = ratios.map(value);
    let of = |[a, b]: [f64; 2]| a * a + a * b + b * b;
    (to - from) * (of(upper) - of(lower)) / 6.0
}

/// The way that a line is proven: the clock that the other one is followed by, and whether its frame turns.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    base: usize,
    turns: bool,
}

impl Way {
    /// In a frame that turns, and in one that does not.
    fn both(base: usize) -> [Way; 2] {
        [Way { base, turns: true }, Way { base, turns: false }]
    }

    pub fn all() -> impl Iterator<Item = Way> {
        [0, 1].into_iter().flat_map(Way::both)
    }
}

/// Ways to prove lines of sectors, and labels at their ends.
#[derive(Clone, Debug)]
pub struct Prover {
    lambdas: [Laurent; 2],
    bases: [Base; 2],
    /// Of all steps, and the double nearest to 10^-this.
    decimals: i32,
    unit: f64,
}

impl Prover {
    pub fn new(lambdas: [Laurent; 2], bases: [Base; 2], decimals: i32) -> Self {
        Prover { lambdas, bases, decimals, unit: rational::to_f64(&step(1, decimals)) }
    }

    /// A way in which every ratio on a line is unstable, by a cone that is the same, or moves continuously,
    /// for all of them: so the tongue is the same, too. `known` is the only way that is tried, where there is
    /// one.
    pub fn prove(&self, family: [i64; 2], ratios: [Ratio; 2], line: Line, known: Option<Way>) -> Option<Way> {
        if !self.unit.is_normal() {
            return None;
        }
        let [(p, q), (r, s)] = ratios.map(|(p, q)| (p as i64, q as i64));
        let [from, to] = ratios.map(value);
        // A quotient is within U of its double, a whole number below 2^53 times the unit within 2 U, their
        // mean and half their difference within 3 U each.
        let affine = |[first, last]: [f64; 2]| {
            let off = 8.0 * U * first.abs().max(last.abs());
            Taylor::constant(0.5 * (first + last), off).with_slope(0.5 * (last - first))
        };
        let (ratio, h1) = (affine([from, to]), affine(line.map(|n| n as f64 * self.unit)));
        let steps = [h1, h1.times(&ratio)];
        let (taus, ranges) = ([Some(ratio), ratio.reciprocal()], [[(p, q), (r, s)], [(s, r), (q, p)]]);
        let frame = |base: usize| Frame::new(&steps[base], &steps[1 - base], &taus[base]?, &self.bases[base]);
        let proves = |way: Way, frame: &Frame| {
            let a = family[way.base];
            if way.turns {
                a.abs() <= FAMILIES && frame.proves(Some(a), ranges[way.base], 0)
            } else {
                frame.distortion() > STRONG && frame.proves(None, ranges[way.base], 0)
            }
        };
        if let Some(way) = known {
            return proves(way, &frame(way.base)?).then_some(way);
        }
        // Followed by the clock that the other one distorts less.
        let frames = [frame(0), frame(1)];
        let distortion = |base: usize| frames[base].as_ref().map_or(f64::INFINITY, Frame::distortion);
        let base = usize::from(distortion(1) < distortion(0));
        let frame = frames[base].as_ref()?;
        Way::both(base).into_iter().find(|way| proves(*way, frame))
    }

    /// Whether both ends of a line are proven to be in the tongue of the family.
    ///
    /// # Errors
    /// Where the work was stopped.
    pub fn is_in_tongue(&self, [a, b]: [i64; 2], ratios: [Ratio; 2], line: Line) -> Result<bool> {
        for ((p, q), n) in ratios.into_iter().zip(line) {
            go_on()?;
            let h1 = step(n, self.decimals);
            let h2 = &h1 * exact((p, q));
            let ([first, second], [h1, h2]) = (self.lambdas.clone(), [h1, h2].map(Laurent::from_rational));
            let label = Oscillator::new(first, second, h1, h2)
                .and_then(|oscillator| oscillator.clocks())
                .and_then(|clocks| decide(&clocks, &Limits::default())?.label());
            let expected = i128::from(a) * i128::from(p) + i128::from(b) * i128::from(q);
            if !matches!(label, Ok(Some(m)) if i128::from(m) == expected) {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
