//! Ranges of frictions that mask what grows, of more than one degree of freedom.

use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::schedule::Weight;
use kickdrift::system::friction::{Damping, Friction, Mask, Masked, damped_system};
use kickdrift::system::levels::{Hessians, Kernel, Outer};
use kickdrift::system::{Limits, Potential, Symmetric, System};
use nalgebra::DMatrix;

/// Stiffnesses with the ticks between their kicks, of unit masses; a tick is 1.
type Clocks = Vec<(DMatrix<f64>, i64)>;

fn system(clocks: &Clocks) -> System {
    let one = vec![ratio(1, 1); clocks[0].0.nrows()];
    let potential = |(k, step): &(_, i64)| Potential::new(Symmetric::try_from(k).unwrap(), ratio(*step, 1));
    System::new(Symmetric::diagonal(&one), clocks.iter().map(potential).collect()).unwrap()
}

fn measured(clocks: &Clocks) -> (Kernel, Outer) {
    let [(fast, 1), (slow, p)] = &clocks[..] else { panic!("two levels") };
    let kernel = Kernel::new(&Hessians::new(fast, slow, 0.0).unwrap()).unwrap();
    (kernel, Outer::new(*p as f64, *p as u64).unwrap())
}

/// Two masses, each held, with a spring between them.
fn two(a: f64, b: f64, spring: f64) -> DMatrix<f64> {
    DMatrix::from_row_slice(2, 2, &[a, -spring, -spring, b])
}

/// The spectral radius by plain matrices in doubles.
fn radius(clocks: &Clocks, rate: f64) -> f64 {
    let (system, n) = (system(clocks), clocks[0].0.nrows());
    let block = |a: f64, b: f64, c: f64| {
        DMatrix::from_fn(2 * n, 2 * n, |i, j| match (i / n, j / n) {
            _ if i % n != j % n => 0.0,
            (0, 0) => a,
            (0, _) => b,
            (_, 0) => 0.0,
            _ => c,
        })
    };
    let mut q = DMatrix::<f64>::identity(2 * n, 2 * n);
    for event in system.schedule().symmetric_period() {
        let t = event.drift as f64 * to_f64(system.tick());
        let c = (-rate * t).exp();
        q = block(1.0, t * (1.0 + c) / 2.0, c) * q;
        let weight = if event.weight == Weight::Half { 0.5 } else { 1.0 };
        for clock in event.clocks() {
            let (stiffness, step) = &clocks[clock];
            let moved = weight * *step as f64 * stiffness * q.rows(0, n);
            let kicked = q.rows(n, n) - moved;
            q.rows_mut(n, n).copy_from(&kicked);
        }
    }
    q.complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max)
}

fn masked(found: Friction) -> Masked {
    match found.masking {
        Mask::At(own) => own,
        other => panic!("{other:?}"),
    }
}

/// By rational and by measured stiffnesses.
fn both_ways(clocks: &Clocks) -> [Masked; 2] {
    let (kernel, outer) = measured(clocks);
    let exact = damped_system(&system(clocks), &ratio(1, 1), &Limits::default()).unwrap();
    [masked(exact), masked(kernel.friction(&outer, &ratio(1, 1)))]
}

/// 200 frictions of each range; of one without an end up to 10^4 times its least.
fn decays_everywhere(clocks: &Clocks, mask: &Masked) {
    for (lo, hi) in &mask.ranges {
        let decades = if hi.is_finite() { (hi / lo).log10() } else { 4.0 };
        for k in 0..200 {
            let rate = lo * 10f64.powf(decades * f64::from(k) / 199.0);
            // Eigenvalues of doubles near 1 in size are off by some 10^-13: above an edge by 10^-4 of a
            // friction of 0.01 it is 10^-6 off.
            assert!(radius(clocks, rate) < 1.0, "{rate} {mask:?}");
        }
    }
}

