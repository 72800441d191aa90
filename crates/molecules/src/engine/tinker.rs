//! Tinker and Tinker-HP: key files. The outer step is no part of them: it is given when a run starts.
//!
//! Tinker-HP has `DSHORT` and `DINTER` in ps. `RESPA-INNER` is Tinker's: the inner step in fs until version
//! 8, and since version 25 how many of them an outer step has. A value that both could mean is asked for.

use std::ops::Range;

use super::evidence::Vocabulary;
use super::lines::{Line, PLAIN as NOTATION, last, lines};
use super::reading::{Engine, MOST_COUNT, Place, Reading, count, fortran, scheme, times};
use crate::beads::Beads;
use crate::constraint::Constraints;
use number::{Error, Rational, Result};

/// Integrators with one step for all forces.
const PLAIN: [&str; 8] = ["BEEMAN", "VERLET", "BUSSI", "NOSE-HOOVER", "STOCHASTIC", "BAOAB", "OBABO", "BBK"];

/// Integrators of two levels that Tinker alone has, since version 25.
const NEW: [&str; 3] = ["VRESPA", "BRESPA", "SRESPA"];

pub(super) const WORDS: Vocabulary = Vocabulary {
    engine: Engine::Tinker,
    notation: NOTATION,
    words: include_str!("words/tinker.txt"),
    plain: |word| word.to_ascii_lowercase(),
    prefixes: &[],
    is_own: |line| {
        let text = line.words.get(1).map(|word| word.0.to_ascii_uppercase()).unwrap_or_default();
        let lists: [&[&str]; 4] = [&PLAIN, &NEW, &HP_INTEGRATORS, &["RESPA", "GHMC", "RIGIDBODY"]];
        line.key().eq_ignore_ascii_case("integrator")
            && lists.iter().any(|list| list.contains(&text.as_str()))
    },
    is_whole: false,
};

/// Keys that Tinker-HP alone has.
const HP_KEYS: [&str; 12] = [
    "dshort",
    "dinter",
    "polar-alg",
    "polar-algshort",
    "nlupdate",
    "pme-procs",
    "bead-procs",
    "nbeads",
    "masspiston",
    "frictionpiston",
    "tcgorder",
    "mlpot",
];

/// Integrators that Tinker-HP alone has.
const HP_INTEGRATORS: [&str; 4] = ["BBK", "BAOABRESPA", "RESPA1", "BAOABRESPA1"];

/// Keys that Tinker alone has.
const TINKER_KEYS: [&str; 2] = ["respa-inner", "openmp-threads"];

pub(super) fn read(text: &str, outer: Option<&Rational>) -> Result<Reading> {
    let lines = lines(text, &NOTATION);
    let given =
        last(&lines, "integrator").map(|line| line.value("integrator").map(|word| word.0)).transpose()?;
    let integrator = given.map(str::to_ascii_uppercase);
    let has = |keys: &[&str]| keys.iter().any(|key| last(&lines, key).is_some());
    let is_hp =
        has(&HP_KEYS) || integrator.as_deref().is_some_and(|integrator| HP_INTEGRATORS.contains(&integrator));
    if is_hp && has(&TINKER_KEYS) {
        let remedy = "is a key of Tinker beside keys of Tinker-HP: leave out the keys of one of them";
        return Err(Error::input("key file", "RESPA-INNER or OPENMP-THREADS", remedy));
    }
    let outer = outer.ok_or_else(|| {
        let remedy = "a key file has no outer step: give the step of the run, by --steps";
        Error::missing("outer step", remedy)
    })?;
    let engine = if is_hp { Engine::TinkerHp } else { Engine::Tinker };
    let file = Key { text, lines: &lines, outer, engine };
    let mut reading = match integrator.as_deref() {
        None => file.one("BEEMAN or VERLET (the default)")?,
        Some(text) if PLAIN.contains(&text) => file.one(text)?,
        Some("RESPA") if !is_hp => file.inner()?,
        Some(text) if NEW.contains(&text) => file.counted(text)?,
        Some(text @ ("RESPA" | "BAOABRESPA")) => file.short(text)?,
        Some(text @ ("RESPA1" | "BAOABRESPA1")) => file.three(text)?,
        Some(text) => {
            let remedy = "is no integrator whose steps are read here";
            return Err(Error::input("integrator", text, remedy));
        }
    };
    file.molecules(&mut reading);
    Ok(reading)
}

