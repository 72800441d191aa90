//! A check that every row has passed, as a document.

use serde_json::Value;

use super::context::Outcome;
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{COUNT, Keys, Schema, Shape, TEXT, TEXTS};

/// A check, and NAME of the document that was checked.
type Told<'a> = (&'a Outcome, &'a str);

impl Outcome {
    /// The document `kickdrift/verify/1`: all rows of a file hold, whose document has this name.
    pub fn document(&self, file: &str, name: &str) -> Document {
        let Outcome { rows, route, sample, not_rechecked, .. } = self;
        let mut lines = vec![
            format!("{rows} of {rows} rows hold"),
            format!("  document     {name}, every value computed again from its input"),
            format!("  other route  {route}"),
        ];
        lines.extend(sample.map(|(drawn, of)| format!("  sample       {drawn} of {of}")));
        lines.extend(not_rechecked.iter().map(|field| format!("  not rechecked: {field}")));
        record().document(Document::new(NAME).input("file", file), &(self, name)).summary_alone(&lines)
    }
}

/// NAME in `kickdrift/NAME/1`.
const NAME: &str = "verify";

/// The schema of such documents, by their name.
pub fn schema() -> (&'static str, Value) {
    let about = "Written only where every row holds; a row that does not is an error that names it.";
    let title = "A document computed again, and rechecked by another route";
    let input = Keys::new().key("file", TEXT, "The file that was checked.");
    (NAME, Schema::new(title, record().keys()).about(about).value(NAME, &input))
}

fn record<'a>() -> Record<'a, Told<'a>> {
    const DOCUMENT: Shape = Shape::Plain(r#"{"type": "string", "pattern": "^kickdrift/[a-z-]+/1$"}"#);
    const NONE: Shape = Shape::Plain(r#"{"type": "array", "maxItems": 0}"#);
    Record::new()
        .value("document", |(_, name): &Told| format!("kickdrift/{name}/1").into())
        .says(DOCUMENT, "The schema of the document.")
        .json("rows", |(outcome, _)| outcome.rows.into())
        .says(COUNT, "")
        .json("holding", |(outcome, _)| outcome.rows.into())
        .says(COUNT, "")
        .json("route", |(outcome, _)| outcome.route.into())
        .says(TEXT, "In words, the other route.")
        .value("sample", |(outcome, _)| outcome.sample.map(|sample| drawn().entries(&sample)).into())
        .says(Shape::OrNull(&Shape::Object(|| drawn().keys())), "Pairs or ratios that the slower route took, drawn by the document's own input; null where it took all rows.")
        .value("not_rechecked", |(outcome, _)| outcome.not_rechecked.clone().into())
        .says(TEXTS, "Fields that were not rechecked, and why.")
        .value("failures", |_| Vec::<Value>::new().into())
        .says(NONE, "")
}

fn drawn() -> Record<'static, (u64, u64)> {
    Record::new()
        .json("drawn", |&(drawn, _): &(u64, u64)| drawn.into())
        .says(COUNT, "")
        .json("of", |&(_, all)| all.into())
        .says(COUNT, "")
}
