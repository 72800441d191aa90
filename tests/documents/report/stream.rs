//! Streams of JSON.

use kickdrift::format::Format;
use kickdrift::report::document::Document;
use kickdrift::report::stream::JsonRows;
use serde_json::json;

#[test]
fn the_bytes_are_those_of_a_document() {
    for rows in [vec![json!({"p": 1}), json!({"p": 2, "lower": {"lo": 0.5, "hi": 0.5}})], vec![]] {
        let head = || Document::new("tongues").input("rho", "1/25");
        let mut streamed = Vec::new();
        let mut out = JsonRows::begin(&mut streamed, &head(), "tongues").unwrap();
        rows.iter().for_each(|row| out.row(&row.to_string()).unwrap());
        out.end(json!({"count": rows.len()}).as_object().unwrap()).unwrap();
        let whole = head().entry("tongues", rows.clone()).entry("count", rows.len());
        assert_eq!(String::from_utf8(streamed).unwrap(), whole.render(Format::Json).unwrap());
    }
}
