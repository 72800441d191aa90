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
//! assert!(matches!(scene.want[0].product, Product::Map));
//! ```

mod document;
pub mod file;
mod grid;
pub(crate) mod json;
#[cfg(feature = "system")]
mod system;
mod want;

use crate::error::{Error, Result};
use crate::map::Grid;
use crate::number::parse::{
    parse, parse_integer_range, parse_range, parse_ratio, parse_rational, parse_rational_range,
};
use crate::number::{Laurent, Ratio, Rational};
use crate::resonance::Families;

pub use document::{Document, Quantity};
pub use grid::{GridRange, shown_range};
#[cfg(feature = "advise")]
pub use system::of_archive;
#[cfg(feature = "system")]
pub use system::{Array, Arrays, Axis, Scan, Span, SystemFile, SystemScene};
pub use want::{Product, Want};

/// What is to be computed: what the file gives, read once, and checked as far as it can be without computing.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Scene {
    /// The title, or nothing.
    pub title: String,
    /// The stiffness of the fast force, 1/time².
    pub lambda1: Option<Laurent>,
    /// The stiffness of the slow force, 1/time².
    pub lambda2: Option<Laurent>,
    /// The spacings and ranges of the steps.
    pub grid: Option<GridRange>,
    /// The curves wanted.
    pub families: Option<Families>,
    /// How near q h2 must be to a multiple of T½ to count as resonant, in units of T½.
    pub tolerance: Option<Rational>,
    /// h2/h1 = p/q.
    pub ratio: Option<Ratio>,
    /// The bound on p and q of an exhaustive check of the Proposition.
    pub max: Option<u64>,
    /// All ratios with p + q up to this.
    pub max_sum: Option<u64>,
    /// ρ = L2/L1, where it is given as such.
    pub rho: Option<Rational>,
    /// The closed range of ρ in which closings are searched.
    pub rho_range: Option<(Rational, Rational)>,
    /// The steps to show.
    pub window: Option<[StepRange; 2]>,
    /// What the atlas's colours show: `family` or `growth`.
    pub colour: Option<String>,
    /// The products wanted, in the order of the file.
    pub want: Vec<Want>,
}

/// The curves unless a scene or a person says otherwise: a from 0 to 3 and |b| up to 12.
pub const FAMILIES: Families = Families { a: (0, 3), b: (-12, 12), samples: 400 };

fn read_families(document: &document::Families) -> Result<Families> {
    let range = |field, given: &Option<_>, default| {
        Ok(Quantity::read(given.as_ref(), field, parse_integer_range)?.unwrap_or(default))
    };
    Ok(Families {
        a: range("families.a", &document.a, FAMILIES.a)?,
        b: range("families.b", &document.b, FAMILIES.b)?,
        samples: document.samples.map_or(FAMILIES.samples, |samples| samples as usize),
    })
}

