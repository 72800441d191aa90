//! Hessians of a molecule on its clocks: its own modes, the first unstable interval, a band of periods.
//!
//! Where periods are given one by one the stiffest stands for all; Hessians have the coupling of the modes,
//! too. The first stable region, its margin and its band are proven (proofs/REGION.md); growth rates are
//! rounded.

use std::sync::Arc;

use num_traits::{ToPrimitive, Zero};

use super::answer::Status;
use super::caps::{Bound, Caps};
use super::finding::{Finding, Findings, Group, MostBiased};
use super::levels::Scheme;
use super::lever::{Lever, Way};
use super::levers::{MOST_MASKED, RATIOS, bounded, least, of_units};
use super::names::Names;
use super::question::{check_band, check_friction, check_length};
use super::unit::TimeUnit;
use number::{Error, Rational, Result, to_f64};
use systems::friction::Damping;
use systems::levels::{Growing, Method, Search, Source};
use systems::{BiasedMode, Holds};

/// Measured stiffnesses on their clocks, and what their coordinates are called.
#[derive(Clone, Debug)]
pub struct Molecule {
    source: Arc<dyn Source>,
    /// fs in the unit of time of the matrices.
    unit: Rational,
    names: Names,
    /// How well the matrices are known, relative to their norms.
    accuracy: f64,
    /// Whether the bonds are said to be harmonic.
    harmonic: bool,
}

/// The answer for a molecule at a ratio of steps, in fs.
#[derive(Clone)]
struct AtRatio {
    first: Option<(f64, f64)>,
    first_upper: Option<f64>,
    growing: Vec<Growing>,
    band_edge: Option<f64>,
}

/// Fast modes are listed as one group where each period is within this factor of the next.
const NEIGHBOUR: f64 = 1.03;

/// At most this many groups are listed.
const MOST_GROUPS: usize = 12;

/// Frequencies below this part of the highest one of all levels are no modes of a fast one: rigid to it, or
/// slow, or held.
const NO_MODE: f64 = 1e-2;

/// The most products unless a budget is given: a minute or two.
pub const MOST_PRODUCTS: u64 = 1_000_000_000_000;

/// A mode's inner step costs, over all the half periods that advice looks at, as much as so many products:
/// some 1500 of them, measured.
const OF_AN_INNER_STEP: u64 = 30_000;

/// Factorizations of the action by which many levels are advised on, each in n³ for a kick time, measured.
const FACTORIZATIONS: u64 = 400;

/// An interval is followed in relative steps no shorter than this: its beginning is found to 1e-8.
const LEAST: f64 = 1e-9;

/// Nor are the first samples of its growth closer.
const LEAST_SAMPLE: f64 = 1e-5;

impl Molecule {
    /// From what decides, whose unit of time is so many fs.
    pub fn new(source: Arc<dyn Source>, unit: Rational, names: Names, accuracy: f64) -> Molecule {
        Molecule { source, unit, names, accuracy, harmonic: false }
    }

    /// States whether the bonds are harmonic.
    #[must_use]
    pub fn with_harmonic_bonds(self, harmonic: bool) -> Molecule {
        Molecule { harmonic, ..self }
    }

    /// The products that advice on so many degrees of freedom at these schemes costs, about: factorizations
    /// that bisect to edges and margins, sampled eigenvalues; with a friction those of whole periods. For
    /// each of these every fast mode of two levels is followed over the inner steps of half an outer one; of
    /// other numbers of levels a factorization has all kick times of half a period.
    ///
    /// # Errors
    /// A budget error where that is more than `most`.
    pub fn allow(size: usize, schemes: &[Scheme], has_friction: bool, most: Option<u64>) -> Result<u64> {
        let (n, cubes) = (size as u64, if has_friction { 800 } else { 200 });
        let of_scheme = |scheme: &Scheme| {
            let inner_steps = (scheme.outer() / scheme.inner()).ceil().to_u64().unwrap_or(u64::MAX);
            if scheme.steps().len() == 2 {
                let followed = inner_steps.saturating_mul(n).saturating_mul(OF_AN_INNER_STEP);
                return n.saturating_pow(3).saturating_mul(cubes).saturating_add(followed);
            }
            let factored = (inner_steps / 2 + 1).saturating_mul(FACTORIZATIONS);
            n.saturating_pow(3).saturating_mul(factored.saturating_add(4 * cubes))
        };
        let cost = schemes.iter().map(of_scheme).fold(0, u64::saturating_add);
        let schemes = schemes.len();
        let most = most.unwrap_or(MOST_PRODUCTS);
        if cost <= most {
            return Ok(cost);
        }
        let (products, limit) = (cost as f64, most as f64);
        let work = format!(
            "advice on {size} degrees of freedom, {schemes} scheme{} of steps, costs about {products:.1e} products, the budget is {limit:.1e}",
            if schemes == 1 { "" } else { "s" }
        );
        Err(Error::budget(work, cost).or("ask about fewer schemes, longer inner steps, or without levers"))
    }

