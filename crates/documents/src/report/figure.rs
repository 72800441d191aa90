//! Figures as files that say what made them.

use plot::Figure;

use crate::format::Format;
use number::{Error, Result};

/// Pixels an inch: print quality.
const DPI: f64 = 300.0;

/// The bytes of a file with the figure, this program's version and the command.
///
/// # Errors
/// A format that is none of figures; for PNG a size on paper that makes more than 2^28 pixels.
pub fn file(figure: Figure, command: &str, format: Format) -> Result<Vec<u8>> {
    let figure = figure.made_by(concat!("kickdrift ", env!("CARGO_PKG_VERSION")), command);
    match format {
        Format::Svg => Ok(figure.svg().into_bytes()),
        Format::Pdf => Ok(figure.pdf()),
        Format::Png => {
            let remedy = "between 1 and what makes 268 million pixels; 300 suits print";
            figure.png(DPI).ok_or_else(|| Error::input("dpi", DPI, remedy))
        }
        other => {
            let remedy = format!("a figure is written as {}", Format::extensions(&Format::FIGURE));
            Err(Error::input("format", other.name(), remedy))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_a_file_is_refused_with_what_can() {
        let message = |side, format| file(Figure::new(side, side), "", format).unwrap_err().to_string();
        assert!(message(2000.0, Format::Png).starts_with("dpi = 300: "));
        assert!(message(40.0, Format::Csv).ends_with(".svg, .pdf or .png"));
    }
}
