//! Where a word is stable: every interval of s = h² Λ1, its ends exact algebraic numbers.
//!
//! With trace T and denominator q the powers of the propagator are bounded where |T| < 2 |q|, and at a zero
//! of T ∓ 2 q iff the propagator is ±I there (B = C = 0). The zeros are isolated by Sturm chains over
//! ℚ(c^(1/n)) and separated; between them the sign of T² − 4 q² is that at one rational point.

use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};

use super::product::Polynomials;
use number::polynomial::{self, Sturm};
use number::{Ball, ExactSign, Polynomial, Radical, Rational, Ring, Sign, rational};

type Poly = Polynomial<Radical>;

/// The relative width to which edges are refined: beyond the 53 bits of doubles, so that their enclosures are
/// neighbours.
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

    /// Halves the interval about it.
    fn halve(&mut self) {
        let (lo, hi) = &self.ends;
        let middle = (lo + hi) / Rational::from_integer(2.into());
        match self.compare(&middle) {
            Sign::Zero => self.ends = (middle.clone(), middle),
            Sign::Positive => self.ends.0 = middle,
            Sign::Negative => self.ends.1 = middle,
        }
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

/// The zeros s > 0 of a polynomial.
struct Zeros {
    /// Its squarefree part.
    squarefree: Poly,
    /// The quotient of both: its zeros are the repeated ones.
    repeated: Poly,
    /// Each zero within 2^−BITS of its size.
    all: Vec<(Rational, Rational)>,
}

/// The zeros s > 0 of f ≠ 0: over ℚ by Descartes' rule, which has no remainders that grow, else by Sturm's
/// chain.
fn zeros(f: &Poly) -> Zeros {
    let at_zero = f.coefficients().iter().take_while(|c| c.is_zero()).count();
    let f = Polynomial::new(f.coefficients()[at_zero..].to_vec());
    if f.degree() == Some(0) {
        return Zeros { squarefree: Poly::one(), repeated: f, all: Vec::new() };
    }
    let sturm = |f: &Poly| {
        let squarefree = f.squarefree();
        let repeated = f.div_rem(&squarefree).map_or_else(Poly::one, |(quotient, _)| quotient);
        // 0 is no zero of f, so the positive ones begin somewhere.
        let chain = Sturm::over_field(&squarefree);
        let found = chain.isolate().into_iter().filter_map(|mut ends| {
            while !ends.0.is_positive() && ends.1.is_positive() {
                ends = chain.refine(&ends, &((&ends.1 - &ends.0) / Rational::from_integer(4.into())));
            }
            ends.0.is_positive().then_some(ends)
        });
        let found = found.collect();
        Zeros { squarefree, repeated, all: found }
    };
    let descartes = |f: &Polynomial<Rational>| {
        let f = f.primitive();
        let whole: Vec<BigInt> = f.coefficients().iter().map(Rational::to_integer).collect();
        let simple = polynomial::squarefree(&whole);
        let repeated = polynomial::quotient(&whole, &simple).expect("its squarefree part divides it");
        let turned = Polynomial::new(f.coefficients().iter().rev().cloned().collect());
        let found = polynomial::roots_within(&simple, &turned.root_bound().recip(), &f.root_bound());
        let over = |f: &[BigInt]| {
            Polynomial::new(
                f.iter().map(|c| Radical::from_rational(&Rational::from_integer(c.clone()))).collect(),
            )
        };
        Zeros { squarefree: over(&simple), repeated: over(&repeated), all: found }
    };
    let mut zeros = f.rational().map_or_else(|| sturm(&f), |f| descartes(&f));
    let squarefree = zeros.squarefree.clone();
    zeros.all.iter_mut().for_each(|ends| {
        let below = sign_at(&squarefree, &ends.0);
        while &ends.1 - &ends.0 > &ends.0 * rational::scale2(&1.into(), -i64::from(BITS)) {
            let middle = (&ends.0 + &ends.1) / Rational::from_integer(2.into());
            match sign_at(&squarefree, &middle) {
                Sign::Zero => *ends = (middle.clone(), middle),
                sign if sign == below => ends.0 = middle,
                _ => ends.1 = middle,
            }
        }
    });
    zeros
}

/// The sign of f(x): in integers where f has rational coefficients.
fn sign_at(f: &Poly, x: &Rational) -> Sign {
    let whole = |c: &Radical| c.as_rational().filter(Rational::is_integer).map(|c| c.to_integer());
    match f.coefficients().iter().map(whole).collect::<Option<Vec<BigInt>>>() {
        Some(whole) => polynomial::sign_at(&whole, x),
        None => f.eval(&Radical::from_rational(x)).sign(),
    }
}

impl Stability {
    /// Every interval of s > 0. Where a midpoint's force is negative, its poles lie in unstable intervals.
    pub fn of(product: &Polynomials) -> Stability {
        let (trace, twice) = (
            product.trace(),
            product.denominator.scale(&Radical::from_rational(&Rational::from_integer(2.into()))),
        );
        let mut sides = [(1, &trace - &twice), (-1, &trace + &twice)];
        // A zero of both is one of q and of T: a pole of a midpoint that the word cancels.
        if product.denominator.degree() > Some(0) {
            let common = sides[0].1.gcd(&sides[1].1);
            sides
                .iter_mut()
                .for_each(|(_, f)| *f = f.div_rem(&common).map_or_else(Poly::zero, |(quotient, _)| quotient));
        }
        let off = [&product.matrix[(0, 1)], &product.matrix[(1, 0)]];
        if sides.iter().any(|(_, f)| f.is_zero()) {
            let identity = off.iter().all(|f| f.is_zero());
            let all = Interval { lower: None, upper: None, stable: identity, includes: [false; 2] };
            return Stability { intervals: vec![all] };
        }
        // In integers, where they are rational: signs are found faster so, and a positive factor does not
        // change them.
        let sides = sides
            .map(|(side, f)| (side, f.rational().map_or(f, |f| f.primitive().map(Radical::from_rational))));
        let mut edges: Vec<Edge> = Vec::new();
        for (side, f) in &sides {
            let Zeros { squarefree, repeated, all } = zeros(f);
            // tr(X) = 0 for X in the tangent space at ±I, so the trace has a repeated zero there.
            let common = off
                .iter()
                .fold(repeated, |common, f| if common.degree() > Some(0) { common.gcd(f) } else { common });
            let common = common.squarefree();
            let identity =
                |(lo, hi): &(Rational, Rational)| match (sign_at(&common, lo), sign_at(&common, hi)) {
                    (Sign::Zero, _) => lo == hi,
                    (below, above) => below != above,
                };
            edges.extend(all.into_iter().map(|ends| Edge {
                side: *side,
                polynomial: squarefree.clone(),
                coexistence: identity(&ends),
                ends,
            }));
        }
        apart(&mut edges);
        let inside = |x: &Rational| sign_at(&sides[0].1, x) * sign_at(&sides[1].1, x) == Sign::Negative;
        Stability { intervals: joined(edges, inside) }
    }

    /// The end of the stable interval that begins at 0; `None` where there is no such interval, or it has no
    /// end.
    pub fn first_edge(&self) -> Option<&Edge> {
        self.intervals.first().filter(|first| first.stable)?.upper.as_ref()
    }

    /// The first edge when unstable intervals below 2^-30 of their size do not count: published decimals open
    /// such intervals where exact coefficients have a touching of ±2.
    pub fn nominal_edge(&self) -> Option<&Edge> {
        let narrow = |gap: &Interval| {
            let (Some(lower), Some(upper)) = (&gap.lower, &gap.upper) else { return false };
            &upper.ends.1 - &lower.ends.0 < &lower.ends.0 * rational::scale2(&1.into(), -30)
        };
        let mut edge = self.first_edge()?;
        for pair in self.intervals[1..].chunks(2) {
            match pair {
                [gap, stable] if narrow(gap) => edge = stable.upper.as_ref()?,
                _ => break,
            }
        }
        Some(edge)
    }

    /// Whether small steps are stable.
    pub fn begins_stable(&self) -> bool {
        self.intervals.first().is_some_and(|first| first.stable)
    }
}

/// Refines edges until their intervals are apart, and sorts them; they are different numbers, as the two
/// polynomials have no common zero.
fn apart(edges: &mut [Edge]) {
    loop {
        edges.sort_by(|a, b| a.ends.cmp(&b.ends));
        let Some(i) = edges.windows(2).position(|pair| pair[0].ends.1 >= pair[1].ends.0) else { return };
        edges[i..=i + 1].iter_mut().for_each(Edge::halve);
    }
}

/// The simplest number in the middle half of (lo, hi), whose ends may be zeros.
fn between(lo: &Rational, hi: &Rational) -> Rational {
    let quarter = (hi - lo) / Rational::from_integer(4.into());
    rational::simplest(&(lo + &quarter), &(hi - &quarter))
}

/// The intervals between edges and the edges themselves, those of one answer joined.
fn joined(edges: Vec<Edge>, inside: impl Fn(&Rational) -> bool) -> Vec<Interval> {
    let first = edges.first().map_or_else(Rational::one, |edge| between(&Rational::zero(), &edge.ends.0));
    let mut open = Interval { lower: None, upper: None, stable: inside(&first), includes: [false; 2] };
    let mut all = Vec::new();
    for (i, edge) in edges.iter().enumerate() {
        let point = match edges.get(i + 1) {
            Some(next) => between(&edge.ends.1, &next.ends.0),
            None => (&edge.ends.1 + Rational::one()).ceil(),
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
        let begin = |stable: bool| Interval {
            lower: Some(edge.clone()),
            upper: None,
            stable,
            includes: [here == stable, false],
        };
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
