//! The recurrence from one end of the string to the node r, and what rounding took from it.
//!
//! Two operations lead from a node to the next, and their errors f and e are known exactly, being those of a product
//! and a sum each:
//!
//! ```text
//!     v' = v - k x - f,        x' = x + ℓ v' + e,        k = κ m + δ.
//! ```
//!
//! So the force in the spring behind is F = v + e/ℓ (e, ℓ of that spring), and the residual of a node's row is
//!
//! ```text
//!     ρ = F - F' - κ m x = f + δ x + e/ℓ - e'/ℓ'.
//! ```
//!
//! Σ x ρ over the nodes before r is Σ x (f + δ x) + Σ e F − (e/ℓ) x at r (summation by parts); that last term cancels
//! against the row at r. Σ ρ²/m is computed from |f| + |δ x| + |e/ℓ| + |e'/ℓ'|, an upper bound that does not cancel.

use super::lanes::{LANES, Lanes, lanes, largest, normalizing, smallest, two_product, two_sum};
use super::locate::{Problems, start};
use super::string::{BLOCK, HalfString, Kicks, Step};

/// The two halves, each on arrival at r.
#[inline(always)]
pub(super) fn halves<const PROVE: bool>(string: &HalfString, problems: &Problems, at: &Lanes) -> [Half; 2] {
    let tables = Tables::new::<PROVE>(string, &problems.kappa);
    let mut left = Half::new(&problems.starts_free);
    left.follow::<PROVE>(string, &tables, &string.forward, at);
    let mut right = Half::new(&problems.ends_free);
    let n = string.last() as f64;
    right.follow::<PROVE>(string, &tables, &string.backward, &lanes(|i| n - at[i]));
    [left, right]
}

/// By kind of node: the kick k, and δ = k − κ m to within 2^-50 of itself and 2^-103 κ m.
struct Tables {
    kicks: Kicks,
    deltas: Kicks,
}

impl Tables {
    #[inline(always)]
    fn new<const PROVE: bool>(string: &HalfString, kappa: &Lanes) -> Self {
        let kicks = string.kicks(kappa);
        let mut table = [[0.0; LANES]; 8];
        if PROVE {
            for (kind, delta) in table.iter_mut().enumerate() {
                let (mass, lost) = ([string.masses[kind]; LANES], [string.rests[kind]; LANES]);
                *delta = deltas(kappa, &mass, &lost, &kicks[kind]);
            }
        }
        Tables { kicks, deltas: table }
    }
}

/// k − κ m, the mass being `mass` + `lost`.
#[inline(always)]
pub(super) fn deltas(kappa: &Lanes, mass: &Lanes, lost: &Lanes, kick: &Lanes) -> Lanes {
    lanes(|i| -(kappa[i].mul_add(mass[i], -kick[i]) + kappa[i] * lost[i]))
}

/// A half on its way to r: the node's amplitude, the slope before it, and the sums over the nodes passed, in the scale
/// of x (squares: of x²).
pub(super) struct Half {
    pub x: Lanes,
    pub v: Lanes,
    /// e/ℓ of the spring just passed.
    pub g: Lanes,
    /// Σ m x².
    pub squares: Lanes,
    /// Σ x (f + δ x) + Σ e F.
    pub work: Lanes,
    /// Σ (|f| + |δ x| + |e/ℓ| + |e'/ℓ'|)²/m.
    pub residual: Lanes,
}

impl Half {
    #[inline(always)]
    fn new(free: &[bool; LANES]) -> Self {
        let (x, v) = start(free);
        let zero = [0.0; LANES];
        Half { x, v, g: zero, squares: zero, work: zero, residual: zero }
    }

    /// The first `until` steps, in each lane its own number.
    #[inline(always)]
    fn follow<const PROVE: bool>(
        &mut self,
        string: &HalfString,
        tables: &Tables,
        steps: &[Step],
        until: &Lanes,
    ) {
        let (least, most) = (smallest(until), largest(until));
        for (block, steps) in steps[..most as usize].chunks(BLOCK).enumerate() {
            let first = (block * BLOCK) as f64;
            if first + steps.len() as f64 <= least {
                for step in steps {
                    self.pass::<PROVE>(string, tables, step, &[1.0; LANES]);
                }
            } else {
                for (k, step) in steps.iter().enumerate() {
                    let goes = lanes(|i| if first + (k as f64) < until[i] { 1.0 } else { 0.0 });
                    self.pass::<PROVE>(string, tables, step, &goes);
                }
            }
            self.rescale::<PROVE>();
        }
    }

