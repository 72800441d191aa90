//! The half period of many degrees of freedom, each carrying its own time.
//!
//! In ticks τ and with momenta τ p the maps are x ← x + n M⁻¹ p and p ← p − F_k x, F_k = τ² s_k K_k with the
//! step of s_k ticks. As in Algorithm 1 of the paper a kick touches only the degrees of freedom in its
//! potential, and only these are drifted up to its time. So the cost of a half period over m columns is
//!
//! ```text
//!     m Σ_k (T/2h_k) (entries of K_k + degrees of freedom of K_k)
//! ```
//!
//! multiplications (for a diagonal mass matrix; else whole islands of M drift together), not (T/2h) n² m.

use faer::Mat;
use nalgebra::DMatrix;
use num_traits::{One, Zero};

use crate::linear::sparse::Symmetric;
use crate::linear::system::{Potential, System};
use crate::verdict::limits::Limits;
use clocks::schedule::{Event, Weight};
use number::{Rational, Result, Ring, to_f64};

/// The cost of an event beside its multiplications, in columns of the half period.
const OVERHEAD: u64 = 16;

/// The multiplications of a half period with all 2n columns, roughly.
pub fn cost(system: &System) -> u64 {
    let entries = |k: &Symmetric| (0..k.size()).map(|i| k.row(i).len() + 1).sum::<usize>() as u64;
    let kick = |(k, clock): (usize, &Potential)| {
        (system.strikes(k) / 2 + 1).saturating_mul(entries(&clock.stiffness))
    };
    let rows = system.clocks().iter().enumerate().map(kick).fold(0, u64::saturating_add);
    rows.saturating_mul(2 * system.size() as u64 + OVERHEAD)
}

/// That a half period may be composed kick by kick.
///
/// # Errors
/// A budget error, before any work.
pub fn check_length(system: &System, limits: &Limits) -> Result<()> {
    limits.allow(cost(system), || format!("half a period of {} kicks", system.schedule().strikes() / 2))
}

/// The coefficients of one row: (column, value) pairs.
pub type Row<S> = Vec<(usize, S)>;

/// The events of a system, in ticks: rows of M⁻¹ and of the F_k over any scalar.
#[derive(Clone, Debug)]
pub struct Program<S> {
    /// The rows of M⁻¹.
    pub inverse_mass: Vec<Row<S>>,
    /// The degrees of freedom that drift together with each.
    pub islands: Vec<Vec<usize>>,
    /// The island of each degree of freedom.
    pub island_of: Vec<usize>,
    /// For each clock the rows of F_k that are not 0, and the islands that they look at.
    pub kicks: Vec<Kick<S>>,
}

/// One clock's kick.
#[derive(Clone, Debug)]
pub struct Kick<S> {
    pub rows: Vec<(usize, Row<S>)>,
    pub islands: Vec<usize>,
}

/// The islands of M, and the rows of M⁻¹.
pub fn inverse_mass(system: &System) -> (Vec<Vec<usize>>, Vec<Row<Rational>>) {
    let islands = connected(system.size(), system.mass().places());
    let inverse = inverse(system.mass(), &islands);
    (islands, inverse)
}

/// M⁻¹, each entry rounded.
pub(crate) fn rounded_inverse_mass(system: &System) -> Mat<f64> {
    let mut rounded = Mat::zeros(system.size(), system.size());
    for (i, row) in inverse_mass(system).1.iter().enumerate() {
        row.iter().for_each(|(j, x)| rounded[(i, *j)] = to_f64(x));
    }
    rounded
}

impl Program<Rational> {
    pub fn new(system: &System) -> Self {
        Program::over(system, Rational::clone, |k, factor| {
            let entry = |(&j, x): (&usize, &Rational)| (j, x * factor);
            k.support().into_iter().map(|i| (i, k.row(i).iter().map(entry).collect())).collect()
        })
    }
}

impl Program<f64> {
    /// Each coefficient the double nearest to it.
    pub fn rounded(system: &System) -> Self {
        Program::over(system, to_f64, Symmetric::rounded_products)
    }
}

