//! The aperture of a bond: its letters one by one, phase by phase, with the exponential of the platform.

use std::f64::consts::{PI, TAU};

use super::context::{Checked, Context, Outcome, holds};
use super::kind::Verify;
use crate::question::Aperture;
use molecules::aperture::{
    Bond, Edge, FAR, Hottest, LATE, Measured, Shape, Step, rungs, squared_frequency, thermal,
};
use number::{Radical, Rational, Real, Result, to_f64};
use words::{Force, Letter, Word};

const ROUTE: &str = "the word run letter by letter, phase by phase: no start is lost a tenth or half a kT below E*, and some are up to as much above it";

impl Verify for Aperture {
    fn check(&self, measured: &Measured, context: &Context) -> Result<Outcome> {
        let slow = self.slow.as_ref().map(|slow| &slow.value);
        let plain = Plain::of(&self.bond, &self.integrator()?, &self.temperature.value, slow);
        let mut found = context.outcome(ROUTE, Ok(()), &measured.steps, |step| plain.holds(step))?;
        let what = "that no bond of a band is lost at less than its least E*: computed again only";
        found.not_rechecked.extend(self.band.is_some().then(|| what.into()));
        Ok(found)
    }
}

/// A letter's kick or drift, in shares of the step.
enum Part {
    Drift(f64),
    Kick { bond: f64, slow: f64 },
}

/// The bond and the word, in amu, nm, fs.
pub struct Plain {
    shape: Shape,
    parts: Vec<Part>,
    /// Whether a letter O stands within the word.
    is_within: bool,
    mass: f64,
    thermal: f64,
    squares: [f64; 2],
}

impl Plain {
    /// A bond at a temperature in K by a word; `slow` is the slow force's period in fs.
    pub fn of(bond: &Bond, word: &Word, temperature: &Rational, slow: Option<&Rational>) -> Plain {
        let letters = word.letters();
        let is_thermostat = |letter: &Letter| matches!(letter, Letter::Friction { .. });
        let ends = letters.iter().enumerate().filter(|(_, letter)| is_thermostat(letter));
        let is_within = ends.map(|(at, _)| at).any(|at| at > 0 && at + 1 < letters.len());
        let double = |x: &Radical| x.enclosure(64).mid_f64();
        let part = |letter: &&Letter| match letter {
            Letter::Drift(time) => Some(Part::Drift(double(time))),
            Letter::Kick { force, powers, .. } => {
                let share = double(&powers[0]);
                let bond = if *force == Force::Second { 0.0 } else { share };
                Some(Part::Kick { bond, slow: if *force == Force::First { 0.0 } else { share } })
            }
            _ => None,
        };
        let mass = bond.mass();
        let slow = slow.map_or(0.0, |slow| squared_frequency(to_f64(slow)));
        Plain {
            shape: bond.shape.clone(),
            parts: letters.iter().filter_map(part).collect(),
            is_within,
            thermal: to_f64(&thermal(temperature)),
            squares: [to_f64(&(bond.curvature() / &mass)), slow],
            mass: to_f64(&mass),
        }
    }

