//! Eigenvalues one by one: isolated by Sturm counts, improved by Newton's method, certified by Rayleigh quotients.

use std::ops::RangeInclusive;

use super::isolate::{Bracket, Wanted};
use super::lanes::LANES;
use super::locate::{Problems, Workspace};
use super::mode::{Bounds, Proofs};
use super::string::{Entry, HalfString};
use super::sturm::Targets;

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

/// Halvings for one eigenvalue before more bits are called.
const ROUNDS: u32 = 60;

/// Halvings between two attempts.
const HALVINGS: u32 = 4;

/// A relative uncertainty that hardly ever shows in a double: below it an enclosure is as narrow as doubles get.
const NEGLIGIBLE: f64 = 1e-17;

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
        let bounds = |entry: Entry| range(entry).map(|range| (*range.start() as u64, *range.end() as u64));
        let asked: [Wanted; 2] = [true, false].map(|free| Entry::starting(free).map(bounds));
        let mut tasks = Vec::new();
        for (samples, asked) in self.sample(&asked).iter().zip(&asked) {
            tasks.extend(samples.brackets(asked).into_iter().map(Task::new));
        }
        let mut found =
            Entry::ALL.map(|entry| vec![None; range(entry).map_or(0, |range| range.clone().count())]);
        Search { string: self, space }.run(tasks, |edge| {
            let first = range(edge.entry).map_or(1, |range| *range.start());
            found[edge.entry as usize][edge.index - first] = Some(edge);
        });
        found
    }

    /// An interval of s that holds no other eigenvalue of the problem than this one, by counts in doubles: the one
    /// before lies below lo (1 + η), the one after above hi (1 − η). Whether it holds this one, signs must tell.
    pub fn bracket(&self, entry: Entry, index: usize) -> Option<(f64, f64)> {
        let wanted = entry.alone(index);
        let samples = self.sample(&wanted);
        let bracket =
            samples.iter().zip(&wanted).find_map(|(samples, asked)| samples.brackets(asked).pop())?;
        let slack = 2.0 * self.eta() + 4.0 * f64::EPSILON;
        Some((bracket.lo * (1.0 + slack) * self.ticks, bracket.hi * (1.0 - slack) * self.ticks))
    }

    /// An interval of s in which the eigenvalue lies, perhaps with others.
    pub fn cluster(&self, entry: Entry, index: usize) -> Option<(f64, f64)> {
        let samples = &self.sample(&entry.alone(index))[usize::from(!entry.starts_free())];
        let (lo, hi) = samples.around(usize::from(entry.ends_free()), index as u64)?;
        let slack = 2.0 * self.eta() + 4.0 * f64::EPSILON;
        Some((lo * (1.0 - slack) * self.ticks, hi * (1.0 + slack) * self.ticks))
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
    at: u32,
    /// Halvings done.
    rounds: u32,
    /// The last proof's radius: a wider enclosure is better than none where another trial gains no more.
    radius: f64,
}

impl Task {
    fn new(bracket: Bracket) -> Task {
        let inner = (bracket.lo, bracket.hi);
        Task { bracket, inner, kappa: 0.0, at: 0, rounds: 0, radius: f64::INFINITY }
    }

    fn edge(&self, lo: f64, hi: f64) -> Edge {
        Edge { entry: self.bracket.entry, index: self.bracket.index, lo, hi }
    }
}

/// The tasks by the node where the mode lives, else in their order.
fn by_place(tasks: &[Task], nodes: usize) -> Vec<Task> {
    let mut places = vec![0; nodes + 1];
    tasks.iter().for_each(|task| places[task.at as usize + 1] += 1);
    (0..nodes).for_each(|at| places[at + 1] += places[at]);
    let mut sorted = tasks.to_vec();
    for task in tasks {
        let place = &mut places[task.at as usize];
        sorted[*place] = *task;
        *place += 1;
    }
    sorted
}

/// A number of each task, the last one's repeated in the lanes left over.
fn each<T: Copy>(batch: &[Task], number: impl Fn(&Task) -> T) -> [T; LANES] {
    let mut all = [number(&batch[batch.len() - 1]); LANES];
    all.iter_mut().zip(batch).for_each(|(lane, task)| *lane = number(task));
    all
}

fn problems(batch: &[Task]) -> Problems {
    Problems {
        kappa: each(batch, |task| task.kappa),
        starts_free: each(batch, |task| f64::from(u8::from(task.bracket.entry.starts_free()))),
        ends_free: each(batch, |task| f64::from(u8::from(task.bracket.entry.ends_free()))),
    }
}

struct Search<'a> {
    string: &'a HalfString,
    space: &'a mut Workspace,
}

