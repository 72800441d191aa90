//! Numbers side by side: one for each eigenvalue that is being looked for.

/// So many at a time.
pub(super) const LANES: usize = 16;

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

/// The rounded product and what rounding took from it, exactly (barring underflow).
#[inline(always)]
pub(super) fn two_product(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    (p, a.mul_add(b, -p))
}

/// The same in each lane.
#[inline(always)]
pub(super) fn two_sums(a: &Lanes, b: &Lanes) -> (Lanes, Lanes) {
    let s = lanes(|i| a[i] + b[i]);
    let t = lanes(|i| s[i] - a[i]);
    (s, lanes(|i| (a[i] - (s[i] - t[i])) + (b[i] - t[i])))
}

/// The same in each lane.
#[inline(always)]
pub(super) fn two_products(a: &Lanes, b: &Lanes) -> (Lanes, Lanes) {
    let p = lanes(|i| a[i] * b[i]);
    (p, lanes(|i| a[i].mul_add(b[i], -p[i])))
}

/// The lesser one; b if one is NaN.
#[inline(always)]
pub(super) fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The largest of numbers that are not negative.
#[inline(always)]
pub(super) fn largest(x: &Lanes) -> f64 {
    x.iter().fold(0.0, |most, &x| if x > most { x } else { most })
}

/// The smallest.
#[inline(always)]
pub(super) fn smallest(x: &Lanes) -> f64 {
    x.iter().fold(f64::INFINITY, |least, &x| if x < least { x } else { least })
}

/// 2^e, clipped to the range of normal doubles.
#[inline(always)]
pub(super) fn power_of_two(e: i64) -> f64 {
    f64::from_bits(((e.clamp(-1022, 1023) + 1023) as u64) << 52)
}

/// The powers of two that bring the larger one of |x| and |v| to [1, 2).
#[inline(always)]
pub(super) fn normalizing(x: &Lanes, v: &Lanes) -> Lanes {
    lanes(|i| {
        let (x, v) = (x[i].abs(), v[i].abs());
        let exponent = (if x > v { x } else { v }).to_bits() >> 52;
        f64::from_bits((2046 - exponent) << 52)
    })
}
