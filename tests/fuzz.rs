//! No input panics, hangs, or is refused in more than one line.

use std::time::{Duration, Instant};

use kickdrift::error::Error;
use kickdrift::number::parse;
use kickdrift::scene::Scene;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use serde_json::Value;

/// The parser bounds its effort to a few seconds on an idle machine; this one may be busy.
const PATIENCE: Duration = Duration::from_secs(60);

/// Runs one case against the clock; a refusal must be one line of bearable length.
fn sane<T>(case: impl FnOnce() -> Result<T, Error>) -> Result<Option<T>, TestCaseError> {
    let start = Instant::now();
    let result = case();
    prop_assert!(start.elapsed() < PATIENCE, "took {:?}", start.elapsed());
    match result {
        Ok(value) => Ok(Some(value)),
        Err(error) => {
            let message = error.to_string();
            prop_assert!(!message.contains(char::is_control), "{message:?}");
            prop_assert!(message.chars().count() < 1000, "{message}");
            Ok(None)
        }
    }
}

/// All ways to read a text as a quantity; what is read must be read again from what it shows.
fn reads(text: &str) -> Result<(), TestCaseError> {
    sane(|| parse::parse_ratio("ratio", text))?;
    sane(|| parse::parse_integer("a", text))?;
    sane(|| parse::parse_range("h1-range", text))?;
    sane(|| parse::parse_integer_range("b", text))?;
    if let Some(value) = sane(|| parse::parse("h1", text))? {
        let shown = value.to_string();
        if shown.len() < parse::MAX_CHARACTERS {
            prop_assert_eq!(parse::parse("h1", &shown).unwrap(), value, "{}", shown);
        }
    }
    Ok(())
}

const NUMBERS: [&str; 14] = [
    "0",
    "3/10",
    "0.3",
    ".5",
    "1e-3",
    "-2^2",
    "pi^2/25",
    "2/pi",
    "(1 + pi)^3 / 7",
    "-(3 - π)*2",
    "1..2",
    "1/100..2/pi",
    "123456789.987654321e-30",
    "((((1))))^-7",
];

/// One small damage to a text.
#[derive(Clone, Debug)]
enum Damage {
    Drop(Index),
    Double(Index),
    Swap(Index, Index),
    Put(Index, char),
    Cut(Index),
    Repeat(u8),
}

fn damage() -> impl Strategy<Value = Damage> {
    let character =
        prop_oneof![select("0123456789.eE+-*/^()piπ _,{}[]\":\\".chars().collect::<Vec<_>>()), any::<char>()];
    prop_oneof![
        any::<Index>().prop_map(Damage::Drop),
        any::<Index>().prop_map(Damage::Double),
        any::<(Index, Index)>().prop_map(|(a, b)| Damage::Swap(a, b)),
        (any::<Index>(), character).prop_map(|(at, c)| Damage::Put(at, c)),
        any::<Index>().prop_map(Damage::Cut),
        (0u8..4).prop_map(Damage::Repeat),
    ]
}

fn damaged(text: &str, all: &[Damage]) -> String {
    let mut text: Vec<char> = text.chars().collect();
    for damage in all {
        let n = text.len();
        if n == 0 {
            break;
        }
        match damage {
            Damage::Drop(at) => drop(text.remove(at.index(n))),
            Damage::Double(at) => text.insert(at.index(n), text[at.index(n)]),
            Damage::Swap(a, b) => text.swap(a.index(n), b.index(n)),
            Damage::Put(at, c) => text[at.index(n)] = *c,
            Damage::Cut(at) => text.truncate(at.index(n)),
            Damage::Repeat(times) => text = text.repeat(usize::from(*times)),
        }
    }
    text.into_iter().collect()
}

/// Any JSON, with the words of a scene in it now and then.
fn json() -> impl Strategy<Value = Value> {
    let words =
        ["schema", "kickdrift/scene/1", "grid", "step", "want", "map", "families", "a", "1..2", "pi", ""];
    let word = prop_oneof![select(words.to_vec()).prop_map(str::to_string), any::<String>()];
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        any::<f64>().prop_map(Value::from),
        word.clone().prop_map(Value::from),
        select(NUMBERS.to_vec()).prop_map(Value::from),
    ];
    leaf.prop_recursive(4, 40, 6, move |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..6).prop_map(Value::from),
            prop::collection::vec((word.clone(), inner), 0..6)
                .prop_map(|entries| entries.into_iter().collect()),
        ]
    })
}

const SCENES: [&str; 2] =
    [include_str!("../data/scenes/figure1.json"), include_str!("../data/scenes/small.json")];

/// Every value inside a JSON value, by its path.
fn paths(value: &Value, here: String, all: &mut Vec<String>) {
    match value {
        Value::Object(map) => map.iter().for_each(|(key, value)| paths(value, format!("{here}/{key}"), all)),
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, value)| paths(value, format!("{here}/{i}"), all));
        }
        _ => {}
    }
    all.push(here);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn any_text_is_a_number_or_a_refusal(text in any::<String>()) {
        reads(&text)?;
    }

    #[test]
    fn any_text_of_the_right_characters_is_a_number_or_a_refusal(text in "[0-9pie.+*/^() -]{0,40}") {
        reads(&text)?;
    }

    #[test]
    fn a_damaged_number_is_a_number_or_a_refusal(
        text in select(NUMBERS.to_vec()), all in prop::collection::vec(damage(), 0..12),
    ) {
        reads(&damaged(text, &all))?;
    }

    #[test]
    fn any_text_is_a_scene_or_a_refusal(text in any::<String>()) {
        sane(|| Scene::read(&text))?;
    }

    #[test]
    fn any_json_is_a_scene_or_a_refusal(value in json()) {
        sane(|| Scene::read(&value.to_string()))?;
    }

    #[test]
    fn a_damaged_scene_is_a_scene_or_a_refusal(
        text in select(SCENES.to_vec()), all in prop::collection::vec(damage(), 0..6),
    ) {
        sane(|| Scene::read(&damaged(text, &all)))?;
    }

    #[test]
    fn a_scene_with_one_value_replaced_is_a_scene_or_a_refusal(
        text in select(SCENES.to_vec()), at in any::<Index>(), value in json(),
    ) {
        let mut scene: Value = serde_json::from_str(text).unwrap();
        let mut all = Vec::new();
        paths(&scene, String::new(), &mut all);
        *scene.pointer_mut(&all[at.index(all.len())]).unwrap() = value;
        sane(|| Scene::read(&scene.to_string()))?;
    }
}
