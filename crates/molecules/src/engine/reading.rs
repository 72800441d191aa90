//! The text of an engine, read, and rewritten with other steps.

use std::ops::Range;

use crate::beads::Beads;
use crate::constraint::Constraints;
use crate::levels::Scheme;
use crate::unit::{TimeUnit, decimal};
use number::parse::parse_rational;
use number::{Error, Rational, Result, named};

named! {
    /// A simulation engine.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Engine {
        OpenMm = "OpenMM",
        Lammps = "LAMMPS",
        Gromacs = "GROMACS",
        Namd = "NAMD",
        Tinker = "Tinker",
        TinkerHp = "Tinker-HP",
        Ipi = "i-PI",
    }
}

impl Engine {
    /// Which step its dt is.
    pub fn dt(self) -> &'static str {
        match self {
            Engine::OpenMm | Engine::Lammps | Engine::Ipi => "dt is the outermost step",
            Engine::Gromacs | Engine::Namd => "dt is the innermost step",
            Engine::Tinker | Engine::TinkerHp => "dt, given when a run starts, is the outermost step",
        }
    }
}

/// A number in the text as a function of the steps.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Place {
    /// The outermost step in units of so many fs.
    Outer(Unit),
    /// How often level k (0 the innermost) is evaluated in an outermost step.
    PerOuter(usize),
    /// The outermost step over the one before it.
    LastRatio,
    /// The outermost step over the innermost one.
    OuterOverInner,
    /// An interval in innermost steps that has to be a multiple of the outermost one.
    Interval(Interval),
    /// A whole line to add at the end, with the last ratio behind it.
    Append(&'static str),
    /// The innermost step in fs with a point, of an engine that takes the next shorter one which divides the
    /// outermost.
    Inner,
    /// Whether there are two clocks at all, as yes or no.
    Switch,
    /// The work in one step of the level below the outermost, written out as often as that step is made.
    Loop(Loop),
}

/// One turn of a loop that is written out.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Loop {
    /// In it every dt/n is a part of the outermost step.
    pub turn: String,
    /// White space between two turns.
    pub gap: String,
    /// How many there are.
    pub turns: u64,
}

impl Loop {
    /// So many turns in place of those.
    fn written(&self, turns: u64) -> String {
        let mut one = String::new();
        let mut rest = self.turn.as_str();
        while let Some(at) = rest.find("dt/") {
            let (before, behind) = rest.split_at(at + 3);
            let digits = behind.len() - behind.trim_start_matches(|c: char| c.is_ascii_digit()).len();
            let n = behind[..digits].parse::<u64>().unwrap_or(0);
            one += before;
            one += &(n / self.turns * turns).to_string();
            rest = &behind[digits..];
        }
        one += rest;
        vec![one; turns as usize].join(&self.gap)
    }
}

/// How often something is done, in innermost steps.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Interval {
    pub name: &'static str,
    /// Where it stands nowhere: the key of its line, to be added unless its default does.
    pub key: Option<&'static str>,
    pub steps: u64,
    /// Another interval of which it stays a multiple.
    pub of: u64,
    /// Whether a part of the outermost step does, too.
    pub or_part: bool,
}

impl Interval {
    /// "nstlist = 10 (the default)", where it is no multiple of so many inner steps as the engine wants.
    pub fn amiss(&self, outer: u64) -> Option<String> {
        let is_default = if self.key.is_some() { " (the default)" } else { "" };
        let is_sound = self.steps.is_multiple_of(outer) || (self.or_part && outer.is_multiple_of(self.steps));
        (!is_sound).then(|| format!("{} = {}{is_default}", self.name, self.steps))
    }

    /// The next one that is a multiple of so many innermost steps; `None` where a default is one.
    fn written(&self, outer: u64) -> Option<u64> {
        let unit = self.of.div_ceil(outer) * outer;
        let is_part = self.or_part && outer.is_multiple_of(self.steps);
        let steps = if is_part { self.steps } else { self.steps.div_ceil(unit) * unit };
        (self.key.is_none() || steps != self.steps).then_some(steps)
    }
}

