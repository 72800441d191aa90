//! The grid of all step pairs (i D1, j D2) in a window.

use num_bigint::BigInt;
use num_traits::{One, Signed, ToPrimitive};

use super::document;
use crate::error::{Error, Result};
use crate::number::parse::{parse, parse_range};
use crate::number::{ExactSign, Laurent, Rational, Real, Ring, Sign};

/// All pairs (i D1, j D2) with h1 and h2 in closed ranges: i and j run over ranges of positive integers.
#[derive(Clone, Debug, PartialEq)]
pub struct GridRange {
    step1: Laurent,
    step2: Laurent,
    h1: (Laurent, Laurent),
    h2: (Laurent, Laurent),
    columns: (u64, u64),
    rows: (u64, u64),
}

impl GridRange {
    /// From the texts of a scene.
    pub(super) fn new(grid: &document::Grid) -> Result<Self> {
        let step = |field, own: &Option<String>| match own.as_ref().or(grid.step.as_ref()) {
            Some(text) => parse(field, text),
            None => Err(Error::input(
                field,
                "missing",
                "give the spacing as \"step\", or as \"step1\" and \"step2\"",
            )),
        };
        let (step1, step2) = (step("grid.step1", &grid.step1)?, step("grid.step2", &grid.step2)?);
        GridRange::from_quantities(
            step1,
            step2,
            parse_range("grid.h1", &grid.h1)?,
            parse_range("grid.h2", &grid.h2)?,
        )
    }

    /// All positive multiples of `step1` in the closed range `h1`, and of `step2` in `h2`.
    ///
    /// # Errors
    /// A step that is not positive, steps without a rational ratio, a range that holds no multiple, more than
    /// 2^32 multiples of either step.
    pub fn from_quantities(
        step1: Laurent,
        step2: Laurent,
        h1: (Laurent, Laurent),
        h2: (Laurent, Laurent),
    ) -> Result<Self> {
        if Laurent::ratio(&step2, &step1).is_none() && step1.sign() == Sign::Positive {
            let remedy = "the ratio of the two spacings is irrational, so no pair of steps ever meets again";
            return Err(Error::input("grid", format!("{step2} to {step1}"), remedy));
        }
        let (columns, rows) = (multiples("h1", &step1, &h1)?, multiples("h2", &step2, &h2)?);
        Ok(GridRange { step1, step2, h1, h2, columns, rows })
    }

    /// The first and last i of h1 = i D1.
    pub fn columns(&self) -> (u64, u64) {
        self.columns
    }

    /// The first and last j of h2 = j D2.
    pub fn rows(&self) -> (u64, u64) {
        self.rows
    }

    /// The number of pairs.
    pub fn len(&self) -> u64 {
        let count = |(first, last): (u64, u64)| last - first + 1;
        count(self.columns) * count(self.rows)
    }

    /// Never: a grid holds at least one pair.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// h1 = i D1.
    pub fn h1(&self, i: u64) -> Laurent {
        times(&self.step1, i)
    }

    /// h2 = j D2.
    pub fn h2(&self, j: u64) -> Laurent {
        times(&self.step2, j)
    }

    /// The spacings D1 and D2.
    pub fn steps(&self) -> (&Laurent, &Laurent) {
        (&self.step1, &self.step2)
    }

    /// The ranges of h1 and h2 as they were given.
    pub fn ranges(&self) -> [&(Laurent, Laurent); 2] {
        [&self.h1, &self.h2]
    }
}

fn times(step: &Laurent, n: u64) -> Laurent {
    Laurent::product(step, &Laurent::from_rational(Rational::from_integer(n.into())))
}

/// The first and last positive n with lo ≤ n step ≤ hi.
fn multiples(field: &str, step: &Laurent, (lo, hi): &(Laurent, Laurent)) -> Result<(u64, u64)> {
    if step.sign() != Sign::Positive {
        return Err(Error::input(&format!("step of {field}"), step, "the spacing must be positive"));
    }
    let last = floor_quotient(hi, step);
    let below = floor_quotient(lo, step);
    let exact = times_signed(step, &below) == *lo;
    let first = if exact { below } else { below + 1 }.max(One::one());
    let bounds = (first.to_u64(), last.to_u64());
    match bounds {
        (Some(first), Some(last)) if first <= last && last - first < 1 << 32 => Ok((first, last)),
        (Some(first), Some(last)) if first <= last => {
            Err(Error::input(field, format!("{lo}..{hi}"), "holds more than 2^32 multiples of the step"))
        }
        _ => Err(Error::input(field, format!("{lo}..{hi}"), format!("holds no positive multiple of {step}"))),
    }
}

fn times_signed(step: &Laurent, n: &BigInt) -> Laurent {
    Laurent::product(step, &Laurent::from_rational(Rational::from_integer(n.clone())))
}

/// ⌊x/step⌋, exactly: from an enclosure, mended by exact comparisons.
fn floor_quotient(x: &Laurent, step: &Laurent) -> BigInt {
    let bits = 128;
    let quotient = x.enclosure(bits).div(&step.enclosure(bits), bits).expect("step > 0");
    let mut n = quotient.mid_scaled(0).0;
    let beyond = |n: &BigInt| {
        let mut difference = times_signed(step, n);
        difference -= x.clone();
        difference.sign() == Sign::Positive
    };
    while beyond(&n) {
        n -= 1;
    }
    while !beyond(&(&n + 1)) {
        n += 1;
    }
    debug_assert!(!n.is_negative() || x.sign() == Sign::Negative);
    n
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(step: &str, h1: &str, h2: &str) -> Result<GridRange> {
        let grid = document::Grid {
            step: Some(step.into()),
            step1: None,
            step2: None,
            h1: h1.into(),
            h2: h2.into(),
        };
        GridRange::new(&grid)
    }

    #[test]
    fn closed_ranges_hold_their_ends() {
        let grid = grid("1/10", "1/10..1/2", "0.15..0.3").unwrap();
        assert_eq!((grid.columns(), grid.rows()), ((1, 5), (2, 3)));
        assert_eq!(grid.len(), 10);
    }

    #[test]
    fn irrational_ends_are_compared_exactly() {
        // 2/pi = 0.63661977...
        assert_eq!(grid("1/100", "1/100..2/pi", "1..1").unwrap().columns(), (1, 63));
        // Multiples of pi/10 up to exactly 3 pi.
        let range = |lo: &str, hi: &str| parse_range("h", &format!("{lo}..{hi}")).unwrap();
        let step = || parse("step", "pi/10").unwrap();
        let grid =
            GridRange::from_quantities(step(), step(), range("pi/10", "3*pi"), range("1", "2")).unwrap();
        assert_eq!((grid.columns(), grid.rows()), ((1, 30), (4, 6)));
    }

    #[test]
    fn bad_grids_are_refused() {
        for (step, h1, h2) in [
            ("0", "1..2", "1..2"),
            ("-1", "1..2", "1..2"),
            ("1", "0.1..0.2", "1..2"),
            ("1e-30", "1..2", "1..2"),
            ("1", "2..1", "1..2"),
        ] {
            assert!(grid(step, h1, h2).is_err(), "{step} {h1} {h2}");
        }
        let one = || (parse("h", "1").unwrap(), parse("h", "9").unwrap());
        let steps = |text| parse("step", text).unwrap();
        assert!(GridRange::from_quantities(steps("1"), steps("pi"), one(), one()).is_err());
    }
}
