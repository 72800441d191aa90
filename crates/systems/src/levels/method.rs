//! How two levels are integrated: three functions of the fast frequency.
//!
//! With x = H w over the outer step H and y = x/2, a method of fast angle Θ, impedance Z and filter φ has the
//! half period a = d = cos(Θ/2), b = sin(Θ/2)/Z, c = −Z sin(Θ/2) in every mode of F, and kicks by φ(F) S
//! φ(F). Only a d, b d, b c and the ratios a/b, c/d enter, so (a, b) may be multiplied by any number and (c,
//! d) divided by it. In the time unit H:
//!
//! | method | a, b, c, d | φ |
//! |---|---|---|
//! | kicks and drifts | file `half` | 1 |
//! | exact flow: impulse, MOLLY | cos y, sinc(y)/2, −x sin y, cos y | 1; sinc y, sinc² y, sinc x |
//! | midpoint rule: implicit-explicit | 1, 1/2, −(x²/2)/(1 + y²), 1/(1 + y²) | 1 |
//! | x₊ − 2 cos(x) x + x₋ = −H² ψ S φ x | cos² y, 1/2, −2 sin² y, 1 | γ, γ² = ψ φ: sinc y (Gautschi), sinc x (Hairer, Lubich) |
//!
//! The last is similar to −H² γ S γ where ψ φ is a square, whose trace is 2 + 4 b (c − d M) as that of any
//! method is. Source: proofs/REGION.md, section 8. `proofs/REGION.md`, section 8, has these as functions of
//! matrices, and bounds on how they move with F.

use super::half::Half;
use number::{Ball, Error, Interval, Result, from_f64_exact};
use words::Trigonometric;

/// The integrator of two levels, slow kicks outside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Kicks and drifts of the inner step: r-RESPA, Verlet within.
    #[default]
    Respa,
    /// The fast force by the midpoint rule over the whole outer step.
    ImplicitExplicit,
    /// The fast force exactly, the slow one filtered.
    Trigonometric(Trigonometric),
}

impl Method {
    /// Every one.
    pub fn all() -> impl Iterator<Item = Method> {
        let first = [Method::Respa, Method::ImplicitExplicit];
        first.into_iter().chain(Trigonometric::ALL.map(Method::Trigonometric))
    }

