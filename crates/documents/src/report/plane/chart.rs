//! A map drawn: its unstable pairs in colour, the edges marked, the curves over them on request.

use plot::palette::{self, COEXISTENCE, Colour, GREY, Gradient, HYPERBOLIC, PARABOLIC};
use plot::{Anchor, Axis, Cells, ColourBar, Figure, Hatch, Layer, Note, Panel, Place, Shape};

use super::lines::{lines_in, stroke};
use super::raster::Raster;
use crate::report::map::{Counts, Found, marked};
use clocks::map::{Band, Enclosure, Grid, Products};
use clocks::propagator::rounded_bias;
use clocks::resonance::{Curve, Window};
use clocks::verdict::Kind;
use number::{Laurent, parallel};

/// The meaning of colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Colouring {
    /// Exponential growth, linear growth, closed tongues.
    #[default]
    Verdict,
    /// The growth rate per unit time.
    Growth,
    /// The a of the dominant family.
    Family,
    /// Slow steps until the amplitude is tenfold.
    Tenfold,
    /// How far the potential energy of stable pairs is off at the kicks: the larger of R and 1/R, in doubles.
    Bias,
}

impl Colouring {
    /// The products that these colours need.
    pub fn needs(self) -> Products {
        Products { label: self == Colouring::Family, growth: self.by_growth() }
    }

    fn by_growth(self) -> bool {
        matches!(self, Colouring::Growth | Colouring::Tenfold)
    }

    /// The larger, the stronger: of the pairs in a cell the strongest is shown.
    fn strength(self, found: &Found) -> f64 {
        // Growth so slow that its rate rounds to 0 is still shown, as the weakest.
        let positive = |x: Option<f64>| x.filter(|&x| x > 0.0).unwrap_or(f64::MIN_POSITIVE);
        match self {
            Colouring::Verdict | Colouring::Bias => 1.0,
            Colouring::Growth => positive(found.rate.map(Enclosure::middle)),
            Colouring::Tenfold => positive(found.tenfold.map(|steps| steps.middle().recip())),
            Colouring::Family => found.family.map_or(f64::NEG_INFINITY, |(a, _)| -rank(a)),
        }
    }
}

/// The place of a in 0, 1, -1, 2, -2, ...
pub(super) fn rank(a: i64) -> f64 {
    if a > 0 { 2.0 * a as f64 - 1.0 } else { -2.0 * a as f64 }
}

/// The a at a place.
pub(super) fn of_rank(rank: f64) -> i64 {
    let half = (rank / 2.0).ceil() as i64;
    if rank % 2.0 == 1.0 { half } else { -half }
}

/// An edge of a tongue; where both kinds meet in a cell, the rarer is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Edge {
    Parabolic,
    Coexistence,
}

/// A map on its way into a figure: memory is bounded by what paper can show.
#[derive(Clone, Debug)]
pub struct Chart {
    colouring: Colouring,
    growing: Raster<f64>,
    edges: Raster<Edge>,
    /// The larger of R and 1/R, where the colours stand for it.
    biased: Option<Raster<f64>>,
}

/// Families with a colour of their own; the others share the next, nearly a grey.
pub(super) const FAMILIES: usize = 7;
/// Pairs in points of paper; on an edge they are few and should be found.
const PAIR: f64 = 0.35;
const EDGE: f64 = 3.4;
/// An energy that is off by more has the colour of this one.
const WORST_BIAS: f64 = 10.0;

impl Chart {
    pub fn new(grid: &Grid, colouring: Colouring) -> Self {
        let biased = (colouring == Colouring::Bias).then(|| Raster::new(grid));
        Chart { colouring, growing: Raster::new(grid), edges: Raster::new(grid), biased }
    }

    /// Puts a band in.
    pub fn add(&mut self, grid: &Grid, band: &Band) {
        for pair in marked(grid, band) {
            match pair.decision.verdict.kind() {
                Kind::Elliptic => {}
                Kind::Hyperbolic => self.growing.put(pair.i, pair.j, self.colouring.strength(&pair.found())),
                Kind::Parabolic => self.edges.put(pair.i, pair.j, Edge::Parabolic),
                Kind::Coexistence => self.edges.put(pair.i, pair.j, Edge::Coexistence),
            }
        }
        if let Some(raster) = &mut self.biased {
            add_biases(raster, grid, band);
        }
    }

