//! The kernel: half periods of L pairs side by side, four shears an update.
//!
//! In the coordinates of [`super::floquet`] with w = im/B, the state (re, w) after a kick, and t, S the
//! shears of the turn that the carry of ⌊kp/q⌋ selects, an update is
//!
//! ```text
//!     re += B (T - t) w,    w += (S/B) re,    re -= B (t + T') w,    w += re
//! ```
//!
//! 8 operations for both solutions, all but the last two fused, and 7 shared ones: a comparison, three
//! choices, a sum, and two fused operations. Every operation is rounded once, as IEEE 754 says, the fused
//! ones on every machine: in hardware where there is some, else in software (some 50 times slower). So
//! results are equal bit for bit, whatever the vectors.
//!
//! At the end of each block of updates |g|² = (re + B T w)² + (B w)² is added up and compared with the sum so
//! far; the certificate of [`super::filter`] needs no more.

use std::marker::PhantomData;

use super::lanes::{Lanes, Orbits};
use number::vector::Vector;
use number::vector::instructions::{Instructions, Kernel};

/// Above this squared norm an orbit is scaled down.
const LARGE: f64 = power_of_two(300);

/// An orbit is scaled down at every fourth look at most. Between two looks |g|² grows by 2^12, or in a single
/// step by κ² ≤ 2^82 (the certificate wants κ < 2^41), so that no square overflows: 300 + 4·82 < 1000.
const SCALING: u64 = 4;

const fn power_of_two(n: i64) -> f64 {
    f64::from_bits(((n + 1023) as u64) << 52)
}

/// The work of a run beside the updates.
pub trait Watch {
    /// Measure `worst`, not only whether it is within bounds.
    const MEASURE: bool;
    /// Count the even solution's half turns.
    const WIND: bool;
    /// Keep the sums that the certificate needs.
    const CERTIFY: bool = true;
}

/// The data that an update reads.
#[derive(Clone, Copy)]
struct Course<V> {
    limit: V,
    tilt: V,
    /// With a carry and without, in the form that is chosen from.
    step: [V; 2],
    drift: [V; 2],
    kick: [V; 2],
}

/// The data that an update changes.
#[derive(Clone, Copy)]
struct State<V> {
    place: V,
    /// Of the even and of the odd solution.
    re: [V; 2],
    w: [V; 2],
    crossings: [V; 4],
}

impl<V: Vector> Course<V> {
    #[inline(always)]
    fn load<const L: usize>(lanes: &Lanes<L>, at: usize) -> Self {
        let ([drift, carried_drift], [kick, carried_kick]) = (&lanes.drift, &lanes.kick);
        Course {
            limit: V::load(&lanes.limit[at..]),
            tilt: V::load(&lanes.tilt[at..]),
            step: V::alternatives(V::load(&lanes.wrap[at..]), V::load(&lanes.step[at..])),
            drift: V::alternatives(V::load(&carried_drift[at..]), V::load(&drift[at..])),
            kick: V::alternatives(V::load(&carried_kick[at..]), V::load(&kick[at..])),
        }
    }
}

impl<V: Vector> State<V> {
    #[inline(always)]
    fn load<W: Watch, const L: usize>(lanes: &Lanes<L>, at: usize) -> Self {
        let (even, odd) = (&lanes.even, &lanes.odd);
        let mut state = State {
            place: V::load(&lanes.place[at..]),
            re: [V::load(&even.re[at..]), V::load(&odd.re[at..])],
            w: [V::load(&even.w[at..]), V::load(&odd.w[at..])],
            crossings: [V::splat(0.0); 4],
        };
        if W::WIND {
            for (to, from) in state.crossings.iter_mut().zip(&lanes.crossings) {
                *to = V::load(&from[at..]);
            }
        }
        state
    }

    #[inline(always)]
    fn store<W: Watch, const L: usize>(self, lanes: &mut Lanes<L>, at: usize) {
        self.place.store(&mut lanes.place[at..]);
        self.re[0].store(&mut lanes.even.re[at..]);
        self.re[1].store(&mut lanes.odd.re[at..]);
        self.w[0].store(&mut lanes.even.w[at..]);
        self.w[1].store(&mut lanes.odd.w[at..]);
        if W::WIND {
            for (to, count) in lanes.crossings.iter_mut().zip(self.crossings) {
                count.store(&mut to[at..]);
            }
        }
    }