    pub fn name(self) -> &'static str {
        match self {
            Method::Respa => "respa",
            Method::ImplicitExplicit => "implicit-explicit",
            Method::Trigonometric(trigonometric) => trigonometric.name(),
        }
    }

    /// Whether inner steps mean anything: all others take the fast force in one go.
    pub fn has_inner_steps(self) -> bool {
        self == Method::Respa
    }

    /// Whether a, b and c are those of a two-step method, no monotone functions of F.
    fn is_two_step(self) -> bool {
        matches!(self, Method::Trigonometric(trigonometric) if trigonometric.is_two_step())
    }

    /// The half period of p inner steps at s = h² w², h the inner step; in the time unit h.
    pub(super) fn half(self, s: Interval, p: u64) -> Half {
        if self.has_inner_steps() {
            return Half::new(s.middle(), p);
        }
        let (p, one) = (Interval::point(p as f64), Interval::point(1.0));
        let square = p * p * s;
        let turned = |[a, b, c, d]: [Interval; 4], changes| Half { a, b: b * p, c: c / p, d, changes };
        let half = one.half();
        if self == Method::ImplicitExplicit {
            let d = one / (one + square.half().half());
            return turned([one, half, -square.half() * d, d], (d.sign() == Some(true)).then_some(0));
        }
        let [cos, sinc] = turn(square);
        match self.is_two_step() {
            false => turned([cos, sinc * half, -square * (sinc * half), cos], turns(square)),
            true => turned([cos * cos, half, -square.half() * sinc * sinc, one], Some(0)),
        }
    }

    /// The filter at s.
    pub(super) fn filter(self, s: Interval, p: u64) -> Interval {
        let Some((i, k)) = self.powers() else { return Interval::point(1.0) };
        let p = Interval::point(p as f64);
        let [cos, sinc] = turn(p * p * s);
        let power = |x: Interval, n| (0..n).fold(Interval::point(1.0), |product, _| product * x);
        power(cos, i) * power(sinc, k)
    }

    /// (i, k) of the filter cos^i y sinc^k y; `None` where it is 1.
    fn powers(self) -> Option<(u32, u32)> {
        let Method::Trigonometric(trigonometric) = self else { return None };
        Some(trigonometric.filter()).filter(|pair| *pair != (0, 0))
    }

    pub(super) fn has_filter(self) -> bool {
        self.powers().is_some()
    }

    /// A little more than the H w of the fastest mode at which the first region ends at the latest; `None`
    /// where the slow force alone ends it.
    pub(super) fn highest_angle(self, p: u64) -> Option<f64> {
        let pi = std::f64::consts::PI;
        match self {
            Method::Respa => Some(1.000_001 * p as f64 * 2.0 * (pi / (2.0 * p as f64)).sin()),
            Method::ImplicitExplicit => None,
            Method::Trigonometric(_) => Some(1.000_001 * pi),
        }
    }

    /// The H w of the fastest mode up to which a stable step proves all smaller ones stable
    /// (`proofs/REGION.md`, section 8): there Z cot(Θ/2)/(H φ²) decreases in H in every mode, of the exact
    /// flow filtered by sinc x up to 1.7 only.
    pub(super) fn first_region_ends(self) -> f64 {
        match self {
            Method::Trigonometric(Trigonometric::Long) => 1.7,
            Method::Trigonometric(Trigonometric::Impulse) | Method::Respa | Method::ImplicitExplicit => {
                f64::INFINITY
            }
            Method::Trigonometric(_) => 0.999_999 * std::f64::consts::PI,
        }
    }

    /// How far, at most, a, b, c, d and the filter move for each unit that the matrix s does, no s being
    /// below −`below`, of other methods than r-RESPA.
    ///
    /// cos(t √s) solves y'' = −s y, so it moves by t²/2; its mean over t, sinc, by t²/6; its slope −√s sin(t
    /// √s) by t.
    pub(super) fn slopes(self, p: u64, below: f64) -> [f64; 5] {
        let (p, square) = (p as f64, (p as f64).powi(2));
        let room = room(below * square);
        let (i, k) = self.powers().unwrap_or_default();
        let filter = f64::from(i) / 8.0 + f64::from(k) / 24.0;
        let [a, b, c, d] = match (self, self.is_two_step()) {
            (Method::ImplicitExplicit, _) => [0.0, 0.0, 0.5, 0.25],
            (_, false) => [0.125, 1.0 / 48.0, 0.5, 0.125],
            (_, true) => [0.25, 0.0, 0.5, 0.0],
        };
        // Bounds in s/p², in the time unit of the inner step.
        [a, b * p, c / p, d, filter].map(|x| 1.01 * room * square * x)
    }

    /// By how much φ² and b d may exceed 1 and p/2, no s being below −`below`.
    pub(super) fn room(self, p: u64, below: f64) -> f64 {
        room(below * (p as f64).powi(2))
    }

    /// The slopes of b c and b d.
    pub(super) fn slopes_of_products(self, p: u64, below: f64) -> [f64; 2] {
        let (size, square) = (p as f64, (p as f64).powi(2));
        let room = room(below * square);
        // b c = (cos x − 1)/2 or −y²/(1 + y²)/2; b d = sinc(x)/2 or 1/(1 + y²)/2.
        let other = match (self, self.is_two_step()) {
            (Method::ImplicitExplicit, _) => 0.125,
            (_, false) => 1.0 / 12.0,
            (_, true) => 0.0,
        };
        [0.25, size * other].map(|x| 1.01 * room * square * x)
    }

    /// The half periods that bound those of all s within `off` of one, in Loewner's order as functions of
    /// matrices: with less fast stiffness, with more.
    pub(super) fn around(self, (less, more): (f64, f64), p: u64) -> [Half; 2] {
        if !self.is_two_step() {
            return [less, more].map(|s| self.half(Interval::point(s), p));
        }
        let all = Interval { lo: less, hi: more };
        let half = self.half(Interval::point(all.middle()), p);
        let slopes = self.slopes(p, (-less).max(0.0));
        let wider = |x: Interval, slope: f64| {
            let off = 1.01 * slope * all.error();
            Interval { lo: (x.lo - off).next_down(), hi: (x.hi + off).next_up() }
        };
        [Half { a: wider(half.a, slopes[0]), c: wider(half.c, slopes[2]), ..half }; 2]
    }
}

