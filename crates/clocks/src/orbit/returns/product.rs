//! Products of functions, and functions on parts of their intervals: the arithmetic of a verdict.
//!
//! Few coefficients need all digits of their numbers: what is left out of a function is as small as its level
//! allows ([`Map::least`]), and coefficients fall by many bits from one to the next. So the last ones, whose
//! roundings in the next shorter numbers together are no more than that, are computed in these
//! (proofs/RETURNS.md, "Last coefficients").

use super::coefficient::Coefficient;
use super::lanes::Lanes;
use super::map::{Entries, FEW, FLOOR, MOST, Map, UP, sizes, sums};
use number::vector::instructions::{Instructions, Task};

impl<T: Coefficient> Map<T> {
    /// `self` after `earlier`, on the same interval.
    pub fn after(&self, earlier: &Self) -> Self {
        Instructions::best().perform_alone(Product { later: self, earlier })
    }

    /// On the part t = α + β t' of its interval, |α| + |β| ≤ 1.
    pub fn part(&self, alpha: &T, beta: &T) -> Self {
        Instructions::best().perform_alone(Part { whole: self, alpha, beta })
    }

    /// At the point t = α.
    pub fn at(&self, alpha: &T) -> Self {
        Instructions::best().perform_alone(Value { whole: self, alpha })
    }
}

/// The unit of the next shorter numbers.
const fn lower_unit<T: Coefficient>() -> f64 {
    <T::Lower as Coefficient>::UNIT
}

/// Whether there are shorter numbers.
const fn has_lower<T: Coefficient>() -> bool {
    T::BITS > <T::Lower as Coefficient>::BITS
}

/// Of n coefficients those that need all digits, the first ones, and what all others add to the error in
/// shorter numbers: `roundings` says it of one in units of these.
#[inline(always)]
fn long_ones<T: Coefficient>(n: usize, least: f64, roundings: impl Fn(usize) -> f64) -> (usize, f64) {
    let (mut long, mut lost) = (n, 0.0);
    while has_lower::<T>() && long > 0 {
        let next = lost + lower_unit::<T>() * roundings(long - 1);
        if next >= least {
            break;
        }
        (long, lost) = (long - 1, next);
    }
    (long, lost)
}

#[inline(always)]
fn lower<T: Coefficient>(term: &Entries<T>) -> Entries<T::Lower> {
    term.each_ref().map(T::to)
}

#[inline(always)]
fn raised<T: Coefficient>(lanes: <T::Lower as Coefficient>::Lanes) -> T::Lanes {
    let entries = lanes.entries().map(|x| x.to::<T>());
    T::Lanes::of(entries.each_ref())
}

struct Product<'a, T> {
    later: &'a Map<T>,
    earlier: &'a Map<T>,
}

impl<T: Coefficient> Product<'_, T> {
    /// With room for so many terms of a factor, and of their product.
    #[inline(always)]
    fn with_room<const N: usize, const ALL: usize>(&self) -> Map<T> {
        let Product { later, earlier } = self;
        let (b, a): ([f64; N], [f64; N]) = (sizes(later.terms()), sizes(earlier.terms()));
        let ends = (later.terms().len(), earlier.terms().len());
        let ([sum_b, rank_b], [sum_a, rank_a]) = (sums(&b[..ends.0]), sums(&a[..ends.1]));
        // Σ |B_i| |A_j|, i + j = m.
        let mut degrees = [0.0; ALL];
        for (i, b) in b[..ends.0].iter().enumerate() {
            for (degree, a) in degrees[i..].iter_mut().zip(&a) {
                *degree += b * a;
            }
        }
        let mut n = ends.0 + ends.1 - 1;
        let relative = later.least.max(earlier.least);
        let (mut dropped, least) = (0.0, relative * sum_b * sum_a);
        while n > 1 && (n > T::TERMS || dropped + degrees[n - 1] < least) {
            n -= 1;
            dropped += degrees[n];
        }
        let (long, lost) = long_ones::<T>(n, least, |m| 2.0 * f64::from(2 * m as u32 + 8) * degrees[m]);
        let rounding = 2.0 * T::UNIT * (4.0 * sum_b * sum_a + 2.0 * (rank_b * sum_a + sum_b * rank_a)) + lost;
        let carried =
            later.norm() * earlier.bound() + earlier.norm() * later.bound() + later.bound() * earlier.bound();
        let error = (carried + dropped + rounding) * UP + FLOOR;
        let known = (later.norm() * earlier.norm() + dropped + rounding) * UP;
        let exponent = later.exponent.saturating_add(earlier.exponent);
        let mut product = Map::bounded(self.terms::<N>(n, long), error, known, exponent);
        product.least = relative;
        product.turn = later.turn_after(earlier, &product);
        product
    }

    /// The first n coefficients, the first ones of which in these numbers and the others in shorter ones.
    #[inline(always)]
    fn terms<const N: usize>(&self, n: usize, long: usize) -> Vec<Entries<T>> {
        let (later, earlier) = (self.later.terms(), self.earlier.terms());
        let mut terms = Vec::with_capacity(n);
        for m in 0..long {
            terms.push(coefficient(later, earlier, m).entries());
        }
        if long < n {
            let (b, a) = (shortened::<T, N>(later), shortened::<T, N>(earlier));
            let (b, a) = (&b[..later.len()], &a[..earlier.len()]);
            for m in long..n {
                terms.push(raised::<T>(coefficient(b, a, m)).entries());
            }
        }
        terms
    }
}

