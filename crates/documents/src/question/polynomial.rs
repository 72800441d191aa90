//! The half period of one ratio in s and ρ.

use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};
use serde_json::{Map, Value};

use super::asking::{Question, Work, question};
use crate::report::document::Document;
use crate::report::latex::Equation;
use crate::report::record::Record;
use crate::report::shape::{COUNT, GROUP, Keys, POSITIVE, RATIONAL, Schema, Shape};
use crate::report::table::{Cell, Column, Table};
use clocks::propagator::{HalfPeriod, TwoClocks, half_period};
use number::{self, Error, Ratio, Rational, Result};

question! {
    /// A, B, C, D and the trace of one ratio as polynomials in s and ρ.
    args struct Polynomial {
        /// h2/h1 = p/q.
        ratio as "P/Q": Ratio,
    }
}

/// The products of coefficients that polynomials cost at most unless a budget says otherwise: some ten
/// seconds.
const MOST_PRODUCTS: u64 = 150_000;

/// Polynomials in s whose coefficients are polynomials in rho.
type Bivariate = number::Polynomial<number::Polynomial<Rational>>;

/// A, B, C, D and the trace by name.
pub type Polynomials = [(&'static str, Bivariate); 5];

impl Question for Polynomial {
    const NAME: &'static str = "polynomial";
    const EXAMPLES: &'static [&'static str] =
        &["polynomial --ratio 5/3", "polynomial --ratio 5/3 --format latex"];
    type Answer = Polynomials;

    fn schema() -> Option<Schema> {
        const POLYNOMIAL: Shape = Shape::Named(
            "polynomial",
            r#"{
                "type": "string",
                "pattern": "^[-0-9srho^*/+() ]+$",
                "description": "Exact, with rational coefficients."
            }"#,
        );
        let body = Keys::new()
            .key("p", POSITIVE, "Fast kicks a period: h2/h1 = p/q in lowest terms.")
            .key("q", POSITIVE, "Slow kicks a period.")
            .key("polynomials", GROUP, "Each entry, and the trace.")
            .key("polynomials.A", POLYNOMIAL, "")
            .key("polynomials.B", POLYNOMIAL, "")
            .key("polynomials.C", POLYNOMIAL, "")
            .key("polynomials.D", POLYNOMIAL, "")
            .key("polynomials.trace", POLYNOMIAL, "Tr Q = 2 (AD + BC).")
            .key("terms", TERMS, "The nonzero terms, by entry, then by power of s, then of rho.");
        let title = "The half period and the trace of one ratio as polynomials in s = h1^2 lambda1 and rho = lambda2/lambda1";
        Some(Schema::new(title, body).about("In the time unit h1: B is in units of h1, C in units of 1/h1."))
    }

    fn answer(&self, work: &Work) -> Result<Self::Answer> {
        let (ratio, most) = (self.ratio, work.budget.unwrap_or(MOST_PRODUCTS));
        let terms = u128::from(ratio.p()) * u128::from(ratio.q()) / 4 + u128::from(ratio.kicks());
        let products = terms.saturating_mul(ratio.kicks().into());
        if products > most.into() {
            let (cost, remedy) = (
                format!(
                    "polynomials of {ratio} have some {terms} terms each; the budget, in products of terms, is {most}"
                ),
                "choose a ratio of smaller p and q",
            );
            let budget = |products| Error::budget(&cost, products).or(remedy);
            return Err(u64::try_from(products).map_or_else(|_| Error::too_much(&cost, remedy), budget));
        }
        Ok(polynomials(ratio))
    }

    fn show(&self, polynomials: &Polynomials) -> Document {
        let text = |f: &Bivariate| f.text(&["s", "rho"]);
        let lines: Vec<String> =
            polynomials.iter().map(|(name, f)| format!("{name:<5} = {}", text(f))).collect();
        let values: Map<String, Value> =
            polynomials.iter().map(|(name, f)| ((*name).to_string(), Value::String(text(f)))).collect();
        Document::new(Self::NAME)
            .entry("p", self.ratio.p())
            .entry("q", self.ratio.q())
            .entry("polynomials", Value::Object(values))
            .rows(table(polynomials))
            .equations(polynomials.iter().map(|(name, f)| equation(name, f)).collect())
            .summary_alone(&lines)
    }
}

