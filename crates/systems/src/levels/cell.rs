//! Verdicts on all outer steps, or all scales of one level, between two: cells that cover a range.
//!
//! In a cell the fast kicks are t F, t_1 ≤ t ≤ t_2, the slow ones m S, m_1 ≤ m ≤ m_2. Each mode of F is
//! bounded by its own kicks at the two ends, and m S by m_0 S ± (m_2 − m_1)/2 |S|, |S| the matrix with the
//! absolute values of S's eigenvalues: what is soft is moved by little, whatever the norm of the whole. So
//! the counts at both ends bound those between (`counts`). Discs take over where a pair of multipliers left
//! the circle together: entry by entry, how far S = bᵀ C can be from that in the middle.
//!
//! All of it holds for every F + E₁ and S + E₂ within the accuracy of the data, as one verdict's margin does:
//! ‖E₁‖ moves each mode of F both ways, ‖E₂‖ is room for every eigenvalue (Loewner's order and Weyl), and
//! discs widen by how far both can move bᵀ C (`beyond`).

use faer::{Mat, Side};

use super::beyond::slopes;
use super::counts::{Counts, between_signs};
use super::half::Half;
use super::kernel::{Kernel, Outer, STEP_ERROR};
use crate::half::norm;
use crate::signs::inertia::backward_error;
use crate::spectrum::discs::Spectrum;
use crate::verdict::measured::Holds;
use number::{Error, Interval, Result, U};

/// The kernel with |S|.
pub struct Cells<'a> {
    kernel: &'a Kernel,
    /// How far (2-norm) Λ and S' are from those of all stiffnesses meant.
    shifts: [f64; 2],
    /// N with −N ≤ S' ≤ N.
    size: Mat<f64>,
}

/// The filter in a cell, see [`Cells::filter`].
struct Filter {
    phi: Vec<Interval>,
    /// m ‖N‖ (1 + 1/τ) r²,
    moved: Vec<f64>,
    /// m τ, of N,
    share: f64,
    /// and how far (2-norm) Φ S Φ is off for each unit of m, since F and S are not exactly known.
    off: f64,
}

/// Factors of the fast and of the slow stiffness in the time unit of the inner step.
struct Cell {
    inner_steps: u64,
    fast: Interval,
    slow: Interval,
}

impl<'a> Cells<'a> {
    /// For all stiffnesses within `accuracy` of their norms, 0 for those given alone: one eigendecomposition
    /// of S.
    ///
    /// # Errors
    /// Where its iteration fails: never seen, but not excluded.
    pub fn new(kernel: &'a Kernel, accuracy: f64) -> Result<Self> {
        let failed = || {
            Error::input("slow", "its eigenvalues", "the iteration does not converge: is the matrix sound?")
        };
        let m = kernel.size();
        let eigen = kernel.slow.self_adjoint_eigen(Side::Lower).map_err(|_| failed())?;
        let (v, values) = (eigen.U().to_owned(), (0..m).map(|i| eigen.S()[i]).collect::<Vec<_>>());
        let (error, defect) = backward_error(&kernel.slow, &v, &values).ok_or_else(failed)?;
        let largest = values.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
        let scaled = Mat::from_fn(m, m, |i, j| v[(i, j)] * values[j].abs());
        let mut size = &scaled * v.transpose();
        // V |Λ| Vᵀ beside Q |Λ| Qᵀ, Q the orthogonal factor of V; the product's rounding; that of the sums
        // here.
        let rounding = 1.1 * (m as f64 + 4.0) * U * norm::frobenius(&scaled) * norm::frobenius(&v);
        let room = 1.01 * (error + 2.1 * defect * largest + rounding) + 4.0 * U * largest;
        (0..m).for_each(|i| size[(i, i)] += room);
        Ok(Cells { kernel, shifts: kernel.errors_within(accuracy), size })
    }

