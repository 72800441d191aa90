//! The order of a word on oscillators, by the exact expansion of its product in the step.

use num_traits::{One, Zero};

use super::letters::Word;
use super::product::Forces;
use crate::number::{Polynomial, Radical, Rational, Ring};

/// Polynomials in ρ = Λ2/Λ1.
type InRho = Polynomial<Radical>;

/// How a word differs from the exact flow of x'' + (Λ1 + Λ2) x = 0, all coefficients exact.
///
/// Order p: every entry of the propagator errs by O(h^(p+1)). That is the order on linear problems; on others it may be lower.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// p; 0 where the word is not consistent.
    pub order: u64,
    /// The coefficients of h^(p+1) (with s = (ω h)², per power of ω) in the errors of the entries A, B, C, D, as polynomials
    /// in ρ where the word names two forces: 0 where an entry errs less.
    pub error: [InRho; 4],
    /// (k, c): the effective frequency is ω (1 + c (ω h)^k + ...). One force only; `None` also where it is exact or begins elsewhere.
    pub frequency: Option<(u64, Radical)>,
    /// (k, c): the effective impedance √(−C/B) is ω (1 + c (ω h)^k + ...). As `frequency`, and for A = D only.
    pub impedance: Option<(u64, Radical)>,
}

/// The coefficient of s^k in cos ω h (`offset` 0), sin ω h / ω h (1), −ω h sin ω h (−1), ω² h² = s (1 + ρ).
fn exact(k: usize, offset: i64) -> InRho {
    let last = 2 * k as i64 + offset;
    if last < 0 {
        return InRho::zero();
    }
    let factorial = (1..=last).fold(Rational::one(), |product, n| product * Rational::from_integer(n.into()));
    let sign = if k % 2 == 0 { Rational::one() } else { -Rational::one() };
    let one_plus_rho = InRho::new(vec![Radical::one(), Radical::one()]);
    let power = (0..k).fold(InRho::one(), |power, _| &power * &one_plus_rho);
    power.scale(&Radical::from_rational(&(sign / factorial)))
}

impl Word {
    /// The order on oscillators, with the leading errors.
    pub fn order(&self) -> Order {
        let named = self.names_forces();
        let s = Polynomial::<InRho>::variable();
        let rho = if named { InRho::variable() } else { InRho::zero() };
        let forces = Forces { of: [s.clone(), s.scale(&rho)], embed: |c| Polynomial::constant(InRho::constant(c.clone())) };
        let product = self.product(&forces);
        let flow = |k: usize, offset: i64| if named { exact(k, offset) } else { InRho::constant(exact(k, offset).coefficient(0)) };
        let below = product.denominator.coefficients();
        // The coefficient of s^k in `numerator` − denominator × flow.
        let error = |numerator: &Polynomial<InRho>, k: usize, offset: i64| {
            (0..=k.min(below.len() - 1)).fold(numerator.coefficient(k), |sum, j| &sum - &(&below[j] * &flow(k - j, offset)))
        };
        let m = &product.matrix;
        let entries = [(&m[(0, 0)], 0), (&m[(0, 1)], 1), (&m[(1, 0)], -1), (&m[(1, 1)], 0)];
        // The power of h of the first error: h^(2k) for A and D, h^(2k + 1) for B, h^(2k − 1) for C. A rational function of s is none of
        // these series, so there is one.
        let first = |&(entry, offset): &(&Polynomial<InRho>, i64)| {
            let k = (0..).find(|&k| !error(entry, k, offset).is_zero()).expect("no rational function is the exact flow");
            (k, (2 * k as i64 + offset) as u64)
        };
        let firsts: Vec<(usize, u64)> = entries.iter().map(first).collect();
        let least = firsts.iter().map(|(_, power)| *power).min().expect("four entries");
        let leading = |i: usize| {
            let ((k, power), (entry, offset)) = (firsts[i], entries[i]);
            if power == least { error(entry, k, offset) } else { InRho::zero() }
        };
        let consistent = self.is_consistent();
        let (mut frequency, mut impedance) = (None, None);
        if consistent && !named {
            // δ cos θ = −sin θ δθ, so δθ/θ = −(the error of Tr/2)/(ω h)².
            let trace = m[(0, 0)].clone() + m[(1, 1)].clone();
            let wrong = |k: usize| &error(&m[(0, 0)], k, 0) + &error(&m[(1, 1)], k, 0);
            frequency = (2..=2 * trace.coefficients().len() + 2).map(|k| (k, wrong(k))).find(|(_, c)| !c.is_zero());
            if m[(0, 0)] == m[(1, 1)] {
                // −C/s − B: half of its first term is the impedance's.
                let differs = |k: usize| -&(&m[(1, 0)].coefficient(k + 1) + &m[(0, 1)].coefficient(k));
                let most = m[(1, 0)].coefficients().len().max(m[(0, 1)].coefficients().len());
                impedance = (1..=most).map(|k| (k, differs(k))).find(|(_, c)| !c.is_zero());
            }
        }
        let half = Radical::from_rational(&Rational::new(1.into(), 2.into()));
        let halved = |c: InRho| &c.coefficient(0) * &half;
        Order {
            order: least.saturating_sub(1),
            error: [0, 1, 2, 3].map(leading),
            frequency: frequency.map(|(k, c)| (2 * k as u64 - 2, -halved(c))),
            impedance: impedance.map(|(k, c)| (2 * k as u64, halved(c))),
        }
    }
}
