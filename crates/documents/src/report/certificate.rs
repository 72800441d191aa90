//! A verdict as a Coq proof: nine lines that state it and prove it by computation from the theorems in
//! proofs/; of two clocks, or of a word at one step; and a tongue's edges.
//!
//! The file's theorem is `kickdrift_verdict`; what it means is theorem `certificate` in proofs/. The template
//! is described in proofs/README.md; `proofs/tools/certificate.sh FILE.v` checks a file against it.
//!
//! ```
//! use kickdrift_documents::number::parse::parse;
//! use kickdrift_documents::clocks::propagator::Oscillator;
//! use kickdrift_documents::report::certificate::coq;
//! use kickdrift_documents::clocks::verdict::{decide, Limits};
//! let x = |text| parse("x", text).unwrap();
//! let oscillator = Oscillator::new(x("11/4"), x("57/10"), x("1"), x("5/3")).unwrap();
//! let verdict = decide(&oscillator.clocks().unwrap(), &Limits::default()).unwrap().verdict;
//! let file = coq(&oscillator, verdict, "closing.v").unwrap();
//! assert!(file.contains("verdict (Coexistence Plus) 5 3 (1 / 1) (11 / 4) (5 / 3) (57 / 10)."));
//! ```

use num_traits::Zero;

use clocks::propagator::Oscillator;
use clocks::tongue::Gap;
use clocks::verdict::{Kind, Verdict};
use number::{Error, Laurent, Radical, Ratio, Rational, Result, rational};
use words::{At, Force, Letter, Word};

/// Coq multiplies exact matrices of so many kicks in some seconds.
const LONGEST_EXACT: u64 = 500;

/// The text of the certificate; `file_name` is the name it will have, without folders.
///
/// Input with π is proven by intervals, for verdicts that hold around it, elliptic or hyperbolic; so are
/// these of rational input where exact numbers, which gain digits with every kick, would be long.
///
/// # Errors
/// A quantity that is no rational times a power of π, an edge where π is, or a file name that Coq does not
/// take for a module's.
pub fn coq(oscillator: &Oscillator, verdict: Verdict, file_name: &str) -> Result<String> {
    check_name(file_name)?;
    let clocks = oscillator.clocks()?;
    let given = [
        ("h1", oscillator.h1()),
        ("lambda1", oscillator.lambda1()),
        ("h2", oscillator.h2()),
        ("lambda2", oscillator.lambda2()),
    ];
    let mut numbers = Vec::with_capacity(4);
    for (field, x) in given {
        numbers.push(monomial(field, x)?);
    }
    let irrational = numbers.iter().any(|(_, power)| *power != 0);
    let edge = matches!(verdict.kind(), Kind::Parabolic | Kind::Coexistence);
    if irrational && edge {
        let remedy =
            "an edge needs rational numbers: measure time in a unit without pi (h / pi, lambda * pi^2)";
        return Err(Error::input("certificate", file_name, remedy));
    }
    let by_intervals = irrational || (clocks.ratio().kicks() > LONGEST_EXACT && !edge);
    let said =
        numbers.iter().map(|(c, power)| if *power == 0 { c.to_string() } else { format!("{c}*pi^{power}") });
    let said: Vec<String> = said.collect();
    let (words, tactic) =
        if by_intervals { ("PiCertificate", "certify_pi") } else { ("Certificate", "certify") };
    Ok(format!(
        "(* kickdrift verdict --lambda1 {} --lambda2 {} --h1 {} --h2 {} --certificate {file_name} *)\n\
         From Coq Require Import Reals QArith.\n\
         From Kickdrift Require Import Vocabulary {words}.\n\
         \n\
         (** kind, p, q with h2/h1 = p/q, then h1, lambda1, h2, lambda2. *)\n\
         Theorem kickdrift_verdict :\n  verdict {} {} {} {}.\n\
         Proof. {tactic} {}. Qed.\n\
         Print Assumptions kickdrift_verdict.\n",
        said[1],
        said[3],
        said[0],
        said[2],
        kind(verdict.kind().name(), verdict.side()),
        clocks.p(),
        clocks.q(),
        written(&numbers, by_intervals, '/'),
        written(&numbers, by_intervals, '#'),
    ))
}

