//! Flags that several commands share.

use std::fmt::Display;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};

use super::progress::make_room;
use super::screen::{self, Colour};
use clocks::map::Products;
use documents::format::Format;
use documents::question::flag;
use documents::report::document::{Document, Layout};
use documents::report::file::write_output;
use documents::report::latex::Float;
use documents::report::map::needed;
use number::error::visible;
use number::{Error, Laurent, Result};

/// Flags of every command.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Options of every command")]
pub struct Common {
    /// The form [default: by the file name; else text, or json for piped tables].
    #[arg(long, global = true, value_name = "FORMAT")]
    pub format: Option<Format>,
    /// Write to this file (run: to this folder) and not to standard output; files appear whole or not at all.
    #[arg(long, global = true, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Threads to use [default: one a core]. The result is the same, byte for byte.
    #[arg(long, global = true, value_name = "N", value_parser = flag::<usize>)]
    pub threads: Option<usize>,
    /// The environment of LaTeX tables [default: table where it fits a column, else table*; longtable beyond
    /// a page].
    #[arg(long, global = true, value_name = "ENV", value_enum)]
    pub float: Option<Float>,
    /// Nothing on standard error but errors: neither progress nor the names of written files.
    #[arg(long, global = true)]
    pub quiet: bool,
    /// Colours the verdict [default: at a terminal, unless NO_COLOR is set].
    #[arg(long, global = true, value_name = "WHEN", value_enum, default_value_t, hide_default_value = true)]
    pub color: Colour,
    /// The most work that an answer may cost, in the unit that a refusal names: as a rule kicks of one pair
    /// of steps [default: 100000000].
    #[arg(long, global = true, value_name = "KICKS", value_parser = flag::<u64>)]
    pub budget: Option<u64>,
    /// The command as figures carry it.
    #[arg(skip)]
    pub command: String,
}

/// That none of these flags is given, which are of no use here.
pub fn unused(given: &[(&str, bool)], remedy: &str) -> Result<()> {
    let found = given.iter().find(|(_, given)| *given);
    found.map_or(Ok(()), |(flag, _)| Err(Error::input(flag, "given", remedy)))
}

/// How rows that are left out of a text are to be seen.
pub const TO_SEE_ROWS: &str = "use --format csv, json or latex to see them";

/// More threads than this are a slip of the keyboard; starting them could bring the machine down.
const MOST_THREADS: usize = 1024;

impl Common {
    /// Writes a document where and how the flags say, in `default` format if they do not.
    pub fn write(&self, document: &Document, default: Format) -> Result<()> {
        let format = self.format(&Format::DOCUMENT, default)?;
        let document = document.clone().floated(self.float).within(self.width());
        let text = document.render_with(format, TO_SEE_ROWS)?;
        self.write_in_form(&text, format)
    }

    /// Writes a rendered document where the flags say: a text on standard output as a person reads it.
    pub fn write_in_form(&self, text: &str, format: Format) -> Result<()> {
        if format == Format::Text && self.output.is_none() {
            return self.write_to_person(text);
        }
        self.write_text(text)
    }

    /// Characters a line of the output, where it is a terminal.
    pub fn width(&self) -> Option<usize> {
        screen::width_of_output().filter(|_| self.output.is_none())
    }

    /// Writes a text to standard output, fitted to a terminal and coloured as the flags say.
    pub fn write_to_person(&self, text: &str) -> Result<()> {
        make_room();
        write_output(None, screen::shown(text, self.color).as_bytes())
    }

    /// Writes a text where the flags say.
    pub fn write_text(&self, text: &str) -> Result<()> {
        make_room();
        write_output(self.output.as_deref(), text.as_bytes())?;
        self.wrote_output();
        Ok(())
    }

    /// Says on standard error that a file, or a number of them in a folder, is written.
    pub fn wrote(&self, what: impl Display) {
        make_room();
        if !self.quiet {
            // Where standard error is closed, nobody wants to know.
            let _ = writeln!(
                std::io::stderr(),
                "kickdrift: wrote {}",
                visible(&what.to_string()).replace('\n', " ")
            );
        }
    }

    /// An answer in words on standard output where `--output` has taken it in another form.
    pub fn tell_beside_output(&self, document: &Document) -> Result<()> {
        if self.output.is_none() || self.quiet {
            return Ok(());
        }
        let document = document.clone().within(screen::width_of_output());
        self.write_to_person(&document.render(Format::Text)?)
    }

    /// Says on standard error that the file of `--output` is written, where there is one.
    pub fn wrote_output(&self) {
        self.output.iter().for_each(|path| self.wrote(path.display()));
    }

