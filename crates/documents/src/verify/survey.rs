//! A survey: its counts by the survey's own route again; the thin tongues, and a sample of all others, by
//! exact signs.

use super::context::{Checked, Context, Failure, Outcome, holds, located};
use super::exact::{ZeroOf, check_ratio, fraction, part};
use super::kind::Verify;
use super::sample::sample;
use super::tongues::Row;
use crate::question::Survey;
use clocks::tongue::{self, Entry, Request, Stiffness, Thin, Tongues, Wanted};
use clocks::verdict::Limits;
use num_traits::Zero;
use number::{Ratio, Rational, Result, rational};

const ROUTE: &str = "thin tongues, and a random sample of the others, by exact signs about both edges";

/// Ratios of which one tongue each is rechecked by exact signs.
const SAMPLE: u64 = 200;

impl Verify for Survey {
    fn check(&self, survey: &tongue::Survey, context: &Context) -> Result<Outcome> {
        let (list, rho): (Vec<Ratio>, _) = (Ratio::up_to(self.max_sum).collect(), &self.rho);
        let is_thin = |thin: &Thin| is_thin(thin, rho, &context.limits());
        let mut outcome = context.outcome(ROUTE, Ok(()), &survey.thinnest, is_thin)?;
        // One tongue each of a sample of ratios, with all that the survey counts of it.
        let most = if context.options.all { list.len() as u64 } else { SAMPLE };
        let name = format!("{} {rho}", self.max_sum);
        let drawn = sample(&name, list.len() as u64, most).into_iter().map(|n| list[n as usize]);
        let drawn: Vec<Ratio> = drawn.collect();
        let is_exact = |&ratio: &Ratio| located(ratio, exact_signs(ratio, rho, &context.limits()));
        let failures = context.rows(&drawn, is_exact)?.into_iter();
        outcome.failures.extend(failures.map(|failure| Failure { row: 0, ..failure }));
        outcome.sample = Some((drawn.len() as u64, list.len() as u64));
        Ok(outcome)
    }
}

/// Both entries vanish just above s, as far apart as the width.
fn is_thin(thin: &Thin, rho: &Rational, limits: &Limits) -> Checked {
    let Thin { ratio, m, s, width, .. } = *thin;
    check_ratio(ratio.p(), ratio.q(), limits)?;
    let pair = Entry::of_tongue(m % 2 == 1);
    let exact = |x: f64| rational::from_f64_exact(x).unwrap_or_else(Rational::zero);
    let (least, most) = (exact(width.0), exact(width.1));
    // From a double below the lower edge, a few doubles and the width up.
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

/// The middle one of a ratio's tongues below s = 4 by exact signs.
fn exact_signs(ratio: Ratio, rho: &Rational, limits: &Limits) -> Checked {
    let tongues = Tongues::new(ratio, rho)?;
    let below = tongues.below(4.0)?;
    let Some(gap) = below.get(below.len() / 2).filter(|gap| gap.upper.is_some()) else { return Ok(()) };
    let wanted = Wanted { family: true, ..Wanted::default() };
    let request = Request { wanted, ..Request::default() };
    let tongue = request.answer(&tongues, gap)?;
    let given = Stiffness { rho: rho.clone(), lambda1: None, lambda2: None };
    Row { tongue: &tongue, given: &given, has_closed_forms: false, limits }.holds()
}
