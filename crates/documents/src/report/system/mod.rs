//! The verdict on a system of many clocks and degrees of freedom: as a document, its modes drawn, and maps of
//! it.

mod beside;
mod bias;
mod chart;
mod intervals;
mod map;
mod measured;
mod modes;
mod nearest;
mod viewers;
mod words;

use serde_json::{Value, json};

use super::decimal;
use super::document::{Document, enclosure};
use super::record::Record;
use super::table::Column;
use super::text::counted;
pub use beside::Beside;
pub use bias::Biases;
pub use chart::Colouring;
pub use intervals::figure as intervals_figure;
pub use intervals::{document as intervals, sampled};
pub use map::SystemMap;
pub(in crate::report) use measured::of_each;
pub use modes::figure;
use systems::{Analysis, Clocked, Holds, Instability, MuCount, Multiplier, Origin, Part, Resonance};
pub use viewers::{vtu, xyz};
use words::{rate, rate_per};

const CAPTION: &str =
    "Multipliers $\\lambda$ over one synchronization period, $\\lambda + 1/\\lambda = 2 + 4\\mu$";

/// The document `kickdrift/system-verdict/1`; the caller adds the input.
pub fn document(analysis: &Analysis, beside: &Beside) -> Document {
    let parts = || (1..).zip(&analysis.parts);
    let all: Vec<Own> = parts().flat_map(|(n, part)| multipliers(n, part)).collect();
    let table =
        record().table("multipliers", "Multipliers over one synchronization period", &all).captioned(CAPTION);
    let document = Document::new("system-verdict")
        .entry("degrees_of_freedom", analysis.size)
        .entry("clocks", analysis.clocks)
        .entry("period", analysis.period.to_string())
        .entry("kind", analysis.kind_name())
        .entry("stable", analysis.holds().is_stable())
        .entry("proven", analysis.is_proof())
        .entry("growth_rate", analysis.growth_rate().map(enclosure))
        .entry("rigid_modes", analysis.rigid_modes.len())
        .entry("parts", parts().map(part).collect::<Vec<_>>())
        .entry("warnings", analysis.warnings.clone())
        .entries(analysis.measured.as_ref().map(|measured| ("measured", measured::value(measured))))
        .entry("bias", bias::value(beside.bias))
        .entries(beside::entries(beside, analysis));
    let [first, all] = [false, true].map(|is_whole| lines(analysis, beside, is_whole));
    let is_short = first.len() < all.len();
    let document = document.long_rows(table).summary_alone(&all);
    if is_short { document.answer(first) } else { document }
}

fn multipliers(n: u64, part: &Part) -> impl Iterator<Item = Own<'_>> {
    part.multipliers.iter().map(move |multiplier| (n, part, multiplier))
}

fn part((n, part): (u64, &Part)) -> Value {
    json!({
        "dofs": part.dofs,
        "size": part.size,
        "period": part.period.to_string(),
        "kind": part.kind_name(),
        "decided_by": part.evidence.name(),
        "multipliers": multipliers(n, part).map(|multiplier| record().entries(&multiplier)).collect::<Vec<_>>(),
        "instabilities": part.instabilities.iter().map(instability).collect::<Vec<_>>(),
        "roots": part.roots.as_ref().map(roots),
        "oscillator": part.oscillator.as_ref().map(clocked),
    })
}

fn roots(count: &MuCount) -> Value {
    json!({
        "inside": count.inside, "at_zero": count.at_zero, "at_minus_one": count.at_minus_one,
        "above": count.above, "below": count.below, "complex": count.complex,
    })
}

fn clocked(clocked: &Clocked) -> Value {
    json!({
        "trace": enclosure(clocked.trace.to_f64_enclosure()), "strikes": clocked.strikes,
        "label": clocked.label, "families": clocked.families,
    })
}

