//! Local time steps of many thousands of degrees of freedom: f = Σ C_j dt^2j, every C_j sparse, in doubles
//! within proven bounds.

use faer::Mat;

use super::columns::{Block, Sparse, effective};
use super::scheme::{Level, LocalSteps, Scheme, SchemeSummary};
use crate::half::norm;
use crate::levels::search::first_past;
use crate::levels::sparse::{Pattern, Triplets, symmetric};
use crate::linear::sparse::Symmetric;
use crate::linear::system::{Potential, System};
use crate::verdict::large::start;
use crate::verdict::measured::{Holds, check_masses};
use number::{Rational, Result, U, bisected, from_f64_exact};

/// A diagonal mass, a sparse stiffness, levels from the coarsest to the finest one. Its verdicts are two
/// factorizations each.
///
/// ```
/// use kickdrift_systems::{Holds, Level, SparseSteps};
/// // A string of a thousand masses whose first hundred springs are four times as stiff.
/// let spring = |i: usize| if i < 100 { 4.0 } else { 1.0 };
/// let diagonal = (0..1000).map(|i| (i, i, spring(i) + spring(i + 1)));
/// let stiffness: Vec<_> = diagonal.chain((1..1000).map(|i| (i, i - 1, -spring(i)))).collect();
/// let levels = vec![Level { fine: (0..101).collect(), substeps: 2 }];
/// let steps = SparseSteps::new(&[1.0; 1000], &stiffness, levels)?;
/// // All with one step: below 1/2. The first fine motion takes half a turn in dt near 0.707.
/// let (lo, hi) = steps.first_unstable().expect("proven");
/// assert!(0.70 < lo && hi < 0.7075);
/// assert_eq!(steps.verdict(0.70), Holds::Stable);
/// assert_eq!(steps.verdict(1.05), Holds::Unstable);
/// # Ok::<(), kickdrift_systems::number::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct SparseSteps {
    pattern: Pattern,
    /// C_1 first.
    terms: Vec<Term>,
    levels: Vec<Level>,
    /// A,
    plain: Block,
    /// and its rows and columns that are fine at the first level, where there are any.
    fine: Option<Block>,
    /// The common motion, of length 1 and mass-weighted, where all may move together.
    rigid: Mat<f64>,
    /// The largest sum of a row of K beside that of its |entries|.
    sums: f64,
    roots: Vec<f64>,
    /// Of a small one masses and K, for exact arithmetic.
    given: Option<(Vec<f64>, Box<Triplets>)>,
}

/// C_j, how far it is from the one that is meant, and no less than its norm (2-norms).
#[derive(Clone, Debug)]
struct Term {
    values: Vec<f64>,
    error: f64,
    size: f64,
}

/// Sums of rows so small beside those of |entries| are the rounding of each entry: then all may move
/// together.
const RIGID: f64 = 8.0 * U;

/// Sums of rows that are small and no rounding: all together are neither clearly free nor clearly held.
const NEARLY: f64 = 1e-9;

/// Degrees of freedom up to which exact arithmetic tells what doubles do not.
const SMALL: usize = 24;

/// Rounds of inverse iteration for the motion that grows fastest.
const ROUNDS: usize = 12;

/// The most times that these begin anew, nearer to what they seek.
const MOST_ROUNDS: usize = 12;

/// How sharply eigenvalues are enclosed that limit steps, and the relative width within which the first
/// unstable one is sought.
const LIMIT: f64 = 1e-6;
const WIDTH: f64 = 1e-5;

/// How sharp a growth rate is: of λ − 4 of the largest λ.
const SHARP: f64 = 0.02;

