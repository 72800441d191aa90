//! The half period in the logarithm of the period: a matrix product over a rotation of the circle,
//! renormalized by Euclid's algorithm (proofs/RETURNS.md).
//!
//! The base's step is the unit of time, s its strength, σ = sin θ = √(s − s²/4), k that of the other clock.
//! Right in the middle of a base's kick, in the coordinates (x, v/σ), the base turns clockwise by θ a step. A
//! kick of the other clock at the offset x behind it, pulled back to it, is with u = 1 − s x/2
//!
//! ```text
//!     K(x) = 1 + k [[u x, σ x²], [−u²/σ, −u x]],
//! ```
//!
//! a polynomial in x. (Beyond the base's own limit, s ≤ 0 and s ≥ 4, the velocity has another unit κ in place
//! of σ, and the base's step is [[c, κ], [−σ²/κ, c]], c = 1 − s/2.) From kick to kick the offset moves by p/q
//! mod 1, and the state by K(x') R(nθ), n = ⌊x + p/q⌋. So the half period is a product of such maps along the
//! orbit of x, half a kick before it, and what is left up to T/2 after it. Winding comes out of the same run:
//! each product has its [`Turn`], so the sign changes of x are known without following them.

mod branch;
mod coefficient;
mod cone;
mod enclosure;
mod euclid;
mod fit;
mod frame;
mod lanes;
mod long;
mod map;
mod product;
mod row;
mod run;
mod series;
mod slow;
mod turn;
mod wanted;

pub use frame::Found;
pub use map::{FLOOR, UP, norm};
pub use wanted::Wanted;

use super::ends::Ends;
use crate::propagator::LongClocks;
use coefficient::{Coefficient, Long};
use enclosure::{Close, Enclosure, Wide};
use frame::Frame;
use number::{Ball, Ratio, Rational, Real, Twofold, to_f64};

/// The precisions, in bits.
pub const PRECISIONS: [u32; 3] = [53, 106, 256];

/// From so many kicks of each clock on, return maps in doubles are cheaper than the filter's kicks
/// (tests/bench/README.md).
const LONG: u64 = 1 << 14;

/// From so many on, return maps in two doubles are cheaper than kicks in 128 bits.
const LONG_FOR_BITS: u64 = 1 << 9;

/// Whether the period is so long that its return maps are to be tried before its kicks, in doubles or in more
/// bits.
pub fn is_worth(ratio: Ratio, bits: u32) -> bool {
    ratio.p().min(ratio.q()) >= if bits > 53 { LONG_FOR_BITS } else { LONG }
}

/// log₂ of the ratio of the steps, at most, where two doubles know the constants: a step of the base to the
/// power 2^8 costs them 12 bits, and a period of 2^70 kicks is known well enough with the others.
const MOST_LOG2_RATIO: u64 = 8;

/// The half period to the digits of numbers of so many bits; `None` where the bound loses all digits, where a
/// partial quotient asks for too many products, and where the work was stopped.
///
/// The base is the clock by which the other one's kicks distort less, or the other where that fails.
pub fn run<S: Real>(clocks: &LongClocks<S>, bits: u32, wanted: Wanted) -> Option<Ends> {
    better(clocks, bits, wanted)?.ends
}

/// What a verdict needs: the signs of entries, too, whose logarithms no exponent of a ball holds, or growth
/// that shows before the ends.
pub fn decisive<S: Real>(clocks: &LongClocks<S>, bits: u32, wanted: Wanted) -> Option<Found> {
    better(clocks, bits, wanted).filter(Found::decides)
}

/// As [`run`], over the clock that distorts more alone: another route to the same numbers.
pub fn run_over_other<S: Real>(clocks: &LongClocks<S>, bits: u32, wanted: Wanted) -> Option<Ends> {
    over(clocks, !prefers_fast(clocks), bits, wanted)?.ends
}

