//! Words of kicks, drifts, midpoints and rational friction at one step whose numbers are rational: what balls
//! leave undecided is an edge, or is none.

use num_traits::Zero;

use super::letters::Word;
use super::product::Forces;
use number::{ExactSign, Laurent, Radical, Rational, Ring, Sign};

/// An oscillator, its numbers as they are given.
#[derive(Clone, Debug)]
pub(super) struct Exact {
    pub stiffness: [Laurent; 2],
    pub friction: Laurent,
}

impl Exact {
    /// The kind of verdict at a step h, by Jury's conditions; `None` where h² Λ or γ h is no rational number,
    /// and at a pole. The word is algebraic and has no letters O.
    pub fn kind(&self, word: &Word, h: &Laurent) -> Option<&'static str> {
        let rational = |x: &Rational| Radical::from_rational(x);
        let square = Laurent::product(h, h);
        let [first, second] =
            [0, 1].map(|i| Laurent::product(&square, &self.stiffness[i]).as_rational().map(|x| rational(&x)));
        let friction = rational(&Laurent::product(h, &self.friction).as_rational()?);
        let product = word.product(&Forces { friction, ..Forces::new([first?, second?], Radical::clone) });
        let implicit = product.implicit.sign();
        let side = product.denominator.sign() * implicit;
        if side == Sign::Zero {
            return None;
        }
        let ends = product.margins().map(|margin| margin.sign() * side);
        let damped = (product.implicit.clone() - product.damping.clone()).sign() * implicit;
        let identity = product.matrix[(0, 1)].is_zero() && product.matrix[(1, 0)].is_zero();
        Some(match damped {
            Sign::Negative => "hyperbolic",
            _ if ends.contains(&Sign::Negative) => "hyperbolic",
            Sign::Positive if ends.contains(&Sign::Zero) => "marginal",
            Sign::Positive => "damped",
            Sign::Zero if !ends.contains(&Sign::Zero) => "elliptic",
            Sign::Zero if identity => "coexistence",
            Sign::Zero => "parabolic",
        })
    }
}
