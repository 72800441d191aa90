//! One step of a scheme of local time steps, written as a step of Verlet's with another stiffness.

use std::collections::BTreeSet;

use num_traits::Zero;

use crate::levels::sparse::Pattern;
use crate::linear::sparse::Symmetric;
use crate::linear::system::{Potential, System};
use number::{Error, Rational, Result, U, named, ratio, to_f64};

/// Degrees of freedom that take so many substeps in a step of the level above.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Level {
    pub fine: BTreeSet<usize>,
    pub substeps: u32,
}

named! {
    /// The meaning of levels of steps.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Scheme {
        /// Leapfrog with local time steps: forces on what is not fine stand still (Diaz and Grote 2009).
        Lts = "lts",
        /// Asynchronous variational integrators: elements kick with steps of their own (Lew, Marsden, Ortiz
        /// and West 2003).
        Avi = "avi",
    }
}

/// The summary of a scheme in answers.
#[derive(Clone, Debug, PartialEq)]
pub struct SchemeSummary {
    pub scheme: Scheme,
    /// Degrees of freedom; of AVI elements.
    pub size: usize,
    /// Fine ones and substeps of each level.
    pub levels: Vec<(usize, u32)>,
    /// As [`LocalSteps::plain_limit`].
    pub plain_limit: Option<(f64, f64)>,
    /// \[lo, hi\]: every step in (0, lo] is proven stable, some step up to hi is proven unstable; `None`
    /// where that is not known.
    pub first_unstable: Option<(f64, f64)>,
}

impl SchemeSummary {
    /// Of these levels, nothing being known of the first unstable step.
    pub(super) fn new(
        scheme: Scheme,
        size: usize,
        levels: &[Level],
        plain_limit: Option<(f64, f64)>,
    ) -> SchemeSummary {
        let levels = levels.iter().map(|level| (level.fine.len(), level.substeps)).collect();
        SchemeSummary { scheme, size, levels, plain_limit, first_unstable: None }
    }
}

impl std::str::FromStr for Scheme {
    type Err = Error;

    /// # Errors
    /// Another name.
    fn from_str(name: &str) -> Result<Scheme> {
        let found = Scheme::ALL.into_iter().find(|scheme| scheme.name() == name);
        found.ok_or_else(|| {
            let remedy = "name lts (leapfrog with local time steps) or avi (a clock for each element)";
            Error::input("scheme", name, remedy)
        })
    }
}

impl Level {
    /// The substeps of all levels together.
    ///
    /// # Errors
    /// No level, levels that are no parts of the ones above, indices of n or more, too many substeps.
    pub(super) fn check(levels: &[Level], n: usize) -> Result<u32> {
        let refused = |field: &str, value: String, remedy: &str| Err(Error::input(field, value, remedy));
        if levels.is_empty() {
            let remedy = "give at least one, as {\"fine\": [3, 4], \"substeps\": 2}";
            return refused("levels", "none".into(), remedy);
        }
        let mut product = 1u32;
        for (l, level) in levels.iter().enumerate() {
            let field = |name: &str| format!("levels[{l}].{name}");
            product = product.saturating_mul(level.substeps);
            if level.substeps == 0 || product > LocalSteps::MOST_SUBSTEPS {
                let remedy =
                    format!("choose 1 or more, at most {} of all levels together", LocalSteps::MOST_SUBSTEPS);
                return refused(&field("substeps"), level.substeps.to_string(), &remedy);
            }
            if let Some(i) = level.fine.iter().find(|&&i| i >= n) {
                return refused(
                    &field("fine"),
                    i.to_string(),
                    &format!("indices are 0 to {}", n.saturating_sub(1)),
                );
            }
            let above = l.checked_sub(1).map(|above| &levels[above].fine);
            if let Some(i) = above.and_then(|above| level.fine.difference(above).next()) {
                let remedy = "is not fine in the level above: nest the levels";
                return refused(&field("fine"), i.to_string(), remedy);
            }
        }
        Ok(product)
    }

    /// The substeps in a step of the whole of one degree of freedom, or of one element.
    pub(crate) fn substeps_of(levels: &[Level], i: usize) -> u32 {
        levels.iter().filter(|level| level.fine.contains(&i)).map(|level| level.substeps).product()
    }

    /// As [`Level::check`], of a system of one clock without a phase and with lumped masses.
    ///
    /// # Errors
    /// A mass matrix that is not diagonal, several clocks, a phase; as [`Level::check`].
    pub(super) fn of_one_clock(plain: &System, levels: &[Level]) -> Result<u32> {
        let refused = |field: &str, value: String, remedy: &str| Err(Error::input(field, value, remedy));
        if !plain.mass().is_diagonal() {
            return refused(
                "mass_matrix",
                "not diagonal".into(),
                "local steps are for lumped masses: give masses",
            );
        }
        let [clock] = plain.clocks() else {
            let remedy = "give all potentials one step: the levels say which parts take shorter ones";
            return refused("potentials", format!("{} steps", plain.clocks().len()), remedy);
        };
        if !clock.phase.is_zero() {
            return refused(
                "phase",
                clock.phase.to_string(),
                "has no meaning with local steps: leave it out",
            );
        }
        Level::check(levels, plain.size())
    }
}

