//! All unstable intervals of one number of a file, none missed.
//!
//! * `outer`: the outer step, all steps in their ratios as in the file;
//! * the path of a step: its multiples of the shortest of the others (the inner steps are what they are),
//!   each decided;
//! * the path of a scale, a stiffness, a spring, a mass: the number itself.

use std::fmt::{Display, Formatter};
use std::str::FromStr;

use num_traits::Zero;
use serde_json::Value;

use super::SystemScene;
use super::document::SIZES;
use super::part::Number as Written;
use super::scan::{MOST_POINTS, found};
use number::parse::parse_rational_range;
use number::{Error, Rational, Result, from_f64_exact, to_f64};
use systems::nearest::Nearest;
use systems::stretches::{Stretch, merged};
use systems::vary::Intervals;
use systems::{Limits, Number, Route, middle};

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
        let is_in_range = |x: &Rational| x.is_zero() || SIZES.contains(&to_f64(x).abs());
        if !(is_in_range(&lo) && is_in_range(&hi)) {
            return Err(Error::input("intervals", text, "give ends that are 0 or 1e-150 to 1e150 in size"));
        }
        Ok(Span { text: text.into(), path: path.trim().into(), lo, hi })
    }
}

impl Span {
    /// The least and the largest value.
    pub fn range(&self) -> (&Rational, &Rational) {
        (&self.lo, &self.hi)
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

/// What is asked of the unstable steps, in words.
pub const NEAREST: &str = "the unstable steps next to its own";

impl SystemScene {
    /// The verdicts on all values of a number in a range, no interval wider than `width` times its larger end
    /// missed.
    ///
    /// # Errors
    /// A number that is none of these, nonlinear bonds, irrational quantities, friction; a budget error,
    /// before the work; as [`Model::between`](systems::Model::between).
    pub fn intervals(&self, span: &Span, width: f64, limits: &Limits) -> Result<Intervals> {
        self.cost_of_intervals(span, width, limits)?;
        let (role, inner_steps) = (span.role()?, self.model.inner_steps());
        let (stretches, open) = match role {
            Role::Step => (self.multiples(span, limits)?, None),
            _ => self.over(span, limits, |number| {
                let stretches = self.model.stretches(number, span.ends(), width, limits)?;
                let open = self.model.open_by_accuracy(number, &stretches, limits)?;
                Ok((stretches, open))
            })?,
        };
        let inner_steps =
            inner_steps.filter(|_| role == Role::Outer && self.model.method().has_inner_steps());
        let is_discrete = role == Role::Step;
        Ok(Intervals { number: span.path.clone(), is_discrete, inner_steps, stretches, open })
    }

    /// The products that these cost, roughly, where cells are narrow throughout.
    ///
    /// # Errors
    /// As [`SystemScene::intervals`].
    pub fn cost_of_intervals(&self, span: &Span, width: f64, limits: &Limits) -> Result<f64> {
        let cost = match span.role()? {
            Role::Step => {
                self.allow_intervals("intervals", limits)?;
                self.multiples_of(span)?.len() as f64 * self.model.cost() as f64
            }
            _ => self.over(span, limits, |number| {
                self.model.cost_of_stretches(number, span.ends(), width, limits)
            })?,
        };
        self.allowed(cost, limits, || format!("intervals of {span}"))
    }

    /// A cost that the limits allow.
    fn allowed(&self, cost: f64, limits: &Limits, what: impl FnOnce() -> String) -> Result<f64> {
        let remedy = "choose a shorter range or a larger resolution";
        limits.allow(cost.min(1e19) as u64, what).map_err(|error| error.or(remedy)).map(|()| cost)
    }

    /// What `ask` finds of a number that is no step.
    fn over<T>(&self, span: &Span, limits: &Limits, ask: impl FnOnce(&Number) -> Result<T>) -> Result<T> {
        self.allow_intervals("intervals", limits)?;
        let role = span.role()?;
        if role == Role::Outer && span.lo <= Rational::default() {
            return Err(Error::input("intervals", span, "steps are positive"));
        }
        let at = |x: &Rational| Ok(self.with("intervals", &[(&span.path, x)])?.model.moving()?.into_owned());
        match role {
            Role::Outer => ask(&Number::Outer),
            Role::Linear if self.model.inner_steps().is_some() && span.path.ends_with(".scale") => {
                let (level, factor) = self.scale(&span.path)?;
                ask(&Number::Scale(level, factor))
            }
            Role::Linear if self.model.measured().is_ok() => {
                let remedy = "of measured stiffnesses name outer, a step, or the scale of one of two levels; --scan decides single values of other scales";
                Err(Error::input("intervals", &span.path, remedy))
            }
            Role::Step | Role::Linear => ask(&Number::Linear(&at)),
        }
    }

    /// Which of two measured levels the scale at a path is of, 0 the fast one, and its present value.
    fn scale(&self, path: &str) -> Result<(usize, f64)> {
        let key = path.strip_prefix("potentials.").and_then(|rest| rest.strip_suffix(".scale"));
        let all = &self.source["potentials"];
        let value = key.map_or(&Value::Null, |key| found(all, key));
        if value.is_null() {
            return Err(Error::input("intervals", path, "name the scale of a potential"));
        }
        let step = |of: &Value| Written::from(of["step"].clone()).read("step");
        let step_of = step(value)?;
        let steps = all.as_array().into_iter().flatten().map(step).collect::<Result<Vec<_>>>()?;
        let factor = match value.get("scale") {
            Some(scale) => to_f64(&Written::from(scale.clone()).read("scale")?),
            None => 1.0,
        };
        if steps.iter().filter(|other| **other == step_of).count() > 1 || factor == 0.0 {
            let remedy = "give the potential a step of its own and a scale that is not 0";
            return Err(Error::input("intervals", path, remedy));
        }
        let level = self.model.steps().iter().position(|other| *other == step_of).expect("its own step");
        Ok((level, factor))
    }

    /// The largest growth rate at each value of the number, per unit time, rounded; `None` where it is not
    /// known.
    ///
    /// # Errors
    /// As [`SystemScene::intervals`] and [`Model::decide`](systems::Model::decide).
    pub fn growth_rates(&self, span: &Span, values: &[f64], limits: &Limits) -> Result<Vec<Option<f64>>> {
        // Some milliseconds a rate, whose last digits nobody sees, and a second at most for one that doubles
        // leave open.
        let limits = &Limits { refining: 1 << 20, products: limits.products.min(1 << 30) };
        if span.role()? == Role::Outer {
            return self.model.growth_rates(values, limits);
        }
        let rate = |&value: &f64| {
            let value = from_f64_exact(value).expect("a finite number");
            let scene = self.with("intervals", &[(&span.path, &value)])?;
            Ok(scene.model.decide(Route::Cheapest, limits)?.growth_rate().map(middle))
        };
        number::parallel::try_map(values, rate)
    }

    /// The unstable intervals of the outer step next to the one of the file, all steps in their ratios:
    /// between half of it and twice it.
    ///
    /// # Errors
    /// As [`SystemScene::intervals`].
    pub fn nearest_unstable(&self, width: f64, limits: &Limits) -> Result<Nearest> {
        self.cost_of_nearest(width, limits)?;
        self.model.nearest_unstable(width, limits)
    }

    /// The products that this costs, roughly, where cells are narrow throughout.
    ///
    /// # Errors
    /// As [`SystemScene::nearest_unstable`].
    pub fn cost_of_nearest(&self, width: f64, limits: &Limits) -> Result<f64> {
        self.allow_intervals("nearest", limits)?;
        self.allowed(self.model.cost_of_nearest(width, limits)?, limits, || NEAREST.into())
    }

    /// What has no intervals is refused, and what costs too much.
    fn allow_intervals(&self, field: &str, limits: &Limits) -> Result<()> {
        let refused = |what: &str, remedy: &str| Err(Error::input(field, what, remedy));
        if self.friction.is_some() {
            return refused("with friction", "take the friction out of the file");
        }
        if let Some((what, remedy)) = self.model.no_intervals() {
            return refused(what, remedy);
        }
        if !self.is_linear() {
            return refused("of this file", "are for linear systems of rational numbers");
        }
        let work = || format!("a verdict on {} degrees of freedom", self.model.size());
        limits.allow(self.model.cost(), work)
    }

    /// The multiples of the shortest of the other steps.
    fn multiples_of(&self, span: &Span) -> Result<Vec<Rational>> {
        let longest = self.model.outer_step();
        // A step that no other has: with it in place, the shortest of the rest.
        let far = longest * Rational::from_integer(2.into());
        let steps = self.with("intervals", &[(&span.path, &far)])?.model.steps();
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
        Ok(std::iter::successors(Some(first), next).map(|k| k * &inner).collect())
    }

    /// The verdict at each of them alone: stretches from one to another.
    fn multiples(&self, span: &Span, limits: &Limits) -> Result<Vec<Stretch>> {
        let values = self.multiples_of(span)?;
        // One eigenbasis serves them all.
        if self.model.inner_steps().is_some() {
            self.model.measured()?.kernel()?;
        }
        let stretch = |step: &Rational| {
            let model = self.with("intervals", &[(&span.path, step)])?.model;
            let verdict = model.verdict(1.0, limits)?;
            Ok(Stretch { lo: to_f64(step), hi: to_f64(step), verdict })
        };
        Ok(merged(number::parallel::try_map(&values, stretch)?.into_iter()))
    }
}
