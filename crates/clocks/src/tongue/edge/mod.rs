//! Edges of tongues: the eigenvalues of the four strings, enclosed.
//!
//! Sturm counts separate the eigenvalues. The Rayleigh quotient of a mode encloses each one, as a rule
//! between neighbouring doubles. Signs of the entry in more bits give any number of digits.
//!
//! | file | what is there |
//! |---|---|
//! | `count`, `isolate` | how many eigenvalues lie below a point, and brackets of one each |
//! | `batch` | eigenvalues that are looked for side by side |
//! | `locate`, `half`, `mode` | where a mode lives, the recurrence to it from both ends, what it proves |
//! | `eigenvalues` | the way from counts to enclosures in doubles |
//! | `enclosure` | an edge in doubles, and by rational ends |
//! | `function` | an entry of the half period at rational points |
//! | `fine_count` | 25 digits by counts in two doubles |
//! | `precise`, `proven_count` | any number of digits; counts where two doubles cannot separate |
//! | `long` | edges of long periods, one by one |
//! | `modular` | the proof modulo a prime that no tongue is closed |
//! | `edges` | the edges of one ratio, by whichever way is needed |

mod batch;
mod count;
mod edges;
mod eigenvalues;
mod enclosure;
mod fine_count;
mod function;
mod half;
mod isolate;
mod locate;
mod long;
mod mode;
mod modular;
mod precise;
mod proven_count;

pub use count::counts;
pub use edges::{Effort, Tongues};
pub(crate) use enclosure::negative_log2;
pub use enclosure::{Edge, Enclosure};
pub(crate) use fine_count::TWO_DOUBLES;
pub use number::rational::simplest;
