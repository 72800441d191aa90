//! One degree of freedom under any number of clocks.

use num_complex::Complex64;

use crate::ManyClocks;
use crate::half::compose::check_length;
use crate::half::float;
use crate::linear::frame::Frame;
use crate::linear::system::{Potential, System};
use crate::single::clocks::{shortest_families, shortest_family};
use crate::single::enclose;
use crate::spectrum::modes::{Origin, Resonance};
use crate::spectrum::rate;
use crate::spectrum::rate::Multiplier;
use crate::verdict::analysis::{Analysis, Clocked, Evidence, Instability, Part};
use crate::verdict::limits::Limits;
use clocks::verdict::{self, Decidable, Kind, PartialSigns, Tier, Verdict};
use number::{Ball, Laurent, Rational, Result, Ring, Sign, to_f64};

/// The results of the kernels for one oscillator: a trace, a label.
struct Scalar {
    verdict: Verdict,
    tier: Tier,
    /// μ = (Tr − 2)/4.
    mu: Ball,
    /// ln |λ| where it grows.
    growth: Option<Ball>,
    label: Option<u64>,
}

const BITS: u32 = 128;

/// Balls of 2^7 to 2^16 bits are tried, as long as kicks times bits stay below this: some seconds.
const BALL_WORK: u64 = 1 << 32;

/// Families listed of a resonance.
const FAMILIES: usize = 6;

impl System {
    /// The system as K clocks on one oscillator; `None` unless it has one degree of freedom.
    pub fn as_many_clocks(&self) -> Option<ManyClocks<Rational>> {
        if self.size() != 1 {
            return None;
        }
        let (clocks, first) = (self.clocks(), &self.clocks()[0].step);
        let steps: Vec<_> = clocks.iter().map(|clock| &clock.step / first).collect();
        let phases: Vec<_> = clocks.iter().map(|clock| clock.phase.clone()).collect();
        let unit = |clock: &Potential| first * &clock.step / self.mass().get(0, 0);
        let strengths = clocks.iter().map(|clock| unit(clock) * clock.stiffness.get(0, 0)).collect();
        Some(ManyClocks::new(&steps, &phases, strengths).expect("the clocks of a checked system"))
    }
}

/// The verdict on a system of one degree of freedom; shapes are (1).
pub fn decide(system: &System, limits: &Limits) -> Result<Part> {
    let clocks = system.as_many_clocks().expect("one degree of freedom");
    // In fractions each kick makes the numbers longer.
    let cost = |kicks: f64| 40.0 * kicks.powi(2);
    decide_clocks(&clocks, system, Laurent::from_rational(system.period()), cost, limits)
}

/// The verdict on K clocks with stiffnesses that may involve π, as the one part of a system.
///
/// `rounded` is the same oscillator with each stiffness/mass rounded to a rational of 64 bits, mass 1; `unit`
/// is h_1, the unit of time of `clocks`.
///
/// # Errors
/// A budget error where the decision would exceed the limits.
///
/// # Panics
/// Where `rounded` has not the clocks of `clocks`.
pub fn decide_oscillator(
    clocks: &ManyClocks<Laurent>,
    rounded: &System,
    unit: &Laurent,
    limits: &Limits,
) -> Result<Analysis> {
    assert_eq!(clocks.strikes().len(), rounded.clocks().len(), "one stiffness a clock");
    let period = Laurent::from_rational(clocks.period()) * unit.clone();
    let part = decide_clocks(clocks, rounded, period, with_pi, limits)?;
    let warnings = if rounded.is_total_semidefinite() {
        Vec::new()
    } else {
        vec!["the total stiffness is negative: the oscillator itself is unstable, whatever the steps".into()]
    };
    Ok(Analysis::of_part(part, clocks.strikes().len(), warnings))
}

/// The products of machine words that exact signs cost over ℚ\[π\], whose numbers grow with each kick in
/// length and in degree.
pub fn with_pi(kicks: f64) -> f64 {
    0.15 * kicks.powi(4)
}