    /// The findings at each scheme, all periods within `band` of theirs.
    ///
    /// # Errors
    /// No scheme; one of another number of steps than there are levels, or of two whose outer step is no
    /// multiple of the inner one; a band outside [0, 1).
    pub fn advise(
        &self,
        schemes: &[Scheme],
        band: &Rational,
        length: Option<&Rational>,
        friction: Option<&Rational>,
    ) -> Result<Findings> {
        check_band(band)?;
        if schemes.is_empty() {
            return Err(Error::missing("steps", "give the inner and the outer step, as 0.5fs,4fs"));
        }
        let (groups, caps) = (self.groups(), self.caps());
        let fastest = groups.first().cloned().or_else(|| self.fastest_between()).ok_or_else(|| {
            let remedy = "no force of the shorter step acts on the free motions: give it the bonds, or leave it out and ask `kickdrift system FILE`";
            Error::input("fast stiffness", "0", remedy)
        })?;
        friction.map_or(Ok(()), check_friction)?;
        length.map_or(Ok(()), check_length)?;
        let mut known: Vec<(Vec<Rational>, AtRatio)> = Vec::new();
        let mut found = Vec::new();
        for scheme in schemes {
            let ratios: Vec<Rational> = scheme.steps().iter().map(|step| step / scheme.inner()).collect();
            if known.iter().all(|(values, _)| *values != ratios) {
                known.push((ratios.clone(), self.at_ratio(scheme, to_f64(band))?));
            }
            let (_, at) = known.iter().find(|(values, _)| *values == ratios).expect("just put there");
            found.push(self.find(scheme, &caps, band, (length, friction), at)?);
        }
        let slow = self.source.slower_frequencies().last().map(|value| self.period(value * value));
        Ok(Findings {
            slow: slow.unwrap_or(f64::INFINITY),
            between: self.between().map(|period| period.unwrap_or(f64::INFINITY)).collect(),
            removed: self.source.removed().cloned(),
            accuracy: self.accuracy,
            caps,
            harmonic: self.harmonic,
            band: band.clone(),
            length: length.cloned(),
            friction: friction.cloned(),
            schemes: found,
            groups,
            fastest,
            levers: None,
        })
    }

    fn period(&self, square: f64) -> f64 {
        2.0 * std::f64::consts::PI / square.sqrt() * to_f64(&self.unit)
    }

    /// A square up to this is no mode of any level: rigid, held, or what rounding left of a held force.
    fn least_square(&self) -> f64 {
        let slower = self.source.slower_frequencies().into_iter().map(|value| value * value);
        let stiffest = self.source.fast_squares().last().copied().into_iter().chain(slower);
        NO_MODE * NO_MODE * stiffest.fold(0.0, f64::max)
    }

    /// The shortest period of each level between the innermost and the outermost one alone, in fs; `None`
    /// where it has no mode.
    fn between(&self) -> impl Iterator<Item = Option<f64>> {
        let (mut slower, least) = (self.source.slower_frequencies(), self.least_square());
        slower.pop();
        slower.into_iter().map(move |value| (value * value > least).then(|| self.period(value * value)))
    }

    /// Where all that the innermost forces pull is held: the fastest motion of the next level that has one.
    fn fastest_between(&self) -> Option<Group> {
        let found = (2..).zip(self.between()).filter_map(|(level, period)| Some((level, period?)));
        let (level, period) = found.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let name = Some(format!("level {level}"));
        Some(Group { count: 1, period: (period, period), name, atoms: String::new() })
    }

