//! Maps: the verdicts of a grid of pairs, every one certified; labels and growth on request.
//!
//! A grid is all pairs (i d1, j d2) in a window. Its pairs are grouped into *bands* of columns (of equal h1);
//! within a band pairs with equal numbers of updates run side by side through the filter of
//! [`crate::verdict`], with tables of the base clock's turns made once a column and once a row. What the
//! filter cannot certify goes up the ladder as any single pair does. Bands come in order and depend on the
//! grid alone, not on threads, shards or the machine.
//!
//! [`Map`] computes all of it into one vector, into a slice, or band by band; [`Pairs`] are
//! pairs that lie on no grid.

mod band;
mod bases;
mod cost;
mod gcd;
mod grid;
mod grow;
mod growth;
mod pairs;
mod products;
mod resources;
mod run;
mod scattered;
mod shard;
mod store;
mod work;

pub use band::{Band, Counters};
pub use grid::Grid;
pub use number::Interval as Enclosure;
pub use pairs::Pairs;
pub use products::{Growing, Products};
pub use resources::Resources;
pub use run::{Map, merge, uncertified_unstable};
pub use shard::Shard;
pub use store::Store;

#[doc(hidden)]
pub use number::vector::instructions::names as instruction_sets;
