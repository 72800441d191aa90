//! The two edges of a tongue: which is the lower one and how far they are apart, or the proof that they are
//! one point.
//!
//! As a rule the enclosures of the edges say it. Where they overlap, or nearly so, the width is found without
//! more digits of the edges (by tunnelling); where it is a difference of nearly equal terms, as close to a
//! closing, by more and more digits, and where no number of digits would end that, by algebra.

use num_traits::Zero;

use super::elimination::common_factor;
use super::tunnel::{self, Apart};
use crate::tongue::edge::{Edge, Enclosure, TWO_DOUBLES, Tongues, negative_log2, simplest};
use crate::tongue::string::{Digits, Twofold};
use number::{Rational, Result, Sign};

/// A tongue of p/q: the pairs with s between the edges are unstable.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    pub m: u64,
    /// The edges, `lower` ≤ `upper`, in the right order by proof; `None` above the last tongue.
    pub lower: Edge,
    pub upper: Option<Edge>,
    /// Whether the edges are one point: no instability, Q = ±I there.
    pub closed: bool,
    /// hi − lo, enclosed: proven to about three digits, or to be smaller than all normal doubles; infinite
    /// for the last tongue.
    pub width: (f64, f64),
}

/// Digits asked of return maps, one after the other, each of which leaves a width its last four; two doubles
/// give some 24 of them.
const DIGITS_OF_RETURNS: [u32; 5] = [19, 22, 24, 26, 50];

/// Relative accuracy of a width: a few digits are what it is worth.
const WIDTH_ACCURACY: f64 = 1e-3;

/// Whether an enclosure of a width proves the tongue open, and is narrow enough.
fn is_accurate(width: (f64, f64)) -> bool {
    width.0 > 0.0 && width.1 <= width.0 * (1.0 + WIDTH_ACCURACY)
}

impl Gap {
    /// The middles of both edges, rounded; infinite where there is no upper one.
    pub fn middles(&self) -> [f64; 2] {
        [self.lower.middle(), self.upper.as_ref().map_or(f64::INFINITY, Edge::middle)]
    }

    /// Tongue m between its two edges, ordered or proven equal.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub(crate) fn new(tongues: &Tongues, m: u64, pair: [Option<Edge>; 2]) -> Result<Gap> {
        let (a, b) = match pair {
            [Some(a), Some(b)] => (a, b),
            [Some(lower), None] | [None, Some(lower)] => {
                let width = (f64::INFINITY, f64::INFINITY);
                return Ok(Gap { m, lower, upper: None, closed: false, width });
            }
            [None, None] => unreachable!("tongue {m} has an edge"),
        };
        let (lower, upper) = if a.lo <= b.lo { (a, b) } else { (b, a) };
        let width = ((upper.lo - lower.hi).next_down(), (upper.hi - lower.lo).next_up());
        if is_accurate(width) {
            return Ok(Gap { m, lower, upper: Some(upper), closed: false, width });
        }
        Gap::thin(tongues, m, lower, upper)
    }

    /// The tongue between two edges whose enclosures overlap or nearly do.
    fn thin(tongues: &Tongues, m: u64, a: Edge, b: Edge) -> Result<Gap> {
        if tongues.rho().is_zero() {
            return Ok(Gap { m, lower: a, upper: Some(b), closed: true, width: (0.0, 0.0) });
        }
        let (free, pinned) = if a.entry.starts_free() { (a, b) } else { (b, a) };
        let between = [free.lo.min(pinned.lo), free.hi.max(pinned.hi)];
        if tongues.is_long()
            && let Some(gap) = Gap::by_returns(tongues, m, free, pinned)?
        {
            return Ok(gap);
        }
        let tunnelled = by_tunnelling(tongues, m, &free, &pinned, between)?;
        tunnelled.map_or_else(|| Gap::by_digits(tongues, m, free, pinned), Ok)
    }

    /// By digits of both edges that return maps give, where these part them.
    fn by_returns(tongues: &Tongues, m: u64, a: Edge, b: Edge) -> Result<Option<Gap>> {
        let (mut x, mut y) = (Enclosure::from(&a), Enclosure::from(&b));
        for digits in DIGITS_OF_RETURNS {
            let found = (tongues.by_returns(&a, &x, digits)?, tongues.by_returns(&b, &y, digits)?);
            let (Some(first), Some(second)) = found else { return Ok(None) };
            (x, y) = (first, second);
            if let Some((gap, _)) = parted(m, [(a, &x), (b, &y)]).filter(|(gap, _)| is_accurate(gap.width)) {
                return Ok(Some(gap));
            }
        }
        Ok(None)
    }

    /// By more and more digits of both edges, until they part or are proven one.
    fn by_digits(tongues: &Tongues, m: u64, free: Edge, pinned: Edge) -> Result<Gap> {
        let (a, b) = (free, pinned);
        let (mut x, mut y) = (Enclosure::from(&a), Enclosure::from(&b));
        let mut digits = TWO_DOUBLES;
        loop {
            (x, y) = (tongues.sharpened(&a, &x, digits)?, tongues.sharpened(&b, &y, digits)?);
            if let Some((gap, width)) = parted(m, [(a, &x), (b, &y)]) {
                if is_accurate(gap.width) {
                    return Ok(gap);
                }
                // A bit is 0.30 decimal digits: so many that the width has five, more than there are.
                let places = 3 * negative_log2(&(width / &x.hi)) / 10 + 6;
                digits = places.max(digits + 1);
            } else if digits == TWO_DOUBLES
                && let between = [(&x.lo).min(&y.lo), (&x.hi).max(&y.hi)].map(Twofold::from_rational)
                && let Some(gap) = by_tunnelling(tongues, m, &a, &b, between)?
            {
                return Ok(gap);
            } else if !tongues.are_open(m % 2 == 1)? && coincide(tongues, &[(a, &x), (b, &y)])? {
                return Ok(Gap { m, lower: a, upper: Some(b), closed: true, width: (0.0, 0.0) });
            } else {
                digits *= 2;
            }
        }
    }
}

