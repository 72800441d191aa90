//! Strokes over areas: exact to the outline, and unbroken from one outline to the next.

use std::collections::BTreeMap;

use super::canvas::Path;
use super::layer::Hatch;

/// Between two strokes, in points, and their width.
const PITCH: f64 = 3.0;
pub(crate) const WIDTH: f64 = 0.45;
/// Pieces of a stroke that are no further apart than this are one, in points: coordinates are hundredths.
const TOUCHING: f64 = 0.02;
/// Shorter pieces are left out: on a lonely cell, as small as print takes, a stroke would be all that is
/// seen.
const SHORTEST: f64 = 0.9;

impl Hatch {
    /// Unit vectors along the strokes, each with the distance of its strokes.
    fn directions(self) -> Vec<([f64; 2], f64)> {
        // Down is positive on the page.
        let diagonal = std::f64::consts::FRAC_1_SQRT_2;
        let (rising, falling) = ([diagonal, -diagonal], [diagonal, diagonal]);
        let (level, upright) = ([1.0, 0.0], [0.0, 1.0]);
        let plain = |way| (way, PITCH);
        match self {
            Hatch::Rising => vec![plain(rising)],
            Hatch::Falling => vec![plain(falling)],
            Hatch::Level => vec![plain(level)],
            Hatch::Upright => vec![plain(upright)],
            Hatch::Crossed => vec![plain(rising), plain(falling)],
            Hatch::Chequered => vec![plain(level), plain(upright)],
            Hatch::Dense => vec![(rising, 0.5 * PITCH)],
        }
    }

    /// The strokes over closed outlines on the page that do not overlap.
    pub(crate) fn over<'a>(self, outlines: impl Iterator<Item = &'a [[f64; 2]]> + Clone) -> Path {
        let mut path = Path::default();
        for (way, pitch) in self.directions() {
            // Stroke n is where the coordinate across is n pitches: on the whole page the same strokes.
            let mut strokes: BTreeMap<i64, Vec<[f64; 2]>> = BTreeMap::new();
            for outline in outlines.clone() {
                for (n, crossings) in crossings(outline, way, pitch) {
                    strokes
                        .entry(n)
                        .or_default()
                        .extend(crossings.chunks_exact(2).map(|pair| [pair[0], pair[1]]));
                }
            }
            for (n, pieces) in strokes {
                let across = pitch * n as f64;
                let at = |along: f64| [along * way[0] - across * way[1], along * way[1] + across * way[0]];
                for [from, upto] in joined(pieces).into_iter().filter(|[from, upto]| upto - from >= SHORTEST)
                {
                    path.move_to(at(from));
                    path.line_to(at(upto));
                }
            }
        }
        path
    }
}

/// Where an outline crosses each stroke, along it, in order: it is inside from the first to the second, and
/// so on.
fn crossings(outline: &[[f64; 2]], way: [f64; 2], pitch: f64) -> BTreeMap<i64, Vec<f64>> {
    let turned = |[x, y]: [f64; 2]| [x * way[0] + y * way[1], (y * way[0] - x * way[1]) / pitch];
    let mut found: BTreeMap<i64, Vec<f64>> = BTreeMap::new();
    for (i, &from) in outline.iter().enumerate() {
        let ([u, a], [v, b]) = (turned(from), turned(outline[(i + 1) % outline.len()]));
        // Half open: a corner on a stroke counts for one of its two sides.
        let (low, high) = (a.min(b).ceil() as i64, a.max(b).ceil() as i64);
        for n in low..high {
            found.entry(n).or_default().push(u + (n as f64 - a) / (b - a) * (v - u));
        }
    }
    found.values_mut().for_each(|along| along.sort_unstable_by(f64::total_cmp));
    found
}

/// Pieces that touch as one.
fn joined(mut pieces: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    pieces.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
    let mut all: Vec<[f64; 2]> = Vec::new();
    for [from, upto] in pieces {
        match all.last_mut() {
            Some(last) if from <= last[1] + TOUCHING => last[1] = last[1].max(upto),
            _ => all.push([from, upto]),
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::Step;

    fn square(x: f64, y: f64, side: f64) -> Vec<[f64; 2]> {
        vec![[x, y], [x + side, y], [x + side, y + side], [x, y + side]]
    }

    fn strokes(hatch: Hatch, outlines: &[Vec<[f64; 2]>]) -> Vec<[i64; 4]> {
        let steps = hatch.over(outlines.iter().map(Vec::as_slice)).steps;
        let both = |pair: &[Step]| match pair {
            [Step::Move(a, b), Step::Line(c, d)] => [*a, *b, *c, *d],
            other => panic!("{other:?}"),
        };
        steps.chunks(2).map(both).collect()
    }

    #[test]
    fn strokes_end_at_the_outline() {
        assert_eq!(
            strokes(Hatch::Level, &[square(1.0, 2.0, 5.0)]),
            [[100, 300, 600, 300], [100, 600, 600, 600]]
        );
        // Across a triangle: what lies between its sides.
        let triangle = vec![[0.0, 0.0], [8.0, 0.0], [0.0, 8.0]];
        assert_eq!(
            strokes(Hatch::Level, &[triangle]),
            [[0, 0, 800, 0], [0, 300, 500, 300], [0, 600, 200, 600]]
        );
        assert!(
            strokes(Hatch::Crossed, &[square(0.0, 0.0, 9.0)]).iter().flatten().all(|x| (0..=900).contains(x))
        );
    }

    #[test]
    fn strokes_go_on_from_one_cell_to_the_next() {
        let two = [square(0.0, 0.0, 5.0), square(5.0, 0.0, 5.0)];
        assert_eq!(strokes(Hatch::Level, &two), [[0, 0, 1000, 0], [0, 300, 1000, 300]]);
        let apart = [square(0.0, 0.0, 5.0), square(6.0, 0.0, 5.0)];
        assert_eq!(strokes(Hatch::Level, &apart).len(), 4);
    }

    #[test]
    fn a_lonely_cell_is_left_as_it_is() {
        let cells: Vec<_> = (0..50).map(|n| square(7.1 * f64::from(n), 3.3 * f64::from(n), 0.35)).collect();
        assert!(strokes(Hatch::Crossed, &cells).is_empty());
    }
}
