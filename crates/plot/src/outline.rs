//! Lines and curves of a drawing's pieces, for formats that draw by themselves.

use super::canvas::{Patch, Path, Step};
use super::font::Curve;

/// A pen that takes lines and curves.
pub(crate) trait Outline {
    fn begin(&mut self, at: [f64; 2]);
    fn line(&mut self, to: [f64; 2]);
    fn cubic(&mut self, first: [f64; 2], second: [f64; 2], to: [f64; 2]);
    fn end(&mut self);
}

/// A path, in points.
pub(crate) fn path(path: &Path, outline: &mut impl Outline) {
    let mut at = (0, 0);
    let points = |(x, y): (i64, i64)| [x as f64 / 100.0, y as f64 / 100.0];
    for &step in &path.steps {
        match step {
            Step::Move(x, y) | Step::Line(x, y) | Step::Close(x, y) => at = (x, y),
            Step::Across(x) => at.0 = x,
            Step::Along(y) => at.1 = y,
            Step::Dot => {}
        }
        match step {
            Step::Move(..) => outline.begin(points(at)),
            Step::Close(..) => outline.end(),
            _ => outline.line(points(at)),
        }
    }
}

/// A rectangle, in points.
pub(crate) fn patch(patch: &Patch, outline: &mut impl Outline) {
    let (left, top) = (patch.x, patch.y);
    let (right, bottom) = (left + patch.width, top + patch.height);
    outline.begin([left, top]);
    for corner in [[right, top], [right, bottom], [left, bottom], [left, top]] {
        outline.line(corner);
    }
    outline.end();
}

/// A glyph, in 1/1000 em.
pub(crate) fn glyph(curves: &[Curve], outline: &mut impl Outline) {
    let mut at = [0.0; 2];
    for &curve in curves {
        let points = |point: [i32; 2]| point.map(f64::from);
        match curve {
            Curve::Move(to) => {
                at = points(to);
                outline.begin(at);
            }
            Curve::Line(to) => {
                at = points(to);
                outline.line(at);
            }
            Curve::Quad(control, to) => {
                let (control, to) = (points(control), points(to));
                let third = |end: [f64; 2]| [0, 1].map(|i| (end[i] + 2.0 * control[i]) / 3.0);
                outline.cubic(third(at), third(to), to);
                at = to;
            }
            Curve::Cubic(first, second, to) => {
                at = points(to);
                outline.cubic(points(first), points(second), at);
            }
            Curve::Close => outline.end(),
        }
    }
}
