//! A scene: quantities by name, and the products that are wanted of them.

mod products;

pub use products::{Made, Products};

use std::path::Path;

use serde_json::{Map as Input, Value};

use super::asking::{Fields, question};
use super::curves::Curves;
use super::field::StepRange;
use super::map::Map;
use super::ratios::{MOST_SUM, Ratios};
use super::survey::{Survey, THINNEST};
use super::tongues::{Colour, Tongues};
use super::want::{Product, Want};
use crate::input::json;
use crate::input::kind::of_another_kind;
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{GROUP, QUANTITY, Schema, Shape, TEXT};
use clocks::resonance::Families;
use clocks::tongue::Stiffness;
use number::{Error, Laurent, Ratio, Rational, Result};

question! {
    /// The quantities of a scene file and the products that it wants; only the fields that these need have to
    /// be there.
    ///
    /// ```
    /// use kickdrift_documents::question::{Product, Scene};
    /// let text = r#"{
    ///     "schema": "kickdrift/scene/1",
    ///     "lambda1": "pi^2", "lambda2": "pi^2/25",
    ///     "grid": {"step": "1/100", "h1": "1/100..2/pi", "h2": "1/100..7/2"},
    ///     "want": ["map.csv"]
    /// }"#;
    /// let scene = Scene::from_json(text).unwrap();
    /// assert_eq!(scene.map().unwrap().grid().unwrap().pairs(), 63 * 350);
    /// assert!(matches!(scene.want[0].product, Product::Map));
    /// ```
    struct Scene {
        /// Shown on figures and summaries.
        title: String = "",
        /// The stiffness of the fast force, positive, in 1/time².
        lambda1: Option<Laurent>,
        /// The stiffness of the slow force, in 1/time²; may be negative.
        lambda2: Option<Laurent>,
        /// The spacing of h1.
        step1: Option<Laurent>,
        /// The spacing of h2.
        step2: Option<Laurent>,
        /// The closed range of h1.
        h1_range: Option<StepRange>,
        /// The closed range of h2.
        h2_range: Option<StepRange>,
        /// The range of a of the curves.
        a: Option<(i64, i64)>,
        /// The range of b of the curves.
        b: Option<(i64, i64)>,
        /// Points a curve.
        samples: Option<usize>,
        /// How near q h2 must be to a multiple of T½ to count as resonant, in units of T½; 1/20 unless given.
        tolerance: Option<Rational>,
        /// h2/h1 = p/q.
        ratio: Option<Ratio>,
        /// The bound on p and q of an exhaustive check of the Proposition; 60 unless given.
        max: Option<u64>,
        /// All coprime p + q up to this number, for tongues, closings, survey and atlas; without it they are
        /// about the ratio.
        max_sum: Option<u64>,
        /// λ2/λ1, in place of λ2, for tongues, survey and atlas.
        rho: Option<Rational>,
        /// The closed range of h1 that tongues and the atlas show.
        window_h1: Option<StepRange>,
        /// The closed range of h2 that they show.
        window_h2: Option<StepRange>,
        /// The quantity shown by the colours of the atlas; family unless given.
        colour: Option<Colour>,
        /// The closed range of ρ in which closings are searched; 1/10000..100 unless given.
        rho_range: Option<(Rational, Rational)>,
        /// The products wanted, in the order of the file.
        want: Vec<Want>,
    }
}

/// The curves unless a scene or a person says otherwise: a from 0 to 3 and |b| up to 12.
pub const FAMILIES: Families = Families { a: (0, 3), b: (-12, 12), samples: 400 };

/// The longest scene file read, in bytes: a scene is written by hand.
pub const LONGEST_SCENE: usize = 1 << 20;

const SCHEMA: &str = "kickdrift/scene/1";

/// Where a file has the fields that it keeps in groups; `grid.step` stands for both spacings.
const GROUPED: [(&str, &str); 10] = [
    ("grid.step", "step"),
    ("grid.step1", "step1"),
    ("grid.step2", "step2"),
    ("grid.h1", "h1_range"),
    ("grid.h2", "h2_range"),
    ("families.a", "a"),
    ("families.b", "b"),
    ("families.samples", "samples"),
    ("window.h1", "window_h1"),
    ("window.h2", "window_h2"),
];

