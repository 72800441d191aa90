//! The question to a walk: it does no more than it is asked for.

/// The results that a run is asked for.
#[derive(Clone, Copy, PartialEq)]
pub enum Wanted {
    /// Whether the period grows: the entries where it takes them.
    Verdict,
    /// The four entries.
    Entries,
    /// The sign changes of x, too: half as much again.
    Nodes,
}
