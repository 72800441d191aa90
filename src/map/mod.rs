//! Maps: the verdicts of a grid of pairs, every one certified.

mod band;
mod bases;
mod gcd;
mod grid;
mod products;
mod run;

pub use band::{Band, Counters};
pub use grid::Grid;
pub use products::{Growing, Products};
pub use run::{Shard, for_each_band, uncertified_unstable};
