//! Lines and curves of a drawing's pieces, for formats that draw by themselves.

use super::canvas::{Patch, Path, Step};
use super::font::Curve;

/// Control points of a quarter of a circle of radius 1, from its ends: with them a cubic is off by 0.03 %.
const QUARTER: f64 = 0.552_285;

/// What takes lines and curves.
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

/// A rectangle, in points; its corners are quarters of a circle where it has a radius.
pub(crate) fn patch(patch: &Patch, outline: &mut impl Outline) {
    let ([left, top], radius) = ([patch.x, patch.y], patch.radius.unwrap_or(0.0));
    let (right, bottom) = (left + patch.width, top + patch.height);
    // Each corner with the direction in which the outline, clockwise, comes to it, and goes from it.
    let corners = [
        ([right, top], [1.0, 0.0], [0.0, 1.0]),
        ([right, bottom], [0.0, 1.0], [-1.0, 0.0]),
        ([left, bottom], [-1.0, 0.0], [0.0, -1.0]),
        ([left, top], [0.0, -1.0], [1.0, 0.0]),
    ];
    outline.begin([left + radius, top]);
    for ([x, y], [in_x, in_y], [out_x, out_y]) in corners {
        let before = |by: f64| [x - by * in_x, y - by * in_y];
        let behind = |by: f64| [x + by * out_x, y + by * out_y];
        outline.line(before(radius));
        if radius > 0.0 {
            let near = radius * (1.0 - QUARTER);
            outline.cubic(before(near), behind(near), behind(radius));
        }
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
