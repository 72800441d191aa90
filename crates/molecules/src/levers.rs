//! Levers, changes that would let the outer step grow: other masses, constraints, methods and ratios, each
//! with its own proof.
//!
//! A lever is the question with one thing changed. A lever of r-RESPA (kicks and drifts) is proven by the
//! first region of the levels; one of mollified kicks by the edge of all coupled modes
//! ([`Trigonometric::coupled_edge`](words::Trigonometric::coupled_edge)), for Hessians by the band of their
//! modes ([`Kernel::band_edge`](systems::levels::Kernel::band_edge)). Two methods have no resonance with the
//! fast modes at all: with the fast forces by the midpoint rule a step is stable iff h² S < 4 (and F +
//! S > 0), whatever F (proofs/ImplicitExplicit.v); MOLLY by the equilibrium does not kick the fast modes. A
//! lever that cannot be computed is left out, with the reason.

use num_bigint::BigInt;
use num_traits::{One, Zero};

use super::caps::{Bound, Caps};
use super::constraint::Constraints;
use super::engine::not_nested;
use super::levels::{Levels, Scheme, scaled};
use super::lever::{Lever, Way};
use super::mode::Mode;
use super::question::Question;
use super::unit::{TimeUnit, decimal};
use number::rational::enclose_f64;
use number::{Ball, Laurent, Rational, Real, Result, from_f64_exact, ratio};
use words::Trigonometric;

const BITS: u32 = 96;

/// All levers of the first scheme, and what was left out and why.
#[derive(Clone, Debug, Default)]
pub struct Levers {
    pub rows: Vec<Lever>,
    pub left_out: Vec<String>,
}

/// The masses of heavy hydrogens, in amu.
pub fn heavy() -> [Rational; 2] {
    [ratio(3024, 1000), ratio(4, 1)]
}

/// Ratios of the outermost step to the one before it.
pub const RATIOS: std::ops::RangeInclusive<u64> = 2..=16;

/// Other methods, by name.
pub const SOLVED: [(&str, Way); 4] = [
    ("short-average MOLLY", Way::Molly(Trigonometric::Short)),
    ("linear-average MOLLY", Way::Molly(Trigonometric::Linear)),
    ("long-average MOLLY", Way::Molly(Trigonometric::Long)),
    ("implicit-explicit", Way::ImplicitExplicit),
];

/// Innermost steps of other ratios are multiples of this, in fs.
pub(super) fn least() -> Rational {
    ratio(1, 100)
}

/// The most outer steps that a friction is tried at.
pub(super) const MOST_MASKED: u64 = 200;

impl Question {
    /// The levers that would let the outer step of the first scheme grow.
    ///
    /// # Errors
    /// A budget error, as of the answer.
    pub(super) fn levers(&self) -> Result<Levers> {
        let mut all = Levers::default();
        let scheme = &self.schemes[0];
        if self.stiffest().iter().any(Option::is_none) || self.lacks_fast() {
            all.left_out
                .push("a clock has no period, so no levers are computed that would let the step grow".into());
            return Ok(all);
        }
        let way = if scheme.steps().len() == 1 { Way::Verlet } else { Way::Respa };
        all.rows.push(self.respa("as given".into(), way, scheme)?);
        self.heavier(&mut all)?;
        self.held(&mut all)?;
        match scheme.steps() {
            [_] => all.left_out.push("other ratios, MOLLY, implicit-explicit: there is one clock".into()),
            [_, _] => {
                self.other_methods(&mut all);
                self.ratios(&mut all)?;
            }
            _ => {
                all.left_out.push("MOLLY, implicit-explicit: they are computed for two clocks".into());
                self.ratios(&mut all)?;
            }
        }
        if let Some(rate) = &self.friction {
            match self.masked(scheme, rate) {
                Some(lever) => all.rows.push(lever),
                None => all.left_out.push(
                    "masked by the friction: not even the first step, or its period is too long".into(),
                ),
            }
        }
        all.compare();
        Ok(all)
    }

