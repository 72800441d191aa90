//! Leapfrog with local time steps: the stiffness that stands for it, its verdicts, all unstable intervals of
//! dt.

use kickdrift::number::Rational;
use kickdrift::number::rational::{from_f64_exact, ratio, to_f64};
use kickdrift::scene::{Span, SystemScene};
use kickdrift::system::stretches::Stretch;
use kickdrift::system::{Holds, Level, Limits, LocalSteps, Model, Potential, Symmetric, System};
use nalgebra::DMatrix;
use serde_json::{Value, json};

/// Numbers that repeat.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, n: u64) -> i64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n) as i64
    }

    /// Two to six masses, a positive semidefinite stiffness BᵀB, one to three levels of substeps.
    fn scheme(&mut self) -> LocalSteps {
        let n = 2 + self.below(5) as usize;
        let masses: Vec<_> = (0..n).map(|_| ratio(1 + self.below(4), 1)).collect();
        let factor: Vec<Vec<_>> =
            (0..n).map(|_| (0..n).map(|_| ratio(self.below(9) - 4, 4)).collect()).collect();
        let entry = |i: usize, j: usize| factor.iter().map(|row| &row[i] * &row[j]).sum::<Rational>();
        let stiffness = DMatrix::from_fn(n, n, entry);
        let step = ratio(1 + self.below(40), 20);
        let mut fine: Vec<usize> = (0..n).collect();
        let levels = (0..1 + self.below(3)).map(|_| {
            fine.retain(|_| self.below(3) > 0);
            Level { fine: fine.iter().copied().collect(), substeps: 1 + self.below(4) as u32 }
        });
        let levels = levels.collect();
        let potential = Potential::new(Symmetric::try_from(&stiffness).unwrap(), step);
        LocalSteps::new(System::new(Symmetric::diagonal(&masses), vec![potential]).unwrap(), levels).unwrap()
    }
}

/// dt² M⁻¹ K' by the matrices of a step, x₊ + x₋ = 2 U x, in doubles: at level l, U y − V w is where it is
/// after a step from y with a force −w from outside, U_L = 1 − d²/2 M⁻¹K P, V_L = d²/2; of p steps T_p(U) y −
/// W_p(U) V w.
fn by_matrices(own: &LocalSteps) -> DMatrix<f64> {
    let (n, mass, stiffness) = (own.plain().size(), own.plain().mass(), &own.plain().clocks()[0].stiffness);
    let a = DMatrix::from_fn(n, n, |i, j| to_f64(&(stiffness.get(i, j) / mass.get(i, i))));
    let one = DMatrix::<f64>::identity(n, n);
    let fine = |l: usize| {
        let is_fine = |i: usize| l == 0 || own.levels()[l - 1].fine.contains(&i);
        DMatrix::from_fn(n, n, |i, j| f64::from(u8::from(i == j && is_fine(i))))
    };
    let finest = own.levels().len();
    let d = to_f64(own.step()) / f64::from(own.substeps());
    let mut u = &one - 0.5 * d * d * &a * fine(finest);
    let mut v = 0.5 * d * d * &one;
    for (l, level) in own.levels().iter().enumerate().rev() {
        let [mut t, mut w] = [[one.clone(), u.clone()], [0.0 * &one, one.clone()]];
        for _ in 1..level.substeps {
            t = [t[1].clone(), 2.0 * &u * &t[1] - &t[0]];
            w = [w[1].clone(), 2.0 * &u * &w[1] + 2.0 * &one - &w[0]];
        }
        (u, v) = (&t[1] - &w[1] * &v * &a * (fine(l) - fine(l + 1)), &w[1] * &v);
    }
    2.0 * (one - u)
}

/// Two masses: A = [[1, −1], [−1, 9]], the second one takes two substeps.
fn two_masses(step: &str) -> SystemScene {
    SystemScene::read(
        &json!({
            "schema": "kickdrift/system/1", "masses": [1, 1], "scheme": "lts",
            "potentials": [{"step": step, "stiffness": [[1, -1], [-1, 9]]}],
            "levels": [{"fine": [1], "substeps": 2}],
        })
        .to_string(),
    )
    .unwrap()
}

