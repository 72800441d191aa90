//! The product of some equidistant parts of one function, in one go: no bound and no list for each of them.
//!
//! On a part t = α + β t', |α| + |β| ≤ 1, the coefficients of M are at most f_0 = |M| and f_j = |β|^j Σ_k
//! C(k, j) |M_k| in norm, whatever α is. So the product of q parts, Σ P_j t'^j, has the majorant f^q, and
//! with v = f_0 + what parts lack:
//!
//! * *terms left out.* A degree once passed is not lost again, so all that is left out of the products beyond
//!   the coefficient c is at most Σ_{j ≥ c} [t^j] f^q ≤ f(R)^q R^{−c}, for each R ≥ 1.
//! * *rounding.* The i-th product's is at most 2 u g^i (4 + 2 i f'(1)/g), g = f(1) (see [`map`](super::map)),
//!   and what follows it takes it v^{q − i} times.
//!
//! Where g is much more than f_0, this would lose digits: then there is no such row.

use super::coefficient::Coefficient;
use super::lanes::Lanes;
use super::map::{FEW, MOST, Map, UP, image, sizes};
use super::turn::{Turn, direction};
use number::vector::instructions::{Instructions, Task};

/// So many parts at most.
pub const LONGEST: usize = 8;

/// Room for the terms of most functions of doubles.
const SHORT: usize = 8;

/// The largest (g/f_0)^q.
const GROWTH: f64 = 4.0;

/// The part at `places[0]` first; `None` where the bounds would lose digits.
pub fn product<T: Coefficient>(whole: &Map<T>, places: &[T], beta: &T) -> Option<Map<T>> {
    let row = Row { whole, places, beta: *beta };
    Instructions::best().perform_alone(row).filter(Map::is_useful)
}

struct Row<'a, T> {
    whole: &'a Map<T>,
    /// The α.
    places: &'a [T],
    beta: T,
}

/// Everything known before any product is made.
struct Plan {
    /// f_j, as far as parts have terms.
    majorant: [f64; MOST],
    /// Terms of parts, and of products.
    terms: [usize; 2],
    /// A bound of everything that the computed part lacks.
    lacks: f64,
    /// v.
    value: f64,
    /// The terms left out of i products together, over v^i.
    left_out: f64,
}

/// A whole number at least log₂ x.
#[inline(always)]
fn log2_above(x: f64) -> i32 {
    (x.to_bits() >> 52 & 0x7ff) as i32 - 1022
}

