//! The products of a scene, computed.

use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use plot::Figure;

use super::tongues;
use crate::cli::args::{Common, TO_SEE_ROWS};
use crate::cli::map;
use crate::cli::paper::Paper;
use crate::cli::plane::Verdicts;
use crate::cli::tongues as answers;
use crate::error::Result;
use crate::format::Format;
use crate::map::Products;
use crate::number::rational::ratio;
use crate::question::{Closings, Compare, Curves, Polynomial, Proposition, Question, Survey, THINNEST};
use crate::report::closings::DIGITS;
use crate::report::document::Document;
use crate::report::file::write_output;
use crate::report::map::MapArrays;
use crate::report::plane;
use crate::report::tongues::Tally;
use crate::resonance::{Curve, Families, Window};
use crate::scene::{FAMILIES, Product, Scene, Want};
use crate::tongue::Wanted;
use crate::verdict::Limits;

/// What the products are made of, each part computed when first asked for.
pub struct Work<'a> {
    scene: &'a Scene,
    common: &'a Common,
    paper: &'a Paper,
    limits: Limits,
    threads: usize,
    /// Where the arrays of the map go, if they are wanted.
    archive: Option<PathBuf>,
    verdicts: OnceCell<Verdicts>,
    /// Filled with the verdicts, taken when written.
    arrays: RefCell<Option<MapArrays>>,
    curves: OnceCell<Vec<Curve>>,
    documents: Made<Document>,
    /// What stands out among the tongues, once they were written.
    tongues: OnceCell<Tally>,
    figures: Made<Figure>,
}

impl<'a> Work<'a> {
    pub fn new(scene: &'a Scene, common: &'a Common, paper: &'a Paper, folder: &Path) -> Self {
        let (limits, threads) = (common.limits(), common.threads());
        let arrays = scene.want.iter().find(|want| want.format == Format::Npz);
        Work {
            scene,
            common,
            paper,
            limits,
            threads,
            archive: arrays.map(|want| folder.join(want.file_name())),
            verdicts: OnceCell::new(),
            arrays: RefCell::default(),
            curves: OnceCell::new(),
            documents: Made::default(),
            tongues: OnceCell::new(),
            figures: Made::default(),
        }
    }

    /// One product, computed: its bytes, or nothing for arrays, which are on the disk already.
    pub fn contents(&self, want: Want) -> Result<Option<Vec<u8>>> {
        if want.format == Format::Npz { self.verdicts().map(|_| None) } else { self.bytes(want).map(Some) }
    }

    /// Writes one product's file.
    pub fn write(&self, contents: Option<Vec<u8>>, path: &Path) -> Result<()> {
        match contents {
            Some(bytes) => write_output(Some(path), &bytes),
            None => self.arrays.take().map_or(Ok(()), MapArrays::finish),
        }
    }

    /// The bytes of one product's file, where they fit memory.
    fn bytes(&self, want: Want) -> Result<Vec<u8>> {
        let text = |format| Ok(self.document(want.product)?.render_with(format, TO_SEE_ROWS)?.into_bytes());
        if want.product == Product::Tongues {
            return self.tongues(want.format);
        }
        match want.format {
            drawn if drawn.is_figure() => {
                self.paper.bytes(self.figure(want.product)?.as_ref().clone(), drawn, &self.common.command)
            }
            Format::Npz => unreachable!("arrays are streamed"),
            of_document => text(of_document),
        }
    }

    fn document(&self, product: Product) -> Result<Rc<Document>> {
        self.documents.get(product, || match product {
            Product::Map => {
                let Verdicts { tally, marked } = self.verdicts()?;
                Ok(map::document(&self.scene.grid()?, self.scene.range()?, tally, marked))
            }
            _ => self.asked(product),
        })
    }

