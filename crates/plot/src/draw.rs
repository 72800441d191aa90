//! A panel onto the canvas: layers, frame, ticks, numbers, labels, title.

use super::axis::Tick;
use super::canvas::{Anchor, Canvas, Element, Path, Pen, Set};
use super::clip::{self, Rect};
use super::font::Face;
use super::key;
use super::label::{Label, wrapped};
use super::layout::Site;
use super::marks;
use super::measure::{
    CAPITAL, DIGIT, GAP, LINE, MINOR_TICK, NUMBER, Plane, TICK, TITLE, WORDS, set, ticks, widest_number,
};
use super::palette::{Colour, INK};
use super::panel::{Note, Panel};

/// Lines of the frame and its ticks.
const HAIR: f64 = 0.5;
/// The smallest letters that journals take.
const LEAST: f64 = 6.0;
/// Lines of a grid.
const FAINT: Colour = Colour(0xe4, 0xe5, 0xe8);

/// Draws the whole panel around and in its frame.
pub(crate) fn panel(canvas: &mut Canvas, panel: &Panel, Site { frame, top }: Site) {
    let plane = Plane { x: &panel.x, y: &panel.y, frame };
    let (across, up) = (frame[2] - frame[0], frame[3] - frame[1]);
    let (x_ticks, y_ticks) = (ticks(&panel.x, 0, across), ticks(&panel.y, 1, up));
    if panel.grid {
        grid(canvas, &plane, &x_ticks, &y_ticks);
    }
    canvas.elements.push(Element::Open(frame));
    for layer in &panel.layers {
        marks::layer(canvas, &plane, layer);
    }
    canvas.elements.push(Element::Close);
    rim(canvas, &plane, &x_ticks, &y_ticks);
    for note in &panel.notes {
        words(canvas, &plane, note);
    }
    numbers(canvas, &plane, &x_ticks, &y_ticks);
    axis_labels(canvas, &plane, up);
    lines(canvas, wrapped(&panel.title, Face::Semibold, across / TITLE), [frame[0], top], TITLE);
    key::legend(canvas, panel, frame);
    if let Some(bar) = &panel.bar {
        key::bar(canvas, bar, frame);
    }
}

/// Lines of words that hang from a point.
pub(crate) fn lines(canvas: &mut Canvas, lines: Vec<Label>, [x, y]: [f64; 2], size: f64) {
    for (n, line) in (0..).zip(lines) {
        let base = y + size * (CAPITAL + LINE * f64::from(n));
        canvas.text(line, [x, base], set(size, Anchor::Start));
    }
}

fn grid(canvas: &mut Canvas, plane: &Plane, x_ticks: &[Tick], y_ticks: &[Tick]) {
    let [left, top, right, bottom] = plane.frame;
    let mut lines = Path::default();
    for tick in x_ticks.iter().filter(|tick| tick.label.is_some()) {
        lines.vertical([plane.across(plane.x.unit(tick.at)), top], bottom);
    }
    for tick in y_ticks.iter().filter(|tick| tick.label.is_some()) {
        lines.horizontal([left, plane.down(plane.y.unit(tick.at))], right);
    }
    canvas.stroke(lines, Pen::new(FAINT, HAIR));
}

/// The frame with its ticks, as one path.
fn rim(canvas: &mut Canvas, plane: &Plane, x_ticks: &[Tick], y_ticks: &[Tick]) {
    let [left, top, right, bottom] = plane.frame;
    let length = |tick: &Tick| if tick.label.is_some() { TICK } else { MINOR_TICK };
    let mut lines = Path::default();
    lines.move_to([left, top]);
    for corner in [[right, top], [right, bottom], [left, bottom]] {
        lines.line_to(corner);
    }
    lines.close([left, top]);
    for tick in x_ticks {
        lines.vertical([plane.across(plane.x.unit(tick.at)), bottom], bottom + length(tick));
    }
    for tick in y_ticks {
        lines.horizontal([left, plane.down(plane.y.unit(tick.at))], left - length(tick));
    }
    canvas.stroke(lines, Pen::new(INK, HAIR));
}

fn numbers(canvas: &mut Canvas, plane: &Plane, x_ticks: &[Tick], y_ticks: &[Tick]) {
    let [left, _, _, bottom] = plane.frame;
    let labelled = |ticks: &[Tick]| -> Vec<(f64, Label)> {
        ticks.iter().filter_map(|t| Some((t.at, Label::new(t.label.as_ref()?)))).collect()
    };
    let base = bottom + TICK + GAP + NUMBER * DIGIT;
    for (at, label) in labelled(x_ticks) {
        canvas.text(label, [plane.across(plane.x.unit(at)), base], set(NUMBER, Anchor::Middle));
    }
    for (at, label) in labelled(y_ticks) {
        let base = plane.down(plane.y.unit(at)) + NUMBER * DIGIT / 2.0;
        canvas.text(label, [left - TICK - GAP, base], set(NUMBER, Anchor::End));
    }
}

fn axis_labels(canvas: &mut Canvas, plane: &Plane, up: f64) {
    let [left, top, right, bottom] = plane.frame;
    let base = bottom + TICK + GAP + NUMBER * DIGIT + GAP + WORDS * 0.85;
    let label = Label::new(&plane.x.label);
    let size = fitting(&label, right - left);
    canvas.text(label, [(left + right) / 2.0, base], set(size, Anchor::Middle));
    let base = left - TICK - GAP - widest_number(plane.y, up) - GAP - WORDS * (LINE - 0.85);
    let label = Label::new(&plane.y.label);
    let upright = Set { turn: 90.0, ..set(fitting(&label, up), Anchor::Middle) };
    canvas.text(label, [base, (top + bottom) / 2.0], upright);
}

/// The size of the letters of an axis's label: smaller where it is longer than the axis and a third.
fn fitting(label: &Label, length: f64) -> f64 {
    WORDS.min((length / (0.75 * label.width)).max(LEAST))
}

fn words(canvas: &mut Canvas, plane: &Plane, note: &Note) {
    let [x, y] = plane.place(note.at);
    if clip::holds(plane.frame, [x, y]) {
        // Centred on the point: half the height of a small letter lies below it.
        let at = [x + note.shift[0], y - note.shift[1] + NUMBER * 0.23];
        let set = Set { turn: note.turn, colour: note.colour, halo: true, ..set(NUMBER, note.anchor) };
        let label = Label::new(&note.text);
        let at =
            if note.is_turned() { at } else { within(plane.frame, at, NUMBER * label.width, note.anchor) };
        canvas.text(label, at, set);
    }
}

/// The nearest place at which a line of words so wide lies in the frame; where it is wider, as it was.
fn within([left, top, right, bottom]: Rect, [x, y]: [f64; 2], width: f64, anchor: Anchor) -> [f64; 2] {
    let before = match anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => width / 2.0,
        Anchor::End => width,
    };
    let (first, last) = (left + 1.0 + before, right - 1.0 + before - width);
    // Between the top of its capitals and the foot of its letters.
    let (high, low) = (top + 1.0 + NUMBER * CAPITAL, bottom - 1.0 - NUMBER * 0.23);
    let put = |at: f64, lo: f64, hi: f64| if lo <= hi { at.clamp(lo, hi) } else { at };
    [put(x, first, last), put(y, high, low)]
}
