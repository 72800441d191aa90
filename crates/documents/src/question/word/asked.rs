//! What is asked about a word, and that it makes sense.

use crate::question::asking::question;
use crate::question::field::flag;
use crate::question::field::{StepRange, notation};
use num_traits::Zero;
use number::{Error, ExactSign, Laurent, Rational, Result, Ring, Sign};
use words::method;

notation! {
    words::Word: |_: &str, text: &str| text.parse(), ToString::to_string;
}

question! {
    /// Consistency, symmetry, order, stable steps, cost of an integrator; its verdict at one step.
    #[derive(Default)]
    args struct Word {
        /// The integrator: kicks K, K1, K2, drifts D, midpoints C, exact flows R, friction O, F, I,
        /// n*(...), as "K(1/2) D(1) K(1/2)".
        #[arg(value_name = "WORD", value_parser = flag::<words::Word>)]
        word: Option<words::Word>,
        /// One of the catalogue, which --list shows.
        #[arg(long, value_name = "NAME", conflicts_with = "word")]
        method: Option<String>,
        /// The stiffness of K1, or of K where the word names no forces.
        lambda1 as "X": Option<Laurent>,
        /// The stiffness of K2; a rational multiple of lambda1.
        lambda2 as "Y": Option<Laurent>,
        /// The step of the whole word: the verdict there.
        h as "H": Option<Laurent>,
        /// Only intervals that meet this closed range of steps.
        h_range as "LO..HI": Option<StepRange>,
        /// The friction of letters O, F and I, in 1/time; without it they do nothing.
        friction as "G": Option<Laurent>,
    }
}

impl Word {
    /// Whether balls answer: the product of the letters is no polynomial.
    pub(super) fn is_enclosed(&self, word: &words::Word) -> bool {
        !word.is_algebraic() || self.friction.is_some()
    }

    /// Refuses friction without a letter that feels it, and a second force of flows or filters that is 0.
    pub(super) fn check(&self, word: &words::Word) -> Result<()> {
        if let Some(friction) = &self.friction {
            if friction.sign() != Sign::Positive {
                return Err(Error::input(
                    "friction",
                    friction,
                    "the friction must be positive; or leave it out",
                ));
            }
            if !word.has_friction() {
                return Err(Error::input(
                    "friction",
                    friction,
                    "the word has no letter O, F or I, so nothing feels it",
                ));
            }
            if self.lambda1.is_none() {
                return Err(Error::missing("lambda1", "friction needs a scale of time: give the stiffness"));
            }
        }
        match &self.lambda2 {
            Some(lambda2) if !word.is_algebraic() && lambda2.sign() == Sign::Zero => {
                Err(Error::input("lambda2", lambda2, "give a stiffness that is not 0"))
            }
            _ => Ok(()),
        }
    }

    /// The word that is asked about.
    ///
    /// # Errors
    /// None or two of a word and a method.
    pub fn word(&self) -> Result<words::Word> {
        match (&self.word, &self.method) {
            (Some(word), None) => Ok(word.clone()),
            (None, Some(name)) => Ok(method(name)?.word()),
            (None, None) => Err(Error::missing(
                "word",
                "write a word such as \"K(1/2) D(1) K(1/2)\", or --method NAME; --list shows names",
            )),
            (Some(word), Some(_)) => Err(Error::input("word", word, "give a word or a method, not both")),
        }
    }

    /// Λ2/Λ1, where the word's forces are known.
    pub(super) fn ratio(&self, word: &words::Word) -> Result<Option<Rational>> {
        if let Some(lambda1) = self.lambda1.as_ref().filter(|lambda1| lambda1.sign() != Sign::Positive) {
            return Err(Error::input("lambda1", lambda1, "the stiffness must be positive"));
        }
        match (&self.lambda1, &self.lambda2, word.names_forces()) {
            (_, Some(lambda2), false) => Err(Error::input(
                "lambda2",
                lambda2,
                "the word names no second force: write K1 and K2, or leave it out",
            )),
            (_, None, false) => Ok(Some(Rational::zero())),
            (Some(lambda1), Some(lambda2), true) => match Laurent::ratio(lambda2, lambda1) {
                Some(rho) => Ok(Some(rho)),
                None => Err(Error::input(
                    "lambda2",
                    lambda2,
                    "choose a rational multiple of lambda1: the word's entries are polynomials over Q then",
                )),
            },
            (None, None, true) => Ok(None),
            (None, ..) => Err(Error::missing("lambda1", "the word names two forces: give both stiffnesses")),
            (_, None, _) => {
                Err(Error::missing("lambda2", "the word names two forces: give both stiffnesses"))
            }
        }
    }

    /// h² Λ1, for a step that is given.
    pub(super) fn s(&self, h: &Laurent, field: &str) -> Result<Laurent> {
        let lambda1 = self
            .lambda1
            .as_ref()
            .ok_or_else(|| Error::missing("lambda1", "a step needs the stiffness: add --lambda1"))?;
        if h.sign() != Sign::Positive {
            return Err(Error::input(field, h, "a step must be positive"));
        }
        Ok(Laurent::product(&Laurent::product(h, h), lambda1))
    }
}
