//! Stiffnesses of several masses that involve π.

use std::collections::BTreeMap;

use super::document::{Document, PotentialDocument, ends};
use super::part::Number;
use number::{Laurent, Result};
use systems::{BesidePi, PiPotential, Symmetric, beside_pi};

impl Document {
    /// The system with a rational in the place of π, where stiffnesses involve it; `None` where all numbers
    /// are rational.
    pub fn beside_pi(&self, mass: Symmetric) -> Result<Option<BesidePi>> {
        let n = mass.size();
        let potentials = self
            .potentials()?
            .iter()
            .enumerate()
            .map(|(k, potential_document)| potential_document.with_pi(k, n));
        let potentials = potentials.collect::<Result<Vec<_>>>()?;
        if potentials
            .iter()
            .flat_map(|potential| potential.stiffness.values())
            .all(|x| x.as_rational().is_some())
        {
            return Ok(None);
        }
        beside_pi(mass, &potentials).map(Some)
    }
}

impl PotentialDocument {
    /// Springs and matrix on n degrees of freedom over ℚ\[π, 1/π\], with the clock.
    fn with_pi(&self, k: usize, n: usize) -> Result<PiPotential> {
        let field = |name: &str| format!("potentials[{k}].{name}");
        let mut stiffness = BTreeMap::new();
        let mut add = |i: usize, j: usize, x: Laurent| {
            *stiffness.entry((i.max(j), i.min(j))).or_insert_with(Laurent::default) += x;
        };
        let rows = self.rows(k)?;
        let size = rows.map_or(n, <[_]>::len);
        for (i, row) in numbers(&field("stiffness"), rows.unwrap_or_default())?.iter().enumerate() {
            row[..=i].iter().enumerate().for_each(|(j, x)| add(i, j, x.clone()));
        }
        // A matrix of another size is refused with the system.
        for (s, (i, j, value)) in self.springs.iter().enumerate().filter(|_| size == n) {
            let field = field(&format!("springs[{s}]"));
            let (i, j) = ends(&field, i, j.as_ref(), n)?;
            let value = value.read_laurent(&field)?;
            if let Some(j) = j {
                add(i, j, -value.clone());
                add(j, j, value.clone());
            }
            add(i, i, value);
        }
        if let Some(scale) = &self.scale {
            let scale = scale.read_laurent(&field("scale"))?;
            stiffness.values_mut().for_each(|x| *x = &*x * &scale);
        }
        let [step, phase] = self.step_and_phase(k)?;
        Ok(PiPotential { size, stiffness, step, phase })
    }
}

/// The rows of a symmetric matrix.
fn numbers(field: &str, rows: &[Vec<Number>]) -> Result<Vec<Vec<Laurent>>> {
    let row = |(i, row): (usize, &Vec<Number>)| {
        let entry = |(j, x): (usize, &Number)| x.read_laurent(&format!("{field}[{i}][{j}]"));
        row.iter().enumerate().map(entry).collect::<Result<Vec<_>>>()
    };
    let rows = rows.iter().enumerate().map(row).collect::<Result<Vec<_>>>()?;
    Symmetric::check(field, &rows)?;
    Ok(rows)
}
