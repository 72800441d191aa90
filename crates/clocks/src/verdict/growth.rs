//! Trace, growth and label of a pair, as enclosures.
//!
//! Inside a tongue the multiplier is μ = (|Tr| + √(Tr² − 4))/2. From the half period, without cancellation at
//! |Tr| = 2,
//!
//! ```text
//!     ln μ = 2 asinh √(BC)   for Tr > 2,        ln μ = 2 asinh √(-AD)   for Tr < -2,
//! ```
//!
//! since Tr = 2 cosh(ln μ) = 2 + 4 sinh²(ln μ / 2) (theorems `multiplier_plus`, `multiplier_minus` in
//! proofs/).

use super::exact::Decidable;
use super::kind::{Side, Verdict};
use super::label::{from_nodes, label};
use super::tier::{Limits, Tier};
use crate::orbit::floquet::Floquet;
use crate::orbit::returns::{self, Wanted};
use crate::orbit::{filter, plain, refine};
use crate::propagator::{LongClocks, Oscillator, TwoClocks};
use crate::schedule::Schedule;
use number::parallel::go_on;
use number::{Ball, Error, Real, Result};

/// How a pair moves over one synchronization period. As JSON its enclosures are two doubles with the value
/// between them, `{"lo": , "hi": }`.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Growth {
    /// Tr Q.
    pub trace: Ball,
    /// ln μ, the growth over one period T; divide by T for the rate per unit time. `None` unless hyperbolic.
    pub ln_multiplier: Option<Ball>,
    /// m, the tongue's label: half turns of the growing solution over one period. `None` unless hyperbolic.
    pub label: Option<u64>,
}

impl Growth {
    /// ln μ / T per unit time, near the middle of its enclosure; 0 where nothing grows exponentially.
    pub fn rate(&self, oscillator: &Oscillator) -> f64 {
        const BITS: u32 = 96;
        let period = oscillator.period().enclosure(BITS);
        let rate = self.ln_multiplier.as_ref().and_then(|ln| ln.div(&period, BITS));
        rate.map_or(0.0, |rate| rate.mid_f64())
    }
}

/// Above this many kicks the enclosures come from the filter and are as tight as doubles allow.
const WORTH_REFINING: u64 = 2_000_000;

/// Bits of relative accuracy asked of the trace's distance from ±2: more than a double shows.
const ACCURACY: i64 = 60;

/// As many are enough of a period so long that its return maps decide: ten digits.
const ACCURACY_OF_RETURNS: i64 = 34;

/// Bits in which half turns are counted kick by kick: the orbit that grows is known ever better, so few do.
const COUNTED: [u32; 4] = [128, 256, 512, 1024];

/// The enclosures of a pair whose verdict is known.
///
/// # Errors
/// A budget error where more kicks would have to be composed than `limits` allows.
pub fn growth<S: Decidable>(clocks: &TwoClocks<S>, verdict: Verdict, limits: &Limits) -> Result<Growth> {
    Runs::default().growth(clocks, verdict, limits)
}

/// As [`growth`], by return maps alone: the period may hold any number of kicks.
///
/// # Errors
/// A budget error where entries have more than 2^58 binary digits. `Stopped`.
pub fn long_growth<S: Real>(clocks: &LongClocks<S>, verdict: Verdict) -> Result<Growth> {
    Runs::default().long_growth(clocks, verdict)
}

/// The runs through the half period that a decision has made.
#[derive(Debug, Default)]
pub(super) struct Runs {
    /// `Some(None)` where the filter ran and its bound did not hold.
    pub filtered: Option<Option<filter::Ends>>,
    /// The last one, and its bits.
    pub refined: Option<(refine::Ends, u32)>,
}

impl Runs {
    /// The label, where the filter's run gives it.
    pub fn label(&self, verdict: Verdict) -> Option<u64> {
        label(self.filtered.as_ref()?.as_ref()?, verdict)
    }

    /// As [`growth`], from these runs as far as they reach.
    pub fn growth<S: Decidable>(
        &self,
        clocks: &TwoClocks<S>,
        verdict: Verdict,
        limits: &Limits,
    ) -> Result<Growth> {
        if let Verdict::Parabolic(side) | Verdict::Coexistence(side) = verdict {
            let trace = Ball::from_integer(&(2 * i64::from(side.sign())).into());
            return Ok(Growth { trace, ln_multiplier: None, label: None });
        }
        let ratio = clocks.ratio();
        // Unless kicks had to decide, return maps give more than those of the filter could.
        if (self.refined.is_some() || self.filtered.is_none())
            && returns::is_worth(ratio, 53)
            && let Some(Returned { products, label, .. }) =
                self.returned(&clocks.into(), u32::MAX, verdict, ACCURACY_OF_RETURNS)
        {
            go_on()?;
            let label = if label.is_none() { counted(clocks, verdict, limits)? } else { label };
            return Ok(from_products(products, verdict, label));
        }
        let schedule = Schedule::two_clocks(ratio)?;
        let filtered = self.filtered.unwrap_or_else(|| first_tier(clocks, &schedule));
        let label = filtered.as_ref().and_then(|ends| label(ends, verdict));
        if let Some(ends) = filtered.filter(|_| schedule.strikes() > WORTH_REFINING) {
            return Ok(from_products(products(&ends), verdict, label));
        }
        if returns::is_worth(ratio, 106) {
            // Where kicks are few, 128 bits of them cost less than return maps in 256.
            let most = if returns::is_worth(ratio, 53) { u32::MAX } else { 106 };
            let found = self.returned(&clocks.into(), most, verdict, ACCURACY);
            let found = found.filter(|found| found.is_enough);
            go_on()?;
            if let Some(Returned { products, label: nodes, .. }) = found {
                return Ok(from_products(products, verdict, label.or(nodes)));
            }
        }
        limits.allow(refine::kicks(ratio), Tier::Refine)?;
        let (products, nodes) = self.refined(clocks, &schedule, verdict)?;
        Ok(from_products(products, verdict, label.or(nodes)))
    }

