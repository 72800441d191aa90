//! Tongues, edge by edge: exact signs of the half period at the ends of every enclosure, and the verdict inside.

use num_traits::{Signed, Zero};
use serde_json::Value;

use super::exact::{ZeroOf, check_ratio, fraction, ln_multiplier_at, meets, part, resonance, signs};
use super::listing::{complete, counts};
use super::read::{Checked, Fault, Row, holds, whole};
use super::{Context, Outcome};
use crate::error::Result;
use crate::number::{Laurent, Ratio, Rational, Sign, rational};
use crate::propagator::TwoClocks;
use crate::tongue::{Entry, Resonance, entries};
use crate::verdict::{Kind, Limits, decide, growth};

const ROUTE: &str = "the entries' exact signs at both ends of every enclosure, verdict and label inside, closed forms, \
                     growth, predicted points; that no tongue is left out";

/// What all rows share.
struct Given {
    rho: Rational,
    lambda1: Option<Laurent>,
    limits: Limits,
}

pub fn check(document: &Value, context: &Context) -> Result<Outcome> {
    let all = Row::new(document);
    let input = whole(all.object("input"))?;
    let given = Given {
        rho: whole(input.rational("rho"))?,
        lambda1: input.get("lambda1").map(|_| whole(input.quantity("lambda1"))).transpose()?,
        limits: context.limits,
    };
    let rows = whole(all.rows("tongues"))?;
    let mut outcome = context.rows(rows, ROUTE, |row| given.row(row))?;
    if let Some(failure) = complete(&input, rows, &given.rho)? {
        outcome.failures.insert(0, failure);
    }
    if let Some(failure) = counts(&all, rows)? {
        outcome.failures.push(failure);
    }
    Ok(outcome)
}

/// One edge of a row.
struct Edge<'a> {
    row: Row<'a>,
    name: &'static str,
    zero: ZeroOf<'a>,
}

impl Given {
    fn row(&self, row: &Row) -> Checked<()> {
        let (ratio, m) = (row.ratio()?, row.whole("m")?);
        check_ratio(ratio, &self.limits)?;
        holds(m > 0, || "labels begin at 1".into())?;
        let (a, b) = (i128::from(row.integer("a")?), i128::from(row.integer("b")?));
        holds(a * i128::from(ratio.p()) + b * i128::from(ratio.q()) == i128::from(m), || {
            "m is not a p + b q".into()
        })?;
        let lower = self.edge(row, "lower", (ratio, m))?;
        let upper = row.get("upper").map(|_| self.edge(row, "upper", (ratio, m))).transpose()?;
        match upper {
            None => {
                holds(!row.flag("closed")?, || "the last tongue is open".into())?;
                self.last(&lower, m)
            }
            Some(upper) => {
                holds(lower.zero.entry != upper.zero.entry, || "both edges are zeros of one entry".into())?;
                if row.flag("closed")? {
                    self.closed(row, &lower, &upper)?;
                } else {
                    self.open(row, &lower, &upper, m)?;
                }
                self.predicted(row, &lower, &upper, m)
            }
        }
    }

