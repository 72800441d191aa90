//! The first tier: the half period in Floquet coordinates and doubles, with a proven error bound.
//!
//! proofs/FILTER.md derives every constant; in short, with u = 2^-53 and g in the coordinates of
//! [`super::floquet`], where a kick has the norm κ ≤ |β|/2 + √(1 + β²/4) and a turn the norm 1,
//!
//! ```text
//!     |r_k| ≤ u (κ (28 + 13 tan(θ/2)) + 6.1 |β|) |g_(k-1)| + u (1 + tan(θ/2)) |g_k|
//! ```
//!
//! is what one update (four shears) adds to the error.

use super::bound::StepBound;
use super::floquet::{Floquet, Pair};
use super::kernel::{Instructions, Lanes, Watch};
use super::kind::PartialSigns;
use super::winding;
use crate::number::Sign;

/// Half the distance from 1 to the next double.
const U: f64 = f64::EPSILON / 2.0;

/// The most updates between two looks at |g|.
const BLOCK: i32 = 8;

/// The constants of the certification, all dimensionless.
#[derive(Clone, Copy, Debug)]
pub(super) struct Certificate {
    step: StepBound,
    /// Updates, the half kick at t = 0 included.
    steps: u64,
    /// Updates between two looks at |g|.
    pub block: u64,
    /// 2b ≤ `ratio` · `squares/|g|²` · |g|² anywhere in a block.
    ratio: f64,
    /// The largest `squares/|g|²` that the theorem's condition on τ admits.
    pub worst: f64,
    /// 2b and the error of evaluating a linear form of g are together at most this times `squares`.
    across: f64,
}

impl Certificate {
    /// For all pairs whose |β|, tan(θ/2) and number of steps are at most these; `None` where the theorem's
    /// conditions cannot be met.
    pub fn new(beta: f64, slope: f64, steps: u64) -> Option<Certificate> {
        // 1 + 64u covers the roundings of β and of this line.
        let beta = beta * (1.0 + 64.0 * U);
        let kappa = (beta / 2.0 + (1.0 + beta * beta / 4.0).sqrt()) * (1.0 + 8.0 * U);
        let before = kappa * (28.0 + 13.0 * slope) + 6.1 * beta;
        let after = 1.0 + slope;
        let step = StepBound { kappa, epsilon: 1.01 * U * (before + 1.01 * kappa * after) };
        let tau = step.tau(steps)?;
        // Blocks in which |g| at most doubles.
        let growth = step.growth();
        let block = ((2f64.ln() / growth.ln()) as i32).clamp(1, BLOCK);
        // Every step is within block/2 of a block's end and at most `block` steps share one: with the inequality
        // of the means Σ |r_j| |g_j| ≤ u (before + after) block growth^(2 ⌊block/2⌋) squares. 1.01 for the
        // rounding of the sum itself (at most 10^13 terms) and of these constants.
        let b = 1.01 * U * (before + after) * f64::from(block) * growth.powi(2 * (block / 2));
        // Before a block's end |g|² was smaller than there by growth^(2 (block - 1)) at most.
        let ratio = 2.0 * b * growth.powi(2 * (block - 1));
        let across = 2.0 * b + 1.01 * U * (7.0 + 5.0 * slope);
        let certificate =
            Certificate { step, steps, block: block as u64, ratio, worst: 0.99 * tau / ratio, across };
        (steps < 1 << 43 && ratio.is_finite()).then_some(certificate)
    }

    /// Whether |g|² may pass 2^300, from 2^100 at most at the start.
    fn strong(&self) -> bool {
        self.steps as f64 * self.step.growth().log2() > 100.0
    }

    /// The signs of the two components of a solution at T/2.
    fn signs(&self, [x, v]: [f64; 2], squares: f64) -> (Option<Sign>, Option<Sign>) {
        let across = self.across * squares;
        let length2 = x * x + v * v;
        let certain = |form: f64| {
            let beyond = form * form * length2 > across * across;
            beyond.then_some(if form > 0.0 { Sign::Positive } else { Sign::Negative })
        };
        (certain(x), certain(v))
    }
}

