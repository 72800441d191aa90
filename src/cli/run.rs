//! `kickdrift run`: the products that a scene wants, nothing else; a grid is decided once, however many
//! products show it.

use std::path::{Path, PathBuf};

use super::args::{Common, TO_SEE_ROWS};
use super::paper::Paper;
use documents::format::Format;
use documents::question::{Form, LONGEST_SCENE, Scene, Want};
use documents::report::file::{Folder, write_output};
use documents::report::map::MapArrays;
use number::{Error, Result, file};

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
        let extension = common.output.as_ref().and_then(|path| path.extension()?.to_str());
        if let (Some(path), Some(_)) = (&common.output, extension.and_then(Format::of_extension)) {
            let remedy = format!(
                "a scene makes several files: name a folder for them, as {}",
                path.with_extension("").display()
            );
            return Err(Error::input("output", path.display(), remedy));
        }
        let folder = Folder::make(&common.output.clone().unwrap_or_else(|| self.default_folder()))?;
        let mut products = scene.products(Some(folder.path()), &common.work())?;
        // All products before the first file: an error leaves nothing behind.
        let written = |&Want { product, format }: &Want| {
            let form = Form { format, float: common.float, to_see: TO_SEE_ROWS, width: None };
            let draw = |figure| self.paper.bytes(figure, format, &common.command);
            // Arrays are on the disk already.
            let held = (format != Format::Npz).then(|| products.of(product).written(form, draw));
            held.transpose()
        };
        let contents = scene.want.iter().map(written).collect::<Result<Vec<_>>>()?;
        for (want, contents) in scene.want.iter().zip(contents) {
            match contents {
                Some(bytes) => write_output(Some(&folder.path().join(want.file_name())), &bytes)?,
                None => products.arrays.take().map_or(Ok(()), MapArrays::finish)?,
            }
        }
        let document = scene.summary(folder.path(), &products);
        folder.keep();
        let format = common.format.unwrap_or(Format::Text);
        let text = document.render(format)?;
        if format == Format::Text {
            common.write_to_person(&text)
        } else {
            write_output(None, text.as_bytes())
        }
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
