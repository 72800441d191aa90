//! `kickdrift cite`: how to cite the program, from its own CITATION.cff.

use clap::ValueEnum;

use super::args::Common;
use crate::error::{Error, Result};
use crate::format::Format;
use crate::report::file::write_output;

/// The file of the source from which this program was built.
const CITATION: &str = include_str!("../../CITATION.cff");

/// Flags of `cite`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The form: entries of BibTeX, or the citation file itself.
    #[arg(value_enum, default_value_t = Form::Bibtex)]
    form: Form,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Form {
    /// An entry of this version of the program, and one of the paper whose method it decides.
    Bibtex,
    /// CITATION.cff, as archives and reference managers read it.
    Cff,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        if let Some(format) = common.format.filter(|format| *format != Format::Text) {
            let remedy = "a citation is bibtex or cff: name one of them behind cite";
            return Err(Error::input("format", format.name(), remedy));
        }
        let text = match self.form {
            Form::Bibtex => bibtex(CITATION),
            Form::Cff => CITATION.into(),
        };
        write_output(common.output.as_deref(), text.as_bytes())?;
        common.wrote_output();
        Ok(())
    }
}

/// The entries of the program and of its references.
fn bibtex(cff: &str) -> String {
    let (program, references) = cff.split_once("\nreferences:\n").unwrap_or((cff, ""));
    let works = references.split("\n  - type:").filter(|work| !work.trim().is_empty());
    let program = entry("software", program, "kickdrift");
    std::iter::once(program)
        .chain(works.map(|work| entry("article", work, "paper")))
        .collect::<Vec<_>>()
        .join("\n")
}

/// One work: the fields of BibTeX that the lines of the citation file fill.
fn entry(kind: &str, lines: &str, fallback: &str) -> String {
    let field = |key: &str| values(lines, key).next();
    let year = field("year").or_else(|| Some(field("date-released")?[..4].to_string()));
    let first = values(lines, "family-names").next().unwrap_or_else(|| fallback.into()).to_lowercase();
    let key = if kind == "article" {
        format!("{first}{}", year.clone().unwrap_or_default())
    } else {
        fallback.into()
    };
    let pages = field("start").zip(field("end")).map(|(start, end)| format!("{start}--{end}"));
    let fields = [
        ("author", Some(authors(lines))),
        ("title", field("title").map(|title| format!("{{{title}}}"))),
        ("journal", field("journal")),
        ("volume", field("volume")),
        ("number", field("issue")),
        ("pages", pages),
        ("year", year),
        ("version", field("version")),
        ("url", field("repository-code").or_else(|| field("url"))),
        ("doi", field("doi")),
        ("license", field("license")),
    ];
    let lines =
        fields.into_iter().filter_map(|(name, value)| Some(format!("  {name:<7} = {{{}}},\n", value?)));
    format!("@{kind}{{{key},\n{}}}\n", lines.collect::<String>())
}

/// The names of a work: `Family, Given` of a person, the whole in braces of a group.
fn authors(lines: &str) -> String {
    let people = values(lines, "family-names").zip(values(lines, "given-names"));
    let people = people.map(|(family, given)| format!("{family}, {given}"));
    let groups = values(lines, "name").map(|name| format!("{{{name}}}"));
    people.chain(groups).collect::<Vec<_>>().join(" and ")
}

/// The values of a key, wherever it stands.
fn values(lines: &str, key: &str) -> impl Iterator<Item = String> {
    lines.lines().filter_map(move |line| {
        let value = line.trim_start_matches([' ', '-']).strip_prefix(key)?.strip_prefix(':')?;
        Some(value.trim().trim_matches(['"', '\'']).to_string())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_and_groups_are_authors_in_the_form_of_bibtex() {
        let cff =
            "authors:\n  - family-names: Doe\n    given-names: Jane\n  - name: The group\ntitle: kickdrift\n";
        let entry = bibtex(cff);
        assert!(entry.contains("author  = {Doe, Jane and {The group}}"), "{entry}");
    }

    #[test]
    fn the_citation_file_names_the_version_that_is_built() {
        assert_eq!(values(CITATION, "version").next().unwrap(), env!("CARGO_PKG_VERSION"));
    }
}
