//! Orders on all problems, held against local errors in high precision on problems that are not linear.

use kickdrift_words::anharmonic::order_shown;
use kickdrift_words::number::{Radical, Rational};
use kickdrift_words::{
    ALL, FREE, Forces, GeneralOrder, HALF_PERIOD, LIMITS, METHODS, NoGeneralOrder, Shape, Stability, Word,
    method,
};
use num_traits::{One, Zero};

fn orders(text: &str) -> GeneralOrder {
    text.parse::<Word>().unwrap().general_order().unwrap()
}

/// The exact orders: in general, of a potential.
fn exact(text: &str) -> (u64, u64) {
    let orders = orders(text);
    (orders.general.order, orders.nystrom.order)
}

fn terms(order: &kickdrift_words::FormalOrder) -> Vec<String> {
    let text = |c: &Radical| c.text(ToString::to_string);
    order.error.iter().map(|term| format!("{} {}", text(&term.coefficient), term.commutator)).collect()
}

/// Steps of 2^-5: errors of rounded coefficients, 1e-16 h³, are far below those of order 8, and those of
/// order 6 whose constant is 1e-6.
const STEP_LOG2: u32 = 5;

/// For words whose leading term is small beside the next ones, as those for planets are: the coefficients of
/// these are long.
const SHORT_STEP_LOG2: u32 = 7;

/// That the error halves as the order says; the next term changes it by about a step's length, 3 %.
fn shows(word: &Word, quadratic: bool, order: u64, name: &str) {
    shows_at(&[STEP_LOG2, SHORT_STEP_LOG2], word, quadratic, order, name);
}

/// At one of the steps.
fn shows_at(steps_log2: &[u32], word: &Word, quadratic: bool, order: u64, name: &str) {
    let seen: Vec<f64> = steps_log2.iter().map(|&log2| order_shown(word, quadratic, log2).unwrap()).collect();
    let is_near = |seen: &f64| (seen - order as f64).abs() < 0.25;
    assert!(seen.iter().any(is_near), "{name}: order {order}, seen {seen:?}");
}

#[test]
fn methods_of_the_catalogue_converge_as_their_orders_say() {
    let mut held = 0;
    for listed in METHODS {
        let word = listed.word();
        let Ok(orders) = word.general_order() else { continue };
        let has_gradient = word.cost().gradients > 0;
        if orders.nystrom.nominal > 0 {
            shows(&word, true, orders.nystrom.nominal, listed.name);
            // A force gradient is a kick for a quadratic kinetic energy alone.
            if !has_gradient {
                shows(&word, false, orders.general.nominal, listed.name);
            }
            held += 1;
        }
        assert_eq!(orders.nystrom.nominal, listed.order, "{}: the order that its source states", listed.name);
    }
    assert!(held > 115, "{held} methods");
}

/// A limit that a source prints holds to its last digit, or the catalogue says why not.
#[test]
fn published_limits_are_met_or_the_reason_is_listed() {
    for limit in LIMITS {
        let word = method(limit.method).unwrap().word();
        let agrees = limit.disagrees.is_none();
        match limit.below {
            ALL => {
                let stability = Stability::of(&word.polynomials(&Forces::one()));
                assert!(agrees && stability.begins_stable() && stability.first_edge().is_none());
            }
            FREE => {
                // Up to the slow force's own limit: ω2 h = 2 is ω1 h = 8 at a quarter of the frequency.
                let sixteenth = Rational::new(1.into(), 16.into());
                let stability = Stability::of(&word.polynomials(&Forces::ratio(&sixteenth)));
                let edge = stability.first_edge().unwrap().rational();
                assert!(agrees && edge == Some(Rational::from_integer(64.into())), "{}", limit.method);
            }
            HALF_PERIOD => {
                let (first, last) = first_unstable(&word);
                assert_eq!((first < last, agrees), (true, false), "{}: {first}", limit.method);
                assert!((last - 5.0).abs() < 1e-9, "{}: the half period is 5, not {last}", limit.method);
            }
            below => is_met(limit.method, &word, below, agrees),
        }
    }
}

