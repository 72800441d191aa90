//! The first tier: the half period in Floquet coordinates and doubles, with a proven error bound.
//!
//! Rounding, u = 2^-53, |P| ≤ 1 and every constant of [`Floquet`] as accurate as it says:
//!
//! * σ = r · (1/q): 2u; P: real part 5u · (σ s/2 ≤ 2) + u ≤ 11u, imaginary part 5u, so |δP| ≤ 13u.
//! * x = Re(g P): two products and a difference 2u |g|, P 13u |g|: 15u |g|.
//! * y = β x: β 2u, product u: |δy| ≤ 18u |β| |g|. Adding i y P̄: P 13u, product u: 32u |β| |g|, and the sum
//!   itself u |g'|.
//! * the turn: its own error √2 u and √5 u for the complex product (Brent, Percival, Zimmermann 2007):
//!   3.7u |g|.
//!
//! Together |r_k| ≤ u (6 |û_k| + 34 |β| |û_{k−1}|), with room for terms in u² and for underflow (2^-1074 beside
//! |û| ≥ 2^-100, which the check of τ enforces). The shear g ↦ g + iβ Re(gP) P̄ has the norm
//! κ = |β|/2 + √(1 + β²/4) at most.

use super::bound::StepBound;
use super::floquet::{Floquet, Step};
use super::kind::PartialSigns;
use crate::number::Sign;

/// Half the distance from 1 to the next double.
const U: f64 = f64::EPSILON / 2.0;

/// Updates between two looks at |g| where kicks are weak. Within a block |û| is bounded by its value at the
/// block's end, so that the bound costs one squared norm in four.
const BLOCK: u64 = 4;

/// Above this squared norm an orbit is scaled down, so that no square overflows.
const LARGE: f64 = 1.3407807929942597e154 / 4.0; // 2^510
const SHRINK: f64 = 1.0 / 1.157920892373162e77; // 2^-256

/// One solution on its way through the half period.
#[derive(Clone, Copy, Debug)]
struct Orbit {
    re: f64,
    im: f64,
    /// Σ |û|² over the block ends, from the start on, in the scale of the latest rescaling.
    squares: f64,
    /// The largest `squares/|û|²` at a block's end.
    worst: f64,
    /// The true orbit is 2^exponent times this one.
    exponent: i64,
}

impl Orbit {
    fn new(re: f64, im: f64) -> Self {
        let squares = re * re + im * im;
        Orbit { re, im, squares, worst: 1.0, exponent: 0 }
    }

    fn update(&mut self, step: Step) {
        self.turn(step.turn);
        let [p_re, p_im] = step.p;
        let y = step.beta * (self.re * p_re - self.im * p_im);
        (self.re, self.im) = (self.re + y * p_im, self.im + y * p_re);
    }

    fn turn(&mut self, [c, s]: [f64; 2]) {
        (self.re, self.im) = (self.re * c - self.im * s, self.re * s + self.im * c);
    }

    /// Adds to the sum of squares and compares it with |û|².
    fn end_block(&mut self) {
        let norm2 = self.re * self.re + self.im * self.im;
        self.squares += norm2;
        self.worst = self.worst.max(self.squares / norm2);
        if norm2 > LARGE {
            self.re *= SHRINK;
            self.im *= SHRINK;
            self.squares *= SHRINK * SHRINK;
            self.exponent += 256;
        }
    }

    /// At T/2; `None` where the theorem's conditions did not hold all the way. (NaN fails.)
    fn finish(mut self, floquet: &Floquet, certificate: &Certificate) -> Option<End> {
        let tau = certificate.ratio * self.worst;
        self.turn(floquet.last_turn);
        let end = End {
            x: self.re,
            v: -self.im,
            exponent: self.exponent,
            across: certificate.across * self.squares,
            stretch: certificate.step.length_uncertainty(certificate.steps, tau),
        };
        (tau <= certificate.tau).then_some(end)
    }
}