    /// The verdict that is proven for all outer steps from lo to hi of `inner_steps` inner ones.
    ///
    /// # Errors
    /// As [`Outer::new`].
    pub fn verdict(&self, inner_steps: u64, (lo, hi): (f64, f64)) -> Result<Holds> {
        Outer::new(lo, inner_steps).and(Outer::new(hi, inner_steps))?;
        let step = Interval { lo, hi } / Interval::point(inner_steps as f64);
        let fast = step * step;
        Ok(self.holds_over(&Cell {
            inner_steps,
            fast,
            slow: fast * Interval::point(inner_steps as f64).half(),
        }))
    }

    /// The verdict at an outer step that is proven for all systems in which one level (0: the fast one) is lo
    /// to hi times as stiff.
    pub fn verdict_scaled(&self, outer: &Outer, level: usize, (lo, hi): (f64, f64)) -> Holds {
        if level == 0 && lo <= 0.0 {
            return Holds::Undecided;
        }
        let room = Interval { lo: 1.0 - STEP_ERROR, hi: 1.0 + STEP_ERROR };
        let (scale, square) =
            (Interval { lo: lo.next_down(), hi: hi.next_up() }, Interval::point(outer.inner_square) * room);
        let slow = square * Interval::point(outer.inner_steps as f64).half();
        self.holds_over(&match level {
            0 => Cell { inner_steps: outer.inner_steps, fast: square * scale, slow },
            _ => Cell { inner_steps: outer.inner_steps, fast: square, slow: slow * scale },
        })
    }

    fn holds_over(&self, cell: &Cell) -> Holds {
        let counts = self.counts(cell);
        if counts.as_ref().is_some_and(Counts::prove_instability) {
            return Holds::Unstable;
        }
        let spectrum = self.spectrum(cell);
        if let Some(counts) = &counts {
            let twists = spectrum.as_ref().and_then(|(spectrum, _)| self.twists(cell, spectrum));
            // Beyond the limits of the discs the modes of the fast level place the twists.
            if twists.or_else(|| counts.twists()).is_some_and(|or_else| counts.prove_stability(&or_else)) {
                return Holds::Stable;
            }
        }
        spectrum.and_then(|(spectrum, off)| spectrum.certified_around(&off)).into()
    }

    fn counts(&self, cell: &Cell) -> Option<Counts> {
        let kernel = self.kernel;
        let (shift, middle, half) = (self.shifts[0], cell.slow.middle(), cell.slow.error());
        let ends = |x: &f64| {
            let least = Interval::point((x - shift).next_down()) * cell.fast;
            (least.lo, (Interval::point((x + shift).next_up()) * cell.fast).hi)
        };
        let around = |x: &f64| kernel.method.around(ends(x), cell.inner_steps);
        let (less, more): (Vec<_>, Vec<_>) =
            kernel.values.iter().map(around).map(|[less, more]: [Half; 2]| (less, more)).unzip();
        let (m, filter) = (kernel.size(), self.filter(cell));
        let phi = |i: usize| filter.phi[i].middle();
        let slow = |sign: f64| {
            Mat::from_fn(m, m, |i, j| {
                let value = middle * kernel.slow[(i, j)] + sign * (half + filter.share) * self.size[(i, j)];
                phi(i) * value * phi(j) + if i == j { sign * filter.moved[i] } else { 0.0 }
            })
        };
        let slow = [slow(-1.0), slow(1.0)];
        let largest = cell.slow.lo.abs().max(cell.slow.hi.abs());
        let rounding = 8.0 * U * largest * (norm::frobenius(&kernel.slow) + norm::frobenius(&self.size));
        let slack = largest * filter.off + rounding;
        Counts::new([less, more], slow, 1.01 * slack)
    }

