//! One pair of steps, decided; trace, growth and label when they are asked for.

use std::sync::OnceLock;

use kickdrift::error::Result;
use kickdrift::format::Format;
use kickdrift::number::{Laurent, Rational};
use kickdrift::propagator::{LongClocks, Oscillator, TwoClocks};
use kickdrift::question::{Decided as Report, Question, Verdict};
use kickdrift::report::document::Document;
use kickdrift::system::friction::damped_pair;
use kickdrift::verdict::{Answer, Decision, Growth, Limits, Tier, decide_from, decide_long, long_growth};
use num_bigint::BigInt;
use pyo3::prelude::*;

use crate::arguments::Budget;
use crate::error::raised;
use crate::job;
use crate::number::{Number, quantity, rational};

enum Found {
    Rational(Answer<Rational>),
    Pi(Answer<Laurent>),
    /// Of a period that no machine follows kick by kick.
    Long(LongClocks<Laurent>, Decision, OnceLock<Growth>),
}

impl Found {
    fn decision(&self) -> Decision {
        match self {
            Found::Rational(answer) => answer.decision(),
            Found::Pi(answer) => answer.decision(),
            Found::Long(_, decision, _) => *decision,
        }
    }

    fn growth(&self) -> Result<&Growth> {
        match self {
            Found::Rational(answer) => answer.growth(),
            Found::Pi(answer) => answer.growth(),
            Found::Long(clocks, decision, growth) => {
                if growth.get().is_none() {
                    // Another thread that was quicker found the same.
                    let _ = growth.set(long_growth(clocks, decision.verdict)?);
                }
                Ok(growth.get().expect("just set"))
            }
        }
    }
}

/// A decided pair.
#[pyclass(frozen, module = "kickdrift._native")]
pub struct Pair {
    oscillator: Oscillator,
    found: Found,
    exact: bool,
    friction: Option<Rational>,
    budget: Option<u64>,
}

/// Decides one pair of steps.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn decide(
    py: Python<'_>,
    lambda1: &Bound<'_, PyAny>,
    lambda2: &Bound<'_, PyAny>,
    h1: &Bound<'_, PyAny>,
    h2: &Bound<'_, PyAny>,
    exact: bool,
    friction: Option<&Bound<'_, PyAny>>,
    budget: Budget,
) -> PyResult<Pair> {
    let friction = friction.map(|rate| rational("friction", rate)).transpose()?;
    let quantities = (quantity("lambda1", lambda1)?, quantity("lambda2", lambda2)?);
    let steps = (quantity("h1", h1)?, quantity("h2", h2)?);
    let oscillator =
        Oscillator::new(quantities.0, quantities.1, steps.0, steps.1).map_err(|error| raised(&error))?;
    let first = if exact { Tier::Exact } else { Tier::Filter };
    job::run(py, move |_| {
        let limits = limits(budget.0);
        let found = match oscillator.clocks() {
            Err(_) if !exact => {
                let clocks = oscillator.long_clocks();
                let decision = decide_long(&clocks)?;
                Found::Long(clocks, decision, OnceLock::new())
            }
            // Rational strengths make every tier cheaper, whatever the stiffnesses and steps look like.
            clocks => match clocks.as_ref().map(TwoClocks::as_rational) {
                Ok(Some(rational)) => Found::Rational(decide_from(first, &rational, &limits)?),
                _ => Found::Pi(decide_from(first, &clocks?, &limits)?),
            },
        };
        Ok(Pair { oscillator, found, exact, friction, budget: budget.0 })
    })
}

/// The work one verdict may cost.
pub fn limits(budget: Option<u64>) -> Limits {
    budget.map_or_else(Limits::default, |kicks| Limits { kicks })
}

#[pymethods]
impl Pair {
    #[getter]
    fn stable(&self) -> bool {
        self.found.decision().verdict.is_stable()
    }

    #[getter]
    fn kind(&self) -> &'static str {
        self.found.decision().verdict.kind().name()
    }

    #[getter]
    fn side(&self) -> i8 {
        self.found.decision().verdict.side()
    }

    #[getter]
    fn decided_by(&self) -> &'static str {
        self.found.decision().decided_by.name()
    }

    #[getter]
    fn terms(&self) -> (BigInt, BigInt) {
        (self.oscillator.ratio().numer().clone(), self.oscillator.ratio().denom().clone())
    }

    /// lambda1, lambda2, h1, h2 and the period.
    #[getter]
    fn quantities(&self) -> [Number; 5] {
        let own = &self.oscillator;
        [own.lambda1(), own.lambda2(), own.h1(), own.h2(), &own.period()].map(|x| Number(x.clone()))
    }

    /// What `decide` is called with for the same pair: a copy is decided again.
    fn question(&self) -> (Vec<Number>, bool, Option<Number>, Option<u64>) {
        let friction = self.friction.clone().map(|rate| Number(Laurent::from_rational(rate)));
        (self.quantities()[..4].to_vec(), self.exact, friction, self.budget)
    }

    /// The document in one of its forms: json, csv, latex or text.
    fn render(slf: &Bound<'_, Self>, format: &str) -> PyResult<String> {
        let format = form(format);
        let own = slf.clone().unbind();
        // Growth may take a while: it is computed when it is first asked for.
        job::run(slf.py(), move |_| own.get().document()?.render(format))
    }
}

impl Pair {
    fn document(&self) -> Result<Document> {
        let (decision, growth) = (self.found.decision(), self.found.growth()?.clone());
        let exact_trace = Report::exact_trace(&self.oscillator, self.exact);
        let limits = limits(self.budget);
        let friction =
            self.friction.as_ref().map(|rate| damped_pair(&self.oscillator, rate, &limits)).transpose()?;
        let oscillator = self.oscillator.clone();
        let asked =
            Verdict { friction: self.friction.clone(), exact: self.exact, ..Verdict::of(&oscillator) };
        let bias = Report::bias(&oscillator, decision);
        Ok(asked.document(&Report { oscillator, decision, growth, exact_trace, friction, bias }))
    }
}

/// A document's form by its name; text for anything else.
pub fn form(name: &str) -> Format {
    Format::DOCUMENT.into_iter().find(|format| format.name() == name).unwrap_or(Format::Text)
}
