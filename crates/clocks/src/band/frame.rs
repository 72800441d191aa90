//! Steps in the units of their base, and one kick of the other clock in a frame that turns (proofs/BANDS.md).
//!
//! In Floquet coordinates of the base a kick at the offset y behind it is 1 + 2α J ξξᵀ, ξ a point of a chord
//! of the unit circle. In the frame that turns by ψ y, ψ = θ − πa, one kick and the way to it become, with
//! t = 2 y − 1, but for a sign
//!
//! ```text
//!     M(t) = (1 + α (|Z| J + J S(Z))) R(τψ),    Z = (C + i S t)² e^{−iψt},    S(Z) = [[Re Z, Im Z], [Im Z, −Re Z]],
//! ```
//!
//! C = cos θ/2, S = sin θ/2. Beside the curves (a, b), τψ ≈ −πb: it is near ±1 there for every offset.

use std::f64::consts::PI;

use super::family::Family;
use super::taylor::Taylor;
use crate::orbit::returns::UP;
use number::U;

/// Terms of a sine and a cosine, and what may be left out of them.
const TERMS: usize = 30;
const TAIL: f64 = 1e-9;
const MOST_TAIL: f64 = 1e-3;

/// The clock that the other one is followed by: √Λ/2 of its own stiffness, Λ'/(2 √Λ) with that of the other
/// one.
#[derive(Clone, Copy, Debug)]
pub struct Base {
    pub root: Taylor,
    pub weight: Taylor,
}

/// One step of a clock that the other one is followed by, and a range of the other's.
#[derive(Clone, Debug)]
pub struct Frame {
    /// S = sin θ/2 = √s/2.
    sine: Taylor,
    /// k/4S = α cos θ/2.
    pull: Taylor,
    /// The other step over the base's.
    pub tau: Taylor,
    /// `None` where the base may be beyond its own limit.
    turning: Option<Turning>,
}

/// A base within its own limit.
#[derive(Clone, Debug)]
struct Turning {
    sine: Taylor,
    cosine: Taylor,
    theta: Taylor,
    /// τθ.
    phase: Taylor,
    /// k/(2 sin θ).
    alpha: Taylor,
    tau: Taylor,
}

impl Frame {
    /// Of the base's step, the other one, and the other one over the base's. `None` where the base's step may
    /// be zero.
    pub fn new(taylor: &Taylor, other: &Taylor, tau: &Taylor, base: &Base) -> Option<Frame> {
        let (sine, pull) = (taylor.times(&base.root), other.times(&base.weight));
        let turning = Turning::new(&sine, &pull, tau, &other.times(&base.root));
        Some(Frame { sine, pull, tau: *tau, turning })
    }

    /// |α| in the middle: how strongly the other clock's kicks distort the base's turn.
    pub fn distortion(&self) -> f64 {
        let rest = 1.0 - self.sine.center * self.sine.center;
        if rest > 0.0 { self.pull.center.abs() / rest.sqrt() } else { f64::INFINITY }
    }

    /// One kick in the frame of family a. `None` where the base may be beyond its limit, or ψ is too large
    /// for its terms.
    pub fn kick(&self, a: i64) -> Option<Family> {
        self.turning.as_ref()?.kick(a)
    }

    /// A kick at y = (1 + t)/2, pulled back to the base's, and a step of the base, in coordinates (x, v/κ)
    /// that no angle enters: also for a base beyond its own limit. `None` where nothing moves.
    pub fn plain(&self) -> Option<[Family; 2]> {
        let s = self.sine.times(&self.sine).scale2(2);
        let k = self.sine.times(&self.pull).scale2(2);
        let (half, quarter) = (s.scale2(-1), s.times(&s).scale2(-2));
        let square = s.minus(&quarter);
        // Any unit κ of the velocity will do.
        let unit = Taylor::constant((square.center.abs() + k.center.abs()).sqrt(), 0.0);
        let inverse = unit.reciprocal()?;
        let [one, zero] = [1.0, 0.0].map(|x| Taylor::constant(x, 0.0));
        let c = one.minus(&half);
        let step = Family::new(&[[c, unit, square.times(&inverse).negative(), c]]);
        // 1, y, y² by powers of t; u = 1 − s y/2.
        let powers = [[1.0, 0.5, 0.25], [0.0, 0.5, 0.5], [0.0, 0.0, 0.25]]
            .map(|row| row.map(|x| Taylor::constant(x, 0.0)));
        let terms = powers.map(|[constant, y, square]| {
            let across = k.times(&y.minus(&half.times(&square)));
            let along = constant.minus(&s.times(&y)).plus(&quarter.times(&square));
            let right = if square.center == 0.0 { zero } else { k.times(&square).times(&unit) };
            [
                constant.plus(&across),
                right,
                k.times(&along).times(&inverse).negative(),
                constant.minus(&across),
            ]
        });
        Some([Family::new(&terms), step])
    }
}

