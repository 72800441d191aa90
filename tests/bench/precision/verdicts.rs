//! Who is still right how near to an edge.

use kickdrift::number::rational::ratio;
use kickdrift::number::{Ratio, Rational};
use kickdrift::propagator::TwoClocks;
use kickdrift::tongue::Tongues;
use kickdrift::verdict::{Decidable, Limits, Tier, decide};
use num_bigint::BigInt;
use num_traits::Signed;
use serde_json::{Value, json};

use crate::methods::Method;

/// The methods that guess.
pub const NAIVE: [Method; 4] =
    [Method::SingleFull, Method::DoubleFull, Method::DoubleHalf, Method::DoubleDouble];

/// 10^-k of s beside an edge, on both sides.
pub struct Row {
    pub k: u32,
    pub cases: u64,
    /// Wrong verdicts of each of [`NAIVE`].
    pub wrong: [u64; NAIVE.len()],
    /// Wrong verdicts of the ladder, and how many its tiers decided.
    pub ladder: u64,
    pub tiers: [u64; 3],
}

pub struct Verdicts(pub Vec<Row>);

/// Edges of tongues of ratios between 10 and 1000 kicks.
fn edges() -> Vec<(u64, u64, Rational, Rational)> {
    let mut edges = Vec::new();
    for (p, q, m) in [(7, 3, 4), (13, 8, 9), (61, 39, 40), (97, 31, 20), (89, 144, 51), (619, 381, 300)] {
        for rho in [ratio(1, 25), ratio(1, 2)] {
            let tongues = Tongues::new(Ratio::new(p, q).unwrap(), &rho).expect("a ratio");
            let gap = tongues.gap(m).expect("a tongue");
            for edge in [Some(gap.lower), gap.upper].into_iter().flatten() {
                let digits = tongues.refine(&edge, 60).expect("digits");
                edges.push((p, q, rho.clone(), digits.lo));
            }
        }
    }
    edges
}

pub fn measure() -> Verdicts {
    let edges = edges();
    let rows = (1..=30).map(|k| {
        let mut row = Row { k, cases: 0, wrong: [0; NAIVE.len()], ladder: 0, tiers: [0; 3] };
        for (p, q, rho, edge) in &edges {
            for sign in [1, -1] {
                let hair = Rational::new(sign.into(), BigInt::from(10).pow(k));
                let s = edge * (ratio(1, 1) + hair);
                row.add(&TwoClocks::with_rho(Ratio::new(*p, *q).expect("a ratio"), s, rho.clone()));
            }
        }
        row
    });
    Verdicts(rows.collect())
}

impl Row {
    fn add(&mut self, clocks: &TwoClocks<Rational>) {
        let exact = Decidable::half_signs(clocks).verdict();
        let decision = decide(clocks, &Limits::default()).expect("a short period");
        self.cases += 1;
        self.ladder += u64::from(decision.verdict != exact);
        self.tiers[decision.decided_by as usize] += 1;
        for (wrong, method) in self.wrong.iter_mut().zip(NAIVE) {
            // No number is beyond all bounds: unstable.
            let stable = method.trace(clocks).is_some_and(|trace| trace.abs() < ratio(2, 1));
            *wrong += u64::from(stable != exact.is_stable());
        }
    }
}

pub fn print(Verdicts(rows): &Verdicts) {
    println!("\nwrong verdicts at s (1 ± 10^-k), s an edge, and the ladder's tiers");
    print!("{:>3} {:>6}", "k", "cases");
    NAIVE.iter().for_each(|method| print!(" {:>20}", method.name()));
    println!(" {:>8} {:>8} {:>8} {:>8}", "ladder", "filter", "refine", "exact");
    for row in rows {
        print!("{:>3} {:>6}", row.k, row.cases);
        row.wrong.iter().for_each(|wrong| print!(" {wrong:>20}"));
        let [filter, refine, exact] = row.tiers;
        println!(" {:>8} {filter:>8} {refine:>8} {exact:>8}", row.ladder);
    }
}

impl Verdicts {
    pub fn json(&self) -> Value {
        let row = |row: &Row| {
            let wrong: serde_json::Map<String, Value> = NAIVE
                .iter()
                .zip(row.wrong)
                .map(|(method, wrong)| (method.name().into(), wrong.into()))
                .collect();
            let tiers: serde_json::Map<String, Value> = [Tier::Filter, Tier::Refine, Tier::Exact]
                .iter()
                .zip(row.tiers)
                .map(|(tier, n)| (tier.name().into(), n.into()))
                .collect();
            json!({ "distance": format!("1e-{}", row.k), "cases": row.cases, "wrong": wrong, "wrong_ladder": row.ladder, "decided_by": tiers })
        };
        self.0.iter().map(row).collect()
    }
}
