//! A cone of directions that two return maps take into its interior (proofs/BANDS.md, `band_growth` in
//! proofs/Returns.v).

use super::family::{Family, Matrix};
use crate::orbit::returns::UP;

/// Two unit vectors between which the directions of the cone lie.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    pub first: [f64; 2],
    pub second: [f64; 2],
}

/// The vectors (x, y) along the attracting and the repelling direction of a hyperbolic matrix of
/// determinant 1.
fn directions([a, b, c, d]: Matrix) -> Option<[[f64; 2]; 2]> {
    let trace = a + d;
    let discriminant = trace * trace - 4.0;
    if discriminant.is_nan() || discriminant <= 0.0 {
        return None;
    }
    let large = 0.5 * (trace + discriminant.sqrt().copysign(trace));
    Some([large, 1.0 / large].map(|lambda| {
        if (lambda - a).abs() > (lambda - d).abs() { [b, lambda - a] } else { [lambda - d, c] }
    }))
}

fn unit([x, y]: [f64; 2]) -> [f64; 2] {
    let length = (x * x + y * y).sqrt();
    [x / length, y / length]
}

/// Places between two directions that are tried for a boundary.
const PLACES: u32 = 8;

/// The direction between two others, less than a half turn apart, that both functions take inwards most
/// safely: `turn` is 1 where inwards is counterclockwise.
fn boundary(maps: [&Family; 2], turn: f64, v: [f64; 2], w: [f64; 2]) -> [f64; 2] {
    let (v, w) = (unit(v), unit(w));
    let unsure = maps.map(|map| map.error + map.moved() + 1e-6);
    let values = maps.map(|map| [-1.0, 0.0, 1.0].map(|t| map.at(t)));
    let (mut best, mut safest) = (v, f64::NEG_INFINITY);
    for place in 1..PLACES {
        let share = f64::from(place) / f64::from(PLACES);
        let [x, y] = unit([0, 1].map(|i| (1.0 - share) * v[i] + share * w[i]));
        let mut least = f64::INFINITY;
        for (values, unsure) in values.iter().zip(unsure) {
            for [a, b, c, d] in values {
                let moved = (x * (c * x + d * y) - y * (a * x + b * y)) * 1f64.copysign(a + d);
                least = least.min(turn * moved / unsure);
            }
        }
        if least > safest {
            (best, safest) = ([x, y], least);
        }
    }
    best
}

impl Cone {
    /// A cone that may serve both functions: between the attracting and the repelling directions of their
    /// values at the ends and in the middle of their intervals. `None` where some value is not hyperbolic, or
    /// where the directions interlace.
    pub fn candidate(maps: [&Family; 2]) -> Option<Cone> {
        let mut all = [[[0.0; 2]; 2]; 6];
        for (n, t) in [0.0, -1.0, 1.0].into_iter().enumerate() {
            for (k, map) in maps.into_iter().enumerate() {
                all[2 * n + k] = directions(map.at(t))?;
            }
        }
        // In the frame of the first attracting direction attracting lines have slopes y/x, and the others
        // x/y: the largest of these follows it first, the least one comes before it last.
        let [e, f] = unit(all[0][0]);
        let framed = |[x, y]: [f64; 2]| [e * x + f * y, e * y - f * x];
        let (mut least, mut most, mut after, mut before) = (0.0f64, 0.0f64, f64::NEG_INFINITY, f64::INFINITY);
        for [attracting, repelling] in all {
            let [x, y] = framed(attracting);
            least = least.min(y / x);
            most = most.max(y / x);
            let [x, y] = framed(repelling);
            after = after.max(x / y);
            before = before.min(x / y);
        }
        // Each is less than a half turn from the next.
        if !(1.0 - most * after > 0.0 && 1.0 - least * before > 0.0) {
            return None;
        }
        let back = |[x, y]: [f64; 2]| [e * x - f * y, f * x + e * y];
        let first = boundary(maps, 1.0, back([-before, -1.0]), back([1.0, least]));
        let second = boundary(maps, -1.0, back([1.0, most]), back([after, 1.0]));
        Some(Cone { first, second })
    }

    /// Whether the function has entries of one sign, none of them zero, in the coordinates of the cone: for
    /// all offsets and all ratios.
    pub fn serves(&self, map: &Family) -> bool {
        let ([p, r], [q, s]) = (self.first, self.second);
        let determinant = p * s - q * r;
        // Columns u, w; the inverse has rows (s, −q), (−r, p) over the determinant.
        let change = |[a, b, c, d]: Matrix| {
            let (au, aw) = (a * p + b * r, a * q + b * s);
            let (cu, cw) = (c * p + d * r, c * q + d * s);
            [s * au - q * cu, s * aw - q * cw, p * cu - r * au, p * cw - r * aw].map(|x| x / determinant)
        };
        // Norms of both changes: |P|² ≤ 2, |P⁻¹| = |P|/|det|. Entries of a matrix are at most its norm.
        let condition = 2.0 / (determinant.abs() - 1e-15).max(0.0);
        let sign = 1f64.copysign(change(map.of(0)[0])[0]);
        let mut least = [0.0; 4];
        for k in 0..3 {
            for (j, m) in map.of(k).iter().enumerate() {
                // t^j u^k is 1, in [0, 1], or in [−1, 1].
                let at_least = |x: f64| match (k, j) {
                    (0, 0) => x,
                    _ if j % 2 == 0 && k % 2 == 0 => x.min(0.0),
                    _ => -x.abs(),
                };
                least.iter_mut().zip(change(*m)).for_each(|(least, x)| *least += at_least(sign * x));
            }
        }
        let rounding = 1e-14 * map.size();
        let error = condition * (map.error + rounding) * UP;
        least.into_iter().all(|least| least > error)
    }
}
