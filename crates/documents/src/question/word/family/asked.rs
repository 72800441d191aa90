//! What is asked about a word with parameters.

use std::fmt;
use std::str::FromStr;

use super::super::asked::Word;
use crate::question::asking::question;
use crate::question::field::{notation, shown_range};
use number::parse::{parse_rational, parse_rational_range};
use number::{Error, ExactSign, Laurent, Radical, Rational, Result, Ring, Sign, named};

/// A parameter and its values: one, or those from one end of a range on by a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    pub name: String,
    pub range: (Rational, Rational),
    /// `None` for one value.
    pub step: Option<Rational>,
}

/// All parameters of a word.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameters(pub Vec<Parameter>);

/// The most values of one parameter.
const MOST_VALUES: i64 = 10_000;

/// The most parameters that have a range.
const MOST_RANGES: usize = 2;

impl Parameter {
    fn values(&self) -> Result<Vec<Rational>> {
        let (lo, hi) = &self.range;
        let Some(step) = &self.step else { return Ok(vec![lo.clone()]) };
        let count = ((hi - lo) / step).floor();
        if count > Rational::from_integer(MOST_VALUES.into()) {
            return Err(Error::input(
                "parameter",
                self,
                format!("choose a larger step: {MOST_VALUES} values at most"),
            ));
        }
        let next = |value: &Rational| Some(value + step).filter(|value| value <= hi);
        Ok(std::iter::successors(Some(lo.clone()), next).collect())
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.step {
            Some(step) => write!(f, "{}={}:{step}", self.name, shown_range(&self.range)),
            None => write!(f, "{}={}", self.name, self.range.0),
        }
    }
}

impl Parameters {
    /// Those that have a range.
    pub fn ranged(&self) -> impl Iterator<Item = (usize, &Parameter)> {
        self.0.iter().enumerate().filter(|(_, parameter)| parameter.step.is_some())
    }

    /// The values of all parameters at each place of the grid.
    pub(super) fn places(&self) -> Result<Vec<Vec<Rational>>> {
        let mut places = vec![Vec::new()];
        for parameter in &self.0 {
            let values = parameter.values()?;
            let with = |place: &Vec<Rational>| {
                let place = place.clone();
                values
                    .iter()
                    .map(move |value| [&place[..], std::slice::from_ref(value)].concat())
                    .collect::<Vec<_>>()
            };
            places = places.iter().flat_map(with).collect();
        }
        Ok(places)
    }
}

impl fmt::Display for Parameters {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all: Vec<String> = self.0.iter().map(ToString::to_string).collect();
        f.write_str(&all.join(","))
    }
}

const AS: &str = "write b=LO..HI:STEP, as b=0.15..0.25:1/100; further parameters behind commas, as c=1/3";

impl FromStr for Parameters {
    type Err = Error;

    fn from_str(text: &str) -> Result<Parameters> {
        let wrong = |remedy: &str| Error::input("parameter", text, remedy);
        let one = |part: &str| {
            let (name, values) = part.split_once('=').ok_or_else(|| wrong(AS))?;
            let name = name.trim().to_string();
            if name == "sqrt" || name.is_empty() || !name.chars().all(|c| c.is_ascii_lowercase()) {
                return Err(wrong("name a parameter by lower-case letters, as b"));
            }
            if !values.contains("..") && values.contains(':') {
                return Err(wrong(&format!("two points stand between the ends of a range: {AS}")));
            }
            if !values.contains("..") {
                let value = parse_rational("parameter", values)?;
                return Ok(Parameter { name, range: (value.clone(), value), step: None });
            }
            let (range, step) = values.split_once(':').ok_or_else(|| {
                wrong(&format!("add how far its values are apart, as {name}={values}:1/100"))
            })?;
            let range = parse_rational_range("parameter", range)?;
            let step = parse_rational("parameter", step)?;
            match step.sign() {
                Sign::Positive => Ok(Parameter { name, range, step: Some(step) }),
                _ => Err(wrong("a step must be positive")),
            }
        };
        let all = text.split(',').map(one).collect::<Result<Vec<_>>>()?;
        let is_twice = |n: usize| all[..n].iter().any(|other| other.name == all[n].name);
        if (0..all.len()).any(is_twice) {
            return Err(wrong("give each parameter once"));
        }
        let found = Parameters(all);
        match found.ranged().count() {
            0..=MOST_RANGES => Ok(found),
            _ => Err(wrong("two parameters at most have a range: give the others one value")),
        }
    }
}

