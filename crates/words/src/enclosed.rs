//! Words with exact flows, filters or friction, in balls.
//!
//! A step's matrix is divided by q e, q of midpoints and e of implicit friction; with T the matrix's trace
//! and d/e the step's determinant, the powers are bounded if |T| < q (e + d) and d ≤ e, q and e being
//! positive (Jury's conditions for two eigenvalues inside the unit circle; for d = e they are on it and
//! differ), and unbounded if
//! |T| > q (e + d) or d > e. Over an interval of steps q (e + d) ∓ T is enclosed by its value in the middle and the balls of its derivative over the whole, so that the width
//! of cells falls with the distance from an edge, and not with its square where the trace only touches ±2.

use std::cell::{Cell, RefCell};

use num_traits::One;

use super::exactly::Exact;
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

/// Exponents of repulsive flows and of friction beyond this, e^(2^14), are left undecided.
const MOST_EXPONENT_LOG2: u32 = 14;

type Jet = jet::Jet<BITS>;

/// An oscillator that a word integrates.
#[derive(Clone, Debug)]
pub struct Enclosed<'a> {
    word: &'a Word,
    /// Λ1, Λ2 and their sum.
    stiffness: [Ball; 3],
    friction: Ball,
    /// The same, where numbers are known that may be rational.
    exactly: Option<Exact>,
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
    stiffness: [Ball; 3],
    friction: Ball,
    /// Cleared where a filter has a pole, and where exponents are too large.
    defined: Cell<bool>,
    /// Flows that are known: a palindrome has each twice.
    flows: RefCell<Vec<Flow>>,
}

/// The first row of an exact flow.
struct Flow {
    force: Force,
    time: Radical,
    moved: [Jet; 2],
}

impl Steps {
    fn constant(&self, x: Ball) -> Jet {
        Jet::constant(x)
    }

    /// Λ of a force.
    fn stiffness(&self, force: Force) -> &Ball {
        let [fast, slow, sum] = &self.stiffness;
        match force {
            Force::All => sum,
            Force::First => fast,
            Force::Second => slow,
        }
    }

    fn undefined(&self) -> Ball {
        self.defined.set(false);
        Ball::zero()
    }

    /// √|Λ| of a force, and whether it repels; 0 where its sign is not known.
    fn frequency(&self, force: Force) -> (Ball, bool) {
        let stiffness = self.stiffness(force);
        let repels = stiffness.sign() == Some(Sign::Negative);
        let size = if repels { stiffness.neg() } else { stiffness.clone() };
        (size.sqrt_clipped(BITS).unwrap_or_else(|| self.undefined()), repels)
    }

    fn exp(&self, x: &Ball) -> Ball {
        let limit = Ball::one().scale2(MOST_EXPONENT_LOG2.into());
        if x.compare(&limit) == Some(std::cmp::Ordering::Less) { x.exp(BITS) } else { self.undefined() }
    }

    /// cosh x and sinh x.
    fn hyperbolic(&self, x: &Ball) -> [Ball; 2] {
        let (up, down) = (self.exp(x), self.exp(&x.neg()));
        [up.add(&down, BITS).scale2(-1), up.sub(&down, BITS).scale2(-1)]
    }

    /// cosh x and sinh x / x, for x ≥ 0; about 0 by the bounds 1 ≤ sinh x / x ≤ cosh x, whose slope is at
    /// most x/3 cosh x.
    fn repelled(&self, x: &Jet) -> [Jet; 2] {
        let ball = &x.value;
        let [cosh, sinh] = self.hyperbolic(ball);
        let (sinhc, slope) = if ball.is_away_from_zero() {
            let sinhc = self.over(&sinh, ball);
            let slope = self.over(&cosh.sub(&sinhc, BITS), ball);
            (sinhc, slope)
        } else {
            let third = Ball::from_rational(&Rational::new(1.into(), 3.into()), BITS);
            let most = ball.mul(&cosh, BITS).mul(&third, BITS);
            (Ball::one().union(&cosh, BITS), Ball::zero().union(&most, BITS))
        };
        [x.chained(cosh, &sinh), x.chained(sinhc, &slope)]
    }

