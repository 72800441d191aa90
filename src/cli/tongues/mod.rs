//! `kickdrift tongues`: every unstable interval of one ratio or of all, with certified edges.

mod figures;

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use plot::Figure;

use super::args::{Common, TO_SEE_ROWS, unused};
use super::paper::Paper;
use super::verdict::{EDGES_WORTH_CERTIFYING, within};
use clocks::tongue::{Selection, Tongues};
use documents::format::Format;
use documents::question::{
    Colour, Columns, Form, Question as _, Ratios, Survey, THINNEST, Tongues as Asked, flag,
};
use documents::report::certificate::coq_of_tongue;
use documents::report::file::{write_output, write_with};
use number::{Error, Laurent, Ratio, Result, ratio};

/// Flags of `tongues`: a ratio or all of them, and rho or both stiffnesses.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    asked: Asked,
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
        if self.survey {
            return common.write(&self.all_tongues()?.ask(&common.work())?, format);
        }
        if format.is_figure() {
            return self.paper.write(self.drawn(common)?, format, common.output.as_deref(), common);
        }
        let mut question = self.asked.clone();
        if format == Format::Latex {
            question.columns.get_or_insert_with(Columns::edges);
        }
        let form = Form { format, float: common.float, to_see: TO_SEE_ROWS, width: common.width() };
        if format == Format::Text {
            let mut text = Vec::new();
            question.write(&common.work(), form, &mut text)?;
            return common.write_in_form(&String::from_utf8_lossy(&text), format);
        }
        write_with(common.output.as_deref(), |sink| question.write(&common.work(), form, sink).map(drop))?;
        common.wrote_output();
        Ok(())
    }

    /// The figure that is asked for.
    fn drawn(&self, common: &Common) -> Result<Figure> {
        if self.figure == Some(Drawn::Diagram) {
            return figures::diagram(self.several()?, &self.asked.stiffness()?.rho, self.paper.width_mm());
        }
        let question = &self.asked;
        let (ratios, stiffness) = (question.ratios()?, || question.stiffness());
        match self.figure.unwrap_or(Drawn::Atlas) {
            Drawn::Strength => {
                let theta = self.theta.clone().unwrap_or_else(|| Laurent::monomial(ratio(1, 2), 1));
                figures::strengths(ratios, &stiffness()?, &theta)
            }
            Drawn::Widths => figures::widths(ratios, &stiffness()?),
            Drawn::Trace => {
                let Ratios::One(ratio) = ratios else {
                    return Err(Error::missing("ratio", "traces are of one ratio: give --ratio P/Q"));
                };
                figures::trace(ratio, &stiffness()?.rho, question.m.as_ref())
            }
            Drawn::Atlas | Drawn::Diagram => {
                let colour = self.colour.unwrap_or(Colour::Family);
                question.atlas(colour, None, &common.work())
            }
        }
    }

    /// Writes the proof of one tongue's edges.
    fn certify(&self, path: &Path, common: &Common) -> Result<()> {
        common.apart_from_output("certificate", path)?;
        let rho = self.asked.stiffness()?.rho;
        let one = |remedy| Error::input("--certificate", path.display(), remedy);
        let [ratio] = self.asked.ratios()?.list()[..] else {
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
            ("columns", self.asked.columns.is_some() && (figure || self.survey), "is for tables"),
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
        let Ratios::UpTo(max_sum) = self.asked.ratios()? else {
            return Err(Error::missing("max-sum", "a survey is of many ratios: give --max-sum N"));
        };
        let (rho, thinnest) = (self.asked.stiffness()?.rho, self.thinnest.unwrap_or(THINNEST));
        Ok(Survey { max_sum, rho, thinnest })
    }

    /// The ratios that were named, one or more.
    fn several(&self) -> Result<&[Ratio]> {
        match (&self.asked.ratio, self.asked.max_sum) {
            (Some(named), None) => Ok(named.ratios()),
            _ => Err(Error::missing(
                "ratio",
                "a diagram is of ratios by name: give --ratio P/Q or --ratio P/Q,P/Q",
            )),
        }
    }
}
