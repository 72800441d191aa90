//! Words: letter by letter in numbers, no polynomials.

use nalgebra::Matrix2;
use num_traits::{One, Zero};

use super::context::{Checked, Context, Failure, Outcome, TRACE_ROOM, holds, same};
use super::kind::Verify;
use super::side::step;
use crate::question::{Family, Held, Linted, Listed, Member, Members, Methods, Span, Word, WordCheck};
use number::{ExactSign, Radical, Rational, Real, Result, Ring, Sign, rational};
use words::anharmonic::order_shown;
use words::{Force, Letter, method};

const ROUTE: &str = "letter by letter in exact numbers: a step of each interval, the orders by halving a step, on an anharmonic problem, too; exact flows, filters and friction in doubles";

/// Orders are seen at steps of 2^-80 and half of it: the next order's error is as much smaller.
const STEP_LOG2: u32 = 80;

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
                // Without friction O, F and I do nothing; words with flows take another route.
                Letter::Friction { .. } | Letter::Flow { .. } => return product,
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

impl Verify for Word {
    fn check(&self, linted: &Linted, context: &Context) -> Result<Outcome> {
        // Whose length is within the budget.
        let (word, rho) = (&linted.word, linted.rho.clone().unwrap_or_default());
        let spans = linted.spans(self.lambda1.as_ref());
        let Some(pieces) = &linted.pieces else {
            return context.outcome(ROUTE, has_order(linted), &spans, |span| is_so(span, word, &rho));
        };
        let friction = self.friction.as_ref().map_or(0.0, |rate| rate.to_f64()) / pieces.root.mid_f64();
        let rho = rational::to_f64(&rho);
        context.outcome(ROUTE, Ok(()), &spans, |span| is_so_in_doubles(span, word, rho, friction))
    }
}

fn has_order(linted: &Linted) -> Checked {
    // The order is the least one over all ρ.
    let rhos = [rational::ratio(0, 1), rational::ratio(1, 1), rational::ratio(-1, 2)];
    let rhos = if linted.word.names_forces() { &rhos[..] } else { &rhos[..1] };
    let order = rhos.iter().map(|rho| order(&linted.word, rho)).min().unwrap_or_default();
    same("order", linted.order.order, order)?;
    has_general_orders(linted)?;
    holds(linted.word.is_consistent() || order == 0, || "it has an order, so it is consistent".into())
}

/// The orders on all problems, where steps can show them.
fn has_general_orders(linted: &Linted) -> Checked {
    let Ok(orders) = &linted.general else { return Ok(()) };
    let both = [("general order", &orders.general, false), ("Nystrom order", &orders.nystrom, true)];
    both.into_iter().try_for_each(|(name, found, quadratic)| {
        let seen = order_shown(&linted.word, quadratic, STEP_LOG2);
        seen.map_or(Ok(()), |seen| same(name, found.order, seen.round() as u64))
    })
}

