//! Forces that are no gradient, as learned ones that are predicted directly: what the steps add to their own
//! growth.
//!
//! x'' = −A x itself grows where A has eigenvalues that are not real and positive, whatever the steps. So no
//! step is stable there, and the question is how much growth the steps add. They add *little* where growth
//! with them is proven to be at most twice that without: then no shorter step can halve it. If the forces do
//! not grow by themselves, little means stable. Where motions lie too close together for doubles to prove
//! that, growth which takes more than 1 µs to be tenfold counts as little, too.
//!
//! The advice rests on points: the multiples of the step before the outermost one, which are the outer steps
//! that can be chosen beside it. Each is decided with the periods given and with all periods shorter by the
//! band. Nothing is known of the steps between.

use num_traits::{One, ToPrimitive};

use super::caps::Caps;
use super::levels::Scheme;
use super::names::Names;
use super::question::{check_band, check_friction, check_length};
use number::{Error, Rational, Result, named, outward, to_f64};
use systems::friction::Damping;
use systems::{Jacobians, Limits};

/// Growth with the steps may be so many times that without: then no shorter step can halve it.
pub const TIMES: f64 = 2.0;

/// Growth per fs up to this is little, whatever the forces do by themselves: an amplitude takes 1 µs to be
/// tenfold (ln 10/10⁹ fs), and no run with such forces is as long.
const SLOW: f64 = 2.3e-9;

/// The most multiples that are decided: where a fast period has more, the step before the outermost one is
/// far shorter than anyone chooses.
const MOST_RUNGS: u64 = 200;

/// A scheme is decided as given and within the band, and its friction looked for.
const OF_A_SCHEME: u64 = 4;

/// Jacobians on their clocks, and what their coordinates are called.
#[derive(Clone, Debug)]
pub struct Direct {
    jacobians: Jacobians,
    /// fs in the unit of time of the matrices.
    unit: Rational,
    names: Names,
    /// Whether the bonds are said to be harmonic.
    harmonic: bool,
}

named! {
    /// The growth that the steps add to that of the forces.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Adds {
        /// Growth is proven to be at most [`TIMES`] the growth without steps, so none where nothing grows
        /// without steps; or it is tenfold after 1 µs at the earliest.
        Little = "little",
        /// It is proven to be more.
        Much = "much",
        /// Neither is proven.
        Undecided = "not told",
    }
}

/// One outer step of the ladder; steps in fs, rates per fs.
#[derive(Clone, Debug)]
pub struct Rung {
    /// Of the step before the outermost one.
    pub multiple: u64,
    pub outer: Rational,
    /// Growth with the steps, enclosed, for the matrices given; `None`: not bounded.
    pub rate: Option<(f64, f64)>,
    /// With the periods given,
    pub adds: Adds,
    /// and with all of them shorter by the band.
    pub in_band: Adds,
    /// Whether the friction given is proven to mask what grows, or not to.
    pub is_damped: Option<bool>,
}

/// A scheme of steps; steps in fs, rates per fs.
#[derive(Clone, Debug)]
pub struct DirectFinding {
    pub scheme: Scheme,
    pub rate: Option<(f64, f64)>,
    pub adds: Adds,
    pub in_band: Adds,
    /// How much faster it grows with the steps than without, enclosed; negative where it is slower.
    pub added: Option<(f64, f64)>,
    /// Growth for all matrices within their accuracy, enclosed; `None` of exact ones, and where that is not
    /// bounded.
    pub within_accuracy: Option<(f64, f64)>,
    /// Outer steps until an amplitude is tenfold, enclosed; `None` where growth is not proven.
    pub tenfold_steps: Option<(f64, f64)>,
    /// Who moves in what grows fastest.
    pub atoms: Option<String>,
    /// Whether the friction given is proven to mask what grows, or not to.
    pub is_damped: Option<bool>,
    /// A friction that is proven to mask it, about the least.
    pub masking: Option<f64>,
    /// Whether an amplitude is tenfold within the run; `None` where that is not proven, or no length given.
    pub within_run: Option<bool>,
    /// The longest multiple up to which all are proven to add little, within the band too.
    pub largest: Option<Rational>,
    /// The longest multiple that is `largest` at most and below what is published ([`Caps`]); `None` also
    /// where an inner step is not.
    pub safe: Option<Rational>,
    /// The longest multiple up to which the friction given is proven to mask all growth.
    pub masked: Option<Rational>,
    /// All multiples that were looked at.
    pub ladder: Vec<Rung>,
}

/// The advice on forces that are no gradient.
#[derive(Clone, Debug)]
pub struct DirectFindings {
    /// |J − Jᵀ|/|J + Jᵀ| of each potential, rounded.
    pub asymmetries: Vec<f64>,
    pub accuracy: Option<f64>,
    /// Growth of x'' = −A x per fs, enclosed; `None`: not bounded.
    pub without_steps: Option<(f64, f64)>,
    /// The shortest period of the forces of the innermost step alone, in fs, rounded.
    pub fastest: f64,
    pub band: Rational,
    pub length: Option<Rational>,
    /// Per fs.
    pub friction: Option<Rational>,
    /// Whether the bonds are said to be harmonic.
    pub harmonic: bool,
    pub schemes: Vec<DirectFinding>,
}

