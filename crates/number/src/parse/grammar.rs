//! The recursive descent behind [`parse`](super::parse): a text becomes a value at once, no tree between.

use num_bigint::BigInt;
use num_traits::{One, ToPrimitive, Zero};

use super::arithmetic::{Arithmetic, Operation};
use crate::{Laurent, Rational};

/// A sign as keyboards have it: papers print `−` for `-`, and `×` or `·` for `*`.
pub fn typed(c: char) -> char {
    match c {
        '−' => '-',
        '×' | '·' => '*',
        c => c,
    }
}

/// Exponents as papers print them, and what they mean.
const RAISED: [char; 11] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹', '⁻'];
const LOWERED: [char; 11] = ['0', '1', '2', '3', '4', '5', '6', '7', '8', '9', '-'];

const INTEGER_POWER: &str = "a power must be an integer";

fn is_raised(c: char) -> bool {
    RAISED.contains(&c)
}

/// The longest text that is read, in characters.
pub const MAX_CHARACTERS: usize = 20_000;

/// The largest value that is held: bits of all numerators and denominators together.
pub const MAX_BITS: u64 = 200_000;

/// The largest |k| in π^k.
pub const MAX_PI_EXPONENT: u32 = 1000;

/// The deepest nesting of parentheses.
const MAX_DEPTH: u32 = 100;

/// Bounds the time, to a few seconds at worst. The unit is a bit operation of reducing a fraction, which
/// costs the square of its length; [`OVERHEAD`] units are charged for each product of two coefficients.
const MAX_EFFORT: u64 = 100_000_000_000;

/// See [`MAX_EFFORT`].
const OVERHEAD: u64 = 100_000;

/// The remedy for a text that is not a number.
type Remedy = String;
type Parsed<T> = Result<T, Remedy>;

/// The value of a whole text.
pub(super) fn evaluate(text: &str) -> Parsed<Laurent> {
    if let Some(value) = decimal(text) {
        return Ok(Laurent::from_rational(value));
    }
    if text.chars().nth(MAX_CHARACTERS).is_some() {
        return Err(format!("longer than {MAX_CHARACTERS} characters; write the number shorter"));
    }
    let characters: Vec<char> = text.chars().filter(|c| !c.is_whitespace()).map(typed).collect();
    if characters.is_empty() {
        return Err("empty; write a number such as 3/10, 0.3 or pi^2/25".into());
    }
    if splits_a_number(text) {
        return Err("has a space inside a number; write * for a product".into());
    }
    let mut parser = Parser { characters: &characters, at: 0, depth: 0, effort: 0 };
    let value = parser.sum()?;
    if parser.at < characters.len() { Err(parser.unexpected()) } else { Ok(value) }
}

/// A plain decimal of at most 25 digits and a power of ten between 10^-36 and 10^12, as data mostly are: in
/// machine words, in a twentieth of the time that the grammar takes. `None` for everything else, errors among
/// it.
fn decimal(text: &str) -> Option<Rational> {
    let (negative, text) = text.strip_prefix('-').map_or((false, text), |rest| (true, rest));
    let (digits, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, "0"));
    let is_number = |part: &str| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
    if !is_number(fraction)
        || !(is_number(whole) || whole.is_empty() && digits.starts_with('.'))
        || whole.len() + fraction.len() > 25
        || !is_number(exponent.strip_prefix(['-', '+']).unwrap_or(exponent))
    {
        return None;
    }
    let read = |value: u128, part: &str| part.bytes().fold(value, |n, b| 10 * n + u128::from(b - b'0'));
    let mut mantissa = read(read(0, whole), fraction);
    let scale: i32 = exponent.parse::<i32>().ok()?.checked_sub(fraction.len() as i32)?;
    if !(-36..=12).contains(&scale) {
        return None;
    }
    let (mut denominator, places) = (1u128, scale.min(0).unsigned_abs());
    mantissa *= 10u128.pow(scale.max(0).unsigned_abs());
    let twos = mantissa.trailing_zeros().min(places);
    (mantissa, denominator) = (mantissa >> twos, denominator << (places - twos));
    for _ in 0..places {
        if mantissa.is_multiple_of(5) { mantissa /= 5 } else { denominator *= 5 }
    }
    let mantissa = BigInt::from(mantissa);
    Some(Rational::new_raw(if negative { -mantissa } else { mantissa }, denominator.into()))
}

/// Is there white space between two characters of numbers or names, as in `1 000` or `2 pi`?
fn splits_a_number(text: &str) -> bool {
    let inside = |c: char| c.is_alphanumeric() || c == '.';
    let mut words = text.split_whitespace().peekable();
    while let (Some(word), Some(next)) = (words.next(), words.peek()) {
        if word.ends_with(inside) && next.starts_with(inside) {
            return true;
        }
    }
    false
}

