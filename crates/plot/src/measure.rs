//! Measures that drawing and layout share: the sizes of letters, the ticks that fit an axis, the way from
//! data to the page. Lengths are points.

use super::axis::{Axis, Tick};
use super::canvas::{Anchor, Set};
use super::clip::Rect;
use super::label::Label;
use super::palette::INK;

/// Sizes of letters.
pub(crate) const NUMBER: f64 = 8.0;
pub(crate) const WORDS: f64 = 9.0;
pub(crate) const TITLE: f64 = 9.5;
/// Ticks point outward, away from the data.
pub(crate) const TICK: f64 = 2.8;
pub(crate) const MINOR_TICK: f64 = 1.6;
/// Between a tick and its number, a number and the label, the frame and the edge of the paper.
pub(crate) const GAP: f64 = 2.2;
/// The least distance between two labelled ticks.
const APART: [f64; 2] = [34.0, 24.0];
/// Height of a capital relative to the size of the letters.
pub(crate) const CAPITAL: f64 = 0.72;
/// Height of a digit, and of a line of labels with its indices, relative to the size of the letters.
pub(crate) const DIGIT: f64 = 0.66;
pub(crate) const LINE: f64 = 1.15;

/// From data to the page.
#[derive(Clone, Copy)]
pub(crate) struct Plane<'a> {
    pub x: &'a Axis,
    pub y: &'a Axis,
    pub frame: Rect,
}

impl Plane<'_> {
    pub(crate) fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.across(self.x.unit(x)), self.down(self.y.unit(y))]
    }

    pub(crate) fn across(&self, unit: f64) -> f64 {
        self.frame[0] + unit * (self.frame[2] - self.frame[0])
    }

    pub(crate) fn down(&self, unit: f64) -> f64 {
        self.frame[3] - unit * (self.frame[3] - self.frame[1])
    }
}

/// A plain setting; the fields not given here are the common ones.
pub(crate) fn set(size: f64, anchor: Anchor) -> Set {
    Set { size, anchor, turn: 0.0, colour: INK, halo: false }
}

/// The ticks of a horizontal (0) or vertical (1) axis of the given length: as many as fit without crowding.
pub(crate) fn ticks(axis: &Axis, direction: usize, length: f64) -> Vec<Tick> {
    let mut most = (length / APART[direction]) as usize + 1;
    loop {
        let ticks = axis.marks(most);
        let labelled: Vec<&Tick> = ticks.iter().filter(|tick| tick.label.is_some()).collect();
        let crowded = labelled.windows(2).any(|pair| {
            let apart = (axis.unit(pair[1].at) - axis.unit(pair[0].at)).abs() * length;
            let wide = |tick: &Tick| number_width(tick);
            let needed =
                if direction == 0 { (wide(pair[0]) + wide(pair[1])) / 2.0 + 6.0 } else { 1.2 * NUMBER };
            apart < needed
        });
        if !crowded || most <= 2 {
            return ticks;
        }
        most -= 1;
    }
}

fn number_width(tick: &Tick) -> f64 {
    tick.label.as_ref().map_or(0.0, |label| NUMBER * Label::new(label).width)
}

/// By how much the numbers of a horizontal axis reach beyond its right end.
pub(crate) fn overhang(axis: &Axis, length: f64) -> f64 {
    let beyond = |tick: &Tick| number_width(tick) / 2.0 - (1.0 - axis.unit(tick.at)) * length;
    ticks(axis, 0, length).iter().map(beyond).fold(0.0, f64::max)
}

/// The width of the widest number on a vertical axis.
pub(crate) fn widest_number(axis: &Axis, length: f64) -> f64 {
    ticks(axis, 1, length).iter().map(number_width).fold(0.0, f64::max)
}

/// The room of ticks, numbers and label at the left of an upright axis so long.
pub(crate) fn beside(axis: &Axis, length: f64) -> f64 {
    let label = if axis.label.is_empty() { 0.0 } else { GAP + WORDS * LINE };
    TICK + GAP + widest_number(axis, length) + 1.5 + label
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_never_touch() {
        for length in [15.0, 40.0, 90.0, 300.0] {
            let axis = Axis::linear("", 0.731610, 0.731625);
            let at: Vec<(f64, f64)> = ticks(&axis, 0, length)
                .iter()
                .filter(|tick| tick.label.is_some())
                .map(|tick| (axis.unit(tick.at) * length, number_width(tick)))
                .collect();
            // Two numbers are the fewest an axis shows, even on one too short for them.
            let apart = at.windows(2).all(|w| w[1].0 - w[0].0 >= (w[0].1 + w[1].1) / 2.0);
            assert!(apart || at.len() <= 2, "{length}: {at:?}");
        }
    }
}
