//! A linear system with a clock for each of its potentials.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use faer::Mat;
use num_traits::{One, Signed, Zero};

use crate::linear::sparse::{Symmetric, inertia_of_sum, is_sum_semidefinite, null_space};
use clocks::schedule::Schedule;
use number::{Error, Rational, Result};

/// One potential xᵀ K x/2, its force applied as kicks at the times (n + phase) step.
#[derive(Clone, Debug, PartialEq)]
pub struct Potential {
    /// K, symmetric, force/length.
    pub stiffness: Symmetric,
    /// The time between two kicks, positive.
    pub step: Rational,
    /// 0 or 1/2.
    pub phase: Rational,
}

impl Potential {
    /// The potential of the stiffness K, its first kick at t = 0.
    pub fn new(stiffness: Symmetric, step: Rational) -> Self {
        Potential { stiffness, step, phase: Rational::default() }
    }
}

/// M x'' + Σ K_k x = 0, each K_k kicking by its own clock.
///
/// ```
/// use kickdrift_systems::number::rational::ratio;
/// use kickdrift_systems::{Limits, Potential, Symmetric, System, decide_system};
/// use nalgebra::DMatrix;
/// let mass = Symmetric::diagonal(&[ratio(1, 1), ratio(2, 1)]);
/// let bond = Symmetric::try_from(&DMatrix::from_row_slice(2, 2, &[50.0, -50.0, -50.0, 50.0]))?;
/// let tether = Symmetric::try_from(&DMatrix::from_row_slice(2, 2, &[0.5, 0.0, 0.0, 0.0]))?;
/// let potentials = vec![Potential::new(bond, ratio(1, 10)), Potential::new(tether, ratio(3, 10))];
/// let analysis = decide_system(&System::new(mass, potentials)?, &Limits::default())?;
/// assert!(analysis.is_stable() && analysis.is_proof());
/// # Ok::<(), kickdrift_systems::number::error::Error>(())
/// ```
///
/// Potentials of equal step and phase share a clock, whose stiffness is their sum.
#[derive(Clone, Debug)]
pub struct System {
    mass: Symmetric,
    potentials: Vec<Potential>,
    clocks: Vec<Potential>,
    schedule: Schedule,
    tick: Rational,
    /// What holds a motion, where the potentials are effective ones: these may vanish at one step along what
    /// their own parts hold.
    holding: Option<Vec<Symmetric>>,
}

impl System {
    /// From a mass matrix and potentials of its size.
    ///
    /// # Errors
    /// Names the entry: a mass matrix that is not positive definite (a mass ≤ 0), a stiffness of another
    /// size, a step ≤ 0, a phase other than 0 and 1/2, a period of 2^62 ticks and more, nothing at all.
    pub fn new(mass: Symmetric, potentials: Vec<Potential>) -> Result<Self> {
        check_mass(&mass)?;
        for (k, potential) in potentials.iter().enumerate() {
            check_potential(k, potential, mass.size())?;
        }
        System::of_checked(mass, potentials)
    }

    /// From a mass matrix and potentials that were checked, at least one of these.
    fn of_checked(mass: Symmetric, potentials: Vec<Potential>) -> Result<Self> {
        let clocks = heard(merged(&potentials));
        System::on(clocks, mass, potentials)
    }

    fn on(clocks: Vec<Potential>, mass: Symmetric, potentials: Vec<Potential>) -> Result<Self> {
        let steps: Vec<_> = clocks.iter().map(|clock| clock.step.clone()).collect();
        let phases: Vec<_> = clocks.iter().map(|clock| clock.phase.clone()).collect();
        let schedule = Schedule::new(&steps, &phases)?;
        let tick = &steps[0] / Rational::from_integer(schedule.clocks()[0].step().into());
        Ok(System { mass, potentials, clocks, schedule, tick, holding: None })
    }

    /// Unit masses under clocks of these steps without stiffness, where only its size and its clocks are
    /// asked for.
    ///
    /// # Errors
    /// As [`System::new`].
    pub(crate) fn of_clocks(n: usize, steps: impl IntoIterator<Item = Rational>) -> Result<System> {
        let clock = |step| Potential::new(Symmetric::zero(n), step);
        System::new(Symmetric::diagonal(&vec![Rational::one(); n]), steps.into_iter().map(clock).collect())
    }

