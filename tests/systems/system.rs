//! Many degrees of freedom: every route to a verdict against another.

use kickdrift::number::Rational;
use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::propagator::TwoClocks;
use kickdrift::system::{
    Analysis, Evidence, Limits, ManyClocks, Origin, Part, Potential, Route, Symmetric, System, builders,
    decide_by, decide_exact, decide_system, exact_kind, full_period, half_period, middle,
};
use kickdrift::verdict::{Decidable, Kind};
use nalgebra::DMatrix;
use num_traits::{ToPrimitive, Zero};
use proptest::prelude::*;

fn potential(stiffness: Symmetric, step: Rational, phase: Rational) -> Potential {
    Potential { stiffness, step, phase }
}

/// Random systems: n masses, K potentials of random springs, steps of small ratios, phases 0 and 1/2.
fn system(n: usize, clocks: usize) -> impl Strategy<Value = System> {
    let spring = (0..n, 0..=n, 1i64..40);
    let springs = prop::collection::vec(spring, 1..=n + 2);
    let one = (springs, 1i64..7, prop::bool::weighted(0.25));
    let masses = prop::collection::vec(1i64..6, n);
    (masses, prop::collection::vec(one, clocks)).prop_map(move |(masses, potentials)| {
        let mass = Symmetric::diagonal(&masses.iter().map(|&m| ratio(m, 2)).collect::<Vec<_>>());
        let build = |(springs, step, late): (Vec<(usize, usize, i64)>, i64, bool)| {
            let mut k = Symmetric::zero(n);
            for (i, j, stiffness) in springs {
                k.add_spring(i, (j < n && j != i).then_some(j), &ratio(stiffness, 20));
            }
            potential(k, ratio(step, 4), ratio(i64::from(late), 2))
        };
        System::new(mass, potentials.into_iter().map(build).collect()).unwrap()
    })
}

fn any_system(n: std::ops::RangeInclusive<usize>) -> impl Strategy<Value = System> {
    (n, 1usize..=4).prop_flat_map(|(n, clocks)| system(n, clocks))
}

fn block(m: &DMatrix<Rational>, row: usize, column: usize) -> DMatrix<Rational> {
    let n = m.nrows() / 2;
    m.view((row * n, column * n), (n, n)).into_owned()
}

