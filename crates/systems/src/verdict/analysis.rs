//! The answer about a system: its kind, part by part, every multiplier, and the modes that grow.

use num_complex::Complex64;

use crate::exact::decide::MuCount;
use crate::spectrum::modes::{Origin, Resonance};
use crate::spectrum::rate::{self, Multiplier};
use crate::verdict::measured::{Holds, Measured};
use clocks::verdict::{Kind, Tier};
use number::{Ball, Laurent, Rational};

/// The proof behind a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evidence {
    /// The scalar ladder.
    Scalar(Tier),
    /// Definite forms of the half period in doubles, within proven bounds.
    Signs,
    /// Doubles with proven discs about every eigenvalue.
    Discs,
    /// Exact arithmetic.
    Exact,
    /// Doubles alone: not proven.
    Estimate,
}

impl Evidence {
    /// The name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Evidence::Scalar(tier) => tier.name(),
            Evidence::Signs => "signs",
            Evidence::Discs => "discs",
            Evidence::Exact => "exact",
            Evidence::Estimate => "estimate",
        }
    }

    /// Whether the verdict is proven.
    pub fn is_proof(self) -> bool {
        self != Evidence::Estimate
    }
}

/// A multiplier off the unit circle.
#[derive(Clone, Debug)]
pub struct Instability {
    /// Which one.
    pub multiplier: Multiplier,
    /// How it came there.
    pub origin: Origin,
    /// An enclosure of ln |λ|/T, per unit time; `None`: not bounded.
    pub growth_rate: Option<(f64, f64)>,
    /// The positions of the growing solution at t = 0 in the system's coordinates, rounded: of the complex
    /// shape, scaled so that its longest entry is 1, the real part,
    pub shape: Vec<f64>,
    /// and the imaginary one, a quarter turn of the beat later; all 0 for a real pair.
    pub quadrature: Vec<f64>,
    /// The nearest resonance, by the normal modes in the shape; `None` where these could not be computed.
    pub resonance: Option<Resonance>,
}

impl Instability {
    /// Brings the shape to other coordinates, its longest entry 1.
    pub(crate) fn lift(&mut self, up: impl Fn(&[f64]) -> Vec<f64>) {
        (self.shape, self.quadrature) = (up(&self.shape), up(&self.quadrature));
        self.normalize();
    }

    /// Turns and scales the shape so that its longest entry is 1.
    pub(crate) fn normalize(&mut self) {
        let entries = || self.shape.iter().zip(&self.quadrature).map(|(&re, &im)| Complex64::new(re, im));
        let longer = |a: Complex64, b: Complex64| if b.norm_sqr() > a.norm_sqr() { b } else { a };
        let longest = entries().fold(Complex64::new(0.0, 0.0), longer);
        if longest.norm_sqr() == 0.0 {
            return;
        }
        let scaled: Vec<Complex64> = entries().map(|z| z / longest).collect();
        self.shape = scaled.iter().map(|z| z.re).collect();
        self.quadrature = scaled.iter().map(|z| z.im).collect();
    }
}

/// An invariant part that was decided by itself.
#[derive(Clone, Debug)]
pub struct Part {
    /// The degrees of freedom of the system that take part.
    pub dofs: Vec<usize>,
    /// The number of its own, rigid modes left out.
    pub size: usize,
    /// Its synchronization period: that of the clocks that act on it.
    pub period: Laurent,
    /// Over that period. Coexistence: stable with a multiplier ±1 of its own. Over a multiple of its period,
    /// the system's say, a multiplier that is a root of 1 may become ±1, too: that is a property of the other
    /// parts' clocks, and not counted. `None`: not decided.
    pub kind: Option<Kind>,
    pub evidence: Evidence,
    /// One for each pair of multipliers, by increasing real part of μ.
    pub multipliers: Vec<Multiplier>,
    pub instabilities: Vec<Instability>,
    /// The exact count of the μ, where exact arithmetic decided.
    pub roots: Option<MuCount>,
    /// The results for one oscillator beside its multiplier.
    pub oscillator: Option<Clocked>,
    /// An enclosure of the largest ln |λ| over the period, where it is known though not every multiplier is;
    /// infinite above where only the least is proven.
    pub largest: Option<(f64, f64)>,
}

impl Part {
    /// One of `size` degrees of freedom, all of its system's, what was decided of it and by what.
    pub fn new(
        size: usize,
        period: Laurent,
        (kind, evidence): (Option<Kind>, Evidence),
        (multipliers, instabilities): (Vec<Multiplier>, Vec<Instability>),
    ) -> Self {
        let (dofs, roots, oscillator, largest) = ((0..size).collect(), None, None, None);
        Part { dofs, size, period, kind, evidence, multipliers, instabilities, roots, oscillator, largest }
    }

