//! Advice on periods: modes, schemes and pairs, and what is proven of the band.

use num_traits::One;

use super::mass::{BITS, Mass, exact};
use crate::verify::aperture::Plain;
use crate::verify::context::{Checked, Context, Outcome, holds, located, same};
use crate::verify::exact::encloses;
use molecules::aperture::Cold;
use molecules::{Advice, Answer, Mode, Pair, Row, Scheme, Status};
use number::{Ball, Rational, Real, Result, Sign, to_f64};

const ROUTE: &str =
    "the full period, kick by kick, in balls of 512 bits; the first region by the pivots of its action";

pub fn check(advice: &Advice, context: &Context) -> Result<Outcome> {
    let periods = Periods { advice };
    let rows: Vec<(&Answer, &Row)> =
        advice.schemes.iter().flat_map(|answer| answer.rows.iter().map(move |row| (answer, row))).collect();
    context.outcome(ROUTE, periods.whole(), &rows, |(answer, row)| periods.row(answer, row))
}

/// Advice, its modes as masses on clocks.
pub struct Periods<'a> {
    pub advice: &'a Advice,
}

impl Periods<'_> {
    fn whole(&self) -> Checked {
        self.advice.modes.iter().try_for_each(|mode| located(&mode.name, has_parts(mode)))?;
        for (number, answer) in (1..).zip(&self.advice.schemes) {
            located(format!("scheme {number}"), self.scheme(answer))?;
            answer.pairs.iter().try_for_each(|pair| self.pair(pair, &answer.scheme))?;
        }
        self.advice.cold.iter().try_for_each(|cold| located(&cold.name, self.cold(cold)))?;
        let levers = self.advice.levers.iter().flat_map(|levers| &levers.rows);
        levers.into_iter().try_for_each(|lever| located(&lever.name, self.lever(lever)))
    }

    /// The stiffest mode on each clock, or this one on its own.
    pub fn mass(&self, scheme: &Scheme, mode: Option<&Mode>) -> Mass {
        stiffest(&self.advice.modes, scheme.steps(), mode)
    }

    /// The stiffest modes with the shortest periods of the band.
    pub fn corner(&self, scheme: &Scheme) -> Mass {
        let mut mass = self.mass(scheme, None);
        let square = Ball::from_rational(&self.shorter(), BITS).square(BITS);
        for stiffness in &mut mass.stiffness {
            *stiffness = stiffness.div(&square, BITS).unwrap_or_else(|| stiffness.clone());
        }
        mass
    }

    /// The shortest periods of the band over those given.
    pub fn shorter(&self) -> Rational {
        Rational::one() - &self.advice.band
    }

    fn scheme(&self, answer: &Answer) -> Checked {
        let (scheme, lacks_fast) = (&answer.scheme, self.advice.lacks_fast);
        let (corner, given, outer) = (self.corner(scheme), self.mass(scheme, None), scheme.outer());
        let in_band = corner.in_first_region()? == Some(true);
        corner.ends_within(outer, answer.band_edge, "the band")?;
        let is_before = |row: &Row| row.first.as_ref().is_some_and(|first| *outer < exact(first.lower.0));
        let status = match () {
            () if lacks_fast => Status::Undecided,
            () if answer.rows.iter().any(|row| !row.found.kind.is_stable()) => Status::Unstable,
            () if in_band && self.advice.beads.is_some() => Status::Undecided,
            () if in_band && self.is_published(&given, outer) => Status::Safe,
            () if in_band => Status::Caution,
            () if answer.rows.iter().all(is_before) => Status::Near,
            () => Status::Island,
        };
        same("status", answer.status.name(), status.name())?;
        self.largest(&corner, &given, answer)?;
        self.safe_bias(answer)?;
        let silent: Vec<usize> = (1..corner.steps.len()).filter(|&clock| corner.is_silent(clock)).collect();
        let is_asked = !silent.is_empty() && in_band && !lacks_fast;
        holds(answer.needs.is_some() == is_asked, || "needs is given for a silent clock".into())?;
        answer.needs.map_or(Ok(()), |needs| self.needs(corner, &silent, needs))
    }

    /// That of the mode that is most off with the outermost step that is safe.
    fn safe_bias(&self, answer: &Answer) -> Checked {
        let Some((safe, (_, told))) = answer.safe.as_ref().zip(answer.safe_bias) else {
            return holds(answer.safe.is_some() == answer.safe_bias.is_some(), || {
                "safe_bias is missing".into()
            });
        };
        let mut most = Ball::one();
        for row in &answer.rows {
            let mass = self.mass(&answer.scheme, Some(&self.advice.modes[row.mode])).heard().with_outer(safe);
            let bias = mass.bias()?.unwrap_or_else(Ball::one);
            let off = |bias: &Ball| bias.mid_f64().ln().abs();
            most = if off(&bias) > off(&most) { bias } else { most };
        }
        holds(encloses(told, &most), || format!("safe_bias is {}", most.mid_f64()))
    }

    /// The shortest period on silent clocks for which the band is proven, to a millionth.
    fn needs(&self, corner: Mass, silent: &[usize], needs: f64) -> Checked {
        let is_proven = |period: f64| {
            let shorter = Ball::from_rational(&(exact(period) * self.shorter()), BITS);
            let frequency = Ball::pi(BITS).scale2(1).div(&shorter, BITS).unwrap_or_else(Ball::zero);
            let mut with = Mass { steps: corner.steps.clone(), stiffness: corner.stiffness.clone() };
            silent.iter().for_each(|&clock| with.stiffness[clock] = frequency.square(BITS));
            with.in_first_region()
        };
        let is_shortest = is_proven(needs)? == Some(true) && is_proven(0.999_99 * needs)? == Some(false);
        holds(is_shortest, || "needs is not the shortest slow period".into())
    }

    /// Whether all steps are below what is published, with this outermost one.
    fn is_published(&self, given: &Mass, outer: &Rational) -> bool {
        let last = given.steps.len() - 1;
        let inner_are = (0..last).all(|clock| self.is_below_turn(given, clock, &given.steps[clock]));
        let third = self.advice.modes[self.advice.fastest].part(3).0;
        inner_are && self.is_below_turn(given, last, outer) && (last == 0 || *outer < exact(third))
    }

    /// Whether h w ≤ 1 of the stiffest mode on a clock, for a step of its own; lifted of harmonic bonds, but
    /// not of the slowest force beside others. A bond of a known shape has the step that was measured in its
    /// place.
    fn is_below_turn(&self, given: &Mass, clock: usize, step: &Rational) -> bool {
        let last = given.steps.len() - 1;
        let is_slow = clock == last && last > 0;
        if is_slow || self.advice.cold.is_empty() {
            return !is_slow && self.advice.harmonic || is_below_one(&given.stiffness[clock], step);
        }
        self.advice.modes.iter().filter(|mode| mode.clock == Some(clock)).all(|mode| {
            let stiffness = mode.stiffness.enclosure(BITS);
            let mut cold = self.advice.cold.iter().filter(|cold| cold.name == mode.name).peekable();
            if cold.peek().is_none() {
                return self.advice.harmonic || is_below_one(&stiffness, step);
            }
            // h below the bound share T, that is h w/(2 π share) below 1.
            cold.filter_map(|cold| cold.first).all(|edge| {
                let share = Ball::from_rational(&exact(edge.bound()), BITS);
                let turn = Ball::pi(BITS).scale2(1).mul(&share, BITS);
                let scaled = stiffness.div(&turn.square(BITS), BITS);
                scaled.is_some_and(|scaled| is_below_one(&scaled, step))
            })
        })
    }

    /// Where a bond of a known shape begins to be too hot, letter by letter.
    fn cold(&self, cold: &Cold) -> Checked {
        let bond = self.advice.modes.iter().find(|mode| mode.name == cold.name);
        let word = words::method(cold.kind.method)?.word();
        let plain = bond
            .and_then(|mode| mode.shape.as_ref())
            .map(|bond| Plain::of(bond, &word, &cold.temperature, None));
        holds(plain.is_some(), || "it has no shape".into())?;
        plain.map_or(Ok(()), |plain| plain.begins(cold.first.as_ref(), cold.level))
    }

    /// That the band's corner is in the first region at `largest`, and not at the next multiple; and `safe`
    /// below what is published.
    fn largest(&self, corner: &Mass, given: &Mass, answer: &Answer) -> Checked {
        let count = corner.steps.len();
        let is_proven = |outer: &Rational| -> Checked<bool> {
            Ok(corner.with_outer(outer).in_first_region()? == Some(true))
        };
        let is_silent = (0..count).any(|clock| corner.is_silent(clock)) || self.advice.lacks_fast;
        let Some(largest) = &answer.largest else {
            let none = is_silent || count == 1 || !is_proven(&corner.steps[count - 2])?;
            return holds(answer.safe.is_none() && none, || "largest is missing".into());
        };
        let unit = if count > 1 { corner.steps[count - 2].clone() } else { Rational::one() };
        let is_multiple = |step: &Rational| count == 1 || (step / &unit).is_integer();
        let is_largest = is_multiple(largest) && (count == 1 || !is_proven(&(largest + &unit))?);
        holds(!is_silent && is_proven(largest)? && is_largest, || {
            format!("{largest} is not the largest outer step that is proven for the band")
        })?;
        let Some(safe) = &answer.safe else {
            let none = self.advice.beads.is_some() || !self.is_published(given, &unit);
            return holds(none, || "safe is missing".into());
        };
        // Of one step the bound itself is told, of several the longest multiple below it.
        let beside = |by: i64| safe * Rational::new((10_i64.pow(12) + by).into(), 10_i64.pow(12).into());
        let [value, next] = if count == 1 { [-1, 1].map(beside) } else { [safe.clone(), safe + &unit] };
        let is_longest = safe == largest || !self.is_published(given, &next);
        let is_safe = is_multiple(safe) && safe <= largest && self.is_published(given, &value);
        holds(is_safe && is_longest && self.advice.beads.is_none(), || {
            format!("{safe} is not the longest outer step below the published limits")
        })
    }

    /// Both turn by 2 π together in an outer step of that length.
    fn pair(&self, pair: &Pair, scheme: &Scheme) -> Checked {
        let parts = to_f64(&(scheme.outer() / scheme.inner()));
        let [first, second] = pair.modes.map(|mode| &self.advice.modes[mode]);
        let turns = |mode: &Mode| {
            // s = 2 − 2 cos θ, so the angle by its cosine and not by the sine of its half.
            let s = (2.0 * std::f64::consts::PI * pair.near / (parts * mode.period().0)).powi(2);
            parts * (1.0 - s / 2.0).max(-1.0).acos()
        };
        // The cosine of a small angle has half of its digits.
        let off = (turns(first) + turns(second)) / (2.0 * std::f64::consts::PI) - 1.0;
        holds(off.abs() < 1e-6, || format!("{} and {} do not meet there", first.name, second.name))
    }
}