    fn edge<'a>(&'a self, row: &Row<'a>, name: &'static str, (ratio, m): (Ratio, u64)) -> Checked<Edge<'a>> {
        let edge = row.object(name)?;
        let letter = edge.text("entry")?;
        let pair = if m % 2 == 1 { [Entry::A, Entry::D] } else { [Entry::B, Entry::C] };
        let entry = pair.into_iter().find(|entry| entry.name() == letter);
        let entry =
            entry.ok_or_else(|| Fault::Wrong(format!("{name}: {letter} bounds no tongue m = {m}")))?;
        let ends = row.enclosure(name)?;
        let zero = ZeroOf::new((ratio, &self.rho), entry, ends, name)?;
        let edge = Edge { row: edge, name, zero };
        self.closed_form(&edge, m)?;
        self.written(&edge)?;
        self.steps(&edge)?;
        Ok(edge)
    }

    /// A rational edge is a zero, and a resonance lies in the enclosure.
    fn closed_form(&self, edge: &Edge, m: u64) -> Checked<()> {
        let Edge { row, name, zero } = edge;
        let ratio = zero.ratio;
        if row.get("exact").is_some() {
            let s = row.rational("exact")?;
            let inside = zero.lo <= s && s <= zero.hi;
            holds(inside, || format!("{name}: {s} lies outside its enclosure"))?;
            let vanishes = signs(ratio, &self.rho, &s).all()[zero.entry as usize] == Sign::Zero;
            holds(vanishes, || format!("{name}: {} does not vanish at {s}", zero.entry.name()))?;
        }
        if row.get("on").is_none() {
            return Ok(());
        }
        let on = row.text("on")?;
        const BITS: u32 = 128;
        let s = if on == Resonance::Fast.name() {
            resonance(ratio.p(), m, BITS)
        } else {
            holds(!self.rho.is_zero(), || format!("{name}: without slow kicks there is no {on}"))?;
            let back = Rational::from(ratio.inverse());
            let scale = &back * &back / &self.rho;
            resonance(ratio.q(), m, BITS).mul(&crate::number::Ball::from_rational(&scale, BITS), BITS)
        };
        let ends = (rational::to_f64(&zero.lo), rational::to_f64(&zero.hi));
        holds(meets(ends, &s), || format!("{name}: the resonance {on} lies outside its enclosure"))
    }

    /// The digits enclose the zero too.
    fn written(&self, edge: &Edge) -> Checked<()> {
        if edge.row.get("decimal").is_none() {
            return Ok(());
        }
        let decimal = edge.row.object("decimal")?;
        let ends = (decimal.rational("lo")?, decimal.rational("hi")?);
        let ZeroOf { ratio, rho, entry, .. } = edge.zero;
        ZeroOf::new((ratio, rho), entry, ends, edge.name).map(drop)
    }

    /// h² L over an enclosure of a step meets the enclosure of s.
    fn steps(&self, edge: &Edge) -> Checked<()> {
        let Some(lambda1) = self.lambda1.as_ref().filter(|_| edge.row.get("h1").is_some()) else {
            return Ok(());
        };
        for (key, back) in [("h1", fraction(1, 1)), ("h2", edge.zero.ratio.inverse().into())] {
            let step = edge.row.object(key)?;
            let decimal = step
                .get("decimal")
                .map(|ends| -> Checked<_> { Ok((ends.rational("lo")?, ends.rational("hi")?)) });
            let s = |h: Rational| {
                let h = h * &back;
                &Laurent::from_rational(&h * &h) * lambda1
            };
            let [from, upto] = [&edge.zero.lo, &edge.zero.hi].map(|s| Laurent::from_rational(s.clone()));
            for (lo, hi) in
                [Some(edge.row.enclosure(key)), decimal].into_iter().flatten().collect::<Checked<Vec<_>>>()?
            {
                let meets = !lo.is_negative() && s(lo) <= upto && from <= s(hi);
                holds(meets, || format!("{}: {key} is not the step of s", edge.name))?;
            }
        }
        Ok(())
    }

    /// Above the last tongue's edge all is unstable.
    fn last(&self, lower: &Edge, m: u64) -> Checked<()> {
        let ZeroOf { ratio, hi, .. } = &lower.zero;
        let end = if self.rho.is_zero() { ratio.p() } else { ratio.kicks() - 1 };
        holds(m == end, || format!("{ratio} has a tongue above m = {m}: it has an upper edge"))?;
        self.unstable(*ratio, m, &(hi * fraction(2, 1)))
    }

    fn unstable(&self, ratio: Ratio, m: u64, s: &Rational) -> Checked<()> {
        let verdict = signs(ratio, &self.rho, s).verdict();
        let side = if m.is_multiple_of(2) { 1 } else { -1 };
        let unstable = verdict.kind() == Kind::Hyperbolic && verdict.side() == side;
        holds(unstable, || format!("s = {s} inside it is {}, side {}", verdict.kind().name(), verdict.side()))
    }

    /// The edges part in the order given, and between them all is unstable with the label m.
    fn open(&self, row: &Row, lower: &Edge, upper: &Edge, m: u64) -> Checked<()> {
        let ratio = lower.zero.ratio;
        let (mut below, mut above) = (lower.zero.clone(), upper.zero.clone());
        let order = part(&mut below, &mut above);
        holds(order.is_some_and(std::cmp::Ordering::is_lt), || {
            "its edges do not part in their order".into()
        })?;
        let (inner, outer) = (&above.lo - &below.hi, &above.hi - &below.lo);
        let (least, most) = row.enclosure("width")?;
        holds(least <= outer && inner <= most, || "its width is not the distance of its edges".into())?;
        let middle = (&below.hi + &above.lo) / fraction(2, 1);
        self.unstable(ratio, m, &middle)?;
        if lower.zero.hi >= upper.zero.lo {
            return Ok(()); // thinner than doubles show
        }
        let clocks = TwoClocks::with_rho(ratio, middle, self.rho.clone());
        let verdict = decide(&clocks, &self.limits)?.verdict;
        let label = growth(&clocks, verdict, &self.limits)?.label;
        holds(label == Some(m), || format!("the growing solution turns {label:?} times"))?;
        self.growth(row, lower, upper)
    }

    /// The growth told is that of its place, and no hundredth of the tongue to either side has more.
    fn growth(&self, row: &Row, lower: &Edge, upper: &Edge) -> Checked<()> {
        let Some(told) = row.get("growth") else { return Ok(()) };
        let ratio = lower.zero.ratio;
        let (s, ln) = (told.float("s")?, told.float("ln_multiplier")?);
        let exact = rational::from_f64_exact(s).ok_or_else(|| Fault::Wrong("growth at no s".into()))?;
        let inside = lower.zero.lo <= exact && exact <= upper.zero.hi;
        holds(inside, || format!("its fastest growth is told outside of it, at s = {s}"))?;
        // Fifteen digits of the rates are told; where s is rounded to a double they are flat.
        let near = |x: f64, y: f64| (x - y).abs() <= 1e-9 * y.abs();
        let rate = |s: &Rational| {
            let ln = ln_multiplier_at(&TwoClocks::with_rho(ratio, s.clone(), self.rho.clone()));
            ln.map(|ln| (ln, ln / (ratio.p() as f64 * rational::to_f64(s).sqrt())))
        };
        // A place within an edge's rounding tells nothing.
        let Some((ln_here, here)) = rate(&exact) else { return Ok(()) };
        let width = rational::to_f64(&(&upper.zero.lo - &lower.zero.hi));
        if width < 1e-6 * s {
            return Ok(()); // rounding s to a double moves it visibly within the tongue
        }
        holds(near(ln, ln_here), || format!("ln of the multiplier at s = {s} is {ln_here}, not {ln}"))?;
        holds(near(told.float("rate")?, here), || format!("the rate at s = {s} is {here}"))?;
        let steps = std::f64::consts::LN_10 * ratio.q() as f64 / ln_here;
        holds(near(told.float("steps_until_tenfold")?, steps), || {
            format!("tenfold takes {steps} slow steps")
        })?;
        if let Some(lambda1) = &self.lambda1 {
            let rate = here * lambda1.to_f64().sqrt();
            holds(near(told.float("growth_rate")?, rate), || format!("the growth rate is {rate}"))?;
        }
        let hundredth = (&upper.zero.lo - &lower.zero.hi) * fraction(1, 100);
        let beside = [&exact - &hundredth, &exact + &hundredth];
        let faster = beside.iter().filter_map(rate).any(|(_, beside)| beside > here * (1.0 + 1e-9));
        holds(!faster, || format!("growth is faster beside s = {s}"))
    }

    /// Both entries vanish at one point.
    fn closed(&self, row: &Row, lower: &Edge, upper: &Edge) -> Checked<()> {
        let ratio = lower.zero.ratio;
        let (least, most) = row.enclosure("width")?;
        holds(least.is_zero() && most.is_zero(), || "a closed tongue is 0 wide".into())?;
        if self.rho.is_zero() {
            return Ok(()); // without slow kicks both are zeros of sin p theta, at p theta = m pi: checked above
        }
        if lower.row.get("exact").is_some() {
            let (a, b) = (lower.row.rational("exact")?, upper.row.rational("exact")?);
            return holds(a == b, || format!("its edges {a} and {b} differ"));
        }
        let polynomials = entries(ratio, &self.rho);
        let [f, g] = [&lower.zero, &upper.zero].map(|zero| &polynomials[zero.entry as usize]);
        let (lo, hi) = ((&lower.zero.lo).max(&upper.zero.lo), (&lower.zero.hi).min(&upper.zero.hi));
        let common = f.gcd(g);
        let shared = lo <= hi && common.degree() > Some(0) && common.count_roots(lo, hi) > 0;
        holds(shared, || "its edges have no zero in common".into())
    }

    /// The point p θ = m π lies where it is said to lie.
    fn predicted(&self, row: &Row, lower: &Edge, upper: &Edge, m: u64) -> Checked<()> {
        let Some(told) = row.get("predicted") else { return Ok(()) };
        let s = resonance(lower.zero.ratio.p(), m, 128);
        let (position, distance) = (told.text("position")?, told.float("distance")?);
        let side = match position {
            "inside" => "inside",
            "below" | "above" => "outside",
            _ => "on the edge",
        };
        holds(told.text("side")? == side, || format!("{position} is {}", told.text("side").unwrap_or("")))?;
        let (below, above) = (s.upper() < lower.zero.lo, s.lower() > upper.zero.hi);
        let inside = s.lower() > lower.zero.hi && s.upper() < upper.zero.lo;
        let wrong = (below && position != "below")
            || (above && position != "above")
            || (inside && position != "inside");
        holds(!wrong, || format!("p theta = m pi at s = {} is not {position}", s.mid_f64()))?;
        let sign = match side {
            "inside" => distance <= 0.0,
            "outside" => distance >= 0.0,
            _ => distance.is_zero(),
        };
        holds(sign, || format!("{distance} is no distance to a point {side}"))?;
        let (least, most) = s.to_f64_enclosure();
        holds((least.next_down()..=most.next_up()).contains(&told.float("s")?), || {
            format!("p theta = m pi is s = {}", s.mid_f64())
        })?;
        // How far the enclosures are apart at least and at most; told to a millionth, for both ends are rounded.
        let below = (&lower.zero.lo - s.upper(), &lower.zero.hi - s.lower());
        let above = (s.lower() - &upper.zero.hi, s.upper() - &upper.zero.lo);
        let (least, most) = match position {
            "below" => below,
            "above" => above,
            "inside" => {
                let nearer = |a: Rational, b: Rational| (-a).min(-b);
                (nearer(below.1, above.1), nearer(below.0, above.0))
            }
            _ => return Ok(()),
        };
        let [least, most] = [least, most].map(|x| rational::to_f64(&x));
        let truth = least * (1.0 - 1e-6)..=most * (1.0 + 1e-6);
        holds(truth.contains(&distance.abs()), || format!("the distance to its tongue is not {distance}"))
    }
}
