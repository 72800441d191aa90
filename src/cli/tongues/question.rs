//! Which tongues are asked for, and what of them.

use crate::parallel::*;
use indicatif::ProgressBar;

use crate::cli::args::{Common, shown_range};
use crate::cli::progress::progress;
use crate::cli::ratios::Ratios;
use crate::error::{Error, Result};
use crate::number::ExactSign;
use crate::number::{Laurent, Ratio, Rational, Sign};
use crate::report::document::Document;
use crate::report::tongues::{Frame, Told};
use crate::tongue::{Gap, Selection, Tongues};

/// ρ, and the stiffnesses where they are given.
#[derive(Clone, Debug)]
pub struct Stiffness {
    pub rho: Rational,
    pub lambda1: Option<Laurent>,
    /// Given in place of ρ.
    pub lambda2: Option<Laurent>,
}

/// A closed range of steps.
pub type Range = (Laurent, Laurent);

/// Closed ranges of h1 and h2.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Window {
    pub h1: Option<Range>,
    pub h2: Option<Range>,
}

/// All that `tongues` asks.
#[derive(Clone, Debug)]
pub struct Question {
    pub ratios: Ratios,
    pub stiffness: Stiffness,
    pub window: Window,
    /// Without the window, which is one of steps.
    pub selection: Selection,
    pub frame: Frame,
}

/// The largest p + q of all ratios: there are 1.2 million of them below 2000.
pub const MOST_SUM: u64 = 2000;

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
                return Err(Error::missing("rho", "give --rho R, or --lambda1 X and --lambda2 Y"));
            }
        };
        Ok(Stiffness { rho, lambda1, lambda2 })
    }
}

impl Window {
    /// The range of s = h1² L1 for one ratio, from both ranges of steps: h1 = h2 q/p. Ends rounded outward.
    fn of_ratio(&self, ratio: Ratio, lambda1: &Laurent) -> Option<(f64, f64)> {
        let back = Laurent::from_rational(ratio.inverse().into());
        let from_h2 = self.h2.as_ref().map(|(lo, hi)| (lo * &back, hi * &back));
        let (lo, hi) = match (self.h1.clone(), from_h2) {
            (None, None) => return None,
            (Some(range), None) | (None, Some(range)) => range,
            (Some((a, b)), Some((c, d))) => (a.max(c), b.min(d)),
        };
        let zero = Laurent::from_integer(0);
        if hi < lo.clone().max(zero.clone()) {
            return Some((1.0, 0.0)); // empty
        }
        let s = |h1: Laurent| &(&h1 * &h1) * lambda1;
        Some((s(lo.max(zero)).enclose_f64().0, s(hi).enclose_f64().1))
    }
}

impl Question {
    /// The question, if it makes sense.
    ///
    /// # Errors
    /// A window without L1, labels that the one ratio does not have, and what [`Tongues::new`] refuses.
    pub fn new(
        ratios: Ratios,
        stiffness: Stiffness,
        window: Window,
        selection: Selection,
        mut frame: Frame,
    ) -> Result<Self> {
        if window != Window::default() && stiffness.lambda1.is_none() {
            return Err(Error::missing("lambda1", "a window of h1 or h2 needs it: s = h1^2 lambda1"));
        }
        let ratio = ratios.list()[0];
        let first = Tongues::new(ratio, &stiffness.rho)?;
        if ratios == Ratios::One(ratio) {
            first.check_labels(&selection)?;
        }
        frame.wanted.family = true;
        frame.lambda1 = stiffness.lambda1.clone();
        Ok(Question { ratios, stiffness, window, selection, frame })
    }

    /// Hands on the tongues in the order of p + q, p, m: in parts, computed in parallel.
    ///
    /// # Errors
    /// Where a schedule is too long, and those of `see`.
    pub fn each(&self, common: &Common, mut see: impl FnMut(&[Told]) -> Result<()>) -> Result<()> {
        let ratios = self.ratios.list();
        // Of one ratio the tongues are counted, once it is known how many there are.
        let alone = ratios.len() == 1;
        let bar = progress(common.quiet, ratios.len() as u64, if alone { "tongues" } else { "ratios" });
        let one = |&ratio: &Ratio| self.of_ratio(ratio, alone.then_some(&bar));
        for batch in ratios.chunks(BATCH) {
            let parts: Vec<Vec<Told>> = batch.par_iter().map(one).collect::<Result<_>>()?;
            for part in &parts {
                see(part)?;
            }
            bar.inc(if alone { 0 } else { batch.len() as u64 });
        }
        bar.finish_and_clear();
        Ok(())
    }

    fn of_ratio(&self, ratio: Ratio, bar: Option<&ProgressBar>) -> Result<Vec<Told>> {
        let tongues = Tongues::new(ratio, &self.stiffness.rho)?;
        let window = self.stiffness.lambda1.as_ref().and_then(|lambda1| self.window.of_ratio(ratio, lambda1));
        let gaps = tongues.select(&Selection { s: window, ..self.selection.clone() })?;
        if let Some(bar) = bar {
            bar.set_length(gaps.len() as u64);
        }
        let chunk = |gaps: &[Gap]| {
            let told = gaps.iter().map(|gap| self.frame.told(&tongues, gap)).collect();
            if let Some(bar) = bar {
                bar.inc(gaps.len() as u64);
            }
            told
        };
        let parts: Vec<Vec<Told>> = gaps.par_chunks(CHUNK).map(chunk).collect::<Result<_>>()?;
        Ok(parts.into_iter().flatten().collect())
    }

    /// Echoes the question, exactly.
    pub fn echo(&self, document: Document) -> Document {
        let Stiffness { rho, lambda1, lambda2 } = &self.stiffness;
        let range = |range: &Option<Range>| range.as_ref().map(shown_range);
        let integers = |range: Option<(i64, i64)>| range.map(|(lo, hi)| format!("{lo}..{hi}"));
        let Selection { m, a, b, .. } = &self.selection;
        let given = [
            ("rho", Some(rho.to_string())),
            ("lambda1", lambda1.as_ref().map(ToString::to_string)),
            ("lambda2", lambda2.as_ref().map(ToString::to_string)),
            ("h1_range", range(&self.window.h1)),
            ("h2_range", range(&self.window.h2)),
            ("m", m.as_ref().map(|list| shown_list(list))),
            ("a", integers(*a)),
            ("b", integers(*b)),
            ("digits", self.frame.digits.map(|digits| digits.to_string())),
        ];
        given.into_iter().fold(self.ratios.echo(document), |document, (key, value)| match value {
            Some(value) => document.input(key, value),
            None => document,
        })
    }

    /// The question in words.
    pub fn words(&self) -> String {
        format!("{} at rho = {}", self.ratios.words(), self.stiffness.rho)
    }
}

/// A list of labels as it is written: `1,4..7`.
pub fn shown_list(list: &[(u64, u64)]) -> String {
    let shown =
        |&(from, upto): &(u64, u64)| if from == upto { from.to_string() } else { format!("{from}..{upto}") };
    list.iter().map(shown).collect::<Vec<_>>().join(",")
}
