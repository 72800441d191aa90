//! What the author of a word may claim, and whether it holds.

use num_traits::{One, Zero};

use super::super::asking::{Fields, question};
use super::super::field::notation;
use super::super::word::{Linted, commutators, shown};
use crate::report::decimal;
use crate::report::shape::Shape;
use number::{Ball, Error, ExactSign, Radical, Rational, Real, Result, Sign, rational};
use words::{ErrorTerm, FormalOrder, Letter, NoGeneralOrder};

/// The bits of what is compared.
const BITS: u32 = 96;

/// A number below counts as 0, as error coefficients do in a nominal order.
const SMALL_LOG2: i64 = -30;

/// True or false, as it is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Truth(pub bool);

/// The first unstable omega h that is claimed.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// As the author wrote it.
    text: String,
    /// `None` where it is claimed that there is none.
    value: Option<Radical>,
    /// Half a unit of its last decimal; 0 where it has no decimals, so that it is claimed exactly.
    half_unit: Rational,
}

const TRUTH: Shape = Shape::OneOf(&["true", "false"]);

notation! {
    Truth: truth, |truth: &Truth| truth.0.to_string(), TRUTH;
    Limit: Limit::parsed, |limit: &Limit| limit.text.clone();
}

question! {
    /// What the author of a word claims.
    struct Claims {
        /// The name in the answer.
        name: Option<String>,
        /// The order on oscillators.
        order: Option<u64>,
        /// The order on all problems that split into drifts and kicks.
        general_order: Option<u64>,
        /// The order where the kinetic energy is quadratic.
        nystrom_order: Option<u64>,
        /// Whether the coefficients of each kind of letters sum to 1.
        consistent: Option<Truth>,
        /// Whether the word reads the same backwards.
        symmetric: Option<Truth>,
        /// The first unstable omega h, sqrt(lambda1) h for two forces; one with decimals is held to half a
        /// unit of its last decimal, another one (2, sqrt(12)) exactly; "none" for no limit.
        limit: Option<Limit>,
    }
}

/// All that can be claimed, in this order.
pub(super) const CLAIMS: &[&str] =
    &["order", "general_order", "nystrom_order", "consistent", "symmetric", "limit"];

/// A claim that was held against the answer.
pub struct Checked {
    pub claim: &'static str,
    pub claimed: String,
    pub found: String,
    pub holds: bool,
    /// What is in the way of a claim that does not hold.
    pub by: Option<String>,
}

fn truth(field: &str, text: &str) -> Result<Truth> {
    match text {
        "true" => Ok(Truth(true)),
        "false" => Ok(Truth(false)),
        _ => Err(Error::input(field, text, "write true or false")),
    }
}

impl Limit {
    fn parsed(field: &str, text: &str) -> Result<Limit> {
        let text = text.trim().to_string();
        if ["none", "inf", "+inf"].contains(&text.as_str()) {
            return Ok(Limit { text, value: None, half_unit: Rational::zero() });
        }
        let refused = || {
            let remedy = "write a positive number such as 1.5734, 12/5 or \"sqrt(12)\", or \"none\"";
            Error::input(field, &text, remedy)
        };
        // A coefficient of a word, in its notation.
        let letter: words::Word = format!("D({text})").parse().map_err(|_| refused())?;
        let value = match letter.letters()[..] {
            [Letter::Drift(time)] if time.sign() == Sign::Positive => time.clone(),
            _ => return Err(refused()),
        };
        let half_unit = decimals(&text).map_or(Rational::zero(), |places| {
            Rational::new(1.into(), num_bigint::BigInt::from(10).pow(places) * 2)
        });
        Ok(Limit { text, value: Some(value), half_unit })
    }
}

/// The digits behind the point of a plain decimal.
fn decimals(text: &str) -> Option<u32> {
    let (whole, places) = text.split_once('.')?;
    let plain = |digits: &str| digits.chars().all(|c| c.is_ascii_digit());
    (plain(whole) && plain(places)).then_some(places.len() as u32)
}

impl Claims {
    /// Whether nothing is claimed.
    pub(super) fn is_empty(&self) -> bool {
        self.input().iter().all(|(field, _)| !CLAIMS.contains(field))
    }

    /// Each claim held against what was found, in the order of [`CLAIMS`].
    pub(super) fn hold(&self, linted: &Linted) -> Result<Vec<Checked>> {
        let mut checks = Vec::new();
        checks.extend(self.order.map(|claimed| order(claimed, linted)));
        let orders = [("general_order", self.general_order), ("nystrom_order", self.nystrom_order)];
        for (claim, claimed) in orders {
            let Some(claimed) = claimed else { continue };
            let known = linted.general.as_ref().map_err(|reason| unknown(claim, claimed, *reason))?;
            let found = if claim == "general_order" { &known.general } else { &known.nystrom };
            checks.push(formal(claim, claimed, found, known.most)?);
        }
        checks.extend(self.consistent.map(|claimed| consistent(claimed, linted)));
        checks.extend(self.symmetric.map(|claimed| symmetric(claimed, linted)));
        if let Some(limit) = &self.limit {
            checks.push(limit.hold(linted)?);
        }
        Ok(checks)
    }
}

fn unknown(claim: &str, claimed: u64, reason: NoGeneralOrder) -> Error {
    Error::input(claim, claimed, format!("cannot be checked, as {reason}: leave this claim out"))
}

/// An order, `exact` where rounded coefficients leave errors.
fn order_found(nominal: u64, exact: u64) -> String {
    if nominal > exact { format!("{nominal} nominally ({exact} exactly)") } else { nominal.to_string() }
}

