//! Words with exact flows, filters or friction, in balls.
//!
//! Of the step's matrix over its denominator q, with T its trace and E its determinant, the powers are
//! bounded if |T| < q (1 + E) and E ≤ 1 (Jury's conditions for two eigenvalues inside the unit circle; for
//! E = 1 they are on it and differ), and unbounded if |T| > q (1 + E). Over an interval of steps q (1 + E) ∓
//! T is enclosed by its value in the middle and the balls of its derivative over the whole, so that the width
//! of cells falls with the distance from an edge, and not with its square where the trace only touches ±2.

use std::cell::Cell;

use num_traits::One;

use super::filter::Filter;
use super::letters::{Force, Word};
use super::point::At;
use super::product::{Product, Setting};
use number::jet;
use number::{Ball, Laurent, Radical, Rational, Real, Ring, Sign};

/// Bits of the balls.
const BITS: u32 = 128;

/// Halvings of the range of steps: an edge is enclosed to 2^−44 of the range.
pub(super) const HALVINGS: u32 = 44;

/// The most cells of one range.
const MOST_CELLS: usize = 200_000;

type Jet = jet::Jet<BITS>;

/// An oscillator that a word integrates, its stiffnesses positive where the word has their exact flow.
#[derive(Clone, Debug)]
pub struct Enclosed<'a> {
    word: &'a Word,
    stiffness: [Ball; 2],
    friction: Ball,
}

/// Steps with one answer, each end enclosed. Between two neighbours of the same answer lies a place of which
/// nothing is proven.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    pub stable: bool,
    pub lower: (f64, f64),
    pub upper: (f64, f64),
}

/// The letters at one step or over an interval of steps h.
struct Steps {
    h: Jet,
    stiffness: [Ball; 2],
    friction: Ball,
    /// Cleared where a filter has a pole.
    defined: Cell<bool>,
}

impl Steps {
    fn constant(&self, x: Ball) -> Jet {
        Jet::constant(x)
    }

    /// Λ of a force.
    fn stiffness(&self, force: Force) -> Ball {
        let [fast, slow] = &self.stiffness;
        match force {
            Force::All => fast.add(slow, BITS),
            Force::First => fast.clone(),
            Force::Second => slow.clone(),
        }
    }

    /// √Λ of a force; 0 for what is not positive.
    fn frequency(&self, force: Force) -> Ball {
        self.stiffness(force).sqrt_clipped(BITS).unwrap_or_else(|| {
            self.defined.set(false);
            Ball::zero()
        })
    }

    fn over(&self, x: &Ball, by: &Ball) -> Ball {
        x.div(by, BITS).unwrap_or_else(|| {
            self.defined.set(false);
            Ball::zero()
        })
    }

    /// cos x.
    fn cos(x: &Jet) -> Jet {
        x.chained(x.value.cos(BITS), &x.value.sin(BITS).neg())
    }

    /// sin x / x, and about 0 the bounds 1 − x²/6 ≤ sinc x ≤ 1, −x/3 ≤ sinc' x ≤ 0 for x ≥ 0.
    fn sinc(&self, x: &Jet) -> Jet {
        let ball = &x.value;
        if ball.is_away_from_zero() {
            let sinc = self.over(&ball.sin(BITS), ball);
            let slope = self.over(&ball.cos(BITS).sub(&sinc, BITS), ball);
            return x.chained(sinc, &slope);
        }
        let sixth = Ball::from_rational(&Rational::new(1.into(), 6.into()), BITS);
        let least = Ball::one().sub(&ball.square(BITS).mul(&sixth, BITS), BITS);
        let slope = ball.mul(&sixth, BITS).scale2(1).neg();
        x.chained(least.union(&Ball::one(), BITS), &slope.union(&Ball::zero(), BITS))
    }
}

impl Setting<Jet> for Steps {
    fn force(&self, force: Force) -> Jet {
        Jet::product(&Jet::product(&self.h, &self.h), &self.constant(self.stiffness(force)))
    }

    fn embed(&self, c: &Radical) -> Jet {
        self.constant(c.enclosure(BITS))
    }

    fn flow(&self, force: Force, c: &Radical) -> [Jet; 2] {
        let c = c.enclosure(BITS);
        // Both are even in c.
        let x = Jet::product(&self.h, &self.constant(self.frequency(force).mul(&c.abs(), BITS)));
        [Steps::cos(&x), Jet::product(&self.sinc(&x), &self.constant(c))]
    }

