//! Pairs in lanes: what the kernel of [`super::kernel`] reads and changes, where it begins and what it ends
//! at.

use super::certificate::Hardest;
use super::floquet::Pair;
use number::vector::{double_of, each, largest, sum};

/// One solution in each lane.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Orbits<const L: usize> {
    pub re: [f64; L],
    pub w: [f64; L],
    /// Σ |g|² over the block ends, from the start on, in the scale of the latest rescaling.
    pub squares: [f64; L],
    /// The largest `squares/|g|²` at a block's end; infinite, without being measured, where it exceeded
    /// [`Lanes::worst`].
    pub worst: [f64; L],
    /// The true orbit is 2^exponent times this one.
    pub exponent: [f64; L],
}

/// L pairs on their way.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Lanes<const L: usize> {
    pub even: Orbits<L>,
    pub odd: Orbits<L>,
    /// 2r − q, r the remainder of kp mod q: an integer in [−q, q).
    pub(super) place: [f64; L],
    /// The increment of a kick, the largest place without a carry, and the increment of a kick with a carry.
    pub(super) step: [f64; L],
    pub(super) limit: [f64; L],
    pub(super) wrap: [f64; L],
    /// B T per unit of `place`.
    pub(super) tilt: [f64; L],
    /// B t and S/B, without and with a carry.
    pub(super) drift: [[f64; L]; 2],
    pub(super) kick: [[f64; L]; 2],
    /// B and tan(θ/2).
    pub(super) scale: [f64; L],
    pub(super) slope: [f64; L],
    /// ⌊q/2⌋, and the share of a kick that the last one is.
    pub(super) updates: [f64; L],
    pub(super) last_kick: [f64; L],
    /// Integers in the bits of doubles: by the first and by the second shear of re, how often the even
    /// solution crossed the w axis, and how often of these the first shear's coefficient and that of −w in
    /// the second one was negative.
    pub(super) crossings: [[f64; L]; 4],
    /// The limit of `worst`.
    pub worst: f64,
    /// Whether an orbit may grow so long that it must be scaled down on the way.
    pub strong: bool,
}

/// Pairs that can be put into lanes.
pub trait InLanes: Sized {
    /// The start of the kernel, lanes to spare holding the last pair, and the cosine and sine of the base's
    /// last turn.
    fn constants<const L: usize>(pairs: &[Self]) -> (Constants<L>, [[f64; L]; 2]);
}

/// The start of the lanes, by kind instead of by pair: one walk over the pairs, then vectors only.
pub struct Constants<const L: usize> {
    pub kick: [f64; L],
    pub slope: [f64; L],
    pub sin: [f64; L],
    pub modulus: [f64; L],
    pub rest: [f64; L],
    /// tan(α/2) and sin α of the turns without and with a carry.
    pub tan: [[f64; L]; 2],
    pub sine: [[f64; L]; 2],
    pub updates: [f64; L],
    pub last_kick: [f64; L],
}

impl InLanes for Pair<'_> {
    #[inline(always)]
    fn constants<const L: usize>(pairs: &[Self]) -> (Constants<L>, [[f64; L]; 2]) {
        let zero = [0.0; L];
        let (kick, slope, sin, modulus, rest, updates) = (zero, zero, zero, zero, zero, zero);
        let (tan, sine, last_kick) = ([zero; 2], [zero; 2], zero);
        let mut constants = Constants { kick, slope, sin, modulus, rest, tan, sine, updates, last_kick };
        let mut left = [zero; 2];
        for i in 0..L {
            let pair = &pairs[i.min(pairs.len() - 1)];
            let base = pair.base;
            (constants.kick[i], constants.slope[i], constants.sin[i]) = (pair.kick, base.slope, base.sin);
            (constants.modulus[i], constants.rest[i]) = (double_of(pair.modulus), double_of(pair.rest));
            let turns = [base.turn(pair.whole), base.turn(pair.whole + 1)];
            (constants.tan[0][i], constants.sine[0][i]) = (turns[0].tan, turns[0].sin);
            (constants.tan[1][i], constants.sine[1][i]) = (turns[1].tan, turns[1].sin);
            constants.updates[i] = double_of(pair.updates);
            constants.last_kick[i] = if pair.q_even { 0.5 } else { 1.0 };
            [left[0][i], left[1][i]] = pair.left().map_or([1.0, 0.0], |n| base.turn(n).half);
        }
        (constants, left)
    }
}

impl<const L: usize> Orbits<L> {
    #[inline(always)]
    fn new(re: f64, w: [f64; L], squares: [f64; L]) -> Self {
        Orbits { re: [re; L], w, squares, worst: [1.0; L], exponent: [0.0; L] }
    }
}

