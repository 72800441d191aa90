//! Stiffnesses that involve π, by their rational coefficients.

use std::collections::BTreeMap;

use super::document::{Document, Number, PotentialDocument, ends};
use crate::error::Result;
use crate::number::{Laurent, Rational};
use crate::system::{PiPotential, PiSystem, Symmetric};

impl Document {
    /// The system, where stiffnesses involve π; `None` where all numbers are rational.
    pub fn with_pi(&self, mass: Symmetric) -> Result<Option<PiSystem>> {
        let n = mass.size();
        let potentials = self.potentials()?.iter().enumerate().map(|(k, own)| own.with_pi(k, n));
        let potentials = potentials.collect::<Result<Vec<_>>>()?;
        if potentials.iter().flat_map(|own| own.stiffness.keys()).all(|&power| power == 0) {
            return Ok(None);
        }
        PiSystem::new(mass, potentials).map(Some)
    }
}

impl PotentialDocument {
    /// Springs and matrix on n degrees of freedom over ℚ\[π, 1/π\], with the clock.
    fn with_pi(&self, k: usize, n: usize) -> Result<PiPotential> {
        let field = |name: &str| format!("potentials[{k}].{name}");
        let scale = self.scale.as_ref().map(|own| own.read_laurent(&field("scale"))).transpose()?;
        let size = self.stiffness.as_ref().map_or(n, Vec::len);
        let mut stiffness = Coefficients { size, scale, by_power: BTreeMap::new() };
        if let Some(rows) = &self.stiffness {
            stiffness.add_matrix(&field("stiffness"), rows)?;
        }
        // A matrix of another size is refused with the system.
        for (s, (i, j, value)) in self.springs.iter().enumerate().filter(|_| size == n) {
            let field = field(&format!("springs[{s}]"));
            let (i, j) = ends(&field, i, j.as_ref(), n)?;
            stiffness.add(&value.read_laurent(&field)?, |matrix, x| matrix.add_spring(i, j, x));
        }
        let [step, phase] = self.step_and_phase(k)?;
        Ok(PiPotential { stiffness: stiffness.finish(), step, phase })
    }
}

/// K_j by j, while it is being filled.
struct Coefficients {
    size: usize,
    scale: Option<Laurent>,
    by_power: BTreeMap<i32, Symmetric>,
}

impl Coefficients {
    /// Adds what `add` does with a number to the matrices of its terms.
    fn add(&mut self, x: &Laurent, add: impl Fn(&mut Symmetric, &Rational)) {
        let scaled = self.scale.as_ref().map(|scale| scale * x);
        for (power, c) in scaled.as_ref().unwrap_or(x).terms() {
            add(self.by_power.entry(*power).or_insert_with(|| Symmetric::zero(self.size)), c);
        }
    }

    fn add_matrix(&mut self, field: &str, rows: &[Vec<Number>]) -> Result<()> {
        let row = |(i, row): (usize, &Vec<Number>)| {
            let entry = |(j, x): (usize, &Number)| x.read_laurent(&format!("{field}[{i}][{j}]"));
            row.iter().enumerate().map(entry).collect::<Result<Vec<_>>>()
        };
        let rows = rows.iter().enumerate().map(row).collect::<Result<Vec<_>>>()?;
        Symmetric::check(field, &rows)?;
        for (i, row) in rows.iter().enumerate() {
            row[..=i].iter().enumerate().for_each(|(j, x)| self.add(x, |matrix, x| matrix.add(i, j, x)));
        }
        Ok(())
    }

    /// The coefficients that are not 0, or a single 0.
    fn finish(mut self) -> BTreeMap<i32, Symmetric> {
        self.by_power.retain(|_, matrix| !matrix.is_zero());
        if self.by_power.is_empty() {
            self.by_power.insert(0, Symmetric::zero(self.size));
        }
        self.by_power
    }
}
