//! Trigonometric integrators: the fast force by its exact flow, the slow one by filtered kicks.
//!
//! With w = √Λ1, y = h w/2, c = cos y, s = sin y and ρ = Λ2/Λ1 the trace of a step is Tr = 2 cos h w − h² Λ2
//! g with g = c^i (s/y)^k (Hairer, Lubich, Wanner, Geometric Numerical Integration, XIII.2), so that
//!
//! ```text
//!     (2 + Tr)/4 = c² − ρ y² c^i (s/y)^k,        (2 − Tr)/4 = s² + ρ y² c^i (s/y)^k.
//! ```
//!
//! A step is unstable where one of them is negative. Common factors c² and s² change no sign; they are 0 only
//! where the filters are, and the propagator is ±I there. Balls over intervals of y prove the signs
//! everywhere but at the edges; theorems on transcendental numbers decide whether a step is an edge, see
//! `at_edge`.
//!
//! ```
//! use kickdrift_words::number::{Laurent, rational::ratio};
//! use kickdrift_words::Trigonometric;
//! // Periods 10 and 40: Λ = (2 π/T)².
//! let [fast, slow] = [ratio(1, 25), ratio(1, 400)].map(|c| Laurent::monomial(c, 2));
//! let unstable = Trigonometric::Short.unstable(&fast, &slow, 16.0);
//! assert_eq!(format!("{:.4} {:.4}", unstable[0][0].0, unstable[0][1].1), "4.8703 5.0000");
//! assert!(Trigonometric::HairerLubich.unstable(&fast, &slow, 16.0).is_empty());
//! ```

use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};

use super::enclosed::{Piece, pieces};
use super::letters::{Force, Item, Letter, Word};
use number::{Ball, Laurent, Rational, Real, Sign, named, ratio};

named! {
    /// A trigonometric integrator, by its filters.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Trigonometric {
        /// No filter: g = sinc h w.
        Impulse = "impulse",
        /// g = sinc²(h w/2).
        Gautschi = "gautschi",
        /// MOLLY, positions averaged over a short time: g = sinc h w sinc²(h w/2).
        Short = "molly-short",
        /// MOLLY, the average weighted linearly: g = sinc h w sinc⁴(h w/2).
        Linear = "molly-linear",
        /// MOLLY, positions averaged over the whole step: g = sinc³ h w.
        Long = "molly-long",
        /// g = sinc² h w.
        HairerLubich = "hairer-lubich",
    }
}

/// Bits of the balls; intervals are halved to fewer.
const BITS: u32 = 96;

/// The most bits of a step that is no edge, for all that is known.
const MOST_BITS: u32 = 1 << 13;

impl Trigonometric {
    /// (i, k) of g = c^i (s/y)^k.
    fn powers(self) -> (u32, u32) {
        match self {
            Trigonometric::Impulse => (1, 1),
            Trigonometric::Gautschi => (0, 2),
            Trigonometric::Short => (1, 3),
            Trigonometric::Linear => (1, 5),
            Trigonometric::Long => (3, 3),
            Trigonometric::HairerLubich => (2, 2),
        }
    }

    /// Whether only its two-step form is published, Gautschi's and that of Hairer and Lubich; else kicks
    /// stand around an exact flow.
    pub fn is_two_step(self) -> bool {
        matches!(self, Trigonometric::Gautschi | Trigonometric::HairerLubich)
    }

    /// (i, k) of the filter c^i (s/y)^k of positions and forces alike: its square is g, beside the c s/y of
    /// an exact flow.
    pub fn filter(self) -> (u32, u32) {
        let (i, k) = self.powers();
        let count = u32::from(!self.is_two_step());
        ((i - count) / 2, (k - count) / 2)
    }

    /// Its trace.
    pub fn shape(self) -> Shape {
        let (cos, sinc) = self.powers();
        Shape { cos, sinc, felt: true }
    }

