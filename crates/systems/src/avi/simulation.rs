//! Algorithm 1: kicks in the order of time, every particle with a clock of its own.
//!
//! Repeat: take the potential that kicks next, at time t; drift each of its particles from that particle's
//! own time to t; kick them with the force of the potential there, over its step; schedule the potential
//! again.

use super::force::Force;
use clocks::schedule::{Clock, Clocks, Queue};
use number::{Error, Rational, Result, Ring, named};

/// A ring in which a number of ticks is quickly made.
pub trait Ticks: Ring {
    /// The integer n (in doubles the nearest one).
    fn ticks(n: u64) -> Self;
}

impl Ticks for f64 {
    fn ticks(n: u64) -> f64 {
        n as f64
    }
}

impl Ticks for Rational {
    fn ticks(n: u64) -> Rational {
        Rational::from_integer(n.into())
    }
}

named! {
    /// How the kicks at the two ends of a run are taken.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Ends {
        /// Algorithm 1 as it stands: whole kicks at the start, none at the end.
        Staggered = "staggered",
        /// Time-symmetric: half of each kick at the start and at the end.
        Symmetric = "symmetric",
    }
}

/// Particles of one degree of freedom each, potentials with clocks, and the state.
pub struct Simulation<S, F> {
    forces: Vec<F>,
    clocks: Clocks,
    inverse_masses: Vec<S>,
    /// The length of a tick over m_i.
    ticks: Vec<S>,
    /// h_k and h_k/2.
    steps: Vec<[S; 2]>,
    state: State<S>,
    queue: Queue,
    /// The time of the state, in ticks.
    now: u64,
    scratch: (Vec<S>, Vec<S>),
}

/// Positions and momenta, each particle at a time of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct State<S> {
    /// Positions.
    pub x: Vec<S>,
    /// Momenta.
    pub p: Vec<S>,
    /// The times of the positions, in ticks.
    at: Vec<u64>,
}

impl<S> State<S> {
    /// A state at t = 0.
    pub fn new(x: Vec<S>, p: Vec<S>) -> Self {
        let at = vec![0; x.len()];
        State { x, p, at }
    }
}

impl<S: Ticks, F: Force<S>> Simulation<S, F> {
    /// At t = 0, before the kicks that stand there.
    ///
    /// # Errors
    /// Names what does not fit: numbers of masses, positions and momenta, of potentials and clocks, a
    /// particle that is not there; a mass of 0.
    pub fn new(masses: &[Rational], forces: Vec<F>, clocks: Clocks, state: State<S>) -> Result<Self> {
        let n = masses.len();
        check(masses, &forces, &clocks, &state)?;
        let step = |clock: &Clock| {
            let step = clocks.tick() * Rational::from_integer(clock.step().into());
            [S::from_rational(&step), S::from_rational(&(step / Rational::from_integer(2.into())))]
        };
        Ok(Simulation {
            inverse_masses: masses.iter().map(|m| S::from_rational(&m.recip())).collect(),
            ticks: masses.iter().map(|m| S::from_rational(&(clocks.tick() / m))).collect(),
            steps: clocks.all().iter().map(step).collect(),
            queue: Queue::new(clocks.all()),
            scratch: (vec![S::zero(); n], vec![S::zero(); n]),
            forces,
            clocks,
            state,
            now: 0,
        })
    }

    /// Runs for `ticks` more, kicks at the ends as `ends` says; afterwards all particles are at the same
    /// time. Returns the number of kicks.
    pub fn run(&mut self, ticks: u64, ends: Ends) -> u64 {
        let (start, end) = (self.now, self.now + ticks);
        if ends == Ends::Staggered {
            let kicks = self.events(end, false);
            self.finish(end);
            return kicks;
        }
        // The kicks at `start` stand first in the queue; those at `end` are given in halves, and the other
        // halves belong to the next run, whose queue must hold them again.
        let mut kicks = 0;
        while let Some((time, potential)) = self.queue.pop_before(start, true) {
            self.kick(time, potential, 1);
            kicks += 1;
        }
        kicks += self.events(end, false);
        let again = self.queue.clone();
        while let Some((time, potential)) = self.queue.pop_before(end, true) {
            self.kick(time, potential, 1);
            kicks += 1;
        }
        self.queue = again;
        self.finish(end);
        kicks
    }

    /// All whole kicks before `end`.
    fn events(&mut self, end: u64, inclusive: bool) -> u64 {
        let mut kicks = 0;
        while let Some((time, potential)) = self.queue.pop_before(end, inclusive) {
            self.kick(time, potential, 0);
            kicks += 1;
        }
        kicks
    }

