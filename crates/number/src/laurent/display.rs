//! Text that the parser reads back: `7/2`, `pi^2/25`, `3/(2*pi)`, `1 - pi/3`.

use std::fmt;

use num_traits::{One, Signed, Zero};

use super::Laurent;
use crate::Rational;

impl fmt::Display for Laurent {
    /// The terms by increasing power of π, without needless coefficients and exponents.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_zero() {
            return f.write_str("0");
        }
        for (index, (k, c)) in self.terms.iter().enumerate() {
            f.write_str(match (index, c.is_negative()) {
                (0, true) => "-",
                (0, false) => "",
                (_, true) => " - ",
                (_, false) => " + ",
            })?;
            write_term(f, &c.abs(), *k)?;
        }
        Ok(())
    }
}

/// c π^k for c > 0.
fn write_term(f: &mut fmt::Formatter<'_>, c: &Rational, k: i32) -> fmt::Result {
    let (n, d) = (c.numer(), c.denom());
    let power = match k.unsigned_abs() {
        1 => "pi".to_string(),
        size => format!("pi^{size}"),
    };
    match (k, n.is_one(), d.is_one()) {
        (0, _, _) => write!(f, "{c}"),
        (1.., true, true) => write!(f, "{power}"),
        (1.., false, true) => write!(f, "{n}*{power}"),
        (1.., true, false) => write!(f, "{power}/{d}"),
        (1.., false, false) => write!(f, "{n}*{power}/{d}"),
        (_, _, true) => write!(f, "{n}/{power}"),
        (_, _, false) => write!(f, "{n}/({d}*{power})"),
    }
}
