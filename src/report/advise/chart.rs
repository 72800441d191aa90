//! Advice drawn: the outer step across, each mode and pair of modes a row.

use crate::advise::unit::decimal;
use crate::advise::{Advice, Answer, Pair, Row};
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

/// A row of the figure: a fast mode, or a pair of them, at one scheme's ratio.
enum Subject<'a> {
    Mode(&'a Row),
    Pair(&'a Pair),
}

/// One scheme for each ratio, with the rows that belong to it.
fn by_ratio(advice: &Advice) -> Vec<(&Answer, Vec<&Answer>)> {
    let mut found: Vec<(&Answer, Vec<&Answer>)> = Vec::new();
    for answer in &advice.schemes {
        match found.iter_mut().find(|(first, _)| ratio(first) == ratio(answer)) {
            Some((_, all)) => all.push(answer),
            None => found.push((answer, vec![answer])),
        }
    }
    found
}

/// Each mode and each pair of modes at each scheme's own ratio, and the schemes' outer steps as lines through their rows.
pub fn figure(advice: &Advice, title: &str) -> Figure {
    let groups = by_ratio(advice);
    let count = |answer: &Answer| answer.rows.len() + answer.pairs.len();
    let rows: usize = groups.iter().map(|(answer, _)| count(answer)).sum();
    let outers = advice.schemes.iter().map(|answer| to_f64(answer.scheme.outer()));
    let ends = advice.schemes.iter().flat_map(|answer| &answer.rows).filter_map(|row| row.first.as_ref());
    let right = ends.map(|of| of.upper.unwrap_or(of.lower).1).chain(outers).fold(0.0, f64::max) * 1.12;
    let (mut layers, mut ticks, mut notes) = (Layers::default(), Vec::new(), Vec::new());
    let mut at = rows as f64;
    for (answer, all) in &groups {
        let top = at - 0.5;
        let modes = answer.rows.iter().map(Subject::Mode);
        for subject in modes.chain(answer.pairs.iter().map(Subject::Pair)) {
            at -= 1.0;
            layers.add(advice, answer, &subject, at, right);
            let name = match subject {
                Subject::Mode(row) => advice.modes[row.mode].name.clone(),
                Subject::Pair(pair) => pair.modes.map(|i| advice.modes[i].name.as_str()).join(" + "),
            };
            let label = if groups.len() > 1 { format!("{name}, {}", ratio(answer)) } else { name };
            ticks.push(Tick { at, label: Some(label) });
        }
        for (i, own) in all.iter().enumerate() {
            let outer = to_f64(own.scheme.outer());
            layers.chosen.push(vec![[outer, at - 0.5], [outer, top]]);
            let (anchor, shift) =
                if outer > 0.7 * right { (Anchor::End, -4.0) } else { (Anchor::Start, 4.0) };
            let text = format!("{} fs: {}", decimal(own.scheme.outer()), own.status.name());
            // Above its first row, in lines of their own.
            notes.push(
                Note::new([outer, top - 0.06 - 0.2 * (i % 2) as f64], &text)
                    .anchored(anchor, [shift, 0.0])
                    .in_colour(INK),
            );
        }
        if let Some(safe) = answer.safe.as_ref().map(to_f64) {
            layers.recommended.push(vec![[safe, at - 0.5], [safe, top]]);
        }
    }
    let only = if groups.len() == 1 {
        format!(", {} inner steps in each", ratio(groups[0].0))
    } else {
        String::new()
    };
    let x = Axis::linear(&format!("outer step (fs){only}"), 0.0, right);
    let panel = Panel::new(x, Axis::linear("", -0.6, rows as f64 - 0.4).ticks(ticks));
    let panel = notes.into_iter().fold(layers.on(panel, right / 90.0), Panel::note);
    Figure::new(150.0, 54.0 + 11.0 * rows as f64).named(title).with(panel.legend(Place::Above))
}

fn ratio(answer: &Answer) -> String {
    let steps = answer.scheme.steps();
    if steps.len() == 1 {
        return "one clock".into();
    }
    let ratios: Vec<String> = steps.windows(2).map(|pair| decimal(&(&pair[1] / &pair[0]))).collect();
    ratios.join(" x ")
}

/// What is drawn, kind by kind.
#[derive(Default)]
struct Layers {
    safe: Vec<Band>,
    caution: Vec<Band>,
    unstable: Vec<Band>,
    beyond: Vec<Band>,
    near: Vec<[f64; 2]>,
    chosen: Vec<Vec<[f64; 2]>>,
    recommended: Vec<Vec<[f64; 2]>>,
}

impl Layers {
    /// Safe up to T/3, caution up to the band's edge, then what is not advised, the unstable intervals over it. A pair is proven
    /// stable as far as all couplings are.
    fn add(&mut self, advice: &Advice, answer: &Answer, subject: &Subject, row: f64, right: f64) {
        let alone = answer.scheme.steps().len() == 1;
        let (band, fastest) = match subject {
            Subject::Mode(own) => {
                let edge = own.first.as_ref().map_or(0.0, |first| first.lower.0);
                (edge * (1.0 - to_f64(&advice.band)), own.mode)
            }
            Subject::Pair(pair) => {
                self.near.extend(Some([pair.near, row]).filter(|at| at[0] < right));
                (answer.band_edge.0, advice.fastest)
            }
        };
        let third = if alone { band } else { advice.modes[fastest].part(3).0 };
        let push = |list: &mut Vec<Band>, lo: f64, hi: f64| {
            if lo < hi.min(right) {
                list.push(Band { at: [lo, hi.min(right)], row });
            }
        };
        push(&mut self.safe, 0.0, third.min(band));
        push(&mut self.caution, third, band);
        push(&mut self.beyond, band, right);
        let Subject::Mode(own) = subject else { return };
        let first = own.first.iter().filter(|of| alone || of.upper.is_some());
        for interval in first.chain(&own.inside).chain(&own.intervals) {
            push(&mut self.unstable, interval.lower.0, interval.upper.map_or(right, |upper| upper.1));
        }
    }

    fn on(self, panel: Panel, pitch: f64) -> Panel {
        let areas =
            |bands: &[Band], colour| Layer::areas(bands.iter().map(Band::outline).collect(), colour, 1.0);
        let hatch = |bands: &[Band], pitch, falls| {
            bands.iter().flat_map(|band| band.hatch(pitch, falls)).collect::<Vec<_>>()
        };
        let panel = panel
            .with(areas(&self.safe, SAFE).labelled("proven stable, all periods in the band"))
            .with(areas(&self.caution, CAUTION).labelled("the same, beyond T/3 (published drift)"))
            .with(Layer::lines(hatch(&self.caution, pitch, false), Stroke::THIN))
            .with(
                Layer::lines(hatch(&self.beyond, 1.5 * pitch, true), Stroke::THIN.in_colour(GREY))
                    .labelled("not to be recommended"),
            )
            .with(areas(&self.unstable, UNSTABLE).labelled("unstable, proven"))
            .with(Layer::lines(self.chosen, Stroke::LINE));
        let panel = match self.near.is_empty() {
            true => panel,
            false => panel.with(
                Layer::dots(self.near, Shape::Diamond, 4.0, PARABOLIC)
                    .labelled("two modes may resonate (first order)"),
            ),
        };
        panel.with(
            Layer::lines(self.recommended, Stroke::DASHED.in_colour(COEXISTENCE)).labelled("recommended"),
        )
    }
}
