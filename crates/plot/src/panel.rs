//! A panel: two axes and what stands between them.

use super::axis::Axis;
use super::canvas::Anchor;
use super::label::Label;
use super::layer::Layer;
use super::measure::NUMBER;
use super::palette::{Colour, Gradient, INK};

/// Where the legend stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In lines between title and frame: never over the data.
    Above,
}

/// The key to a gradient, at the right of a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourBar {
    pub(crate) axis: Axis,
    pub(crate) gradient: Gradient,
    /// Whether there are values below and above: an arrow each.
    pub(crate) beyond: [bool; 2],
}

/// From the strongest to the weakest of what a bar of rates resolves.
const RESOLVED: f64 = 100.0;

impl ColourBar {
    /// Shades of a gradient: neighbours barely differ.
    pub const SHADES: u16 = 40;

    /// The values that the colours stand for; the gradient runs evenly along the axis.
    pub fn new(axis: Axis, gradient: Gradient) -> Self {
        ColourBar { axis, gradient, beyond: [false; 2] }
    }

    /// Puts an arrow at each end beyond which some of these values lie: they take its last colours.
    #[must_use]
    pub fn over(mut self, values: impl Iterator<Item = f64>) -> Self {
        for unit in values.map(|value| self.axis.unit(value)) {
            self.beyond[0] |= unit < -1e-9;
            self.beyond[1] |= unit > 1.0 + 1e-9;
        }
        self
    }

    /// The range of a bar of rates of growth: up to the largest but one in a hundred, so that a few do not
    /// darken all others, and down to the smallest but one in twenty or to the hundredth part: near the edges
    /// of tongues growth falls to zero. Without a rate at all a range that has none: [`Axis::log`] replaces
    /// it.
    pub fn range_of(rates: impl Iterator<Item = f64>) -> (f64, f64) {
        let mut rates: Vec<f64> = rates.collect();
        rates.sort_unstable_by(f64::total_cmp);
        let at = |part: usize| rates.get(part).copied().unwrap_or(1.0);
        let high = at(rates.len().saturating_sub(1 + rates.len() / 100));
        (at(rates.len() / 20).max(high / RESOLVED), high)
    }

    /// Its colours in `n` steps, for [`class`](Self::class).
    pub fn steps(&self, n: u16) -> Vec<Colour> {
        self.gradient.steps(n.into())
    }

    /// The colour of a value.
    pub fn colour(&self, value: f64) -> Colour {
        self.gradient.at(self.axis.unit(value))
    }

    /// The place of a value among `n` equal parts of the bar, for [`Cells`](super::layer::Cells) of
    /// [`steps(n)`](Self::steps) colours.
    pub fn class(&self, value: f64, n: u16) -> u16 {
        // A float becomes an integer by saturation, and what is not a number becomes 0: the lowest part.
        ((self.axis.unit(value) * f64::from(n)) as u16).min(n.saturating_sub(1))
    }
}

/// Words at a point of the data.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Note {
    pub(crate) at: [f64; 2],
    pub(crate) text: String,
    pub(crate) anchor: Anchor,
    pub(crate) shift: [f64; 2],
    pub(crate) turn: f64,
    pub(crate) colour: Colour,
}

impl Note {
    /// Words that begin a little to the right of a point.
    pub fn new(at: [f64; 2], text: &str) -> Self {
        Note { at, text: text.into(), anchor: Anchor::Start, shift: [3.0, 0.0], turn: 0.0, colour: INK }
    }

    /// The letters alone.
    pub fn words(&self) -> String {
        Label::new(&self.text).words
    }

    /// Whether the words stand upright.
    pub fn is_turned(&self) -> bool {
        self.turn != 0.0
    }

    /// How wide the words are, in points.
    pub fn width(&self) -> f64 {
        NUMBER * Label::new(&self.text).width
    }

    /// Puts another side of the words at the point, moved by so many points right and up.
    pub fn anchored(mut self, anchor: Anchor, shift: [f64; 2]) -> Self {
        (self.anchor, self.shift) = (anchor, shift);
        self
    }

    /// Turns the words counterclockwise by so many degrees.
    pub fn turned(mut self, degrees: f64) -> Self {
        self.turn = degrees;
        self
    }

    /// Changes the colour of the words.
    pub fn in_colour(mut self, colour: Colour) -> Self {
        self.colour = colour;
        self
    }
}

/// Two axes and what stands between them.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Panel {
    pub(crate) title: String,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) layers: Vec<Layer>,
    pub(crate) notes: Vec<Note>,
    pub(crate) legend: Option<Place>,
    pub(crate) bar: Option<ColourBar>,
    pub(crate) grid: bool,
}

impl Panel {
    /// An empty panel.
    pub fn new(x: Axis, y: Axis) -> Self {
        let (layers, notes) = (Vec::new(), Vec::new());
        Panel { title: String::new(), x, y, layers, notes, legend: None, bar: None, grid: false }
    }

    /// Gives it a title, in the notation of labels.
    pub fn titled(mut self, title: &str) -> Self {
        self.title = title.into();
        self
    }

    /// Puts a layer on top.
    pub fn with(mut self, layer: Layer) -> Self {
        self.layers.push(layer);
        self
    }

    /// Puts a note above all layers.
    pub fn note(mut self, note: Note) -> Self {
        self.notes.push(note);
        self
    }

    /// Replaces its horizontal axis: of panels that share one the last has its name.
    pub fn over(mut self, x: Axis) -> Self {
        self.x = x;
        self
    }

    /// Gives it a legend of its labelled layers.
    pub fn legend(mut self, place: Place) -> Self {
        self.legend = Some(place);
        self
    }

    /// Gives it a colour bar.
    pub fn bar(mut self, bar: ColourBar) -> Self {
        self.bar = Some(bar);
        self
    }

    pub(crate) fn has_time(&self) -> bool {
        [&self.x, &self.y].into_iter().chain(self.bar.as_ref().map(|bar| &bar.axis)).any(Axis::has_time)
    }

    /// Names the unit of time at its axes.
    pub(crate) fn in_units_of(&self, unit: &str) -> Self {
        let bar = self.bar.clone().map(|bar| ColourBar { axis: bar.axis.in_units_of(unit), ..bar });
        Panel { x: self.x.in_units_of(unit), y: self.y.in_units_of(unit), bar, ..self.clone() }
    }

    /// Draws faint lines at the labelled ticks.
    pub fn gridded(mut self) -> Self {
        self.grid = true;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_leaves_out_the_weakest_and_a_few_of_the_strongest() {
        let rates = |weak: usize| (0..20).map(move |n| if n < weak { 2e-9 } else { 0.02 + 0.1 * n as f64 });
        assert_eq!(ColourBar::range_of(rates(1)), (0.02 + 0.1, 0.02 + 0.1 * 19.0));
        assert_eq!(ColourBar::range_of(rates(2)).0, (0.02 + 0.1 * 19.0) / RESOLVED);
        assert_eq!(ColourBar::range_of((1..=200).map(f64::from)), (11.0, 198.0));
        assert_eq!(ColourBar::range_of(std::iter::empty()), (1.0, 1.0));
        let bar = ColourBar::new(Axis::log("", 1.0, 2.0), Gradient::on_white());
        assert_eq!(bar.clone().over([1.0, 2.0].into_iter()).beyond, [false, false]);
        assert_eq!(bar.clone().over([0.5, 1.5].into_iter()).beyond, [true, false]);
        assert_eq!(bar.over([1.0, f64::INFINITY].into_iter()).beyond, [false, true]);
    }
}
