//! Time and error of the trace.

use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::number::{Ratio, Rational};
use kickdrift::propagator::TwoClocks;
use num_traits::Signed;
use serde_json::{Value, json};

use crate::common::least;
use crate::methods::Method;

/// One method on one scene.
pub struct Row {
    pub scene: &'static str,
    pub kicks: u64,
    pub method: Method,
    pub seconds: f64,
    /// |error| / max(1, |Tr|) by exact arithmetic, in long periods by the refine tier; `None` where the method has no
    /// number, or is the judge.
    pub error: Option<f64>,
}

/// Ratios near the golden one: no period is short by accident.
const RATIOS: [(u64, u64); 6] =
    [(7, 3), (61, 39), (619, 381), (6181, 3819), (61_803, 38_197), (618_034, 381_967)];

/// Name, s, rho.
fn scenes() -> [(&'static str, Rational, Rational); 5] {
    let small = |n: i64| ratio(1, 10i64.pow(n as u32));
    [
        ("usual", ratio(1, 3), ratio(1, 25)),
        ("weak", ratio(1, 3), small(6)),
        ("strong", ratio(1, 3), ratio(10, 1)),
        ("theta near 0", small(8), ratio(1, 25)),
        ("theta near pi", ratio(4, 1) - small(6), ratio(1, 25)),
    ]
}

pub fn measure() -> Vec<Row> {
    let mut rows = Vec::new();
    for (scene, s, rho) in scenes() {
        for (p, q) in RATIOS {
            // The full length for one scene only: the others show nothing new there.
            if p + q > 20_000 && scene != "usual" {
                continue;
            }
            let clocks = TwoClocks::with_rho(Ratio::new(p, q).unwrap(), s.clone(), rho.clone());
            let reference = if p + q <= Method::Exact.patience() { Method::Exact } else { Method::Refine };
            let exact = reference.trace(&clocks).expect("a trace");
            for method in Method::ALL.into_iter().filter(|method| p + q <= method.patience()) {
                let (seconds, trace) = least(1, 0.1, || method.trace(&clocks));
                let size = if exact.abs() > ratio(1, 1) { exact.abs() } else { ratio(1, 1) };
                // The refine tier is no judge of itself.
                let judged = trace.filter(|_| method != Method::Refine || reference == Method::Exact);
                let error = judged.map(|trace| to_f64(&((trace - &exact).abs() / &size)));
                rows.push(Row { scene, kicks: p + q, method, seconds, error });
            }
        }
    }
    rows
}

pub fn print(rows: &[Row]) {
    println!(
        "{:<14} {:>9}  {:<20} {:>12} {:>14} {:>12}",
        "scene", "p + q", "method", "seconds", "ns a kick", "error"
    );
    for row in rows {
        let error = row.error.map_or("none".into(), |error| format!("{error:.1e}"));
        let each = row.seconds / row.kicks as f64 * 1e9;
        println!(
            "{:<14} {:>9}  {:<20} {:>12.3e} {each:>14.1} {error:>12}",
            row.scene,
            row.kicks,
            row.method.name(),
            row.seconds
        );
    }
}

impl Row {
    pub fn json(&self) -> Value {
        json!({
            "scene": self.scene, "kicks": self.kicks, "method": self.method.name(),
            "seconds": self.seconds, "error": self.error,
        })
    }
}
