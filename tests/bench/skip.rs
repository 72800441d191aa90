//! What a scene does not ask for is not done: counts of work and times, product by product, as a Markdown
//! table.
//!
//!     cargo bench --bench skip

use kickdrift::map::{Counters, Map, Products};
use kickdrift::number::rational::ratio;
use kickdrift::propagator::TwoClocks;
use kickdrift::tongue::{Tongues, Wanted};
use kickdrift::verdict::{Limits, Tier, decide, decide_from, growth};

mod common;

use common::{figure_1, least};

/// The least time of ten runs, and what the work returned.
fn timed<T>(work: impl FnMut() -> T) -> (f64, T) {
    least(10, 0.0, work)
}

fn map(products: Products) -> (f64, Counters) {
    let grid = figure_1(500);
    timed(|| Map::of(&grid).with(products).for_each_band(|_, _| Ok(())).expect("within the budget"))
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
    let clocks = TwoClocks::with_rho("3499/631".parse().unwrap(), ratio(1, 3), ratio(1, 25));
    let limits = Limits::default();
    let (base, decision) = timed(|| decide(&clocks, &limits).expect("short"));
    println!("| verdict at p + q = 4130 | 316 updates, {} | 1.00 |", decision.decided_by.name());
    let (seconds, _) = timed(|| growth(&clocks, decision.verdict, &limits).expect("short"));
    println!("| its trace, growth and label | 2065 kicks in 128 bits | {:.0} |", seconds / base);
    let (seconds, _) = timed(|| decide_from(Tier::Exact, &clocks, &limits).expect("short"));
    println!("| its verdict by exact arithmetic alone | 2065 kicks | {:.0} |", seconds / base);
    tongues();
}

fn tongues() {
    let new = || Tongues::new("97/61".parse().unwrap(), &ratio(1, 25)).expect("a ratio");
    let (base, edges) = timed(|| {
        let tongues = new();
        tongues.gap(50).expect("a tongue");
        tongues.effort()
    });
    println!(
        "| one tongue of 97/61 | {} edges in doubles, {} with more bits | 1.00 |",
        edges.doubles, edges.precise
    );
    let (seconds, edges) = timed(|| {
        let tongues = new();
        tongues.all().expect("tongues");
        tongues.effort()
    });
    println!(
        "| all its tongues | {} edges in doubles, {} with more bits | {:.1} |",
        edges.doubles,
        edges.precise,
        seconds / base
    );
    let (seconds, edges) = timed(|| {
        let tongues = new();
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
