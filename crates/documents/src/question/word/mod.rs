//! An integrator as its author writes it: what can be said of it exactly.

mod asked;
mod catalogue;
mod chart;
mod family;
mod linted;
mod orders;
mod shown;

pub use asked::Word;
pub use catalogue::{Listed, Methods};
pub use family::{Best, Family, Goal, Member, Members, Parameter, Parameters};
pub use linted::{Linted, Span};
pub(super) use orders::{commutators, shown};

use super::asking::{Question, Work};
use crate::report::document::Document;
use crate::report::shape::Schema;
use linted::{BITS, Pieces};
use num_traits::Zero;
use number::{Error, ExactSign, Laurent, Real, Result, Sign};
use shown::record;
use words::{Enclosed, Forces, Stability, at};

/// The most kicks of a word unless a budget says otherwise: roots of polynomials of this degree are isolated
/// in some seconds.
const MOST_KICKS: u64 = 100;

/// So many letters cost as much as one power of the force.
const LETTERS: u64 = 1000;

impl Question for Word {
    const NAME: &'static str = "word";
    const USAGE: Option<&'static str> =
        Some("(WORD | --method <NAME> | --list | --check <FILE>) [--lambda1 <X>] [--lambda2 <Y>] [--h <H>]");
    const EXAMPLES: &'static [&'static str] = &[
        "word \"K(1/6) D(1/2) K(2/3, -1/36) D(1/2) K(1/6)\"",
        "word --method pefrl",
        "word --method respa-4 --lambda1 pi^2 --lambda2 pi^2/25 --h 1 --h-range 0..3",
        "word \"K(b) D(1/2) K(1-2*b) D(1/2) K(b)\" --parameter b=0.15..0.25:1/100 --minimize error",
        "word --method bcss-2 --output word.svg",
        "word --list",
        "word --check data/words/claims.toml",
    ];
    type Answer = Linted;

    fn schema() -> Option<Schema> {
        Some(shown::schema())
    }

    fn answer(&self, work: &Work) -> Result<Linted> {
        self.answer_with(work, |word| (word.order(), word.general_order()))
    }

    fn show(&self, answer: &Linted) -> Document {
        let rows = answer.rows(self.lambda1.as_ref());
        let document = record(self).document(Document::new(Self::NAME), answer);
        let mut columns = vec!["stable", "lower", "upper"];
        columns.extend(self.lambda1.iter().flat_map(|_| ["h_lower", "h_upper"]));
        let people = rows.only(&columns);
        let document = document.rows(rows).for_people(people).summary(&answer.lines(self));
        // Whoever gives a range asks for the intervals in it.
        if self.h_range.is_some() { document } else { document.answer(answer.answer(self)) }
    }

    fn figure(&self, answer: &Linted, _: &Work) -> Result<Option<plot::Figure>> {
        chart::figure(self, answer).map(Some)
    }
}

/// The order on oscillators and those on all problems.
type Orders = (words::Order, std::result::Result<words::GeneralOrder, words::NoGeneralOrder>);

impl Word {
    /// The answer, the word's orders being known or found by this.
    fn answer_with(&self, work: &Work, orders: impl FnOnce(&words::Word) -> Orders) -> Result<Linted> {
        let word = self.word()?;
        affordable(&word, work)?;
        self.check(&word)?;
        let rho = self.ratio(&word)?;
        let range = self.h_range.as_ref().map(|(lo, hi)| {
            let lo = if lo.sign() == Sign::Zero { Ok(Laurent::zero()) } else { self.s(lo, "h-range") };
            Ok::<_, Error>((lo?, self.s(hi, "h-range")?))
        });
        let range =
            range.transpose()?.map(|(lo, hi)| (lo.enclosure(BITS).lower(), hi.enclosure(BITS).upper()));
        let s = self.h.as_ref().map(|h| self.s(h, "h")).transpose()?;
        let (mut stability, mut pieces, mut found) = (None, None, None);
        if rho.is_some() && self.is_enclosed(&word) {
            let lambda2 = self.lambda2.clone().unwrap_or_else(Laurent::zero);
            pieces = Some(Pieces::of(self, &word, &lambda2)?);
            if let (Some(h), Some(lambda1)) = (&self.h, &self.lambda1) {
                let friction = self.friction.clone().unwrap_or_else(Laurent::zero);
                let at = Enclosed::new(&word, lambda1, &lambda2, &friction).at(h);
                found = Some(at.ok_or_else(|| {
                    Error::input("h", h, "a filter or a letter I has a pole at this step, or it is too long for balls: choose another one")
                })?);
            }
        } else if let Some(rho) = &rho {
            let product = word.polynomials(&Forces::ratio(rho));
            stability = Some(Stability::of(&product));
            let pole = |h: &Laurent| {
                Error::input(
                    "h",
                    h,
                    "a midpoint has no solution at this step, its force being negative: choose another one",
                )
            };
            found = match (&s, &self.h) {
                (Some(s), Some(h)) => Some(at(&product, s).ok_or_else(|| pole(h))?),
                _ => None,
            };
        } else if s.is_some() || range.is_some() {
            return Err(Error::missing("lambda1", "the word names two forces: give both stiffnesses"));
        }
        let (order, general) = orders(&word);
        let (sums, cost) = (word.sums(), word.cost());
        Ok(Linted { word, sums, order, general, cost, rho, stability, pieces, range, at: found })
    }
}

/// Refuses what costs more than the budget allows.
fn affordable(word: &words::Word, work: &Work) -> Result<()> {
    let (needed, most) = (word.effort().max(word.len() / LETTERS), work.budget.unwrap_or(MOST_KICKS));
    if needed > most {
        let cost = format!("the entries of this word are polynomials of degree {needed}");
        return Err(Error::budget(cost, needed).or(format!("write a word of {most} kicks at most")));
    }
    Ok(())
}
