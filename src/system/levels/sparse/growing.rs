//! The modes that grow beyond the first unstable step, where p θ < π still holds for every fast mode.
//!
//! Where the fast stiffness falls into small blocks a Krylov space of an inverse (file `counted`), above the largest excess that products tell, has the modes.
//! Elsewhere one of the excess e itself (file `period`), symmetric in the scalar product of V, is begun anew from its best part until the largest
//! eigenvalues are found (thick restarts: Wu and Simon, SIAM J. Matrix Anal. Appl. 22, 2000). What is claimed of them rests on their residuals
//! alone, computed again with bounds on all roundings (proofs/REGION.md, section 9):
//!
//! * k vectors with residuals R and nearly orthonormal, Gram matrix 1 + Δ, are claims on k eigenvalues, each within 2 |R|/√(1 − |Δ|) + 1.3 |Δ| times their
//!   spread of its own;
//! * no more modes grow than α − β h² F − M has negative eigenvalues, for a line α − β s below a/b: one factorization;
//! * no excess is above ε where α − β h² F + 2 ε ℓ(h² F) − M > 0, ℓ a tangent of the convex 1/V: again one each;
//! * where F falls into small blocks, counts say both without a line, and also where p θ > π for some (file `counted`). There the excess is
//!   symmetric in no scalar product: its modes are rounded, and the counts are what is proven.

use faer::{Mat, Side};
use num_complex::Complex64;

use super::counted::{Counted, LEAST};
use super::krylov::arnoldi;
use super::period::Period;
use super::region::SparseLevels;
use crate::number::{U, bisected};
use crate::system::half::norm;
use crate::system::levels::chord::chord;
use crate::system::levels::half::inverse_twist;
use crate::system::levels::kernel::Outer;
use crate::system::spectrum::rate;
use crate::system::verdict::large::start;
use crate::system::verdict::measured::Holds;

/// What is proven to grow at an unstable outer step.
#[derive(Clone, Debug)]
pub struct Growing {
    /// The fastest first.
    pub modes: Vec<GrowingMode>,
    /// So many grow by a multiplier below −1 for sure,
    pub at_least: usize,
    /// and no more than so many; `None` where they are not counted.
    pub at_most: Option<usize>,
    /// An enclosure of the largest ln |λ| of a period, infinite above where only the least is proven; `None` where nothing bounds it above.
    pub fastest: Option<(f64, f64)>,
}

/// A mode that grows.
#[derive(Clone, Debug)]
pub struct GrowingMode {
    /// μ, λ + 1/λ = 2 + 4 μ, rounded; −1 − e of a multiplier λ < −1.
    pub mu: Complex64,
    /// The true μ is within this of it: as many true ones as modes, where these ranges meet; `None`: not bounded.
    pub radius: Option<f64>,
    /// An enclosure of ln |λ| of a period, infinite above where only the least growth is proven; `None`: not bounded.
    pub growth: Option<(f64, f64)>,
    /// Positions, the longest entry 1, rounded,
    pub shape: Vec<f64>,
    /// and a quarter of the beat later; 0 for a multiplier below −1.
    pub quadrature: Vec<f64>,
}

/// The most modes that are looked for.
const WANTED: usize = 12;

/// Vectors of a Krylov space, and how many are kept when it begins anew.
const SPACE: usize = 96;
const KEPT: usize = 40;

/// How often it does.
const MOST_ROUNDS: usize = 60;

/// Residuals at which a mode counts as found, its length by V being 1: its growth is told to some six digits. None is told above the second.
const FOUND: f64 = 1e-9;
const TOLD: f64 = 1e-6;

/// How sharp growth is to be at best: a part of the excess.
const NEAREST: f64 = 1e-5;

/// Rooms above the largest excess that is found, relative to it, up to which the true one is sought.
const ROOMS: [f64; 6] = [0.003, 0.1, 0.5, 2.0, 8.0, 100.0];

