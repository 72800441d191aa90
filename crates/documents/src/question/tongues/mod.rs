//! The tongues of one ratio or of all.

mod atlas;
mod written;

use super::asking::{Fields, Question, Work, question};
use super::field::notation;
use super::ratios::{MOST_SUM, RatioList, Ratios};
use crate::report::document::{Document, Layout};
use crate::report::shape::{Keys, Schema, Shape};
use crate::report::tongues::{CAPTION, CAPTION_LATEX, TongueTally, keys, needed, record};
use atlas::Atlas;
pub use atlas::Colour;
use clocks::resonance::Families;
use clocks::tongue::{Labels, Listing, Range, Request, Selection, StepWindow, Stiffness, Tongue, Wanted};
use number::{Error, Laurent, Rational, Result};
pub use written::Form;

question! {
    /// Tongues of one ratio, of some or of all, at one ρ, and what is wanted of each.
    #[derive(Default)]
    args struct Tongues {
        /// h2/h1 = p/q; or several, as 3/2,5/2.
        ratio as "P/Q": Option<RatioList>,
        /// All coprime p + q up to this number.
        max_sum as "N": Option<u64>,
        /// rho = lambda2/lambda1, not negative.
        rho as "R": Option<Rational>,
        /// The fast stiffness: edges are given in h1 and h2 too.
        lambda1 as "X": Option<Laurent>,
        /// The slow stiffness, in place of --rho.
        lambda2 as "Y": Option<Laurent>,
        /// Only tongues that meet this closed range of h1 (needs --lambda1).
        h1_range as "LO..HI": Option<Range>,
        /// Only tongues that meet this closed range of h2 (needs --lambda1).
        h2_range as "LO..HI": Option<Range>,
        /// Only these labels, as 4 or 1,3,7..9.
        m as "LIST": Option<Labels>,
        /// Only tongues whose dominant family has its a in this range.
        a as "LO..HI": Option<(i64, i64)>,
        /// Only tongues whose dominant family has its b in this range.
        b as "LO..HI": Option<(i64, i64)>,
        /// Give the edges to so many significant digits, more or fewer than doubles have.
        digits as "N": Option<u32>,
        /// Columns by the names that csv has, or groups [default: all; with --max-sum all but growth; in
        /// LaTeX edges].
        ///
        /// Groups: edges, exact, growth (takes longest), predicted, first-order.
        columns as "LIST": Option<Columns>,
    }
}

/// Columns of tongues, by the names that CSV has or in groups. Documents name the groups that were asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Columns(Vec<String>);

/// The groups beside p, q, m, (a, b), the edges and the width, which alone are `EDGES`.
const EDGES: &str = "edges";
const GROUPS: [&str; 4] = ["exact", "growth", "predicted", "first-order"];

impl Columns {
    /// The edges, and no other group.
    pub fn edges() -> Columns {
        Columns::of(Wanted::default())
    }

    /// The groups that are wanted.
    fn of(Wanted { exact, growth, predicted, first_order, .. }: Wanted) -> Columns {
        let wanted = GROUPS.into_iter().zip([exact, growth, predicted, first_order]);
        let groups: Vec<String> =
            wanted.filter(|(_, wanted)| *wanted).map(|(group, _)| group.to_string()).collect();
        Columns(if groups.is_empty() { vec![EDGES.into()] } else { groups })
    }

    /// What is wanted, where all names are those of groups.
    fn groups(&self) -> Option<Wanted> {
        let is_group = |name: &String| name == EDGES || GROUPS.contains(&name.as_str());
        let [exact, growth, predicted, first_order] =
            GROUPS.map(|group| self.0.iter().any(|name| name == group));
        self.0.iter().all(is_group).then_some(Wanted { family: true, exact, growth, predicted, first_order })
    }
}

const COLUMNS: Shape = Shape::Plain(
    r#"{
        "type": "string",
        "pattern": "^(edges|(exact|growth|predicted|first-order)(,(growth|predicted|first-order))*)$"
    }"#,
);

notation! {
    Columns: |_, text: &str| {
            Ok::<_, Error>(Columns(text.split(',').map(|name| name.trim().into()).collect()))
        },
        |columns: &Columns| columns.0.join(","), COLUMNS;
}

/// Digits beyond this are a slip of the keyboard.
const MOST_DIGITS: u32 = 10_000;

/// Rows unless a budget says otherwise: some gigabytes of text, minutes of work.
const MOST_ROWS: u64 = 30_000_000;

/// Tongues that were found, or the first of them and the counts of all.
pub struct FoundTongues {
    /// The question with ρ and with groups in place of columns, as documents echo it.
    asked: Tongues,
    pub request: Request,
    pub tongues: Vec<Tongue>,
    tally: TongueTally,
}

