//! Integrators side by side: their verdicts over the same grid of steps and stiffness ratios.

use plot::{Axis, Cells, Figure, Foot, Layer, Panel, Place, literal, palette};

use super::asking::{Question, Work, question};
use super::field::flag;
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{COUNT, EXACT, Keys, POSITIVE, ROUNDED, Schema, Shape, TEXT};
use crate::report::table::{Cell, Column};
use number::error::{Error, Result};
use number::parallel::try_map;
use number::rational::to_f64;
use number::{ExactSign, Laurent, Rational, Sign};
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
        #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
        lambda1: Laurent = "1",
        /// The closed range of steps, with --methods.
        #[arg(long, value_name = "LO..HI", required = false, requires = "methods", value_parser = flag::<(Rational, Rational)>)]
        h_range: (Rational, Rational) | h1_range,
        /// The spacing of steps.
        #[arg(long, value_name = "D", required = false, requires = "methods", value_parser = flag::<Rational>)]
        h_step: Rational | step1 | step,
        /// The closed range of lambda2/lambda1, with --methods.
        #[arg(long, value_name = "LO..HI", requires = "methods", value_parser = flag::<(Rational, Rational)>)]
        rho_range: Option<(Rational, Rational)>,
        /// The spacing of lambda2/lambda1.
        #[arg(long, value_name = "R", requires = "methods", value_parser = flag::<Rational>)]
        rho_step: Option<Rational>,
        /// The stiffness of the slow force, that of the fast one if not given; with h2.
        #[arg(skip)]
        lambda2: Option<Laurent>,
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

    /// The vertical axis: its range, its spacing, and Λ2/Λ1 where it is h2.
    fn second(&self) -> Result<(&(Rational, Rational), &Rational, Option<Rational>)> {
        let by_ratio = self.rho_range.as_ref().zip(self.rho_step.as_ref());
        let by_step = self.h2_range.as_ref().zip(self.h2_step.as_ref());
        match (by_ratio, by_step) {
            (Some((range, step)), None) if self.lambda2.is_none() => Ok((range, step, None)),
            (None, Some((range, step))) => {
                let lambda2 = self.lambda2.as_ref().unwrap_or(&self.lambda1);
                let wrong =
                    || Error::input("lambda2", lambda2, "choose a positive rational multiple of lambda1");
                let ratio = Laurent::ratio(lambda2, &self.lambda1).ok_or_else(wrong)?;
                if ratio.sign() == Sign::Positive { Ok((range, step, Some(ratio))) } else { Err(wrong()) }
            }
            _ => Err(Error::missing(
                "rho_range",
                "give a range and spacing of lambda2/lambda1, or of h2 (lambda2 goes with h2)",
            )),
        }
    }

    /// The steps, and the ratios or the steps of the slow force.
    ///
    /// # Errors
    /// A spacing that is not positive, a range without a positive multiple; neither or both of ratios and
    /// slow steps.
    pub fn grid(&self) -> Result<[Vec<Rational>; 2]> {
        let (range, step, by_step) = self.second()?;
        Ok([
            Self::multiples("h", &self.h_range, &self.h_step)?,
            Self::multiples(if by_step.is_some() { "h2" } else { "rho" }, range, step)?,
        ])
    }

    /// Λ2/Λ1 of one step in units of which both forces have the same: ρ itself, or (h2/h1)² Λ2/Λ1.
    ///
    /// # Errors
    /// As [`grid`](Self::grid).
    pub fn ratio(&self) -> Result<impl Fn(&Rational, &Rational) -> Rational + Sync> {
        let (.., by_step) = self.second()?;
        Ok(move |h: &Rational, up: &Rational| match &by_step {
            None => up.clone(),
            Some(ratio) => (up / h) * (up / h) * ratio,
        })
    }

    /// h² Λ1 of each step.
    pub fn squares(&self, steps: &[Rational]) -> Vec<Laurent> {
        steps.iter().map(|h| &self.lambda1 * &Laurent::from_rational(h * h)).collect()
    }
}