    /// From a kick to just before the next one.
    #[inline(always)]
    fn travel<W: Watch>(&mut self, course: &Course<V>) {
        let carry = self.place.exceeds(course.limit);
        let drift = V::choose(carry, course.drift);
        let kick = V::choose(carry, course.kick);
        let first = self.place.mul_sub(course.tilt, drift);
        self.place = self.place.add(V::choose(carry, course.step));
        let second = self.place.mul_add(course.tilt, drift);
        let before = self.re[0];
        for (re, w) in self.re.iter_mut().zip(self.w) {
            *re = first.mul_add(w, *re);
        }
        if W::WIND {
            self.count(0, before, first);
        }
        for (w, re) in self.w.iter_mut().zip(self.re) {
            *w = kick.mul_add(re, *w);
        }
        let before = self.re[0];
        for (re, w) in self.re.iter_mut().zip(self.w) {
            *re = second.neg_mul_add(w, *re);
        }
        if W::WIND {
            self.count(2, before, second);
        }
    }

    /// The state before in the lanes of the mask.
    #[inline(always)]
    fn unless(self, mask: V::Mask, before: Self) -> Self {
        let two = |old: [V; 2], new: [V; 2]| [kept(mask, old[0], new[0]), kept(mask, old[1], new[1])];
        State {
            place: kept(mask, before.place, self.place),
            re: two(before.re, self.re),
            w: two(before.w, self.w),
            crossings: std::array::from_fn(|n| kept(mask, before.crossings[n], self.crossings[n])),
        }
    }

    /// Counts where the even solution's re has changed its sign, and where the coefficient is negative too.
    #[inline(always)]
    fn count(&mut self, shear: usize, before: V, coefficient: V) {
        let [all, negative] = [self.crossings[shear], self.crossings[shear + 1]];
        self.crossings[shear] = all.count_change(before, self.re[0]);
        self.crossings[shear + 1] = negative.count_change_below(before, self.re[0], coefficient);
    }

    /// A whole kick.
    #[inline(always)]
    fn strike(&mut self) {
        for (w, re) in self.w.iter_mut().zip(self.re) {
            *w = w.add(re);
        }
    }

    /// Part of a kick.
    #[inline(always)]
    fn strike_by(&mut self, share: V) {
        for (w, re) in self.w.iter_mut().zip(self.re) {
            *w = share.mul_add(re, *w);
        }
    }

    /// Adds |g|² to the sums and compares them.
    #[inline(always)]
    fn look<W: Watch, const L: usize>(&self, lanes: &mut Lanes<L>, at: usize) {
        let norms = self.norms(lanes, at);
        let worst = V::splat(lanes.worst);
        for (norm, orbits) in norms.into_iter().zip([&mut lanes.even, &mut lanes.odd]) {
            let squares = V::load(&orbits.squares[at..]).add(norm);
            let so_far = V::load(&orbits.worst[at..]);
            let now = if W::MEASURE {
                // NaN stays.
                let ratio = squares.div(norm);
                V::choose(so_far.exceeds(ratio), V::alternatives(so_far, ratio))
            } else {
                // NaN fails.
                let within = worst.mul(norm).exceeds(squares);
                V::choose(within, V::alternatives(so_far, V::splat(f64::INFINITY)))
            };
            now.store(&mut orbits.worst[at..]);
            squares.store(&mut orbits.squares[at..]);
        }
    }

    /// |g|² of both solutions.
    #[inline(always)]
    fn norms<const L: usize>(&self, lanes: &Lanes<L>, at: usize) -> [V; 2] {
        let (tilt, scale) = (self.place.mul(V::load(&lanes.tilt[at..])), V::load(&lanes.scale[at..]));
        let norm = |re: V, w: V| {
            let (re, im) = (tilt.mul_add(w, re), scale.mul(w));
            re.mul_add(re, im.mul(im))
        };
        [norm(self.re[0], self.w[0]), norm(self.re[1], self.w[1])]
    }

