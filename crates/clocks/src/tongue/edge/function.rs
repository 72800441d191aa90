//! An entry of the half period as a function of s, at rational points.

use crate::orbit::refine::{self, End};
use crate::orbit::residue;
use crate::orbit::returns::{self, Wanted};
use crate::propagator::TwoClocks;
use crate::schedule::Schedule;
use crate::tongue::string::{Entry, MOST_KICKS};
use crate::verdict::Decidable;
use number::{Ball, Laurent, Ratio, Rational, Result, Sign};

/// An entry of the half period as a function of s, for fixed p/q and ρ.
#[derive(Clone, Debug)]
pub(crate) struct EntryFunction {
    ratio: Ratio,
    /// The slow clock's mass ρ p/q, in those of the fast one.
    slow: Rational,
    schedule: Schedule,
    pub entry: Entry,
    by: By,
}

/// How the orbits are followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum By {
    /// Kick by kick, in as many bits as it takes; exactly in the end.
    Kicks,
    /// By return maps in doubles or two doubles, where the kicks are too many to be followed in 256 bits. A
    /// sign that these maps cannot decide stays unknown.
    Returns,
}

/// Bits beyond which the refine tier is not asked before exact arithmetic: so many times what the cell's size
/// asks. Of a long period they still cost far less than exact numbers, whose length grows with every kick;
/// and a mode that lives far from the ends wants twice the digits that its ends are small by.
const BITS_BEFORE_EXACT: u32 = 64;

impl EntryFunction {
    pub fn new(ratio: Ratio, rho: &Rational, entry: Entry, by: By) -> Result<Self> {
        let slow = rho * Rational::from(ratio);
        Ok(EntryFunction { ratio, slow, schedule: Schedule::two_clocks(ratio)?, entry, by })
    }

    fn clocks(&self, s: &Rational) -> TwoClocks<Rational> {
        TwoClocks::new(self.ratio, s.clone(), s * &self.slow)
    }

    /// The entry's exact sign at s.
    pub fn exact_sign(&self, s: &Rational) -> Sign {
        Decidable::half_signs(&self.clocks(s)).all()[self.entry as usize]
    }

    /// Whether the entry is zero at s; mostly a residue shows that it is not, at a cost linear in the period.
    pub fn is_zero_at(&self, s: &Rational) -> bool {
        let [fast, slow] = [s.clone(), s * &self.slow].map(Laurent::from_rational);
        !residue::nonzero_entries(&TwoClocks::new(self.ratio, fast, slow)) && self.exact_sign(s) == Sign::Zero
    }

    /// Where the entry's orbit ends at s, enclosed by so many bits.
    pub fn orbit(&self, s: &Rational, bits: u32) -> Option<End> {
        // In no lowest terms: balls do not need them.
        let slow = Rational::new_raw(s.numer() * self.slow.numer(), s.denom() * self.slow.denom());
        let clocks = TwoClocks::new(self.ratio, s.clone(), slow);
        match self.by {
            By::Kicks => refine::run_one(&clocks, &self.schedule, bits, self.entry.starts_free()),
            By::Returns => {
                let ends = returns::run(&(&clocks).into(), bits, Wanted::Nodes)?;
                Some(if self.entry.starts_free() { ends.even } else { ends.odd })
            }
        }
    }

    /// The entry's value at s, with a certified sign, from `bits` bits; the exact ball 0 where it is 0. And
    /// how many zeros lie below s, if those bits decide it.
    ///
    /// `None` where return maps cannot decide it.
    pub fn value(&self, s: &Rational, bits: u32) -> Option<(Ball, Option<u64>)> {
        let known = |working: u32| {
            let end = self.orbit(s, working)?;
            let count = self.counted(&end);
            let value = if self.entry.ends_free() { end.v } else { end.x };
            value.sign().is_some().then_some((value, count))
        };
        if self.by == By::Returns {
            return self.bits_of_returns().filter(|&working| bits <= working).find_map(known);
        }
        let mut tried = std::iter::successors(Some(bits), |bits| Some(2 * bits));
        let found = tried.by_ref().take_while(|&working| working <= BITS_BEFORE_EXACT * bits).find_map(known);
        Some(found.unwrap_or_else(|| (Ball::from_integer(&self.exact_sign(s).to_i8().into()), None)))
    }

    /// How many zeros lie below s, by return maps.
    pub fn count(&self, s: &Rational) -> Option<u64> {
        self.bits_of_returns().find_map(|bits| self.counted(&self.orbit(s, bits)?))
    }

    /// In 256 bits return maps cost a hundred times what they do in two doubles, and as much as some 10^5
    /// kicks.
    fn bits_of_returns(&self) -> impl Iterator<Item = u32> {
        let most = if self.ratio.kicks() > MOST_KICKS { 256 } else { 106 };
        returns::PRECISIONS.into_iter().filter(move |&bits| bits <= most)
    }

    /// In how many bits a value is worth computing that is to be known to so many binary digits of its size
    /// between two zeros: return maps lose fewer than kicks do.
    pub fn bits_for(&self, digits: u32) -> u32 {
        match self.by {
            By::Kicks => (digits + 96).next_multiple_of(32),
            By::Returns => digits + 20,
        }
    }

    /// The number of zeros below the s of an orbit; `None` if its signs are not certain or s may be a zero.
    pub fn counted(&self, end: &End) -> Option<u64> {
        let (changes, (x, v)) = (end.nodes?, (end.signs.0?, end.signs.1?));
        // At a free end the slope's zeros count; the rigid shift of C does not.
        let at_free_end = || changes + u64::from(x != v) - u64::from(self.entry == Entry::C);
        Some(if self.entry.ends_free() { at_free_end() } else { changes })
    }
}
