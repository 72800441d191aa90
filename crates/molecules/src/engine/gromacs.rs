//! GROMACS: `dt` (ps) is the innermost step; with `mts` the second level kicks every `mts-level2-factor` of
//! them.

use super::evidence::Vocabulary;
use super::lines::{Line, Notation, Word, interval, intervals, last, lines};
use super::reading::{Engine, PS, Place, Reading, count, number, scheme, times};
use crate::constraint::Constraints;
use crate::unit::decimal;
use number::{Error, Rational, Result};

pub(super) const WORDS: Vocabulary = Vocabulary {
    engine: Engine::Gromacs,
    notation: NOTATION,
    words: include_str!("words/gromacs.txt"),
    plain,
    prefixes: &[
        "pull",
        "awh",
        "rot",
        "densityguided",
        "qmmm",
        "colvars",
        "plumed",
        "nnpot",
        "fmm",
        "imd",
        "mimic",
        "adress",
        "gb",
    ],
    is_own: |line| is_integrator(line),
    is_whole: true,
};

const NOTATION: Notation = Notation { comment: ';', equals: true, ends: None, goes_on: None, braces: false };

/// Those that move in steps of time, then those that do not, as grompp compares them.
const INTEGRATORS: [&str; 6] = ["md", "mdvv", "mdvvavek", "sd", "sd2", "bd"];
const TIMELESS: [&str; 7] = ["steep", "cg", "lbfgs", "nm", "tpi", "tpic", "mimic"];

/// The groups that can stand in `mts-level2-forces`.
const GROUPS: [&str; 7] = ["longrange-nonbonded", "nonbonded", "pair", "dihedral", "angle", "pull", "awh"];

/// The hydrogens that `mass-repartition-factor` multiplies, in amu.
const HYDROGEN: &str = "1.008";

/// grompp compares words so.
fn plain(word: &str) -> String {
    word.chars().filter(|c| !matches!(c, '-' | '_')).collect::<String>().to_ascii_lowercase()
}

fn is_integrator(line: &Line) -> bool {
    let known = |word: &Word| INTEGRATORS.iter().chain(&TIMELESS).any(|text| plain(word.0) == *text);
    line.key().eq_ignore_ascii_case("integrator") && line.words.get(1).is_some_and(known)
}

/// The words behind keys, as grompp takes them: a key without one has its default.
struct Keys<'a> {
    lines: Vec<Line<'a>>,
    end: usize,
}

impl<'a> Keys<'a> {
    fn of(text: &'a str) -> Keys<'a> {
        let mut lines = lines(text, &NOTATION);
        lines.retain(|line| line.words.len() > 1);
        Keys { lines, end: text.len() }
    }

    fn word(&self, key: &str) -> Option<Word<'a>> {
        last(&self.lines, key).and_then(|line| line.words.get(1)).cloned()
    }

    /// As grompp compares it.
    fn text(&self, key: &str, default: &str) -> String {
        plain(self.word(key).map_or(default, |word| word.0))
    }

    fn is_on(&self, key: &str) -> Result<bool> {
        match self.text(key, "no").as_str() {
            "yes" | "on" | "true" => Ok(true),
            "no" | "off" | "false" => Ok(false),
            other => Err(Error::input(key, other, "write yes or no")),
        }
    }
}

/// `mdout.mdp` is read like any other text; of a log or `gmx dump`, what grompp understood.
pub(super) fn of_log(text: &str) -> Option<Result<Reading>> {
    let head =
        ["\nInput Parameters:", "\ninputrec:"].iter().find_map(|head| Some(text.find(head)? + head.len()))?;
    let own = &text[head..];
    let end = own.find("\n\n").unwrap_or(own.len());
    // Blocks of other things, as "grpopts:", end what is read.
    let text = &own[..own.find("grpopts:").unwrap_or(end).min(own.len())];
    Some(read(text).map(|mut reading| {
        reading.stays = Some("this is what grompp understood of an .mdp file: change that one".into());
        let bonds = "which bonds are held stands in the .mdp file and the topology alone: say so by --constraints, as h-bonds";
        reading.remarks.push(bonds.into());
        reading
    }))
}

