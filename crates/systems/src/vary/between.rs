//! Verdicts on all systems between two: the stable and unstable intervals of one number, none left out.
//!
//! A number t on which masses and stiffnesses depend linearly, steps fixed, makes kicks K_k(t) between K_k⁻
//! and K_k⁺ in Loewner's order for t in a cell. Near the first region the signs of the action at both decide
//! for the whole cell (`action`; the order theorem of `proofs/REGION.md`), and beyond it counts of negative
//! eigenvalues do where many modes resonate at once. Elsewhere the half period in the middle does, its bound
//! widened by how far kicks and drifts are from it: the forms' inertias, or discs about the eigenvalues.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use faer::Mat;
use num_traits::{Signed, Zero};

use crate::half::compose::inverted;
use crate::half::float::scaled_program;
use crate::half::norm;
use crate::half::period::{Drifts, Stiff, Stiffness, follow_proven};
use crate::linear::frame::Frame;
use crate::linear::sparse::Symmetric;
use crate::linear::system::{Potential, System};
use crate::signs;
use crate::signs::action::{self, Counts, differ, is_total_definite};
use crate::signs::envelope::Sign;
use crate::signs::inertia;
use crate::spectrum::discs::Spectrum;
use crate::vary::stretches::Stretch;
use crate::verdict::measured::Holds;
use number::{Error, Rational, Result, U, from_f64_exact, ratio, to_f64};

/// The stretches of one number of a system.
#[derive(Clone, Debug, PartialEq)]
pub struct Intervals {
    /// The number's name.
    pub number: String,
    /// Whether only the ends of the stretches and the multiples between were decided, not all between.
    pub is_discrete: bool,
    /// The inner steps in an outer one, where these are two levels and the number is the outer step at that
    /// ratio.
    pub inner_steps: Option<u64>,
    /// They cover the range, in order; where edges were isolated exactly, neighbouring doubles end one and
    /// begin the next.
    pub stretches: Vec<Stretch>,
    /// How many of those that are not decided the accuracy of the data leaves open: data a thousand times as
    /// accurate decide most of each. `None` where stretches hold for the numbers given alone.
    pub open: Option<usize>,
}

impl Intervals {
    /// \[lo, hi\]: where what is proven stable before the first unstable stretch ends, and where that begins;
    /// twice the first unstable number where only some were decided.
    pub fn first_unstable(&self) -> Option<(f64, f64)> {
        let k = self.stretches.iter().position(|stretch| stretch.verdict == Holds::Unstable)?;
        if self.is_discrete {
            return Some((self.stretches[k].lo, self.stretches[k].lo));
        }
        let stable = self.stretches[..k].iter().rev().find(|stretch| stretch.verdict == Holds::Stable)?;
        Some((stable.hi, self.stretches[k].lo))
    }
}

/// Cells of one line of systems, and what they have in common.
pub struct Cells<'a> {
    /// The system of a number.
    at: &'a (dyn Fn(f64) -> Result<System> + Sync),
    /// Whether they differ by a positive factor of all stiffnesses alone, growing with the number, which
    /// needs no check then.
    is_scaled: bool,
    /// The rigid modes of such systems, and whether Σ K_k is proven positive definite but for these.
    frame: OnceLock<Frame>,
    is_definite: OnceLock<bool>,
    /// Counts at ends of cells, which neighbours share, by the bits of the number.
    counts: Mutex<BTreeMap<u64, Arc<Option<Counts>>>>,
}

/// A cell is halved so often where counts prove its middle unstable.
const HALVINGS: u32 = 5;

/// Counts that are kept.
const MOST_ENDS: usize = 128;

