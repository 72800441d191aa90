//! The half period as a vibrating string.
//!
//! Between kicks x(t) is straight; at a kick of strength s m its slope drops by s m x: a massless string
//! under unit tension with point masses m. One *tick* is the greatest common measure of all kick times, so
//! all spring lengths ℓ are whole numbers; in slopes per tick the kick is κ m x, κ = s/(ticks in h1), with
//! the masses 1 (fast), R = ρ p/q (slow), their sum where both strike, and half of it at t = 0 and T/2. So
//! A = 0, B = 0, C = 0, D = 0 are four eigenvalue problems in κ,
//!
//! ```text
//!     (x_j - x_{j-1})/ℓ_j - (x_{j+1} - x_j)/ℓ_{j+1} = κ m_j x_j,
//! ```
//!
//! whose ends are free (slope 0) or pinned (x = 0). Stiffness is GᵀG, G bidiagonal; all eigenvalues are real
//! and simple (Gantmacher and Krein), and relative changes of masses and lengths change them by no more than
//! that:
//!
//! **Monotonicity** (Courant, Fischer). κ_k is a min-max of Σ (x_j − x_{j−1})²/ℓ_j / Σ m_j x_j². So if every
//! mass changes by a factor in [1/μ, μ] and every length by one in [1/ν, ν], κ_k changes by one in [1/(μν),
//! μν].

use num_traits::{Signed, ToPrimitive, Zero};

use super::entry::Entry;
use crate::schedule::Schedule;
use number::vector::instructions::Instructions;
use number::{Error, Ratio, Rational, Result, Twofold};

/// The clocks that strike at a kick time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Ticks since the node before.
    pub length: f64,
    /// Index of the mass among [`HalfString::masses`].
    pub kind: usize,
    /// (1/ℓ + 1/ℓ')²/m, rounded; 0 where there is no mass.
    pub weight: f64,
}

/// So many kinds of nodes there are: that at t = 0, where both clocks strike, those of the fast clock alone
/// and of the slow one, and that at T/2. In between the clocks never strike together.
pub(crate) const KINDS: usize = 4;

const START: usize = 0;
const FAST: usize = 1;
const SLOW: usize = 2;
const END: usize = 3;

/// The kick at a node and the spring to the next one on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    pub kind: usize,
    pub length: f64,
    /// The node's mass.
    pub mass: f64,
    /// The node's.
    pub weight: f64,
}

/// Decades by which (x, v) may grow or shrink between two rescalings: squares of it stay in the range of
/// doubles.
const RANGE: f64 = 140.0;

/// The half period of p/q as nodes 0, 1, ..., n at the kick times; node n stands at T/2, kick or none.
#[derive(Clone, Debug)]
pub(crate) struct HalfString {
    pub nodes: Vec<Node>,
    /// The steps from t = 0 to T/2, and those back.
    pub forward: Vec<Step>,
    pub backward: Vec<Step>,
    /// The masses by kind, each within 2u relative of its exact value, u = 2^-53.
    pub masses: [f64; KINDS],
    /// The parts of them lost by rounding, to within 2^-104 of the masses.
    pub rests: [f64; KINDS],
    /// 1/m, rounded; 0 where there is no mass.
    pub inverse_masses: [f64; KINDS],
    /// The largest 1/(m ℓ) of a node and a spring at it, or a little more.
    pub stiffest: f64,
    /// Ticks in h1: s = κ · ticks.
    pub ticks: f64,
    /// Above all eigenvalues κ of all four problems.
    pub upper_bound: f64,
    /// Nodes between two rescalings.
    pub block: usize,
    /// How many positive eigenvalues each problem has.
    pub dimensions: [usize; 4],
    /// The instructions that the kernels run on.
    pub instructions: Instructions,
}

/// R must lie between the reciprocals of this and this, so that no product of the kernels leaves the range of
/// doubles.
const EXTREME: f64 = 1e16;

