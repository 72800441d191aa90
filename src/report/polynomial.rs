//! The half period of one ratio as polynomials in s = h1² L1 and rho = L2/L1.

use serde_json::{Map, Value};

use super::document::Document;
use super::table::{Cell, Column, Table};
use crate::number::{Polynomial, Ratio, Rational};
use crate::propagator::{HalfPeriod, TwoClocks, half_period};

/// Polynomials in s whose coefficients are polynomials in rho.
type Bivariate = Polynomial<Polynomial<Rational>>;

/// A, B, C, D and the trace of h2/h1 = p/q, in the time unit h1: B in h1, C in 1/h1.
pub fn polynomials(ratio: Ratio) -> [(&'static str, Bivariate); 5] {
    let s = Polynomial::variable();
    let rho = Polynomial::constant(Polynomial::variable());
    let half: HalfPeriod<Bivariate> = half_period(&TwoClocks::with_rho(ratio, s, rho));
    let entries = [("A", half.a()), ("B", half.b()), ("C", half.c()), ("D", half.d())];
    let [a, b, c, d] = entries.map(|(name, entry)| (name, entry.clone()));
    [a, b, c, d, ("trace", half.trace())]
}

/// The document `kickdrift/polynomial/1`.
pub fn document(ratio: Ratio) -> Document {
    let polynomials = polynomials(ratio);
    let text = |f: &Bivariate| f.text(&["s", "rho"]);
    let lines: Vec<String> = polynomials.iter().map(|(name, f)| format!("{name:<5} = {}", text(f))).collect();
    let values: Map<String, Value> =
        polynomials.iter().map(|(name, f)| ((*name).to_string(), Value::String(text(f)))).collect();
    Document::new("polynomial")
        .input("ratio", ratio.to_string())
        .entry("p", ratio.p())
        .entry("q", ratio.q())
        .entry("polynomials", Value::Object(values))
        .rows(table(&polynomials))
        .told(&lines)
}

fn table(polynomials: &[(&'static str, Bivariate)]) -> Table {
    let columns = vec![
        Column::new("entry").left(),
        Column::new("s").titled("power of s", "power of $s$"),
        Column::new("rho").titled("power of rho", "power of $\\rho$"),
        Column::new("coefficient"),
    ];
    let mut table = Table::new("terms", "Half period and trace as polynomials in s and rho", columns);
    for (name, f) in polynomials {
        for (i, in_rho) in f.coefficients().iter().enumerate() {
            for (j, c) in in_rho.coefficients().iter().enumerate().filter(|(_, c)| **c != Rational::default())
            {
                let powers = [i, j].map(|n| Cell::Integer(n as i64));
                let [s, rho] = powers;
                table.push(vec![Cell::Text((*name).into()), s, rho, Cell::Exact(c.to_string())]);
            }
        }
    }
    table
}