/// Parts beside the one that is found, up to which counts are asked for none above and some below.
const BESIDE: [f64; 5] = [1e-3, 0.03, 0.1, 0.3, 0.7];

/// How often a larger or a smaller one is asked for.
const MOST_TURNS: i32 = 12;

/// How many bounds from below are tried where it is not known that anything grows.
const MOST_UNKNOWN: usize = 2;

/// Steps of a recursion that finds about the largest excess, and what part above it a Krylov space of an inverse begins.
const STEPS: usize = 160;
const ABOVE: f64 = 1.1;

/// How often that is tried.
const MOST_TRIES: u32 = 4;

/// How near to each other an excess that is proven and one that is not are to be, relative to the first.
const BETWEEN: f64 = 0.25;

/// What a Krylov space tells: eigenvalues, the largest first, and vectors of length 1 by V.
struct Ritz {
    values: Vec<f64>,
    vectors: Mat<f64>,
}

impl SparseLevels {
    /// The verdict at an outer step and the growth, without the number of modes that grow: what a scan shows, at about half the cost of
    /// [`SparseLevels::beyond`]. Steps below the end of the first region need no factorization.
    pub fn growth(&self, outer: &Outer) -> (Holds, Option<Growing>) {
        if self.unheld() == Some(0) && self.is_below_first(outer, 0.0) {
            return (Holds::Stable, None);
        }
        // What proves a step proves those below it, and nothing proves where the region ends.
        let is_near = self.first_resonance(outer.inner_steps()).is_none_or(|(_, hi)| outer.step() < hi);
        if is_near && self.is_proven(outer, 0.0) {
            return (Holds::Stable, None);
        }
        self.beyond(outer, false)
    }

    /// The verdict at an outer step where the first region's line proves nothing, and what grows: the fastest modes, up to a dozen, and how many do where these
    /// `are_counted`. `Unstable` without any where none is found beside the vector that proves it.
    ///
    /// Cost: some hundred to some thousand products with S, p times as many with F, and one to a dozen factorizations.
    pub fn beyond(&self, outer: &Outer, are_counted: bool) -> (Holds, Option<Growing>) {
        let counted = self.counted(outer, 0.0);
        // By modes that are proven to grow, or by counts: of these few where it is not known that any does.
        let growing = |is_known| {
            let first = self.growing_first(outer, counted.as_ref(), are_counted);
            first.or_else(|| self.growing_past(outer, counted.as_ref()?, [are_counted, is_known]))
        };
        // Modes that are proven to grow are a verdict; to look for them where nothing shows any costs more than a count.
        let by_products = |own: &Counted| {
            let low = self.ends(0.0).map(|[low, _]| low);
            low.is_some_and(|low| Period::new(self, *outer, low).by_products(own).is_some())
        };
        let is_shown = self.is_unstable(outer, 0.0) || counted.as_ref().is_some_and(by_products);
        if let Some(found) = is_shown.then(|| growing(false)).flatten() {
            return (Holds::Unstable, Some(found));
        }
        let told = self.told_by(outer, 0.0, counted.as_ref());
        (told, (told == Holds::Unstable).then(|| growing(true)).flatten())
    }

    /// Where p θ < π for every fast mode, by the chord.
    fn growing_first(&self, outer: &Outer, counted: Option<&Counted>, are_counted: bool) -> Option<Growing> {
        let [low, high] = self.ends(0.0)?;
        let line = chord(outer, low, high)?;
        let period = Period::new(self, *outer, low);
        let seeds = counted.map_or_else(Vec::new, |own| period.farthest(own).1);
        let (claims, radius) = proven(&period, period.top(seeds)?)?;
        let modes: Vec<GrowingMode> = (claims.values.iter().enumerate())
            .map(|(i, e)| {
                // A rounding of the sum.
                let (mu, radius) = (Complex64::new(-1.0 - e, 0.0), radius + 2.0 * U);
                GrowingMode {
                    mu,
                    radius: Some(radius),
                    growth: Some(rate::about(mu, radius)),
                    shape: longest_one(self.positions(claims.vectors.col_as_slice(i))),
                    quadrature: vec![0.0; self.size()],
                }
            })
            .collect();
        let counts = counted.filter(|_| are_counted);
        let by_chord = || {
            let ([fast, slow], slack) = self.form(outer, line, 0.0);
            self.both.at_most_negative(line[0], &[(fast, &self.fast), (slow, &self.slow)], slack)
        };
        let at_most =
            are_counted.then(|| counts.and_then(|own| own.at_most_above(0.0)).or_else(by_chord)).flatten();
        let fastest = self.fastest(outer, line, &claims, radius, counted);
        let at_least = modes.len().max(counts.map_or(0, |own| own.at_least_above(0.0)));
        Some(Growing { at_least, modes, at_most, fastest })
    }

