//! The products of a scene, computed.

use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use plot::Figure;

use crate::cli::args::{Common, TO_SEE_ROWS};
use crate::cli::paper::Paper;
use clocks::map::{Grid, Products};
use clocks::resonance::{Curve, Window};
use documents::format::Format;
use documents::question::{Colour, Form, Map, Product, Question, Scene, Want};
use documents::report::document::Document;
use documents::report::file::write_output;
use documents::report::map::{MapArrays, Marked, Rows, marked};
use documents::report::plane::{self, Cloud};
use documents::report::{map, tongues::TongueTally};
use number::error::Result;

/// The parts that the products are made of, each computed when first asked for.
pub struct Work<'a> {
    scene: &'a Scene,
    common: &'a Common,
    paper: &'a Paper,
    /// Where the arrays of the map go, if they are wanted.
    archive: Option<PathBuf>,
    verdicts: OnceCell<Verdicts>,
    /// Filled with the verdicts, taken when written.
    arrays: RefCell<Option<MapArrays>>,
    curves: OnceCell<Vec<Curve>>,
    documents: Made<Document>,
    /// Counts and extremes of the tongues, once they were written.
    tongues: OnceCell<TongueTally>,
    figures: Made<Figure>,
}

/// Every pair of the grid decided: the counts, and the pairs that are not plainly stable, in the order of h1,
/// then h2.
struct Verdicts {
    map: Map,
    grid: Grid,
    tally: map::MapTally,
    marked: Vec<Marked>,
}

impl<'a> Work<'a> {
    pub fn new(scene: &'a Scene, common: &'a Common, paper: &'a Paper, folder: &Path) -> Self {
        let arrays = scene.want.iter().find(|want| want.format == Format::Npz);
        Work {
            scene,
            common,
            paper,
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
    fn bytes(&self, Want { product, format }: Want) -> Result<Vec<u8>> {
        if product == Product::Tongues {
            return self.tongues(format);
        }
        if format.is_figure() {
            let figure = self.figure(product)?.as_ref().clone();
            return self.paper.bytes(figure, format, &self.common.command);
        }
        Ok(self.document(product)?.render_with(format, TO_SEE_ROWS)?.into_bytes())
    }

    fn document(&self, product: Product) -> Result<Rc<Document>> {
        self.documents.get(product, || {
            if product != Product::Map {
                return self.scene.ask(product, &self.common.work());
            }
            let Verdicts { map, grid, tally, marked } = self.verdicts()?;
            Ok(map.document(tally).long_rows(Rows::new(grid, Products::default()).table(marked)))
        })
    }

    fn figure(&self, product: Product) -> Result<Rc<Figure>> {
        self.figures.get(product, || {
            if product == Product::Atlas {
                let colour = self.scene.colour.unwrap_or(Colour::Family);
                return self.scene.tongues()?.atlas(colour, Some(self.scene.families()), &self.common.work());
            }
            let Verdicts { map, grid, marked, .. } = self.verdicts()?;
            let unstable = marked.iter().filter(|pair| !pair.decision.verdict.is_stable());
            let pairs = unstable.map(|pair| (pair.i as u32, pair.j as u32)).collect();
            let cloud = Cloud { spacing: [grid.steps().0.to_f64(), grid.steps().1.to_f64()], pairs };
            let window = Window::new(&map.h1_range, &map.h2_range);
            let curves = once(&self.curves, || self.scene.families().curves(&map.lambda1, &window))?;
            let draw = if product == Product::Overlay { plane::overlay } else { plane::side_by_side };
            Ok(draw(&window, &cloud, curves, &self.scene.title).footed(&map.foot()))
        })
    }

    /// The tongues' bytes in one format.
    fn tongues(&self, format: Format) -> Result<Vec<u8>> {
        let (mut bytes, form) = (Vec::new(), Form { format, float: self.common.float, to_see: TO_SEE_ROWS });
        let tally = self.scene.tongues()?.write(&self.common.work(), form, &mut bytes)?;
        // It is the same in every format.
        let _ = self.tongues.set(tally);
        Ok(bytes)
    }

    /// The lines on a product, for the closing message.
    pub fn summary(&self, product: Product) -> Option<String> {
        match product {
            Product::Tongues => {
                let words = self.scene.tongues().and_then(|tongues| tongues.words()).ok()?;
                Some(self.tongues.get()?.lines(&words).join("\n"))
            }
            _ if product.is_figure() => None,
            _ => self.document(product).ok().map(|document| document.summary_text().to_string()),
        }
    }

    fn verdicts(&self) -> Result<&Verdicts> {
        once(&self.verdicts, || {
            let map = self.scene.map()?;
            let grid = map.grid()?;
            let arrays = self.archive.as_ref().map(|path| MapArrays::new(path, &grid, Products::default()));
            let (mut arrays, mut tally, mut all) =
                (arrays.transpose()?, map::MapTally::default(), Vec::new());
            map.each(&grid, &self.common.work(), |band| {
                tally.add(&grid, &band);
                all.extend(marked(&grid, &band));
                arrays.as_mut().map_or(Ok(()), |arrays| arrays.add(&grid, &band))
            })?;
            self.arrays.replace(arrays);
            Ok(Verdicts { map, grid, tally, marked: all })
        })
    }
}

/// Documents or figures of products, kept to be written in more than one format.
struct Made<T>(RefCell<BTreeMap<Product, Rc<T>>>);

impl<T> Default for Made<T> {
    fn default() -> Self {
        Made(RefCell::default())
    }
}

impl<T> Made<T> {
    /// The one that is kept, or is made now.
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
