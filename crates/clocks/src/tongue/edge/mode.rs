//! A vibration mode near κ, and what its Rayleigh quotient proves about the eigenvalue.
//!
//! **The vector.** Run the recurrence from both ends to the node r where the mode lives (see `locate`), and
//! join the two halves there: z_j = x_j/x_r on the left, y_j/y_r on the right, so z_r = 1. All equations
//!
//! ```text
//!     F_j - F_{j+1} - κ m_j z_j = 0,        F_j = (z_j - z_{j-1})/ℓ_j
//! ```
//!
//! hold but for the roundings of each step, which are known exactly (as the errors of sums and products), and
//! the one at r, where the two halves do not quite meet. With the residuals ρ_j the quotient is
//!
//! ```text
//!     μ = Σ F_j² ℓ_j/Σ m_j z_j² = κ + Σ z_j ρ_j/Σ m_j z_j²:
//! ```
//!
//! a tiny correction to κ, so it needs a few digits only, and no cancellation ever occurs but at r, where it
//! is done in sums of two doubles. Without the roundings it is Newton's step for the mismatch at r. Steps
//! before that use the point before, too: κ is a smooth function of the mismatch, and two values with slopes
//! give a cubic for it.
//!
//! **Theorem** (Weinstein; Temple, Kato). Let ε² = Σ ρ_j²/m_j/Σ m_j z_j². Some eigenvalue lies in \[μ − ε,
//! μ + ε\]. If all but the k-th are ≤ α or ≥ β with α < μ − ε and μ + ε < β, it is the k-th one, and
//!
//! ```text
//!     μ - ε²/(β - μ) <= κ_k <= μ + ε²/(μ - α).
//! ```
//!
//! **The residual**, with S = Σ m z², W = Σ (1/ℓ + 1/ℓ')² z²/m and λ the largest 1/(m ℓ) of a node and a
//! spring at it. By `half` each row holds but for u (4 κ m |z| + (1/ℓ + 1/ℓ') |z| + 3 |F| + 3 |F'|) and, at
//! r, the mismatch; and Σ (3 |F| + 3 |F'|)²/m ≤ 36 λ Σ F² ℓ = 36 λ μ S, μ ≤ κ + ε. With p = |mismatch|/√(m_r
//! S):
//!
//! ```text
//!     ε <= p + u (√(W/S) + 4 κ + 6 √(λ (κ + ε)))
//!       <= p + u √(9/8 W/S + 288 κ² + 648 λ (κ + ε))
//!       <= 1.01 (p + u √(9/8 W/S + 288 κ² + 648 λ κ)) + 17000 u² λ.
//! ```
//!
//! So no absolute values need to be summed on the way. What is of second order in u is far below the 1.01
//! given to it.
//!
//! **The quotient's own error.** The terms of Σ z ρ add up to at most u (5 κ + 2 √(λ μ)) S ≤ ε S in absolute
//! value, with the ε just computed; five are summed for each of n nodes, so rounding puts μ off by (5 n + 64)
//! u ε at most, and n rounded masses in S, |μ − κ| being at most ε, by (n + 64) u ε. The terms e²/ℓ left out
//! of e F add less than 4 u² (κ + λ).

use super::batch::Batch;
use super::count::uncertainty;
use super::half::{Half, Ways, difference};
use crate::tongue::string::lanes::{LANES, Lanes};
use crate::tongue::string::{HalfString, Node};
use number::U;
use number::vector::Vector;
use number::vector::instructions::Kernel;

/// 2^-96, which covers what the products of [`Mode::new`] in two doubles round off.
const SLACK: f64 = f64::from_bits((1023 - 96) << 52);

/// Newton steps at most: as a rule three are enough.
const PASSES: u32 = 6;

/// A step shorter than this part of the distance to the neighbours is the last: what is left is about its
/// square, in units of the distance. So is one whose product with the step before is: what is left is about
/// the product's square.
const LAST_STEP: f64 = 1e-4;

/// A step that would lead beyond an end of the bracket goes this part of the way to it.
const NEARLY: f64 = 0.875;

/// The results of the modes, proven.
#[repr(align(64))]
pub(crate) struct Proofs {
    /// The eigenvalue's enclosure, times the ticks: an edge in s.
    pub edge: [Lanes; 2],
    /// The enclosure's radius before it is rounded to doubles, in κ; infinite where nothing is proven.
    pub radius: Lanes,
    /// μ, rounded.
    pub quotient: Lanes,
}

impl Proofs {
    /// Steps from each κ of a batch towards the eigenvalue, and what the modes prove where they end.
    pub fn of(string: &HalfString, batch: &Batch) -> Proofs {
        string.instructions.compute(Proving { string, batch })
    }
}

