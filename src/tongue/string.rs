//! The half period as a vibrating string.
//!
//! Between kicks x(t) is straight; at a kick of strength s m its slope drops by s m x: a massless string under
//! unit tension with point masses m. One *tick* is the greatest common measure of all kick times, so all spring
//! lengths ℓ are whole numbers; in slopes per tick the kick is κ m x, κ = s/(ticks in h1), with the masses 1
//! (fast), R = ρ p/q (slow), their sum where both strike, and half of it at t = 0 and T/2. So A = 0, B = 0, C = 0,
//! D = 0 are four eigenvalue problems in κ,
//!
//! ```text
//!     (x_j - x_{j-1})/ℓ_j - (x_{j+1} - x_j)/ℓ_{j+1} = κ m_j x_j,
//! ```
//!
//! whose ends are free (slope 0) or pinned (x = 0). Stiffness is GᵀG, G bidiagonal; all eigenvalues are real and
//! simple (Gantmacher and Krein), and relative changes of masses and lengths change them by no more than that:
//!
//! **Monotonicity** (Courant, Fischer). κ_k is a min-max of Σ (x_j − x_{j−1})²/ℓ_j / Σ m_j x_j². So if every mass
//! changes by a factor in [1/μ, μ] and every length by one in [1/ν, ν], κ_k changes by one in [1/(μν), μν].

use num_traits::{Signed, Zero};

use super::twofold::Twofold;
use crate::error::{Error, Result};
use crate::number::{Rational, rational};
use crate::propagator::{Schedule, Weight};

/// An entry of the half-period propagator, as the problem whose eigenvalues are its zeros.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Entry {
    /// Even at 0 (free), odd at T/2 (pinned).
    A,
    /// Odd at both ends.
    B,
    /// Even at both ends; its zero s = 0, a rigid shift, is not counted.
    C,
    /// Odd at 0, even at T/2.
    D,
}

impl Entry {
    /// All four.
    pub const ALL: [Entry; 4] = [Entry::A, Entry::B, Entry::C, Entry::D];

    /// Whether the string is free at t = 0.
    pub(super) fn starts_free(self) -> bool {
        matches!(self, Entry::A | Entry::C)
    }

    /// Whether the string is free at t = T/2.
    pub(super) fn ends_free(self) -> bool {
        matches!(self, Entry::C | Entry::D)
    }

    /// The entry's name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Entry::A => "A",
            Entry::B => "B",
            Entry::C => "C",
            Entry::D => "D",
        }
    }
}

/// What strikes at a node: index into the tables of masses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Node {
    /// Ticks since the node before.
    pub length: f64,
    /// 1/length, to the nearest.
    pub inverse: f64,
    /// How much of a fast and of a slow mass stands here: 0, 1/2 or 1.
    pub fast: f64,
    pub slow: f64,
    /// Index of the mass among [`HalfString::masses`].
    pub kind: usize,
}

/// The half period of p/q as nodes 0, 1, ..., n at the kick times; node n stands at T/2, kick or none.
#[derive(Clone, Debug)]
pub(super) struct HalfString {
    pub nodes: Vec<Node>,
    /// The masses by kind (2 · clocks + whole?), each within 2u relative of its exact value, u = 2^-53.
    pub masses: [f64; 8],
    /// R = ρ p/q to within 2^-104 relative.
    pub slow_mass: Twofold,
    /// Ticks in h1: s = κ · ticks.
    pub ticks: f64,
    /// Σ 1/ℓ, rounded.
    pub stiffness: f64,
}

/// R must lie between the reciprocals of this and this, so that no product of the kernels leaves the range of
/// doubles.
const EXTREME: f64 = 1e16;

/// The bit of the slow clock in an event's kicks.
const SLOW: u64 = 2;

/// More kicks than this are not laid out in memory.
const MOST_KICKS: u64 = 1 << 24;

