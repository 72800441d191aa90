//! Many degrees of freedom with friction: the eigenvalues of the whole period in doubles, within proven discs.

use faer::Mat;

use super::damping::Damping;
use super::masking::masking;
use super::scalar::damped;
use crate::error::{Error, Result};
use crate::number::rational::{from_f64_exact, to_f64};
use crate::number::{Ball, Laurent, Rational, Real, U};
use crate::propagator::Oscillator;
use crate::system::ManyClocks;
use crate::system::half::compose::{Kick, connected_parts};
use crate::system::half::float::scaled_program;
use crate::system::half::norm;
use crate::system::half::period::{Drifts, Stiff, Stiffness, follow};
use crate::system::linear::frame::Frame;
use crate::system::linear::system::System;
use crate::system::signs::inertia::is_definite;
use crate::system::spectrum::discs::{components, residual};
use crate::system::verdict::decide::decide_by;
use crate::system::verdict::limits::{Limits, Route, degrees_of_freedom};
use crate::system::verdict::measured::Holds;
use crate::verdict::{self, Tier};

/// The effect of friction on a system.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// γ, per unit time.
    pub rate: Rational,
    /// Where the spectral radius lies, rigid motions apart; `None`: doubles cannot decide.
    pub damping: Option<Damping>,
    /// ln ρ(Q)/T of the part where it is largest, enclosed, per unit time: below 0 the slowest decay, above 0 the growth;
    /// `None` where doubles bound nothing.
    pub growth: Option<(f64, f64)>,
    /// The friction that masks every resonance.
    pub masking: Mask,
}

/// Whether there is something to mask, and by which friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mask {
    /// Nothing grows without friction, which is proven (many degrees of freedom: without or at one of 10^-6 a period).
    NotNeeded,
    /// Something does, and this masks it.
    At(Masked),
    /// Not found: no friction that is proven to mask, a period too long for the polynomial in c, or doubles that cannot decide whether
    /// anything grows.
    NotTold,
}

impl Mask {
    /// The friction that masks both.
    fn and(self, other: Mask) -> Mask {
        match (self, other) {
            (Mask::NotNeeded, one) | (one, Mask::NotNeeded) => one,
            (Mask::At(a), Mask::At(b)) => Mask::At(Masked {
                rate: (a.rate.0.max(b.rate.0), a.rate.1.max(b.rate.1)),
                stays: a.stays.zip(b.stays).map(|(a, b)| a && b),
            }),
            _ => Mask::NotTold,
        }
    }
}

/// The friction that masks the resonances of a system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Masked {
    /// One oscillator: γ* is in \[lo, hi\], every smaller friction leaves it growing. More of them: at lo something is proven
    /// to grow, at hi nothing does.
    pub rate: (f64, f64),
    /// Whether every friction above hi is proven to mask, too; `None`: not asked (many degrees of freedom).
    pub stays: Option<bool>,
}

/// The relative width to which a masking friction of many degrees of freedom is bisected: what linear theory is good for.
const WIDTH: f64 = 1e-4;

/// The effect of friction of the rate γ per unit time on a system, and the friction that masks its resonances.
///
/// # Errors
/// A rate that is not positive; budget errors, before the work.
pub fn damped_system(system: &System, rate: &Rational, limits: &Limits) -> Result<Friction> {
    if *rate <= Rational::default() {
        return Err(Error::input("friction", rate, "a rate of friction must be positive"));
    }
    let parts = parts(system);
    // With friction the drifts of a part end where those of the others do.
    let ticking: Vec<_> = parts.iter().map(System::with_silent_clocks).collect();
    for part in &ticking {
        let n = part.size() as u64;
        let kicks = part.schedule().strikes();
        // Some 60 eigenvalue problems of 2n rows to bisect, each 25 (2n)³.
        let cost = n
            .pow(3)
            .saturating_mul(if n > 1 { 12_000 } else { 0 })
            .saturating_add(kicks.saturating_mul(2 * n.pow(3)));
        limits
            .allow(cost, || format!("the eigenvalues of a period of {}", degrees_of_freedom(part.size())))?;
    }
    let all = parts.iter().zip(&ticking).map(|(part, ticking)| damped_part(part, ticking, rate, limits));
    let all = all.collect::<Result<Vec<_>>>()?;
    let growth = all.iter().map(|own| own.growth).collect::<Option<Vec<_>>>();
    Ok(Friction {
        rate: rate.clone(),
        damping: worst(all.iter().map(|own| own.damping)),
        growth: growth.and_then(|all| all.into_iter().reduce(|a, b| (a.0.max(b.0), a.1.max(b.1)))),
        masking: all.iter().map(|own| own.masking).fold(Mask::NotNeeded, Mask::and),
    })
}