/// That exact signs may be computed, whose cost depends so on the kicks of half a period.
///
/// # Errors
/// A budget error with the cost, before any work.
pub(crate) fn allow_signs<S: Ring>(
    clocks: &ManyClocks<S>,
    cost: impl Fn(f64) -> f64,
    limits: &Limits,
) -> Result<()> {
    let kicks = clocks.schedule().strikes() / 2;
    limits.allow(cost(kicks as f64) as u64, || format!("exact signs of {kicks} kicks"))
}

/// By the ladder, by doubles, by balls, or by exact signs, whose cost `exact` gives by the number of kicks.
fn decide_clocks<S: Decidable>(
    clocks: &ManyClocks<S>,
    rounded: &System,
    period: Laurent,
    exact: impl Fn(f64) -> f64,
    limits: &Limits,
) -> Result<Part> {
    let scalar = match by_ladder(clocks, limits)? {
        Some(scalar) => scalar,
        None => {
            check_length(rounded, limits)?;
            match by_doubles(rounded, clocks).or_else(|| by_balls(clocks)) {
                Some(scalar) => scalar,
                None => by_signs(clocks, exact, limits)?,
            }
        }
    };
    let (lo, hi) = scalar.mu.to_f64_enclosure();
    let mu = scalar.mu.mid_f64();
    let growth = scalar.growth.as_ref().map_or((0.0, 0.0), Ball::to_f64_enclosure);
    let multiplier = Multiplier::new(Complex64::new(mu, 0.0), Some((hi - mu).max(mu - lo)), Some(growth));
    let kind = scalar.verdict.kind();
    let strikes = clocks.strikes();
    let trace = scalar.mu.scale2(2).add(&Ball::from_integer(&2.into()), BITS);
    let families = scalar.label.map_or_else(Vec::new, |m| shortest_families(m as i64, &strikes, FAMILIES));
    let instabilities = match kind {
        Kind::Hyperbolic => vec![instability(rounded, &period, multiplier, &scalar)],
        _ => Vec::new(),
    };
    let decided = (Some(kind), Evidence::Scalar(scalar.tier));
    let part = Part::new(1, period, decided, (vec![multiplier], instabilities));
    let oscillator = Some(Clocked { trace, strikes, label: scalar.label, families });
    Ok(Part { oscillator, ..part })
}

/// One or two clocks of phase 0: the certified ladder.
fn by_ladder<S: Decidable>(clocks: &ManyClocks<S>, limits: &Limits) -> Result<Option<Scalar>> {
    let Some(two) = clocks.as_two_clocks() else { return Ok(None) };
    let found = || {
        let answer = verdict::decide(&two, &limits.of_ladder())?;
        let mu = answer.trace()?.sub(&Ball::from_integer(&2.into()), BITS).scale2(-2);
        let growth = answer.growth()?.ln_multiplier.clone();
        Ok(Scalar { verdict: answer.verdict, tier: answer.decided_by, mu, growth, label: answer.label()? })
    };
    found().map(Some).map_err(Limits::in_products)
}

/// Any clocks: the signs that doubles prove. The bound of [`float`] has room for one more rounding of each
/// stiffness.
fn by_doubles<S: Decidable>(rounded: &System, clocks: &ManyClocks<S>) -> Option<Scalar> {
    let blocks = float::half_period(rounded, &Frame::whole(1));
    let error = blocks.error?;
    let certain = |x: f64| (x.abs() > error).then_some(if x > 0.0 { Sign::Positive } else { Sign::Negative });
    let entries = blocks.matrices.each_ref().map(|block| block[(0, 0)]);
    let [a, b, c, d] = entries.map(certain);
    let verdict = PartialSigns { a, b, c, d }.verdict()?;
    let exact = |x: f64| Some(Ball::from_rational(&Rational::from_float(x)?, BITS));
    let around = |x: f64| Some(exact((x - error).next_down())?.union(&exact((x + error).next_up())?, BITS));
    let [Some(a), Some(b), Some(c), Some(d)] = entries.map(around) else { return None };
    let (mu, label) = (b.mul(&c, BITS), labelled(clocks, verdict));
    let growth = growth(verdict, &mu, &a.mul(&d, BITS));
    // Beside an edge balls give more digits.
    let is_sharp = growth.as_ref().is_none_or(|growth| growth.relative_accuracy_bits() > SHARP);
    is_sharp.then_some(Scalar { verdict, tier: Tier::Filter, mu, growth, label })
}

