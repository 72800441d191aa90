//! The atlas: every tongue as the segment that it is in the (h1, h2) plane, over the curves (a, b).
//!
//! Along the ray h2 = h1 p/q a tongue is the segment between its two edges; nothing is sampled, so what is
//! thinner than any grid is there too: as a dot as wide as the lines.

use plot::palette::{self, COEXISTENCE, Colour, Gradient};
use plot::{Axis, ColourBar, Figure, Layer, Panel, Place, Shape, Stroke};

use super::chart::{FAMILIES, axis, family_name, grouped, rank};
use super::lines::lines_in;
use clocks::resonance::{Curve, Window};

/// A tongue in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// (h1, h2) of its edges.
    pub from: [f64; 2],
    pub to: [f64; 2],
    /// The a of its dominant family.
    pub a: i64,
    /// Its fastest growth per unit time, where colours show it.
    pub rate: Option<f64>,
    pub closed: bool,
}

/// The tongues and curves that are drawn.
#[derive(Clone, Debug)]
pub struct Atlas<'a> {
    pub window: Window,
    pub segments: &'a [Segment],
    pub curves: &'a [Curve],
    /// Shown above.
    pub title: String,
}

/// The lines' width in points, and how many points the panel is across, about: what is shorter than the width
/// becomes a dot.
const WIDTH: f64 = 0.55;
const ACROSS: f64 = 320.0;
/// A line in the legend, wide enough to show its colour.
const SAMPLE: f64 = 2.0;
/// The families' marks, for those who see no colours: on the middle of each segment that is longer than so
/// many points; the strongest family is the one without.
const SHAPES: [Option<Shape>; FAMILIES] = [
    None,
    Some(Shape::Triangle),
    Some(Shape::Square),
    Some(Shape::Diamond),
    Some(Shape::Cross),
    Some(Shape::Ring),
    Some(Shape::Disc),
];
const MARKED: f64 = 1.6;
const MARK: f64 = 2.0;
/// The size of a mark in the legend.
const SAMPLED: f64 = 4.0;
/// Curves, behind the tongues.
const PALE: Colour = Colour(0xc2, 0xc5, 0xcc);

