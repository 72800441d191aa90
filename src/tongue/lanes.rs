//! Numbers side by side: one for each eigenvalue that is being looked for.

pub(super) use crate::vector::LANES;

/// One number for each lane.
pub(super) type Lanes = [f64; LANES];

/// On a cache line's boundary, which no vector then straddles.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Aligned<T>(pub T);

/// f of each lane; a plain loop over an array is what compilers turn into vector instructions.
#[inline(always)]
pub(super) fn lanes(f: impl Fn(usize) -> f64) -> Lanes {
    let mut all = [0.0; LANES];
    for (i, lane) in all.iter_mut().enumerate() {
        *lane = f(i);
    }
    all
}

/// The rounded sum and what rounding took from it, exactly (Knuth).
#[inline(always)]
pub(super) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let t = s - a;
    (s, (a - (s - t)) + (b - t))
}

/// The lesser one; b if one is NaN.
#[inline(always)]
pub(super) fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The smallest and the largest.
#[inline(always)]
pub(super) fn range(x: &Lanes) -> (f64, f64) {
    x.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &x| {
        (if x < least { x } else { least }, if x > most { x } else { most })
    })
}

/// 2^e, clipped to the range of normal doubles.
#[inline(always)]
pub(super) fn power_of_two(e: i64) -> f64 {
    f64::from_bits(((e.clamp(-1022, 1023) + 1023) as u64) << 52)
}
