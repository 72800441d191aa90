//! Eigenvalues one by one: isolated by Sturm counts, improved and certified by Rayleigh quotients.

use std::ops::RangeInclusive;

use super::mode::{Mode, Workspace};
use super::string::{Entry, HalfString};
use super::sturm::{LANES, Lanes, lanes};

/// An edge of a tongue: the `index`-th positive zero of an entry, in an interval that holds no other zero of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    pub entry: Entry,
    /// 1, 2, ... from below.
    pub index: usize,
    /// The enclosure of s = h1² L1.
    pub lo: f64,
    pub hi: f64,
}

/// An interval of κ in which a problem has, by computed counts, the eigenvalues `below` + 1 ..= `upto`.
#[derive(Clone, Copy, Debug)]
struct Bracket {
    lo: f64,
    hi: f64,
    below: u64,
    upto: u64,
}

/// Rounds of Rayleigh quotient iteration and halvings for one eigenvalue before more bits are called.
const ROUNDS: u32 = 60;

/// Quotients that may follow one another before the bracket is halved: they converge cubically or not at all.
const PATIENCE: u32 = 6;

/// A quotient that moved by less than this part of its distance to the neighbours is close: its own error is
/// about the cube of that.
const CLOSE: f64 = 1e-4;

/// An uncertainty of the quotient that no double shows.
const NEGLIGIBLE: f64 = 1e-18;

impl HalfString {
    /// The eigenvalues with the given indices, `None` where doubles cannot certify one.
    pub fn eigenvalues(
        &self,
        entry: Entry,
        wanted: RangeInclusive<usize>,
        space: &mut Workspace,
    ) -> Vec<Option<Edge>> {
        let first = *wanted.start();
        let mut found = vec![None; wanted.end() + 1 - first];
        let brackets = self.isolate(entry, &wanted, false);
        let mut search =
            Search { string: self, entry, space, tasks: brackets.into_iter().map(Task::new).collect() };
        search.run(|edge: Edge| found[edge.index - first] = Some(edge));
        found
    }

    /// An interval of s that holds no other eigenvalue of the problem than this one, by counts in doubles: the one
    /// before lies below lo (1 + η), the one after above hi (1 − η). Whether it holds this one, signs must tell.
    pub fn bracket(&self, entry: Entry, index: usize) -> Option<(f64, f64)> {
        self.around(entry, index, true)
    }

    /// An interval of s in which the eigenvalue lies, perhaps with others.
    pub fn cluster(&self, entry: Entry, index: usize) -> Option<(f64, f64)> {
        self.around(entry, index, false)
    }

    fn around(&self, entry: Entry, index: usize, alone: bool) -> Option<(f64, f64)> {
        let parts = self.isolate(entry, &(index..=index), !alone);
        let found = parts.into_iter().find(|part| part.below < index as u64 && index as u64 <= part.upto)?;
        let slack = (2.0 * self.eta() + 4.0 * f64::EPSILON) * if alone { 1.0 } else { -1.0 };
        Some((found.lo * (1.0 + slack) * self.ticks, found.hi * (1.0 - slack) * self.ticks))
    }

    /// Brackets of one eigenvalue each, for all wanted ones that counts in doubles can tell apart.
    ///
    /// `clusters`: those that they cannot tell apart too, together.
    fn isolate(&self, entry: Entry, wanted: &RangeInclusive<usize>, clusters: bool) -> Vec<Bracket> {
        let upto = self.dimension(entry) as u64;
        let mut open = vec![Bracket { lo: 0.0, hi: self.upper_bound(), below: 0, upto }];
        let mut isolated = Vec::new();
        while !open.is_empty() {
            let cuts: Vec<Vec<f64>> = open.iter().map(|bracket| bracket.cuts(LANES / open.len())).collect();
            let points: Vec<f64> = cuts.iter().flatten().copied().collect();
            let counts: Vec<u64> = points
                .chunks(LANES)
                .flat_map(|chunk| {
                    self.counts(entry, &lanes(|i| chunk[i.min(chunk.len() - 1)]))
                        .into_iter()
                        .take(chunk.len())
                })
                .collect();
            let mut next = Vec::new();
            let mut at = 0;
            for (bracket, cuts) in open.iter().zip(&cuts) {
                let known = points[at..at + cuts.len()].iter().copied().zip(counts[at..].iter().copied());
                at += cuts.len();
                for part in bracket.parts(known) {
                    let asked = part.below < *wanted.end() as u64 && part.upto >= *wanted.start() as u64;
                    match part.upto.saturating_sub(part.below) {
                        0 => {}
                        _ if !asked => {}
                        1 => isolated.push(part),
                        _ if part.hi - part.lo < 16.0 * self.eta() * part.hi => {
                            isolated.extend(clusters.then_some(part))
                        }
                        _ => next.push(part),
                    }
                }
            }
            open = next;
        }
        isolated
    }
}

impl Bracket {
    /// Points that cut the bracket evenly in √κ, one for each eigenvalue in it and at least `least`.
    fn cuts(&self, least: usize) -> Vec<f64> {
        let n = ((self.upto - self.below) as usize).min(64).max(least).max(1);
        let (from, to) = (self.lo.sqrt(), self.hi.sqrt());
        let point = |k: usize| (from + (to - from) * k as f64 / (n + 1) as f64).powi(2);
        (1..=n).map(point).collect()
    }

