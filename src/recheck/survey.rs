//! A survey: its counts by the survey's own route again; the thin tongues, and a sample of all others, by exact signs.

use num_traits::Zero;
use serde::de::IgnoredAny;

use super::context::{Checked, Context, Fault, Outcome, Place, holds, same};
use super::exact::{ZeroOf, check_ratio, fraction, part};
use super::sample::sample;
use super::tongues::{Input as Question, Tongue};
use super::written::{Ends, Written, ratios};
use crate::error::{Error, Result};
use crate::number::{Ratio, Rational, rational};
use crate::resonance::dominant_family;
use crate::tongue::{Entry, Spread, Survey, Tongues, survey};
use crate::verdict::Limits;

const ROUTE: &str = "thin tongues, and a random sample of the others, by exact signs about both edges; the counts by the \
                     survey's own certified route again";

/// Ratios of which one tongue each is rechecked by exact signs.
const SAMPLE: u64 = 200;

rows! {
    /// `kickdrift/survey/1`.
    pub struct Claim {
        input: Input,
        ratios: u64,
        tongues: u64,
        open: u64,
        closed: Vec<Label>,
        #[serde(rename = "edges")]
        _edges: IgnoredAny,
        predicted: Predicted,
        width_ratios: Vec<Widths>,
        thinnest: Vec<Thin>,
    }

    struct Input {
        max_sum: Written<u64>,
        rho: Written<Rational>,
    }

    struct Label {
        p: u64,
        q: u64,
        m: u64,
    }

    struct Predicted {
        points: u64,
        outside: u64,
        on_edge: u64,
        inside: u64,
    }

    struct Widths {
        abs_a: u64,
        count: u64,
        least: f64,
        lower_quartile: f64,
        median: f64,
        upper_quartile: f64,
        largest: f64,
    }

    struct Thin {
        p: u64,
        q: u64,
        m: u64,
        a: i64,
        b: i64,
        s: f64,
        width: Ends,
    }
}

impl Place for Thin {
    fn place(&self) -> String {
        format!("p = {}, q = {}, m = {}", self.p, self.q, self.m)
    }
}

impl Claim {
    pub fn check(&self, context: &Context) -> Result<Outcome> {
        let rho = &self.input.rho.0;
        let list = ratios(None, Some(&self.input.max_sum)).map_err(|fault| match fault {
            Fault::Wrong(why) => Error::input("max_sum", self.input.max_sum.0, why),
            Fault::Error(error) => error,
        })?;
        let whole = survey(*self.input.max_sum, rho, self.thinnest.len()).map_err(Fault::Error);
        let whole = whole.and_then(|survey| self.holds(&survey));
        let mut outcome = context
            .outcome(ROUTE, ("the counts", whole), &self.thinnest, |row| row.holds(rho, context.limits()))?;
        // One tongue each of a sample of ratios, with all that the survey counts of it.
        let most = if context.options.all { list.len() as u64 } else { SAMPLE };
        let name = format!("{} {rho}", self.input.max_sum.0);
        let drawn: Vec<Ratio> =
            sample(&name, list.len() as u64, most).into_iter().map(|n| list[n as usize]).collect();
        let failures = context.rows(&drawn, |&ratio| exact_signs(ratio, rho, context.limits()))?;
        outcome
            .failures
            .extend(failures.into_iter().map(|failure| super::context::Failure { row: 0, ..failure }));
        outcome.sample = Some((drawn.len() as u64, list.len() as u64));
        outcome.not_rechecked.push("edges: how many needed more bits depends on the version of the program");
        Ok(outcome)
    }

