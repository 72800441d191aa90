//! How many modes grow at any outer step, where the fast stiffness falls into small blocks, as that of molecules which no bond joins does.
//!
//! Every function of F is then as sparse as its blocks. With V = U_(p−1)(x), C = T_p(x), x = 1 − h² F/2 and M = (p/2) h² S, a multiplier with the excess e,
//! μ = −1 − e, is where a pencil of sparse matrices is singular (proofs/REGION.md, section 9):
//!
//! ```text
//!     L(e) = V (C + 1 + 2 e) − V M V:       at least |neg L(e) − neg V| modes have an excess above e;
//!                                           just as many where V > 0, or where L is positive definite at some −1 < e < 0.
//! ```
//!
//! In the latter case all e are real, those with V < 0 above it and the others below. So it goes beyond a resonance with half a turn of bonds:
//! once all of these have passed it, a step is stable again, and four factorizations prove it.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use faer::{Mat, Side};
use num_complex::Complex64;

use super::blocks::Blocks;
use super::krylov::arnoldi;
use super::period::Period;
use super::region::SparseLevels;
use crate::number::U;
use crate::parallel::map;
use crate::system::half::norm;
use crate::system::levels::kernel::{Outer, STEP_ERROR};
use crate::system::verdict::measured::Holds;

/// The pencil at an outer step as Xᵀ L(e) X, which has as many negative eigenvalues for every regular X. Here X has the modes of each block, each over
/// √|V| where that is not small, so that no entry is large beside what L(e) moves by with e.
pub(super) struct Counted<'a> {
    blocks: &'a Blocks,
    /// Xᵀ V (C + 1) X, 2 Xᵀ V X and (V X)ᵀ S V X,
    terms: [Vec<f64>; 3],
    /// (p/2) h²,
    kick: f64,
    /// and how far Xᵀ L(e) X may be from theirs: the first and |e| times the second (2-norm).
    slack: [f64; 2],
    /// Negative eigenvalues of V: no fewer and no more.
    negative: [usize; 2],
    /// Rigid motions, along which L(e) = −2 (1 + e) V.
    rigid: usize,
    /// Whether all multipliers are real or on the circle for sure: an L(e) > 0 parts those with V < 0 from those with V > 0.
    is_parted: OnceLock<bool>,
    /// An e in (−1, 0) for that.
    gap: Option<f64>,
    known: Mutex<Known>,
    /// X of each block,
    turned: Vec<Mat<f64>>,
    /// and the largest e of a mode, as if none were joined to another, rounded.
    top: f64,
    /// The largest real e, estimated by products with the stiffnesses (file `growing`).
    pub by_products: OnceLock<Option<f64>>,
}

impl SparseLevels {
    /// The pencil at an outer step, for all stiffnesses within `epsilon` times their norms; `None` where F does not fall into small blocks, or an eigenvalue
    /// of V is too near to 0.
    ///
    /// Cost: p products of every block, two of every pair that S joins.
    pub(super) fn counted(&self, outer: &Outer, epsilon: f64) -> Option<Counted<'_>> {
        let blocks = self.blocks()?;
        let [low, high] = self.ends(epsilon)?;
        // Else θ is no angle, and |U_k| may be any.
        if outer.scaled_up(high) >= 4.0 {
            return None;
        }
        Counted::new(self, blocks, &Period::new(self, *outer, low), epsilon)
    }

    /// The verdict past the first region's line for all stiffnesses within `epsilon` times their norms, by one vector or by a count of these.
    pub(super) fn told_by(&self, outer: &Outer, epsilon: f64, counted: Option<&Counted>) -> Holds {
        if self.is_unstable(outer, epsilon) || counted.is_some_and(|own| own.at_least_above(0.0) > 0) {
            return Holds::Unstable;
        }
        // Where p θ < π, F + S > 0 is asked for of the matrices given alone; the first region's line has been asked there.
        let is_stable = counted
            .filter(|own| epsilon == 0.0 || !own.is_first())
            .is_some_and(|own| own.at_most_above(0.0) == Some(0) && own.grows_by_resonance_alone(self));
        if is_stable { Holds::Stable } else { Holds::NotTold }
    }

    /// F and S in blocks, as they are asked for first.
    fn blocks(&self) -> Option<&Blocks> {
        let found = || Blocks::new([&self.alone, &self.both], [&self.fast_alone, &self.slow]).map(Arc::new);
        self.blocks.get_or_init(found).as_deref()
    }

    /// How far F and S are from themselves without what they do along rigid motions: P K P − K for the projection P on the rest, ‖K R‖ twice and
    /// Rᵀ K R once.
    fn leaks(&self) -> [f64; 2] {
        [(&self.fast, self.sizes[0]), (&self.slow, self.sizes[1])].map(|(own, size)| {
            let terms = self.both.size_of(own).1 as f64;
            let rounding = 2.0 * (terms + 2.0) * U * size * norm::frobenius(&self.rigid);
            3.1 * (norm::frobenius(&self.both.times(own, &self.rigid)) + rounding)
        })
    }
}

