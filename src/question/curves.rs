//! The (a, b) families of resonance curves.

use super::asking::{Question, Work, question};
use super::field::StepRange;
#[cfg(feature = "cli")]
use super::field::flag;
use crate::error::{Error, Result};
use crate::number::{ExactSign, Laurent, Sign};
use crate::report::curves;
use crate::report::document::Document;
use crate::resonance::{Curve, Families, Window};

question! {
    /// The curves 1/T½ = a/h1 + b/h2 over closed ranges of h1 and h2.
    args struct Curves {
        /// The stiffness of the fast force.
        #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
        lambda1: Laurent = "pi^2",
        /// The spacing of h1 of a scene's grid, on which curves do not depend.
        #[arg(skip)]
        step1: Option<Laurent>,
        /// That of h2.
        #[arg(skip)]
        step2: Option<Laurent>,
        /// The closed range of h1.
        #[arg(long, value_name = "LO..HI", allow_hyphen_values = true, value_parser = flag::<StepRange>)]
        h1_range: StepRange = "1/1000..2/pi",
        /// The closed range of h2.
        #[arg(long, value_name = "LO..HI", allow_hyphen_values = true, value_parser = flag::<StepRange>)]
        h2_range: StepRange = "1/1000..7/2",
        /// The range of a.
        #[arg(long, value_name = "LO..HI", allow_hyphen_values = true, value_parser = flag::<(i64, i64)>)]
        a: (i64, i64) = "0..3",
        /// The range of b.
        #[arg(long, value_name = "LO..HI", allow_hyphen_values = true, value_parser = flag::<(i64, i64)>)]
        b: (i64, i64) = "-12..12",
        /// Points a curve, evenly spaced in theta over its pieces in the window.
        #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = flag::<usize>)]
        samples: usize = "400",
    }
}

impl Question for Curves {
    const NAME: &'static str = "curves";
    const EXAMPLES: &'static [&'static str] =
        &["curves --lambda1 pi^2 --a 0..1 --b 1..3 --samples 20 --format csv"];
    type Answer = Vec<Curve>;

    fn answer(&self, _: &Work) -> Result<Vec<Curve>> {
        for (field, (lo, hi)) in [("h1-range", &self.h1_range), ("h2-range", &self.h2_range)] {
            if hi.sign() != Sign::Positive {
                let remedy = "holds no positive step; raise its end";
                return Err(Error::input(field, format!("{lo}..{hi}"), remedy));
            }
        }
        let families = Families { a: self.a, b: self.b, samples: self.samples };
        families.curves(&self.lambda1, &Window::new(&self.h1_range, &self.h2_range))
    }

    fn show(&self, answer: &Vec<Curve>) -> Document {
        curves::document(answer)
    }
}
