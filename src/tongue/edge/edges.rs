//! The edges of one ratio, in doubles where these prove them and by more bits elsewhere.

use std::ops::RangeInclusive;
use std::sync::atomic::{AtomicU64, Ordering};

use num_traits::Signed;

use super::eigenvalues::{Sighting, eigenvalues};
use super::enclosure::{Edge, Enclosure};
use super::function::EntryFunction;
use super::{exact_count, precise};
use crate::error::{Error, Result};
use crate::number::{Ball, Ratio, Rational, rational};
use crate::tongue::string::{Entry, HalfString, Indices};

/// How much work was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effort {
    /// Edges certified in doubles.
    pub doubles: u64,
    /// Edges certified with more bits, refinements for a width or an order included.
    pub precise: u64,
}

/// The zeros of the entries A, B, C and D in s > 0, for one p/q and ρ ≥ 0.
#[derive(Debug)]
pub(crate) struct Edges {
    ratio: Ratio,
    rho: Rational,
    string: HalfString,
    doubles: AtomicU64,
    precise: AtomicU64,
}

impl Clone for Edges {
    fn clone(&self) -> Self {
        let Effort { doubles, precise } = self.effort();
        let (rho, string) = (self.rho.clone(), self.string.clone());
        Edges { ratio: self.ratio, rho, string, doubles: doubles.into(), precise: precise.into() }
    }
}

impl Edges {
    /// The edges of h2/h1 = p/q and ρ = L2/L1.
    ///
    /// # Errors
    /// ρ < 0 (no string), ρ p/q beyond 1e±16, too many kicks.
    pub fn new(ratio: Ratio, rho: &Rational) -> Result<Self> {
        let string = HalfString::new(ratio, rho)?;
        Ok(Edges { ratio, rho: rho.clone(), string, doubles: 0.into(), precise: 0.into() })
    }

    pub fn ratio(&self) -> Ratio {
        self.ratio
    }

    pub fn rho(&self) -> &Rational {
        &self.rho
    }

    pub fn string(&self) -> &HalfString {
        &self.string
    }

    /// The work done so far.
    pub fn effort(&self) -> Effort {
        let [doubles, precise] = [&self.doubles, &self.precise].map(|count| count.load(Ordering::Relaxed));
        Effort { doubles, precise }
    }

    /// The edges `first` ..= `last` of one problem.
    ///
    /// # Errors
    /// Where the schedule is too long; an index out of range.
    pub fn range(&self, entry: Entry, first: usize, last: usize) -> Result<Vec<Edge>> {
        let zeros = self.string.dimension(entry);
        if first == 0 || first > last || last > zeros {
            let remedy = format!("entry {} has {zeros} positive zeros", entry.name());
            return Err(Error::input("edge", format!("{first}..{last}"), remedy));
        }
        let mut wanted = [const { None }; 4];
        wanted[entry as usize] = Some(first..=last);
        Ok(self.with_indices(&wanted)?.concat())
    }

