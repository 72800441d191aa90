//! Counts and extremes of many tongues.

use super::rows::side;
use crate::report::decimal::{self, few};
use crate::report::record::Record;
use crate::report::shape::{COUNT, Shape};
use crate::report::text::counted;
use clocks::tongue::Tongue;

/// Counts and extremes, in the order in which the tongues come.
#[derive(Clone, Debug, Default)]
pub struct TongueTally {
    pub count: u64,
    pub closed: u64,
    /// Inside, on the edge, outside: predicted points.
    predicted: [u64; 3],
    thinnest: Option<Tongue>,
    fastest: Option<Tongue>,
    /// The least and the largest width over first-order width.
    ratios: Option<(f64, f64)>,
}

impl TongueTally {
    /// Counts a tongue in.
    pub fn add(&mut self, tongue: &Tongue) {
        let row = &tongue.row;
        self.count += 1;
        self.closed += u64::from(row.gap.closed);
        if let Some(predicted) = &row.predicted {
            let place = ["inside", "on the edge", "outside"].iter().position(|&s| s == side(predicted.side));
            self.predicted[place.expect("one of three")] += 1;
        }
        let thinner = |other: &Tongue| row.gap.width.0 < other.row.gap.width.0;
        if !row.gap.closed && row.gap.upper.is_some() && self.thinnest.as_ref().is_none_or(thinner) {
            self.thinnest = Some(tongue.clone());
        }
        let rate = |tongue: &Tongue| tongue.row.peak.as_ref().map(|peak| peak.rate);
        if rate(tongue) > self.fastest.as_ref().and_then(rate) {
            self.fastest = Some(tongue.clone());
        }
        if let Some(law) = &row.first_order {
            let (least, largest) = self.ratios.unwrap_or((f64::INFINITY, 0.0));
            self.ratios = Some((least.min(law.width_ratio.0), largest.max(law.width_ratio.1)));
        }
    }

    /// The record of the entries behind the rows in JSON.
    pub fn record() -> Record<'static, TongueTally> {
        Record::new()
            .json("count", |tally: &TongueTally| tally.count.into())
            .says(COUNT, "The rows above.")
            .json("open", |tally| (tally.count - tally.closed).into())
            .says(COUNT, "Tongues whose two edges are proven different.")
            .json("closed", |tally| tally.closed.into())
            .says(COUNT, "Tongues whose two edges are proven equal: Q = I or -I there.")
            .optional("predicted_points", |tally| {
                (tally.predicted != [0; 3]).then(|| places().entries(&tally.predicted))
            })
            .says(
                Shape::Object(|| places().keys()),
                "The points p theta = m pi among the rows, by where they lie.",
            )
    }

    /// For people; `what` says of which ratios the tongues are.
    pub fn lines(&self, what: &str) -> Vec<String> {
        let open = self.count - self.closed;
        let plural = if self.count == 1 { "" } else { "s" };
        let mut lines =
            vec![format!("{} tongue{plural} of {what}: {open} open, {} closed", self.count, self.closed)];
        if let Some(tongue) = &self.thinnest {
            let (lo, hi) = tongue.row.gap.width;
            lines.push(format!("  thinnest     {} wide: {}", decimal::enclosure(lo, hi), place(tongue)));
        }
        if let Some((tongue, peak)) =
            self.fastest.as_ref().and_then(|tongue| Some((tongue, tongue.row.peak?)))
        {
            let (rate, unit) =
                tongue.growth_rate.map_or((peak.rate, "√lambda1"), |rate| (rate, "per unit time"));
            let (rate, steps) = (few(rate, 4), few(peak.slow_steps_to_tenfold, 3));
            lines.push(format!(
                "  fastest      {rate} {unit}, tenfold in {steps} slow steps: {} at s = {}",
                place(tongue),
                few(peak.s, 6)
            ));
        }
        if self.predicted != [0; 3] {
            let [inside, on_edge, outside] = self.predicted;
            lines.push(format!(
                "  predicted    {} p theta = m pi: {outside} outside their own tongue, {on_edge} on its edge, {inside} inside",
                counted((inside + on_edge + outside) as usize, "point", "points")
            ));
        }
        if let Some((least, largest)) = self.ratios {
            let [least, largest] = [least, largest].map(|x| few(x, 4));
            lines.push(format!(
                "  first order  widths are {least} to {largest} times those that first-order theory gives"
            ));
        }
        lines
    }
}

fn places() -> Record<'static, [u64; 3]> {
    let places = ["inside", "on_edge", "outside"].into_iter().enumerate();
    places.fold(Record::new(), |record, (n, place)| {
        record.json(place, move |counts: &[u64; 3]| counts[n].into()).says(COUNT, "")
    })
}

fn place(tongue: &Tongue) -> String {
    format!("{}, m = {}", tongue.row.ratio, tongue.row.gap.m)
}
