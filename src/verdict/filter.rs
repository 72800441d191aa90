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

use std::marker::PhantomData;

use super::bound::StepBound;
use super::floquet::{Floquet, Pair};
use super::kernel::{Instructions, Lanes, Orbits, Task, Watch, each};
use super::kind::PartialSigns;
use super::winding;
use crate::number::Sign;

/// Half the distance from 1 to the next double.
const U: f64 = f64::EPSILON / 2.0;

/// The most updates between two looks at |g|.
const BLOCK: i32 = 16;

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
    #[inline(always)]
    fn new(beta: f64, slope: f64, steps: u64) -> Option<Certificate> {
        // 1 + 64u covers the roundings of β and of this line.
        let beta = beta * (1.0 + 64.0 * U);
        let kappa = (beta / 2.0 + (1.0 + beta * beta / 4.0).sqrt()) * (1.0 + 8.0 * U);
        let before = kappa * (28.0 + 13.0 * slope) + 6.1 * beta;
        let after = 1.0 + slope;
        let step = StepBound { kappa, epsilon: 1.01 * U * (before + 1.01 * kappa * after) };
        let tau = step.tau(steps)?;
        // Blocks in which |g| grows fourfold at most.
        let growth = step.growth();
        let block = ((4f64.ln() / growth.ln()) as i32).clamp(1, BLOCK);
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
    #[inline(always)]
    fn strong(&self) -> bool {
        self.steps as f64 * self.step.growth().log2() > 100.0
    }

    /// The sign of a component of a solution at T/2 whose length² is given, 0 where it is not certain.
    #[inline(always)]
    fn sign(&self, form: f64, length2: f64, squares: f64) -> f64 {
        let across = self.across * squares;
        let certain = form * form * length2 > across * across;
        if certain { form.signum() } else { 0.0 }
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
struct Everything;

impl Watch for Everything {
    const MEASURE: bool = true;
    const WIND: bool = true;
}

/// Signs and whether the bounds hold.
struct SignsOnly;

impl Watch for SignsOnly {
    const MEASURE: bool = false;
    const WIND: bool = false;
}

/// Runs the half period; `None` where the bound's conditions cannot be met (very strong kicks).
pub(super) fn run(floquet: &Floquet) -> Option<Ends> {
    let mut ends = [None];
    everything::<1>(&[floquet.pair()], Instructions::best(), &mut ends);
    ends[0]
}

/// Runs the half periods of at most L pairs side by side, and tells of each what [`run`] tells of one.
pub(crate) fn everything<const L: usize>(
    pairs: &[Pair],
    instructions: Instructions,
    ends: &mut [Option<Ends>],
) {
    let Some(run) = side_by_side::<Everything, L>(pairs, instructions) else { return ends.fill(None) };
    let halves = instructions.perform(Finish(&run));
    for (i, (pair, end)) in pairs.iter().zip(ends).enumerate() {
        *end = halves.ends(&run, pair, i);
    }
}

/// Runs the half periods of at most L pairs side by side for their verdicts: positions in [`Verdict::ALL`], or
/// [`UNDECIDED`].
pub(crate) fn verdicts<const L: usize>(pairs: &[Pair], instructions: Instructions) -> [u8; L] {
    let run = side_by_side::<SignsOnly, L>(pairs, instructions);
    run.map_or([UNDECIDED; L], |run| instructions.perform(Verdicts(&run)))
}

/// The filter could not tell.
pub(crate) const UNDECIDED: u8 = u8::MAX;

/// Runs at most L pairs side by side. One certificate serves all: that of the strongest kick, the steepest slope
/// and the most updates.
fn side_by_side<W: Watch, const L: usize>(pairs: &[Pair], instructions: Instructions) -> Option<Run<L>> {
    let (mut lanes, strongest) = instructions.perform(Start::<L>(pairs));
    let slope = pairs.iter().map(|pair| pair.base.slope).fold(0.0, f64::max);
    let steps = pairs.iter().map(|pair| pair.updates).max().unwrap_or(0) + 1;
    let certificate = Certificate::new(strongest, slope, steps)?;
    (lanes.worst, lanes.strong) = (certificate.worst, certificate.strong());
    instructions.perform(Advance::<W, L>(&mut lanes, certificate.block, PhantomData));
    let mut left = [[1.0; L], [0.0; L]];
    for (i, pair) in pairs.iter().enumerate() {
        let [cos, sin] = pair.left().map_or([1.0, 0.0], |n| pair.base.turn(n).half);
        (left[0][i], left[1][i]) = (cos, sin);
    }
    Some(Run { certificate, lanes, left })
}

/// What is compiled for each instruction set.
struct Start<'a, const L: usize>(&'a [Pair<'a>]);
struct Advance<'a, W, const L: usize>(&'a mut Lanes<L>, u64, PhantomData<W>);
struct Finish<'a, const L: usize>(&'a Run<L>);
struct Verdicts<'a, const L: usize>(&'a Run<L>);