/// The question asked at every scheme, and the growth of the forces alone.
struct Asked<'a> {
    band: &'a Rational,
    length: Option<&'a Rational>,
    friction: Option<&'a Rational>,
    /// Growth of x'' = −A x per unit time of the matrices.
    without: Option<(f64, f64)>,
    /// The shortest period of the forces of the innermost step, in fs.
    fastest: f64,
}

impl Direct {
    /// From Jacobians whose unit of time is so many fs.
    pub fn new(jacobians: Jacobians, unit: Rational, names: Names) -> Direct {
        Direct { jacobians, unit, names, harmonic: false }
    }

    /// States whether the bonds are harmonic.
    #[must_use]
    pub fn with_harmonic_bonds(self, harmonic: bool) -> Direct {
        Direct { harmonic, ..self }
    }

    /// The products of doubles that advice costs, about.
    ///
    /// # Errors
    /// As [`Direct::advise`].
    pub fn cost(&self, schemes: &[Scheme]) -> Result<u64> {
        self.cost_beside(schemes, self.fastest()?)
    }

    fn cost_beside(&self, schemes: &[Scheme], fastest: f64) -> Result<u64> {
        let of = |scheme: &Scheme| {
            let points = multiples(scheme, fastest).len() as u64 + OF_A_SCHEME;
            Ok(points.saturating_mul(self.at(scheme.steps())?.cost()))
        };
        schemes.iter().map(of).try_fold(0, |sum: u64, count: Result<u64>| Ok(sum.saturating_add(count?)))
    }

    /// The findings at each scheme.
    ///
    /// # Errors
    /// No scheme, one of another number of steps than there are clocks, a band outside [0, 1), a length or a
    /// friction that is not positive, forces of the innermost step under which nothing vibrates; a budget
    /// error before work beyond `limits`.
    pub fn advise(
        &self,
        schemes: &[Scheme],
        band: &Rational,
        (length, friction): (Option<&Rational>, Option<&Rational>),
        limits: &Limits,
    ) -> Result<DirectFindings> {
        check_band(band)?;
        if schemes.is_empty() {
            return Err(Error::missing("steps", "give the inner and the outer step, as 0.5fs,4fs"));
        }
        friction.map_or(Ok(()), check_friction)?;
        length.map_or(Ok(()), check_length)?;
        let fastest = self.fastest()?;
        let cost = self.cost_beside(schemes, fastest)?;
        limits.allow(cost, || "advice on forces that are no gradient".into())?;
        let without = self.jacobians.without_steps();
        let asked = Asked { band, length, friction, without, fastest };
        let find = |scheme: &Scheme| self.find(scheme, &asked);
        Ok(DirectFindings {
            asymmetries: self.jacobians.asymmetries().to_vec(),
            accuracy: self.jacobians.accuracy(),
            without_steps: without.map(|rate| self.per_fs(rate)),
            fastest,
            band: band.clone(),
            length: length.cloned(),
            friction: friction.cloned(),
            harmonic: self.harmonic,
            schemes: schemes.iter().map(find).collect::<Result<_>>()?,
        })
    }

    /// T of the fastest motion of the forces of the innermost step alone, in fs, rounded.
    fn fastest(&self) -> Result<f64> {
        let found = self.jacobians.highest_fast_frequency();
        let period = found.map(|found| 2.0 * std::f64::consts::PI / found * to_f64(&self.unit));
        period.ok_or_else(|| {
            let remedy =
                "nothing vibrates under the forces of the shortest step: ask `kickdrift system FILE`";
            Error::input("fast stiffness", "no positive eigenvalue", remedy)
        })
    }

    /// With these steps in fs.
    fn at(&self, steps: &[Rational]) -> Result<Jacobians> {
        self.jacobians.with_steps(&steps.iter().map(|step| step / &self.unit).collect::<Vec<_>>())
    }

    /// Rates per unit time as rates per fs, rounded outward.
    fn per_fs(&self, (lo, hi): (f64, f64)) -> (f64, f64) {
        let unit = to_f64(&self.unit);
        // The unit, the quotient.
        let outward = |x: f64, by: f64| if x == 0.0 { 0.0 } else { x / unit * (1.0 + by) };
        (outward(lo, -1e-15), outward(hi, 1e-15))
    }

    /// The growth that steps in fs add, with the periods given and within the band.
    fn adds(&self, at: &Jacobians, asked: &Asked) -> Result<[Adds; 2]> {
        let longer = at.slowed(&(Rational::one() - asked.band).recip())?;
        let slow = SLOW * to_f64(&self.unit);
        Ok([at, &longer].map(|jacobians| adds(jacobians.growth_rate(), asked.without, slow)))
    }

