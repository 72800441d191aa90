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

use super::decimal;
use super::document::Document;
use super::record::Record;
use super::shape::{
    ALL_ROUNDED, COUNT, ENCLOSED_OR_NULL, FLAG, FLAG_OR_NULL, INTEGER, KIND_IF_DECIDED, POSITIVE, ROUNDED,
    ROUNDED_OR_NULL, Schema, Shape, TEXT, TEXTS, WIDE_ENCLOSURE,
};
use super::table::{Cell, Column};
use super::text::counted;
use beside::About;
pub use beside::Beside;
pub use bias::Biases;
pub use chart::Colouring;
pub use intervals::figure as intervals_figure;
pub use intervals::{document as intervals, sampled, schema as intervals_schema};
pub use map::SystemMap;
pub(in crate::report) use measured::{motions, of_each};
pub use modes::figure;
use systems::{Analysis, Clocked, Holds, Instability, MuCount, Multiplier, Origin, Part, Resonance};
pub use viewers::{vtu, xyz};
use words::{rate, rate_per};

const CAPTION: &str =
    "Multipliers $\\lambda$ over one synchronization period, $\\lambda + 1/\\lambda = 2 + 4\\mu$";

/// A part, and its number from 1.
type Numbered<'a> = (u64, &'a Part);

/// The document `kickdrift/system-verdict/1`; the caller adds the input.
pub fn document(analysis: &Analysis, beside: &Beside) -> Document {
    let all: Vec<Own> = numbered(analysis).into_iter().flat_map(multipliers).collect();
    let table =
        record().table("multipliers", "Multipliers over one synchronization period", &all).captioned(CAPTION);
    let document = head().document(Document::new("system-verdict"), &(analysis, beside));
    let [first, all] = [false, true].map(|is_whole| lines(analysis, beside, is_whole));
    let is_short = first.len() < all.len();
    let document = document.long_rows(table).summary_alone(&all);
    if is_short { document.answer(first) } else { document }
}

/// Its schema.
pub fn schema() -> Schema {
    let about = "M x'' + sum K_k x = 0, each potential with its own clock. Multipliers satisfy lambda + 1/lambda = 2 + 4 mu.";
    Schema::new("The verdict on a system", head().keys()).about(about)
}

/// The record of the whole.
fn head<'a>() -> Record<'a, About<'a>> {
    const PARTS: Shape = Shape::List(&Shape::Object(|| part().keys()));
    let record = Record::new()
        .json("degrees_of_freedom", |(analysis, _): &About| analysis.size.into())
        .says(POSITIVE, "")
        .json("clocks", |(analysis, _)| analysis.clocks.into())
        .says(POSITIVE, "")
        .json("period", |(analysis, _)| Cell::exact(&analysis.period))
        .says(TEXT, "The synchronization period: exact, rational or with pi.")
        .json("kind", |(analysis, _)| analysis.kind_name().into())
        .says(KIND_IF_DECIDED, "")
        .json("stable", |(analysis, _)| analysis.holds().is_stable().into())
        .says(FLAG_OR_NULL, "null: not decided.")
        .json("proven", |(analysis, _)| analysis.is_proof().into())
        .says(FLAG, "False where nothing is decided; a warning says why.")
        .json("growth_rate", |(analysis, _)| analysis.growth_rate().into())
        .says(ENCLOSED_OR_NULL, "The largest, per unit time, 0 where nothing grows exponentially; null where no bound is proven.")
        .json("rigid_modes", |(analysis, _)| analysis.rigid_modes.len().into())
        .says(COUNT, "Common null vectors of all potentials, set apart.")
        .value("parts", |(analysis, _)| part().all(&numbered(analysis)).into())
        .says(PARTS, "Degrees of freedom that no potential joins, each set decided over its own period.")
        .value("warnings", |(analysis, _)| analysis.warnings.clone().into())
        .says(TEXTS, "")
        .optional("measured", |(analysis, _)| {
            analysis.measured.as_ref().map(|measured| measured::record().entries(measured))
        })
        .says(Shape::Object(|| measured::record().keys()), "How far the verdict on measured stiffnesses stands; only where they are given by reference, and where a warning does not say that their accuracy is not used.")
        .value("bias", |(_, beside)| bias::value(beside.bias))
        .says(bias::SHAPE, bias::SAYS);
    beside::fields(record)
}