    /// `--format`, else what the extension of `--output` says, else `default`.
    pub fn format(&self, forms: &[Format], default: Format) -> Result<Format> {
        let format = self.form(forms, default)?;
        match self.float {
            Some(_) if format != Format::Latex => {
                Err(Error::input("--float", "given", "is for LaTeX tables: add --format latex"))
            }
            _ => Ok(format),
        }
    }

    fn form(&self, forms: &[Format], default: Format) -> Result<Format> {
        let extension = self.output.as_ref().and_then(|path| path.extension());
        let (Some(path), Some(extension), None) = (&self.output, extension, self.format) else {
            return Ok(self.format.unwrap_or(default));
        };
        let format =
            extension.to_str().and_then(Format::of_extension).filter(|format| forms.contains(format));
        format.ok_or_else(|| {
            let remedy =
                format!("this result has other forms: end the name in {}", Format::extensions(forms));
            Error::input("output", path.display(), remedy)
        })
    }

    /// The format of a table: text at a terminal, JSON elsewhere, unless one is asked for.
    pub fn format_of_table(&self, forms: &[Format]) -> Result<Format> {
        let read = self.output.is_none() && std::io::stdout().is_terminal();
        self.format(forms, if read { Format::Text } else { Format::Json })
    }

    /// That a second file is not the one of `--output`, which would replace it.
    pub fn apart_from_output(&self, field: &str, path: &Path) -> Result<()> {
        if self.output.as_deref() != Some(path) {
            return Ok(());
        }
        Err(Error::input(field, path.display(), "is the file of --output too: name another one"))
    }

    /// The number of threads asked for; 0 means one a core.
    pub fn threads(&self) -> usize {
        self.threads.unwrap_or(0)
    }

    /// Sets the number of threads, once.
    pub fn set_threads(&self) -> Result<()> {
        let Some(threads) = self.threads else { return Ok(()) };
        if !(1..=MOST_THREADS).contains(&threads) {
            return Err(Error::input("threads", threads, format!("choose 1 to {MOST_THREADS}")));
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
        pool.map_err(|cause| Error::input("threads", threads, cause))
    }
}

/// How tables are laid out for people and papers.
#[derive(Clone, Debug, clap::Args)]
pub struct Columns {
    /// Only these columns of csv, text and latex, by the names that csv has [default: all; in latex those
    /// that fit].
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    columns: Option<Vec<String>>,
    /// Significant digits of text and latex [default: all; in latex as many as fit].
    #[arg(long, value_name = "N", value_parser = flag::<u32>)]
    digits: Option<u32>,
}

impl Columns {
    /// The columns asked for.
    pub fn names(&self) -> Option<&[String]> {
        self.columns.as_deref()
    }

    /// The products that a map has to compute for the columns asked for.
    pub fn products(&self, format: Format) -> Result<Products> {
        let given = [("--columns", self.columns.is_some()), ("--digits", self.digits.is_some())];
        let has_rows = matches!(format, Format::Csv | Format::Latex | Format::Text);
        if !has_rows {
            unused(&given, "is for rows: add --format csv, latex or text")?;
        }
        Ok(needed(self.names().unwrap_or_default()))
    }

    /// As the document takes it.
    pub fn layout(&self) -> Layout {
        Layout { columns: self.columns.clone(), digits: self.digits }
    }

    /// With so many digits where none are asked for.
    pub fn in_digits(&self, digits: u32) -> Columns {
        Columns { digits: self.digits.or(Some(digits)), ..self.clone() }
    }

    /// The document, laid out.
    pub fn of(&self, document: Document) -> Result<Document> {
        document.laid_out(&self.layout())
    }
}

/// Whether an answer comes alone.
#[derive(Debug, clap::Args)]
pub struct Details {
    /// The whole answer with its tables in text; other forms always have it.
    #[arg(long)]
    details: bool,
}

impl Details {
    /// The document with its details, or with a line that says how to see them.
    pub fn of(&self, document: Document, format: Format, common: &Common) -> Result<Document> {
        if format != Format::Text && common.output.is_none() {
            unused(&[("--details", self.details)], "is for text: other forms have all")?;
        }
        Ok(if self.details { document.detailed() } else { document.below_answer(MORE) })
    }
}

/// Below an answer in a few lines.
const MORE: &str = "more: the whole answer and its tables with --details";

/// The spacing of a grid, which stands for those of both steps.
#[derive(Debug, clap::Args)]
pub struct Spacing {
    /// The spacing of both steps.
    #[arg(long, value_name = "D", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
    pub step: Option<Laurent>,
}
