//! Layers onto the canvas: one path a colour and stroke, nothing outside the frame.

use std::collections::BTreeMap;

use super::canvas::{Canvas, Path, Pen};
use super::clip::{self, Rect};
use super::hatch;
use super::layer::{Cells, Hatch, Layer, Mark, Run, Shape, Stroke};
use super::measure::Plane;
use super::palette::{Colour, WHITE};

/// Draws a layer.
pub(crate) fn layer(canvas: &mut Canvas, plane: &Plane, layer: &Layer) {
    match &layer.mark {
        Mark::Lines { lines: all, stroke, marks } => {
            lines(canvas, plane, all, stroke);
            if let Some((shape, size)) = *marks {
                dots(canvas, plane, &all.concat(), (shape, size, stroke.colour));
            }
        }
        Mark::Dots { points, shape, size, colour } => dots(canvas, plane, points, (*shape, *size, *colour)),
        Mark::Area { outlines, colour, opacity } => {
            let kept = |outline: &Vec<_>| clip::polygon(plane.frame, outline.iter().map(|&p| plane.place(p)));
            let kept: Vec<Vec<[f64; 2]>> = outlines.iter().map(kept).collect();
            let mut path = Path::default();
            kept.iter().for_each(|outline| put_outline(&mut path, outline));
            canvas.fill(path, *colour, Some(*opacity));
            hatched(canvas, layer.hatch, &kept, *colour);
        }
        Mark::Cells(grid) => cells(canvas, plane, grid, layer.hatch),
    }
}

/// Strokes over what is filled.
fn hatched(canvas: &mut Canvas, hatch: Option<Hatch>, outlines: &[Vec<[f64; 2]>], colour: Colour) {
    if let Some(hatch) = hatch {
        let strokes = hatch.over(outlines.iter().map(Vec::as_slice));
        canvas.stroke(strokes, Pen::new(colour.opposite(), hatch::WIDTH));
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

/// Each colour over all cells of it and of later colours, in one outline: then nothing but the colour below
/// can show where two cells meet, however the page is rasterized. Growth falls from the middle of a tongue to
/// its edges, so that this is no more than a rectangle a colour and column either.
fn cells(canvas: &mut Canvas, plane: &Plane, cells: &Cells, hatch: Option<Hatch>) {
    let single = |run: &Run| {
        let (run, wide) = (*run, run.across);
        (0..wide * run.up).map(move |n| (run.i + n % wide, run.j + n / wide, run.class))
    };
    let mut all: Vec<(u32, u32, u16)> = cells.runs.iter().flat_map(single).collect();
    all.sort_unstable();
    let mut classes: Vec<u16> = cells.runs.iter().map(|run| run.class).collect();
    classes.sort_unstable();
    classes.dedup();
    for class in classes {
        let runs = rectangles(all.iter().filter(|cell| cell.2 >= class).map(|&(i, j, _)| (i, j)));
        let places: Vec<Rect> = runs.iter().filter_map(|run| rectangle(plane, cells, run)).collect();
        let mut path = Path::default();
        places.iter().for_each(|&place| path.rectangle(place));
        let colour = cells.colours[usize::from(class)];
        canvas.cells(path, colour);
        let corners = |&[left, top, right, bottom]: &Rect| {
            vec![[left, top], [right, top], [right, bottom], [left, bottom]]
        };
        hatched(canvas, hatch, &places.iter().map(corners).collect::<Vec<_>>(), colour);
    }
}

/// Cells sorted by column and row as rectangles: runs of a column, and equal runs of neighbouring columns
/// joined.
fn rectangles(cells: impl Iterator<Item = (u32, u32)>) -> Vec<Run> {
    let (mut runs, mut done) = (Vec::<Run>::new(), Vec::new());
    for (i, j) in cells {
        match runs.last_mut() {
            Some(last) if last.i == i && last.j + last.up >= j => last.up = last.up.max(j - last.j + 1),
            _ => runs.push(Run { i, j, across: 1, up: 1, class: 0 }),
        }
    }
    let mut open: BTreeMap<(u32, u32), Run> = BTreeMap::new();
    for column in runs.chunk_by(|a, b| a.i == b.i) {
        // A mark that ends before the neighbour of this column grows no more.
        let (near, ended): (BTreeMap<_, _>, BTreeMap<_, _>) = std::mem::take(&mut open)
            .into_iter()
            .partition(|(_, known)| known.i + known.across == column[0].i);
        done.extend(ended.into_values());
        open = near;
        let mut still = BTreeMap::new();
        for run in column {
            let joined =
                open.remove(&(run.j, run.up)).map_or(*run, |known| Run { across: known.across + 1, ..known });
            still.insert((run.j, run.up), joined);
        }
        done.extend(std::mem::replace(&mut open, still).into_values());
    }
    done.extend(open.into_values());
    done
}

/// The part in the frame of what a run covers, widened to the least size; none if it lies outside.
fn rectangle(plane: &Plane, cells: &Cells, run: &Run) -> Option<Rect> {
    let corner = |i: u32, j: u32| {
        let at = |axis: usize, n: u32| cells.origin[axis] + cells.step[axis] * (f64::from(n) - 0.5);
        plane.place([at(0, i), at(1, j)])
    };
    let (a, b) = (corner(run.i, run.j), corner(run.i + run.across, run.j + run.up));
    let [[left, right], [top, bottom]] = [0, 1].map(|axis| {
        let (low, high) = (a[axis].min(b[axis]), a[axis].max(b[axis]));
        let more = ((cells.least - (high - low)) / 2.0).max(0.0);
        [(low - more).max(plane.frame[axis]), (high + more).min(plane.frame[axis + 2])]
    });
    (left < right && top < bottom).then_some([left, top, right, bottom])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_joined_to_rectangles() {
        let cells = [(0, 1), (0, 2), (1, 1), (1, 2), (1, 4), (2, 1), (2, 2), (4, 1), (4, 2)];
        let mut found: Vec<[u32; 4]> =
            rectangles(cells.into_iter()).iter().map(|run| [run.i, run.j, run.across, run.up]).collect();
        found.sort_unstable();
        assert_eq!(found, [[0, 1, 3, 2], [1, 4, 1, 1], [4, 1, 1, 2]]);
    }

    #[test]
    fn rectangles_cover_each_cell_once() {
        let all = |n: u32| {
            (0..900).map(|k| (k / 30, k % 30)).filter(move |(i, j)| (i * i + 7 * i * j + 3 * j) % n < 2)
        };
        for n in 2..12 {
            let covered = |run: Run| {
                (0..run.across * run.up).map(move |k| (run.i + k % run.across, run.j + k / run.across))
            };
            let mut found: Vec<(u32, u32)> = rectangles(all(n)).into_iter().flat_map(covered).collect();
            found.sort_unstable();
            assert_eq!(found, all(n).collect::<Vec<_>>(), "modulo {n}");
        }
    }
}