/// The kind over the system's period of what was decided part by part, each over its own: an elliptic part is
/// coexistence where a multiplier is a root of 1 that becomes ±1 (which doubles tell of small systems).
fn over_the_whole_period(analysis: &Analysis) -> Kind {
    let whole = analysis.period.as_rational().unwrap();
    let is_back = |part: &Part| {
        let times = (&whole / part.period.as_rational().unwrap()).to_integer().to_i32().unwrap();
        part.multipliers.iter().any(|own| own.lambda.powi(times).im.abs() < 1e-9)
    };
    let is_back = analysis.parts.iter().any(is_back);
    if analysis.kind.unwrap() == Kind::Elliptic && is_back {
        Kind::Coexistence
    } else {
        analysis.kind.unwrap()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn the_half_period_is_symplectic_and_tells_the_full_one(system in any_system(1..=4)) {
        let (h, q) = (half_period::<Rational>(&system), full_period::<Rational>(&system));
        let [a, b, c, d] = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| block(&h, i, j));
        let n = system.size();
        let identity = DMatrix::<Rational>::identity(n, n);
        prop_assert_eq!(d.transpose() * &a - b.transpose() * &c, identity.clone());
        // Q + 1/Q = diag(2 + 4 S, 2 + 4 Sᵀ), and 1/Q = −J Qᵀ J.
        let [qa, qb, qc, qd] = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| block(&q, i, j));
        let s = b.transpose() * &c;
        let four = |m: &DMatrix<Rational>| m.map(|x| x * ratio(4, 1));
        let two = identity.map(|x| x * ratio(2, 1));
        prop_assert_eq!(&qa + qd.transpose(), &two + four(&s));
        prop_assert_eq!(&qd + qa.transpose(), &two + four(&s.transpose()));
        prop_assert_eq!(qb.transpose(), qb);
        prop_assert_eq!(qc.transpose(), qc);
    }

    #[test]
    fn doubles_and_exact_arithmetic_agree(system in any_system(2..=6)) {
        let exact = decide_exact(&system, &Limits::default()).unwrap();
        let analysis = decide_system(&system, &Limits::default()).unwrap();
        prop_assert!(analysis.is_proof());
        prop_assert_eq!(exact_kind(&system, &Limits::default()).unwrap(), analysis.kind.unwrap());
        prop_assert_eq!(over_the_whole_period(&analysis), exact.kind, "{:?} {:?}", analysis.kind.unwrap(), exact.roots);
        prop_assert_eq!(analysis.is_stable(), exact.kind.is_stable(), "{:?}", exact.roots);
        let (lo, hi) = analysis.growth_rate().unwrap();
        prop_assert_eq!((lo > 0.0, hi > 0.0), (exact.kind == Kind::Hyperbolic, exact.kind == Kind::Hyperbolic));
    }

    #[test]
    fn half_size_multipliers_are_those_of_the_full_propagator(system in any_system(1..=5)) {
        let analysis = decide_system(&system, &Limits::default()).unwrap();
        prop_assume!(analysis.rigid_modes.is_empty() && analysis.parts.len() == 1);
        let q = full_period::<Rational>(&system).map(|x| to_f64(&x));
        let eigenvalues = q.complex_eigenvalues();
        let size = eigenvalues.iter().fold(1.0f64, |a, z| a.max(z.norm()));
        for multiplier in &analysis.parts[0].multipliers {
            let near = eigenvalues.iter().map(|z| (z - multiplier.lambda).norm()).fold(f64::INFINITY, f64::min);
            // A double multiplier of a general 2n x 2n matrix is only good to the root of its roundoff.
            prop_assert!(near < 1e-4 * size, "{near} {multiplier:?} {eigenvalues:?}");
        }
    }

    #[test]
    fn decoupled_oscillators_give_the_union_of_the_scalar_verdicts(
        oscillators in prop::collection::vec((1i64..80, 1i64..40, 1i64..5), 1..5), p in 1u64..8, q in 1u64..5,
        rotation in prop::collection::vec((0usize..5, 0usize..5, 1i64..4), 0..3),
    ) {
        let n = oscillators.len();
        let (h1, h2) = (ratio(1, 2), ratio(p as i64, 2 * q as i64));
        let diagonal = |pick: fn(&(i64, i64, i64)) -> Rational| {
            Symmetric::diagonal(&oscillators.iter().map(pick).collect::<Vec<_>>())
        };
        let mass = diagonal(|o| ratio(o.2, 1));
        let (fast, slow) = (diagonal(|o| ratio(o.0, 8)), diagonal(|o| ratio(o.1, 30)));
        let build = |mass: Symmetric, fast: Symmetric, slow: Symmetric| {
            let potentials = vec![potential(fast, h1.clone(), ratio(0, 1)), potential(slow, h2.clone(), ratio(0, 1))];
            System::new(mass, potentials).unwrap()
        };
        let scalar = |o: &(i64, i64, i64)| {
            let ratio_of_steps = &h2 / &h1;
            let strength = |h: &Rational, k: Rational| &h1 * h * k / ratio(o.2, 1);
            let (s, k) = (strength(&h1, ratio(o.0, 8)), strength(&h2, ratio(o.1, 30)));
            if h1 == h2 { return Decidable::half_signs(&TwoClocks::new("1/1".parse().unwrap(), s + k, Rational::zero())).verdict().kind(); }
            Decidable::half_signs(&TwoClocks::new((&ratio_of_steps).try_into().unwrap(), s, k)).verdict().kind()
        };
        let severity = |kind: &Kind| [Kind::Elliptic, Kind::Coexistence, Kind::Parabolic, Kind::Hyperbolic].iter().position(|k| k == kind).unwrap();
        let expected = oscillators.iter().map(scalar).max_by_key(severity).unwrap();
        let plain = build(mass.clone(), fast.clone(), slow.clone());
        prop_assert_eq!(decide_system(&plain, &Limits::default()).unwrap().kind.unwrap(), expected);
        prop_assert_eq!(decide_exact(&plain, &Limits::default()).unwrap().kind, expected);
        // Rational rotations: (3/5, 4/5) and the like, in several planes.
        let mut columns: Vec<Vec<Rational>> = (0..n).map(|i| (0..n).map(|j| ratio(i64::from(i == j), 1)).collect()).collect();
        for (i, j, t) in rotation.into_iter().filter(|(i, j, _)| i != j && *i < n && *j < n) {
            let (c, s) = (ratio(t * t - 4, t * t + 4), ratio(4 * t, t * t + 4));
            let (u, v) = (columns[i].clone(), columns[j].clone());
            columns[i] = u.iter().zip(&v).map(|(x, y)| x * &c + y * &s).collect();
            columns[j] = u.iter().zip(&v).map(|(x, y)| y * &c - x * &s).collect();
        }
        let turned = build(mass.congruent(&columns), fast.congruent(&columns), slow.congruent(&columns));
        prop_assert_eq!(decide_exact(&turned, &Limits::default()).unwrap().kind, expected);
        prop_assert_eq!(decide_system(&turned, &Limits::default()).unwrap().kind.unwrap(), expected);
    }

    #[test]
    fn rotating_coordinates_changes_nothing(system in system(3, 3), t in 1i64..5) {
        let (c, s) = (ratio(t * t - 4, t * t + 4), ratio(4 * t, t * t + 4));
        let zero = || ratio(0, 1);
        let columns = vec![vec![c.clone(), s.clone(), zero()], vec![-s, c, zero()], vec![zero(), zero(), ratio(1, 1)]];
        let turn = |p: &Potential| Potential { stiffness: p.stiffness.congruent(&columns), ..p.clone() };
        let turned = System::new(system.mass().congruent(&columns), system.clocks().iter().map(turn).collect()).unwrap();
        let (one, two) = (decide_exact(&system, &Limits::default()).unwrap(), decide_exact(&turned, &Limits::default()).unwrap());
        prop_assert_eq!(one.kind, two.kind);
        prop_assert_eq!(one.roots, two.roots);
        prop_assert_eq!(decide_system(&turned, &Limits::default()).unwrap().kind.unwrap(), one.kind);
    }

    #[test]
    fn equal_clocks_are_one_clock_with_the_sum(k in prop::collection::vec(1i64..60, 1..5), h in 1i64..9) {
        let steps = vec![ratio(1, 1); k.len()];
        let phases = vec![ratio(0, 1); k.len()];
        let strength = |k: i64| ratio(h * h * k, 200);
        let many = ManyClocks::new(&steps, &phases, k.iter().map(|&k| strength(k)).collect()).unwrap();
        let one = ManyClocks::new(&steps[..1], &phases[..1], vec![strength(k.iter().sum())]).unwrap();
        prop_assert_eq!(many.half_signs().verdict(), one.half_signs().verdict());
        prop_assert_eq!(many.trace(), one.trace());
        let single = |k: i64| potential(Symmetric::diagonal(&[ratio(k, 200)]), ratio(h, 1), ratio(0, 1));
        let system = System::new(Symmetric::diagonal(&[ratio(1, 1)]), k.iter().map(|&k| single(k)).collect()).unwrap();
        prop_assert_eq!(system.clocks().len(), 1);
        prop_assert_eq!(decide_system(&system, &Limits::default()).unwrap().kind.unwrap(), one.half_signs().verdict().kind());
    }

    #[test]
    fn two_of_many_clocks_are_the_two_clocks(p in 1i64..12, q in 1i64..12, s in 1i64..400, k in -90i64..200) {
        let many = ManyClocks::new(&[ratio(1, 1), ratio(p, q)], &[ratio(0, 1), ratio(0, 1)], vec![ratio(s, 90), ratio(k, 70)]).unwrap();
        let two = many.as_two_clocks().unwrap();
        prop_assert_eq!(many.half_signs().verdict(), Decidable::half_signs(&two).verdict());
        let growth = kickdrift::verdict::growth(&two, many.half_signs().verdict(), &Default::default()).unwrap();
        prop_assert!(growth.trace.contains(&many.trace()));
        prop_assert_eq!(growth.label, many.label());
    }

    #[test]
    fn scalar_systems_of_many_clocks_agree_with_their_signs(system in (1usize..=4).prop_flat_map(|k| system(1, k))) {
        let clocks = system.as_many_clocks().unwrap();
        let analysis = decide_system(&system, &Limits::default()).unwrap();
        prop_assert_eq!(analysis.kind.unwrap(), clocks.half_signs().verdict().kind());
        prop_assert_eq!(decide_exact(&system, &Limits::default()).unwrap().kind, analysis.kind.unwrap());
        let mu = (clocks.trace() - ratio(2, 1)) / ratio(4, 1);
        let multiplier = analysis.parts[0].multipliers[0];
        let off = (to_f64(&mu) - multiplier.mu.re).abs();
        prop_assert!(off <= multiplier.radius.unwrap() * 1.01 + 1e-15 * to_f64(&mu).abs());
    }
}