/// The order at one ρ: the error of a step of 2^-80, and of half of it, against the series of the flow.
fn order(word: &words::Word, rho: &Rational) -> u64 {
    let error = |log2: u32| {
        let h = rational::scale2(&1.into(), -i64::from(log2));
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
    let (coarse, fine) = (error(STEP_LOG2), error(STEP_LOG2 + 1));
    if coarse.is_zero() || fine.is_zero() {
        return u64::MAX;
    }
    // Between 2^(p + 1/2) and 2^(p + 3/2), in squares.
    let ratio = coarse / fine;
    let square = &ratio * &ratio;
    let log2 = square.to_integer().bits();
    (log2 / 2).saturating_sub(1)
}

/// The verdict in the middle of an interval.
fn is_so(span: &Span, word: &words::Word, rho: &Rational) -> Checked {
    let [lower, upper] = span.enclosed();
    let lower = lower.map_or(0.0, |ends| ends.1);
    let upper = upper.map_or(2.0 * lower + 1.0, |ends| ends.0);
    let ends = rational::from_f64_exact(lower).zip(rational::from_f64_exact(upper));
    // Ends that are one double leave no step between them to try.
    let Some((lo, hi)) = ends.filter(|(lo, hi)| lo < hi) else { return Ok(()) };
    let omega_h = (lo + hi) / Rational::from_integer(2.into());
    let sign = inside(word, &(&omega_h * &omega_h), rho);
    let stable = sign == Sign::Positive;
    holds(sign == Sign::Zero || stable == span.stable, || verdict_at(rational::to_f64(&omega_h), stable))
}

/// The trace in the middle against 1 + the determinant; γ in units of √Λ1.
fn is_so_in_doubles(span: &Span, word: &words::Word, rho: f64, friction: f64) -> Checked {
    let [lower, upper] = span.enclosed();
    let lower = lower.map_or(0.0, |ends| ends.1);
    let omega_h = upper.map_or(lower + 0.01, |ends| (lower + ends.0) / 2.0);
    let (trace, determinant) = step(word, omega_h * omega_h, rho, friction * omega_h);
    let margin = 1.0 + determinant - trace.abs();
    holds(margin.abs() < TRACE_ROOM || (margin > 0.0) == span.stable, || verdict_at(omega_h, margin > 0.0))
}

fn verdict_at(omega_h: f64, stable: bool) -> String {
    format!("at omega h = {omega_h} it is {}", if stable { "stable" } else { "unstable" })
}

impl Verify for Methods {
    fn check(&self, methods: &&'static [Listed], context: &Context) -> Result<Outcome> {
        context.outcome(ROUTE, Ok(()), methods, has_edges)
    }
}

/// Just below an edge it is stable, just above it is not: the interval there is no narrower than 2^-30 of its
/// size.
fn has_edges(Listed { method: listed, linted, two }: &Listed) -> Checked {
    let word = &linted.word;
    holds(method(listed.name)?.word() == *word, || "its word is another one".into())?;
    has_general_orders(linted)?;
    if let Some((two, edge)) = two.as_ref().and_then(|two| Some((two, two.edge_omega_h()?))) {
        let lo = edge.to_f64_enclosure().0 * (1.0 - 1e-4);
        let margin = 2.0 - step(word, lo * lo, 1.0 / 16.0, 0.0).0.abs();
        holds(margin > 0.0, || "its edge beside a slow force is another one".into())?;
        // Where the order is high the steps behind it are unstable for less than 1e-4 of their size.
        let behind = two.spans(None).into_iter().find(|span| !span.stable);
        behind.map_or(Ok(()), |span| is_so_in_doubles(&span, word, 1.0 / 16.0, 0.0))?;
    }
    let Some((lo, hi)) = linted.nominal_edge().map(|edge| edge.to_f64_enclosure()) else { return Ok(()) };
    for (x, sign) in [(lo * (1.0 - 1e-10), Sign::Positive), (hi * (1.0 + 1e-10), Sign::Negative)] {
        let Some(x) = rational::from_f64_exact(x) else { return Ok(()) };
        holds(inside(word, &(&x * &x), &Rational::zero()) == sign, || "its edge is another one".into())?;
    }
    Ok(())
}

impl Verify for WordCheck {
    /// Each word as `word` has it, by its own other route.
    fn check(&self, answer: &Vec<Held>, context: &Context) -> Result<Outcome> {
        let mut whole = Outcome::holding(ROUTE, answer.iter().map(|held| held.checks.len() as u64).sum());
        for (claimed, held) in self.words.iter().zip(answer) {
            let Outcome { failures, .. } = claimed.word.check(&held.linted, context)?;
            let about_words =
                failures.into_iter().map(|failure| Failure { row: 0, place: held.name.clone(), ..failure });
            whole.failures.extend(about_words);
        }
        Ok(whole)
    }
}

impl Verify for Family {
    fn check(&self, members: &Members, context: &Context) -> Result<Outcome> {
        let best = members.best.iter().try_for_each(|best| is_member(self, &best.member));
        context.outcome(ROUTE, best, &members.all, |member| is_member(self, member))
    }
}

/// Steps at which the bias is looked at, and the part of the worst one that these may miss.
const STEPS: i64 = 60;
const MISSED: f64 = 0.05;

/// No step has a worse energy error than the worst one, and some step is nearly as bad.
fn is_worst(family: &Family, member: &Member, rho: &Rational) -> Checked {
    let Some(worst) = &member.bias else { return Ok(()) };
    let (up_to, sum) = (family.up_to(&member.linted), Rational::one() + rho);
    let at = |n: i64| {
        let omega_h = &up_to * rational::ratio(n, STEPS);
        let square = &omega_h * &omega_h;
        let product = product(&member.linted.word, &square, rho);
        let [b, c] = [(0, 1), (1, 0)].map(|at| product[at].enclosure(64).mid_f64());
        let bias = -rational::to_f64(&(&square * &sum)) * b / c;
        (bias + 1.0 / bias) / 2.0 - 1.0
    };
    let seen = (1..=STEPS).map(at).fold(0.0, f64::max);
    let worst = worst.mid_f64();
    // A few roundings beside numbers of size 1.
    let is_so = seen <= worst + 1e-12 && seen >= (1.0 - MISSED) * worst - 1e-12;
    holds(is_so, || format!("steps have an energy error of {seen} at most"))
}

/// The word is that of its values; its orders, its bias and the answers between its edges.
fn is_member(family: &Family, member: &Member) -> Checked {
    let Member { values, linted, .. } = member;
    holds(family.word_at(values)? == linted.word, || "its word is another one".into())?;
    let rho = linted.rho.clone().unwrap_or_default();
    match &linted.pieces {
        None => {
            has_order(linted)?;
            is_worst(family, member, &rho)?;
            linted.spans(None).iter().try_for_each(|span| is_so(span, &linted.word, &rho))
        }
        Some(_) => {
            has_general_orders(linted)?;
            let rho = rational::to_f64(&rho);
            linted.spans(None).iter().try_for_each(|span| is_so_in_doubles(span, &linted.word, rho, 0.0))
        }
    }
}
