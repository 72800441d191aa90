//! What motions of molecules are called.

use kickdrift::advise::{Names, Told};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

/// The name of each group of modes, mass-weighted and normalized, a row each, of atoms at these positions;
/// `None` where none of a group has one.
#[pyfunction]
pub fn motions(
    labels: Vec<String>,
    elements: Vec<String>,
    bonds: Option<Vec<[usize; 2]>>,
    positions: PyReadonlyArray2<'_, f64>,
    masses: PyReadonlyArray1<'_, f64>,
    groups: Vec<PyReadonlyArray2<'_, f64>>,
) -> Vec<Option<String>> {
    let masses = masses.as_array().to_vec();
    let told = Told { labels, elements, bonds, masses: masses.clone() };
    let rows = |array: &PyReadonlyArray2<'_, f64>| -> Vec<Vec<f64>> {
        array.as_array().rows().into_iter().map(|row| row.to_vec()).collect()
    };
    let places: Option<Vec<[f64; 3]>> =
        rows(&positions).into_iter().map(|place| place.try_into().ok()).collect();
    let names = Names::new(told, &places.unwrap_or_default(), masses);
    let name = |modes: &PyReadonlyArray2<'_, f64>| {
        let modes = rows(modes);
        names.motion(&modes.iter().map(|mode| vec![&mode[..]]).collect::<Vec<_>>())
    };
    groups.iter().map(name).collect()
}