/// Whether doubles proved the verdict.
fn is_in_doubles(evidence: Evidence) -> bool {
    matches!(evidence, Evidence::Signs | Evidence::Discs)
}

/// The verdict by `verdict`'s own ladder, on the sums of springs of one step.
fn by_the_ladder(springs: &[(i64, i64)]) -> Kind {
    let steps: Vec<i64> =
        springs.iter().map(|s| s.1).collect::<std::collections::BTreeSet<_>>().into_iter().collect();
    let strength =
        |h: &i64| ratio(springs.iter().filter(|s| s.1 == *h).map(|s| s.0).sum::<i64>() * h * steps[0], 10);
    let two = match steps.as_slice() {
        [one] => TwoClocks::new("1/1".parse().unwrap(), strength(one), Rational::zero()),
        [a, b] => TwoClocks::new((&ratio(*b, *a)).try_into().unwrap(), strength(a), strength(b)),
        _ => unreachable!("two steps"),
    };
    kickdrift::verdict::decide(&two, &Default::default()).unwrap().verdict.kind()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    // Ledger: exact systems; 200 random masses on springs, new in each run; the verdict on two clocks
    #[test]
    fn one_mass_has_the_verdict_of_verdict_cancelling_springs_included(
        springs in prop::collection::vec((-4i64..=4, 1i64..=2), 1..5), mass_first in any::<bool>(),
    ) {
        // Springs that cancel leave a drift, not a rigid mode; only a mass without any spring is one.
        prop_assume!(springs.iter().any(|s| s.0 != 0));
        let single = |&(k, h): &(i64, i64)| potential(Symmetric::diagonal(&[ratio(k, 10)]), ratio(h, 1), ratio(0, 1));
        let system = System::new(Symmetric::diagonal(&[ratio(1, 1)]), springs.iter().map(single).collect()).unwrap();
        let analysis = decide_system(&system, &Limits::default()).unwrap();
        prop_assert_eq!(analysis.kind.unwrap(), by_the_ladder(&springs));
        prop_assert_eq!(analysis.rigid_modes.len(), 0);
        prop_assert_eq!(decide_exact(&system, &Limits::default()).unwrap().kind, analysis.kind.unwrap());
        // Beside another mass that is stable, coupled by what cancels.
        let place = usize::from(mass_first);
        let beside = |&(k, h): &(i64, i64)| {
            let mut stiffness = Symmetric::zero(2);
            stiffness.add(place, place, &ratio(k, 10));
            potential(stiffness, ratio(h, 1), ratio(0, 1))
        };
        let mut coupling = Symmetric::zero(2);
        coupling.add(0, 1, &ratio(1, 1));
        let mut other = Symmetric::zero(2);
        other.add(1 - place, 1 - place, &ratio(1, 10));
        let extra = [coupling.clone(), coupling.scaled(&ratio(-1, 1)), other].map(|k| potential(k, ratio(1, 1), ratio(0, 1)));
        let all = springs.iter().map(beside).chain(extra).collect();
        let system = System::new(Symmetric::diagonal(&[ratio(1, 1), ratio(1, 1)]), all).unwrap();
        let analysis = decide_system(&system, &Limits::default()).unwrap();
        prop_assert_eq!(analysis.kind.unwrap(), by_the_ladder(&springs));
        prop_assert_eq!(analysis.rigid_modes.len(), 0);
        prop_assert_eq!(decide_exact(&system, &Limits::default()).unwrap().kind, analysis.kind.unwrap());
    }

    // Ledger: exact systems; 200 random systems, new in each run; the exact full period
    #[test]
    fn random_systems_of_potentials_that_may_cancel_have_the_verdict_of_the_full_period(
        (n, entries) in (2usize..=3).prop_flat_map(|n| {
            (Just(n), prop::collection::vec((0..n, 0..n, -3i64..=6, 1i64..=2), 1..6))
        }),
    ) {
        let one = |&(i, j, k, h): &(usize, usize, i64, i64)| {
            let mut stiffness = Symmetric::zero(n);
            stiffness.add_spring(i, (i != j).then_some(j), &ratio(k, 12));
            potential(stiffness, ratio(h, 1), ratio(0, 1))
        };
        // Every other spring is taken back by a potential of its own.
        let back = entries.iter().step_by(2).map(|&(i, j, k, h)| (i, j, -k, h)).collect::<Vec<_>>();
        let potentials: Vec<_> = entries.iter().chain(&back).map(one).collect();
        let system = System::new(Symmetric::diagonal(&vec![ratio(1, 1); n]), potentials.clone()).unwrap();
        let analysis = decide_system(&system, &Limits::default()).unwrap();
        // Rigid: null vectors of the matrix of all potentials, one below the other.
        let rows = potentials.iter().flat_map(|p| (0..n).map(|i| (0..n).map(|j| to_f64(&p.stiffness.get(i, j))).collect::<Vec<_>>())).collect::<Vec<_>>();
        let stacked = DMatrix::from_fn(rows.len(), n, |i, j| rows[i][j]);
        prop_assert_eq!(analysis.rigid_modes.len(), n - stacked.rank(1e-9));
        // Each rigid mode is one Jordan block of Q at 1, ker (Q - 1)^2 = 2 rigid; what is left decides.
        let q = full_period::<Rational>(&system);
        let hyperbolic = q.map(|x| to_f64(&x)).complex_eigenvalues().iter().any(|z| z.norm() > 1.0 + 1e-3);
        if hyperbolic {
            prop_assert_eq!(analysis.kind.unwrap(), Kind::Hyperbolic);
        } else if analysis.kind.unwrap() != Kind::Hyperbolic {
            let minus = |q: &DMatrix<Rational>, x: i64| q - DMatrix::<Rational>::identity(2 * n, 2 * n).map(|e| e * ratio(x, 1));
            let jordan = |x: i64| {
                let m = minus(&q, x);
                let square = &m * &m;
                exact_rank(&m) - exact_rank(&square)
            };
            let defects = jordan(1) + jordan(-1);
            prop_assert_eq!(analysis.kind.unwrap() == Kind::Parabolic, defects > analysis.rigid_modes.len(), "{}", defects);
        }
    }
}

