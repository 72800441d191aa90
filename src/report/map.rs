//! The verdicts of a grid as a document: the counts, and the pairs that are not plainly stable as rows.

use serde_json::json;

use super::document::Document;
use super::table::{Cell, Column, Table};
use crate::verdict::{Decision, Kind, Tier};

/// A pair whose verdict is not "elliptic": (i, j) names h1 = i D1 and h2 = j D2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Marked {
    pub i: u64,
    pub j: u64,
    pub p: u64,
    pub q: u64,
    pub decision: Decision,
}

/// Counts over a grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    pub pairs: u64,
    /// Elliptic or coexistence.
    pub stable: u64,
    /// Hyperbolic or parabolic.
    pub unstable: u64,
    pub parabolic: u64,
    pub coexistence: u64,
    /// By tier: filter, refine, exact.
    pub decided_by: [u64; 3],
}

impl Counts {
    /// Counts one pair in.
    pub fn add(&mut self, decision: &Decision) {
        let verdict = decision.verdict;
        self.pairs += 1;
        *(if verdict.is_stable() { &mut self.stable } else { &mut self.unstable }) += 1;
        self.parabolic += u64::from(verdict.kind() == Kind::Parabolic);
        self.coexistence += u64::from(verdict.kind() == Kind::Coexistence);
        self.decided_by[decision.decided_by as usize] += 1;
    }

    /// The counts of two disjoint sets of pairs together.
    #[must_use]
    pub fn plus(mut self, other: &Counts) -> Self {
        self.pairs += other.pairs;
        self.stable += other.stable;
        self.unstable += other.unstable;
        self.parabolic += other.parabolic;
        self.coexistence += other.coexistence;
        self.decided_by.iter_mut().zip(other.decided_by).for_each(|(mine, theirs)| *mine += theirs);
        self
    }
}

/// The document `kickdrift/map/1`; `steps` shows h1 and h2 of a marked pair exactly. The caller adds the input.
pub fn document(counts: &Counts, marked: &[Marked], steps: impl Fn(&Marked) -> [String; 2]) -> Document {
    let [filter, refine, exact] = counts.decided_by;
    let tiers = [Tier::Filter, Tier::Refine, Tier::Exact].map(Tier::name);
    let lines = [
        format!(
            "{} pairs, each decided: {} stable, {} unstable",
            counts.pairs, counts.stable, counts.unstable
        ),
        format!("  parabolic {}, coexistence {}", counts.parabolic, counts.coexistence),
        format!("  decided by {} {filter}, {} {refine}, {} {exact}", tiers[0], tiers[1], tiers[2]),
    ];
    Document::new("map")
        .entry("pairs", counts.pairs)
        .entry("stable", counts.stable)
        .entry("unstable", counts.unstable)
        .entry("parabolic", counts.parabolic)
        .entry("coexistence", counts.coexistence)
        .entry("decided_by", json!({tiers[0]: filter, tiers[1]: refine, tiers[2]: exact}))
        .long_rows(table(marked, steps))
        .summary(&lines)
}

fn table(marked: &[Marked], steps: impl Fn(&Marked) -> [String; 2]) -> Table {
    let columns = vec![
        Column::new("h1").titled("h1", "$h_1$"),
        Column::new("h2").titled("h2", "$h_2$"),
        Column::new("p").titled("p", "$p$"),
        Column::new("q").titled("q", "$q$"),
        Column::new("kind").left(),
        Column::new("side"),
        Column::new("decided_by").titled("decided by", "decided by").left(),
    ];
    let mut table = Table::new("pairs", "Pairs that are unstable or on an edge", columns);
    for pair in marked {
        let [h1, h2] = steps(pair).map(Cell::Exact);
        let verdict = pair.decision.verdict;
        let (kind, tier) = (verdict.kind().name(), pair.decision.decided_by.name());
        let [p, q] = [pair.p, pair.q].map(|n| Cell::Integer(n as i64));
        table.push(vec![
            h1,
            h2,
            p,
            q,
            Cell::Text(kind.into()),
            Cell::Integer(verdict.side().into()),
            Cell::Text(tier.into()),
        ]);
    }
    table
}
