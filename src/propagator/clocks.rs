//! Two clocks on one oscillator: in physical quantities, and without dimension.
//!
//! ```
//! use kickdrift::number::parse::parse;
//! use kickdrift::propagator::Oscillator;
//! let x = |text| parse("x", text).unwrap();
//! let oscillator = Oscillator::new(x("pi^2"), x("pi^2/25"), x("0.4"), x("1")).unwrap();
//! let clocks = oscillator.clocks();
//! assert_eq!((clocks.p(), clocks.q()), (5, 2));
//! assert_eq!(clocks.fast().to_string(), "4*pi^2/25"); // s = h1² L1
//! assert_eq!(clocks.slow().to_string(), "2*pi^2/125"); // h1 h2 L2
//! ```

use num_integer::Integer;
use num_traits::ToPrimitive;

use crate::error::{Error, Result};
use crate::number::{ExactSign, Laurent, Rational, Ring, Sign};

/// x'' + (L1 + L2) x = 0 with the force of L1 at the multiples of h1 and that of L2 at those of h2:
/// the paper's section 3, its Lambda_1, Lambda_2. Unit mass; L in 1/time², h in time.
#[derive(Clone, Debug, PartialEq)]
pub struct Oscillator {
    lambda1: Laurent,
    lambda2: Laurent,
    h1: Laurent,
    h2: Laurent,
    p: u64,
    q: u64,
}

/// The same without dimension, all that a verdict depends on: with h1 as the unit of time a fast kick
/// has strength s = h1² L1, a slow one h1 h2 L2, and h2/h1 = p/q in lowest terms.
#[derive(Clone, Debug, PartialEq)]
pub struct TwoClocks<S> {
    p: u64,
    q: u64,
    fast: S,
    slow: S,
}

impl Oscillator {
    /// Checks what the theory asks for: L1 > 0, h1 > 0, h2 > 0, and h2/h1 rational (otherwise the
    /// clocks never meet again and there is no propagator over a period). L2 may have any sign.
    ///
    /// # Errors
    /// Names the quantity that is out of range; a budget error where p or q reaches 2^62.
    pub fn new(lambda1: Laurent, lambda2: Laurent, h1: Laurent, h2: Laurent) -> Result<Self> {
        positive("lambda1", &lambda1, "the fast stiffness must be positive")?;
        positive("h1", &h1, "a step must be positive")?;
        positive("h2", &h2, "a step must be positive")?;
        let irrational = || {
            let remedy =
                "the ratio is irrational, so the clocks never meet again; choose commensurable steps";
            Error::input("h2/h1", format!("({h2})/({h1})"), remedy)
        };
        let ratio = Laurent::ratio(&h2, &h1).ok_or_else(irrational)?;
        let (p, q) = terms(&ratio)?;
        Ok(Oscillator { lambda1, lambda2, h1, h2, p, q })
    }

    /// The dimensionless pair.
    pub fn clocks(&self) -> TwoClocks<Laurent> {
        let fast = Laurent::product(&Laurent::product(&self.h1, &self.h1), &self.lambda1);
        let slow = Laurent::product(&Laurent::product(&self.h1, &self.h2), &self.lambda2);
        TwoClocks { p: self.p, q: self.q, fast, slow }
    }

    /// The fast stiffness L1.
    pub fn lambda1(&self) -> &Laurent {
        &self.lambda1
    }

    /// The slow stiffness L2.
    pub fn lambda2(&self) -> &Laurent {
        &self.lambda2
    }

    /// The fast step h1.
    pub fn h1(&self) -> &Laurent {
        &self.h1
    }

    /// The slow step h2.
    pub fn h2(&self) -> &Laurent {
        &self.h2
    }

    /// T = p h1 = q h2.
    pub fn period(&self) -> Laurent {
        Laurent::product(&self.h1, &Laurent::from_rational(Rational::from_integer(self.p.into())))
    }
}

impl<S: Ring> TwoClocks<S> {
    /// h2/h1 = p/q, s = h1² L1 and h1 h2 L2.
    ///
    /// # Panics
    /// Where p/q is not a positive fraction in lowest terms.
    pub fn new(p: u64, q: u64, fast: S, slow: S) -> Self {
        assert!(p > 0 && q > 0 && p.gcd(&q) == 1, "{p}/{q} is not a positive fraction in lowest terms");
        TwoClocks { p, q, fast, slow }
    }

    /// From s and rho = L2/L1: the slow kick is s rho p/q.
    ///
    /// # Panics
    /// Where p/q is not a positive fraction in lowest terms.
    pub fn with_rho(p: u64, q: u64, s: S, rho: S) -> Self {
        let ratio = S::from_rational(&Rational::new(p.into(), q.into()));
        let slow = S::product(&S::product(&s, &rho), &ratio);
        TwoClocks::new(p, q, s, slow)
    }

    /// The numerator of h2/h1: the number of fast kicks in a period.
    pub fn p(&self) -> u64 {
        self.p
    }

    /// The denominator of h2/h1: the number of slow kicks in a period.
    pub fn q(&self) -> u64 {
        self.q
    }

    /// s = h1² L1, the strength of a fast kick in the time unit h1.
    pub fn fast(&self) -> &S {
        &self.fast
    }

    /// h1 h2 L2, the strength of a slow kick in the time unit h1.
    pub fn slow(&self) -> &S {
        &self.slow
    }

    /// The same system with the clocks' roles exchanged, in the time unit h2: s' = h2² L2 and so on.
    /// No verdict changes (theorem `swap_clocks` in proofs/).
    pub fn swapped(&self) -> Self {
        let ratio = S::from_rational(&Rational::new(self.p.into(), self.q.into()));
        let (fast, slow) = (S::product(&self.slow, &ratio), S::product(&self.fast, &ratio));
        TwoClocks { p: self.q, q: self.p, fast, slow }
    }

    /// The same pair with its strengths in another ring.
    pub fn map<U: Ring>(&self, convert: impl Fn(&S) -> U) -> TwoClocks<U> {
        TwoClocks { p: self.p, q: self.q, fast: convert(&self.fast), slow: convert(&self.slow) }
    }
}

impl TwoClocks<Laurent> {
    /// The pair over the rationals, where both strengths are rational.
    pub fn as_rational(&self) -> Option<TwoClocks<Rational>> {
        let (fast, slow) = (self.fast.as_rational()?.clone(), self.slow.as_rational()?.clone());
        Some(TwoClocks { p: self.p, q: self.q, fast, slow })
    }
}

fn positive(field: &str, x: &Laurent, remedy: &str) -> Result<()> {
    if x.sign() == Sign::Positive { Ok(()) } else { Err(Error::input(field, x, remedy)) }
}

/// p and q of a positive ratio.
fn terms(ratio: &Rational) -> Result<(u64, u64)> {
    let small = |n: &num_bigint::BigInt| n.to_u64().filter(|&n| n < 1 << 62);
    match (small(ratio.numer()), small(ratio.denom())) {
        (Some(p), Some(q)) => Ok((p, q)),
        _ => Err(Error::too_much(
            "h2/h1 = p/q has more than 18 digits in p or q, so one period holds more kicks than any machine composes",
            "choose steps with a simpler ratio",
        )),
    }
}
