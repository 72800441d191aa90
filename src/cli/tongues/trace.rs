//! Traces through the tongues of one ratio.

use plot::{Figure, Foot};

use crate::error::{Error, Result};
use crate::number::{Ratio, Rational};
use crate::report::tongues::trace::figure;
use crate::tongue::Labels;
use crate::tongue::sampled::Trace;

/// Beyond this tongues are thinner than lines.
const MOST_SUM: u64 = 40;

/// Tr Q through the tongues of a ratio, and through one of them: that of `labels`, else the widest.
///
/// # Errors
/// A ratio with too many tongues, more than one label, and those of [`Trace::through`].
pub fn drawn(ratio: Ratio, rho: &Rational, labels: Option<&Labels>) -> Result<Figure> {
    if ratio.kicks() > MOST_SUM {
        return Err(Error::input("ratio", ratio, format!("traces are readable for p + q <= {MOST_SUM}")));
    }
    let m = labels.map(one).transpose()?;
    let trace = Trace::through(ratio, rho, m)?;
    let foot = Foot::default().value("*h*_2/*h*_1", ratio).value("*ρ*", rho).value("*m*", trace.near.m);
    Ok(figure(&trace).footed(&foot))
}

fn one(labels: &Labels) -> Result<u64> {
    match labels.0[..] {
        [(m, upto)] if m == upto => Ok(m),
        _ => Err(Error::input("m", labels, "give one label: the trace goes through one tongue")),
    }
}
