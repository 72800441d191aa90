//! Where the labels of a diagram stand: m (a, b) inside its tongue or beside it, on nothing else; upright
//! where it is narrow, and m alone where neither fits.

use plot::{Anchor, Note};

use clocks::tongue::sampled::{Band, Diagram, LARGEST_S};

/// Heights that are tried, from the bottom to the top, and where a tongue's edges are looked at along a
/// label.
const HEIGHTS: usize = 40;
const SAMPLES: usize = 8;
/// The height of letters, the distance to what is not to be touched, half a ring, in points.
const LETTERS: f64 = 7.0;
const APART: f64 = 2.0;
const RING: f64 = 3.5;
/// From the baseline of letters to their middle.
const MIDDLE: f64 = 1.84;

/// [left, bottom, right, top] in points from the frame's lower left corner.
type Place = [f64; 4];

/// A frame of so many points, and what is in it already.
struct Page<'a> {
    own: &'a Diagram,
    size: [f64; 2],
    taken: Vec<Place>,
}

/// How a label may stand.
#[derive(Clone, Copy)]
struct Way {
    inside: bool,
    turned: bool,
    /// Whether it may stand over a line p θ = m π.
    crossing: bool,
}

/// The ways to set the whole label, the best first; m alone is level.
const WAYS: [Way; 8] = {
    const fn way(inside: bool, turned: bool, crossing: bool) -> Way {
        Way { inside, turned, crossing }
    }
    [
        way(true, false, false),
        way(false, false, false),
        way(true, true, false),
        way(false, true, false),
        way(true, false, true),
        way(false, false, true),
        way(true, true, true),
        way(false, true, true),
    ]
};

/// Notes on a frame of `size` points that shows ρ from 0 to `rho`.
pub(super) fn notes(own: &Diagram, rho: f64, size: [f64; 2]) -> Vec<Note> {
    let ring = |&[s, at]: &[f64; 2]| {
        let [x, y] = [s / LARGEST_S * size[0], at / rho * size[1]];
        [x - RING, y - RING, x + RING, y + RING]
    };
    let mut page = Page { own, size, taken: own.closings.iter().map(ring).collect() };
    // The narrowest first: they have the fewest places.
    let mut order: Vec<usize> = (0..own.bands.len()).collect();
    let breadth = |n: &usize| own.bands[*n].edges.iter().map(|edge| edge[1] - edge[0]).fold(0.0, f64::max);
    order.sort_by(|a, b| breadth(a).total_cmp(&breadth(b)));
    let mut notes: Vec<(usize, Note)> =
        order.into_iter().filter_map(|n| Some((n, page.note(n, rho)?))).collect();
    notes.sort_by_key(|(n, _)| *n);
    notes.into_iter().map(|(_, note)| note).collect()
}

