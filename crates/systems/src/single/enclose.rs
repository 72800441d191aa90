//! K clocks on one oscillator in balls: enclosures that widen with every kick, and as many bits as that
//! takes.

use crate::ManyClocks;
use clocks::schedule::{KickDrift, Kicks};
use clocks::verdict::{PartialSigns, Verdict};
use number::{Ball, Rational, Real, Sign};

/// H = \[\[A, B\], \[C, D\]\], and the sign changes of x on the way of the even solution.
pub struct Enclosed {
    a: Ball,
    b: Ball,
    c: Ball,
    d: Ball,
    /// `None` where some sign was not known.
    nodes: Option<u64>,
    last: Sign,
    bits: u32,
    /// Ticks in h_1.
    ticks: u64,
}

/// The half period in balls of `bits` bits.
pub fn run<S: Real>(clocks: &ManyClocks<S>, bits: u32) -> Enclosed {
    let strengths = clocks.strengths().iter().map(|k| k.enclosure(bits));
    let kicks = Kicks::of_clocks(strengths, |k| [k.clone(), k.scale2(-1)]);
    let ticks = clocks.schedule().clocks()[0].step();
    let [a, b, c, d] = [1, 0, 0, 1].map(|n: i32| Ball::from_integer(&n.into()));
    let mut half = Enclosed { a, b, c, d, nodes: Some(0), last: Sign::Positive, bits, ticks };
    kicks.lead(clocks.schedule().half_period(), &mut half);
    half
}

impl KickDrift<Ball> for Enclosed {
    fn drift(&mut self, ticks: u64) {
        let time = Ball::from_rational(&Rational::new(ticks.into(), self.ticks.into()), self.bits);
        self.a = self.a.add(&self.c.mul(&time, self.bits), self.bits);
        self.b = self.b.add(&self.d.mul(&time, self.bits), self.bits);
    }

    fn arrive(&mut self) {
        match self.a.sign() {
            Some(sign) if sign != Sign::Zero && sign != self.last => {
                self.nodes = self.nodes.map(|n| n + 1);
                self.last = sign;
            }
            Some(_) => {}
            None => self.nodes = None,
        }
    }

    fn kick(&mut self, strength: &Ball) {
        self.c = self.c.sub(&strength.mul(&self.a, self.bits), self.bits);
        self.d = self.d.sub(&strength.mul(&self.b, self.bits), self.bits);
    }
}

impl Enclosed {
    /// The verdict, where the signs that are known imply it.
    pub fn verdict(&self) -> Option<Verdict> {
        let (a, b, c, d) = (self.a.sign(), self.b.sign(), self.c.sign(), self.d.sign());
        PartialSigns { a, b, c, d }.verdict()
    }

    /// BC = μ = (Tr Q − 2)/4, and AD = (Tr Q + 2)/4.
    pub fn products(&self, bits: u32) -> [Ball; 2] {
        [self.b.mul(&self.c, bits), self.a.mul(&self.d, bits)]
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
