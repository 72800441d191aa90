//! All bands of a grid, or of one shard of it, in order, on all threads.

use super::band::{Band, Counters};
use super::bases::Bases;
use super::cost::allow;
use super::grid::Grid;
use super::products::Products;
use super::resources::Resources;
use super::shard::{Numbered, Shard, bands};
use super::store::Store;
use super::work::Work;
use crate::verdict::Verdict;
use number::error::{filled, room};
use number::parallel::{map, try_map};
use number::{Error, Result};

/// A grid whose pairs are to be decided, and what else is asked of them.
///
/// ```
/// use kickdrift_clocks::map::{Grid, Map};
/// use kickdrift_clocks::number::parse::parse;
/// // Figure 1 of the paper with steps of 1/25.
/// let x = |text| parse("x", text).unwrap();
/// let (h1, h2) = ((x("1/25"), x("2/pi")), (x("1/25"), x("7/2")));
/// let grid = Grid::new(x("pi^2"), x("pi^2/25"), [x("1/25"), x("1/25")], h1, h2).unwrap();
/// let verdicts = Map::of(&grid).verdicts().unwrap();
/// assert_eq!((grid.shape(), verdicts.len()), ((15, 87), 1305));
/// let unstable = verdicts.iter().filter(|verdict| !verdict.is_stable()).count();
/// assert!(unstable > 50 && unstable < 300);
/// ```
#[derive(Clone, Copy, Debug)]
#[must_use]
pub struct Map<'a> {
    grid: &'a Grid,
    products: Products,
    shard: Shard,
    resources: Resources<'a>,
    store: Option<&'a Store>,
}

impl<'a> Map<'a> {
    /// The verdicts of the whole grid and nothing else, with the default resources.
    pub fn of(grid: &'a Grid) -> Self {
        let (products, resources) = (Products::default(), Resources::default());
        Map { grid, products, shard: Shard::WHOLE, resources, store: None }
    }

    /// Asks for these products beside the verdicts.
    pub fn with(self, products: Products) -> Self {
        Map { products, ..self }
    }

    /// This part of it only.
    pub fn shard(self, shard: Shard) -> Self {
        Map { shard, ..self }
    }

    /// Limits the work to these resources.
    pub fn within(self, resources: Resources<'a>) -> Self {
        Map { resources, ..self }
    }

    /// Uses a store for the bands: those that the store holds are taken from there, new ones are put there.
    /// Interrupted work goes on where it stopped and gives the same result; a kill loses the bands under way.
    pub fn kept_in(self, store: &'a Store) -> Self {
        Map { store: Some(store), ..self }
    }

    /// That the map as a whole is within the budget: for whoever makes room for its pairs before the work.
    ///
    /// # Errors
    /// A budget error that states the cost.
    pub fn allow(&self) -> Result<()> {
        allow(self.grid, self.shard, &self.resources.limits)
    }

    /// Computes the bands and hands them on in order with their numbers: the same bands whatever the threads.
    ///
    /// # Errors
    /// A budget error, before the work begins where the map as a whole exceeds it; `Stopped`; an I/O error
    /// where a band cannot be stored; or what `see` returns: then the map ends there.
    pub fn for_each_band(&self, mut see: impl FnMut(u64, Band) -> Result<()>) -> Result<Counters> {
        self.allow()?;
        let Map { grid, products, shard, resources, store } = self;
        let (pool, bases) = (resources.pool()?, Bases::new(grid));
        let bands = shard.bands(grid);
        let widest = bands.clone().map(|(_, (_, columns))| columns).max().unwrap_or(0);
        let bytes = pool.size() as u128 * Work::bytes(grid, &bases, widest);
        room(bytes, "fewer threads, a larger step2 or a smaller h2-range")?;
        let compute = |columns| {
            resources.go_on()?;
            let work = Work::new(grid, &bases, resources, columns);
            let mut band = work.run()?;
            if products.growing() {
                work.grow(&mut band, *products)?;
            }
            Ok(band)
        };
        let obtain = |&(n, columns): &Numbered| match store.and_then(|store| store.load(n)) {
            Some(band) => Ok((n, band)),
            None => {
                let band = compute(columns)?;
                store.map_or(Ok(()), |store| store.save(n, &band)).map(|()| (n, band))
            }
        };
        let mut counters = Counters::default();
        let mut bands = bands.peekable();
        while bands.peek().is_some() {
            let group: Vec<Numbered> = bands.by_ref().take(AHEAD * pool.size()).collect();
            let done = pool.install(|| try_map(&group, obtain))?;
            for (n, band) in done {
                counters.add(&band.counters);
                see(n, band)?;
            }
        }
        Ok(counters)
    }

    /// The verdicts, column by column, in each by increasing row: that of (i, j) in a grid of r rows, counted
    /// from the first ones, is at i r + j.
    ///
    /// # Errors
    /// As [`Map::for_each_band`].
    pub fn verdicts(&self) -> Result<Vec<Verdict>> {
        self.allow()?;
        let mut verdicts = filled(Verdict::ALL[0], self.shard.pairs(self.grid))?;
        self.fill(&mut verdicts, |_| {})?;
        Ok(verdicts)
    }

    /// Writes all verdicts into a slice, one for each pair; `progress` is called with the number of pairs
    /// done.
    ///
    /// # Errors
    /// As [`Map::for_each_band`], and where the slice has another length.
    pub fn fill(&self, verdicts: &mut [Verdict], mut progress: impl FnMut(u64)) -> Result<Counters> {
        let (pairs, mut rest, mut done) = (self.shard.pairs(self.grid), verdicts, 0);
        if rest.len() as u64 != pairs {
            return Err(Error::input("verdicts", rest.len(), format!("the slice must hold {pairs}")));
        }
        self.for_each_band(|_, band| {
            let (verdicts, others) = std::mem::take(&mut rest).split_at_mut(band.verdicts.len());
            rest = others;
            verdicts.iter_mut().zip(&band.verdicts).for_each(|(to, &n)| *to = Verdict::ALL[usize::from(n)]);
            done += verdicts.len() as u64;
            progress(done);
            Ok(())
        })
    }
}

/// Bands that are computed before the first of them is handed on, per thread.
const AHEAD: usize = 4;

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
                "is whole in no part: run its shard",
            )
        };
        let band = stores.iter().find_map(|store| store.load(n)).ok_or_else(missing)?;
        counters.add(&band.counters);
        see(n, band)?;
    }
    Ok(counters)
}

/// The unstable pairs by the same kernel without its certificate: wrong where rounding says so, and of no use
/// but to see what certification costs.
#[doc(hidden)]
pub fn uncertified_unstable(grid: &Grid, threads: usize) -> Result<u64> {
    let (bases, resources) = (Bases::new(grid), Resources { threads, ..Resources::default() });
    let pool = resources.pool()?;
    let all: Vec<(u64, usize)> = bands(grid).collect();
    let count = |&columns: &(u64, usize)| Work::new(grid, &bases, &resources, columns).uncertified_unstable();
    pool.install(|| map(&all, count)).into_iter().sum()
}