/// A key file, and the step that its run is started with.
struct Key<'a> {
    text: &'a str,
    lines: &'a [Line<'a>],
    outer: &'a Rational,
    engine: Engine,
}

impl Key<'_> {
    fn value(&self, key: &str) -> Result<Option<(&str, Range<usize>)>> {
        last(self.lines, key).map(|line| line.value(key).cloned()).transpose()
    }

    fn reading(&self, steps: Vec<Rational>, forces: &[&str], used: Vec<String>) -> Result<Reading> {
        let mut reading = Reading::new(self.engine, self.text, scheme(steps)?);
        reading.forces = forces.iter().map(ToString::to_string).collect();
        // Where a level takes the step of the next one, its forces do.
        while reading.forces.len() > reading.scheme.steps().len() {
            let first = reading.forces.remove(0);
            reading.forces[0] = format!("{first}, {}", reading.forces[0]);
        }
        reading.used = used;
        Ok(reading)
    }

    fn one(&self, integrator: &str) -> Result<Reading> {
        self.reading(vec![self.outer.clone()], &["all forces"], vec![format!("INTEGRATOR {integrator}")])
    }

    /// So many steps of a level in one of the level above.
    fn part(&self, outer: &Rational, wanted: &Rational) -> Result<u64> {
        // In ps both programs add 1e-8 to the step that is wanted, so that a divisor gives itself.
        let epsilon = Rational::new(1.into(), 100_000.into());
        let n = (outer / (wanted + epsilon)).floor().to_integer() + 1u8;
        let n = u64::try_from(&n).ok().filter(|n| *n <= MOST_COUNT);
        n.ok_or_else(|| Error::input("outer step", outer, "is more than a million inner steps"))
    }

    /// Tinker's `RESPA` with `RESPA-INNER`.
    fn inner(&self) -> Result<Reading> {
        let Some((word, place)) = self.value("respa-inner")? else {
            let remedy = "its default differs: 0.25 fs in Tinker 8, 0.5 fs in Tinker 26, and DSHORT of Tinker-HP. Write RESPA-INNER 0.25 for Tinker 8, \
                          INTEGRATOR BRESPA for Tinker 26, DSHORT 0.00025 (ps) for Tinker-HP";
            return Err(Error::missing("RESPA-INNER", remedy));
        };
        if !word.contains(['.', 'e', 'E', 'd', 'D']) {
            let remedy = format!(
                "is {word} fs in Tinker 8 and {word} inner steps in Tinker 26: write {word}.0 for Tinker 8, INTEGRATOR BRESPA for Tinker 26"
            );
            return Err(Error::input("RESPA-INNER", word, remedy));
        }
        let n = self.part(self.outer, &fortran("RESPA-INNER", word)?)?;
        let step = self.outer / times(&Rational::from_integer(1.into()), n);
        let used = vec!["INTEGRATOR RESPA".into(), format!("RESPA-INNER {word} fs")];
        let mut reading = self.reading(vec![step, self.outer.clone()], &LEVELS, used)?;
        reading.places = vec![(place, Place::Inner)];
        reading.remarks.push(
            "read as Tinker 8 does; Tinker 26 reads no fraction there, and takes inner steps of about 0.5 fs"
                .into(),
        );
        Ok(reading)
    }

    /// `RESPA-INNER` of Tinker 26: how many inner steps an outer one has.
    fn counted(&self, integrator: &str) -> Result<Reading> {
        let given = self.value("respa-inner")?;
        let half = Rational::new(1.into(), 2.into());
        let nearest = (self.outer / &half + &half).floor().to_integer();
        let n = match &given {
            Some((word, _)) => count("RESPA-INNER", word)?,
            None => u64::try_from(&nearest).unwrap_or(MOST_COUNT).clamp(1, MOST_COUNT),
        };
        let step = self.outer / times(&Rational::from_integer(1.into()), n);
        let shown = given.as_ref().map_or_else(|| format!("{n} (the default)"), |(word, _)| (*word).into());
        let used = vec![format!("INTEGRATOR {integrator}"), format!("RESPA-INNER {shown}")];
        let mut reading = self.reading(vec![step, self.outer.clone()], &LEVELS, used)?;
        reading.places =
            given.into_iter().filter(|_| n > 1).map(|(_, place)| (place, Place::LastRatio)).collect();
        Ok(reading)
    }

    /// `DSHORT` of Tinker-HP, in fs.
    fn picoseconds(&self, key: &str, default: Option<&str>) -> Result<(Rational, String)> {
        let given = self.value(key)?;
        let shown = match (&given, default) {
            (Some((word, _)), _) => format!("{key} {word} ps"),
            (None, Some(own)) => format!("{key} {own} ps (the default)"),
            (None, None) => {
                let remedy = "its default is 0.00025 ps in Tinker-HP 1.2 and 0.001 ps in its version for GPUs: write it";
                return Err(Error::missing(key, remedy));
            }
        };
        let word = given.map(|(word, _)| word).or(default).unwrap_or_default();
        Ok((fortran(key, word)? * Rational::from_integer(1000.into()), shown))
    }

    /// `RESPA` and `BAOABRESPA` of Tinker-HP.
    fn short(&self, integrator: &str) -> Result<Reading> {
        let (wanted, shown) = self.picoseconds("DSHORT", None)?;
        let n = self.part(self.outer, &wanted)?;
        let step = self.outer / times(&Rational::from_integer(1.into()), n);
        let used = vec![format!("INTEGRATOR {integrator}"), shown];
        self.reading(vec![step, self.outer.clone()], &LEVELS, used)
    }

    /// `RESPA1` and `BAOABRESPA1` of Tinker-HP: three levels.
    fn three(&self, integrator: &str) -> Result<Reading> {
        let (middle, dinter) = self.picoseconds("DINTER", Some("0.002"))?;
        let (short, dshort) = self.picoseconds("DSHORT", Some("0.00025"))?;
        // The innermost step is counted in the step that was wanted, and taken of the one that there is.
        let (outer, inner) = (self.part(self.outer, &middle)?, self.part(&middle, &short)?);
        let one = Rational::from_integer(1.into());
        let middle = self.outer / times(&one, outer);
        let steps = vec![&middle / times(&one, inner), middle, self.outer.clone()];
        let forces = ["valence terms", "short-range nonbonded terms", "the rest of the nonbonded terms"];
        self.reading(steps, &forces, vec![format!("INTEGRATOR {integrator}"), dinter, dshort])
    }

    /// Bonds that are held, masses of hydrogens, rings of beads.
    fn molecules(&self, reading: &mut Reading) {
        for key in ["rattle", "freeze"] {
            let Some(line) = last(self.lines, key) else { continue };
            let how = line.words.get(1).map(|word| word.0.to_ascii_uppercase());
            match how.as_deref() {
                None => reading.constraints = Some(Constraints::HBonds),
                Some("BONDS" | "ANGLES") => reading.constraints = Some(Constraints::AllBonds),
                Some(own) => {
                    let remark =
                        format!("{} {own} holds some bonds: say by --constraints which", key.to_uppercase());
                    reading.remarks.push(remark);
                    continue;
                }
            }
            reading
                .used
                .push(format!("{} {}", key.to_uppercase(), how.as_deref().unwrap_or("")).trim().into());
        }
        if let Some(line) = last(self.lines, "heavy-hydrogen") {
            let value = line.words.get(1).and_then(|word| fortran("heavy-hydrogen", word.0).ok());
            let shown = value.map_or_else(|| "4".into(), |value| crate::unit::decimal(&value));
            reading.remarks.push(format!("HEAVY-HYDROGEN was not read: hydrogens have up to {shown} amu, and no more than the equal share of a group: say so by --hmr"));
        }
        if let Some((beads, _)) = self.value("nbeads").ok().flatten().filter(|(beads, _)| *beads != "1") {
            reading.beads = beads.parse().ok().map(|count| Beads { count, kelvin: None });
            reading.remarks.push(format!("{beads} beads: the modes of their rings vibrate beside yours"));
        }
    }
}

const LEVELS: [&str; 2] = ["valence terms", "nonbonded terms"];
