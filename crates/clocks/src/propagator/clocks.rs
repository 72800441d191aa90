//! Two clocks on one oscillator: in physical quantities, and without dimension.
//!
//! ```
//! use kickdrift_clocks::number::parse::parse;
//! use kickdrift_clocks::propagator::Oscillator;
//! let x = |text| parse("x", text).unwrap();
//! let oscillator = Oscillator::new(x("pi^2"), x("pi^2/25"), x("0.4"), x("1")).unwrap();
//! let clocks = oscillator.clocks().unwrap();
//! assert_eq!((clocks.p(), clocks.q()), (5, 2));
//! assert_eq!(clocks.fast().to_string(), "4*pi^2/25"); // s = h1² L1
//! assert_eq!(clocks.slow().to_string(), "2*pi^2/125"); // h1 h2 L2
//! ```

use number::{Ball, Error, ExactSign, Laurent, Ratio, Rational, Real, Result, Ring, Sign};

/// x'' + (L1 + L2) x = 0 with the force of L1 at the multiples of h1 and that of L2 at those of h2:
/// the paper's section 3, its Lambda_1, Lambda_2. Unit mass; L in 1/time², h in time.
#[derive(Clone, Debug, PartialEq)]
pub struct Oscillator {
    lambda1: Laurent,
    lambda2: Laurent,
    h1: Laurent,
    h2: Laurent,
    ratio: Rational,
}

/// Two clocks without dimensions, all that a verdict depends on: with h1 as the unit of time a fast kick
/// has strength s = h1² L1, a slow one h1 h2 L2, and h2/h1 = p/q in lowest terms.
#[derive(Clone, Debug, PartialEq)]
pub struct TwoClocks<S> {
    ratio: Ratio,
    fast: S,
    slow: S,
}

impl Oscillator {
    /// Checks what the theory asks for: L1 > 0, h1 > 0, h2 > 0, and h2/h1 rational (otherwise the
    /// clocks never meet again and there is no propagator over a period). L2 may have any sign.
    ///
    /// # Errors
    /// Names the quantity that is out of range.
    pub fn new(lambda1: Laurent, lambda2: Laurent, h1: Laurent, h2: Laurent) -> Result<Self> {
        let ratio = ratio(&lambda1, &h1, &h2)?;
        Ok(Oscillator { lambda1, lambda2, h1, h2, ratio })
    }

    /// The dimensionless pair.
    ///
    /// # Errors
    /// A budget error where p or q reaches 2^62.
    pub fn clocks(&self) -> Result<TwoClocks<Laurent>> {
        let ratio = Ratio::try_from(&self.ratio).map_err(|_| endless())?;
        let LongClocks { fast, slow, .. } = self.long_clocks();
        Ok(TwoClocks { ratio, fast, slow })
    }

    /// As [`Oscillator::clocks`], for a period of any number of kicks.
    pub fn long_clocks(&self) -> LongClocks<Laurent> {
        let [fast, slow] = [(&self.h1, &self.lambda1), (&self.h2, &self.lambda2)]
            .map(|(h, lambda)| Laurent::product(&Laurent::product(&self.h1, h), lambda));
        LongClocks { ratio: self.ratio.clone(), fast, slow }
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

    /// h2/h1 = p/q.
    pub fn ratio(&self) -> &Rational {
        &self.ratio
    }

    /// T = p h1 = q h2.
    pub fn period(&self) -> Laurent {
        let p = Rational::from_integer(self.ratio.numer().clone());
        Laurent::product(&self.h1, &Laurent::from_rational(p))
    }
}

impl<S: Ring> TwoClocks<S> {
    /// h2/h1 = p/q, s = h1² L1 and h1 h2 L2.
    pub fn new(ratio: Ratio, fast: S, slow: S) -> Self {
        TwoClocks { ratio, fast, slow }
    }

    /// From s and rho = L2/L1: the slow kick is s rho p/q.
    pub fn with_rho(ratio: Ratio, s: S, rho: S) -> Self {
        let slow = S::product(&S::product(&s, &rho), &S::from_rational(&ratio.into()));
        TwoClocks { ratio, fast: s, slow }
    }

    /// h2/h1 = p/q.
    pub fn ratio(&self) -> Ratio {
        self.ratio
    }

    /// The numerator of h2/h1: the number of fast kicks in a period.
    pub fn p(&self) -> u64 {
        self.ratio.p()
    }

    /// The denominator of h2/h1: the number of slow kicks in a period.
    pub fn q(&self) -> u64 {
        self.ratio.q()
    }

    /// s = h1² L1, the strength of a fast kick in the time unit h1.
    pub fn fast(&self) -> &S {
        &self.fast
    }

    /// h1 h2 L2, the strength of a slow kick in the time unit h1.
    pub fn slow(&self) -> &S {
        &self.slow
    }

