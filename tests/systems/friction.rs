//! Friction: O-steps in the middle of every drift.

use kickdrift::number::parse::parse;
use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::number::{Laurent, Rational, Real};
use kickdrift::schedule::{KickDrift, Kicks};
use kickdrift::system::friction::{Damping, Friction, Mask, Masked, damped_oscillator, damped_system};
use kickdrift::system::{Holds, Limits, ManyClocks, Potential, Symmetric, System, builders, decide_system};
use nalgebra::Matrix2;

/// At a rate in units of 1/h_1.
fn damped<S: Real>(clocks: &ManyClocks<S>, rate: &Rational) -> Friction {
    damped_oscillator(clocks, &Laurent::from_integer(1), rate).unwrap()
}

/// The frictions that mask what grows.
fn masked<S: Real>(clocks: &ManyClocks<S>) -> Masked {
    match damped(clocks, &ratio(1, 1)).masking {
        Mask::At(own) => own,
        other => panic!("{other:?}"),
    }
}

fn exact(x: f64) -> Rational {
    Rational::from_float(x).unwrap()
}

fn two_clocks(ratio_of_steps: Rational, fast: Rational, slow: Rational) -> ManyClocks<Rational> {
    ManyClocks::new(&[ratio(1, 1), ratio_of_steps], &[ratio(0, 1), ratio(0, 1)], vec![fast, slow]).unwrap()
}

/// Two periods, 10 and 40 fs, outer step 4.8 fs at 10:1; the unit of time is h_1 = 0.48 fs.
fn ten_and_forty() -> ManyClocks<Laurent> {
    let strength = |text: &str| parse("strength", text).unwrap();
    let steps = [ratio(1, 1), ratio(10, 1)];
    // h_1² (2π/10)², h_1 h_2 (2π/40)².
    let strengths = vec![strength("4*pi^2*144/62500"), strength("40*pi^2*144/1000000")];
    ManyClocks::new(&steps, &[ratio(0, 1), ratio(0, 1)], strengths).unwrap()
}

#[test]
fn the_resonance_of_periods_ten_and_forty_is_masked_between_38_and_39_per_picosecond() {
    let clocks = ten_and_forty();
    let mask = masked(&clocks);
    let per_picosecond = mask.least() / 0.48e-3;
    assert!(38.0 < per_picosecond && per_picosecond < 39.0, "{per_picosecond}");
    // Bisected to 10^-4.
    assert!(mask.stays() && mask.least() < 1.0002 * mask.grows, "{mask:?}");
    // The growth without friction is 19.43 per picosecond: about half of that.
    assert!((per_picosecond / 19.43 - 2.0).abs() < 0.02, "{per_picosecond}");
    let at = |rate: Rational| damped(&clocks, &rate).damping;
    // 38 and 39 per picosecond, in 1/h_1.
    assert_eq!(at(ratio(38 * 48, 100_000)), Some(Damping::Growing));
    assert_eq!(at(ratio(39 * 48, 100_000)), Some(Damping::Damped));
}

/// One oscillator under some clocks: steps, stiffnesses, phases.
fn one(clocks: &[[(i64, i64); 3]]) -> System {
    let potential = |[step, stiffness, phase]: &[(i64, i64); 3]| Potential {
        stiffness: Symmetric::diagonal(&[ratio(stiffness.0, stiffness.1)]),
        step: ratio(step.0, step.1),
        phase: ratio(phase.0, phase.1),
    };
    System::new(Symmetric::diagonal(&[ratio(1, 1)]), clocks.iter().map(potential).collect()).unwrap()
}

