//! How many eigenvalues lie below κ: a Sturm count in doubles, and what it proves.
//!
//! Follow the string from t = 0: x ← x + ℓ v, v ← v − κ m x. The number of eigenvalues below κ is the number
//! of sign changes of x on the way (to a pinned end), and one more where x v < 0 at a free end (Sturm's
//! oscillation theorem; the zero eigenvalue of C included). So one pass counts for two problems.
//!
//! **Theorem** (after Kahan 1966 and Demmel and Kahan 1990). With u = 2^-53 and n nodes the computed count
//! N̂(κ) is the exact count of a string whose masses and lengths are off by factors within (1 ± u)^±(2n + 5),
//! so
//!
//! ```text
//!     N(κ (1 - η)) <= N̂(κ) <= N(κ (1 + η)),        η = (4n + 16) u.
//! ```
//!
//! Proof. x̂_j = (x̂_{j−1} + ℓ_j v̂_{j−1}) (1 + δ') and v̂_j = (v̂_{j−1} − κ m_j x̂_j (1 + δ)) (1 + δ''), the
//! operations being fused. Divide x̂_j by X_j = Π (1 + δ') and v̂_j by V_j = Π (1 + δ'') up to j: no sign
//! changes, and what is left is the exact recurrence with ℓ_j V_{j−1}/X_{j−1} and m_j (1 + δ) X_j/V_{j−1},
//! where m_j itself is within two more roundings of the string's mass. Each is off by a factor within (1 ±
//! u)^±(2n + 5), so by monotonicity (see [`HalfString`]) the eigenvalues are by one within (1 ±
//! u)^±(4n + 10). An underflowing result is off by less than u/4 of the larger one of |x| and |v|, which
//! rescaling by powers of two keeps above 2^-500. ∎

use super::batch::Batch;
use crate::tongue::string::lanes::{LANES, Lanes, lanes, lesser};
use crate::tongue::string::{HalfString, KINDS};
use number::U;
use number::vector::Vector;
use number::vector::instructions::Kernel;

/// The uncertainty η of a computed count, see the module's theorem.
pub fn uncertainty(string: &HalfString) -> f64 {
    (4.0 * string.nodes.len() as f64 + 16.0) * U
}

/// N̂(κ) of positive eigenvalues, whole numbers: of the four problems, for the κ of each lane. Above all
/// eigenvalues every κ counts alike, so none is taken where numbers grow faster than [`HalfString::block`]
/// allows for.
pub fn counts(string: &HalfString, kappa: &Lanes) -> [Lanes; 4] {
    let kappa = lanes(|i| lesser(kappa[i], 2.0 * string.upper_bound));
    string.instructions.compute(Counting { string, kappa: &kappa })
}

/// Halves the intervals in which the eigenvalues are so many times, by the entries' signs.
pub fn narrow(string: &HalfString, batches: &mut [Batch], halvings: u32) {
    for pair in batches.chunks_mut(2) {
        string.instructions.compute(Narrowing { string, pair, halvings });
    }
}

/// Two walks from node to node side by side: one alone would wait for itself.
struct Walks<V> {
    x: [V; 2],
    /// Behind the node's kick.
    v: [V; 2],
    changes: [V; 2],
}

/// In doubles from here on to twice it whole numbers count the last bits.
const UNIT: f64 = (1u64 << 52) as f64;

impl<V: Vector> Walks<V> {
    /// From the first node, free (1) or pinned (0), to the last, counting the changes of sign if asked to.
    #[inline(always)]
    fn new<const COUNT: bool>(string: &HalfString, starts_free: &[V; 2], kappa: &[V; 2]) -> Self {
        let mut kicks = [*kappa; KINDS];
        for (kick, &mass) in kicks.iter_mut().zip(&string.masses) {
            let mass = V::splat(mass);
            *kick = [kappa[0].mul(mass), kappa[1].mul(mass)];
        }
        let (mut x, mut v, mut changes) = (*starts_free, *starts_free, [V::splat(UNIT); 2]);
        for g in 0..2 {
            let first = kicks[string.nodes[0].kind][g];
            v[g] = first.neg_mul_add(x[g], V::splat(1.0).sub(x[g]));
        }
        for block in string.nodes[1..].chunks(string.block) {
            for node in block {
                let (kick, length) = (&kicks[node.kind], V::splat(node.length));
                for g in 0..2 {
                    let next = length.mul_add(v[g], x[g]);
                    if COUNT {
                        changes[g] = changes[g].count_change(next, x[g]);
                    }
                    v[g] = kick[g].neg_mul_add(next, v[g]);
                    x[g] = next;
                }
            }
            for g in 0..2 {
                let factor = x[g].abs().larger(v[g].abs()).normalizing();
                x[g] = x[g].mul(factor);
                v[g] = v[g].mul(factor);
            }
        }
        Walks { x, v, changes }
    }
}

struct Counting<'a> {
    string: &'a HalfString,
    kappa: &'a Lanes,
}

impl Kernel for Counting<'_> {
    type Output = [Lanes; 4];

    #[inline(always)]
    fn run<V: Vector>(self) -> [Lanes; 4] {
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        let starts_free = [one, zero];
        let walks = Walks::new::<true>(self.string, &starts_free, &[V::load(self.kappa); 2]);
        let mut counts = [[0.0; LANES]; 4];
        for g in 0..2 {
            // A, B: pinned at T/2.
            let pinned = walks.changes[g].sub(V::splat(UNIT));
            pinned.store(&mut counts[g]);
            // C, D: one more past the last node; the zero eigenvalue of C is below every κ and not counted.
            let past = zero.if_above(walks.x[g].mul(walks.v[g]), one, zero);
            pinned.add(past).sub(starts_free[g]).store(&mut counts[g + 2]);
        }
        counts
    }
}

struct Narrowing<'a> {
    string: &'a HalfString,
    /// Two batches, or one.
    pair: &'a mut [Batch],
    halvings: u32,
}

impl Kernel for Narrowing<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Narrowing { string, pair, halvings } = self;
        let batches = [&pair[0], &pair[pair.len() - 1]];
        let both = |of: fn(&Batch) -> &Lanes| [V::load(of(batches[0])), V::load(of(batches[1]))];
        let starts_free = both(|batch| &batch.starts_free);
        let ends_free = both(|batch| &batch.ends_free);
        let sign = both(|batch| &batch.sign);
        let [mut lo, mut hi] = [both(|batch| &batch.inside[0]), both(|batch| &batch.inside[1])];
        let (zero, half) = (V::splat(0.0), V::splat(0.5));
        for _ in 0..halvings {
            let cut = [half.mul(lo[0].add(hi[0])), half.mul(lo[1].add(hi[1]))];
            let walks = Walks::new::<false>(string, &starts_free, &cut);
            for g in 0..2 {
                let value = ends_free[g].if_above(zero, walks.v[g], walks.x[g]).mul(sign[g]);
                (lo[g], hi[g]) = (value.if_above(zero, cut[g], lo[g]), value.if_above(zero, hi[g], cut[g]));
            }
        }
        for (g, batch) in pair.iter_mut().enumerate() {
            lo[g].store(&mut batch.inside[0]);
            hi[g].store(&mut batch.inside[1]);
            batch.guess();
        }
    }
}
