//! Euclid's algorithm on a box of steps: both return maps of each level, until a common cone proves all of it unstable.

use super::UP;
use super::cone::{Cone, Margins};
use super::family::{Cut, Family, Order};
use super::frame::{Candidate, Frame};
use super::taylor::{Taylor, product_of_slopes};
use crate::number::U;

/// The most levels of one path, and forks of it where the box has ratios of both kinds.
const LEVELS: usize = 60;
const FORKS: usize = 4;

/// A map whose bound or whose norm is larger proves nothing any more.
const MOST_ERROR: f64 = 0.5;
const MOST_SIZE: f64 = 1e6;

/// Boxes with more bisections to go are not tried.
const NEAR: u32 = 3;

/// From so many kicks over the strength on, a map that nowhere is hyperbolic shows that there is no band.
const ENOUGH: f64 = 1.5;

/// Levels that are followed in the middle of a box alone once it is too large for its bounds, and about how many bisections it is from
/// being proven where one of them has a cone, and where none has.
const FURTHER: u32 = 6;
const NEAREST: u32 = 4;
const UNSEEN: u32 = 8;

/// So many bisections before it may be proven a box is tried to the first order first.
const FAR: u32 = 5;

/// Beyond this |α| the coordinates that no angle enters are tried, too: where kicks are strong, turning frames are not near 1.
const STRONG: f64 = 0.3;
const ENOUGH_WHERE_STRONG: f64 = 8.0;
const MOST_STEPS: u32 = 64;

/// The result for a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Found {
    /// Every ratio is unstable.
    Certified,
    /// A part of it may be: the step to bisect, and about how many times until then.
    Open { direction: usize, to_go: u32 },
    /// The first-order law expects no band.
    Dropped,
}

/// A length a₀ + a₁ τ.
#[derive(Clone, Copy, Debug)]
struct Length(i64, i64);

impl Length {
    fn minus(self, other: Length) -> Option<Length> {
        let (a, b) = (self.0.checked_sub(other.0)?, self.1.checked_sub(other.1)?);
        // Integers of doubles.
        (a.unsigned_abs().max(b.unsigned_abs()) < 1 << 50).then_some(Length(a, b))
    }

    /// Its value at a double τ, and a bound on the rounding.
    fn at(self, tau: f64) -> (f64, f64) {
        let (a, b) = (self.0 as f64, self.1 as f64);
        (b * tau + a, 3.0 * U * ((b * tau).abs() + a.abs()))
    }

    /// How far it is from there at most.
    fn reach(self, tau: &Taylor) -> f64 {
        (self.1 as f64).abs() * tau.reach() * UP
    }

    /// r = short/long, of this length and a shorter one. Their determinant D is ±1, so r(τ) − r(τ₀) = D (τ − τ₀)/(long(τ) long(τ₀)).
    fn share(self, short: Length, tau: &Taylor) -> Option<Taylor> {
        let [(length, long_off), (rest, rest_off)] = [self, short].map(|own| own.at(tau.center));
        let moved = self.reach(tau);
        let least = (length - long_off - moved) * (1.0 - 4.0 * U);
        if least.is_nan() || least <= 0.0 {
            return None;
        }
        let cross = |x: i64, y: i64| i128::from(x) * i128::from(y);
        let determinant = (cross(short.1, self.0) - cross(short.0, self.1)) as f64;
        let center = rest / length;
        // D δ/long², −D b δ²/long³, and the rest: D b² δ³/(long³ long(τ)).
        let by = determinant / (length * length);
        let bend = -by * self.1 as f64 / length;
        let squares = product_of_slopes(tau.slopes, tau.slopes);
        let (cube, off) = (least * least * least, 4.0 * long_off / least);
        let third = tau.reach() * moved * moved / (cube * least);
        let curved = by.abs() * tau.error + bend.abs() * tau.square_beside_affine();
        // The rounding of the lengths, in each term.
        let terms = by.abs() * tau.reach() + bend.abs() * tau.reach() * tau.reach();
        let rounding = (rest_off + center.abs() * long_off) / least
            + 8.0 * U * center.abs()
            + (2.0 * off + 16.0 * U) * terms;
        Some(Taylor {
            center,
            slopes: tau.slopes.map(|slope| slope * by),
            squares: [0, 1, 2].map(|k| tau.squares[k] * by + bend * squares[k]),
            error: (third + curved + rounding) * (1.0 + 1e-9),
        })
    }
}

/// Both return maps, on 0..a and on a..a + b.
struct Level {
    maps: [Family; 2],
    lengths: [Length; 2],
}

/// One frame on its way down.
struct Trial {
    /// Heights from which on hyperbolic maps are to be seen.
    enough: f64,
    /// Whether there may be a band.
    is_open: bool,
    direction: usize,
    /// Whether the direction is that of a level whose middle has a cone.
    is_settled: bool,
    /// Shares of both steps in what is not affine.
    bending: [f64; 2],
    forks: usize,
    /// About so many bisections until a level proves it.
    to_go: u32,
    /// Whether the middle of the box has a cone on some level.
    is_seen: bool,
}

