//! The atlas of tongues in the (h1, h2) plane.

use plot::{Figure, Foot};

use super::output::Stream;
use crate::cli::args::Common;
use crate::cli::paper::Paper;
use clocks::resonance::{Curve, Families, Window};
use clocks::tongue::{Bounds, Range, Tongue, TongueEdge};
use documents::format::Format;
use documents::question::{Colour, Ratios};
use documents::report::plane::{self, Segment};
use number::Laurent;
use number::error::{Error, Result};

/// A question whose answer is drawn.
pub struct Atlas<'a> {
    question: &'a Stream,
    colour: Colour,
    window: Window,
    curves: Vec<Curve>,
}

/// Samples of a curve in the window: on paper a third of a millimetre apart.
const SAMPLES: usize = 400;

impl<'a> Atlas<'a> {
    /// The window and the curves, those of the families selected unless others are given; tongues come later.
    pub fn new(question: &'a Stream, colour: Colour, families: Option<Families>) -> Result<Self> {
        let missing =
            |field: &str, example: &str| Error::missing(field, format!("an atlas needs it, as {example}"));
        let lambda1 =
            question.asked.stiffness.lambda1.as_ref().ok_or_else(|| missing("lambda1", "--lambda1 pi^2"))?;
        let h1 =
            question.asked.window.h1.as_ref().ok_or_else(|| missing("h1-range", "--h1-range 0..2/pi"))?;
        let h2 = question.asked.window.h2.as_ref().ok_or_else(|| missing("h2-range", "--h2-range 0..7/2"))?;
        let window = Window::new(h1, h2);
        for (field, (lo, hi)) in [("h1-range", window.h1), ("h2-range", window.h2)] {
            if hi <= lo.max(0.0) {
                return Err(Error::input(field, format!("{lo}..{hi}"), "holds no positive step to draw"));
            }
        }
        let families = families.unwrap_or(Families {
            a: question.asked.selection.a.unwrap_or((0, 3)),
            b: question.asked.selection.b.unwrap_or((-12, 12)),
            samples: SAMPLES,
        });
        let curves = families.curves(lambda1, &window)?;
        Ok(Atlas { question, colour, window, curves })
    }

    /// Computes the tongues and writes the figure.
    pub fn write(&self, common: &Common, format: Format, paper: &Paper) -> Result<()> {
        paper.write(self.figure(common)?, format, common.output.as_deref(), common)
    }

    /// The figure.
    pub fn figure(&self, common: &Common) -> Result<Figure> {
        let mut segments = Vec::new();
        self.question.each(common, |part| {
            segments.extend(part.iter().map(|tongue| self.segment(tongue)));
            Ok(())
        })?;
        let title = self.title();
        let atlas =
            plane::Atlas { window: self.window.clone(), segments: &segments, curves: &self.curves, title };
        let figure = match self.colour {
            Colour::Family => atlas.by_family(),
            Colour::Growth => atlas.by_growth(),
        };
        Ok(figure.footed(&self.foot()))
    }

    fn foot(&self) -> Foot {
        let (stiffness, window) = (&self.question.asked.stiffness, &self.question.asked.window);
        let clock = |foot: Foot, n: usize, lambda: Option<&Laurent>, range: Option<&Range>| {
            let foot = match lambda {
                Some(lambda) => foot.value(&format!("*Λ*_{n}"), lambda),
                None => foot.value("*ρ*", &stiffness.rho),
            };
            range.map_or(foot.clone(), |(lo, hi)| foot.range(&format!("*h*_{n}"), lo, hi))
        };
        let foot = clock(Foot::default(), 1, stiffness.lambda1.as_ref(), window.h1.as_ref());
        let foot = clock(foot, 2, stiffness.lambda2.as_ref(), window.h2.as_ref());
        below(self.question.ratios, foot)
    }

    fn title(&self) -> String {
        let rho = &self.question.asked.stiffness.rho;
        match self.question.ratios {
            Ratios::One(ratio) => format!("Tongues of *h*_2/*h*_1 = {ratio}, *ρ* = {rho}"),
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

/// θ/π of an angle strictly between 0 and π that is a rational multiple of π.
pub fn share_of_pi(theta: &Laurent) -> Result<number::Rational> {
    use num_traits::{One, Signed};
    let share = theta.as_monomial().filter(|(power, _)| *power == 1).map(|(_, share)| share.clone());
    share.filter(|share| share.is_positive() && *share < One::one()).ok_or_else(|| {
        Error::input("theta", theta, "give a rational multiple of pi between 0 and pi, as pi/2")
    })
}

/// Below a figure.
pub fn below(ratios: Ratios, foot: Foot) -> Foot {
    match ratios {
        Ratios::One(ratio) => foot.value("*h*_2/*h*_1", ratio),
        Ratios::UpTo(max_sum) => foot.part(format!("all *h*_2/*h*_1 = *p*/*q*, *p* + *q* ≤ {max_sum}")),
    }
}
