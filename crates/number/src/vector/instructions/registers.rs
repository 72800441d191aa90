//! Vectors in the registers of x86-64.
//!
//! Their operations are safe because nobody can name these types who has not asked the processor:
//! `instructions` alone sees them, and it hands them to kernels with an `Instructions` in its hand that has
//! them. A kernel knows them as some `V: Vector`, from which no value leads out of it.

use std::arch::x86_64::*;

use crate::vector::{EXPONENTS, FloatRing, SIGN, Vector, WHOLE};

/// A value for the k-th register, of every one. A loop and no closure: compilers leave closures for the
/// processor's common instructions.
macro_rules! each {
    ($vector:ident, $k:ident => $value:expr) => {{
        let mut all = $vector;
        for ($k, register) in all.0.iter_mut().enumerate() {
            // Safety: a processor without these instructions never sees a vector in its registers, as said
            // above.
            *register = unsafe { $value };
        }
        all
    }};
}

/// A vector of registers: their type and number, and what its operations are called.
macro_rules! registers {
    ($name:ident, $register:ty, $count:literal of $width:literal,
     memory: $load:ident $store:ident $set:ident $set_integers:ident,
     doubles: $add:ident $sub:ident $mul:ident $div:ident $sqrt:ident $mul_add:ident $neg_mul_add:ident $mul_sub:ident,
     bits: $as_integers:ident $as_doubles:ident $and:ident $xor:ident $plus:ident $minus:ident $right:ident $left:ident,
     choice: $choose:ident $any:ident $mask:ty, $exceeds:ident $contrast:ident $select:ident) => {
        #[derive(Clone, Copy)]
        pub(super) struct $name([$register; $count]);

        impl FloatRing for $name {
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                each!(self, k => $add(self.0[k], other.0[k]))
            }

            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                each!(self, k => $sub(self.0[k], other.0[k]))
            }

            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                each!(self, k => $mul(self.0[k], other.0[k]))
            }

            #[inline(always)]
            fn mul_add(self, b: Self, c: Self) -> Self {
                each!(self, k => $mul_add(self.0[k], b.0[k], c.0[k]))
            }

            #[inline(always)]
            fn mul_sub(self, b: Self, c: Self) -> Self {
                each!(self, k => $mul_sub(self.0[k], b.0[k], c.0[k]))
            }
        }

        impl Vector for $name {
            const WIDTH: usize = $count * $width;
            type Mask = [$mask; $count];

            #[inline(always)]
            fn exceeds(self, limit: Self) -> Self::Mask {
                // Safety: as for all operations.
                let mut mask = [unsafe { $exceeds(self.0[0], limit.0[0]) }; $count];
                for (k, mask) in mask.iter_mut().enumerate().skip(1) {
                    *mask = unsafe { $exceeds(self.0[k], limit.0[k]) };
                }
                mask
            }

            #[inline(always)]
            fn alternatives(this: Self, that: Self) -> [Self; 2] {
                [each!(this, k => $contrast(this.0[k], that.0[k])), that]
            }

            #[inline(always)]
            fn choose(mask: Self::Mask, [this, that]: [Self; 2]) -> Self {
                each!(that, k => $select(mask[k], this.0[k], that.0[k]))
            }

            #[inline(always)]
            fn splat(x: f64) -> Self {
                // Safety: as for all operations.
                Self([unsafe { $set(x) }; $count])
            }

            #[inline(always)]
            fn load(from: &[f64]) -> Self {
                let (all, from) = (Self::splat(0.0), &from[..Self::WIDTH]);
                each!(all, k => $load(from.as_ptr().add(k * $width)))
            }

            #[inline(always)]
            fn store(self, to: &mut [f64]) {
                let to = &mut to[..Self::WIDTH];
                for (k, &register) in self.0.iter().enumerate() {
                    // Safety: as for all operations; the registers together are as long as the slice.
                    unsafe { $store(to.as_mut_ptr().add(k * $width), register) }
                }
            }

            #[inline(always)]
            fn neg_mul_add(self, b: Self, c: Self) -> Self {
                each!(self, k => $neg_mul_add(self.0[k], b.0[k], c.0[k]))
            }

            #[inline(always)]
            fn div(self, other: Self) -> Self {
                each!(self, k => $div(self.0[k], other.0[k]))
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                each!(self, k => $sqrt(self.0[k]))
            }

            #[inline(always)]
            fn abs(self) -> Self {
                each!(self, k => $as_doubles($and($as_integers(self.0[k]), $set_integers(!SIGN as i64))))
            }

            #[inline(always)]
            fn any_above(self, limit: Self) -> bool {
                // Safety: as for all operations.
                (0..$count).fold(0, |any, k| any | unsafe { $any(self.0[k], limit.0[k]) }) != 0
            }

            #[inline(always)]
            fn if_above(self, limit: Self, this: Self, that: Self) -> Self {
                each!(self, k => $choose(self.0[k], limit.0[k], this.0[k], that.0[k]))
            }

            #[inline(always)]
            fn below(self) -> Self {
                each!(self, k => $as_doubles($minus($as_integers(self.0[k]), $set_integers(1))))
            }

            #[inline(always)]
            fn count_change(self, a: Self, b: Self) -> Self {
                each!(self, k => {
                    let changed = $right::<63>($xor($as_integers(a.0[k]), $as_integers(b.0[k])));
                    $as_doubles($plus($as_integers(self.0[k]), changed))
                })
            }

            #[inline(always)]
            fn count_change_below(self, a: Self, b: Self, c: Self) -> Self {
                each!(self, k => {
                    let changed = $xor($as_integers(a.0[k]), $as_integers(b.0[k]));
                    let below = $right::<63>($and(changed, $as_integers(c.0[k])));
                    $as_doubles($plus($as_integers(self.0[k]), below))
                })
            }

            #[inline(always)]
            fn normalizing(self) -> Self {
                each!(self, k => {
                    let positive = $and($as_integers(self.0[k]), $set_integers(!SIGN as i64));
                    let exponent = $minus($set_integers(EXPONENTS as i64), $right::<52>(positive));
                    $as_doubles($left::<52>(exponent))
                })
            }

            #[inline(always)]
            fn logarithm(self) -> Self {
                let whole = each!(self, k => {
                    let positive = $and($as_integers(self.0[k]), $set_integers(!SIGN as i64));
                    // No bit of the two is the same.
                    let bits = $right::<20>(positive);
                    $as_doubles($xor(bits, $set_integers(WHOLE.to_bits() as i64)))
                });
                whole.sub(Self::splat(WHOLE))
            }
        }
    };
}

