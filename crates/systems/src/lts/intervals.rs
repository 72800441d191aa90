//! All unstable intervals of dt: between real roots of two determinants one step decides.
//!
//! K(X) = f/X is a polynomial in X = dt². Its signature and that of 4 M − X K(X), off the rigid motions,
//! change only at the real roots of
//!
//! ```text
//!     det Zᵀ K(X) Z,      det Zᵀ (4 M − X K(X)) Z,
//! ```
//!
//! Z a basis of what is M-orthogonal to them. At a root the scheme is unstable: a multiplier 1 or −1 has a
//! Jordan block.

use num_bigint::BigInt;
use num_traits::{One, Zero};

use super::scheme::LocalSteps;
use crate::half::compose::connected_parts;
use crate::linear::frame::Frame;
use crate::linear::sparse::Symmetric;
use crate::vary::critical::{Gap, gaps_of};
use crate::vary::edges::between;
use crate::vary::stretches::Stretch;
use crate::verdict::decide::decide_system;
use crate::verdict::limits::Limits;
use crate::verdict::measured::Holds;
use number::parallel::try_map;
use number::polynomial::integers;
use number::{Error, Polynomial, Rational, Result, from_f64_exact, ratio};

/// Products of machine words for one of rationals with some thousand bits.
const WORDS: f64 = 500.0;

impl LocalSteps {
    /// The verdicts on all steps from lo > 0 to hi: the end of a stretch and the beginning of the next are
    /// neighbouring doubles with one edge or more between them, or one stretch holds the edge, a double.
    ///
    /// # Errors
    /// A budget error where the determinants would cost more; as [`decide_system`].
    pub fn stretches(&self, range: (f64, f64), limits: &Limits) -> Result<Vec<Stretch>> {
        let verdict = |x: &Rational| Ok(decide_system(self.at(x)?.system(), limits)?.holds());
        // At a simple root one eigenvalue passes an end. On the side where it is within both, others are
        // unstable, and stay so.
        let within = |gap: &Gap, around: Holds| {
            Ok(if gap.is_simple() && around == Holds::Unstable { around } else { Holds::Undecided })
        };
        between(range, &self.gaps(range, limits)?, &verdict, &within)
    }

    /// The cost of these, in products of machine words.
    pub fn cost(&self) -> f64 {
        let part = |dofs: &Vec<usize>| {
            let local_steps = self.part(dofs);
            let (n, degree) = (local_steps.size() as f64, local_steps.degree() as f64);
            let words = degree + 16.0;
            WORDS * (degree + 1.0) * (local_steps.size() as f64).powi(3) / 3.0
                + 100.0 * degree * degree / 2.0 * words
                + n
        };
        connected_parts(self.plain()).iter().map(part).sum()
    }

    fn size(&self) -> usize {
        self.plain().size()
    }

    /// A bound on the degree in X of both determinants: what depends on X in K(X) has the rank of the fine
    /// part.
    fn degree(&self) -> usize {
        let (n, fine) = (self.size(), self.levels().first().map_or(0, |level| level.fine.len()));
        n + fine.min(n) * self.substeps() as usize
    }

    /// The gaps that hold all steps at which the verdict can change, increasing.
    fn gaps(&self, (lo, hi): (f64, f64), limits: &Limits) -> Result<Vec<Gap>> {
        limits.allow(self.cost() as u64, || {
            format!("the edges of a scheme of {} degrees of freedom", self.size())
        })?;
        // X = 4^k s, s in [0, 1].
        let top = 2f64.powi(hi.log2().ceil() as i32);
        let square = from_f64_exact(top * top)
            .ok_or_else(|| Error::input("range", format!("{lo}..{hi}"), "choose steps below 1e150"))?;
        let mut polynomials = Vec::new();
        for dofs in connected_parts(self.plain()) {
            polynomials.extend(self.part(&dofs).determinants()?);
        }
        let polynomials: Vec<_> = polynomials
            .iter()
            .filter(|polynomial| polynomial.degree().is_some_and(|n| n > 0))
            .map(|polynomial| whole(polynomial, &square))
            .collect();
        let gaps = gaps_of(&polynomials, (0.0, top), &|x| x * x / &square)?;
        Ok(gaps.into_iter().filter(|gap| gap.lo < hi && lo < gap.hi).collect())
    }

    /// Both determinants as polynomials in X, from their values.
    fn determinants(&self) -> Result<[Polynomial<Rational>; 2]> {
        let complement = Frame::new(self.plain()).complement(self.plain());
        let mass = self.plain().mass().scaled(&ratio(4, 1));
        let values = |k: &usize| {
            let x = Rational::from_integer((*k).into());
            let effective = self.effective(&x);
            let mut other = effective.scaled(&-&x);
            other.add_all(&mass);
            Ok([effective, other].map(|matrix| (x.clone(), determinant(&matrix.congruent(&complement)))))
        };
        let values: Vec<[(Rational, Rational); 2]> =
            try_map(&(1..=self.degree() + 1).collect::<Vec<_>>(), values)?;
        let points = |k: usize| values.iter().map(|values| values[k].clone()).collect::<Vec<_>>();
        Ok([0, 1].map(|k| Polynomial::through(&points(k))))
    }
}

/// By elimination.
fn determinant(matrix: &Symmetric) -> Rational {
    let mut rows: Vec<Vec<Rational>> =
        (0..matrix.size()).map(|i| (0..matrix.size()).map(|j| matrix.get(i, j)).collect()).collect();
    let mut determinant = Rational::one();
    while let Some(place) = rows.iter().position(|row| row.last().is_some_and(|x| !x.is_zero())) {
        let last = rows.len() - 1;
        if place != last {
            rows.swap(place, last);
            determinant = -determinant;
        }
        let mut pivot_row = rows.pop().expect("a row");
        let pivot = pivot_row.pop().expect("a column");
        for row in &mut rows {
            let factor = row.pop().expect("a column") / &pivot;
            if !factor.is_zero() {
                row.iter_mut().zip(&pivot_row).for_each(|(x, y)| *x -= &factor * y);
            }
        }
        determinant *= pivot;
    }
    if rows.is_empty() { determinant } else { Rational::zero() }
}

/// An integer multiple of f(B s).
fn whole(f: &Polynomial<Rational>, b: &Rational) -> Vec<BigInt> {
    let mut power = Rational::one();
    let mut scaled = Vec::new();
    for c in f.coefficients() {
        scaled.push(c * &power);
        power *= b;
    }
    integers(&Polynomial::new(scaled))
}
