//! Euclid's algorithm on a range of ratios: both return maps of each level, until a common cone proves all of
//! it unstable.

use super::cone::Cone;
use super::family::{Cut, Family};
use super::frame::Frame;
use super::taylor::Taylor;
use crate::orbit::returns::UP;
use number::U;

/// The most levels of one path.
const LEVELS: usize = 60;

/// A map whose bound or whose norm is larger proves nothing any more.
const MOST_ERROR: f64 = 0.5;
const MOST_SIZE: f64 = 1e6;

/// The most steps of the base between two kicks in coordinates that no angle enters.
const MOST_STEPS: i64 = 64;

/// A closed range of ratios p/q.
pub type Range = [(i64, i64); 2];

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

    /// Its sign at p/q, exactly.
    fn sign(self, (p, q): (i64, i64)) -> i128 {
        (i128::from(self.0) * i128::from(q) + i128::from(self.1) * i128::from(p)).signum()
    }

    /// How far it is from there at most.
    fn reach(self, tau: &Taylor) -> f64 {
        (self.1 as f64).abs() * tau.reach() * UP
    }

    /// r = short/long, of this length and a shorter one. Their determinant D is ±1, so r(τ) − r(τ₀) = D (τ −
    /// τ₀)/(long(τ) long(τ₀)).
    fn share(self, short: Length, tau: &Taylor) -> Option<Taylor> {
        let [(length, long_off), (rest, rest_off)] = [self, short].map(|length| length.at(tau.center));
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
            slope: tau.slope * by,
            square: tau.square * by + bend * tau.slope * tau.slope,
            error: (third + curved + rounding) * (1.0 + 1e-9),
        })
    }
}

/// Both return maps, on 0..a and on a..a + b.
struct Level {
    maps: [Family; 2],
    lengths: [Length; 2],
}

impl Frame {
    /// Whether a common cone of one level proves every ratio other/base of the range unstable: in the frame
    /// of family a, or, where none is given, in coordinates that no angle enters. So many times the path may
    /// fork, where ratios of both kinds are left.
    pub fn proves(&self, family: Option<i64>, range: Range, forks: usize) -> bool {
        self.try_levels(family, range, forks).is_some()
    }

    /// `None` where nothing is proven.
    fn try_levels(&self, family: Option<i64>, range: Range, forks: usize) -> Option<()> {
        let kick = match family {
            Some(a) => {
                let kick = self.kick(a)?;
                // All offsets at once, whatever the ratio.
                let all = [kick.clone(), kick];
                if has_cone(&all) {
                    return Some(());
                }
                let [kick, _] = all;
                (kick, None)
            }
            None => {
                let [kick, step] = self.plain()?;
                (kick, Some(step))
            }
        };
        // n = ⌊τ⌋ of all ratios but the last.
        let [(p, q), (p_last, q_last)] = range;
        let (first, last) = (p.div_euclid(q), (p_last - 1).div_euclid(q_last));
        let forks = forks.checked_sub(usize::try_from(last - first).ok()?)?;
        for n in first..=last {
            let from = if n > first { (n, 1) } else { range[0] };
            let to = if n < last { (n + 1, 1) } else { range[1] };
            let level = Level { maps: self.first(&kick, n)?, lengths: [Length(1 + n, -1), Length(-n, 1)] };
            self.descend(level, [from, to], 0, forks)?;
        }
        Some(())
    }

    /// Kicks that arrive at f..1, a share 1 − f of all offsets, and at 0..f, n or n + 1 steps after the one
    /// before.
    fn first(&self, (kick, step): &(Family, Option<Family>), n: i64) -> Option<[Family; 2]> {
        let share = Taylor::constant(n as f64 + 1.0, 0.0).minus(&self.tau);
        let [last, before] = [Cut::Last, Cut::Before].map(|cut| kick.part(cut, &share));
        let Some(step) = step else { return Some([last, before]) };
        let steps =
            (n <= MOST_STEPS).then(|| (0..n).fold(Family::identity(), |product, _| step.after(&product)))?;
        Some([last.after(&steps), before.after(&step.after(&steps))])
    }

    /// Level by level. Where there are ratios of both kinds, either way is to prove those of its kind.
    fn descend(&self, mut level: Level, range: Range, mut depth: usize, forks: usize) -> Option<()> {
        loop {
            if depth > LEVELS || !level.is_useful() {
                return None;
            }
            if has_cone(&level.maps) {
                return Some(());
            }
            depth += 1;
            let difference = level.lengths[0].minus(level.lengths[1])?;
            let signs = range.map(|ratio| difference.sign(ratio));
            if signs[0] * signs[1] >= 0 {
                level = level.next(&self.tau, signs[0] + signs[1] > 0, difference)?;
                continue;
            }
            // Where the lengths are equal.
            let Length(a, b) = difference;
            let middle = if b < 0 { (a, -b) } else { (-a, b) };
            let forks = forks.checked_sub(1)?;
            for (side, range) in [[range[0], middle], [middle, range[1]]].into_iter().enumerate() {
                let next = level.next(&self.tau, signs[side] > 0, difference)?;
                self.descend(next, range, depth, forks)?;
            }
            return Some(());
        }
    }
}

/// Whether one cone serves both maps, for all offsets and all ratios.
fn has_cone(maps: &[Family; 2]) -> bool {
    Cone::candidate([&maps[0], &maps[1]]).is_some_and(|cone| maps.iter().all(|map| cone.serves(map)))
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
}
