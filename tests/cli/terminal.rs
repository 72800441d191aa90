//! What a terminal shows: lines that fit it, and the verdict in colour.

use super::support::{at_a_terminal, run, stdout, words};

const WATER: &str = "advise --period OH=10fs --period slow=40fs --steps 0.5fs,4fs --steps 0.5fs,5fs";
const RED: &str = "\u{1b}[1;31munstable\u{1b}[0m";

#[test]
fn no_line_is_wider_than_the_terminal_and_no_word_is_broken() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/water4.json");
    for line in [
        WATER.to_string(),
        format!("{WATER} --details"),
        format!("advise {scene} --details"),
        format!("system {scene}"),
        "verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 1/100 --h2 0.98".into(),
        "word --method respa-4 --lambda1 pi^2 --lambda2 pi^2/25 --h 1 --h-range 0..3".into(),
        "compare --max-sum 8 --rho 1/25 --samples 20 --details".into(),
        "tongues --ratio 3/2 --rho 1/25".into(),
        "tongues --help".into(),
    ] {
        let piped = stdout(&words(&format!("{line} --format text"), &[]));
        let known: Vec<&str> = piped.split_whitespace().collect();
        for columns in [80, 120] {
            let shown = at_a_terminal(&line, Some(columns), &[("NO_COLOR", "1")]).replace('\r', "");
            let wide: Vec<&str> = shown.lines().filter(|line| line.chars().count() > columns).collect();
            assert!(wide.is_empty(), "{columns} {line}: {wide:#?}");
            let note = "at most 8 digits here; left out here: ; a wider terminal or --format json has them";
            let is_new =
                |word: &&str| !known.contains(word) && !note.contains(word.trim_end_matches([';', ',']));
            let broken: Vec<&str> = shown.split_whitespace().filter(is_new).collect();
            // Rules of tables, and names of columns in the note, which end in a mark.
            let is_mark = |word: &str| word.trim_matches('-').is_empty() || word.ends_with([',', ';']);
            // Enclosures with fewer digits.
            let is_begun = |begin: &str| known.iter().any(|known| known.starts_with(begin));
            let is_shorter = |word: &str| word.contains('.') && word.get(..5).is_some_and(is_begun);
            assert!(
                broken.iter().all(|word| is_mark(word) || is_shorter(word)),
                "{columns} {line}: {broken:#?}"
            );
        }
    }
}

/// The upper edges were left out, for the sake of digits and of a column without a value.
#[test]
fn tongues_keep_both_edges_at_a_narrow_terminal() {
    for line in ["tongues --ratio 7/3 --rho 1/25", "tongues --ratio 2.333 --rho 1/25 --m 3"] {
        let shown =
            at_a_terminal(&format!("{line} --quiet"), Some(80), &[("NO_COLOR", "1")]).replace('\r', "");
        let head = shown.lines().find(|line| line.trim_start().starts_with("p ")).unwrap();
        assert!(head.contains("lower edge") && head.contains("upper edge"), "{shown}");
    }
}

/// Its last columns were left out, its edges among them.
#[test]
fn the_catalogue_keeps_order_cost_and_edges_at_a_narrow_terminal() {
    let shown = at_a_terminal("word --list --quiet", Some(80), &[("NO_COLOR", "1")]).replace('\r', "");
    let row = shown.lines().find(|line| line.starts_with("bcss-3 ")).unwrap();
    let cells: Vec<&str> = row.split_whitespace().collect();
    assert_eq!(cells[..5], ["bcss-3", "2", "3", "4.66185(1)", "1.55395(1)"], "{shown}");
}

#[test]
fn a_verdict_is_coloured_at_a_terminal_unless_nobody_wants_it() {
    let line = "verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 1/100 --h2 0.98";
    assert!(at_a_terminal(line, Some(80), &[]).starts_with(RED));
    for (flags, variables) in
        [("", [("NO_COLOR", "1")]), ("--color never", [("TERM", "xterm")]), ("", [("TERM", "dumb")])]
    {
        let shown = at_a_terminal(&format!("{line} {flags}"), Some(80), &variables);
        assert!(
            shown.starts_with("unstable: ") && !shown.contains('\u{1b}'),
            "{flags} {variables:?}: {shown}"
        );
    }
    // What is piped has colours where they are asked for alone, and documents have none.
    assert!(stdout(&words(line, &[])).starts_with("unstable: "));
    assert!(stdout(&words(line, &["--color", "always"])).starts_with(RED));
    let json = run(&words(line, &["--color", "always", "--format", "json"])).stdout;
    assert!(json.starts_with('{') && !json.contains('\u{1b}'), "{json}");
}
