//! The trace of a ratio through its tongues.

use super::LARGEST_S;
use crate::propagator::{HalfPeriod, TwoClocks, half_period};
use crate::tongue::{Entry, Gap, Tongues};
use number::parallel::map;
use number::{Error, Ratio, Rational, Result, from_f64_exact, to_f64};

/// Tr Q of one ratio over s, in exact arithmetic, rounded to doubles.
///
/// ```
/// use kickdrift_clocks::number::rational::ratio;
/// use kickdrift_clocks::tongue::sampled::Trace;
/// let trace = Trace::through("5/3".parse()?, &ratio(1, 25), Some(3))?;
/// // In the middle of the tongue |Tr Q| exceeds 2, half its width outside it does not.
/// let (middle, outside) = (trace.near.excess[300], trace.near.excess[100]);
/// assert!(middle[0] == 0.5 && middle[1] > 0.0 && outside[0] == -0.5 && outside[1] < 0.0);
/// # Ok::<(), kickdrift_clocks::number::error::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    pub ratio: Ratio,
    pub rho: Rational,
    /// [s, Tr Q] from 0 to the limit of the fast clock.
    pub whole: Vec<[f64; 2]>,
    /// Each tongue's m, lower and upper s.
    pub tongues: Vec<(u64, [f64; 2])>,
    /// The one that is sampled close by.
    pub near: Near,
}

/// One tongue; x is 0 at its lower edge and 1 at its upper one.
#[derive(Clone, Debug, PartialEq)]
pub struct Near {
    pub m: u64,
    pub lower: f64,
    pub width: f64,
    /// [x, ±Tr Q − 2], the sign being (−1)^m: positive where unstable.
    pub excess: Vec<[f64; 2]>,
    /// The two entries of the half-period propagator that vanish at the edges, each over its largest value:
    /// [x, value].
    pub entries: [(Entry, Vec<[f64; 2]>); 2],
}

/// Points of the whole, and of one tongue: closer than a third of a millimetre on paper.
const SAMPLES: u32 = 900;
const SAMPLES_OF_TONGUE: u32 = 600;
/// No thinner tongue, relative to s, is sampled by doubles: a thousand of them between its edges.
const THINNEST: f64 = 2e-13;

impl Trace {
    /// Through all tongues below s = 4, and close by through that of label m, or the widest.
    ///
    /// # Errors
    /// A label that is not there; a tongue that is closed, the last, or too thin; and those of
    /// [`Tongues::gaps`].
    pub fn through(ratio: Ratio, rho: &Rational, m: Option<u64>) -> Result<Trace> {
        let tongues = Tongues::new(ratio, rho)?;
        let gaps = tongues.gaps(1, tongues.last())?;
        let chosen = chosen(&gaps, m)?;
        let at = |s: f64| {
            let s = from_f64_exact(s).expect("a finite place");
            half_period(&TwoClocks::with_rho(ratio, s, rho.clone()))
        };
        let places: Vec<f64> = (0..=SAMPLES).map(|n| LARGEST_S * f64::from(n) / f64::from(SAMPLES)).collect();
        let whole = map(&places, |&s| [s, to_f64(&at(s).trace())]);
        let spans = gaps
            .iter()
            .filter(|gap| gap.middles()[0] < LARGEST_S)
            .map(|gap| (gap.m, gap.middles().map(|edge| edge.min(LARGEST_S))));
        let near = near(chosen, at);
        Ok(Trace { ratio, rho: rho.clone(), whole, tongues: spans.collect(), near })
    }
}

/// From one width below the tongue to one above it.
fn near(gap: &Gap, at: impl Fn(f64) -> HalfPeriod<Rational> + Sync) -> Near {
    let (m, [lower, upper]) = (gap.m, gap.middles());
    let places: Vec<f64> =
        (0..=SAMPLES_OF_TONGUE).map(|n| 3.0 * f64::from(n) / f64::from(SAMPLES_OF_TONGUE) - 1.0).collect();
    let halves = map(&places, |x| at(lower + x * (upper - lower)));
    let two = Rational::from_integer(2.into());
    let sign = |trace: Rational| if m.is_multiple_of(2) { trace } else { -trace };
    let excess =
        places.iter().zip(&halves).map(|(x, half)| [*x, to_f64(&(sign(half.trace()) - &two))]).collect();
    let entries = [gap.lower.entry, gap.upper.expect("not the last").entry].map(|entry| {
        let values: Vec<f64> = halves.iter().map(|half| to_f64(value(half, entry))).collect();
        let largest = values.iter().fold(0.0, |a: f64, value| a.max(value.abs()));
        (entry, places.iter().zip(values).map(|(x, value)| [*x, value / largest]).collect())
    });
    Near { m, lower, width: upper - lower, excess, entries }
}

fn value(half: &HalfPeriod<Rational>, entry: Entry) -> &Rational {
    match entry {
        Entry::A => half.a(),
        Entry::B => half.b(),
        Entry::C => half.c(),
        Entry::D => half.d(),
    }
}

fn chosen(gaps: &[Gap], m: Option<u64>) -> Result<&Gap> {
    let width = |gap: &Gap| gap.middles()[1] - gap.middles()[0];
    let Some(m) = m else {
        let inner = gaps.iter().filter(|gap| gap.middles()[1] < LARGEST_S && !gap.closed);
        return inner.max_by(|a, b| width(a).total_cmp(&width(b))).ok_or_else(|| {
            Error::input("ratio", "given", "has no tongue below s = 4 to look at: choose another")
        });
    };
    let refused = |remedy: &str| Err(Error::input("m", m, remedy));
    match gaps.iter().find(|gap| gap.m == m) {
        Some(gap) if gap.upper.is_none() => {
            refused("is the last tongue, which has no end: choose a smaller label")
        }
        Some(gap) if gap.closed => refused("is closed at this rho: choose another rho"),
        Some(gap) if width(gap) < THINNEST * gap.lower.hi => {
            refused("is too thin to draw: choose a larger rho")
        }
        Some(gap) => Ok(gap),
        None => refused("give one label that there is: the trace goes through one tongue"),
    }
}