#[test]
fn a_friction_that_masks_is_not_said_to_mask_where_larger_ones_grow() {
    let limits = Limits::default();
    let at = |system: &System, rate: f64| damped_system(system, &exact(rate), &limits).unwrap();
    // Damped from 0.0393 to 0.066 or so, and at no larger friction: |Tr Q| is 3.5 at 0.1, and 7.8 where
    // velocities stop.
    let stays = one(&[[(31, 10), (2, 5), (0, 1)], [(124, 5), (1, 3), (0, 1)]]);
    let Mask::At(mask) = at(&stays, 1.0).masking else { panic!("it grows without friction") };
    let [(lo, hi)] = mask.ranges[..] else { panic!("{mask:?}") };
    assert!(mask.grows < lo && 0.039 < mask.grows && lo < 0.0393 && 0.06 < hi && hi < 0.07, "{mask:?}");
    assert!(!mask.stays());
    for (rate, damping) in [
        (0.0393, Damping::Damped),
        (0.05, Damping::Damped),
        (0.06, Damping::Damped),
        (0.1, Damping::Growing),
        (0.3, Damping::Growing),
        (1.0, Damping::Growing),
        (3.0, Damping::Growing),
        (1e9, Damping::Growing),
    ] {
        assert_eq!(at(&stays, rate).damping, Some(damping), "{rate}");
    }
    // In a window of some 10^-9 the trace passes from below −2 to above 2: 1.6·10^6 at 1.17.
    let window = one(&[[(10, 3), (2, 1), (0, 1)], [(5, 1), (-1, 10), (1, 2)], [(25, 3), (3, 10), (1, 2)]]);
    let found = at(&window, 1.17);
    assert_eq!(found.damping, Some(Damping::Growing));
    let Mask::At(mask) = found.masking else { panic!("{found:?}") };
    assert!(mask.ranges.iter().all(|(lo, hi)| 1.169_847 < *lo && *hi < 1.169_848), "{mask:?}");
    assert!(!mask.stays() && mask.ranges.len() == 1, "{mask:?}");
}

// Ledger: friction; random oscillators in unstable intervals; exact arithmetic at frictions in each range
/// Random oscillators in unstable intervals: every range holds at frictions in it, by exact arithmetic.
#[test]
fn ranges_of_frictions_hold_at_every_friction_in_them() {
    let mut state = 11u64;
    let mut below = |n: u64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) % n) as i64
    };
    let (mut seen, mut ended) = (0, 0);
    for _ in 0..60 {
        let (p, q) = (1 + below(9), 1 + below(3));
        let clocks = two_clocks(ratio(p, q), ratio(1 + below(60), 10), ratio(below(80), 10));
        let Mask::At(mask) = damped(&clocks, &ratio(1, 1)).masking else { continue };
        let tick = to_f64(clocks.schedule().tick());
        let at = |rate: f64| damped_exactly(&clocks, &exact((-rate * tick).exp()));
        assert_eq!(at(mask.grows * (1.0 - 1e-9)), Damping::Growing, "{clocks:?} {mask:?}");
        for &(lo, hi) in &mask.ranges {
            let hi = if hi.is_finite() { hi } else { 1e3 * lo };
            for k in 0..=40 {
                // Ends are proven, but for the rounding of the factor here.
                let rate = lo * (1.0 + 1e-9) + (hi * (1.0 - 2e-9) - lo).max(0.0) * f64::from(k) / 40.0;
                assert_eq!(at(rate), Damping::Damped, "{rate} {clocks:?} {mask:?}");
            }
            seen += 1;
        }
        ended += usize::from(!mask.stays());
    }
    assert!(seen > 5 && ended > 0, "{seen} {ended}");
}

/// −1 is an eigenvalue at every friction at Verlet's own limit, and in no other of these.
#[test]
fn a_radius_of_one_at_every_friction_is_told_exactly() {
    let limit = two_clocks(ratio(1, 1), ratio(4, 1), ratio(0, 1));
    let found = damped(&limit, &ratio(1, 10));
    assert_eq!((found.damping, found.growth), (Some(Damping::Marginal), Some((0.0, 0.0))));
    let strength = |text: &str| parse("strength", text).unwrap();
    let steps = [ratio(1, 1), ratio(2, 1)];
    let with_pi = |slow: &str| {
        let strengths = [strength("4 - pi"), strength(slow)];
        let clocks =
            ManyClocks::new(&steps[..1], &[ratio(0, 1)], vec![&strengths[0] + &strengths[1]]).unwrap();
        damped(&clocks, &ratio(1, 10)).damping
    };
    assert_eq!(with_pi("pi"), Some(Damping::Marginal));
    assert_eq!(with_pi("pi + 1/1000"), Some(Damping::Growing));
    assert_eq!(with_pi("pi - 1/1000"), Some(Damping::Damped));
    // Of more masses, one of which is there.
    let unit = [ratio(1, 1), ratio(1, 1)];
    let two = system_of(&unit, &[(ratio(1, 1), &[(0, 0, ratio(4, 1)), (1, 1, ratio(1, 1))])]);
    assert_eq!(
        damped_system(&two, &ratio(1, 10), &Limits::default()).unwrap().damping,
        Some(Damping::Marginal)
    );
}

