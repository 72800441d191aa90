//! Normal forms: coordinates in which all factors of a piece commute, so that their product is a closed sum.
//!
//! A factor A(x) with the step d has a row w with w(x + d) A(x) = μ(x) w(x): a left eigenvector that knows
//! the next factor. With w = (1, z) that is z(x) = (b + d z⁺)/(a + c z⁺), z⁺ = z(x + d), and corrections δ =
//! −r/(1 − μ⁻²) of what is left, r, gain a factor of about 1/n each on a piece of n steps (they are those of
//! Newton's method, but for δ⁺ − δ). Two such rows make W. So
//!
//! ```text
//!     W(x + d) A(x) = e^L(x) W(x) + R(x),
//!     P_n(x) = W(x + n d)⁻¹ (e^S + E) W(x),     S = Σ L(x + j d),     |E| ≤ |e^S| ((1 + |R W⁻¹|/|e^L|)^n − 1).
//! ```
//!
//! *Elliptic*: the rows are Re w and Im w, L = [[a, −b], [b, a]]; all norms are moduli. *Hyperbolic*: two
//! real rows, L diagonal, the first multiplier the larger one on all of the piece. W and L are polynomials
//! with floating coefficients, exactly; how they were found is of no concern, R is bounded by maps. The sum
//! is Q(x + n d) − Q(x), Q the polynomial with Q(x + d) − Q(x) = L(x).

use super::super::branch::Branch;
use super::super::coefficient::Coefficient;
use super::super::map::{Entries, MOST, Map};
use super::super::series::Series;
use super::super::turn::Turn;
use num_traits::ToPrimitive;
use number::{Ball, Rational};
use std::f64::consts::PI;

/// The part of rounding in the bound of a product of n factors, about.
pub fn roundings<T: Coefficient>(n: u128) -> f64 {
    1000.0 * T::UNIT * n as f64
}

/// Largest error of a normal form, in errors of its factor.
const MAX_FORM_ERROR: f64 = 64.0;

/// The most corrections: more of them gain less than rounding takes.
const CORRECTIONS: usize = 24;

/// Terms of an exponential series: e^x of |x| ≤ 4 to 2^-300.
const EXPONENTIAL: u32 = 110;

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Elliptic,
    Hyperbolic,
}

pub struct Normal<T> {
    kind: Kind,
    /// W.
    rows: Branch<T>,
    /// W⁻¹.
    columns: Branch<T>,
    /// Q.
    sum: Branch<T>,
    /// |R W⁻¹|/|e^L| at most.
    error: f64,
    /// A factor is 2^exponent times what has been brought to normal form.
    exponent: i128,
    /// Hyperbolic, and both multipliers are negative.
    is_negative: bool,
    /// The turns of a factor beside e^L: whole turns, elliptic; half turns, hyperbolic.
    turns: Option<i128>,
    stride: i128,
}

/// The entries of a function, without its power of two, as series.
fn series<T: Coefficient>(map: &Map<T>) -> [Series<T>; 4] {
    std::array::from_fn(|k| Series::real(map.terms().iter().map(|term| term[k])))
}

/// (a − d)/2 and its square + b c, a quarter of the discriminant.
fn discriminant<T: Coefficient>([a, b, c, d]: &[Series<T>; 4]) -> [Series<T>; 2] {
    let half = a.minus(d).scale2(-1);
    let square = half.times(&half).plus(&b.times(c));
    [half, square]
}

/// Whether the multipliers stay so far apart that a normal form can be found.
pub fn is_apart<T: Coefficient>(map: &Map<T>) -> bool {
    let [_, square] = discriminant(&series(map));
    // √ of it converges in all its terms.
    square.first().norm() > 4.0 * square.variation()
}

/// z with (1, z(t + τ)) A(t) = μ(t) (1, z(t)), near the root of that sign; det A = 2^-2e.
fn row<T: Coefficient>(
    entries: &[Series<T>; 4],
    exponent: i128,
    tau: &T,
    positive: bool,
) -> Option<Series<T>> {
    let [a, b, c, d] = entries;
    let [half, square] = discriminant(entries);
    let root = square.root()?;
    let root = if positive { root } else { root.negative() };
    let mut z = root.minus(&half).over(c)?;
    let determinant = (-2 * exponent).clamp(-2000, 2000) as i32;
    let mut last = f64::INFINITY;
    for _ in 0..CORRECTIONS {
        let next = z.shifted(tau);
        let multiplier = a.plus(&c.times(&next));
        let inverse = Series::constant(1.0).over(&multiplier)?;
        let rest = z.minus(&b.plus(&d.times(&next)).times(&inverse));
        let passed = inverse.times(&inverse).scale2(determinant);
        let correction = rest.over(&Series::constant(1.0).minus(&passed))?;
        let size = correction.size();
        if size.is_nan() || size > 0.7 * last {
            break;
        }
        z = z.minus(&correction);
        last = size;
        if size < T::UNIT * z.size() {
            break;
        }
    }
    Some(z)
}