impl Turning {
    fn new(sine: &Taylor, pull: &Taylor, tau: &Taylor, other: &Taylor) -> Option<Turning> {
        let [half, cosine, share] = sine.arcsine()?;
        let alpha = pull.times(&cosine.reciprocal()?);
        // τθ = h2 θ/h1, and θ/h1 hardly depends on h1.
        let phase = other.times(&share).scale2(1);
        Some(Turning { sine: *sine, cosine, theta: half.scale2(1), phase, alpha, tau: *tau })
    }

    /// ψ = θ − πa.
    fn psi(&self, a: i64) -> Taylor {
        self.theta.minus(&half_turns(a))
    }

    /// τψ.
    fn phase(&self, a: i64) -> Taylor {
        self.phase.minus(&self.tau.times(&half_turns(a)))
    }

    /// M of family a. `None` where ψ is too large for its terms.
    fn kick(&self, a: i64) -> Option<Family> {
        let psi = self.psi(a);
        let [sine, cosine] = self.phase(a).sine_cosine()?;
        let (powers, tail) = powers(&psi)?;
        let [one, zero] = [1.0, 0.0].map(|x| Taylor::constant(x, 0.0));
        // The coefficient of t^j in t^k cos ψt, and of t^k sin ψt.
        let term = |j: usize, k: usize, odd: usize| match j.checked_sub(k) {
            Some(n) if n % 2 == odd && n < powers.len() => {
                if n / 2 % 2 == 0 {
                    powers[n]
                } else {
                    powers[n].negative()
                }
            }
            _ => zero,
        };
        let (square_c, square_s) = (self.cosine.times(&self.cosine), self.sine.times(&self.sine));
        let twice = self.cosine.times(&self.sine).scale2(1);
        let alpha = &self.alpha;
        let coefficient = |j: usize| {
            let combined = |x: Taylor, y: Taylor, z: Taylor| {
                square_c.times(&x).plus(&square_s.times(&y)).plus(&twice.times(&z))
            };
            // Re Z = (C² − S²t²) cos ψt + 2CSt sin ψt, Im Z = 2CSt cos ψt − (C² − S²t²) sin ψt.
            let re = combined(term(j, 0, 0), term(j, 2, 0).negative(), term(j, 1, 1));
            let im = combined(term(j, 0, 1).negative(), term(j, 2, 1), term(j, 1, 0));
            let modulus = match j {
                0 => square_c,
                2 => square_s,
                _ => zero,
            };
            let constant = if j == 0 { one } else { zero };
            let [p, q, r, s] = [
                constant.plus(&alpha.times(&im)),
                alpha.times(&modulus.minus(&re)),
                alpha.times(&modulus.plus(&re)).negative(),
                constant.minus(&alpha.times(&im)),
            ];
            // Times R(τψ) = [[cos, sin], [−sin, cos]].
            let row = |x: &Taylor, y: &Taylor| {
                [x.times(&cosine).minus(&y.times(&sine)), x.times(&sine).plus(&y.times(&cosine))]
            };
            let ([p, q], [r, s]) = (row(&p, &q), row(&r, &s));
            [p, q, r, s]
        };
        let terms: Vec<[Taylor; 4]> = (0..powers.len() + 2).map(coefficient).collect();
        // |C + iSt| ≤ 1, and S(Z) has the norm |Z|: a sine and a cosine lack a tail each.
        Some(Family::new(&terms).widened(2.0 * tail * self.alpha.size() * UP))
    }
}

/// πa.
fn half_turns(a: i64) -> Taylor {
    let turns = a as f64 * PI;
    Taylor::constant(turns, 2.0 * U * turns.abs())
}

/// ψ^j/j!, and a bound on the sum of |ψ|^j/j! over all that are left out.
fn powers(psi: &Taylor) -> Option<(Vec<Taylor>, f64)> {
    let (most, mut powers) = (psi.size(), vec![Taylor::constant(1.0, 0.0)]);
    for j in 1..TERMS {
        let next = powers[j - 1].times(psi).times(&Taylor::constant(1.0 / j as f64, U));
        powers.push(next);
        let factor = most / (j + 1) as f64;
        let tail = next.size() * factor / (1.0 - factor) * UP;
        let is_last = j + 1 == TERMS;
        if factor < 0.5 && (tail < TAIL || is_last) {
            return (tail < MOST_TAIL).then_some((powers, tail));
        }
    }
    None
}
