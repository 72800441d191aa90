//! Zeros isolated by proven counts: for those so close that counts in doubles cannot separate them.

use num_traits::Zero;

use super::enclosure::Enclosure;
use super::function::EntryFunction;
use crate::tongue::string::HalfString;
use number::{Rational, rational};

/// Bits to begin with, and those after which another point is looked at.
const BITS: u32 = 128;
const MOST_BITS: u32 = 1 << 13;

/// A point, and how many of an entry's positive zeros lie below it.
struct Sample {
    s: Rational,
    count: u64,
}

/// Isolates a zero by halving with proven counts. `around`, if given, is where doubles saw it.
pub fn isolate(
    function: &EntryFunction,
    string: &HalfString,
    index: usize,
    around: Option<(f64, f64)>,
) -> Enclosure {
    let (index, exact) = (index as u64, |x: f64| rational::from_f64_exact(x).expect("finite"));
    let all = string.dimensions[function.entry as usize] as u64;
    let mut lo = Sample { s: Rational::zero(), count: 0 };
    let mut hi = Sample { s: exact(2.0 * string.upper_bound * string.ticks), count: all };
    // Beside the ends, which may be zeros themselves.
    let mut hints = around.map_or(Vec::new(), |(lo, hi)| vec![exact(hi.next_up()), exact(lo.next_down())]);
    while hi.count - lo.count > 1 || lo.s.is_zero() {
        let hint = hints.pop().filter(|s| lo.s < *s && *s < hi.s);
        let cut = between(function, [&lo.s, &hi.s], hint);
        if cut.count < index { lo = cut } else { hi = cut }
    }
    Enclosure { lo: lo.s, hi: hi.s }
}

/// A point inside an interval that is no zero: the hint or the middle, if bits decide the count there. No
/// number of bits does where x or v vanishes at T/2, but that is so at finitely many points; so other points
/// follow, each with twice the bits.
fn between(function: &EntryFunction, [lo, hi]: [&Rational; 2], hint: Option<Rational>) -> Sample {
    let middle = (lo + hi) / Rational::from_integer(2.into());
    let part = |n: u32| &middle + (hi - lo) * rational::scale2(&1.into(), -i64::from(n) - 1);
    let points = std::iter::once(hint.unwrap_or_else(|| middle.clone())).chain((1..).map(part));
    let count = |(s, most): (Rational, u32)| {
        let mut bits =
            std::iter::successors(Some(BITS), |bits| Some(2 * bits)).take_while(|&bits| bits <= most);
        let count = bits.find_map(|bits| function.counted(&function.orbit(&s, bits)?))?;
        Some(Sample { s, count })
    };
    points.zip((0..).map(|n| MOST_BITS << n)).find_map(count).expect("points without end")
}