/// The first unstable steps of a fast period 10 and a slow one 40.
fn first_unstable(word: &Word) -> (f64, f64) {
    let [fast, slow] = ["pi^2/25", "pi^2/400"].map(|stiffness| stiffness.parse().unwrap());
    let pieces = Shape::of(word).unwrap().pieces(&fast, &slow, 0.0, 6.0);
    let unstable = pieces.iter().find(|piece| !piece.stable).unwrap();
    (unstable.lower.0, unstable.upper.1)
}

fn is_met(name: &str, word: &Word, below: &str, agrees: bool) {
    let printed: f64 = below.parse().unwrap();
    let places = below.split_once('.').map_or(0, |(_, fraction)| fraction.len());
    let stability = Stability::of(&word.polynomials(&Forces::one()));
    let (strict, nominal) = (stability.first_edge().unwrap(), stability.nominal_edge().unwrap());
    let [strict, nominal] = [strict, nominal].map(|edge| edge.s().mid_f64().sqrt());
    // Rounded or cut.
    let is_met = |edge: f64| (edge - printed).abs() < 10f64.powi(-(places as i32));
    assert!(is_met(nominal), "{name}: {nominal}, published {printed}");
    assert_eq!(is_met(strict), agrees, "{name}: {strict}, published {printed}");
}

#[test]
fn published_orders_are_met() {
    assert_eq!(exact("K(1/2) D(1) K(1/2)"), (2, 2));
    assert_eq!(exact("K(7/24) D(2/3) K(3/4) D(-2/3) K(-1/24) D(1)"), (3, 3));
    assert_eq!(exact(method("forest-ruth").unwrap().text), (4, 4));
    assert_eq!(exact(method("chin-4a").unwrap().text), (4, 4));
    let atela = method("mclachlan-atela-4").unwrap().word().general_order().unwrap();
    assert_eq!((atela.general.nominal, atela.nystrom.nominal), (3, 4));
    let yoshida = method("yoshida-6").unwrap().word().general_order().unwrap();
    assert_eq!((yoshida.general.nominal, yoshida.nystrom.nominal), (6, 6));
    assert_eq!(exact("R(1)"), (9, 9));
    assert_eq!(exact("K1(1/2) D(1) K2(1)"), (0, 0));
}

#[test]
fn leading_errors_are_the_known_commutators() {
    // Strang's splitting, Hairer, Lubich, Wanner III.4.
    assert_eq!(terms(&orders("K(1/2) D(1) K(1/2)").general), ["1/24 [B,[A,B]]", "1/12 [A,[A,B]]"]);
    assert_eq!(terms(&orders("K(1) D(1)").general), ["-1/2 [A,B]"]);
    // [B,[B,[A,B]]] vanishes for a potential.
    let ruth = orders("K(7/24) D(2/3) K(3/4) D(-2/3) K(-1/24) D(1)");
    assert_eq!(terms(&ruth.general).len(), 3);
    assert_eq!(terms(&ruth.nystrom), terms(&ruth.general)[1..]);
    assert_eq!(terms(&orders("K1(1/2) D(1) K2(1)").general), ["-1/2 B1"]);
    // Two forces: B = B1 + B2, and by symmetry as many terms begin with either.
    let two = orders(&format!("{} K1(0)", method("forest-ruth").unwrap().text));
    assert_eq!((two.general.order, two.nystrom.order), (4, 4));
    let with = |name: &str| two.general.error.iter().filter(|term| term.commutator.contains(name)).count();
    assert_eq!(with("B1"), with("B2"));
    assert!(two.general.error.len() > orders(method("forest-ruth").unwrap().text).general.error.len());
}

#[test]
fn two_coefficients_that_are_swapped_are_noticed() {
    // Order 4 becomes order 2 or less (JuliaGNI/GeometricIntegrators.jl 220).
    let right = "K(0.1344961992774310892) D(0.5153528374311229364) K(-0.2248198030794208058) D(-0.085782019412973646) K(0.7563200005156682911) D(0.4415830236164665242) K(0.3340036032863214255) D(0.1288461583653841854)";
    let wrong = right
        .replace("D(-0.085782019412973646)", "D(x)")
        .replace("D(0.4415830236164665242)", "D(-0.085782019412973646)")
        .replace("D(x)", "D(0.4415830236164665242)");
    assert_eq!(orders(right).nystrom.nominal, 4);
    let swapped = orders(&wrong);
    assert!(swapped.nystrom.nominal < 3, "{}", swapped.nystrom.nominal);
    shows(&wrong.parse().unwrap(), true, swapped.nystrom.nominal, "swapped");
}

