//! Orders on all problems of words of the catalogue, by the number of their letters.
//!
//!     cargo bench -p kickdrift-words --bench order
//!
//! `-- NAME` or `-- WORD` asks one. Series are followed to one degree more than the order. No method of ten
//! letters has an order near 8, so two words are followed to the last degree, 9, because they are the exact
//! flow: one undoes its kicks and drifts again, and one is ten flows, the dearest letter, for each has all
//! monomials.

use std::time::{Duration, Instant};

use kickdrift_words::{Word, method};

/// How long each word is asked again and again.
const ASKED: Duration = Duration::from_millis(300);

/// By name, or as they are written.
const WORDS: &[&str] = &[
    "velocity-verlet",
    "chin-4a",
    "forest-ruth",
    "bcss-4",
    "mclachlan-atela-5",
    "fg-badadadab",
    "fg-adadadadada",
    "vefrl",
    "pefrl",
    "mclachlan-rkn-5",
    "4mn5fv",
    "blanes-moan-6",
    "blanes-moan-rkn-6-14",
    "suzuki-4",
    "yoshida-6",
    "yoshida-8",
    "mclachlan-ss17",
    "R(1/2) D(0.1786178958448091) K(-0.2123418310626054) D(-0.06626458266981849) K(0.7123418310626054) K(-0.7123418310626054) D(0.06626458266981849) K(0.2123418310626054) D(-0.1786178958448091) R(1/2)",
    "R(1/10) R(1/10) R(1/10) R(1/10) R(1/10) R(1/10) R(1/10) R(1/10) R(1/10) R(1/10)",
    "respa-4",
    "avi-3-2",
    "sexton-weingarten-4",
    "nested-2mn-4",
];

fn least(mut work: impl FnMut()) -> f64 {
    let (begin, mut least) = (Instant::now(), f64::INFINITY);
    while begin.elapsed() < ASKED {
        let start = Instant::now();
        work();
        least = least.min(start.elapsed().as_secs_f64());
    }
    least
}

fn main() {
    println!("| word | letters | general, Nystrom order | ms |\n|---|---|---|---|");
    let asked: Vec<String> = std::env::args().skip(1).filter(|x| !x.starts_with("--")).collect();
    let names = if asked.is_empty() { WORDS.iter().map(ToString::to_string).collect() } else { asked };
    for name in &names {
        let word: Word = match method(name) {
            Ok(listed) => listed.word(),
            Err(_) => name.parse().unwrap(),
        };
        let orders = word.general_order().unwrap();
        let time = least(|| {
            std::hint::black_box(word.general_order()).unwrap();
        });
        let [general, nystrom] = [&orders.general, &orders.nystrom].map(|order| order.nominal);
        println!("| {name} | {} | {general}, {nystrom} | {:.3} |", word.letters().len(), time * 1e3);
    }
}
