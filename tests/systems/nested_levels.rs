//! Any number of levels of measured stiffnesses, by the action: against the eigenbasis of two levels, one
//! mass, and rational systems.

use kickdrift::number::Rational;
use kickdrift::number::rational::{from_f64_exact, ratio};
use kickdrift::system::friction::Damping;
use kickdrift::system::levels::{Hessians, Kernel, Nested, Outer, Search};
use kickdrift::system::{
    Body, Holds, Limits, MeasuredSystem, Model, Potential, Route, Symmetric, System, decide_system,
};
use nalgebra::DMatrix;

/// Numbers that repeat, in [−1, 1).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn symmetric(&mut self, n: usize) -> DMatrix<f64> {
        let g = DMatrix::from_fn(n, n, |_, _| self.next());
        (&g + g.transpose()) / 2.0
    }

    /// A definite stiffness whose highest frequency is about 1, one of a third, an indefinite one of a fifth.
    fn levels(&mut self, n: usize) -> Vec<DMatrix<f64>> {
        let g = self.symmetric(n);
        let fast = &g * &g + DMatrix::identity(n, n) * 0.3;
        let fast = &fast / size(&fast);
        let g = self.symmetric(n);
        let middle = &g * &g;
        vec![fast, &middle * (0.1 / size(&middle)), self.symmetric(n) * (0.04 / n as f64)]
    }
}

fn size(k: &DMatrix<f64>) -> f64 {
    k.clone().symmetric_eigen().eigenvalues.iter().fold(0.0, |a: f64, x| a.max(x.abs()))
}

fn nested(levels: &[DMatrix<f64>]) -> Nested {
    let slow =
        levels[1..].iter().fold(DMatrix::zeros(levels[0].nrows(), levels[0].nrows()), |sum, k| sum + k);
    let whole = Hessians::new(&levels[0], &slow, 1e-9).unwrap();
    Nested::new(&whole, &levels.iter().map(|k| vec![k.clone()]).collect::<Vec<_>>()).unwrap()
}

/// The verdict on exactly these doubles, the outer step exactly this one.
fn decided(levels: &[DMatrix<f64>], steps: &[Rational], outer: f64) -> Holds {
    let n = levels[0].nrows();
    let factor = from_f64_exact(outer).unwrap() / steps.last().unwrap();
    let potential = |(k, step): (&DMatrix<f64>, &Rational)| {
        let mut own = Symmetric::zero(n);
        (0..n).for_each(|i| (0..=i).for_each(|j| own.add(i, j, &from_f64_exact(k[(i, j)]).unwrap())));
        Potential::new(own, step * &factor)
    };
    let mass = Symmetric::diagonal(&vec![ratio(1, 1); n]);
    let system = System::new(mass, levels.iter().zip(steps).map(potential).collect()).unwrap();
    decide_system(&system, &Limits::default()).unwrap().holds()
}

#[test]
fn two_levels_have_the_region_and_the_band_of_their_eigenbasis() {
    let mut numbers = Numbers(7);
    for n in [1, 2, 5, 12] {
        let levels = &numbers.levels(n)[..2];
        let (own, steps) = (nested(levels), [ratio(1, 4), ratio(1, 1)]);
        let at = own.at(&steps).unwrap();
        let kernel = Kernel::new(&Hessians::new(&levels[0], &levels[1], 1e-9).unwrap()).unwrap();
        let (a, b) = (at.first_unstable().unwrap(), kernel.first_unstable(4).unwrap());
        // Both are found to 1e-8, and what doubles do not tell on both sides.
        assert!(a.0 < b.1 && b.0 < a.1 && a.1 - a.0 < 1e-6 * a.0, "{n}: {a:?} {b:?}");
        for band in [0.0, 0.05] {
            let [a, b] = [at.band_edge(band, 1e-6), kernel.band_edge(4, band, 1e-6)].map(Option::unwrap);
            assert!((a / b - 1.0).abs() < 4e-6, "{n} {band}: {a} {b}");
        }
        // Near the edge, where (1) bounds the margin, and not that the sum stays definite.
        let step = 0.99 * a.0;
        let [a, b] = [at.margin(step), kernel.margin(&Outer::new(step, 4).unwrap())].map(Option::unwrap);
        // Each within a percent, down; norms of nested levels have room of two more.
        assert!((a / b - 1.0).abs() < 0.032, "{n}: {a} {b}");
    }
}