impl<T: Coefficient> Row<'_, T> {
    #[inline(always)]
    fn plan(&self) -> Option<Plan> {
        let (n, q) = (self.whole.terms().len(), self.places.len() as u32);
        // Σ C(k, j) |M_k|: the coefficients about t = 1 of Σ |M_k| t^k.
        let mut majorant: [f64; MOST] = sizes(self.whole.terms());
        for i in 0..n {
            for j in (i..n - 1).rev() {
                majorant[j] += majorant[j + 1];
            }
        }
        let rounding = 1.42 * T::UNIT * 6.0 * (majorant[0] + if n > 1 { majorant[1] } else { 0.0 });
        majorant[0] = (self.whole.norm() + rounding) * UP;
        let (beta, mut power) = (self.beta.near().abs(), 1.0);
        for own in &mut majorant[1..n] {
            power *= beta;
            *own *= power * UP;
        }
        let least = self.whole.least;
        let (mut terms, mut tail) = (n, 0.0);
        while terms > 1 && f64::from(q) * (tail + majorant[terms - 1]) <= least * majorant[0] {
            terms -= 1;
            tail += majorant[terms];
            majorant[terms] = 0.0;
        }
        let value = (majorant[0] + tail) * UP;
        // f(R)^q/f_0^q.
        let ratio = |radius: f64| {
            let mut sum = 0.0;
            for value in majorant[..terms].iter().rev() {
                sum = sum * radius + value;
            }
            let (ratio, mut power) = (sum * UP / majorant[0], 1.0);
            for _ in 0..q {
                power *= ratio;
            }
            power
        };
        let growth = ratio(1.0);
        if growth.is_nan() || growth > GROWTH {
            return None;
        }
        let (mut kept, mut left_out) = ((terms - 1) * self.places.len() + 1, 0.0);
        if kept > 2 {
            // Near where the bound is least, f(R) = e f_0, about.
            let log2 = log2_above(majorant[0] / majorant[1]).clamp(1, 12);
            let radius = f64::from(1 << log2);
            let ratio = ratio(radius);
            let needed = (log2_above(ratio) + 2 - log2_above(least)).max(log2) / log2 + 1;
            if (needed as usize) < kept {
                (kept, left_out) = (needed as usize, ratio * radius.powi(-needed) * UP);
            }
        }
        if kept > T::TERMS {
            return None;
        }
        let lacks = (self.whole.bound() + rounding + tail) * UP;
        Some(Plan { majorant, terms: [terms, kept], lacks, value, left_out })
    }

    #[inline(always)]
    fn with_room<const N: usize>(&self, plan: &Plan) -> Map<T> {
        let &Plan { ref majorant, terms: [m, kept], lacks, value, left_out } = plan;
        let (mut g, mut slope) = (0.0, 0.0);
        for (own, j) in majorant[..m].iter().zip(0u32..) {
            (g, slope) = (g + own, slope + f64::from(j) * own);
        }
        let of = T::Lanes::of;
        let n = self.whole.terms().len();
        let zero = T::Lanes::splat(&T::zero());
        let (mut own, mut scales) = ([zero; N], [zero; N]);
        for (own, term) in own.iter_mut().zip(self.whole.terms()) {
            *own = of(term.each_ref());
        }
        let mut power = T::of(1.0);
        for scale in &mut scales[..m] {
            *scale = T::Lanes::splat(&power);
            power = power.times(&self.beta);
        }
        let [nothing, one] = [0.0, 1.0].map(T::of);
        let mut product = [[nothing; 4]; N];
        product[0] = [one, nothing, nothing, one];
        let (mut length, mut error) = (1, 0.0);
        // v^i and g^i.
        let (mut values, mut sums) = (1.0, 1.0);
        let mut turn = self.whole.turn.map(|_| Turn::NONE);
        let mut columns = [[zero; 2]; N];
        for (alpha, i) in self.places.iter().zip(1u32..) {
            let mut part = own;
            let by = T::Lanes::splat(alpha);
            // A row of eight is followed to its end, zeros too: no loop's length has to be foreseen.
            let end = if N == SHORT { N } else { n };
            for k in 0..m {
                for j in (k..end - 1).rev() {
                    part[j] = part[j].plus_times(&by, &part[j + 1]);
                }
                part[k] = part[k].times(&scales[k]);
            }
            // The rows of the later matrices meet the columns of the earlier ones.
            for (column, [e, f, g, h]) in columns[..length].iter_mut().zip(&product) {
                *column = [of([e, f, e, f]), of([g, h, g, h])];
            }
            let known = length;
            length = (known + m - 1).min(kept);
            let mut next = [zero; N];
            for (k, later) in part[..m].iter().enumerate() {
                let [a, b, c, d] = later.entries();
                let (first, second) = (of([&a, &a, &c, &c]), of([&b, &b, &d, &d]));
                for (sum, [upper, lower]) in next[k.min(length)..length].iter_mut().zip(&columns[..known]) {
                    *sum = sum.plus_times(&first, upper).plus_times(&second, lower);
                }
            }
            for (numbers, next) in product[..length].iter_mut().zip(&next) {
                *numbers = next.entries();
            }
            sums *= g;
            let rounding = 2.0 * T::UNIT * sums * (4.0 + 2.0 * f64::from(i) * slope / g);
            let size = values * (1.0 + left_out) + error;
            error = ((value + self.whole.bound()) * error + lacks * size + rounding) * UP;
            values *= value * UP;
            turn = turn.and_then(|turn| {
                let towards = direction(image(&part[0].entries()), lacks)?;
                let later = self.whole.turn_moved(alpha.near(), Some(towards))?;
                turn.then(later, direction(image(&product[0]), (error + left_out * values) * UP)?)
            });
        }
        error = (error + left_out * values) * UP;
        let known = (values + error) * UP;
        let exponent = self.whole.exponent.saturating_mul(self.places.len() as i128);
        let mut product = Map::bounded(product[..length].to_vec(), error, known, exponent);
        (product.turn, product.least) = (turn, self.whole.least);
        product
    }
}

