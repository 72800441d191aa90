//! Edges of long periods, one by one: zeros are counted, and an entry's signs taken, by return maps in the
//! logarithm of the period ([`crate::orbit::returns`]), and no string is laid out.
//!
//! The zeros of an entry lie nearly evenly in the angle of the base, so the secant through the counts at two
//! ends finds a point between two zeros in a few counts; every other cut halves, which bounds them. Then
//! signs alone shrink the interval (`precise`).

use super::enclosure::Enclosure;
use super::function::EntryFunction;
use number::rational;

/// Below the fast clock's own limit s = 4, at which its turns are no rotations, and most zeros.
const FIRST_CUT: f64 = 3.9;

/// Parts of an interval at which it is cut in turn where the point before lies too close to a zero.
const CUTS: [f64; 3] = [0.5, 0.45, 0.56];

/// Cuts at most: the secant needs some ten, halving alone 53 from the spacing of doubles, and twice that are
/// both in turn.
const MOST_CUTS: u32 = 128;

/// A point and how many of an entry's positive zeros lie below it.
#[derive(Clone, Copy)]
struct Sample {
    s: f64,
    count: u64,
}

/// An interval with the `index`-th positive zero of an entry, alone and inside; `None` where counts are not
/// known, or between neighbouring doubles leave others there.
pub fn isolate(function: &EntryFunction, index: usize) -> Option<Enclosure> {
    let index = index as u64;
    let (mut lo, mut hi) = (Sample { s: 0.0, count: 0 }, counted(function, FIRST_CUT)?);
    while hi.count < index {
        (lo, hi) = (hi, counted(function, 16.0 * hi.s)?);
    }
    for round in 0..MOST_CUTS {
        if hi.count - lo.count == 1 && lo.s > 0.0 {
            let [lo, hi] = [lo.s, hi.s].map(|s| rational::from_f64_exact(s).expect("finite"));
            return Some(Enclosure { lo, hi });
        }
        // Zeros are about evenly spaced in the root of s, of which the upper half of the range has few.
        let (from, upto) = (lo.s.sqrt(), hi.s.sqrt());
        let part = (index as f64 - 0.5 - lo.count as f64) / (hi.count - lo.count) as f64;
        let parts = if round % 2 == 0 { [part, 0.98 * part, 1.02 * part] } else { CUTS };
        let at = |part: f64| Some((from + (upto - from) * part).powi(2)).filter(|&s| lo.s < s && s < hi.s);
        let cut = parts.into_iter().filter_map(at).find_map(|s| counted(function, s))?;
        if cut.count < index { lo = cut } else { hi = cut }
    }
    None
}

fn counted(function: &EntryFunction, s: f64) -> Option<Sample> {
    Some(Sample { s, count: function.count(&rational::from_f64_exact(s)?)? })
}