/// [`registers`] of AVX-512, so many of them.
macro_rules! avx512 {
    ($name:ident, $count:literal) => {
        registers!(
            $name, __m512d, $count of 8,
            memory: _mm512_loadu_pd _mm512_storeu_pd _mm512_set1_pd _mm512_set1_epi64,
            doubles: _mm512_add_pd _mm512_sub_pd _mm512_mul_pd _mm512_div_pd _mm512_sqrt_pd
                _mm512_fmadd_pd _mm512_fnmadd_pd _mm512_fmsub_pd,
            bits: _mm512_castpd_si512 _mm512_castsi512_pd _mm512_and_si512 _mm512_xor_si512
                _mm512_add_epi64 _mm512_sub_epi64 _mm512_srli_epi64 _mm512_slli_epi64,
            choice: choose512 any512 __mmask8, exceeds512 contrast512 select512
        );
    };
}

/// [`registers`] of AVX2, so many of them.
macro_rules! avx2 {
    ($name:ident, $count:literal) => {
        registers!(
            $name, __m256d, $count of 4,
            memory: _mm256_loadu_pd _mm256_storeu_pd _mm256_set1_pd _mm256_set1_epi64x,
            doubles: _mm256_add_pd _mm256_sub_pd _mm256_mul_pd _mm256_div_pd _mm256_sqrt_pd
                _mm256_fmadd_pd _mm256_fnmadd_pd _mm256_fmsub_pd,
            bits: _mm256_castpd_si256 _mm256_castsi256_pd _mm256_and_si256 _mm256_xor_si256
                _mm256_add_epi64 _mm256_sub_epi64 _mm256_srli_epi64 _mm256_slli_epi64,
            choice: choose256 any256 __m256d, exceeds256 contrast256 select256
        );
    };
}

avx512!(Avx512, 2);
avx512!(Avx512Single, 1);
avx2!(Avx2, 4);
avx2!(Avx2Single, 1);

// Safety of what follows: as for all operations.

#[inline(always)]
unsafe fn choose512(x: __m512d, limit: __m512d, this: __m512d, that: __m512d) -> __m512d {
    unsafe { _mm512_mask_blend_pd(_mm512_cmp_pd_mask::<_CMP_GT_OQ>(x, limit), that, this) }
}

#[inline(always)]
unsafe fn any512(x: __m512d, limit: __m512d) -> u8 {
    unsafe { _mm512_cmp_pd_mask::<_CMP_GT_OQ>(x, limit) }
}

#[inline(always)]
unsafe fn choose256(x: __m256d, limit: __m256d, this: __m256d, that: __m256d) -> __m256d {
    unsafe { _mm256_blendv_pd(that, this, _mm256_cmp_pd::<_CMP_GT_OQ>(x, limit)) }
}

#[inline(always)]
unsafe fn any256(x: __m256d, limit: __m256d) -> i32 {
    unsafe { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GT_OQ>(x, limit)) }
}

#[inline(always)]
unsafe fn exceeds512(x: __m512d, limit: __m512d) -> __mmask8 {
    unsafe { _mm512_cmp_pd_mask::<_CMP_GT_OQ>(x, limit) }
}

#[inline(always)]
unsafe fn contrast512(this: __m512d, _that: __m512d) -> __m512d {
    this
}

#[inline(always)]
unsafe fn select512(mask: __mmask8, this: __m512d, that: __m512d) -> __m512d {
    unsafe { _mm512_mask_blend_pd(mask, that, this) }
}

#[inline(always)]
unsafe fn exceeds256(x: __m256d, limit: __m256d) -> __m256d {
    unsafe { _mm256_cmp_pd::<_CMP_GT_OQ>(x, limit) }
}

/// Bits that differ: two logical operations then do what a blend takes three for.
#[inline(always)]
unsafe fn contrast256(this: __m256d, that: __m256d) -> __m256d {
    unsafe { _mm256_xor_pd(this, that) }
}

#[inline(always)]
unsafe fn select256(mask: __m256d, contrast: __m256d, that: __m256d) -> __m256d {
    unsafe { _mm256_xor_pd(_mm256_and_pd(mask, contrast), that) }
}
