//! All unstable intervals of dt of a large scheme with one level: between resonances of its fine part the stable steps are one interval
//! (proofs/LOCAL_STEPS.md).
//!
//! With the fine part F of A, y and u its eigenvalues and vectors, θ of the substep, 4 sin²(θ/2) = (dt/p)² y, and B what couples it to the coarse
//! part C, Schur's complement of 4 − f with respect to the fine part is, where all (dt/p)² y < 4,
//!
//! ```text
//!     R(dt²) = 4 − dt² (C − B F⁻¹ Bᵀ) − 4 Σ_k tan²(p θ_k/2) b_k b_kᵀ,      b_k = B u_k/y_k,
//! ```
//!
//! and 4 − f > 0 iff R > 0. 1 + cos(p θ) has real roots alone as a polynomial in dt², all double but the last, so its reciprocal is convex between
//! them, and so is tan²(p θ/2) = 2/(1 + cos p θ) − 1. Hence each xᵀ R x is concave between resonances, where no p θ_k is an odd multiple of π, and **the
//! stable steps between two neighbouring resonances are one interval**; the first one begins at 0. At a resonance f has an eigenvalue 4 or more, so it is
//! unstable, and so is every step beyond the one where the fastest fine motion has θ = π. f ≥ 0 up to there, and f is singular only where some p θ_k is
//! an even multiple of π. Resonances are counted by the inertia of F.

use super::scheme::Level;
use super::sparse::{Block, SparseSteps};
use crate::error::{Error, Result};
use crate::number::{U, bisected};
use crate::parallel::try_map;
use crate::system::vary::stretches::{Stretch, check_width, merged};
use crate::system::verdict::measured::Holds;

/// The relative width within which the first unstable step is sought.
const WIDTH: f64 = 1e-4;

/// Beside the resolution: how much sharper edges are, and how much narrower the places of resonances.
const SHARPER: f64 = 0.1;
const NARROWER: f64 = 0.25;

/// Steps between two resonances that are tried for a stable one.
const TRIED: u32 = 4;

/// A resonance of the fine part: 4 sin²(p θ..)'s argument (dt/p)² y, and whether p θ is an odd multiple of π there.
#[derive(Clone, Copy, Debug)]
struct Mark {
    z: f64,
    is_odd: bool,
}

/// Steps within which resonances are, at most so many odd ones and even ones.
#[derive(Clone, Copy, Debug)]
struct Place {
    lo: f64,
    hi: f64,
    odd: usize,
    even: usize,
}

impl Block {
    /// An upper bound on the number of eigenvalues in \[lo, hi\]; `None` where counts cannot decide.
    fn within(&self, lo: f64, hi: f64) -> Option<usize> {
        let terms = [(1.0, self.values.as_slice())];
        let below = |c: f64, up: f64| {
            let mut by = 2.0 * self.error + 16.0 * U * c;
            for _ in 0..3 {
                let (count, off) = self.pattern.negative(c + up * by, &terms)?;
                if by > 1.01 * (off + self.error) + 8.0 * U * c {
                    return Some(count);
                }
                by = 1.1 * (1.01 * (off + self.error) + 8.0 * U * c);
            }
            None
        };
        Some(below(hi, 1.0)?.saturating_sub(below(lo, -1.0)?))
    }
}

impl SparseSteps {
    /// The only level, and its fine part.
    fn one(&self) -> Option<(&Level, &Block)> {
        let [level] = &self.levels[..] else { return None };
        self.fine.as_ref().map(|fine| (level, fine))
    }

    /// (dt/p)² y of the odd and the even multiples of π, below 4.
    fn marks(substeps: u32) -> Vec<Mark> {
        let p = f64::from(substeps);
        let mark = |k: u32| Mark {
            z: 4.0 * (f64::from(k) * std::f64::consts::PI / (2.0 * p)).sin().powi(2),
            is_odd: k % 2 == 1,
        };
        (1..substeps).map(mark).collect()
    }

    /// Where the fastest fine motion has θ = π: every step above the second one is unstable, every resonance below it.
    fn limit(&self) -> Option<(f64, f64)> {
        let (level, fine) = self.one()?;
        let (lo, hi) = fine.largest(1e-6)?;
        let of = |y: f64| 2.0 * f64::from(level.substeps) / y.sqrt();
        Some((of(hi) * (1.0 - 4.0 * U), of(lo) * (1.0 + 4.0 * U)))
    }

