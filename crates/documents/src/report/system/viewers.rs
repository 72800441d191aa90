//! The growing modes in space, as viewers read them: extended XYZ, VTK's unstructured grids.

use std::fmt::Write;

use super::beside::{SHOWN_MODES, fastest};
use number::{Error, Result};
use systems::{Analysis, Geometry, Instability};

/// The fastest modes, each with its number in documents.
fn modes<'a>(analysis: &'a Analysis, geometry: &Geometry) -> Result<Vec<(usize, &'a Instability)>> {
    let (modes, _) = fastest(analysis, SHOWN_MODES);
    if modes.is_empty() {
        let found = format!("the modes that grow, of a system that is {}", analysis.kind_name());
        return Err(Error::input("output", found, "none is known: choose an unstable step, or another form"));
    }
    if modes.iter().any(|(_, instability)| instability.shape.len() != geometry.moved.len()) {
        let remedy =
            "the modes have other degrees of freedom than the points that the file places: write JSON";
        return Err(Error::input("output", "these modes", remedy));
    }
    Ok(modes)
}

/// A shape as one vector a point, 0 where a point is fixed.
fn vectors(shape: &[f64], geometry: &Geometry) -> Vec<[f64; 3]> {
    let mut vectors = vec![[0.0; 3]; geometry.points.len()];
    shape.iter().zip(&geometry.moved).for_each(|(x, &(point, axis))| vectors[point][axis] = *x);
    vectors
}

/// Whether a shape turns into another one: then both are written.
fn turns(instability: &Instability) -> bool {
    instability.quadrature.iter().any(|x| *x != 0.0)
}

/// One frame a growing mode, the columns `mode` and, where two modes collide, `quadrature`: positions a
/// quarter turn of the beat later. Rounded.
///
/// # Errors
/// Where no mode grows; where the modes are of other points.
pub fn xyz(analysis: &Analysis, geometry: &Geometry) -> Result<String> {
    let mut text = String::new();
    for (n, instability) in modes(analysis, geometry)? {
        let shapes: Vec<_> =
            [Some(&instability.shape), turns(instability).then_some(&instability.quadrature)]
                .into_iter()
                .flatten()
                .collect();
        let names = ["mode", "quadrature"].iter().take(shapes.len()).map(|name| format!(":{name}:R:3"));
        let lambda = instability.multiplier.lambda;
        let rate = instability
            .growth_rate
            .map_or(String::new(), |(lo, hi)| format!(" growth_rate=\"{lo:e} {hi:e}\""));
        let _ = writeln!(
            text,
            "{}\nProperties=species:S:1:pos:R:3{} number={n} multiplier=\"{} {}\"{rate}",
            geometry.points.len(),
            names.collect::<String>(),
            lambda.re,
            lambda.im
        );
        let columns: Vec<_> = shapes.into_iter().map(|shape| vectors(shape, geometry)).collect();
        for (i, (symbol, point)) in geometry.symbols.iter().zip(&geometry.points).enumerate() {
            let numbers = std::iter::once(point).chain(columns.iter().map(|values| &values[i])).flatten();
            let _ = writeln!(text, "{symbol}{}", numbers.map(|x| format!(" {x}")).collect::<String>());
        }
    }
    Ok(text)
}

/// All growing modes on one grid, a vector a point each: `mode 1` and so on, by their numbers in documents.
/// Rounded.
///
/// # Errors
/// As [`xyz`].
pub fn vtu(analysis: &Analysis, geometry: &Geometry) -> Result<String> {
    let modes = modes(analysis, geometry)?;
    let points: Vec<[usize; 1]> = (0..geometry.points.len()).map(|i| [i]).collect();
    // Where nothing joins the points, each is a cell.
    let cells: Vec<&[usize]> = match geometry.cells.is_empty() {
        true => points.iter().map(|point| point.as_slice()).collect(),
        false => geometry.cells.iter().map(Vec::as_slice).collect(),
    };
    let list = |numbers: Vec<String>| numbers.join(" ");
    let floats = |rows: &[[f64; 3]]| list(rows.iter().flatten().map(f64::to_string).collect());
    let array = |kind: &str, name: &str, width: usize, numbers: String| {
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{width}\" format=\"ascii\">{numbers}</DataArray>\n"
        )
    };
    let shapes = modes.into_iter().flat_map(|(n, instability)| {
        let turned = turns(instability).then_some((format!("quadrature {n}"), &instability.quadrature));
        [Some((format!("mode {n}"), &instability.shape)), turned].into_iter().flatten()
    });
    let shapes: String =
        shapes.map(|(name, values)| array("Float64", &name, 3, floats(&vectors(values, geometry)))).collect();
    // VTK's vertex, line, triangle and tetrahedron.
    let kind = |cell: &&[usize]| ["1", "3", "5", "10"][cell.len().clamp(1, 4) - 1].to_string();
    let ends = cells.iter().scan(0, |end, cell| {
        *end += cell.len();
        Some(end.to_string())
    });
    let joined = cells.iter().flat_map(|cell| cell.iter().map(usize::to_string)).collect();
    let cells_text = array("Int64", "connectivity", 1, list(joined))
        + &array("Int64", "offsets", 1, list(ends.collect()))
        + &array("UInt8", "types", 1, list(cells.iter().map(kind).collect()));
    Ok(format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n\
         <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>\n{shapes}</PointData>\n<Points>\n{}</Points>\n<Cells>\n{cells_text}\
         </Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
        geometry.points.len(),
        cells.len(),
        array("Float64", "points", 3, floats(&geometry.points))
    ))
}