#[test]
fn every_friction_above_the_least_masks_what_grows_of_two_coupled_masses() {
    let slow = |size: f64| size * DMatrix::from_row_slice(2, 2, &[1.0, 0.3, 0.3, 0.7]);
    let cases = [
        (two(1.2, 0.5, 0.2), slow(0.2), 4),
        (two(2.1, 1.0, 0.25), slow(0.05), 7),
        (two(0.6, 0.4, 0.1), slow(0.05), 5),
        // Of two scales.
        (two(2.5, 1e-4, 1e-3), DMatrix::from_row_slice(2, 2, &[0.34, 1e-4, 1e-4, 1e-4]), 3),
    ];
    for (fast, slow, p) in cases {
        let clocks = vec![(fast, 1), (slow, p)];
        let all = both_ways(&clocks);
        for mask in &all {
            assert!(mask.stays() && mask.ranges.len() == 1, "{mask:?}");
            assert!(
                mask.least() < 1.001 * mask.grows && radius(&clocks, 0.999 * mask.grows) > 1.0,
                "{mask:?}"
            );
            decays_everywhere(&clocks, mask);
        }
        assert!((all[0].least() / all[1].least() - 1.0).abs() < 1e-3, "{all:?}");
    }
}

#[test]
fn a_range_of_two_coupled_masses_ends_before_a_larger_friction_lets_them_grow() {
    // Damped from 0.030 to 0.33, a factor of ten, and growing on either side.
    let clocks = vec![(two(3.65, 0.4, 0.0), 1), (two(1.9, 2.95, 0.2), 5)];
    for mask in both_ways(&clocks) {
        let [(lo, hi)] = mask.ranges[..] else { panic!("{mask:?}") };
        assert!(!mask.stays() && hi > 10.0 * lo, "{mask:?}");
        decays_everywhere(&clocks, &mask);
        // Up to a part in 10^5 of what is there.
        assert!(radius(&clocks, hi) < 1.0 && radius(&clocks, 1.00001 * hi) > 1.0, "{mask:?}");
        for rate in [0.36, 1.0, 10.0, 1000.0] {
            assert!(radius(&clocks, rate) > 1.0, "{rate}");
        }
    }
    let at = |rate| damped_system(&system(&clocks), &rate, &Limits::default()).unwrap().damping;
    assert_eq!([at(ratio(1, 10)), at(ratio(36, 100))], [Some(Damping::Damped), Some(Damping::Growing)]);
}

// Ledger: friction; random systems on five sets of clocks, seed 5; the spectral radius of the composed period
/// Drifts of different lengths, more clocks, more masses, and strengths at random.
#[test]
fn ranges_of_random_systems_hold_at_every_friction_in_them() {
    let mut state = 5u64;
    let mut number = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / (1u64 << 24) as f64
    };
    let (mut seen, mut without_end) = (0, 0);
    for steps in [&[1, 4][..], &[2, 7], &[1, 2, 6], &[3, 4, 6], &[1, 10]] {
        for n in [2, 3, 3, 5] {
            let mut clocks = Clocks::new();
            for (k, step) in steps.iter().enumerate() {
                let a = DMatrix::from_fn(n, n, |_, _| number() - 0.5);
                let stiffness = &a * a.transpose();
                let size = 3.0 * number() * 0.1f64.powi(k as i32) / stiffness.norm() / steps[0] as f64;
                clocks.push((size * stiffness, *step));
            }
            let found = damped_system(&system(&clocks), &ratio(1, 1), &Limits::default()).unwrap();
            let Mask::At(mask) = found.masking else { continue };
            decays_everywhere(&clocks, &mask);
            assert!(mask.grows == 0.0 || radius(&clocks, mask.grows) > 1.0, "{mask:?}");
            (seen, without_end) = (seen + 1, without_end + usize::from(mask.stays()));
        }
    }
    assert!(seen > 5 && without_end > 4, "{seen} {without_end}");
}

/// 30 : 29, a polynomial of degree 870.
#[test]
fn frictions_of_a_long_period_mask_without_an_end() {
    let one = |x: f64| DMatrix::from_element(1, 1, x);
    let clocks = vec![(one(2.47 / 841.0), 29), (one(1.23 / 900.0), 30)];
    let mask = masked(damped_system(&system(&clocks), &ratio(1, 1), &Limits::default()).unwrap());
    assert!(mask.stays(), "{mask:?}");
    decays_everywhere(&clocks, &mask);
}