/// (1, z) A's first entry: the multiplier.
fn multiplier<T: Coefficient>([a, _, c, _]: &[Series<T>; 4], z: &Series<T>, tau: &T) -> Series<T> {
    a.plus(&c.times(&z.shifted(tau)))
}

/// Rows and multipliers' logarithms, guessed.
struct Guess<T> {
    kind: Kind,
    rows: [Series<T>; 4],
    /// Both, or real and imaginary part.
    logarithms: [Series<T>; 2],
    is_negative: bool,
}

fn part<T: Coefficient>(series: &Series<T>, imaginary: bool) -> Series<T> {
    Series::real((0..series.0.len()).map(|i| if imaginary { series.im(i) } else { series.re(i) }))
}

fn elliptic<T: Coefficient>(entries: &[Series<T>; 4], exponent: i128, tau: &T) -> Option<Guess<T>> {
    // Im z > 0: W keeps the orientation, and the direction of (1, 0).
    let z = row(entries, exponent, tau, entries[2].first().re > 0.0)?;
    let logarithm = multiplier(entries, &z, tau).logarithm()?;
    let rows = [Series::constant(1.0), part(&z, false), Series::constant(0.0), part(&z, true)];
    let logarithms = [part(&logarithm, false), part(&logarithm, true)];
    Some(Guess { kind: Kind::Elliptic, rows, logarithms, is_negative: false })
}

/// The direction between both left eigenvectors, from which neither is at a right angle.
fn between([a, b, c, d]: [f64; 4]) -> [f64; 2] {
    let (half, mean) = (0.5 * (a - d), 0.5 * (a + d));
    let root = (half * half + b * c).max(0.0).sqrt();
    let eigenvector = |mu: f64| {
        let ([x, y], [u, v]) = ([c, mu - a], [mu - d, b]);
        let [x, y] = if x.hypot(y) > u.hypot(v) { [x, y] } else { [u, v] };
        let size = x.hypot(y);
        [x / size, y / size]
    };
    let ([x, y], [u, v]) = (eigenvector(mean + root), eigenvector(mean - root));
    let [x, y] = if x * u + y * v > 0.0 { [x + u, y + v] } else { [x - u, y - v] };
    let size = x.hypot(y);
    [x / size, y / size]
}

fn hyperbolic<T: Coefficient>(entries: &[Series<T>; 4], exponent: i128, tau: &T) -> Option<Guess<T>> {
    let [cos, sin] = between(entries.each_ref().map(|x| x.first().re));
    if !(cos.is_finite() && sin.is_finite()) {
        return None;
    }
    let [cos, sin] = [cos, sin].map(|x| Series::constant(x));
    // G A G^-1, G = [[cos, sin], [-sin, cos]].
    let square = cos.times(&cos).plus(&sin.times(&sin));
    let [a, b, c, d] = entries;
    let mixed =
        |x: &Series<T>, y: &Series<T>| [cos.times(x).plus(&sin.times(y)), cos.times(y).minus(&sin.times(x))];
    let ([top_a, low_a], [top_b, low_b]) = (mixed(a, c), mixed(b, d));
    let ([a, b], [c, d]) = (mixed(&top_a, &top_b), mixed(&low_a, &low_b));
    let turned = [a.over(&square)?, b.over(&square)?, c.over(&square)?, d.over(&square)?];
    let positive = turned[0].first().re + turned[3].first().re > 0.0;
    let large = row(&turned, exponent, tau, positive)?;
    // The smaller one is the inverse's larger one, backwards: w(x - d) adj A(x - d) = mu w(x).
    let back = tau.negative();
    let [a, b, c, d] = turned.each_ref().map(|x| x.shifted(&back));
    let adjugate = [d, b.negative(), c.negative(), a];
    let small = row(&adjugate, exponent, &back, positive)?;
    let signed = |x: Series<T>| if positive { x } else { x.negative() };
    let first = signed(multiplier(&turned, &large, tau)).logarithm()?;
    let second = signed(multiplier(&adjugate, &small, &back).shifted(tau)).logarithm()?;
    // det = 2^-2e.
    let ln = Ball::ln2(T::BITS).mul(&Ball::from_integer(&(-2 * exponent).into()), T::BITS);
    let second = Series::real(std::iter::once(T::of_ball(&ln))).minus(&second);
    let rows = |z: &Series<T>| [cos.minus(&sin.times(z)), sin.plus(&cos.times(z))];
    let ([a, b], [c, d]) = (rows(&large), rows(&small));
    // W keeps the orientation, and (1, 0) on its side where it can.
    let flipped = |x: [Series<T>; 2], flip: bool| if flip { x.map(|x| x.negative()) } else { x };
    let [p, q, r, s] = [&a, &b, &c, &d].map(|x| x.first().re);
    let ([a, b], [c, d]) = (flipped([a, b], p < 0.0), flipped([c, d], (p * s - q * r < 0.0) != (p < 0.0)));
    let logarithms = [part(&first, false), part(&second, false)];
    Some(Guess { kind: Kind::Hyperbolic, rows: [a, b, c, d], logarithms, is_negative: !positive })
}

