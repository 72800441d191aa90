//! Integrators side by side: their verdicts over the same grid of steps and stiffness ratios.

use plot::{Axis, Cells, Figure, Foot, Layer, Panel, Place, literal, palette};

use super::asking::{Question, Work, question};
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{COUNT, EXACT, Keys, POSITIVE, ROUNDED, Schema, Shape, TEXT};
use crate::report::table::{Cell, Column};
use number::parallel::try_map;
use number::{Error, ExactSign, Laurent, Rational, Result, Sign, to_f64};
use words::{Bounded, Integrator};

question! {
    /// The verdicts of several integrators at all multiples of two spacings: of the step h and of ρ = Λ2/Λ1,
    /// or of the steps h1 and h2 of each force, h² Λ1 being h1² Λ1 and h² Λ2 being h2² Λ2.
    args struct CompareMethods {
        /// Integrators side by side instead: names of the catalogue (word --list), or words, with commas
        /// between them.
        ///
        /// Over (h, lambda2/lambda1), or over (h1, h2) with a grid: each force in units of its own step, so
        /// that a step h of the word has
        ///
        /// h^2 times the stiffnesses h1^2 lambda1 and h2^2 lambda2. lambda1 is 1 unless given, lambda2 as
        /// lambda1.
        #[arg(long, value_name = "A,B,...", required = false, conflicts_with_all = ["max_sum", "rho"])]
        methods: String,
        /// The stiffness of the fast force.
        lambda1 as "X": Laurent = "1",
        /// The closed range of steps, with --methods.
        #[arg(required = false, requires = "methods")]
        h_range as "LO..HI": (Rational, Rational) | h1_range,
        /// The spacing of steps.
        #[arg(required = false, requires = "methods")]
        h_step as "D": Rational | step1 | step,
        /// The closed range of lambda2/lambda1, with --methods.
        #[arg(requires = "methods")]
        rho_range as "LO..HI": Option<(Rational, Rational)>,
        /// The spacing of lambda2/lambda1.
        #[arg(requires = "methods")]
        rho_step as "R": Option<Rational>,
        /// The stiffness of the slow force, that of the fast one if not given; with h2.
        #[arg(skip)]
        lambda2: Option<Laurent>,
        /// With --methods: equal cost. A word of n evaluations, gradients, solves and flows takes n times
        /// each step; best first.
        #[arg(long, requires = "methods")]
        by_cost: bool,
        /// In place of Λ2/Λ1: the closed range of h2.
        #[arg(skip)]
        h2_range: Option<(Rational, Rational)>,
        /// Its spacing.
        #[arg(skip)]
        h2_step: Option<Rational> | step2 | step,
    }
}

/// The verdicts of one integrator, row by row of ρ.
#[derive(Clone, Debug)]
pub struct Side {
    pub name: String,
    pub integrator: Integrator,
    /// Its evaluations, gradients, solves and flows in a step.
    pub evaluations: u64,
    pub rows: Vec<Vec<Bounded>>,
}

impl Side {
    /// How many points have this answer.
    pub fn count(&self, bounded: Bounded) -> u64 {
        self.rows.iter().flatten().filter(|own| **own == bounded).count() as u64
    }
}

/// Points times the degree of the entries in s, unless a budget says otherwise: some seconds.
const MOST: u64 = 2_000_000;

/// The most integrators: more do not fit a page.
const MOST_METHODS: usize = 8;

/// A range and a spacing of Λ2/Λ1, or of h2 and then with the ratio.
type Second<'a> = (&'a (Rational, Rational), &'a Rational, Option<Rational>);

impl CompareMethods {
    /// The names between commas; those in parentheses belong to words.
    fn names(&self) -> Vec<String> {
        let (mut depth, mut names) = (0i32, vec![String::new()]);
        for c in self.methods.chars() {
            depth += i32::from(c == '(') - i32::from(c == ')');
            match names.last_mut() {
                Some(text) if c != ',' || depth > 0 => text.push(c),
                _ => names.push(String::new()),
            }
        }
        names.iter().map(|name| name.trim().to_string()).collect()
    }