    /// This system, whose potentials are effective ones, with the stiffnesses that they come from: rigid is
    /// what none of these holds.
    #[must_use]
    pub(crate) fn held_by(self, plain: &System) -> System {
        System { holding: Some(plain.holding().cloned().collect()), ..self }
    }

    /// The stiffnesses whose common null vectors are the rigid motions.
    pub fn holding(&self) -> impl Iterator<Item = &Symmetric> {
        let potentials =
            self.potentials.iter().filter(|_| self.holding.is_none()).map(|potential| &potential.stiffness);
        self.holding.iter().flatten().chain(potentials)
    }

    /// The number of degrees of freedom.
    pub fn size(&self) -> usize {
        self.mass.size()
    }

    /// M.
    pub fn mass(&self) -> &Symmetric {
        &self.mass
    }

    /// The potentials as they were given.
    pub fn potentials(&self) -> &[Potential] {
        &self.potentials
    }

    /// The sums of the potentials that share a step and a phase, by increasing step; sums that vanish are
    /// left out, unless all do.
    pub fn clocks(&self) -> &[Potential] {
        &self.clocks
    }

    /// The steps of the potentials as they were given.
    pub fn steps(&self) -> Vec<Rational> {
        self.potentials.iter().map(|potential| potential.step.clone()).collect()
    }

    /// This system with all stiffnesses times a factor, and all steps times another one.
    ///
    /// # Errors
    /// As [`System::new`].
    pub fn with(&self, stiffer: &Rational, slower: &Rational) -> Result<System> {
        let changed = |potential: &Potential| Potential {
            stiffness: if stiffer.is_one() {
                potential.stiffness.clone()
            } else {
                potential.stiffness.scaled(stiffer)
            },
            step: &potential.step * slower,
            phase: potential.phase.clone(),
        };
        let (mass, potentials) = (self.mass.clone(), self.potentials.iter().map(changed).collect());
        if stiffer.is_zero() || !slower.is_positive() {
            return System::new(mass, potentials);
        }
        // Sums of equal clocks are multiples, too.
        let changed = System::on(self.clocks.iter().map(changed).collect(), mass, potentials)?;
        Ok(System { holding: self.holding.clone(), ..changed })
    }

    /// This system with every clock, also those whose sum vanishes: with friction a kick of strength 0 parts
    /// a drift in two.
    pub(crate) fn with_silent_clocks(&self) -> System {
        let (mass, potentials) = (self.mass.clone(), self.potentials.clone());
        let all = System::on(merged(&potentials), mass, potentials).expect("the clocks of a checked system");
        System { holding: self.holding.clone(), ..all }
    }

    /// When which clock kicks.
    pub fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    /// The unit of time of the schedule.
    pub fn tick(&self) -> &Rational {
        &self.tick
    }

    /// T, the synchronization period.
    pub fn period(&self) -> Rational {
        &self.tick * Rational::from_integer(self.schedule.period().into())
    }

    /// T/h_k, the kicks of clock k in a period.
    pub fn strikes(&self, clock: usize) -> u64 {
        self.schedule.period() / self.schedule.clocks()[clock].step()
    }

    /// Σ K_k.
    pub fn total_stiffness(&self) -> Symmetric {
        let mut total = Symmetric::zero(self.size());
        self.clocks.iter().for_each(|clock| total.add_all(&clock.stiffness));
        total
    }

    /// Whether Σ K_k has no negative eigenvalue, exactly.
    pub(crate) fn is_total_semidefinite(&self) -> bool {
        is_sum_semidefinite(&self.stiffnesses(), || self.total_stiffness())
    }

    /// Σ K_k, rounded.
    pub(crate) fn rounded_total(&self) -> Mat<f64> {
        let zero = Mat::zeros(self.size(), self.size());
        self.clocks.iter().fold(zero, |sum, clock| sum + clock.stiffness.rounded())
    }

    /// The stiffnesses of the clocks.
    pub fn stiffnesses(&self) -> Vec<&Symmetric> {
        self.clocks.iter().map(|clock| &clock.stiffness).collect()
    }