impl<T: Coefficient> Task for Row<'_, T> {
    type Output = Option<Map<T>>;

    #[inline(always)]
    fn run(self) -> Option<Map<T>> {
        let plan = self.plan()?;
        // Small cases stay in registers, or near them.
        Some(match plan.terms[1].max(self.whole.terms().len()) {
            n if n <= SHORT => self.with_room::<SHORT>(&plan),
            n if n <= FEW => self.with_room::<FEW>(&plan),
            _ => self.with_room::<MOST>(&plan),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::Twofold;

    /// The value at t, without the power of two.
    fn value<T: Coefficient>(map: &Map<T>, t: f64) -> [f64; 4] {
        let at = map.at(&T::of(t));
        let unit = 2f64.powi(at.exponent as i32);
        at.terms()[0].each_ref().map(|x| x.near() * unit)
    }

    #[test]
    fn rows_are_what_single_products_are() {
        let mut state = 1u64;
        let mut random = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let (mut rows, mut cut) = (0, 0);
        for case in 0..600 {
            let (q, n, least) = (2 + case % 7, 1 + case % 9, [0.0, 1e-14, 1e-8][case % 3]);
            let change = [0.02, 0.1, 0.4][case / 3 % 3];
            let (sin, cos) = (3.0 * random()).sin_cos();
            let mut size = 1.0;
            let mut terms = vec![[cos, sin, -sin, cos]];
            for j in 1..n {
                size *= change / j as f64;
                terms.push(std::array::from_fn(|_| size * random()));
            }
            let mut whole = Map::<f64>::of(terms.clone());
            whole.least = whole.least.max(least);
            let exact = Map::<Twofold>::of(terms.iter().map(|term| term.map(<Twofold>::of)).collect());
            let (beta, first) = (0.1 * random().abs(), -0.9 + 0.1 * random());
            let places: Vec<f64> = (0..q).map(|i| first + 0.2 * i as f64).collect();
            let Some(row) = product(&whole, &places, &beta) else { continue };
            rows += 1;
            cut += usize::from(row.terms().len() < (n - 1) * q + 1);
            let parts = places.iter().map(|&alpha| exact.part(&<Twofold>::of(alpha), &<Twofold>::of(beta)));
            let single = parts.reduce(|earlier, later| later.after(&earlier)).unwrap();
            // Some 8 roundings of 2 u 4 (4 + 16/5) and as much again of parts, and what is left out on
            // purpose, each times what the other factors make of it.
            let most = (3e-13 + 100.0 * whole.least) * whole.norm().powi(q as i32);
            assert!(row.error() < most, "{case}: {} {most}", row.error());
            for t in [-1.0, -0.4, 0.0, 0.7, 1.0] {
                let (one, other) = (value(&row, t), value(&single, t));
                let apart = one.iter().zip(other).map(|(x, y)| (x - y).powi(2)).sum::<f64>().sqrt();
                // In the norm of Frobenius; reading two doubles as one adds some units.
                assert!(
                    apart <= 1.5 * (row.bound() + single.bound()) + 1e-15,
                    "{case}, {t}: {apart} {}",
                    row.bound()
                );
            }
        }
        assert!(rows > 400 && cut > 200, "{rows} rows, {cut} of them cut");
    }
}
