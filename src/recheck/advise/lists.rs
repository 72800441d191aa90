//! That no row, pair or interval is left out.

use num_traits::Zero;

use super::claim::{Claim, Interval, Mode, Row};
use crate::advise::{Intervals, MOST_INTERVALS, reach};
use crate::number::rational::to_f64;
use crate::number::{Laurent, Ratio};
use crate::recheck::context::{Checked, holds};

impl Claim {
    /// A row for each mode that is not on the outermost clock alone at each scheme, all pairs of them, and no interval left out.
    pub fn whole_lists(&self) -> Checked {
        let last = self.input.schemes.first().map_or(0, Vec::len) as u64;
        let inner = |mode: &&Mode| last == 1 || mode.clock < last;
        let mut names: Vec<&str> =
            self.input.modes.iter().filter(inner).map(|mode| mode.name.as_str()).collect();
        if names.is_empty() {
            names = self.input.modes.iter().map(|mode| mode.name.as_str()).collect();
        }
        let schemes = 1..=self.schemes.len() as u64;
        let rows = schemes.clone().flat_map(|n| names.iter().map(move |name| (n, *name)));
        let told = self.rows.iter().map(|row| (row.scheme, row.mode.as_str()));
        holds(told.eq(rows), || "the rows are not those of each mode at each scheme".into())?;
        let of = |n: u64| {
            let names = &names;
            (0..names.len()).flat_map(move |i| names[i + 1..].iter().map(move |other| (n, names[i], *other)))
        };
        let told = self.pairs.iter().map(|pair| (pair.scheme, pair.first.as_str(), pair.second.as_str()));
        holds(told.eq(schemes.flat_map(of)), || {
            "the pairs are not all pairs of modes at each scheme".into()
        })?;
        // Each interval behind those of the rows before its own.
        let row = |own: &Interval| {
            self.rows.iter().position(|row| row.scheme == own.scheme && row.mode == own.mode)
        };
        let places: Option<Vec<usize>> = self.intervals.iter().map(row).collect();
        holds(places.is_some_and(|all| all.is_sorted()), || {
            "the intervals are not those of the rows".into()
        })?;
        self.rows.iter().try_for_each(|row| self.list(row))
    }

    /// The intervals of a row: labels rise by one, but past closed ones, until one begins beyond what is listed.
    fn list(&self, row: &Row) -> Checked {
        let mode = self.input.modes.iter().find(|mode| mode.name == row.mode);
        let mass = self.mass(row.scheme as usize - 1, mode)?;
        let listed = |own: &&Interval| own.scheme == row.scheme && own.mode == row.mode;
        let own: Vec<&Interval> = self.intervals.iter().filter(listed).collect();
        let rises = own.windows(2).all(|pair| pair[0].m < pair[1].m);
        holds(rises, || format!("the intervals of {} are not in their order", row.mode))?;
        let (Some(first), [inner, outer]) = (row.first_lower, &mass.steps[..]) else { return Ok(()) };
        if let (Some(upper), Some(begins)) = (row.first_upper, own.first()) {
            let told = (begins.m, begins.lower.lo, begins.upper.map(|upper| upper.hi));
            holds(told == (1, first.lo, Some(upper.hi)), || "the first interval is another one".into())?;
        }
        let stiffness = self.exact_stiffness(row)?;
        if stiffness[0].is_zero() || own.len() == MOST_INTERVALS {
            return Ok(());
        }
        let intervals = Intervals::new(Ratio::try_from(&(outer / inner))?, &stiffness[0], &stiffness[1])?;
        let reach = reach(row.first_upper.map(|upper| upper.hi), to_f64(outer));
        let listed = own.iter().map(|own| own.m).max().unwrap_or(0);
        for m in (1..=listed + 1).take_while(|m| *m <= intervals.last()) {
            let truth = intervals.get(m)?.filter(|truth| truth.lower.0 <= reach);
            holds(truth.is_some() == own.iter().any(|own| own.m == m), || {
                format!("interval {m} is missing")
            })?;
        }
        Ok(())
    }

    /// The stiffness on each clock, as [`Claim::mass`] has it in balls.
    fn exact_stiffness(&self, row: &Row) -> Checked<Vec<Laurent>> {
        let clocks = self.input.schemes[row.scheme as usize - 1].len() as u64;
        let of = |clock: u64| {
            let on = || self.input.modes.iter().filter(move |mode| mode.clock == clock);
            let own = on().find(|mode| mode.name == row.mode);
            let stiffest = own.or_else(|| on().max_by(|a, b| a.stiffness.cmp(&b.stiffness)));
            stiffest.map_or_else(Laurent::zero, |mode| mode.stiffness.0.clone())
        };
        Ok((1..=clocks).map(of).collect())
    }
}
