//! The period at one friction, in balls: near an edge, and where velocities all but stop.

use std::collections::BTreeMap;

use faer::Mat;

use super::damping::Damping;
use super::powers::{Factors, of_rows};
use crate::linear::system::System;
use number::{Ball, Rational, Sign};

/// Products of balls: some 20 milliseconds.
const MAX_PRODUCTS: u64 = 200_000;

/// The columns of Q, and its determinant.
pub(super) struct Fixed {
    columns: Vec<Vec<Ball>>,
    det: Ball,
    bits: u32,
}

impl Fixed {
    /// `None` where that would cost too much.
    pub fn new(system: &System, rate: &Rational) -> Option<Fixed> {
        let (n, kicks) = (system.size(), system.schedule().strikes());
        if kicks.saturating_mul(2 * (n as u64).pow(3)) > MAX_PRODUCTS {
            return None;
        }
        // A kick may take some bits from what is known.
        let bits = 160 + 8 * kicks as u32;
        let factors = Factors::new(system, bits);
        let decay = rate * system.tick();
        let decayed = |ticks: u64| {
            Ball::from_rational(&(&decay * Rational::from_integer(ticks.into())), bits).neg().exp(bits)
        };
        let mut known = BTreeMap::new();
        let entry = |is_one: bool| vec![if is_one { Ball::one() } else { Ball::zero() }];
        let mut columns: Vec<Vec<_>> =
            (0..2 * n).map(|j| (0..2 * n).map(|i| entry(i == j)).collect()).collect();
        for event in system.schedule().symmetric_period() {
            let c = known.entry(event.drift).or_insert_with(|| decayed(event.drift));
            for column in &mut columns {
                factors.apply(&event, column, |own| vec![own[0].mul(c, bits)]);
            }
        }
        let columns = columns.into_iter().map(|own| own.into_iter().flatten().collect()).collect();
        Some(Fixed { columns, det: decayed(system.schedule().period()), bits })
    }

    /// With positions times these powers of two and momenta divided by them, rounded; and how far it is off
    /// (2-norm).
    pub fn rounded(&self, scales: &[f64]) -> (Mat<f64>, f64) {
        let scales = of_rows(scales);
        let (size, mut squares) = (scales.len(), 0.0);
        let q = Mat::from_fn(size, size, |i, j| {
            let (lo, hi) = self.columns[j][i].to_f64_enclosure();
            let scale = scales[i] / scales[j];
            squares += (scale * (hi - lo)).powi(2);
            scale * (lo + (hi - lo) / 2.0)
        });
        (q, 1.01 * f64::sqrt(squares) + size as f64 * f64::MIN_POSITIVE)
    }

    /// The trace of one oscillator.
    fn trace(&self) -> Option<Ball> {
        let [first, second] = &self.columns[..] else { return None };
        Some(first[0].add(&second[1], self.bits))
    }

    /// Where the spectral radius of one oscillator lies: |Tr| against 1 + det (Jury).
    pub fn damping(&self) -> Option<Damping> {
        let (trace, sum) = (self.trace()?, Ball::one().add(&self.det, self.bits));
        let signs = [sum.sub(&trace, self.bits), sum.add(&trace, self.bits)].map(|side| side.sign());
        if signs == [Some(Sign::Positive); 2] {
            return Some(Damping::Damped);
        }
        signs.contains(&Some(Sign::Negative)).then_some(Damping::Growing)
    }

    /// ln ρ of one oscillator, the larger |λ| of λ² − Tr λ + det: √det for a complex pair, else (|Tr| + √(Tr²
    /// − 4 det))/2.
    pub fn ln_radius(&self) -> Option<Ball> {
        let (trace, bits) = (self.trace()?, self.bits);
        let discriminant = trace.square(bits).sub(&self.det.scale2(2), bits);
        let root = self.det.sqrt_clipped(bits)?;
        let real =
            trace.abs().add(&discriminant.sqrt_clipped(bits).unwrap_or_else(Ball::zero), bits).scale2(-1);
        let radius = match discriminant.sign() {
            Some(Sign::Negative) => root,
            Some(Sign::Positive) => real,
            _ => real.union(&root, bits),
        };
        radius.ln(bits)
    }
}
