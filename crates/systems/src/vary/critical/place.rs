//! Roots of polynomials in s as gaps between neighbouring doubles of the number that s stands for.

use num_bigint::BigInt;
use num_traits::{One, Zero};

use super::polynomials::Critical;
use number::parallel::try_map;
use number::polynomial::{RootInterval, in_unit_interval, sign_at};
use number::rational::simplest;
use number::{Ball, Rational, Result, Sign, from_f64_exact, to_f64};

/// Between `lo` and `hi`, neither of them, lies a place where the verdict can change.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    pub lo: f64,
    pub hi: f64,
    /// That place, where it is rational, of a small denominator or a double, and the only one.
    pub exact: Option<Rational>,
    /// The parts of the system whose polynomials have roots there, increasing, and whether each has but one,
    /// a simple root of one polynomial.
    pub parts: Vec<(usize, bool)>,
}

/// Bits in which signs are sought before they are computed exactly.
const BITS: u32 = 256;

/// The roots of a part's polynomials in \[0, 1\], in no order.
///
/// # Errors
/// Where the work is stopped.
pub(super) fn gaps(
    part: usize,
    polynomials: &[Critical],
    ends: (f64, f64),
    place: &(impl Fn(&Rational) -> Rational + Sync),
) -> Result<Vec<Gap>> {
    let found = try_map(polynomials, |critical| {
        let multiple = roots(&critical.multiple, ends, place);
        let is_simple = |gap: &Gap| multiple.iter().all(|own| own.hi <= gap.lo || gap.hi <= own.lo);
        let all = roots(&critical.simple, ends, place);
        let of_part = |gap: Gap| Gap { parts: vec![(part, is_simple(&gap))], ..gap };
        Ok(all.into_iter().map(of_part).collect::<Vec<_>>())
    })?;
    Ok(found.concat())
}

/// The roots of a squarefree polynomial.
fn roots(f: &[BigInt], ends: (f64, f64), place: &impl Fn(&Rational) -> Rational) -> Vec<Gap> {
    if f.len() < 2 {
        return Vec::new();
    }
    let own = Own { f, balls: f.iter().map(|c| Ball::from_integer(c).round(BITS)).collect() };
    let at_ends = [(ends.0, Rational::zero()), (ends.1, Rational::one())];
    let at_ends = at_ends.into_iter().filter(|(_, s)| own.sign(s) == Sign::Zero).map(|(x, _)| Gap::at(x));
    let inside = in_unit_interval(f.to_vec());
    at_ends.chain(inside.iter().map(|root| own.gap(root, ends, place))).collect()
}

impl Gap {
    fn at(x: f64) -> Gap {
        Gap { lo: x.next_down(), hi: x.next_up(), exact: from_f64_exact(x), parts: Vec::new() }
    }

    /// Whether there is but one place, a simple root of one polynomial.
    pub fn is_simple(&self) -> bool {
        matches!(self.parts[..], [(_, true)])
    }

    /// The double strictly between its ends, where that is the place.
    pub fn double(&self) -> Option<f64> {
        self.exact.as_ref().map(to_f64).filter(|x| self.lo < *x && *x < self.hi)
    }
}

/// Gaps without a double between them as one, increasing.
pub(super) fn united(mut gaps: Vec<Gap>) -> Vec<Gap> {
    gaps.sort_by(|a, b| a.lo.total_cmp(&b.lo).then(a.hi.total_cmp(&b.hi)));
    let mut all: Vec<Gap> = Vec::new();
    for gap in gaps {
        match all.last_mut() {
            Some(last) if gap.lo < last.hi => {
                // A double found twice is still alone.
                let exact = last.exact.take().filter(|x| gap.exact.as_ref() == Some(x));
                let mut parts = std::mem::take(&mut last.parts);
                for (part, is_simple) in gap.parts {
                    match parts.iter_mut().find(|known| known.0 == part) {
                        Some(known) => known.1 = false,
                        None => parts.push((part, is_simple)),
                    }
                }
                parts.sort_unstable();
                *last = Gap { lo: last.lo, hi: last.hi.max(gap.hi), exact, parts };
            }
            _ => all.push(gap),
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

    /// The gap about a root, by bisection down to neighbours.
    fn gap(
        &self,
        (a, b): &RootInterval,
        (mut lo, mut hi): (f64, f64),
        place: &impl Fn(&Rational) -> Rational,
    ) -> Gap {
        let above = self.sign(b);
        loop {
            let middle = lo / 2.0 + hi / 2.0;
            let is_root = |s: &Rational| {
                if a == b { s == a } else { a < s && s < b && self.sign(s) == Sign::Zero }
            };
            if middle <= lo || middle >= hi {
                let [least, most] = [lo, hi].map(|x| from_f64_exact(x).expect("finite"));
                let exact = match lo < 0.0 {
                    true => -simplest(&-most, &-least),
                    false => simplest(&least, &most),
                };
                let exact = Some(exact).filter(|x| is_root(&place(x)));
                return Gap { lo, hi, exact, parts: Vec::new() };
            }
            let s = place(&from_f64_exact(middle).expect("finite"));
            if is_root(&s) {
                return Gap::at(middle);
            }
            let is_below = s <= *a || s < *b && self.sign(&s) != above;
            *(if is_below { &mut lo } else { &mut hi }) = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_lie_between_neighbouring_doubles_or_are_one() {
        let place = |x: &Rational| x / Rational::from_integer(2.into());
        // (8 s² − 1) (4 s − 1) (s − 1), whose 1/4 is double: x = 2 s = 1/√2, 1/2 and 2.
        let f: Vec<BigInt> = [-1, 5, 4, -40, 32].map(BigInt::from).into();
        let f = Critical { simple: f, multiple: [-1, 4].map(BigInt::from).into() };
        let all = united(gaps(0, &[f], (0.0, 2.0), &place).unwrap());
        let [half, root, two] = &all[..] else { panic!("three") };
        let of = |parts: &[(usize, bool)], x: f64| Gap { parts: parts.to_vec(), ..Gap::at(x) };
        assert_eq!((half, two), (&of(&[(0, false)], 0.5), &of(&[(0, true)], 2.0)));
        assert!(root.lo.powi(2) < 0.5 && root.hi.powi(2) > 0.5 && root.hi == root.lo.next_up());
        assert!(root.is_simple() && root.exact.is_none());
        // Twice in one part, and once in each of two.
        let (a, b) = (of(&[(1, true)], 0.7), of(&[(1, true)], 0.8));
        assert_eq!(united(vec![b.clone(), a.clone(), b.clone()]), [a.clone(), of(&[(1, false)], 0.8)]);
        let near = Gap { lo: 0.7, hi: 0.7f64.next_up(), exact: None, parts: vec![(0, true)] };
        assert_eq!(united(vec![near, a]), [Gap { exact: None, ..of(&[(0, true), (1, true)], 0.7) }]);
        // 3 s − 1: x = 2/3 is no double.
        let f = Critical { simple: [-1, 3].map(BigInt::from).into(), multiple: vec![BigInt::one()] };
        let [third] = &gaps(0, &[f], (0.0, 2.0), &place).unwrap()[..] else { panic!("one") };
        assert!(third.exact == Some(Rational::new(2.into(), 3.into())) && third.double().is_none());
    }
}
