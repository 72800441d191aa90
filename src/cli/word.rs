//! `kickdrift word`: an integrator as its author writes it, and the catalogue.

use std::path::{Path, PathBuf};

use num_traits::Zero;

use super::args::{Columns, Common};
use super::verdict::within;
use documents::format::Format;
use documents::question::{Linted, Methods, Question, Word, WordCheck};
use documents::report::certificate;
use documents::report::file::write_output;
use number::error::{Error, Result};
use number::{Laurent, file};

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
    /// Holds words against what their authors claim: files of TOML with lines [[word]], word = "K(1/2) D(1)
    /// K(1/2)", order = 2, symmetric = true, limit = 2 for each.
    ///
    /// Exits with 1 and a line for each claim that does not hold. A claim is order (on oscillators), general_order,
    /// nystrom_order, consistent, symmetric, limit (the first unstable omega h). A limit with decimals is held to
    /// half a unit of its last one, another limit exactly. Orders, sums and limits of coefficients with decimals
    /// leave out what is below 2^-30.
    #[arg(long, value_name = "FILE", num_args = 1.., value_hint = clap::ValueHint::FilePath, conflicts_with_all = ["word", "method", "lambda1", "lambda2", "h", "h_range", "friction", "certificate", "list"])]
    check: Vec<PathBuf>,
    #[command(flatten)]
    columns: Columns,
}

/// Coq multiplies 400 letters of small fractions in some 10 s, and twice as many in four times that.
const WORTH_CERTIFYING: u64 = 400;

impl Args {
    pub fn run(&self, common: &Common) -> Result<u8> {
        let work = common.work();
        if !self.check.is_empty() {
            return self.check(common);
        }
        let document = if self.list {
            Methods {}.ask(&work)?
        } else {
            self.certificate.as_ref().map_or(Ok(()), |path| common.apart_from_output("certificate", path))?;
            let answer = self.question.answer(&work)?;
            if let Some(path) = &self.certificate {
                self.certify(&answer, path, common.budget)?;
                common.wrote(path.display());
            }
            self.question.document(&answer)
        };
        common.write(&self.columns.of(document)?, Format::Text)?;
        Ok(0)
    }

    /// 1 where a claim does not hold.
    fn check(&self, common: &Common) -> Result<u8> {
        let mut words = Vec::new();
        for path in &self.check {
            let text = file::text(path, file::LONGEST).map_err(|cause| {
                let remedy = "name a file of TOML, such as data/words/claims.toml";
                Error::io(path.display(), format!("cannot read it ({cause}): {remedy}")).caused_by(cause)
            })?;
            words.extend(WordCheck::of_toml(&path.display().to_string(), &text)?.words);
        }
        let asked = WordCheck { words };
        let answer = asked.answer(&common.work())?;
        common.write(&self.columns.of(asked.document(&answer))?, Format::Text)?;
        Ok(u8::from(!WordCheck::all_hold(&answer)))
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
