//! A scheme of local time steps run as codes run it, substep by substep, against the stiffness that stands
//! for it.

use num_traits::{Num, One, Zero};

use crate::verify::context::{Checked, holds};
use number::Rational;
use systems::{Analysis, Holds, Level, LocalSteps, SchemeSummary, SparseSteps, symmetric_eigenvalues};

/// Degrees of freedom of which one is displaced, at most.
const MOST: usize = 16;

/// Steps of Lanczos's recursion: it sees all motions of a scheme with no more degrees of freedom, of a larger
/// one the extreme motions.
pub const SEEN: usize = 120;

/// The error of doubles, relative to the norm of f: a recursion of some hundred steps, each of sums of some
/// dozen terms.
const ROUNDED: f64 = 1e-10;

/// The relative width of the enclosure of what grows.
const GROWTH_REL_WIDTH: f64 = 0.02;

/// How far below 4 f may be, relative to it, where a resonance is known to 10^-6: as the square of that times
/// the substeps.
const RESONANT: f64 = 1e-6;

/// x₊ + x₋ − 2 x = −dt² M⁻¹ K' x, for displacements of one degree of freedom each, exactly.
pub fn steps(local_steps: &LocalSteps) -> Checked {
    let (n, mass, square) =
        (local_steps.plain().size(), local_steps.plain().mass(), local_steps.step() * local_steps.step());
    let (plain, effective) =
        (&local_steps.plain().clocks()[0].stiffness, &local_steps.system().clocks()[0].stiffness);
    let pull = |x: &[Rational]| {
        plain.times(x).into_iter().enumerate().map(|(i, force)| force / mass.get(i, i)).collect()
    };
    let scheme = Scheme::new(n, local_steps.levels(), &pull);
    (0..n).step_by(n.div_ceil(MOST)).try_for_each(|k| {
        let mut x = vec![Rational::zero(); n];
        x[k] = Rational::one();
        let half = scheme.half_turn(0, local_steps.step().clone(), &x, &vec![Rational::zero(); n]);
        let right = effective.times(&x).into_iter().enumerate().all(|(i, force)| {
            let two = Rational::from_integer(2.into());
            two * (&half[i] - &x[i]) == -&square * force / mass.get(i, i)
        });
        holds(right, || {
            format!("a step of the scheme from a displacement of {k} does not follow from its stiffness")
        })
    })
}

/// The verdict on a large scheme, its growth and its limits.
pub fn sparse(
    sparse_steps: &SparseSteps,
    dt: f64,
    analysis: &Analysis,
    said: Option<&SchemeSummary>,
) -> Checked {
    verdict(sparse_steps, dt, analysis.holds())?;
    if let Some((lo, hi)) = analysis.growth_rate().filter(|_| analysis.holds() == Holds::Unstable) {
        let ritz = Extreme::of(sparse_steps, dt);
        let shapes = analysis.parts.iter().flat_map(|part| &part.instabilities).map(|mode| {
            let y = sparse_steps.weighted(&mode.shape);
            beyond(dot(&y, &turn(sparse_steps, dt, &y)) / dot(&y, &y))
        });
        // λ + 1/λ = ±(2 + excess).
        let excess = |rate: f64| 4.0 * (0.5 * rate * dt).sinh().powi(2);
        let found = shapes.fold(ritz.excess, f64::max);
        let right =
            (1.0 - GROWTH_REL_WIDTH) * excess(lo) <= found + ritz.room && found <= excess(hi) + ritz.room;
        holds(right, || {
            format!("the scheme, run, has f beyond its ends by {found}, not as it is said to grow")
        })?;
    }
    let Some(said) = said else { return Ok(()) };
    let n = sparse_steps.size();
    if let Some((lo, hi)) = said.plain_limit {
        let [_, most] = extremes(n, |y| sparse_steps.pull(y));
        let found = 2.0 / most.sqrt();
        let right = found >= lo * (1.0 - ROUNDED) && (n > SEEN || found <= hi * (1.0 + ROUNDED));
        holds(right, || format!("plain leapfrog's limit is {found}"))?;
    }
    if let Some((lo, hi)) = said.first_unstable {
        verdict(sparse_steps, lo, Holds::Stable)?;
        let excess = Extreme::of(sparse_steps, hi).excess;
        holds(n > SEEN || excess > -RESONANT, || format!("nothing is unstable up to a step of {hi}"))?;
    }
    Ok(())
}

/// No motion beyond the ends where all are said to be stable; some, where all are seen and one is said to
/// grow.
fn verdict(sparse_steps: &SparseSteps, dt: f64, said: Holds) -> Checked {
    let Extreme { excess, room } = Extreme::of(sparse_steps, dt);
    let right = match said {
        Holds::Stable => excess <= room,
        Holds::Unstable => sparse_steps.size() > SEEN || excess >= -room,
        Holds::Undecided => true,
    };
    holds(right, || {
        format!("at a step of {dt} the scheme, run, has f beyond its ends by {excess}: not {}", said.name())
    })
}

/// How far the eigenvalues of f that Lanczos's recursion sees are beyond 0 and 4, and what rounding makes of
/// it.
struct Extreme {
    excess: f64,
    room: f64,
}