    /// The resonances of steps in \[lo, hi\]: at most so many odd ones and even ones.
    fn resonances(&self, lo: f64, hi: f64) -> Option<[usize; 2]> {
        let (level, fine) = self.one()?;
        let p2 = f64::from(level.substeps).powi(2);
        let mut found = [0, 0];
        for mark in SparseSteps::marks(level.substeps) {
            found[usize::from(!mark.is_odd)] +=
                fine.within(p2 * mark.z / (hi * hi), p2 * mark.z / (lo * lo))?;
        }
        Some(found)
    }

    /// The resonances of steps in a range below the limit, by inertia, no fewer than there are: each makes an interval of unstable steps.
    pub fn count(&self, (lo, hi): (f64, f64)) -> Option<usize> {
        self.resonances(lo, hi).map(|own| own[0])
    }

    /// \[lo, hi\]: every step in (0, lo] is proven stable, some step up to hi is proven unstable; `None` where nothing is proven, or with several levels.
    ///
    /// At the first resonance f has an eigenvalue of 4 or more, however weakly that fine motion is coupled: where every step up to there is stable, hi is
    /// no more than the resonance itself is known to, and no factorization could see the interval.
    pub fn first_unstable(&self) -> Option<(f64, f64)> {
        let (level, fine) = self.one()?;
        // The first odd multiple of π is reached by the fastest fine motion: below it there is none.
        let (low, high) = fine.largest(1e-6)?;
        let z = SparseSteps::marks(level.substeps).first().map_or(4.0, |mark| mark.z);
        let at = |y: f64, round: f64| f64::from(level.substeps) * (z / y).sqrt() * (1.0 + round * 8.0 * U);
        let (top, resonance) = (at(high, -1.0), at(low, 1.0));
        let is_below = |dt: f64| self.is_proven_below_four(dt);
        // f > 0 at one step below is A > 0, and then f > 0 at all.
        let is_stable = |dt: &f64| is_below(*dt) && self.verdict(*dt) == Holds::Stable;
        let start = (0..12).map(|k| top * 0.5f64.powi(k)).find(is_stable)?;
        if start == top || is_below(top) {
            return Some((top, resonance));
        }
        let (lo, beyond) = bisected((start, top), WIDTH * SHARPER, |dt| Some(is_below(dt)));
        let mut steps = (0..40).map(|k| beyond * (1.0 + WIDTH / 16.0 * 1.5f64.powi(k)));
        let is_before = |dt: &f64| *dt < resonance;
        let told = steps.by_ref().take_while(is_before).find(|&dt| self.is_below_four(dt) == Holds::Unstable);
        Some((lo, told.unwrap_or(resonance)))
    }

    /// The verdicts on all steps from `lo` to `hi`, as stretches that cover them: between resonances two steps prove all between, and an unstable
    /// one beside a stable one all up to the resonance. No interval wider than `width` times its end is missed.
    ///
    /// # Errors
    /// An empty range or one that begins below 10^-150, a width outside \[10^-9, 1/10\]; several levels; where doubles do not bound the resonances.
    pub fn stretches(&self, (lo, hi): (f64, f64), width: f64) -> Result<Vec<Stretch>> {
        check_width(width)?;
        // The squares of smaller steps are no normal numbers.
        if !(lo >= 1e-150 && lo < hi && hi.is_finite()) {
            let remedy = "write the smaller step first, both 1e-150 or more";
            return Err(Error::input("range", format!("{lo}..{hi}"), remedy));
        }
        let Some((from, to)) = self.limit() else {
            let found = match &self.levels[..] {
                [own] if own.fine.is_empty() => "none fine",
                [_] => "a fine part whose forces vanish",
                _ => "several",
            };
            let remedy = "give one level with forces on its fine part: intervals of so large a scheme are known for that alone";
            return Err(Error::input("levels", found, remedy));
        };
        let end = from.min(hi);
        let mut found = Vec::new();
        if lo < end {
            let mut places = Vec::new();
            self.places((lo, end), NARROWER * width * lo, &mut places);
            let starts = std::iter::once(lo).chain(places.iter().map(|own| own.hi));
            let ends = places.iter().map(|own| own.lo).chain([end]);
            let gaps: Vec<_> = starts.zip(ends).collect();
            // Every fine motion has (dt/p)² y < 4 at `lo`, so its first resonance is no earlier than this.
            let least = SparseSteps::marks(self.substeps()).first().map_or(1.0, |mark| 0.49 * mark.z.sqrt());
            let is_first = self.resonances(lo * least, lo) == Some([0, 0]);
            let solve = |&(k, gap): &(usize, (f64, f64))| Ok(self.gap(gap, width, k == 0 && is_first));
            let solved: Vec<Vec<Stretch>> =
                try_map(&gaps.into_iter().enumerate().collect::<Vec<_>>(), solve)?;
            for (k, own) in solved.into_iter().enumerate() {
                if let Some(place) = k.checked_sub(1).map(|k| places[k]) {
                    found.push(self.at_place(&place, found.last(), own.first()));
                }
                found.extend(own);
            }
        }
        let rest = [(end.max(lo), to.clamp(lo, hi), Holds::NotTold), (to.clamp(lo, hi), hi, Holds::Unstable)];
        let rest =
            rest.into_iter().filter(|own| own.0 < own.1).map(|(lo, hi, verdict)| Stretch { lo, hi, verdict });
        Ok(merged(found.into_iter().chain(rest)))
    }

