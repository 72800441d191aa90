//! What a scene does not ask for is not done: counts of work and times, product by product, as a Markdown table.
//!
//!     cargo bench --bench skip

use std::time::Instant;

use kickdrift::map::{Counters, Grid, Products, Shard, for_each_band};
use kickdrift::number::parse::parse;
use kickdrift::number::rational::ratio;
use kickdrift::propagator::TwoClocks;
use kickdrift::tongue::{Tongues, Wanted};
use kickdrift::verdict::{Limits, Tier, decide, decide_from, growth};

/// The least time of ten runs, and what the work returned.
fn least<T>(work: impl Fn() -> T) -> (f64, T) {
    let timed = |_| {
        let start = Instant::now();
        let result = work();
        (start.elapsed().as_secs_f64(), result)
    };
    (0..10).map(timed).min_by(|a, b| a.0.total_cmp(&b.0)).expect("ten runs")
}

fn map(products: Products) -> (f64, Counters) {
    let x = |text: &str| parse("x", text).expect("a number");
    let window = |hi: &str| (x("1/500"), x(hi));
    let grid = Grid::new(x("pi^2"), x("pi^2/25"), [x("1/500"), x("1/500")], window("2/pi"), window("7/2"))
        .expect("a grid");
    least(|| {
        for_each_band(&grid, products, Shard::WHOLE, 0, &Limits::default(), |_, _| Ok(()))
            .expect("within the budget")
    })
}

fn main() {
    println!("| product | work | time, relative |\n|---|---|---|");
    let rows = [
        ("verdicts", Products::default()),
        ("verdicts and labels", Products { label: true, growth: false }),
        ("verdicts, labels, growth", Products { label: true, growth: true }),
    ];
    let base = map(Products::default()).0;
    for (name, products) in rows {
        let (seconds, counters) = map(products);
        println!(
            "| map of Figure 1 at d = 1/500, {name} | {} + {} kicks, {} pairs escalated | {:.2} |",
            counters.kicks,
            counters.kicks_again,
            counters.escalated,
            seconds / base
        );
    }
    let clocks = TwoClocks::with_rho(3499, 631, ratio(1, 3), ratio(1, 25));
    let limits = Limits::default();
    let (base, decision) = least(|| decide(&clocks, &limits).expect("short"));
    println!("| verdict at p + q = 4130 | 316 updates, {} | 1.00 |", decision.decided_by.name());
    let (seconds, _) = least(|| growth(&clocks, decision.verdict, &limits).expect("short"));
    println!("| its trace, growth and label | 2065 kicks in 128 bits | {:.0} |", seconds / base);
    let (seconds, _) = least(|| decide_from(Tier::Exact, &clocks, &limits).expect("short"));
    println!("| its verdict by exact arithmetic alone | 2065 kicks | {:.0} |", seconds / base);
    tongues();
}

fn tongues() {
    let new = || Tongues::new(97, 61, &ratio(1, 25)).expect("a ratio");
    let (base, edges) = least(|| {
        let mut tongues = new();
        tongues.gap(50).expect("a tongue");
        tongues.effort()
    });
    println!(
        "| one tongue of 97/61 | {} edges in doubles, {} with more bits | 1.00 |",
        edges.doubles, edges.precise
    );
    let (seconds, edges) = least(|| {
        let mut tongues = new();
        tongues.all().expect("tongues");
        tongues.effort()
    });
    println!(
        "| all its tongues | {} edges in doubles, {} with more bits | {:.1} |",
        edges.doubles,
        edges.precise,
        seconds / base
    );
    let (seconds, edges) = least(|| {
        let mut tongues = new();
        let all = tongues.all().expect("tongues");
        let wanted = Wanted { growth: true, ..Wanted::default() };
        all.iter().for_each(|gap| drop(tongues.row(gap, &wanted)));
        tongues.effort()
    });
    println!(
        "| ... and their largest growth rates | {} edges in doubles, {} with more bits | {:.1} |",
        edges.doubles,
        edges.precise,
        seconds / base
    );
}
