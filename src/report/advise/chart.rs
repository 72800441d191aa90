//! Advice drawn: the outer step across, each mode and pair of modes a row.

use crate::advise::{Advice, Answer, Row};
use crate::number::rational::to_f64;
use crate::report::figure::palette::{COEXISTENCE, Colour, GREY, HYPERBOLIC, INK, PARABOLIC};
use crate::report::figure::{Anchor, Axis, Figure, Layer, Note, Panel, Place, Shape, Stroke, Tick};

/// Half the height of a row.
const HALF: f64 = 0.34;

/// Safe, caution, unstable: from light to dark, so that grey print tells them apart; hatching tells them too.
const SAFE: Colour = Colour(0xcf, 0xec, 0xdf);
const CAUTION: Colour = Colour(0xf3, 0xb4, 0x7a);
const UNSTABLE: Colour = HYPERBOLIC;

/// One stretch of outer steps in a row.
struct Band {
    at: [f64; 2],
    row: f64,
}

impl Band {
    fn outline(&self) -> Vec<[f64; 2]> {
        let ([a, b], [lo, hi]) = (self.at, [self.row - HALF, self.row + HALF]);
        vec![[a, lo], [b, lo], [b, hi], [a, hi]]
    }

    /// Strokes rising (or falling) across, `pitch` apart.
    fn hatch(&self, pitch: f64, falls: bool) -> Vec<Vec<[f64; 2]>> {
        let [a, b] = self.at;
        let (lean, count) = (1.6 * pitch, ((b - a) / pitch).ceil() as usize + 2);
        let line = |k: usize| {
            let x = a - lean + k as f64 * pitch;
            // Cut at both ends of the stretch.
            let [p, q] = [(a - x) / lean, (b - x) / lean].map(|t| t.clamp(0.0, 1.0));
            let at = |t: f64| {
                [x + t * lean, self.row + (if falls { 1.0 - 2.0 * t } else { 2.0 * t - 1.0 }) * HALF]
            };
            (p < q).then(|| vec![at(p), at(q)])
        };
        (0..count.min(400)).filter_map(line).collect()
    }
}

