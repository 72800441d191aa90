//! Sparse stiffnesses of thousands of degrees of freedom: the first stable region of two levels; local time
//! steps of one.

use std::sync::Arc;

use num_complex::Complex64;

use crate::levels::sparse::SparseLevels;
use crate::levels::{Method, Outer};
use crate::linear::system::System;
use crate::lts::{Growth, SparseSteps};
use crate::spectrum::modes::Origin;
use crate::spectrum::rate::{Multiplier, per_time};
use crate::verdict::analysis::{Analysis, Evidence, Instability, Part};
use crate::verdict::decide::decide_by;
use crate::verdict::limits::{Limits, Route, degrees_of_freedom};
use crate::verdict::measured::{Holds, Measured, Removed, check_accuracy};
use clocks::verdict::Kind;
use number::error::Kind as Reason;
use number::{Error, Laurent, Rational, Result, to_f64};

/// Sparse stiffnesses with their steps.
#[derive(Clone, Debug)]
pub struct SparseSystem {
    pub(super) kind: SparseKind,
    pub(super) step: Rational,
    /// With the size and the clocks alone.
    pub(super) clocks: System,
}

#[derive(Clone, Debug)]
pub(super) enum SparseKind {
    /// Two levels, and how well they are known.
    Levels { levels: Arc<SparseLevels>, outer: Outer, accuracy: f64, removed: Option<Removed> },
    /// One stiffness, with local time steps.
    Steps(Box<SparseSteps>),
}

/// The note on two levels: what is decided of them, and what does more.
const FIRST: &str = "of sparse stiffnesses the first stable region is decided, and nothing above it: take smaller outer steps, or give dense stiffnesses, \
                     which are decided at every step";

/// The note on two levels that are unstable.
const NO_MODE: &str = "the mode that ends the first stable region grows at this step (proven): how fast, and what else grows, is not computed of sparse \
                       stiffnesses; dense ones have it";

/// The note on local time steps.
const FASTEST: &str = "of sparse stiffnesses only the motion that grows fastest is computed";

const TOGETHER: &str = "the rows of the stiffness sum to 0 within the rounding of their entries, so all may move together: that motion is set apart";

/// The note on a small system that sparse factorizations do not decide.
const EXACTLY: &str = "decided as a dense system: sparse factorizations in doubles do not prove it";

/// Factorizations that an answer takes, roughly, with all else.
const FACTORIZATIONS: f64 = 6.0;

/// Those that one of two levels takes.
const OF_LEVELS: f64 = 3.0;

/// By so many times a product of theirs, in dense blocks, is faster than one of an eigenvalue iteration, as
/// measured on droplets of 500 and 2,000 waters.
const FASTER: f64 = 100.0;

impl SparseSystem {
    /// From two levels with an inner step and a multiple of it, each stiffness known to `accuracy` times its
    /// norm; answers name the motions that were set apart.
    ///
    /// # Errors
    /// An outer step that is no multiple of the inner one, an accuracy that is not in (0, 1/10), motions set
    /// apart that a stiffness holds.
    pub fn new(
        levels: SparseLevels,
        steps: [&Rational; 2],
        accuracy: f64,
        removed: Option<Removed>,
    ) -> Result<SparseSystem> {
        check_accuracy(accuracy)?;
        if removed.is_some() {
            levels.check_rigid(accuracy)?;
        }
        SparseSystem::of_levels(Arc::new(levels), steps, accuracy, removed)
    }

    fn of_levels(
        levels: Arc<SparseLevels>,
        [inner, outer]: [&Rational; 2],
        accuracy: f64,
        removed: Option<Removed>,
    ) -> Result<SparseSystem> {
        let clocks = System::of_clocks(levels.size(), [inner, outer].map(Clone::clone))?;
        let at = Outer::of_steps(inner, outer).ok_or_else(|| {
            Error::input(
                "step",
                outer,
                format!("the outer step of sparse stiffnesses is a multiple of the inner one, {inner}"),
            )
        })?;
        Ok(SparseSystem {
            kind: SparseKind::Levels { levels, outer: at, accuracy, removed },
            step: outer.clone(),
            clocks,
        })
    }

    /// Local time steps in a step.
    ///
    /// # Errors
    /// A step that is not positive.
    pub fn with_local_steps(steps: SparseSteps, step: &Rational) -> Result<SparseSystem> {
        SparseSystem::of_one(steps.size(), SparseKind::Steps(Box::new(steps)), step)
    }

