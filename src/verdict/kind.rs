//! Four signs → verdict: one pure function.
//!
//! | signs of the half period | kind | Tr Q | stable |
//! |---|---|---|---|
//! | BC > 0 | hyperbolic | > 2 | no, exponential growth |
//! | AD < 0 | hyperbolic | < −2 | no, exponential growth |
//! | BC < 0 < AD | elliptic | in (−2, 2) | yes |
//! | B = 0 or C = 0, not both | parabolic | 2 | no, linear growth |
//! | A = 0 or D = 0, not both | parabolic | −2 | no, linear growth |
//! | B = C = 0 | coexistence, Q = I | 2 | yes |
//! | A = D = 0 | coexistence, Q = −I | −2 | yes |
//!
//! (theorem `four_signs` in proofs/). Since AD − BC = 1, either product's sign is enough where it
//! already says "hyperbolic".
//!
//! ```
//! use kickdrift::number::Sign::*;
//! use kickdrift::verdict::{HalfSigns, Kind};
//! let verdict = HalfSigns::new(Positive, Zero, Negative, Positive).verdict();
//! assert_eq!((verdict.kind(), verdict.side()), (Kind::Parabolic, 1));
//! assert!(!verdict.is_stable());
//! ```

use crate::number::Sign::{self, Negative, Positive, Zero};
use crate::propagator::{HalfSigns, PartialSigns};

/// What the powers of Q do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// |Tr Q| < 2: powers bounded.
    Elliptic,
    /// |Tr Q| > 2: exponential growth.
    Hyperbolic,
    /// |Tr Q| = 2, Q ≠ ±I: a Jordan block, linear growth.
    Parabolic,
    /// Q = ±I: powers bounded; a tongue is closed here.
    Coexistence,
}

impl Kind {
    /// The kind's name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Elliptic => "elliptic",
            Kind::Hyperbolic => "hyperbolic",
            Kind::Parabolic => "parabolic",
            Kind::Coexistence => "coexistence",
        }
    }
}

/// The answer to "is this pair stable?".
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Verdict {
    kind: Kind,
    side: i8,
}

const fn verdict(kind: Kind, side: i8) -> Verdict {
    Verdict { kind, side }
}

impl Verdict {
    /// The seven verdicts, the rows of the table above: tables of many verdicts store indices into this one.
    pub const ALL: [Verdict; 7] = [
        verdict(Kind::Elliptic, 0),
        verdict(Kind::Hyperbolic, 1),
        verdict(Kind::Hyperbolic, -1),
        verdict(Kind::Parabolic, 1),
        verdict(Kind::Parabolic, -1),
        verdict(Kind::Coexistence, 1),
        verdict(Kind::Coexistence, -1),
    ];

    /// The position in [`Verdict::ALL`].
    pub fn index(self) -> u8 {
        let minus = u8::from(self.side < 0);
        match self.kind {
            Kind::Elliptic => 0,
            Kind::Hyperbolic => 1 + minus,
            Kind::Parabolic => 3 + minus,
            Kind::Coexistence => 5 + minus,
        }
    }

    /// What the powers of Q do.
    pub fn kind(self) -> Kind {
        self.kind
    }

    /// 1 for Tr Q ≥ 2, −1 for Tr Q ≤ −2, else 0.
    pub fn side(self) -> i8 {
        self.side
    }

    /// Whether the powers of Q are bounded (theorem `bounded_iff` in proofs/).
    pub fn is_stable(self) -> bool {
        matches!(self.kind, Kind::Elliptic | Kind::Coexistence)
    }
}

impl HalfSigns {
    /// The table above.
    pub fn verdict(self) -> Verdict {
        let [a, b, c, d] = self.all();
        let (kind, side) = match (b * c, a * d) {
            (Positive, _) => (Kind::Hyperbolic, 1),
            (_, Negative) => (Kind::Hyperbolic, -1),
            (Negative, Positive) => (Kind::Elliptic, 0),
            (Zero, _) if b == c => (Kind::Coexistence, 1),
            (Zero, _) => (Kind::Parabolic, 1),
            (_, Zero) if a == d => (Kind::Coexistence, -1),
            (_, Zero) => (Kind::Parabolic, -1),
        };
        Verdict { kind, side }
    }
}