impl Atlas<'_> {
    /// Families in colours of their own.
    pub fn by_family(&self) -> Figure {
        let mut ranks: Vec<f64> = self.open().map(|segment| rank(segment.a)).collect();
        ranks.sort_unstable_by(f64::total_cmp);
        ranks.dedup();
        let (values, others) = ranks.split_at(ranks.len().min(FAMILIES));
        // Each curve in a pale shade of its family's hue: the pattern of the line names the family, too.
        let place = |a| values.iter().position(|&value| value == rank(a));
        let mut panel = self.panel(|a| place(a).map_or(PALE, palette::behind), "family ");
        for (n, &value) in values.iter().enumerate() {
            panel = entry(panel, palette::family(n), SHAPES[n], &family_name(value));
        }
        // The weak ones first: the strong ones lie on top.
        if let Some(&first) = others.first() {
            let rest: Vec<&Segment> = self.open().filter(|segment| rank(segment.a) >= first).collect();
            let grey = palette::family(FAMILIES);
            panel = self.put(entry(panel, grey, None, "others"), &rest, grey);
        }
        for (n, &value) in values.iter().enumerate().rev() {
            let family: Vec<&Segment> = self.open().filter(|segment| rank(segment.a) == value).collect();
            panel = self.put(panel, &family, palette::family(n));
            if let Some(shape) = SHAPES[n] {
                let long = family.iter().filter(|segment| self.length(segment) > MARKED);
                let middles = long.map(|segment| middle(segment)).collect();
                panel = panel.with(Layer::dots(middles, shape, MARK, palette::family(n)));
            }
        }
        self.finish(panel, 135.0)
    }

    /// The fastest growth on a gradient; in the last tongue of a ratio growth has no bound, and the strongest
    /// colour.
    pub fn by_growth(&self) -> Figure {
        let bar = self.bar();
        let mut panel = self.panel(|_| PALE, "curves ");
        for (class, colour) in (0..ColourBar::SHADES).zip(bar.steps(ColourBar::SHADES)) {
            let rate = |segment: &Segment| segment.rate.unwrap_or(f64::INFINITY);
            let of_class = |segment: &&Segment| bar.class(rate(segment), ColourBar::SHADES) == class;
            let segments: Vec<&Segment> = self.open().filter(of_class).collect();
            panel = self.put(panel, &segments, colour);
        }
        self.finish(panel.bar(bar), 150.0)
    }

    fn bar(&self) -> ColourBar {
        let rates = self.open().filter_map(|segment| segment.rate).filter(|rate| *rate > 0.0);
        let (low, high) = ColourBar::range_of(rates);
        let axis = Axis::log("growth rate", low, high).per_time();
        let all = self.open().map(|segment| segment.rate.unwrap_or(f64::INFINITY));
        ColourBar::new(axis, Gradient::on_white()).over(all)
    }

    fn open(&self) -> impl Iterator<Item = &Segment> {
        self.segments.iter().filter(|segment| !segment.closed)
    }

    /// The curves, in the background. A family's curves and tongues share a name, and so an entry.
    fn panel(&self, colour: impl Fn(i64) -> Colour, before: &str) -> Panel {
        let Window { h1, h2 } = self.window;
        let panel = Panel::new(axis("*h*_1", h1).of_time(), axis("*h*_2", h2).of_time()).titled(&self.title);
        lines_in(colour, before, panel, self.curves)
    }

    fn put(&self, mut panel: Panel, segments: &[&Segment], colour: Colour) -> Panel {
        let (dots, lines): (Vec<&Segment>, Vec<&Segment>) = segments.iter().partition(|s| self.is_short(s));
        let points = dots.into_iter().map(middle).collect::<Vec<_>>();
        let lines = lines.into_iter().map(|s| vec![s.from, s.to]).collect::<Vec<_>>();
        if points.is_empty() && lines.is_empty() {
            return panel;
        }
        panel = panel.with(Layer::dots(points, Shape::Disc, WIDTH, colour));
        panel.with(Layer::lines(lines, Stroke::LINE.in_colour(colour).wide(WIDTH)))
    }

    fn is_short(&self, segment: &Segment) -> bool {
        self.length(segment) < WIDTH
    }

    /// On paper, in points, about.
    fn length(&self, segment: &Segment) -> f64 {
        let share = |i: usize, (lo, hi): (f64, f64)| (segment.to[i] - segment.from[i]) / (hi - lo);
        share(0, self.window.h1).hypot(share(1, self.window.h2)) * ACROSS
    }

    fn finish(&self, mut panel: Panel, wide: f64) -> Figure {
        let closed: Vec<[f64; 2]> = self.segments.iter().filter(|s| s.closed).map(|s| s.from).collect();
        if !closed.is_empty() {
            let layer = Layer::dots(closed, Shape::Ring, 3.0, COEXISTENCE);
            panel = panel.with(layer.labelled("closed tongue (coexistence)"));
        }
        let name = format!("Atlas of tongues; {}", grouped(self.segments.len() as u64));
        Figure::new(wide, 140.0).named(&name).with(panel.legend(Place::Above))
    }
}

/// A legend's entry alone, so that entries stand in the order of families and tongues in that of strength.
fn entry(panel: Panel, colour: Colour, shape: Option<Shape>, label: &str) -> Panel {
    let line = Layer::lines(
        Vec::new(),
        Stroke::LINE.in_colour(colour).wide(if shape.is_some() { WIDTH } else { SAMPLE }),
    );
    let line = shape.map_or(line.clone(), |shape| line.marked(shape, SAMPLED));
    panel.with(line.labelled(label))
}

fn middle(segment: &Segment) -> [f64; 2] {
    [0, 1].map(|i| 0.5 * (segment.from[i] + segment.to[i]))
}
