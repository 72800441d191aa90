//! Is this pair of steps stable, and what is there to say beyond yes and no?
//!
//! `cargo run --release --example verdict`

use kickdrift::error::Result;
use kickdrift::propagator::Oscillator;
use kickdrift::verdict::{Kind, Limits, decide};

fn main() -> Result<()> {
    // Stiffnesses as text, exactly: decimals, fractions and powers of pi.
    for slow_step in ["0.9", "0.98", "1", "1.02"] {
        let oscillator =
            Oscillator::builder().lambda1("pi^2").lambda2("pi^2/25").h1("1/100").h2(slow_step).build()?;
        let answer = decide(&oscillator.clocks()?, &Limits::default())?;
        let stable = if answer.verdict.is_stable() { "stable" } else { "unstable" };
        println!(
            "h2 = {slow_step}: {stable}; {}; proven by the {} tier",
            answer.verdict,
            answer.decided_by.name()
        );

        // Trace, growth and label are computed when they are asked for.
        if answer.verdict.kind() == Kind::Hyperbolic {
            let ln = answer.growth()?.ln_multiplier.as_ref().map_or(0.0, |ln| ln.mid_f64());
            println!("    every period multiplies the amplitude by {:.6}", ln.exp());
            if let (Some(m), Some((a, b))) = (answer.label()?, answer.family()?) {
                println!(
                    "    the growing solution makes {m} half turns a period: family (a, b) = ({a}, {b})"
                );
            }
        }
    }

    // Numbers of any kind serve as well; what does not fit is refused with the field, the value and the
    // remedy.
    let error = Oscillator::builder().lambda1(1).lambda2(2).h1("0").h2(1).build().unwrap_err();
    println!("{error}");
    Ok(())
}
