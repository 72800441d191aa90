//! Maps: the verdicts of a grid of pairs, every one certified; labels and growth on request.
//!
//! A grid is all pairs (i d1, j d2) in a window. Its pairs are grouped into *bands* of columns (of equal h1); within
//! a band pairs with equal numbers of updates run side by side through the filter of [`crate::verdict`], with tables
//! of the base clock's turns made once a column and once a row. What the filter cannot certify goes up the ladder
//! as any single pair does. Bands come in order and depend on the grid alone, not on threads, shards or the machine.
//!
//! ```
//! use kickdrift::map::{for_each_band, Grid, Products, Shard};
//! use kickdrift::number::parse::parse;
//! use kickdrift::verdict::Limits;
//! // Figure 1 of the paper with steps of 1/25.
//! let x = |text| parse("x", text).unwrap();
//! let (h1, h2) = ((x("1/25"), x("2/pi")), (x("1/25"), x("7/2")));
//! let grid = Grid::new(x("pi^2"), x("pi^2/25"), [x("1/25"), x("1/25")], h1, h2).unwrap();
//! let mut unstable = 0;
//! let counters = for_each_band(&grid, Products::default(), Shard::WHOLE, 0, &Limits::default(), |_, band| {
//!     unstable += (0..band.verdicts.len()).filter(|&n| !band.decision(n).verdict.is_stable()).count();
//!     Ok(())
//! });
//! assert_eq!((grid.shape(), counters.unwrap().pairs), ((15, 87), 1305));
//! assert!(unstable > 50 && unstable < 300);
//! ```

mod band;
mod bases;
mod gcd;
mod grid;
mod products;
mod run;
mod store;

pub use band::{Band, Counters};
pub use grid::Grid;
pub use products::{Growing, Products};
pub use run::{Shard, for_each_band, merge, resume, uncertified_unstable};
pub use store::Store;
