//! Forces that are no gradient: their Jacobians are not symmetric.

use kickdrift::number::Rational;
use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::scene::{Axis, Scan, SystemScene};
use kickdrift::system::{Analysis, Jacobians, Limits, Potential, Route, Symmetric, System, middle};
use kickdrift::verdict::Kind;
use nalgebra::DMatrix;
use serde_json::json;

/// Numbers that repeat.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, n: u64) -> i64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n) as i64
    }

    /// A Jacobian of n rows: `size` on the diagonal, and entries up to `off` twelfths of it beside.
    fn jacobian(&mut self, n: usize, size: i64, off: u64) -> DMatrix<Rational> {
        DMatrix::from_fn(n, n, |i, j| {
            let beside = ratio(self.below(2 * off + 1) - off as i64, 12);
            if i == j { ratio(size + self.below(4), 1) + beside } else { beside }
        })
    }
}

/// Masses, and Jacobians with their steps.
type Given = (Vec<Rational>, Vec<(DMatrix<Rational>, Rational)>);

fn decided((masses, given): &Given, route: Route) -> Analysis {
    let given: Vec<_> = given.iter().map(|(j, step)| (j.clone(), step.clone(), ratio(0, 1))).collect();
    Jacobians::rational(masses, &given).unwrap().decide(route, &Limits::default()).unwrap()
}

/// The outer step of two clocks, the second of which kicks in every k-th step of the first, half before and
/// half after: in doubles.
fn period((masses, given): &Given) -> DMatrix<f64> {
    let n = masses.len();
    let [(fast, inner), (slow, outer)] = &given[..] else { panic!("two") };
    let a = |j: &DMatrix<Rational>| DMatrix::from_fn(n, n, |i, k| to_f64(&(&j[(i, k)] / &masses[i])));
    let (fast, slow, d, h) = (a(fast), a(slow), to_f64(inner), to_f64(outer));
    let block = |c: DMatrix<f64>, x: f64| {
        let mut m = DMatrix::identity(2 * n, 2 * n);
        m.view_mut((n, 0), (n, n)).copy_from(&c);
        (0..n).for_each(|i| m[(i, n + i)] = x);
        m
    };
    let [kick, end] = [block(-d / 2.0 * &fast, 0.0), block(-h / 2.0 * &slow, 0.0)];
    let step = &kick * block(DMatrix::zeros(n, n), d) * &kick;
    let times = (outer / inner).to_integer();
    let inner = (0..i32::try_from(times).unwrap()).fold(DMatrix::identity(2 * n, 2 * n), |q, _| &step * q);
    &end * inner * &end
}

// Ledger: non-conservative forces; 2000 random Jacobians, seed 3; exact arithmetic and the dense period
#[test]
fn doubles_and_exact_arithmetic_agree_and_so_does_the_dense_period() {
    let (mut numbers, mut kinds) = (Numbers(3), std::collections::BTreeMap::new());
    for _ in 0..2000 {
        let n = 1 + numbers.below(6) as usize;
        let masses: Vec<_> = (0..n).map(|_| ratio(1 + numbers.below(3), 1)).collect();
        let (inner, times) = (ratio(1 + numbers.below(12), 20), 1 + numbers.below(6));
        let off = 1 + numbers.below(5) as u64;
        let fast = numbers.jacobian(n, 4, off);
        let slow = numbers.jacobian(n, 0, off);
        let given = (masses, vec![(fast, inner.clone()), (slow, inner * ratio(times, 1))]);
        let [found, exact] = [Route::Cheapest, Route::Exact].map(|route| decided(&given, route));
        assert!(found.is_proof() && found.kind == exact.kind, "{:?} {:?} {given:?}", found.kind, exact.kind);
        *kinds.entry(found.kind.unwrap().name()).or_insert(0) += 1;
        // Of nearly defective periods half of the digits are right.
        let size = period(&given).complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max);
        let is_unstable = found.kind == Some(Kind::Hyperbolic);
        assert!(size > 1.0 + 1e-6 || !is_unstable || size < 1.0 + 1e-5, "{size} {given:?}");
        if (size - 1.0).abs() > 1e-5 {
            assert!(is_unstable, "{size} {given:?}");
            let (lo, hi) = found.growth_rate().unwrap();
            let rate = size.ln() / to_f64(&given.1[1].1);
            assert!(lo - 1e-6 * rate <= rate && rate <= hi + 1e-6 * rate, "{rate} in {lo}..{hi}");
        }
    }
    assert!(kinds["elliptic"] > 300 && kinds["hyperbolic"] > 300, "{kinds:?}");
}

