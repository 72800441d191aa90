//! AVI as the paper's Algorithm 1: a priority queue of kicks, a clock for every potential, a time for every
//! particle.
//!
//! Times are whole ticks, so two kicks coincide iff they do in exact arithmetic; floating-point queues get
//! ties wrong. Over an exact ring a linear simulation of one period is the propagator itself.
//!
//! ```
//! use kickdrift_systems::avi::{Clocks, Ends, Linear, Simulation, State};
//! use kickdrift_systems::number::rational::ratio;
//! use kickdrift_systems::clocks::propagator::{TwoClocks, full_period};
//! // The paper's oscillator with two springs, h2/h1 = 3/2, in exact arithmetic.
//! let springs = vec![Linear::tether(0, ratio(1, 1)), Linear::tether(0, ratio(1, 25))];
//! let clocks = Clocks::new(&[ratio(1, 1), ratio(3, 2)], &[ratio(0, 1), ratio(0, 1)]).unwrap();
//! let period = clocks.period();
//! let start = State::new(vec![ratio(1, 1)], vec![ratio(0, 1)]);
//! let mut simulation = Simulation::new(&[ratio(1, 1)], springs, clocks, start).unwrap();
//! assert_eq!(simulation.run(period, Ends::Symmetric), 3 + 2 + 2); // the kicks at both ends in halves
//! let q = full_period(&TwoClocks::with_rho("3/2".parse().unwrap(), ratio(1, 1), ratio(1, 25)));
//! assert_eq!((&simulation.state().x[0], &simulation.state().p[0]), (&q[(0, 0)], &q[(1, 0)]));
//! ```

mod force;
mod measure;
mod orbit;
mod simulation;

pub use clocks::schedule::Clocks;
pub use force::{Bond, Force, Form, Linear};
pub use measure::{Run, Sample, equilibrium, growth_rate, irreversibility, series};
pub use orbit::{Clocked, PeriodicOrbit};
pub use simulation::{Ends, Simulation, State, Ticks};
