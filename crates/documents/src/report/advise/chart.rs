//! Advice drawn: the outer step across, each mode and pair of modes a row.

use std::f64::consts::PI;

use plot::palette::{CAUTION, INK, PARABOLIC, SAFE, SAMPLED, UNSTABLE, WHITE};
use plot::{Anchor, Axis, Figure, Foot, Hatch, Layer, Note, Panel, Place, Shape, Stroke, Tick, literal};

use molecules::unit::{TimeUnit, decimal};
use molecules::{
    Advice, Answer, Bound, Caps, Finding, Findings, Group, Lever, Levers, Pair, Row, Scheme, Status, Unstable,
};
use number::{Rational, to_f64};
use systems::levels::Growing;

use super::levers::{AS_GOOD, one_of};
use super::molecule::called;
use super::words::{length, meaning, named, nearest, percent};

/// A row's share of the height, in mm, and half the height of its bars in rows.
const ROW: f64 = 8.5;
const HALF: f64 = 0.3;
/// Below the last row and above the first, whose words need room, in rows.
const FOOT: f64 = 0.5;
const HEAD: f64 = 0.8;

/// From a line of words to the next, in rows.
const NEXT: f64 = 0.36;

/// Groups of a molecule's modes are drawn up to this many.
const MOST_ROWS: usize = 8;

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
}

/// A row of the figure: a mode, a pair of modes, a molecule; in fs.
#[derive(Default)]
struct Line {
    label: String,
    /// How far nothing is published against it, and how far all periods of the band are proven stable.
    published: f64,
    band: f64,
    /// Proven unstable.
    unstable: Vec<[f64; 2]>,
    /// Growing wherever it was sampled.
    sampled: Vec<[f64; 2]>,
    /// Where a resonance is near.
    near: Option<f64>,
}

/// The rows at one ratio of steps, and the schemes that have it.
struct Block {
    ratio: String,
    lines: Vec<Line>,
    /// The outer step, and what is known of it.
    chosen: Vec<(f64, String)>,
    safe: Option<f64>,
}

/// Blocks of one ratio each.
fn blocks<'a, T>(
    all: &'a [T],
    (scheme, unit): (impl Fn(&T) -> &Scheme, TimeUnit),
    of: impl Fn(&'a T) -> (Vec<Line>, Status, &'a Option<Rational>),
) -> Vec<Block> {
    let mut found: Vec<Block> = Vec::new();
    for number in all {
        let (ratio, outer) = (ratio(scheme(number)), scheme(number).outer());
        let (lines, status, safe) = of(number);
        let chosen = (to_f64(outer), format!("{}: {}", length(outer, unit), status.name()));
        match found.iter_mut().find(|block| block.ratio == ratio) {
            Some(block) => block.chosen.push(chosen),
            None => {
                found.push(Block { ratio, lines, chosen: vec![chosen], safe: safe.as_ref().map(to_f64) });
            }
        }
    }
    found
}

/// Each mode and each pair of modes at each scheme's own ratio, and the schemes' outer steps as lines through
/// their rows.
pub(super) fn of_periods(advice: &Advice, title: &str) -> Figure {
    let lines = |answer: &Answer| {
        let modes = answer.rows.iter().map(|row| mode(advice, answer, row));
        modes.chain(answer.pairs.iter().map(|modes| pair(advice, answer, modes))).collect()
    };
    let of = |answer| (lines(answer), answer.status, &answer.safe);
    let ends = advice.schemes.iter().flat_map(|answer| &answer.rows).filter_map(|row| row.first.as_ref());
    let right = ends.map(|ends| ends.upper.unwrap_or(ends.lower).1).fold(0.0, f64::max);
    let near = "two modes may resonate (first order)";
    let foot = advice.modes.iter().fold(Foot::default(), |foot, mode| foot.words(&named(mode, advice.unit)));
    let foot = within(foot, &advice.band, advice.friction.as_ref(), advice.unit);
    let foot = told(foot, advice.schemes.iter().map(|answer| answer.status));
    let blocks = blocks(&advice.schemes, (|answer: &Answer| &answer.scheme, advice.unit), of);
    draw(&blocks, right, (title, near), advice.unit).footed(&foot)
}

/// How far all periods may be off, and the friction.
pub(super) fn within(foot: Foot, band: &Rational, friction: Option<&Rational>, unit: TimeUnit) -> Foot {
    let foot = foot.words(&format!("all periods within {}", percent(band)));
    let rate = |rate: &Rational| unit.rate(decimal(&(rate * Rational::from_integer(unit.in_rates().into()))));
    friction.map_or(foot.clone(), |value| foot.words(&format!("friction {}", rate(value))))
}

