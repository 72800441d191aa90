//! What a release is made by, and what lies in its archives.

use std::path::Path;
use std::process::Command;

use regex_lite::Regex;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The workflows' names and texts.
fn workflows() -> Vec<(String, String)> {
    let folder = std::fs::read_dir(root().join(".github/workflows")).unwrap();
    let read =
        |path: std::path::PathBuf| (path.display().to_string(), std::fs::read_to_string(&path).unwrap());
    let found: Vec<_> = folder.map(|entry| read(entry.unwrap().path())).collect();
    assert!(found.len() >= 2);
    found
}

#[test]
fn every_action_is_named_by_the_hash_of_its_commit() {
    let pinned =
        Regex::new(r"uses: [A-Za-z0-9-]+/[A-Za-z0-9-]+@[0-9a-f]{40} # v[0-9]+\.[0-9]+\.[0-9]+$").unwrap();
    for (name, text) in workflows() {
        let used: Vec<&str> = text.lines().filter(|line| line.contains("uses:")).collect();
        assert!(!used.is_empty(), "{name}");
        used.iter().for_each(|line| assert!(pinned.is_match(line), "{name}: {line}"));
    }
}

#[test]
fn no_workflow_may_write_more_than_it_has_to() {
    for (name, text) in workflows() {
        let above = text.split("jobs:").next().unwrap();
        assert!(above.contains("\npermissions:\n  contents: read\n"), "{name}");
    }
}

/// What stands in `${{ }}` in a script is put in before a shell reads it: a tag could be a command.
#[test]
fn scripts_of_workflows_take_names_from_their_environment_only() {
    for (name, text) in workflows() {
        let mut depth = None;
        for line in text.lines() {
            let indent = line.len() - line.trim_start().len();
            if depth.is_some_and(|depth| indent <= depth && !line.trim().is_empty()) {
                depth = None;
            }
            let begins = line.trim_start().trim_start_matches("- ").starts_with("run:");
            assert!(!((begins || depth.is_some()) && line.contains("${{")), "{name}: {line}");
            if begins {
                depth = Some(indent);
            }
        }
    }
}

/// The page is in what people download.
#[test]
fn released_programs_have_the_page_and_the_notices_of_what_is_linked() {
    let text = std::fs::read_to_string(root().join(".github/workflows/release.yml")).unwrap();
    assert!(text.contains("cargo build --release --locked --features explore"));
    let notices =
        Command::new("python3").args([".ci/notices", "--features", "explore"]).current_dir(root()).output();
    let notices = notices.expect("python3 runs");
    assert!(notices.status.success(), "{}", String::from_utf8_lossy(&notices.stderr));
    let notices = String::from_utf8(notices.stdout).unwrap();
    for (name, licence) in
        [("axum", "MIT"), ("faer", "MIT"), ("tiny-skia", "BSD-3-Clause"), ("clap", "MIT OR Apache-2.0")]
    {
        let line = Regex::new(&format!(r"(?m)^{name} [0-9.]+: {licence};")).unwrap();
        assert!(line.is_match(&notices), "{name}");
    }
    let texts = notices.matches("Permission is hereby granted, free of charge").count();
    assert!(texts > 20 && notices.contains("Redistribution and use in source and binary forms"), "{texts}");
}

/// An installation resolves nothing anew: it takes the versions that were tested.
#[test]
fn every_installation_that_is_written_down_is_locked() {
    let pages = ["docs/index.md", "docs/page.md", "README.md", "python/README.md", "CONTRIBUTING.md"];
    for name in pages.into_iter().chain(["conda/recipe.yaml", "src/cli/explore.rs"]) {
        let text = std::fs::read_to_string(root().join(name)).unwrap();
        for line in text.lines().filter(|line| line.contains("cargo install")) {
            assert!(line.contains("--locked"), "{name}: {line}");
        }
    }
}

/// One version in all that names it.
#[test]
fn every_file_that_names_the_version_names_this_one() {
    let version = env!("CARGO_PKG_VERSION");
    for (name, line) in [
        ("Cargo.toml", format!("kickdrift-plot\", version = \"{version}\"")),
        ("crates/plot/Cargo.toml", format!("\nversion = \"{version}\"\n")),
        ("python/Cargo.toml", format!("\nversion = \"{version}\"\n")),
        ("CITATION.cff", format!("\nversion: {version}\n")),
        ("data/citation.bib", format!("version = {{{version}}},\n")),
        ("conda/recipe.yaml", format!("version: \"{version}\"\n")),
        (".zenodo.json", format!("\"version\": \"{version}\",\n")),
    ] {
        assert!(std::fs::read_to_string(root().join(name)).unwrap().contains(&line), "{name}: {line}");
    }
}
