//! Ring polymers: path integrals of P beads have modes of their own, faster than any bond.
//!
//! Between two kicks a free ring of P beads moves exactly, its normal modes with w_k = 2 (P k_B T/ħ) sin(k
//! π/P). A kick every h resonates with mode k near h = π/w_k, and with stiff forces from below that on
//! (docs/safe-step.md). The verdicts here are those of the centroid, k = 0, alone.

use num_traits::ToPrimitive;

use number::Rational;

/// ħ/k_B in fs K, rounded: 1.054571817e-34 J s over 1.380649e-23 J/K.
const HBAR_OVER_K: f64 = 7638.232577577645;

/// Ring polymers of so many beads.
#[derive(Clone, Debug, PartialEq)]
pub struct Beads {
    /// P.
    pub count: u64,
    /// In kelvin, where it is known.
    pub kelvin: Option<Rational>,
}

impl Beads {
    /// The period in fs of ring mode k, rounded; `None` of mode 0 and where the temperature is not known.
    ///
    /// ```
    /// use kickdrift_molecules::{Beads, number::rational::ratio};
    /// let beads = Beads { count: 32, kelvin: Some(ratio(300, 1)) };
    /// // Half of it is where a kick meets the fastest ring mode.
    /// assert_eq!(format!("{:.4}", beads.period(16).unwrap() / 2.0), "1.2498");
    /// assert_eq!(format!("{:.2}", beads.period(1).unwrap()), "25.50");
    /// ```
    pub fn period(&self, k: u64) -> Option<f64> {
        let kelvin = self.kelvin.as_ref()?.to_f64().filter(|value| *value > 0.0)?;
        let frequency = 2.0 * self.count as f64 * kelvin / HBAR_OVER_K;
        let turn = (k as f64 * std::f64::consts::PI / self.count as f64).sin();
        (turn > 0.0).then(|| 2.0 * std::f64::consts::PI / (frequency * turn))
    }

    /// The periods of the fastest ring mode and of the slowest one.
    pub fn ends(&self) -> Option<[f64; 2]> {
        Some([self.period(self.count / 2)?, self.period(1)?])
    }
}
