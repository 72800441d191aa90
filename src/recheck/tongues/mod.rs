//! Tongues, edge by edge: exact signs of the half period at the ends of every enclosure, and the verdict inside.
//!
//! | file | what it holds against the mathematics |
//! |---|---|
//! | `edge` | an edge: its zero, closed form, digits, steps |
//! | `columns` | what else a row says: growth, the predicted point, the law of first order |
//! | `listing` | the list: none left out, none counted twice |

mod columns;
mod edge;
mod listing;

use serde::Deserialize;

use super::exact::{check_ratio, fraction, part, signs};
use super::written::{Column, Ends, Range, Written, nullable};
use super::{Checked, Context, Fault, Outcome, Place, holds, same};
use crate::error::Result;
use crate::number::{Laurent, Ratio, Rational};
use crate::resonance::dominant_family;
use crate::tongue::{Tongues, entries};
use crate::verdict::{Kind, Limits, decide, growth};
use columns::{FirstOrder, Growth, Predicted};
pub(super) use edge::simplest;
use edge::{Edge, Zero};

const ROUTE: &str = "the entries' exact signs at both ends of every enclosure, verdict and label inside, closed forms, \
                     growth, predicted points, the law of first order; that no tongue is left out";

/// `kickdrift/tongues/1`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    #[serde(rename = "schema")]
    _schema: String,
    #[serde(rename = "kickdrift")]
    _written_by: Option<serde_json::Value>,
    input: Input,
    tongues: Vec<Tongue>,
    count: u64,
    open: u64,
    closed: u64,
    predicted_points: Option<Points>,
}

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Input {
    pub ratio: Option<Written<Ratio>>,
    pub max_sum: Option<Written<u64>>,
    #[serde(deserialize_with = "given_rho")]
    pub rho: Rational,
    pub lambda1: Option<Written<Laurent>>,
    pub lambda2: Option<Written<Laurent>>,
    pub h1_range: Option<Written<Range>>,
    pub h2_range: Option<Written<Range>>,
    pub m: Option<Written<Vec<(u64, u64)>>>,
    pub a: Option<Written<(i64, i64)>>,
    pub b: Option<Written<(i64, i64)>>,
    pub digits: Option<Written<u64>>,
}

fn given_rho<'de, D: serde::Deserializer<'de>>(deserializer: D) -> std::result::Result<Rational, D::Error> {
    Written::deserialize(deserializer).map(|rho| rho.0)
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Points {
    inside: u64,
    on_edge: u64,
    outside: u64,
}

/// A row.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Tongue {
    pub p: u64,
    pub q: u64,
    pub m: u64,
    #[serde(deserialize_with = "nullable")]
    pub a: Option<i64>,
    #[serde(deserialize_with = "nullable")]
    pub b: Option<i64>,
    pub lower: Edge,
    #[serde(deserialize_with = "nullable")]
    pub upper: Option<Edge>,
    pub closed: bool,
    #[serde(deserialize_with = "nullable")]
    pub width: Option<Ends>,
    #[serde(default)]
    pub growth: Column<Growth>,
    #[serde(default)]
    pub predicted: Column<Predicted>,
    #[serde(default)]
    pub first_order: Column<FirstOrder>,
}

impl Place for Tongue {
    fn place(&self) -> String {
        format!("p = {}, q = {}, m = {}", self.p, self.q, self.m)
    }
}

impl Claim {
    pub(super) fn check(&self, context: &Context) -> Result<Outcome> {
        let whole = self.complete(context.limits()).and_then(|()| self.counted());
        context.outcome(ROUTE, ("the list", whole), &self.tongues, |row| {
            row.holds(&self.input, context.limits())
        })
    }
}

