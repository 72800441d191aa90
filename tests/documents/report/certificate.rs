//! Certificates.

use kickdrift::number::Laurent;
use kickdrift::number::parse::parse;
use kickdrift::propagator::Oscillator;
use kickdrift::report::certificate::{coq, coq_of_tongue, coq_of_word};
use kickdrift::tongue::Tongues;
use kickdrift::verdict::{Limits, decide};
use kickdrift::word::{Forces, Word, at};
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
        if words[2] == "word" {
            assert_eq!(of_word(&text), text, "{}", path.display());
            continue;
        }
        if words[2] == "tongues" {
            let (ratio, rho) = (value("--ratio").parse().unwrap(), x("--rho").as_rational().unwrap());
            let gap = Tongues::new(ratio, &rho).unwrap().gap(value("--m").parse().unwrap()).unwrap();
            assert_eq!(coq_of_tongue(ratio, &rho, &gap, value("--certificate")).unwrap(), text);
            continue;
        }
        let oscillator = Oscillator::new(x("--lambda1"), x("--lambda2"), x("--h1"), x("--h2")).unwrap();
        let verdict = decide(&oscillator.clocks().unwrap(), &Limits::default()).unwrap().verdict;
        assert_eq!(coq(&oscillator, verdict, value("--certificate")).unwrap(), text, "{}", path.display());
        kinds.insert((verdict.kind(), verdict.side()));
    }
    assert_eq!(kinds.len(), 7);
}

/// The certificate that the command in the first line of a word's certificate writes.
fn of_word(text: &str) -> String {
    let parts: Vec<&str> = text.lines().next().unwrap().split('"').collect();
    let flags: Vec<&str> = parts[2].split_whitespace().collect();
    let value = |flag: &str| flags.iter().position(|own| *own == flag).map_or("0", |place| flags[place + 1]);
    let [h, lambda1, lambda2] =
        ["--h", "--lambda1", "--lambda2"].map(|flag| parse(flag, value(flag)).unwrap());
    certified(parts[1], [&h, &lambda1, &lambda2], value("--certificate")).unwrap()
}

fn certified(
    word: &str,
    [h, lambda1, lambda2]: [&Laurent; 3],
    name: &str,
) -> kickdrift::error::Result<String> {
    let word: Word = word.parse().unwrap();
    let rho = Laurent::ratio(lambda2, lambda1).unwrap_or_default();
    let found = at(&word.polynomials(&Forces::ratio(&rho)), &(&(h * h) * lambda1)).unwrap();
    coq_of_word(&word, &found, [h, lambda1, lambda2], name)
}

/// Repeated letters are written out, and what has no fractions is refused in one line that names it.
#[test]
fn words_have_certificates_where_their_numbers_are_fractions() {
    let x = |text: &str| parse("x", text).unwrap();
    let (one, half) = (x("1"), x("1/2"));
    let text =
        certified("K2(1/2) 2*(K1(0.25) C1(1/2) K1(1/4)) K2(1/2)", [&half, &one, &half], "a.v").unwrap();
    let inside = "K First [1 # 4]; C First (1 # 2); K First [1 # 4]";
    assert!(
        text.contains(&format!(" [K Second [1 # 2]; {inside}; {inside}; K Second [1 # 2]] (1 / 2) ")),
        "{text}"
    );
    assert!(
        text.contains("word \"K2(1/2) K1(1/4) C1(1/2) ") && text.contains("--lambda2 1/2 --h 1/2"),
        "{text}"
    );
    let none = Laurent::from_integer(0);
    for (word, numbers, wanted) in [
        ("K((3-sqrt(3))/6) D(1)", [&half, &one, &none], "rational coefficients"),
        ("K2[sinc(x)](1) D(1)", [&half, &one, &half], "rational coefficients"),
        ("K(1) D(1)", [&x("pi"), &one, &none], "without pi"),
    ] {
        let error = certified(word, numbers, "a.v").unwrap_err().to_string();
        assert!(error.contains(wanted) && !error.contains('\n'), "{error}");
    }
}

