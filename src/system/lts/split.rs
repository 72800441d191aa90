//! Two more schemes on the levels of local time steps. Both are kicks and drifts, so each is decided as a system of clocks is.
//!
//! **Subcycling with held velocities** (Belytschko, Yen and Mullen 1979; Daniel, "The subcycled Newmark algorithm", Comput. Mech. 20, 272–281, 1997; in
//! Abaqus/Explicit "selective subcycling"): explicit Newmark (central differences) node by node. A degree of freedom of the step d kicks at the multiples of d
//! and moves with that velocity until its next kick, so fine ones see coarse neighbours that move on linearly meanwhile:
//!
//! ```text
//!     v_i ← v_i − d_i (M⁻¹ K x)_i   at t = 0, d_i, 2 d_i, …,      x ← x + t v   in between
//! ```
//!
//! The kick of a level is its rows of K, which are no symmetric matrix: a force without a potential of its own, though K has one. So its step is decided by
//! [`Jacobians`]. The levels' kicks at one time are all of the same positions, so they commute. Up to its first unstable step two factorizations decide, too (file `held`).
//!
//! **AVI** (Lew, Marsden, Ortiz and West 2003): element by element. The elements of a level share a clock, and the kick is that of their stiffness, which is
//! symmetric: the system of these clocks.

use nalgebra::DMatrix;
use num_traits::Zero;

use super::held::SparseSubcycles;
use super::scheme::{Level, Scheme, SchemeSummary, plain_limit};
use crate::error::{Error, Result};
use crate::number::rational::to_f64;
use crate::number::{Rational, U};
use crate::system::jacobian::Jacobians;
use crate::system::linear::system::System;

/// Entries of a system in layers, twice as many at most: some seconds.
const MOST_ENTRIES: usize = 1_000_000;

/// Levels of steps under one of these schemes, beside the clocks that decide it.
#[derive(Clone, Debug)]
pub struct Subcycles {
    scheme: Scheme,
    plain: System,
    /// Degrees of freedom, or elements.
    size: usize,
    levels: Vec<Level>,
}

impl Subcycles {
    /// Subcycling with held velocities, and the clocks that decide it. `plain` has one clock, whose step is that of all which is in no level.
    ///
    /// ```
    /// use kickdrift::number::rational::ratio;
    /// use kickdrift::system::{Level, Limits, Potential, Route, Subcycles, Symmetric, System};
    /// use nalgebra::DMatrix;
    /// // Two masses, the second on a stiff spring: it takes two substeps in each step.
    /// let stiffness = Symmetric::try_from(&DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 9.0]))?;
    /// let mass = Symmetric::diagonal(&[ratio(1, 1), ratio(1, 1)]);
    /// let stable = |step| {
    ///     let plain = System::new(mass.clone(), vec![Potential::new(stiffness.clone(), step)])?;
    ///     let (_, clocks) = Subcycles::newmark(plain, vec![Level { fine: [1].into(), substeps: 2 }])?;
    ///     Ok::<_, kickdrift::error::Error>(clocks.decide(Route::Cheapest, &Limits::default())?.is_stable())
    /// };
    /// assert!(stable(ratio(1, 2))? && !stable(ratio(3, 2))?);
    /// # Ok::<(), kickdrift::error::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`LocalSteps::new`](super::LocalSteps::new).
    pub fn newmark(plain: System, levels: Vec<Level>) -> Result<(Subcycles, Jacobians)> {
        Level::of_one_clock(&plain, &levels)?;
        let (n, clock) = (plain.size(), &plain.clocks()[0]);
        let mut step = clock.step.clone();
        let mut given = Vec::new();
        for l in 0..=levels.len() {
            let is_own = |i: usize| {
                let is_in = |level: Option<&Level>| level.is_some_and(|own| own.fine.contains(&i));
                (l == 0 || is_in(levels.get(l - 1))) && !is_in(levels.get(l))
            };
            let row = |i, j| if is_own(i) { clock.stiffness.get(i, j) } else { Rational::zero() };
            given.push((DMatrix::from_fn(n, n, row), step.clone(), Rational::zero()));
            step /= Rational::from_integer(levels.get(l).map_or(1, |own| own.substeps).into());
        }
        let masses: Vec<_> = (0..n).map(|i| plain.mass().get(i, i)).collect();
        let clocks = Jacobians::rational(&masses, &given)?;
        Ok((Subcycles { scheme: Scheme::Newmark, plain, size: n, levels }, clocks))
    }

