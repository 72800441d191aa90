//! E* over the step, with the resonances of the method, the steps asked for, and the level of a system.

use plot::palette::{GREY, HYPERBOLIC, INK, PARABOLIC, family};
use plot::{Anchor, Axis, Figure, Foot, Layer, Note, Panel, Place, Shape, Stroke, literal};

use crate::report::decimal::few;
use molecules::aperture::{Measured, Step, rungs};
use molecules::unit::decimal;
use number::to_f64;

/// Above the highest rung there is room for two lines of words, on a column of 85 mm, too.
const ROOM: f64 = 15.0;

/// Heights above the highest rung at which words stand: the steps asked for, and above them the resonances.
const WORDS: [f64; 2] = [2.5, 9.5];

/// Up to so many steps asked for have their energies beside them.
const FEW: usize = 3;

/// E* over the step; a step at which no start is lost stands at the highest rung.
pub fn figure(measured: &Measured) -> Figure {
    let top = rungs().last().expect("there are rungs");
    let is_chosen = |step: &&Step| measured.chosen.contains(&step.step);
    let chosen: Vec<&Step> = measured.steps.iter().filter(is_chosen).collect();
    let ends = [measured.steps.first(), measured.steps.last()]
        .map(|step| step.map_or(0.0, |step| to_f64(&step.step)));
    // Curves end at the frame; steps that stand alone have their dots and words inside it.
    let share = if is_range(measured) { 0.01 } else { 0.15 };
    let margin = if ends[1] > ends[0] { share * (ends[1] - ends[0]) } else { 0.3 * ends[1] };
    let (left, right) = (ends[0] - margin, ends[1] + margin);
    let level = measured.level;
    let panel = Panel::new(
        Axis::linear("*h* (fs)", left, right),
        Axis::linear(&format!("*E* (kT; {top}: no start is lost)"), 0.0, top + ROOM),
    );
    let panel = with_resonances(panel, measured, (left, right), top).with(
        Layer::lines(
            vec![vec![[left, level], [right, level]]],
            Stroke::DASHED.in_colour(PARABOLIC).wide(1.0),
        )
        .labelled(&format!("ln *N* = {}, the hottest of *N* bonds x ps", few(level, 3))),
    );
    let panel = with_curves(panel, measured, top);
    let panel = with_chosen(panel, &chosen, top, (left, right));
    let foot = Foot::default()
        .words(&measured.bond.to_string())
        .words(&format!("{} K", decimal(&measured.temperature)))
        .words(&measured.word.to_string())
        .words("measured, no proof");
    Figure::new(150.0, 95.0)
        .named(&format!("How hot {} may be", measured.bond.name))
        .with(panel.legend(Place::Above))
        .footed(&foot)
}

/// Whether there are more steps than those asked for one by one.
fn is_range(measured: &Measured) -> bool {
    measured.steps.iter().any(|step| !measured.chosen.contains(&step.step))
}

/// A line and its k where the method turns by a simple part of a full turn.
fn with_resonances(panel: Panel, measured: &Measured, (left, right): (f64, f64), top: f64) -> Panel {
    let places = measured.resonances.iter().filter_map(|resonance| Some((resonance.k, resonance.step?)));
    let inside: Vec<(u64, f64)> = places.filter(|(_, h)| (left..=right).contains(h)).collect();
    if inside.is_empty() {
        return panel;
    }
    let lines = inside.iter().map(|&(_, h)| vec![[h, 0.0], [h, top + WORDS[1] - 0.5]]).collect();
    let layer = Layer::lines(lines, Stroke::DOTTED.in_colour(GREY)).labelled("the method turns by 2 *π*/*k*");
    let note = |panel: Panel, &(k, h): &(u64, f64)| {
        let note = Note::new([h, top + WORDS[1]], &format!("*k* = {k}"));
        panel.note(note.anchored(Anchor::Middle, [0.0, 1.0]))
    };
    inside.iter().fold(panel.with(layer), note)
}

/// E* and the half aperture of a range as lines; without a range there are the steps alone.
fn with_curves(panel: Panel, measured: &Measured, top: f64) -> Panel {
    if !is_range(measured) {
        return panel;
    }
    let line = |value: fn(&Step) -> Option<f64>| {
        let at = |step: &Step| [to_f64(&step.step), value(step).unwrap_or(top)];
        vec![measured.steps.iter().map(at).collect::<Vec<_>>()]
    };
    let half = Layer::lines(line(|step| step.half), Stroke::LINE.in_colour(family(0)).wide(0.6));
    let aperture = Layer::lines(line(|step| step.aperture), Stroke::THICK.in_colour(HYPERBOLIC));
    panel.with(half.labelled("half of all phases are lost")).with(aperture.labelled("some phase is lost"))
}

/// The steps asked for, each with its length.
fn with_chosen(panel: Panel, chosen: &[&Step], top: f64, (left, right): (f64, f64)) -> Panel {
    if chosen.is_empty() {
        return panel;
    }
    let places: Vec<f64> = chosen.iter().map(|step| to_f64(&step.step)).collect();
    let energies = chosen.iter().map(|step| step.aperture.unwrap_or(top));
    let points = places.iter().zip(energies).map(|(&h, energy)| [h, energy]).collect();
    let sticks = places.iter().map(|&h| vec![[h, 0.0], [h, top + WORDS[0] - 0.5]]).collect();
    let panel = panel
        .with(Layer::lines(sticks, Stroke::LINE.in_colour(INK)))
        .with(Layer::dots(points, Shape::Disc, 4.0, INK).labelled("the steps asked for"));
    chosen.iter().zip(places).fold(panel, |panel, (step, h)| {
        let energy = step.aperture.map_or_else(|| format!("above {top} kT"), |energy| format!("{energy} kT"));
        let length = decimal(&step.step);
        let words = if chosen.len() > FEW { length } else { format!("{length} fs: {energy}") };
        let anchor = match (h - left) / (right - left) {
            share if share < 0.1 => Anchor::Start,
            share if share > 0.9 => Anchor::End,
            _ => Anchor::Middle,
        };
        panel.note(Note::new([h, top + WORDS[0]], &literal(&words)).anchored(anchor, [0.0, 1.0]))
    })
}
