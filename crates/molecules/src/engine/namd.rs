//! NAMD: `timestep` (fs) is the innermost step, `nonbondedFreq` and `fullElectFrequency` count it.

use super::evidence::Vocabulary;
use super::lines::{Line, Names, Notation, Word, interval, intervals, is_key, last, lines};
use super::reading::{Engine, FS, Place, Reading, count, number, scheme, times};
use crate::constraint::Constraints;
use number::{Error, Result};

pub(super) const WORDS: Vocabulary = Vocabulary {
    engine: Engine::Namd,
    notation: NOTATION,
    words: include_str!("words/namd.txt"),
    plain: |word| word.to_ascii_lowercase(),
    prefixes: &[],
    is_own: |_| false,
    // Commands in Tcl may be anything.
    is_whole: false,
};

const NOTATION: Notation =
    Notation { comment: '#', equals: true, ends: Some(';'), goes_on: Some('\\'), braces: true };

/// One of them has to be on, or there are no full electrostatics.
const FULL: [&str; 9] = ["PME", "FMA", "MSM", "FMM", "FullDirect", "GBIS", "GBISSer", "LCPO", "SASA"];

/// What bears on the steps, and is not read where it stands in a loop or a condition.
const STEPS: [&str; 4] = ["timestep", "nonbondedFreq", "fullElectFrequency", "MTSAlgorithm"];

const BETTER: &str =
    "give the log of NAMD's run instead (`namd3 run.conf > run.log`), which has all steps as NAMD took them";

/// The keys of a text, with names followed.
struct Keys<'a> {
    lines: Vec<Line<'a>>,
    names: Names<'a>,
    end: usize,
}

impl<'a> Keys<'a> {
    fn of(text: &'a str) -> Keys<'a> {
        let all = lines(text, &NOTATION);
        let mut names = Names::default();
        for line in all.iter().filter(|line| line.words.len() > 1) {
            match line.key() {
                "set" => names.set(
                    line.words[1].0,
                    line.words.get(2).filter(|_| line.words.len() == 3 && line.depth == 0).cloned(),
                ),
                "incr" | "foreach" | "lassign" | "append" | "global" | "unset" => {
                    names.set(line.words[1].0, None)
                }
                "for" => names.set(line.words.get(2).map_or("", |word| word.0), None),
                _ => {}
            }
        }
        // A parameter behind the first run comes too late.
        let run = all.iter().find(|line| line.depth == 0 && ["run", "minimize"].contains(&line.key()));
        let begins = |line: &Line| text[..line.words[0].1.start].rfind('\n').map_or(0, |end| end + 1);
        let end = run.map_or(text.len(), begins);
        Keys { lines: all, names, end }
    }

    fn word(&self, key: &str) -> Result<Option<Word<'a>>> {
        let line = self.lines.iter().rev().find(|line| line.depth == 0 && is_key(line.key(), key));
        line.map(|line| line.value(key).map(|word| self.names.follow(word))).transpose()
    }

    fn is_on(&self, key: &str) -> Result<bool> {
        let word = self.word(key)?;
        Ok(word.is_some_and(|word| ["yes", "on", "true"].iter().any(|on| word.0.eq_ignore_ascii_case(on))))
    }

    /// Whether more may be set than stands in the text.
    fn is_open(&self) -> bool {
        ["source", "if", "proc", "foreach", "while"].iter().any(|key| last(&self.lines, key).is_some())
    }

    fn is_full(&self) -> Result<bool> {
        FULL.iter().try_fold(false, |any, key| Ok(any || self.is_on(key)?))
    }
}

