//! A verdict as a Coq proof: nine lines that state it and prove it by computation from the theorems in proofs/.
//!
//! The file's theorem is `kickdrift_verdict`; what it means is theorem `certificate` in proofs/. The template
//! is described in proofs/README.md; `proofs/tools/certificate.sh FILE.v` checks a file against it.
//!
//! ```
//! use kickdrift::number::parse::parse;
//! use kickdrift::propagator::Oscillator;
//! use kickdrift::report::certificate::coq;
//! use kickdrift::verdict::{decide, Limits};
//! let x = |text| parse("x", text).unwrap();
//! let oscillator = Oscillator::new(x("11/4"), x("57/10"), x("1"), x("5/3")).unwrap();
//! let verdict = decide(&oscillator.clocks(), &Limits::default()).unwrap().verdict;
//! let file = coq(&oscillator, verdict, "closing.v").unwrap();
//! assert!(file.contains("verdict (Coexistence Plus) 5 3 (1 / 1) (11 / 4) (5 / 3) (57 / 10)."));
//! ```

use crate::error::{Error, Result};
use crate::number::{Laurent, Rational};
use crate::propagator::Oscillator;
use crate::verdict::{Kind, Verdict};

/// The text of the certificate; `file_name` is the name it will have, without folders.
///
/// # Errors
/// A quantity that is not rational, or a file name that Coq does not take for a module's.
pub fn coq(oscillator: &Oscillator, verdict: Verdict, file_name: &str) -> Result<String> {
    check_name(file_name)?;
    let clocks = oscillator.clocks();
    let (h1, h2) = (rational("h1", oscillator.h1())?, rational("h2", oscillator.h2())?);
    let lambda1 = rational("lambda1", oscillator.lambda1())?;
    let lambda2 = rational("lambda2", oscillator.lambda2())?;
    let numbers = [&h1, &lambda1, &h2, &lambda2];
    let written =
        |separator: char| numbers.map(|x| format!("({} {separator} {})", x.numer(), x.denom())).join(" ");
    Ok(format!(
        "(* kickdrift verdict --lambda1 {lambda1} --lambda2 {lambda2} --h1 {h1} --h2 {h2} --certificate {file_name} *)\n\
         From Coq Require Import Reals QArith.\n\
         From Kickdrift Require Import Vocabulary Certificate.\n\
         \n\
         (** kind, p, q with h2/h1 = p/q, then h1, lambda1, h2, lambda2. *)\n\
         Theorem kickdrift_verdict :\n  verdict {} {} {} {}.\n\
         Proof. certify {}. Qed.\n\
         Print Assumptions kickdrift_verdict.\n",
        kind(verdict),
        clocks.p(),
        clocks.q(),
        written('/'),
        written('#'),
    ))
}

fn kind(verdict: Verdict) -> String {
    let side = if verdict.side() > 0 { "Plus" } else { "Minus" };
    match verdict.kind() {
        Kind::Elliptic => "Elliptic".into(),
        Kind::Hyperbolic => format!("(Hyperbolic {side})"),
        Kind::Parabolic => format!("(Parabolic {side})"),
        Kind::Coexistence => format!("(Coexistence {side})"),
    }
}

fn rational(field: &str, x: &Laurent) -> Result<Rational> {
    let remedy = "a certificate needs rational numbers: replace pi by a fraction near it";
    x.as_rational().ok_or_else(|| Error::input(field, x, remedy))
}

fn check_name(name: &str) -> Result<()> {
    let stem = name.strip_suffix(".v").unwrap_or("");
    if !stem.is_empty() && stem.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return Ok(());
    }
    Err(Error::input("certificate", name, "name the file with letters, digits and _, ending in .v"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::parse::parse;
    use crate::verdict::{Limits, decide};
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
            assert_eq!(
                coq(&oscillator, verdict, value("--certificate")).unwrap(),
                text,
                "{}",
                path.display()
            );
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
}
