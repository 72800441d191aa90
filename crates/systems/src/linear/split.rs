//! Systems split exactly into rational subspaces that all potentials leave invariant.
//!
//! Where the M⁻¹ K_k commute, they share their eigenspaces, and each common eigenvector v is an oscillator
//! with the stiffnesses vᵀ K_k v/vᵀ M v. One combination of the M⁻¹ K_k separates them; its rational
//! eigenvalues are found exactly, and what has irrational ones stays together, M-orthogonal to the rest.
//!
//! Where they do not commute, an X that commutes with each of them, self-adjoint in the metric of M, has
//! eigenspaces that all leave invariant: a mirror of a molecule splits it into symmetric and antisymmetric
//! motions. With X = M⁻¹ Y that is
//!
//! ```text
//!     Y = Yᵀ,      Y M⁻¹ K_k = K_k M⁻¹ Y for all k,
//! ```
//!
//! linear in Y; Y = M is always a solution.

use std::collections::BTreeMap;

use faer::Mat;
use nalgebra::DMatrix;
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Zero};

use crate::exact::{modular, roots};
use crate::half::compose::{inverse_mass, rounded_inverse_mass};
use crate::linear::sparse::{Symmetric, null_space};
use crate::linear::system::System;
use number::polynomial::squarefree;
use number::{Polynomial, Rational, U};

/// Columns that span an invariant subspace.
pub(crate) type Subspace = Vec<Vec<Rational>>;

/// Invariant subspaces of commuting potentials, M-orthogonal to each other: lines where they are rational,
/// and at most one rest; `None` where potentials do not commute.
pub(crate) fn invariant_subspaces(system: &System, stiffnesses: &[&Symmetric]) -> Option<Vec<Subspace>> {
    let n = system.size();
    if !may_split(system, stiffnesses) {
        return None;
    }
    let inverse = dense_inverse(system);
    let operators: Vec<_> = stiffnesses.iter().map(|k| &inverse * k.to_dense()).collect();
    let commute = |a: &DMatrix<Rational>, b: &DMatrix<Rational>| a * b == b * a;
    if operators.iter().enumerate().any(|(i, a)| operators[..i].iter().any(|b| !commute(a, b))) {
        return None;
    }
    let mut subspaces = Vec::new();
    let mut open = vec![whole(n)];
    for operator in &operators {
        let mut next = Vec::new();
        for space in open {
            next.extend(eigenspaces(system, operator, space));
        }
        open = next;
    }
    for space in open {
        // On a space where each operator is a multiple of the identity every vector is an oscillator.
        let scalar = space.iter().all(|v| operators.iter().all(|a| is_eigenvector(a, v)));
        if scalar {
            subspaces.extend(space.into_iter().map(|v| vec![v]));
        } else {
            subspaces.push(space);
        }
    }
    Some(subspaces)
}

/// Whether the M⁻¹ K_k may all commute; `false` where doubles prove that two of them do not.
///
/// An entry of the rounded matrices is within 2 u of its size of the true one, a product of three of them
/// summed over n² terms within (n² + 12) u of the sum of their absolute values.
pub(crate) fn may_split(system: &System, stiffnesses: &[&Symmetric]) -> bool {
    let n = system.size();
    let dense = |rounded: Mat<f64>| DMatrix::from_fn(n, n, |i, j| rounded[(i, j)]);
    let inverse = dense(rounded_inverse_mass(system));
    let products: Vec<[DMatrix<f64>; 2]> = stiffnesses
        .iter()
        .map(|k| {
            let k = dense(k.rounded());
            [&inverse * &k, inverse.abs() * k.abs()]
        })
        .collect();
    let rounding = 1.01 * ((n * n) as f64 + 12.0) * U;
    let differ = |[a, a_size]: &[DMatrix<f64>; 2], [b, b_size]: &[DMatrix<f64>; 2]| {
        let (difference, size) = (a * b - b * a, a_size * b_size + b_size * a_size);
        difference
            .iter()
            .zip(size.iter())
            .any(|(x, size)| x.abs() > 2.0 * rounding * size + f64::MIN_POSITIVE)
    };
    !products.iter().enumerate().any(|(i, a)| products[..i].iter().any(|b| differ(a, b)))
}

