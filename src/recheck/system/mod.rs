//! Documents of systems: computed again whole, and what they claim found by another route.
//!
//! The same input gives the same document, so every value must be what it is when it is computed again. That finds what was
//! changed afterwards; what would be wrong from the start is looked for by exact arithmetic (the kind) and by the dense full
//! period in doubles (multipliers, runs of linear systems).

mod dense;

use serde_json::Value;

use super::again::{Left, Recheck};
use super::context::{Checked, Context, Outcome, REMEDY, same};
use super::sample::sample;
use super::written::{Written, positive};
use crate::avi::{Ends, Run};
use crate::error::{Error, Kind as Reason, Result};
use crate::number::Rational;
use crate::number::rational::to_f64;
use crate::report::document::Document;
use crate::report::system::{self as report, SystemMap};
use crate::scene::{Axis, Displacement, RunRequest, Scan, SystemScene};
use crate::system::scan::scan;
use crate::system::{Analysis, Limits, Route};
use crate::verdict::Kind;

/// Points of a map whose kind is decided by the other route (where it costs no more than is allowed), unless all are.
const POINTS: u64 = 200;

rows! {
    #[serde(deny_unknown_fields)]
    struct Input {
        #[serde(rename = "file")]
        _file: String,
        #[serde(rename = "title")]
        _title: String,
        system: Value,
        exact: Option<Written<bool>>,
        keep_rigid: Option<Written<bool>>,
        accuracy: Option<Written<Rational>>,
        friction: Option<Written<Rational>>,
        nearest: Option<Written<bool>>,
        scan_x: Option<String>,
        scan_y: Option<String>,
        intervals: Option<String>,
        width: Option<Written<Rational>>,
        periods: Option<Written<u64>>,
        displace: Option<String>,
        form: Option<String>,
    }
}

