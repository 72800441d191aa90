//! Documents rechecked: computed again from their inputs, then held against the mathematics by another route than the one
//! that made them.
//!
//! The same input gives the same document, so whatever was changed afterwards differs from the document computed again: every
//! value is compared, and those that the input does not determine are named. What would be wrong from the start is looked
//! for by the other route.
//!
//! | document | made by | the other route |
//! |---|---|---|
//! | tongues | Rayleigh quotients of a string in doubles | exact signs of the half period at the ends of each enclosure |
//! | survey | the same | exact signs about the thin tongues and a sample of the others |
//! | closings | Newton's method and Krawczyk's test | exact signs at both ends of the range of ρ; the resultant of the mirror ratio |
//! | verdict | the filter, as a rule | the full period, kick by kick, in exact arithmetic |
//! | map | the filter, as a rule | a sample of pairs kick by kick |
//! | compare | the half period kick by kick, and the tan criterion | the filter for every pair, the full period for every offender |
//! | curves | arcsines | arctangents; the samples again in doubles |
//! | polynomial | products of polynomials | the full period at rational points |
//! | system-verdict, system-map, simulate | signs, discs, simulation | exact arithmetic; the dense full period |
//! | system-intervals | signs | none |
//! | proposition | Bézout's identity | eqs. (9) and (10) in integers |
//! | advise-system | definite forms, counts | the action over its paths; the full period kick by kick |
//! | advise | strings, orbits in balls | the full period in balls of 512 bits, pivots of the action |
//!
//! ```
//! use kickdrift::recheck::{Claim, Options};
//! let text = r#"{"schema": "kickdrift/proposition/1", "kickdrift": {"version": "0.1.0", "command": "proposition"},
//!     "input": {"max": "2"}, "holds": true, "resonant_points": 1, "curves": 5, "failures": [], "witnesses": [{"p": 2, "q": 1, "m": 1, "a": 0, "b": 1}]}"#;
//! let outcome = Claim::read(text).unwrap().recheck(&Options::default(), None).unwrap();
//! assert!(outcome.failures.is_empty(), "{:?}", outcome.failures);
//! // Another b, and the first row fails.
//! let outcome = Claim::read(&text.replace("\"b\": 1", "\"b\": 0")).unwrap().recheck(&Options::default(), None).unwrap();
//! assert_eq!(outcome.failures[0].row, 1);
//! ```

/// Rows of documents: what the other route needs of them. An input knows all of its fields.
macro_rules! rows {
    ($($row:item)*) => {
        $(#[derive(Clone, Debug, serde::Deserialize)] $row)*
    };
}

#[cfg(feature = "advise")]
mod advise;
mod again;
mod claim;
mod closings;
mod compare;
mod context;
mod curves;
mod exact;
mod map;
mod polynomial;
mod proposition;
mod sample;
mod survey;
#[cfg(feature = "system")]
mod system;
mod tongues;
mod verdict;
mod written;

pub use claim::Claim;
pub use context::{Failure, Options, Outcome, See};
