//! Hessians of a molecule on two clocks: its own modes, the first unstable interval, a band of periods.
//!
//! Where periods are given one by one the stiffest stands for all; Hessians tell what their coupling makes of them. The first stable
//! region, its margin and its band are proven (proofs/REGION.md); growth rates are rounded.

use num_traits::{One, ToPrimitive, Zero};

use super::answer::Status;
use super::levels::{Scheme, longest_below};
use super::levers::{
    Bound, Lever, Levers, MOST_MASKED, RATIOS, Way, below_third, bounded, least, of_units, part,
};
use super::names::Names;
use super::question::check_length;
use crate::error::{Error, Result};
use crate::number::Rational;
use crate::number::rational::{from_f64_exact, to_f64};
use crate::system::friction::Damping;
use crate::system::levels::{Growing, Kernel, Method, Outer};
use crate::system::{Analysis, Holds, Removed};

/// Measured stiffnesses of two levels, and what their coordinates are called.
#[derive(Clone, Debug)]
pub struct Molecule {
    kernel: Kernel,
    /// fs in the unit of time of the matrices.
    unit: Rational,
    names: Names,
    /// How well the matrices are known, relative to their norms.
    accuracy: f64,
}

/// Fast modes of nearly one period.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    pub count: usize,
    /// The shortest and the longest period in fs, rounded.
    pub period: (f64, f64),
    /// What they are called; `None` where it is not known who is bonded to whom, or no bond, angle or molecule has most of a mode.
    pub name: Option<String>,
    /// Who moves in the fastest of them.
    pub atoms: String,
}

/// What is told of a molecule at one scheme of steps; lengths in fs.
#[derive(Clone, Debug)]
pub struct Finding {
    pub scheme: Scheme,
    pub status: Status,
    /// What is proven of all matrices within their accuracy.
    pub holds: Holds,
    /// The largest relative change of the stiffnesses under which the verdict is proven to stand.
    pub margin: Option<f64>,
    /// \[lo, hi\]: every outer step up to lo is proven stable at this ratio, hi is proven unstable.
    pub first: Option<(f64, f64)>,
    /// Every outer step from the first unstable one up to this is proven unstable; the interval may end later.
    pub first_upper: Option<f64>,
    /// Growth from there on, sampled, steps in fs and rates per fs; that a step is stable again is proven. None where no first one is.
    pub growing: Vec<Growing>,
    /// Growth per fs, rounded; 0 where nothing grows, `None` where that is not decided.
    pub rate: Option<f64>,
    /// What grows fastest is called, where that is known.
    pub name: Option<String>,
    /// Who moves in it.
    pub atoms: Option<String>,
    /// Where a friction was given: whether it is proven to keep all bounded, or that something grows all the same; `None`: doubles do not tell.
    pub is_damped: Option<bool>,
    /// And where something grows without one, a friction per fs that is proven to mask it, about the least.
    pub masking: Option<f64>,
    /// Every outer step up to this, at this ratio, is proven stable for all periods in the band.
    pub band_edge: Option<f64>,
    /// The longest multiple of the inner step that is proven so, all shorter ones too.
    pub largest: Option<Rational>,
    /// The same, and below T/3 of the fastest mode.
    pub safe: Option<Rational>,
    pub within_run: Option<bool>,
}

/// What is told of a molecule at a ratio of steps, in fs.
#[derive(Clone)]
struct AtRatio {
    first_upper: Option<f64>,
    growing: Vec<Growing>,
    band_edge: Option<f64>,
}

/// All that is told of a molecule.
#[derive(Clone, Debug)]
pub struct Findings {
    pub groups: Vec<Group>,
    /// The shortest period of the slow stiffness alone, in fs, rounded.
    pub slow: f64,
    pub removed: Option<Removed>,
    pub accuracy: f64,
    pub band: Rational,
    pub length: Option<Rational>,
    /// Per fs.
    pub friction: Option<Rational>,
    pub schemes: Vec<Finding>,
    /// What would let the outer step of the first scheme grow; `None` where that was not asked.
    pub levers: Option<Levers>,
}

/// Fast modes are told as one where each period is within this of the next.
const NEIGHBOUR: f64 = 1.03;

/// Groups are told up to this many.
const MOST_GROUPS: usize = 12;