impl Extreme {
    fn of(sparse_steps: &SparseSteps, dt: f64) -> Extreme {
        let [least, most] = extremes(sparse_steps.size(), |y| turn(sparse_steps, dt, y));
        Extreme {
            excess: beyond(least).max(beyond(most)),
            room: ROUNDED * (4.0 + least.abs().max(most.abs())),
        }
    }
}

/// How far f is beyond 0 and 4.
fn beyond(f: f64) -> f64 {
    (f - 4.0).max(-f)
}

/// f y = 2 y − y(dt) − y(−dt), mass-weighted, by the scheme itself.
fn turn(sparse_steps: &SparseSteps, dt: f64, y: &[f64]) -> Vec<f64> {
    let pull = |y: &[f64]| sparse_steps.pull(y);
    let half = Scheme::new(y.len(), sparse_steps.levels(), &pull).half_turn(0, dt, y, &vec![0.0; y.len()]);
    y.iter().zip(half).map(|(y, half)| 2.0 * (y - half)).collect()
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// The least and the largest eigenvalue of a symmetric matrix that Lanczos's recursion sees, each vector held
/// orthogonal to all before it.
fn extremes(n: usize, of: impl Fn(&[f64]) -> Vec<f64>) -> [f64; 2] {
    let unit = |x: Vec<f64>| {
        let length = dot(&x, &x).sqrt();
        (x.into_iter().map(|x| x / length).collect::<Vec<f64>>(), length)
    };
    let mut next = unit((1..=n).map(|i| (i as f64 * 0.754_877_666_246_692_7).fract() - 0.5).collect()).0;
    let (mut basis, mut diagonal, mut beside): (Vec<Vec<f64>>, Vec<f64>, Vec<f64>) = Default::default();
    while basis.len() < n.min(SEEN) {
        let mut image = of(&next);
        diagonal.push(dot(&next, &image));
        basis.push(next);
        // Twice is enough (Parlett).
        for values in basis.iter().chain(&basis) {
            let along = dot(values, &image);
            image.iter_mut().zip(values).for_each(|(x, value)| *x -= along * value);
        }
        let (values, length) = unit(image);
        let size = diagonal.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        if !length.is_finite() || length <= ROUNDED * size {
            break;
        }
        beside.push(length);
        next = values;
    }
    let entry = |i: usize, j: usize| match i.abs_diff(j) {
        0 => diagonal[i],
        1 => beside[i.min(j)],
        _ => 0.0,
    };
    let k = diagonal.len();
    let all = symmetric_eigenvalues(k, &entry).unwrap_or(diagonal.clone());
    [all.iter().copied().fold(f64::INFINITY, f64::min), all.into_iter().fold(f64::NEG_INFINITY, f64::max)]
}

/// Leapfrog with local time steps, as codes run it.
struct Scheme<'a, T> {
    /// Whether a degree of freedom moves at a level: all do at the coarsest.
    moves: Vec<Vec<bool>>,
    /// The substeps of each level but the finest one.
    substeps: Vec<u32>,
    /// M⁻¹ K x.
    pull: &'a dyn Fn(&[T]) -> Vec<T>,
}

impl<'a, T: Num + Clone> Scheme<'a, T> {
    fn new(n: usize, levels: &[Level], pull: &'a dyn Fn(&[T]) -> Vec<T>) -> Self {
        let fine = levels.iter().map(|level| (0..n).map(|i| level.fine.contains(&i)).collect());
        let moves = std::iter::once(vec![true; n]).chain(fine).collect();
        Scheme { moves, substeps: levels.iter().map(|level| level.substeps).collect(), pull }
    }

    /// (x(d) + x(−d))/2 from x(0) = `x` at level l with the step d, forces of coarser levels standing still
    /// at −`still` an inertia.
    fn half_turn(&self, l: usize, d: T, x: &[T], still: &[T]) -> Vec<T> {
        let whole = |n: u32| (0..n).fold(T::zero(), |sum, _| sum + T::one());
        let forced = |moves: &dyn Fn(usize) -> bool| -> Vec<T> {
            let part = |(i, x): (usize, &T)| if moves(i) { x.clone() } else { T::zero() };
            let pulled = (self.pull)(&x.iter().enumerate().map(part).collect::<Vec<_>>());
            pulled.into_iter().zip(still).map(|(pull, still)| pull + still.clone()).collect()
        };
        let Some(&substeps) = self.substeps.get(l) else {
            let half = d.clone() * d / whole(2);
            let kicked = forced(&|i| self.moves[l][i]);
            return x.iter().zip(kicked).map(|(x, a)| x.clone() - half.clone() * a).collect();
        };
        let still = forced(&|i| self.moves[l][i] && !self.moves[l + 1][i]);
        let d = d / whole(substeps);
        let (mut before, mut now) = (x.to_vec(), self.half_turn(l + 1, d.clone(), x, &still));
        for _ in 1..substeps {
            let turned = self.half_turn(l + 1, d.clone(), &now, &still);
            let both = turned.into_iter().zip(&before);
            let next = both.map(|(x, before)| x.clone() + x - before.clone()).collect();
            (before, now) = (now, next);
        }
        now
    }
}