/// Of a block: X, V X, (C + 1) X, the norms of V's own recursion, and where its modes are.
struct Turned {
    /// X; V X; (C + 1) X.
    own: [Mat<f64>; 3],
    /// The Frobenius norms of all U_k up to U_p, and of C + 1,
    sizes: Vec<f64>,
    even: f64,
    /// and no less than the 2-norm of X.
    stretch: f64,
    /// The least e of its modes with V < 0, the largest of those with V > 0 and of all, as if none were joined to another, rounded.
    ends: (f64, f64),
    top: f64,
}

/// What was counted, by its sign and e.
type Known = BTreeMap<[u64; 2], Option<usize>>;

/// |V| from which on a mode is scaled by it.
const SMALL: f64 = 0.04;

impl Turned {
    /// `slow` is S on the block. `None` where it has no eigenbasis in doubles.
    fn new(fast: &Mat<f64>, slow: &Mat<f64>, outer: &Outer) -> Option<Turned> {
        let (m, p) = (fast.nrows(), outer.inner_steps);
        let (mut before, mut now) = (Mat::<f64>::zeros(m, m), Mat::<f64>::identity(m, m));
        let mut sizes = vec![norm::frobenius(&now)];
        for k in 1..=p {
            let pulled = fast * &now;
            let next = Mat::from_fn(m, m, |i, j| {
                2.0 * now[(i, j)] - outer.inner_square * pulled[(i, j)] - before[(i, j)]
            });
            sizes.push(norm::frobenius(&next));
            if k < p {
                (before, now) = (now, next);
            } else {
                before = (next - before) / faer::Scale(2.0);
            }
        }
        let turned = before + Mat::<f64>::identity(m, m);
        let eigen = fast.self_adjoint_eigen(Side::Lower).ok()?;
        let basis = eigen.U().to_owned();
        let defect = norm::frobenius(&(basis.transpose() * &basis - Mat::<f64>::identity(m, m)));
        // Then it is regular, whatever else the decomposition is off by.
        if defect.is_nan() || defect >= 0.1 {
            return None;
        }
        let [twists, angles, pulls] = [&now, &turned, slow]
            .map(|own| (basis.transpose() * own * &basis).diagonal().column_vector().to_owned());
        let scales: Vec<f64> = (0..m).map(|i| 1.0 / twists[i].abs().max(SMALL).sqrt()).collect();
        let e = |i: usize| (outer.half_kick() * twists[i] * pulls[i] - angles[i]) / 2.0;
        let (ends, top) = (0..m).fold((NOWHERE, 0.0), |((least, most), top), i| {
            let ends = if twists[i] < 0.0 { (e(i).min(least), most) } else { (least, e(i).max(most)) };
            (ends, e(i).max(top))
        });
        let x = Mat::from_fn(m, m, |i, j| basis[(i, j)] * scales[j]);
        let stretch = 1.2 * scales.iter().fold(0.0, |most: f64, own| most.max(*own));
        let even = norm::frobenius(&turned);
        let own = [x.clone(), now * &x, turned * x];
        Some(Turned { own, sizes, even, stretch, ends, top })
    }
}

