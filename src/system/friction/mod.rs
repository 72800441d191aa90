//! Friction: Ornstein and Uhlenbeck's step O in the middle of every drift, as BAOAB and its relatives do.
//!
//! Between two kick times a time t apart the state goes through D(t/2) O D(t/2), O: v → c v (+ noise), c = exp(−γ t). The kick times are
//! those of the whole schedule: a potential parts the drifts of what it does not act on, too, and of strength 0 it still does
//! (D(t/2) O D(t/2) twice is not the same over 2t). So what moves apart from the rest is damped as if weakly coupled to it.
//! With one level this is BAOAB, with r-RESPA its multiple-time-step form (the innermost step a BAOAB one). Means and
//! covariances of the chain stay bounded iff the *spectral radius* ρ(Q) of the noiseless period is below 1. Friction is no
//! longer reversible, so the whole period decides, not its half. For one oscillator
//!
//! ```text
//!     det Q = exp(−γ T),     ρ(Q) < 1  iff  |Tr Q| < 1 + det Q   (Jury),
//! ```
//!
//! and a linear resonance is *masked* by every γ for which ρ(Q) < 1 although the frictionless period grows.
//!
//! | file | what |
//! |---|---|
//! | `scalar` | one oscillator, enclosed for a rate γ |
//! | `masking` | the smallest friction that masks a resonance of one oscillator, from the polynomial Tr Q(c) |
//! | `matrices` | many degrees of freedom, in doubles with a proven bound (two levels of measured stiffnesses: [`Kernel::friction`](crate::system::levels::Kernel::friction)) |
//!
//! ```
//! use kickdrift::number::{Rational, rational::ratio};
//! use kickdrift::system::ManyClocks;
//! use kickdrift::system::friction::{Damping, damped, masking};
//! // s = h1² L1 = 9/4, rho = 1/25, h2 = 7/2 h1: in the tongue m = 4.
//! let (steps, phases) = ([ratio(1, 1), ratio(7, 2)], [ratio(0, 1), ratio(0, 1)]);
//! let clocks = ManyClocks::new(&steps, &phases, vec![ratio(12, 5), ratio(12 * 7, 5 * 25 * 2)]).unwrap();
//! let mask = masking(&clocks).unwrap().expect("it grows without friction");
//! let at = |rate: Rational| damped(&clocks, &rate).unwrap().damping;
//! assert_eq!(at(mask.rate.lower() / ratio(2, 1)), Damping::Growing);
//! assert_eq!(at(mask.rate.upper() * ratio(2, 1)), Damping::Damped);
//! ```

mod damping;
mod masking;
mod matrices;
mod scalar;

pub use damping::Damping;
pub use masking::{Masking, masking};
pub use matrices::{Friction, Mask, Masked, damped_oscillator, damped_pair, damped_system};
pub(in crate::system) use matrices::{Radius, damping};
pub use scalar::{Damped, damped};