    /// φ of every mode in the cell. With Φ = Φ₀ + Δ, |Δ| ≤ r entry by entry, and N = |S|
    ///
    /// ```text
    ///     ± (Φ S Φ − Φ₀ S Φ₀) ≤ (1 + 1/τ) Δ N Δ + τ Φ₀ N Φ₀,     Δ N Δ ≤ ‖N‖ r²,
    /// ```
    ///
    /// for every τ > 0.
    fn filter(&self, cell: &Cell) -> Filter {
        let (kernel, p) = (self.kernel, cell.inner_steps);
        let phi = |x: &f64| kernel.method.filter(Interval::point(*x) * cell.fast, p);
        let phi: Vec<Interval> = kernel.values.iter().map(phi).collect();
        if !kernel.method.has_filter() {
            return Filter { moved: vec![0.0; phi.len()], phi, share: 0.0, off: self.shifts[1] };
        }
        let (largest, [_, size], [fast, slow]) =
            (cell.slow.lo.abs().max(cell.slow.hi.abs()), kernel.norms(), self.shifts);
        let tau = phi.iter().map(|interval| interval.error()).fold(U, f64::max);
        let moved =
            |interval: &Interval| 1.01 * largest * (1.0 + 1.0 / tau) * size * interval.error().powi(2);
        let below = self.below(cell);
        let [.., slope] = kernel.method.slopes(p, below);
        let turned = 1.01 * slope * cell.fast.hi * fast;
        // φ² is at most 1, but for what lies below 0.
        let off = 1.01 * kernel.method.room(p, below) * (2.0 * turned * (size + slow) + slow);
        Filter { moved: phi.iter().map(moved).collect(), phi, share: 1.01 * largest * tau, off }
    }

    /// How far the fast kicks reach below 0.
    fn below(&self, cell: &Cell) -> f64 {
        let lowest = self.kernel.values.first().map_or(0.0, |x| x - self.shifts[0]);
        (-lowest * cell.fast.hi).next_up().max(0.0)
    }

    /// S = f(F) − g(F) m S, f = (T_p − 1)/2 and g = U_(p−1)/2 at 1 − t F/2, in the middle of the cell, and
    /// how far it is elsewhere, entry by entry: f' = −p U_(p−1)/4 in s = t λ, and errors of Λ move f and g by
    /// T_p'(ξ)/4 and U_(p−1)'(ξ)/4 times them (`beyond`), p²/4 and p (p² − 1)/12 where all s are in \[0, 4\].
    fn spectrum(&self, cell: &Cell) -> Option<(Spectrum, Mat<f64>)> {
        let (kernel, p, m) = (self.kernel, cell.inner_steps as f64, self.kernel.size());
        let (shift, middle) = (self.shifts[0], Interval::point(cell.fast.middle()));
        let (lowest, highest) = (kernel.values.first()?, kernel.values.last()?);
        let ends = Interval { lo: lowest - shift, hi: highest + shift } * cell.fast;
        if !kernel.method.has_inner_steps() {
            return self.spectrum_in_one_go(cell);
        }
        // |1 − s/2| − 1 at both ends.
        let beyond = (ends.hi / 2.0 - 2.0).max(-ends.lo / 2.0).max(0.0).next_up();
        let [[_, u_slope], [t_slope, _], _] = slopes(cell.inner_steps, beyond);
        let ([f_slope, g_slope], g_size) = ([t_slope / 4.0, u_slope / 4.0], (p + beyond * u_slope) / 2.0);
        let halves: Vec<Half> = kernel
            .values
            .iter()
            .map(|x| Half::new((Interval::point(*x) * middle).middle(), cell.inner_steps))
            .collect();
        let (f, g): (Vec<_>, Vec<_>) = halves.iter().map(|half| (half.b * half.c, half.b * half.d)).unzip();
        let (mid, radius) = (cell.slow.middle(), cell.slow.error());
        let (most, size) = (cell.slow.lo.abs().max(cell.slow.hi.abs()), &kernel.slow);
        let s = Mat::from_fn(m, m, |i, j| {
            (if i == j { f[i].middle() } else { 0.0 }) - g[i].middle() * (mid * size[(i, j)])
        });
        // In s: from the middle, and of its rounding.
        let moved = |i: usize| 1.01 * kernel.values[i].abs() * (cell.fast.error() + 4.0 * U * cell.fast.hi);
        let off = Mat::from_fn(m, m, |i, j| {
            let (g_off, value) = (g_slope * moved(i), g[i].middle().abs() + g[i].error());
            let steep = (p / 2.0 * (value + g_off)).min(f_slope);
            let own = if i == j { steep * moved(i) + f[i].error() } else { 0.0 };
            let coupled =
                size[(i, j)].abs() * (value * (radius + 4.0 * U * most) + (g_off + g[i].error()) * most);
            1.01 * (own + coupled) + 2.0 * U * s[(i, j)].abs()
        });
        let error = 1.01 * cell.fast.hi * shift;
        let slow = kernel.norms()[1] + self.shifts[1];
        let error = 1.01 * (f_slope * error + most * (g_slope * error * slow + g_size * self.shifts[1]));
        Some((Spectrum::of(s, Some(error))?, off))
    }

