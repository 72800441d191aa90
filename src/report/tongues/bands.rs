//! What a diagram of tongues is made from.

use crate::number::Ratio;

/// One tongue over ρ.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    pub m: u64,
    /// Its dominant family.
    pub family: (i64, i64),
    /// [lower s, upper s, ρ], ρ rising; where ρ is 0 both are the point p θ = m π.
    pub edges: Vec<[f64; 3]>,
}

/// All of one ratio that begin below s = 4 at some ρ.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    pub ratio: Ratio,
    pub bands: Vec<Band>,
    /// The points p θ = m π, 0 < m < p, in s: the same for every ρ.
    pub resonances: Vec<f64>,
    /// [s, ρ] of closed tongues.
    pub closings: Vec<[f64; 2]>,
}

/// The fast clock's own limit, where the axis ends.
pub const LARGEST_S: f64 = 4.0;
