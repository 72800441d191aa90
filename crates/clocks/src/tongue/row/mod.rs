//! The properties of a tongue, column by column; each is computed only where it is wanted.
//!
//! ```
//! use kickdrift_clocks::number::rational::ratio;
//! use kickdrift_clocks::tongue::{Side, Tongues, Wanted};
//! // 7/3, m = 4: the resonance p th = 4 pi lies outside its own tongue.
//! let tongues = Tongues::new("7/3".parse().unwrap(), &ratio(1, 25)).unwrap();
//! let gap = tongues.gap(4).unwrap();
//! let row = tongues.row(&gap, &Wanted::all()).unwrap();
//! assert_eq!((row.family, row.predicted.unwrap().side), (Some((1, -1)), Side::Above));
//! assert_eq!(tongues.effort().doubles, 2); // no other edge was computed
//! ```

mod exact;
mod predicted;

use num_traits::Zero;

use exact::exact_edge;
pub use exact::{ExactEdge, Resonance};
pub use predicted::{Predicted, Side};

use crate::resonance::{FirstOrder, dominant_family, first_order};
use crate::tongue::edge::{Edge, Tongues};
use crate::tongue::gap::Gap;
use crate::tongue::peak::Peak;
use number::{Ball, Ratio, Result};

/// The columns wanted beside p, q, m, the edges and the width.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// The dominant (a, b).
    pub family: bool,
    /// Which edges are known exactly.
    pub exact: bool,
    /// The largest growth rate inside.
    pub growth: bool,
    /// The point p θ = m π against the tongue.
    pub predicted: bool,
    /// The first-order law against the tongue.
    pub first_order: bool,
}

impl Wanted {
    /// Every column.
    pub fn all() -> Self {
        Wanted { family: true, exact: true, growth: true, predicted: true, first_order: true }
    }
}

/// The first-order law, the nearest doubles of it, and what it misses, enclosed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    pub centre: f64,
    pub width: f64,
    pub ln_multiplier: f64,
    /// Tongue minus law.
    pub centre_error: (f64, f64),
    pub width_error: (f64, f64),
    /// Tongue's width over the law's.
    pub width_ratio: (f64, f64),
}

/// A tongue and the columns asked for; `None` where not asked, or where there is none (said beside each).
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub ratio: Ratio,
    pub gap: Gap,
    /// (a, b), m = a p + b q, of the strongest family.
    pub family: Option<(i64, i64)>,
    /// The two edges, where recognized.
    pub exact: [Option<ExactEdge>; 2],
    /// Not for closed tongues, nor the infinite one.
    pub peak: Option<Peak>,
    /// Only for m < p: below the fast clock's Verlet limit.
    pub predicted: Option<Predicted>,
    /// Only for m < p, ρ > 0.
    pub first_order: Option<Law>,
}

impl Tongues {
    /// A tongue with the columns wanted.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn row(&self, gap: &Gap, wanted: &Wanted) -> Result<Row> {
        Ok(self.rows(std::slice::from_ref(gap), wanted)?.remove(0))
    }

    /// Tongues with the columns wanted: where growth is wanted, many cost a fraction of so many alone.
    ///
    /// # Errors
    /// Where the schedule is too long.
    pub fn rows(&self, gaps: &[Gap], wanted: &Wanted) -> Result<Vec<Row>> {
        let peaks = if wanted.growth { self.peaks(gaps)? } else { vec![None; gaps.len()] };
        gaps.iter().zip(peaks).map(|(gap, peak)| Row::new(self, gap, wanted, peak)).collect()
    }
}

impl Row {
    fn new(tongues: &Tongues, gap: &Gap, wanted: &Wanted, peak: Option<Peak>) -> Result<Row> {
        let (ratio, m) = (tongues.ratio(), gap.m);
        let family = wanted.family.then(|| dominant_family(ratio, m));
        let mut exact = [None, None];
        if wanted.exact {
            exact[0] = exact_edge(tongues, m, &gap.lower)?;
            exact[1] = gap.upper.as_ref().map_or(Ok(None), |upper| exact_edge(tongues, m, upper))?;
        }
        let predicted = if wanted.predicted { Predicted::new(tongues, gap)? } else { None };
        let first_order = if wanted.first_order { Law::new(tongues, gap) } else { None };
        Ok(Row { ratio, gap: gap.clone(), family, exact, peak, predicted, first_order })
    }
}

impl Law {
    fn new(tongues: &Tongues, gap: &Gap) -> Option<Law> {
        const BITS: u32 = 128;
        let rho = Some(tongues.rho()).filter(|rho| !rho.is_zero())?;
        let FirstOrder { centre, width, ln_multiplier } = first_order(tongues.ratio(), gap.m, rho)?;
        let of = |edge: &Edge| Ball::between(edge.lo, edge.hi, BITS);
        let middle = of(&gap.lower)?.add(&of(gap.upper.as_ref()?)?, BITS).scale2(-1);
        let found = Ball::between(gap.width.0, gap.width.1, BITS)?;
        Some(Law {
            centre_error: middle.sub(&centre, BITS).to_f64_enclosure(),
            width_error: found.sub(&width, BITS).to_f64_enclosure(),
            width_ratio: found.div(&width, BITS)?.to_f64_enclosure(),
            centre: centre.mid_f64(),
            width: width.mid_f64(),
            ln_multiplier: ln_multiplier.mid_f64(),
        })
    }
}