/// As many kicks as a certificate may have: elliptic and hyperbolic, with pi and without, and a tongue's
/// edges. Needs coqc and the compiled theory (make -C proofs theory); some three minutes of Coq's time.
#[test]
#[ignore = "three minutes of Coq"]
fn what_is_allowed_is_proven() {
    let proofs = Path::new(env!("CARGO_MANIFEST_DIR")).join("proofs");
    let folder = std::env::temp_dir().join(format!("kickdrift-certificates-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let proven = |name: &str, text: String| {
        let file = folder.join(name);
        std::fs::write(&file, text).unwrap();
        let check =
            std::process::Command::new("sh").arg(proofs.join("tools/certificate.sh")).arg(&file).output();
        let check = check.unwrap();
        assert!(check.status.success(), "{name}: {}", String::from_utf8_lossy(&check.stdout));
    };
    let x = |text: &str| parse("x", text).unwrap();
    for (name, lambda1, lambda2, h1, h2) in [
        ("pi_elliptic.v", "pi^2", "pi^2/25", "2499/10000", "2501/10000"),
        ("pi_hyperbolic.v", "pi^2", "pi^2/25", "631/1000", "4369/1000"),
        ("elliptic.v", "10", "2/5", "2499/10000", "2501/10000"),
        ("hyperbolic.v", "10", "2/5", "631/1000", "4369/1000"),
    ] {
        let oscillator = Oscillator::new(x(lambda1), x(lambda2), x(h1), x(h2)).unwrap();
        assert_eq!(oscillator.clocks().unwrap().p() + oscillator.clocks().unwrap().q(), 5000, "{name}");
        let verdict = decide(&oscillator.clocks().unwrap(), &Limits::default()).unwrap().verdict;
        proven(name, coq(&oscillator, verdict, name).unwrap());
    }
    let (ratio, rho) = ("667/333".parse().unwrap(), x("1/25").as_rational().unwrap());
    let gap = Tongues::new(ratio, &rho).unwrap().gap(333).unwrap();
    proven("edges.v", coq_of_tongue(ratio, &rho, &gap, "edges.v").unwrap());
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn sums_with_pi_edges_with_pi_and_bad_names_are_refused() {
    let x = |text: &str| parse("x", text).unwrap();
    let file = |[lambda1, lambda2, h1, h2]: [&str; 4], name: &str| {
        let oscillator = Oscillator::new(x(lambda1), x(lambda2), x(h1), x(h2)).unwrap();
        let verdict = decide(&oscillator.clocks().unwrap(), &Limits::default()).unwrap().verdict;
        coq(&oscillator, verdict, name)
    };
    assert!(file(["1 + pi", "1", "1/4", "1"], "a.v").unwrap_err().to_string().contains("lambda1"));
    // s = 2, q = 1, p even: an edge exactly, whatever the slow stiffness.
    assert!(file(["2*pi^2", "pi^2", "1/pi", "2/pi"], "a.v").unwrap_err().to_string().contains("edge"));
    for name in ["a b.v", "a.txt", ".v", "a-b.v"] {
        assert!(file(["2", "1", "1/4", "1"], name).is_err(), "{name}");
    }
}

/// Exact numbers gain digits with every kick: where a verdict holds around its input, many kicks are proven
/// by intervals.
#[test]
fn many_kicks_are_proven_by_intervals_and_edges_never() {
    let x = |text: &str| parse("x", text).unwrap();
    let file = |[lambda1, lambda2, h1, h2]: [&str; 4]| {
        let oscillator = Oscillator::new(x(lambda1), x(lambda2), x(h1), x(h2)).unwrap();
        let verdict = decide(&oscillator.clocks().unwrap(), &Limits::default()).unwrap().verdict;
        coq(&oscillator, verdict, "a.v").unwrap()
    };
    assert!(file(["10", "2/5", "249/1000", "251/1000"]).contains("Proof. certify (249 # 1000) (10 # 1)"));
    let long = file(["10", "2/5", "299/1000", "301/1000"]);
    assert!(
        long.contains("Import Vocabulary PiCertificate.") && long.contains("--lambda1 10 --lambda2 2/5 ")
    );
    assert!(
        long.contains("(10 / 1 * powerRZ PI 0)")
            && long.contains("certify_pi (299 # 1000, 0%Z) (10 # 1, 0%Z)")
    );
    // s = 2, q = 1, p even: an edge whatever the slow stiffness.
    assert!(file(["2", "1", "1", "600"]).contains("Proof. certify (1 # 1)"));
}