impl PartialSigns {
    /// The verdict, where the known signs already imply it: BC > 0 or AD < 0 settle it alone.
    pub fn verdict(self) -> Option<Verdict> {
        let product = |x: Option<Sign>, y: Option<Sign>| Some(x? * y?);
        match (product(self.b, self.c), product(self.a, self.d)) {
            (Some(Positive), _) => Some(Verdict { kind: Kind::Hyperbolic, side: 1 }),
            (_, Some(Negative)) => Some(Verdict { kind: Kind::Hyperbolic, side: -1 }),
            _ => self.complete().map(HalfSigns::verdict),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Sign; 3] = [Negative, Zero, Positive];

    fn every_quadruple() -> impl Iterator<Item = [Sign; 4]> {
        (0..81).map(|i| [ALL[i % 3], ALL[i / 3 % 3], ALL[i / 9 % 3], ALL[i / 27]])
    }

    /// Whether some real matrix with AD − BC = 1 has these signs: entries of size 1/2, 1, 2 suffice to try
    /// AD − BC > 0, and scaling a row gives 1.
    fn realizable([a, b, c, d]: [Sign; 4]) -> bool {
        let sizes = [0.5, 1.0, 2.0];
        let value = |sign: Sign, size: f64| sign.to_i8() as f64 * size;
        sizes
            .iter()
            .any(|x| sizes.iter().any(|y| value(a, *x) * value(d, 1.0) - value(b, *y) * value(c, 1.0) > 0.0))
    }

    #[test]
    fn all_seven_rows_are_reached_and_agree_with_the_trace() {
        let mut rows = std::collections::HashSet::new();
        for signs in every_quadruple().filter(|&s| realizable(s)) {
            let [a, b, c, d] = signs;
            let verdict = HalfSigns::new(a, b, c, d).verdict();
            // Tr - 2 = 4 BC and Tr + 2 = 4 AD, by sign.
            let side = if (b * c) != Negative {
                1
            } else if (a * d) != Positive {
                -1
            } else {
                0
            };
            assert_eq!(verdict.side(), side, "{signs:?}");
            let identity = (b == Zero && c == Zero) || (a == Zero && d == Zero);
            let on_edge = b * c == Zero || a * d == Zero;
            assert_eq!(verdict.is_stable(), side == 0 || identity, "{signs:?}");
            assert_eq!(matches!(verdict.kind(), Kind::Parabolic | Kind::Coexistence), on_edge, "{signs:?}");
            rows.insert((verdict.kind(), verdict.side()));
        }
        assert_eq!(rows.len(), 7);
    }

    #[test]
    fn every_verdict_is_where_its_index_says() {
        assert!(Verdict::ALL.iter().zip(0..).all(|(verdict, index)| verdict.index() == index));
    }

    #[test]
    fn impossible_signs_are_refused() {
        for [a, b, c, d] in every_quadruple() {
            let refused = std::panic::catch_unwind(|| HalfSigns::new(a, b, c, d)).is_err();
            assert_eq!(refused, !realizable([a, b, c, d]));
        }
    }

    #[test]
    fn partial_signs_never_say_more_than_every_completion_says() {
        for [a, b, c, d] in every_quadruple().filter(|&s| realizable(s)) {
            let truth = HalfSigns::new(a, b, c, d).verdict();
            for known in 0..16 {
                let keep = |bit: u8, sign| (known >> bit & 1 == 1).then_some(sign);
                let partial = PartialSigns { a: keep(0, a), b: keep(1, b), c: keep(2, c), d: keep(3, d) };
                assert!(partial.verdict().is_none_or(|verdict| verdict == truth));
            }
        }
    }
}
