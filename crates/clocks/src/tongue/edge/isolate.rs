//! Eigenvalues separated by counts.

use std::ops::RangeInclusive;

use super::count::{counts, uncertainty};
use crate::tongue::string::lanes::{LANES, lanes};
use crate::tongue::string::{Entry, HalfString, Indices};

/// κ and the computed counts there, of the four problems.
#[derive(Clone, Copy, Debug)]
struct Sample {
    kappa: f64,
    counts: [u32; 4],
}

/// An interval of κ between two samples.
#[derive(Clone, Copy, Debug)]
pub struct Interval {
    lower: Sample,
    upper: Sample,
}

impl Interval {
    /// κ at the ends.
    pub fn ends(&self) -> [f64; 2] {
        [self.lower.kappa, self.upper.kappa]
    }

    /// The index of a problem's last eigenvalue below the upper end, by the counts.
    #[inline(always)]
    pub fn upto(&self, entry: Entry) -> usize {
        self.upper.counts[entry as usize] as usize
    }

    /// The indices, by the counts, of a problem's eigenvalues inside.
    pub fn inside(&self, entry: Entry) -> RangeInclusive<usize> {
        let [from, upto] = [&self.lower, &self.upper].map(|sample| sample.counts[entry as usize] as usize);
        from + 1..=upto
    }

    /// The wanted eigenvalues inside, by the counts.
    #[inline(always)]
    fn contents(&self, limits: &Limits) -> Contents {
        // Numbers rather than branches: which problems have one is anybody's guess.
        let mut contents = Contents { most: 0, alone: 0 };
        for entry in 0..4 {
            let (from, upto) = (self.lower.counts[entry], self.upper.counts[entry]);
            let asked = (limits.last[entry] > from) & (limits.first[entry] <= upto);
            let inside = if asked { upto.saturating_sub(from) } else { 0 };
            contents.most = contents.most.max(inside);
            contents.alone |= u32::from(inside == 1) << entry;
        }
        contents
    }
}

/// The wanted eigenvalues that an interval holds, by its counts.
#[derive(Clone, Copy)]
pub(crate) struct Contents {
    /// The most eigenvalues of a problem.
    most: u32,
    /// A bit for each problem of which there is one: the eigenvalue before it lies below lo (1 + η), the one
    /// after above hi (1 − η).
    alone: u32,
}

impl Contents {
    /// The problems with a single eigenvalue inside.
    #[inline(always)]
    pub fn each_alone(&self, mut found: impl FnMut(Entry)) {
        let mut alone = self.alone;
        while alone != 0 {
            found(Entry::ALL[alone.trailing_zeros() as usize]);
            alone &= alone - 1;
        }
    }
}

/// The first and the last index wanted of each problem.
pub struct Limits {
    pub first: [u32; 4],
    pub last: [u32; 4],
}

impl Limits {
    pub fn new(wanted: &Indices) -> Self {
        let mut limits = Limits { first: [1; 4], last: [0; 4] };
        for (entry, range) in wanted.iter().enumerate() {
            if let Some(range) = range {
                (limits.first[entry], limits.last[entry]) = (*range.start() as u32, *range.end() as u32);
            }
        }
        limits
    }
}

/// Memory for the search.
#[derive(Debug, Default)]
pub(crate) struct Cutting {
    /// The intervals to cut, from below; those of the next round; in how many points they are cut; the
    /// points; what is found there.
    open: Vec<Interval>,
    next: Vec<Interval>,
    cuts: Vec<usize>,
    points: Vec<f64>,
    samples: Vec<Sample>,
}

/// At most so many points cut an interval at a time.
const POINTS_AT_A_TIME: usize = 64;

impl Cutting {
    /// Cuts the range of all eigenvalues until those wanted are alone, or counts in doubles cannot separate
    /// them, and shows each interval to `found`.
    pub fn isolate(
        &mut self,
        string: &HalfString,
        limits: &Limits,
        mut found: impl FnMut(&Interval, Contents),
    ) {
        let least_width = 16.0 * uncertainty(string);
        let counts = string.dimensions.map(|zeros| zeros as u32);
        let (zero, top) =
            (Sample { kappa: 0.0, counts: [0; 4] }, Sample { kappa: string.upper_bound, counts });
        self.open.clear();
        self.open.push(Interval { lower: zero, upper: top });
        while !self.open.is_empty() {
            self.cut(limits);
            self.count_at_points(string);
            let Cutting { open, next, cuts, samples, .. } = self;
            let mut samples = samples.as_slice();
            for (interval, &cuts) in open.iter().zip(&*cuts) {
                let (inner, after) = samples.split_at(cuts);
                let mut lower = interval.lower;
                for k in 0..=cuts {
                    let upper = *inner.get(k).unwrap_or(&interval.upper);
                    let piece = Interval { lower, upper };
                    let contents = piece.contents(limits);
                    if contents.most > 1 && upper.kappa - lower.kappa >= least_width * upper.kappa {
                        next.push(piece);
                    } else {
                        found(&piece, contents);
                    }
                    lower = upper;
                }
                samples = after;
            }
            std::mem::swap(&mut self.open, &mut self.next);
            self.next.clear();
        }
    }

    /// Points that cut the open intervals evenly in √κ: as many as there are eigenvalues inside, and as cost
    /// nothing more.
    fn cut(&mut self, limits: &Limits) {
        let Cutting { open, cuts, points, .. } = self;
        points.clear();
        cuts.clear();
        cuts.extend(
            open.iter().map(|interval| (interval.contents(limits).most as usize).min(POINTS_AT_A_TIME)),
        );
        let all: usize = cuts.iter().sum();
        let spare = all.next_multiple_of(LANES) - all;
        for (i, (interval, cuts)) in open.iter().zip(cuts).enumerate() {
            *cuts += (spare + i) / open.len();
            let (lower, upper) = (interval.lower.kappa.sqrt(), interval.upper.kappa.sqrt());
            let step = (upper - lower) / (*cuts + 1) as f64;
            for k in 1..=*cuts {
                let root = lower + step * k as f64;
                points.push(root * root);
            }
        }
    }

    /// The samples at the points.
    fn count_at_points(&mut self, string: &HalfString) {
        let Cutting { points, samples, .. } = self;
        samples.clear();
        for kappa in points.chunks(LANES) {
            let [a, b, c, d] = counts(string, &lanes(|i| kappa[i.min(kappa.len() - 1)]));
            for (i, &kappa) in kappa.iter().enumerate() {
                let counts = [a[i] as u32, b[i] as u32, c[i] as u32, d[i] as u32];
                samples.push(Sample { kappa, counts });
            }
        }
    }
}