/// An event's kicks where only the fast clock strikes.
const FAST_ALONE: u64 = 1;

/// More kicks than this are not laid out in memory.
pub const MOST_KICKS: u64 = 1 << 24;

impl HalfString {
    /// The string of h2/h1 = p/q and ρ = L2/L1 > 0.
    ///
    /// # Errors
    /// More than 2^24 kicks in a period.
    pub fn new(ratio: Ratio, rho: &Rational) -> Result<Self> {
        if ratio.kicks() > MOST_KICKS {
            let cost = format!("{ratio} has more than {MOST_KICKS} kicks in a period");
            return Err(Error::too_much(cost, "choose a simpler ratio, or few labels (--m)"));
        }
        let (nodes, ticks, last) = nodes(ratio, rho.is_zero())?;
        let mut string = HalfString::with_nodes(nodes, ticks, slow_mass(ratio, rho), last);
        string.dimensions = Entry::ALL.map(|entry| HalfString::dimension(ratio, rho.is_zero(), entry));
        Ok(string)
    }

    /// That the masses are those of a string in the range of doubles.
    ///
    /// # Errors
    /// ρ < 0 (no string), ρ p/q beyond 1e±16.
    pub fn check(ratio: Ratio, rho: &Rational) -> Result<()> {
        if rho.is_negative() {
            let remedy = "a string has no negative masses, so the unstable set is not a list of its eigenvalues; \
                          use `map` or `verdict`, which take any sign";
            return Err(Error::input("rho", rho, remedy));
        }
        let mass = slow_mass(ratio, rho);
        if !rho.is_zero() && !(1.0 / EXTREME..=EXTREME).contains(&mass.hi) {
            return Err(Error::input("rho", rho, "rho p/q must lie between 1e-16 and 1e16"));
        }
        Ok(())
    }

    /// `last`: the clocks that strike at T/2.
    fn with_nodes(nodes: Vec<Node>, ticks: f64, slow: Twofold, last: u64) -> Self {
        let both = Twofold::sum(1.0, slow.hi);
        let both = Twofold { hi: both.hi, lo: both.lo + slow.lo };
        let (one, none) = (Twofold { hi: 1.0, lo: 0.0 }, Twofold::ZERO);
        // Half a kick at t = 0 and at T/2.
        let masses = [both.half(), one, slow, [none, one, slow, both][last as usize].half()];
        let (masses, rests) = (masses.map(|mass| mass.hi), masses.map(|mass| mass.lo));
        let inverse = |m: f64| if m > 0.0 { 1.0 / m } else { 0.0 };
        let mut string = HalfString {
            nodes,
            forward: Vec::new(),
            backward: Vec::new(),
            masses,
            rests,
            inverse_masses: masses.map(inverse),
            stiffest: 0.0,
            ticks,
            upper_bound: 0.0,
            block: 1,
            dimensions: [0; 4],
            instructions: Instructions::best(),
        };
        string.lay_steps();
        string.block = string.nodes_in_range();
        string
    }

    /// n, the index of the node at T/2.
    pub fn last(&self) -> usize {
        self.nodes.len() - 1
    }

    /// The mass at node j.
    #[inline(always)]
    pub fn mass(&self, j: usize) -> f64 {
        self.masses[self.nodes[j].kind]
    }

    /// Ticks in a unit of time: a power of two, at least as long as any spring.
    pub fn unit(&self) -> f64 {
        (self.longest() as u64).next_power_of_two() as f64
    }

    /// The longest spring, at least a tick.
    fn longest(&self) -> f64 {
        self.nodes.iter().fold(1.0, |most: f64, node| most.max(node.length))
    }

