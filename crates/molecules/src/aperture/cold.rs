//! Up to which step of its own a bond stays at a temperature.

use num_traits::ToPrimitive;

use super::bond::Bond;
use super::search::{Measurement, hottest_of};
use number::Rational;
use number::error::Result;
use number::parallel::try_map;
use number::rational::to_f64;
use words::method;

/// The first step of velocity Verlet at which a bond is too hot.
#[derive(Clone, Debug, PartialEq)]
pub struct Cold {
    /// The step over the period of the smallest oscillations: it is the same for all masses.
    pub share: f64,
    /// E* there, in kT.
    pub aperture: f64,
    /// What E* is held against, in kT.
    pub level: f64,
    /// In K.
    pub temperature: Rational,
}

/// Steps are looked at from the tenth part of the period on, by four thousandths of it, and from the eighth
/// on, where resonances are strong, by one.
const FIRST: usize = 100;
const STRONG: usize = 125;
const PARTS: usize = 1000;

/// So many steps are measured side by side.
const TOGETHER: usize = 8;

impl Cold {
    /// The first step at which E* is below the logarithm of `seen` independent energies, at a temperature in
    /// K; `None` where there is none up to the linear limit.
    ///
    /// # Errors
    /// Where somebody has stopped the work.
    pub fn of(bond: &Bond, temperature: &Rational, seen: &Rational) -> Result<Option<Cold>> {
        let measurement = Measurement::new(bond, temperature, &method("velocity-verlet")?.word(), None)?;
        let level = hottest_of(seen);
        // Whole fs or their thousandths keep the digits of the steps few.
        let period = measurement.period();
        let unit = Rational::new((period.ceil().to_u64().unwrap_or(u64::MAX)).into(), PARTS.into());
        let step = |n: usize| &unit * Rational::from_integer(n.into());
        let last = measurement.limit.map_or(PARTS, |limit| (limit / to_f64(&unit)).floor() as usize);
        let all: Vec<Rational> = (FIRST..STRONG).step_by(4).chain(STRONG..=last).map(step).collect();
        for steps in all.chunks(TOGETHER) {
            let found = try_map(steps, |step| measurement.aperture_below(step, level))?;
            if let Some((step, aperture)) = steps.iter().zip(found).find_map(|(step, e)| Some((step, e?))) {
                let (share, temperature) = (to_f64(step) / period, temperature.clone());
                return Ok(Some(Cold { share, aperture, level, temperature }));
            }
        }
        Ok(None)
    }
}
