//! Where every ratio is unstable.

use num_traits::{One, Signed};
use plot::Figure;

use super::asking::{Question, Work, question};
use super::field::StepRange;
use crate::report::bands;
use crate::report::document::Document;
use crate::report::shape::Schema;
use clocks::band::{self, Window};
use number::{Error, Laurent, Rational, Result};

question! {
    /// Sectors of (h1, h2) in which every ratio h2/h1, rational or not, is proven unstable.
    args struct Bands {
        /// The stiffness of the fast force.
        lambda1 as "X": Laurent,
        /// The stiffness of the slow force.
        lambda2 as "Y": Laurent,
        /// The closed range of h1.
        h1_range as "LO..HI": StepRange,
        /// The closed range of h2.
        h2_range as "LO..HI": StepRange,
        /// End where this share of the window is certified, as 17/200.
        area as "A": Option<Rational>,
        /// The most sectors that are tried: each costs a tenth of a millisecond, and more in a narrow window.
        sectors as "N": u64 = "100000",
    }
}

/// The most sectors unless a budget says otherwise: an hour on two cores, and some gigabytes.
const MOST_SECTORS: u64 = 30_000_000;

/// Seconds of one core that a sector costs, about.
const SECTOR: f64 = 1e-4;

impl Bands {
    /// The window.
    ///
    /// # Errors
    /// As [`Window::new`].
    pub fn window(&self) -> Result<Window> {
        let ranges = [self.h1_range.clone(), self.h2_range.clone()];
        Window::new([self.lambda1.clone(), self.lambda2.clone()], ranges)
    }
}

impl Question for Bands {
    const NAME: &'static str = "bands";
    const EXAMPLES: &'static [&'static str] = &[
        "bands --lambda1 pi^2 --lambda2 pi^2/25 --h1-range 1/5..1/4 --h2-range 9/10..1 --sectors 2000",
        "bands --lambda1 pi^2 --lambda2 pi^2/25 --h1-range 0..2/pi --h2-range 0..7/2 --area 3/50 --output bands.png",
    ];
    type Answer = band::Bands;

    fn schema() -> Option<Schema> {
        let title = "Sectors of steps in which every ratio h2/h1, rational or not, is unstable";
        Some(Schema::new(title, bands::keys()))
    }

    fn answer(&self, work: &Work) -> Result<band::Bands> {
        let most = work.budget.unwrap_or(MOST_SECTORS);
        if self.sectors > most {
            let cost = format!("{} sectors are too many", self.sectors);
            return Err(Error::budget(cost, self.sectors).or(format!("choose --sectors {most} at most")));
        }
        if let Some(share) = self.area.as_ref().filter(|share| !share.is_positive() || **share > One::one()) {
            return Err(Error::input(
                "area",
                share,
                "is a share of the window: choose one above 0, at most 1",
            ));
        }
        let window = self.window()?;
        work.announce("the bands", self.sectors as f64 * SECTOR);
        let bar = work.count(self.sectors, "sectors");
        window.search(self.sectors, self.area.as_ref(), &|more| bar.advance(more))
    }

    fn show(&self, answer: &band::Bands) -> Document {
        bands::document(answer)
    }

    fn figure(&self, answer: &band::Bands, _: &Work) -> Result<Option<Figure>> {
        Ok(Some(bands::figure(answer)))
    }
}
