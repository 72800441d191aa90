//! Bands: steps at which every ratio h2/h1, rational or not, is unstable (proofs/BANDS.md).
//!
//! Between two kicks of the other clock the state moves by a matrix that depends on one offset alone, and the
//! offset moves by an exchange of two intervals. Euclid's algorithm on their lengths leads from level to
//! level; each has two return maps. Where both of one level, for all offsets and all ratios of a range, take
//! one cone of directions into its interior, products of them grow in whatever order they come: every ratio
//! of the range is unstable.
//!
//! Larger steps turn further. So where two first steps are in one tongue, for all ratios of a range, all
//! steps between them are: a **sector** is proven by its two sides, however wide it is.
//!
//! ```text
//!     tongue, range of ratios -> about where its edges are -> a side: Taylor models in the ratio -> one kick in a turning frame
//!         -> two return maps, level by level -> a common cone; labels at both ends -> a sector
//! ```
//!
//! | file | what is there |
//! |---|---|
//! | `taylor` | numbers that depend on the ratio: Taylor models of the second order, with a bound on the rest |
//! | `trig` | sine, cosine and arcsine of doubles with proven bounds |
//! | `family` | matrix functions of an offset, Taylor models in the ratio, too |
//! | `frame` | steps in the units of their base, and one kick in the frame of a family (a, b) |
//! | `walk` | Euclid's algorithm on a range of ratios |
//! | `cone` | the common cone |
//! | `ratios` | the ratios about one of them, at one step of the first clock |
//! | `edges` | about where a tongue is |
//! | `sector` | a sector, and the proof of a side |
//! | `search` | the tongues of a window, cut into ranges of ratios |
//!
//! Nothing is said of what is not certified: it may be stable or not.
//!
//! ```
//! use kickdrift_clocks::band::Window;
//! use kickdrift_clocks::number::parse::parse;
//! let x = |text| parse("quantity", text).unwrap();
//! // Below h2 = 1: half a period of the fast force.
//! let window = Window::new([x("pi^2"), x("pi^2/25")], [(x("1/5"), x("1/4")), (x("9/10"), x("1"))]).unwrap();
//! let bands = window.search(500, None, &|_| ()).unwrap();
//! // At least a third of it is unstable for every ratio.
//! assert!(bands.share().0 > 1.0 / 3.0);
//! ```

mod cone;
mod edges;
mod family;
mod frame;
mod ratios;
mod search;
mod sector;
mod taylor;
mod trig;
mod walk;

pub use ratios::unstable_ratios;
pub use search::{Bands, Window};
pub use sector::{Line, Ratio, Sector};
