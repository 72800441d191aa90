//! Certificates.

use kickdrift::number::parse::parse;
use kickdrift::propagator::Oscillator;
use kickdrift::report::certificate::coq;
use kickdrift::verdict::{Limits, decide};
use std::path::Path;

/// Every example in proofs/certificates is what its own first line makes, byte for byte.
#[test]
fn the_examples_are_what_the_command_writes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("proofs/certificates");
    let mut kinds = std::collections::BTreeSet::new();
    for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if path.extension().is_none_or(|extension| extension != "v") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let words: Vec<&str> = text.lines().next().unwrap().split_whitespace().collect();
        let value = |flag: &str| words[words.iter().position(|word| *word == flag).unwrap() + 1];
        let x = |flag: &str| parse(flag, value(flag)).unwrap();
        let oscillator = Oscillator::new(x("--lambda1"), x("--lambda2"), x("--h1"), x("--h2")).unwrap();
        let verdict = decide(&oscillator.clocks(), &Limits::default()).unwrap().verdict;
        assert_eq!(coq(&oscillator, verdict, value("--certificate")).unwrap(), text, "{}", path.display());
        kinds.insert((verdict.kind(), verdict.side()));
    }
    assert_eq!(kinds.len(), 7);
}

#[test]
fn irrational_input_and_bad_names_are_refused() {
    let x = |text| parse("x", text).unwrap();
    let oscillator = Oscillator::new(x("pi^2"), x("1"), x("1/4"), x("1")).unwrap();
    let verdict = decide(&oscillator.clocks(), &Limits::default()).unwrap().verdict;
    assert!(coq(&oscillator, verdict, "a.v").unwrap_err().to_string().contains("lambda1"));
    let rational = Oscillator::new(x("2"), x("1"), x("1/4"), x("1")).unwrap();
    for name in ["a b.v", "a.txt", ".v", "a-b.v"] {
        assert!(coq(&rational, verdict, name).is_err(), "{name}");
    }
}
