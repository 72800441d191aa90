//! Entries beside the verdict of a system: the unit of time, friction, the integrator's own orbit, the
//! motions of the growing modes.

use serde_json::Value;

use super::bias::Biases;
use super::nearest;
use super::words::{rate, rate_per};
use crate::report::decimal;
use crate::report::document::enclosure;
use crate::report::friction;
use crate::report::record::Record;
use crate::report::shape::{
    ALL_ROUNDED, COUNT, ENCLOSED_OR_NULL, ENCLOSURE, FLAG, FLAG_OR_NULL, KIND_IF_DECIDED, POSITIVE, ROUNDED,
    ROUNDED_OR_NULL, Shape, TEXT,
};
use systems::friction::Friction;
use systems::nearest::Nearest;
use systems::{Analysis, Instability, NoGradient, OwnOrbit, Scheme, SchemeSummary, middle};

/// Results beside the verdict at the equilibrium and without friction.
#[derive(Clone, Copy, Debug, Default)]
pub struct Beside<'a> {
    /// The unit of time, where it has a name.
    pub unit: Option<&'a str>,
    pub friction: Option<&'a Friction>,
    pub orbit: Option<&'a OwnOrbit>,
    /// That an orbit was searched for in vain.
    pub is_orbit_missing: bool,
    /// The name of each degree of freedom.
    pub labels: Option<&'a [String]>,
    /// The unstable outer steps next to this one, where they were asked for.
    pub nearest: Option<&'a Nearest>,
    /// The scheme of local time steps, where it is one.
    pub local: Option<&'a SchemeSummary>,
    /// The remark on its model ([`systems::Model::remark`]).
    pub remark: Option<&'a str>,
    /// The bias of its modes, where it is stable.
    pub bias: Option<&'a Biases>,
    /// Results on forces that are no gradient.
    pub no_gradient: Option<&'a NoGradient>,
}

/// An analysis, and what stands beside it.
pub(super) type About<'a> = (&'a Analysis, &'a Beside<'a>);

/// A growing mode lists this many degrees of freedom: those that move most.
const LISTED: usize = 4;

/// Adds its entries to the record of a document.
pub(super) fn fields<'a>(record: Record<'a, About<'a>>) -> Record<'a, About<'a>> {
    record
        .optional("time_unit", |(_, beside): &About| beside.unit.map(Value::from))
        .says(TEXT, "The unit of times, rates per it; where the file gives one.")
        .optional("friction", |(_, beside)| beside.friction.map(friction::value))
        .says(friction::SHAPE, friction::SAYS)
        .optional("own_orbit", |(_, beside)| beside.orbit.map(|orbit| own_orbit().entries(orbit)))
        .says(Shape::Object(|| own_orbit().keys()), "The integrator's own periodic orbit beside the equilibrium, where nonlinear bonds displace it; the rest of the document speaks about the equilibrium.")
        .optional("moving", |&(analysis, beside)| {
            let modes = analysis.parts.iter().flat_map(|part| &part.instabilities);
            beside.labels.map(|labels| modes.map(|mode| moved().all(&named(mode, labels))).collect())
        })
        .says(Shape::List(&Shape::List(&Shape::Object(|| moved().keys()))), "The degrees of freedom that move most in each growing mode; only where they have labels.")
        .optional("nearest_unstable", |(_, beside)| beside.nearest.map(|all| nearest::record().entries(all)))
        .says(Shape::Object(|| nearest::record().keys()), "The unstable intervals of the outer step next to the file's, all steps in their ratios; only where asked for.")
        .optional("local_steps", |(_, beside)| beside.local.map(|local| local_steps().entries(local)))
        .says(Shape::Object(|| local_steps().keys()), "Only with a scheme of local time steps.")
        .optional("no_gradient", |&(analysis, beside)| {
            beside.no_gradient.map(|forces| no_gradient().entries(&(forces, analysis)))
        })
        .says(Shape::Object(|| no_gradient().keys()), "Only of forces that are no gradient.")
}

fn own_orbit() -> Record<'static, OwnOrbit> {
    Record::new()
        .json("displacement", |orbit: &OwnOrbit| orbit.displacement.into())
        .says(ROUNDED, "Rounded double: the largest |start - equilibrium|.")
        .value("start", |orbit| orbit.start.clone().into())
        .says(ALL_ROUNDED, "Where the orbit is at rest.")
        .json("kind", |orbit| orbit.analysis.kind_name().into())
        .says(KIND_IF_DECIDED, "")
        .json("stable", |orbit| orbit.analysis.holds().is_stable().into())
        .says(FLAG_OR_NULL, "null: not decided.")
        .json("proven", |orbit| orbit.analysis.is_proof().into())
        .says(FLAG, "For the Hessians along the computed orbit as they are in doubles.")
        .json("growth_rate", |orbit| orbit.analysis.growth_rate().into())
        .says(ENCLOSED_OR_NULL, "The largest, per unit time; null where no bound is proven.")
}

