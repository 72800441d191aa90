//! The trace against the predictions: over a grid, or over ratios.

use super::asking::{Fields, Question, Work, question};
use super::field::StepRange;
use super::map::Map;
use super::ratios::{MOST_SUM, Ratios};
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{COUNT, EXACT, GROUP, KIND, POSITIVE, Schema, Shape, WIDE_ENCLOSURE};
use crate::report::table::{Cell, Column};
use clocks::map::Grid;
use clocks::resonance::compare::{Comparison, Comparisons, Offender, Tally, compare_ratios};
use number::{Error, Laurent, Rational, Result};

question! {
    /// The trace verdict against the tan criterion and against resonance: over a grid with both stiffnesses,
    /// or over all coprime p + q up to a sum at s = 4 k/(samples + 1).
    #[derive(Default)]
    args struct Compare {
        /// How near q h2 must be to a multiple of T1/2, half the vibration's period, to count as resonant; in
        /// units of T1/2.
        tolerance as "T": Rational = "1/20",
        /// The stiffness of the fast force (with a grid).
        lambda1 as "X": Option<Laurent>,
        /// The stiffness of the slow force (with a grid).
        lambda2 as "Y": Option<Laurent>,
        /// The spacing of h1, where it differs.
        step1 as "D1": Option<Laurent> | step,
        /// The spacing of h2, where it differs.
        step2 as "D2": Option<Laurent> | step,
        /// The closed range of h1, as 1/100..2/pi.
        h1_range as "LO..HI": Option<StepRange>,
        /// The closed range of h2.
        h2_range as "LO..HI": Option<StepRange>,
        /// Instead of a grid: all coprime p + q up to this number.
        max_sum as "N": Option<u64>,
        /// lambda2/lambda1, with --max-sum.
        rho as "R": Option<Rational>,
        /// With --max-sum: the values of s = h1^2 lambda1, evenly spaced inside 0 < s < 4 [default: 99].
        samples as "K": Option<u64>,
    }
}

/// The pairs that are compared.
pub enum Over {
    /// All pairs of a grid.
    Grid(Grid),
    /// All coprime p + q up to a sum.
    Ratios { max_sum: u64, rho: Rational, samples: u64 },
}

impl Compare {
    /// The comparison over the grid of a map.
    pub fn over_grid(map: Map, tolerance: Rational) -> Compare {
        let Map { lambda1, lambda2, step1, step2, h1_range, h2_range, .. } = map;
        let [lambda1, lambda2, step1, step2] = [lambda1, lambda2, step1, step2].map(Some);
        let [h1_range, h2_range] = [h1_range, h2_range].map(Some);
        Compare { tolerance, lambda1, lambda2, step1, step2, h1_range, h2_range, ..Compare::default() }
    }

    /// The values of s of each ratio, with a sum.
    fn samples(&self) -> Option<u64> {
        self.max_sum.map(|_| self.samples.unwrap_or(99))
    }

    /// The pairs that are compared.
    ///
    /// # Errors
    /// Neither a whole grid nor a sum with ρ, or parts of both; whatever [`Grid::new`] refuses.
    pub fn pairs(&self) -> Result<Over> {
        let Compare { lambda1, lambda2, step1, step2, h1_range, h2_range, max_sum, rho, samples, .. } = self;
        match (lambda1, lambda2, step1, step2, h1_range, h2_range, max_sum, rho) {
            (Some(lambda1), Some(lambda2), Some(step1), Some(step2), Some(h1), Some(h2), None, None)
                if samples.is_none() =>
            {
                let steps = [step1.clone(), step2.clone()];
                Grid::new(lambda1.clone(), lambda2.clone(), steps, h1.clone(), h2.clone()).map(Over::Grid)
            }
            (None, None, None, None, None, None, Some(max_sum), Some(rho)) => {
                Ratios::UpTo(*max_sum).within(MOST_SUM)?;
                let samples = self.samples().unwrap_or_default();
                Ok(Over::Ratios { max_sum: *max_sum, rho: rho.clone(), samples })
            }
            _ => {
                let remedy = "give --lambda1, --lambda2 and a grid (--step, --h1-range, --h2-range), or --max-sum and --rho";
                Err(Error::input("flags", "incomplete or mixed", remedy))
            }
        }
    }
}