/// What the words beside the steps mean, each once.
fn told(foot: Foot, statuses: impl Iterator<Item = Status>) -> Foot {
    let mut statuses: Vec<Status> = statuses.collect();
    statuses.sort_unstable();
    statuses.dedup();
    statuses
        .into_iter()
        .fold(foot, |foot, status| foot.words(&format!("{}: {}", status.name(), meaning(status))))
}

/// Safe up to what is published, caution up to the band's edge, the unstable intervals over what is not
/// advised; no step is called stable where a clock has no period.
fn mode(advice: &Advice, answer: &Answer, row: &Row) -> Line {
    let alone = answer.scheme.steps().len() == 1;
    let known = !advice.silent && !advice.lacks_fast && advice.beads.is_none();
    let band = row.first.as_ref().filter(|_| known).map_or(0.0, |first| first.lower.0)
        * (1.0 - to_f64(&advice.band));
    let first = row.first.iter().filter(|unstable| alone || unstable.upper.is_some());
    let ends =
        |unstable: &Unstable| [unstable.lower.0, unstable.upper.map_or(f64::INFINITY, |upper| upper.1)];
    Line {
        label: literal(&advice.modes[row.mode].name),
        published: cap(&advice.caps, band),
        band,
        unstable: first.chain(&row.inside).chain(&row.intervals).map(ends).collect(),
        ..Line::default()
    }
}

/// A pair is proven stable as far as all couplings are.
fn pair(advice: &Advice, answer: &Answer, pair: &Pair) -> Line {
    Line {
        label: literal(&pair.modes.map(|i| advice.modes[i].name.as_str()).join(" + ")),
        published: cap(&advice.caps, answer.band_edge.0),
        band: answer.band_edge.0,
        near: Some(pair.near),
        ..Line::default()
    }
}

/// The molecule and each group of its fast modes, alike.
pub(super) fn of_molecule(findings: &Findings, title: &str) -> Figure {
    let of = |finding| (molecule(findings, finding), finding.status, &finding.safe);
    let far = |finding: &Finding| {
        finding.growing.last().and_then(|last| last.upper).or(finding.first.map(|first| first.1))
    };
    let right = findings.schemes.iter().filter_map(far).fold(0.0, f64::max);
    let near = "half a turn of these modes alone";
    let unit = TimeUnit::Femtoseconds;
    let foot = within(Foot::default(), &findings.band, findings.friction.as_ref(), unit);
    let foot = told(foot, findings.schemes.iter().map(|finding| finding.status));
    draw(
        &blocks(&findings.schemes, (|finding: &Finding| &finding.scheme, unit), of),
        right,
        (title, near),
        unit,
    )
    .footed(&foot)
}

/// The published bound on the outermost step, `band` where there is none.
fn cap(caps: &Caps, band: f64) -> f64 {
    caps.outer().map_or(band, |(value, _)| to_f64(value))
}

/// The whole first; below it where each group alone has turned half way round in an outer step.
fn molecule(findings: &Findings, finding: &Finding) -> Vec<Line> {
    let band = finding.band_edge.unwrap_or(0.0);
    let published = cap(&findings.caps, band);
    let proven = finding.first.zip(finding.first_upper).map(|(first, upper)| [first.1, upper]);
    let ends = |growing: &Growing| [growing.lower, growing.upper.unwrap_or(f64::INFINITY)];
    let whole = Line {
        label: "all, coupled".into(),
        published,
        band,
        unstable: proven.into_iter().collect(),
        sampled: finding.growing.iter().map(ends).collect(),
        near: None,
    };
    let parts = to_f64(&(finding.scheme.outer() / finding.scheme.inner()));
    let half = |period: f64| parts * period / PI * (PI / (2.0 * parts)).sin();
    let group = |group: &Group| Line {
        label: format!("{}, {} fs", called(group), nearest(group.period, 4)),
        published,
        band,
        near: Some(half(group.period.0)),
        ..Line::default()
    };
    [whole].into_iter().chain(findings.groups.iter().take(MOST_ROWS).map(group)).collect()
}