    /// The figure, with the curves given over it.
    pub fn figure(&self, grid: &Grid, counts: &Counts, curves: &[Curve]) -> Figure {
        let window = window(grid);
        let steps = [grid.steps().0.to_f64(), grid.steps().1.to_f64()];
        let mut panel = Panel::new(axis("*h*_1", window.h1).of_time(), axis("*h*_2", window.h2).of_time())
            .titled(&format!("{} of {} pairs unstable", grouped(counts.unstable), grouped(counts.pairs)));
        if !curves.is_empty() {
            panel = labels(lines_in(|_| GREY, "", panel, curves), curves, &window);
        }
        panel = match self.colouring {
            Colouring::Verdict => self.by_verdict(panel, steps),
            Colouring::Growth | Colouring::Tenfold => self.by_growth(panel, steps),
            Colouring::Family => self.by_family(panel, steps),
            Colouring::Bias => {
                self.biased.iter().fold(panel, |panel, biased| self.by_bias(panel, biased, steps))
            }
        };
        let (origin, pitch) = self.edges.geometry(steps);
        for (edge, shape, colour, name) in [
            (Edge::Parabolic, Shape::Triangle, PARABOLIC, "linear growth (parabolic)"),
            (Edge::Coexistence, Shape::Ring, COEXISTENCE, "closed tongue (coexistence)"),
        ] {
            let found = self.edges.filled().filter(|(_, _, value)| *value == edge);
            let place = |(k, l, _): (u32, u32, Edge)| {
                [origin[0] + pitch[0] * f64::from(k), origin[1] + pitch[1] * f64::from(l)]
            };
            let found: Vec<[f64; 2]> = found.map(place).collect();
            if !found.is_empty() {
                panel = panel.with(Layer::dots(found, shape, EDGE, colour).labelled(name));
            }
        }
        let has_bar = self.colouring.by_growth() || self.biased.is_some();
        let wide = if has_bar { 150.0 } else { 135.0 };
        Figure::new(wide, 135.0)
            .named(&format!("Stability map; {}", grid.fingerprint()))
            .with(panel.legend(Place::Above))
    }

    fn by_verdict(&self, panel: Panel, steps: [f64; 2]) -> Panel {
        panel.with(self.unstable(steps, HYPERBOLIC))
    }

    fn unstable(&self, steps: [f64; 2], colour: Colour) -> Layer {
        let mut cells = cells(&self.growing, steps, vec![colour]);
        self.growing.filled().for_each(|(k, l, _)| cells.push(k, l, 0));
        Layer::cells(cells).labelled("exponential growth (hyperbolic)")
    }

    fn by_growth(&self, panel: Panel, steps: [f64; 2]) -> Panel {
        let bar = self.bar();
        panel.with(shaded(&self.growing, steps, &bar, |strength| self.shown(strength))).bar(bar)
    }

    fn by_bias(&self, panel: Panel, biased: &Raster<f64>, steps: [f64; 2]) -> Panel {
        let axis = Axis::log("bias, the larger of *R* and 1/*R*", 1.0, WORST_BIAS);
        let bar = ColourBar::new(axis, Gradient::on_white()).over(biased.filled().map(|(_, _, bias)| bias));
        panel.with(shaded(biased, steps, &bar, |bias| bias)).with(self.unstable(steps, GREY)).bar(bar)
    }

    /// The quantity on the bar.
    fn shown(&self, strength: f64) -> f64 {
        if self.colouring == Colouring::Tenfold { strength.recip() } else { strength }
    }

    fn bar(&self) -> ColourBar {
        let (low, high) = ColourBar::range_of(self.growing.filled().map(|(_, _, strength)| strength));
        let shown = self.growing.filled().map(|(_, _, strength)| self.shown(strength));
        if self.colouring == Colouring::Tenfold {
            let axis = Axis::log("slow steps until tenfold", high.recip(), low.recip());
            return ColourBar::new(axis, Gradient::on_white().reversed()).over(shown);
        }
        let axis = Axis::log("growth rate", low, high).per_time();
        ColourBar::new(axis, Gradient::on_white()).over(shown)
    }

    fn by_family(&self, mut panel: Panel, steps: [f64; 2]) -> Panel {
        let mut ranks: Vec<f64> = self.growing.filled().map(|(_, _, strength)| -strength).collect();
        ranks.sort_unstable_by(f64::total_cmp);
        ranks.dedup();
        let (values, others) = ranks.split_at(ranks.len().min(FAMILIES));
        // Each family has a hatch, too, for those who see no colours or few.
        let layer = |n: usize, belongs: &dyn Fn(f64) -> bool| {
            let mut cells = cells(&self.growing, steps, vec![palette::family(n)]);
            let found = self.growing.filled().filter(|(_, _, strength)| belongs(-strength));
            found.for_each(|(k, l, _)| cells.push(k, l, 0));
            Layer::cells(cells).hatched(Hatch::of_family(n))
        };
        for (n, &rank) in values.iter().enumerate() {
            panel = panel.with(layer(n, &|value| value == rank).labelled(&family_name(rank)));
        }
        match others.first() {
            Some(&first) => panel.with(layer(FAMILIES, &|value| value >= first).labelled("others")),
            None => panel,
        }
    }
}

