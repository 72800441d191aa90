//! The answer of advice: scheme by scheme, and which step to take.

use num_traits::{One, Zero};

use super::aperture::Cold;
use super::beads::Beads;
use super::caps::{Bound, Caps};
use super::edges::Edges;
use super::interval::{Intervals, Unstable};
use super::levels::{Found, Levels, Scheme, scaled};
use super::levers::Levers;
use super::mode::Mode;
use super::question::Question;
use super::unit::TimeUnit;
use clocks::band::unstable_ratios;
use clocks::verdict::Kind;
use number::rational::enclose_f64;
use number::{Ball, Laurent, Ratio, Rational, Result, from_f64_exact, named, to_f64};
use systems::Limits;
use systems::friction::Masked;

const BITS: u32 = 128;

named! {
    /// The judgement of a scheme, the best first.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Status {
        /// Proven stable for every period in the band, and below all that is published; of a clock without a
        /// period as far as [`Answer::needs`] says.
        Safe = "safe",
        /// Proven stable for every period in the band; beyond a published limit.
        Caution = "caution",
        /// Below the first unstable interval of the periods given, not of all in the band.
        Near = "near",
        /// Stable for the periods given, but above an unstable interval.
        Island = "island",
        /// Within the accuracy of the measured stiffnesses no verdict is proven; or nothing is known of the
        /// fastest motion.
        Undecided = "not told",
        /// Unstable.
        Unstable = "unstable",
    }
}

/// One fast mode at one scheme, with the stiffest modes on the other clocks.
#[derive(Clone, Debug)]
pub struct Row {
    /// Its place in [`Advice::modes`].
    pub mode: usize,
    pub found: Found,
    /// The bias of its potential energy where it is kicked ([`Levels::bias`]); `None` unless it is stable.
    pub bias: Option<(f64, f64)>,
    /// Outer steps until an amplitude is tenfold, enclosed; `None` unless it grows exponentially.
    pub tenfold_steps: Option<(f64, f64)>,
    /// The first unstable interval of outer steps at the ratio of the scheme. Its upper end and growth are
    /// known for one or two clocks.
    pub first: Option<Unstable>,
    /// With two clocks: the unstable intervals next to a stable scheme, below and above; for an unstable
    /// scheme the interval that holds it.
    pub below: Option<Unstable>,
    pub above: Option<Unstable>,
    pub inside: Option<Unstable>,
    /// Open intervals from the first one on, up to some way beyond the scheme and the first of them; at
    /// most 32.
    pub intervals: Vec<Unstable>,
    /// Where it grows: the frictions per fs that mask that (BAOAB).
    pub masking: Option<Masked>,
    /// Whether the friction given keeps it bounded.
    pub is_damped: Option<bool>,
    /// With two clocks, where it grows: with the inner step every ratio of steps from lo to hi, rational or
    /// not, is unstable; `None` where that is not proven ([`unstable_ratios`]).
    pub ratios: Option<(Rational, Rational)>,
}

/// The most intervals that are listed of a row.
pub const MOST_INTERVALS: usize = 32;

/// Intervals are listed that begin below so many times the scheme's outer step, or the end of the first
/// interval.
const REACH: f64 = 1.1;

pub fn reach(first_upper: Option<f64>, outer: f64) -> f64 {
    REACH * first_upper.map_or(outer, |upper| upper.max(outer))
}

/// Two modes that a coupling can make resonate.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    pub modes: [usize; 2],
    /// The outer step near which w_i + w_j = 2 π/H, at the ratio of the scheme; first order, rounded.
    pub near: f64,
}

/// A mode's place in [`Advice::modes`], and its bias.
pub type Biased = (usize, (f64, f64));

/// The one that is most off.
pub fn most_biased(all: impl IntoIterator<Item = Biased>) -> Option<Biased> {
    let off = |(_, (lo, _)): &Biased| lo.ln().abs();
    all.into_iter().max_by(|a, b| off(a).total_cmp(&off(b)))
}

