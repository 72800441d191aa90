//! The means of drawing: paths, rectangles and words, from which each file format is written.
//!
//! Lengths are points (1/72 inch), y pointing down. Coordinates of paths are whole hundredths of a point (3.5
//! micrometres), so that every format draws the very same lines.

use super::clip::Rect;
use super::font::Face;
use super::label::{Label, Placed};
use super::layer::Dash;
use super::palette::Colour;

/// Points a millimetre.
pub(crate) const MM: f64 = 72.0 / 25.4;

/// A rim of paper around letters, in 1/1000 em.
pub(crate) const HALO: f64 = 280.0;

/// A coordinate in hundredths of a point. Far outside it saturates: nobody sees the difference.
pub(crate) fn hundredths(value: f64) -> i64 {
    (value * 100.0).round().clamp(-1e12, 1e12) as i64
}

/// One move of the pen, in hundredths of a point on the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    Move(i64, i64),
    Line(i64, i64),
    /// A horizontal line to this x.
    Across(i64),
    /// A vertical line to this y.
    Along(i64),
    /// A line of no length: a dot under a round line cap.
    Dot,
    /// Back to the start of the outline.
    Close(i64, i64),
}

/// A path under construction.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Path {
    pub steps: Vec<Step>,
    at: (i64, i64),
}

impl Path {
    /// Lifts the pen to a point.
    pub(crate) fn move_to(&mut self, [x, y]: [f64; 2]) {
        self.at = (hundredths(x), hundredths(y));
        self.steps.push(Step::Move(self.at.0, self.at.1));
    }

    /// Draws to a point; nothing where it rounds to the one before.
    pub(crate) fn line_to(&mut self, [x, y]: [f64; 2]) {
        let to = (hundredths(x), hundredths(y));
        if to != self.at {
            self.at = to;
            self.steps.push(Step::Line(to.0, to.1));
        }
    }

    /// A dot under a round line cap.
    pub(crate) fn dot(&mut self, point: [f64; 2]) {
        self.move_to(point);
        self.steps.push(Step::Dot);
    }

    /// A horizontal stroke from `from` to `x`.
    pub(crate) fn horizontal(&mut self, from: [f64; 2], x: f64) {
        self.move_to(from);
        self.at.0 = hundredths(x);
        self.steps.push(Step::Across(self.at.0));
    }

    /// A vertical stroke from `from` to `y`.
    pub(crate) fn vertical(&mut self, from: [f64; 2], y: f64) {
        self.move_to(from);
        self.at.1 = hundredths(y);
        self.steps.push(Step::Along(self.at.1));
    }

    /// A closed rectangle, given by its sides.
    pub(crate) fn rectangle(&mut self, [left, top, right, bottom]: Rect) {
        self.horizontal([left, top], right);
        self.steps.extend([Step::Along(hundredths(bottom)), Step::Across(hundredths(left))]);
        self.close([left, top]);
    }

    /// The rectangles of a path that consists of nothing else, in points.
    pub(crate) fn rectangles(&self) -> impl Iterator<Item = Rect> + '_ {
        self.steps.chunks_exact(5).filter_map(|steps| match *steps {
            [Step::Move(left, top), Step::Across(right), Step::Along(bottom), ..] => {
                Some([left, top, right, bottom].map(|side| side as f64 / 100.0))
            }
            _ => None,
        })
    }

    /// Closes the outline; the pen is back where it began.
    pub(crate) fn close(&mut self, [x, y]: [f64; 2]) {
        self.at = (hundredths(x), hundredths(y));
        self.steps.push(Step::Close(self.at.0, self.at.1));
    }
}

/// How a path is drawn.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Paint {
    Fill {
        colour: Colour,
        opacity: Option<f64>,
    },
    /// A fill of rectangles beside each other, hundreds of thousands of them.
    Cells(Colour),
    Stroke(Pen),
}

/// A line's look. Joins and caps are plain unless rounded.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pen {
    pub colour: Colour,
    pub width: f64,
    pub round_joins: bool,
    pub round_caps: bool,
    /// Lengths of dashes and gaps in turn; none for an unbroken line.
    pub dashes: Vec<f64>,
}

impl Pen {
    /// An unbroken line.
    pub(crate) fn new(colour: Colour, width: f64) -> Pen {
        Pen { colour, width, round_joins: false, round_caps: false, dashes: Vec::new() }
    }

    /// Breaks the line into a pattern.
    pub(crate) fn dashed(mut self, dash: Dash) -> Pen {
        let width = self.width;
        match dash {
            Dash::Solid => self.round_joins = true,
            // Lines of no length under a round cap: dots as wide as the line.
            Dash::Dotted => (self.round_caps, self.dashes) = (true, vec![0.0, 2.4 * width]),
            Dash::Dashed => self.dashes = vec![2.0 + 2.4 * width, 1.0 + 1.4 * width],
            Dash::DashDotted => self.dashes = vec![2.5 + 3.0 * width, 1.0 + width, width, 1.0 + width],
        }
        self
    }