impl Page<'_> {
    fn note(&mut self, n: usize, rho: f64) -> Option<Note> {
        let band = &self.own.bands[n];
        let (a, b) = band.family;
        let texts = [format!("{} ({a}, {b})", band.m).replace('-', "−"), band.m.to_string()];
        let all = WAYS.map(|way| (&texts[0], way)).into_iter();
        let short = WAYS.into_iter().filter(|way| !way.turned).map(|way| (&texts[1], way));
        let (text, way, place) =
            all.chain(short).find_map(|(text, way)| Some((text, way, self.best(n, text, way)?)))?;
        self.taken.push(place);
        let [x, y] = [0.5 * (place[0] + place[2]), 0.5 * (place[1] + place[3])];
        let at = [x / self.size[0] * LARGEST_S, y / self.size[1] * rho];
        let note = Note::new(at, text);
        Some(match way.turned {
            true => note.anchored(Anchor::Middle, [MIDDLE, MIDDLE]).turned(90.0),
            false => note.anchored(Anchor::Middle, [0.0, 0.0]),
        })
    }

    /// The roomiest free place.
    fn best(&self, n: usize, text: &str, way: Way) -> Option<Place> {
        let letters = Note::new([0.0; 2], text).width();
        let [wide, high] = if way.turned { [LETTERS, letters] } else { [letters, LETTERS] };
        let [wide, high] = [wide + 2.0 * APART, high + 2.0 * APART];
        let heights = (0..=HEIGHTS).map(|k| 0.5 * high + (self.size[1] - high) * k as f64 / HEIGHTS as f64);
        let places = heights.filter(|_| high < self.size[1]).flat_map(|y| {
            let span = [y - 0.5 * high, y + 0.5 * high];
            self.centres(n, span, wide, way.inside)
                .into_iter()
                .map(move |(x, room)| ([x - 0.5 * wide, span[0], x + 0.5 * wide, span[1]], room))
        });
        let free = places.filter(|(place, _)| self.is_free(n, place, way));
        free.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
    }

    /// Where a label of this width may be centred, and how much room is left over.
    fn centres(&self, n: usize, span: [f64; 2], wide: f64, inside: bool) -> Vec<(f64, f64)> {
        let band = &self.own.bands[n];
        if inside {
            let Some([lower, upper]) = self.within(band, span) else { return Vec::new() };
            let room = upper - lower - wide;
            let shares = [0.5, 0.35, 0.65, 0.2, 0.8];
            let centre = |share: f64| (lower + 0.5 * wide + share * room, room - (share - 0.5).abs());
            return if room > 0.0 { shares.map(centre).to_vec() } else { Vec::new() };
        }
        let Some([lower, upper]) = self.around(band, span) else { return Vec::new() };
        let side =
            |n: Option<usize>| n.and_then(|n| self.own.bands.get(n)).and_then(|band| self.around(band, span));
        let before = side(n.checked_sub(1)).map_or(0.0, |values| values[1]);
        let after = side(Some(n + 1)).map_or(self.size[0], |values| values[0]).min(self.size[0]);
        let found = [(lower - 0.5 * wide, lower - before - wide), (upper + 0.5 * wide, after - upper - wide)];
        found.into_iter().filter(|(_, room)| *room >= 0.0).collect()
    }

    fn is_free(&self, n: usize, place: &Place, way: Way) -> bool {
        let [left, bottom, right, top] = *place;
        let meets =
            |other: &Place| left < other[2] && other[0] < right && bottom < other[3] && other[1] < top;
        let line = |&s: &f64| (left..right).contains(&(s / LARGEST_S * self.size[0]));
        let covers = |(k, band): (usize, &Band)| {
            let around = self.around(band, [bottom, top]);
            k != n && around.is_some_and(|[lower, upper]| left < upper && lower < right)
        };
        left >= 0.0
            && right <= self.size[0]
            && !self.taken.iter().any(meets)
            && (way.crossing || !self.own.resonances.iter().any(line))
            && !self.own.bands.iter().enumerate().any(covers)
    }

    /// A tongue's edges over a span of heights, in points, folded.
    fn edges(&self, band: &Band, span: [f64; 2], fold: [fn(f64, f64) -> f64; 2]) -> Option<[f64; 2]> {
        let last = band.edges.len().checked_sub(1)? as f64;
        let height = |k: usize| (span[0] + (span[1] - span[0]) * k as f64 / SAMPLES as f64) / self.size[1];
        let edges = (0..=SAMPLES).map(|k| band.edges[(height(k).clamp(0.0, 1.0) * last).round() as usize]);
        let scaled = edges.map(|[lower, upper, _]| [lower, upper].map(|s| s / LARGEST_S * self.size[0]));
        scaled.reduce(|a, b| [fold[0](a[0], b[0]), fold[1](a[1], b[1])])
    }

    /// The interval that a tongue covers somewhere in a span of heights.
    fn around(&self, band: &Band, span: [f64; 2]) -> Option<[f64; 2]> {
        self.edges(band, span, [f64::min, f64::max])
    }

    /// The interval that it covers all over a span of heights.
    fn within(&self, band: &Band, span: [f64; 2]) -> Option<[f64; 2]> {
        self.edges(band, span, [f64::max, f64::min]).map(|[lower, upper]| [lower, upper.min(self.size[0])])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tongues of equal widths between straight edges.
    fn diagram(lowers: &[f64], width: f64) -> Diagram {
        let band = |(n, &s): (usize, &f64)| {
            let edges = (0..=20).map(|k| [s, s + width, f64::from(k) / 20.0]).collect();
            Band { m: n as u64 + 1, family: (-1, 12), edges }
        };
        let bands = lowers.iter().enumerate().map(band).collect();
        let ratio = number::Ratio::new(5, 3).unwrap();
        Diagram { ratio, bands, resonances: Vec::new(), closings: Vec::new() }
    }

    fn said(diagram: &Diagram, size: [f64; 2]) -> Vec<(String, bool)> {
        let notes = notes(diagram, 1.0, size);
        notes.iter().map(|note| (note.words(), note.is_turned())).collect()
    }

    #[test]
    fn labels_turn_where_tongues_are_close_and_lose_their_families_where_they_are_closer() {
        let (wide, long) = ([400.0, 120.0], |m: u64, turned| (format!("{m} (−1, 12)"), turned));
        assert_eq!(said(&diagram(&[1.0, 3.0], 0.1), wide), [long(1, false), long(2, false)]);
        assert_eq!(said(&diagram(&[3.2, 3.45, 3.7], 0.05), wide).iter().filter(|pair| pair.1).count(), 2);
        // Too low for an upright label.
        let low = [400.0, 15.0];
        let short = said(&diagram(&[0.2, 0.45, 0.7, 0.95], 0.05), low);
        assert!(short.iter().any(|pair| pair.0 == "1") && short.iter().all(|pair| !pair.1), "{short:?}");
    }

    #[test]
    fn no_two_labels_meet_and_none_lies_on_another_tongue() {
        for columns in [200.0, 455.0] {
            let diagram = diagram(&[0.1, 0.3, 0.9, 1.2, 2.0, 2.4, 3.5], 0.08);
            let mut page = Page { own: &diagram, size: [columns, 120.0], taken: Vec::new() };
            for n in 0..diagram.bands.len() {
                page.note(n, 1.0);
            }
            for (i, [left, bottom, right, top]) in page.taken.iter().enumerate() {
                assert!(*left >= 0.0 && *right <= columns && *bottom >= 0.0 && *top <= 120.0);
                let apart = |other: &Place| {
                    left >= &other[2] || &other[0] >= right || bottom >= &other[3] || &other[1] >= top
                };
                assert!(page.taken[..i].iter().all(apart));
            }
        }
    }
}