/// The answer about one scheme.
#[derive(Clone, Debug)]
pub struct Answer {
    pub scheme: Scheme,
    pub status: Status,
    pub rows: Vec<Row>,
    /// Every outer step below this, in fs, at this ratio, is proven stable for every period in the band.
    pub band_edge: (f64, f64),
    /// The longest outer step, a multiple of the step before it, that is proven stable for every period in
    /// the band; `None`: not even that step itself, or a clock is without a period.
    pub largest: Option<Rational>,
    /// The longest multiple that is `largest` at most and below what is published ([`Caps`]); `None` also
    /// where an inner step is not.
    pub safe: Option<Rational>,
    /// What bounds `safe`.
    pub bound: Option<Bound>,
    /// With that outermost step: the mode whose potential energy is most off, and its bias.
    pub safe_bias: Option<Biased>,
    /// Where nothing is known to be on other clocks than the innermost: the shortest period there, in fs, for
    /// which the scheme is proven stable for every period in the band; rounded up.
    pub needs: Option<f64>,
    pub pairs: Vec<Pair>,
    /// Where it grows: whether an amplitude is tenfold within the run.
    pub within_run: Option<bool>,
}

/// All answers.
#[derive(Clone, Debug)]
pub struct Advice {
    pub modes: Vec<Mode>,
    pub band: Rational,
    pub length: Option<Rational>,
    /// The place of the fastest mode on any clock but the outermost.
    pub fastest: usize,
    pub schemes: Vec<Answer>,
    /// Whether a clock is without a mode.
    pub silent: bool,
    /// Whether nothing is known of the fastest clock: then no step is called safe.
    pub lacks_fast: bool,
    /// What bounds the steps beside linear theory.
    pub caps: Caps,
    /// Whether the bonds are said to be harmonic.
    pub harmonic: bool,
    /// Of bonds whose shape is known: where they begin to be too hot, by each kind of scheme.
    pub cold: Vec<Cold>,
    pub beads: Option<Beads>,
    /// Of all times.
    pub unit: TimeUnit,
    /// Modes that constraints hold: they are on no clock.
    pub held: Vec<Mode>,
    /// Per fs.
    pub friction: Option<Rational>,
    /// Changes that would let the outer step of the first scheme grow; `None` where that was not asked.
    pub levers: Option<Levers>,
    /// Whether the periods are the shortest of all motions on their clocks.
    pub all_modes: bool,
}

impl Question {
    /// The answer: each mode at each scheme decided by the certified ladder.
    ///
    /// # Errors
    /// A budget error where a ratio of steps makes too long a period.
    pub fn answer(self) -> Result<Advice> {
        self.allow()?;
        let schemes = self.schemes.iter().map(|scheme| self.of_scheme(scheme)).collect::<Result<_>>()?;
        let faster = self.faster();
        let stiffness = |&i: &usize| &self.modes[i].stiffness;
        let fastest = faster.into_iter().max_by(|i, j| stiffness(i).cmp(stiffness(j))).expect("a mode");
        let silent = self.stiffest().iter().any(Option::is_none);
        let levers = if self.levers { Some(self.levers()?) } else { None };
        let (lacks_fast, caps) = (self.lacks_fast(), self.caps());
        let Question { modes, band, length, held, friction, all_modes, harmonic, cold, beads, unit, .. } =
            self;
        Ok(Advice {
            fastest,
            silent,
            lacks_fast,
            caps,
            harmonic,
            cold,
            beads,
            unit,
            schemes,
            modes,
            band,
            length,
            held,
            friction,
            levers,
            all_modes,
        })
    }

