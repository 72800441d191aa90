//! Stiffnesses of several degrees of freedom that involve π, decided at a rational ϖ in its place.
//!
//! Every entry at ϖ is within 2^-150 of itself of the true one, and the bounds' constants leave a hundredth
//! of u = 2^-53 for what is of second order: what doubles prove at ϖ they prove of all stiffnesses that near,
//! the true ones among them. Nothing else is asked at ϖ: exact arithmetic there would decide ties that the
//! true stiffnesses need not have, and a part is not split along vectors that are invariant there.

use std::collections::BTreeMap;

use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};

use crate::linear::sparse::Symmetric;
use crate::linear::system::{Potential, System};
use crate::model::Model;
use crate::verdict::analysis::Analysis;
use crate::verdict::decide::decide_around;
use crate::verdict::limits::{Limits, Route};
use number::rational::scale2;
use number::{Ball, Error, Laurent, Rational, Real, Result};

/// The highest power of π, and of 1/π: numbers at ϖ grow with it.
const HIGHEST: u32 = 64;

/// Every entry at ϖ is within 2^-ACCURACY of itself of the entry at π.
const ACCURACY: u32 = 150;

/// One potential xᵀ K x/2 with K over ℚ\[π, 1/π\], its force applied as kicks at the times (n + phase) step.
#[derive(Clone, Debug)]
pub struct PiPotential {
    /// The number of degrees of freedom.
    pub size: usize,
    /// The entries (i, j) of K, i ≥ j, force/length.
    pub stiffness: BTreeMap<(usize, usize), Laurent>,
    /// The time between two kicks, positive.
    pub step: Rational,
    /// 0 or 1/2.
    pub phase: Rational,
}

/// The system with a rational in the place of π.
#[derive(Clone, Debug)]
pub struct BesidePi(System);

/// Several degrees of freedom with π in the stiffnesses, by the rational system beside it.
impl Model for BesidePi {
    fn system(&self) -> &System {
        &self.0
    }

    fn is_exact(&self) -> bool {
        false
    }

    fn refused(&self, what: &str) -> Error {
        let remedy =
            format!("{what} on several degrees of freedom needs rational numbers: write them without pi");
        Error::input("stiffness", "with pi", remedy)
    }

    fn no_intervals(&self) -> Option<(&'static str, &'static str)> {
        Some((
            "with pi in the stiffnesses of several degrees of freedom",
            "are for rational numbers: write them without pi, or decide steps one by one, as --scan outer=LO..HI:BY does",
        ))
    }

    fn decide(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        match route {
            Route::Exact => Err(self.refused("exact arithmetic")),
            Route::Cheapest => decide_around(&self.0, limits),
        }
    }

    fn decide_at(&self, outer: &Rational, limits: &Limits) -> Result<Analysis> {
        decide_around(&self.0.with(&Rational::one(), &(outer / self.outer_step()))?, limits)
    }
}

/// The system with a rational in the place of π.
///
/// ```
/// use std::collections::BTreeMap;
/// use kickdrift_systems::number::{Laurent, parse::parse, rational::ratio};
/// use kickdrift_systems::{Limits, Model, PiPotential, Route, Symmetric, beside_pi};
/// use kickdrift_systems::clocks::verdict::Kind;
/// // Two unit masses, walls of stiffness π² and a spring of 7/10 between; velocity Verlet with the step 6/10.
/// let [diagonal, other] = ["pi^2 + 7/10", "-7/10"].map(|text| parse("stiffness", text).unwrap());
/// let stiffness = BTreeMap::from([((0, 0), diagonal.clone()), ((1, 0), other), ((1, 1), diagonal)]);
/// let potential = PiPotential { size: 2, stiffness, step: ratio(6, 10), phase: ratio(0, 1) };
/// let system = beside_pi(Symmetric::diagonal(&[ratio(1, 1), ratio(1, 1)]), &[potential])?;
/// let analysis = system.decide(Route::Cheapest, &Limits::default())?;
/// // h² (π² + 7/5) = 4.06 > 4.
/// assert!(analysis.is_proof() && analysis.kind.unwrap() == Kind::Hyperbolic);
/// # Ok::<(), kickdrift_systems::number::error::Error>(())
/// ```
///
/// # Errors
/// As [`System::new`]; a power of π beyond ±64; a common null vector of all potentials at ϖ that none is of
/// the true ones.
pub fn beside_pi(mass: Symmetric, potentials: &[PiPotential]) -> Result<BesidePi> {
    for (k, pi_potential) in potentials.iter().enumerate() {
        let powers = pi_potential.stiffness.values().flat_map(|x| x.terms()).map(|(power, _)| *power);
        if let Some(power) = powers.into_iter().find(|power| power.unsigned_abs() > HIGHEST) {
            let remedy = format!("powers of pi may be -{HIGHEST} to {HIGHEST}: choose other units");
            return Err(Error::input(&format!("potentials[{k}].stiffness"), format!("pi^{power}"), remedy));
        }
    }
    let clocks = clocks(potentials);
    let mut bits = 2 * ACCURACY;
    let mut pi = Ball::pi(bits).lower();
    while !clocks.iter().flat_map(BTreeMap::values).all(|entry| is_near(entry, &pi)) {
        bits *= 2;
        pi = Ball::pi(bits).lower();
    }
    let at = |pi_potential: &PiPotential| {
        let mut stiffness = Symmetric::zero(pi_potential.size);
        pi_potential.stiffness.iter().for_each(|(&(i, j), x)| stiffness.add(i, j, &x.at(&pi)));
        Potential { stiffness, step: pi_potential.step.clone(), phase: pi_potential.phase.clone() }
    };
    let system = System::new(mass, potentials.iter().map(at).collect())?;
    // π is transcendental: of a rational vector all is known.
    let is_rigid = |v: &[Rational]| potentials.iter().all(|potential| vanishes(&potential.stiffness, v));
    if !system.rigid_modes().iter().all(|(_, v)| is_rigid(v)) {
        let remedy = "choose coordinates in which the vector that no potential sees is rational";
        return Err(Error::input("stiffness", "all potentials have a null vector that involves pi", remedy));
    }
    Ok(BesidePi(system))
}

type Entries = BTreeMap<(usize, usize), Laurent>;

/// What kicks at one step and phase together.
fn clocks(potentials: &[PiPotential]) -> Vec<Entries> {
    let mut clocks: BTreeMap<(&Rational, &Rational), Entries> = BTreeMap::new();
    for potential in potentials {
        let clock = clocks.entry((&potential.step, &potential.phase)).or_default();
        for (&at, x) in &potential.stiffness {
            *clock.entry(at).or_insert_with(Laurent::zero) += x.clone();
        }
    }
    clocks.into_values().collect()
}

/// Whether an entry at ϖ is as near to the true one as is allowed.
fn is_near(exact: &Laurent, pi: &Rational) -> bool {
    if exact.is_zero() {
        return true;
    }
    // The ball is four times as tight.
    let truth = exact.enclosure(ACCURACY + 2).lower();
    let difference = exact.at(pi) / &truth - Rational::one();
    difference.abs() < scale2(&BigInt::one(), -i64::from(ACCURACY))
}

/// Whether K v = 0.
fn vanishes(entries: &Entries, v: &[Rational]) -> bool {
    let mut force = vec![Laurent::zero(); v.len()];
    for (&(i, j), x) in entries {
        force[i] += x * &Laurent::from_rational(v[j].clone());
        if i != j {
            force[j] += x * &Laurent::from_rational(v[i].clone());
        }
    }
    force.iter().all(Laurent::is_zero)
}
