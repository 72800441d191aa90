//! Friction in JSON and in words.

use serde_json::{Value, json};

use super::decimal;
use super::document::enclosure;
use super::shape::{ENCLOSURE, FLAG, Keys, ROUNDED, Shape, TEXT};
use systems::friction::{Damping, Friction, Mask, Masked};

/// The sentence on the entry `friction` of a document.
pub const SAYS: &str =
    "O-steps, v to exp(-rate t) v in the middle of every drift; only where a rate was given.";

/// What it is.
pub const SHAPE: Shape = Shape::Object(|| {
    const DAMPING: Shape = Shape::OneOf(&["damped", "marginal", "growing", "not told"]);
    const MASKING: Shape =
        Shape::Any(&[Shape::OneOf(&["nothing grows", "not told"]), Shape::Object(masking_keys)]);
    Keys::new()
        .key("rate", TEXT, "Exact, per unit time.")
        .key("damping", DAMPING, "The spectral radius of the period: proven below, at or above 1.")
        .key(
            "growth_rate",
            Shape::OrNull(&ENCLOSURE),
            "ln(spectral radius)/T, per unit time, of the part where it is largest.",
        )
        .key(
            "masking",
            MASKING,
            "The frictions that mask every resonance: at lo something is proven to grow, at hi nothing does.",
        )
});

fn masking_keys() -> Keys {
    const RANGES: Shape = Shape::With(&Shape::List(&Shape::Object(range_keys)), r#"{"minItems": 1}"#);
    Keys::new()
        .key("lo", ROUNDED, "A double; a lower bound.")
        .key("hi", ROUNDED, "A double; an upper bound.")
        .key("stays", FLAG, "Whether every friction above hi is proven to mask, too.")
        .key(
            "ranges",
            RANGES,
            "Frictions that are proven to mask, from lo to hi; hi null where all larger ones are proven to.",
        )
}

fn range_keys() -> Keys {
    Keys::new().key("lo", ROUNDED, "A double, proven to mask.").key(
        "hi",
        Shape::OrNull(&ROUNDED),
        "A double, proven to mask.",
    )
}

/// The entry `friction` of a document.
pub fn value(own: &Friction) -> Value {
    let masking = match &own.masking {
        Mask::At(mask) => {
            let end = |hi: f64| hi.is_finite().then_some(hi);
            let ranges: Vec<Value> =
                mask.ranges.iter().map(|(lo, hi)| json!({"lo": lo, "hi": end(*hi)})).collect();
            json!({"lo": mask.grows, "hi": mask.least(), "stays": mask.stays(), "ranges": ranges})
        }
        Mask::NotNeeded => json!("nothing grows"),
        Mask::Undecided => json!("not told"),
    };
    json!({
        "rate": own.rate.to_string(),
        "damping": own.damping.map_or("not told", Damping::name),
        "growth_rate": own.growth.map(enclosure),
        "masking": masking,
    })
}

/// Lines for people.
pub fn lines(own: &Friction) -> Vec<String> {
    let radius = match own.damping {
        Some(Damping::Damped) => "spectral radius proven below 1: means and covariances stay bounded",
        Some(Damping::Marginal) => "spectral radius 1, exactly",
        Some(Damping::Growing) => "spectral radius proven above 1: it grows in spite of it",
        None => "doubles cannot decide whether the spectral radius is below 1",
    };
    let rate =
        own.growth.map_or(String::new(), |(lo, hi)| format!("; ln rho/T = {}", decimal::enclosure(lo, hi)));
    let mut lines = vec![format!("  with friction {}: {radius}{rate}", own.rate)];
    lines.push(match &own.masking {
        Mask::At(mask) => format!("  {} all growth{}", masking(mask, 1.0, ""), others(mask)),
        Mask::NotNeeded => "  nothing grows without friction".into(),
        Mask::Undecided => "  a friction that masks what may grow was not found".into(),
    });
    lines
}

/// A range that ends so soon is told as one friction.
const NARROW: f64 = 1.01;

/// "a friction above 1.5 masks", or "frictions of 1.5 to 2 mask", in another unit: so many of the old ones,
/// and its name.
pub(crate) fn masking(own: &Masked, unit: f64, name: &str) -> String {
    if own.stays() {
        let above = decimal::enclosure(unit * own.grows, unit * own.least());
        return format!("a friction above {above}{name} masks");
    }
    if let [(lo, hi)] = own.ranges[..]
        && hi <= NARROW * lo
    {
        return format!("a friction of about {}{name} masks", decimal::few(unit * lo, 6));
    }
    let range = |(lo, hi): &(f64, f64)| {
        let (lo, hi) = (unit * lo, unit * hi);
        if hi.is_finite() {
            let [lo, hi] = inward(lo, hi);
            format!("of {lo} to {hi}{name}")
        } else {
            format!("above {}{name}", inward(lo, 2.0 * lo)[0])
        }
    };
    format!("frictions {} mask", own.ranges.iter().map(range).collect::<Vec<_>>().join(" and "))
}

/// What is told of other frictions than those that `masking` names.
pub fn others(own: &Masked) -> &'static str {
    if own.stays() { ", and so does any larger one" } else { "; of others that is not proven" }
}

/// Two ends as few digits as lie between them with a tenth of what is between to spare, else all of them.
fn inward(lo: f64, hi: f64) -> [String; 2] {
    let ends = |digits: usize| {
        let unit = |x: f64| 10f64.powi(x.abs().log10().floor() as i32 + 1 - digits as i32);
        let (a, b) = ((lo / unit(lo)).ceil() * unit(lo), (hi / unit(hi)).floor() * unit(hi));
        let shown = [decimal::few(a, digits), decimal::few(b, digits)];
        let value = |text: &String| text.parse::<f64>().unwrap_or(f64::NAN);
        let room = 0.1 * (hi - lo);
        let (a, b) = (value(&shown[0]), value(&shown[1]));
        (lo <= a && a <= lo + room && hi - room <= b && b <= hi).then_some(shown)
    };
    let all = || [decimal::few(lo, 17), decimal::few(hi, 17)];
    (3..17).find_map(ends).unwrap_or_else(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_written_between_the_true_ones() {
        for (lo, hi) in
            [(0.039_257_3, 0.062_1), (1.169_847_771_23, 1.169_847_771_9), (3.0, 3e9), (1e-7, 2e-7)]
        {
            let [a, b] = inward(lo, hi).map(|text| text.parse::<f64>().unwrap());
            assert!(lo <= a && a < b && b <= hi, "{lo} {hi} {a} {b}");
        }
        let own = |ranges: &[(f64, f64)]| Masked { grows: 0.0392, ranges: ranges.to_vec() };
        let told = |own: &Masked| format!("{}{}", masking(own, 1.0, "/ps"), others(own));
        let two = own(&[(0.03926, 0.06), (3.0, f64::INFINITY)]);
        assert_eq!(
            told(&two),
            "frictions of 0.0393 to 0.06/ps and above 3/ps mask; of others that is not proven"
        );
        assert!(told(&own(&[(0.0393, f64::INFINITY)])).ends_with("masks, and so does any larger one"));
        assert!(told(&own(&[(0.0393, 0.0393)])).starts_with("a friction of about 0.0393/ps masks;"));
    }
}
