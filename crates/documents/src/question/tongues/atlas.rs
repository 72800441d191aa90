//! The atlas of tongues in the (h1, h2) plane.

use plot::{Figure, Foot};

use crate::question::field::notation;
use crate::question::ratios::Ratios;
use crate::report::plane::{self, Segment};
use crate::report::shape::Shape;
use clocks::resonance::{Curve, Families, Window};
use clocks::tongue::{Bounds, Listing, Range, Tongue, TongueEdge};
use number::{Error, Laurent, Result, named};

named! {
    /// The quantity shown by the colours of an atlas.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    #[derive(clap::ValueEnum)]
    pub enum Colour {
        /// The a of the dominant family.
        Family = "family",
        /// The fastest growth inside the tongue.
        Growth = "growth",
    }
}

notation! {
    Colour: colour, |colour: &Colour| colour.name(), Shape::OneOf(Colour::NAMES);
}

fn colour(field: &str, text: &str) -> Result<Colour> {
    Colour::named(text).ok_or_else(|| Error::input(field, text, "choose family or growth"))
}

/// A figure to which tongues are added.
pub struct Atlas {
    ratios: Ratios,
    listing: Listing,
    colour: Colour,
    window: Window,
    curves: Vec<Curve>,
    segments: Vec<Segment>,
}

/// Samples of a curve in the window: on paper a third of a millimetre apart.
const SAMPLES: usize = 400;

impl Atlas {
    /// The window and the curves, those of the families selected unless others are given; tongues come later.
    ///
    /// # Errors
    /// A question that makes no sense; λ1 or a range of steps that is missing; a window without a step.
    pub fn new(ratios: Ratios, listing: Listing, colour: Colour, families: Option<Families>) -> Result<Self> {
        let missing = |field: &str, example: &str| {
            Error::missing(
                field,
                format!("the picture of all tongues in the plane of steps needs it, as {example}"),
            )
        };
        let lambda1 =
            listing.stiffness.lambda1.as_ref().ok_or_else(|| missing("lambda1", "--lambda1 pi^2"))?;
        let h1 = listing.window.h1.as_ref().ok_or_else(|| missing("h1-range", "--h1-range 0..2/pi"))?;
        let h2 = listing.window.h2.as_ref().ok_or_else(|| missing("h2-range", "--h2-range 0..7/2"))?;
        let window = Window::new(h1, h2);
        for (field, (lo, hi)) in [("h1-range", window.h1), ("h2-range", window.h2)] {
            if hi <= lo.max(0.0) {
                return Err(Error::input(field, format!("{lo}..{hi}"), "holds no positive step to draw"));
            }
        }
        let families = families.unwrap_or(Families {
            a: listing.selection.a.unwrap_or((0, 3)),
            b: listing.selection.b.unwrap_or((-12, 12)),
            samples: SAMPLES,
        });
        let curves = families.curves(lambda1, &window)?;
        Ok(Atlas { ratios, listing, colour, window, curves, segments: Vec::new() })
    }

    /// Adds tongues, as many as come.
    pub fn add(&mut self, part: &[Tongue]) {
        let segments: Vec<Segment> = part.iter().map(|tongue| self.segment(tongue)).collect();
        self.segments.extend(segments);
    }

    /// The figure of those that were added.
    pub fn drawn(&self) -> Figure {
        let (title, window) = (self.title(), self.window.clone());
        let atlas = plane::Atlas { window, segments: &self.segments, curves: &self.curves, title };
        let figure = match self.colour {
            Colour::Family => atlas.by_family(),
            Colour::Growth => atlas.by_growth(),
        };
        figure.footed(&self.foot())
    }

    fn foot(&self) -> Foot {
        let (stiffness, window) = (&self.listing.stiffness, &self.listing.window);
        let clock = |foot: Foot, n: usize, lambda: Option<&Laurent>, range: Option<&Range>| {
            let foot = match lambda {
                Some(lambda) => foot.value(&format!("*Λ*_{n}"), lambda),
                None => foot.value("*ρ*", &stiffness.rho),
            };
            range.map_or(foot.clone(), |(lo, hi)| foot.range(&format!("*h*_{n}"), lo, hi))
        };
        let foot = clock(Foot::default(), 1, stiffness.lambda1.as_ref(), window.h1.as_ref());
        let foot = clock(foot, 2, stiffness.lambda2.as_ref(), window.h2.as_ref());
        let foot = self.ratios.below(foot);
        if self.curves.is_empty() {
            return foot;
        }
        foot.part("pale: curves 1/*T*_{1/2} = *a*/*h*_1 + *b*/*h*_2, dark: tongues".into())
    }

    fn title(&self) -> String {
        let rho = &self.listing.stiffness.rho;
        match &self.ratios {
            Ratios::One(ratio) => format!("Tongues of *h*_2/*h*_1 = {ratio}, *ρ* = {rho}"),
            Ratios::Several(list) => format!("Tongues of *h*_2/*h*_1 = {}, *ρ* = {rho}", list.spaced()),
            Ratios::UpTo(max_sum) => format!("All tongues with *p* + *q* ≤ {max_sum}, *ρ* = {rho}"),
        }
    }

    /// The last tongue has no end: it is drawn to where the window ends.
    fn segment(&self, tongue: &Tongue) -> Segment {
        let middle = |q: &Bounds| 0.5 * (q.lo + q.hi);
        let place = |edge: &TongueEdge| edge.steps.as_ref().expect("lambda1 is known").each_ref().map(middle);
        let ratio = tongue.row.ratio.p() as f64 / tongue.row.ratio.q() as f64;
        let from = place(&tongue.lower);
        let to = tongue.upper.as_ref().map_or([self.window.h1.1, self.window.h1.1 * ratio], place);
        let a = tongue.row.family.map_or(0, |(a, _)| a);
        Segment { from, to, a, rate: tongue.growth_rate, closed: tongue.row.gap.closed }
    }
}
