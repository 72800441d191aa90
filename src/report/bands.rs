//! Boxes in which every ratio is unstable, as a document and as a figure.

use super::decimal;
use super::document::Document;
use super::record::Record;
use super::table::{Cell as Value, Column};
use crate::band::{Bands, Cell};
use crate::number::{Laurent, rational};

const CAPTION: &str = "Boxes of steps in which every ratio $h_2/h_1$ is unstable";

/// The document `kickdrift/bands/1`. The caller adds the input.
pub fn document(bands: &Bands) -> Document {
    let share = bands.share();
    let area = &bands.window.area() * &Laurent::from_rational(share.clone());
    let table = record(bands).table(
        "boxes",
        "Boxes of steps in which every ratio h2/h1 is unstable",
        &bands.certified,
    );
    let [(lo, hi), (area_lo, area_hi)] = [rational::enclose_f64(&share), area.enclose_f64()];
    let ends = |lo: f64, hi: f64| serde_json::json!({"lo": lo, "hi": hi});
    Document::new("bands")
        .entry("certified", bands.certified.len())
        .entry("open", bands.open.len())
        .entry("tried", bands.tried)
        .entry("share.value", ends(lo, hi))
        .entry("share.exact", share.to_string())
        .entry("area.value", ends(area_lo, area_hi))
        .entry("area.exact", area.to_string())
        .rows(table.captioned(CAPTION))
        .summary(&lines(bands, lo, area_lo))
}

fn lines(bands: &Bands, share: f64, area: f64) -> Vec<String> {
    vec![
        format!("{:.4} % of the window: every ratio h2/h1 there is unstable, rational or not", 100.0 * share),
        format!("  area         {}, exact in JSON", decimal::few(area, 6)),
        format!(
            "  boxes        {} certified, {} left open, {} tried",
            bands.certified.len(),
            bands.open.len(),
            bands.tried
        ),
        "  elsewhere    nothing is claimed: it may be stable or not".into(),
    ]
}

/// The record of a box.
fn record(bands: &Bands) -> Record<'_, Cell> {
    let mut record = Record::new();
    for (step, key) in ["h1", "h2"].into_iter().enumerate() {
        let column = |end: &str, words: &str| {
            let formula = format!("$h_{}$ {words}", step + 1);
            Column::new(&format!("{key}_{end}")).titled(&format!("{key} {words}"), &formula)
        };
        let ends = move |cell: &Cell| bands.window.range(cell, step);
        record = record
            .field(column("lower", "from"), move |cell| Value::exact(ends(cell).0))
            .field(column("upper", "to"), move |cell| Value::exact(ends(cell).1));
    }
    let share = Column::new("share").in_words("share of the window");
    record.field(share, |cell| Value::exact(cell.share()))
}

#[cfg(feature = "figure")]
pub use drawn::figure;

#[cfg(feature = "figure")]
mod drawn {
    use plot::palette::{Colour, HYPERBOLIC};
    use plot::{Axis, Cells, Figure, Foot, Layer, Panel, Place};

    use super::*;

    /// Pixels of a side.
    const SIDE: usize = 600;

    const UNDECIDED: Colour = Colour(0xd2, 0xd4, 0xd9);

    /// How much of each pixel some boxes cover.
    fn covered(cells: &[Cell]) -> Vec<f32> {
        let mut pixels = vec![0.0; SIDE * SIDE];
        for cell in cells {
            let [x, y] = [0, 1].map(|step| {
                let length = SIDE as f64 * 0.5f64.powi(cell.depths[step] as i32);
                let from = cell.places[step] as f64 * length;
                (from, from + length)
            });
            for i in x.0 as usize..(x.1.ceil() as usize).min(SIDE) {
                for j in y.0 as usize..(y.1.ceil() as usize).min(SIDE) {
                    let part = |(lo, hi): (f64, f64), at: usize| hi.min(at as f64 + 1.0) - lo.max(at as f64);
                    pixels[i * SIDE + j] += (part(x, i) * part(y, j)) as f32;
                }
            }
        }
        pixels
    }

    /// The boxes in the plane of steps: a pixel is filled where half of it is certified, and grey elsewhere.
    pub fn figure(bands: &Bands) -> Figure {
        let ends = [0, 1].map(|step| bands.window.range(&Cell::WHOLE, step));
        let range = |step: usize| (ends[step].0.to_f64(), ends[step].1.to_f64());
        let [(x, width), (y, height)] =
            [0, 1].map(|step| (range(step).0, (range(step).1 - range(step).0) / SIDE as f64));
        let layer = |colour: Colour, is_in: &dyn Fn(usize) -> bool| {
            let mut cells = Cells::new([x + 0.5 * width, y + 0.5 * height], [width, height], vec![colour]);
            let places = (0..SIDE * SIDE).filter(|&place| is_in(place));
            places.for_each(|place| cells.push((place / SIDE) as u32, (place % SIDE) as u32, 0));
            Layer::cells(cells)
        };
        let certified = covered(&bands.certified);
        let axis = |label: &str, step: usize| Axis::linear(label, range(step).0, range(step).1).of_time();
        let share = rational::to_f64(&bands.share());
        let panel = Panel::new(axis("*h*_1", 0), axis("*h*_2", 1))
            .titled(&format!("Every ratio is unstable in {:.3} % of the window", 100.0 * share))
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
