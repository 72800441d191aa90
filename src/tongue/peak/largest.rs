//! The largest growth inside a tongue.
//!
//! ln of the multiplier per period is ln μ = 2 asinh √E, E = BC where Tr > 2 and −AD where Tr < −2; the growth rate per
//! unit time at fixed L1 is that over T = p h1 = p √(s/L1).
//!
//! **One peak.** An entry is a product of factors 1 − s/s_k over its zeros (C: times s), all of them positive. Each factor's
//! ln |1 − s/s_k| is concave in σ = ln s on either side of s_k, so ln E is concave in σ inside the tongue. So is ln ln μ, since
//! ln asinh e^y rises and is concave; and the rate's logarithm, which is that less σ/2. Hence the rate has exactly
//! one maximum in a tongue, where with w = asinh √E = ½ ln μ
//!
//! ```text
//!     d ln E/dσ = w coth w.
//! ```
//!
//! The difference of the two sides falls in σ, from ∞ at the lower edge a to −∞ at the upper edge b; times
//! (1 − a/s)(1 − s/b)/(1 − a/b) it goes from 1 to −1, and is all but straight where the tongue is narrow. Its zero is found by regula
//! falsi with σ as the variable, so that edges any number of decades apart are no different. The entries at a point
//! come from [`super::meet`], in two doubles: three to ten evaluations a peak, each O(p + q), and no other edge is needed.
//!
//! **Thin tongues.** Where the relative width δ is below 2^-52 the middle is the place and the parabola's height there the value
//! ([`super::meet`]), n nodes making it wrong by some n δ relative.
//!
//! **Nothing is guessed.** Each value comes with a bound of what rounding can have done to it, and where that shows in a
//! double, as where the two edges all but meet (near a closing), big numbers take over.

use super::meet::Meeting;
use crate::error::{Error, Result};
use crate::number::{Laurent, Rational, Twofold, rational};
use crate::propagator::TwoClocks;
use crate::tongue::edge::{Edge, Edges, Enclosure, negative_log2};
use crate::tongue::gap::Gap;
use crate::tongue::string::HalfString;
use crate::verdict::{Limits, Side, Verdict, growth};

/// The fastest growth in a tongue; rounded: s to nine digits, the rate to fifteen; the rest is that of a place which is s
/// before rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Where.
    pub s: f64,
    /// Growth of ln amplitude per period.
    pub ln_multiplier: f64,
    /// The same per unit time, in units of √L1.
    pub rate: f64,
    /// Slow steps h2 until the amplitude is ten times as large.
    pub slow_steps_to_tenfold: f64,
}

/// Relative widths up to this are thin: doubles do not tell the edges apart.
const THIN: f64 = f64::EPSILON;

/// Relative widths up to this are too narrow for edges in doubles: they are wrong by 1e-10 of the width.
const NARROW: f64 = 1e-6;

/// Below this relative width the middle is the place, to within the square of it.
const POINT: f64 = 1e-10;

/// The last step, relative to s and to the tongue's width alike: the rate is flat to the square of it.
const STEP: f64 = 1e-10;

/// Steps at most; regula falsi needs three to ten.
const STEPS: u32 = 100;

impl Peak {
    /// The peak of an open, finite tongue; `None` of any other.
    ///
    /// # Errors
    /// Where the schedule is too long, or more digits are needed than are tried.
    pub(crate) fn new(edges: &Edges, gap: &Gap) -> Result<Option<Peak>> {
        let Some(upper) = gap.upper.filter(|_| !gap.closed) else { return Ok(None) };
        // Of a long period one point by more bits costs less than the string.
        let is_thin = gap.width.1 <= POINT * gap.lower.lo;
        let in_doubles = match () {
            () if edges.is_long() && is_thin => None,
            () => Inside::new(edges.string()?, gap, &upper).fastest(),
        };
        let (s, ln_multiplier) = in_doubles.map_or_else(|| fastest_by_bits(edges, gap, &upper), Ok)?;
        Ok(Some(Peak {
            s,
            ln_multiplier,
            rate: ln_multiplier / (edges.ratio().p() as f64 * s.sqrt()),
            slow_steps_to_tenfold: std::f64::consts::LN_10 * edges.ratio().q() as f64 / ln_multiplier,
        }))
    }

    /// The growth rate per unit time for a fast stiffness L1, rounded: `rate` is in units of √L1.
    pub fn growth_rate(&self, lambda1: &Laurent) -> f64 {
        self.rate * lambda1.to_f64().sqrt()
    }
}