struct Proving<'a> {
    string: &'a HalfString,
    batch: &'a Batch,
}

impl Kernel for Proving<'_> {
    type Output = Proofs;

    #[inline(always)]
    fn run<V: Vector>(self) -> Proofs {
        let Proving { string, batch } = self;
        let (node, ways) = (Nodes::new(string, &batch.at), Ways::new(string, batch));
        let inner = [V::load(&batch.inside[0]), V::load(&batch.inside[1])];
        let eta = 2.0 * uncertainty(string);
        let others = [
            V::load(&batch.alone[0]).mul(V::splat(1.0 + eta)),
            V::load(&batch.alone[1]).mul(V::splat(1.0 - eta)),
        ];
        let (zero, one, last_step) = (V::splat(0.0), V::splat(1.0), V::splat(LAST_STEP));
        let mut kappa = V::load(&batch.kappa);
        let mut before = Point { kappa, mismatch: zero, slope: zero };
        // The step before: the first is plain Newton's, as long as a neighbour is far.
        let mut last = V::splat(f64::INFINITY);
        for _ in 0..PASSES {
            let point = Point::new(kappa, &ways.halves::<V, false>(kappa), node.mass);
            let next = point.zero(&before);
            let (inside, distance) = (within(&inner, next), within(&others, next));
            let step = next.sub(kappa).abs();
            // A step beyond an end of the bracket is made one nearly to that end.
            let end = next.if_above(kappa, inner[1], inner[0]);
            let short = V::splat(NEARLY).mul_add(end.sub(kappa), kappa);
            kappa = inside.if_above(zero, next, short);
            // By how much the step, and its product with the step before, are too long.
            let reach = last_step.mul(distance);
            let excess = step.sub(reach).lesser(step.mul(last).sub(reach.mul(distance)));
            if !inside.if_above(zero, excess, one).any_above(zero) {
                break;
            }
            (before, last) = (point, step);
        }
        Mode::new(string, kappa, &node, &ways.halves::<V, true>(kappa)).prove(string.ticks, &others)
    }
}

/// The distance to the nearer end: positive inside.
#[inline(always)]
fn within<V: Vector>([lo, hi]: &[V; 2], x: V) -> V {
    x.sub(*lo).lesser(hi.sub(x))
}

/// The nodes r.
struct Nodes<V> {
    mass: V,
    /// The part of it lost by rounding.
    lost: V,
    inverse_mass: V,
    /// (1/ℓ + 1/ℓ')²/m.
    weight: V,
}

impl<V: Vector> Nodes<V> {
    #[inline(always)]
    fn new(string: &HalfString, at: &Lanes) -> Self {
        let mut nodes = [[0.0; LANES]; 4];
        for (i, &at) in at.iter().enumerate() {
            let Node { kind, weight, .. } = string.nodes[at as usize];
            nodes[0][i] = string.masses[kind];
            nodes[1][i] = string.rests[kind];
            nodes[2][i] = string.inverse_masses[kind];
            nodes[3][i] = weight;
        }
        let [mass, lost, inverse_mass, weight] = &nodes;
        Nodes {
            mass: V::load(mass),
            lost: V::load(lost),
            inverse_mass: V::load(inverse_mass),
            weight: V::load(weight),
        }
    }
}

/// The mismatch at r as a function of κ: its value, and −dκ of a unit of it, 1/Σ m z².
#[derive(Clone, Copy)]
struct Point<V> {
    kappa: V,
    mismatch: V,
    slope: V,
}

impl<V: Vector> Point<V> {
    #[inline(always)]
    fn new(kappa: V, [left, right]: &[Half<V>; 2], mass: V) -> Self {
        let one = V::splat(1.0);
        let (a, b) = (one.div(left.x), one.div(right.x));
        let mismatch = kappa.neg_mul_add(mass, left.v.mul_add(a, right.v.mul(b)));
        let squares = left.squares.mul(a).mul_add(a, right.squares.mul(b).mul_add(b, mass));
        Point { kappa, mismatch, slope: one.div(squares) }
    }

    /// Where the mismatch vanishes: by the cubic for κ as a function of it, through this point and the one
    /// before with the slopes; by Newton's step where that is no improvement of it, or there is no point
    /// before.
    #[inline(always)]
    fn zero(&self, before: &Point<V>) -> V {
        let (y, z) = (self.mismatch, before.mismatch);
        let newton = y.mul(self.slope);
        let inverse = V::splat(1.0).div(y.sub(z));
        let chord = self.kappa.sub(before.kappa).mul(inverse);
        // The slope of κ is minus that which is kept.
        let (here, there) = (self.slope.add(chord).mul(inverse), before.slope.add(chord).mul(inverse));
        let bend = y.mul(y).mul(here.add(there).mul(inverse).mul_sub(z, here));
        // No comparison holds for NaN.
        let bend = newton.abs().if_above(V::splat(2.0).mul(bend.abs()), bend, V::splat(0.0));
        self.kappa.add(newton.add(bend))
    }
}

