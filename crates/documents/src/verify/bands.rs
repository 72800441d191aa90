//! Sectors in which every ratio is unstable: pairs of steps in them, each decided by the ladder.

use super::context::{Checked, Context, Failure, Outcome, holds};
use super::exact::encloses;
use super::kind::Verify;
use super::sample::sample;
use crate::question::{Bands, Fields};
use clocks::band::{self, Sector, Window};
use clocks::propagator::Oscillator;
use clocks::verdict::{Kind, decide};
use number::{Ball, ExactSign, Laurent, Rational, Result, Sign, rational};

const ROUTE: &str = "nine pairs of steps in each sector, worst placed, with ratios as simple as there are: all are hyperbolic by the ladder, in the tongue named";

/// Sectors that the slower route takes unless it takes all.
const SECTORS: u64 = 200;

/// Where between both sides h1 is, in thousandths.
const PLACES: [i64; 3] = [1, 500, 999];

/// Bits of areas.
const BITS: u32 = 128;

impl Verify for Bands {
    fn check(&self, bands: &band::Bands, context: &Context) -> Result<Outcome> {
        let count = bands.certified.len() as u64;
        let texts = self.input();
        let text: String = texts.iter().filter_map(|(_, text)| text.as_str()).collect();
        let chosen = sample(&text, count, if context.options.all { count } else { SECTORS });
        let sectors: Vec<&Sector> = chosen.iter().map(|&n| &bands.certified[n as usize]).collect();
        let is_sound =
            |sector: &&Sector| is_inside(sector, &bands.window).and_then(|()| self.grows(sector, context));
        let outcome = context.outcome(ROUTE, whole(bands), &sectors, is_sound)?;
        let row = |failure: Failure| match failure.row {
            0 => failure,
            row => Failure { row: chosen[row as usize - 1] + 1, ..failure },
        };
        let failures = outcome.failures.into_iter().map(row).collect();
        let sample = (chosen.len() as u64 != count).then_some((chosen.len() as u64, count));
        Ok(Outcome { rows: count, sample, failures, ..outcome })
    }
}

/// The area by Simpson's rule, which is exact here; no two sectors of one curve overlap.
fn whole(bands: &band::Bands) -> Checked {
    let area = bands.certified.iter().fold(Ball::zero(), |sum, sector| sum.add(&area(sector), BITS));
    holds(encloses(bands.area(), &area), || "its area is outside its enclosure".into())?;
    let mut ranges: Vec<_> = bands.certified.iter().map(|sector| (sector.family, ratios(sector))).collect();
    ranges.sort();
    let are_apart = ranges.windows(2).all(|pair| pair[0].0 != pair[1].0 || pair[0].1[1] <= pair[1].1[0]);
    holds(are_apart, || "two of its sectors overlap".into())
}

fn ratios(sector: &Sector) -> [Rational; 2] {
    sector.ratios.map(|(p, q)| Rational::new(p.into(), q.into()))
}

/// The integral of (upper² − lower²)/2 over the ratio.
fn area(sector: &Sector) -> Ball {
    let [from, to] = ratios(sector);
    let at = |ratio: &Rational| {
        let [lower, upper] = sector.sides_at(ratio);
        &upper * &upper - &lower * &lower
    };
    let middle = (&from + &to) / rational::ratio(2, 1);
    let sum = at(&from) + rational::ratio(4, 1) * at(&middle) + at(&to);
    Ball::from_rational(&(sum * (to - from) / rational::ratio(12, 1)), BITS)
}

/// Its corners lie in the window, its sides in their order.
fn is_inside(sector: &Sector, window: &Window) -> Checked {
    let is_in_range = |step: usize, x: &Rational| {
        let ((lo, hi), x) = (window.range(step), Laurent::from_rational(x.clone()));
        (&x - lo).sign() != Sign::Negative && (hi - &x).sign() != Sign::Negative
    };
    for ratio in ratios(sector) {
        let [lower, upper] = sector.sides_at(&ratio);
        holds(lower < upper, || "its sides cross".into())?;
        let all = [lower, upper].iter().all(|h1| is_in_range(0, h1) && is_in_range(1, &(h1 * &ratio)));
        holds(all, || "it leaves the window".into())?;
    }
    Ok(())
}

impl Bands {
    /// Pairs all over the sector grow, in its tongue.
    fn grows(&self, sector: &Sector, context: &Context) -> Checked {
        let [from, to] = &ratios(sector);
        let part = (to - from) / Rational::from_integer(50.into());
        for (lo, hi) in [(from, to), (from, &(from + &part)), (&(to - &part), to)] {
            let ratio = rational::simplest(lo, hi);
            let [lower, upper] = sector.sides_at(&ratio);
            for place in PLACES {
                let h1 = &lower + (&upper - &lower) * rational::ratio(place, 1000);
                let [first, second] = [h1.clone(), &h1 * &ratio].map(Laurent::from_rational);
                let (lambda1, lambda2) = (self.lambda1.clone(), self.lambda2.clone());
                let clocks = Oscillator::new(lambda1, lambda2, first, second)?.clocks()?;
                let answer = decide(&clocks, &context.limits())?;
                let kind = answer.verdict.kind();
                holds(kind == Kind::Hyperbolic, || format!("h1 = {h1}, h2/h1 = {ratio} is {}", kind.name()))?;
                let turns = ratio.numer() * sector.family[0] + ratio.denom() * sector.family[1];
                let label = answer.label()?;
                holds(label.is_some_and(|m| turns == m.into()), || {
                    format!("h1 = {h1}, h2/h1 = {ratio} is in another tongue")
                })?;
            }
        }
        Ok(())
    }
}
