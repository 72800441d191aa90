//! Figures for papers: panels of layers, as SVG, PDF and PNG. Nothing here knows what is drawn.
//!
//! A figure is measured in millimetres of paper; lines and letters are in points and do not grow with it.
//! Words are words in a built-in face that the file carries, so the same figure gives the same bytes wherever
//! it is made, and every format draws the same primitives.
//!
//! ```
//! use kickdrift_plot::{Axis, Figure, Layer, Panel, Stroke};
//! let wave = (0..=100).map(|i| f64::from(i) / 100.0).map(|t| [t, (6.0 * t).sin()]).collect();
//! let panel = Panel::new(Axis::linear("*t* (s)", 0.0, 1.0), Axis::linear("*x*", -1.1, 1.1))
//!     .titled("One oscillation")
//!     .with(Layer::lines(vec![wave], Stroke::LINE));
//! let figure = Figure::new(85.0, 60.0).with(panel);
//! assert!(figure.svg().starts_with("<svg"));
//! assert_eq!(&figure.png(300.0).unwrap()[1..4], b"PNG");
//! ```
//!
//! | file | what is in it |
//! |---|---|
//! | `palette` | colours and gradients |
//! | `axis` | scales and ticks |
//! | `layer` | lines, dots, areas, cells |
//! | `panel` | axes, layers, notes, legend, colour bar |
//! | `layout` | where everything goes |
//! | `measure` | sizes of letters, ticks that fit, from data to the page |
//! | `draw` | a panel onto the canvas |
//! | `key` | legends and colour bars onto the canvas |
//! | `marks` | layers onto the canvas |
//! | `hatch` | strokes over areas |
//! | `clip` | what lies in the frame |
//! | `foot` | what stands below: the parameters |
//! | `font`, `label` | glyphs, and words made of them |
//! | `canvas` | paths, rectangles, words: what every format draws |
//! | `outline` | its lines and curves, for formats that draw by themselves |
//! | `svg` | the canvas as SVG |
//! | `png` | the canvas as pixels |
//! | `pdf` | the canvas as PDF |
//! | `embed`, `opentype` | the letters in it, and in the SVG |

mod axis;
mod canvas;
mod clip;
mod draw;
mod embed;
mod font;
mod foot;
mod hatch;
mod key;
mod label;
mod layer;
mod layout;
mod marks;
mod measure;
mod opentype;
mod outline;
pub mod palette;
mod panel;
mod pdf;
mod png;
mod svg;

pub use axis::{Axis, Scale, Tick};
pub use canvas::Anchor;
pub use font::font_file;
pub use foot::Foot;
pub use layer::{Cells, Dash, Hatch, Layer, Shape, Stroke};
pub use panel::{ColourBar, Note, Panel, Place};

use canvas::{Canvas, Letters};
use font::Face;
use label::{Label, wrapped};
pub use label::{literal, typeset};
use measure::TITLE;

/// The least height of a row of panels in a figure that is made narrower, in mm.
const LEAST_ROW: f64 = 45.0;
/// More than any legend, title and label take of a height, in points.
const ROOM: f64 = 1000.0;
/// The size of letters below all panels, in points.
const FOOT: f64 = 7.0;

/// A sheet of panels.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Figure {
    width_mm: f64,
    height_mm: f64,
    /// The height of a single frame, where that is given instead.
    frame_mm: Option<f64>,
    columns: usize,
    title: String,
    heading: String,
    foot: String,
    time_unit: String,
    maker: Option<[String; 2]>,
    letters: Letters,
    panels: Vec<Panel>,
}

impl Figure {
    /// A figure of the given size on paper, its panels side by side; a heading and a foot make it taller.
    pub fn new(width_mm: f64, height_mm: f64) -> Self {
        let [title, heading, foot] = [const { String::new() }; 3];
        let (columns, letters, panels) = (usize::MAX, Letters::default(), Vec::new());
        Figure {
            width_mm,
            height_mm,
            frame_mm: None,
            columns,
            title,
            heading,
            foot,
            time_unit: "time".into(),
            maker: None,
            letters,
            panels,
        }
    }

    /// A figure for the full width of a paper: 175 mm.
    pub fn double_column(height_mm: f64) -> Self {
        Self::new(175.0, height_mm)
    }

    /// A figure of one panel whose frame has this height in any width, for axes of rows; what stands around
    /// it comes on top.
    pub fn of_rows(width_mm: f64, frame_mm: f64) -> Self {
        Figure { frame_mm: Some(frame_mm), ..Self::new(width_mm, frame_mm) }
    }

    /// Puts at most so many panels side by side; further ones go below.
    pub fn columns(mut self, columns: usize) -> Self {
        self.columns = columns.max(1);
        self
    }

    /// Names the SVG: browsers show the name as a hint and read it aloud; it is never drawn.
    pub fn named(mut self, title: &str) -> Self {
        self.title = title.into();
        self
    }

    /// Changes its width. Its height follows unless it is that of rows, but no row of panels falls below 45
    /// mm that was higher.
    pub fn wide(mut self, width_mm: f64) -> Self {
        let rows = self.panels.len().div_ceil(self.columns.max(1)).max(1) as f64;
        let least = self.height_mm.min(LEAST_ROW * rows);
        self.height_mm = (self.height_mm * width_mm / self.width_mm).max(least);
        self.width_mm = width_mm;
        self
    }

