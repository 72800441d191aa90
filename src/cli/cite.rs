//! `kickdrift cite`: how to cite the program.

use clap::ValueEnum;

use super::args::Common;
use documents::format::Format;
use documents::report::file::write_output;
use number::{Error, Result};

/// The files of the source from which this program was built; a test holds one to the other.
const CITATION: &str = include_str!("../../CITATION.cff");
const BIBTEX: &str = include_str!("../../data/citation.bib");

/// Flags of `cite`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// What to print.
    #[arg(value_enum, default_value_t = Form::Bibtex)]
    form: Form,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Form {
    /// Two entries of BibTeX: this version of the program, and the paper that posed its question.
    Bibtex,
    /// The file CITATION.cff, which archives and reference managers read.
    Cff,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        if let Some(format) = common.format.filter(|format| *format != Format::Text) {
            let remedy = "a citation is bibtex or cff: name one of them behind cite";
            return Err(Error::input("format", format.name(), remedy));
        }
        let text = if self.form == Form::Cff { CITATION } else { BIBTEX };
        write_output(common.output.as_deref(), text.as_bytes())?;
        common.wrote_output();
        Ok(())
    }
}
