//! Local time steps of sparse stiffnesses in doubles, against exact arithmetic and dense eigenvalues.

use kickdrift::number::rational::{from_f64_exact, ratio, to_f64};
use kickdrift::system::{
    Holds, Level, Limits, LocalSteps, Model, Potential, Route, SparseSteps, SparseSystem, Symmetric, System,
    exact_kind,
};
use kickdrift::verdict::Kind;
use nalgebra::DMatrix;

/// Numbers that repeat.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, n: u64) -> i64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n) as i64
    }
}

type Entries = Vec<(usize, usize, f64)>;

/// Springs between neighbours of a chain, the last one free where it `floats`, else walls at both ends.
fn chain(springs: &[f64], floats: bool) -> Entries {
    let n = springs.len() - 1;
    let of = |i: usize| if floats && (i == 0 || i == n) { 0.0 } else { springs[i] };
    let diagonal = (0..n).map(|i| (i, i, of(i) + of(i + 1)));
    diagonal.chain((1..n).map(|i| (i, i - 1, -of(i)))).collect()
}

/// The same scheme in doubles and in rationals, whose entries these doubles are.
fn both(masses: &[f64], stiffness: &Entries, levels: &[Level]) -> (SparseSteps, LocalSteps) {
    let n = masses.len();
    let entry = |i: usize, j: usize| {
        let (i, j) = (i.max(j), i.min(j));
        stiffness.iter().filter(|own| (own.0, own.1) == (i, j)).map(|own| own.2).sum::<f64>()
    };
    let dense = Symmetric::try_from(&DMatrix::from_fn(n, n, entry)).unwrap();
    let exact: Vec<_> = masses.iter().map(|&m| from_f64_exact(m).unwrap()).collect();
    let plain = System::new(Symmetric::diagonal(&exact), vec![Potential::new(dense, ratio(1, 1))]).unwrap();
    let sparse = SparseSteps::new(masses, stiffness, levels.to_vec()).unwrap();
    (sparse, LocalSteps::new(plain, levels.to_vec()).unwrap())
}

/// The eigenvalues of M^-1/2 f M^-1/2 from exact f, increasing.
fn eigenvalues(own: &LocalSteps, dt: f64) -> Vec<f64> {
    let (n, square) = (own.plain().size(), from_f64_exact(dt).map(|dt| &dt * &dt).unwrap());
    let (f, mass) = (own.effective(&square), own.plain().mass());
    let root = |i: usize| to_f64(&mass.get(i, i)).sqrt();
    let entry = |i: usize, j: usize| to_f64(&(f.get(i, j) * &square)) / (root(i) * root(j));
    let mut all: Vec<_> = DMatrix::from_fn(n, n, entry).symmetric_eigenvalues().iter().copied().collect();
    all.sort_by(f64::total_cmp);
    all
}

/// Doubles tell eigenvalues of some units to so much.
const CLEAR: f64 = 1e-9;

#[test]
fn verdicts_and_growth_are_those_of_dense_eigenvalues() {
    let (mut numbers, mut seen) = (Numbers(3), [0, 0]);
    for case in 0..80 {
        let n = 3 + numbers.below(10) as usize;
        let floats = case % 4 == 0;
        let springs: Vec<_> = (0..=n).map(|_| (1 + numbers.below(16)) as f64 / 4.0).collect();
        let masses: Vec<_> = (0..n).map(|_| (1 + numbers.below(4)) as f64).collect();
        let mut fine: Vec<usize> = (0..n).collect();
        let levels: Vec<_> = (0..1 + numbers.below(3))
            .map(|_| {
                fine.retain(|_| numbers.below(3) > 0);
                Level { fine: fine.iter().copied().collect(), substeps: 1 + numbers.below(4) as u32 }
            })
            .collect();
        let (sparse, exact) = both(&masses, &chain(&springs, floats), &levels);
        assert_eq!(sparse.rigid_motions(), usize::from(floats));
        for _ in 0..10 {
            let dt = (1 + numbers.below(300)) as f64 / 100.0;
            let all = eigenvalues(&exact, dt);
            // The rigid motion is the eigenvalue nearest to 0.
            let rigid = all.iter().map(|x| x.abs()).fold(f64::MAX, f64::min);
            let own = all.iter().filter(|x| !floats || x.abs() > rigid).copied();
            let beyond = own.clone().map(|x| (-x).max(x - 4.0)).fold(f64::MIN, f64::max);
            match sparse.verdict(dt) {
                Holds::Stable => assert!(beyond < CLEAR, "{case} {dt} {all:?}"),
                Holds::Unstable => assert!(beyond > -CLEAR, "{case} {dt} {all:?}"),
                Holds::Undecided => assert!(beyond.abs() < CLEAR, "{case} {dt} {all:?}"),
            }
            if beyond.abs() > CLEAR {
                seen[usize::from(beyond > 0.0)] += 1;
            }
            let growth = sparse.growth(dt);
            assert_eq!(growth.is_some(), sparse.verdict(dt) == Holds::Unstable, "{case} {dt} {beyond}");
            if let Some(growth) = growth {
                // λ + 1/λ = ±(2 + excess).
                let rate = (1.0 + beyond / 2.0).acosh();
                let (lo, hi) = growth.rate;
                assert!(lo * (1.0 - 1e-6) <= rate && rate <= hi * (1.0 + 1e-6), "{lo} {rate} {hi}");
                assert!(hi < 1.02 * lo, "{lo} {hi}");
            }
        }
    }
    assert!(seen.iter().all(|&n| n > 120), "{seen:?}");
}

