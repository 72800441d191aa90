//! The tongues of one ratio: which edge bounds which, open or closed.
//!
//! With 0 = P0 < P1 <= P2 < ... the zeros of B and C together and M1 <= M2 < ... those of A and D, tongue m is
//! [M_m, M_{m+1}] for odd m and [P_{m−1}, P_m] for even m: one edge from each of the two problems, both with the index
//! ⌈m/2⌉. For ρ > 0 there are p + q − 2 of them, and the last, m = p + q − 1, has no upper end. For ρ = 0 the slow clock is
//! silent: all are closed, at p θ = m π, m < p, and m = p begins at the Verlet limit s = 4.

use std::ops::RangeInclusive;

use num_traits::{Signed, Zero};

use super::modular;
use super::order::Gap;
use super::precise::{Enclosure, Function};
use super::spectrum::Edge;
use super::string::{Entry, HalfString};
use crate::error::{Error, Result};
use crate::number::{Ball, Ratio, Rational, rational};

/// How much work was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effort {
    /// Edges certified in doubles.
    pub doubles: u64,
    /// Edges certified with more bits, refinements for a width or an order included.
    pub precise: u64,
}

/// All tongues of one p/q and ρ ≥ 0, computed as they are asked for.
#[derive(Clone, Debug)]
pub struct Tongues {
    ratio: Ratio,
    rho: Rational,
    string: HalfString,
    /// Whether all tongues of even and of odd m are proven open; `None`: not asked yet.
    pub(super) open: [Option<bool>; 2],
    effort: Effort,
}

impl Tongues {
    /// The tongues of h2/h1 = p/q and ρ = L2/L1.
    ///
    /// # Errors
    /// ρ < 0 (no string: use `map`), ρ p/q beyond 1e±16, too many kicks.
    pub fn new(ratio: Ratio, rho: &Rational) -> Result<Self> {
        let string = HalfString::new(ratio, rho)?;
        let rho = rho.clone();
        Ok(Tongues { ratio, rho, string, open: [None; 2], effort: Effort::default() })
    }

    /// h2/h1 = p/q.
    pub fn ratio(&self) -> Ratio {
        self.ratio
    }

    /// The numerator of h2/h1.
    pub fn p(&self) -> u64 {
        self.ratio.p()
    }

    /// The denominator of h2/h1.
    pub fn q(&self) -> u64 {
        self.ratio.q()
    }

    /// ρ = L2/L1.
    pub fn rho(&self) -> &Rational {
        &self.rho
    }

    /// m of the last tongue, which is infinite: p + q − 1, or p for ρ = 0.
    pub fn last(&self) -> u64 {
        if self.rho.is_zero() { self.p() } else { self.ratio.kicks() - 1 }
    }

    /// The work done so far.
    pub fn effort(&self) -> Effort {
        self.effort
    }

    /// Tongue m alone, 1 ≤ m ≤ [`Tongues::last`]: two edges are computed.
    ///
    /// # Errors
    /// m out of range.
    pub fn gap(&mut self, m: u64) -> Result<Gap> {
        self.check(m)?;
        let index = m.div_ceil(2) as usize;
        let mut edges = [None, None];
        for (edge, entry) in edges.iter_mut().zip(modular::pair(m % 2 == 1)) {
            if index <= self.string.dimension(entry) {
                *edge = self.edges(entry, index, index)?.pop();
            }
        }
        self.assemble(m, edges)
    }

    /// The tongues `from` ..= `upto`; all edges of one problem are computed side by side.
    ///
    /// # Errors
    /// m out of range.
    pub fn gaps(&mut self, from: u64, upto: u64) -> Result<Vec<Gap>> {
        self.check(from)?;
        self.check(upto)?;
        let mut wanted = [const { None }; 4];
        for entry in Entry::ALL {
            let (first, last) = indices(entry, from, upto);
            let last = last.min(self.string.dimension(entry));
            wanted[entry as usize] = (first <= last).then_some(first..=last);
        }
        let lists = self.wanted_edges(&wanted)?;
        let edge = |entry: Entry, index: usize| {
            let first = *wanted[entry as usize].as_ref()?.start();
            lists[entry as usize].get(index - first).copied()
        };
        let pairs: Vec<_> = (from..=upto)
            .map(|m| (m, modular::pair(m % 2 == 1).map(|entry| edge(entry, m.div_ceil(2) as usize))))
            .collect();
        pairs.into_iter().map(|(m, pair)| self.assemble(m, pair)).collect()
    }

    /// All tongues, the infinite one last.
    ///
    /// # Errors
    /// As [`Tongues::gaps`].
    pub fn all(&mut self) -> Result<Vec<Gap>> {
        self.gaps(1, self.last())
    }

    /// The edges `first` ..= `last` of one problem.
    ///
    /// # Errors
    /// Where the schedule is too long; an index out of range.
    pub fn edges(&mut self, entry: Entry, first: usize, last: usize) -> Result<Vec<Edge>> {
        if first == 0 || first > last || last > self.string.dimension(entry) {
            let remedy =
                format!("entry {} has {} positive zeros", entry.name(), self.string.dimension(entry));
            return Err(Error::input("edge", format!("{first}..{last}"), remedy));
        }
        let mut wanted = [const { None }; 4];
        wanted[entry as usize] = Some(first..=last);
        let [a, b, c, d] = self.wanted_edges(&wanted)?;
        Ok([a, b, c, d].concat())
    }

