//! A system's verdict over one or two of its numbers, drawn.

use plot::palette::{COEXISTENCE, Colour, Gradient, HYPERBOLIC, INK, PARABOLIC};
use plot::{Axis, Cells, ColourBar, Figure, Layer, Panel, Place, Shape, Stroke, literal};

use super::SystemMap;
use clocks::verdict::Kind;
use number::{Rational, to_f64};
use systems::scan::Point;

/// The quantity shown by colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Colouring {
    /// Exponential growth, linear growth, multipliers at ±1.
    Verdict,
    /// The growth rate per unit time.
    #[default]
    Growth,
}

/// Points in points of paper.
const LEAST_SIZE: f64 = 0.35;
const EDGE_SIZE: f64 = 3.4;

impl SystemMap {
    /// The unstable points in colour, the edges marked.
    pub fn figure(&self, colouring: Colouring, title: &str) -> Figure {
        let numbers = &self.numbers;
        if numbers.len() == 1 {
            return self.profile(title, &numbers[0]);
        }
        let unstable = self.count(Kind::Hyperbolic) + self.count(Kind::Parabolic);
        let [x, y] = [(&numbers[0], &self.xs), (&numbers[1], &self.ys)].map(|(number, values)| {
            let (first, step) = pitch(values);
            axis(number, first - step / 2.0, first + step * (values.len() as f64 - 0.5))
        });
        let panel = Panel::new(x, y).titled(&format!("{unstable} of {} points unstable", self.points.len()));
        let panel = match colouring {
            Colouring::Verdict => {
                let cells = self.cells(vec![HYPERBOLIC], Kind::Hyperbolic, |_| 0);
                panel.with(Layer::cells(cells).labelled("exponential growth (hyperbolic)"))
            }
            Colouring::Growth => self.by_growth(panel),
        };
        let panel = self.edges(panel).legend(Place::Above);
        Figure::new(if colouring == Colouring::Growth { 150.0 } else { 135.0 }, 135.0)
            .named(title)
            .with(panel)
    }

    /// One number varied: growth over it, a line where it is known; an undecided point is not drawn as no
    /// growth.
    fn profile(&self, title: &str, number: &(String, i8)) -> Figure {
        let (first, step) = pitch(&self.xs);
        // Half a step beyond both ends, so that no point is cut by the frame.
        let (first, last) = (first - step / 2.0, first + step * (self.xs.len() as f64 - 0.5));
        let lines = self.runs();
        let dots = |which: &dyn Fn(&Point) -> bool| -> Vec<[f64; 2]> {
            self.points.iter().filter(|point| which(point)).map(place).collect()
        };
        let bounded_below = dots(&|point| point.kind.is_some() && !is_known(point));
        let fastest = self.points.iter().map(place).fold(0.0, |a: f64, values| a.max(values[1]));
        let top = if fastest > 0.0 { 1.12 * fastest } else { 1.0 };
        let unstable = self.count(Kind::Hyperbolic) + self.count(Kind::Parabolic);
        let mut panel =
            Panel::new(axis(number, first, last), Axis::linear("growth rate", 0.0, top).per_time())
                .titled(&format!("{unstable} of {} points unstable", self.points.len()))
                .with(Layer::lines(lines.clone(), Stroke::LINE.in_colour(INK)))
                .with(Layer::dots(lines.concat(), Shape::Disc, 2.0, HYPERBOLIC));
        // A little above the frame, which would hide them.
        let open: Vec<_> =
            dots(&|point| point.kind.is_none()).into_iter().map(|[x, y]| [x, y.max(0.03 * top)]).collect();
        for (values, shape, name) in [
            (bounded_below, Shape::Triangle, "unstable: grows as fast or faster"),
            (open, Shape::Cross, "not decided"),
        ] {
            if !values.is_empty() {
                panel = panel.with(Layer::dots(values, shape, 3.0, INK).labelled(name)).legend(Place::Above);
            }
        }
        Figure::double_column(80.0).named(title).with(panel)
    }

    /// The points next to each other whose growth is known.
    fn runs(&self) -> Vec<Vec<[f64; 2]>> {
        let runs = self.points.chunk_by(|a, b| is_known(a) == is_known(b)).filter(|run| is_known(&run[0]));
        runs.map(|run| run.iter().map(place).collect()).collect()
    }

    fn by_growth(&self, panel: Panel) -> Panel {
        let rates = self.points.iter().map(Point::rounded_rate);
        let rates = rates.filter(|&rate| rate > 0.0);
        let (low, fastest) = ColourBar::range_of(rates.clone());
        let axis = Axis::log("growth rate", low, fastest).per_time();
        let bar = ColourBar::new(axis, Gradient::on_white()).over(rates);
        let shade = |point: &Point| bar.class(point.rounded_rate().max(f64::MIN_POSITIVE), ColourBar::SHADES);
        let cells = self.cells(bar.steps(ColourBar::SHADES), Kind::Hyperbolic, shade);
        panel.with(Layer::cells(cells)).bar(bar)
    }