    /// The name of the kind in documents.
    pub fn kind_name(&self) -> &'static str {
        name(self.kind)
    }

    /// An enclosure of the largest ln |λ|/T, per unit time, (0, 0) where nothing grows exponentially; `None`:
    /// not bounded.
    pub fn growth_rate(&self) -> Option<(f64, f64)> {
        if !matches!(self.kind, Some(Kind::Hyperbolic) | None) {
            return Some((0.0, 0.0));
        }
        if let Some(largest) = self.largest {
            return Some(rate::per_time(largest, &self.period));
        }
        let growth =
            self.multipliers.iter().map(|multiplier| multiplier.growth).collect::<Option<Vec<_>>>()?;
        let complete = (growth.len() >= self.size).then(|| rate::largest(growth.into_iter()))?;
        Some(rate::per_time(complete, &self.period))
    }

    /// The growth rate of one of its multipliers, enclosed, per unit time.
    pub fn growth_rate_of(&self, multiplier: &Multiplier) -> Option<(f64, f64)> {
        match self.kind {
            Some(Kind::Hyperbolic) | None => Some(rate::per_time(multiplier.growth?, &self.period)),
            _ => Some((0.0, 0.0)),
        }
    }
}

/// One oscillator under its clocks: the results of the paper for two of them.
#[derive(Clone, Debug)]
pub struct Clocked {
    /// Tr Q.
    pub trace: Ball,
    /// N_k = T/h_k.
    pub strikes: Vec<u64>,
    /// m, the half turns of the growing solution in a period, where it grows and they were counted.
    pub label: Option<u64>,
    /// The families of the resonance, 1/T½ = Σ a_k/h_k with m = Σ a_k N_k: the shortest first.
    pub families: Vec<Vec<i64>>,
}

/// The answer for a whole system.
#[derive(Clone, Debug)]
pub struct Analysis {
    /// Degrees of freedom.
    pub size: usize,
    /// The number of clocks.
    pub clocks: usize,
    /// T, the synchronization period.
    pub period: Laurent,
    /// Hyperbolic if any part is, else not decided (`None`) if any part is not, else parabolic, else
    /// coexistence, else elliptic; each over its own period, by every route.
    pub kind: Option<Kind>,
    /// The common null vectors of all potentials: they drift freely and are set apart.
    pub rigid_modes: Vec<Vec<Rational>>,
    pub parts: Vec<Part>,
    /// Warnings beside the verdict.
    pub warnings: Vec<String>,
    /// How far the verdict stands, where stiffnesses were measured.
    pub measured: Option<Measured>,
}

impl Analysis {
    /// Whether every pair of multipliers is there: of large parts those that grow fastest are alone.
    pub fn has_all_multipliers(&self) -> bool {
        self.parts.iter().all(|part| part.multipliers.len() >= part.size)
    }

    /// The analysis of a system that is one part.
    pub(crate) fn of_part(part: Part, clocks: usize, warnings: Vec<String>) -> Self {
        Analysis {
            size: part.dofs.len(),
            clocks,
            period: part.period.clone(),
            kind: part.kind,
            rigid_modes: Vec::new(),
            parts: vec![part],
            warnings,
            measured: None,
        }
    }

    /// Whether powers of the propagator are proven to stay bounded, rigid modes apart.
    pub fn is_stable(&self) -> bool {
        self.holds() == Holds::Stable
    }

    /// Whether they are proven not to.
    pub fn is_unstable(&self) -> bool {
        self.holds() == Holds::Unstable
    }

    /// Whether the kind is decided: every decision is proven.
    pub fn is_proof(&self) -> bool {
        self.kind.is_some()
    }

    /// The verdict, as far as it is proven.
    pub fn holds(&self) -> Holds {
        self.kind.into()
    }

    /// The verdict that is proven of all stiffnesses within `times` their accuracy, 0 of those given.
    pub fn within(&self, times: f64) -> Holds {
        let reaches = |measured: &Measured| {
            times == 0.0 || measured.margin.is_some_and(|margin| times * measured.accuracy <= margin)
        };
        if self.measured.as_ref().is_none_or(reaches) { self.holds() } else { Holds::Undecided }
    }

    /// The name of the kind in documents.
    pub fn kind_name(&self) -> &'static str {
        name(self.kind)
    }

    /// An enclosure of the largest growth rate per unit time, (0, 0) where nothing grows exponentially;
    /// `None`: not bounded.
    pub fn growth_rate(&self) -> Option<(f64, f64)> {
        let rates = self.parts.iter().map(Part::growth_rate).collect::<Option<Vec<_>>>()?;
        Some(rate::largest(rates.into_iter()))
    }

    /// That rate at a step, rounded; `None` where it is not known to a quarter, nor to be less than 10^-3 a
    /// step.
    pub fn rounded_rate(&self, step: f64) -> Option<f64> {
        let known = |(lo, hi): &(f64, f64)| hi - lo <= 0.25 * lo || hi * step <= 1e-3;
        self.growth_rate().filter(known).map(rate::middle)
    }
}

/// The name of a kind in documents.
pub fn name(kind: Option<Kind>) -> &'static str {
    kind.map_or("not decided", Kind::name)
}
