//! One pair of steps: all that there is to say.

use std::sync::atomic::AtomicBool;

use serde_json::{Value, json};

use super::query::Query;
use super::reply::Reply;
use super::session::Session;
use crate::error::Result;
use crate::number::parse::parse;
use crate::propagator::Oscillator;
use crate::report::verdict::Answer;
use crate::verdict::{Limits, decide};

/// Kicks that one tier may compose.
pub(super) const MOST_KICKS: u64 = 3_000_000;

const LIMITS: Limits = Limits { kicks: MOST_KICKS };

/// The verdict's document, and what the page shows beside it.
pub(super) fn answer(session: &Session, query: &Query, _stop: &AtomicBool) -> Result<Reply> {
    let oscillator = oscillator(session, query)?;
    let answer = decided(&oscillator)?;
    let mut body = answer.document().value();
    body["tenfold"] = tenfold(&body, &oscillator);
    body["command"] = command(&oscillator).into();
    Ok(Reply::json(&body))
}

/// The pair that is asked about.
fn oscillator(session: &Session, query: &Query) -> Result<Oscillator> {
    let (lambda1, lambda2) = query.stiffnesses(session)?;
    Oscillator::new(lambda1, lambda2, query.need("h1", parse)?, query.need("h2", parse)?)
}

fn decided(oscillator: &Oscillator) -> Result<Answer> {
    let clocks = oscillator.clocks();
    // Rational strengths make every tier cheaper, whatever the stiffnesses and steps look like.
    let (decision, growth) = match clocks.as_rational() {
        Some(rational) => {
            let answer = decide(&rational, &LIMITS)?;
            (answer.decision(), answer.growth()?.clone())
        }
        None => {
            let answer = decide(&clocks, &LIMITS)?;
            (answer.decision(), answer.growth()?.clone())
        }
    };
    let exact_trace = Answer::exact_trace(&clocks, false);
    Ok(Answer { oscillator: oscillator.clone(), decision, growth, exact_trace, friction: None })
}

/// Slow steps and time until the amplitude is tenfold.
fn tenfold(document: &Value, oscillator: &Oscillator) -> Value {
    let rate = document["growth_rate"]["lo"].as_f64().unwrap_or(0.0);
    let time = std::f64::consts::LN_10 / rate;
    let steps = time / oscillator.h2().to_f64();
    if steps.is_finite() { json!({"steps": steps, "time": time}) } else { Value::Null }
}

/// The line that gives the same answer.
fn command(oscillator: &Oscillator) -> String {
    let quantities = [
        ("lambda1", oscillator.lambda1()),
        ("lambda2", oscillator.lambda2()),
        ("h1", oscillator.h1()),
        ("h2", oscillator.h2()),
    ];
    // Quotes only where a shell would see more than a word.
    let quoted = |text: String| if text.contains(['*', ' ', '(']) { format!("'{text}'") } else { text };
    let flags = quantities.map(|(name, x)| format!(" --{name} {}", quoted(x.to_string())));
    format!("kickdrift verdict{}", flags.concat())
}
