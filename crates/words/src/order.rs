//! The order of a word on oscillators, by the exact expansion of its product in the step.

use num_traits::{One, Zero};

use super::letters::Word;
use super::product::{FEW_TERMS, Forces, TERMS};
use number::{Polynomial, Radical, Rational, Real, Ring, rational};

/// Polynomials in ρ = Λ2/Λ1.
type InRho = Polynomial<Radical>;

/// How a word differs from the exact flow of x'' + (Λ1 + Λ2) x = 0, all coefficients exact.
///
/// Order p: every entry of the propagator errs by O(h^(p+1)). That is the order on linear problems; on others
/// it may be lower.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// p; 0 where the word is not consistent.
    pub order: u64,
    /// The order when coefficients below 2^-30 count as 0: those of published decimals, which have 10 digits
    /// and more, leave such errors where exact ones would leave none.
    pub nominal: u64,
    /// The coefficients of (√Λ1 h)^(p+1) in the errors of the entries A, B, C, D in the time unit 1/√Λ1,
    /// polynomials in ρ where the word names two forces: 0 where an entry errs less.
    pub error: [InRho; 4],
    /// (k, c): the effective frequency is ω (1 + c (ω h)^k + ...). For consistent words of one force; `None`
    /// also where it is exact.
    pub frequency: Option<(u64, Radical)>,
    /// (k, c): the effective impedance √(−C/B) is ω (1 + c (ω h)^k + ...). As `frequency`, and for A = D
    /// only.
    pub impedance: Option<(u64, Radical)>,
}

/// The largest order that is given for a word with exact flows or filters: it has this order or a higher one.
pub const MOST_ORDER: u64 = known_order(TERMS);

/// An error coefficient below this counts as 0 for the nominal order.
const ROUNDED: i64 = -30;

/// The coefficient of s^k in cos ω h (`offset` 0), sin ω h / ω h (1), −ω h sin ω h (−1), ω² h² = s (1 + ρ).
fn exact(k: usize, offset: i64, named: bool) -> InRho {
    let last = 2 * k as i64 + offset;
    if last < 0 {
        return InRho::zero();
    }
    let factorial = (1..=last).fold(Rational::one(), |product, n| product * Rational::from_integer(n.into()));
    let sign = if k.is_multiple_of(2) { Rational::one() } else { -Rational::one() };
    let sum = if named { InRho::new(vec![Radical::one(), Radical::one()]) } else { InRho::one() };
    (0..k).fold(InRho::one(), |power, _| &power * &sum).scale(&Radical::from_rational(&(sign / factorial)))
}

/// The order up to which the series of so many terms are known.
const fn known_order(terms: usize) -> u64 {
    2 * terms as u64 - 3
}

/// A power series in s without the terms that flows and filters leave out.
fn first_terms(series: Polynomial<InRho>, terms: usize) -> Polynomial<InRho> {
    Polynomial::new(series.coefficients().iter().take(terms + 1).cloned().collect())
}

fn is_small(f: &InRho) -> bool {
    let limit = rational::scale2(&1.into(), ROUNDED);
    f.coefficients().iter().all(|c| c.is_zero() || c.enclosure(32).abs().upper() < limit)
}

impl Word {
    /// The order on oscillators, with the leading errors.
    pub fn order(&self) -> Order {
        // The frequency's error of one force may come much later than that of the entries.
        if !self.is_algebraic() && self.names_forces() {
            let order = self.order_by(FEW_TERMS);
            if order.nominal < known_order(FEW_TERMS) {
                return order;
            }
        }
        self.order_by(TERMS)
    }

    fn order_by(&self, terms: usize) -> Order {
        let named = self.names_forces();
        let s = Polynomial::<InRho>::variable();
        let rho = if named { InRho::variable() } else { InRho::zero() };
        let embed = |c: &Radical| Polynomial::constant(InRho::constant(c.clone()));
        let mut forces = Forces::new([s.clone(), s.scale(&rho)], embed);
        if !self.is_algebraic() {
            (forces.terms, forces.trim) = (terms, first_terms);
        }
        let product = self.product(&forces);
        let below = product.denominator.coefficients();
        // The coefficient of s^k in an entry's numerator less the denominator times the flow: to first order
        // that of the error.
        let error = |numerator: &Polynomial<InRho>, k: usize, offset: i64| {
            let flow = |sum, j: usize| &sum - &(&below[j] * &exact(k - j, offset, named));
            (0..below.len().min(k + 1)).fold(numerator.coefficient(k), flow)
        };
        let m = &product.matrix;
        let entries = [(&m[(0, 0)], 0), (&m[(0, 1)], 1), (&m[(1, 0)], -1), (&m[(1, 1)], 0)];
        // s^k in A and D is h^(2k), in B h^(2k + 1), in C h^(2k − 1).
        let errors = |power: u64| {
            entries.map(|(entry, offset)| {
                let twice = power as i64 - offset;
                if twice % 2 == 0 { error(entry, (twice / 2) as usize, offset) } else { InRho::zero() }
            })
        };
        // No rational function of s is the exact flow, so both are found; of series the first terms are
        // known.
        let most = if self.is_algebraic() { u64::MAX } else { known_order(terms) + 1 };
        let first = |counts: &dyn Fn(&InRho) -> bool| {
            (1..most).find(|&power| errors(power).iter().any(counts)).unwrap_or(most)
        };
        let (order, nominal) = (first(&|f| !f.is_zero()) - 1, first(&|f| !is_small(f)) - 1);
        let half = Radical::from_rational(&rational::ratio(1, 2));
        let halved = |c: InRho| &c.coefficient(0) * &half;
        let (mut frequency, mut impedance) = (None, None);
        if self.is_consistent() && !named {
            // δ cos θ = −sin θ δθ, so δθ/θ = −(the error of Tr/2)/(ω h)².
            let wrong = |k: usize| &error(&m[(0, 0)], k, 0) + &error(&m[(1, 1)], k, 0);
            let differs = |k: &usize| !wrong(*k).is_zero();
            let most = if self.is_algebraic() { usize::MAX } else { terms - 1 };
            frequency = (2..most).find(differs).map(|k| (2 * k as u64 - 2, -halved(wrong(k))));
            if m[(0, 0)] == m[(1, 1)] {
                // −C/(s B) = 1 + 2 c s^k + ...
                let wrong = |k: usize| -(&m[(1, 0)].coefficient(k + 1) + &m[(0, 1)].coefficient(k));
                let most = most.min(m[(1, 0)].coefficients().len().max(m[(0, 1)].coefficients().len()));
                let found = (1..=most).find(|&k| !wrong(k).is_zero());
                impedance = found.map(|k| (2 * k as u64, halved(wrong(k))));
            }
        }
        Order { order, nominal, error: errors(order + 1), frequency, impedance }
    }
}
