//! The summary of a run: the files of the products that its scene wants.

use std::path::Path;

use serde_json::{Map, Value};

use super::context::{Context, Outcome};
use super::kind::{Again, Kind, asked};
use crate::question::Scene;
use number::Result;

const ROUTE: &str = "none: the files are named again from what the scene wants";

/// The folder is a place, one for all files: it is taken from the first of them.
pub const KIND: Kind = Kind {
    name: "run",
    table: "products",
    excluded: &[],
    by_input: false,
    read: |document| asked::<Scene>(document).map(drop),
    again: recompute,
};

fn recompute<'a>(document: &Map<String, Value>, _: &'a Context<'a>) -> Result<Again<'a>> {
    let scene: Scene = asked(document)?;
    scene.check()?;
    let files = document.get("products").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    let first = files.first().and_then(|product| product.get("file")).and_then(Value::as_str);
    let folder = first.and_then(|file| Path::new(file).parent()).unwrap_or(Path::new(""));
    let mut outcome = Outcome::holding(ROUTE, files.len() as u64);
    outcome.not_rechecked = [
        "input.*: the summary holds nothing of it but what is wanted",
        "which folder the files are in, and what they hold: verify those that are documents",
    ]
    .map(String::from)
    .to_vec();
    Ok((scene.written(folder).value(), Box::new(move || Ok(outcome))))
}
