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
