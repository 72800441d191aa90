//! Friction in JSON and in words.

use serde_json::Value;

use super::decimal;
use super::record::Record;
use super::shape::{ENCLOSURE, FLAG, ROUNDED, ROUNDED_OR_NULL, Shape, TEXT};
use super::table::Cell;
use systems::friction::{Damping, Friction, Mask, Masked};

/// The sentence on the entry `friction` of a document.
pub const SAYS: &str =
    "O-steps, v to exp(-rate t) v in the middle of every drift; only where a rate was given.";

/// What it is.
pub const SHAPE: Shape = Shape::Object(|| record().keys());

/// The entry `friction` of a document.
pub fn value(friction: &Friction) -> Value {
    record().entries(friction)
}

fn record() -> Record<'static, Friction> {
    const DAMPING: Shape = Shape::OneOf(&["damped", "marginal", "growing", "not told"]);
    const MASKING: Shape =
        Shape::Any(&[Shape::OneOf(&["nothing grows", "not told"]), Shape::Object(|| masked().keys())]);
    Record::new()
        .json("rate", |friction: &Friction| Cell::exact(&friction.rate))
        .says(TEXT, "Exact, per unit time.")
        .json("damping", |friction| friction.damping.map_or("not told", Damping::name).into())
        .says(DAMPING, "The spectral radius of the period: proven below, at or above 1.")
        .json("growth_rate", |friction| friction.growth.into())
        .says(
            Shape::OrNull(&ENCLOSURE),
            "ln(spectral radius)/T, per unit time, of the part where it is largest.",
        )
        .value("masking", |friction| match &friction.masking {
            Mask::At(mask) => masked().entries(mask),
            Mask::NotNeeded => "nothing grows".into(),
            Mask::Undecided => "not told".into(),
        })
        .says(
            MASKING,
            "The frictions that mask every resonance: at lo something is proven to grow, at hi nothing does.",
        )
}

fn masked() -> Record<'static, Masked> {
    const RANGES: Shape = Shape::With(&Shape::List(&Shape::Object(|| range().keys())), r#"{"minItems": 1}"#);
    Record::new()
        .json("lo", |mask: &Masked| mask.grows.into())
        .says(ROUNDED, "A double; a lower bound.")
        .json("hi", |mask| mask.least().into())
        .says(ROUNDED, "A double; an upper bound.")
        .json("stays", |mask| mask.stays().into())
        .says(FLAG, "Whether every friction above hi is proven to mask, too.")
        .value("ranges", |mask| range().all(&mask.ranges).into())
        .says(
            RANGES,
            "Frictions that are proven to mask, from lo to hi; hi null where all larger ones are proven to.",
        )
}

fn range() -> Record<'static, (f64, f64)> {
    Record::new()
        .json("lo", |&(lo, _): &(f64, f64)| lo.into())
        .says(ROUNDED, "A double, proven to mask.")
        .json("hi", |&(_, hi)| hi.is_finite().then_some(hi).into())
        .says(ROUNDED_OR_NULL, "A double, proven to mask.")
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
        Mask::At(mask) if mask.stays() => {
            let above = decimal::enclosure(mask.grows, mask.least());
            format!("  a friction above {above} masks all growth{}", others(mask))
        }
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
        return format!("a friction above {}{name} masks", above(unit * own.least()));
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
            format!("above {}{name}", above(lo))
        }
    };
    format!("frictions {} mask", own.ranges.iter().map(range).collect::<Vec<_>>().join(" and "))
}

/// What is told of other frictions than those that `masking` names.
pub fn others(own: &Masked) -> &'static str {
    if own.stays() { ", and so does any larger one" } else { "; of others that is not proven" }
}

/// A few digits of a number that is no less.
pub(crate) fn above(x: f64) -> String {
    let [above, _] = inward(x, 2.0 * x);
    above
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
