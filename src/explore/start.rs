//! The session as the page receives it, with the limits of its questions.

use serde_json::{Value, json};

use super::query::Query;
use super::reply::Reply;
use super::session::Session;
use super::{point, tile};
use documents::question::shown_range;
use number::{Laurent, Result};

/// The session, or the plane of other stiffnesses: exact texts, and doubles to draw by.
pub(super) fn answer(session: &Session, query: &Query) -> Result<Reply> {
    let other = ["lambda1", "lambda2", "rho"].iter().any(|key| query.text(key).is_some());
    let own = match other {
        true => {
            let (lambda1, lambda2) = query.stiffnesses(session)?;
            Some(Session::new(lambda1, lambda2)?)
        }
        false => None,
    };
    let shown = own.as_ref().unwrap_or(session);
    let [h1, h2] = shown.window();
    let ends = |(lo, hi): &(Laurent, Laurent)| [lo.to_string(), hi.to_string()];
    let mut body = json!({
        "kickdrift": env!("CARGO_PKG_VERSION"),
        "h1": ends(h1), "h2": ends(h2), "ranges": [shown_range(h1), shown_range(h2)],
        "window": [h1.0.to_f64(), h1.1.to_f64(), h2.0.to_f64(), h2.1.to_f64()],
        "step": shown.step().to_string(),
        "unit": session.unit(),
        "title": session.title(),
        "limits": {
            "tile": {"kicks": tile::MOST_KICKS, "size": [tile::SIZES.0, tile::SIZES.1], "multiple": tile::LARGEST},
            "point": {"kicks": point::MOST_KICKS},
        },
        "system": session.system().map(|system| json!({"title": system.title(), "unit": system.time_unit()})),
        "lambda1": null, "lambda2": null, "rho": null, "values": null,
    });
    if let Some((lambda1, lambda2)) = shown.stiffnesses() {
        let rho = Laurent::ratio(lambda2, lambda1);
        body["lambda1"] = lambda1.to_string().into();
        body["lambda2"] = lambda2.to_string().into();
        body["rho"] = rho.map_or(Value::Null, |rho| rho.to_string().into());
        let (one, two) = (lambda1.to_f64(), lambda2.to_f64());
        body["values"] = json!({"lambda1": one, "lambda2": two, "rho": two / one});
    }
    Ok(Reply::json(&body))
}