/// Products of rationals for the effective stiffness beyond which reading a file would take a minute.
const MOST_WORK: f64 = 2e8;

/// A diagonal mass, a stiffness, levels from the coarsest to the finest one, and a step.
///
/// ```
/// use kickdrift_systems::number::rational::ratio;
/// use kickdrift_systems::{Holds, Level, Limits, LocalSteps, Potential, Symmetric, System};
/// use nalgebra::DMatrix;
/// // Two masses, the second on a stiff spring: it takes two substeps in each step.
/// let stiffness = Symmetric::try_from(&DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 9.0]))?;
/// let mass = Symmetric::diagonal(&[ratio(1, 1), ratio(1, 1)]);
/// let plain = System::new(mass, vec![Potential::new(stiffness, ratio(1, 2))])?;
/// let scheme = LocalSteps::new(plain, vec![Level { fine: [1].into(), substeps: 2 }])?;
/// // Unstable for steps from 0.8837... to 1 and above 4/3, and nowhere else.
/// let found = scheme.stretches((0.1, 3.0), &Limits::default())?;
/// let unstable: Vec<_> = found.iter().filter(|own| own.verdict == Holds::Unstable).collect();
/// assert_eq!(unstable.len(), 2);
/// assert!(unstable[0].lo > 0.8837 && unstable[0].hi == 1.0 && unstable[1].lo > 1.3333);
/// # Ok::<(), kickdrift_systems::number::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct LocalSteps {
    /// Without local steps: Verlet's.
    plain: System,
    levels: Vec<Level>,
    /// With the effective stiffness.
    system: System,
}

impl LocalSteps {
    /// The most substeps of the finest level in a step: degrees of polynomials grow with them.
    pub const MOST_SUBSTEPS: u32 = 1024;

    /// The scheme for a system of one clock.
    ///
    /// # Errors
    /// A mass matrix that is not diagonal, several clocks, a phase, levels that are no parts of the ones
    /// above, too many substeps.
    pub fn new(plain: System, levels: Vec<Level>) -> Result<LocalSteps> {
        let product = Level::of_one_clock(&plain, &levels)?;
        let work = work(&plain, &levels);
        if work > MOST_WORK {
            let remedy =
                format!("with {work:.0e} products of rationals is too much: at most {MOST_WORK:.0e}");
            return Err(Error::input("levels", format!("{product} substeps"), remedy));
        }
        let step = &plain.clocks()[0].step;
        let system = with_stiffness(&plain, effective(&plain, &levels, &(step * step)), step)?;
        Ok(LocalSteps { plain, levels, system })
    }

    /// The scheme as Verlet's with its effective stiffness.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// This system without local steps.
    pub fn plain(&self) -> &System {
        &self.plain
    }

    /// The levels, the coarsest first.
    pub fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// dt.
    pub fn step(&self) -> &Rational {
        &self.plain.clocks()[0].step
    }

    /// How often the finest level steps in a step.
    pub fn substeps(&self) -> u32 {
        self.levels.iter().map(|level| level.substeps).product()
    }

    /// This system with another step.
    ///
    /// # Errors
    /// A step that is not positive.
    pub fn at(&self, step: &Rational) -> Result<LocalSteps> {
        let stiffness = self.plain.clocks()[0].stiffness.clone();
        let plain = with_stiffness(&self.plain, stiffness, step)?;
        let system = with_stiffness(&self.plain, self.effective(&(step * step)), step)?;
        Ok(LocalSteps { plain, levels: self.levels.clone(), system })
    }

    /// Where plain leapfrog, all with the step of the whole, becomes unstable: \[lo, hi\] holds 2/√λ of the
    /// largest λ of K x = λ M x, within 10^-9 of itself or as near as doubles can decide; `None` where no λ
    /// is positive.
    pub fn plain_limit(&self) -> Option<(f64, f64)> {
        plain_limit(&self.plain)
    }

    /// f/dt² at dt² = `square` > 0.
    pub fn effective(&self, square: &Rational) -> Symmetric {
        effective(&self.plain, &self.levels, square)
    }

    /// The degrees of freedom in `indices` alone, which nothing couples to others.
    pub(super) fn part(&self, indices: &[usize]) -> LocalSteps {
        let place = |(new, old): (usize, &usize), level: &Level| level.fine.contains(old).then_some(new);
        let own = |level: &Level| Level {
            fine: indices.iter().enumerate().filter_map(|at| place(at, level)).collect(),
            substeps: level.substeps,
        };
        let levels = self.levels.iter().map(own).collect();
        LocalSteps { plain: self.plain.part(indices), levels, system: self.system.part(indices) }
    }
}

