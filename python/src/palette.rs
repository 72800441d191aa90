//! The colours of the program's figures.

use std::collections::BTreeMap;

use kickdrift::plot::palette::{
    CAUTION, COEXISTENCE, Colour, GREY, Gradient, HYPERBOLIC, INK, PARABOLIC, SAFE, UNSTABLE, family,
};
use pyo3::prelude::*;

/// Colours as `#rrggbb` by what they stand for, those of families in their order, and the 256 of growth on
/// white, weak to strong.
#[pyfunction]
pub fn palette() -> (BTreeMap<&'static str, String>, Vec<String>, Vec<String>) {
    let single = [
        ("caution", CAUTION),
        ("coexistence", COEXISTENCE),
        ("grey", GREY),
        ("hyperbolic", HYPERBOLIC),
        ("ink", INK),
        ("parabolic", PARABOLIC),
        ("safe", SAFE),
        ("unstable", UNSTABLE),
    ];
    let names = |colours: Vec<Colour>| colours.iter().map(Colour::to_string).collect();
    let single = single.map(|(name, colour)| (name, colour.to_string())).into();
    (single, names((0..8).map(family).collect()), names(Gradient::on_white().steps(256)))
}