impl Tongue {
    /// That all of the row holds.
    pub fn holds(&self, input: &Input, limits: &Limits) -> Checked {
        let (p, m, rho) = (self.p, self.m, &input.rho);
        let ratio = check_ratio(p, self.q, limits)?;
        let last = listing::last(ratio, rho);
        holds((1..=last).contains(&m), || format!("{ratio} has the tongues 1 to {last}"))?;
        self.family(ratio)?;
        let lower = self.lower.zero("lower", (ratio, m), input)?;
        let finite = self.upper.is_some();
        holds(finite == (m < last), || "the last tongue has no upper edge, and no other one".into())?;
        holds(finite == self.width.is_some(), || "it has a width where it has an upper edge".into())?;
        let open = finite && !self.closed;
        self.growth.due("growth", open)?;
        self.predicted.due("predicted point", finite && m < p)?;
        self.first_order.due("law of first order", finite && m < p && *rho != Rational::default())?;
        let (Some(upper), Some(width)) = (&self.upper, self.width) else {
            holds(!self.closed, || "the last tongue is open".into())?;
            return self.unstable(&lower, &(&lower.zero.hi * fraction(2, 1)));
        };
        let upper = upper.zero("upper", (ratio, m), input)?;
        let entries = (lower.zero.entry, upper.zero.entry);
        holds(entries.0 != entries.1, || "both edges are zeros of one entry".into())?;
        let order = lower.zero.lo <= upper.zero.hi;
        holds(order, || "its lower edge lies above its upper one".into())?;
        if self.closed {
            self.closed(&lower, &upper, width, input)?;
        } else {
            self.open(&lower, &upper, width, input, limits)?;
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
    fn open(&self, lower: &Zero, upper: &Zero, width: Ends, input: &Input, limits: &Limits) -> Checked {
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
        self.growth.value().map_or(Ok(()), |growth| growth.holds(self, input, (&below, &above)))
    }

    /// Both entries vanish at one point, and it is this tongue's.
    fn closed(&self, lower: &Zero, upper: &Zero, width: Ends, input: &Input) -> Checked {
        holds((width.lo, width.hi) == (0.0, 0.0), || "a closed tongue is 0 wide".into())?;
        let (ratio, rho) = (lower.zero.ratio, &input.rho);
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

impl Claim {
    /// The counts behind the rows are those of the rows, and all rows have the same columns.
    fn counted(&self) -> Checked {
        let rows = &self.tongues;
        let closed = rows.iter().filter(|row| row.closed).count() as u64;
        same("count", self.count, rows.len() as u64)?;
        same("closed", self.closed, closed)?;
        same("open", self.open, rows.len() as u64 - closed)?;
        let columns = |row: &Tongue| {
            let edges = row.upper.iter().chain([&row.lower]);
            let exact: Vec<bool> =
                edges.flat_map(|edge| [edge.exact.is_absent(), edge.on.is_absent()]).collect();
            let of_row = [row.growth.is_absent(), row.predicted.is_absent(), row.first_order.is_absent()];
            (of_row, exact[0], exact.iter().all(|&absent| absent == exact[0]))
        };
        for (i, row) in rows.iter().enumerate() {
            let uniform = columns(row) == columns(&rows[0]) && columns(row).2;
            holds(uniform, || format!("row {} has other columns than row 1", i + 1))?;
        }
        let side = |wanted: &str| {
            rows.iter().filter_map(|row| row.predicted.value()).filter(|p| p.side == wanted).count()
        };
        let [inside, on_edge, outside] = ["inside", "on the edge", "outside"].map(|name| side(name) as u64);
        let truth = Some(Points { inside, on_edge, outside }).filter(|_| inside + on_edge + outside > 0);
        holds(self.predicted_points == truth, || format!("predicted_points are {truth:?}"))
    }
}

impl From<&'static str> for Fault {
    fn from(why: &'static str) -> Fault {
        Fault::Wrong(why.into())
    }
}

impl Tongue {
    /// A tongue as it is computed, without further columns.
    pub fn bare(ratio: Ratio, gap: &crate::tongue::Gap) -> Tongue {
        let ((p, q), family) = (ratio.terms(), dominant_family(ratio, gap.m));
        let width = gap.upper.map(|_| Ends { lo: gap.width.0, hi: gap.width.1 });
        Tongue {
            p,
            q,
            m: gap.m,
            a: Some(family.0),
            b: Some(family.1),
            lower: Edge::bare(&gap.lower),
            upper: gap.upper.as_ref().map(Edge::bare),
            closed: gap.closed,
            width,
            growth: Column::Absent,
            predicted: Column::Absent,
            first_order: Column::Absent,
        }
    }
}

impl Input {
    /// The input of bare tongues.
    pub fn bare(rho: &Rational) -> Input {
        Input { rho: rho.clone(), ..Input::default() }
    }
}