#[test]
fn nothing_masks_what_does_not_grow() {
    let stable = two_clocks(ratio(2, 1), ratio(1, 10), ratio(1, 10));
    let found = damped(&stable, &ratio(1, 1000));
    assert_eq!((found.damping, found.masking), (Some(Damping::Damped), Mask::NotNeeded));
}

/// The period by plain matrices in doubles.
fn plain(clocks: &ManyClocks<Rational>, rate: f64) -> Matrix2<f64> {
    let tick = to_f64(clocks.schedule().tick());
    clocks.schedule().symmetric_period().fold(Matrix2::identity(), |m, event| {
        let t = event.drift as f64 * tick;
        let drift = Matrix2::new(1.0, t / 2.0, 0.0, 1.0);
        let friction = Matrix2::new(1.0, 0.0, 0.0, (-rate * t).exp());
        let weight = if event.weight == kickdrift::schedule::Weight::Half { 0.5 } else { 1.0 };
        event.clocks().fold(drift * friction * drift * m, |m, clock| {
            Matrix2::new(1.0, 0.0, -weight * to_f64(&clocks.strengths()[clock]), 1.0) * m
        })
    })
}

#[test]
fn spectral_radii_are_those_of_the_plain_product() {
    for (p, q, s, rho, rate) in
        [(7, 2, 2.4, 0.04, 0.05), (10, 1, 0.9, 0.06, 0.001), (5, 3, 2.55, 0.1, 0.3), (3, 2, 3.9, 0.5, 1.0)]
    {
        let slow = exact(s * rho) * ratio(p, q);
        let clocks = two_clocks(ratio(p, q), exact(s), slow);
        let own = damped(&clocks, &exact(rate));
        let m = plain(&clocks, rate);
        let radius = m.complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max);
        let (lo, hi) = own.growth.unwrap();
        let growth = radius.ln() / to_f64(&clocks.period());
        // Some 20 products of matrices of norm 10 at most.
        assert!(hi - lo < 1e-10 && lo - 1e-12 < growth && growth < hi + 1e-12, "{p}/{q}: {growth} {lo} {hi}");
        assert_eq!(own.damping == Some(Damping::Growing), radius > 1.0);
    }
}

/// The rows of the propagator over ℚ, v → c v over each tick.
struct Exactly<'a> {
    x: [Rational; 2],
    v: [Rational; 2],
    tick: &'a Rational,
    c: &'a Rational,
}

impl KickDrift<Rational> for Exactly<'_> {
    fn drift(&mut self, ticks: u64) {
        let c = self.c.pow(ticks as i32);
        let mean = self.tick * Rational::new(ticks.into(), 2.into()) * (ratio(1, 1) + &c);
        for (x, v) in self.x.iter_mut().zip(&mut self.v) {
            *x += &mean * &*v;
            *v *= &c;
        }
    }

    fn kick(&mut self, strength: &Rational) {
        self.x.iter().zip(&mut self.v).for_each(|(x, v)| *v -= strength * x);
    }
}

/// Where the spectral radius lies for 0 ≤ c < 1: |Tr Q| against 1 + det Q (Jury).
fn damped_exactly(clocks: &ManyClocks<Rational>, c: &Rational) -> Damping {
    let kicks = Kicks::of_clocks(clocks.strengths().to_vec(), |k| [k.clone(), k / ratio(2, 1)]);
    let [zero, one] = [0, 1].map(|n| ratio(n, 1));
    let (x, v) = ([one.clone(), zero.clone()], [zero.clone(), one.clone()]);
    let mut orbit = Exactly { x, v, tick: clocks.schedule().tick(), c };
    kicks.lead(clocks.schedule().staggered_period(), &mut orbit);
    let trace = &orbit.x[0] + &orbit.v[1];
    let sum = one + c.pow(clocks.schedule().period() as i32);
    match (&sum - &trace).min(&sum + &trace) {
        room if room < zero => Damping::Growing,
        room if room > zero => Damping::Damped,
        _ => Damping::Marginal,
    }
}