/// A half scaled to z_r = 1.
struct Arrival<V> {
    /// v, and what rounding took from it.
    force: V,
    rest: V,
    squares: V,
    work: V,
    stretch: V,
}

impl<V: Vector> Arrival<V> {
    #[inline(always)]
    fn new(half: &Half<V>) -> Self {
        let inverse = V::splat(1.0).div(half.x);
        let force = half.v.mul(inverse);
        let square = inverse.mul(inverse);
        Arrival {
            force,
            rest: force.neg_mul_add(half.x, half.v).mul(inverse),
            squares: half.squares.mul(square),
            work: half.work.mul(square),
            stretch: half.stretch.mul(square),
        }
    }
}

/// Rayleigh quotients and their residuals.
struct Mode<V> {
    /// μ = hi + lo, off by at most `error`.
    hi: V,
    lo: V,
    error: V,
    /// ε.
    residual: V,
}

impl<V: Vector> Mode<V> {
    /// The two halves joined at r.
    #[inline(always)]
    fn new(string: &HalfString, kappa: V, node: &Nodes<V>, [left, right]: &[Half<V>; 2]) -> Self {
        let (left, right) = (Arrival::new(left), Arrival::new(right));
        let kick = kappa.mul(node.mass);
        let (force, first) = left.force.two_sum(right.force);
        let (most, second) = force.two_sub(kick);
        let rest = left.rest.add(right.rest).add(difference(kappa, node.mass, node.lost, kick));
        let mismatch = most.add(first.add(second).add(rest));
        let inverse = V::splat(1.0).div(left.squares.add(right.squares).add(node.mass));
        let correction = left.work.add(right.work).add(mismatch).mul(inverse);
        // ε and the quotient's own error: see the module's text.
        let stiffest = V::splat(string.stiffest);
        let stretch = left.stretch.add(right.stretch).add(node.weight).mul(inverse);
        let bend = V::splat(288.0).mul_add(kappa, V::splat(648.0).mul(stiffest));
        let rounding = kappa.mul_add(bend, V::splat(1.125).mul(stretch)).sqrt();
        let own = mismatch.mul(mismatch).mul(node.inverse_mass).mul(inverse).sqrt();
        let least = V::splat(17_000.0 * U * U).mul(stiffest);
        let residual = V::splat(1.02).mul(V::splat(U).mul_add(rounding, own).add(least));
        let terms = left.force.abs().add(right.force.abs()).add(kick).mul_add(inverse, kappa);
        let rounded = V::splat((6.0 * string.nodes.len() as f64 + 128.0) * U).mul(residual);
        let omitted = V::splat(4.0 * U * U).mul(kappa.add(stiffest));
        let error = V::splat(1.01).mul(V::splat(SLACK).mul_add(terms, rounded.add(omitted)));
        let (hi, lo) = kappa.two_sum(correction);
        Mode { hi, lo, error, residual }
    }

    /// The module's theorem.
    #[inline(always)]
    fn prove(&self, ticks: f64, others: &[V; 2]) -> Proofs {
        let (mu, infinity) = (self.hi, V::splat(f64::INFINITY));
        // The uncertainty of the quotient itself, subtracted from the distances.
        let own = V::splat(2.0).mul(V::splat(f64::EPSILON).mul_add(mu, self.error));
        let least = within(others, mu).sub(own);
        let radius = V::splat(1.01).mul(self.residual.mul(self.residual.div(least)).add(self.error));
        // NaN proves nothing.
        let proven = least.if_above(self.residual, radius, infinity);
        let mut proofs = Proofs { edge: [[0.0; LANES]; 2], radius: [0.0; LANES], quotient: [0.0; LANES] };
        proven.store(&mut proofs.radius);
        mu.store(&mut proofs.quotient);
        // The operations below round by less than 10 u², a hundredth of the least radius.
        let ticks = V::splat(ticks);
        let (product, rest) = mu.two_product(ticks);
        let (nearest, rest) = product.two_sum(ticks.mul_add(self.lo, rest));
        let radius = V::splat(1.02).mul(ticks).mul(radius);
        let (lo, below) = nearest.two_sum(rest.sub(radius));
        let (hi, above) = nearest.two_sum(rest.add(radius));
        let zero = V::splat(0.0);
        zero.if_above(below, lo.below(), lo).store(&mut proofs.edge[0]);
        above.if_above(zero, hi.above(), hi).store(&mut proofs.edge[1]);
        proofs
    }
}
