//! The bias of every normal mode of a stable period: by how much its potential energy is off.
//!
//! Where all clocks kick, Q = \[\[X, V\], \[W, Xᵀ\]\] with symmetric V and W. An x with X x = cos φ x and p =
//! −W x/sin φ turn into each other: Q (x, 0) = (x cos φ, −p sin φ), Q (0, p) = (x sin φ, p cos φ). So each
//! normal mode has an ellipse of its own, a (x, 0) + b (0, p) of any a and b with ⟨a²⟩ = ⟨b²⟩ and ⟨ab⟩ = 0.
//! With K the sum of all stiffnesses,
//!
//! ```text
//!     at the kicks:     R = xᵀ K x/(pᵀ M⁻¹ p)
//!     in the drifts:    R = xᵀ K x ⟨ξᵀ M ξ + ηᵀ M η⟩/(xᵀ p)²
//! ```
//!
//! ξ and η are the positions that x and p have become, and ⟨⟩ is the mean, by time, in the middles of all
//! drifts: there a weak friction draws ⟨a²⟩ to kT ⟨ξᵀ M ξ + ηᵀ M η⟩/(xᵀ p)², as noise of variance w M in the
//! momenta adds w (ξᵀ M ξ + ηᵀ M η)/(xᵀ p)² to a² + b². Of one mass this is the bias of
//! [`clocks::propagator::bias`]. All of it is in doubles, without bounds.

use std::f64::consts::PI;

use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, MatRef, Side};

use crate::half::compose::{Program, Row, cost};
use crate::half::period::Stiffness;
use crate::linear::system::System;
use crate::verdict::limits::DENSE;
use clocks::propagator::Bias;
use clocks::schedule::{Clock, Event, Schedule};
use number::{named, to_f64};

/// One normal mode of a stable period.
#[derive(Clone, Debug, PartialEq)]
pub struct BiasedMode {
    /// Its turn over the period as a part of a full one, whole turns left out: 0 to 1/2.
    pub turn: f64,
    /// 2π √(xᵀ M x/xᵀ K x), in the unit of time.
    pub period: f64,
    pub bias: Bias<f64>,
    /// x, and p in units of the tick.
    pub pair: [Vec<f64>; 2],
}

named! {
    /// The reason why no bias is told of a stable system.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum NoBias {
        Edge = "a multiplier is 1 or -1",
        Kind = "it is computed of kicks and drifts of dense symmetric stiffnesses at one place alone",
        Phases = "its clocks do not all kick at the start of a period",
        Cost = "it would take more than some seconds",
        Sum = "the sum of the stiffnesses is not positive on every mode",
        Rounding = "doubles do not tell its modes apart",
    }
}

/// The most products that it may cost: a verdict alone need not wait longer. No budget changes an answer.
const MOST_PRODUCTS: u64 = 2_000_000_000;

/// Eigenvalues of n rows take so many n³ products.
const EIGEN: u64 = 30;

/// Cosines this close are those of one multiplier: doubles would mix their modes.
const ALIKE: f64 = 1e-9;

/// Modes of a lower frequency in a unit of the period are rigid motions.
const RIGID: f64 = 1e-5;

/// Masses, and what each clock kicks with, in doubles and ticks.
struct Motion<'a> {
    schedule: &'a Schedule,
    mass: Vec<Row<f64>>,
    inverse_mass: Vec<Row<f64>>,
    /// F_k: the stiffness times the step.
    kicks: Vec<Stiffness>,
    /// Motions that nothing holds.
    rigid: usize,
}

/// That half a period of this cost may be followed twice, and the modes be found.
fn allow(half_period: u64, n: usize) -> Result<(), NoBias> {
    let eigen = EIGEN.saturating_mul((n as u64).saturating_pow(3)) / DENSE;
    let work = half_period.saturating_mul(2).saturating_add(eigen);
    if work > MOST_PRODUCTS { Err(NoBias::Cost) } else { Ok(()) }
}

