//! Stretches of a number whose edges are isolated exactly: nothing between them is left open.
//!
//! Masses or stiffnesses are linear in the number, or in its square (an outer step at fixed ratios: in the
//! old steps all stiffnesses grow with its square). Where the polynomials of `critical` are within the
//! limits, the verdict at one rational number between two neighbouring roots is that of all; a root that is
//! no double lies between the end of one stretch and the beginning of the next, two neighbouring doubles.
//! Else cells cover the range (`vary`).

use crate::half::compose;
use crate::linear::system::System;
use crate::signs::action;
use crate::vary::between::{Cells, verify_line};
use crate::vary::critical::{Gap, Line, Plan};
use crate::vary::stretches::{Stretch, cover};
use crate::verdict::decide::decide_system;
use crate::verdict::limits::Limits;
use crate::verdict::measured::Holds;
use number::rational::simplest;
use number::{Rational, Result, from_f64_exact, ratio};

/// The function in which masses or stiffnesses are linear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Linear {
    /// The number x itself.
    Number,
    /// x², x > 0, by which all stiffnesses are multiplied.
    Square,
}

impl Linear {
    fn of(self, x: &Rational) -> Rational {
        match self {
            Linear::Number => x.clone(),
            Linear::Square => x * x,
        }
    }
}

/// Eliminations of the action that a cell takes, roughly: signs at both ends, and counts at some halvings of
/// those that counts prove.
const ELIMINATIONS: f64 = 16.0;

/// A product of rationals, with what goes on around it, in products of words: of these a cell takes 3 n³
/// where rigid modes leave the masses of the rest dense.
const RATIONAL: f64 = 1000.0;

/// The systems of one number.
pub struct Family<'a> {
    pub linear: Linear,
    /// The system of a number, or of its square, on which masses or stiffnesses depend linearly, steps fixed.
    pub at: &'a (dyn Fn(&Rational) -> Result<System> + Sync),
}

impl Family<'_> {
    /// The verdicts on all systems with a number from lo to hi: exactly where this is within the limits, else
    /// by cells, no interval wider than `width` times the larger end missed.
    ///
    /// # Errors
    /// As [`Family::exactly`]; an empty range, a width outside \[10^-9, 1/10\].
    pub fn stretches(&self, (lo, hi): (f64, f64), width: f64, limits: &Limits) -> Result<Vec<Stretch>> {
        match if lo < hi { self.exactly((lo, hi), limits)? } else { None } {
            Some(found) => Ok(found),
            None => self.over_cells(|cells| cover((lo, hi), width, |lo, hi| self.cell(cells, lo, hi))),
        }
    }

    /// Between lo < hi, nothing left open: the end of a stretch and the beginning of the next are
    /// neighbouring doubles with one edge or more between them, or one stretch holds the edge, a double.
    /// `None` where this is beyond the limits.
    ///
    /// # Errors
    /// Where masses and stiffnesses are not linear or steps differ; as `at` and [`decide_system`].
    pub fn exactly(&self, (lo, hi): (f64, f64), limits: &Limits) -> Result<Option<Vec<Stretch>>> {
        let [a, b] = [lo, hi].map(|x| self.linear.of(&exact(x)));
        let fraction = |x: &Rational| (self.linear.of(x) - &a) / (&b - &a);
        let Some(plan) = self.plan((lo, hi), limits)? else { return Ok(None) };
        let Some(gaps) = plan.gaps((lo, hi), &fraction)? else { return Ok(None) };
        let verdict = |x: &Rational| Ok(decide_system(&(self.at)(&self.linear.of(x))?, limits)?.holds());
        self.over_cells(|cells| {
            let within = |gap: &Gap, around: Holds| {
                let sides = [gap.lo, gap.hi].map(|x| fraction(&exact(x)));
                match around {
                    Holds::Unstable if plan.is_unstable_in(gap, sides, limits)? => Ok(around),
                    _ => self.cell(cells, gap.lo, gap.hi),
                }
            };
            between((lo, hi), &gaps, &verdict, &within).map(Some)
        })
    }

    fn plan(&self, (lo, hi): (f64, f64), limits: &Limits) -> Result<Option<Plan>> {
        let [(_, first), (_, middle), (_, last)] = self.three(lo, hi)?;
        verify_line([&first, &middle, &last])?;
        Plan::new(&Line::new([first, last]), limits)
    }

    /// The products that the stretches of a range cost, roughly: those of the polynomials, else of so many
    /// cells.
    ///
    /// # Errors
    /// As [`Family::exactly`].
    pub fn cost(&self, (lo, hi): (f64, f64), cells: f64, limits: &Limits) -> Result<f64> {
        if let Some(plan) = self.plan((lo, hi), limits)? {
            return Ok(plan.cost());
        }
        let [_, (_, middle), _] = self.three(lo, hi)?;
        // The half period with its norms, some eliminations, and rational entries: as measured on
        // bar-resonant.json and chain200.json.
        let entries = middle.clocks().iter().map(|own| own.stiffness.places().count()).sum::<usize>();
        let n = middle.size() as f64;
        let rigid = if middle.rigid_modes().is_empty() { 0.0 } else { RATIONAL * 3.0 * n.powi(3) };
        let own = 16.0 * compose::cost(&middle) as f64 + 4.0 * n.powi(3) + 8_000.0 * (entries as f64 + n);
        let signs = ELIMINATIONS * action::cost_of_signs(&middle);
        Ok(cells * (own + rigid + signs))
    }

    /// The result of `ask` on the cells of these systems.
    fn over_cells<T>(&self, ask: impl FnOnce(&Cells) -> Result<T>) -> Result<T> {
        let at = |x: f64| (self.at)(&self.linear.of(&exact(x)));
        ask(&Cells::new(&at, self.linear == Linear::Square))
    }

    /// The verdict that a cell proves for all systems in it.
    fn cell(&self, cells: &Cells, lo: f64, hi: f64) -> Result<Holds> {
        let three = self.three(lo, hi)?;
        cells.verdict((lo, hi), three.each_ref().map(|(_, own)| own))
    }

    /// The systems at both ends and at their mean.
    fn three(&self, lo: f64, hi: f64) -> Result<[(Rational, System); 3]> {
        let [a, b] = [lo, hi].map(|x| self.linear.of(&exact(x)));
        let middle = (&a + &b) / Rational::from_integer(2.into());
        let [first, mean, last] = [&a, &middle, &b].map(|x| (self.at)(x));
        Ok([(a, first?), (middle, mean?), (b, last?)])
    }
}