/// Dimensions of a Krylov space of an inverse, and how many of its modes are looked at.
const SPACE: usize = 64;
const NEAREST: usize = 24;

/// An excess below it is rounding.
pub(super) const LEAST: f64 = 1e-9;

/// Where the largest excess is sought, where nothing shows it.
const ANYWHERE: f64 = 1e-4;

/// Of no mode.
const NOWHERE: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);

impl<'a> Counted<'a> {
    fn new(levels: &SparseLevels, blocks: &'a Blocks, period: &Period, epsilon: f64) -> Option<Counted<'a>> {
        let (outer, leaks) = (&period.outer, levels.leaks());
        let errors = [0, 1].map(|k| levels.errors[k] + epsilon * levels.sizes[k] + leaks[k]);
        let diagonal = blocks.slow.iter().filter(|([k, l], _)| k == l);
        let both: Vec<_> = blocks.fast.iter().zip(diagonal.map(|(_, own)| own)).collect();
        let all = map(&both, |(fast, slow)| Turned::new(fast, slow, outer))
            .into_iter()
            .collect::<Option<Vec<_>>>()?;
        let most = |of: &dyn Fn(&Turned) -> f64| all.iter().fold(0.0, |most: f64, own| most.max(of(own)));
        let (p, m) = (outer.inner_steps as usize, blocks.rows.iter().map(Vec::len).max()? as f64);
        let sizes: Vec<f64> = (0..=p).map(|k| most(&|own| own.sizes[k])).collect();
        let fast = blocks.fast.iter().fold(0.0, |size: f64, own| size.max(norm::frobenius(own)));
        // U_k is off by Σ U_(k−1−i) f_i (file `period`): h² and F, a product of m terms, three sums; what is subtracted.
        let h2 = outer.inner_square;
        let known = h2 * errors[0];
        let local = 1.02 * (known + (2.0 * STEP_ERROR + (m + 4.0) * U) * h2 * fast) + 4.1 * U;
        let (mut each, mut sum, mut off) = (0.0, 0.0, vec![0.0]);
        for k in 0..p {
            each += local * sizes[k] + 2.1 * U * k.checked_sub(1).map_or(0.0, |k| sizes[k]);
            sum += each;
            off.push(period.above * sum);
        }
        let (old, last) = p.checked_sub(2).map_or((0.0, 0.0), |k| (off[k], sizes[k]));
        let (v, v_off) = (sizes[p - 1], off[p - 1]);
        // C, and 1 on its diagonal.
        let (c, c_off) = (most(&|own| own.even), (off[p] + old) / 2.0 + 2.0 * U * (sizes[p] + last + m));
        let [x, vx, cx] = [0, 1, 2].map(|k| most(&|own| norm::frobenius(&own.own[k])));
        let stretch = most(&|own| own.stretch);
        let product = (m + 4.0) * U;
        let [vx_off, cx_off] = [(v, v_off), (c, c_off)].map(|(size, off)| off * stretch + product * size * x);
        let first_off = vx_off * (cx + cx_off) + vx * cx_off + product * vx * cx;
        let twice_off = 2.0 * (vx_off * stretch + product * vx * x);
        // |V X| |S| |V X| entry by entry, sums of two blocks' terms; V X's own error twice; S's.
        let slow = levels.sizes[1];
        let kicked_off = slow * (2.0 * vx * vx_off + vx_off * vx_off)
            + (vx + vx_off).powi(2) * errors[1]
            + 2.0 * product * vx * vx * slow;
        let mut terms = [0; 3].map(|_| vec![0.0; blocks.pattern.entries()]);
        let mut alone = vec![0.0; blocks.alone.entries()];
        for (rows, Turned { own: [x, vx, cx], .. }) in blocks.rows.iter().zip(&all) {
            let [first, twice] = [vx.transpose() * cx, vx.transpose() * x];
            for (a, b) in (0..rows.len()).flat_map(|a| (0..=a).map(move |b| (a, b))) {
                let at = [rows[a], rows[b]];
                blocks.pattern.add(&mut terms[0], at, (first[(a, b)] + first[(b, a)]) / 2.0);
                blocks.pattern.add(&mut terms[1], at, twice[(a, b)] + twice[(b, a)]);
                blocks.alone.add(&mut alone, at, twice[(a, b)] + twice[(b, a)]);
            }
        }
        let kicked = map(&blocks.slow, |([k, l], own)| all[*k].own[1].transpose() * (own * &all[*l].own[1]));
        for (([k, l], _), own) in blocks.slow.iter().zip(&kicked) {
            for (a, b) in (0..own.nrows()).flat_map(|a| (0..own.ncols()).map(move |b| (a, b))) {
                if k != l || a >= b {
                    blocks.pattern.add(&mut terms[2], [blocks.rows[*k][a], blocks.rows[*l][b]], own[(a, b)]);
                }
            }
        }
        let kick = outer.half_kick();
        let [first, twice, kicks] = terms.each_ref().map(|own| blocks.pattern.size_of(own).0);
        let slack = [
            1.02 * (first_off
                + kick * (kicked_off + 2.0 * STEP_ERROR * kicks)
                + 6.0 * U * (first + kick * kicks)),
            1.02 * (twice_off + 6.0 * U * twice),
        ];
        let signs = [(1.0, &alone[..])];
        let beside = |sign: f64| Some(blocks.alone.negative_beside(sign, 0.0, &signs, [slack[1], 0.0])?.0);
        let negative = [beside(-1.0)?, beside(1.0)?];
        let (hi, lo) = all.iter().fold(NOWHERE, |(a, b), own| (a.min(own.ends.0), b.max(own.ends.1)));
        // Between −1 and 0 alone does it say that what is above 0 has V < 0, and what is below −1 has V > 0.
        let (lo, hi) = (lo.max(-1.0), hi.min(0.0));
        let gap = (negative[0] == negative[1] && lo < hi).then_some(lo + (hi - lo) / 2.0);
        let (rigid, is_parted) = (levels.rigid.ncols(), OnceLock::new());
        let top = most(&|own| own.top);
        let turned = all.into_iter().map(|Turned { own: [x, ..], .. }| x).collect();
        Some(Counted {
            blocks,
            terms,
            kick,
            slack,
            negative,
            rigid,
            is_parted,
            gap,
            known: Mutex::default(),
            turned,
            top,
            by_products: OnceLock::new(),
        })
    }

    /// Whether p θ < π for every fast mode.
    fn is_first(&self) -> bool {
        self.negative[1] == 0
    }

    /// Xᵀ L(e) X, as its terms, and how far from these it is.
    fn pencil(&self, e: f64) -> ([(f64, &[f64]); 3], f64) {
        let [first, twice, kicked] = &self.terms;
        ([(1.0, first), (e, twice), (-self.kick, kicked)], self.slack[0] + e.abs() * self.slack[1])
    }

    /// No fewer than the negative eigenvalues of L(e).
    fn at_most_negative(&self, e: f64) -> Option<usize> {
        self.negative_beside(1.0, e)
    }

    /// And no more.
    fn at_least_negative(&self, e: f64) -> Option<usize> {
        self.negative_beside(-1.0, e)
    }

    /// How far from e a mode is to be for a count to see on which side it is, as a rule.
    pub fn sharp(&self, e: f64) -> f64 {
        self.blocks.pattern.usually_off(&self.pencil(e).0)
    }

    /// Each asked for once.
    fn negative_beside(&self, sign: f64, e: f64) -> Option<usize> {
        let key = [sign, e].map(f64::to_bits);
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(own) = known().get(&key) {
            return *own;
        }
        let (terms, slack) = self.pencil(e);
        let expected = self.blocks.pattern.usually_off(&terms);
        let found = self.blocks.pattern.negative_beside(sign, 0.0, &terms, [slack, expected]);
        let found = found.map(|own| own.0);
        known().insert(key, found);
        found
    }

    fn is_parted(&self) -> bool {
        let is_definite = |e: f64| {
            let (terms, slack) = self.pencil(e);
            self.blocks.pattern.is_definite(0.0, &terms, slack)
        };
        *self.is_parted.get_or_init(|| self.gap.is_some_and(is_definite))
    }

    /// So many modes have a multiplier −λ > 1 with an excess above e ≥ 0 for sure, and more may: one factorization, or two where multipliers with both signs
    /// of V are next to each other.
    pub fn at_least_above(&self, e: f64) -> usize {
        // Those with V < 0 alone are above 0 then.
        if self.negative[0] > 0 && self.is_parted() {
            return self.at_most_negative(e).map_or(0, |own| self.negative[0].saturating_sub(own));
        }
        let more = self.at_least_negative(e).map_or(0, |own| own.saturating_sub(self.negative[1]));
        if more > 0 || self.negative[0] == 0 {
            return more;
        }
        self.at_most_negative(e).map_or(0, |own| self.negative[0].saturating_sub(own))
    }

    /// No more modes than so many have an excess above e ≥ 0; `None` where that is not told, as where multipliers with both signs of V are next to each other.
    pub fn at_most_above(&self, e: f64) -> Option<usize> {
        if self.is_first() {
            return self.at_most_negative(e);
        }
        let fewest = || self.at_least_negative(e).map(|own| self.negative[0].saturating_sub(own));
        self.is_parted().then(fewest).flatten()
    }

    /// Whether multipliers below −1 are all that can be off the circle: where F + S > 0 if p θ < π; else by a count at 1.
    pub fn grows_by_resonance_alone(&self, levels: &SparseLevels) -> bool {
        if self.is_first() {
            return levels.unheld() == Some(0);
        }
        let held = || {
            self.at_least_negative(-1.0)
                .is_some_and(|own| own + self.rigid + self.negative[1] >= levels.size())
        };
        self.is_parted() && held()
    }

    /// The largest e as if no mode were joined to another, rounded, or a small one.
    pub fn about(&self) -> f64 {
        if self.top > LEAST { self.top } else { ANYWHERE }
    }

    /// The modes whose e is nearest to one that is given, and their z (of a pair of complex ones the first, real and imaginary part), all rounded; none
    /// where memory runs out. L(e₀) z = (e₀ − e) 2 V z: a Krylov space of the inverse.
    pub fn modes_near(&self, e: f64) -> Vec<(Complex64, Mat<f64>)> {
        self.inverted_modes(e).unwrap_or_default()
    }

    fn inverted_modes(&self, e: f64) -> Option<Vec<(Complex64, Mat<f64>)>> {
        let pattern = &self.blocks.pattern;
        let own = pattern.factored_signed(&self.pencil(e).0)?;
        let n = pattern.size();
        let (basis, form) = arnoldi(n, SPACE, |x| own.solve(pattern.times(&self.terms[1], x)))?;
        let (size, eigen) = (basis.ncols(), form.eigen().ok()?);
        let mut order: Vec<usize> = (0..size).filter(|&i| eigen.S()[i].im >= 0.0).collect();
        order.sort_by(|&i, &j| eigen.S()[j].norm().total_cmp(&eigen.S()[i].norm()));
        let mode = |&i: &usize| {
            let theta = eigen.S()[i];
            let columns = if theta.im == 0.0 { 1 } else { 2 };
            let part = |k: usize, c: usize| if c == 0 { eigen.U()[(k, i)].re } else { eigen.U()[(k, i)].im };
            let found = &basis * Mat::from_fn(size, columns, part);
            let mut z = Mat::<f64>::zeros(n, columns);
            for (rows, x) in self.blocks.rows.iter().zip(&self.turned) {
                let turned = x * Mat::from_fn(rows.len(), columns, |a, c| found[(rows[a], c)]);
                rows.iter()
                    .enumerate()
                    .for_each(|(a, &i)| (0..columns).for_each(|c| z[(i, c)] = turned[(a, c)]));
            }
            (e - theta.inv(), z)
        };
        Some(order.iter().take(NEAREST).map(mode).collect())
    }
}
