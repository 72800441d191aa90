//! A part of a system with π by the rational coefficients of its stiffnesses.

use std::sync::Arc;

use nalgebra::DMatrix;
use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};

use super::moments;
use crate::error::Result;
use crate::number::rational::scale2;
use crate::number::{Ball, Laurent, PiInteger, Rational, Real};
use crate::system::ManyClocks;
use crate::system::compose::{Kick, Program, half_period_of};
use crate::system::exact::MuCount;
use crate::system::frame::Frame;
use crate::system::integers::{IntegerBlocks, IntegerProgram};
use crate::system::limits::{Limits, degrees_of_freedom};
use crate::system::model::{Potential, System};
use crate::system::signs;
use crate::system::sparse::Symmetric;
use crate::verdict::Kind;

/// The factor π^power of a coefficient, and the potential that it is one of.
#[derive(Clone, Copy, Debug)]
pub(in crate::system) struct Term {
    pub potential: usize,
    pub power: i32,
}

/// Every entry at ϖ is within 2^-ACCURACY of itself of the entry at π.
const ACCURACY: u32 = 150;

/// The coefficients K_kj as potentials of their own, with the indices k and the powers j.
#[derive(Clone, Debug)]
pub(in crate::system) struct Coefficients {
    /// What its potentials have in common, every system with these coefficients has. Its clocks mean nothing.
    system: System,
    terms: Arc<[Term]>,
}

impl Coefficients {
    /// A term for each coefficient, in the order of the potentials.
    pub fn new(mass: Symmetric, coefficients: Vec<Potential>, terms: Vec<Term>) -> Result<Self> {
        Ok(Coefficients { system: System::new(mass, coefficients)?, terms: terms.into() })
    }

    /// Those of a part of the system.
    pub fn of_part(&self, system: System) -> Self {
        Coefficients { system, terms: self.terms.clone() }
    }

    /// The same with all steps times a positive factor.
    pub fn slowed(&self, factor: &Rational) -> Result<Self> {
        Ok(self.of_part(self.system.with(&Rational::one(), factor)?))
    }

    pub fn system(&self) -> &System {
        &self.system
    }

    /// The entry (i, j) of the stiffness that kicks at this step and phase.
    fn entry(&self, clock: &Potential, i: usize, j: usize) -> Laurent {
        self.all().filter(|(own, _)| own.step == clock.step && own.phase == clock.phase).fold(
            Laurent::zero(),
            |mut sum, (own, term)| {
                if let Some(x) = own.stiffness.row(i).get(&j) {
                    sum += Laurent::monomial(x.clone(), term.power);
                }
                sum
            },
        )
    }

    /// Each coefficient with its term.
    fn all(&self) -> impl Iterator<Item = (&Potential, &Term)> {
        self.system.potentials().iter().zip(&*self.terms)
    }

    /// The system at ϖ.
    ///
    /// # Errors
    /// As [`System::new`].
    pub fn near(&self) -> Result<System> {
        let mut bits = 2 * ACCURACY;
        loop {
            let pi = Ball::pi(bits).lower();
            let mut potentials: Vec<Potential> = Vec::new();
            let mut last = None;
            for (own, term) in self.all() {
                let stiffness = own.stiffness.scaled(&pi.pow(term.power));
                match potentials.last_mut().filter(|_| last == Some(term.potential)) {
                    Some(sum) => sum.stiffness.add_all(&stiffness),
                    None => potentials.push(Potential { stiffness, ..own.clone() }),
                }
                last = Some(term.potential);
            }
            let near = System::new(self.system.mass().clone(), potentials)?;
            if self.is_near(&pi) {
                return Ok(near);
            }
            bits *= 2;
        }
    }

    /// Whether no entry that is not 0 is farther from the true one than allowed.
    fn is_near(&self, pi: &Rational) -> bool {
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
        let row_is_near =
            |own: &Potential, i: usize| own.stiffness.row(i).keys().all(|&j| is_near(&self.entry(own, i, j)));
        self.all().all(|(own, _)| (0..self.system.size()).all(|i| row_is_near(own, i)))
    }

