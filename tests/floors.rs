//! Imports go down only; siblings on one floor do not import each other.

use std::fs;
use std::path::{Path, PathBuf};

/// The floor of each module; `error` may be used by all.
const FLOORS: [(&str, u32); 18] = [
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
    ("recheck", 7),
    ("scene", 8),
    ("report", 8),
    ("cli", 9),
    ("explore", 9),
];

fn floor(module: &str) -> u32 {
    FLOORS.iter().find(|(name, _)| *name == module).unwrap_or_else(|| panic!("{module} has no floor")).1
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] }).collect()
}

/// The modules that a source names after `crate::`, comments left out.
fn imports(text: &str) -> Vec<String> {
    let code = text.lines().map(|line| line.split("//").next().unwrap_or(""));
    let code =
        code.inspect(|line| assert!(!line.contains("crate::{"), "name each module on its own: {line}"));
    let named = code.flat_map(|line| line.split("crate::").skip(1).map(str::to_string).collect::<Vec<_>>());
    let first = |rest: String| {
        rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or("").to_string()
    };
    named.map(first).filter(|module| !module.is_empty() && module != "error").collect()
}

#[test]
fn imports_go_down_only() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut seen = 0;
    for path in sources(&root) {
        let inside = path.strip_prefix(&root).unwrap();
        let Some(module) = inside.parent().and_then(|parent| parent.iter().next()) else { continue };
        let module = module.to_str().unwrap();
        for import in imports(&fs::read_to_string(&path).unwrap()) {
            seen += 1;
            let down = import == module || floor(&import) < floor(module);
            assert!(
                down,
                "{} (floor {}) imports {import} (floor {})",
                inside.display(),
                floor(module),
                floor(&import)
            );
        }
    }
    assert!(seen > 100, "only {seen} imports found: is the test reading the sources?");
}
