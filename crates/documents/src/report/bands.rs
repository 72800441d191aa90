//! Where every ratio is unstable, as a document and as a figure.

use super::decimal;
use super::document::Document;
use super::record::Record;
use super::shape::{COUNT, ENCLOSURE, INTEGER, Keys, Shape};
use super::table::{Cell as Value, Column};
use clocks::band::{Bands, Sector};

const CAPTION: &str = "Sectors of steps in which every ratio $h_2/h_1$ is unstable: ratios from $r_1$ to $r_2$, and $h_1$ between the sides \
                       $h_1^-$ and $h_1^+$, each affine in the ratio and rounded into the sector";

/// Decimals of the sides on paper: a row of both sides fits a page.
const SHOWN: i32 = 10;

/// The document `kickdrift/bands/1`. The caller adds the input.
pub fn document(bands: &Bands) -> Document {
    let table = record().table(
        "sectors",
        "Sectors of steps in which every ratio h2/h1 is unstable",
        &bands.certified,
    );
    let narrowed: Vec<Sector> = bands.certified.iter().map(narrowed).collect();
    let people = record().table(table.name(), table.caption(), &narrowed).captioned(CAPTION);
    let lines = lines(bands, bands.share().0, bands.area().0);
    counts().document(Document::new("bands"), bands).rows(table).for_people(people).summary(&lines)
}

/// A sector in the decimals of paper, its sides rounded to its inside; as it is where it is too thin for
/// that.
fn narrowed(sector: &Sector) -> Sector {
    let Some(unit) = u32::try_from(sector.decimals - SHOWN).ok().and_then(|n| 10i64.checked_pow(n)) else {
        return sector.clone();
    };
    let [lower, upper] = sector.sides;
    let sides = [
        lower.map(|end| end.div_euclid(unit) + i64::from(end.rem_euclid(unit) > 0)),
        upper.map(|end| end.div_euclid(unit)),
    ];
    let is_open = sides[0].iter().zip(&sides[1]).all(|(lower, upper)| lower < upper);
    if is_open { Sector { sides, decimals: SHOWN, ..sector.clone() } } else { sector.clone() }
}

/// The keys of the document.
pub fn keys() -> Keys {
    let says = "By curves and ratios; no two overlap. Every pair of steps in one, edges included, is unstable with exponential growth: ratios h2/h1 of a range, and h1 between two sides, each affine in the ratio.";
    counts().keys().key("sectors", Shape::List(&Shape::Object(|| record().keys())), says)
}

/// What is certified.
fn counts() -> Record<'static, Bands> {
    Record::new()
        .json("certified", |bands: &Bands| (bands.certified.len() as u64).into())
        .says(COUNT, "Sectors that are proven.")
        .json("open", |bands| bands.open.into())
        .says(COUNT, "Ranges of ratios of a tongue that are left to try.")
        .json("tried", |bands| bands.tried.into())
        .says(COUNT, "Ranges of ratios of a tongue that were tried.")
        .json("share", |bands| bands.share().into())
        .says(ENCLOSURE, "The share of the window that is certified.")
        .json("area", |bands| bands.area().into())
        .says(ENCLOSURE, "The area that is certified.")
}