    /// As [`long_growth`], from these runs as far as they reach.
    pub fn long_growth<S: Real>(&self, clocks: &LongClocks<S>, verdict: Verdict) -> Result<Growth> {
        let found = self.returned(clocks, u32::MAX, verdict, ACCURACY_OF_RETURNS);
        go_on()?;
        let Returned { products, label, .. } = found.ok_or_else(|| {
            let work = format!(
                "the pair is {}, but the entries of its half period have more than 2^58 binary digits",
                verdict.kind().name()
            );
            Error::too_much(work, "choose steps with a simpler ratio")
        })?;
        Ok(from_products(products, verdict, label))
    }

    /// By the known run, then by return maps in more bits, at most in `most`, until `least` bits are known,
    /// and the label.
    fn returned<S: Real>(
        &self,
        clocks: &LongClocks<S>,
        most: u32,
        verdict: Verdict,
        least: i64,
    ) -> Option<Returned> {
        let of = |ends: &refine::Ends, bits| {
            let (products, label) = (ends.products(2 * bits), from_nodes(ends, verdict));
            // More bits than two doubles have give no further labels.
            let is_labelled = label.is_some() || verdict.side() == 0 || bits > 53;
            let is_enough = products.accuracy() >= least && is_labelled;
            Returned { products, label, is_enough }
        };
        let mut best = self.refined.as_ref().map(|(ends, bits)| of(ends, *bits));
        // For the label the same bits may do, with the sign changes that a verdict alone does not ask for.
        let wanted = if verdict.side() == 0 { Wanted::Entries } else { Wanted::Nodes };
        let known = self.refined.as_ref().map_or(0, |(_, bits)| *bits);
        let from = if wanted == Wanted::Nodes { known } else { known + 1 };
        for bits in returns::PRECISIONS.into_iter().filter(|&bits| bits >= from && bits <= most) {
            if best.as_ref().is_some_and(|best| best.is_enough) {
                break;
            }
            let Some(ends) = returns::run(clocks, bits, wanted) else { continue };
            let found = of(&ends, bits);
            best = Some(Returned { label: found.label.or(best.and_then(|best| best.label)), ..found });
        }
        best
    }

    /// Refines until the distance from ±2 is known to [`ACCURACY`] bits; with the label as the sign changes
    /// give it.
    fn refined<S: Decidable>(
        &self,
        clocks: &TwoClocks<S>,
        schedule: &Schedule,
        verdict: Verdict,
    ) -> Result<(Products, Option<u64>)> {
        let mut bits = 128;
        if let Some((ends, known)) = &self.refined {
            if let Some(found) = accurate(ends, *known, verdict) {
                return Ok(found);
            }
            bits = 2 * known;
        }
        loop {
            let ends = refine::run_at_any(clocks, schedule, bits);
            if let Some(found) = ends.and_then(|ends| accurate(&ends, bits, verdict)) {
                return Ok(found);
            }
            go_on()?;
            bits *= 2;
        }
    }
}

/// The label by kicks, where return maps lose the turns and the limits allow kicks. `None` where they do not,
/// and unless hyperbolic.
fn counted<S: Decidable>(clocks: &TwoClocks<S>, verdict: Verdict, limits: &Limits) -> Result<Option<u64>> {
    let ratio = clocks.ratio();
    if verdict.side() == 0 || refine::kicks(ratio) > limits.kicks {
        return Ok(None);
    }
    let schedule = Schedule::two_clocks(ratio)?;
    let quick = first_tier(clocks, &schedule).and_then(|ends| label(&ends, verdict));
    let by_kicks = |bits: u32| from_nodes(&refine::run_at_any(clocks, &schedule, bits)?, verdict);
    let found = quick.or_else(|| COUNTED.into_iter().find_map(by_kicks));
    go_on().map(|()| found)
}

/// The first tier's run: in Floquet coordinates, or kick by kick where there are none.
fn first_tier<S: Real>(clocks: &TwoClocks<S>, schedule: &Schedule) -> Option<filter::Ends> {
    match Floquet::new(clocks) {
        Some(floquet) => filter::run(&floquet),
        None => plain::run(clocks, schedule),
    }
}

