//! Roots of polynomials as gaps between neighbouring doubles, and the stretches of one verdict between them.

use num_bigint::BigInt;
use num_traits::{One, Zero};

use crate::error::Result;
use crate::number::polynomial::{RootInterval, in_unit_interval, primitive, quotient, sign_at, squarefree};
use crate::number::rational::{from_f64_exact, ratio, simplest, to_f64};
use crate::number::{Ball, Rational, Sign};
use crate::parallel::try_map;
use crate::system::vary::stretches::Stretch;
use crate::system::verdict::measured::Holds;

/// Between `lo` and `hi`, neither of them, lies a place where the verdict can change.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Gap {
    pub lo: f64,
    pub hi: f64,
    /// That place, where it is rational, of a small denominator or a double, and the only one.
    pub exact: Option<Rational>,
    /// Whether there is but one place, a simple root of one polynomial.
    pub is_simple: bool,
}

impl Gap {
    fn at(x: f64) -> Gap {
        Gap { lo: x.next_down(), hi: x.next_up(), exact: from_f64_exact(x), is_simple: true }
    }

    /// The double strictly between its ends, where that is the place.
    fn double(&self) -> Option<f64> {
        self.exact.as_ref().map(to_f64).filter(|x| self.lo < *x && *x < self.hi)
    }
}

/// Bits in which signs are sought before they are computed exactly.
const BITS: u32 = 256;

/// The gaps of all real roots in \[0, 1\] of polynomials in s, increasing; `place` takes a number to its s, an increasing map of
/// \[0, top\] onto \[0, 1\].
///
/// # Errors
/// Where the work is stopped.
pub(super) fn gaps(
    polynomials: &[Vec<BigInt>],
    top: f64,
    place: &(impl Fn(&Rational) -> Rational + Sync),
) -> Result<Vec<Gap>> {
    let found = try_map(polynomials, |own| {
        let simple = squarefree(own);
        let rest = quotient(&primitive(own.to_vec()), &simple).expect("a divisor");
        let multiple = roots(&squarefree(&rest), top, place);
        let mut all = roots(&simple, top, place);
        for gap in &mut all {
            gap.is_simple = multiple.iter().all(|own| own.hi <= gap.lo || gap.hi <= own.lo);
        }
        Ok(all)
    })?;
    Ok(united(found.concat()))
}

/// The roots of a squarefree polynomial.
fn roots(f: &[BigInt], top: f64, place: &impl Fn(&Rational) -> Rational) -> Vec<Gap> {
    if f.len() < 2 {
        return Vec::new();
    }
    let own = Own { f, balls: f.iter().map(|c| Ball::from_integer(c).round(BITS)).collect() };
    let at_ends = [(0.0, Rational::zero()), (top, Rational::one())];
    let at_ends = at_ends.into_iter().filter(|(_, s)| own.sign(s) == Sign::Zero).map(|(x, _)| Gap::at(x));
    let inside = in_unit_interval(f.to_vec());
    at_ends.chain(inside.iter().map(|root| own.gap(root, top, place))).collect()
}

/// Gaps without a double between them as one, increasing.
fn united(mut gaps: Vec<Gap>) -> Vec<Gap> {
    gaps.sort_by(|a, b| a.lo.total_cmp(&b.lo).then(a.hi.total_cmp(&b.hi)));
    let mut all: Vec<Gap> = Vec::new();
    for own in gaps {
        match all.last_mut() {
            Some(last) if own.lo < last.hi => {
                // A double found twice is still alone.
                let exact = last.exact.take().filter(|x| own.exact.as_ref() == Some(x));
                *last = Gap { lo: last.lo, hi: last.hi.max(own.hi), exact, is_simple: false };
            }
            _ => all.push(own),
        }
    }
    all
}

struct Own<'a> {
    f: &'a [BigInt],
    /// Its coefficients, rounded.
    balls: Vec<Ball>,
}

