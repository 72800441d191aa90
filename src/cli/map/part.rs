//! A map's exact input, and the directories that hold parts of maps and say of which.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::cli::args::Stiffness;
use crate::error::{Error, Result};
use crate::map::{Grid, Products, Store};
use crate::number::Laurent;
use crate::number::parse::{parse, parse_range};
use crate::report::file::write_output;
use crate::report::plane::command;
use crate::scene::{GridRange, file, json, shown_range};

/// A grid, as it was asked for, and what is asked of it.
pub struct Map {
    pub grid: Grid,
    pub range: GridRange,
    pub products: Products,
}

impl Map {
    /// # Errors
    /// As [`Grid::new`].
    pub fn new(
        Stiffness { lambda1, lambda2 }: Stiffness,
        range: GridRange,
        products: Products,
    ) -> Result<Map> {
        Ok(Map { grid: range.of(lambda1, lambda2)?, range, products })
    }

    /// The command that asks for its pairs.
    pub fn command(&self) -> String {
        command(self.grid.lambdas(), self.range.given())
    }
}

/// The file that names the map, and what stands in it.
const NAME: &str = "map.json";
const SCHEMA: &str = "kickdrift/part/1";

/// A map in writing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    schema: String,
    lambda1: String,
    lambda2: String,
    step1: String,
    step2: String,
    h1_range: String,
    h2_range: String,
    label: bool,
    growth: bool,
}

impl Written {
    fn new(map: &Map) -> Written {
        let ((lambda1, lambda2), [step1, step2]) = (map.grid.lambdas(), map.range.steps());
        let [h1_range, h2_range] = map.range.ranges().each_ref().map(shown_range);
        let [lambda1, lambda2, step1, step2] = [lambda1, lambda2, step1, step2].map(Laurent::to_string);
        let Products { label, growth } = map.products;
        let schema = SCHEMA.into();
        Written { schema, lambda1, lambda2, step1, step2, h1_range, h2_range, label, growth }
    }

    fn read(self) -> Result<Map> {
        if self.schema != SCHEMA {
            return Err(Error::input("schema", self.schema, format!("this version reads {SCHEMA}")));
        }
        let ranges = [parse_range("h1_range", &self.h1_range)?, parse_range("h2_range", &self.h2_range)?];
        let steps = [parse("step1", &self.step1)?, parse("step2", &self.step2)?];
        let lambdas = Stiffness {
            lambda1: parse("lambda1", &self.lambda1)?,
            lambda2: parse("lambda2", &self.lambda2)?,
        };
        Map::new(lambdas, GridRange::new(steps, ranges), Products { label: self.label, growth: self.growth })
    }

    /// The first field in which two maps differ: its name, here and there.
    fn difference(&self, other: &Written) -> Option<String> {
        let value = |written: &Written| serde_json::to_value(written).expect("plain fields are JSON");
        let (here, there) = (value(self), value(other));
        let fields = here.as_object().expect("a struct is an object").iter();
        let mut differing = fields.filter(|(key, value)| there[key.as_str()] != **value);
        differing.next().map(|(key, value)| format!("its {key} is {value}, not {}", there[key.as_str()]))
    }
}

/// A directory with bands of one map.
pub struct Part {
    directory: PathBuf,
    written: Written,
    store: Store,
}

impl Part {
    /// The part in a directory that exists.
    ///
    /// # Errors
    /// Where the directory holds no map that this version knows.
    pub fn open(directory: &Path) -> Result<Part> {
        let remedy = "name a directory that kickdrift map --resume has written";
        let unreadable = |cause: &dyn std::fmt::Display| {
            Error::io(directory.join(NAME).display(), format!("cannot read ({cause}): {remedy}"))
        };
        let text = file::text(&directory.join(NAME), file::LONGEST).map_err(|cause| unreadable(&cause))?;
        let written: Written = json::from_str(&text).map_err(|cause| unreadable(&cause))?;
        let map = written.clone().read()?;
        let store = Store::open(directory, &map.grid, map.products)?;
        Ok(Part { directory: directory.to_owned(), written, store })
    }

    /// A directory for bands of this map, made where there is none.
    ///
    /// # Errors
    /// Where the directory holds another map, or cannot be written.
    pub fn create(directory: &Path, map: &Map) -> Result<Part> {
        let written = Written::new(map);
        if directory.join(NAME).exists() {
            let part = Part::open(directory)?;
            let Some(difference) = part.written.difference(&written) else { return Ok(part) };
            let remedy = format!("holds another map: {difference}; choose another directory");
            return Err(Error::input("--resume", directory.display(), remedy));
        }
        let store = Store::open(directory, &map.grid, map.products)?;
        let text = serde_json::to_string_pretty(&written).expect("plain fields are JSON") + "\n";
        write_output(Some(&directory.join(NAME)), text.as_bytes())?;
        Ok(Part { directory: directory.to_owned(), written, store })
    }

    /// The map that all the parts belong to.
    ///
    /// # Errors
    /// Where there is none, or two parts are of different maps.
    pub fn common_map(parts: &[Part]) -> Result<Map> {
        let [first, others @ ..] = parts else {
            return Err(Error::input("PARTS", "none", "name the directories of the parts"));
        };
        for part in others {
            if let Some(difference) = part.written.difference(&first.written) {
                let first = first.directory.display();
                let remedy = format!("is a part of another map than {first}: {difference}");
                return Err(Error::input("PARTS", part.directory.display(), remedy));
            }
        }
        first.written.clone().read()
    }

    /// The bands.
    pub fn into_store(self) -> Store {
        self.store
    }
}