/// Where a box is far from being proven, the second order is for those alone whose middle has a cone.
fn tried(to_go: u32, by: impl Fn(Order) -> Option<Trial>) -> Option<Trial> {
    if to_go >= FAR {
        let trial = by(Order::First)?;
        if !(trial.is_seen && trial.is_open) {
            return Some(trial);
        }
    }
    by(Order::Second)
}

impl Frame {
    /// Whether a common cone of one level proves every ratio of the box unstable; it is thought to take `to_go` more bisections.
    pub fn prove(&self, to_go: u32) -> Found {
        let mut found = Found::Dropped;
        let mut keep = |direction: usize, left: u32| {
            if !matches!(found, Found::Open { to_go, .. } if to_go <= left) {
                found = Found::Open { direction, to_go: left };
            }
        };
        let Some(turning) = &self.turning else {
            return match self.is_strong().then(|| tried(to_go, |order| self.try_plain(order))) {
                Some(None) => Found::Certified,
                Some(Some(trial)) => Found::Open { direction: 0, to_go: trial.to_go },
                None => Found::Open { direction: 0, to_go: 1 },
            };
        };
        for candidate in turning.candidates() {
            if candidate.to_go > NEAR {
                keep(candidate.direction, candidate.to_go);
                continue;
            }
            match tried(to_go, |order| self.try_family(&candidate, order)) {
                None => return Found::Certified,
                Some(trial) if trial.is_open => keep(trial.direction, candidate.to_go.max(trial.to_go)),
                Some(_) => {}
            }
        }
        if self.is_strong() {
            match tried(to_go, |order| self.try_plain(order)) {
                None => return Found::Certified,
                Some(trial) if trial.is_open && found == Found::Dropped => {
                    return Found::Open { direction: trial.direction, to_go: trial.to_go };
                }
                Some(_) => {}
            }
        }
        found
    }

    fn is_strong(&self) -> bool {
        self.distortion() > STRONG && self.tau.reach() < 0.5
    }

    /// In the frame of a family; `None` where it proves the box.
    fn try_family(&self, candidate: &Candidate, order: Order) -> Option<Trial> {
        let mut trial = Trial::new(ENOUGH / candidate.strength, candidate.direction);
        let Some(kick) = self.turning.as_ref().and_then(|turning| turning.kick(candidate.a, order)) else {
            return Some(trial);
        };
        // All offsets at once, whatever the ratio.
        let all = Level { maps: [kick.clone(), kick], lengths: [Length(1, 0), Length(0, 0)] };
        if 2.0 * all.maps[0].error > all.moves().iter().sum() {
            // Bent rather than moved: by the base's step.
            (trial.direction, trial.is_settled) = (0, true);
        }
        if all.has_cone(&mut trial) {
            return None;
        }
        let [kick, _] = all.maps;
        let maps = |share: &Taylor, _| Some([kick.part(Cut::Last, share), kick.part(Cut::Before, share)]);
        let proven = self.down_from_first(&mut trial, maps);
        (!proven).then_some(trial)
    }

    /// In coordinates that no angle enters; `None` where that proves the box.
    fn try_plain(&self, order: Order) -> Option<Trial> {
        let is_slow = self.turning.is_some() && self.tau.slopes[1].abs() > self.tau.slopes[0].abs();
        let mut trial = Trial::new(ENOUGH_WHERE_STRONG, usize::from(is_slow));
        let Some([kick, step]) = self.plain(order) else { return Some(trial) };
        let proven = self.down_from_first(&mut trial, |share, n| {
            let before = (n <= MOST_STEPS)
                .then(|| (0..n).fold(Family::identity(order), |product, _| step.after(&product)))?;
            let after = step.after(&before);
            Some([kick.part(Cut::Last, share).after(&before), kick.part(Cut::Before, share).after(&after)])
        });
        (!proven).then_some(trial)
    }

    /// From the first level on, for all n = ⌊τ⌋ of the box: kicks that arrive at f..1, a share 1 − f of all offsets, and at 0..f.
    fn down_from_first(&self, trial: &mut Trial, maps: impl Fn(&Taylor, u32) -> Option<[Family; 2]>) -> bool {
        let (tau, reach) = (self.tau.center, self.tau.reach());
        let (low, high) = ((tau - reach) * (1.0 - 4.0 * U), (tau + reach) * (1.0 + 4.0 * U));
        if !(low > 0.0 && high < 1e6) {
            return false;
        }
        let (first, last) = (low.floor() as u32, high.floor() as u32);
        if last - first > 1 {
            return false;
        }
        let squares = self.tau.slopes.map(|x| x * x);
        trial.bending = squares.map(|x| x / (squares[0] + squares[1]));
        (first..=last).all(|n| {
            let share = Taylor::constant(f64::from(n) + 1.0, 0.0).minus(&self.tau);
            let lengths = [Length(1 + i64::from(n), -1), Length(-i64::from(n), 1)];
            maps(&share, n).is_some_and(|maps| self.descend(Level { maps, lengths }, 0, trial))
        })
    }

