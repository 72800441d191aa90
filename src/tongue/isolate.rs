//! Eigenvalues told apart by counts.

use super::lanes::{LANES, lanes};
use super::string::{Entry, HalfString};

/// An interval of κ that, by computed counts, holds no other eigenvalue of the problem: the one before lies below
/// lo (1 + η), the one after above hi (1 − η).
#[derive(Clone, Copy, Debug)]
pub(super) struct Bracket {
    pub entry: Entry,
    /// 1, 2, ... from below.
    pub index: usize,
    pub lo: f64,
    pub hi: f64,
}

/// The first and the last index wanted of each of the two problems with the same start: pinned and free at T/2.
pub(super) type Wanted = [Option<(u64, u64)>; 2];

/// κ and the computed counts there.
#[derive(Clone, Copy, Debug)]
struct Sample {
    kappa: f64,
    counts: [u64; 2],
}

impl Sample {
    /// The most eigenvalues that one of the two problems has between two samples; `all`: even where none is wanted.
    fn inside(&self, next: &Sample, wanted: &Wanted, all: bool) -> u64 {
        let one = |e: usize| {
            let (from, upto) = (self.counts[e], next.counts[e]);
            let asked = all || wanted[e].is_some_and(|(first, last)| from < last && first <= upto);
            if asked { upto.saturating_sub(from) } else { 0 }
        };
        one(0).max(one(1))
    }
}

/// Samples in increasing order of κ, dense enough to tell the wanted eigenvalues apart.
pub(super) struct Samples {
    starts_free: bool,
    list: Vec<Sample>,
}

/// At most so many points in an interval at a time.
const MOST: u64 = 64;

impl HalfString {
    /// Counts until all wanted eigenvalues are alone between two samples, or counts in doubles cannot tell them apart;
    /// for the problems that start free and those that start pinned.
    pub fn sample(&self, wanted: &[Wanted; 2]) -> [Samples; 2] {
        let mut both = [true, false].map(|starts_free| {
            let counts = Entry::starting(starts_free).map(|entry| self.dimension(entry) as u64);
            let zero = Sample { kappa: 0.0, counts: [0, 0] };
            Samples { starts_free, list: vec![zero, Sample { kappa: self.upper_bound, counts }] }
        });
        loop {
            let mut points = Vec::new();
            for (samples, wanted) in both.iter().zip(wanted) {
                samples.cut(wanted, 16.0 * self.eta(), &mut points);
            }
            if points.is_empty() {
                return both;
            }
            let found = self.count_at(&points);
            let (free, pinned) = found.split_at(points.iter().filter(|point| point.1).count());
            both[0].merge(free);
            both[1].merge(pinned);
        }
    }

    /// Samples at κ, whether the string starts free being told with it.
    fn count_at(&self, points: &[(f64, bool)]) -> Vec<Sample> {
        let mut found = Vec::with_capacity(points.len());
        for chunk in points.chunks(LANES) {
            let point = |i: usize| chunk[i.min(chunk.len() - 1)];
            let kappa = lanes(|i| point(i).0);
            let [pinned, free] = self.counts(&std::array::from_fn(|i| point(i).1), &kappa);
            let sample = |i: usize| Sample { kappa: kappa[i], counts: [pinned[i] as u64, free[i] as u64] };
            found.extend((0..chunk.len()).map(sample));
        }
        found
    }
}

impl Samples {
    /// Adds points that cut the intervals with several eigenvalues of a problem, one of them wanted, evenly in √κ.
    fn cut(&self, wanted: &Wanted, least_width: f64, points: &mut Vec<(f64, bool)>) {
        let mut open = Vec::new();
        for pair in self.list.windows(2) {
            let [inside, asked] =
                [pair[0].inside(&pair[1], wanted, true), pair[0].inside(&pair[1], wanted, false)];
            if asked > 1 && pair[1].kappa - pair[0].kappa >= least_width * pair[1].kappa {
                open.push((pair[0].kappa.sqrt(), pair[1].kappa.sqrt(), inside.min(MOST)));
            }
        }
        let least = (LANES / open.len().max(1)) as u64;
        for (from, to, count) in open {
            let n = count.max(least);
            let step = (to - from) / (n + 1) as f64;
            for k in 1..=n {
                let root = from + step * k as f64;
                points.push((root * root, self.starts_free));
            }
        }
    }

    /// Takes in more samples, in increasing order of κ.
    fn merge(&mut self, more: &[Sample]) {
        let mut all = Vec::with_capacity(self.list.len() + more.len());
        let mut more = more.iter().peekable();
        for sample in &self.list {
            while let Some(&earlier) = more.next_if(|other| other.kappa < sample.kappa) {
                all.push(earlier);
            }
            all.push(*sample);
        }
        all.extend(more);
        self.list = all;
    }

    /// The wanted eigenvalues that are alone.
    pub fn brackets(&self, wanted: &Wanted) -> Vec<Bracket> {
        let mut alone = Vec::with_capacity(self.list.len());
        for (end, entry) in Entry::starting(self.starts_free).into_iter().enumerate() {
            let Some((first, last)) = wanted[end] else { continue };
            for pair in self.list.windows(2) {
                let (before, index) = (pair[0].counts[end], pair[1].counts[end]);
                if before + 1 == index && first <= index && index <= last {
                    let index = index as usize;
                    alone.push(Bracket { entry, index, lo: pair[0].kappa, hi: pair[1].kappa });
                }
            }
        }
        alone
    }

    /// The interval between two samples where one eigenvalue lies by the counts, perhaps with others.
    pub fn around(&self, end: usize, index: u64) -> Option<(f64, f64)> {
        let holds = |pair: &&[Sample]| pair[0].counts[end] < index && index <= pair[1].counts[end];
        self.list.windows(2).find(holds).map(|pair| (pair[0].kappa, pair[1].kappa))
    }
}
