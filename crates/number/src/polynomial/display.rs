//! Polynomials as text: `s^2 - 3*s + 1`, nested ones as `(1/2 + rho)*s - 4`.

use super::Polynomial;
use crate::{Rational, Ring};

/// Something that can be written in given variables, the outermost one first.
pub trait Text {
    /// The text in these variables.
    ///
    /// **Panics** if there are fewer names than levels of nesting.
    fn text(&self, variables: &[&str]) -> String;
}

impl Text for Rational {
    fn text(&self, _: &[&str]) -> String {
        self.to_string()
    }
}

impl<R: Ring + Text> Text for Polynomial<R> {
    fn text(&self, variables: &[&str]) -> String {
        Polynomial::text(self, variables)
    }
}

impl<R: Ring + Text> Polynomial<R> {
    /// The text in these variables (this polynomial's own first), by falling powers.
    ///
    /// **Panics** if there are fewer names than levels of nesting.
    pub fn text(&self, variables: &[&str]) -> String {
        let (name, inner) = variables.split_first().expect("a name for each variable");
        let mut text = String::new();
        for (k, c) in self.coefficients.iter().enumerate().rev().filter(|(_, c)| !c.is_zero()) {
            let term = term(&c.text(inner), name, k);
            match (text.is_empty(), term.strip_prefix('-')) {
                (true, _) => text.push_str(&term),
                (false, Some(positive)) => text.push_str(&format!(" - {positive}")),
                (false, None) => text.push_str(&format!(" + {term}")),
            }
        }
        if text.is_empty() { "0".into() } else { text }
    }
}

/// c x^k, where c is given as text.
fn term(c: &str, name: &str, k: usize) -> String {
    let power = if k == 1 { name.to_string() } else { format!("{name}^{k}") };
    let simple = !c.contains(' ');
    match c {
        _ if k == 0 => c.to_string(),
        "1" => power,
        "-1" => format!("-{power}"),
        _ if simple => format!("{c}*{power}"),
        _ => format!("({c})*{power}"),
    }
}
