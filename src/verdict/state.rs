//! The propagator over any number of steps, which nobody follows one by one.

use num_bigint::BigUint;

use crate::error::{Error, Result};
use crate::number::{Ball, Real};
use crate::orbit::returns;
use crate::parallel::go_on;
use crate::propagator::LongClocks;

/// [[xx, xv], [vx, vv]] over n steps of the slow clock, enclosed in some 70 digits: from the middle of the kicks at t = 0 to the
/// middle of the slow kick at n h2, in the time unit h1. Whole periods are a power by squaring, the rest is a walk through return
/// maps (THEORY section 15), so n may be 10^18.
///
/// ```
/// use kickdrift::number::rational::ratio;
/// use kickdrift::propagator::{LongClocks, TwoClocks};
/// use kickdrift::verdict::propagator_after;
/// // Verlet at s = 1 turns by 60 degrees a step, and 10^18 = 4 mod 6.
/// let verlet = LongClocks::from(&TwoClocks::with_rho("1/1".parse()?, ratio(1, 1), ratio(0, 1)));
/// let [xx, xv, vx, vv] = propagator_after(&verlet, 10u64.pow(18))?;
/// assert!(xx.contains(&ratio(-1, 2)) && vv.contains(&ratio(-1, 2)));
/// assert!(xv.contains(&ratio(-1, 1)) && vx.contains(&ratio(3, 4)));
/// # Ok::<(), kickdrift::error::Error>(())
/// ```
///
/// # Errors
/// A budget error where 256 bits do not enclose the entries, or these have more than 2^58 binary digits. `Stopped`.
pub fn propagator_after<S: Real>(clocks: &LongClocks<S>, steps: u64) -> Result<[Ball; 4]> {
    let found = returns::after(clocks, &BigUint::from(steps));
    go_on()?;
    found.ok_or_else(|| {
        let work = format!("256 bits do not enclose the state after {steps} steps");
        Error::too_much(work, "choose fewer steps, or weaker kicks")
    })
}
