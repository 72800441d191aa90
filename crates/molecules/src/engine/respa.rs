//! Levels of LAMMPS's `run_style respa`: which force is on which, and which levels are clocks.

use std::collections::HashSet;

use super::lines::{Line, Word, last};
use number::{Error, Rational, Result};

/// LAMMPS wants every force on a level at least as far out as that of the one before.
pub(super) fn refuse_order(forces: &[(String, usize)], shown: &str) -> Result<()> {
    let at =
        |key: &&str| forces.iter().find(|force| force.0 == **key).map(|force| (force.0.as_str(), force.1));
    let order: Vec<(&str, usize)> = KEYWORDS.iter().filter(|key| **key != "hybrid").filter_map(at).collect();
    match order.windows(2).find(|pair| pair[1].1 < pair[0].1) {
        Some(pair) => {
            let remedy = format!("LAMMPS refuses {} on a level below {}", pair[1].0, pair[0].0);
            Err(Error::input("run_style", shown, remedy))
        }
        None => Ok(()),
    }
}

/// The levels that are clocks: equal steps are one, a level without a force is none.
pub(super) fn clocks(steps: Vec<Rational>, forces: Vec<String>) -> (Vec<Rational>, Vec<String>, Vec<String>) {
    let mut found: Vec<(Rational, Vec<String>)> = Vec::new();
    let (mut empty, mut equal) = (Vec::new(), false);
    for (level, (step, text)) in steps.into_iter().zip(forces).enumerate() {
        if text.is_empty() {
            empty.push((level + 1).to_string());
            continue;
        }
        match found.last_mut().filter(|(last, _)| *last == step) {
            Some((_, all)) => {
                all.push(text);
                equal = true;
            }
            None => found.push((step, vec![text])),
        }
    }
    let mut remarks = Vec::new();
    if !empty.is_empty() {
        remarks
            .push(format!("no force is on level {}: it is no clock (LAMMPS warns of it)", empty.join(", ")));
    }
    if equal {
        remarks.push("levels of equal steps are taken as one".into());
    }
    let (steps, forces) = found.into_iter().map(|(step, texts)| (step, texts.join(", "))).unzip();
    (steps, forces, remarks)
}

/// A part of `pair_style hybrid` or `hybrid/overlay`.
pub(super) struct PairStyle<'a> {
    pub name: &'a str,
    /// `non_conservative on`, as metatomic has it: forces that are predicted, not derived.
    pub is_direct: bool,
}

/// The parts of the pair style, each begun by a word that `pair_coeff` names as a style.
pub(super) fn pair_styles<'a>(lines: &[Line<'a>]) -> Vec<PairStyle<'a>> {
    let Some(style) = last(lines, "pair_style") else { return vec![] };
    if !style.words.get(1).is_some_and(|word| word.0.starts_with("hybrid")) {
        return vec![];
    }
    let coefficients = lines.iter().filter(|line| line.key() == "pair_coeff");
    let names: HashSet<&str> = coefficients.filter_map(|line| Some(line.words.get(3)?.0)).collect();
    let words: Vec<&str> = style.words[2..].iter().map(|word| word.0).collect();
    let begins: Vec<usize> = (0..words.len()).filter(|&k| names.contains(words[k])).collect();
    let part = |(k, &from): (usize, &usize)| {
        let texts = &words[from..begins.get(k + 1).copied().unwrap_or(words.len())];
        let is_direct = texts.windows(2).any(|pair| pair[0] == "non_conservative" && is_on(pair[1]));
        PairStyle { name: words[from], is_direct }
    };
    begins.iter().enumerate().map(part).collect()
}

fn is_on(word: &str) -> bool {
    ["on", "yes", "true"].iter().any(|on| word.eq_ignore_ascii_case(on))
}

pub(super) const BONDED: [&str; 4] = ["bond", "angle", "dihedral", "improper"];

/// Each force with its level, as LAMMPS sets them: `hybrid` has a level for each part of the pair style, a
/// word that is given twice its last one.
///
/// # Errors
/// A word that LAMMPS does not know there, or a level that there is not.
fn named(rest: &[Word], styles: &[PairStyle], levels: usize) -> Result<Vec<(String, usize)>> {
    let mut found: Vec<(String, usize)> = Vec::new();
    let mut words = rest.iter().map(|word| word.0).peekable();
    let mut keys = 0;
    while let Some(key) = words.next() {
        keys += 1;
        if keys > 2 * KEYWORDS.len() || !KEYWORDS.contains(&key) {
            let remedy =
                format!("LAMMPS knows no such word behind the factors: there are {}", KEYWORDS.join(", "));
            return Err(Error::input("run_style", key, remedy));
        }
        let mut next = || words.next_if(|word| word.parse::<f64>().is_ok());
        if key == "hybrid" {
            let object = std::iter::from_fn(&mut next).map(str::parse::<usize>);
            let name = |k: usize| {
                styles.get(k).map_or_else(|| format!("pair {}", k + 1), |pair_style| pair_style.name.into())
            };
            found.extend(object.enumerate().filter_map(|(k, level)| Some((name(k), level.ok()?))));
        } else {
            found.retain(|found| found.0 != key);
            found.extend(next().and_then(|level| level.parse().ok()).map(|level| (key.to_string(), level)));
            // The distances of `inner`, `middle` and `outer`.
            std::iter::from_fn(next).for_each(drop);
        }
    }
    match found.iter().find(|pair| pair.1 < 1 || pair.1 > levels) {
        Some((key, level)) => Err(Error::input(
            "run_style",
            format!("{key} {level}"),
            format!("there are levels 1 to {levels}"),
        )),
        None => Ok(found),
    }
}

const KEYWORDS: [&str; 10] =
    ["bond", "angle", "dihedral", "improper", "pair", "inner", "middle", "outer", "hybrid", "kspace"];

/// The same with the defaults: bonded forces on the level of the bonded one before, the first on 1; pairs on
/// the last level, the sum over waves with them. A force that is not named and has no style is none.
pub(super) fn on_levels(
    rest: &[Word],
    lines: &[Line],
    there: &dyn Fn(&str) -> bool,
    styles: &[PairStyle],
    levels: usize,
) -> Result<Vec<(String, usize)>> {
    let mut found = named(rest, styles, levels)?;
    let at =
        |found: &[(String, usize)], key: &str| found.iter().find(|pair| pair.0 == key).map(|pair| pair.1);
    // With its outermost part, where pairs are several.
    let parts = |pair: &&(String, usize)| !BONDED.contains(&pair.0.as_str()) && pair.0 != "kspace";
    let pairs = found.iter().filter(parts).map(|pair| pair.1).max();
    let mut before = 1;
    for key in BONDED {
        let given = at(&found, key);
        before = given.unwrap_or(before);
        if given.is_none() && there(key) {
            found.push((key.into(), before));
        }
    }
    if pairs.is_none() {
        found.push(("pair".into(), levels));
    }
    if at(&found, "kspace").is_none() && there("kspace") {
        found.push(("kspace".into(), pairs.unwrap_or(levels)));
    }
    found.extend(lines.iter().filter(|line| line.key() == "fix_modify").filter_map(|line| {
        let at = line.words.iter().position(|word| word.0 == "respa")?;
        Some((format!("fix {}", line.words.get(1)?.0), line.words.get(at + 1)?.0.parse().ok()?))
    }));
    Ok(found)
}
