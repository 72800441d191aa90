//! Maps of a system: its verdict over two parameters.

use crate::parallel::try_map;

use super::analysis::Analysis;
use crate::error::Result;
use crate::number::Rational;
use crate::verdict::Kind;

/// One point of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The two parameters.
    pub at: (Rational, Rational),
    pub kind: Kind,
    /// Whether every part is proven.
    pub is_proof: bool,
    /// The largest growth rate, per unit time; 0 if stable.
    pub growth_rate: f64,
}

/// Points that are handed to all threads at once.
const AHEAD: usize = 512;

/// The verdicts `decide(x, y)` for all pairs of parameters, row by row of y; in parallel, in order. `see` is told how
/// many more are done, now and then.
///
/// # Errors
/// The first error of `decide`.
pub fn scan(
    xs: &[Rational],
    ys: &[Rational],
    decide: impl Fn(&Rational, &Rational) -> Result<Analysis> + Sync,
    mut see: impl FnMut(usize),
) -> Result<Vec<Point>> {
    let pairs: Vec<_> = ys.iter().flat_map(|y| xs.iter().map(move |x| (x, y))).collect();
    let point = |&(x, y): &(&Rational, &Rational)| {
        let analysis = decide(x, y)?;
        Ok(Point {
            at: (x.clone(), y.clone()),
            kind: analysis.kind,
            is_proof: analysis.is_proof(),
            growth_rate: analysis.growth_rate(),
        })
    };
    let mut points = Vec::with_capacity(pairs.len());
    for group in pairs.chunks(AHEAD) {
        points.extend(try_map(group, point)?);
        see(group.len());
    }
    Ok(points)
}
