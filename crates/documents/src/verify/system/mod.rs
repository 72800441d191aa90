//! Documents of systems: computed again as a whole, then checked by another route.
//!
//! Equal inputs give equal documents, so every value is compared with the one computed again. That finds any
//! change made afterwards. Errors made from the start are looked for by exact arithmetic (the kind) and by
//! the dense full period in doubles (multipliers, runs of linear systems).

mod apart;
mod dense;
mod implicit;
pub mod intervals;
mod levels;
mod local;

use super::again::{Left, Recheck, asked};
use super::context::{Checked, Context, Fault, Outcome, same, too_costly};
use super::sample::sample;
use crate::input::SystemScene;
use crate::question::{Found, Simulate, System, SystemAnswer};
use crate::report::system::SystemMap;
use clocks::verdict::Kind;
use number::error::{Kind as Reason, Result};
use number::rational::to_f64;
use systems::avi::Ends;
use systems::{Analysis, Limits, Model, SchemeSummary, SparseSteps};

/// Points of a map whose kind is decided by the other route (where it costs no more than is allowed), unless
/// all are.
const POINTS: u64 = 200;

/// `kickdrift/system-verdict/1` or `kickdrift/system-map/1`.
#[derive(Clone, Debug, serde::Deserialize)]
pub struct Claim {
    input: System,
}

/// `kickdrift/simulate/1`.
#[derive(Clone, Debug, serde::Deserialize)]
pub struct Simulated {
    input: Simulate,
}

/// The file is a name.
const LEFT: &[Left] = &[("input.file", "a name")];

/// The outcome of another route for the whole document.
fn outcome(context: &Context, route: &'static str, other: Checked) -> Result<Outcome> {
    let failures = context.failure(0, || "the document".into(), other)?.into_iter().collect();
    Ok(Outcome { rows: 1, route, sample: None, failures, not_rechecked: Vec::new() })
}

/// Where there is no other route.
const ALONE: &str = "none: every value is computed again, by the same route";

impl Recheck for Claim {
    const TABLE: &'static str = "rows";
    const LEFT: &'static [Left] = LEFT;
    asked!(System);

    fn check(&self, SystemAnswer { scene, found }: SystemAnswer, context: &Context) -> Result<Outcome> {
        match found {
            Found::Verdict(decided) => verdict(&scene, &decided.analysis, decided.local.as_ref(), context),
            Found::Map(map) => self.points(&scene, &map, context),
            Found::Intervals(_) => outcome(context, ALONE, Ok(())),
        }
    }
}

fn verdict(
    scene: &SystemScene,
    analysis: &Analysis,
    local: Option<&SchemeSummary>,
    context: &Context,
) -> Result<Outcome> {
    if let Model::Sparse(sparse_system) = scene.model() {
        if let Some((sparse_levels, outer)) = sparse_system.levels() {
            let (checked, unseen) = levels::run(sparse_levels, outer, analysis);
            return Ok(Outcome { not_rechecked: unseen, ..outcome(context, levels::ROUTE, checked)? });
        }
        let Some(steps) = sparse_system.local_steps() else { return outcome(context, ALONE, Ok(())) };
        let checked = local::sparse(steps, to_f64(&scene.model().steps()[0]), analysis, local);
        return Ok(seen(steps, outcome(context, RUN, checked)?));
    }
    if let Some(measured) = &analysis.measured {
        let (limits, route) = (context.work().products(), dense::Stands::of(scene, measured)?);
        let checked = dense::growth(scene, analysis, &limits).and_then(|()| route.check(&limits));
        return match checked {
            Err(Fault::Error(error)) if error.kind() == Reason::Budget => {
                let mut found = outcome(context, ALONE, Ok(()))?;
                found
                    .not_rechecked
                    .push(too_costly("the growth rate and how far the verdict stands", &error));
                Ok(found)
            }
            checked => {
                let mut found = outcome(context, route.name(), checked)?;
                found.not_rechecked.extend(route.unseen());
                Ok(found)
            }
        };
    }
    let traces = || {
        apart::exactly(scene, analysis)?;
        scene.model().local_steps().map_or(Ok(()), local::steps)?;
        scene
            .model()
            .implicit()
            .map_or(Ok(()), |implicit_explicit| implicit::in_doubles(implicit_explicit, analysis))?;
        dense::traces(scene, analysis)
    };
    match exact_kind(scene, analysis.kind, &context.work().products())? {
        Some(truth) => {
            let route = match scene.model() {
                Model::LocalSteps(_) => {
                    "the scheme substep by substep, the kind in exact arithmetic, multipliers by the traces of the full period"
                }
                _ => {
                    "the kind in exact arithmetic, multipliers by the traces of the dense full period and of its square"
                }
            };
            outcome(context, route, same_kind(analysis.kind, truth).and_then(|()| traces()))
        }
        None => {
            let route = match scene.model() {
                Model::Pi(_) => "multipliers by the traces of the dense full period and of its square",
                _ => {
                    "multipliers by the traces of the dense full period and of its square (exact arithmetic would cost \
                     more than is allowed)"
                }
            };
            outcome(context, route, traces())
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
    if matches!(scene.model(), Model::Pi(_)) && claimed.is_none() {
        return Ok(None);
    }
    match scene.model().exact_kind(limits) {
        Ok(value) => Ok(Some(value)),
        Err(error) if error.kind() == Reason::Budget => Ok(None),
        Err(error) => Err(error),
    }
}

impl Claim {
    fn points(&self, scene: &SystemScene, map: &SystemMap, context: &Context) -> Result<Outcome> {
        let (of, limits) = (map.points.len() as u64, context.work().products());
        if matches!(scene.model(), Model::Sparse(_)) {
            return outcome(context, ALONE, Ok(()));
        }
        let mut outcome =
            outcome(context, "the kind of a random sample of points in exact arithmetic", Ok(()))?;
        let Some(axes) = self.input.scan(scene)? else { return Ok(outcome) };
        let most = if context.options.all { of } else { POINTS };
        let mut decided = 0;
        for n in sample(&scene.source().to_string(), of, most) {
            let point = &map.points[n as usize];
            let (x, y) = &point.at;
            let Some(truth) = exact_kind(&axes.at(x, y)?, point.kind, &limits)? else { continue };
            decided += 1;
            let values = || map.names.iter().zip([x, y]).map(|(name, value)| format!("{name} = {value}"));
            let place = || values().collect::<Vec<_>>().join(", ");
            outcome.failures.extend(context.failure(n + 1, place, same_kind(point.kind, truth))?);
        }
        (outcome.rows, outcome.sample) = (of, Some((decided, of)));
        Ok(outcome)
    }
}

impl Recheck for Simulated {
    const TABLE: &'static str = "series";
    const LEFT: &'static [Left] = LEFT;
    asked!(Simulate);

    fn check(&self, found: Self::Found, context: &Context) -> Result<Outcome> {
        if found.run.linear && self.input.form == Ends::Symmetric {
            let route = "the amplitudes by powers of the dense full period";
            let checked = dense::linear_run(&found.scene, &self.input.displace, &found.run);
            return outcome(context, route, checked);
        }
        outcome(context, ALONE, Ok(()))
    }
}

/// Kinds agree, undecided parts excluded.
fn same_kind(found: Option<Kind>, truth: Kind) -> Checked {
    same("kind", found.map_or("not decided", Kind::name), truth.name())
}