impl Own<'_> {
    fn sign(&self, s: &Rational) -> Sign {
        let s_ball = Ball::from_rational(s, BITS);
        let value = self.balls.iter().rev().fold(Ball::zero(), |sum, c| sum.mul(&s_ball, BITS).add(c, BITS));
        value.sign().unwrap_or_else(|| sign_at(self.f, s))
    }

    /// The gap about a root, by bisection of \[0, top\] down to neighbours.
    fn gap(&self, (a, b): &RootInterval, top: f64, place: &impl Fn(&Rational) -> Rational) -> Gap {
        let (mut lo, mut hi) = (0.0, top);
        let above = self.sign(b);
        loop {
            let middle = lo / 2.0 + hi / 2.0;
            let is_root = |s: &Rational| {
                if a == b { s == a } else { a < s && s < b && self.sign(s) == Sign::Zero }
            };
            if middle <= lo || middle >= hi {
                let found = Some(simplest(&exact(lo), &exact(hi))).filter(|x| is_root(&place(x)));
                return Gap { lo, hi, exact: found, is_simple: true };
            }
            let s = place(&exact(middle));
            if is_root(&s) {
                return Gap::at(middle);
            }
            let is_below = s <= *a || s < *b && self.sign(&s) != above;
            *(if is_below { &mut lo } else { &mut hi }) = middle;
        }
    }
}

/// The stretches between gaps, each decided at one number. A gap between two stretches of one verdict is of it where `is_crossed` says so.
pub(super) fn between(
    (lo, hi): (f64, f64),
    gaps: &[Gap],
    verdict: &impl Fn(&Rational) -> Result<Holds>,
    is_crossed: &impl Fn(&Gap, Holds) -> bool,
) -> Result<Vec<Stretch>> {
    let free = |lo: f64, hi: f64| -> Result<Option<Stretch>> {
        let sample = || if lo == hi { exact(lo) } else { inside(lo, hi) };
        (lo <= hi).then(|| Ok(Stretch { lo, hi, verdict: verdict(&sample())? })).transpose()
    };
    let mut found: Vec<Stretch> = Vec::new();
    let mut at = lo;
    for gap in gaps {
        found.extend(free(at, gap.lo)?);
        if let Some(x) = gap.double() {
            found.extend(free(x, x)?);
        }
        at = gap.hi;
    }
    found.extend(free(at, hi)?);
    let mut all: Vec<Stretch> = Vec::new();
    for own in found {
        let Some(last) = all.last().filter(|last| last.verdict == own.verdict).copied() else {
            all.push(own);
            continue;
        };
        // Two doubles without one between them: either a gap lies there, or nothing can change.
        let gap = gaps.iter().find(|gap| gap.double().is_none() && gap.lo == last.hi);
        let holds = |gap: &Gap| match &gap.exact {
            Some(x) => Ok(verdict(x)? == own.verdict),
            None => Ok(is_crossed(gap, own.verdict)),
        };
        if gap.map_or(Ok(true), holds)? {
            all.last_mut().expect("just seen").hi = own.hi;
        } else {
            all.extend([Stretch { lo: last.hi, hi: own.lo, verdict: Holds::NotTold }, own]);
        }
    }
    Ok(all)
}

/// A number well within (lo, hi), lo ≥ 0, of small denominator where it can be.
fn inside(lo: f64, hi: f64) -> Rational {
    let (a, b) = (exact(lo), exact(hi));
    let part = |k: i64| &a + (&b - &a) * ratio(k, 4);
    simplest(&part(1), &part(3))
}

fn exact(x: f64) -> Rational {
    from_f64_exact(x).expect("a finite end of a range")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_lie_between_neighbouring_doubles_or_are_one() {
        let place = |x: &Rational| x / Rational::from_integer(2.into());
        // (8 s² − 1) (4 s − 1)² (s − 1): x = 2 s = 1/√2, 1/2 and 2.
        let f: Vec<BigInt> = [1, -9, 16, 56, -192, 128].map(BigInt::from).into();
        let all = gaps(&[f], 2.0, &place).unwrap();
        let [half, root, two] = &all[..] else { panic!("three: {all:?}") };
        assert_eq!((half, two), (&Gap { is_simple: false, ..Gap::at(0.5) }, &Gap::at(2.0)));
        assert!(root.lo.powi(2) < 0.5 && root.hi.powi(2) > 0.5 && root.hi == root.lo.next_up());
        assert!(root.is_simple && root.exact.is_none());
        // Once in each of two.
        assert_eq!(united(vec![Gap::at(0.8), Gap::at(0.7), Gap::at(0.8)]).len(), 2);
        // 3 s − 1: x = 2/3 is no double.
        let third = &gaps(&[[-1, 3].map(BigInt::from).into()], 2.0, &place).unwrap()[0];
        assert!(third.exact == Some(Rational::new(2.into(), 3.into())) && third.double().is_none());
    }
}
