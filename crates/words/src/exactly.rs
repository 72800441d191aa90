//! Words of kicks, drifts, midpoints and rational friction at one step whose numbers are rational: what balls
//! leave undecided is an edge, or is none.

use num_traits::Zero;

use super::filter::Filter;
use super::letters::{Force, Word};
use super::product::{Forces, Setting};
use number::{ExactSign, Laurent, Radical, Rational, Ring, Sign};

/// An oscillator, its numbers as they are given.
#[derive(Clone, Debug)]
pub(super) struct Exact {
    pub stiffness: [Laurent; 2],
    pub friction: Laurent,
}

/// The letters at one step, γ h as a number.
struct Step {
    forces: Forces<Radical>,
    rate: Radical,
}

impl Setting<Radical> for Step {
    fn force(&self, force: Force) -> Radical {
        self.forces.force(force)
    }

    fn embed(&self, c: &Radical) -> Radical {
        c.clone()
    }

    fn flow(&self, force: Force, c: &Radical) -> [Radical; 2] {
        self.forces.flow(force, c)
    }

    fn filter(&self, filter: Filter) -> Radical {
        self.forces.filter(filter)
    }

    fn damping(&self, c: &Radical) -> Radical {
        self.forces.damping(c)
    }

    fn friction(&self, c: &Radical) -> Radical {
        c * &self.rate
    }
}

impl Exact {
    /// The kind of verdict at a step h, by Jury's conditions; `None` where h² Λ or γ h is no rational number, and
    /// at a pole. The word is algebraic and has no letters O.
    pub fn kind(&self, word: &Word, h: &Laurent) -> Option<&'static str> {
        let rational = |x: &Rational| Radical::from_rational(x);
        let square = Laurent::product(h, h);
        let [first, second] =
            [0, 1].map(|i| Laurent::product(&square, &self.stiffness[i]).as_rational().map(|x| rational(&x)));
        let forces = Forces { of: [first?, second?], embed: Radical::clone };
        let rate = rational(&Laurent::product(h, &self.friction).as_rational()?);
        let product = word.product(&Step { forces, rate });
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