/// A unit of time, in fs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unit(pub &'static str);

pub(super) const FS: Unit = Unit("1");
pub(super) const PS: Unit = Unit("1000");

impl Unit {
    pub fn size(self) -> Rational {
        parse_rational("unit", self.0).expect("units are numbers")
    }
}

/// The text of an engine, read.
#[derive(Clone, Debug)]
pub struct Reading {
    pub engine: Engine,
    pub scheme: Scheme,
    /// The forces on each clock, the innermost first, in the engine's own words.
    pub forces: Vec<String>,
    /// The keys that were used, as they stand in the text.
    pub used: Vec<String>,
    /// Remarks for the writer of the text: parts that the engine would refuse, parts that were not read.
    pub remarks: Vec<String>,
    /// The bonds that it constrains, where its text says so.
    pub constraints: Option<Constraints>,
    /// The mass in amu that it gives to hydrogens, taken from their heavy atoms, where its text says so.
    pub hydrogen: Option<Rational>,
    /// Where the innermost step, or the one that is no other's multiple, is the engine's default: that
    /// default.
    pub(super) default: Option<String>,
    /// Why no line of it is to be written anew.
    pub(super) stays: Option<String>,
    /// Ring polymers, where it moves such.
    pub beads: Option<Beads>,
    /// The unit of its times: plain where they have no length in seconds, as in Lennard-Jones units.
    pub unit: TimeUnit,
    text: String,
    pub(super) places: Vec<(Range<usize>, Place)>,
}

/// Texts longer than this are no input of an engine.
pub(super) const LONGEST: usize = 10_000_000;

/// Levels and counts beyond these are slips of the keyboard.
pub(super) const MOST_LEVELS: usize = 16;
pub(super) const MOST_COUNT: u64 = 1_000_000;

/// Turns of a loop that are written out.
const MOST_TURNS: u64 = 1000;

/// Why engines refuse a scheme, where steps are not multiples of each other.
pub fn not_nested(scheme: &Scheme, unit: TimeUnit) -> Option<String> {
    let pair = scheme.steps().windows(2).find(|pair| !(&pair[1] / &pair[0]).is_integer())?;
    Some(format!("{} is no multiple of {}", unit.of(decimal(&pair[1])), unit.of(decimal(&pair[0]))))
}

/// For two steps that are no multiples of each other: the steps, and the outer steps beside that are
/// multiples.
pub fn nested_beside(scheme: &Scheme, unit: TimeUnit) -> Option<String> {
    let ([inner, outer], Some(why)) = (scheme.steps(), not_nested(scheme, unit)) else { return None };
    let one = Rational::from_integer(1.into());
    let [below, above] = [(outer / inner).floor(), (outer / inner).floor() + one]
        .map(|n| format!("{} ({n} of {})", unit.of(decimal(&(inner * &n))), unit.of(decimal(inner))));
    Some(format!("{why}, so no engine runs it: ask for {below} or {above}"))
}

impl Reading {
    /// Notes intervals that the engine, or a program of its, refuses beside an outermost step of so many
    /// innermost ones.
    pub(super) fn note_intervals(&mut self, by: &str, places: &[(Range<usize>, Place)], outer: u64) {
        let wrong = places.iter().filter_map(|(_, place)| match place {
            Place::Interval(interval) => interval.amiss(outer),
            _ => None,
        });
        let wrong: Vec<String> = wrong.collect();
        if !wrong.is_empty() {
            let are = if wrong.len() == 1 { "is no multiple" } else { "are no multiples" };
            let wrong = wrong.join(", ");
            self.remarks.push(format!("{by} refuses this text as it stands: {wrong} {are} of {outer}"));
        }
    }

