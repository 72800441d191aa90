//! The largest growth inside a tongue.
//!
//! ln of the multiplier per period is ln μ = 2 asinh √E, E = BC where Tr > 2 and −AD where Tr < −2; the
//! growth rate per unit time at fixed L1 is that over T = p h1 = p √(s/L1).
//!
//! **One peak.** An entry is a product of factors 1 − s/s_k over its zeros (C: times s), all of them
//! positive. Each factor's ln |1 − s/s_k| is concave in σ = ln s on either side of s_k, so ln E is concave in
//! σ inside the tongue. So is ln ln μ, since ln asinh e^y rises and is concave; and the rate's logarithm,
//! which is that less σ/2. Hence the rate has exactly one maximum in a tongue, where with w = asinh √E = ½ ln
//! μ
//!
//! ```text
//!     d ln E/dσ = w coth w.
//! ```
//!
//! The difference of the two sides falls in σ, from ∞ at the lower edge a to −∞ at the upper edge b; times
//! (1 − a/s)(1 − s/b)/(1 − a/b) it goes from 1 to −1, and is all but straight where the tongue is narrow. Its
//! zero is found by regula falsi with σ as the variable, so that edges any number of decades apart are no
//! different. The entries at a point come from [`super::meet`], in two doubles: three to ten evaluations a
//! peak, each O(p + q), and no other edge is needed.
//!
//! **Thin tongues.** Where the relative width δ is below 2^-52 the middle is the place and the parabola's
//! height there the value ([`super::meet`]), n nodes making it wrong by some n δ relative.
//!
//! **Nothing is guessed.** Each value comes with a bound of what rounding can have done to it, and where that
//! shows in a double, as where the two edges all but meet (near a closing), big numbers take over.

use super::meet::{Meeting, Point};
use crate::propagator::TwoClocks;
use crate::tongue::edge::{Edge, Enclosure, Tongues, negative_log2};
use crate::tongue::gap::Gap;
use crate::tongue::string::HalfString;
use crate::verdict::{Limits, Side, Verdict, growth};
use number::{Error, Laurent, Rational, Result, Twofold, rational};

/// The fastest growth in a tongue; rounded: s to nine digits, the rate to fifteen; the rest is that of a
/// place which is s before rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Where.
    pub s: f64,
    /// Growth of ln amplitude per period.
    pub ln_multiplier: f64,
    /// The growth per unit time, in units of √L1.
    pub rate: f64,
    /// Slow steps h2 until the amplitude is ten times as large.
    pub slow_steps_to_tenfold: f64,
}

/// Relative widths up to this are thin: doubles cannot separate the edges.
const THIN: f64 = f64::EPSILON;

/// Relative widths up to this are too narrow for edges in doubles: they are wrong by 1e-10 of the width.
const NARROW: f64 = 1e-6;

/// Below this relative width the middle is the place, to within the square of it.
const POINT: f64 = 1e-10;

/// The last step, relative to s and to the tongue's width alike: the rate is flat to the square of it.
const STEP: f64 = 1e-10;

/// Steps at most; regula falsi needs three to ten.
const STEPS: u32 = 100;

impl Tongues {
    /// The fastest growth inside a tongue; `None` of a closed one and of the infinite one.
    ///
    /// # Errors
    /// Where the schedule is too long, or more digits are needed than are tried.
    pub fn peak(&self, gap: &Gap) -> Result<Option<Peak>> {
        Ok(self.peaks(std::slice::from_ref(gap))?.remove(0))
    }

