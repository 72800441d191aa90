//! Naive verdicts beside certified ones, over neighbouring doubles of s and rho about an edge.

use kickdrift::number::rational::{from_f64_exact, ratio};
use kickdrift::number::{Ratio, Rational};
use kickdrift::plot::palette::Colour;
use kickdrift::plot::{Axis, Cells, Figure, Layer, Panel};
use kickdrift::propagator::TwoClocks;
use kickdrift::tongue::Tongues;
use kickdrift::verdict::{Limits, decide};
use num_traits::Signed;

use crate::methods::Method;

/// Doubles to either side.
const AROUND: i64 = 50;
const RATIO: (u64, u64, u64) = (61, 39, 40);
/// A pale grey.
const PALE: Colour = Colour(0xb5, 0xb7, 0xbb);
const RED: Colour = Colour(0xc8, 0x2c, 0x3c);

pub struct Picture {
    pub figure: Figure,
    pub pairs: u64,
    pub wrong: u64,
}

pub fn picture() -> Picture {
    let (p, q, m) = RATIO;
    let rho = 0.04;
    let tongues = Tongues::new(Ratio::new(p, q).unwrap(), &exact(rho)).expect("a ratio");
    let edge = tongues.gap(m).expect("a tongue").lower.lo;
    let neighbour = |x: f64, n: i64| f64::from_bits((x.to_bits() as i64 + n) as u64);
    let side = (2 * AROUND + 1) as u32;
    let cells = || Cells::new([-AROUND as f64; 2], [1.0; 2], vec![PALE, RED]);
    let (mut naive, mut certified, mut wrong) = (cells(), cells(), 0);
    for i in 0..side {
        for j in 0..side {
            let s = exact(neighbour(edge, i64::from(i) - AROUND));
            // A unit in the last place of rho moves the edge by less than one of s: eight show a slope.
            let clocks = TwoClocks::with_rho(
                Ratio::new(p, q).unwrap(),
                s,
                exact(neighbour(rho, 8 * (i64::from(j) - AROUND))),
            );
            let truth = decide(&clocks, &Limits::default()).expect("a short period").verdict.is_stable();
            let trace = Method::DoubleFull.trace(&clocks);
            let guess = trace.is_some_and(|trace| trace.abs() < ratio(2, 1));
            wrong += u64::from(guess != truth);
            if guess != truth || !guess {
                naive.push(i, j, u16::from(guess != truth));
            }
            if !truth {
                certified.push(i, j, 0);
            }
        }
    }
    let pairs = u64::from(side * side);
    let axis = |label: &str| Axis::linear(label, -AROUND as f64 - 0.5, AROUND as f64 + 0.5);
    let panel = |title: &str, cells: Cells, label: &str| {
        Panel::new(axis("*s*, in doubles from the edge"), axis(label)).titled(title).with(Layer::cells(cells))
    };
    let rho_label = "*ρ*, in eighth doubles from 0.04";
    let figure = Figure::double_column(92.0)
        .named("Verdicts of neighbouring doubles about an edge: unstable is grey, wrong is red")
        .with(panel(&format!("f64, full period: {wrong} of {pairs} wrong (red)"), naive, rho_label))
        .with(panel("kickdrift: certified, unstable grey", certified, rho_label));
    Picture { figure, pairs, wrong }
}

fn exact(x: f64) -> Rational {
    from_f64_exact(x).expect("finite")
}
