//! Numbers and names for people.

use crate::report::decimal::few;
use molecules::unit::{TimeUnit, decimal};
use molecules::{Bound, Caps, Mode, Origin, PRACTICE, Scheme, Status, Typical};
use number::Rational;

/// A number known to an enclosure, rounded to at most so many significant digits, fewer where the enclosure
/// is wider: every digit is that of both ends' rounding.
///
/// ```
/// use kickdrift_documents::report::advise::nearest;
/// assert_eq!(nearest((4.67679999, 4.67680001), 4), "4.677");
/// assert_eq!(nearest((4.6, 4.7), 4), "5");
/// assert_eq!([nearest((23.9, 23.9), 5), nearest((0.0, 0.0), 3), nearest((-1.72237, -1.72237), 4)], ["23.9", "0", "-1.722"]);
/// ```
pub fn nearest((lo, hi): (f64, f64), digits: usize) -> String {
    let shown = |x: f64, digits: usize| few(x, digits);
    let same = (1..=digits).rev().find(|&n| shown(lo, n) == shown(hi, n));
    same.map_or_else(|| format!("{} to {}", shown(lo, 2), shown(hi, 2)), |n| shown(lo, n))
}

/// A number of so many significant digits at most.
pub(super) fn rounded(x: f64, digits: usize) -> String {
    nearest((x, x), digits)
}

/// The name of a mode and where it comes from, for people.
pub(super) fn named(mode: &Mode, unit: TimeUnit) -> String {
    let period = unit.of(nearest(mode.period(), 4));
    let called = called(mode, unit);
    match mode.origin {
        Origin::Period if called != mode.name => called,
        Origin::Period => format!("{called} (T = {period})"),
        origin => format!("{called} (T = {period} from the {})", origin.name()),
    }
}

/// The name of a mode; one that was given none is called by its period.
pub(super) fn called(mode: &Mode, unit: TimeUnit) -> String {
    if mode.name.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
        return format!("the period of {}", unit.of(nearest(mode.period(), 4)));
    }
    mode.name.clone()
}

/// A judgement as a picture's key explains it; the band is named beside it.
pub(super) fn meaning(status: Status) -> &'static str {
    match status {
        Status::Safe => "proven stable for all periods in the band, below what is published",
        Status::Caution => "proven stable for all periods in the band, beyond a published limit",
        Status::Near => "stable for the periods given, not for all in the band",
        Status::Island => "stable for the periods given, but above an unstable interval",
        Status::Undecided => "neither stable nor unstable is proven",
        Status::Unstable => "grows without bound",
    }
}

/// A length of time in the unit that suits it.
pub(crate) fn time(x: &Rational, unit: TimeUnit) -> String {
    let over = |n: u64| x / Rational::from_integer(n.into());
    let one = Rational::from_integer(1.into());
    let units = [(1_000_000_000_000_000, "s"), (1_000_000, "ns"), (1000, "ps")];
    let found = units.into_iter().find(|(n, _)| unit == TimeUnit::Femtoseconds && over(*n) >= one);
    found.map_or_else(|| length(x, unit), |(n, unit)| format!("{} {unit}", decimal(&over(n))))
}

/// "; within the run of 10 ns", where a run was given and something grows.
pub(super) fn within(run: Option<bool>, length: &Option<Rational>, unit: TimeUnit) -> String {
    let Some((within, length)) = run.zip(length.as_ref()) else { return String::new() };
    format!("; {}within the run of {}", if within { "" } else { "not " }, time(length, unit))
}

pub(super) fn percent(x: &Rational) -> String {
    format!("{} %", decimal(&(x * Rational::from_integer(100.into()))))
}

pub(super) fn length(x: &Rational, unit: TimeUnit) -> String {
    unit.of(decimal(x))
}

pub(super) fn fs(x: &Rational) -> String {
    length(x, TimeUnit::Femtoseconds)
}

/// Three digits, rounded down.
pub(super) fn down(x: f64) -> String {
    let size = 10f64.powi(2 - x.abs().log10().floor() as i32);
    few((x * size).floor() / size, 3)
}

/// A bound on a step, three digits, rounded down.
pub(super) fn cap(x: &Rational, unit: TimeUnit) -> String {
    unit.of(down(number::rational::to_f64(x)))
}

/// What a step of a scheme is not below; a third of the fastest period in words.
pub(super) fn not_below(caps: &Caps, scheme: &Scheme, third: String, unit: TimeUnit) -> String {
    if let Some((clock, own)) = caps.too_long(scheme) {
        let (step, own) = (length(&scheme.steps()[clock], unit), cap(own, unit));
        return match caps.bound(clock) {
            Bound::Aperture => {
                format!("the step of {step} is not below {own}; beyond it hot bonds are lost, as measured")
            }
            _ => format!("the step of {step} is not below T/6.28 = {own} of its own forces"),
        };
    }
    match caps.outer() {
        Some((_, Bound::Third)) => format!("not below T/3 = {}", unit.of(third)),
        Some((own, Bound::Aperture)) => {
            format!("not below {}; beyond it hot bonds are lost, as measured", cap(own, unit))
        }
        Some((own, bound)) => format!("not below {} = {}", bound.name(), cap(own, unit)),
        None => "not below what is published".into(),
    }
}