    /// The positive multiples of a spacing in a range.
    fn multiples(field: &str, (lo, hi): &(Rational, Rational), step: &Rational) -> Result<Vec<Rational>> {
        if step.sign() != Sign::Positive {
            return Err(Error::input(&format!("{field}_step"), step, "a spacing must be positive"));
        }
        let one = Rational::from_integer(1.into());
        let (first, last) = ((lo / step).ceil().max(one), (hi / step).floor());
        let count = &last - &first;
        if count.sign() == Sign::Negative {
            return Err(Error::input(
                &format!("{field}_range"),
                format!("{lo}..{hi}"),
                "holds no positive multiple of the spacing: choose a smaller spacing or a longer range",
            ));
        }
        if count > Rational::from_integer(MOST.into()) {
            return Err(Error::input(
                &format!("{field}_step"),
                step,
                "choose a larger spacing: there are millions of multiples",
            ));
        }
        let mut all = vec![first];
        while all.last().is_some_and(|value| *value < last) {
            let next = all[all.len() - 1].clone() + Rational::from_integer(1.into());
            all.push(next);
        }
        Ok(all.iter().map(|n| n * step).collect())
    }

    /// The vertical axis: its range, its spacing, and Λ2/Λ1 where it is h2; none for one force.
    fn second(&self) -> Result<Option<Second<'_>>> {
        let by_ratio = self.rho_range.as_ref().zip(self.rho_step.as_ref());
        let by_step = self.h2_range.as_ref().zip(self.h2_step.as_ref());
        match (by_ratio, by_step) {
            (None, None) if self.is_of_one_force() => Ok(None),
            (Some((range, step)), None) if self.lambda2.is_none() => Ok(Some((range, step, None))),
            (None, Some((range, step))) => {
                let lambda2 = self.lambda2.as_ref().unwrap_or(&self.lambda1);
                let wrong =
                    || Error::input("lambda2", lambda2, "choose a positive rational multiple of lambda1");
                let ratio = Laurent::ratio(lambda2, &self.lambda1).ok_or_else(wrong)?;
                if ratio.sign() == Sign::Positive {
                    Ok(Some((range, step, Some(ratio))))
                } else {
                    Err(wrong())
                }
            }
            _ => Err(Self::without_second()),
        }
    }

    fn without_second() -> Error {
        let remedy = "two forces have a second axis: add --rho-range and --rho-step (of lambda2/lambda1), or --h1-range, --h2-range and --step in place of those of h";
        Error::missing("rho_range", remedy)
    }

    /// Whether nothing is said about a second force.
    fn is_of_one_force(&self) -> bool {
        let CompareMethods { rho_range, rho_step, h2_range, h2_step, lambda2, .. } = self;
        [rho_range, h2_range].iter().all(|range| range.is_none())
            && [rho_step, h2_step].iter().all(|step| step.is_none())
            && lambda2.is_none()
    }

    /// The steps, and the ratios or the steps of the slow force.
    ///
    /// # Errors
    /// A spacing that is not positive, a range without a positive multiple; neither or both of ratios and
    /// slow steps.
    pub fn grid(&self) -> Result<[Vec<Rational>; 2]> {
        let ups = match self.second()? {
            Some((range, step, by_step)) => {
                Self::multiples(if by_step.is_some() { "h2" } else { "rho" }, range, step)?
            }
            None => vec![Rational::default()],
        };
        Ok([Self::multiples("h", &self.h_range, &self.h_step)?, ups])
    }

    /// Λ2/Λ1 of one step in units of which both forces have the same: ρ itself, or (h2/h1)² Λ2/Λ1; 0 of one
    /// force.
    ///
    /// # Errors
    /// As [`grid`](Self::grid).
    pub fn ratio(&self) -> Result<impl Fn(&Rational, &Rational) -> Rational + Sync> {
        let by_step = self.second()?.and_then(|(.., by_step)| by_step);
        Ok(move |h: &Rational, up: &Rational| match &by_step {
            None => up.clone(),
            Some(ratio) => (up / h) * (up / h) * ratio,
        })
    }

    /// h² Λ1 of each step, of a word of so many evaluations.
    pub fn squares(&self, steps: &[Rational], evaluations: u64) -> Vec<Laurent> {
        let times = Rational::from_integer(if self.by_cost { evaluations } else { 1 }.into());
        let square = |h: &Rational| h * h * &times * &times;
        steps.iter().map(|h| &self.lambda1 * &Laurent::from_rational(square(h))).collect()
    }

    /// The words, each with its evaluations.
    fn words(&self) -> Result<Vec<(String, u64, Integrator)>> {
        let one = |name: String| {
            let word = Integrator::word(&name)?;
            if self.is_of_one_force() && word.names_forces() {
                return Err(Self::without_second());
            }
            Ok((name, word.cost().total().max(1), Integrator::of(word)))
        };
        self.names().into_iter().map(one).collect()
    }
}

