//! About where a tongue of one ratio begins and ends, in doubles: where the search looks rests on it, and no
//! proof.

use super::sector::Ratio;
use number::vector::instructions::{Instructions, Task};

/// Steps that are followed side by side.
const LANES: usize = 8;

/// Edges are found within this share of a tongue's width, in so many rounds at most.
const OFF: f64 = 2e-3;
const ROUNDS: u32 = 40;

/// Kicks between which nothing outgrows doubles, and what is scaled down then.
const SAFE: u32 = 64;
const LARGE: f64 = 1e100;

/// At each of some steps h1: 2m in the tongue m, 2m + 1 between it and the next.
struct Places {
    stiffness: [f64; 2],
    ratio: Ratio,
    steps: [f64; LANES],
}

impl Task for Places {
    type Output = [f64; LANES];

    /// The even and the odd solution over the half period, and the quarter turns of the even one: a kick and
    /// a drift cross one axis each at most.
    #[inline(always)]
    fn run(self) -> [f64; LANES] {
        let Places { stiffness, ratio: (p, q), steps } = self;
        // Half a tick, so that the half period is p q of them.
        let tick = steps.map(|h1| 0.5 * h1 / q as f64);
        let kicks = [q, p].map(|ticks| tick.map(|tick| 2.0 * tick * ticks as f64));
        let kicks = [0, 1].map(|k| kicks[k].map(|step| step * stiffness[k]));
        let (every, end) = ([2 * q, 2 * p], p * q);
        let (mut next, mut now, mut since) = (every, 0, 0);
        let (mut x, mut v) = ([[1.0; LANES], [0.0; LANES]], [[0.0; LANES], [1.0; LANES]]);
        for i in 0..LANES {
            v[0][i] = -0.5 * (kicks[0][i] + kicks[1][i]);
        }
        let mut quarters = [0f64; LANES];
        while now < end {
            let at = next[0].min(next[1]).min(end);
            let ticks = (at - now) as f64;
            now = at;
            // Half a kick at the end, as at the beginning.
            let share = if at == end { 0.5 } else { 1.0 };
            let shares = [0, 1].map(|k| if next[k] == at { share } else { 0.0 });
            for k in 0..2 {
                if next[k] == at {
                    next[k] += every[k];
                }
            }
            for i in 0..LANES {
                let drift = ticks * tick[i];
                let kick = shares[0] * kicks[0][i] + shares[1] * kicks[1][i];
                let (x_before, v_before) = (x[0][i], v[0][i]);
                for k in 0..2 {
                    x[k][i] += drift * v[k][i];
                    v[k][i] -= kick * x[k][i];
                }
                quarters[i] += if (x_before < 0.0) != (x[0][i] < 0.0) { 1.0 } else { 0.0 };
                quarters[i] += if (v_before < 0.0) != (v[0][i] < 0.0) { 1.0 } else { 0.0 };
            }
            since += 1;
            if since == SAFE {
                since = 0;
                for i in 0..LANES {
                    let size = x[0][i].abs() + x[1][i].abs() + v[0][i].abs() + v[1][i].abs();
                    let scale = if size > LARGE { 1.0 / LARGE } else { 1.0 };
                    for k in 0..2 {
                        x[k][i] *= scale;
                        v[k][i] *= scale;
                    }
                }
            }
        }
        // Tr > 2 where B C > 0, Tr < −2 where A D < 0.
        std::array::from_fn(|i| {
            if (x[1][i] > 0.0) == (v[0][i] > 0.0) {
                4.0 * (0.5 * (quarters[i] + 1.0)).floor()
            } else if (x[0][i] > 0.0) != (v[1][i] > 0.0) {
                4.0 * (0.5 * quarters[i]).floor() + 2.0
            } else {
                2.0 * quarters[i] + 1.0
            }
        })
    }
}

