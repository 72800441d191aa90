//! One oscillator whose mass, stiffnesses or steps involve π: K clocks over ℚ\[π\].

use num_traits::Zero;

use super::document::{Document, PotentialDocument, ends};
use super::given::Given;
use number::{Error, ExactSign, Laurent, Rational, Result, Sign};
use systems::Oscillator;

impl Document {
    /// `None` unless the file is of one mass and some number of it is irrational.
    pub fn oscillator(&self) -> Result<Option<Oscillator>> {
        let (Some(Given::Here(masses)), Ok(potentials)) = (&self.masses, self.potentials()) else {
            return Ok(None);
        };
        let [mass] = &masses[..] else { return Ok(None) };
        if potentials.iter().any(|p| !p.bonds.is_empty()) {
            return Ok(None);
        }
        let mass = mass.read_laurent("masses[0]")?;
        let read = potentials.iter().enumerate().map(|(k, p)| p.clock(k));
        let clocks = read.collect::<Result<Vec<_>>>()?;
        let all = clocks.iter().flat_map(|(step, _, stiffness)| [step, stiffness]).chain([&mass]);
        if all.map(Laurent::as_rational).all(|x| x.is_some()) {
            return Ok(None);
        }
        Oscillator::new(mass, clocks).map(Some)
    }
}

impl PotentialDocument {
    /// Step, phase and stiffness on one degree of freedom.
    fn clock(&self, k: usize) -> Result<(Laurent, Rational, Laurent)> {
        let field = |name: &str| format!("potentials[{k}].{name}");
        let mut stiffness = match self.rows(k)? {
            None => Laurent::zero(),
            Some([row]) if row.len() == 1 => row[0].read_laurent(&field("stiffness[0][0]"))?,
            Some(rows) => {
                let size = format!("{} rows", rows.len());
                return Err(Error::input(
                    &field("stiffness"),
                    size,
                    "there is 1 degree of freedom: give [[k]]",
                ));
            }
        };
        for (s, (i, j, value)) in self.springs.iter().enumerate() {
            let field = field(&format!("springs[{s}]"));
            ends(&field, i, j.as_ref(), 1)?;
            stiffness += value.read_laurent(&field)?;
        }
        if let Some(scale) = &self.scale {
            stiffness *= scale.read_laurent(&field("scale"))?;
        }
        let step = self.step.read_laurent(&field("step"))?;
        if step.sign() != Sign::Positive {
            return Err(Error::input(&field("step"), step, "a step must be positive"));
        }
        let phase = self.phase.as_ref().map_or(Ok(Rational::zero()), |phase| phase.read(&field("phase")))?;
        if !phase.is_zero() && phase != Rational::new(1.into(), 2.into()) {
            return Err(Error::input(&field("phase"), phase, "must be 0 or 1/2"));
        }
        Ok((step, phase, stiffness))
    }
}
