//! How many eigenvalues lie below κ: a Sturm count in doubles, and what it proves.
//!
//! Follow the string from t = 0: x ← x + ℓ v, v ← v − κ m x. The number of eigenvalues below κ is the number of
//! sign changes of x on the way (to a pinned end), and one more where x v < 0 at a free end (Sturm's oscillation
//! theorem; the zero eigenvalue of C included).
//!
//! **Theorem** (after Kahan 1966 and Demmel and Kahan 1990). With u = 2^-53 and n nodes the computed count N̂(κ)
//! is the exact count of a string whose masses and lengths are off by factors within (1 ± u)^±(2n + 5), so
//!
//! ```text
//!     N(κ (1 - η)) <= N̂(κ) <= N(κ (1 + η)),        η = (4n + 16) u.
//! ```
//!
//! Proof. x̂_j = (x̂_{j−1} + ℓ_j v̂_{j−1} (1 + δ)) (1 + δ') and v̂_j = (v̂_{j−1} − κ m_j x̂_j (1 + δ)²) (1 + δ''). Divide x̂_j by
//! X_j = Π (1 + δ') and v̂_j by V_j = Π (1 + δ'') up to j: no sign changes, and what is left is the exact recurrence with
//! ℓ_j (1 + δ) V_{j−1}/X_{j−1} and m_j (1 + δ)² X_j/V_{j−1}, where m_j itself is within two more roundings of the string's
//! mass. Each is off by a factor within (1 ± u)^±(2n + 5), so by monotonicity (see [`super::string`]) the eigenvalues
//! are by one within (1 ± u)^±(4n + 10). An underflowing product is less than u/4 of the sum that it enters, whose
//! rounding covers it: rescaling by powers of two keeps max(|x|, |v|) above 2^-500. ∎

use super::string::{Entry, HalfString};

/// Eigenvalues are looked for this many at a time, side by side.
pub(super) const LANES: usize = 8;

/// One number for each lane.
pub(super) type Lanes = [f64; LANES];

/// Nodes between two rescalings. With masses within 1e±16 and lengths below 2^25 a node's factor is below 1e25,
/// so no block overflows.
pub(super) const BLOCK: usize = 8;

/// f of each lane.
pub(super) fn lanes(f: impl FnMut(usize) -> f64) -> Lanes {
    std::array::from_fn(f)
}

/// The kick strengths κ m, by kind of node.
pub(super) type Kicks = [Lanes; 8];

impl HalfString {
    /// The uncertainty η of a computed count, see the module's theorem.
    pub fn eta(&self) -> f64 {
        (4.0 * self.nodes.len() as f64 + 16.0) * (f64::EPSILON / 2.0)
    }

    pub fn kicks(&self, kappa: &Lanes) -> Kicks {
        self.masses.map(|m| lanes(|i| kappa[i] * m))
    }

    /// N̂(κ) for each lane: computed counts of positive eigenvalues below κ.
    pub fn counts(&self, entry: Entry, kappa: &Lanes) -> [u64; LANES] {
        let kicks = self.kicks(kappa);
        let (mut x, mut v) = start(entry.starts_free(), &kicks[self.nodes[0].kind]);
        let mut changes = [0u64; LANES];
        for block in self.nodes[1..].chunks(BLOCK) {
            for node in block {
                let kick = &kicks[node.kind];
                for i in 0..LANES {
                    let before = x[i].to_bits();
                    x[i] += node.length * v[i];
                    changes[i] += (before ^ x[i].to_bits()) >> 63;
                    v[i] -= kick[i] * x[i];
                }
            }
            rescale(&mut x, &mut v);
        }
        if entry.ends_free() {
            // The zero eigenvalue of C is below every κ and not counted.
            let rigid = u64::from(entry == Entry::C);
            (0..LANES).for_each(|i| changes[i] = changes[i] + u64::from(x[i] * v[i] < 0.0) - rigid);
        }
        changes
    }
}

/// (x, v) after the node at a free or pinned end, whose kick strength is given.
pub(super) fn start(free: bool, kick: &Lanes) -> (Lanes, Lanes) {
    if free { ([1.0; LANES], kick.map(|k| -k)) } else { ([0.0; LANES], [1.0; LANES]) }
}

/// Divides x and v by a power of two that brings the larger one to [1, 2); returns its exponent.
pub(super) fn rescale(x: &mut Lanes, v: &mut Lanes) -> [i64; LANES] {
    let mut exponents = [0; LANES];
    for i in 0..LANES {
        let field = (x[i].abs().max(v[i].abs()).to_bits() >> 52) as i64;
        exponents[i] = field - 1023;
        let factor = f64::from_bits(((2046 - field) as u64) << 52);
        x[i] *= factor;
        v[i] *= factor;
    }
    exponents
}
