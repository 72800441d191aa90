//! The question of advice: modes on clocks, schemes of steps, a band about the periods.

use num_traits::{One, Zero};

use super::aperture::Cold;
use super::beads::Beads;
use super::caps::Caps;
use super::levels::Scheme;
use super::mode::Mode;
use super::unit::TimeUnit;
use clocks::schedule::Schedule;
use clocks::verdict::Limits;
use number::{Error, Laurent, Rational, Result};

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
    /// Whether bonds are said to be harmonic: then a clock's own step has no bound but the proven one.
    pub(super) harmonic: bool,
    /// Of bonds whose shape is known: where they begin to be too hot, by each kind of scheme.
    pub(super) cold: Vec<Cold>,
    /// Ring polymers in place of atoms.
    pub(super) beads: Option<Beads>,
    /// The unit of all times.
    pub(super) unit: TimeUnit,
    /// The highest cost of the advice.
    pub(super) limits: Limits,
}

/// Periods that are followed for a scheme: verdicts, edges of intervals, multiples of the inner step.
const PERIODS: u64 = 1000;

/// The same where edges are found by balls, of three clocks and more: 8 ms for each kick of a period,
/// measured, at 5,000 kicks a ms.
const PERIODS_OF_MANY: u64 = 40_000;

/// Schemes and modes beyond these numbers are a slip of the keyboard.
const MOST_SCHEMES: usize = 1000;
const MOST_MODES: usize = 1000;

/// Gives each mode without a clock one by its place: with K steps the last K − 1 modes are on the slower
/// clocks, in order, and all before them on the fastest; with fewer modes than steps, each on the clock of
/// its place. What is called fast comes before all others and is on the fastest clock, what is called slow
/// comes last and is never there.
pub fn place(modes: &mut [Mode], clocks: usize) {
    let count = modes.len();
    let rank = |mode: &Mode| u8::from(mode.is_called_slow()) + u8::from(!mode.is_called_fast());
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by_key(|&i| rank(&modes[i]));
    for (i, at) in order.into_iter().enumerate() {
        let mode = &mut modes[at];
        let by_order = if count < clocks { i } else { (i + clocks).saturating_sub(count) };
        let place = match () {
            () if mode.is_called_fast() => 0,
            () if mode.is_called_slow() && (count < clocks || by_order == 0) => clocks - 1,
            () => by_order,
        };
        mode.clock.get_or_insert(place);
    }
}

impl Question {
    /// The question, if it makes sense; a mode without a clock gets one ([`place`]).
    ///
    /// # Errors
    /// No mode, no scheme, schemes with different numbers of steps, a clock that there is not, two modes of
    /// one name, a band outside [0, 1).
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
        place(&mut modes, clocks);
        for mode in &modes {
            let clock = mode.clock.expect("just placed");
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
            harmonic: false,
            cold: Vec::new(),
            beads: None,
            unit: TimeUnit::default(),
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
        let is_many = self.clocks() > 2 || self.stiffest()[0].is_none();
        let periods = if is_many { PERIODS_OF_MANY } else { PERIODS };
        // Where balls find the edges, scheme by scheme.
        let costs = self.schemes.iter().map(|scheme| strikes(scheme).saturating_mul(periods));
        if is_many { costs.fold(0, u64::saturating_add) } else { costs.max().unwrap_or(0) }
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

    /// States whether the bonds are harmonic.
    #[must_use]
    pub fn with_harmonic_bonds(self, harmonic: bool) -> Question {
        Question { harmonic, ..self }
    }

    /// Measures up to which steps of their own the bonds of a known shape stay at a temperature in K, where
    /// so many independent energies are seen.
    ///
    /// # Errors
    /// Where somebody has stopped the work.
    pub fn at_temperature(mut self, temperature: &Rational, seen: &Rational) -> Result<Question> {
        let shaped = self.modes.iter().filter_map(|mode| Some((&mode.name, mode.shape.as_ref()?)));
        let cold = shaped.map(|(name, bond)| Cold::of(name, bond, temperature, seen));
        self.cold = cold.collect::<Result<Vec<_>>>()?.concat();
        Ok(self)
    }

    /// Asks about ring polymers of so many beads.
    #[must_use]
    pub fn with_beads(self, beads: Option<Beads>) -> Question {
        Question { beads: beads.filter(|beads| beads.count > 1), ..self }
    }

    /// States the unit of all times.
    #[must_use]
    pub fn in_units_of(self, unit: TimeUnit) -> Question {
        Question { unit, ..self }
    }

    /// Whether nothing is known of the fastest clock: no mode is on it, or all are called slow where there is
    /// but one.
    pub(super) fn lacks_fast(&self) -> bool {
        let fast = |mode: &Mode| mode.clock == Some(0) && (self.clocks() > 1 || !mode.is_called_slow());
        !self.modes.iter().any(fast)
    }

    /// What bounds the steps beside linear theory.
    pub(super) fn caps(&self) -> Caps {
        let shortest = |period: &dyn Fn(&Mode) -> Option<f64>| -> Vec<Option<f64>> {
            let on = |clock: usize| self.modes.iter().filter(move |mode| mode.clock == Some(clock));
            (0..self.clocks()).map(|clock| on(clock).filter_map(period).reduce(f64::min)).collect()
        };
        let is_measured = |mode: &Mode| self.cold.iter().any(|cold| cold.name == mode.name);
        let caps = Caps::new(&shortest(&|mode| Some(mode.period().0)), self.harmonic);
        if self.cold.is_empty() {
            return caps;
        }
        let other = |mode: &Mode| (!is_measured(mode)).then(|| mode.period().0);
        // Of all kinds of schemes. Surroundings make the period of a shape longer: these bonds are colder.
        let cold = |mode: &Mode| {
            let own = self.cold.iter().filter(|cold| cold.name == mode.name);
            let least = own.filter_map(|cold| cold.first).map(|edge| edge.bound()).reduce(f64::min)?;
            Some((mode.period().0 * least).next_down())
        };
        caps.with_measured(&Caps::new(&shortest(&other), self.harmonic), &shortest(&cold))
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

    /// The modes that resonate with an outer clock: those on any clock but the outermost, or all where there
    /// is but one.
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

/// That a band is a part of the period.
///
/// # Errors
/// A part outside [0, 1).
pub fn check_band(band: &Rational) -> Result<()> {
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