/// Frequencies below this part of the highest one are no modes of the fast stiffness: rigid to it, or slow.
const NO_MODE: f64 = 1e-2;

/// The most products unless a budget is given: a minute or two.
pub const MOST_PRODUCTS: u64 = 1_000_000_000_000;

/// A mode's inner step costs, over all the half periods that advice looks at, as much as so many products: some 1500 of them, measured.
const OF_AN_INNER_STEP: u64 = 30_000;

/// An interval is followed in relative steps no shorter than this: its beginning is told to 1e-8.
const LEAST: f64 = 1e-9;

/// Nor are the first samples of its growth closer.
const LEAST_SAMPLE: f64 = 1e-5;

impl Molecule {
    /// From a kernel whose unit of time is so many fs.
    pub fn new(kernel: Kernel, unit: Rational, names: Names, accuracy: f64) -> Molecule {
        Molecule { kernel, unit, names, accuracy }
    }

    /// The products that advice on so many degrees of freedom at these schemes costs, about: factorizations that bisect to edges and
    /// margins, sampled eigenvalues; with a friction those of whole periods. For each of these every fast mode is followed over the inner
    /// steps of half an outer one.
    ///
    /// # Errors
    /// A budget error where that is more than `most`.
    pub fn allow(size: usize, schemes: &[Scheme], has_friction: bool, most: Option<u64>) -> Result<u64> {
        let (n, cubes) = (size as u64, if has_friction { 800 } else { 200 });
        let of_scheme = |scheme: &Scheme| {
            let inner_steps = (scheme.outer() / scheme.inner()).ceil().to_u64().unwrap_or(u64::MAX);
            let followed = inner_steps.saturating_mul(n).saturating_mul(OF_AN_INNER_STEP);
            n.saturating_pow(3).saturating_mul(cubes).saturating_add(followed)
        };
        let cost = schemes.iter().map(of_scheme).fold(0, u64::saturating_add);
        let schemes = schemes.len();
        let most = most.unwrap_or(MOST_PRODUCTS);
        if cost <= most {
            return Ok(cost);
        }
        let (told, limit) = (cost as f64, most as f64);
        let work = format!(
            "advice on {size} degrees of freedom, {schemes} scheme{} of steps, costs about {told:.1e} products, the budget is {limit:.1e}",
            if schemes == 1 { "" } else { "s" }
        );
        Err(Error::budget(work, cost)
            .or("ask about fewer schemes, longer inner steps, or without what would let the step grow"))
    }

    /// The findings at each scheme, all periods within `band` of theirs.
    ///
    /// # Errors
    /// No scheme; one of other than two steps, or whose outer step is no multiple of the inner one; a band outside [0, 1).
    pub fn advise(
        &self,
        schemes: &[Scheme],
        band: &Rational,
        length: Option<&Rational>,
        friction: Option<&Rational>,
    ) -> Result<Findings> {
        if *band < Rational::zero() || *band >= Rational::one() {
            return Err(Error::input("band", band, "write a part of the period from 0 to below 1, as 5%"));
        }
        if schemes.is_empty() {
            return Err(Error::missing("steps", "give the inner and the outer step, as 0.5fs,4fs"));
        }
        let groups = self.groups();
        let Some(fastest) = groups.first().map(|group| group.period.0) else {
            return Err(Error::input(
                "fast stiffness",
                "0",
                "no force of the shorter step acts on what is free: give it the bonds, or leave it out and ask `kickdrift system FILE`",
            ));
        };
        if let Some(rate) = friction.filter(|rate| **rate <= Rational::zero()) {
            return Err(Error::input("friction", rate, "a friction must be positive"));
        }
        length.map_or(Ok(()), check_length)?;
        let mut known: Vec<(u64, AtRatio)> = Vec::new();
        let mut found = Vec::new();
        for scheme in schemes {
            let p = self.outer_of(scheme)?.inner_steps();
            if known.iter().all(|(own, _)| *own != p) {
                known.push((p, self.at_ratio(p, to_f64(band))?));
            }
            let (_, at) = known.iter().find(|(own, _)| *own == p).expect("just put there");
            found.push(self.find(scheme, fastest, band, (length, friction), at)?);
        }
        let frequency = self.kernel.highest_slow_frequency();
        Ok(Findings {
            slow: self.period(frequency * frequency),
            removed: self.kernel.removed.clone(),
            accuracy: self.accuracy,
            band: band.clone(),
            length: length.cloned(),
            friction: friction.cloned(),
            schemes: found,
            groups,
            levers: None,
        })
    }