impl<'a> Cells<'a> {
    pub fn new(at: &'a (dyn Fn(f64) -> Result<System> + Sync), is_scaled: bool) -> Cells<'a> {
        let (frame, is_definite) = Default::default();
        Cells { at, is_scaled, frame, is_definite, counts: Mutex::default() }
    }

    /// The verdict that is proven for all systems between two: those of both ends and their mean are given,
    /// and masses and stiffnesses are linear in between.
    ///
    /// # Errors
    /// Where the second system is not the mean, or steps differ.
    pub fn verdict(&self, ends: (f64, f64), systems: [&System; 3]) -> Result<Holds> {
        let [lo, middle, hi] = systems;
        let varies_mass = lo.mass() != hi.mass();
        if !self.is_scaled {
            verify_line(systems)?;
            let rigid = middle.rigid_modes();
            if varies_mass && !middle.mass().is_diagonal()
                || lo.rigid_modes() != rigid
                || hi.rigid_modes() != rigid
            {
                return Ok(Holds::Undecided);
            }
        }
        let pairs = lo.potentials().iter().zip(hi.potentials()).filter(|_| !self.is_scaled);
        let courses = pairs.map(|(a, b)| Course::of(&a.stiffness, &b.stiffness)).collect();
        let frame = || Frame::new(middle);
        let frame = if self.is_scaled { self.frame.get_or_init(frame).clone() } else { frame() };
        let cell = Cell { ends, systems, frame, courses, cells: self };
        Ok(match cell.by_action()? {
            Holds::Undecided => cell.by_half_period()?,
            known => known,
        })
    }

    /// The counts at a number.
    fn counts(&self, x: f64) -> Result<Arc<Option<Counts>>> {
        let known = || self.counts.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(counts) = known().get(&x.to_bits()) {
            return Ok(Arc::clone(counts));
        }
        let counts = Arc::new(Counts::new(&(self.at)(x)?));
        let mut known = known();
        if known.len() >= MOST_ENDS {
            known.clear();
        }
        Ok(Arc::clone(known.entry(x.to_bits()).or_insert(counts)))
    }

    /// Whether counts prove all systems between two numbers unstable, every kick growing from one to the
    /// other: at both ends together, or half by half as long as they prove the middle of each.
    fn differ_throughout(
        &self,
        (lo, hi): (f64, f64),
        is_rising: bool,
        n: Option<usize>,
        halvings: u32,
    ) -> Result<bool> {
        let ends = [self.counts(lo)?, self.counts(hi)?];
        let [Some(a), Some(b)] = ends.each_ref().map(|ends| ends.as_ref().as_ref()) else { return Ok(false) };
        if differ(if is_rising { [a, b] } else { [b, a] }, n) {
            return Ok(true);
        }
        let middle = lo + (hi - lo) / 2.0;
        if halvings == 0 || !(lo < middle && middle < hi) {
            return Ok(false);
        }
        let counts = self.counts(middle)?;
        Ok(counts.as_ref().as_ref().is_some_and(|counts| differ([counts, counts], n))
            && self.differ_throughout((lo, middle), is_rising, n, halvings - 1)?
            && self.differ_throughout((middle, hi), is_rising, n, halvings - 1)?)
    }
}

/// How a stiffness moves as the number grows, in Loewner's order.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Course {
    Fixed,
    Rising,
    Falling,
    Neither,
}

impl Course {
    fn of(lo: &Symmetric, hi: &Symmetric) -> Course {
        let minus = Rational::from_integer((-1).into());
        let mut difference = hi.clone();
        difference.add_all(&lo.scaled(&minus));
        if difference.is_zero() {
            Course::Fixed
        } else if difference.is_positive_semidefinite() {
            Course::Rising
        } else if difference.scaled(&minus).is_positive_semidefinite() {
            Course::Falling
        } else {
            Course::Neither
        }
    }
}

/// That steps are the same and the second system is the mean of the others.
///
/// # Errors
/// Where it is not.
pub(crate) fn verify_line(systems: [&System; 3]) -> Result<()> {
    let [lo, middle, hi] = systems;
    let steps = |system: &System| {
        system
            .potentials()
            .iter()
            .map(|potential| (potential.step.clone(), potential.phase.clone()))
            .collect::<Vec<_>>()
    };
    let is_mean = |[a, b, c]: [&Symmetric; 3]| {
        let mut twice = a.clone();
        twice.add_all(c);
        twice == b.scaled(&Rational::from_integer(2.into()))
    };
    let stiffnesses = |k: usize| systems.map(|systems| &systems.potentials()[k].stiffness);
    if steps(lo) != steps(middle)
        || steps(hi) != steps(middle)
        || !is_mean(systems.map(System::mass))
        || !(0..middle.potentials().len()).all(|k| is_mean(stiffnesses(k)))
    {
        let remedy = "choose a number on which masses or stiffnesses depend linearly, steps fixed: a mass, a scale, a stiffness";
        return Err(Error::input("intervals", "this number", remedy));
    }
    Ok(())
}

