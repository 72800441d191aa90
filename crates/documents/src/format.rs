//! The forms in which results are written.

use clap::ValueEnum;
use clap::builder::PossibleValue;
use number::named;

named! {
    /// The form of a file, of standard output, of a scene's product.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum Format {
        Json = "json",
        Csv = "csv",
        Latex = "latex",
        Text = "text",
        Svg = "svg",
        Pdf = "pdf",
        Png = "png",
        /// NumPy arrays; of maps alone.
        Npz = "npz",
        /// Extended XYZ; of the modes of systems alone.
        Xyz = "xyz",
        /// VTK's unstructured grids; of the same.
        Vtu = "vtu",
    }
}

impl Format {
    /// The forms of a [`Document`](crate::report::document::Document).
    pub const DOCUMENT: [Format; 4] = [Format::Json, Format::Csv, Format::Latex, Format::Text];

    /// The forms of a [`Figure`](plot::Figure).
    pub const FIGURE: [Format; 3] = [Format::Svg, Format::Pdf, Format::Png];

    /// The forms of a result that is a document or drawn.
    pub const DOCUMENT_OR_FIGURE: [Format; 7] = joined(&Format::DOCUMENT, &Format::FIGURE);

    /// The forms of modes in space, which viewers of molecules and of meshes read.
    pub const MODES: [Format; 2] = [Format::Xyz, Format::Vtu];

    /// The forms of a system's answer.
    pub const SYSTEM: [Format; 9] = joined(&Format::DOCUMENT_OR_FIGURE, &Format::MODES);

    /// The forms of maps, and of what scenes want.
    pub const MAP: [Format; 8] = joined(&Format::DOCUMENT_OR_FIGURE, &[Format::Npz]);

    /// The extension of its files.
    pub fn extension(self) -> &'static str {
        match self {
            Format::Latex => "tex",
            Format::Text => "txt",
            other => other.name(),
        }
    }

    /// The form of files with this extension, in capitals or not; `None` where there is none.
    pub fn of_extension(extension: &str) -> Option<Format> {
        Format::ALL.into_iter().find(|format| format.extension().eq_ignore_ascii_case(extension))
    }

    /// Whether it is drawn.
    pub fn is_figure(self) -> bool {
        Format::FIGURE.contains(&self)
    }

    /// The extensions of some forms in one phrase: `.json, .csv or .txt`.
    ///
    /// ```
    /// use kickdrift_documents::format::Format;
    /// assert_eq!(Format::extensions(&Format::FIGURE), ".svg, .pdf or .png");
    /// ```
    pub fn extensions(formats: &[Format]) -> String {
        let dotted: Vec<String> = formats.iter().map(|format| format!(".{}", format.extension())).collect();
        match dotted.split_last() {
            Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
            _ => dotted.concat(),
        }
    }
}

/// The forms of both lists.
const fn joined<const N: usize>(first: &[Format], second: &[Format]) -> [Format; N] {
    let (mut all, mut k) = ([Format::Json; N], 0);
    while k < N {
        all[k] = if k < first.len() { first[k] } else { second[k - first.len()] };
        k += 1;
    }
    all
}

/// The formats that can be asked for by name; figures and arrays are asked for by the file's extension.
impl ValueEnum for Format {
    fn value_variants<'a>() -> &'a [Self] {
        &[Format::Text, Format::Json, Format::Csv, Format::Latex]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()))
    }
}
