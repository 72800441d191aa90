//! All unstable intervals of one number of a file, none missed.
//!
//! * `outer`: the outer step, all steps in their ratios as in the file;
//! * the path of a step: its multiples of the shortest of the others (the inner steps are what they are), each decided;
//! * the path of a scale, a stiffness, a spring, a mass: the number itself.

use std::fmt::{Display, Formatter};
use std::str::FromStr;

use super::SystemScene;
use super::scan::MOST_POINTS;
use crate::error::{Error, Result};
use crate::number::Rational;
use crate::number::parse::parse_rational_range;
use crate::number::rational::{from_f64_exact, to_f64};
use crate::system::edges::{Family, Linear};
use crate::system::nearest::Nearest;
use crate::system::stretches::Stretch;
use crate::system::stretches::merged;
use crate::system::vary::Intervals;
use crate::system::{Analysis, Holds, Limits, Potential, Route, System, middle};

/// One number of a file and its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    text: String,
    path: String,
    lo: Rational,
    hi: Rational,
}

impl FromStr for Span {
    type Err = Error;

    /// From `PATH=LO..HI`.
    ///
    /// # Errors
    /// A text of another form, an empty range.
    fn from_str(text: &str) -> Result<Span> {
        let form =
            || Error::input("intervals", text, "write PATH=LO..HI, as outer=0.004..0.005 or masses.0=1..2");
        let (path, range) = text.split_once('=').ok_or_else(form)?;
        let (lo, hi) = parse_rational_range("intervals", range)?;
        if lo == hi {
            return Err(Error::input(
                "intervals",
                text,
                "the range is empty: write the smaller number first",
            ));
        }
        Ok(Span { text: text.into(), path: path.trim().into(), lo, hi })
    }
}

impl Display for Span {
    fn fmt(&self, f: &mut Formatter) -> std::fmt::Result {
        f.write_str(&self.text)
    }
}

/// What a number is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    Outer,
    Step,
    /// Stiffnesses or masses depend on it linearly.
    Linear,
}

/// Names after which numbers enter stiffnesses or masses linearly.
const LINEAR: [&str; 11] = [
    "scale",
    "springs",
    "stiffness",
    "masses",
    "mass_matrix",
    "k",
    "stiff",
    "soft",
    "young",
    "density",
    "thickness",
];

impl Span {
    fn role(&self) -> Result<Role> {
        let name = self.path.split('.').rfind(|key| key.parse::<usize>().is_err()).unwrap_or_default();
        match name {
            "outer" => Ok(Role::Outer),
            "step" | "steps" => Ok(Role::Step),
            _ if LINEAR.contains(&name) => Ok(Role::Linear),
            _ => {
                let remedy = "name outer, or the path of a step, a scale, a stiffness, a spring or a mass";
                Err(Error::input("intervals", &self.path, remedy))
            }
        }
    }

    fn ends(&self) -> (f64, f64) {
        (to_f64(&self.lo), to_f64(&self.hi))
    }
}

impl SystemScene {
    /// The verdicts on all values of a number in a range, no interval wider than `width` times its larger end missed.
    ///
    /// # Errors
    /// A number that is none of these, nonlinear bonds, irrational quantities, friction; a budget error, before the work; as
    /// [`Family::stretches`].
    pub fn intervals(&self, span: &Span, width: f64, limits: &Limits) -> Result<Intervals> {
        self.allow_intervals("intervals", limits)?;
        let role = span.role()?;
        if role == Role::Outer && span.lo <= Rational::default() {
            return Err(Error::input("intervals", span, "steps are positive"));
        }
        let levels = self.measured.as_ref().filter(|own| own.is_of_two_levels());
        let is_scale = span.path.ends_with(".scale");
        let (inner_steps, stretches) = match (role, levels) {
            (Role::Outer, _) => self.outer_stretches(span.ends(), width, limits)?,
            (Role::Step, _) => (None, self.multiples(span, limits)?),
            (Role::Linear, Some(own)) if is_scale => {
                let (level, factor) = own.scaled_at(&span.path)?;
                (None, own.stretches_of_scale(level, span.ends(), factor, width)?)
            }
            (Role::Linear, _) => {
                let at = |x: &Rational| Ok(self.with("intervals", &[(&span.path, x)])?.system().clone());
                let family = Family { linear: Linear::Number, at: &at };
                (None, family.stretches(span.ends(), width, limits)?)
            }
        };
        Ok(Intervals { number: span.path.clone(), is_discrete: role == Role::Step, inner_steps, stretches })
    }

    /// The largest growth rate at each value of the number, per unit time, rounded; `None` where it is not told.
    ///
    /// # Errors
    /// As [`SystemScene::intervals`] and [`SystemScene::decide`].
    pub fn growth_rates(&self, span: &Span, values: &[f64], limits: &Limits) -> Result<Vec<Option<f64>>> {
        let role = span.role()?;
        if let (Role::Outer, Some(own)) = (role, self.measured.as_ref().filter(|own| own.is_of_two_levels()))
        {
            return own.growth_rates(values);
        }
        // Some milliseconds a rate, whose last digits nobody sees.
        let limits = &Limits { refining: 1 << 20, ..*limits };
        let rate = |&value: &f64| {
            let analysis = match role {
                Role::Outer => self.decide_at(&exact(value), limits)?,
                _ => {
                    self.with("intervals", &[(&span.path, &exact(value))])?.decide(Route::Cheapest, limits)?
                }
            };
            Ok(analysis.growth_rate().map(middle))
        };
        crate::parallel::try_map(values, rate)
    }

