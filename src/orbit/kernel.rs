//! The kernel: half periods of L pairs side by side, four shears an update.
//!
//! In the coordinates of [`super::floquet`] with w = im/B, the state (re, w) after a kick, and t, S the shears of
//! the turn that the carry of ⌊kp/q⌋ selects, an update is
//!
//! ```text
//!     re += B (T - t) w,    w += (S/B) re,    re -= B (t + T') w,    w += re
//! ```
//!
//! 8 fused operations for both solutions and 7 shared ones. Every operation is rounded once, as IEEE 754 says,
//! the fused ones on every machine: in hardware where there is some, else in software (some 50 times slower).
//! So results are equal bit for bit, whichever of the compiled versions runs.
//!
//! At the end of each block of updates |g|² = (re + B T w)² + (B w)² is added up and compared with the sum so
//! far; the certificate of [`super::filter`] needs no more.

use super::floquet::Pair;
use crate::vector::each;

/// Above this squared norm an orbit is scaled down.
const LARGE: f64 = power_of_two(300);

/// ... at every fourth look. Between two looks |g|² grows by 2^12, or in a single step by κ² ≤ 2^82 (the certificate
/// wants κ < 2^41), so that no square overflows: 300 + 4·82 < 1000.
const SCALING: u64 = 4;

const fn power_of_two(n: i64) -> f64 {
    f64::from_bits(((n + 1023) as u64) << 52)
}

/// One solution in each lane.
#[derive(Clone, Copy, Debug)]
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
    /// ⌊angle / (π/2)⌋ in the plane (re, w), turns apart.
    pub quarters: [f64; L],
}

/// L pairs on their way.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<const L: usize> {
    pub even: Orbits<L>,
    pub odd: Orbits<L>,
    /// 2r − q, r the remainder of kp mod q: an integer in [−q, q).
    place: [f64; L],
    /// What a kick adds to it, q less that, and the same with a carry.
    step: [f64; L],
    limit: [f64; L],
    wrap: [f64; L],
    /// B T per unit of `place`.
    tilt: [f64; L],
    /// B t and S/B, without and with a carry.
    drift: [[f64; L]; 2],
    kick: [[f64; L]; 2],
    /// B and tan(θ/2).
    scale: [f64; L],
    slope: [f64; L],
    /// ⌊q/2⌋, and the share of a kick that the last one is.
    updates: [f64; L],
    last_kick: [f64; L],
    /// What `worst` must not exceed.
    pub worst: f64,
    /// Whether an orbit may grow so long that it must be scaled down on the way.
    pub strong: bool,
}

/// What a run does beside the updates.
pub trait Watch {
    /// Measure `worst`, not only whether it is within bounds.
    const MEASURE: bool;
    /// Count the even solution's quarter turns.
    const WIND: bool;
    /// Keep the sums that the certificate needs.
    const CERTIFY: bool = true;
}

impl<const L: usize> Orbits<L> {
    #[inline(always)]
    fn new(re: f64, w: [f64; L], squares: [f64; L]) -> Self {
        let quarters = each(|i| if w[i] < 0.0 { -1.0 } else { 0.0 });
        Orbits { re: [re; L], w, squares, worst: [1.0; L], exponent: [0.0; L], quarters }
    }

    /// re += a w: counterclockwise across the w axis where re and w had the same sign.
    #[inline(always)]
    fn drift<W: Watch>(&mut self, a: &[f64; L]) {
        let re: [f64; L] = each(|i| a[i].mul_add(self.w[i], self.re[i]));
        if W::WIND {
            let same = |i: usize| (self.re[i] < 0.0) == (self.w[i] < 0.0);
            let turn = |i: usize| if same(i) { 1.0 } else { -1.0 };
            let crossed = |i: usize| (re[i] < 0.0) != (self.re[i] < 0.0);
            self.quarters = each(|i| self.quarters[i] + if crossed(i) { turn(i) } else { 0.0 });
        }
        self.re = re;
    }

