//! Do two entries share a zero at all? Decided modulo a prime.
//!
//! For fixed p/q and ρ the entries are polynomials in κ. **Lemma.** If a prime does not divide the
//! denominators of ρ p/q, the degrees of X and Y survive modulo it, and X and Y have no common factor there,
//! they have none over Q: their resultant is an integer (up to powers of the denominator) that is not 0
//! modulo the prime. So B and C without a common factor mean that no tongue of even m is closed, however
//! thin; A and D likewise for odd m. The other answer, a common factor, may be an accident of the prime and
//! is left to exact arithmetic.

use num_traits::Zero;

use crate::schedule::{KickDrift, Kicks, Schedule};
use number::{PrimeField, Ratio, Rational, Result};

/// Any prime field will do.
const FIELD: PrimeField = PrimeField::LARGEST;

/// c_0, c_1, ..., the last one not 0.
type Coefficients = Vec<u64>;

fn trim(mut f: Coefficients) -> Coefficients {
    while f.last() == Some(&0) {
        f.pop();
    }
    f
}

/// x += c y.
fn add_multiple(x: &mut Coefficients, c: u64, y: &[u64]) {
    x.resize(x.len().max(y.len()), 0);
    x.iter_mut().zip(y).for_each(|(x, y)| *x = FIELD.add(*x, FIELD.mul(c, *y)));
}

/// x and v at T/2 as polynomials in 2κ; `None` where the prime divides a denominator.
fn ends(ratio: Ratio, rho: &Rational, even: bool) -> Result<Option<(Coefficients, Coefficients)>> {
    let Some(slow) = FIELD.of_rational(&(rho * Rational::from(ratio))) else { return Ok(None) };
    let one = FIELD.of(1);
    let kicks = Kicks::of_two_clocks([one, slow, FIELD.add(one, slow)], |half| [FIELD.add(half, half), half]);
    let (x, v) = if even { (vec![one], vec![]) } else { (vec![], vec![one]) };
    let mut orbit = PolynomialOrbit { x, v };
    kicks.lead(Schedule::two_clocks(ratio)?.half_period(), &mut orbit);
    Ok(Some((trim(orbit.x), trim(orbit.v))))
}

/// A solution on its way.
struct PolynomialOrbit {
    x: Coefficients,
    v: Coefficients,
}

impl KickDrift<u64> for PolynomialOrbit {
    fn drift(&mut self, ticks: u64) {
        add_multiple(&mut self.x, FIELD.of(ticks), &self.v);
    }

    fn kick(&mut self, mass: &u64) {
        let raised: Coefficients = std::iter::once(0).chain(self.x.iter().copied()).collect();
        add_multiple(&mut self.v, FIELD.sub(0, *mass), &raised);
    }
}

/// Whether both edges of every tongue of the given parity of m are proven different, for ρ > 0.
///
/// `degrees` are the numbers of positive zeros of (B, C) for even m, of (A, D) for odd m.
pub fn all_open(ratio: Ratio, rho: &Rational, odd: bool, degrees: [usize; 2]) -> Result<bool> {
    debug_assert!(!rho.is_zero());
    let (Some(even_start), Some(odd_start)) = (ends(ratio, rho, true)?, ends(ratio, rho, false)?) else {
        return Ok(false);
    };
    let (first, second) = if odd { (even_start.0, odd_start.1) } else { (odd_start.0, even_start.1) };
    // C = κ times the polynomial of its positive zeros.
    let second = if odd { second } else { second.into_iter().skip(1).collect() };
    let survived = first.len() == degrees[0] + 1 && second.len() == degrees[1] + 1;
    Ok(survived && FIELD.gcd(first, second).len() == 1)
}