    fn is_damped(&self, at: &Jacobians, friction: Option<&Rational>) -> Option<bool> {
        match at.damping(&(friction? * &self.unit))? {
            Damping::Damped => Some(true),
            Damping::Growing => Some(false),
            Damping::Marginal => None,
        }
    }

    fn rung(&self, scheme: &Scheme, multiple: u64, asked: &Asked) -> Result<Rung> {
        let outer = scheme.last_but_one() * Rational::from_integer(multiple.into());
        let mut steps = scheme.steps().to_vec();
        *steps.last_mut().expect("at least one step") = outer.clone();
        let at = self.at(&steps)?;
        let [adds, in_band] = self.adds(&at, asked)?;
        let (rate, is_damped) = (at.growth_rate(), self.is_damped(&at, asked.friction));
        Ok(Rung { multiple, outer, rate: rate.map(|rate| self.per_fs(rate)), adds, in_band, is_damped })
    }

    fn find(&self, scheme: &Scheme, asked: &Asked) -> Result<DirectFinding> {
        let at = self.at(scheme.steps())?;
        let multiples = multiples(scheme, asked.fastest);
        let ladder = number::parallel::try_map(&multiples, |&multiple| self.rung(scheme, multiple, asked))?;
        let up_to = |holds: fn(&Rung) -> bool| {
            ladder.iter().take_while(|rung| holds(rung)).last().map(|rung| rung.outer.clone())
        };
        let largest = up_to(|rung| rung.adds == Adds::Little && rung.in_band == Adds::Little);
        // Only the fastest of all motions is known.
        let mut periods = vec![None; scheme.steps().len()];
        periods[0] = Some(asked.fastest * (1.0 - 1e-9));
        let caps = Caps::new(&periods, self.harmonic);
        let safe =
            if ladder.is_empty() { None } else { caps.safe(scheme, largest.as_ref()).map(|pair| pair.0) };
        let [adds, in_band] = self.adds(&at, asked)?;
        let rate = at.growth_rate().map(|pair| self.per_fs(pair));
        let added = rate.zip(asked.without.map(|without| self.per_fs(without)));
        let tenfold = |rate: f64| std::f64::consts::LN_10 / (rate * to_f64(scheme.outer()));
        let tenfold_steps = rate.filter(|rate| rate.0 > 0.0).map(|(lo, hi)| {
            // ln 10, the step, two products.
            (tenfold(hi) * (1.0 - 1e-15), tenfold(lo) * (1.0 + 1e-15))
        });
        let run = asked.length.map(|length| to_f64(&(length / scheme.outer())));
        let within_run = run.zip(rate).and_then(|(run, (_, hi))| match tenfold_steps {
            Some((_, most)) if most <= run => Some(true),
            _ if tenfold(hi) * (1.0 - 1e-15) > run => Some(false),
            _ => None,
        });
        Ok(DirectFinding {
            scheme: scheme.clone(),
            rate,
            adds,
            in_band,
            added: added.map(|((lo, hi), (least, most))| outward((lo - most, hi - least))),
            within_accuracy: at.within_accuracy().map(|pair| self.per_fs(pair)),
            tenfold_steps,
            atoms: at.fastest().filter(|_| tenfold_steps.is_some()).map(|values| self.atoms(&values)),
            is_damped: self.is_damped(&at, asked.friction),
            masking: at.masking_friction().map(|value| value / to_f64(&self.unit)),
            within_run,
            largest,
            safe,
            masked: up_to(|rung| rung.is_damped == Some(true)),
            ladder,
        })
    }

    /// Who moves, by kinetic energy.
    fn atoms(&self, [re, im]: &[Vec<f64>; 2]) -> String {
        let root = |i: usize| self.jacobians.body().masses.as_ref().map_or(1.0, |values| values[i].sqrt());
        let amplitudes = re.iter().zip(im).enumerate().map(|(i, (re, im))| root(i) * re.hypot(*im));
        self.names.atoms(&amplitudes.collect::<Vec<_>>())
    }
}

/// The multiples that are looked at: up to a period of the fastest motion, and to the scheme's own outer
/// step.
fn multiples(scheme: &Scheme, fastest: f64) -> Vec<u64> {
    if scheme.steps().len() < 2 {
        return Vec::new();
    }
    let count = (scheme.outer() / scheme.last_but_one()).ceil().to_u64().unwrap_or(MOST_RUNGS);
    let period = (fastest / to_f64(scheme.last_but_one())).floor() as u64;
    (1..=period.max(count).min(MOST_RUNGS)).collect()
}

fn adds(rate: Option<(f64, f64)>, without: Option<(f64, f64)>, slow: f64) -> Adds {
    match (rate, without) {
        (Some((_, hi)), _) if hi <= slow => Adds::Little,
        (Some((_, hi)), Some((least, _))) if hi <= TIMES * least => Adds::Little,
        (Some((lo, _)), Some((_, most))) if lo > (TIMES * most).max(slow) => Adds::Much,
        _ => Adds::Undecided,
    }
}