/// The tongue between two edges whose enclosures are apart, and the least that its width can be.
fn parted(m: u64, [(a, x), (b, y)]: [(Edge, &Enclosure); 2]) -> Option<(Gap, Rational)> {
    let ordered = [(x, y, a, b), (y, x, b, a)].into_iter().find(|(below, above, ..)| below.hi < above.lo);
    let (below, above, lower, upper) = ordered?;
    let width = Enclosure { lo: &above.lo - &below.hi, hi: &above.hi - &below.lo };
    Some((Gap { m, lower, upper: Some(upper), closed: false, width: width.to_f64() }, width.lo))
}

/// The tongue, if orbits over an interval that holds both edges give its width.
fn by_tunnelling<D: Digits>(
    tongues: &Tongues,
    m: u64,
    free: &Edge,
    pinned: &Edge,
    between: [D; 2],
) -> Result<Option<Gap>> {
    let splitting = tunnel::splitting(tongues.string()?, free.entry, between);
    let Some(Apart { in_order, width }) = splitting else { return Ok(None) };
    let (lower, upper) = if in_order { (*free, *pinned) } else { (*pinned, *free) };
    let is_enough = is_accurate(width) || width.1 < f64::MIN_POSITIVE;
    Ok(is_enough.then_some(Gap { m, lower, upper: Some(upper), closed: false, width }))
}

/// Whether both entries vanish at the simplest rational in both enclosures, or at a common algebraic zero
/// there.
fn coincide(tongues: &Tongues, pair: &[(Edge, &Enclosure); 2]) -> Result<bool> {
    let [(a, x), (b, y)] = pair;
    let (lo, hi) = ((&x.lo).max(&y.lo), (&x.hi).min(&y.hi));
    if lo > hi {
        return Ok(false);
    }
    let candidate = simplest(lo, hi);
    let (f, g) = (tongues.function(a.entry)?, tongues.function(b.entry)?);
    if f.exact_sign(&candidate) == Sign::Zero && g.exact_sign(&candidate) == Sign::Zero {
        return Ok(true);
    }
    let common = common_factor(tongues.ratio(), tongues.rho(), [a.entry, b.entry]);
    Ok(common.degree() > Some(0) && common.count_roots(lo, hi) > 0)
}