impl<const L: usize> Lanes<L> {
    /// No pair yet.
    pub fn empty() -> Self {
        let (zero, orbits) = ([0.0; L], Orbits::new(0.0, [0.0; L], [0.0; L]));
        Lanes {
            even: orbits,
            odd: orbits,
            crossings: [zero; 4],
            place: zero,
            step: zero,
            limit: zero,
            wrap: zero,
            tilt: zero,
            drift: [zero; 2],
            kick: [zero; 2],
            scale: zero,
            slope: zero,
            updates: zero,
            last_kick: zero,
            worst: 0.0,
            strong: false,
        }
    }

    /// After the half kick at t = 0.
    ///
    /// Even start (1, (sin θ + B)/2), odd start (0, −1), in (re, im) and in the scales cos(θ/2) and
    /// 1/cos(θ/2), which are |g| before the half kick; products of the two solutions have the right scale.
    #[inline(always)]
    pub fn start(&mut self, constants: Constants<L>) {
        let scale: [f64; L] = each(|i| constants.kick[i] / (2.0 * constants.slope[i]));
        let inverse: [f64; L] = each(|i| 1.0 / scale[i]);
        let secant2: [f64; L] = each(|i| constants.slope[i].mul_add(constants.slope[i], 1.0));
        let step: [f64; L] = each(|i| 2.0 * constants.rest[i]);
        *self = Lanes {
            even: Orbits::new(
                1.0,
                each(|i| 0.5 * constants.sin[i].mul_add(inverse[i], 1.0)),
                each(|i| 1.0 / secant2[i]),
            ),
            odd: Orbits::new(0.0, each(|i| -inverse[i]), secant2),
            place: each(|i| -constants.modulus[i]),
            step,
            // Places go by twos from -q on: the largest without a carry is q - step - 2.
            limit: each(|i| constants.modulus[i] - step[i] - 1.0),
            wrap: each(|i| step[i] - 2.0 * constants.modulus[i]),
            tilt: each(|i| scale[i] * constants.slope[i] / constants.modulus[i]),
            drift: [each(|i| scale[i] * constants.tan[0][i]), each(|i| scale[i] * constants.tan[1][i])],
            kick: [each(|i| inverse[i] * constants.sine[0][i]), each(|i| inverse[i] * constants.sine[1][i])],
            scale,
            slope: constants.slope,
            updates: constants.updates,
            last_kick: constants.last_kick,
            crossings: [[0.0; L]; 4],
            worst: f64::INFINITY,
            strong: true,
        };
    }

    /// The largest |β| = |B| (1 + tan²(θ/2)), to within 20u, the steepest tan(θ/2) and the most updates.
    #[inline(always)]
    pub fn hardest(&self) -> Hardest {
        // The odd start's |g|² is 1 + tan²(θ/2) still.
        let beta = each(|i| self.scale[i].abs() * self.odd.squares[i]);
        let steps = largest(&self.updates) as u64 + 1;
        Hardest { beta: largest::<L>(&beta), slope: largest(&self.slope), steps }
    }

    /// The kicks that the first so many lanes will have composed; the others hold the pair of the last one.
    #[inline(always)]
    pub fn kicks(&self, pairs: usize) -> u64 {
        let spare = (L - pairs) as f64 * self.updates[L - 1];
        (sum(&self.updates) - spare) as u64 + pairs as u64
    }

    /// ⌊angle/(π/2)⌋ of the even solution after its last update in (re, im), in lane i.
    pub fn even_quarter(&self, i: usize) -> i64 {
        let [first, first_negative, second, second_negative] =
            self.crossings.map(|count| count[i].to_bits() as i64);
        // re += a w crosses the w axis counterclockwise iff a < 0; the second shear's a is the negative one.
        let half_turns = 2 * (first_negative - second_negative) - first + second;
        let same = self.even.re[i].is_sign_negative() == self.even.w[i].is_sign_negative();
        let counted = 2 * half_turns - 1 + i64::from(same);
        // For B < 0 the plane (re, w) is the mirror image.
        if self.scale[i] < 0.0 { -1 - counted } else { counted }
    }

    /// The states at T/2 before the base's last turn: (re, im) of the even and of the odd solution.
    #[inline(always)]
    pub fn ends(&self) -> [[[f64; L]; 2]; 2] {
        let tilt: [f64; L] = each(|i| self.place[i] * self.tilt[i]);
        let end =
            |o: &Orbits<L>| [each(|i| tilt[i].mul_add(o.w[i], o.re[i])), each(|i| self.scale[i] * o.w[i])];
        [end(&self.even), end(&self.odd)]
    }
}