named! {
    /// What is best.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Goal {
        /// The longest step that is stable with all shorter ones.
        Edge = "edge",
        /// The same for each evaluation.
        Efficiency = "efficiency",
        /// The least root of the sum of squares of the leading error's coefficients.
        Error = "error",
        /// The least energy error of the worst step up to some length.
        Bias = "bias",
    }
}

notation! {
    Parameters: |_: &str, text: &str| text.parse(), ToString::to_string;
    Goal: goal, |goal: &Goal| goal.name();
}

fn goal(field: &str, text: &str) -> Result<Goal> {
    let remedy = || format!("choose one of {}", Goal::NAMES.join(", "));
    Goal::named(text).ok_or_else(|| Error::input(field, text, remedy()))
}

question! {
    /// A word whose coefficients are expressions of parameters: order, error, stable steps and cost at each
    /// value; the best value.
    args struct Family {
        /// The integrator: kicks K, K1, K2, drifts D, midpoints C, exact flows R, friction O, F, I, n*(...),
        /// as "K(1/2) D(1) K(1/2)".
        #[arg(value_name = "WORD", required = false)]
        word: String,
        /// A row for each value of a name in the word, as b=0.15..0.25:1/100 in K(b)D(1/2)K(1-2*b)D(1/2)K(b).
        ///
        /// Further names stand behind commas, with values or one more range. Where none has a range, the
        /// answer is about one word.
        #[arg(required = false)]
        parameter as "B=LO..HI:STEP": Parameters,
        /// With --parameter, the value with the greatest: edge (the longest stable step) or efficiency (the
        /// same for each evaluation).
        #[arg(requires = "parameter", conflicts_with = "minimize")]
        maximize as "GOAL": Option<Goal>,
        /// With --parameter, the value with the least: error (of leading order) or bias (energy error of the
        /// worst step up to --up-to).
        #[arg(requires = "parameter")]
        minimize as "GOAL": Option<Goal>,
        /// With --parameter, the omega h up to which the bias counts [default: the evaluations of the first
        /// force].
        #[arg(requires = "parameter")]
        up_to as "X": Option<Rational>,
        /// The stiffness of K1, or of K where the word names no forces.
        lambda1 as "X": Option<Laurent>,
        /// The stiffness of K2; a rational multiple of lambda1.
        lambda2 as "Y": Option<Laurent>,
    }
}

impl Family {
    /// The word itself, where every parameter has one value and none is looked for.
    ///
    /// # Errors
    /// A text that is no word with these names.
    pub fn only_word(&self) -> Result<Option<words::Word>> {
        let values = self.parameter.0.iter().map(|parameter| parameter.range.0.clone());
        let is_one = self.parameter.ranged().next().is_none() && self.goal().is_none();
        is_one.then(|| self.word_at(&values.collect::<Vec<_>>())).transpose()
    }

    /// What is to be best.
    pub fn goal(&self) -> Option<Goal> {
        self.maximize.or(self.minimize)
    }

    /// Refuses goals that go the other way, and a length that is none.
    pub(super) fn check(&self) -> Result<()> {
        let is_great = |goal: &Goal| matches!(goal, Goal::Edge | Goal::Efficiency);
        match (&self.maximize, &self.minimize, &self.up_to) {
            (Some(_), Some(_), _) => {
                Err(Error::input("minimize", "given", "give --maximize or --minimize, not both"))
            }
            (Some(goal), ..) if !is_great(goal) => {
                let remedy = format!("choose edge or efficiency; --minimize {} makes it least", goal.name());
                Err(Error::input("maximize", goal.name(), remedy))
            }
            (_, Some(goal), _) if is_great(goal) => {
                let remedy = format!("choose error or bias; --maximize {} makes it greatest", goal.name());
                Err(Error::input("minimize", goal.name(), remedy))
            }
            (.., Some(up_to)) if up_to.sign() != Sign::Positive => {
                Err(Error::input("up-to", up_to, "a step must be positive"))
            }
            _ => Ok(()),
        }
    }

    /// The word at some values of all parameters.
    ///
    /// # Errors
    /// A text that is no word with these names.
    pub fn word_at(&self, values: &[Rational]) -> Result<words::Word> {
        let names = self.parameter.0.iter().map(|parameter| parameter.name.as_str());
        let values: Vec<(&str, Radical)> = names.zip(values.iter().map(Radical::from_rational)).collect();
        words::Word::with(&self.word, &values)
    }

    /// The question about it.
    pub(super) fn asked_at(&self, values: &[Rational]) -> Result<Word> {
        Ok(Word {
            word: Some(self.word_at(values)?),
            lambda1: self.lambda1.clone(),
            lambda2: self.lambda2.clone(),
            ..Word::default()
        })
    }
}
