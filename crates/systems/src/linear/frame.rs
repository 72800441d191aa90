//! Rigid modes set apart, exactly: the coordinates in which they are not seen.
//!
//! Let N be the common null space of all K_k, with the basis n_J in reduced form (n_J is 1 at the coordinate
//! J, where the others are 0). No kick sees a shift x + n, so positions count modulo N: y_i = x_i − Σ_J
//! n_J\[i\] x_J for the other coordinates i. No kick changes n_Jᵀ p, so momenta with n_Jᵀ p = 0 stay among
//! themselves: p_J = −Σ n_J\[i\] p_i. The half period maps these (y, p) to themselves and stays symplectic
//! there. The propagation itself runs in the full coordinates, where matrices are sparse.

use nalgebra::DMatrix;
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::One;

use crate::linear::sparse::null_space;
use crate::linear::system::System;
use number::{Rational, Ring, to_f64};

/// The coordinates kept, and the rigid modes.
#[derive(Clone, Debug)]
pub struct Frame {
    /// (J, n_J).
    pub rigid: Vec<(usize, Vec<Rational>)>,
    /// All other coordinates, increasing.
    pub kept: Vec<usize>,
}

impl Frame {
    pub fn new(system: &System) -> Self {
        let rigid = system.rigid_modes();
        let kept = (0..system.size()).filter(|i| rigid.iter().all(|(index, _)| index != i)).collect();
        Frame { rigid, kept }
    }

    /// The frame of n degrees of freedom without rigid modes.
    pub fn whole(n: usize) -> Self {
        Frame { rigid: Vec::new(), kept: (0..n).collect() }
    }

    /// The momentum that starts column `k`: the rows of its entries that are not 0.
    pub fn momentum(&self, k: usize) -> Vec<(usize, Rational)> {
        let i = self.kept[k];
        let rest = self.rigid.iter().map(|(index, n)| (*index, -n[i].clone()));
        std::iter::once((i, Rational::one())).chain(rest).collect()
    }

    /// The least δ for which all δ n_J are integers.
    pub fn denominator(&self) -> BigInt {
        let entries = self.rigid.iter().flat_map(|(_, n)| n);
        entries.fold(BigInt::one(), |lcm, x| lcm.lcm(x.denom()))
    }

    /// The rows of x in the coordinates y, times c.
    pub fn project<S: Ring>(&self, x: &DMatrix<S>, c: &Rational) -> DMatrix<S> {
        let mut y = DMatrix::from_element(self.kept.len(), x.ncols(), S::zero());
        let factor = S::from_rational(c);
        for (a, &i) in self.kept.iter().enumerate() {
            let factors: Vec<_> =
                self.rigid.iter().map(|(index, n)| (*index, S::from_rational(&(c * &n[i])))).collect();
            for j in 0..x.ncols() {
                let mut entry = S::product(&factor, &x[(i, j)]);
                factors.iter().for_each(|(index, n)| entry.sub_product(n, &x[(*index, j)]));
                y[(a, j)] = entry;
            }
        }
        y
    }

    /// A basis of the M-orthogonal complement of the rigid modes: x = Z y.
    pub fn complement(&self, system: &System) -> Vec<Vec<Rational>> {
        let conditions = self.rigid.iter().map(|(_, n)| {
            let image = system.mass().times(n).into_iter().enumerate();
            image.filter(|(_, x)| *x != Rational::default()).collect()
        });
        null_space(conditions.collect(), system.size()).into_iter().map(|(_, z)| z).collect()
    }

    /// The position whose coordinates are y, M-orthogonal to the rigid modes; rounded.
    pub fn lift(&self, y: &[f64], system: &System) -> Vec<f64> {
        let n = system.size();
        let mut x = vec![0.0; n];
        self.kept.iter().zip(y).for_each(|(&i, &value)| x[i] = value);
        let times_mass = |v: &[f64]| -> Vec<f64> {
            let entry = |i: usize| system.mass().row(i).iter().map(|(&j, m)| to_f64(m) * v[j]).sum();
            (0..n).map(entry).collect()
        };
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        // Gram and Schmidt in the metric of M: the rigid modes first, then x.
        let subtract = |x: &mut Vec<f64>, basis: &[(Vec<f64>, Vec<f64>)]| {
            for (v, mv) in basis {
                let part = product(x, mv) / product(v, mv);
                x.iter_mut().zip(v).for_each(|(x, v)| *x -= part * v);
            }
        };
        let mut basis = Vec::new();
        for (_, mode) in &self.rigid {
            let mut v: Vec<f64> = mode.iter().map(to_f64).collect();
            subtract(&mut v, &basis);
            let image = times_mass(&v);
            basis.push((v, image));
        }
        subtract(&mut x, &basis);
        x
    }
}
