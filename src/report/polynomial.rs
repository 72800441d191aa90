//! The half period of one ratio as polynomials in s = h1² L1 and rho = L2/L1.

use num_traits::{One, Signed, Zero};
use serde_json::{Map, Value};

use super::document::Document;
use super::latex::Equation;
use super::record::Record;
use super::table::{Cell, Column, Table};
use crate::number::{Polynomial, Ratio, Rational};
use crate::propagator::{HalfPeriod, TwoClocks, half_period};

/// Polynomials in s whose coefficients are polynomials in rho.
type Bivariate = Polynomial<Polynomial<Rational>>;

/// A, B, C, D and the trace by name.
pub type Polynomials = [(&'static str, Bivariate); 5];

/// A, B, C, D and the trace of h2/h1 = p/q, in the time unit h1: B in h1, C in 1/h1.
pub fn polynomials(ratio: Ratio) -> Polynomials {
    let s = Polynomial::variable();
    let rho = Polynomial::constant(Polynomial::variable());
    let half: HalfPeriod<Bivariate> = half_period(&TwoClocks::with_rho(ratio, s, rho));
    let entries = [("A", half.a()), ("B", half.b()), ("C", half.c()), ("D", half.d())];
    let [a, b, c, d] = entries.map(|(name, entry)| (name, entry.clone()));
    [a, b, c, d, ("trace", half.trace())]
}

/// The document `kickdrift/polynomial/1` without its input.
pub fn document(ratio: Ratio, polynomials: &Polynomials) -> Document {
    let text = |f: &Bivariate| f.text(&["s", "rho"]);
    let lines: Vec<String> = polynomials.iter().map(|(name, f)| format!("{name:<5} = {}", text(f))).collect();
    let values: Map<String, Value> =
        polynomials.iter().map(|(name, f)| ((*name).to_string(), Value::String(text(f)))).collect();
    Document::new("polynomial")
        .entry("p", ratio.p())
        .entry("q", ratio.q())
        .entry("polynomials", Value::Object(values))
        .rows(table(polynomials))
        .equations(polynomials.iter().map(|(name, f)| equation(name, f)).collect())
        .summary_alone(&lines)
}

/// One polynomial in LaTeX, term by term.
fn equation(name: &str, f: &Bivariate) -> Equation {
    let power = |letter: &str, n: usize| match n {
        0 => String::new(),
        1 => format!(" {letter}"),
        n => format!(" {letter}^{{{n}}}"),
    };
    let in_s = f.coefficients().iter().enumerate();
    let all = in_s.flat_map(|(i, g)| g.coefficients().iter().enumerate().map(move |(j, c)| (i, j, c)));
    let terms: Vec<(usize, usize, &Rational)> = all.filter(|(.., c)| !c.is_zero()).collect();
    let term = |(n, (i, j, c)): (usize, &(usize, usize, &Rational))| {
        let sign = match (n, c.is_negative()) {
            (0, false) => "",
            (_, false) => " +",
            (_, true) => " -",
        };
        let letters = format!("{}{}", power("\\rho", *j), power("s", *i));
        let size = c.abs();
        let number = match (size.is_one() && !letters.is_empty(), size.is_integer()) {
            (true, _) => String::new(),
            (false, true) => format!(" {size}"),
            (false, false) => format!(" \\tfrac{{{}}}{{{}}}", size.numer(), size.denom()),
        };
        format!("{sign}{number}{letters}")
    };
    let left = if name == "trace" { "\\operatorname{Tr} Q" } else { name };
    Equation { name: left.into(), key: name.into(), terms: terms.iter().enumerate().map(term).collect() }
}

/// The terms other than zero: entry, powers of s and rho, coefficient.
fn table(polynomials: &[(&'static str, Bivariate)]) -> Table {
    type Term<'a> = (&'static str, usize, usize, &'a Rational);
    let terms = polynomials.iter().flat_map(|(name, f)| {
        let in_s = f.coefficients().iter().enumerate();
        in_s.flat_map(move |(i, g)| g.coefficients().iter().enumerate().map(move |(j, c)| (*name, i, j, c)))
    });
    let terms: Vec<Term> = terms.filter(|(.., coefficient)| **coefficient != Rational::default()).collect();
    Record::new()
        .field(Column::new("entry").left(), |(name, ..): &Term| (*name).into())
        .field(Column::new("s").titled("power of s", "power of $s$"), |(_, s, ..)| (*s as u64).into())
        .field(Column::new("rho").titled("power of rho", "power of $\\rho$"), |(_, _, rho, _)| {
            (*rho as u64).into()
        })
        .field(Column::new("coefficient"), |(.., coefficient)| Cell::exact(coefficient))
        .table("terms", "Half period and trace as polynomials in s and rho", &terms)
}