impl SparseSteps {
    /// From K, each pair of entries once or both alike, and the mass of each degree of freedom. Where the
    /// rows of K sum to 0, all may move together and that motion is set apart.
    ///
    /// # Errors
    /// Masses that are not positive, numbers that are not finite, indices beyond the rows, pairs of entries
    /// that differ; levels as [`LocalSteps::new`].
    pub fn new(masses: &[f64], stiffness: &Triplets, levels: Vec<Level>) -> Result<SparseSteps> {
        let n = masses.len();
        check_masses(masses)?;
        Level::check(&levels, n)?;
        let given = symmetric("stiffness", n, stiffness, false)?;
        let roots: Vec<f64> = masses.iter().map(|m| m.sqrt()).collect();
        let (rigid, sums) = rigid(&given, &roots);
        let weighted: Vec<_> = given.iter().map(|&(i, j, x)| (i, j, x / (roots[i] * roots[j]))).collect();
        let whole = Sparse::symmetric(n, &weighted);
        let plain = whole.block(0..n)?;
        let fine = levels.first().filter(|levels| !levels.fine.is_empty());
        let fine = fine.map(|fine| whole.block(fine.fine.iter().copied())).transpose()?;
        let coefficients = effective(whole, &levels);
        let triplets: Vec<_> = coefficients.iter().map(Sparse::lower).collect();
        let (pattern, values) = Pattern::of_all(n, &triplets.iter().map(Vec::as_slice).collect::<Vec<_>>())?;
        let term = |(values, sparse): (Vec<f64>, &Sparse)| {
            // The lower triangle stands for both: sums of rows and of columns.
            Term { size: pattern.size_of(&values).0, values, error: 2.0 * sparse.error }
        };
        let terms = values.into_iter().zip(&coefficients).map(term).collect();
        let given = (n <= SMALL).then(|| (masses.to_vec(), given.into_boxed_slice()));
        Ok(SparseSteps { pattern, terms, levels, plain, fine, rigid, sums, roots, given })
    }

    /// The number of degrees of freedom.
    pub fn size(&self) -> usize {
        self.pattern.size()
    }

    /// The products of one factorization.
    pub fn products(&self) -> f64 {
        self.pattern.products()
    }

    /// The levels, the coarsest first.
    pub fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// M^½ x of positions x.
    pub fn weighted(&self, x: &[f64]) -> Vec<f64> {
        x.iter().zip(&self.roots).map(|(x, root)| x * root).collect()
    }

    /// A y = M^-½ K M^-½ y, rounded.
    pub fn pull(&self, y: &[f64]) -> Vec<f64> {
        let block = &self.plain;
        block.pattern.times(&block.values, &Mat::from_fn(y.len(), 1, |i, _| y[i])).col_as_slice(0).to_vec()
    }

    /// Rigid motions that are set apart: 0 or 1.
    pub fn rigid_motions(&self) -> usize {
        self.rigid.ncols()
    }

    /// The largest sum of a row of K relative to that of its |entries|, where that is small and yet no
    /// rounding: whether all together are free is not clear.
    pub fn nearly_free(&self) -> Option<f64> {
        (self.rigid.ncols() == 0 && self.sums <= NEARLY).then_some(self.sums)
    }

    /// The same scheme with this step in rational numbers, of some dozen degrees of freedom at most; `None`
    /// of more.
    pub fn exactly(&self, step: &Rational) -> Option<Result<LocalSteps>> {
        let (masses, stiffness) = self.given.as_ref()?;
        let exact = |x: f64| from_f64_exact(x).expect("finite");
        let mut symmetric = Symmetric::zero(self.size());
        stiffness.iter().for_each(|&(i, j, x)| symmetric.add(i, j, &exact(x)));
        let mass = Symmetric::diagonal(&masses.iter().map(|&m| exact(m)).collect::<Vec<_>>());
        let plain = System::new(mass, vec![Potential::new(symmetric, step.clone())]);
        Some(plain.and_then(|plain| LocalSteps::new(plain, self.levels.clone())))
    }