    pub(super) fn new(engine: Engine, text: &str, scheme: Scheme) -> Reading {
        Reading {
            engine,
            scheme,
            forces: vec![],
            used: vec![],
            remarks: vec![],
            constraints: None,
            hydrogen: None,
            default: None,
            stays: None,
            beads: None,
            unit: TimeUnit::default(),
            text: text.into(),
            places: vec![],
        }
    }

    /// The text with another outermost step, all inner steps as they are.
    ///
    /// # Errors
    /// A step that is not a multiple of the one before it, or (where evaluations are counted per outermost
    /// step) of another one; a text in which the steps do not stand.
    pub fn rewritten(&self, outer: &Rational) -> Result<String> {
        let steps = self.scheme.steps();
        let shown = format!("{} fs", decimal(outer));
        if let Some(why) = &self.stays {
            return Err(Error::input("outer step", shown, why));
        }
        if self.places.is_empty() {
            return Err(Error::input("outer step", shown, "the text has no place for it"));
        }
        let before = self.scheme.last_but_one();
        if steps.len() > 1 && !(outer / before).is_integer() {
            return Err(Error::input(
                "outer step",
                shown,
                format!("choose a multiple of {} fs", decimal(before)),
            ));
        }
        let levels = steps.len();
        let step = |k: usize| if k + 1 == levels { outer } else { &steps[k] };
        let whole = |over: &Rational| {
            let count = outer / over;
            let remedy = format!("choose a multiple of {} fs", decimal(over));
            let whole = count.is_integer().then(|| count.to_integer().to_string());
            whole.ok_or_else(|| Error::input("outer step", &shown, remedy))
        };
        let mut text = self.text.clone();
        let mut places = self.places.clone();
        let is_off = outer == before && places.iter().any(|(_, place)| *place == Place::Switch);
        places.sort_by_key(|(range, _)| std::cmp::Reverse(range.start));
        for (range, place) in places {
            let number = match place {
                Place::Outer(unit) => written(&(outer / unit.size())),
                Place::PerOuter(k) => whole(step(k))?,
                Place::Loop(own) => {
                    let turns = whole(before)?.parse::<u64>().ok().filter(|n| *n <= MOST_TURNS);
                    let remedy = "that is too many turns to write out: choose a shorter one";
                    own.written(turns.ok_or_else(|| Error::input("outer step", &shown, remedy))?)
                }
                // Rounded up to 10^-6 fs, the step still gives as many inner ones.
                Place::Inner => {
                    let millionths = (self.scheme.inner() * Rational::from_integer(1_000_000.into())).ceil();
                    let own = decimal(&(millionths / Rational::from_integer(1_000_000.into())));
                    if own.contains('.') { own } else { own + ".0" }
                }
                // One clock has no ratio: the number stays.
                Place::LastRatio if is_off => continue,
                Place::Interval(_) if is_off => continue,
                Place::Switch => if is_off { "no" } else { "yes" }.into(),
                Place::LastRatio => whole(before)?,
                Place::OuterOverInner => whole(self.scheme.inner())?,
                Place::Interval(interval) => {
                    let outer = whole(self.scheme.inner())?.parse().ok().filter(|n| *n <= MOST_COUNT);
                    let remedy = "that is too many inner steps: choose a shorter one";
                    let steps =
                        interval.written(outer.ok_or_else(|| Error::input("outer step", &shown, remedy))?);
                    let added = |key: &str| {
                        steps.map_or_else(String::new, |n| at_end(&text, &range, &format!("{key} = {n}")))
                    };
                    interval.key.map_or_else(|| steps.unwrap_or(interval.steps).to_string(), added)
                }
                Place::Append(key) => at_end(&text, &range, &format!("{key} {}", whole(before)?)),
            };
            text.replace_range(range, &number);
        }
        Ok(text)
    }

