//! Sine, cosine and arcsine of doubles with proven bounds, the same on every machine (proofs/BANDS.md).

/// No sine and no cosine of [`sine_cosine`] is further off.
pub const TRIG: f64 = 4e-15;

/// π/2 as two doubles, within 2^-108.
const QUARTER: [f64; 2] = [std::f64::consts::FRAC_PI_2, 6.123233995736766e-17];

/// 1/1!, 1/3!, ... with alternating signs.
const SINE: [f64; 10] = [
    1.0,
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5040.0,
    1.0 / 362880.0,
    -1.0 / 39916800.0,
    1.0 / 6227020800.0,
    -1.0 / 1307674368000.0,
    1.0 / 355687428096000.0,
    -1.0 / 121645100408832000.0,
];

/// 1/0!, 1/2!, ... with alternating signs.
const COSINE: [f64; 10] = [
    1.0,
    -1.0 / 2.0,
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40320.0,
    -1.0 / 3628800.0,
    1.0 / 479001600.0,
    -1.0 / 87178291200.0,
    1.0 / 20922789888000.0,
    -1.0 / 6402373705728000.0,
];

fn series(coefficients: &[f64; 10], square: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * square + c)
}

/// sin x and cos x within [`TRIG`] for |x| ≤ 10^6.
pub fn sine_cosine(x: f64) -> [f64; 2] {
    let n = (x / QUARTER[0]).round();
    let r = (-n).mul_add(QUARTER[1], (-n).mul_add(QUARTER[0], x));
    let square = r * r;
    let (s, c) = (r * series(&SINE, square), series(&COSINE, square));
    match n.rem_euclid(4.0) as u8 {
        0 => [s, c],
        1 => [c, -s],
        2 => [-s, -c],
        _ => [-c, s],
    }
}

/// arcsin x and a bound on its error, for 0 ≤ x < 1.
pub fn arcsine(x: f64) -> [f64; 2] {
    if x > 0.75 {
        // π/2 − arcsin √(1 − x²); the root's relative error is below 3/2 ulp.
        let [y, error] = arcsine(((1.0 - x) * (1.0 + x)).sqrt());
        return [QUARTER[0] - y, error + 1e-15];
    }
    let mut y = x;
    for _ in 0..6 {
        let [s, c] = sine_cosine(y);
        y += (x - s) / c;
    }
    let [s, c] = sine_cosine(y);
    // The mean value of the cosine between both is above half of c here.
    [y, 2.0 * ((x - s).abs() + 2.0 * TRIG) / c]
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::Ball;

    fn off(near: f64, exact: &Ball) -> f64 {
        let near = Ball::from_f64(near).unwrap();
        exact.sub(&near, 128).abs().to_f64_enclosure().1
    }

    #[test]
    fn functions_are_within_their_bounds() {
        for k in -4000..4000 {
            let x = f64::from(k) * 0.0371 + f64::from(k) * f64::from(k) * 1e-4;
            let ball = Ball::from_f64(x).unwrap();
            let [s, c] = sine_cosine(x);
            assert!(off(s, &ball.sin(128)) < TRIG && off(c, &ball.cos(128)) < TRIG, "{x}");
        }
        for k in 0..4000 {
            let x = f64::from(k) / 4001.0;
            let ball = Ball::from_f64(x).unwrap();
            let [y, error] = arcsine(x);
            assert!(off(y, &ball.asin(128).unwrap()) < error && error < 1e-13, "{x}");
        }
    }
}