pub(super) fn family_name(rank: f64) -> String {
    if !rank.is_finite() {
        return "not labelled".into();
    }
    format!("family *a* = {}", of_rank(rank)).replace('-', "−")
}

/// R of the elliptic pairs; of the pairs in a cell the one that is most off is shown.
fn add_biases(raster: &mut Raster<f64>, grid: &Grid, band: &Band) {
    let biased = |n: usize| {
        let (i, j) = band.multipliers(grid, n);
        let clocks = grid.clocks(i, j).ok()?.map(Laurent::to_f64);
        rounded_bias(&clocks).map(|bias| (i, j, bias.max(bias.recip())))
    };
    let is_elliptic = |n: &usize| band.decision(*n).verdict.kind() == Kind::Elliptic;
    let column = |&column: &usize| -> Vec<_> {
        let positions = column * band.rows..(column + 1) * band.rows;
        positions.filter(is_elliptic).filter_map(biased).collect()
    };
    let columns: Vec<usize> = (0..band.columns).collect();
    for (i, j, bias) in parallel::map(&columns, column).into_iter().flatten() {
        raster.put(i, j, bias);
    }
}

/// Each cell in the shade of the value that the bar has for it.
fn shaded(raster: &Raster<f64>, steps: [f64; 2], bar: &ColourBar, shown: impl Fn(f64) -> f64) -> Layer {
    let mut cells = cells(raster, steps, bar.steps(ColourBar::SHADES));
    for (k, l, value) in raster.filled() {
        cells.push(k, l, bar.class(shown(value), ColourBar::SHADES));
    }
    Layer::cells(cells)
}

fn cells<T: Copy + PartialOrd>(raster: &Raster<T>, steps: [f64; 2], colours: Vec<Colour>) -> Cells {
    let (origin, pitch) = raster.geometry(steps);
    Cells::new(origin, pitch, colours).at_least(PAIR)
}

/// The cells of all pairs, from edge to edge.
pub fn window(grid: &Grid) -> Window {
    let edges =
        |(first, last): (u64, u64), step: f64| ((first as f64 - 0.5) * step, (last as f64 + 0.5) * step);
    Window {
        h1: edges(grid.columns(), grid.steps().0.to_f64()),
        h2: edges(grid.rows(), grid.steps().1.to_f64()),
    }
}

/// An axis over the range; one that begins near zero begins at zero.
pub(super) fn axis(label: &str, (lo, hi): (f64, f64)) -> Axis {
    Axis::linear(label, if lo < 0.1 * hi { 0.0 } else { lo }, hi)
}

/// (a, b) beside each thick curve, where it enters the window from the left, a little below its top.
pub(super) fn labels(mut panel: Panel, curves: &[Curve], window: &Window) -> Panel {
    let share = |(lo, hi): (f64, f64), x: f64| (x - lo) / (hi - lo);
    for curve in curves.iter().filter(|curve| stroke(curve.a) == stroke(0)) {
        // Room for the letters: the right rim and the top are not to cut them.
        let roomy =
            |h1: f64, h2: f64| (0.06..0.9).contains(&share(window.h1, h1)) && share(window.h2, h2) < 0.94;
        let mut points = curve.pieces.iter().flatten();
        if let Some(point) = points.find(|point| roomy(point.h1, point.h2)) {
            let text = format!("({}, {})", curve.a, curve.b).replace('-', "−");
            // Above the curve, for unstable pairs lie below it; from the middle on, where it falls steeply,
            // right of it.
            let side = if share(window.h1, point.h1) < 0.5 { Anchor::Middle } else { Anchor::Start };
            let shift = if side == Anchor::Middle { [0.0, 7.5] } else { [2.0, 5.0] };
            panel = panel.note(Note::new([point.h1, point.h2], &text).anchored(side, shift));
        }
    }
    panel
}

/// A count with its digits in groups of three.
pub(super) fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let groups: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().map(|group| std::str::from_utf8(group).expect("digits")).collect();
    groups.join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families_have_places() {
        assert_eq!([0, 1, -1, 2, -2].map(rank), [0.0, 1.0, 2.0, 3.0, 4.0]);
        assert!((-9..9).all(|a| of_rank(rank(a)) == a));
    }

    #[test]
    fn counts_are_grouped() {
        assert_eq!([0, 999, 1000, 2_226_000].map(grouped), ["0", "999", "1,000", "2,226,000"]);
    }
}
