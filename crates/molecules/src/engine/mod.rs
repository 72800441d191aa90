//! The input of simulation engines about their time steps, read as the engines read it.
//!
//! | engine | notation | dt is | scheme |
//! |---|---|---|---|
//! | OpenMM | `MTSIntegrator(4*femtoseconds, [(0,1),(1,8)])`, its kind, and integrators of one step; serialized XML | the outermost step | recursive half kicks |
//! | LAMMPS | `timestep`, `run_style respa N factors` (the first factor is the innermost one), `units` | the outermost step | half kicks |
//! | GROMACS | `mts`, `mts-level2-factor`, `dt` in ps | the innermost step | leap-frog, slow forces times the factor: conjugate |
//! | NAMD | `timestep`, `nonbondedFreq`, `fullElectFrequency` | the innermost step | impulses; `MTSAlgorithm naive` is not symplectic |
//! | Tinker | `INTEGRATOR RESPA`, `RESPA-INNER`; the outer step is no part of the key file | – | half kicks |
//! | Tinker-HP | `INTEGRATOR RESPA` and `RESPA1`, `DSHORT` and `DINTER` in ps; the outer step likewise | – | half kicks |
//! | i-PI | `<timestep>`, `<nmts>`, level 0 the outermost | the outermost step | half kicks |
//!
//! A text is of an engine by words that this engine alone has (`evidence`); inputs of others are refused by
//! name (`others`). Logs of LAMMPS, NAMD and GROMACS are read as what the engine understood. Keys that do not
//! affect the steps are skipped; the reading lists those that were used, and remarks what bears on the answer
//! and was not read. A text is rewritten in place: only the numbers that change are touched, and written as
//! decimals, rounded down. A number that the engine wants to be a multiple of the changed one becomes a
//! multiple, and is written out where its default is not a multiple: at a factor of 6, GROMACS's energies of
//! every 100 steps are of every 102.
//!
//! ```
//! use kickdrift_molecules::engine::{Engine, read};
//! use kickdrift_molecules::number::rational::ratio;
//! let reading = read(&["dt = 0.0005 ; ps\nmts = yes\nmts-level2-factor = 8\n"], None)?;
//! assert_eq!(reading.engine, Engine::Gromacs);
//! assert_eq!(reading.scheme.steps(), [ratio(1, 2), ratio(4, 1)]); // fs
//! assert_eq!(reading.rewritten(&ratio(2, 1))?, "dt = 0.0005 ; ps\nmts = yes\nmts-level2-factor = 4\n");
//! # Ok::<(), kickdrift_molecules::number::error::Error>(())
//! ```

mod evidence;
mod gromacs;
mod groups;
mod ipi;
mod lammps;
mod lines;
mod molecules;
mod namd;
mod openmm;
mod others;
mod quantity;
mod read;
mod reading;
mod respa;
mod script;
mod serialized;
mod tinker;
mod xml;

pub use read::read;
pub use reading::{Engine, Reading, nested_beside, not_nested};