#[test]
fn two_masses_are_unstable_in_one_interval_below_1_and_beyond_four_thirds() {
    let scene = two_masses("1/2");
    let found = scene.intervals(&"outer=1/10..3".parse::<Span>().unwrap(), 1e-4, &Limits::default()).unwrap();
    let told: Vec<_> = found.stretches.iter().map(|own| own.verdict).collect();
    assert_eq!(told, [Holds::Stable, Holds::Unstable, Holds::Stable, Holds::Unstable]);
    // det(4 − X A + X²/16 A P A), X = dt², by hand: A P A = [[1, −9], [−9, 81]].
    let determinant = |dt: f64| {
        let x = from_f64_exact(dt).map(|dt| &dt * &dt).unwrap();
        let entry = |a: i64, b: i64, c: i64| ratio(c, 1) - &x * ratio(a, 1) + &x * &x * ratio(b, 16);
        entry(1, 1, 4) * entry(9, 81, 4) - entry(-1, -9, 0) * entry(-1, -9, 0)
    };
    let zero = Rational::default();
    let [first, second, third, _] = &found.stretches[..] else { panic!("four stretches") };
    assert!(determinant(first.hi) > zero && determinant(second.lo) < zero);
    assert_eq!((second.lo, second.hi), (first.hi.next_up(), 1.0));
    assert!((0.88376..0.88377).contains(&first.hi), "{first:?}");
    assert_eq!(determinant(1.0), zero);
    // 4/3 lies between two doubles.
    let edge = ratio(4, 3);
    assert!(from_f64_exact(third.hi).unwrap() < edge && edge < from_f64_exact(third.hi.next_up()).unwrap());
    // There X (1 − 9 X/16) and 9 X (1 − 9 X/16) vanish with X = 16/9: f has an eigenvalue 0.
    // 4/λ of the larger eigenvalue 5 + √17.
    let (lo, hi) = scene.model().local_steps().unwrap().plain_limit().unwrap();
    let plain = 2.0 / (5.0 + 17f64.sqrt()).sqrt();
    assert!(lo < plain && plain < hi && hi - lo < 1e-8 && (0.66215..0.66216).contains(&lo));
}

/// Without the last digits of doubles: how far f is from its ends, in units of 4.
const CLEAR: f64 = 1e-7;

/// Whether 0 < f < 4 M, from the eigenvalues of M^-1/2 f M^-1/2; `None` too near to an end.
fn is_stable(own: &LocalSteps) -> Option<bool> {
    let f = by_matrices(own);
    let root = |i: usize| to_f64(&own.plain().mass().get(i, i)).sqrt();
    let symmetric = DMatrix::from_fn(f.nrows(), f.ncols(), |i, j| f[(i, j)] * root(i) / root(j));
    let eigenvalues = ((&symmetric + symmetric.transpose()) * 0.5).symmetric_eigenvalues();
    let size = eigenvalues.amax().max(1.0);
    let is_near = |x: &f64| x.abs() < CLEAR * size || (x - 4.0).abs() < CLEAR * size;
    (!eigenvalues.iter().any(is_near)).then(|| eigenvalues.iter().all(|&x| 0.0 < x && x < 4.0))
}

// Ledger: local time stepping; 400 random schemes, seed 7; eigenvalues of the composed step
#[test]
fn the_stiffness_of_the_scheme_is_what_its_steps_do_and_decides() {
    let (mut numbers, mut decided) = (Numbers(7), [0, 0]);
    for _ in 0..400 {
        let own = numbers.scheme();
        let (n, mass, square) = (own.plain().size(), own.plain().mass(), own.step() * own.step());
        let stiffness = &own.system().clocks()[0].stiffness;
        let f = DMatrix::from_fn(n, n, |i, j| to_f64(&(stiffness.get(i, j) * &square / mass.get(i, i))));
        let truth = by_matrices(&own);
        // Some thousand roundings of numbers up to the largest power of U.
        let size = (truth.amax() + 1.0) * f64::from(own.substeps()).powi(2);
        assert!((&f - &truth).amax() <= 1e-11 * size, "{own:?}");
        let found = own.decide(kickdrift::system::Route::Cheapest, &Limits::default()).unwrap();
        assert!(found.is_proof(), "{own:?}");
        if let Some(stable) = is_stable(&own) {
            assert_eq!(found.is_stable(), stable, "{own:?}");
            decided[usize::from(stable)] += 1;
        }
    }
    assert!(decided.iter().all(|&n| n > 40), "{decided:?}");
}

#[test]
fn all_unstable_intervals_are_found() {
    all_intervals_are_found(11, 20);
}

#[test]
#[ignore = "minutes"]
fn all_unstable_intervals_of_three_hundred_schemes_are_found() {
    all_intervals_are_found(12, 300);
}

