//! The products of a scene: each is the answer of one question, which is asked once in however many forms it
//! is wanted.

use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::Path;

use plot::Figure;

use super::{Scene, given, missing, record};
use crate::format::Format;
use crate::question::asking::{Question, Work};
use crate::question::closings::{Closings, DIGITS};
use crate::question::compare::Compare;
use crate::question::map::Map;
use crate::question::polynomial::Polynomial;
use crate::question::proposition::Proposition;
use crate::question::tongues::{Colour, Form, FoundTongues, Tongues};
use crate::question::want::Product;
use crate::report::document::Document;
use crate::report::map::{MapArrays, MapTally, Marked, Rows, marked};
use crate::report::plane::{self, Cloud};
use crate::report::shape::Schema;
use clocks::map::{Grid, Products as Columns};
use clocks::resonance::{Curve, Window};
use number::{Result, ratio};

/// All products of a scene.
pub struct Products {
    made: BTreeMap<Product, Made>,
    /// The arrays of the map where they are wanted, on their way to their file.
    pub arrays: Option<MapArrays>,
}

/// The answer of a product's question.
pub enum Made {
    Document(Box<Document>),
    Figure(Box<Figure>),
    /// Rendered row by row, for they may be many.
    Tongues(Box<(Tongues, FoundTongues)>),
}

impl Products {
    /// The answer of a product.
    ///
    /// # Panics
    /// Where the scene does not want it.
    pub fn of(&self, product: Product) -> &Made {
        &self.made[&product]
    }
}

impl Made {
    /// The bytes of its file; a figure is drawn by `draw`.
    ///
    /// # Errors
    /// A form that it does not have.
    pub fn written(&self, form: Form, draw: impl FnOnce(Figure) -> Result<Vec<u8>>) -> Result<Vec<u8>> {
        match self {
            Made::Document(document) => {
                let document = document.as_ref().clone().floated(form.float);
                Ok(document.render_with(form.format, form.to_see)?.into_bytes())
            }
            Made::Figure(figure) => draw(figure.as_ref().clone()),
            Made::Tongues(tongues) => tongues.0.written(&tongues.1, form),
        }
    }

    /// What it says of itself in words.
    fn summary(&self) -> String {
        match self {
            Made::Document(document) => document.summary_text().to_string(),
            Made::Figure(_) => String::new(),
            Made::Tongues(tongues) => tongues.1.lines().join("\n"),
        }
    }
}

/// The question of a product, to be asked.
type Asking<'a> = Box<dyn Fn(&Work, &Shared) -> Result<Made> + 'a>;

/// What several products show.
#[derive(Default)]
struct Shared<'a> {
    /// The file of the map's arrays, if they are wanted.
    archive: Option<&'a Path>,
    decided: OnceCell<Decided>,
    arrays: RefCell<Option<MapArrays>>,
}

/// Every pair of the grid decided: the counts, and the pairs that are not plainly stable, in the order of h1,
/// then h2.
struct Decided {
    grid: Grid,
    tally: MapTally,
    marked: Vec<Marked>,
}

impl Shared<'_> {
    /// The verdicts of the grid; they are decided where they are not yet.
    fn decided(&self, map: &Map, work: &Work) -> Result<&Decided> {
        if self.decided.get().is_none() {
            let (grid, mut tally, mut all) = (map.grid()?, MapTally::default(), Vec::new());
            let arrays = self.archive.map(|path| MapArrays::new(path, &grid, Columns::default()));
            let mut arrays = arrays.transpose()?;
            map.each(&grid, None, work, |band| {
                tally.add(&grid, &band);
                all.extend(marked(&grid, &band));
                arrays.as_mut().map_or(Ok(()), |arrays| arrays.add(&grid, &band))
            })?;
            self.arrays.replace(arrays);
            let _ = self.decided.set(Decided { grid, tally, marked: all });
        }
        Ok(self.decided.get().expect("just filled"))
    }
}

/// A question whose answer is its document.
fn plain<'a, Q: Question + 'a>(question: Q) -> Asking<'a> {
    Box::new(move |work, _| question.ask(work).map(Box::new).map(Made::Document))
}

impl Scene {
    /// That it has what its products need.
    ///
    /// # Errors
    /// A product whose fields are missing, or make no sense together.
    pub fn check(&self) -> Result<()> {
        self.want.iter().try_for_each(|want| self.asking(want.product).map(drop))
    }

