//! Doubles side by side in the processor's registers.
//!
//! A compiler makes vector instructions of most plain loops over lanes, but not of every one where it must
//! not fail: the few kernels that everything waits for are written for a [`Vector`] instead, and compiled for
//! each kind of registers.

pub mod instructions;
mod portable;

/// How many numbers a vector has as a rule; [`Vector::WIDTH`] is the exact number.
pub const LANES: usize = 16;

/// f of each lane; a plain loop over an array is what compilers turn into vector instructions.
#[inline(always)]
pub fn each<const N: usize>(f: impl Fn(usize) -> f64) -> [f64; N] {
    let mut all = [0.0; N];
    for (i, lane) in all.iter_mut().enumerate() {
        *lane = f(i);
    }
    all
}

/// All lanes in one number, from 0 on: in eight chains at a time, for compilers make vector instructions of
/// them, and no lane waits for all before it.
#[inline(always)]
fn gathered<const N: usize>(lanes: &[f64; N], join: impl Fn(f64, f64) -> f64) -> f64 {
    let (eights, rest) = lanes.as_chunks::<8>();
    let mut all = [0.0; 8];
    for eight in eights {
        all = each(|i| join(all[i], eight[i]));
    }
    all.iter().chain(rest).fold(0.0, |all, &x| join(all, x))
}

/// The largest of the lanes, or 0 where none is above it; NaN is passed over.
#[inline(always)]
pub fn largest<const N: usize>(lanes: &[f64; N]) -> f64 {
    gathered(lanes, |most, x| if x > most { x } else { most })
}

/// The sum of the lanes.
#[inline(always)]
pub fn sum<const N: usize>(lanes: &[f64; N]) -> f64 {
    gathered(lanes, |sum, x| sum + x)
}

/// 2^52: the doubles from here to 2^53 are the whole numbers.
const WHOLE: f64 = (1u64 << 52) as f64;

/// A whole number below 2^52 as a double. (Vectors have no instruction for it before AVX-512's extensions.)
#[inline(always)]
pub fn double_of(n: u64) -> f64 {
    f64::from_bits(n | WHOLE.to_bits()) - WHOLE
}

/// A double that is a whole number from 0 on, below 2^52, as an integer.
#[inline(always)]
pub fn integer_of(x: f64) -> u64 {
    (x + WHOLE).to_bits() ^ WHOLE.to_bits()
}

/// Sums and products, and what rounding takes from them: of doubles, alone or side by side.
pub trait FloatRing: Copy {
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    /// self · b + c, rounded once.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// self · b − c, rounded once.
    fn mul_sub(self, b: Self, c: Self) -> Self;

    /// The rounded sum and what rounding took from it, exactly (Knuth).
    #[inline(always)]
    fn two_sum(self, other: Self) -> (Self, Self) {
        let sum = self.add(other);
        let part = sum.sub(self);
        (sum, self.sub(sum.sub(part)).add(other.sub(part)))
    }

    /// The rounded difference, and what rounding took from it, exactly.
    #[inline(always)]
    fn two_sub(self, other: Self) -> (Self, Self) {
        let difference = self.sub(other);
        let part = difference.sub(self);
        (difference, self.sub(difference.sub(part)).sub(other.add(part)))
    }

    /// The rounded product and what rounding took from it, exactly (barring underflow).
    #[inline(always)]
    fn two_product(self, other: Self) -> (Self, Self) {
        let product = self.mul(other);
        (product, self.mul_sub(other, product))
    }
}

impl FloatRing for f64 {
    #[inline(always)]
    fn add(self, other: f64) -> f64 {
        self + other
    }

    #[inline(always)]
    fn sub(self, other: f64) -> f64 {
        self - other
    }

    #[inline(always)]
    fn mul(self, other: f64) -> f64 {
        self * other
    }

    #[inline(always)]
    fn mul_add(self, b: f64, c: f64) -> f64 {
        f64::mul_add(self, b, c)
    }

    #[inline(always)]
    fn mul_sub(self, b: f64, c: f64) -> f64 {
        f64::mul_add(self, b, -c)
    }
}

/// One number for each lane. All instruction sets give the same bits.
pub trait Vector: FloatRing {
    /// How many numbers it has.
    const WIDTH: usize;
    /// A yes or no for each lane.
    type Mask: Copy;
    fn splat(x: f64) -> Self;
    /// The first [`WIDTH`](Vector::WIDTH) numbers, which must be there.
    fn load(from: &[f64]) -> Self;
    fn store(self, to: &mut [f64]);
    /// Whether self > limit.
    fn exceeds(self, limit: Self) -> Self::Mask;
    /// Two alternatives in the form in which [`Vector::choose`] is fastest.
    fn alternatives(this: Self, that: Self) -> [Self; 2];
    /// `this` of the [alternatives](Vector::alternatives) where the mask says yes, else `that`.
    fn choose(mask: Self::Mask, alternatives: [Self; 2]) -> Self;
    /// c − self · b, rounded once.
    fn neg_mul_add(self, b: Self, c: Self) -> Self;
    fn div(self, other: Self) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    /// Whether self > limit in any lane.
    fn any_above(self, limit: Self) -> bool;
    /// `this` where self > limit, else `that`.
    fn if_above(self, limit: Self, this: Self, that: Self) -> Self;
    /// The next double below, of a positive number.
    fn below(self) -> Self;
    /// self, in which whole numbers are held as integers, one more where the signs of a and b differ.
    fn count_change(self, a: Self, b: Self) -> Self;
    /// Adds 1 in each lane where the signs of a and b differ and c is negative.
    fn count_change_below(self, a: Self, b: Self, c: Self) -> Self;
    /// The power of two that brings |self|, not below 2^-1022, to [1, 2).
    fn normalizing(self) -> Self;
    /// 2^32 log2 |x| up to a constant, to within 2^29, as a whole number: a double's bits are its logarithm,
    /// the mantissa's straightened.
    fn logarithm(self) -> Self;