/// The numbers as reals of Coq (sign /) or as what its computation takes (sign #).
fn written(numbers: &[(Rational, i32)], by_intervals: bool, sign: char) -> String {
    let one = |(c, power): &(Rational, i32)| {
        let fraction = format!("{} {sign} {}", c.numer(), c.denom());
        let power = if *power < 0 { format!("({power})") } else { power.to_string() };
        match (by_intervals, sign) {
            (false, _) => format!("({fraction})"),
            (true, '/') => format!("({fraction} * powerRZ PI {power})"),
            (true, _) => format!("({fraction}, {power}%Z)"),
        }
    };
    numbers.iter().map(one).collect::<Vec<_>>().join(" ")
}

/// A tongue's edges as Coq proofs: each lies between two doubles, of which the entry that vanishes there has
/// opposite signs.
///
/// # Errors
/// A file name that Coq does not take for a module's.
pub fn coq_of_tongue(ratio: Ratio, rho: &Rational, gap: &Gap, file_name: &str) -> Result<String> {
    check_name(file_name)?;
    let mut text = format!(
        "(* kickdrift tongues --ratio {ratio} --rho {rho} --m {} --certificate {file_name} *)\n\
         From Coq Require Import Reals QArith.\n\
         From Kickdrift Require Import Vocabulary EdgeCertificate.\n\
         \n\
         (** entry, p, q, rho, and the ends of an interval of s = h1^2 lambda1 that holds a zero of the entry. *)\n",
        gap.m
    );
    let edges = [("lower", Some(&gap.lower)), ("upper", gap.upper.as_ref())];
    for (name, edge) in edges.into_iter().filter_map(|(name, edge)| Some((name, edge?))) {
        // One double further out: the edge itself may be a double.
        let [lo, hi] = [edge.lo.next_down(), edge.hi.next_up()]
            .map(|end| rational::from_f64_exact(end).expect("an edge is finite"));
        let numbers = [(rho.clone(), 0), (lo, 0), (hi, 0)];
        text += &format!(
            "Theorem kickdrift_{name} :\n  edge {:?} {} {} {}.\n\
             Proof. certify_edge {}. Qed.\n\
             Print Assumptions kickdrift_{name}.\n",
            edge.entry,
            ratio.p(),
            ratio.q(),
            written(&numbers, false, '/'),
            written(&numbers, false, '#'),
        );
    }
    Ok(text)
}