fn instability(unstable: &Instability) -> Value {
    let resonance = unstable.resonance.as_ref().map(|r| {
        json!({
            "frequencies": [r.frequencies.0, r.frequencies.1], "sign": r.sign, "m": r.m,
            "family": r.family, "detuning": r.detuning,
        })
    });
    let lambda = unstable.multiplier.lambda;
    json!({
        "lambda": {"re": lambda.re, "im": lambda.im},
        "origin": origin(unstable.origin),
        "growth_rate": unstable.growth_rate.map(enclosure),
        "shape": unstable.shape,
        "quadrature": unstable.quadrature,
        "resonance": resonance,
    })
}

fn origin(origin: Origin) -> &'static str {
    match origin {
        Origin::RealPair => "real pair",
        Origin::Collision => "collision",
    }
}

/// The answer in words, whole, or what a person wants first: of what grows the fastest, of the biases the one
/// that is most off, and nothing on how it was read.
fn lines(analysis: &Analysis, beside: &Beside, is_whole: bool) -> Vec<String> {
    let suffix = beside.unit.map_or(String::new(), |unit| format!(" {unit}"));
    let headline = match analysis.holds() {
        Holds::Stable => format!("stable: {} (proven)", analysis.kind_name()),
        Holds::Unstable => format!("unstable: {} (proven)", analysis.kind_name()),
        Holds::Undecided => "not decided: doubles do not prove a verdict".into(),
    };
    let mut lines = vec![
        headline,
        format!(
            "  {}, {}, period T = {}{suffix}",
            counted(analysis.size, "degree of freedom", "degrees of freedom"),
            counted(analysis.clocks, "clock", "clocks"),
            analysis.period
        ),
    ];
    let (rigid, parts) = (analysis.rigid_modes.len(), analysis.parts.len());
    if rigid > 0 && is_whole {
        lines.push(format!("  {} set apart", counted(rigid, "rigid mode", "rigid modes")));
    }
    if parts > 1 && is_whole {
        lines.push(format!("  {parts} independent parts"));
    }
    if !analysis.is_stable() {
        let per = beside.unit.unwrap_or("unit time");
        lines.push(format!("  largest growth rate {}", rate_per(analysis.growth_rate(), per)));
    }
    lines
        .extend(analysis.parts.iter().filter_map(|part| part.oscillator.as_ref()).flat_map(oscillator_lines));
    let (growing, left_out) = beside::fastest(analysis, if is_whole { beside::SHOWN_MODES } else { 1 });
    lines.extend(growing.iter().map(|(_, unstable)| format!("  {}", described(unstable))));
    if left_out > 0 {
        let modes = counted(left_out, "mode grows", "modes grow");
        let rest = if is_whole { ": as JSON or CSV all are shown" } else { "" };
        lines.push(format!("  {modes} more slowly{rest}"));
    }
    lines.extend(beside.bias.iter().flat_map(|bias| bias::lines(bias, &suffix, is_whole)));
    let per = beside.unit.unwrap_or("unit time");
    lines.extend(
        beside
            .no_gradient
            .into_iter()
            .flat_map(|no_gradient| beside::no_gradient_lines(no_gradient, analysis, per)),
    );
    lines.extend(
        beside.local.into_iter().flat_map(|scheme_summary| beside::local_lines(scheme_summary, &suffix)),
    );
    lines.extend(beside.remark.map(|remark| format!("  {remark}")));
    lines.extend(beside::lines(beside, &growing, analysis));
    let measured =
        |measured| measured::lines(measured, (analysis.clocks, analysis.is_stable()), &suffix, is_whole);
    lines.extend(analysis.measured.iter().flat_map(measured));
    lines.extend(beside.nearest.iter().flat_map(|nearest| nearest::lines(nearest, &suffix)));
    lines.extend(analysis.warnings.iter().map(|warning| format!("  warning: {warning}")));
    lines
}

