//! Where a map's bands come from: computed, resumed, or joined from parts.

use crate::cli::args::Common;
use crate::cli::progress::progress;
use clocks::map::{Band, Grid, Map, Products, Resources, Shard, Store, merge};
use clocks::verdict::Limits;
use number::error::Result;

/// Bands in order.
pub enum Source {
    Computed { shard: Shard, store: Option<Store>, threads: usize, limits: Limits, quiet: bool },
    Joined(Vec<Store>),
}

impl Source {
    /// Bands that are computed as the flags say, kept in a store where there is one.
    pub fn compute(common: &Common, shard: Shard, store: Option<Store>) -> Source {
        let (threads, limits) = (common.threads(), common.limits());
        Source::Computed { shard, store, threads, limits, quiet: common.quiet }
    }

    /// Hands the bands on in order.
    pub fn each(
        &self,
        grid: &Grid,
        products: Products,
        see: &mut dyn FnMut(&Band) -> Result<()>,
    ) -> Result<()> {
        match self {
            Source::Joined(stores) => merge(grid, stores, |_, band| see(&band)).map(drop),
            Source::Computed { shard, store, threads, limits, quiet } => {
                let bar = progress(*quiet, shard.pairs(grid), "pairs");
                let see = |_, band: Band| {
                    see(&band)?;
                    bar.inc(band.counters.pairs);
                    Ok(())
                };
                let resources = Resources { threads: *threads, limits: *limits, ..Resources::default() };
                let whole = Map::of(grid).with(products).shard(*shard).within(resources);
                let done = store.as_ref().map_or(whole, |store| whole.kept_in(store)).for_each_band(see);
                bar.finish_and_clear();
                done.map(drop)
            }
        }
    }
}
