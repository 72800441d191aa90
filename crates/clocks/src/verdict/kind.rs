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
//! use kickdrift_clocks::number::Sign::*;
//! use kickdrift_clocks::verdict::{HalfSigns, Side, Verdict};
//! let verdict = HalfSigns::new(Positive, Zero, Negative, Positive).verdict();
//! assert_eq!(verdict, Verdict::Parabolic(Side::Plus));
//! assert_eq!((verdict.is_stable(), verdict.to_string().as_str()), (false, "parabolic, Tr Q = 2"));
//! ```

use std::fmt;

use crate::propagator::{HalfSigns, PartialSigns};
use number::Sign::{self, Negative, Positive, Zero};
use number::named;

named! {
    /// How the powers of Q behave: a [`Verdict`] without its side, which many clocks do not have.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
    #[derive(serde::Serialize, serde::Deserialize)]
    pub enum Kind {
        /// Powers bounded, no eigenvalue ±1.
        Elliptic = "elliptic",
        /// Exponential growth.
        Hyperbolic = "hyperbolic",
        /// Linear growth: a Jordan block.
        Parabolic = "parabolic",
        /// Powers bounded, an eigenvalue ±1.
        Coexistence = "coexistence",
    }
}

impl Kind {
    /// Whether the powers of Q are bounded (theorem `bounded_iff` in proofs/).
    pub fn is_stable(self) -> bool {
        matches!(self, Kind::Elliptic | Kind::Coexistence)
    }
}

/// On which side of the stable band −2 < Tr Q < 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub enum Side {
    /// Tr Q ≥ 2.
    Plus,
    /// Tr Q ≤ −2.
    Minus,
}

/// The answer to "is this pair stable?": the rows of the table above, as `kind` in proofs/Vocabulary.v.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub enum Verdict {
    /// |Tr Q| < 2: powers bounded.
    Elliptic,
    /// |Tr Q| > 2: exponential growth.
    Hyperbolic(Side),
    /// |Tr Q| = 2, Q ≠ ±I: a Jordan block, linear growth.
    Parabolic(Side),
    /// Q = ±I: powers bounded; a tongue is closed here.
    Coexistence(Side),
}

impl Verdict {
    /// The seven verdicts, the rows of the table above: tables of many verdicts store indices into this one.
    pub const ALL: [Verdict; 7] = [
        Verdict::Elliptic,
        Verdict::Hyperbolic(Side::Plus),
        Verdict::Hyperbolic(Side::Minus),
        Verdict::Parabolic(Side::Plus),
        Verdict::Parabolic(Side::Minus),
        Verdict::Coexistence(Side::Plus),
        Verdict::Coexistence(Side::Minus),
    ];

    /// The position in [`Verdict::ALL`].
    pub fn index(self) -> u8 {
        match self {
            Verdict::Elliptic => 0,
            Verdict::Hyperbolic(side) => 1 + side as u8,
            Verdict::Parabolic(side) => 3 + side as u8,
            Verdict::Coexistence(side) => 5 + side as u8,
        }
    }

    /// The verdict without its side.
    pub fn kind(self) -> Kind {
        match self {
            Verdict::Elliptic => Kind::Elliptic,
            Verdict::Hyperbolic(_) => Kind::Hyperbolic,
            Verdict::Parabolic(_) => Kind::Parabolic,
            Verdict::Coexistence(_) => Kind::Coexistence,
        }
    }

    /// 1 for Tr Q ≥ 2, −1 for Tr Q ≤ −2, else 0.
    pub fn side(self) -> i8 {
        match self {
            Verdict::Elliptic => 0,
            Verdict::Hyperbolic(side) | Verdict::Parabolic(side) | Verdict::Coexistence(side) => side.sign(),
        }
    }

    /// See [`Kind::is_stable`].
    pub fn is_stable(self) -> bool {
        self.kind().is_stable()
    }
}

impl Side {
    /// The side of the tongue m: a solution that makes m half turns a period returns with the sign (−1)^m.
    pub fn of_half_turns(m: u64) -> Side {
        if m.is_multiple_of(2) { Side::Plus } else { Side::Minus }
    }

    /// 1 or −1: the sign of Tr Q.
    pub fn sign(self) -> i8 {
        if self == Side::Plus { 1 } else { -1 }
    }
}

impl fmt::Display for Verdict {
    /// The kind and what it says of Q: `hyperbolic, Tr Q < -2`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let minus = if self.side() < 0 { "-" } else { "" };
        match self {
            Verdict::Elliptic => f.write_str("elliptic, |Tr Q| < 2"),
            Verdict::Hyperbolic(Side::Plus) => f.write_str("hyperbolic, Tr Q > 2"),
            Verdict::Hyperbolic(Side::Minus) => f.write_str("hyperbolic, Tr Q < -2"),
            Verdict::Parabolic(_) => write!(f, "parabolic, Tr Q = {minus}2"),
            Verdict::Coexistence(_) => write!(f, "coexistence, Q = {minus}I"),
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl HalfSigns {
    /// The table above.
    pub fn verdict(self) -> Verdict {
        let [a, b, c, d] = self.all();
        match (b * c, a * d) {
            (Positive, _) => Verdict::Hyperbolic(Side::Plus),
            (_, Negative) => Verdict::Hyperbolic(Side::Minus),
            (Negative, Positive) => Verdict::Elliptic,
            (Zero, _) if b == c => Verdict::Coexistence(Side::Plus),
            (Zero, _) => Verdict::Parabolic(Side::Plus),
            (_, Zero) if a == d => Verdict::Coexistence(Side::Minus),
            (_, Zero) => Verdict::Parabolic(Side::Minus),
        }
    }
}

impl PartialSigns {
    /// The verdict, where the known signs already imply it: BC > 0 or AD < 0 settle it alone.
    pub fn verdict(self) -> Option<Verdict> {
        let product = |x: Option<Sign>, y: Option<Sign>| Some(x? * y?);
        match (product(self.b, self.c), product(self.a, self.d)) {
            (Some(Positive), _) => Some(Verdict::Hyperbolic(Side::Plus)),
            (_, Some(Negative)) => Some(Verdict::Hyperbolic(Side::Minus)),
            _ => self.complete().map(HalfSigns::verdict),
        }
    }
}