    /// The parts between neighbouring points.
    fn parts(self, points: impl Iterator<Item = (f64, u64)>) -> impl Iterator<Item = Bracket> {
        let end = (self.hi, self.upto);
        points.chain(std::iter::once(end)).scan((self.lo, self.below), |from, to| {
            let part = Bracket { lo: from.0, hi: to.0, below: from.1, upto: to.1 };
            *from = to;
            Some(part)
        })
    }
}

/// One eigenvalue being looked for.
#[derive(Clone, Copy, Debug)]
struct Task {
    /// What the counts say: it bounds the neighbours.
    bracket: Bracket,
    /// The part of the bracket where the eigenvalue is.
    inner: Bracket,
    kappa: f64,
    rounds: u32,
    /// The last quotient left the inner bracket, or there were too many: halve it first.
    astray: bool,
}

impl Task {
    fn new(bracket: Bracket) -> Task {
        Task { bracket, inner: bracket, kappa: middle(&bracket), rounds: 0, astray: false }
    }
}

/// Takes up to [`LANES`] tasks off the list.
fn next_batch(tasks: &mut Vec<Task>) -> Vec<Task> {
    tasks.split_off(tasks.len().saturating_sub(LANES))
}

/// The guesses of a batch, the last one repeated in the lanes left over.
fn guesses(batch: &[Task]) -> Lanes {
    lanes(|i| batch[i.min(batch.len() - 1)].kappa)
}

fn middle(bracket: &Bracket) -> f64 {
    (0.5 * (bracket.lo.sqrt() + bracket.hi.sqrt())).powi(2)
}

struct Search<'a> {
    string: &'a HalfString,
    entry: Entry,
    space: &'a mut Workspace,
    tasks: Vec<Task>,
}

impl Search<'_> {
    /// Works on up to [`LANES`] tasks at a time: first brings them near, then certifies them.
    fn run(&mut self, mut found: impl FnMut(Edge)) {
        let mut near = Vec::with_capacity(self.tasks.len());
        while !self.tasks.is_empty() {
            let mut batch = next_batch(&mut self.tasks);
            self.halve(&mut batch);
            let quotients = self.space.quotients(self.string, self.entry, &guesses(&batch));
            for (mut task, mu) in batch.into_iter().zip(quotients) {
                let shift = (mu - task.kappa).abs();
                task.follow(mu);
                let distance = (mu - task.bracket.lo).min(task.bracket.hi - mu);
                let close = !task.astray && shift <= CLOSE * distance;
                if close || task.rounds >= ROUNDS { near.push(task) } else { self.tasks.push(task) }
            }
        }
        while !near.is_empty() {
            let batch = next_batch(&mut near);
            let modes = self.space.modes(self.string, self.entry, &guesses(&batch));
            for (mut task, mode) in batch.into_iter().zip(modes) {
                task.follow(mode.quotient.hi);
                match self.certified(&task.bracket, &mode) {
                    Some(edge) => found(edge),
                    None if task.rounds < ROUNDS => near.push(task),
                    None => {}
                }
            }
        }
    }

    /// Halves the brackets of the tasks that went astray.
    fn halve(&self, batch: &mut [Task]) {
        if batch.iter().all(|task| !task.astray) {
            return;
        }
        let kappa = lanes(|i| middle(&batch[i.min(batch.len() - 1)].inner));
        let counts = self.string.counts(self.entry, &kappa);
        for (task, (kappa, count)) in batch.iter_mut().zip(kappa.into_iter().zip(counts)) {
            if task.astray {
                let inner = &mut task.inner;
                if count <= inner.below {
                    inner.lo = kappa
                } else {
                    inner.hi = kappa
                }
                task.kappa = middle(inner);
            }
        }
    }

    /// The theorems of [`super::mode`] and [`super::sturm`] together: eigenvalue `below` lies below lo (1 + η),
    /// eigenvalue `below` + 2 above hi (1 − η).
    fn certified(&self, bracket: &Bracket, mode: &Mode) -> Option<Edge> {
        let (mu, eta) = (mode.quotient.hi, self.string.eta());
        // What the quotient's own uncertainty takes from the distances.
        let own = 2.0 * (mode.relative + f64::EPSILON) * mu;
        let (alpha, beta) = (bracket.lo * (1.0 + 2.0 * eta), bracket.hi * (1.0 - 2.0 * eta));
        let (down, up) = (mu - own - alpha, beta - own - mu);
        let inside = mode.residual < down && mode.residual < up;
        let radius = 1.01 * mode.residual * (mode.residual / down.min(up)) + 1.01 * mode.relative * mu;
        if !inside || radius > (NEGLIGIBLE * mu).max(1.02 * mode.relative * mu) {
            return None;
        }
        let ticks = super::twofold::Twofold { hi: self.string.ticks, lo: 0.0 };
        let (lo, hi) = mode.quotient.times(ticks).around(1.01 * radius * self.string.ticks);
        Some(Edge { entry: self.entry, index: bracket.upto as usize, lo, hi })
    }
}

impl Task {
    /// Takes the quotient as the next guess where it stays inside the bracket.
    fn follow(&mut self, mu: f64) {
        self.rounds += 1;
        self.astray = !(self.inner.lo < mu && mu < self.inner.hi) || self.rounds.is_multiple_of(PATIENCE);
        self.kappa = mu;
    }
}