#[test]
fn a_rational_factor_is_decided_exactly_on_either_side_of_the_masking_friction_and_on_it() {
    // One clock, s = 9/2 > 4: Q = [[1 - k m, m], [-k c, c]], m = (1 + c)/2 a tick of 1, so 1 + c + Tr = 2 + 2
    // c - k (1 + c)/2. Above k = 4 no friction masks it.
    let one = |k: Rational| ManyClocks::new(&[ratio(1, 1)], &[ratio(0, 1)], vec![k]).unwrap();
    for c in [ratio(0, 1), ratio(1, 2), ratio(9, 10)] {
        assert_eq!(damped_exactly(&one(ratio(9, 2)), &c), Damping::Growing);
        assert_eq!(damped_exactly(&one(ratio(4, 1)), &c), Damping::Marginal);
        assert_eq!(damped_exactly(&one(ratio(7, 2)), &c), Damping::Damped);
        assert_eq!(damped_exactly(&one(ratio(0, 1)), &c), Damping::Marginal);
    }
    // Both sides of a masking friction agree with it.
    let clocks = two_clocks(ratio(7, 2), ratio(12, 5), ratio(12 * 7, 250));
    let mask = masked(&clocks);
    let (lo, hi) = (mask.grows, mask.least());
    let tick = to_f64(clocks.schedule().tick());
    let factor = |rate: f64| Rational::from_float((-rate * tick).exp()).unwrap();
    assert_eq!(damped_exactly(&clocks, &factor(lo * (1.0 - 1e-9))), Damping::Growing);
    assert_eq!(damped_exactly(&clocks, &factor(hi * (1.0 + 1e-9))), Damping::Damped);
}

#[test]
fn a_period_of_many_ticks_is_masked_as_well() {
    // 30/29: a polynomial of degree 870.
    let clocks = two_clocks(ratio(30, 29), ratio(2, 1), ratio(2 * 30, 29 * 3));
    if let Mask::At(mask) = damped(&clocks, &ratio(1, 1)).masking {
        let rate = mask.least();
        let radius = |rate: f64| {
            plain(&clocks, rate).complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max)
        };
        assert!(radius(rate * 0.999) > 1.0 && radius(rate * 1.001) < 1.0);
    }
}

#[test]
fn a_system_of_independent_oscillators_is_masked_by_what_masks_its_worst() {
    let clocks = two_clocks(ratio(7, 2), ratio(12, 5), ratio(12 * 7, 250));
    let own = masked(&clocks);
    let mask = (own.grows, own.least());
    // The same oscillator twice, turned by (3, 4, 5), beside one that does not grow, steps 1/2 and 7/4.
    let turn = [vec![ratio(3, 5), ratio(-4, 5)], vec![ratio(4, 5), ratio(3, 5)]];
    let matrix = |a: Rational, b: Rational| Symmetric::diagonal(&[a, b]).congruent(&turn);
    let potentials = vec![
        Potential::new(matrix(ratio(4 * 12, 5), ratio(1, 2)), ratio(1, 2)),
        Potential::new(matrix(ratio(4 * 12, 125), ratio(1, 100)), ratio(7, 4)),
    ];
    let system = System::new(Symmetric::diagonal(&[ratio(1, 1), ratio(1, 1)]), potentials).unwrap();
    let found = damped_system(&system, &ratio(1, 100), &Limits::default()).unwrap();
    assert_eq!(found.damping, Some(Damping::Growing));
    let Mask::At(both) = found.masking else { panic!("{found:?}") };
    let (lo, hi) = (both.grows, both.least());
    // In units of time: h_1 = 1/2.
    assert!(lo <= 2.0 * mask.1 && 2.0 * mask.0 <= hi && hi < 1.001 * lo, "{lo} {hi} {mask:?}");
    let enough = damped_system(&system, &ratio(3, 1), &Limits::default()).unwrap();
    assert_eq!(enough.damping, Some(Damping::Damped));
    assert!(enough.growth.unwrap().1 < 0.0);
}