    fn edges(&self, mut panel: Panel) -> Panel {
        let places = |which: &dyn Fn(&Point) -> bool| -> Vec<[f64; 2]> {
            let points = self.points.iter().filter(|point| which(point));
            points.map(|point| [to_f64(&point.at.0), to_f64(&point.at.1)]).collect()
        };
        for (kind, shape, colour, name) in [
            (Kind::Parabolic, Shape::Triangle, PARABOLIC, "linear growth (parabolic)"),
            (Kind::Coexistence, Shape::Ring, COEXISTENCE, "multipliers ±1, stable (coexistence)"),
        ] {
            if self.count(kind) > 0 {
                let dots = Layer::dots(places(&|point| point.kind == Some(kind)), shape, EDGE_SIZE, colour);
                panel = panel.with(dots.labelled(name));
            }
        }
        let open = places(&|point| point.kind.is_none());
        if open.is_empty() {
            return panel;
        }
        panel.with(Layer::dots(open, Shape::Cross, 3.0, INK).labelled("not decided"))
    }

    /// The points of one kind as cells.
    fn cells(&self, colours: Vec<Colour>, kind: Kind, class: impl Fn(&Point) -> u16) -> Cells {
        let ((x, dx), (y, dy)) = (pitch(&self.xs), pitch(&self.ys));
        let mut cells = Cells::new([x, y], [dx, dy], colours).at_least(LEAST_SIZE);
        for (n, point) in self.points.iter().enumerate().filter(|(_, point)| point.kind == Some(kind)) {
            let (i, j) = (n % self.xs.len(), n / self.xs.len());
            cells.push(i as u32, j as u32, class(point));
        }
        cells
    }
}

/// Whether a point is decided and its growth bounded.
fn is_known(point: &Point) -> bool {
    point.kind.is_some() && point.growth_rate.is_some_and(|(_, hi)| hi.is_finite())
}

/// Where a point of a profile is: at its growth, or at what is known of it from below.
fn place(point: &Point) -> [f64; 2] {
    [to_f64(&point.at.0), if is_known(point) { point.rounded_rate() } else { point.at_least }]
}

/// The values of a number of the file: its name in words, and the power of time in its unit.
pub(super) fn axis((words, time): &(String, i8), lo: f64, hi: f64) -> Axis {
    let axis = Axis::linear(&literal(words), lo, hi);
    match time {
        0 => axis,
        1 => axis.of_time(),
        _ => axis.per_time(),
    }
}

/// The first of evenly spaced values, and their distance.
fn pitch(values: &[Rational]) -> (f64, f64) {
    let first = values.first().map_or(0.0, to_f64);
    let distance = values.get(1).map_or_else(|| first.abs().max(1.0) / 10.0, |second| to_f64(second) - first);
    (first, distance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::ratio;

    #[test]
    fn growth_that_is_not_known_is_not_drawn_as_none() {
        type Known = (Option<Kind>, Option<(f64, f64)>, f64);
        let map = |triples: &[Known]| {
            let xs: Vec<Rational> = (1..=triples.len() as i64).map(|k| ratio(k, 4)).collect();
            let points = triples.iter().zip(&xs).map(|(&(kind, growth_rate, at_least), x)| Point {
                at: (x.clone(), Rational::default()),
                kind,
                growth_rate,
                at_least,
            });
            let (numbers, ys) = (vec![("step".into(), 1)], vec![Rational::default()]);
            SystemMap { numbers, points: points.collect(), xs, ys, time_unit: None }
        };
        let [stable, grows] =
            [(Some(Kind::Elliptic), Some((0.0, 0.0)), 0.0), (Some(Kind::Hyperbolic), Some((2.0, 2.1)), 2.0)];
        let [open, above] = [(None, None, 0.0), (Some(Kind::Hyperbolic), Some((3.0, f64::INFINITY)), 3.0)];
        let names = ["not decided", "unstable: grows as fast or faster"];
        let said = |system_map: &SystemMap| {
            let svg = system_map.figure(Colouring::Growth, "growth").svg();
            names.map(|name| svg.contains(&format!("aria-label=\"{name}\"")))
        };
        for (points, keys, runs) in [
            (vec![stable, grows, stable], [false, false], vec![vec![[0.25, 0.0], [0.5, 2.05], [0.75, 0.0]]]),
            (vec![stable, open, grows], [true, false], vec![vec![[0.25, 0.0]], vec![[0.75, 2.05]]]),
            (vec![open, stable, above], [true, true], vec![vec![[0.5, 0.0]]]),
        ] {
            let system_map = map(&points);
            assert_eq!((said(&system_map), system_map.runs()), (keys, runs));
        }
    }
}
