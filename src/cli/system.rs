//! `kickdrift system`: many clocks, many degrees of freedom.

use std::path::{Path, PathBuf};

use super::args::{Common, Format};
use crate::error::{Error, Result};
use crate::report::system as report;
use crate::scene::SystemScene;
use crate::system::{Limits, decide_system};

/// Flags of `system`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The system, a JSON file as data/scenes/diatomic-tether.json.
    #[arg(value_name = "FILE")]
    file: PathBuf,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let scene = read(&self.file)?;
        let limits = common.budget.map_or_else(Limits::default, |products| Limits { products });
        let analysis = decide_system(scene.system(), &limits)?;
        let document = report::document(scene.system(), &analysis)
            .input("file", self.file.file_name().unwrap_or_default().to_string_lossy())
            .input("title", scene.title());
        common.write(&document, Format::Text)
    }
}

/// A system file, read.
pub fn read(path: &Path) -> Result<SystemScene> {
    let unreadable = |cause| Error::io(path.display(), format!("cannot read the system: {cause}"));
    SystemScene::read(&std::fs::read_to_string(path).map_err(unreadable)?)
}
