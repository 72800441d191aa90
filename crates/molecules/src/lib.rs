//! Which steps are safe for these periods, for how long, and why.
//!
//! Periods or bonds on the clocks of a multiple-time-step integrator become one mass under several
//! potentials. What is answered is of three kinds, kept apart:
//!
//! * **proven** (linear): the verdict at each scheme of steps, the unstable intervals about it, and the first
//!   stable region with a band of periods: below its end no molecule whose periods are at least as long is
//!   unstable, however its modes are coupled (module `levels`, proofs/REGION.md);
//! * **published** (nonlinear): the outer one of several steps near T/3 and T/4, a clock's own step beyond
//!   T/6.28, with their source ([`published`]);
//! * **unknown**: whether the periods given are the fastest, how anharmonic they are, what another
//!   temperature does.
//!
//! A stable step *above* the first unstable interval is an island: periods move, intervals can be 0.006 fs
//! wide, so it is never recommended.
//!
//! | file | what |
//! |---|---|
//! | [`mod@unit`] | fs, 1/cm, amu, kcal/mol/A²: exactly |
//! | `mode` | periods, wavenumbers, bonds → stiffnesses |
//! | `levels` | one mass, K clocks: verdict, first stable region |
//! | `interval`, `edges` | unstable intervals of the outer step, on two clocks and on more |
//! | `lever`, `levers` | what would let the step grow: one change, and all of them |
//! | `direct` | forces that are no gradient: what the steps add to their own growth |
//! | `constraint` | bonds that do not vibrate |
//! | `molecule`, `finding` | Hessians in place of periods, and what is found of them |
//! | `names` | what the motions of molecules are called |
//! | `question`, `answer` | what is asked, what is answered |
//! | `caution`, `caps` | what is published, and the steps below it |
//! | `typical` | periods that are known by name |
//! | `beads` | ring polymers |
//! | [`mod@aperture`] | how hot a bond may be before the method throws it out, measured |
//! | [`engine`] | the input of simulation engines |
//!
//! ```
//! use kickdrift_molecules::{Mode, Question, Scheme, Status};
//! use kickdrift_molecules::number::rational::ratio;
//! let modes = vec![Mode::from_period("10fs")?, Mode::from_period("40fs")?];
//! let schemes = vec![Scheme::new(vec![ratio(1, 2), ratio(4, 1)])?, Scheme::new(vec![ratio(1, 2), ratio(5, 1)])?];
//! let advice = Question::new(modes, schemes, ratio(1, 20))?.answer()?;
//! let [four, five] = &advice.schemes[..] else { unreachable!() };
//! // 4 fs is stable, and stays so if all periods are 5 % shorter; 5 fs lies above an unstable interval.
//! assert_eq!((four.status, five.status), (Status::Caution, Status::Island));
//! let first = five.rows[0].first.as_ref().unwrap();
//! assert!(4.6875 < first.lower.0 && first.upper.unwrap().1 < 4.9795);
//! assert_eq!(four.safe, Some(ratio(3, 1))); // fs: below T/3 too
//! # Ok::<(), kickdrift_molecules::number::error::Error>(())
//! ```

mod answer;
pub mod aperture;
mod beads;
mod caps;
mod caution;
mod constraint;
mod direct;
mod edges;
pub mod engine;
mod finding;
mod interval;
mod levels;
mod lever;
mod levers;
mod mode;
mod molecule;
mod names;
mod question;
mod typical;
pub mod unit;

pub use clocks;
pub use number;
pub use systems;
pub use words;

pub use answer::{Advice, Answer, Biased, Pair, Row, Status, most_biased};
pub use beads::Beads;
pub use caps::{Bound, Caps, shortest_of};
pub use caution::{Caution, GROMPP, HEEDED, OF_MANY, OF_ONE, PRACTICE, Place, SEEN, published};
pub use constraint::Constraints;
pub use direct::{Adds, Direct, DirectFinding, DirectFindings, Rung, TIMES};
pub use finding::{Finding, Findings, Group, MostBiased};
pub use interval::{Unstable, Worst};
pub use levels::{Found, Levels, Scheme};
pub use lever::{Keyword, Lever, Way};
pub use levers::{Levers, RATIOS, SOLVED, heavy};
pub use mode::{Bond, Mode, Origin};
pub use molecule::{MOST_PRODUCTS, Molecule};
pub use names::{Names, Told};
pub use question::{Question, check_band, place};
pub use typical::{FAST, SLOW, Typical};
