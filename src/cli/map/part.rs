//! A map's exact input, and the directories that hold parts of maps and say of which.

use std::path::{Path, PathBuf};

use serde_json::{Map as Input, Value};

use clocks::map::Store;
use documents::input::json;
use documents::question::{Fields, Map};
use documents::report::file::write_output;
use number::{Error, Result, file};

/// The file that names the map, and what stands in it.
const NAME: &str = "map.json";
const SCHEMA: &str = "kickdrift/part/1";

/// The longest such file, in bytes: some hundred, and what a person may type in numbers.
const MOST_BYTES: u64 = 1 << 20;

/// A map in writing: its fields, whether flags are set or not.
fn written(map: &Map) -> Input<String, Value> {
    let fields = map.input().into_iter().map(|(key, text)| (key.into(), text));
    let mut all: Input<String, Value> =
        [("schema".into(), SCHEMA.into())].into_iter().chain(fields).collect();
    all.insert("label".into(), map.label.into());
    all.insert("growth".into(), map.growth.into());
    all
}

fn read(mut written: Input<String, Value>) -> Result<Map> {
    let schema = written.shift_remove("schema").unwrap_or_default();
    if schema != SCHEMA {
        return Err(Error::input("schema", schema, format!("this version reads {SCHEMA}")));
    }
    Map::read(&written)
}

/// The first field in which two maps differ: its name, here and there.
fn difference(here: &Map, there: &Map) -> Option<String> {
    let (here, there) = (written(here), written(there));
    let (key, value) = here.iter().find(|(key, value)| there[key.as_str()] != **value)?;
    Some(format!("its {key} is {value}, not {}", there[key.as_str()]))
}

/// A directory with bands of one map.
pub struct Part {
    directory: PathBuf,
    map: Map,
    store: Store,
}

impl Part {
    /// The part in a directory that exists.
    pub fn open(directory: &Path) -> Result<Part> {
        let remedy = "name a directory that kickdrift map --resume has written";
        let unreadable = |cause: &dyn std::fmt::Display| {
            Error::io(directory.join(NAME).display(), format!("cannot read ({cause}): {remedy}"))
        };
        let bytes = file::bytes(&directory.join(NAME), MOST_BYTES).map_err(|cause| unreadable(&cause))?;
        let text = String::from_utf8_lossy(&bytes);
        let map = read(json::from_str(&text).map_err(|cause| unreadable(&cause))?)?;
        let store = Store::open(directory, &map.grid()?, map.products())?;
        Ok(Part { directory: directory.to_owned(), map, store })
    }

    /// A directory for bands of this map, made where there is none.
    pub fn create(directory: &Path, map: &Map) -> Result<Part> {
        if directory.join(NAME).exists() {
            let part = Part::open(directory)?;
            let Some(difference) = difference(&part.map, map) else { return Ok(part) };
            let remedy = format!("holds another map: {difference}; choose another directory");
            return Err(Error::input("--resume", directory.display(), remedy));
        }
        let store = Store::open(directory, &map.grid()?, map.products())?;
        let text = format!("{:#}\n", Value::Object(written(map)));
        write_output(Some(&directory.join(NAME)), text.as_bytes())?;
        Ok(Part { directory: directory.to_owned(), map: map.clone(), store })
    }

    /// The map that all the parts belong to.
    pub fn common_map(parts: &[Part]) -> Result<Map> {
        let [first, others @ ..] = parts else {
            return Err(Error::input("PARTS", "none", "name the directories of the parts"));
        };
        for part in others {
            if let Some(difference) = difference(&part.map, &first.map) {
                let first = first.directory.display();
                let remedy = format!("is a part of another map than {first}: {difference}");
                return Err(Error::input("PARTS", part.directory.display(), remedy));
            }
        }
        Ok(first.map.clone())
    }

    /// The bands.
    pub fn into_store(self) -> Store {
        self.store
    }
}