    fn holds(&self, survey: &Survey) -> Checked {
        same("ratios", self.ratios, survey.ratios)?;
        same("tongues", self.tongues, survey.tongues)?;
        same("open", self.open, survey.open)?;
        let closed = self.closed.iter().map(|label| ((label.p, label.q), label.m));
        holds(closed.eq(survey.closed.iter().map(|(ratio, m)| (ratio.terms(), *m))), || {
            format!("the closed tongues are {:?}", survey.closed)
        })?;
        let Predicted { points, outside, on_edge, inside } = self.predicted;
        same("the predicted points", points, survey.predicted)?;
        same("those outside", outside, survey.predicted_outside)?;
        same("those on an edge", on_edge, survey.predicted_on_edge)?;
        same("those inside", inside, survey.predicted_inside)?;
        let rows = survey.width_ratios.len() == self.width_ratios.len();
        let spreads = || survey.width_ratios.iter().zip(&self.width_ratios);
        let wrong = spreads().find(|(truth, told)| !told.holds(truth)).map(|(truth, _)| truth.abs_a);
        holds(rows && wrong.is_none(), || {
            format!("the quotients of widths at |a| = {wrong:?} are not these")
        })?;
        for (i, (told, truth)) in self.thinnest.iter().zip(&survey.thinnest).enumerate() {
            let ties = told.width.lo <= truth.width.1 && truth.width.0 <= told.width.hi;
            holds(ties, || {
                format!("row {}: the next thin tongue is {}, m = {}", i + 1, truth.ratio, truth.m)
            })?;
        }
        let label = |thin: &Thin| (thin.p, thin.q, thin.m);
        let twice = (1..self.thinnest.len())
            .any(|i| self.thinnest[..i].iter().any(|t| label(t) == label(&self.thinnest[i])));
        holds(!twice, || "a thin tongue stands there twice".into())?;
        same("the number of thin tongues", self.thinnest.len(), survey.thinnest.len())
    }
}

impl Widths {
    fn holds(&self, truth: &Spread) -> bool {
        let told = [self.least, self.lower_quartile, self.median, self.upper_quartile, self.largest];
        let truths = [truth.least, truth.lower_quartile, truth.median, truth.upper_quartile, truth.largest];
        // Widths are sure to a thousandth.
        let near = told.iter().zip(truths).all(|(x, y)| (x - y).abs() <= 1e-3 * y.abs());
        (self.abs_a, self.count) == (truth.abs_a, truth.count) && near
    }
}

impl Thin {
    /// Both entries vanish just above s, as far apart as written.
    fn holds(&self, rho: &Rational, limits: &Limits) -> Checked {
        let (p, q, m, s) = (self.p, self.q, self.m, self.s);
        let ratio = check_ratio(p, q, limits)?;
        holds(p.max(q).max(m) < 1 << 31 && m > 0 && m < p + q - 1, || "is no finite tongue".into())?;
        let family = dominant_family(ratio, m);
        holds((self.a, self.b) == family, || format!("its dominant family is {family:?}"))?;
        let pair = Entry::of_tongue(m % 2 == 1);
        let (least, most) = self.width.exact()?;
        // From a double below the lower edge, a few doubles and the width up.
        let exact = |s: f64| rational::from_f64_exact(s).unwrap_or_else(Rational::zero);
        holds(s > 0.0 && s < 4.0, || "it begins at 0 < s < 4".into())?;
        let reach = (exact(s), exact(s * (1.0 + 4.0 * f64::EPSILON)) + &most);
        let zero = |entry| ZeroOf::new((ratio, rho), entry, reach.clone(), "s");
        let (mut a, mut b) = (zero(pair[0])?, zero(pair[1])?);
        holds(part(&mut a, &mut b).is_some(), || "its edges do not part".into())?;
        // Halved until the distance is known to a thousandth, as the width is.
        let apart = |a: &ZeroOf, b: &ZeroOf| {
            if a.hi < b.lo { (&b.lo - &a.hi, &b.hi - &a.lo) } else { (&a.lo - &b.hi, &a.hi - &b.lo) }
        };
        let (inner, outer) = loop {
            let (inner, outer) = apart(&a, &b);
            let exact = a.lo == a.hi && b.lo == b.hi;
            if exact || outer <= &inner * fraction(1001, 1000) {
                break (inner, outer);
            }
            a.halve();
            b.halve();
        };
        holds(least <= outer && inner <= most, || "its width is not the distance of its edges".into())
    }
}

impl Place for Ratio {
    fn place(&self) -> String {
        format!("p = {}, q = {}", self.p(), self.q())
    }
}

/// The middle one of a ratio's tongues below s = 4 by exact signs.
fn exact_signs(ratio: Ratio, rho: &Rational, limits: &Limits) -> Checked {
    let tongues = Tongues::new(ratio, rho)?;
    let below = tongues.below(4.0)?;
    let Some(gap) = below.get(below.len() / 2).filter(|gap| gap.upper.is_some()) else { return Ok(()) };
    Tongue::bare(ratio, gap).holds(&Question::bare(rho), limits)
}
