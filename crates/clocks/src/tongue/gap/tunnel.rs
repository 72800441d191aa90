//! How far apart two edges are that doubles see as one point: by tunnelling.
//!
//! The two problems X and Y of a tongue differ at both ends of the string: where one is free the other is
//! pinned. A mode that lives far from the ends hardly feels that, and the little it feels is the width of the
//! tongue. It needs no digits of the edges themselves.
//!
//! **The width, exactly.** Run the recurrence (x, v): v −= κ m x at a mass, x += v ℓ along a spring, from the
//! left end and, mirrored, from the right end to a node r, short of its mass: (x, v) and (y, w). With
//!
//! ```text
//!     F(κ) = v/x + w/y - κ m_r,        F = 0 at the problem's eigenvalues, where x, y ≠ 0,
//!     F'   = -Z,   Z = Σ m x_j²/x² + Σ m y_j²/y² + m_r     (sums over the nodes on either side of r),
//! ```
//!
//! because v ∂x/∂κ − x ∂v/∂κ = Σ m x_j². All steps have determinant 1, so the free and the pinned start of
//! one end keep x_free v_pinned − v_free x_pinned = 1, and with the sign + at an end where X is free, − where
//! it is pinned,
//!
//! ```text
//!     Δ = F_Y - F_X = ± 1/(x_X x_Y) ± 1/(y_X y_Y).
//! ```
//!
//! F_Y(κ_Y) = 0, so F_X(κ_Y) = −Δ(κ_Y), and by the mean value theorem κ_Y − κ_X = Δ(κ_Y)/Z_X(ξ), ξ between
//! the two. Both sums have positive terms and Δ is a product for each end: where its two terms do not cancel,
//! all is known in doubles to many digits over the whole interval that holds κ_X and κ_Y, however narrow the
//! tongue.
//!
//! The orbits are followed in doubles, or in two doubles each over an interval that is narrower by as much:
//! where kicks are 1e12 strong an error of 1e-16 in x is one of 1e-4 in v.
//!
//! **Roundings** and the interval's width are local errors r_k of the computed orbit û, bounded by theorems
//! `perturbed_orbit_stepwise` and `shear_turn` in proofs/. With ‖M_k‖ ≤ κ_k, b_k = Σ |r_j| |û_j| and τ_k = 2
//! b_k/|û_k|², let
//!
//! ```text
//!     w_k = Σ (|r_j| + κ_j τ_{j-1} |û_{j-1}|)/|û_j|,     c_k = Σ |r_j|/|û_{j-1}|,     w_n + c_n <= 1/2.
//! ```
//!
//! Then u_k = a_k (û_k + (t_k/|û_k|²) J û_k), J the rotation by a right angle, |t_k| ≤ 2 b_k and 1 − w_k ≤
//! a_k ≤ 1/(1 − w_k).

use crate::tongue::string::lanes::{logarithm, rescaling};
use crate::tongue::string::{Digits, Entry, HalfString, KINDS, Step};
use number::U;

/// √2, rounded up: |x| + |v| is at most this times the vector's length.
const ROOT_TWO: f64 = 1.4143;

/// No orbit is used where w + c of the module's theorem, or the relative error of x, exceeds this: below it
/// |ln(1 ± t)| ≤ 1.03 t, and four such errors of the logarithm change a number by no more than 1.3 times their sum.
const LARGEST_STRAIN: f64 = 0.05;

/// A term of Δ below this power of two of the other is only bounded.
const FAINT: i64 = -400;

/// Powers of two beyond this are taken in two factors, and below its double make nothing of any number met
/// here.
const RANGE: i64 = 900;

/// Two edges separated.
pub struct Apart {
    /// Whether s_X < s_Y, else s_X > s_Y.
    pub in_order: bool,
    /// |s_Y − s_X|, enclosed: by doubles that are not normal where it is too small.
    pub width: (f64, f64),
}

/// s_Y − s_X, for the edge X whose string is free at t = 0 and the edge Y whose string is pinned there; both
/// lie in `between`, which is narrow, else the enclosure is poor. `None` where nothing is proven.
pub fn splitting<D: Digits>(string: &HalfString, free: Entry, between: [D; 2]) -> Option<Apart> {
    debug_assert!(free.starts_free());
    let tunnel = Tunnel::new(string, between);
    let ends_free = free.ends_free();
    let from_left: Vec<Orbit<D>> = tunnel.orbit(&string.forward, true).collect();
    let from_right: Vec<Orbit<D>> = tunnel.orbit(&string.backward, ends_free).collect();
    let last = string.last();
    // The mode's square, up to a factor: x y is Green's function at the node.
    let height = |r: usize| from_left[r].logarithm() + from_right[last - r].logarithm();
    let at = (1..last).max_by_key(|&r| height(r))?;
    let (left, right) = (&from_left[at], &from_right[last - at]);
    let other_left = tunnel.orbit(&string.forward[..at], false).last()?;
    let other_right = tunnel.orbit(&string.backward[..last - at], !ends_free).last()?;
    let delta = sum(left.reciprocal(&other_left, true)?, right.reciprocal(&other_right, ends_free)?);
    let (a, b, mass) = (left.share(), right.share(), string.mass(at));
    // As many roundings as a sum has terms, and some at the end.
    let rounded = 2.0 * (last as f64 + 64.0) * U;
    let slope = ((a.0 + b.0 + mass) * (1.0 - rounded), (a.1 + b.1 + mass) * (1.0 + rounded));
    delta.over(slope, string.ticks / tunnel.unit)
}