pub(super) fn read(text: &str) -> Result<Reading> {
    let keys = Keys::of(text);
    let dt = keys.word("dt");
    let inner = number("dt", dt.as_ref().map_or("0.001", |word| word.0))? * PS.size();
    let integrator = keys.text("integrator", "md");
    if TIMELESS.contains(&integrator.as_str()) {
        let remedy = "takes no steps of time: give the .mdp file of the run that does";
        return Err(Error::input("integrator", integrator, remedy));
    }
    let mut reading = if keys.is_on("mts")? {
        two_levels(text, &keys, &inner)?
    } else {
        let mut reading = Reading::new(Engine::Gromacs, text, scheme(vec![inner])?);
        reading.forces = vec!["all forces".into()];
        reading.places = dt.iter().map(|(_, range)| (range.clone(), Place::Outer(PS))).collect();
        reading
    };
    if dt.is_none() {
        reading.default = Some("0.001 ps".into());
        if reading.places.is_empty() {
            let why = "the text has no dt, and grompp takes 0.001 ps: write dt = and the step in ps";
            reading.stays = reading.stays.or(Some(why.into()));
        }
    }
    let shown = format!("dt = {}", dt.as_ref().map_or("0.001 (the default)", |word| word.0));
    reading.used.insert(0, shown);
    if !INTEGRATORS.contains(&integrator.as_str()) {
        reading.remarks.push(format!(
            "integrator = {integrator} is not known here: the answer is about kicks and drifts"
        ));
    }
    masses_and_bonds(&keys, &mut reading)?;
    Ok(reading)
}

fn masses_and_bonds(keys: &Keys, reading: &mut Reading) -> Result<()> {
    for key in ["integrator", "constraints", "mass-repartition-factor"] {
        reading.used.extend(keys.word(key).map(|word| format!("{key} = {}", word.0)));
    }
    reading.constraints = match keys.text("constraints", "none").as_str() {
        "hbonds" => Some(Constraints::HBonds),
        "allbonds" => Some(Constraints::AllBonds),
        "hangles" | "allangles" => {
            reading.remarks.push(
                "the angles that constraints hold are not taken out: leave their periods out yourself".into(),
            );
            Some(Constraints::AllBonds)
        }
        _ => None,
    };
    if let Some((word, _)) = keys.word("mass-repartition-factor") {
        let factor = number("mass-repartition-factor", word)?;
        let mass = &factor * number("hydrogen", HYDROGEN)?;
        if factor > Rational::from_integer(1.into()) {
            reading.used.push(format!("hydrogens of {} amu", decimal(&mass)));
            reading.hydrogen = Some(mass);
        }
    }
    Ok(())
}

fn two_levels(text: &str, keys: &Keys, inner: &Rational) -> Result<Reading> {
    if let Some((word, _)) = keys.word("mts-levels").filter(|(word, _)| *word != "2") {
        return Err(Error::input("mts-levels", word, "GROMACS has two levels: write 2"));
    }
    let factor = keys.word("mts-level2-factor");
    let n = count("mts-level2-factor", factor.as_ref().map_or("2", |word| word.0))?;
    let given = last(&keys.lines, "mts-level2-forces");
    let slow: Vec<&str> =
        given.map_or(vec!["longrange-nonbonded"], |line| line.words[1..].iter().map(|word| word.0).collect());
    let mut reading = Reading::new(Engine::Gromacs, text, scheme(vec![inner.clone(), times(inner, n)])?);
    reading.used =
        vec![format!("mts-level2-factor = {n}"), format!("mts-level2-forces = {}", slow.join(" "))];
    reading.forces = vec!["bonds and all other forces".into(), slow.join(" ")];
    reading.forces.truncate(reading.scheme.steps().len());
    let refused = refusals(keys, n, &slow);
    if !refused.is_empty() {
        let why = format!("grompp refuses this text: {}", refused.join("; "));
        reading.stays = Some(why.clone());
        reading.remarks.push(why);
    }
    if slow.iter().all(|text| text.eq_ignore_ascii_case("longrange-nonbonded")) && !is_full(keys) {
        let why = "without PME, Ewald or P3M there is no longrange-nonbonded force: then no force is on the second level, and all move with dt";
        reading.remarks.push(why.into());
    }
    let places = multiples(keys, &slow);
    if n > 1 {
        reading.note_intervals("grompp", &places, n);
    }
    if n > 1 {
        reading.places = places;
        reading.places.extend(keys.word("mts").map(|(_, range)| (range, Place::Switch)));
        let added = (text.len()..text.len(), Place::Append("mts-level2-factor ="));
        reading.places.push(factor.map_or(added, |(_, range)| (range, Place::LastRatio)));
    }
    Ok(reading)
}