/// All rows, from the top down; in words what is near.
fn draw(blocks: &[Block], right: f64, (title, near): (&str, &str), unit: TimeUnit) -> Figure {
    let rows: usize = blocks.iter().map(|block| block.lines.len()).sum();
    let outers = blocks.iter().flat_map(|block| &block.chosen).map(|(outer, _)| *outer);
    let right = 1.12 * outers.fold(right, f64::max);
    let (mut layers, mut ticks, mut notes) = (Layers::default(), Vec::new(), Vec::new());
    let mut at = rows as f64;
    for block in blocks {
        let top = at - 0.5;
        for line in &block.lines {
            at -= 1.0;
            layers.add(line, at, right);
            let many = blocks.len() > 1;
            let label = if many { format!("{} at {}", line.label, block.ratio) } else { line.label.clone() };
            ticks.push(Tick { at, label: Some(label) });
        }
        // Words stand between the rows; lines end at the bars, those of the words' own steps beside these.
        let (edge, end) = (top - 0.5 + HALF + 0.06, at - HALF - 0.06);
        for (i, (outer, text)) in block.chosen.iter().enumerate() {
            layers.chosen.push(vec![[*outer, end], [*outer, top + 0.14]]);
            let (anchor, shift) =
                if *outer > 0.7 * right { (Anchor::End, -3.0) } else { (Anchor::Start, 3.0) };
            // Neighbours in lines of their own.
            let note = Note::new([*outer, top - NEXT * (i % 2) as f64], text);
            notes.push(note.anchored(anchor, [shift, 0.0]).in_colour(INK));
        }
        // The advice is the first scheme's: in rows where its step is not proven it would mislead.
        let is_proven = |safe: &f64| block.lines.iter().all(|line| *safe <= line.band);
        if let Some(safe) = block.safe.filter(is_proven) {
            layers.recommended.push(vec![[safe, end], [safe, edge]]);
        }
    }
    let only = if let [block] = blocks { format!(", steps {}", block.ratio) } else { String::new() };
    let x = Axis::linear(&format!("{}{only}", axis(unit)), 0.0, right);
    let (low, high) = (-FOOT, rows as f64 - 1.0 + HEAD);
    let panel = Panel::new(x, Axis::linear("", low, high).ticks(ticks));
    let panel = notes.into_iter().fold(layers.on(panel, &Names::of_schemes(near)), Panel::note);
    Figure::of_rows(150.0, ROW * (high - low)).named(title).with(panel.legend(Place::Above))
}

/// The name of the horizontal axis.
fn axis(unit: TimeUnit) -> &'static str {
    if unit == TimeUnit::Plain { "outer step" } else { "outer step (fs)" }
}

/// The step to take by a lever, and that below which it is proven for the band; 0 where there is none.
fn reached(lever: &Lever) -> [f64; 2] {
    [lever.step.as_ref().map_or(0.0, |(step, _)| to_f64(step)), lever.band_edge.map_or(0.0, |edge| edge.0)]
}

/// Whether friction hides what grows.
fn is_masked(lever: &Lever) -> bool {
    matches!(lever.step, Some((_, Bound::Friction)))
}

/// Levers that reach as far, within 2 %, together, in the order of the first of each.
fn alike(levers: &Levers) -> Vec<Vec<&Lever>> {
    let is_near = |a: f64, b: f64| a.min(b) >= AS_GOOD * a.max(b);
    let mut groups: Vec<Vec<&Lever>> = Vec::new();
    for lever in &levers.rows {
        let is_alike = |group: &&mut Vec<&Lever>| {
            let mut both = reached(group[0]).into_iter().zip(reached(lever));
            is_masked(group[0]) == is_masked(lever) && both.all(|(a, b)| is_near(a, b))
        };
        match groups.iter_mut().find(is_alike) {
            Some(group) => group.push(lever),
            None => groups.push(vec![lever]),
        }
    }
    groups
}

