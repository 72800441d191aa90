//! Every theorem that the documentation cites exists in proofs/Main.v or proofs/MatrixSigns.v.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let all = entries.flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] });
    all.filter(|path| path.extension().is_some_and(|extension| extension == "rs")).collect()
}

/// The names in backquotes that follow the word "theorem" or "theorems", up to " in proofs/".
fn cited(text: &str) -> Vec<String> {
    let joined: Vec<&str> = text
        .lines()
        .map(|line| line.trim().trim_start_matches("//!").trim_start_matches("///").trim())
        .collect();
    let joined = joined.join(" ").replace("Theorem", "theorem");
    let mut names = Vec::new();
    for rest in joined.split("theorem").skip(1) {
        let Some((list, _)) = rest.split_once(" in proofs/") else { continue };
        // A citation is short: "theorems" must not reach for the next "in proofs/" of another sentence.
        if list.len() < 120 {
            names.extend(list.split('`').skip(1).step_by(2).map(str::to_string));
        }
    }
    names
}

#[test]
fn every_cited_theorem_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |file: &str| fs::read_to_string(root.join("proofs").join(file)).unwrap();
    let statements = ["Main.v", "MatrixSigns.v", "ImplicitExplicitModes.v"].map(read).concat();
    let theorem = |line: &str| line.strip_prefix("Theorem ")?.split([' ', ':']).next().map(str::to_string);
    let proven: BTreeSet<String> = statements.lines().filter_map(theorem).collect();
    let mut all = BTreeSet::new();
    for path in ["src", "crates"].iter().flat_map(|folder| sources(&root.join(folder))) {
        for name in cited(&fs::read_to_string(&path).unwrap()) {
            assert!(proven.contains(&name), "{} cites `{name}`, which proofs/ does not have", path.display());
            all.insert(name);
        }
    }
    assert!(all.len() >= 15, "only {} citations found: is the test reading the sources? {all:?}", all.len());
}

#[test]
fn every_theorem_that_the_manuscript_names_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |file: &str| fs::read_to_string(root.join(file)).unwrap();
    let statements = read("proofs/Main.v") + &read("proofs/MatrixSigns.v");
    let text = read("paper/paper.tex") + &read("paper/supplement.tex");
    let named: BTreeSet<String> = text
        .split("\\coq{")
        .skip(1)
        .map(|rest| rest.split('}').next().unwrap().replace("\\_", "_"))
        .collect();
    assert!(named.len() > 15, "{named:?}");
    for name in named {
        assert!(statements.contains(&format!("Theorem {name} ")), "the manuscript names `{name}`");
    }
}

#[test]
fn citations_are_read_across_lines() {
    let text = "/// bounded (theorem `a_b` in proofs/), and\n/// (theorems `c`,\n/// `d` in proofs/).";
    assert_eq!(cited(text), ["a_b", "c", "d"]);
}

/// `kickdrift cite` prints one file or the other.
#[test]
fn the_entries_of_bibtex_say_what_the_citation_file_says() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |name| std::fs::read_to_string(root.join(name)).unwrap();
    let (cff, bib) = (read("CITATION.cff"), read("data/citation.bib"));
    let told = [
        "name",
        "version",
        "license",
        "title",
        "journal",
        "year",
        "volume",
        "issue",
        "doi",
        "family-names",
        "given-names",
        "start",
        "end",
    ];
    let mut count = 0;
    for line in cff.lines() {
        let Some((key, value)) = line.trim_start_matches([' ', '-']).split_once(": ") else { continue };
        if told.contains(&key) {
            assert!(bib.contains(value), "{key}: {value}");
            count += 1;
        }
    }
    assert_eq!(count, 18);
    assert!(bib.contains(&format!("version = {{{}}}", env!("CARGO_PKG_VERSION"))));
}
