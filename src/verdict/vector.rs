//! Sixteen doubles in the processor's registers.
//!
//! A compiler makes vector instructions of most plain loops over lanes, but not of every one where it must not fail: the
//! few kernels that everything waits for are written for a [`Vector`] instead, and compiled for each kind of registers.

/// How many numbers a vector has.
pub(crate) const LANES: usize = 16;

/// One number for each lane. All instruction sets give the same bits.
pub(crate) trait Vector: Copy {
    fn splat(x: f64) -> Self;
    fn load(from: &[f64; LANES]) -> Self;
    fn store(self, to: &mut [f64; LANES]);
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    /// self · b + c, rounded once.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// c − self · b, rounded once.
    fn neg_mul_add(self, b: Self, c: Self) -> Self;
    /// self · b − c, rounded once.
    fn mul_sub(self, b: Self, c: Self) -> Self;
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
    /// The power of two that brings |self|, not below 2^-1022, to [1, 2).
    fn normalizing(self) -> Self;

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

    /// The rounded sum and what rounding took from it, exactly (Knuth).
    #[inline(always)]
    fn two_sum(self, other: Self) -> (Self, Self) {
        let sum = self.add(other);
        let part = sum.sub(self);
        (sum, self.sub(sum.sub(part)).add(other.sub(part)))
    }

    /// The same of a difference.
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

const SIGN: u64 = 1 << 63;
/// The exponents of x and 1/x add up to this.
const EXPONENTS: u64 = 2046;

impl Vector for [f64; LANES] {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        [x; LANES]
    }

    #[inline(always)]
    fn load(from: &[f64; LANES]) -> Self {
        *from
    }

    #[inline(always)]
    fn store(self, to: &mut [f64; LANES]) {
        *to = self;
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        each(|i| self[i] + other[i])
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        each(|i| self[i] - other[i])
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        each(|i| self[i] * other[i])
    }

    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        each(|i| self[i].mul_add(b[i], c[i]))
    }

    #[inline(always)]
    fn neg_mul_add(self, b: Self, c: Self) -> Self {
        each(|i| (-self[i]).mul_add(b[i], c[i]))
    }

    #[inline(always)]
    fn mul_sub(self, b: Self, c: Self) -> Self {
        each(|i| self[i].mul_add(b[i], -c[i]))
    }

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        each(|i| self[i] / other[i])
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        each(|i| self[i].sqrt())
    }

    #[inline(always)]
    fn abs(self) -> Self {
        each(|i| self[i].abs())
    }

    #[inline(always)]
    fn any_above(self, limit: Self) -> bool {
        self.iter().zip(&limit).any(|(x, limit)| x > limit)
    }

    #[inline(always)]
    fn if_above(self, limit: Self, this: Self, that: Self) -> Self {
        each(|i| if self[i] > limit[i] { this[i] } else { that[i] })
    }

    #[inline(always)]
    fn below(self) -> Self {
        each(|i| f64::from_bits(self[i].to_bits().wrapping_sub(1)))
    }

    #[inline(always)]
    fn count_change(self, a: Self, b: Self) -> Self {
        each(|i| f64::from_bits(self[i].to_bits() + ((a[i].to_bits() ^ b[i].to_bits()) >> 63)))
    }

    #[inline(always)]
    fn normalizing(self) -> Self {
        each(|i| f64::from_bits(EXPONENTS.wrapping_sub((self[i].to_bits() & !SIGN) >> 52) << 52))
    }
}

#[inline(always)]
fn each(f: impl Fn(usize) -> f64) -> [f64; LANES] {
    let mut all = [0.0; LANES];
    for (i, lane) in all.iter_mut().enumerate() {
        *lane = f(i);
    }
    all
}

