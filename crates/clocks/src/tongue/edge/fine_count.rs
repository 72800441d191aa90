//! An edge by Sturm counts in two doubles: 27 digits, however close its neighbours are.
//!
//! The theorem of `count` holds for any arithmetic whose sums and products are right to within a part ε of
//! themselves: the computed count at κ is the exact one somewhere in κ (1 ± η), η = (4n + 16) ε. Here ε =
//! 2^-99. So where the count is below the index at one point and not below it at another, the eigenvalue of
//! that index lies between the two, each moved outward by η; and halving brings them together. Nothing needs
//! to be known of the other eigenvalues. The entry's own values say where to look before a half: secants
//! prove nothing, the counts beside them do.

use super::enclosure::Enclosure;
use crate::tongue::string::lanes::{power_of_two, rescaling};
use crate::tongue::string::{Entry, HalfString, KINDS, Twofold};
use number::vector::instructions::Task;
use number::{Rational, rational};

/// Significant digits of an edge that counts in two doubles enclose, at least.
pub(crate) const TWO_DOUBLES: u32 = 25;

/// The relative width at which halving ends: 10^-27.
const NARROW: f64 = 1e-27;

/// ε: the mass is right to 2^-104, its product with κ and that with x to 2^-101, a sum to 2^-104.
const EPSILON: f64 = f64::from_bits((1023 - 99) << 52);

/// The eigenvalue of an index as an interval of s. `around` is where it is believed to be, in s.
pub fn enclose(string: &HalfString, entry: Entry, index: usize, around: Option<(f64, f64)>) -> Enclosure {
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
        // Their values are known once they have been looked at.
        let [mut lo, mut hi] =
            [0.0, 2.0 * string.upper_bound].map(|x| Place { kappa: point(x), entry: None });
        if let Some((from, upto)) = around {
            // Beyond the ends' own rounding.
            let ends = [from / string.ticks * (1.0 - 1e-15), upto / string.ticks * (1.0 + 1e-15)].map(point);
            for end in ends {
                if 0.0 < end.hi && end.hi < 2.0 * string.upper_bound {
                    look(string, entry, index, end, [&mut lo, &mut hi]);
                }
            }
        }
        loop {
            let width = hi.kappa.minus(lo.kappa).hi;
            if width <= NARROW * lo.kappa.hi {
                return [lo.kappa, hi.kappa];
            }
            if let Some(share) = lo.share(&hi) {
                let zero = lo.kappa.and(share * width);
                for beside in [-CLOSE * width, CLOSE * width] {
                    let kappa = zero.and(beside);
                    if kappa.minus(lo.kappa).hi > 0.0 && hi.kappa.minus(kappa).hi > 0.0 {
                        look(string, entry, index, kappa, [&mut lo, &mut hi]);
                    }
                }
                if hi.kappa.minus(lo.kappa).hi < 0.5 * width {
                    continue;
                }
            }
            look(string, entry, index, lo.kappa.plus(hi.kappa).half(), [&mut lo, &mut hi]);
        }
    }
}

/// How far beside a secant's zero the counts are asked, relative to the interval: its curvature moves it by
/// less, but where a neighbour is as close as that.
const CLOSE: f64 = f64::from_bits((1023 - 20) << 52);

/// A κ below or above the eigenvalue, and the value there of the entry whose zero that is, times 2^-exponent.
struct Place {
    kappa: Twofold,
    entry: Option<(f64, i64)>,
}

impl Place {
    /// Where between the two the straight line through both values is zero, as a share of their distance.
    #[inline(always)]
    fn share(&self, other: &Place) -> Option<f64> {
        let ((a, i), (b, j)) = self.entry.zip(other.entry)?;
        let b = b * power_of_two(j - i);
        (a * b < 0.0).then(|| a / (a - b))
    }
}

/// Moves one of the two ends to κ, as the count there says.
#[inline(always)]
fn look(string: &HalfString, entry: Entry, index: usize, kappa: Twofold, [lo, hi]: [&mut Place; 2]) {
    let (count, value) = count(string, entry, kappa);
    *(if count < index { lo } else { hi }) = Place { kappa, entry: Some(value) };
}

/// The computed count of a problem's positive eigenvalues below κ, and the entry's value there as a [`Place`]
/// has it.
#[inline(always)]
fn count(string: &HalfString, entry: Entry, kappa: Twofold) -> (usize, (f64, i64)) {
    let mut kicks = [kappa; KINDS];
    for (kick, (&hi, &lo)) in kicks.iter_mut().zip(string.masses.iter().zip(&string.rests)) {
        *kick = kappa.times(Twofold { hi, lo });
    }
    let unit = |on: bool| Twofold { hi: f64::from(u8::from(on)), lo: 0.0 };
    let (mut x, mut v) = (unit(entry.starts_free()), unit(!entry.starts_free()));
    v = v.accurate_difference(kicks[string.nodes[0].kind].times(x));
    let (mut changes, mut exponent) = (0, 0);
    for node in &string.nodes[1..] {
        let next = x.accurate_sum(v.scaled(node.length));
        changes += usize::from(next.hi.is_sign_negative() != x.hi.is_sign_negative());
        v = v.accurate_difference(kicks[node.kind].times(next));
        let (factor, places) = rescaling(next.hi.abs() + v.hi.abs());
        exponent += places;
        (x, v) = (next.scaled(factor), v.scaled(factor));
    }
    if !entry.ends_free() {
        return (changes, (x.hi, exponent));
    }
    // One more past the last node; the zero eigenvalue of C is below every κ and not counted.
    let past = changes + usize::from(x.hi * v.hi < 0.0) - usize::from(entry == Entry::C);
    (past, (v.hi, exponent))
}
