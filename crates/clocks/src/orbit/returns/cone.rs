//! Growth that shows before the walk's end: both branches of a level take one cone into itself.
//!
//! A period visits each place of a level once: it is a product of a values of the left branch and b of the
//! right one, a and b their lengths. Where each value, in the basis of two vectors, has four positive
//! entries, or four negative ones, all along its branch, so has the product, and Tr Q > 2 or Tr Q < −2, as
//! the branches' signs and a and b say (proofs/RETURNS.md, "Early ends").

use std::f64::consts::PI;

use super::branch::Branch;
use super::coefficient::Coefficient;
use super::map::{Map, UP, about};
use number::Sign;

/// More than all that some dozens of roundings of entries do, over the sum of all norms.
const ROUNDING: f64 = 1e-13;

/// The sign of Tr Q, which is beyond ±2; `None` says nothing.
pub fn trace_sign<T: Coefficient>(left: &Branch<T>, right: &Branch<T>) -> Option<Sign> {
    let basis = common([axes(&left.map)?, axes(&right.map)?])?;
    let [one, other] =
        [left, right].map(|branch| sign_on(&branch.map, basis).map(|sign| (sign, branch.length)));
    let odd =
        [one?, other?].iter().filter(|(sign, length)| *sign == Sign::Negative && length % 2 == 1).count();
    Some(if odd == 1 { Sign::Negative } else { Sign::Positive })
}

/// The axes of the middle that attracts and that repels, as angles in 0..π, about; `None` where directions
/// turn, or do hardly anything else.
fn axes<T: Coefficient>(map: &Map<T>) -> Option<[f64; 2]> {
    let [a, b, c, d] = map.terms()[0].each_ref().map(T::near);
    let (half, mean) = (0.5 * (a - d), 0.5 * (a + d));
    let square = half * half + b * c;
    // Not of numbers, where the test of the entries is to fail.
    (square > 1e-6 * (half * half + mean * mean + b * b + c * c)).then(|| {
        let root = square.sqrt().copysign(mean);
        let axis = |root: f64| {
            // (A − μ) of a vector is along the other axis: the longer column of two.
            let ([x, y], [u, v]) = ([half + root, c], [b, root - half]);
            let [x, y] = if x.abs() + y.abs() > u.abs() + v.abs() { [x, y] } else { [u, v] };
            y.atan2(x).rem_euclid(PI)
        };
        [axis(root), axis(-root)]
    })
}

/// Half way from each of the outer axes that attract to the next one that repels; `None` where one that
/// repels lies on both ways from the one that attracts to the other.
fn common([[first, zero], [second, other]]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    let [first, second, other] = [first, second, other].map(|angle| (angle - zero).rem_euclid(PI));
    let (low, high) = (first.min(second), first.max(second));
    let (from, to) = if high < other {
        (0.0, other)
    } else if low > other {
        (other, PI)
    } else {
        return None;
    };
    Some([0.5 * (from + low), 0.5 * (high + to)].map(|angle| (angle + zero).sin_cos()).map(|(y, x)| [x, y]))
}

/// The one sign of all entries of all values in the basis of two unit vectors.
fn sign_on<T: Coefficient>(map: &Map<T>, [[p, r], [q, s]]: [[f64; 2]; 2]) -> Option<Sign> {
    // adj S M S, S = [[p, q], [r, s]]; its determinant is positive.
    let determinant = p * s - q * r;
    let entries = |[a, b, c, d]: [f64; 4]| {
        let ([e, f], [g, h]) = ([a * p + b * r, a * q + b * s], [c * p + d * r, c * q + d * s]);
        [s * e - q * g, s * f - q * h, p * g - r * e, p * h - r * f]
    };
    let (mut varied, mut sum) = ([0.0; 4], 0.0);
    for term in &map.terms()[1..] {
        let size = entries(term.each_ref().map(T::near)).map(f64::abs);
        varied = std::array::from_fn(|k| varied[k] + size[k]);
        sum += about(term);
    }
    let first = &map.terms()[0];
    let slack = (2.0 * map.bound() + ROUNDING * (about(first) + sum)) * UP;
    let first = entries(first.each_ref().map(T::near));
    let sign = if first[0] > 0.0 { Sign::Positive } else { Sign::Negative };
    let all = first.iter().zip(varied).all(|(x, varied)| {
        let inward = if sign == Sign::Positive { *x } else { -x };
        inward > (varied + slack) * UP
    });
    (all && determinant > ROUNDING).then_some(sign)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn branch(terms: &[[f64; 4]], length: i128) -> Branch<f64> {
        Branch { map: Map::of(terms.to_vec()), start: 0, length, stride: 0, height: 1 }
    }

    #[test]
    fn the_sign_of_a_trace_is_that_of_the_product_of_all_places() {
        let (stretch, turned) = ([2.0, 0.1, 0.1, 0.55], [-1.9, 0.2, -0.1, -0.5]);
        for (a, b) in [(2, 1), (3, 2), (1, 1), (4, 3)] {
            let found = trace_sign(&branch(&[stretch], a), &branch(&[turned], b));
            assert_eq!(found, Some(if b % 2 == 1 { Sign::Negative } else { Sign::Positive }), "{a}, {b}");
        }
    }

    #[test]
    fn branches_that_turn_or_that_undo_each_other_say_nothing() {
        let (stretch, back, turn) = ([2.0, 0.0, 0.0, 0.5], [0.5, 0.0, 0.0, 2.0], [0.8, 0.6, -0.6, 0.8]);
        let varied = [[2.0, 0.1, 0.1, 0.55], [0.0, 0.2, 0.0, 0.0]];
        let quiet = |one: &[[f64; 4]], two: &[[f64; 4]]| trace_sign(&branch(one, 2), &branch(two, 3));
        assert_eq!(quiet(&[stretch], &[stretch]), Some(Sign::Positive));
        assert_eq!(quiet(&[stretch], &[back]), None);
        assert_eq!(quiet(&[stretch], &[turn]), None);
        // The entry beside the diagonal changes its sign along the branch in a basis next to the axes alone.
        assert_eq!(quiet(&varied[..1], &[stretch]), Some(Sign::Positive));
        let known = Map::of(vec![stretch]).known_within(1.0);
        let uncertain = Branch { map: known, ..branch(&[stretch], 2) };
        assert_eq!(trace_sign(&uncertain, &uncertain), None);
    }
}
