//! The rows of the document `kickdrift/advise/1`, and what concerns it as a whole.

use num_traits::One;

use super::mass::{BITS, Mass, crosses, exact, fastest_growth};
use crate::question::Advised;
use crate::verify::again::{Left, Recheck, asked};
use crate::verify::context::{Checked, Context, Fault, Outcome, Place, holds};
use crate::verify::written::{Ends, Written};
use clocks::verdict::Kind;
use molecules::Mode;
use number::error::Result;
use number::rational::to_f64;
use number::{Ball, Laurent, Rational, Real, Sign};

const ROUTE: &str =
    "the full period, kick by kick, in balls of 512 bits; the first region by the pivots of its action";

rows! {
    /// `kickdrift/advise/1`.
    pub struct Claim {
        pub input: Advised,
        pub modes: Vec<ModeRow>,
        pub schemes: Vec<SchemeRow>,
        pub rows: Vec<Row>,
        pub intervals: Vec<Interval>,
        pub pairs: Vec<Pair>,
        #[serde(default)]
        pub levers: Vec<LeverRow>,
        #[serde(default)]
        pub measured: Vec<Measured>,
    }

    /// A bond of a known shape: the first step at which it is too hot, over its period.
    pub struct Measured {
        pub mode: String,
        pub share: f64 | null,
    }

    pub struct ModeRow {
        pub name: String,
        pub clock: u64,
        pub stiffness: Written<Laurent>,
        pub period: Ends,
        pub verlet: Ends,
        pub half: Ends,
        pub third: Ends,
        pub quarter: Ends,
        pub fifth: Ends,
        pub tenth: Ends,
        pub before: f64 | null,
    }

    pub struct SchemeRow {
        pub outer: Written<Rational>,
        pub status: String,
        pub band_edge: Ends,
        pub largest: Written<Rational> | null,
        pub safe: Written<Rational> | null,
        pub bound: String | null,
        pub needs: f64 | null,
        pub within_run: bool | null,
    }

    pub struct Row {
        pub scheme: u64,
        pub outer: Written<Rational>,
        pub mode: String,
        pub kind: Written<Kind>,
        pub trace: Ends,
        pub growth_rate: Ends,
        pub tenfold_steps: Ends | null,
        pub masked_above: Ends | null,
        pub masked_below: f64 | null,
        pub damped: bool | null,
        pub ratios_lower: Written<Rational> | null,
        pub ratios_upper: Written<Rational> | null,
        pub first_lower: Ends | null,
        pub first_upper: Ends | null,
        pub first_tenfold_steps: f64 | null,
        pub inside_lower: Ends | null,
        pub inside_upper: Ends | null,
        pub inside_tenfold_steps: f64 | null,
        pub below_lower: Ends | null,
        pub below_upper: Ends | null,
        pub below_tenfold_steps: f64 | null,
        pub above_lower: Ends | null,
        pub above_upper: Ends | null,
        pub above_tenfold_steps: f64 | null,
    }

    pub struct Interval {
        pub scheme: u64,
        pub mode: String,
        pub m: u64,
        pub lower: Ends,
        pub upper: Ends | null,
        pub tenfold_steps: f64 | null,
    }

    pub struct LeverRow {
        pub lever: String,
        pub method: String,
        pub first: Ends | null,
        pub first_exact: Written<Laurent> | null,
        pub band_edge: Ends | null,
        pub step: Written<Rational> | null,
    }

    pub struct Pair {
        pub scheme: u64,
        pub first: String,
        pub second: String,
        pub near: f64,
    }
}

impl Place for Row {
    fn place(&self) -> String {
        format!("scheme {}, mode {}", self.scheme, self.mode)
    }
}

impl Recheck for Claim {
    const TABLE: &'static str = "rows";
    const LEFT: &'static [Left] = &[
        ("engine", "the text that it was read from is not part of the document"),
        ("input.constrained", "bonds that are held take no part in the answer"),
    ];
    asked!(Advised);

    fn check(&self, _: Self::Found, context: &Context) -> Result<Outcome> {
        context.outcome(ROUTE, ("the schemes", self.whole()), &self.rows, |row| self.row(row))
    }
}

impl Claim {
    /// The unit of rates over that of lengths.
    pub fn per(&self) -> u32 {
        if self.input.plain_time { 1 } else { 1000 }
    }

    /// Whether nothing is known of the innermost clock.
    pub fn lacks_fast(&self) -> bool {
        let is_alone = self.input.schemes.first().is_none_or(|schemes| schemes.steps().len() == 1);
        let slow = |mode: &Mode| {
            mode.origin.name().starts_with("slow period") || mode.name.to_lowercase().starts_with("slow")
        };
        !self.modes_asked().any(|mode| mode.clock == Some(0) && !(is_alone && slow(mode)))
    }