/// Bits of a growth rate below which more are looked for.
const SHARP: i64 = 30;

/// ln |λ| = 2 asinh √(BC) for Tr > 2, 2 asinh √(−AD) for Tr < −2.
fn growth(verdict: Verdict, bc: &Ball, ad: &Ball) -> Option<Ball> {
    let excess = match (verdict.kind(), verdict.side() > 0) {
        (Kind::Hyperbolic, true) => bc.clone(),
        (Kind::Hyperbolic, false) => ad.neg(),
        _ => return None,
    };
    Some(excess.sqrt_clipped(BITS)?.asinh(BITS).scale2(1))
}

/// The precisions that balls are worth trying at.
fn precisions<S: Decidable>(clocks: &ManyClocks<S>) -> impl Iterator<Item = u32> {
    let kicks = clocks.schedule().strikes();
    (7..=16).map(|log2| 1u32 << log2).take_while(move |&bits| kicks.saturating_mul(bits.into()) < BALL_WORK)
}

/// Any clocks: the signs that balls decide.
fn by_balls<S: Decidable>(clocks: &ManyClocks<S>) -> Option<Scalar> {
    precisions(clocks).find_map(|bits| {
        let half = enclose::run(clocks, bits);
        let verdict = half.verdict()?;
        let label = half.label(verdict).filter(|_| verdict.kind() == Kind::Hyperbolic);
        let [bc, ad] = half.products(BITS);
        let growth = growth(verdict, &bc, &ad);
        let is_sharp = growth.as_ref().is_none_or(|growth| growth.relative_accuracy_bits() > SHARP);
        is_sharp.then_some(Scalar { verdict, tier: Tier::Refine, mu: bc, growth, label })
    })
}

/// m, where balls count it.
fn labelled<S: Decidable>(clocks: &ManyClocks<S>, verdict: Verdict) -> Option<u64> {
    if verdict.kind() != Kind::Hyperbolic {
        return None;
    }
    precisions(clocks).find_map(|bits| enclose::run(clocks, bits).label(verdict))
}

/// Any clocks: exact signs.
fn by_signs<S: Decidable>(
    clocks: &ManyClocks<S>,
    cost: impl Fn(f64) -> f64,
    limits: &Limits,
) -> Result<Scalar> {
    allow_signs(clocks, cost, limits)?;
    let half = clocks.half_period();
    let mu = S::product(&half[(0, 1)], &half[(1, 0)]).enclosure(BITS);
    let ad = S::product(&half[(0, 0)], &half[(1, 1)]).enclosure(BITS);
    let verdict = clocks.half_signs().verdict();
    let growth = growth(verdict, &mu, &ad);
    Ok(Scalar { verdict, tier: Tier::Exact, mu, growth, label: clocks.label() })
}

fn instability(rounded: &System, period: &Laurent, multiplier: Multiplier, scalar: &Scalar) -> Instability {
    // The frequency in the units of `rounded`, whose period is T there.
    let stiffness = rounded.total_stiffness().get(0, 0) / rounded.mass().get(0, 0);
    let w = to_f64(&stiffness).max(0.0).sqrt();
    let turns = w * to_f64(&rounded.period()) / std::f64::consts::PI;
    // m is even where Tr > 2 and odd where Tr < −2.
    let odd = f64::from(u8::from(scalar.verdict.side() < 0));
    let m = scalar.label.map_or((2.0 * ((turns - odd) / 2.0).round() + odd) as i64, |m| m as i64);
    let strikes: Vec<u64> = (0..rounded.clocks().len()).map(|k| rounded.strikes(k)).collect();
    let family = shortest_family(m, &strikes).unwrap_or_default();
    let w = turns * std::f64::consts::PI / period.to_f64();
    let resonance = Resonance { frequencies: (w, w), sign: 1, m, family, detuning: turns - m as f64 };
    Instability {
        multiplier,
        origin: Origin::RealPair,
        growth_rate: multiplier.growth.map(|growth| rate::per_time(growth, period)),
        shape: vec![1.0],
        quadrature: vec![0.0],
        resonance: Some(resonance),
    }
}
