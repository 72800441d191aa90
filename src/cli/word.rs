//! `kickdrift word`: an integrator as its author writes it, and the catalogue.

use std::path::{Path, PathBuf};

use num_traits::Zero;

use super::args::{Columns, Common, Details, unused};
use super::asked::Flags;
use super::paper::Paper;
use super::verdict::within;
use documents::format::Format;
use documents::question::{Family, Linted, Methods, Question, Word, WordCheck};
use documents::report::certificate;
use documents::report::file::write_output;
use number::{Error, Laurent, Result, file};

/// Flags of `word`: the question, its table, or the catalogue in its place.
#[derive(Debug, clap::Args)]
pub struct Args {
    // Its flags come first: its word may have names.
    #[command(flatten)]
    family: Flags<Family>,
    #[command(flatten)]
    asked: Flags<Word>,
    /// Also write a Coq proof of the verdict at --h, where all numbers are fractions;
    /// proofs/tools/certificate.sh checks it.
    #[arg(long, value_name = "FILE.v")]
    certificate: Option<PathBuf>,
    /// Shows the catalogue.
    #[arg(long, conflicts_with_all = ["word", "method", "lambda1", "lambda2", "h", "h_range", "certificate", "parameter"])]
    list: bool,
    /// Holds words against what their authors claim: files of TOML; exits with 1 where a claim does not hold.
    ///
    /// For each word [[word]], word = "K(1/2) D(1) K(1/2)", order = 2, symmetric = true, limit = 2.
    ///
    /// Claims: order (on oscillators), general_order, nystrom_order, consistent, symmetric, limit (first
    /// unstable omega h).
    ///
    /// A limit with decimals is held to half a unit of its last one, another limit exactly.
    ///
    /// Coefficients with decimals are taken nominally: an error below 2^-30 counts as 0.
    #[arg(long, value_name = "FILE", num_args = 1.., value_hint = clap::ValueHint::FilePath, conflicts_with_all = ["word", "method", "lambda1", "lambda2", "h", "h_range", "friction", "certificate", "list"])]
    check: Vec<PathBuf>,
    #[command(flatten)]
    columns: Columns,
    #[command(flatten)]
    details: Details,
    #[command(flatten)]
    paper: Paper,
}

/// Significant digits of the catalogue in text, where none are asked for.
const LISTED: u32 = 6;

/// Coq multiplies 400 letters of small fractions in some 10 s, and twice as many in four times that.
const WORTH_CERTIFYING: u64 = 400;

impl Args {
    pub fn run(&self, common: &Common) -> Result<u8> {
        if !self.check.is_empty() {
            return self.check(common);
        }
        self.ask(common).map(|()| 0)
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

    fn ask(&self, common: &Common) -> Result<()> {
        let forms: &[Format] = if self.list { &Format::DOCUMENT } else { &Format::DOCUMENT_OR_FIGURE };
        let format = common.format(forms, Format::Text)?;
        self.paper.check(format.is_figure())?;
        let work = common.work();
        if self.list {
            let columns =
                if format == Format::Text { self.columns.in_digits(LISTED) } else { self.columns.clone() };
            return common.write(&columns.of(Methods {}.ask(&work)?)?, Format::Text);
        }
        let family = self.family.has("parameter").then(|| self.family.question()).transpose()?;
        let filled = family.as_ref().map_or(Ok(None), Family::only_word)?;
        if let Some(question) = family.filter(|_| filled.is_none()) {
            let of_one =
                [("--method", "method"), ("--h", "h"), ("--h-range", "h_range"), ("--friction", "friction")];
            let of_one = of_one.map(|(flag, field)| (flag, self.asked.has(field)));
            unused(&of_one, "goes with one word: leave it out, or --parameter")?;
            unused(&[("--certificate", self.certificate.is_some())], "is of one word: leave it out")?;
            return self.answered(&question, &question.answer(&work)?, format, common);
        }
        self.certificate.as_ref().map_or(Ok(()), |path| common.apart_from_output("certificate", path))?;
        let question = match &filled {
            Some(word) => self.asked.with("word", &word.to_string()).question()?,
            None => self.asked.question()?,
        };
        let answer = question.answer(&work)?;
        if let Some(path) = &self.certificate {
            certify(&question, &answer, path, common.budget)?;
            common.wrote(path.display());
        }
        self.answered(&question, &answer, format, common)
    }

    /// The document, or the figure and the document in words.
    fn answered<Q: Question>(
        &self,
        question: &Q,
        answer: &Q::Answer,
        format: Format,
        common: &Common,
    ) -> Result<()> {
        let document = self.details.of(self.columns.of(question.document(answer))?, format, common)?;
        let figure = if format.is_figure() { question.figure(answer, &common.work())? } else { None };
        self.paper.write_answer(figure, &document, format, common)?;
        if format.is_figure() { common.tell_beside_output(&document) } else { Ok(()) }
    }
}

fn certify(question: &Word, answer: &Linted, path: &Path, budget: Option<u64>) -> Result<()> {
    let Word { h: Some(h), lambda1: Some(lambda1), lambda2, .. } = question else {
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