    /// See [`Shape::stable_at`].
    pub fn at(self, s: &Laurent, rho: &Rational) -> Option<bool> {
        self.shape().stable_at(s, rho)
    }

    /// See [`Shape::unstable`].
    pub fn unstable(self, fast: &Laurent, slow: &Laurent, most: f64) -> Vec<[(f64, f64); 2]> {
        self.shape().unstable(fast, slow, most)
    }

    /// The end of the steps at which **any number of coupled modes** is stable, with 0 ≤ F ≤ Λ1 and 0 ≤ S ≤
    /// Λ2: proven stable below its lower end.
    ///
    /// There P and R of proofs/REGION.md, section 8, are definite as long as h w < π and ρ y² c^(i−1)
    /// (s/y)^k < c for every w² ≤ Λ1. Of this, (s/y)^k c^(i−1)/c times h² Λ2/4 is the left side over the
    /// right one. Its logarithm has the derivative Σ a_n (4^n − 1 − k) y^(2n−1) for i = 1, all a_n > 0: it
    /// increases for k ≤ 3, and for k = 5 decreases first and then increases. So the ends of 0 ≤ w² ≤ Λ1
    /// decide: at w = 0 it is h² Λ2 < 4, at w² = Λ1 the first edge. For i = 3 it is at most h² Λ2/4, and h
    /// w < π. `None` for what is no filtered impulse.
    pub fn coupled_edge(self, fast: &Laurent, slow: &Laurent) -> Option<(f64, f64)> {
        let frequency = half_frequency(fast, BITS).scale2(1);
        let turn = Ball::pi(BITS).div(&frequency, BITS)?.to_f64_enclosure();
        let pair = match self {
            Trigonometric::Impulse | Trigonometric::Short | Trigonometric::Linear => {
                self.unstable(fast, slow, turn.1).first()?[0]
            }
            Trigonometric::Long => turn,
            Trigonometric::Gautschi | Trigonometric::HairerLubich => return None,
        };
        let rigid =
            Ball::from_integer(&2.into()).div(&slow.enclosure(BITS).sqrt(BITS)?, BITS)?.to_f64_enclosure();
        Some((pair.0.min(rigid.0), pair.1.min(rigid.1)))
    }

    /// See [`Shape::is_free`].
    pub fn is_free(self, rho: &Rational) -> bool {
        self.shape().is_free(rho)
    }
}

/// The trace 2 cos h w − h² Λ2 g with g = c^i (s/y)^k, and with g = 0: of one filtered slow kick beside one
/// exact fast flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    pub cos: u32,
    pub sinc: u32,
    /// Whether the slow force is felt at all; else g = 0.
    pub felt: bool,
}

impl Shape {
    /// The trace of a word that has, once its ends are joined, one slow kick and one fast flow, each over the
    /// whole step; `None` for all others, and where g has a pole. A kick and a flow have that trace in
    /// whatever order and shares they stand around each other.
    pub fn of(word: &Word) -> Option<Shape> {
        let mut letters: Vec<Letter> = word.joined();
        letters.retain(|letter| !matches!(letter, Letter::Friction { .. }));
        if letters.len() == 3 {
            // Their traces are those of the words that begin elsewhere.
            let last = letters.pop()?;
            letters.insert(0, last);
            letters = Word::new(letters.into_iter().map(Item::Letter).collect())?.joined();
        }
        if letters.first().is_some_and(|letter| matches!(letter, Letter::Flow { .. })) {
            letters.rotate_left(1);
        }
        let [
            Letter::Kick { force: Force::Second, filter, powers },
            Letter::Flow { force: Force::First, time },
        ] = letters.as_slice()
        else {
            return None;
        };
        let whole = powers.len() == 1 && powers[0].is_one() && time.is_one();
        let power = |n: i32| u32::try_from(n + 1).ok();
        whole.then_some(())?;
        Some(Shape { cos: power(filter.cos)?, sinc: power(filter.sinc)?, felt: !filter.zero })
    }

