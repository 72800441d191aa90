//! Engines whose input is lines of keys and values: LAMMPS, GROMACS, NAMD, Tinker.

use std::ops::Range;

use super::reading::{
    Engine, FS, Interval, MOST_COUNT, MOST_LEVELS, PS, Place, Reading, Unit, count, no_gradient, number,
    scheme, times,
};
use crate::advise::constraint::Constraints;
use crate::error::{Error, Result};
use crate::number::Rational;

/// A line: its words with their places, comments left out.
struct Line<'a> {
    words: Vec<(&'a str, Range<usize>)>,
}

impl<'a> Line<'a> {
    fn key(&self) -> &'a str {
        self.words.first().map_or("", |word| word.0)
    }

    fn value(&self, field: &str) -> Result<&(&'a str, Range<usize>)> {
        self.words.get(1).ok_or_else(|| Error::missing(field, "its line has no value"))
    }
}

/// All lines with words; `=` counts as white space where `equals`, and a line that ends in & goes on in the next.
fn lines<'a>(text: &'a str, comment: char, equals: bool) -> Vec<Line<'a>> {
    let mut all: Vec<Line<'a>> = Vec::new();
    let (mut from, mut goes_on) = (0, false);
    for line in text.split_inclusive('\n') {
        let own = line.split(comment).next().unwrap_or_default();
        let (own, more) = match own.trim_end().strip_suffix('&') {
            Some(own) if comment == '#' && !equals => (own, true),
            _ => (own, false),
        };
        let words = words(own, from, equals);
        match all.last_mut().filter(|_| goes_on) {
            Some(last) => last.words.extend(words),
            None if !words.is_empty() => all.push(Line { words }),
            None => {}
        }
        goes_on = more;
        from += line.len();
    }
    all
}

fn words(line: &str, from: usize, equals: bool) -> Vec<(&str, Range<usize>)> {
    let gap = |c: char| c.is_whitespace() || (equals && c == '=');
    let (mut found, mut start) = (Vec::new(), None);
    for (i, c) in line.char_indices().chain([(line.len(), ' ')]) {
        match (gap(c), start) {
            (false, None) => start = Some(i),
            (true, Some(begin)) => {
                found.push((&line[begin..i], from + begin..from + i));
                start = None;
            }
            _ => {}
        }
    }
    found
}

/// Words that begin lines of one engine alone.
const MARKS: [(Engine, &[&str]); 4] = [
    (
        Engine::Lammps,
        &["run_style", "units", "pair_style", "atom_style", "read_data", "fix", "pair_coeff", "bond_style"],
    ),
    (
        Engine::Namd,
        &[
            "fullelectfrequency",
            "nonbondedfreq",
            "mtsalgorithm",
            "structure",
            "coordinates",
            "stepspercycle",
            "outputname",
            "parameters",
            "paratypecharmm",
            "amber",
            "parmfile",
        ],
    ),
    (Engine::Tinker, &["respa-inner", "integrator", "verbose", "ewald", "openmp-threads", "digits"]),
    (
        Engine::Gromacs,
        &[
            "mts",
            "mts-levels",
            "mts-level2-factor",
            "mts-level2-forces",
            "integrator",
            "dt",
            "nsteps",
            "constraints",
            "coulombtype",
        ],
    ),
];

/// The engine that most lines speak of.
pub(super) fn recognized(text: &str) -> Option<Engine> {
    // In GROMACS every line is an equation.
    let code = |text: &'_ str, comment: char| {
        text.lines().filter_map(|line| line.split(comment).next()).filter(|l| !l.trim().is_empty()).count()
    };
    let equations =
        text.lines().filter_map(|line| line.split(';').next()).filter(|line| line.contains('=')).count();
    let is_mdp = equations > 0 && 2 * equations > code(text, ';');
    let votes = |engine: Engine, marks: &[&str]| {
        let key = |line: &Line| {
            line.key().to_ascii_lowercase().replace('_', if engine == Engine::Lammps { "_" } else { "-" })
        };
        let (comment, equals) =
            if engine == Engine::Gromacs { (';', true) } else { ('#', engine == Engine::Namd) };
        lines(text, comment, equals).iter().filter(|line| marks.contains(&key(line).as_str())).count()
    };
    let best =
        MARKS.iter().filter(|(engine, _)| (*engine == Engine::Gromacs) == is_mdp || *engine == Engine::Namd);
    best.map(|(engine, marks)| (votes(*engine, marks), *engine))
        .filter(|(votes, _)| *votes > 0)
        .max_by_key(|(votes, _)| *votes)
        .map(|(_, engine)| engine)
}