impl FoundTongues {
    /// Counts and extremes in words.
    pub fn lines(&self) -> Vec<String> {
        self.tally.lines(&self.asked.words().expect("it was answered"))
    }
}

impl Tongues {
    /// All tongues of these ratios.
    pub fn of(ratios: Ratios, Stiffness { rho, lambda1, lambda2 }: Stiffness) -> Tongues {
        let (ratio, max_sum) = ratios.fields();
        Tongues { ratio, max_sum, rho: Some(rho), lambda1, lambda2, ..Tongues::default() }
    }

    /// The ratios.
    ///
    /// # Errors
    /// Neither ratios nor a sum, or both; a sum out of range.
    pub fn ratios(&self) -> Result<Ratios> {
        Ratios::of(self.ratio.clone().map(Into::into), self.max_sum)?.within(MOST_SUM)
    }

    /// ρ, given as such or by both stiffnesses; a document has all three.
    ///
    /// # Errors
    /// As [`Stiffness::new`]; a ρ that is another one than the stiffnesses'.
    pub fn stiffness(&self) -> Result<Stiffness> {
        let Tongues { rho, lambda1, lambda2, .. } = self.clone();
        if let (Some(rho), Some(_)) = (&rho, &lambda2) {
            let both = Stiffness::new(None, lambda1, lambda2).ok();
            let refused = || Error::input("rho", "given with lambda2", "give one of them");
            return both.filter(|both| both.rho == *rho).ok_or_else(refused);
        }
        Stiffness::new(rho, lambda1, lambda2)
    }

    /// The question in words.
    ///
    /// # Errors
    /// As [`Tongues::ratios`] and [`Tongues::stiffness`].
    pub fn words(&self) -> Result<String> {
        Ok(format!("{} at rho = {}", self.ratios()?.words(), self.stiffness()?.rho))
    }

    /// What is wanted of each tongue beside its edges.
    fn wanted(&self) -> Result<Wanted> {
        let Some(columns) = &self.columns else {
            return Ok(Wanted { growth: self.max_sum.is_none(), ..Wanted::all() });
        };
        let (lambda1, digits) = (self.lambda1.clone(), self.digits);
        let request = Request { lambda1, digits, ..Request::default() };
        columns.groups().map_or_else(|| needed(&columns.0, &request), Ok)
    }

    /// The columns of tables, where they are asked for one by one.
    fn named(&self) -> Option<Vec<String>> {
        self.columns.as_ref().filter(|columns| columns.groups().is_none()).map(|columns| columns.0.clone())
    }

    /// The question as documents echo it: with ρ, and with the groups of columns where some were asked for.
    fn whole(&self) -> Result<Tongues> {
        self.ratios()?;
        let (rho, wanted) = (self.stiffness()?.rho, self.wanted()?);
        let columns = self.columns.as_ref().map(|_| Columns::of(wanted));
        Ok(Tongues { rho: Some(rho), columns, ..self.clone() })
    }

    /// The question as the search takes it.
    fn listing(&self) -> Result<Listing> {
        if let Some(digits) = self.digits.filter(|digits| !(1..=MOST_DIGITS).contains(digits)) {
            return Err(Error::input("digits", digits, format!("choose 1 to {MOST_DIGITS}")));
        }
        let window = StepWindow { h1: self.h1_range.clone(), h2: self.h2_range.clone() };
        let selection = Selection { m: self.m.clone(), a: self.a, b: self.b, s: None };
        let request = Request { wanted: self.wanted()?, lambda1: None, digits: self.digits };
        Listing::new(self.ratios()?.list(), self.stiffness()?, window, selection, request)
    }

    /// That so many rows may be computed, where no window and no label says that they are fewer: p + q - 1 of
    /// p/q.
    fn allow(&self, listing: &Listing, work: &Work) -> Result<()> {
        if listing.window != StepWindow::default() || listing.selection != Selection::default() {
            return Ok(());
        }
        let rows = listing.ratios.iter().map(|ratio| ratio.kicks() - 1).sum::<u64>();
        let most = work.budget.unwrap_or(MOST_ROWS);
        if rows <= most {
            return Ok(());
        }
        let ratios = self.ratios()?;
        let cost = format!("the tongues of {} are {rows} rows, the budget is {most}", ratios.words());
        Err(Error::budget(cost, rows).or(match ratios {
            Ratios::One(_) | Ratios::Several(_) => "choose labels by --m, or a window",
            Ratios::UpTo(_) => "choose a smaller --max-sum, a window, or --survey",
        }))
    }

    /// Hands on the tongues in the order of the ratios, then of m.
    fn each(&self, listing: &Listing, work: &Work, see: impl FnMut(&[Tongue]) -> Result<()>) -> Result<()> {
        self.allow(listing, work)?;
        let count = listing.ratios.len() as u64;
        let progress = work.count(count, if count == 1 { "tongues" } else { "ratios" });
        listing.each(&*progress, see)
    }

