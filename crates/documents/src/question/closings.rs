//! Where tongues close.

use super::asking::{Question, Work, question};
use super::ratios::Ratios;
use crate::report::decimal::outward;
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{
    DECIMAL, FLAG, GROUP, Keys, POSITIVE, POSITIVE_ENCLOSURE, RATIONAL_OR_NULL, Schema, Shape,
};
use crate::report::table::{Cell, Column};
use clocks::tongue::{self, Closing, Enclosure, Found, Labels, Search};
use number::parallel::try_map;
use number::{Error, Ratio, Rational, Result};

question! {
    /// The pairs (s, ρ) at which tongues of one ratio or of all are closed.
    args struct Closings {
        /// h2/h1 = p/q.
        ratio as "P/Q": Option<Ratio>,
        /// All coprime p + q up to this number.
        max_sum as "N": Option<u64>,
        /// Only these labels (with --ratio), as 4 or 1,3,7..9.
        m as "LIST": Option<Labels>,
        /// The closed range of rho = lambda2/lambda1, positive.
        rho_range as "LO..HI": (Rational, Rational) = "1/10000..100",
        /// Where p + q > 24: at how many rho, evenly spaced in ln rho, edges are computed to see where two
        /// cross.
        samples as "N": usize = "400",
        /// Significant digits of s and rho.
        digits as "N": u32 = "25",
    }
}

/// Significant digits unless others are asked for: the boxes are known to 2^-100.
pub const DIGITS: u32 = 25;

const CAPTION: &str =
    "Closed tongues, where $Q = \\pm I$, in $s = h_1^2 \\Lambda_1$ and $\\rho = \\Lambda_2/\\Lambda_1$";

/// Searches cost p + q squared for each of the samples.
const MOST_SUM: u64 = 200;
/// Steps of a search unless a budget says otherwise: all ratios up to the largest sum at ten times the usual
/// samples. And the seconds of one.
const MOST_COST: u64 = 1_000_000_000_000;
const STEP: f64 = 3e-7;
const MOST_SAMPLES: usize = 1_000_000;
/// The boxes are known to 2^-100 of their centres.
const MOST_DIGITS: u32 = 28;

impl Closings {
    /// The ratios that are searched.
    ///
    /// # Errors
    /// Neither one ratio nor a sum, a sum out of range.
    pub fn ratios(&self) -> Result<Ratios> {
        Ratios::of(self.ratio.map(Ratios::One), self.max_sum)?.within(MOST_SUM)
    }

    fn words(&self) -> String {
        self.ratios().map(|ratios| ratios.words()).unwrap_or_default()
    }

    /// (p + q)² for each of the samples.
    fn cost(&self, ratio: Ratio) -> u64 {
        ratio.kicks().saturating_pow(2).saturating_mul(self.samples as u64)
    }

    fn of_ratio(&self, ratio: Ratio) -> Result<Found> {
        let search = Search { m: None, rho: self.rho_range.clone(), samples: self.samples };
        match &self.m {
            None => tongue::closings(ratio, &search),
            Some(labels) => tongue::closings_of(ratio, &labels.0, &search),
        }
    }
}

impl Question for Closings {
    const NAME: &'static str = "closings";
    const EXAMPLES: &'static [&'static str] =
        &["closings --max-sum 8", "closings --ratio 5/3 --format latex --digits 8"];
    const USAGE: Option<&'static str> = Some("(--ratio <P/Q> | --max-sum <N>)");
    type Answer = Vec<Found>;

    fn schema() -> Option<Schema> {
        let says = "By p + q, p, m, rho. The box s x rho holds exactly one common zero of the two entries, and it is this tongue's.";
        let body = Keys::new().key("closings", Shape::List(&Shape::Object(closing_keys)), says).key(
            "ratios",
            Shape::List(&Shape::Object(|| ratio_record().keys())),
            "The ratios searched.",
        );
        let title =
            "Closed tongues: pairs (s, rho) at which both edges of a tongue are one point and Q = I or -I";
        // One ratio or all up to a sum, and a range of rho above 0.
        let rules = r#"{"allOf": [{"properties": {"input": {
            "oneOf": [{"required": ["ratio"]}, {"required": ["max_sum"]}],
            "properties": {"rho_range": {"pattern": "^[0-9/]+[.][.][0-9/]+$"}}
        }}}]}"#;
        Some(Schema::new(title, body).rules(rules))
    }

    fn answer(&self, work: &Work) -> Result<Vec<Found>> {
        let ratios = self.ratios()?;
        if matches!(ratios, Ratios::UpTo(_)) && self.m.is_some() {
            return Err(Error::input(
                "m",
                "given with --max-sum",
                "labels belong to one ratio: give --ratio P/Q, or leave --m out",
            ));
        }
        if !(2..=MOST_SAMPLES).contains(&self.samples) {
            return Err(Error::input("samples", self.samples, format!("choose 2 to {MOST_SAMPLES}")));
        }
        if !(1..=MOST_DIGITS).contains(&self.digits) {
            return Err(Error::input("digits", self.digits, format!("choose 1 to {MOST_DIGITS}")));
        }
        let list = ratios.list();
        let cost = list.iter().map(|ratio| self.cost(*ratio)).fold(0, u64::saturating_add);
        if cost > work.budget.unwrap_or(MOST_COST) {
            let name = format!("the closings of {} cost about {cost} steps of a search", ratios.words());
            return Err(Error::budget(name, cost).or("choose fewer samples, or ratios of smaller numbers"));
        }
        work.announce(&format!("the closings of {}", ratios.words()), cost as f64 * STEP);
        let bar = work.count(list.len() as u64, "ratios");
        try_map(&list, |&ratio| {
            let found = self.of_ratio(ratio);
            bar.advance(1);
            found
        })
    }

    fn show(&self, found: &Vec<Found>) -> Document {
        let ((lo, hi), digits) = (&self.rho_range, self.digits);
        let what = format!("{}, rho in {lo}..{hi}", self.words());
        let closings = || found.iter().flat_map(|found| &found.closings);
        let table = |short| {
            let record = record(digits, short);
            record.table("closings", "Closed tongues: Q = I or -I", closings()).captioned(CAPTION)
        };
        Document::new(Self::NAME)
            .entry("closings", record(digits, false).all(closings()))
            .entry("ratios", ratio_record().all(found))
            .long_rows(table(false))
            .for_people(table(true))
            .summary(&lines(found, &what))
    }
}