/// As [`damped_system`], for one part, which ticks with all clocks of the whole.
fn damped_part(part: &System, ticking: &System, rate: &Rational, limits: &Limits) -> Result<Friction> {
    if let Some(clocks) = ticking.as_many_clocks() {
        let unit = Laurent::from_rational(ticking.clocks()[0].step.clone());
        return damped_oscillator(&clocks, &unit, rate);
    }
    let (damping, growth) = at(ticking, rate);
    Ok(Friction { rate: rate.clone(), damping, growth, masking: masked(part, ticking, limits)? })
}

/// As [`damped_system`], for a pair of steps.
///
/// # Errors
/// As [`damped`]; a period of more kicks than the limits allow.
pub fn damped_pair(oscillator: &Oscillator, rate: &Rational, limits: &verdict::Limits) -> Result<Friction> {
    let two = oscillator.clocks()?;
    limits.allow(two.ratio().kicks(), Tier::Refine)?;
    let steps = [Rational::from_integer(1.into()), Rational::new(two.p().into(), two.q().into())];
    let strengths = vec![two.fast().clone(), two.slow().clone()];
    let clocks = ManyClocks::new(&steps, &[Rational::default(), Rational::default()], strengths)?;
    damped_oscillator(&clocks, oscillator.h1(), rate)
}

/// As [`damped_system`], for K clocks on one oscillator, whose stiffnesses and steps may involve π; `unit` is h_1, the unit of time of the
/// clocks, and γ is per unit of what `unit` is in.
///
/// # Errors
/// As [`damped`].
pub fn damped_oscillator<S: Real>(
    clocks: &ManyClocks<S>,
    unit: &Laurent,
    rate: &Rational,
) -> Result<Friction> {
    let own = damped(clocks, &(unit * &Laurent::from_rational(rate.clone())))?;
    let period = (unit * &Laurent::from_rational(clocks.period())).enclosure(BITS);
    let ln = own.radius.ln(BITS).and_then(|ln| ln.div(&period, BITS));
    let per_time =
        |rate: &Ball| rate.div(&unit.enclosure(BITS), BITS).expect("a step > 0").to_f64_enclosure();
    Ok(Friction {
        rate: rate.clone(),
        damping: Some(own.damping),
        growth: ln.map(|ln| ln.to_f64_enclosure()),
        masking: match masking(clocks) {
            Ok(None) => Mask::NotNeeded,
            Ok(Some(mask)) => Mask::At(Masked { rate: per_time(&mask.rate), stays: Some(mask.stays) }),
            Err(_) => Mask::NotTold,
        },
    })
}

/// Bits of the quotients that are given.
const BITS: u32 = 128;

/// Growing if any part is; else `None` if any part is undecided.
fn worst(parts: impl Iterator<Item = Option<Damping>>) -> Option<Damping> {
    let all: Vec<_> = parts.collect();
    if all.contains(&Some(Damping::Growing)) {
        return Some(Damping::Growing);
    }
    let all = all.into_iter().collect::<Option<Vec<_>>>()?;
    Some(if all.contains(&Damping::Marginal) { Damping::Marginal } else { Damping::Damped })
}

/// The connected components, rigid modes left out.
fn parts(system: &System) -> Vec<System> {
    let own = |dofs: Vec<usize>| {
        let component = system.component(&dofs)?;
        let frame = Frame::new(&component);
        if frame.rigid.is_empty() {
            return Some(component);
        }
        let space = frame.complement(&component);
        (!space.is_empty()).then(|| component.restricted(&space))
    };
    connected_parts(system).into_iter().filter_map(own).collect()
}

type At = (Option<Damping>, Option<(f64, f64)>);

/// Where ρ lies, and ln ρ/T.
fn at(part: &System, rate: &Rational) -> At {
    let frame = Frame::whole(part.size());
    let (program, _) = scaled_program(part, &frame);
    // Entries within one rounding of the true ones are in the bound of [`follow`].
    let stiff =
        |kick: &Kick<f64>| Stiff { stiffness: Stiffness::Rows(kick.rows.clone()), off: 0.0, known: 0.0 };
    let kicks: Vec<_> = program.kicks.iter().map(stiff).collect();
    let drifts = Drifts { inverse_mass: &program.inverse_mass, decay: &(rate * part.tick()), off: 0.0 };
    let q = follow(&drifts, part.schedule().symmetric_period(), |_, clock| &kicks[clock]);
    let Some(error) = q.error else { return (None, None) };
    let radius = Radius::of(&q.matrix(), error);
    (damping(&q.matrix(), error, radius), radius.map(|own| own.growth(to_f64(&part.period()))))
}

/// Where the spectral radius of all matrices within `error` (2-norm) of q lies: by its enclosure, or, near double eigenvalues where that is
/// wide, by a form that each of them shrinks.
pub(in crate::system) fn damping(q: &Mat<f64>, error: f64, radius: Option<Radius>) -> Option<Damping> {
    let by_radius = radius.and_then(Radius::damping);
    by_radius.or_else(|| shrinks_a_form(q, error).then_some(Damping::Damped))
}