/// The row of an integrator, so many points of a map, each with so much area.
fn record(points: u64, cell: Rational, by_cost: bool) -> Record<'static, Side> {
    let area = move |side: &Side, what: Bounded| {
        Cell::exact(&(Rational::from_integer(side.count(what).into()) * &cell))
    };
    let area_too = area.clone();
    let share = move |side: &Side| Cell::Float(side.count(Bounded::Stable) as f64 / points as f64);
    let record = Record::new()
        .field(Column::new("method").left(), |side: &Side| side.name.as_str().into())
        .says(TEXT, "A name or a word, as it was asked for.")
        .field(Column::new("stable"), |side| side.count(Bounded::Stable).into())
        .says(COUNT, "Points with bounded powers; of words decided exactly.")
        .field(Column::new("unstable"), |side| side.count(Bounded::Unstable).into())
        .says(COUNT, "Points without; edges of words count here unless the propagator is 1 or -1.")
        .field(Column::new("edge"), |side| side.count(Bounded::Edge).into())
        .says(COUNT, "Points of words with exact flows or filters nearer to an edge than bits tell, or on one of which no theorem says so.")
        .field(Column::new("share").in_words("share that is stable"), share)
        .says(ROUNDED, "stable over points; the nearest double.")
        .field(Column::new("stable_area").in_words("stable area"), move |side| {
            area(side, Bounded::Stable)
        })
        .says(EXACT, "stable times h_step times rho_step.")
        .field(Column::new("unstable_area").in_words("unstable area"), move |side| {
            area_too(side, Bounded::Unstable)
        })
        .says(EXACT, "unstable times h_step times rho_step.");
    if !by_cost {
        return record;
    }
    record
        .field(Column::new("evaluations"), |side| side.evaluations.into())
        .says(POSITIVE, "With by_cost: evaluations, gradients, solves and exact flows in a step; its steps are so many times those of the grid.")
        .field(Column::new("unstable_share").in_words("unstable share"), move |side| {
            Cell::Float(side.count(Bounded::Unstable) as f64 / points as f64)
        })
        .says(ROUNDED, "With by_cost: unstable over points; the nearest double.")
}

impl Question for CompareMethods {
    const NAME: &'static str = "compare-methods";
    type Answer = Vec<Side>;

    fn schema() -> Option<Schema> {
        let methods = Shape::List(&Shape::Object(|| {
            let keys = |by_cost| record(0, Rational::default(), by_cost).keys();
            keys(true).or_only(&keys(false))
        }));
        let body = Keys::new().key("points", POSITIVE, "Points of each map.").key(
            "methods",
            methods,
            "The integrators, in the order in which they were asked for; with by_cost the least unstable share first.",
        );
        Some(Schema::new("Integrators side by side over the same steps and ratios of stiffness", body))
    }

    fn answer(&self, work: &Work) -> Result<Vec<Side>> {
        if self.lambda1.sign() != Sign::Positive {
            return Err(Error::input("lambda1", &self.lambda1, "the stiffness must be positive"));
        }
        let names = self.names();
        if names.len() > MOST_METHODS {
            return Err(Error::input("methods", names.len(), format!("choose {MOST_METHODS} at most")));
        }
        let methods = self.words()?;
        let [steps, ups] = self.grid()?;
        let (ratio, by_ratio) = (self.ratio()?, self.h2_range.is_none());
        let degree: u64 = methods.iter().map(|(.., own)| own.degree()).fold(0, u64::saturating_add);
        let cost = degree.saturating_mul(steps.len() as u64).saturating_mul(ups.len() as u64);
        let most = work.budget.unwrap_or(MOST);
        if cost > most {
            let what = format!("these maps cost {cost} powers of a force, the budget is {most}");
            return Err(Error::budget(what, cost).or("choose larger spacings"));
        }
        let bar = work.count((methods.len() * ups.len()) as u64, "rows");
        let side = |(name, evaluations, integrator): (String, u64, Integrator)| {
            let squares = self.squares(&steps, evaluations);
            let row = |up: &Rational| {
                let boundeds = if by_ratio {
                    integrator.along(up, &squares)
                } else {
                    let points = steps.iter().zip(&squares);
                    points
                        .flat_map(|(h, s)| integrator.along(&ratio(h, up), std::slice::from_ref(s)))
                        .collect()
                };
                bar.advance(1);
                Ok(boundeds)
            };
            let rows = try_map(&ups, row)?;
            Ok(Side { name, integrator, evaluations, rows })
        };
        let mut sides = methods.into_iter().map(side).collect::<Result<Vec<Side>>>()?;
        if self.by_cost {
            sides.sort_by_key(|side| side.count(Bounded::Unstable));
        }
        Ok(sides)
    }

