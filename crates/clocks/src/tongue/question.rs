//! Questions about the tongues of many ratios: which of them, and what of each.

use super::edge::Tongues;
use super::gap::Gap;
use super::request::{Request, Tongue};
use super::select::{Range, Selection};
use number::parallel::try_map;
use number::{Error, ExactSign, Laurent, Ratio, Rational, Result, Sign};

/// ρ, and the stiffnesses where they are given.
#[derive(Clone, Debug)]
pub struct Stiffness {
    pub rho: Rational,
    pub lambda1: Option<Laurent>,
    /// The slow stiffness, where it was given in place of ρ.
    pub lambda2: Option<Laurent>,
}

/// Closed ranges of h1 and h2.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepWindow {
    pub h1: Option<Range>,
    pub h2: Option<Range>,
}

/// Tongues of some ratios at one ρ.
///
/// ```
/// use kickdrift_clocks::number::{Ratio, rational::ratio};
/// use kickdrift_clocks::tongue::{Listing, Request, Selection, Stiffness, StepWindow};
/// let stiffness = Stiffness::new(Some(ratio(1, 25)), None, None).unwrap();
/// let ratios: Vec<Ratio> = Ratio::up_to(10).collect();
/// let asked = Listing::new(ratios, stiffness, StepWindow::default(), Selection::below(4.0), Request::default()).unwrap();
/// let mut widest: f64 = 0.0;
/// asked
///     .each(&(), |part| {
///         part.iter().filter(|t| t.upper.is_some()).for_each(|t| widest = widest.max(t.row.gap.width.1));
///         Ok(())
///     })
///     .unwrap();
/// assert!(widest > 0.1);
/// ```
#[derive(Clone, Debug)]
pub struct Listing {
    pub ratios: Vec<Ratio>,
    pub stiffness: Stiffness,
    pub window: StepWindow,
    /// Conditions beside the window, which is one of steps.
    pub selection: Selection,
    pub request: Request,
}

/// Who watches a long computation; `()` does not.
pub trait Progress: Sync {
    /// So many things are to be done in all.
    fn expect(&self, _total: u64) {}
    /// So many more are done.
    fn advance(&self, _more: u64) {}
}

impl Progress for () {}

/// Ratios whose tongues are held in memory together, and tongues of one ratio that a thread takes at a time.
const BATCH: usize = 64;
const CHUNK: usize = 16;

impl Stiffness {
    /// ρ = L2/L1 exactly, given as such or by the stiffnesses.
    ///
    /// # Errors
    /// Neither or both, L1 ≤ 0, an irrational ρ, a negative one.
    pub fn new(rho: Option<Rational>, lambda1: Option<Laurent>, lambda2: Option<Laurent>) -> Result<Self> {
        if let Some(lambda1) = lambda1.as_ref().filter(|lambda1| lambda1.sign() != Sign::Positive) {
            return Err(Error::input("lambda1", lambda1, "the fast stiffness must be positive"));
        }
        let rho = match (rho, &lambda1, &lambda2) {
            (Some(rho), _, None) => rho,
            (None, Some(lambda1), Some(lambda2)) => Laurent::ratio(lambda2, lambda1).ok_or_else(|| {
                let remedy =
                    "rho must be rational: choose stiffnesses that are rational multiples of each other";
                Error::input("lambda2/lambda1", format!("({lambda2})/({lambda1})"), remedy)
            })?,
            (Some(_), _, Some(_)) => {
                return Err(Error::input("rho", "given with lambda2", "give one of them"));
            }
            (None, _, _) => {
                return Err(Error::missing("rho", "give it, or lambda1 and lambda2, whose quotient it is"));
            }
        };
        Ok(Stiffness { rho, lambda1, lambda2 })
    }
}

impl StepWindow {
    /// The range of s = h1² L1 for one ratio, from both ranges of steps: h1 = h2 q/p.
    fn of_ratio(&self, ratio: Ratio, lambda1: &Laurent) -> Option<Range> {
        let back = Laurent::from_rational(ratio.inverse().into());
        let from_h2 = self.h2.as_ref().map(|(lo, hi)| (lo * &back, hi * &back));
        let (lo, hi) = match (self.h1.clone(), from_h2) {
            (None, None) => return None,
            (Some(range), None) | (None, Some(range)) => range,
            (Some((a, b)), Some((c, d))) => (a.max(c), b.min(d)),
        };
        let zero = Laurent::from_integer(0);
        if hi < lo.clone().max(zero.clone()) {
            return Some((Laurent::from_integer(1), zero)); // empty
        }
        let s = |h1: Laurent| &(&h1 * &h1) * lambda1;
        Some((s(lo.max(zero)), s(hi)))
    }
}

impl Listing {
    /// The question, if it makes sense.
    ///
    /// # Errors
    /// A window without L1, labels that the one ratio does not have, and what [`Tongues::new`] refuses.
    pub fn new(
        ratios: Vec<Ratio>,
        stiffness: Stiffness,
        window: StepWindow,
        selection: Selection,
        mut request: Request,
    ) -> Result<Self> {
        if window != StepWindow::default() && stiffness.lambda1.is_none() {
            return Err(Error::missing("lambda1", "a window of h1 or h2 needs it: s = h1^2 lambda1"));
        }
        if let Some(&first) = ratios.first() {
            let tongues = Tongues::new(first, &stiffness.rho)?;
            if ratios.len() == 1 {
                selection.check_labels(&tongues)?;
            }
        }
        request.wanted.family = true;
        request.lambda1 = stiffness.lambda1.clone();
        Ok(Listing { ratios, stiffness, window, selection, request })
    }

    /// Hands on the tongues in the order of the ratios and of m: in parts, computed in parallel. Ratios are
    /// counted for who watches, and of one ratio alone the tongues.
    ///
    /// # Errors
    /// Where a schedule is too long, and those of `see`.
    pub fn each(&self, watch: &dyn Progress, mut see: impl FnMut(&[Tongue]) -> Result<()>) -> Result<()> {
        let alone = self.ratios.len() == 1;
        let one = |&ratio: &Ratio| self.of_ratio(ratio, if alone { watch } else { &() });
        if !alone {
            watch.expect(self.ratios.len() as u64);
        }
        for batch in self.ratios.chunks(BATCH) {
            let parts: Vec<Vec<Tongue>> = try_map(batch, one)?;
            for part in &parts {
                see(part)?;
            }
            if !alone {
                watch.advance(batch.len() as u64);
            }
        }
        Ok(())
    }

    fn of_ratio(&self, ratio: Ratio, watch: &dyn Progress) -> Result<Vec<Tongue>> {
        let tongues = Tongues::new(ratio, &self.stiffness.rho)?;
        let window = self.stiffness.lambda1.as_ref().and_then(|lambda1| self.window.of_ratio(ratio, lambda1));
        let gaps = tongues.select(&Selection {
            s: window.or_else(|| self.selection.s.clone()),
            ..self.selection.clone()
        })?;
        watch.expect(gaps.len() as u64);
        let chunk = |gaps: &&[Gap]| {
            let answers = self.request.answers(&tongues, gaps);
            watch.advance(gaps.len() as u64);
            answers
        };
        let parts: Vec<Vec<Tongue>> = try_map(&gaps.chunks(CHUNK).collect::<Vec<_>>(), chunk)?;
        Ok(parts.into_iter().flatten().collect())
    }
}
