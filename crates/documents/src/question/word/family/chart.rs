//! A family over its parameter: unstable steps as a map, and below it the efficiency, the error and the bias.

use plot::palette::{HYPERBOLIC, INK};
use plot::{Axis, Figure, Foot, Layer, Panel, Place, Stroke};

use super::super::chart::{ends, marked, stacked, unstable};
use super::asked::Family;
use super::member::Member;
use super::search::Members;
use number::{Error, Result, to_f64};

/// Steps are drawn beyond the longest edge by this factor.
const BEYOND: f64 = 1.2;

/// A curve over the parameter: its name, and its value at a member.
type Curve<'a> = (&'a str, Box<dyn Fn(&Member) -> Option<f64> + 'a>);

/// The figure of a family of one parameter.
pub(super) fn figure(family: &Family, members: &Members) -> Result<Figure> {
    let mut ranged = family.parameter.ranged();
    let (Some((at, parameter)), None) = (ranged.next(), ranged.next()) else {
        let remedy = "a figure has one parameter: give the others one value";
        return Err(Error::input("parameter", &family.parameter, remedy));
    };
    let places: Vec<f64> = members.all.iter().map(|member| to_f64(&member.values[at])).collect();
    let half = parameter.step.as_ref().map_or(0.5, |step| to_f64(step) / 2.0);
    let (first, last) = (places[0] - half, places[places.len() - 1] + half);
    let x = |name: &str| Axis::linear(name, first, last);
    let middle = |ends: (f64, f64)| (ends.0 + ends.1) / 2.0;
    let degree = members.degree;
    let error = match degree {
        Some(degree) => format!("error, degree {degree}"),
        None => "error".into(),
    };
    let curves: [Curve; 3] = [
        ("efficiency", Box::new(move |member| member.linted.efficiency().map(middle))),
        (&error, Box::new(move |member| member.error(degree).map(middle))),
        ("worst bias", Box::new(|member| member.bias.as_ref().map(|bias| bias.mid_f64()))),
    ];
    let mut panels: Vec<Panel> = map(members, &places, half, x("")).into_iter().collect();
    for (name, value) in curves {
        let line: Vec<_> = members
            .all
            .iter()
            .zip(&places)
            .map(|(member, place)| [*place, value(member).unwrap_or(f64::NAN)])
            .collect();
        let Some([low, high]) = ends(&line) else { continue };
        let panel = Panel::new(x(""), Axis::linear(name, low.max(0.0), high));
        panels.push(panel.with(Layer::lines(vec![line], Stroke::LINE.in_colour(INK))));
    }
    if let Some(best) = &members.best {
        let place = to_f64(&best.member.values[at]);
        let name = format!("best {}: *{}* = {place:.7}", best.goal.name(), parameter.name);
        panels = marked(panels, place, &name);
    }
    let mut foot = Foot::default().words(&family.word);
    for fixed in family.parameter.0.iter().filter(|parameter| parameter.step.is_none()) {
        foot = foot.value(&format!("*{}*", fixed.name), &fixed.range.0);
    }
    for (name, value) in [("*Λ*_1", &family.lambda1), ("*Λ*_2", &family.lambda2)] {
        foot = value.iter().fold(foot, |foot, value| foot.value(name, value));
    }
    let x = x(&format!("*{}*", parameter.name));
    Ok(stacked(panels, &x, 26.0, "A word over its parameter").footed(&foot))
}

/// The unstable steps over the parameter; `None` where none are known.
fn map(members: &Members, places: &[f64], half: f64, x: Axis) -> Option<Panel> {
    let edge = |member: &Member| member.linted.nominal_edge().map(|edge| edge.mid_f64());
    let top = BEYOND * members.all.iter().filter_map(edge).reduce(f64::max)?;
    let outline = |place: f64, [a, b]: [f64; 2]| {
        vec![[place - half, a], [place + half, a], [place + half, b], [place - half, b]]
    };
    let strips = members.all.iter().zip(places).flat_map(|(member, place)| {
        unstable(&member.linted, [0.0, top]).into_iter().map(move |span| outline(*place, span))
    });
    let names_forces = members.all[0].linted.word.names_forces();
    let y = Axis::linear(if names_forces { "√*Λ*_1 *h*" } else { "*ωh*" }, 0.0, top);
    let layer = Layer::areas(strips.collect(), HYPERBOLIC, 1.0).labelled("unstable");
    Some(Panel::new(x, y).with(layer).legend(Place::Above))
}
