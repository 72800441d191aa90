//! A system's verdict, part by part, each by the cheapest means that proves it.
//!
//! 1. Connected components and rigid modes are set apart; small components whose potentials commute are split
//!    along their rational eigenvectors.
//! 2. A part of one degree of freedom is the scalar problem: two clocks go to the certified ladder of
//!    [`verdict`](clocks::verdict), more of them to doubles, balls and exact signs.
//! 3. Any other part is tried in doubles with proven discs, multiple eigenvalues in clusters; where these
//!    cannot decide, in exact arithmetic.
//! 4. Where exact arithmetic exceeds the budget and doubles prove nothing, the kind is not decided.
//!
//! The cost for n degrees of freedom: the half period ([`compose`](crate::half::compose)) and some twenty
//! products of n x n matrices for the eigenvalues and their bound; the budget error of exact arithmetic names
//! its cost.

use crate::half::compose::{self, connected_parts};
use crate::half::norm;
use crate::linear::frame::Frame;
use crate::linear::split::unit;
use crate::linear::system::System;
use crate::signs::inertia;
use crate::verdict::analysis::Analysis;
use crate::verdict::large;
use crate::verdict::limits::{Limits, Route};
use crate::verdict::piece::{Piece, pieces};
use clocks::verdict::Kind;
use number::{Laurent, Rational, Result, U};

/// The verdict on a system.
///
/// # Errors
/// A budget error of the scalar kernels. (A large part that only exact arithmetic could decide, beyond the
/// budget, is no error but not decided, with a warning.)
pub fn decide_system(system: &System, limits: &Limits) -> Result<Analysis> {
    decide_by(Route::Cheapest, system, limits)
}

/// The verdict on a system by one route.
///
/// # Errors
/// As [`decide_system`]; by [`Route::Exact`] also where exact arithmetic exceeds the budget.
pub fn decide_by(route: Route, system: &System, limits: &Limits) -> Result<Analysis> {
    decided(system, true, (route, limits))
}

/// The verdict on all systems within 2^-150 of each entry: the kind is that of this one where doubles prove
/// it, else not decided.
///
/// # Errors
/// As [`decide_system`].
pub(crate) fn decide_around(system: &System, limits: &Limits) -> Result<Analysis> {
    decided(system, false, (Route::Cheapest, limits))
}

/// Pieces, each with the degrees of freedom of the connected part that it is of, and the rigid modes.
type Apart = (Vec<(Vec<usize>, Piece)>, Vec<Vec<Rational>>);

/// The pieces of all connected parts, which are split where the system is exact.
fn apart(system: &System, is_exact: bool) -> Apart {
    let (mut all, mut rigid_modes) = (Vec::new(), Vec::new());
    for dofs in connected_parts(system) {
        let Some(component) = system.component(&dofs) else {
            rigid_modes.extend(dofs.iter().map(|&i| unit(system.size(), i)));
            continue;
        };
        let frame = Frame::new(&component);
        let place = |v: &Vec<Rational>| {
            let mut x = vec![Rational::default(); system.size()];
            dofs.iter().zip(v).for_each(|(&i, value)| x[i] = value.clone());
            x
        };
        rigid_modes.extend(frame.rigid.iter().map(|(_, v)| place(v)));
        all.extend(pieces(component, frame, is_exact).into_iter().map(|piece| (dofs.clone(), piece)));
    }
    (all, rigid_modes)
}

fn decided(system: &System, is_exact: bool, how: (Route, &Limits)) -> Result<Analysis> {
    let mut warnings = Vec::new();
    let is_indefinite = if is_exact { !system.is_total_semidefinite() } else { is_proven_indefinite(system) };
    if is_indefinite {
        warnings.push(
            "the total stiffness is indefinite: the system itself is unstable, whatever the steps".into(),
        );
    }
    let (all, rigid_modes) = apart(system, is_exact);
    let part = |(dofs, piece): (Vec<usize>, Piece)| piece.decide(system.size(), &dofs, how, &mut warnings);
    let parts = all.into_iter().map(part).collect::<Result<Vec<_>>>()?;
    let kind = severest(parts.iter().map(|part| part.kind));
    let period = Laurent::from_rational(system.period());
    let (size, clocks) = (system.size(), system.clocks().len());
    Ok(Analysis { size, clocks, period, kind, rigid_modes, parts, warnings, measured: None })
}

/// Whether the total stiffness has a negative direction, for all stiffnesses within the rounding of these to
/// doubles.
fn is_proven_indefinite(system: &System) -> bool {
    let sizes = system.stiffnesses().into_iter().map(|symmetric| norm::frobenius(&symmetric.rounded()));
    // Entries are rounded once, and added up.
    let slack = 2.0 * (1 + system.clocks().len()) as f64 * U * sizes.sum::<f64>();
    inertia::proven(&system.rounded_total(), slack).negative > 0
}

/// The kind by exact arithmetic alone, over characteristic polynomials: the severest of the parts', each over
/// its own period.
///
/// # Errors
/// A budget error, before the work on the part that exceeds it.
pub fn exact_kind(system: &System, limits: &Limits) -> Result<Kind> {
    let pieces = apart(system, true).0.into_iter();
    let kinds = pieces.map(|(_, piece)| Ok(piece.exact(limits)?.0)).collect::<Result<Vec<_>>>()?;
    Ok(kinds.into_iter().max_by_key(severity).unwrap_or(Kind::Elliptic))
}

/// The products of doubles that a verdict costs, roughly, at the pace of eigenvalue iterations: the half
/// period, and all eigenvalues with their proof; of large systems some products of matrices, which are twenty
/// times as fast.
pub fn verdict_cost(system: &System) -> u64 {
    let n = system.size() as u64;
    let per_cube = if system.size() < large::LARGE { 60 } else { 2 };
    compose::cost(system).saturating_add(n.saturating_pow(3).saturating_mul(per_cube))
}

/// The kind of a system of these parts: it grows exponentially where one of them does.
fn severest(kinds: impl Iterator<Item = Option<Kind>>) -> Option<Kind> {
    // One that is not decided may grow.
    let place = |kind: &Option<Kind>| {
        kind.as_ref().map_or(2 * severity(&Kind::Hyperbolic) - 1, |kind| 2 * severity(kind))
    };
    kinds.max_by_key(place).unwrap_or(Some(Kind::Elliptic))
}

pub(crate) fn severity(kind: &Kind) -> u8 {
    match kind {
        Kind::Elliptic => 0,
        Kind::Coexistence => 1,
        Kind::Parabolic => 2,
        Kind::Hyperbolic => 3,
    }
}