impl<S> Program<S> {
    /// Over the scalars that `entry` makes of one of M⁻¹, and `products` of a stiffness and the factor of its
    /// clock: the rows that are not 0.
    fn over(
        system: &System,
        entry: impl Fn(&Rational) -> S,
        products: impl Fn(&Symmetric, &Rational) -> Vec<(usize, Row<S>)>,
    ) -> Self {
        let (islands, inverse_mass) = inverse_mass(system);
        let mut island_of = vec![0; system.size()];
        for (k, island) in islands.iter().enumerate() {
            island.iter().for_each(|&i| island_of[i] = k);
        }
        let row = |row: &Row<Rational>| row.iter().map(|(j, x)| (*j, entry(x))).collect();
        let inverse_mass = inverse_mass.iter().map(row).collect();
        let kick = |(clock, ticks): (&Potential, u64)| {
            let factor = system.tick() * system.tick() * Rational::from_integer(ticks.into());
            let rows = products(&clock.stiffness, &factor);
            let mut islands: Vec<_> = rows.iter().map(|(i, _)| island_of[*i]).collect();
            islands.sort_unstable();
            islands.dedup();
            Kick { rows, islands }
        };
        let steps = system.schedule().clocks().iter().map(|clock| clock.step());
        let kicks = system.clocks().iter().zip(steps).map(kick).collect();
        Program { inverse_mass, islands, island_of, kicks }
    }

    /// Converts the program to another scalar.
    pub fn map<U>(&self, convert: impl Fn(&S) -> U) -> Program<U> {
        let row = |row: &Row<S>| row.iter().map(|(j, x)| (*j, convert(x))).collect::<Row<U>>();
        let kick = |kick: &Kick<S>| Kick {
            rows: kick.rows.iter().map(|(i, r)| (*i, row(r))).collect(),
            islands: kick.islands.clone(),
        };
        Program {
            inverse_mass: self.inverse_mass.iter().map(row).collect(),
            islands: self.islands.clone(),
            island_of: self.island_of.clone(),
            kicks: self.kicks.iter().map(kick).collect(),
        }
    }

    pub fn size(&self) -> usize {
        self.inverse_mass.len()
    }

    /// All coefficients, of M⁻¹ and of the F_k.
    pub fn entries(&self) -> impl Iterator<Item = &S> {
        let kicks = self.kicks.iter().flat_map(|kick| &kick.rows).map(|(_, row)| row);
        self.inverse_mass.iter().chain(kicks).flatten().map(|(_, x)| x)
    }

    /// Sends `events` to the state: drifts of islands up to date before the kicks that look at them, and at
    /// the end all to the same time.
    pub fn run(&self, events: impl Iterator<Item = Event>, state: &mut impl State<S>) {
        let mut at = vec![0u64; self.islands.len()];
        let mut now = 0;
        for event in events {
            now += event.drift;
            for kick in event.clocks().map(|clock| &self.kicks[clock]) {
                for &island in &kick.islands {
                    state.drift(self, island, now - at[island]);
                    at[island] = now;
                }
                kick.rows.iter().for_each(|(i, row)| state.kick(*i, row, event.weight));
            }
        }
        for (island, at) in at.into_iter().enumerate() {
            state.drift(self, island, now - at);
        }
    }
}

/// Columns of positions and momenta that drift and are kicked.
pub trait State<S> {
    /// x ← x + ticks M⁻¹ p on one island.
    fn drift(&mut self, program: &Program<S>, island: usize, ticks: u64);
    /// p_i ← p_i − w Σ F_ij x_j, w = 1 or 1/2.
    fn kick(&mut self, i: usize, row: &Row<S>, weight: Weight);
}

/// The rows of positions and of momenta over any ring.
pub struct Columns<S> {
    pub x: Vec<Vec<S>>,
    pub p: Vec<Vec<S>>,
}

impl<S: Ring> State<S> for Columns<S> {
    fn drift(&mut self, program: &Program<S>, island: usize, ticks: u64) {
        if ticks == 0 {
            return;
        }
        let ticks = S::from_rational(&Rational::from_integer(ticks.into()));
        for &i in &program.islands[island] {
            for (j, a) in &program.inverse_mass[i] {
                let factor = S::product(&ticks, a);
                add(&mut self.x[i], &factor, &self.p[*j]);
            }
        }
    }

    fn kick(&mut self, i: usize, row: &Row<S>, weight: Weight) {
        let weight = S::from_rational(&weight.of(&-Rational::one()));
        for (j, a) in row {
            let factor = S::product(&weight, a);
            add(&mut self.p[i], &factor, &self.x[*j]);
        }
    }
}

fn add<S: Ring>(row: &mut [S], factor: &S, other: &[S]) {
    row.iter_mut().zip(other).for_each(|(x, y)| x.add_product(factor, y));
}