    /// f at dt² = `square` to its rounding, and how far the f that is meant is from it (2-norm).
    fn at(&self, square: f64) -> (Vec<f64>, f64) {
        let mut values = vec![0.0; self.terms[0].values.len()];
        let (mut power, mut off) = (1.0, 0.0);
        for (j, term) in self.terms.iter().enumerate() {
            power *= square;
            values.iter_mut().zip(&term.values).for_each(|(sum, x)| *sum += power * x);
            // Of the power, two roundings each, of the products and of the sums.
            off += power * (term.error + (3 * j + self.terms.len() + 5) as f64 * U * term.size);
        }
        (values, 1.01 * off)
    }

    /// The verdict at a step, the nearest double of it: both factorizations run to their end, or one counts
    /// what lies beyond.
    pub fn verdict(&self, dt: f64) -> Holds {
        let (values, off) = self.at(dt * dt);
        match (self.above(&values, off), self.below(&values, off, 4.0)) {
            (Holds::Stable, Holds::Stable) => Holds::Stable,
            (Holds::Unstable, _) | (_, Holds::Unstable) => Holds::Unstable,
            _ => Holds::Undecided,
        }
    }

    /// Whether c − f > 0: stable, or an eigenvalue of f is above c.
    fn below(&self, values: &[f64], off: f64, c: f64) -> Holds {
        if self.pattern.is_definite(c, &[(-1.0, values)], off) {
            return Holds::Stable;
        }
        self.unstable_along(values, -1.0, off, c)
    }

    /// Whether f > 0 off the rigid motion.
    fn above(&self, values: &[f64], off: f64) -> Holds {
        let terms = [(1.0, values)];
        if self.rigid.ncols() == 0 {
            if self.pattern.is_definite(0.0, &terms, off) {
                return Holds::Stable;
            }
            return self.unstable_along(values, 1.0, off, 0.0);
        }
        // P f P − f for the projection on the rest: ‖f r‖ twice and rᵀ f r once.
        let ((size, count), image) = (self.pattern.size_of(values), self.pattern.times(values, &self.rigid));
        let rounding = 2.0 * (count as f64 + 2.0) * U * size;
        let off = off + 3.1 * (norm::frobenius(&image) + rounding);
        if self.pattern.at_most_negative(0.0, &terms, off).is_some_and(|count| count <= self.rigid.ncols()) {
            return Holds::Stable;
        }
        self.unstable_along(values, 1.0, off, 0.0)
    }

    /// Unstable where some vector proves that c + a f has a negative eigenvalue, a = ±1.
    fn unstable_along(&self, values: &[f64], a: f64, off: f64, c: f64) -> Holds {
        self.beyond(values, off, (a, c), false).map_or(Holds::Undecided, |_| Holds::Unstable)
    }

    /// Of the motion that grows fastest at an unstable step: an enclosure of the largest ln |λ| of a step,
    /// and positions, rounded, the longest entry 1. With the largest λ of f, or of 4 − f, 2 asinh √(λ/4 − 1):
    /// a step multiplies by as much. `None` where nothing is proven to grow.
    pub fn growth(&self, dt: f64) -> Option<Growth> {
        let (values, off) = self.at(dt * dt);
        let above = self.beyond(&values, off, (-1.0, 4.0), true);
        let below = self.beyond(&values, off, (1.0, 0.0), true);
        let is_above =
            below.as_ref().is_none_or(|below| above.as_ref().is_some_and(|above| above.hi >= below.hi));
        let (beyond, other, end) =
            if is_above { (above?, below, (1.0, 0.0)) } else { (below?, above, (-1.0, 4.0)) };
        let (lo, hi) =
            other.as_ref().map_or((beyond.lo, beyond.hi), |other| (beyond.lo.max(other.lo), beyond.hi));
        // Beyond the other end nothing is farther out.
        let is_known = other.is_some() || self.pattern.is_definite(end.1 + hi, &[(end.0, &values)], off);
        // Ten roundings at most.
        let rate = |excess: f64, round: f64| 2.0 * (excess.sqrt() / 2.0).asinh() * (1.0 + round * 10.0 * U);
        let shape: Vec<f64> = (0..self.size()).map(|i| beyond.along[(i, 0)] / self.roots[i]).collect();
        let longest = shape.iter().fold(0.0, |most: f64, x| if x.abs() > most.abs() { *x } else { most });
        is_known.then(|| Growth {
            excess: (lo, hi),
            rate: (rate(lo, -1.0), rate(hi, 1.0)),
            is_above,
            shape: shape.into_iter().map(|x| x / longest).collect(),
        })
    }

