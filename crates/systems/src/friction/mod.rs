//! Friction: Ornstein and Uhlenbeck's step O in the middle of every drift, as BAOAB and its relatives do.
//!
//! Between two kick times a time t apart the state goes through D(t/2) O D(t/2), O: v → c v (+ noise), c =
//! exp(−γ t). The kick times are those of the whole schedule: a potential parts the drifts of what it does
//! not act on, too, and of strength 0 it still does (D(t/2) O D(t/2) twice is not the same over 2t). So what
//! moves apart from the rest is damped as if weakly coupled to it. With one level this is BAOAB, with r-RESPA
//! its multiple-time-step form (the innermost step a BAOAB one). Means and covariances of the chain stay
//! bounded iff the *spectral radius* ρ(Q) of the noiseless period is below 1. Friction is no longer
//! reversible, so the whole period decides, not its half. For one oscillator
//!
//! ```text
//!     det Q = exp(−γ T),     ρ(Q) < 1  iff  |Tr Q| < 1 + det Q   (Jury),
//! ```
//!
//! and a linear resonance is *masked* by every γ for which ρ(Q) < 1 although the frictionless period grows.
//! Larger frictions need not mask it, too: a strong one stops velocities in the middle of each drift, and
//! positions then follow products of 1 − t K/2, which may grow.
//!
//! | file | what |
//! |---|---|
//! | `matrices` | periods in doubles with a proven bound (two levels of measured stiffnesses: [`Kernel::friction`](crate::levels::Kernel::friction)) |
//! | `radius` | where the spectral radius of a matrix lies that is known within an error |
//! | `fixed` | the period at one friction in balls: one oscillator's, and where velocities all but stop |
//! | `masking` | the frictions that mask: looked for by values, proven range by range |
//! | `powers` | the period as a polynomial in c = exp(−γ t) |
//! | `polynomial` | all frictions of one oscillator at once: polynomials in c between two signs |
//! | `cells` | those of more degrees of freedom: forms that all periods of a cell of c shrink |
//! | `tie` | one oscillator whose spectral radius is 1 at every friction, exactly |
//!
//! ```
//! use kickdrift_systems::number::{Laurent, Rational, rational::{from_f64_exact, ratio}};
//! use kickdrift_systems::ManyClocks;
//! use kickdrift_systems::friction::{Damping, Mask, damped_oscillator};
//! // s = h1² L1 = 9/4, rho = 1/25, h2 = 7/2 h1: in the tongue m = 4.
//! let (steps, phases) = ([ratio(1, 1), ratio(7, 2)], [ratio(0, 1), ratio(0, 1)]);
//! let clocks = ManyClocks::new(&steps, &phases, vec![ratio(12, 5), ratio(12 * 7, 5 * 25 * 2)]).unwrap();
//! let with = |rate: f64| {
//!     damped_oscillator(&clocks, &Laurent::from_integer(1), &from_f64_exact(rate).unwrap()).unwrap()
//! };
//! let Mask::At(mask) = with(0.1).masking else { panic!("it grows without friction") };
//! assert!(mask.stays());
//! assert_eq!(with(mask.grows).damping, Some(Damping::Growing));
//! assert_eq!(with(2.0 * mask.least()).damping, Some(Damping::Damped));
//! ```

mod cells;
mod damping;
mod fixed;
mod masking;
mod matrices;
mod polynomial;
mod powers;
mod radius;
mod tie;

pub use damping::Damping;
pub use masking::{Mask, Masked};
pub(crate) use masking::{from_edge, proven_down};
pub use matrices::{
    Friction, allow_pair, damped_oscillator, damped_pair, damped_system, damping_of_oscillator,
};
pub(crate) use radius::{Radius, damping, shrink_one_form};
