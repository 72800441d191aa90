//! Documents rechecked: what each one claims, found again by another route than the one that made it.
//!
//! A document is read once, into the typed rows of a [`Claim`]; its check holds every field against the mathematics, the
//! list's completeness included, and names the fields that it does not recheck.
//!
//! | document | made by | rechecked by |
//! |---|---|---|
//! | tongues | Rayleigh quotients of a string in doubles | exact signs of the half period at the ends of each enclosure |
//! | survey | the same | exact signs about the thin tongues and a sample of the others; the counts by the same route again |
//! | closings | Newton's method and Krawczyk's test | exact signs at both ends of the range of ρ; the resultant of the mirror ratio |
//! | verdict | the filter, as a rule | the full period, kick by kick, in exact arithmetic |
//! | map | the filter, as a rule | a sample of pairs kick by kick; the counts by the same route again |
//! | compare | the half period kick by kick, and the tan criterion | the filter for every pair, the full period for every offender |
//! | curves | arcsines | arctangents; the samples again in doubles |
//! | polynomial | products of polynomials | the full period at rational points |
//! | system-verdict, system-map, system-intervals, simulate | signs, discs, simulation | computed again; exact arithmetic; the dense full period |
//! | proposition | Bézout's identity | eqs. (9) and (10) in integers |
//! | advise-system | definite forms, counts | computed again |
//! | advise | strings, orbits in balls | the full period in balls of 512 bits, pivots of the action |
//!
//! ```
//! use kickdrift::recheck::{Claim, Options};
//! let text = r#"{"schema": "kickdrift/proposition/1", "input": {"max": "2"}, "holds": true, "resonant_points": 1,
//!     "curves": 5, "failures": [], "witnesses": [{"p": 2, "q": 1, "m": 1, "a": 0, "b": 1}]}"#;
//! let outcome = Claim::read(text).unwrap().recheck(&Options::default(), None).unwrap();
//! assert!(outcome.failures.is_empty(), "{:?}", outcome.failures);
//! // Another b, and the first row fails.
//! let outcome = Claim::read(&text.replace("\"b\": 1", "\"b\": 0")).unwrap().recheck(&Options::default(), None).unwrap();
//! assert_eq!(outcome.failures[0].row, 1);
//! ```

/// Rows of documents: every field is known, none is left over.
macro_rules! rows {
    ($($row:item)*) => {
        $(#[derive(Clone, Debug, serde::Deserialize)] #[serde(deny_unknown_fields)] $row)*
    };
}

#[cfg(feature = "advise")]
mod advise;
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
