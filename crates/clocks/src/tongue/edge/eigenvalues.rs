//! Eigenvalues one by one: isolated by Sturm counts, improved by Newton's method, certified by Rayleigh
//! quotients.

use std::cell::RefCell;

use super::batch::{Batches, Order};
use super::count::{narrow, uncertainty};
use super::enclosure::Edge;
use super::isolate::{Cutting, Limits};
use super::locate::Walk;
use super::mode::Proofs;
use crate::tongue::string::{Entry, HalfString, Indices};

/// Halvings for one eigenvalue before more bits are called.
const ROUNDS: u32 = 60;

/// Halvings between two attempts.
const HALVINGS: u32 = 4;

/// A relative uncertainty that hardly ever shows in a double: below it an enclosure is as narrow as doubles
/// get.
const NEGLIGIBLE: f64 = 1e-17;

/// A trial that leaves more than this part of the uncertainty is the last: doubles allow no better.
const GAIN: f64 = 0.1;

/// A thread keeps the memory for strings of no more nodes: some 10 MB.
const KEPT: usize = 1 << 16;

/// Memory for searches: a thread keeps it from string to string.
#[derive(Debug, Default)]
struct Workspace {
    cutting: Cutting,
    walk: Walk,
    /// The eigenvalues that are looked for, and the same by the node where their modes live.
    tasks: Batches,
    sorted: Batches,
    order: Order,
}

thread_local! {
    static SPACE: RefCell<Workspace> = RefCell::default();
}

/// The eigenvalues with the given indices, by entry, as narrow as doubles prove them; `None` where that is
/// nothing.
pub fn eigenvalues(string: &HalfString, wanted: &Indices) -> [Vec<Option<Edge>>; 4] {
    SPACE.with_borrow_mut(|space| {
        let found = space.search(string, wanted);
        if string.nodes.len() > KEPT {
            *space = Workspace::default();
        }
        found
    })
}

impl Workspace {
    fn search(&mut self, string: &HalfString, wanted: &Indices) -> [Vec<Option<Edge>>; 4] {
        let Workspace { cutting, walk, tasks, sorted, order } = self;
        tasks.clear();
        let limits = Limits::new(wanted);
        cutting.isolate(string, &limits, |interval, contents| {
            contents.each_alone(|entry| tasks.push(entry, interval.upto(entry), interval.ends()));
        });
        let mut found = Entry::ALL.map(|entry| {
            let (first, last) = (limits.first[entry as usize], limits.last[entry as usize]);
            vec![None; (last + 1 - first) as usize]
        });
        // Halve the brackets, find out where the modes live, and prove them; what fails, again.
        for _ in 0..ROUNDS / HALVINGS {
            if tasks.is_empty() {
                break;
            }
            tasks.fill();
            narrow(string, tasks.all_mut(), HALVINGS);
            tasks.all_mut().iter_mut().for_each(|batch| walk.locate(string, batch));
            // Modes that live side by side are followed side by side.
            sorted.sort_by_place(tasks, string.nodes.len(), order);
            tasks.clear();
            prove_all(string, sorted, tasks, |edge| {
                let entry = edge.entry as usize;
                found[entry][(edge.index - limits.first[entry]) as usize] = Some(edge);
            });
        }
        found
    }
}

/// Proves what it can; the others fail: κ was not near enough.
fn prove_all(string: &HalfString, tasks: &Batches, failed: &mut Batches, mut found: impl FnMut(Edge)) {
    for (batch, lanes) in tasks.iter() {
        let Proofs { edge: [lo, hi], radius, quotient } = Proofs::of(string, batch);
        for i in 0..lanes {
            let in_vain = radius[i] < f64::INFINITY && radius[i] > GAIN * batch.radius[i];
            if radius[i] <= NEGLIGIBLE * quotient[i] || in_vain {
                let (entry, index) = batch.eigenvalue(i);
                found(Edge { entry, index, lo: lo[i], hi: hi[i] });
            } else {
                let (batch, lane) = failed.push_lane(batch, i);
                (batch.radius[lane], batch.kappa[lane]) = (radius[i], quotient[i]);
            }
        }
    }
}

/// An interval of s in which counts in doubles see the eigenvalue, perhaps with others.
pub(crate) fn sighting(string: &HalfString, entry: Entry, index: usize) -> Option<(f64, f64)> {
    let mut seen = None;
    Cutting::default().isolate(string, &Limits::new(&entry.only(index)), |interval, _| {
        if interval.inside(entry).contains(&index) {
            seen = Some(interval.ends());
        }
    });
    let slack = 2.0 * uncertainty(string) + 4.0 * f64::EPSILON;
    seen.map(|[lo, hi]| (lo * (1.0 - slack) * string.ticks, hi * (1.0 + slack) * string.ticks))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tongue::edge::counts;
    use number::vector::LANES;
    use number::vector::instructions::Instructions;
    use number::{Ratio, ratio};

    #[test]
    fn every_instruction_set_finds_the_same_edges() {
        let rhos = [ratio(1, 1000), ratio(1, 25), ratio(1, 2), ratio(40, 1)];
        let ratios = Ratio::up_to(14).map(Ratio::terms).chain([(23, 20), (5, 31), (61, 38)]);
        for ((p, q), rho) in ratios.flat_map(|pair| rhos.iter().map(move |rho| (pair, rho))) {
            let edges = |instructions: Instructions| {
                let mut string = HalfString::new(Ratio::new(p, q).unwrap(), rho).unwrap();
                string.instructions = instructions;
                let wanted = string.dimensions.map(|n| (n > 0).then_some(1..=n));
                eigenvalues(&string, &wanted)
            };
            let portable = edges(Instructions::PORTABLE);
            assert!(Instructions::available().all(|set| edges(set) == portable));
        }
    }

    #[test]
    fn counts_far_above_all_eigenvalues_are_complete() {
        // Four hundred nodes, each of which multiplies x by up to 1e15 at this κ: no product may overflow.
        let string = HalfString::new("1/801".parse().unwrap(), &ratio(1_000_000_000, 1)).unwrap();
        let counts = counts(&string, &[1e9 * string.upper_bound; LANES]);
        for (entry, count) in Entry::ALL.into_iter().zip(counts) {
            assert_eq!(count, [string.dimensions[entry as usize] as f64; LANES]);
        }
    }
}
