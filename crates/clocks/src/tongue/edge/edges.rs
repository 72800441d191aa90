//! The edges of one ratio, in doubles where these prove them and by more bits elsewhere.

use std::cmp::Ordering;
use std::ops::RangeInclusive;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

use num_bigint::BigInt;
use num_traits::Zero;

use super::eigenvalues::{eigenvalues, sighting};
use super::enclosure::{Edge, Enclosure};
use super::fine_count::{self, TWO_DOUBLES};
use super::function::{By, EntryFunction};
use super::{long, modular, precise, proven_count};
use crate::orbit::returns;
use crate::tongue::string::{Entry, HalfString, Indices, MOST_KICKS};
use number::parallel::go_on;
use number::{Ball, Error, Laurent, Ratio, Rational, Real, Result};

/// How much work was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effort {
    /// Edges certified in doubles.
    pub doubles: u64,
    /// Edges certified with more bits, refinements for a width or an order included.
    pub precise: u64,
}

/// So many edges of a long period cost less one by one than the string's laying out and all its modes side by
/// side.
const ONE_BY_ONE: usize = 64;

/// More edges of a period that is not laid out are not looked for at a time: some hours of them.
const MOST_EDGES: usize = 1 << 20;

/// A relative width of 2^-56 shows in no double.
const DIGITS_OF_DOUBLES: u32 = 56;

/// All tongues of one p/q and ρ ≥ 0, computed as they are asked for; their edges are the zeros of the entries
/// A, B, C and D in s > 0.
#[derive(Debug)]
pub struct Tongues {
    ratio: Ratio,
    rho: Rational,
    /// Laid out when it is first needed.
    string: OnceLock<HalfString>,
    /// Whether all tongues of even m, and all of odd m, are proven open.
    open: [OnceLock<bool>; 2],
    doubles: AtomicU64,
    precise: AtomicU64,
}

impl Clone for Tongues {
    fn clone(&self) -> Self {
        let Effort { doubles, precise } = self.effort();
        let (rho, string, open) = (self.rho.clone(), self.string.clone(), self.open.clone());
        Tongues { ratio: self.ratio, rho, string, open, doubles: doubles.into(), precise: precise.into() }
    }
}

impl Tongues {
    /// The tongues of h2/h1 = p/q and ρ = L2/L1.
    ///
    /// # Errors
    /// ρ < 0 (then the masses are no string's), ρ p/q beyond 1e±16.
    pub fn new(ratio: Ratio, rho: &Rational) -> Result<Self> {
        HalfString::check(ratio, rho)?;
        let (string, open) = Default::default();
        Ok(Tongues { ratio, rho: rho.clone(), string, open, doubles: 0.into(), precise: 0.into() })
    }

    /// h2/h1 = p/q.
    pub fn ratio(&self) -> Ratio {
        self.ratio
    }

    /// The numerator of h2/h1.
    pub fn p(&self) -> u64 {
        self.ratio.p()
    }

    /// ρ = L2/L1.
    pub fn rho(&self) -> &Rational {
        &self.rho
    }

    /// m of the last tongue, which is infinite: p + q − 1, or p for ρ = 0.
    pub fn last(&self) -> u64 {
        if self.rho.is_zero() { self.p() } else { self.ratio.kicks() - 1 }
    }

    /// The half period as a string.
    ///
    /// # Errors
    /// Too many kicks to be laid out.
    pub(crate) fn string(&self) -> Result<&HalfString> {
        if let Some(string) = self.string.get() {
            return Ok(string);
        }
        let string = HalfString::new(self.ratio, &self.rho)?;
        Ok(self.string.get_or_init(|| string))
    }

    /// How many positive zeros an entry has.
    pub fn zeros(&self, entry: Entry) -> usize {
        HalfString::dimension(self.ratio, self.rho.is_zero(), entry)
    }

    /// Whether the period is so long that edges are found one by one.
    pub(crate) fn is_long(&self) -> bool {
        returns::is_worth(self.ratio, f64::MANTISSA_DIGITS)
    }

    /// The work done so far.
    pub fn effort(&self) -> Effort {
        let [doubles, precise] = [&self.doubles, &self.precise].map(|count| count.load(Relaxed));
        Effort { doubles, precise }
    }

    /// The edges `first` ..= `last` of one problem, counted from 1.
    ///
    /// # Errors
    /// Where the schedule is too long; an index out of range.
    pub fn edges(&self, entry: Entry, first: usize, last: usize) -> Result<Vec<Edge>> {
        let zeros = self.zeros(entry);
        if first == 0 || first > last || last > zeros {
            let remedy = format!("entry {} has {zeros} positive zeros", entry.name());
            return Err(Error::input("edge", format!("{first}..{last}"), remedy));
        }
        let mut wanted = [const { None }; 4];
        wanted[entry as usize] = Some(first..=last);
        Ok(self.with_indices(&wanted)?.concat())
    }