    /// The lines of the rewritten text that differ from the text's own.
    ///
    /// # Errors
    /// As [`Reading::rewritten`].
    pub fn changed_lines(&self, outer: &Rational) -> Result<Vec<String>> {
        let new = self.rewritten(outer)?;
        let mut old = self.text.lines().peekable();
        let mut new = new.lines().peekable();
        let mut changed = Vec::new();
        while let Some(line) = new.next() {
            if old.next_if_eq(&line).is_some() {
                continue;
            }
            changed.push(line.trim().to_string());
            // An added line has the old one behind it, a changed one stands in its place.
            if new.peek().is_none() || new.peek() != old.peek() {
                old.next();
            }
        }
        Ok(changed)
    }
}

/// A number as every engine reads it, never larger: a decimal of twelve places if it is one, else six digits.
pub(super) fn written(x: &Rational) -> String {
    let exact = decimal(x);
    if !exact.contains('/') {
        return exact;
    }
    let ten = |k: i32| Rational::from_integer(10.into()).pow(k);
    let mut places = 0;
    while x * ten(places) >= ten(6) && places > -300 {
        places -= 1;
    }
    while x * ten(places) < ten(5) && places < 300 {
        places += 1;
    }
    let value = (x * ten(places)).floor() * ten(-places);
    if value >= ten(-6) {
        decimal(&value)
    } else {
        format!("{}e-{}", decimal(&(value * ten(places - 5))), places - 5)
    }
}

/// A line to insert where the text ended; lines inserted there before come behind it.
fn at_end(text: &str, at: &Range<usize>, line: &str) -> String {
    match (text[..at.start].ends_with('\n') || at.start == 0, text.len() > at.start) {
        (true, _) => format!("{line}\n"),
        (false, true) => format!("\n{line}"),
        (false, false) => format!("\n{line}\n"),
    }
}

/// A positive number that stands in a text, as C reads it.
pub(super) fn number(field: &str, text: &str) -> Result<Rational> {
    // A name or a formula is none.
    let plain = |c: char| c.is_ascii_digit() || matches!(c, '.' | '+' | '-' | 'e' | 'E');
    let sound = !text.is_empty() && text.len() < 40 && text.chars().all(plain);
    let lower = text.to_ascii_lowercase();
    // Exponents beyond those of doubles are none of steps.
    let small = lower
        .split_once('e')
        .is_none_or(|(_, power)| power.parse::<i32>().is_ok_and(|power| power.abs() < 300));
    // C reads 4. and +4, too.
    let plain = lower.strip_prefix('+').unwrap_or(&lower).replace(".e", ".0e");
    let plain = plain.strip_suffix('.').unwrap_or(&plain);
    let value = if sound && small { parse_rational(field, plain).ok() } else { None };
    let remedy = || {
        Error::input(field, text, "write a positive number here (variables and formulas are not evaluated)")
    };
    value.filter(|value| *value > Rational::default()).ok_or_else(remedy)
}

/// The same as Fortran reads it, 1d0 too.
pub(super) fn fortran(field: &str, text: &str) -> Result<Rational> {
    number(field, &text.replace(['d', 'D'], "e"))
}

/// A positive whole number that stands in a text.
pub(super) fn count(field: &str, text: &str) -> Result<u64> {
    let count = text.parse::<u64>().ok().filter(|n| (1..=MOST_COUNT).contains(n));
    count.ok_or_else(|| Error::input(field, text, "write a whole number from 1 to a million"))
}

/// What is to be known of forces that are predicted directly, where there are any.
pub(super) fn no_gradient(names: &[&str]) -> Option<String> {
    let are = match names {
        [] => return None,
        [_] => "is",
        _ => "are",
    };
    let names = names.join(", ");
    Some(format!(
        "{names} {are} predicted directly (non_conservative), as no gradient of an energy: a motion may grow whatever the steps are. Periods describe an \
         energy, so give the Jacobians too: kickdrift.ase.system(..., symmetric=False)"
    ))
}

/// Steps from the innermost to the outermost one, equal ones once.
pub(super) fn scheme(mut steps: Vec<Rational>) -> Result<Scheme> {
    steps.dedup();
    Scheme::new(steps)
}

pub(super) fn times(step: &Rational, n: u64) -> Rational {
    step * Rational::from_integer(n.into())
}