/// Real parts as a map's terms.
fn map<T: Coefficient>(entries: &[Series<T>; 4]) -> Map<T> {
    let length = entries.iter().map(|x| x.0.len()).max().unwrap_or(1);
    Map::of((0..length).map(|i| entries.each_ref().map(|x| x.re(i))).collect())
}

impl Kind {
    /// [[a, −b], [b, a]] or [[a, 0], [0, b]].
    fn entries<X: Clone>(self, [a, b]: [X; 2], zero: X, negative: impl Fn(&X) -> X) -> [X; 4] {
        match self {
            Kind::Elliptic => [a.clone(), negative(&b), b, a],
            Kind::Hyperbolic => [a, zero.clone(), zero, b],
        }
    }

    fn numbers<X: Clone>(self, [a, _, c, d]: &Entries<X>) -> [X; 2] {
        match self {
            Kind::Elliptic => [a.clone(), c.clone()],
            Kind::Hyperbolic => [a.clone(), d.clone()],
        }
    }

    /// The turn of e^S, with so many whole turns, elliptic, or half turns, hyperbolic, beside it.
    fn turn(self, angle: &Ball, turns: i128) -> Option<Turn> {
        match self {
            Kind::Elliptic => {
                let bits = 256;
                let whole = angle.div(&Ball::pi(bits).scale2(1), bits)?;
                let whole = whole.lower().round().to_integer().to_i128()?;
                let ball = Ball::pi(bits).scale2(1).mul(&Ball::from_integer(&whole.into()), bits);
                let rest = angle.sub(&ball, bits).to_f64_enclosure().0;
                Some(Turn { whole: whole + turns, angle: rest })
            }
            Kind::Hyperbolic => {
                let angle = if turns % 2 == 0 { 0.0 } else { PI };
                Some(Turn { whole: turns.div_euclid(2), angle })
            }
        }
    }

    /// e^S, for S known up to `error`.
    fn exponential<T: Coefficient>(self, exponent: &Map<T>) -> Option<Map<T>> {
        let (error, scale) = (exponent.error(), i64::try_from(exponent.exponent).ok()?);
        let bits = T::BITS + 80;
        let [a, b] = self.numbers(&exponent.terms()[0]).map(|x| x.ball().scale2(scale));
        let log2 = a.div(&Ball::ln2(bits), bits)?.lower().round().to_integer();
        let ln2 = Ball::ln2(bits);
        let without = |x: &Ball| x.sub(&ln2.mul(&Ball::from_integer(&log2), bits), bits);
        let exp = |x: &Ball| x.exp(bits);
        let first = match self {
            Kind::Elliptic => {
                let modulus = exp(&without(&a));
                [modulus.mul(&b.cos(bits), bits), modulus.mul(&b.sin(bits), bits)]
            }
            Kind::Hyperbolic => [exp(&without(&a)), exp(&without(&b))],
        };
        let mut first = Map::of_balls(&[self.entries(first, Ball::zero(), Ball::neg)]);
        first.exponent = first.exponent.checked_add(log2.to_i128()?)?;
        // e^R, R = S without its constant term: a small part of a long sum, so it is scaled
        // apart from S.
        let scale = i32::try_from(scale).ok()?;
        let mut terms = exponent.terms().to_vec();
        terms[0] = std::array::from_fn(|_| T::zero());
        terms.iter_mut().flatten().for_each(|x| *x = x.scale2(scale));
        let rest = Map::of(terms);
        let size = rest.size();
        if size.is_nan() || size > 4.0 || error > 1.0 {
            return None;
        }
        let one = Map::identity();
        let (mut series, mut left, mut count) = (one.clone(), size, 1);
        while left > 0.01 * T::UNIT && count < EXPONENTIAL {
            count += 1;
            left *= size / f64::from(count);
        }
        // The terms from count on are less than size^count/count! e^size.
        if size > 0.0 {
            for k in (1..count).rev() {
                let over = Ball::from_rational(&Rational::new(1.into(), k.into()), T::BITS);
                let part = Map::of_balls(&[[over.clone(), Ball::zero(), Ball::zero(), over]]);
                series = one.plus(&part.after(&rest.after(&series)));
            }
        }
        let lost = left * size.exp() + error.exp_m1() * 1.01;
        Some(series.after(&first).widened(if size > 0.0 { lost } else { error.exp_m1() * 1.01 }).trimmed())
    }
}

