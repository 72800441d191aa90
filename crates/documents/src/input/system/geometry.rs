//! Where the degrees of freedom of a file are in space: its atoms, or the nodes of its mesh.

use super::SystemScene;
use super::document::{Document, is_by_reference};
use number::{Error, Result, to_f64};
use systems::Geometry;

impl SystemScene {
    /// Where its degrees of freedom are.
    ///
    /// # Errors
    /// A file without `positions` and without a `mesh`.
    pub fn geometry(&self) -> Result<Geometry> {
        let document = Document::parse(&self.source, None)?;
        if is_by_reference(&self.source) {
            return self.atoms(&document);
        }
        let mesh = document.mesh.ok_or_else(missing)?;
        let (nodes, elements, moved) = mesh.placed()?;
        let point = |values: Vec<_>| std::array::from_fn(|axis| values.get(axis).map_or(0.0, to_f64));
        let points: Vec<[f64; 3]> = nodes.into_iter().map(point).collect();
        Ok(Geometry { symbols: vec!["X".into(); points.len()], points, cells: elements, moved })
    }

    fn atoms(&self, document: &Document) -> Result<Geometry> {
        let n = self.model.size();
        let points = document.positions(n, &self.arrays)?.ok_or_else(missing)?;
        let words = |i: usize| self.labels.as_ref().and_then(|all| all.get(3 * i)).map(String::as_str);
        // "O 12 x": a label that begins with an element's symbol.
        let is_symbol = |word: &&str| {
            let (first, rest) = word.split_at_checked(1).unwrap_or_default();
            !first.is_empty()
                && first.chars().all(char::is_uppercase)
                && rest.len() < 2
                && rest.chars().all(char::is_lowercase)
        };
        let named =
            |i: usize| words(i).and_then(|words| words.split(' ').next()).filter(is_symbol).unwrap_or("X");
        let symbol =
            |i: usize| document.elements.as_ref().map_or(named(i), |all| all[i].as_str()).to_string();
        let symbols = (0..points.len()).map(symbol).collect();
        let cells = document.bonded.iter().flatten().map(|pair| pair.to_vec()).collect();
        Ok(Geometry { points, symbols, cells, moved: (0..n).map(|i| (i / 3, i % 3)).collect() })
    }
}

fn missing() -> Error {
    let remedy =
        "modes are drawn in space where the file has positions, or a mesh: give one of them, or write JSON";
    Error::missing("positions", remedy)
}
