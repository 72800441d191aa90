//! A word on an oscillator that is not linear, letter by letter in fixed point: the order that its steps
//! show, to hold [`Word::general_order`] against. Nothing is expanded.
//!
//! H = T(v) + V1(x) + V2(x) with T = v²/2, or v²/2 + v³/3 where the kinetic energy may be any, −V1' = −x − x²
//! and −V2' = −x³. The error of a step h and that of h/2 differ by 2^(p + 1).

use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive, Zero};

use super::letters::{Force, Letter, Word};
use number::{Radical, Rational, Real};

/// Bits after the point: errors of order 9 are near 2^-800.
const BITS: u32 = 1000;

/// Bits after the point of the ratio of two errors.
const RATIO_BITS: u32 = 40;

/// Errors below so many last bits are those of rounding.
const ROUNDING_BITS: u32 = 50;

/// The most terms of a Taylor series: those left out are below h^60, and below the last bit where fewer do.
const MOST_TERMS: u32 = 60;

type Fixed = BigInt;

/// The terms for steps of 2^-`step_log2`.
fn terms(step_log2: u32) -> u32 {
    MOST_TERMS.min(BITS / step_log2 + 2)
}

fn fixed(x: &Rational) -> Fixed {
    (x.numer() << BITS) / x.denom()
}

fn times(a: &Fixed, b: &Fixed) -> Fixed {
    (a * b) >> BITS
}

/// The order that a word shows at the steps 2^-`step_log2` and half of it, to about the shorter one; rounded
/// coefficients show theirs at long steps, and what they leave at short ones. `None` where a letter is no
/// kick, no drift and no flow, where a force gradient meets a kinetic energy that is not quadratic, and where
/// nothing is off.
pub fn order_shown(word: &Word, quadratic: bool, step_log2: u32) -> Option<f64> {
    let start = [(3, 10), (2, 5)].map(|(n, d): (i64, i64)| fixed(&Rational::new(n.into(), d.into())));
    let error = |log2: u32| {
        let h = BigInt::from(1) << (BITS - log2);
        let (step, solution) = (
            step(word, quadratic, &h, log2, &start)?,
            solution(quadratic, Force::All, &h, &start, terms(log2)),
        );
        Some([0, 1].iter().map(|&i| (&step[i] - &solution[i]).abs()).sum::<Fixed>())
    };
    let (coarse, fine) = (error(step_log2)?, error(step_log2 + 1)?);
    // Flows are followed to the last bits.
    if fine.bits() < u64::from(ROUNDING_BITS) {
        return None;
    }
    let ratio = (coarse << RATIO_BITS).checked_div(&fine)?.to_f64()?;
    (ratio > 0.0).then(|| ratio.log2() - f64::from(RATIO_BITS) - 1.0)
}

fn force(force: Force, x: &Fixed) -> Fixed {
    let square = times(x, x);
    let (first, second) = (-(x + &square), -times(&square, x));
    match force {
        Force::First => first,
        Force::Second => second,
        Force::All => first + second,
    }
}

/// The derivative of [`force`].
fn slope(force: Force, x: &Fixed) -> Fixed {
    let (first, second) = (-((BigInt::from(1) << BITS) + x * 2u8), -(times(x, x) * 3u8));
    match force {
        Force::First => first,
        Force::Second => second,
        Force::All => first + second,
    }
}

fn step(word: &Word, quadratic: bool, h: &Fixed, log2: u32, start: &[Fixed; 2]) -> Option<[Fixed; 2]> {
    let [mut x, mut v] = start.clone();
    let by = |c: &Radical, time: &Fixed| times(&fixed(&c.enclosure(BITS).upper()), time);
    let cube = times(&times(h, h), h);
    for letter in word.letters() {
        match letter {
            Letter::Friction { .. } => (),
            Letter::Drift(time) => {
                let velocity = if quadratic { v.clone() } else { &v + times(&v, &v) };
                x += times(&by(time, h), &velocity);
            }
            Letter::Kick { filter, .. } if filter.zero => (),
            Letter::Kick { filter, powers, .. } if !filter.is_one() || powers.len() > 2 => return None,
            Letter::Kick { force: named, powers, .. } => {
                let pull = force(*named, &x);
                v += times(&by(&powers[0], h), &pull);
                if let Some(strength) = powers.get(1).filter(|strength| !strength.is_zero()) {
                    if !quadratic {
                        return None;
                    }
                    // Of a linear force f = −Λ x: f' f = Λ² x, and v −= d h³ Λ² x.
                    v -= times(&by(strength, &cube), &times(&slope(*named, &x), &pull));
                }
            }
            Letter::Flow { force, time } => {
                [x, v] = solution(quadratic, *force, &by(time, h), &[x, v], terms(log2));
            }
            Letter::Midpoint { .. } => return None,
        }
    }
    Some([x, v])
}

/// The solution after h, moved by one force or by both, by its Taylor series.
fn solution(quadratic: bool, force: Force, h: &Fixed, start: &[Fixed; 2], terms: u32) -> [Fixed; 2] {
    let coefficient =
        |a: &[Fixed], b: &[Fixed], n: usize| (0..=n).map(|k| times(&a[k], &b[n - k])).sum::<Fixed>();
    let [mut x, mut v] = start.clone().map(|value| vec![value]);
    let mut squares = Vec::new();
    for n in 0..terms as usize {
        squares.push(coefficient(&x, &x, n));
        let velocity = if quadratic { v[n].clone() } else { &v[n] + coefficient(&v, &v, n) };
        let (first, second) = (-(&x[n] + &squares[n]), -coefficient(&squares, &x, n));
        let pull = match force {
            Force::First => first,
            Force::Second => second,
            Force::All => first + second,
        };
        x.push(velocity / (n + 1));
        v.push(pull / (n + 1));
    }
    [x, v].map(|series| series.iter().rev().fold(Fixed::zero(), |sum, c| times(&sum, h) + c))
}
