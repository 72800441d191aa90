//! Sectors in which every ratio is unstable: pairs of steps in them, each decided by the ladder.

use num_traits::Zero;

use super::again::{Recheck, asked};
use super::context::{Checked, Context, Outcome, Place, holds};
use super::sample::sample;
use super::written::{Ends, Written};
use crate::question::{Bands, Fields};
use clocks::propagator::Oscillator;
use clocks::verdict::{Kind, decide};
use number::error::Result;
use number::{Ball, ExactSign, Laurent, Rational, Real, Sign, rational};

const ROUTE: &str = "nine pairs of steps in each sector, worst placed, with ratios as simple as there are: all are hyperbolic by the ladder, in the tongue named";

/// Sectors that the slower route takes unless it takes all.
const SECTORS: u64 = 200;

/// Where between both sides h1 is, in thousandths.
const PLACES: [i64; 3] = [1, 500, 999];

/// Bits of areas.
const BITS: u32 = 128;

rows! {
    /// `kickdrift/bands/1`.
    pub struct Claim {
        input: Bands,
        certified: u64,
        share: Ends,
        area: Ends,
        sectors: Vec<Row>,
    }

    struct Row {
        a: i64,
        b: i64,
        ratio_from: Written<Rational>,
        ratio_to: Written<Rational>,
        lower_from: Written<Rational>,
        lower_to: Written<Rational>,
        upper_from: Written<Rational>,
        upper_to: Written<Rational>,
    }
}

impl Place for Row {
    fn place(&self) -> String {
        format!("h2/h1 = {}..{}, a = {}, b = {}", self.ratio_from.0, self.ratio_to.0, self.a, self.b)
    }
}

impl Recheck for Claim {
    const TABLE: &'static str = "sectors";
    asked!(Bands);

    fn check(&self, _: Self::Found, context: &Context) -> Result<Outcome> {
        let of = self.sectors.len() as u64;
        let texts = self.input.input();
        let text: String = texts.iter().filter_map(|(_, text)| text.as_str()).collect();
        let chosen = sample(&text, of, if context.options.all { of } else { SECTORS });
        let rows: Vec<Row> = chosen.iter().map(|&n| self.sectors[n as usize].clone()).collect();
        let check = |row: &Row| self.holds(row, context);
        let outcome = context.outcome(ROUTE, ("the area", self.whole()), &rows, check)?;
        let sample = (chosen.len() as u64 != of).then_some((chosen.len() as u64, of));
        Ok(Outcome { rows: of, sample, ..outcome })
    }
}

impl Claim {
    fn whole(&self) -> Checked {
        holds(self.certified == self.sectors.len() as u64, || {
            "its sectors are not as many as it says".into()
        })?;
        let area = self.sectors.iter().fold(Ball::zero(), |sum, row| sum.add(&row.area(), BITS));
        holds(self.area.holds(&area), || "its area is outside its enclosure".into())?;
        let whole = self.input.window()?.area().enclosure(BITS);
        let share = area.div(&whole, BITS).expect("a window has an area");
        holds(self.share.holds(&share), || "its share is outside its enclosure".into())?;
        // Those of one curve do not overlap where the ratios of no two do.
        let mut ranges: Vec<_> =
            self.sectors.iter().map(|row| ([row.a, row.b], &row.ratio_from.0, &row.ratio_to.0)).collect();
        ranges.sort();
        let are_apart = ranges.windows(2).all(|pair| pair[0].0 != pair[1].0 || pair[0].2 <= pair[1].1);
        holds(are_apart, || "two of its sectors overlap".into())
    }

    fn holds(&self, row: &Row, context: &Context) -> Checked {
        let (from, to) = (&row.ratio_from.0, &row.ratio_to.0);
        holds(Rational::zero() < *from && from < to, || "its ratios are no range".into())?;
        let sides = [[&row.lower_from.0, &row.upper_from.0], [&row.lower_to.0, &row.upper_to.0]];
        let window = self.input.window()?;
        let is_inside = |step: usize, x: &Rational| {
            let (lo, hi) = window.range(step);
            let x = Laurent::from_rational(x.clone());
            (&x - lo).sign() != Sign::Negative && (hi - &x).sign() != Sign::Negative
        };
        for (ratio, [lower, upper]) in [from, to].into_iter().zip(sides) {
            holds(lower < upper, || "its sides cross".into())?;
            let all = [lower, upper].into_iter().all(|h1| is_inside(0, h1) && is_inside(1, &(h1 * ratio)));
            holds(all, || "it leaves the window".into())?;
        }
        let part = (to - from) / Rational::from_integer(50.into());
        for (lo, hi) in [(from.clone(), to.clone()), (from.clone(), from + &part), (to - &part, to.clone())] {
            let ratio = rational::simplest(&lo, &hi);
            let share = (&ratio - from) / (to - from);
            let [lower, upper] =
                [0, 1].map(|side| sides[0][side] + (sides[1][side] - sides[0][side]) * &share);
            for place in PLACES {
                let h1 = &lower + (&upper - &lower) * rational::ratio(place, 1000);
                let [first, second] = [h1.clone(), &h1 * &ratio].map(Laurent::from_rational);
                let Bands { lambda1, lambda2, .. } = self.input.clone();
                let clocks = Oscillator::new(lambda1, lambda2, first, second)?.clocks()?;
                let answer = decide(&clocks, &context.limits())?;
                let kind = answer.verdict.kind();
                holds(kind == Kind::Hyperbolic, || format!("h1 = {h1}, h2/h1 = {ratio} is {}", kind.name()))?;
                let turns = ratio.numer() * row.a + ratio.denom() * row.b;
                let label = answer.label()?;
                holds(label.is_some_and(|m| turns == m.into()), || {
                    format!("h1 = {h1}, h2/h1 = {ratio} is in another tongue")
                })?;
            }
        }
        Ok(())
    }
}

impl Row {
    /// The integral of (upper² − lower²)/2 over the ratio.
    fn area(&self) -> Ball {
        let of = |a: &Rational, b: &Rational| a * a + a * b + b * b;
        let squares = of(&self.upper_from.0, &self.upper_to.0) - of(&self.lower_from.0, &self.lower_to.0);
        let width = (&self.ratio_to.0 - &self.ratio_from.0) / Rational::from_integer(6.into());
        Ball::from_rational(&(squares * width), BITS)
    }
}
