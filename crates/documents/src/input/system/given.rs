//! Lists of a system's file: its own numbers, or an array by reference.

use std::fmt;
use std::marker::PhantomData;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};

use super::array::Reference;
use super::part::Part;
use crate::report::shape::Shape;
use number::{Error, Result};

/// What stands in the file, or an array by reference.
#[derive(Clone, Debug)]
pub(super) enum Given<T> {
    Here(T),
    Array(Reference),
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Given<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        deserializer.deserialize_any(Either(PhantomData))
    }
}

struct Either<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for Either<T> {
    type Value = Given<T>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a list, or an array as {\"npy\": \"h.npy\"},")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, all: A) -> std::result::Result<Given<T>, A::Error> {
        T::deserialize(SeqAccessDeserializer::new(all)).map(Given::Here)
    }

    fn visit_map<A: MapAccess<'de>>(self, all: A) -> std::result::Result<Given<T>, A::Error> {
        Reference::deserialize(MapAccessDeserializer::new(all)).map(Given::Array)
    }
}

impl<T> Given<T> {
    /// What stands in a file whose stiffnesses stand in it, too.
    pub fn here<'a>(given: &'a Option<Given<T>>, field: &str) -> Result<Option<&'a T>> {
        match given {
            None => Ok(None),
            Some(Given::Here(value)) => Ok(Some(value)),
            Some(Given::Array(_)) => {
                let remedy = "stands beside stiffnesses by reference alone: write it in the file, as these";
                Err(Error::input(field, "an array by reference", remedy))
            }
        }
    }
}

impl<T: Part> Part for Given<T> {
    const SHAPE: Shape = Shape::Any(&[T::SHAPE, Reference::SHAPE]);
}