    /// As [`Tongues::peak`], of many tongues.
    pub(crate) fn peaks(&self, gaps: &[Gap]) -> Result<Vec<Option<Peak>>> {
        // For a long period one point in more bits costs less than the string.
        let by_bits = |gap: &Gap| self.is_long() && gap.width.1 <= POINT * gap.lower.lo;
        let open = gaps.iter().filter_map(|gap| gap.upper.filter(|_| !gap.closed).map(|upper| (gap, upper)));
        let in_doubles: Vec<_> = open.filter(|(gap, _)| !by_bits(gap)).collect();
        let mut found = match in_doubles.is_empty() {
            true => Vec::new(),
            false => Search::all(self.string()?, &in_doubles),
        }
        .into_iter();
        let peak = |gap: &Gap| {
            let Some(upper) = gap.upper.filter(|_| !gap.closed) else { return Ok(None) };
            let in_doubles = if by_bits(gap) { None } else { found.next().flatten() };
            let (s, ln_multiplier) = in_doubles.map_or_else(|| fastest_by_bits(self, gap, &upper), Ok)?;
            Ok(Some(Peak {
                s,
                ln_multiplier,
                rate: ln_multiplier / (self.ratio().p() as f64 * s.sqrt()),
                slow_steps_to_tenfold: std::f64::consts::LN_10 * self.ratio().q() as f64 / ln_multiplier,
            }))
        };
        gaps.iter().map(peak).collect()
    }
}

impl Peak {
    /// The growth rate per unit time for a fast stiffness L1, rounded: `rate` is in units of √L1.
    pub fn growth_rate(&self, lambda1: &Laurent) -> f64 {
        self.rate * lambda1.to_f64().sqrt()
    }
}

/// s and ln μ by golden section and certified enclosures: slow, and always right.
fn fastest_by_bits(tongues: &Tongues, gap: &Gap, upper: &Edge) -> Result<(f64, f64)> {
    let [a, b] = parted(tongues, &gap.lower, upper, gap.width.0)?;
    let width = &b - &a;
    let ratio = rational::to_f64(&(&width / &a));
    let at = |u: f64| {
        let part = if ratio > THIN { (u * ratio.ln_1p()).exp_m1() / ratio } else { u };
        &a + &width * rational::from_f64_exact(part).expect("finite")
    };
    let ln = |s: &Rational| ln_multiplier_by_bits(tongues, s, gap.m);
    let rate = |u: f64| Ok(ln(&at(u))? / rational::to_f64(&at(u)).sqrt());
    let u = if ratio > POINT { golden(rate)? } else { 0.5 };
    Ok((rational::to_f64(&at(u)), ln(&at(u))?))
}

/// Points at the edges, to within 1e-8 of their distance.
fn parted(tongues: &Tongues, lower: &Edge, upper: &Edge, width: f64) -> Result<[Rational; 2]> {
    let [mut a, mut b] = [lower, upper].map(Enclosure::from);
    // Those of the tongue's relative width (a binary digit is 0.3 decimal ones), and ten more.
    let mut digits =
        3 * negative_log2(&rational::from_f64_exact(width / lower.lo).expect("finite")) / 10 + 10;
    while (a.width() + b.width()) * Rational::from_integer(100_000_000.into()) > &b.lo - &a.hi {
        (a, b) = (tongues.sharpened(lower, &a, digits)?, tongues.sharpened(upper, &b, digits)?);
        digits *= 2;
    }
    Ok([a.middle(), b.middle()])
}

fn ln_multiplier_by_bits(tongues: &Tongues, s: &Rational, m: u64) -> Result<f64> {
    let verdict = Verdict::Hyperbolic(Side::of_half_turns(m));
    let clocks = TwoClocks::with_rho(tongues.ratio(), s.clone(), tongues.rho().clone());
    let ln = growth(&clocks, verdict, &Limits::default())?.ln_multiplier.map(|ln| ln.mid_f64());
    ln.filter(|&ln| ln > 0.0).ok_or_else(|| {
        let cost = format!("the growth of tongue {m} at s = {}", rational::to_f64(s));
        Error::too_much(format!("{cost} needs more digits than are tried"), "choose a simpler ratio")
    })
}

/// A tongue in doubles, and how far the search in it has come.
struct Search {
    odd: bool,
    /// a, and b − a.
    lower: Twofold,
    width: f64,
    /// Shares of ln(b/a) below and above the peak, with the two sides' difference there.
    below: (f64, f64),
    above: (f64, f64),
    /// The difference at the share looked at last.
    before: f64,
    /// The share to look at next.
    next: f64,
    step: f64,
    steps: u32,
    /// s and ln μ where the rate is largest; `None` where rounding shows.
    found: Option<Option<(f64, f64)>>,
}

