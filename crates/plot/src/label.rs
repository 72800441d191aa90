//! Words with italics, subscripts and superscripts, measured and placed.
//!
//! The notation: `*h*_1` is an italic h with index 1, `10^{−3}` a power, `T_{1/2}` an index of more than one
//! letter, and `h_1^2` has its power above its index; a backslash takes the meaning from the letter behind
//! it. An open `*` or `{` ends with the text.

use super::font::Face;

/// Size of an index or exponent, and how far its baseline lies below or above, relative to the text.
const SCRIPT: f64 = 0.7;
const DROP: f64 = 0.17;
const RISE: f64 = -0.36;
/// Leaning letters reach over the place of an upright neighbour.
const ITALIC_CORRECTION: f64 = 0.03;

/// A glyph in its place, in em of the label, y down from the baseline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placed {
    pub face: Face,
    pub glyph: u16,
    pub x: f64,
    pub y: f64,
    pub scale: f64,
}

/// A line of text, laid out.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Label {
    /// The letters alone, for those who listen or search.
    pub words: String,
    pub glyphs: Vec<Placed>,
    /// In em.
    pub width: f64,
}

/// Where a letter goes.
#[derive(Clone, Copy, PartialEq)]
enum Level {
    Line,
    Below,
    Above,
}

impl Level {
    /// Size and baseline.
    fn shape(self) -> (f64, f64) {
        match self {
            Level::Line => (1.0, 0.0),
            Level::Below => (SCRIPT, DROP),
            Level::Above => (SCRIPT, RISE),
        }
    }
}

impl Label {
    /// Lays out `markup` in the roman face.
    pub(crate) fn new(markup: &str) -> Self {
        Self::in_face(markup, Face::Roman)
    }

    /// Lays out `markup` in `base` and its italic.
    pub(crate) fn in_face(markup: &str, base: Face) -> Self {
        let mut line = Line::default();
        let (mut level, mut italic, mut braced) = (Level::Line, false, false);
        let mut letters = markup.chars().peekable();
        while let Some(letter) = letters.next() {
            match letter {
                '*' => italic = !italic,
                '_' | '^' if level == Level::Line && letters.peek().is_some() => {
                    level = if letter == '_' { Level::Below } else { Level::Above };
                    braced = letters.next_if_eq(&'{').is_some();
                    line.begin_script(level);
                }
                '}' if braced => (level, braced) = (Level::Line, false),
                other => {
                    let plain = if other == '\\' { letters.next().unwrap_or(other) } else { other };
                    line.put(plain, if italic { base.italic() } else { base }, level);
                    if !braced {
                        level = Level::Line;
                    }
                }
            }
        }
        Label { words: line.words, glyphs: line.glyphs, width: line.width }
    }
}

/// The words in lines no longer than `room`, in em; a word that is longer has a line of its own.
pub(crate) fn wrapped(markup: &str, face: Face, room: f64) -> Vec<Label> {
    let mut lines: Vec<(String, Label)> = Vec::new();
    for word in markup.split(' ') {
        let longer = lines.last().map(|(line, _)| format!("{line} {word}"));
        let longer =
            longer.map(|line| (Label::in_face(&line, face), line)).filter(|(label, _)| label.width <= room);
        match (longer, lines.last_mut()) {
            (Some((label, line)), Some(last)) => *last = (line, label),
            _ => lines.push((word.into(), Label::in_face(word, face))),
        }
    }
    lines.into_iter().map(|(_, label)| label).filter(|label| !label.glyphs.is_empty()).collect()
}

/// Words that others wrote, in the notation of labels: their stars and bars are letters.
pub fn literal(words: &str) -> String {
    let letter = |c: char| if "*_^\\".contains(c) { format!("\\{c}") } else { c.to_string() };
    words.chars().map(letter).collect()
}

/// An exact number in the notation of labels: `2/5*pi^2` as 2/5 π².
pub fn typeset(number: impl std::fmt::Display) -> String {
    number.to_string().replace("*pi", " π").replace("pi", "π").replace('*', "").replace('-', "−")
}

/// A label under construction.
#[derive(Default)]
struct Line {
    words: String,
    glyphs: Vec<Placed>,
    /// Where the next glyph goes, and how far the glyphs reach.
    pen: f64,
    width: f64,
    /// The script just set and where it began.
    script: Option<(Level, f64)>,
}

impl Line {
    /// An index right behind a power, or the other way round, begins where that began.
    fn begin_script(&mut self, level: Level) {
        match self.script.take() {
            Some((other, start)) if other != level => self.pen = start,
            _ => {
                self.pen = self.width;
                self.script = Some((level, self.pen));
            }
        }
    }

    fn put(&mut self, letter: char, face: Face, level: Level) {
        if level == Level::Line {
            (self.script, self.pen) = (None, self.width);
        }
        let (scale, y) = level.shape();
        let glyph = face.glyph(letter);
        if let Some(last) = self.glyphs.last() {
            if last.face == face && last.y == y {
                self.pen += scale * face.kerning(last.glyph, glyph);
            } else if level != Level::Below && last.face.italic() == last.face && face.italic() != face {
                self.pen += ITALIC_CORRECTION;
            }
        }
        self.glyphs.push(Placed { face, glyph, x: self.pen, y, scale });
        self.pen += scale * face.advance(glyph);
        self.width = self.width.max(self.pen);
        self.words.push(letter);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_are_small_and_low_and_the_text_returns_to_its_line() {
        let label = Label::new("*T*_{1/2} = *h*^2x");
        assert_eq!(label.words, "T1/2 = h2x");
        let scripts: String =
            label.words.chars().zip(&label.glyphs).filter(|(_, g)| g.scale < 1.0).map(|(c, _)| c).collect();
        assert_eq!(scripts, "1/22");
        assert!(label.glyphs[1].y > 0.0 && label.glyphs[8].y < 0.0 && label.glyphs[9].y == 0.0);
        assert_eq!(label.glyphs[0].face, Face::Italic);
        assert!(label.glyphs.windows(2).all(|pair| pair[0].x < pair[1].x));
        assert!(label.width > label.glyphs[9].x);
    }

    #[test]
    fn a_power_stands_above_an_index_and_the_line_goes_on_behind_both() {
        let label = Label::new("h_{12}^2x");
        let x: Vec<f64> = label.glyphs.iter().map(|glyph| glyph.x).collect();
        assert_eq!(x[1], x[3]);
        assert!(x[4] > x[2] && label.width > x[4]);
        assert_eq!(Label::new("h^2_{12}").width, Label::new("h_{12}^2").width);
    }

    #[test]
    fn words_are_wrapped_between_them() {
        let lines = |room| wrapped("one two *three*", Face::Roman, room).into_iter().map(|line| line.words);
        assert_eq!(lines(99.0).collect::<Vec<_>>(), ["one two three"]);
        assert_eq!(lines(Label::new("one two").width).collect::<Vec<_>>(), ["one two", "three"]);
        assert_eq!(lines(0.1).collect::<Vec<_>>(), ["one", "two", "three"]);
        assert_eq!(wrapped("", Face::Roman, 9.0), []);
    }

    #[test]
    fn a_backslash_and_loose_ends_are_taken_literally() {
        assert_eq!(Label::new(r"a\_b\*c\\").words, r"a_b*c\");
        assert_eq!(Label::new("x_").words, "x_");
        assert_eq!(Label::new("x_{12").words, "x12");
        assert_eq!(Label::new("").width, 0.0);
    }
}