    /// Where some fast mode has p θ > π: modes are rounded, and the fastest multiplier below −1 is enclosed by counts.
    fn growing_past(
        &self,
        outer: &Outer,
        counted: &Counted,
        [are_counted, is_known]: [bool; 2],
    ) -> Option<Growing> {
        let period = Period::new(self, *outer, self.ends(0.0)?[0]);
        let rate = |e: f64| rate::about(Complex64::new(-1.0 - e, 0.0), 2.0 * U);
        let (about, mut found) = period.farthest(counted);
        found.retain(|(e, z)| {
            let image = period.of(z).excess;
            let turn = Mat::from_fn(2, 2, |a, b| if a == b { e.re } else { [e.im, -e.im][a] });
            let turn = turn.submatrix(0, 0, z.ncols(), z.ncols());
            excess(*e) > LEAST && (image - z * turn).norm_l2() < TOLD * z.norm_l2()
        });
        found.sort_by(|a, b| excess(b.0).total_cmp(&excess(a.0)));
        found.truncate(WANTED);
        let fastest = found.iter().position(|(e, _)| e.im == 0.0);
        let own = fastest.map_or(about, |i| found[i].0.re);
        let is_held = counted.grows_by_resonance_alone(self);
        // No nearer than counts can see.
        let nearest = (counted.sharp(own) / own).max(NEAREST);
        let parts = || std::iter::once(nearest).chain(BESIDE.into_iter().filter(move |part| *part > nearest));
        let beside = |sign: f64| parts().map(move |part| 1.0 + sign * part);
        let farther = |turn: f64| (1..=MOST_TURNS).map(move |k| turn.powi(k));
        // Where nothing is known to grow few are asked for: that there is none costs less.
        let tries = if is_known { usize::MAX } else { MOST_UNKNOWN };
        let least = beside(-1.0).chain(farther(0.2)).map(|by| by * own).take(tries);
        let least = least.into_iter().find(|&e| counted.at_least_above(e) > 0)?;
        let most = beside(1.0).chain(farther(2.0)).map(|by| by * own).filter(|_| is_held);
        let most = most.into_iter().find(|&e| counted.at_most_above(e) == Some(0));
        let bounds = (rate(least).0, most.map_or(f64::INFINITY, |e| rate(e).1));
        let mode = |(i, (e, z)): (usize, &(Complex64, Mat<f64>))| {
            let y = period.of(z).moved;
            let of = |j: usize| {
                if j < y.ncols() { self.positions(y.col_as_slice(j)) } else { vec![0.0; self.size()] }
            };
            let (shape, quadrature) = turned(of(0), of(1));
            let growth = (Some(i) == fastest).then_some(bounds);
            GrowingMode { mu: -1.0 - e, radius: None, growth, shape, quadrature }
        };
        let modes = found.iter().enumerate().map(mode).collect();
        let at_most = (are_counted && is_held).then(|| counted.at_most_above(0.0)).flatten();
        // One has been counted above `least`.
        let at_least = if are_counted { counted.at_least_above(0.0).max(1) } else { 1 };
        Some(Growing { modes, at_least, at_most, fastest: Some(bounds) })
    }

