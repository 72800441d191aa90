//! LAMMPS: `timestep` is the outermost step, `run_style respa` has the levels, the innermost first.

use std::collections::HashSet;

use super::evidence::Vocabulary;
use super::lines::{Line, Names, Notation, Word, last, lines};
use super::reading::{
    Engine, FS, MOST_LEVELS, PS, Place, Reading, Unit, count, no_gradient, number, scheme, times,
};
use super::respa::{BONDED, clocks, on_levels, pair_styles, refuse_order};
use crate::constraint::Constraints;
use crate::unit::TimeUnit;
use number::{Error, Rational, Result};

pub(super) const WORDS: Vocabulary = Vocabulary {
    engine: Engine::Lammps,
    notation: NOTATION,
    words: include_str!("words/lammps.txt"),
    plain: |word| word.to_string(),
    prefixes: &["$"],
    is_own: |_| false,
    is_whole: true,
};

const NOTATION: Notation =
    Notation { comment: '#', equals: false, ends: None, goes_on: Some('&'), braces: false };

/// What sets more than stands in the text.
const OPEN: [&str; 5] = ["include", "jump", "read_restart", "python", "kim"];

const BETTER: &str = "give LAMMPS's log of the run instead (`lmp -in in.file` writes log.lammps), which has every command as LAMMPS took it";

/// The commands that count: those between the last `clear` and the last `run`, with names followed.
struct Commands<'a> {
    lines: Vec<Line<'a>>,
    names: Names<'a>,
}

impl<'a> Commands<'a> {
    fn of(text: &'a str) -> Commands<'a> {
        let mut all = lines(text, &NOTATION);
        if let Some(run) = all.iter().rposition(|line| line.key() == "run") {
            all.truncate(run + 1);
        }
        let mut names = Names::default();
        for line in all.iter().filter(|line| line.key() == "variable" && line.words.len() > 2) {
            let is_plain = ["equal", "index", "string", "internal"].contains(&line.words[2].0);
            names.set(
                line.words[1].0,
                line.words.get(3).filter(|_| is_plain && line.words.len() == 4).cloned(),
            );
        }
        if let Some(clear) = all.iter().rposition(|line| line.key() == "clear") {
            all.drain(..=clear);
        }
        Commands { lines: all, names }
    }

    fn last(&self, key: &str) -> Option<&Line<'a>> {
        last(&self.lines, key)
    }

    fn words(&self, key: &str) -> Option<Vec<Word<'a>>> {
        self.last(key).map(|line| line.words.iter().map(|word| self.names.follow(word)).collect())
    }

    fn has(&self, keys: &[&str]) -> bool {
        self.lines.iter().any(|line| keys.contains(&line.key()))
    }

    /// Whether more may be set than stands in the text.
    fn is_open(&self) -> bool {
        let opens = |line: &Line| {
            line.words.iter().any(|word| OPEN.contains(&word.0.trim_start_matches(['"', '\''])))
        };
        self.has(&OPEN) || self.lines.iter().any(|line| line.key() == "if" && opens(line))
    }

    /// Commands that are done in a condition or for each of several values.
    fn refuse_conditions(&self) -> Result<()> {
        const STEPS: [&str; 3] = ["units", "timestep", "run_style"];
        for line in self.lines.iter().filter(|line| line.key() == "if") {
            let begins = |pair: &[Word]| {
                let quoted = pair[1].0.starts_with(['"', '\'']);
                let follows = ["then", "else"].contains(&pair[0].0) || quoted;
                follows && STEPS.contains(&pair[1].0.trim_start_matches(['"', '\'']))
            };
            if line.words.windows(2).any(begins) {
                let remedy = format!("decides on the steps, and conditions are not followed: {BETTER}");
                return Err(Error::input("if", line.shown(), remedy));
            }
        }
        Ok(())
    }
}