/// What is known of the first scheme, drawn at its ratio; the other schemes' outer steps as lines.
pub fn figure(advice: &Advice, title: &str) -> Figure {
    let answer = &advice.schemes[0];
    let rows = answer.rows.len() + answer.pairs.len();
    let ends =
        answer.rows.iter().filter_map(|row| row.first.as_ref()).filter_map(|of| of.upper.or(Some(of.lower)));
    let outers: Vec<f64> = advice.schemes.iter().map(|answer| to_f64(answer.scheme.outer())).collect();
    let right = ends.map(|(_, hi)| hi).chain(outers.iter().copied()).fold(0.0, f64::max) * 1.12;
    let place = |i: usize| (rows - 1 - i) as f64;
    let [mut safe, mut caution, mut unstable, mut beyond] = [const { Vec::<Band>::new() }; 4];
    for (i, row) in answer.rows.iter().enumerate() {
        stretches(
            advice,
            answer,
            row,
            place(i),
            right,
            [&mut safe, &mut caution, &mut unstable, &mut beyond],
        );
    }
    let pitch = right / 90.0;
    let areas = |bands: &[Band], colour| Layer::areas(bands.iter().map(Band::outline).collect(), colour, 1.0);
    let hatch = |bands: &[Band], pitch, falls| {
        bands.iter().flat_map(|band| band.hatch(pitch, falls)).collect::<Vec<_>>()
    };
    let names = answer.rows.iter().map(|row| advice.modes[row.mode].name.clone());
    let pairs = answer.pairs.iter().map(|pair| pair.modes.map(|i| advice.modes[i].name.as_str()).join(" + "));
    let ticks =
        names.chain(pairs).enumerate().map(|(i, name)| Tick { at: place(i), label: Some(name) }).collect();
    // Above the rows there is room for two lines of labels.
    let top = rows as f64 + 0.6;
    let x = Axis::linear(&format!("outer step (fs), {}", ratio(answer)), 0.0, right);
    let mut panel = Panel::new(x, Axis::linear("", -0.7, top).ticks(ticks))
        .with(areas(&safe, SAFE).labelled("proven stable, all periods in the band"))
        .with(areas(&caution, CAUTION).labelled("the same, beyond T/3 (published drift)"))
        .with(Layer::lines(hatch(&caution, pitch, false), Stroke::THIN))
        .with(
            Layer::lines(hatch(&beyond, 1.5 * pitch, true), Stroke::THIN.in_colour(GREY))
                .labelled("not to be recommended"),
        )
        .with(areas(&unstable, UNSTABLE).labelled("unstable, proven"));
    let near: Vec<[f64; 2]> = answer
        .pairs
        .iter()
        .enumerate()
        .map(|(i, pair)| [pair.near, place(answer.rows.len() + i)])
        .filter(|at| at[0] < right)
        .collect();
    if !near.is_empty() {
        panel = panel.with(
            Layer::dots(near, Shape::Diamond, 4.0, PARABOLIC)
                .labelled("two modes may resonate (first order)"),
        );
    }
    for (i, (outer, answer)) in outers.iter().zip(&advice.schemes).enumerate() {
        let line = vec![vec![[*outer, -0.7], [*outer, top]]];
        let label =
            format!("{} fs: {}", crate::advise::unit::decimal(answer.scheme.outer()), answer.status.name());
        let (anchor, shift) = if *outer > 0.8 * right { (Anchor::End, -4.0) } else { (Anchor::Start, 4.0) };
        let height = rows as f64 + if i % 2 == 0 { 0.25 } else { -0.15 };
        let note = Note::new([*outer, height], &label).anchored(anchor, [shift, 0.0]).in_colour(INK);
        panel = panel.with(Layer::lines(line, Stroke::LINE)).note(note);
    }
    if let Some(safe) = answer.safe.as_ref().map(to_f64) {
        let line = vec![vec![[safe, -0.7], [safe, top]]];
        panel = panel.with(Layer::lines(line, Stroke::DASHED.in_colour(COEXISTENCE)).labelled("recommended"));
    }
    Figure::new(150.0, 54.0 + 9.0 * rows as f64).named(title).with(panel.legend(Place::Above))
}

fn ratio(answer: &Answer) -> String {
    let steps = answer.scheme.steps();
    if steps.len() == 1 {
        return "one clock".into();
    }
    let ratios: Vec<String> =
        steps.windows(2).map(|pair| crate::advise::unit::decimal(&(&pair[1] / &pair[0]))).collect();
    format!("{} inner steps in each", ratios.join(" x "))
}

/// Safe up to T/3, caution up to the band's edge, unstable in the first interval and in the ones about the scheme, the rest not advised.
fn stretches(advice: &Advice, answer: &Answer, row: &Row, at: f64, right: f64, into: [&mut Vec<Band>; 4]) {
    let [safe, caution, unstable, beyond] = into;
    let edge = row.first.as_ref().map_or(0.0, |first| first.lower.0);
    let band = edge * (1.0 - to_f64(&advice.band));
    let third = advice.modes[row.mode].part(3).0;
    let push = |list: &mut Vec<Band>, lo: f64, hi: f64| {
        if lo < hi.min(right) {
            list.push(Band { at: [lo, hi.min(right)], row: at });
        }
    };
    let alone = answer.scheme.steps().len() == 1;
    push(safe, 0.0, if alone { band } else { third.min(band) });
    push(caution, if alone { band } else { third }, band);
    push(beyond, band, right);
    let known = [&row.first, &row.inside, &row.below, &row.above];
    let mut seen: Vec<f64> = Vec::new();
    for interval in known.into_iter().flatten().filter(|of| of.upper.is_some() || alone) {
        if !seen.contains(&interval.lower.0) {
            seen.push(interval.lower.0);
            push(unstable, interval.lower.0, interval.upper.map_or(right, |upper| upper.1));
        }
    }
}
