//! A period or half of one in doubles with a proven bound, with friction, and with a stiffness of its own for
//! every kick.
//!
//! Each step is Ĥ_k = M_k Ĥ_(k−1) + Δ_k, the M_k shears or, with friction, shears times diag(1, c): then H_k
//! is d_k^½ times a symplectic matrix, d_k the product of the c's, and H_k⁻¹ takes an error R in the rows of
//! momenta to Xᵀ R/d_k, X the rows of positions, and one in those of positions to Pᵀ R/d_k, but for signs.
//! The error after the last step is Σ_j H H_j⁻¹ Δ_j, so with σ = Σ ‖X̂_j‖ ‖R_j‖/d_j (or P̂_j), ρ = Σ
//! ‖R_j‖/d_j and G = max ‖Ĥ_k‖ the bound of [`float`](crate::half::float) holds: if 8 G ρ ≤ 1 all errors stay
//! below 2 G σ, and ‖E‖ ≤ ‖Ĥ‖ s/(1 − s), s = σ + 2 G σ ρ. A kick F that is off by δ has R = δ X, and its term
//! is δ ‖X̂‖²: norms are spectral, of many rows some n times less than Frobenius's.

use std::collections::BTreeMap;

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef};

use crate::half::compose::Row;
use crate::half::float::FloatBlocks;
use crate::half::norm;
use clocks::schedule::{Event, Weight};
use number::{Ball, Rational, U};

/// One kick: F, and how far (2-norm) the true F may be from it: `off`, and `known` beside it where F was
/// measured.
#[derive(Clone, Debug)]
pub(crate) struct Stiff {
    pub stiffness: Stiffness,
    pub off: f64,
    pub known: f64,
}

#[derive(Clone, Debug)]
pub enum Stiffness {
    /// The rows that are not 0.
    Rows(Vec<(usize, Row<f64>)>),
    /// All of it, where few entries are 0: products of whole matrices take a tenth of the time.
    Whole(Mat<f64>),
}

/// The motion between the events: drifts with M⁻¹ in ticks, which is known to `off` (2-norm), v → c v with
/// c = exp(−decay) a tick.
#[derive(Clone, Debug)]
pub(crate) struct Drifts<'a> {
    pub inverse_mass: &'a [Row<f64>],
    pub decay: &'a Rational,
    pub off: f64,
}

/// The rows of positions and momenta, 2n columns each, and the bound on the error of all (2-norm).
#[derive(Clone, Debug)]
pub(crate) struct Propagated {
    pub n: usize,
    x: Vec<f64>,
    p: Vec<f64>,
    pub error: Option<f64>,
    account: Account,
}

/// ‖R‖ and ‖X‖ ‖R‖ of one step's errors, with P in place of X for errors of positions; and of a kick's
/// `known` alone.
struct Step {
    error: f64,
    taken_back: f64,
    known: [f64; 2],
}

/// From so many columns on sums of rows and columns are worth their time.
const MANY: usize = 32;

/// The sums of the bound: of what rounding and `off` leave, and of what is `known` beside them.
#[derive(Clone, Debug)]
struct Account {
    rho: [f64; 2],
    sigma: [f64; 2],
    largest: f64,
    /// d_k.
    volume: f64,
}

impl Account {
    fn add(&mut self, Step { error, taken_back, known }: Step, size: f64) {
        self.largest = self.largest.max(size);
        for (k, [error, taken_back]) in [[error, taken_back], known].into_iter().enumerate() {
            self.rho[k] += error / self.volume;
            self.sigma[k] += taken_back / self.volume;
        }
    }
}

/// Follows the events, `kick(k, clock)` being the stiffness that the clock kicks with in the k-th of them.
pub fn follow<'a>(
    drifts: &Drifts,
    events: impl Iterator<Item = Event>,
    kick: impl Fn(usize, usize) -> &'a Stiff,
) -> Propagated {
    followed(drifts, events, kick, |_, _, _| true).expect("never given up")
}

/// Follows with a bound; `None` as soon as there can be none.
pub(crate) fn follow_proven<'a>(
    drifts: &Drifts,
    events: impl Iterator<Item = Event>,
    kick: impl Fn(usize, usize) -> &'a Stiff,
) -> Option<Propagated> {
    follow_looking(drifts, events, kick, |_, _| ())
}

/// Follows with a bound, and shows `look` every event and the rows of positions there, 2n columns each,
/// within [`Propagated::error_on_the_way`].
pub(crate) fn follow_looking<'a>(
    drifts: &Drifts,
    events: impl Iterator<Item = Event>,
    kick: impl Fn(usize, usize) -> &'a Stiff,
    mut look: impl FnMut(&Event, &[f64]),
) -> Option<Propagated> {
    let state = followed(drifts, events, kick, |account, event, x| {
        look(event, x);
        account.holds(0.0)
    });
    state.filter(|state| state.error.is_some())
}