/// The modes of a system that is known to be stable.
pub(crate) fn of_system(system: &System) -> Result<Vec<BiasedMode>, NoBias> {
    allow(cost(system), system.size())?;
    let Program { inverse_mass, kicks, .. } = Program::rounded(system);
    let mass = |i: usize| system.mass().row(i).iter().map(|(&j, x)| (j, to_f64(x))).collect();
    let motion = Motion {
        schedule: system.schedule(),
        mass: (0..system.size()).map(mass).collect(),
        inverse_mass,
        kicks: kicks.into_iter().map(|kick| Stiffness::Rows(kick.rows)).collect(),
        rigid: system.rigid_modes().len(),
    };
    motion.modes(to_f64(system.tick()))
}

/// Those of levels of n unit masses; `kicks` are their stiffnesses.
pub(crate) fn of_levels(
    schedule: &Schedule,
    n: usize,
    kicks: Vec<Stiffness>,
) -> Result<Vec<BiasedMode>, NoBias> {
    let entries = |kick: &Stiffness| match kick {
        Stiffness::Whole(_) => (n * n) as u64 / DENSE,
        Stiffness::Rows(rows) => rows.iter().map(|(_, row)| row.len() as u64).sum(),
    };
    let strikes = |step: u64| schedule.period() / step / 2 + 1;
    let each = kicks.iter().zip(schedule.clocks()).map(|(kick, clock)| entries(kick) * strikes(clock.step()));
    allow(each.sum::<u64>().saturating_mul(2 * n as u64), n)?;
    let tick = to_f64(schedule.tick());
    let in_ticks = |(kick, clock): (Stiffness, &Clock)| {
        let factor = tick * tick * clock.step() as f64;
        match kick {
            Stiffness::Whole(whole) => Stiffness::Whole(faer::Scale(factor) * whole),
            Stiffness::Rows(mut rows) => {
                rows.iter_mut().flat_map(|(_, row)| row).for_each(|(_, x)| *x *= factor);
                Stiffness::Rows(rows)
            }
        }
    };
    let kicks = kicks.into_iter().zip(schedule.clocks()).map(in_ticks).collect();
    let mass: Vec<Row<f64>> = (0..n).map(|i| vec![(i, 1.0)]).collect();
    Motion { schedule, inverse_mass: mass.clone(), mass, kicks, rigid: 0 }.modes(tick)
}

/// Positions and momenta, a column each.
#[derive(Clone)]
struct State {
    x: Mat<f64>,
    p: Mat<f64>,
}

/// y += a F x.
fn add<'a>(
    y: &mut Mat<f64>,
    a: f64,
    rows: impl Iterator<Item = (usize, &'a Row<f64>)> + Clone,
    x: &Mat<f64>,
) {
    for k in 0..x.ncols() {
        let (x, y) = (x.col_as_slice(k), y.col_as_slice_mut(k));
        rows.clone().for_each(|(i, row)| y[i] += a * row.iter().map(|&(j, f)| f * x[j]).sum::<f64>());
    }
}

fn all(rows: &[Row<f64>]) -> impl Iterator<Item = (usize, &Row<f64>)> + Clone {
    rows.iter().enumerate()
}

fn product(stiffness: &Stiffness, x: &Mat<f64>) -> Mat<f64> {
    match stiffness {
        Stiffness::Whole(whole) => whole * x,
        Stiffness::Rows(rows) => {
            let mut y = Mat::zeros(x.nrows(), x.ncols());
            add(&mut y, 1.0, rows.iter().map(|(i, row)| (*i, row)), x);
            y
        }
    }
}

/// aₖᵀ bₖ of the columns.
fn dots(a: &Mat<f64>, b: &Mat<f64>) -> Vec<f64> {
    (0..a.ncols()).map(|k| a.col(k).iter().zip(b.col(k).iter()).map(|(x, y)| x * y).sum()).collect()
}