/// The recurrence at one κ, for all κ of an interval about it.
struct Tunnel<D> {
    /// Ticks in the unit of time: a power of two, at least as long as any spring.
    unit: f64,
    /// κ m in that unit, rounded, by kind of node.
    kicks: [D; KINDS],
    masses: [f64; KINDS],
    /// Relative error of the kicks, the interval included.
    uncertainty: f64,
}

impl<D: Digits> Tunnel<D> {
    /// For s in [lo, hi].
    fn new(string: &HalfString, [lo, hi]: [D; 2]) -> Self {
        let unit = string.unit();
        let kappa = lo.plus(hi).scaled(0.5).over(string.ticks);
        // Rounded: the ends, the middle, the quotient, the mass (twice), the product.
        let uncertainty = hi.minus(lo).double() / lo.double() + 8.0 * D::LOSS;
        let mut kicks = [kappa; KINDS];
        for (kick, (&mass, &rest)) in kicks.iter_mut().zip(string.masses.iter().zip(&string.rests)) {
            *kick = kappa.times(D::sum(mass, rest)).scaled(unit);
        }
        Tunnel { unit, kicks, masses: string.masses, uncertainty }
    }

    /// The orbit at the start and after each step, short of the node's own kick.
    fn orbit<'a>(&'a self, steps: &'a [Step], free: bool) -> impl Iterator<Item = Orbit<D>> + 'a {
        let mut orbit = Orbit::start(free);
        std::iter::once(orbit).chain(steps.iter().map(move |step| {
            orbit.kick(self.kicks[step.kind], self.masses[step.kind], self.uncertainty);
            orbit.drift(step.length / self.unit);
            orbit.rescale();
            orbit
        }))
    }
}

/// A computed orbit û and how far the exact ones may be.
#[derive(Clone, Copy)]
struct Orbit<D> {
    /// û = (x, v) 2^exponent; what follows is in units of that, too.
    x: D,
    v: D,
    exponent: i64,
    /// |x| + |v|: at least |û|, at most √2 |û|.
    length: f64,
    /// Σ m x² over the nodes passed, and Σ m (τ v)², the square of what it may be off by in √m x.
    squares: f64,
    strays: f64,
    /// b, τ, w and c of the module's theorem.
    across: f64,
    tilt: f64,
    stretch: f64,
    strain: f64,
}

impl<D: Digits> Orbit<D> {
    fn start(free: bool) -> Self {
        let (x, v) = if free { (1.0, 0.0) } else { (0.0, 1.0) };
        let (squares, strays, across, tilt, stretch, strain) = Default::default();
        let [x, v] = [x, v].map(|x| D::sum(x, 0.0));
        Orbit { x, v, exponent: 0, length: 1.0, squares, strays, across, tilt, stretch, strain }
    }

    /// v −= k x, k known to within `uncertainty` of itself. (Where a product underflows, the other component
    /// is far longer than 2^-200, and its rounding covers that.)
    fn kick(&mut self, k: D, mass: f64, uncertainty: f64) {
        let (x, stray) = (self.x.double(), self.tilt * self.v.double());
        self.squares += mass * x * x;
        self.strays += mass * stray * stray;
        let pull = k.times(self.x);
        self.v = self.v.minus(pull);
        let residual = (uncertainty + 2.0 * D::LOSS) * pull.double().abs() + D::LOSS * self.v.double().abs();
        self.advance(1.0 + k.double(), residual);
    }

    /// x += v t, 0 ≤ t ≤ 1 exactly.
    fn drift(&mut self, t: f64) {
        let way = self.v.scaled(t);
        self.x = self.x.plus(way);
        self.advance(1.0 + t, D::LOSS * (way.double().abs() + self.x.double().abs()));
    }

