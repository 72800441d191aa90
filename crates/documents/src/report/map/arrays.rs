//! All pairs of a grid as NumPy arrays.
//!
//! | array | type, shape | content |
//! |---|---|---|
//! | `h1`, `h2` | f8 \[columns\], \[rows\] | the doubles nearest to the steps |
//! | `verdict` | u1 \[columns, rows\] | a position in `verdict_names` |
//! | `tier` | u1 \[columns, rows\] | the deciding tier, a position in `tier_names` |
//! | `verdict_names` | S12 \[7\] | kind, and sign of the trace where it is ±2 or beyond |
//! | `tier_names` | S6 \[3\] | filter, refine, exact |
//! | `m`, `a`, `b` | i8 \[columns, rows\] | with labels: m and its dominant family; -1, 0, 0 where there is none, or none was counted within the budget |
//! | `growth_rate` | f8 \[columns, rows\] | with growth: per unit time; NaN unless hyperbolic |
//! | `growth_rate_error` | f8 \[columns, rows\] | with growth: `growth_rate` is off by at most that, proven |

use std::path::{Path, PathBuf};

use super::rows::marked;
use crate::report::npz::{self, Array, Element};
use clocks::map::{Band, Grid, Products};
use clocks::verdict::{Tier, Verdict};
use number::Result;

/// The longest name of a verdict and of a tier.
const VERDICT: usize = 12;
const TIER: usize = 6;

/// The arrays of a map under construction, in the order of the archive.
pub struct MapArrays {
    path: PathBuf,
    steps: Vec<Array>,
    verdict: Array,
    tier: Array,
    names: Vec<Array>,
    labels: Vec<Array>,
    rates: Vec<Array>,
}

impl MapArrays {
    /// For an archive at `path`, without any pair.
    ///
    /// # Errors
    /// An I/O error that names the archive.
    pub fn new(path: &Path, grid: &Grid, products: Products) -> Result<Self> {
        let (columns, rows) = grid.shape();
        let array = |name, element, shape: &[usize]| Array::new(path, name, element, shape);
        let mut steps = vec![array("h1", Element::F64, &[columns])?, array("h2", Element::F64, &[rows])?];
        let each = |(first, last)| first..=last;
        steps[0].put_f64(each(grid.columns()).map(|i| grid.h1(i).to_f64()))?;
        steps[1].put_f64(each(grid.rows()).map(|j| grid.h2(j).to_f64()))?;
        let names: Vec<String> = Verdict::ALL.into_iter().map(name).collect();
        let tiers = Tier::ALL.map(Tier::name);
        let mut legends = vec![
            array("verdict_names", Element::Text(VERDICT), &[names.len()])?,
            array("tier_names", Element::Text(TIER), &[tiers.len()])?,
        ];
        legends[0].put_texts(VERDICT, &names)?;
        legends[1].put_texts(TIER, &tiers)?;
        let of_pairs = |name, element| array(name, element, &[columns, rows]);
        let asked = |wanted: bool, names: &[&'static str], element| -> Result<Vec<Array>> {
            names.iter().filter(|_| wanted).map(|name| of_pairs(name, element)).collect()
        };
        Ok(MapArrays {
            path: path.to_owned(),
            steps,
            verdict: of_pairs("verdict", Element::U8)?,
            tier: of_pairs("tier", Element::U8)?,
            names: legends,
            labels: asked(products.label, &["m", "a", "b"], Element::I64)?,
            rates: asked(products.growth, &["growth_rate", "growth_rate_error"], Element::F64)?,
        })
    }

    /// Appends a band; bands come in order.
    ///
    /// # Errors
    /// An I/O error that names the archive.
    pub fn add(&mut self, grid: &Grid, band: &Band) -> Result<()> {
        self.verdict.put(&band.verdicts)?;
        self.tier.put(&band.tiers)?;
        if self.labels.is_empty() && self.rates.is_empty() {
            return Ok(());
        }
        let pairs = band.verdicts.len();
        let mut labels = [vec![-1; pairs], vec![0; pairs], vec![0; pairs]];
        let mut rates = [vec![f64::NAN; pairs], vec![f64::NAN; pairs]];
        for pair in marked(grid, band) {
            let Some(growing) = pair.growing else { continue };
            let (n, found) = (growing.position as usize, pair.found());
            labels[0][n] = found.m.map_or(-1, |m| m as i64);
            (labels[1][n], labels[2][n]) = found.family.unwrap_or_default();
            if let Some(rate) = found.rate {
                (rates[0][n], rates[1][n]) = (rate.middle(), rate.error());
            }
        }
        for (array, values) in self.labels.iter_mut().zip(labels) {
            array.put_i64(values)?;
        }
        self.rates.iter_mut().zip(rates).try_for_each(|(array, values)| array.put_f64(values))
    }

    /// Writes the archive.
    ///
    /// # Errors
    /// An I/O error that names it.
    pub fn finish(self) -> Result<()> {
        let MapArrays { path, steps, verdict, tier, names, labels, rates } = self;
        let parts = [steps, vec![verdict, tier], names, labels, rates];
        npz::write(&path, parts.into_iter().flatten().collect())
    }
}

fn name(verdict: Verdict) -> String {
    let sign = ["-", "", "+"][(verdict.side() + 1) as usize];
    format!("{}{sign}", verdict.kind().name())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_fit_and_differ() {
        let names: std::collections::BTreeSet<String> = Verdict::ALL.into_iter().map(name).collect();
        assert_eq!(names.len(), Verdict::ALL.len());
        assert_eq!(names.iter().map(String::len).max(), Some(VERDICT));
    }
}
