//! What is found of a molecule: its fast motions, and a finding for each scheme of steps.

use num_traits::ToPrimitive;

use super::answer::Status;
use super::caps::{Bound, Caps};
use super::levels::Scheme;
use super::levers::Levers;
use number::Rational;
use systems::levels::Growing;
use systems::{Holds, Removed};

/// Fast modes of nearly one period.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    pub count: usize,
    /// The shortest and the longest period in fs, rounded.
    pub period: (f64, f64),
    /// Their name; `None` where the bonds are not known, or where no bond, angle or molecule has most of a
    /// mode.
    pub name: Option<String>,
    /// Who moves in the fastest of them.
    pub atoms: String,
}

/// The answer for a molecule at one scheme of steps; lengths in fs.
#[derive(Clone, Debug)]
pub struct Finding {
    pub scheme: Scheme,
    pub status: Status,
    /// The verdict that is proven for all matrices within their accuracy.
    pub holds: Holds,
    /// The largest relative change of the stiffnesses under which the verdict is proven to stand.
    pub margin: Option<f64>,
    /// \[lo, hi\]: every outer step up to lo is proven stable at this ratio, hi is proven unstable.
    pub first: Option<(f64, f64)>,
    /// Every outer step from the first unstable one up to this is proven unstable; the interval may end
    /// later.
    pub first_upper: Option<f64>,
    /// Growth from there on, sampled, steps in fs and rates per fs; that a step is stable again is proven.
    /// None where no first one is.
    pub growing: Vec<Growing>,
    /// Growth per fs, rounded; 0 where nothing grows, `None` where that is not decided.
    pub rate: Option<f64>,
    /// The name of the motion that grows fastest, where it is known.
    pub name: Option<String>,
    /// Who moves in it.
    pub atoms: Option<String>,
    /// Where a friction was given: whether it is proven to keep all bounded, or that something grows all the
    /// same; `None`: doubles cannot decide.
    pub is_damped: Option<bool>,
    /// And where something grows without one, a friction per fs that is proven to mask it, about the least.
    pub masking: Option<f64>,
    /// Every outer step up to this, at this ratio, is proven stable for all periods in the band.
    pub band_edge: Option<f64>,
    /// The longest multiple of the inner step that is proven so, all shorter ones too.
    pub largest: Option<Rational>,
    /// The longest multiple that is `largest` at most and below what is published ([`Caps`]); `None` also
    /// where an inner step is not.
    pub safe: Option<Rational>,
    /// What bounds `safe`.
    pub bound: Option<Bound>,
    pub within_run: Option<bool>,
    /// Where it is stable for all matrices: the normal mode whose potential energy is most off; `None` also
    /// where it is not computed.
    pub bias: Option<MostBiased>,
    /// That with the outermost step `safe`.
    pub safe_bias: Option<MostBiased>,
}

/// The normal mode of a period whose potential energy is most off, rounded.
#[derive(Clone, Debug, PartialEq)]
pub struct MostBiased {
    /// Its name or, where it has none, who moves in it.
    pub mode: String,
    /// At the kicks.
    pub bias: f64,
}

/// The whole answer for a molecule.
#[derive(Clone, Debug)]
pub struct Findings {
    /// Of the innermost forces; none where all that they pull is held.
    pub groups: Vec<Group>,
    /// The first group, or else the fastest motion of a level between.
    pub fastest: Group,
    /// The shortest period of the slowest stiffness alone, in fs, rounded.
    pub slow: f64,
    /// The shortest periods of the levels between, each alone, from the inside out.
    pub between: Vec<f64>,
    pub removed: Option<Removed>,
    pub accuracy: f64,
    /// What bounds the steps beside linear theory.
    pub caps: Caps,
    /// Whether the bonds are said to be harmonic.
    pub harmonic: bool,
    pub band: Rational,
    pub length: Option<Rational>,
    /// Per fs.
    pub friction: Option<Rational>,
    pub schemes: Vec<Finding>,
    /// Levers that would let the outer step of the first scheme grow; `None` where that was not asked.
    pub levers: Option<Levers>,
}

impl Finding {
    /// Outer steps until an amplitude is tenfold, rounded; `None` where nothing grows.
    pub fn tenfold_steps(&self) -> Option<f64> {
        let outer = self.scheme.outer().to_f64()?;
        self.rate.filter(|rate| *rate > 0.0).map(|rate| std::f64::consts::LN_10 / (rate * outer))
    }
}
