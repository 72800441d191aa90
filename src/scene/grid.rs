//! The grid of step pairs as a scene or a command line gives it.

use super::document::{self, Quantity};
use crate::error::{Error, Result};
use crate::map::Grid;
use crate::number::Laurent;
use crate::number::parse::{parse, parse_range};

/// Spacings and closed ranges of h1 and h2, not yet applied to an oscillator.
#[derive(Clone, Debug, PartialEq)]
pub struct GridRange {
    steps: [Laurent; 2],
    ranges: [(Laurent, Laurent); 2],
}

impl GridRange {
    /// Spacings and closed ranges `lo ≤ hi`, as parsed.
    pub fn new(steps: [Laurent; 2], ranges: [(Laurent, Laurent); 2]) -> Self {
        GridRange { steps, ranges }
    }

    /// From the texts of a scene.
    ///
    /// # Errors
    /// A missing spacing, or a text that does not parse.
    pub(super) fn read(grid: &document::Grid) -> Result<Self> {
        let step = |field, own: &Option<Quantity>| match own.as_ref().or(grid.step.as_ref()) {
            Some(text) => parse(field, &text.0),
            None => Err(Error::missing(field, "give the spacing as \"step\", or as \"step1\" and \"step2\"")),
        };
        let steps = [step("grid.step1", &grid.step1)?, step("grid.step2", &grid.step2)?];
        let ranges = [parse_range("grid.h1", &grid.h1.0)?, parse_range("grid.h2", &grid.h2.0)?];
        Ok(GridRange::new(steps, ranges))
    }

    /// The fields by which a document echoes it.
    pub fn given(&self) -> [(&'static str, String); 4] {
        let ([step1, step2], [h1, h2]) = (&self.steps, &self.ranges);
        [
            ("step1", step1.to_string()),
            ("step2", step2.to_string()),
            ("h1_range", shown_range(h1)),
            ("h2_range", shown_range(h2)),
        ]
    }

    /// All pairs of multiples of the spacings in the ranges, for one oscillator.
    ///
    /// # Errors
    /// As [`Grid::new`].
    pub fn of(&self, lambda1: Laurent, lambda2: Laurent) -> Result<Grid> {
        let [h1, h2] = self.ranges.clone();
        Grid::new(lambda1, lambda2, self.steps.clone(), h1, h2)
    }

    /// The spacings of h1 and h2.
    pub fn steps(&self) -> &[Laurent; 2] {
        &self.steps
    }

    /// The ranges of h1 and h2.
    pub fn ranges(&self) -> &[(Laurent, Laurent); 2] {
        &self.ranges
    }
}

/// A closed range as it is written, exactly.
pub fn shown_range<T: std::fmt::Display>((lo, hi): &(T, T)) -> String {
    format!("{lo}..{hi}")
}