impl Scene {
    /// Reads a scene from the text of its file.
    ///
    /// # Errors
    /// JSON that is not a scene, an unknown field or product, a quantity that does not parse or is out of
    /// range, a product whose fields are missing.
    pub fn from_json(text: &str) -> Result<Scene> {
        if text.len() > LONGEST_SCENE {
            let remedy = "a scene has at most 1 MiB; is this the right file?";
            return Err(Error::input("scene", format!("{} bytes", text.len()), remedy));
        }
        let mut file: Input<String, Value> =
            json::from_str(text).map_err(|cause| not_a_scene(text, &cause))?;
        let schema = file.shift_remove("schema").unwrap_or_default();
        if schema != SCHEMA {
            let schema = schema.as_str().map_or_else(|| schema.to_string(), String::from);
            return Err(of_another_kind(&schema, SCHEMA));
        }
        // One text is how documents have it.
        if let Some(text) = file.get("want").and_then(Value::as_str) {
            return Err(Error::input("want", text, "list the products, as [\"map.csv\"]"));
        }
        let scene = Scene::read(&ungrouped(file)?).map_err(|error| match place(error.field()) {
            Some(place) => error.at(place),
            None => error,
        })?;
        if scene.window_h1.is_some() != scene.window_h2.is_some() {
            return Err(missing("window"));
        }
        scene.check()?;
        Ok(scene)
    }

    /// The schema of its files, by their name: the fields in their groups, as a person may write them.
    pub fn file_schema() -> (&'static str, Value) {
        let required = ["want", "grid.h1", "grid.h2", "window.h1", "window.h2"];
        let keys = Scene::keys()
            .without(&["want"])
            .key("want", Shape::List(&Shape::Words(Want::texts)), "The products to compute, NAME or NAME.FORMAT; nothing else is computed.")
            .key("grid", GROUP, "All pairs of positive multiples of the spacings in closed ranges of h1 and h2.")
            .key("grid.step", QUANTITY, "The spacing of both steps.")
            .key("families", GROUP, "The curves 1/T_half = a/h1 + b/h2 to draw; a from 0 to 3 and b from -12 to 12 unless given, of 400 points.")
            .key("window", GROUP, "The steps that tongues and the atlas show.")
            .written(place, &required);
        let rules = r#"{"allOf": [{"properties": {"grid": {
            "anyOf": [{"required": ["step"]}, {"required": ["step1", "step2"]}]
        }}}]}"#;
        let about = "The input of `kickdrift run`. Every quantity is exact, a JSON number or a string: sums, products, quotients and integer powers of decimals, fractions and pi.";
        let schema = Schema::new("A scene: what to compute, and which products to write", keys);
        ("scene", schema.about(about).rules(rules).file("scene"))
    }

    /// The document on the files of its products in a folder.
    pub fn written(&self, folder: &Path) -> Document {
        let products = self.want.iter().map(|want| (want.product, self.file(folder, want))).collect();
        record().document(Document::new("run").inputs(self.input()), &products)
    }

    fn file(&self, folder: &Path, want: &Want) -> String {
        folder.join(want.file_name()).display().to_string()
    }

    /// The question about the verdicts of the grid.
    ///
    /// # Errors
    /// Where the scene lacks a stiffness or the grid.
    pub fn map(&self) -> Result<Map> {
        let ([step1, step2], [h1_range, h2_range]) = self.grid()?;
        let [lambda1, lambda2] = [("lambda1", &self.lambda1), ("lambda2", &self.lambda2)].map(given);
        let (lambda1, lambda2) = (lambda1?, lambda2?);
        Ok(Map { lambda1, lambda2, step1, step2, h1_range, h2_range, ..Map::default() })
    }

    /// The question about the tongues, in the window where there is one.
    ///
    /// # Errors
    /// Where the scene lacks a ratio or ρ.
    pub fn tongues(&self) -> Result<Tongues> {
        let [h1_range, h2_range] = [&self.window_h1, &self.window_h2].map(Clone::clone);
        Ok(Tongues { h1_range, h2_range, ..Tongues::of(self.ratios()?, self.stiffness()?) })
    }

    /// The question about the curves over the grid's ranges.
    ///
    /// # Errors
    /// Where the scene lacks λ1 or the grid.
    pub fn curves(&self) -> Result<Curves> {
        let lambda1 = given(("lambda1", &self.lambda1))?;
        let (steps, [h1_range, h2_range]) = self.grid()?;
        let [step1, step2] = steps.map(Some);
        let Families { a, b, samples } = self.families();
        Ok(Curves { lambda1, step1, step2, h1_range, h2_range, a, b, samples })
    }

    /// The curves that tongues and maps are drawn over.
    pub fn families(&self) -> Families {
        let Families { a, b, samples } = FAMILIES;
        Families { a: self.a.unwrap_or(a), b: self.b.unwrap_or(b), samples: self.samples.unwrap_or(samples) }
    }

    fn survey(&self) -> Result<Survey> {
        let max_sum = self.max_sum.ok_or_else(|| missing("max_sum"))?;
        Ok(Survey { max_sum, rho: self.stiffness()?.rho, thinnest: THINNEST })
    }

    /// The spacings and the ranges.
    fn grid(&self) -> Result<([Laurent; 2], [StepRange; 2])> {
        let Scene { step1, step2, h1_range, h2_range, .. } = self;
        let steps = step1.clone().zip(step2.clone()).map(|(one, two)| [one, two]);
        let ranges = h1_range.clone().zip(h2_range.clone()).map(|(one, two)| [one, two]);
        steps.zip(ranges).ok_or_else(|| missing("grid"))
    }

    fn ratio(&self) -> Result<Ratio> {
        self.ratio.ok_or_else(|| missing("ratio"))
    }

    /// All ratios where a sum is given, else the one.
    fn ratios(&self) -> Result<Ratios> {
        match self.max_sum {
            Some(max_sum) => Ratios::UpTo(max_sum).within(MOST_SUM),
            None => self.ratio().map(Ratios::One),
        }
    }

    /// ρ, as such or by the stiffnesses.
    fn stiffness(&self) -> Result<Stiffness> {
        Stiffness::new(self.rho.clone(), self.lambda1.clone(), self.lambda2.clone())
    }
}

