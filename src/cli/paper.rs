//! How figures are put on paper: what all commands that draw have in common.

use std::path::Path;

use plot::Figure;

use super::args::{Common, unused};
use documents::format::Format;
use documents::report::document::Document;
use documents::report::figure::file;
use documents::report::file::write_output;
use number::{Error, Result};

/// Flags of every command that draws.
#[derive(Clone, Debug, Default, clap::Args)]
#[command(next_help_heading = "Options of figures")]
pub struct Paper {
    /// The width on paper, as 85mm, 17.4cm, 3.3in or 240pt; the height follows [default: 85 to 175mm].
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = millimetres)]
    width: Option<f64>,
    /// A heading, as "Run 7 of *h*_1 = 2 fs": italics between stars, an index after _, a power after ^.
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// No heading and nothing below the axes, for papers whose caption says it; several panels keep their
    /// titles.
    #[arg(long, conflicts_with = "title")]
    bare: bool,
    /// The unit of times and rates at the axes, as fs [default: the system's, else the word time].
    #[arg(long, value_name = "UNIT")]
    time_unit: Option<String>,
    /// Letters of PDF as shapes, as those of SVG are [default: text, searchable]
    #[arg(long)]
    outlines: bool,
    /// Letters of SVG as text, searchable; programs that ignore fonts in a document, as Inkscape, misplace
    /// them [default: shapes]
    #[arg(long, conflicts_with = "outlines")]
    text: bool,
}

impl Paper {
    /// The width asked for.
    pub fn width_mm(&self) -> Option<f64> {
        self.width
    }

    /// That nothing is asked of a figure where none is drawn.
    pub fn check(&self, draws: bool) -> Result<()> {
        let given = [
            ("--width", self.width.is_some()),
            ("--title", self.title.is_some()),
            ("--bare", self.bare),
            ("--time-unit", self.time_unit.is_some()),
            ("--outlines", self.outlines),
            ("--text", self.text),
        ];
        if draws { Ok(()) } else { unused(&given, "is for figures, and this draws none") }
    }

    /// The figure as the flags want it, as the bytes of a file that carries its command.
    pub fn bytes(&self, mut figure: Figure, format: Format, command: &str) -> Result<Vec<u8>> {
        if let Some(unit) = &self.time_unit {
            if !figure.has_time() {
                return Err(Error::input(
                    "time-unit",
                    unit,
                    "no axis of this figure is a time: leave it out",
                ));
            }
            figure = figure.in_units_of(unit);
        }
        if let Some(width) = self.width {
            figure = figure.wide(width);
        }
        if let Some(title) = &self.title {
            figure = figure.headed(title);
        }
        if self.bare {
            figure = figure.bare();
        }
        let figure = match (self.outlines, self.text) {
            (true, _) => figure.outlined(),
            (_, true) => figure.in_text(),
            _ => figure,
        };
        file(figure, command, format)
    }

    /// Writes the figure to a file, or to standard output.
    pub fn write(&self, figure: Figure, format: Format, path: Option<&Path>, common: &Common) -> Result<()> {
        self.write_as(figure, format, path, (&common.command, common))
    }

    /// Writes an answer as the form wants it: the figure where it is drawn, else the document.
    pub fn write_answer(
        &self,
        figure: Option<Figure>,
        document: &Document,
        format: Format,
        common: &Common,
    ) -> Result<()> {
        match figure {
            Some(figure) => self.write(figure, format, common.output.as_deref(), common),
            None => common.write(document, format),
        }
    }

    /// Writes the figure with this command in it.
    pub fn write_as(
        &self,
        figure: Figure,
        format: Format,
        path: Option<&Path>,
        (command, common): (&str, &Common),
    ) -> Result<()> {
        write_output(path, &self.bytes(figure, format, command)?)?;
        path.into_iter().for_each(|path| common.wrote(path.display()));
        Ok(())
    }

    /// Writes the figure to the FILE.svg, FILE.pdf or FILE.png that a flag names.
    pub fn draw(&self, field: &str, path: &Path, figure: Figure, common: &Common) -> Result<()> {
        let extension = path.extension().and_then(|extension| extension.to_str());
        let format = extension.and_then(Format::of_extension).filter(|format| format.is_figure());
        let remedy = || format!("name a file that ends in {}", Format::extensions(&Format::FIGURE));
        let format = format.ok_or_else(|| Error::input(field, path.display(), remedy()))?;
        self.write(figure, format, Some(path), common)
    }
}

/// A length on paper in millimetres: no wider than a poster, no narrower than a thumb.
fn millimetres(text: &str) -> std::result::Result<f64, &'static str> {
    const REFUSED: &str = "write a length from 20mm to 2000mm, in mm, cm, in or pt, as 85mm";
    let unit = [("mm", 1.0), ("cm", 10.0), ("in", 25.4), ("pt", 25.4 / 72.0)];
    let found = unit.into_iter().find_map(|(name, size)| Some((text.trim().strip_suffix(name)?, size)));
    let (number, size) = found.ok_or(REFUSED)?;
    let length = number.trim().parse::<f64>().map_err(|_| REFUSED)? * size;
    if (20.0..=2000.0).contains(&length) { Ok(length) } else { Err(REFUSED) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_units() {
        assert_eq!(["85mm", "8.5 cm", "1in", "72pt"].map(millimetres), [85.0, 85.0, 25.4, 25.4].map(Ok));
        for text in ["85", "mm", "19mm", "3m", "1e9cm", "NaNmm", "-85mm"] {
            assert!(millimetres(text).is_err(), "{text}");
        }
    }
}
