//! Which engine a text is of, and its reading.

use std::sync::LazyLock;

use super::evidence::{Known, evidence};
use super::reading::{Engine, LONGEST, Reading, not_nested};
use super::{gromacs, ipi, lammps, namd, openmm, others, tinker, xml};
use number::{Error, Rational, Result};

const NONE: &str =
    "is the input of no engine that is known here (OpenMM, LAMMPS, GROMACS, NAMD, Tinker, Tinker-HP, i-PI)";

static KNOWN: LazyLock<[Known; 4]> =
    LazyLock::new(|| [lammps::WORDS, gromacs::WORDS, namd::WORDS, tinker::WORDS].map(Known::new));

/// Reads an engine's texts, the engine recognized by their content; `outer` is the outermost step where the
/// text does not have it.
///
/// # Errors
/// A text of no known engine; an integrator that is not symplectic; forces that would never be integrated; a
/// number that is missing or none.
pub fn read(texts: &[&str], outer: Option<&Rational>) -> Result<Reading> {
    if texts.iter().any(|text| text.len() > LONGEST) {
        let remedy = "give the engine's input, not its output";
        return Err(Error::input("engine", "a text of more than 10 MB", remedy));
    }
    let texts: Vec<&str> = texts.iter().map(|text| unmarked(text)).collect();
    let mut reading = of_texts(&texts, outer)?;
    if let Some(remark) = not_nested(&reading.scheme, reading.unit) {
        reading.remarks.push(format!("{} itself refuses this: {remark}", reading.engine.name()));
    }
    Ok(reading)
}

/// Without a byte order mark, read as UTF-8 or as Latin-1.
fn unmarked(text: &str) -> &str {
    let mark =
        |text: &'_ str| ["\u{feff}", "\u{ef}\u{bb}\u{bf}"].into_iter().find(|mark| text.starts_with(mark));
    mark(text).map_or(text, |mark| &text[mark.len()..])
}

fn of_texts(texts: &[&str], outer: Option<&Rational>) -> Result<Reading> {
    for text in texts {
        if xml::is_xml(text) {
            return match xml::recognized(text)? {
                Engine::Ipi => ipi::ipi(text),
                _ => openmm::read(texts),
            };
        }
        if openmm::is_python(text) {
            return openmm::read(texts);
        }
        if let Some(reading) = of_log(text) {
            return reading;
        }
        if let Some(refusal) = others::refusal(text) {
            return Err(refusal);
        }
        if let Some(reading) = of_lines(text, outer)? {
            return Ok(reading);
        }
    }
    let first = texts
        .first()
        .map_or("nothing".into(), |text| format!("a text that begins with {:?}", first_words(text)));
    Err(Error::input("engine", first, NONE))
}

/// What an engine wrote about its run.
fn of_log(text: &str) -> Option<Result<Reading>> {
    [lammps::of_log, namd::of_log, gromacs::of_log].iter().find_map(|of_log| of_log(text))
}

/// A text of lines of keys and values.
fn of_lines(text: &str, outer: Option<&Rational>) -> Result<Option<Reading>> {
    let Some(evidence) = evidence(text, &*KNOWN) else { return Ok(None) };
    let mut reading = match evidence.engine {
        Engine::Lammps => lammps::read(text)?,
        Engine::Gromacs => gromacs::read(text)?,
        Engine::Namd => namd::read(text)?,
        _ => tinker::read(text, outer)?,
    };
    if let [first, ..] = &evidence.unknown[..] {
        let (name, all) = (evidence.engine.name(), evidence.unknown.len());
        let more = if all > 1 { format!(" and {} more", all - 1) } else { String::new() };
        if let Some(default) = &reading.default {
            let remedy = format!(
                "stands nowhere, and {name} knows no {first}{more}, so that its default of {default} is not taken: write it"
            );
            return Err(Error::input("step", "of the text", remedy));
        }
        let shown = evidence.unknown.iter().take(5).map(String::as_str).collect::<Vec<_>>().join(", ");
        let more = if all > 5 { format!(" and {} more", all - 5) } else { String::new() };
        reading.remarks.push(format!("not understood, since {name} has no such words: {shown}{more}"));
    }
    Ok(Some(reading))
}

fn first_words(text: &str) -> &str {
    text.trim().lines().next().unwrap_or("nothing")
}
