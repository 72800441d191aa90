//! The systems of one number: masses or stiffnesses are linear in it, or in its square (an outer step at fixed ratios: in the old steps all
//! stiffnesses grow with its square). Cells cover a range.

use crate::error::Result;
use crate::number::Rational;
use crate::number::rational::from_f64_exact;
use crate::system::half::compose;
use crate::system::linear::system::System;
use crate::system::vary::between::Cells;
use crate::system::vary::stretches::{Stretch, cover, most_cells};
use crate::system::verdict::measured::Holds;

/// The function in which masses or stiffnesses are linear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::system) enum Linear {
    /// The number x itself.
    Number,
    /// x², x > 0, by which all stiffnesses are multiplied.
    Square,
}

impl Linear {
    fn of(self, x: f64) -> Rational {
        let x = from_f64_exact(x).expect("a finite end of a range");
        match self {
            Linear::Number => x,
            Linear::Square => &x * &x,
        }
    }
}

/// The systems of one number.
pub(in crate::system) struct Family<'a> {
    pub linear: Linear,
    /// The system of a number, or of its square, on which masses or stiffnesses depend linearly, steps fixed.
    pub at: &'a (dyn Fn(&Rational) -> Result<System> + Sync),
}

impl Family<'_> {
    /// The verdicts on all systems with a number in a range, no interval wider than `width` times the larger end missed.
    ///
    /// # Errors
    /// As [`cover`]; where masses and stiffnesses are not linear or steps differ; as `at`.
    pub fn stretches(&self, range: (f64, f64), width: f64) -> Result<Vec<Stretch>> {
        let at = |x: f64| (self.at)(&self.linear.of(x));
        let cells = Cells::new(&at, self.linear == Linear::Square);
        cover(range, width, |lo, hi| self.cell(&cells, lo, hi))
    }

    /// The products that these cost, roughly: those of as many cells as there can be.
    ///
    /// # Errors
    /// As `at`.
    pub fn cost(&self, (lo, hi): (f64, f64), width: f64) -> Result<f64> {
        let [_, middle, _] = self.three(lo, hi)?;
        // The half period with its norms, some eliminations, and rational entries: as measured on bar-resonant.json and chain200.json.
        let entries = middle.clocks().iter().map(|own| own.stiffness.places().count()).sum::<usize>();
        let n = middle.size() as f64;
        let own = 16.0 * compose::cost(&middle) as f64 + 4.0 * n.powi(3) + 8_000.0 * (entries as f64 + n);
        Ok(most_cells((lo, hi), width) * own)
    }

    /// The verdict that a cell proves for all systems in it.
    fn cell(&self, cells: &Cells, lo: f64, hi: f64) -> Result<Holds> {
        let three = self.three(lo, hi)?;
        cells.verdict((lo, hi), three.each_ref())
    }

    /// The systems at both ends and at their mean.
    fn three(&self, lo: f64, hi: f64) -> Result<[System; 3]> {
        let [a, b] = [lo, hi].map(|x| self.linear.of(x));
        let middle = (&a + &b) / Rational::from_integer(2.into());
        let [first, mean, last] = [&a, &middle, &b].map(|x| (self.at)(x));
        Ok([first?, mean?, last?])
    }
}
