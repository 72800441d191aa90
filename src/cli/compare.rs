//! `kickdrift compare`: the trace against the predictions, over a grid or over ratios.

use super::args::{self, Columns, Common};
use super::paper::Paper;
use documents::format::Format;
use documents::question::{Compare, CompareMethods, Question, flag};
use number::Laurent;
use number::Rational;
use number::error::{Error, Result};

/// Flags of `compare`: either a grid with both stiffnesses, or --max-sum with --rho.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The stiffness of the fast force (with a grid).
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
    lambda1: Option<Laurent>,
    /// The stiffness of the slow force (with a grid).
    #[arg(long, value_name = "Y", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
    lambda2: Option<Laurent>,
    #[command(flatten)]
    grid: args::Grid,
    /// Instead of a grid: all coprime p + q up to this number.
    #[arg(long, value_name = "N", value_parser = flag::<u64>)]
    max_sum: Option<u64>,
    /// lambda2/lambda1, with --max-sum.
    #[arg(long, value_name = "R", allow_hyphen_values = true, value_parser = flag::<Rational>)]
    rho: Option<Rational>,
    /// With --max-sum: the values of s = h1^2 lambda1, evenly spaced inside 0 < s < 4.
    #[arg(long, value_name = "K", default_value_t = 99, value_parser = flag::<u64>)]
    samples: u64,
    /// How near q h2 must be to a multiple of T1/2, half the vibration's period, to count as resonant; in
    /// units of T1/2.
    #[arg(long, value_name = "T", default_value = "1/20", allow_hyphen_values = true, value_parser = flag::<Rational>)]
    tolerance: Rational,
    /// Integrators side by side instead: names of the catalogue (word --list), or words, with commas between
    /// them.
    ///
    /// Over (h, lambda2/lambda1), or over (h1, h2) with a grid: each force in units of its own step, so that
    /// a step h of the word has
    ///
    /// h^2 times the stiffnesses h1^2 lambda1 and h2^2 lambda2. lambda1 is 1 unless given, lambda2 as
    /// lambda1.
    #[arg(long, value_name = "A,B,...", conflicts_with_all = ["max_sum", "rho"])]
    methods: Option<String>,
    /// The closed range of steps, with --methods.
    #[arg(long, value_name = "LO..HI", requires = "methods", value_parser = flag::<(Rational, Rational)>)]
    h_range: Option<(Rational, Rational)>,
    /// The spacing of steps.
    #[arg(long, value_name = "D", requires = "methods", value_parser = flag::<Rational>)]
    h_step: Option<Rational>,
    /// The closed range of lambda2/lambda1, with --methods.
    #[arg(long, value_name = "LO..HI", requires = "methods", value_parser = flag::<(Rational, Rational)>)]
    rho_range: Option<(Rational, Rational)>,
    /// The spacing of lambda2/lambda1.
    #[arg(long, value_name = "R", requires = "methods", value_parser = flag::<Rational>)]
    rho_step: Option<Rational>,
    #[command(flatten)]
    columns: Columns,
    #[command(flatten)]
    paper: Paper,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        if let Some(asked) = self.methods()? {
            return self.side_by_side(&asked, common);
        }
        self.paper.check(false)?;
        let document = self.question()?.ask(&common.work())?;
        common.write(&self.columns.of(document)?, Format::Text)
    }

    fn methods(&self) -> Result<Option<CompareMethods>> {
        let Some(methods) = self.methods.clone() else { return Ok(None) };
        let lambda1 = self.lambda1.clone().unwrap_or_else(|| Laurent::from_integer(1));
        let asked = if self.grid.is_absent() {
            let missing = |flag: &str| {
                Error::missing(
                    flag,
                    "give --h-range, --h-step, --rho-range, --rho-step; or the grid of h1 and h2",
                )
            };
            CompareMethods {
                methods,
                lambda1,
                h_range: self.h_range.clone().ok_or_else(|| missing("h-range"))?,
                h_step: self.h_step.clone().ok_or_else(|| missing("h-step"))?,
                rho_range: self.rho_range.clone(),
                rho_step: self.rho_step.clone(),
                lambda2: self.lambda2.clone(),
                h2_range: None,
                h2_step: None,
            }
        } else {
            let map = self.grid.map(&lambda1, self.lambda2.as_ref().unwrap_or(&lambda1))?;
            let rational = |field: &str, x: &Laurent| {
                x.as_rational().ok_or_else(|| {
                    Error::input(field, x, "write a rational number here, pi in the stiffnesses")
                })
            };
            let range = |field: &str, (lo, hi): &(Laurent, Laurent)| {
                Ok::<_, Error>((rational(field, lo)?, rational(field, hi)?))
            };
            CompareMethods {
                methods,
                lambda1,
                h_range: range("h1-range", &map.h1_range)?,
                h_step: rational("step1", &map.step1)?,
                rho_range: self.rho_range.clone(),
                rho_step: self.rho_step.clone(),
                lambda2: self.lambda2.clone(),
                h2_range: Some(range("h2-range", &map.h2_range)?),
                h2_step: Some(rational("step2", &map.step2)?),
            }
        };
        Ok(Some(asked))
    }

    /// The table, or the maps drawn.
    fn side_by_side(&self, asked: &CompareMethods, common: &Common) -> Result<()> {
        let format = common.format(&Format::DOCUMENT_OR_FIGURE, Format::Text)?;
        self.paper.check(format.is_figure())?;
        let work = common.work();
        let answer = asked.answer(&work)?;
        let document = self.columns.of(asked.document(&answer))?;
        let drawn = common.output.as_deref().filter(|_| format.is_figure());
        match drawn.zip(drawn.map_or(Ok(None), |_| asked.figure(&answer, &work))?) {
            Some((path, figure)) => self.paper.draw("output", path, figure, common)?,
            None => common.write(&document, format)?,
        }
        common.tell_beside_output(&document)
    }

    fn question(&self) -> Result<Compare> {
        let tolerance = self.tolerance.clone();
        match (&self.lambda1, &self.lambda2, self.max_sum, &self.rho) {
            (Some(lambda1), Some(lambda2), None, None) => {
                Ok(Compare::over_grid(self.grid.map(lambda1, lambda2)?, tolerance))
            }
            (None, None, Some(max_sum), Some(rho)) if self.grid.is_absent() => {
                Ok(Compare::over_ratios(max_sum, rho.clone(), self.samples, tolerance))
            }
            _ => Err(Compare::mixed()),
        }
    }
}
