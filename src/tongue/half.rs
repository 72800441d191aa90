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

use super::lanes::{Aligned, LANES, Lanes, lanes, largest, normalizing, smallest, two_product, two_sum};
use super::locate::{Problems, start};
use super::string::{HalfString, Kicks, Step};
use crate::verdict::instructions::Task;

/// The two halves, each on arrival at r.
#[inline(always)]
pub(super) fn halves<const PROVE: bool>(string: &HalfString, problems: &Problems, at: &Lanes) -> [Half; 2] {
    let tables = Tables::new::<PROVE>(string, &problems.kappa);
    let mut left = Half::new(&problems.starts_free);
    follow::<PROVE>(string, &tables, &string.forward, at, &mut left);
    let mut right = Half::new(&problems.ends_free);
    let n = string.last() as f64;
    follow::<PROVE>(string, &tables, &string.backward, &lanes(|i| n - at[i]), &mut right);
    [left, right]
}

#[inline(always)]
fn follow<const PROVE: bool>(
    string: &HalfString,
    tables: &Tables,
    steps: &[Step],
    until: &Lanes,
    half: &mut Half,
) {
    string.instructions.perform(Following::<PROVE> { string, tables, steps, until, half });
}

/// The first `until` steps of a half, in each lane its own number. A task of its own: what follows it is of no
/// concern to the compiler where the loop is made vector instructions.
struct Following<'a, const PROVE: bool> {
    string: &'a HalfString,
    tables: &'a Tables,
    steps: &'a [Step],
    until: &'a Lanes,
    half: &'a mut Half,
}

impl<const PROVE: bool> Task for Following<'_, PROVE> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Following { string, tables, steps, until, .. } = self;
        let mut half = *self.half;
        let (least, most) = (smallest(until), largest(until));
        for (block, steps) in steps[..most as usize].chunks(string.block).enumerate() {
            let first = (block * string.block) as f64;
            let together = ((least - first).max(0.0) as usize).min(steps.len());
            for step in &steps[..together] {
                half.pass::<PROVE, false>(string, tables, step, &[1.0; LANES]);
            }
            for (k, step) in steps.iter().enumerate().skip(together) {
                let goes = lanes(|i| if first + (k as f64) < until[i] { 1.0 } else { 0.0 });
                half.pass::<PROVE, true>(string, tables, step, &goes);
            }
            half.rescale::<PROVE>();
        }
        *self.half = half;
    }
}

/// By kind of node: the kick k, and δ = k − κ m to within 2^-50 of itself and 2^-103 κ m.
struct Tables {
    kicks: Kicks,
    /// Where they are proven.
    deltas: Option<Kicks>,
}

impl Tables {
    #[inline(always)]
    fn new<const PROVE: bool>(string: &HalfString, kappa: &Lanes) -> Self {
        let kicks = string.kicks(kappa);
        if !PROVE {
            return Tables { kicks, deltas: None };
        }
        let mut table = Aligned([[0.0; LANES]; 8]);
        for (kind, delta) in table.0.iter_mut().enumerate().skip(2) {
            let (mass, lost) = ([string.masses[kind]; LANES], [string.rests[kind]; LANES]);
            *delta = deltas(kappa, &mass, &lost, &kicks.0[kind]);
        }
        Tables { kicks, deltas: Some(table) }
    }
}

/// k − κ m, the mass being `mass` + `lost`.
#[inline(always)]
pub(super) fn deltas(kappa: &Lanes, mass: &Lanes, lost: &Lanes, kick: &Lanes) -> Lanes {
    lanes(|i| -(kappa[i].mul_add(mass[i], -kick[i]) + kappa[i] * lost[i]))
}

/// A half on its way to r: the node's amplitude, the slope before it, and the sums over the nodes passed, in the scale
/// of x (squares: of x²).
#[derive(Clone, Copy)]
#[repr(align(64))]
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
    fn new(free: &Lanes) -> Self {
        let (x, v) = start(free);
        let zero = [0.0; LANES];
        Half { x, v, g: zero, squares: zero, work: zero, residual: zero }
    }

    #[inline(always)]
    fn pass<const PROVE: bool, const SOME: bool>(
        &mut self,
        string: &HalfString,
        tables: &Tables,
        step: &Step,
        goes: &Lanes,
    ) {
        if PROVE {
            self.prove::<SOME>(string, tables, step, goes);
        } else {
            self.step::<SOME>(string, tables, step, goes);
        }
    }

    /// The kick at a node and the drift to the next; where only `SOME` lanes go, nothing moves in those whose `goes`
    /// is 0.
    #[inline(always)]
    fn step<const SOME: bool>(&mut self, string: &HalfString, tables: &Tables, step: &Step, goes: &Lanes) {
        let (kick, mass) = (&tables.kicks.0[step.kind], string.masses[step.kind]);
        let pull = if SOME { lanes(|i| goes[i] * self.x[i]) } else { self.x };
        let length = if SOME { lanes(|i| step.length * goes[i]) } else { [step.length; LANES] };
        self.squares = lanes(|i| (mass * pull[i]).mul_add(pull[i], self.squares[i]));
        self.v = lanes(|i| (-kick[i]).mul_add(pull[i], self.v[i]));
        self.x = lanes(|i| length[i].mul_add(self.v[i], self.x[i]));
    }

    /// The same, and the roundings.
    #[inline(always)]
    fn prove<const SOME: bool>(&mut self, string: &HalfString, tables: &Tables, step: &Step, goes: &Lanes) {
        let deltas = tables.deltas.as_ref().expect("a proof's tables");
        let (kick, delta, mass) =
            (&tables.kicks.0[step.kind], &deltas.0[step.kind], string.masses[step.kind]);
        let weight = string.inverse_masses[step.kind];
        let (length, inverse) = (step.length, step.inverse);
        for i in 0..LANES {
            let x = self.x[i];
            let pull = if SOME { goes[i] * x } else { x };
            let squares = (mass * pull).mul_add(pull, self.squares[i]);
            let (kicked, product_error) = two_product(kick[i], pull);
            let (v, sum_error) = two_sum(self.v[i], -kicked);
            let f = sum_error - product_error;
            let shift = delta[i] * pull;
            let (drift, product_error) = two_product(if SOME { length * goes[i] } else { length }, v);
            let (next, sum_error) = two_sum(x, drift);
            let e = -(product_error + sum_error);
            let g = if SOME { e.mul_add(inverse, (1.0 - goes[i]) * self.g[i]) } else { e * inverse };
            let work = e.mul_add(v + g, x.mul_add(f + shift, self.work[i]));
            let row = (f.abs() + shift.abs()) + (self.g[i].abs() + g.abs());
            let weight = if SOME { weight * goes[i] } else { weight };
            let residual = (row * weight).mul_add(row, self.residual[i]);
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

    /// v and Σ m x², scaled to x = 1.
    #[inline(always)]
    pub fn force_and_squares(&self) -> (Lanes, Lanes) {
        let inverse = lanes(|i| 1.0 / self.x[i]);
        let force = lanes(|i| self.v[i] * inverse[i]);
        (force, lanes(|i| self.squares[i] * inverse[i] * inverse[i]))
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