    pub(super) fn of_one(n: usize, kind: SparseKind, step: &Rational) -> Result<SparseSystem> {
        Ok(SparseSystem { kind, step: step.clone(), clocks: System::of_clocks(n, [step.clone()])? })
    }

    /// Both levels with the outer step, where it has them.
    pub fn levels(&self) -> Option<(&SparseLevels, &Outer)> {
        match &self.kind {
            SparseKind::Levels { levels, outer, .. } => Some((levels, outer)),
            _ => None,
        }
    }

    /// Where it has local time steps.
    pub fn local_steps(&self) -> Option<&SparseSteps> {
        match &self.kind {
            SparseKind::Steps(sparse_steps) => Some(sparse_steps),
            _ => None,
        }
    }

    /// This system with another accuracy.
    ///
    /// # Errors
    /// One that is not in (0, 1/10).
    pub fn at_accuracy(self, accuracy: f64) -> Result<SparseSystem> {
        check_accuracy(accuracy)?;
        match self.kind {
            SparseKind::Levels { levels, outer, removed, .. } => {
                if removed.is_some() {
                    levels.check_rigid(accuracy)?;
                }
                Ok(SparseSystem { kind: SparseKind::Levels { levels, outer, accuracy, removed }, ..self })
            }
            SparseKind::Steps(_) => {
                Err(Error::input("accuracy", accuracy, "has no meaning with local steps: leave it out"))
            }
        }
    }

    /// Takes over the accuracy of two other levels.
    pub fn copy_settings_from(&mut self, other: &SparseSystem) {
        if let (SparseKind::Levels { accuracy, .. }, SparseKind::Levels { accuracy: value, .. }) =
            (&mut self.kind, &other.kind)
        {
            *accuracy = *value;
        }
    }

    /// Both levels with other steps; what is known of their stiffnesses stays known. `None` for local time
    /// steps.
    pub fn with_steps(&self, steps: [&Rational; 2]) -> Option<Result<SparseSystem>> {
        let SparseKind::Levels { levels, accuracy, removed, .. } = &self.kind else { return None };
        Some(SparseSystem::of_levels(Arc::clone(levels), steps, *accuracy, removed.clone()))
    }

    /// Products, at the pace of eigenvalue iterations.
    pub(super) fn products(&self) -> u64 {
        let products = match &self.kind {
            SparseKind::Levels { levels, .. } => OF_LEVELS * levels.products(),
            SparseKind::Steps(sparse_steps) => FACTORIZATIONS * sparse_steps.products(),
        };
        (products / FASTER).min(1e19) as u64
    }

    pub(super) fn allow(&self, limits: &Limits) -> Result<()> {
        limits.allow(self.products(), || {
            format!("factorizations of {}", degrees_of_freedom(self.clocks.size()))
        })
    }

    /// The verdict, how far it stands, and where the first region ends.
    pub(super) fn decided(&self, limits: &Limits) -> Result<Analysis> {
        self.allow(limits)?;
        let (levels, outer, accuracy, removed) = match &self.kind {
            SparseKind::Levels { levels, outer, accuracy, removed } => (levels, outer, *accuracy, removed),
            SparseKind::Steps(sparse_steps) => return self.of_steps(sparse_steps, limits),
        };
        levels.look(outer.inner_steps());
        let margin = if levels.is_unstable(outer, 0.0) { None } else { levels.margin(outer) };
        let verdict = margin.map_or_else(|| levels.verdict(outer, 0.0), |_| Holds::Stable);
        // Of the first region nothing is proven of all stiffnesses within more than the margin.
        let holds = match margin {
            Some(margin) if accuracy <= margin => Holds::Stable,
            None if levels.is_unstable(outer, accuracy) => Holds::Unstable,
            _ => Holds::Undecided,
        };
        let first_unstable = levels.first_unstable(outer.inner_steps());
        let part = self.of_levels_part(verdict);
        let measured = Some(Measured {
            method: Method::default().name(),
            accuracy,
            holds,
            margin,
            first_unstable,
            is_above_unstable: first_unstable.is_some_and(|(_, hi)| outer.step() > hi),
            removed: removed.clone(),
        });
        let mut notes = vec![if verdict == Holds::Unstable { NO_MODE } else { FIRST }.to_string()];
        notes.extend(falls(levels, outer));
        Ok(Analysis { measured, ..Analysis::of_part(part, 2, notes) })
    }

