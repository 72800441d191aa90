//! AVI (Lew, Marsden, Ortiz and West 2003) on levels of elements: those of a level share a clock, and the
//! kick is that of their stiffness, which is symmetric. So the system of these clocks decides.

use super::scheme::{Level, Scheme, SchemeSummary, plain_limit};
use crate::linear::system::System;
use number::Result;

/// Levels of steps of elements, beside the clocks that decide them.
#[derive(Clone, Debug)]
pub struct ElementSteps {
    clocks: System,
    /// Elements.
    size: usize,
    levels: Vec<Level>,
}

impl ElementSteps {
    /// Those of `size` elements, with [`ElementSteps::clocks`].
    ///
    /// # Errors
    /// As [`ElementSteps::substeps`].
    pub fn new(clocks: System, size: usize, levels: Vec<Level>) -> Result<ElementSteps> {
        Level::check(&levels, size)?;
        Ok(ElementSteps { clocks, size, levels })
    }

    /// The system in which the elements of each level kick with their own step.
    pub fn clocks(&self) -> &System {
        &self.clocks
    }

    /// The substeps of each element of `size` in a step.
    ///
    /// # Errors
    /// No level, levels that are no parts of the ones above, indices of `size` or more, too many substeps.
    pub fn substeps(levels: &[Level], size: usize) -> Result<Vec<u32>> {
        Level::check(levels, size)?;
        Ok((0..size).map(|i| Level::substeps_of(levels, i)).collect())
    }

    /// The scheme as answers state it: its levels, and plain leapfrog's limit beside them.
    pub fn summary(&self) -> SchemeSummary {
        SchemeSummary::new(Scheme::Avi, self.size, &self.levels, plain_limit(&self.clocks))
    }
}