/// Less and more than all on the segment from a to b: with b − a + β I ≥ 0 and a − b + γ I ≥ 0 these are a −
/// β I and b + β I, or b − γ I and a + γ I.
fn spread([a, b]: [&Symmetric; 2]) -> Option<[Symmetric; 2]> {
    let minus = ratio(-1, 1);
    let mut difference = b.clone();
    difference.add_all(&a.scaled(&minus));
    let rounded = difference.rounded();
    let slack = 1.01 * U * norm::frobenius(&rounded);
    let (beta, gamma) = (inertia::lack(&rounded, slack), inertia::lack(&-&rounded, slack));
    let (bound, [lo, hi]) = if beta <= gamma { (beta, [a, b]) } else { (gamma, [b, a]) };
    let bound = from_f64_exact(bound)?;
    let moved = |symmetric: &Symmetric, by: &Rational| {
        let mut moved = symmetric.clone();
        moved.add_all(&Symmetric::diagonal(&vec![by.clone(); symmetric.size()]));
        moved
    };
    Some([moved(lo, &-&bound), moved(hi, &bound)])
}

/// Three systems on a line.
struct Cell<'a> {
    ends: (f64, f64),
    systems: [&'a System; 3],
    frame: Frame,
    /// How each stiffness moves, where they are not scaled.
    courses: Vec<Course>,
    cells: &'a Cells<'a>,
}