impl Motion<'_> {
    /// Follows half the period; `look` is shown each drift and the positions in its middle.
    fn follow(&self, state: &mut State, mut look: impl FnMut(f64, &Mat<f64>)) {
        for event in self.schedule.half_period() {
            if event.drift > 0 {
                // T/2 is in the middle of a drift that no kick has followed.
                let is_last = event.clocks().next().is_none();
                let (before, after) = if is_last { (1.0, 0.0) } else { (0.5, 0.5) };
                let ticks = event.drift as f64;
                add(&mut state.x, before * ticks, all(&self.inverse_mass), &state.p);
                look(ticks, &state.x);
                if !is_last {
                    add(&mut state.x, after * ticks, all(&self.inverse_mass), &state.p);
                }
            }
            self.kick(&event, state);
        }
    }

    fn kick(&self, event: &Event, state: &mut State) {
        for clock in event.clocks() {
            let weight = -event.weight.share();
            match &self.kicks[clock] {
                Stiffness::Rows(rows) => {
                    add(&mut state.p, weight, rows.iter().map(|(i, row)| (*i, row)), &state.x)
                }
                whole => state.p += faer::Scale(weight) * product(whole, &state.x),
            }
        }
    }

    /// Σ K x, in ticks.
    fn stiffness(&self, x: &Mat<f64>) -> Mat<f64> {
        let each = self.kicks.iter().zip(self.schedule.clocks());
        each.fold(Mat::zeros(x.nrows(), x.ncols()), |sum, (kick, clock)| {
            sum + faer::Scale((clock.step() as f64).recip()) * product(kick, x)
        })
    }

    fn weighted(&self, rows: &[Row<f64>], x: &Mat<f64>) -> Mat<f64> {
        let mut y = Mat::zeros(x.nrows(), x.ncols());
        add(&mut y, 1.0, all(rows), x);
        y
    }

    /// The modes, the fastest first; a tick takes `tick`.
    fn modes(&self, tick: f64) -> Result<Vec<BiasedMode>, NoBias> {
        if self.schedule.clocks().iter().any(|clock| clock.offset() > 0) {
            return Err(NoBias::Phases);
        }
        let full = self.full_period();
        let x = full.vectors().ok_or(NoBias::Rounding)?;
        let x = self.without_rigid(x)?;
        let x = self.apart(&full, x).ok_or(NoBias::Rounding)?;
        let momenta = full.turned_into(&x);
        let (cosines, sines) = full.angles(&x, &momenta);
        if sines.iter().any(|sine| !sine.is_normal()) {
            return Err(NoBias::Rounding);
        }
        let p = Mat::from_fn(x.nrows(), x.ncols(), |i, k| momenta[(i, k)] / sines[k]);
        let potential = dots(&x, &self.stiffness(&x));
        if potential.iter().any(|energy| *energy <= 0.0) {
            return Err(NoBias::Sum);
        }
        let (inertia, action) = (dots(&x, &self.weighted(&self.mass, &x)), dots(&x, &p));
        let kinetic = dots(&p, &self.weighted(&self.inverse_mass, &p));
        let spread = self.spread(&x, &p);
        let column = |matrix: &Mat<f64>, k: usize| matrix.col(k).iter().copied().collect::<Vec<f64>>();
        let mode = |k: usize| BiasedMode {
            turn: sines[k].atan2(cosines[k]) / (2.0 * PI),
            period: 2.0 * PI * tick * (inertia[k] / potential[k]).sqrt(),
            bias: Bias {
                at_kicks: potential[k] / kinetic[k],
                in_drifts: potential[k] * spread[k] / (action[k] * action[k]),
            },
            pair: [column(&x, k), column(&p, k)],
        };
        let mut modes: Vec<BiasedMode> = (0..x.ncols()).map(mode).collect();
        modes.sort_by(|a, b| a.period.total_cmp(&b.period));
        Ok(modes)
    }

    fn full_period(&self) -> Full {
        let n = self.mass.len();
        let unit = |first: usize| Mat::from_fn(n, 2 * n, |i, k| f64::from(u8::from(k == first + i)));
        let mut half = State { x: unit(0), p: unit(n) };
        self.follow(&mut half, |_, _| ());
        let (a, b) = (half.x.subcols(0, n), half.x.subcols(n, n));
        let (c, d) = (half.p.subcols(0, n), half.p.subcols(n, n));
        let twice = |product: Mat<f64>| faer::Scale(2.0) * product;
        let symmetric = |m: Mat<f64>| Mat::from_fn(n, n, |i, j| m[(i, j)] + m[(j, i)]);
        Full {
            x: Mat::<f64>::identity(n, n) + twice(b.transpose() * c),
            v: symmetric(d.transpose() * b),
            w: symmetric(a.transpose() * c),
        }
    }

    /// The vectors of the modes that something holds.
    fn without_rigid(&self, x: Mat<f64>) -> Result<Mat<f64>, NoBias> {
        if self.rigid == 0 {
            return Ok(x);
        }
        let period = self.schedule.period() as f64;
        let (energy, inertia) = (dots(&x, &self.stiffness(&x)), dots(&x, &self.weighted(&self.mass, &x)));
        let is_held = |k: &usize| energy[*k].abs().sqrt() * period > RIGID * inertia[*k].sqrt();
        let held: Vec<usize> = (0..x.ncols()).filter(is_held).collect();
        if held.len() + self.rigid != x.ncols() {
            return Err(NoBias::Rounding);
        }
        Ok(Mat::from_fn(x.nrows(), held.len(), |i, k| x[(i, held[k])]))
    }

    /// Of modes that turn alike those of extreme R at the kicks; `None` where doubles do not part them.
    fn apart(&self, full: &Full, mut x: Mat<f64>) -> Option<Mat<f64>> {
        let (cosines, _) = full.angles(&x, &full.turned_into(&x));
        let mut order: Vec<usize> = (0..x.ncols()).collect();
        order.sort_by(|&a, &b| cosines[a].total_cmp(&cosines[b]));
        for alike in order.chunk_by(|&a, &b| cosines[b] - cosines[a] <= ALIKE).filter(|alike| alike.len() > 1)
        {
            let space = Mat::from_fn(x.nrows(), alike.len(), |i, k| x[(i, alike[k])]);
            let momenta = full.turned_into(&space);
            let kinetic = momenta.transpose() * self.weighted(&self.inverse_mass, &momenta);
            let potential = space.transpose() * self.stiffness(&space);
            let parted = space * pencil(&potential, &kinetic)?;
            for (k, &to) in alike.iter().enumerate() {
                (0..x.nrows()).for_each(|i| x[(i, to)] = parted[(i, k)]);
            }
        }
        Some(x)
    }

    /// ⟨ξᵀ M ξ + ηᵀ M η⟩ of each pair.
    fn spread(&self, x: &Mat<f64>, p: &Mat<f64>) -> Vec<f64> {
        let (n, m) = (x.nrows(), x.ncols());
        let either = |first: &Mat<f64>, i: usize, k: usize| if k < m { first[(i, k)] } else { 0.0 };
        let mut state = State {
            x: Mat::from_fn(n, 2 * m, |i, k| either(x, i, k)),
            p: Mat::from_fn(n, 2 * m, |i, k| if k < m { 0.0 } else { p[(i, k - m)] }),
        };
        let mut sums = vec![0.0; 2 * m];
        self.follow(&mut state, |ticks, middle| {
            let squares = dots(middle, &self.weighted(&self.mass, middle));
            sums.iter_mut().zip(squares).for_each(|(sum, square)| *sum += ticks * square);
        });
        let half = self.schedule.period() as f64 / 2.0;
        (0..m).map(|k| (sums[k] + sums[m + k]) / half).collect()
    }
}

