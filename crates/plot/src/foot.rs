//! The small words below a figure: what it was made from.

use std::fmt::{self, Display};

use super::label::{literal, typeset};

/// Parameters in the notation of labels, in the order in which they were given.
///
/// ```
/// use kickdrift_plot::Foot;
/// let foot = Foot::default().value("*ρ*", "1/25").range("*h*_1", "0", "2/pi").words("16_waters");
/// assert_eq!(foot.to_string(), "*ρ* = 1/25; *h*_1 from 0 to 2/π; 16\\_waters");
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[must_use]
pub struct Foot(Vec<String>);

impl Foot {
    /// name = value
    pub fn value(self, name: &str, value: impl Display) -> Self {
        self.part(format!("{name} = {}", typeset(value)))
    }

    /// name from lo to hi
    pub fn range(self, name: &str, lo: impl Display, hi: impl Display) -> Self {
        self.part(format!("{name} from {} to {}", typeset(lo), typeset(hi)))
    }

    /// name from lo to hi by step
    pub fn grid(self, name: &str, [lo, hi, step]: [&dyn Display; 3]) -> Self {
        self.part(format!("{name} from {} to {} by {}", typeset(lo), typeset(hi), typeset(step)))
    }

    /// In the notation of labels.
    pub fn part(mut self, part: String) -> Self {
        if !part.is_empty() {
            self.0.push(part);
        }
        self
    }

    /// Words that others wrote: their stars and bars are letters.
    pub fn words(self, words: &str) -> Self {
        self.part(literal(words))
    }
}

impl Display for Foot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.join("; "))
    }
}
