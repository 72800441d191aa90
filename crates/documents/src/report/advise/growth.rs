//! Advice on forces that are no gradient, drawn: growth at every multiple of the step before the outermost
//! one.

use plot::palette::{COEXISTENCE, GREY, HYPERBOLIC, INK, SAFE};
use plot::{Anchor, Axis, Figure, Layer, Note, Panel, Place, Shape, Stroke};

use super::chart::within;
use super::words::fs;
use molecules::unit::TimeUnit;
use molecules::{Adds, DirectFinding, DirectFindings, Rung, TIMES};
use number::{Rational, to_f64};
use systems::middle;

/// A panel's height, in mm.
const HEIGHT: f64 = 70.0;

/// From a line of words to the next, as a share of that.
const NEXT: f64 = 0.09;

/// A panel for each step before the outermost one, with the schemes that have it; `None` where every scheme
/// has one step alone.
pub(super) fn figure(findings: &DirectFindings, title: &str) -> Option<Figure> {
    let mut inner: Vec<(&Rational, Vec<&DirectFinding>)> = Vec::new();
    for direct_finding in findings.schemes.iter().filter(|scheme| !scheme.ladder.is_empty()) {
        let step = direct_finding.scheme.last_but_one();
        match inner.iter_mut().find(|(known, _)| *known == step) {
            Some((_, schemes)) => schemes.push(direct_finding),
            None => inner.push((step, vec![direct_finding])),
        }
    }
    let figure = Figure::double_column(HEIGHT * inner.len() as f64).columns(1).named(title);
    let panels = inner.iter().map(|(step, schemes)| panel(findings, step, schemes));
    let drawn = (!inner.is_empty()).then(|| panels.fold(figure, Figure::with))?;
    let unit = TimeUnit::Femtoseconds;
    let foot = within(plot::Foot::default(), &findings.band, findings.friction.as_ref(), unit);
    let little = format!(
        "little: at most {TIMES} times the growth of the forces by themselves, or tenfold after 1 µs at the earliest"
    );
    Some(drawn.footed(&foot.words(&little)))
}

/// Per ps, in the middle of its enclosure; no lower than what is known where it is not bounded.
fn height(rate: Option<(f64, f64)>) -> f64 {
    1000.0
        * match rate {
            Some((lo, hi)) if hi.is_finite() => middle((lo, hi)),
            Some((lo, _)) => lo,
            None => 0.0,
        }
}

fn panel(findings: &DirectFindings, step: &Rational, schemes: &[&DirectFinding]) -> Panel {
    // The longest ladder reaches the longest scheme.
    let first = schemes.iter().max_by_key(|scheme| scheme.ladder.len()).expect("a scheme with this step");
    let last = first.ladder.last().map_or(0.0, |rung| to_f64(&rung.outer));
    let (right, by_themselves) = (last + 0.5 * to_f64(step), height(findings.without_steps));
    let fastest = first.ladder.iter().map(|rung| height(rung.rate)).fold(by_themselves, f64::max);
    let top = if fastest > 0.0 { 1.15 * fastest } else { 1.0 };
    let axis = Axis::linear(&format!("outer step (fs), multiples of {}", fs(step)), 0.0, right);
    let mut panel = Panel::new(axis, Axis::linear("growth rate (1/ps)", 0.0, top)).legend(Place::Above);
    if let Some(largest) = first.largest.as_ref().map(to_f64) {
        let area = vec![[0.0, 0.0], [largest, 0.0], [largest, top], [0.0, top]];
        let words = "little growth proven at every multiple, all periods in the band";
        panel = panel.with(Layer::areas(vec![area], SAFE, 1.0).labelled(words));
    }
    if by_themselves > 0.0 {
        let line = Layer::lines(
            vec![vec![[0.0, by_themselves], [right, by_themselves]]],
            Stroke::DASHED.in_colour(GREY),
        );
        panel = panel.with(line.labelled("the forces by themselves"));
    }
    let dots = |adds: Adds| {
        let at = |rung: &Rung| {
            // What is not known stands a little above the frame, which would hide it.
            let least = if adds == Adds::Undecided { 0.03 * top } else { 0.0 };
            [to_f64(&rung.outer), height(rung.rate).max(least)]
        };
        first.ladder.iter().filter(|rung| rung.adds == adds).map(at).collect::<Vec<_>>()
    };
    for (adds, shape, colour, name) in [
        (Adds::Little, Shape::Ring, COEXISTENCE, "the steps add little, proven"),
        (Adds::Much, Shape::Disc, HYPERBOLIC, "they add more, proven"),
        (Adds::Undecided, Shape::Cross, INK, "neither is proven"),
    ] {
        let values = dots(adds);
        if !values.is_empty() {
            panel = panel.with(Layer::dots(values, shape, 3.2, colour).labelled(name));
        }
    }
    let lines = schemes
        .iter()
        .map(|scheme| to_f64(scheme.scheme.outer()))
        .map(|x| vec![[x, 0.0], [x, top]])
        .collect();
    panel = panel.with(Layer::lines(lines, Stroke::THIN.in_colour(INK)));
    if let Some(safe) = first.safe.as_ref().map(to_f64) {
        let line = Layer::lines(vec![vec![[safe, 0.0], [safe, top]]], Stroke::DASHED.wide(1.0));
        panel = panel.with(line.labelled("recommended"));
    }
    (0..).zip(schemes).fold(panel, |panel, (n, direct_finding)| {
        let outer = to_f64(direct_finding.scheme.outer());
        let (anchor, shift) = if outer > 0.7 * right { (Anchor::End, -3.0) } else { (Anchor::Start, 3.0) };
        let adds =
            if direct_finding.adds == Adds::Undecided { "not proven" } else { direct_finding.adds.name() };
        // Neighbours in lines of their own.
        let line = (0.93 - NEXT * f64::from(n % 4)) * top;
        let note = Note::new([outer, line], &format!("{}: {adds}", fs(direct_finding.scheme.outer())));
        panel.note(note.anchored(anchor, [shift, 0.0]).in_colour(INK))
    })
}
