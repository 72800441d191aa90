//! Coordinates in which both branches of a level have small norms.
//!
//! Errors grow by the norms of what they pass through. Where orbits stay bounded there are coordinates in
//! which all products turn, and have norm 1; the deeper the level, the less these coordinates vary along its
//! intervals. So each level takes those that suit its branches' middles: the point of the hyperbolic plane of
//! metrics which both move least.
//!
//! With F = α + [[β, γ + δ], [γ − δ, −β]] the squares of F's entries sum to 2 (2 α² + 2 δ² − det F), and
//! coordinates exp X/2, X = [[u, v], [v, −u]], change δ into δ + γ u − β v + δ (u² + v²)/2 up to the second
//! order. Steps of Newton's method make Σ δ² least. No bound rests on how well they do: the coordinates are
//! two shears, whose inverse is exact.

use super::coefficient::Coefficient;
use super::map::{Entries, Map};
use super::turn::Turn;

/// Steps of Newton's method.
const STEPS: usize = 12;

/// Coordinates nearer to the present ones than this are not worth a change.
const LEAST_MOVE: f64 = 0.05;

/// Coordinates farther from the present ones than this are not gone to at once: doubles would lose digits.
const FAR: f64 = 6.0;

/// [[a, b], [c, d]] in doubles.
type Real = [f64; 4];

fn product([a, b, c, d]: Real, [e, f, g, h]: Real) -> Real {
    [a * e + b * g, a * f + b * h, c * e + d * g, c * f + d * h]
}

/// The middle of a branch with determinant 1; `None` where doubles do not hold it.
fn middle<T: Coefficient>(map: &Map<T>) -> Option<Real> {
    let [a, b, c, d] = map.terms()[0].each_ref().map(T::near);
    // Doubles cannot resolve the determinant of a long hyperbolic product: its norm stands for it.
    let determinant = (a * d - b * c).max(1e-12 * (a * a + b * b + c * c + d * d));
    let unit = determinant.sqrt().recip();
    unit.is_finite().then_some([a, b, c, d].map(|x| x * unit))
}

/// One step: exp X/2; `None` where it is too short.
fn step(both: &[Real; 2]) -> Option<Real> {
    let (mut rest, mut square) = ([0.0; 2], [0.0; 3]);
    for [a, b, c, d] in both {
        let (beta, gamma, delta) = (0.5 * (a - d), 0.5 * (b + c), 0.5 * (b - c));
        rest = [rest[0] - delta * gamma, rest[1] + delta * beta];
        let value = delta * delta;
        square =
            [square[0] + gamma * gamma + value, square[1] - beta * gamma, square[2] + beta * beta + value];
    }
    let [xx, xy, yy] = square;
    let determinant = xx * yy - xy * xy;
    let [u, v] = [(yy * rest[0] - xy * rest[1]) / determinant, (xx * rest[1] - xy * rest[0]) / determinant];
    let length = (u * u + v * v).sqrt();
    let far = length.min(1.0) / length;
    let (u, v, length) = (u * far, v * far, length.min(1.0));
    (length > 0.1 * LEAST_MOVE).then(|| {
        // sinh(length/2)/length within a percent; the determinant is 1 whatever it is.
        let sinh = 0.5 + length * length / 48.0;
        let cosh = (1.0 + sinh * sinh * length * length).sqrt();
        [cosh + sinh * u, sinh * v, sinh * v, cosh - sinh * u]
    })
}

/// Coordinates G = exp … exp in which both are small.
fn metric(mut both: [Real; 2]) -> Real {
    let mut all = [1.0, 0.0, 0.0, 1.0];
    for _ in 0..STEPS {
        let Some(next) = step(&both) else { break };
        let further = product(next, all);
        if further.iter().map(|x| x * x).sum::<f64>() > 2.0 * FAR.cosh() {
            break;
        }
        let [a, b, c, d] = next;
        let back = [d, -b, -c, a];
        both = both.map(|both| product(product(next, both), back));
        all = further;
    }
    all
}

/// Coordinates that suit both functions, and the way back; `None` where the present ones do.
pub fn coordinates<T: Coefficient>(left: &Map<T>, right: &Map<T>) -> Option<(Map<T>, Map<T>)> {
    let [a, b, c, d] = metric([middle(left)?, middle(right)?]);
    // The metric GᵀG = [[p, q], [q, r]], p r − q² = 1.
    let (p, q, r) = (a * a + c * c, a * b + c * d, b * b + d * d);
    // cosh of the distance from the present one.
    let far = 0.5 * (p + r);
    if !(1.0 + 0.5 * LEAST_MOVE * LEAST_MOVE..FAR.cosh()).contains(&far) {
        return None;
    }
    // [[1, x], [0, 1]] [[1, 0], [y, 1]] has r = x² + 1, q = x (1 + x y) + y; the other order has p = y² + 1.
    let of = |r: f64| {
        let x = (r - 1.0).max(0.0).sqrt();
        (x, (q - x) / r)
    };
    let upper_last = r >= p;
    let (x, y) = if upper_last { of(r) } else { of(p) };
    let (one, x, y) = (T::of(1.0), T::of(x), T::of(y));
    let corner = one.plus(&x.times(&y));
    let (there, back): (Entries<T>, Entries<T>) = if upper_last {
        ([corner, x, y, one], [one, x.negative(), y.negative(), corner])
    } else {
        ([one, y, x, corner], [corner, y.negative(), x.negative(), one])
    };
    // One product and one sum.
    let rounding = 2.0 * T::UNIT * (1.0 + 2.0 * (x.near() * y.near()).abs());
    Some((shears(there, rounding), shears(back, rounding)))
}

/// Two shears of (1, 0), the first of which keeps or moves it by less than a right angle, and the second by
/// less than to the opposite.
fn shears<T: Coefficient>(entries: Entries<T>, rounding: f64) -> Map<T> {
    let mut map = Map::of(vec![entries]).known_within(rounding);
    map.turn = map.direction().map(|angle| Turn { whole: 0, angle });
    map
}