#[test]
fn one_level_is_verlet() {
    let own = nested(&[DMatrix::from_row_slice(2, 2, &[4.0, 0.0, 0.0, 1.0])]);
    let at = own.at(&[ratio(1, 3)]).unwrap();
    // h w < 2, w = 2.
    let (lo, hi) = at.first_unstable().unwrap();
    assert!(lo < 1.0 && 1.0 < hi && hi - lo < 1e-6, "{lo} {hi}");
    // Of periods 5 % shorter.
    let edge = at.band_edge(0.05, 1e-9).unwrap();
    assert!(0.949_99 < edge && edge < 0.95, "{edge}");
}

// Ledger: many levels; random levels of 2, 4 and 7 modes, seed 11; the rational system
/// At random steps, nested or not, whatever is proven is what rational arithmetic or discs of the rational
/// system say.
#[test]
fn three_levels_have_the_verdicts_of_the_rational_system() {
    let mut numbers = Numbers(11);
    let mut seen = [0; 3];
    for steps in [[ratio(1, 4), ratio(1, 2), ratio(1, 1)], [ratio(1, 3), ratio(1, 2), ratio(1, 1)]] {
        for n in [2, 4, 7] {
            let levels = numbers.levels(n);
            let own = nested(&levels);
            let at = own.at(&steps).unwrap();
            let (lo, hi) = at.first_unstable().unwrap();
            assert!(hi - lo < 1e-6 * lo, "{lo} {hi}");
            // A little beside the edge, where multipliers are double.
            assert_eq!(decided(&levels, &steps, lo * (1.0 - 1e-7)), Holds::Stable);
            assert_eq!(decided(&levels, &steps, hi * (1.0 + 1e-7)), Holds::Unstable);
            let upper = at.unstable_up_to(hi, 1e-9).unwrap();
            for k in 1..40 {
                let step = 0.05 * f64::from(k) * lo;
                let (told, true_one) = (at.verdict_within(step, 0.0), decided(&levels, &steps, step));
                assert!(told == Holds::Undecided || told == true_one, "{n} {step}: {told:?} {true_one:?}");
                assert!(step > lo || told == Holds::Stable, "{n} {step}");
                assert!(!(hi..upper).contains(&step) || told == Holds::Unstable, "{n} {step}");
                seen[told as usize] += 1;
            }
        }
    }
    // All but a few of 234 are told, some of each.
    assert!(seen[0] > 120 && seen[1] > 20 && seen[2] < 40, "{seen:?}");
}

/// The margin is for every perturbation, and the band for every stiffness in it.
#[test]
fn what_is_within_the_margin_or_the_band_has_the_verdict() {
    let mut numbers = Numbers(23);
    let (levels, steps) = (numbers.levels(5), [ratio(1, 6), ratio(1, 2), ratio(1, 1)]);
    let own = nested(&levels);
    let at = own.at(&steps).unwrap();
    let (lo, hi) = at.first_unstable().unwrap();
    for (step, verdict) in [(0.98 * lo, Holds::Stable), (hi * 1.001, Holds::Unstable)] {
        assert_eq!(at.verdict_within(step, 0.0), verdict);
        let margin = at.margin(step).unwrap();
        assert!(1e-9 < margin && margin < 0.2, "{margin}");
        for _ in 0..20 {
            let near = |k: &DMatrix<f64>| {
                let e = numbers.symmetric(5);
                k + &e * (margin * size(k) / size(&e))
            };
            let moved: Vec<_> = levels.iter().map(near).collect();
            assert_eq!(decided(&moved, &steps, step), verdict);
        }
    }
    let edge = at.band_edge(0.1, 1e-6).unwrap();
    assert!(0.85 * lo < edge && edge < lo, "{edge} {lo}");
    let shorter = |x: f64| (1.0 + 0.1 * x).powi(-2);
    for _ in 0..20 {
        let mut moved: Vec<_> = levels.iter().map(|k| k * shorter(numbers.next())).collect();
        let eigen = levels[0].clone().symmetric_eigen();
        let each = DMatrix::from_diagonal(&eigen.eigenvalues.map(|x| x * shorter(numbers.next())));
        moved[0] = &eigen.eigenvectors * each * eigen.eigenvectors.transpose();
        moved[0] = (&moved[0] + moved[0].transpose()) / 2.0;
        // The sum must stay definite: it does, by far.
        assert_eq!(decided(&moved, &steps, edge * (1.0 - 1e-6)), Holds::Stable);
    }
}

