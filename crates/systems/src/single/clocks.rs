//! K clocks on one oscillator: x'' + Σ L_k x = 0, exact in every ring whose signs are known.
//!
//! The half period decides as for two clocks: the four signs of H. The resonances are those of the paper's
//! eq. (10) with a term for each clock,
//!
//! ```text
//!     1/T½ = Σ a_k/h_k,        that is  m = Σ a_k N_k,   N_k = T/h_k the kicks of clock k in a period.
//! ```
//!
//! ```
//! use kickdrift_systems::number::rational::ratio;
//! use kickdrift_systems::ManyClocks;
//! use kickdrift_systems::clocks::verdict::Kind;
//! // Three levels, h = 1, 2, 6: strengths h_1 h_k L_k in the time unit h_1.
//! let (steps, phases) = ([ratio(1, 1), ratio(2, 1), ratio(6, 1)], [ratio(0, 1), ratio(0, 1), ratio(0, 1)]);
//! let clocks = ManyClocks::new(&steps, &phases, vec![ratio(19, 10), ratio(1, 5), ratio(1, 10)]).unwrap();
//! assert_eq!(clocks.half_signs().verdict().kind(), Kind::Hyperbolic);
//! assert_eq!(clocks.label(), Some(3)); // next to s = 2, where 6 θ = 3 π
//! ```

use nalgebra::Matrix2;
use num_traits::{One, Zero};

use clocks::propagator::{TwoClocks, apply_drift, apply_kick};
use clocks::schedule::{KickDrift, Kicks, Schedule};
use clocks::verdict::{HalfSigns, Kind};
use number::{Error, ExactSign, Ratio, Rational, Result, Ring, Sign};

/// K clocks on one oscillator, without dimension: the unit of time is h_1.
#[derive(Clone, Debug)]
pub struct ManyClocks<S> {
    steps: Vec<Rational>,
    phases: Vec<Rational>,
    strengths: Vec<S>,
    schedule: Schedule,
}

impl<S: Ring> ManyClocks<S> {
    /// The steps h_k/h_1, the phases (0 or 1/2) and the strengths h_1 h_k L_k.
    ///
    /// # Errors
    /// As [`Schedule::new`]; a phase that is neither 0 nor 1/2; strengths of another number than steps.
    pub fn new(steps: &[Rational], phases: &[Rational], strengths: Vec<S>) -> Result<Self> {
        let schedule = Schedule::new(steps, phases)?;
        if !schedule.is_palindrome() {
            return Err(Error::input("phase", format!("{phases:?}"), "phases must be 0 or 1/2"));
        }
        if strengths.len() != steps.len() {
            return Err(Error::input("strengths", strengths.len(), format!("give {}", steps.len())));
        }
        Ok(ManyClocks { steps: steps.to_vec(), phases: phases.to_vec(), strengths, schedule })
    }

    /// When which clock kicks.
    pub fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    /// The strengths h_1 h_k L_k.
    pub fn strengths(&self) -> &[S] {
        &self.strengths
    }

    /// N_k = T/h_k.
    pub fn strikes(&self) -> Vec<u64> {
        self.schedule.clocks().iter().map(|clock| self.schedule.period() / clock.step()).collect()
    }

    /// T in units of h_1.
    pub fn period(&self) -> Rational {
        Rational::new(self.schedule.period().into(), self.schedule.clocks()[0].step().into()) * &self.steps[0]
    }

    /// These clocks as one or two of phase 0, for the scalar kernels; `None` for any other.
    pub fn as_two_clocks(&self) -> Option<TwoClocks<S>> {
        if self.phases.iter().any(|phase| !phase.is_zero()) || !self.steps[0].is_one() {
            return None;
        }
        match self.strengths.as_slice() {
            [one] => Some(TwoClocks::new(Ratio::ONE, one.clone(), S::zero())),
            [fast, slow] => {
                let ratio = Ratio::try_from(&self.steps[1]).ok()?;
                Some(TwoClocks::new(ratio, fast.clone(), slow.clone()))
            }
            _ => None,
        }
    }

    /// H = \[\[A, B\], \[C, D\]\], in the unit of time h_1.
    pub fn half_period(&self) -> Matrix2<S> {
        self.lead(|_| ())
    }

    /// H, and `see` of the position of the even solution at every kick time on the way.
    fn lead(&self, see: impl FnMut(&S)) -> Matrix2<S> {
        let one_half = S::from_rational(&Rational::new(1.into(), 2.into()));
        let kicks = Kicks::of_clocks(self.strengths.clone(), |k| [k.clone(), k * one_half.clone()]);
        let m = Matrix2::new(S::one(), S::zero(), S::zero(), S::one());
        let mut product = Product { m, tick: self.schedule.tick(), see };
        kicks.lead(self.schedule.half_period(), &mut product);
        product.m
    }

    /// Tr Q = 2 (AD + BC).
    pub fn trace(&self) -> S {
        let m = self.half_period();
        let mut sum = S::product(&m[(0, 0)], &m[(1, 1)]);
        sum.add_product(&m[(0, 1)], &m[(1, 0)]);
        sum.clone() + sum
    }
}

impl<S: ExactSign> ManyClocks<S> {
    /// The signs of A, B, C, D, exactly; they are the verdict.
    pub fn half_signs(&self) -> HalfSigns {
        signs(&self.half_period())
    }

