//! The orders of a word on all problems, as entries and lines.

use super::linted::Linted;
use crate::report::record::Record;
use crate::report::shape::{INTEGER, Shape, TEXT};
use crate::report::table::Cell;
use number::{Radical, Real};
use words::{ErrorTerm, FormalOrder, GeneralOrder};

/// A name, and what is said of it.
pub(super) type Line = (&'static str, String);

impl Linted {
    /// The orders where forces are not linear, with the leading errors.
    pub(super) fn on_all_problems(&self) -> Vec<Line> {
        let GeneralOrder { general, nystrom, most } = match &self.general {
            Ok(orders) => orders,
            Err(reason) => return vec![("general", format!("no order on all problems is known: {reason}"))],
        };
        let text = |order: &FormalOrder, on: &str| {
            let least = if order.order == *most { "at least " } else { "" };
            let rounded = if order.nominal > order.order {
                let rest = commutators(&order.error, 1);
                format!(" but for {rest}, which rounded coefficients leave; {} exactly", order.order)
            } else {
                String::new()
            };
            format!("{least}{} {on}{rounded}", order.nominal)
        };
        let mut lines = vec![("general", text(general, "on all problems"))];
        if (nystrom.order, nystrom.nominal) != (general.order, general.nominal) {
            lines.push(("Nystrom", text(nystrom, "where the kinetic energy is quadratic")));
        }
        if !nystrom.nominal_error.is_empty() {
            let letters = if self.word.names_forces() { "kicks B1, B2" } else { "kicks B" };
            lines.push(("error", format!("{}; drifts A, {letters}", commutators(&nystrom.nominal_error, 3))));
        }
        lines
    }
}

/// The first terms of an error, and how many more there are.
pub(crate) fn commutators(terms: &[ErrorTerm], most: usize) -> String {
    let term = |term: &ErrorTerm| format!("{} {}", shown(&term.coefficient), term.commutator);
    let shown: Vec<String> = terms.iter().take(most).map(term).collect();
    let more = terms.len().saturating_sub(most);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!("{}{more}", shown.join(" + ").replace("+ -", "- "))
}

/// A record of a word with its orders on all problems, the nominal ones and the leading errors.
pub(super) fn with_orders(mut record: Record<'_, Linted>) -> Record<'_, Linted> {
    type Of<'a> = &'a Linted;
    type OfOrder = fn(&GeneralOrder) -> &FormalOrder;
    let orders: [(&'static str, &'static str, OfOrder); 2] = [
        ("general", "all problems that split into drifts and kicks", |all| &all.general),
        ("nystrom", "problems with a quadratic kinetic energy and the forces of a potential", |all| {
            &all.nystrom
        }),
    ];
    for (name, problems, which) in orders {
        let of = move |linted: Of| linted.general.as_ref().ok().map(which).cloned();
        let terms = |terms: &[ErrorTerm]| Cell::Text(commutators(terms, usize::MAX));
        record = record
            .json(&format!("{name}_order"), move |linted| of(linted).map(|found| found.order).into())
            .says(
                Shape::OrNull(&INTEGER),
                format!(
                    "The order on {problems}, exactly, by the commutators in the word's error; 9 (7 for two forces) stands for this order or a higher one. null where a letter is no exponential of commutators."
                ),
            )
            .json(&format!("nominal_{name}_order"), move |linted| of(linted).map(|found| found.nominal).into())
            .says(Shape::OrNull(&INTEGER), "The same when coefficients below 2^-30 count as 0, as rounded coefficients leave them.")
            .json(&format!("{name}_error"), move |linted| {
                of(linted).map_or(Cell::Missing, |found| terms(&found.nominal_error))
            })
            .says(Shape::OrNull(&TEXT), "The commutators of degree (nominal order + 1) in the error, drifts being A and kicks B, or B1 and B2; coefficients of more than 24 characters with seven digits.")
            .json(&format!("{name}_rounding"), move |linted| {
                let rounded = of(linted).filter(|found| found.nominal > found.order);
                rounded.map_or(Cell::Missing, |found| terms(&found.error))
            })
            .says(Shape::OrNull(&TEXT), "The commutators of degree (order + 1) that the nominal order leaves out; null where both orders are equal.");
    }
    record
}

/// An exact number where it is short, else its first digits.
pub(crate) fn shown(x: &Radical) -> String {
    const SHORT: usize = 24;
    let text = x.text(ToString::to_string);
    if text.len() <= SHORT { text } else { format!("{:.6e}", x.enclosure(64).mid_f64()) }
}
