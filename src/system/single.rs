//! One degree of freedom under any number of clocks.

use num_complex::Complex64;

use super::ManyClocks;
use super::analysis::{Evidence, Instability, Multiplier, Part};
use super::float;
use super::frame::Frame;
use super::model::System;
use super::modes::{Origin, Resonance};
use super::scalar::shortest_family;
use crate::error::{Error, Result};
use crate::number::rational::to_f64;
use crate::number::{Ball, Rational, Sign};
use crate::verdict::{self, Kind, Limits, PartialSigns, Tier, Verdict, growth};

/// A trace, a label: what the kernels tell of one oscillator.
struct Scalar {
    verdict: Verdict,
    tier: Tier,
    /// μ = (Tr − 2)/4.
    mu: Ball,
    label: Option<u64>,
}

const BITS: u32 = 128;

/// Labels are counted exactly up to this many kicks, of which each makes the numbers longer.
const COUNTED: u64 = 5_000;

/// The most kicks composed in fractions, each of which makes the numbers longer.
const EXACT: u64 = 50_000;

impl System {
    /// The system as K clocks on one oscillator; `None` unless it has one degree of freedom.
    pub fn as_many_clocks(&self) -> Option<ManyClocks<Rational>> {
        if self.size() != 1 {
            return None;
        }
        let first = &self.clocks()[0].step;
        let steps: Vec<_> = self.clocks().iter().map(|clock| &clock.step / first).collect();
        let phases: Vec<_> = self.clocks().iter().map(|clock| clock.phase.clone()).collect();
        let strength = |clock: &super::Potential| {
            first * &clock.step * clock.stiffness.get(0, 0) / self.mass().get(0, 0)
        };
        let strengths = self.clocks().iter().map(strength).collect();
        Some(ManyClocks::new(&steps, &phases, strengths).expect("the clocks of a checked system"))
    }
}

/// The verdict on a system of one degree of freedom; shapes are (1).
pub(super) fn decide(system: &System) -> Result<Part> {
    let clocks = system.as_many_clocks().expect("one degree of freedom");
    let scalar = match by_ladder(&clocks)? {
        Some(scalar) => scalar,
        None => by_doubles(system, &clocks).map_or_else(|| by_signs(&clocks), Ok)?,
    };
    let (lo, hi) = scalar.mu.to_f64_enclosure();
    let mu = scalar.mu.mid_f64();
    let multiplier = Multiplier::new(Complex64::new(mu, 0.0), Some((hi - mu).max(mu - lo)));
    let kind = scalar.verdict.kind();
    let instabilities = match kind {
        Kind::Hyperbolic => vec![instability(system, multiplier, scalar.label, scalar.verdict)],
        _ => Vec::new(),
    };
    Ok(Part {
        dofs: vec![0],
        size: 1,
        period: system.period(),
        kind,
        evidence: Evidence::Scalar(scalar.tier),
        multipliers: vec![multiplier],
        instabilities,
        roots: None,
    })
}

/// One or two clocks of phase 0: the certified ladder.
fn by_ladder(clocks: &ManyClocks<Rational>) -> Result<Option<Scalar>> {
    let Some(two) = clocks.as_two_clocks() else { return Ok(None) };
    let limits = Limits::default();
    let decision = verdict::decide(&two, &limits)?;
    let growth = growth(&two, decision.verdict, &limits)?;
    let mu = growth.trace.sub(&Ball::from_integer(&2.into()), BITS).scale2(-2);
    Ok(Some(Scalar { verdict: decision.verdict, tier: decision.decided_by, mu, label: growth.label }))
}

/// Any clocks: the signs that doubles prove.
fn by_doubles(system: &System, clocks: &ManyClocks<Rational>) -> Option<Scalar> {
    let blocks = float::half_period(system, &Frame::new(system));
    let error = blocks.error?;
    let certain = |x: f64| (x.abs() > error).then_some(if x > 0.0 { Sign::Positive } else { Sign::Negative });
    let (y, p) = (&blocks.y[0], &blocks.p[0]);
    let signs = PartialSigns { a: certain(y[0]), b: certain(y[1]), c: certain(p[0]), d: certain(p[1]) };
    let exact = |x: f64| Some(Ball::from_rational(&Rational::from_float(x)?, BITS));
    let around = |x: f64| Some(exact((x - error).next_down())?.union(&exact((x + error).next_up())?, BITS));
    let mu = around(y[1])?.mul(&around(p[0])?, BITS);
    Some(Scalar { verdict: signs.verdict()?, tier: Tier::Filter, mu, label: counted(clocks) })
}

/// Any clocks: exact signs.
fn by_signs(clocks: &ManyClocks<Rational>) -> Result<Scalar> {
    let kicks = clocks.schedule().strikes() / 2;
    if kicks > EXACT {
        return Err(Error::budget(format!(
            "exact signs of {kicks} kicks would take more than minutes (the limit is {EXACT}): choose steps with \
             simpler ratios"
        )));
    }
    let half = clocks.half_period();
    let mu = Ball::from_rational(&(&half[(0, 1)] * &half[(1, 0)]), BITS);
    Ok(Scalar { verdict: clocks.half_signs().verdict(), tier: Tier::Exact, mu, label: counted(clocks) })
}

fn counted(clocks: &ManyClocks<Rational>) -> Option<u64> {
    if clocks.schedule().strikes() <= COUNTED { clocks.label() } else { None }
}

fn instability(system: &System, multiplier: Multiplier, label: Option<u64>, verdict: Verdict) -> Instability {
    let period = to_f64(&system.period());
    let stiffness = system.total_stiffness().get(0, 0) / system.mass().get(0, 0);
    let w = to_f64(&stiffness).max(0.0).sqrt();
    let turns = w * period / std::f64::consts::PI;
    // m is even where Tr > 2 and odd where Tr < −2.
    let odd = f64::from(u8::from(verdict.side() < 0));
    let m = label.map_or((2.0 * ((turns - odd) / 2.0).round() + odd) as i64, |m| m as i64);
    let strikes: Vec<u64> = (0..system.clocks().len()).map(|k| system.strikes(k)).collect();
    let family = shortest_family(m, &strikes).unwrap_or_default();
    let resonance = Resonance { frequencies: (w, w), sign: 1, m, family, detuning: turns - m as f64 };
    Instability {
        multiplier,
        origin: Origin::RealPair,
        growth_rate: multiplier.lambda.norm().ln() / period,
        shape: vec![1.0],
        resonance: Some(resonance),
    }
}
