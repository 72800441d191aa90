//! A double, or two: one kernel for both.

use number::{Twofold, U};

/// A double, or two: what orbits are followed in.
pub trait Digits: Copy {
    /// The relative rounding error of a product. A sum has the same relative error and, beside it, an eighth
    /// of it times the terms.
    const LOSS: f64;
    /// a + b, rounded.
    fn sum(a: f64, b: f64) -> Self;
    /// The nearest double, or one next to it.
    fn double(self) -> f64;
    fn plus(self, other: Self) -> Self;
    fn minus(self, other: Self) -> Self;
    fn times(self, other: Self) -> Self;
    /// The product with a double: exact for a power of two.
    fn scaled(self, b: f64) -> Self;
    /// The quotient by a double.
    fn over(self, b: f64) -> Self;
}

impl Digits for f64 {
    const LOSS: f64 = U;

    fn sum(a: f64, b: f64) -> f64 {
        a + b
    }

    fn double(self) -> f64 {
        self
    }

    fn plus(self, other: f64) -> f64 {
        self + other
    }

    fn minus(self, other: f64) -> f64 {
        self - other
    }

    fn times(self, other: f64) -> f64 {
        self * other
    }

    fn scaled(self, b: f64) -> f64 {
        self * b
    }

    fn over(self, b: f64) -> f64 {
        self / b
    }
}

impl Digits for Twofold {
    const LOSS: f64 = f64::from_bits((1023 - 101) << 52);

    fn sum(a: f64, b: f64) -> Twofold {
        Twofold::sum(a, b)
    }

    fn double(self) -> f64 {
        self.hi
    }

    fn plus(self, other: Twofold) -> Twofold {
        Twofold::plus(self, other)
    }

    fn minus(self, other: Twofold) -> Twofold {
        Twofold::minus(self, other)
    }

    fn times(self, other: Twofold) -> Twofold {
        Twofold::times(self, other)
    }

    fn scaled(self, b: f64) -> Twofold {
        Twofold::scaled(self, b)
    }

    fn over(self, b: f64) -> Twofold {
        Twofold::over(self, b)
    }
}
