//! Every tongue of a ratio.
mod elimination;
mod gaps;
mod mode;
mod modular;
mod precise;
mod spectrum;
mod string;
mod sturm;
mod twofold;

pub use elimination::entries;
pub use gaps::{Effort, Gap, Tongues};
pub use precise::Enclosure;
pub use spectrum::Edge;
pub use string::Entry;