    #[inline(always)]
    fn pass<const PROVE: bool>(&mut self, string: &HalfString, tables: &Tables, step: &Step, goes: &Lanes) {
        if PROVE { self.prove(string, tables, step, goes) } else { self.step(string, tables, step, goes) }
    }

    /// The kick at a node and the drift to the next, in the lanes that still go; nothing moves where `goes` is 0.
    #[inline(always)]
    fn step(&mut self, string: &HalfString, tables: &Tables, step: &Step, goes: &Lanes) {
        let (kick, mass) = (&tables.kicks[step.kind], string.masses[step.kind]);
        let pull = lanes(|i| goes[i] * self.x[i]);
        self.squares = lanes(|i| (mass * pull[i]).mul_add(pull[i], self.squares[i]));
        self.v = lanes(|i| (-kick[i]).mul_add(pull[i], self.v[i]));
        self.x = lanes(|i| (step.length * goes[i]).mul_add(self.v[i], self.x[i]));
    }

    /// The same, and the roundings.
    #[inline(always)]
    fn prove(&mut self, string: &HalfString, tables: &Tables, step: &Step, goes: &Lanes) {
        let (kick, delta, mass) =
            (&tables.kicks[step.kind], &tables.deltas[step.kind], string.masses[step.kind]);
        let weight = string.inverse_masses[step.kind];
        let (length, inverse) = (step.length, step.inverse);
        for i in 0..LANES {
            let (x, goes) = (self.x[i], goes[i]);
            let pull = goes * x;
            let squares = (mass * pull).mul_add(pull, self.squares[i]);
            let (kicked, product_error) = two_product(kick[i], pull);
            let (v, sum_error) = two_sum(self.v[i], -kicked);
            let f = sum_error - product_error;
            let shift = delta[i] * pull;
            let (drift, product_error) = two_product(length * goes, v);
            let (next, sum_error) = two_sum(x, drift);
            let e = -(product_error + sum_error);
            let g = e.mul_add(inverse, (1.0 - goes) * self.g[i]);
            let work = e.mul_add(v + g, x.mul_add(f + shift, self.work[i]));
            let row = (f.abs() + shift.abs()) + (self.g[i].abs() + g.abs());
            let residual = (row * (weight * goes)).mul_add(row, self.residual[i]);
            self.x[i] = next;
            self.v[i] = v;
            self.g[i] = g;
            self.squares[i] = squares;
            self.work[i] = work;
            self.residual[i] = residual;
        }
    }

    /// Brings the larger of |x| and |v| to [1, 2), exactly.
    #[inline(always)]
    fn rescale<const PROVE: bool>(&mut self) {
        let factor = normalizing(&self.x, &self.v);
        let once = |x: &Lanes| lanes(|i| x[i] * factor[i]);
        let twice = |x: &Lanes| lanes(|i| x[i] * factor[i] * factor[i]);
        let (x, v, squares) = (once(&self.x), once(&self.v), twice(&self.squares));
        *self = if PROVE {
            let (work, residual) = (twice(&self.work), twice(&self.residual));
            Half { x, v, g: once(&self.g), squares, work, residual }
        } else {
            Half { x, v, squares, ..*self }
        };
    }

    /// Scaled to x = 1.
    #[inline(always)]
    pub fn arrival(&self) -> Arrival {
        let force = lanes(|i| self.v[i] / self.x[i]);
        // The quotient's remainder is a double.
        let rest = lanes(|i| (-force[i]).mul_add(self.x[i], self.v[i]) / self.x[i]);
        let square = lanes(|i| 1.0 / (self.x[i] * self.x[i]));
        let scaled = |sum: &Lanes| lanes(|i| sum[i] * square[i]);
        Arrival {
            force,
            rest,
            g: lanes(|i| (self.g[i] / self.x[i]).abs()),
            squares: scaled(&self.squares),
            work: scaled(&self.work),
            residual: scaled(&self.residual),
        }
    }
}

/// A half on arrival at r, scaled to z_r = 1.
pub(super) struct Arrival {
    /// v, and what rounding took from it.
    pub force: Lanes,
    pub rest: Lanes,
    pub g: Lanes,
    pub squares: Lanes,
    pub work: Lanes,
    pub residual: Lanes,
}