    /// Where resonances are, no wider than `floor`; between them there are none for sure.
    fn places(&self, (lo, hi): (f64, f64), floor: f64, found: &mut Vec<Place>) {
        let own = self.resonances(lo, hi);
        if own == Some([0, 0]) {
            return;
        }
        if hi - lo <= floor {
            // Counts reach a little beyond both ends: two neighbours may hold the same resonance, or two, which only both together decide.
            let last = found.pop_if(|last| last.hi == lo);
            let lo = last.map_or(lo, |last| last.lo);
            let own = if last.is_some() { self.resonances(lo, hi) } else { own };
            let [odd, even] = own.unwrap_or([usize::MAX; 2]);
            found.push(Place { lo, hi, odd, even });
            return;
        }
        let middle = lo + (hi - lo) / 2.0;
        self.places((lo, middle), floor, found);
        self.places((middle, hi), floor, found);
    }

    /// The verdict that is proven for the steps about resonances, given those beside them: one odd resonance between unstable steps is unstable.
    fn at_place(&self, place: &Place, before: Option<&Stretch>, after: Option<&Stretch>) -> Stretch {
        let is_unstable = |own: Option<&Stretch>| own.is_some_and(|own| own.verdict == Holds::Unstable);
        let is_one = place.odd == 1 && place.even == 0 && is_unstable(before) && is_unstable(after);
        let verdict = if is_one { Holds::Unstable } else { Holds::NotTold };
        Stretch { lo: place.lo, hi: place.hi, verdict }
    }

    /// Between two resonances; the first gap begins with stable steps.
    fn gap(&self, (a, b): (f64, f64), width: f64, is_first: bool) -> Vec<Stretch> {
        let whole = |verdict| vec![Stretch { lo: a, hi: b, verdict }];
        let [left, right] = [a, b].map(|dt| self.verdict(dt));
        match (left, right) {
            (Holds::Stable, Holds::Stable) => return whole(Holds::Stable),
            (Holds::Unstable, _) if is_first => return whole(Holds::Unstable),
            _ => {}
        }
        let tried = (1..=TRIED)
            .flat_map(|k| (1..1u32 << k).step_by(2).map(move |i| f64::from(i) / f64::from(1u32 << k)));
        let tried = [0.0, 1.0].into_iter().chain(tried).map(|share| a + (b - a) * share);
        let tried = tried.take_while(|_| b - a > 0.0).take(if b - a > width * b { usize::MAX } else { 3 });
        let Some(stable) = tried.into_iter().find(|&dt| self.verdict(dt) == Holds::Stable) else {
            return whole(Holds::NotTold);
        };
        let mut all = Vec::new();
        let [(lo, below), (hi, above)] = [a, b].map(|end| self.edge(stable, end, width * SHARPER * b));
        all.extend(below.map(|own| Stretch { lo: a, hi: own, verdict: Holds::Unstable }));
        all.push(Stretch { lo: below.unwrap_or(a), hi: lo, verdict: Holds::NotTold });
        all.push(Stretch { lo, hi, verdict: Holds::Stable });
        all.push(Stretch { lo: hi, hi: above.unwrap_or(b), verdict: Holds::NotTold });
        all.extend(above.map(|own| Stretch { lo: own, hi: b, verdict: Holds::Unstable }));
        all.into_iter().filter(|own| own.lo < own.hi).collect()
    }

    /// From a stable step towards one end of its gap: the last proven stable, and the first proven unstable, between which all to the end are.
    fn edge(&self, stable: f64, end: f64, sharp: f64) -> (f64, Option<f64>) {
        let (mut inner, mut outer) = (stable, end);
        if self.is_proven_below_four(end) {
            return (end, None);
        }
        while (outer - inner).abs() > sharp {
            let middle = inner + (outer - inner) / 2.0;
            if self.is_proven_below_four(middle) { inner = middle } else { outer = middle }
        }
        let mut by = 0.0;
        loop {
            let at = outer + (end - outer).signum() * by;
            if by > (end - outer).abs() {
                return (inner, None);
            }
            if self.is_below_four(at) == Holds::Unstable {
                return (inner, Some(at));
            }
            by = (2.0 * by).max(sharp);
        }
    }
}