/// The inverse of a matrix function: the adjugate over the determinant, V. With V W = 1 + R, W⁻¹ = (1 + R)⁻¹
/// V.
fn inverse<T: Coefficient>(given: &Map<T>) -> Option<Map<T>> {
    let [a, b, c, d] = series(given);
    let determinant = a.times(&d).minus(&b.times(&c));
    let entries = [&d, &b.negative(), &c.negative(), &a].map(|x| x.over(&determinant));
    let [Some(a), Some(b), Some(c), Some(d)] = entries else { return None };
    let mut inverse = map(&[a, b, c, d]);
    inverse.exponent = given.exponent.saturating_neg();
    let rest = inverse.after(given).plus(&Map::identity().negative()).size();
    (rest < 0.1).then(|| inverse.widened(rest / (1.0 - rest) * (1.0 + 1e-12)))
}

/// Both, with turns that undo each other: they keep the orientation, and no direction turns by a half turn.
pub fn inverses<T: Coefficient>(given: Map<T>) -> Option<(Map<T>, Map<T>)> {
    let back = inverse(&given)?;
    let turned = |mut map: Map<T>| {
        map.turn = map.direction().map(|angle| Turn { whole: 0, angle });
        map
    };
    Some((turned(given), turned(back)))
}

impl<T: Coefficient> Normal<T> {
    /// `None` where none is found that is near enough.
    pub fn new(piece: &Branch<T>, steps: u128, allowed: f64) -> Option<Self> {
        let Branch { start, length, stride, .. } = *piece;
        let mut factor = piece.map.clone();
        let factor_error = factor.relative_error();
        let exponent = std::mem::take(&mut factor.exponent);
        let entries = series(&factor);
        let tau = T::quotient(2 * stride, length as u128);
        let [_, square] = discriminant(&entries);
        let guess = if square.first().re < 0.0 { elliptic } else { hyperbolic };
        let Guess { kind, rows, logarithms, is_negative } = guess(&entries, exponent, &tau)?;
        let [large, small] = &logarithms;
        let (first, varied) = (large.first().re, large.variation());
        let apart = first - small.first().re > varied + small.variation();
        if kind == Kind::Hyperbolic && !apart {
            return None;
        }
        let on = |map: Map<T>| Branch { map, start, length, stride: 0, height: 0 };
        let (rows, columns) = inverses(map(&rows))?;
        let (rows, columns) = (on(rows), on(columns));
        let logarithm = map(&kind.entries(logarithms.clone(), Series::constant(0.0), Series::negative));
        let multiplier = on(kind.exponential(&logarithm)?);
        let signed = if is_negative { factor.clone().negative() } else { factor };
        // Where a factor's both ends lie on the piece.
        let (from, long) = (start + (-stride).max(0), length - stride.abs());
        let moved = rows.on(from + stride, long).after(&on(signed).on(from, long));
        let kept = multiplier.on(from, long).after(&rows.on(from, long));
        let rest = moved.plus(&kept.negative()).size();
        let error = rest * columns.map.size() * (varied - first).exp() * (1.0 + 1e-9);
        let lost = error * steps as f64;
        // Shorter pieces do not know their factors better.
        let known = MAX_FORM_ERROR * factor_error * steps as f64;
        if lost.is_nan() || lost > allowed.max(roundings::<T>(steps)).max(known) {
            return None;
        }
        let sum = on(summed(kind, &logarithms, stride, length)?);
        let mut normal =
            Normal { kind, rows, columns, sum, error, exponent, is_negative, turns: None, stride };
        let angle = logarithms[1].first().re;
        normal.turns = normal.own_turns(&piece.map, &multiplier.map, angle, &tau);
        Some(normal)
    }

