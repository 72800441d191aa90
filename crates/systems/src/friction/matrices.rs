//! Many degrees of freedom with friction: the eigenvalues of the whole period in doubles, within proven
//! discs.

use super::cells::Cells;
use super::damping::Damping;
use super::fixed::Fixed;
use super::masking::{Mask, Search};
use super::polynomial::Polynomials;
use super::powers::Powers;
use super::radius::{Radius, damping};
use super::tie::is_tie;
use crate::ManyClocks;
use crate::half::compose::{Kick, connected_parts};
use crate::half::float::scaled_program;
use crate::half::period::{Drifts, Stiff, Stiffness, follow};
use crate::linear::frame::Frame;
use crate::linear::sparse::Symmetric;
use crate::linear::system::{Potential, System};
use crate::verdict::decide::decide_by;
use crate::verdict::limits::{Limits, Route, degrees_of_freedom};
use clocks::propagator::Oscillator;
use clocks::verdict::{self, Kind};
use number::{Ball, Error, Laurent, Rational, Real, Result, Sign, U, from_f64_exact, to_f64};

/// The effect of friction on a system.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// γ, per unit time.
    pub rate: Rational,
    /// Where the spectral radius lies, rigid motions apart; `None`: doubles cannot decide.
    pub damping: Option<Damping>,
    /// ln ρ(Q)/T of the part where it is largest, enclosed, per unit time: below 0 the slowest decay, above 0
    /// the growth; `None` where doubles bound nothing.
    pub growth: Option<(f64, f64)>,
    /// The frictions that mask every resonance.
    pub masking: Mask,
}

/// The effect of friction of the rate γ per unit time on a system, and the friction that masks its
/// resonances.
///
/// # Errors
/// A rate that is not positive; budget errors, before the work.
pub fn damped_system(system: &System, rate: &Rational, limits: &Limits) -> Result<Friction> {
    let all =
        of_parts(system, rate, limits, |own, part| Ok((own.at_or_tie(rate), own.masked(part, limits)?)))?;
    let growth = all.iter().map(|((_, growth), _)| *growth).collect::<Option<Vec<_>>>();
    Ok(Friction {
        rate: rate.clone(),
        damping: worst(all.iter().map(|((damping, _), _)| *damping)),
        growth: growth.and_then(|all| all.into_iter().reduce(|a, b| (a.0.max(b.0), a.1.max(b.1)))),
        masking: all.into_iter().map(|(_, masking)| masking).fold(Mask::NotNeeded, Mask::and),
    })
}

/// What is found of each part at a friction, and the part as it ticks without any.
fn of_parts<T>(
    system: &System,
    rate: &Rational,
    limits: &Limits,
    found: impl Fn(&Damped, &System) -> Result<T>,
) -> Result<Vec<T>> {
    check(rate)?;
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
    parts.iter().zip(&ticking).map(|(part, ticking)| found(&Damped::new(ticking), part)).collect()
}

fn check(rate: &Rational) -> Result<()> {
    if *rate <= Rational::default() {
        return Err(Error::input("friction", rate, "a rate of friction must be positive"));
    }
    Ok(())
}

/// The spectral radius is 1, whatever the friction.
const TIE: At = (Some(Damping::Marginal), Some((0.0, 0.0)));

/// A kick of friction costs as much as so many without, as measured.
const A_DAMPED_KICK: u64 = 50;

/// That friction on a pair of steps is within the limits.
///
/// # Errors
/// A budget error, before the work; steps without a rational ratio.
pub fn allow_pair(oscillator: &Oscillator, limits: &verdict::Limits) -> Result<()> {
    let kicks = oscillator.clocks()?.ratio().kicks();
    let cost = kicks.saturating_mul(A_DAMPED_KICK);
    if cost <= limits.kicks {
        return Ok(());
    }
    let work = format!(
        "friction on {kicks} kicks costs as much as {cost} of them without, on the order of {} s; the budget is {}",
        cost.div_ceil(1_000_000),
        limits.kicks
    );
    Err(Error::budget(work, cost).or("choose steps with a simpler ratio"))
}

