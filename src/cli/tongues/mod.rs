//! `kickdrift tongues`: every unstable interval of one ratio or of all, with certified edges.

mod atlas;
mod figures;
mod output;

use std::path::{Path, PathBuf};

use clap::ValueEnum;

use super::args::{Common, unused};
use super::paper::Paper;
use super::verdict::{EDGES_WORTH_CERTIFYING, within};
pub use atlas::Atlas;
use clocks::tongue::{self, Selection, Stiffness, Tongues, Wanted};
use documents::format::Format;
use documents::question::{
    Colour, MOST_SUM, Question as _, Ratios, Survey, THINNEST, Tongues as Asked, flag,
};
use documents::report::certificate::coq_of_tongue;
use documents::report::file::write_output;
use documents::report::tongues::needed;
use number::error::{Error, Result};
use number::rational::ratio;
use number::{Laurent, Ratio, Rational};
pub use output::{Stream, put};

/// Flags of `tongues`: a ratio or all of them, and rho or both stiffnesses.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// h2/h1 = p/q; several, as 5/3,7/2, for a diagram.
    #[arg(long, value_name = "P/Q", allow_hyphen_values = true, value_delimiter = ',', value_parser = flag::<Ratio>)]
    ratio: Vec<Ratio>,
    /// All coprime p + q up to this number.
    #[arg(long, value_name = "N", value_parser = flag::<u64>)]
    max_sum: Option<u64>,
    /// rho = lambda2/lambda1, not negative.
    #[arg(long, value_name = "R", allow_hyphen_values = true, value_parser = flag::<Rational>)]
    rho: Option<Rational>,
    #[command(flatten)]
    asked: Asked,
    /// Columns by the names that csv has, or groups [default: all; with --max-sum all but growth; in LaTeX
    /// edges].
    ///
    /// Groups: edges, exact, growth (takes longest), predicted, first-order.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    columns: Option<Vec<String>>,
    /// Count and compare instead of listing: all tongues of all ratios that begin below s = 4
    /// (needs --max-sum).
    #[arg(long)]
    survey: bool,
    /// How many of the thinnest tongues a survey lists.
    #[arg(long, value_name = "K", value_parser = flag::<usize>)]
    thinnest: Option<usize>,
    /// What a figure (--output FILE.svg, FILE.pdf or FILE.png) shows [default: atlas].
    #[arg(long, value_name = "WHAT")]
    figure: Option<Drawn>,
    /// What the colours of an atlas stand for [default: family].
    #[arg(long, value_name = "WHAT")]
    colour: Option<Colour>,
    /// The fast clock's angle of --figure strength, a rational multiple of pi between 0 and pi [default:
    /// pi/2].
    #[arg(long, value_name = "THETA", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
    theta: Option<Laurent>,
    /// Also write a Coq proof of the edges of the tongue chosen by --ratio, --rho and --m.
    #[arg(long, value_name = "FILE.v", requires_all = ["ratio", "m"], conflicts_with_all = ["survey", "figure"])]
    certificate: Option<PathBuf>,
    #[command(flatten)]
    paper: Paper,
}

