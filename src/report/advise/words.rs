//! Numbers and names for people.

use crate::advise::unit::decimal;
use crate::advise::{Mode, Origin, Scheme};
use crate::number::Rational;
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
pub(super) fn named(mode: &Mode) -> String {
    let period = nearest(mode.period(), 4);
    match mode.origin {
        Origin::Period => format!("{} (T = {period} fs)", mode.name),
        origin => format!("{} (T = {period} fs from the {})", mode.name, origin.name()),
    }
}

/// A length of time in the unit that suits it.
fn time(x: &Rational) -> String {
    let over = |n: u64| x / Rational::from_integer(n.into());
    let one = Rational::from_integer(1.into());
    let units = [(1_000_000_000_000_000, "s"), (1_000_000, "ns"), (1000, "ps")];
    let found = units.into_iter().find(|(n, _)| over(*n) >= one);
    found.map_or_else(|| fs(x), |(n, unit)| format!("{} {unit}", decimal(&over(n))))
}

/// "; within the run of 10 ns", where a run was given and something grows.
pub(super) fn within(run: Option<bool>, length: &Option<Rational>) -> String {
    let Some((within, length)) = run.zip(length.as_ref()) else { return String::new() };
    format!("; {}within the run of {}", if within { "" } else { "not " }, time(length))
}

pub(super) fn percent(x: &Rational) -> String {
    format!("{} %", decimal(&(x * Rational::from_integer(100.into()))))
}

pub(super) fn fs(x: &Rational) -> String {
    format!("{} fs", decimal(x))
}

/// Three digits, rounded down.
pub(super) fn down(x: f64) -> String {
    let size = 10f64.powi(2 - x.abs().log10().floor() as i32);
    few((x * size).floor() / size, 3)
}

/// Which outer step to take: `safe` is below T/3 too, `largest` is proven for the whole band; of the fastest mode its words and its period.
pub(super) fn choice(
    scheme: &Scheme,
    [safe, largest]: [&Option<Rational>; 2],
    band: &str,
    (fastest, (lo, hi)): (&str, (f64, f64)),
) -> String {
    let step = scheme.last_but_one();
    let times = |outer: &Rational| match scheme.steps() {
        [_] => fs(outer),
        _ => format!("{} ({} of {})", fs(outer), decimal(&(outer / step)), fs(step)),
    };
    let part = |n: f64| nearest((lo / n, hi / n), 3);
    let third = part(3.0);
    match (safe, largest) {
        (Some(safe), Some(largest)) if safe == largest => {
            format!(
                "advice: outer step {}, the longest that is proven stable for all periods within {band}",
                times(safe)
            )
        }
        (Some(safe), Some(largest)) => format!(
            "advice: outer step {}: below T/3 = {third} fs and proven stable for all periods within {band}; {} is proven too, but drift is \
             published beyond T/3",
            times(safe),
            times(largest)
        ),
        (None, Some(largest)) => format!(
            "advice: up to {} is proven stable for all periods within {band}; T/3 = {third} fs is below the step of {}: shorten that one first",
            times(largest),
            fs(step)
        ),
        _ => format!(
            "advice: no outer step is proven stable with {} inside: {fastest} needs inner steps below T/pi = {} fs, better T/10 = {} fs",
            fs(step),
            part(std::f64::consts::PI),
            part(10.0)
        ),
    }
}
