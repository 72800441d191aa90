//! Tinker: the key file has the innermost step.

use super::evidence::Vocabulary;
use super::lines::{PLAIN, last, lines};
use super::reading::{Engine, MOST_COUNT, Place, Reading, number, scheme, times};
use crate::error::{Error, Result};
use crate::number::Rational;

pub(super) const WORDS: Vocabulary = Vocabulary {
    engine: Engine::Tinker,
    notation: PLAIN,
    words: "respa-inner verbose ewald openmp-threads digits\n\nintegrator parameters",
    plain: |word| word.to_ascii_lowercase(),
    prefixes: &[],
    is_own: |line| {
        line.words.get(1).is_some_and(|word| {
            line.key().eq_ignore_ascii_case("integrator") && word.0.to_ascii_lowercase().ends_with("respa")
        })
    },
    is_whole: false,
};

/// The inner step is dt/n, n = int(dt/inner) + 1 with dt/inner rounded down a little first, so that a multiple gives itself.
pub(super) fn read(text: &str, outer: Option<&Rational>) -> Result<Reading> {
    let lines = lines(text, &PLAIN);
    let integrator = last(&lines, "integrator")
        .map(|line| line.value("integrator").map(|word| word.0))
        .transpose()?
        .unwrap_or("BEEMAN");
    let outer = outer.ok_or_else(|| {
        Error::missing(
            "outer step",
            "a key file has no outer step: give the one that the run is started with",
        )
    })?;
    let mut used = vec![format!("INTEGRATOR {integrator}")];
    if !["RESPA", "BAOABRESPA"].contains(&integrator.to_ascii_uppercase().as_str()) {
        let mut reading = Reading::new(Engine::Tinker, text, scheme(vec![outer.clone()])?);
        (reading.forces, reading.used) = (vec!["all forces".into()], used);
        return Ok(reading);
    }
    let inner = last(&lines, "respa-inner").map(|line| line.value("respa-inner").cloned()).transpose()?;
    let wanted = number("respa-inner", inner.as_ref().map_or("0.25", |word| word.0))?;
    used.push(format!("RESPA-INNER {}", inner.as_ref().map_or("0.25 (the default)", |word| word.0)));
    // In ps Tinker adds 1e-8 to the inner step.
    let epsilon = Rational::new(1.into(), 100_000.into());
    let n = (outer / (wanted + epsilon)).floor().to_integer() + 1u8;
    let n = u64::try_from(&n).ok().filter(|n| *n <= MOST_COUNT);
    let n = n.ok_or_else(|| Error::input("outer step", outer, "is more than a million inner steps"))?;
    let step = outer / times(&Rational::from_integer(1.into()), n);
    let mut reading = Reading::new(Engine::Tinker, text, scheme(vec![step, outer.clone()])?);
    let place = inner.map_or((text.len()..text.len(), Place::Inner("RESPA-INNER")), |(_, range)| {
        (range, Place::Inner(""))
    });
    reading.places = vec![place];
    reading.forces = vec!["valence terms".into(), "nonbonded terms".into()];
    reading.forces.truncate(reading.scheme.steps().len());
    reading.used = used;
    Ok(reading)
}
