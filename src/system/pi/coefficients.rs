//! A part of a system with π by the rational coefficients of its stiffnesses.

use std::borrow::Cow;
use std::sync::Arc;

use nalgebra::DMatrix;
use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};

use super::moments;
use crate::error::Result;
use crate::number::rational::scale2;
use crate::number::{Ball, Laurent, PiInteger, Rational, Real};
use crate::system::ManyClocks;
use crate::system::exact::decide::MuCount;
use crate::system::exact::integers::{IntegerBlocks, IntegerProgram};
use crate::system::half::compose::{Kick, Program, half_period_of};
use crate::system::linear::frame::Frame;
use crate::system::linear::system::{Potential, System};
use crate::system::signs;
use crate::system::single::decide::many_clocks;
use crate::system::verdict::limits::{Limits, degrees_of_freedom};
use crate::verdict::Kind;

/// The factor π^power of a coefficient, and the potential that it is one of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Term {
    pub potential: usize,
    pub power: i32,
}

/// Every entry at ϖ is within 2^-ACCURACY of itself of the entry at π.
const ACCURACY: u32 = 150;

/// A system with stiffnesses over ℚ\[π, 1/π\], rational masses and steps.
///
/// ```
/// use std::collections::BTreeMap;
/// use kickdrift::number::rational::ratio;
/// use kickdrift::system::{Limits, PiPotential, PiSystem, Route, Symmetric};
/// use kickdrift::verdict::Kind;
/// // Two unit masses, walls of stiffness π² and a spring of 7/10 between; velocity Verlet with the step 6/10.
/// let mut walls = Symmetric::zero(2);
/// (0..2).for_each(|i| walls.add_spring(i, None, &ratio(1, 1)));
/// let mut spring = Symmetric::zero(2);
/// spring.add_spring(0, Some(1), &ratio(7, 10));
/// let stiffness = BTreeMap::from([(2, walls), (0, spring)]);
/// let potential = PiPotential { stiffness, step: ratio(6, 10), phase: ratio(0, 1) };
/// let system = PiSystem::new(Symmetric::diagonal(&[ratio(1, 1), ratio(1, 1)]), vec![potential])?;
/// let analysis = system.decide(Route::Cheapest, &Limits::default())?;
/// // h² (π² + 7/5) = 4.06 > 4.
/// assert!(analysis.is_proof() && analysis.kind.unwrap() == Kind::Hyperbolic);
/// # Ok::<(), kickdrift::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct PiSystem {
    /// The coefficients K_kj as potentials of their own,
    system: System,
    /// with the indices k and the powers j.
    terms: Arc<[Term]>,
    near: System,
}

impl PiSystem {
    /// A term for each coefficient, in the order of the potentials.
    pub(super) fn of(system: System, terms: Arc<[Term]>) -> Result<Self> {
        let near = near(&system, &terms)?;
        Ok(PiSystem { system, terms, near })
    }

    /// A part of the system, with the same powers of π.
    pub(super) fn of_part(&self, system: System) -> Result<Self> {
        PiSystem::of(system, self.terms.clone())
    }

    /// This system with all steps times a positive factor.
    ///
    /// # Errors
    /// As [`System::new`].
    pub fn slowed(&self, factor: &Rational) -> Result<Self> {
        self.of_part(self.system.with(&Rational::one(), factor)?)
    }

    /// The coefficients as potentials of their own: what these have in common, every system with these coefficients has. The clocks mean
    /// nothing.
    pub(super) fn system(&self) -> &System {
        &self.system
    }

    /// The system with a rational in the place of π, so near that every entry is within 2^-150 of itself of the true one.
    pub fn near(&self) -> &System {
        &self.near
    }

    /// The entry (i, j) of the stiffness that kicks at this step and phase.
    fn entry(&self, clock: &Potential, i: usize, j: usize) -> Laurent {
        entry(&self.system, &self.terms, clock, i, j)
    }

    /// K clocks on one oscillator, where there is one degree of freedom: those of [`PiSystem::near`].
    pub(in crate::system) fn as_many_clocks(&self) -> ManyClocks<Laurent> {
        many_clocks(&self.near, |clock| self.entry(clock, 0, 0))
    }