    fn period(&self, square: f64) -> f64 {
        2.0 * std::f64::consts::PI / square.sqrt() * to_f64(&self.unit)
    }

    fn groups(&self) -> Vec<Group> {
        let squares = self.kernel.fast_squares();
        let least = NO_MODE * NO_MODE * squares.last().copied().unwrap_or(0.0).max(0.0);
        let mut groups: Vec<(Group, Vec<Vec<f64>>)> = Vec::new();
        for (k, &square) in squares.iter().enumerate().rev().take_while(|(_, square)| **square > least) {
            let (period, mode) = (self.period(square), self.kernel.fast_mode(k));
            let is_full = groups.len() == MOST_GROUPS;
            match groups.last_mut() {
                Some((last, modes)) if period < NEIGHBOUR * last.period.1 => {
                    (last.count, last.period.1) = (last.count + 1, period);
                    modes.push(mode);
                }
                _ if is_full => break,
                _ => {
                    let atoms = self.names.atoms(&mode);
                    groups
                        .push((Group { count: 1, period: (period, period), name: None, atoms }, vec![mode]));
                }
            }
        }
        let named = |(group, modes): (Group, Vec<Vec<f64>>)| {
            let modes: Vec<Vec<&[f64]>> = modes.iter().map(|mode| vec![&mode[..]]).collect();
            Group { name: self.names.motion(&modes), ..group }
        };
        groups.into_iter().map(named).collect()
    }

    fn outer(&self, inner: &Rational, outer: &Rational) -> Result<Outer> {
        let steps = [inner, outer].map(|step| step / &self.unit);
        Outer::of_steps(&steps[0], &steps[1]).ok_or_else(|| {
            let remedy = "Hessians are answered for an outer step that is a multiple of the inner one";
            Error::input("steps", format!("{inner} fs, {outer} fs"), remedy)
        })
    }

    fn outer_of(&self, scheme: &Scheme) -> Result<Outer> {
        let [inner, last] = scheme.steps() else {
            let remedy = "Hessians are answered for two steps, as 0.5fs,4fs";
            return Err(Error::input("steps", format!("{} of them", scheme.steps().len()), remedy));
        };
        self.outer(inner, last)
    }

    fn find(
        &self,
        scheme: &Scheme,
        fastest: f64,
        band: &Rational,
        (length, friction): (Option<&Rational>, Option<&Rational>),
        at: &AtRatio,
    ) -> Result<Finding> {
        let (inner, last) = (scheme.inner(), scheme.outer());
        let (outer, part, unit) = (self.outer_of(scheme)?, to_f64(band), to_f64(&self.unit));
        let analysis = self.kernel.decide(&outer, &(last / &self.unit), self.accuracy);
        let measured = analysis.measured.as_ref().expect("Hessians are measured");
        let third = from_f64_exact(fastest / 3.0).unwrap_or_else(Rational::zero);
        let is_in_band = self.kernel.covers_band(&outer, part, self.accuracy);
        let status = match measured.holds {
            Holds::Unstable => Status::Unstable,
            Holds::NotTold => Status::NotTold,
            Holds::Stable if is_in_band && *last < third => Status::Safe,
            Holds::Stable if is_in_band => Status::Caution,
            Holds::Stable if self.kernel.is_in_first_region(&outer, self.accuracy) => Status::Near,
            Holds::Stable => Status::Island,
        };
        let rate = growth(&analysis).map(|rate| rate / unit);
        let grows = rate.is_some_and(|rate| rate > 0.0);
        let time = rate.map(|rate| std::f64::consts::LN_10 / rate);
        let AtRatio { first_upper, growing, band_edge } = at.clone();
        let fastest_growing = fastest_instability(&analysis);
        let largest = self.largest(inner, part)?;
        Ok(Finding {
            scheme: scheme.clone(),
            status,
            holds: measured.holds,
            margin: measured.margin.filter(|_| analysis.is_stable()),
            first: measured.first_unstable.map(|(lo, hi)| (lo * unit, hi * unit)),
            first_upper,
            growing,
            rate,
            is_damped: friction
                .and_then(|rate| self.kernel.damping(&outer, to_f64(rate) * unit))
                .map(|own| own == Damping::Damped),
            masking: friction
                .filter(|_| grows)
                .and_then(|_| self.kernel.masking_friction(&outer))
                .map(|own| own / unit),
            name: fastest_growing.and_then(|own| self.names.motion(&[vec![&own.shape, &own.quadrature]])),
            atoms: fastest_growing.map(|own| self.names.atoms(&amplitudes(own))),
            band_edge,
            safe: largest.as_ref().and_then(|largest| longest_below(scheme, largest, &third)),
            largest,
            within_run: length.filter(|_| grows).zip(time).map(|(length, time)| time <= to_f64(length)),
        })
    }