    /// All edges, by entry.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn all(&self) -> Result<[Vec<Edge>; 4]> {
        let all = Entry::ALL.map(|entry| self.string.dimension(entry));
        self.with_indices(&all.map(|zeros| (zeros > 0).then_some(1..=zeros)))
    }

    /// The edges of each problem with the given indices, all side by side.
    pub fn with_indices(&self, wanted: &Indices) -> Result<[Vec<Edge>; 4]> {
        let mut found = eigenvalues(&self.string, wanted).into_iter();
        let mut edges = [const { Vec::new() }; 4];
        for (entry, edges) in Entry::ALL.into_iter().zip(&mut edges) {
            let first = wanted[entry as usize].as_ref().map_or(1, |range: &RangeInclusive<_>| *range.start());
            *edges = self.completed(entry, first, found.next().unwrap_or_default())?;
        }
        Ok(edges)
    }

    /// The edges `first`, `first` + 1, ... of one problem, those that doubles could not certify by more bits.
    fn completed(&self, entry: Entry, first: usize, found: Vec<Option<Edge>>) -> Result<Vec<Edge>> {
        // Without a new list where all are there already.
        let narrow = |edge: &Option<Edge>| edge.is_some_and(|edge| edge.is_narrow());
        let good = found.iter().filter(|edge| narrow(edge)).count();
        self.doubles.fetch_add(good as u64, Ordering::Relaxed);
        if good == found.len() {
            return Ok(found.into_iter().map(|edge| edge.expect("a narrow one")).collect());
        }
        let complete = |(edge, index): (Option<Edge>, usize)| match edge {
            Some(edge) if edge.is_narrow() => Ok(edge),
            edge => self.by_more_bits(entry, index, edge),
        };
        found.into_iter().zip(first..).map(complete).collect()
    }

    /// An edge that doubles could not certify, or left wide.
    fn by_more_bits(&self, entry: Entry, index: usize, wide: Option<Edge>) -> Result<Edge> {
        const DIGITS: u32 = 20;
        let found = match wide {
            Some(edge) => self.refine(&edge, DIGITS)?,
            None => {
                let seen = Sighting::of(&self.string, entry, index);
                let exact = |x: f64| rational::from_f64_exact(x).filter(Signed::is_positive);
                let start =
                    seen.alone.and_then(|(lo, hi)| Some(Enclosure { lo: exact(lo)?, hi: exact(hi)? }));
                self.digits_of((entry, index), start.as_ref(), DIGITS, seen.around)?
            }
        };
        let (lo, hi) = found.to_f64();
        Ok(Edge { entry, index: index as u32, lo, hi })
    }

    /// The edge to `digits` significant digits: an interval narrower than 10^-digits of itself.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn refine(&self, edge: &Edge, digits: u32) -> Result<Enclosure> {
        self.sharpened(edge, &Enclosure::from(edge), digits)
    }

    /// The same from an enclosure that may hold more digits than the edge.
    pub fn sharpened(&self, edge: &Edge, start: &Enclosure, digits: u32) -> Result<Enclosure> {
        let zero = (edge.entry, edge.index as usize);
        self.digits_of(zero, Some(start), digits, Some((edge.lo, edge.hi)))
    }

    /// The same from `start`, where there are no other zeros; else, others being so near that one double holds them too,
    /// or one on the end, from proven counts `around` where doubles see it.
    fn digits_of(
        &self,
        (entry, index): (Entry, usize),
        start: Option<&Enclosure>,
        digits: u32,
        around: Option<(f64, f64)>,
    ) -> Result<Enclosure> {
        self.precise.fetch_add(1, Ordering::Relaxed);
        let (function, relative) = (self.function(entry)?, tenth_power(digits));
        if let Some(found) = start.and_then(|start| precise::shrink(&function, start, &relative, false)) {
            return Ok(found);
        }
        let alone = exact_count::isolate(&function, &self.string, index, around);
        Ok(precise::shrink(&function, &alone, &relative, true).expect("it is isolated"))
    }

    /// An entry as a function of s.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn function(&self, entry: Entry) -> Result<EntryFunction> {
        EntryFunction::new(self.ratio, &self.rho, entry)
    }

    /// s = 4 sin²(m π/(2p)), where p θ = m π: the paper's eq. (9).
    pub fn resonance(&self, m: u64, bits: u32) -> Ball {
        let angle = Ball::pi(bits + 16).mul(
            &Ball::from_rational(&Rational::new(m.into(), (2 * self.ratio.p()).into()), bits + 16),
            bits + 16,
        );
        angle.sin(bits + 8).square(bits).scale2(2)
    }
}

/// 10^-digits.
fn tenth_power(digits: u32) -> Rational {
    Rational::new(1.into(), num_bigint::BigInt::from(10).pow(digits))
}
