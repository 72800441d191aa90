//! A drawing as a PDF of one page: the same lines as the SVG, and words as words, in the letters that they
//! need.

use std::collections::BTreeMap;

use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect as Area, Ref, Str, TextStr};

use super::canvas::{Canvas, Element, HALO, Letters, Paint, Pen, Words};
use super::embed::{Fonts, deflated};
use super::label::Placed;
use super::outline::{self, Outline};
use super::palette::{Colour, WHITE};

/// The whole document.
pub(crate) fn document(canvas: &Canvas) -> Vec<u8> {
    let mut next = 1;
    let mut fresh = || {
        next += 1;
        Ref::new(next - 1)
    };
    let [catalog, pages, page, stream, info] = std::array::from_fn(|_| fresh());
    let mut pdf = Pdf::new();
    // No feature here is newer, and LaTeX includes no later version without a warning.
    pdf.set_version(1, 5);
    pdf.catalog(catalog).pages(pages);
    let mut about = pdf.document_info(info);
    about.title(TextStr(&canvas.title));
    if let Some([program, command]) = &canvas.maker {
        about.creator(TextStr(program)).subject(TextStr(command));
    }
    about.finish();
    pdf.pages(pages).kids([page]).count(1);
    let fonts = if canvas.letters == Letters::Shapes { Fonts::default() } else { Fonts::new(canvas) };
    let mut drawing = Drawing::new(&fonts, canvas);
    canvas.elements.iter().for_each(|element| drawing.draw(element));
    let Drawing { content, veils, .. } = drawing;
    pdf.stream(stream, &deflated(content.finish().as_slice())).filter(Filter::FlateDecode);
    let fonts = fonts.write(&mut pdf, &mut fresh);
    let mut sheet = pdf.page(page);
    sheet.parent(pages).media_box(Area::new(0.0, 0.0, canvas.width as f32, canvas.height as f32));
    sheet.contents(stream);
    let mut resources = sheet.resources();
    resources.fonts().pairs(fonts.iter().map(|(name, font)| (Name(name.as_bytes()), *font)));
    let mut states = resources.ext_g_states();
    for (opacity, name) in &veils {
        let share = f32::from(*opacity) / 100.0;
        states.insert(Name(name.as_bytes())).dict().pair(Name(b"ca"), share);
    }
    states.finish();
    resources.finish();
    sheet.finish();
    pdf.finish()
}

/// The page under construction.
struct Drawing<'a> {
    content: Content,
    fonts: &'a Fonts,
    outlined: bool,
    /// Opacities in use, in hundredths as in the SVG, with their names.
    veils: BTreeMap<u8, String>,
}

impl<'a> Drawing<'a> {
    /// An empty page with y pointing down from its upper edge, as on the canvas.
    fn new(fonts: &'a Fonts, canvas: &Canvas) -> Self {
        let mut content = Content::new();
        content.transform([1.0, 0.0, 0.0, -1.0, 0.0, canvas.height as f32]);
        Drawing { content, fonts, outlined: canvas.letters == Letters::Shapes, veils: BTreeMap::new() }
    }

    fn draw(&mut self, element: &'a Element) {
        match element {
            Element::Path(path, Paint::Fill { colour, opacity }) => {
                self.fill(*colour, *opacity, |content| outline::path(path, content));
            }
            Element::Path(path, Paint::Cells(colour)) => {
                self.fill(*colour, None, |content| outline::path(path, content));
            }
            Element::Path(path, Paint::Stroke(pen)) => {
                self.content.save_state();
                self.take(pen);
                outline::path(path, &mut self.content);
                self.content.stroke().restore_state();
            }
            Element::Patch(patch) => {
                self.fill(patch.colour, None, |content| outline::patch(patch, content));
            }
            Element::Words(words) => self.words(words),
            Element::Open([left, top, right, bottom]) => {
                let [x, y, width, height] = [*left, *top, right - left, bottom - top].map(|x| x as f32);
                self.content.save_state().rect(x, y, width, height);
                self.content.clip_nonzero().end_path();
            }
            Element::Close => drop(self.content.restore_state()),
        }
    }

    fn fill(&mut self, colour: Colour, opacity: Option<f64>, trace: impl FnOnce(&mut Content)) {
        let opacity = (100.0 * opacity.unwrap_or(1.0)).round() as u8;
        self.content.save_state();
        if opacity < 100 {
            let name = self.veils.entry(opacity).or_insert_with(|| format!("v{opacity}"));
            self.content.set_parameters(Name(name.as_bytes()));
        }
        let [r, g, b] = shares(colour);
        self.content.set_fill_rgb(r, g, b);
        trace(&mut self.content);
        self.content.fill_nonzero().restore_state();
    }