impl<const L: usize> Task for Start<'_, L> {
    type Output = (Lanes<L>, f64);

    #[inline(always)]
    fn run(self) -> (Lanes<L>, f64) {
        let lanes = Lanes::new(self.0);
        (lanes, lanes.strongest())
    }
}

impl<W: Watch, const L: usize> Task for Advance<'_, W, L> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.0.advance::<W>(self.1);
    }
}

impl<const L: usize> Task for Finish<'_, L> {
    type Output = Halves<L>;

    #[inline(always)]
    fn run(self) -> Halves<L> {
        Halves::new(self.0)
    }
}

impl<const L: usize> Task for Verdicts<'_, L> {
    type Output = [u8; L];

    #[inline(always)]
    fn run(self) -> [u8; L] {
        Halves::new(self.0).verdicts()
    }
}

/// A group after its last update.
struct Run<const L: usize> {
    certificate: Certificate,
    lanes: Lanes<L>,
    /// Cosine and sine of the base's last turn.
    left: [[f64; L]; 2],
}

/// The half periods of a group.
struct Halves<const L: usize> {
    /// (re, im) of the even solution before the base's last turn.
    even: [[f64; L]; 2],
    /// (x, v) of the even and the odd solution, and their signs, 0 where uncertain.
    ends: [[[f64; L]; 2]; 2],
    signs: [[[f64; L]; 2]; 2],
}

impl<const L: usize> Halves<L> {
    #[inline(always)]
    fn new(run: &Run<L>) -> Self {
        let [even, odd] = run.lanes.ends();
        let ends = [run.turned(&even), run.turned(&odd)];
        let signs = [run.signs(&ends[0], &run.lanes.even), run.signs(&ends[1], &run.lanes.odd)];
        Halves { even, ends, signs }
    }

    /// Positions in `Verdict::ALL`: BC > 0, AD < 0, BC < 0 < AD.
    #[inline(always)]
    fn verdicts(&self) -> [u8; L] {
        let [[a, c], [b, d]] = &self.signs;
        let mut verdicts = [UNDECIDED; L];
        for (i, verdict) in verdicts.iter_mut().enumerate() {
            let (bc, ad) = (b[i] * c[i], a[i] * d[i]);
            *verdict = if bc < 0.0 && ad > 0.0 { 0 } else { *verdict };
            *verdict = if ad < 0.0 { 2 } else { *verdict };
            *verdict = if bc > 0.0 { 1 } else { *verdict };
        }
        verdicts
    }

    /// All about lane i; `None` where the theorem's conditions did not hold all the way.
    fn ends(&self, run: &Run<L>, pair: &Pair, i: usize) -> Option<Ends> {
        let certificate = &run.certificate;
        let end = |n: usize, orbits: &Orbits<L>| {
            let certain = |x: f64| (x != 0.0).then(|| Sign::from_ordering(x.total_cmp(&0.0)));
            let (squares, worst) = (orbits.squares[i], orbits.worst[i]);
            let stretch = certificate.step.length_uncertainty(certificate.steps, certificate.ratio * worst);
            let end = End {
                x: self.ends[n][0][i],
                v: self.ends[n][1][i],
                exponent: orbits.exponent[i] as i64,
                across: certificate.across * squares,
                stretch: stretch + 2.0 * U,
                signs: (certain(self.signs[n][0][i]), certain(self.signs[n][1][i])),
            };
            (worst <= certificate.worst).then_some(end)
        };
        let lane = |pair: &[[f64; L]; 2]| [pair[0][i], pair[1][i]];
        let quarters = winding::at_end(pair, run.lanes.even_quarter(i), lane(&self.even), lane(&run.left));
        Some(Ends { even: end(0, &run.lanes.even)?, odd: end(1, &run.lanes.odd)?, quarters })
    }
}

impl<const L: usize> Run<L> {
    /// (x, v) = (Re, −Im) of g e^{iω}, ω the turn left.
    #[inline(always)]
    fn turned(&self, [re, im]: &[[f64; L]; 2]) -> [[f64; L]; 2] {
        let [cos, sin] = &self.left;
        [each(|i| re[i] * cos[i] - im[i] * sin[i]), each(|i| -(re[i] * sin[i] + im[i] * cos[i]))]
    }

    /// The signs of x and v: 0 where they are not certain, everywhere where a condition of the theorem failed on
    /// the way. (NaN fails.)
    #[inline(always)]
    fn signs(&self, [x, v]: &[[f64; L]; 2], orbits: &Orbits<L>) -> [[f64; L]; 2] {
        let certificate = &self.certificate;
        let length2: [f64; L] = each(|i| x[i] * x[i] + v[i] * v[i]);
        let held = |i: usize| orbits.worst[i] <= certificate.worst;
        let squares: [f64; L] = each(|i| if held(i) { orbits.squares[i] } else { f64::INFINITY });
        [
            each(|i| certificate.sign(x[i], length2[i], squares[i])),
            each(|i| certificate.sign(v[i], length2[i], squares[i])),
        ]
    }
}
