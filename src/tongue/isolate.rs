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
    /// The intervals to cut, from below.
    open: Vec<Open>,
}

/// An interval between two samples with several eigenvalues of a problem, one of them wanted.
#[derive(Clone, Copy)]
struct Open {
    /// The sample below, as a position in the list.
    from: usize,
    /// In so many points it is cut.
    cuts: u64,
}

/// At most so many points in an interval at a time.
const MOST: u64 = 64;

/// Where to count.
#[derive(Default)]
struct Points {
    kappa: Vec<f64>,
    starts_free: Vec<bool>,
}

impl HalfString {
    /// Counts until all wanted eigenvalues are alone between two samples, or counts in doubles cannot tell them apart;
    /// for the problems that start free and those that start pinned.
    pub fn sample(&self, wanted: &[Wanted; 2]) -> [Samples; 2] {
        let least_width = 16.0 * self.eta();
        let mut both =
            [true, false].map(|free| Samples::new(self, free, &wanted[usize::from(!free)], least_width));
        let (mut points, mut found) = (Points::default(), Vec::new());
        loop {
            points.kappa.clear();
            points.starts_free.clear();
            both.iter_mut().for_each(|samples| samples.cut(&mut points));
            if points.kappa.is_empty() {
                return both;
            }
            self.count_at(&points, &mut found);
            let mut rest = found.as_slice();
            for (samples, wanted) in both.iter_mut().zip(wanted) {
                rest = samples.merge(rest, wanted, least_width);
            }
        }
    }

    /// The samples at the points.
    fn count_at(&self, points: &Points, found: &mut Vec<Sample>) {
        found.clear();
        let filled = |x: &[f64]| lanes(|i| x[i.min(x.len() - 1)]);
        for (kappa, starts_free) in points.kappa.chunks(LANES).zip(points.starts_free.chunks(LANES)) {
            let last = starts_free.len() - 1;
            let starts_free = std::array::from_fn(|i| starts_free[i.min(last)]);
            let [pinned, free] = self.counts(&starts_free, &filled(kappa));
            let sample = |i: usize| Sample { kappa: kappa[i], counts: [pinned[i] as u64, free[i] as u64] };
            found.extend((0..kappa.len()).map(sample));
        }
    }
}

impl Samples {
    /// All eigenvalues in one interval.
    fn new(string: &HalfString, starts_free: bool, wanted: &Wanted, least_width: f64) -> Self {
        let counts = Entry::starting(starts_free).map(|entry| string.dimension(entry) as u64);
        let zero = Sample { kappa: 0.0, counts: [0, 0] };
        let list = vec![zero, Sample { kappa: string.upper_bound, counts }];
        let mut samples = Samples { starts_free, list, open: Vec::new() };
        samples.open.extend(samples.open_below(1, wanted, least_width));
        samples
    }

    /// The interval below a sample, if it is to be cut.
    fn open_below(&self, upper: usize, wanted: &Wanted, least_width: f64) -> Option<Open> {
        let (lower, upper) = (&self.list[upper - 1], &self.list[upper]);
        let wide = upper.kappa - lower.kappa >= least_width * upper.kappa;
        let open = lower.inside(upper, wanted, false) > 1 && wide;
        let cuts = lower.inside(upper, wanted, true).min(MOST);
        open.then_some(Open { from: self.list.len() - 2, cuts })
    }

    /// Adds points that cut the open intervals evenly in √κ.
    fn cut(&mut self, points: &mut Points) {
        let least = (LANES / self.open.len().max(1)) as u64;
        for Open { from, cuts } in &mut self.open {
            let [lower, upper] = [self.list[*from], self.list[*from + 1]].map(|sample| sample.kappa.sqrt());
            *cuts = least.max(*cuts);
            let step = (upper - lower) / (*cuts + 1) as f64;
            points.kappa.extend((1..=*cuts).map(|k| {
                let root = lower + step * k as f64;
                root * root
            }));
        }
        points.starts_free.resize(points.kappa.len(), self.starts_free);
    }

    /// Takes in the samples at the points of the open intervals; what is left are the others.
    fn merge<'a>(&mut self, mut more: &'a [Sample], wanted: &Wanted, least_width: f64) -> &'a [Sample] {
        let cuts = self.open.iter().map(|open| open.cuts as usize).sum::<usize>();
        let room = Vec::with_capacity(self.list.len() + cuts);
        let list = std::mem::replace(&mut self.list, room);
        let open = std::mem::take(&mut self.open);
        let mut done = 0;
        for Open { from, cuts } in open {
            self.list.extend_from_slice(&list[done..=from]);
            let (inner, rest) = more.split_at(cuts as usize);
            for &sample in inner.iter().chain([&list[from + 1]]) {
                self.list.push(sample);
                let open = self.open_below(self.list.len() - 1, wanted, least_width);
                self.open.extend(open);
            }
            (more, done) = (rest, from + 2);
        }
        self.list.extend_from_slice(&list[done..]);
        more
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
