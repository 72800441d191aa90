//! Maps: Figure 1 of the paper, and agreement with the other tiers.

use kickdrift::map::{Grid, Products, Shard, for_each_band};
use kickdrift::number::parse::parse;
use kickdrift::verdict::Limits;

fn figure1(d: &str) -> Grid {
    let x = |text: &str| parse("x", text).unwrap();
    Grid::new(x("pi^2"), x("pi^2/25"), [x(d), x(d)], (x(d), x("2/pi")), (x(d), x("7/2"))).unwrap()
}

fn unstable(grid: &Grid) -> (u64, u64, u64) {
    let mut count = 0;
    let t = std::time::Instant::now();
    let counters =
        for_each_band(grid, Products::default(), Shard::WHOLE, 0, &Limits::default(), |_, band| {
            let beyond = band.tiers.iter().filter(|&&t| t != 0).count();
            if beyond > 0 {
                println!("beyond {beyond} in {}", band.first);
                let all: Vec<_> = (0..band.tiers.len())
                    .filter(|&n| band.tiers[n] != 0)
                    .map(|n| band.multipliers(grid, n))
                    .collect();
                println!("{:?}", &all[..20]);
                println!("{:?}", &all[all.len() - 20..]);
            }
            count += band.verdicts.iter().filter(|&&v| v != 0).count() as u64;
            Ok(())
        });
    println!("{:?} {counters:?}", t.elapsed());
    (counters.as_ref().unwrap().pairs, count, counters.unwrap().escalated)
}

#[test]
fn figure_1() {
    assert_eq!(unstable(&figure1("1/100")), (22_050, 2_075, 0));
    assert_eq!(unstable(&figure1("1/500")), (556_500, 55_092, 1));
    assert_eq!(unstable(&figure1("1/1000")), (2_226_000, 218_848, 0));
}
