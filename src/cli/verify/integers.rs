//! The Proposition's witnesses and the polynomials: integers and rationals, no analysis.

use std::collections::BTreeMap;

use num_integer::Integer;
use num_traits::{One, Zero};
use serde_json::Value;

use super::exact::{check_ratio, fraction};
use super::read::{Checked, Row, holds, whole};
use super::{Context, Outcome};
use crate::error::Result;
use crate::number::{Polynomial, Ratio, Rational};
use crate::propagator::methods::avi;
use crate::propagator::{TwoClocks, half_period};

const WITNESSES: &str = "eq. (10) with m = a p + b q in integers, b not 0; every coprime (p, q, m) once";
const POLYNOMIALS: &str =
    "the full period, kick by kick, at more rational points than the degrees leave free";

pub fn check_proposition(document: &Value, context: &Context) -> Result<Outcome> {
    let all = Row::new(document);
    let max = whole(whole(all.object("input"))?.rational("max"))?.to_integer();
    let rows = whole(all.rows("witnesses"))?;
    let mut outcome = context.rows(rows, WITNESSES, check_witness)?;
    let max: u64 = max.try_into().unwrap_or(0);
    crate::cli::proposition::check_bound(max)?;
    let points =
        (1..=max).flat_map(|p| (1..=max).filter(move |q| p.gcd(q) == 1).map(move |_| p - 1)).sum::<u64>();
    let told = whole(all.whole("resonant_points"))?;
    let sound = whole(all.flag("holds"))? && whole(all.rows("failures"))?.is_empty();
    if !sound {
        outcome.failures.push((0, format!("max = {max}"), "every point has its witness: it holds".into()));
    }
    if told != rows.len() as u64 || told != points {
        outcome.failures.push((
            0,
            format!("max = {max}"),
            format!("{points} resonant points are expected, {told} told"),
        ));
    }
    Ok(outcome)
}

fn check_witness(row: &Row) -> Checked<()> {
    let (p, q, m) = (row.integer("p")?, row.integer("q")?, row.integer("m")?);
    let (a, b) = (row.integer("a")?, row.integer("b")?);
    let small = [p, q, m, a, b].iter().all(|n| n.unsigned_abs() < 1 << 20);
    let sound = small && p > 0 && q > 0 && m > 0 && p.gcd(&q) == 1;
    holds(sound, || "is no resonant point of a ratio in lowest terms".into())?;
    holds(b != 0, || "b = 0: eq. (10) has no such curve".into())?;
    // In the unit h1 T½ = p/m: h2 = b T½/(1 − a T½) = b p/(m − a p) must be p/q.
    holds(m - a * p != 0 && b * p * q == p * (m - a * p), || {
        "its curve does not pass through the point".into()
    })
}

/// Coefficients by powers of s and ρ.
type Terms = BTreeMap<(u32, u32), Rational>;

pub fn check_polynomial(document: &Value, context: &Context) -> Result<Outcome> {
    let all = Row::new(document);
    let ratio = whole(all.ratio())?;
    whole(check_ratio(ratio, &context.limits))?;
    crate::cli::polynomial::check(ratio, context.common.budget)?;
    let mut terms: BTreeMap<String, Terms> = BTreeMap::new();
    for term in whole(all.rows("terms"))? {
        let term = Row::new(term);
        // Beyond p + q no power can stand; those are told as the first that cannot.
        let power = |key: &str| -> Result<u32> { Ok(whole(term.whole(key))?.min(ratio.kicks() + 1) as u32) };
        let powers = (power("s")?, power("rho")?);
        let coefficient = whole(term.rational("coefficient"))?;
        let own = terms.entry(whole(term.text("entry"))?.to_string()).or_default();
        let twice = own.insert(powers, coefficient).is_some();
        whole(holds(!twice, || "a term is told twice".into()))?;
    }
    let asked = whole(whole(all.object("input"))?.rational("ratio"))?;
    whole(holds(asked == ratio.into(), || format!("its ratio is {asked}, not {ratio}")))?;
    let texts = whole(all.object("polynomials"))?;
    let names = ["A", "B", "C", "D", "trace"].map(|entry| serde_json::json!({"entry": entry}));
    context.rows(&names, POLYNOMIALS, |row| {
        let entry = row.text("entry")?;
        check_entry(entry, ratio, &terms)?;
        let text = terms.get(entry).map_or_else(|| "0".into(), in_writing);
        holds(texts.text(entry)? == text, || format!("its text is not {text}"))
    })
}

/// The polynomial with these terms as it is written.
fn in_writing(terms: &Terms) -> String {
    let s_and_rho = terms.iter().fold(Polynomial::zero(), |mut sum, ((k, l), c)| {
        sum += Polynomial::monomial(Polynomial::monomial(c.clone(), *l as usize), *k as usize);
        sum
    });
    s_and_rho.text(&["s", "rho"])
}

/// A polynomial of degree m in s and n in ρ is determined by (m + 1)(n + 1) values on a grid.
fn check_entry(entry: &str, ratio: Ratio, terms: &BTreeMap<String, Terms>) -> Checked<()> {
    let none = Terms::new();
    let own = terms.get(entry).unwrap_or(&none);
    // At most p + q kicks carry a power of s each, q of them one of rho.
    let told = |power: fn(&(u32, u32)) -> u32| u64::from(own.keys().map(power).max().unwrap_or(0));
    let (in_s, in_rho) = (told(|k| k.0).max(ratio.kicks()), told(|k| k.1).max(ratio.q()));
    for i in 0..=in_s {
        for j in 0..=in_rho {
            let (s, rho) = (fraction(i, 1), fraction(j, 1));
            let value = own
                .iter()
                .fold(Rational::zero(), |sum, ((k, l), c)| sum + c * power(&s, *k) * power(&rho, *l));
            let truth = kicked(entry, ratio, &s, &rho);
            holds(value == truth, || format!("at s = {s}, rho = {rho} it is {truth}, not {value}"))?;
        }
    }
    Ok(())
}

fn power(x: &Rational, k: u32) -> Rational {
    if k == 0 { Rational::one() } else { x.pow(k as i32) }
}

/// The entry at one point: numbers kicked and drifted, no polynomials.
fn kicked(entry: &str, ratio: Ratio, s: &Rational, rho: &Rational) -> Rational {
    let clocks = TwoClocks::with_rho(ratio, s.clone(), rho.clone());
    if entry == "trace" {
        return avi::staggered(&clocks).trace();
    }
    let half = half_period(&clocks);
    match entry {
        "A" => half.a(),
        "B" => half.b(),
        "C" => half.c(),
        _ => half.d(),
    }
    .clone()
}
