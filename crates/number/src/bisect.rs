//! Bisection over doubles.

/// Bisects [lo, hi] to the relative width: `holds` is true at the first number and false at the second, given
/// that it is so at lo and hi. They are neighbouring doubles at least, and farther apart where `holds` is
/// `None` between.
pub fn bisected((mut lo, mut hi): (f64, f64), width: f64, holds: impl Fn(f64) -> Option<bool>) -> (f64, f64) {
    while hi - lo > width * lo && lo.next_up() < hi {
        let middle = lo + (hi - lo) / 2.0;
        match holds(middle) {
            Some(true) => lo = middle,
            Some(false) => hi = middle,
            None => break,
        }
    }
    (lo, hi)
}