impl Cell<'_> {
    /// The order theorem: all kicks lie between those of two systems.
    fn by_action(&self) -> Result<Holds> {
        let [lo, middle, hi] = self.systems;
        if !middle.mass().is_diagonal() {
            return Ok(Holds::Undecided);
        }
        match self.rises() {
            Some(true) => self.between_kicks([lo, hi], Some(true)),
            Some(false) => self.between_kicks([hi, lo], Some(false)),
            None => match self.around()? {
                Some([less, more]) => self.between_kicks([&less, &more], None),
                None => Ok(Holds::Undecided),
            },
        }
    }

    /// Whether all kicks grow with the number, or all fall; lighter masses act as stiffer kicks. Where they
    /// are but scaled, by a factor that grows, all counts grow with it, whatever the signs of the kicks
    /// (`proofs/REGION.md`, section 3).
    fn rises(&self) -> Option<bool> {
        if self.cells.is_scaled {
            return Some(true);
        }
        let [lo, _, hi] = self.systems.map(System::mass);
        let masses = |is: fn(&Rational, &Rational) -> bool| {
            lo == hi || (0..lo.size()).all(|i| is(&lo.get(i, i), &hi.get(i, i)))
        };
        let all = |course| self.courses.iter().all(|own| [Course::Fixed, course].contains(own));
        if all(Course::Rising) && masses(PartialOrd::ge) {
            return Some(true);
        }
        (all(Course::Falling) && masses(PartialOrd::le)).then_some(false)
    }

    /// Systems with kicks no stronger and no weaker than any of the cell.
    fn around(&self) -> Result<Option<[System; 2]>> {
        let [lo, middle, hi] = self.systems;
        let (mut less, mut more) = (Vec::new(), Vec::new());
        for (k, potential) in middle.potentials().iter().enumerate() {
            let [a, b] = [lo, hi].map(|system| system.potentials()[k].stiffness.clone());
            let [small, large] = match self.courses[k] {
                Course::Fixed | Course::Rising => [a, b],
                Course::Falling => [b, a],
                Course::Neither => match spread([&a, &b]) {
                    Some(both) => both,
                    None => return Ok(None),
                },
            };
            less.push(Potential { stiffness: small, ..potential.clone() });
            more.push(Potential { stiffness: large, ..potential.clone() });
        }
        let masses = |pick: fn(Rational, Rational) -> Rational| {
            let entry = |i: usize| pick(lo.mass().get(i, i), hi.mass().get(i, i));
            Symmetric::diagonal(&(0..middle.size()).map(entry).collect::<Vec<_>>())
        };
        Ok(Some([System::new(masses(|a, b| a.max(b)), less)?, System::new(masses(|a, b| a.min(b)), more)?]))
    }

    /// The verdict that is proven where all kicks lie between those of two systems, the softer one first;
    /// these are the ends of the cell where the kicks are known to rise or fall.
    fn between_kicks(&self, [less, more]: [&System; 2], rises: Option<bool>) -> Result<Holds> {
        // Where a kick vanishes the schedule is another, and nothing can be compared.
        if self.clocks() != more.clocks().len() || self.clocks() != less.clocks().len() {
            return Ok(Holds::Undecided);
        }
        let Some(stiffer) = action::signs(more) else { return Ok(Holds::Undecided) };
        if stiffer == [Some(Sign::Positive); 2] {
            let is_stable = self.is_definite(less);
            return Ok(if is_stable { Holds::Stable } else { Holds::Undecided });
        }
        let softer = action::signs(less).unwrap_or_default();
        let is_unstable =
            |k: usize| stiffer[k] == Some(Sign::Positive) && softer[1 - k] == Some(Sign::Negative);
        let is_unstable =
            is_unstable(0) || is_unstable(1) || self.has_real_unstable_mode([less, more], rises)?;
        Ok(if is_unstable { Holds::Unstable } else { Holds::Undecided })
    }

    /// Whether Σ K_k is proven positive definite modulo the rigid modes.
    fn is_definite(&self, system: &System) -> bool {
        let found = || is_total_definite(system, &self.frame);
        if self.cells.is_scaled { *self.cells.is_definite.get_or_init(found) } else { found() }
    }

    /// Whether counts at the least and the greatest kicks prove a real multiplier off the circle for all
    /// between; where every kick grows from one end of the cell to the other, piece by piece.
    fn has_real_unstable_mode(&self, kicks: [&System; 2], rises: Option<bool>) -> Result<bool> {
        let n = self.frame.rigid.is_empty() && self.is_definite(kicks[0]);
        let n = n.then(|| kicks[0].size());
        if let Some(rises) = rises {
            return self.cells.differ_throughout(self.ends, rises, n, HALVINGS);
        }
        let [Some(softer), Some(stiffer)] = kicks.map(Counts::new) else { return Ok(false) };
        Ok(differ([&softer, &stiffer], n))
    }

    /// The half period in the middle, every kick and drift off by as much as it moves.
    fn by_half_period(&self) -> Result<Holds> {
        let [lo, middle, hi] = self.systems;
        let reduced = self.reduced(middle)?;
        if reduced.clocks().len() != self.clocks() {
            return Ok(Holds::Undecided);
        }
        let m = reduced.size();
        let (program, scales) = scaled_program(&reduced, &Frame::whole(m));
        let tick = reduced.tick();
        // Sums of equal clocks, where none vanishes at an end.
        let are_all = [middle, hi].iter().all(|system| system.clocks().len() == self.clocks());
        let kicks = |system: &'_ System| {
            if are_all { system.clocks().to_vec() } else { system.potentials().to_vec() }
        };
        let stiff = |(k, clock): (usize, &Potential)| {
            let ticks = Rational::from_integer(reduced.schedule().clocks()[k].step().into());
            let factor = to_f64(&(tick * tick * ticks));
            let rows = program.kicks[k].rows.clone();
            let squares: f64 = rows.iter().flat_map(|(_, row)| row).map(|(_, x)| x * x).sum();
            let mut moved = Mat::<f64>::zeros(m, m);
            if self.cells.is_scaled {
                // By a factor from 1 − r to 1 + r, the number's square being that in the old steps.
                let (lo, hi) = self.ends;
                let r = (hi - lo) * (hi + lo) / (hi * hi + lo * lo);
                rows.iter().for_each(|(a, row)| row.iter().for_each(|(b, x)| moved[(*a, *b)] = r * x));
            } else {
                for (from, to) in kicks(middle).iter().zip(kicks(hi)) {
                    if (&from.step, &from.phase) == (&clock.step, &clock.phase) {
                        let mut change = to.stiffness.clone();
                        change.add_all(&from.stiffness.scaled(&ratio(-1, 1)));
                        for (a, row) in change.restricted(&self.frame.kept).rounded_products(&ratio(1, 1)) {
                            row.into_iter()
                                .for_each(|(b, x)| moved[(a, b)] += x * factor / (scales[a] * scales[b]));
                        }
                    }
                }
            }
            let off = 1.01 * (norm::spectral(&moved) + 2.0 * U * squares.sqrt());
            Stiff { stiffness: Stiffness::Rows(rows), off, known: 0.0 }
        };
        let kicks: Vec<Stiff> = reduced.clocks().iter().enumerate().map(stiff).collect();
        // ‖P diag(e) Pᵀ‖ ≤ Σ e_i |P_i|², P = (I, −N); where N is empty the largest e_i.
        let moved = |i: usize| {
            let inverse = self.systems.map(|systems| systems.mass().get(i, i).recip());
            let far = (&inverse[0] - &inverse[1]).abs().max((&inverse[2] - &inverse[1]).abs());
            let column: f64 = match self.frame.kept.iter().position(|&index| index == i) {
                Some(k) => scales[k] * scales[k],
                None => self
                    .frame
                    .rigid
                    .iter()
                    .filter(|(index, _)| *index == i)
                    .map(|(_, n)| self.square(n, &scales))
                    .sum(),
            };
            1.01 * to_f64(&far) * column
        };
        let varies = lo.mass() != hi.mass();
        let all = (0..if varies { middle.size() } else { 0 }).map(moved);
        let off = if self.frame.rigid.is_empty() { all.fold(0.0, f64::max) } else { all.sum::<f64>() };
        let drifts = Drifts { inverse_mass: &program.inverse_mass, decay: &Rational::zero(), off };
        let events = reduced.schedule().half_period();
        let Some(state) = follow_proven(&drifts, events, |_, clock| &kicks[clock]) else {
            return Ok(Holds::Undecided);
        };
        let blocks = state.blocks(scales);
        let proven = signs::proven(&blocks).or_else(|| Spectrum::new(&blocks)?.certified(&blocks));
        Ok(proven.into())
    }

    /// The number of clocks that kick anywhere on the segment.
    fn clocks(&self) -> usize {
        let [lo, middle, hi] = self.systems.map(System::potentials);
        let kicks = |k: &usize| [lo, middle, hi].iter().any(|potentials| !potentials[*k].stiffness.is_zero());
        let clocks = (0..middle.len()).filter(kicks).map(|k| (&middle[k].step, &middle[k].phase));
        clocks.collect::<BTreeSet<_>>().len()
    }

    /// Σ (a_i n_i)² over the coordinates kept.
    fn square(&self, n: &[Rational], scales: &[f64]) -> f64 {
        self.frame.kept.iter().zip(scales).map(|(&i, a)| (a * to_f64(&n[i])).powi(2)).sum()
    }

    /// The system in the frame's coordinates: positions modulo rigid modes, M⁻¹ as P M⁻¹ Pᵀ.
    fn reduced(&self, system: &System) -> Result<System> {
        if self.frame.rigid.is_empty() {
            return Ok(system.clone());
        }
        let inverse = inverted(system.mass().to_dense());
        let columns = nalgebra::DMatrix::from_fn(self.frame.kept.len(), system.size(), |a, i| {
            let rigid = self.frame.rigid.iter().find(|(index, _)| *index == i);
            match rigid {
                Some((_, n)) => -n[self.frame.kept[a]].clone(),
                None => Rational::from_integer(i64::from(self.frame.kept[a] == i).into()),
            }
        });
        let mass = Symmetric::try_from(&inverted(&columns * inverse * columns.transpose()))?;
        let kept = |potential: &Potential| Potential {
            stiffness: potential.stiffness.restricted(&self.frame.kept),
            ..potential.clone()
        };
        System::new(mass, system.potentials().iter().map(kept).collect())
    }
}
