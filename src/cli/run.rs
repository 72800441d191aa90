//! `kickdrift run`: the products that a scene wants, nothing else, and what two of them share only once.

use std::cell::{OnceCell, RefCell};
use std::io::Read;
use std::path::{Path, PathBuf};

use super::args::{Common, Format as DocumentFormat, echo_grid, shown_range};
use super::plane::{DPI, Verdicts};
use super::tongues::{self, Atlas, Colour, Question, Ratios, Stiffness, Window as StepWindow};
use super::{closings, compare, curves, map, polynomial, proposition};
use crate::error::{Error, Result};
use crate::map::Products;
use crate::report::closings::DIGITS;
use crate::report::document::Document;
use crate::report::figure::{Figure, png};
use crate::report::file::{Folder, write_output};
use crate::report::map::MapArrays;
use crate::report::tongues::{Frame, Tally};
use crate::report::{document, plane};
use crate::resonance::{Curve, Window};
use crate::scene::{self, Format, Product, Scene, Want};
use crate::tongue::{Selection, Wanted};
use crate::verdict::Limits;

/// Flags of `run`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The scene, a JSON file as data/scenes/figure1.json.
    #[arg(value_name = "SCENE.json")]
    scene: PathBuf,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let scene = Scene::read(&self.text()?)?;
        let folder = Folder::make(&common.output.clone().unwrap_or_else(|| self.default_folder()))?;
        let work = Work::new(&scene, common, folder.path());
        // All products before the first file: an error leaves nothing behind.
        let contents = scene.want().iter().map(|want| work.contents(*want)).collect::<Result<Vec<_>>>()?;
        let mut summary = Summary::default();
        for (want, contents) in scene.want().iter().zip(contents) {
            let path = folder.path().join(want.file_name());
            work.write(contents, &path)?;
            summary.add(*want, &path, &work);
        }
        folder.keep();
        let document = echo(summary.document(&scene), &scene)?;
        let format = common.format.unwrap_or(DocumentFormat::Text).into();
        write_output(None, document.render(format)?.as_bytes())
    }

    /// The text of the scene file; no more of it than a scene may have.
    fn text(&self) -> Result<String> {
        let read = || {
            let mut text = String::new();
            let file = std::fs::File::open(&self.scene)?;
            file.take(scene::LONGEST as u64 + 1).read_to_string(&mut text)?;
            Ok(text)
        };
        read().map_err(|cause: std::io::Error| {
            let remedy = "name a scene file, such as data/scenes/figure1.json";
            Error::io(self.scene.display(), format!("cannot read the scene ({cause}): {remedy}"))
        })
    }

    /// `out/` and the scene's name.
    fn default_folder(&self) -> PathBuf {
        Path::new("out").join(self.scene.file_stem().unwrap_or_default())
    }
}

/// What the products are made of, each part computed when first asked for.
struct Work<'a> {
    scene: &'a Scene,
    common: &'a Common,
    limits: Limits,
    threads: usize,
    /// Where the arrays of the map go, if they are wanted.
    archive: Option<PathBuf>,
    verdicts: OnceCell<Verdicts>,
    /// Filled with the verdicts, taken when written.
    arrays: RefCell<Option<MapArrays>>,
    curves: OnceCell<Vec<Curve>>,
    documents: [OnceCell<Document>; 7],
    /// What the tongues told, once they were written.
    tongues: OnceCell<Tally>,
    figures: [OnceCell<String>; 3],
}

impl<'a> Work<'a> {
    fn new(scene: &'a Scene, common: &'a Common, folder: &Path) -> Self {
        let (limits, threads) = (common.limits(), common.threads());
        let arrays = scene.want().iter().find(|want| want.format == Format::Npz);
        Work {
            scene,
            common,
            limits,
            threads,
            archive: arrays.map(|want| folder.join(want.file_name())),
            verdicts: OnceCell::new(),
            arrays: RefCell::default(),
            curves: OnceCell::new(),
            documents: Default::default(),
            tongues: OnceCell::new(),
            figures: Default::default(),
        }
    }

    /// One product, computed: its bytes, or nothing for arrays, which are on the disk already.
    fn contents(&self, want: Want) -> Result<Option<Vec<u8>>> {
        if want.format == Format::Npz { self.verdicts().map(|_| None) } else { self.bytes(want).map(Some) }
    }