#[test]
fn rigid_motions_are_set_apart_under_friction() {
    // A free pair: only its vibration counts.
    let mut bond = Symmetric::zero(2);
    bond.add_spring(0, Some(1), &ratio(2, 1));
    let system = System::new(
        Symmetric::diagonal(&[ratio(1, 1), ratio(1, 1)]),
        vec![Potential::new(bond, ratio(1, 10))],
    )
    .unwrap();
    assert_eq!(
        damped_system(&system, &ratio(1, 1), &Limits::default()).unwrap().damping,
        Some(Damping::Damped)
    );
    let chain =
        builders::alternating_chain(6, [&ratio(10, 1), &ratio(1, 1)], [&ratio(1, 4), &ratio(1, 2)]).unwrap();
    let found = damped_system(&chain, &ratio(1, 2), &Limits::default()).unwrap();
    assert_eq!((found.damping, found.masking), (Some(Damping::Damped), Mask::NotNeeded));
}

/// Stiffnesses by reference, in an unstable interval of the outer step: by the eigenbasis, rigid motions
/// projected out.
#[test]
fn measured_stiffnesses_are_masked_from_where_it_is_told() {
    use kickdrift::scene::SystemScene;
    use kickdrift::system::levels::{Outer, Search};
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes");
    let text = std::fs::read_to_string(folder.join("water4.json")).unwrap().replace("1/250", "9/2000");
    let scene =
        SystemScene::read_in(&folder, &text).unwrap().asked(None, false, Some(&ratio(1, 100)), None).unwrap();
    let weak = scene.friction(&Limits::default()).unwrap().unwrap();
    let (Mask::At(mask), Some(growth)) = (weak.masking.clone(), weak.growth) else { panic!("{weak:?}") };
    let (lo, hi) = (mask.grows, mask.least());
    // Discs of 10^-11 or so about multipliers, 10^-5 of the ln |λ| of a period.
    assert!(
        weak.damping == Some(Damping::Growing) && 0.0 < growth.0 && growth.1 - growth.0 < 1e-4 * growth.1
    );
    // Friction takes half its rate from growth, to first order.
    assert!(lo < hi && hi < 1.02 * lo && (lo / (2.0 * growth.0) - 1.0).abs() < 0.2, "{lo} {hi} {growth:?}");
    let levels = scene.model().measured().unwrap().levels().unwrap();
    let (kernel, outer) = (levels.source.kernel().unwrap(), Outer::new(0.0045, 9).unwrap());
    let damping = |x: f64| kernel.at(&outer).damping(outer.step(), x);
    assert_eq!([damping(0.99 * lo), damping(1.01 * hi)], [Some(Damping::Growing), Some(Damping::Damped)]);
}

/// Of the slow mode doubles do not tell, at next to no friction, whether it grows: the verdict without
/// friction does.
#[test]
fn what_grows_too_slowly_to_be_told_is_not_said_not_to_grow() {
    let masking = |spring: Rational| {
        let weak = ratio(1, 1_000_000_000_000);
        let (mut fast, mut slow) = (Symmetric::zero(2), Symmetric::zero(2));
        fast.add_spring(0, None, &ratio(1, 1));
        slow.add_spring(0, Some(1), &weak);
        slow.add_spring(1, None, &(weak * spring));
        let potentials = vec![Potential::new(fast, ratio(1, 4)), Potential::new(slow, ratio(1, 1))];
        let system = System::new(Symmetric::diagonal(&[ratio(1, 1), ratio(1, 1)]), potentials).unwrap();
        let verdict = decide_system(&system, &Limits::default()).unwrap().holds();
        (verdict, damped_system(&system, &ratio(1, 1_000_000_000), &Limits::default()).unwrap().masking)
    };
    assert_eq!(masking(ratio(1, 1)), (Holds::Stable, Mask::NotNeeded));
    assert_eq!(masking(ratio(-2, 1)), (Holds::Unstable, Mask::Undecided));
}

type Entries<'a> = &'a [(usize, usize, Rational)];

fn system_of(masses: &[Rational], potentials: &[(Rational, Entries)]) -> System {
    let potential = |(step, entries): &(Rational, Entries)| {
        let mut own = Symmetric::zero(masses.len());
        entries.iter().for_each(|(i, j, x)| own.add(*i, *j, x));
        Potential::new(own, step.clone())
    };
    System::new(Symmetric::diagonal(masses), potentials.iter().map(potential).collect()).unwrap()
}

