//! Input documents: what a person writes in a scene file, as library types.
//!
//! A scene names its quantities exactly, as texts or JSON numbers, and the products it wants; only those are computed. It is
//! read in two steps: JSON into [`document::Document`], whose fields are still text, then each text into the
//! type that the library asks for, so that every error names the field, its value and a remedy.
//!
//! ```
//! use kickdrift::scene::{Product, Scene};
//! let text = r#"{
//!     "schema": "kickdrift/scene/1",
//!     "lambda1": "pi^2", "lambda2": "pi^2/25",
//!     "grid": {"step": "1/100", "h1": "1/100..2/pi", "h2": "1/100..7/2"},
//!     "want": ["map.csv"]
//! }"#;
//! let scene = Scene::read(text).unwrap();
//! assert_eq!(scene.grid().unwrap().pairs(), 63 * 350);
//! assert!(matches!(scene.want()[0].product, Product::Map));
//! ```

mod document;
mod grid;
#[cfg(feature = "system")]
mod system;
mod want;

use crate::error::{Error, Result};
use crate::map::Grid;
use crate::number::parse::{parse, parse_integer_range, parse_range, parse_ratio, parse_rational};
use crate::number::{Laurent, Ratio, Rational};

pub use document::{Document, Quantity};
pub use grid::GridRange;
#[cfg(feature = "system")]
pub use system::{Axis, Scan, SystemScene};
pub use want::{Product, Want};

/// What is to be computed, checked as far as it can be without computing.
#[derive(Clone, Debug)]
pub struct Scene {
    document: Document,
    range: Option<GridRange>,
    want: Vec<Want>,
}

/// The curves wanted: closed ranges of a and b, and the number of samples in 0 < θ < π.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Families {
    pub a: (i64, i64),
    pub b: (i64, i64),
    pub samples: usize,
}

/// A closed range of steps.
pub type StepRange = (Laurent, Laurent);

/// The longest scene file read, in bytes: a scene is written by hand.
pub const LONGEST: usize = 1 << 20;

impl Scene {
    /// Reads a scene from the text of its file.
    ///
    /// # Errors
    /// JSON that is not a scene, an unknown field or product, a quantity that does not parse or is out of
    /// range, a product whose fields are missing.
    pub fn read(text: &str) -> Result<Scene> {
        if text.len() > LONGEST {
            let remedy = "a scene has at most 1 MiB; is this the right file?";
            return Err(Error::input("scene", format!("{} bytes", text.len()), remedy));
        }
        let document: Document = serde_json::from_str(text).map_err(|cause| not_a_scene(text, &cause))?;
        Scene::new(document)
    }

    /// Checks a document and turns its texts into quantities.
    ///
    /// # Errors
    /// As [`Scene::read`].
    pub fn new(document: Document) -> Result<Scene> {
        document.check_schema()?;
        let range = document.grid.as_ref().map(GridRange::read).transpose()?;
        let want = document.want.iter().map(|text| Want::new(text)).collect::<Result<Vec<_>>>()?;
        let scene = Scene { document, range, want };
        scene.parses()?;
        scene.want.iter().try_for_each(|want| scene.supports(want.product))?;
        Ok(scene)
    }

    /// The products wanted, in the order of the file.
    pub fn want(&self) -> &[Want] {
        &self.want
    }

    /// The document behind the scene, for the echo of the input.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The title, or nothing.
    pub fn title(&self) -> &str {
        self.document.title.as_deref().unwrap_or("")
    }

    /// The stiffness of the fast force.
    ///
    /// # Errors
    /// Where the field is missing or does not parse.
    pub fn lambda1(&self) -> Result<Laurent> {
        quantity("lambda1", self.document.lambda1.as_ref())
    }

    /// The stiffness of the slow force.
    ///
    /// # Errors
    /// As [`Scene::lambda1`].
    pub fn lambda2(&self) -> Result<Laurent> {
        quantity("lambda2", self.document.lambda2.as_ref())
    }

    /// The grid of step pairs on the scene's oscillator.
    ///
    /// # Errors
    /// Where the scene lacks it or a stiffness, or holds no pair.
    pub fn grid(&self) -> Result<Grid> {
        self.range()?.of(self.lambda1()?, self.lambda2()?)
    }

    /// The spacings and ranges of the steps.
    ///
    /// # Errors
    /// Where the scene has none.
    pub fn range(&self) -> Result<&GridRange> {
        self.range
            .as_ref()
            .ok_or_else(|| missing("grid", "{\"step\": \"1/100\", \"h1\": \"LO..HI\", \"h2\": \"LO..HI\"}"))
    }

    /// The families of curves; a from 0 to 3 and |b| up to 12 unless the scene says otherwise.
    ///
    /// # Errors
    /// Where a range does not parse.
    pub fn families(&self) -> Result<Families> {
        let range = |field, text: Option<&String>, default| {
            text.map_or(Ok(default), |text| parse_integer_range(field, text))
        };
        let families = self.document.families.clone().unwrap_or_default();
        Ok(Families {
            a: range("families.a", families.a.as_ref(), (0, 3))?,
            b: range("families.b", families.b.as_ref(), (-12, 12))?,
            samples: families.samples.unwrap_or(400) as usize,
        })
    }