#[inline(always)]
fn shortened<T: Coefficient, const N: usize>(terms: &[Entries<T>]) -> [Entries<T::Lower>; N] {
    let mut short = [[<T::Lower as Coefficient>::zero(); 4]; N];
    for (short, term) in short.iter_mut().zip(terms) {
        *short = lower(term);
    }
    short
}

/// Coefficients of so low a degree are gathered: more products would lose more than is said of them.
const GATHERED: usize = 13;

/// The coefficient m of a product.
#[inline(always)]
fn coefficient<T: Coefficient>(later: &[Entries<T>], earlier: &[Entries<T>], m: usize) -> T::Lanes {
    let of = T::Lanes::of;
    let mut sum = T::Lanes::splat(&T::zero());
    let from = (m + 1).saturating_sub(earlier.len());
    for i in from..(m + 1).min(later.len()) {
        let ([a, b, c, d], [e, f, g, h]) = (&later[i], &earlier[m - i]);
        // The later matrix's columns meet the earlier one's rows.
        let (left, upper) = (of([a, a, c, c]), of([e, f, e, f]));
        let (right, lower) = (of([b, b, d, d]), of([g, h, g, h]));
        sum = if m < GATHERED {
            sum.gathered(&left, &upper).gathered(&right, &lower)
        } else {
            sum.plus_times(&left, &upper).plus_times(&right, &lower)
        };
    }
    if m < GATHERED { sum.settled() } else { sum }
}

impl<T: Coefficient> Task for Product<'_, T> {
    type Output = Map<T>;

    #[inline(always)]
    fn run(self) -> Map<T> {
        match self.later.terms().len().max(self.earlier.terms().len()) {
            0..=4 => self.with_room::<4, 8>(),
            5..=8 => self.with_room::<8, 16>(),
            9..=FEW => self.with_room::<FEW, { 2 * FEW }>(),
            _ => self.with_room::<MOST, { 2 * MOST }>(),
        }
    }
}

/// A function in t' of t = α + β t'.
struct Part<'a, T> {
    whole: &'a Map<T>,
    alpha: &'a T,
    beta: &'a T,
}

impl<T: Coefficient> Part<'_, T> {
    #[inline(always)]
    fn with_room<const N: usize>(&self) -> Map<T> {
        let terms = self.whole.terms();
        let n = terms.len();
        let size: [f64; N] = sizes(terms);
        let least = self.whole.least * size[0];
        let (long, lost) = long_ones::<T>(n, least, |j| 1.42 * f64::from(6 * j as u32 + 8) * size[j]);
        let mut short = [<T::Lower as Coefficient>::Lanes::splat(&<T::Lower as Coefficient>::zero()); N];
        for (short, term) in short[long..].iter_mut().zip(&terms[long..]) {
            *short = <T::Lower as Coefficient>::Lanes::of(lower(term).each_ref());
        }
        let mut all = [T::Lanes::splat(&T::zero()); N];
        for (all, term) in all.iter_mut().zip(&terms[..long]) {
            *all = T::Lanes::of(term.each_ref());
        }
        let (alpha, beta) = (T::Lanes::splat(self.alpha), T::Lanes::splat(self.beta));
        let [short_alpha, short_beta] =
            [self.alpha, self.beta].map(|x| <T::Lower as Coefficient>::Lanes::splat(&x.to()));
        for i in 0..n - 1 {
            for j in (i.max(long)..n - 1).rev() {
                short[j] = short[j].plus_times(&short_alpha, &short[j + 1]);
            }
            if i < long && long < n {
                all[long - 1] = all[long - 1].plus(&raised::<T>(short_alpha.times(&short[long])));
            }
            for j in (i..long.saturating_sub(1)).rev() {
                all[j] = all[j].plus_times(&alpha, &all[j + 1]);
            }
        }
        let mut power = beta;
        for all in &mut all[1.min(long)..long] {
            *all = all.times(&power);
            power = power.times(&beta);
        }
        let mut power = <T::Lower as Coefficient>::Lanes::splat(&<T::Lower as Coefficient>::of(1.0));
        for short in &mut short[..n] {
            *short = short.times(&power);
            power = power.times(&short_beta);
        }
        let mut moved = Vec::with_capacity(n);
        for all in &all[..long] {
            moved.push(all.entries());
        }
        for short in &short[long..n] {
            moved.push(raised::<T>(*short).entries());
        }
        let mut part = self.whole.moved(moved, sums(&size[..n]), lost);
        part.turn = self.whole.turn_moved(self.alpha.near(), part.direction());
        part
    }
}

