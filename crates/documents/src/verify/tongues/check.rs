//! A tongue and a document of tongues against the mathematics.

use serde_json::Value;

use super::edge::Zero;
use super::listing::last;
use super::rows::{Claim, Tongue};
use crate::question::{Question, Work};
use crate::verify::again::Recheck;
use crate::verify::context::{Checked, Context, Fault, Outcome, holds};
use crate::verify::exact::{check_ratio, fraction, part, signs};
use crate::verify::written::Ends;
use clocks::resonance::dominant_family;
use clocks::tongue::{Stiffness, Tongues, entries};
use clocks::verdict::{Kind, Limits, decide, growth};
use number::error::Result;
use number::{Ratio, Rational};

const ROUTE: &str = "the entries' exact signs at both ends of every enclosure, verdict and label inside, closed forms, \
                     growth, predicted points, the law of first order; that no tongue is left out";

impl Recheck for Claim {
    const TABLE: &'static str = "tongues";
    type Found = ();

    fn again(&self, context: &Context) -> Result<(Value, ())> {
        if let Some(longest) = self.input.ratios()?.list().iter().max_by_key(|ratio| ratio.kicks()) {
            check_ratio(longest.p(), longest.q(), &context.limits()).map_err(Fault::refused)?;
        }
        Ok((self.input.ask(&Work { watch: None, ..context.work() })?.value(), ()))
    }

    fn check(&self, (): (), context: &Context) -> Result<Outcome> {
        let (limits, given) = (context.limits(), self.input.stiffness()?);
        let whole = self.complete(&given.rho, &limits);
        context.outcome(ROUTE, ("the list", whole), &self.tongues, |row| row.holds(&given, &limits))
    }
}

impl Tongue {
    /// That all of the row holds.
    pub fn holds(&self, given: &Stiffness, limits: &Limits) -> Checked {
        let (p, m, rho) = (self.p, self.m, &given.rho);
        let ratio = check_ratio(p, self.q, limits)?;
        let last = last(ratio, rho);
        holds((1..=last).contains(&m), || format!("{ratio} has the tongues 1 to {last}"))?;
        self.family(ratio)?;
        let lower = self.lower.zero("lower", (ratio, m), given)?;
        let finite = self.upper.is_some();
        holds(finite == (m < last), || "the last tongue has no upper edge, and no other one".into())?;
        let (Some(upper), Some(width)) = (&self.upper, self.width) else {
            holds(!self.closed, || "the last tongue is open".into())?;
            return self.unstable(&lower, &(&lower.zero.hi * fraction(2, 1)));
        };
        let upper = upper.zero("upper", (ratio, m), given)?;
        let entries = (lower.zero.entry, upper.zero.entry);
        holds(entries.0 != entries.1, || "both edges are zeros of one entry".into())?;
        let order = lower.zero.lo <= upper.zero.hi;
        holds(order, || "its lower edge lies above its upper one".into())?;
        if self.closed {
            self.closed(&lower, &upper, width, given)?;
        } else {
            self.open(&lower, &upper, width, given, limits)?;
        }
        if let Some(predicted) = self.predicted.value() {
            predicted.holds(self.m, &lower, &upper)?;
        }
        self.first_order.value().map_or(Ok(()), |law| law.holds(self.m, &lower, &upper, width))
    }

    /// The dominant (a, b), m = a p + b q.
    fn family(&self, ratio: Ratio) -> Checked {
        let due = self.p.max(self.q).max(self.m) < 1 << 31;
        let truth = due.then(|| dominant_family(ratio, self.m));
        holds(self.a.zip(self.b) == truth && self.a.is_some() == due, || {
            format!("its dominant family is {truth:?}")
        })
    }

    fn unstable(&self, edge: &Zero, s: &Rational) -> Checked {
        let verdict = signs(edge.zero.ratio, edge.zero.rho, s).verdict();
        let side = if self.m.is_multiple_of(2) { 1 } else { -1 };
        let unstable = verdict.kind() == Kind::Hyperbolic && verdict.side() == side;
        holds(unstable, || format!("s = {s} inside it is {}, side {}", verdict.kind().name(), verdict.side()))
    }

    /// The edges part in the order given, and between them all is unstable with the label m.
    fn open(&self, lower: &Zero, upper: &Zero, width: Ends, given: &Stiffness, limits: &Limits) -> Checked {
        let (mut below, mut above) = (lower.zero.clone(), upper.zero.clone());
        let order = part(&mut below, &mut above);
        holds(order.is_some_and(std::cmp::Ordering::is_lt), || {
            "its edges do not part in their order".into()
        })?;
        let (inner, outer) = (&above.lo - &below.hi, &above.hi - &below.lo);
        let (least, most) = width.exact()?;
        holds(least <= outer && inner <= most, || "its width is not the distance of its edges".into())?;
        let positive = least > Rational::default() || inner <= fraction(1, 1) / fraction(2, 1).pow(1022);
        holds(positive, || "its width is not proven positive".into())?;
        let middle = (&below.hi + &above.lo) / fraction(2, 1);
        self.unstable(lower, &middle)?;
        let clocks = lower.zero.clocks(middle);
        let verdict = decide(&clocks, limits)?.verdict;
        let label = growth(&clocks, verdict, limits)?.label;
        holds(label == Some(self.m), || format!("the growing solution turns {label:?} times"))?;
        self.growth.value().map_or(Ok(()), |growth| growth.holds(self, given, (&below, &above)))
    }

    /// Both entries vanish at one point, and it is this tongue's.
    fn closed(&self, lower: &Zero, upper: &Zero, width: Ends, given: &Stiffness) -> Checked {
        holds((width.lo, width.hi) == (0.0, 0.0), || "a closed tongue is 0 wide".into())?;
        let (ratio, rho) = (lower.zero.ratio, &given.rho);
        if *rho == Rational::default() {
            return lower.on_resonance(self.m); // without slow kicks both are zeros of sin p theta
        }
        let gap = Tongues::new(ratio, rho)?.gap(self.m)?;
        let near = gap.lower.lo <= self.lower.hi && self.lower.lo <= gap.lower.hi;
        holds(near, || format!("the tongue m = {} lies elsewhere", self.m))?;
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