/// The row of an integrator, so many points of a map, each with so much area.
fn record(points: u64, cell: Rational) -> Record<'static, Side> {
    let area = move |side: &Side, what: Bounded| {
        Cell::exact(&(Rational::from_integer(side.count(what).into()) * &cell))
    };
    let area_too = area.clone();
    let share = move |side: &Side| Cell::Float(side.count(Bounded::Stable) as f64 / points as f64);
    Record::new()
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
        .says(EXACT, "unstable times h_step times rho_step.")
}

impl Question for CompareMethods {
    const NAME: &'static str = "compare-methods";
    type Answer = Vec<Side>;

    fn schema() -> Option<Schema> {
        let methods = Shape::List(&Shape::Object(|| record(0, Rational::default()).keys()));
        let body = Keys::new().key("points", POSITIVE, "Points of each map.").key(
            "methods",
            methods,
            "The integrators, in the order in which they were asked for.",
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
        let methods = names.iter().map(|name| Integrator::named(name)).collect::<Result<Vec<_>>>()?;
        let [steps, ups] = self.grid()?;
        let (ratio, by_ratio) = (self.ratio()?, self.rho_range.is_some());
        let degree: u64 = methods.iter().map(Integrator::degree).fold(0, u64::saturating_add);
        let cost = degree.saturating_mul(steps.len() as u64).saturating_mul(ups.len() as u64);
        let most = work.budget.unwrap_or(MOST);
        if cost > most {
            let what = format!("these maps cost {cost} powers of a force, the budget is {most}");
            return Err(Error::budget(what, cost).or("choose larger spacings"));
        }
        let squares = self.squares(&steps);
        let bar = work.count((methods.len() * ups.len()) as u64, "rows");
        let side = |(name, integrator): (&String, Integrator)| {
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
            Ok(Side { name: name.clone(), integrator, rows })
        };
        names.iter().zip(methods).map(side).collect()
    }

    fn show(&self, sides: &Vec<Side>) -> Document {
        let cell = self.second().map_or_else(|_| Rational::default(), |(_, step, _)| &self.h_step * step);
        let points = sides.first().map_or(0, |side| side.rows.iter().map(Vec::len).sum::<usize>() as u64);
        let table =
            record(points, cell).table("methods", "Integrators side by side, over the same steps", sides);
        let plane = if self.rho_range.is_some() { "(h, lambda2/lambda1)" } else { "(h1, h2)" };
        let line = format!("{points} points {plane} for each of {} integrators", sides.len());
        let shown =
            ["method", "stable", "unstable", "edge", "stable_area", "unstable_area"].map(String::from);
        let people = table.choose(&shown).expect("columns of the table");
        Document::new(Self::NAME).entry("points", points).rows(table).for_people(people).summary(&[line])
    }

    fn figure(&self, sides: &Vec<Side>, _: &Work) -> Result<Option<Figure>> {
        let [steps, ratios] = self.grid()?.map(|all| all.iter().map(to_f64).collect::<Vec<_>>());
        let (_, second, by_step) = self.second()?;
        let (across, up, by_step) = (to_f64(&self.h_step), to_f64(second), by_step.is_some());
        let ends = |all: &[f64], step: f64| (all[0] - step / 2.0, all[all.len() - 1] + step / 2.0);
        let ((left, right), (low, high)) = (ends(&steps, across), ends(&ratios, up));
        let columns = if (5..=6).contains(&sides.len()) { 3 } else { sides.len().min(4) };
        let panel = |side: &Side| {
            let x = Axis::linear(if by_step { "*h*_1" } else { "*h*" }, left, right).of_time();
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
            kinds.into_iter().fold(panel, |panel, (kind, colour, name)| {
                let mut cells = Cells::new([steps[0], ratios[0]], [across, up], vec![colour]);
                let all = (0u32..)
                    .zip(&side.rows)
                    .flat_map(|(j, row)| (0u32..).zip(row).map(move |(i, bounded)| (i, j, *bounded)));
                let found: Vec<_> = all.filter(|(.., bounded)| *bounded == kind).collect();
                found.iter().for_each(|&(i, j, _)| cells.push(i, j, 0));
                if found.is_empty() { panel } else { panel.with(Layer::cells(cells).labelled(name)) }
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
