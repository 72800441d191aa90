//! The SVG text: numbers, paths, glyphs. Lengths are points (1/72 inch), y pointing down.
//!
//! Every coordinate is a whole number of hundredths of a point (3.5 micrometres) and is written with as few
//! letters as possible; path data is relative, computed in integers, so that nothing drifts.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::font::Face;
use super::label::Label;
use super::palette::{Colour, WHITE};

/// Points a millimetre.
pub(super) const MM: f64 = 72.0 / 25.4;

/// A coordinate in hundredths of a point. Far outside it saturates: nobody sees the difference.
fn hundredths(value: f64) -> i64 {
    (value * 100.0).round().clamp(-1e12, 1e12) as i64
}

/// A number with at most two decimals and no letter to spare.
pub(super) fn number(value: f64) -> String {
    let mut text = String::new();
    put(&mut text, hundredths(value));
    text
}

fn put(text: &mut String, value: i64) {
    let (whole, part) = (value.unsigned_abs() / 100, value.unsigned_abs() % 100);
    if value < 0 {
        text.push('-');
    }
    if whole > 0 || part == 0 {
        write!(text, "{whole}").expect("writing to a String does not fail");
    }
    if part > 0 {
        let digits = format!(".{part:02}");
        text.push_str(digits.trim_end_matches('0'));
    }
}

/// Path data under construction.
#[derive(Default)]
pub(super) struct Path {
    data: String,
    at: (i64, i64),
    /// The command that a bare pair of numbers would repeat.
    implied: char,
}

impl Path {
    pub(super) fn is_empty(&self) -> bool {
        self.data.is_empty()
    }

    /// Lifts the pen to a point.
    pub(super) fn move_to(&mut self, [x, y]: [f64; 2]) {
        self.step('m', hundredths(x), hundredths(y));
        // Behind a move, a bare pair is a line.
        self.implied = 'l';
    }

    /// Draws to a point; nothing where it rounds to the one before.
    pub(super) fn line_to(&mut self, [x, y]: [f64; 2]) {
        let to = (hundredths(x), hundredths(y));
        if to != self.at {
            self.step('l', to.0, to.1);
        }
    }

    /// A dot under a round line cap: a line of no length.
    pub(super) fn dot(&mut self, point: [f64; 2]) {
        self.move_to(point);
        self.data.push_str("h0");
        self.implied = 'h';
    }

    /// A horizontal stroke from `from` to `x`.
    pub(super) fn horizontal(&mut self, from: [f64; 2], x: f64) {
        self.move_to(from);
        self.along('h', hundredths(x) - self.at.0);
        self.at.0 = hundredths(x);
    }

    /// A vertical stroke from `from` to `y`.
    pub(super) fn vertical(&mut self, from: [f64; 2], y: f64) {
        self.move_to(from);
        self.along('v', hundredths(y) - self.at.1);
        self.at.1 = hundredths(y);
    }

    /// Closes the outline; the pen is back where it began.
    pub(super) fn close(&mut self, start: [f64; 2]) {
        self.data.push('z');
        self.at = (hundredths(start[0]), hundredths(start[1]));
        self.implied = 'z';
    }

    fn along(&mut self, command: char, length: i64) {
        self.data.push(command);
        put(&mut self.data, length);
        self.implied = command;
    }

