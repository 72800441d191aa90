//! The ratios about one of them that are unstable, at a step of the first clock: the cone of one step and a
//! range of ratios.

use num_traits::ToPrimitive;

use super::frame::Frame;
use super::search::{BITS, base, enclosed};
use super::taylor::Taylor;
use number::{Laurent, Rational, Real, U};

/// Ends of ranges are multiples of 1/UNIT.
const UNIT: i64 = 1_000_000;

/// Ranges of ratios that are tried on either side.
const TRIES: usize = 100;

/// Families |a| ≤ this have a frame.
const FAMILIES: i64 = 8;

/// Forks of Euclid's algorithm: simple ratios within the range.
const FORKS: usize = 4;

/// The base, and the family in whose frame it is followed, if it turns.
type Way = (usize, Option<i64>);

/// Ratios from this one on are not looked at: in doubles they would not be exact multiples of 1/[`UNIT`].
const LARGEST: i64 = 1 << 30;

/// A range of ratios h2/h1 about `ratio` in which **every** one is unstable, rational or not, at the step h1
/// and with the stiffnesses Λ1 and Λ2 (proofs/BANDS.md).
///
/// Its ends lo < hi are multiples of 10⁻⁶ with lo ≤ `ratio` ≤ hi. Ratios beyond them may be unstable, too.
/// `None` where nothing is proven beside the ratio.
///
/// ```
/// use kickdrift_clocks::band::unstable_ratios;
/// use kickdrift_clocks::number::{parse::parse, rational::ratio};
/// let x = |text| parse("quantity", text).unwrap();
/// let all = |times| unstable_ratios([&x("pi^2"), &x("pi^2/25")], &x("1/8"), &times);
/// // The fast force turns by almost π while the slow one waits.
/// let (lo, hi) = all(ratio(31, 4)).unwrap();
/// assert!(hi - lo > ratio(1, 4));
/// assert_eq!(all(ratio(5, 1)), None);
/// ```
pub fn unstable_ratios(
    lambdas: [&Laurent; 2],
    h1: &Laurent,
    ratio: &Rational,
) -> Option<(Rational, Rational)> {
    let scaled = ratio * Rational::from_integer(UNIT.into());
    let [from, to] = [scaled.floor(), scaled.ceil()].map(|x| x.to_integer().to_i64());
    let (from, to) = from.zip(to).filter(|(from, to)| *from > 0 && *to < LARGEST * UNIT)?;
    let [first, second] = lambdas;
    let (bases, h1) = ([base(first, second), base(second, first)], enclosed(&h1.enclosure(BITS)));
    let is_unstable = |from: i64, to: i64, (index, family): Way| {
        let [middle, half] = [from + to, to - from].map(|x| x as f64 / (2 * UNIT) as f64);
        let ratio = Taylor::constant(middle, 2.0 * U * (middle + half)).with_slope(half);
        let steps = [h1, h1.times(&ratio)];
        let range = [[(from, UNIT), (to, UNIT)], [(UNIT, to), (UNIT, from)]][index];
        let frame = || {
            let tau = if index == 0 { ratio } else { ratio.reciprocal()? };
            Frame::new(&steps[index], &steps[1 - index], &tau, bases[index].as_ref()?)
        };
        from > 0 && frame().is_some_and(|frame| frame.proves(family, range, FORKS))
    };
    // The way that proves the narrowest range proves the others.
    let narrow = ((from - 1).max(1), to + 1);
    let families = || (0..=FAMILIES).flat_map(|a| [a, -a]).map(Some).chain([None]);
    let ways = families().flat_map(|family| [(0, family), (1, family)]);
    let way = ways.into_iter().find(|way| is_unstable(narrow.0, narrow.1, *way))?;
    let is_unstable = |from: i64, to: i64| is_unstable(from, to, way);
    // Ranges are doubled where they are proven, and halved where not.
    let reached = |from: i64, side: i64| {
        let (mut end, mut length) = (from, 1024);
        for _ in 0..TRIES {
            let next = end + side * length;
            if is_unstable(end.min(next), end.max(next)) {
                (end, length) = (next, 2 * length);
            } else if length > 1 {
                length /= 2;
            } else {
                break;
            }
        }
        end
    };
    let (lo, hi) = (reached(from, -1), reached(to, 1));
    let over = |n: i64| Rational::new(n.into(), UNIT.into());
    (lo < hi).then(|| (over(lo), over(hi)))
}
