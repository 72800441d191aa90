//! A drawing as pixels.

use png::{BitDepth, ColorType, Compression, Encoder, PixelDimensions, Unit};
use tiny_skia::{
    Color, ColorU8, FillRule, LineCap, LineJoin, Mask, Paint as Shade, PathBuilder, Pixmap,
    PremultipliedColorU8, Rect as Area, Stroke, StrokeDash, Transform,
};

use super::canvas::{Canvas, Element, HALO, Paint, Path, Pen, Words};
use super::clip::Rect;
use super::outline::{self, Outline};
use super::palette::{Colour, WHITE};

/// The most pixels of one image; at four bytes each this is 1 GiB.
const MOST_PIXELS: f64 = (1u64 << 28) as f64;

/// Rasterizes a drawing on white at `dpi` pixels an inch, and notes that resolution in the file; `None` if
/// `dpi` is not a positive number or makes more than 2^28 pixels.
pub(crate) fn raster(canvas: &Canvas, dpi: f64) -> Option<Vec<u8>> {
    let scale = dpi / 72.0;
    let size = [canvas.width, canvas.height].map(|side| (side * scale).round().max(1.0));
    if !(dpi > 0.0 && size[0] * size[1] <= MOST_PIXELS) {
        return None;
    }
    let mut pixels = Pixmap::new(size[0] as u32, size[1] as u32)?;
    pixels.fill(Color::WHITE);
    let page = Transform::from_scale(scale as f32, scale as f32);
    let mut brush = Brush { pixels, page, clip: None };
    canvas.elements.iter().for_each(|element| brush.draw(element));
    // White below makes every pixel opaque, so premultiplied and plain colours agree.
    let colours: Vec<u8> =
        brush.pixels.pixels().iter().flat_map(|p| [p.red(), p.green(), p.blue()]).collect();
    Some(encode(&brush.pixels, &colours, dpi, canvas.maker.as_ref()))
}

/// Pixels as a PNG file, with the program and the command that made it where they are known.
fn encode(pixels: &Pixmap, colours: &[u8], dpi: f64, maker: Option<&[String; 2]>) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, pixels.width(), pixels.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    let per_metre = (dpi / 0.0254).round() as u32;
    encoder.set_pixel_dims(Some(PixelDimensions { xppu: per_metre, yppu: per_metre, unit: Unit::Meter }));
    if let Some([program, command]) = maker {
        let text = "a keyword of the format and words without null";
        encoder.add_text_chunk("Software".into(), program.clone()).expect(text);
        // `tEXt` has Latin letters alone.
        let command = command.replace('\0', " ");
        match command.is_ascii() {
            true => encoder.add_text_chunk("Comment".into(), command).expect(text),
            false => encoder.add_itxt_chunk("Comment".into(), command).expect(text),
        }
    }
    let mut writer = encoder.write_header().expect("a positive size and eight bits a channel are valid");
    writer.write_image_data(colours).expect("writing to memory does not fail");
    writer.finish().expect("writing to memory does not fail");
    bytes
}

/// The pixels under the brush, and the clip that it keeps to.
struct Brush {
    pixels: Pixmap,
    /// From points to pixels.
    page: Transform,
    clip: Option<Mask>,
}

impl Brush {
    fn draw(&mut self, element: &Element) {
        match element {
            Element::Path(path, Paint::Cells(colour)) if self.whole_pixels(path) => self.cells(path, *colour),
            Element::Path(path, paint) => {
                if let Some(path) = traced(|pen| outline::path(path, pen)) {
                    match paint {
                        Paint::Fill { colour, opacity } => {
                            self.fill(&path, &shade(*colour, *opacity), self.page);
                        }
                        Paint::Cells(colour) => self.fill(&path, &shade(*colour, None), self.page),
                        Paint::Stroke(pen) => self.stroke(&path, pen, self.page),
                    }
                }
            }
            Element::Patch(patch) => {
                if let Some(path) = traced(|pen| outline::patch(patch, pen)) {
                    self.fill(&path, &shade(patch.colour, None), self.page);
                }
            }
            Element::Words(words) => self.words(words),
            Element::Open(frame) => self.clip = self.mask(frame),
            Element::Close => self.clip = None,
        }
    }

    fn fill(&mut self, path: &tiny_skia::Path, shade: &Shade, place: Transform) {
        self.pixels.fill_path(path, shade, FillRule::Winding, place, self.clip.as_ref());
    }

    /// Whether each rectangle of a path is at least a pixel wide and high.
    fn whole_pixels(&self, path: &Path) -> bool {
        let least = 1.0 / f64::from(self.page.sx);
        path.rectangles().all(|[left, top, right, bottom]| right - left >= least && bottom - top >= least)
    }

    /// The pixels whose centres lie in a rectangle: where two meet, each pixel is of one of them. Blending
    /// the edges of many shades, one over another, would take ten times as long as all that is seen.
    fn cells(&mut self, path: &Path, colour: Colour) {
        let (scale, wide, high) = (f64::from(self.page.sx), self.pixels.width(), self.pixels.height());
        let colour = opaque(colour);
        let pixel = |at: f64, most: u32| (at * scale).round().clamp(0.0, f64::from(most)) as usize;
        let pixels = self.pixels.pixels_mut();
        for [left, top, right, bottom] in path.rectangles() {
            let (left, right) = (pixel(left, wide), pixel(right, wide));
            for row in pixels.chunks_mut(wide as usize).take(pixel(bottom, high)).skip(pixel(top, high)) {
                row[left..right].fill(colour);
            }
        }
    }

