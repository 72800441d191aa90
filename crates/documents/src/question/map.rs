//! The verdicts of a grid of step pairs.

use super::asking::{Question, Work, question};
use super::field::StepRange;
use crate::report::document::Document;
use crate::report::map::{self as map_report, MapTally, document};
use crate::report::shape::Schema;
use clocks::map::{self, Band, Grid, Products, Resources, Shard, Store};
use number::{Error, Laurent, Result};

question! {
    /// The verdicts of all pairs of multiples of two spacings in closed ranges.
    #[derive(Default)]
    args struct Map {
        /// The stiffness of the fast force, as 10 or pi^2.
        lambda1 as "X": Laurent,
        /// The stiffness of the slow force, as 2/5 or pi^2/25; may be negative.
        lambda2 as "Y": Laurent,
        /// The spacing of h1, where it differs.
        #[arg(required = false, required_unless_present = "step")]
        step1 as "D1": Laurent | step,
        /// The spacing of h2, where it differs.
        #[arg(required = false, required_unless_present = "step")]
        step2 as "D2": Laurent | step,
        /// The closed range of h1, as 1/100..2/pi.
        h1_range as "LO..HI": StepRange,
        /// The closed range of h2.
        h2_range as "LO..HI": StepRange,
        /// Give the tongue's label m of each growing pair, and its dominant family (a, b).
        #[arg(long)]
        label: bool,
        /// Give the growth rate of each growing pair, and the slow steps until its amplitude is tenfold.
        #[arg(long)]
        growth: bool,
        /// Compute the K-th of N parts only, into the directory of --resume; `kickdrift merge` joins the
        /// parts.
        shard as "K/N": Option<Shard>,
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

    /// That it is no part.
    ///
    /// # Errors
    /// Where it is one.
    pub fn check_whole(&self) -> Result<()> {
        let remedy = "this question is about whole maps: join the parts first";
        self.shard.map_or(Ok(()), |shard| Err(Error::input("shard", shard, remedy)))
    }

    /// Hands on the bands of the map or of its part, in order; those in `store` are not computed again.
    ///
    /// # Errors
    /// As [`map::Map::for_each_band`].
    pub fn each(
        &self,
        grid: &Grid,
        store: Option<&Store>,
        work: &Work,
        mut see: impl FnMut(Band) -> Result<()>,
    ) -> Result<()> {
        let shard = self.shard.unwrap_or(Shard::WHOLE);
        let bar = work.count(shard.pairs(grid), "pairs");
        let resources = Resources { threads: work.threads, limits: work.limits(), ..Resources::default() };
        let task = map::Map::of(grid).with(self.products()).shard(shard).within(resources);
        let task = match store {
            Some(store) => task.kept_in(store),
            None => task,
        };
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
    const EXAMPLES: &'static [&'static str] = &[
        "map --lambda1 pi^2 --lambda2 1/3 --step 1/20 --h1-range 1/20..2/pi --h2-range 1/20..7/2",
        "map --lambda1 1 --lambda2 1/9 --step 1/9 --h1-range 1..2 --h2-range 1..9 --output map.pdf",
    ];
    const USAGE: Option<&'static str> =
        Some("--lambda1 <X> --lambda2 <Y> --step <D> --h1-range <LO..HI> --h2-range <LO..HI>");
    type Answer = MapTally;

    fn schema() -> Option<Schema> {
        Some(map_report::schema())
    }

    fn answer(&self, work: &Work) -> Result<MapTally> {
        self.check_whole()?;
        let (grid, mut tally) = (self.grid()?, MapTally::default());
        self.each(&grid, None, work, |band| {
            tally.add(&grid, &band);
            Ok(())
        })?;
        Ok(tally)
    }

    fn show(&self, tally: &MapTally) -> Document {
        document(tally, None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::question::Fields;

    #[test]
    fn one_spacing_stands_for_both_steps_that_have_none_of_their_own() {
        let mut input = serde_json::json!({"lambda1": "1", "lambda2": "1/9", "step": "1/2", "step2": "1/3",
            "h1_range": "1..2", "h2_range": "1..2"});
        let read = |input: &serde_json::Value| Map::read(input.as_object().unwrap());
        let map = read(&input).unwrap();
        assert_eq!([map.step1.to_string(), map.step2.to_string()], ["1/2", "1/3"]);
        // Documents name each.
        let echoed: Vec<&str> = map.input().iter().map(|(name, _)| *name).collect();
        assert_eq!(echoed, ["lambda1", "lambda2", "step1", "step2", "h1_range", "h2_range"]);
        input["step3"] = "1".into();
        assert_eq!(read(&input).unwrap_err().field(), "step3");
    }
}