/// O stands in the middle of every drift of the whole schedule, also for what only one of the clocks acts on.
#[test]
fn a_decoupled_part_is_damped_as_a_part_that_is_hardly_coupled() {
    let unit = [ratio(1, 1), ratio(1, 1)];
    let growth = |coupling: Rational| {
        let slow = [(0, 0, ratio(1, 100)), (1, 0, coupling), (1, 1, ratio(42, 90))];
        let system = system_of(&unit, &[(ratio(1, 1), &[(0, 0, ratio(1, 10))]), (ratio(3, 1), &slow)]);
        let found = damped_system(&system, &ratio(1, 2), &Limits::default()).unwrap();
        (found.damping, found.growth.unwrap())
    };
    let (damping, apart) = growth(ratio(0, 1));
    let (other, coupled) = growth(ratio(1, 1_000_000_000));
    assert_eq!((damping, other), (Some(Damping::Damped), Some(Damping::Damped)));
    // The eigenvalues of a matrix of norm 10 move by some 10^-9 · 10.
    assert!(
        (apart.0 - coupled.0).abs() < 1e-7 && (apart.1 - coupled.1).abs() < 1e-7,
        "{apart:?} {coupled:?}"
    );
    // A rigid pair beside it, and a stiffness that is zero: the same clocks all the same.
    let bond = [(0, 0, ratio(7, 30)), (1, 0, ratio(-7, 30)), (1, 1, ratio(7, 30))];
    let pair = system_of(&unit, &[(ratio(1, 1), &[]), (ratio(3, 1), &bond)]);
    let alone = system_of(&unit[..1], &[(ratio(1, 1), &[]), (ratio(3, 1), &[(0, 0, ratio(42, 90))])]);
    for system in [pair, alone] {
        let own = damped_system(&system, &ratio(1, 2), &Limits::default()).unwrap();
        assert_eq!(own.damping, Some(Damping::Damped));
        let growth = own.growth.unwrap();
        assert!((growth.0 - apart.0).abs() < 1e-7, "{growth:?} {apart:?}");
    }
    // By one clock of 3 alone, one O a kick, it would grow.
    let one = system_of(&unit[..1], &[(ratio(3, 1), &[(0, 0, ratio(42, 90))])]);
    assert_eq!(
        damped_system(&one, &ratio(1, 2), &Limits::default()).unwrap().damping,
        Some(Damping::Growing)
    );
}

/// exp(−γ t) is then enclosed by [0, tiny].
#[test]
fn a_friction_that_stops_all_velocities_is_answered() {
    let clocks = two_clocks(ratio(7, 2), ratio(12, 5), ratio(12 * 7, 250));
    for rate in [ratio(2, 1).pow(60), ratio(10, 1).pow(30), ratio(10, 1).pow(400)] {
        let own = damped(&clocks, &rate);
        // In the limit the velocity is that of the last kick: x → (1 − t k/2) x.
        assert_eq!(own.damping, Some(Damping::Damped));
        assert!(own.growth.unwrap().1 < 0.0);
        let apart = system_of(
            &[ratio(1, 1), ratio(1, 1)],
            &[(ratio(1, 1), &[(0, 0, ratio(1, 10)), (1, 0, ratio(1, 20)), (1, 1, ratio(1, 10))])],
        );
        let found = damped_system(&apart, &rate, &Limits::default()).unwrap();
        assert_eq!(found.damping, Some(Damping::Damped));
    }
}

/// Friction on two levels.
mod levels {
    use super::damped;
    use kickdrift::number::Rational;
    use kickdrift::number::rational::from_f64_exact;
    use kickdrift::system::friction::damped_system;
    use kickdrift::system::friction::{Damping, Mask};
    use kickdrift::system::levels::Hessians;
    use kickdrift::system::levels::{Kernel, Outer, Search};
    use kickdrift::system::{ManyClocks, Potential, Symmetric, System};
    use nalgebra::DMatrix;

    use kickdrift::number::rational::ratio;

