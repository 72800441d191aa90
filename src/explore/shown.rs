//! Files to keep of the plane shown: a scene that makes it again, and its picture as for a paper.

use serde_json::json;

use super::query::{Query, positive};
use super::reply::Reply;
use super::session::Session;
use clocks::map::Products;
use documents::format::Format;
use documents::question::{FAMILIES, Map, Question, Scene, Work, shown_range};
use documents::report::figure::file;
use documents::report::map::Counts;
use documents::report::plane::{Chart, Colouring, window};
use number::{Error, Laurent, Result};

/// Pairs and kicks of a picture.
const MOST_PAIRS: u64 = 4_000_000;
pub(super) const MOST_KICKS: u64 = 20_000_000_000;

/// The map of what is shown.
fn map(session: &Session, query: &Query) -> Result<Map> {
    let (lambda1, lambda2) = query.stiffnesses(session)?;
    let [h1_range, h2_range] = query.window(session)?;
    let step = query.read("step", positive)?.unwrap_or_else(|| session.step().clone());
    let step2 = query.read("step2", positive)?.unwrap_or_else(|| step.clone());
    let [step1, step2] = [step, step2].map(Laurent::from_rational);
    Ok(Map { lambda1, lambda2, step1, step2, h1_range, h2_range, ..Map::default() })
}

/// A scene file: `kickdrift run` makes the map and its picture from it.
pub(super) fn scene(session: &Session, query: &Query) -> Result<Reply> {
    let Map { lambda1, lambda2, step1, step2, h1_range, h2_range, .. } = map(session, query)?;
    let scene = json!({
        "schema": "kickdrift/scene/1",
        "title": if session.title().is_empty() { "Explored" } else { session.title() },
        "lambda1": lambda1.to_string(), "lambda2": lambda2.to_string(),
        "grid": {
            "step1": step1.to_string(), "step2": step2.to_string(), "h1": shown_range(&h1_range), "h2": shown_range(&h2_range),
        },
        "want": ["map.json", "overlay.svg"],
    });
    let text = format!("{scene:#}\n");
    // A scene that is kept can be read again.
    Scene::from_json(&text)?;
    Ok(Reply::file("scene.json", "application/json", text.into_bytes()))
}

/// The picture that `kickdrift map` draws of the same pairs: `format` svg, png or pdf, `what` as for tiles,
/// `curves` 1 to draw them.
pub(super) fn picture(session: &Session, query: &Query) -> Result<Reply> {
    let format = query.read("format", figure)?.unwrap_or(Format::Svg);
    let colouring = query.read("what", colouring)?.unwrap_or_default();
    let map = map(session, query)?;
    let grid = map.grid()?;
    if grid.pairs() > MOST_PAIRS || grid.kicks() > MOST_KICKS as f64 {
        let (pairs, kicks) = (grid.pairs(), grid.kicks());
        let message =
            format!("this picture of {pairs} pairs composes about {kicks:.1e} kicks: choose a larger step");
        return Ok(Reply::too_costly(Some(kicks), MOST_KICKS, &message));
    }
    let curves = match query.text("curves") {
        Some("1") => FAMILIES.curves(grid.lambdas().0, &window(&grid))?,
        _ => Vec::new(),
    };
    let coloured = query.text("what").filter(|_| colouring != Colouring::default());
    let coloured = coloured.map(|what| format!(" --colour {what}"));
    let flags =
        coloured.unwrap_or_default() + if query.text("curves") == Some("1") { " --curves" } else { "" };
    let (mut chart, mut counts) = (Chart::new(&grid, colouring), Counts::default());
    let Products { label, growth } = colouring.needs();
    let work = Work { threads: 1, ..Work::default() };
    Map { label, growth, ..map.clone() }.each(&grid, None, &work, |band| {
        chart.add(&grid, &band);
        counts.add(&band);
        Ok(())
    })?;
    let figure = chart.figure(&grid, &counts, &curves).footed(&map.foot());
    let bytes = file(figure, &(map.command() + &flags), format)?;
    let (name, media) = match format {
        Format::Png => ("map.png", "image/png"),
        Format::Pdf => ("map.pdf", "application/pdf"),
        _ => ("map.svg", "image/svg+xml"),
    };
    Ok(Reply::file(name, media, bytes))
}

fn figure(field: &str, text: &str) -> Result<Format> {
    let format = Format::of_extension(text).filter(|format| format.is_figure());
    format.ok_or_else(|| Error::input(field, text, "choose svg, png or pdf"))
}

fn colouring(field: &str, text: &str) -> Result<Colouring> {
    match text {
        "verdict" => Ok(Colouring::Verdict),
        "growth" => Ok(Colouring::Growth),
        "family" => Ok(Colouring::Family),
        "tenfold" => Ok(Colouring::Tenfold),
        _ => Err(Error::input(field, text, "choose verdict, growth, family or tenfold")),
    }
}