    /// The signs of 2 + Tr and 2 − Tr, without factors that are squares, for every y of a ball; `None` where
    /// they are undecided.
    fn signs(self, y: &Ball, rho: &Ball, bits: u32) -> [Option<Sign>; 2] {
        if !self.felt {
            // 4 cos² y and 4 sin² y: ±I where they are 0.
            return [Some(Sign::Positive); 2];
        }
        let (i, k) = (self.cos, self.sinc);
        let (c, sinc) = (y.cos(bits), sinc(y, bits));
        let power = |x: &Ball, n: u32| (0..n).fold(Ball::one(), |product, _| product.mul(x, bits));
        let common = i.min(2);
        let kicked = rho.mul(&y.square(bits), bits).mul(&power(&sinc, k), bits);
        // c², or c (c − ...), or 1 − ...
        let bracket = power(&c, 2 - common).sub(&kicked.mul(&power(&c, i - common), bits), bits);
        let below = if common == 1 { c.mul(&bracket, bits) } else { bracket };
        // s² is y² sinc².
        let rest = rho.mul(&power(&c, i), bits);
        let above = match k {
            0 => sinc.square(bits).add(&rest, bits),
            1 => sinc.mul(&sinc.add(&rest, bits), bits),
            _ => Ball::one().add(&rest.mul(&power(&sinc, k - 2), bits), bits),
        };
        [below.sign(), above.sign()]
    }

    /// Whether every step of an interval of y is stable or every one unstable; `None` where that is
    /// undecided.
    fn verdict(self, y: &Ball, rho: &Ball, bits: u32) -> Option<bool> {
        match self.signs(y, rho, bits) {
            [Some(Sign::Positive), Some(Sign::Positive)] => Some(true),
            [Some(Sign::Negative), _] | [_, Some(Sign::Negative)] => Some(false),
            _ => None,
        }
    }

    /// Whether the step with s = h² Λ1 is stable, ρ > 0; `None` at s = 0, and where neither 8192 bits nor a
    /// theorem decide.
    pub fn stable_at(self, s: &Laurent, rho: &Rational) -> Option<bool> {
        if s.is_zero() {
            return None;
        }
        let at = |bits: u32| self.verdict(&half_frequency(s, bits), &Ball::from_rational(rho, bits), bits);
        let doubled = || std::iter::successors(Some(2 * BITS), |bits| Some(2 * bits));
        at(BITS)
            .or_else(|| self.at_edge(s, rho))
            .or_else(|| doubled().take_while(|bits| *bits <= MOST_BITS).find_map(at))
    }

    /// Whether an edge is stable; `None` where s is no edge, or where it is not known whether it is.
    ///
    /// For h w = r π, s = r² π²: where r is a whole number s or c is 0, the flow is ±I, and the step is ±I if
    /// the filter c^(i−1) (s/y)^(k−1) of the kick is 0 there, and else a kick, under which a displacement
    /// grows with every step. Where it is none, and k is not 2, c² and s² are algebraic and not 0, what is
    /// added to them is a power of π times an algebraic number, and π is transcendental: no sum is 0. For k =
    /// 2 it is only where cos h w is a rational number, which at rational r is 0, ±1/2 or ±1 (Niven). A
    /// rational s > 0 is no edge at all: the exponentials of different algebraic numbers are independent over
    /// the algebraic numbers (Lindemann, Weierstrass), so c² and what is added to it, other sums of them,
    /// have no common value.
    fn at_edge(self, s: &Laurent, rho: &Rational) -> Option<bool> {
        let r = turns(s)?;
        if r.is_integer() {
            let is_even = (r.to_integer() % BigInt::from(2)).is_zero();
            return Some(if is_even { self.sinc > 1 } else { self.cos > 1 });
        }
        let edge = match (self.cos, self.sinc) {
            // c² = ρ s².
            (0, 2) => (rho - Rational::one()) / (rho + Rational::one()),
            // 1 = ρ s².
            (2, 2) => Rational::one() - ratio(2, 1) / rho,
            _ => return None,
        };
        (cosine(&r) == Some(edge)).then_some(false)
    }