macro_rules! claims {
    ($($(#[$doc:meta])* $name:ident;)*) => {
        $($(#[$doc])*
        #[derive(Clone, Debug, serde::Deserialize)]
        pub struct $name {
            input: Input,
        })*
    };
}

claims! {
    /// `kickdrift/system-verdict/1`.
    Verdict;
    /// `kickdrift/system-map/1`.
    Points;
    /// `kickdrift/system-intervals/1`.
    Intervals;
    /// `kickdrift/simulate/1`.
    Simulated;
}

/// The file is a name.
const LEFT: &[Left] = &[("input.file", "a name")];

/// What another route says of the whole document.
fn outcome(context: &Context, route: &'static str, other: Checked) -> Result<Outcome> {
    let failures = context.failure(0, || "the document".into(), other)?.into_iter().collect();
    Ok(Outcome { rows: 1, route, sample: None, failures, not_rechecked: Vec::new() })
}

/// Where there is no other route.
const ALONE: &str = "none: every value is computed again, by the same route";

impl Input {
    /// The system, and what its answer may cost: a kick of the scalar ladder is some hundred products.
    fn asked(&self, context: &Context) -> Result<(SystemScene, Limits)> {
        let scene = SystemScene::from_json_in(&context.options.folder, self.system.clone())?;
        let accuracy = self.accuracy.as_ref().map(|own| to_f64(own));
        let friction = positive("input.friction", self.friction.as_ref())?;
        Ok((scene.asked(accuracy, self.keep_rigid.is_some(), friction)?, limits(context)))
    }

    /// The title is that of the system.
    fn echo(&self, document: Document, scene: &SystemScene) -> Document {
        document.input("title", scene.title())
    }

    fn route(&self) -> Route {
        if self.exact.is_some() { Route::Exact } else { Route::Cheapest }
    }
}

fn limits(context: &Context) -> Limits {
    let products = context.limits().kicks.saturating_mul(100).max(Limits::default().products);
    Limits { products, ..Limits::default() }
}

fn missing(field: &str) -> Error {
    Error::missing(field, REMEDY)
}

impl Recheck for Verdict {
    const TABLE: &'static str = "rows";
    const LEFT: &'static [Left] = LEFT;
    type Found = (SystemScene, Analysis);

    fn again(&self, context: &Context) -> Result<(Value, Self::Found)> {
        let input = &self.input;
        let (scene, limits) = input.asked(context)?;
        let analysis = scene.model().decide(input.route(), &limits)?;
        let friction = scene.friction(&limits)?;
        let orbit = match scene.own_orbit(&limits) {
            Err(error) if error.kind() == Reason::Input => None,
            found => found?,
        };
        let nearest = input.nearest.as_ref().map(|_| {
            let width = input.width.as_ref().ok_or_else(|| missing("input.width"))?;
            scene.nearest_unstable(to_f64(width), &limits)
        });
        let nearest = nearest.transpose()?;
        let (friction, orbit, nearest) = (friction.as_ref(), orbit.as_ref(), nearest.as_ref());
        let (unit, labels) = (scene.time_unit(), scene.labels());
        let beside = report::Beside { unit, friction, orbit, labels, nearest, ..report::Beside::default() };
        let again = input.echo(report::document(&analysis, &beside), &scene);
        Ok((again.value(), (scene, analysis)))
    }

    fn check(&self, (scene, analysis): Self::Found, context: &Context) -> Result<Outcome> {
        if analysis.measured.is_some() {
            let route = "the growth rate by the eigenvalues of the dense full period";
            return outcome(context, route, dense::growth(&scene, &analysis));
        }
        let traces = || dense::traces(&scene, &analysis);
        match within(scene.model().exact_kind(&limits(context)))? {
            Some(truth) => {
                let route = "the kind in exact arithmetic, multipliers by the traces of the dense full period and of its square";
                outcome(context, route, same_kind(analysis.kind, truth).and_then(|()| traces()))
            }
            None => {
                let route = "multipliers by the traces of the dense full period and of its square (exact arithmetic would cost \
                             more than is allowed)";
                outcome(context, route, traces())
            }
        }
    }
}

/// `None` where the work exceeds the limits.
fn within<T>(found: Result<T>) -> Result<Option<T>> {
    match found {
        Ok(value) => Ok(Some(value)),
        Err(error) if error.kind() == Reason::Budget => Ok(None),
        Err(error) => Err(error),
    }
}

impl Recheck for Points {
    const TABLE: &'static str = "points";
    const LEFT: &'static [Left] = LEFT;
    type Found = (Scan, SystemMap);

    fn again(&self, context: &Context) -> Result<(Value, Self::Found)> {
        let input = &self.input;
        let x: Axis = input.scan_x.as_ref().ok_or_else(|| missing("input.scan_x"))?.parse()?;
        let y = input.scan_y.as_ref().map(|own| own.parse()).transpose()?;
        let (scene, limits) = input.asked(context)?;
        let time_unit = scene.time_unit().map(String::from);
        let scan_of = Scan::new(scene.clone(), x, y)?;
        let (xs, ys) = (scan_of.x.values(), scan_of.ys());
        let decide =
            |x: &_, y: &_| -> Result<Analysis> { scan_of.at(x, y)?.model().decide(input.route(), &limits) };
        let (of, mut done) = ((xs.len() * ys.len()) as u64, 0);
        let points = scan(&xs, &ys, decide, |more| {
            done += more as u64;
            context.see.inspect(|see| see(done, of));
        })?;
        let map = SystemMap { names: scan_of.names(), xs, ys, points, time_unit };
        Ok((input.echo(map.document(), &scene).value(), (scan_of, map)))
    }

    fn check(&self, (scan_of, map): Self::Found, context: &Context) -> Result<Outcome> {
        let (of, limits) = (map.points.len() as u64, limits(context));
        let mut outcome =
            outcome(context, "the kind of a random sample of points in exact arithmetic", Ok(()))?;
        let most = if context.options.all { of } else { POINTS };
        let mut decided = 0;
        for n in sample(&self.input.system.to_string(), of, most) {
            let point = &map.points[n as usize];
            let (x, y) = &point.at;
            let Some(truth) = within(scan_of.at(x, y)?.model().exact_kind(&limits))? else { continue };
            decided += 1;
            let values = || map.names.iter().zip([x, y]).map(|(name, value)| format!("{name} = {value}"));
            let place = || values().collect::<Vec<_>>().join(", ");
            outcome.failures.extend(context.failure(n + 1, place, same_kind(point.kind, truth))?);
        }
        (outcome.rows, outcome.sample) = (of, Some((decided, of)));
        Ok(outcome)
    }
}

impl Recheck for Intervals {
    const TABLE: &'static str = "rows";
    const LEFT: &'static [Left] = LEFT;
    type Found = ();

    fn again(&self, context: &Context) -> Result<(Value, ())> {
        let input = &self.input;
        let (span, width) =
            input.intervals.as_deref().zip(input.width.as_ref()).ok_or_else(|| missing("input"))?;
        let (span, width) = (span.parse()?, to_f64(width));
        let (scene, limits) = input.asked(context)?;
        let found = scene.intervals(&span, width, &limits)?;
        Ok((input.echo(report::intervals(&found), &scene).value(), ()))
    }

    fn check(&self, (): (), context: &Context) -> Result<Outcome> {
        outcome(context, ALONE, Ok(()))
    }
}

impl Recheck for Simulated {
    const TABLE: &'static str = "series";
    const LEFT: &'static [Left] = LEFT;
    type Found = (SystemScene, RunRequest, Run);

    fn again(&self, context: &Context) -> Result<(Value, Self::Found)> {
        let input = &self.input;
        let periods = input.periods.as_deref().ok_or_else(|| missing("input.periods"))?;
        let periods =
            u32::try_from(*periods).map_err(|_| Error::input("input.periods", periods, "too many"))?;
        let displacement: Displacement =
            input.displace.as_ref().ok_or_else(|| missing("input.displace"))?.parse()?;
        let ends = match input.form.as_deref() {
            Some("symmetric") => Ends::Symmetric,
            Some("staggered") => Ends::Staggered,
            _ => return Err(missing("input.form")),
        };
        let (scene, limits) = input.asked(context)?;
        let request = RunRequest { periods, displacement, ends };
        let run = scene.run(&request, &limits)?;
        let again = input.echo(crate::report::simulate::document(&run), &scene);
        Ok((again.value(), (scene, request, run)))
    }

    fn check(&self, (scene, request, run): Self::Found, context: &Context) -> Result<Outcome> {
        if run.linear && request.ends == Ends::Symmetric {
            let route = "the amplitudes by powers of the dense full period";
            return outcome(context, route, dense::linear_run(&scene, &request, &run));
        }
        outcome(context, ALONE, Ok(()))
    }
}

/// Kinds agree, a part that is at rest apart.
fn same_kind(found: Option<Kind>, truth: Kind) -> Checked {
    same("kind", found.map_or("not decided", Kind::name), truth.name())
}
