//! A tongue and a document of tongues against the mathematics.

use super::columns;
use super::edge::{Claimed, Zero};
use super::listing::{complete, last};
use crate::question::{FoundTongues, Tongues as Question};
use crate::verify::context::{Checked, Context, Outcome, holds};
use crate::verify::exact::{between, check_ratio, fraction, part, signs};
use crate::verify::kind::Verify;
use clocks::resonance::dominant_family;
use clocks::tongue::{Stiffness, Tongue, Tongues, entries};
use clocks::verdict::{Kind, Limits, decide, growth};
use number::{Ratio, Rational, Result};

const ROUTE: &str = "the entries' exact signs at both ends of every enclosure, verdict and label inside, closed forms, \
                     growth, predicted points, the law of first order; that no tongue is left out";

impl Verify for Question {
    fn check(&self, found: &FoundTongues, context: &Context) -> Result<Outcome> {
        let (limits, given) = (context.limits(), self.stiffness()?);
        let whole = complete(self, &found.tongues, &given.rho, &limits);
        let has_closed_forms = found.request.wanted.exact;
        context.outcome(ROUTE, whole, &found.tongues, |tongue| {
            Row { tongue, given: &given, has_closed_forms, limits: &limits }.holds()
        })
    }
}

/// A tongue that is held against the mathematics.
pub struct Row<'a> {
    pub tongue: &'a Tongue,
    pub given: &'a Stiffness,
    /// Whether closed forms and resonances were asked for.
    pub has_closed_forms: bool,
    pub limits: &'a Limits,
}

impl Row<'_> {
    /// That all of the row holds.
    pub fn holds(&self) -> Checked {
        let (row, gap, given) = (&self.tongue.row, &self.tongue.row.gap, self.given);
        let ratio = check_ratio(row.ratio.p(), row.ratio.q(), self.limits)?;
        let (m, last) = (gap.m, last(ratio, &given.rho));
        holds((1..=last).contains(&m), || format!("{ratio} has the tongues 1 to {last}"))?;
        self.family(ratio)?;
        let claimed = |edge, name| Claimed { edge, name, has_closed_forms: self.has_closed_forms };
        let lower = claimed(&self.tongue.lower, "lower").zero((ratio, m), given)?;
        let is_finite = self.tongue.upper.is_some();
        holds(is_finite == (m < last), || "the last tongue has no upper edge, and no other one".into())?;
        let Some(upper) = &self.tongue.upper else {
            holds(!gap.closed, || "the last tongue is open".into())?;
            return self.unstable(&lower, &(&lower.zero.hi * fraction(2, 1)));
        };
        let upper = claimed(upper, "upper").zero((ratio, m), given)?;
        let entries = (lower.zero.entry, upper.zero.entry);
        holds(entries.0 != entries.1, || "both edges are zeros of one entry".into())?;
        let order = lower.zero.lo <= upper.zero.hi;
        holds(order, || "its lower edge lies above its upper one".into())?;
        if gap.closed {
            self.closed(&lower, &upper)?;
        } else {
            self.open(&lower, &upper)?;
        }
        if let Some(point) = &row.predicted {
            columns::predicted(point, m, &lower, &upper)?;
        }
        let law = row.first_order.as_ref();
        law.map_or(Ok(()), |law| columns::first_order(law, m, &lower, &upper, gap.width))
    }

    /// The dominant (a, b), m = a p + b q.
    fn family(&self, ratio: Ratio) -> Checked {
        let (m, found) = (self.tongue.row.gap.m, self.tongue.row.family);
        let truth = (ratio.p().max(ratio.q()).max(m) < 1 << 31).then(|| dominant_family(ratio, m));
        holds(found == truth, || format!("its dominant family is {truth:?}"))
    }

    fn unstable(&self, edge: &Zero, s: &Rational) -> Checked {
        let verdict = signs(edge.zero.ratio, edge.zero.rho, s).verdict();
        let side = if self.tongue.row.gap.m.is_multiple_of(2) { 1 } else { -1 };
        let unstable = verdict.kind() == Kind::Hyperbolic && verdict.side() == side;
        holds(unstable, || format!("s = {s} inside it is {}, side {}", verdict.kind().name(), verdict.side()))
    }

    /// The edges part in the order given, and between them all is unstable with the label m.
    fn open(&self, lower: &Zero, upper: &Zero) -> Checked {
        let (row, limits) = (&self.tongue.row, self.limits);
        let (mut below, mut above) = (lower.zero.clone(), upper.zero.clone());
        let order = part(&mut below, &mut above);
        holds(order.is_some_and(std::cmp::Ordering::is_lt), || {
            "its edges do not part in their order".into()
        })?;
        let (inner, outer) = (&above.lo - &below.hi, &above.hi - &below.lo);
        let (least, most) = between(row.gap.width.0, row.gap.width.1)?;
        holds(least <= outer && inner <= most, || "its width is not the distance of its edges".into())?;
        let positive = least > Rational::default() || inner <= fraction(1, 1) / fraction(2, 1).pow(1022);
        holds(positive, || "its width is not proven positive".into())?;
        let middle = (&below.hi + &above.lo) / fraction(2, 1);
        self.unstable(lower, &middle)?;
        let clocks = lower.zero.clocks(middle);
        let verdict = decide(&clocks, limits)?.verdict;
        let label = growth(&clocks, verdict, limits)?.label;
        holds(label == Some(row.gap.m), || format!("the growing solution turns {label:?} times"))?;
        let peak = row.peak.as_ref();
        peak.map_or(Ok(()), |peak| columns::growth(peak, self.tongue, self.given, (&below, &above)))
    }

    /// Both entries vanish at one point, and it is this tongue's.
    fn closed(&self, lower: &Zero, upper: &Zero) -> Checked {
        let (claimed, rho) = (&self.tongue.row.gap, &self.given.rho);
        holds(claimed.width == (0.0, 0.0), || "a closed tongue is 0 wide".into())?;
        let ratio = lower.zero.ratio;
        if *rho == Rational::default() {
            return lower.on_resonance(claimed.m); // without slow kicks both are zeros of sin p theta
        }
        let gap = Tongues::new(ratio, rho)?.gap(claimed.m)?;
        let near = gap.lower.lo <= self.tongue.lower.s.hi && self.tongue.lower.s.lo <= gap.lower.hi;
        holds(near, || format!("the tongue m = {} lies elsewhere", claimed.m))?;
        if let (Some(a), Some(b)) = (&lower.exact, &upper.exact) {
            return holds(a == b, || format!("its edges {a} and {b} differ"));
        }
        let polynomials = entries(ratio, rho);
        let [f, g] = [lower, upper].map(|edge| &polynomials[edge.zero.entry as usize]);
        let (lo, hi) = ((&lower.zero.lo).max(&upper.zero.lo), (&lower.zero.hi).min(&upper.zero.hi));
        let common = f.gcd(g);
        let shared = lo <= hi && common.degree() > Some(0) && common.count_roots(lo, hi) > 0;
        holds(shared, || "its edges have no zero in common".into())
    }
}