/// A product, and the path of its file.
type Written = (Product, String);

/// The record of a run.
fn record() -> Record<'static, Vec<Written>> {
    const WRITTEN: Shape = Shape::List(&Shape::Object(|| written().keys()));
    Record::new()
        .value("products", |all: &Vec<Written>| written().all(all).into())
        .says(WRITTEN, "The files written, in the order of the scene.")
}

fn written() -> Record<'static, Written> {
    Record::new()
        .json("product", |(product, _): &Written| product.name().into())
        .says(Shape::OneOf(Product::NAMES), "")
        .json("file", |(_, file)| file.as_str().into())
        .says(TEXT, "The path, relative to where the program ran unless it was asked otherwise.")
}

fn given((field, value): (&str, &Option<Laurent>)) -> Result<Laurent> {
    value.clone().ok_or_else(|| missing(field))
}

/// A field's place in a file, where it is in a group.
fn place(field: &str) -> Option<&'static str> {
    GROUPED.iter().find(|(_, name)| *name == field).map(|(place, _)| *place)
}

/// The fields of a file by their names, out of their groups; one spacing for both where one is given.
fn ungrouped(file: Input<String, Value>) -> Result<Input<String, Value>> {
    let mut input = Input::new();
    for (key, value) in file {
        match (key.as_str(), value) {
            ("grid" | "families" | "window", Value::Object(object)) => {
                for (inner, value) in object {
                    let path = format!("{key}.{inner}");
                    let known = GROUPED.iter().find(|(place, _)| *place == path);
                    let (_, field) = known.ok_or_else(|| unknown(&path, &GROUPED.map(|(place, _)| place)))?;
                    input.insert((*field).into(), value);
                }
            }
            (field, value) if place(field).is_none() && Scene::FIELDS.contains(&field) => {
                input.insert(key, value);
            }
            _ => {
                let plain = Scene::FIELDS.iter().copied().filter(|field| place(field).is_none());
                return Err(unknown(&key, &plain.chain(["grid", "families", "window"]).collect::<Vec<_>>()));
            }
        }
    }
    if let Some(step) = input.shift_remove("step") {
        for text in ["step1", "step2"] {
            input.entry(text).or_insert_with(|| step.clone());
        }
    }
    Ok(input)
}

fn unknown(field: &str, known: &[&str]) -> Error {
    Error::input("unknown field", field, format!("a scene has {}", known.join(", ")))
}

fn missing(field: &str) -> Error {
    let example = match field {
        "grid" => "{\"step\": \"1/100\", \"h1\": \"LO..HI\", \"h2\": \"LO..HI\"}",
        "window" => "{\"h1\": \"0..2/pi\", \"h2\": \"0..7/2\"}",
        "ratio" => "\"7/2\"",
        "max_sum" => "40",
        _ => "\"pi^2/25\"",
    };
    Error::missing(field, format!("a wanted product needs it: add for example \"{field}\": {example}"))
}

/// The line at which reading stopped, and why.
fn not_a_scene(text: &str, cause: &serde_json::Error) -> Error {
    let number = cause.line();
    let line = text.lines().nth(number.saturating_sub(1)).unwrap_or("");
    let remedy = format!("{}; a scene is one JSON object, as data/scenes/figure1.json", json::plain(cause));
    Error::input(&format!("line {number} of the scene"), line.trim(), remedy)
}