fn followed<'a>(
    drifts: &Drifts,
    events: impl Iterator<Item = Event>,
    kick: impl Fn(usize, usize) -> &'a Stiff,
    mut goes_on: impl FnMut(&Account, &Event, &[f64]) -> bool,
) -> Option<Propagated> {
    let n = drifts.inverse_mass.len();
    let unit = |first: usize| {
        (0..2 * n * n).map(|k| f64::from(u8::from(k % (2 * n) == first + k / (2 * n)))).collect()
    };
    let mut account = Account { rho: [0.0; 2], sigma: [0.0; 2], largest: 1.0, volume: 1.0 };
    let mut state = Propagated { n, x: unit(0), p: unit(n), error: None, account: account.clone() };
    let mut sizes = [1.0; 2];
    let mut known: BTreeMap<u64, f64> = BTreeMap::new();
    for (k, event) in events.enumerate() {
        if event.drift > 0 {
            let c = *known.entry(event.drift).or_insert_with(|| decayed(drifts.decay, event.drift));
            let step = state.drift(drifts, event.drift as f64, c, &mut sizes);
            account.volume *= c;
            account.add(step, sizes[0].hypot(sizes[1]));
        }
        for clock in event.clocks() {
            let step = state.kick(kick(k, clock), event.weight, &mut sizes);
            account.add(step, sizes[0].hypot(sizes[1]));
        }
        if !goes_on(&account, &event, &state.x) {
            return None;
        }
    }
    state.account = account;
    state.error = state.error_within(0.0);
    Some(state)
}

/// exp(−decay ticks), to the nearest double but for 2^-60.
pub(crate) fn decayed(decay: &Rational, ticks: u64) -> f64 {
    let exponent = decay * Rational::from_integer(ticks.into());
    Ball::from_rational(&exponent, 96).neg().exp(96).mid_f64()
}

impl Account {
    /// The bound's condition; once it fails it fails for good, as both factors only grow.
    fn holds(&self, times: f64) -> bool {
        // 1.01: as in the bound. A sum that is no number fails the comparison, too.
        8.0 * (1.01 * self.largest) * (1.01 * within(self.rho, times)) <= 1.0
    }

    /// Where it holds.
    fn bound(&self, end: f64, times: f64) -> f64 {
        // 1.01: the roundings of norms, of d_k and of the sums.
        let [rho, sigma] = [self.rho, self.sigma].map(|sums| 1.01 * within(sums, times));
        let largest = 1.01 * self.largest;
        let s = sigma + 2.0 * largest * sigma * rho;
        1.02 * end * s / (1.0 - s)
    }
}

/// With so many times what is known.
fn within([own, known]: [f64; 2], times: f64) -> f64 {
    // Exact where nothing is added.
    if times > 0.0 { own + times * known } else { own }
}

impl Propagated {
    /// The bound on the error where each F is off by `off` and so many times its `known`; `None` where its
    /// condition fails.
    pub fn error_within(&self, times: f64) -> Option<f64> {
        self.account.holds(times).then(|| self.account.bound(self.norm(), times))
    }

    /// More than the error (2-norm) of all positions and momenta on the way, where the bound holds.
    pub fn error_on_the_way(&self) -> f64 {
        2.1 * self.account.largest * self.account.sigma[0]
    }

    fn row(rows: &[f64], columns: usize, i: usize) -> &[f64] {
        &rows[i * columns..(i + 1) * columns]
    }

    /// More than ‖Ĥ‖.
    fn norm(&self) -> f64 {
        spectral(&self.x, self.n).hypot(spectral(&self.p, self.n))
    }

    /// x ← x + t (1 + c)/2 M⁻¹ p, p ← c p; more than the error. The sizes are bounds of ‖X̂‖ and ‖P̂‖, before
    /// and then after.
    fn drift(&mut self, drifts: &Drifts, ticks: f64, c: f64, [x_size, p_size]: &mut [f64; 2]) -> Step {
        let columns = 2 * self.n;
        let mean = ticks * (1.0 + c) / 2.0;
        let mut squares = 0.0;
        let moved = mean * drifts.off * *p_size;
        for (i, masses) in drifts.inverse_mass.iter().enumerate() {
            let target = &mut self.x[i * columns..(i + 1) * columns];
            let mut size = norm2(target).sqrt();
            for (j, a) in masses {
                let (factor, p) = (mean * a, Propagated::row(&self.p, columns, *j));
                target.iter_mut().zip(p).for_each(|(x, p)| *x += factor * p);
                size += factor.abs() * norm2(p).sqrt();
            }
            // Each term: the factor's five roundings (a, t, c, sum, product), the product's, at most k sums.
            squares += ((masses.len() as f64 + 6.0) * size).powi(2);
        }
        let of_positions = 1.01 * (U * squares.sqrt() + moved);
        *x_size = bound(&self.x, columns);
        if c == 1.0 {
            return Step { error: of_positions, taken_back: of_positions * *p_size, known: [0.0; 2] };
        }
        let of_momenta = 1.01 * U * 2.0 * norm2(&self.p).sqrt();
        self.p.iter_mut().for_each(|p| *p *= c);
        // 1.01: the rounding of the rows just scaled.
        *p_size *= 1.01 * c;
        let taken_back = of_positions * *p_size + of_momenta * *x_size;
        Step { error: of_positions + of_momenta, taken_back, known: [0.0; 2] }
    }