    fn of_scheme(&self, scheme: &Scheme) -> Result<Answer> {
        let rows =
            self.faster().into_iter().map(|mode| self.row(scheme, mode)).collect::<Result<Vec<_>>>()?;
        let corner = self.corner(scheme);
        let in_band = corner.in_first_region(&Ball::one()) == Some(true);
        let ends = rows.iter().filter_map(|row| row.first.as_ref()).map(|first| first.lower);
        let edge = ends.fold((f64::INFINITY, f64::INFINITY), |a, b| (a.0.min(b.0), a.1.min(b.1)));
        let shrink =
            |x: f64| from_f64_exact(x).map_or((x, x), |x| enclose_f64(&(x * (Rational::one() - &self.band))));
        let (caps, outer) = (self.caps(), scheme.outer());
        let is_known = self.stiffest().iter().all(Option::is_some) && !self.lacks_fast();
        let largest = if is_known { self.largest(scheme)? } else { None };
        let (safe, bound) = caps.safe(scheme, largest.as_ref()).filter(|_| self.beads.is_none()).unzip();
        let safe_bias = safe.as_ref().and_then(|outer| self.most_biased(scheme, outer));
        let status = if self.lacks_fast() {
            Status::Undecided
        } else if rows.iter().any(|row| !row.found.kind.is_stable()) {
            Status::Unstable
        } else if in_band {
            match () {
                () if self.beads.is_some() => Status::Undecided,
                () if caps.hold(scheme) => Status::Safe,
                () => Status::Caution,
            }
        } else if rows.iter().all(|row| row.is_before_first(outer)) {
            Status::Near
        } else {
            Status::Island
        };
        let fewest_to_tenfold =
            rows.iter().filter_map(|row| row.tenfold_steps).map(|(_, hi)| hi).fold(f64::INFINITY, f64::min);
        let grows = fewest_to_tenfold.is_finite();
        let time = fewest_to_tenfold * to_f64(outer);
        let within_run = self.length.as_ref().filter(|_| grows).map(|length| time <= to_f64(length));
        let needs = self.needs(scheme, in_band);
        let pairs = self.pairs(scheme);
        let band_edge = (shrink(edge.0).0, shrink(edge.1).1);
        Ok(Answer {
            scheme: scheme.clone(),
            status,
            rows,
            band_edge,
            largest,
            safe,
            bound,
            safe_bias,
            needs,
            pairs,
            within_run,
        })
    }

    /// With another outermost step than that of a scheme, or with none beside the one before it.
    fn most_biased(&self, scheme: &Scheme, outer: &Rational) -> Option<Biased> {
        let is_merged = scheme.steps().len() > 1 && outer == scheme.last_but_one();
        let scheme = if is_merged { scheme.merged() } else { scheme.with_outer(outer.clone()) }.ok()?;
        let bias = |mode: usize| {
            let mut stiffness = self.with(mode);
            let above = stiffness.split_off(scheme.steps().len());
            above.into_iter().for_each(|own| *stiffness.last_mut().expect("at least one clock") += own);
            Some((mode, Levels { scheme: &scheme, stiffness }.bias()?))
        };
        most_biased(self.faster().into_iter().filter_map(bias))
    }

