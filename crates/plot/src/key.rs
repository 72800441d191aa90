//! Keys: legends and colour bars.

use super::canvas::{Anchor, Canvas, Element, Patch, Path, Pen, Set};
use super::clip::Rect;
use super::label::Label;
use super::layer::{Layer, Mark, Shape};
use super::marks;
use super::measure::{
    DIGIT, GAP, LINE, MINOR_TICK, NUMBER, Plane, TICK, WORDS, beside, set, ticks, widest_number,
};
use super::palette::INK;
use super::panel::{ColourBar, Panel};
use crate::Axis;

/// A sample of a line, the space to its words, the space to the next entry, the height of a line of entries.
const SAMPLE: f64 = 17.0;
const TO_WORDS: f64 = 4.0;
const TO_NEXT: f64 = 11.0;
const ROW: f64 = 11.0;
/// A colour bar's distance from the frame and its width.
const BAR_GAP: f64 = 8.0;
const BAR: f64 = 7.0;
/// The height of an arrow at its end.
const ARROW: f64 = 7.0;
/// Steps of colour in a bar: finer than the eye can distinguish.
const SHADES: usize = 96;

/// One entry: the layers it stands for, whose samples lie over each other, and their words.
type Entry<'a> = (Vec<&'a Layer>, Label);

/// Each name once.
fn entries(panel: &Panel) -> Vec<Entry<'_>> {
    let mut named: Vec<(&str, Vec<&Layer>)> = Vec::new();
    for (layer, name) in panel.layers.iter().filter_map(|layer| Some((layer, layer.label.as_deref()?))) {
        match named.iter_mut().find(|(known, _)| *known == name) {
            Some((_, layers)) => layers.push(layer),
            None => named.push((name, vec![layer])),
        }
    }
    named.into_iter().map(|(name, layers)| (layers, Label::new(name))).collect()
}

fn width((_, label): &Entry) -> f64 {
    SAMPLE + TO_WORDS + NUMBER * label.width
}

/// The entries in lines no longer than `room`.
fn rows<'a>(entries: Vec<Entry<'a>>, room: f64) -> Vec<Vec<Entry<'a>>> {
    let mut rows: Vec<Vec<Entry>> = Vec::new();
    let mut used = f64::INFINITY;
    for entry in entries {
        let wide = width(&entry);
        if used + TO_NEXT + wide > room {
            rows.push(Vec::new());
            used = -TO_NEXT;
        }
        used += TO_NEXT + wide;
        rows.last_mut().expect("the first entry opens a line").push(entry);
    }
    rows
}

/// How far a legend above a frame so wide reaches to the left of it: over the numbers and names there, `left`
/// wide, if one of its entries is longer than the frame, or it takes fewer lines so.
fn indent(entries: &[Entry], wide: f64, left: f64) -> f64 {
    let lines = |room: f64| rows(entries.to_vec(), room).len();
    let is_long = entries.iter().any(|entry| width(entry) > wide);
    if is_long || lines(wide + left) < lines(wide) { left } else { 0.0 }
}

/// The height of a legend above a frame of the given width, with what stands left of that.
pub(crate) fn rows_height(panel: &Panel, wide: f64, left: f64) -> f64 {
    let entries = entries(panel);
    let room = wide + indent(&entries, wide, left);
    let count = rows(entries, room).len();
    if count == 0 { 0.0 } else { ROW * count as f64 + 3.0 }
}

/// Draws the legend above the frame, where the panel has one.
pub(crate) fn legend(canvas: &mut Canvas, panel: &Panel, frame: Rect) {
    if panel.legend.is_none() {
        return;
    }
    let entries = entries(panel);
    let (wide, left) = (frame[2] - frame[0], beside(&panel.y, frame[3] - frame[1]));
    let (height, indent) = (rows_height(panel, wide, left), indent(&entries, wide, left));
    for (i, row) in rows(entries, wide + indent).iter().enumerate() {
        let mut x = frame[0] - indent;
        for entry in row {
            draw_entry(canvas, entry, [x, frame[1] - height + ROW * (i as f64 + 0.5)]);
            x += width(entry) + TO_NEXT;
        }
    }
}

/// Samples of the layers' marks and their words, around the height y.
fn draw_entry(canvas: &mut Canvas, (layers, label): &Entry, [x, y]: [f64; 2]) {
    layers.iter().for_each(|layer| draw_sample(canvas, layer, [x, y]));
    let at = [x + SAMPLE + TO_WORDS, y + NUMBER * 0.23];
    canvas.text(label.clone(), at, set(NUMBER, Anchor::Start));
}