    fn filter(&self, filter: Filter) -> Jet {
        if filter.zero {
            return self.constant(Ball::zero());
        }
        let half = Jet::product(&self.h, &self.constant(self.frequency(Force::First).scale2(-1)));
        let power = |x: Jet, n: i32| {
            let jet = (0..n.unsigned_abs()).fold(Jet::one(), |product, _| Jet::product(&product, &x));
            if n >= 0 {
                return jet;
            }
            let inverse = self.over(&Ball::one(), &jet.value);
            let slope = inverse.square(BITS).neg();
            jet.chained(inverse, &slope)
        };
        Jet::product(&power(Steps::cos(&half), filter.cos), &power(self.sinc(&half), filter.sinc))
    }

    fn damping(&self, c: &Radical) -> Jet {
        let rate = self.friction.mul(&c.enclosure(BITS), BITS).neg();
        let x = Jet::product(&self.h, &self.constant(rate));
        let value = x.value.exp(BITS);
        x.chained(value.clone(), &value)
    }
}

impl<'a> Enclosed<'a> {
    /// A word, its stiffnesses, its friction γ ≥ 0.
    pub fn new(word: &'a Word, fast: &Laurent, slow: &Laurent, friction: &Laurent) -> Enclosed<'a> {
        let ball = |x: &Laurent| x.enclosure(BITS);
        Enclosed { word, stiffness: [ball(fast), ball(slow)], friction: ball(friction) }
    }

    /// At h² Λ1 = s and h² Λ2 = ρ s, h being 1; no friction.
    pub(super) fn scaled(word: &'a Word, s: &Laurent, rho: &Rational) -> Enclosed<'a> {
        let fast = s.enclosure(BITS);
        let slow = fast.mul(&Ball::from_rational(rho, BITS), BITS);
        Enclosed { word, stiffness: [fast, slow], friction: Ball::zero() }
    }

    /// The product over all steps of a ball; `None` where a filter has a pole.
    fn product(&self, h: Ball) -> Option<Product<Jet>> {
        let steps = Steps {
            h: Jet::variable(h),
            stiffness: self.stiffness.clone(),
            friction: self.friction.clone(),
            defined: Cell::new(true),
        };
        let product = self.word.product(&steps);
        steps.defined.get().then_some(product)
    }

    /// q (1 + E) − T and q (1 + E) + T.
    fn margins(product: &Product<Jet>) -> [Jet; 2] {
        let (trace, q) = (product.trace(), &product.denominator);
        let sum = Jet::product(q, &(Jet::one() + product.damping.clone()));
        [&sum - &trace, &sum + &trace]
    }

    /// Whether all steps of [lo, hi] are stable or all unstable; `None` where that is undecided.
    fn verdict(&self, lo: f64, hi: f64) -> Option<bool> {
        let exact = |x: f64| {
            let x = number::rational::from_f64_exact(x).unwrap_or_default();
            Ball::from_rational(&x, BITS)
        };
        let (lower, upper) = (exact(lo), exact(hi));
        let (middle, cell) = (exact(lo + (hi - lo) / 2.0), lower.union(&upper, BITS));
        let (here, over) = (self.product(middle.clone())?, self.product(cell.clone())?);
        let off = cell.sub(&middle, BITS);
        let pairs = Self::margins(&here).into_iter().zip(Self::margins(&over));
        // The value in the middle and the mean value theorem.
        let signs: Vec<Option<Sign>> = pairs
            .map(|(here, over)| {
                here.value.add(&over.slope.mul(&off, BITS), BITS).sign().or(over.value.sign())
            })
            .collect();
        stable(&over, [signs[0], signs[1]])
    }

    /// The answer at one step h > 0. `kind` is `edge` where balls of 128 bits cannot decide, and `damped`
    /// where friction draws all to 0.
    pub fn at(&self, h: &Laurent) -> Option<At> {
        let product = self.product(h.enclosure(BITS))?;
        let q = &product.denominator.value;
        let trace = product.trace().value.div(q, BITS)?;
        let determinant = product.damping.value.clone();
        let [above, below] = Self::margins(&product).map(|margin| margin.value.sign());
        let damped = determinant.compare(&Ball::one()) == Some(std::cmp::Ordering::Less);
        let stable = stable(&product, [above, below]);
        let mut found = At {
            kind: match stable {
                None => "edge",
                Some(false) => "hyperbolic",
                Some(true) if damped => "damped",
                Some(true) => "elliptic",
            },
            side: i8::from(above == Some(Sign::Negative)) - i8::from(below == Some(Sign::Negative)),
            ln_multiplier: None,
            angle: None,
            impedance: None,
            trace,
        };
        // The eigenvalues T/2 ± √(T²/4 − E).
        let half = found.trace.scale2(-1);
        let excess = half.square(BITS).sub(&determinant, BITS);
        match excess.sign() {
            Some(Sign::Positive) if stable.is_some() => {
                let largest = half.abs().add(&excess.sqrt(BITS)?, BITS);
                found.ln_multiplier = largest.ln(BITS);
            }
            Some(Sign::Negative) => {
                let size = determinant.sqrt(BITS)?;
                found.angle = half.div(&size, BITS).and_then(|cos| cos.acos(BITS));
                found.ln_multiplier = if damped { size.ln(BITS) } else { None };
            }
            _ => (),
        }
        Some(found)
    }

    /// Every step of (lo, hi): pieces with one answer. `None` where there are more pieces than can be
    /// separated.
    pub fn pieces(&self, lo: f64, hi: f64) -> Option<Vec<Piece>> {
        let mut left = MOST_CELLS;
        let verdict = |lo: f64, hi: f64| {
            left = left.saturating_sub(1);
            // Cells beyond the limit are left undecided, and refused below.
            if left == 0 { Some(true) } else { self.verdict(lo, hi) }
        };
        let all = pieces(lo, hi, verdict);
        (left > 0).then_some(all)
    }
}

/// Whether a step is stable: both margins are positive. `None` where neither this nor a negative margin is
/// proven.
fn stable(product: &Product<Jet>, margins: [Option<Sign>; 2]) -> Option<bool> {
    // Letters O that sum to less than 0 feed energy in.
    match product.damping.value.compare(&Ball::one()) {
        Some(std::cmp::Ordering::Greater) => return Some(false),
        None => return None,
        Some(_) => (),
    }
    // A negative denominator turns both.
    let margins = match product.denominator.value.sign()? {
        Sign::Positive => margins,
        Sign::Negative => margins.map(|margins| margins.map(|sign| sign * Sign::Negative)),
        Sign::Zero => return None,
    };
    match margins {
        [Some(Sign::Positive), Some(Sign::Positive)] => Some(true),
        [Some(Sign::Negative), _] | [_, Some(Sign::Negative)] => Some(false),
        _ => None,
    }
}

/// Halves [lo, hi] until a verdict holds all over a cell, or it is narrower than 2^−44 of the whole, and
/// joins what agrees.
pub(super) fn pieces(lo: f64, hi: f64, mut verdict: impl FnMut(f64, f64) -> Option<bool>) -> Vec<Piece> {
    // (where it begins, whether the steps up to the next one are stable)
    let mut cells: Vec<(f64, Option<bool>)> = Vec::new();
    let mut open = vec![(lo, hi, 0)];
    while let Some((lo, hi, depth)) = open.pop() {
        let flag = verdict(lo, hi);
        if flag.is_some() || depth == HALVINGS {
            if cells.last().is_none_or(|last| last.1 != flag) {
                cells.push((lo, flag));
            }
        } else {
            let middle = lo + (hi - lo) / 2.0;
            open.extend([(middle, hi, depth + 1), (lo, middle, depth + 1)]);
        }
    }
    let ends = |n: usize| cells.get(n).map_or(hi, |cell| cell.0);
    let piece = |n: usize| {
        let stable = cells[n].1?;
        let lower =
            if n > 0 && cells[n - 1].1.is_none() { (ends(n - 1), ends(n)) } else { (ends(n), ends(n)) };
        let upper = match cells.get(n + 1) {
            Some((_, None)) => (ends(n + 1), ends(n + 2)),
            _ => (ends(n + 1), ends(n + 1)),
        };
        Some(Piece { stable, lower, upper })
    };
    (0..cells.len()).filter_map(piece).collect()
}
