//! Figures for papers: panels of layers, drawn as SVG, rasterized to PNG.
//!
//! A figure is measured in millimetres of paper; lines and letters are in points and do not grow with it. Text is
//! drawn in a built-in face, so the same figure gives the same bytes wherever it is made, and every format draws the
//! same primitives.
//!
//! ```
//! use kickdrift::report::figure::{Axis, Figure, Layer, Panel, Stroke};
//! let wave = (0..=100).map(|i| f64::from(i) / 100.0).map(|t| [t, (6.0 * t).sin()]).collect();
//! let panel = Panel::new(Axis::linear("*t* (s)", 0.0, 1.0), Axis::linear("*x*", -1.1, 1.1))
//!     .titled("One oscillation")
//!     .with(Layer::lines(vec![wave], Stroke::LINE));
//! let figure = Figure::single_column(60.0).with(panel);
//! assert!(figure.svg().starts_with("<svg"));
//! assert_eq!(&figure.png(300.0)?[1..4], b"PNG");
//! # Ok::<(), kickdrift::error::Error>(())
//! ```
//!
//! | file | what is in it |
//! |---|---|
//! | `palette` | colours and gradients |
//! | `axis` | scales and ticks |
//! | `layer` | lines, dots, areas, cells, pictures |
//! | `panel` | axes, layers, notes, legend, colour bar |
//! | `layout` | where everything goes |
//! | `measure` | sizes of letters, ticks that fit, from data to the page |
//! | `draw` | a panel onto the canvas |
//! | `key` | legends and colour bars onto the canvas |
//! | `marks` | layers onto the canvas |
//! | `clip` | what lies in the frame |
//! | `font`, `label` | glyphs, and words made of them |
//! | `canvas` | paths, rectangles, pictures, words: what every format draws |
//! | `outline` | its lines and curves, for formats that draw by themselves |
//! | `svg` | the canvas as SVG |
//! | `png` | the canvas as pixels |
//! | `pdf`, `embed` | the canvas as PDF, and the letters in it |

mod axis;
mod canvas;
mod clip;
mod draw;
mod embed;
mod font;
mod key;
mod label;
mod layer;
mod layout;
mod marks;
mod measure;
mod outline;
pub mod palette;
mod panel;
mod pdf;
mod png;
mod svg;

pub use axis::{Axis, Scale, Tick};
pub use canvas::Anchor;
pub use layer::{Cells, Dash, Layer, Picture, Shape, Stroke};
pub use panel::{ColourBar, Note, Panel, Place};

use crate::error::{Error, Result};
use crate::format::Format;
use canvas::Canvas;

/// A sheet of panels.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    width_mm: f64,
    height_mm: f64,
    columns: usize,
    title: String,
    panels: Vec<Panel>,
}

impl Figure {
    /// A figure of the given size on paper, its panels side by side.
    pub fn new(width_mm: f64, height_mm: f64) -> Self {
        Figure { width_mm, height_mm, columns: usize::MAX, title: String::new(), panels: Vec::new() }
    }

    /// A figure for one column of a paper: 85 mm wide.
    pub fn single_column(height_mm: f64) -> Self {
        Self::new(85.0, height_mm)
    }

    /// A figure for the full width of a paper: 175 mm.
    pub fn double_column(height_mm: f64) -> Self {
        Self::new(175.0, height_mm)
    }

    /// The same figure with at most so many panels side by side; further ones go below.
    #[must_use]
    pub fn columns(mut self, columns: usize) -> Self {
        self.columns = columns.max(1);
        self
    }

    /// The same figure with a name for the SVG: shown by browsers as a hint, read aloud, never drawn.
    #[must_use]
    pub fn named(mut self, title: &str) -> Self {
        self.title = title.into();
        self
    }

    /// The same figure with one more panel.
    #[must_use]
    pub fn with(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// The figure as a whole SVG document: same figure, same bytes.
    pub fn svg(&self) -> String {
        svg::document(&self.drawn())
    }

    /// The figure as a PNG file on white, with `dpi` pixels an inch.
    ///
    /// # Errors
    /// [`Kind::Input`](crate::error::Kind::Input) if `dpi` is not a positive number or makes more than 2^28 pixels.
    pub fn png(&self, dpi: f64) -> Result<Vec<u8>> {
        png::raster(&self.drawn(), dpi)
    }

    /// The figure as a PDF file of one page, its words searchable: same figure, same bytes.
    pub fn pdf(&self) -> Vec<u8> {
        pdf::document(&self.drawn())
    }

    /// The figure as the bytes of a file; `dpi` is for PNG alone.
    ///
    /// # Errors
    /// A format that is none of figures, and as [`Figure::png`].
    pub fn file(&self, format: Format, dpi: f64) -> Result<Vec<u8>> {
        match format {
            Format::Svg => Ok(self.svg().into_bytes()),
            Format::Pdf => Ok(self.pdf()),
            Format::Png => self.png(dpi),
            other => {
                let remedy = format!("a figure is written as {}", Format::extensions(&Format::FIGURE));
                Err(Error::input("format", other.name(), remedy))
            }
        }
    }

    fn drawn(&self) -> Canvas {
        let (width, height) = (self.width_mm * canvas::MM, self.height_mm * canvas::MM);
        let columns = self.columns.min(self.panels.len()).max(1);
        let sites = layout::sites(&self.panels, columns, width, height);
        let mut canvas = Canvas::new(width, height, &self.title);
        for (panel, site) in self.panels.iter().zip(sites) {
            draw::panel(&mut canvas, panel, site);
        }
        canvas
    }
}
