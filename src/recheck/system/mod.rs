//! Documents of systems: computed again whole, and what they claim found by another route.
//!
//! The same input gives the same document, so every value must be what it is when it is computed again. That finds what was
//! changed afterwards; what would be wrong from the start is looked for by exact arithmetic (the kind) and by the dense full
//! period in doubles (multipliers, runs of linear systems).

mod again;
mod dense;

use std::ops::Deref;

use serde::de::IgnoredAny;
use serde_json::{Map, Value};

use super::context::{Checked, Context, Outcome, REMEDY, same};
use super::sample::sample;
use super::written::Written;
use crate::avi::{Ends, Run};
use crate::error::{Error, Kind as Reason, Result};
use crate::number::Rational;
use crate::report::system::{self as report, SystemMap};
use crate::scene::{Axis, Displacement, RunRequest, Scan, SystemScene};
use crate::system::scan::scan;
use crate::system::{Analysis, Limits, Route};
use crate::verdict::Kind;
pub use again::same_values;

/// Points of a map whose kind is decided by the other route (where it costs no more than is allowed), unless all are.
const POINTS: u64 = 200;

/// Every field is computed again; these are names.
const NAMES: &str = "file, title: names";

rows! {
    struct Input {
        #[serde(rename = "file")]
        _file: IgnoredAny,
        #[serde(rename = "title")]
        _title: IgnoredAny,
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

/// A document as it stands.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(transparent)]
pub struct Document(Map<String, Value>);

macro_rules! claims {
    ($($(#[$doc:meta])* $name:ident;)*) => {
        $($(#[$doc])*
        #[derive(Clone, Debug, serde::Deserialize)]
        #[serde(transparent)]
        pub struct $name(Document);

        impl Deref for $name {
            type Target = Document;

            fn deref(&self) -> &Document {
                &self.0
            }
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

impl Document {
    fn input(&self) -> Result<Input> {
        let input = self.0.get("input").cloned().unwrap_or_default();
        serde_json::from_value(input).map_err(|fault| {
            let why = format!("{fault}; {REMEDY}");
            Error::input("input", "not what the schema says", why)
        })
    }

    /// What is found of the whole document: its values against those computed again, then what another route says.
    fn outcome(
        &self,
        context: &Context,
        route: &'static str,
        again: &Value,
        other: Checked,
    ) -> Result<Outcome> {
        let checked = same_values(&self.0, again).and(other);
        let failures = context.failure(0, || "the document".into(), checked)?.into_iter().collect();
        Ok(Outcome { rows: 1, route, sample: None, failures, not_rechecked: vec![NAMES] })
    }
}

impl Input {
    fn scene(&self, context: &Context) -> Result<SystemScene> {
        let mut scene = SystemScene::from_json_in(&context.options.folder, self.system.clone())?;
        if let Some(accuracy) = &self.accuracy {
            scene = scene.at_accuracy(crate::number::rational::to_f64(accuracy))?;
        }
        if self.keep_rigid.is_some() {
            scene = scene.keeping_rigid()?;
        }
        if let Some(rate) = &self.friction {
            scene = scene.with_friction((**rate).clone())?;
        }
        Ok(scene)
    }

    fn route(&self) -> Route {
        if self.exact.is_some() { Route::Exact } else { Route::Cheapest }
    }
}

/// A kick of the scalar ladder is some hundred products.
fn limits(context: &Context) -> Limits {
    Limits { products: context.limits().kicks.saturating_mul(100).max(Limits::default().products) }
}

fn missing(field: &str) -> Error {
    Error::missing(field, REMEDY)
}

impl Verdict {
    pub fn check(&self, context: &Context) -> Result<Outcome> {
        let (input, limits) = (self.input()?, limits(context));
        let scene = input.scene(context)?;
        let analysis = scene.decide(input.route(), &limits)?;
        let friction = scene.friction(&limits)?;
        let orbit = match scene.own_orbit(&limits) {
            Err(error) if error.kind() == Reason::Input => None,
            found => found?,
        };
        let nearest = input.nearest.as_ref().map(|_| {
            let width = input.width.as_ref().ok_or_else(|| missing("input.width"))?;
            scene.nearest_unstable(crate::number::rational::to_f64(width), &limits)
        });
        let nearest = nearest.transpose()?;
        let (friction, orbit, nearest) = (friction.as_ref(), orbit.as_ref(), nearest.as_ref());
        let (unit, labels) = (scene.time_unit(), scene.labels());
        let beside = report::Beside { unit, friction, orbit, labels, nearest, ..report::Beside::default() };
        let again = report::document(&analysis, &beside).value();
        if analysis.measured.is_some() {
            let route = "computed again, by the same route: stiffnesses were measured; the growth rate by the eigenvalues of the dense \
                         full period";
            return self.outcome(context, route, &again, dense::growth(&scene, &analysis));
        }
        let traces = || dense::traces(&scene, &analysis);
        match within(scene.exact_kind(&limits))? {
            Some(truth) => {
                let other = same_kind(analysis.kind, truth).and_then(|()| traces());
                let route = "computed again; the kind in exact arithmetic, multipliers by the traces of the dense full period \
                             and of its square";
                self.outcome(context, route, &again, other)
            }
            None => {
                let route = "computed again; multipliers by the traces of the dense full period and of its square (exact \
                             arithmetic would cost more than is allowed)";
                self.outcome(context, route, &again, traces())
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

impl Points {
    pub fn check(&self, context: &Context) -> Result<Outcome> {
        let (input, limits) = (self.input()?, limits(context));
        let x: Axis = input.scan_x.as_ref().ok_or_else(|| missing("input.scan_x"))?.parse()?;
        let y = input.scan_y.as_ref().map(|own| own.parse()).transpose()?;
        let scene = input.scene(context)?;
        let time_unit = scene.time_unit().map(String::from);
        let scan_of = Scan::new(scene, x, y)?;
        let (xs, ys) = (scan_of.x.values(), scan_of.ys());
        let decide = |x: &_, y: &_| -> Result<Analysis> { scan_of.at(x, y)?.decide(input.route(), &limits) };
        let (of, mut done) = ((xs.len() * ys.len()) as u64, 0);
        let points = scan(&xs, &ys, decide, |more| {
            done += more as u64;
            context.see.inspect(|see| see(done, of));
        })?;
        let map = SystemMap { names: scan_of.names(), xs, ys, points, time_unit };
        let route = "computed again; the kind of a random sample of points in exact arithmetic";
        let mut outcome = self.outcome(context, route, &map.document().value(), Ok(()))?;
        let drawn = sample(&input.system.to_string(), of, if context.options.all { of } else { POINTS });
        let mut decided = 0;
        for &n in &drawn {
            let point = &map.points[n as usize];
            let (x, y) = &point.at;
            let Some(truth) = within(scan_of.at(x, y)?.exact_kind(&limits))? else { continue };
            decided += 1;
            let values = || map.names.iter().zip([x, y]).map(|(name, value)| format!("{name} = {value}"));
            let place = || values().collect::<Vec<_>>().join(", ");
            outcome.failures.extend(context.failure(n + 1, place, same_kind(point.kind, truth))?);
        }
        (outcome.rows, outcome.sample) = (of, Some((decided, of)));
        Ok(outcome)
    }
}

impl Intervals {
    pub fn check(&self, context: &Context) -> Result<Outcome> {
        let input = self.input()?;
        let (span, width) =
            input.intervals.as_deref().zip(input.width.as_ref()).ok_or_else(|| missing("input"))?;
        let (span, width) = (span.parse()?, crate::number::rational::to_f64(width));
        let found = input.scene(context)?.intervals(&span, width, &limits(context))?;
        let again = report::intervals(&found).value();
        self.outcome(context, "computed again, by the same route", &again, Ok(()))
    }
}

impl Simulated {
    pub fn check(&self, context: &Context) -> Result<Outcome> {
        let input = self.input()?;
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
        let scene = input.scene(context)?;
        let request = RunRequest { periods, displacement, ends };
        let run: Run = scene.run(&request, &limits(context))?;
        let again = crate::report::simulate::document(&run).value();
        if run.linear && ends == Ends::Symmetric {
            let route = "computed again; the amplitudes by powers of the dense full period";
            return self.outcome(context, route, &again, dense::linear_run(&scene, &request, &run));
        }
        self.outcome(context, "computed again, by the same route", &again, Ok(()))
    }
}

/// Kinds agree, a part that is at rest apart.
fn same_kind(found: Option<Kind>, truth: Kind) -> Checked {
    same("kind", found.map_or("not decided", Kind::name), truth.name())
}
