//! Draws a two-panel figure with made-up data, to look at: `cargo run --release --example figure_demo -- FOLDER`.

use std::path::Path;

use kickdrift::error::Result;
use kickdrift::report::figure::palette::{Gradient, family};
use kickdrift::report::figure::{
    Anchor, Axis, Cells, ColourBar, Dash, Figure, Layer, Note, Panel, Picture, Place, Shape, Stroke, png,
};
use kickdrift::report::file::write_output;

const SHADES: u16 = 48;

fn half_period(h1: f64) -> f64 {
    std::f64::consts::PI * h1 / (2.0 * (std::f64::consts::FRAC_PI_2 * h1).min(1.0).asin())
}

/// The curve h2 = b T h1/(h1 - a T) in pieces of finite points.
fn curve(a: f64, b: f64) -> Vec<[f64; 2]> {
    (1..=600)
        .map(|i| f64::from(i) / 600.0 * 2.0 / std::f64::consts::PI)
        .map(|h1| [h1, b * half_period(h1) * h1 / (h1 - a * half_period(h1))])
        .map(|[x, y]| [x, if y > 0.0 { y } else { f64::NAN }])
        .collect()
}

fn axes() -> (Axis, Axis) {
    (Axis::linear("*h*_1", 0.0, 2.0 / std::f64::consts::PI), Axis::linear("*h*_2", 0.0, 3.5))
}

/// Bands below the thick curves and a haze of lonely cells.
fn left() -> Panel {
    let d = 1.0 / 250.0;
    let gradient = Gradient::on_white();
    let bar = ColourBar { axis: Axis::log("growth rate", 1e-6, 1.0), gradient };
    let mut cells = Cells::new([0.0, 0.0], [d, d], gradient.steps(SHADES.into()));
    let mut seed = 1u64;
    for i in 1..=159u32 {
        for j in 1..=875u32 {
            let (h1, h2) = (f64::from(i) * d, f64::from(j) * d);
            let near = h2 / half_period(h1);
            let off = near.round() - near;
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let dice = (seed >> 40) as f64 / (1u64 << 24) as f64;
            if near > 0.5 && (0.0..0.03 * near).contains(&off) {
                let depth = off / (0.03 * near);
                cells.push(i, j, bar.class(0.4 * (depth * (1.0 - depth)).sqrt(), SHADES));
            } else if dice < 0.012 * h1 * h2 {
                cells.push(i, j, bar.class(10f64.powf(-6.0 + 5.0 * (dice * 7919.0).fract()), SHADES));
            }
        }
    }
    let (x, y) = axes();
    Panel::new(x, y).titled("(a) Unstable pairs, *d* = 1/250").with(Layer::cells(cells)).bar(bar)
}

fn right() -> Panel {
    let (x, y) = axes();
    let families = [
        (0, "*a* = 0", Stroke::THICK),
        (1, "*a* = 1", Stroke::DOTTED),
        (2, "*a* = 2", Stroke::DASHED),
        (3, "*a* = 3", Stroke::THIN),
    ];
    let mut panel = Panel::new(x, y.unnumbered()).titled("(b) Curves 1/*T*_{1/2} = *a*/*h*_1 + *b*/*h*_2");
    for (a, label, stroke) in families {
        let bs = if a == 0 { 1..=5 } else { 1..=18 };
        let sign = if a == 0 { 1.0 } else { -1.0 };
        let lines = bs.map(|b| curve(f64::from(a), sign * f64::from(b))).collect();
        panel = panel.with(Layer::lines(lines, stroke).labelled(label));
    }
    for b in 1..=3 {
        panel = panel.note(
            Note::new([0.02, f64::from(b)], &format!("*b* = {b}")).anchored(Anchor::Start, [0.0, -7.0]),
        );
    }
    panel.legend(Place::Above)
}

/// Run time against error: a log-log panel with every shape of dot.
fn precision() -> Panel {
    let shapes = [Shape::Disc, Shape::Square, Shape::Diamond, Shape::Triangle, Shape::Ring, Shape::Cross];
    let names = ["f32", "f64", "half period", "Floquet", "ball 128", "exact"];
    let mut panel =
        Panel::new(Axis::log("run time (s)", 1e-7, 1e-1), Axis::log("relative error", 1e-17, 1e1))
            .titled("(c) Work and precision");
    for (i, (shape, name)) in shapes.into_iter().zip(names).enumerate() {
        let line: Vec<[f64; 2]> = (0..6)
            .map(f64::from)
            .map(|k| {
                [10f64.powf(-6.5 + 0.6 * k + 0.3 * i as f64), 10f64.powf(-2.0 - 2.4 * i as f64 + 0.5 * k)]
            })
            .collect();
        panel = panel
            .with(Layer::lines(vec![line.clone()], Stroke::LINE.in_colour(family(i))))
            .with(Layer::dots(line, shape, 4.5, family(i)).labelled(name));
    }
    panel.gridded().legend(Place::TopRight)
}

/// Arnold tongues as areas over a picture.
fn tongues() -> Panel {
    let gradient = Gradient::full();
    let bar = ColourBar { axis: Axis::linear("log_{10} |*S*_a|", -6.0, 0.0), gradient };
    let pixels = (0..120 * 80)
        .map(|k| (f64::from(k % 120) / 120.0, f64::from(k / 120) / 80.0))
        .map(|(x, y)| gradient.at(0.5 + 0.5 * (9.0 * x).sin() * (7.0 * y * x).cos()))
        .collect();
    let mut panel = Panel::new(Axis::linear("*ρ*", 0.0, 1.0), Axis::linear("*s* = *h*_1^2 *Λ*_1", 0.0, 4.0))
        .titled("(d) Tongues on a picture")
        .with(Layer::picture(Picture::new([0.0, 1.0], [0.0, 4.0], 120, pixels)));
    for m in 1..=4 {
        let s = f64::from(m) * 0.9;
        let outline = vec![[0.0, s], [1.0, s - 0.1], [1.0, s - 0.6], [0.0, s]];
        panel = panel
            .with(Layer::areas(vec![outline], family(m as usize), 0.8))
            .note(Note::new([0.8, s - 0.3], &format!("*m* = {m}")).anchored(Anchor::Middle, [0.0, 0.0]));
    }
    let level = vec![vec![[0.0, 3.9], [1.0, 0.2]]];
    panel.with(Layer::lines(level, Stroke { dash: Dash::DashDotted, ..Stroke::LINE })).bar(bar)
}

fn main() -> Result<()> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let figures = [
        ("two", Figure::double_column(95.0).named("Demo").with(left()).with(right())),
        (
            "grid",
            Figure::double_column(150.0)
                .columns(2)
                .with(precision())
                .with(tongues())
                .with(right())
                .with(left()),
        ),
        ("single", Figure::single_column(70.0).with(precision())),
    ];
    for (name, figure) in figures {
        let svg = figure.svg();
        let place = |ending: &str| Path::new(&folder).join(format!("{name}.{ending}"));
        write_output(Some(&place("svg")), svg.as_bytes())?;
        write_output(Some(&place("png")), &png::raster(&svg, 200.0)?)?;
    }
    Ok(())
}