/// A vector of registers: their type and number, and what its operations are called.
#[cfg(target_arch = "x86_64")]
macro_rules! registers {
    ($name:ident, $register:ty, $count:literal, $integers:ty, $set:ident, $set_integers:ident, $load:ident,
     $store:ident, $add:ident, $sub:ident, $mul:ident, $div:ident, $sqrt:ident, $mul_add:ident, $neg_mul_add:ident, $mul_sub:ident,
     $as_integers:ident, $as_doubles:ident, $and:ident, $xor:ident, $add_integers:ident, $sub_integers:ident,
     $right:ident, $left:ident, $if_above:ident, $any_above:ident) => {
        /// Numbers in registers: to be used in a function that is compiled for them only.
        #[derive(Clone, Copy)]
        pub(crate) struct $name([$register; $count]);

        // Safety: see the type.
        impl Vector for $name {
            #[inline(always)]
            fn splat(x: f64) -> Self {
                Self([unsafe { $set(x) }; $count])
            }

            #[inline(always)]
            fn load(from: &[f64; LANES]) -> Self {
                let mut all = Self::splat(0.0);
                for (k, register) in all.0.iter_mut().enumerate() {
                    *register = unsafe { $load(from.as_ptr().add(k * (LANES / $count))) };
                }
                all
            }

            #[inline(always)]
            fn store(self, to: &mut [f64; LANES]) {
                for (k, &register) in self.0.iter().enumerate() {
                    unsafe { $store(to.as_mut_ptr().add(k * (LANES / $count)), register) }
                }
            }

            #[inline(always)]
            fn add(self, other: Self) -> Self {
                // No closures: compilers leave them for the processor's common instructions.
                let mut all = self;
                for (k, register) in all.0.iter_mut().enumerate() {
                    *register = unsafe { $add(self.0[k], other.0[k]) };
                }
                all
            }

            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                let mut all = self;
                for (k, register) in all.0.iter_mut().enumerate() {
                    *register = unsafe { $sub(self.0[k], other.0[k]) };
                }
                all
            }

            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                let mut all = self;
                for (k, register) in all.0.iter_mut().enumerate() {
                    *register = unsafe { $mul(self.0[k], other.0[k]) };
                }
                all
            }

            #[inline(always)]
            fn mul_add(self, b: Self, c: Self) -> Self {
                let mut all = self;
                for (k, register) in all.0.iter_mut().enumerate() {
                    *register = unsafe { $mul_add(self.0[k], b.0[k], c.0[k]) };
                }
                all
            }

            #[inline(always)]
            fn neg_mul_add(self, b: Self, c: Self) -> Self {
                let mut all = self;
                for (k, register) in all.0.iter_mut().enumerate() {
                    *register = unsafe { $neg_mul_add(self.0[k], b.0[k], c.0[k]) };
                }
                all
            }

            #[inline(always)]
            fn mul_sub(self, b: Self, c: Self) -> Self {
                let mut all = self;
                for (k, register) in all.0.iter_mut().enumerate() {
                    *register = unsafe { $mul_sub(self.0[k], b.0[k], c.0[k]) };
                }
                all
            }

            #[inline(always)]
            fn div(self, other: Self) -> Self {
                let mut all = self;
                for (k, register) in all.0.iter_mut().enumerate() {
                    *register = unsafe { $div(self.0[k], other.0[k]) };
                }
                all
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                let mut all = self;
                for register in &mut all.0 {
                    *register = unsafe { $sqrt(*register) };
                }
                all
            }

            #[inline(always)]
            fn any_above(self, limit: Self) -> bool {
                let mut any = 0;
                for k in 0..$count {
                    any |= unsafe { $any_above(self.0[k], limit.0[k]) };
                }
                any != 0
            }

            #[inline(always)]
            fn abs(self) -> Self {
                let mut all = self;
                for (k, register) in all.0.iter_mut().enumerate() {
                    *register =
                        unsafe { $as_doubles($and($as_integers(self.0[k]), $set_integers(!SIGN as i64))) };
                }
                all
            }

            #[inline(always)]
            fn if_above(self, limit: Self, this: Self, that: Self) -> Self {
                let mut all = self;
                for (k, register) in all.0.iter_mut().enumerate() {
                    *register = unsafe { $if_above(self.0[k], limit.0[k], this.0[k], that.0[k]) };
                }
                all
            }

            #[inline(always)]
            fn below(self) -> Self {
                let mut all = self;
                for register in &mut all.0 {
                    *register =
                        unsafe { $as_doubles($sub_integers($as_integers(*register), $set_integers(1))) };
                }
                all
            }

            #[inline(always)]
            fn count_change(self, a: Self, b: Self) -> Self {
                let mut all = self;
                for (k, register) in all.0.iter_mut().enumerate() {
                    *register = unsafe {
                        let changed = $right::<63>($xor($as_integers(a.0[k]), $as_integers(b.0[k])));
                        $as_doubles($add_integers($as_integers(self.0[k]), changed))
                    };
                }
                all
            }

            #[inline(always)]
            fn normalizing(self) -> Self {
                let mut all = self;
                for (k, register) in all.0.iter_mut().enumerate() {
                    *register = unsafe {
                        let positive = $and($as_integers(self.0[k]), $set_integers(!SIGN as i64));
                        let exponent = $sub_integers($set_integers(EXPONENTS as i64), $right::<52>(positive));
                        $as_doubles($left::<52>(exponent))
                    };
                }
                all
            }
        }
    };
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::*;

    use super::{EXPONENTS, LANES, SIGN, Vector};

    #[inline(always)]
    unsafe fn blend512(x: __m512d, limit: __m512d, this: __m512d, that: __m512d) -> __m512d {
        unsafe { _mm512_mask_blend_pd(_mm512_cmp_pd_mask::<_CMP_GT_OQ>(x, limit), that, this) }
    }

    #[inline(always)]
    unsafe fn blend256(x: __m256d, limit: __m256d, this: __m256d, that: __m256d) -> __m256d {
        unsafe { _mm256_blendv_pd(that, this, _mm256_cmp_pd::<_CMP_GT_OQ>(x, limit)) }
    }

    #[inline(always)]
    unsafe fn above512(x: __m512d, limit: __m512d) -> u32 {
        unsafe { u32::from(_mm512_cmp_pd_mask::<_CMP_GT_OQ>(x, limit)) }
    }

    #[inline(always)]
    unsafe fn above256(x: __m256d, limit: __m256d) -> i32 {
        unsafe { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GT_OQ>(x, limit)) }
    }

    registers!(
        Avx512,
        __m512d,
        2,
        __m512i,
        _mm512_set1_pd,
        _mm512_set1_epi64,
        _mm512_loadu_pd,
        _mm512_storeu_pd,
        _mm512_add_pd,
        _mm512_sub_pd,
        _mm512_mul_pd,
        _mm512_div_pd,
        _mm512_sqrt_pd,
        _mm512_fmadd_pd,
        _mm512_fnmadd_pd,
        _mm512_fmsub_pd,
        _mm512_castpd_si512,
        _mm512_castsi512_pd,
        _mm512_and_si512,
        _mm512_xor_si512,
        _mm512_add_epi64,
        _mm512_sub_epi64,
        _mm512_srli_epi64,
        _mm512_slli_epi64,
        blend512,
        above512
    );

    registers!(
        Avx2,
        __m256d,
        4,
        __m256i,
        _mm256_set1_pd,
        _mm256_set1_epi64x,
        _mm256_loadu_pd,
        _mm256_storeu_pd,
        _mm256_add_pd,
        _mm256_sub_pd,
        _mm256_mul_pd,
        _mm256_div_pd,
        _mm256_sqrt_pd,
        _mm256_fmadd_pd,
        _mm256_fnmadd_pd,
        _mm256_fmsub_pd,
        _mm256_castpd_si256,
        _mm256_castsi256_pd,
        _mm256_and_si256,
        _mm256_xor_si256,
        _mm256_add_epi64,
        _mm256_sub_epi64,
        _mm256_srli_epi64,
        _mm256_slli_epi64,
        blend256,
        above256
    );
}