    fn step(&mut self, command: char, x: i64, y: i64) {
        let (dx, dy) = (x - self.at.0, y - self.at.1);
        if self.implied != command {
            self.data.push(command);
        } else if dx >= 0 {
            self.data.push(' ');
        }
        put(&mut self.data, dx);
        if dy >= 0 {
            self.data.push(' ');
        }
        put(&mut self.data, dy);
        (self.at, self.implied) = ((x, y), command);
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
#[derive(Clone, Copy)]
pub(super) struct Set {
    pub size: f64,
    pub anchor: Anchor,
    /// Degrees, counterclockwise.
    pub turn: f64,
    pub colour: Colour,
    /// Whether a rim of paper keeps the text readable over lines.
    pub halo: bool,
}

/// The drawing so far.
#[derive(Default)]
pub(super) struct Canvas {
    body: String,
    glyphs: BTreeSet<(Face, u16)>,
    clips: usize,
}

impl Canvas {
    /// Adds a finished element or tag.
    pub(super) fn raw(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }

    /// Adds a path with the attributes given; an empty one is left out.
    pub(super) fn path(&mut self, path: &Path, attributes: &str) {
        if !path.is_empty() {
            let data = &path.data;
            self.raw(&format!("<path {attributes} d=\"{data}\"/>"));
        }
    }

    /// Opens a group that shows only what lies in the rectangle; [`Canvas::close`] ends it.
    pub(super) fn open_clipped(&mut self, [left, top, right, bottom]: [f64; 4]) {
        self.clips += 1;
        let name = format!("box{}", self.clips);
        let (x, y, w, h) = (number(left), number(top), number(right - left), number(bottom - top));
        let shape = format!("<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"/>");
        self.raw(&format!("<clipPath id=\"{name}\">{shape}</clipPath>\n<g clip-path=\"url(#{name})\">"));
    }

    /// Ends a group.
    pub(super) fn close(&mut self) {
        self.raw("</g>");
    }

    /// Sets a label with its baseline at (x, y).
    pub(super) fn text(&mut self, label: &Label, [x, y]: [f64; 2], set: Set) {
        if label.glyphs.is_empty() {
            return;
        }
        let before = label.width
            * match set.anchor {
                Anchor::Start => 0.0,
                Anchor::Middle => 0.5,
                Anchor::End => 1.0,
            };
        let turn = if set.turn == 0.0 { String::new() } else { format!(" rotate({})", number(-set.turn)) };
        // Glyphs are drawn in units of 1/1000 em.
        let scale = set.size / 1000.0;
        let mut uses = String::new();
        for placed in &label.glyphs {
            self.glyphs.insert((placed.face, placed.glyph));
            let (gx, gy) = (number(1000.0 * (placed.x - before)), number(1000.0 * placed.y));
            let scaled =
                if placed.scale == 1.0 { String::new() } else { format!(" scale({})", placed.scale) };
            let name = glyph_name(placed.face, placed.glyph);
            let place = format!("translate({gx} {gy}){scaled}");
            write!(uses, "<use xlink:href=\"#{name}\" transform=\"{place}\"/>").expect("a String takes all");
        }
        let frame = format!("transform=\"translate({} {}){turn} scale({scale})\"", number(x), number(y));
        if set.halo {
            let rim =
                format!("fill=\"{WHITE}\" stroke=\"{WHITE}\" stroke-width=\"280\" stroke-linejoin=\"round\"");
            self.raw(&format!("<g aria-hidden=\"true\" {rim} {frame}>{uses}</g>"));
        }
        let words = escaped(&label.words);
        self.raw(&format!(
            "<g role=\"img\" aria-label=\"{words}\" fill=\"{}\" {frame}>{uses}</g>",
            set.colour
        ));
    }

    /// The whole document, on white paper of the size given.
    pub(super) fn finish(self, width: f64, height: f64, title: &str) -> String {
        let (w, h) = (number(width), number(height));
        let (w_mm, h_mm) = (number(width / MM), number(height / MM));
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" \
             width=\"{w_mm}mm\" height=\"{h_mm}mm\" viewBox=\"0 0 {w} {h}\">\n<title>{}</title>\n<defs>\n",
            escaped(title)
        );
        for &(face, glyph) in &self.glyphs {
            let (name, data) = (glyph_name(face, glyph), face.outline(glyph));
            writeln!(out, "<path id=\"{name}\" d=\"{data}\"/>").expect("a String takes all");
        }
        writeln!(out, "</defs>\n<rect width=\"{w}\" height=\"{h}\" fill=\"{WHITE}\"/>")
            .expect("a String takes all");
        out.push_str(&self.body);
        out.push_str("</svg>\n");
        out
    }
}

fn glyph_name(face: Face, glyph: u16) -> String {
    format!("{}{glyph}", face.prefix())
}

/// Text that may stand in an attribute or between tags; control letters are no XML and become spaces.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            control if control.is_control() => out.push(' '),
            plain => out.push(plain),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let shown = [0.0, -0.001, 0.5, -0.5, 1.0, 12.345, 100.0, -7.1].map(number);
        assert_eq!(shown, ["0", "0", ".5", "-.5", "1", "12.35", "100", "-7.1"]);
        assert_eq!(number(f64::NAN), "0");
    }

    #[test]
    fn paths_are_relative_and_do_not_drift() {
        let mut path = Path::default();
        path.move_to([1.0, 2.0]);
        path.line_to([1.0, 2.001]);
        for i in 1..=3 {
            path.line_to([1.0 + f64::from(i) / 3.0, 2.0]);
        }
        path.move_to([2.0, 1.0]);
        path.vertical([0.0, 0.0], 5.0);
        path.dot([1.0, 1.0]);
        assert_eq!(path.data, "m1 2 .33 0 .34 0 .33 0m0-1m-2-1v5m1-4h0");
    }

    #[test]
    fn words_are_escaped() {
        assert_eq!(escaped("a<b & \"c\"\u{1}"), "a&lt;b &amp; &quot;c&quot; ");
    }
}
