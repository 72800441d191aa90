//! Systems: their verdicts, maps, intervals and runs by another route.
//!
//! Errors made from the start are looked for by exact arithmetic (the kind) and by the dense full period in
//! doubles (multipliers, runs of linear systems).

mod apart;
pub(super) mod bias;
mod dense;
mod implicit;
mod intervals;
mod levels;
mod local;

use super::sample::sample;
use crate::input::SystemScene;
use crate::question::{Simulate, Simulated, System, SystemAnswer, SystemFound};
use crate::report::system::SystemMap;
use crate::verify::again::Excluded;
use crate::verify::context::{ALONE, Checked, Context, Fault, Outcome, failure, same, too_costly};
use crate::verify::kind::Verify;
use clocks::verdict::Kind;
use number::error::Kind as Reason;
use number::{Result, to_f64};
use systems::avi::Ends;
use systems::levels::Method;
use systems::{Analysis, Limits, Measured, SchemeSummary, SparseSteps};

/// Points of a map whose kind is decided by the other route (where it costs no more than is allowed), unless
/// all are.
const POINTS: u64 = 200;

/// The file is a name.
const EXCLUDED: &[Excluded] = &[("input.file", "a name")];

impl Verify for System {
    const EXCLUDED: &'static [Excluded] = EXCLUDED;

    fn check(&self, SystemAnswer { scene, found }: &SystemAnswer, context: &Context) -> Result<Outcome> {
        match found {
            SystemFound::Verdict(decided) => {
                let mut found = verdict(scene, &decided.analysis, decided.local.as_ref(), context)?;
                let bias = bias::check(scene, &decided.analysis, decided.bias.as_ref());
                found.failures.extend(failure(1, bias)?);
                Ok(found)
            }
            SystemFound::Map(map) => points(self, scene, map, context),
            SystemFound::Intervals(found) => intervals::check(self, scene, found, context),
        }
    }
}

fn verdict(
    scene: &SystemScene,
    analysis: &Analysis,
    local: Option<&SchemeSummary>,
    context: &Context,
) -> Result<Outcome> {
    if let Some(sparse_system) = scene.model().sparse() {
        if let Some((sparse_levels, outer)) = sparse_system.levels() {
            let (checked, unseen) = levels::run(sparse_levels, outer, analysis);
            return Ok(Outcome { not_rechecked: unseen, ..Outcome::whole(levels::ROUTE, checked)? });
        }
        let Some(steps) = sparse_system.local_steps() else { return Outcome::whole(ALONE, Ok(())) };
        let checked = local::sparse(steps, to_f64(&scene.model().steps()[0]), analysis, local);
        return Ok(seen(steps, Outcome::whole(RUN, checked)?));
    }
    let of_many = scene.model().measured().is_ok() && scene.model().inner_steps().is_none();
    let of_any = analysis.measured.as_ref().filter(|_| of_many);
    if let Some(measured) = analysis.measured.as_ref().filter(|_| !of_many) {
        return stands(scene, analysis, measured, context);
    }
    let traces = || {
        apart::exactly(scene, analysis)?;
        scene.model().local_steps().map_or(Ok(()), local::steps)?;
        let solved_for = scene.model().plain().filter(|_| scene.model().method() != Method::Respa);
        solved_for.map_or(Ok(()), |plain| implicit::in_doubles(plain, analysis))?;
        of_any
            .map_or(Ok(()), |measured| dense::first_unstable(scene, measured, &context.work().products()))?;
        dense::traces(scene, analysis)
    };
    let mut outcome = match exact_kind(scene, analysis.kind, &context.work().products())? {
        Some(truth) => {
            let route = exact_route(scene.model().local_steps().is_some(), of_any.is_some());
            Outcome::whole(route, same_kind(analysis.kind, truth).and_then(|()| traces()))
        }
        None => {
            let route = match scene.model().is_exact() {
                false => "multipliers by the traces of the dense full period and of its square",
                _ => {
                    "multipliers by the traces of the dense full period and of its square (exact arithmetic would cost \
                     more than is allowed)"
                }
            };
            Outcome::whole(route, traces())
        }
    }?;
    outcome.not_rechecked.extend(of_any.map(|_| dense::SAME_ROUTE.into()));
    Ok(outcome)
}