fn draw_sample(canvas: &mut Canvas, layer: &Layer, [x, y]: [f64; 2]) {
    let unit = Axis::linear("", 0.0, 1.0);
    let frame = [x, y - 3.5, x + SAMPLE, y + 3.5];
    let plane = Plane { x: &unit, y: &unit, frame };
    let swatch = |colour, opacity| {
        let outline = vec![[0.1, 0.0], [0.9, 0.0], [0.9, 1.0], [0.1, 1.0]];
        Some(Layer::areas(vec![outline], colour, opacity))
    };
    let sample = match &layer.mark {
        Mark::Lines { stroke, marks, .. } => {
            marks::layer(canvas, &plane, &Layer::lines(vec![vec![[0.0, 0.5], [1.0, 0.5]]], *stroke));
            marks.map(|(shape, size)| Layer::dots(vec![[0.5, 0.5]], shape, size, stroke.colour))
        }
        Mark::Dots { shape, size, colour, .. } => {
            // A dot in a legend is for being seen.
            let size = if *shape == Shape::Disc { size.max(2.5) } else { *size };
            Some(Layer::dots(vec![[0.5, 0.5]], *shape, size, *colour))
        }
        Mark::Area { colour, opacity, .. } => swatch(*colour, *opacity).map(|own| own.hatched(layer.hatch)),
        Mark::Cells(cells) => {
            let colour = cells.colours.get(cells.colours.len() / 2);
            colour.and_then(|colour| swatch(*colour, 1.0)).map(|own| own.hatched(layer.hatch))
        }
    };
    if let Some(sample) = sample {
        marks::layer(canvas, &plane, &sample);
    }
}

/// The width of a colour bar at the right of a frame of the given height.
pub(crate) fn bar_width(bar: &ColourBar, height: f64) -> f64 {
    let label = if bar.axis.label.is_empty() { 0.0 } else { GAP + WORDS * LINE };
    let high = height - bar.beyond.iter().filter(|beyond| **beyond).count() as f64 * ARROW;
    BAR_GAP + BAR + TICK + GAP + widest_number(&bar.axis, high) + label
}

/// Draws a colour bar at the right of a frame.
pub(crate) fn bar(canvas: &mut Canvas, bar: &ColourBar, frame: Rect) {
    let [_, top, right, bottom] = frame;
    let (left, edge) = (right + BAR_GAP, right + BAR_GAP + BAR);
    let arrow = bar.beyond.map(|beyond| if beyond { ARROW } else { 0.0 });
    let (foot, head) = (bottom - arrow[0], top + arrow[1]);
    let high = foot - head;
    let mut rim = Path::default();
    rim.move_to([left, head]);
    let tip = (left + edge) / 2.0;
    for corner in [[tip, top], [edge, head], [edge, foot], [tip, bottom], [left, foot]] {
        rim.line_to(corner);
    }
    rim.close([left, head]);
    // The arrows have the last colours.
    canvas.fill(rim.clone(), bar.gradient.at(0.0), None);
    if arrow[1] > 0.0 {
        let mut tips = Path::default();
        tips.move_to([left, head]);
        [[tip, top], [edge, head]].into_iter().for_each(|corner| tips.line_to(corner));
        tips.close([left, head]);
        canvas.fill(tips, bar.gradient.at(1.0), None);
    }
    for (i, colour) in bar.gradient.steps(SHADES).into_iter().enumerate() {
        // From each shade's foot up to the top: the next one covers the rest, and no seam shows.
        let (x, y, width, height) = (left, head, BAR, high * (1.0 - i as f64 / SHADES as f64));
        let shade = Patch { x, y, width, height, colour };
        canvas.elements.push(Element::Patch(shade));
    }
    for tick in ticks(&bar.axis, 1, high) {
        let y = foot - high * bar.axis.unit(tick.at);
        rim.horizontal([edge, y], edge + if tick.label.is_some() { TICK } else { MINOR_TICK });
        if let Some(label) = &tick.label {
            let at = [edge + TICK + GAP, y + NUMBER * DIGIT / 2.0];
            canvas.text(Label::new(label), at, set(NUMBER, Anchor::Start));
        }
    }
    canvas.stroke(rim, Pen::new(INK, 0.5));
    let x = edge + TICK + GAP + widest_number(&bar.axis, high) + GAP + WORDS * 0.75;
    let upright = Set { turn: 90.0, ..set(WORDS, Anchor::Middle) };
    canvas.text(Label::new(&bar.axis.label), [x, (top + bottom) / 2.0], upright);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Stroke;

    /// Four short names above a narrow frame took four lines.
    #[test]
    fn a_legend_reaches_over_the_numbers_where_it_takes_fewer_lines_so() {
        let panel = Panel::new(Axis::linear("x", 0.0, 1.0), Axis::linear("y", 0.0, 1.0));
        let names = ["*a* = 0", "*a* = 1", "*a* = 1", "*a* = 2", "*a* = 3"];
        let line = |name: &&str| Layer::lines(Vec::new(), Stroke::LINE).labelled(name);
        let panel = names.iter().map(line).fold(panel, Panel::with);
        let lines = |left: f64| ((rows_height(&panel, 82.0, left) - 3.0) / ROW).round();
        assert_eq!(entries(&panel).len(), 4, "a name stands twice");
        assert_eq!([lines(0.0), lines(25.0)], [4.0, 2.0]);
    }
}
