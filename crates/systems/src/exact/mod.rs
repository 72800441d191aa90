//! Verdicts in exact arithmetic over ℚ: nothing is left open.
//!
//! | file | what |
//! |---|---|
//! | `integers` | the half period in integers |
//! | `modular`, `roots` | characteristic polynomials by prime fields; their roots counted |
//! | `decide` | the verdict, with its cost before it begins |
//! | `refined` | the roots themselves, to as many digits as growth asks for |

pub(super) mod decide;
pub(super) mod integers;
pub(super) mod modular;
pub(super) mod refined;
pub(super) mod roots;