pub(super) fn read(text: &str) -> Result<Reading> {
    let keys = Keys::of(text);
    let is_step = |line: &&Line| line.depth > 0 && STEPS.iter().any(|key| is_key(line.key(), key));
    if let Some(line) = keys.lines.iter().find(is_step) {
        let remedy = format!("stands in a condition, a loop or a procedure: {BETTER}");
        return Err(Error::input(line.key(), line.shown(), remedy));
    }
    let algorithm = keys.word("MTSAlgorithm")?;
    refuse_naive(algorithm.as_ref().map_or("impulse", |word| word.0))?;
    let step = keys.word("timestep")?;
    let shown = step.as_ref().map_or("1.0 (the default)", |word| word.0);
    if step.is_none() && keys.is_open() {
        return Err(Error::missing(
            "timestep",
            format!("a text that sources others, or decides on conditions, may have it there: {BETTER}"),
        ));
    }
    let inner = number("timestep", step.as_ref().map_or("1.0", |word| word.0))
        .map_err(|error| better(error, shown))?;
    let (nonbonded, full) = (keys.word("nonbondedFreq")?, keys.word("fullElectFrequency")?);
    let each = |key: &str, word: &Option<Word>| {
        word.as_ref().map(|word| count(key, word.0).map_err(|error| better(error, word.0))).transpose()
    };
    let n = each("nonbondedFreq", &nonbonded)?.unwrap_or(1);
    let given = each("fullElectFrequency", &full)?;
    let is_full = keys.is_full()?;
    if given.is_some_and(|given| given != n)
        && !is_full
        && keys.is_open()
        && !FULL.iter().any(|key| last(&keys.lines, key).is_some_and(|line| line.depth == 0))
    {
        let remedy = format!(
            "PME, without which it is 0, may be on in a text that is sourced, or on a condition: {BETTER}"
        );
        return Err(Error::input("fullElectFrequency", full.map_or("", |word| word.0), remedy));
    }
    let m = if is_full { given.unwrap_or(n) } else { n };
    let mut steps = vec![inner.clone(), times(&inner, n), times(&inner, m)];
    steps.sort();
    let mut reading = Reading::new(Engine::Namd, text, scheme(steps)?);
    reading.default = step.is_none().then(|| "1 fs".into());
    reading.used = vec![format!("timestep {shown}")];
    for (key, word) in [("nonbondedFreq", &nonbonded), ("fullElectFrequency", &full)] {
        reading.used.extend(word.as_ref().map(|word| format!("{key} {}", word.0)));
    }
    if given.is_some_and(|given| given != n) && !is_full {
        let why =
            "NAMD takes fullElectFrequency for 0: none of PME, FMA, MSM, FMM, FullDirect, GBIS, LCPO is on";
        reading.remarks.push(why.into());
    }
    reading.forces = forces(n, m, is_full);
    let full = full.filter(|_| is_full);
    if reading.scheme.steps().len() > 1 {
        place_intervals(&mut reading, &keys, is_full, (n, nonbonded), (m, full));
    } else {
        if step.is_none() {
            let why = "the text has no timestep, and NAMD takes 1 fs: write timestep and the step in fs";
            reading.stays = Some(why.into());
        }
        reading.places = step.map(|(_, range)| (range, Place::Outer(FS))).into_iter().collect();
    }
    bonds(&keys, &mut reading)?;
    notes(&keys, &mut reading);
    Ok(reading)
}

/// Notes where the steps of several clocks stand in the text, and its intervals that are multiples of them;
/// nonbonded and full forces each with their multiple and where that is written.
fn place_intervals(
    reading: &mut Reading,
    keys: &Keys,
    is_full: bool,
    (n, nonbonded): (u64, Option<Word>),
    (m, full): (u64, Option<Word>),
) {
    // Both where they are equal: the one is to stay a multiple of the other.
    let outermost = full.filter(|_| m >= n).into_iter().chain(nonbonded.filter(|_| n >= m));
    reading.places = outermost.map(|(_, range)| (range, Place::OuterOverInner)).collect();
    let intervals = multiples(keys);
    let cycle = |(_, place): &&(_, Place)| matches!(place, Place::Interval(interval) if interval.name == "stepspercycle");
    let cycles: Vec<_> = intervals.iter().filter(cycle).cloned().collect();
    for outer in [n, m].iter().take(if n == m { 1 } else { 2 }) {
        reading.note_intervals("NAMD", &cycles, *outer);
    }
    if is_full {
        let energies: Vec<_> = intervals
            .iter()
            .filter(|(_, place)| matches!(place, Place::Interval(interval) if interval.or_part))
            .cloned()
            .collect();
        reading.note_intervals("NAMD", &energies, m);
    }
    reading.places.extend(intervals);
    if is_full && m < n {
        let why = "NAMD refuses this text: fullElectFrequency has to be a multiple of nonbondedFreq";
        reading.remarks.push(why.into());
        reading.stays = Some(why.into());
    }
}

fn better(error: Error, given: &str) -> Error {
    if given.starts_with(['$', '[', '{', '"']) {
        return Error::input(
            error.field(),
            given,
            format!("is no number, nor a name that the text sets once to one: {BETTER}"),
        );
    }
    error
}

fn refuse_naive(algorithm: &str) -> Result<()> {
    if ["constant", "naive"].iter().any(|text| algorithm.eq_ignore_ascii_case(text)) {
        let remedy = "repeats the slow force at every step instead of kicking with it: not symplectic, so energy drifts at any step; write impulse";
        return Err(Error::input("MTSAlgorithm", algorithm, remedy));
    }
    Ok(())
}

fn forces(n: u64, m: u64, is_full: bool) -> Vec<String> {
    let (short, long) = ("short-range nonbonded forces", "full electrostatics");
    let slower = match (n > 1, m > 1) {
        (true, true) if n < m => vec![short, long],
        (true, true) if n > m => vec![long, short],
        (true, true) if is_full => vec!["all nonbonded forces"],
        (true, _) => vec![short],
        (false, true) => vec![long],
        (false, false) => return vec!["all forces".into()],
    };
    std::iter::once("bonded forces").chain(slower).map(Into::into).collect()
}