/// The stiffest of some modes on each clock, or this one on its own.
pub fn stiffest(modes: &[Mode], steps: &[Rational], mode: Option<&Mode>) -> Mass {
    let on = |clock: usize| {
        let own = mode.filter(|mode| mode.clock == Some(clock));
        let all = modes.iter().filter(move |mode| mode.clock == Some(clock));
        let stiffest = own.or_else(|| all.max_by(|a, b| a.stiffness.cmp(&b.stiffness)));
        stiffest.map_or_else(Ball::zero, |mode| mode.stiffness.enclosure(BITS))
    };
    Mass { steps: steps.to_vec(), stiffness: (0..steps.len()).map(on).collect() }
}

/// Each x with n x = T: (n x)² stiffness = 4 π².
fn has_parts(mode: &Mode) -> Checked {
    let stiffness = mode.stiffness.enclosure(BITS);
    let is = |n: u64, (lo, hi): (f64, f64), square: &Ball| {
        let of = |x: f64| {
            let whole = Ball::from_rational(&(exact(x) * Rational::from_integer(n.into())), BITS);
            whole.square(BITS).mul(&stiffness, BITS)
        };
        lo > 0.0 && of(lo).lower() <= square.upper() && square.lower() <= of(hi).upper()
    };
    let turn = Ball::pi(BITS).scale2(1).square(BITS);
    for n in [2, 3, 4, 5, 10] {
        holds(is(n, mode.part(n), &turn), || format!("a part is not the period over {n}"))?;
    }
    let are_so = is(1, mode.period(), &turn) && is(1, mode.verlet(), &Ball::from_integer(&4.into()));
    holds(are_so, || "its stiffness has another period".into())
}

/// Whether h w < 1; bounds are rounded down a little.
fn is_below_one(stiffness: &Ball, step: &Rational) -> bool {
    let square = Ball::from_rational(step, BITS).square(BITS).mul(stiffness, BITS);
    let little = Rational::new(1.into(), 1_000_000_000_000_000_i64.into());
    let most = Ball::from_rational(&(Rational::one() - little), BITS);
    square.sub(&most, BITS).sign() == Some(Sign::Negative)
}