    fn finish(&mut self, end: u64) {
        (0..self.state.x.len()).for_each(|i| self.drift(i, end));
        self.now = end;
    }

    /// x_i ← x_i + (time − t_i) p_i/m_i, t_i ← time.
    fn drift(&mut self, i: usize, time: u64) {
        let ticks = time - self.state.at[i];
        if ticks > 0 {
            let factor = S::product(&S::ticks(ticks), &self.ticks[i]);
            let State { x, p, at } = &mut self.state;
            x[i].add_product(&factor, &p[i]);
            at[i] = time;
        }
    }

    /// Drifts the potential's particles to `time` and kicks them; `half` is 1 for half a kick.
    fn kick(&mut self, time: u64, potential: usize, half: usize) {
        for k in 0..self.forces[potential].particles().len() {
            self.drift(self.forces[potential].particles()[k], time);
        }
        let particles = self.forces[potential].particles();
        let (x, f) = (&mut self.scratch.0[..particles.len()], &mut self.scratch.1[..particles.len()]);
        particles.iter().zip(x.iter_mut()).for_each(|(&i, x)| *x = self.state.x[i].clone());
        self.forces[potential].force(x, f);
        let step = &self.steps[potential][half];
        particles.iter().zip(f.iter()).for_each(|(&i, f)| self.state.p[i].add_product(step, f));
    }

    /// The state; all particles are at the same time after [`Simulation::run`].
    pub fn state(&self) -> &State<S> {
        &self.state
    }

    /// The time in ticks.
    pub fn now(&self) -> u64 {
        self.now
    }

    /// The clocks.
    pub fn clocks(&self) -> &Clocks {
        &self.clocks
    }

    /// Replaces positions and momenta: a linear run that grows is scaled down now and then.
    ///
    /// # Panics
    /// Where the number of particles differs.
    pub fn set(&mut self, x: Vec<S>, p: Vec<S>) {
        assert_eq!((x.len(), p.len()), (self.state.x.len(), self.state.p.len()), "particles");
        (self.state.x, self.state.p) = (x, p);
    }

    /// The multiplications of a run of `ticks`, roughly: those of every force as a dense matrix on its
    /// particles, and what the queue and the drifts cost.
    pub fn cost(&self, ticks: u64) -> u64 {
        const OVERHEAD: u64 = 16;
        let kicks = self.clocks.all().iter().map(|clock| ticks / clock.step() + 1);
        let one = |force: &F| (force.particles().len() as u64).pow(2) + OVERHEAD;
        kicks
            .zip(&self.forces)
            .fold(0, |sum: u64, (n, force)| sum.saturating_add(n.saturating_mul(one(force))))
    }

    /// Turns all momenta round: a symmetric run of whole periods then leads back.
    pub fn reverse(&mut self) {
        self.state.p.iter_mut().for_each(|p| *p = -p.clone());
    }

    /// Σ p²/2m + Σ V.
    pub fn energy(&self) -> S {
        let half = S::from_rational(&Rational::new(1.into(), 2.into()));
        let mut energy = S::zero();
        for (p, w) in self.state.p.iter().zip(&self.inverse_masses) {
            energy.add_product(&S::product(&S::product(p, p), w), &half);
        }
        for force in &self.forces {
            let x: Vec<S> = force.particles().iter().map(|&i| self.state.x[i].clone()).collect();
            energy += force.energy(&x);
        }
        energy
    }

    /// Σ p.
    pub fn momentum(&self) -> S {
        self.state.p.iter().fold(S::zero(), |mut sum, p| {
            sum += p.clone();
            sum
        })
    }
}

fn check<S, F: Force<S>>(masses: &[Rational], forces: &[F], clocks: &Clocks, state: &State<S>) -> Result<()> {
    use num_traits::Signed;
    let n = masses.len();
    if let Some((i, mass)) = masses.iter().enumerate().find(|(_, m)| !m.is_positive()) {
        return Err(Error::input(&format!("masses[{i}]"), mass, "a mass must be positive"));
    }
    if state.x.len() != n || state.p.len() != n {
        let given = format!("{} positions, {} momenta", state.x.len(), state.p.len());
        return Err(Error::input("state", given, format!("give {n} of each")));
    }
    if forces.len() != clocks.all().len() {
        return Err(Error::input(
            "steps",
            clocks.all().len(),
            format!("give {}, one a potential", forces.len()),
        ));
    }
    for (k, force) in forces.iter().enumerate() {
        if let Some(i) = force.particles().iter().find(|&&i| i >= n) {
            return Err(Error::input(
                &format!("potentials[{k}]"),
                i,
                format!("particles are 0 to {}", n.max(1) - 1),
            ));
        }
    }
    Ok(())
}
