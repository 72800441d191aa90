//! K clocks on one oscillator in balls: enclosures that widen with every kick, and as many bits as that takes.

use num_bigint::BigInt;

use super::ManyClocks;
use crate::number::{Ball, Rational, Real, Sign};
use crate::schedule::Weight;
use crate::verdict::{PartialSigns, Verdict};

/// H = \[\[A, B\], \[C, D\]\], and the sign changes of x on the way of the even solution.
pub(super) struct Enclosed {
    a: Ball,
    b: Ball,
    c: Ball,
    d: Ball,
    /// `None` where some sign was not told.
    nodes: Option<u64>,
}

/// The half period in balls of `bits` bits.
pub(super) fn run<S: Real>(clocks: &ManyClocks<S>, bits: u32) -> Enclosed {
    let strengths: Vec<Ball> = clocks.strengths().iter().map(|k| k.enclosure(bits)).collect();
    let ticks = BigInt::from(clocks.schedule().clocks()[0].step());
    let [mut a, mut b, mut c, mut d] = [1, 0, 0, 1].map(|n: i32| Ball::from_integer(&n.into()));
    let (mut nodes, mut last) = (Some(0), Sign::Positive);
    for event in clocks.schedule().half_period() {
        let drift = Ball::from_rational(&Rational::new(event.drift.into(), ticks.clone()), bits);
        a = a.add(&c.mul(&drift, bits), bits);
        b = b.add(&d.mul(&drift, bits), bits);
        match a.sign() {
            Some(sign) if sign != Sign::Zero && sign != last => {
                nodes = nodes.map(|n| n + 1);
                last = sign;
            }
            Some(_) => {}
            None => nodes = None,
        }
        let halvings = i64::from(event.weight == Weight::Half);
        for (_, strength) in strengths.iter().enumerate().filter(|(k, _)| event.kicks >> k & 1 == 1) {
            let strength = strength.scale2(-halvings);
            c = c.sub(&strength.mul(&a, bits), bits);
            d = d.sub(&strength.mul(&b, bits), bits);
        }
    }
    Enclosed { a, b, c, d, nodes }
}

impl Enclosed {
    /// The verdict, where the signs that are told imply it.
    pub fn verdict(&self) -> Option<Verdict> {
        let (a, b, c, d) = (self.a.sign(), self.b.sign(), self.c.sign(), self.d.sign());
        PartialSigns { a, b, c, d }.verdict()
    }

    /// μ = BC = (Tr Q − 2)/4.
    pub fn mu(&self, bits: u32) -> Ball {
        self.b.mul(&self.c, bits)
    }

    /// m of a hyperbolic verdict, from the nodes as in [`ManyClocks::label`].
    pub fn label(&self, verdict: Verdict) -> Option<u64> {
        let nodes = self.nodes?;
        if verdict.side() > 0 {
            return Some(2 * nodes);
        }
        let past = self.a.sign()? * self.c.sign()? == Sign::Negative;
        if past { Some(2 * nodes + 1) } else { (2 * nodes).checked_sub(1) }
    }
}