/// s and ln μ by golden section and certified enclosures: slow, and always right.
fn fastest_by_bits(edges: &Edges, gap: &Gap, upper: &Edge) -> Result<(f64, f64)> {
    let [a, b] = parted(edges, &gap.lower, upper, gap.width.0)?;
    let width = &b - &a;
    let ratio = rational::to_f64(&(&width / &a));
    let at = |u: f64| {
        let part = if ratio > THIN { (u * ratio.ln_1p()).exp_m1() / ratio } else { u };
        &a + &width * rational::from_f64_exact(part).expect("finite")
    };
    let ln = |s: &Rational| ln_multiplier_by_bits(edges, s, gap.m);
    let rate = |u: f64| Ok(ln(&at(u))? / rational::to_f64(&at(u)).sqrt());
    let u = if ratio > POINT { golden(rate)? } else { 0.5 };
    Ok((rational::to_f64(&at(u)), ln(&at(u))?))
}

/// Points at the edges, to within 1e-8 of their distance.
fn parted(edges: &Edges, lower: &Edge, upper: &Edge, width: f64) -> Result<[Rational; 2]> {
    let [mut a, mut b] = [lower, upper].map(Enclosure::from);
    // Those of the tongue's relative width (a binary digit is 0.3 decimal ones), and ten more.
    let mut digits =
        3 * negative_log2(&rational::from_f64_exact(width / lower.lo).expect("finite")) / 10 + 10;
    while (a.width() + b.width()) * Rational::from_integer(100_000_000.into()) > &b.lo - &a.hi {
        (a, b) = (edges.sharpened(lower, &a, digits)?, edges.sharpened(upper, &b, digits)?);
        digits *= 2;
    }
    Ok([a.middle(), b.middle()])
}

fn ln_multiplier_by_bits(edges: &Edges, s: &Rational, m: u64) -> Result<f64> {
    let verdict = Verdict::Hyperbolic(Side::of_half_turns(m));
    let clocks = TwoClocks::with_rho(edges.ratio(), s.clone(), edges.rho().clone());
    let ln = growth(&clocks, verdict, &Limits::default())?.ln_multiplier.map(|ln| ln.mid_f64());
    ln.filter(|&ln| ln > 0.0).ok_or_else(|| {
        let cost = format!("the growth of tongue {m} at s = {}", rational::to_f64(s));
        Error::too_much(format!("{cost} needs more digits than are tried"), "choose a simpler ratio")
    })
}

/// A tongue in doubles.
struct Inside<'a> {
    string: &'a HalfString,
    odd: bool,
    /// a, and b − a.
    lower: Twofold,
    width: f64,
}

impl<'a> Inside<'a> {
    fn new(string: &'a HalfString, gap: &Gap, upper: &Edge) -> Self {
        let odd = gap.m % 2 == 1;
        let middle = |edge: &Edge| Twofold { hi: edge.middle(), lo: 0.0 };
        let (mut lower, mut width) = (middle(&gap.lower), 0.5 * (gap.width.0 + gap.width.1));
        let relative = width / lower.hi;
        if THIN < relative && relative < NARROW {
            let sharper = |edge: &Edge| {
                let s = middle(edge);
                let to = Meeting::new(string, s, odd).pair[usize::from(!edge.entry.starts_free())].to_zero();
                s.plus(s.scaled(to))
            };
            lower = sharper(&gap.lower);
            width = sharper(upper).minus(lower).hi;
        }
        Inside { string, odd, lower, width }
    }

    /// s and ln μ where the rate is largest; `None` where rounding shows.
    fn fastest(&self) -> Option<(f64, f64)> {
        if self.width <= THIN * self.lower.hi {
            let (ln, to) = Meeting::new(self.string, self.lower, self.odd).in_the_middle()?;
            return Some((self.lower.hi + self.lower.hi * to, ln));
        }
        let (mut below, mut above) = ((0.0, 1.0), (1.0, -1.0));
        let step = STEP / (self.width / self.lower.hi).ln_1p().max(1.0);
        let mut last: Option<(f64, f64, f64)> = None;
        let mut before = 0.0;
        for _ in 0..STEPS {
            let u = (below.0 * above.1 - above.0 * below.1) / (above.1 - below.1);
            if let Some((_, s, ln)) = last.filter(|last| (u - last.0).abs() <= step) {
                return Some((s, ln));
            }
            let (s, ln, balance) = self.at(u)?;
            last = Some((u, s, ln));
            // Illinois: an end that stays twice counts half.
            let half = if balance * before > 0.0 { 0.5 } else { 1.0 };
            if balance > 0.0 {
                (below, above.1) = ((u, balance), half * above.1);
            } else {
                (above, below.1) = ((u, balance), half * below.1);
            }
            before = balance;
        }
        None
    }

