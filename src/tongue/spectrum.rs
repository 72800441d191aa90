//! Eigenvalues one by one: isolated by Sturm counts, improved by Newton's method, certified by Rayleigh quotients.

use std::ops::RangeInclusive;

use super::isolate::{Bracket, Wanted};
use super::lanes::{LANES, Lanes, lanes};
use super::locate::{Problems, Workspace};
use super::mode::Mode;
use super::string::{Entry, HalfString};
use super::twofold::Twofold;

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

/// Newton's steps and halvings for one eigenvalue before more bits are called.
const ROUNDS: u32 = 60;

/// Newton's steps that may follow one another before the bracket is halved: as a rule four are enough.
const PATIENCE: u32 = 8;

/// A step shorter than this part of the distance to the neighbours is the last: what is left is about its square.
const CLOSE: f64 = 1e-4;

/// A relative uncertainty that hardly ever shows in a double: below it an enclosure is as narrow as doubles get.
const NEGLIGIBLE: f64 = 1e-17;

/// Proofs tried before a wider enclosure is better than none.
const TRIALS: u32 = 3;

/// One of a few units in the last place: what strings of many thousand masses allow in doubles.
const TOLERABLE: f64 = 1e-15;

impl HalfString {
    /// The eigenvalues with the given indices, by entry; `None` where doubles cannot certify one.
    pub fn eigenvalues(
        &self,
        wanted: &[Option<RangeInclusive<usize>>; 4],
        space: &mut Workspace,
    ) -> [Vec<Option<Edge>>; 4] {
        let range = |entry: Entry| wanted[entry as usize].as_ref();
        let mut tasks = Vec::new();
        for starts_free in [true, false] {
            let two: Wanted = Entry::starting(starts_free)
                .map(|entry| range(entry).map(|range| (*range.start() as u64, *range.end() as u64)));
            if two.iter().any(Option::is_some) {
                tasks.extend(self.sample(starts_free, &two).brackets(&two).map(Task::new));
            }
        }
        let mut found = Entry::ALL.map(|entry| vec![None; range(entry).map_or(0, |range| range.clone().count())]);
        let mut search = Search { string: self, space, moving: Vec::new(), near: Vec::new(), astray: Vec::new() };
        search.run(tasks, |edge| {
            let first = range(edge.entry).map_or(1, |range| *range.start());
            found[edge.entry as usize][edge.index - first] = Some(edge);
        });
        found
    }

    /// An interval of s that holds no other eigenvalue of the problem than this one, by counts in doubles: the one
    /// before lies below lo (1 + η), the one after above hi (1 − η). Whether it holds this one, signs must tell.
    pub fn bracket(&self, entry: Entry, index: usize) -> Option<(f64, f64)> {
        let wanted = entry.alone(index);
        let bracket = self.sample(entry.starts_free(), &wanted).brackets(&wanted).next()?;
        let slack = 2.0 * self.eta() + 4.0 * f64::EPSILON;
        Some((bracket.lo * (1.0 + slack) * self.ticks, bracket.hi * (1.0 - slack) * self.ticks))
    }

    /// An interval of s in which the eigenvalue lies, perhaps with others.
    pub fn cluster(&self, entry: Entry, index: usize) -> Option<(f64, f64)> {
        let samples = self.sample(entry.starts_free(), &entry.alone(index));
        let (lo, hi) = samples.around(usize::from(entry.ends_free()), index as u64)?;
        let slack = 2.0 * self.eta() + 4.0 * f64::EPSILON;
        Some((lo * (1.0 - slack) * self.ticks, hi * (1.0 + slack) * self.ticks))
    }

    /// The theorems of [`super::mode`] and [`super::sturm`] together.
    fn certified(&self, bracket: &Bracket, mode: &Mode, tolerance: f64) -> Option<Edge> {
        let (mu, eta) = (mode.quotient.hi, 2.0 * self.eta());
        // What the quotient's own uncertainty takes from the distances.
        let own = 2.0 * (mode.error + f64::EPSILON * mu);
        let down = mu - own - bracket.lo * (1.0 + eta);
        let up = bracket.hi * (1.0 - eta) - own - mu;
        let inside = mode.residual < down && mode.residual < up;
        let radius = 1.01 * mode.residual * (mode.residual / down.min(up)) + 1.01 * mode.error;
        if !inside || radius > tolerance * mu {
            return None;
        }
        let ticks = Twofold { hi: self.ticks, lo: 0.0 };
        let (lo, hi) = mode.quotient.times(ticks).around(1.01 * radius * self.ticks);
        Some(Edge { entry: bracket.entry, index: bracket.index, lo, hi })
    }
}

/// One eigenvalue being looked for.
#[derive(Clone, Copy, Debug)]
struct Task {
    /// What the counts say: it bounds the neighbours.
    bracket: Bracket,
    /// The part of the bracket where the eigenvalue is.
    inner: (f64, f64),
    kappa: f64,
    /// The node where the mode lives.
    at: f64,
    rounds: u32,
    /// Proofs tried.
    trials: u32,
}