    /// Kicks and drifts with the inner steps of this scheme: the outermost one is a multiple of the one
    /// before it, and the edges are those at the ratio of the step to take, of the scheme itself where there
    /// is none.
    fn respa(&self, name: String, way: Way, scheme: &Scheme) -> Result<Lever> {
        let largest = self.largest(scheme)?;
        let one_clock = scheme.steps().len() == 1;
        let step = match self.caps().safe(scheme, largest.as_ref()) {
            Some((step, bound)) if one_clock => multiple(&step, &self.least()).map(|step| (step, bound)),
            pair => pair,
        };
        let (first, band_edge) = match &step {
            Some((step, _)) if !one_clock && step == scheme.last_but_one() => {
                self.merged()?.edges(&scheme.merged()?)?
            }
            Some((step, _)) if !one_clock => self.edges(&scheme.with_outer(step.clone())?)?,
            _ => self.edges(scheme)?,
        };
        Ok(Lever {
            first: Some(first),
            band_edge: Some(band_edge),
            inner: if one_clock {
                step.as_ref().map(|(step, _)| step.clone())
            } else {
                Some(scheme.inner().clone())
            },
            step,
            ..Lever::new(name, way)
        })
    }

    /// The first unstable outer step at the ratio of a scheme, and the same for the shortest periods of the
    /// band.
    fn edges(&self, scheme: &Scheme) -> Result<((f64, f64), (f64, f64))> {
        let of = |i: Option<usize>| i.map_or_else(Laurent::zero, |i| self.modes[i].stiffness.clone());
        let levels = Levels { scheme, stiffness: self.stiffest().into_iter().map(of).collect() };
        let first = scaled(levels.first_region_ends()?, scheme.outer());
        Ok((first, self.shrunk(first)))
    }

    /// Periods that are shorter by the band make every length shorter by it.
    fn shrunk(&self, (lo, hi): (f64, f64)) -> (f64, f64) {
        let of =
            |x: f64| from_f64_exact(x).map_or((x, x), |x| enclose_f64(&(x * (Rational::one() - &self.band))));
        (of(lo).0, of(hi).1)
    }

    /// The same modes where the outermost step is the one before it: both are one clock.
    fn merged(&self) -> Result<Question> {
        let schemes = self.schemes.iter().map(Scheme::merged).collect::<Result<_>>()?;
        let last = self.clocks() - 2;
        let modes = self
            .modes
            .iter()
            .cloned()
            .map(|mode| Mode { clock: mode.clock.map(|clock| clock.min(last)), ..mode });
        Ok(Question { modes: modes.collect(), schemes, ..self.clone() })
    }

    /// Steps of other ratios are multiples of this: of 0.01 fs, or of about a thousandth of the fastest
    /// period of plain times.
    fn least(&self) -> Rational {
        if self.unit == TimeUnit::Femtoseconds {
            return least();
        }
        let fastest =
            self.faster().into_iter().map(|i| self.modes[i].period().0).fold(f64::INFINITY, f64::min);
        let power = (fastest.log10() - 3.0).round().clamp(-300.0, 300.0) as i32;
        Rational::from_integer(10.into()).pow(power)
    }

    /// This question about other modes.
    fn about(&self, modes: Vec<Mode>) -> Question {
        Question { modes, ..self.clone() }
    }

    fn heavier(&self, all: &mut Levers) -> Result<()> {
        let inner = self.faster();
        let no_bond: Vec<&str> = inner
            .iter()
            .map(|&i| &self.modes[i])
            .filter(|mode| mode.bond.is_none())
            .map(|mode| mode.name.as_str())
            .collect();
        let why = if !no_bond.is_empty() {
            format!(
                "{} without masses: give a bond, as --bond OH:K=450kcal/mol/A^2,15.999,1.008",
                no_bond.join(", ")
            )
        } else if inner.iter().all(|&i| self.modes[i].is_bond_with_hydrogen() != Some(true)) {
            "no bond has a hydrogen".into()
        } else if inner.iter().any(|&i| self.modes[i].bond.as_ref().is_some_and(|bond| bond.heavy.is_some()))
        {
            "the hydrogens are heavy already".into()
        } else {
            for mass in heavy() {
                match self.modes.iter().map(|mode| mode.with_hydrogens(&mass)).collect() {
                    Ok(modes) => {
                        let name = format!("hydrogens of {} amu", decimal(&mass));
                        all.rows.push(self.about(modes).respa(name, Way::Hydrogens, &self.schemes[0])?);
                    }
                    Err(error) => {
                        all.left_out.push(format!("hydrogens of {} amu: {}", decimal(&mass), error.remedy()))
                    }
                }
            }
            return Ok(());
        };
        all.left_out.push(format!("heavy hydrogens: {why}"));
        Ok(())
    }