/// Whether P − Qᵀ P Q > 0 for some P > 0 and all Q within `error` (2-norm) of q, so that their spectral radius is below 1 (Stein): tried with
/// P = Σ (qᵏ)ᵀ qᵏ, in doubles, for which it would be the identity less what the sum leaves out.
fn shrinks_a_form(q: &Mat<f64>, error: f64) -> bool {
    const DOUBLINGS: usize = 48;
    let n = q.nrows();
    let (mut power, mut p) = (q.clone(), Mat::<f64>::identity(n, n));
    for _ in 0..DOUBLINGS {
        let size = norm::frobenius(&power);
        if !size.is_finite() || size < 0.5 {
            break;
        }
        p = &p + power.transpose() * &p * &power;
        power = &power * &power;
    }
    let symmetric = |x: &Mat<f64>| Mat::from_fn(n, n, |i, j| (x[(i, j)] + x[(j, i)]) / 2.0);
    let p = symmetric(&p);
    let (size_q, size_p) = (norm::frobenius(q), norm::frobenius(&p));
    let rounding = 1.1 * U * ((2 * n + 8) as f64 * size_q * size_q + 4.0) * size_p;
    let slack = 1.01 * (rounding + error * (2.0 * size_q + error) * size_p);
    let rest = symmetric(&(&p - q.transpose() * &p * q));
    slack.is_finite() && is_definite(rest, slack) && is_definite(p, 0.0)
}

/// An enclosure of a spectral radius.
#[derive(Clone, Copy, Debug)]
pub(in crate::system) struct Radius {
    lo: f64,
    hi: f64,
}

impl Radius {
    /// For all matrices within `error` (2-norm) of q: no eigenvalue lies outside the discs, and at least one in each of their connected
    /// components. `None` where doubles bound nothing.
    pub fn of(q: &Mat<f64>, error: f64) -> Option<Radius> {
        let eigen = q.eigen().ok()?;
        let values: Vec<_> = (0..q.nrows()).map(|i| eigen.S()[i]).collect();
        let radius = 1.01 * residual(q, error + U * norm::frobenius(q), &values, &eigen.U().to_owned())?.norm;
        let far = values.iter().map(|z| z.norm()).fold(0.0, f64::max);
        let least = |component: &Vec<usize>| {
            component.iter().map(|&i| values[i].norm()).fold(f64::INFINITY, f64::min)
        };
        let lower = components(&values, radius).iter().map(least).fold(0.0, f64::max);
        Some(Radius { lo: (lower - radius).next_down(), hi: (far + radius).next_up() })
    }

    /// `None` where 1 lies inside.
    pub fn damping(self) -> Option<Damping> {
        if self.hi < 1.0 { Some(Damping::Damped) } else { (self.lo > 1.0).then_some(Damping::Growing) }
    }

    /// ln ρ/T, the period within 4u: beside the quotient's, ln x is off by some roundings of |ln x| + 1.
    pub fn growth(self, period: f64) -> (f64, f64) {
        let [lo, hi] = [self.lo.max(f64::MIN_POSITIVE), self.hi].map(f64::ln);
        ((lo - 10.0 * U * (lo.abs() + 1.0)) / period, (hi + 10.0 * U * (hi.abs() + 1.0)) / period)
    }
}

/// The friction that masks what grows in a part, which ticks with all clocks of the whole.
fn masked(part: &System, ticking: &System, limits: &Limits) -> Result<Mask> {
    let side = |rate: f64| at(ticking, &from_f64_exact(rate).expect("finite")).0;
    // A friction that is next to none: does anything grow?
    let period = to_f64(&ticking.period());
    let mut lo = 1e-6 / period;
    match side(lo) {
        Some(Damping::Growing) => {}
        None if decide_by(Route::Cheapest, part, limits)?.holds() != Holds::Stable => {
            return Ok(Mask::NotTold);
        }
        _ => return Ok(Mask::NotNeeded),
    }
    let mut all = (0..=40).map(|k| 2f64.powi(k) / period);
    let Some(mut hi) = all.find(|&rate| side(rate) == Some(Damping::Damped)) else {
        return Ok(Mask::NotTold);
    };
    while hi > lo * (1.0 + WIDTH) {
        let middle = if hi > 4.0 * lo { (lo * hi).sqrt() } else { (lo + hi) / 2.0 };
        match side(middle) {
            Some(Damping::Growing) => lo = middle,
            Some(Damping::Damped) => hi = middle,
            // So near to 1 that doubles cannot decide: the bracket is as narrow as it gets.
            _ => break,
        }
    }
    Ok(Mask::At(Masked { rate: (lo, hi), stays: None }))
}