/// The last line of a key, upper and lower case alike.
fn last<'b, 'a>(lines: &'b [Line<'a>], key: &str) -> Option<&'b Line<'a>> {
    let same = |line: &&Line| line.key().replace('_', "-").eq_ignore_ascii_case(&key.replace('_', "-"));
    lines.iter().rev().find(same)
}

/// `timestep` is the outermost step; the first loop factor belongs to the innermost level.
pub(super) fn lammps(text: &str) -> Result<Reading> {
    let lines = lines(text, '#', false);
    let units =
        last(&lines, "units").map(|line| line.value("units").map(|word| word.0)).transpose()?.unwrap_or("lj");
    let (unit, default) = match units {
        "real" | "electron" => (FS, "1.0"),
        "metal" => (PS, "0.001"),
        "si" | "cgs" => (Unit("1e15"), "1e-8"),
        "micro" => (Unit("1e9"), "2.0"),
        "nano" => (Unit("1e6"), "0.00045"),
        _ => {
            return Err(Error::input(
                "units",
                units,
                "its time has no length in seconds: choose real or metal units",
            ));
        }
    };
    let timestep = last(&lines, "timestep");
    let value = timestep.map(|line| line.value("timestep")).transpose()?;
    let outer = number("timestep", value.map_or(default, |word| word.0))? * unit.size();
    let mut places = value.map(|word| (word.1.clone(), Place::Outer(unit))).into_iter().collect::<Vec<_>>();
    let mut used =
        vec![format!("units {units}"), format!("timestep {}", value.map_or(default, |word| word.0))];
    let style = last(&lines, "run_style")
        .filter(|line| line.words.get(1).is_some_and(|word| word.0.starts_with("respa")));
    let Some(style) = style else {
        let mut reading = Reading::new(Engine::Lammps, text, scheme(vec![outer])?);
        (reading.forces, reading.used, reading.places) = (vec!["all forces".into()], used, places);
        return Ok(reading);
    };
    let shown = style.words.iter().map(|word| word.0).collect::<Vec<_>>().join(" ");
    let levels = style
        .words
        .get(2)
        .ok_or_else(|| Error::input("run_style", &shown, "write the number of levels behind respa"))?;
    let levels = count("run_style", levels.0)? as usize;
    if levels > MOST_LEVELS || style.words.len() < 2 + levels {
        return Err(Error::input(
            "run_style",
            &shown,
            format!("{levels} levels have {} loop factors", levels.saturating_sub(1)),
        ));
    }
    let factors = &style.words[3..2 + levels];
    let mut steps = vec![outer];
    for (factor, _) in factors.iter().rev() {
        let n = count("run_style", factor)?;
        let step = steps.last().expect("not empty") / times(&Rational::from_integer(1.into()), n);
        steps.push(step);
    }
    steps.reverse();
    let whole = scheme(steps)?;
    if let Some((_, range)) = factors.last() {
        places.push((range.clone(), Place::LastRatio));
    }
    used.push(shown);
    let mut reading = Reading::new(Engine::Lammps, text, whole);
    let styles = pair_styles(&lines);
    let on_levels = on_levels(&style.words[2 + levels..], &styles);
    let on = |level: usize| {
        let own = on_levels.iter().filter(|(_, at)| *at == level);
        own.map(|(force, _)| force.as_str()).collect::<Vec<_>>().join(", ")
    };
    reading.forces = (1..=levels)
        .map(|level| if on(level).is_empty() { format!("level {level}") } else { on(level) })
        .collect();
    let direct: Vec<&str> = styles.iter().filter(|style| style.is_direct).map(|style| style.name).collect();
    reading.remarks.extend(no_gradient(&direct));
    if reading.scheme.steps().len() < levels {
        reading.remarks.push("levels of equal steps are taken as one".into());
        reading.forces = vec!["forces of all its levels".into(); reading.scheme.steps().len()];
        places.clear();
    }
    // Without a timestep there is no number to change.
    if timestep.is_none() {
        places.clear();
    }
    (reading.used, reading.places) = (used, places);
    Ok(reading)
}

/// A part of `pair_style hybrid` or `hybrid/overlay`.
struct PairStyle<'a> {
    name: &'a str,
    /// `non_conservative on`, as metatomic has it: forces that are predicted, not derived.
    is_direct: bool,
}

