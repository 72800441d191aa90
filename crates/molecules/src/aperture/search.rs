//! The search for the least energy at which a bond is lost, and the share of a thermal ensemble that is.

use std::ops::Range;
use std::sync::OnceLock;

use super::bond::{Bond, Shape};
use super::kernel::{DOUBLINGS, Morse, PHASES, Polynomial, Pull, Runs, Turn};
use super::map::{Map, Stage, squared_frequency};
use number::parallel::go_on;
use number::{Ball, Error, Rational, Result, rational, to_f64};
use words::{Forces, Stability, Word};

/// The steps of a run: E* and the half aperture are of these.
pub const LATE: u32 = 20_000;

/// The steps in which the share of a thermal ensemble is lost.
pub const EARLY: u32 = 3_000;

/// Between these many steps somebody looks who is lost.
const PIECE: u32 = 500;

/// The gas constant in amu nm²/fs² and K: k_B N_A, both exact in the SI.
const GAS: &str = "1.380649e-23*6.02214076e23*1e-9";

/// What is asked of every step: a bond at a temperature, a method, and perhaps a slow force.
#[derive(Clone, Debug)]
pub struct Measurement {
    shape: Shape,
    map: Map,
    /// kT in amu nm²/fs².
    thermal: f64,
    /// The reduced mass in amu.
    mass: f64,
    /// Squared frequencies in 1/fs²: the bond's at rest, the slow force's.
    squares: [f64; 2],
    /// Linear stability ends at this step in fs; `None` where a slow force has steps of its own.
    pub limit: Option<f64>,
    /// The energy in kT at which the bond breaks by itself, whatever the step; `None` where it does not.
    pub depth: Option<f64>,
}

/// The answer at one step.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// In fs.
    pub step: Rational,
    /// The share of a full turn that the method makes; `None` where it is linearly unstable.
    pub turn: Option<f64>,
    /// The k for which 2 π/k is nearest to the turn, and the step in fs nearest to this one that has it.
    pub nearest: Option<(u64, Option<f64>)>,
    /// The least energy in kT at which some phase is lost; `None` where none is up to the last rung.
    pub aperture: Option<f64>,
    /// The least energy in kT at which at least half of all phases are lost.
    pub half: Option<f64>,
    /// The share of a thermal ensemble of starts that is lost in [`EARLY`] steps.
    pub share: f64,
    /// exp(E*): so many independent energies see one above E*; a bond has about one a picosecond.
    pub enough: Option<f64>,
    /// The least E* of the bonds whose periods are in a band, where one was asked for.
    pub band: Option<Hottest>,
}

/// The step of a band at which E* is least.
#[derive(Clone, Debug, PartialEq)]
pub struct Hottest {
    /// In fs.
    pub step: Rational,
    /// E* there, in kT; `None` where no bond of the band is lost up to the last rung.
    pub aperture: Option<f64>,
}

/// A step at which the method makes the k-th part of a turn, in fs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resonance {
    pub k: u64,
    pub step: Option<f64>,
}

/// The energies of starts in kT: by 1/16 up to 1, then by 1/4 up to 40.
pub fn rungs() -> impl Iterator<Item = f64> {
    let fine = (1..16).map(|n| f64::from(n) / 16.0);
    fine.chain((4..=160).map(|n| f64::from(n) / 4.0))
}

/// kT in amu nm²/fs².
pub fn thermal(temperature: &Rational) -> Rational {
    number::parse::parse_rational("gas", GAS).expect("a number") * temperature
}

/// The fewest and the most independent energies that a run may see: energies beyond 40 kT, of which exp(40)
/// are needed to see one, are not measured.
const SEEN: std::ops::RangeInclusive<f64> = 1.0..=1e17;

/// How many independent energies of bonds a run of `length` fs sees: about one a picosecond and bond.
///
/// # Errors
/// Fewer than one, or more than 10^17.
pub fn energies_seen(bonds: u64, length: &Rational) -> Result<Rational> {
    let seen = Rational::from_integer(bonds.into()) * length / Rational::from_integer(1000.into());
    if SEEN.contains(&to_f64(&seen)) {
        return Ok(seen);
    }
    let remedy = "choose 1 to 1e17 bonds times picoseconds: energies up to 40 kT are measured";
    Err(Error::input("bonds", bonds, remedy))
}

/// The energy in kT of about the hottest of so many: their logarithm, the double nearest to it.
pub fn hottest_of(seen: &Rational) -> f64 {
    Ball::nearest_f64(|bits| Ball::from_rational(seen, bits).ln(bits).expect("somebody looks at a bond"))
}

/// exp(x), the double nearest to it.
fn exp(x: f64) -> f64 {
    let exact = rational::from_f64_exact(x).expect("energies are finite");
    Ball::nearest_f64(|bits| Ball::from_rational(&exact, bits).exp(bits))
}

