//! Words: letter by letter in numbers, no polynomials.

use nalgebra::Matrix2;
use num_traits::{One, Zero};

use super::again::{Recheck, asked};
use super::context::{Checked, Context, Outcome, holds, same};
use super::side::step;
use super::written::{Ends, Written};
use crate::question::{Methods, Word};
use number::error::Result;
use number::{ExactSign, Radical, Rational, Real, Ring, Sign, rational};
use words::{Force, Letter, method};

const ROUTE: &str = "letter by letter in exact numbers: a step of each interval, the order by halving a step; exact flows, filters and friction in doubles";

/// Traces this near to an edge decide nothing in doubles.
const NEAR: f64 = 1e-7;

rows! {
    /// `kickdrift/word/1`.
    pub struct Claim {
        input: Word,
        word: Written<words::Word>,
        consistent: bool,
        order: u64,
        intervals: Vec<Row>,
    }

    struct Row [stable] {
        stable: bool,
        lower: Ends | null,
        upper: Ends | null,
    }

    /// `kickdrift/methods/1`.
    pub struct Listed {
        input: Methods,
        methods: Vec<Entry>,
    }

    struct Entry [name] {
        name: String,
        nominal_edge: Ends | null,
        coupled_edge: Ends | null,
        word: Written<words::Word>,
    }
}

/// The product of the letters at h² Λ1 = s, Λ2 = ρ Λ1, in the coordinates (x, h v).
fn product(word: &words::Word, s: &Rational, rho: &Rational) -> Matrix2<Radical> {
    let (zero, one) = (Radical::zero(), Radical::one());
    let number = |x: &Rational| Radical::from_rational(x);
    let force = |force: Force| {
        number(&match force {
            Force::First => s.clone(),
            Force::Second => s * rho,
            Force::All => s * (Rational::one() + rho),
        })
    };
    word.letters().iter().fold(
        Matrix2::new(one.clone(), zero.clone(), zero.clone(), one.clone()),
        |product, letter| {
            let matrix = match letter {
                Letter::Drift(time) => Matrix2::new(one.clone(), time.clone(), zero.clone(), one.clone()),
                // Without friction O does nothing; words with flows take another route.
                Letter::Friction(_) | Letter::Flow { .. } => return product,
                Letter::Kick { filter, .. } if filter.zero => return product,
                Letter::Kick { force: named, powers, .. } => {
                    let force = force(*named);
                    let (mut power, mut strength) = (one.clone(), zero.clone());
                    for c in powers {
                        power *= force.clone();
                        strength += &power * c;
                    }
                    Matrix2::new(one.clone(), zero.clone(), -strength, one.clone())
                }
                Letter::Midpoint { force: named, time } => {
                    let quarter = &(&force(*named) * &(time * time)) * &number(&rational::ratio(1, 4));
                    let over = (&one + &quarter).inverse().unwrap_or_else(Radical::zero);
                    let diagonal = &(&one - &quarter) * &over;
                    Matrix2::new(
                        diagonal.clone(),
                        time * &over,
                        -(&(&force(*named) * time) * &over),
                        diagonal,
                    )
                }
            };
            matrix * product
        },
    )
}

/// Whether |trace| < 2 (`Less`), or more, or 2.
fn inside(word: &words::Word, s: &Rational, rho: &Rational) -> Sign {
    let trace = product(word, s, rho).trace();
    (&Radical::from_rational(&Rational::from_integer(4.into())) - &(&trace * &trace)).sign()
}

impl Recheck for Claim {
    const TABLE: &'static str = "intervals";
    asked!(Word);

    fn check(&self, found: Self::Found, context: &Context) -> Result<Outcome> {
        // Whose length is within the budget.
        let (word, rho) = (&found.word, found.rho.unwrap_or_default());
        let Some(pieces) = &found.pieces else {
            let whole = self.whole(word);
            return context.outcome(ROUTE, ("the word", whole), &self.intervals, |row| row.holds(word, &rho));
        };
        let whole = holds(self.word.0 == *word, || format!("the word is {word}"));
        let friction =
            self.input.friction.as_ref().map_or(0.0, |value| value.to_f64()) / pieces.root.mid_f64();
        context.outcome(ROUTE, ("the word", whole), &self.intervals, |row| {
            row.holds_in_doubles(word, rational::to_f64(&rho), friction)
        })
    }
}

impl Claim {
    fn whole(&self, word: &words::Word) -> Checked {
        holds(self.word.0 == *word, || format!("the word is {word}"))?;
        // The order is the least one over all ρ.
        let names = word.names_forces();
        let rhos = [rational::ratio(0, 1), rational::ratio(1, 1), rational::ratio(-1, 2)];
        let rhos = if names { &rhos[..] } else { &rhos[..1] };
        let orders = rhos.iter().map(|rho| order(word, rho));
        let order = orders.min().unwrap_or_default();
        same("order", self.order, order)?;
        holds(self.consistent || order == 0, || "it has an order, so it is consistent".into())
    }
}