/// `units`: the unit of time and the default step.
fn units(units: &str) -> Result<(Unit, &'static str)> {
    Ok(match units {
        "real" => (FS, "1.0"),
        // Plain numbers: no length in seconds.
        "lj" => (FS, "0.005"),
        "electron" => (FS, "0.001"),
        "metal" => (PS, "0.001"),
        "si" | "cgs" => (Unit("1e15"), "1e-8"),
        "micro" => (Unit("1e9"), "2.0"),
        "nano" => (Unit("1e6"), "0.00045"),
        _ => {
            let remedy =
                "is no style of units that is known here: lj, real, metal, si, cgs, electron, micro, nano";
            return Err(Error::input("units", units, remedy));
        }
    })
}

pub(super) fn read(text: &str) -> Result<Reading> {
    let commands = Commands::of(text);
    commands.refuse_conditions()?;
    of_commands(text, &commands)
}

fn of_commands(text: &str, commands: &Commands) -> Result<Reading> {
    let named = commands.words("units");
    if named.is_none() && commands.is_open() {
        let remedy =
            format!("a text that includes others, or decides on conditions, may have them there: {BETTER}");
        return Err(Error::missing("units", remedy));
    }
    let named = named.as_ref().map_or(Ok("lj"), |words| {
        words.get(1).map(|word| word.0).ok_or_else(|| Error::missing("units", "its line has no value"))
    })?;
    let (unit, default) = units(named)?;
    let timestep = commands.words("timestep");
    let value = timestep
        .as_ref()
        .map(|words| words.get(1).ok_or_else(|| Error::missing("timestep", "its line has no value")))
        .transpose()?;
    let shown = value.map_or(default, |word| word.0);
    let outer = number("timestep", shown).map_err(|error| better(error, "timestep", shown))? * unit.size();
    let style = commands
        .words("run_style")
        .filter(|words| words.get(1).is_some_and(|word| word.0.starts_with("respa")));
    let mut reading = match &style {
        Some(words) => respa(text, commands, words, outer)?,
        None => {
            let mut reading = Reading::new(Engine::Lammps, text, scheme(vec![outer])?);
            reading.forces = vec!["all forces".into()];
            reading
        }
    };
    if named == "lj" {
        reading.unit = TimeUnit::Plain;
    }
    let is_default = if value.is_none() { " (the default)" } else { "" };
    reading.used.splice(0..0, [format!("units {named}"), format!("timestep {shown}{is_default}")]);
    match value {
        Some(word) if reading.stays.is_none() => reading.places.push((word.1.clone(), Place::Outer(unit))),
        Some(_) => {}
        // Without a timestep there is no number to change.
        None => {
            if commands.is_open() {
                let remedy = format!(
                    "a text that includes others, or decides on conditions, may have it there: {BETTER}"
                );
                return Err(Error::missing("timestep", remedy));
            }
            reading.places.clear();
            let why =
                format!("the text has no timestep, and LAMMPS takes {default}: write one before its run");
            reading.stays = reading.stays.or(Some(why));
            reading.default = Some(format!("{default} in units {named}"));
        }
    }
    notes(commands, &mut reading);
    Ok(reading)
}

fn better(error: Error, field: &str, given: &str) -> Error {
    if !given.contains(['$', '(', '{']) {
        return error;
    }
    Error::input(field, given, format!("is no number, nor a name that the text sets once to one: {BETTER}"))
}

