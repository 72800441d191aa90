//! No input panics, hangs, or is refused in more than one line.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use kickdrift::error::Error;
use kickdrift::number::parse;
use kickdrift::question::{Scene, WordCheck};
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

const CLAIMS: &str = include_str!("../../data/words/claims.toml");

/// As many cases as PROPTEST_CASES says, else so many.
fn cases(most: u32) -> ProptestConfig {
    let asked = std::env::var("PROPTEST_CASES").ok().and_then(|text| text.parse().ok());
    ProptestConfig::with_cases(asked.unwrap_or(most))
}

const SCENES: [&str; 2] =
    [include_str!("../../data/scenes/figure1.json"), include_str!("../../data/scenes/small.json")];

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
    #![proptest_config(cases(1000))]

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
        sane(|| Scene::from_json(&text))?;
    }

    #[test]
    fn a_damaged_list_of_claims_is_one_or_a_refusal(all in prop::collection::vec(damage(), 0..6)) {
        sane(|| WordCheck::of_toml("claims.toml", &damaged(CLAIMS, &all)))?;
    }

    #[test]
    fn any_json_is_a_scene_or_a_refusal(value in json()) {
        sane(|| Scene::from_json(&value.to_string()))?;
    }

    #[test]
    fn a_damaged_scene_is_a_scene_or_a_refusal(
        text in select(SCENES.to_vec()), all in prop::collection::vec(damage(), 0..6),
    ) {
        sane(|| Scene::from_json(&damaged(text, &all)))?;
    }

    #[test]
    fn a_scene_with_one_value_replaced_is_a_scene_or_a_refusal(
        text in select(SCENES.to_vec()), at in any::<Index>(), value in json(),
    ) {
        let mut scene: Value = serde_json::from_str(text).unwrap();
        let mut all = Vec::new();
        paths(&scene, String::new(), &mut all);
        *scene.pointer_mut(&all[at.index(all.len())]).unwrap() = value;
        sane(|| Scene::from_json(&scene.to_string()))?;
    }
}

/// What the program is run with: a command, and what may follow it.
const COMMANDS: [&str; 14] = [
    "verdict --lambda1 10 --lambda2 2/5 --h1 1/10 --h2 1/2 --exact --friction --certificate",
    "curves --lambda1 10 --a 0..2 --b -1..1 --samples 9 --h1-range 1/10..1 --h2-range 1/10..2",
    "compare --max-sum 7 --rho 1/25 --samples 9 --lambda1 16 --lambda2 1 --step 1/10 --h1-range 1/10..3/5 --h2-range 1/10..2",
    "proposition --max 6",
    "polynomial --ratio 5/3",
    "map --lambda1 10 --lambda2 2/5 --step 1/10 --step1 1/10 --h1-range 1/10..1 --h2-range 1/10..3 --shard --growth --label",
    "tongues --ratio 5/3 --max-sum 6 --rho 1/10 --m 1..3 --digits 9 --columns edges --survey --thinnest 3 --figure atlas",
    "closings --ratio 5/3 --max-sum 6 --m 2 --samples 9 --digits 9",
    "system data/scenes/diatomic-tether.json --scan potentials.0.scale=1..2:1/2 --intervals masses.0=1/2..1 --resolution 1e-2 --nearest --exact --friction 1/2",
    "simulate --lambda1 10 --lambda2 2/5 --h1 1/10 --h2 1/2 --periods 9",
    "run data/scenes/small.json",
    "verify data/scenes/small.json",
    "advise --period OH=10fs --bond CH:K=340kcal/mol/A^2,12.011,1.008 --steps 1/2fs,4fs --band 5% --length 10ns --friction 1/ps --on OH=1 --hmr 3.024 --constraints h-bonds",
    "generate man completions bash",
];

/// What may stand in the place of any word.
const WORDS: [&str; 24] = [
    "--format",
    "json",
    "csv",
    "text",
    "latex",
    "--output",
    "--quiet",
    "--threads",
    "1",
    "--budget",
    "--",
    "-",
    "",
    "-1",
    "0",
    "1/0",
    "1e400",
    "NaN",
    "pi",
    "1..0",
    "7/7",
    "4fs",
    "--help",
    "\u{202e}",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, max_shrink_iters: 20, ..ProptestConfig::default() })]

    /// Some words of a command line left out, doubled or replaced: the program answers, or refuses in one
    /// line.
    #[test]
    fn any_command_line_is_answered_or_refused_in_one_line(
        command in select(COMMANDS.to_vec()),
        all in prop::collection::vec((any::<Index>(), 0u8..3, select(WORDS.to_vec())), 0..5),
        numbers in prop::collection::vec((any::<Index>(), select(NUMBERS.to_vec())), 0..2),
    ) {
        let mut words: Vec<&str> = command.split(' ').collect();
        for (at, how, word) in all {
            let at = at.index(words.len());
            match how {
                0 if words.len() > 1 => drop(words.remove(at)),
                1 => words.insert(at, words[at]),
                _ => words[at] = word,
            }
        }
        for (at, number) in numbers {
            let at = at.index(words.len());
            words[at] = number;
        }
        // Whatever was asked, at little cost, and into no file.
        words.retain(|word| !["--output", "--certificate", "--budget"].contains(word));
        words.extend(["--budget", "100000"]);
        let (code, stderr) = answered(&words)?;
        prop_assert!(matches!(code, Some(0..=2)), "{words:?}: {code:?} {stderr}");
        prop_assert!(!stderr.contains("panicked"), "{words:?}: {stderr}");
        let is_one_line = stderr.lines().count() == 1 && stderr.starts_with("kickdrift: ");
        prop_assert!(code == Some(0) || is_one_line || code == Some(1), "{words:?}: {stderr}");
    }
}

/// The program's exit code and what it wrote on standard error; what takes longer than patience allows is
/// ended and fails.
fn answered(words: &[&str]) -> Result<(Option<i32>, String), TestCaseError> {
    let mut child = Command::new(env!("CARGO_BIN_EXE_kickdrift"))
        .args(words)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if start.elapsed() > PATIENCE {
            child.kill().unwrap();
            child.wait().unwrap();
            return Err(TestCaseError::fail(format!("{words:?} took longer than {PATIENCE:?}")));
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    let ended = child.wait_with_output().unwrap();
    Ok((ended.status.code(), String::from_utf8_lossy(&ended.stderr).into_owned()))
}