impl Search {
    /// s and ln μ where the rate is largest, in each tongue; `None` where rounding shows.
    fn all(string: &HalfString, tongues: &[(&Gap, Edge)]) -> Vec<Option<(f64, f64)>> {
        let mut all: Vec<Search> = tongues.iter().map(|(gap, _)| Search::new(gap)).collect();
        Search::sharpen(string, tongues, &mut all);
        loop {
            let mut left: Vec<&mut Search> = all.iter_mut().filter(|search| search.found.is_none()).collect();
            if left.is_empty() {
                break;
            }
            let points: Vec<Point> = left.iter().map(|search| search.point()).collect();
            for (search, meeting) in left.iter_mut().zip(Meeting::all(string, &points)) {
                search.take(&meeting);
            }
        }
        all.into_iter().map(|search| search.found.flatten()).collect()
    }

    fn new(gap: &Gap) -> Self {
        let lower = Twofold { hi: gap.lower.middle(), lo: 0.0 };
        let width = 0.5 * (gap.width.0 + gap.width.1);
        let step = STEP / (width / lower.hi).ln_1p().max(1.0);
        let (below, above) = ((0.0, 1.0), (1.0, -1.0));
        let odd = gap.m % 2 == 1;
        Search { odd, lower, width, below, above, before: 0.0, next: 0.5, step, steps: 0, found: None }
    }

    /// Edges of narrow tongues to two doubles, by a step of Newton's.
    fn sharpen(string: &HalfString, tongues: &[(&Gap, Edge)], all: &mut [Search]) {
        let narrow = |search: &Search| !search.is_thin() && search.width < NARROW * search.lower.hi;
        let mut narrow: Vec<_> = all.iter_mut().zip(tongues).filter(|(search, _)| narrow(search)).collect();
        let at = |edge: &Edge| Twofold { hi: edge.middle(), lo: 0.0 };
        let edges = narrow.iter().flat_map(|(search, (gap, upper))| {
            [&gap.lower, upper].map(|edge| Point { s: at(edge), odd: search.odd })
        });
        let meetings = Meeting::all(string, &edges.collect::<Vec<_>>());
        for ((search, (gap, upper)), meetings) in narrow.iter_mut().zip(meetings.chunks_exact(2)) {
            let sharper = |edge: &Edge, meeting: &Meeting| {
                let to = meeting.pair[usize::from(!edge.entry.starts_free())].to_zero();
                at(edge).plus(at(edge).scaled(to))
            };
            search.lower = sharper(&gap.lower, &meetings[0]);
            search.width = sharper(upper, &meetings[1]).minus(search.lower).hi;
        }
    }

    fn is_thin(&self) -> bool {
        self.width <= THIN * self.lower.hi
    }

    /// How far above a the next place is: ln(s/a) is that share of ln(b/a).
    fn from(&self) -> f64 {
        let a = self.lower.hi;
        a * (self.next * (self.width / a).ln_1p()).exp_m1()
    }

    /// Where to look next.
    fn point(&self) -> Point {
        let s = match self.is_thin() {
            true => self.lower,
            false => self.lower.plus(Twofold { hi: self.from(), lo: 0.0 }),
        };
        Point { s, odd: self.odd }
    }

    /// Goes on with what is there.
    fn take(&mut self, meeting: &Meeting) {
        if self.is_thin() {
            let found = meeting.in_the_middle();
            self.found = Some(found.map(|(ln, to)| (self.lower.hi + self.lower.hi * to, ln)));
            return;
        }
        let Some((s, ln, balance)) = self.balance(meeting) else {
            self.found = Some(None);
            return;
        };
        let u = self.next;
        // Illinois: an end that stays twice counts half.
        let half = if balance * self.before > 0.0 { 0.5 } else { 1.0 };
        if balance > 0.0 {
            (self.below, self.above.1) = ((u, balance), half * self.above.1);
        } else {
            (self.above, self.below.1) = ((u, balance), half * self.below.1);
        }
        self.before = balance;
        self.steps += 1;
        self.next =
            (self.below.0 * self.above.1 - self.above.0 * self.below.1) / (self.above.1 - self.below.1);
        if (self.next - u).abs() <= self.step {
            self.found = Some(Some((s, ln)));
        } else if self.steps == STEPS {
            self.found = Some(None);
        }
    }