    /// Without the bonds that have hydrogens. What is left has no hydrogen's mass to change: then both levers
    /// are one.
    fn held(&self, all: &mut Levers) -> Result<()> {
        let left = |why: &str| format!("h-bonds held: {why}");
        let (free, held) = match Constraints::HBonds.split(self.modes.clone()) {
            Ok(split) => split,
            Err(_) => (Vec::new(), self.modes.clone()),
        };
        if held.is_empty() {
            let why = if self.held.is_empty() {
                "no mode is given as a bond with a hydrogen"
            } else {
                "they are held as it is"
            };
            all.left_out.push(left(why));
            return Ok(());
        }
        let other = self.about(free);
        if other.modes.is_empty() || other.stiffest().iter().any(Option::is_none) {
            all.left_out.push(left(
                "no other mode is on the fast clocks: give the fastest period that is left, as angle=19.45fs",
            ));
            return Ok(());
        }
        all.rows.push(other.respa("h-bonds held".into(), Way::Held, &self.schemes[0])?);
        all.left_out
            .push("h-bonds held and heavy hydrogens: the periods that are left have no masses".into());
        Ok(())
    }

    /// Other methods on two clocks, the stiffest mode on each.
    fn other_methods(&self, all: &mut Levers) {
        let shorter = Rational::one() - &self.band;
        let factor = Laurent::from_rational((&shorter * &shorter).recip());
        let values: Vec<&Laurent> =
            self.stiffest().into_iter().flatten().map(|i| &self.modes[i].stiffness).collect();
        let [fast, slow] = values[..] else { return };
        let corner = [fast, slow].map(|value| value * &factor);
        // Of the stiffest slow mode over every fast one: the longest fast period with the shortest slow one.
        let softest = self.faster().into_iter().map(|i| &self.modes[i].stiffness).min();
        let widest = (Rational::one() + &self.band) / &shorter;
        let rho = softest.and_then(|softest| slow.enclosure(BITS).div(&softest.enclosure(BITS), BITS));
        let rho = rho.map(|rho| rho.upper() * &widest * &widest);
        let (inner, caps, least) = (self.schemes[0].last_but_one(), self.caps(), self.least());
        let beyond_verlet = self.rigid(slow);
        for (words, way) in SOLVED {
            let Way::Molly(method) = way else { continue };
            let is_free = rho.as_ref().is_some_and(|rho| method.is_free(rho));
            let turn = 2.0 * beyond_verlet.1;
            let of_mode = |i: usize| {
                method.unstable(&self.modes[i].stiffness, slow, turn).first().map(|pairs| pairs[0])
            };
            let first = self.faster().into_iter().filter_map(of_mode);
            let first = first.reduce(|a, b| (a.0.min(b.0), a.1.min(b.1)));
            let Some(band_edge) = method.coupled_edge(&corner[0], &corner[1]) else { continue };
            let step = bounded(band_edge.0, &caps, &least);
            all.rows.push(Lever {
                first: first.filter(|_| !is_free),
                is_free,
                band_edge: Some(band_edge),
                inner: caps.part_of(&step, inner),
                step,
                ..Lever::new(words.into(), way)
            });
        }
        let (band_edge, exact) = (self.shrunk(beyond_verlet), exact_root(slow));
        let step = bounded(band_edge.0, &caps, &least);
        let free = |name: &str, way: Way, inner: Option<Rational>| Lever {
            first: Some(beyond_verlet),
            exact: exact.clone(),
            band_edge: Some(band_edge),
            inner,
            step: step.clone(),
            ..Lever::new(name.into(), way)
        };
        all.rows.push(free("equilibrium MOLLY", Way::Equilibrium, caps.part_of(&step, inner)));
        all.rows.push(free("implicit-explicit", Way::ImplicitExplicit, None));
    }

    /// 2/√Λ2 = T/π of the slow force: beyond it Verlet's rule fails on it alone.
    fn rigid(&self, slow: &Laurent) -> (f64, f64) {
        let root = slow.enclosure(BITS).sqrt(BITS).expect("a stiffness is positive");
        Ball::from_integer(&2.into()).div(&root, BITS).expect("a stiffness is positive").to_f64_enclosure()
    }