#[test]
fn growth_and_friction_are_those_of_the_rational_system() {
    let mut numbers = Numbers(5);
    let (levels, steps) = (numbers.levels(4), [ratio(1, 4), ratio(1, 2), ratio(1, 1)]);
    let own = nested(&levels);
    let at = own.at(&steps).unwrap();
    let growing = &at.growing(at.first_unstable().unwrap().1, 1e-4).unwrap()[0];
    let (step, rate) = growing.worst;
    let found = at.decide(step, 1e-9);
    assert!(found.holds == Holds::Unstable && !found.is_in_first_region && found.growing.is_some());
    assert!((found.rate.unwrap() / rate - 1.0).abs() < 1e-6);
    let mask = at.masking_friction(step).unwrap();
    // To first order twice the rate.
    assert!((mask / (2.0 * rate) - 1.0).abs() < 0.2, "{mask} {rate}");
    assert_eq!(at.damping(step, 0.9 * mask), Some(Damping::Growing));
    assert_eq!(at.damping(step, 1.1 * mask), Some(Damping::Damped));
    let still = at.decide(0.5 * step, 1e-9);
    assert!(still.is_in_first_region && still.rate == Some(0.0) && still.growing.is_none());
}

/// Stretches hold at every step in them and for all stiffnesses within the accuracy, far beyond the first
/// unstable step, too; and little is left open.
#[test]
fn stretches_hold_for_all_stiffnesses_within_the_accuracy() {
    let (mut numbers, accuracy) = (Numbers(31), 1e-5);
    let mut length = [0.0; 3];
    for (n, steps) in [
        (2, [ratio(1, 4), ratio(1, 2), ratio(1, 1)]),
        (4, [ratio(1, 3), ratio(1, 2), ratio(1, 1)]),
        (6, [ratio(1, 6), ratio(1, 3), ratio(1, 1)]),
    ] {
        let levels = numbers.levels(n);
        let own = nested(&levels);
        let at = own.at(&steps).unwrap();
        let (first, _) = at.first_unstable().unwrap();
        let range = (0.5 * first, 3.0 * first);
        let found = at.stretches(range, 1e-3, accuracy).unwrap();
        assert!(found[0].lo == range.0 && found[found.len() - 1].hi == range.1);
        assert!(found.windows(2).all(|pair| pair[0].hi == pair[1].lo && pair[0].verdict != pair[1].verdict));
        // The first region ends where its own bound does, but for what the accuracy takes.
        assert!(
            found[0].verdict == Holds::Stable && found[0].hi < first && found[0].hi > first * (1.0 - 1e-2)
        );
        let beyond = found.iter().filter(|own| own.verdict == Holds::Stable && own.lo > first).count();
        assert!(beyond > 0, "{n} {found:?}");
        for own in &found {
            length[own.verdict as usize] += (own.hi - own.lo) / (range.1 - range.0) / 3.0;
            if own.verdict == Holds::Undecided {
                continue;
            }
            for k in 0..3 {
                let step = own.lo + (own.hi - own.lo) * f64::from(k) / 2.0;
                let near = |k: &DMatrix<f64>| {
                    let e = numbers.symmetric(n);
                    k + &e * (0.999 * accuracy * size(k) / size(&e))
                };
                let moved: Vec<_> = levels.iter().map(near).collect();
                let exact = decided(&moved, &steps, step);
                assert_eq!(exact, own.verdict, "{n} {step}");
            }
        }
    }
    assert!(length[0] > 0.5 && length[1] > 0.1 && length[2] < 0.05, "{length:?}");
}

#[test]
fn steps_of_another_number_are_refused() {
    let own = nested(&Numbers(3).levels(2));
    let error = own.at(&[ratio(1, 4), ratio(1, 1)]).unwrap_err();
    assert!(error.to_string().contains("there are 3 levels: give as many steps"), "{error}");
}

/// Steps that meet after 6,000 kicks, and exact arithmetic.
#[test]
fn a_verdict_that_does_not_use_the_accuracy_says_so() {
    let step = |k: i64| ratio(1, k);
    let given = [1, 3000, 2999].map(|k| (step(k), DMatrix::from_element(1, 1, 0.3))).to_vec();
    let body = Body { masses: Some(vec![1.0]), ..Body::default() };
    let long = MeasuredSystem::new(body.clone(), given, 1e-2).unwrap();
    let short = [1, 2, 3].map(|k| (step(k), DMatrix::from_element(1, 1, 0.3))).to_vec();
    let short = MeasuredSystem::new(body, short, 1e-2).unwrap();
    for (measured_system, route) in [(&long, Route::Cheapest), (&short, Route::Exact)] {
        let found = measured_system.decide(route, &Limits::default()).unwrap();
        assert!(found.is_proof() && found.measured.is_none(), "{route:?}");
        let is_said = |warning: &String| warning.contains("their accuracy is not used");
        assert!(found.warnings.iter().any(is_said), "{route:?}: {:?}", found.warnings);
    }
    let found = short.decide(Route::Cheapest, &Limits::default()).unwrap();
    assert!(found.warnings.is_empty() && found.measured.unwrap().holds == Holds::Stable);
}