/// The choice of an outer step: `safe` is below what is published too, `largest` is proven for the whole
/// band.
pub(super) struct Choice<'a> {
    pub scheme: &'a Scheme,
    pub safe: &'a Option<Rational>,
    pub bound: Option<Bound>,
    pub largest: &'a Option<Rational>,
    pub caps: &'a Caps,
    /// In words.
    pub band: &'a str,
    /// The fastest mode in words, and its period.
    pub fastest: (&'a str, (f64, f64)),
    /// Below it all is proven stable for the band; 0 where nothing is.
    pub edge: f64,
    /// Whether the bonds are said to be harmonic.
    pub harmonic: bool,
    pub unit: TimeUnit,
}

impl Choice<'_> {
    /// Which outer step to take.
    pub fn words(&self) -> String {
        let Choice { scheme, band, unit, fastest: (fastest, (lo, hi)), .. } = *self;
        if scheme.steps().len() == 1 {
            return self.alone();
        }
        let of = |x: &Rational| length(x, unit);
        let step = scheme.last_but_one();
        let times = |outer: &Rational| match scheme.steps() {
            [_] => of(outer),
            _ => format!("{} ({} of {})", of(outer), decimal(&(outer / step)), of(step)),
        };
        let part = |n: f64| unit.of(nearest((lo / n, hi / n), 3));
        let third = part(3.0);
        match (self.safe, self.largest) {
            (Some(safe), Some(largest)) if safe == largest => {
                format!(
                    "advice: outer step {}, the longest that is proven stable for all periods within {band}",
                    times(safe)
                )
            }
            (Some(safe), Some(largest)) if self.bound == Some(Bound::SlowTurn) => format!(
                "advice: outer step {}: below T/6.28 = {} of the slow force and proven stable for all periods within {band}; {} is proven too, but \
                 of harmonic forces alone",
                times(safe),
                self.caps.slow().map_or_else(String::new, |value| cap(value, unit)),
                times(largest)
            ),
            (Some(safe), Some(largest)) => format!(
                "advice: outer step {}: below T/3 = {third} and proven stable for all periods within {band}; {} is proven too, but drift is \
                 published beyond T/3",
                times(safe),
                times(largest)
            ),
            (None, Some(largest)) => self.shorter(&times(largest)),
            _ => format!(
                "advice: no outer step is proven stable with {} inside: {fastest} needs inner steps below T/pi = {}, better T/6.28 = {}",
                of(step),
                part(std::f64::consts::PI),
                part(2.0 * std::f64::consts::PI)
            ),
        }
    }

    /// What practice arrived at, of molecules.
    fn practice(&self) -> String {
        if self.unit == TimeUnit::Plain { String::new() } else { format!(" ({PRACTICE})") }
    }

    /// Of a single step.
    fn alone(&self) -> String {
        let Choice { band, unit, edge, fastest: (name, (lo, hi)), .. } = *self;
        if edge <= 0.0 {
            return format!("advice: no step is proven stable for all periods within {band}");
        }
        let edge = unit.of(down(edge));
        match self.caps.outer().filter(|(_, bound)| self.bound == Some(*bound)) {
            Some((value, Bound::Aperture)) => format!(
                "advice: keep the step below {}, as measured and not proven: beyond it hot bonds are lost. All steps below {edge} are proven stable (all \
                 periods within {band}), but for small oscillations alone",
                cap(value, unit),
            ),
            Some((value, _)) => format!(
                "advice: keep the step below {} = T/6.28 of {name}, that is h w <= 1: beyond it bonds that are not harmonic are lost{}. All steps below \
                 {edge} are proven stable (all periods within {band}), but for small oscillations alone: if your bonds are harmonic, say --harmonic",
                cap(value, unit),
                self.practice(),
            ),
            None => format!(
                "advice: keep the step below {edge} (proven for all periods within {band}{}); T/10 = {} resolves {name}",
                if self.harmonic { ", bonds said to be harmonic" } else { "" },
                unit.of(nearest((lo / 10.0, hi / 10.0), 3))
            ),
        }
    }

    /// A step before the outermost one that is too long for any multiple of it.
    fn shorter(&self, largest: &str) -> String {
        let Choice { scheme, band, unit, .. } = *self;
        if let Some((clock, value)) = self.caps.too_long(scheme) {
            let step = length(&scheme.steps()[clock], unit);
            let whose =
                if clock == 0 { "the fastest motion" } else { "the fastest motion of its own forces" };
            let own = cap(value, unit);
            if self.caps.bound(clock) == Bound::Aperture {
                return format!(
                    "advice: none with a step of {step} inside: it is not below {own}; beyond it hot bonds are lost, as measured: take a shorter one. \
                     Up to {largest} is proven stable for all periods within {band}, of small oscillations"
                );
            }
            return format!(
                "advice: none with a step of {step} inside: it is not below T/6.28 = {own} of {whose} (h w <= 1), beyond which bonds that are not \
                 harmonic are lost{}: take a shorter one, or say --harmonic if they are. Up to {largest} is proven stable for all periods \
                 within {band} if they are",
                self.practice()
            );
        }
        let (own, bound) = self
            .caps
            .outer()
            .map_or_else(Default::default, |(value, bound)| (cap(value, unit), bound.name()));
        format!(
            "advice: up to {largest} is proven stable for all periods within {band}; {bound} = {own} is not above the step of {}: shorten that one first",
            length(scheme.last_but_one(), unit)
        )
    }
}

/// A period that is known by name, and where it comes from.
pub(super) fn typical(typical: &Typical) -> String {
    format!(
        "{} is {} fs, the shortest period {} ({})",
        typical.asked(),
        typical.period,
        typical.what,
        typical.source
    )
}