    /// Where F + S > 0 off the rigid motions, so that nothing else grows (section 9).
    fn fastest(
        &self,
        outer: &Outer,
        line: [f64; 2],
        claims: &Ritz,
        radius: f64,
        counted: Option<&Counted>,
    ) -> Option<(f64, f64)> {
        if self.unheld() != Some(0) {
            return None;
        }
        let about = |e: f64| rate::about(Complex64::new(-1.0 - e, 0.0), radius + 2.0 * U);
        let (ends, most) = (self.ends(0.0)?, claims.values[0]);
        let y = claims.vectors.col(0);
        let fast = self.both.times(&self.fast, &Mat::from_fn(self.size(), 1, |i, _| y[i]));
        let along = outer.inner_square * (y.transpose() * fast.col(0)) / y.squared_norm_l2();
        let is_above_all = |e: f64| match counted {
            Some(own) => own.at_most_above(e) == Some(0),
            None => self.is_no_excess_above(outer, line, ends, along, e),
        };
        let (mut open, mut above) = (most, None);
        // No nearer than counts can see.
        let nearest = counted.map_or(0.0, |own| own.sharp(most) / most).max(NEAREST);
        for room in std::iter::once(nearest).chain(ROOMS.into_iter().filter(|room| *room > nearest)) {
            let e = (most + radius) * (1.0 + room);
            if is_above_all(e) {
                above = Some(e);
                break;
            }
            open = e;
        }
        let (_, e) = bisected((open, above?), BETWEEN, |e| Some(!is_above_all(e)));
        Some((about(most).0, rate::about(Complex64::new(-1.0 - e, 0.0), 2.0 * U).1))
    }

    /// Whether all eigenvalues of the excess are below e for sure, by the tangent of 1/V at s = `along`.
    fn is_no_excess_above(
        &self,
        outer: &Outer,
        [offset, slope]: [f64; 2],
        [low, high]: [f64; 2],
        along: f64,
        e: f64,
    ) -> bool {
        let ends = [outer.scaled_down(low), outer.scaled_up(high)];
        let along = along.clamp(ends[0], ends[1]);
        let [value, steep] = inverse_twist(along, outer.inner_steps);
        let (m, reach) = (steep.mid(), (along - ends[0]).max(ends[1] - along));
        // Where the slope is not sharp the line is lower by as much at the ends; then the roundings of what follows.
        let at_zero = value.lo - m * along - steep.radius() * reach * (1.0 + 4.0 * U);
        let (a, b) = (2.0 * e * at_zero, 2.0 * e * m);
        let rounding = 8.0 * U * (offset.abs() + 2.0 * e * (value.lo.abs() + (m * along).abs()))
            + 4.0 * U * (slope.abs() + b.abs()) * ends[0].abs().max(ends[1].abs());
        let line = [offset + a - rounding, slope - b];
        let ([fast, slow], slack) = self.form(outer, line, 0.0);
        self.both.is_definite(line[0], &[(fast, &self.fast), (slow, &self.slow)], slack)
    }
}

