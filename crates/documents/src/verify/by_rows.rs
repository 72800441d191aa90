//! Documents of tongues and of runs: their rows are read beside their input, for both are not asked as
//! [`Question`](crate::question::Question)s yet.

use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::context::{Checked, Context, Outcome};
use super::kind::{Kind, typed};
use number::error::Result;

/// Rows of documents: what the other route needs of them. A field `T | null` must be there and may be null,
/// one of type `Option` may be missing. An input knows all of its fields. A row is named by the fields in
/// brackets.
macro_rules! rows {
    ($(
        $(#[$row:meta])*
        $visible:vis struct $name:ident $([$($by:ident),*])? {
            $($(#[$attribute:meta])* $seen:vis $field:ident: $type:ty $(| $null:ident)?,)*
        }
    )*) => {
        $(
            #[derive(Clone, Debug, serde::Deserialize)]
            $(#[$row])*
            $visible struct $name {
                $(
                    $(#[$attribute])*
                    $(#[doc = stringify!($null)] #[serde(deserialize_with = "crate::verify::written::nullable")])?
                    $seen $field: rows!(@type $type $(, $null)?),
                )*
            }

            $(impl $crate::verify::context::Place for $name {
                fn place(&self) -> String {
                    [$(format!(concat!(stringify!($by), " = {}"), self.$by)),*].join(", ")
                }
            })?
        )*
    };
    (@type $type:ty) => { $type };
    (@type $type:ty, $null:ident) => { Option<$type> };
}

/// A row that can be named.
pub trait Place: Sync {
    fn place(&self) -> String;
}

/// A document of one kind, in typed rows.
pub trait Recheck {
    /// The key of the rows.
    const TABLE: &'static str;
    /// Whether `again` reads rows of the document beside its input.
    const READS_ROWS: bool = false;
    /// The part of the answer that the other route needs.
    type Found;

    /// The document computed again from its input.
    fn again(&self, context: &Context) -> Result<(Value, Self::Found)>;

    /// The outcome of another route.
    fn check(&self, found: Self::Found, context: &Context) -> Result<Outcome>;
}

/// Kinds of such documents.
pub struct ByRows;

impl ByRows {
    pub const fn of<R: Recheck<Found = ()> + DeserializeOwned + 'static>(name: &'static str) -> Kind {
        Kind {
            name,
            table: R::TABLE,
            excluded: &[],
            by_input: !R::READS_ROWS,
            read: |document| read::<R>(document).map(drop),
            again: |document, context| {
                let claim: R = read(document)?;
                Ok((claim.again(context)?.0, Box::new(move || claim.check((), context))))
            },
        }
    }
}

fn read<R: DeserializeOwned>(document: &Map<String, Value>) -> Result<R> {
    let mut rows = document.clone();
    rows.retain(|key, _| !["schema", "kickdrift"].contains(&key.as_str()));
    typed(rows)
}

impl Context<'_> {
    /// The outcome of a whole document (named in words) and of its rows.
    pub fn outcome<T: Place>(
        &self,
        route: &'static str,
        (place, whole): (&str, Checked),
        rows: &[T],
        check: impl Fn(&T) -> Checked + Sync,
    ) -> Result<Outcome> {
        let mut outcome = self.each(route, whole, rows, check)?;
        let name = |row: u64| rows.get((row as usize).wrapping_sub(1)).map(T::place);
        for failure in &mut outcome.failures {
            failure.place = name(failure.row).unwrap_or_else(|| place.into());
        }
        Ok(outcome)
    }
}