/// The blocks X, V, W of the full period.
struct Full {
    x: Mat<f64>,
    v: Mat<f64>,
    w: Mat<f64>,
}

impl Full {
    /// Eigenvectors of X, a column each: V = L Lᵀ makes L⁻¹ X L symmetric; where V is not definite, as beyond
    /// half a turn, they are those of any matrix.
    fn vectors(&self) -> Option<Mat<f64>> {
        let n = self.x.nrows();
        if (0..n).any(|i| (0..n).any(|j| !self.x[(i, j)].is_finite())) {
            return None;
        }
        if let Ok(factor) = self.v.llt(Side::Lower) {
            let lower = factor.L().to_owned();
            let turned = below(&lower, (&self.x * &lower).as_ref());
            let eigen = turned.self_adjoint_eigen(Side::Lower).ok()?;
            return Some(lower * eigen.U());
        }
        let eigen = self.x.eigen().ok()?;
        // Two that are alike may come as a pair, whose parts span what they do.
        let part = |i: usize, k: usize| {
            let z = eigen.U()[(i, k)];
            if eigen.S()[k].im < 0.0 { z.im } else { z.re }
        };
        Some(Mat::from_fn(n, n, part))
    }

    /// −W x = p sin φ.
    fn turned_into(&self, x: &Mat<f64>) -> Mat<f64> {
        faer::Scale(-1.0) * (&self.w * x)
    }