/// `run_style respa N n1 ... n(N-1) keywords`: forces on their levels, levels without a force left out.
fn respa(text: &str, commands: &Commands, words: &[Word], outer: Rational) -> Result<Reading> {
    let shown = words.iter().map(|word| word.0).collect::<Vec<_>>().join(" ");
    let levels = words
        .get(2)
        .ok_or_else(|| Error::input("run_style", &shown, "write the number of levels behind respa"))?;
    let whole = |word: &Word| count("run_style", word.0).map_err(|error| better(error, "run_style", word.0));
    let levels = whole(levels)? as usize;
    if levels > MOST_LEVELS || words.len() < 2 + levels {
        let remedy = format!("{levels} levels have {} loop factors", levels.saturating_sub(1));
        return Err(Error::input("run_style", &shown, remedy));
    }
    let factors = &words[3..2 + levels];
    let mut steps = vec![outer];
    for factor in factors.iter().rev() {
        let step =
            steps.last().expect("not empty") / times(&Rational::from_integer(1.into()), whole(factor)?);
        steps.push(step);
    }
    steps.reverse();
    let styles = pair_styles(&commands.lines);
    let is_open = commands.is_open();
    let there = |force: &str| is_open || commands.has(&[&format!("{force}_style")]);
    let all = on_levels(&words[2 + levels..], &commands.lines, &there, &styles, levels)?;
    let on = |level: usize| {
        let filter = all.iter().filter(|(_, at)| *at == level);
        filter.map(|(force, _)| force.as_str()).collect::<Vec<_>>().join(", ")
    };
    refuse_order(&all, &shown)?;
    let forces: Vec<String> = (1..=levels).map(on).collect();
    let (steps, forces, remarks) = clocks(steps, forces);
    let mut reading = Reading::new(Engine::Lammps, text, scheme(steps)?);
    (reading.used, reading.forces, reading.remarks) = (vec![shown], forces, remarks);
    let direct: Vec<&str> = styles.iter().filter(|style| style.is_direct).map(|style| style.name).collect();
    reading.remarks.extend(no_gradient(&direct));
    if reading.scheme.steps().len() == levels {
        reading.places.extend(factors.last().map(|word| (word.1.clone(), Place::LastRatio)));
    } else {
        reading.stays = Some(
            "levels without a force, or of equal steps, are to go first: write one level for each clock"
                .into(),
        );
    }
    Ok(reading)
}

/// What else in the text bears on the answer.
fn notes(commands: &Commands, reading: &mut Reading) {
    let has = |keys: &[&str]| commands.lines.iter().any(|line| keys.contains(&line.key()));
    if has(&["include", "jump", "read_restart", "python", "if"]) {
        reading
            .remarks
            .push(format!("what include, jump, if, python and restart files set is not read: {BETTER}"));
    }
    for key in ["timestep", "run_style"] {
        let given: HashSet<String> =
            commands.lines.iter().filter(|line| line.key() == key).map(Line::shown).collect();
        if given.len() > 1 {
            reading.remarks.push(format!(
                "{key} is given {} times: the last one before the last run is read",
                given.len()
            ));
        }
    }
    let of = |key: &'static str| commands.lines.iter().filter(move |line| line.key() == key);
    let unfixed: HashSet<&str> = of("unfix").filter_map(|line| Some(line.words.get(1)?.0)).collect();
    for line in of("fix").filter(|line| line.words.len() > 3 && !unfixed.contains(line.words[1].0)) {
        held(line, reading);
    }
    let bonded =
        reading.scheme.steps().len() > 1 && reading.forces[0].split(", ").all(|text| BONDED.contains(&text));
    if bonded && !commands.is_open() && !BONDED.iter().any(|own| commands.has(&[&format!("{own}_style")])) {
        let why = "the innermost level has bonded forces alone, and the text no bond_style: without bonds it is no clock, and all forces have the outer steps";
        reading.remarks.push(why.into());
    }
}

/// Bonds that a fix holds, bodies that it makes rigid, steps that it changes.
fn held(fix: &Line, reading: &mut Reading) {
    let plain = fix.words[3].0.split('/').next().unwrap_or_default();
    let remark = match plain {
        "shake" | "rattle" => {
            let shown = fix.words[3..].iter().map(|word| word.0);
            let mut masses = shown
                .clone()
                .skip_while(|word| *word != "m")
                .skip(1)
                .map_while(|word| word.parse::<f64>().ok());
            let is_hydrogen = masses.any(|mass| (0.9..1.2).contains(&mass));
            if reading.used.len() < MOST_USED {
                reading.used.push(format!("fix {}", shown.collect::<Vec<_>>().join(" ")));
            }
            if is_hydrogen {
                reading.constraints = Some(Constraints::HBonds);
                return;
            }
            format!(
                "fix {plain} holds bonds by their types, which are not read here: name those of the periods given that are held, as \
                 --constraints h-bonds or --constraints OH,CH"
            )
        }
        "rigid" | "poems" => {
            format!("fix {plain} makes bodies rigid: leave out the periods of motions inside them")
        }
        "dt" => "fix dt/reset changes the step in the run: this answer is for the step given".into(),
        "adapt" if fix.words.iter().any(|word| word.0 == "dt") => {
            "fix adapt may change the step in the run".into()
        }
        _ => return,
    };
    if !reading.remarks.contains(&remark) {
        reading.remarks.push(remark);
    }
}