/// The share of a thermal ensemble that each rung stands for: what lies nearer to it than to its neighbours.
fn weights() -> &'static [f64] {
    static WEIGHTS: OnceLock<Vec<f64>> = OnceLock::new();
    WEIGHTS.get_or_init(|| {
        let rungs: Vec<f64> = rungs().collect();
        let middles = rungs.windows(2).map(|pair| exp(-0.5 * (pair[0] + pair[1])));
        let ends: Vec<f64> = [1.0].into_iter().chain(middles).chain([0.0]).collect();
        ends.windows(2).map(|pair| pair[0] - pair[1]).collect()
    })
}

/// cos and sin of every phase, the doubles nearest to them.
fn phases() -> &'static [[f64; PHASES]; 2] {
    static PHASE: OnceLock<[[f64; PHASES]; 2]> = OnceLock::new();
    PHASE.get_or_init(|| {
        let angle = |j: usize, bits| {
            let share = Rational::new((2 * j as u64 + 1).into(), (PHASES as u64).into());
            Ball::pi(bits).mul(&Ball::from_rational(&share, bits), bits)
        };
        [
            std::array::from_fn(|j| Ball::nearest_f64(|bits| angle(j, bits).cos(bits))),
            std::array::from_fn(|j| Ball::nearest_f64(|bits| angle(j, bits).sin(bits))),
        ]
    })
}

impl Measurement {
    /// A bond at a temperature in K by a method; `slow` is the period in fs that a harmonic force about the
    /// bond's rest would give its reduced mass.
    ///
    /// # Errors
    /// A word that is not of kicks and drifts alone, one of two forces without the slow one.
    pub fn new(
        bond: &Bond,
        temperature: &Rational,
        word: &Word,
        slow: Option<&Rational>,
    ) -> Result<Measurement> {
        let map = Map::of(word)?;
        if word.names_forces() && slow.is_none() {
            return Err(Error::missing("slow", "the word names two forces: give the slow one, as 40fs"));
        }
        let (kt, mass) = (thermal(temperature), bond.mass());
        let squares =
            [to_f64(&(bond.curvature() / &mass)), slow.map_or(0.0, |slow| squared_frequency(to_f64(slow)))];
        let limit = if word.names_forces() { None } else { limit(word, squares[0] + squares[1]) };
        let kt = to_f64(&kt);
        let depth = bond.depth().map(|depth| depth / kt);
        Ok(Measurement {
            shape: bond.shape.clone(),
            map,
            thermal: kt,
            mass: to_f64(&mass),
            squares,
            limit,
            depth,
        })
    }

    /// The period of the smallest oscillations in fs.
    pub fn period(&self) -> f64 {
        std::f64::consts::TAU / (self.squares[0] + self.squares[1]).sqrt()
    }

    /// kT in kJ/mol.
    pub fn thermal(&self) -> f64 {
        self.thermal * 1e6
    }

    /// The kicks of one step from all phases at all energies, at most.
    pub fn cost(&self) -> u64 {
        self.map.kicks() * PHASES as u64 * u64::from(LATE) * rungs().count() as u64
    }

    /// The first steps up to `most` fs at which the method makes a third, ... an eighth of a turn.
    pub fn resonances(&self, most: f64) -> Vec<Resonance> {
        let step = |k| self.map.first_resonance(k, most, self.squares);
        (3..=8).map(|k| Resonance { k, step: step(k) }).collect()
    }

    /// The answer at a step in fs.
    ///
    /// # Errors
    /// Where somebody has stopped the work.
    pub fn at(&self, step: &Rational) -> Result<Step> {
        let h = to_f64(step);
        let turn = self.map.turn(h, self.squares);
        let nearest = turn.and_then(nearest_part).map(|k| (k, self.map.resonance(k, h, self.squares)));
        let found = self.found(h, None)?;
        let enough = found.aperture.map(exp);
        let Found { aperture, half, share } = found;
        Ok(Step { step: step.clone(), turn, nearest, aperture, half, share, enough, band: None })
    }

    /// E* at a step in fs where it is below a level, both in kT.
    ///
    /// # Errors
    /// Where somebody has stopped the work.
    pub fn aperture_below(&self, step: &Rational, level: f64) -> Result<Option<f64>> {
        Ok(self.found(to_f64(step), Some(0.0..level))?.aperture)
    }

    /// E* at a step in fs where some phase is lost at energies from half the level up to it, all in kT.
    ///
    /// A bond that is lost from a lower energy passes through these on its way out, so they tell by themselves
    /// whether any is. That is an observation and no proof: it held at all steps that were tried (the test
    /// beside [`Cold`](super::Cold)).
    ///
    /// # Errors
    /// Where somebody has stopped the work.
    pub fn aperture_seen_below(&self, step: &Rational, level: f64) -> Result<Option<f64>> {
        let half = 0.5 * level;
        match self.found(to_f64(step), Some(half..level))?.aperture {
            Some(seen) => Ok(Some(self.aperture_below(step, half)?.unwrap_or(seen))),
            None => Ok(None),
        }
    }

