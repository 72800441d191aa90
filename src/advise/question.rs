//! The question of advice: modes on clocks, schemes of steps, a band about the periods.

use num_traits::{One, Zero};

use super::levels::Scheme;
use super::mode::Mode;
use crate::error::{Error, Result};
use crate::number::{Laurent, Rational};
use crate::schedule::Schedule;
use crate::verdict::Limits;

/// Modes, the schemes that they are asked about, and how well the periods are known.
#[derive(Clone, Debug)]
pub struct Question {
    /// Each on a clock.
    pub(super) modes: Vec<Mode>,
    /// All with as many steps.
    pub(super) schemes: Vec<Scheme>,
    /// Every period may be shorter (or longer) by this part of itself.
    pub(super) band: Rational,
    /// The length of the run in fs.
    pub(super) length: Option<Rational>,
    /// Modes that constraints hold.
    pub(super) held: Vec<Mode>,
    /// Of the thermostat, per fs.
    pub(super) friction: Option<Rational>,
    /// Whether it is asked what would let the step grow.
    pub(super) levers: bool,
    /// Whether the periods are the shortest of all motions on their clocks.
    pub(super) all_modes: bool,
    /// The highest cost of the advice.
    pub(super) limits: Limits,
}

/// Periods that are followed for a scheme: verdicts, edges of intervals, multiples of the inner step.
const PERIODS: u64 = 1000;

/// Schemes and modes beyond these numbers are a slip of the keyboard.
const MOST_SCHEMES: usize = 1000;
const MOST_MODES: usize = 1000;

impl Question {
    /// The question, if it makes sense. A mode without a clock gets one by its place: with K steps the last K − 1 modes are on the slower
    /// clocks, in order, and all before them on the fastest; with fewer modes than steps, each on the clock of its place.
    ///
    /// # Errors
    /// No mode, no scheme, schemes with different numbers of steps, a clock that there is not, two modes of one name, a band outside [0, 1).
    pub fn new(mut modes: Vec<Mode>, schemes: Vec<Scheme>, band: Rational) -> Result<Question> {
        let missing = |field: &str, remedy: &str| Err(Error::missing(field, remedy));
        let Some(first) = schemes.first() else {
            return missing("steps", "give the steps from the innermost to the outermost one, as 0.5fs,4fs");
        };
        if modes.is_empty() {
            return missing("period", "give the period of at least one force, as OH=10fs, or a bond");
        }
        if schemes.len() > MOST_SCHEMES || modes.len() > MOST_MODES {
            let given = format!("{} modes, {} schemes of steps", modes.len(), schemes.len());
            return Err(Error::input("question", given, "ask about a thousand of each at most"));
        }
        let clocks = first.steps().len();
        if let Some(other) = schemes.iter().find(|scheme| scheme.steps().len() != clocks) {
            let given = format!("{} and {clocks} of them", other.steps().len());
            return Err(Error::input("steps", given, "give every scheme as many steps"));
        }
        check_band(&band)?;
        let count = modes.len();
        for (i, mode) in modes.iter_mut().enumerate() {
            let place = if count < clocks { i } else { (i + clocks).saturating_sub(count) };
            let clock = *mode.clock.get_or_insert(place);
            if clock >= clocks {
                let remedy =
                    format!("there are {clocks} steps: choose a clock from 1 to {clocks}, 1 the fastest");
                return Err(Error::input(&format!("the clock of {}", mode.name), clock + 1, remedy));
            }
        }
        for (i, mode) in modes.iter().enumerate() {
            if modes[..i].iter().any(|other| other.name == mode.name) {
                return Err(Error::input(
                    "name",
                    &mode.name,
                    "two modes have this name: give each its own, as OH=10fs",
                ));
            }
        }
        Ok(Question {
            modes,
            schemes,
            band,
            length: None,
            held: Vec::new(),
            friction: None,
            levers: false,
            all_modes: false,
            limits: Limits::default(),
        })
    }

    /// Answers within these limits.
    #[must_use]
    pub fn within(self, limits: Limits) -> Question {
        Question { limits, ..self }
    }