    /// The molecule with one thing changed: kicks and drifts at this scheme.
    ///
    /// # Errors
    /// As [`Molecule::advise`].
    pub fn lever(&self, name: String, way: Way, scheme: &Scheme, band: &Rational) -> Result<Lever> {
        let largest = self.largest(scheme.inner(), to_f64(band))?;
        let step = below_third(scheme, largest.as_ref(), &self.third());
        self.lever_at(name, way, scheme, band, step)
    }

    /// The longest outer steps at every ratio, the inner step following.
    ///
    /// # Errors
    /// As [`Molecule::advise`].
    pub fn ratios(&self, scheme: &Scheme, band: &Rational) -> Result<Vec<Lever>> {
        let at = |p: u64| {
            let unit = Rational::from_integer(p.into()) * least();
            let scheme = scheme.with_outer(scheme.inner() * Rational::from_integer(p.into()))?;
            let mut lever = self.lever_at(format!("ratio {p}"), Way::Respa, &scheme, band, None)?;
            lever.step = of_units(lever.band_edge.map_or(0.0, |edge| edge.0), &self.third(), &unit);
            lever.inner = lever.step.as_ref().map(|(step, _)| step / Rational::from_integer(p.into()));
            Ok(lever)
        };
        RATIOS.map(at).collect()
    }

    fn lever_at(
        &self,
        name: String,
        way: Way,
        scheme: &Scheme,
        band: &Rational,
        step: Option<(Rational, Bound)>,
    ) -> Result<Lever> {
        let (p, unit) = (self.outer_of(scheme)?.inner_steps(), to_f64(&self.unit));
        let edge = self.kernel.band_edge(p, to_f64(band), self.accuracy);
        Ok(Lever {
            first: self.first_of(&self.kernel, p),
            band_edge: edge.map(|edge| rounded_edge(edge * unit)),
            step,
            inner: Some(scheme.inner().clone()),
            ..Lever::new(name, way)
        })
    }

    /// The first unstable outer step of p inner ones under the method of a kernel, in fs.
    fn first_of(&self, kernel: &Kernel, p: u64) -> Option<(f64, f64)> {
        let unit = to_f64(&self.unit);
        kernel.first_unstable(p).map(|(lo, hi)| ((lo * unit).next_down(), (hi * unit).next_up()))
    }

    /// Another method that takes the fast stiffness in one go, or follows it exactly by inner steps up to that of the scheme; `None` where no step is
    /// proven.
    pub fn method(&self, name: &str, way: Way, scheme: &Scheme, band: &Rational) -> Option<Lever> {
        let method = match way {
            Way::Molly(own) => Method::Trigonometric(own),
            Way::ImplicitExplicit => Method::ImplicitExplicit,
            _ => return None,
        };
        let kernel = self.kernel.clone().with_method(method);
        let edge = rounded_edge(kernel.band_edge(1, to_f64(band), self.accuracy)? * to_f64(&self.unit));
        let frequency = kernel.highest_slow_frequency();
        let step = bounded(edge.0, self.period(frequency * frequency) / 5.0);
        let follows = method != Method::ImplicitExplicit;
        Some(Lever {
            first: self.first_of(&kernel, 1),
            band_edge: Some(edge),
            inner: part(&step, scheme.inner()).filter(|_| follows),
            step,
            ..Lever::new(name.into(), way)
        })
    }

