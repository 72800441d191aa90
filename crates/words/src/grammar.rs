//! The grammar of words: a text becomes letters, or one line that says where it is wrong.

use std::str::FromStr;

use super::catalogue::METHODS;
use super::coefficient::{Read, Reader, TWO_FIELDS};
use super::damping::Damping;
use super::filter::Filter;
use super::letters::{Force, Item, Letter, Word};
use num_traits::Zero;
use number::error::{MOST_LIKE, likes};
use number::parse::arithmetic::Arithmetic;
use number::parse::typed;
use number::{Error, Radical, Result};

/// The longest text that is read, in characters.
const MAX_CHARACTERS: usize = 20_000;

/// The most powers of the force in one kick.
const MAX_POWERS: usize = 8;

impl FromStr for Word {
    type Err = Error;

    /// Reads a word; see the module's head for the grammar.
    ///
    /// # Errors
    /// A text that is no word: the place, and what stands there.
    fn from_str(text: &str) -> Result<Word> {
        Word::with(text, &[])
    }
}

impl Word {
    /// Reads a word in which names stand for numbers.
    ///
    /// ```
    /// use kickdrift_words::{Word, number::{Radical, Ring, rational::ratio}};
    /// let quarter = Radical::from_rational(&ratio(1, 4));
    /// let word = Word::with("K(b) D(1/2) K(1-2*b) D(1/2) K(b)", &[("b", quarter)])?;
    /// assert_eq!(word.to_string(), "K(1/4) D(1/2) K(1/2) D(1/2) K(1/4)");
    /// # Ok::<(), kickdrift_words::number::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// A text that is no word: the place, and what stands there.
    pub fn with(text: &str, named: &[(&str, Radical)]) -> Result<Word> {
        if text.chars().nth(MAX_CHARACTERS).is_some() {
            return Err(Error::input(
                "word",
                text,
                format!("write it in {MAX_CHARACTERS} characters at most"),
            ));
        }
        let characters = text.chars().map(typed).collect();
        let mut reader = Reader { characters, at: 0, depth: 0, known: Radical::zero(), named };
        let items = reader.items().and_then(|items| match reader.peek() {
            None if items.is_empty() => reader.wrong(0, "a word has letters, as K(1/2) D(1) K(1/2)"),
            None => Ok(items),
            Some(c) => reader.wrong(reader.at, unexpected(c, &items)),
        });
        if items.is_err()
            && let Some(remedy) = of_catalogue(text)
        {
            return Err(Error::input("word", text, remedy));
        }
        let items =
            items.map_err(|(at, why)| Error::input("word", text, format!("character {}: {why}", at + 1)))?;
        Word::new(items).ok_or_else(|| Error::input("word", text, TWO_FIELDS))
    }
}

const LETTERS: &str =
    "K(c) is a kick, D(c) a drift; other letters are K1, K2, C, C1, C2, R, R1, R2, O, F, I and n*(...)";

/// What to write where no letter begins.
fn unexpected(c: char, before: &[Item]) -> String {
    match c {
        '*' | ',' | ';' | '+' | '@' | '∘' if !before.is_empty() => {
            format!("letters follow each other without {c:?}, as K(1/2) D(1) K(1/2)")
        }
        '(' => "letters in parentheses are repeated, as 2*(K(1/4) D(1/2) K(1/4))".into(),
        c => format!("unexpected {c:?}; {LETTERS}"),
    }
}

/// How to ask for a method of the catalogue, where a text is its name or nearly so.
fn of_catalogue(text: &str) -> Option<String> {
    let names: Vec<&str> = METHODS.iter().map(|method| method.name).collect();
    let like = if text.contains('(') { Vec::new() } else { likes(text.trim(), &names) };
    let flags: Vec<String> = like.iter().take(MOST_LIKE).map(|name| format!("--method {name}")).collect();
    (!flags.is_empty()).then(|| format!("is no word; did you mean {}?", flags.join(" or ")))
}

const FILTERS: &str =
    "a filter is made of sinc(x), sinc(x/2), cos(x/2), their powers, 1 and 0, as [sinc(x/2)^2]";

/// The largest power of a filter's factor, and of all together.
const MAX_FILTER: i32 = 16;

