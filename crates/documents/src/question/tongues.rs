//! Which tongues are asked for.

use super::asking::question;
use super::field::flag;
use super::field::notation;
use super::ratios::{MOST_SUM, Ratios};
use clocks::tongue::{self, Labels, Range, Request, Selection, StepWindow, Stiffness, Wanted};
use number::error::{Error, Result};
use number::named;
use number::{Laurent, Ratio, Rational};

question! {
    /// Tongues of one ratio or of all, at one ρ. What else is wanted of each is seen in the document's rows.
    #[derive(Default)]
    args struct Tongues {
        /// h2/h1 = p/q.
        #[arg(skip)]
        ratio: Option<Ratio>,
        /// In place of one ratio: all coprime p + q up to this number.
        #[arg(skip)]
        max_sum: Option<u64>,
        /// λ2/λ1, not negative; where both stiffnesses are given, their quotient.
        #[arg(skip)]
        rho: Rational,
        /// The fast stiffness: edges are given in h1 and h2 too.
        #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
        lambda1: Option<Laurent>,
        /// The slow stiffness, in place of --rho.
        #[arg(long, value_name = "Y", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
        lambda2: Option<Laurent>,
        /// Only tongues that meet this closed range of h1 (needs --lambda1).
        #[arg(long, value_name = "LO..HI", allow_hyphen_values = true, value_parser = flag::<(Laurent, Laurent)>)]
        h1_range: Option<Range>,
        /// Only tongues that meet this closed range of h2 (needs --lambda1).
        #[arg(long, value_name = "LO..HI", allow_hyphen_values = true, value_parser = flag::<(Laurent, Laurent)>)]
        h2_range: Option<Range>,
        /// Only these labels, as 4 or 1,3,7..9.
        #[arg(long, value_name = "LIST", allow_hyphen_values = true, value_parser = flag::<Labels>)]
        m: Option<Labels>,
        /// Only tongues whose dominant family has its a in this range.
        #[arg(long, value_name = "LO..HI", allow_hyphen_values = true, value_parser = flag::<(i64, i64)>)]
        a: Option<(i64, i64)>,
        /// Only tongues whose dominant family has its b in this range.
        #[arg(long, value_name = "LO..HI", allow_hyphen_values = true, value_parser = flag::<(i64, i64)>)]
        b: Option<(i64, i64)>,
        /// Give the edges to so many significant digits, more or fewer than doubles have.
        #[arg(long, value_name = "N", value_parser = flag::<u32>)]
        digits: Option<u32>,
    }
}

named! {
    /// The quantity shown by the colours of an atlas.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    #[derive(clap::ValueEnum)]
    pub enum Colour {
        /// The a of the dominant family.
        Family = "family",
        /// The fastest growth inside the tongue.
        Growth = "growth",
    }
}

impl Colour {
    /// The groups that the colours need.
    pub fn needs(self) -> Wanted {
        Wanted { family: true, growth: self == Colour::Growth, ..Wanted::default() }
    }

    fn read(field: &str, text: &str) -> Result<Colour> {
        let known = Colour::ALL.into_iter().find(|colour| colour.name() == text);
        known.ok_or_else(|| Error::input(field, text, "choose family or growth"))
    }
}

notation! {
    Colour: Colour::read, |colour: &Colour| colour.name().to_string();
}

/// Digits beyond this are a slip of the keyboard.
const MOST_DIGITS: u32 = 10_000;

impl Tongues {
    /// All tongues of these ratios.
    pub fn of(ratios: Ratios, stiffness: Stiffness) -> Tongues {
        let ((ratio, max_sum), Stiffness { rho, lambda1, lambda2 }) = (ratios.fields(), stiffness);
        Tongues { ratio, max_sum, rho, lambda1, lambda2, ..Tongues::default() }
    }

    /// The ratios.
    ///
    /// # Errors
    /// Neither one ratio nor a sum, or both; a sum out of range.
    pub fn ratios(&self) -> Result<Ratios> {
        Ratios::of(self.ratio, self.max_sum)?.within(MOST_SUM)
    }

    /// The question in words.
    ///
    /// # Errors
    /// As [`Tongues::ratios`].
    pub fn words(&self) -> Result<String> {
        Ok(format!("{} at rho = {}", self.ratios()?.words(), self.rho))
    }

    /// The question about these tongues, with what is `wanted` of each beside the edges.
    ///
    /// # Errors
    /// As [`Tongues::ratios`] and [`tongue::Listing::new`]; digits out of range.
    pub fn asked(&self, wanted: Wanted) -> Result<tongue::Listing> {
        if let Some(digits) = self.digits.filter(|digits| !(1..=MOST_DIGITS).contains(digits)) {
            return Err(Error::input("digits", digits, format!("choose 1 to {MOST_DIGITS}")));
        }
        let rho = self.lambda2.is_none().then(|| self.rho.clone());
        let stiffness = Stiffness::new(rho, self.lambda1.clone(), self.lambda2.clone())?;
        let window = StepWindow { h1: self.h1_range.clone(), h2: self.h2_range.clone() };
        let selection = Selection { m: self.m.clone(), a: self.a, b: self.b, s: None };
        let request = Request { wanted, lambda1: None, digits: self.digits };
        tongue::Listing::new(self.ratios()?.list(), stiffness, window, selection, request)
    }
}