    /// Scales down what is large, by powers of two: exactly.
    #[inline(always)]
    fn scale_down<const L: usize>(&mut self, lanes: &mut Lanes<L>, at: usize) {
        let norms = self.norms(lanes, at);
        for (n, orbits) in [&mut lanes.even, &mut lanes.odd].into_iter().enumerate() {
            let large = norms[n].exceeds(V::splat(LARGE));
            let once = either::<V>(large, power_of_two(-150), 1.0);
            (self.re[n], self.w[n]) = (self.re[n].mul(once), self.w[n].mul(once));
            let squares = V::load(&orbits.squares[at..]);
            squares.mul(either(large, power_of_two(-300), 1.0)).store(&mut orbits.squares[at..]);
            let exponent = V::load(&orbits.exponent[at..]).add(either(large, 150.0, 0.0));
            exponent.store(&mut orbits.exponent[at..]);
        }
    }
}

/// `old` where the mask says yes, else `new`.
#[inline(always)]
fn kept<V: Vector>(mask: V::Mask, old: V, new: V) -> V {
    V::choose(mask, V::alternatives(old, new))
}

#[inline(always)]
fn either<V: Vector>(mask: V::Mask, yes: f64, no: f64) -> V {
    V::choose(mask, V::alternatives(V::splat(yes), V::splat(no)))
}

/// The updates that all lanes have, with looks in between and at the end.
struct Together<'a, W, const L: usize> {
    lanes: &'a mut Lanes<L>,
    updates: u64,
    block: u64,
    watch: PhantomData<W>,
}

impl<W: Watch, const L: usize> Kernel for Together<'_, W, L> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(mut self) {
        if L == V::WIDTH {
            return self.strands::<V, 1>(0);
        }
        // Two vectors on their way hide most of each other's latency, and leave registers for what they need;
        // where there are twice as many registers, four.
        if V::WIDTH == 8 && L.is_multiple_of(4 * V::WIDTH) {
            for at in (0..L).step_by(4 * V::WIDTH) {
                self.strands::<V, 4>(at);
            }
            return;
        }
        for at in (0..L).step_by(2 * V::WIDTH) {
            self.strands::<V, 2>(at);
        }
    }
}

impl<W: Watch, const L: usize> Together<'_, W, L> {
    /// N vectors of lanes, from lane `at` on.
    #[inline(always)]
    fn strands<V: Vector, const N: usize>(&mut self, at: usize) {
        let mut courses = [Course::<V>::load(self.lanes, at); N];
        let mut states = [State::<V>::load::<W, L>(self.lanes, at); N];
        for n in 1..N {
            courses[n] = Course::load(self.lanes, at + n * V::WIDTH);
            states[n] = State::load::<W, L>(self.lanes, at + n * V::WIDTH);
        }
        // The half kick at t = 0 was the first block's first step; the last update is perhaps half a kick.
        let (last, mut done, mut due, mut looks) = (self.updates.saturating_sub(1), 0, self.block - 1, 0);
        while due <= last {
            states = blocks::<V, W, N>(states, &courses, due - done);
            self.look(&mut states, at, looks % SCALING == 0);
            (done, due, looks) = (due, due + self.block, looks + 1);
        }
        states = blocks::<V, W, N>(states, &courses, last - done);
        for n in 0..N {
            if self.updates > 0 {
                states[n].travel::<W>(&courses[n]);
                states[n].strike_by(self.lanes.share(self.updates, at + n * V::WIDTH));
            }
        }
        self.look(&mut states, at, true);
        for (n, state) in states.iter().enumerate() {
            state.store::<W, L>(self.lanes, at + n * V::WIDTH);
        }
    }

    #[inline(always)]
    fn look<V: Vector, const N: usize>(&mut self, states: &mut [State<V>; N], at: usize, scaling: bool) {
        if W::CERTIFY {
            for (n, state) in states.iter().enumerate() {
                state.look::<W, L>(self.lanes, at + n * V::WIDTH);
            }
            if self.lanes.strong && scaling {
                for (n, state) in states.iter_mut().enumerate() {
                    state.scale_down(self.lanes, at + n * V::WIDTH);
                }
            }
        }
    }
}