struct Parser<'a> {
    characters: &'a [char],
    at: usize,
    depth: u32,
    effort: u64,
}

impl Arithmetic for Parser<'_> {
    type Value = Laurent;
    type Error = Remedy;

    fn at(&self) -> usize {
        self.at
    }

    fn skip(&mut self, wanted: char) -> bool {
        let found = self.peek() == Some(wanted);
        self.at += usize::from(found);
        found
    }

    /// power = atom ("^" exponent | raised)?
    fn power(&mut self) -> Parsed<Laurent> {
        let base = self.atom()?;
        let exponent = match self.peek() {
            Some('^') => {
                self.at += 1;
                self.exponent()?
            }
            Some(c) if is_raised(c) => self.raised()?,
            _ => return Ok(base),
        };
        if self.peek().is_some_and(|c| c == '^' || is_raised(c)) {
            return Err("has two powers in a row; write parentheses".into());
        }
        self.raise(&base, exponent)
    }

    fn combined(&mut self, _: usize, a: &Laurent, operation: Operation, b: &Laurent) -> Parsed<Laurent> {
        if operation == Operation::Over {
            check_divisor(b)?;
        }
        self.spend(pairs(a, b), mean_size(a) + mean_size(b))?;
        checked(match operation {
            Operation::Plus => a + b,
            Operation::Minus => a - b,
            Operation::Times => a * b,
            Operation::Over => a.checked_div(b).expect("checked"),
        })
    }
}

