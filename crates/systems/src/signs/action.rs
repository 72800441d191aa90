//! The signs of the action: stability of large sparse systems without the half period.
//!
//! A path over the half period, a straight line for each degree of freedom between the kicks that touch it,
//! has the action
//!
//! ```text
//!     J[x] = Σ_i m_i Σ |Δx_i|²/Δt − Σ_kicks xᵀ k x,      half kicks at t = 0 and T/2.
//! ```
//!
//! J is a sparse matrix over the positions at kick times. `proofs/REGION.md`, sections 1, 3 and 5: for Σ
//! K_k > 0 the period is stable where J is positive definite on paths held at x = 0 at either end, the other
//! end free; and where it is so for one of the ends, and for the other it has a negative eigenvalue, the
//! period is hyperbolic. An entry of J is a few roundings from the data: no product of kicks, no norm of a
//! propagator enters the proof. Where some mode makes more than half a turn in a period, J is negative
//! whatever end is held; then the numbers of negative eigenvalues prove real multipliers off the circle.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use crate::half::compose::{Program, Row};
use crate::linear::frame::Frame;
use crate::linear::system::System;
use crate::signs::envelope::{Envelope, Sign, narrow};
use clocks::schedule::Weight;
use number::parallel::{both, map};
use number::to_f64;

/// Which ends of the paths are held at x = 0.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Held {
    Start,
    End,
    Both,
    Neither,
}

impl Held {
    fn start(self) -> bool {
        matches!(self, Held::Start | Held::Both)
    }

    fn end(self) -> bool {
        matches!(self, Held::End | Held::Both)
    }
}

/// Roundings in a term: mass and tick, their quotient, the coefficient of a kick.
const ROUNDINGS: usize = 4;

/// Whether the system is stable, as far as the signs of its action prove it; `None` where they do not, where
/// the mass matrix is not diagonal, and where elimination would cost more than n³ products.
pub fn is_stable(system: &System, frame: &Frame) -> Option<bool> {
    match signs(system)? {
        [Some(Sign::Positive), Some(Sign::Positive)] => is_total_definite(system, frame).then_some(true),
        [Some(Sign::Positive), Some(Sign::Negative)] | [Some(Sign::Negative), Some(Sign::Positive)] => {
            Some(false)
        }
        [Some(Sign::Negative), Some(Sign::Negative)] => {
            has_real_unstable_mode(system, frame).then_some(false)
        }
        _ => None,
    }
}

/// Whether counts of negative eigenvalues prove a real multiplier off the circle.
fn has_real_unstable_mode(system: &System, frame: &Frame) -> bool {
    // Counts prove something only where no eigenvalue of J_hh and J_hf is undecided.
    let are_regular = |counts: &Counts| {
        let is_sharp = |held| {
            counts.count(held, Bound::Least).is_some_and(|a| counts.count(held, Bound::Most) == Some(a))
        };
        [Held::Both, Held::Start].into_iter().all(is_sharp)
    };
    let n = frame.rigid.is_empty().then_some(system.size());
    Counts::new(system).is_some_and(|new| differ([&new, &new], n) && are_regular(&new))
}

/// Bounds on the number of negative eigenvalues of the action for each pair of ends, each computed when it is
/// first asked for.
pub struct Counts {
    action: Action,
    /// The terms of an entry: two drifts meet in it, and each clock once.
    terms: usize,
    known: [[OnceLock<Option<usize>>; 2]; 4],
}

/// No fewer are negative; no more are negative or 0.
#[derive(Clone, Copy)]
enum Bound {
    Least,
    Most,
}

impl Counts {
    pub fn new(system: &System) -> Option<Counts> {
        Some(Counts {
            action: Action::new(system)?,
            terms: 2 + system.clocks().len(),
            known: Default::default(),
        })
    }

    /// `None` where nothing is proven.
    fn count(&self, held: Held, bound: Bound) -> Option<usize> {
        let (terms, is_least) = (self.terms, matches!(bound, Bound::Least));
        let found = &self.known[held as usize][bound as usize];
        *found.get_or_init(|| self.action.matrix(held)?.negatives(terms, ROUNDINGS, is_least))
    }
}

