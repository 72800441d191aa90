//! Coefficients as they are written: sums, products, quotients, powers and roots.

use num_traits::{Signed, ToPrimitive, Zero};

use number::parse::arithmetic::{Arithmetic, Operation};
use number::parse::parse_rational;
use number::radical::MAX_ROOT;
use number::{Radical, Rational, Ring};

/// The deepest nesting of parentheses.
pub(super) const MAX_DEPTH: u32 = 50;

/// The largest |k| of a power.
const MAX_POWER: u32 = 1000;

/// The most bits that the numerators and denominators of a coefficient may have together.
const MAX_BITS: u64 = 4000;

/// The text of a word and the place in it. An error is the place, counted in characters from 0, and what to
/// do.
pub(super) struct Reader<'a> {
    pub characters: Vec<char>,
    pub at: usize,
    pub depth: u32,
    /// A number of the largest field so far.
    pub known: Radical,
    /// Numbers that have names.
    pub named: &'a [(&'a str, Radical)],
}

pub(super) type Read<T> = Result<T, (usize, String)>;

impl Arithmetic for Reader<'_> {
    type Value = Radical;
    type Error = (usize, String);

    fn at(&self) -> usize {
        self.at
    }

    /// Passes over white space, and over `wanted` if it comes next.
    fn skip(&mut self, wanted: char) -> bool {
        while self.peek().is_some_and(char::is_whitespace) {
            self.at += 1;
        }
        let found = self.peek() == Some(wanted);
        self.at += usize::from(found);
        found
    }

    /// power = atom ("^" (["-"] digits | "(" rational ")"))?
    fn power(&mut self) -> Read<Radical> {
        let base = self.atom()?;
        let at = self.at;
        if !self.skip('^') {
            return Ok(base);
        }
        let negative = self.skip('-');
        let exponent = self.atom()?.as_rational().map(|x| if negative { -x } else { x });
        let small = |x: &Rational| (x.numer().to_i32(), x.denom().to_u32());
        let Some((Some(k), Some(n))) = exponent.as_ref().map(small) else {
            return self.wrong(at, "a power is a rational number such as 3, -1 or 1/3");
        };
        self.root(at, base, n).and_then(|root| self.raised(at, &root, k))
    }

    /// In a common field.
    fn combined(&mut self, at: usize, a: &Radical, operation: Operation, b: &Radical) -> Read<Radical> {
        let Some((a, b)) = Radical::together(a, b) else { return self.wrong(at, TWO_FIELDS) };
        let value = match operation {
            Operation::Plus => Some(&a + &b),
            Operation::Minus => Some(&a - &b),
            Operation::Times => Some(&a * &b),
            Operation::Over => b.inverse().map(|inverse| &a * &inverse),
        };
        match value {
            Some(value) if size(&value) <= MAX_BITS => Ok(value),
            Some(_) => self.wrong(at, "this number is too long"),
            None => self.wrong(at, "divides by zero"),
        }
    }
}

