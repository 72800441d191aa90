//! The products that a scene can want.

use serde_json::Value;

use super::field::Field;
use crate::format::Format;
use number::{Error, Result, named};

named! {
    /// A product of a scene.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
    #[non_exhaustive]
    pub enum Product {
        /// The verdicts of the grid.
        Map = "map",
        /// The (a, b) curves over the grid's window.
        Curves = "curves",
        /// Trace against tan criterion and resonance over the grid.
        Compare = "compare",
        /// The Proposition, exhaustively.
        Proposition = "proposition",
        /// The half period as polynomials.
        Polynomial = "polynomial",
        /// Unstable pairs and curves side by side.
        Figure = "figure",
        /// Unstable pairs under the curves.
        Overlay = "overlay",
        /// The tongues of the ratio, or of all ratios.
        Tongues = "tongues",
        /// Where tongues close.
        Closings = "closings",
        /// All tongues of all ratios, counted and compared.
        Survey = "survey",
        /// All tongues of all ratios in the plane.
        Atlas = "atlas",
    }
}

/// One product in one format: one file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Want {
    pub product: Product,
    pub format: Format,
}

impl Want {
    /// Reads `NAME` or `NAME.FORMAT`. Without a format: JSON for tables, SVG for figures.
    ///
    /// # Errors
    /// An unknown product or format, or a format that the product does not have.
    fn new(text: &str) -> Result<Want> {
        let (name, format) = text.split_once('.').map_or((text, None), |(name, format)| (name, Some(format)));
        let known = || unknown(text, "the products are", &Product::NAMES.join(", "));
        let product = Product::named(name).ok_or_else(known)?;
        let default = if product.is_figure() { Format::Svg } else { Format::Json };
        let format = match format {
            Some(format) => {
                let known = Format::MAP.map(Format::extension).join(", ");
                Format::of_extension(format)
                    .filter(|format| Format::MAP.contains(format))
                    .ok_or_else(|| unknown(text, "the formats are", &known))?
            }
            None => default,
        };
        let drawn = format.is_figure();
        if drawn != product.is_figure() {
            let remedy =
                if drawn { "is a table: json, csv, tex or txt" } else { "is a figure: svg, pdf or png" };
            return Err(Error::input("want", text, remedy));
        }
        if format == Format::Npz && product != Product::Map {
            return Err(Error::input("want", text, "only a map has arrays: map.npz"));
        }
        Ok(Want { product, format })
    }

    /// All that can be wanted, as it may be written.
    pub(super) fn texts() -> Vec<String> {
        let ends = || {
            [String::new()].into_iter().chain(Format::MAP.map(|format| format!(".{}", format.extension())))
        };
        let texts = Product::NAMES.iter().flat_map(|name| ends().map(move |end| format!("{name}{end}")));
        texts.filter(|text| Want::new(text).is_ok()).collect()
    }

    /// The name of the product's file.
    pub fn file_name(&self) -> String {
        format!("{}.{}", self.product.name(), self.format.extension())
    }
}

impl Product {
    /// Whether it is drawn.
    pub fn is_figure(self) -> bool {
        matches!(self, Product::Figure | Product::Overlay | Product::Atlas)
    }
}

/// A list of texts in a scene, one text in documents.
impl Field for Vec<Want> {
    fn of(given: Option<&Value>, name: &str) -> Option<Result<Self>> {
        let texts = match given? {
            Value::String(text) => Some(text.split(", ").collect()),
            list => list.as_array().and_then(|all| all.iter().map(Value::as_str).collect::<Option<Vec<_>>>()),
        };
        let refused =
            || Error::input(name, given.unwrap_or(&Value::Null), "list the products, as [\"map.csv\"]");
        Some(texts.ok_or_else(refused).and_then(|all| all.into_iter().map(Want::new).collect()))
    }

    fn shown(&self) -> Option<Value> {
        Some(self.iter().map(Want::file_name).collect::<Vec<_>>().join(", ").into())
    }
}

fn unknown(text: &str, what: &str, known: &str) -> Error {
    Error::input("want", text, format!("unknown; {what} {known}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_product_has_a_file_and_a_default_format() {
        for product in Product::ALL {
            let want = Want::new(product.name()).unwrap();
            assert_eq!(want.product, product);
            assert_eq!(Want::new(&want.file_name()).unwrap(), want);
        }
        assert_eq!(Want::new("figure.png").unwrap().format, Format::Png);
        assert_eq!(Want::new("map.npz").unwrap().format, Format::Npz);
    }

    #[test]
    fn nonsense_is_refused() {
        for text in ["", "maps", "map.xls", "map.png", "curves.npz", "figure.csv", "figure.svg.png", "."] {
            assert!(Want::new(text).is_err(), "{text}");
        }
    }
}