    /// Writes one product's file.
    fn write(&self, contents: Option<Vec<u8>>, path: &Path) -> Result<()> {
        match contents {
            Some(bytes) => write_output(Some(path), &bytes),
            None => self.arrays.take().map_or(Ok(()), MapArrays::finish),
        }
    }

    /// The bytes of one product's file, where they fit memory.
    fn bytes(&self, want: Want) -> Result<Vec<u8>> {
        let text = |format| Ok(self.document(want.product)?.render(format)?.into_bytes());
        if want.product == Product::Tongues {
            return self.tongues(want.format);
        }
        match want.format {
            Format::Svg => Ok(self.figure(want.product)?.clone().into_bytes()),
            Format::Png => png::raster(self.figure(want.product)?, DPI),
            Format::Json => text(document::Format::Json),
            Format::Csv => text(document::Format::Csv),
            Format::Latex => text(document::Format::Latex),
            Format::Text => text(document::Format::Text),
            Format::Npz => unreachable!("arrays are streamed"),
        }
    }

    fn document(&self, product: Product) -> Result<&Document> {
        let slot = match product {
            Product::Map => 0,
            Product::Curves => 1,
            Product::Compare => 2,
            Product::Proposition => 3,
            Product::Polynomial => 4,
            Product::Closings => 5,
            Product::Survey => 6,
            Product::Tongues => unreachable!("tongues are streamed"),
            Product::Atlas | Product::Figure | Product::Overlay => unreachable!("a figure is no document"),
        };
        once(&self.documents[slot], || self.make_document(product))
    }

    fn make_document(&self, product: Product) -> Result<Document> {
        let scene = self.scene;
        match product {
            Product::Map => {
                let Verdicts { tally, marked } = self.verdicts()?;
                Ok(map::document(&scene.grid()?, scene.range()?, tally, marked))
            }
            Product::Curves => {
                Ok(curves::document(&scene.lambda1()?, scene.range()?, &scene.families()?, self.curves()?))
            }
            Product::Compare => {
                compare::over_grid(&scene.grid()?, scene.range()?, &scene.tolerance()?, &self.limits)
            }
            Product::Proposition => proposition::document(scene.max()),
            Product::Polynomial => {
                let (p, q) = scene.ratio()?;
                polynomial::check_default(p, q)?;
                Ok(crate::report::polynomial::document(p, q))
            }
            Product::Closings => {
                closings::Question::new(self.ratios()?, None, scene.rho_range()?, 400, DIGITS)?
                    .document(self.common, false)
            }
            Product::Survey => {
                let max_sum = scene.document().max_sum.expect("the scene was checked");
                tongues::survey(max_sum, &self.stiffness()?.rho, tongues::THINNEST)
            }
            Product::Tongues => unreachable!("tongues are streamed"),
            Product::Atlas | Product::Figure | Product::Overlay => unreachable!("a figure is no document"),
        }
    }

    /// The SVG of a figure.
    fn figure(&self, product: Product) -> Result<&String> {
        let slot = match product {
            Product::Figure => 0,
            Product::Overlay => 1,
            _ => return once(&self.figures[2], || self.atlas()),
        };
        once(&self.figures[slot], || {
            let (window, cloud) = (self.window()?, self.verdicts()?.cloud(&self.scene.grid()?));
            let draw: fn(&Window, &plane::Cloud, &[Curve], &str) -> Figure =
                if product == Product::Overlay { plane::overlay } else { plane::side_by_side };
            Ok(draw(&window, &cloud, self.curves()?, self.scene.title()).svg())
        })
    }

    /// The tongues' bytes in one format.
    fn tongues(&self, format: Format) -> Result<Vec<u8>> {
        let growth = self.scene.document().max_sum.is_none();
        let question = self.question(Wanted { growth, ..Wanted::all() })?;
        let (bytes, tally) = tongues::bytes(&question, self.common, format)?;
        // Every format tells the same.
        let _ = self.tongues.set(tally);
        Ok(bytes)
    }

    fn atlas(&self) -> Result<String> {
        let colour = match self.scene.document().colour.as_deref() {
            None | Some("family") => Colour::Family,
            Some("growth") => Colour::Growth,
            Some(other) => return Err(Error::input("colour", other, "choose family or growth")),
        };
        let question = self.question(colour.needs())?;
        Ok(Atlas::new(&question, colour, Some(self.scene.families()?))?.figure(self.common)?.svg())
    }