/// Over the one base, and where that does not decide the verdict, over the other.
fn better<S: Real>(clocks: &LongClocks<S>, bits: u32, wanted: Wanted) -> Option<Found> {
    let fast = prefers_fast(clocks);
    let first = over(clocks, fast, bits, wanted);
    if first.as_ref().is_some_and(Found::decides) {
        return first;
    }
    let second = over(clocks, !fast, bits, wanted);
    if second.as_ref().is_some_and(Found::decides) { second } else { first.or(second) }
}

/// A run with the fast or the slow clock as the base. The number of kicks of the rarer clock decides which
/// numbers know its first levels well enough (`euclid::suffices`).
fn over<S: Real>(clocks: &LongClocks<S>, fast: bool, bits: u32, wanted: Wanted) -> Option<Found> {
    let over = match (bits, clocks.shorter_bits()) {
        (0..=53, 0..=38) => over_in::<S, f64, Close>,
        (0..=53, 39..=70) if clocks.log2_ratio() <= MOST_LOG2_RATIO => over_in::<S, Twofold, Close>,
        (0..=53, 39..=86) | (54..=106, 0..=62) => over_in::<S, Twofold, Wide>,
        (0..=256, _) => over_in::<S, Long, Wide>,
        _ => return None,
    };
    over(clocks, fast, bits, wanted)
}

fn over_in<S: Real, T: Walk, E: Enclosure>(
    clocks: &LongClocks<S>,
    fast: bool,
    bits: u32,
    wanted: Wanted,
) -> Option<Found> {
    let found = |clocks: &LongClocks<S>| T::walked(&Frame::<T, E>::new(clocks, wanted)?, bits);
    if fast {
        return found(clocks);
    }
    let found = found(&clocks.swapped())?;
    Some(Found { ends: found.ends.map(|ends| in_first_unit(ends, clocks.ratio(), T::BITS)), ..found })
}

/// The numbers of a first level, and in them the walk with products of so many bits.
///
/// No type of strengths enters: the walk, most of this room's code, is compiled here and not once more by
/// every crate that asks.
trait Walk: Coefficient {
    fn walked<E: Enclosure>(frame: &Frame<Self, E>, bits: u32) -> Option<Found>;
}

impl Walk for f64 {
    fn walked<E: Enclosure>(frame: &Frame<Self, E>, _: u32) -> Option<Found> {
        frame.found::<f64>()
    }
}

impl Walk for Twofold {
    fn walked<E: Enclosure>(frame: &Frame<Self, E>, bits: u32) -> Option<Found> {
        if bits <= 53 { frame.found::<f64>() } else { frame.found::<Twofold>() }
    }
}

impl Walk for Long {
    fn walked<E: Enclosure>(frame: &Frame<Self, E>, bits: u32) -> Option<Found> {
        match bits {
            0..=53 => frame.found::<f64>(),
            54..=106 => frame.found::<Twofold>(),
            _ => frame.found::<Long>(),
        }
    }
}

/// Whether the slow clock's kicks distort the fast one's turn no more than the other way round, about.
fn prefers_fast<S: Real>(clocks: &LongClocks<S>) -> bool {
    let [s, k] = [clocks.fast(), clocks.slow()].map(|x| x.enclosure(53).mid_f64());
    let ratio = to_f64(clocks.ratio());
    distortion(s, k) <= distortion(k * ratio, s * ratio)
}

/// The norm of a kick k in the coordinates of a base s, about; far more where the base is beyond its own
/// limit.
fn distortion(s: f64, k: f64) -> f64 {
    let square = s * (1.0 - 0.25 * s);
    if square > 0.0 { k.abs() / square.sqrt() } else { 1e6 + k.abs() }
}

/// From the unit of time h2 to h1.
fn in_first_unit(mut ends: Ends, ratio: &Rational, bits: u32) -> Ends {
    ends.even.v = ends.even.v.mul(&Ball::from_rational(&ratio.recip(), bits), bits);
    ends.odd.x = ends.odd.x.mul(&Ball::from_rational(ratio, bits), bits);
    ends
}

#[cfg(test)]
mod tests;