    /// m, the half turns of the growing solution in one period; `None` unless hyperbolic.
    ///
    /// The sign changes n of the even solution over the half period (x is straight between kicks) give it:
    /// m = 2n where Tr > 2; where Tr < −2, m = 2n ± 1, + if x and v differ in sign at T/2, that is if it is
    /// past its n-th zero by less than a quarter turn.
    pub fn label(&self) -> Option<u64> {
        let (mut nodes, mut last) = (0, Sign::Positive);
        let m = self.lead(|x| {
            let sign = x.sign();
            if sign != Sign::Zero && sign != last {
                (nodes, last) = (nodes + 1, sign);
            }
        });
        let verdict = signs(&m).verdict();
        let (a, c) = signs(&m).even();
        match (verdict.kind(), verdict.side()) {
            (Kind::Hyperbolic, 1) => Some(2 * nodes),
            (Kind::Hyperbolic, _) if a * c == Sign::Negative => Some(2 * nodes + 1),
            (Kind::Hyperbolic, _) => (2 * nodes).checked_sub(1),
            _ => None,
        }
    }
}

/// The product so far.
struct Product<'a, S, F> {
    m: Matrix2<S>,
    tick: &'a Rational,
    see: F,
}

impl<S: Ring, F: FnMut(&S)> KickDrift<S> for Product<'_, S, F> {
    fn drift(&mut self, ticks: u64) {
        let time = self.tick * Rational::from_integer(ticks.into());
        apply_drift(&mut self.m, &S::from_rational(&time));
    }

    fn arrive(&mut self) {
        (self.see)(&self.m[(0, 0)]);
    }

    fn kick(&mut self, strength: &S) {
        apply_kick(&mut self.m, strength);
    }
}

fn signs<S: ExactSign>(m: &Matrix2<S>) -> HalfSigns {
    HalfSigns::new(m[(0, 0)].sign(), m[(0, 1)].sign(), m[(1, 0)].sign(), m[(1, 1)].sign())
}

/// All families of the resonance m: the integers a_k, |a_k| ≤ `bound`, with m = Σ a_k N_k.
pub fn families(m: i64, strikes: &[u64], bound: i64) -> Vec<Vec<i64>> {
    let Some((&last, others)) = strikes.split_last() else { return Vec::new() };
    if others.is_empty() {
        let a = m / last as i64;
        return if a * last as i64 == m && a.abs() <= bound { vec![vec![a]] } else { Vec::new() };
    }
    let with = |a: i64| {
        let rest = families(m - a * last as i64, others, bound);
        rest.into_iter().map(move |mut family| {
            family.push(a);
            family
        })
    };
    (-bound..=bound).flat_map(with).collect()
}

/// The shortest families of the resonance m by Σ |a_k|, at most `count`: with |a_k| a little beyond those of
/// the shortest, and for many clocks that one alone.
pub fn shortest_families(m: i64, strikes: &[u64], count: usize) -> Vec<Vec<i64>> {
    let Some(shortest) = shortest_family(m, strikes) else { return Vec::new() };
    let bound = shortest.iter().map(|a| a.abs()).max().unwrap_or(0) + 3;
    // All but one a_k are tried; the last one follows.
    let trials = (2 * bound + 1).checked_pow(strikes.len().saturating_sub(1) as u32);
    if trials.is_none_or(|trials| trials > MAX_SUMS) {
        return vec![shortest];
    }
    let length = |family: &Vec<i64>| family.iter().map(|a| a.abs()).sum::<i64>();
    let mut all = families(m, strikes, bound);
    all.sort_by_key(length);
    all.truncate(count);
    all
}

/// The most sums that the search for a shortest family visits.
const MAX_SUMS: i64 = 4_000_000;

/// A family of least Σ |a_k|; `None` where m is no integer combination of the N_k, or beyond some millions.
pub fn shortest_family(m: i64, strikes: &[u64]) -> Option<Vec<i64>> {
    let sign = if m < 0 { -1 } else { 1 };
    let m = m.abs();
    let largest = i64::try_from(*strikes.iter().max()?).ok()?;
    let (lowest, size) = (-largest, m.checked_add(2 * largest)? + 1);
    if size > MAX_SUMS {
        return None;
    }
    // Breadth first over the sums in [−N, m + N]: the terms of any family can be ordered to stay there.
    let mut steps = vec![0i8; size as usize];
    let at = |sum: i64| (sum - lowest) as usize;
    let mut queue = std::collections::VecDeque::from([0]);
    steps[at(0)] = i8::MAX;
    while let Some(sum) = queue.pop_front() {
        if sum == m {
            break;
        }
        for (k, &n) in strikes.iter().enumerate() {
            for (direction, next) in [(1i8, sum + n as i64), (-1, sum - n as i64)] {
                if next >= lowest && next <= m + largest && steps[at(next)] == 0 {
                    steps[at(next)] = direction * (k as i8 + 1);
                    queue.push_back(next);
                }
            }
        }
    }
    let (mut family, mut sum) = (vec![0; strikes.len()], m);
    while sum != 0 {
        let step = steps[at(sum)];
        let k = usize::from(step.unsigned_abs()).checked_sub(1)?;
        let direction = i64::from(step.signum());
        family[k] += sign * direction;
        sum -= direction * strikes[k] as i64;
    }
    Some(family)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shortest_family_is_among_all_and_none_is_shorter() {
        for strikes in [vec![7, 2], vec![12, 5, 3], vec![6, 10, 15, 1], vec![1]] {
            for m in -20..20 {
                let shortest = shortest_family(m, &strikes).expect("coprime");
                let length = |family: &Vec<i64>| family.iter().map(|a| a.abs()).sum::<i64>();
                let sum: i64 = shortest.iter().zip(&strikes).map(|(a, &n)| a * n as i64).sum();
                assert_eq!(sum, m);
                let all = families(m, &strikes, 6);
                assert!(all.iter().all(|family| length(family) >= length(&shortest)), "{strikes:?} {m}");
            }
        }
        assert_eq!(shortest_family(3, &[4, 6]), None);
    }
}