fn numbered(analysis: &Analysis) -> Vec<Numbered<'_>> {
    (1..).zip(&analysis.parts).collect()
}

fn multipliers<'a>((n, part): Numbered<'a>) -> impl Iterator<Item = Own<'a>> {
    part.multipliers.iter().map(move |multiplier| (n, part, multiplier))
}

fn part<'a>() -> Record<'a, Numbered<'a>> {
    const DECIDED_BY: Shape = Shape::OneOf(&["filter", "refine", "exact", "signs", "discs", "estimate"]);
    Record::new()
        .value("dofs", |(_, part): &Numbered| part.dofs.clone().into())
        .says(Shape::List(&COUNT), "")
        .json("size", |(_, part)| part.size.into())
        .says(COUNT, "")
        .json("period", |(_, part)| Cell::exact(&part.period))
        .says(TEXT, "")
        .json("kind", |(_, part)| part.kind_name().into())
        .says(KIND_IF_DECIDED, "")
        .json("decided_by", |(_, part)| part.evidence.name().into())
        .says(DECIDED_BY, "")
        .value("multipliers", |&numbered| record().all(&multipliers(numbered).collect::<Vec<_>>()).into())
        .says(Shape::List(&Shape::Object(|| record().keys())), "")
        .value("instabilities", |(_, part)| instability().all(&part.instabilities).into())
        .says(Shape::List(&Shape::Object(|| instability().keys())), "")
        .value("roots", |(_, part)| part.roots.as_ref().map(|count| roots().entries(count)).into())
        .says(Shape::OrNull(&Shape::Object(|| roots().keys())), "The exact count of the mu by place, each as often as it is one, where exact arithmetic decided: together `size`.")
        .value("oscillator", |(_, part)| part.oscillator.as_ref().map(|one| clocked().entries(one)).into())
        .says(Shape::OrNull(&Shape::Object(|| clocked().keys())), "For one degree of freedom.")
}

fn roots() -> Record<'static, MuCount> {
    Record::new()
        .json("inside", |count: &MuCount| count.inside.into())
        .says(COUNT, "Between -1 and 0: lambda on the unit circle.")
        .json("at_zero", |count| count.at_zero.into())
        .says(COUNT, "lambda = 1.")
        .json("at_minus_one", |count| count.at_minus_one.into())
        .says(COUNT, "lambda = -1.")
        .json("above", |count| count.above.into())
        .says(COUNT, "Above 0: lambda > 1.")
        .json("below", |count| count.below.into())
        .says(COUNT, "Below -1: lambda < -1.")
        .json("complex", |count| count.complex.into())
        .says(COUNT, "Not real.")
}

fn clocked() -> Record<'static, Clocked> {
    const STRIKES: Shape = Shape::List(&POSITIVE);
    const FAMILIES: Shape = Shape::List(&Shape::List(&INTEGER));
    Record::new()
        .json("trace", |clocked: &Clocked| clocked.trace.to_f64_enclosure().into())
        .says(WIDE_ENCLOSURE, "An enclosure of Tr Q.")
        .value("strikes", |clocked| clocked.strikes.clone().into())
        .says(STRIKES, "T/h_k.")
        .json("label", |clocked| clocked.label.into())
        .says(Shape::OrNull(&COUNT), "Half turns of the growing solution in a period.")
        .value("families", |clocked| clocked.families.clone().into())
        .says(FAMILIES, "The a_k of 1/T_half = sum a_k/h_k, the shortest first.")
}

