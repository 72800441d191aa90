//! Time and error of edges of tongues, and of the multipliers of systems.

use kickdrift::number::Ratio;
use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::system::{Limits, System, builders, decide_system};
use kickdrift::tongue::{Entry, Tongues};
use serde_json::{Value, json};

use crate::common::least;
use crate::dense;

/// A method, what it was put to, how long it took, and its error or proven bound, relative.
pub struct Row {
    what: String,
    method: String,
    seconds: f64,
    error: f64,
}

/// The least time of all runs in a fifth of a second.
fn timed<T>(work: impl FnMut() -> T) -> (f64, T) {
    least(1, 0.2, work)
}

/// An edge in the middle of the spectrum: by doubles, and to more and more digits.
pub fn edges() -> Vec<Row> {
    let mut rows = Vec::new();
    for (p, q) in [(7, 3), (61, 39), (619, 381), (6181, 3819), (61_803, 38_197)] {
        let what = format!("edge of {p}/{q}");
        let tongues = || Tongues::new(Ratio::new(p, q).unwrap(), &ratio(1, 25)).expect("a ratio");
        let middle = tongues().zeros(Entry::B) / 2 + 1;
        let (seconds, edge) = timed(|| tongues().edges(Entry::B, middle, middle).expect("an edge").remove(0));
        let width = (edge.hi - edge.lo) / edge.lo;
        rows.push(Row { what: what.clone(), method: "doubles, certified".into(), seconds, error: width });
        for digits in [20, 50, 100].into_iter().filter(|_| p < 10_000) {
            let own = tongues();
            let (seconds, fine) = timed(|| own.refine(&edge, digits).expect("digits"));
            let error = to_f64(&(fine.width() / &fine.lo));
            rows.push(Row {
                what: what.clone(),
                method: format!("{digits} digits, certified"),
                seconds,
                error,
            });
        }
    }
    rows
}

/// Stable chains, all multipliers on the unit circle: how far off it the dense way puts them, and the radius
/// of the proven discs.
pub fn systems() -> Vec<Row> {
    let mut rows = Vec::new();
    let steps = [ratio(1, 4), ratio(3, 10), ratio(7, 20)];
    for n in [10, 50, 200] {
        let system: System =
            builders::periodic_chain(n, &[ratio(4, 1), ratio(2, 1), ratio(1, 2)], &steps).expect("a chain");
        let what = format!("chain of {n}");
        let (seconds, moduli) = timed(|| dense::multipliers(&system));
        let error = moduli.into_iter().map(|x| (x - 1.0).abs()).fold(0.0, f64::max);
        rows.push(Row { what: what.clone(), method: "dense 2n x 2n, full period".into(), seconds, error });
        let (seconds, analysis) = timed(|| decide_system(&system, &Limits::default()).expect("a verdict"));
        assert!(analysis.is_stable() && analysis.is_proof(), "{what}");
        let radii = analysis.parts.iter().flat_map(|part| &part.multipliers).filter_map(|m| m.radius);
        let error = radii.fold(0.0, f64::max);
        rows.push(Row { what, method: "kickdrift, verdict proven".into(), seconds, error });
    }
    rows
}

pub fn print(title: &str, rows: &[Row]) {
    println!("\n{title}\n{:<24} {:<28} {:>12} {:>12}", "what", "method", "seconds", "error");
    for Row { what, method, seconds, error } in rows {
        println!("{what:<24} {method:<28} {seconds:>12.3e} {error:>12.1e}");
    }
}

pub fn json(rows: &[Row]) -> Value {
    let row = |row: &Row| json!({ "what": row.what, "method": row.method, "seconds": row.seconds, "error": row.error });
    rows.iter().map(row).collect()
}
