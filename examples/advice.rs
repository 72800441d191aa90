//! Is 5 fs safe for flexible water? And which outer step is?
//!
//!     cargo run --release --example advice

use kickdrift::advise::{Mode, Question, Scheme, unit};
use kickdrift::error::Result;
use kickdrift::number::rational::ratio;

fn main() -> Result<()> {
    let modes = vec![Mode::from_period("OH=10fs")?, Mode::from_period("slow=40fs")?];
    let schemes =
        vec![Scheme::new(vec![ratio(1, 2), ratio(4, 1)])?, Scheme::new(vec![ratio(1, 2), ratio(5, 1)])?];
    // Every period may be 5 % shorter or longer.
    let advice = Question::new(modes, schemes, ratio(1, 20))?.answer()?;
    for answer in &advice.schemes {
        println!("{} fs: {}", unit::decimal(answer.scheme.outer()), answer.status.name());
        for first in answer.rows.iter().filter_map(|row| row.first.as_ref()) {
            println!("  unstable from {} fs on", first.lower.0);
        }
    }
    let safe = advice.schemes[0].safe.as_ref().expect("0.5 fs inside leaves room");
    println!("advice: {} fs", unit::decimal(safe));
    Ok(())
}