    /// w += a re: counterclockwise across the re axis where re and w had opposite signs.
    #[inline(always)]
    fn kick<W: Watch>(&mut self, a: &[f64; L]) {
        let w: [f64; L] = each(|i| a[i].mul_add(self.re[i], self.w[i]));
        if W::WIND {
            let same = |i: usize| (self.re[i] < 0.0) == (self.w[i] < 0.0);
            let turn = |i: usize| if same(i) { -1.0 } else { 1.0 };
            let crossed = |i: usize| (w[i] < 0.0) != (self.w[i] < 0.0);
            self.quarters = each(|i| self.quarters[i] + if crossed(i) { turn(i) } else { 0.0 });
        }
        self.w = w;
    }

    /// Adds |g|² to the sum and compares them, in the active lanes.
    #[inline(always)]
    fn look<W: Watch>(
        &mut self,
        (tilt, scale): (&[f64; L], &[f64; L]),
        (worst, strong): (f64, bool),
        active: impl Fn(usize) -> bool,
    ) {
        let norm: [f64; L] = each(|i| {
            let (re, im) = (tilt[i].mul_add(self.w[i], self.re[i]), scale[i] * self.w[i]);
            re.mul_add(re, im * im)
        });
        self.squares = each(|i| self.squares[i] + if active(i) { norm[i] } else { 0.0 });
        if W::MEASURE {
            let ratio: [f64; L] = each(|i| self.squares[i] / norm[i]);
            let within = |i: usize| ratio[i] <= self.worst[i] || !active(i);
            self.worst = each(|i| if within(i) { self.worst[i] } else { ratio[i] });
        } else {
            // NaN fails.
            let within = |i: usize| self.squares[i] <= worst * norm[i] || !active(i);
            self.worst = each(|i| if within(i) { self.worst[i] } else { f64::INFINITY });
        }
        if strong {
            // Powers of two: exact.
            let shrink = |by: f64| -> [f64; L] { each(|i| if norm[i] > LARGE { by } else { 1.0 }) };
            let (once, twice) = (shrink(power_of_two(-150)), shrink(power_of_two(-300)));
            self.re = each(|i| self.re[i] * once[i]);
            self.w = each(|i| self.w[i] * once[i]);
            self.squares = each(|i| self.squares[i] * twice[i]);
            self.exponent = each(|i| self.exponent[i] + if norm[i] > LARGE { 150.0 } else { 0.0 });
        }
    }
}

/// What the lanes start from, by kind instead of by pair: one walk over the pairs, then vectors only.
struct Constants<const L: usize> {
    kick: [f64; L],
    slope: [f64; L],
    sin: [f64; L],
    modulus: [f64; L],
    rest: [f64; L],
    /// tan(α/2) and sin α of the turns without and with a carry.
    tan: [[f64; L]; 2],
    sine: [[f64; L]; 2],
    updates: [f64; L],
    last_kick: [f64; L],
}

impl<const L: usize> Constants<L> {
    #[inline(always)]
    fn gather(pairs: &[Pair]) -> Self {
        let zero = [0.0; L];
        let (kick, slope, sin, modulus, rest, updates) = (zero, zero, zero, zero, zero, zero);
        let (tan, sine, last_kick) = ([zero; 2], [zero; 2], zero);
        let mut of = Constants { kick, slope, sin, modulus, rest, tan, sine, updates, last_kick };
        for i in 0..L {
            let pair = &pairs[i.min(pairs.len() - 1)];
            let base = pair.base;
            (of.kick[i], of.slope[i], of.sin[i]) = (pair.kick, base.slope, base.sin);
            (of.modulus[i], of.rest[i]) = (pair.modulus as f64, pair.rest as f64);
            let turns = [base.turn(pair.whole), base.turn(pair.whole + 1)];
            (of.tan[0][i], of.sine[0][i]) = (turns[0].tan, turns[0].sin);
            (of.tan[1][i], of.sine[1][i]) = (turns[1].tan, turns[1].sin);
            of.updates[i] = pair.updates as f64;
            of.last_kick[i] = if pair.q_even { 0.5 } else { 1.0 };
        }
        of
    }
}