    fn over(&self, x: &Ball, by: &Ball) -> Ball {
        x.div(by, BITS).unwrap_or_else(|| self.undefined())
    }

    /// cos x and sin x / x; about 0 the latter by the bounds 1 − x²/6 ≤ sinc x ≤ 1, −x/3 ≤ sinc' x ≤ 0 for x
    /// ≥ 0.
    fn circular(&self, x: &Jet) -> [Jet; 2] {
        let ball = &x.value;
        let (cos, sin) = (ball.cos(BITS), ball.sin(BITS));
        let (sinc, slope) = if ball.is_away_from_zero() {
            let sinc = self.over(&sin, ball);
            let slope = self.over(&cos.sub(&sinc, BITS), ball);
            (sinc, slope)
        } else {
            let sixth = Ball::from_rational(&Rational::new(1.into(), 6.into()), BITS);
            let least = Ball::one().sub(&ball.square(BITS).mul(&sixth, BITS), BITS);
            let slope = ball.mul(&sixth, BITS).scale2(1).neg();
            (least.union(&Ball::one(), BITS), slope.union(&Ball::zero(), BITS))
        };
        [x.chained(cos, &sin.neg()), x.chained(sinc, &slope)]
    }

    fn moved(&self, force: Force, c: &Radical) -> [Jet; 2] {
        let (c, (frequency, repels)) = (c.enclosure(BITS), self.frequency(force));
        // Both are even in c.
        let x = Jet::product(&self.h, &self.constant(frequency.mul(&c.abs(), BITS)));
        let [cos, sinc] = if repels { self.repelled(&x) } else { self.circular(&x) };
        [cos, Jet::product(&sinc, &self.constant(c))]
    }
}

impl Setting<Jet> for Steps {
    fn force(&self, force: Force) -> Jet {
        Jet::product(&Jet::product(&self.h, &self.h), &self.constant(self.stiffness(force).clone()))
    }

    fn embed(&self, c: &Radical) -> Jet {
        self.constant(c.enclosure(BITS))
    }

    fn flow(&self, force: Force, c: &Radical) -> [Jet; 2] {
        let is_known = |known: &&Flow| known.force == force && known.time == *c;
        if let Some(known) = self.flows.borrow().iter().find(is_known) {
            return known.moved.clone();
        }
        let moved = self.moved(force, c);
        self.flows.borrow_mut().push(Flow { force, time: c.clone(), moved: moved.clone() });
        moved
    }

    fn filter(&self, filter: Filter) -> Jet {
        if filter.zero {
            return self.constant(Ball::zero());
        }
        let half = Jet::product(&self.h, &self.constant(self.frequency(Force::First).0.scale2(-1)));
        let power = |x: Jet, n: i32| {
            let jet = (0..n.unsigned_abs()).fold(Jet::one(), |product, _| Jet::product(&product, &x));
            if n >= 0 {
                return jet;
            }
            let inverse = self.over(&Ball::one(), &jet.value);
            let slope = inverse.square(BITS).neg();
            jet.chained(inverse, &slope)
        };
        let [cos, sinc] = self.circular(&half);
        Jet::product(&power(cos, filter.cos), &power(sinc, filter.sinc))
    }

    fn damping(&self, c: &Radical) -> Jet {
        // exp(0) is 1 itself: in a ball around it no margin of a step on an edge would have a sign.
        if self.friction.sign() == Some(Sign::Zero) {
            return self.constant(Ball::one());
        }
        let x = -self.friction(c);
        let value = self.exp(&x.value);
        x.chained(value.clone(), &value)
    }

    fn friction(&self, c: &Radical) -> Jet {
        Jet::product(&self.h, &self.constant(self.friction.mul(&c.enclosure(BITS), BITS)))
    }
}