/// Fixes beyond so many are not shown.
const MOST_USED: usize = 8;

/// A log has every command as it was done, and LAMMPS's own table of levels.
pub(super) fn of_log(text: &str) -> Option<Result<Reading>> {
    text.lines().take(20).find(|line| line.starts_with("LAMMPS ("))?;
    let echoed =
        lines(text, &NOTATION).iter().any(|line| ["units", "pair_style", "run_style"].contains(&line.key()));
    Some(if echoed { of_commands(text, &Commands::of_log(text)) } else { of_screen(text) })
}

impl<'a> Commands<'a> {
    /// What stands in a log: lines with names are followed by the same lines with values, those of conditions
    /// by what was done.
    fn of_log(text: &'a str) -> Commands<'a> {
        let mut commands = Commands::of(text);
        let known: HashSet<&str> = WORDS.words.split_whitespace().collect();
        let is_done = |line: &Line| {
            let named = line.key() != "print" && line.words.iter().any(|word| word.0.contains('$'));
            known.contains(line.key())
                && !named
                && !["if", "include", "jump", "variable"].contains(&line.key())
        };
        commands.lines.retain(is_done);
        commands
    }
}

/// What LAMMPS shows on the screen as a run begins, where its commands are not echoed.
fn of_screen(text: &str) -> Result<Reading> {
    let value = |key: &str| {
        let own = text.lines().rev().map(str::trim_start).find_map(|line| line.strip_prefix(key));
        own.and_then(|rest| Some(rest.trim_start().strip_prefix(':')?.trim()))
    };
    let missing = || Error::missing("timestep", format!("the screen's text has no run: {BETTER}"));
    let named = value("Unit style").ok_or_else(missing)?;
    let unit = units(named)?.0;
    let levels = value("Time steps");
    let steps: Vec<&str> = match levels {
        Some(all) => all.split_whitespace().map(|text| text.rsplit(':').next().unwrap_or(text)).collect(),
        None => vec![value("Time step").ok_or_else(missing)?],
    };
    let steps =
        steps.iter().map(|step| Ok(number("timestep", step)? * unit.size())).collect::<Result<Vec<_>>>()?;
    let table = text.rfind("Respa levels:").map_or("", |at| &text[at..]);
    let fixes = value("r-RESPA fixes").unwrap_or_default();
    let on = |level: usize| {
        let text = table.lines().nth(level).and_then(|line| line.split_once('=')).map_or("", |pair| pair.1);
        let fixed = fixes.split_whitespace().filter_map(|fix| fix.strip_prefix(&format!("{level}:")));
        let fixed = fixed.map(|fix| format!("fix {fix}"));
        text.split_whitespace().map(String::from).chain(fixed).collect::<Vec<_>>().join(", ")
    };
    let forces =
        if levels.is_some() { (1..=steps.len()).map(on).collect() } else { vec!["all forces".into()] };
    let (steps, forces, remarks) = clocks(steps, forces);
    let mut reading = Reading::new(Engine::Lammps, text, scheme(steps)?);
    reading.used = vec![
        format!("units {named}"),
        format!("time steps {}", levels.or(value("Time step")).unwrap_or_default()),
    ];
    (reading.forces, reading.remarks) = (forces, remarks);
    reading.stays = Some("this is what LAMMPS showed: change timestep and run_style in its input".into());
    Ok(reading)
}
