//! The trace against the predictions: over a grid, or over ratios.

use super::asking::{Question, Work, question};
use super::field::StepRange;
use super::map::Map;
use super::ratios::{MOST_SUM, Ratios};
use crate::error::{Error, Result};
use crate::map::Grid;
use crate::number::{Laurent, Rational};
use crate::report::compare;
use crate::report::document::Document;
use crate::resonance::compare::{Comparisons, compare_ratios};

question! {
    /// The trace verdict against the tan criterion and against resonance: over a grid with both stiffnesses, or over all coprime
    /// p + q up to a sum at s = 4 k/(samples + 1).
    struct Compare {
        /// How near q h2 must be to a multiple of T½ to count as resonant, in units of T½.
        tolerance: Rational = "1/20",
        /// The stiffness of the fast force, with a grid.
        lambda1: Option<Laurent>,
        /// That of the slow force.
        lambda2: Option<Laurent>,
        /// The spacing of h1.
        step1: Option<Laurent>,
        /// The spacing of h2.
        step2: Option<Laurent>,
        /// The closed range of h1.
        h1_range: Option<StepRange>,
        /// The closed range of h2.
        h2_range: Option<StepRange>,
        /// In place of a grid: all coprime p + q up to this number.
        max_sum: Option<u64>,
        /// λ2/λ1, with a sum.
        rho: Option<Rational>,
        /// Values of s, evenly spaced inside 0 < s < 4, with a sum.
        samples: Option<u64>,
    }
}

/// What is compared.
pub enum Over {
    /// All pairs of a grid.
    Grid(Grid),
    /// All coprime p + q up to a sum.
    Ratios { max_sum: u64, rho: Rational, samples: u64 },
}

impl Compare {
    /// The comparison over the grid of a map.
    pub fn over_grid(map: Map, tolerance: Rational) -> Compare {
        let Map { lambda1, lambda2, step1, step2, h1_range, h2_range, .. } = map;
        let [lambda1, lambda2, step1, step2] = [lambda1, lambda2, step1, step2].map(Some);
        let [h1_range, h2_range] = [h1_range, h2_range].map(Some);
        let (max_sum, rho, samples) = (None, None, None);
        Compare { tolerance, lambda1, lambda2, step1, step2, h1_range, h2_range, max_sum, rho, samples }
    }

    /// The comparison over all coprime p + q up to a sum.
    pub fn over_ratios(max_sum: u64, rho: Rational, samples: u64, tolerance: Rational) -> Compare {
        let (max_sum, rho, samples) = (Some(max_sum), Some(rho), Some(samples));
        let (lambda1, lambda2, step1, step2, h1_range, h2_range) = (None, None, None, None, None, None);
        Compare { tolerance, lambda1, lambda2, step1, step2, h1_range, h2_range, max_sum, rho, samples }
    }

    /// What is said of a question that is neither, or both.
    pub fn mixed() -> Error {
        let remedy =
            "give --lambda1, --lambda2 and a grid (--step, --h1-range, --h2-range), or --max-sum and --rho";
        Error::input("flags", "incomplete or mixed", remedy)
    }

    /// The pairs that are compared.
    ///
    /// # Errors
    /// Neither a whole grid nor a sum with ρ, or parts of both; whatever [`Grid::new`] refuses.
    pub fn pairs(&self) -> Result<Over> {
        let Compare { lambda1, lambda2, step1, step2, h1_range, h2_range, max_sum, rho, samples, .. } = self;
        match (lambda1, lambda2, step1, step2, h1_range, h2_range, max_sum, rho) {
            (Some(lambda1), Some(lambda2), Some(step1), Some(step2), Some(h1), Some(h2), None, None)
                if samples.is_none() =>
            {
                let steps = [step1.clone(), step2.clone()];
                Grid::new(lambda1.clone(), lambda2.clone(), steps, h1.clone(), h2.clone()).map(Over::Grid)
            }
            (None, None, None, None, None, None, Some(max_sum), Some(rho)) => {
                Ratios::UpTo(*max_sum).within(MOST_SUM)?;
                Ok(Over::Ratios { max_sum: *max_sum, rho: rho.clone(), samples: samples.unwrap_or(99) })
            }
            _ => Err(Compare::mixed()),
        }
    }
}

impl Question for Compare {
    const NAME: &'static str = "compare";
    type Answer = Comparisons;

    fn answer(&self, work: &Work) -> Result<Comparisons> {
        match self.pairs()? {
            Over::Grid(grid) => grid.compare(&self.tolerance, &work.limits()),
            Over::Ratios { max_sum, rho, samples } => {
                compare_ratios(max_sum, &rho, samples, &self.tolerance, &work.limits())
            }
        }
    }

    fn show(&self, answer: &Comparisons) -> Document {
        let places = if self.max_sum.is_some() { ["s", "rho"] } else { ["h1", "h2"] };
        compare::document(answer, &self.tolerance, places)
    }
}
