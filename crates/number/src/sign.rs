//! The sign of a real number: zero is a value of its own, never "undecided".

use std::cmp::Ordering;
use std::ops::{Mul, Neg};

/// Negative, zero or positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sign {
    Negative,
    Zero,
    Positive,
}

impl Sign {
    /// The sign of x, given how x compares with 0.
    pub fn from_ordering(ordering: Ordering) -> Self {
        match ordering {
            Ordering::Less => Sign::Negative,
            Ordering::Equal => Sign::Zero,
            Ordering::Greater => Sign::Positive,
        }
    }

    /// −1, 0 or 1.
    pub fn to_i8(self) -> i8 {
        match self {
            Sign::Negative => -1,
            Sign::Zero => 0,
            Sign::Positive => 1,
        }
    }
}

impl Mul for Sign {
    type Output = Sign;

    /// sign(x y) = sign(x) sign(y).
    fn mul(self, other: Sign) -> Sign {
        Sign::from_ordering((self.to_i8() * other.to_i8()).cmp(&0))
    }
}

impl Neg for Sign {
    type Output = Sign;

    fn neg(self) -> Sign {
        Sign::from_ordering(0.cmp(&self.to_i8()))
    }
}
