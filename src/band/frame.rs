//! A box in the units of its base, and one kick of the other clock in a frame that turns (proofs/BANDS.md).
//!
//! In Floquet coordinates of the base a kick at the offset y behind it is 1 + 2α J ξξᵀ, ξ a point of a chord of the unit circle. In
//! the frame that turns by ψ y, ψ = θ − πa, one kick and the way to it become, with t = 2 y − 1, but for a sign
//!
//! ```text
//!     M(t) = (1 + α (|Z| J + J S(Z))) R(τψ),    Z = (C + i S t)² e^{−iψt},    S(Z) = [[Re Z, Im Z], [Im Z, −Re Z]],
//! ```
//!
//! C = cos θ/2, S = sin θ/2. Beside the curves (a, b), τψ ≈ −πb: it is near ±1 there for every offset.

use std::f64::consts::PI;

use super::UP;
use super::family::{Family, Order};
use super::taylor::Taylor;
use super::trig::{arcsine, sine_cosine};
use crate::number::U;

/// Families |a| ≤ this have a frame.
const FAMILIES: i32 = 4;

/// Room for the second order beside the first-order law: a share of its widths, and of α².
const WIDER: f64 = 1.1;
const BEYOND: f64 = 0.3;

/// Terms of a sine and a cosine, and what may be left out of them.
const TERMS: usize = 30;
const TAIL: f64 = 1e-9;
const MOST_TAIL: f64 = 1e-3;

/// The clock that a box is followed by: √Λ/2 of its own stiffness, Λ'/(2 √Λ) with that of the other one.
#[derive(Clone, Copy, Debug)]
pub struct Base {
    pub root: Taylor,
    pub weight: Taylor,
}

/// A box in the units of its base.
#[derive(Clone, Debug)]
pub struct Frame {
    /// S = sin θ/2 = √s/2.
    pub sine: Taylor,
    /// k/4S = α cos θ/2.
    pub pull: Taylor,
    /// The other step over the base's.
    pub tau: Taylor,
    /// `None` where the base may be beyond its own limit.
    pub turning: Option<Turning>,
}

/// A base within its own limit.
#[derive(Clone, Debug)]
pub struct Turning {
    sine: Taylor,
    cosine: Taylor,
    theta: Taylor,
    /// τθ.
    phase: Taylor,
    /// k/(2 sin θ).
    alpha: Taylor,
    tau: Taylor,
}

/// A family whose band may cross the box.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    pub a: i32,
    /// |S_a|, the share of α that is half the band's width in phase.
    pub strength: f64,
    /// The step that moves the phase more.
    pub direction: usize,
    /// About so many bisections until the box is as small as the band.
    pub to_go: u32,
}

impl Frame {
    /// A box of the base's step and the other one. `None` where the base's step may be zero.
    pub fn new(own: &Taylor, other: &Taylor, base: &Base) -> Option<Frame> {
        let (sine, pull) = (own.times(&base.root), other.times(&base.weight));
        let tau = other.times(&own.reciprocal()?);
        let turning = Turning::new(&sine, &pull, &tau, &other.times(&base.root));
        Some(Frame { sine, pull, tau, turning })
    }

    /// |α| in the middle: how strongly the other clock's kicks distort the base's turn.
    pub fn distortion(&self) -> f64 {
        let rest = 1.0 - self.sine.center * self.sine.center;
        if rest > 0.0 { self.pull.center.abs() / rest.sqrt() } else { f64::INFINITY }
    }

