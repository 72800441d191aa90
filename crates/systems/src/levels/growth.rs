//! Growth past the first stable region, in doubles: where it is fastest, where it ends. Sampled and rounded
//! but for the step that is proven stable again.

use faer::Mat;
use num_complex::Complex64;

use super::kernel::{Kernel, Outer};
use crate::spectrum::rate::exponent;
use number::{Result, bisected};

/// A stretch of outer steps that grow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growing {
    /// Where it begins,
    pub lower: f64,
    /// and the last step of those sampled that grows, none between being still; `None` up to 1.3 times the
    /// first.
    pub upper: Option<f64>,
    /// The first step above it that is proven stable, as near as doubles can decide.
    pub stable_again: Option<f64>,
    /// The outer step at which growth is fastest of those sampled, and ln |λ| per unit time there.
    pub worst: (f64, f64),
}

/// The farthest that growth is followed, relative.
const REACH: f64 = 1.3;

/// Samples are no farther apart, relative.
const WIDEST: f64 = 1.0 / 60.0;

/// Growth is looked for at so many steps of a stretch.
const SAMPLES: usize = 12;

/// A stretch up to this, relative, is thin: the next one is looked for as far.
const THIN: f64 = 1e-3;
const MOST_STRETCHES: usize = 4;

/// ln |λ| of a period below which roundings may have made it: a double eigenvalue moves by the square root of
/// 10^-16 times its condition.
const STILL: f64 = 1e-5;

impl Kernel {
    /// max ln |λ|/H at an outer step H, from the eigenvalues μ of Bᵀ C = b (c − d M) in doubles.
    pub fn growth(&self, outer: &Outer) -> f64 {
        let (halves, factor) = (self.halves(outer), outer.half_kick());
        let (slow, _) = self.filtered(outer, [0.0; 2]);
        let entry = |i: usize, j: usize| {
            let [b, c, d] = [halves[i].b, halves[i].c, halves[i].d].map(|interval| interval.middle());
            b * ((if i == j { c } else { 0.0 }) - d * factor * slow[(i, j)])
        };
        let period = Mat::from_fn(self.size(), self.size(), entry);
        let rate = |mu: Complex64| exponent(mu).re;
        period.eigenvalues().map_or(f64::NAN, |mu| mu.into_iter().map(rate).fold(0.0, f64::max)) / outer.step
    }
}

/// Growth over the outer step, all steps in their ratios: max ln |λ| per unit time, rounded, and whether a
/// step is proven stable.
pub(super) struct Sampled<'a> {
    pub rate: &'a dyn Fn(f64) -> Result<f64>,
    pub is_stable: &'a dyn Fn(f64) -> bool,
}

impl Sampled<'_> {
    /// Stretches from an unstable outer step `from` on, the first samples `width` apart, relative: up to the
    /// first one that is not thin, as a thin one shows little of those that follow.
    pub fn growing(&self, from: f64, width: f64) -> Result<Vec<Growing>> {
        let mut found = vec![self.stretch(from, width)?];
        while let Some(Growing { lower, upper: Some(upper), .. }) = found.last().copied() {
            let thin = upper / lower - 1.0;
            let next = if thin < THIN { self.next_growing(upper, thin)? } else { None };
            let Some(next) = next.filter(|_| found.len() < MOST_STRETCHES) else { break };
            found.push(self.stretch(next, thin.max(1e-5))?);
        }
        Ok(found)
    }

    /// Where growth begins again within `THIN` above a step, to 1e-7.
    fn next_growing(&self, above: f64, thin: f64) -> Result<Option<f64>> {
        let (mut last, mut width) = (above * (1.0 + 1e-6), (thin / 4.0).max(1e-6));
        while last < above * (1.0 + THIN) {
            let step = last * (1.0 + width);
            if grows(step, (self.rate)(step)?) {
                return Ok(Some(self.end((last, step), false).1));
            }
            (last, width) = (step, 1.3 * width);
        }
        Ok(None)
    }

    /// Steps to 1e-7 between which what is so at the first, growth or none, ends.
    fn end(&self, ends: (f64, f64), growth: bool) -> (f64, f64) {
        bisected(ends, 1e-7, |step| Some(grows(step, (self.rate)(step).ok()?) == growth))
    }

    fn stretch(&self, from: f64, width: f64) -> Result<Growing> {
        let (mut last, mut width, mut still) = (from, width, None);
        while last < REACH * from && still.is_none() {
            let step = last * (1.0 + width);
            if grows(step, (self.rate)(step)?) {
                (last, width) = (step, (1.5 * width).min(WIDEST));
            } else {
                still = Some(step);
            }
        }
        let ends = still.map(|still| self.end((last, still), true));
        let worst = self.fastest_between(from, ends.map_or(last, |(upper, _)| upper))?;
        // At the end itself multipliers are double, and doubles cannot decide.
        let proven = |still: f64| (0..12).map(move |k| still * (1.0 + 1e-7 * f64::from(4u32.pow(k))));
        let stable_again = ends.and_then(|(_, still)| proven(still).find(|step| (self.is_stable)(*step)));
        Ok(Growing { lower: from, upper: ends.map(|(upper, _)| upper), stable_again, worst })
    }

    /// The fastest of `SAMPLES` steps between, and of some nearer and nearer to it.
    fn fastest_between(&self, lo: f64, hi: f64) -> Result<(f64, f64)> {
        let mut worst = (lo, (self.rate)(lo)?);
        let mut width = (hi - lo) / SAMPLES as f64;
        let see = |step: f64, worst: &mut (f64, f64)| -> Result<()> {
            let rate = (self.rate)(step)?;
            if rate > worst.1 {
                *worst = (step, rate);
            }
            Ok(())
        };
        (1..SAMPLES).try_for_each(|k| see(lo + width * k as f64, &mut worst))?;
        for _ in 0..6 {
            width /= 2.0;
            let middle = worst.0;
            [middle - width, middle + width].into_iter().try_for_each(|step| see(step, &mut worst))?;
        }
        Ok(worst)
    }
}

fn grows(step: f64, rate: f64) -> bool {
    rate * step > STILL
}
