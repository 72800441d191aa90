//! Methods that stand between a processor and its inverse, with the processors that sources print.

use kickdrift_words::{Forces, METHODS, Stability, Word, method};

/// What acts first; its inverse acts last. Digits as in REBOUND, and in Blanes, Casas, Murua (2024).
const PROCESSORS: &[(&str, &str)] = &[
    (
        "takahashi-imada",
        "K(0.1859353996846055) D(0.8749306155955435) K(0.0731969797858114) D(-0.237106680151022) K(-0.1576624269298081) D(-0.5363539829039128)",
    ),
    (
        "pmlf-6",
        "D(0.07943288242455420) K(1.3599424487455264, -2*-0.034841228074994859) D(0.02974829169467665) K(-0.6505973747535132, -2*0.031675672097525204) D(-0.7057074964815896) K(-0.033542814598338416, -2*-0.005661054677711889) D(0.3190423451260838) K(-0.040129915275115030, -2*0.004262222269023640) D(-0.2869147334299646) K(0.044579729809902803, -2*0.005) D(0.564398710666239478150885) K(-0.680252073928462652752103, -2*-0.005)",
    ),
    (
        "blanes-casas-ros-6",
        "D(-0.5682049251492933) K(0.2005780724079215) D(0.2817876004745961) K(-0.3923456667727871) D(0.7168960305523042) K(-0.9517071967056039) D(0.4332386614652446) K(-0.0443156930081850) D(-0.3552157340165512) K(0.7361124293734198) D(-0.5825683076056897) K(0.3776113804258454)",
    ),
    (
        "plf-7-6-4",
        "R1(-0.3346222298730800) K2(-1.621810118086801) R1(1.097567990732164) K2(0.0061709468110142) R1(-1.038088746096783) K2(0.8348493592472594) R1(0.6234776317921379) K2(-0.0511253369989315) R1(-1.102753206303191) K2(0.5633782670698199) R1(-0.0141183222088869) K2(-1/2)",
    ),
];

/// Verlet steps of shares opposite to these, and of these; _ makes the sum of a half 0.
const COMPOSED: &[(&str, &[&str])] = &[
    (
        "blanes-processed-6",
        &["_", "-0.461165940466494", "-0.074332422810238", "0.384998538774070", "0.375012038697862"],
    ),
    (
        "blanes-casas-murua-6-11",
        &["_", "-0.20621953139126", "0.23651387483203", "0.09086982276241", "0.24687306977659", "-0.1"],
    ),
    (
        "blanes-casas-murua-6-13",
        &["0.1", "0.225080298761176", "0.191244694511161", "-0.212763792194890", "-0.09660157306582295", "_"],
    ),
    (
        "blanes-casas-murua-8",
        &[
            "_",
            "-0.008488123494574411",
            "-0.337188967354338",
            "0.333987768164597",
            "0.588351189003849",
            "0.162324207599241",
            "-0.511744926116413",
            "0.236885952363384",
            "0.598212975943381",
            "-0.543415765371656",
        ],
    ),
];

/// The letters of the inverse.
fn inverse(processor: &str) -> String {
    let undone = |letter: &str| {
        let (name, numbers) = letter.split_once('(').unwrap();
        let opposite: Vec<String> =
            numbers.strip_suffix(')').unwrap().split(',').map(|number| format!("-({number})")).collect();
        format!("{name}({})", opposite.join(","))
    };
    let spaced = processor.replace(", ", ",").replace(") ", ")|");
    spaced.split('|').rev().map(undone).collect::<Vec<_>>().join(" ")
}

/// Verlet steps of these shares.
fn verlets(shares: &[String]) -> String {
    shares.iter().map(|c| format!("K(({c})/2) D({c}) K(({c})/2)")).collect::<Vec<_>>().join(" ")
}

fn composed(shares: &[&str]) -> String {
    let known: Vec<&str> = shares.iter().copied().filter(|&share| share != "_").collect();
    let rest = format!("-({})", known.join("+").replace("+-", "-"));
    let half: Vec<String> =
        shares.iter().map(|&share| if share == "_" { rest.clone() } else { share.into() }).collect();
    let opposite: Vec<String> = half.iter().map(|c| format!("-({c})")).collect();
    verlets(&[opposite, half].concat())
}

fn between(processor: &str, kernel: &str) -> String {
    format!("{processor} {kernel} {}", inverse(processor))
}

fn nystrom(text: &str) -> u64 {
    text.parse::<Word>().unwrap().general_order().unwrap().nystrom.nominal
}

#[test]
fn processors_bring_kernels_to_the_order_that_is_published() {
    let composed = COMPOSED.iter().map(|(name, shares)| (*name, composed(shares)));
    for (name, processor) in PROCESSORS.iter().map(|(name, text)| (*name, text.to_string())).chain(composed) {
        let listed = method(name).unwrap();
        assert_eq!(nystrom(listed.text), listed.order, "{name} alone");
        assert_eq!(Some(nystrom(&between(&processor, listed.text))), listed.processed, "{name}");
    }
}

/// Where no processor is printed: an error c [A + B, X], X = [A, B], is taken away by one near exp(±c X). So
/// is the next one: for kicks by a potential [A + B, [A, X]] and [A + B, [B, X]] are a basis of degree 4.
#[test]
fn the_error_of_other_kernels_is_a_commutator_with_the_whole_motion() {
    let has_processor = |name: &str| {
        PROCESSORS.iter().any(|known| known.0 == name) || COMPOSED.iter().any(|known| known.0 == name)
    };
    let others = METHODS.iter().filter(|listed| listed.processed.is_some() && !has_processor(listed.name));
    let mut names = Vec::new();
    for listed in others {
        // A is what moves between kicks: the exact flow of a force or a drift.
        let word: Word = listed.text.replace("R1", "D").replace("K2", "K").parse().unwrap();
        let orders = word.general_order().unwrap().nystrom;
        let [first, second] = &orders.error[..] else { panic!("{}: {:?}", listed.name, orders.error) };
        assert_eq!([&first.commutator, &second.commutator], ["[B,[A,B]]", "[A,[A,B]]"], "{}", listed.name);
        assert_eq!(first.coefficient, second.coefficient, "{}", listed.name);
        assert_eq!((orders.order, listed.processed), (2, Some(4)), "{}", listed.name);
        names.push(listed.name);
    }
    assert_eq!(names, ["lopez-marcos-3", "wisdom-holman-modified", "wisdom-holman-composition"]);
}

/// Conjugation keeps the trace.
#[test]
fn a_processor_changes_no_stable_step() {
    for (name, processor) in PROCESSORS.iter().filter(|known| known.0 != "plf-7-6-4") {
        let kernel = method(name).unwrap();
        let edge = |text: &str| {
            let product = text.parse::<Word>().unwrap().polynomials(&Forces::one());
            Stability::of(&product).first_edge().unwrap().s().to_f64_enclosure()
        };
        assert_eq!(edge(&between(processor, kernel.text)), edge(kernel.text), "{name}");
    }
}