    /// The longest outer steps at every ratio, the innermost step following.
    fn ratios(&self, all: &mut Levers) -> Result<()> {
        let own = &self.schemes[0];
        if let Some(why) = not_nested(own, self.unit) {
            all.left_out.push(format!("other ratios: {why}"));
            return Ok(());
        }
        let caps = self.caps();
        for p in RATIOS {
            let scheme = own.with_outer(own.last_but_one() * Rational::from_integer(p.into()))?;
            let (first, band_edge) = self.edges(&scheme)?;
            // The unit of the outer step: the innermost one is a multiple of the least.
            let unit = scheme.outer() / scheme.inner() * self.least();
            let step = of_units(band_edge.0, &caps, &scheme, &unit);
            let inner = step.as_ref().map(|(step, _)| step / scheme.outer() * scheme.inner());
            all.rows.push(Lever {
                first: Some(first),
                band_edge: Some(band_edge),
                step,
                inner,
                ..Lever::new(format!("ratio {p}"), Way::Respa)
            });
        }
        Ok(())
    }

    /// The longest outer step that the friction keeps bounded, all shorter multiples too, for the periods
    /// given.
    fn masked(&self, scheme: &Scheme, rate: &Rational) -> Option<Lever> {
        let holds = |p: u64| -> Option<bool> {
            let other = scheme.with_outer(scheme.last_but_one() * Rational::from_integer(p.into())).ok()?;
            let damped = |mode| Levels { scheme: &other, stiffness: self.with(mode) }.is_damped_by(rate);
            self.faster().into_iter().try_fold(true, |all, mode| Some(all && damped(mode)?))
        };
        (scheme.steps().len() > 1).then_some(())?;
        let found = (2..=MOST_MASKED).take_while(|&p| holds(p) == Some(true)).last()?;
        let step = scheme.last_but_one() * Rational::from_integer(found.into());
        Some(Lever::masked(step, scheme.inner(), rate, self.unit))
    }
}

/// 2/√Λ of Λ = c π^(2 k) with a square c.
fn exact_root(stiffness: &Laurent) -> Option<Laurent> {
    let (power, c) = stiffness.as_monomial()?;
    let root = |n: &BigInt| Some(n.sqrt()).filter(|root| root * root == *n);
    let (below, above) = (root(c.numer())?, root(c.denom())?);
    (power % 2 == 0).then(|| Laurent::monomial(Rational::new(above * 2, below), -power / 2))
}

/// The longest multiple of `unit` below the band's edge and what is published, where all steps keep the
/// ratios of a scheme.
pub(super) fn of_units(
    edge: f64,
    caps: &Caps,
    scheme: &Scheme,
    unit: &Rational,
) -> Option<(Rational, Bound)> {
    let edge = (from_f64_exact(edge).unwrap_or_default(), Bound::Band);
    let (limit, bound) = caps.at_ratio(scheme).into_iter().chain([edge]).min_by(|a, b| a.0.cmp(&b.0))?;
    multiple(&limit, unit).map(|step| (step, bound))
}

/// The longest multiple of `unit` that is shorter than `limit`.
pub(super) fn multiple(limit: &Rational, unit: &Rational) -> Option<Rational> {
    let count = (limit / unit).ceil() - Rational::one();
    (count >= Rational::one()).then(|| count * unit)
}

/// The longest multiple of `unit` below the band's edge and the slow force's own bound.
pub(super) fn bounded(edge: f64, caps: &Caps, unit: &Rational) -> Option<(Rational, Bound)> {
    let edge = (from_f64_exact(edge).unwrap_or_default(), Bound::Band);
    let slow = caps.slow().map(|value| (value.clone(), Bound::SlowTurn));
    let (limit, bound) = slow.into_iter().chain([edge]).min_by(|a, b| a.0.cmp(&b.0))?;
    multiple(&limit, unit).map(|step| (step, bound))
}

impl Levers {
    /// Sets each gain: against the longest step of kicks and drifts as they are today, at any ratio.
    pub fn compare(&mut self) {
        let today = self.rows.iter().filter(|lever| matches!(lever.way, Way::Verlet | Way::Respa));
        let longest = today.filter_map(|today| today.step.as_ref()).map(|(step, _)| step.clone()).max();
        for row in &mut self.rows {
            let step = row.step.as_ref().map(|(step, _)| step);
            row.gain = step.zip(longest.as_ref()).map(|(step, longest)| step / longest);
        }
    }
}