impl Reader<'_> {
    /// items = (letter | digits "*" "(" items ")")*
    fn items(&mut self) -> Read<Vec<Item>> {
        let mut items = Vec::new();
        loop {
            // White space and products between letters mean the same.
            self.skip('\0');
            match self.peek() {
                Some(c) if c.is_ascii_digit() => items.push(self.repeated()?),
                Some('K' | 'D' | 'C' | 'R' | 'O' | 'F' | 'I') => items.push(Item::Letter(self.letter()?)),
                _ => return Ok(items),
            }
        }
    }

    fn repeated(&mut self) -> Read<Item> {
        let at = self.at;
        let digits = self.taken(|c| c.is_ascii_digit());
        let Some(times) = digits.parse().ok().filter(|&times: &u64| times > 0 && digits.len() < 10) else {
            return self.wrong(at, "repeat 1 to 999999999 times");
        };
        self.expect('*', "after the number of repetitions")?;
        self.expect('(', "after *")?;
        let inside = self.nested(Self::items)?;
        if inside.is_empty() {
            return self.wrong(self.at, format!("expected a letter; {LETTERS}"));
        }
        self.expect(')', "after the letters that are repeated")?;
        Ok(Item::Repeat(times, inside))
    }

    fn letter(&mut self) -> Read<Letter> {
        let at = self.at;
        let name = self.taken(char::is_alphanumeric);
        let force = match name.get(1..) {
            Some("") => Force::All,
            Some("1") => Force::First,
            Some("2") => Force::Second,
            _ => return self.wrong(at, format!("{name} is no letter; {LETTERS}")),
        };
        let filtered = self.at;
        let filter = if self.skip('[') { Some(self.filter()?) } else { None };
        if filter.is_some() && name != "K2" {
            return self.wrong(filtered, "filters stand on K2: x is h sqrt(lambda1), the fast force's angle");
        }
        let filter = filter.unwrap_or_default();
        self.expect('(', &format!("after {name}, as in {name}(1/2)"))?;
        let mut powers = vec![self.coefficient()?];
        while self.skip(',') {
            powers.push(self.coefficient()?);
        }
        self.expect(')', &format!("after the coefficient of {name}"))?;
        match (name.as_bytes()[0], powers.len()) {
            (b'K', 1..=MAX_POWERS) => Ok(Letter::Kick { force, filter, powers }),
            (b'K', _) => self.wrong(at, format!("a kick has {MAX_POWERS} powers of the force at most")),
            (_, 2..) => self.wrong(at, format!("{name} has one coefficient")),
            (b'D', _) if force == Force::All => Ok(Letter::Drift(powers.remove(0))),
            (b'C', _) => Ok(Letter::Midpoint { force, time: powers.remove(0) }),
            (b'R', _) => Ok(Letter::Flow { force, time: powers.remove(0) }),
            (letter, _) => match Damping::of(letter.into()).filter(|_| force == Force::All) {
                Some(damping) => Ok(Letter::Friction { damping, time: powers.remove(0) }),
                None => self.wrong(at, format!("{name} is no letter; {LETTERS}")),
            },
        }
    }

    /// filter = factor (("*" | "/") factor)* "]"
    fn filter(&mut self) -> Read<Filter> {
        let mut all = self.factor()?;
        loop {
            let at = self.at;
            let sign = if self.skip('*') { 1 } else { -i32::from(self.skip('/')) };
            if sign == 0 {
                return self.expect(']', "after a filter").map(|()| all);
            }
            let filter = self.factor()?;
            if filter.zero && sign < 0 {
                return self.wrong(at, "divides by zero");
            }
            all = Filter {
                cos: all.cos + sign * filter.cos,
                sinc: all.sinc + sign * filter.sinc,
                zero: all.zero || filter.zero,
            };
            if all.cos.abs().max(all.sinc.abs()) > MAX_FILTER {
                return self.wrong(at, format!("choose powers up to {MAX_FILTER}"));
            }
            if all.zero {
                all = Filter { zero: true, ..Filter::default() };
            }
        }
    }

    /// factor = "0" | "1" | ("sinc(x)" | "sinc(x/2)" | "cos(x/2)") ("^" digits)?
    fn factor(&mut self) -> Read<Filter> {
        self.skip('\0');
        let at = self.at;
        let mut name = self.taken(char::is_alphanumeric);
        if self.skip('(') {
            name += &format!("({})", self.taken(|c| c != ')' && c != ']'));
            self.expect(')', "after the argument of a filter")?;
        }
        let mut power = 1;
        if self.skip('^') {
            let digits = self.taken(|c| c.is_ascii_digit());
            let Some(number) = digits.parse().ok().filter(|digits| (0..=MAX_FILTER).contains(digits)) else {
                return self.wrong(at, format!("the power of a filter is 0 to {MAX_FILTER}"));
            };
            power = number;
        }
        let (cos, sinc) = match name.as_str() {
            "0" if power > 0 => return Ok(Filter { zero: true, ..Filter::default() }),
            "0" | "1" => (0, 0),
            "sinc(x)" => (power, power),
            "sinc(x/2)" => (0, power),
            "cos(x/2)" => (power, 0),
            _ => return self.wrong(at, FILTERS),
        };
        Ok(Filter { cos, sinc, zero: false })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_are_read_as_papers_print_them() {
        let printed: Word = "K(1/6) D(1/2) K(2·1/3, −1/36) D(1/2) K(1×1/6)".parse().unwrap();
        let typed: Word = "K(1/6) D(1/2) K(2*1/3, -1/36) D(1/2) K(1*1/6)".parse().unwrap();
        assert_eq!(printed, typed);
    }

    #[test]
    fn a_text_that_is_nearly_a_word_is_answered_with_what_it_lacks() {
        let b = Radical::zero();
        for (text, why) in [
            ("K(2b) D(1)", "write * for a product"),
            ("K(2(b-1)) D(1)", "write * for a product"),
            ("K(1/2)*D(1)", "follow each other without '*'"),
            ("(K(1/2) D(1))^2", "2*(K(1/4)"),
            ("B(1/2) A(1)", "K(c) is a kick, D(c) a drift"),
            ("K(c) D(1)", "the parameters given are b"),
            ("K(sin(1)) D(1)", "is no number: write a decimal, sqrt(c) or c^(1/n)"),
            ("K(1/2, D(1)", "close the parenthesis before it"),
            ("BAOAB", "did you mean --method baoab?"),
            ("velocity-verlet", "did you mean --method velocity-verlet?"),
            ("molly", "--method molly-short or --method molly-linear"),
        ] {
            let error = Word::with(text, &[("b", b.clone())]).unwrap_err().to_string();
            assert!(error.contains(why), "{error}");
        }
        let alone = "K(b) D(1)".parse::<Word>().unwrap_err().to_string();
        assert!(alone.contains("as b=1/6 or b=1/6..1/4:1/100"), "{alone}");
    }
}