/// Trace, label and families of one oscillator in words.
fn oscillator_lines(clocked: &Clocked) -> Vec<String> {
    let (lo, hi) = clocked.trace.to_f64_enclosure();
    let mut lines = vec![format!("  trace Tr Q = {}", decimal::enclosure(lo, hi))];
    if let Some(m) = clocked.label {
        let families: Vec<String> = clocked.families.iter().map(|family| terms(family, "h")).collect();
        lines.push(format!("  m = {m} half turns a period: 1/T_half near {}", families.join(" = ")));
    }
    lines
}

/// Σ a_k/h_k without the terms that vanish, `h` before each index.
fn terms(family: &[i64], h: &str) -> String {
    let mut text = String::new();
    for (k, &a) in (1..).zip(family).filter(|(_, a)| **a != 0) {
        text += match (text.is_empty(), a < 0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        text += &format!("{}/{h}{k}", a.abs());
    }
    if text.is_empty() { "0".into() } else { text }
}

/// One unstable multiplier in words.
fn described(unstable: &Instability) -> String {
    let lambda = unstable.multiplier.lambda;
    // Doubles have no digits behind the point from 10^15 on.
    let part = |x: f64| if x.abs() < 1e9 { format!("{x:.6}") } else { format!("{x:.6e}") };
    let mut line = match unstable.origin {
        Origin::RealPair => format!("multiplier {}: one mode, ", part(lambda.re)),
        Origin::Collision => {
            format!("multipliers {} ± {}i: two modes collide, ", part(lambda.re), part(lambda.im.abs()))
        }
    };
    line += &format!("growth rate {}", rate(unstable.growth_rate));
    if let Some(r) = &unstable.resonance {
        line += &resonance(r);
    }
    line
}

/// "; near w = 0.3 + 3.1 = 2 pi (1/h1 - 1/h3)": the resonance in words.
fn resonance(resonance: &Resonance) -> String {
    let (first, second) = resonance.frequencies;
    if first == 0.0 && second == 0.0 {
        return "; no resonance: the total stiffness is not positive on this mode".into();
    }
    let sign = if resonance.sign > 0 { '+' } else { '-' };
    let sum = match resonance.m {
        0 => "0".into(),
        m if resonance.family.is_empty() => format!("2 pi {m}/T"),
        _ => format!("2 pi ({})", terms(&resonance.family, "h")),
    };
    // Four decimals leave nothing of a slow mode.
    let shown = |w: f64| if w == 0.0 || w >= 1e-3 { format!("{w:.4}") } else { format!("{w:.3e}") };
    format!("; near w = {} {sign} {} = {sum}", shown(first), shown(second))
}

/// A multiplier, its part, and the part's number from 1.
type Own<'a> = (u64, &'a Part, &'a Multiplier);

/// The record of a multiplier.
fn record<'a>() -> Record<'a, Own<'a>> {
    let titled = |key: &str, title: &str| Column::new(key).titled(title, title);
    Record::new()
        .column(Column::new("part").aside(), |&(n, ..): &Own| n.into())
        .column(Column::new("kind").left(), |(_, part, _)| part.kind_name().into())
        .column(titled("decided_by", "decided by").left().aside(), |(_, part, _)| part.evidence.name().into())
        .at("mu.re", Column::new("mu_re").titled("Re mu", "$\\operatorname{Re}\\mu$"), |(.., m)| {
            m.mu.re.into()
        })
        .at("mu.im", Column::new("mu_im").titled("Im mu", "$\\operatorname{Im}\\mu$"), |(.., m)| {
            m.mu.im.into()
        })
        .field(Column::new("radius"), |(.., m)| m.radius.into())
        .json("lambda.re", |(.., m)| m.lambda.re.into())
        .json("lambda.im", |(.., m)| m.lambda.im.into())
        .column(Column::new("lambda_abs").titled("|lambda|", "$|\\lambda|$"), |(.., m)| {
            m.lambda.norm().into()
        })
        .column(titled("growth_rate", "growth rate").enclosure(), |(_, part, m)| {
            part.growth_rate_of(m).into()
        })
}
