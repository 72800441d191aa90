//! The steps of action.yml as a runner takes them, on the program that is built here in place of the wheel's.

use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

use super::support::{Desk, Ended};

/// A Python whose virtual environments hold this program, and whose pip notes what it is asked for.
const PYTHON: &str = r#"#!/bin/sh
case "$2" in
venv) mkdir -p "$3/bin" && cp "$0" "$3/bin/python" && ln -s "$BUILT" "$3/bin/kickdrift" ;;
pip) shift 2 && echo "$*" > asked ;;
esac
"#;

/// The script of the n-th step.
fn script(n: usize) -> String {
    let action = Path::new(env!("CARGO_MANIFEST_DIR")).join("action.yml");
    let text = std::fs::read_to_string(action).unwrap();
    let step = text.split("run: |\n").nth(n + 1).unwrap();
    let inside =
        step.lines().map_while(|line| line.strip_prefix("        ").or(line.is_empty().then_some("")));
    inside.collect::<Vec<_>>().join("\n")
}

/// The n-th step, by the command that a runner takes for `shell: bash`.
fn step(desk: &Desk, n: usize, variables: &[(&str, &str)]) -> Ended {
    desk.write("step.sh", &script(n));
    let path = format!("{}:{}", desk.path().display(), std::env::var("PATH").unwrap());
    let mut command = Command::new("bash");
    command.args(["--noprofile", "--norc", "-eo", "pipefail", "step.sh"]).current_dir(desk.path());
    command.env("PATH", path).env("BUILT", env!("CARGO_BIN_EXE_kickdrift"));
    let output = command.envs(variables.iter().copied()).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Ended { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
}

/// A desk with the program installed, and where its programs are.
fn installed(version: &str) -> (Desk, String) {
    let desk = Desk::new();
    desk.write("python3", PYTHON);
    std::fs::set_permissions(desk.path().join("python3"), PermissionsExt::from_mode(0o755)).unwrap();
    let home = desk.path().to_str().unwrap();
    let ended = step(
        &desk,
        0,
        &[("RUNNER_TEMP", home), ("GITHUB_OUTPUT", &format!("{home}/output")), ("VERSION", version)],
    );
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    let output = String::from_utf8(desk.read("output")).unwrap();
    let programs = output.trim().strip_prefix("programs=").unwrap().to_string();
    (desk, programs)
}

fn checked(files: &[&str], words: &str, engines: &str) -> Ended {
    let (desk, programs) = installed("");
    for name in files {
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/words").join(name);
        std::fs::copy(data, desk.path().join(name)).unwrap();
    }
    desk.write("run.mdp", "integrator = md-vv\ndt = 0.002\nconstraints = none\n");
    desk.write("long.mdp", "integrator = md-vv\ndt = 0.004\nconstraints = none\n");
    let known = "--period OH=10fs --period slow=40fs";
    let variables =
        [("PROGRAMS", programs.as_str()), ("WORDS", words), ("ENGINES", engines), ("ADVISE", known)];
    step(&desk, 1, &variables)
}

#[test]
fn the_version_that_is_asked_for_is_installed_from_its_wheel() {
    for (version, wanted) in [("", "kickdrift"), ("0.1.0", "kickdrift==0.1.0")] {
        let (desk, programs) = installed(version);
        assert!(Path::new(&programs).join("kickdrift").exists());
        let asked = String::from_utf8(desk.read("asked")).unwrap();
        assert_eq!(asked, format!("install --quiet --only-binary :all: {wanted}\n"));
    }
}

#[test]
fn claims_that_hold_pass_and_each_that_does_not_is_told() {
    let ended = checked(&["claims.toml"], "claims.toml\n", "");
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    assert!(ended.stdout.ends_with("claims about 6 words: all hold\n"), "{}", ended.stdout);
    // A file that fails does not keep the next one from being checked.
    let ended = checked(&["claims.toml", "swapped.toml"], "sw*.toml\nclaims.toml", "");
    assert_eq!(ended.code, Some(1));
    assert!(ended.stdout.contains("that do not hold: 2 of 3\n"), "{}", ended.stdout);
    assert!(ended.stdout.ends_with("all hold\n"), "{}", ended.stdout);
}

#[test]
fn inputs_of_engines_pass_where_their_steps_are_proven_stable() {
    let ended = checked(&[], "", "run.mdp");
    assert_eq!(ended.code, Some(0), "{}{}", ended.stdout, ended.stderr);
    let ended = checked(&[], "", "*.mdp");
    assert_eq!(ended.code, Some(1), "{}{}", ended.stdout, ended.stderr);
    assert!(ended.stdout.contains("--engine run.mdp") && ended.stdout.contains("--engine long.mdp"));
}

#[test]
fn a_pattern_without_files_and_nothing_at_all_are_no_passes() {
    let ended = checked(&[], "none*.toml", "");
    assert_eq!(ended.code, Some(1));
    assert!(ended.stderr.contains("none*.toml: cannot read it"), "{}", ended.stderr);
    let ended = checked(&[], "", "");
    assert_eq!(
        (ended.code, ended.stdout.lines().last()),
        (Some(2), Some("kickdrift: nothing to check: give words or engines"))
    );
}
