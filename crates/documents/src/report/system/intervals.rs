//! Stretches of one number of a system: rows, and the unstable ones in words.

use plot::palette::{GREY, HYPERBOLIC, INK};
use plot::{Axis, Figure, Hatch, Layer, Panel, Place, Stroke};

use super::chart::axis;
use crate::report::decimal;
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{COUNT, ENCLOSURE, POSITIVE, ROUNDED, Schema, Shape};
use crate::report::table::Column;
use crate::report::text::counted;
use systems::Holds;
use systems::stretches::Stretch;
use systems::vary::Intervals;

/// Growth rates drawn over the whole range, and at least of a stretch.
const SAMPLES: f64 = 400.0;
const FEWEST: f64 = 24.0;
/// Of the range: a line on paper.
const THIN: f64 = 1.0 / 500.0;

/// The steps at which growth is drawn: all over the stretches that are not proven stable.
pub fn sampled(stretches: &[Stretch]) -> Vec<f64> {
    let unstable = stretches.iter().filter(|stretch| stretch.verdict != Holds::Stable);
    unstable.flat_map(|unstable| inside(unstable, stretches)).collect()
}

/// Those within one stretch, its ends left out.
fn inside(stretch: &Stretch, all: &[Stretch]) -> impl Iterator<Item = f64> {
    let range = all.last().map_or(1.0, |last| last.hi) - all.first().map_or(0.0, |first| first.lo);
    let (lo, width) = (stretch.lo, stretch.hi - stretch.lo);
    let count = (SAMPLES * width / range).max(FEWEST).ceil();
    (0..count as u32).map(move |k| lo + width * (f64::from(k) + 0.5) / count)
}

/// The number across, growth rate up, unstable stretches shaded; `rates` are those at [`sampled`].
pub fn figure(intervals: &Intervals, rates: &[Option<f64>], title: &str, number: &(String, i8)) -> Figure {
    let stretches = intervals.stretches.as_slice();
    let (lo, hi) = (
        stretches.first().map_or(0.0, |stretch| stretch.lo),
        stretches.last().map_or(1.0, |stretch| stretch.hi),
    );
    let fastest = rates.iter().flatten().fold(0.0, |a: f64, &x| a.max(x));
    let top = if fastest > 0.0 { 1.12 * fastest } else { 1.0 };
    let shade = |verdict: Holds| {
        let filter = stretches.iter().filter(|stretch| stretch.verdict == verdict);
        filter
            .map(|stretch| vec![[stretch.lo, 0.0], [stretch.hi, 0.0], [stretch.hi, top], [stretch.lo, top]])
            .collect::<Vec<_>>()
    };
    let mut line = Vec::new();
    let mut rates = rates.iter();
    for stretch in stretches {
        // 0 over what is proven stable; elsewhere what was computed.
        match stretch.verdict {
            Holds::Stable => line.extend([[stretch.lo, 0.0], [stretch.hi, 0.0]]),
            _ => line.extend(
                inside(stretch, stretches).zip(&mut rates).filter_map(|(step, rate)| Some([step, (*rate)?])),
            ),
        }
    }
    let unstable = counted(shade(Holds::Unstable).len(), "unstable interval", "unstable intervals");
    let inner =
        |steps| counted(steps as usize, "inner step in each outer one", "inner steps in each outer one");
    let mut panel = Panel::new(axis(number, lo, hi), Axis::linear("growth rate", 0.0, top).per_time())
        .titled(
            &[Some(unstable), intervals.inner_steps.map(inner)]
                .into_iter()
                .flatten()
                .collect::<Vec<_>>()
                .join(", "),
        );
    for (verdict, colour, hatch, name) in [
        (Holds::Unstable, HYPERBOLIC, None, "proven unstable"),
        (Holds::Undecided, GREY, Some(Hatch::Falling), "nothing proven"),
    ] {
        let outlines = shade(verdict);
        if !outlines.is_empty() {
            panel = panel.with(Layer::areas(outlines, colour, 0.25).hatched(hatch).labelled(name));
        }
    }
    // One that is thinner than a line would be lost.
    let thin = stretches
        .iter()
        .filter(|stretch| stretch.verdict == Holds::Unstable && stretch.hi - stretch.lo < (hi - lo) * THIN);
    let thin: Vec<_> =
        thin.map(|thin| 0.5 * (thin.lo + thin.hi)).map(|at| vec![[at, 0.0], [at, top]]).collect();
    if !thin.is_empty() {
        panel = panel.with(Layer::lines(thin, Stroke::LINE.in_colour(HYPERBOLIC).wide(0.8)));
    }
    let line = Layer::lines(vec![line], Stroke::LINE.in_colour(INK)).labelled("growth rate");
    Figure::double_column(80.0).named(title).with(panel.with(line).legend(Place::Above))
}

