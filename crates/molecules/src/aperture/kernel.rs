//! Runs from all phases side by side: the loop that everything here waits for.
//!
//! Sums and products in a fixed order, none of them fused, and an exponential made of them: every machine and
//! every instruction set gives the same bits.

use number::vector::instructions::{Instructions, Kernel};
use number::vector::{LANES, Vector};

/// Phases of a start, side by side.
pub const PHASES: usize = 48;

/// A bond is lost beyond this length, in nm, at a kick.
pub const FAR: f64 = 1.0;

/// The change of the velocity by a kick, in nm a step.
pub trait Pull: Copy + Sync {
    fn kick<V: Vector>(&self, x: V) -> V;
}

/// c1 x + c2 x² + c3 x³.
#[derive(Clone, Copy, Debug)]
pub struct Polynomial(pub [f64; 3]);

impl Pull for Polynomial {
    #[inline(always)]
    fn kick<V: Vector>(&self, x: V) -> V {
        let [c1, c2, c3] = self.0.map(V::splat);
        x.mul(c1.add(x.mul(c2.add(x.mul(c3)))))
    }
}

/// c1 x + s (1 − e) e, e = exp(−a x).
#[derive(Clone, Copy, Debug)]
pub struct Morse {
    pub linear: f64,
    pub strength: f64,
    /// −a/2^[`DOUBLINGS`].
    pub part: f64,
}

/// exp(z) is reached from z/2^8 by so many squarings.
pub const DOUBLINGS: i32 = 8;

/// 1/n, rounded.
const PARTS: [f64; 6] = [1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0, 1.0 / 5.0, 1.0 / 6.0, 1.0 / 7.0];

impl Pull for Morse {
    /// exp − 1 of z/2^8 by its series to the 7th power, then q ← q (2 + q) eight times. Up to |z| = 6, with
    /// 160,000 times the depth on the steep side, it errs by 1e-15 s or by 2e-14 of itself; at |z| = 23 by
    /// 1e-10.
    #[inline(always)]
    fn kick<V: Vector>(&self, x: V) -> V {
        let one = V::splat(1.0);
        let z = x.mul(V::splat(self.part));
        let mut series = one;
        for part in PARTS.iter().rev() {
            series = one.add(series.mul(z).mul(V::splat(*part)));
        }
        let mut q = z.mul(series);
        for _ in 0..DOUBLINGS {
            q = q.mul(q.add(V::splat(2.0)));
        }
        let pull = q.mul(q.add(one)).mul(V::splat(self.strength));
        x.mul(V::splat(self.linear)).sub(pull)
    }
}

/// A drift in steps, and the kick after it.
#[derive(Clone, Copy, Debug)]
pub struct Turn<P> {
    pub drift: f64,
    pub pull: P,
}

/// All phases under way: lengths in nm, velocities in nm a step, and the largest length met at a kick.
#[derive(Clone, Debug)]
pub struct Runs {
    pub x: [f64; PHASES],
    pub v: [f64; PHASES],
    most: [f64; PHASES],
}

impl Runs {
    pub fn new(x: [f64; PHASES], v: [f64; PHASES]) -> Runs {
        Runs { x, v, most: x.map(f64::abs) }
    }

    /// How many are lost.
    pub fn lost(&self) -> usize {
        self.most.iter().filter(|most| **most > FAR).count()
    }

    /// Goes on for so many steps; where every phase of a group is lost, the group stays.
    pub fn advance<P: Pull>(&mut self, turns: &[Turn<P>], steps: u32) {
        for group in 0..PHASES / LANES {
            let at = group * LANES;
            if self.most[at..at + LANES].iter().any(|most| *most <= FAR) {
                Instructions::best().compute(Advance { runs: self, turns, steps, at });
            }
        }
    }
}

struct Advance<'a, P> {
    runs: &'a mut Runs,
    turns: &'a [Turn<P>],
    steps: u32,
    at: usize,
}

impl<P: Pull> Kernel for Advance<'_, P> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Advance { runs, turns, steps, at } = self;
        for at in (at..at + LANES).step_by(V::WIDTH) {
            let (mut x, mut v) = (V::load(&runs.x[at..]), V::load(&runs.v[at..]));
            let mut most = V::load(&runs.most[at..]);
            for _ in 0..steps {
                for turn in turns {
                    x = x.add(v.mul(V::splat(turn.drift)));
                    // No number comes without an infinity before it, which stays.
                    most = x.abs().larger(most);
                    v = v.add(turn.pull.kick(x));
                }
            }
            x.store(&mut runs.x[at..]);
            v.store(&mut runs.v[at..]);
            most.store(&mut runs.most[at..]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lanes(at: impl Fn(usize) -> f64) -> [f64; PHASES] {
        std::array::from_fn(at)
    }

    #[test]
    fn the_exponential_is_one() {
        // Over six units to either side, as said.
        for n in -600..=600 {
            let x = f64::from(n) / 100.0;
            let morse = Morse { linear: 0.0, strength: 1.0, part: -1.0 / 256.0 };
            let [pull] = morse.kick([x]);
            let e = (-x).exp();
            let truth = -(-x).exp_m1() * e;
            assert!((pull - truth).abs() <= 1e-15 + 2e-14 * truth.abs(), "{x}: {pull} {truth}");
        }
    }

    #[test]
    fn every_instruction_set_runs_to_the_same_bits() {
        let runs = Runs::new(lanes(|n| 0.002 * n as f64 - 0.03), lanes(|n| 0.001 * n as f64 - 0.02));
        let polynomial = [Turn { drift: 1.0, pull: Polynomial([-1.7, 40.0, -500.0]) }];
        let morse = [
            Turn { drift: 0.5, pull: Morse { linear: -0.1, strength: 0.03, part: -22.87 / 256.0 } },
            Turn { drift: 0.5, pull: Morse { linear: 0.0, strength: 0.03, part: -22.87 / 256.0 } },
        ];
        fn after<P: Pull>(runs: &Runs, turns: &[Turn<P>], set: Instructions) -> Vec<u64> {
            let mut runs = runs.clone();
            for at in (0..PHASES).step_by(LANES) {
                set.compute(Advance { runs: &mut runs, turns, steps: 300, at });
            }
            // NaN has many forms.
            let bits = |x: &f64| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() };
            runs.x.iter().chain(&runs.v).chain(&runs.most).map(bits).collect()
        }
        let (first, second) =
            (after(&runs, &polynomial, Instructions::PORTABLE), after(&runs, &morse, Instructions::PORTABLE));
        for set in Instructions::available() {
            assert_eq!(after(&runs, &polynomial, set), first, "{set:?}");
            assert_eq!(after(&runs, &morse, set), second, "{set:?}");
        }
    }

    #[test]
    fn what_leaves_is_lost_and_stays_so() {
        let turns = [Turn { drift: 1.0, pull: Polynomial([-1.0, 0.0, 300.0]) }];
        let mut runs = Runs::new(lanes(|n| if n % 2 == 0 { 0.01 } else { 0.5 }), lanes(|_| 0.0));
        runs.advance(&turns, 5);
        assert_eq!(runs.lost(), 24);
        runs.advance(&turns, 200);
        assert_eq!(runs.lost(), 24);
    }
}
