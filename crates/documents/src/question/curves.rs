//! The (a, b) families of resonance curves.

use super::asking::{Question, Work, question};
use super::field::StepRange;
use crate::report::document::Document;
use crate::report::plane;
use crate::report::record::Record;
use crate::report::shape::{COUNT, INTEGER, Keys, ROUNDED, Schema, Shape};
use crate::report::table::{Column, Table};
use clocks::resonance::{Curve, CurvePoint, Families, Window};
use number::{Error, ExactSign, Laurent, Result, Sign};
use plot::{Figure, Foot};

question! {
    /// The curves 1/T½ = a/h1 + b/h2 over closed ranges of h1 and h2.
    args struct Curves {
        /// The stiffness of the fast force.
        lambda1 as "X": Laurent = "pi^2",
        /// The spacing of h1 of a scene's grid, on which curves do not depend.
        #[arg(skip)]
        step1: Option<Laurent>,
        /// The spacing of h2.
        #[arg(skip)]
        step2: Option<Laurent>,
        /// The closed range of h1.
        h1_range as "LO..HI": StepRange = "1/1000..2/pi",
        /// The closed range of h2.
        h2_range as "LO..HI": StepRange = "1/1000..7/2",
        /// The range of a.
        a as "LO..HI": (i64, i64) = "0..3",
        /// The range of b.
        b as "LO..HI": (i64, i64) = "-12..12",
        /// Points a curve, evenly spaced in theta over its pieces in the window.
        samples as "N": usize = "400",
    }
}

impl Curves {
    fn window(&self) -> Window {
        Window::nearest(&self.h1_range, &self.h2_range)
    }
}

impl Question for Curves {
    const NAME: &'static str = "curves";
    const EXAMPLES: &'static [&'static str] = &[
        "curves --lambda1 pi^2 --a 0..1 --b 1..3 --samples 20 --format csv",
        "curves --lambda1 pi^2 --output curves.svg",
    ];
    type Answer = Vec<Curve>;

    fn schema() -> Option<Schema> {
        let says = "The curves that pass through the window, by a, then b.";
        let body = Keys::new().key("curves", Shape::List(&Shape::Object(|| curve_record().keys())), says);
        let title = "The (a, b) families of resonance curves 1/T_half = a/h1 + b/h2, sampled";
        Some(Schema::new(title, body))
    }

    fn answer(&self, _: &Work) -> Result<Vec<Curve>> {
        for (field, (lo, hi)) in [("h1-range", &self.h1_range), ("h2-range", &self.h2_range)] {
            if hi.sign() != Sign::Positive {
                let remedy = "holds no positive step; raise its end";
                return Err(Error::input(field, format!("{lo}..{hi}"), remedy));
            }
        }
        let families = Families { a: self.a, b: self.b, samples: self.samples };
        families.curves(&self.lambda1, &self.window())
    }

    fn show(&self, curves: &Vec<Curve>) -> Document {
        // Empty curves are left out.
        let curves: Vec<&Curve> = curves.iter().filter(|curve| !curve.pieces.is_empty()).collect();
        let points: Vec<Point> = curves.iter().flat_map(|curve| points(curve)).collect();
        let summary =
            format!("{} curves 1/T½ = a/h1 + b/h2 in the window, {} points", curves.len(), points.len());
        let values = curve_record().all(curves);
        Document::new(Self::NAME).entry("curves", values).rows(table(&points)).summary(&[summary])
    }

    fn figure(&self, curves: &Vec<Curve>, _: &Work) -> Result<Option<Figure>> {
        let foot = Foot::default().value("*Λ*_1", &self.lambda1);
        Ok(Some(plane::families(&self.window(), curves).footed(&foot)))
    }
}

/// A point, its curve, and the number of its piece.
type Point<'a> = (&'a Curve, usize, &'a CurvePoint);

fn points(curve: &Curve) -> impl Iterator<Item = Point<'_>> {
    let pieces = curve.pieces.iter().enumerate();
    pieces.flat_map(move |(i, piece)| piece.iter().map(move |point| (curve, i, point)))
}

const STEP: Shape = Shape::With(&ROUNDED, r#"{"exclusiveMinimum": 0}"#);
const SHARE: Shape = Shape::With(&ROUNDED, r#"{"exclusiveMinimum": 0, "exclusiveMaximum": 1}"#);

/// The columns of a point, behind those of its curve.
fn place<'a>(record: Record<'a, Point<'a>>) -> Record<'a, Point<'a>> {
    record
        .field(Column::math("h1", "h_1"), |(_, _, point)| point.h1.into())
        .says(STEP, "A double; h2 and theta_over_pi are the doubles nearest to the curve there, so theta/pi = a + b h1/h2 holds to 2^-53 (|a| + 2).")
        .field(Column::math("h2", "h_2"), |(_, _, point)| point.h2.into())
        .says(STEP, "As h1.")
        .field(Column::new("theta_over_pi").titled("theta/pi", "$\\theta/\\pi$"), |(_, _, point)| {
            point.theta_over_pi.into()
        })
        .says(SHARE, "theta/pi = h1/T_half as a double, as h1.")
}

/// The entries of a point.
fn point_record<'a>() -> Record<'a, Point<'a>> {
    place(Record::new()).field(Column::new("piece"), |(_, piece, _)| (*piece as u64).into()).says(
        COUNT,
        "Points of one piece are joined by a line; where the curve leaves the window a new piece begins.",
    )
}

/// The entries of a curve.
fn curve_record() -> Record<'static, Curve> {
    const POINTS: Shape =
        Shape::With(&Shape::List(&Shape::Object(|| point_record().keys())), r#"{"minItems": 1}"#);
    Record::new()
        .json("a", |curve: &Curve| curve.a.into())
        .says(INTEGER, "a of the curve.")
        .json("b", |curve| curve.b.into())
        .says(INTEGER, "b of the curve.")
        .value("points", |curve| point_record().all(&points(curve).collect::<Vec<_>>()).into())
        .says(POINTS, "Points in the window, in their order along the curve.")
}

fn table(points: &[Point]) -> Table {
    let curve = Record::new()
        .field(Column::math("a", "a"), |(curve, ..): &Point| curve.a.into())
        .field(Column::math("b", "b"), |(curve, ..)| curve.b.into());
    place(curve)
        .table("curves", "Points of the resonance curves (a, b)", points)
        .captioned("Points of the resonance curves $1/T_{1/2} = a/h_1 + b/h_2$, $\\theta = \\pi h_1/T_{1/2}$")
}
