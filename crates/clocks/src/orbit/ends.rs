//! Where two solutions are after half a period: values, signs, and the sign changes of x on the way.

use crate::propagator::PartialSigns;
use number::{Ball, Sign};

/// The even and the odd solution at T/2, in the time unit h1.
#[derive(Clone, Debug)]
pub struct Ends {
    pub even: End,
    pub odd: End,
}

/// One solution at T/2: enclosures, certified signs, and the sign changes of x on the way.
#[derive(Clone, Debug)]
pub struct End {
    pub x: Ball,
    pub v: Ball,
    pub signs: (Option<Sign>, Option<Sign>),
    /// `None` where some sign is undecided.
    pub nodes: Option<u64>,
}

impl Ends {
    /// The signs of A, B, C, D as far as this precision decides them.
    pub fn signs(&self) -> PartialSigns {
        let ((a, c), (b, d)) = (self.even.signs, self.odd.signs);
        PartialSigns { a, b, c, d }
    }
}

/// Counts the sign changes of x from kick to kick.
///
/// Where one sign is uncertain, x is near 0 and its neighbours' signs differ: still one change. Equal
/// neighbours, or two uncertain signs in a row, leave the count unknown.
#[derive(Clone, Debug, Default)]
pub struct Nodes {
    last: Option<Sign>,
    uncertain: u32,
    changes: u64,
    unknown: bool,
}

impl Nodes {
    // Called at every kick, from another file.
    #[inline]
    pub fn see(&mut self, sign: Option<Sign>) {
        if sign.is_none() {
            self.uncertain += 1;
            return;
        }
        let changed = self.last.is_some() && self.last != sign;
        self.changes += u64::from(changed);
        // An orbit that begins at x = 0 has no sign there, and no change.
        self.unknown |= self.uncertain > 1 || (self.uncertain == 1 && self.last.is_some() && !changed);
        self.uncertain = 0;
        self.last = sign;
    }

    /// The sign last seen, where it was certain.
    pub fn last_certain(&self) -> Option<Sign> {
        self.last.filter(|_| self.uncertain == 0)
    }

    /// Goes on to a later sign, with so many changes on the way; `None` where they are not known.
    pub fn pass(&mut self, changes: Option<u64>, sign: Option<Sign>) {
        self.unknown |= changes.is_none();
        self.changes += changes.unwrap_or(0);
        (self.last, self.uncertain) = (sign, u32::from(sign.is_none()));
    }

    pub fn count(&self) -> Option<u64> {
        (!self.unknown && self.uncertain == 0).then_some(self.changes)
    }
}