    /// A kick at y = (1 + t)/2, pulled back to the base's, and a step of the base, in coordinates (x, v/κ) that no angle enters: also
    /// for a base beyond its own limit. `None` where nothing moves.
    pub fn plain(&self, order: Order) -> Option<[Family; 2]> {
        let s = self.sine.times(&self.sine).scale2(2);
        let k = self.sine.times(&self.pull).scale2(2);
        let (half, quarter) = (s.scale2(-1), s.times(&s).scale2(-2));
        let square = s.minus(&quarter);
        // Any unit κ of the velocity will do.
        let unit = Taylor::constant((square.center.abs() + k.center.abs()).sqrt(), 0.0);
        let inverse = unit.reciprocal()?;
        let [one, zero] = [1.0, 0.0].map(|x| Taylor::constant(x, 0.0));
        let c = one.minus(&half);
        let step = Family::new(order, &[[c, unit, square.times(&inverse).negative(), c]]);
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
        Some([Family::new(order, &terms), step])
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
    fn psi(&self, a: i32) -> Taylor {
        self.theta.minus(&half_turns(a))
    }

    /// τψ.
    fn phase(&self, a: i32) -> Taylor {
        self.phase.minus(&self.tau.times(&half_turns(a)))
    }

    /// |S_a| of the first-order law: (2 S²/ψ²) (1 + sin θ/ψ).
    fn strength(&self, a: i32) -> f64 {
        let (s, c, psi) = (self.sine.center, self.cosine.center, self.psi(a).center);
        (2.0 * s * s / (psi * psi) * (1.0 + 2.0 * s * c / psi)).abs()
    }

    /// The families whose band may cross the box by the first-order law, the widest first. No proof rests on it: what is left out is not
    /// looked for.
    pub fn candidates(&self) -> Vec<Candidate> {
        let (s, alpha) = (self.sine.center, self.alpha.center);
        let mean = alpha * (1.0 - 2.0 / 3.0 * s * s);
        // By how much one kick and the way to it turn beside the bands: the mean kick, with its own part that does not turn.
        let own = alpha * self.strength(0);
        let [sine, cosine] = sine_cosine(self.phase.center);
        let half_trace = (cosine - mean * sine) / (1.0 + mean * mean - own * own).max(1e-3).sqrt();
        let angle = 0.5 * PI - arcsine(half_trace.abs().min(1.0 - 1e-9))[0].copysign(half_trace);
        let below = ((self.phase.center + mean) / PI).floor();
        let is_even = below.rem_euclid(2.0) == 0.0;
        let turn = if is_even { below * PI + angle } else { (below + 1.0) * PI - angle };
        let slope = (sine + mean * cosine).abs() / (1.0 - half_trace * half_trace).max(1e-2).sqrt();
        let candidate = |a: i32| {
            let (phase, strength) = (self.phase(a), self.strength(a));
            let width = alpha.abs() * strength;
            let moved = phase.reach() + self.alpha.reach() + WIDER * width;
            let (center, room) = if a == 0 {
                (self.phase.center + mean, moved)
            } else {
                (turn - f64::from(a) * PI * self.tau.center, slope.max(1.0) * moved + BEYOND * alpha * alpha)
            };
            let beside = center / PI;
            let may_cross = PI * (beside - beside.round()).abs() <= room;
            may_cross.then(|| Candidate {
                a,
                strength,
                direction: usize::from(phase.slopes[1].abs() > phase.slopes[0].abs()),
                to_go: bisections(4.0 * phase.reach() / width),
            })
        };
        let mut found: Vec<Candidate> = (-FAMILIES..=FAMILIES).filter_map(candidate).collect();
        found.sort_by(|x, y| y.strength.total_cmp(&x.strength));
        found
    }

    /// M of family a. `None` where ψ is too large for its terms.
    pub fn kick(&self, a: i32, order: Order) -> Option<Family> {
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
        Some(Family::new(order, &terms).widened(2.0 * tail * self.alpha.size() * UP))
    }
}

/// πa.
fn half_turns(a: i32) -> Taylor {
    let turns = f64::from(a) * PI;
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

/// 2 log₂ x, rounded up; 0 below 1.
pub fn bisections(x: f64) -> u32 {
    let (mut square, mut count) = (x * x, 0);
    while square > 1.0 && count < 60 {
        square *= 0.5;
        count += 1;
    }
    count
}