#[test]
fn symmetric_matrices_are_decided_as_gradients_are() {
    let mut numbers = Numbers(5);
    for _ in 0..300 {
        let n = 1 + numbers.below(4) as usize;
        let masses: Vec<_> = (0..n).map(|_| ratio(1 + numbers.below(3), 1)).collect();
        let symmetric = |m: DMatrix<Rational>| (&m + m.transpose()).map(|x| x / ratio(2, 1));
        let given: Vec<_> = [(4, ratio(1, 4)), (0, ratio(1, 1)), (0, ratio(3, 2))]
            .map(|(size, step)| (symmetric(numbers.jacobian(n, size, 4)), step))
            .into();
        let potentials =
            given.iter().map(|(k, step)| Potential::new(Symmetric::try_from(k).unwrap(), step.clone()));
        let system = System::new(Symmetric::diagonal(&masses), potentials.collect()).unwrap();
        let exact = kickdrift::system::exact_kind(&system, &Limits::default()).unwrap();
        let found = decided(&(masses, given), Route::Exact).kind.unwrap();
        // Over the whole period, where parts have shorter ones, multipliers may be ±1 without harm.
        let are_stable = exact.is_stable() && found.is_stable();
        assert!(exact == found || are_stable, "{exact:?} {found:?} {system:?}");
    }
}

/// Three molecules alike that hardly see each other, a stiff bond in each, and a slow force whose Jacobian is
/// not symmetric by this part of its norm, as a file.
fn learned(asymmetry: f64, outer: i64) -> (SystemScene, Given) {
    let (n, mut numbers) = (6, Numbers(11));
    let fast = DMatrix::from_fn(n, n, |i, j| match (i / 2 == j / 2, i == j) {
        (true, true) => ratio(200, 1),
        (true, false) => ratio(-120, 1),
        _ => ratio(0, 1),
    });
    let beside = |i: usize, j: usize| if i.abs_diff(j) == 1 { ratio(-1, 100) } else { ratio(0, 1) };
    let mut slow = DMatrix::from_fn(n, n, |i, j| if i == j { ratio(20, 1) } else { beside(i, j) });
    let mut off = DMatrix::from_fn(n, n, |_, _| ratio(0, 1));
    for (i, j) in (0..n).flat_map(|i| (0..i).map(move |j| (i, j))) {
        let x = ratio(numbers.below(201) - 100, 100);
        (off[(i, j)], off[(j, i)]) = (x.clone(), -x);
    }
    let norm = |m: &DMatrix<Rational>| m.map(|x| to_f64(&x)).norm();
    let factor = ratio((asymmetry * norm(&slow) / norm(&off) * 1e6).round() as i64, 1_000_000);
    slow += off.map(|x| x * &factor);
    let text = |m: &DMatrix<Rational>| {
        let row = |i: usize| m.row(i).iter().map(ToString::to_string).collect::<Vec<_>>();
        (0..n).map(row).collect::<Vec<_>>()
    };
    let steps = [ratio(1, 50), ratio(outer, 50)];
    let file = json!({
        "schema": "kickdrift/system/1", "symmetric": false, "masses": vec!["1"; n],
        "potentials": [
            {"step": steps[0].to_string(), "stiffness": text(&fast)},
            {"step": steps[1].to_string(), "stiffness": text(&slow)},
        ],
    });
    let [inner, outer] = steps;
    let given = (vec![ratio(1, 1); n], vec![(fast, inner), (slow, outer)]);
    (SystemScene::read(&file.to_string()).unwrap(), given)
}