    /// Finds the tongues and draws them over the curves of these families, else of those selected.
    ///
    /// # Errors
    /// As [`Question::answer`]; λ1 or a range of steps that is missing; a window without a step.
    pub fn atlas(&self, colour: Colour, families: Option<Families>, work: &Work) -> Result<plot::Figure> {
        let growth = colour == Colour::Growth;
        let columns = Some(Columns::of(Wanted { growth, ..Wanted::default() }));
        let listing = Tongues { columns, ..self.clone() }.listing()?;
        let mut atlas = Atlas::new(self.ratios()?, listing.clone(), colour, families)?;
        self.each(&listing, work, |part| {
            atlas.add(part);
            Ok(())
        })?;
        Ok(atlas.drawn())
    }

    /// The counts of all tongues, and the first of them, up to `most`.
    fn first(&self, most: u64, work: &Work) -> Result<FoundTongues> {
        let (asked, listing) = (self.whole()?, self.listing()?);
        let (mut tongues, mut tally) = (Vec::new(), TongueTally::default());
        self.each(&listing, work, |part| {
            for tongue in part {
                tally.add(tongue);
                if tally.count <= most {
                    tongues.push(tongue.clone());
                }
            }
            Ok(())
        })?;
        Ok(FoundTongues { asked, request: listing.request, tongues, tally })
    }

    /// The tables and the summary, without rows in JSON; what people see has these columns.
    fn tables(&self, answer: &FoundTongues, tongues: &[Tongue], seen: &Request) -> Document {
        let request = &answer.request;
        let table = |request, short| {
            record(request, short).table("tongues", CAPTION, tongues).captioned(CAPTION_LATEX)
        };
        // Places come with their digits already; what is left are widths and rounded numbers, which doubles
        // hold.
        let layout = Layout { columns: self.named(), digits: request.digits };
        let document =
            Document::new(Self::NAME).long_rows(table(request, false)).for_people(table(seen, true));
        document.summary(&answer.lines()).laid_out(&layout).expect("it was answered")
    }
}

impl Question for Tongues {
    const NAME: &'static str = "tongues";
    const EXAMPLES: &'static [&'static str] = &[
        "tongues --ratio 7/3 --rho 1/25 --m 3..5 --digits 30",
        "tongues --ratio 5/3,7/2 --rho 5/2 --figure diagram --output tongues.svg",
        "tongues --ratio 5/3 --rho 1/25 --m 3 --figure trace --output trace.pdf --width 174mm",
        "tongues --survey --max-sum 12 --rho 1/25 --format latex",
    ];
    const USAGE: Option<&'static str> =
        Some("(--ratio <P/Q> | --max-sum <N>) (--rho <R> | --lambda1 <X> --lambda2 <Y>)");
    type Answer = FoundTongues;

    fn schema() -> Option<Schema> {
        let body = Keys::new()
            .key("tongues", Shape::List(&Shape::Object(keys)), "The tongues, one a row.")
            .and(TongueTally::record().keys());
        let says = "By p + q, then p, or in the order in which ratios are named; then by m. What was not asked for (--columns, --digits, lambda1) is absent; null says that a tongue has none of it.";
        // Ratios by name or all up to a sum, at a rho that is not below 0.
        let rules = r#"{"allOf": [{"properties": {"input": {
            "required": ["rho"],
            "oneOf": [{"required": ["ratio"]}, {"required": ["max_sum"]}],
            "properties": {"rho": {"pattern": "^[0-9]"}}
        }}}]}"#;
        let title = "Unstable intervals (tongues) in s = h1^2 lambda1, with certified edges";
        Some(Schema::new(title, body).about(says).rules(rules))
    }

    fn answer(&self, work: &Work) -> Result<FoundTongues> {
        self.first(u64::MAX, work)
    }

    fn show(&self, answer: &FoundTongues) -> Document {
        let rows = record(&answer.request, false).all(&answer.tongues);
        // A table for paper has edges alone unless it is asked for more.
        let wanted = self.columns.as_ref().map_or_else(Wanted::default, |_| answer.request.wanted);
        let seen = Request { wanted, ..answer.request.clone() };
        let document = self.tables(answer, &answer.tongues, &seen).entry("tongues", rows);
        TongueTally::record().document(document, &answer.tally)
    }

    fn document(&self, answer: &FoundTongues) -> Document {
        self.show(answer).inputs(answer.asked.input())
    }

    fn figure(&self, answer: &FoundTongues, _: &Work) -> Result<Option<plot::Figure>> {
        let mut atlas = Atlas::new(self.ratios()?, self.listing()?, Colour::Family, None)?;
        atlas.add(&answer.tongues);
        Ok(Some(atlas.drawn()))
    }
}
