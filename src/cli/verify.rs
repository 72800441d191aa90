//! `kickdrift verify`: a document computed again, and held against another route than the one that made it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::args::Common;
use super::progress::{announce, progress};
use documents::format::Format;
use documents::verify::{CheckedDocument, Failure, Options, Outcome};
use number::error::Kind;
use number::{Error, Result, file};

/// Flags of `verify`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A JSON document that kickdrift wrote.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Take the slower route for every pair or ratio of a map or a survey, and not for a random sample of
    /// them.
    #[arg(long)]
    all: bool,
    /// The folder of the scene, where files are that a system refers to (Hessians) [default: the folder of
    /// FILE].
    #[arg(long, value_name = "FOLDER")]
    data: Option<PathBuf>,
}

/// Kicks a second of the slower route.
const KICKS_A_SECOND: f64 = 4e5;

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let file = self.file.display();
        let text = file::text(&self.file, file::LONGEST).map_err(|cause| {
            Error::io(&file, format!("cannot read it ({cause}): name a JSON document that kickdrift wrote"))
        })?;
        let checked = CheckedDocument::read(&text).map_err(|error| self.no_document(error))?;
        let options = Options { budget: common.budget, all: self.all, folder: self.folder() };
        let work = checked.work(&options).map_err(|error| self.elsewhere(error))?;
        announce(common.quiet, &format!("{file}, about {work} kicks"), work as f64 / KICKS_A_SECOND);
        let bar = progress(common.quiet, 0, "rows");
        let shown = |done: u64, count: u64| {
            bar.set_length(count);
            bar.set_position(done);
        };
        let outcome = checked.verify(&options, Some(&shown)).map_err(|error| self.elsewhere(error))?;
        bar.finish_and_clear();
        let name = checked.name();
        if let Some(first) = outcome.failures.first() {
            return Err(failed(first, &outcome, name, &file.to_string()));
        }
        common.write(&outcome.document(&file.to_string(), name), Format::Text)
    }

    /// Another form of an answer, and a proof, have no document that could be read.
    fn no_document(&self, error: Error) -> Error {
        let extension = self.file.extension().and_then(std::ffi::OsStr::to_str);
        let remedy = match extension {
            Some("v") => "is a proof for Coq: proofs/tools/certificate.sh checks it".into(),
            Some(extension) if Format::of_extension(extension).is_some_and(|form| form != Format::Json) => {
                format!(
                    "has no document in it: let the command that made it write {} too, and verify that",
                    self.file.with_extension("json").display()
                )
            }
            _ => return error,
        };
        Error::io(self.file.display(), remedy)
    }

    /// A file that is not beside the document may be elsewhere.
    fn elsewhere(&self, error: Error) -> Error {
        if error.kind() != Kind::Io || self.data.is_some() {
            return error;
        }
        let remedy = format!("{}: --data FOLDER says where the scene of the document lies", error.remedy());
        error.or(remedy)
    }

    fn folder(&self) -> PathBuf {
        let beside = || self.file.parent().unwrap_or(Path::new("")).into();
        self.data.clone().unwrap_or_else(beside)
    }
}

/// The error of the first of some failures: its row by number and name, where the document has rows.
fn failed(first: &Failure, outcome: &Outcome, name: &str, file: &str) -> Error {
    let rows: BTreeSet<u64> =
        outcome.failures.iter().map(|failure| failure.row).filter(|&row| row > 0).collect();
    let more = match (outcome.failures.len(), rows.len()) {
        (_, failing @ 1..) if outcome.rows > 1 => {
            format!(
                "{failing} of {} rows of {file} {}",
                outcome.rows,
                if failing == 1 { "fails" } else { "fail" }
            )
        }
        (1, _) => format!("in {file}"),
        (values, _) => format!("{values} values of {file} differ"),
    };
    let is_row = first.row > 0 && outcome.rows > 1;
    let field = if is_row { format!("row {} of {name}", first.row) } else { "document".into() };
    let place = if first.place.is_empty() { name } else { &first.place };
    Error::input(&field, place, format!("{} ({more})", first.why))
}