    fn question(&self, wanted: Wanted) -> Result<Question> {
        let window = self
            .scene
            .window()?
            .map_or_else(StepWindow::default, |[h1, h2]| StepWindow { h1: Some(h1), h2: Some(h2) });
        let frame = Frame { wanted, ..Frame::default() };
        Question::new(self.ratios()?, self.stiffness()?, window, Selection::default(), frame)
    }

    /// All ratios where a sum is given, else the one.
    fn ratios(&self) -> Result<Ratios> {
        match self.scene.document().max_sum {
            Some(max_sum) => Ratios::up_to(max_sum),
            None => self.scene.ratio().map(|(p, q)| Ratios::One(p, q)),
        }
    }

    fn stiffness(&self) -> Result<Stiffness> {
        let given = self.scene.document();
        let lambda1 = given.lambda1.as_ref().map(|_| self.scene.lambda1()).transpose()?;
        let lambda2 = given.lambda2.as_ref().map(|_| self.scene.lambda2()).transpose()?;
        Stiffness::new(self.scene.rho()?, lambda1, lambda2)
    }

    /// The lines on a product, for the closing message.
    fn summary(&self, product: Product) -> Option<String> {
        match product {
            Product::Tongues => {
                let question = self.question(Wanted::default()).ok()?;
                Some(self.tongues.get()?.lines(&question.words()).join("\n"))
            }
            _ if product.is_figure() => None,
            _ => self.document(product).ok().map(|document| document.summary_text().to_string()),
        }
    }

    fn verdicts(&self) -> Result<&Verdicts> {
        once(&self.verdicts, || {
            let grid = self.scene.grid()?;
            let arrays = self.archive.as_ref().map(|path| MapArrays::new(path, &grid, Products::default()));
            let mut arrays = arrays.transpose()?;
            let verdicts = Verdicts::compute(&grid, self.threads, &self.limits, arrays.as_mut())?;
            self.arrays.replace(arrays);
            Ok(verdicts)
        })
    }

    fn curves(&self) -> Result<&Vec<Curve>> {
        once(&self.curves, || {
            curves::sample(&self.scene.lambda1()?, &self.scene.families()?, &self.window()?)
        })
    }

    fn window(&self) -> Result<Window> {
        let [h1, h2] = self.scene.range()?.ranges();
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
        if let Some(summary) = work.summary(want.product).filter(|_| !known) {
            self.lines.extend(summary.lines().map(|line| format!("    {line}")));
        }
        self.products.push(serde_json::json!({"product": want.product.name(), "file": file}));
    }

    fn document(self, scene: &Scene) -> Document {
        let heading = if scene.title().is_empty() { vec![] } else { vec![scene.title().to_string()] };
        let lines: Vec<String> = heading.into_iter().chain(self.lines).collect();
        Document::new("run").input("title", scene.title()).entry("products", self.products).summary(&lines)
    }
}

/// Echoes what the scene gives, exactly.
fn echo(mut document: Document, scene: &Scene) -> Result<Document> {
    let given = scene.document();
    if given.lambda1.is_some() {
        document = document.input("lambda1", scene.lambda1()?);
    }
    if given.lambda2.is_some() {
        document = document.input("lambda2", scene.lambda2()?);
    }
    if let Ok(range) = scene.range() {
        document = echo_grid(document, range);
    }
    if given.families.is_some() {
        document = curves::echo(document, &scene.families()?);
    }
    if given.tolerance.is_some() {
        document = document.input("tolerance", scene.tolerance()?);
    }
    if given.ratio.is_some() {
        let (p, q) = scene.ratio()?;
        document = document.input("ratio", format!("{p}/{q}"));
    }
    if let Some(max) = given.max {
        document = document.input("max", max);
    }
    if let Some(max_sum) = given.max_sum {
        document = document.input("max_sum", max_sum);
    }
    if let Some(rho) = scene.rho()? {
        document = document.input("rho", rho);
    }
    if let Some([h1, h2]) = scene.window()? {
        document = document.input("window_h1", shown_range(&h1)).input("window_h2", shown_range(&h2));
    }
    if let Some(colour) = &given.colour {
        document = document.input("colour", colour);
    }
    if given.rho_range.is_some() {
        let (lo, hi) = scene.rho_range()?;
        document = document.input("rho_range", format!("{lo}..{hi}"));
    }
    let want: Vec<String> = scene.want().iter().map(Want::file_name).collect();
    Ok(document.input("want", want.join(", ")))
}
