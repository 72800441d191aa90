//! The method as a map: kicks and drifts in shares of the step, joined where they touch; its turn.

use std::f64::consts::TAU;

use number::{Ball, Error, Radical, Real, Result};
use words::{Force, Letter, Word};

/// A drift, and the kick after it, by the bond's force and by the slow one; shares of the step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stage {
    pub drift: f64,
    pub bond: f64,
    pub slow: f64,
}

/// A method of kicks and drifts.
///
/// A run is `first`, then `stages` again and again: the last kick of a step and the first one of the next
/// are one. A letter O, F or I is where a thermostat acts; here there is no friction.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    pub first: Stage,
    pub stages: Vec<Stage>,
    /// One step, from where it begins.
    step: Vec<Stage>,
    /// Whether a thermostat acts within the word, and not at its ends alone.
    is_thermal_within: bool,
}

/// More letters than this are no method of molecular dynamics.
const MOST_LETTERS: u64 = 10_000;

impl Map {
    /// The method of a word.
    ///
    /// # Errors
    /// Letters other than kicks by the force and drifts, none of the two, too many.
    pub fn of(word: &Word) -> Result<Map> {
        let refused = |remedy: &str| Err(Error::input("word", word, remedy));
        if word.len() > MOST_LETTERS {
            return refused("write 10000 letters at most");
        }
        let letters = word.letters();
        let is_thermostat = |letter: &&Letter| matches!(letter, Letter::Friction { .. });
        let within = letters.get(1..letters.len().saturating_sub(1)).unwrap_or_default();
        let is_thermal_within = within.iter().any(is_thermostat);
        let mut all: Vec<Stage> = Vec::new();
        for letter in letters {
            match letter {
                Letter::Drift(time) => Stage::drifted(&mut all, nearest(time)),
                Letter::Kick { force, filter, powers } if powers.len() == 1 && filter.is_one() => {
                    let share = nearest(&powers[0]);
                    let [bond, slow] = match force {
                        Force::All => [share, share],
                        Force::First => [share, 0.0],
                        Force::Second => [0.0, share],
                    };
                    Stage::kicked(&mut all, bond, slow);
                }
                Letter::Friction { .. } => {}
                _ => return refused("an aperture is of kicks K, K1, K2 and drifts D alone"),
            }
        }
        if all.iter().all(|stage| stage.drift == 0.0) || all.iter().all(|stage| stage.bond == 0.0) {
            return refused("the word never moves the bond: it needs kicks K or K1, and drifts D");
        }
        let step = all.clone();
        let first = all.remove(0);
        Stage::drifted(&mut all, first.drift);
        Stage::kicked(&mut all, first.bond, first.slow);
        Ok(Map { first, stages: all, step, is_thermal_within })
    }

    /// A step of length `h` from where it begins, on a bond and a slow force of these squared frequencies:
    /// its columns, lengths first, velocities times h second.
    fn columns(&self, h: f64, [bond, slow]: [f64; 2]) -> [[f64; 2]; 2] {
        let mut columns = [[1.0, 0.0], [0.0, 1.0]];
        for stage in &self.step {
            let kick = h * h * (stage.bond * bond + stage.slow * slow);
            for [x, v] in &mut columns {
                *x += stage.drift * *v;
                *v -= kick * *x;
            }
        }
        columns
    }

    /// Half the trace of a step of length `h`.
    pub fn half_trace(&self, h: f64, squares: [f64; 2]) -> f64 {
        let [[a, _], [_, d]] = self.columns(h, squares);
        (a + d) / 2.0
    }

    /// Velocities times h over lengths of the starts: those of the bond itself, or, where a thermostat acts
    /// within the word, those that the method has with these lengths. (Middle schemes have thermal lengths at
    /// their kicks, and slower velocities there.)
    pub fn speed(&self, h: f64, squares: [f64; 2]) -> f64 {
        let [[_, c], [b, _]] = self.columns(h, squares);
        let square = -c / b;
        if self.is_thermal_within && self.half_trace(h, squares).abs() < 1.0 && square > 0.0 {
            return square.sqrt();
        }
        h * (squares[0] + squares[1]).sqrt()
    }

    /// The share of a full turn that a step makes, up to one half; `None` where the step is linearly
    /// unstable.
    pub fn turn(&self, h: f64, squares: [f64; 2]) -> Option<f64> {
        const BITS: u32 = 96;
        let cosine = number::rational::from_f64_exact(self.half_trace(h, squares))?;
        let angle = Ball::from_rational(&cosine, BITS).acos(BITS)?;
        Some(angle.div(&Ball::pi(BITS), BITS)?.scale2(-1).mid_f64())
    }

    /// The step nearest to `h`, from 0 to 3 h, at which a step makes the k-th part of a turn.
    pub fn resonance(&self, k: u64, h: f64, squares: [f64; 2]) -> Option<f64> {
        let part = h / 200.0;
        let above = |h: f64| self.half_trace(h, squares) > cosine(k);
        (1..=400).find_map(|n| {
            let (near, far) = (f64::from(n - 1) * part, f64::from(n) * part);
            [[h + near, h + far], [h - far, h - near]]
                .into_iter()
                .find(|[lo, hi]| *lo >= 0.0 && above(*lo) != above(*hi))
                .map(|ends| bisected(above, ends))
        })
    }