    /// s, ln μ and the two sides' difference where ln(s/a) is the share u of ln(b/a).
    fn at(&self, u: f64) -> Option<(f64, f64, f64)> {
        let (a, width) = (self.lower.hi, self.width);
        let from = a * (u * (width / a).ln_1p()).exp_m1();
        let s = self.lower.plus(Twofold { hi: from, lo: 0.0 });
        let meeting = Meeting::new(self.string, s, self.odd);
        let ln = meeting.ln_multiplier()?;
        let w = 0.5 * ln;
        let balance = from * (width - from) / (s.hi * width) * (meeting.rise() - w / w.tanh());
        balance.is_finite().then_some((s.hi, ln, balance))
    }
}

/// Where f, with one maximum in [0, 1], has it: 44 sections that keep 0.618 each leave 6e-10, where f is flat to 1e-18.
fn golden(f: impl Fn(f64) -> Result<f64>) -> Result<f64> {
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    let (mut lo, mut hi) = (0.0, 1.0);
    let (mut x, mut y) = (1.0 - ratio, ratio);
    let (mut at_x, mut at_y) = (f(x)?, f(y)?);
    for _ in 0..44 {
        if at_x > at_y {
            (hi, y, at_y) = (y, x, at_x);
            x = hi - ratio * (hi - lo);
            at_x = f(x)?;
        } else {
            (lo, x, at_x) = (x, y, at_y);
            y = lo + ratio * (hi - lo);
            at_y = f(y)?;
        }
    }
    Ok(0.5 * (lo + hi))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Ratio;
    use crate::number::rational::ratio;
    use crate::tongue::Tongues;

    #[test]
    fn doubles_and_big_numbers_agree() {
        let power = |n: i32| Rational::from_integer(10.into()).pow(n);
        let (mut seen, mut left) = (0, 0);
        for decade in [-12, -6, -3, -1, 0, 2, 6, 12] {
            for (p, q) in [(2, 1), (1, 2), (7, 3), (5, 6), (4, 9), (19, 16)] {
                let rho = ratio(7, 5) * power(decade);
                let edges = Edges::new(Ratio::new(p, q).unwrap(), &rho).unwrap();
                for gap in Tongues::new(Ratio::new(p, q).unwrap(), &rho).unwrap().all().unwrap() {
                    let Some(upper) = gap.upper.filter(|_| !gap.closed) else { continue };
                    seen += 1;
                    let Some((s, ln)) = Inside::new(edges.string().unwrap(), &gap, &upper).fastest() else {
                        left += 1;
                        continue;
                    };
                    let (t, exact) = fastest_by_bits(&edges, &gap, &upper).unwrap();
                    let rate = |s: f64, ln: f64| ln / s.sqrt();
                    // Golden section sees a maximum to the root of a rounding.
                    assert!((s - t).abs() < 1e-7 * t, "{p}/{q}, 10^{decade}: {s}, {t}, {gap:?}");
                    let error = rate(s, ln) / rate(t, exact) - 1.0;
                    assert!(error.abs() < 1e-15, "{p}/{q}, 10^{decade}: {error}, {gap:?}");
                }
            }
        }
        // A bound on how often doubles give up: slow or fast forces of 1e-12 leave 1e-14 of an edge between the two.
        assert!(seen > 500 && left < seen / 5, "{left} of {seen}");
    }

    /// The widths relative to s are 1e-11 to 1e-12: edges by return maps are sharp enough, as 40 digits by kicks show.
    #[test]
    fn thin_tongues_of_a_long_period_grow_as_their_kicks_say() {
        let edges = Edges::new(Ratio::new(30001, 30000).unwrap(), &ratio(121, 10_000)).unwrap();
        for gap in Tongues::new(edges.ratio(), edges.rho()).unwrap().gaps(1, 2).unwrap() {
            let upper = gap.upper.unwrap();
            assert!(edges.is_long() && gap.width.1 < POINT * gap.lower.lo);
            let [a, b] = [&gap.lower, &upper].map(|edge| edges.refine(edge, 40).unwrap().middle());
            let exact = ln_multiplier_by_bits(&edges, &((a + b) / Rational::from_integer(2.into())), gap.m);
            let (_, ln) = fastest_by_bits(&edges, &gap, &upper).unwrap();
            // The rate is flat in the middle, to the square of the 1e-8 of a width that the place may be off.
            assert!((ln / exact.unwrap() - 1.0).abs() < 1e-14, "{ln} {gap:?}");
        }
    }
}
