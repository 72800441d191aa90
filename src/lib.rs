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
//! *synchronization period* has determinant 1, so its powers are bounded iff |Tr Q| < 2 or Q = ±I. Where they are
//! not, the steps *resonate*. The dimensionless data are p/q, s = h1² L1 and rho = L2/L1.
//!
//! **The half period.** The pattern of kicks is a palindrome. With H = \[\[A, B\], \[C, D\]\] the
//! [propagator](propagator::half_period) over T/2 (half of each kick at both ends),
//!
//! ```text
//!     Tr Q - 2 = 4 BC,      Tr Q + 2 = 4 AD,      AD - BC = 1.
//! ```
//!
//! So **four [signs](verdict::HalfSigns) are the verdict**: BC > 0 or AD < 0 is unstable with exponential growth,
//! BC < 0 < AD stable, one zero an edge with linear growth, two zeros (B = C = 0 or A = D = 0) Q = ±I.
//!
//! **The ladder.** The signs are certified in doubles by an a-posteriori [bound](verdict): det 1 keeps the error
//! *across* a computed orbit from growing, so it turns into an angle that shrinks where the orbit grows. What
//! doubles cannot certify goes to more bits, and at last to exact arithmetic over ℚ, ℚ\[π\] or a real cyclotomic
//! field, where zero is [decided](number). A verdict is never guessed and no tolerance is involved.
//!
//! **The prediction.** The fast clock alone turns by θ each step, cos θ = 1 − s/2, so its effective half period is
//! T½ = π h1/θ. Instability is predicted where q h2 is near m T½, that is p θ near m π. These points lie on the
//! curves 1/T½ = a/h1 + b/h2 with m = a p + b q ([`resonance::proposition`]); the [tan criterion](resonance::tan) is
//! exact for every q; how wide a tongue opens about each point is given to first order by
//! [`resonance::first_order`].
//!
//! The method and the conjecture are those of W. Fong, E. Darve and A. Lew, *Stability of Asynchronous Variational
//! Integrators*; equation numbers in this documentation refer to that paper, theorem names to the machine-checked
//! proofs in `proofs/`.
//!
//! ```
//! use kickdrift::{Kind, Limits, Oscillator, decide_steps, parse};
//! let x = |text| parse("quantity", text).unwrap();
//! // Just below h2 = T½ = 1: resonant.
//! let oscillator = Oscillator::new(x("pi^2"), x("pi^2/25"), x("1/100"), x("0.98")).unwrap();
//! let decision = decide_steps(&oscillator, &Limits::default()).unwrap();
//! assert_eq!(decision.verdict.kind(), Kind::Hyperbolic);
//! ```
//!
//! # Glossary
//!
//! * *period*: T = q h2 = p h1, after which the clocks strike together again; *half period*: the first half of it, with
//!   half of each kick at its two ends.
//! * *base*: the clock that an orbit is followed along in closed form; *foreign kick*: a kick of the other clock.
//! * *tongue*: an interval of s in which a pair p/q is unstable with exponential growth, between two zeros (*edges*) of
//!   A, B, C or D; it is *closed* where the two coincide.
//! * *label*: the number m of half turns that the growing solution of a tongue makes in one period.
//! * *family*: the integers (a, b) with m = a p + b q, one curve of resonance across all ratios.
//! * *look*: the moment at which a run in doubles measures its orbit's length, on which the proven bound rests.
//! * *refine*: to follow the orbit again kick by kick, in more bits.
//!
//! # The floors of the house
//!
//! Imports go down only, and siblings on one floor do not import each other (a test keeps it so).
//!
//! | floor | module | what is there |
//! |---|---|---|
//! | – | [`error`], [`format`](mod@format) | one error with a kind; the forms of results |
//! | 0 | [`plot`] | figures as pictures, without physics: a crate of its own, crates/plot |
//! | 0 | `vector` | doubles side by side in the processor's registers |
//! | 0 | [`parallel`] | work on all threads, or without them; work that can be stopped |
//! | 0 | [`number`] | signs, rings, rationals, ℚ\[π\], cyclotomic fields, polynomials, balls, parsing |
//! | 1 | [`schedule`] | which clocks kick when, over the period or its first half |
//! | 2 | [`propagator`] | kick, drift, full and half period and its signs, the methods |
//! | 3 | [`word`] | integrators as their authors write them: order, stable intervals, the catalogue |
//! | 3 | `orbit` | orbits followed with proven bounds: Floquet coordinates, filter, refine, leaps over long runs, return maps of long periods |
//! | 4 | [`verdict`] | four signs → verdict, and the ladder filter → refine → exact |
//! | 5 | [`resonance`] | θ, tan criterion, Proposition, (a, b) families and curves, strength, comparison |
//! | 6 | [`map`] | the verdicts of whole grids of steps, pairs side by side |
//! | 6 | [`tongue`] | every unstable interval of a ratio, its edges, and where tongues close |
//! | 6 | [`system`] | many clocks, many degrees of freedom |
//! | 6 | [`band`] | steps at which every ratio is unstable |
//! | 6 | [`avi`] | Algorithm 1 run as a simulation |
//! | 7 | [`advise`] | units, periods and bonds, engines' notations → which steps are safe |
//! | 8 | [`scene`] | systems' files → library types |
//! | 8 | [`report`] | results → JSON, CSV, LaTeX, text, NPZ, SVG, PDF, PNG |
//! | 9 | [`question`] | what is asked, typed; each question with its answer, its rows and its document |
//! | 10 | [`recheck`] | every document's claims found again by another route |
//! | 10 | [`explore`] | what a page asks to move in the plane, answered; the page, served |
//! | 11 | [`cli`] | arguments → a question → the library → a report |
//!
//! A new number type goes to `number` and implements [`number::Real`]; a new integrator to
//! [`propagator::methods`]; a new table format to [`report`]; a new command to [`cli`].
//!
//! # Features
//!
//! Without any feature the library is the mathematics of one oscillator and of Algorithm 1, and builds in seconds.
//!
//! | feature | adds |
//! |---|---|
//! | `system` | `system`: many clocks, many degrees of freedom (faer) |
//! | `advise` | `advise`: which steps are safe for these periods (roxmltree) |
//! | `parallel` | maps, surveys and scans on all cores (rayon); without it the same results on one |
//! | `serde` | `scene`, `report` and `recheck`: input documents, output tables, documents rechecked |
//! | `figure` | the drawings of results, by the crate `plot` |
//! | `cli` | the program (default), and `explore`: its page, what that asks, and the page served on this machine (axum, tokio) |

