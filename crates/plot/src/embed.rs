//! The letters of a drawing as fonts in its file: of each face the glyphs in use, and what letter each one
//! means.

use std::collections::BTreeMap;
use std::io::Write as _;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::writers::FontDescriptor;
use pdf_writer::{Filter, Finish, Name, Pdf, Rect, Ref, Str};
use subsetter::GlyphRemapper;

use super::canvas::{Canvas, Element};
use super::font::Face;
use super::opentype;

/// Glyphs are numbered by us, in no known order of characters.
const ORDER: SystemInfo = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };

/// Bytes as the filter `FlateDecode` of a PDF reads them.
pub(crate) fn deflated(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).and_then(|()| encoder.finish()).expect("writing to memory does not fail")
}

/// The faces in use.
#[derive(Default)]
pub(crate) struct Fonts(BTreeMap<Face, Font>);

#[derive(Default)]
struct Font {
    name: String,
    numbers: GlyphRemapper,
    /// The letter of each glyph in use.
    letters: BTreeMap<u16, char>,
}

impl Fonts {
    /// The glyphs that the words of a drawing need.
    pub(crate) fn new(canvas: &Canvas) -> Fonts {
        let mut fonts: BTreeMap<Face, Font> = BTreeMap::new();
        for element in &canvas.elements {
            let Element::Words(words) = element else { continue };
            for (letter, placed) in words.words.chars().zip(&words.glyphs) {
                let font = fonts.entry(placed.face).or_default();
                font.name = format!("f{}", placed.face.prefix());
                font.numbers.remap(placed.glyph);
                font.letters.entry(placed.glyph).or_insert(letter);
            }
        }
        Fonts(fonts)
    }

    /// The name of a face's font on the page and the number of a glyph in it.
    pub(crate) fn find(&self, face: Face, glyph: u16) -> (&str, u16) {
        let font = &self.0[&face];
        // A glyph that is not there is the empty box.
        (&font.name, font.numbers.get(glyph).unwrap_or(0))
    }

    /// Each face as a font file of its own, for SVG.
    pub(crate) fn files(&self) -> impl Iterator<Item = (Face, Vec<u8>)> {
        self.0.iter().map(|(&face, font)| (face, opentype::font(face, &font.numbers, &font.letters)))
    }

    /// Puts the fonts into the document; their names on the page, and where they are.
    pub(crate) fn write(&self, pdf: &mut Pdf, fresh: &mut impl FnMut() -> Ref) -> Vec<(String, Ref)> {
        let one = |(face, font): (&Face, &Font)| (font.name.clone(), font.write(*face, pdf, fresh));
        self.0.iter().map(one).collect()
    }
}

impl Font {
    fn write(&self, face: Face, pdf: &mut Pdf, fresh: &mut impl FnMut() -> Ref) -> Ref {
        let [font, descendant, descriptor, meanings, file] = std::array::from_fn(|_| fresh());
        // Six letters mark a font of which not all glyphs are there.
        let name = format!("KDRIFT+LibertinusSerif-{face:?}");
        let name = Name(name.as_bytes());
        let mut outer = pdf.type0_font(font);
        outer.base_font(name).encoding_predefined(Name(b"Identity-H"));
        outer.descendant_font(descendant).to_unicode(meanings);
        outer.finish();
        let mut inner = pdf.cid_font(descendant);
        inner.subtype(CidFontType::Type0).base_font(name).system_info(ORDER).font_descriptor(descriptor);
        let widths = self.numbers.remapped_gids().map(|glyph| (1000.0 * face.advance(glyph)) as f32);
        inner.widths().consecutive(0, widths);
        inner.finish();
        describe(face, name, pdf.font_descriptor(descriptor), file);
        let mut map = UnicodeCmap::new(Name(b"letters"), ORDER);
        for (&glyph, &letter) in &self.letters {
            map.pair(self.numbers.get(glyph).unwrap_or(0), letter);
        }
        pdf.cmap(meanings, map.finish().as_slice());
        let bytes = deflated(&face.outlines(&self.numbers));
        let mut stream = pdf.stream(file, &bytes);
        stream.filter(Filter::FlateDecode).pair(Name(b"Subtype"), Name(b"CIDFontType0C"));
        stream.finish();
        font
    }
}

/// The measures of a face, by which a reader lays out what it marks.
fn describe(face: Face, name: Name, mut descriptor: FontDescriptor, file: Ref) {
    let shape = face.shape();
    let [left, bottom, right, top] = shape.bounds.map(|side| side as f32);
    descriptor.name(name).bbox(Rect::new(left, bottom, right, top)).italic_angle(shape.slant as f32);
    descriptor.flags(FontFlags::SERIF | FontFlags::SYMBOLIC).cap_height(shape.capital as f32);
    descriptor.ascent(shape.ascent as f32).descent(shape.descent as f32);
    // No reader looks at the width of stems where the font is there.
    descriptor.stem_v(80.0).font_file3(file);
}
