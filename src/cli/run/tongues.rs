//! What a scene asks of tongues.

use plot::Figure;

use crate::cli::args::Common;
use crate::cli::tongues::{Atlas, Colour, Question};
use crate::error::Result;
use crate::question::{MOST_SUM, Ratios, Tongues};
use crate::scene::{FAMILIES, Scene};
use crate::tongue::{Stiffness, Wanted};

/// The atlas.
pub fn atlas(scene: &Scene, common: &Common) -> Result<Figure> {
    let colour = match scene.colour.as_deref() {
        Some("growth") => Colour::Growth,
        _ => Colour::Family,
    };
    let question = question(scene, colour.needs())?;
    Atlas::new(&question, colour, Some(scene.families.unwrap_or(FAMILIES)))?.figure(common)
}

/// The question that tongues and atlas answer.
pub fn question(scene: &Scene, wanted: Wanted) -> Result<Question> {
    let [h1_range, h2_range] = scene.window.clone().map_or([None, None], |window| window.map(Some));
    let all = Tongues::of(ratios(scene)?, stiffness(scene)?);
    Question::new(Tongues { h1_range, h2_range, ..all }, wanted)
}

/// All ratios where a sum is given, else the one.
pub fn ratios(scene: &Scene) -> Result<Ratios> {
    match scene.max_sum {
        Some(max_sum) => Ratios::UpTo(max_sum).within(MOST_SUM),
        None => scene.ratio().map(Ratios::One),
    }
}

/// rho, as such or by the stiffnesses.
pub fn stiffness(scene: &Scene) -> Result<Stiffness> {
    Stiffness::new(scene.rho.clone(), scene.lambda1.clone(), scene.lambda2.clone())
}