    /// Whether h w ≤ 1 of the stiffest mode on a clock, for a step of its own; lifted of harmonic bonds, but
    /// not of the slowest force beside others. A bond of a known shape has the step that was measured in its
    /// place.
    pub fn is_below_turn(&self, mass: &Mass, clock: usize, step: &Rational) -> bool {
        let last = mass.steps.len() - 1;
        let is_slow = clock == last && last > 0;
        if is_slow || self.measured.is_empty() {
            return !is_slow && self.input.harmonic || is_below_one(&mass.stiffness[clock], step);
        }
        self.modes_asked().filter(|mode| mode.clock == Some(clock)).all(|mode| {
            let stiffness = mode.stiffness.enclosure(BITS);
            match self.measured.iter().find(|row| row.mode == mode.name) {
                None => self.input.harmonic || is_below_one(&stiffness, step),
                // h below T (1 - band) share, that is h w/(2 π (1 - band) share) below 1.
                Some(Measured { share: Some(share), .. }) => {
                    let part =
                        Ball::from_rational(&(exact(*share) * (Rational::one() - &self.input.band)), BITS);
                    let turn = Ball::pi(BITS).scale2(1).mul(&part, BITS);
                    let scaled = stiffness.div(&turn.square(BITS), BITS);
                    scaled.is_some_and(|scaled| is_below_one(&scaled, step))
                }
                Some(_) => true,
            }
        })
    }

    /// The stiffest mode on each clock, or this one on its own.
    pub fn mass(&self, scheme: usize, mode: Option<&Mode>) -> Checked<Mass> {
        let missing = || Fault::Wrong(format!("there is no scheme {}", scheme.wrapping_add(1)));
        let steps = self.input.schemes.get(scheme).ok_or_else(missing)?.steps().to_vec();
        let of = |clock: usize| {
            let own = mode.filter(|mode| mode.clock == Some(clock));
            let on = self.modes_asked().filter(move |mode| mode.clock == Some(clock));
            let stiffest = own.or_else(|| on.max_by(|a, b| a.stiffness.cmp(&b.stiffness)));
            stiffest.map_or_else(Ball::zero, |mode| mode.stiffness.enclosure(BITS))
        };
        let stiffness = (0..steps.len()).map(of).collect();
        Ok(Mass { steps, stiffness })
    }

    pub fn modes_asked(&self) -> impl Iterator<Item = &Mode> {
        self.input.modes.iter().flatten()
    }

    /// The stiffest modes with the shortest periods of the band.
    pub fn corner(&self, scheme: usize) -> Checked<Mass> {
        let mut mass = self.mass(scheme, None)?;
        let shorter = Ball::from_rational(&(Rational::one() - &self.input.band), BITS);
        let square = shorter.square(BITS);
        for stiffness in &mut mass.stiffness {
            *stiffness = stiffness.div(&square, BITS).unwrap_or_else(|| stiffness.clone());
        }
        Ok(mass)
    }

    fn whole(&self) -> Checked {
        let length = &self.input.length;
        self.modes.iter().try_for_each(ModeRow::holds)?;
        for (n, scheme) in self.schemes.iter().enumerate() {
            self.scheme(n, scheme)?;
            let grows = self.of(n).any(|row| row.tenfold_steps.is_some());
            let least = self.of(n).filter_map(|row| row.tenfold_steps).map(|steps| steps.hi);
            let time = least.fold(f64::INFINITY, f64::min) * to_f64(&scheme.outer);
            let truth = length.as_ref().filter(|_| grows).map(|length| time <= to_f64(length));
            holds(scheme.within_run == truth, || "within_run is not what growth in the run says".into())?;
        }
        self.pairs.iter().try_for_each(|pair| self.pair(pair))?;
        self.levers.iter().try_for_each(|lever| self.lever(lever))?;
        self.intervals.iter().try_for_each(|interval| self.interval(interval))
    }