fn instability() -> Record<'static, Instability> {
    Record::new()
        .json("lambda.re", |unstable: &Instability| unstable.multiplier.lambda.re.into())
        .says(ROUNDED, "")
        .json("lambda.im", |unstable| unstable.multiplier.lambda.im.into())
        .says(ROUNDED, "")
        .json("origin", |unstable| unstable.origin.name().into())
        .says(Shape::OneOf(Origin::NAMES), "")
        .json("growth_rate", |unstable| unstable.growth_rate.into())
        .says(ENCLOSED_OR_NULL, "Per unit time; null where no bound is proven.")
        .value("shape", |unstable| unstable.shape.clone().into())
        .says(ALL_ROUNDED, "The positions of the growing solution at the start of a period, the longest 1.")
        .value("quadrature", |unstable| unstable.quadrature.clone().into())
        .says(ALL_ROUNDED, "The imaginary part of the shape.")
        .value("resonance", |unstable| unstable.resonance.as_ref().map(|r| resonant().entries(r)).into())
        .says(
            Shape::OrNull(&Shape::Object(|| resonant().keys())),
            "The nearest one, by the normal modes in the shape; null where these could not be computed.",
        )
}

fn resonant() -> Record<'static, Resonance> {
    const TWO: Shape = Shape::With(&ALL_ROUNDED, r#"{"minItems": 2, "maxItems": 2}"#);
    Record::new()
        .value("frequencies", |r: &Resonance| vec![r.frequencies.0, r.frequencies.1].into())
        .says(TWO, "w_i and w_j, per unit time.")
        .json("sign", |r| i64::from(r.sign).into())
        .says(Shape::Plain(r#"{"enum": [1, -1]}"#), "Of w_i + w_j or w_i - w_j.")
        .json("m", |r| r.m.into())
        .says(INTEGER, "(w_i +- w_j) T/(2 pi) is near it.")
        .value("family", |r| r.family.clone().into())
        .says(Shape::List(&INTEGER), "The a_k of m = sum a_k T/h_k; empty where none was found.")
        .json("detuning", |r| r.detuning.into())
        .says(ROUNDED, "(w_i +- w_j) T/(2 pi) - m.")
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
        let turns = if m == 1 { "turn" } else { "turns" };
        lines.push(format!("  m = {m} half {turns} a period: 1/T_half near {}", families.join(" = ")));
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
    let part_of_mu = |key: &str, part: &str| {
        Column::new(key).titled(&format!("{part} mu"), &format!("$\\operatorname{{{part}}}\\mu$"))
    };
    Record::new()
        .column(Column::new("part").aside(), |&(n, ..): &Own| n.into())
        .column(Column::new("kind").left(), |(_, part, _)| part.kind_name().into())
        .column(titled("decided_by", "decided by").left().aside(), |(_, part, _)| part.evidence.name().into())
        .at("mu.re", part_of_mu("mu_re", "Re"), |(.., m)| m.mu.re.into())
        .says(ROUNDED, "")
        .at("mu.im", part_of_mu("mu_im", "Im"), |(.., m)| m.mu.im.into())
        .says(ROUNDED, "")
        .field(Column::new("radius"), |(.., m)| m.radius.into())
        .says(ROUNDED_OR_NULL, "The exact mu is within this double of the one given; null: not bounded.")
        .json("lambda.re", |(.., m)| m.lambda.re.into())
        .says(ROUNDED, "")
        .json("lambda.im", |(.., m)| m.lambda.im.into())
        .says(ROUNDED, "")
        .column(Column::new("lambda_abs").titled("|lambda|", "$|\\lambda|$"), |(.., m)| {
            m.lambda.norm().into()
        })
        .column(titled("growth_rate", "growth rate").enclosure(), |(_, part, m)| {
            part.growth_rate_of(m).into()
        })
}
