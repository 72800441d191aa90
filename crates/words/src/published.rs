//! Limits of stable steps that sources print, to hold those found here against.

use super::catalogue::Method;

/// A limit as it is printed.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// The method's name in the catalogue.
    pub method: &'static str,
    /// Every step below is stable: ω h for one force, ω1 h for two, whose fast one is the first; or [`ALL`],
    /// or [`FREE`].
    pub below: &'static str,
    /// Where it is printed.
    pub source: &'static str,
    /// Why the end of the stable steps is another one, where it is.
    pub disagrees: Option<&'static str>,
}

/// In place of a limit: every step is stable.
pub const ALL: &str = "infinity";

/// In place of a limit: two forces have no resonance, so the slow one's own limit is left.
pub const FREE: &str = "free";

/// In place of a limit: half the fast period.
pub const HALF_PERIOD: &str = "pi";

impl Method {
    /// The limit that is published of it.
    pub fn limit(&self) -> Option<&'static Limit> {
        LIMITS.iter().find(|limit| limit.method == self.name)
    }
}

const fn limit(method: &'static str, below: &'static str, source: &'static str) -> Limit {
    Limit { method, below, source, disagrees: None }
}

const BOOK: &str = "Hairer, Lubich, Wanner, Geometric Numerical Integration, I.5.2";
const BLACKJAX: &str = "BlackJAX, blackjax.mcmc.integrators, to about three digits";
const LATTICE: &str = "Schaefers, Finkenrath, Guenther, Knechtli, arXiv:2506.08813 (2025)";
const JULIA: &str = "OrdinaryDiffEq.jl, its documentation";
const MOLLY: &str = "Garcia-Archilla, Sanz-Serna, Skeel, SIAM J. Sci. Comput. 20, 930 (1998)";

const WEAK_FORCE: Option<&str> =
    Some("the published limit is that of a weak slow force; an unstable interval ends there");

/// All that are known here: no source that could be opened prints one of another method.
pub const LIMITS: &[Limit] = &[
    limit("symplectic-euler", "2", BOOK),
    limit("velocity-verlet", "2", BOOK),
    limit("position-verlet", "2", "Leimkuhler, Reich, Simulating Hamiltonian Dynamics, 2.6"),
    limit("midpoint", ALL, BOOK),
    limit("newmark", ALL, JULIA),
    limit("bcss-3", "4.67", BLACKJAX),
    Limit {
        disagrees: Some("its decimals open a narrow unstable interval, which the published limit leaves out"),
        ..limit("bcss-3-decimals", "4.67", BLACKJAX)
    },
    // BADAB and BABABABAB there.
    limit("chin-4a", "3.464102", LATTICE),
    limit("vefrl", "3.469636", LATTICE),
    limit("fg-adada", "2.926948", LATTICE),
    limit("fg-badadadab", "2.184445", LATTICE),
    Limit { disagrees: WEAK_FORCE, ..limit("impulse", HALF_PERIOD, MOLLY) },
    // The method of impulses is Deuflhard's where the slow force is linear.
    Limit {
        disagrees: WEAK_FORCE,
        ..limit("deuflhard", HALF_PERIOD, "Hairer, Lubich, Wanner, Geometric Numerical Integration, XIII.1.3")
    },
    limit("implicit-explicit", FREE, "Stern, Grinspun, Multiscale Model. Simul. 7, 1779 (2009)"),
    limit("rpmd-cayley", FREE, "Korol, Bou-Rabee, Miller, J. Chem. Phys. 151, 124103 (2019)"),
];