/// Tr Q as the first tier alone encloses it: min(p, q)/2 updates in doubles. `None` where it proves nothing:
/// both clocks beyond their own Verlet limits, a clock that does nothing, or a bound that a condition of its
/// theorem does not allow.
///
/// ```
/// use kickdrift_clocks::number::rational::ratio;
/// use kickdrift_clocks::propagator::{TwoClocks, half_period};
/// let clocks = TwoClocks::with_rho("7/2".parse().unwrap(), ratio(1, 3), ratio(1, 25));
/// let trace = kickdrift_clocks::verdict::filter_trace(&clocks).unwrap();
/// assert!(trace.contains(&half_period(&clocks).trace()) && trace.relative_accuracy_bits() > 40);
/// ```
pub fn filter_trace<S: Real>(clocks: &TwoClocks<S>) -> Option<Ball> {
    let ends = filter::run(&Floquet::new(clocks)?)?;
    Some(from_products(products(&ends), Verdict::Elliptic, None).trace)
}

/// The ends and the label from return maps.
struct Returned {
    products: Products,
    label: Option<u64>,
    is_enough: bool,
}

/// BC and AD, as enclosures; AD − BC = 1.
#[derive(Clone, Debug)]
pub(super) struct Products {
    pub bc: Ball,
    pub ad: Ball,
}

fn from_products(products: Products, verdict: Verdict, label: Option<u64>) -> Growth {
    const BITS: u32 = 128;
    let two = Ball::from_integer(&2.into());
    let (above, below) = (products.bc.scale2(2), products.ad.scale2(2));
    // The smaller product knows its distance from ±2 better.
    let near_two = above.mid_f64().abs() <= below.mid_f64().abs();
    let trace = if near_two { two.add(&above, BITS) } else { below.sub(&two, BITS) };
    let excess = match verdict {
        Verdict::Hyperbolic(Side::Plus) => products.bc,
        Verdict::Hyperbolic(Side::Minus) => products.ad.neg(),
        _ => return Growth { trace, ln_multiplier: None, label: None },
    };
    let ln_multiplier = excess.sqrt_clipped(BITS).map(|root| root.asinh(BITS).scale2(1));
    Growth { trace, ln_multiplier, label }
}

/// The products and the label, where `bits` bits were enough.
fn accurate(ends: &refine::Ends, bits: u32, verdict: Verdict) -> Option<(Products, Option<u64>)> {
    let products = ends.products(2 * bits);
    (products.accuracy() >= ACCURACY).then(|| (products, from_nodes(ends, verdict)))
}

impl Products {
    /// Bits to which both are known; of a trace beyond 2^n only the logarithm is shown, which is known to
    /// log₂ n bits more.
    fn accuracy(&self) -> i64 {
        let accuracy = self.bc.relative_accuracy_bits().min(self.ad.relative_accuracy_bits());
        let beyond = self.ad.top().unwrap_or(0).max(64) as u64;
        accuracy.saturating_add(i64::from(beyond.ilog2()) - 6)
    }
}

impl refine::Ends {
    fn products(&self, bits: u32) -> Products {
        Products { bc: self.odd.x.mul(&self.even.v, bits), ad: self.even.x.mul(&self.odd.v, bits) }
    }
}

/// The filter's products: exact vector = a 2^e ((x, v) + t J(x, v)/|(x, v)|²), |t| ≤ across.
fn products(ends: &filter::Ends) -> Products {
    let product = |(x, one): (f64, &filter::End), (v, other): (f64, &filter::End)| {
        component(x, one).mul(&component(v, other), 128)
    };
    let (even, odd) = (&ends.even, &ends.odd);
    Products { bc: product((odd.x, odd), (even.v, even)), ad: product((even.x, even), (odd.v, odd)) }
}

fn component(value: f64, end: &filter::End) -> Ball {
    let slack = 1.001 * (end.across / end.x.hypot(end.v) + end.rounding * value.abs());
    let between = |lo: f64, hi: f64| Ball::between(lo, hi, 128).expect("finite");
    let range = between((value - slack).next_down(), (value + slack).next_up());
    let length = between(1.0 - 1.4 * end.stretch, 1.0 + 1.4 * end.stretch);
    range.mul(&length, 128).scale2(end.exponent)
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::ratio;

    #[test]
    fn half_turns_are_counted_kick_by_kick_within_the_budget_alone() {
        let clocks = TwoClocks::with_rho("7/3".parse().unwrap(), ratio(19, 8), ratio(1, 25));
        let label = |verdict, kicks| counted(&clocks, verdict, &Limits { kicks }).unwrap();
        assert_eq!(label(Verdict::Hyperbolic(Side::Plus), 100), Some(4));
        assert_eq!(label(Verdict::Hyperbolic(Side::Plus), 4), None);
        assert_eq!(label(Verdict::Elliptic, 100), None);
    }
}