/// Whether a sum over a mesh or over waves is there.
fn is_full(keys: &Keys) -> bool {
    let [coulomb, vdw] = ["coulombtype", "vdwtype"].map(|key| keys.text(key, "cutoff"));
    ["pme", "ewald", "p3m", "fmm"].iter().any(|text| coulomb.starts_with(text)) || vdw == "pme"
}

/// Why grompp refuses two levels here.
fn refusals(keys: &Keys, n: u64, slow: &[&str]) -> Vec<String> {
    let mut all = Vec::new();
    let integrator = keys.text("integrator", "md");
    if integrator != "md" {
        all.push(format!("mts is for integrator = md, not {integrator}"));
    }
    if is_full(keys) && !slow.iter().any(|text| text.eq_ignore_ascii_case(GROUPS[0])) {
        all.push("with PME, Ewald or P3M longrange-nonbonded has to stand in mts-level2-forces".into());
    }
    let known = |text: &&&str| !GROUPS.iter().any(|group| text.eq_ignore_ascii_case(group));
    all.extend(slow.iter().filter(known).map(|own| format!("{own} is no group of mts-level2-forces")));
    if n == 1 {
        all.push("mts-level2-factor has to be larger than 1: write mts = no".into());
    }
    all
}

/// Intervals that grompp wants to be multiples of the factor, where they are not 0.
fn multiples(keys: &Keys, slow: &[&str]) -> Vec<(std::ops::Range<usize>, Place)> {
    let is_slow = |group: &str| slow.iter().any(|text| text.eq_ignore_ascii_case(group));
    let is_free = keys.text("free-energy", "no") != "no";
    // grompp lowers the first to the others.
    let lower = |key: &str, default: u64| {
        let count = keys.word(key).map_or(Some(default), |word| word.0.parse::<u64>().ok());
        count.filter(|n| *n > 0).unwrap_or(100)
    };
    let least = lower("nstenergy", 1000).min(if is_free { lower("nstdhdl", 50) } else { 100 }).min(100);
    let mut tied = vec![("nstcalcenergy", least), ("nstenergy", 1000), ("nstlog", 1000), ("nstfout", 0)];
    if is_free {
        tied.push(("nstdhdl", 50));
    }
    let mut places = intervals(&keys.lines, keys.end, &tied);
    let mut alone = Vec::new();
    if is_slow("nonbonded") {
        alone.push(("nstlist", 10));
    }
    // Where it is absent or -1, grompp takes a multiple itself.
    if keys.text("pcoupl", "no") != "no" {
        alone.push(("nstpcouple", 0));
    }
    if keys.text("pull", "no") != "no" && is_slow("pull") {
        alone.extend([("pull-nstxout", 50), ("pull-nstfout", 50)]);
    }
    let filter_map =
        alone.into_iter().filter_map(|(key, default)| interval(&keys.lines, keys.end, key, default));
    places.extend(filter_map.map(|(range, interval)| (range, Place::Interval(interval))));
    places
}
