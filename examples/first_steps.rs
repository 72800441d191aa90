//! A thousand verdicts, all tongues of a ratio, and a map as a vector.
//!
//! `cargo run --release --example first_steps`

use kickdrift::error::Result;
use kickdrift::map::{Grid, Map};
use kickdrift::number::{parse::parse, rational::ratio};
use kickdrift::propagator::TwoClocks;
use kickdrift::tongue::Tongues;
use kickdrift::verdict::{Limits, decide};

fn main() -> Result<()> {
    // h2/h1 = 5/3 and lambda2 = lambda1/25, at a thousand steps: s = h1^2 lambda1 from 0.004 to 4.
    let stable = |k| {
        let clocks = TwoClocks::with_rho("5/3".parse()?, ratio(k, 250), ratio(1, 25));
        Ok(decide(&clocks, &Limits::default())?.verdict.is_stable())
    };
    let verdicts = (1..=1000).map(stable).collect::<Result<Vec<bool>>>()?;
    println!("{} of {} steps are stable", verdicts.iter().filter(|&&stable| stable).count(), verdicts.len());

    let tongues = Tongues::new("5/3".parse()?, &ratio(1, 25))?;
    for tongue in tongues.below(4)? {
        println!("tongue {} begins at s = {}", tongue.m, tongue.lower.hi);
    }

    let step = parse("step", "1/50")?;
    let range = (step.clone(), parse("h", "2")?);
    let steps = [step.clone(), step];
    let grid = Grid::new(parse("lambda1", "pi^2")?, parse("lambda2", "1/25")?, steps, range.clone(), range)?;
    let map: Vec<_> = Map::of(&grid).verdicts()?;
    println!(
        "{} of {} pairs are stable",
        map.iter().filter(|verdict| verdict.is_stable()).count(),
        map.len()
    );
    Ok(())
}
