//! The summary of a run: the files of the products that its scene wants.

use std::path::Path;

use serde_json::Value;

use super::again::Recheck;
use super::context::{Context, Outcome};
use crate::question::Scene;
use number::error::Result;

const ROUTE: &str = "none: the files are named again from what the scene wants";

rows! {
    /// `kickdrift/run/1`.
    pub struct Claim {
        input: Scene,
        products: Vec<File>,
    }

    struct File [file] {
        file: String,
    }
}

impl Recheck for Claim {
    const TABLE: &'static str = "products";
    const READS_ROWS: bool = true;
    type Found = ();

    fn again(&self, _: &Context) -> Result<(Value, ())> {
        self.input.check()?;
        // The folder is a place, one for all files.
        let folder = self.products.first().and_then(|products| Path::new(&products.file).parent());
        Ok((self.input.written(folder.unwrap_or(Path::new(""))).value(), ()))
    }

    fn check(&self, (): (), context: &Context) -> Result<Outcome> {
        let mut outcome = context.outcome(ROUTE, ("the products", Ok(())), &self.products, |_| Ok(()))?;
        let left = [
            "input.*: the summary holds nothing of it but what is wanted",
            "which folder the files are in, and what they hold: verify those that are documents",
        ];
        outcome.not_rechecked.extend(left.map(String::from));
        Ok(outcome)
    }
}