/// Whether neg J_fh and neg J_hf differ, or n + neg J_hh and neg J_ff, for all kicks between those of two
/// systems, the softer one first: every count grows with the kicks. f: free, h: x = 0, the first letter for
/// t = 0. The latter is asked where n is given: where no rigid mode is at μ = 0 (`proofs/REGION.md`, sections
/// 3 and 5).
pub fn differ([softer, stiffer]: [&Counts; 2], n: Option<usize>) -> bool {
    let exceeds = |[low, high]: [Held; 2], [more, other]: [usize; 2]| {
        let (low, high) = both(true, || softer.count(low, Bound::Least), || stiffer.count(high, Bound::Most));
        low.zip(high).is_some_and(|(low, high)| low + more > high + other)
    };
    exceeds([Held::End, Held::Start], [0, 0])
        || exceeds([Held::Start, Held::End], [0, 0])
        || n.is_some_and(|n| {
            exceeds([Held::Neither, Held::Both], [0, n]) || exceeds([Held::Both, Held::Neither], [n, 0])
        })
}

/// The signs of the action of paths that are held at their start, and at their end.
pub fn signs(system: &System) -> Option<[Option<Sign>; 2]> {
    let action = Action::new(system)?;
    let terms = 2 + system.clocks().len();
    let found = map(&[Held::Start, Held::End], |&held| action.matrix(held)?.sign(terms, ROUNDINGS));
    Some([found[0], found[1]])
}

/// Whether Σ K_k is proven positive definite modulo the rigid modes: on the coordinates kept.
pub(crate) fn is_total_definite(system: &System, frame: &Frame) -> bool {
    let place: BTreeMap<usize, usize> = frame.kept.iter().enumerate().map(|(k, &i)| (i, k)).collect();
    let total = system.total_stiffness();
    let entries = frame.kept.iter().flat_map(|i| total.row(*i).iter().map(move |(j, x)| (i, j, x)));
    let graph = entries.clone().filter(|(i, j, _)| i != j);
    let mut neighbours = vec![Vec::new(); place.len()];
    graph.filter_map(|(i, j, _)| Some((place[i], *place.get(j)?))).for_each(|(i, j)| neighbours[i].push(j));
    let order = positions(&narrow(&neighbours));
    let lower = entries.filter(|(i, j, _)| j <= i);
    let terms: Vec<_> =
        lower.filter_map(|(i, j, x)| Some((order[place[i]], order[*place.get(j)?], to_f64(x)))).collect();
    assembled(place.len(), &terms, place.len()).and_then(|assembled| assembled.sign(1, 1))
        == Some(Sign::Positive)
}

/// Where each item stands in an order.
fn positions(order: &[usize]) -> Vec<usize> {
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(k, &i)| place[i] = k);
    place
}

/// The products of one elimination of the action, 0 where none is tried.
pub(crate) fn cost_of_signs(system: &System) -> f64 {
    Action::new(system).and_then(|own| own.matrix(Held::Neither)).map_or(0.0, |own| own.products())
}

/// The parts of the action, degrees of freedom in an order in which neighbours stand close together.
struct Action {
    /// The kicks in ticks, for rows in the new order: (column, coefficient).
    kicks: Vec<Vec<(usize, Row<f64>)>>,
    masses: Vec<f64>,
    /// For each degree of freedom the ticks from 0 to T/2 at which it is kicked, and both ends.
    times: Vec<Vec<u64>>,
    /// The clocks that kick, and how, by ticks.
    events: Vec<(u64, Vec<usize>, Weight)>,
}

/// From so many nodes on other ways are cheaper, whatever the mesh.
const MOST_NODES: usize = 1 << 20;

impl Action {
    fn new(system: &System) -> Option<Action> {
        if !system.mass().is_diagonal() {
            return None;
        }
        let n = system.size();
        let program = Program::rounded(system);
        let mut graph = vec![Vec::new(); n];
        for (i, row) in program.kicks.iter().flat_map(|kick| &kick.rows) {
            graph[*i].extend(row.iter().map(|(j, _)| *j).filter(|j| j != i));
        }
        graph.iter_mut().for_each(|indexes| {
            indexes.sort_unstable();
            indexes.dedup();
        });
        let order = narrow(&graph);
        let place = positions(&order);
        let moved = |(i, row): &(usize, Row<f64>)| {
            (place[*i], row.iter().map(|(j, x)| (place[*j], *x)).collect::<Row<f64>>())
        };
        let kicks: Vec<Vec<_>> =
            program.kicks.iter().map(|kick| kick.rows.iter().map(moved).collect()).collect();
        let (mut now, mut events, mut times) = (0, Vec::new(), vec![vec![0]; n]);
        let mut nodes = n;
        for event in system.schedule().half_period() {
            now += event.drift;
            let clocks: Vec<usize> = event.clocks().collect();
            for (i, _) in clocks.iter().flat_map(|&clock| &kicks[clock]) {
                if times[*i].last() != Some(&now) {
                    times[*i].push(now);
                    nodes += 1;
                }
            }
            events.push((now, clocks, event.weight));
            if nodes > MOST_NODES {
                return None;
            }
        }
        let end = system.schedule().period() / 2;
        times.iter_mut().filter(|time| time.last() != Some(&end)).for_each(|time| time.push(end));
        let masses: Vec<f64> = order.iter().map(|&i| to_f64(&system.mass().get(i, i))).collect();
        // Below the smallest normal double nothing is within a rounding.
        let entries = kicks.iter().flatten().flat_map(|(_, row)| row).map(|(_, x)| x);
        let is_sound = entries.chain(&masses).all(|x| (1e-200..1e200).contains(&x.abs()));
        is_sound.then_some(Action { kicks, masses, times, events })
    }