/// NAMD wants both frequencies to divide the steps of a cycle, that cycle the steps of a run, and energies to
/// go with full electrostatics.
fn multiples(keys: &Keys) -> Vec<(std::ops::Range<usize>, Place)> {
    let tied = [
        ("stepspercycle", 20),
        ("numsteps", 0),
        ("firsttimestep", 0),
        ("run", 0),
        ("minimize", 0),
        ("berendsenPressureFreq", 0),
        ("monteCarloPressureFreq", 0),
    ];
    let top: Vec<(&'static str, u64)> = tied
        .into_iter()
        .filter(|(key, _)| last(&keys.lines, key).is_none_or(|line| line.depth == 0))
        .collect();
    let mut places = intervals(&keys.lines, keys.end, &top);
    for key in ["outputEnergies", "computeEnergies"] {
        if let Some((range, mut interval)) = interval(&keys.lines, keys.end, key, 0) {
            interval.or_part = true;
            places.push((range, Place::Interval(interval)));
        }
    }
    places
}

fn bonds(keys: &Keys, reading: &mut Reading) -> Result<()> {
    let Some((word, _)) = keys.word("rigidBonds")? else { return Ok(()) };
    reading.used.push(format!("rigidBonds {word}"));
    match word.to_ascii_lowercase().as_str() {
        "all" => reading.constraints = Some(Constraints::HBonds),
        "none" | "off" | "no" => {}
        "water" => reading.remarks.push("rigidBonds water holds the bonds of water alone: name those of the periods given that are held, as --constraints OH".into()),
        _ => return Err(better(Error::input("rigidBonds", word, "write all, water or none"), word)),
    }
    Ok(())
}

fn notes(keys: &Keys, reading: &mut Reading) {
    if keys.lines.iter().any(|line| line.depth > 0 && is_key(line.key(), "rigidBonds")) {
        reading.remarks.push(
            "rigidBonds stands in a condition: if it holds, name the bonds, as --constraints h-bonds".into(),
        );
    }
    if keys.is_open() {
        reading.remarks.push(format!("what `source`, `if` and `proc` do is not followed: {BETTER}"));
    }
    if keys.is_on("molly").unwrap_or(false) {
        reading.remarks.push("molly is on: it is another method than plain impulses, and its row stands in the table of levers".into());
    }
}

/// The log of a run: all of its parameters, defaults filled in.
pub(super) fn of_log(text: &str) -> Option<Result<Reading>> {
    let is_log = |line: &&str| line.starts_with("Info: NAMD ");
    text.lines().take(2000).find(is_log)?;
    let value = |head: &str| {
        let own = text
            .lines()
            .rev()
            .filter_map(|line| line.strip_prefix("Info: "))
            .find_map(|line| line.strip_prefix(head));
        own.map(str::trim)
    };
    Some(logged(text, &value))
}

fn logged<'a>(text: &str, value: &dyn Fn(&str) -> Option<&'a str>) -> Result<Reading> {
    if value("USING NAIVE").is_some() {
        refuse_naive("naive")?;
    }
    let step = value("TIMESTEP ")
        .ok_or_else(|| Error::missing("timestep", "the log has none: it ends before NAMD's parameters"))?;
    let inner = number("timestep", step)?;
    let each = |head: &str| {
        value(head).map(|text| count(head, text.split_whitespace().next().unwrap_or_default())).transpose()
    };
    let n = each("NONBONDED FORCES EVALUATED EVERY ")?.unwrap_or(1);
    let full = each("FULL ELECTROSTATIC EVALUATION FREQUENCY ")?;
    let mut reading = Reading::new(
        Engine::Namd,
        text,
        scheme(vec![inner.clone(), times(&inner, n), times(&inner, full.unwrap_or(n).max(n))])?,
    );
    reading.forces = forces(n, full.unwrap_or(n), full.is_some());
    reading.used = vec![format!("timestep {step}"), format!("nonbondedFreq {n}")];
    reading.used.extend(full.map(|m| format!("fullElectFrequency {m}")));
    match value("RIGID BONDS TO HYDROGEN :") {
        Some("ALL") => reading.constraints = Some(Constraints::HBonds),
        Some("WATER") => reading.remarks.push("rigidBonds water holds the bonds of water alone: name those of the periods given that are held, as --constraints OH".into()),
        _ => {}
    }
    reading.stays =
        Some("this is a log: change timestep, nonbondedFreq or fullElectFrequency in NAMD's input".into());
    Ok(reading)
}
