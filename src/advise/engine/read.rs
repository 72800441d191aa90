//! Which engine a text is of, and its reading.

use super::reading::{Engine, LONGEST, Reading, not_nested};
use super::{lines, openmm, xml};
use crate::error::{Error, Result};
use crate::number::Rational;

/// Reads an engine's texts, the engine recognized by their content; `outer` is the outermost step where the text does not have it.
///
/// # Errors
/// A text of no known engine; an integrator that is not symplectic; forces that would never be integrated; a number that is missing or none.
pub fn read(texts: &[&str], outer: Option<&Rational>) -> Result<Reading> {
    if texts.iter().any(|text| text.len() > LONGEST) {
        return Err(Error::input(
            "engine",
            "a text of more than 10 MB",
            "give the engine's input, not its output",
        ));
    }
    let Some((engine, text)) = texts.iter().find_map(|text| recognized(text).map(|engine| (engine, *text)))
    else {
        let remedy =
            "is the input of no engine that is known here (OpenMM, LAMMPS, GROMACS, NAMD, Tinker, i-PI)";
        return Err(Error::input(
            "engine",
            texts.first().map_or("nothing", |text| first_words(text)),
            remedy,
        ));
    };
    let mut reading = match engine {
        Engine::OpenMm => openmm::read(texts)?,
        Engine::Lammps => lines::lammps(text)?,
        Engine::Gromacs => lines::gromacs(text)?,
        Engine::Namd => lines::namd(text)?,
        Engine::Tinker => lines::tinker(text, outer)?,
        Engine::Ipi => xml::ipi(text)?,
    };
    if let Some(remark) = not_nested(&reading.scheme) {
        reading.remarks.push(format!("{} itself refuses this: {remark}", engine.name()));
    }
    Ok(reading)
}

fn first_words(text: &str) -> &str {
    text.trim().lines().next().unwrap_or("nothing")
}

fn recognized(text: &str) -> Option<Engine> {
    if text.trim_start().starts_with('<') {
        return xml::recognized(text);
    }
    if openmm::is_python(text) { Some(Engine::OpenMm) } else { lines::recognized(text) }
}