/// The parts of the pair style, each begun by a word that `pair_coeff` names as a style.
fn pair_styles<'a>(lines: &[Line<'a>]) -> Vec<PairStyle<'a>> {
    let Some(style) = last(lines, "pair_style") else { return vec![] };
    if !style.words.get(1).is_some_and(|word| word.0.starts_with("hybrid")) {
        return vec![];
    }
    let coefficients = lines.iter().filter(|line| line.key() == "pair_coeff");
    let names: Vec<&str> = coefficients.filter_map(|line| Some(line.words.get(3)?.0)).collect();
    let words: Vec<&str> = style.words[2..].iter().map(|word| word.0).collect();
    let begins: Vec<usize> = (0..words.len()).filter(|&k| names.contains(&words[k])).collect();
    let part = |(k, &from): (usize, &usize)| {
        let own = &words[from..begins.get(k + 1).copied().unwrap_or(words.len())];
        let is_direct = own.windows(2).any(|pair| pair[0] == "non_conservative" && is_on(pair[1]));
        PairStyle { name: words[from], is_direct }
    };
    begins.iter().enumerate().map(part).collect()
}

fn is_on(word: &str) -> bool {
    ["on", "yes", "true"].iter().any(|on| word.eq_ignore_ascii_case(on))
}

/// Each force behind `run_style respa N n1 ...` with its level: a keyword has one, `hybrid` one for each part of the pair style.
fn on_levels(rest: &[(&str, Range<usize>)], styles: &[PairStyle]) -> Vec<(String, usize)> {
    let mut found = Vec::new();
    let mut words = rest.iter().map(|word| word.0).peekable();
    while let Some(key) = words.next() {
        let mut next = || words.next_if(|word| word.parse::<f64>().is_ok());
        if key == "hybrid" {
            let levels = std::iter::from_fn(&mut next).map(str::parse::<usize>);
            let name =
                |k: usize| styles.get(k).map_or_else(|| format!("pair {}", k + 1), |own| own.name.into());
            found.extend(levels.enumerate().filter_map(|(k, level)| Some((name(k), level.ok()?))));
        } else {
            found.extend(next().and_then(|level| level.parse().ok()).map(|level| (key.to_string(), level)));
            // The distances of `inner`, `middle` and `outer`.
            std::iter::from_fn(next).for_each(drop);
        }
    }
    found
}

/// Keys that grompp wants to be multiples of `mts-level2-factor` where they are not 0, with their defaults; all but the first also of the first.
const GROMACS_INTERVALS: [(&str, u64); 4] =
    [("nstcalcenergy", 100), ("nstenergy", 1000), ("nstlog", 1000), ("nstfout", 0)];

