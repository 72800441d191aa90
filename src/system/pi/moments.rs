//! The exact verdict from power sums: inertias alone, in any ordered domain, no polynomial is factored.
//!
//! Let S = Bᵀ C have the distinct eigenvalues μ with multiplicities m(μ), and let the form of a polynomial w be the Hankel matrix
//!
//! ```text
//!     G_w = (tr w(S) S^(i + j)) = Σ m(μ) w(μ) v(μ) v(μ)ᵀ,      v(μ) = (1, μ, ..., μ^(n-1)).
//! ```
//!
//! The v(μ) are independent, so G_w has the rank #{μ: w(μ) ≠ 0}; a real μ adds the sign of w(μ) to its signature, a pair
//! of complex ones a positive and a negative square (Hermite, Sylvester). With w = −μ (μ + 1), which is positive inside (−1, 0):
//!
//! ```text
//!     signature of G_w        = inside - above - below,
//!     signature of G_(μ w)    = below - inside - above,
//!     signature of G_((μ+1)w) = inside + below - above,      rank of G_w = all four together.
//! ```
//!
//! Multiplicities of 0 and −1 are those in the characteristic polynomial, by Newton's identities. Outside of them S is
//! semisimple iff its minimal polynomial has no more degree than there are distinct μ: iff T, T S, ..., T S^r are dependent,
//! T = S^a (S + 1)^b with these multiplicities and r distinct μ. At λ = ±1 as in [`exact`](crate::system::exact::decide).

use nalgebra::DMatrix;

use crate::number::Domain;
use crate::system::exact::decide::MuCount;
use crate::system::exact::integers::{IntegerBlocks, product};
use crate::system::signs::inertia::Inertia;
use crate::system::signs::{exact_inertia, exact_rank};
use crate::verdict::Kind;

/// The kind, and where the μ lie.
pub(in crate::system) fn judge<D: Domain>(blocks: &IntegerBlocks<D>) -> (Kind, MuCount) {
    // P = d S, so that −1 becomes −d.
    let (p, d) = (blocks.product(), &blocks.scale);
    let n = p.nrows();
    let sums: Vec<D> = powers(DMatrix::identity(n, n), &p, 2 * n + 2).iter().map(trace).collect();
    let (at_zero, at_minus_one) = multiplicities(&sums, d);
    let roots = count(&sums, d, [at_zero, at_minus_one]);
    let kind = if roots.above + roots.below + roots.complex > 0 {
        Kind::Hyperbolic
    } else if !is_semisimple(blocks, &p, &roots) {
        Kind::Parabolic
    } else if at_zero + at_minus_one > 0 {
        Kind::Coexistence
    } else {
        Kind::Elliptic
    };
    (kind, roots)
}

/// M, M P, M P², ..., so many.
fn powers<D: Domain>(m: DMatrix<D>, p: &DMatrix<D>, count: usize) -> Vec<DMatrix<D>> {
    let mut all = vec![m];
    for k in 1..count {
        all.push(product(&all[k - 1], p));
    }
    all
}

fn trace<D: Domain>(m: &DMatrix<D>) -> D {
    (0..m.nrows()).fold(D::zero(), |mut sum, i| {
        sum += m[(i, i)].clone();
        sum
    })
}

/// How often 0 and −d are zeros of the characteristic polynomial.
fn multiplicities<D: Domain>(sums: &[D], d: &D) -> (usize, usize) {
    // Newton: k c_k = −Σ c_(k−i) s_i, c_0 = 1 the leading coefficient.
    let n = (sums.len() - 2) / 2;
    let mut c = vec![D::one()];
    for k in 1..=n {
        let sum = (1..=k).fold(D::zero(), |mut sum, i| {
            sum -= c[k - i].product(&sums[i]);
            sum
        });
        c.push(sum.divided_exactly_by(&D::from_integer(k as i64)));
    }
    let at_zero = c.iter().rev().take_while(|c| c.is_zero()).count();
    let mut at_minus_one = 0;
    // Synthetic division by z + d, highest coefficient first.
    while c.len() > 1 {
        let mut value = D::zero();
        let mut quotient: Vec<D> = Vec::with_capacity(c.len());
        for own in &c {
            let mut next = own.clone();
            next -= value.product(d);
            quotient.push(next.clone());
            value = next;
        }
        if !quotient.pop().is_some_and(|rest| rest.is_zero()) {
            break;
        }
        c = quotient;
        at_minus_one += 1;
    }
    (at_zero, at_minus_one)
}

/// The distinct eigenvalues by place.
fn count<D: Domain>(sums: &[D], d: &D, [at_zero, at_minus_one]: [usize; 2]) -> MuCount {
    let n = (sums.len() - 2) / 2;
    // tr w(P) P^k for w = −z (z + d).
    let weighted: Vec<D> = (0..2 * n)
        .map(|k| {
            let mut x = -sums[k + 2].clone();
            x -= d.product(&sums[k + 1]);
            x
        })
        .collect();
    let form = |moment: &dyn Fn(usize) -> D| exact_inertia(DMatrix::from_fn(n, n, |i, j| moment(i + j)));
    let signature = |own: &Inertia| own.positive as i64 - own.negative as i64;
    let inertia = form(&|k| weighted[k].clone());
    let own = signature(&inertia);
    let distinct = inertia.positive + inertia.negative;
    if inertia.negative == 0 {
        return MuCount { inside: distinct, at_zero, at_minus_one, above: 0, below: 0, complex: 0 };
    }
    let times_mu = signature(&form(&|k| weighted[k + 1].clone()));
    let times_mu_plus_one = signature(&form(&|k| {
        let mut x = weighted[k + 1].clone();
        x += d.product(&weighted[k]);
        x
    }));
    let above = -(own + times_mu) / 2;
    let inside = (own + times_mu_plus_one) / 2 + above;
    let below = inside - above - own;
    let [inside, above, below] = [inside, above, below].map(|x| x as usize);
    MuCount { inside, at_zero, at_minus_one, above, below, complex: distinct - inside - above - below }
}

/// Whether Q is diagonalizable, all μ being in \[−1, 0\].
fn is_semisimple<D: Domain>(blocks: &IntegerBlocks<D>, p: &DMatrix<D>, roots: &MuCount) -> bool {
    let (n, d) = (p.nrows(), &blocks.scale);
    let nullity = |m: &DMatrix<D>| n - exact_rank(m.clone());
    if roots.at_zero > 0 && nullity(&blocks.b) + nullity(&blocks.c) != 2 * roots.at_zero
        || roots.at_minus_one > 0 && nullity(&blocks.a) + nullity(&blocks.d) != 2 * roots.at_minus_one
    {
        return false;
    }
    if roots.inside + roots.at_zero + roots.at_minus_one == n {
        return true;
    }
    let mut shifted = p.clone();
    (0..n).for_each(|i| shifted[(i, i)] += d.clone());
    let times = |m: DMatrix<D>, factor: &DMatrix<D>, count: usize| {
        powers(m, factor, count + 1).pop().expect("at least the first")
    };
    let t = times(times(DMatrix::identity(n, n), p, roots.at_zero), &shifted, roots.at_minus_one);
    let rows = powers(t, p, roots.inside + 1);
    exact_rank(DMatrix::from_fn(rows.len(), n * n, |i, j| rows[i].as_slice()[j].clone())) <= roots.inside
}
