//! `kickdrift closings`: where tongues close.

use crate::parallel::try_map;

use super::args::{Common, from_str, of, whole};
use super::progress::progress;
use super::ratios::{Flags, Ratios};
use super::request::Request;
use crate::error::{Error, Result};
use crate::format::Format;
use crate::number::parse::parse_rational_range;
use crate::number::{Ratio, Rational};
use crate::report::closings::{self, DIGITS};
use crate::report::document::Document;
use crate::scene::shown_range;
use crate::tongue::{self, Found, Labels, Search};

/// Flags of `closings`: a ratio or all of them.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    which: Flags,
    /// Only these labels (with --ratio), as 4 or 1,3,7..9.
    #[arg(long, value_name = "LIST", allow_hyphen_values = true, value_parser = from_str::<Labels>)]
    m: Option<Labels>,
    /// The closed range of rho = lambda2/lambda1, positive.
    #[arg(long, value_name = "LO..HI", default_value = "1/10000..100", allow_hyphen_values = true, value_parser = of(parse_rational_range))]
    rho_range: (Rational, Rational),
    /// Values of rho, evenly spaced in ln rho, between which edges are seen to cross.
    #[arg(long, value_name = "N", default_value_t = 400, allow_negative_numbers = true, value_parser = whole::<usize>)]
    samples: usize,
    /// Significant digits of s and rho.
    #[arg(long, value_name = "N", default_value_t = DIGITS, allow_negative_numbers = true, value_parser = whole::<u32>)]
    digits: u32,
}

/// All that `closings` asks.
#[derive(Clone, Debug)]
pub struct Question {
    pub ratios: Ratios,
    pub m: Option<Labels>,
    pub rho: (Rational, Rational),
    pub samples: usize,
    pub digits: u32,
}

/// Searches cost p + q squared for each of the samples.
const MOST_SUM: u64 = 200;
const MOST_SAMPLES: usize = 1_000_000;
/// The boxes are known to 2^-100 of their centres.
const MOST_DIGITS: u32 = 28;

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let format = common.format_of_table(&Format::DOCUMENT)?;
        let request = Request::Closings(self.question()?);
        common.write(&request.perform(common, format == Format::Csv)?, format)
    }

    fn question(&self) -> Result<Question> {
        let Args { which, m, rho_range, samples, digits } = self;
        Question::new(which.ratios()?, m.clone(), rho_range.clone(), *samples, *digits)
    }
}

impl Question {
    /// The question, if it makes sense.
    ///
    /// # Errors
    /// A sum, a number of samples or digits out of range, labels of many ratios.
    pub fn new(
        ratios: Ratios,
        m: Option<Labels>,
        rho: (Rational, Rational),
        samples: usize,
        digits: u32,
    ) -> Result<Self> {
        let ratios = ratios.within(MOST_SUM)?;
        if matches!(ratios, Ratios::UpTo(_)) && m.is_some() {
            return Err(Error::input("m", "given with --max-sum", "labels are those of one --ratio"));
        }
        if !(2..=MOST_SAMPLES).contains(&samples) {
            return Err(Error::input("samples", samples, format!("choose 2 to {MOST_SAMPLES}")));
        }
        if !(1..=MOST_DIGITS).contains(&digits) {
            return Err(Error::input("digits", digits, format!("choose 1 to {MOST_DIGITS}")));
        }
        Ok(Question { ratios, m, rho, samples, digits })
    }

    /// The document `kickdrift/closings/1`; its rows with all columns, or with those that fit paper.
    ///
    /// # Errors
    /// As [`tongue::closings`].
    pub fn document(&self, common: &Common, all_columns: bool) -> Result<Document> {
        let list = self.ratios.list();
        let bar = progress(common.quiet, list.len() as u64, "ratios");
        let one = |&ratio: &Ratio| {
            let found = self.of_ratio(ratio);
            bar.inc(1);
            found
        };
        let found: Vec<Found> = try_map(&list, one)?;
        bar.finish_and_clear();
        let (lo, hi) = &self.rho;
        let what = format!("{}, rho in {lo}..{hi}", self.ratios.words());
        Ok(self.echo(closings::document(&found, self.digits, &what, all_columns)))
    }

    fn of_ratio(&self, ratio: Ratio) -> Result<Found> {
        let search = Search { m: None, rho: self.rho.clone(), samples: self.samples };
        match &self.m {
            None => tongue::closings(ratio, &search),
            Some(labels) => tongue::closings_of(ratio, &labels.0, &search),
        }
    }

    fn echo(&self, document: Document) -> Document {
        let labels = self.m.iter().map(|labels| ("m", labels.to_string()));
        self.ratios
            .echo(document)
            .inputs(labels)
            .input("rho_range", shown_range(&self.rho))
            .input("samples", self.samples)
            .input("digits", self.digits)
    }
}