/// As [`damped_system`], for a pair of steps.
///
/// # Errors
/// As [`damped_oscillator`]; a period of more kicks than the limits allow.
pub fn damped_pair(oscillator: &Oscillator, rate: &Rational, limits: &verdict::Limits) -> Result<Friction> {
    let two = oscillator.clocks()?;
    allow_pair(oscillator, limits)?;
    let steps = [Rational::from_integer(1.into()), Rational::new(two.p().into(), two.q().into())];
    let strengths = vec![two.fast().clone(), two.slow().clone()];
    let clocks = ManyClocks::new(&steps, &[Rational::default(), Rational::default()], strengths)?;
    damped_oscillator(&clocks, oscillator.h1(), rate)
}

/// As [`damped_system`], for K clocks on one oscillator, whose stiffnesses and steps may involve π; `unit` is
/// h_1, the unit of time of the clocks, and γ is per unit of what `unit` is in.
///
/// # Errors
/// A rate that is not positive.
pub fn damped_oscillator<S: Real>(
    clocks: &ManyClocks<S>,
    unit: &Laurent,
    rate: &Rational,
) -> Result<Friction> {
    check(rate)?;
    if is_silent(clocks) {
        let (damping, growth) = TIE;
        return Ok(Friction { rate: rate.clone(), damping, growth, masking: Mask::NotNeeded });
    }
    let own = per_unit(rate, unit);
    let found = damped_system(&rounded(clocks)?, &own, &Limits::default())?;
    let (damping, growth) = match found.damping {
        None if is_tie(clocks) => TIE,
        damping => (damping, found.growth),
    };
    let unit = unit.to_f64();
    // A unit is rounded, and the quotient.
    let per_time = |(lo, hi): (f64, f64)| {
        (lo / unit - 4.0 * U * (lo / unit).abs(), hi / unit + 4.0 * U * (hi / unit).abs())
    };
    let masking = match found.masking {
        Mask::At(own) => Mask::At(own.per(unit)),
        other => other,
    };
    Ok(Friction { rate: rate.clone(), damping, growth: growth.map(per_time), masking })
}

/// Where the spectral radius lies, as [`damped_oscillator`] has it, without the frictions that mask.
///
/// # Errors
/// A rate that is not positive.
pub fn damping_of_oscillator<S: Real>(
    clocks: &ManyClocks<S>,
    unit: &Laurent,
    rate: &Rational,
) -> Result<Option<Damping>> {
    check(rate)?;
    if is_silent(clocks) {
        return Ok(TIE.0);
    }
    let own = per_unit(rate, unit);
    let all = of_parts(&rounded(clocks)?, &own, &Limits::default(), |part, _| Ok(part.at_or_tie(&own).0))?;
    Ok(worst(all.into_iter()).or_else(|| if is_tie(clocks) { TIE.0 } else { None }))
}

fn is_silent<S: Real>(clocks: &ManyClocks<S>) -> bool {
    clocks.strengths().iter().all(|k| k.sign() == Sign::Zero)
}

/// A rate in the unit of time of clocks.
fn per_unit(rate: &Rational, unit: &Laurent) -> Rational {
    near(&(unit * &Laurent::from_rational(rate.clone())))
}

/// Within 2^-200 of a number, relative to it: so that its rounding to a double is all that counts, and bounds
/// on long periods hold.
fn near(x: &impl Real) -> Rational {
    let balls = (7..20).map(|log2| x.enclosure(1 << log2));
    let found = balls.into_iter().find(|ball| ball.relative_accuracy_bits() > 200);
    found.map_or_else(Rational::default, |ball| ball.lower())
}

/// K clocks on one oscillator as a system of mass 1 in the unit of time h_1.
fn rounded<S: Real>(clocks: &ManyClocks<S>) -> Result<System> {
    let (schedule, one) = (clocks.schedule(), Rational::from_integer(1.into()));
    let potentials = schedule.clocks().iter().zip(clocks.strengths()).map(|(clock, strength)| {
        let step = schedule.tick() * Rational::from_integer(clock.step().into());
        let stiffness = Symmetric::diagonal(&[near(strength) / &step]);
        let phase = Rational::new(clock.offset().into(), clock.step().into());
        Potential { stiffness, step, phase }
    });
    System::new(Symmetric::diagonal(&[one]), potentials.collect())
}

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

