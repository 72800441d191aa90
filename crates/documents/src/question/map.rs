//! The verdicts of a grid of step pairs.

use super::asking::{Question, Work, question};
use super::field::StepRange;
use crate::report::document::Document;
use crate::report::map::{self as map_report, MapTally, document};
use crate::report::shape::Schema;
use clocks::map::{self, Band, Grid, Products, Resources, Shard};
use number::Laurent;
use number::error::{Error, Result};

question! {
    /// The verdicts of all pairs of multiples of two spacings in closed ranges.
    #[derive(Default)]
    struct Map {
        /// The stiffness of the fast force, 1/time².
        lambda1: Laurent,
        /// The stiffness of the slow force.
        lambda2: Laurent,
        /// The spacing of h1.
        step1: Laurent,
        /// The spacing of h2.
        step2: Laurent,
        /// The closed range of h1.
        h1_range: StepRange,
        /// The closed range of h2.
        h2_range: StepRange,
        /// Labels and dominant families of growing pairs.
        label: bool,
        /// Growth rates of growing pairs.
        growth: bool,
        /// The K-th of N parts, where the map is not whole.
        shard: Option<Shard>,
    }
}

impl Map {
    /// The grid.
    ///
    /// # Errors
    /// As [`Grid::new`].
    pub fn grid(&self) -> Result<Grid> {
        let Map { lambda1, lambda2, step1, step2, h1_range, h2_range, .. } = self.clone();
        Grid::new(lambda1, lambda2, [step1, step2], h1_range, h2_range)
    }

    /// The question about the verdicts of these pairs alone.
    #[must_use]
    pub fn bare(&self) -> Map {
        Map { label: false, growth: false, shard: None, ..self.clone() }
    }

    /// The products beside the verdicts.
    pub fn products(&self) -> Products {
        Products { label: self.label, growth: self.growth }
    }

    /// Hands on the bands of the whole map, in order.
    ///
    /// # Errors
    /// A map that is not whole, and as [`map::Map::for_each_band`].
    pub fn each(&self, grid: &Grid, work: &Work, mut see: impl FnMut(Band) -> Result<()>) -> Result<()> {
        if let Some(shard) = self.shard {
            return Err(Error::input(
                "shard",
                shard,
                "this question is about whole maps: join the parts first",
            ));
        }
        let bar = work.count(grid.pairs(), "pairs");
        let resources = Resources { threads: work.threads, limits: work.limits(), ..Resources::default() };
        let task = map::Map::of(grid).with(self.products()).within(resources);
        let see = |_, band: Band| {
            let pairs = band.counters.pairs;
            see(band)?;
            bar.advance(pairs);
            Ok(())
        };
        task.for_each_band(see).map(drop)
    }
}

impl Map {
    /// The parameters below its figure: stiffnesses, ranges, spacings.
    pub fn foot(&self) -> plot::Foot {
        let clocks = [
            (1, &self.lambda1, &self.h1_range, &self.step1),
            (2, &self.lambda2, &self.h2_range, &self.step2),
        ];
        clocks.into_iter().fold(plot::Foot::default(), |foot, (n, lambda, (lo, hi), step)| {
            foot.value(&format!("*Λ*_{n}"), lambda).grid(&format!("*h*_{n}"), [lo, hi, step])
        })
    }
}

impl Question for Map {
    const NAME: &'static str = "map";
    type Answer = MapTally;

    fn schema() -> Option<Schema> {
        Some(map_report::schema())
    }

    fn answer(&self, work: &Work) -> Result<MapTally> {
        let (grid, mut tally) = (self.grid()?, MapTally::default());
        self.each(&grid, work, |band| {
            tally.add(&grid, &band);
            Ok(())
        })?;
        Ok(tally)
    }

    fn show(&self, tally: &MapTally) -> Document {
        document(tally, None)
    }
}