    /// All edges, by entry: the quickest way to have them all.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn all_edges(&mut self) -> Result<[Vec<Edge>; 4]> {
        let all = Entry::ALL.map(|entry| self.string.dimension(entry));
        self.wanted_edges(&all.map(|zeros| (zeros > 0).then_some(1..=zeros)))
    }

    /// The edges of each problem with the given indices, all side by side.
    fn wanted_edges(&mut self, wanted: &[Option<RangeInclusive<usize>>; 4]) -> Result<[Vec<Edge>; 4]> {
        let mut found = self.string.eigenvalues(wanted).into_iter();
        let mut edges = [const { Vec::new() }; 4];
        for (entry, edges) in Entry::ALL.into_iter().zip(&mut edges) {
            let first = wanted[entry as usize].as_ref().map_or(1, |range| *range.start());
            *edges = self.completed(entry, first, found.next().unwrap_or_default())?;
        }
        Ok(edges)
    }

    /// The edges `first`, `first` + 1, ... of one problem, those that doubles could not certify by more bits.
    fn completed(&mut self, entry: Entry, first: usize, found: Vec<Option<Edge>>) -> Result<Vec<Edge>> {
        // Without a new list where all are there already.
        let narrow = |edge: &Option<Edge>| edge.is_some_and(|edge| edge.is_narrow());
        let good = found.iter().filter(|edge| narrow(edge)).count();
        self.effort.doubles += good as u64;
        if good == found.len() {
            return Ok(found.into_iter().map(|edge| edge.expect("a narrow one")).collect());
        }
        let complete = |(edge, index): (Option<Edge>, usize)| match edge {
            Some(edge) if edge.is_narrow() => Ok(edge),
            edge => self.by_more_bits(entry, index, edge),
        };
        found.into_iter().zip(first..).map(complete).collect()
    }

    /// How many positive zeros an entry has.
    pub fn zeros(&self, entry: Entry) -> usize {
        self.string.dimension(entry)
    }

    /// An edge that doubles could not certify, or left wide.
    fn by_more_bits(&mut self, entry: Entry, index: usize, wide: Option<Edge>) -> Result<Edge> {
        const DIGITS: u32 = 20;
        let found = match wide {
            Some(edge) => self.refine(&edge, DIGITS)?,
            None => {
                let exact = |x: f64| rational::from_f64_exact(x).filter(Signed::is_positive);
                let bracket = self.string.bracket(entry, index);
                let start = bracket.and_then(|(lo, hi)| Some(Enclosure { lo: exact(lo)?, hi: exact(hi)? }));
                self.digits_of((entry, index), start.as_ref(), DIGITS, |string| string.cluster(entry, index))?
            }
        };
        let (lo, hi) = found.to_f64();
        Ok(Edge { entry, index: index as u32, lo, hi })
    }

    /// The edge to `digits` significant digits: an interval narrower than 10^-digits of itself.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn refine(&mut self, edge: &Edge, digits: u32) -> Result<Enclosure> {
        self.sharpened(edge, &Enclosure::from(edge), digits)
    }

    /// The same from an enclosure that may hold more digits than the edge.
    pub(super) fn sharpened(&mut self, edge: &Edge, start: &Enclosure, digits: u32) -> Result<Enclosure> {
        let zero = (edge.entry, edge.index as usize);
        self.digits_of(zero, Some(start), digits, |_| Some((edge.lo, edge.hi)))
    }

    /// The same from where there are no other zeros; else, others being so near that one double holds them too, or one on
    /// the end, from proven counts `around` where doubles see it.
    fn digits_of(
        &mut self,
        (entry, index): (Entry, usize),
        start: Option<&Enclosure>,
        digits: u32,
        around: impl FnOnce(&HalfString) -> Option<(f64, f64)>,
    ) -> Result<Enclosure> {
        self.effort.precise += 1;
        let (function, relative) = (self.function(entry)?, tenth_power(digits));
        if let Some(found) = start.and_then(|start| function.shrink(start, &relative, false)) {
            return Ok(found);
        }
        let alone = function.isolate(&self.string, index, around(&self.string));
        Ok(function.shrink(&alone, &relative, true).expect("it is isolated"))
    }

    pub(super) fn function(&self, entry: Entry) -> Result<Function> {
        Function::new(self.ratio, &self.rho, entry)
    }

    pub(super) fn string(&self) -> &HalfString {
        &self.string
    }

    fn check(&self, m: u64) -> Result<()> {
        if (1..=self.last()).contains(&m) {
            return Ok(());
        }
        Err(Error::input("m", m, format!("{} has the tongues 1 to {}", self.ratio, self.last())))
    }

    /// s = 4 sin²(m π/(2p)), where p θ = m π: the paper's eq. (9).
    pub fn resonance(&self, m: u64, bits: u32) -> Ball {
        let angle = Ball::pi(bits + 16)
            .mul(&Ball::from_rational(&Rational::new(m.into(), (2 * self.p()).into()), bits + 16), bits + 16);
        angle.sin(bits + 8).square(bits).scale2(2)
    }
}

/// The indices of an entry's edges in the tongues `from` ..= `upto`.
fn indices(entry: Entry, from: u64, upto: u64) -> (usize, usize) {
    let odd = matches!(entry, Entry::A | Entry::D);
    // The least and the largest m of the parity in the range.
    let first = if (from % 2 == 1) == odd { from } else { from + 1 };
    let last = if (upto % 2 == 1) == odd { upto } else { upto.saturating_sub(1) };
    (first.div_ceil(2) as usize, last.div_ceil(2) as usize)
}

/// 10^-digits.
fn tenth_power(digits: u32) -> Rational {
    Rational::new(1.into(), num_bigint::BigInt::from(10).pow(digits))
}