impl<T: Coefficient> Task for Part<'_, T> {
    type Output = Map<T>;

    #[inline(always)]
    fn run(self) -> Map<T> {
        match self.whole.terms().len() {
            0..=4 => self.with_room::<4>(),
            5..=8 => self.with_room::<8>(),
            9..=FEW => self.with_room::<FEW>(),
            _ => self.with_room::<MOST>(),
        }
    }
}

struct Value<'a, T> {
    whole: &'a Map<T>,
    alpha: &'a T,
}

impl<T: Coefficient> Task for Value<'_, T> {
    type Output = Map<T>;

    #[inline(always)]
    fn run(self) -> Map<T> {
        let by = T::Lanes::splat(self.alpha);
        let terms = self.whole.terms();
        let mut sum = T::Lanes::splat(&T::zero());
        for term in terms.iter().rev() {
            sum = T::Lanes::of(term.each_ref()).plus_times(&sum, &by);
        }
        let known = sums(&sizes::<T, MOST>(terms)[..terms.len()]);
        let mut value = self.whole.moved(vec![sum.entries()], known, 0.0);
        value.turn = self.whole.turn_moved(self.alpha.near(), value.direction());
        value
    }
}

#[cfg(test)]
mod tests {
    use super::super::coefficient::Long;
    use super::*;
    use number::Twofold;

    /// Coefficients that fall by 6 to 9 bits from one to the next.
    fn function(n: usize, random: &mut impl FnMut() -> f64) -> Vec<[Twofold; 4]> {
        let bits = 6.0 + 3.0 * random().abs();
        let mut term = |j: usize| {
            let size = (-bits * j as f64).exp2();
            std::array::from_fn(|k| {
                let one = if j == 0 && k % 3 == 0 { 1.0 } else { 0.0 };
                Twofold::sum(one + 0.3 * size * random(), 1e-17 * size * random())
            })
        };
        (0..n).map(&mut term).collect()
    }

    fn long(terms: &[[Twofold; 4]]) -> Map<Long> {
        Map::of(terms.iter().map(|term| term.map(|x| x.to())).collect())
    }

    /// The largest distance of two functions' values.
    fn apart(one: &Map<Twofold>, other: &Map<Long>) -> f64 {
        let values = |t: f64| {
            let (one, other) = (one.at(&<Twofold>::of(t)), other.at(&Long::of(t)));
            assert_eq!((one.exponent, other.exponent), (0, 0));
            let (one, other) = (one.terms()[0], other.terms()[0]);
            let square = |k: usize| one[k].to::<Long>().plus(&other[k].negative()).near().powi(2);
            (0..4).map(square).sum::<f64>().sqrt()
        };
        [-1.0, -0.3, 0.0, 0.6, 1.0].into_iter().map(values).fold(0.0, f64::max)
    }

    #[test]
    fn last_coefficients_in_shorter_numbers_are_within_what_is_said_of_them() {
        let mut state = 1u64;
        let mut random = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        for case in 0..300 {
            let (n, least) = (1 + case % 20, [1e-18, 1e-22, 1e-26, 0.0][case % 4]);
            let [a, b] = [n, 1 + case % 7].map(|n| function(n, &mut random));
            let [mut one, other] = [&a, &b].map(|terms| Map::<Twofold>::of(terms.clone()));
            one.least = one.least.max(least);
            let made = other.after(&one);
            let exact = long(&b).after(&long(&a));
            // Both are rounded for the comparison, at the point.
            let room = 1e-29;
            assert!(apart(&made, &exact) <= 1.42 * made.error() + room, "{case}");
            assert!(made.error() <= 1e-27 + 8.0 * least, "{case}: {}", made.error());
            let (alpha, beta) = (0.6 * random(), 0.3);
            let made = one.part(&<Twofold>::of(alpha), &<Twofold>::of(beta));
            let exact = long(&a).part(&Long::of(alpha), &Long::of(beta));
            assert!(apart(&made, &exact) <= 1.42 * made.error() + room, "{case}");
            assert!(made.error() <= 1e-27 + 8.0 * least, "{case}: {}", made.error());
        }
    }
}
