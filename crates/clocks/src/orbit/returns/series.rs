//! Complex power series in t, cut off after [`Coefficient::TERMS`]: what is guessed with them is proven by
//! maps afterwards.

use num_complex::Complex64;

use super::coefficient::Coefficient;
use number::Ball;
use number::vector::instructions::{Instructions, Task};

/// A complex number.
type Complex<T> = [T; 2];

#[derive(Clone)]
pub struct Series<T>(pub Vec<Complex<T>>);

#[inline(always)]
fn plus<T: Coefficient>([a, b]: &Complex<T>, [c, d]: &Complex<T>) -> Complex<T> {
    [a.plus(c), b.plus(d)]
}

#[inline(always)]
fn negative<T: Coefficient>(x: &Complex<T>) -> Complex<T> {
    x.each_ref().map(T::negative)
}

#[inline(always)]
fn times<T: Coefficient>([a, b]: &Complex<T>, [c, d]: &Complex<T>) -> Complex<T> {
    [a.times(c).plus(&b.times(d).negative()), a.times(d).plus(&b.times(c))]
}

#[inline(always)]
fn scaled<T: Coefficient>(x: &Complex<T>, by: &T) -> Complex<T> {
    x.each_ref().map(|x| x.times(by))
}

fn near<T: Coefficient>([a, b]: &Complex<T>) -> Complex64 {
    Complex64::new(a.near(), b.near())
}

fn of<T: Coefficient>(x: Complex64) -> Complex<T> {
    [T::of(x.re), T::of(x.im)]
}

/// Steps of Newton's method from a double's 50 bits, each of which doubles them.
fn refinements<T: Coefficient>() -> u32 {
    (T::BITS / 50).next_power_of_two().ilog2()
}

/// 1/x; `None` for zero, and for what doubles do not hold.
fn reciprocal<T: Coefficient>(x: &Complex<T>) -> Option<Complex<T>> {
    let first = near(x).inv();
    if !first.is_finite() {
        return None;
    }
    let mut y = of(first);
    for _ in 0..refinements::<T>() {
        let rest = plus(&[T::of(1.0), T::zero()], &negative(&times(x, &y)));
        y = plus(&y, &times(&y, &rest));
    }
    Some(y)
}

fn root<T: Coefficient>(x: &Complex<T>) -> Option<Complex<T>> {
    let mut y = of(near(x).sqrt());
    for _ in 0..refinements::<T>() {
        y = plus(&y, &times(x, &reciprocal(&y)?)).map(|x| x.scale2(-1));
    }
    Some(y)
}

/// ln x, the angle in -π..=π.
fn logarithm<T: Coefficient>(x: &Complex<T>) -> Option<Complex<T>> {
    // An angle near 0 or π has half the digits of its cosine.
    let bits = 2 * T::BITS + 64;
    let [re, im] = x.each_ref().map(T::ball);
    let square = re.square(bits).add(&im.square(bits), bits);
    let cosine = re.div(&square.sqrt(bits)?, bits)?.midpoint();
    let one = Ball::one();
    let within = if cosine.abs().sub(&one, bits).to_f64_enclosure().1 > 0.0 { one } else { cosine };
    let angle = within.acos(bits)?;
    let angle = if x[1].near() < 0.0 { angle.neg() } else { angle };
    Some([T::of_ball(&square.ln(bits)?.scale2(-1)), T::of_ball(&angle)])
}

impl<T: Coefficient> Series<T> {
    pub fn real(terms: impl Iterator<Item = T>) -> Self {
        Series(terms.map(|x| [x, T::zero()]).collect())
    }

    pub fn constant(x: f64) -> Self {
        Series(vec![of(x.into())])
    }

    pub fn re(&self, i: usize) -> T {
        self.0.get(i).map_or_else(T::zero, |[re, _]| *re)
    }

    pub fn im(&self, i: usize) -> T {
        self.0.get(i).map_or_else(T::zero, |[_, im]| *im)
    }

    /// The constant term.
    pub fn first(&self) -> Complex64 {
        near(&self.0[0])
    }

    /// Σ |c_j|.
    pub fn size(&self) -> f64 {
        self.0.iter().map(|x| near(x).norm()).sum()
    }

    /// Σ |c_j| over all but the constant term.
    pub fn variation(&self) -> f64 {
        self.0[1..].iter().map(|x| near(x).norm()).sum()
    }

    pub fn plus(&self, other: &Self) -> Self {
        let (long, short) = if self.0.len() >= other.0.len() { (self, other) } else { (other, self) };
        let mut sum = long.clone();
        sum.0.iter_mut().zip(&short.0).for_each(|(x, y)| *x = plus(x, y));
        sum
    }

    pub fn negative(&self) -> Self {
        Series(self.0.iter().map(negative).collect())
    }

