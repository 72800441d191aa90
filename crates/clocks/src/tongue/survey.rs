//! All ratios up to a sum: which tongues below the fast clock's Verlet limit are open, how thin they get, how
//! well the resonances predict them.
//!
//! ```
//! use kickdrift_clocks::number::rational::ratio;
//! use kickdrift_clocks::tongue::survey;
//! let survey = survey(12, &ratio(1, 25), 3).unwrap();
//! assert_eq!((survey.ratios, survey.closed.len()), (45, 0)); // 45 coprime p + q <= 12, every tongue open
//! assert!(survey.predicted_outside > 0); // a resonance need not lie in its own tongue
//! ```

use std::collections::BTreeMap;

use super::edge::Tongues;
use super::row::{Row, Side, Wanted};
use number::parallel::try_map;
use number::{Ratio, Rational, Result};

/// The tongues of all coprime p + q ≤ N at one ρ whose lower edge has s < 4, summed up.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    pub max_sum: u64,
    pub rho: Rational,
    pub ratios: u64,
    /// Tongues with lower edge s < 4, each certified open or closed.
    pub tongues: u64,
    pub open: u64,
    /// The ratio and m of the closed ones.
    pub closed: Vec<(Ratio, u64)>,
    /// Edges certified in doubles, and with more bits.
    pub edges: (u64, u64),
    /// The thinnest open ones, thinnest first.
    pub thinnest: Vec<Thin>,
    /// Tongues with a predicted point p θ = m π, m < p, and how many of those points lie outside their
    /// tongue, on an edge and inside.
    pub predicted: u64,
    pub predicted_outside: u64,
    pub predicted_on_edge: u64,
    pub predicted_inside: u64,
    /// Width over first-order width, by |a| of the dominant family.
    pub width_ratios: Vec<Spread>,
}

/// A thin tongue; its width is enclosed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thin {
    pub ratio: Ratio,
    pub m: u64,
    pub a: i64,
    pub b: i64,
    pub s: f64,
    pub width: (f64, f64),
}

/// The distribution of a ratio: how many, the least, quartiles, the largest; rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    pub abs_a: u64,
    pub count: u64,
    pub least: f64,
    pub lower_quartile: f64,
    pub median: f64,
    pub upper_quartile: f64,
    pub largest: f64,
}

/// The survey of all p + q ≤ `max_sum` at ρ > 0, with the `keep` thinnest tongues. The same whatever the
/// number of threads.
///
/// # Errors
/// As [`Tongues::new`].
pub fn survey(max_sum: u64, rho: &Rational, keep: usize) -> Result<Survey> {
    let wanted = Wanted { family: true, predicted: true, first_order: true, ..Wanted::default() };
    let one = |&ratio: &Ratio| -> Result<(Vec<Row>, (u64, u64))> {
        let tongues = Tongues::new(ratio, rho)?;
        let gaps = tongues.below(4)?;
        let rows = gaps.iter().map(|gap| tongues.row(gap, &wanted)).collect::<Result<_>>()?;
        let effort = tongues.effort();
        Ok((rows, (effort.doubles, effort.precise)))
    };
    let ratios: Vec<Ratio> = Ratio::up_to(max_sum).collect();
    let parts: Vec<_> = try_map(&ratios, one)?;
    let mut survey = Survey::empty(max_sum, rho, parts.len() as u64);
    let mut by_family: BTreeMap<u64, Vec<f64>> = BTreeMap::new();
    for (rows, (doubles, precise)) in &parts {
        survey.edges = (survey.edges.0 + doubles, survey.edges.1 + precise);
        for row in rows {
            survey.count(row);
            if let (Some((a, _)), Some(law)) = (row.family, row.first_order) {
                by_family
                    .entry(a.unsigned_abs())
                    .or_default()
                    .push(0.5 * (law.width_ratio.0 + law.width_ratio.1));
            }
        }
    }
    survey.thinnest.sort_by(|x, y| x.width.0.total_cmp(&y.width.0));
    survey.thinnest.truncate(keep);
    survey.width_ratios = by_family.into_iter().map(|(a, ratios)| Spread::new(a, ratios)).collect();
    Ok(survey)
}

impl Survey {
    fn empty(max_sum: u64, rho: &Rational, ratios: u64) -> Self {
        Survey {
            max_sum,
            rho: rho.clone(),
            ratios,
            tongues: 0,
            open: 0,
            closed: Vec::new(),
            edges: (0, 0),
            thinnest: Vec::new(),
            predicted: 0,
            predicted_outside: 0,
            predicted_on_edge: 0,
            predicted_inside: 0,
            width_ratios: Vec::new(),
        }
    }

    fn count(&mut self, row: &Row) {
        let (ratio, gap) = (row.ratio, &row.gap);
        self.tongues += 1;
        if gap.closed {
            self.closed.push((ratio, gap.m));
        } else {
            self.open += 1;
            if gap.upper.is_some() {
                let (a, b) = row.family.unwrap_or_default();
                self.thinnest.push(Thin { ratio, m: gap.m, a, b, s: gap.lower.lo, width: gap.width });
            }
        }
        if let Some(predicted) = row.predicted {
            self.predicted += 1;
            *match predicted.side {
                Side::Below | Side::Above => &mut self.predicted_outside,
                Side::OnLower | Side::OnUpper => &mut self.predicted_on_edge,
                Side::Inside => &mut self.predicted_inside,
            } += 1;
        }
    }
}

impl Spread {
    /// The distribution of `values`, not empty.
    fn new(abs_a: u64, mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let at = |quarter: usize| values[(values.len() - 1) * quarter / 4];
        Spread {
            abs_a,
            count: values.len() as u64,
            least: at(0),
            lower_quartile: at(1),
            median: at(2),
            upper_quartile: at(3),
            largest: at(4),
        }
    }
}