    /// The common null vectors of all potentials as they were given, which move freely: (coordinate where it
    /// alone is 1, vector) pairs. A direction in which potentials of one clock cancel is none of them: it
    /// drifts, but only as long as they cancel, and is called what it is, parabolic. Nor is one along which
    /// an effective stiffness vanishes at this step alone, as after a full turn.
    pub fn rigid_modes(&self) -> Vec<(usize, Vec<Rational>)> {
        // Common null vectors are null vectors of the sum.
        if inertia_of_sum(&self.stiffnesses()).unknown == 0 {
            return Vec::new();
        }
        let rows = self.holding().flat_map(Symmetric::pattern).filter(|row| !row.is_empty());
        null_space(rows.cloned().collect(), self.size())
    }

    /// The dynamics in the coordinates y, x = Z y, where the columns of Z span an invariant subspace.
    pub(crate) fn restricted(&self, columns: &[Vec<Rational>]) -> System {
        self.mapped(self.mass.congruent(columns), |k| k.congruent(columns))
    }

    /// The degrees of freedom in `indices` alone; `None` where no potential acts on them.
    pub(crate) fn component(&self, indices: &[usize]) -> Option<System> {
        let part = self.part(indices);
        let is_held = part.holding().any(|symmetric| !symmetric.is_zero());
        is_held.then_some(part)
    }

    /// The degrees of freedom in `indices` alone, which nothing couples to others.
    pub fn part(&self, indices: &[usize]) -> System {
        if indices.len() == self.size() {
            return self.clone();
        }
        self.mapped(self.mass.restricted(indices), |k| k.restricted(indices))
    }

    fn mapped(&self, mass: Symmetric, map: impl Fn(&Symmetric) -> Symmetric) -> System {
        let mapped =
            |potential: &Potential| Potential { stiffness: map(&potential.stiffness), ..potential.clone() };
        // A part of a schedule has no longer a period than the whole.
        let part = System::of_checked(mass, self.potentials.iter().map(mapped).collect())
            .expect("a part of a checked system");
        System { holding: self.holding.as_ref().map(|all| all.iter().map(&map).collect()), ..part }
    }
}

pub(crate) fn check_mass(mass: &Symmetric) -> Result<()> {
    if mass.size() == 0 {
        return Err(Error::input("masses", "none", "give at least one mass"));
    }
    for i in 0..mass.size() {
        if !mass.get(i, i).is_positive() {
            return Err(Error::input(&format!("masses[{i}]"), mass.get(i, i), "a mass must be positive"));
        }
    }
    if !mass.is_positive_definite() {
        return Err(Error::input("masses", "the mass matrix", "must be positive definite"));
    }
    Ok(())
}

pub(crate) fn check_potential(k: usize, potential: &Potential, n: usize) -> Result<()> {
    let field = |name: &str| format!("potentials[{k}].{name}");
    if potential.stiffness.size() != n {
        let size = potential.stiffness.size();
        let remedy = format!("there are {n} degrees of freedom: give {n} rows and columns");
        return Err(Error::input(&field("stiffness"), format!("{size} x {size}"), remedy));
    }
    if !potential.step.is_positive() {
        return Err(Error::input(&field("step"), &potential.step, "a step must be positive"));
    }
    let half = Rational::new(1.into(), 2.into());
    if !potential.phase.is_zero() && potential.phase != half {
        let remedy = "must be 0 or 1/2: other phases have no time reversal, so no half period decides them";
        return Err(Error::input(&field("phase"), &potential.phase, remedy));
    }
    Ok(())
}

/// One clock for each (step, phase), by increasing step.
fn merged(potentials: &[Potential]) -> Vec<Potential> {
    let mut clocks: BTreeMap<(&Rational, &Rational), Potential> = BTreeMap::new();
    for potential in potentials {
        match clocks.entry((&potential.step, &potential.phase)) {
            Entry::Vacant(place) => drop(place.insert(potential.clone())),
            Entry::Occupied(mut place) => place.get_mut().stiffness.add_all(&potential.stiffness),
        }
    }
    clocks.into_values().collect()
}

/// Those whose stiffness does not vanish; all if there are none.
fn heard(clocks: Vec<Potential>) -> Vec<Potential> {
    let (moving, still): (Vec<_>, Vec<_>) = clocks.into_iter().partition(|c| !c.stiffness.is_zero());
    if moving.is_empty() { still } else { moving }
}
