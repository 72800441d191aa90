//! Maps of a system: its verdict over two parameters.

use number::parallel::try_map;

use crate::spectrum::rate::middle;
use crate::verdict::analysis::{Analysis, name};
use clocks::verdict::Kind;
use number::{Rational, Result};

/// One point of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The two parameters.
    pub at: (Rational, Rational),
    /// `None`: not decided.
    pub kind: Option<Kind>,
    /// An enclosure of the largest growth rate, per unit time, infinite above where the least alone is
    /// proven; (0, 0) if nothing grows exponentially; `None`: not bounded.
    pub growth_rate: Option<(f64, f64)>,
    /// No more than it: what the fastest mode that is proven to grow has at least, 0 where none is.
    pub at_least: f64,
}

impl Point {
    /// The name of the kind in documents.
    pub fn kind_name(&self) -> &'static str {
        name(self.kind)
    }

    /// The middle of that enclosure, what is proven at least where it is infinite, 0 where there is none.
    pub fn rounded_rate(&self) -> f64 {
        self.growth_rate.map_or(0.0, |pair| if pair.1.is_finite() { middle(pair) } else { pair.0 })
    }
}

/// The verdicts `decide(x, y)` for all pairs of parameters, row by row of y; in parallel, in order. `see` is
/// called after each.
///
/// # Errors
/// The first error of `decide`.
pub fn scan(
    xs: &[Rational],
    ys: &[Rational],
    decide: impl Fn(&Rational, &Rational) -> Result<Analysis> + Sync,
    see: impl Fn() + Sync,
) -> Result<Vec<Point>> {
    let pairs: Vec<_> = ys.iter().flat_map(|y| xs.iter().map(move |x| (x, y))).collect();
    let point = |&(x, y): &(&Rational, &Rational)| {
        let analysis = decide(x, y)?;
        let modes = analysis.parts.iter().flat_map(|part| &part.instabilities);
        let at_least = modes.filter_map(|mode| mode.growth_rate).fold(0.0, |most: f64, (lo, _)| most.max(lo));
        let (kind, growth_rate) = (analysis.kind, analysis.growth_rate());
        let at_least = growth_rate.map_or(at_least, |(lo, _)| at_least.max(lo));
        Ok(Point { at: (x.clone(), y.clone()), kind, growth_rate, at_least })
    };
    try_map(&pairs, |pair| point(pair).inspect(|_| see()))
}
