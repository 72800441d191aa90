//! The text face: Libertinus Serif (SIL Open Font License, see `fonts/`), built in.
//!
//! The letters in use go into SVG and PDF with their outlines, so that a figure looks the same in a browser,
//! in a paper and as PNG, with no font installed. Lengths are in em.

use std::sync::LazyLock;

use subsetter::GlyphRemapper;
use ttf_parser::gpos::{PairAdjustment, PositioningSubtable};
use ttf_parser::{GlyphId, OutlineBuilder};

macro_rules! file {
    ($name:literal) => {
        ($name, include_bytes!(concat!("../fonts/", $name)))
    };
}

/// The font files with their names, in the order of faces.
const FILES: [(&str, &[u8]); 4] = [
    file!("LibertinusSerif-Regular.otf"),
    file!("LibertinusSerif-Italic.otf"),
    file!("LibertinusSerif-Semibold.otf"),
    file!("LibertinusSerif-SemiboldItalic.otf"),
];

/// A built-in font file by its name, for pages that write in the same letters.
pub fn font_file(name: &str) -> Option<&'static [u8]> {
    FILES.iter().find(|file| file.0 == name).map(|file| file.1)
}

/// The four faces in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Face {
    Roman,
    Italic,
    Semibold,
    SemiboldItalic,
}

impl Face {
    pub(crate) const ALL: [Face; 4] = [Face::Roman, Face::Italic, Face::Semibold, Face::SemiboldItalic];

    /// The italic face of this weight.
    pub(crate) fn italic(self) -> Face {
        match self {
            Face::Roman | Face::Italic => Face::Italic,
            Face::Semibold | Face::SemiboldItalic => Face::SemiboldItalic,
        }
    }

    /// The font file.
    fn file(self) -> &'static [u8] {
        FILES[self as usize].1
    }

    /// A letter that starts the names of its glyphs in the SVG.
    pub(crate) fn prefix(self) -> char {
        match self {
            Face::Roman => 'r',
            Face::Italic => 'i',
            Face::Semibold => 's',
            Face::SemiboldItalic => 't',
        }
    }

    fn font(self) -> &'static ttf_parser::Face<'static> {
        static FONTS: LazyLock<[ttf_parser::Face<'static>; 4]> = LazyLock::new(|| {
            Face::ALL.map(|face| ttf_parser::Face::parse(face.file(), 0).expect("a built-in font is sound"))
        });
        &FONTS[self as usize]
    }

    /// The glyph of a letter; of one that the face lacks, the empty box.
    pub(crate) fn glyph(self, letter: char) -> u16 {
        self.font().glyph_index(letter).map_or(0, |id| id.0)
    }

    /// How far the pen moves on after a glyph.
    pub(crate) fn advance(self, glyph: u16) -> f64 {
        f64::from(self.font().glyph_hor_advance(GlyphId(glyph)).unwrap_or(0)) / self.em()
    }

    /// How much closer (negative) or farther two neighbours stand than their advances say.
    pub(crate) fn kerning(self, left: u16, right: u16) -> f64 {
        let (left, right) = (GlyphId(left), GlyphId(right));
        let Some(gpos) = self.font().tables().gpos else { return 0.0 };
        let shift = gpos.lookups.into_iter().find_map(|lookup| {
            lookup.subtables.into_iter::<PositioningSubtable>().find_map(|table| match table {
                // Tables that know the pair but leave it alone make way for the next.
                PositioningSubtable::Pair(pairs) => pair_shift(&pairs, left, right).filter(|&by| by != 0),
                _ => None,
            })
        });
        f64::from(shift.unwrap_or(0)) / self.em()
    }

    /// The outline in units of 1/1000 em, y pointing down.
    pub(crate) fn outline(self, glyph: u16) -> Vec<Curve> {
        curves(self.font(), glyph)
    }

    /// The glyphs numbered by `numbers` as a font without a table of letters.
    pub(crate) fn part(self, numbers: &GlyphRemapper) -> Vec<u8> {
        subsetter::subset(self.file(), 0, numbers).expect("a built-in font is sound")
    }

    /// The glyphs numbered by `numbers` as a font program for PDF (CFF).
    pub(crate) fn outlines(self, numbers: &GlyphRemapper) -> Vec<u8> {
        table(&self.part(numbers), b"CFF ")
    }

    /// One of the tables of the font file.
    pub(crate) fn table(self, tag: &[u8; 4]) -> Vec<u8> {
        table(self.file(), tag)
    }

    /// How large its glyphs are.
    pub(crate) fn shape(self) -> Shape {
        let (font, em) = (self.font(), self.em());
        let length = |units: i16| 1000.0 * f64::from(units) / em;
        let bounds = font.global_bounding_box();
        Shape {
            bounds: [bounds.x_min, bounds.y_min, bounds.x_max, bounds.y_max].map(length),
            slant: f64::from(font.italic_angle()),
            ascent: length(font.ascender()),
            descent: length(font.descender()),
            capital: font.capital_height().map_or(700.0, length),
        }
    }

    fn em(self) -> f64 {
        f64::from(self.font().units_per_em())
    }
}

