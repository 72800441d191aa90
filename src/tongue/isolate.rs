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

/// Samples in increasing order of κ, dense enough to tell the wanted eigenvalues apart.
pub(super) struct Samples {
    starts_free: bool,
    list: Vec<Sample>,
}

/// At most so many points in an interval at a time.
const MOST: u64 = 64;

impl HalfString {
    /// Counts until all wanted eigenvalues are alone between two samples, or counts in doubles cannot tell them apart.
    pub fn sample(&self, starts_free: bool, wanted: &Wanted) -> Samples {
        let ends = Entry::starting(starts_free).map(|entry| self.dimension(entry) as u64);
        let zero = Sample { kappa: 0.0, counts: [0, 0] };
        let top = Sample { kappa: self.upper_bound, counts: ends };
        let mut samples = Samples { starts_free, list: vec![zero, top] };
        loop {
            let points = samples.cuts(wanted, 16.0 * self.eta());
            if points.is_empty() {
                return samples;
            }
            let mut found = Vec::with_capacity(points.len());
            for chunk in points.chunks(LANES) {
                let kappa = lanes(|i| chunk[i.min(chunk.len() - 1)]);
                let [pinned, free] = self.counts(&[starts_free; LANES], &kappa);
                let sample =
                    |i: usize| Sample { kappa: kappa[i], counts: [pinned[i] as u64, free[i] as u64] };
                found.extend((0..chunk.len()).map(sample));
            }
            samples.list = merged(&samples.list, &found);
        }
    }
}

/// Two sorted lists as one.
fn merged(a: &[Sample], b: &[Sample]) -> Vec<Sample> {
    let mut all = Vec::with_capacity(a.len() + b.len());
    let mut later = b.iter().peekable();
    for sample in a {
        while let Some(&other) = later.next_if(|other| other.kappa < sample.kappa) {
            all.push(other);
        }
        all.push(*sample);
    }
    all.extend(later);
    all
}

impl Samples {
    /// Points that cut the intervals with several eigenvalues of a problem, one of them wanted, evenly in √κ.
    fn cuts(&self, wanted: &Wanted, least_width: f64) -> Vec<f64> {
        let mut open = Vec::new();
        for pair in self.list.windows(2) {
            let inside = |e: usize| pair[1].counts[e].saturating_sub(pair[0].counts[e]);
            let asked = |e: usize| {
                let (from, upto) = (pair[0].counts[e], pair[1].counts[e]);
                inside(e) > 1 && wanted[e].is_some_and(|(first, last)| from < last && first <= upto)
            };
            let (lo, hi) = (pair[0].kappa, pair[1].kappa);
            if (asked(0) || asked(1)) && hi - lo >= least_width * hi {
                open.push((lo.sqrt(), hi.sqrt(), inside(0).max(inside(1)).min(MOST)));
            }
        }
        let least = (LANES / open.len().max(1)) as u64;
        let mut points = Vec::new();
        for (from, to, count) in open {
            let n = count.max(least);
            points.extend((1..=n).map(|k| (from + (to - from) * k as f64 / (n + 1) as f64).powi(2)));
        }
        points
    }

    /// The wanted eigenvalues that are alone.
    pub fn brackets<'a>(&'a self, wanted: &'a Wanted) -> impl Iterator<Item = Bracket> + 'a {
        self.list.windows(2).flat_map(move |pair| {
            let alone = move |e: usize| {
                let (before, index) = (pair[0].counts[e], pair[1].counts[e]);
                let asked = wanted[e].is_some_and(|(first, last)| (first..=last).contains(&index));
                let entry = Entry::starting(self.starts_free)[e];
                (before + 1 == index && asked).then_some(Bracket {
                    entry,
                    index: index as usize,
                    lo: pair[0].kappa,
                    hi: pair[1].kappa,
                })
            };
            [alone(0), alone(1)].into_iter().flatten()
        })
    }

    /// The interval between two samples where one eigenvalue lies by the counts, perhaps with others.
    pub fn around(&self, end: usize, index: u64) -> Option<(f64, f64)> {
        let holds = |pair: &&[Sample]| pair[0].counts[end] < index && index <= pair[1].counts[end];
        self.list.windows(2).find(holds).map(|pair| (pair[0].kappa, pair[1].kappa))
    }
}
