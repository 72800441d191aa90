//! Numbers and names for people.

use crate::advise::{Mode, Origin};
use crate::report::decimal::few;

/// A number known to an enclosure, rounded to at most so many significant digits, fewer where the enclosure is wider: every digit is that of
/// both ends' rounding.
///
/// ```
/// use kickdrift::report::advise::nearest;
/// assert_eq!(nearest((4.67679999, 4.67680001), 4), "4.677");
/// assert_eq!(nearest((4.6, 4.7), 4), "5");
/// assert_eq!([nearest((23.9, 23.9), 5), nearest((0.0, 0.0), 3), nearest((-1.72237, -1.72237), 4)], ["23.9", "0", "-1.722"]);
/// ```
pub fn nearest((lo, hi): (f64, f64), digits: usize) -> String {
    let shown = |x: f64, digits: usize| few(x, digits);
    let same = (1..=digits).rev().find(|&n| shown(lo, n) == shown(hi, n));
    same.map_or_else(|| format!("{} to {}", shown(lo, 2), shown(hi, 2)), |n| shown(lo, n))
}

/// The name of a mode and where it comes from, for people.
pub(super) fn told(mode: &Mode) -> String {
    let period = nearest(mode.period(), 4);
    match mode.origin {
        Origin::Period => format!("{} (T = {period} fs)", mode.name),
        origin => format!("{} (T = {period} fs from the {})", mode.name, origin.name()),
    }
}
