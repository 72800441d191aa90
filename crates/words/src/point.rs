//! A word at one step: verdict, growth, frequency, impedance.

use super::product::Polynomials;
use number::{Ball, ExactSign, Laurent, Polynomial, Radical, Real, Ring, Sign};

/// The propagator of one step at s = h² Λ1.
#[derive(Clone, Debug)]
pub struct At {
    /// `elliptic`, `hyperbolic`, `parabolic` or `coexistence`, decided; with friction also `damped`, both
    /// eigenvalues inside the unit circle, and `marginal`, one on it; `edge` where balls cannot decide it.
    pub kind: &'static str,
    /// 1 where the trace is at least 2, −1 where it is at most −2, else 0.
    pub side: i8,
    pub trace: Ball,
    /// ln μ a step, where the word is hyperbolic.
    pub ln_multiplier: Option<Ball>,
    /// θ in (0, π) a step, where it is elliptic.
    pub angle: Option<Ball>,
    /// √(−C/B), in 1/h, where it is elliptic and A = D.
    pub impedance: Option<Ball>,
}

impl At {
    /// Whether the powers are bounded; with friction, whether they fall to 0.
    pub fn is_stable(&self) -> bool {
        matches!(self.kind, "elliptic" | "coexistence" | "damped")
    }
}

/// The bits of what is enclosed: beyond the 53 of doubles.
const BITS: u32 = 96;

type Poly = Polynomial<Radical>;

/// The sign of f(s): exact in ℚ(c^(1/n)) for a rational s. Any other s of ℚ\[π, 1/π\] is transcendental over
/// that field, so that f(s) is not 0 unless f is, and balls decide.
fn sign(f: &Poly, s: &Laurent) -> Sign {
    match s.as_rational() {
        Some(s) => f.eval(&Radical::from_rational(&s)).sign(),
        None if f.degree().is_none() => Sign::Zero,
        None => value(f, s, BITS).sign().expect("a ball with correct bits of a number that is not 0"),
    }
}

/// f(s) with about so many correct bits; f(s) is not 0, or s is rational.
fn value(f: &Poly, s: &Laurent, bits: u32) -> Ball {
    if let Some(s) = s.as_rational() {
        return f.eval(&Radical::from_rational(&s)).enclosure(bits);
    }
    let mut working = bits + 32;
    loop {
        let (s, zero) = (s.enclosure(working), Ball::zero());
        let horner = |sum: Ball, c: &Radical| sum.mul(&s, working).add(&c.enclosure(working), working);
        let ball = f.coefficients().iter().rev().fold(zero, horner);
        if f.degree().is_none() || ball.relative_accuracy_bits() > i64::from(bits) {
            return ball;
        }
        working *= 2;
    }
}

/// The word at s > 0; `None` at a pole of a midpoint whose force is negative.
pub fn at(product: &Polynomials, s: &Laurent) -> Option<At> {
    let [a, b, c, d] = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|at| &product.matrix[at]);
    let (trace, q) = (product.trace(), &product.denominator);
    // The sign of the denominator turns both sides.
    let turned = match sign(q, s) {
        Sign::Zero => return None,
        Sign::Positive => Radical::from_rational(&number::rational::ratio(1, 1)),
        Sign::Negative => Radical::from_rational(&number::rational::ratio(-1, 1)),
    };
    let (trace, q) = (trace.scale(&turned), q.scale(&turned));
    let twice = &q + &q;
    let (above, below) = (&trace - &twice, &trace + &twice);
    let of = |f: &Poly| value(f, s, BITS);
    let over = |x: &Ball, by: &Ball| x.div(by, BITS).expect("not 0, with correct bits");
    let denominator = of(&q);
    let mut found = At {
        kind: "elliptic",
        side: 0,
        trace: over(&of(&trace), &denominator),
        ln_multiplier: None,
        angle: None,
        impedance: None,
    };
    let (side, excess) = match (sign(&above, s), sign(&below, s)) {
        (Sign::Negative, Sign::Positive) => {
            found.angle = over(&of(&trace), &of(&twice)).acos(BITS);
            if a == d {
                found.impedance = over(&of(&-c), &of(b)).sqrt(BITS);
            }
            return Some(found);
        }
        (Sign::Zero, _) | (_, Sign::Zero) => {
            let identity = [b, c].iter().all(|f| sign(f, s) == Sign::Zero);
            found.kind = if identity { "coexistence" } else { "parabolic" };
            found.side = if sign(&above, s) == Sign::Zero { 1 } else { -1 };
            return Some(found);
        }
        (Sign::Positive, _) => (1, above),
        _ => (-1, -&below),
    };
    // |Tr| − 2 = 4 sinh²(ln μ / 2), without cancellation at |Tr| = 2.
    let root = over(&of(&excess), &denominator).scale2(-2).sqrt(BITS);
    (found.kind, found.side) = ("hyperbolic", side);
    found.ln_multiplier = root.map(|root| root.asinh(BITS).scale2(1));
    Some(found)
}