    /// How near q h2 must be to a multiple of T½ to count as resonant, in units of T½; 1/20 unless the scene
    /// says otherwise.
    ///
    /// # Errors
    /// Where it does not parse.
    pub fn tolerance(&self) -> Result<Rational> {
        parse_rational("tolerance", self.document.tolerance.as_ref().map_or("1/20", |text| &text.0))
    }

    /// h2/h1 = p/q.
    ///
    /// # Errors
    /// Where the field is missing or is no positive ratio.
    pub fn ratio(&self) -> Result<Ratio> {
        let text = self.document.ratio.as_ref().ok_or_else(|| missing("ratio", "\"7/2\""))?;
        parse_ratio("ratio", &text.0)
    }

    /// The bound on p and q of an exhaustive check of the Proposition; 60 unless the scene says otherwise.
    pub fn max(&self) -> u64 {
        self.document.max.unwrap_or(60)
    }

    /// ρ = L2/L1, where it is given as such.
    ///
    /// # Errors
    /// Where it does not parse.
    pub fn rho(&self) -> Result<Option<Rational>> {
        self.document.rho.as_ref().map(|text| parse_rational("rho", &text.0)).transpose()
    }

    /// The closed range of ρ in which closings are searched; 1/10000..100 unless the scene says otherwise.
    ///
    /// # Errors
    /// Where it does not parse or is not rational.
    pub fn rho_range(&self) -> Result<(Rational, Rational)> {
        let text = self.document.rho_range.as_deref().unwrap_or("1/10000..100");
        let (lo, hi) = parse_range("rho_range", text)?;
        let both = lo.as_rational().zip(hi.as_rational());
        both.ok_or_else(|| Error::input("rho_range", text, "must be rational; write it without pi"))
    }

    /// The steps to show.
    ///
    /// # Errors
    /// Where a range does not parse.
    pub fn window(&self) -> Result<Option<[StepRange; 2]>> {
        let Some(window) = &self.document.window else { return Ok(None) };
        Ok(Some([parse_range("window.h1", &window.h1)?, parse_range("window.h2", &window.h2)?]))
    }

    /// What is given parses, wanted or not.
    fn parses(&self) -> Result<()> {
        let Document { lambda1, lambda2, ratio, .. } = &self.document;
        lambda1.as_ref().map(|_| self.lambda1()).transpose()?;
        lambda2.as_ref().map(|_| self.lambda2()).transpose()?;
        ratio.as_ref().map(|_| self.ratio()).transpose()?;
        self.rho().and(self.rho_range()).and(self.window())?;
        if let Some(colour) =
            self.document.colour.as_ref().filter(|c| !["family", "growth"].contains(&c.as_str()))
        {
            return Err(Error::input("colour", colour, "choose family or growth"));
        }
        self.families().and(self.tolerance()).map(drop)
    }

    /// The fields that a product needs are there, and make sense together.
    fn supports(&self, product: Product) -> Result<()> {
        match product {
            Product::Map | Product::Compare | Product::Figure | Product::Overlay => self.grid().map(drop),
            Product::Curves => self.lambda1().and(self.range().map(drop)),
            Product::Polynomial => self.ratio().map(drop),
            Product::Proposition => Ok(()),
            Product::Closings => self.has_ratios(),
            Product::Tongues => self.has_ratios().and(self.has_rho()),
            Product::Survey => self.has_max_sum().and(self.has_rho()),
            Product::Atlas => {
                self.has_ratios()?;
                self.lambda1()?;
                self.has_rho()?;
                match self.document.window {
                    Some(_) => Ok(()),
                    None => Err(missing("window", "{\"h1\": \"0..2/pi\", \"h2\": \"0..7/2\"}")),
                }
            }
        }
    }

    fn has_max_sum(&self) -> Result<()> {
        self.document.max_sum.map(drop).ok_or_else(|| missing("max_sum", "40"))
    }

    fn has_ratios(&self) -> Result<()> {
        if self.document.max_sum.is_some() { Ok(()) } else { self.ratio().map(drop) }
    }

    fn has_rho(&self) -> Result<()> {
        if self.document.rho.is_some() { Ok(()) } else { self.lambda1().and(self.lambda2()).map(drop) }
    }
}

fn quantity(field: &str, quantity: Option<&Quantity>) -> Result<Laurent> {
    parse(field, &quantity.ok_or_else(|| missing(field, "\"pi^2/25\""))?.0)
}

fn missing(field: &str, example: &str) -> Error {
    Error::missing(field, format!("a wanted product needs it: add for example \"{field}\": {example}"))
}

/// The line at which reading stopped, and why.
fn not_a_scene(text: &str, cause: &serde_json::Error) -> Error {
    let (number, column) = (cause.line(), cause.column());
    let line = text.lines().nth(number.saturating_sub(1)).unwrap_or("");
    let told = cause.to_string();
    let why = told.strip_suffix(&format!(" at line {number} column {column}")).unwrap_or(&told);
    let remedy = format!("{why}; a scene is one JSON object, as data/scenes/figure1.json");
    Error::input(&format!("line {number} of the scene"), line.trim(), remedy)
}
