//! The stiffnesses, window and system that a page starts on.

use num_traits::Pow;

use clocks::propagator::Oscillator;
use documents::input::SystemScene;
use documents::question::{Scene, StepRange};
use number::parse::parse;
use number::{Error, ExactSign, Laurent, Rational, Result, Sign, rational};

/// The stiffnesses, window and system that a page starts on; every question may name others.
#[derive(Debug)]
#[must_use]
pub struct Session {
    stiffnesses: Option<(Laurent, Laurent)>,
    window: [StepRange; 2],
    /// The spacing of the map, about a thousandth of the window where none was given.
    step: Rational,
    /// The unit of time, where there is one.
    unit: Option<String>,
    title: String,
    system: Option<SystemScene>,
}

/// Points of a map across the window, about.
const ACROSS: f64 = 1000.0;

impl Session {
    /// Two stiffnesses, the window reaching to where either clock alone is unstable.
    ///
    /// # Errors
    /// λ1 ≤ 0, and stiffnesses beyond doubles.
    pub fn new(lambda1: Laurent, lambda2: Laurent) -> Result<Session> {
        // It is checked where it is used by others.
        Oscillator::new(
            lambda1.clone(),
            lambda2.clone(),
            Laurent::from_integer(1),
            Laurent::from_integer(1),
        )?;
        let window = natural(&lambda1, &lambda2)?;
        Ok(Session {
            step: spacing(&window).ok_or_else(|| beyond("lambda1", &lambda1))?,
            window,
            stiffnesses: Some((lambda1, lambda2)),
            unit: None,
            title: String::new(),
            system: None,
        })
    }

    /// The paper's Figure 1: λ1 = π², λ2 = π²/25.
    pub fn figure1() -> Session {
        let x = |text| parse("figure 1", text).expect("a number");
        let session = Session::new(x("pi^2"), x("pi^2/25")).expect("positive");
        let session = session.within([(x("0"), x("2/pi")), (x("0"), x("7/2"))]);
        Session { step: rational::ratio(1, 1000), ..session }
    }

    /// The plane of a scene.
    ///
    /// # Errors
    /// A stiffness that is not there.
    pub fn of_scene(scene: &Scene) -> Result<Session> {
        let known = |field: &str, given: &Option<Laurent>| {
            given
                .clone()
                .ok_or_else(|| Error::missing(field, "the page needs both stiffnesses: add it to the scene"))
        };
        let mut session = Session::new(known("lambda1", &scene.lambda1)?, known("lambda2", &scene.lambda2)?)?;
        session.title = scene.title.clone();
        if let (Some(h1), Some(h2)) = (&scene.h1_range, &scene.h2_range) {
            session = session.within([h1.clone(), h2.clone()]);
            session.step = scene.step1.as_ref().and_then(Laurent::as_rational).unwrap_or(session.step);
        }
        Ok(match (&scene.window_h1, &scene.window_h2) {
            (Some(h1), Some(h2)) => session.within([h1.clone(), h2.clone()]),
            _ => session,
        })
    }

    /// A system; its two springs' plane where it is two clocks on one oscillator.
    pub fn of_system(system: SystemScene) -> Session {
        let two = system.model().two_clocks();
        let known = two.and_then(|two| Session::new(two.lambda1().clone(), two.lambda2().clone()).ok());
        let mut session = known.unwrap_or_else(|| Session { stiffnesses: None, ..Session::figure1() });
        session.title = system.title().into();
        session.unit = system.time_unit().map(Into::into);
        session.system = Some(system);
        session
    }

    /// Takes another window. One without width, or beyond doubles, cannot be shown: the session keeps its
    /// own.
    pub fn within(self, window: [StepRange; 2]) -> Session {
        match spacing(&window) {
            Some(step) => Session { step, window, ..self },
            None => self,
        }
    }

    /// Takes a unit of time.
    pub fn in_unit(self, unit: &str) -> Session {
        Session { unit: Some(unit.into()), ..self }
    }

    /// That a plane of these stiffnesses can be shown.
    ///
    /// # Errors
    /// As [`Session::new`], but for the sign of λ1.
    pub(super) fn shows((lambda1, lambda2): &(Laurent, Laurent)) -> Result<()> {
        if lambda1.sign() == Sign::Positive { natural(lambda1, lambda2).map(drop) } else { Ok(()) }
    }

    pub(super) fn stiffnesses(&self) -> Option<&(Laurent, Laurent)> {
        self.stiffnesses.as_ref()
    }

    pub(super) fn window(&self) -> &[StepRange; 2] {
        &self.window
    }

    pub(super) fn step(&self) -> &Rational {
        &self.step
    }

    pub(super) fn unit(&self) -> Option<&str> {
        self.unit.as_deref()
    }

    pub(super) fn title(&self) -> &str {
        &self.title
    }

    pub(super) fn system(&self) -> Option<&SystemScene> {
        self.system.as_ref()
    }
}

/// 0 to the Verlet limit 2/√λ of either clock; where the slow one has none, as far as Figure 1 goes: to 3.5
/// half periods of the fast one.
///
/// # Errors
/// Stiffnesses beyond doubles.
fn natural(lambda1: &Laurent, lambda2: &Laurent) -> Result<[StepRange; 2]> {
    let limit = |lambda: &Laurent| 2.0 / lambda.to_f64().sqrt();
    let value = if lambda2.sign() == Sign::Positive { 1.1 * limit(lambda2) } else { f64::INFINITY };
    let most = 3.5 * std::f64::consts::FRAC_PI_2 * limit(lambda1);
    let to = |x: f64| Some((Laurent::from_integer(0), Laurent::from_rational(short(x, 2)?)));
    let h1 = to(limit(lambda1)).ok_or_else(|| beyond("lambda1", lambda1))?;
    let h2 = to(value.min(most.max(limit(lambda1)))).ok_or_else(|| beyond("lambda2", lambda2))?;
    if lambda2.to_f64().is_finite() { Ok([h1, h2]) } else { Err(beyond("lambda2", lambda2)) }
}

fn beyond(field: &str, lambda: &Laurent) -> Error {
    Error::input(field, lambda, "is too large or too small to be drawn: choose another unit of time")
}

/// A thousandth of the window's smaller side, to one digit; `None` for windows without width, and beyond
/// doubles.
fn spacing([h1, h2]: &[StepRange; 2]) -> Option<Rational> {
    let width = |(lo, hi): &StepRange| hi.to_f64() - lo.to_f64();
    // The larger one as it is: NaN and infinity are no widths.
    let (smaller, larger) = (width(h1).min(width(h2)), width(h1).max(width(h2)));
    short(larger, 1).and_then(|_| short(smaller / ACROSS, 1))
}

/// x to so many significant digits, rounded up in the last one; `None` unless it is a positive number.
fn short(x: f64, digits: i32) -> Option<Rational> {
    if !(x > 0.0 && x.is_finite()) {
        return None;
    }
    let exponent = (x.log10().floor() as i32).saturating_sub(digits - 1);
    let ten = Rational::from_integer(10.into());
    let power = |n: i32| Pow::pow(&ten, n.unsigned_abs());
    let unit = if exponent < 0 { power(exponent).recip() } else { power(exponent) };
    Some((rational::from_f64_exact(x)? / &unit).ceil() * unit)
}
