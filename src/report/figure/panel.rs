//! A panel: two axes and what stands between them.

use super::axis::Axis;
use super::canvas::Anchor;
use super::layer::Layer;
use super::palette::{Colour, Gradient, INK};

/// Where the legend stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// In lines between title and frame: never over the data.
    Above,
    /// In a corner of the panel.
    TopLeft,
    /// In a corner of the panel.
    TopRight,
    /// In a corner of the panel.
    BottomLeft,
    /// In a corner of the panel.
    BottomRight,
}

/// The key to a gradient, at the right of a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourBar {
    /// The values that the colours stand for; the gradient runs evenly along it.
    pub axis: Axis,
    /// The colours.
    pub gradient: Gradient,
}

impl ColourBar {
    /// Shades of a gradient: neighbours are barely told apart.
    pub const SHADES: u16 = 40;

    /// The range of a bar of rates of growth: from the largest down to the decade of the smallest but one in
    /// twenty. Near the edges of tongues growth falls to zero, and a few of these would stretch the bar beyond
    /// use; they take its last colour. Without a rate at all a range that has none: [`Axis::log`] replaces it.
    pub fn range_of(rates: impl Iterator<Item = f64>) -> (f64, f64) {
        let mut rates: Vec<f64> = rates.collect();
        rates.sort_unstable_by(f64::total_cmp);
        let largest = rates.last().copied().unwrap_or(1.0);
        let small = rates.get(rates.len() / 20).copied().unwrap_or(largest);
        (10f64.powi(small.log10().floor() as i32), largest)
    }

    /// The colour of a value.
    pub fn colour(&self, value: f64) -> Colour {
        self.gradient.at(self.axis.unit(value))
    }

    /// The place of a value among `n` equal parts of the bar, for [`Cells`](super::layer::Cells) of
    /// [`steps(n)`](Gradient::steps) colours.
    pub fn class(&self, value: f64, n: u16) -> u16 {
        // A float becomes an integer by saturation, and what is not a number becomes 0: the lowest part.
        ((self.axis.unit(value) * f64::from(n)) as u16).min(n.saturating_sub(1))
    }
}

/// Words at a point of the data.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    pub(super) at: [f64; 2],
    pub(super) text: String,
    pub(super) anchor: Anchor,
    pub(super) shift: [f64; 2],
    pub(super) turn: f64,
    pub(super) colour: Colour,
}

impl Note {
    /// Words that begin a little to the right of a point.
    pub fn new(at: [f64; 2], text: &str) -> Self {
        Note { at, text: text.into(), anchor: Anchor::Start, shift: [3.0, 0.0], turn: 0.0, colour: INK }
    }

    /// The same words with another side at the point, moved by so many points right and up.
    #[must_use]
    pub fn anchored(mut self, anchor: Anchor, shift: [f64; 2]) -> Self {
        (self.anchor, self.shift) = (anchor, shift);
        self
    }

    /// The same words, turned counterclockwise by so many degrees.
    #[must_use]
    pub fn turned(mut self, degrees: f64) -> Self {
        self.turn = degrees;
        self
    }

    /// The same words in another colour.
    #[must_use]
    pub fn in_colour(mut self, colour: Colour) -> Self {
        self.colour = colour;
        self
    }
}

/// Two axes and what stands between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    pub(super) title: String,
    pub(super) x: Axis,
    pub(super) y: Axis,
    pub(super) layers: Vec<Layer>,
    pub(super) notes: Vec<Note>,
    pub(super) legend: Option<Place>,
    pub(super) bar: Option<ColourBar>,
    pub(super) grid: bool,
}

impl Panel {
    /// An empty panel.
    pub fn new(x: Axis, y: Axis) -> Self {
        let (layers, notes) = (Vec::new(), Vec::new());
        Panel { title: String::new(), x, y, layers, notes, legend: None, bar: None, grid: false }
    }

    /// The same panel with a title, in the notation of labels.
    #[must_use]
    pub fn titled(mut self, title: &str) -> Self {
        self.title = title.into();
        self
    }

    /// The same panel with one more layer on top.
    #[must_use]
    pub fn with(mut self, layer: Layer) -> Self {
        self.layers.push(layer);
        self
    }

    /// The same panel with a note above all layers.
    #[must_use]
    pub fn note(mut self, note: Note) -> Self {
        self.notes.push(note);
        self
    }

    /// The same panel with a legend of its labelled layers.
    #[must_use]
    pub fn legend(mut self, place: Place) -> Self {
        self.legend = Some(place);
        self
    }

    /// The same panel with a colour bar.
    #[must_use]
    pub fn bar(mut self, bar: ColourBar) -> Self {
        self.bar = Some(bar);
        self
    }

    /// The same panel with faint lines at the labelled ticks.
    #[must_use]
    pub fn gridded(mut self) -> Self {
        self.grid = true;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_in_twenty_may_lie_below_the_decades_of_a_bar() {
        let rates = |weak: usize| (0..20).map(move |n| if n < weak { 2e-9 } else { 0.02 + 0.1 * n as f64 });
        assert_eq!(ColourBar::range_of(rates(1)), (0.1, 0.02 + 0.1 * 19.0));
        assert_eq!(ColourBar::range_of(rates(2)).0, 1e-9);
        assert_eq!(ColourBar::range_of(std::iter::empty()), (1.0, 1.0));
    }
}