    /// The longest multiple of the inner step that a friction per fs is proven to mask, all shorter multiples too; `None` where it is none.
    ///
    /// # Errors
    /// As [`Molecule::advise`].
    pub fn masked(&self, scheme: &Scheme, rate: &Rational) -> Result<Option<Lever>> {
        let (inner, unit) = (scheme.inner(), to_f64(&self.unit));
        let mut longest = None;
        for p in 2..=MOST_MASKED {
            let step = inner * Rational::from_integer(p.into());
            let outer = self.outer(inner, &step)?;
            if self.kernel.damping(&outer, to_f64(rate) * unit) != Some(Damping::Damped) {
                break;
            }
            longest = Some(step);
        }
        Ok(longest.map(|step| Lever::masked(step, inner, rate)))
    }

    /// T/3 of the fastest mode.
    fn third(&self) -> Rational {
        let third = self.groups().first().and_then(|fastest| from_f64_exact(fastest.period.0 / 3.0));
        third.unwrap_or_else(Rational::zero)
    }

    /// What belongs to a number of inner steps.
    fn at_ratio(&self, inner_steps: u64, band: f64) -> Result<AtRatio> {
        let unit = to_f64(&self.unit);
        let band_edge = self.kernel.band_edge(inner_steps, band, self.accuracy).map(|edge| edge * unit);
        let Some((_, begins)) = self.kernel.first_unstable(inner_steps) else {
            return Ok(AtRatio { first_upper: None, growing: Vec::new(), band_edge });
        };
        let upper = self.kernel.unstable_up_to(inner_steps, begins, LEAST)?;
        let growing = self.kernel.growing(inner_steps, begins, (upper / begins - 1.0).max(LEAST_SAMPLE))?;
        let fs = |step: Option<f64>| step.map(|step| step * unit);
        let in_fs = |own: Growing| Growing {
            lower: own.lower * unit,
            upper: fs(own.upper),
            stable_again: fs(own.stable_again),
            worst: (own.worst.0 * unit, own.worst.1 / unit),
        };
        let growing = growing.into_iter().map(in_fs).collect();
        Ok(AtRatio { first_upper: Some(upper * unit), growing, band_edge })
    }

    /// The longest multiple of the inner step for the band, all shorter ones holding too.
    fn largest(&self, inner: &Rational, band: f64) -> Result<Option<Rational>> {
        let holds = |count: u64| -> Result<bool> {
            let outer = self.outer(inner, &(inner * Rational::from_integer(count.into())))?;
            Ok(self.kernel.covers_band(&outer, band, self.accuracy))
        };
        let mut found = 0;
        while found < MOST_INNER_STEPS && holds(found + 1)? {
            found += 1;
        }
        Ok((found > 0).then(|| inner * Rational::from_integer(found.into())))
    }
}

/// Beyond this many the inner step is so short that nobody means it.
const MOST_INNER_STEPS: u64 = 1000;

/// The edge of a band as it is found: to 1e-6 of itself.
fn rounded_edge(edge: f64) -> (f64, f64) {
    (edge.next_down(), edge * (1.0 + 2e-6))
}

/// The largest growth rate, per unit of time, rounded; `None` where it is not decided whether anything grows.
fn growth(analysis: &Analysis) -> Option<f64> {
    let largest = instabilities(analysis).map(|own| own.multiplier.size().ln()).fold(0.0, f64::max);
    analysis.is_proof().then(|| largest / analysis.period.to_f64())
}

fn instabilities(analysis: &Analysis) -> impl Iterator<Item = &crate::system::Instability> {
    analysis.parts.iter().flat_map(|part| &part.instabilities)
}

fn fastest_instability(analysis: &Analysis) -> Option<&crate::system::Instability> {
    instabilities(analysis).max_by(|a, b| a.multiplier.size().total_cmp(&b.multiplier.size()))
}

fn amplitudes(own: &crate::system::Instability) -> Vec<f64> {
    own.shape.iter().zip(&own.quadrature).map(|(re, im)| re.hypot(*im)).collect()
}

impl Finding {
    /// Outer steps until an amplitude is tenfold, rounded; `None` where nothing grows.
    pub fn tenfold_steps(&self) -> Option<f64> {
        let outer = self.scheme.outer().to_f64()?;
        self.rate.filter(|rate| *rate > 0.0).map(|rate| std::f64::consts::LN_10 / (rate * outer))
    }
}
