//! Words held against the claims of their authors: what `word --check FILE.toml` does in a CI.

mod claim;

pub use claim::{Checked, Claims};

use serde_json::{Map, Value};

use super::asking::{Fields, Question, Work, question};
use super::field::Field;
use super::word::{Linted, Word};
use crate::input::{Entry, tables};
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{COUNT, FLAG, Keys, Schema, Shape, TEXT};
use crate::report::table::{Cell, Column};
use number::{Error, Result};

/// A word, and what its author claims.
#[derive(Clone, Debug, PartialEq)]
pub struct Claimed {
    pub word: Word,
    pub claims: Claims,
    /// Where its keys stand in a file.
    entry: Option<Entry>,
}

question! {
    /// Words with what their authors claim, each claim held against the answer.
    struct WordCheck {
        /// The words, each with its claims.
        words: Vec<Claimed>,
    }
}

/// What was found about one word.
pub struct Held {
    /// The name that the author gave, else the method's, else the word.
    pub name: String,
    pub linted: Linted,
    pub checks: Vec<Checked>,
    entry: Option<Entry>,
}

impl Claimed {
    /// Reads the fields of `word` and the claims from one table.
    fn read(fields: &Map<String, Value>) -> Result<Claimed> {
        let known = || Word::FIELDS.iter().chain(Claims::FIELDS).copied();
        if let Some((name, value)) = fields.iter().find(|(name, _)| !known().any(|known| known == *name)) {
            let remedy = Error::unknown("key", name, known()).remedy().to_string();
            return Err(Error::input(name, value.as_str().unwrap_or_default(), remedy));
        }
        let only = |names: &[&str]| {
            let fields = fields.iter().filter(|(name, _)| names.contains(&name.as_str()));
            fields.map(|(name, value)| (name.clone(), value.clone())).collect::<Map<_, _>>()
        };
        let (word, claims) = (Word::read(&only(Word::FIELDS))?, Claims::read(&only(Claims::FIELDS))?);
        if word.word.is_none() && word.method.is_none() {
            return Err(Error::missing("word", "add word = \"K(1/2) D(1) K(1/2)\", or method = \"pefrl\""));
        }
        word.word()?;
        if claims.is_empty() {
            let remedy = "nothing is claimed: write a line such as order = 4, symmetric = true or limit = 2";
            return Err(Error::missing("claims", remedy));
        }
        Ok(Claimed { word, claims, entry: None })
    }

    fn shown(&self) -> Value {
        let fields = self.claims.input().into_iter().chain(self.word.input());
        fields.map(|(name, value)| (name.to_string(), value)).collect::<Map<_, _>>().into()
    }

    fn name(&self) -> String {
        let Claimed { word: Word { word, method, .. }, claims, .. } = self;
        claims
            .name
            .clone()
            .or_else(|| method.clone())
            .unwrap_or_else(|| word.as_ref().map(ToString::to_string).unwrap_or_default())
    }

    fn hold(&self, work: &Work) -> Result<Held> {
        let linted = self.word.answer(work)?;
        let checks = self.claims.hold(&linted)?;
        Ok(Held { name: self.name(), linted, checks, entry: self.entry.clone() })
    }

    /// The same error, with its place in a file, or the name of the word.
    fn locate(&self, error: Error) -> Error {
        match &self.entry {
            Some(entry) => entry.locate(error),
            None => {
                let field = format!("{}: {}", self.name(), error.field());
                error.at(field)
            }
        }
    }
}

impl Field for Vec<Claimed> {
    const SHAPE: Shape =
        Shape::With(&Shape::List(&Shape::Object(|| Claims::keys().and(Word::keys()))), r#"{"minItems": 1}"#);

    fn of(given: Option<&Value>, name: &str) -> Option<Result<Self>> {
        let one = |value: &Value| {
            let refused = || Error::input(name, value, "give objects with a word and its claims");
            Claimed::read(value.as_object().ok_or_else(refused)?)
        };
        let refused = |value| Error::input(name, value, "give a list of words, each with its claims");
        Some(match given? {
            Value::Array(all) if !all.is_empty() => all.iter().map(one).collect(),
            other => Err(refused(other)),
        })
    }

    fn shown(&self) -> Option<Value> {
        Some(self.iter().map(Claimed::shown).collect::<Vec<_>>().into())
    }
}

impl WordCheck {
    /// Reads a file of TOML, a table `[[word]]` for each word.
    ///
    /// # Errors
    /// A text that is no TOML, a key or a value that is none, a claim that nothing can be held against; each
    /// with the line that it stands in.
    pub fn of_toml(file: &str, text: &str) -> Result<WordCheck> {
        let read = |entry: &Entry| {
            let claimed = Claimed::read(&entry.fields).map_err(|error| entry.locate(error))?;
            Ok(Claimed { entry: Some(entry.clone()), ..claimed })
        };
        Ok(WordCheck { words: tables(file, text, "word")?.iter().map(read).collect::<Result<_>>()? })
    }