    /// p ← p − w F x; more than the error. The sizes as in `drift`.
    fn kick(&mut self, stiff: &Stiff, weight: Weight, [x_size, p_size]: &mut [f64; 2]) -> Step {
        let columns = 2 * self.n;
        let weight = -weight.share();
        let squares = match &stiff.stiffness {
            Stiffness::Rows(rows) => self.kick_rows(rows, weight),
            Stiffness::Whole(stiffness) => self.kick_whole(stiffness, weight),
        };
        *p_size = bound(&self.p, columns);
        if stiff.known > 0.0 {
            // The error of a kick exceeds its roundings by far: the norm is worth the products.
            *x_size = x_size.min(spectral(&self.x, self.n));
        }
        let error = 1.01 * (U * squares.sqrt() + weight.abs() * stiff.off * *x_size);
        let known = 1.01 * weight.abs() * stiff.known * *x_size;
        Step { error, taken_back: error * *x_size, known: [known, known * *x_size] }
    }

    /// p ← p + w F x row by row; the square of what U times bounds the rounding.
    fn kick_rows(&mut self, rows: &[(usize, Row<f64>)], weight: f64) -> f64 {
        let (columns, mut squares) = (2 * self.n, 0.0);
        for (i, row) in rows {
            let target = &mut self.p[i * columns..(i + 1) * columns];
            let mut size = norm2(target).sqrt();
            for (j, a) in row {
                let (factor, x) = (weight * a, Propagated::row(&self.x, columns, *j));
                target.iter_mut().zip(x).for_each(|(p, x)| *p += factor * x);
                size += factor.abs() * norm2(x).sqrt();
            }
            squares += ((row.len() as f64 + 3.0) * size).powi(2);
        }
        squares
    }

    /// Kicks at once, w a power of 2: whatever the order of its sums, an entry is off by n + 1 roundings of
    /// the sum of all sizes at most.
    fn kick_whole(&mut self, stiffness: &Mat<f64>, weight: f64) -> f64 {
        let (n, columns) = (self.n, 2 * self.n);
        let sizes = |rows: &[f64]| Mat::from_fn(n, 1, |i, _| norm2(Propagated::row(rows, columns, i)).sqrt());
        let absolute = Mat::from_fn(n, n, |i, j| weight.abs() * stiffness[(i, j)].abs());
        let size = sizes(&self.p) + absolute * sizes(&self.x);
        let x = MatRef::from_row_major_slice(&self.x, n, columns);
        let p = MatMut::from_row_major_slice_mut(&mut self.p, n, columns);
        matmul(p, Accum::Add, stiffness.as_ref(), x, weight, faer::get_global_parallelism());
        // 1.01: the roundings of these sums, of up to 10^12 terms.
        (0..n).map(|i| (1.01 * (n as f64 + 3.0) * size[(i, 0)]).powi(2)).sum()
    }

    /// The whole propagator, 2n x 2n.
    pub fn matrix(&self) -> Mat<f64> {
        let columns = 2 * self.n;
        Mat::from_fn(columns, columns, |i, j| {
            if i < self.n { self.x[i * columns + j] } else { self.p[(i - self.n) * columns + j] }
        })
    }

    /// As the blocks of a half period whose positions are a_i x_i.
    pub fn blocks(&self, scales: Vec<f64>) -> FloatBlocks {
        let (n, x, p) = (self.n, &self.x, &self.p);
        let matrices = [block(x, n, 0), block(x, n, n), block(p, n, 0), block(p, n, n)];
        let norm = self.norm() + self.error.unwrap_or(0.0);
        FloatBlocks { matrices, error: self.error, norm, scales }
    }
}

/// More than the 2-norm of the rows, each of so many columns: Frobenius's, or of many rows the root of the
/// largest sums.
fn bound(rows: &[f64], columns: usize) -> f64 {
    let size = 1.01 * norm2(rows).sqrt();
    if columns < MANY || !size.is_finite() {
        size
    } else {
        size.min(norm::by_sums(columns, rows.chunks(columns)))
    }
}

/// A sharper bound at the cost of products: ‖(A B)‖² ≤ ‖A‖² + ‖B‖².
fn spectral(rows: &[f64], n: usize) -> f64 {
    let size = |first: usize| norm::spectral(&block(rows, n, first));
    1.01 * size(0).hypot(size(n))
}

/// The n columns from the given one on, of rows of 2n.
fn block(rows: &[f64], n: usize, first: usize) -> Mat<f64> {
    Mat::from_fn(n, n, |i, j| rows[i * 2 * n + first + j])
}

fn norm2(row: &[f64]) -> f64 {
    row.iter().map(|x| x * x).sum()
}
