//! Figures for papers: panels of layers, drawn as SVG, rasterized to PNG.
//!
//! A figure is measured in millimetres of paper; lines and letters are in points and do not grow with it. Text is
//! drawn in a built-in face, so the same figure gives the same SVG bytes wherever it is made, and the PNG is
//! rasterized from that very SVG.
//!
//! ```
//! use kickdrift::report::figure::{Axis, Figure, Layer, Panel, Stroke, png};
//! let wave = (0..=100).map(|i| f64::from(i) / 100.0).map(|t| [t, (6.0 * t).sin()]).collect();
//! let panel = Panel::new(Axis::linear("*t* (s)", 0.0, 1.0), Axis::linear("*x*", -1.1, 1.1))
//!     .titled("One oscillation")
//!     .with(Layer::lines(vec![wave], Stroke::LINE));
//! let svg = Figure::single_column(60.0).with(panel).svg();
//! assert!(svg.starts_with("<svg"));
//! let image = png::raster(&svg, 300.0)?;
//! assert_eq!(&image[1..4], b"PNG");
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
//! | `draw` | a panel into the SVG |
//! | `key` | legends and colour bars into the SVG |
//! | `marks` | layers into the SVG |
//! | `clip` | what lies in the frame |
//! | `font`, `label` | glyphs, and words made of them |
//! | `svg` | the text of the SVG |
//! | `png` | the SVG as pixels |

mod axis;
mod clip;
mod draw;
mod font;
mod key;
mod label;
mod layer;
mod layout;
mod marks;
pub mod palette;
mod panel;
pub mod png;
mod svg;

pub use axis::{Axis, Scale, Tick};
pub use layer::{Cells, Dash, Layer, Picture, Shape, Stroke};
pub use panel::{ColourBar, Note, Panel, Place};
pub use svg::Anchor;

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
        let (width, height) = (self.width_mm * svg::MM, self.height_mm * svg::MM);
        let columns = self.columns.min(self.panels.len()).max(1);
        let sites = layout::sites(&self.panels, columns, width, height);
        let mut canvas = svg::Canvas::default();
        for (panel, site) in self.panels.iter().zip(sites) {
            draw::panel(&mut canvas, panel, site);
        }
        canvas.finish(width, height, &self.title)
    }
}