    pub fn of(&self, scheme: usize) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(move |row| row.scheme == scheme as u64 + 1)
    }

    fn named(&self, name: &str) -> Checked<&ModeRow> {
        let found = self.modes.iter().find(|mode| mode.name == name);
        holds(found.is_some(), || format!("there is no mode {name}"))?;
        Ok(found.expect("just seen"))
    }

    /// The shortest period on any clock but the outermost.
    pub fn fastest(&self) -> Checked<&ModeRow> {
        let last = self.input.schemes.first().map_or(0, |scheme| scheme.steps().len()) as u64;
        let inner = self.modes.iter().filter(|mode| last == 1 || mode.clock < last);
        let by = |a: &&ModeRow, b: &&ModeRow| a.stiffness.cmp(&b.stiffness);
        let found = inner.max_by(by).or_else(|| self.modes.iter().max_by(by));
        holds(found.is_some(), || "there is no mode".into())?;
        Ok(found.expect("just seen"))
    }

    /// An interval that is listed: both ends are such, and what lies between is unstable.
    fn interval(&self, interval: &Interval) -> Checked {
        let mode = self.modes_asked().find(|mode| mode.name == interval.mode);
        let mass = self.mass((interval.scheme as usize).wrapping_sub(1), mode)?;
        let outer = mass.steps.last().cloned().unwrap_or_default();
        let at = |step: f64| mass.scaled(&(exact(step) / &outer));
        let Some(upper) = interval.upper else { return Ok(()) };
        holds(mode.is_some() && interval.lower.hi <= upper.lo, || {
            format!("interval {} of {} is none", interval.m, interval.mode)
        })?;
        crosses(&at, interval.lower, "lower")?;
        crosses(&at, upper, "upper")?;
        let inside = at(interval.lower.hi / 2.0 + upper.lo / 2.0);
        holds(inside.excess()? != Some(Sign::Negative), || {
            format!("interval {} of {} is stable inside", interval.m, interval.mode)
        })?;
        // In tongue m the trace has the sign (-1)^m.
        let sign = inside.trace()?.0.sign();
        holds((sign == Some(Sign::Positive)) == (interval.m.is_multiple_of(2)), || {
            format!("{} is not the label of that interval", interval.m)
        })?;
        fastest_growth(&at, (interval.lower.hi, upper.lo), interval.tenfold_steps)
    }

    fn pair(&self, pair: &Pair) -> Checked {
        let Some(scheme) = self.input.schemes.get((pair.scheme as usize).wrapping_sub(1)) else {
            return holds(false, || format!("there is no scheme {}", pair.scheme));
        };
        let parts = to_f64(&(scheme.outer() / scheme.inner()));
        let turns = |mode: &ModeRow| {
            // s = 2 − 2 cos θ, so the angle by its cosine and not by the sine of its half.
            let s = (2.0 * std::f64::consts::PI * pair.near / (parts * mode.period.lo)).powi(2);
            parts * (1.0 - s / 2.0).max(-1.0).acos()
        };
        let sum = turns(self.named(&pair.first)?) + turns(self.named(&pair.second)?);
        // near has four digits.
        holds((sum / (2.0 * std::f64::consts::PI) - 1.0).abs() < 2e-3, || {
            format!("{} and {} do not meet there", pair.first, pair.second)
        })
    }
}

impl ModeRow {
    /// Each x with n x = T: (n x)² stiffness = 4 π².
    fn holds(&self) -> Checked {
        let stiffness = self.stiffness.enclosure(BITS);
        let turn = Ball::pi(BITS).scale2(1);
        let parts = [
            (1, self.period),
            (2, self.half),
            (3, self.third),
            (4, self.quarter),
            (5, self.fifth),
            (10, self.tenth),
        ];
        let whole = |n: u64, ends: Ends, square: Ball, name: &str| {
            let of = |x: f64| {
                Ball::from_rational(&(exact(x) * Rational::from_integer(n.into())), BITS)
                    .square(BITS)
                    .mul(&stiffness, BITS)
            };
            let right = ends.lo > 0.0
                && of(ends.lo).lower() <= square.upper()
                && square.lower() <= of(ends.hi).upper();
            holds(right, || format!("{name} of {} is not the period over {n}", self.name))
        };
        for (n, ends) in parts {
            whole(n, ends, turn.square(BITS), "a part")?;
        }
        let shorter = self.before.is_none_or(|before| before > 0.0 && before < self.period.hi);
        holds(shorter, || format!("heavy hydrogens do not shorten the period of {}", self.name))?;
        whole(1, self.verlet, Ball::from_integer(&4.into()), "verlet")
    }
}

/// Whether h w < 1; bounds are rounded down a little.
fn is_below_one(stiffness: &Ball, step: &Rational) -> bool {
    let square = Ball::from_rational(step, BITS).square(BITS).mul(stiffness, BITS);
    let most = Ball::from_rational(
        &(Rational::one() - Rational::new(1.into(), 1_000_000_000_000_000_i64.into())),
        BITS,
    );
    square.sub(&most, BITS).sign() == Some(Sign::Negative)
}