    fn stroke(&mut self, path: &tiny_skia::Path, pen: &Pen, place: Transform) {
        let stroke = Stroke {
            width: pen.width as f32,
            line_cap: if pen.round_caps { LineCap::Round } else { LineCap::Butt },
            line_join: if pen.round_joins { LineJoin::Round } else { LineJoin::Miter },
            dash: StrokeDash::new(pen.dashes.iter().map(|&length| length as f32).collect(), 0.0),
            ..Stroke::default()
        };
        self.pixels.stroke_path(path, &shade(pen.colour, None), &stroke, place, self.clip.as_ref());
    }

    /// The pixels inside a rectangle; none where it has no size.
    fn mask(&self, &[left, top, right, bottom]: &Rect) -> Option<Mask> {
        let [left, top, right, bottom] = [left, top, right, bottom].map(|side| side as f32);
        let mut mask = Mask::new(self.pixels.width(), self.pixels.height())?;
        if let Some(frame) = Area::from_ltrb(left, top, right, bottom) {
            mask.fill_path(&PathBuilder::from_rect(frame), FillRule::Winding, true, self.page);
        }
        Some(mask)
    }

    /// Each glyph in its place; the rim of all of them first, or it would cover neighbours.
    fn words(&mut self, words: &Words) {
        let ([x, y], set) = (words.at.map(|at| at as f32), words.set);
        let em = (set.size / 1000.0) as f32;
        let frame = Transform::from_rotate(-set.turn as f32).pre_scale(em, em).post_translate(x, y);
        let glyphs = words.glyphs.iter().filter_map(|placed| {
            let [x, y] = words.offset(placed).map(|at| at as f32);
            let scale = placed.scale as f32;
            let place = frame.pre_translate(x, y).pre_scale(scale, scale).post_concat(self.page);
            let curves = placed.face.outline(placed.glyph);
            Some((traced(|pen| outline::glyph(&curves, pen))?, place))
        });
        let glyphs: Vec<_> = glyphs.collect();
        if set.halo {
            let rim = Pen { round_joins: true, ..Pen::new(WHITE, HALO) };
            for (path, place) in &glyphs {
                self.fill(path, &shade(WHITE, None), *place);
                self.stroke(path, &rim, *place);
            }
        }
        for (path, place) in &glyphs {
            self.fill(path, &shade(set.colour, None), *place);
        }
    }
}

fn opaque(Colour(r, g, b): Colour) -> PremultipliedColorU8 {
    ColorU8::from_rgba(r, g, b, 255).premultiply()
}

fn shade(Colour(r, g, b): Colour, opacity: Option<f64>) -> Shade<'static> {
    let mut shade = Shade::default();
    shade.set_color_rgba8(r, g, b, (255.0 * opacity.unwrap_or(1.0)).round() as u8);
    shade
}

/// The path that `trace` draws; none where nothing is left of it.
fn traced(trace: impl FnOnce(&mut PathBuilder)) -> Option<tiny_skia::Path> {
    let mut path = PathBuilder::new();
    trace(&mut path);
    path.finish()
}

impl Outline for PathBuilder {
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
        self.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two cells beside each other, 3 and 5 points wide and 4 high, on a sheet of 10 by 6; at `dpi`.
    fn cells(dpi: f64) -> (u32, Vec<Colour>) {
        let mut canvas = Canvas::new(10.0, 6.0, "");
        let place = |left: f64, right: f64| {
            let mut path = Path::default();
            path.rectangle([left, 1.0, right, 5.0]);
            path
        };
        canvas.cells(place(1.0, 4.0), Colour(200, 0, 0));
        canvas.cells(place(4.0, 9.0), Colour(0, 0, 200));
        let file = raster(&canvas, dpi).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut bytes).unwrap();
        let pixels = bytes[..frame.buffer_size()].chunks(3).map(|p| Colour(p[0], p[1], p[2])).collect();
        (frame.width, pixels)
    }

    #[test]
    fn cells_meet_without_seam_or_blend() {
        for dpi in [72.0, 100.0, 131.7, 300.0] {
            let (width, pixels) = cells(dpi);
            let count = |colour: Colour| pixels.iter().filter(|&&pixel| pixel == colour).count() as f64;
            let (left, right) = (count(Colour(200, 0, 0)), count(Colour(0, 0, 200)));
            assert_eq!(left + right + count(WHITE), pixels.len() as f64, "{dpi}");
            // Each side is off by half a pixel at most, so each length by one.
            let within = |found: f64, [wide, high]: [f64; 2]| {
                let [wide, high] = [wide, high].map(|side| side * dpi / 72.0);
                (wide - 1.0) * (high - 1.0) <= found && found <= (wide + 1.0) * (high + 1.0)
            };
            assert!(within(left, [3.0, 4.0]) && within(right, [5.0, 4.0]), "{dpi} {left} {right}");
            let row = &pixels[(pixels.len() / width as usize / 2) * width as usize..][..width as usize];
            let colours: Vec<Colour> = row.chunk_by(|a, b| a == b).map(|run| run[0]).collect();
            assert_eq!(colours, [WHITE, Colour(200, 0, 0), Colour(0, 0, 200), WHITE], "{dpi}");
        }
        // Where cells are no pixels they are blended: none is lost, and none grows.
        let (_, pixels) = cells(12.0);
        assert!(pixels.iter().any(|&Colour(r, g, b)| r > 0 && g > 0 && b < 255 && r < 255));
    }
}