#[test]
fn the_first_unstable_step_of_one_level_is_that_of_exact_determinants() {
    let (mut numbers, mut seen) = (Numbers(5), 0);
    for case in 0..100 {
        let n = 3 + numbers.below(5) as usize;
        let springs: Vec<_> = (0..=n).map(|_| (1 + numbers.below(12)) as f64 / 2.0).collect();
        let masses: Vec<_> = (0..n).map(|_| (1 + numbers.below(3)) as f64).collect();
        let count = 1 + numbers.below(n as u64 - 1) as usize;
        let levels = [Level { fine: (0..count).collect(), substeps: 2 + numbers.below(3) as u32 }];
        let (sparse, exact) = both(&masses, &chain(&springs, false), &levels);
        let Some((lo, hi)) = sparse.first_unstable() else { continue };
        let truth = exact.stretches((0.2, 3.0), &Limits::default()).unwrap();
        assert!(eigenvalues(&exact, lo).last().unwrap() < &4.0 && hi < 1.001 * lo, "{case} {lo} {hi}");
        assert!(eigenvalues(&exact, hi).last().unwrap() > &(4.0 - CLEAR), "{case} {lo} {hi}");
        let first = truth.iter().find(|own| own.verdict == Holds::Unstable).map(|own| own.lo);
        // Edges of the truth lie between neighbouring doubles.
        assert!(
            first.is_none_or(|first| lo <= first && first <= hi * (1.0 + 1e-12)),
            "{case} {first:?} {hi}"
        );
        seen += usize::from(first.is_some());
    }
    assert!(seen > 50, "{seen}");
}

#[test]
fn the_first_unstable_step_is_as_sharp_where_a_resonance_is_hardly_coupled() {
    // The fastest fine motion is at the far wall, three hundred springs away from what is coarse: the
    // interval is thinner than doubles are.
    let springs: Vec<_> = (0..=400)
        .map(|i| {
            if i < 4 {
                40.0
            } else if i < 300 {
                16.0
            } else {
                1.0
            }
        })
        .collect();
    let levels = vec![Level { fine: (0..320).collect(), substeps: 4 }];
    let sparse = SparseSteps::new(&[1.0; 400], &chain(&springs, false), levels).unwrap();
    let (lo, hi) = sparse.first_unstable().expect("proven");
    // 4 − f falls as the square of the distance from there: within some 10^-6 factorizations do not tell, and
    // a bisection ends at 10^-5.
    assert!(lo < hi && hi < lo * (1.0 + 2e-5), "{lo} {hi}");
    assert_eq!((sparse.verdict(lo), sparse.verdict(hi * (1.0 + 1e-3))), (Holds::Stable, Holds::Stable));
    // (dt/4)² y = 4 sin²(π/8) of the largest y, a little below 160.
    let expected = |y: f64| 8.0 * (std::f64::consts::PI / 8.0).sin() / f64::sqrt(y);
    assert!(expected(160.0) < lo && hi < expected(120.0), "{lo} {hi}");
}

/// A free chain of four, each mass pulled by so much more.
fn floating(more: f64) -> Entries {
    let mut own = chain(&[1.0; 5], true);
    own.iter_mut().filter(|own| own.0 == own.1).for_each(|own| own.2 += more);
    own
}