/// Intervals where they stand in a text, and those to be added where their default may not do.
fn intervals(lines: &[Line], end: usize, keys: &[(&'static str, u64)]) -> Result<Vec<(Range<usize>, Place)>> {
    let mut places = Vec::new();
    let mut first = 1;
    for (k, &(key, default)) in keys.iter().enumerate() {
        let given = last(lines, key).and_then(|line| line.words.get(1));
        // Below 0 is the default, too.
        let own = given.map_or(Some(default), |word| match word.0.parse::<i64>() {
            Ok(n) => Some(u64::try_from(n).unwrap_or(default)),
            Err(_) => None,
        });
        let Some(steps) = own.filter(|n| (1..=MOST_COUNT * MOST_COUNT).contains(n)) else { continue };
        first = if k == 0 { steps } else { first };
        let of = if k > 0 && steps % first == 0 { first } else { 1 };
        let range = given.map_or(end..end, |word| word.1.clone());
        let key = given.is_none().then_some(key);
        places.push((range, Place::Interval(Interval { key, steps, of })));
    }
    Ok(places)
}

/// `dt` (ps) is the innermost step; with `mts` the second level kicks every `mts-level2-factor` of them.
pub(super) fn gromacs(text: &str) -> Result<Reading> {
    let lines = lines(text, ';', true);
    let value = |key: &str| last(&lines, key).map(|line| line.value(key).cloned()).transpose();
    let mut used = Vec::new();
    let dt = value("dt")?;
    let inner = number("dt", dt.as_ref().map_or("0.001", |word| word.0))? * PS.size();
    used.push(format!("dt = {}", dt.as_ref().map_or("0.001 (the default)", |word| word.0)));
    for key in ["integrator", "constraints"] {
        if let Some((word, _)) = value(key)? {
            used.push(format!("{key} = {word}"));
        }
    }
    let constraints = match value("constraints")?.map(|(word, _)| word.to_ascii_lowercase()).as_deref() {
        Some("h-bonds") => Some(Constraints::HBonds),
        Some("all-bonds" | "h-angles" | "all-angles") => Some(Constraints::AllBonds),
        _ => None,
    };
    let mts = value("mts")?.is_some_and(|(word, _)| {
        word.eq_ignore_ascii_case("yes") || word.eq_ignore_ascii_case("on") || word == "true"
    });
    if !mts {
        let mut reading = Reading::new(Engine::Gromacs, text, scheme(vec![inner])?);
        (reading.forces, reading.used, reading.constraints) = (vec!["all forces".into()], used, constraints);
        reading.places = dt.map(|(_, range)| (range, Place::Outer(PS))).into_iter().collect();
        return Ok(reading);
    }
    let levels = value("mts-levels")?;
    if let Some((word, _)) = levels.filter(|(word, _)| *word != "2") {
        return Err(Error::input("mts-levels", word, "GROMACS has two levels: write 2"));
    }
    let factor = value("mts-level2-factor")?;
    let n = count("mts-level2-factor", factor.as_ref().map_or("2", |word| word.0))?;
    used.push(format!("mts-level2-factor = {n}"));
    let slow = last(&lines, "mts-level2-forces")
        .map(|line| line.words[1..].iter().map(|word| word.0).collect::<Vec<_>>().join(" "));
    let slow = slow.unwrap_or_else(|| "longrange-nonbonded".into());
    used.push(format!("mts-level2-forces = {slow}"));
    let mut reading = Reading::new(Engine::Gromacs, text, scheme(vec![inner.clone(), times(&inner, n)])?);
    let place = factor
        .map_or((text.len()..text.len(), Place::Append("mts-level2-factor =")), |(_, range)| {
            (range, Place::LastRatio)
        });
    if n > 1 {
        reading.places = intervals(&lines, text.len(), &GROMACS_INTERVALS)?;
        reading.places.push(place);
    }
    reading.forces = vec!["bonds and all other forces".into(), slow];
    reading.forces.truncate(reading.scheme.steps().len());
    (reading.used, reading.constraints) = (used, constraints);
    Ok(reading)
}

/// `timestep` (fs) is the innermost step.
pub(super) fn namd(text: &str) -> Result<Reading> {
    let lines = lines(text, '#', true);
    let value = |key: &str| last(&lines, key).map(|line| line.value(key).cloned()).transpose();
    if let Some((word, _)) = value("MTSAlgorithm")?
        .filter(|(word, _)| matches!(word.to_ascii_lowercase().as_str(), "constant" | "naive"))
    {
        let remedy = "repeats the slow force at every step instead of kicking with it: not symplectic, so energy drifts at any step; write impulse";
        return Err(Error::input("MTSAlgorithm", word, remedy));
    }
    let step = value("timestep")?;
    let inner = number("timestep", step.as_ref().map_or("1.0", |word| word.0))?;
    let mut used = vec![format!("timestep {}", step.as_ref().map_or("1.0 (the default)", |word| word.0))];
    let (nonbonded, full) = (value("nonbondedFreq")?, value("fullElectFrequency")?);
    let n = nonbonded.as_ref().map_or(Ok(1), |word| count("nonbondedFreq", word.0))?;
    let m = full.as_ref().map_or(Ok(n), |word| count("fullElectFrequency", word.0))?;
    for (key, word) in [("nonbondedFreq", &nonbonded), ("fullElectFrequency", &full)] {
        if let Some((word, _)) = word {
            used.push(format!("{key} {word}"));
        }
    }
    let mut steps = vec![inner.clone(), times(&inner, n), times(&inner, m)];
    steps.sort();
    let mut reading = Reading::new(Engine::Namd, text, scheme(steps)?);
    let mut forces = vec!["bonded forces"];
    let (short, long) = ("short-range nonbonded forces", "full electrostatics");
    match (n > 1, m > 1) {
        (true, true) if n < m => forces.extend([short, long]),
        (true, true) if n > m => forces.extend([long, short]),
        (true, true) => forces.push("all nonbonded forces"),
        (true, false) => forces.push(short),
        (false, true) => forces.push(long),
        (false, false) => {}
    }
    reading.forces = forces.into_iter().map(Into::into).collect();
    // Both where they are equal: the one is to stay a multiple of the other.
    let outermost = full.filter(|_| m >= n).into_iter().chain(nonbonded.filter(|_| n >= m));
    if reading.scheme.steps().len() > 1 {
        reading.places = outermost.map(|(_, range)| (range, Place::OuterOverInner)).collect();
        // NAMD wants both to divide the steps of a cycle.
        reading.places.extend(intervals(&lines, text.len(), &[("stepspercycle", 20)])?);
    } else {
        reading.places = step.map(|(_, range)| (range, Place::Outer(FS))).into_iter().collect();
    }
    if let Some((word, _)) = value("rigidBonds")? {
        used.push(format!("rigidBonds {word}"));
        reading.constraints = word.eq_ignore_ascii_case("all").then_some(Constraints::HBonds);
    }
    reading.used = used;
    Ok(reading)
}

/// The inner step is dt/n, n = int(dt/inner) + 1 with dt/inner rounded down a little first, so that a multiple gives itself.
pub(super) fn tinker(text: &str, outer: Option<&Rational>) -> Result<Reading> {
    let lines = lines(text, '#', false);
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