    /// The first step at which a step makes the k-th part of a turn; `None` where there is none up to `most`.
    pub fn first_resonance(&self, k: u64, most: f64, squares: [f64; 2]) -> Option<f64> {
        const PARTS: u32 = 2000;
        let above = |h: f64| self.half_trace(h, squares) > cosine(k);
        let place = |n: u32| most * (f64::from(n) / f64::from(PARTS));
        let found = (1..=PARTS).find(|&n| above(place(n - 1)) != above(place(n)))?;
        Some(bisected(above, [place(found - 1), place(found)]))
    }

    /// The kicks of a step.
    pub fn kicks(&self) -> u64 {
        self.stages.len() as u64
    }
}

/// cos(2 π/k), the same on every machine.
fn cosine(k: u64) -> f64 {
    if k <= 2 {
        return -1.0;
    }
    Ball::nearest_f64(|bits| {
        let angle = Ball::pi(bits).scale2(1).div(&Ball::from_integer(&k.into()), bits);
        angle.expect("k > 0").cos(bits)
    })
}

/// Where the answer changes between two ends, to the last digit.
fn bisected(above: impl Fn(f64) -> bool, [mut lo, mut hi]: [f64; 2]) -> f64 {
    let at_first = above(lo);
    loop {
        let middle = 0.5 * (lo + hi);
        if middle <= lo || middle >= hi {
            return middle;
        }
        if above(middle) == at_first { lo = middle } else { hi = middle }
    }
}

/// The squared frequency of a period.
pub fn squared_frequency(period: f64) -> f64 {
    let frequency = TAU / period;
    frequency * frequency
}

fn nearest(x: &Radical) -> f64 {
    Ball::nearest_f64(|bits| x.enclosure(bits))
}

impl Stage {
    /// One more drift.
    fn drifted(all: &mut Vec<Stage>, drift: f64) {
        if drift == 0.0 {
            return;
        }
        match all.last_mut() {
            Some(last) if last.bond == 0.0 && last.slow == 0.0 => last.drift += drift,
            _ => all.push(Stage { drift, ..Stage::default() }),
        }
    }

    /// One more kick.
    fn kicked(all: &mut Vec<Stage>, bond: f64, slow: f64) {
        if bond == 0.0 && slow == 0.0 {
            return;
        }
        if all.is_empty() {
            all.push(Stage::default());
        }
        let last = all.last_mut().expect("one is there");
        (last.bond, last.slow) = (last.bond + bond, last.slow + slow);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(word: &str) -> Map {
        Map::of(&word.parse().unwrap()).unwrap()
    }

    #[test]
    fn touching_letters_are_one() {
        let whole = Stage { drift: 1.0, bond: 1.0, slow: 1.0 };
        let verlet = map("K(1/2) D(1) K(1/2)");
        assert_eq!((verlet.first.drift, verlet.first.bond, &verlet.stages), (0.0, 0.5, &vec![whole]));
        let middle = map("D(1/2) K(1) D(1/2)");
        assert_eq!((middle.first.drift, middle.first.bond, &middle.stages), (0.5, 1.0, &vec![whole]));
        assert_eq!(map("O(1/2) K(1/2) D(1) K(1/2) O(1/2)"), verlet);
        let within = map("K(1/2) D(1/2) O(1) D(1/2) K(1/2)");
        assert_eq!(within, Map { is_thermal_within: true, ..verlet.clone() });
        // There the velocities are 1 − h² ω²/4 = 3/4 of the thermal ones, squared.
        let [thermal, slower] = [&verlet, &within].map(|map| map.speed(1.0, [1.0, 0.0]));
        assert!(thermal == 1.0 && (slower - 0.75f64.sqrt()).abs() < 1e-15);
        assert_eq!(map("K2(1/2) 4*(K1(1/8) D(1/4) K1(1/8)) K2(1/2)").stages.len(), 4);
    }

    #[test]
    fn a_step_turns_as_its_theory_says() {
        let (verlet, squares) = (map("K(1/2) D(1) K(1/2)"), [1.0, 0.0]);
        // sin(θ/2) = h ω/2.
        assert!((verlet.turn(1.0, squares).unwrap() - 1.0 / 6.0).abs() < 1e-15);
        assert_eq!(verlet.turn(2.1, squares), None);
        for (k, step) in [(3, 3f64.sqrt()), (4, 2f64.sqrt()), (6, 1.0)] {
            assert!((verlet.resonance(k, 1.1, squares).unwrap() - step).abs() < 1e-14, "{k}");
            assert!((verlet.first_resonance(k, 2.0, squares).unwrap() - step).abs() < 1e-14, "{k}");
        }
        assert_eq!(verlet.resonance(3, 0.5, squares), None);
    }

    #[test]
    fn words_that_do_not_move_a_bond_are_refused() {
        for word in ["K(1)", "D(1)", "K2(1) D(1)", "C(1)", "R(1)", "K(1, 1/2) D(1)"] {
            assert!(Map::of(&word.parse().unwrap()).is_err(), "{word}");
        }
    }
}