/// The fields by which a document echoes families.
pub fn given_families(families: &Families) -> [(&'static str, String); 3] {
    let Families { a, b, samples } = families;
    [("a", shown_range(a)), ("b", shown_range(b)), ("samples", samples.to_string())]
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
        let document: Document = json::from_str(text).map_err(|cause| not_a_scene(text, &cause))?;
        Scene::new(&document)
    }

    /// Checks a document and turns its texts into quantities.
    ///
    /// # Errors
    /// As [`Scene::read`].
    pub fn new(document: &Document) -> Result<Scene> {
        document.check_schema()?;
        let window = |of: &document::Window| {
            Ok([parse_range("window.h1", &of.h1.0)?, parse_range("window.h2", &of.h2.0)?])
        };
        let rational = |field, given: &Option<_>| Quantity::read(given.as_ref(), field, parse_rational);
        let scene = Scene {
            title: document.title.clone().unwrap_or_default(),
            lambda1: Quantity::read(document.lambda1.as_ref(), "lambda1", parse)?,
            lambda2: Quantity::read(document.lambda2.as_ref(), "lambda2", parse)?,
            grid: document.grid.as_ref().map(GridRange::read).transpose()?,
            families: document.families.as_ref().map(read_families).transpose()?,
            tolerance: rational("tolerance", &document.tolerance)?,
            ratio: Quantity::read(document.ratio.as_ref(), "ratio", parse_ratio)?,
            max: document.max,
            max_sum: document.max_sum,
            rho: rational("rho", &document.rho)?,
            rho_range: Quantity::read(document.rho_range.as_ref(), "rho_range", parse_rational_range)?,
            window: document.window.as_ref().map(window).transpose()?,
            colour: document.colour.as_ref().map(|text| colour(text)).transpose()?,
            want: document.want.iter().map(|text| Want::new(text)).collect::<Result<_>>()?,
        };
        scene.want.iter().try_for_each(|want| scene.supports(want.product))?;
        Ok(scene)
    }

    /// The stiffness of the fast force.
    ///
    /// # Errors
    /// Where the field is missing.
    pub fn lambda1(&self) -> Result<&Laurent> {
        self.lambda1.as_ref().ok_or_else(|| missing("lambda1", "\"pi^2/25\""))
    }

    /// λ1 and λ2.
    ///
    /// # Errors
    /// Where the scene lacks one of them.
    pub fn stiffnesses(&self) -> Result<(Laurent, Laurent)> {
        Ok((self.lambda1()?.clone(), self.lambda2()?.clone()))
    }

    /// The grid of step pairs on the scene's oscillator.
    ///
    /// # Errors
    /// Where the scene lacks it or a stiffness, or holds no pair.
    pub fn grid(&self) -> Result<Grid> {
        let range = self.range()?;
        let (lambda1, lambda2) = self.stiffnesses()?;
        range.of(lambda1, lambda2)
    }

    /// The spacings and ranges of the steps.
    ///
    /// # Errors
    /// Where the scene has none.
    pub fn range(&self) -> Result<&GridRange> {
        self.grid
            .as_ref()
            .ok_or_else(|| missing("grid", "{\"step\": \"1/100\", \"h1\": \"LO..HI\", \"h2\": \"LO..HI\"}"))
    }

    /// h2/h1 = p/q.
    ///
    /// # Errors
    /// Where the field is missing.
    pub fn ratio(&self) -> Result<Ratio> {
        self.ratio.ok_or_else(|| missing("ratio", "\"7/2\""))
    }

    fn lambda2(&self) -> Result<&Laurent> {
        self.lambda2.as_ref().ok_or_else(|| missing("lambda2", "\"pi^2/25\""))
    }

    /// What the scene gives, exactly, for a document to echo.
    pub fn given(&self) -> Vec<(&'static str, String)> {
        fn text<T: ToString>(key: &'static str, given: Option<&T>) -> Option<(&'static str, String)> {
            given.map(|value| (key, value.to_string()))
        }
        let range = |key, of: usize| self.window.as_ref().map(|window| (key, shown_range(&window[of])));
        let mut given = vec![("title", self.title.clone())];
        given.extend(text("lambda1", self.lambda1.as_ref()));
        given.extend(text("lambda2", self.lambda2.as_ref()));
        given.extend(self.grid.iter().flat_map(GridRange::given));
        given.extend(self.families.iter().flat_map(given_families));
        given.extend(text("tolerance", self.tolerance.as_ref()));
        given.extend(text("ratio", self.ratio.as_ref()));
        given.extend(text("max", self.max.as_ref()));
        given.extend(text("max_sum", self.max_sum.as_ref()));
        given.extend(text("rho", self.rho.as_ref()));
        given.extend(range("window_h1", 0).into_iter().chain(range("window_h2", 1)));
        given.extend(text("colour", self.colour.as_ref()));
        given.extend(self.rho_range.as_ref().map(|range| ("rho_range", shown_range(range))));
        given.push(("want", self.want.iter().map(Want::file_name).collect::<Vec<_>>().join(", ")));
        given
    }

    /// The fields that a product needs are there, and make sense together.
    fn supports(&self, product: Product) -> Result<()> {
        match product {
            Product::Map | Product::Compare | Product::Figure | Product::Overlay => self.grid().map(drop),
            Product::Curves => self.lambda1().and(self.range()).map(drop),
            Product::Polynomial => self.ratio().map(drop),
            Product::Proposition => Ok(()),
            Product::Closings => self.has_ratios(),
            Product::Tongues => self.has_ratios().and(self.has_rho()),
            Product::Survey => self.has_max_sum().and(self.has_rho()),
            Product::Atlas => {
                self.has_ratios()?;
                self.lambda1()?;
                self.has_rho()?;
                match self.window {
                    Some(_) => Ok(()),
                    None => Err(missing("window", "{\"h1\": \"0..2/pi\", \"h2\": \"0..7/2\"}")),
                }
            }
        }
    }

    fn has_max_sum(&self) -> Result<()> {
        self.max_sum.map(drop).ok_or_else(|| missing("max_sum", "40"))
    }

    fn has_ratios(&self) -> Result<()> {
        if self.max_sum.is_some() { Ok(()) } else { self.ratio().map(drop) }
    }

    fn has_rho(&self) -> Result<()> {
        if self.rho.is_some() { Ok(()) } else { self.lambda1().and(self.lambda2()).map(drop) }
    }
}

fn colour(text: &str) -> Result<String> {
    let known = ["family", "growth"].contains(&text).then(|| text.to_string());
    known.ok_or_else(|| Error::input("colour", text, "choose family or growth"))
}

fn missing(field: &str, example: &str) -> Error {
    Error::missing(field, format!("a wanted product needs it: add for example \"{field}\": {example}"))
}

/// The line at which reading stopped, and why.
fn not_a_scene(text: &str, cause: &serde_json::Error) -> Error {
    let number = cause.line();
    let line = text.lines().nth(number.saturating_sub(1)).unwrap_or("");
    let remedy = format!("{}; a scene is one JSON object, as data/scenes/figure1.json", json::plain(cause));
    Error::input(&format!("line {number} of the scene"), line.trim(), remedy)
}
