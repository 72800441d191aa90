//! Counts over a grid, and what stands out in it.

use std::collections::BTreeMap;

use serde_json::Value;

use super::rows::{Found, marked};
use crate::report::decimal::enclosure;
use crate::report::record::Record;
use crate::report::shape::{EXACT, INTEGER, POSITIVE, POSITIVE_ENCLOSURE, Shape};
use crate::report::table::Cell;
use clocks::map::{Band, Counters, Enclosure, Grid};
use clocks::verdict::{Kind, Verdict};

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
    /// Counts the pairs of a band in.
    pub fn add(&mut self, band: &Band) {
        let mut seen = [0u64; Verdict::ALL.len()];
        band.verdicts.iter().for_each(|&verdict| seen[usize::from(verdict)] += 1);
        band.tiers.iter().for_each(|&tier| self.decided_by[usize::from(tier)] += 1);
        for (verdict, count) in Verdict::ALL.iter().zip(seen) {
            self.pairs += count;
            *(if verdict.is_stable() { &mut self.stable } else { &mut self.unstable }) += count;
            self.parabolic += if verdict.kind() == Kind::Parabolic { count } else { 0 };
            self.coexistence += if verdict.kind() == Kind::Coexistence { count } else { 0 };
        }
    }

    /// The pairs that are not elliptic: those that have a row.
    pub fn marked(&self) -> u64 {
        self.unstable + self.coexistence
    }
}

/// How many families the summary for people lists.
const FAMILIES_LISTED: usize = 6;

/// The numbers of the summary.
#[derive(Clone, Debug, Default)]
pub struct MapTally {
    pub counts: Counts,
    pub(super) counters: Counters,
    /// Pairs by the a of their dominant family, where labels were asked for.
    families: BTreeMap<i64, u64>,
    /// The pair that grows fastest where growth was asked for: no other one is proven to grow faster.
    pub(crate) fastest: Option<Fastest>,
}

#[derive(Clone, Debug)]
pub struct Fastest {
    /// The multiples of both spacings.
    pub at: [u64; 2],
    steps: [String; 2],
    pub rate: Enclosure,
    /// Slow steps until an amplitude is tenfold.
    pub tenfold: Enclosure,
}

pub(super) const FAMILIES: Shape = Shape::List(&Shape::Object(|| family_record().keys()));
pub(super) const FASTEST: Shape = Shape::Object(|| fastest_record().keys());

/// The record of a family: its a, and how many pairs grow with it.
fn family_record() -> Record<'static, (i64, u64)> {
    Record::new()
        .json("a", |&(a, _): &(i64, u64)| a.into())
        .says(INTEGER, "a of the dominant family.")
        .json("pairs", |&(_, pairs)| pairs.into())
        .says(POSITIVE, "So many pairs grow with it.")
}

/// The entries of the pair that grows fastest.
fn fastest_record() -> Record<'static, Fastest> {
    Record::new()
        .json("h1", |fastest: &Fastest| Cell::exact(&fastest.steps[0]))
        .says(EXACT, "")
        .json("h2", |fastest| Cell::exact(&fastest.steps[1]))
        .says(EXACT, "")
        .json("growth_rate", |fastest| (fastest.rate.lo, fastest.rate.hi).into())
        .says(POSITIVE_ENCLOSURE, "Per unit time.")
        .json("steps_until_tenfold", |fastest| (fastest.tenfold.lo, fastest.tenfold.hi).into())
        .says(POSITIVE_ENCLOSURE, "Slow steps until the amplitude has grown tenfold.")
}

impl MapTally {
    /// Counts a band in.
    pub fn add(&mut self, grid: &Grid, band: &Band) {
        self.counts.add(band);
        self.counters.add(&band.counters);
        if band.growing.is_empty() {
            return;
        }
        for pair in marked(grid, band) {
            let Found { family, rate, tenfold, .. } = pair.found();
            if let Some((a, _)) = family {
                *self.families.entry(a).or_default() += 1;
            }
            if let (Some(rate), Some(tenfold)) = (rate, tenfold)
                && self.fastest.as_ref().is_none_or(|fastest| rate.middle() > fastest.rate.middle())
            {
                let steps = [grid.h1(pair.i).to_string(), grid.h2(pair.j).to_string()];
                self.fastest = Some(Fastest { at: [pair.i, pair.j], steps, rate, tenfold });
            }
        }
    }

    /// The entry `families`, where labels were asked for and some pair grows.
    pub(super) fn families(&self) -> Option<Value> {
        let families = || self.families.iter().map(|(&a, &pairs)| family_record().entries(&(a, pairs)));
        (!self.families.is_empty()).then(|| families().collect())
    }

    /// The entry `fastest`, where growth was asked for and some pair grows.
    pub(super) fn fastest(&self) -> Option<Value> {
        self.fastest.as_ref().map(|fastest| fastest_record().entries(fastest))
    }

    pub(super) fn lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        if !self.families.is_empty() {
            let mut families: Vec<(&i64, &u64)> = self.families.iter().collect();
            families.sort_by_key(|(a, pairs)| (std::cmp::Reverse(**pairs), **a));
            let listed: Vec<String> =
                families.iter().take(FAMILIES_LISTED).map(|(a, pairs)| format!("a = {a}: {pairs}")).collect();
            let others = families.len().saturating_sub(FAMILIES_LISTED);
            let others = if others > 0 { format!(", {others} others") } else { String::new() };
            lines.push(format!("  dominant families {}{others}", listed.join(", ")));
        }
        if let Some(Fastest { steps: [h1, h2], rate, tenfold, .. }) = &self.fastest {
            let [rate, tenfold] = [rate, tenfold].map(|x| enclosure(x.lo, x.hi));
            lines.push(format!(
                "  fastest growth {rate} per unit time at h1 = {h1}, h2 = {h2}: tenfold in {tenfold} slow steps"
            ));
        }
        lines
    }
}