/// A part with friction.
struct Damped<'a> {
    part: &'a System,
    period: f64,
}

impl<'a> Damped<'a> {
    fn new(part: &'a System) -> Damped<'a> {
        Damped { part, period: to_f64(&part.period()) }
    }

    /// Where ρ lies, and ln ρ/T; of a tie, too, which doubles do not tell.
    fn at_or_tie(&self, rate: &Rational) -> At {
        match self.at(rate) {
            (None, _) if self.part.as_many_clocks().is_some_and(|own| is_tie(&own)) => TIE,
            found => found,
        }
    }

    /// Where ρ lies, and ln ρ/T.
    fn at(&self, rate: &Rational) -> At {
        let one = (self.part.size() == 1).then(|| Fixed::new(self.part, rate)).flatten();
        if let Some((damping @ Some(_), own)) = one.map(|own| (own.damping(), own)) {
            return (damping, self.rate_of_one(&own));
        }
        let frame = Frame::whole(self.part.size());
        let (program, scales) = scaled_program(self.part, &frame);
        // Entries within one rounding of the true ones are in the bound of [`follow`].
        let stiff =
            |kick: &Kick<f64>| Stiff { stiffness: Stiffness::Rows(kick.rows.clone()), off: 0.0, known: 0.0 };
        let kicks: Vec<_> = program.kicks.iter().map(stiff).collect();
        let decay = rate * self.part.tick();
        let drifts = Drifts { inverse_mass: &program.inverse_mass, decay: &decay, off: 0.0 };
        let q = follow(&drifts, self.part.schedule().symmetric_period(), |_, clock| &kicks[clock]);
        let (q, error) = match q.error {
            Some(error) => (q.matrix(), error),
            // Where velocities have all but stopped.
            None => match Fixed::new(self.part, rate) {
                Some(own) => own.rounded(&scales),
                None => return (None, None),
            },
        };
        let radius = Radius::of(&q, error);
        (damping(&q, error, radius), radius.map(|own| own.growth(self.period)))
    }

    fn rate_of_one(&self, own: &Fixed) -> Option<(f64, f64)> {
        Some(own.ln_radius()?.div(&Ball::from_rational(&self.part.period(), 64), 64)?.to_f64_enclosure())
    }

    /// The frictions that mask what grows in a part, which ticks with all clocks of the whole.
    fn masked(&self, part: &System, limits: &Limits) -> Result<Mask> {
        let exact = |rate: f64| from_f64_exact(rate).expect("finite");
        let side = |rate: f64| self.at(&exact(rate)).0;
        // A friction that is next to none: does anything grow?
        let least = 1e-6 / self.period;
        let grows = match side(least) {
            Some(Damping::Growing) => least,
            None => match decide_by(Route::Cheapest, part, limits)?.kind {
                Some(kind) if kind.is_stable() => return Ok(Mask::NotNeeded),
                // Without any.
                Some(Kind::Hyperbolic) => 0.0,
                _ => return Ok(Mask::Undecided),
            },
            _ => return Ok(Mask::NotNeeded),
        };
        let powers = Powers::new(self.part);
        if let Some(found) = powers.as_ref().and_then(Polynomials::new).and_then(|own| own.above(grows)) {
            return Ok(found);
        }
        let cells = powers.map(|own| Cells::new(own, self.part));
        let up = cells.as_ref().map(|own| |from: f64| own.up(from));
        let search = Search {
            period: self.period,
            side: &side,
            up: up.as_ref().map(|up| up as &dyn Fn(f64) -> f64),
            per_octave: if self.part.size() <= FEW { 4 } else { 1 },
            width: NEAR_EDGE,
        };
        Ok(search.above(grows))
    }
}

/// The relative width to which the least friction that masks is bisected.
const NEAR_EDGE: f64 = 1e-4;

/// Degrees of freedom whose frictions are looked at closely.
const FEW: usize = 8;