const CAPTION: &str = "Pairs at which the prediction $q h_2 \\approx m T_{1/2}$ is wrong";

impl Question for Compare {
    const NAME: &'static str = "compare";
    const EXAMPLES: &'static [&'static str] = &[
        "compare --max-sum 9 --rho 1/25",
        "compare --lambda1 10 --lambda2 2/5 --step 1/10 --h1-range 1/10..1/2 --h2-range 1/10..3",
        "compare --methods impulse,molly-short,respa-4 --h-range 0..8 --h-step 1/8 --rho-range 0..1 --rho-step 1/16 --output side.svg",
        "compare --methods velocity-verlet,forest-ruth,pefrl --by-cost --h-range 0..4 --h-step 1/100",
    ];
    const USAGE: Option<&'static str> = Some(
        "(--lambda1 X --lambda2 Y --step D --h1-range A..B --h2-range A..B | --max-sum N --rho R | --methods LIST)",
    );
    type Answer = Comparisons;

    fn schema() -> Option<Schema> {
        let body = counts()
            .keys()
            .key(
                "tan",
                GROUP,
                "Pairs at which the tan criterion and the trace condition give one verdict, and others.",
            )
            .key(
                "resonance",
                GROUP,
                "The rule `unstable whenever q h2 is near a multiple of T_half` against the trace condition.",
            )
            .key(
                "offenders",
                OFFENDERS,
                "The pairs at which a prediction is wrong, in the order of the grid or of the ratios.",
            );
        let title = "The trace condition against the tan criterion and against nearness to a resonance";
        // Either a grid of steps for one oscillator, or all coprime p + q up to a sum for one rho.
        let rules = r#"{"allOf": [{"properties": {"input": {"oneOf": [
            {"required": ["lambda1", "lambda2", "step1", "step2", "h1_range", "h2_range"], "properties": {"max_sum": false, "rho": false, "samples": false}},
            {"required": ["max_sum", "rho", "samples"], "properties": {"lambda1": false, "lambda2": false, "step1": false, "step2": false, "h1_range": false, "h2_range": false}}
        ]}}}]}"#;
        Some(Schema::new(title, body).rules(rules))
    }

    fn answer(&self, work: &Work) -> Result<Comparisons> {
        match self.pairs()? {
            Over::Grid(grid) => grid.compare(&self.tolerance, &work.limits()),
            Over::Ratios { max_sum, rho, samples } => {
                compare_ratios(max_sum, &rho, samples, &self.tolerance, &work.limits())
            }
        }
    }

    fn show(&self, answer: &Comparisons) -> Document {
        let places = if self.max_sum.is_some() { ["s", "rho"] } else { ["h1", "h2"] };
        let Comparisons { tally, offenders } = answer;
        let table = record(places).table("offenders", "Pairs at which a prediction is wrong", offenders);
        let lines = lines(tally, &self.tolerance);
        let document = counts().document(Document::new(Self::NAME), tally);
        document.rows(table.captioned(CAPTION)).summary(&lines).answer(lines)
    }

    /// With the number of samples that was taken.
    fn document(&self, answer: &Comparisons) -> Document {
        self.show(answer).inputs(Compare { samples: self.samples(), ..self.clone() }.input())
    }
}

/// The counts of a comparison.
fn counts() -> Record<'static, Tally> {
    Record::new()
        .json("pairs", |tally: &Tally| tally.pairs.into())
        .says(COUNT, "The pairs that were compared.")
        .json("unstable", |tally| tally.unstable.into())
        .says(COUNT, "By the trace condition.")
        .json("tan.agree", |tally| tally.tan_agree.into())
        .says(COUNT, "")
        .json("tan.disagree", |tally| tally.tan_disagree.into())
        .says(COUNT, "")
        .json("resonance.hits", |tally| tally.hits.into())
        .says(COUNT, "Unstable and near.")
        .json("resonance.quiet", |tally| tally.quiet.into())
        .says(COUNT, "Stable and away.")
        .json("resonance.misses", |tally| tally.misses.into())
        .says(COUNT, "Unstable but away.")
        .json("resonance.false_alarms", |tally| tally.false_alarms.into())
        .says(COUNT, "Stable but near.")
        .json("resonance.beyond_verlet", |tally| tally.beyond_verlet.into())
        .says(COUNT, "s = h1^2 lambda1 >= 4: there is no T_half.")
}