    /// The next double above, of a positive number.
    #[inline(always)]
    fn above(self) -> Self {
        self.count_change(Self::splat(1.0), Self::splat(-1.0))
    }

    /// The larger one; the other one if this is NaN.
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        self.if_above(other, self, other)
    }

    /// The lesser one; the other one if this is NaN.
    #[inline(always)]
    fn lesser(self, other: Self) -> Self {
        other.if_above(self, self, other)
    }
}

/// The bit of a double's sign.
const SIGN: u64 = 1 << 63;
/// The exponents of x and 1/x add up to this.
const EXPONENTS: u64 = 2046;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::instructions::{Instructions, Kernel};

    /// Three numbers for each of sixteen lanes, and what all operations make of them.
    struct EveryOperation([[f64; LANES]; 3]);

    impl Kernel for EveryOperation {
        type Output = Vec<[u64; LANES]>;

        fn run<V: Vector>(self) -> Self::Output {
            let mut all = Vec::new();
            for at in (0..LANES).step_by(V::WIDTH) {
                let [a, b, c] = self.0.each_ref().map(|x| V::load(&x[at..]));
                let above = |i: usize| self.0[0][i] > self.0[1][i];
                assert_eq!(a.any_above(b), (at..at + V::WIDTH).any(above));
                let results = results(a, b, c);
                all.resize(results.len(), [0; LANES]);
                for (to, result) in all.iter_mut().zip(results) {
                    let mut lanes = [0.0; LANES];
                    result.store(&mut lanes);
                    // NaN has many forms.
                    let bits = |x: f64| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() };
                    to[at..at + V::WIDTH].copy_from_slice(&lanes.map(bits)[..V::WIDTH]);
                }
            }
            all
        }
    }

    fn results<V: Vector>(a: V, b: V, c: V) -> Vec<V> {
        let (sum, rest) = a.two_sum(b);
        let (difference, left) = a.two_sub(b);
        let (product, lost) = a.two_product(b);
        // These operations on bits are right for whole numbers and for positive ones.
        let unit = V::splat((1u64 << 52) as f64);
        vec![
            a,
            sum,
            rest,
            difference,
            left,
            product,
            lost,
            a.mul_add(b, c),
            a.neg_mul_add(b, c),
            a.div(b),
            a.abs().sqrt(),
            a.if_above(b, c, a),
            V::choose(a.exceeds(b), V::alternatives(c, a)),
            a.larger(b),
            a.lesser(b),
            c.abs().normalizing(),
            a.logarithm(),
            unit.count_change(a, b),
            unit.count_change_below(a, b, c),
            c.abs().above(),
            c.abs().below(),
        ]
    }

    #[test]
    fn every_instruction_set_computes_the_same() {
        let special = [0.0, -0.0, 1.0, -1.5, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, f64::MIN_POSITIVE];
        let mut state = 20_261_121u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let x = f64::from_bits((state >> 12) | 0x3ff0_0000_0000_0000) - 1.5;
            x * 2f64.powi((state % 40) as i32 - 20)
        };
        for round in 0..1000 {
            let mut numbers = [(); 3].map(|()| [(); LANES].map(|()| random()));
            if round % 2 == 1 {
                numbers[round % 3][round % LANES] = special[round % special.len()];
                numbers[(round + 1) % 3][round % LANES] = special[round / 7 % special.len()];
            }
            // A normal number that is not near an end of the range.
            numbers[2] = numbers[2].map(|x| if x.is_normal() { x } else { 1.0 });
            let portable = Instructions::PORTABLE.compute(EveryOperation(numbers));
            for set in Instructions::available() {
                assert_eq!(set.compute(EveryOperation(numbers)), portable);
                assert_eq!(set.compute_by_register(EveryOperation(numbers)), portable);
                assert_eq!(set.compute_alone(EveryOperation(numbers)), portable);
            }
        }
    }

    #[test]
    fn whole_numbers_are_the_same_in_either_form() {
        for n in [0, 1, 2, 12_345, (1 << 51) - 1, (1 << 52) - 1] {
            assert_eq!((double_of(n), integer_of(double_of(n))), (n as f64, n));
        }
        assert_eq!(largest(&[1.0, f64::NAN, 7.0, -8.0, 3.0]), 7.0);
        assert_eq!((largest(&[-1.0; 16]), largest(&[f64::NAN]), largest(&[2.0])), (0.0, 0.0, 2.0));
    }

    #[test]
    fn operations_are_what_they_say() {
        let x = [3.0; LANES];
        assert_eq!(x.neg_mul_add([2.0; LANES], [10.0; LANES]), [4.0; LANES]);
        assert_eq!(x.mul_sub([2.0; LANES], [10.0; LANES]), [-4.0; LANES]);
        assert_eq!(x.mul([f64::EPSILON; LANES]).normalizing(), [2f64.powi(51); LANES]);
        assert_eq!([2.0; LANES].logarithm().sub([1.0; LANES].logarithm()), [(1u64 << 32) as f64; LANES]);
        assert_eq!((x.above(), x.below()), ([3f64.next_up(); LANES], [3f64.next_down(); LANES]));
        assert_eq!(x.two_sum([f64::EPSILON; LANES]), ([3.0; LANES], [f64::EPSILON; LANES]));
        assert_eq!(x.two_sub([f64::EPSILON; LANES]), ([3.0; LANES], [-f64::EPSILON; LANES]));
    }
}