    /// The strengths of the kicks of the fast clock, of the slow one and of both together.
    pub fn strengths(&self) -> [S; 3] {
        let (fast, slow) = (self.fast.clone(), self.slow.clone());
        [fast.clone(), slow.clone(), fast + slow]
    }

    /// Exchanges the roles of the two clocks, in the time unit h2: s' = h2² L2 and so on.
    /// No verdict changes (theorem `swap_clocks` in proofs/).
    pub fn swapped(&self) -> Self {
        let ratio = S::from_rational(&self.ratio.into());
        let (fast, slow) = (S::product(&self.slow, &ratio), S::product(&self.fast, &ratio));
        TwoClocks { ratio: self.ratio.inverse(), fast, slow }
    }

    /// Converts both strengths to another ring.
    pub fn map<U: Ring>(&self, convert: impl Fn(&S) -> U) -> TwoClocks<U> {
        TwoClocks { ratio: self.ratio, fast: convert(&self.fast), slow: convert(&self.slow) }
    }
}

impl<S: Real> TwoClocks<S> {
    /// [`TwoClocks::strengths`] in balls.
    pub fn enclosures(&self, bits: u32) -> [Ball; 3] {
        let (fast, slow) = (self.fast.enclosure(bits), self.slow.enclosure(bits));
        // With opposite signs much may cancel, even everything: only the exact sum shows it.
        let alike = fast.sign().is_some() && fast.sign() == slow.sign();
        let both = if alike {
            fast.add(&slow, bits)
        } else {
            (self.fast.clone() + self.slow.clone()).enclosure(bits)
        };
        [fast, slow, both]
    }
}

/// Two clocks whose period may hold any number of kicks, as that of two steps that are doubles does: 2^100
/// and more.
#[derive(Clone, Debug, PartialEq)]
pub struct LongClocks<S> {
    ratio: Rational,
    fast: S,
    slow: S,
}

impl<S: Ring> LongClocks<S> {
    /// h2/h1.
    pub fn ratio(&self) -> &Rational {
        &self.ratio
    }

    /// s = h1² L1.
    pub fn fast(&self) -> &S {
        &self.fast
    }

    /// h1 h2 L2.
    pub fn slow(&self) -> &S {
        &self.slow
    }

    /// These strengths at another ratio.
    #[cfg(test)]
    pub(crate) fn with_ratio(self, ratio: Rational) -> Self {
        LongClocks { ratio, ..self }
    }

    /// How many binary digits the number of kicks of the clock has that strikes less often.
    pub fn shorter_bits(&self) -> u64 {
        self.ratio.numer().bits().min(self.ratio.denom().bits())
    }

    /// log₂ of the ratio of the steps, in either direction, within 1.
    pub(crate) fn log2_ratio(&self) -> u64 {
        self.ratio.numer().bits().abs_diff(self.ratio.denom().bits())
    }

    /// As [`TwoClocks::swapped`].
    #[must_use]
    pub fn swapped(&self) -> Self {
        let ratio = S::from_rational(&self.ratio);
        let (fast, slow) = (S::product(&self.slow, &ratio), S::product(&self.fast, &ratio));
        LongClocks { ratio: self.ratio.recip(), fast, slow }
    }
}

impl<S: Ring> From<&TwoClocks<S>> for LongClocks<S> {
    fn from(clocks: &TwoClocks<S>) -> Self {
        let TwoClocks { ratio, fast, slow } = clocks.clone();
        LongClocks { ratio: ratio.into(), fast, slow }
    }
}

impl TwoClocks<Laurent> {
    /// The pair over the rationals, where both strengths are rational.
    pub fn as_rational(&self) -> Option<TwoClocks<Rational>> {
        let (fast, slow) = (self.fast.as_rational()?.clone(), self.slow.as_rational()?.clone());
        Some(TwoClocks { ratio: self.ratio, fast, slow })
    }
}

/// h2/h1, where the quantities are in range.
fn ratio(lambda1: &Laurent, h1: &Laurent, h2: &Laurent) -> Result<Rational> {
    positive("lambda1", lambda1, "the fast stiffness must be positive")?;
    positive("h1", h1, "a step must be positive")?;
    positive("h2", h2, "a step must be positive")?;
    Laurent::ratio(h2, h1).ok_or_else(|| {
        let remedy = "the ratio is irrational, so the clocks never meet again; choose commensurable steps";
        Error::input("h2/h1", format!("({h2})/({h1})"), remedy)
    })
}

fn positive(field: &str, x: &Laurent, remedy: &str) -> Result<()> {
    if x.sign() == Sign::Positive { Ok(()) } else { Err(Error::input(field, x, remedy)) }
}

fn endless() -> Error {
    Error::too_much(
        "h2/h1 = p/q has more than 18 digits in p or q, so one period holds more kicks than any machine composes",
        "choose steps with a simpler ratio",
    )
}
