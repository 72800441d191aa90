//! The grid: all pairs (i d1, j d2) in a window, exactly.

use crate::propagator::{Oscillator, TwoClocks};
use crate::resonance::compare::{Comparisons, allow};
use crate::verdict::Limits;
use number::error::room;
use number::{Error, ExactSign, Laurent, Ratio, Rational, Result, Ring, Sign};

/// The most columns or rows: their products are then exact in doubles.
const LARGEST_MULTIPLIER: u64 = 1 << 26;

/// Every step h1 = i d1 in a closed range (a *column*) with every step h2 = j d2 in another (a *row*), i,
/// j ≥ 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    lambda1: Laurent,
    lambda2: Laurent,
    step1: Laurent,
    step2: Laurent,
    /// d2/d1 in lowest terms.
    ratio: Ratio,
    columns: (u64, u64),
    rows: (u64, u64),
}

impl Grid {
    /// All positive multiples of `step1` and `step2` in the closed ranges.
    ///
    /// # Errors
    /// Names the quantity: λ1 or a step that is not positive, a range without a multiple of its step or with
    /// 2^26 and more, steps whose ratio is not a rational of two 24-bit integers.
    pub fn new(
        lambda1: Laurent,
        lambda2: Laurent,
        [step1, step2]: [Laurent; 2],
        h1_range: (Laurent, Laurent),
        h2_range: (Laurent, Laurent),
    ) -> Result<Grid> {
        positive("lambda1", &lambda1, "the fast stiffness must be positive")?;
        positive("step1", &step1, "a grid step must be positive")?;
        positive("step2", &step2, "a grid step must be positive")?;
        let columns = multiples("h1-range", &step1, h1_range)?;
        let rows = multiples("h2-range", &step2, h2_range)?;
        let ratio = ratio(&step1, &step2)?;
        Ok(Grid { lambda1, lambda2, step1, step2, ratio, columns, rows })
    }

    /// The multipliers i of the columns: first and last.
    pub fn columns(&self) -> (u64, u64) {
        self.columns
    }

    /// The multipliers j of the rows: first and last.
    pub fn rows(&self) -> (u64, u64) {
        self.rows
    }

    /// The number of columns and of rows.
    pub fn shape(&self) -> (usize, usize) {
        let count = |(first, last): (u64, u64)| (last - first + 1) as usize;
        (count(self.columns), count(self.rows))
    }

    /// The number of pairs.
    pub fn pairs(&self) -> u64 {
        let (columns, rows) = self.shape();
        columns as u64 * rows as u64
    }

    /// h1 = i d1.
    pub fn h1(&self, column: u64) -> Laurent {
        times(&self.step1, column)
    }

    /// h2 = j d2.
    pub fn h2(&self, row: u64) -> Laurent {
        times(&self.step2, row)
    }

    /// λ1, λ2.
    pub fn lambdas(&self) -> (&Laurent, &Laurent) {
        (&self.lambda1, &self.lambda2)
    }

    /// d1, d2.
    pub fn steps(&self) -> (&Laurent, &Laurent) {
        (&self.step1, &self.step2)
    }

    /// d2/d1 in lowest terms.
    pub(super) fn step_ratio(&self) -> (u64, u64) {
        self.ratio.terms()
    }

    /// h2/h1 = p/q at (i, j): both below 2^50.
    pub fn ratio(&self, column: u64, row: u64) -> Ratio {
        Ratio::new(self.ratio.p() * row, self.ratio.q() * column).expect("24 and 26 bits, none 0")
    }

    /// The pair of clocks at (i, j).
    ///
    /// # Errors
    /// A budget error where p or q is too large, which no grid of this size reaches.
    pub fn clocks(&self, column: u64, row: u64) -> Result<TwoClocks<Laurent>> {
        let (lambda1, lambda2) = (self.lambda1.clone(), self.lambda2.clone());
        Oscillator::new(lambda1, lambda2, self.h1(column), self.h2(row))?.clocks()
    }

    /// The trace condition against the resonance predictions at every pair, column by column.
    ///
    /// # Errors
    /// A negative tolerance, and as [`compare`](crate::resonance::compare::compare).
    pub fn compare(&self, tolerance: &Rational, limits: &Limits) -> Result<Comparisons> {
        room((self.shape().0 * size_of::<u64>()) as u128, "a larger step1 or a smaller h1-range")?;
        allow(self.pairs(), self.sampled(), limits)?;
        let columns: Vec<u64> = (self.columns.0..=self.columns.1).collect();
        Comparisons::gather(&columns, tolerance, |&i, found| {
            (self.rows.0..=self.rows.1).try_for_each(|j| {
                let (clocks, place) = (self.clocks(i, j)?, || [self.h1(i), self.h2(j)]);
                found.add(&clocks, place, tolerance, limits)
            })
        })
    }

    /// The grid as one line of exact strings: equal iff the grids are.
    pub fn fingerprint(&self) -> String {
        let Grid { lambda1, lambda2, step1, step2, columns: (i, k), rows: (j, l), .. } = self;
        format!(
            "lambda1 = {lambda1}; lambda2 = {lambda2}; h1 = ({step1})*({i}..{k}); h2 = ({step2})*({j}..{l})"
        )
    }
}

fn times(x: &Laurent, n: u64) -> Laurent {
    Laurent::product(x, &Laurent::from_rational(Rational::from_integer(n.into())))
}

fn positive(field: &str, x: &Laurent, remedy: &str) -> Result<()> {
    if x.sign() == Sign::Positive { Ok(()) } else { Err(Error::input(field, x, remedy)) }
}

/// The first and the last n ≥ 1 with lo ≤ n step ≤ hi.
fn multiples(field: &str, step: &Laurent, (lo, hi): (Laurent, Laurent)) -> Result<(u64, u64)> {
    let range = format!("{lo}..{hi}");
    let too_many = || {
        let count = format!("{field} = {range} holds 2^26 multiples of {step} and more");
        Error::too_much(count, "choose a larger step")
    };
    let last = floor(&hi, step).ok_or_else(too_many)?;
    // The first n with n step ≥ lo is one more than the last with n step < lo.
    let below = if lo.sign() == Sign::Positive { floor(&lo, step).ok_or_else(too_many)? } else { 0 };
    let first = if below > 0 && times(step, below) == lo { below } else { below + 1 };
    if last < first {
        return Err(Error::input(field, range, format!("holds no positive multiple of the step {step}")));
    }
    Ok((first, last))
}

/// ⌊x/step⌋ for step > 0, 0 for x < step; `None` from 2^26 on.
fn floor(x: &Laurent, step: &Laurent) -> Option<u64> {
    let fits = |n: u64| times(step, n) <= *x;
    if fits(LARGEST_MULTIPLIER) {
        return None;
    }
    // Binary digits, from the top: exact comparisons, no quotient.
    Some((0..26).rev().fold(0, |n, bit| if fits(n | 1 << bit) { n | 1 << bit } else { n }))
}

/// step2/step1 in lowest terms.
fn ratio(step1: &Laurent, step2: &Laurent) -> Result<Ratio> {
    let field = "step2/step1";
    let value = || format!("({step2})/({step1})");
    let remedy = "is not rational: no pair's clocks ever meet again; choose commensurable steps";
    let ratio = Laurent::ratio(step2, step1).ok_or_else(|| Error::input(field, value(), remedy))?;
    let small = Ratio::try_from(&ratio).ok().filter(|ratio| ratio.p().max(ratio.q()) < 1 << 24);
    small.ok_or_else(|| {
        Error::input(field, value(), "has more than 24 bits above or below: choose a simpler ratio")
    })
}