    /// Rounds its ends.
    pub(crate) fn capped(mut self) -> Pen {
        self.round_caps = true;
        self
    }
}

/// The side of a text that stands at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The text begins there.
    Start,
    /// The text is centred there.
    Middle,
    /// The text ends there.
    End,
}

/// How a text is set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Set {
    pub size: f64,
    pub anchor: Anchor,
    /// Degrees, counterclockwise.
    pub turn: f64,
    pub colour: Colour,
    /// Whether a rim of paper keeps the text readable over lines.
    pub halo: bool,
}

/// A label in its place.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Words {
    pub words: String,
    pub glyphs: Vec<Placed>,
    /// Where the baseline begins, is centred, or ends.
    pub at: [f64; 2],
    pub set: Set,
    /// The part of the label before that point, in em.
    before: f64,
}

impl Words {
    /// The place of a glyph in 1/1000 em from the point of the label, y pointing down.
    pub(crate) fn offset(&self, placed: &Placed) -> [f64; 2] {
        [1000.0 * (placed.x - self.before), 1000.0 * placed.y]
    }

    /// The label in pieces of one face, size and baseline, each with its letters: a letter is a glyph.
    pub(crate) fn runs(&self) -> impl Iterator<Item = (String, &[Placed])> {
        let mut letters = self.words.chars();
        let alike = |a: &Placed, b: &Placed| (a.face, a.scale, a.y) == (b.face, b.scale, b.y);
        self.glyphs.chunk_by(alike).map(move |run| (letters.by_ref().take(run.len()).collect(), run))
    }
}

/// A rectangle with its left upper corner at (x, y).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Patch {
    pub x: f64,
    pub y: f64,
    pub width: f64,
    pub height: f64,
    pub colour: Colour,
}

/// A piece of a drawing; later ones cover earlier ones.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Element {
    Path(Path, Paint),
    Patch(Patch),
    Words(Words),
    /// Clips the elements up to `Close` to the rectangle; these do not nest.
    Open(Rect),
    Close,
}

/// How letters are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Letters {
    /// As shapes in SVG, whose readers often ignore embedded fonts, as text in PDF, whose readers know them.
    #[default]
    Usual,
    Shapes,
    Text,
}

/// A sheet of paper with a drawing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Canvas {
    pub width: f64,
    pub height: f64,
    pub title: String,
    /// The program that made it with its version, and its command, where they are known.
    pub maker: Option<[String; 2]>,
    pub letters: Letters,
    pub elements: Vec<Element>,
}

impl Canvas {
    /// An empty sheet.
    pub(crate) fn new(width: f64, height: f64, title: &str) -> Canvas {
        Canvas {
            width,
            height,
            title: title.into(),
            maker: None,
            letters: Letters::default(),
            elements: Vec::new(),
        }
    }

    /// Adds a path; an empty one is left out.
    pub(crate) fn path(&mut self, path: Path, paint: Paint) {
        if !path.steps.is_empty() {
            self.elements.push(Element::Path(path, paint));
        }
    }

    /// Adds a filled path.
    pub(crate) fn fill(&mut self, path: Path, colour: Colour, opacity: Option<f64>) {
        self.path(path, Paint::Fill { colour, opacity });
    }

    /// Adds a path of rectangles beside each other.
    pub(crate) fn cells(&mut self, path: Path, colour: Colour) {
        self.path(path, Paint::Cells(colour));
    }

    /// Adds a drawn line.
    pub(crate) fn stroke(&mut self, path: Path, pen: Pen) {
        self.path(path, Paint::Stroke(pen));
    }

    /// Sets a label with its baseline at a point.
    pub(crate) fn text(&mut self, label: Label, at: [f64; 2], set: Set) {
        let share = match set.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5,
            Anchor::End => 1.0,
        };
        if !label.glyphs.is_empty() {
            let before = label.width * share;
            let (words, glyphs) = (label.words, label.glyphs);
            self.elements.push(Element::Words(Words { words, glyphs, at, set, before }));
        }
    }

    /// The glyphs in use, in the order of faces and numbers.
    pub(crate) fn glyphs(&self) -> std::collections::BTreeSet<(Face, u16)> {
        let words = self.elements.iter().filter_map(|element| match element {
            Element::Words(words) => Some(&words.glyphs),
            _ => None,
        });
        words.flatten().map(|placed| (placed.face, placed.glyph)).collect()
    }
}