/// A, B, C, D and the trace of h2/h1 = p/q, in the time unit h1: B in h1, C in 1/h1.
fn polynomials(ratio: Ratio) -> Polynomials {
    let s = number::Polynomial::variable();
    let rho = number::Polynomial::constant(number::Polynomial::variable());
    let half: HalfPeriod<Bivariate> = half_period(&TwoClocks::with_rho(ratio, s, rho));
    let entries = [("A", half.a()), ("B", half.b()), ("C", half.c()), ("D", half.d())];
    let [a, b, c, d] = entries.map(|(name, entry)| (name, entry.clone()));
    [a, b, c, d, ("trace", trace(&half, ratio.q()))]
}

/// Tr Q = 4 A D − 2, in integers: drifts are multiples of h1/(2q), kicks of s/2 and s ρ/(2q), so a
/// coefficient of s^i in A and D becomes one by (2q)^(2i). (In rationals each of the (p q/4)² products would
/// cost a greatest common divisor.)
fn trace(half: &HalfPeriod<Bivariate>, q: u64) -> Bivariate {
    let unit = (BigInt::from(q) * 2u8).pow(2);
    let integers = |f: &Bivariate| -> Vec<Vec<BigInt>> {
        let in_s = f.coefficients().iter().enumerate();
        in_s.map(|(i, g)| g.coefficients().iter().map(|c| (c * unit.pow(i as u32)).to_integer()).collect())
            .collect()
    };
    let (a, d) = (integers(half.a()), integers(half.d()));
    let mut product = vec![Vec::<BigInt>::new(); a.len() + d.len() - 1];
    for (i, a) in a.iter().enumerate() {
        for (sum, d) in product[i..].iter_mut().zip(&d) {
            sum.resize(sum.len().max(a.len() + d.len()), BigInt::zero());
            for (k, a) in a.iter().enumerate() {
                sum[k..].iter_mut().zip(d).for_each(|(integer, d)| *integer += a * d);
            }
        }
    }
    let rational = |(i, in_rho): (usize, Vec<BigInt>)| {
        let divisor = unit.pow(i as u32);
        number::Polynomial::new(in_rho.into_iter().map(|c| Rational::new(c * 4, divisor.clone())).collect())
    };
    let two = number::Polynomial::constant(number::Polynomial::constant(Rational::from_integer(2.into())));
    number::Polynomial::new(product.into_iter().enumerate().map(rational).collect()) - two
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

/// A term: its entry, powers of s and rho, coefficient.
type Term<'a> = (&'static str, usize, usize, &'a Rational);

const TERMS: Shape = Shape::List(&Shape::Object(|| record().keys()));

/// The row of a term.
fn record<'a>() -> Record<'a, Term<'a>> {
    Record::new()
        .field(Column::new("entry").left(), |(name, ..): &Term| (*name).into())
        .says(Shape::OneOf(&["A", "B", "C", "D", "trace"]), "The polynomial that it is a term of.")
        .field(Column::new("s").titled("power of s", "power of $s$"), |(_, s, ..)| (*s as u64).into())
        .says(COUNT, "The power of s.")
        .field(Column::new("rho").titled("power of rho", "power of $\\rho$"), |(_, _, rho, _)| {
            (*rho as u64).into()
        })
        .says(COUNT, "The power of rho.")
        .field(Column::new("coefficient"), |(.., coefficient)| Cell::exact(coefficient))
        .says(RATIONAL, "An exact rational.")
}

/// The terms other than zero.
fn table(polynomials: &[(&'static str, Bivariate)]) -> Table {
    let terms = polynomials.iter().flat_map(|(name, f)| {
        let in_s = f.coefficients().iter().enumerate();
        in_s.flat_map(move |(i, g)| g.coefficients().iter().enumerate().map(move |(j, c)| (*name, i, j, c)))
    });
    let terms: Vec<Term> = terms.filter(|(.., coefficient)| **coefficient != Rational::default()).collect();
    record().table("terms", "Half period and trace as polynomials in s and rho", &terms)
}