#[test]
fn growth_of_a_learned_force_is_what_a_run_shows() {
    for (asymmetry, outer) in [(0.004, 8), (0.015, 8), (0.03, 8), (0.03, 4), (0.03, 9)] {
        let (scene, given) = learned(asymmetry, outer);
        let analysis = scene.model().decide(Route::Cheapest, &Limits::default()).unwrap();
        let jacobians = scene.model().jacobians().unwrap();
        let beside = jacobians.no_gradient();
        assert!((beside.asymmetries[1] / asymmetry - 1.0).abs() < 1e-3 && beside.asymmetries[0] == 0.0);
        assert_eq!(analysis.kind, Some(Kind::Hyperbolic), "{asymmetry} {outer}");
        let predicted = analysis.growth_rate().unwrap();
        assert!(predicted.1 - predicted.0 < 1e-6 * predicted.1);
        // A run from random displacements, until what grows most is all that is left.
        let (step, n) = (period(&given), given.0.len());
        let time = to_f64(&given.1[1].1);
        let mut state = nalgebra::DVector::from_fn(2 * n, |i, _| ((7 * i + 3) % 5) as f64 - 2.0);
        let mut logs = 0.0;
        let advance = |state: &mut nalgebra::DVector<f64>, steps: usize| {
            (0..steps).fold(0.0, |sum, _| {
                *state = &step * &*state;
                let norm = state.norm();
                *state /= norm;
                sum + norm.ln()
            })
        };
        // Others fall behind by ten thousand e-foldings of the growth, or as many of its differences.
        let steps = (40.0 / (predicted.0 * time)) as usize + 20_000;
        advance(&mut state, steps);
        logs += advance(&mut state, steps);
        let seen = logs / (steps as f64 * time);
        assert!((seen / middle(predicted) - 1.0).abs() < 0.02, "{seen} {predicted:?}");
        // x'' = −A x itself, by its eigenvalues.
        let a = given.1.iter().fold(DMatrix::zeros(n, n), |a, (j, _)| a + j.map(|x| to_f64(&x)));
        let own = a.complex_eigenvalues().iter().map(|z| z.sqrt().im.abs()).fold(0.0, f64::max);
        let (lo, hi) = beside.without_steps.unwrap();
        assert!(lo <= own + 1e-9 && own - 1e-9 <= hi && hi - lo < 1e-6, "{own} in {lo}..{hi}");
        // Friction masks it at twice the rate, to first order.
        let masking = beside.masking.unwrap();
        assert!(masking > 0.5 * predicted.0 && masking < 8.0 * predicted.1, "{masking} {predicted:?}");
    }
}

#[test]
fn what_no_force_sees_is_set_apart() {
    // Two particles that push each other unequally: a shift of both is not seen, their momentum is not kept.
    let file = json!({
        "schema": "kickdrift/system/1", "symmetric": false, "masses": [1, 2],
        "potentials": [
            {"step": "1/10", "stiffness": [["9", "-9"], ["-10", "10"]]},
            {"step": "1/2", "stiffness": [["1/4", "-1/4"], ["-1/5", "1/5"]]},
        ],
    });
    let model = SystemScene::read(&file.to_string()).unwrap();
    let model = model.model();
    let found = model.decide(Route::Cheapest, &Limits::default()).unwrap();
    assert_eq!(found.rigid_modes, vec![vec![ratio(1, 1), ratio(1, 1)]]);
    assert_eq!((found.size, found.parts[0].size, found.kind), (2, 1, Some(Kind::Elliptic)));
    // What is left is one oscillator, of x₁ − x₂: 9 + 10/2 and 1/4 + 1/10.
    let alone = json!({
        "schema": "kickdrift/system/1", "masses": [1],
        "potentials": [{"step": "1/10", "stiffness": [["14"]]}, {"step": "1/2", "stiffness": [["7/20"]]}],
    });
    let alone = SystemScene::read(&alone.to_string()).unwrap();
    let alone = alone.model().decide(Route::Cheapest, &Limits::default()).unwrap();
    let [own, other] = [&found, &alone].map(|own| own.parts[0].multipliers[0].mu.re);
    assert!((own - other).abs() < 1e-12, "{own} {other}");
}

/// Two oscillators that do not grow, with steps and without: nothing is added, and no double beside 0.
#[test]
fn steps_that_add_nothing_to_what_does_not_grow_add_zero() {
    let file = r#"{"schema": "kickdrift/system/1", "symmetric": false, "masses": [1, 1],
        "potentials": [{"step": "1/10", "stiffness": [["4", "1/10"], ["1/5", "1"]]}]}"#;
    let scene = SystemScene::read(file).unwrap();
    let analysis = scene.model().decide(Route::Cheapest, &Limits::default()).unwrap();
    assert!(analysis.is_stable());
    assert_eq!(scene.model().jacobians().unwrap().no_gradient().added_by_steps(&analysis), Some((0.0, 0.0)));
}