/// A ratio of steps, whole or a fraction.
const RATIO: Shape = Shape::Plain(r#"{"type": "string", "pattern": "^[0-9]+(/[0-9]+)?$"}"#);
/// Decimal digits.
const DIGITS: Shape = Shape::Plain(r#"{"type": "string", "pattern": "^[0-9]+([.][0-9]+)?$"}"#);

fn lines(bands: &Bands, share: f64, area: f64) -> Vec<String> {
    vec![
        format!(
            "{} % of the window: every ratio h2/h1 there is unstable, rational or not",
            decimal::few(100.0 * share, 6)
        ),
        format!("  area         {}", decimal::few(area, 6)),
        format!(
            "  sectors      {} certified, {} left open, {} tried",
            bands.certified.len(),
            bands.open,
            bands.tried
        ),
        "  elsewhere    nothing is claimed: it may be stable or not".into(),
    ]
}

/// The record of a sector.
fn record() -> Record<'static, Sector> {
    let ends = ["from", "to"];
    let mut record = Record::new();
    let says = [
        "a of the curve (a, b) of the tongue: at the ratio p/q the growing solution makes a p + b q half turns a period.",
        "b of the curve.",
    ];
    for (k, (name, says)) in ["a", "b"].into_iter().zip(says).enumerate() {
        record = record
            .field(Column::math(name, name), move |sector: &Sector| Value::Integer(sector.family[k]))
            .says(INTEGER, says);
    }
    let ratios = ["least", "largest"];
    for (k, end) in ends.into_iter().enumerate() {
        let column = Column::new(&format!("ratio_{end}"));
        let column = column.titled(&format!("h2/h1 {end}"), &format!("$r_{}$", k + 1));
        record = record.field(column, move |sector| {
            let (p, q) = sector.ratios[k];
            Value::exact(if q == 1 { p.to_string() } else { format!("{p}/{q}") })
        });
        record = record.says(RATIO, format!("The {} ratio h2/h1.", ratios[k]));
    }
    for (side, name) in ["lower", "upper"].into_iter().enumerate() {
        for (k, end) in ends.into_iter().enumerate() {
            let column = Column::new(&format!("{name}_{end}"));
            let words = format!("{name} h1 {end}");
            let column = column.titled(&words, &format!("$h_1^{}(r_{})$", ["-", "+"][side], k + 1));
            record = record.field(column, move |sector| {
                Value::exact(decimal::shifted(sector.sides[side][k], sector.decimals))
            });
            record =
                record.says(DIGITS, format!("h1 on the {name} side at the {} ratio, exactly.", ratios[k]));
        }
    }
    record
}

pub use drawn::figure;

mod drawn {
    use plot::palette::{Colour, HYPERBOLIC};
    use plot::{Axis, Cells, Figure, Foot, Layer, Panel, Place};

    use super::*;

    /// Pixels of a side, and lines of constant h1 in each.
    const SIDE: usize = 600;
    const LINES: usize = 4;

    const UNDECIDED: Colour = Colour(0xd2, 0xd4, 0xd9);

    /// About how much of each pixel some sectors cover, from the lines of constant h1 in it.
    fn covered(sectors: &[Sector], [(x, width), (y, height)]: [(f64, f64); 2]) -> Vec<f32> {
        let mut pixels = vec![0.0; SIDE * SIDE];
        let spacing = width / LINES as f64;
        for sector in sectors {
            let unit = 0.1f64.powi(sector.decimals);
            let [lower, upper] = sector.sides.map(|side| side.map(|n| n as f64 * unit));
            let [from, to] = sector.ratios.map(|(p, q)| p as f64 / q as f64);
            let line = |h1: f64| (h1 - x) / spacing - 0.5;
            let first = line(lower[0].min(lower[1])).ceil().max(0.0) as usize;
            let last = line(upper[0].max(upper[1])).floor().min((SIDE * LINES) as f64 - 1.0);
            for n in first..(last + 1.0).max(0.0) as usize {
                let h1 = x + (n as f64 + 0.5) * spacing;
                // Of shares 0 to 1 of the ratios those at which h1 is between both sides.
                let (mut begin, mut end) = (0f64, 1f64);
                for (side, sign) in [(lower, 1.0), (upper, -1.0)] {
                    let [at_first, at_last] = side.map(|end| sign * (h1 - end));
                    let zero = at_first / (at_first - at_last);
                    match (at_first >= 0.0, at_last >= 0.0) {
                        (false, false) => end = begin,
                        (true, false) => end = end.min(zero),
                        (false, true) => begin = begin.max(zero),
                        (true, true) => {}
                    }
                }
                let place = |share: f64| ((from + share * (to - from)) * h1 - y) / height;
                let (lo, hi) = (place(begin).max(0.0), place(end).min(SIDE as f64));
                for j in lo as usize..(hi.ceil().max(0.0) as usize).min(SIDE) {
                    let part = (hi.min(j as f64 + 1.0) - lo.max(j as f64)).max(0.0);
                    pixels[n / LINES * SIDE + j] += part as f32 / LINES as f32;
                }
            }
        }
        pixels
    }

    /// The sectors in the plane of steps: a pixel is filled where half of it is certified, and grey
    /// elsewhere.
    pub fn figure(bands: &Bands) -> Figure {
        let ends = [0, 1].map(|step| bands.window.range(step));
        let range = |step: usize| (ends[step].0.to_f64(), ends[step].1.to_f64());
        let pixels = [0, 1].map(|step| (range(step).0, (range(step).1 - range(step).0) / SIDE as f64));
        let [(x, width), (y, height)] = pixels;
        let layer = |colour: Colour, is_in: &dyn Fn(usize) -> bool| {
            let mut cells = Cells::new([x + 0.5 * width, y + 0.5 * height], [width, height], vec![colour]);
            let places = (0..SIDE * SIDE).filter(|&place| is_in(place));
            places.for_each(|place| cells.push((place / SIDE) as u32, (place % SIDE) as u32, 0));
            Layer::cells(cells)
        };
        let certified = covered(&bands.certified, pixels);
        let axis = |label: &str, step: usize| Axis::linear(label, range(step).0, range(step).1).of_time();
        let panel = Panel::new(axis("*h*_1", 0), axis("*h*_2", 1))
            .titled(&format!(
                "Every ratio is unstable in {} % of the window",
                decimal::few(100.0 * bands.share().0, 4)
            ))
            .with(layer(UNDECIDED, &|n| certified[n] < 0.5).labelled("undecided"))
            .with(layer(HYPERBOLIC, &|n| certified[n] >= 0.5).labelled("every ratio unstable"))
            .legend(Place::Above);
        let [first, second] = bands.window.lambdas();
        let foot = Foot::default().value("*Λ*_1", first).value("*Λ*_2", second);
        Figure::new(130.0, 140.0)
            .named("Bands of steps in which every ratio is unstable")
            .with(panel)
            .footed(&foot)
    }
}
