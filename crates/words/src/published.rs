//! Limits of stable steps that sources print, to hold those found here against.

use super::catalogue::Method;

/// A limit as it is printed.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// The method's name in the catalogue.
    pub method: &'static str,
    /// Every ω h below is stable, for one force.
    pub omega_h: &'static str,
    /// Where it is printed.
    pub source: &'static str,
    /// Why the end of the stable steps is another one, where it is.
    pub disagrees: Option<&'static str>,
}

impl Method {
    /// The limit that is published of it.
    pub fn limit(&self) -> Option<&'static Limit> {
        LIMITS.iter().find(|limit| limit.method == self.name)
    }
}

const fn limit(method: &'static str, omega_h: &'static str, source: &'static str) -> Limit {
    Limit { method, omega_h, source, disagrees: None }
}

const BOOK: &str = "Hairer, Lubich, Wanner, Geometric Numerical Integration, I.5.2";
const BLACKJAX: &str = "BlackJAX, blackjax.mcmc.integrators, to about three digits";
const LATTICE: &str = "Schaefers, Finkenrath, Guenther, Knechtli, arXiv:2506.08813 (2025)";

/// All that are known here: no source that could be opened prints one of another method.
pub const LIMITS: &[Limit] = &[
    limit("symplectic-euler", "2", BOOK),
    limit("velocity-verlet", "2", BOOK),
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
];
