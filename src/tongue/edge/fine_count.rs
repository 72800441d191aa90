//! An edge by Sturm counts in two doubles: 27 digits, however close its neighbours are.
//!
//! The theorem of `count` holds for any arithmetic whose sums and products are right to within a part ε of themselves:
//! the computed count at κ is the exact one somewhere in κ (1 ± η), η = (4n + 16) ε. Here ε = 2^-99. So where the
//! count is below the index at one point and not below it at another, the eigenvalue of that index lies between the two,
//! each moved outward by η; and halving brings them together. Nothing needs to be known of the other eigenvalues.

use super::enclosure::Enclosure;
use crate::number::{Rational, rational};
use crate::tongue::string::lanes::rescaling;
use crate::tongue::string::{Entry, HalfString, KINDS, Twofold};
use crate::vector::instructions::Task;

/// Significant digits of an edge that counts in two doubles enclose, at least.
pub(crate) const TWO_DOUBLES: u32 = 25;

/// The relative width at which halving ends: 10^-27.
const NARROW: f64 = 1e-27;

/// ε: the mass is right to 2^-104, its product with κ and that with x to 2^-101, a sum to 2^-104.
const EPSILON: f64 = f64::from_bits((1023 - 99) << 52);

/// The eigenvalue of an index as an interval of s. `around` is where it is believed to be, in s.
pub(crate) fn enclose(
    string: &HalfString,
    entry: Entry,
    index: usize,
    around: Option<(f64, f64)>,
) -> Enclosure {
    let [lo, hi] = string.instructions.perform_alone(Halving { string, entry, index, around });
    let eta = rational::from_f64_exact((4.0 * string.nodes.len() as f64 + 16.0) * EPSILON).expect("finite");
    let exact = |x: f64| rational::from_f64_exact(x).expect("finite");
    let s = |kappa: Twofold| (exact(kappa.hi) + exact(kappa.lo)) * exact(string.ticks);
    let one = Rational::from_integer(1.into());
    Enclosure { lo: s(lo) * (&one - &eta), hi: s(hi) * (one + eta) }
}

struct Halving<'a> {
    string: &'a HalfString,
    entry: Entry,
    index: usize,
    around: Option<(f64, f64)>,
}

impl Task for Halving<'_> {
    type Output = [Twofold; 2];

    #[inline(always)]
    fn run(self) -> [Twofold; 2] {
        let Halving { string, entry, index, around } = self;
        let point = |x: f64| Twofold { hi: x, lo: 0.0 };
        let [mut lo, mut hi] = [point(0.0), point(2.0 * string.upper_bound)];
        if let Some((from, upto)) = around {
            // Beyond the ends' own rounding.
            let ends = [from / string.ticks * (1.0 - 1e-15), upto / string.ticks * (1.0 + 1e-15)].map(point);
            for end in ends {
                if 0.0 < end.hi && end.hi < 2.0 * string.upper_bound {
                    if count(string, entry, end) < index { lo = end } else { hi = end }
                }
            }
        }
        loop {
            let width = hi.minus(lo).hi;
            if width <= NARROW * lo.hi {
                return [lo, hi];
            }
            let middle = lo.plus(hi).half();
            if count(string, entry, middle) < index { lo = middle } else { hi = middle }
        }
    }
}

/// The computed count of a problem's positive eigenvalues below κ.
#[inline(always)]
fn count(string: &HalfString, entry: Entry, kappa: Twofold) -> usize {
    let mut kicks = [kappa; KINDS];
    for (kick, (&hi, &lo)) in kicks.iter_mut().zip(string.masses.iter().zip(&string.rests)) {
        *kick = kappa.times(Twofold { hi, lo });
    }
    let unit = |on: bool| Twofold { hi: f64::from(u8::from(on)), lo: 0.0 };
    let (mut x, mut v) = (unit(entry.starts_free()), unit(!entry.starts_free()));
    v = v.accurate_difference(kicks[string.nodes[0].kind].times(x));
    let mut changes = 0;
    for node in &string.nodes[1..] {
        let next = x.accurate_sum(v.scaled(node.length));
        changes += usize::from(next.hi.is_sign_negative() != x.hi.is_sign_negative());
        v = v.accurate_difference(kicks[node.kind].times(next));
        let (factor, _) = rescaling(next.hi.abs() + v.hi.abs());
        (x, v) = (next.scaled(factor), v.scaled(factor));
    }
    if !entry.ends_free() {
        return changes;
    }
    // One more past the last node; the zero eigenvalue of C is below every κ and not counted.
    changes + usize::from(x.hi * v.hi < 0.0) - usize::from(entry == Entry::C)
}
