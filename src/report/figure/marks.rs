//! Layers onto the canvas: one path a colour and stroke, nothing outside the frame.

use super::canvas::{Canvas, Element, Image, Path, Pen};
use super::clip;
use super::layer::{Cells, Layer, Mark, Picture, Run, Shape, Stroke};
use super::measure::Plane;
use super::palette::{Colour, WHITE};

/// Cells overlap by this much (points), or hairlines of paper would show between neighbours in every rasterizer.
const OVERLAP: f64 = 0.06;
/// A pixel of a picture wider than this (points) is shown as the square it is; finer ones are blended.
const SQUARE: f64 = 0.5;

/// Draws a layer.
pub(super) fn layer(canvas: &mut Canvas, plane: &Plane, layer: &Layer) {
    match &layer.mark {
        Mark::Lines { lines: all, stroke } => lines(canvas, plane, all, stroke),
        Mark::Dots { points, shape, size, colour } => dots(canvas, plane, points, (*shape, *size, *colour)),
        Mark::Area { outlines, colour, opacity } => {
            let mut path = Path::default();
            for outline in outlines {
                let kept = clip::polygon(plane.frame, outline.iter().map(|&p| plane.place(p)));
                put_outline(&mut path, &kept);
            }
            canvas.fill(path, *colour, Some(*opacity));
        }
        Mark::Cells(grid) => cells(canvas, plane, grid),
        Mark::Picture(pixels) => picture(canvas, plane, pixels),
    }
}

fn lines(canvas: &mut Canvas, plane: &Plane, lines: &[Vec<[f64; 2]>], stroke: &Stroke) {
    let mut path = Path::default();
    for line in lines {
        for piece in clip::polyline(plane.frame, line.iter().map(|&p| plane.place(p))) {
            path.move_to(piece[0]);
            piece[1..].iter().for_each(|&point| path.line_to(point));
        }
    }
    canvas.stroke(path, Pen::new(stroke.colour, stroke.width).dashed(stroke.dash));
}

fn dots(
    canvas: &mut Canvas,
    plane: &Plane,
    points: &[[f64; 2]],
    (shape, size, colour): (Shape, f64, Colour),
) {
    let mut path = Path::default();
    let half = size / 2.0;
    for [x, y] in points.iter().map(|&p| plane.place(p)).filter(|&p| clip::holds(plane.frame, p)) {
        match shape {
            Shape::Disc | Shape::Ring => path.dot([x, y]),
            Shape::Square => {
                put_turned(&mut path, [x, y], &[[-1, -1], [1, -1], [1, 1], [-1, 1]], 0.89 * half)
            }
            Shape::Diamond => put_turned(&mut path, [x, y], &[[0, -1], [1, 0], [0, 1], [-1, 0]], 1.2 * half),
            Shape::Triangle => put_turned(&mut path, [x, y - 0.1 * size], &[[0, -1], [1, 1], [-1, 1]], half),
            Shape::Cross => {
                path.horizontal([x - half, y], x + half);
                path.vertical([x, y - half], y + half);
            }
        }
    }
    match shape {
        Shape::Disc => canvas.stroke(path, Pen::new(colour, size).capped()),
        Shape::Ring => {
            canvas.stroke(path.clone(), Pen::new(colour, size).capped());
            canvas.stroke(path, Pen::new(WHITE, size - 1.6).capped());
        }
        Shape::Cross => canvas.stroke(path, Pen::new(colour, 0.8)),
        _ => canvas.fill(path, colour, None),
    }
}

fn put_turned(path: &mut Path, [x, y]: [f64; 2], corners: &[[i8; 2]], half: f64) {
    let outline: Vec<[f64; 2]> =
        corners.iter().map(|&[dx, dy]| [x + half * f64::from(dx), y + half * f64::from(dy)]).collect();
    put_outline(path, &outline);
}

fn put_outline(path: &mut Path, outline: &[[f64; 2]]) {
    if let [first, rest @ ..] = outline {
        path.move_to(*first);
        rest.iter().for_each(|&point| path.line_to(point));
        path.close(*first);
    }
}

/// Each colour's runs as strokes: one path for those across, one for those up.
fn cells(canvas: &mut Canvas, plane: &Plane, cells: &Cells) {
    let mut paths: Vec<[Path; 2]> = cells.colours.iter().map(|_| Default::default()).collect();
    for run in &cells.runs {
        let lying = run.across >= run.up;
        if let Some((from, to)) = run_ends(plane, cells, run, lying) {
            let [across, up] = &mut paths[usize::from(run.class)];
            if lying { across.horizontal(from, to[0]) } else { up.vertical(from, to[1]) }
        }
    }
    let [wide, high] = cell_size(plane, cells);
    for (&colour, [across, up]) in cells.colours.iter().zip(paths) {
        canvas.stroke(across, Pen::new(colour, high));
        canvas.stroke(up, Pen::new(colour, wide));
    }
}

/// The size of one cell as it is drawn.
fn cell_size(plane: &Plane, cells: &Cells) -> [f64; 2] {
    let [x, y] = plane.place(cells.origin);
    let [right, up] = plane.place([cells.origin[0] + cells.step[0], cells.origin[1] + cells.step[1]]);
    [(right - x).abs(), (up - y).abs()].map(|size| (size + OVERLAP).max(cells.least))
}

/// The two ends of the stroke that covers a run, lengthened to the least size; none if it lies outside.
fn run_ends(plane: &Plane, cells: &Cells, run: &Run, lying: bool) -> Option<([f64; 2], [f64; 2])> {
    let corner = |i: f64, j: f64| {
        plane.place([cells.origin[0] + cells.step[0] * i, cells.origin[1] + cells.step[1] * j])
    };
    let (i, j) = (f64::from(run.i), f64::from(run.j));
    let (across, up) = (f64::from(run.across), f64::from(run.up));
    let axis = usize::from(!lying);
    let (a, b) = (corner(i - 0.5, j - 0.5), corner(i + across - 0.5, j + up - 0.5));
    let other = 1 - axis;
    let middle = (a[other] + b[other]) / 2.0;
    let (low, high) = (a[axis].min(b[axis]), a[axis].max(b[axis]));
    let more = ((cells.least - (high - low)) / 2.0).max(OVERLAP / 2.0);
    let mut ends = [[middle; 2]; 2];
    (ends[0][axis], ends[1][axis]) = (low - more, high + more);
    clip::segment(plane.frame, ends[0], ends[1])
}

fn picture(canvas: &mut Canvas, plane: &Plane, picture: &Picture) {
    let [left, bottom] = plane.place([picture.x[0], picture.y[0]]);
    let [right, top] = plane.place([picture.x[1], picture.y[1]]);
    let smooth = (right - left) / f64::from(picture.width) <= SQUARE;
    let (place, pixels) = ([left, top, right, bottom], picture.pixels.clone());
    canvas.elements.push(Element::Image(Image { place, width: picture.width, pixels, smooth }));
}
