//! Tongues, edge by edge: exact signs of the half period at the ends of every enclosure, and the verdict
//! inside.
//!
//! | file | what is there |
//! |---|---|
//! | `edge` | an edge: its zero, closed form, digits, steps |
//! | `columns` | what else a row says: growth, the predicted point, the law of first order |
//! | `listing` | the list: none left out, none counted twice |
//! | `check` | a whole row, a whole document |

mod check;
mod columns;
mod edge;
mod listing;

pub use check::Row;
