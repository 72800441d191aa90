//! Where the verdict on a line of systems can change: real roots of polynomials, isolated.
//!
//! Masses and stiffnesses are linear in s, steps are fixed, 0 ≤ s ≤ 1. The eigenvalues μ of S(s) = Bᵀ C are the roots of χ(z, s), a
//! polynomial in s up to a power of the masses. With f its squarefree part in z, of degree m, the numbers of distinct μ in (−1, 0), beyond
//! either end and off the real axis change only at the real roots in s of
//!
//! ```text
//!     f(0, s)  (det B det C = 0),     f(−1, s)  (det A det D = 0),     disc f(·, s)  (two μ meet).
//! ```
//!
//! Between two of them multiplicities stay what they are, and where μ are multiple throughout, f(S) = 0 is asked for: then S is
//! diagonalizable for all s, and Q with it, as no μ is 0 or −1. So the verdict at one point is that of the whole interval
//! between two roots (THEORY sections 10 and 11).
//!
//! Where all potentials commute, S is self-adjoint in the metric of M: μ are real and S is diagonalizable for all s, so f is χ and the
//! discriminant is left out.
//!
//! | file | what |
//! |---|---|
//! | `line` | systems on a line, decoupled |
//! | `half` | the half period on a line modulo a prime; how long and of what degree its invariants are |
//! | `polynomials` | the three polynomials, from their values modulo primes |
//! | `place` | their roots as gaps between neighbouring doubles |

mod half;
mod line;
mod place;
mod polynomials;

use half::Half;
pub(super) use line::Line;
pub(super) use place::Gap;

use crate::error::Result;
use crate::number::Rational;
use crate::system::verdict::limits::Limits;

/// The gaps between doubles from `lo` to `hi` that hold all places where the verdict can change, increasing; `place` takes a double to
/// its s, an increasing map of \[lo, hi\] onto \[0, 1\]. `None` where the polynomials would cost too much or vanish altogether.
///
/// # Errors
/// Where the work is stopped.
pub(super) fn gaps(
    line: &Line,
    ends: (f64, f64),
    place: &(impl Fn(f64) -> Rational + Sync),
    limits: &Limits,
) -> Result<Option<Vec<Gap>>> {
    let mut gaps = Vec::new();
    for part in line.parts().iter().filter(|part| !part.is_constant()) {
        let Some(half) = Half::new(part)? else { return Ok(None) };
        let Some(found) = polynomials::critical(&half, limits)? else { return Ok(None) };
        gaps.extend(place::gaps(&found, ends, place)?);
    }
    Ok(Some(place::united(gaps)))
}
