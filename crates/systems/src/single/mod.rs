//! One degree of freedom under any number of clocks.
//!
//! | file | what |
//! |---|---|
//! | `clocks` | K clocks on one oscillator: exact in every ring whose signs are known |
//! | `enclose` | in balls |
//! | `decide` | the verdict, by whichever decides |

pub(super) mod clocks;
pub(super) mod decide;
pub(super) mod enclose;
