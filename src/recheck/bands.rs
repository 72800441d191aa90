//! Boxes in which every ratio is unstable: pairs of steps in them, each decided by the ladder.

use super::again::{Recheck, asked};
use super::context::{Checked, Context, Fault, Outcome, Place, holds};
use super::sample::sample;
use super::written::{Ends, Written};
use crate::error::Result;
use crate::number::{Laurent, Rational, Real, rational};
use crate::propagator::Oscillator;
use crate::question::{Bands, Fields};
use crate::verdict::{Kind, decide_steps};

const ROUTE: &str = "nine pairs of steps in each box, worst placed, with ratios as simple as there are: all are hyperbolic by the ladder";

/// Boxes that the slower route takes unless it takes all.
const BOXES: u64 = 200;

/// Where in a box h1 is, and between which shares of the ratios that are left h2/h1 is the simplest one.
const PLACES: [i64; 3] = [1, 500, 999];

rows! {
    /// `kickdrift/bands/1`.
    pub struct Claim {
        input: Bands,
        certified: u64,
        share: Share,
        area: Area,
        boxes: Vec<Row>,
    }

    struct Share {
        value: Ends,
        exact: Written<Rational>,
    }

    struct Area {
        value: Ends,
        exact: Written<Laurent>,
    }

    struct Row {
        h1_lower: Written<Laurent>,
        h1_upper: Written<Laurent>,
        h2_lower: Written<Laurent>,
        h2_upper: Written<Laurent>,
        share: Written<Rational>,
    }
}

impl Place for Row {
    fn place(&self) -> String {
        let Row { h1_lower, h1_upper, h2_lower, h2_upper, .. } = self;
        format!("h1 = {}..{}, h2 = {}..{}", h1_lower.0, h1_upper.0, h2_lower.0, h2_upper.0)
    }
}

impl Recheck for Claim {
    const TABLE: &'static str = "boxes";
    asked!(Bands);

    fn check(&self, _: Self::Found, context: &Context) -> Result<Outcome> {
        let of = self.boxes.len() as u64;
        let texts = self.input.input();
        let text: String = texts.iter().filter_map(|(_, text)| text.as_str()).collect();
        let chosen = sample(&text, of, if context.options.all { of } else { BOXES });
        let rows: Vec<Row> = chosen.iter().map(|&n| self.boxes[n as usize].clone()).collect();
        let check = |row: &Row| self.holds(row, context);
        let outcome = context.outcome(ROUTE, ("the area", self.whole()), &rows, check)?;
        let sample = (chosen.len() as u64 != of).then_some((chosen.len() as u64, of));
        Ok(Outcome { rows: of, sample, ..outcome })
    }
}

impl Claim {
    fn whole(&self) -> Checked {
        holds(self.certified == self.boxes.len() as u64, || "its boxes are not as many as it says".into())?;
        let shares: Rational = self.boxes.iter().map(|row| row.share.0.clone()).sum();
        holds(shares == self.share.exact.0, || format!("its boxes are {shares} of the window"))?;
        let area = &self.input.window()?.area() * &Laurent::from_rational(shares.clone());
        holds(area == self.area.exact.0, || format!("its area is {area}"))?;
        let inside = |ends: &Ends, x: &Laurent| ends.holds(&x.enclosure(128));
        holds(inside(&self.area.value, &area), || "its area is outside its enclosure".into())?;
        holds(inside(&self.share.value, &Laurent::from_rational(shares)), || {
            "its share is outside its enclosure".into()
        })
    }

    fn holds(&self, row: &Row, context: &Context) -> Checked {
        let area = &(&row.h1_upper.0 - &row.h1_lower.0) * &(&row.h2_upper.0 - &row.h2_lower.0);
        let whole = self.input.window()?.area();
        holds(area == &whole * &Laurent::from_rational(row.share.0.clone()), || {
            "it has another share".into()
        })?;
        for place in PLACES {
            let along = Laurent::from_rational(rational::ratio(place, 1000));
            let h1 = &row.h1_lower.0 + &(&(&row.h1_upper.0 - &row.h1_lower.0) * &along);
            for ratio in ratios(&h1, &row.h2_lower.0, &row.h2_upper.0)? {
                let h2 = &h1 * &Laurent::from_rational(ratio.clone());
                let Bands { lambda1, lambda2, .. } = self.input.clone();
                let oscillator = Oscillator::new(lambda1, lambda2, h1.clone(), h2)?;
                let kind = decide_steps(&oscillator, &context.limits())?.verdict.kind();
                holds(kind == Kind::Hyperbolic, || format!("h1 = {h1}, h2/h1 = {ratio} is {}", kind.name()))?;
            }
        }
        Ok(())
    }
}

/// The simplest ratios with which h2 lies in a range: in all of it, and at either end.
fn ratios(h1: &Laurent, lower: &Laurent, upper: &Laurent) -> Checked<Vec<Rational>> {
    const BITS: u32 = 128;
    let over = |x: &Laurent| x.enclosure(BITS).div(&h1.enclosure(BITS), BITS);
    let Some((lo, hi)) = over(lower).zip(over(upper)) else {
        return Err(Fault::Wrong("its h1 is zero".into()));
    };
    let (lo, hi) = (lo.upper(), hi.lower());
    let part = (&hi - &lo) / Rational::from_integer(50.into());
    let all = [(lo.clone(), hi.clone()), (lo.clone(), &lo + &part), (&hi - &part, hi)];
    let simplest =
        all.iter().map(|(lo, hi)| rational::simplest(lo, hi)).filter(|ratio| *ratio > Rational::default());
    Ok(simplest.collect())
}