    /// This system without its rigid modes.
    fn vibrating(&self, frame: &Frame) -> Result<Cow<'_, PiSystem>> {
        if frame.rigid.is_empty() {
            return Ok(Cow::Borrowed(self));
        }
        self.of_part(self.system.restricted(&frame.complement(&self.system))).map(Cow::Owned)
    }

    /// The half period in ℤ\[π\].
    fn half_period(&self) -> IntegerBlocks<PiInteger> {
        let near = &self.near;
        let mut program = Program::new(near).map(|x| Laurent::from_rational(x.clone()));
        for (clock, (kick, ticks)) in
            near.clocks().iter().zip(program.kicks.iter_mut().zip(near.schedule().clocks()))
        {
            let factor = near.tick() * near.tick() * Rational::from_integer(ticks.step().into());
            self.replace(kick, clock, &Laurent::from_rational(factor));
        }
        let h = half_period_of(&program, near);
        let (entries, multiple) = PiInteger::common(h.iter());
        let (n, h) = (near.size(), DMatrix::from_vec(h.nrows(), h.ncols(), entries));
        let block = |i: usize, j: usize| h.view((i * n, j * n), (n, n)).into_owned();
        let scale = &multiple * &multiple;
        IntegerBlocks { a: block(0, 0), b: block(0, 1), c: block(1, 0), d: block(1, 1), scale }
    }

    /// The true rows of a kick.
    fn replace(&self, kick: &mut Kick<Laurent>, clock: &Potential, factor: &Laurent) {
        for (i, row) in &mut kick.rows {
            for (j, x) in row {
                *x = &self.entry(clock, *i, *j) * factor;
            }
        }
    }

    /// The kind, where one of the half period's forms is definite.
    ///
    /// # Errors
    /// A budget error with the estimated cost, before any work.
    pub(in crate::system) fn decide_by_signs(&self, frame: &Frame, limits: &Limits) -> Result<Option<Kind>> {
        let vibrating = self.vibrating(frame)?;
        let n = vibrating.near.size() as f64;
        // Four eliminations of n³/3 products, of numbers that grow to n times the length of twice the entries'.
        vibrating.allow(2.0 * n.powi(5), limits)?;
        Ok(signs::judge(&mut vibrating.half_period()))
    }

    /// The exact verdict, and where the eigenvalues μ lie.
    ///
    /// # Errors
    /// A budget error with the estimated cost, before any work.
    pub(in crate::system) fn decide_exact(&self, frame: &Frame, limits: &Limits) -> Result<(Kind, MuCount)> {
        let vibrating = self.vibrating(frame)?;
        let n = vibrating.near.size() as f64;
        // Power sums up to the (2n + 1)-th, two more factors n in length and degree. The 10 was 4 to 16 on chains of 3 to 6.
        vibrating.allow(10.0 * n.powi(7), limits)?;
        Ok(moments::judge(&vibrating.half_period()))
    }

    /// That exact arithmetic over ℚ\[π\] may begin; its cost is `factor` times the square of the degree and of the words of the half
    /// period's entries, which both grow with each kick.
    fn allow(&self, factor: f64, limits: &Limits) -> Result<()> {
        let near = &self.near;
        let highest = |clock: &Potential| {
            let own = of_clock(&self.system, &self.terms, clock);
            own.map(|(_, term)| term.power.unsigned_abs()).max().unwrap_or(0)
        };
        let strikes = |k: usize| (near.strikes(k) / 2 + 1) as f64;
        let clocks = || near.clocks().iter().enumerate();
        let degree: f64 = clocks().map(|(k, clock)| strikes(k) * f64::from(highest(clock))).sum();
        let kicks: f64 = clocks().map(|(k, _)| strikes(k)).sum();
        let words = kicks * IntegerProgram::new(&self.system).bits() as f64 / 64.0 + 1.0;
        let cost = factor * (degree + 1.0).powi(2) * words.powi(2);
        limits.allow(cost.min(1e19) as u64, || {
            format!("exact arithmetic over Q[pi] on {}", degrees_of_freedom(near.size()))
        })
    }
}

/// The coefficients that kick at the step and the phase of a clock, each with its term.
fn of_clock<'a>(
    system: &'a System,
    terms: &'a [Term],
    clock: &'a Potential,
) -> impl Iterator<Item = (&'a Potential, &'a Term)> {
    let all = system.potentials().iter().zip(terms);
    all.filter(|(own, _)| own.step == clock.step && own.phase == clock.phase)
}

/// The entry (i, j) of the stiffness of a clock.
fn entry(system: &System, terms: &[Term], clock: &Potential, i: usize, j: usize) -> Laurent {
    let mut sum = Laurent::zero();
    for (own, term) in of_clock(system, terms, clock) {
        if let Some(x) = own.stiffness.row(i).get(&j) {
            sum += Laurent::monomial(x.clone(), term.power);
        }
    }
    sum
}