#[cfg(feature = "advise")]
pub mod advise;
pub mod avi;
pub mod band;
#[cfg(feature = "cli")]
pub mod cli;
pub mod error;
#[cfg(feature = "cli")]
pub mod explore;
pub mod file;
pub mod format;
pub mod map;
mod named;
pub mod number;
mod orbit;
pub mod parallel;
/// Figures as pictures: what `report` draws with.
#[cfg(feature = "figure")]
pub use plot;
pub mod propagator;
#[cfg(feature = "serde")]
pub mod question;
#[cfg(feature = "serde")]
pub mod recheck;
#[cfg(feature = "serde")]
pub mod report;
pub mod resonance;
#[cfg(feature = "serde")]
pub mod scene;
pub mod schedule;
#[cfg(feature = "system")]
pub mod system;
pub mod tongue;
mod vector;
pub mod verdict;
pub mod word;

// What everyone needs, without the way to it.
pub use error::{Error, Result};
pub use map::{Grid, Map};
pub use number::parse::parse;
pub use number::{Laurent, Ratio, Rational, Sign};
pub use propagator::{HalfPeriod, Oscillator, TwoClocks, half_period};
pub use resonance::{Families, dominant_family};
pub use tongue::{Tongues, closings};
pub use verdict::{Kind, Limits, Side, Verdict, decide, decide_steps};

#[doc(hidden)]
pub use vector::instructions::force_instructions;