/// The document `kickdrift/system-intervals/1` of the number with this name; the caller adds the input.
pub fn document(intervals: &Intervals, name: &str) -> Document {
    let [unstable, undecided] = [Holds::Unstable, Holds::Undecided].map(|verdict| number(intervals, verdict));
    let is_place =
        |stretch: &&Stretch| stretch.verdict == Holds::Undecided && stretch.lo.next_up() == stretch.hi;
    let places = intervals.stretches.iter().filter(is_place).count();
    let inner = |steps| format!(", with {} in each", counted(steps as usize, "inner step", "inner steps"));
    let mut lines = vec![format!(
        "{} of the {name}{}",
        counted(unstable, "unstable interval", "unstable intervals"),
        intervals.inner_steps.map(inner).unwrap_or_default()
    )];
    let unproven = undecided - places - intervals.open.unwrap_or_default();
    if let Some(open) = intervals.open.filter(|open| *open > 0) {
        lines.push(format!(
            "  {} that the accuracy of the data leaves open (data a thousand times as accurate decide most of each)",
            counted(open, "stretch", "stretches")
        ));
    }
    if unproven > 0 || intervals.open.is_none_or(|open| open == 0) {
        let is_measured = intervals.open.is_some() && unproven > 0;
        let better = if is_measured { ", not even of data a thousand times as accurate" } else { "" };
        lines
            .push(format!("  {} where nothing is proven{better}", counted(unproven, "stretch", "stretches")));
    }
    if places > 0 {
        let all = counted(places, "isolated place", "isolated places");
        lines.push(format!(
            "  {all} between neighbouring doubles not decided, the same verdict on both sides"
        ));
    }
    if let Some((lo, hi)) = intervals.first_unstable() {
        lines.push(format!("  the first begins at {}", decimal::enclosure(lo, hi)));
    }
    let caption = format!("Verdicts on stretches of the {name}");
    head()
        .document(Document::new("system-intervals"), intervals)
        .rows(record().table("stretches", &caption, &intervals.stretches))
        .summary(&lines)
}

/// Its schema.
pub fn schema() -> Schema {
    let about = "Stretches that cover a range of the number; of a step at fixed other steps, the multiples of the inner one from lo to hi.";
    let stretches = Shape::List(&Shape::Object(|| record().keys()));
    let keys = head().keys().key("stretches", stretches, "");
    Schema::new("Stable and unstable intervals of one number of a system", keys).about(about)
}

/// All but the stretches.
fn head() -> Record<'static, Intervals> {
    Record::new()
        .json("inner_steps", |intervals: &Intervals| intervals.inner_steps.into())
        .says(Shape::OrNull(&POSITIVE), "In an outer step, where these are two measured levels and the number is the outer step.")
        .json("unstable", |intervals| number(intervals, Holds::Unstable).into())
        .says(COUNT, "")
        .json("untold", |intervals| number(intervals, Holds::Undecided).into())
        .says(COUNT, "Stretches where nothing is proven.")
        .json("first_unstable", |intervals| intervals.first_unstable().into())
        .says(Shape::OrNull(&ENCLOSURE), "What is proven stable before the first unstable stretch ends at lo, that begins at hi: doubles, taken exactly; null where there is none.")
}

/// The record of a stretch.
fn record() -> Record<'static, Stretch> {
    Record::new()
        .field(Column::new("lo"), |stretch: &Stretch| stretch.lo.into())
        .says(ROUNDED, "The stretch begins here, a double taken exactly.")
        .field(Column::new("hi"), |stretch| stretch.hi.into())
        .says(ROUNDED, "The stretch ends here, a double taken exactly.")
        .field(Column::new("verdict").left(), |stretch| stretch.verdict.name().into())
        .says(Shape::OneOf(Holds::NAMES), "Proven of every number between.")
}

/// How many stretches are so.
fn number(intervals: &Intervals, verdict: Holds) -> usize {
    intervals.stretches.iter().filter(|stretch| stretch.verdict == verdict).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::Format;

    #[test]
    fn a_place_between_neighbouring_doubles_is_no_stretch() {
        let stretch = |lo: f64, hi: f64, verdict| Stretch { lo, hi, verdict };
        let after = 1f64.next_up();
        let stretches = vec![
            stretch(0.5, 1.0, Holds::Stable),
            stretch(1.0, after, Holds::Undecided),
            stretch(after, 1.5, Holds::Stable),
            stretch(1.5, 1.75, Holds::Undecided),
        ];
        let intervals =
            Intervals { number: "x".into(), is_discrete: false, inner_steps: None, stretches, open: None };
        let text = document(&intervals, "x").render(Format::Text).unwrap();
        assert!(text.contains("  1 stretch where nothing is proven\n  1 isolated place between"), "{text}");
        let text = document(&Intervals { open: Some(1), ..intervals }, "x").render(Format::Text).unwrap();
        assert!(text.contains("  1 stretch that the accuracy of the data leaves open"), "{text}");
        assert!(!text.contains("where nothing is proven"), "{text}");
    }
}