/// The propagator over the events in positions and momenta (unit of time: the tick), 2n x 2n.
fn propagator<S: Ring>(program: &Program<S>, events: impl Iterator<Item = Event>) -> DMatrix<S> {
    let n = program.size();
    let unit = |i: usize| (0..2 * n).map(|j| if i == j { S::one() } else { S::zero() }).collect();
    let mut columns = Columns { x: (0..n).map(unit).collect(), p: (n..2 * n).map(unit).collect() };
    program.run(events, &mut columns);
    let rows: Vec<_> = columns.x.into_iter().chain(columns.p).collect();
    DMatrix::from_fn(2 * n, 2 * n, |i, j| rows[i][j].clone())
}

/// H, the propagator over half the period, half of each kick at its ends, in any ring: 2n x 2n, positions
/// before momenta, the momenta in the unit of time one tick.
pub fn half_period<S: Ring>(system: &System) -> DMatrix<S> {
    half_period_of(&Program::new(system).map(S::from_rational), system)
}

/// H of a program with the events of `system`.
pub(crate) fn half_period_of<S: Ring>(program: &Program<S>, system: &System) -> DMatrix<S> {
    propagator(program, system.schedule().half_period())
}

/// Q of the time-symmetric form, like [`half_period`].
pub fn full_period<S: Ring>(system: &System) -> DMatrix<S> {
    propagator(&Program::new(system).map(S::from_rational), system.schedule().symmetric_period())
}

/// The degrees of freedom that some entry of the mass or of a stiffness connects, an effective one or one
/// that it comes from.
pub(crate) fn connected_parts(system: &System) -> Vec<Vec<usize>> {
    let potentials = system.potentials().iter().map(|potential| &potential.stiffness);
    let graphs = potentials.chain(system.holding()).chain([system.mass()]);
    connected(system.size(), graphs.flat_map(Symmetric::places))
}

/// The connected components of the graph on 0, ..., n − 1 with these edges, each increasing, in the order of
/// their first.
pub(crate) fn connected(n: usize, edges: impl Iterator<Item = (usize, usize)>) -> Vec<Vec<usize>> {
    let mut root: Vec<usize> = (0..n).collect();
    fn find(root: &mut [usize], mut i: usize) -> usize {
        while root[i] != i {
            root[i] = root[root[i]];
            i = root[i];
        }
        i
    }
    for (i, j) in edges {
        let (a, b) = (find(&mut root, i), find(&mut root, j));
        root[a.max(b)] = a.min(b);
    }
    let mut components: std::collections::BTreeMap<usize, Vec<usize>> = Default::default();
    for i in 0..n {
        components.entry(find(&mut root, i)).or_default().push(i);
    }
    components.into_values().collect()
}

/// The rows of M⁻¹, island by island.
fn inverse(mass: &Symmetric, islands: &[Vec<usize>]) -> Vec<Row<Rational>> {
    let mut rows = vec![Vec::new(); mass.size()];
    for island in islands {
        if let [i] = island[..] {
            rows[i] = vec![(i, mass.row(i)[&i].recip())];
            continue;
        }
        let inverse = inverted(mass.restricted(island).to_dense());
        for (a, &i) in island.iter().enumerate() {
            let entry = |(b, &j): (usize, &usize)| (j, inverse[(a, b)].clone());
            rows[i] = island.iter().enumerate().map(entry).filter(|(_, x)| !x.is_zero()).collect();
        }
    }
    rows
}

/// The inverse of a positive definite matrix, by Gauss and Jordan (no pivot can vanish).
pub(crate) fn inverted(mut m: DMatrix<Rational>) -> DMatrix<Rational> {
    let n = m.nrows();
    let mut inverse = DMatrix::from_fn(n, n, |i, j| if i == j { Rational::one() } else { Rational::zero() });
    for k in 0..n {
        let pivot = m[(k, k)].recip();
        for j in 0..n {
            m[(k, j)] *= &pivot;
            inverse[(k, j)] *= &pivot;
        }
        for i in (0..n).filter(|&i| i != k) {
            let factor = m[(i, k)].clone();
            for j in 0..n {
                let (a, b) = (&factor * &m[(k, j)], &factor * &inverse[(k, j)]);
                m[(i, j)] -= a;
                inverse[(i, j)] -= b;
            }
        }
    }
    inverse
}