/// Stretches of random schemes against verdicts at 99 steps each.
fn all_intervals_are_found(seed: u64, schemes: usize) {
    let (mut numbers, mut seen) = (Numbers(seed), [0, 0]);
    for _ in 0..schemes {
        let own = numbers.scheme();
        let found = own.stretches((0.05, 3.0), &Limits::default()).unwrap();
        // But where one number between two doubles is unstable and both are not.
        let is_told = |own: &Stretch| own.verdict != Holds::Undecided || own.hi == own.lo.next_up();
        assert!(found.iter().all(is_told), "{found:?}");
        assert!(found.windows(2).all(|pair| pair[0].hi <= pair[1].lo && pair[1].lo <= pair[0].hi.next_up()));
        for k in 1..100 {
            let step = ratio(5, 100) + ratio(295 * k, 10_000);
            let (x, there) = (to_f64(&step), own.at(&step).unwrap());
            let Some(stable) = is_stable(&there) else { continue };
            let stretch = found.iter().find(|own| own.lo <= x && x <= own.hi).expect("a stretch");
            assert_eq!(stretch.verdict == Holds::Stable, stable, "{x}: {own:?}");
            seen[usize::from(stable)] += 1;
        }
    }
    assert!(seen.iter().all(|&n| n > 9 * schemes), "{seen:?}");
}

#[test]
fn elements_of_a_mesh_stand_for_their_nodes() {
    let text = std::fs::read_to_string("data/scenes/local-steps.json").unwrap();
    let by_elements = SystemScene::read(&text).unwrap();
    let mut other: Value = serde_json::from_str(&text).unwrap();
    // Nodes 2, 3 and 4; the first one is held.
    other["levels"] = json!([{"fine": [1, 2, 3], "substeps": 2}]);
    let by_degrees = SystemScene::read(&other.to_string()).unwrap();
    let stiffness = |scene: &SystemScene| scene.model().system().clocks()[0].stiffness.clone();
    assert_eq!(stiffness(&by_elements), stiffness(&by_degrees));
}

#[test]
fn what_is_no_scheme_is_refused_by_the_name_of_its_field() {
    let with = |changes: &[(&str, Value)]| {
        let mut file = json!({
            "schema": "kickdrift/system/1", "masses": [1, 1], "scheme": "lts",
            "potentials": [{"step": 1, "stiffness": [[1, -1], [-1, 9]]}],
            "levels": [{"fine": [1], "substeps": 2}],
        });
        changes.iter().for_each(|(key, value)| file[*key] = value.clone());
        SystemScene::read(&file.to_string()).unwrap_err()
    };
    let two_steps = json!([{"step": 1, "springs": [[0, 1, 1]]}, {"step": 2, "springs": [[0, null, 1]]}]);
    let nested = json!([{"fine": [1], "substeps": 2}, {"fine": [0], "substeps": 2}]);
    for (changes, field) in [
        (vec![("scheme", json!("leapfrog"))], "scheme"),
        (vec![("scheme", Value::Null)], "levels"),
        (vec![("levels", Value::Null)], "levels"),
        (vec![("levels", json!([]))], "levels"),
        (vec![("levels", json!([{"substeps": 2}]))], "levels[0]"),
        (vec![("levels", json!([{"elements": [0], "substeps": 2}]))], "levels[0]"),
        (vec![("levels", json!([{"fine": [2], "substeps": 2}]))], "levels[0].fine"),
        (vec![("levels", json!([{"fine": [1], "substeps": 0}]))], "levels[0].substeps"),
        (vec![("levels", json!([{"fine": [1], "substeps": 5000}]))], "levels[0].substeps"),
        (vec![("levels", nested)], "levels[1].fine"),
        (vec![("potentials", two_steps)], "potentials"),
        (vec![("masses", Value::Null), ("mass_matrix", json!([[2, 1], [1, 2]]))], "mass_matrix"),
        (vec![("friction", json!("1/10"))], "friction"),
    ] {
        let error = with(&changes);
        assert_eq!(error.field(), field, "{error}");
        assert!(!error.to_string().contains('\n'), "{error}");
    }
}

/// Of one mass on a spring p substeps of leapfrog are one step with 2 - 2 T_p(1 - s/2), s = dt^2 k/p^2,
/// whatever p: by the recurrence of T.
#[test]
fn substeps_of_one_mass_are_chebyshevs_polynomials() {
    for p in (1..=33).chain([256, 1021]) {
        let diagonal = |x| Symmetric::diagonal(&[x]);
        let plain =
            System::new(diagonal(ratio(1, 1)), vec![Potential::new(diagonal(ratio(7, 3)), ratio(1, 5))]);
        let own = LocalSteps::new(plain.unwrap(), vec![Level { fine: [0].into(), substeps: p }]).unwrap();
        let square = ratio(1, 25);
        let x = ratio(1, 1) - &square * ratio(7, 6) / ratio(i64::from(p) * i64::from(p), 1);
        let (mut before, mut now) = (ratio(1, 1), x.clone());
        for _ in 1..p {
            let next = ratio(2, 1) * &x * &now - &before;
            (before, now) = (now, next);
        }
        assert_eq!(own.effective(&square).get(0, 0) * &square, ratio(2, 1) - ratio(2, 1) * now, "{p}");
    }
}
