//! Edges in closed form, and the resonances that they sit on.

use num_traits::Zero;

use crate::tongue::edge::{Edge, Enclosure, Tongues, simplest};
use crate::tongue::string::Entry;
use number::{Ratio, Rational, Result, named, rational};

/// An edge in closed form, proven.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ExactEdge {
    /// s is this rational.
    Rational(Rational),
    /// p θ = m π exactly: s = 4 sin²(m π/(2p)).
    Resonance,
    /// q θ' = m π exactly, θ' the angle of the slow clock: s ρ (p/q)² = 4 sin²(m π/(2q)).
    SlowResonance,
}

/// An edge in closed form, if it has one that we know.
///
/// The odd solution of p θ = m π vanishes at all slow kicks if q = 1 (and then ends with x = 0 or v = 0 at
/// T/2 as m is even or odd), or if q = 2 and m is even: the slow clock does not act on it. Likewise with the
/// clocks exchanged. Other edges are rational if the simplest rational in the enclosure is a zero.
pub(crate) fn exact_edge(tongues: &Tongues, m: u64, edge: &Edge) -> Result<Option<ExactEdge>> {
    let odd_start = !edge.entry.starts_free();
    let silent = |other: u64| other == 1 || (other == 2 && edge.entry == Entry::B);
    if let Some(s) = rational_edge(tongues, edge)? {
        return Ok(Some(ExactEdge::Rational(s)));
    }
    if (odd_start && silent(tongues.ratio().q()) && m < tongues.ratio().p()) || tongues.rho().is_zero() {
        return Ok(Some(ExactEdge::Resonance));
    }
    Ok((odd_start && silent(tongues.ratio().p()) && m < tongues.ratio().q())
        .then_some(ExactEdge::SlowResonance))
}

fn rational_edge(tongues: &Tongues, edge: &Edge) -> Result<Option<Rational>> {
    let around = Enclosure::from(edge);
    let candidate = simplest(&around.lo, &around.hi);
    // A random enclosure of 2^-52 has its simplest rational at a denominator of some 2^26.
    let simple = candidate.denom().bits() <= 20;
    let is_zero = simple && tongues.function(edge.entry)?.is_zero_at(&candidate);
    Ok(is_zero.then_some(candidate))
}

named! {
    /// A clock whose own resonance an edge sits on exactly.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum Resonance {
        /// p θ = m π: the paper's eq. (9), q h2 = m T½.
        Fast = "p theta = m pi",
        /// q θ' = m π, θ' the slow clock's angle: the same with the clocks exchanged.
        Slow = "q theta' = m pi",
    }
}

impl Resonance {
    /// The resonance on which an edge in closed form sits, if any; a rational edge does where its angle is
    /// π/3, π/2 or 2π/3.
    pub fn of(ratio: Ratio, m: u64, rho: &Rational, edge: &ExactEdge) -> Option<Resonance> {
        match edge {
            ExactEdge::Resonance => Some(Resonance::Fast),
            ExactEdge::SlowResonance => Some(Resonance::Slow),
            ExactEdge::Rational(s) => {
                let steps = Rational::from(ratio);
                let slow = s * rho * &steps * &steps;
                if turns(s, m, ratio.p()) {
                    Some(Resonance::Fast)
                } else {
                    turns(&slow, m, ratio.q()).then_some(Resonance::Slow)
                }
            }
        }
    }
}

/// Whether s = 4 sin²(m π/(2p)), m < p, for a rational s: by Niven's theorem only 1, 2 and 3 can be.
fn turns(s: &Rational, m: u64, p: u64) -> bool {
    [(1, 3, 1), (2, 2, 1), (3, 3, 2)]
        .into_iter()
        .any(|(value, whole, part)| *s == rational::ratio(value, 1) && whole * m == part * p)
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::ratio;

    #[test]
    fn rational_angles_are_resonances() {
        let on = |p, q, m, s| {
            Resonance::of(Ratio::new(p, q).unwrap(), m, &ratio(1, 4), &ExactEdge::Rational(ratio(s, 1)))
        };
        assert_eq!([on(3, 1, 1, 1), on(4, 1, 2, 2), on(9, 2, 6, 3)], [Some(Resonance::Fast); 3]);
        assert_eq!(on(3, 1, 2, 1), None);
        // s rho (p/q)² = 36/4/9 = 1 and q = 3, m = 1: the slow clock's own.
        assert_eq!(on(1, 3, 1, 36), Some(Resonance::Slow));
    }
}