    /// s, ln μ and the two sides' difference.
    fn balance(&self, meeting: &Meeting) -> Option<(f64, f64, f64)> {
        let (width, from, s) = (self.width, self.from(), self.point().s);
        let ln = meeting.ln_multiplier()?;
        let w = 0.5 * ln;
        let balance = from * (width - from) / (s.hi * width) * (meeting.rise() - w / w.tanh());
        balance.is_finite().then_some((s.hi, ln, balance))
    }
}

/// Where f, with one maximum in [0, 1], has it: 44 sections that keep 0.618 each leave 6e-10, where f is flat
/// to 1e-18.
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
    use number::{Ratio, ratio};

    #[test]
    fn doubles_and_big_numbers_agree() {
        let power = |n: i32| Rational::from_integer(10.into()).pow(n);
        let (mut seen, mut left) = (0, 0);
        for decade in [-12, -6, -3, -1, 0, 2, 6, 12] {
            for (p, q) in [(2, 1), (1, 2), (7, 3), (5, 6), (4, 9), (19, 16)] {
                let rho = ratio(7, 5) * power(decade);
                let tongues = Tongues::new(Ratio::new(p, q).unwrap(), &rho).unwrap();
                for gap in tongues.all().unwrap() {
                    let Some(upper) = gap.upper.filter(|_| !gap.closed) else { continue };
                    seen += 1;
                    let alone = Search::all(tongues.string().unwrap(), &[(&gap, upper)]);
                    let Some((s, ln)) = alone[0] else {
                        left += 1;
                        continue;
                    };
                    let (t, exact) = fastest_by_bits(&tongues, &gap, &upper).unwrap();
                    let rate = |s: f64, ln: f64| ln / s.sqrt();
                    // Golden section sees a maximum to the root of a rounding.
                    assert!((s - t).abs() < 1e-7 * t, "{p}/{q}, 10^{decade}: {s}, {t}, {gap:?}");
                    let error = rate(s, ln) / rate(t, exact) - 1.0;
                    assert!(error.abs() < 1e-15, "{p}/{q}, 10^{decade}: {error}, {gap:?}");
                }
            }
        }
        // A bound on how often doubles give up: slow or fast forces of 1e-12 leave 1e-14 of an edge between
        // the two.
        assert!(seen > 500 && left < seen / 5, "{left} of {seen}");
    }

    /// The widths relative to s are 1e-11 to 1e-12: edges by return maps are sharp enough, as 40 digits by
    /// kicks show.
    #[test]
    fn thin_tongues_of_a_long_period_grow_as_their_kicks_say() {
        let tongues = Tongues::new(Ratio::new(30001, 30000).unwrap(), &ratio(121, 10_000)).unwrap();
        for gap in tongues.gaps(1, 2).unwrap() {
            let upper = gap.upper.unwrap();
            assert!(tongues.is_long() && gap.width.1 < POINT * gap.lower.lo);
            let [a, b] = [&gap.lower, &upper].map(|edge| tongues.refine(edge, 40).unwrap().middle());
            let exact = ln_multiplier_by_bits(&tongues, &((a + b) / Rational::from_integer(2.into())), gap.m);
            let (_, ln) = fastest_by_bits(&tongues, &gap, &upper).unwrap();
            // The rate is flat in the middle, to the square of the 1e-8 of a width that the place may be off.
            assert!((ln / exact.unwrap() - 1.0).abs() < 1e-14, "{ln} {gap:?}");
        }
    }
}
