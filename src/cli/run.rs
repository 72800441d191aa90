//! `kickdrift run`: the products that a scene wants, nothing else, and what two of them share only once.

use std::cell::OnceCell;
use std::path::{Path, PathBuf};

use super::args::{Common, Format as DocumentFormat};
use super::plane::Verdicts;
use super::{compare, curves, map, polynomial, proposition};
use crate::error::{Error, Result};
use crate::report::document::Document;
use crate::report::figure::{Figure, png};
use crate::report::file::write_output;
use crate::report::{document, plane};
use crate::resonance::{Curve, Window};
use crate::scene::{Format, Product, Scene, Want};
use crate::verdict::Limits;

/// Flags of `run`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The scene, a JSON file as data/scenes/figure1.json.
    #[arg(value_name = "SCENE.json")]
    scene: PathBuf,
}

/// Pixels per inch of PNG figures: print quality.
const DPI: f64 = 300.0;

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let text = std::fs::read_to_string(&self.scene)
            .map_err(|cause| Error::io(self.scene.display(), format!("cannot read the scene: {cause}")))?;
        let scene = Scene::read(&text)?;
        let folder = common.output.clone().unwrap_or_else(|| self.default_folder());
        std::fs::create_dir_all(&folder).map_err(|cause| {
            Error::io(
                folder.display(),
                format!("cannot make the output folder: {cause}; choose one with --output"),
            )
        })?;
        let work = Work::new(&scene, common.limits());
        let mut summary = Summary::default();
        for want in scene.want() {
            let path = folder.join(want.file_name());
            write_output(Some(&path), &work.bytes(*want)?)?;
            summary.add(*want, &path, &work);
        }
        let document = summary.document(&scene);
        let format = common.format.unwrap_or(DocumentFormat::Text).into();
        write_output(None, document.render(format)?.as_bytes())
    }

    /// `out/` and the scene's name.
    fn default_folder(&self) -> PathBuf {
        Path::new("out").join(self.scene.file_stem().unwrap_or_default())
    }
}

/// What the products are made of, each part computed when first asked for.
struct Work<'a> {
    scene: &'a Scene,
    limits: Limits,
    verdicts: OnceCell<Verdicts>,
    curves: OnceCell<Vec<Curve>>,
    documents: [OnceCell<Document>; 5],
    figures: [OnceCell<String>; 2],
}

impl<'a> Work<'a> {
    fn new(scene: &'a Scene, limits: Limits) -> Self {
        let (verdicts, curves) = (OnceCell::new(), OnceCell::new());
        Work { scene, limits, verdicts, curves, documents: Default::default(), figures: Default::default() }
    }

    /// The bytes of one product's file.
    fn bytes(&self, want: Want) -> Result<Vec<u8>> {
        let text = |format| Ok(self.document(want.product)?.render(format)?.into_bytes());
        match want.format {
            Format::Svg => Ok(self.figure(want.product)?.clone().into_bytes()),
            Format::Png => png::raster(self.figure(want.product)?, DPI),
            Format::Json => text(document::Format::Json),
            Format::Csv => text(document::Format::Csv),
            Format::Latex => text(document::Format::Latex),
            Format::Text => text(document::Format::Text),
        }
    }

    fn document(&self, product: Product) -> Result<&Document> {
        let slot = match product {
            Product::Map => 0,
            Product::Curves => 1,
            Product::Compare => 2,
            Product::Proposition => 3,
            Product::Polynomial => 4,
            Product::Figure | Product::Overlay => unreachable!("a figure is no document"),
        };
        once(&self.documents[slot], || self.make_document(product))
    }

    fn make_document(&self, product: Product) -> Result<Document> {
        let scene = self.scene;
        match product {
            Product::Map => {
                Ok(map::document(&scene.lambda1()?, &scene.lambda2()?, scene.grid()?, self.verdicts()?))
            }
            Product::Curves => {
                Ok(curves::document(&scene.lambda1()?, scene.grid()?, &scene.families()?, self.curves()?))
            }
            Product::Compare => {
                let (lambda1, lambda2, grid) = (scene.lambda1()?, scene.lambda2()?, scene.grid()?);
                compare::over_grid(&lambda1, &lambda2, grid, &scene.tolerance()?, &self.limits)
            }
            Product::Proposition => proposition::document(scene.max()),
            Product::Polynomial => {
                let (p, q) = scene.ratio()?;
                polynomial::check_default(p, q)?;
                Ok(crate::report::polynomial::document(p, q))
            }
            Product::Figure | Product::Overlay => unreachable!("a figure is no document"),
        }
    }

    /// The SVG of a figure.
    fn figure(&self, product: Product) -> Result<&String> {
        let slot = &self.figures[usize::from(product == Product::Overlay)];
        once(slot, || {
            let (window, cloud) = (self.window()?, self.verdicts()?.cloud(self.scene.grid()?));
            let draw: fn(&Window, &plane::Cloud, &[Curve], &str) -> Figure =
                if product == Product::Overlay { plane::overlay } else { plane::side_by_side };
            Ok(draw(&window, &cloud, self.curves()?, self.scene.title()).svg())
        })
    }

    fn verdicts(&self) -> Result<&Verdicts> {
        once(&self.verdicts, || {
            let scene = self.scene;
            Verdicts::compute(&scene.lambda1()?, &scene.lambda2()?, scene.grid()?, &self.limits)
        })
    }

    fn curves(&self) -> Result<&Vec<Curve>> {
        once(&self.curves, || {
            curves::sample(&self.scene.lambda1()?, &self.scene.families()?, &self.window()?)
        })
    }

    fn window(&self) -> Result<Window> {
        let [h1, h2] = self.scene.grid()?.ranges();
        Ok(curves::window(h1, h2))
    }
}

/// `OnceCell::get_or_init` for a computation that can fail.
fn once<T>(cell: &OnceCell<T>, make: impl FnOnce() -> Result<T>) -> Result<&T> {
    if cell.get().is_none() {
        let value = make()?;
        // Nobody else can have filled it: the cell is not shared between threads.
        let _ = cell.set(value);
    }
    Ok(cell.get().expect("just filled"))
}

/// What was written, for the closing message.
#[derive(Default)]
struct Summary {
    lines: Vec<String>,
    products: Vec<serde_json::Value>,
}

impl Summary {
    fn add(&mut self, want: Want, path: &Path, work: &Work) {
        let file = path.display().to_string();
        self.lines.push(file.clone());
        // A product's summary is told once, with its first file.
        let known = self.products.iter().any(|p| p["product"] == want.product.name());
        if !known
            && !want.product.is_figure()
            && let Ok(document) = work.document(want.product)
        {
            self.lines.extend(document.summary_text().lines().map(|line| format!("    {line}")));
        }
        self.products.push(serde_json::json!({"product": want.product.name(), "file": file}));
    }

    fn document(self, scene: &Scene) -> Document {
        let heading = if scene.title().is_empty() { vec![] } else { vec![scene.title().to_string()] };
        let lines: Vec<String> = heading.into_iter().chain(self.lines).collect();
        Document::new("run").input("title", scene.title()).entry("products", self.products).summary(&lines)
    }
}