    /// One mass with the shortest periods of the band: the corner that covers all of it.
    fn corner<'a>(&self, scheme: &'a Scheme) -> Levels<'a> {
        let shorter = Rational::one() - &self.band;
        let factor = Laurent::from_rational((&shorter * &shorter).recip());
        let of = |i: Option<usize>| i.map_or_else(Laurent::zero, |i| &self.modes[i].stiffness * &factor);
        Levels { scheme, stiffness: self.stiffest().into_iter().map(of).collect() }
    }

    fn row(&self, scheme: &Scheme, mode: usize) -> Result<Row> {
        let levels = Levels { scheme, stiffness: self.with(mode) };
        let found = levels.decide(&Limits::default())?;
        let tenfold_steps = (found.rate.0 > 0.0).then(|| tenfold(found.rate, scheme.outer()));
        let masking = tenfold_steps.and_then(|_| levels.masking());
        let mut row = Row {
            mode,
            bias: levels.bias().filter(|_| found.kind == Kind::Elliptic),
            tenfold_steps,
            masking,
            is_damped: self.friction.as_ref().and_then(|rate| levels.is_damped_by(rate)),
            found,
            ratios: None,
            first: None,
            below: None,
            above: None,
            inside: None,
            intervals: Vec::new(),
        };
        let outer = to_f64(scheme.outer());
        let (fast, slow) =
            (&levels.stiffness[0], levels.stiffness.get(1).cloned().unwrap_or_else(Laurent::zero));
        if scheme.steps().len() > 2 || fast.is_zero() {
            self.many_clocks(&mut row, &levels)?;
            return Ok(row);
        }
        let times = scheme.outer() / scheme.inner();
        if scheme.steps().len() == 2 && row.tenfold_steps.is_some() {
            let inner = Laurent::from_rational(scheme.inner().clone());
            row.ratios = unstable_ratios([fast, &slow], &inner, &times);
        }
        let ratio = Ratio::try_from(&times)?;
        let intervals = Intervals::new(ratio, fast, &slow)?;
        row.first = Some(intervals.first()?);
        if row.found.kind.is_stable() {
            [row.below, row.above] = intervals.about(outer)?;
        } else if let Some(label) = row.found.label {
            row.inside = intervals.get(label)?;
        }
        let reach = reach(row.first.as_ref().and_then(|first| first.upper).map(|upper| upper.1), outer);
        row.intervals = intervals.up_to(reach, MOST_INTERVALS)?;
        Ok(row)
    }

    /// The intervals of three clocks and more, and of a fast clock without a mode.
    fn many_clocks(&self, row: &mut Row, levels: &Levels) -> Result<()> {
        let (lo, hi) = levels.first_region_ends()?;
        let outer = to_f64(levels.scheme.outer());
        row.first = Some(Unstable {
            label: 1,
            lower: scaled((lo, hi), levels.scheme.outer()),
            upper: None,
            worst: None,
        });
        let Some(edges) = Edges::new(levels) else { return Ok(()) };
        row.intervals = edges.all(REACH * hi.max(1.0) * REACH, MOST_INTERVALS);
        let upper = |unstable: &Unstable| unstable.upper.map_or(f64::INFINITY, |upper| upper.1);
        row.first = row.intervals.iter().find(|interval| interval.label == 1).cloned().or(row.first.take());
        if row.found.kind.is_stable() {
            row.below = row.intervals.iter().rev().find(|interval| upper(interval) <= outer).cloned();
            row.above = row.intervals.iter().find(|interval| interval.lower.0 >= outer).cloned();
        } else {
            row.inside =
                row.intervals.iter().find(|interval| Some(interval.label) == row.found.label).cloned();
        }
        Ok(())
    }

    /// The largest multiple of the step before the outermost one at which the corner of the band is in the
    /// first region.
    pub(super) fn largest(&self, scheme: &Scheme) -> Result<Option<Rational>> {
        let step = scheme.last_but_one();
        if scheme.steps().len() == 1 {
            let edge = self.corner(scheme).first_region_ends()?.0;
            return Ok(from_f64_exact(edge).map(|edge| edge * step));
        }
        let times = |p: u64| step * Rational::from_integer(p.into());
        let holds = |p: u64| -> Result<bool> {
            // One level less where the outermost step is the one before it.
            let stable = |levels: &Levels| levels.in_first_region(&Ball::one()) == Some(true);
            if p == 1 {
                let merged = Scheme::new(scheme.steps()[..scheme.steps().len() - 1].to_vec())?;
                let mut stiffness = self.corner(scheme).stiffness;
                let last = stiffness.pop().expect("at least two clocks");
                *stiffness.last_mut().expect("at least one clock") += last;
                return Ok(stable(&Levels { scheme: &merged, stiffness }));
            }
            let other = scheme.with_outer(times(p))?;
            Ok(stable(&Levels { scheme: &other, stiffness: self.corner(scheme).stiffness }))
        };
        if !holds(1)? {
            return Ok(None);
        }
        let mut found = 1;
        if scheme.steps().len() == 2 {
            // p θ < π and sin θ cot(p θ/2) > (p/2) h² L2 (proofs/REGION.md, section 2): both fail for good as
            // p grows.
            let mut beyond = 2;
            while beyond < MOST_INNER_STEPS && holds(beyond)? {
                (found, beyond) = (beyond, 2 * beyond);
            }
            while beyond - found > 1 {
                let middle = found + (beyond - found) / 2;
                if holds(middle)? { found = middle } else { beyond = middle }
            }
        } else {
            while found < MOST_STEPS_OF_MANY && holds(found + 1)? {
                found += 1;
            }
        }
        Ok(Some(times(found)))
    }

    /// See [`Answer::needs`].
    fn needs(&self, scheme: &Scheme, in_band: bool) -> Option<f64> {
        let mut corner = self.corner(scheme);
        let silent: Vec<usize> =
            (1..corner.stiffness.len()).filter(|&k| corner.stiffness[k].is_zero()).collect();
        if !in_band || self.lacks_fast() || silent.is_empty() {
            return None;
        }
        let mut stable = |slow: f64| {
            let value = Laurent::from_rational(from_f64_exact(slow)?);
            silent.iter().for_each(|&k| corner.stiffness[k] = value.clone());
            corner.in_first_region(&Ball::one()).filter(|&holds| holds)
        };
        // From a period of 2 π 10^8 fs down.
        let mut lo = 1e-16;
        stable(lo)?;
        let mut hi = lo;
        while stable(hi).is_some() && hi < 1e16 {
            (lo, hi) = (hi, 4.0 * hi);
        }
        while hi > 1.000_001 * lo {
            let middle = (lo * hi).sqrt();
            if stable(middle).is_some() { lo = middle } else { hi = middle }
        }
        let shorter = Ball::from_rational(&(Rational::one() - &self.band), BITS);
        let frequency = Ball::from_rational(&from_f64_exact(lo)?, BITS).sqrt(BITS)?.mul(&shorter, BITS);
        Some(Ball::pi(BITS).scale2(1).div(&frequency, BITS)?.to_f64_enclosure().1)
    }

    fn pairs(&self, scheme: &Scheme) -> Vec<Pair> {
        let faster = self.faster();
        let period = |i: usize| self.modes[i].part(1).0;
        let parts = to_f64(&(scheme.outer() / scheme.inner()));
        let near = |i: usize, j: usize| {
            // Turns of both in an outer step of length x, as velocity Verlet with the inner step makes them.
            let angle =
                |x: f64, t: f64| 2.0 * parts * (std::f64::consts::PI * x / (parts * t)).min(1.0).asin();
            let turns = |x: f64| angle(x, period(i)) + angle(x, period(j));
            let (mut lo, mut hi) = (0.0, period(i).max(period(j)) * parts);
            for _ in 0..60 {
                let middle = (lo + hi) / 2.0;
                if turns(middle) < 2.0 * std::f64::consts::PI { lo = middle } else { hi = middle }
            }
            // Beyond the inner step's own limit a mode grows by itself; with one step both are there before
            // they meet.
            let is_within = |i: usize| std::f64::consts::PI * lo < (1.0 - 1e-9) * parts * period(i);
            (is_within(i) && is_within(j)).then_some(lo)
        };
        let ordered =
            faster.iter().enumerate().flat_map(|(n, &i)| faster[n + 1..].iter().map(move |&j| [i, j]));
        ordered.filter_map(|modes| Some(Pair { modes, near: near(modes[0], modes[1])? })).collect()
    }
}

/// Beyond these the step before the outermost one is so short that nobody means it.
const MOST_INNER_STEPS: u64 = 100_000;
const MOST_STEPS_OF_MANY: u64 = 300;

impl Row {
    /// Whether the outer step is proven to lie before the first unstable interval.
    fn is_before_first(&self, outer: &Rational) -> bool {
        let edge = self.first.as_ref().and_then(|first| from_f64_exact(first.lower.0));
        edge.is_some_and(|edge| *outer < edge)
    }
}

/// ln 10 over the rate, in steps of this length.
fn tenfold((lo, hi): (f64, f64), step: &Rational) -> (f64, f64) {
    let ten = Ball::from_integer(&10.into()).ln(BITS).expect("10 > 0");
    let step = Ball::from_rational(step, BITS);
    let over = |rate: f64| {
        let rate = from_f64_exact(rate).map(|rate| Ball::from_rational(&rate, BITS).mul(&step, BITS));
        rate.and_then(|rate| ten.div(&rate, BITS)).map(|steps| steps.to_f64_enclosure())
    };
    (over(hi).map_or(0.0, |steps| steps.0), over(lo).map_or(f64::INFINITY, |steps| steps.1))
}