/// Columns of a tongue beside p, q, m, (a, b), its edges and its width.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Columns {
    /// Nothing else.
    Edges,
    /// Edges in closed form.
    Exact,
    /// The fastest growth inside.
    Growth,
    /// The point p theta = m pi against the tongue.
    Predicted,
    /// The first-order law against the tongue.
    FirstOrder,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Drawn {
    /// All tongues as segments in the (h1, h2) plane, over the curves (a, b).
    Atlas,
    /// Measured widths over the first-order law |S_a| at one angle, against a.
    Strength,
    /// Measured widths of all tongues against |S_a|, family by family.
    Widths,
    /// The tongues of one or several ratios: s across, rho from 0 to the one given, closings and resonances
    /// marked.
    Diagram,
    /// Tr Q of one ratio through its tongues, and through the one of --m [default: the widest], with half a
    /// period's entries.
    Trace,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        self.certificate.as_ref().map_or(Ok(()), |path| self.certify(path, common))?;
        let forms = if self.survey { &Format::DOCUMENT[..] } else { &Format::DOCUMENT_OR_FIGURE };
        let format = common.format_of_table(forms)?;
        self.check(format)?;
        let put = |figure| self.paper.write(figure, format, common.output.as_deref(), common);
        match (format, self.figure) {
            _ if self.survey => common.write(&self.all_tongues()?.ask(&common.work())?, format),
            (Format::Svg | Format::Pdf | Format::Png, Some(Drawn::Strength)) => {
                let theta = self.theta.clone().unwrap_or_else(|| Laurent::monomial(ratio(1, 2), 1));
                put(figures::strengths(self.ratios()?, &self.stiffness()?, &theta)?)
            }
            (Format::Svg | Format::Pdf | Format::Png, Some(Drawn::Widths)) => {
                put(figures::widths(self.ratios()?, &self.stiffness()?)?)
            }
            (Format::Svg | Format::Pdf | Format::Png, Some(Drawn::Trace)) => {
                let Ratios::One(ratio) = self.ratios()? else {
                    return Err(Error::missing("ratio", "traces are of one ratio: give --ratio P/Q"));
                };
                put(figures::trace(ratio, &self.stiffness()?.rho, self.asked.m.as_ref())?)
            }
            (Format::Svg | Format::Pdf | Format::Png, Some(Drawn::Diagram)) => {
                put(figures::diagram(self.several()?, &self.stiffness()?.rho, self.paper.width_mm())?)
            }
            (Format::Svg | Format::Pdf | Format::Png, _) => {
                let colour = self.colour.unwrap_or(Colour::Family);
                let question = self.question(colour.needs())?;
                Atlas::new(&question, colour, None)?.write(common, format, &self.paper)
            }
            _ => {
                let names = self.columns.clone().filter(|_| self.groups().is_none());
                let mut question = self.question(self.wanted(format)?)?;
                question.columns = names;
                output::write(&question, common, format)
            }
        }
    }

    /// Writes the proof of one tongue's edges.
    fn certify(&self, path: &Path, common: &Common) -> Result<()> {
        common.apart_from_output("certificate", path)?;
        let rho = self.stiffness()?.rho;
        let one = |remedy| Error::input("--certificate", path.display(), remedy);
        let [ratio] = self.ratios()?.list()[..] else {
            return Err(one("is for one ratio: give --ratio P/Q"));
        };
        within(ratio.kicks(), EDGES_WORTH_CERTIFYING, common.budget)?;
        let gaps = Tongues::new(ratio, &rho)?
            .select(&Selection { m: self.asked.m.clone(), ..Selection::default() })?;
        let [gap] = &gaps[..] else { return Err(one("is for one tongue: choose it with --m")) };
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        write_output(Some(path), coq_of_tongue(ratio, &rho, gap, &name)?.as_bytes())?;
        common.wrote(path.display());
        Ok(())
    }

    /// Rejects combinations of flags that have no meaning.
    fn check(&self, format: Format) -> Result<()> {
        let figure = format.is_figure();
        self.paper.check(figure)?;
        let strength = figure && self.figure == Some(Drawn::Strength);
        let bare = figure && self.figure.is_some_and(|drawn| drawn != Drawn::Atlas);
        let wrong = [
            (
                "figure",
                self.figure.is_some() && !figure,
                "is for figures: write one with --output FILE.svg, FILE.pdf or FILE.png",
            ),
            (
                "colour",
                self.colour.is_some() && (!figure || bare),
                "is for an atlas: write one with --output FILE.svg, FILE.pdf or FILE.png",
            ),
            (
                "theta",
                self.theta.is_some() && !strength,
                "is for --figure strength with --output FILE.svg, FILE.pdf or FILE.png",
            ),
            ("thinnest", self.thinnest.is_some() && !self.survey, "is for --survey"),
            ("columns", self.columns.is_some() && (figure || self.survey), "is for tables"),
            ("digits", self.asked.digits.is_some() && (figure || self.survey), "is for tables"),
        ];
        match wrong.iter().find(|(_, wrong, _)| *wrong) {
            Some((flag, _, remedy)) => Err(Error::input(&format!("--{flag}"), "given", remedy)),
            None if self.survey || bare => self.check_bare(),
            None => Ok(()),
        }
    }

    /// A survey and a figure of strengths are of all tongues.
    fn check_bare(&self) -> Result<()> {
        let given = [
            ("--h1-range", self.asked.h1_range.is_some()),
            ("--h2-range", self.asked.h2_range.is_some()),
            ("--m", self.asked.m.is_some() && self.figure != Some(Drawn::Trace)),
            ("--a", self.asked.a.is_some()),
            ("--b", self.asked.b.is_some()),
        ];
        unused(&given, "this result is of all tongues; leave it out")
    }

    fn all_tongues(&self) -> Result<Survey> {
        let Ratios::UpTo(max_sum) = self.ratios()? else {
            return Err(Error::missing("max-sum", "a survey is of many ratios: give --max-sum N"));
        };
        let (rho, thinnest) = (self.stiffness()?.rho, self.thinnest.unwrap_or(THINNEST));
        Ok(Survey { max_sum, rho, thinnest })
    }

    /// The ratios that were named, one or more.
    fn several(&self) -> Result<&[Ratio]> {
        match (&self.ratio[..], self.max_sum) {
            (named @ [_, ..], None) => Ok(named),
            _ => Err(Error::missing(
                "ratio",
                "a diagram is of ratios by name: give --ratio P/Q or --ratio P/Q,P/Q",
            )),
        }
    }

    fn ratios(&self) -> Result<Ratios> {
        match (&self.ratio[..], self.max_sum) {
            ([_, second, ..], None) => Err(Error::input(
                "ratio",
                second,
                "is a second ratio, and tables are of one: ask for each alone, or for all by --max-sum",
            )),
            (named, max_sum) => Ratios::of(named.first().copied(), max_sum)?.within(MOST_SUM),
        }
    }

    fn stiffness(&self) -> Result<Stiffness> {
        Stiffness::new(self.rho.clone(), self.asked.lambda1.clone(), self.asked.lambda2.clone())
    }

    fn question(&self, wanted: Wanted) -> Result<Stream> {
        let ((ratio, max_sum), rho) = (self.ratios()?.fields(), self.stiffness()?.rho);
        Stream::new(Asked { ratio, max_sum, rho, ..self.asked.clone() }, wanted)
    }

    /// The groups of `--columns`, where it names groups and not columns.
    fn groups(&self) -> Option<Vec<Columns>> {
        let names = self.columns.iter().flatten();
        names.map(|name| Columns::from_str(name.trim(), false).ok()).collect()
    }

    fn wanted(&self, format: Format) -> Result<Wanted> {
        Ok(match (&self.columns, self.groups()) {
            (None, _) if format == Format::Latex => Wanted { family: true, ..Wanted::default() },
            (None, _) => Wanted { growth: self.max_sum.is_none(), ..Wanted::all() },
            (Some(names), None) => {
                let lambda1 = self.asked.lambda1.clone();
                needed(
                    names,
                    &tongue::Request { lambda1, digits: self.asked.digits, ..tongue::Request::default() },
                )?
            }
            (Some(_), Some(list)) => {
                let has = |column| list.contains(&column);
                Wanted {
                    family: true,
                    exact: has(Columns::Exact),
                    growth: has(Columns::Growth),
                    predicted: has(Columns::Predicted),
                    first_order: has(Columns::FirstOrder),
                }
            }
        })
    }
}