    /// How many positive eigenvalues a problem of p/q has: one for each free mass, less the rigid shift of C.
    /// Masses stand at the clocks' kicks in [0, T/2], at T/2 where p or q is even; the slow clock's only
    /// where it is not silent.
    pub fn dimension(ratio: Ratio, slow_is_silent: bool, entry: Entry) -> usize {
        let (p, q) = (ratio.p(), if slow_is_silent { 1 } else { ratio.q() });
        let at_end = p.is_multiple_of(2) || q.is_multiple_of(2);
        let between = (p - 1) / 2 + (q - 1) / 2;
        let ends = u64::from(entry.starts_free()) + u64::from(entry.ends_free() && at_end);
        (between + ends) as usize - usize::from(entry == Entry::C)
    }

    /// The steps from node to node, and what bounds the string as a whole.
    fn lay_steps(&mut self) {
        const BEYOND: f64 = 1.0 + 1e-9; // far beyond the rounding of these lines
        let n = self.last();
        self.forward.reserve(n);
        self.backward.reserve(n);
        let mut before = 0.0;
        for j in 0..=n {
            let Node { length, kind, .. } = self.nodes[j];
            let after = self.nodes.get(j + 1).map_or(0.0, |next| 1.0 / next.length);
            let (mass, inverse_mass) = (self.masses[kind], self.inverse_masses[kind]);
            let row = (before + after) * inverse_mass;
            // Gershgorin on M⁻¹K.
            self.upper_bound = self.upper_bound.max(2.0 * row * BEYOND);
            self.stiffest = self.stiffest.max(before.max(after) * inverse_mass * BEYOND);
            let weight = (before + after) * row;
            self.nodes[j].weight = weight;
            if j < n {
                self.forward.push(Step { kind, length: self.nodes[j + 1].length, mass, weight });
            }
            if j > 0 {
                self.backward.push(Step { kind, length, mass, weight });
            }
            before = after;
        }
        self.backward.reverse();
    }

    /// So many that max(|x|, |v|) changes by a factor within 1e±140: a kick and a drift multiply it by (1 +
    /// k) (1 + ℓ) at most, and so do their inverses, κ being at most twice the upper bound. A node alone,
    /// with masses within 1e±16 and lengths below 2^25, is within 1e±48.
    fn nodes_in_range(&self) -> usize {
        let heaviest = self.masses.iter().fold(0.0, |most: f64, &mass| most.max(mass));
        let growth = (1.0 + 2.0 * self.upper_bound * heaviest) * (1.0 + self.longest());
        ((RANGE / growth.log10()) as usize).max(1)
    }
}

/// R = ρ p/q.
fn slow_mass(ratio: Ratio, rho: &Rational) -> Twofold {
    let term = |big: &num_bigint::BigInt, small: u64| big.to_u64()?.checked_mul(small);
    term(rho.numer(), ratio.p())
        .zip(term(rho.denom(), ratio.q()))
        .and_then(|(a, b)| Twofold::quotient(a, b))
        .unwrap_or_else(|| Twofold::from_rational(&(rho * Rational::from(ratio))))
}

/// The nodes, how many ticks h1 has, and the clocks that strike at T/2.
fn nodes(ratio: Ratio, slow_is_silent: bool) -> Result<(Vec<Node>, f64, u64)> {
    let schedule = Schedule::two_clocks(ratio)?;
    let end = schedule.period() / 2;
    let mut nodes = Vec::with_capacity(ratio.kicks() as usize / 2 + 2);
    let (mut now, mut skipped, mut last) = (0, 0, 0);
    for event in schedule.half_period() {
        now += event.drift;
        let kind = match event.kicks {
            _ if now == 0 => START,
            _ if now == end => END,
            FAST_ALONE => FAST,
            _ => SLOW,
        };
        // Where the slow clock is silent its kick times are no nodes, unless the half period ends there.
        if slow_is_silent && kind == SLOW {
            skipped += event.drift;
            continue;
        }
        nodes.push(Node { length: (skipped + event.drift) as f64, kind, weight: 0.0 });
        (skipped, last) = (0, event.kicks);
    }
    Ok((nodes, schedule.clocks()[0].step() as f64, last))
}