impl std::str::FromStr for Method {
    type Err = Error;

    fn from_str(text: &str) -> Result<Method> {
        let found = Method::all().find(|method| method.name() == text);
        found.ok_or_else(|| Error::unknown("method", text, Method::all().map(Method::name)))
    }
}

impl std::fmt::Display for Method {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// By how much slopes at s ≥ −`below` may exceed those at s ≥ 0: all grow by no more than cosh² √below, and
/// 1/(1 + s/4)² by less.
fn room(below: f64) -> f64 {
    if below <= 1.0 { 1.01 * (2.0 * below.sqrt()).exp() } else { f64::INFINITY }
}

/// Bits of balls that become doubles.
const BITS: u32 = 80;

/// Below this |x²| the series are summed.
const SMALL: f64 = 1.0;

/// cos y and sinc y for y² = s/4; everything where s is far below 0.
fn turn(s: Interval) -> [Interval; 2] {
    let nothing = Interval { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
    if !(s.lo.is_finite() && s.hi.is_finite() && s.lo > -64.0 * SMALL) {
        return [nothing; 2];
    }
    if s.lo <= SMALL {
        // Wide intervals are no concern: those of one s are a few roundings wide.
        return if s.hi <= 2.0 * SMALL { [series(s, 0.0), series(s, 1.0)] } else { [nothing; 2] };
    }
    let ball = |x: f64| Ball::from_rational(&from_f64_exact(x).expect("finite"), BITS);
    let square = ball(s.lo).union(&ball(s.hi), BITS).scale2(-2);
    let Some(y) = square.sqrt(BITS) else { return [nothing; 2] };
    let sinc = y.sin(BITS).div(&y, BITS);
    [Interval::of(&y.cos(BITS)), sinc.map_or(nothing, |sinc| Interval::of(&sinc))]
}

/// Σ (−s/4)^n/(2n + first)!, the rest of which is less than its last term: terms fall by more than two from
/// the tenth on.
fn series(s: Interval, first: f64) -> Interval {
    let (square, one) = (-s.half().half(), Interval::point(1.0));
    let (mut term, mut sum) = (one, one);
    for n in 1..=30 {
        let n = 2.0 * f64::from(n) + first;
        term = term * square / Interval::point(n * (n - 1.0));
        sum = sum + term;
    }
    let rest = term.lo.abs().max(term.hi.abs());
    sum + Interval { lo: -rest, hi: rest }
}

/// How many half turns y makes; `None` where that is not certain.
fn turns(s: Interval) -> Option<usize> {
    let root = |x: f64| x.max(0.0).sqrt() / std::f64::consts::TAU;
    // A root, a quotient, π itself.
    let [lo, hi] = [root(s.lo) * (1.0 - 1e-15), root(s.hi) * (1.0 + 1e-15)].map(f64::floor);
    (lo == hi && hi < 1e9).then_some(lo as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_periods_and_filters_are_those_of_the_functions() {
        let sinc = |x: f64| if x == 0.0 { 1.0 } else { x.sin() / x };
        for method in Method::all().filter(|method| !method.has_inner_steps()) {
            for x in [0.0, 1e-5, 0.3, 0.99, 1.01, 3.0, 6.2, 6.4, 25.0] {
                for p in [1u64, 4] {
                    let (s, y) = ((x / p as f64).powi(2), x / 2.0);
                    let half = method.half(Interval::point(s), p);
                    let [ad, bd, bc] = match method {
                        Method::ImplicitExplicit => [1.0, 0.5, -x * x / 4.0].map(|z| z / (1.0 + y * y)),
                        _ if method.is_two_step() => [y.cos().powi(2), 0.5, -y.sin().powi(2)],
                        _ => [y.cos().powi(2), sinc(x) / 2.0, -y.sin().powi(2)],
                    };
                    let products = [half.a * half.d, half.b * half.d, half.b * half.c];
                    for (got, want) in products.into_iter().zip([ad, bd * p as f64, bc]) {
                        // Some roundings of y, whose size is up to 13.
                        assert!(
                            got.lo - 1e-14 <= want && want <= got.hi + 1e-14,
                            "{method} {x}: {got:?} {want}"
                        );
                        assert!(got.error() < 1e-13 * p as f64, "{method} {x}: {got:?}");
                    }
                    let want = match method.name() {
                        "molly-short" | "gautschi" => sinc(y),
                        "molly-linear" => sinc(y).powi(2),
                        "molly-long" | "hairer-lubich" => sinc(x),
                        _ => 1.0,
                    };
                    let got = method.filter(Interval::point(s), p);
                    assert!(got.lo - 1e-14 <= want && want <= got.hi + 1e-14, "{method} {x}: {got:?} {want}");
                }
            }
            assert_eq!(method.name().parse::<Method>().unwrap(), method);
        }
        // Past 2 π the odd solution has changed its sign once.
        let impulse: Method = "impulse".parse().unwrap();
        assert_eq!([6.2, 6.4].map(|x| impulse.half(Interval::point(x * x), 1).changes), [Some(0), Some(1)]);
        assert!("verlet".parse::<Method>().is_err());
    }

    #[test]
    fn negative_stiffness_gives_hyperbolic_functions() {
        let [cos, sinc] = turn(Interval::point(-4.0 * 0.25));
        assert!(cos.lo <= 0.5f64.cosh() + 1e-15 && cos.hi >= 0.5f64.cosh() - 1e-15 && cos.error() < 1e-14);
        let want = 0.5f64.sinh() / 0.5;
        assert!(sinc.lo <= want + 1e-15 && sinc.hi >= want - 1e-15 && sinc.error() < 1e-14);
        assert!(turn(Interval::point(-100.0))[0].hi.is_infinite());
    }

    /// Slopes against those of scalars: no matrix moves by more, and scalars are matrices.
    #[test]
    fn slopes_are_no_less_than_those_of_scalars() {
        for method in Method::all().filter(|method| !method.has_inner_steps()) {
            for s in [0.01, 1.5, 9.0, 40.0, 200.0] {
                let step = 1e-4;
                let at = |s: f64| {
                    let (half, phi) =
                        (method.half(Interval::point(s), 1), method.filter(Interval::point(s), 1));
                    [half.a, half.b, half.c, half.d, phi, half.b * half.c, half.b * half.d]
                        .map(Interval::middle)
                };
                let products = method.slopes_of_products(1, 0.0);
                let slopes = [method.slopes(1, 0.0).as_slice(), products.as_slice()].concat();
                let (before, after) = (at(s - step), at(s + step));
                for k in 0..7 {
                    let slope = (after[k] - before[k]).abs() / (2.0 * step);
                    assert!(slope <= slopes[k] + 1e-9, "{method} {s} {k}: {slope} {}", slopes[k]);
                }
            }
        }
    }
}