    /// Level by level. Where the box has ratios of both kinds, either way is to prove it: each holds for the ratios of its kind.
    fn descend(&self, mut level: Level, mut depth: usize, trial: &mut Trial) -> bool {
        loop {
            if depth > LEVELS {
                return false;
            }
            if !level.is_useful() {
                if !trial.is_settled {
                    self.look_further(level, trial);
                }
                return false;
            }
            if level.has_cone(trial) {
                return true;
            }
            if level.height() as f64 > trial.enough && !level.may_be_hyperbolic() {
                trial.is_open = false;
                return false;
            }
            depth += 1;
            let Some(difference) = level.lengths[0].minus(level.lengths[1]) else { return false };
            let (center, rounding) = difference.at(self.tau.center);
            let reach = difference.reach(&self.tau) + rounding;
            let is_one_kind = center.abs() > reach;
            if is_one_kind {
                let Some(next) = level.next(&self.tau, center > 0.0, difference) else { return false };
                level = next;
                continue;
            }
            trial.forks += 1;
            return trial.forks <= FORKS
                && [true, false].into_iter().all(|left_is_longer| {
                    let next = level.next(&self.tau, left_is_longer, difference);
                    next.is_some_and(|next| self.descend(next, depth, trial))
                });
        }
    }

    /// From a level on that bounds of the box are too wide for: whether its middle has a cone a few levels further, and so the box parts
    /// that will be proven. Where to look next rests on it, and no proof.
    fn look_further(&self, mut level: Level, trial: &mut Trial) {
        let tau = Taylor::constant(self.tau.center, 0.0);
        for steps in 1..=FURTHER {
            let Some(difference) = level.lengths[0].minus(level.lengths[1]) else { return };
            let (center, _) = difference.at(tau.center);
            level.maps.iter_mut().for_each(Family::keep_middle);
            let Some(next) = level.next(&tau, center > 0.0, difference) else { return };
            level = next;
            if level.margins().is_some_and(|margins| margins.iter().all(|margin| margin.of_middle > 0.0)) {
                (trial.to_go, trial.is_settled, trial.is_seen) =
                    (trial.to_go.min(NEAREST + steps), true, true);
                return;
            }
        }
    }
}

impl Level {
    /// One step of Euclid where the left interval is the longer one, or the right one.
    fn next(&self, tau: &Taylor, left_is_longer: bool, difference: Length) -> Option<Level> {
        let ([left, right], [a, b]) = (&self.maps, self.lengths);
        Some(if left_is_longer {
            let share = a.share(b, tau)?;
            let after = right.after(&left.part(Cut::Last, &share));
            Level { maps: [left.part(Cut::Before, &share), after], lengths: [difference, b] }
        } else {
            let share = b.share(a, tau)?;
            let after = right.part(Cut::Last, &share).after(left);
            let rest = Length(-difference.0, -difference.1);
            Level { maps: [after, right.part(Cut::Before, &share)], lengths: [a, rest] }
        })
    }

    fn is_useful(&self) -> bool {
        self.maps.iter().all(|map| map.error < MOST_ERROR && map.size() < MOST_SIZE)
    }

    /// The kicks of the shorter return.
    fn height(&self) -> u64 {
        self.lengths[0].1.unsigned_abs().min(self.lengths[1].1.unsigned_abs())
    }

    /// How far either step moves the maps in the middle of their intervals.
    fn moves(&self) -> [f64; 2] {
        [0, 1].map(|direction| {
            self.maps.iter().map(|map| map.moved_by(direction) + map.bent_by(direction)).sum()
        })
    }

    /// The margins of both maps in one cone.
    fn margins(&self) -> Option<[Margins; 2]> {
        let maps = [&self.maps[0], &self.maps[1]];
        let cone = Cone::candidate(maps)?;
        Some(maps.map(|map| cone.margins(map)))
    }

    /// Whether one cone serves both maps, for all offsets and all of the box. Where only its middle has one, the trial learns how much
    /// smaller the box has to be, and the step that moves the maps more.
    fn has_cone(&self, trial: &mut Trial) -> bool {
        let Some(margins) = self.margins() else { return false };
        if margins.iter().all(|margin| margin.of_box > 0.0) {
            return true;
        }
        if margins.iter().all(|margin| margin.of_middle > 0.0) {
            trial.is_seen = true;
            let to_go = margins.iter().map(Margins::bisections).fold(1, u32::max);
            trial.to_go = trial.to_go.min(to_go);
            if !trial.is_settled {
                let (moves, bent) = (self.moves(), self.maps[0].error + self.maps[1].error);
                let [first, second] = [0, 1].map(|i| moves[i] + bent * trial.bending[i]);
                (trial.direction, trial.is_settled) = (usize::from(second > first), true);
            }
        }
        false
    }

    /// Whether both maps may be hyperbolic somewhere in the box, in the middle of their intervals.
    fn may_be_hyperbolic(&self) -> bool {
        self.maps.iter().all(|map| map.largest_trace() > 2.0)
    }
}

impl Trial {
    fn new(enough: f64, direction: usize) -> Self {
        Trial {
            enough,
            is_open: true,
            direction,
            is_settled: false,
            bending: [1.0, 0.0],
            forks: 0,
            to_go: UNSEEN,
            is_seen: false,
        }
    }
}