#[test]
fn what_needs_gradients_is_refused() {
    let (scene, _) = learned(0.03, 8);
    let limits = Limits::default();
    let errors = [
        scene.linear_simulation(vec![0.0; 6], vec![0.0; 6]).map(|_| ()).unwrap_err(),
        scene.model().moving().map(|_| ()).unwrap_err(),
        scene.model().friction(&ratio(1, 5), &limits).map(|_| ()).unwrap_err(),
    ];
    assert!(errors.iter().all(|error| !error.to_string().contains('\n')), "{errors:?}");
    assert!(scene.model().jacobians().is_some());
    // What is named instead of intervals answers.
    let span = "outer=1/10..1/5".parse().unwrap();
    let error = scene.intervals(&span, 1e-2, &limits).unwrap_err().to_string();
    assert!(error.contains("--scan outer=LO..HI:BY"), "{error}");
    assert_eq!(scene.nearest_unstable(1e-2, &limits).unwrap_err().field(), "nearest");
    let axis: Axis = "outer=1/10..1/5:1/20".parse().unwrap();
    let (outer, scan) = (axis.values(), Scan::new(scene, axis, None).unwrap());
    let decides =
        |outer: &Rational| scan.at(outer, outer).unwrap().model().decide(Route::Cheapest, &limits).is_ok();
    assert!(outer.iter().all(decides));
}

/// Two oscillators alike of 10 fs and one of 13 fs, cheap forces every 1/2 fs; a correction whose Jacobian is
/// not symmetric every `outer` fs.
fn alike(outer: &Rational) -> (String, Given) {
    let diagonal =
        |own: [i64; 3]| DMatrix::from_fn(3, 3, |i, j| if i == j { ratio(own[i], 1000) } else { ratio(0, 1) });
    let mut correction = diagonal([20, 20, 15]);
    for (i, j, x) in [(0, 1, 5), (1, 0, -5), (1, 2, 3), (2, 1, -2)] {
        correction[(i, j)] = ratio(x, 10_000);
    }
    let cheap = diagonal([395, 395, 234]);
    let rows = |m: &DMatrix<Rational>| -> Vec<Vec<String>> {
        m.row_iter().map(|row| row.iter().map(ToString::to_string).collect()).collect()
    };
    let file = json!({"schema": "kickdrift/system/1", "title": "", "time_unit": "fs", "symmetric": false, "masses": [1, 1, 1],
        "potentials": [{"step": "1/2", "stiffness": rows(&cheap)}, {"step": outer.to_string(), "stiffness": rows(&correction)}]});
    let masses = vec![ratio(1, 1); 3];
    (file.to_string(), (masses, vec![(cheap, ratio(1, 2)), (correction, outer.clone())]))
}

/// The period with a friction in the middle of each inner drift, in doubles.
fn damped_radius((masses, given): &Given, friction: f64) -> f64 {
    let n = masses.len();
    let [(fast, inner), (slow, outer)] = &given[..] else { panic!("two") };
    let a = |j: &DMatrix<Rational>| j.map(|x| to_f64(&x));
    let (fast, slow, d, h) = (a(fast), a(slow), to_f64(inner), to_f64(outer));
    let kick = |m: &DMatrix<f64>, step: f64| {
        let mut own = DMatrix::identity(2 * n, 2 * n);
        own.view_mut((n, 0), (n, n)).copy_from(&(-step * m));
        own
    };
    let (mut drift, mut fade) = (DMatrix::identity(2 * n, 2 * n), DMatrix::identity(2 * n, 2 * n));
    for i in 0..n {
        drift[(i, n + i)] = d / 2.0;
        fade[(n + i, n + i)] = (-friction * d).exp();
    }
    let step = kick(&fast, d / 2.0) * &drift * fade * &drift * kick(&fast, d / 2.0);
    let times = i32::try_from((outer / inner).to_integer()).unwrap();
    let inner = (0..times).fold(DMatrix::identity(2 * n, 2 * n), |q, _| &step * q);
    let whole = kick(&slow, h / 2.0) * inner * kick(&slow, h / 2.0);
    whole.complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max)
}

