//! A million verdicts in Rust, for `performance.py`: the seconds they take, and how many are unstable.

use std::time::Instant;

use kickdrift::error::Result;
use kickdrift::map::{Resources, decide_all};
use kickdrift::number::{Laurent, Rational};
use kickdrift::propagator::{Oscillator, TwoClocks};
use rayon::prelude::*;

const SIDE: i64 = 1000;

fn main() -> Result<()> {
    let step = |k: i64| Laurent::from_rational(Rational::new(k.into(), SIDE.into()));
    let (lambda1, lambda2) = (Laurent::from_integer(10), Laurent::try_from("2/5")?);
    let pair = |n: i64| -> Result<TwoClocks<Rational>> {
        let (h1, h2) = (step(n / SIDE + 1), step(n % SIDE + 1));
        let oscillator = Oscillator::new(lambda1.clone(), lambda2.clone(), h1, h2)?;
        Ok(oscillator.clocks()?.as_rational().expect("no pi"))
    };
    let start = Instant::now();
    let pairs = (0..SIDE * SIDE).into_par_iter().map(pair).collect::<Result<Vec<_>>>()?;
    let decisions = decide_all(&pairs, &Resources::default())?;
    let seconds = start.elapsed().as_secs_f64();
    println!("{seconds} {}", decisions.iter().filter(|decision| !decision.verdict.is_stable()).count());
    Ok(())
}