    /// The largest eigenvalue of −(c + a f), enclosed, where it is proven to be above 0: below by the
    /// quotient of the vector that inverse iteration finds, above by a factorization.
    fn beyond(&self, values: &[f64], off: f64, (a, c): (f64, f64), is_sharp: bool) -> Option<Beyond> {
        let (n, size) = (self.size() as f64, self.pattern.size_of(values).0);
        let factors = |by: f64| self.pattern.factored(c + by, &[(a, values)], off);
        let rooms = std::iter::successors(Some(LEAST * size), |by| Some(16.0 * by))
            .take_while(|&by| by < 32.0 * size);
        let (mut hi, mut factored) = rooms.into_iter().find_map(|by| Some((by, factors(by)?)))?;
        let (begin, mut lo) = (start(self.size()), f64::MIN);
        let mut x = Mat::from_fn(self.size(), 1, |i, _| begin[i]);
        // Sums of n products each, of |x|ᵀ|f||x| ≤ ‖f‖.
        let rounding = 1.02 * (n + 8.0) * U;
        for _ in 0..MOST_ROUNDS {
            x = factored.iterated(x, &self.rigid, ROUNDS)?;
            let (square, form) =
                (x.squared_norm_l2(), (x.transpose() * self.pattern.times(values, &x))[(0, 0)]);
            let least = -(c * square + a * form) - 1.01 * square * (off + rounding * (size + c));
            lo = least / (square * (1.0 + rounding));
            let is_done = if lo > 0.0 { !is_sharp || hi <= lo * (1.0 + SHARP) } else { hi <= LEAST * size };
            if is_done {
                break;
            }
            // Nearer to its own quotient, where that proves it: a step of the iteration then brings more.
            let nearer =
                if lo > 0.0 { [lo * (1.0 + SHARP / 2.0), (lo * hi).sqrt()] } else { [hi / 8.0, hi / 2.0] };
            if let Some((by, next)) = nearer.into_iter().find_map(|by| Some((by, factors(by)?))) {
                (hi, factored) = (by, next);
            }
        }
        (lo > 0.0).then_some(Beyond { lo, hi, along: x })
    }

    /// Where plain leapfrog, all with the step of the whole, becomes unstable, as
    /// [`LocalSteps::plain_limit`].
    pub fn plain_limit(&self) -> Option<(f64, f64)> {
        let (lo, hi) = self.plain.largest(LIMIT)?;
        Some((2.0 / hi.sqrt() * (1.0 - 4.0 * U), 2.0 / lo.sqrt() * (1.0 + 4.0 * U)))
    }