/// The entries of a ratio.
fn ratio_record() -> Record<'static, Found> {
    Record::new()
        .json("p", |found: &Found| found.ratio.p().into())
        .says(POSITIVE, "Fast kicks a period: h2/h1 = p/q in lowest terms.")
        .json("q", |found| found.ratio.q().into())
        .says(POSITIVE, "Slow kicks a period.")
        .json("complete", |found| found.complete.into())
        .says(FLAG, "Whether elimination proves that the range of rho holds no others; false says nothing.")
}

/// The keys of a closing.
fn closing_keys() -> Keys {
    let keys = ["s.decimal", "rho.decimal"].into_iter();
    keys.fold(record(DIGITS, false).keys(), |keys, path| keys.key(path, GROUP, "Decimals around the value."))
}

/// s or ρ of a closing: its enclosure, and its value where that is rational.
type Side = fn(&Closing) -> (&Enclosure, Option<&Rational>);

/// The row of a closing; in the short form s and ρ are one column each, exact where they are rational.
fn record(digits: u32, short: bool) -> Record<'static, Closing> {
    let mut record = Record::new()
        .field(Column::math("p", "p"), |closing: &Closing| closing.ratio.p().into())
        .says(POSITIVE, "Fast kicks a period: h2/h1 = p/q in lowest terms.")
        .field(Column::math("q", "q"), |closing| closing.ratio.q().into())
        .says(POSITIVE, "Slow kicks a period.")
        .field(Column::math("m", "m"), |closing| closing.m.into())
        .says(POSITIVE, "The tongue's label.");
    let sides: [(&str, &str, &str, Side); 2] = [
        ("s", "s", "s = h1^2 lambda1.", |closing| (&closing.s, closing.exact.as_ref().map(|(s, _)| s))),
        ("rho", "\\rho", "rho = lambda2/lambda1.", |closing| {
            (&closing.rho, closing.exact.as_ref().map(|(_, rho)| rho))
        }),
    ];
    for (key, formula, says, side) in sides {
        let column = Column::math(key, formula).enclosure();
        let exact = move |closing: &Closing| side(closing).1.map(Cell::exact).unwrap_or(Cell::Missing);
        let enclosed = move |closing: &Closing| Cell::from(side(closing).0.to_f64());
        if short {
            record = record.field(column, move |closing| match exact(closing) {
                Cell::Missing => enclosed(closing),
                exact => exact,
            });
            continue;
        }
        let ends = move |closing: &Closing| match side(closing) {
            (_, Some(x)) => outward(x, x, digits),
            (x, None) => outward(&x.lo, &x.hi, digits),
        };
        let titled = |part: &str, title: &str| Column::new(&format!("{key}_{part}")).titled(title, title);
        record = record
            .field(column, enclosed)
            .says(POSITIVE_ENCLOSURE, says)
            .at(&format!("{key}.exact"), titled("exact", "exact"), exact)
            .says(RATIONAL_OR_NULL, "The value, where s and rho are rational.")
            .at(&format!("{key}.decimal.lo"), titled("decimal_lo", "lo"), move |closing| {
                Cell::exact(&ends(closing)[0])
            })
            .says(DECIMAL, "Not above the value.")
            .at(&format!("{key}.decimal.hi"), titled("decimal_hi", "hi"), move |closing| {
                Cell::exact(&ends(closing)[1])
            })
            .says(DECIMAL, "Not below the value.");
    }
    record
        .field(Column::new("below_verlet").titled("s < 4", "$s < 4$"), |closing| closing.below_verlet.into())
        .says(FLAG, "Whether s < 4, the fast clock's Verlet limit.")
}

fn lines(found: &[Found], what: &str) -> Vec<String> {
    let closings = || found.iter().flat_map(|found| &found.closings);
    let count = closings().count();
    let exact = closings().filter(|closing| closing.exact.is_some()).count();
    let below = closings().filter(|closing| closing.below_verlet).count();
    let complete = found.iter().filter(|found| found.complete).count();
    let plural = if count == 1 { "" } else { "s" };
    vec![
        format!("{count} closed tongue{plural} of {what}"),
        format!("  rational     {exact}: s and rho known exactly"),
        format!("  below s = 4  {below}: the fast clock alone is stable there"),
        format!(
            "  complete     {complete} of {} ratios: elimination proves that there are no others",
            found.len()
        ),
    ]
}