/// Where the even and the odd solution stand at T/2, with proven bounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ends {
    pub even: End,
    pub odd: End,
    /// ⌊Θ/(π/2)⌋, Θ the even solution's turn over the half period; counted on request.
    pub quarters: i64,
}

/// One solution at T/2 in Floquet coordinates: the exact vector is 2^exponent a ((x, v) + t J(x, v)/|(x, v)|²)
/// with |t| ≤ across and |a − 1| ≤ stretch/(1 − stretch).
#[derive(Clone, Copy, Debug)]
pub(crate) struct End {
    /// A or B, in the scale that leaves the products AD and BC as they are.
    pub x: f64,
    /// C or D.
    pub v: f64,
    pub exponent: i64,
    pub across: f64,
    pub stretch: f64,
    signs: (Option<Sign>, Option<Sign>),
}

impl Ends {
    /// The signs as far as the bounds certify them.
    pub fn signs(&self) -> PartialSigns {
        let ((a, c), (b, d)) = (self.even.signs, self.odd.signs);
        PartialSigns { a, b, c, d }
    }
}

/// Signs, bounds and turns: all that one pair can tell.
pub(crate) struct Everything;

impl Watch for Everything {
    const MEASURE: bool = true;
    const WIND: bool = true;
}

/// Signs and whether the bounds hold.
pub(crate) struct SignsOnly;

impl Watch for SignsOnly {
    const MEASURE: bool = false;
    const WIND: bool = false;
}

/// Runs the half period; `None` where the bound's conditions cannot be met (very strong kicks).
pub(super) fn run(floquet: &Floquet) -> Option<Ends> {
    let mut ends = [None];
    together::<Everything, 1>(&[floquet.pair()], Instructions::best(), &mut ends);
    ends[0]
}

/// Runs the half periods of at most L pairs side by side, and tells of each what [`run`] tells of one.
///
/// One certificate serves all: that of the strongest kick, the steepest slope and the most updates.
pub(crate) fn together<W: Watch, const L: usize>(pairs: &[Pair], instructions: Instructions, ends: &mut [Option<Ends>]) {
    let mut lanes = Lanes::<L>::new(pairs);
    let slope = pairs.iter().map(|pair| pair.base.slope).fold(0.0, f64::max);
    let steps = pairs.iter().map(|pair| pair.updates).max().unwrap_or(0) + 1;
    let Some(certificate) = Certificate::new(lanes.strongest(pairs), slope, steps) else {
        ends.fill(None);
        return;
    };
    (lanes.worst, lanes.strong) = (certificate.worst, certificate.strong());
    lanes.run::<W>(instructions, certificate.block);
    for (i, (pair, end)) in pairs.iter().zip(ends).enumerate() {
        *end = finish::<W, L>(&lanes, &certificate, pair, i);
    }
}

/// At T/2; `None` where the theorem's conditions did not hold all the way. (NaN fails.)
fn finish<W: Watch, const L: usize>(lanes: &Lanes<L>, certificate: &Certificate, pair: &Pair, i: usize) -> Option<Ends> {
    let [cos, sin] = match pair.left() {
        0 => [1.0, 0.0],
        n => pair.base.turn(n).half,
    };
    let [even, odd] = lanes.end(i);
    let end = |[re, im]: [f64; 2], orbits: &super::kernel::Orbits<L>| {
        let (x, v) = (re.mul_add(cos, -(im * sin)), -re.mul_add(sin, im * cos));
        let (squares, worst) = (orbits.squares[i], orbits.worst[i]);
        let end = End {
            x,
            v,
            exponent: orbits.exponent[i] as i64,
            across: certificate.across * squares,
            stretch: certificate.step.length_uncertainty(certificate.steps, certificate.ratio * worst) + 2.0 * U,
            signs: certificate.signs([x, v], squares),
        };
        (worst <= certificate.worst).then_some(end)
    };
    let quarters = if W::WIND { winding::at_end(pair, lanes.even_quarter(i), even, [cos, sin]) } else { 0 };
    Some(Ends { even: end(even, &lanes.even)?, odd: end(odd, &lanes.odd)?, quarters })
}
