//! Orbits followed through the half period with proven bounds.
//!
//! Three ways, cheapest first. [`filter`] goes from kick to kick of one clock in doubles, in the [`floquet`]
//! coordinates of the other, one pair or many side by side ([`strengths`] makes the constants of many);
//! [`plain`] takes kick after kick in doubles, where there are no such coordinates; [`refine`] takes kick
//! after kick in as many bits as it takes, or leaps over long runs of one clock's kicks. All but the leaps
//! rest on the theorem of [`bound`]. [`residue`] proves that no entry of the half period is zero.

mod balls;
mod bound;
mod certificate;
mod ends;
pub mod filter;
pub mod floquet;
pub mod kernel;
pub mod lanes;
mod leap;
pub mod plain;
pub mod refine;
pub mod residue;
pub mod returns;
pub mod strengths;
mod winding;