    /// What a scene asks by wanting a product that one document is.
    fn asked(&self, product: Product) -> Result<Document> {
        let (scene, work) = (self.scene, self.common.work());
        match product {
            Product::Curves => {
                let Families { a, b, samples } = self.families();
                let [step1, step2] = scene.range()?.steps().clone().map(Some);
                let [h1_range, h2_range] = scene.range()?.ranges().clone();
                let lambda1 = scene.lambda1()?.clone();
                Curves { lambda1, step1, step2, h1_range, h2_range, a, b, samples }.ask(&work)
            }
            Product::Compare => {
                let (lambda1, lambda2) = scene.stiffnesses()?;
                let tolerance = scene.tolerance.clone().unwrap_or_else(|| ratio(1, 20));
                Compare::over_grid([&lambda1, &lambda2], scene.range()?, tolerance).ask(&work)
            }
            Product::Proposition => Proposition { max: scene.max.unwrap_or(60) }.ask(&work),
            Product::Polynomial => Polynomial { ratio: scene.ratio()? }.ask(&work),
            Product::Closings => {
                let rho_range = scene.rho_range.clone().unwrap_or_else(|| (ratio(1, 10_000), ratio(100, 1)));
                let (ratio, max_sum) = tongues::ratios(scene)?.fields();
                Closings { ratio, max_sum, m: None, rho_range, samples: 400, digits: DIGITS }.ask(&work)
            }
            Product::Survey => {
                let max_sum = scene.max_sum.expect("the scene was checked");
                Survey { max_sum, rho: tongues::stiffness(scene)?.rho, thinnest: THINNEST }.ask(&work)
            }
            Product::Map | Product::Tongues | Product::Atlas | Product::Figure | Product::Overlay => {
                unreachable!("of the grid, streamed, or drawn")
            }
        }
    }

    /// A figure.
    fn figure(&self, product: Product) -> Result<Rc<Figure>> {
        self.figures.get(product, || {
            if product == Product::Atlas {
                return tongues::atlas(self.scene, self.common);
            }
            let (window, cloud) = (self.window()?, self.verdicts()?.cloud(&self.scene.grid()?));
            let draw = if product == Product::Overlay { plane::overlay } else { plane::side_by_side };
            let range = self.scene.range()?;
            let foot = plane::parameters(self.scene.grid()?.lambdas(), range.ranges(), range.steps());
            Ok(draw(&window, &cloud, self.curves()?, &self.scene.title).footed(&foot))
        })
    }

    /// The tongues' bytes in one format.
    fn tongues(&self, format: Format) -> Result<Vec<u8>> {
        let growth = self.scene.max_sum.is_none();
        let question = tongues::question(self.scene, Wanted { growth, ..Wanted::all() })?;
        let mut bytes = Vec::new();
        let tally = answers::put(&question, self.common, format, &mut bytes)?;
        // It is the same in every format.
        let _ = self.tongues.set(tally);
        Ok(bytes)
    }

    /// The lines on a product, for the closing message.
    pub fn summary(&self, product: Product) -> Option<String> {
        match product {
            Product::Tongues => {
                let question = tongues::question(self.scene, Wanted::default()).ok()?;
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
        once(&self.curves, || self.families().curves(self.scene.lambda1()?, &self.window()?))
    }

    fn families(&self) -> Families {
        self.scene.families.unwrap_or(FAMILIES)
    }

    fn window(&self) -> Result<Window> {
        let [h1, h2] = self.scene.range()?.ranges();
        Ok(Window::new(h1, h2))
    }
}

/// What was made for some products, to be written in more than one format.
struct Made<T>(RefCell<BTreeMap<Product, Rc<T>>>);

impl<T> Default for Made<T> {
    fn default() -> Self {
        Made(RefCell::default())
    }
}

impl<T> Made<T> {
    /// What is there, or is made now.
    fn get(&self, product: Product, make: impl FnOnce() -> Result<T>) -> Result<Rc<T>> {
        if let Some(known) = self.0.borrow().get(&product) {
            return Ok(known.clone());
        }
        let made = Rc::new(make()?);
        self.0.borrow_mut().insert(product, made.clone());
        Ok(made)
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