#[test]
fn what_is_no_product_of_flows_has_no_order_on_all_problems() {
    let reason = |text: &str| text.parse::<Word>().unwrap().general_order().unwrap_err();
    assert_eq!(reason("C(1)"), NoGeneralOrder::Midpoint);
    assert_eq!(reason("K2[sinc(x)](1/2) R1(1) K2[sinc(x)](1/2)"), NoGeneralOrder::Filter);
    assert_eq!(reason("K(1/2, 0, 1/100) D(1) K(1/2)"), NoGeneralOrder::Powers);
}

/// Words of one and of two forces whose coefficients are small rationals, sums 1 or not.
#[test]
fn random_words_show_the_order_that_is_computed() {
    let mut state = 7u64;
    let mut next = |n: u64| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) % n
    };
    let mut seen = [0; 4];
    for _ in 0..200 {
        // Palindromes of kicks and drifts with consistent sums have order 2 at least, others 1.
        let two = next(2) == 0;
        let names: &[&str] = if two { &["K1", "K2"] } else { &["K"] };
        let mut letters = Vec::new();
        let (mut drift, mut kicks) = (Rational::zero(), vec![Rational::zero(); names.len()]);
        for _ in 0..2 + next(3) {
            let c = Rational::new((1 + next(9)).into(), (10 + next(9)).into());
            drift += &c;
            letters.push(format!("D({c})"));
            let which = next(names.len() as u64) as usize;
            let c = Rational::new((1 + next(9)).into(), (10 + next(9)).into());
            kicks[which] += &c;
            letters.push(format!("{}({c})", names[which]));
        }
        let half = Rational::new(1.into(), 2.into());
        let whole = if next(2) == 0 { Rational::one() } else { half };
        letters.push(format!("D({})", &whole - drift));
        names.iter().zip(&kicks).for_each(|(name, sum)| letters.push(format!("{name}({})", &whole - sum)));
        if whole != Rational::one() {
            let back: Vec<String> = letters.iter().rev().cloned().collect();
            letters.extend(back);
        }
        let word: Word = letters.join(" ").parse().unwrap();
        let orders = word.general_order().unwrap();
        // The leading term may be small beside the next one.
        shows_at(&[SHORT_STEP_LOG2], &word, true, orders.nystrom.order, &word.to_string());
        shows_at(&[SHORT_STEP_LOG2], &word, false, orders.general.order, &word.to_string());
        seen[orders.general.order as usize] += 1;
    }
    assert!(seen[1] > 40 && seen[2] > 40, "{seen:?}");
}

/// Orders that Principia states of partitioned methods, which need no quadratic kinetic energy.
#[test]
fn partitioned_methods_have_the_order_of_their_source_on_all_problems() {
    let partitioned = [
        "velocity-verlet",
        "mclachlan-atela-2",
        "2mn-velocity",
        "mclachlan-atela-3",
        "ruth-3",
        "blanes-moan-4",
        "forest-ruth",
        "mclachlan-s4",
        "mclachlan-s5",
        "mclachlan-ss5",
        "suzuki-4",
        "blanes-moan-6",
        "mclachlan-ss9",
        "yoshida-6",
        "yoshida-6-b",
        "yoshida-6-c",
        "mclachlan-ss15",
        "mclachlan-ss17",
        "yoshida-8",
        "yoshida-8-b",
        "yoshida-8-c",
        "yoshida-8-d",
        "yoshida-8-e",
    ];
    for listed in partitioned.map(|name| method(name).unwrap()) {
        assert_eq!(listed.word().general_order().unwrap().general.nominal, listed.order, "{}", listed.name);
    }
}
