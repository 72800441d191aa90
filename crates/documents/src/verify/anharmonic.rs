//! A word on an oscillator that is not linear, letter by letter in fixed point: the order that its steps show.
//!
//! H = T(v) + V1(x) + V2(x) with T = v²/2, or v²/2 + v³/3 where the kinetic energy may be any, −V1' = −x − x²
//! and −V2' = −x³. The error of a step of 2^-80 and that of half of it differ by 2^(p + 1).

use num_bigint::BigInt;
use num_traits::{Signed, Zero};

use number::{Radical, Rational, Real};
use words::{Force, Letter};

/// Bits after the point: errors of order 9 are near 2^-800.
const BITS: u32 = 1000;

/// The step is 2^-80: the next order's error is as much smaller.
const STEP_LOG2: u32 = 80;

/// Terms of a Taylor series: those left out are below 2^(-80 · 14).
const TERMS: i64 = 14;

type Fixed = BigInt;

fn fixed(x: &Rational) -> Fixed {
    (x.numer() << BITS) / x.denom()
}

fn times(a: &Fixed, b: &Fixed) -> Fixed {
    (a * b) >> BITS
}

/// The order that a word shows; `None` where a letter is no kick and no drift, or a force gradient meets a
/// kinetic energy that is not quadratic.
pub(super) fn order(word: &words::Word, quadratic: bool) -> Option<u64> {
    let start = [(3, 10), (2, 5)].map(|(n, d): (i64, i64)| fixed(&Rational::new(n.into(), d.into())));
    let error = |log2: u32| {
        let h = BigInt::from(1) << (BITS - log2);
        let (step, solution) = (step(word, quadratic, &h, &start)?, solution(quadratic, &h, &start));
        Some([0, 1].iter().map(|&i| (&step[i] - &solution[i]).abs()).sum::<Fixed>())
    };
    let (coarse, fine) = (error(STEP_LOG2)?, error(STEP_LOG2 + 1)?);
    if fine.is_zero() {
        return None;
    }
    // Between 2^(p + 1/2) and 2^(p + 3/2), in squares.
    let ratio = (coarse << 64u32) / fine;
    let log2 = ((&ratio * &ratio) >> 128u32).bits();
    Some((log2 / 2).saturating_sub(1))
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

fn step(word: &words::Word, quadratic: bool, h: &Fixed, start: &[Fixed; 2]) -> Option<[Fixed; 2]> {
    let [mut x, mut v] = start.clone();
    let by = |c: &Radical, time: &Fixed| times(&fixed(&c.enclosure(BITS).upper()), time);
    let cube = times(&times(h, h), h);
    for letter in word.letters() {
        match letter {
            Letter::Friction(_) => (),
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
            Letter::Flow { .. } | Letter::Midpoint { .. } => return None,
        }
    }
    Some([x, v])
}

/// The solution after h by its Taylor series.
fn solution(quadratic: bool, h: &Fixed, start: &[Fixed; 2]) -> [Fixed; 2] {
    let coefficient =
        |a: &[Fixed], b: &[Fixed], n: usize| (0..=n).map(|k| times(&a[k], &b[n - k])).sum::<Fixed>();
    let [mut x, mut v] = start.clone().map(|value| vec![value]);
    let mut squares = Vec::new();
    for n in 0..TERMS as usize {
        squares.push(coefficient(&x, &x, n));
        let velocity = if quadratic { v[n].clone() } else { &v[n] + coefficient(&v, &v, n) };
        let pull = -(&x[n] + &squares[n] + coefficient(&squares, &x, n));
        x.push(velocity / (n + 1));
        v.push(pull / (n + 1));
    }
    [x, v].map(|series| series.iter().rev().fold(Fixed::zero(), |sum, c| times(&sum, h) + c))
}
