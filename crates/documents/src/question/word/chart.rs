//! A word drawn over its step: trace, error of the frequency and bias in aligned panels, unstable steps
//! shaded; of two forces also the plane of the step and the ratio of frequencies.

use std::f64::consts::{PI, TAU};

use plot::palette::{GREY, HYPERBOLIC, INK, PARABOLIC, family};
use plot::{Axis, Dash, Figure, Foot, Layer, Panel, Place, Stroke, typeset};

use super::asked::Word;
use super::linted::{Linted, Pieces, omega_h};
use num_traits::Zero;
use number::parallel::try_map;
use number::{Laurent, Rational, Result, Ring, from_f64_exact, to_f64};
use words::{At, Enclosed, Forces, Shape, Stability, at};

/// Steps at which curves are drawn.
const SAMPLES: i64 = 600;

/// Beyond this the trace is cut.
const TRACE: f64 = 3.2;

/// Beyond this the bias is cut.
const BIAS: f64 = 4.0;

/// Rows of a plane of words of so many powers of the force; with more of these, and in balls, each takes
/// longer.
const ROWS: u64 = 96;
const POWERS: u64 = 12;
const LEAST_ROWS: u64 = 24;

/// Without a range steps are drawn beyond the edge by this factor.
const BEYOND: f64 = 1.2;

/// Unstable intervals narrower than this part of the axis are seen by their edges alone.
const NARROW: f64 = 1.0 / 400.0;

/// Beyond every axis.
const HIGH: f64 = 1e3;

/// Intervals of √Λ1 h.
type Spans = Vec<[f64; 2]>;

/// A step that is drawn.
struct Sample {
    /// √Λ1 h.
    x: f64,
    at: At,
}

/// The figure of a word.
pub(super) fn figure(question: &Word, linted: &Linted) -> Result<Figure> {
    let range = range(question, linted);
    let mut panels = Vec::new();
    if linted.word.names_forces() {
        panels.push(plane(question, linted, range)?);
    }
    if let Some(rho) = &linted.rho {
        let samples = samples(question, linted, rho, range);
        let bars = unstable(linted, range);
        let is_first = panels.is_empty();
        panels.push(trace(&samples, &bars, range, is_first));
        panels.extend(frequency(&samples, &bars, rho, range));
        panels.extend(biased(&samples, &bars, rho, range));
    }
    if let (Some(h), Some(x)) = (&question.h, asked(question)) {
        panels = marked(panels, x, &format!("*h* = {}", typeset(h)));
    }
    let x = Axis::linear(if linted.word.names_forces() { "√*Λ*_1 *h*" } else { "*ωh*" }, range[0], range[1]);
    let room = if linted.word.names_forces() { 26.0 } else { 12.0 };
    let mut foot = Foot::default().words(&linted.word.to_string());
    for (name, value) in
        [("*Λ*_1", &question.lambda1), ("*Λ*_2", &question.lambda2), ("*γ*", &question.friction)]
    {
        foot = value.iter().fold(foot, |foot, value| foot.value(name, value));
    }
    Ok(stacked(panels, &x, room, "An integrator over its step").footed(&foot))
}

/// A line at x in every panel, named in the first one.
pub(super) fn marked(panels: Vec<Panel>, x: f64, name: &str) -> Vec<Panel> {
    let line =
        || Layer::lines(vec![vec![[x, -HIGH], [x, HIGH]]], Stroke::DOTTED.in_colour(PARABOLIC).wide(1.2));
    let with_line = |(n, panel): (usize, Panel)| match n {
        0 => panel.with(line().labelled(name)).legend(Place::Above),
        _ => panel.with(line()),
    };
    panels.into_iter().enumerate().map(with_line).collect()
}

/// Panels one below the other over one axis, with `room` mm for what stands around them.
pub(super) fn stacked(panels: Vec<Panel>, x: &Axis, room: f64, name: &str) -> Figure {
    let count = panels.len();
    let sheet = Figure::new(130.0, room + 42.0 * count as f64).columns(1).named(name);
    let over = |(n, panel): (usize, Panel)| if n + 1 == count { panel.over(x.clone()) } else { panel };
    panels.into_iter().enumerate().map(over).fold(sheet, Figure::with)
}

