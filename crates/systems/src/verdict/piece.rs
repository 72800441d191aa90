//! Invariant parts of a component, and the verdict on each.

use crate::exact::decide::{MuCount, decide_beside, grows_by_trace};
use crate::half::compose::check_length;
use crate::half::float;
use crate::linear::frame::Frame;
use crate::linear::sparse::dot;
use crate::linear::split::{Subspace, invariant_subspaces, may_split, whole};
use crate::linear::system::System;
use crate::signs;
use crate::single::decide as single;
use crate::spectrum::discs::Spectrum;
use crate::verdict::analysis::{Evidence, Part};
use crate::verdict::large;
use crate::verdict::limits::{Limits, Route, SIDE_BY_SIDE, degrees_of_freedom};
use clocks::verdict::Kind;
use number::error::Kind as ErrorKind;
use number::parallel::both;
use number::{Laurent, Rational, Result};

/// Components of at most this size are brought to rational normal forms before anything else.
const SMALL: usize = 16;

/// A part of a component on its way to a verdict.
pub struct Piece {
    pub system: System,
    pub frame: Frame,
    /// x = Z y in the component's coordinates; `None` for the component itself.
    pub columns: Option<Subspace>,
    /// Whether it is this system that is asked about, and not all within 2^-150 of each entry.
    pub(crate) is_exact: bool,
}

/// The component itself, or what it splits into where it is exact: subspaces that are invariant under M⁻¹
/// times each of its stiffnesses.
pub fn pieces(component: System, frame: Frame, is_exact: bool) -> Vec<Piece> {
    let is_whole = !is_exact || component.size() > SMALL;
    if is_whole || frame.rigid.is_empty() && !may_split(&component, &component.stiffnesses()) {
        let is_at_rest = frame.kept.is_empty();
        let piece = Piece { system: component, frame, columns: None, is_exact };
        return if is_at_rest { Vec::new() } else { vec![piece] };
    }
    let complement = frame.complement(&component);
    if complement.is_empty() {
        return Vec::new();
    }
    let vibrating = component.restricted(&complement);
    let subspaces = invariant_subspaces(&vibrating, &vibrating.stiffnesses())
        .unwrap_or_else(|| vec![whole(vibrating.size())]);
    let piece = |space: Subspace| {
        let system = vibrating.restricted(&space);
        let frame = Frame::whole(system.size());
        let lifted = |y: &Vec<Rational>| {
            let rows =
                (0..component.size()).map(|i| complement.iter().map(|z| z[i].clone()).collect::<Vec<_>>());
            rows.map(|row| dot(&row, y)).collect()
        };
        let columns = Some(space.iter().map(lifted).collect());
        Piece { system, frame, columns, is_exact }
    };
    subspaces.into_iter().map(piece).collect()
}

impl Piece {
    /// The verdict on the piece of a component of `n` that has the degrees of freedom `dofs`.
    pub fn decide(
        &self,
        n: usize,
        dofs: &[usize],
        how: (Route, &Limits),
        warnings: &mut Vec<String>,
    ) -> Result<Part> {
        let mut part = if self.is_exact && self.system.size() == 1 && self.frame.rigid.is_empty() {
            single::decide(&self.system, how.1)?
        } else {
            self.decide_many(how, warnings)?
        };
        let taken =
            |i: &usize| self.columns.as_ref().is_none_or(|z| z.iter().any(|z| z[*i] != Rational::default()));
        part.dofs = (0..dofs.len()).filter(taken).map(|i| dofs[i]).collect();
        for instability in &mut part.instabilities {
            self.place_shape(instability, n, dofs);
        }
        Ok(part)
    }

    fn decide_many(&self, how: (Route, &Limits), warnings: &mut Vec<String>) -> Result<Part> {
        // A part that may be refused is asked for before anything else is computed.
        let asked = (how.0 == Route::Exact).then(|| self.exact(how.1)).transpose()?;
        check_length(&self.system, how.1)?;
        if asked.is_none()
            && let Some(part) = large::decide(&self.system, &self.frame)?
        {
            warnings.push(large::NOTE.into());
            return Ok(part);
        }
        let blocks = float::half_period(&self.system, &self.frame);
        let signed = || asked.is_none().then(|| signs::proven(&blocks)).flatten();
        let (signed, spectrum) = both(blocks.size() >= SIDE_BY_SIDE, signed, || Spectrum::new(&blocks));
        let certified = || Some((spectrum.as_ref()?.certified(&blocks)?, Evidence::Discs));
        let (kind, evidence, roots) = match asked {
            Some((kind, roots)) => (Some(kind), Evidence::Exact, Some(roots)),
            None => match signed.map(|kind| (kind, Evidence::Signs)).or_else(certified) {
                Some((kind, evidence)) => (Some(kind), evidence, None),
                None => self.exact_or_not(how.1, spectrum.as_ref(), warnings)?,
            },
        };
        let multipliers = match &spectrum {
            Some(spectrum) => self.explain(spectrum, &blocks, kind, how.1),
            None => Default::default(),
        };
        let period = Laurent::from_rational(self.system.period());
        let part = Part::new(self.frame.kept.len(), period, (kind, evidence), multipliers);
        Ok(Part { roots, ..part })
    }

    /// The kind in exact arithmetic, and where the μ lie.
    pub fn exact(&self, limits: &Limits) -> Result<(Kind, MuCount)> {
        decide_beside(&self.system, &self.frame, limits).map(|exact| (exact.kind, exact.roots))
    }

    fn exact_or_not(
        &self,
        limits: &Limits,
        spectrum: Option<&Spectrum>,
        warnings: &mut Vec<String>,
    ) -> Result<(Option<Kind>, Evidence, Option<MuCount>)> {
        if !self.is_exact {
            warnings.push(format!(
                "doubles do not decide {}, and with pi in the stiffnesses nothing else does",
                degrees_of_freedom(self.frame.kept.len())
            ));
            return Ok((None, Evidence::Estimate, None));
        }
        if grows_by_trace(&self.system, &self.frame, limits) {
            return Ok((Some(Kind::Hyperbolic), Evidence::Exact, None));
        }
        let error = match (self.exact(limits), spectrum) {
            (Ok((kind, roots)), _) => return Ok((Some(kind), Evidence::Exact, Some(roots))),
            (Err(error), Some(_)) if error.kind() == ErrorKind::Budget => error,
            (Err(error), _) => return Err(error),
        };
        warnings.push(format!(
            "doubles do not decide {} (eigenvalues too close together or to the edge of stability); {error}",
            degrees_of_freedom(self.frame.kept.len())
        ));
        Ok((None, Evidence::Estimate, None))
    }
}

/// Where nothing is proven: eigenvalues of a matrix of norm 1 with a well-conditioned basis are good to some
/// 10^-12; a double eigenvalue splits by the square root of that.
pub(crate) const ROUGH: f64 = 1e-6;
