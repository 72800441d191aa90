//! All curves of a range of families at once.
//!
//! ```
//! use kickdrift_clocks::number::Laurent;
//! use kickdrift_clocks::resonance::{Families, Window};
//! let families = Families { a: (0, 3), b: (-12, 12), samples: 100 };
//! let curves = families.curves(&Laurent::pi_power(2), &Window { h1: (0.0, 0.6), h2: (0.0, 3.5) })?;
//! assert!(curves.iter().any(|curve| (curve.a, curve.b) == (1, -1)));
//! # Ok::<(), kickdrift_clocks::number::error::Error>(())
//! ```

use super::curve::{Curve, MOST_POINTS, Window, curve};
use number::parallel::try_map;
use number::{Error, Laurent, Result};

/// Curves (a, b): closed ranges of a and b, and the number of samples of each in the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Families {
    pub a: (i64, i64),
    pub b: (i64, i64),
    pub samples: usize,
}

/// The most curves sampled at once: beyond it the range is a mistake.
const MOST_CURVES: i128 = 100_000;

impl Families {
    /// All curves that pass through the window, each as [`curve`] samples it; by a, then b.
    ///
    /// # Errors
    /// Too many curves or points, and as [`curve`].
    pub fn curves(&self, lambda1: &Laurent, window: &Window) -> Result<Vec<Curve>> {
        let count = |(lo, hi): (i64, i64)| (i128::from(hi) - i128::from(lo) + 1).max(0);
        let curves = count(self.a) * count(self.b);
        if curves > MOST_CURVES {
            let value = format!("{:?} by {:?}", self.a, self.b);
            let remedy = format!("at most {MOST_CURVES} curves: choose smaller ranges");
            return Err(Error::input("a, b", value, remedy));
        }
        if curves * self.samples as i128 > MOST_POINTS as i128 {
            let remedy =
                format!("{curves} curves of so many points are more than {MOST_POINTS}: choose fewer");
            return Err(Error::input("samples", self.samples, remedy));
        }
        let pairs: Vec<(i64, i64)> =
            (self.a.0..=self.a.1).flat_map(|a| (self.b.0..=self.b.1).map(move |b| (a, b))).collect();
        let curves = try_map(&pairs, |&(a, b)| curve(a, b, lambda1, window, self.samples))?;
        Ok(curves.into_iter().filter(|curve| !curve.pieces.is_empty()).collect())
    }
}
