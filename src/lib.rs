//! kickdrift decides, exactly, whether a multiple-time-step integrator is linearly stable.
//!
//! # The mathematics on one page
//!
//! One oscillator x'' + (L1 + L2) x = 0 is integrated by *kicks* and *drifts*: the force of L1 kicks at the
//! multiples of h1, that of L2 at the multiples of h2, and between two kicks the state drifts,
//!
//! ```text
//!     K(k) = [[1, 0], [-k, 1]],  k = h L        D(t) = [[1, t], [0, 1]].
//! ```
//!
//! With one clock this is velocity Verlet, with h2 = p h1 r-RESPA, and with any h2/h1 = p/q an asynchronous
//! variational integrator (AVI). After T = q h2 = p h1 the clocks meet again; the product Q over that
//! *synchronization period* has determinant 1, so its powers are bounded iff |Tr Q| < 2 or Q = ±I. Where they
//! are not, the steps *resonate*. The dimensionless data are p/q, s = h1² L1 and rho = L2/L1.
//!
//! **The half period.** The pattern of kicks is a palindrome. With H = \[\[A, B\], \[C, D\]\] the
//! [propagator](propagator::half_period) over T/2 (half of each kick at both ends),
//!
//! ```text
//!     Tr Q - 2 = 4 BC,      Tr Q + 2 = 4 AD,      AD - BC = 1.
//! ```
//!
//! So **four [signs](verdict::HalfSigns) are the verdict**: BC > 0 or AD < 0 is unstable with exponential
//! growth, BC < 0 < AD stable, one zero an edge with linear growth, two zeros (B = C = 0 or A = D = 0) Q =
//! ±I.
//!
//! **The ladder.** The signs are certified in doubles by an a-posteriori [bound](verdict): det 1 keeps the
//! error *across* a computed orbit from growing, so it turns into an angle that shrinks where the orbit
//! grows. What doubles cannot certify goes to more bits, and at last to exact arithmetic over ℚ, ℚ\[π\] or a
//! real cyclotomic field, where zero is [decided](number). A verdict is never guessed and no tolerance is
//! involved.
//!
//! **The prediction.** The fast clock alone turns by θ each step, cos θ = 1 − s/2, so its effective half
//! period is T½ = π h1/θ. Instability is predicted where q h2 is near m T½, that is p θ near m π. These
//! points lie on the curves 1/T½ = a/h1 + b/h2 with m = a p + b q ([`resonance::proposition`]); the [tan
//! criterion](resonance::tan) is exact for every q; how wide a tongue opens about each point is given to
//! first order by [`resonance::first_order`].
//!
//! The method and the conjecture are those of W. Fong, E. Darve and A. Lew, *Stability of Asynchronous
//! Variational Integrators*; equation numbers in this documentation refer to that paper, theorem names to the
//! machine-checked proofs in `proofs/`.
//!
//! ```
//! use kickdrift::{Kind, Limits, Oscillator, decide_steps};
//! // Just below h2 = T½ = 1: resonant.
//! let pair = Oscillator::builder().lambda1("pi^2").lambda2("pi^2/25").h1("1/100").h2("0.98").build()?;
//! assert_eq!(decide_steps(&pair, &Limits::default())?.verdict.kind(), Kind::Hyperbolic);
//! # Ok::<(), kickdrift::Error>(())
//! ```
//!
//! That is the first call: quantities as people write them, and a verdict on a period of any length.
//! [`decide`] takes the [dimensionless pair](TwoClocks), in any ring, and its [answer](verdict::Answer) knows
//! trace, growth and label; a [`question`] is asked in the words of the command line and answered by a
//! document.
//!
//! # Glossary
//!
//! * *period*: T = q h2 = p h1, after which the clocks strike together again; *half period*: the first half
//!   of it, with half of each kick at its two ends.
//! * *base*: the clock that an orbit is followed along in closed form; *foreign kick*: a kick of the other
//!   clock.
//! * *tongue*: an interval of s in which a pair p/q is unstable with exponential growth, between two zeros
//!   (*edges*) of A, B, C or D; it is *closed* where the two coincide.
//! * *label*: the number m of half turns that the growing solution of a tongue makes in one period.
//! * *family*: the integers (a, b) with m = a p + b q, one curve of resonance across all ratios.
//! * *look*: the moment at which a run in doubles measures its orbit's length, on which the proven bound
//!   rests.
//! * *refine*: to follow the orbit again kick by kick, in more bits.
//!
//! # The crates of the house
//!
//! Each crate has a page of its own and builds without those below it in this table; this one hands on their
//! modules and is the program.
//!
//! | crate | here | what is there |
//! |---|---|---|
//! | `kickdrift-number` | [`number`], [`error`], [`parallel`], [`mod@file`] | rationals, ℚ\[π\], cyclotomic fields, polynomials, balls; one error with a kind; threads |
//! | `kickdrift-clocks` | [`schedule`], [`propagator`], [`verdict`], [`resonance`], [`tongue`], [`map`], [`band`] | two clocks on one oscillator: the mission |
//! | `kickdrift-words` | [`word`] | integrators as their authors write them: order, stable intervals, the catalogue |
//! | `kickdrift-systems` | [`system`], [`avi`] | many clocks, many degrees of freedom; Algorithm 1 run as a simulation |
//! | `kickdrift-molecules` | [`advise`] | units, periods and bonds, engines' notations → which steps are safe |
//! | `kickdrift-plot` | [`plot`] | figures as pictures, without physics |
//! | `kickdrift-documents` | [`question`], [`format`](mod@format), [`scene`], [`report`], [`recheck`] | what is asked, typed, with its answer as a document; documents verified |
//! | `kickdrift` | [`cli`], [`explore`] | the program, and the page that it serves |
//!
//! A library that needs verdicts alone depends on `kickdrift-clocks` and builds some thirty crates.

pub mod cli;
pub mod explore;

/// The code of README.md, run as documentation is.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use clocks::{band, map, propagator, resonance, schedule, tongue, verdict};
pub use documents::{format, input as scene, question, report, verify as recheck};
pub use molecules as advise;
pub use number::{self, error, file, parallel};
/// Figures as pictures: what `report` draws with.
pub use plot;
pub use systems::{self as system, avi};
pub use words as word;

// What everyone needs, without the way to it.
pub use clocks::{
    Error, Families, Grid, HalfPeriod, Kind, Limits, Map, Oscillator, Result, Side, Tongues, TwoClocks,
    Verdict, closings, decide, decide_steps, dominant_family, half_period,
};
pub use number::parse::parse;
pub use number::{Laurent, Ratio, Rational, Sign};

#[doc(hidden)]
pub use number::vector::instructions::force_instructions;