/// A table of a font; empty where there is none.
pub(crate) fn table(font: &[u8], tag: &[u8; 4]) -> Vec<u8> {
    let face = ttf_parser::RawFace::parse(font, 0).expect("a built-in font and its parts are sound");
    face.table(ttf_parser::Tag::from_bytes(tag)).unwrap_or_default().to_vec()
}

/// The outline of a font's glyph in units of 1/1000 em, y pointing down.
pub(crate) fn curves(font: &ttf_parser::Face, glyph: u16) -> Vec<Curve> {
    let mut pen = Pen { curves: Vec::new(), scale: (1000.0 / f64::from(font.units_per_em())) as f32 };
    font.outline_glyph(GlyphId(glyph), &mut pen);
    pen.curves
}

/// The measures of a face in 1/1000 em, y pointing up; the slant in degrees, counterclockwise.
pub(crate) struct Shape {
    /// Left, bottom, right, top of all glyphs put on one another.
    pub bounds: [f64; 4],
    pub slant: f64,
    pub ascent: f64,
    pub descent: f64,
    pub capital: f64,
}

/// The change of the left glyph's advance, if the table knows the pair.
fn pair_shift(pairs: &PairAdjustment, left: GlyphId, right: GlyphId) -> Option<i16> {
    let row = pairs.coverage().get(left)?;
    let (first, _) = match pairs {
        PairAdjustment::Format1 { sets, .. } => sets.get(row)?.get(right)?,
        PairAdjustment::Format2 { classes, matrix, .. } => {
            matrix.get((classes.0.get(left), classes.1.get(right)))?
        }
    };
    Some(first.x_advance)
}

/// A piece of an outline: control points, and the point where it ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Curve {
    Move([i32; 2]),
    Line([i32; 2]),
    Quad([i32; 2], [i32; 2]),
    Cubic([i32; 2], [i32; 2], [i32; 2]),
    Close,
}

struct Pen {
    curves: Vec<Curve>,
    scale: f32,
}

impl Pen {
    /// Fonts count upwards, pages downwards.
    fn at(&self, x: f32, y: f32) -> [i32; 2] {
        [x * self.scale, -y * self.scale].map(|value| value.round() as i32)
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.curves.push(Curve::Move(self.at(x, y)));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.curves.push(Curve::Line(self.at(x, y)));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.curves.push(Curve::Quad(self.at(x1, y1), self.at(x, y)));
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.curves.push(Curve::Cubic(self.at(x1, y1), self.at(x2, y2), self.at(x, y)));
    }

    fn close(&mut self) {
        self.curves.push(Curve::Close);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_built_in_fonts_are_the_ones_we_mean() {
        let full_name = |face: Face| {
            face.font()
                .names()
                .into_iter()
                .find(|n| n.name_id == 4 && n.is_unicode())
                .and_then(|n| n.to_string())
        };
        let names = Face::ALL.map(|face| full_name(face).unwrap());
        assert_eq!(
            names,
            [
                "Libertinus Serif Regular",
                "Libertinus Serif Italic",
                "Libertinus Serif Semibold",
                "Libertinus Serif Semibold Italic"
            ]
        );
    }

    #[test]
    fn every_letter_that_figures_use_is_there() {
        for letter in "0123456789−.,×·±≤≥½∞√′″αβγδθλμπρσωΛΔ()[]/%&=<>|".chars()
        {
            assert!(Face::ALL.iter().all(|face| face.glyph(letter) != 0), "no {letter}");
        }
    }

    #[test]
    fn neighbours_are_kerned() {
        let pair = |a, b| Face::Roman.kerning(Face::Roman.glyph(a), Face::Roman.glyph(b));
        assert!(pair('A', 'V') < -0.03 && pair('H', 'H') == 0.0, "{} {}", pair('A', 'V'), pair('H', 'H'));
    }
}