impl Task {
    fn new(bracket: Bracket) -> Task {
        let inner = (bracket.lo, bracket.hi);
        Task { bracket, inner, kappa: middle(inner), at: 0.0, rounds: 0, trials: 0 }
    }
}

/// The middle in √κ.
fn middle((lo, hi): (f64, f64)) -> f64 {
    (0.5 * (lo.sqrt() + hi.sqrt())).powi(2)
}

/// The last one repeated in the lanes left over.
fn problems(batch: &[Task]) -> Problems {
    let task = |i: usize| &batch[i.min(batch.len() - 1)];
    Problems {
        kappa: lanes(|i| task(i).kappa),
        starts_free: std::array::from_fn(|i| task(i).bracket.entry.starts_free()),
        ends_free: std::array::from_fn(|i| task(i).bracket.entry.ends_free()),
    }
}

fn places(batch: &[Task]) -> Lanes {
    lanes(|i| batch[i.min(batch.len() - 1)].at)
}

/// Tasks by what is to be done with them next.
struct Search<'a> {
    string: &'a HalfString,
    space: &'a mut Workspace,
    moving: Vec<Task>,
    near: Vec<Task>,
    astray: Vec<Task>,
}

impl Search<'_> {
    fn run(&mut self, mut fresh: Vec<Task>, mut found: impl FnMut(Edge)) {
        while !fresh.is_empty() {
            self.locate(&mut fresh);
            self.moving = fresh;
            while !(self.moving.is_empty() && self.near.is_empty()) {
                self.improve();
                self.certify(&mut found);
            }
            fresh = self.halve();
        }
    }

    /// Where the modes live; tasks with neighbouring places go side by side.
    fn locate(&mut self, fresh: &mut [Task]) {
        for batch in fresh.chunks_mut(LANES) {
            let places = self.string.locate(&problems(batch), self.space);
            batch.iter_mut().zip(places).for_each(|(task, at)| task.at = at);
        }
        fresh.sort_by(|a, b| a.at.total_cmp(&b.at));
    }

    /// Newton's steps until all are near or astray.
    fn improve(&mut self) {
        while !self.moving.is_empty() {
            let tasks = std::mem::take(&mut self.moving);
            for batch in tasks.chunks(LANES) {
                let steps = self.string.newton(&problems(batch), &places(batch));
                for (&task, next) in batch.iter().zip(steps) {
                    self.sort_in(task, next);
                }
            }
        }
    }

    fn sort_in(&mut self, mut task: Task, next: f64) {
        let step = (next - task.kappa).abs();
        let distance = (next - task.bracket.lo).min(task.bracket.hi - next);
        task.rounds += 1;
        // NaN is astray too.
        if !(task.inner.0 < next && next < task.inner.1) || task.rounds.is_multiple_of(PATIENCE) {
            return self.astray.push(task);
        }
        task.kappa = next;
        if step <= CLOSE * distance { self.near.push(task) } else { self.moving.push(task) }
    }

    /// Modes of those that are near; one that does not prove enough takes its quotient for a further step.
    fn certify(&mut self, found: &mut impl FnMut(Edge)) {
        for batch in std::mem::take(&mut self.near).chunks(LANES) {
            let modes = self.string.modes(&problems(batch), &places(batch));
            for (&(mut task), mode) in batch.iter().zip(modes) {
                task.trials += 1;
                let tolerance = if task.trials < TRIALS { NEGLIGIBLE } else { TOLERABLE };
                match self.string.certified(&task.bracket, &mode, tolerance) {
                    Some(edge) => found(edge),
                    None => self.sort_in(task, mode.quotient.hi),
                }
            }
        }
    }

    /// Halves the brackets of those that went astray; gives up those that did so too often.
    fn halve(&mut self) -> Vec<Task> {
        let mut tasks = std::mem::take(&mut self.astray);
        tasks.retain(|task| task.rounds < ROUNDS);
        for batch in tasks.chunks_mut(LANES) {
            let cuts = lanes(|i| middle(batch[i.min(batch.len() - 1)].inner));
            for starts_free in [true, false] {
                if batch.iter().all(|task| task.bracket.entry.starts_free() != starts_free) {
                    continue;
                }
                let counts = self.string.counts(starts_free, &cuts);
                for (task, (cut, counts)) in batch.iter_mut().zip(cuts.into_iter().zip(counts)) {
                    if task.bracket.entry.starts_free() == starts_free {
                        task.halve(cut, counts[usize::from(task.bracket.entry.ends_free())]);
                    }
                }
            }
        }
        tasks
    }
}

impl Task {
    fn halve(&mut self, cut: f64, count: u64) {
        if count < self.bracket.index as u64 { self.inner.0 = cut } else { self.inner.1 = cut }
        self.kappa = middle(self.inner);
    }
}