/// The rank over the rationals.
fn exact_rank(m: &DMatrix<Rational>) -> usize {
    let (mut m, mut rank) = (m.clone(), 0);
    for column in 0..m.ncols() {
        let Some(pivot) = (rank..m.nrows()).find(|&i| !m[(i, column)].is_zero()) else { continue };
        m.swap_rows(rank, pivot);
        for i in rank + 1..m.nrows() {
            let factor = &m[(i, column)] / &m[(rank, column)];
            for j in column..m.ncols() {
                let product = &factor * &m[(rank, j)];
                m[(i, j)] -= product;
            }
        }
        rank += 1;
    }
    rank
}

#[test]
fn rigid_motion_is_set_apart_and_not_called_unstable() {
    // Three free masses: one rigid mode; velocity Verlet well inside its limit.
    let mut k = Symmetric::zero(3);
    k.add_spring(0, Some(1), &ratio(1, 1));
    k.add_spring(1, Some(2), &ratio(2, 1));
    let mass = Symmetric::diagonal(&[ratio(1, 1), ratio(2, 1), ratio(3, 1)]);
    let system = System::new(mass, vec![potential(k, ratio(1, 2), ratio(0, 1))]).unwrap();
    let analysis = decide_system(&system, &Limits::default()).unwrap();
    assert_eq!(analysis.rigid_modes, vec![vec![ratio(1, 1); 3]]);
    assert_eq!(analysis.kind.unwrap(), Kind::Elliptic);
    assert_eq!(decide_exact(&system, &Limits::default()).unwrap().kind, Kind::Elliptic);
}

