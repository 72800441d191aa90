//! The SVG as pixels.

use png::{BitDepth, ColorType, Compression, Encoder, PixelDimensions, Unit};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use super::palette::Colour;
use crate::error::{Error, Result};

/// The most pixels of one image; at four bytes each this is 1 GiB.
const MOST_PIXELS: f64 = (1u64 << 28) as f64;
/// CSS, and with it SVG, counts 96 units an inch.
const UNITS_AN_INCH: f32 = 96.0;

/// Rasterizes an SVG document on white at `dpi` pixels an inch, and notes that resolution in the file.
///
/// # Errors
/// [`Kind::Input`](crate::error::Kind::Input) if `dpi` is not a positive number or makes more than 2^28 pixels.
///
/// # Panics
/// If `svg` is not an SVG document: [`Figure::svg`](super::Figure::svg) always makes one.
pub fn raster(svg: &str, dpi: f64) -> Result<Vec<u8>> {
    let tree = Tree::from_str(svg, &Options { dpi: UNITS_AN_INCH, ..Options::default() })
        .expect("the figure is an SVG document");
    let scale = dpi / f64::from(UNITS_AN_INCH);
    let size =
        [tree.size().width(), tree.size().height()].map(|side| (f64::from(side) * scale).round().max(1.0));
    if !(dpi > 0.0 && size[0] * size[1] <= MOST_PIXELS) {
        return Err(Error::input("dpi", dpi, "between 1 and what makes 268 million pixels; 300 suits print"));
    }
    let (width, height) = (size[0] as u32, size[1] as u32);
    let mut pixels = Pixmap::new(width, height).expect("both sides are positive");
    pixels.fill(resvg::tiny_skia::Color::WHITE);
    resvg::render(&tree, Transform::from_scale(scale as f32, scale as f32), &mut pixels.as_mut());
    // White below makes every pixel opaque, so premultiplied and plain colours agree.
    let colours: Vec<Colour> = pixels.pixels().iter().map(|p| Colour(p.red(), p.green(), p.blue())).collect();
    Ok(encode(width, height, &colours, Some(dpi)))
}

/// Pixels, row by row, as a PNG file.
pub(super) fn encode(width: u32, height: u32, pixels: &[Colour], dpi: Option<f64>) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    if let Some(dpi) = dpi {
        let per_metre = (dpi / 0.0254).round() as u32;
        encoder.set_pixel_dims(Some(PixelDimensions { xppu: per_metre, yppu: per_metre, unit: Unit::Meter }));
    }
    let data: Vec<u8> = pixels.iter().flat_map(|&Colour(r, g, b)| [r, g, b]).collect();
    let mut writer = encoder.write_header().expect("a positive size and eight bits a channel are valid");
    writer.write_image_data(&data).expect("writing to memory does not fail");
    writer.finish().expect("writing to memory does not fail");
    bytes
}