    /// Accounts for a step with ‖M‖ ≤ `norm` and |r| ≤ `residual`, r in the component that the step changes.
    /// The roundings of this, and the second-order parts of the residuals, are below 2^-26 of the sums (fewer
    /// than 2^26 steps) and in the margins of [`Orbit::reliable`].
    fn advance(&mut self, norm: f64, residual: f64) {
        let length = self.x.double().abs() + self.v.double().abs();
        let inverse = ROOT_TWO / length;
        self.strain += residual * (ROOT_TWO / self.length);
        self.stretch += inverse * (residual + norm * self.tilt * self.length);
        self.across += residual * length;
        self.tilt = 2.0 * self.across * inverse * inverse;
        self.length = length;
    }

    /// By a power of two, exactly.
    fn rescale(&mut self) {
        let (factor, exponent) = rescaling(self.length);
        if exponent == 0 {
            return;
        }
        (self.x, self.v, self.length) = (self.x.scaled(factor), self.v.scaled(factor), self.length * factor);
        [&mut self.squares, &mut self.strays, &mut self.across]
            .into_iter()
            .for_each(|x| *x *= factor * factor);
        self.exponent += exponent;
    }

    /// 2^32 log2 |x| up to a constant, to within 2^29.
    fn logarithm(&self) -> i64 {
        logarithm(self.x.double()) + (self.exponent << 32)
    }

    /// τ |v/x|: by how much of itself x may be off across the orbit.
    fn lean(&self) -> f64 {
        self.tilt * (self.v.double() / self.x.double()).abs()
    }

    /// Whether the theorem holds and x is far from 0 (NaN is not).
    fn reliable(&self) -> bool {
        self.stretch + self.strain <= LARGEST_STRAIN && self.lean() <= LARGEST_STRAIN
    }

    /// 1/(x x') at one end, with the sign + where the first orbit starts free; `None` where x or x' may be 0.
    fn reciprocal(&self, other: &Orbit<D>, free: bool) -> Option<Term> {
        if !(self.reliable() && other.reliable()) {
            return None;
        }
        let sign = if free { 1.0 } else { -1.0 };
        let value = sign / (self.x.double() * other.x.double());
        // ln |x| is off by at most 1.03 (w + τ |v/x|), where the orbit is reliable.
        let error = 1.3 * (self.stretch + self.lean() + other.stretch + other.lean()) + 8.0 * U;
        Some(Term { value, error: error * value.abs(), exponent: -(self.exponent + other.exponent) })
    }

    /// Σ m x_j²/x², enclosed: by Minkowski's inequality √(Σ m x_j²) is off by the root of `strays`.
    fn share(&self) -> (f64, f64) {
        let x = self.x.double();
        let (root, stray) = (self.squares.sqrt(), 1.01 * self.strays.sqrt());
        let square = |root: f64| (root / x) * (root / x);
        // Twice the logarithm's: w once for the sum, once for x.
        let error = 2.6 * (2.0 * self.stretch + self.lean());
        (square((root - stray).max(0.0)) * (1.0 - error).max(0.0), square(root + stray) * (1.0 + error))
    }
}

/// A number within `error` of `value`, times 2^exponent.
struct Term {
    value: f64,
    error: f64,
    exponent: i64,
}

impl Term {
    /// This divided by a number in `slope`, times a positive factor; `None` where its sign is not proven.
    fn over(&self, slope: (f64, f64), factor: f64) -> Option<Apart> {
        let (lo, hi) = (self.value.abs() - self.error, self.value.abs() + self.error);
        if !(slope.0 > 0.0 && lo > 0.0 && self.exponent <= RANGE) {
            return None;
        }
        // In two factors, each within the range of doubles; four roundings, and two where the result is not
        // normal.
        let first = (self.exponent / 2).max(-RANGE);
        let second = (self.exponent - first).max(-RANGE);
        let quotient =
            |x: f64, slope: f64| x / slope * factor * 2f64.powi(first as i32) * 2f64.powi(second as i32);
        let margin = 4.0 * U;
        let (lo, hi) = (quotient(lo, slope.1) * (1.0 - margin), quotient(hi, slope.0) * (1.0 + margin));
        let outward = |x: f64, step: fn(f64) -> f64| if x < f64::MIN_POSITIVE { step(step(x)) } else { x };
        let width = (outward(lo, f64::next_down).max(0.0), outward(hi, f64::next_up));
        width.1.is_finite().then_some(Apart { in_order: self.value > 0.0, width })
    }
}

/// a + b.
fn sum(a: Term, b: Term) -> Term {
    let (a, b) = if a.exponent < b.exponent { (b, a) } else { (a, b) };
    let below = b.exponent - a.exponent;
    // A faint term is no more than its bound.
    let power = 2f64.powi(below.max(FAINT) as i32);
    let (value, error) = (b.value * power, b.error * power);
    let (value, error) = if below < FAINT { (0.0, value.abs() + error) } else { (value, error) };
    let total = a.value + value;
    Term { value: total, error: 1.01 * (a.error + error) + 2.0 * U * total.abs(), exponent: a.exponent }
}
