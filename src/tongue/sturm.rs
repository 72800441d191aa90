//! How many eigenvalues lie below κ: a Sturm count in doubles, and what it proves.
//!
//! Follow the string from t = 0: x ← x + ℓ v, v ← v − κ m x. The number of eigenvalues below κ is the number of
//! sign changes of x on the way (to a pinned end), and one more where x v < 0 at a free end (Sturm's oscillation
//! theorem; the zero eigenvalue of C included). So one pass counts for two problems.
//!
//! **Theorem** (after Kahan 1966 and Demmel and Kahan 1990). With u = 2^-53 and n nodes the computed count N̂(κ)
//! is the exact count of a string whose masses and lengths are off by factors within (1 ± u)^±(2n + 5), so
//!
//! ```text
//!     N(κ (1 - η)) <= N̂(κ) <= N(κ (1 + η)),        η = (4n + 16) u.
//! ```
//!
//! Proof. x̂_j = (x̂_{j−1} + ℓ_j v̂_{j−1}) (1 + δ') and v̂_j = (v̂_{j−1} − κ m_j x̂_j (1 + δ)) (1 + δ''), the
//! operations being fused. Divide x̂_j by X_j = Π (1 + δ') and v̂_j by V_j = Π (1 + δ'') up to j: no sign changes, and
//! what is left is the exact recurrence with ℓ_j V_{j−1}/X_{j−1} and m_j (1 + δ) X_j/V_{j−1}, where m_j itself is
//! within two more roundings of the string's mass. Each is off by a factor within (1 ± u)^±(2n + 5), so by
//! monotonicity (see [`super::string`]) the eigenvalues are by one within (1 ± u)^±(4n + 10). An underflowing result is
//! off by less than u/4 of the larger one of |x| and |v|, which rescaling by powers of two keeps above 2^-500. ∎

use super::lanes::{Aligned, LANES, Lanes, lanes, lesser, normalizing};
use super::locate::start;
use super::string::{HalfString, Kicks};
use crate::number::U;
use crate::verdict::instructions::Task;

/// N̂(κ) for a pinned and for a free end at T/2, of positive eigenvalues: whole numbers.
pub(super) type Counts = [Lanes; 2];

impl HalfString {
    /// The uncertainty η of a computed count, see the module's theorem.
    pub fn eta(&self) -> f64 {
        (4.0 * self.nodes.len() as f64 + 16.0) * U
    }

    /// The counts for each lane, of the two problems that are free (or pinned) at t = 0. Above all eigenvalues every κ
    /// counts alike, so none is taken where numbers grow faster than [`HalfString::block`] allows for.
    pub fn counts(&self, starts_free: &[bool; LANES], kappa: &Lanes) -> Counts {
        let starts_free = lanes(|i| f64::from(u8::from(starts_free[i])));
        let kappa = lanes(|i| lesser(kappa[i], 2.0 * self.upper_bound));
        self.instructions.perform(Counting { string: self, starts_free: &starts_free, kappa: &kappa })
    }
}

struct Counting<'a> {
    string: &'a HalfString,
    starts_free: &'a Lanes,
    kappa: &'a Lanes,
}

impl Task for Counting<'_> {
    type Output = Counts;

    #[inline(always)]
    fn run(self) -> Counts {
        count(self.string, self.starts_free, self.kappa)
    }
}

#[inline(always)]
fn count(string: &HalfString, starts_free: &Lanes, kappa: &Lanes) -> Counts {
    let kicks = string.kicks(kappa);
    let first = &kicks.0[string.nodes[0].kind];
    let (mut x, mut v) = start(starts_free);
    v = lanes(|i| (-first[i]).mul_add(x[i], v[i]));
    let mut changes = [0; LANES];
    for block in string.nodes[1..].chunks(string.block) {
        for node in block {
            let kick: &Lanes = &kicks.0[node.kind];
            let next = lanes(|i| node.length.mul_add(v[i], x[i]));
            for i in 0..LANES {
                changes[i] += (next[i].to_bits() ^ x[i].to_bits()) >> 63;
            }
            v = lanes(|i| (-kick[i]).mul_add(next[i], v[i]));
            x = next;
        }
        let factor = normalizing(&x, &v);
        x = lanes(|i| x[i] * factor[i]);
        v = lanes(|i| v[i] * factor[i]);
    }
    let changes = lanes(|i| whole(changes[i]));
    let past = lanes(|i| if x[i] * v[i] < 0.0 { 1.0 } else { 0.0 });
    // The zero eigenvalue of C is below every κ and not counted.
    let free = lanes(|i| changes[i] + past[i] - starts_free[i]);
    [changes, free]
}

/// A whole number below 2^52 as a double.
#[inline(always)]
fn whole(n: u64) -> f64 {
    const UNIT: f64 = (1u64 << 52) as f64;
    f64::from_bits(UNIT.to_bits() | n) - UNIT
}

/// An eigenvalue for each lane, and where it is.
#[derive(Clone, Copy)]
pub(super) struct Targets {
    /// 1 where the end is free, else 0.
    pub starts_free: Lanes,
    pub ends_free: Lanes,
    pub index: Lanes,
    pub inside: [Lanes; 2],
}

impl HalfString {
    /// Halves the intervals so many times.
    pub fn narrow(&self, targets: &Targets, halvings: u32) -> [Lanes; 2] {
        self.instructions.perform(Narrowing { string: self, targets, halvings })
    }
}

struct Narrowing<'a> {
    string: &'a HalfString,
    targets: &'a Targets,
    halvings: u32,
}

impl Task for Narrowing<'_> {
    type Output = [Lanes; 2];

    #[inline(always)]
    fn run(self) -> [Lanes; 2] {
        let Targets { starts_free, ends_free, index, inside: [mut lo, mut hi] } = *self.targets;
        for _ in 0..self.halvings {
            let cut = lanes(|i| 0.5 * (lo[i] + hi[i]));
            let [pinned, free] = count(self.string, &starts_free, &cut);
            let below = lanes(|i| if ends_free[i] > 0.0 { free[i] } else { pinned[i] });
            lo = lanes(|i| if below[i] < index[i] { cut[i] } else { lo[i] });
            hi = lanes(|i| if below[i] < index[i] { hi[i] } else { cut[i] });
        }
        [lo, hi]
    }
}

impl HalfString {
    /// κ m, by kind of node.
    #[inline(always)]
    pub fn kicks(&self, kappa: &Lanes) -> Kicks {
        // No closure that a compiler might leave for the processor's common instructions.
        let mut kicks = Aligned([[0.0; LANES]; 8]);
        for kind in 2..8 {
            let mass = self.masses[kind];
            kicks.0[kind] = lanes(|i| kappa[i] * mass);
        }
        kicks
    }
}