    /// Whether every claim holds.
    pub fn all_hold(answer: &[Held]) -> bool {
        answer.iter().flat_map(|held| &held.checks).all(|check| check.holds)
    }
}

impl Question for WordCheck {
    const NAME: &'static str = "word-check";
    type Answer = Vec<Held>;

    fn schema() -> Option<Schema> {
        const CHECKS: Shape = Shape::List(&Shape::Object(|| record().keys()));
        let body = Keys::new()
            .key("claims", COUNT, "How many claims there are.")
            .key("failed", COUNT, "How many of them do not hold.")
            .key("checks", CHECKS, "The claims, in the order of the words.");
        Some(Schema::new("Words held against the claims of their authors", body))
    }

    fn answer(&self, work: &Work) -> Result<Vec<Held>> {
        let one = |claimed: &Claimed| claimed.hold(work).map_err(|error| claimed.locate(error));
        self.words.iter().map(one).collect()
    }

    fn show(&self, answer: &Vec<Held>) -> Document {
        let rows: Vec<Row> =
            answer.iter().flat_map(|held| held.checks.iter().map(move |check| Row { held, check })).collect();
        let failed: Vec<&Row> = rows.iter().filter(|row| !row.check.holds).collect();
        let words = if answer.len() == 1 { "a word".into() } else { format!("{} words", answer.len()) };
        let count = match (rows.len(), failed.len()) {
            (1, 0) => format!("1 claim about {words}: it holds"),
            (all, 0) => format!("{all} claims about {words}: all hold"),
            (all, n) => format!("claims about {words} that do not hold: {n} of {all}"),
        };
        let lines: Vec<String> =
            failed.iter().map(|row| row.line()).chain(notes(answer)).chain([count]).collect();
        Document::new(Self::NAME)
            .entry("claims", rows.len())
            .entry("failed", failed.len())
            .rows(record().table("checks", "Claims about words, each held against what is found", &rows))
            .summary_alone(&lines)
    }

    fn command(&self) -> String {
        "kickdrift word --check FILE.toml".into()
    }
}

/// A claim, and the word it is about.
struct Row<'a> {
    held: &'a Held,
    check: &'a Checked,
}

impl Row<'_> {
    /// For people, and for a CI's log.
    fn line(&self) -> String {
        let Checked { claim, claimed, found, by, .. } = self.check;
        let by = by.as_ref().map_or(String::new(), |by| format!(": {by}"));
        format!("{}: {claim} is {found}, not {claimed}{by}", self.held.at(claim))
    }
}

impl Held {
    /// The name, behind the line in which a key stands.
    fn at(&self, key: &str) -> String {
        let place = self.entry.as_ref().map_or(String::new(), |entry| format!("{}: ", entry.place(key)));
        format!("{place}{}", self.name)
    }
}

/// An order on oscillators says little about other problems: this is told where nothing else is claimed.
fn notes(answer: &[Held]) -> impl Iterator<Item = String> {
    answer.iter().filter_map(|held| {
        let claims = |name: &str| held.checks.iter().any(|check| check.claim == name);
        let orders = held.linted.general.as_ref().ok()?;
        let (oscillators, all) = (held.linted.order.nominal, orders.general.nominal);
        let silent = claims("order") && !claims("general_order") && !claims("nystrom_order");
        (silent && all < oscillators).then(|| {
            format!(
                "{}: note: order = {oscillators} is the order on oscillators; on all problems it is {all}: claim general_order or nystrom_order",
                held.at("order")
            )
        })
    })
}

/// The row of a claim.
fn record<'a>() -> Record<'static, Row<'a>> {
    Record::new()
        .field(Column::new("name").left(), |row: &Row| row.held.name.as_str().into())
        .says(TEXT, "The name that the author gave, else the method's, else the word.")
        .field(Column::new("claim").left(), |row| row.check.claim.into())
        .says(Shape::OneOf(claim::CLAIMS), "What the claim is about.")
        .field(Column::new("claimed").left(), |row| row.check.claimed.as_str().into())
        .says(TEXT, "As the author wrote it.")
        .field(Column::new("found").left(), |row| row.check.found.as_str().into())
        .says(TEXT, "The answer; coefficients with decimals are taken nominally, as `word` does.")
        .field(Column::new("holds").left(), |row| row.check.holds.into())
        .says(FLAG, "Whether the claim holds.")
        .field(Column::new("by").left(), |row| row.check.by.clone().map_or(Cell::Missing, Cell::Text))
        .says(Shape::OrNull(&TEXT), "What is in the way: the leading commutators, the letter that has no mirror image, the sum that is not 1, the difference; null where nothing is.")
}