/// The constants of the certification, all dimensionless.
#[derive(Clone, Copy, Debug)]
struct Certificate {
    step: StepBound,
    steps: u64,
    /// Updates between two looks at |g|.
    block: u64,
    /// The theorem's τ.
    tau: f64,
    /// 2b ≤ `ratio` · `squares/|û_end|²` · |û|² anywhere in a block.
    ratio: f64,
    /// 2b and the error of evaluating a linear form of û are together at most this times `squares`.
    across: f64,
}

impl Certificate {
    fn new(beta: f64, steps: u64) -> Option<Certificate> {
        let beta = beta.abs() * (1.0 + 4.0 * U);
        let kappa = (beta / 2.0 + (1.0 + beta * beta / 4.0).sqrt()) * (1.0 + 8.0 * U);
        let step = StepBound { kappa, epsilon: U * (6.0 * 1.01 * kappa + 34.0 * beta) };
        let tau = step.tau(steps)?;
        // In a block |û_k|² ≤ g^(2 block - 2) |û_end|², and the other way round: a strong kick wants a look
        // after every update.
        let block = if beta < 0.5 { BLOCK } else { 1 };
        let spread = step.growth().powi(2 * (block as i32 - 1));
        // b_k ≤ u (6 + 34 β) Σ |û_j|² (arithmetic and geometric mean), 1.01 for the rounding of the sum
        // itself (at most 10^13 terms) and of these constants.
        let b = 1.01 * U * (6.0 + 34.0 * beta) * block as f64 * spread;
        // |⟨n, û⟩| evaluated with an error of 5u |û|, the turn's own error included.
        let across = 2.0 * b + 5.1 * U;
        let certificate = Certificate { step, steps, block, tau, ratio: 2.0 * b * spread, across };
        (steps < 1 << 43 && spread.is_finite()).then_some(certificate)
    }
}

/// Where the even and the odd solution stand at T/2, with proven bounds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends {
    pub even: End,
    pub odd: End,
}

/// One solution at T/2 in Floquet coordinates: the exact vector is 2^exponent a ((x, v) + t J(x, v)/|(x, v)|²)
/// with |t| ≤ across and |a − 1| ≤ stretch/(1 − stretch).
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    /// Re(g e^{iψ}): the sign of A or B.
    pub x: f64,
    /// −Im(g e^{iψ}): the sign of C or D.
    pub v: f64,
    pub exponent: i64,
    pub across: f64,
    pub stretch: f64,
}

impl End {
    /// The certified signs of x and v.
    fn signs(&self) -> (Option<Sign>, Option<Sign>) {
        let length = (self.x * self.x + self.v * self.v).sqrt();
        let certain = |form: f64| {
            let beyond = form.abs() * length > self.across;
            beyond.then_some(if form > 0.0 { Sign::Positive } else { Sign::Negative })
        };
        (certain(self.x), certain(self.v))
    }
}

impl Ends {
    /// The signs as far as the bounds certify them.
    pub fn signs(&self) -> PartialSigns {
        let ((a, c), (b, d)) = (self.even.signs(), self.odd.signs());
        PartialSigns { a, b, c, d }
    }
}

/// Runs the half period; `None` where the bound's conditions cannot be met (very strong kicks).
pub(super) fn run(floquet: &Floquet) -> Option<Ends> {
    let certificate = Certificate::new(floquet.beta, floquet.updates())?;
    // Even: x = 1, v = 0. Odd: x = 0, v = 1.
    let mut orbits = [Orbit::new(1.0, 0.0), Orbit::new(0.0, -1.0)];
    let last = floquet.updates() - 1;
    for (k, step) in (0..).zip(floquet.steps()) {
        for orbit in &mut orbits {
            orbit.update(step);
            if k % certificate.block == 0 || k == last {
                orbit.end_block();
            }
        }
    }
    let [even, odd] = orbits.map(|orbit| orbit.finish(floquet, &certificate));
    Some(Ends { even: even?, odd: odd? })
}