#[test]
fn advice_tells_of_each_multiple_what_the_steps_add_and_which_friction_masks_it() {
    use kickdrift::advise::{Adds, Scheme, TIMES};
    let (file, _) = alike(&ratio(4, 1));
    let direct = SystemScene::read(&file).unwrap().direct().unwrap().unwrap();
    let scheme = Scheme::new(vec![ratio(1, 2), ratio(4, 1)]).unwrap();
    let friction = ratio(1, 1000);
    let asked = direct.advise(&[scheme], &ratio(1, 20), (None, Some(&friction)), &Limits::default());
    let found = asked.unwrap();
    let (least, most) = found.without_steps.unwrap();
    // (0.415 ± 0.0005 i)/fs² for the pair, to first order; of near motions the root of the roundings is left.
    let own = 0.0005 / (2.0 * 0.415f64.sqrt());
    assert!((least / own - 1.0).abs() < 1e-2 && most - least < 1e-6 * most, "{least} {most} {own}");
    let [at] = &found.schemes[..] else { panic!("one scheme") };
    // A period of 10 fs holds 19 multiples of 1/2 fs.
    assert_eq!(at.ladder.len(), 19);
    let mut told = std::collections::BTreeSet::new();
    for rung in &at.ladder {
        let (_, given) = alike(&rung.outer);
        let (lo, hi) = rung.rate.unwrap();
        let rate = damped_radius(&given, 0.0).ln() / to_f64(&rung.outer);
        assert!(lo - 1e-9 < rate && rate < hi + 1e-9, "{}: {rate} in {lo}..{hi}", rung.outer);
        match rung.adds {
            Adds::Little => assert!(rate < TIMES * most + 1e-9),
            Adds::Much => assert!(rate > TIMES * least - 1e-9),
            Adds::Undecided => {}
        }
        let radius = damped_radius(&given, to_f64(&friction));
        assert_eq!(rung.is_damped, Some(radius < 1.0), "{}: {radius}", rung.outer);
        told.insert(rung.adds.name());
    }
    assert_eq!(told.into_iter().collect::<Vec<_>>(), ["little", "much"]);
    // The least friction that masks, to the part of a hundred by which it is raised.
    let (mask, given) = (at.masking.unwrap(), alike(&ratio(4, 1)).1);
    assert!(damped_radius(&given, mask) < 1.0 && damped_radius(&given, 0.98 * mask) > 1.0);
    // The longest multiple up to which all add little.
    let fails = at.ladder.iter().position(|own| own.adds != Adds::Little || own.in_band != Adds::Little);
    assert_eq!(at.largest, fails.and_then(|k| k.checked_sub(1)).map(|k| at.ladder[k].outer.clone()));
}

#[test]
fn forces_that_do_not_grow_by_themselves_are_to_be_stable_with_their_steps() {
    use kickdrift::advise::{Adds, Scheme};
    // Periods apart: an asymmetry leaves all eigenvalues real.
    let file = json!({"schema": "kickdrift/system/1", "title": "", "time_unit": "fs", "symmetric": false, "masses": [1, 1],
        "potentials": [{"step": "1/2", "stiffness": [["19/50", 0], [0, "1/5"]]}, {"step": 4, "stiffness": [["1/50", "1/100"], ["-1/100", "1/50"]]}]});
    let direct = SystemScene::read(&file.to_string()).unwrap().direct().unwrap().unwrap();
    let schemes = [4, 5].map(|outer| Scheme::new(vec![ratio(1, 2), ratio(outer, 1)]).unwrap());
    let found = direct.advise(&schemes, &ratio(1, 20), (None, None), &Limits::default()).unwrap();
    assert_eq!(found.without_steps, Some((0.0, 0.0)));
    let [four, five] = &found.schemes[..] else { panic!("two schemes") };
    assert_eq!((four.adds, four.rate), (Adds::Little, Some((0.0, 0.0))));
    assert!(five.adds == Adds::Much && five.rate.unwrap().0 > 0.0 && five.masking.is_some());
    // Another number of steps is refused.
    let three = Scheme::new(vec![ratio(1, 2), ratio(1, 1), ratio(4, 1)]).unwrap();
    let refused = direct.advise(&[three], &ratio(1, 20), (None, None), &Limits::default());
    assert_eq!(refused.unwrap_err().field(), "steps");
}