/// How far a verdict on measured stiffnesses stands, and how fast it grows.
fn stands(
    scene: &SystemScene,
    analysis: &Analysis,
    measured: &Measured,
    context: &Context,
) -> Result<Outcome> {
    let (limits, route) = (context.work().products(), dense::Stands::of(scene, measured)?);
    let checked = dense::growth(scene, analysis, &limits).and_then(|()| route.check(&limits));
    match checked {
        Err(Fault::Error(error)) if error.kind() == Reason::Budget => {
            let mut found = Outcome::whole(ALONE, Ok(()))?;
            found.not_rechecked.push(too_costly("the growth rate and how far the verdict stands", &error));
            Ok(found)
        }
        checked => {
            let mut found = Outcome::whole(route.name(), checked)?;
            found.not_rechecked.extend(route.unseen());
            Ok(found)
        }
    }
}

/// The words for a kind in exact arithmetic, of a scheme of local steps, and of measured stiffnesses.
fn exact_route(has_local_steps: bool, is_measured: bool) -> &'static str {
    match (has_local_steps, is_measured) {
        (true, _) => {
            "the scheme substep by substep, the kind in exact arithmetic, multipliers by the traces of the full period"
        }
        (_, true) => {
            "the kind in exact arithmetic, multipliers by the traces of the dense full period and of its square, both sides of the \
             first unstable step by half periods of a rational system of the doubles given"
        }
        _ => {
            "the kind in exact arithmetic, multipliers by the traces of the dense full period and of its square"
        }
    }
}

/// The scheme run, of large ones.
const RUN: &str = "the scheme substep by substep, and the eigenvalues of its steps by Lanczos's recursion";

/// Names the claims that Lanczos's recursion does not see.
fn seen(steps: &SparseSteps, mut outcome: Outcome) -> Outcome {
    if steps.size() > local::SEEN {
        let what = "that no motion is less stable than the extreme ones of Lanczos's recursion: by factorizations alone";
        outcome.not_rechecked.push(what.into());
    }
    outcome
}

/// `None` where the work exceeds the limits, and where stiffnesses are known within a bound only and no kind
/// is claimed.
fn exact_kind(scene: &SystemScene, claimed: Option<Kind>, limits: &Limits) -> Result<Option<Kind>> {
    if !scene.model().is_exact() && claimed.is_none() {
        return Ok(None);
    }
    match scene.model().exact_kind(limits) {
        Ok(value) => Ok(Some(value)),
        Err(error) if error.kind() == Reason::Budget => Ok(None),
        Err(error) => Err(error),
    }
}

fn points(question: &System, scene: &SystemScene, map: &SystemMap, context: &Context) -> Result<Outcome> {
    let (count, limits) = (map.points.len() as u64, context.work().products());
    if scene.model().sparse().is_some() {
        return Outcome::whole(ALONE, Ok(()));
    }
    let mut outcome = Outcome::whole("the kind of a random sample of points in exact arithmetic", Ok(()))?;
    let Some(axes) = question.scan(scene)? else { return Ok(outcome) };
    let most = if context.options.all { count } else { POINTS };
    let mut decided = 0;
    for n in sample(&scene.source().to_string(), count, most) {
        let point = &map.points[n as usize];
        let (x, y) = &point.at;
        let Some(truth) = exact_kind(&axes.at(x, y)?, point.kind, &limits)? else { continue };
        decided += 1;
        outcome.failures.extend(failure(n + 1, same_kind(point.kind, truth))?);
    }
    (outcome.rows, outcome.sample) = (count, Some((decided, count)));
    Ok(outcome)
}

impl Verify for Simulate {
    const EXCLUDED: &'static [Excluded] = EXCLUDED;

    fn check(&self, Simulated { scene, run }: &Simulated, _: &Context) -> Result<Outcome> {
        if run.linear && self.form == Ends::Symmetric {
            let route = "the amplitudes by powers of the dense full period";
            return Outcome::whole(route, dense::linear_run(scene, &self.displace, run));
        }
        Outcome::whole(ALONE, Ok(()))
    }
}

/// Kinds agree, undecided parts excluded.
fn same_kind(found: Option<Kind>, truth: Kind) -> Checked {
    same("kind", found.map_or("not decided", Kind::name), truth.name())
}