fn places(stiffness: [f64; 2], ratio: Ratio, steps: [f64; LANES]) -> [f64; LANES] {
    Instructions::best().perform_alone(Places { stiffness, ratio, steps })
}

/// The labels of the tongues of a ratio between two steps h1.
pub fn labels(stiffness: [f64; 2], ratio: Ratio, (lo, hi): (f64, f64)) -> std::ops::RangeInclusive<i64> {
    let places = places(stiffness, ratio, std::array::from_fn(|i| if i == 0 { lo } else { hi }));
    ((0.5 * places[0]).ceil() as i64).max(1)..=(0.5 * places[1]).floor() as i64
}

/// The steps h1 between which the tongue m of a ratio is, none beyond `most`. It may be near `about`.
pub fn edges(stiffness: [f64; 2], ratio: Ratio, m: i64, about: (f64, f64), most: f64) -> (f64, f64) {
    if m < 1 {
        return (0.0, 0.0);
    }
    let m = 2.0 * m as f64;
    let (lo, hi) = about;
    let room = 0.2 * (hi - lo).max(1e-3 * hi);
    let (from, to) = ((lo - room).max(0.0), (hi + room).min(most));
    let mut steps: [f64; LANES] = std::array::from_fn(|i| from + (to - from) * i as f64 / (LANES - 1) as f64);
    // The last step before each edge and the first one behind it.
    let mut edges = [(0f64, most); 2];
    for _ in 0..ROUNDS {
        for (step, place) in steps.into_iter().zip(places(stiffness, ratio, steps)) {
            for (edge, is_before) in edges.iter_mut().zip([place < m, place <= m]) {
                if is_before {
                    edge.0 = edge.0.max(step);
                } else {
                    edge.1 = edge.1.min(step);
                }
                // Rounding may have them in another order.
                edge.1 = edge.1.max(edge.0);
            }
        }
        let [lower, upper] = edges;
        let width = (upper.0 - lower.1).max(1e-7 * upper.1);
        if (lower.1 - lower.0).max(upper.1 - upper.0) <= OFF * width {
            break;
        }
        steps = std::array::from_fn(|i| {
            let (edge, k, parts) =
                if lower == upper { (lower, i, LANES) } else { (edges[i % 2], i / 2, LANES / 2) };
            edge.0 + (edge.1 - edge.0) * (k + 1) as f64 / (parts + 1) as f64
        });
    }
    let [lower, upper] = edges.map(|(before, behind)| 0.5 * (before + behind));
    (lower, upper)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_where_the_paper_has_them() {
        // One clock twice, at equal steps: one force of stiffness 4, stable up to h1 = 1, and no tongue
        // before.
        let (lo, hi) = edges([2.0, 2.0], (1, 1), 1, (0.1, 0.9), 3.0);
        assert!((lo - 1.0).abs() < 1e-2 && hi > 2.9, "{lo}, {hi}");
        // h2 = 2 h1, both of stiffness s/h1²: D = 1 − 2 s, A = 1 − 3 s + s² over the half period (by hand).
        let (lo, hi) = edges([1.0, 1.0], (2, 1), 1, (0.1, 0.9), 3.0);
        let half = |s: f64| {
            // Kicks of 3/2 s, drift, s, drift, 3/2 s, over the period.
            let end = |mut x: f64, mut v: f64| {
                v -= 1.5 * s * x;
                x += v;
                v -= 0.5 * s * x;
                (x, v)
            };
            [end(1.0, 0.0), end(0.0, 1.0)]
        };
        let is_stable = |h1: f64| {
            let [(a, c), (b, d)] = half(h1 * h1);
            a * d > 0.0 && b * c < 0.0
        };
        let off = 1e-2 * (hi - lo);
        assert!(is_stable(lo - off) && !is_stable(lo + off) && !is_stable(hi - off), "{lo}, {hi}");
        assert!(hi > 2.9 || is_stable(hi + off), "{lo}, {hi}");
    }
}
