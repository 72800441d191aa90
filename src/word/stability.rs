//! Where a word is stable: every interval of s = h² Λ1, its ends exact algebraic numbers.
//!
//! With trace T and denominator q > 0 the powers of the propagator are bounded where |T| < 2 q, and at a zero of T ∓ 2 q iff the
//! propagator is ±I there (B = C = 0). The zeros are isolated by Sturm chains over ℚ(c^(1/n)) and told apart; between
//! them the sign of T² − 4 q² is that at one rational point.

use num_traits::{One, Signed, Zero};

use super::product::Polynomials;
use crate::number::polynomial::Sturm;
use crate::number::{Ball, ExactSign, Polynomial, Radical, Rational, Ring, Sign, rational};

type Poly = Polynomial<Radical>;

/// The relative width to which edges are refined: beyond the 53 bits of doubles, so that their enclosures are neighbours.
const BITS: u32 = 70;

/// An end of a stable interval: a simple zero of a squarefree polynomial in s.
#[derive(Clone, Debug)]
pub struct Edge {
    /// 1 where the trace is 2 there, −1 where it is −2.
    pub side: i8,
    /// The polynomial, monic.
    pub polynomial: Poly,
    /// A closed interval that holds this zero and no other: a point, or one with a change of sign.
    pub ends: (Rational, Rational),
    /// Whether the propagator is ±I there: then the powers are bounded at the edge itself.
    pub coexistence: bool,
}

/// A largest interval of s with one answer.
#[derive(Clone, Debug)]
pub struct Interval {
    /// `None` for 0.
    pub lower: Option<Edge>,
    /// `None` for no end.
    pub upper: Option<Edge>,
    pub stable: bool,
    /// Whether the answer holds at the ends, too.
    pub includes: [bool; 2],
}

/// Every interval of s > 0, stable and unstable in turn.
#[derive(Clone, Debug)]
pub struct Stability {
    pub intervals: Vec<Interval>,
}

impl Edge {
    /// The number, if it is rational: looked for as the simplest number in its interval.
    pub fn rational(&self) -> Option<Rational> {
        let (lo, hi) = &self.ends;
        let simple = rational::simplest(lo, hi);
        let value = self.polynomial.eval(&Radical::from_rational(&simple));
        value.is_zero().then_some(simple)
    }

    /// An enclosure of s.
    pub fn s(&self) -> Ball {
        let [lo, hi] = [&self.ends.0, &self.ends.1].map(|end| Ball::from_rational(end, BITS + 30));
        lo.union(&hi, BITS + 30)
    }

    /// The sign of the number minus x, decided.
    pub fn compare(&self, x: &Rational) -> Sign {
        let (lo, hi) = &self.ends;
        if x < lo || lo == hi {
            return (lo - x).sign();
        }
        if x > hi {
            return Sign::Negative;
        }
        let at = |x: &Rational| sign_at(&self.polynomial, x);
        match at(x) {
            Sign::Zero => Sign::Zero,
            sign if sign == at(lo) => Sign::Positive,
            _ => Sign::Negative,
        }
    }
}

fn sign_at(f: &Poly, x: &Rational) -> Sign {
    f.eval(&Radical::from_rational(x)).sign()
}

/// The zeros s > 0 of f ≠ 0, each within 2^−BITS of its size, with the squarefree part of f.
fn zeros(f: &Poly) -> (Poly, Vec<(Rational, Rational)>) {
    let at_zero = f.coefficients().iter().take_while(|c| c.is_zero()).count();
    let f = Polynomial::new(f.coefficients()[at_zero..].to_vec()).squarefree();
    if f.degree() == Some(0) {
        return (f, Vec::new());
    }
    let refine: Box<dyn Fn(&(Rational, Rational), &Rational) -> (Rational, Rational)>;
    let found = match f.rational() {
        Some(f) => {
            let sturm = Sturm::new(&f);
            let found = sturm.isolate();
            refine = Box::new(move |ends, width| sturm.refine(ends, width));
            found
        }
        None => {
            let sturm = Sturm::over_field(&f);
            let found = sturm.isolate();
            refine = Box::new(move |ends, width| sturm.refine(ends, width));
            found
        }
    };
    let positive = found.into_iter().filter_map(|mut ends| {
        // 0 is no zero of f, so the interval leaves it.
        while !ends.0.is_positive() && ends.1.is_positive() {
            ends = refine(&ends, &((&ends.1 - &ends.0) / Rational::from_integer(4.into())));
        }
        let width = &ends.0 * rational::scale2(&1.into(), -i64::from(BITS));
        ends.0.is_positive().then(|| refine(&ends, &width))
    });
    let positive = positive.collect();
    (f, positive)
}

