//! A linear system over ℚ: masses, potentials with their clocks, and what is exact about it before anything
//! is decided.
//!
//! | file | what |
//! |---|---|
//! | `system`, `sparse` | what a system is; symmetric matrices by rows |
//! | `builders`, `mesh` | the usual systems; finite elements |
//! | `frame`, `split` | rigid modes set apart; commuting potentials split |

pub mod builders;
pub(super) mod frame;
pub mod mesh;
pub(super) mod sparse;
pub(super) mod split;
pub(super) mod system;