    pub fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negative())
    }

    pub fn scale2(&self, k: i32) -> Self {
        Series(self.0.iter().map(|x| x.each_ref().map(|x| x.scale2(k))).collect())
    }

    pub fn times(&self, other: &Self) -> Self {
        Series(Instructions::best().perform_alone(Product(&self.0, &other.0)))
    }

    /// The coefficients one after the other: c_k of `length` from `next(k, those before)`.
    fn solved(length: usize, first: Complex<T>, next: impl Fn(usize, &[Complex<T>]) -> Complex<T>) -> Self {
        let mut terms = vec![first];
        for k in 1..length {
            let term = next(k, &terms);
            terms.push(term);
        }
        Series(terms)
    }

    fn term(&self, k: usize) -> Complex<T> {
        self.0.get(k).cloned().unwrap_or_else(|| [T::zero(), T::zero()])
    }

    pub fn over(&self, divisor: &Self) -> Option<Self> {
        let inverse = reciprocal(&divisor.0[0])?;
        let terms = if divisor.0.len() == 1 { self.0.len() } else { T::TERMS };
        let quotient = Quotient { series: &self.0, divisor: &divisor.0, inverse, terms };
        Some(Series(Instructions::best().perform_alone(quotient)))
    }

    pub fn root(&self) -> Option<Self> {
        let first = root(&self.0[0])?;
        let inverse = reciprocal(&plus(&first, &first))?;
        let length = if self.0.len() == 1 { 1 } else { T::TERMS };
        Some(Series::solved(length, first, |k, known| {
            let passed = known[1..].iter().zip(known[1..].iter().rev());
            let rest = passed.fold(self.term(k), |rest, (x, y)| plus(&rest, &negative(&times(x, y))));
            times(&rest, &inverse)
        }))
    }

    /// ln, the angle at t = 0 in -π..=π.
    pub fn logarithm(&self) -> Option<Self> {
        let (first, inverse) = (logarithm(&self.0[0])?, reciprocal(&self.0[0])?);
        let length = if self.0.len() == 1 { 1 } else { T::TERMS };
        Some(Series::solved(length, first, |k, known| {
            // k c_k = Σ j l_j c_(k - j).
            let passed = (1..k).map(|j| scaled(&times(&known[j], &self.term(k - j)), &T::of(j as f64)));
            let sum = passed.fold([T::zero(), T::zero()], |sum, x| plus(&sum, &x));
            let mean = scaled(&sum, &T::quotient(1, k as u128));
            times(&plus(&self.term(k), &negative(&mean)), &inverse)
        }))
    }

    /// At t + τ.
    pub fn shifted(&self, tau: &T) -> Self {
        Series(Instructions::best().perform_alone(Shift(self.0.clone(), tau)))
    }
}

struct Product<'a, T>(&'a [Complex<T>], &'a [Complex<T>]);

impl<T: Coefficient> Task for Product<'_, T> {
    type Output = Vec<Complex<T>>;

    #[inline(always)]
    fn run(self) -> Vec<Complex<T>> {
        let Product(one, two) = self;
        let terms = (one.len() + two.len() - 1).min(T::TERMS);
        let mut product = vec![[T::zero(), T::zero()]; terms];
        for i in 0..one.len().min(terms) {
            for j in 0..two.len().min(terms - i) {
                product[i + j] = plus(&product[i + j], &times(&one[i], &two[j]));
            }
        }
        product
    }
}

struct Quotient<'a, T> {
    series: &'a [Complex<T>],
    divisor: &'a [Complex<T>],
    /// Of the divisor's first coefficient.
    inverse: Complex<T>,
    terms: usize,
}

impl<T: Coefficient> Task for Quotient<'_, T> {
    type Output = Vec<Complex<T>>;

    #[inline(always)]
    fn run(self) -> Vec<Complex<T>> {
        let mut quotient: Vec<Complex<T>> = Vec::with_capacity(self.terms);
        for k in 0..self.terms {
            let mut rest = if k < self.series.len() { self.series[k] } else { [T::zero(), T::zero()] };
            for j in 1..self.divisor.len().min(k + 1) {
                rest = plus(&rest, &negative(&times(&self.divisor[j], &quotient[k - j])));
            }
            quotient.push(times(&rest, &self.inverse));
        }
        quotient
    }
}

/// By τ.
struct Shift<'a, T>(Vec<Complex<T>>, &'a T);

impl<T: Coefficient> Task for Shift<'_, T> {
    type Output = Vec<Complex<T>>;

    #[inline(always)]
    fn run(self) -> Vec<Complex<T>> {
        let Shift(mut terms, tau) = self;
        for i in 0..terms.len() {
            for j in (i..terms.len() - 1).rev() {
                terms[j] = plus(&terms[j], &scaled(&terms[j + 1], tau));
            }
        }
        terms
    }
}
