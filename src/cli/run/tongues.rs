//! What a scene asks of tongues.

use crate::cli::args::Common;
use crate::cli::ratios::Ratios;
use crate::cli::tongues::{Atlas, Colour, MOST_SUM, Question, Stiffness, Window};
use crate::error::{Error, Result};
use crate::report::tongues::Frame;
use crate::scene::Scene;
use crate::tongue::{Selection, Wanted};

/// The atlas's SVG.
pub fn atlas(scene: &Scene, common: &Common) -> Result<String> {
    let colour = match scene.document().colour.as_deref() {
        None | Some("family") => Colour::Family,
        Some("growth") => Colour::Growth,
        Some(other) => return Err(Error::input("colour", other, "choose family or growth")),
    };
    let question = question(scene, colour.needs())?;
    Ok(Atlas::new(&question, colour, Some(scene.families()?))?.figure(common)?.svg())
}

/// The question that tongues and atlas answer.
pub fn question(scene: &Scene, wanted: Wanted) -> Result<Question> {
    let window =
        scene.window()?.map_or_else(Window::default, |[h1, h2]| Window { h1: Some(h1), h2: Some(h2) });
    let frame = Frame { wanted, ..Frame::default() };
    Question::new(ratios(scene)?, stiffness(scene)?, window, Selection::default(), frame)
}

/// All ratios where a sum is given, else the one.
pub fn ratios(scene: &Scene) -> Result<Ratios> {
    match scene.document().max_sum {
        Some(max_sum) => Ratios::UpTo(max_sum).within(MOST_SUM),
        None => scene.ratio().map(Ratios::One),
    }
}

/// rho, as such or by the stiffnesses.
pub fn stiffness(scene: &Scene) -> Result<Stiffness> {
    let given = scene.document();
    let lambda1 = given.lambda1.as_ref().map(|_| scene.lambda1()).transpose()?;
    let lambda2 = given.lambda2.as_ref().map(|_| scene.lambda2()).transpose()?;
    Stiffness::new(scene.rho()?, lambda1, lambda2)
}