    /// A verdict on two levels, without modes.
    pub(super) fn of_levels_part(&self, verdict: Holds) -> Part {
        let period = Laurent::from_rational(self.step.clone());
        Part::new(self.clocks.size(), period, decided(verdict), Default::default())
    }

    /// The verdict on local time steps, and what grows fastest.
    pub(super) fn of_steps(&self, sparse_steps: &SparseSteps, limits: &Limits) -> Result<Analysis> {
        let (dt, period) = (to_f64(&self.step), Laurent::from_rational(self.step.clone()));
        let verdict = sparse_steps.verdict(dt);
        if verdict == Holds::Undecided
            && let Some(found) = self.exactly(sparse_steps, limits)?
        {
            return Ok(found);
        }
        let growth = if verdict == Holds::Unstable { sparse_steps.growth(dt) } else { None };
        let largest = growth.as_ref().map(|growth| growth.rate);
        let growing = growth.map(|growth| {
            let Growth { excess: (lo, hi), rate, is_above, shape } = growth;
            // f = −4 μ.
            let mu = (lo + hi) / 8.0;
            let mu = Complex64::new(if is_above { -1.0 - mu } else { mu }, 0.0);
            let multiplier = Multiplier::new(mu, Some((hi - lo) / 8.0 * (1.0 + 1e-9)), Some(rate));
            let quadrature = vec![0.0; shape.len()];
            let growth_rate = Some(per_time(rate, &period));
            Instability {
                multiplier,
                origin: Origin::RealPair,
                growth_rate,
                shape,
                quadrature,
                resonance: None,
            }
        });
        let (multipliers, instabilities) =
            growing.map(|growing| (growing.multiplier, growing)).into_iter().unzip();
        let part = Part::new(sparse_steps.size(), period, decided(verdict), (multipliers, instabilities));
        let mut notes = vec![FASTEST.into()];
        if sparse_steps.rigid_motions() > 0 {
            notes.push(TOGETHER.into());
        }
        notes.extend(sparse_steps.nearly_free().filter(|_| verdict == Holds::Undecided).map(|sums| {
            format!(
                "the rows of the stiffness sum to nearly 0 ({sums:.0e} of their entries): all together are neither clearly free nor clearly held, and \
                 nothing is proven; assemble it so that they sum to 0 to rounding, or hold a node"
            )
        }));
        Ok(Analysis::of_part(Part { largest, ..part }, 1, notes))
    }

    /// What exact arithmetic tells of a small one, where doubles tell nothing; `None` where that is too much.
    fn exactly(&self, sparse_steps: &SparseSteps, limits: &Limits) -> Result<Option<Analysis>> {
        let Some(Ok(exact)) = sparse_steps.exactly(&self.step) else { return Ok(None) };
        match decide_by(Route::Cheapest, exact.system(), limits) {
            // What the effective stiffness leaves free at this step and K holds is not rigid.
            Ok(found) if found.rigid_modes.len() != exact.plain().rigid_modes().len() => Ok(None),
            Ok(mut found) => {
                found.warnings.push(EXACTLY.into());
                Ok(Some(found))
            }
            Err(error) if error.kind() == Reason::Budget => Ok(None),
            Err(error) => Err(error),
        }
    }
}

/// Notes where both stiffnesses together are not proven positive.
fn falls(levels: &SparseLevels, outer: &Outer) -> Vec<String> {
    let directions = match levels.unproven_directions() {
        Some(0) => return Vec::new(),
        Some(1) => "1 direction".into(),
        Some(count) => format!("{count} directions"),
        None => "directions that no factorization counts".into(),
    };
    let along = format!(
        "along {directions}, rigid motions aside, both stiffnesses together are not proven positive, as where positions are no minimum: the system \
         may fall along them at any step, however small"
    );
    let resonance = levels.first_resonance(outer.inner_steps()).map(|(lo, hi)| {
        format!(
            "apart from such falls nothing grows at any outer step up to {lo} with as many inner steps; at {hi} a resonance grows, too (both proven)"
        )
    });
    std::iter::once(along).chain(resonance).collect()
}

/// The kind, and what it rests on.
fn decided(verdict: Holds) -> (Option<Kind>, Evidence) {
    match verdict {
        Holds::Stable => (Some(Kind::Elliptic), Evidence::Signs),
        Holds::Unstable => (Some(Kind::Hyperbolic), Evidence::Signs),
        Holds::Undecided => (None, Evidence::Estimate),
    }
}
