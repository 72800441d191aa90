//! What a run says when it is done.

use std::path::Path;

use super::work::Work;
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
        // A product's summary is shown once, with its first file.
        let known = self.products.iter().any(|p| p["product"] == want.product.name());
        if let Some(summary) = work.summary(want.product).filter(|_| !known) {
            self.lines.extend(summary.lines().map(|line| format!("    {line}")));
        }
        self.products.push(serde_json::json!({"product": want.product.name(), "file": file}));
    }

    pub fn document(self, scene: &Scene) -> Document {
        let heading = Some(scene.title.clone()).filter(|title| !title.is_empty());
        let lines: Vec<String> = heading.into_iter().chain(self.lines).collect();
        Document::new("run").inputs(scene.given()).entry("products", self.products).summary(&lines)
    }
}
