//! `kickdrift word`: an integrator as its author writes it, and the catalogue.

use std::path::{Path, PathBuf};

use num_traits::Zero;

use super::args::{Columns, Common};
use super::paper::Paper;
use super::verdict::within;
use documents::format::Format;
use documents::question::{Linted, Methods, Question, Word};
use documents::report::certificate;
use documents::report::file::write_output;
use number::Laurent;
use number::error::{Error, Result};

/// Flags of `word`: the question, its table, or the catalogue in its place.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    question: Word,
    /// Also write a Coq proof of the verdict at --h, where all numbers are fractions;
    /// proofs/tools/certificate.sh checks it.
    #[arg(long, value_name = "FILE.v")]
    certificate: Option<PathBuf>,
    /// Shows the catalogue.
    #[arg(long, conflicts_with_all = ["word", "method", "lambda1", "lambda2", "h", "h_range", "certificate"])]
    list: bool,
    #[command(flatten)]
    columns: Columns,
    #[command(flatten)]
    paper: Paper,
}

/// Coq multiplies 400 letters of small fractions in some 10 s, and twice as many in four times that.
const WORTH_CERTIFYING: u64 = 400;

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let work = common.work();
        let forms: &[Format] = if self.list { &Format::DOCUMENT } else { &Format::DOCUMENT_OR_FIGURE };
        let format = common.format(forms, Format::Text)?;
        self.paper.check(format.is_figure())?;
        let document = if self.list {
            Methods {}.ask(&work)?
        } else {
            self.certificate.as_ref().map_or(Ok(()), |path| common.apart_from_output("certificate", path))?;
            let answer = self.question.answer(&work)?;
            if let Some(path) = &self.certificate {
                self.certify(&answer, path, common.budget)?;
                common.wrote(path.display());
            }
            let document = self.columns.of(self.question.document(&answer))?;
            if format.is_figure()
                && let Some(figure) = self.question.figure(&answer, &work)?
            {
                self.paper.write(figure, format, common.output.as_deref(), common)?;
                return common.tell_beside_output(&document);
            }
            document
        };
        common.write(&self.columns.of(document)?, Format::Text)
    }

    fn certify(&self, answer: &Linted, path: &Path, budget: Option<u64>) -> Result<()> {
        let Word { h: Some(h), lambda1: Some(lambda1), lambda2, .. } = &self.question else {
            return Err(Error::missing("h", "a certificate is of one step: give --lambda1 and --h"));
        };
        within(answer.word.len(), WORTH_CERTIFYING, budget)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let (none, lambda2) = (Laurent::zero(), lambda2.as_ref());
        let found = answer.at.as_ref().expect("a step was given");
        let numbers = [h, lambda1, lambda2.unwrap_or(&none)];
        let text = certificate::coq_of_word(&answer.word, found, numbers, &name)?;
        write_output(Some(path), text.as_bytes())
    }
}
