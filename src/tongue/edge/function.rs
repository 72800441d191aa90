//! An entry of the half period as a function of s, at rational points.

use crate::error::Result;
use crate::number::{Ball, Ratio, Rational, Sign};
use crate::orbit::refine::{self, End};
use crate::propagator::TwoClocks;
use crate::schedule::Schedule;
use crate::tongue::string::Entry;
use crate::verdict::Decidable;

/// An entry of the half period as a function of s, for fixed p/q and ρ.
#[derive(Clone, Debug)]
pub(crate) struct EntryFunction {
    ratio: Ratio,
    /// The slow clock's mass ρ p/q, in those of the fast one.
    pub slow: Rational,
    pub schedule: Schedule,
    pub entry: Entry,
}

/// Bits beyond which the refine tier is not asked before exact arithmetic: so many times what the cell's size asks. Of a
/// long period they still cost far less than exact numbers, whose length grows with every kick; and a mode that lives
/// far from the ends wants twice the digits that its ends are small by.
const BITS_BEFORE_EXACT: u32 = 64;

impl EntryFunction {
    pub fn new(ratio: Ratio, rho: &Rational, entry: Entry) -> Result<Self> {
        let slow = rho * Rational::from(ratio);
        Ok(EntryFunction { ratio, slow, schedule: Schedule::two_clocks(ratio)?, entry })
    }

    fn clocks(&self, s: &Rational) -> TwoClocks<Rational> {
        TwoClocks::new(self.ratio, s.clone(), s * &self.slow)
    }

    /// The entry's exact sign at s.
    pub fn exact_sign(&self, s: &Rational) -> Sign {
        Decidable::half_signs(&self.clocks(s)).all()[self.entry as usize]
    }

    /// Where the entry's orbit ends at s, enclosed by so many bits.
    pub fn orbit(&self, s: &Rational, bits: u32) -> Option<End> {
        // In no lowest terms: balls do not need them.
        let slow = Rational::new_raw(s.numer() * self.slow.numer(), s.denom() * self.slow.denom());
        let clocks = TwoClocks::new(self.ratio, s.clone(), slow);
        refine::run_one(&clocks, &self.schedule, bits, self.entry.starts_free())
    }

    /// The entry's value at s, with a certified sign, from `bits` bits; the exact ball 0 where it is 0. And how many zeros lie
    /// below s, if those bits decide it.
    pub fn value(&self, s: &Rational, bits: u32) -> (Ball, Option<u64>) {
        let mut working = bits;
        while working <= BITS_BEFORE_EXACT * bits {
            if let Some(end) = self.orbit(s, working) {
                let count = self.counted(&end);
                let value = if self.entry.ends_free() { end.v } else { end.x };
                if value.sign().is_some() {
                    return (value, count);
                }
            }
            working *= 2;
        }
        (Ball::from_integer(&self.exact_sign(s).to_i8().into()), None)
    }

    /// The zeros below the s of an orbit, where its signs are certain and s is none.
    pub fn counted(&self, end: &End) -> Option<u64> {
        let (changes, (x, v)) = (end.nodes?, (end.signs.0?, end.signs.1?));
        Some(if self.entry.ends_free() { self.free_count(changes, x != v) } else { changes })
    }

    /// At a free end the slope's zeros count; the rigid shift of C does not.
    pub fn free_count(&self, changes: u64, falling: bool) -> u64 {
        changes + u64::from(falling) - u64::from(self.entry == Entry::C)
    }
}