/// A degree of freedom, its name, and how far it moves.
type Moved<'a> = (usize, &'a str, f64);

fn moved<'a>() -> Record<'a, Moved<'a>> {
    Record::new()
        .json("dof", |&(i, ..): &Moved| i.into())
        .says(COUNT, "")
        .json("label", |&(_, label, _)| label.into())
        .says(TEXT, "")
        .json("amplitude", |&(.., amplitude)| amplitude.into())
        .says(ROUNDED, "Rounded double; the longest is 1.")
}

type Forces<'a> = (&'a NoGradient, &'a Analysis);

fn no_gradient<'a>() -> Record<'a, Forces<'a>> {
    const ENCLOSED: Shape = Shape::OrNull(&ENCLOSURE);
    Record::new()
        .value("asymmetries", |(forces, _): &Forces| forces.asymmetries.clone().into())
        .says(ALL_ROUNDED, "|J - J'|/|J + J'| of each potential in Frobenius's norm, rounded.")
        .json("without_steps", |(forces, _)| forces.without_steps.into())
        .says(ENCLOSED, "The growth rate of the equations themselves, without steps, enclosed; null: not bounded.")
        .json("added_by_steps", |&(forces, analysis)| forces.added_by_steps(analysis).into())
        .says(ENCLOSED, "The growth rate less that without steps, enclosed.")
        .json("within_accuracy", |(forces, _)| forces.within_accuracy.into())
        .says(ENCLOSED, "The growth rate for all measured matrices within their accuracy, enclosed; null: exact matrices, or not bounded.")
        .json("masking_friction", |(forces, _)| forces.masking.into())
        .says(ROUNDED_OR_NULL, "The least friction per unit time under which nothing grows, rounded; null: not looked for, beyond 150 degrees of freedom.")
}

/// The growth of such forces, with the steps and without; `per` is the unit of time.
pub(super) fn no_gradient_lines(no_gradient: &NoGradient, analysis: &Analysis, per: &str) -> Vec<String> {
    let asymmetries: Vec<_> = no_gradient
        .asymmetries
        .iter()
        .map(|&x| if x == 0.0 { "0".into() } else { format!("{x:.2e}") })
        .collect();
    let mut lines = vec![
        format!("  forces that are no gradient: |J - J'|/|J + J'| = {}", asymmetries.join(", ")),
        format!("  without steps growth rate {}", rate_per(no_gradient.without_steps, per)),
    ];
    if let Some((lo, hi)) = no_gradient.added_by_steps(analysis) {
        lines.push(if decimal::is_nothing((lo, hi), analysis.growth_rate()) {
            "  the steps add nothing within rounding".into()
        } else {
            format!("  the steps add {} per {per}", decimal::enclosure(lo, hi))
        });
    }
    if let Some(ends) = no_gradient.within_accuracy {
        lines.push(format!(
            "  for all matrices within their accuracy growth rate {} per {per}",
            rate(Some(ends))
        ));
    }
    match no_gradient.masking {
        Some(0.0) => lines.push("  no friction is needed".into()),
        Some(friction) => {
            let friction = decimal::few(friction, 5);
            lines.push(format!("  a friction of about {friction} per {per} masks the growth (rounded)"))
        }
        None => {}
    }
    lines
}

fn local_steps() -> Record<'static, SchemeSummary> {
    const LEVELS: Shape = Shape::List(&Shape::Object(|| level().keys()));
    Record::new()
        .json("scheme", |summary: &SchemeSummary| summary.scheme.name().into())
        .says(Shape::OneOf(Scheme::NAMES), "")
        .value("levels", |summary| level().all(&summary.levels).into())
        .says(LEVELS, "The coarsest first.")
        .json("plain_limit", |summary| summary.plain_limit.into())
        .says(Shape::OrNull(&ENCLOSURE), "Where plain leapfrog with the step of the whole becomes unstable, enclosed; null: never by its stiffness.")
        .optional("first_unstable", |summary| summary.first_unstable.map(enclosure))
        .says(ENCLOSURE, "Only of sparse stiffnesses, under lts with one level: every step up to the lower number is proven stable, some step up to the upper one is proven unstable.")
}

fn level() -> Record<'static, (usize, u32)> {
    Record::new()
        .json("fine", |&(fine, _): &(usize, u32)| fine.into())
        .says(COUNT, "How many degrees of freedom, in avi elements.")
        .json("substeps", |&(_, substeps)| u64::from(substeps).into())
        .says(POSITIVE, "In a step of the level above.")
}