    /// What runs at a step tell; of the least energy lost alone, where that is in a range, if one is given.
    fn found(&self, h: f64, range: Option<Range<f64>>) -> Result<Found> {
        match &self.shape {
            Shape::Morse { depth, a } => self.morse(h, [to_f64(depth), to_f64(a)], range),
            Shape::Harmonic { k } => self.polynomial(h, [to_f64(k), 0.0, 0.0], range),
            Shape::Polynomial { k2, k3, k4 } => {
                let [k2, k3, k4] = [k2, k3, k4].map(to_f64);
                self.polynomial(h, [2.0 * k2, 3.0 * k3, 4.0 * k4], range)
            }
        }
    }

    /// Of the derivative c1 x + c2 x² + c3 x³.
    fn polynomial(&self, h: f64, derivative: [f64; 3], range: Option<Range<f64>>) -> Result<Found> {
        let [c1, c2, c3] = derivative.map(|c| c * (h * h / self.mass));
        let slow = self.squares[1] * (h * h);
        let pull = |stage: &Stage| {
            Polynomial([-(stage.bond * c1 + stage.slow * slow), -(stage.bond * c2), -(stage.bond * c3)])
        };
        self.search(h, pull, range)
    }

    fn morse(&self, h: f64, [depth, a]: [f64; 2], range: Option<Range<f64>>) -> Result<Found> {
        let strength = 2.0 * depth * a * (h * h / self.mass);
        let slow = self.squares[1] * (h * h);
        // −a/2^8, exactly; −V' is 2 D a (e − 1) e.
        let part = -a / f64::from(1 << DOUBLINGS);
        let pull =
            |stage: &Stage| Morse { linear: -(stage.slow * slow), strength: -(stage.bond * strength), part };
        self.search(h, pull, range)
    }

    /// From the lowest rung up.
    fn search<P: Pull>(
        &self,
        h: f64,
        pull: impl Fn(&Stage) -> P,
        range: Option<Range<f64>>,
    ) -> Result<Found> {
        let turn = |stage: &Stage| Turn { drift: stage.drift, pull: pull(stage) };
        let first = turn(&self.map.first);
        let turns: Vec<_> = self.map.stages.iter().map(turn).collect();
        let mut found = Found { aperture: None, half: None, share: 0.0 };
        for (energy, weight) in rungs().zip(weights()) {
            go_on()?;
            if let Some(range) = &range {
                if energy >= range.end || found.aperture.is_some() {
                    break;
                }
                if energy < range.start {
                    continue;
                }
            }
            let mut runs = self.start(h, energy, &first);
            let mut done = 0;
            while done < LATE && !found.knows_all(&runs, done) && (range.is_none() || runs.lost() == 0) {
                runs.advance(&turns, PIECE);
                done += PIECE;
                if done == EARLY {
                    found.share += weight * (runs.lost() as f64 / PHASES as f64);
                }
            }
            let lost = runs.lost();
            if lost > 0 && found.aperture.is_none() {
                found.aperture = Some(energy);
            }
            if 2 * lost >= PHASES && found.half.is_none() {
                found.half = Some(energy);
            }
        }
        Ok(found)
    }

    /// All phases at an energy in kT, after the first stage.
    fn start<P: Pull>(&self, h: f64, energy: f64, first: &Turn<P>) -> Runs {
        let stiffness = self.mass * (self.squares[0] + self.squares[1]);
        let length = (2.0 * energy * self.thermal / stiffness).sqrt();
        let speed = length * self.map.speed(h, self.squares);
        let [cos, sin] = phases();
        let (x, v) = (cos.map(|cos| length * cos), sin.map(|sin| speed * sin));
        let mut runs = Runs::new(x, v);
        runs.advance(std::slice::from_ref(first), 1);
        runs
    }
}

/// What one step's runs tell.
struct Found {
    aperture: Option<f64>,
    half: Option<f64>,
    share: f64,
}

impl Found {
    /// Whether these runs can tell nothing more: after [`EARLY`] steps, or with all phases lost, what both
    /// apertures need is known.
    fn knows_all(&self, runs: &Runs, done: u32) -> bool {
        let lost = runs.lost();
        done >= EARLY && (self.half.is_some() || 2 * lost >= PHASES)
    }
}

/// The k for which 1/k is nearest to a share of a turn.
fn nearest_part(turn: f64) -> Option<u64> {
    let below = (1.0 / turn).floor();
    // Beyond this k the parts lie nearer to each other than doubles of the trace tell.
    if !(2.0..1e6).contains(&below) {
        return None;
    }
    let is_lower = (1.0 / below - turn).abs() <= (turn - 1.0 / (below + 1.0)).abs();
    Some(below as u64 + u64::from(!is_lower))
}

/// The step at which linear stability ends, of one force.
fn limit(word: &Word, square: f64) -> Option<f64> {
    let stability = Stability::of(&word.polynomials(&Forces::one()));
    if !stability.begins_stable() {
        return Some(0.0);
    }
    let s = stability.first_edge()?.s().mid_f64();
    Some((s / square).sqrt())
}
