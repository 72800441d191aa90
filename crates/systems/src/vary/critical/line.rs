//! Systems on a line: masses and stiffnesses linear in s, from those at s = 0 to those at s = 1.

use nalgebra::DMatrix;

use crate::half::compose::connected;
use crate::linear::frame::Frame;
use crate::linear::sparse::Symmetric;
use crate::linear::split::{Subspace, Symmetry, invariant_subspaces, symmetry};
use crate::linear::system::{Potential, System};
use number::{Rational, Result};

/// Parts of at most this size are split along rational eigenvectors that all systems have in common.
const SMALL: usize = 16;

/// The systems between two whose potentials have the same steps, in order.
pub struct Line {
    pub ends: [System; 2],
    /// Whether all potentials of all systems are known to commute.
    pub commutes: bool,
    /// Where they are not: what commutes with them, and with all that does.
    pub symmetry: Option<DMatrix<Rational>>,
}

impl Line {
    pub fn new(ends: [System; 2]) -> Line {
        Line { ends, commutes: false, symmetry: None }
    }

    /// Whether all systems are one.
    pub fn is_constant(&self) -> bool {
        let [lo, hi] = &self.ends;
        lo.mass() == hi.mass() && lo.potentials() == hi.potentials()
    }

    pub fn varies_mass(&self) -> bool {
        self.ends[0].mass() != self.ends[1].mass()
    }

    /// The system at s.
    ///
    /// # Errors
    /// As [`System::new`].
    pub fn at(&self, s: &Rational) -> Result<System> {
        let [lo, hi] = &self.ends;
        let rest = Rational::from_integer(1.into()) - s;
        let mixed = |a: &Symmetric, b: &Symmetric| {
            let mut sum = a.scaled(&rest);
            sum.add_all(&b.scaled(s));
            sum
        };
        let pairs = lo.potentials().iter().zip(hi.potentials());
        let potentials =
            pairs.map(|(a, b)| Potential { stiffness: mixed(&a.stiffness, &b.stiffness), ..a.clone() });
        System::new(mixed(lo.mass(), hi.mass()), potentials.collect())
    }

    /// The common null vectors of all potentials of all systems.
    pub fn frame(&self) -> Result<Frame> {
        let [lo, hi] = &self.ends;
        let both = lo.potentials().iter().chain(hi.potentials()).cloned().collect();
        Ok(Frame::new(&System::new(lo.mass().clone(), both)?))
    }

    /// The connected parts that some potential acts on, split where all potentials of all systems commute and
    /// masses do not vary, and along the symmetries that all systems have in common.
    pub fn parts(&self) -> Vec<Line> {
        let [lo, hi] = &self.ends;
        let matrices = |system: &System| {
            let stiffnesses = system.potentials().iter().map(|potential| potential.stiffness.clone());
            stiffnesses.chain([system.mass().clone()]).collect::<Vec<_>>()
        };
        let all = [matrices(lo), matrices(hi)].concat();
        let parts = connected(lo.size(), all.iter().flat_map(Symmetric::places));
        let acted = parts.into_iter().map(|dofs| Line::new([lo, hi].map(|system| system.part(&dofs))));
        acted.filter(Line::is_acted_on).flat_map(Line::split).collect()
    }

    /// Whether any potential acts.
    fn is_acted_on(&self) -> bool {
        self.ends.iter().any(|end| end.potentials().iter().any(|potential| !potential.stiffness.is_zero()))
    }

    fn split(self) -> Vec<Line> {
        if self.ends[0].size() > SMALL {
            return vec![self];
        }
        if self.varies_mass() {
            return self.along_symmetries();
        }
        let Ok(frame) = self.frame() else { return vec![self] };
        let complement = frame.complement(&self.ends[0]);
        let vibrating = Line::new(self.ends.each_ref().map(|ends| ends.restricted(&complement)));
        let stiffnesses: Vec<_> = vibrating
            .ends
            .iter()
            .flat_map(|end| end.potentials().iter().map(|potential| &potential.stiffness))
            .collect();
        let Some(spaces) = invariant_subspaces(&vibrating.ends[0], &stiffnesses) else {
            return vibrating.along_symmetries();
        };
        let along = |space: &Subspace| {
            let ends = vibrating.ends.each_ref().map(|ends| ends.restricted(space));
            Line { ends, commutes: true, symmetry: None }
        };
        spaces.iter().map(along).collect()
    }

    /// The eigenspaces of a symmetry, each split in turn; where they are not rational, all of it with a
    /// symmetry beside it.
    fn along_symmetries(mut self) -> Vec<Line> {
        let [lo, hi] = &self.ends;
        let stiffnesses =
            self.ends.iter().flat_map(|end| end.potentials()).map(|potential| &potential.stiffness);
        // A subspace that is invariant under M of one end, and under its inverse times M of the other end,
        // splits the masses in between, too.
        let all: Vec<_> = stiffnesses.chain([hi.mass()]).collect();
        let spaces = match symmetry(lo, &all) {
            Some(Symmetry::Subspaces(spaces)) => spaces,
            Some(Symmetry::Central(operator)) => {
                self.symmetry = Some(operator);
                return vec![self];
            }
            None => return vec![self],
        };
        let along = |space: &Subspace| Line::new(self.ends.each_ref().map(|ends| ends.restricted(space)));
        spaces.iter().map(along).filter(Line::is_acted_on).flat_map(Line::split).collect()
    }
}
