//! Two measured levels as a molecule to be advised on.

use serde::Deserialize;

use super::SystemScene;
use crate::advise::unit::{self, Dimension};
use crate::advise::{Molecule, Scheme};
use crate::error::{Error, Result};

impl SystemScene {
    /// The molecule with the scheme of steps of its file, in fs.
    ///
    /// # Errors
    /// A file without `time_unit`, or with another than fs, ps, ns or s; as [`SystemScene::two_levels`].
    pub fn molecule(&self) -> Result<(Molecule, Scheme)> {
        let levels = self.two_levels()?;
        let missing =
            || Error::missing("time_unit", "say in the file what its steps are in, as \"time_unit\": \"ps\"");
        let one = format!("1 {}", self.time_unit().ok_or_else(missing)?);
        let unit = unit::rational("time_unit", &one, Dimension::Time)?;
        let labels = self.source().get("labels").map(Vec::<String>::deserialize);
        let names = labels.and_then(std::result::Result::ok).unwrap_or_default();
        let scheme = Scheme::new([levels.inner, levels.outer].map(|step| step * &unit).to_vec())?;
        Ok((Molecule::new(levels.kernel.clone(), unit, names, levels.accuracy), scheme))
    }
}