/// The steps that are drawn, in √Λ1 h.
fn range(question: &Word, linted: &Linted) -> [f64; 2] {
    let root = |x: &Rational| to_f64(x).max(0.0).sqrt();
    if let Some((lo, hi)) = &linted.range {
        return [root(lo), root(hi)];
    }
    if let Some(pieces) = &linted.pieces {
        return [pieces.range.0, pieces.range.1].map(|h| h * pieces.root.mid_f64());
    }
    let edge = linted.nominal_edge().map(|edge| edge.mid_f64());
    let mut last =
        linted.stability.iter().flat_map(|all| &all.intervals).filter_map(|interval| interval.upper.as_ref());
    let edge = edge.or_else(|| last.next_back().map(|edge| omega_h(edge).mid_f64()));
    [0.0, BEYOND * edge.unwrap_or(PI).max(asked(question).unwrap_or(0.0))]
}

/// The verdicts at steps of a range.
fn samples(question: &Word, linted: &Linted, rho: &Rational, [lo, hi]: [f64; 2]) -> Vec<Sample> {
    let one = Laurent::from_integer(1);
    let lambda1 = question.lambda1.as_ref().unwrap_or(&one);
    let [first, last] = [lo, hi].map(|x| from_f64_exact(x).unwrap_or_default());
    let part = (last - &first) / Rational::from_integer(SAMPLES.into());
    let places = (0..=SAMPLES).map(|n| &first + &part * Rational::from_integer(n.into()));
    let places = places.filter(|x| !x.is_zero());
    if let Some(pieces) = &linted.pieces {
        let lambda2 = question.lambda2.clone().unwrap_or_else(Laurent::zero);
        let friction = question.friction.clone().unwrap_or_else(Laurent::zero);
        let word = Enclosed::new(&linted.word, lambda1, &lambda2, &friction);
        let root = pieces.root.mid_f64();
        let near = |x: Rational| from_f64_exact(to_f64(&x) / root).unwrap_or(x);
        let sample = |h: Rational| {
            let at = word.at(&Laurent::from_rational(h.clone()))?;
            Some(Sample { x: to_f64(&h) * root, at })
        };
        return places.map(near).filter_map(sample).collect();
    }
    let product = linted.word.polynomials(&Forces::ratio(rho));
    let sample = |x: Rational| {
        let at = at(&product, &Laurent::from_rational(&x * &x))?;
        Some(Sample { x: to_f64(&x), at })
    };
    places.filter_map(sample).collect()
}

/// √Λ1 h of the step that was asked about.
fn asked(question: &Word) -> Option<f64> {
    question.s(question.h.as_ref()?, "h").ok().map(|s| s.to_f64().max(0.0).sqrt())
}

/// The unstable intervals, cut to a range.
pub(super) fn unstable(linted: &Linted, [lo, hi]: [f64; 2]) -> Spans {
    let spans = linted.spans(None).into_iter().filter(|span| !span.stable).map(|span| {
        let [lower, upper] = span.enclosed();
        [lower.map_or(0.0, |ends| ends.0).max(lo), upper.map_or(hi, |ends| ends.1).min(hi)]
    });
    spans.filter(|[lower, upper]| lower <= upper).collect()
}

/// Shades the unstable steps, and names them where this is the first panel.
fn shaded(panel: Panel, bars: &Spans, [low, high]: [f64; 2], [lo, hi]: [f64; 2], is_named: bool) -> Panel {
    let outline = |&[a, b]: &[f64; 2]| vec![[a, low], [b, low], [b, high], [a, high]];
    let areas = Layer::areas(bars.iter().map(outline).collect(), HYPERBOLIC, 0.22);
    let narrow = bars.iter().filter(|[a, b]| b - a < NARROW * (hi - lo));
    let lines = narrow.map(|&[a, b]| vec![[(a + b) / 2.0, low], [(a + b) / 2.0, high]]).collect();
    let areas = if is_named && !bars.is_empty() { areas.labelled("unstable") } else { areas };
    panel.with(areas).with(Layer::lines(lines, Stroke::LINE.in_colour(HYPERBOLIC)))
}

