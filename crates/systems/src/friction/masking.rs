//! The frictions that mask what grows: looked for by values, proven range by range.

use super::damping::Damping;

/// Whether there is something to mask, and by which frictions.
#[derive(Clone, Debug, PartialEq)]
pub enum Mask {
    /// Nothing grows without friction, which is proven (without one, or at one of 10^-6 a period).
    NotNeeded,
    /// Something does, and these mask it.
    At(Masked),
    /// Not found: no friction that is proven to mask, or doubles that cannot decide whether anything grows.
    Undecided,
}

/// The frictions that mask the resonances of a system.
#[derive(Clone, Debug, PartialEq)]
pub struct Masked {
    /// At this one something is proven to grow; 0 where that is known without friction alone.
    pub grows: f64,
    /// Ranges of frictions that are proven to mask, increasing, at least one. The last has no end where all
    /// larger ones are proven to.
    pub ranges: Vec<(f64, f64)>,
}

impl Mask {
    /// The frictions that mask both.
    pub(super) fn and(self, other: Mask) -> Mask {
        match (self, other) {
            (Mask::NotNeeded, one) | (one, Mask::NotNeeded) => one,
            (Mask::At(a), Mask::At(b)) => {
                let common = |(lo, hi): &(f64, f64)| {
                    b.ranges.iter().map(|own| (lo.max(own.0), hi.min(own.1))).collect::<Vec<_>>()
                };
                let ranges = a.ranges.iter().flat_map(common).filter(|(lo, hi)| lo <= hi).collect();
                Mask::found(a.grows.max(b.grows), ranges)
            }
            _ => Mask::Undecided,
        }
    }

    pub fn found(grows: f64, ranges: Vec<(f64, f64)>) -> Mask {
        if ranges.is_empty() { Mask::Undecided } else { Mask::At(Masked { grows, ranges }) }
    }
}

impl Masked {
    /// The least friction that is proven to mask.
    pub fn least(&self) -> f64 {
        self.ranges[0].0
    }

    /// Whether every friction above the least one is proven to mask.
    pub fn stays(&self) -> bool {
        self.ranges[0].1 == f64::INFINITY
    }

    /// The same in another unit of time, `unit` of the old ones.
    pub fn per(&self, unit: f64) -> Masked {
        let ranges = self.ranges.iter().map(|(lo, hi)| (lo / unit, hi / unit)).collect();
        Masked { grows: self.grows / unit, ranges }
    }
}

/// Frictions from 2^-4 to 2^20 a period are looked at.
const OCTAVES: std::ops::Range<i32> = -4..20;

/// The width of a cell that is not halved, relative to all of them.
const MIN_CELL: f64 = 1.0 / (1_u64 << 46) as f64;

/// What is known of frictions.
pub struct Search<'a> {
    pub period: f64,
    /// Where the spectral radius is proven to lie.
    pub side: &'a dyn Fn(f64) -> Option<Damping>,
    /// Up to where all frictions from one on are proven to mask, where that is asked for.
    pub up: Option<&'a dyn Fn(f64) -> f64>,
    /// Frictions that are looked at between one and its double.
    pub per_octave: i32,
    /// The relative width to which the least is bisected.
    pub width: f64,
}

impl Search<'_> {
    /// The ranges that are found above a friction at which something grows.
    pub fn above(&self, grows: f64) -> Mask {
        let (mut ranges, mut least): (Vec<(f64, f64)>, _) = (Vec::new(), grows);
        let mut last = grows;
        for k in OCTAVES.start * self.per_octave..OCTAVES.end * self.per_octave {
            let at = 2f64.powf(f64::from(k) / f64::from(self.per_octave)) / self.period;
            let end = ranges.last().map_or(0.0, |own| own.1);
            if at <= last.max(end) {
                continue;
            }
            let side = (self.side)(at);
            let found = match side {
                // Nothing between the range before and this one is known to grow.
                Some(Damping::Damped) if last < end => Some((last, at)),
                Some(Damping::Damped) => Some(self.bisected(last, at)),
                _ => None,
            };
            if let Some((below, first)) = found {
                if ranges.is_empty() {
                    least = below;
                }
                ranges.push(from_edge(first, |from| self.up.map_or(from, |up| up(from))));
                if self.up.is_none() {
                    break;
                }
            }
            if side == Some(Damping::Growing) {
                last = at;
            }
        }
        Mask::found(least, ranges)
    }

    /// Neighbours of which something grows at the first and nothing at the second.
    fn bisected(&self, mut lo: f64, mut hi: f64) -> (f64, f64) {
        while hi > lo * (1.0 + self.width) {
            let is_far = lo > 0.0 && hi > 4.0 * lo;
            let middle = if is_far { (lo * hi).sqrt() } else { lo + (hi - lo) / 2.0 };
            match (self.side)(middle) {
                Some(Damping::Growing) => lo = middle,
                Some(Damping::Damped) => hi = middle,
                // So near to 1 that doubles cannot decide: the bracket is as narrow as it gets.
                _ => break,
            }
        }
        (lo, hi)
    }
}

/// The range that is proven from a friction that masks, or from just above it: beside an edge bounds may be
/// as wide as the way to it.
pub(crate) fn from_edge(first: f64, up: impl Fn(f64) -> f64) -> (f64, f64) {
    let reach = |part: f64| (part * first, up(part * first));
    let found = [1.0, 1.001, 1.003, 1.01].into_iter().map(reach).find(|(lo, hi)| lo < hi);
    found.unwrap_or((first, first))
}

/// The least share down to which all shares from 1 on are proven, cell by cell: `halve` gives the halves of a
/// cell that is not, and knows its ends.
pub(crate) fn proven_down<C>(
    whole: C,
    mut halvings: usize,
    halve: impl Fn(C, f64, f64) -> Option<[C; 2]>,
) -> f64 {
    let (mut open, mut least) = (vec![(whole, 0.0, 1.0)], 1.0);
    while let Some((cell, lo, hi)) = open.pop() {
        let Some([lower, upper]) = halve(cell, lo, hi) else {
            least = lo;
            continue;
        };
        if hi - lo <= MIN_CELL || halvings == 0 {
            break;
        }
        halvings -= 1;
        let middle = lo + (hi - lo) / 2.0;
        open.push((lower, lo, middle));
        open.push((upper, middle, hi));
    }
    least
}