impl HalfString {
    /// The string of h2/h1 = p/q (lowest terms) and ρ = L2/L1 > 0.
    ///
    /// # Errors
    /// ρ < 0 (no string), ρ beyond 1e±16, or more than 2^24 kicks in a period.
    pub fn new(p: u64, q: u64, rho: &Rational) -> Result<Self> {
        if rho.is_negative() {
            let remedy = "a string has no negative masses, so the unstable set is not a list of its eigenvalues; \
                          use `map` or `verdict`, which take any sign";
            return Err(Error::input("rho", rho, remedy));
        }
        let mass = rho * Rational::new(p.into(), q.into());
        let slow = rational::to_f64(&mass);
        if !rho.is_zero() && !(1.0 / EXTREME..=EXTREME).contains(&slow) {
            return Err(Error::input("rho", rho, "rho p/q must lie between 1e-16 and 1e16"));
        }
        if p.saturating_add(q) > MOST_KICKS {
            let cost =
                format!("{p}/{q} has more than {MOST_KICKS} kicks in a period: choose a simpler ratio");
            return Err(Error::budget(cost));
        }
        let schedule = Schedule::two_clocks(p, q)?;
        let mut nodes: Vec<Node> = Vec::new();
        let mut skipped = 0;
        let end = schedule.period() / 2;
        let mut now = 0;
        for event in schedule.half_period() {
            now += event.drift;
            // Where the slow clock is silent its kick times are no nodes, unless the half period ends there.
            if rho.is_zero() && event.kicks == SLOW && now < end {
                skipped += event.drift;
            } else {
                nodes.push(node(skipped + event.drift, event.kicks, event.weight));
                skipped = 0;
            }
        }
        let whole = [0.0, 1.0, slow, 1.0 + slow];
        let masses = std::array::from_fn(|kind| whole[kind / 2] * if kind % 2 == 0 { 0.5 } else { 1.0 });
        let stiffness = nodes[1..].iter().map(|node| node.inverse).sum();
        let slow_mass = Twofold::from_rational(&mass);
        Ok(HalfString { nodes, masses, slow_mass, ticks: schedule.clocks()[0].step() as f64, stiffness })
    }

    /// n, the index of the node at T/2.
    pub fn last(&self) -> usize {
        self.nodes.len() - 1
    }

    /// The last node that the problem moves: a free end without a mass only follows its neighbour.
    pub fn end(&self, entry: Entry) -> usize {
        let idle = entry.ends_free() && self.mass(self.last()) == 0.0;
        self.last() - usize::from(idle)
    }

    /// The mass at node j.
    pub fn mass(&self, j: usize) -> f64 {
        self.masses[self.nodes[j].kind]
    }

    /// How many positive eigenvalues the problem has: one for each free mass, less the rigid shift of C.
    pub fn dimension(&self, entry: Entry) -> usize {
        let free = |j: usize| (j > 0 || entry.starts_free()) && (j < self.last() || entry.ends_free());
        let masses = (0..=self.last()).filter(|&j| free(j) && self.mass(j) > 0.0).count();
        masses - usize::from(entry == Entry::C)
    }

    /// A bound above all eigenvalues κ of all four problems: max (2/m)(1/ℓ + 1/ℓ') (Gershgorin on M⁻¹K).
    pub fn upper_bound(&self) -> f64 {
        let inverse =
            |j: usize| if j == 0 { 0.0 } else { self.nodes.get(j).map_or(0.0, |node| node.inverse) };
        let row = |j: usize| 2.0 * (inverse(j) + inverse(j + 1)) / self.mass(j);
        let largest = (0..=self.last()).filter(|&j| self.mass(j) > 0.0).map(row).fold(0.0, f64::max);
        largest * (1.0 + 1e-9) // far beyond the rounding of this line
    }
}

fn node(drift: u64, kicks: u64, weight: Weight) -> Node {
    let whole = weight == Weight::Full;
    let part = |bit: u64| {
        if kicks & bit == 0 {
            0.0
        } else if whole {
            1.0
        } else {
            0.5
        }
    };
    let length = drift as f64;
    let kind = 2 * kicks as usize + usize::from(whole);
    Node { length, inverse: 1.0 / length, fast: part(1), slow: part(2), kind }
}
