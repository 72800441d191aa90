//! The unstable intervals of an outer step at a fixed ratio: tongues, in fs.

use num_traits::Zero;

use clocks::tongue::{Gap, Tongues};
use number::{Ball, Laurent, Ratio, Rational, Real, Result, from_f64_exact};

const BITS: u32 = 128;

/// Tongues whose edges are computed side by side.
const AT_ONCE: u64 = 8;

/// Outer steps that are unstable, at the ratio of the steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Unstable {
    /// m, the half turns of the growing solution in a synchronization period.
    pub label: u64,
    /// Both ends in fs, enclosed; no upper end beyond the fast clock's own limit, nor where the two are one
    /// point.
    pub lower: (f64, f64),
    pub upper: Option<(f64, f64)>,
    /// Where growth is fastest.
    pub worst: Option<Worst>,
}

/// The fastest growth in an interval; rounded to some nine digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// Per fs.
    pub rate: f64,
    /// Outer steps until an amplitude is tenfold,
    pub steps: f64,
    /// and fs.
    pub time: f64,
}

/// The tongues of one fast stiffness and one slow one at a ratio of steps.
pub struct Intervals<'a> {
    /// For ρ, rounded down where it is irrational,
    low: Tongues,
    /// and then for ρ rounded up: edges fall as ρ rises, so the two enclose its own.
    high: Option<Tongues>,
    ratio: Ratio,
    fast: &'a Laurent,
}

impl<'a> Intervals<'a> {
    /// The stiffnesses on the clocks h1 and h2 = h1 p/q.
    pub fn new(ratio: Ratio, fast: &'a Laurent, slow: &Laurent) -> Result<Self> {
        let of = |rho: &Rational| Tongues::new(ratio, rho);
        let (low, high) = match Laurent::ratio(slow, fast) {
            Some(rho) => (of(&rho)?, None),
            None => {
                let rho = slow.enclosure(BITS).div(&fast.enclosure(BITS), BITS);
                let rho = rho.expect("the fast stiffness is positive");
                (of(&rho.lower())?, Some(of(&rho.upper())?))
            }
        };
        Ok(Intervals { low, high, ratio, fast })
    }

    /// The last label.
    pub fn last(&self) -> u64 {
        self.low.last()
    }

    /// The first label that can be open: where the slow clock is silent, all before the last are closed.
    fn first_open(&self) -> u64 {
        if self.low.rho().is_zero() { self.last() } else { 1 }
    }

    /// √(s/L1) p/q, the outer step, over an enclosure of s.
    fn step(&self, lo: f64, hi: f64) -> (f64, f64) {
        let stiffness = self.fast.enclosure(BITS);
        let ratio = Ball::from_rational(&Rational::from(self.ratio), BITS);
        let of = |s: f64| {
            let s = Ball::from_rational(&from_f64_exact(s).expect("an edge is finite"), BITS);
            s.div(&stiffness, BITS).and_then(|square| square.sqrt(BITS)).expect("s > 0").mul(&ratio, BITS)
        };
        (of(lo).to_f64_enclosure().0, of(hi).to_f64_enclosure().1)
    }

    /// The tongues `from` ..= `upto`, for ρ rounded down and up.
    fn gaps(&self, from: u64, upto: u64) -> Result<Vec<[Gap; 2]>> {
        let low = self.low.gaps(from, upto)?;
        let high = self.high.as_ref().map_or_else(|| Ok(low.clone()), |tongues| tongues.gaps(from, upto))?;
        Ok(low.into_iter().zip(high).map(|(low, high)| [low, high]).collect())
    }

    fn gap(&self, label: u64) -> Result<[Gap; 2]> {
        Ok(self.gaps(label, label)?.remove(0))
    }

    fn lower(&self, [low, high]: &[Gap; 2]) -> (f64, f64) {
        self.step(high.lower.lo, low.lower.hi)
    }

    /// Tongue `label`; `None` where it is closed.
    pub fn get(&self, label: u64) -> Result<Option<Unstable>> {
        self.open(&self.gap(label)?)
    }

    /// A tongue with its growth; `None` where it is closed.
    fn open(&self, gaps: &[Gap; 2]) -> Result<Option<Unstable>> {
        let [low, high] = gaps;
        if low.closed || high.closed {
            return Ok(None);
        }
        let lower = self.lower(gaps);
        let upper = low.upper.zip(high.upper).map(|(low, high)| self.step(high.lo, low.hi));
        let peak = self.low.peak(low)?;
        let worst = peak.map(|peak| {
            let rate = peak.growth_rate(self.fast);
            Worst { rate, steps: peak.slow_steps_to_tenfold, time: std::f64::consts::LN_10 / rate }
        });
        Ok(Some(Unstable { label: low.m, lower, upper, worst }))
    }

    /// The first tongue, at which the stable region that begins at step 0 ends; without an upper end where it
    /// is closed, as without a slow force.
    pub fn first(&self) -> Result<Unstable> {
        let gaps = self.gap(1)?;
        let lower = self.lower(&gaps);
        Ok(self.open(&gaps)?.unwrap_or(Unstable { label: 1, lower, upper: None, worst: None }))
    }

    /// The open ones that begin below a step, from the first on: at most so many.
    pub fn up_to(&self, step: f64, count: usize) -> Result<Vec<Unstable>> {
        let mut found = Vec::new();
        for from in (self.first_open()..=self.last()).step_by(AT_ONCE as usize) {
            for gaps in self.gaps(from, self.last().min(from + AT_ONCE - 1))? {
                if found.len() == count || self.lower(&gaps).0 > step {
                    return Ok(found);
                }
                found.extend(self.open(&gaps)?);
            }
        }
        Ok(found)
    }

    /// The nearest open tongues about a stable outer step: the one below it, the one above it.
    pub fn about(&self, outer: f64) -> Result<[Option<Unstable>; 2]> {
        // Lower edges rise with the label: the first label whose tongue begins above the step.
        let (mut lo, mut hi) = (self.first_open(), self.last() + 1);
        while lo < hi {
            let middle = lo + (hi - lo) / 2;
            let begins = self.lower(&self.gap(middle)?).0;
            if begins > outer { hi = middle } else { lo = middle + 1 }
        }
        let below = (self.first_open()..lo)
            .rev()
            .map(|label| self.get(label))
            .find_map(Result::transpose)
            .transpose()?;
        let above =
            (lo..=self.last()).map(|label| self.get(label)).find_map(Result::transpose).transpose()?;
        Ok([below, above])
    }
}