impl Parser<'_> {
    /// exponent = ("-" | "+")? digits | atom, an integer
    fn exponent(&mut self) -> Parsed<i32> {
        let negative = self.skip('-');
        if !negative {
            self.skip('+');
        }
        let value = self.atom()?.as_rational().filter(Rational::is_integer);
        let value = value.ok_or(INTEGER_POWER)?;
        let size = value.to_integer().to_i32().and_then(|n| if negative { n.checked_neg() } else { Some(n) });
        size.ok_or_else(too_large)
    }

    /// raised = "⁻"? ("⁰" | … | "⁹")+, an exponent as papers print it.
    fn raised(&mut self) -> Parsed<i32> {
        let rest = self.characters[self.at..].iter();
        let place = |&c: &char| RAISED.iter().position(|&raised| raised == c);
        let typed: String = rest.map_while(place).map(|place| LOWERED[place]).collect();
        self.at += typed.len();
        let digits = typed.strip_prefix('-').unwrap_or(&typed);
        let is_integer = !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit());
        typed.parse().map_err(|_| if is_integer { too_large() } else { INTEGER_POWER.into() })
    }

    /// atom = number | "pi" | "π" | "(" sum ")"
    fn atom(&mut self) -> Parsed<Laurent> {
        match self.peek() {
            Some('(') => self.parenthesis(),
            Some('π') => {
                self.at += 1;
                Ok(Laurent::pi_power(1))
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() => self.name(),
            _ => Err(self.unexpected()),
        }
    }

    fn parenthesis(&mut self) -> Parsed<Laurent> {
        self.at += 1;
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(format!("nests parentheses deeper than {MAX_DEPTH}; write it flatter"));
        }
        let value = self.sum()?;
        if !self.skip(')') {
            return Err(if self.at < self.characters.len() {
                self.unexpected()
            } else {
                "lacks a closing parenthesis; add it".into()
            });
        }
        self.depth -= 1;
        Ok(value)
    }

    fn name(&mut self) -> Parsed<Laurent> {
        let name: String = self.characters[self.at..].iter().take_while(|c| c.is_alphabetic()).collect();
        if name == "pi" {
            self.at += 2;
            return Ok(Laurent::pi_power(1));
        }
        Err(match name.to_lowercase().as_str() {
            "nan" | "inf" | "infinity" => "is not a number; write a finite one such as 3/10".into(),
            _ => format!(
                "has the name {}, and numbers have none but pi; write digits and pi, as in pi^2/25",
                name.chars().take(20).collect::<String>()
            ),
        })
    }

    /// number = (digits ("." digits)? | "." digits) (("e" | "E") ("-" | "+")? digits)?
    fn number(&mut self) -> Parsed<Laurent> {
        let mut digits = self.digits();
        let mut scale = 0;
        if self.skip('.') {
            let fraction = self.digits();
            if fraction.is_empty() {
                return Err(
                    "has a decimal point without digits after it; write them, or leave the point out".into(),
                );
            }
            scale = -(fraction.len() as i64);
            digits.push_str(&fraction);
        }
        if self.skip('e') || self.skip('E') {
            scale += self.decimal_exponent()?;
        }
        let mantissa: BigInt = digits.parse().map_err(|_| self.unexpected())?;
        if scale.unsigned_abs() * 10 / 3 > MAX_BITS {
            return Err(too_large());
        }
        let power = BigInt::from(10).pow(scale.unsigned_abs() as u32);
        self.spend(1, mantissa.bits() + power.bits())?;
        let value =
            if scale < 0 { Rational::new(mantissa, power) } else { Rational::from_integer(mantissa * power) };
        checked(Laurent::from_rational(value))
    }

    fn digits(&mut self) -> String {
        let digits: String = self.characters[self.at..].iter().take_while(|c| c.is_ascii_digit()).collect();
        self.at += digits.len();
        digits
    }

    fn decimal_exponent(&mut self) -> Parsed<i64> {
        let negative = self.skip('-');
        if !negative {
            self.skip('+');
        }
        let digits = self.digits();
        if digits.is_empty() {
            return Err("has an e without an exponent; write 1e-3, or pi for the circle's number".into());
        }
        let size: i64 = digits.parse().ok().filter(|&n: &i64| n <= MAX_BITS as i64).ok_or_else(too_large)?;
        Ok(if negative { -size } else { size })
    }

    /// base^n, refused before it is computed if it would be too large.
    fn raise(&mut self, base: &Laurent, n: i32) -> Parsed<Laurent> {
        if n < 0 {
            check_divisor(base)?;
        }
        if let Some((k, c)) = base.as_monomial() {
            let exponent = u64::from(k.unsigned_abs()) * u64::from(n.unsigned_abs());
            let unit = c.denom().is_one() && c.numer().magnitude().is_one();
            let bits = if unit { 1 } else { base.size() * u64::from(n.unsigned_abs()) };
            // The power has more than a quarter of these bits (the worst base is 2: 3 n against n + 2).
            if exponent > u64::from(MAX_PI_EXPONENT) || bits > 4 * MAX_BITS {
                return Err(too_large());
            }
            return checked(base.pow(n).expect("a monomial"));
        }
        if base.is_zero() {
            return Ok(if n == 0 { Laurent::one() } else { Laurent::zero() });
        }
        let widest = base.terms().iter().map(|(k, _)| k.unsigned_abs()).max().unwrap_or(0);
        if u64::from(widest) * u64::from(n.unsigned_abs()) > u64::from(MAX_PI_EXPONENT) {
            return Err(too_large());
        }
        let mut power = Laurent::one();
        for bit in (0..32 - n.leading_zeros()).rev() {
            power = self.combined(self.at, &power, Operation::Times, &power)?;
            if n >> bit & 1 == 1 {
                power = self.combined(self.at, &power, Operation::Times, base)?;
            }
        }
        Ok(power)
    }

    /// Charges for `products` of two coefficients with `bits` bits together.
    fn spend(&mut self, products: u64, bits: u64) -> Parsed<()> {
        self.effort = self.effort.saturating_add(products.saturating_mul(bits * bits + OVERHEAD));
        if self.effort > MAX_EFFORT {
            Err("takes too long to evaluate; write the number shorter".into())
        } else {
            Ok(())
        }
    }

    fn peek(&self) -> Option<char> {
        self.characters.get(self.at).copied()
    }

    fn unexpected(&self) -> Remedy {
        const FORM: &str = "write a number such as 3/10, 0.3, 1e-3 or pi^2/25, with * for products";
        let rest: String = self.characters[self.at..].iter().collect();
        match self.peek() {
            Some(_) if UNITS.contains(&rest.trim()) => {
                format!(
                    "has a unit, and numbers here have none: write all times in one unit, and {rest} nowhere"
                )
            }
            Some(c) => format!("unexpected {c:?} (symbol {}); {FORM}", self.at + 1),
            None => format!("ends too early; {FORM}"),
        }
    }
}

/// Units of time, where no number has one.
const UNITS: [&str; 4] = ["fs", "ps", "ns", "s"];

/// The number of products of coefficients in a · b.
fn pairs(a: &Laurent, b: &Laurent) -> u64 {
    (a.terms().len() * b.terms().len()).max(1) as u64
}

/// The bits of a typical coefficient.
fn mean_size(x: &Laurent) -> u64 {
    x.size() / x.terms().len().max(1) as u64
}

fn check_divisor(divisor: &Laurent) -> Parsed<()> {
    if divisor.is_zero() {
        return Err("divides by zero; write a divisor other than 0".into());
    }
    if divisor.as_monomial().is_none() {
        return Err("a divisor that is a sum involving pi is not supported; \
                    divide by a rational multiple of a power of pi, as in 2/pi, or multiply the sum out"
            .into());
    }
    Ok(())
}

fn checked(value: Laurent) -> Parsed<Laurent> {
    let powers_fit = value.terms().iter().all(|(k, _)| k.unsigned_abs() <= MAX_PI_EXPONENT);
    if powers_fit && value.size() <= MAX_BITS { Ok(value) } else { Err(too_large()) }
}

fn too_large() -> Remedy {
    format!("beyond {MAX_BITS} bits or pi^{MAX_PI_EXPONENT}; use a smaller power")
}