/// The order at one ρ: the error of a step of 2^-80, and of half of it, against the series of the flow.
fn order(word: &words::Word, rho: &Rational) -> u64 {
    const STEP: i64 = 80;
    let error = |log2: i64| {
        let h = rational::scale2(&1.into(), -log2);
        let (s, x) = (&h * &h, &h * &h * (Rational::one() + rho));
        let product = product(word, &s, rho);
        // cos, sin / ω h and −ω h sin by their series in (ω h)², in the time unit of h.
        let series = |from: u64| {
            let term = |(sum, last): (Rational, Rational), k: u64| {
                let next = -last * &x / Rational::from_integer(((2 * k + from) * (2 * k + from - 1)).into());
                (sum + &next, next)
            };
            // The terms left out are below (ω h)^40.
            (1..20).fold((Rational::one(), Rational::one()), term).0
        };
        let (cos, sinc) = (series(0), series(1));
        let off = |i: usize, j: usize, flow: &Rational| &product[(i, j)] - &Radical::from_rational(flow);
        let unit = Radical::from_rational(&h);
        let over = Radical::from_rational(&h.recip());
        let errors =
            [off(0, 0, &cos), off(1, 1, &cos), &off(0, 1, &sinc) * &unit, &off(1, 0, &(-&x * &sinc)) * &over];
        let size = |c: &Radical| c.enclosure(64).abs();
        errors.iter().map(size).map(|ball| ball.upper()).max().unwrap_or_default()
    };
    let (coarse, fine) = (error(STEP), error(STEP + 1));
    if coarse.is_zero() || fine.is_zero() {
        return u64::MAX;
    }
    // Between 2^(p + 1/2) and 2^(p + 3/2), in squares.
    let ratio = coarse / fine;
    let square = &ratio * &ratio;
    let log2 = square.to_integer().bits();
    (log2 / 2).saturating_sub(1)
}

impl Row {
    fn holds(&self, word: &words::Word, rho: &Rational) -> Checked {
        let lower = self.lower.map_or(0.0, |ends| ends.hi);
        let upper = self.upper.map_or(2.0 * lower + 1.0, |ends| ends.lo);
        let ends = rational::from_f64_exact(lower).zip(rational::from_f64_exact(upper));
        // Ends that are one double leave no step between them to try.
        let Some((lo, hi)) = ends.filter(|(lo, hi)| lo < hi) else { return Ok(()) };
        let omega_h = (lo + hi) / Rational::from_integer(2.into());
        let sign = inside(word, &(&omega_h * &omega_h), rho);
        let stable = sign == Sign::Positive;
        holds(sign == Sign::Zero || stable == self.stable, || verdict_at(rational::to_f64(&omega_h), stable))
    }

    /// The trace in the middle against 1 + the determinant; γ in units of √Λ1.
    fn holds_in_doubles(&self, word: &words::Word, rho: f64, friction: f64) -> Checked {
        let lower = self.lower.map_or(0.0, |ends| ends.hi);
        let omega_h = self.upper.map_or(lower + 0.01, |ends| (lower + ends.lo) / 2.0);
        let (trace, determinant) = step(word, omega_h * omega_h, rho, friction * omega_h);
        let margin = 1.0 + determinant - trace.abs();
        holds(margin.abs() < NEAR || (margin > 0.0) == self.stable, || verdict_at(omega_h, margin > 0.0))
    }
}

fn verdict_at(omega_h: f64, stable: bool) -> String {
    format!("at omega h = {omega_h} it is {}", if stable { "stable" } else { "unstable" })
}

impl Recheck for Listed {
    const TABLE: &'static str = "methods";
    asked!(Methods);

    fn check(&self, _: Self::Found, context: &Context) -> Result<Outcome> {
        context.outcome(ROUTE, ("the catalogue", Ok(())), &self.methods, Entry::holds)
    }
}

impl Entry {
    /// Just below the edge it is stable, just above it is not: the interval there is no narrower than 2^-30
    /// of its size.
    fn holds(&self) -> Checked {
        holds(method(&self.name)?.word() == self.word.0, || "its word is another one".into())?;
        if let Some(Ends { lo, hi }) = self.coupled_edge {
            for (x, stable) in [(lo * (1.0 - 1e-4), true), (hi * (1.0 + 1e-4), false)] {
                let margin = 2.0 - step(&self.word.0, x * x, 1.0 / 16.0, 0.0).0.abs();
                holds((margin > 0.0) == stable, || "its edge beside a slow force is another one".into())?;
            }
        }
        let Some(Ends { lo, hi }) = self.nominal_edge else { return Ok(()) };
        for (factor, stable) in [(1.0 - 1e-10, Sign::Positive), (1.0 + 1e-10, Sign::Negative)] {
            let x = if stable == Sign::Positive { lo * factor } else { hi * factor };
            let Some(x) = rational::from_f64_exact(x) else { return Ok(()) };
            let sign = inside(&self.word, &(&x * &x), &Rational::zero());
            holds(sign == stable, || "its edge is another one".into())?;
        }
        Ok(())
    }
}