    /// J, in ticks, on paths held at one end.
    fn matrix(&self, held: Held) -> Option<Envelope> {
        let end = self.times[0].last();
        let is_free = |time: &u64| !(held.start() && *time == 0 || held.end() && Some(time) == end);
        // The first unknown of each degree of freedom; free nodes are neighbours in time.
        let mut begin = vec![0];
        for counts in &self.times {
            begin.push(begin[begin.len() - 1] + counts.iter().filter(|time| is_free(time)).count());
        }
        let unknown = |i: usize, time: u64| {
            let k = self.times[i].binary_search(&time).ok().filter(|_| is_free(&time))?;
            Some(begin[i] + k - usize::from(held.start()))
        };
        let mut terms = Vec::new();
        for (i, counts) in self.times.iter().enumerate() {
            for ends in counts.windows(2) {
                let x = self.masses[i] / (ends[1] - ends[0]) as f64;
                let nodes = [unknown(i, ends[0]), unknown(i, ends[1])];
                terms.extend(nodes.iter().flatten().map(|&a| (a, a, x)));
                if let [Some(a), Some(b)] = nodes {
                    terms.push((b, a, -x));
                }
            }
        }
        for (time, clocks, weight) in &self.events {
            let weight = -weight.share();
            for (i, row) in clocks.iter().flat_map(|&clock| &self.kicks[clock]) {
                let Some(a) = unknown(*i, *time) else { continue };
                let filter = row.iter().filter(|(j, _)| j <= i);
                terms.extend(filter.filter_map(|(j, x)| Some((a, unknown(*j, *time)?, weight * x))));
            }
        }
        // Neighbours close together, the times of each in order; or time by time, where most are neighbours.
        let times = (0..self.times.len())
            .flat_map(|i| self.times[i].iter().filter(|t| is_free(t)).map(move |t| (*t, i)));
        let mut by_time: Vec<_> = times.enumerate().map(|(k, (t, i))| (t, i, k)).collect();
        by_time.sort_unstable();
        let place = positions(&by_time.into_iter().map(|(.., k)| k).collect::<Vec<_>>());
        let other: Vec<_> = terms.iter().map(|&(i, j, x)| (place[i], place[j], x)).collect();
        let cost = |terms: &[Term]| cost(&first(place.len(), terms));
        let terms = if cost(&other) < cost(&terms) { other } else { terms };
        assembled(place.len(), &terms, self.times.len())
    }
}

/// Two indices, and what is added to the entries (i, j) and (j, i).
type Term = (usize, usize, f64);

/// The first column of each row.
fn first(unknowns: usize, terms: &[Term]) -> Vec<usize> {
    let mut first: Vec<usize> = (0..unknowns).collect();
    terms.iter().for_each(|&(i, j, _)| first[i.max(j)] = first[i.max(j)].min(i.min(j)));
    first
}

/// The products of an elimination.
fn cost(first: &[usize]) -> f64 {
    first.iter().enumerate().map(|(k, &first)| ((k - first) as f64).powi(2)).sum()
}

/// An elimination that is cheap whatever the system.
const CHEAP: f64 = 1e7;

/// The sum of the terms, each unknown in a scale, a power of two, in which its diagonal is near 1; `None`
/// where elimination would cost more than n³ products.
fn assembled(unknowns: usize, terms: &[Term], n: usize) -> Option<Envelope> {
    let first = first(unknowns, terms);
    if cost(&first) > CHEAP + (n as f64).powi(3) {
        return None;
    }
    let mut scales = vec![0.0; unknowns];
    terms.iter().filter(|(i, j, _)| i == j).for_each(|(i, _, x)| scales[*i] += x.abs());
    scales.iter_mut().filter(|x| **x > 0.0).for_each(|x| *x = (-x.log2() / 2.0).round().exp2());
    let mut matrix = Envelope::new(first);
    terms.iter().for_each(|&(i, j, x)| matrix.add(i, j, x * scales[i] * scales[j]));
    Some(matrix)
}
