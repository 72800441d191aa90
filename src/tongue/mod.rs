//! Every tongue of a ratio.
mod closing;
mod elimination;
mod gaps;
mod jet;
mod mode;
mod modular;
mod peak;
mod precise;
mod row;
mod spectrum;
mod string;
mod sturm;
mod twofold;

pub use closing::{Closing, ELIMINATION, Found, Search, closings};
pub use elimination::entries;
pub use gaps::{Effort, Gap, Tongues};
pub use peak::Peak;
pub use precise::Enclosure;
pub use row::{ExactEdge, Law, Predicted, Row, Side, Wanted};
pub use spectrum::Edge;
pub use string::Entry;
