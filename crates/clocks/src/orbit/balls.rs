//! A solution on its way in balls: no condition, and enclosures that widen with every step.

use super::ends::{End, Nodes};
use crate::schedule::{KickDrift, Schedule};
use number::{Ball, Rational, Sign};

/// Position and velocity in balls of `bits` bits, in the time unit h1.
#[derive(Clone)]
pub struct BallOrbit {
    pub x: Ball,
    pub v: Ball,
    pub nodes: Nodes,
    bits: u32,
    /// Ticks in the unit of time.
    ticks: u64,
}

impl BallOrbit {
    /// The solution that begins at (x, v).
    pub fn new(start: [u8; 2], schedule: &Schedule, bits: u32) -> Self {
        let [x, v] = start.map(|n| Ball::from_integer(&n.into()));
        BallOrbit { x, v, nodes: Nodes::default(), bits, ticks: schedule.clocks()[0].step() }
    }

    /// Moves the solution to (x, v) at a later time; its sign changes on the way are not counted.
    pub fn at(&self, x: Ball, v: Ball) -> Self {
        BallOrbit { x, v, ..self.clone() }
    }

    /// So many ticks in the unit of time.
    pub fn time(&self, ticks: u64) -> Ball {
        Ball::from_rational(&Rational::new(ticks.into(), self.ticks.into()), self.bits)
    }

    /// The sign of x; balls of rationals can be exactly zero: no sign, as if it were uncertain.
    pub fn sign(&self) -> Option<Sign> {
        self.x.sign().filter(|&sign| sign != Sign::Zero)
    }

    /// Where it is now.
    pub fn end(self) -> End {
        let signs = (self.x.sign(), self.v.sign());
        End { signs, nodes: self.nodes.count(), x: self.x, v: self.v }
    }
}

impl KickDrift<Ball> for BallOrbit {
    fn drift(&mut self, ticks: u64) {
        self.x = self.x.add(&self.v.mul(&self.time(ticks), self.bits), self.bits);
    }

    fn arrive(&mut self) {
        self.nodes.see(self.sign());
    }

    fn kick(&mut self, strength: &Ball) {
        self.v = self.v.sub(&strength.mul(&self.x, self.bits), self.bits);
    }
}
