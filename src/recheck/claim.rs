//! A document of any kind in typed rows, and its check.

use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

#[cfg(feature = "advise")]
use super::advise;
use super::context::{Context, Options, Outcome, REMEDY, See};
#[cfg(feature = "system")]
use super::system;
use super::{closings, compare, curves, map, polynomial, proposition, survey, tongues, verdict};
use crate::error::{Error, Result};

macro_rules! claims {
    ($($(#[$condition:meta])? $name:literal $variant:ident $claim:path;)*) => {
        /// A document in typed rows.
        #[derive(Clone, Debug)]
        #[non_exhaustive]
        pub enum Claim {
            $($(#[$condition])? #[doc = concat!("`kickdrift/", $name, "/1`.")] $variant(Box<$claim>),)*
        }

        impl Claim {
            /// NAME of all documents `kickdrift/NAME/1` that can be rechecked.
            pub const NAMES: &'static [&'static str] = &[$($(#[$condition])? $name),*];

            /// Reads a document: JSON into rows, each field once.
            ///
            /// # Errors
            /// A text that is no JSON, a schema that cannot be rechecked, a field that is missing, unknown or not
            /// what the schema says; named by its path.
            pub fn read(text: &str) -> Result<Claim> {
                let mut document: Map<String, Value> = serde_json::from_str(text)
                    .map_err(|cause| Error::input("document", "no JSON", format!("{cause}; {REMEDY}")))?;
                // Who wrote it is no claim.
                document.remove("kickdrift");
                let schema = document.remove("schema").unwrap_or_default();
                let name = schema.as_str().and_then(|name| name.strip_prefix("kickdrift/")?.strip_suffix("/1"));
                match name {
                    $($(#[$condition])? Some($name) => Ok(Claim::$variant(Box::new(typed(document)?))),)*
                    _ => {
                        let known = Claim::NAMES.join(", ");
                        let remedy = format!("can be rechecked: kickdrift/NAME/1, NAME one of {known}");
                        Err(Error::input("schema", schema, remedy))
                    }
                }
            }

            /// NAME in `kickdrift/NAME/1`.
            pub fn name(&self) -> &'static str {
                match self {
                    $($(#[$condition])? Claim::$variant(_) => $name,)*
                }
            }

            fn check(&self, context: &Context) -> Result<Outcome> {
                match self {
                    $($(#[$condition])? Claim::$variant(claim) => claim.check(context),)*
                }
            }
        }
    };
}

claims! {
    "tongues" Tongues tongues::Claim;
    "closings" Closings closings::Claim;
    "survey" Survey survey::Claim;
    "verdict" Verdict verdict::Claim;
    "map" Map map::Claim;
    "compare" Compare compare::Claim;
    "curves" Curves curves::Claim;
    "polynomial" Polynomial polynomial::Claim;
    "proposition" Proposition proposition::Claim;
    #[cfg(feature = "advise")]
    "advise" Advise advise::Claim;
    #[cfg(feature = "advise")]
    "advise-system" AdviseSystem advise::Molecule;
    #[cfg(feature = "system")] "system-verdict" System system::Verdict;
    #[cfg(feature = "system")] "system-map" SystemMap system::Points;
    #[cfg(feature = "system")] "system-intervals" SystemIntervals system::Intervals;
    #[cfg(feature = "system")] "simulate" Simulate system::Simulated;
}

impl Claim {
    /// Rechecks every claim; progress is shown to `see`.
    ///
    /// # Errors
    /// Where a recheck costs more than the options allow; what does not hold is no error but a [`Failure`](super::Failure).
    pub fn recheck(&self, options: &Options, see: Option<See>) -> Result<Outcome> {
        self.check(&Context { options, see })
    }

    /// About how many kicks the slower route composes; 0 where that is not worth telling.
    ///
    /// # Errors
    /// An input of the document that makes no sense.
    pub fn work(&self, options: &Options) -> Result<u64> {
        match self {
            Claim::Map(claim) => claim.work(options),
            _ => Ok(0),
        }
    }
}

/// All fields by their types; one that is wrong is named by its path.
fn typed<T: DeserializeOwned>(document: Map<String, Value>) -> Result<T> {
    serde_path_to_error::deserialize(Value::Object(document)).map_err(|fault| {
        let why = format!("{}; {REMEDY}", fault.inner());
        Error::input(&fault.path().to_string(), "not what the schema says", why)
    })
}
