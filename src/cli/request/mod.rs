//! What is asked for: arguments and scenes end here, in the same requests, and each is performed in one way.

mod closings;

use super::args::Common;
use super::progress::announce;
use crate::error::{Error, Result};
use crate::map::Grid;
use crate::number::{Laurent, Ratio, Rational};
use crate::report::document::Document;
use crate::report::{compare, curves, polynomial, proposition, survey};
use crate::resonance::compare::compare_ratios;
use crate::resonance::proposition::check;
use crate::resonance::{Families, Window};
use crate::scene::{GridRange, StepRange, given_families};
use crate::tongue;
pub use closings::Question;

/// A question that one document answers.
#[derive(Clone, Debug)]
pub enum Request {
    /// The curves (a, b) over closed ranges of h1 and h2; `given` is how the ranges are echoed.
    Curves {
        lambda1: Laurent,
        ranges: [StepRange; 2],
        families: Families,
        given: Vec<(&'static str, String)>,
    },
    /// The trace against the predictions, over all pairs of a grid.
    CompareGrid { grid: Grid, range: GridRange, tolerance: Rational },
    /// The same over all coprime p + q ≤ `max_sum`, at s = 4k/(samples + 1).
    CompareRatios { max_sum: u64, rho: Rational, samples: u64, tolerance: Rational },
    /// The Proposition for all coprime p, q ≤ `max`, with all witnesses.
    Proposition { max: u64 },
    /// The half period in s and rho.
    Polynomial { ratio: Ratio },
    /// Where tongues close.
    Closings(Question),
    /// All tongues of all coprime p + q ≤ `max_sum`, the `thinnest` of them listed.
    Survey { max_sum: u64, rho: Rational, thinnest: usize },
}

/// Witnesses beyond this bound alone would fill gigabytes.
const LARGEST_MAX: u64 = 400;

/// The largest p + q of polynomials unless a budget says otherwise: the entries have about p q/4 terms, with coefficients
/// of some p + q digits.
const MOST_KICKS: u64 = 120;

/// Thin tongues listed unless a number is given, and at most.
pub const THINNEST: usize = 10;
const MOST_THIN: usize = 100_000;

impl Request {
    /// The answer; `all_columns` of its table, or those that fit paper.
    ///
    /// # Errors
    /// A request that is out of range or costs too much, and whatever the library refuses.
    pub fn perform(&self, common: &Common, all_columns: bool) -> Result<Document> {
        let limits = common.limits();
        match self {
            Request::Curves { lambda1, ranges: [h1, h2], families, given } => {
                let curves = families.curves(lambda1, &Window::new(h1, h2))?;
                let document = curves::document(&curves).input("lambda1", lambda1).inputs(given.clone());
                Ok(document.inputs(given_families(families)))
            }
            Request::CompareGrid { grid, range, tolerance } => {
                let all = grid.compare(tolerance, &limits)?;
                let (lambda1, lambda2) = grid.lambdas();
                let document = compare::document(&all, tolerance, ["h1", "h2"]);
                Ok(document.input("lambda1", lambda1).input("lambda2", lambda2).inputs(range.given()))
            }
            Request::CompareRatios { max_sum, rho, samples, tolerance } => {
                let all = compare_ratios(*max_sum, rho, *samples, tolerance, &limits)?;
                let document = compare::document(&all, tolerance, ["s", "rho"]);
                Ok(document.input("max_sum", max_sum).input("rho", rho).input("samples", samples))
            }
            Request::Proposition { max } => {
                if !(1..=LARGEST_MAX).contains(max) {
                    let remedy =
                        format!("choose 1 to {LARGEST_MAX}; the number of witnesses grows like its cube");
                    return Err(Error::input("max", max, remedy));
                }
                let work = format!("the Proposition up to {max}");
                if max.pow(3) > limits.kicks {
                    let cost = format!("{work} has about {} points and curves", max.pow(3));
                    return Err(Error::budget(cost, max.pow(3)).or("choose a smaller --max"));
                }
                // Some microseconds for each of max³ (1 + ln max) points and curves.
                announce(common.quiet, &work, (*max as f64).powi(3) * (1.0 + (*max as f64).ln()) * 1e-6);
                let mut witnesses = Vec::new();
                let check = check(*max, |witness| witnesses.push(*witness));
                Ok(proposition::document(*max, &check, &witnesses))
            }
            Request::Polynomial { ratio } => {
                let most = common.budget.unwrap_or(MOST_KICKS);
                if ratio.kicks() > most {
                    let terms = u128::from(ratio.p()) * u128::from(ratio.q()) / 4 + 1;
                    let cost = format!("polynomials of {ratio} have about {terms} terms each");
                    return Err(Error::budget(cost, ratio.kicks()).or(format!("choose p + q <= {most}")));
                }
                Ok(polynomial::document(*ratio))
            }
            Request::Closings(question) => question.document(common, all_columns),
            Request::Survey { max_sum, rho, thinnest } => {
                if *thinnest > MOST_THIN {
                    return Err(Error::input("thinnest", thinnest, format!("choose at most {MOST_THIN}")));
                }
                let document = survey::document(&tongue::survey(*max_sum, rho, *thinnest)?);
                Ok(document.input("thinnest", thinnest))
            }
        }
    }
}
