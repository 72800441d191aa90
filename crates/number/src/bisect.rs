//! Bisection over doubles.

/// Two numbers from lo to hi, in this order and no more than `width` times the first apart, or neighbours, of
/// which the first has what lo has and the second lacks what hi lacks; farther apart where `holds` does not
/// know between.
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
