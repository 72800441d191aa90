//! Two clocks that kick one oscillator: verdicts, unstable intervals, maps, and the predictions of resonance.
//!
//! x'' + (Λ1 + Λ2) x = 0 is kicked by Λ1 at the multiples of h1 and by Λ2 at those of h2, and drifts between:
//! velocity Verlet with one clock, r-RESPA with h2 = p h1, an asynchronous variational integrator with any
//! h2/h1 = p/q. The propagator over T = q h2 = p h1 decides: |Tr Q| < 2 is stable. Every verdict is certified
//! in doubles, certified in more bits, or decided exactly, in this order.
//!
//! | type | what it is |
//! |---|---|
//! | [`TwoClocks`] | the pair p/q with its two strengths, over any exact numbers |
//! | [`Verdict`] | stable, unstable, or the kind of edge; [`decide`] finds it |
//! | [`Tongues`] | every unstable interval of one ratio, in order and with its label |
//! | [`Map`] | the verdicts of a grid of steps |
//! | [`Families`] | the curves (a, b) of the Proposition, on which resonance is predicted |
//!
//! Rooms import downwards only: `schedule` (which clock kicks when), `propagator` (kick, drift, half period),
//! `orbit` (orbits followed with a proven bound), `verdict`, `resonance`, then side by side `tongue`, `map`
//! and `band`.
//!
//! ```
//! use kickdrift_clocks::number::rational::ratio;
//! use kickdrift_clocks::{Kind, Limits, Oscillator, Tongues, TwoClocks, decide, decide_steps};
//! // Stiffnesses and steps as people write them: just below h2 = T½ = 1, resonant.
//! let pair = Oscillator::builder().lambda1("pi^2").lambda2("pi^2/25").h1("1/100").h2("0.98").build()?;
//! assert!(!decide_steps(&pair, &Limits::default())?.verdict.is_stable());
//! // h2/h1 = 3/2, s = h1² Λ1 = 5/2, Λ2 = Λ1/25.
//! let clocks = TwoClocks::with_rho("3/2".parse()?, ratio(5, 2), ratio(1, 25));
//! let answer = decide(&clocks, &Limits::default())?;
//! assert_eq!(answer.verdict.kind(), Kind::Elliptic);
//! // p + q − 1 unstable intervals of s, one for each label m.
//! assert_eq!(Tongues::new("3/2".parse()?, &ratio(1, 25))?.all()?.len(), 4);
//! # Ok::<(), kickdrift_clocks::Error>(())
//! ```

pub mod band;
pub mod map;
mod orbit;
pub mod propagator;
pub mod resonance;
pub mod schedule;
pub mod tongue;
pub mod verdict;

pub use number;

// What everyone needs, without the way to it.
pub use map::{Grid, Map};
pub use number::error::{Error, Result};
pub use propagator::{HalfPeriod, Oscillator, TwoClocks, half_period};
pub use resonance::{Families, dominant_family};
pub use tongue::{Tongues, closings};
pub use verdict::{Kind, Limits, Side, Verdict, decide, decide_steps};