/// As [`LocalSteps::plain_limit`], of the stiffnesses of all clocks together, with diagonal masses.
pub(super) fn plain_limit(plain: &System) -> Option<(f64, f64)> {
    const WITHIN: f64 = 1e-9;
    let (mass, stiffness) = (plain.mass(), plain.total_stiffness());
    let root: Vec<f64> = (0..mass.size()).map(|i| to_f64(&mass.get(i, i)).sqrt()).collect();
    let row = |i: usize| stiffness.row(i).iter().map(move |(&j, x)| (i, j, x));
    let entries: Vec<_> =
        (0..mass.size()).flat_map(row).map(|(i, j, x)| (i, j, to_f64(x) / (root[i] * root[j]))).collect();
    let (pattern, [values]) = Pattern::of(mass.size(), [&entries]).ok()?;
    // The error of each entry: its own rounding, two masses' and two roots', their product, the quotient.
    let slack = 8.0 * U * pattern.size_of(&values).0;
    let (lo, hi) = pattern.largest(&values, slack, WITHIN)?;
    Some((2.0 / hi.sqrt() * (1.0 - 4.0 * U), 2.0 / lo.sqrt() * (1.0 + 4.0 * U)))
}

/// f/dt² at dt² = `square` > 0.
fn effective(plain: &System, levels: &[Level], square: &Rational) -> Symmetric {
    let (stiffness, mass) = (&plain.clocks()[0].stiffness, plain.mass());
    let substeps_of = |level: &Level| Rational::from_integer(level.substeps.into());
    let substeps_of_all: Rational = levels.iter().map(substeps_of).product();
    let half = Rational::new(1.into(), 2.into());
    let finest = stiffness.scaled(&(square * half / (&substeps_of_all * &substeps_of_all)));
    let stiffness = levels.iter().rev().fold(finest, |symmetric, level| {
        let weight = |i| if level.fine.contains(&i) { mass.get(i, i).recip() } else { Rational::zero() };
        let weights: Vec<_> = (0..mass.size()).map(weight).collect();
        substeps(&symmetric, &weights, level.substeps)
    });
    stiffness.scaled(&(ratio(2, 1) / square))
}

/// Products of the substeps, roughly: where S has z entries a row, S P M⁻¹ S has up to z², at most n.
fn work(plain: &System, levels: &[Level]) -> f64 {
    let (n, places) = (plain.size() as f64, plain.clocks()[0].stiffness.places().count() as f64);
    let mut width = places / n;
    let mut work = 0.0;
    for level in levels.iter().rev() {
        let fine = level.fine.len() as f64;
        let widest = (width * f64::from(level.substeps)).min(n);
        work += f64::from(level.substeps - 1) * fine * width.min(n) * widest;
        width = widest;
    }
    work
}

/// W_p(1 − S P M⁻¹) S, `weights` the diagonal of P M⁻¹: all polynomials in S P M⁻¹ times S are symmetric.
/// Those of k and k + 1 substeps become those of 2k and 2k + 1 or 2k + 2 by T_2k = 2 T_k² − 1 and T_2k+1 = 2
/// T_k T_k+1 − T_1: p substeps take 2 log₂ p products, whose numbers are p times as long.
fn substeps(symmetric: &Symmetric, weights: &[Rational], substeps: u32) -> Symmetric {
    let [two, minus, minus_two] = [2, -1, -2].map(|n| ratio(n, 1));
    // 1 − T_a+b plus 1 − T_a−b of those of a and b.
    let sum = |a: &Symmetric, b: &Symmetric| {
        let mut sum = a.symmetric_product(weights, b).scaled(&minus_two);
        sum.add_all(&a.scaled(&two));
        sum.add_all(&b.scaled(&two));
        sum
    };
    let (mut now, mut next) = (Symmetric::zero(symmetric.size()), symmetric.clone());
    for bit in (0..u32::BITS - substeps.leading_zeros()).rev() {
        let between = || {
            let mut between = sum(&now, &next);
            between.add_all(&symmetric.scaled(&minus));
            between
        };
        (now, next) = match (substeps >> bit & 1, bit) {
            (1, 0) => return between(),
            (_, 0) => return sum(&now, &now),
            (1, _) => (between(), sum(&next, &next)),
            _ => (sum(&now, &now), between()),
        };
    }
    now
}

fn with_stiffness(plain: &System, stiffness: Symmetric, step: &Rational) -> Result<System> {
    let potential = Potential { stiffness, step: step.clone(), phase: Rational::zero() };
    Ok(System::new(plain.mass().clone(), vec![potential])?.held_by(plain))
}