    /// K clocks on one oscillator, where there is one degree of freedom: those of `near`.
    pub fn as_many_clocks(&self, near: &System) -> ManyClocks<Laurent> {
        let first = &near.clocks()[0].step;
        let steps: Vec<_> = near.clocks().iter().map(|clock| &clock.step / first).collect();
        let phases: Vec<_> = near.clocks().iter().map(|clock| clock.phase.clone()).collect();
        let strength = |clock: &Potential| {
            let unit = first * &clock.step / near.mass().get(0, 0);
            &self.entry(clock, 0, 0) * &Laurent::from_rational(unit)
        };
        let strengths = near.clocks().iter().map(strength).collect();
        ManyClocks::new(&steps, &phases, strengths).expect("the clocks of a checked system")
    }

    /// The same without its rigid modes.
    fn vibrating(&self, frame: &Frame) -> Coefficients {
        if frame.rigid.is_empty() {
            return self.clone();
        }
        self.of_part(self.system.restricted(&frame.complement(&self.system)))
    }

    /// The half period in ℤ\[π\]; `near` is the system at ϖ.
    fn half_period(&self, near: &System) -> IntegerBlocks<PiInteger> {
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
    pub fn decide_by_signs(&self, frame: &Frame, limits: &Limits) -> Result<Option<Kind>> {
        let vibrating = self.vibrating(frame);
        let near = vibrating.near()?;
        // Four eliminations of n³/3 products, of numbers that grow to n times the length of twice the entries'.
        vibrating.allow(&near, 2.0 * (near.size() as f64).powi(5), limits)?;
        Ok(signs::judge(&mut vibrating.half_period(&near)))
    }

    /// The exact verdict, and where the eigenvalues μ lie.
    ///
    /// # Errors
    /// A budget error with the estimated cost, before any work.
    pub fn decide_exact(&self, frame: &Frame, limits: &Limits) -> Result<(Kind, MuCount)> {
        let vibrating = self.vibrating(frame);
        let near = vibrating.near()?;
        // Of power sums up to the (2n + 1)-th, two more factors n in length and degree. The 10 was 4 to 16 on chains of 3 to 6.
        vibrating.allow(&near, 10.0 * (near.size() as f64).powi(7), limits)?;
        Ok(moments::judge(&vibrating.half_period(&near)))
    }

    /// That exact arithmetic over ℚ\[π\] may begin; its cost is `factor` times the square of the degree and of the words of the half
    /// period's entries, which both grow with each kick.
    fn allow(&self, near: &System, factor: f64, limits: &Limits) -> Result<()> {
        let highest = |clock: &Potential| {
            let own = self.all().filter(|(own, _)| own.step == clock.step && own.phase == clock.phase);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::ExactSign;
    use crate::number::parse::parse;
    use crate::number::rational::ratio;
    use crate::system::decide::severity;
    use crate::system::decide_exact;
    use crate::system::numbers::Numbers;

    /// Stiffnesses of unit masses by steps: entries by powers of π.
    fn coefficients(potentials: &[(i64, DMatrix<Laurent>)]) -> Coefficients {
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
        Coefficients::new(Symmetric::diagonal(&vec![ratio(1, 1); n]), own, terms).unwrap()
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
    fn turned(numbers: &mut Numbers) -> (Coefficients, Vec<Kind>) {
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
            // The same with the rational ϖ in the place of π, over characteristic polynomials: what vanishes at π does there, too. (A
            // mode at rest is set apart there.)
            let near = own.near().unwrap();
            if near.rigid_modes().is_empty() {
                let exact = decide_exact(&near, &limits).unwrap();
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
            let near = own.near().unwrap();
            let exact = decide_exact(&near, &limits).unwrap();
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
        let near = own.near().unwrap().clocks()[0].stiffness.get(0, 1);
        let difference = Laurent::from_rational(near) - x.clone();
        let scaled = &difference * &Laurent::from_rational(Rational::from_integer(BigInt::one() << ACCURACY));
        // |near − x| 2^150 < |x|, and x > 0.
        assert!((&x - &scaled).sign().to_i8() * x.sign().to_i8() > 0);
        assert!((&x + &scaled).sign().to_i8() * x.sign().to_i8() > 0);
    }
}