/// The system at ϖ.
fn near(system: &System, terms: &[Term]) -> Result<System> {
    let mut bits = 2 * ACCURACY;
    loop {
        let pi = Ball::pi(bits).lower();
        let mut potentials: Vec<Potential> = Vec::new();
        let mut last = None;
        for (own, term) in system.potentials().iter().zip(terms) {
            let stiffness = own.stiffness.scaled(&pi.pow(term.power));
            match potentials.last_mut().filter(|_| last == Some(term.potential)) {
                Some(sum) => sum.stiffness.add_all(&stiffness),
                None => potentials.push(Potential { stiffness, ..own.clone() }),
            }
            last = Some(term.potential);
        }
        let near = System::new(system.mass().clone(), potentials)?;
        if is_near(system, terms, &pi) {
            return Ok(near);
        }
        bits *= 2;
    }
}

/// Whether no entry that is not 0 is farther from the true one than allowed.
fn is_near(system: &System, terms: &[Term], pi: &Rational) -> bool {
    let most = scale2(&BigInt::one(), -i64::from(ACCURACY));
    let is_near = |exact: &Laurent| {
        if exact.as_monomial().is_some() || exact.is_zero() {
            return true;
        }
        // The ball is four times as tight.
        let truth = exact.enclosure(ACCURACY + 2).lower();
        let difference = exact.at(pi) / &truth - Rational::from_integer(1.into());
        difference.abs() < most
    };
    let places = |own: &Potential| own.stiffness.places().collect::<Vec<_>>();
    system
        .potentials()
        .iter()
        .all(|own| places(own).into_iter().all(|(i, j)| is_near(&entry(system, terms, own, i, j))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::ExactSign;
    use crate::number::parse::parse;
    use crate::number::rational::ratio;
    use crate::system::decide_exact;
    use crate::system::linear::sparse::Symmetric;
    use crate::system::numbers::Numbers;
    use crate::system::verdict::decide::severity;

    /// Stiffnesses of unit masses by steps: entries by powers of π.
    fn coefficients(potentials: &[(i64, DMatrix<Laurent>)]) -> PiSystem {
        let n = potentials[0].1.nrows();
        let (mut own, mut terms) = (Vec::new(), Vec::new());
        for (potential, (step, k)) in potentials.iter().enumerate() {
            for power in -1..=2 {
                let mut stiffness = Symmetric::zero(n);
                for i in 0..n {
                    for j in 0..=i {
                        let term = k[(i, j)].terms().iter().find(|(own, _)| *own == power);
                        term.into_iter().for_each(|(_, c)| stiffness.add(i, j, c));
                    }
                }
                own.push(Potential::new(stiffness, ratio(*step, 1)));
                terms.push(Term { potential, power });
            }
        }
        PiSystem::of(System::new(Symmetric::diagonal(&vec![ratio(1, 1); n]), own).unwrap(), terms.into())
            .unwrap()
    }

    /// Stiffnesses of the steps 1 and 2 whose half period is H = \[\[1 − (a + 2 b)/2, 1\], \[..\]\], D = 1 − a/2: on edges, at rest, inside and
    /// outside, with π and without.
    const OSCILLATORS: [[&str; 2]; 10] = [
        ["pi/2", "1 - pi/4"], // A = 0
        ["2", "pi/10"],       // D = 0
        ["2", "0"],           // A = D = 0
        ["0", "0"],           // C = 0
        ["2*pi", "-pi"],      // A = 1: stable or not by D
        ["1", "1/10"],
        ["pi/4", "1/pi"],
        ["3/pi", "pi^2"],
        ["pi^2", "1/7"],
        ["-1/pi", "pi/5"],
    ];

    /// The diagonal system of some oscillators, turned by (3, 4, 5) so that no entry shows it, and the oscillators' own kinds.
    fn turned(numbers: &mut Numbers) -> (PiSystem, Vec<Kind>) {
        let n = 2 + numbers.below(2) as usize;
        let mut chosen: Vec<_> = (0..n).map(|_| OSCILLATORS[numbers.below(10) as usize]).collect();
        // Where the slow clock does nothing the period is another.
        if chosen.iter().all(|own| own[1] == "0") {
            chosen[0] = ["1", "1/10"];
        }
        let x = |text: &str| parse("x", text).unwrap();
        let rational = |a: i64, b: i64| Laurent::from_rational(ratio(a, b));
        let turn = DMatrix::from_fn(n, n, |i, j| match (i, j) {
            (0, 0) | (1, 1) => rational(3, 5),
            (0, 1) => rational(4, 5),
            (1, 0) => rational(-4, 5),
            _ => rational(i64::from(i == j), 1),
        });
        let stiffness = |k: usize| {
            let diagonal =
                DMatrix::from_fn(n, n, |i, j| if i == j { x(chosen[i][k]) } else { Laurent::zero() });
            &turn * diagonal * turn.transpose()
        };
        let (steps, phases) = ([ratio(1, 1), ratio(2, 1)], [ratio(0, 1), ratio(0, 1)]);
        let kind = |own: &[&str; 2]| {
            let strengths = vec![x(own[0]), &x(own[1]) * &rational(2, 1)];
            ManyClocks::new(&steps, &phases, strengths).unwrap().half_signs().verdict().kind()
        };
        (coefficients(&[(1, stiffness(0)), (2, stiffness(1))]), chosen.iter().map(kind).collect())
    }

    #[test]
    fn turned_oscillators_are_what_each_is() {
        let (mut numbers, limits) = (Numbers(11), Limits::default());
        let mut seen = [0; 4];
        for _ in 0..200 {
            let (own, kinds) = turned(&mut numbers);
            let frame = Frame::whole(own.system().size());
            let truth = kinds.into_iter().max_by_key(severity).unwrap();
            let (kind, roots) = own.decide_exact(&frame, &limits).unwrap();
            assert_eq!(kind, truth, "{own:?}");
            assert_eq!(roots.complex, 0);
            seen[usize::from(severity(&kind))] += 1;
            // The rational ϖ in the place of π, over characteristic polynomials: a polynomial that vanishes at π vanishes there, too. (A mode at rest
            // is set apart there.)
            let near = own.near();
            if near.rigid_modes().is_empty() {
                let exact = decide_exact(near, &limits).unwrap();
                assert_eq!((exact.kind, exact.roots), (kind, roots));
            }
            if let Some(by_signs) = own.decide_by_signs(&frame, &limits).unwrap() {
                assert_eq!(by_signs, kind);
            }
        }
        assert!(seen.iter().all(|&count| count > 0), "{seen:?}");
    }

    #[test]
    fn coupled_systems_are_what_they_are_next_to_pi() {
        let (mut numbers, limits) = (Numbers(3), Limits::default());
        let (mut stable, mut complex) = (0, 0);
        for _ in 0..40 {
            let n = 2 + numbers.below(2) as usize;
            let mut stiffness = |size: i64| {
                let mut k = DMatrix::from_element(n, n, Laurent::zero());
                for i in 0..n {
                    for j in 0..=i {
                        let c = numbers.below(7) - 3 + 4 * i64::from(i == j);
                        let x = Laurent::monomial(ratio(c, size), numbers.below(4) as i32 - 1);
                        (k[(i, j)], k[(j, i)]) = (x.clone(), x);
                    }
                }
                k
            };
            let own = coefficients(&[(1, stiffness(30)), (2, stiffness(150)), (3, stiffness(400))]);
            let near = own.near();
            let exact = decide_exact(near, &limits).unwrap();
            let frame = Frame::whole(n);
            assert_eq!(own.decide_exact(&frame, &limits).unwrap(), (exact.kind, exact.roots));
            stable += usize::from(exact.kind == Kind::Elliptic);
            complex += exact.roots.complex;
        }
        assert!(stable > 5 && complex > 0, "{stable} {complex}");
    }

    #[test]
    fn an_entry_that_nearly_cancels_is_near() {
        // pi - 355/113 is −2.7e-7, and what is left of longer fractions less.
        let x = parse("x", "pi - 5419351/1725033").unwrap();
        let other = Laurent::from_integer(1);
        let k = DMatrix::from_row_slice(2, 2, &[other.clone(), x.clone(), x.clone(), other]);
        let own = coefficients(&[(1, k)]);
        let near = own.near().clocks()[0].stiffness.get(0, 1);
        let difference = Laurent::from_rational(near) - x.clone();
        let scaled = &difference * &Laurent::from_rational(Rational::from_integer(BigInt::one() << ACCURACY));
        // |near − x| 2^150 < |x|, and x > 0.
        assert!((&x - &scaled).sign().to_i8() * x.sign().to_i8() > 0);
        assert!((&x + &scaled).sign().to_i8() * x.sign().to_i8() > 0);
    }
}
