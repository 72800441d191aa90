//! The signs of A, B, C, D, all of them or as far as they are known.

use super::half::HalfPeriod;
use number::ExactSign;
use number::Sign::{self, Negative, Positive};

impl<S: ExactSign> HalfPeriod<S> {
    /// The signs of A, B, C, D, exactly.
    pub fn signs(&self) -> HalfSigns {
        HalfSigns::new(self.a().sign(), self.b().sign(), self.c().sign(), self.d().sign())
    }
}

/// The signs of A, B, C, D; consistent with AD − BC = 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct HalfSigns {
    a: Sign,
    b: Sign,
    c: Sign,
    d: Sign,
}

impl HalfSigns {
    /// # Panics
    /// On signs that no matrix with AD − BC = 1 has: AD ≤ 0 ≤ BC.
    pub fn new(a: Sign, b: Sign, c: Sign, d: Sign) -> Self {
        assert!(
            a * d == Positive || b * c == Negative,
            "signs {a:?} {b:?} {c:?} {d:?} contradict AD - BC = 1"
        );
        HalfSigns { a, b, c, d }
    }

    /// The signs of A, B, C, D.
    pub fn all(self) -> [Sign; 4] {
        [self.a, self.b, self.c, self.d]
    }

    /// The signs of A and C show where the even solution ends; the label of a tongue needs them.
    pub fn even(self) -> (Sign, Sign) {
        (self.a, self.c)
    }
}

/// The four signs as far as they are known: `None` is "undecided", which is not zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PartialSigns {
    pub a: Option<Sign>,
    pub b: Option<Sign>,
    pub c: Option<Sign>,
    pub d: Option<Sign>,
}

impl PartialSigns {
    /// All four signs, where all are known.
    pub fn complete(self) -> Option<HalfSigns> {
        Some(HalfSigns::new(self.a?, self.b?, self.c?, self.d?))
    }
}