#[cfg(target_arch = "x86_64")]
pub(crate) use x86::{Avx2, Avx512};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verdict::instructions::{Instructions, Kernel};

    struct Everything([[f64; LANES]; 3]);

    impl Kernel for Everything {
        type Output = Vec<[u64; LANES]>;

        fn run<V: Vector>(self) -> Self::Output {
            let [a, b, c] = [V::load(&self.0[0]), V::load(&self.0[1]), V::load(&self.0[2])];
            let (sum, rest) = a.two_sum(b);
            let (difference, left) = a.two_sub(b);
            let (product, lost) = a.two_product(b);
            let bits = |x: V| {
                let mut lanes = [0.0; LANES];
                x.store(&mut lanes);
                // NaN has many forms.
                lanes.map(|x| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() })
            };
            let any = V::splat(f64::from(u8::from(a.any_above(b))));
            let results = [
                a,
                any,
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
                a.larger(b),
                a.lesser(b),
                c.abs().normalizing(),
            ];
            let mut all: Vec<_> = results.into_iter().map(bits).collect();
            // What is done to bits holds for whole numbers and for positive ones.
            let unit = V::splat((1u64 << 52) as f64);
            all.extend([unit.count_change(a, b), c.abs().above(), c.abs().below()].map(bits));
            all
        }
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
            let portable = Instructions::Portable.compute(Everything(numbers));
            assert!(Instructions::available().all(|set| set.compute(Everything(numbers)) == portable));
        }
    }

    #[test]
    fn operations_are_what_they_say() {
        let x = [3.0; LANES];
        assert_eq!(x.neg_mul_add([2.0; LANES], [10.0; LANES]), [4.0; LANES]);
        assert_eq!(x.mul_sub([2.0; LANES], [10.0; LANES]), [-4.0; LANES]);
        assert_eq!(x.mul([f64::EPSILON; LANES]).normalizing(), [2f64.powi(51); LANES]);
        assert_eq!((x.above(), x.below()), ([3f64.next_up(); LANES], [3f64.next_down(); LANES]));
        assert_eq!(x.two_sum([f64::EPSILON; LANES]), ([3.0; LANES], [f64::EPSILON; LANES]));
        assert_eq!(x.two_sub([f64::EPSILON; LANES]), ([3.0; LANES], [-f64::EPSILON; LANES]));
    }
}
