//! Orders in the strength of a perturbation, as methods for planets state them: an error ε hⁿ + ε² hᵐ + ...

use super::{Expansion, Generator, LOG_MULTIPLE, SMALL_LOG2, Scalar, Whole};
use crate::catalogue::method;
use crate::letters::{Letter, Word};
use num_traits::{One, Zero};
use number::{Radical, Rational, Real, Ring};

/// Up to this degree, the second and third of all orders that are stated are seen.
const DEGREE: usize = 7;

/// What counts as 0, as for nominal orders.
fn is_small(x: &Radical) -> bool {
    x.enclosure(64).mid_f64().abs() < 2f64.powi(-30)
}

/// The perturbation kicks, what is left moves between: the first order is that of a quadrature.
fn first_order(word: &Word) -> u64 {
    let (mut place, mut nodes) = (Radical::zero(), Vec::new());
    for letter in word.letters() {
        match letter {
            Letter::Drift(time) => place = &place + time,
            Letter::Kick { powers, .. } => nodes.push((place.clone(), powers[0].clone())),
            _ => unreachable!("drifts and kicks"),
        }
    }
    let moment = |power: u64| {
        let sum = nodes.iter().fold(Radical::zero(), |sum, (node, weight)| {
            &sum + &(0..power).fold(weight.clone(), |product, _| &product * node)
        });
        &sum - &Radical::from_rational(&Rational::new(One::one(), (power + 1).into()))
    };
    (0..).find(|&power| !is_small(&moment(power))).unwrap()
}

/// The orders in h at ε² and ε³, of the logarithm of a step; `DEGREE` where none is seen.
fn next_orders(word: &Word) -> [usize; 2] {
    let expansion = Expansion::<Whole>::new(word);
    let step = expansion.product(word.items(), DEGREE).unwrap().log(LOG_MULTIPLE, DEGREE);
    [2, 3].map(|power| {
        let seen = step.terms().filter(|(monomial, value)| {
            let kicks = monomial.generators().iter().filter(|&&one| one == Generator::B1).count();
            kicks == power && !value.is_below(&(expansion.scale(monomial.degree()) >> SMALL_LOG2))
        });
        seen.map(|(monomial, _)| monomial.degree() - 1).min().unwrap_or(DEGREE)
    })
}

#[test]
fn methods_for_planets_have_the_orders_that_are_stated() {
    for (name, first, second, third) in [
        ("wisdom-holman", 2, 2, 4),
        ("saba-2", 4, 2, 4),
        ("saba-3", 6, 2, 4),
        ("saba-4", 8, 2, 4),
        ("sabac-2", 4, 4, 4),
        ("sabac-3", 6, 4, 4),
        ("sabac-4", 8, 4, 4),
        ("saba-10-4", 10, 4, 4),
        ("saba-8-6-4", 8, 6, 4),
        ("saba-10-6-4", 10, 6, 4),
        ("sabah-8-4-4", 8, 4, 4),
        ("sabah-8-6-4", 8, 6, 4),
        ("sabah-10-6-4", 10, 6, 4),
    ] {
        let text = method(name).unwrap().text.replace("R1", "D").replace("K2", "K");
        let word: Word = text.parse().unwrap();
        assert_eq!((first_order(&word), next_orders(&word)), (first, [second, third]), "{name}");
    }
}