#[test]
fn all_together_are_set_apart_only_where_rows_sum_to_0_within_the_rounding_of_their_entries() {
    let levels = vec![Level { fine: [3].into(), substeps: 2 }];
    let decided = |more: f64| {
        let steps = SparseSteps::new(&[1.0; 4], &floating(more), levels.clone()).unwrap();
        let rigid = steps.rigid_motions();
        let model = SparseSystem::with_local_steps(steps, &ratio(1, 1)).unwrap();
        let found = Model::decide(&model, Route::Cheapest, &Limits::default()).unwrap();
        (found, rigid)
    };
    let (free, rigid) = decided(0.0);
    assert!(free.is_stable() && free.is_proof() && rigid == 1);
    // Pushed apart by 10^-12 of its springs all of it runs away, e-fold in 10^6.
    let (pushed, rigid) = decided(-1e-12);
    let (lo, hi) = pushed.growth_rate().unwrap();
    assert!(!pushed.is_stable() && pushed.is_proof() && rigid == 0, "{pushed:?}");
    // 1e-12 as doubles have it, known to a fiftieth of the excess.
    assert!(lo < 1.0001e-6 && 1e-6 < hi && hi < 1.1 * lo, "{lo} {hi}");
    // Pulled by as much it is held.
    let (held, rigid) = decided(1e-12);
    assert!(held.is_stable() && held.is_proof() && rigid == 0 && held.rigid_modes.is_empty(), "{held:?}");
    // Of many masses exact arithmetic is too much, and what doubles do not tell is said.
    let n = 100;
    let mut many = chain(&vec![1.0; n + 1], true);
    many.iter_mut().filter(|own| own.0 == own.1).for_each(|own| own.2 += 3e-14);
    let steps = SparseSteps::new(&vec![1.0; n], &many, levels).unwrap();
    assert_eq!((steps.rigid_motions(), steps.verdict(1.0)), (0, Holds::Undecided));
    let model = SparseSystem::with_local_steps(steps, &ratio(1, 1)).unwrap();
    let found = model.decide(Route::Cheapest, &Limits::default()).unwrap();
    assert!(
        found.warnings.iter().any(|own| own.contains("neither clearly free nor clearly held")),
        "{found:?}"
    );
}

/// Half of 1/2 and 8 with four substeps: the second mass makes a full turn in a step of 2.
#[test]
fn a_full_turn_of_a_fine_motion_is_no_rigid_motion() {
    let levels = vec![Level { fine: [1].into(), substeps: 4 }];
    let steps = SparseSteps::new(&[1.0; 2], &[(0, 0, 0.5), (1, 1, 8.0), (1, 0, 0.1)], levels).unwrap();
    assert_eq!((steps.rigid_motions(), steps.verdict(2.0)), (0, Holds::Undecided));
    let model = SparseSystem::with_local_steps(steps, &ratio(2, 1)).unwrap();
    let found = model.decide(Route::Cheapest, &Limits::default()).unwrap();
    assert!(!found.is_stable() && found.rigid_modes.is_empty(), "{found:?}");
    assert_eq!(found.kind, Some(Kind::Parabolic), "{found:?}");
}

// Ledger: local time stepping; 300 random schemes at four steps, seed 17; exact arithmetic
/// Walls, none, and none but for a last digit; steps at which fine motions make whole and half turns: what is
/// proven is so in exact arithmetic.
#[test]
fn what_is_proven_of_small_schemes_is_so_in_exact_arithmetic() {
    let (mut numbers, mut seen) = (Numbers(17), [0; 3]);
    for case in 0..300 {
        let n = 1 + numbers.below(4) as usize;
        let springs: Vec<_> = (0..=n).map(|_| 2f64.powi(numbers.below(4) as i32)).collect();
        let mut stiffness = chain(&springs, case % 3 > 0 && n > 1);
        if case % 3 == 2 {
            let by = [1e-12, -1e-12, 3e-10, -2f64.powi(-50)][numbers.below(4) as usize];
            stiffness.iter_mut().filter(|own| own.0 == own.1).for_each(|own| own.2 += by);
        }
        let masses: Vec<_> = (0..n).map(|_| (1 + numbers.below(3)) as f64).collect();
        let fine = (0..n).filter(|_| numbers.below(2) > 0).collect();
        let levels = [Level { fine, substeps: 1 + numbers.below(4) as u32 }];
        let (sparse, exact) = both(&masses, &stiffness, &levels);
        for step in [ratio(1, 2), ratio(1, 1), ratio(2, 1), ratio(1 + numbers.below(200), 100)] {
            let truth = exact_kind(exact.at(&step).unwrap().system(), &Limits::default()).unwrap();
            let told = sparse.verdict(to_f64(&step));
            seen[told as usize] += 1;
            // Within the rounding of entries a chain whose rows do not quite sum to 0 may move together.
            let is_free = sparse.rigid_motions() == 1 && case % 3 == 2;
            match told {
                Holds::Stable => assert!(truth.is_stable() || is_free, "{case} {step} {truth:?}"),
                Holds::Unstable => assert!(!truth.is_stable(), "{case} {step} {truth:?}"),
                Holds::Undecided => {
                    let model = SparseSystem::with_local_steps(sparse.clone(), &step).unwrap();
                    let found = model.decide(Route::Cheapest, &Limits::default()).unwrap();
                    assert!(found.kind.is_none_or(|kind| kind == truth), "{case} {step}");
                }
            }
        }
    }
    let [stable, unstable, open] = seen;
    assert!(stable > 200 && unstable > 200 && open > 4, "{seen:?}");
}
