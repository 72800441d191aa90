//! All bands of a grid, or of one shard of it, in order, on all threads.

use rayon::prelude::*;

use super::band::{Band, Counters, Work, bands};
use super::bases::Bases;
use super::grid::Grid;
use super::products::Products;
use crate::error::{Error, Result};
use crate::verdict::Limits;

/// Part k of n of a map, k = 1..n: every n-th band.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    pub k: u64,
    pub n: u64,
}

impl Shard {
    /// The whole map.
    pub const WHOLE: Shard = Shard { k: 1, n: 1 };
}

/// Bands that are computed before the first of them is handed on, per thread.
const AHEAD: usize = 4;

/// Computes the bands of a shard on `threads` threads (0: as many as there are processors) and hands them on
/// in order: the same bands whatever the threads. `limits` bounds the kicks of a single pair.
///
/// # Errors
/// A budget error, or what `see` returns: then the map ends there.
pub fn for_each_band(
    grid: &Grid,
    products: Products,
    shard: Shard,
    threads: usize,
    limits: &Limits,
    mut see: impl FnMut(u64, Band) -> Result<()>,
) -> Result<Counters> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|cause| Error::io("threads", cause))?;
    let bases = Bases::new(grid);
    let mine: Vec<(u64, (u64, usize))> = (0..).zip(bands(grid)).filter(|(n, _)| n % shard.n == shard.k - 1).collect();
    let mut counters = Counters::default();
    for group in mine.chunks(AHEAD * pool.current_num_threads()) {
        let work = |&(n, columns): &(u64, (u64, usize))| {
            Work::new(grid, &bases, limits, columns).run(products).map(|band| (n, band))
        };
        let done: Vec<(u64, Band)> = pool.install(|| group.par_iter().map(work).collect::<Result<_>>())?;
        for (n, band) in done {
            counters.add(&band.counters);
            see(n, band)?;
        }
    }
    Ok(counters)
}

/// The unstable pairs by the same kernel without its certificate: wrong where rounding says so, and of no use but
/// to tell what certification costs.
#[doc(hidden)]
pub fn uncertified_unstable(grid: &Grid, threads: usize) -> Result<u64> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|cause| Error::io("threads", cause))?;
    let (bases, limits) = (Bases::new(grid), Limits::default());
    let all: Vec<(u64, usize)> = bands(grid).collect();
    let count = |&columns: &(u64, usize)| Work::new(grid, &bases, &limits, columns).uncertified_unstable();
    pool.install(|| all.par_iter().map(count).sum())
}