    /// The coordinates W at places of the piece.
    pub fn enter(&self, start: i128, length: i128) -> Map<T> {
        self.rows.on(start, length)
    }

    /// W⁻¹.
    pub fn leave(&self, start: i128, length: i128) -> Map<T> {
        self.columns.on(start, length)
    }

    /// W P_n W⁻¹ from start..start + length, or a point, as long as all of it lies on the piece.
    pub fn product(&self, n: u128, start: i128, length: i128) -> Option<Map<T>> {
        let end = start + self.stride * n as i128;
        let sum = self.sum.on(end, length).plus(&self.sum.on(start, length).negative());
        let error = (self.error * n as f64).exp_m1() * (1.0 + 1e-9);
        let mut product = self.kind.exponential(&sum)?.widened(error);
        product.exponent = product.exponent.checked_add(self.exponent.checked_mul(n.try_into().ok()?)?)?;
        product.turn = self.turns.and_then(|turns| {
            let turns = turns.checked_mul(n.try_into().ok()?)?;
            let ball = self.kind.numbers(&sum.terms()[0])[1].ball().scale2(sum.exponent.try_into().ok()?);
            self.kind.turn(&ball, turns)
        });
        Some(if self.is_negative && n % 2 == 1 { product.negative() } else { product })
    }

    /// The whole turns of one factor beside e^L, elliptic, or its half turns, hyperbolic: what the turn of
    /// the one in the middle is.
    fn own_turns(&self, factor: &Map<T>, multiplier: &Map<T>, angle: f64, tau: &T) -> Option<i128> {
        let half_turns = i128::from(self.is_negative);
        let mut product = multiplier.at(&T::zero());
        product.turn = self.kind.turn(&super::super::coefficient::exact(angle), half_turns);
        if self.is_negative {
            product = product.negative();
        }
        let [rows, columns] = [self.rows.map.at(&T::zero()), self.columns.map.at(tau)];
        let whole = factor.turn?.whole - columns.after(&product.after(&rows)).turn?.whole;
        Some(match self.kind {
            Kind::Elliptic => whole,
            Kind::Hyperbolic => 2 * whole + half_turns,
        })
    }
}

/// Q with Q(t + τ) − Q(t) = L(t), τ = 2 d/length, from the last coefficient to the first.
fn summed<T: Coefficient>(
    kind: Kind,
    logarithms: &[Series<T>; 2],
    stride: i128,
    length: i128,
) -> Option<Map<T>> {
    let bits = T::BITS + 64;
    let tau = Ball::from_rational(&Rational::new(stride.into(), length.into()), bits).scale2(1);
    let terms = logarithms.iter().map(|x| x.0.len()).max().unwrap_or(1);
    debug_assert!(terms <= MOST);
    let mut powers = vec![Ball::one()];
    for i in 0..terms {
        powers.push(powers[i].mul(&tau, bits));
    }
    let solved = |series: &Series<T>| {
        let mut sum = vec![Ball::zero(); terms + 1];
        for m in (0..terms).rev() {
            let mut rest = series.re(m).ball();
            // j over m: below 2^MOST.
            let mut binomial = m as u128 + 1;
            for j in m + 2..=terms {
                binomial = binomial * j as u128 / (j - m) as u128;
                let lost = powers[j - m].mul(&sum[j], bits).mul(&Ball::from_integer(&binomial.into()), bits);
                rest = rest.sub(&lost, bits);
            }
            let divisor = tau.mul(&Ball::from_integer(&(m as u64 + 1).into()), bits);
            sum[m + 1] = rest.div(&divisor, bits)?;
        }
        Some(sum)
    };
    let [first, second] = logarithms.each_ref().map(solved);
    let pairs = first?.into_iter().zip(second?);
    let terms: Vec<_> = pairs.map(|(a, b)| kind.entries([a, b], Ball::zero(), Ball::neg)).collect();
    Some(Map::of_balls(&terms))
}