/// Offenders of a grid, or of ratios.
const OFFENDERS: Shape = Shape::List(&Shape::Any(&[
    Shape::Object(|| record(["h1", "h2"]).keys()),
    Shape::Object(|| record(["s", "rho"]).keys()),
]));

fn lines(tally: &Tally, tolerance: &Rational) -> Vec<String> {
    let Tally { pairs, unstable, tan_agree, hits, quiet, misses, false_alarms, beyond_verlet, .. } = tally;
    let verdict = if tally.tan_disagree == 0 { "everywhere" } else { "NOT everywhere" };
    vec![
        format!("{pairs} pairs, {unstable} unstable by the trace condition"),
        format!("tan criterion: agrees {verdict} ({tan_agree} of {pairs})"),
        format!("q h2 within {tolerance} T½ of a multiple of T½:"),
        format!("  unstable and near (hits)           {hits:>12}"),
        format!("  stable and away (quiet)            {quiet:>12}"),
        format!("  unstable but away (misses)         {misses:>12}"),
        format!("  stable but near (false alarms)     {false_alarms:>12}"),
        format!("  s >= 4, no effective period        {beyond_verlet:>12}"),
    ]
}

/// The row of an offender.
fn record(places: [&str; 2]) -> Record<'static, Offender> {
    let [first, second] = places.map(|name| Column::math(name, formula(name)));
    let nearest = |offender: &Offender| offender.comparison.nearest.clone();
    Record::new()
        .field(first, |offender: &Offender| Cell::exact(&offender.place[0]))
        .says(EXACT, "")
        .field(second, |offender| Cell::exact(&offender.place[1]))
        .says(EXACT, "")
        .field(Column::math("p", "p"), |offender| offender.ratio.p().into())
        .says(POSITIVE, "Fast kicks a period: h2/h1 = p/q in lowest terms.")
        .field(Column::math("q", "q"), |offender| offender.ratio.q().into())
        .says(POSITIVE, "Slow kicks a period.")
        .field(Column::new("offence").left(), |offender| offence(&offender.comparison).into())
        .says(Shape::OneOf(&["miss", "false alarm", "tan"]), "Which prediction is wrong, and how.")
        .field(Column::new("kind").left().aside(), |offender| {
            offender.comparison.trace.verdict.kind().name().into()
        })
        .says(KIND, "By the trace condition.")
        .field(Column::new("tan").in_words("tan criterion").left().aside(), |offender| {
            offender.comparison.tan.kind().name().into()
        })
        .says(KIND, "By the tan criterion.")
        .field(Column::new("m").titled("nearest m", "nearest $m$"), move |offender| {
            nearest(offender).map(|n| n.m).into()
        })
        .says(Shape::OrNull(&COUNT), "The multiple of T_half that q h2 is nearest to, 0 being no resonance; null where there is no T_half.")
        .field(
            Column::new("distance").titled("q h2/T½ - m", "$q h_2/T_{1/2} - m$").enclosure(),
            move |offender| nearest(offender).map(|n| n.distance.to_f64_enclosure()).into(),
        )
        .says(Shape::OrNull(&WIDE_ENCLOSURE), "q h2/T_half - m; null where there is no T_half.")
}

fn offence(comparison: &Comparison) -> &'static str {
    if comparison.tan_agrees() { comparison.outcome.map_or("none", |outcome| outcome.name()) } else { "tan" }
}

fn formula(name: &str) -> &str {
    match name {
        "h1" => "h_1",
        "h2" => "h_2",
        "rho" => "\\rho",
        other => other,
    }
}
