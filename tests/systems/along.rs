//! Hessians along an orbit, each known to an accuracy: what is proven of all within it, against exact
//! arithmetic on some of these.

use std::ops::AddAssign;

use kickdrift::number::Rational;
use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::schedule::Schedule;
use kickdrift::system::{Along, Body, Limits, MeasuredSystem, Model, Route, middle};
use nalgebra::DMatrix;

/// Numbers that repeat.
struct Numbers(u64);

impl Numbers {
    /// Between these.
    fn within(&mut self, lo: f64, hi: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        lo + (hi - lo) * (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, n: i64) -> i64 {
        self.within(0.0, n as f64) as i64
    }
}

/// Symmetric, of this 2-norm at most.
fn noise(random: &mut Numbers, n: usize, size: f64) -> DMatrix<f64> {
    let own = DMatrix::from_fn(n, n, |_, _| random.within(-1.0, 1.0));
    let own = &own + own.transpose();
    let norm = own.clone().svd(false, false).singular_values.max().max(1e-300);
    own * (size * random.within(0.5, 1.0) / norm)
}

/// Positive definite but for a few, about this large.
fn stiffness(random: &mut Numbers, n: usize, size: f64) -> DMatrix<f64> {
    let own = DMatrix::from_fn(n, n, |_, _| random.within(-1.0, 1.0));
    (&own * own.transpose()) * size + DMatrix::identity(n, n) * (0.2 * size)
}

/// How often each of some clocks kicks in half a period, both its ends counted.
fn strikes(steps: &[Rational]) -> Vec<usize> {
    let schedule = Schedule::new(steps, &vec![ratio(0, 1); steps.len()]).unwrap();
    let of = |clock| schedule.half_period().filter(|event| event.clocks().any(|own| own == clock)).count();
    (0..steps.len()).map(of).collect()
}

/// ln |λ| of the fastest over half a period's kicks and the same backwards, by dense products: no symplectic
/// structure is used.
fn growth(masses: &[f64], steps: &[Rational], kicks: &[Vec<DMatrix<f64>>]) -> f64 {
    let n = masses.len();
    let schedule = Schedule::new(steps, &vec![ratio(0, 1); steps.len()]).unwrap();
    let tick = to_f64(schedule.tick());
    let mut next = vec![0; kicks.len()];
    let mut shears = Vec::new();
    for event in schedule.half_period() {
        let mut drift = DMatrix::<f64>::identity(2 * n, 2 * n);
        (0..n).for_each(|i| drift[(i, n + i)] = tick * event.drift as f64 / masses[i]);
        let mut kick = DMatrix::<f64>::identity(2 * n, 2 * n);
        for clock in event.clocks() {
            let own = &kicks[clock][next[clock]] * (-0.5 * to_f64(&steps[clock]));
            next[clock] += 1;
            kick.view_mut((n, 0), (n, n)).add_assign(own);
        }
        shears.push((drift, kick));
    }
    let last = shears.len() - 1;
    let mut period = DMatrix::<f64>::identity(2 * n, 2 * n);
    for (k, (drift, kick)) in shears.iter().enumerate() {
        // A kick at an end is half as strong as one between: those are made twice.
        period = drift * period;
        period = kick * period;
        if k != 0 && k != last {
            period = kick * period;
        }
    }
    for (k, (drift, kick)) in shears.iter().enumerate().rev() {
        period = kick * period;
        if k != 0 && k != last {
            period = kick * period;
        }
        period = drift * period;
    }
    period.complex_eigenvalues().iter().map(|z| z.norm().ln()).fold(0.0, f64::max)
}

// Ledger: along the orbit; 400 random orbits, seed 30; exact arithmetic on Hessians within the accuracy
#[test]
fn what_is_proven_within_the_accuracy_is_so_by_exact_arithmetic_of_what_lies_within_it() {
    let mut random = Numbers(30);
    let (mut told, mut open, mut near) = ([0, 0], 0, 0);
    let none = Limits::default();
    for case in 0..400 {
        let (n, clocks) = (1 + random.below(3) as usize, 1 + random.below(3));
        let mut steps = vec![ratio(1, 4)];
        for _ in 1..clocks {
            let last = steps.last().unwrap().clone();
            steps.push(last * ratio(3 + random.below(5), 2));
        }
        if strikes(&steps).iter().sum::<usize>() > 14 {
            continue;
        }
        let masses: Vec<f64> = (0..n).map(|_| random.within(0.5, 3.0)).collect();
        let accuracy = 0.09 * 10f64.powi(-random.below(7) as i32);
        // Hessians that change along the orbit by a tenth, now and then by all of their size.
        let changes = [0.1, 0.1, 1.0][case % 3];
        let kicks: Vec<Vec<DMatrix<f64>>> = strikes(&steps)
            .iter()
            .zip(&steps)
            .map(|(count, step)| {
                let size = random.within(0.02, 2.0) / to_f64(step).powi(2);
                let mean = stiffness(&mut random, n, size);
                (0..*count).map(|_| &mean + noise(&mut random, n, changes * size)).collect()
            })
            .collect();
        let own = Along::new(&masses, &steps, &kicks).unwrap().at_accuracy(accuracy).unwrap();
        let found = own.decide(Route::Cheapest, &none).unwrap();
        let within = found.measured.clone().unwrap();
        // Another set of Hessians as far from these as they are said to be known: mass-weighted norms.
        let root = DMatrix::from_diagonal(&nalgebra::DVector::from_vec(masses.clone()).map(f64::sqrt));
        let inverse = root.clone().try_inverse().unwrap();
        let mut perturbed = |share: f64| -> Vec<Vec<DMatrix<f64>>> {
            let mut of = |k: &DMatrix<f64>| {
                let size = (&inverse * k * &inverse).svd(false, false).singular_values.max();
                let off = &root * noise(&mut random, n, 0.999 * share * size) * &root;
                let off = (&off + off.transpose()) / 2.0;
                k + off
            };
            kicks.iter().map(|own| own.iter().map(&mut of).collect()).collect()
        };
        let exact = |kicks: &[Vec<DMatrix<f64>>]| {
            Along::new(&masses, &steps, kicks).unwrap().decide(Route::Exact, &none).unwrap()
        };
        let truth = exact(&kicks);
        if let Some(kind) = found.kind {
            assert_eq!(kind.is_stable(), truth.is_stable(), "{case}");
        }
        let (lo, hi) = found.growth_rate().unwrap_or((0.0, f64::INFINITY));
        let period = found.period.to_f64();
        let given = growth(&masses, &steps, &kicks) / period;
        assert!(lo - 1e-6 <= given && given <= hi + 1e-6, "{case}: {given} in {lo}..{hi}");
        let mut differ = false;
        for _ in 0..2 {
            let other = perturbed(accuracy);
            let truth = exact(&other);
            match within.holds.is_stable() {
                Some(is_stable) => assert_eq!(is_stable, truth.is_stable(), "{case}"),
                None => differ |= found.kind.is_some_and(|kind| kind.is_stable() != truth.is_stable()),
            }
            if found.is_unstable() {
                let own = growth(&masses, &steps, &other) / period;
                assert!(lo - 1e-6 <= own && own <= hi + 1e-6, "{case}: {own} in {lo}..{hi}");
            }
        }
        match within.holds.is_stable() {
            Some(is_stable) => told[usize::from(is_stable)] += 1,
            None => open += 1,
        }
        near += usize::from(differ);
        // Up to its margin, too; beyond it nothing is said.
        if let (Some(margin), Some(kind)) = (within.margin, found.kind) {
            assert_eq!(exact(&perturbed(margin)).is_stable(), kind.is_stable(), "{case}: {margin}");
            assert_eq!(within.holds.is_stable().is_some(), margin >= accuracy, "{case}");
        }
    }
    eprintln!("unstable {}, stable {}, open {open}, of these really both ways {near}", told[0], told[1]);
    assert!(told[0] > 60 && told[1] > 100 && open > 20 && open < 140 && near > 2, "{told:?} {open} {near}");
}

#[test]
fn a_molecule_at_rest_is_decided_along_its_orbit_as_at_its_minimum() {
    let mut random = Numbers(7);
    let limits = Limits::default();
    let (mut unstable, mut proven) = (0, 0);
    for case in 0..60 {
        let atoms = 4;
        let masses: Vec<f64> = (0..atoms).map(|_| random.within(1.0, 16.0)).collect();
        let place = |random: &mut Numbers| std::array::from_fn(|_| random.within(-1.0, 1.0));
        let positions: Vec<[f64; 3]> = (0..atoms).map(|_| place(&mut random)).collect();
        let mut bonds = |least: f64, most: f64| {
            let mut k = DMatrix::<f64>::zeros(3 * atoms, 3 * atoms);
            for i in 0..atoms {
                for j in 0..i {
                    let along: [f64; 3] = std::array::from_fn(|a| positions[i][a] - positions[j][a]);
                    let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
                    let strength = random.within(least, most);
                    let mut u = DMatrix::<f64>::zeros(3 * atoms, 1);
                    for a in 0..3 {
                        (u[3 * i + a], u[3 * j + a]) = (along[a] / length, -along[a] / length);
                    }
                    k += &u * u.transpose() * strength;
                }
            }
            k
        };
        let pair = [bonds(20.0, 60.0), bonds(0.5, 4.0)];
        let step = ratio(20 + random.below(40), 100);
        let steps = [&step / Rational::from_integer(4.into()), step];
        let kicks: Vec<Vec<DMatrix<f64>>> =
            strikes(&steps).iter().zip(&pair).map(|(count, k)| vec![k.clone(); *count]).collect();
        let of_dofs: Vec<f64> = masses.iter().flat_map(|m| [*m; 3]).collect();
        let along = Along::new(&of_dofs, &steps, &kicks).unwrap().at_accuracy(1e-9).unwrap();
        let own = along.clone().turning([&positions, &positions]).unwrap();
        let found = own.decide(Route::Cheapest, &limits).unwrap();
        // The same motions as columns, sums of each other.
        let sums = DMatrix::from_fn(12, 6, |i, k| {
            found.rigid_modes[..=k].iter().map(|own| to_f64(&own[i])).sum::<f64>()
        });
        let named = along.free_of(&[sums.clone(), sums]).unwrap().decide(Route::Cheapest, &limits).unwrap();
        assert_eq!(named.measured.as_ref().unwrap().holds, found.measured.as_ref().unwrap().holds);
        let [a, b] = [&named, &found].map(|own| own.growth_rate().map_or(0.0, middle));
        assert!((a - b).abs() <= 1e-9 * (1.0 + b), "{case}: {a} {b}");
        let body =
            Body { masses: Some(of_dofs.clone()), positions: Some(positions.clone()), ..Body::default() };
        let given = steps.iter().cloned().zip(pair.iter().cloned()).collect();
        let model = MeasuredSystem::new(body, given, 1e-9).unwrap();
        let minimum = model.decide(Route::Cheapest, &limits).unwrap();
        assert_eq!(found.rigid_modes.len(), 6);
        let holds = [&found, &minimum].map(|own| own.measured.as_ref().unwrap().holds.is_stable());
        if let [Some(a), Some(b)] = holds {
            assert_eq!(a, b, "{case}");
            let [a, b] = [&found, &minimum].map(|own| own.growth_rate().map_or(0.0, middle));
            assert!((a - b).abs() <= 1e-6 * (1.0 + b), "{case}: {a} {b}");
            assert!((own.growth_of_period() - b).abs() <= 1e-5 * (1.0 + b), "{case}");
            unstable += usize::from(b > 0.0);
            proven += 1;
        }
        // No Hessians near these are free to turn about other axes.
        let mut moved = positions.clone();
        moved[0][0] += 0.5;
        let elsewhere = Along::new(&of_dofs, &steps, &kicks).unwrap().at_accuracy(1e-9).unwrap();
        let elsewhere = elsewhere.turning([&moved, &moved]).unwrap();
        assert_eq!(elsewhere.decide(Route::Cheapest, &limits).unwrap_err().field(), "positions");
    }
    eprintln!("{proven} proven by both, {unstable} of them unstable");
    assert!(proven > 50 && unstable > 3, "{proven} {unstable}");
}

#[test]
fn what_does_not_fit_is_named() {
    let (steps, one) = ([ratio(1, 2), ratio(1, 1)], DMatrix::<f64>::identity(2, 2));
    let kicks = |counts: [usize; 2]| counts.map(|count| vec![one.clone(); count]).to_vec();
    let field = |masses: &[f64], steps: &[Rational], kicks: &[Vec<DMatrix<f64>>]| {
        Along::new(masses, steps, kicks).map(|_| ()).unwrap_err().field().to_string()
    };
    assert_eq!(field(&[1.0, 1.0], &steps, &kicks([3, 1])), "potentials[0].stiffness");
    assert_eq!(field(&[1.0, 1.0], &steps, &kicks([2, 2])), "potentials[1].stiffness");
    assert_eq!(field(&[1.0, -1.0], &steps, &kicks([2, 1])), "masses[1]");
    assert_eq!(field(&[1.0, 1.0], &[ratio(1, 1), ratio(1, 1)], &kicks([2, 1])), "potentials");
    let own = Along::new(&[1.0, 1.0], &steps, &kicks([2, 1])).unwrap();
    assert_eq!(own.clone().at_accuracy(0.2).unwrap_err().field(), "accuracy");
    assert_eq!(own.clone().turning([&[[0.0; 3]], &[[0.0; 3]]]).unwrap_err().field(), "masses");
    let columns = |rows: usize, columns: usize| DMatrix::from_element(rows, columns, 1.0);
    for ends in [
        vec![],
        vec![columns(2, 1)],
        vec![columns(3, 1); 2],
        vec![columns(2, 0); 2],
        vec![columns(2, 1), columns(2, 2)],
        vec![columns(2, 2); 2],
        vec![columns(2, 1), columns(2, 1) * 0.0],
    ] {
        assert_eq!(own.clone().free_of(&ends).unwrap_err().field(), "rigid", "{ends:?}");
    }
    assert!(own.free_of(&[columns(2, 1), columns(2, 1)]).is_ok());
}

/// One triangle of a matrix is no Hessian along an orbit, and neither is what is off by more than the
/// accuracy.
#[test]
fn hessians_along_an_orbit_that_are_not_symmetric_are_refused_by_their_entry() {
    use kickdrift::scene::{Array, Arrays, SystemScene};
    let read = |off: f64| {
        let kick = [2.0, off, 0.0, 2.0];
        let array = Array::new(vec![2, 2, 2], [kick, [2.0, 0.0, 0.0, 2.0]].concat()).unwrap();
        let held = Arrays::Held(std::sync::Arc::new([("k".to_string(), array)].into()));
        let file = serde_json::json!({
            "schema": "kickdrift/system/1", "along_orbit": true, "masses": [1, 1], "accuracy": 1e-6, "keep_rigid": true,
            "potentials": [{"step": "1/4", "stiffness": {"npz": "a.npz", "array": "k"}}],
        });
        SystemScene::from_json_in(held, file)
    };
    let error = read(1e-4).unwrap_err();
    assert_eq!(error.field(), "potentials[0].stiffness[0][1][0]", "{error}");
    assert!(error.to_string().contains("differs from [0][1] by 1e-4"), "{error}");
    // Within the accuracy its symmetric part is taken, and what else is wrong is no longer this.
    assert!(read(1e-8).map_or_else(|error| !error.to_string().contains("differs"), |_| true));
}