/// Horizontal lines over a range.
fn levels(values: &[f64], [lo, hi]: [f64; 2]) -> Layer {
    let lines = values.iter().map(|&y| vec![[lo, y], [hi, y]]).collect();
    Layer::lines(lines, Stroke { dash: Dash::Dashed, ..Stroke::THIN }.in_colour(GREY))
}

/// The values at samples, broken where there is none.
fn line(samples: &[Sample], value: impl Fn(&Sample) -> Option<f64>) -> Vec<[f64; 2]> {
    samples.iter().map(|sample| [sample.x, value(sample).unwrap_or(f64::NAN)]).collect()
}

fn trace(samples: &[Sample], bars: &Spans, range: [f64; 2], is_first: bool) -> Panel {
    let [lo, hi] = range;
    let panel = Panel::new(Axis::linear("", lo, hi), Axis::linear("trace", -TRACE, TRACE));
    let panel = shaded(panel, bars, [-TRACE, TRACE], range, is_first).with(levels(&[-2.0, 2.0], range));
    let curve = line(samples, |sample| Some(sample.at.trace.mid_f64()));
    let panel = panel.with(Layer::lines(vec![curve], Stroke::LINE.in_colour(INK)));
    if is_first { panel.legend(Place::Above) } else { panel }
}

/// The error of the frequency in per cent, beside that of the exact motion in units of √Λ1. A step turns by ±
/// the angle and whole turns: by that which continues the frequency before.
fn errors(samples: &[Sample], exact: f64) -> Vec<[f64; 2]> {
    let mut before = exact;
    let mut error = |Sample { x, at, .. }: &Sample| {
        let angle = at.angle.as_ref()?.mid_f64();
        let turns = (before * x / TAU).round();
        let candidates = [turns - 1.0, turns, turns + 1.0].into_iter();
        let candidates = candidates.flat_map(|k| [TAU * k + angle, TAU * k - angle]);
        let off = |turned: &f64| (turned - before * x).abs();
        before = candidates.min_by(|a, b| off(a).total_cmp(&off(b)))? / x;
        Some(100.0 * (before / exact - 1.0))
    };
    samples.iter().map(|sample| [sample.x, error(sample).unwrap_or(f64::NAN)]).collect()
}

fn frequency(samples: &[Sample], bars: &Spans, rho: &Rational, range: [f64; 2]) -> Option<Panel> {
    let curve = errors(samples, (1.0 + to_f64(rho)).sqrt());
    let [low, high] = ends(&curve)?;
    let axis = Axis::linear("frequency error (%)", low, high);
    let panel =
        shaded(Panel::new(Axis::linear("", range[0], range[1]), axis), bars, [low, high], range, false);
    Some(panel.with(levels(&[0.0], range)).with(Layer::lines(vec![curve], Stroke::LINE.in_colour(INK))))
}

/// Potential over kinetic energy at the ends of the word.
fn biased(samples: &[Sample], bars: &Spans, rho: &Rational, range: [f64; 2]) -> Option<Panel> {
    let square = 1.0 + to_f64(rho);
    let of = |Sample { x, at, .. }: &Sample| {
        let impedance = at.impedance.as_ref()?.mid_f64();
        Some(square * x * x / (impedance * impedance))
    };
    let curve = line(samples, of);
    let [low, high] = ends(&curve)?;
    let [low, high] = [low.max(0.0), high.min(BIAS)];
    let axis = Axis::linear("bias *R*", low, high);
    let panel =
        shaded(Panel::new(Axis::linear("", range[0], range[1]), axis), bars, [low, high], range, false);
    Some(panel.with(levels(&[1.0], range)).with(Layer::lines(vec![curve], Stroke::LINE.in_colour(INK))))
}

/// The range of a curve's values and a margin; `None` where it has none.
pub(super) fn ends(curve: &[[f64; 2]]) -> Option<[f64; 2]> {
    let values = || curve.iter().map(|point| point[1]).filter(|y| y.is_finite());
    let (low, high) = (values().reduce(f64::min)?, values().reduce(f64::max)?);
    let margin = 0.06 * (high - low).max(0.01);
    Some([low - margin, high + margin])
}