/// The order on oscillators. What is in the way are commutators where they are of the same degree.
fn order(claimed: u64, linted: &Linted) -> Checked {
    let words::Order { order, nominal, .. } = linted.order;
    let formal = linted.general.as_ref().ok().map(|orders| &orders.nystrom);
    let by = formal.filter(|formal| nominal < claimed && formal.nominal == nominal);
    Checked {
        claim: "order",
        claimed: claimed.to_string(),
        found: format!("{} on oscillators", order_found(nominal, order)),
        holds: claimed == nominal,
        by: by.and_then(left_over),
    }
}

/// An order on all problems.
fn formal(claim: &'static str, claimed: u64, order: &FormalOrder, most: u64) -> Result<Checked> {
    if claimed > most {
        return Err(Error::input(
            claim,
            claimed,
            format!("orders above {most} are not looked for: claim less"),
        ));
    }
    Ok(Checked {
        claim,
        claimed: claimed.to_string(),
        found: order_found(order.nominal, order.order),
        holds: claimed == order.nominal,
        by: left_over(order).filter(|_| order.nominal < claimed),
    })
}

/// The leading commutators of the error, but for those that rounded coefficients leave.
fn left_over(order: &FormalOrder) -> Option<String> {
    const SHOWN: usize = 3;
    let counts = |term: &&ErrorTerm| !is_small(&term.coefficient);
    let terms: Vec<ErrorTerm> = order.nominal_error.iter().filter(counts).cloned().collect();
    (!terms.is_empty()).then(|| format!("its error begins with {}", commutators(&terms, SHOWN)))
}

/// Whether a number counts as 0.
fn is_small(x: &Radical) -> bool {
    x.enclosure(BITS).abs().upper() < rational::scale2(&1.into(), SMALL_LOG2)
}

fn consistent(claimed: Truth, linted: &Linted) -> Checked {
    let is_one = |sum: &Radical| is_small(&(sum - &Radical::one()));
    let wrong: Vec<String> = linted
        .sums
        .iter()
        .filter(|(_, sum)| !is_one(sum))
        .map(|(name, sum)| format!("the coefficients of {name} sum to {}", shown(sum)))
        .collect();
    let found = wrong.is_empty();
    let by = (!found).then(|| wrong.join(", "));
    truths("consistent", claimed, found, by)
}

fn symmetric(claimed: Truth, linted: &Linted) -> Checked {
    let place = linted.word.asymmetry();
    let by = place.as_ref().map(|place| {
        format!("letter {} is {}, its mirror image {}", place.letter, place.there, place.mirrored)
    });
    truths("symmetric", claimed, place.is_none(), by)
}

fn truths(claim: &'static str, claimed: Truth, found: bool, by: Option<String>) -> Checked {
    let holds = claimed.0 == found;
    let by = by.filter(|_| !holds);
    Checked { claim, claimed: claimed.0.to_string(), found: found.to_string(), holds, by }
}

impl Limit {
    fn hold(&self, linted: &Linted) -> Result<Checked> {
        if linted.stability.is_none() && linted.pieces.is_none() {
            return Err(Error::missing(
                "lambda1",
                "the limit of two forces depends on their stiffnesses: add lambda1 and lambda2",
            ));
        }
        let edge = linted.nominal_edge();
        let (found, holds, by) = match (&edge, &self.value) {
            (None, claimed) => self.without_edge(linted, claimed.is_none())?,
            (Some(edge), None) => (self.end(edge, linted), false, None),
            (Some(edge), Some(claimed)) => {
                let off = edge.sub(&claimed.enclosure(BITS), BITS);
                let holds = self.is_exactly(claimed, linted).unwrap_or(off.abs().lower() <= self.half_unit);
                let size = format!("{:.1e}", off.mid_f64().abs());
                let by = if off.mid_f64() < 0.0 { "less" } else { "more" };
                (self.end(edge, linted), holds, (!holds).then(|| format!("{size} {by}")))
            }
        };
        Ok(Checked { claim: "limit", claimed: self.text.clone(), found, holds, by })
    }

    /// Whether an exact claim holds, where both squares are rational or the edge is algebraic.
    fn is_exactly(&self, claimed: &Radical, linted: &Linted) -> Option<bool> {
        let edge = linted.stability.as_ref()?.nominal_edge().filter(|_| self.half_unit.is_zero())?;
        Some(edge.compare(&(claimed * claimed).as_rational()?) == Sign::Zero)
    }

    /// The limit that is found.
    fn end(&self, edge: &Ball, linted: &Linted) -> String {
        let ends = edge.to_f64_enclosure();
        let exactly = linted.edge_omega_h().map(|exact| exact.to_f64_enclosure());
        let (lo, hi) = ends;
        match exactly.filter(|exactly| *exactly != ends) {
            Some((below, above)) => format!(
                "{} nominally ({} exactly)",
                decimal::enclosure(lo, hi),
                decimal::enclosure(below, above)
            ),
            None => decimal::enclosure(lo, hi).to_string(),
        }
    }

    /// There is no end of stable steps: every step is stable, or small ones are not, or none was looked at.
    fn without_edge(&self, linted: &Linted, none_is_claimed: bool) -> Result<(String, bool, Option<String>)> {
        let unstable = match (&linted.stability, &linted.pieces) {
            (Some(stability), _) => !stability.begins_stable(),
            (_, Some(pieces)) => pieces.all.first().is_some_and(|first| !first.stable),
            _ => false,
        };
        if unstable {
            return Ok(("0 (small steps are unstable)".into(), false, None));
        }
        if linted.pieces.as_ref().is_some_and(|pieces| !pieces.is_free) {
            let remedy = "no unstable step is known up to the end of the range: add h_range and the stiffnesses, or leave the limit out";
            return Err(Error::input("limit", &self.text, remedy));
        }
        Ok(("none".into(), none_is_claimed, None))
    }
}
