//! Advice as a document: lines to act on, then tables.

mod answer;
mod bias;
mod chart;
mod direct;
mod growth;
mod levers;
mod lines;
mod molecule;
mod periods;
mod silent;
mod tables;
mod words;

use super::document::Document;
use super::shape::Schema;
use molecules::engine::Reading;
use molecules::{Advice, DirectFindings, Findings};

pub use chart::levers as levers_figure;
pub use periods::ORIGIN;
pub use words::nearest;
pub(crate) use words::time;

/// The subject of advice.
#[derive(Clone, Copy)]
pub enum View<'a> {
    /// Periods and bonds.
    Periods(&'a Advice),
    /// The Hessians of a molecule.
    Hessians(&'a Findings),
    /// Forces that are no gradient.
    Direct(&'a DirectFindings),
}

/// The document `kickdrift/advise/1`, `kickdrift/advise-system/1` or `kickdrift/advise-direct/1`, but for the
/// input; with what an engine's text says, where the steps are those of one; for people with `notes` on how
/// it was read.
pub fn document(view: View, reading: Option<&Reading>, notes: &[String]) -> Document {
    match view {
        View::Periods(advice) => periods::document(advice, reading),
        View::Hessians(findings) => molecule::document(findings, reading, notes),
        View::Direct(findings) => direct::document(findings, reading, notes),
    }
}

/// Each mode and each pair of modes, or the molecule and each group of its fast modes, at each scheme's own
/// ratio, and the schemes' outer steps as lines through their rows. Of forces that are no gradient the growth
/// over the outer step; `None` where there is one step alone.
pub fn figure(view: View, title: &str) -> Option<plot::Figure> {
    match view {
        View::Periods(advice) => Some(chart::of_periods(advice, title)),
        View::Hessians(findings) => Some(chart::of_molecule(findings, title)),
        View::Direct(findings) => growth::figure(findings, title),
    }
}

/// The schemas of the documents: their names, and what each is.
pub fn schemas() -> [(&'static str, Schema); 3] {
    let periods = "Which outer steps are safe for these periods, for how long, and why";
    let molecule = "Which outer steps are safe for a molecule of measured Hessians, for how long, and why";
    let direct =
        "What the steps add to the growth of forces that are no gradient, and which outer steps add little";
    [
        ("advise", Schema::new(periods, periods::head().keys())),
        ("advise-system", Schema::new(molecule, molecule::head().keys())),
        ("advise-direct", Schema::new(direct, direct::head().keys())),
    ]
}