/// The stretches between gaps, each decided at one number; `within` is asked about a gap between two
/// stretches of one verdict.
pub fn between(
    (lo, hi): (f64, f64),
    gaps: &[Gap],
    verdict: &impl Fn(&Rational) -> Result<Holds>,
    within: &impl Fn(&Gap, Holds) -> Result<Holds>,
) -> Result<Vec<Stretch>> {
    let free = |lo: f64, hi: f64| -> Result<Option<Stretch>> {
        let sample = || if lo == hi { exact(lo) } else { inside(lo, hi) };
        (lo <= hi).then(|| Ok(Stretch { lo, hi, verdict: verdict(&sample())? })).transpose()
    };
    let mut found: Vec<Stretch> = Vec::new();
    let mut at = lo;
    for gap in gaps {
        found.extend(free(at, gap.lo)?);
        if let Some(x) = gap.double() {
            found.extend(free(x, x)?);
        }
        at = gap.hi;
    }
    found.extend(free(at, hi)?);
    let mut all: Vec<Stretch> = Vec::new();
    for own in found {
        let Some(last) = all.last().filter(|last| last.verdict == own.verdict).copied() else {
            all.push(own);
            continue;
        };
        // Two doubles without one between them: either a gap lies there, or nothing can change.
        let gap = gaps.iter().find(|gap| gap.double().is_none() && gap.lo == last.hi);
        let holds = |gap: &Gap| match &gap.exact {
            Some(x) => verdict(x),
            None => within(gap, own.verdict),
        };
        if gap.map_or(Ok(true), |gap| Ok(holds(gap)? == own.verdict))? {
            all.last_mut().expect("just seen").hi = own.hi;
        } else {
            all.extend([Stretch { lo: last.hi, hi: own.lo, verdict: Holds::Undecided }, own]);
        }
    }
    Ok(all)
}

/// A number well within (lo, hi), of small denominator where it can be.
fn inside(lo: f64, hi: f64) -> Rational {
    let (a, b) = (exact(lo), exact(hi));
    let part = |k: i64| &a + (&b - &a) * ratio(k, 4);
    if lo >= 0.0 { simplest(&part(1), &part(3)) } else { part(2) }
}

fn exact(x: f64) -> Rational {
    from_f64_exact(x).expect("a finite end of a range")
}