    fn groups(&self) -> Vec<Group> {
        let (squares, least) = (self.source.fast_squares(), self.least_square());
        let mut groups: Vec<(Group, Vec<Vec<f64>>)> = Vec::new();
        for (k, &square) in squares.iter().enumerate().rev().take_while(|(_, square)| **square > least) {
            let (period, mode) = (self.period(square), self.source.fast_mode(k));
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

    /// In the unit of time of the matrices.
    fn steps(&self, scheme: &Scheme) -> Vec<Rational> {
        self.in_units(scheme.steps())
    }

    fn in_units(&self, steps: &[Rational]) -> Vec<Rational> {
        steps.iter().map(|step| step / &self.unit).collect()
    }

    /// The levels at the steps of a scheme with an outermost step of `count` times the step before it, and
    /// that outermost step in fs.
    fn at_multiple(&self, scheme: &Scheme, count: u64) -> Result<(Rational, Box<dyn Search + '_>)> {
        let outer = scheme.last_but_one() * Rational::from_integer(count.into());
        let mut steps = scheme.steps().to_vec();
        *steps.last_mut().expect("at least one step") = outer.clone();
        Ok((outer, self.source.at(&self.in_units(&steps))?))
    }

    fn find(
        &self,
        scheme: &Scheme,
        caps: &Caps,
        band: &Rational,
        (length, friction): (Option<&Rational>, Option<&Rational>),
        at: &AtRatio,
    ) -> Result<Finding> {
        let (steps, part, unit) = (self.steps(scheme), to_f64(band), to_f64(&self.unit));
        let levels = self.source.at(&steps)?;
        let decided = self.source.decide(&steps, self.accuracy)?;
        let is_in_band = levels.covers_band(levels.outer_step(), part, self.accuracy);
        let status = match decided.holds {
            Holds::Unstable => Status::Unstable,
            Holds::Undecided => Status::Undecided,
            Holds::Stable if is_in_band && caps.hold(scheme) => Status::Safe,
            Holds::Stable if is_in_band => Status::Caution,
            Holds::Stable if decided.is_in_first_region => Status::Near,
            Holds::Stable => Status::Island,
        };
        let rate = decided.rate.map(|rate| rate / unit);
        let grows = rate.is_some_and(|rate| rate > 0.0);
        let time = rate.map(|rate| std::f64::consts::LN_10 / rate);
        let largest = self.largest(scheme, part, at.band_edge)?;
        let (safe, bound) = caps.safe(scheme, largest.as_ref()).unzip();
        let bias = (decided.holds == Holds::Stable).then(|| self.most_biased(&steps)).transpose()?.flatten();
        let safe_bias = safe.as_ref().map(|safe| {
            let mut steps = scheme.steps().to_vec();
            steps.last_mut().expect("at least one step").clone_from(safe);
            self.most_biased(&self.in_units(&steps))
        });
        let safe_bias = safe_bias.transpose()?.flatten();
        let damping = |rate: &Rational| levels.damping(levels.outer_step(), to_f64(rate) * unit);
        let masking = |_| levels.masking_friction(levels.outer_step());
        let AtRatio { first, first_upper, growing, band_edge } = at.clone();
        Ok(Finding {
            scheme: scheme.clone(),
            status,
            holds: decided.holds,
            margin: decided.margin,
            first,
            first_upper,
            growing,
            rate,
            is_damped: friction.and_then(damping).map(|damping| damping == Damping::Damped),
            masking: friction.filter(|_| grows).and_then(masking).map(|value| value / unit),
            name: decided.growing.as_ref().and_then(|[re, im]| self.names.motion(&[vec![re, im]])),
            atoms: decided.growing.as_ref().map(|growing| self.names.atoms(&amplitudes(growing))),
            band_edge,
            safe,
            bound,
            largest,
            within_run: length.filter(|_| grows).zip(time).map(|(length, time)| time <= to_f64(length)),
            bias,
            safe_bias,
        })
    }

    /// The normal mode that is most off at these steps, which are stable; `None` where it is not computed.
    fn most_biased(&self, steps: &[Rational]) -> Result<Option<MostBiased>> {
        let Ok(modes) = self.source.biased_modes(steps)? else { return Ok(None) };
        let off = |mode: &BiasedMode| mode.bias.at_kicks.ln().abs();
        let most = modes.into_iter().max_by(|a, b| off(a).total_cmp(&off(b)));
        let named = |BiasedMode { bias, pair: [x, _], .. }: BiasedMode| {
            let shape = self.source.shape(&x);
            let name = self.names.motion(&[vec![&shape[..]]]);
            MostBiased { mode: name.unwrap_or_else(|| self.names.atoms(&shape)), bias: bias.at_kicks }
        };
        Ok(most.map(named))
    }

    /// The molecule with one thing changed: kicks and drifts at this scheme.
    ///
    /// # Errors
    /// As [`Molecule::advise`].
    pub fn lever(&self, name: String, way: Way, scheme: &Scheme, band: &Rational) -> Result<Lever> {
        let (steps, part) = (self.steps(scheme), to_f64(band));
        let edge = self.source.at(&steps)?.band_edge(part, self.accuracy);
        let largest = self.largest(scheme, part, edge.map(|edge| edge * to_f64(&self.unit)))?;
        let step = self.caps().safe(scheme, largest.as_ref());
        // The edges are those at the ratio of the step to take.
        let mut steps = scheme.steps().to_vec();
        if let (Some((step, _)), [_, .., last]) = (&step, &mut steps[..]) {
            last.clone_from(step);
        }
        self.lever_at((name, way), &steps, band, step)
    }

    /// The longest outer steps at every ratio, the inner step following; none but of two levels.
    ///
    /// # Errors
    /// As [`Molecule::advise`].
    pub fn ratios(&self, scheme: &Scheme, band: &Rational) -> Result<Vec<Lever>> {
        if scheme.steps().len() != 2 {
            return Ok(Vec::new());
        }
        let caps = self.caps();
        let at = |p: u64| {
            let unit = Rational::from_integer(p.into()) * least();
            let scheme = scheme.with_outer(scheme.inner() * Rational::from_integer(p.into()))?;
            let mut lever = self.lever_at((format!("ratio {p}"), Way::Respa), scheme.steps(), band, None)?;
            lever.step = of_units(lever.band_edge.map_or(0.0, |edge| edge.0), &caps, &scheme, &unit);
            lever.inner = lever.step.as_ref().map(|(step, _)| step / Rational::from_integer(p.into()));
            Ok(lever)
        };
        RATIOS.map(at).collect()
    }

    fn lever_at(
        &self,
        (name, way): (String, Way),
        steps: &[Rational],
        band: &Rational,
        step: Option<(Rational, Bound)>,
    ) -> Result<Lever> {
        let (in_units, unit) = (self.in_units(steps), to_f64(&self.unit));
        let levels = self.source.at(&in_units)?;
        let edge = levels.band_edge(to_f64(band), self.accuracy);
        // The edge is found to a millionth; the step itself, and all that are smaller, are proven.
        let proven = step.as_ref().map_or(0.0, |(step, _)| to_f64(step));
        Ok(Lever {
            first: self.outward(levels.first_unstable()),
            band_edge: edge.map(|edge| rounded_edge((edge * unit).max(proven.next_up()))),
            step,
            inner: steps.first().cloned(),
            ..Lever::new(name, way)
        })
    }

    /// In fs, rounded outward.
    fn outward(&self, first: Option<(f64, f64)>) -> Option<(f64, f64)> {
        let unit = to_f64(&self.unit);
        first.map(|(lo, hi)| ((lo * unit).next_down(), (hi * unit).next_up()))
    }

    /// Another method that takes the fast stiffness in one go, or follows it exactly by inner steps up to
    /// that of the scheme; `None` where no step is proven, and of other than two levels.
    pub fn method(&self, name: &str, way: Way, scheme: &Scheme, band: &Rational) -> Option<Lever> {
        let method = match way {
            Way::Molly(trigonometric) => Method::Trigonometric(trigonometric),
            Way::ImplicitExplicit => Method::ImplicitExplicit,
            _ => return None,
        };
        let kernel = self.source.kernel()?.clone().with_method(method);
        let edge = rounded_edge(kernel.band_edge(1, to_f64(band), self.accuracy)? * to_f64(&self.unit));
        let (caps, unit) = (self.caps(), least());
        let step = bounded(edge.0, &caps, &unit);
        let follows = method != Method::ImplicitExplicit;
        Some(Lever {
            first: self.outward(kernel.first_unstable(1)),
            band_edge: Some(edge),
            inner: caps.part_of(&step, scheme.inner()).filter(|_| follows),
            step,
            ..Lever::new(name.into(), way)
        })
    }

    /// The longest multiple of the inner step that a friction per fs is proven to mask, all shorter multiples
    /// too; `None` where it is none.
    ///
    /// # Errors
    /// As [`Molecule::advise`].
    pub fn masked(&self, scheme: &Scheme, rate: &Rational) -> Result<Option<Lever>> {
        let unit = to_f64(&self.unit);
        let mut longest = None;
        for p in 2..=MOST_MASKED {
            let (step, levels) = self.at_multiple(scheme, p)?;
            if levels.damping(levels.outer_step(), to_f64(rate) * unit) != Some(Damping::Damped) {
                break;
            }
            longest = Some(step);
        }
        Ok(longest.map(|step| Lever::masked(step, scheme.inner(), rate, TimeUnit::Femtoseconds)))
    }

    /// What bounds the steps beside linear theory: periods are rounded, so they are taken a little shorter.
    fn caps(&self) -> Caps {
        let shorter = |square: f64| self.period(square) * (1.0 - 1e-9);
        let fastest = self.source.fast_squares().last().filter(|square| **square > self.least_square());
        let between = self.between().map(|period| period.map(|period| period * (1.0 - 1e-9)));
        let slowest = self.source.slower_frequencies().pop().map(|value| value * value);
        let slowest = slowest.map(|square| (square > 0.0).then(|| shorter(square)));
        let levels: Vec<Option<f64>> =
            [fastest.map(|square| shorter(*square))].into_iter().chain(between).chain(slowest).collect();
        Caps::new(&levels, self.harmonic)
    }

    /// The results that belong to the ratios of a scheme's steps.
    fn at_ratio(&self, scheme: &Scheme, band: f64) -> Result<AtRatio> {
        let (steps, unit) = (self.steps(scheme), to_f64(&self.unit));
        let levels = self.source.at(&steps)?;
        let band_edge = levels.band_edge(band, self.accuracy).map(|edge| edge * unit);
        let Some((stable, begins)) = levels.first_unstable() else {
            return Ok(AtRatio { first: None, first_upper: None, growing: Vec::new(), band_edge });
        };
        let upper = levels.unstable_up_to(begins, LEAST)?;
        let growing = levels.growing(begins, (upper / begins - 1.0).max(LEAST_SAMPLE))?;
        let fs = |step: Option<f64>| step.map(|step| step * unit);
        let in_fs = |growing: Growing| Growing {
            lower: growing.lower * unit,
            upper: fs(growing.upper),
            stable_again: fs(growing.stable_again),
            worst: (growing.worst.0 * unit, growing.worst.1 / unit),
        };
        let growing = growing.into_iter().map(in_fs).collect();
        let first = Some((stable * unit, begins * unit));
        Ok(AtRatio { first, first_upper: Some(upper * unit), growing, band_edge })
    }

    /// The longest multiple of the step before the outermost one for the band, all shorter ones holding too;
    /// of one step alone the edge of the band, in fs, to 1e-5 fs.
    fn largest(&self, scheme: &Scheme, band: f64, edge: Option<f64>) -> Result<Option<Rational>> {
        if scheme.steps().len() == 1 {
            let digits = |edge: f64| Rational::new(((edge * 1e5).floor() as i64).into(), 100_000.into());
            return Ok(edge.map(digits).filter(|value| *value > Rational::zero()));
        }
        let holds = |count: u64| -> Result<bool> {
            let (_, levels) = self.at_multiple(scheme, count)?;
            Ok(levels.covers_band(levels.outer_step(), band, self.accuracy))
        };
        let mut found = 0;
        while found < MOST_INNER_STEPS && holds(found + 1)? {
            found += 1;
        }
        Ok((found > 0).then(|| scheme.last_but_one() * Rational::from_integer(found.into())))
    }
}

/// Beyond this many the inner step is so short that nobody means it.
const MOST_INNER_STEPS: u64 = 1000;

/// The edge of a band as it is found: to 1e-6 of itself.
fn rounded_edge(edge: f64) -> (f64, f64) {
    (edge.next_down(), edge * (1.0 + 2e-6))
}

fn amplitudes([re, im]: &[Vec<f64>; 2]) -> Vec<f64> {
    re.iter().zip(im).map(|(re, im)| re.hypot(*im)).collect()
}
