//! Imports go down only; siblings on one floor do not import each other; no sources need each other in a circle.

mod sources;

use std::collections::BTreeSet;
use std::path::Path;

use sources::Sources;

/// The floor of each module and of each crate in crates/; `error` lies below them all.
const FLOORS: [(&str, u32); 21] = [
    ("plot", 0),
    ("format", 0),
    ("vector", 0),
    ("number", 0),
    ("parallel", 0),
    ("schedule", 1),
    ("propagator", 2),
    ("orbit", 3),
    ("verdict", 4),
    ("resonance", 5),
    ("tongue", 6),
    ("map", 6),
    ("system", 6),
    ("avi", 6),
    ("advise", 7),
    ("scene", 8),
    ("report", 8),
    ("question", 9),
    ("recheck", 10),
    ("explore", 10),
    ("cli", 11),
];

fn floor(module: &str) -> u32 {
    FLOORS.iter().find(|(name, _)| *name == module).unwrap_or_else(|| panic!("{module} has no floor")).1
}

fn sources() -> Sources {
    Sources::read(Path::new(env!("CARGO_MANIFEST_DIR")))
}

#[test]
fn imports_go_down_only() {
    let mut seen = 0;
    for source in sources().all {
        let Some(module) = source.module.first() else { continue };
        for import in source.imports.iter().filter_map(|import| import.path.first()) {
            seen += 1;
            if import == "error" || import == module {
                continue;
            }
            let (own, other) = (floor(module), floor(import));
            assert!(other < own, "{} (floor {own}) imports {import} (floor {other})", source.file);
        }
    }
    assert!(seen > 500, "only {seen} imports found: is the test reading the sources?");
}

#[test]
fn no_sources_need_each_other_in_a_circle() {
    let sources = sources();
    let ties: usize = sources.ties().iter().map(BTreeSet::len).sum();
    assert!(ties > 500, "only {ties} ties found: is the test reading the sources?");
    let circles = sources.circles();
    assert!(circles.is_empty(), "circles: {circles:#?}");
}

fn texts(files: &[(&str, &str)]) -> Sources {
    let text = |&(file, text): &(&str, &str)| (file.to_string(), text.to_string());
    Sources::of(&files.iter().map(text).collect::<Vec<_>>())
}

#[test]
fn every_way_of_naming_a_module_is_seen() {
    let sources = texts(&[
        ("lib.rs", "mod a; mod b;"),
        ("a/mod.rs", "mod c; // use crate::b;\n /// [`crate::b`]\n fn f() { c::g() }"),
        (
            "a/c.rs",
            "use crate::{b::{self as d, X}, a::*}; use super::super::b::Y; use std::fmt;
             mod tests { use super::Z; fn f(s: &str) -> crate::b::W { self::g(\"crate::no\") } }",
        ),
        ("b.rs", "use e::F; fn f() { e::g::h() }"),
        ("crates/e/src/lib.rs", "mod g; pub use g::F; use crate::b; fn f() { a::c() }"),
        ("crates/e/src/g.rs", "use super::F; use crate::H;"),
    ]);
    let paths = |at: usize| -> Vec<String> {
        sources.all[at].imports.iter().map(|import| import.path.join("::")).collect()
    };
    assert_eq!(paths(3), ["e::F", "e::g::h"]);
    assert_eq!(paths(4), ["e::g::F", "e::b"]);
    assert_eq!(paths(5), ["e::F", "e::H"]);
    assert_eq!(paths(1), ["a::c::g"]);
    assert_eq!(paths(2), ["b", "b::X", "a", "b::Y", "a::c::Z", "b::W", "a::c::tests::g"]);
}

#[test]
fn circles_are_found_through_re_exports_and_nowhere_else() {
    let files = |b: &'static str, root: &'static str| {
        let circles = |sources: Sources| -> Vec<Vec<String>> {
            let owned = |circle: &BTreeSet<&str>| circle.iter().map(|file| file.to_string()).collect();
            sources.circles().iter().map(owned).collect()
        };
        circles(texts(&[
            ("a/b.rs", b),
            ("a/c.rs", "use super::b::B; pub struct C;"),
            ("a/mod.rs", root),
            ("lib.rs", ""),
        ]))
    };
    let hands_on = "mod b; mod c; pub use b::B; pub use c::C;";
    assert_eq!(files("use super::C; pub struct B;", hands_on), [["a/b.rs", "a/c.rs"]]);
    assert!(files("pub struct B;", hands_on).is_empty());
    // Tests may look up.
    assert!(files("pub struct B; #[cfg(test)] mod tests { use crate::a::C; }", hands_on).is_empty());
    // What uses a name itself does not only hand it on.
    let uses = "mod b; mod c; pub use b::B; pub struct A(B);";
    assert_eq!(files("use super::A; pub struct B;", uses), [["a/b.rs", "a/mod.rs"]]);
}