/// The scheme, and the limit of plain leapfrog; `unit` is that of times, after a space.
pub(super) fn local_lines(scheme_summary: &SchemeSummary, unit: &str) -> Vec<String> {
    let (name, parts) = match scheme_summary.scheme {
        Scheme::Lts => ("local time steps", "degrees of freedom"),
        Scheme::Avi => ("AVI", "elements"),
    };
    let level = |&(fine, substeps): &(usize, u32)| {
        format!("{fine} of {} {parts} take {substeps} substeps", scheme_summary.size)
    };
    let levels: Vec<_> = scheme_summary.levels.iter().map(level).collect();
    let limit = scheme_summary.plain_limit.map(|(lo, hi)| {
        format!("  plain leapfrog without them is stable below {}{unit}", decimal::enclosure(lo, hi))
    });
    let first = scheme_summary.first_unstable.map(|(lo, hi)| {
        let first = decimal::enclosure(lo, hi);
        format!("  first unstable step: {first}{unit}; every smaller one is proven stable")
    });
    let name = format!("  {name}: {}", levels.join("; of these "));
    [name].into_iter().chain(limit).chain(first).collect()
}

/// The entries as lines of text.
pub(super) fn lines(beside: &Beside, growing: &[(usize, &Instability)], analysis: &Analysis) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(labels) = beside.labels {
        for (n, mode) in growing {
            let named: Vec<_> =
                named(mode, labels).iter().map(|(_, name, x)| format!("{name} {x:.3}")).collect();
            lines.push(format!("  growing mode {n} moves most: {}", named.join(", ")));
        }
    }
    lines.extend(beside.friction.into_iter().flat_map(friction::lines));
    if beside.is_orbit_missing {
        let line = "  about the equilibrium; an orbit of the integrator's own beside it was not found";
        lines.push(line.into());
    }
    lines.extend(beside.orbit.map(|orbit| orbit_line(orbit, analysis)));
    lines
}

/// The growing modes that a person is shown.
pub(super) const SHOWN_MODES: usize = 12;

/// The fastest growing modes up to a number, each with its number in the document, in the document's order;
/// and how many are left out.
pub(super) fn fastest(analysis: &Analysis, most: usize) -> (Vec<(usize, &Instability)>, usize) {
    let mut modes: Vec<_> = (1..).zip(analysis.parts.iter().flat_map(|part| &part.instabilities)).collect();
    modes.sort_by(|a, b| b.1.multiplier.size().total_cmp(&a.1.multiplier.size()));
    let left_out = modes.len().saturating_sub(most);
    modes.truncate(most);
    modes.sort_by_key(|(n, _)| *n);
    (modes, left_out)
}

/// The same with their names.
fn named<'a>(mode: &Instability, labels: &'a [String]) -> Vec<Moved<'a>> {
    moving(mode).into_iter().map(|(i, amplitude)| (i, labels[i].as_str(), amplitude)).collect()
}

/// The degrees of freedom with the longest entries of a shape, and these.
fn moving(mode: &Instability) -> Vec<(usize, f64)> {
    let length = |i: usize| mode.shape[i].hypot(mode.quadrature[i]);
    let mut order: Vec<usize> = (0..mode.shape.len()).filter(|&i| length(i) > 0.0).collect();
    order.sort_by(|&a, &b| length(b).total_cmp(&length(a)).then(a.cmp(&b)));
    let moved = |&i: &usize| (i, if mode.quadrature[i] == 0.0 { mode.shape[i] } else { length(i) });
    order.iter().take(LISTED).map(moved).collect()
}

fn orbit_line(own_orbit: &OwnOrbit, analysis: &Analysis) -> String {
    let [here, there] =
        [analysis, &own_orbit.analysis].map(|analysis| analysis.growth_rate().filter(|ends| ends.1 > 0.0));
    let growth = match (here, there) {
        (Some(here), Some(there)) => {
            let more = 100.0 * (middle(there) / middle(here) - 1.0);
            format!("growth rate {}, {more:+.1} % of that at the equilibrium", rate(Some(there)))
        }
        (None, Some(_)) => format!("growth rate {}, though none at the equilibrium", rate(there)),
        (Some(_), None) => "no growth, though some at the equilibrium".into(),
        (None, None) => "no growth, as at the equilibrium".into(),
    };
    let proven = if own_orbit.analysis.is_proof() { "proven for its Hessians" } else { "NOT proven" };
    format!(
        "  the above speaks about the equilibrium; about the integrator's own orbit, {:.3e} beside it, where a run stays: {} ({proven}), {growth}",
        own_orbit.displacement,
        own_orbit.analysis.kind_name(),
    )
}
