//! Advice: the full period kick by kick in balls of many bits, and the first region by the pivots of its
//! action.
//!
//! The action of a path over the half period, J = Σ |x_j − x_(j−1)|²/τ_j − Σ k_j x_j², is a tridiagonal form;
//! it is positive iff all pivots of its elimination are (Sylvester). That is another route than the strings
//! of the tongues and than the orbits of many clocks.
//!
//! | file | what |
//! |---|---|
//! | `mass` | one mass on its clocks: trace, friction, first region |
//! | `periods` | advice on periods: modes, schemes, pairs |
//! | `row` | a mode at a scheme |
//! | `lever` | levers that would let the step grow |
//! | `direct` | advice on forces that are no gradient: growth by the dense full period |
//! | `molecule` | advice on Hessians: proofs and growth by another route |

mod direct;
mod lever;
mod mass;
mod molecule;
mod periods;
mod row;

use crate::question::{Advised, Safe};
use crate::verify::again::Excluded;
use crate::verify::context::{Context, Outcome};
use crate::verify::kind::Verify;
use number::Result;

impl Verify for Advised {
    const EXCLUDED: &'static [Excluded] = &[
        ("input.file", "a name"),
        ("engine", "the text that it was read from is not part of the document"),
        ("input.constrained", "bonds that are held take no part in the answer"),
    ];

    fn check(&self, safe: &Safe, context: &Context) -> Result<Outcome> {
        match safe {
            Safe::Periods(advice) => periods::check(advice, context),
            Safe::Hessians(pair) => molecule::check(self, &pair.0, &pair.1, context),
            Safe::Direct(pair) => direct::check(&pair.0, &pair.1),
        }
    }
}