/// The unstable steps over the ratio of frequencies ω2/ω1 and √Λ1 h.
fn plane(question: &Word, linted: &Linted, range: [f64; 2]) -> Result<Panel> {
    let given = linted.rho.as_ref().map(|rho| to_f64(rho).max(0.0).sqrt());
    let top = given.map_or(1.0, |ratio| (BEYOND * ratio).max(1.0));
    let is_quick =
        linted.pieces.is_none() || Shape::of(&linted.word).is_some() && question.friction.is_none();
    let powers = if is_quick { linted.word.degree().max(POWERS) } else { u64::MAX };
    let count = (ROWS * POWERS / powers).max(LEAST_ROWS);
    let up = top / count as f64;
    let rows: Vec<f64> = (0..count).map(|n| (n as f64 + 0.5) * up).collect();
    let spans = try_map(&rows, |ratio| row(question, linted, *ratio, range))?;
    let outline = |y: f64, [a, b]: [f64; 2]| {
        vec![[a, y - up / 2.0], [b, y - up / 2.0], [b, y + up / 2.0], [a, y + up / 2.0]]
    };
    let all = rows.iter().zip(spans).flat_map(|(y, spans)| spans.into_iter().map(|span| outline(*y, span)));
    let panel = Panel::new(Axis::linear("", range[0], range[1]), Axis::linear("*ω*_2/*ω*_1", 0.0, top));
    let panel = panel.with(Layer::areas(all.collect(), HYPERBOLIC, 1.0).labelled("unstable"));
    let panel = match given {
        Some(ratio) => {
            let line = vec![[range[0], ratio], [range[1], ratio]];
            panel.with(
                Layer::lines(vec![line], Stroke::LINE.in_colour(family(1)))
                    .labelled("ratio of the panels below"),
            )
        }
        None => panel,
    };
    Ok(panel.legend(Place::Above))
}

/// The unstable steps at one ratio of frequencies.
fn row(question: &Word, linted: &Linted, ratio: f64, range: [f64; 2]) -> Result<Spans> {
    let root = from_f64_exact(ratio).unwrap_or_default();
    let rho = &root * &root;
    let lambda1 = question.lambda1.clone().unwrap_or_else(|| Laurent::from_integer(1));
    let lambda2 = Laurent::product(&lambda1, &Laurent::from_rational(rho.clone()));
    let (mut stability, mut pieces) = (None, None);
    if question.is_enclosed(&linted.word) {
        pieces = Some(Pieces::of(question, &linted.word, &lambda2)?);
    } else {
        stability = Some(Stability::of(&linted.word.polynomials(&Forces::ratio(&rho))));
    }
    Ok(unstable(&Linted { rho: Some(rho), stability, pieces, ..linted.clone() }, range))
}

#[cfg(test)]
mod tests {
    use super::super::super::asking::{Question, Work};
    use super::*;

    fn asked(word: &str) -> (Word, Linted) {
        let question = Word { word: Some(word.parse().unwrap()), ..Word::default() };
        let linted = question.answer(&Work::default()).unwrap();
        (question, linted)
    }

    #[test]
    fn the_frequency_goes_on_where_the_trace_touches_two() {
        let (question, linted) = asked("4*(K(1/8) D(1/4) K(1/8))");
        let samples = samples(&question, &linted, &Rational::zero(), [0.0, 7.9]);
        for [x, percent] in errors(&samples, 1.0).into_iter().filter(|point| point[1].is_finite()) {
            let verlet = 100.0 * (8.0 * (x / 8.0).asin() / x - 1.0);
            // The angle is known to 96 bits, and its sine within a few roundings of doubles.
            assert!((percent - verlet).abs() < 1e-9, "{x}: {percent} and not {verlet}");
        }
    }

    #[test]
    fn a_plane_of_two_forces_needs_no_stiffness() {
        let (question, linted) = asked("K2(1/2) 2*(K1(1/4) D(1/2) K1(1/4)) K2(1/2)");
        assert_eq!(figure(&question, &linted).unwrap().frames().len(), 1);
        // Λ2 = Λ1/4: the first tongue ends where both halves of the step turn by a quarter, s = 8.
        let spans = row(&question, &linted, 0.5, [0.0, 4.0]).unwrap();
        assert!((spans[0][1] - 8f64.sqrt()).abs() < 1e-12, "{spans:?}");
    }
}
