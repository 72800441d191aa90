//! A survey: its counts by the survey's own route again; the thin tongues, and a sample of all others, by
//! exact signs.

use super::again::{Recheck, asked};
use super::context::{Checked, Context, Outcome, Place, holds};
use super::exact::{ZeroOf, check_ratio, fraction, part};
use super::sample::sample;
use super::tongues::Tongue;
use super::written::Ends;
use crate::question::Survey;
use crate::report::tongues::record;
use clocks::resonance::dominant_family;
use clocks::tongue::{Entry, Request, Stiffness, Tongues, Wanted};
use clocks::verdict::Limits;
use num_traits::Zero;
use number::error::Result;
use number::{Ratio, Rational, rational};

const ROUTE: &str = "thin tongues, and a random sample of the others, by exact signs about both edges";

/// Ratios of which one tongue each is rechecked by exact signs.
const SAMPLE: u64 = 200;

rows! {
    /// `kickdrift/survey/1`.
    pub struct Claim {
        input: Survey,
        thinnest: Vec<Thin>,
    }

    struct Thin [p, q, m] {
        p: u64,
        q: u64,
        m: u64,
        a: i64,
        b: i64,
        s: f64,
        width: Ends,
    }
}

impl Recheck for Claim {
    const TABLE: &'static str = "thinnest";
    asked!(Survey);

    fn check(&self, _: Self::Found, context: &Context) -> Result<Outcome> {
        let (list, rho): (Vec<Ratio>, _) = (Ratio::up_to(self.input.max_sum).collect(), &self.input.rho);
        let holds = |row: &Thin| row.holds(rho, &context.limits());
        let mut outcome = context.outcome(ROUTE, ("", Ok(())), &self.thinnest, holds)?;
        // One tongue each of a sample of ratios, with all that the survey counts of it.
        let most = if context.options.all { list.len() as u64 } else { SAMPLE };
        let name = format!("{} {rho}", self.input.max_sum);
        let drawn: Vec<Ratio> =
            sample(&name, list.len() as u64, most).into_iter().map(|n| list[n as usize]).collect();
        let failures = context.rows(&drawn, |&ratio| exact_signs(ratio, rho, &context.limits()))?;
        outcome
            .failures
            .extend(failures.into_iter().map(|failure| super::context::Failure { row: 0, ..failure }));
        outcome.sample = Some((drawn.len() as u64, list.len() as u64));
        Ok(outcome)
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
    let wanted = Wanted { family: true, ..Wanted::default() };
    let request = Request { wanted, ..Request::default() };
    let row = record(&request, false).entries(&request.answer(&tongues, gap)?);
    let row: Tongue = serde_json::from_value(row).expect("a row as documents have it");
    row.holds(&Stiffness { rho: rho.clone(), lambda1: None, lambda2: None }, limits)
}
