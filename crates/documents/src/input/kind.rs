//! Kinds of files, by their schemas, and the commands that read them.

use number::Error;

/// A command for files of each kind, by their schemas, and what these are.
const READERS: [(&str, &str); 3] = [
    ("kickdrift/scene/1", "a scene: kickdrift run FILE computes what it asks for"),
    ("kickdrift/system/1", "a system: kickdrift system FILE says whether it is stable"),
    ("kickdrift/part/1", "the map of a folder with parts: kickdrift merge joins these"),
];

/// The error of a file of another kind than the one that is read: the command that reads it, or what is read.
pub fn of_another_kind(schema: &str, read: &str) -> Error {
    let known = READERS.iter().find(|(text, _)| *text == schema).map(|(_, what)| format!("is {what}"));
    let remedy = known.unwrap_or_else(|| match schema.strip_prefix("kickdrift/") {
        Some(name) if name.ends_with("/1") => {
            "is an answer of kickdrift: kickdrift verify FILE rechecks it".into()
        }
        _ => format!("this version reads {read}"),
    });
    Error::input("schema", schema, remedy)
}

/// Whether a schema is one of what is asked, not of an answer.
pub fn is_asked(schema: &str) -> bool {
    READERS.iter().any(|(text, _)| *text == schema)
}