impl Period<'_> {
    /// About the largest real excess, and the modes next to a number above it, rounded: where one of these is above that, too, a larger one is tried.
    fn farthest(&self, counted: &Counted) -> (f64, Vec<(Complex64, Mat<f64>)>) {
        let about = self.about(counted);
        let (mut e, mut left) = (ABOVE * about, MOST_TRIES);
        loop {
            let found = counted.modes_near(e);
            let above = found.iter().map(|own| own.0).filter(|own| own.im == 0.0 && own.re > e);
            let (top, is_beyond) = above.fold((e, false), |(top, _), own| (own.re.max(top), true));
            left -= 1;
            if !is_beyond || left == 0 {
                return (about, found);
            }
            e = 2.0 * top;
        }
    }

    /// About the largest real excess.
    fn about(&self, counted: &Counted) -> f64 {
        self.by_products(counted).unwrap_or_else(|| counted.about())
    }

    /// About the largest real excess, by products; `None` where they show none. They are made once.
    fn by_products(&self, counted: &Counted) -> Option<f64> {
        *counted.by_products.get_or_init(|| {
            let (_, form) = arnoldi(self.levels.size(), STEPS, |z| Some(self.of(z).excess))?;
            let eigen = form.eigen().ok()?;
            let real = (0..form.ncols()).map(|i| eigen.S()[i]).filter(|e| e.im == 0.0);
            real.map(|e| e.re).max_by(f64::total_cmp).filter(|e| *e > LEAST)
        })
    }

    /// The largest eigenvalues of the excess and their z, rounded: those above 0 whose residuals are small. `None` where there is none.
    ///
    /// `seeds` are about these: where the largest one is as sharp as it is to be, they are all that is looked at.
    fn top(&self, seeds: Vec<(Complex64, Mat<f64>)>) -> Option<Ritz> {
        let n = self.levels.size();
        let most = SPACE.min(n);
        let mut space = [0; 3].map(|_| Mat::<f64>::zeros(n, most));
        let begin = start(n);
        let mut next = Mat::from_fn(n, 1, |i, _| begin[i]);
        let (mut size, mut round) = (0, 0);
        let mut seeds: Vec<_> = seeds.into_iter().filter(|(e, _)| e.im == 0.0 && e.re > LEAST).collect();
        seeds.sort_by(|a, b| a.0.re.total_cmp(&b.0.re));
        let mut seeds = seeds.into_iter().map(|(_, z)| &z / faer::Scale(z.norm_l2()));
        let mut is_seeded = seeds.len() > 0;
        next = seeds.next_back().unwrap_or(next);
        loop {
            let mut is_used_up = false;
            while size < most {
                let [z, moved, excess] = &mut space;
                orthogonal(&mut next, z, moved, size);
                let image = self.of(&next);
                let square = (next.transpose() * &image.moved)[(0, 0)];
                // Of length 1 before: what is left is rounding.
                is_used_up = !(square > 1e-26 * next.squared_norm_l2() && next.norm_l2() > 1e-13);
                if is_used_up {
                    break;
                }
                let scale = 1.0 / square.sqrt();
                for (to, from) in [(z, &next), (moved, &image.moved), (&mut *excess, &image.excess)] {
                    to.col_as_slice_mut(size)
                        .iter_mut()
                        .zip(from.col_as_slice(0))
                        .for_each(|(to, x)| *to = scale * x);
                }
                size += 1;
                if let Some(seed) = seeds.next_back() {
                    next = seed;
                    continue;
                }
                next = Mat::from_fn(n, 1, |i, _| excess[(i, size - 1)]);
                next /= faer::Scale(next.norm_l2().max(f64::MIN_POSITIVE));
                if is_seeded {
                    break;
                }
            }
            let [z, moved, excess] = &mut space;
            orthogonal(&mut next, z, moved, size);
            let form = moved.subcols(0, size).transpose() * excess.subcols(0, size);
            let form = Mat::from_fn(size, size, |i, j| (form[(i, j)] + form[(j, i)]) / 2.0);
            let eigen = form.self_adjoint_eigen(Side::Lower).ok()?;
            let kept = if is_used_up { size } else { KEPT.min(size) };
            let values: Vec<f64> = (0..kept).map(|i| eigen.S()[size - 1 - i]).collect();
            let turn = Mat::from_fn(size, kept, |i, j| eigen.U()[(i, size - 1 - j)]);
            for own in [&mut *z, moved, excess] {
                let turned = own.subcols(0, size) * &turn;
                own.subcols_mut(0, kept).copy_from(&turned);
            }
            size = kept;
            round += 1;
            let residual = |i: usize| (excess.col(i) - z.col(i) * faer::Scale(values[i])).norm_l2();
            let wanted: Vec<usize> = (0..kept.min(WANTED)).filter(|&i| values[i] > 0.0).collect();
            let is_found =
                !values.is_empty() && residual(0) < FOUND && wanted.iter().all(|&i| residual(i) < FOUND);
            let is_enough = std::mem::take(&mut is_seeded) && residual(0) < FOUND;
            if is_found || is_enough || is_used_up || round == MOST_ROUNDS {
                let most = if is_enough { FOUND } else { TOLD };
                let told: Vec<usize> = wanted.into_iter().filter(|&i| residual(i) < most).collect();
                let vectors = Mat::from_fn(n, told.len(), |i, j| z[(i, told[j])]);
                let values: Vec<f64> = told.into_iter().map(|i| values[i]).collect();
                return (!values.is_empty()).then_some(Ritz { values, vectors });
            }
        }
    }
}