#[test]
fn a_zero_mode_that_is_not_common_to_all_potentials_is_parabolic_or_worse() {
    // K_1 + K_2 = 0: no net force, but kicks at different times; and a free mass with a null kick.
    let spring = |k: i64| Symmetric::diagonal(&[ratio(k, 10)]);
    let mass = Symmetric::diagonal(&[ratio(1, 1)]);
    let potentials =
        vec![potential(spring(1), ratio(1, 1), ratio(0, 1)), potential(spring(-1), ratio(2, 1), ratio(0, 1))];
    let system = System::new(mass, potentials).unwrap();
    let analysis = decide_system(&system, &Limits::default()).unwrap();
    assert!(analysis.rigid_modes.is_empty());
    assert_eq!(analysis.kind.unwrap(), system.as_many_clocks().unwrap().half_signs().verdict().kind());
}

#[test]
fn an_indefinite_stiffness_is_computed_with_a_warning() {
    let mut k = Symmetric::zero(2);
    k.add_spring(0, Some(1), &ratio(1, 1));
    k.add_spring(0, None, &ratio(-1, 4));
    let system = System::new(
        Symmetric::diagonal(&[ratio(1, 1), ratio(1, 1)]),
        vec![potential(k, ratio(1, 2), ratio(0, 1))],
    )
    .unwrap();
    let analysis = decide_system(&system, &Limits::default()).unwrap();
    assert_eq!(analysis.kind.unwrap(), Kind::Hyperbolic);
    assert!(analysis.warnings[0].contains("indefinite"));
}

