//! Is this pair of steps stable?

use super::asking::{Question, Work, question};
use crate::error::{Error, Result};
use crate::number::{Laurent, Rational};
use crate::propagator::Oscillator;
use crate::report::document::Document;
use crate::report::verdict::Answer;
use crate::verdict::{Tier, decide_from};

question! {
    /// One pair of steps of one oscillator.
    struct Verdict {
        /// The stiffness of the fast force, 1/time².
        lambda1: Laurent,
        /// That of the slow force.
        lambda2: Laurent,
        /// The fast step.
        h1: Laurent,
        /// The slow step; h2/h1 is rational.
        h2: Laurent,
        /// A rate of friction per unit time: is it enough?
        friction: Option<Rational>,
        /// Decided in exact arithmetic alone, the exact trace shown where it is rational.
        exact: bool,
    }
}

/// Seconds a kick of friction.
#[cfg(feature = "system")]
const DAMPED_KICK: f64 = 1e-6;

impl Verdict {
    /// The question about an oscillator with its steps.
    pub fn of(oscillator: &Oscillator) -> Verdict {
        let own = [oscillator.lambda1(), oscillator.lambda2(), oscillator.h1(), oscillator.h2()];
        let [lambda1, lambda2, h1, h2] = own.map(Clone::clone);
        Verdict { lambda1, lambda2, h1, h2, friction: None, exact: false }
    }

    /// The oscillator with its steps.
    ///
    /// # Errors
    /// As [`Oscillator::new`].
    pub fn oscillator(&self) -> Result<Oscillator> {
        let Verdict { lambda1, lambda2, h1, h2, .. } = self.clone();
        Oscillator::new(lambda1, lambda2, h1, h2)
    }

    /// The tier at which the decision begins.
    pub fn first_tier(&self) -> Tier {
        if self.exact { Tier::Exact } else { Tier::Filter }
    }

    #[cfg(feature = "system")]
    fn damped(
        &self,
        oscillator: &Oscillator,
        work: &Work,
    ) -> Result<Option<crate::system::friction::Friction>> {
        let Some(rate) = &self.friction else { return Ok(None) };
        if *rate <= Rational::default() {
            return Err(Error::input("friction", rate, "a rate of friction must be positive"));
        }
        let kicks = oscillator.ratio().kicks();
        work.announce(&format!("friction over {kicks} kicks"), kicks as f64 * DAMPED_KICK);
        crate::system::friction::damped_pair(oscillator, rate, &work.limits()).map(Some)
    }
}

impl Question for Verdict {
    const NAME: &'static str = "verdict";
    type Answer = Answer;

    fn answer(&self, work: &Work) -> Result<Answer> {
        let oscillator = self.oscillator()?;
        let clocks = oscillator.clocks();
        let decided = decide_from(self.first_tier(), &clocks, &work.limits())?;
        #[cfg(not(feature = "system"))]
        if let Some(rate) = &self.friction {
            return Err(Error::input("friction", rate, "is not built in: build with the feature system"));
        }
        Ok(Answer {
            decision: decided.decision(),
            growth: decided.growth()?.clone(),
            exact_trace: Answer::exact_trace(&clocks, self.exact),
            #[cfg(feature = "system")]
            friction: self.damped(&oscillator, work)?,
            oscillator,
        })
    }

    fn show(&self, answer: &Answer) -> Document {
        answer.document()
    }
}