/// How motions of different symmetry come apart.
pub(crate) enum Symmetry {
    /// Invariant subspaces, M-orthogonal to each other: the eigenspaces of a symmetry with rational
    /// eigenvalues and what is left of it.
    Subspaces(Vec<Subspace>),
    /// An operator M⁻¹ Y that commutes with all M⁻¹ K_k and with all symmetries of these; its eigenspaces
    /// need not be rational: the ring of five has two pairs of them over ℚ(√5).
    Central(DMatrix<Rational>),
}

/// The symmetry of potentials that need not commute; `None` where all that commutes with them is a multiple
/// of the identity.
pub fn symmetry(system: &System, stiffnesses: &[&Symmetric]) -> Option<Symmetry> {
    let inverse = dense_inverse(system);
    let mut operators: Vec<_> = stiffnesses.iter().map(|k| &inverse * k.to_dense()).collect();
    let all: Vec<_> = symmetries(&operators).iter().map(|y| &inverse * y).collect();
    if all.len() < 2 {
        return None;
    }
    let spaces = all.iter().map(|operator| eigenspaces(system, operator, whole(system.size())));
    if let Some(found) = spaces.into_iter().find(|found| found.len() > 1) {
        return Some(Symmetry::Subspaces(found));
    }
    operators.extend(all);
    let central = symmetries(&operators);
    // Any weights: eigenvalues that happen to be equal leave their motions together.
    let weight = |k: usize| Rational::from_integer(((k + 1) * (k + 1)).into());
    let sum = central.iter().enumerate().map(|(k, y)| y * weight(k)).reduce(|sum, y| sum + y)?;
    (central.len() > 1).then(|| Symmetry::Central(inverse * sum))
}

/// A basis of the symmetric Y with Y A = Aᵀ Y for all these A; empty where it has but one element, by its
/// rank modulo a prime, which is no larger than the true one.
fn symmetries(operators: &[DMatrix<Rational>]) -> Vec<DMatrix<Rational>> {
    let n = operators.first().map_or(0, DMatrix::nrows);
    let unknown = |i: usize, j: usize| i.max(j) * (i.max(j) + 1) / 2 + i.min(j);
    let count = n * (n + 1) / 2;
    let mut equations: Vec<BTreeMap<usize, Rational>> = Vec::new();
    for a in operators {
        for (i, j) in (0..n).flat_map(|i| (0..i).map(move |j| (i, j))) {
            let mut equation = BTreeMap::new();
            for k in 0..n {
                *equation.entry(unknown(i, k)).or_insert_with(Rational::zero) += &a[(k, j)];
                *equation.entry(unknown(k, j)).or_insert_with(Rational::zero) -= &a[(k, i)];
            }
            equation.retain(|_, x| !x.is_zero());
            equations.push(equation);
        }
    }
    if modular::rank_of(&equations, count).is_some_and(|rank| rank + 1 >= count) {
        return Vec::new();
    }
    let matrix = |y: &[Rational]| DMatrix::from_fn(n, n, |i, j| y[unknown(i, j)].clone());
    null_space(equations, count).iter().map(|(_, y)| matrix(y)).collect()
}

/// All of it.
pub(crate) fn whole(n: usize) -> Subspace {
    (0..n).map(|i| unit(n, i)).collect()
}

/// The i-th unit vector.
pub(crate) fn unit(n: usize, i: usize) -> Vec<Rational> {
    (0..n).map(|j| Rational::from_integer(i64::from(i == j).into())).collect()
}

fn dense_inverse(system: &System) -> DMatrix<Rational> {
    let mut inverse = DMatrix::from_element(system.size(), system.size(), Rational::zero());
    for (i, row) in inverse_mass(system).1.into_iter().enumerate() {
        row.into_iter().for_each(|(j, x)| inverse[(i, j)] = x);
    }
    inverse
}

fn is_eigenvector(a: &DMatrix<Rational>, v: &[Rational]) -> bool {
    let image = times(a, v);
    let Some(i) = v.iter().position(|x| !x.is_zero()) else { return true };
    let value = &image[i] / &v[i];
    image.iter().zip(v).all(|(x, y)| *x == y * &value)
}