#[test]
fn double_modes_on_and_off_the_edge_are_decided_exactly() {
    // Two equal oscillators, coupled to nothing but written in rotated coordinates with a third, and a Verlet
    // step on the limit h² L = 4 for both: a double Jordan block.
    let at = |l: i64| {
        let mass = Symmetric::diagonal(&[ratio(1, 1), ratio(1, 1)]);
        System::new(
            mass,
            vec![potential(Symmetric::diagonal(&[ratio(l, 1), ratio(l, 1)]), ratio(1, 1), ratio(0, 1))],
        )
        .unwrap()
    };
    for (l, kind) in [(3, Kind::Elliptic), (4, Kind::Parabolic), (5, Kind::Hyperbolic)] {
        assert_eq!(decide_exact(&at(l), &Limits::default()).unwrap().kind, kind);
        assert_eq!(decide_system(&at(l), &Limits::default()).unwrap().kind.unwrap(), kind);
    }
    // The closing of 5/3 in two copies: Q = I.
    let (fast, slow) = (ratio(11, 4), ratio(11, 4) * ratio(114, 55));
    let twice = |k: &Rational| Symmetric::diagonal(&[k.clone(), k.clone()]);
    let potentials = vec![
        potential(twice(&fast), ratio(1, 1), ratio(0, 1)),
        potential(twice(&slow), ratio(5, 3), ratio(0, 1)),
    ];
    let system = System::new(Symmetric::diagonal(&[ratio(1, 1), ratio(1, 1)]), potentials).unwrap();
    let exact = decide_exact(&system, &Limits::default()).unwrap();
    assert_eq!((exact.kind, exact.roots.at_zero), (Kind::Coexistence, 2));
    assert_eq!(decide_system(&system, &Limits::default()).unwrap().kind.unwrap(), Kind::Coexistence);
}

#[test]
fn a_collision_of_two_modes_is_named_with_its_resonance() {
    // Two modes coupled by a slow kick whose frequency is the sum of theirs: w_1 + w_2 = 2 pi/h_2.
    let fast = Symmetric::diagonal(&[ratio(1, 1), ratio(4, 1)]);
    let mut slow = Symmetric::zero(2);
    slow.add(0, 1, &ratio(1, 5));
    let step = ratio(2094, 1000); // 2 pi/3 = 2.0944
    let potentials =
        vec![potential(fast, &step / ratio(40, 1), ratio(0, 1)), potential(slow, step.clone(), ratio(0, 1))];
    let system = System::new(Symmetric::diagonal(&[ratio(1, 1), ratio(1, 1)]), potentials).unwrap();
    let analysis = decide_system(&system, &Limits::default()).unwrap();
    assert_eq!(analysis.kind.unwrap(), Kind::Hyperbolic);
    assert!(is_in_doubles(analysis.parts[0].evidence));
    let instability = &analysis.parts[0].instabilities[0];
    assert_eq!(instability.origin, Origin::Collision);
    let resonance = instability.resonance.as_ref().unwrap();
    assert_eq!((resonance.sign, resonance.m), (1, 1));
    assert_eq!(resonance.family, vec![0, 1]);
    assert!(resonance.detuning.abs() < 0.05);
}

#[test]
fn large_chains_and_bars_are_proven_in_doubles() {
    let stiffness = [ratio(4, 1), ratio(2, 1), ratio(1, 2)];
    let steps = [ratio(1, 4), ratio(3, 10), ratio(7, 20)];
    let chain = builders::periodic_chain(200, &stiffness, &steps).unwrap();
    let bar = builders::graded_bar(100, 10, &ratio(1, 4)).unwrap();
    assert_eq!((chain.clocks().len(), bar.clocks().len()), (3, 10));
    for system in [chain, bar] {
        let analysis = decide_system(&system, &Limits::default()).unwrap();
        assert_eq!(analysis.kind.unwrap(), Kind::Elliptic);
        assert!(is_in_doubles(analysis.parts[0].evidence));
    }
}

/// From here on the bound through the projection past a rigid mode is too wide for double eigenvalues.
const LARGE: usize = 60;

/// A ring of n unit masses, springs stiff and soft in turn, the first mass heavier by `extra`; large ones are
/// tied to walls.
fn ring(n: usize, [stiff, soft]: [&Rational; 2], steps: [Rational; 2], extra: Rational) -> System {
    let (mut fast, mut slow) = (Symmetric::zero(n), Symmetric::zero(n));
    for i in 0..n {
        let (k, size) = if i % 2 == 0 { (&mut fast, stiff) } else { (&mut slow, soft) };
        k.add_spring(i, Some((i + 1) % n), size);
        if n > LARGE {
            slow.add_spring(i, None, &ratio(1, 4));
        }
    }
    let masses: Vec<_> = (0..n).map(|i| if i == 0 { ratio(1, 1) + &extra } else { ratio(1, 1) }).collect();
    let [h1, h2] = steps;
    let potentials = vec![potential(fast, h1, ratio(0, 1)), potential(slow, h2, ratio(0, 1))];
    System::new(Symmetric::diagonal(&masses), potentials).unwrap()
}

