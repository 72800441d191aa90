//! XML: what i-PI's input and OpenMM's serialized integrators and systems have in common.

use std::ops::Range;

use roxmltree::{Document, Node, ParsingOptions};

use super::reading::Engine;
use number::{Error, Result};

/// Elements nested more deeply than this are none of an engine's.
const DEEPEST: usize = 200;

/// No element of an engine has as many attributes; reading them takes the square of their number.
const MOST_ATTRIBUTES: usize = 500;

/// Nodes of a text of 10 MB, each of at least two bytes.
const MOST_NODES: u32 = 5_000_000;

/// Whether a text is meant as XML: its first character, behind a byte order mark and white space.
pub(super) fn is_xml(text: &str) -> bool {
    text.trim_start_matches('\u{feff}').trim_start().starts_with('<')
}

pub(super) fn parse(text: &str) -> Result<Document<'_>> {
    sound(text)?;
    let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|cause| malformed(&cause.to_string()))
}

fn malformed(cause: &str) -> Error {
    Error::input("engine", "XML", format!("cannot be read: {cause}"))
}

/// One pass over the text, before anything is built. Where it is no XML, the parser says so.
fn sound(text: &str) -> Result<()> {
    let (mut at, mut depth) = (0, 0_usize);
    while let Some(open) = text[at..].find('<').map(|found| at + found) {
        let rest = &text[open..];
        // Brackets in these are no elements.
        let marks = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")];
        let mark = marks.iter().find(|(begin, _)| rest.starts_with(begin));
        let end = match mark {
            Some((begin, end)) => rest[begin.len()..].find(end).map(|found| begin.len() + found + end.len()),
            None => element(rest)?.map(|(end, change)| {
                depth = depth.saturating_add_signed(change);
                end
            }),
        };
        let Some(end) = end else { return Ok(()) };
        if depth > DEEPEST {
            return Err(Error::input("engine", "XML nested too deeply", "give the engine's own input"));
        }
        at = open + end;
    }
    Ok(())
}

/// Where the tag that begins a text ends, and by how much it changes the depth; `None` where it does not end.
fn element(rest: &str) -> Result<Option<(usize, isize)>> {
    let (mut quote, mut attributes) = (None, 0);
    for (i, byte) in rest.bytes().enumerate().skip(1) {
        match (quote, byte) {
            (Some(mark), _) if mark == byte => quote = None,
            (None, b'"' | b'\'') => quote = Some(byte),
            (None, b'=') => attributes += 1,
            (None, b'<') => return Ok(None),
            (None, b'>') => {
                let change = match rest.as_bytes()[1] {
                    b'/' => -1,
                    b'!' => 0,
                    _ => isize::from(rest.as_bytes()[i - 1] != b'/'),
                };
                return Ok(Some((i + 1, change)));
            }
            _ => {}
        }
        if attributes > MOST_ATTRIBUTES {
            let value = format!("an element of more than {MOST_ATTRIBUTES} attributes");
            return Err(Error::input("engine", value, "give the engine's own input"));
        }
    }
    Ok(None)
}

/// The engine by the root element.
///
/// # Errors
/// No XML; the root element of no engine.
pub(super) fn recognized(text: &str) -> Result<Engine> {
    let document = parse(text)?;
    match document.root_element().tag_name().name() {
        "simulation" => Ok(Engine::Ipi),
        "Integrator" | "System" => Ok(Engine::OpenMm),
        other => {
            let remedy = "begins the input of no engine that is known here (i-PI: simulation; OpenMM: Integrator, System)";
            Err(Error::input("engine", format!("<{other}>"), remedy))
        }
    }
}

/// The first element of this name, the root or below it.
pub(super) fn named<'a>(root: Node<'a, 'a>, name: &str) -> Option<Node<'a, 'a>> {
    root.descendants().find(|node| node.has_tag_name(name))
}

/// The first child of this name.
pub(super) fn child<'a>(node: Node<'a, 'a>, name: &str) -> Option<Node<'a, 'a>> {
    node.children().find(|node| node.has_tag_name(name))
}

/// The text of an element with its place, comments and white space around left out.
///
/// # Errors
/// Several pieces of text with comments between them.
pub(super) fn words<'a>(node: Node<'a, '_>, text: &'a str) -> Result<(&'a str, Range<usize>)> {
    let piece = |child: Node| {
        let own = text.get(child.range()).unwrap_or_default();
        let start = child.range().start + (own.len() - own.trim_start().len());
        (own.trim(), start..start + own.trim().len())
    };
    let mut pieces = node.children().filter(Node::is_text).map(piece).filter(|(text, _)| !text.is_empty());
    let first = pieces.next().unwrap_or(("", 0..0));
    match pieces.next() {
        None => Ok(first),
        Some((next, _)) => {
            let value = format!("{} ... {next}", first.0);
            Err(Error::input(node.tag_name().name(), value, "put the comment outside of the number"))
        }
    }
}