/// The verdict of a word at one step as a Coq proof (theorem `word_certificate` in proofs/): its letters,
/// repeated ones written out, multiplied in exact fractions.
///
/// `found` is [`at`](words::at) at h² Λ1; `lambda2` is 0 for a word that names no second force.
///
/// # Errors
/// A word with irrational coefficients, exact flows, filters or friction; a quantity that is no fraction; a
/// file name that Coq does not take for a module's.
pub fn coq_of_word(
    word: &Word,
    found: &At,
    [h, lambda1, lambda2]: [&Laurent; 3],
    file_name: &str,
) -> Result<String> {
    check_name(file_name)?;
    let mut numbers = Vec::with_capacity(3);
    for (field, x) in [("h", h), ("lambda1", lambda1), ("lambda2", lambda2)] {
        let remedy =
            "a word's certificate needs fractions: measure time in a unit without pi (h / pi, lambda * pi^2)";
        numbers.push((x.as_rational().ok_or_else(|| Error::input(field, x, remedy))?, 0));
    }
    let mut letters = Vec::new();
    for letter in word.letters() {
        let own = Own::of(letter).ok_or_else(|| {
            let remedy = "a certificate is of kicks, drifts and midpoints with rational coefficients: write roots as decimals";
            Error::input("word", letter, remedy)
        })?;
        letters.push(own);
    }
    let text: Vec<String> = letters.iter().map(Own::text).collect();
    let terms: Vec<String> = letters.iter().map(Own::term).collect();
    let second = if lambda2.is_zero() { String::new() } else { format!(" --lambda2 {}", numbers[2].0) };
    Ok(format!(
        "(* kickdrift word \"{}\" --lambda1 {}{second} --h {} --certificate {file_name} *)\n\
         From Coq Require Import Reals QArith.\n\
         From Kickdrift Require Import Vocabulary WordCertificate.\n\
         \n\
         (** kind, the letters, then h, lambda1, lambda2. *)\n\
         Theorem kickdrift_word :\n  word_verdict {} [{}] {}.\n\
         Proof. certify_word {}. Qed.\n\
         Print Assumptions kickdrift_word.\n",
        text.join(" "),
        numbers[1].0,
        numbers[0].0,
        kind(found.kind, found.side),
        terms.join("; "),
        written(&numbers, false, '/'),
        written(&numbers, false, '#'),
    ))
}

/// A letter with rational coefficients.
struct Own {
    /// K, D or C, as in a word and in Coq.
    name: char,
    force: Option<Force>,
    numbers: Vec<Rational>,
}

impl Own {
    fn of(letter: &Letter) -> Option<Own> {
        let (name, force, numbers) = match letter {
            Letter::Drift(time) => ('D', None, std::slice::from_ref(time)),
            Letter::Midpoint { force, time } => ('C', Some(*force), std::slice::from_ref(time)),
            Letter::Kick { force, filter, powers } if filter.is_one() => {
                ('K', Some(*force), powers.as_slice())
            }
            _ => return None,
        };
        let numbers = numbers.iter().map(Radical::as_rational).collect::<Option<_>>()?;
        Some(Own { name, force, numbers })
    }

    /// As a word has it, all numbers as fractions.
    fn text(&self) -> String {
        let force = match self.force {
            None | Some(Force::All) => "",
            Some(Force::First) => "1",
            Some(Force::Second) => "2",
        };
        let numbers: Vec<String> = self.numbers.iter().map(Rational::to_string).collect();
        format!("{}{force}({})", self.name, numbers.join(", "))
    }

    /// As proofs/WordCertificate.v has it.
    fn term(&self) -> String {
        let force = self.force.map_or(String::new(), |force| format!(" {force:?}"));
        let fraction = |c: &Rational| format!("{} # {}", c.numer(), c.denom());
        let numbers: Vec<String> = self.numbers.iter().map(fraction).collect();
        let [open, close] = if self.name == 'K' { ["[", "]"] } else { ["(", ")"] };
        format!("{}{force} {open}{}{close}", self.name, numbers.join("; "))
    }
}

/// A verdict as proofs/Vocabulary.v has it.
fn kind(name: &str, side: i8) -> String {
    let side = if side > 0 { "Plus" } else { "Minus" };
    let title = name[..1].to_uppercase() + &name[1..];
    if name == Kind::Elliptic.name() { title } else { format!("({title} {side})") }
}

/// c and k of c π^k.
fn monomial(field: &str, x: &Laurent) -> Result<(Rational, i32)> {
    match x.terms() {
        [(power, c)] => Ok((c.clone(), *power)),
        [] => Ok((Rational::default(), 0)),
        _ => Err(Error::input(field, x, "a certificate needs a fraction times a power of pi")),
    }
}

fn check_name(name: &str) -> Result<()> {
    let stem = name.strip_suffix(".v").unwrap_or("");
    if !stem.is_empty() && stem.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return Ok(());
    }
    Err(Error::input("certificate", name, "name the file with letters, digits and _, ending in .v"))
}