    /// One mode, whose own route is exact: near the friction that masks, and on both sides of it.
    #[test]
    fn one_mode_is_damped_as_by_the_exact_route() {
        let one = |x: f64| DMatrix::from_element(1, 1, x);
        let mut told = 0;
        for p in [1u64, 2, 3, 8] {
            for turn in [0.9, 0.98, 1.01] {
                // p θ = turn π, h = 1: a resonance of the outer step.
                let fast = 4.0 * (turn * std::f64::consts::PI / (2 * p) as f64).sin().powi(2);
                let slow = 0.05 * fast;
                let kernel = Kernel::new(&Hessians::new(&one(fast), &one(slow), 0.0).unwrap()).unwrap();
                let outer = Outer::new(p as f64, p).unwrap();
                let exact = |x: f64| from_f64_exact(x).unwrap();
                let whole = |n: u64| Rational::from_integer(n.into());
                let strengths = vec![exact(fast), exact(slow) * whole(p)];
                let clocks =
                    ManyClocks::new(&[whole(1), whole(p)], &[ratio(0, 1), ratio(0, 1)], strengths).unwrap();
                let mask = kernel.at(&outer).masking_friction(outer.step()).unwrap_or(0.1);
                for off in [-0.5, -1e-3, -1e-10, 0.0, 1e-10, 1e-3, 0.5] {
                    let friction = mask * (1.0 + off);
                    let truth = damped(&clocks, &exact(friction)).damping;
                    let found = kernel.at(&outer).damping(outer.step(), friction);
                    assert!(
                        found.is_none() || truth.is_none() || found == truth,
                        "{p} {turn} {off}: {found:?} {truth:?}"
                    );
                    assert!(found.is_some() || off.abs() < 1e-6, "{p} {turn} {off}");
                    told += usize::from(found == Some(Damping::Growing));
                }
            }
        }
        assert!(told > 3, "{told}");
    }

    /// Three modes against the whole period composed event by event.
    #[test]
    fn three_modes_are_damped_as_by_the_composed_period() {
        let fast = [[3, 1, 0], [1, 2, 1], [0, 1, 1]];
        let slow = [[1, 0, 2], [0, 1, 1], [2, 1, 3]];
        let dense = |rows: &[[i64; 3]; 3], c: f64| DMatrix::from_fn(3, 3, |i, j| c * rows[i][j] as f64);
        let exact = |rows: &[[i64; 3]; 3], c: Rational| {
            let mut own = Symmetric::zero(3);
            for (i, row) in rows.iter().enumerate() {
                (0..=i).for_each(|j| own.add(i, j, &(&c * ratio(row[j], 1))));
            }
            own
        };
        let (mut told, mut growing, mut masked) = (0, 0, 0);
        for tenths in 4..24 {
            let h = f64::from(tenths) / 16.0;
            let kernel =
                Kernel::new(&Hessians::new(&dense(&fast, 1.0), &dense(&slow, 1.0 / 16.0), 0.0).unwrap())
                    .unwrap();
            let (inner, outer) = (ratio(tenths.into(), 16), ratio(tenths.into(), 4));
            let potentials = vec![
                Potential::new(exact(&fast, ratio(1, 1)), inner.clone()),
                Potential::new(exact(&slow, ratio(1, 16)), outer),
            ];
            let system =
                System::new(Symmetric::diagonal(&[ratio(1, 1), ratio(1, 1), ratio(1, 1)]), potentials)
                    .unwrap();
            for friction in [1.0 / 128.0, 1.0 / 8.0] {
                let rate = from_f64_exact(friction).unwrap();
                let truth = damped_system(&system, &rate, &Default::default()).unwrap();
                let found = kernel.friction(&Outer::new(4.0 * h, 4).unwrap(), &rate);
                if let (Mask::At(truth), Mask::At(found)) = (truth.masking.clone(), found.masking.clone()) {
                    let ((a, b), (c, d)) = ((truth.grows, truth.least()), (found.grows, found.least()));
                    assert!(c <= b && a <= d && d < 1.01 * c, "{h}: {truth:?} {found:?}");
                    masked += 1;
                }
                if let (Some((a, b)), Some((c, d))) = (truth.growth, found.growth) {
                    assert!(c <= b && a <= d, "{h} {friction}: {truth:?} {found:?}");
                }
                let (truth, found) = (truth.damping, found.damping);
                if let (Some(truth), Some(found)) = (truth, found) {
                    assert_eq!(found, truth, "{h} {friction}");
                    told += 1;
                    growing += usize::from(found == Damping::Growing);
                }
            }
        }
        assert!(told >= 36 && growing > 3 && growing < told - 3 && masked > 3, "{told} {growing} {masked}");
    }
}