/// So many whole updates.
///
/// Where registers do not hold what four courses need, it is read from memory, at its own place: the compiler
/// would copy it first, for each block anew, and not to whole cache lines.
#[inline(always)]
fn blocks<V: Vector, W: Watch, const N: usize>(
    mut states: [State<V>; N],
    courses: &[Course<V>; N],
    count: u64,
) -> [State<V>; N] {
    for _ in 0..count {
        let courses = if N > 2 { std::hint::black_box(courses) } else { courses };
        for n in 0..N {
            states[n].travel::<W>(&courses[n]);
            states[n].strike();
        }
    }
    states
}

/// The updates that come after, each in the lanes that have it.
struct Apart<'a, W, const L: usize> {
    lanes: &'a mut Lanes<L>,
    updates: u64,
    longest: u64,
    watch: PhantomData<W>,
}

impl<W: Watch, const L: usize> Kernel for Apart<'_, W, L> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        for k in self.updates + 1..=self.longest {
            for at in (0..L).step_by(V::WIDTH) {
                // Those of fewer updates come first, and are soon done.
                if V::load(&self.lanes.updates[at..]).any_above(V::splat((k - 1) as f64)) {
                    self.lanes.update_some::<V, W>(k, at);
                }
            }
        }
    }
}

impl<const L: usize> Lanes<L> {
    /// The updates of all lanes, looking at |g| every `block` of them.
    pub fn advance<W: Watch>(&mut self, instructions: Instructions, block: u64) {
        let (shortest, longest) = self.updates.iter().fold((f64::INFINITY, 0.0), min_max);
        let (updates, longest) = (shortest as u64, longest as u64);
        let together = Together { lanes: &mut *self, updates, block, watch: PhantomData::<W> };
        if L == 1 {
            instructions.compute_alone(together)
        } else {
            instructions.compute_by_register(together)
        }
        if L > 1 && longest > updates {
            instructions.compute_by_register(Apart {
                lanes: self,
                updates,
                longest,
                watch: PhantomData::<W>,
            });
        }
    }

    /// The shares of a whole kick that the k-th ones are, in lanes that have as many.
    #[inline(always)]
    fn share<V: Vector>(&self, k: u64, at: usize) -> V {
        let last = V::load(&self.last_kick[at..]);
        V::load(&self.updates[at..]).if_above(V::splat(k as f64), V::splat(1.0), last)
    }

    /// The k-th update in those lanes of the vector at `at` that have one.
    #[inline(always)]
    fn update_some<V: Vector, W: Watch>(&mut self, k: u64, at: usize) {
        let over = V::splat(k as f64).exceeds(V::load(&self.updates[at..]));
        let (sums, before) = (self.sums::<V>(at), State::<V>::load::<W, L>(self, at));
        let mut state = before;
        state.travel::<W>(&Course::load(self, at));
        state.strike_by(self.share(k, at));
        if W::CERTIFY {
            state.look::<W, L>(self, at);
            if self.strong {
                state.scale_down(self, at);
            }
            let now = self.sums::<V>(at);
            self.keep(at, std::array::from_fn(|n| kept(over, sums[n], now[n])));
        }
        state.unless(over, before).store::<W, L>(self, at);
    }

    /// The sums that a look changes, of both solutions, in the lanes from `at` on.
    #[inline(always)]
    fn sums<V: Vector>(&self, at: usize) -> [V; 6] {
        let of = |orbits: &Orbits<L>| {
            [&orbits.squares, &orbits.worst, &orbits.exponent].map(|x| V::load(&x[at..]))
        };
        let ([a, b, c], [d, e, f]) = (of(&self.even), of(&self.odd));
        [a, b, c, d, e, f]
    }

    #[inline(always)]
    fn keep<V: Vector>(&mut self, at: usize, sums: [V; 6]) {
        let (even, odd) = (&mut self.even, &mut self.odd);
        let places = [
            &mut even.squares,
            &mut even.worst,
            &mut even.exponent,
            &mut odd.squares,
            &mut odd.worst,
            &mut odd.exponent,
        ];
        places.into_iter().zip(sums).for_each(|(place, sum)| sum.store(&mut place[at..]));
    }
}

fn min_max((least, most): (f64, f64), &x: &f64) -> (f64, f64) {
    (least.min(x), most.max(x))
}
