//! All bands of a grid, or of one shard of it, in order, on all threads.

use super::band::{Band, Counters, Work, bands};
use super::bases::Bases;
use super::grid::Grid;
use super::products::Products;
use super::store::Store;
use crate::error::{Error, Result};
use crate::parallel::*;
use crate::verdict::Limits;

/// Part k of n of a map, k = 1..n: every n-th band.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    k: u64,
    n: u64,
}

impl Shard {
    /// The whole map.
    pub const WHOLE: Shard = Shard { k: 1, n: 1 };

    /// Part k of n.
    ///
    /// # Errors
    /// Unless 1 ≤ k ≤ n.
    pub fn new(k: u64, n: u64) -> Result<Shard> {
        if 1 <= k && k <= n {
            return Ok(Shard { k, n });
        }
        Err(Error::input("shard", format!("{k}/{n}"), "the parts of n are 1/n, 2/n, ..., n/n"))
    }
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
    let pool = Pool::new(threads)?;
    let bases = Bases::new(grid);
    let work = |&(n, columns): &Numbered| Ok((n, Work::new(grid, &bases, limits, columns).run(products)?));
    in_order(&pool, &shard.bands(grid), work, &mut see)
}

/// A band's number and its columns.
type Numbered = (u64, (u64, usize));

impl Shard {
    fn bands(self, grid: &Grid) -> Vec<Numbered> {
        (0..).zip(bands(grid)).filter(|(n, _)| n % self.n == self.k - 1).collect()
    }

    /// The number of pairs in this part of the grid.
    pub fn pairs(self, grid: &Grid) -> u64 {
        self.bands(grid).iter().map(|(_, (_, columns))| *columns as u64 * grid.shape().1 as u64).sum()
    }
}

/// A few bands at a time on all threads, handed on in order.
fn in_order(
    pool: &Pool,
    bands: &[Numbered],
    work: impl Fn(&Numbered) -> Result<(u64, Band)> + Sync,
    see: &mut impl FnMut(u64, Band) -> Result<()>,
) -> Result<Counters> {
    let mut counters = Counters::default();
    for group in bands.chunks(AHEAD * pool.size()) {
        let done: Vec<(u64, Band)> = pool.install(|| group.par_iter().map(&work).collect::<Result<_>>())?;
        for (n, band) in done {
            counters.add(&band.counters);
            see(n, band)?;
        }
    }
    Ok(counters)
}

/// As [`for_each_band`], but bands that the store holds are taken from there and new ones are put there: interrupted
/// work goes on where it stopped and ends the same; a kill loses the bands under way.
///
/// # Errors
/// As [`for_each_band`], and where a band cannot be written.
pub fn resume(
    grid: &Grid,
    products: Products,
    shard: Shard,
    threads: usize,
    limits: &Limits,
    store: &Store,
    mut see: impl FnMut(u64, Band) -> Result<()>,
) -> Result<Counters> {
    let pool = Pool::new(threads)?;
    let bases = Bases::new(grid);
    let obtain = |&(n, columns): &Numbered| match store.load(n) {
        Some(band) => Ok((n, band)),
        None => {
            let band = Work::new(grid, &bases, limits, columns).run(products)?;
            store.save(n, &band).map(|()| (n, band))
        }
    };
    in_order(&pool, &shard.bands(grid), obtain, &mut see)
}

/// Joins the bands that the shards of a map have put into the stores: those of one run, in order.
///
/// # Errors
/// An input error that names the first band which no store holds.
pub fn merge(
    grid: &Grid,
    stores: &[Store],
    mut see: impl FnMut(u64, Band) -> Result<()>,
) -> Result<Counters> {
    let mut counters = Counters::default();
    for (n, (first, _)) in (0..).zip(bands(grid)) {
        let missing = || {
            Error::input(
                "parts",
                format!("band {n} from h1 = {}", grid.h1(first)),
                "is in no part: run its shard",
            )
        };
        let band = stores.iter().find_map(|store| store.load(n)).ok_or_else(missing)?;
        counters.add(&band.counters);
        see(n, band)?;
    }
    Ok(counters)
}

/// The unstable pairs by the same kernel without its certificate: wrong where rounding says so, and of no use but
/// to tell what certification costs.
#[doc(hidden)]
pub fn uncertified_unstable(grid: &Grid, threads: usize) -> Result<u64> {
    let pool = Pool::new(threads)?;
    let (bases, limits) = (Bases::new(grid), Limits::default());
    let all: Vec<(u64, usize)> = bands(grid).collect();
    let count = |&columns: &(u64, usize)| Work::new(grid, &bases, &limits, columns).uncertified_unstable();
    pool.install(|| all.par_iter().map(count).sum())
}