    /// \[lo, hi\]: every step in (0, lo] is proven stable, some step up to hi is proven unstable; `None`
    /// where nothing is proven, or with several levels.
    ///
    /// With the fine part F of A, y its eigenvalues and θ of the substep, 4 sin²(θ/2) = (dt/p)² y, stable
    /// steps are one interval up to where the fastest fine motion has p θ = π (proofs/LOCAL_STEPS.md). There
    /// f has an eigenvalue of 4 or more, however weakly that motion is coupled: where every step up to there
    /// is stable, hi is no more than the resonance itself is known to, and no factorization could see what
    /// lies beyond.
    pub fn first_unstable(&self) -> Option<(f64, f64)> {
        let [level] = &self.levels[..] else { return None };
        let (low, high) = self.fine.as_ref()?.largest(LIMIT)?;
        let p = f64::from(level.substeps);
        let z = 4.0 * (std::f64::consts::FRAC_PI_2 / p).sin().powi(2);
        let at = |y: f64, round: f64| p * (z / y).sqrt() * (1.0 + round * 8.0 * U);
        let (top, resonance) = (at(high, -1.0), at(low, 1.0));
        let is_below = |dt: f64| {
            let (values, off) = self.at(dt * dt);
            self.pattern.is_definite(4.0, &[(-1.0, &values)], off)
        };
        // f > 0 at one step below is A > 0, and then f > 0 at all.
        let is_stable = |dt: &f64| is_below(*dt) && self.verdict(*dt) == Holds::Stable;
        let start = (0..12).map(|k| top * 0.5f64.powi(k)).find(is_stable)?;
        if start == top || is_below(top) {
            return Some((top, resonance));
        }
        let (lo, beyond) = bisected((start, top), WIDTH, |dt| Some(is_below(dt)));
        let is_beyond = |dt: f64| {
            let (values, off) = self.at(dt * dt);
            self.below(&values, off, 4.0) == Holds::Unstable
        };
        let told = first_past(beyond, WIDTH / 1.6, resonance, is_beyond);
        Some((lo, told.unwrap_or(resonance)))
    }

    /// The summary of the scheme in answers.
    pub fn summary(&self) -> SchemeSummary {
        let known = SchemeSummary::new(Scheme::Lts, self.size(), &self.levels, self.plain_limit());
        SchemeSummary { first_unstable: self.first_unstable(), ..known }
    }
}

/// The motion that grows fastest.
#[derive(Clone, Debug)]
pub struct Growth {
    /// How far the largest eigenvalue of f is above 4, or the least one below 0.
    pub excess: (f64, f64),
    /// ln |λ| of a step.
    pub rate: (f64, f64),
    /// Whether f is above 4, λ < −1; else below 0, λ > 1.
    pub is_above: bool,
    pub shape: Vec<f64>,
}

/// The largest eigenvalue of a matrix, and a vector that is near its own.
struct Beyond {
    lo: f64,
    hi: f64,
    along: Mat<f64>,
}

/// The least room above what is sought, relative to ‖f‖: below that factorizations prove nothing.
const LEAST: f64 = 1e-11;

/// The mass-weighted motion of all together, where the rows of K, given by its lower triangle, sum to 0
/// within the rounding of their entries; and the largest of these sums, relative to those of |entries|.
fn rigid(stiffness: &Triplets, roots: &[f64]) -> (Mat<f64>, f64) {
    let n = roots.len();
    let (mut sums, mut sizes, mut counts) = (vec![0.0; n], vec![0.0f64; n], vec![0.0; n]);
    for &(i, j, x) in stiffness {
        for row in std::iter::once(i).chain((i != j).then_some(j)) {
            sums[row] += x;
            sizes[row] += x.abs();
            counts[row] += 1.0;
        }
    }
    let rows = || sums.iter().zip(&sizes).map(|(sum, size): (&f64, &f64)| (sum.abs(), *size));
    let is_rigid = rows().zip(&counts).all(|((sum, size), count)| sum <= RIGID * count * size);
    let largest = rows().filter(|pair| pair.1 > 0.0).map(|(sum, size)| sum / size).fold(0.0, f64::max);
    let length = roots.iter().map(|x| x * x).sum::<f64>().sqrt();
    (Mat::from_fn(n, usize::from(is_rigid), |i, _| roots[i] / length), largest)
}

impl LocalSteps {
    /// The summary of the scheme in answers.
    pub fn summary(&self) -> SchemeSummary {
        SchemeSummary::new(Scheme::Lts, self.system().size(), self.levels(), self.plain_limit())
    }
}
