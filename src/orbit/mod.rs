//! Orbits followed through the half period with proven bounds.
//!
//! Three ways, cheapest first. [`filter`] goes from kick to kick of one clock in doubles, in the [`floquet`]
//! coordinates of the other, one pair or many side by side; [`plain`] takes kick after kick in doubles, where there are
//! no such coordinates; [`refine`] takes kick after kick in as many bits as it takes. All of them rest on the theorem
//! of [`bound`]. [`residue`] proves that no entry of the half period is zero.

mod bound;
mod certificate;
pub mod filter;
pub mod floquet;
mod kernel;
pub mod plain;
pub mod refine;
pub mod residue;
mod winding;