/// How far μ = −1 − e is from what is stable (file `rate`).
fn excess(e: Complex64) -> f64 {
    (e.norm() + (e + 1.0).norm() - 1.0) / 2.0
}

/// Both parts of a complex shape, turned and scaled so that its longest entry is 1.
fn turned(shape: Vec<f64>, quadrature: Vec<f64>) -> (Vec<f64>, Vec<f64>) {
    let all: Vec<Complex64> =
        shape.into_iter().zip(quadrature).map(|(re, im)| Complex64::new(re, im)).collect();
    let longest =
        all.iter().fold(Complex64::new(0.0, 0.0), |most, z| if z.norm() > most.norm() { *z } else { most });
    all.into_iter().map(|z| z / longest).map(|z| (z.re, z.im)).unzip()
}

/// Takes from x what lies along the first columns of z, by the scalar product of V, twice: once leaves too much where little is left.
fn orthogonal(x: &mut Mat<f64>, z: &Mat<f64>, moved: &Mat<f64>, size: usize) {
    for _ in 0..2 {
        let along = moved.subcols(0, size).transpose() * &*x;
        *x -= z.subcols(0, size) * along;
    }
}

/// The claims that are above 0 for sure, their positions V z in place of z, and how far each true eigenvalue may be from its own; `None` without any.
fn proven(period: &Period, found: Ritz) -> Option<(Ritz, f64)> {
    let Ritz { mut values, vectors } = found;
    let (n, k) = (period.levels.size() as f64, values.len());
    let image = period.of(&vectors);
    let (mut residual, mut off) = (0.0, 0.0);
    for (i, (value, &[moved, excess])) in values.iter().zip(&image.errors).enumerate() {
        let (z, own) = (vectors.col(i), image.excess.col(i));
        // Of the product and the difference.
        let rounding = 3.0 * U * (own.norm_l2() + value.abs() * z.norm_l2());
        residual += (1.01 * ((own - z * faer::Scale(*value)).norm_l2() + rounding) + excess).powi(2);
        off += moved.powi(2);
    }
    let residual = (period.size() * residual).sqrt();
    let gram = vectors.transpose() * &image.moved;
    let long = norm::frobenius(&vectors);
    let rounding = 1.01 * (n + 4.0) * U * long * norm::frobenius(&image.moved);
    let defect = norm::frobenius(&(gram - Mat::<f64>::identity(k, k))) + rounding + 1.01 * long * off.sqrt();
    let spread = values[0] - values[k - 1];
    let radius = 1.01 * (2.0 * residual / (1.0 - defect).sqrt() + 1.3 * defect * spread);
    // A defect above a half is no claim: then this is not a number, or the bound does not hold.
    if !(defect < 0.5 && radius.is_finite()) {
        return None;
    }
    values.retain(|e| *e > radius);
    let vectors = image.moved.subcols(0, values.len()).to_owned();
    (!values.is_empty()).then_some((Ritz { values, vectors }, radius))
}

/// Scaled so that the longest entry is 1.
fn longest_one(shape: Vec<f64>) -> Vec<f64> {
    let longest = shape.iter().fold(0.0, |most: f64, x| if x.abs() > most.abs() { *x } else { most });
    shape.into_iter().map(|x| x / longest).collect()
}
