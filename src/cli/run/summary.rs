//! What a run says when it is done.

use std::path::Path;

use super::work::Work;
use crate::cli::args::{echo_grid, shown_range};
use crate::cli::curves;
use crate::error::Result;
use crate::report::document::Document;
use crate::scene::{Scene, Want};

/// What was written, for the closing message.
#[derive(Default)]
pub struct Summary {
    lines: Vec<String>,
    products: Vec<serde_json::Value>,
}

impl Summary {
    pub fn add(&mut self, want: Want, path: &Path, work: &Work) {
        let file = path.display().to_string();
        self.lines.push(file.clone());
        // A product's summary is told once, with its first file.
        let known = self.products.iter().any(|p| p["product"] == want.product.name());
        if let Some(summary) = work.summary(want.product).filter(|_| !known) {
            self.lines.extend(summary.lines().map(|line| format!("    {line}")));
        }
        self.products.push(serde_json::json!({"product": want.product.name(), "file": file}));
    }

    pub fn document(self, scene: &Scene) -> Document {
        let heading = if scene.title().is_empty() { vec![] } else { vec![scene.title().to_string()] };
        let lines: Vec<String> = heading.into_iter().chain(self.lines).collect();
        Document::new("run").input("title", scene.title()).entry("products", self.products).summary(&lines)
    }
}

/// Echoes what the scene gives, exactly.
pub fn echo(mut document: Document, scene: &Scene) -> Result<Document> {
    let given = scene.document();
    if given.lambda1.is_some() {
        document = document.input("lambda1", scene.lambda1()?);
    }
    if given.lambda2.is_some() {
        document = document.input("lambda2", scene.lambda2()?);
    }
    if let Ok(range) = scene.range() {
        document = echo_grid(document, range);
    }
    if given.families.is_some() {
        document = curves::echo(document, &scene.families()?);
    }
    if given.tolerance.is_some() {
        document = document.input("tolerance", scene.tolerance()?);
    }
    if given.ratio.is_some() {
        document = document.input("ratio", scene.ratio()?.to_string());
    }
    if let Some(max) = given.max {
        document = document.input("max", max);
    }
    if let Some(max_sum) = given.max_sum {
        document = document.input("max_sum", max_sum);
    }
    if let Some(rho) = scene.rho()? {
        document = document.input("rho", rho);
    }
    if let Some([h1, h2]) = scene.window()? {
        document = document.input("window_h1", shown_range(&h1)).input("window_h2", shown_range(&h2));
    }
    if let Some(colour) = &given.colour {
        document = document.input("colour", colour);
    }
    if given.rho_range.is_some() {
        let (lo, hi) = scene.rho_range()?;
        document = document.input("rho_range", format!("{lo}..{hi}"));
    }
    let want: Vec<String> = scene.want().iter().map(Want::file_name).collect();
    Ok(document.input("want", want.join(", ")))
}
