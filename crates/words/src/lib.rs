//! Words: integrators as their authors write them, x'' + (Λ1 + Λ2) x = 0 by kicks, drifts and implicit
//! midpoints.
//!
//! A word is read from left to right, in the order of time. In units of the step h, with F the force h² Λ
//! that a letter names:
//!
//! | letter | meaning |
//! |---|---|
//! | `D(c)` | drift: x += c v |
//! | `K(c)`, `K1(c)`, `K2(c)` | kick by both forces, or by one: v −= c F x |
//! | `K(c, d, ...)` | kick by a polynomial of the force (force gradients): v −= (c F + d F² + ...) x |
//! | `K2[g](c)` | kick by the second force through the filter g(x), x = h √Λ1: v −= c g F x ([`Filter`]) |
//! | `C(c)`, `C1(c)`, `C2(c)` | implicit midpoint rule over c h (Cayley's transform) |
//! | `R(c)`, `R1(c)`, `R2(c)` | exact flow over c h, of a force that attracts or repels |
//! | `O(c)` | friction alone over c h: v ← exp(−γ c h) v |
//! | `F(c)` | the same by an explicit step: v ← (1 − γ c h) v |
//! | `I(c)` | the same by an implicit step: v ← v/(1 + γ c h) |
//! | `n*( ... )` | the letters in parentheses n times |
//!
//! Coefficients are sums, products, quotients and powers of rationals and of the roots `sqrt(c)`, `c^(1/n)`;
//! all of them are exact numbers of one field ℚ(c^(1/n)) ([`Radical`](number::Radical)). So the product of
//! the letters has entries that are polynomials in s = h² Λ1 over this field, up to a common denominator that
//! is positive, and everything here is decided exactly: order, edges of stability, verdicts. Doubles appear
//! only as outward rounded enclosures. Exact flows and filters are no polynomials, and friction adds a
//! rate; words that have them are proven stable or unstable in balls ([`Shape`], [`Enclosed`]), their order
//! by power series.
//!
//! ```
//! use kickdrift_words::{Forces, Stability, Word};
//! // Chin 4A: a kick of strength (2/3) s (1 - s/24) in the middle.
//! let word: Word = "K(1/6) D(1/2) K(2/3, -1/36) D(1/2) K(1/6)".parse()?;
//! assert_eq!(word.to_string(), "K(1/6) D(1/2) K(2/3, -1/36) D(1/2) K(1/6)");
//! assert_eq!(word.order().order, 4);
//! let stability = Stability::of(&word.polynomials(&Forces::one()));
//! let edge = stability.first_edge().unwrap().rational();
//! assert_eq!(edge, Some(kickdrift_words::number::rational::ratio(12, 1))); // omega h = 2 sqrt 3
//! # Ok::<(), kickdrift_words::number::error::Error>(())
//! ```

pub mod anharmonic;
mod catalogue;
mod coefficient;
mod damping;
mod enclosed;
mod exactly;
mod filter;
mod general_order;
mod grammar;
mod integrator;
mod letters;
mod order;
mod point;
mod product;
mod published;
mod stability;
mod trigonometric;

pub use clocks;
pub use number;

pub use catalogue::{METHODS, Method, method};
pub use damping::Damping;
pub use enclosed::{Enclosed, Piece};
pub use filter::Filter;
pub use general_order::{ErrorTerm, FormalOrder, GeneralOrder, NoGeneralOrder};
pub use integrator::{Bounded, Integrator};
pub use letters::{Cost, Force, Item, Letter, Place, Word};
pub use order::{MOST_ORDER, Order};
pub use point::{At, at};
pub use product::{Forces, Polynomials, Product};
pub use published::{ALL, FREE, HALF_PERIOD, LIMITS, Limit};
pub use stability::{Edge, Interval, Stability};
pub use trigonometric::{Shape, Trigonometric};
