//! The stability of a grid of step pairs as a vector, and as a picture in letters.
//!
//!     cargo run --release --example map

use kickdrift::error::Result;
use kickdrift::map::{Grid, Map, Products};
use kickdrift::number::parse::parse;

fn main() -> Result<()> {
    // Figure 1 of the paper, coarsely: stiffnesses pi^2 and pi^2/25, all multiples of 1/25 in the window.
    let (fast, slow) = (parse("lambda1", "pi^2")?, parse("lambda2", "pi^2/25")?);
    let step = parse("step", "1/25")?;
    let h1 = (step.clone(), parse("h1", "2/pi")?);
    let h2 = (step.clone(), parse("h2", "7/2")?);
    let grid = Grid::new(fast, slow, [step.clone(), step], h1, h2)?;

    // One verdict a pair, column (h1) by column, in each by increasing h2; every one proven.
    let verdicts = Map::of(&grid).verdicts()?;
    let (columns, rows) = grid.shape();
    for row in (0..rows).rev() {
        let line =
            (0..columns).map(|column| if verdicts[column * rows + row].is_stable() { '.' } else { '#' });
        println!("{}", line.collect::<String>());
    }

    // Band by band, with the growth of the unstable pairs.
    let mut fastest: f64 = 0.0;
    Map::of(&grid).with(Products { growth: true, ..Products::default() }).for_each_band(|_, band| {
        let rates = band.growing.iter().filter_map(|pair| pair.ln_multiplier);
        fastest = rates.fold(fastest, |most, ln| most.max(ln.lo));
        Ok(())
    })?;
    println!("some pair grows at least {:.3}-fold over a period of its clocks", fastest.exp());
    Ok(())
}
