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
    let action = (String::from("action.yml"), std::fs::read_to_string(root().join("action.yml")).unwrap());
    for (name, text) in workflows().into_iter().chain([action]) {
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

/// The jobs of the release by name, with their texts.
fn release_jobs() -> Vec<(String, String)> {
    let text = std::fs::read_to_string(root().join(".github/workflows/release.yml")).unwrap();
    let heads = Regex::new(r"(?m)^  ([a-z]+):$").unwrap();
    let jobs = text.split_once("\njobs:\n").unwrap().1;
    let starts: Vec<_> =
        heads.captures_iter(jobs).map(|found| (found.get(0).unwrap().start(), found[1].to_owned())).collect();
    let ends = starts.iter().skip(1).map(|(start, _)| *start).chain([jobs.len()]);
    starts.iter().zip(ends).map(|((start, name), end)| (name.clone(), jobs[*start..end].to_owned())).collect()
}

/// The job of the release of this name.
fn release_job(wanted: &str) -> String {
    release_jobs().into_iter().find(|(name, _)| name == wanted).unwrap_or_else(|| panic!("no job {wanted}")).1
}

/// Whoever downloads a file can ask which commit and which workflow made it.
#[test]
fn every_file_that_a_release_holds_is_attested_before_it_is_uploaded() {
    let uploading: Vec<String> = release_jobs()
        .into_iter()
        .filter(|(_, job)| job.contains("gh release"))
        .map(|(name, _)| name)
        .collect();
    assert_eq!(uploading, ["upload"]);
    let upload = release_job("upload");
    let place = |text: &str| upload.find(text).unwrap_or_else(|| panic!("no {text}"));
    let [attested, named, sent] =
        ["uses: actions/attest-build-provenance@", "subject-path: files/*\n", "gh release upload"].map(place);
    assert!(attested < named && named < sent && upload[sent..].contains("files/*\n"));
    assert!(upload.contains("needs: [program, wheels, source, version]"));
    let pypi = release_job("pypi");
    assert!(
        pypi.find("pypi_attestations sign").unwrap()
            < pypi.find("upload --non-interactive --skip-existing --attestations").unwrap()
    );
}

/// A build script of any crate could take a token that is within its reach.
#[test]
fn whoever_builds_may_not_write_and_whoever_may_write_builds_nothing() {
    let builds = ["cargo build", "cargo test", "cargo package", "maturin-action", "pip install ."];
    let (mut building, mut writing) = (Vec::new(), Vec::new());
    for (name, job) in release_jobs() {
        let is_building = builds.iter().any(|own| job.contains(own));
        let is_writing = job.contains(": write");
        assert!(!(is_building && is_writing), "{name}");
        building.extend(is_building.then(|| name.clone()));
        writing.extend(is_writing.then_some(name));
    }
    assert_eq!((building.len(), writing), (4, ["upload", "crates", "pypi"].map(String::from).to_vec()));
    let crates = release_job("crates");
    let published: Vec<&str> = crates.lines().filter(|line| line.contains("cargo publish")).collect();
    assert!(published.len() == 2 && published.iter().all(|line| line.contains(" --no-verify ")));
    assert!(crates.contains("needs: [upload, verify]"));
    let verify = release_job("verify");
    assert!(verify.contains("cargo package --locked --workspace --exclude kickdrift-python\n"));
}

#[test]
fn no_checkout_leaves_its_token_in_the_folder() {
    for (name, text) in workflows() {
        let after: Vec<&str> = text.split("uses: actions/checkout@").skip(1).collect();
        assert!(!after.is_empty(), "{name}");
        for rest in after {
            let lines: Vec<&str> = rest.lines().skip(1).take(2).map(str::trim).collect();
            assert_eq!(lines, ["with:", "persist-credentials: false"], "{name}");
        }
    }
}

#[test]
fn what_uploads_to_pypi_is_named_by_its_hash() {
    assert!(
        release_job("pypi").contains("--require-hashes --no-deps --only-binary=:all: -r .ci/upload.txt\n")
    );
    let pins = std::fs::read_to_string(root().join(".ci/upload.txt")).unwrap();
    let pinned = Regex::new(r"^[A-Za-z0-9_.-]+==[A-Za-z0-9.]+ --hash=sha256:[0-9a-f]{64}$").unwrap();
    let lines: Vec<&str> = pins.lines().filter(|line| !line.starts_with('#')).collect();
    assert!(lines.len() > 20 && lines.iter().any(|line| line.starts_with("twine==")));
    lines.iter().for_each(|line| assert!(pinned.is_match(line), "{line}"));
}

/// A number with an underscore is an integer to some readers of YAML.
#[test]
fn programs_are_static_for_old_machines_and_wheels_are_there_without_the_lock() {
    for target in ["x86_64-unknown-linux-musl", "aarch64-unknown-linux-musl"] {
        assert!(release_job("program").contains(&format!("target: {target}}}")), "{target}");
    }
    let wheels = release_job("wheels");
    assert_eq!(wheels.matches("python: 3.14t, native: true").count(), 4);
    assert!(wheels.contains("not sys._is_gil_enabled()"));
    let unquoted = Regex::new(r"linux: [0-9]").unwrap();
    assert!(!unquoted.is_match(&wheels) && wheels.contains("linux: \"2_28\""));
}

/// What a reader is told to run is what is run on a fresh machine.
#[test]
fn the_tests_are_run_by_the_command_that_readme_names() {
    let read = |name| std::fs::read_to_string(root().join(name)).unwrap();
    let (readme, tests, run) = (read("README.md"), read("tests/README.md"), read(".ci/run"));
    let commands = readme.lines().filter(|line| line.starts_with("cargo test"));
    let [command] = commands.collect::<Vec<_>>().try_into().unwrap();
    let command = command.split(" #").next().unwrap().trim_end();
    let first = tests.split("|---|---|\n| `").nth(1).unwrap();
    assert!(first.starts_with(&format!("{command}` |")), "{first}");
    assert!(run.contains("stage \"tests\" readme_tests\n") && !run.contains("cargo test -"));
    let extracted = r"sed -n 's/^\(cargo test[^#]*\)#.*/\1/p' README.md";
    assert!(run.contains(extracted), "{extracted}");
    let printed = Command::new("sh").args(["-c", extracted]).current_dir(root()).output().unwrap();
    assert_eq!(String::from_utf8(printed.stdout).unwrap().trim_end(), command);
}

/// The site lists what each kind of answer is checked against, read from the tests.
#[test]
fn no_kind_of_answer_is_without_a_test_in_the_ledger() {
    let ledger = Command::new("python3").arg("docs/ledger.py").current_dir(root()).output();
    let ledger = ledger.expect("python3 runs");
    assert!(ledger.status.success(), "{}", String::from_utf8_lossy(&ledger.stderr));
    let entries = String::from_utf8(ledger.stdout).unwrap().matches(", against ").count();
    assert!(entries > 30, "{entries}");
}

/// The page is in what people download.
#[test]
fn released_programs_have_the_page_and_the_notices_of_what_is_linked() {
    let text = std::fs::read_to_string(root().join(".github/workflows/release.yml")).unwrap();
    assert!(text.contains("cargo build --release --locked\n"));
    let notices = Command::new("python3").arg(".ci/notices").current_dir(root()).output();
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

/// What cargo-binstall asks for is what a release has.
#[test]
fn archives_have_the_names_that_the_manifest_tells_installers() {
    let manifest = std::fs::read_to_string(root().join("Cargo.toml")).unwrap();
    assert!(manifest.contains("/v{ version }/kickdrift-v{ version }-{ target }.tar.gz\"\n"));
    assert!(manifest.contains("\"kickdrift-v{ version }-{ target }/{ bin }{ binary-ext }\"\n"));
    let program = release_job("program");
    assert!(program.contains("folder=kickdrift-$TAG-$CARGO_BUILD_TARGET\n"));
    assert!(program.contains("tar czf \"$folder.tar.gz\" \"$folder\"\n"));
    for machine in [
        "aarch64-apple-darwin",
        "x86_64-pc-windows-msvc",
        "x86_64-unknown-linux-gnu",
        "aarch64-unknown-linux-gnu",
    ] {
        assert!(program.contains(&format!("target: {machine}}}")), "{machine}");
    }
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

/// The oldest Rust is one number, and a job builds with it.
#[test]
fn the_oldest_rust_of_all_manifests_is_the_same_and_checked() {
    let oldest = concat!("\nrust-version = \"", env!("CARGO_PKG_RUST_VERSION"), "\"\n");
    for name in ["Cargo.toml", "crates/plot/Cargo.toml", "python/Cargo.toml"] {
        assert!(std::fs::read_to_string(root().join(name)).unwrap().contains(oldest), "{name}");
    }
    let checks = std::fs::read_to_string(root().join(".github/workflows/check.yml")).unwrap();
    assert!(checks.contains(r#"cargo "+$oldest" check --locked"#));
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
        ("codemeta.json", format!("\"version\": \"{version}\",\n")),
        ("conda/recipe.yaml", format!("version: \"{version}\"\n")),
        (".zenodo.json", format!("\"version\": \"{version}\",\n")),
    ] {
        assert!(std::fs::read_to_string(root().join(name)).unwrap().contains(&line), "{name}: {line}");
    }
}