impl Search<'_> {
    /// Halves the brackets, finds out where the modes live, and proves them; what fails, again.
    fn run(&mut self, mut tasks: Vec<Task>, mut found: impl FnMut(Edge)) {
        while !tasks.is_empty() {
            self.narrow(&mut tasks);
            self.locate(&mut tasks);
            // Modes that live side by side are followed side by side.
            tasks = self.prove(&by_place(&tasks, self.string.nodes.len()), &mut found);
            tasks.retain(|task| task.rounds < ROUNDS);
        }
    }

    /// What is left: κ was not near enough.
    fn prove(&self, tasks: &[Task], found: &mut impl FnMut(Edge)) -> Vec<Task> {
        let mut failed = Vec::new();
        for batch in tasks.chunks(LANES) {
            let Proofs { edge: [lo, hi], radius, quotient } = self.proofs(batch);
            for (i, task) in batch.iter().enumerate() {
                if radius[i] <= NEGLIGIBLE || (radius[i] <= TOLERABLE && radius[i] > 0.1 * task.radius) {
                    found(task.edge(lo[i], hi[i]));
                } else {
                    failed.push(Task { radius: radius[i], kappa: quotient[i], ..*task });
                }
            }
        }
        failed
    }

    fn proofs(&self, batch: &[Task]) -> Proofs {
        let inner = [each(batch, |task| task.inner.0), each(batch, |task| task.inner.1)];
        let eta = 2.0 * self.string.eta();
        let below = each(batch, |task| task.bracket.lo * (1.0 + eta));
        let above = each(batch, |task| task.bracket.hi * (1.0 - eta));
        let bounds = Bounds { inner, others: [below, above] };
        self.string.prove(&problems(batch), &bounds, &each(batch, |task| f64::from(task.at)))
    }

    /// Where the modes live.
    fn locate(&mut self, tasks: &mut [Task]) {
        for batch in tasks.chunks_mut(LANES) {
            let places = self.string.locate(&problems(batch), self.space);
            batch.iter_mut().zip(places).for_each(|(task, at)| task.at = at as u32);
        }
    }

    /// Halves the inner brackets.
    fn narrow(&self, tasks: &mut [Task]) {
        for batch in tasks.chunks_mut(LANES) {
            let Problems { starts_free, ends_free, .. } = problems(batch);
            let inside = [each(batch, |task| task.inner.0), each(batch, |task| task.inner.1)];
            let index = each(batch, |task| task.bracket.index as f64);
            let [lo, hi] = self.string.narrow(&Targets { starts_free, ends_free, index, inside }, HALVINGS);
            for (i, task) in batch.iter_mut().enumerate() {
                task.inner = (lo[i], hi[i]);
                // A mode that proves something is a better guess.
                let keeps = task.radius < f64::INFINITY && lo[i] < task.kappa && task.kappa < hi[i];
                task.kappa = if keeps { task.kappa } else { 0.5 * (lo[i] + hi[i]) };
                task.rounds += HALVINGS;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::rational::ratio;
    use crate::verdict::instructions::Instructions;

    #[test]
    fn every_instruction_set_finds_the_same_edges() {
        let rhos = [ratio(1, 1000), ratio(1, 25), ratio(1, 2), ratio(40, 1)];
        let ratios = super::super::survey::ratios(14).into_iter().chain([(23, 20), (5, 31), (61, 38)]);
        for ((p, q), rho) in ratios.flat_map(|pair| rhos.iter().map(move |rho| (pair, rho))) {
            let edges = |instructions: Instructions| {
                let mut string = HalfString::new(p, q, rho).unwrap();
                string.instructions = instructions;
                let wanted =
                    Entry::ALL.map(|entry| string.dimension(entry)).map(|n| (n > 0).then_some(1..=n));
                string.eigenvalues(&wanted, &mut Workspace::default())
            };
            let portable = edges(Instructions::Portable);
            assert!(Instructions::available().all(|set| edges(set) == portable));
        }
    }

    #[test]
    fn counts_far_above_all_eigenvalues_are_complete() {
        // Four hundred nodes, each of which multiplies x by up to 1e15 at this κ: no product may overflow.
        let string = HalfString::new(1, 801, &ratio(1_000_000_000, 1)).unwrap();
        let kappa = [1e9 * string.upper_bound; LANES];
        for starts_free in [true, false] {
            let counts = string.counts(&[starts_free; LANES], &kappa);
            for (entry, count) in Entry::starting(starts_free).into_iter().zip(counts) {
                assert_eq!(count, [string.dimension(entry) as f64; LANES]);
            }
        }
    }
}