    /// cos φ and sin φ: sin² φ = yᵀ V y/(xᵀ y) with y = p sin φ, which small angles do not cancel in.
    fn angles(&self, x: &Mat<f64>, momenta: &Mat<f64>) -> (Vec<f64>, Vec<f64>) {
        let cosines = dots(x, &(&self.x * x)).into_iter().zip(dots(x, x)).map(|(a, b)| a / b);
        let squares =
            dots(momenta, &(&self.v * momenta)).into_iter().zip(dots(x, momenta)).map(|(a, b)| a / b);
        (cosines.collect(), squares.map(f64::sqrt).collect())
    }
}

/// L⁻¹ times a matrix.
fn below(lower: &Mat<f64>, matrix: MatRef<f64>) -> Mat<f64> {
    let mut solved = matrix.to_owned();
    solve_lower_triangular_in_place(lower.as_ref(), solved.as_mut(), faer::Par::Seq);
    solved
}

/// The vectors of A z = λ B z, B definite, a column each.
fn pencil(a: &Mat<f64>, b: &Mat<f64>) -> Option<Mat<f64>> {
    let lower = b.llt(Side::Lower).ok()?.L().to_owned();
    let half = below(&lower, a.as_ref());
    let symmetric = below(&lower, half.transpose());
    let eigen = symmetric.self_adjoint_eigen(Side::Lower).ok()?;
    let inverse = below(&lower, Mat::<f64>::identity(a.nrows(), a.nrows()).as_ref());
    Some(inverse.transpose() * eigen.U())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::sparse::Symmetric;
    use crate::linear::system::Potential;
    use clocks::propagator::{TwoClocks, bias};
    use number::{Rational, ratio};

    fn symmetric(rows: &[&[i64]], factor: &Rational) -> Symmetric {
        let mut sum = Symmetric::zero(rows.len());
        for (i, row) in rows.iter().enumerate() {
            (0..=i).for_each(|j| sum.add(i, j, &(ratio(row[j], 1) * factor)));
        }
        sum
    }

    fn system(masses: &[i64], potentials: &[(Rational, Symmetric)]) -> System {
        let masses: Vec<Rational> = masses.iter().map(|&m| ratio(m, 1)).collect();
        let potential =
            |(step, stiffness): &(Rational, Symmetric)| Potential::new(stiffness.clone(), step.clone());
        System::new(Symmetric::diagonal(&masses), potentials.iter().map(potential).collect()).unwrap()
    }

    fn modes(system: &System) -> Vec<BiasedMode> {
        of_system(system).unwrap()
    }

    /// Some roundings of numbers near 1, of matrices whose condition is below 100.
    const ROUNDED: f64 = 1e-12;

    fn is_near(x: f64, y: f64) -> bool {
        (x / y - 1.0).abs() < ROUNDED
    }

    #[test]
    fn coupled_modes_have_the_bias_of_exact_fractions() {
        // The multipliers of this one are roots of rational numbers, cos φ = 4/27 and −32/81: all that R is
        // made of are fractions, by the full period in their arithmetic.
        let unit = ratio(1, 1);
        let fast = symmetric(&[&[1, -2], &[-2, 28]], &unit);
        let slow = symmetric(&[&[3, 2], &[2, 4]], &unit);
        let found = modes(&system(&[1, 4], &[(ratio(1, 3), fast), (ratio(2, 3), slow)]));
        let exact = [
            ((-32.0f64 / 81.0).acos(), ratio(8748, 5537), ratio(67554, 60907)),
            ((4.0f64 / 27.0).acos(), ratio(2232, 1403), ratio(292, 253)),
        ];
        assert_eq!(found.len(), exact.len());
        for (mode, (angle, at_kicks, in_drifts)) in found.iter().zip(exact) {
            assert!(is_near(mode.turn * 2.0 * PI, angle), "{mode:?}");
            assert!(is_near(mode.bias.at_kicks, to_f64(&at_kicks)), "{mode:?}");
            assert!(is_near(mode.bias.in_drifts, to_f64(&in_drifts)), "{mode:?}");
        }
        // x = (1, 0) to the root of the mass: ω² = 4 of the slower one.
        assert!(is_near(found[1].period, PI), "{found:?}");
    }

    #[test]
    fn oscillators_that_nothing_couples_have_the_bias_that_each_has_alone() {
        // 3:2, steps 2 and 3: the third is beyond half a turn, so V is not definite.
        let pairs = [(1, 10), (1, 25), (1, 4), (1, 10)].map(|(n, d)| (ratio(n, d), ratio(1, 5 * d)));
        let diagonal = |which: fn(&(Rational, Rational)) -> &Rational| {
            Symmetric::diagonal(&pairs.iter().map(|pair| which(pair).clone()).collect::<Vec<_>>())
        };
        let potentials = [(ratio(2, 1), diagonal(|pair| &pair.0)), (ratio(3, 1), diagonal(|pair| &pair.1))];
        let found = modes(&system(&[1; 4], &potentials));
        let mut alone: Vec<(f64, [f64; 2])> = pairs
            .iter()
            .map(|(fast, slow)| {
                let strengths = [fast * ratio(4, 1), slow * ratio(6, 1)];
                let [fast_kick, slow_kick] = strengths;
                let clocks = TwoClocks::new("3/2".parse().unwrap(), fast_kick, slow_kick);
                let bias = bias(&clocks).unwrap();
                let period = 2.0 * PI / to_f64(&(fast + slow)).sqrt();
                (period, [to_f64(&bias.at_kicks), to_f64(&bias.in_drifts)])
            })
            .collect();
        alone.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert_eq!(found.len(), alone.len());
        for (mode, (period, [at_kicks, in_drifts])) in found.iter().zip(alone) {
            assert!(is_near(mode.period, period), "{mode:?} {period}");
            assert!(is_near(mode.bias.at_kicks, at_kicks), "{mode:?} {at_kicks}");
            assert!(is_near(mode.bias.in_drifts, in_drifts), "{mode:?} {in_drifts}");
        }
    }

    #[test]
    fn verlet_has_the_known_bias_beside_a_rigid_motion() {
        // Three masses in a row: ω² = 1 and 3.
        let chain = symmetric(&[&[1, -1, 0], &[-1, 2, -1], &[0, -1, 1]], &ratio(1, 1));
        let found = modes(&system(&[1; 3], &[(ratio(1, 1), chain)]));
        let at_kicks = found.iter().map(|mode| mode.bias.at_kicks);
        assert!(at_kicks.zip([4.0, 4.0 / 3.0]).all(|(found, known)| is_near(found, known)), "{found:?}");
        assert!(found.iter().all(|mode| is_near(mode.bias.in_drifts, 1.0)), "{found:?}");
    }

    #[test]
    fn where_there_is_none_the_reason_is_told() {
        let of = |system: &System| of_system(system).unwrap_err();
        let (stiff, soft) = (symmetric(&[&[1]], &ratio(1, 1)), symmetric(&[&[-11]], &ratio(1, 10)));
        let one = |step, stiffness: &Symmetric| (step, stiffness.clone());
        assert_eq!(allow(MOST_PRODUCTS / 2 + 1, 1), Err(NoBias::Cost));
        let off = Potential { stiffness: stiff.clone(), step: ratio(1, 1), phase: ratio(1, 2) };
        let late = System::new(Symmetric::diagonal(&[ratio(1, 1)]), vec![off]).unwrap();
        assert_eq!(of(&late), NoBias::Phases);
        // A saddle that the steps keep in place: stable, and no mode of it has a temperature.
        let held = system(&[1], &[one(ratio(9, 10), &stiff), one(ratio(9, 5), &soft)]);
        assert_eq!(of(&held), NoBias::Sum);
    }
}
