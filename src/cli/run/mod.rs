//! `kickdrift run`: the products that a scene wants, nothing else; a grid is decided once, however many
//! products show it.

mod work;

use std::path::{Path, PathBuf};

use super::args::Common;
use super::paper::Paper;
use documents::format::Format;
use documents::question::{LONGEST_SCENE, Scene};
use documents::report::file::{Folder, write_output};
use number::error::{Error, Result};
use number::file;
use work::Work;

/// Flags of `run`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The scene, a JSON file as data/scenes/figure1.json.
    #[arg(value_name = "SCENE.json")]
    scene: PathBuf,
    #[command(flatten)]
    paper: Paper,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        if let Some(format @ (Format::Csv | Format::Latex)) = common.format {
            let remedy = "a scene's products have their own formats, and the summary is text or json";
            return Err(Error::input("format", format.name(), remedy));
        }
        let scene = Scene::from_json(&self.text()?)?;
        self.paper.check(scene.want.iter().any(|want| want.product.is_figure()))?;
        let folder = Folder::make(&common.output.clone().unwrap_or_else(|| self.default_folder()))?;
        let work = Work::new(&scene, common, &self.paper, folder.path());
        // All products before the first file: an error leaves nothing behind.
        let contents = scene.want.iter().map(|want| work.contents(*want)).collect::<Result<Vec<_>>>()?;
        let mut lines: Vec<String> =
            Some(scene.title.clone()).filter(|title| !title.is_empty()).into_iter().collect();
        let mut shown = Vec::new();
        for (want, contents) in scene.want.iter().zip(contents) {
            let (product, path) = (want.product, folder.path().join(want.file_name()));
            work.write(contents, &path)?;
            lines.push(path.display().to_string());
            // A product's summary is shown once, with its first file.
            if let Some(summary) = work.summary(product).filter(|_| !shown.contains(&product)) {
                lines.extend(summary.lines().map(|line| format!("    {line}")));
            }
            shown.push(product);
        }
        let document = scene.written(folder.path()).summary(&lines);
        folder.keep();
        let format = common.format.unwrap_or(Format::Text);
        write_output(None, document.render(format)?.as_bytes())
    }

    /// The text of the scene file; no more of it than a scene may have.
    fn text(&self) -> Result<String> {
        file::text(&self.scene, LONGEST_SCENE as u64).map_err(|cause| {
            let remedy = "name a scene file, such as data/scenes/figure1.json";
            Error::io(self.scene.display(), format!("cannot read the scene ({cause}): {remedy}"))
                .caused_by(cause)
        })
    }

    /// `out/` and the scene's name.
    fn default_folder(&self) -> PathBuf {
        Path::new("out").join(self.scene.file_stem().unwrap_or_default())
    }
}
