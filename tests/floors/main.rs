//! Rooms have the lines that ARCHITECTURE.md lists; no sources need each other in a circle. What a crate may
//! import, cargo keeps.

mod sources;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use sources::Sources;

/// A room as ARCHITECTURE.md lists it: its path below the repository, the most lines that it has.
struct Room {
    path: String,
    lines: usize,
}

/// The rooms of ARCHITECTURE.md, from the rows of its table that name a folder or a file of src/ or crates/.
fn rooms() -> Vec<Room> {
    let text = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let room = |line: &str| {
        let mut cells = line.strip_prefix("| `")?.split('|').map(str::trim);
        let path = cells.next()?.trim_end_matches('`').to_string();
        let lines = cells.next()?.replace(',', "").parse().ok()?;
        Some(Room { path, lines })
    };
    let rooms: Vec<Room> = text.lines().filter_map(room).collect();
    assert!(rooms.len() > 15, "only {} rooms found: does ARCHITECTURE.md have its table?", rooms.len());
    rooms
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The lines of a file, or of all sources below a folder.
fn lines(path: &Path) -> usize {
    if !path.is_dir() {
        let is_source = path.extension().is_some_and(|extension| extension == "rs");
        return if is_source { fs::read_to_string(path).unwrap().lines().count() } else { 0 };
    }
    fs::read_dir(path).unwrap().map(|entry| lines(&entry.unwrap().path())).sum()
}

#[test]
fn every_room_has_the_lines_that_its_list_allows() {
    let rooms = rooms();
    let (mut listed, mut wrong) = (0, Vec::new());
    for Room { path, lines: most } in &rooms {
        let found = lines(&root().join(path));
        listed += found;
        // A limit far above the lines that are there limits nothing: room for a small change, and no more.
        let least = most.saturating_sub(most / 20 + 60);
        if found > *most || found < least {
            wrong.push(format!("{path} has {found} lines, where ARCHITECTURE.md lists {most}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    let all = lines(&root().join("src")) + lines(&root().join("crates"));
    assert_eq!(listed, all, "ARCHITECTURE.md does not list all of src and crates");
}

fn sources() -> Sources {
    Sources::read(root())
}

/// Safe functions on them rest on who asks the processor first.
#[test]
fn registers_are_named_by_none_but_who_asks_the_processor() {
    let mut named = Vec::new();
    walk(&root().join("crates"), &mut |path, text| {
        if ["Avx2", "Avx512", "_mm256_", "_mm512_"].iter().any(|name| text.contains(name)) {
            named.push(path.strip_prefix(root()).unwrap().display().to_string());
        }
    });
    named.sort();
    assert_eq!(
        named,
        ["crates/number/src/vector/instructions.rs", "crates/number/src/vector/instructions/registers.rs"]
    );
    let types = fs::read_to_string(root().join(&named[1])).unwrap();
    assert!(!types.contains("pub(crate)") && !types.contains("pub struct"));
    let sets = fs::read_to_string(root().join(&named[0])).unwrap();
    assert!(sets.contains("pub struct Instructions(Set);") && sets.contains("\nenum Set {"));
}

/// Every source below a folder.
fn walk(folder: &Path, see: &mut impl FnMut(&Path, &str)) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            walk(&path, see);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            see(&path, &fs::read_to_string(&path).unwrap());
        }
    }
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