    /// AVI of `size` elements. `clocks` is the system in which the elements of each level kick with their own step.
    ///
    /// # Errors
    /// As [`Subcycles::substeps`].
    pub fn avi(clocks: System, size: usize, levels: Vec<Level>) -> Result<Subcycles> {
        Level::check(&levels, size)?;
        Ok(Subcycles { scheme: Scheme::Avi, plain: clocks, size, levels })
    }

    /// The substeps of each degree of freedom or element of `size` in a step.
    ///
    /// # Errors
    /// No level, levels that are no parts of the ones above, indices of `size` or more, too many substeps.
    pub fn substeps(levels: &[Level], size: usize) -> Result<Vec<u32>> {
        Level::check(levels, size)?;
        Ok((0..size).map(|i| Level::substeps_of(levels, i)).collect())
    }

    /// Which of the schemes it is.
    pub fn scheme(&self) -> Scheme {
        self.scheme
    }

    /// The levels, the coarsest first, of degrees of freedom or of elements.
    pub fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// Masses and stiffness; of subcycling one clock has the step of the whole.
    pub fn plain(&self) -> &System {
        &self.plain
    }

    /// Of subcycling, as [`SparseSubcycles::first_unstable`] of this system rounded, the roundings within its proof; `None` also where its layers would be large.
    pub fn first_unstable(&self) -> Option<(f64, f64)> {
        self.first().map(|own| own.0)
    }

    /// The first unstable step, and whether all that is proven at its upper end is the multiplier −1.
    fn first(&self) -> Option<((f64, f64), bool)> {
        let (clock, mass) = (self.plain.clocks().first()?, self.plain.mass());
        let stiffness = &clock.stiffness;
        let layers: usize = self.levels.iter().map(|own| own.substeps as usize).product();
        if self.scheme != Scheme::Newmark || stiffness.places().count() * layers > MOST_ENTRIES {
            return None;
        }
        let masses: Vec<f64> = (0..self.size).map(|i| to_f64(&mass.get(i, i))).collect();
        let row = |i: usize| stiffness.row(i).iter().map(move |(&j, x)| (i, j, to_f64(x)));
        let entries: Vec<_> = (0..self.size).flat_map(row).collect();
        // Of an entry and of two masses, half of each.
        SparseSubcycles::within(&masses, &entries, self.levels.clone(), 3.0 * U).ok()?.first()
    }

    /// The scheme as answers state it: its levels, and plain leapfrog's limit beside them.
    pub fn summary(&self) -> SchemeSummary {
        let first = self.first();
        SchemeSummary {
            scheme: self.scheme,
            size: self.size,
            levels: self.levels.iter().map(|own| (own.fine.len(), own.substeps)).collect(),
            plain_limit: plain_limit(&self.plain),
            first_unstable: first.map(|own| own.0),
            is_minus_one: first.is_some_and(|own| own.1),
        }
    }
}

impl std::str::FromStr for Scheme {
    type Err = Error;

    /// # Errors
    /// Another name.
    fn from_str(name: &str) -> Result<Scheme> {
        let found = Scheme::ALL.into_iter().find(|own| own.name() == name);
        found.ok_or_else(|| {
            let remedy = "name lts (leapfrog with local time steps), newmark (subcycling with held velocities) or avi (a clock for each element)";
            Error::input("scheme", name, remedy)
        })
    }
}