fn times(a: &DMatrix<Rational>, v: &[Rational]) -> Vec<Rational> {
    a.row_iter().map(|row| row.iter().zip(v).fold(Rational::zero(), |sum, (x, y)| sum + x * y)).collect()
}

/// The invariant `space` as the eigenspaces of its rational eigenvalues under `operator` and what is
/// M-orthogonal to them there.
fn eigenspaces(system: &System, operator: &DMatrix<Rational>, space: Subspace) -> Vec<Subspace> {
    let (local, in_space) = restrict(system, operator, &space);
    let mut found: Vec<Subspace> = Vec::new();
    for value in rational_eigenvalues(&local) {
        let shifted = |i: usize| -> BTreeMap<usize, Rational> {
            let entry = |j: usize| if i == j { &local[(i, j)] - &value } else { local[(i, j)].clone() };
            (0..local.ncols()).map(|j| (j, entry(j))).filter(|(_, x)| !x.is_zero()).collect()
        };
        let vectors = null_space((0..local.nrows()).map(shifted).collect(), local.ncols());
        found.push(vectors.into_iter().map(|(_, y)| in_space(&y)).collect());
    }
    // Within the space, the vectors M-orthogonal to all found.
    let mass_images: Vec<_> = found.iter().flatten().map(|v| system.mass().times(v)).collect();
    let condition = |mv: &Vec<Rational>| {
        let products = space.iter().map(|z| crate::linear::sparse::dot(z, mv)).enumerate();
        products.filter(|(_, x)| !x.is_zero()).collect()
    };
    let rest = null_space(mass_images.iter().map(condition).collect(), space.len());
    let rest: Subspace = rest.into_iter().map(|(_, y)| in_space(&y)).collect();
    if !rest.is_empty() {
        found.push(rest);
    }
    found
}

/// The operator's matrix L on the space with basis Z, A Z = Z L, and the map y ↦ Z y.
fn restrict<'a>(
    system: &System,
    operator: &DMatrix<Rational>,
    space: &'a Subspace,
) -> (DMatrix<Rational>, impl Fn(&[Rational]) -> Vec<Rational> + 'a) {
    // L = (Zᵀ M Z)⁻¹ Zᵀ M A Z.
    let d = space.len();
    let weighted: Vec<_> = space.iter().map(|z| system.mass().times(z)).collect();
    let images: Vec<_> = space.iter().map(|z| times(operator, z)).collect();
    let product = |left: &[Vec<Rational>], right: &[Vec<Rational>]| {
        DMatrix::from_fn(d, d, |i, j| crate::linear::sparse::dot(&left[i], &right[j]))
    };
    let gram = crate::half::compose::inverted(product(&weighted, space));
    let combine = |y: &[Rational]| {
        let entry = |i: usize| space.iter().zip(y).fold(Rational::zero(), |sum, (z, c)| sum + &z[i] * c);
        (0..space[0].len()).map(entry).collect()
    };
    (gram * product(&weighted, &images), combine)
}

/// The distinct rational eigenvalues: those of e times the matrix, e its common denominator, are integers.
fn rational_eigenvalues(m: &DMatrix<Rational>) -> Vec<Rational> {
    let e = m.iter().fold(BigInt::one(), |lcm, x| lcm.lcm(x.denom()));
    let integer = m.map(|x| (x * Rational::from_integer(e.clone())).to_integer());
    let polynomial = squarefree(&roots::characteristic(&integer));
    let polynomial = Polynomial::new(polynomial.into_iter().map(Rational::from_integer).collect());
    let sturm = number::polynomial::Sturm::new(&polynomial);
    let half = Rational::new(1.into(), 2.into());
    let integer_root = |interval: &(Rational, Rational)| {
        let (lo, hi) = sturm.refine(interval, &half);
        let candidate = if lo.is_integer() { lo } else { hi.floor() };
        polynomial.eval(&candidate).is_zero().then_some(candidate)
    };
    sturm.isolate().iter().filter_map(integer_root).map(|z| z / Rational::from_integer(e.clone())).collect()
}
