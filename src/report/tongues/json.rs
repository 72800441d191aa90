//! One tongue as JSON.

use serde_json::{Map, Value, json};

use crate::report::digits::outward;
use crate::report::document::enclosure;
use crate::tongue::{Law, Peak, Predicted, Quantity, Request, Side, Tongue, TongueEdge};

/// The row of a tongue: `p, q, m, a, b, lower, upper, closed, width`, and what else is wanted, null where a tongue has
/// none of it.
pub fn row(tongue: &Tongue, request: &Request) -> Value {
    let (row, wanted) = (&tongue.row, &request.wanted);
    let (a, b) = row.family.unzip();
    let width = row.gap.upper.map(|_| enclosure(row.gap.width));
    let mut entries = vec![
        ("p", row.ratio.p().into()),
        ("q", row.ratio.q().into()),
        ("m", row.gap.m.into()),
        ("a", a.into()),
        ("b", b.into()),
        ("lower", edge(&tongue.lower, request)),
        ("upper", tongue.upper.as_ref().map_or(Value::Null, |upper| edge(upper, request))),
        ("closed", row.gap.closed.into()),
        ("width", width.into()),
    ];
    if wanted.growth {
        entries.push(("growth", row.peak.as_ref().map(|peak| growth(peak, tongue.growth_rate)).into()));
    }
    if wanted.predicted {
        entries.push(("predicted", row.predicted.as_ref().map(predicted).into()));
    }
    if wanted.first_order {
        entries.push(("first_order", row.first_order.as_ref().map(first_order).into()));
    }
    object(entries)
}

fn object(entries: Vec<(&str, Value)>) -> Value {
    Value::Object(entries.into_iter().map(|(key, value)| (key.to_string(), value)).collect::<Map<_, _>>())
}

/// `lo, hi, entry`, with closed forms `exact, on`, with L1 `h1, h2`.
fn edge(edge: &TongueEdge, request: &Request) -> Value {
    let mut value = quantity(&edge.s, request);
    let map = value.as_object_mut().expect("an enclosure is an object");
    map.insert("entry".into(), edge.entry.name().into());
    if request.wanted.exact {
        map.insert("exact".into(), edge.exact.as_ref().map(ToString::to_string).into());
        map.insert("on".into(), edge.on.map(|on| on.name()).into());
    }
    if let Some([h1, h2]) = &edge.steps {
        map.insert("h1".into(), quantity(h1, request));
        map.insert("h2".into(), quantity(h2, request));
    }
    value
}

/// `lo, hi`, with digits `decimal`.
fn quantity(quantity: &Quantity, request: &Request) -> Value {
    let mut value = enclosure((quantity.lo, quantity.hi));
    if let (Some([lo, hi]), Some(map)) = (decimal(quantity, request), value.as_object_mut()) {
        map.insert("decimal".into(), json!({"lo": lo, "hi": hi}));
    }
    value
}

/// Both ends in writing, where digits are asked for.
pub fn decimal(quantity: &Quantity, request: &Request) -> Option<[String; 2]> {
    let (precise, digits) = quantity.precise.as_ref().zip(request.digits)?;
    Some(outward(&precise.lo, &precise.hi, digits))
}

fn growth(peak: &Peak, growth_rate: Option<f64>) -> Value {
    let mut entries = vec![
        ("s", peak.s.into()),
        ("ln_multiplier", peak.ln_multiplier.into()),
        ("rate", peak.rate.into()),
        ("steps_until_tenfold", peak.slow_steps_to_tenfold.into()),
    ];
    if let Some(rate) = growth_rate {
        entries.push(("growth_rate", rate.into()));
    }
    object(entries)
}

/// Which of three places: the words of documents.
pub fn side(side: Side) -> &'static str {
    match side {
        Side::Inside => "inside",
        Side::OnLower | Side::OnUpper => "on the edge",
        Side::Below | Side::Above => "outside",
    }
}

fn predicted(predicted: &Predicted) -> Value {
    json!({
        "s": predicted.s,
        "side": side(predicted.side),
        "position": predicted.side.name(),
        "distance": predicted.distance,
    })
}

fn first_order(law: &Law) -> Value {
    json!({
        "centre": law.law.centre,
        "width": law.law.width,
        "ln_multiplier": law.law.ln_multiplier,
        "centre_error": law.centre_error,
        "width_error": law.width_error,
        "width_ratio": law.width_ratio,
    })
}
