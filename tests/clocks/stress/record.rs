//! What a run of cases has shown.

use std::fmt;

/// Counts over cases; joined in any order to the same.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Record {
    pub cases: u64,
    /// Verdicts that differ from exact arithmetic's.
    pub wrong: u64,
    /// Decided by filter, refine, exact.
    pub by_tier: [u64; 3],
    /// Pairs on an edge: parabolic or coexistence.
    pub ties: u64,
    /// The filter's trace enclosures, those that do not hold the exact trace, and the largest error over
    /// bound.
    pub enclosures: u64,
    pub outside: u64,
    pub worst_ratio: f64,
}

impl Record {
    pub fn join(self, other: Record) -> Record {
        let tiers = |n: usize| self.by_tier[n] + other.by_tier[n];
        Record {
            cases: self.cases + other.cases,
            wrong: self.wrong + other.wrong,
            by_tier: [tiers(0), tiers(1), tiers(2)],
            ties: self.ties + other.ties,
            enclosures: self.enclosures + other.enclosures,
            outside: self.outside + other.outside,
            worst_ratio: self.worst_ratio.max(other.worst_ratio),
        }
    }
}

impl fmt::Display for Record {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let share = |n: u64| 100.0 * n as f64 / self.cases.max(1) as f64;
        let [filter, refine, exact] = self.by_tier;
        writeln!(f, "  cases                              {:>10}", self.cases)?;
        writeln!(f, "  wrong verdicts                     {:>10}", self.wrong)?;
        writeln!(f, "  on an edge                         {:>10}", self.ties)?;
        for (name, n) in [("filter", filter), ("refine", refine), ("exact", exact)] {
            writeln!(f, "  decided by {name:<8}                {n:>10}   {:>8.4} %", share(n))?;
        }
        writeln!(f, "  trace enclosures of the filter     {:>10}", self.enclosures)?;
        writeln!(f, "  that miss the exact trace          {:>10}", self.outside)?;
        write!(f, "  largest error over claimed bound   {:>10.4}", self.worst_ratio)
    }
}
