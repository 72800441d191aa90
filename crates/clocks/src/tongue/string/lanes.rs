//! Numbers side by side: one for each eigenvalue that is being looked for.

pub use number::vector::{LANES, each as lanes};

/// One number for each lane.
pub(crate) type Lanes = [f64; LANES];

/// On a cache line's boundary, which no vector then straddles.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Aligned<T>(pub T);

/// The lesser one; b if one is NaN.
#[inline(always)]
pub(crate) fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The smallest and the largest.
#[inline(always)]
pub fn range(x: &Lanes) -> (f64, f64) {
    x.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &x| {
        (if x < least { x } else { least }, if x > most { x } else { most })
    })
}

/// 2^e, clipped to the range of normal doubles.
#[inline(always)]
pub(crate) fn power_of_two(e: i64) -> f64 {
    f64::from_bits(((e.clamp(-1022, 1023) + 1023) as u64) << 52)
}

/// 2^32 log2 |x| up to a constant, to within 2^29: a double's bits are its logarithm, the mantissa's
/// straightened.
#[inline(always)]
pub fn logarithm(x: f64) -> i64 {
    (x.abs().to_bits() >> 20) as i64
}

/// Vectors are scaled down beyond this length and up below its reciprocal: 2^200. A node changes it by less
/// than 2^120.
pub const LONGEST: f64 = f64::from_bits((1023 + 200) << 52);

/// The power of two that brings a length back into range, and by how many places.
#[inline(always)]
pub(crate) fn rescaling(length: f64) -> (f64, i64) {
    match length {
        _ if length > LONGEST => (1.0 / LONGEST, 200),
        _ if length < 1.0 / LONGEST => (LONGEST, -200),
        _ => (1.0, 0),
    }
}