impl<const L: usize> Lanes<L> {
    /// No pair yet.
    pub fn empty() -> Self {
        let (zero, orbits) = ([0.0; L], Orbits::new(0.0, [0.0; L], [0.0; L]));
        Lanes {
            even: orbits,
            odd: orbits,
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

    /// The pairs after the half kick at t = 0. Lane i holds `pairs[i]`, lanes to spare the last pair.
    ///
    /// Even start (1, (sin θ + B)/2), odd start (0, −1), in (re, im) and in the scales cos(θ/2) and 1/cos(θ/2),
    /// which are |g| before the half kick; products of the two solutions have the right scale.
    #[inline(always)]
    pub fn start(&mut self, pairs: &[Pair]) {
        let of = Constants::gather(pairs);
        let scale: [f64; L] = each(|i| of.kick[i] / (2.0 * of.slope[i]));
        let inverse: [f64; L] = each(|i| 1.0 / scale[i]);
        let secant2: [f64; L] = each(|i| of.slope[i].mul_add(of.slope[i], 1.0));
        let step: [f64; L] = each(|i| 2.0 * of.rest[i]);
        *self = Lanes {
            even: Orbits::new(
                1.0,
                each(|i| 0.5 * of.sin[i].mul_add(inverse[i], 1.0)),
                each(|i| 1.0 / secant2[i]),
            ),
            odd: Orbits::new(0.0, each(|i| -inverse[i]), secant2),
            place: each(|i| -of.modulus[i]),
            step,
            limit: each(|i| of.modulus[i] - step[i]),
            wrap: each(|i| step[i] - 2.0 * of.modulus[i]),
            tilt: each(|i| scale[i] * of.slope[i] / of.modulus[i]),
            drift: [each(|i| scale[i] * of.tan[0][i]), each(|i| scale[i] * of.tan[1][i])],
            kick: [each(|i| inverse[i] * of.sine[0][i]), each(|i| inverse[i] * of.sine[1][i])],
            scale,
            slope: of.slope,
            updates: of.updates,
            last_kick: of.last_kick,
            worst: f64::INFINITY,
            strong: true,
        };
    }

    /// The steepest tan(θ/2).
    #[inline(always)]
    pub fn steepest(&self) -> f64 {
        self.slope.iter().fold(0.0, |most, &slope| if slope > most { slope } else { most })
    }

    /// The largest |β| = |B| (1 + tan²(θ/2)), to within 20u.
    #[inline(always)]
    pub fn strongest(&self) -> f64 {
        // The odd start's |g|² is 1 + tan²(θ/2) still.
        let beta: [f64; L] = each(|i| self.scale[i].abs() * self.odd.squares[i]);
        beta.iter().fold(0.0, |most, &beta| if beta > most { beta } else { most })
    }

    /// The updates of all lanes, looking at |g| every `block` of them.
    #[inline(always)]
    pub fn advance<W: Watch>(&mut self, block: u64) {
        let (shortest, longest) = self.updates.iter().fold((f64::INFINITY, 0.0), min_max);
        let mut lanes = *self;
        let mut tilt: [f64; L] = each(|i| lanes.place[i] * lanes.tilt[i]);
        // The last update, perhaps half a kick, is left to the loop that tells the lanes apart.
        let together = (shortest as u64).saturating_sub(1);
        // The half kick at t = 0 was the first block's first step.
        let (mut done, mut due, mut looks) = (0, block - 1, 0);
        while due <= together {
            lanes.block::<W>(&mut tilt, due - done);
            lanes.look::<W>(&tilt, looks % SCALING == 0, |_| true);
            (done, due, looks) = (due, due + block, looks + 1);
        }
        lanes.block::<W>(&mut tilt, together - done);
        if shortest == 0.0 {
            lanes.look::<W>(&tilt, true, |_| true);
        }
        for k in together + 1..=longest as u64 {
            lanes.last_updates::<W>(k as f64, &mut tilt);
        }
        *self = lanes;
    }

    /// `count` whole updates in every lane.
    #[inline(always)]
    fn block<W: Watch>(&mut self, tilt: &mut [f64; L], count: u64) {
        let (mut lanes, mut now) = (*self, *tilt);
        for _ in 0..count {
            lanes.travel::<W>(&mut now);
            lanes.strike::<W>(&[1.0; L]);
        }
        (self.even, self.odd, self.place, *tilt) = (lanes.even, lanes.odd, lanes.place, now);
    }

    /// The k-th update in the lanes that have one.
    #[inline(always)]
    fn last_updates<W: Watch>(&mut self, k: f64, tilt: &mut [f64; L]) {
        let (before, updates) = (*self, self.updates);
        self.travel::<W>(tilt);
        self.strike::<W>(&each(|i| if k == updates[i] { self.last_kick[i] } else { 1.0 }));
        let active = |i: usize| k <= updates[i];
        let keep =
            |new: &mut [f64; L], old: &[f64; L]| *new = each(|i| if active(i) { new[i] } else { old[i] });
        keep(&mut self.place, &before.place);
        keep(&mut self.even.re, &before.even.re);
        keep(&mut self.even.w, &before.even.w);
        keep(&mut self.even.quarters, &before.even.quarters);
        keep(&mut self.odd.re, &before.odd.re);
        keep(&mut self.odd.w, &before.odd.w);
        *tilt = each(|i| self.place[i] * self.tilt[i]);
        self.look::<W>(tilt, true, active);
    }

    /// From a kick to just before the next one.
    #[inline(always)]
    fn travel<W: Watch>(&mut self, tilt: &mut [f64; L]) {
        let (place, limit) = (self.place, self.limit);
        let select = |without: &[f64; L], with: &[f64; L]| -> [f64; L] {
            each(|i| if place[i] >= limit[i] { with[i] } else { without[i] })
        };
        let drift = select(&self.drift[0], &self.drift[1]);
        let kick = select(&self.kick[0], &self.kick[1]);
        let step = select(&self.step, &self.wrap);
        let first: [f64; L] = each(|i| tilt[i] - drift[i]);
        self.place = each(|i| place[i] + step[i]);
        *tilt = each(|i| self.place[i] * self.tilt[i]);
        let second: [f64; L] = each(|i| -(tilt[i] + drift[i]));
        self.even.drift::<W>(&first);
        self.odd.drift::<W>(&first);
        self.even.kick::<W>(&kick);
        self.odd.kick::<W>(&kick);
        self.even.drift::<W>(&second);
        self.odd.drift::<W>(&second);
    }

    #[inline(always)]
    fn strike<W: Watch>(&mut self, share: &[f64; L]) {
        self.even.kick::<W>(share);
        self.odd.kick::<W>(share);
    }

    #[inline(always)]
    fn look<W: Watch>(&mut self, tilt: &[f64; L], scaling: bool, active: impl Fn(usize) -> bool + Copy) {
        if W::CERTIFY {
            let strong = self.strong && scaling;
            self.even.look::<W>((tilt, &self.scale), (self.worst, strong), active);
            self.odd.look::<W>((tilt, &self.scale), (self.worst, strong), active);
        }
    }

    /// ⌊angle/(π/2)⌋ of the even solution after its last update in (re, im), in lane i.
    pub fn even_quarter(&self, i: usize) -> i64 {
        let counted = self.even.quarters[i] as i64;
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

fn min_max((least, most): (f64, f64), &x: &f64) -> (f64, f64) {
    (least.min(x), most.max(x))
}
