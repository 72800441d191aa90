//! Where the verdict on a line of systems can change: real roots of polynomials, isolated.
//!
//! Masses and stiffnesses are linear in s, steps are fixed, 0 ≤ s ≤ 1. The eigenvalues μ of S(s) = Bᵀ C are
//! the roots of χ(z, s), a polynomial in s up to a power of the masses. Let f be its squarefree part in z,
//! and g what is left of f without the factors z and z + 1, which f has where 0 or −1 is a μ for all s. The
//! numbers of distinct μ in (−1, 0), beyond either end and off the real axis, and the multiplicities of 0 and
//! −1, change only at the real roots in s of
//!
//! ```text
//!     g(0, s)  (det B det C = 0),     g(−1, s)  (det A det D = 0),     disc g(·, s)  (two μ meet).
//! ```
//!
//! Between two of them multiplicities stay what they are. With R = diag(I, −I), Q = R H⁻¹ R H and Q + 1/Q =
//! 2 + 4 diag(S, Sᵀ), so Q − I = R H⁻¹ (R H − H R) and Q + I = R H⁻¹ (R H + H R): the squarefree polynomial
//! of the multipliers, taken at Q, is 0 iff
//!
//! ```text
//!     g(S) = 0,      or C g(S) = 0 and B g(Sᵀ) = 0 where 0 is a μ,      or A g(S) = 0 and D g(Sᵀ) = 0 where −1 is
//! ```
//!
//! (where both are, g(S) (S + 1) stands in the first pair and g(S) S in the second). Are these 0 for all s,
//! then Q is diagonalizable wherever no other μ meet, and the verdict at one point is that of the whole
//! interval between two roots (proofs/SIGNS.md, section 1). Are they not, then Q is not diagonalizable where
//! one of their entries is not 0, also where μ meet, whose squarefree polynomial is a divisor: unstable
//! everywhere but at common roots of all entries.
//!
//! Where D = Aᵀ for all s, as of steps 1/3 and 1/2 whose fast forces turn by a third of a half turn a step,
//! S + 1 = Dᵀ A = A²: two μ = ν² − 1 meet where the eigenvalues ν of A are opposite, and −1 is reached where
//! ν = 0, without consequence, for S has the eigenvectors of A, and Q + I as many null vectors as A and D,
//! twice those of S + 1. So (A − 1)/2, whose eigenvalues lie in (−1, 0) where ν lies in (−1, 1), takes the
//! place of S in what is said above, if neither end is always an eigenvalue.
//!
//! Where all potentials commute, S is self-adjoint in the metric of M: μ are real and S is diagonalizable for
//! all s, so g may keep its multiple roots and the discriminant is left out.
//!
//! | file | what |
//! |---|---|
//! | `line` | systems on a line, decoupled |
//! | `half` | the half period on a line modulo a prime; how long and of what degree its invariants are |
//! | `polynomials` | these polynomials, from their values modulo primes |
//! | `place` | their roots as gaps between neighbouring doubles |

mod half;
mod line;
mod place;
mod polynomials;

use half::Half;
pub(super) use line::Line;
pub use place::Gap;
use polynomials::{Critical, Shape};

use num_bigint::BigInt;

use crate::verdict::decide::decide_system;
use crate::verdict::limits::Limits;
use crate::verdict::measured::Holds;
use number::{Rational, Result};

/// All parts, with the half periods of those that change and what is to be found of each.
pub(super) struct Plan(Vec<(Line, Option<(Half, Shape)>)>);

impl Plan {
    /// `None` where the polynomials would cost too much.
    ///
    /// # Errors
    /// As [`Line::at`].
    pub fn new(line: &Line, limits: &Limits) -> Result<Option<Plan>> {
        let mut parts = Vec::new();
        for part in line.parts() {
            if part.is_constant() {
                parts.push((part, None));
                continue;
            }
            let half = Half::new(&part)?;
            let Some(shape) = polynomials::shape(&half, limits) else { return Ok(None) };
            parts.push((part, Some((half, shape))));
        }
        Ok(Some(Plan(parts)))
    }

    /// Those that change, with their places among all.
    fn changing(&self) -> impl Iterator<Item = (usize, &(Half, Shape))> {
        self.0.iter().enumerate().filter_map(|(k, (_, pair))| Some((k, pair.as_ref()?)))
    }

    /// Products of machine words, roughly.
    pub fn cost(&self) -> f64 {
        self.changing().map(|(_, (half, shape))| shape.cost(half)).sum()
    }

    /// The gaps between doubles from `lo` to `hi` that hold all places where the verdict can change,
    /// increasing; `place` takes a number to its s, an increasing map of \[lo, hi\] onto \[0, 1\]. `None`
    /// where the polynomials are of another kind than they seemed to be.
    ///
    /// # Errors
    /// Where the work is stopped.
    pub fn gaps(
        &self,
        ends: (f64, f64),
        place: &(impl Fn(&Rational) -> Rational + Sync),
    ) -> Result<Option<Vec<Gap>>> {
        let mut gaps = Vec::new();
        for (part, (half, shape)) in self.changing() {
            let Some(found) = polynomials::critical(half, shape)? else { return Ok(None) };
            gaps.extend(place::gaps(part, &found, ends, place)?);
        }
        Ok(Some(place::united(gaps)))
    }

    /// Whether some part is unstable at all places in a gap, whatever the others are, since it is on both
    /// sides, at s from and to, and has at most one simple root between. At such a root either one μ crosses
    /// 0 or −1, or two meet that are real on one side, and all others stay where they are. Where these meet
    /// outside \[−1, 0\] they are unstable themselves; else one side has them within it, so that others are
    /// unstable there, and at the root.
    ///
    /// # Errors
    /// As [`decide_system`].
    pub fn is_unstable_in(&self, gap: &Gap, sides: [Rational; 2], limits: &Limits) -> Result<bool> {
        for (k, (part, _)) in self.0.iter().enumerate() {
            let roots = gap.parts.iter().find(|part| part.0 == k);
            if roots.is_some_and(|roots| !roots.1) {
                continue;
            }
            // Without a root both sides are alike.
            let mut sides = sides.iter().take(if roots.is_some() { 2 } else { 1 });
            if sides.try_fold(true, |is, s| {
                Ok(is && decide_system(&part.at(s)?, limits)?.holds() == Holds::Unstable)
            })? {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

/// The gaps of all real roots in \[0, 1\] of polynomials in s, as [`Plan::gaps`] has them.
///
/// # Errors
/// Where the work is stopped.
pub(crate) fn gaps_of(
    polynomials: &[Vec<BigInt>],
    ends: (f64, f64),
    place: &(impl Fn(&Rational) -> Rational + Sync),
) -> Result<Vec<Gap>> {
    let found: Vec<_> = polynomials.iter().map(|polynomial| Critical::new(polynomial)).collect();
    Ok(place::united(place::gaps(0, &found, ends, place)?))
}
