//! Words with a parameter: what is known of a word at each value, and the best value.

mod asked;
mod chart;
mod least;
mod member;
mod search;
mod shown;

pub use asked::{Family, Goal, Parameter, Parameters};
pub use member::Member;
pub use search::{Best, Members};

use crate::question::asking::{Question, Work};
use crate::report::document::Document;
use crate::report::shape::Schema;
use number::parallel::try_map;
use number::{Error, Result};

/// Members times powers of the force, unless a budget says otherwise: some seconds.
const MOST: u64 = 20_000;

impl Question for Family {
    const NAME: &'static str = "family";
    type Answer = Members;

    fn schema() -> Option<Schema> {
        Some(shown::schema())
    }

    fn answer(&self, work: &Work) -> Result<Members> {
        self.check()?;
        if self.parameter.ranged().next().is_none() {
            let remedy = "give one parameter a range, as b=0.15..0.25:1/100; or ask about the word with these values in it";
            return Err(Error::input("parameter", &self.parameter, remedy));
        }
        let places = self.parameter.places()?;
        let first = self.word_at(&places[0])?;
        let cost = first.degree().max(1).saturating_mul(places.len() as u64);
        let most = work.budget.unwrap_or(MOST);
        if cost > most {
            let what =
                format!("these {} members cost {cost} powers of a force, the budget is {most}", places.len());
            return Err(Error::budget(what, cost).or("choose a larger spacing"));
        }
        let bar = work.count(places.len() as u64, "members");
        let all = try_map(&places, |place| {
            let member = self.member(place, work);
            bar.advance(1);
            member
        })?;
        let degree = all.iter().filter_map(Member::nystrom_order).min().map(|order| order + 1);
        let best = self.goal().map_or(Ok(None), |goal| self.best(goal, &all, degree, work))?;
        Ok(Members { all, degree, best })
    }

    fn show(&self, members: &Members) -> Document {
        shown::document(self, members)
    }

    fn figure(&self, members: &Members, _: &Work) -> Result<Option<plot::Figure>> {
        chart::figure(self, members).map(Some)
    }
}
