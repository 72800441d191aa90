//! Entries beside the verdict of a system: the unit of time, friction, the integrator's own orbit, the
//! motions of the growing modes.

use serde_json::{Value, json};

use super::bias::Biases;
use super::nearest;
use super::words::{rate, rate_per};
use crate::report::decimal;
use crate::report::document::enclosure;
use crate::report::friction;
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

/// A growing mode lists this many degrees of freedom: those that move most.
const LISTED: usize = 4;

/// The entries of a document.
pub(super) fn entries(beside: &Beside, analysis: &Analysis) -> Vec<(&'static str, Value)> {
    let moving = |labels: &&[String]| {
        let modes = analysis.parts.iter().flat_map(|part| &part.instabilities);
        let one =
            |(i, amplitude): (usize, f64)| json!({"dof": i, "label": labels[i], "amplitude": amplitude});
        let all = modes.map(|mode| Value::from(moving(mode).into_iter().map(one).collect::<Vec<_>>()));
        Value::from(all.collect::<Vec<_>>())
    };
    let orbit = beside.orbit.map(|orbit| {
        let about = &orbit.analysis;
        json!({
            "displacement": orbit.displacement, "start": orbit.start, "kind": about.kind_name(), "stable": about.holds().is_stable(),
            "proven": about.is_proof(), "growth_rate": about.growth_rate().map(enclosure),
        })
    });
    let all = [
        ("time_unit", beside.unit.map(Value::from)),
        ("friction", beside.friction.map(friction::value)),
        ("own_orbit", orbit),
        ("moving", beside.labels.as_ref().map(moving)),
        ("nearest_unstable", beside.nearest.map(nearest::value)),
        ("local_steps", beside.local.map(local_steps)),
        ("no_gradient", beside.no_gradient.map(|forces| no_gradient(forces, analysis))),
    ];
    all.into_iter().filter_map(|(key, value)| Some((key, value?))).collect()
}

fn no_gradient(no_gradient: &NoGradient, analysis: &Analysis) -> Value {
    json!({
        "asymmetries": no_gradient.asymmetries,
        "without_steps": no_gradient.without_steps.map(enclosure),
        "added_by_steps": no_gradient.added_by_steps(analysis).map(enclosure),
        "within_accuracy": no_gradient.within_accuracy.map(enclosure),
        "masking_friction": no_gradient.masking,
    })
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

fn local_steps(scheme_summary: &SchemeSummary) -> Value {
    let level = |&(fine, substeps): &(usize, u32)| json!({"fine": fine, "substeps": substeps});
    let mut value = json!({
        "scheme": scheme_summary.scheme.name(),
        "levels": scheme_summary.levels.iter().map(level).collect::<Vec<_>>(),
        "plain_limit": scheme_summary.plain_limit.map(enclosure),
    });
    if let Some(first) = scheme_summary.first_unstable {
        value["first_unstable"] = enclosure(first);
    }
    value
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
            let named: Vec<_> = moving(mode).iter().map(|&(i, x)| format!("{} {x:.3}", labels[i])).collect();
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