    /// The question of a product.
    ///
    /// # Errors
    /// Where its fields are missing, or make no sense together.
    fn asking(&self, product: Product) -> Result<Asking<'_>> {
        Ok(match product {
            Product::Map => {
                let map = self.decidable()?;
                Box::new(move |work, shared| {
                    let Decided { grid, tally, marked } = shared.decided(&map, work)?;
                    let rows = Rows::new(grid, Columns::default()).table(marked);
                    Ok(Made::Document(Box::new(map.document(tally).long_rows(rows))))
                })
            }
            Product::Figure => self.drawn(plane::side_by_side)?,
            Product::Overlay => self.drawn(plane::overlay)?,
            Product::Curves => plain(self.curves()?),
            Product::Compare => {
                let tolerance = self.tolerance.clone().unwrap_or_else(|| ratio(1, 20));
                plain(Compare::over_grid(self.decidable()?, tolerance))
            }
            Product::Proposition => plain(Proposition { max: self.max.unwrap_or(60) }),
            Product::Polynomial => plain(Polynomial { ratio: self.ratio()? }),
            Product::Closings => {
                let one = if self.max_sum.is_none() { Some(self.ratio()?) } else { None };
                let rho_range = self.rho_range.clone().unwrap_or_else(|| (ratio(1, 10_000), ratio(100, 1)));
                let max_sum = self.max_sum;
                plain(Closings { ratio: one, max_sum, m: None, rho_range, samples: 400, digits: DIGITS })
            }
            Product::Survey => plain(self.survey()?),
            Product::Tongues => {
                let tongues = self.tongues()?;
                Box::new(move |work, _| {
                    let found = tongues.answer(work)?;
                    Ok(Made::Tongues(Box::new((tongues.clone(), found))))
                })
            }
            Product::Atlas => {
                let tongues = given(("lambda1", &self.lambda1)).and(self.tongues())?;
                self.window_h1.as_ref().ok_or_else(|| missing("window"))?;
                let colour = self.colour.unwrap_or(Colour::Family);
                Box::new(move |work, _| {
                    tongues.atlas(colour, Some(self.families()), work).map(Box::new).map(Made::Figure)
                })
            }
        })
    }

    /// The question about the verdicts of a grid that is one.
    fn decidable(&self) -> Result<Map> {
        let map = self.map()?;
        map.grid()?;
        Ok(map)
    }

    /// The unstable pairs of the grid drawn with the curves.
    fn drawn(&self, draw: fn(&Window, &Cloud, &[Curve], &str) -> Figure) -> Result<Asking<'_>> {
        let map = self.decidable()?;
        Ok(Box::new(move |work, shared| {
            let Decided { grid, marked, .. } = shared.decided(&map, work)?;
            let unstable = marked.iter().filter(|pair| !pair.decision.verdict.is_stable());
            let pairs = unstable.map(|pair| (pair.i as u32, pair.j as u32)).collect();
            let cloud = Cloud { spacing: [grid.steps().0.to_f64(), grid.steps().1.to_f64()], pairs };
            let window = Window::new(&map.h1_range, &map.h2_range);
            let curves = self.families().curves(&map.lambda1, &window)?;
            let figure = draw(&window, &cloud, &curves, &self.title).footed(&map.foot());
            Ok(Made::Figure(Box::new(figure)))
        }))
    }

    /// Asks the questions of all products; arrays of the map go to a file in `folder`, where there is one.
    ///
    /// # Errors
    /// As those of the questions.
    pub fn products(&self, folder: Option<&Path>, work: &Work) -> Result<Products> {
        let arrays = self.want.iter().find(|want| want.format == Format::Npz);
        let archive = arrays.zip(folder).map(|(want, folder)| folder.join(want.file_name()));
        let shared = Shared { archive: archive.as_deref(), ..Shared::default() };
        let mut made = BTreeMap::new();
        for want in &self.want {
            if let Entry::Vacant(product) = made.entry(want.product) {
                product.insert(self.asking(want.product)?(work, &shared)?);
            }
        }
        Ok(Products { made, arrays: shared.arrays.take() })
    }

    /// The document on the files of its products in a folder; a product's summary stands once, with its first
    /// file.
    pub fn summary(&self, folder: &Path, products: &Products) -> Document {
        let mut lines = vec![self.title.clone()];
        lines.retain(|title| !title.is_empty());
        for (place, want) in self.want.iter().enumerate() {
            lines.push(self.file(folder, want));
            if self.want[..place].iter().all(|before| before.product != want.product) {
                let summary = products.of(want.product).summary();
                lines.extend(summary.lines().map(|line| format!("    {line}")));
            }
        }
        self.written(folder).summary(&lines)
    }
}

impl Question for Scene {
    const NAME: &'static str = "run";
    const EXAMPLES: &'static [&'static str] = &["run data/scenes/small.json --output small"];
    type Answer = Products;

    fn schema() -> Option<Schema> {
        Some(Schema::new("What a run of a scene wrote", record().keys()))
    }

    fn answer(&self, work: &Work) -> Result<Products> {
        self.check()?;
        self.products(None, work)
    }

    fn show(&self, products: &Products) -> Document {
        self.summary(Path::new(""), products)
    }

    /// The first of its figures.
    fn figure(&self, products: &Products, _: &Work) -> Result<Option<Figure>> {
        Ok(products.made.values().find_map(|made| match made {
            Made::Figure(figure) => Some(figure.as_ref().clone()),
            _ => None,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_product_is_the_answer_of_its_question_in_the_form_that_is_wanted() {
        let text = r#"{"schema": "kickdrift/scene/1", "title": "small", "lambda1": "10", "lambda2": "2/5",
            "grid": {"step": "1/10", "h1": "1/10..3/5", "h2": "1/10..2"}, "max_sum": 6,
            "want": ["map.npz", "compare.tex", "tongues", "tongues.csv", "tongues.txt", "overlay"]}"#;
        let (scene, work) = (Scene::from_json(text).unwrap(), Work::default());
        let products = scene.answer(&work).unwrap();
        // Without a folder there is no file for them.
        assert!(products.arrays.is_none());
        for want in &scene.want[1..5] {
            let form = Form { format: want.format, float: None, to_see: "", width: None };
            let written = products.of(want.product).written(form, |_| unreachable!()).unwrap();
            let mut alone = Vec::new();
            match want.product {
                Product::Tongues => drop(scene.tongues().unwrap().write(&work, form, &mut alone).unwrap()),
                _ => {
                    let document = Compare::over_grid(scene.map().unwrap(), ratio(1, 20)).ask(&work).unwrap();
                    alone = document.render(want.format).unwrap().into_bytes();
                }
            }
            assert_eq!(String::from_utf8(written).unwrap(), String::from_utf8(alone).unwrap());
        }
        assert!(scene.figure(&products, &work).unwrap().is_some());
        let document = scene.document(&products).value();
        assert_eq!(document["products"][0]["file"], "map.npz");
        assert_eq!(document["input"]["max_sum"], "6");
    }
}
