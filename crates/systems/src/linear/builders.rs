//! The usual systems: chains, bars, molecules.

use num_traits::Zero;

use crate::linear::sparse::Symmetric;
use crate::linear::system::{Potential, System};
use number::{Error, Rational, Result};

fn potential(stiffness: Symmetric, step: &Rational) -> Potential {
    Potential { stiffness, step: step.clone(), phase: Rational::zero() }
}

fn unit_masses(n: usize) -> Symmetric {
    Symmetric::diagonal(&vec![Rational::from_integer(1.into()); n])
}

fn at_least(field: &str, n: usize, least: usize) -> Result<()> {
    if n >= least { Ok(()) } else { Err(Error::input(field, n, format!("give at least {least}"))) }
}

/// n unit masses between two walls, the n + 1 springs in turn of the given kinds: stiffness k_i, step h_i of
/// spring i modulo the number of kinds.
///
/// # Errors
/// No mass, or as many steps as stiffnesses are not given; and as [`System::new`].
pub fn periodic_chain(n: usize, stiffness: &[Rational], steps: &[Rational]) -> Result<System> {
    at_least("masses", n, 1)?;
    if stiffness.is_empty() || stiffness.len() != steps.len() {
        return Err(Error::input(
            "steps",
            steps.len(),
            format!("give {} steps, one a stiffness", stiffness.len()),
        ));
    }
    let mut kinds = vec![Symmetric::zero(n); stiffness.len()];
    for spring in 0..=n {
        let kind = spring % stiffness.len();
        // Mass i lies between the springs i and i + 1.
        let (i, j) = match spring {
            0 => (0, None),
            _ => (spring - 1, (spring < n).then_some(spring)),
        };
        kinds[kind].add_spring(i, j, &stiffness[kind]);
    }
    System::new(unit_masses(n), kinds.into_iter().zip(steps).map(|(k, h)| potential(k, h)).collect())
}

/// n unit masses between two walls with alternating springs.
///
/// # Errors
/// As [`periodic_chain`].
pub fn alternating_chain(n: usize, stiffness: [&Rational; 2], steps: [&Rational; 2]) -> Result<System> {
    periodic_chain(n, &stiffness.map(Clone::clone), &steps.map(Clone::clone))
}

/// The linear part of the Fermi-Pasta-Ulam chain with alternating stiff and soft springs: `pairs` stiff
/// springs of stiffness w² joined by soft ones of stiffness 1, soft walls, unit masses; steps (stiff, soft).
///
/// # Errors
/// No pair; and as [`System::new`].
pub fn stiff_soft_chain(pairs: usize, stiff: &Rational, steps: [&Rational; 2]) -> Result<System> {
    at_least("pairs", pairs, 1)?;
    let one = Rational::from_integer(1.into());
    alternating_chain(2 * pairs, [&one, stiff], [steps[1], steps[0]])
}

/// A bar of linear finite elements with the lengths `lengths`, fixed at its left end: stiffness 1/length,
/// lumped masses of half the lengths beside a node, and each element its own step.
///
/// # Errors
/// No element, a length ≤ 0, as many steps as lengths are not given; and as [`System::new`].
pub fn bar(lengths: &[Rational], steps: &[Rational]) -> Result<System> {
    let n = lengths.len();
    at_least("elements", n, 1)?;
    if steps.len() != n {
        return Err(Error::input("steps", steps.len(), format!("give {n}, one an element")));
    }
    if let Some((i, length)) = lengths.iter().enumerate().find(|(_, x)| **x <= Rational::zero()) {
        return Err(Error::input(&format!("lengths[{i}]"), length, "a length must be positive"));
    }
    let half = Rational::new(1.into(), 2.into());
    let next = |i: usize| lengths.get(i + 1).cloned().unwrap_or_else(Rational::zero);
    let masses: Vec<_> = (0..n).map(|i| (&lengths[i] + next(i)) * &half).collect();
    let element = |i: usize| {
        let mut stiffness = Symmetric::zero(n);
        // Node i is the right end of element i; element 0 hangs on the wall.
        stiffness.add_spring(i, i.checked_sub(1), &lengths[i].recip());
        potential(stiffness, &steps[i])
    };
    System::new(Symmetric::diagonal(&masses), (0..n).map(element).collect())
}

/// A bar of n elements in `classes` groups of equal length, from coarse at the wall to fine: the length (and
/// the step, a constant fraction `courant` of it) of class c is (classes − c)/n.
///
/// # Errors
/// As [`bar`].
pub fn graded_bar(n: usize, classes: usize, courant: &Rational) -> Result<System> {
    at_least("classes", classes, 1)?;
    at_least("elements", n, classes)?;
    let class = |i: usize| i * classes / n;
    let length = |i: usize| Rational::new((classes - class(i)).into(), n.into());
    let lengths: Vec<_> = (0..n).map(length).collect();
    let steps: Vec<_> = lengths.iter().map(|length| length * courant).collect();
    bar(&lengths, &steps)
}

/// Two masses joined by a stiff bond, the first one tethered to a wall by a soft spring.
///
/// # Errors
/// As [`System::new`].
pub fn tethered_pair(
    masses: [&Rational; 2],
    bond: (&Rational, &Rational),
    tether: (&Rational, &Rational),
) -> Result<System> {
    let (mut stiff, mut soft) = (Symmetric::zero(2), Symmetric::zero(2));
    stiff.add_spring(0, Some(1), bond.0);
    soft.add_spring(0, None, tether.0);
    let mass = Symmetric::diagonal(&masses.map(Clone::clone));
    System::new(mass, vec![potential(stiff, bond.1), potential(soft, tether.1)])
}