    /// Puts a heading above all panels, in the notation of labels. It becomes the name, too, and takes the
    /// place of the title of a single panel.
    pub fn headed(mut self, heading: &str) -> Self {
        self.heading = heading.into();
        self.untitled().named(&Label::new(heading).words)
    }

    /// Leaves out heading and foot, for papers whose caption says both; several panels keep their titles.
    pub fn bare(self) -> Self {
        let [heading, foot] = [const { String::new() }; 2];
        Figure { heading, foot, ..self.untitled() }
    }

    /// A single panel without its title.
    fn untitled(mut self) -> Self {
        if let [panel] = &mut self.panels[..] {
            panel.title.clear();
        }
        self
    }

    /// Writes into its files the program that made them with its version, and the command.
    pub fn made_by(mut self, program: &str, command: &str) -> Self {
        self.maker = Some([program.into(), command.into()]);
        self
    }

    /// Puts small words below all panels: what it was made from.
    pub fn footed(mut self, foot: &Foot) -> Self {
        self.foot = foot.to_string();
        self
    }

    /// Names this unit at axes of times and rates, in place of "time".
    pub fn in_units_of(mut self, time: &str) -> Self {
        self.time_unit = time.into();
        self
    }

    /// Whether an axis of it is in units of time.
    pub fn has_time(&self) -> bool {
        self.panels.iter().any(Panel::has_time)
    }

    /// Draws letters as shapes in PDF, too; nobody can search them.
    pub fn outlined(mut self) -> Self {
        self.letters = Letters::Shapes;
        self
    }

    /// Writes letters as text in SVG, too, with their font: in place where fonts in a document are read, as
    /// in browsers, and not where they are ignored (librsvg, Inkscape, LibreOffice).
    pub fn in_text(mut self) -> Self {
        self.letters = Letters::Text;
        self
    }

    /// Adds a panel.
    pub fn with(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// How wide and high the frame of each panel is, in points: for words that need to know.
    pub fn frames(&self) -> Vec<[f64; 2]> {
        let (_, sites, _) = self.sites();
        let size = |[left, top, right, bottom]: [f64; 4]| [right - left, bottom - top];
        sites.into_iter().map(|site| size(site.frame)).collect()
    }

    /// The panels with their units, their places, and the height of all, in points.
    fn sites(&self) -> (Vec<Panel>, Vec<layout::Site>, f64) {
        let columns = self.columns.min(self.panels.len()).max(1);
        let panels: Vec<Panel> = self.panels.iter().map(|panel| panel.in_units_of(&self.time_unit)).collect();
        let placed = |height: f64| layout::sites(&panels, columns, self.width_mm * canvas::MM, height);
        let height = match self.frame_mm.map(|frame| frame * canvas::MM) {
            None => self.height_mm * canvas::MM,
            Some(frame) => {
                // High enough for any surroundings: they take as much of it as of the height that is wanted.
                let trial = frame + ROOM;
                let inside = placed(trial).first().map_or(frame, |site| site.frame[3] - site.frame[1]);
                frame + (trial - inside)
            }
        };
        let sites = placed(height);
        (panels, sites, height)
    }

    /// Adds notes to its panels, in their order.
    pub fn noted(mut self, notes: Vec<Vec<Note>>) -> Self {
        for (panel, notes) in self.panels.iter_mut().zip(notes) {
            panel.notes.extend(notes);
        }
        self
    }

    /// The figure as a whole SVG document: same figure, same bytes.
    pub fn svg(&self) -> String {
        svg::document(&self.drawn())
    }

    /// The figure as a PNG file on white, with `dpi` pixels an inch; `None` if `dpi` is not a positive number
    /// or makes more than 2^28 pixels.
    pub fn png(&self, dpi: f64) -> Option<Vec<u8>> {
        png::raster(&self.drawn(), dpi)
    }

    /// The figure as a PDF file of one page, its words searchable: same figure, same bytes.
    pub fn pdf(&self) -> Vec<u8> {
        pdf::document(&self.drawn())
    }

    fn drawn(&self) -> Canvas {
        let width = self.width_mm * canvas::MM;
        let (panels, sites, height) = self.sites();
        // Below the frame, or from the rim on where numbers and names take much of the width.
        let left = sites.first().map(|site| site.frame[0]).filter(|left| *left < 0.3 * width);
        let left = left.unwrap_or(layout::RIM);
        let lines =
            |markup: &str, face, size: f64| wrapped(markup, face, (width - left - layout::RIM) / size);
        let head = lines(&self.heading, Face::Semibold, TITLE);
        let foot = lines(&self.foot, Face::Roman, FOOT);
        let rows = |lines: &[Label], size: f64| {
            size * 1.2 * lines.len() as f64 + if lines.is_empty() { 0.0 } else { 4.0 }
        };
        let (above, below) = (rows(&head, TITLE), rows(&foot, FOOT));
        let mut canvas = Canvas::new(width, above + height + below, &self.title);
        canvas.letters = self.letters;
        canvas.maker.clone_from(&self.maker);
        draw::lines(&mut canvas, head, [left, layout::RIM], TITLE);
        for (panel, site) in panels.iter().zip(sites) {
            draw::panel(&mut canvas, panel, site.lowered(above));
        }
        draw::lines(&mut canvas, foot, [left, above + height], FOOT);
        canvas
    }
}
