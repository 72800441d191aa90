//! Stretches of outer steps: rows, and the unstable ones in words.

use crate::report::document::Document;
#[cfg(feature = "figure")]
use crate::report::figure::palette::{GREY, HYPERBOLIC, INK};
#[cfg(feature = "figure")]
use crate::report::figure::{Axis, Figure, Layer, Panel, Place, Stroke};
use crate::report::record::Record;
use crate::report::table::Column;
use crate::report::text::counted;
use crate::system::Holds;
use crate::system::levels::Stretch;

/// Growth rates drawn over the whole range, and at least of a stretch.
const SAMPLES: f64 = 400.0;
const FEWEST: f64 = 24.0;

/// The steps at which growth is drawn: all over the stretches that are not proven stable.
pub fn sampled(stretches: &[Stretch]) -> Vec<f64> {
    let unstable = stretches.iter().filter(|own| own.verdict != Holds::Stable);
    unstable.flat_map(|own| inside(own, stretches)).collect()
}

/// Those within one stretch, its ends left out.
fn inside(own: &Stretch, all: &[Stretch]) -> impl Iterator<Item = f64> {
    let range = all.last().map_or(1.0, |last| last.hi) - all.first().map_or(0.0, |first| first.lo);
    let (lo, width) = (own.lo, own.hi - own.lo);
    let count = (SAMPLES * width / range).max(FEWEST).ceil();
    (0..count as u32).map(move |k| lo + width * (f64::from(k) + 0.5) / count)
}

/// Outer step across, growth rate up, unstable stretches shaded; `rates` are those at [`sampled`].
#[cfg(feature = "figure")]
pub fn figure(
    stretches: &[Stretch],
    rates: &[Option<f64>],
    inner_steps: u64,
    (title, time): (&str, &str),
) -> Figure {
    let (lo, hi) = (stretches.first().map_or(0.0, |own| own.lo), stretches.last().map_or(1.0, |own| own.hi));
    let fastest = rates.iter().flatten().fold(0.0, |a: f64, &x| a.max(x));
    let top = if fastest > 0.0 { 1.12 * fastest } else { 1.0 };
    let shade = |verdict: Holds| {
        let own = stretches.iter().filter(|own| own.verdict == verdict);
        own.map(|own| vec![[own.lo, 0.0], [own.hi, 0.0], [own.hi, top], [own.lo, top]]).collect::<Vec<_>>()
    };
    let mut line = Vec::new();
    let mut rates = rates.iter();
    for own in stretches {
        // 0 over what is proven stable; elsewhere what was computed.
        match own.verdict {
            Holds::Stable => line.extend([[own.lo, 0.0], [own.hi, 0.0]]),
            _ => line.extend(
                inside(own, stretches).zip(&mut rates).filter_map(|(step, rate)| Some([step, (*rate)?])),
            ),
        }
    }
    let unstable = shade(Holds::Unstable).len();
    let mut panel = Panel::new(
        Axis::linear(&format!("outer step ({time})"), lo, hi),
        Axis::linear(&format!("growth rate (1/{time})"), 0.0, top),
    )
    .titled(&format!(
        "{}, {}",
        counted(unstable, "unstable interval", "unstable intervals"),
        counted(inner_steps as usize, "inner step in each outer one", "inner steps in each outer one")
    ));
    for (verdict, colour, name) in
        [(Holds::Unstable, HYPERBOLIC, "proven unstable"), (Holds::NotTold, GREY, "nothing proven")]
    {
        let outlines = shade(verdict);
        if !outlines.is_empty() {
            panel = panel.with(Layer::areas(outlines, colour, 0.25).labelled(name));
        }
    }
    let line = Layer::lines(vec![line], Stroke::LINE.in_colour(INK)).labelled("growth rate");
    Figure::double_column(80.0).named(title).with(panel.with(line).legend(Place::Above))
}

/// The document `kickdrift/system-intervals/1`; the caller adds the input.
pub fn document(stretches: &[Stretch], inner_steps: u64) -> Document {
    let record = Record::new()
        .field(Column::new("lo"), |of: &Stretch| of.lo.into())
        .field(Column::new("hi"), |of| of.hi.into())
        .field(Column::new("verdict").left(), |of| of.verdict.name().into());
    let number = |verdict: Holds| stretches.iter().filter(|own| own.verdict == verdict).count();
    let (unstable, undecided) = (number(Holds::Unstable), number(Holds::NotTold));
    let lines = [
        format!(
            "{} of the outer step, with {} in each",
            counted(unstable, "unstable interval", "unstable intervals"),
            counted(inner_steps as usize, "inner step", "inner steps")
        ),
        format!("  {} where nothing is proven", counted(undecided, "stretch", "stretches")),
    ];
    Document::new("system-intervals")
        .entry("inner_steps", inner_steps)
        .entry("unstable", unstable)
        .entry("untold", undecided)
        .rows(record.table("stretches", "Verdicts on outer steps", stretches))
        .summary(&lines)
}