impl<'a> Enclosed<'a> {
    /// A word, its stiffnesses, its friction γ ≥ 0.
    pub fn new(word: &'a Word, fast: &Laurent, slow: &Laurent, friction: &Laurent) -> Enclosed<'a> {
        let ball = |x: &Laurent| x.enclosure(BITS);
        let sum = fast.clone() + slow.clone();
        let exactly = word.is_algebraic() && word.is_damped_rationally();
        Enclosed {
            word,
            stiffness: [ball(fast), ball(slow), ball(&sum)],
            friction: ball(friction),
            exactly: exactly
                .then(|| Exact { stiffness: [fast, slow].map(Clone::clone), friction: friction.clone() }),
        }
    }

    /// At h² Λ1 = s and h² Λ2 = ρ s, h being 1; no friction.
    pub(super) fn scaled(word: &'a Word, s: &Laurent, rho: &Rational) -> Enclosed<'a> {
        let fast = s.enclosure(BITS);
        let times = |x: &Rational| fast.mul(&Ball::from_rational(x, BITS), BITS);
        let stiffness = [fast.clone(), times(rho), times(&(rho + Rational::one()))];
        Enclosed { word, stiffness, friction: Ball::zero(), exactly: None }
    }

    /// The product over all steps of a ball; `None` where a filter has a pole.
    fn product(&self, h: Ball) -> Option<Product<Jet>> {
        let steps = Steps {
            h: Jet::variable(h),
            stiffness: self.stiffness.clone(),
            friction: self.friction.clone(),
            defined: Cell::new(true),
            flows: RefCell::default(),
        };
        let product = self.word.product(&steps);
        steps.defined.get().then_some(product)
    }

    /// Whether all steps of [lo, hi] are stable or all unstable; `None` where that is undecided.
    fn verdict(&self, lo: f64, hi: f64) -> Option<bool> {
        let (middle, cell) = (Ball::from_f64(lo + (hi - lo) / 2.0)?, Ball::between(lo, hi, BITS)?);
        let (here, over) = (self.product(middle.clone())?, self.product(cell.clone())?);
        let off = cell.sub(&middle, BITS);
        let pairs = here.margins().into_iter().zip(over.margins());
        // The value in the middle and the mean value theorem.
        let signs: Vec<Option<Sign>> = pairs
            .map(|(here, over)| {
                here.value.add(&over.slope.mul(&off, BITS), BITS).sign().or(over.value.sign())
            })
            .collect();
        stable(&over, [signs[0], signs[1]])
    }

    /// The answer at one step h > 0. `kind` is `edge` where balls of 128 bits cannot decide, `damped` where
    /// friction draws all to 0, and `marginal` where an eigenvalue is on the unit circle and the other one
    /// inside. Where every number is rational it is decided.
    pub fn at(&self, h: &Laurent) -> Option<At> {
        let product = self.product(h.enclosure(BITS))?;
        let q = &product.denominator.value;
        let implicit = &product.implicit.value;
        let trace = product.trace().value.div(&q.mul(implicit, BITS), BITS)?;
        let determinant = product.damping.value.div(implicit, BITS)?;
        let [above, below] = product.margins().map(|margin| margin.value.sign());
        let damped = determinant.compare(&Ball::one()) == Some(std::cmp::Ordering::Less);
        let stable = stable(&product, [above, below]);
        let mut found = At {
            kind: match stable {
                None => self.exactly.as_ref().and_then(|exact| exact.kind(self.word, h)).unwrap_or("edge"),
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
    let (damping, implicit) = (&product.damping.value, &product.implicit.value);
    let side = implicit.sign()?;
    // Friction below 0 feeds energy in; an explicit step that is too long does, too.
    match (damping.compare(implicit)?, side) {
        (_, Sign::Zero) => return None,
        (std::cmp::Ordering::Greater, Sign::Positive) | (std::cmp::Ordering::Less, Sign::Negative) => {
            return Some(false);
        }
        _ => (),
    }
    // A negative denominator turns both.
    let margins = match product.denominator.value.sign()? * side {
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
