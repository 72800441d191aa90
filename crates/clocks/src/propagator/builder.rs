//! An oscillator from what people have: text and exact numbers, each by its name.
//!
//! ```
//! use kickdrift_clocks::number::{Laurent, rational::ratio};
//! use kickdrift_clocks::propagator::Oscillator;
//! let oscillator = Oscillator::builder().lambda1("pi^2").lambda2("pi^2/25").h1("0.4").h2(1).build()?;
//! assert_eq!(oscillator.ratio().to_string(), "5/2");
//! // A double means exactly that double, and has to be asked for.
//! let double = Oscillator::builder().lambda1(1).lambda2(ratio(1, 25)).h1(Laurent::try_from(0.4)?).h2("2/5").build()?;
//! assert_eq!(double.ratio().to_string(), "18014398509481984/18014398509481985");
//! let error = Oscillator::builder().lambda1("pi^2").lambda2(0).h1("0.4").build().unwrap_err();
//! assert_eq!(error.field(), "h2");
//! # Ok::<(), kickdrift_clocks::number::error::Error>(())
//! ```

use super::clocks::Oscillator;
use number::{Error, Laurent, Quantity, Result};

/// An [`Oscillator`] in the making; [`OscillatorBuilder::build`] reports what is wrong or missing.
#[derive(Clone, Debug, Default)]
#[must_use]
pub struct OscillatorBuilder {
    quantities: [Option<Result<Laurent>>; 4],
}

/// In the order of [`Oscillator::new`], with what is missing where one is.
const QUANTITIES: [(&str, &str); 4] = [
    ("lambda1", "give the fast stiffness, such as pi^2"),
    ("lambda2", "give the slow stiffness, such as pi^2/25"),
    ("h1", "give the fast step, such as 1/100"),
    ("h2", "give the slow step, such as 49/50"),
];

impl Oscillator {
    /// An oscillator from text and exact numbers, each by its name.
    pub fn builder() -> OscillatorBuilder {
        OscillatorBuilder::default()
    }
}

impl OscillatorBuilder {
    /// The fast stiffness L1, in 1/time².
    pub fn lambda1(self, lambda1: impl Quantity) -> Self {
        self.with(0, lambda1)
    }

    /// The slow stiffness L2, in 1/time².
    pub fn lambda2(self, lambda2: impl Quantity) -> Self {
        self.with(1, lambda2)
    }

    /// The fast step h1.
    pub fn h1(self, h1: impl Quantity) -> Self {
        self.with(2, h1)
    }

    /// The slow step h2.
    pub fn h2(self, h2: impl Quantity) -> Self {
        self.with(3, h2)
    }

    fn with(mut self, index: usize, quantity: impl Quantity) -> Self {
        self.quantities[index] = Some(quantity.quantity(QUANTITIES[index].0));
        self
    }

    /// The oscillator.
    ///
    /// # Errors
    /// A quantity that is missing or that its text does not denote, and as [`Oscillator::new`].
    pub fn build(self) -> Result<Oscillator> {
        let mut quantities = self.quantities.into_iter().zip(QUANTITIES);
        let mut next = || {
            let (given, (field, remedy)) = quantities.next().expect("four quantities");
            given.unwrap_or_else(|| Err(Error::missing(field, remedy)))
        };
        Oscillator::new(next()?, next()?, next()?, next()?)
    }
}