#[test]
fn double_eigenvalues_of_one_sign_are_proven_in_doubles() {
    // No sum of two frequencies reaches 2 pi/T.
    let steps = || [ratio(1, 10), ratio(1, 5)];
    for n in [18, 40, LARGE, 200] {
        let analysis = decide_system(
            &ring(n, [&ratio(4, 1), &ratio(1, 1)], steps(), ratio(0, 1)),
            // Enough to compose, and not for exact arithmetic.
            &Limits { products: 30_000_000, ..Limits::default() },
        );
        let analysis = analysis.unwrap();
        let part = &analysis.parts[0];
        let rigid = usize::from(n <= LARGE);
        assert_eq!((analysis.kind.unwrap(), part.evidence), (Kind::Elliptic, Evidence::Signs), "{n}");
        assert_eq!(analysis.rigid_modes.len(), rigid);
        let twice =
            part.multipliers.windows(2).filter(|pair| (pair[0].mu - pair[1].mu).norm() < 1e-9).count();
        assert!(twice >= n / 2 - 2, "{twice}");
    }
    // Exact arithmetic says the same; and where double eigenvalues leave the circle nothing is proven stable.
    let small = ring(12, [&ratio(4, 1), &ratio(1, 1)], steps(), ratio(0, 1));
    assert_eq!(decide_exact(&small, &Limits::default()).unwrap().kind, Kind::Elliptic);
    let resonant = ring(18, [&ratio(4, 1), &ratio(1, 1)], [ratio(1, 4), ratio(5, 2)], ratio(0, 1));
    let analysis = decide_system(&resonant, &Limits::default()).unwrap();
    assert_eq!(analysis.kind.unwrap(), Kind::Hyperbolic);
    assert!(is_in_doubles(analysis.parts[0].evidence));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn clusters_never_contradict_exact_arithmetic(
        cells in 3usize..=5, stiff in 1i64..40, soft in 1i64..20, h in 1i64..10, p in 1i64..7, q in 1i64..4,
    ) {
        let steps = [ratio(h, 16), ratio(h * p, 16 * q)];
        let system = ring(2 * cells, [&ratio(stiff, 4), &ratio(soft, 4)], steps, ratio(0, 1));
        let exact = decide_exact(&system, &Limits::default()).unwrap();
        let analysis = decide_system(&system, &Limits::default()).unwrap();
        prop_assert_eq!(analysis.kind.unwrap(), exact.kind, "{:?} {:?}", analysis.parts[0].evidence, exact.roots);
    }
}

/// Waves around a ring of five come in pairs: each multiplier is there twice.
#[test]
fn counts_of_multipliers_have_their_multiplicities() {
    let system = ring(5, [&ratio(1, 1), &ratio(1, 1)], [ratio(1, 4), ratio(1, 4)], ratio(0, 1));
    let exact = decide_exact(&system, &Limits::default()).unwrap();
    assert_eq!((exact.roots.inside, exact.kind), (4, Kind::Elliptic));
}

#[test]
fn the_exact_route_counts_every_root_or_tells_its_cost() {
    let system = ring(8, [&ratio(4, 1), &ratio(1, 1)], [ratio(1, 4), ratio(3, 5)], ratio(1, 2));
    let analysis = decide_by(Route::Exact, &system, &Limits::default()).unwrap();
    let part = &analysis.parts[0];
    assert_eq!((part.evidence, part.roots.unwrap().inside), (Evidence::Exact, 7));
    assert_eq!(decide_system(&system, &Limits::default()).unwrap().kind.unwrap(), analysis.kind.unwrap());
    let error = decide_by(Route::Exact, &system, &Limits { products: 10, ..Limits::default() }).unwrap_err();
    assert_eq!(error.kind(), kickdrift::error::Kind::Budget);
    assert!(error.to_string().contains("products of machine words"), "{error}");
}

#[test]
fn a_large_unstable_chain_is_proven_and_explained() {
    // The fast springs beyond their Verlet limit h² · 2 k = 4 somewhere.
    let chain =
        builders::alternating_chain(60, [&ratio(9, 1), &ratio(1, 1)], [&ratio(1, 2), &ratio(3, 4)]).unwrap();
    let analysis = decide_system(&chain, &Limits::default()).unwrap();
    assert_eq!(analysis.kind.unwrap(), Kind::Hyperbolic);
    assert!(is_in_doubles(analysis.parts[0].evidence));
    let instabilities = &analysis.parts[0].instabilities;
    assert!(!instabilities.is_empty());
    for instability in instabilities {
        assert!(instability.growth_rate.unwrap().0 > 0.0);
        assert!(instability.shape.contains(&1.0) && instability.shape.len() == 60);
    }
}

