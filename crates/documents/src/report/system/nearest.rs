//! The unstable outer steps next to that of a verdict, in JSON and in words.

use serde_json::Value;

use crate::report::decimal;
use crate::report::document::enclosure;
use crate::report::record::Record;
use crate::report::shape::{ENCLOSURE, ROUNDED, ROUNDED_OR_NULL, Shape};
use systems::nearest::{Nearest, Unstable};

/// The record of the entry `nearest_unstable` of a document.
pub(super) fn record() -> Record<'static, Nearest> {
    const INTERVAL: Shape = Shape::OrNull(&Shape::Object(|| ends().keys()));
    const NONE: &str = "null: none between the step and the end of what was searched.";
    fn entries(unstable: Option<&Unstable>) -> Value {
        unstable.map(|unstable| ends().entries(unstable)).into()
    }
    Record::new()
        .json("step", |nearest: &Nearest| nearest.number.into())
        .says(ROUNDED, "A double: the outer step of the file, rounded.")
        .json("searched", |nearest| nearest.searched.into())
        .says(ENCLOSURE, "Every outer step between these doubles is covered: what is neither in an interval nor untold, edges apart, is proven stable up to the nearest ones.")
        .value("own", |nearest| entries(nearest.own.as_ref()))
        .says(INTERVAL, "The one that holds the step.")
        .value("below", |nearest| entries(nearest.below.as_ref()))
        .says(INTERVAL, NONE)
        .value("above", |nearest| entries(nearest.above.as_ref()))
        .says(INTERVAL, NONE)
        .value("untold", |nearest| nearest.untold.iter().copied().map(enclosure).collect())
        .says(Shape::List(&ENCLOSURE), "Steps no farther than these of which nothing is proven.")
}

fn ends() -> Record<'static, Unstable> {
    Record::new()
        .json("lo", |unstable: &Unstable| unstable.proven.0.into())
        .says(ROUNDED, "A double: the first outer step that is proven unstable.")
        .json("hi", |unstable| unstable.proven.1.into())
        .says(ROUNDED, "A double: the last one.")
        .json("stable_below", |unstable| unstable.within.0.into())
        .says(
            ROUNDED_OR_NULL,
            "A double: the last outer step below that is proven stable; null beyond what was searched.",
        )
        .json("stable_above", |unstable| unstable.within.1.into())
        .says(
            ROUNDED_OR_NULL,
            "A double: the first outer step above that is proven stable; null beyond what was searched.",
        )
}

/// The entry as lines of text; `unit` is that of times, after a space.
pub(super) fn lines(nearest: &Nearest, unit: &str) -> Vec<String> {
    let side = |name: &str, found: Option<Unstable>, end: f64| match found {
        Some(found) => format!("  {name}: {}", interval(found, unit)),
        None => format!("  {name}: none between {} and {}{unit}", nearest.number, decimal::few(end, 6)),
    };
    let mut lines = vec!["  unstable outer steps next to this one, all steps in their ratios; none between the two ends is proven stable:".to_string()];
    if let Some(found) = nearest.own {
        lines.push(format!("  this one lies in {}", interval(found, unit)));
    }
    lines.push(side("below", nearest.below, nearest.searched.0));
    lines.push(side("above", nearest.above, nearest.searched.1));
    for &(lo, hi) in &nearest.untold {
        let between = decimal::enclosure(lo, hi);
        lines.push(format!(
            "  not decided, by the accuracy of the data or for want of a proof: {between}{unit}"
        ));
    }
    lines
}

/// Its two ends, each between the last step proven one thing and the first proven the other.
fn interval(unstable: Unstable, unit: &str) -> String {
    let lower =
        unstable.within.0.map_or(format!("{} or below", decimal::few(unstable.proven.0, 7)), |stable| {
            decimal::enclosure(stable, unstable.proven.0).to_string()
        });
    let upper =
        unstable.within.1.map_or(format!("{} or above", decimal::few(unstable.proven.1, 7)), |stable| {
            decimal::enclosure(unstable.proven.1, stable).to_string()
        });
    format!("{lower} to {upper}{unit}")
}
