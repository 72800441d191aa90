//! A window of the plane: places in it as fractions of its width and height, right at any depth.

use num_traits::ToPrimitive;

use documents::question::StepRange;
use number::{Laurent, Rational, rational};

/// A window with rational ends; irrational ones are taken as the doubles nearest to them.
pub(super) struct Frame {
    /// The low end and the width of h1 and of h2.
    sides: [(Rational, Rational); 2],
}

impl Frame {
    pub fn new(window: &[StepRange; 2]) -> Frame {
        let end = |x: &Laurent| {
            x.as_rational().or_else(|| rational::from_f64_exact(x.to_f64())).expect("an end is finite")
        };
        Frame {
            sides: window.each_ref().map(|(lo, hi)| {
                let lo = end(lo);
                (lo.clone(), end(hi) - lo)
            }),
        }
    }

    /// Where h1 (0) or h2 (1) lies: 0 at the low end, 1 at the high one.
    pub fn fraction(&self, side: usize, h: &Rational) -> f64 {
        let (lo, width) = &self.sides[side];
        rational::to_f64(&((h - lo) / width))
    }

    /// h1 or h2 at a fraction.
    pub fn at(&self, side: usize, fraction: &Rational) -> Rational {
        let (lo, width) = &self.sides[side];
        lo + width * fraction
    }

    /// The window with half of itself on each side, no step below 0.
    pub fn around(&self) -> [(Rational, Rational); 2] {
        let half = rational::ratio(1, 2);
        [0, 1].map(|side| {
            let zero = Rational::default();
            (self.at(side, &-&half).max(zero), self.at(side, &(&half * Rational::from_integer(3.into()))))
        })
    }

    /// Digits before the window's own: −log10 of its width over the largest step in it.
    pub fn depth(&self) -> u32 {
        let digits = self.sides.iter().map(|(lo, width)| {
            let share = width / (lo + width);
            // Doubles would underflow beyond some 300 digits.
            let bits = share.denom().bits() as f64 - share.numer().bits() as f64;
            (bits * std::f64::consts::LOG10_2).max(0.0).ceil().to_u32().unwrap_or(u32::MAX)
        });
        digits.max().unwrap_or(0)
    }

    /// The least and the largest h2/h1 in the window, its halves beside it left out; `None` for the largest
    /// where h1 reaches 0.
    pub fn ratios(&self) -> (Rational, Option<Rational>) {
        let [(a, b), (c, d)] = [0, 1].map(|side| {
            let end = |n: i64| self.at(side, &Rational::from_integer(n.into())).max(Rational::default());
            (end(0), end(1))
        });
        (c / &b, (a > Rational::default()).then(|| d / a))
    }
}