#[test]
fn exact_arithmetic_reaches_twelve_degrees_of_freedom() {
    let stiffness = [ratio(4, 1), ratio(2, 1), ratio(1, 2)];
    for (steps, kind) in [
        ([ratio(1, 4), ratio(3, 10), ratio(7, 20)], Kind::Elliptic),
        ([ratio(1, 4), ratio(3, 10), ratio(3, 1)], Kind::Hyperbolic),
    ] {
        let chain = builders::periodic_chain(12, &stiffness, &steps).unwrap();
        let start = std::time::Instant::now();
        let exact = decide_exact(&chain, &Limits::default()).unwrap();
        println!("n = 12, {} kicks: {:?}", chain.schedule().strikes(), start.elapsed());
        assert_eq!(exact.kind, kind);
        let analysis = decide_system(&chain, &Limits::default()).unwrap();
        assert_eq!(analysis.kind.unwrap(), kind);
        assert!(is_in_doubles(analysis.parts[0].evidence));
    }
    let chain =
        builders::periodic_chain(12, &stiffness, &[ratio(1, 4), ratio(1, 997), ratio(7, 20)]).unwrap();
    let error = decide_exact(&chain, &Limits { products: 1000, ..Limits::default() }).unwrap_err();
    assert_eq!(error.kind(), kickdrift::error::Kind::Budget);
    assert!(error.needed().is_some(), "{error}");
}

#[test]
fn bad_systems_are_refused_by_name() {
    let message = |result: kickdrift::error::Result<System>| result.unwrap_err().to_string();
    let unit = || Symmetric::diagonal(&[ratio(1, 1), ratio(1, 1)]);
    let good = || potential(unit(), ratio(1, 2), ratio(0, 1));
    let mass = Symmetric::diagonal(&[ratio(1, 1), ratio(0, 1)]);
    assert!(message(System::new(mass, vec![good()])).starts_with("masses[1] = 0: a mass must be positive"));
    let size = potential(Symmetric::zero(3), ratio(1, 2), ratio(0, 1));
    assert!(message(System::new(unit(), vec![good(), size])).starts_with("potentials[1].stiffness = 3 x 3"));
    let step = Potential { step: ratio(0, 1), ..good() };
    assert!(message(System::new(unit(), vec![step])).starts_with("potentials[0].step = 0"));
    let phase = Potential { phase: ratio(1, 3), ..good() };
    assert!(message(System::new(unit(), vec![phase])).starts_with("potentials[0].phase = 1/3"));
    let dense = Symmetric::dense("K", &[vec![ratio(1, 1), ratio(2, 1)], vec![ratio(3, 1), ratio(1, 1)]]);
    assert!(dense.unwrap_err().to_string().starts_with("K[1][0] = 3: differs from K[0][1] = 2"));
    let short = Symmetric::dense("K", &[vec![ratio(1, 1), ratio(2, 1)], vec![ratio(2, 1)]]);
    assert!(short.unwrap_err().to_string().starts_with("K[1] = 1 entries"));
}

/// Two elements of a bar, lengths 3 and 2, its ends fixed: one mass of half of each, with C l/c for the step
/// of each.
fn two_elements(courant: &Rational) -> System {
    let spring = |length: i64| {
        let stiffness = Symmetric::diagonal(&[ratio(1, length)]);
        Potential::new(stiffness, courant * ratio(length, 1))
    };
    System::new(Symmetric::diagonal(&[ratio(5, 2)]), vec![spring(3), spring(2)]).unwrap()
}

#[test]
fn a_smaller_courant_number_can_destabilize_a_bar() {
    let decide = |thousandths: i64| {
        let analysis = decide_system(&two_elements(&ratio(thousandths, 10_000)), &Limits::default()).unwrap();
        assert!(analysis.is_proof());
        analysis
    };
    for courant in [10_000, 9_500, 8_859, 8_557, 8_000, 5_000] {
        assert!(decide(courant).is_stable(), "{courant}");
    }
    for courant in [8_559, 8_600, 8_700, 8_800, 8_857] {
        assert!(!decide(courant).is_stable(), "{courant}");
    }
    // Tenfold in 77.3 of the slow steps, 3 C.
    let steps = 10f64.ln() / (middle(decide(8_700).growth_rate().unwrap()) * 3.0 * 0.87);
    assert!((steps - 77.3).abs() < 0.05, "{steps}");
}
