//! A million verdicts in Rust, for `performance.py`: the seconds they take, and how many are unstable.

use std::time::Instant;

use kickdrift::error::Result;
use kickdrift::map::{Pairs, Resources};
use kickdrift::number::{Laurent, Rational};

const SIDE: i64 = 1000;

fn main() -> Result<()> {
    let step = |k: i64| Laurent::from_rational(Rational::new(k.into(), SIDE.into()));
    let (lambda1, lambda2) = (Laurent::from_integer(10), Laurent::try_from("2/5")?);
    let start = Instant::now();
    let steps = (0..SIDE * SIDE).map(|n| [step(n / SIDE + 1), step(n % SIDE + 1)]);
    let decisions = Pairs::of_steps(lambda1, lambda2, steps)?.verdicts(&Resources::default())?;
    let seconds = start.elapsed().as_secs_f64();
    println!("{seconds} {}", decisions.iter().filter(|decision| !decision.verdict.is_stable()).count());
    Ok(())
}