impl Stability {
    /// Every interval of s > 0. Where a midpoint's force is negative, up to its pole.
    pub fn of(product: &Polynomials) -> Stability {
        let (trace, twice) = (product.trace(), product.denominator.scale(&Radical::from_rational(&Rational::from_integer(2.into()))));
        let sides = [(1, &trace - &twice), (-1, &trace + &twice)];
        let off = product.matrix[(0, 1)].gcd(&product.matrix[(1, 0)]);
        if let Some((side, _)) = sides.iter().find(|(_, f)| f.is_zero()) {
            return Stability::constant(*side, off.is_zero());
        }
        let mut edges: Vec<Edge> = Vec::new();
        for (side, f) in &sides {
            let (polynomial, found) = zeros(f);
            let common = polynomial.gcd(&off);
            let identity = |(lo, hi): &(Rational, Rational)| match (sign_at(&common, lo), sign_at(&common, hi)) {
                (Sign::Zero, _) => lo == hi,
                (below, above) => below != above,
            };
            edges.extend(found.into_iter().map(|ends| Edge {
                side: *side,
                polynomial: polynomial.clone(),
                coexistence: identity(&ends),
                ends,
            }));
        }
        edges.sort_by(|a, b| a.ends.cmp(&b.ends));
        apart(&mut edges);
        let inside = |x: &Rational| sign_at(&sides[0].1, x) == Sign::Negative && sign_at(&sides[1].1, x) == Sign::Positive;
        Stability { intervals: joined(edges, inside) }
    }

    /// The trace is 2 (or −2) whatever s.
    fn constant(_: i8, identity: bool) -> Stability {
        let all = Interval { lower: None, upper: None, stable: identity, includes: [false; 2] };
        Stability { intervals: vec![all] }
    }

    /// The end of the stable interval that begins at 0; `None` where there is no such interval, or it has no end.
    pub fn first_edge(&self) -> Option<&Edge> {
        self.intervals.first().filter(|first| first.stable)?.upper.as_ref()
    }

    /// Whether small steps are stable.
    pub fn begins_stable(&self) -> bool {
        self.intervals.first().is_some_and(|first| first.stable)
    }
}

/// Refines edges until their intervals are apart; they are different numbers, as T cannot be 2 q and −2 q at once.
fn apart(edges: &mut [Edge]) {
    let quarter = Rational::new(1.into(), 4.into());
    for i in 1..edges.len() {
        while edges[i - 1].ends.1 >= edges[i].ends.0 {
            for edge in &mut edges[i - 1..=i] {
                let (lo, hi) = edge.ends.clone();
                let middle = &lo + (&hi - &lo) * &quarter * Rational::from_integer(2.into());
                match edge.compare(&middle) {
                    Sign::Zero => edge.ends = (middle.clone(), middle),
                    Sign::Positive => edge.ends.0 = middle,
                    Sign::Negative => edge.ends.1 = middle,
                }
            }
        }
    }
}

/// The intervals between edges and the edges themselves, those of one answer joined.
fn joined(edges: Vec<Edge>, inside: impl Fn(&Rational) -> bool) -> Vec<Interval> {
    let two = Rational::from_integer(2.into());
    let first = edges.first().map_or_else(Rational::one, |edge| &edge.ends.0 / &two);
    let mut open = Interval { lower: None, upper: None, stable: inside(&first), includes: [false; 2] };
    let mut all = Vec::new();
    for (i, edge) in edges.iter().enumerate() {
        let point = match edges.get(i + 1) {
            Some(next) => (&edge.ends.1 + &next.ends.0) / &two,
            None => &edge.ends.1 + Rational::one(),
        };
        let after = inside(&point);
        if open.stable == edge.coexistence && after == open.stable {
            continue;
        }
        let here = edge.coexistence;
        let end = |interval: Interval| Interval {
            upper: Some(edge.clone()),
            includes: [interval.includes[0], here == interval.stable],
            ..interval
        };
        let begin = |stable: bool| Interval { lower: Some(edge.clone()), upper: None, stable, includes: [here == stable, false] };
        if open.stable == after {
            // A point of the other answer.
            all.push(end(open));
            all.push(Interval { upper: Some(edge.clone()), includes: [true, true], ..begin(here) });
            open = begin(after);
        } else {
            all.push(end(open));
            open = begin(after);
        }
    }
    all.push(open);
    all
}