    /// The verdict with the outer step `outer` > 0, all steps in the proportions of the file.
    ///
    /// # Errors
    /// As [`SystemScene::decide`].
    pub fn decide_at(&self, outer: &Rational, limits: &Limits) -> Result<Analysis> {
        if let Some(own) = self.measured.as_ref().filter(|own| own.is_of_two_levels()) {
            return own.decide_at(outer, limits);
        }
        let factor = outer / self.outer_step();
        if let Some(own) = &self.with_pi {
            return own.slowed(&factor)?.decide(Route::Cheapest, limits);
        }
        let slowed = self.slowed(&factor)?;
        SystemScene::linear(self.source.clone(), String::new(), slowed).decide(Route::Cheapest, limits)
    }

    /// The unstable intervals of the outer step next to the one of the file, all steps in their ratios: between half of it and twice it.
    ///
    /// # Errors
    /// As [`SystemScene::intervals`].
    pub fn nearest_unstable(&self, width: f64, limits: &Limits) -> Result<Nearest> {
        self.allow_intervals("nearest", limits)?;
        let step = to_f64(&self.steps().into_iter().max().unwrap_or_default());
        if !self.measured.as_ref().is_some_and(|own| own.is_of_two_levels()) {
            let at = |square: &Rational| self.at_square(square);
            let family = Family { linear: Linear::Square, at: &at };
            if let Some(all) = family.exactly(Nearest::reach(step), limits)? {
                return Ok(Nearest::of(step, &all));
            }
        }
        let own = self.decide(Route::Cheapest, limits)?.holds();
        Nearest::search((step, own), |range| Ok(self.outer_stretches(range, width, limits)?.1))
    }

    /// What has no intervals is refused, and what costs too much.
    fn allow_intervals(&self, field: &str, limits: &Limits) -> Result<()> {
        let refused = |what: &str, remedy: &str| Err(Error::input(field, what, remedy));
        if self.friction.is_some() {
            return refused("with friction", "take the friction out of the file");
        }
        if !self.is_linear() || self.oscillator.is_some() || self.with_pi.is_some() {
            return refused("of this file", "are for linear systems of rational numbers");
        }
        limits.allow(self.cost(), || format!("a verdict on {} degrees of freedom", self.size()))
    }

    /// The verdicts on a range of outer steps, all steps in their ratios, and the inner steps in each where these are two levels.
    fn outer_stretches(
        &self,
        range: (f64, f64),
        width: f64,
        limits: &Limits,
    ) -> Result<(Option<u64>, Vec<Stretch>)> {
        match self.measured.as_ref().filter(|own| own.is_of_two_levels()) {
            Some(own) => own.stretches(range, width).map(|(inner_steps, found)| (Some(inner_steps), found)),
            None => {
                let at = |square: &Rational| self.at_square(square);
                let family = Family { linear: Linear::Square, at: &at };
                Ok((None, family.stretches(range, width, limits)?))
            }
        }
    }

    fn outer_step(&self) -> Rational {
        let steps = self.system().potentials().iter().map(|own| own.step.clone());
        steps.max().unwrap_or_default()
    }

    /// All steps times a factor.
    fn slowed(&self, factor: &Rational) -> Result<System> {
        let slowed = |own: &Potential| Potential { step: &own.step * factor, ..own.clone() };
        System::new(self.system().mass().clone(), self.system().potentials().iter().map(slowed).collect())
    }

    /// The system with the outer step whose square is given, all steps in their ratios: in the old steps all stiffnesses by as much as the
    /// square grows.
    fn at_square(&self, square: &Rational) -> Result<System> {
        let own = self.outer_step();
        let factor = square / (&own * &own);
        let stiffer = |own: &Potential| Potential { stiffness: own.stiffness.scaled(&factor), ..own.clone() };
        System::new(self.system().mass().clone(), self.system().potentials().iter().map(stiffer).collect())
    }

    /// The multiples of the shortest of the other steps, each alone: stretches from one multiple to another.
    fn multiples(&self, span: &Span, limits: &Limits) -> Result<Vec<Stretch>> {
        // A step that no other has: with it in place, the shortest of the rest.
        let far = self.outer_step() * Rational::from_integer(2.into());
        let steps = self.with("intervals", &[(&span.path, &far)])?.steps();
        let inner = steps.into_iter().filter(|step| *step != far).min();
        let inner =
            inner.ok_or_else(|| Error::input("intervals", &span.path, "is the only step: name outer"))?;
        let (first, last) = ((&span.lo / &inner).ceil(), (&span.hi / &inner).floor());
        let count = (&last - &first).to_integer();
        if first > last || count >= MOST_POINTS.into() || first <= Rational::default() {
            let remedy = format!("choose a range that holds 1 to {MOST_POINTS} multiples of {inner}");
            return Err(Error::input("intervals", span, remedy));
        }
        let next = |k: &Rational| Some(k + Rational::from_integer(1.into())).filter(|k| *k <= last);
        let values: Vec<_> = std::iter::successors(Some(first), next).map(|k| k * &inner).collect();
        let stretch = |step: &Rational| {
            let verdict = self.with("intervals", &[(&span.path, step)])?.holds(limits)?;
            Ok(Stretch { lo: to_f64(step), hi: to_f64(step), verdict })
        };
        Ok(merged(crate::parallel::try_map(&values, stretch)?.into_iter()))
    }

    fn steps(&self) -> Vec<Rational> {
        match &self.measured {
            Some(own) => own.steps(),
            None => self.system().potentials().iter().map(|own| own.step.clone()).collect(),
        }
    }

    /// What is proven of the system.
    fn holds(&self, limits: &Limits) -> Result<Holds> {
        match self.measured.as_ref().and_then(|own| own.holds().transpose()) {
            Some(holds) => holds,
            None => Ok(self.decide(Route::Cheapest, limits)?.holds()),
        }
    }
}

fn exact(x: f64) -> Rational {
    from_f64_exact(x).expect("a finite end of a cell")
}