    /// Every step h of (lo, hi), 0 ≤ lo: pieces with one answer, their ends enclosed. Outside the enclosures
    /// every step is proven stable or unstable. Intervals thinner than 2^−44 of the range are not
    /// distinguished from edges that touch.
    pub fn pieces(self, fast: &Laurent, slow: &Laurent, lo: f64, hi: f64) -> Vec<Piece> {
        let (half, rho) = (half_frequency(fast, BITS), over(slow, fast));
        let at = |h: f64| half.mul(&Ball::from_f64(h).unwrap_or_else(Ball::zero), BITS);
        pieces(lo, hi, |lo, hi| self.verdict(&at(lo).union(&at(hi), BITS), &rho, BITS))
    }

    /// The unstable intervals of the step h that begin below `most` > 0, both ends of each enclosed; an end
    /// beyond `most` is not looked for, but given as `most`.
    pub fn unstable(self, fast: &Laurent, slow: &Laurent, most: f64) -> Vec<[(f64, f64); 2]> {
        let all = self.pieces(fast, slow, 0.0, most).into_iter();
        all.filter(|piece| !piece.stable).map(|piece| [piece.lower, piece.upper]).collect()
    }

    /// Whether no step at all is unstable, of one mode: proven for i, k ≥ 2 where 0 < ρ < 1, since then ρ y²
    /// c^(i−2) (s/y)^k ≤ ρ s² < 1 and ρ |c^i (s/y)^(k−2)| < 1. So it is for MOLLY's long average and the
    /// methods of Hairer and Lubich, and of Grimm and Hochbruck.
    pub fn is_free(self, rho: &Rational) -> bool {
        !self.felt || self.cos >= 2 && self.sinc >= 2 && rho.is_positive() && *rho < Rational::one()
    }
}

/// √Λ/2.
fn half_frequency(stiffness: &Laurent, bits: u32) -> Ball {
    stiffness.enclosure(bits).sqrt(bits).expect("a stiffness is positive").scale2(-1)
}

/// r > 0 where s = r² π² and r is rational.
fn turns(s: &Laurent) -> Option<Rational> {
    let (power, square) = s.as_monomial()?;
    let root = |n: &BigInt| Some(n.sqrt()).filter(|root| root * root == *n);
    (power == 2).then(|| Some(Rational::new(root(square.numer())?, root(square.denom())?)))?
}

/// cos r π, where it is rational and r is no whole number.
fn cosine(r: &Rational) -> Option<Rational> {
    let two = ratio(2, 1);
    let rest = r - (r / &two).floor() * &two;
    let known = [
        ((1, 2), (0, 1)),
        ((3, 2), (0, 1)),
        ((1, 3), (1, 2)),
        ((5, 3), (1, 2)),
        ((2, 3), (-1, 2)),
        ((4, 3), (-1, 2)),
    ];
    known.into_iter().find(|((n, d), _)| ratio(*n, *d) == rest).map(|(_, (n, d))| ratio(n, d))
}

fn over(slow: &Laurent, fast: &Laurent) -> Ball {
    match Laurent::ratio(slow, fast) {
        Some(rho) => Ball::from_rational(&rho, BITS),
        None => {
            slow.enclosure(BITS).div(&fast.enclosure(BITS), BITS).expect("the fast stiffness is positive")
        }
    }
}

/// sin y / y of every y of a ball.
fn sinc(y: &Ball, bits: u32) -> Ball {
    match y.sin(bits).div(y, bits) {
        Some(ball) if y.is_away_from_zero() => ball,
        // 1 − y²/6 ≤ sinc y ≤ 1.
        _ => {
            let square = y.square(bits).upper();
            let least = Rational::one() - square / Rational::from_integer(6.into());
            Ball::from_rational(&least, bits).union(&Ball::one(), bits)
        }
    }
}