    fn show(&self, sides: &Vec<Side>) -> Document {
        let by = |second: Option<(_, &Rational, _)>| {
            second.map_or_else(|| self.h_step.clone(), |(_, step, _)| &self.h_step * step)
        };
        let cell = self.second().map_or_else(|_| Rational::default(), by);
        let points = sides.first().map_or(0, |side| side.rows.iter().map(Vec::len).sum::<usize>() as u64);
        let table = record(points, cell, self.by_cost).table(
            "methods",
            "Integrators side by side, over the same steps",
            sides,
        );
        let plane = match (&self.rho_range, &self.h2_range) {
            (Some(_), _) => "(h, lambda2/lambda1)",
            (_, Some(_)) => "(h1, h2)",
            _ => "h",
        };
        let paid = if self.by_cost { "; a word of n evaluations takes n times each step" } else { "" };
        let line = format!("{points} points {plane} for each of {} integrators{paid}", sides.len());
        let shown: &[&str] = if self.by_cost {
            &["method", "evaluations", "unstable_share", "stable", "unstable", "edge"]
        } else {
            &["method", "stable", "unstable", "edge", "stable_area", "unstable_area"]
        };
        let people = table.only(shown);
        Document::new(Self::NAME).entry("points", points).rows(table).for_people(people).summary(&[line])
    }

    fn figure(&self, sides: &Vec<Side>, _: &Work) -> Result<Option<Figure>> {
        let [steps, ratios] = self.grid()?.map(|all| all.iter().map(to_f64).collect::<Vec<_>>());
        let Some((_, second, by_step)) = self.second()? else {
            let remedy = "words of one force have no plane of steps to draw: add --rho-range and --rho-step, which give a second force beside theirs";
            return Err(Error::missing("rho_range", remedy));
        };
        let (across, up, by_step) = (to_f64(&self.h_step), to_f64(second), by_step.is_some());
        let ends = |all: &[f64], step: f64| (all[0] - step / 2.0, all[all.len() - 1] + step / 2.0);
        let ((left, right), (low, high)) = (ends(&steps, across), ends(&ratios, up));
        let columns = if (5..=6).contains(&sides.len()) { 3 } else { sides.len().min(4) };
        let mut is_named = [false; 2];
        let mut panel = |side: &Side| {
            let x = if by_step { "*h*_1" } else { "*h*" };
            let x = if self.by_cost { format!("{x} per evaluation") } else { x.into() };
            let x = Axis::linear(&x, left, right).of_time();
            let y = if by_step {
                Axis::linear("*h*_2", low, high).of_time()
            } else {
                Axis::linear("*Λ*_2/*Λ*_1", low, high)
            };
            let share = 100.0 * side.count(Bounded::Stable) as f64 / (steps.len() * ratios.len()) as f64;
            let panel = Panel::new(x, y).titled(&format!("{}: {share:.1} % stable", literal(&side.name)));
            let kinds = [
                (Bounded::Unstable, palette::HYPERBOLIC, "unstable"),
                (Bounded::Edge, palette::PARABOLIC, "on an edge"),
            ];
            kinds.into_iter().zip(&mut is_named).fold(panel, |panel, ((kind, colour, name), is_named)| {
                let mut cells = Cells::new([steps[0], ratios[0]], [across, up], vec![colour]);
                let all = (0u32..)
                    .zip(&side.rows)
                    .flat_map(|(j, row)| (0u32..).zip(row).map(move |(i, bounded)| (i, j, *bounded)));
                let found: Vec<_> = all.filter(|(.., bounded)| *bounded == kind).collect();
                found.iter().for_each(|&(i, j, _)| cells.push(i, j, 0));
                if found.is_empty() {
                    return panel;
                }
                // The first panel that has it names it for all.
                let layer = Layer::cells(cells);
                panel.with(if std::mem::replace(is_named, true) { layer } else { layer.labelled(name) })
            })
        };
        let rows = sides.len().div_ceil(columns) as f64;
        let sheet = Figure::new(20.0 + 58.0 * columns as f64, 16.0 + 58.0 * rows)
            .named("Integrators side by side")
            .columns(columns);
        let sheet = sides.iter().fold(sheet, |sheet, side| sheet.with(panel(side).legend(Place::Above)));
        let mut foot = Foot::default().value("*Λ*_1", &self.lambda1);
        if by_step {
            foot = foot.value("*Λ*_2", self.lambda2.as_ref().unwrap_or(&Laurent::from_integer(1)));
        }
        Ok(Some(sheet.footed(&foot)))
    }
}