    /// −V'(x)/μ.
    fn pull(&self) -> Box<dyn Fn(f64) -> f64 + '_> {
        match &self.shape {
            Shape::Harmonic { .. } => Box::new(|x| -self.squares[0] * x),
            Shape::Morse { depth, a } => {
                let (strength, a) = (2.0 * to_f64(depth) * to_f64(a) / self.mass, to_f64(a));
                Box::new(move |x| {
                    let e = (-a * x).exp();
                    strength * (e - 1.0) * e
                })
            }
            Shape::Polynomial { k2, k3, k4 } => {
                let [c1, c2, c3] = [2.0 * to_f64(k2), 3.0 * to_f64(k3), 4.0 * to_f64(k4)];
                Box::new(move |x| -(c1 * x + c2 * x * x + c3 * x * x * x) / self.mass)
            }
        }
    }

    /// The propagator of a step, rows of lengths and velocities.
    fn linear(&self, h: f64) -> [[f64; 2]; 2] {
        let mut q = [[1.0, 0.0], [0.0, 1.0]];
        for part in &self.parts {
            let [lengths, velocities] = &mut q;
            for (x, v) in lengths.iter_mut().zip(velocities) {
                match part {
                    Part::Drift(time) => *x += h * time * *v,
                    Part::Kick { bond, slow } => {
                        *v -= h * (bond * self.squares[0] + slow * self.squares[1]) * *x;
                    }
                }
            }
        }
        q
    }

    /// How many of 48 phases are lost at an energy in kT.
    fn lost(&self, h: f64, energy: f64) -> usize {
        let [[a, b], [c, d]] = self.linear(h);
        let length = (2.0 * energy * self.thermal / (self.mass * (self.squares[0] + self.squares[1]))).sqrt();
        let is_sampled = self.is_within && (a + d).abs() < 2.0 && -c / b > 0.0;
        let frequency = if is_sampled { (-c / b).sqrt() } else { (self.squares[0] + self.squares[1]).sqrt() };
        let pull = self.pull();
        let is_lost = |j: &i32| {
            let angle = TAU * (f64::from(*j) + 0.5) / 48.0;
            let (mut x, mut v) = (length * angle.cos(), length * frequency * angle.sin());
            (0..LATE).any(|_| {
                self.parts.iter().any(|part| {
                    match part {
                        Part::Drift(time) => x += h * time * v,
                        Part::Kick { bond, slow } => {
                            v += h * (bond * pull(x) - slow * self.squares[1] * x);
                            return x.is_nan() || x.abs() > FAR;
                        }
                    }
                    false
                })
            })
        };
        (0..48).filter(is_lost).count()
    }

    /// That a bond stays below a level in kT at the share of its period where it is said to begin to be too
    /// hot, and is lost just above it, at E* or up to as much above it as other routes differ; where it is
    /// nowhere too hot, that it stays nearly up to the linear limit.
    pub fn begins(&self, first: Option<&Edge>, level: f64) -> Checked {
        let period = TAU / self.squares[0].sqrt();
        let cold = |share: f64| {
            rungs()
                .take_while(|rung| *rung <= level - room(level))
                .all(|rung| self.lost(share * period, rung) == 0)
        };
        let Some(Edge { share, aperture }) = first else {
            return holds(cold(0.99 / PI), || "bonds are lost by another route".into());
        };
        holds(cold(*share) && cold(0.97 * share), || {
            format!("at T times {share} bonds are lost by another route")
        })?;
        let is_lost = above(*aperture).iter().any(|energy| self.lost(BESIDE * share * period, *energy) > 0);
        holds(is_lost, || format!("just above T times {share} no bond is lost by another route"))
    }

    fn holds(&self, step: &Step) -> Checked {
        let h = to_f64(&step.step);
        let [[a, _], [_, d]] = self.linear(h);
        let wrong = || "its turn is another one".into();
        match step.turn {
            // Near a half or a whole turn a double of the cosine tells half of the digits.
            Some(turn) => holds(((TAU * turn).cos() - (a + d) / 2.0).abs() < 1e-9, wrong)?,
            None => holds((a + d).abs() > 2.0 - 1e-9, wrong)?,
        }
        let last = rungs().last().expect("there are rungs");
        let below = |energy: f64| rungs().filter(|rung| *rung <= energy - room(energy)).last();
        if let Some(rung) = below(step.aperture.unwrap_or(last)) {
            holds(self.lost(h, rung) == 0, || format!("at {rung} kT a bond is lost by another route"))?;
        }
        if let Some(aperture) = step.aperture {
            let is_lost = above(aperture).iter().any(|energy| self.lost(h, *energy) > 0);
            holds(is_lost, || format!("at {aperture} kT and above no bond is lost by another route"))?;
        }
        if let Some(Hottest { step: at, aperture: Some(least) }) = &step.band {
            let is_lost = above(*least).iter().any(|energy| self.lost(to_f64(at), *energy) > 0);
            holds(is_lost, || {
                format!("at {least} kT and above no bond is lost at {at} fs by another route")
            })?;
        }
        if let Some(band) = &step.band {
            let of_all = |aperture: Option<f64>| aperture.unwrap_or(f64::INFINITY);
            holds(of_all(band.aperture) <= of_all(step.aperture), || "a band holds its own step".into())?;
        }
        if let Some(half) = step.half {
            let is_lost = above(half).iter().any(|energy| 2 * self.lost(h, *energy) >= 48);
            holds(is_lost, || format!("at {half} kT and above less than half are lost by another route"))?;
        }
        Ok(())
    }
}

/// How far another route may tell E* otherwise, in kT: another order of sums, on chaotic orbits.
fn room(energy: f64) -> f64 {
    f64::max(0.5, 0.1 * energy)
}

/// E* and energies up to that much above it.
fn above(energy: f64) -> [f64; 5] {
    [0.0, 0.25, 0.5, 0.75, 1.0].map(|part| energy + part * room(energy))
}

/// The step that loses a bond lies within this factor of the one that does not: half a thousandth of the
/// period, halved six times.
const BESIDE: f64 = 1.0001;