    /// The spectrum where all functions of F are enclosed over the whole cell.
    fn spectrum_in_one_go(&self, cell: &Cell) -> Option<(Spectrum, Mat<f64>)> {
        let (kernel, p, m) = (self.kernel, cell.inner_steps, self.kernel.size());
        let halves: Vec<Half> =
            kernel.values.iter().map(|x| kernel.method.half(Interval::point(*x) * cell.fast, p)).collect();
        let phi = self.filter(cell);
        let entry = |i: usize, j: usize| {
            let kick = phi.phi[i] * phi.phi[j] * cell.slow * Interval::point(kernel.slow[(i, j)]);
            let coupled = -(halves[i].b * halves[i].d * kick);
            if i == j { halves[i].b * halves[i].c + coupled } else { coupled }
        };
        let s = Mat::from_fn(m, m, |i, j| entry(i, j).middle());
        let off = Mat::from_fn(m, m, |i, j| entry(i, j).error());
        let below = self.below(cell);
        let [f_slope, g_slope] = kernel.method.slopes_of_products(p, below);
        let most = cell.slow.lo.abs().max(cell.slow.hi.abs());
        let [error, size] = [1.01 * cell.fast.hi * self.shifts[0], kernel.norms()[1] + self.shifts[1]];
        // b d is at most p/2 and φ² at most 1, but for what lies below 0.
        let room = kernel.method.room(p, below);
        let kicked = most * room * (g_slope * error * size + 0.51 * p as f64 * phi.off);
        Some((Spectrum::of(s, Some(1.02 * (f_slope * error + kicked)))?, off))
    }

    /// Values of s = 1 + μ between modes of one of Krein's signs and of the other; `None` where some are off
    /// \[−1, 0\]. Whatever they are, counts at them prove what they prove.
    fn twists(&self, cell: &Cell, spectrum: &Spectrum) -> Option<Vec<f64>> {
        let (kernel, m) = (self.kernel, self.kernel.size());
        if spectrum.mu.iter().any(|mu| mu.im != 0.0 || !(-1.0..=0.0).contains(&mu.re)) {
            return None;
        }
        let half = |x: &f64| kernel.method.half(Interval::point(x * cell.fast.middle()), cell.inner_steps);
        let halves: Vec<Half> = kernel.values.iter().map(half).collect();
        let phi = self.filter(cell).phi;
        let kicked = &kernel.slow
            * Mat::from_fn(m, m, |i, k| phi[i].middle() * cell.slow.middle() * spectrum.vectors[(i, k)].re);
        // vᵀ Aᵀ C v, A = a − b M, C = c − d M.
        let sign = |k: usize| {
            let term = |i: usize| {
                let (v, kick) = (spectrum.vectors[(i, k)].re, phi[i].middle() * kicked[(i, k)]);
                let [a, b, c, d] = [halves[i].a, halves[i].b, halves[i].c, halves[i].d].map(Interval::middle);
                (a * v - b * kick) * (c * v - d * kick)
            };
            (0..m).map(term).sum::<f64>() > 0.0
        };
        between_signs(spectrum.mu.iter().enumerate().map(|(k, mu)| (1.0 + mu.re, sign(k))).collect())
    }
}