    /// All edges, by entry: the quickest way to have them all.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn all_edges(&self) -> Result<[Vec<Edge>; 4]> {
        let all = Entry::ALL.map(|entry| self.zeros(entry));
        self.with_indices(&all.map(|zeros| (zeros > 0).then_some(1..=zeros)))
    }

    /// The edges of each problem with the given indices, all side by side.
    pub(crate) fn with_indices(&self, wanted: &Indices) -> Result<[Vec<Edge>; 4]> {
        let mut edges = [const { Vec::new() }; 4];
        let count: usize = wanted.iter().flatten().map(|range| range.clone().count()).sum();
        if self.is_long() && count <= if self.ratio.kicks() > MOST_KICKS { MOST_EDGES } else { ONE_BY_ONE } {
            let one_by_one = |entry: Entry| {
                let range = wanted[entry as usize].clone().into_iter().flatten();
                range
                    .map(|index| go_on().and_then(|()| self.lone(entry, index)))
                    .collect::<Result<Option<Vec<_>>>>()
            };
            if let [Some(a), Some(b), Some(c), Some(d)] =
                [one_by_one(Entry::A)?, one_by_one(Entry::B)?, one_by_one(Entry::C)?, one_by_one(Entry::D)?]
            {
                return Ok([a, b, c, d]);
            }
        }
        let string = self.string()?;
        let mut found = eigenvalues(string, wanted).into_iter();
        for (entry, edges) in Entry::ALL.into_iter().zip(&mut edges) {
            let first = wanted[entry as usize].as_ref().map_or(1, |range: &RangeInclusive<_>| *range.start());
            *edges = self.completed(string, entry, first, found.next().unwrap_or_default())?;
        }
        Ok(edges)
    }

    /// The edges `first`, `first` + 1, ... of one problem, those that doubles could not certify by more bits.
    fn completed(
        &self,
        string: &HalfString,
        entry: Entry,
        first: usize,
        found: Vec<Option<Edge>>,
    ) -> Result<Vec<Edge>> {
        // Without a new list where all are there already.
        let narrow = |edge: &Option<Edge>| edge.is_some_and(|edge| edge.is_narrow());
        let good = found.iter().filter(|edge| narrow(edge)).count();
        self.doubles.fetch_add(good as u64, Relaxed);
        if good == found.len() {
            return Ok(found.into_iter().map(|edge| edge.expect("a narrow one")).collect());
        }
        let complete = |(edge, index): (Option<Edge>, usize)| match edge {
            Some(edge) if edge.is_narrow() => Ok(edge),
            edge => Ok(self.by_more_bits(string, entry, index, edge)),
        };
        found.into_iter().zip(first..).map(complete).collect()
    }

    /// An edge that doubles could not certify, or left wide.
    fn by_more_bits(&self, string: &HalfString, entry: Entry, index: usize, wide: Option<Edge>) -> Edge {
        self.precise.fetch_add(1, Relaxed);
        let seen = wide.map(|edge| (edge.lo, edge.hi)).or_else(|| sighting(string, entry, index));
        let (lo, hi) = fine_count::enclose(string, entry, index, seen).to_f64();
        Edge { entry, index: index as u32, lo, hi }
    }

    /// An edge of a long period, where return maps can find it.
    fn lone(&self, entry: Entry, index: usize) -> Result<Option<Edge>> {
        let function = EntryFunction::new(self.ratio, &self.rho, entry, By::Returns)?;
        let narrow = Rational::new(1.into(), BigInt::from(1u64 << DIGITS_OF_DOUBLES));
        let found = long::isolate(&function, index);
        let found = found.and_then(|alone| precise::shrink(&function, &alone, &narrow, true));
        self.doubles.fetch_add(u64::from(found.is_some()), Relaxed);
        Ok(found.map(|found| {
            let (lo, hi) = found.to_f64();
            Edge { entry, index: index as u32, lo, hi }
        }))
    }

    /// The edge to `digits` significant digits: an interval narrower than 10^-digits of itself.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn refine(&self, edge: &Edge, digits: u32) -> Result<Enclosure> {
        self.sharpened(edge, &Enclosure::from(edge), digits)
    }

    /// The edge to `digits` significant digits, from an enclosure that may be narrower than the edge's own.
    /// Where it holds another zero, or one on its end, proven counts identify the edge.
    pub(crate) fn sharpened(&self, edge: &Edge, start: &Enclosure, digits: u32) -> Result<Enclosure> {
        self.precise.fetch_add(1, Relaxed);
        let (entry, index, around) = (edge.entry, edge.index as usize, Some((edge.lo, edge.hi)));
        if let Some(found) = self.by_returns(edge, start, digits)? {
            return Ok(found);
        }
        if digits <= TWO_DOUBLES {
            return Ok(fine_count::enclose(self.string()?, entry, index, around));
        }
        let (function, relative) = (self.function(entry)?, tenth_power(digits));
        if let Some(found) = precise::shrink(&function, start, &relative, false) {
            return Ok(found);
        }
        let alone = proven_count::isolate(&function, self.string()?, index, around);
        Ok(precise::shrink(&function, &alone, &relative, true).expect("it is isolated"))
    }

    /// As [`Tongues::sharpened`] by return maps alone; `None` where they cannot decide it, and of a period
    /// that is not long.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub(crate) fn by_returns(
        &self,
        edge: &Edge,
        start: &Enclosure,
        digits: u32,
    ) -> Result<Option<Enclosure>> {
        if !self.is_long() {
            return Ok(None);
        }
        let function = EntryFunction::new(self.ratio, &self.rho, edge.entry, By::Returns)?;
        Ok(precise::shrink(&function, start, &tenth_power(digits), false))
    }

    /// How an edge compares with a number, decided. An enclosure as narrow as it takes holds one zero, so a
    /// rational zero in it is the edge; powers of π are no edges.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub(crate) fn compare(&self, edge: &Edge, s: &Laurent) -> Result<Ordering> {
        let exact = s.as_rational();
        let order = |enclosure: &Enclosure, bits: u32| {
            let [least, most] = match &exact {
                Some(s) => [s.clone(), s.clone()],
                None => {
                    let s = s.enclosure(bits);
                    [s.lower(), s.upper()]
                }
            };
            let beyond = || (enclosure.lo > most).then_some(Ordering::Greater);
            if enclosure.hi < least { Some(Ordering::Less) } else { beyond() }
        };
        let mut near = Enclosure::from(edge);
        let mut digits = TWO_DOUBLES;
        loop {
            if let Some(order) = order(&near, 4 * digits) {
                return Ok(order);
            }
            near = self.sharpened(edge, &near, digits)?;
            let holds = |s: &Rational| near.lo <= *s && *s <= near.hi;
            if let Some(s) = exact.as_ref().filter(|s| holds(s))
                && self.function(edge.entry)?.is_zero_at(s)
            {
                return Ok(Ordering::Equal);
            }
            digits *= 2;
        }
    }

    /// An entry as a function of s.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub(crate) fn function(&self, entry: Entry) -> Result<EntryFunction> {
        EntryFunction::new(self.ratio, &self.rho, entry, By::Kicks)
    }

    /// Whether all tongues of one parity of m are proven open, ρ being positive; computed once.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub(crate) fn are_open(&self, odd: bool) -> Result<bool> {
        let known = &self.open[usize::from(odd)];
        if let Some(&open) = known.get() {
            return Ok(open);
        }
        let degrees = Entry::of_tongue(odd).map(|entry| self.zeros(entry));
        let open = modular::all_open(self.ratio, &self.rho, odd, degrees)?;
        Ok(*known.get_or_init(|| open))
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
    Rational::new(1.into(), BigInt::from(10).pow(digits))
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::ratio;

    /// Weak and strong slow forces, tongues from the first to beyond the fast clock's limit.
    #[test]
    fn return_maps_and_strings_find_the_same_edges() {
        let mut found = 0;
        for (p, q, rho) in
            [(16411, 16421, ratio(1, 10)), (40009, 16901, ratio(3, 100)), (16901, 40009, ratio(2, 1))]
        {
            let tongues = Tongues::new(Ratio::new(p, q).unwrap(), &rho).unwrap();
            for entry in Entry::ALL {
                let last = tongues.zeros(entry);
                for index in [1, 2, last / 7, last / 3, last / 2, last - 1, last] {
                    let Some(edge) = tongues.lone(entry, index).unwrap() else { continue };
                    let mut wanted = [const { None }; 4];
                    wanted[entry as usize] = Some(index..=index);
                    let other = eigenvalues(tongues.string().unwrap(), &wanted)[entry as usize][0].unwrap();
                    assert!(
                        edge.is_narrow() && edge.lo <= other.hi && other.lo <= edge.hi,
                        "{edge:?} {other:?}"
                    );
                    found += 1;
                }
            }
        }
        // Where both clocks are strong, return maps in two doubles leave some to the string.
        assert!(found >= 40, "{found} of 84");
    }

    #[test]
    fn a_period_of_too_many_kicks_to_lay_out_has_its_tongues() {
        let rho = ratio(1, 10);
        let tongues = Tongues::new(Ratio::new(13717421, 109739369).unwrap(), &rho).unwrap();
        assert!(tongues.string().is_err());
        let edge = tongues.lone(Entry::A, 3).unwrap().unwrap();
        // The slow kicks being small and close, the fast ones too: s = h1² L1 of the fifth half turn of a
        // smooth force.
        let smooth = (5.0 * std::f64::consts::PI / 13717421.0).powi(2) / (1.0 + 0.1);
        assert!((edge.middle() / smooth - 1.0).abs() < 1e-10, "{edge:?} {smooth}");
    }
}