impl Reader<'_> {
    pub fn peek(&self) -> Option<char> {
        self.characters.get(self.at).copied()
    }

    pub fn taken(&mut self, of: impl Fn(char) -> bool) -> String {
        let text: String = self.characters[self.at..].iter().copied().take_while(|&c| of(c)).collect();
        self.at += text.chars().count();
        text
    }

    pub fn wrong<T>(&self, at: usize, why: impl Into<String>) -> Read<T> {
        Err((at, why.into()))
    }

    pub fn expect(&mut self, wanted: char, after: &str) -> Read<()> {
        if self.skip(wanted) {
            return Ok(());
        }
        // As 2b, 2(1-b) or 2sqrt(3) go on.
        let is_product = wanted == ')' && self.peek().is_some_and(|c| c == '(' || c.is_lowercase());
        let why = if is_product { PRODUCT.into() } else { format!("expected {wanted:?} {after}") };
        self.wrong(self.at, why)
    }

    pub fn nested<T>(&mut self, inside: impl FnOnce(&mut Self) -> Read<T>) -> Read<T> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return self.wrong(self.at, format!("parentheses are nested deeper than {MAX_DEPTH}"));
        }
        let value = inside(self)?;
        self.depth -= 1;
        Ok(value)
    }

    /// A sum in the field of the coefficients before it.
    pub fn coefficient(&mut self) -> Read<Radical> {
        self.skip(' ');
        let at = self.at;
        let value = self.sum()?;
        let Some((own, known)) = Radical::together(&value, &self.known) else {
            return self.wrong(at, TWO_FIELDS);
        };
        self.known = if known.field().is_some() { known } else { own };
        Ok(value)
    }

    fn root(&self, at: usize, base: Radical, n: u32) -> Read<Radical> {
        if n == 1 {
            return Ok(base);
        }
        match base.as_rational() {
            Some(x) if x.is_negative() => self.wrong(at, "the root of a negative number is not real"),
            Some(_) if n > MAX_ROOT => self.wrong(at, format!("choose a root of degree {MAX_ROOT} at most")),
            Some(x) if x.numer().bits() * u64::from(n) + x.denom().bits() * u64::from(n) > MAX_BITS => {
                self.wrong(at, "the root of a number that is too long")
            }
            Some(x) => Ok(Radical::root(&x, n).expect("a root of small degree of x >= 0")),
            None => {
                self.wrong(at, "a root of a root is not supported; write it as one root, or as a decimal")
            }
        }
    }

    fn raised(&mut self, at: usize, base: &Radical, k: i32) -> Read<Radical> {
        if k.unsigned_abs() > MAX_POWER || size(base) * u64::from(k.unsigned_abs()) > MAX_BITS {
            return self.wrong(at, "this power is too large");
        }
        let mut power = Radical::from_rational(&Rational::from_integer(1.into()));
        for _ in 0..k.unsigned_abs() {
            power = self.combined(at, &power, Operation::Times, base)?;
        }
        if k >= 0 { Ok(power) } else { power.inverse().map_or_else(|| self.wrong(at, "divides by zero"), Ok) }
    }

    /// atom = decimal | name | "sqrt" "(" sum ")" | "(" sum ")"
    fn atom(&mut self) -> Read<Radical> {
        if self.skip('(') {
            let value = self.nested(Self::sum)?;
            return self.expect(')', "after a sum").map(|()| value);
        }
        let at = self.at;
        match self.peek() {
            Some(c) if c.is_ascii_digit() || c == '.' => self.decimal(),
            Some(c) if c.is_alphabetic() => {
                let name = self.taken(char::is_alphabetic);
                if let Some((_, value)) = self.named.iter().find(|(known, _)| *known == name) {
                    return Ok(value.clone());
                }
                if name != "sqrt" {
                    return self.wrong(at, self.unnamed(&name));
                }
                self.expect('(', "after sqrt")?;
                let value = self.nested(Self::sum)?;
                self.expect(')', "after a sum")?;
                self.root(at, value, 2)
            }
            Some(c) => {
                self.wrong(at, format!("unexpected {c:?}; write a number such as 1/6, 0.193 or sqrt(3)/6"))
            }
            None => self.wrong(at, "the text ends where a number should stand"),
        }
    }

    /// What to write in place of a name that no number has.
    fn unnamed(&self, name: &str) -> String {
        if name.starts_with(|c: char| c.is_uppercase()) {
            return format!("{name} begins where a number should stand: close the parenthesis before it");
        }
        let known: Vec<&str> = self.named.iter().map(|(known, _)| *known).collect();
        let or = match (name, self.peek(), &known[..]) {
            // Functions and constants want no values.
            ("pi" | "π", ..) | (_, Some('('), _) => String::new(),
            (.., []) => {
                format!(", or give {name} a value by --parameter, as {name}=1/6 or {name}=1/6..1/4:1/100")
            }
            (.., known) => format!("; the parameters given are {}", known.join(", ")),
        };
        format!("{name} is no number: write a decimal, sqrt(c) or c^(1/n){or}")
    }

    fn decimal(&mut self) -> Read<Radical> {
        let at = self.at;
        let mut text = self.taken(|c| c.is_ascii_digit() || c == '.');
        let exponent: String = self.characters[self.at..].iter().take(3).collect();
        let after = exponent.strip_prefix(['e', 'E']).map(|rest| rest.trim_start_matches(['-', '+']));
        if after.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit())) {
            text.push('e');
            self.at += 1;
            text += &self.taken(|c| c == '-' || c == '+');
            text += &self.taken(|c| c.is_ascii_digit());
        }
        match parse_rational("word", &text) {
            Ok(value) if value.numer().bits() + value.denom().bits() <= MAX_BITS => {
                Ok(Radical::from_rational(&value))
            }
            Ok(_) => self.wrong(at, "this number is too long"),
            Err(error) => self.wrong(at, error.remedy()),
        }
    }
}

pub(super) const TWO_FIELDS: &str =
    "one word has the powers of one root, such as 2^(1/3); write another root as a decimal";

const PRODUCT: &str = "write * for a product, as 2*b";

/// The bits of a number's coefficients.
fn size(x: &Radical) -> u64 {
    let of = |c: &Rational| if c.is_zero() { 0 } else { c.numer().bits() + c.denom().bits() };
    x.polynomial().coefficients().iter().map(of).sum()
}