    fn take(&mut self, pen: &Pen) {
        let [r, g, b] = shares(pen.colour);
        // A miter longer than four widths is cut, as in SVG.
        self.content.set_stroke_rgb(r, g, b).set_line_width(pen.width as f32).set_miter_limit(4.0);
        if pen.round_caps {
            self.content.set_line_cap(LineCapStyle::RoundCap);
        }
        if pen.round_joins {
            self.content.set_line_join(LineJoinStyle::RoundJoin);
        }
        if !pen.dashes.is_empty() {
            self.content.set_dash_pattern(pen.dashes.iter().map(|&length| length as f32), 0.0);
        }
    }

    /// Letters as text, each in its place; the rim around them as outlines, or a search would find them
    /// twice.
    fn words(&mut self, words: &Words) {
        if words.set.halo {
            let rim = Pen { round_joins: true, ..Pen::new(WHITE, HALO) };
            self.shapes(words, |drawing| drawing.take(&rim), |content| content.stroke());
        }
        let [r, g, b] = shares(words.set.colour);
        if self.outlined {
            let ink = |drawing: &mut Self| {
                drawing.content.set_fill_rgb(r, g, b);
            };
            return self.shapes(words, ink, |content| content.fill_nonzero());
        }
        self.content.save_state().begin_text().set_fill_rgb(r, g, b);
        for (_, run) in words.runs() {
            let (size, [a, b, c, d, x, y]) = (words.set.size * run[0].scale, placed(words, &run[0], 1.0));
            // Letters stand upright although y points down.
            self.content.set_text_matrix([a, b, -c, -d, x, y]);
            let font = self.fonts.find(run[0].face, 0).0;
            self.content.set_font(Name(font.as_bytes()), size as f32);
            let mut line = self.content.show_positioned();
            let mut items = line.items();
            let mut bytes = Vec::new();
            for (n, placed) in run.iter().enumerate() {
                bytes.extend(self.fonts.find(placed.face, placed.glyph).1.to_be_bytes());
                // Where the next letter is not where this one's advance ends: thousandths, counted leftwards.
                let back =
                    |next: &Placed| placed.face.advance(placed.glyph) - (next.x - placed.x) / placed.scale;
                let back = run.get(n + 1).map(back).filter(|back| back.abs() > 1e-6);
                if n + 1 == run.len() || back.is_some() {
                    items.show(Str(&std::mem::take(&mut bytes)));
                    back.map(|back| items.adjust((1000.0 * back) as f32));
                }
            }
        }
        self.content.end_text().restore_state();
    }

    /// Letters as outlines.
    fn shapes(
        &mut self,
        words: &Words,
        prepare: impl Fn(&mut Self),
        paint: impl Fn(&mut Content) -> &mut Content,
    ) {
        for glyph in &words.glyphs {
            self.content.save_state();
            prepare(self);
            self.content.transform(placed(words, glyph, words.set.size / 1000.0 * glyph.scale));
            outline::glyph(&glyph.face.outline(glyph.glyph), &mut self.content);
            paint(&mut self.content).restore_state();
        }
    }
}

/// From a glyph's own plane, whose unit is so many points, to the page.
fn placed(words: &Words, placed: &Placed, unit: f64) -> [f32; 6] {
    let (sin, cos) = (-words.set.turn).to_radians().sin_cos();
    let (em, [x, y]) = (words.set.size / 1000.0, words.offset(placed));
    let at = [words.at[0] + em * (cos * x - sin * y), words.at[1] + em * (sin * x + cos * y)];
    [unit * cos, unit * sin, -unit * sin, unit * cos, at[0], at[1]].map(|x| x as f32)
}

fn shares(Colour(r, g, b): Colour) -> [f32; 3] {
    [r, g, b].map(|share| f32::from(share) / 255.0)
}

impl Outline for Content {
    fn begin(&mut self, [x, y]: [f64; 2]) {
        self.move_to(x as f32, y as f32);
    }

    fn line(&mut self, [x, y]: [f64; 2]) {
        self.line_to(x as f32, y as f32);
    }

    fn cubic(&mut self, first: [f64; 2], second: [f64; 2], to: [f64; 2]) {
        let [[a, b], [c, d], [x, y]] = [first, second, to].map(|point| point.map(|x| x as f32));
        self.cubic_to(a, b, c, d, x, y);
    }

    fn end(&mut self) {
        self.close_path();
    }
}