    /// The kicks that the advice follows, about.
    pub fn cost(&self) -> u64 {
        let strikes = |scheme: &Scheme| {
            Schedule::new(scheme.steps(), &vec![Rational::zero(); scheme.steps().len()])
                .map_or(u64::MAX, |all| all.strikes())
        };
        self.schemes.iter().map(|scheme| strikes(scheme).saturating_mul(PERIODS)).max().unwrap_or(0)
    }

    /// # Errors
    /// A budget error where a ratio of steps makes too long a period.
    pub(super) fn allow(&self) -> Result<()> {
        let (cost, most) = (self.cost(), self.limits.kicks);
        if cost <= most {
            return Ok(());
        }
        let work = format!("advice on these steps follows about {cost} kicks, the budget is {most}");
        Err(Error::budget(work, cost).or("choose steps with a simpler ratio"))
    }

    /// Asks about a run of this length in fs.
    ///
    /// # Errors
    /// A length that is not positive.
    pub fn of_length(mut self, length: Rational) -> Result<Question> {
        check_length(&length)?;
        self.length = Some(length);
        Ok(self)
    }

    /// Lists these modes, which constraints hold, in the answer.
    #[must_use]
    pub fn holding(mut self, held: Vec<Mode>) -> Question {
        self.held = held;
        self
    }

    /// Adds a friction per fs, O in the middle of every drift (BAOAB).
    ///
    /// # Errors
    /// A friction that is not positive.
    pub fn with_friction(mut self, rate: Rational) -> Result<Question> {
        check_friction(&rate)?;
        self.friction = Some(rate);
        Ok(self)
    }

    /// Asks also which levers would let the step grow.
    #[must_use]
    pub fn with_levers(self, levers: bool) -> Question {
        Question { levers, ..self }
    }

    /// States whether the periods given are the shortest of all motions on their clocks.
    #[must_use]
    pub fn knowing_all_modes(self, all_modes: bool) -> Question {
        Question { all_modes, ..self }
    }

    /// The number of clocks.
    pub(super) fn clocks(&self) -> usize {
        self.schemes[0].steps().len()
    }

    /// The stiffest mode on each clock; `None` where a clock has none.
    pub(super) fn stiffest(&self) -> Vec<Option<usize>> {
        let on = |clock: usize| (0..self.modes.len()).filter(move |&i| self.modes[i].clock == Some(clock));
        let stiffness = |&i: &usize| &self.modes[i].stiffness;
        (0..self.clocks()).map(|clock| on(clock).max_by(|i, j| stiffness(i).cmp(stiffness(j)))).collect()
    }

    /// The modes that resonate with an outer clock: those on any clock but the outermost, or all where there is but one.
    pub(super) fn faster(&self) -> Vec<usize> {
        let last = self.clocks() - 1;
        let inner: Vec<usize> =
            (0..self.modes.len()).filter(|&i| last == 0 || self.modes[i].clock != Some(last)).collect();
        if inner.is_empty() { (0..self.modes.len()).collect() } else { inner }
    }

    /// One mass: this mode on its clock, on the others the stiffest modes.
    pub(super) fn with(&self, mode: usize) -> Vec<Laurent> {
        let of = |i: Option<usize>| i.map_or_else(Laurent::zero, |i| self.modes[i].stiffness.clone());
        let mut stiffness: Vec<Laurent> = self.stiffest().into_iter().map(of).collect();
        stiffness[self.modes[mode].clock.expect("every mode has a clock")] =
            self.modes[mode].stiffness.clone();
        stiffness
    }
}

/// # Errors
/// A band outside [0, 1).
pub(super) fn check_band(band: &Rational) -> Result<()> {
    if *band >= Rational::zero() && *band < Rational::one() {
        return Ok(());
    }
    Err(Error::input("band", band, "write a part of the period from 0 to below 1, as 5%"))
}

/// # Errors
/// A friction that is not positive.
pub(super) fn check_friction(rate: &Rational) -> Result<()> {
    if *rate > Rational::zero() {
        return Ok(());
    }
    Err(Error::input("friction", rate, "a friction must be positive"))
}

/// # Errors
/// A length of a run that is not positive.
pub(super) fn check_length(length: &Rational) -> Result<()> {
    if *length > Rational::zero() {
        return Ok(());
    }
    Err(Error::input("length", length, "a run has a positive length, as 10ns"))
}
