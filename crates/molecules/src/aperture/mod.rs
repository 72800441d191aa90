//! The aperture of a bond: how hot it may be before the method throws it out.
//!
//! Linear theory lets velocity Verlet go to h ω = 2. A bond that is not harmonic does not: where the method
//! itself turns by a simple part of a full turn in each step, its cubic and quartic terms push in time with
//! it, as in the resonances of accelerators. The **aperture** E*(h) is the least energy, in kT, at which some
//! phase of a start leaves.
//!
//! * A start of energy E: x = √(2 E/k) cos f, v = √(2 E/μ) sin f, f = 2 π (j + ½)/48, k the curvature at
//!   rest. Where a thermostat acts within the word (a letter O), velocities are those that the method has
//!   with these lengths: middle schemes have thermal lengths, and slower velocities at their kicks.
//! * E rises by 1/16 kT up to 1 kT, then by 1/4 kT up to 40 kT ([`rungs`]).
//! * A bond is lost where |x| > 1 nm at a kick of its first 20,000 steps.
//!
//! **This is a measurement of the method on one bond in doubles, and no proof**: energies between the rungs,
//! other phases, longer runs, neighbours and thermostats are not in it.
//!
//! ```
//! use kickdrift_molecules::aperture::{Bond, Measurement};
//! use kickdrift_molecules::number::rational::ratio;
//! let bond = Bond::read("OH:morse:D=485.72kJ/mol,a=22.87/nm,15.999,1.008")?;
//! let measurement = Measurement::new(&bond, &ratio(298, 1), &"K(1/2) D(1) K(1/2)".parse()?, None)?;
//! let step = measurement.at(&ratio(39, 20))?;
//! assert_eq!(step.aperture, Some(0.5)); // kT: a bond at room temperature does not stay
//! # Ok::<(), kickdrift_molecules::number::error::Error>(())
//! ```

mod bond;
mod cold;
mod kernel;
mod map;
mod search;

pub use bond::{Bond, Shape};
pub use cold::{Cold, Edge, KINDS, Kind, band_of, hottest};
pub use kernel::{FAR, PHASES};
pub use map::{Map, Stage, squared_frequency};
pub use search::{
    EARLY, Hottest, LATE, Measurement, Resonance, Step, energies_seen, hottest_of, rungs, thermal,
};

use number::Rational;
use words::Word;

/// What was measured of a bond, and what it is held against.
pub struct Measured {
    pub bond: Bond,
    /// In K.
    pub temperature: Rational,
    pub word: Word,
    pub measurement: Measurement,
    pub resonances: Vec<Resonance>,
    /// By their length.
    pub steps: Vec<Step>,
    /// The steps that were asked for one by one, in fs; the others are those of a range.
    pub chosen: Vec<Rational>,
    /// The bonds of the system that is meant, and the length of its run in fs.
    pub meant: (u64, Rational),
    /// The logarithm of bonds times picoseconds: about the energy of the hottest of them, in kT.
    pub level: f64,
}

impl Measured {
    /// Whether a step is linearly stable, and E* not below the level, nor that of its band.
    pub fn is_enough(&self, step: &Step) -> bool {
        let least = step.band.as_ref().map_or(step.aperture, |hottest| hottest.aperture);
        step.turn.is_some() && least.is_none_or(|aperture| aperture >= self.level)
    }
}