/// Levers that would let the step grow: the steps to take and those that are proven for the band. What
/// reaches as far is a row, which shows the least of it.
pub fn levers(levers: &Levers, title: &str, unit: TimeUnit) -> Figure {
    let groups = alike(levers);
    let (rows, mut layers) = (groups.len(), Layers::default());
    let ends = |lever: &Lever| {
        let step = lever.step.as_ref().map(|(step, _)| to_f64(step));
        [lever.first.map(|first| first.1), lever.band_edge.map(|edge| edge.1), step]
    };
    let right = 1.08 * levers.rows.iter().flat_map(ends).flatten().fold(0.0, f64::max);
    let least = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::INFINITY, f64::min);
    let mut ticks = Vec::new();
    for (n, group) in groups.iter().enumerate() {
        let at = (rows - 1 - n) as f64;
        let [step, band] = [0, 1].map(|i| least(&mut group.iter().map(|lever| reached(lever)[i])));
        let first = least(&mut group.iter().filter_map(|lever| lever.first).map(|first| first.0));
        let masked = is_masked(group[0]);
        let line = Line {
            published: if masked { 0.0 } else { step },
            band,
            sampled: masked.then_some([0.0, step]).into_iter().collect(),
            near: Some(first),
            ..Line::default()
        };
        layers.add(&line, at, right);
        let names: Vec<&str> = group.iter().map(|lever| &*lever.name).collect();
        let name = one_of(names[0], &names[1..]);
        let name =
            if group.iter().all(|lever| lever.is_free) { format!("{name} (no unstable step)") } else { name };
        ticks.push(Tick { at, label: Some(literal(&name)) });
    }
    layers.beyond.clear();
    let (low, high) = (-FOOT, rows as f64 - 1.0 + FOOT);
    let panel = Panel::new(Axis::linear(axis(unit), 0.0, right), Axis::linear("", low, high).ticks(ticks));
    let names = Names {
        safe: "the step to take",
        caution: "proven, all periods in the band",
        sampled: "masked by the friction",
        near: "first unstable step of the periods given",
    };
    Figure::of_rows(150.0, LEVER * (high - low))
        .named(title)
        .with(layers.on(panel, &names).legend(Place::Above))
}

/// The height of a lever's row, in mm.
const LEVER: f64 = 5.0;

/// The legend of the kinds of bars.
struct Names<'a> {
    safe: &'a str,
    caution: &'a str,
    sampled: &'a str,
    near: &'a str,
}

impl<'a> Names<'a> {
    fn of_schemes(near: &'a str) -> Names<'a> {
        Names {
            safe: "proven stable, all periods in the band",
            caution: "proven stable, beyond the published limit",
            sampled: "growing at every step sampled",
            near,
        }
    }
}

fn ratio(scheme: &Scheme) -> String {
    let steps = scheme.steps();
    if steps.len() == 1 {
        return "one clock".into();
    }
    let ratios: Vec<String> = steps.windows(2).map(|pair| decimal(&(&pair[1] / &pair[0]))).collect();
    format!("{}:1", ratios.join(" x "))
}

/// The bars that are drawn, kind by kind.
#[derive(Default)]
struct Layers {
    safe: Vec<Band>,
    caution: Vec<Band>,
    unstable: Vec<Band>,
    sampled: Vec<Band>,
    beyond: Vec<Band>,
    near: Vec<[f64; 2]>,
    chosen: Vec<Vec<[f64; 2]>>,
    recommended: Vec<Vec<[f64; 2]>>,
}

impl Layers {
    fn add(&mut self, line: &Line, row: f64, right: f64) {
        let push = |list: &mut Vec<Band>, lo: f64, hi: f64| {
            if lo < hi.min(right) {
                list.push(Band { at: [lo, hi.min(right)], row });
            }
        };
        push(&mut self.safe, 0.0, line.published.min(line.band));
        push(&mut self.caution, line.published, line.band);
        push(&mut self.beyond, line.band, right);
        line.unstable.iter().for_each(|&[lo, hi]| push(&mut self.unstable, lo, hi));
        line.sampled.iter().for_each(|&[lo, hi]| push(&mut self.sampled, lo, hi));
        self.near.extend(line.near.filter(|&at| at < right).map(|at| [at, row]));
    }

    /// Every kind has a hatch of its own, for those who see no colours.
    fn on(self, panel: Panel, names: &Names) -> Panel {
        let kinds = [
            (&self.safe, SAFE, None, names.safe),
            (&self.caution, CAUTION, Some(Hatch::Rising), names.caution),
            (&self.beyond, WHITE, Some(Hatch::Falling), "not to be recommended"),
            (&self.sampled, SAMPLED, Some(Hatch::Crossed), names.sampled),
            (&self.unstable, UNSTABLE, None, "unstable, proven"),
        ];
        let mut panel = panel;
        for (bands, colour, hatch, name) in kinds.into_iter().filter(|(bands, ..)| !bands.is_empty()) {
            let layer = Layer::areas(bands.iter().map(Band::outline).collect(), colour, 1.0);
            panel = panel.with(layer.hatched(hatch).labelled(name));
        }
        if !self.chosen.is_empty() {
            panel = panel.with(Layer::lines(self.chosen, Stroke::LINE));
        }
        if !self.near.is_empty() {
            panel = panel.with(Layer::dots(self.near, Shape::Diamond, 4.0, PARABOLIC).labelled(names.near));
        }
        if self.recommended.is_empty() {
            return panel;
        }
        let recommended = Layer::lines(self.recommended, Stroke::DASHED.wide(1.0));
        panel.with(recommended.labelled("recommended"))
    }
}
