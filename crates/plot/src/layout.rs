//! Where everything goes: room for titles, numbers and labels first, the frames share the rest.
//!
//! Frames in one row have one height, frames in one column one width, and all of a row or column line up,
//! whatever stands beside them. Lengths are points.

use super::clip::Rect;
use super::font::Face;
use super::key;
use super::label::wrapped;
use super::measure::{CAPITAL, DIGIT, GAP, LINE, NUMBER, TICK, TITLE, WORDS, beside, overhang};
use super::panel::Panel;

/// The paper's rim.
pub(crate) const RIM: f64 = 3.0;
/// Between two panels side by side, and one above the other.
const BESIDE: f64 = 11.0;
const BELOW: f64 = 18.0;

/// Where a panel stands on the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Site {
    /// The rectangle between the axes.
    pub frame: Rect,
    /// Where the row begins: all its titles hang from here.
    pub top: f64,
}

impl Site {
    /// Moves it down.
    pub(crate) fn lowered(self, by: f64) -> Site {
        let [left, top, right, bottom] = self.frame;
        Site { frame: [left, top + by, right, bottom + by], top: self.top + by }
    }
}

/// The place of each panel on a page of the given size.
pub(crate) fn sites(panels: &[Panel], columns: usize, width: f64, height: f64) -> Vec<Site> {
    let rows = panels.len().div_ceil(columns).max(1);
    let (row, column) = (|i: usize| i / columns, |i: usize| i % columns);
    let (width, height) =
        (width - 2.0 * RIM - BESIDE * (columns - 1) as f64, height - 2.0 * RIM - BELOW * (rows - 1) as f64);
    // Heights ask for a width where a legend stands above its frame, widths for a height where the numbers of
    // an axis stand beside it. From a guess at the width, two rounds settle both.
    let mut wide = width / columns as f64;
    let (mut high, mut vertical, mut horizontal) = (0.0, Vec::new(), Vec::new());
    for _ in 0..2 {
        let left = |panel: &Panel| beside(&panel.y, height / rows as f64);
        vertical = panels.iter().map(|panel| (above(panel, wide, left(panel)), below(panel))).collect();
        high = share(rows, &vertical, row, height);
        horizontal = panels.iter().map(|panel| (beside(&panel.y, high), right(panel, wide, high))).collect();
        wide = share(columns, &horizontal, column, width);
    }
    let xs = starts(columns, &horizontal, column, wide + BESIDE);
    let ys = starts(rows, &vertical, row, high + BELOW);
    (0..panels.len())
        .map(|i| ((xs[column(i)].1, ys[row(i)].1), ys[row(i)].0))
        .map(|((x, y), top)| Site { frame: [x, y, x + wide, y + high], top })
        .collect()
}

/// The most room that the members of a track want before and after their frames.
fn wants(track: usize, rooms: &[(f64, f64)], of: impl Fn(usize) -> usize) -> (f64, f64) {
    let members = rooms.iter().enumerate().filter(|(i, _)| of(*i) == track);
    members.fold((0.0, 0.0), |(a, b), (_, room)| (f64::max(a, room.0), f64::max(b, room.1)))
}

/// The length that is left for each frame.
fn share(count: usize, rooms: &[(f64, f64)], of: impl Fn(usize) -> usize + Copy, length: f64) -> f64 {
    let taken: f64 = (0..count).map(|track| wants(track, rooms, of)).map(|(a, b)| a + b).sum();
    // On paper too small for its labels the frames still exist, and overlap.
    ((length - taken) / count as f64).max(10.0)
}

/// Where each track begins, and where its frames do, when a frame and the gap behind it take `pitch`.
fn starts(
    count: usize,
    rooms: &[(f64, f64)],
    of: impl Fn(usize) -> usize + Copy,
    pitch: f64,
) -> Vec<(f64, f64)> {
    let mut at = RIM;
    (0..count)
        .map(|track| {
            let (before, after) = wants(track, rooms, of);
            let begin = at;
            at += before + pitch + after;
            (begin, begin + before)
        })
        .collect()
}

fn above(panel: &Panel, width: f64, left: f64) -> f64 {
    let title = title_height(panel, width);
    let legend = if panel.legend.is_some() { key::rows_height(panel, width, left) } else { 0.0 };
    // The topmost number of the vertical axis reaches over the frame by half its height.
    (title + legend).max(NUMBER * DIGIT / 2.0)
}

/// The height that the title takes above the legend or the frame, which is so wide.
fn title_height(panel: &Panel, width: f64) -> f64 {
    match wrapped(&panel.title, Face::Semibold, width / TITLE).len() {
        0 => 0.0,
        lines => TITLE * CAPITAL + TITLE * LINE * (lines - 1) as f64 + 6.0,
    }
}

fn below(panel: &Panel) -> f64 {
    let label = if panel.x.label.is_empty() { 0.0 } else { GAP + WORDS * LINE };
    TICK + GAP + NUMBER * DIGIT + 2.0 + label
}

fn right(panel: &Panel, width: f64, height: f64) -> f64 {
    match &panel.bar {
        Some(bar) => key::bar_width(bar, height),
        // The last number of the horizontal axis reaches over the frame, by half its width at most: over the
        // rim, too, but not over the paper.
        None => (overhang(&panel.x, width) - RIM).max(7.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Axis;

    fn panel(label: &str) -> Panel {
        Panel::new(Axis::linear("x", 0.0, 1.0), Axis::linear(label, 0.0, 1.0))
    }

    #[test]
    fn a_long_last_number_stays_on_the_page() {
        let x = Axis::linear("x", 0.0043, 0.0045);
        let panel = Panel::new(x.clone(), Axis::linear("y", 0.0, 1.0));
        let [left, _, right, _] = sites(&[panel], 1, 400.0, 200.0)[0].frame;
        let beyond = overhang(&x, right - left);
        assert!(beyond > 7.0 + RIM, "{beyond}: no such number");
        assert!(right + beyond <= 400.0, "{right} + {beyond}");
    }

    #[test]
    fn frames_line_up_and_stay_on_the_page() {
        let panels = [panel("y").titled("a"), panel(""), panel("y"), panel("").titled("d")];
        let found: Vec<Rect> = sites(&panels, 2, 400.0, 300.0).iter().map(|site| site.frame).collect();
        assert_eq!((found[0][0], found[0][2]), (found[2][0], found[2][2]));
        assert_eq!((found[0][1], found[0][3]), (found[1][1], found[1][3]));
        assert!((found[1][2] - found[1][0] - (found[0][2] - found[0][0])).abs() < 1e-9);
        for (frame, panel) in found.iter().zip(&panels) {
            let (wide, high) = (frame[2] - frame[0], frame[3] - frame[1]);
            assert!(
                frame[0] >= beside(&panel.y, high) && frame[1] >= above(panel, wide, beside(&panel.y, high)),
                "{frame:?}"
            );
            assert!(
                frame[2] + right(panel, wide, high) <= 400.0 && frame[3] + below(panel) <= 300.0,
                "{frame:?}"
            );
        }
    }
}
