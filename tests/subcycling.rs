//! Subcycling with held velocities and AVI on levels of elements, against both schemes run step by step.

use kickdrift::number::polynomial::Sturm;
use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::number::{Polynomial, Rational};
use kickdrift::scene::{Span, SystemScene};
use kickdrift::system::{
    Analysis, Holds, Level, Limits, Model, Potential, Route, SparseSubcycles, SparseSystem, Subcycles,
    Symmetric, System,
};
use kickdrift::verdict::Kind;
use nalgebra::DMatrix;
use serde_json::{Value, json};

/// Numbers that repeat.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, n: u64) -> i64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n) as i64
    }

    /// Nested parts of n, each with its substeps.
    fn levels(&mut self, n: usize) -> Vec<Level> {
        let mut fine: Vec<usize> = (0..n).collect();
        let levels = (0..1 + self.below(3)).map(|_| {
            fine.retain(|_| self.below(3) > 0);
            Level { fine: fine.iter().copied().collect(), substeps: 1 + self.below(4) as u32 }
        });
        levels.collect()
    }

    /// One to five masses, a positive semidefinite stiffness BᵀB.
    fn plain(&mut self) -> System {
        let n = 1 + self.below(5) as usize;
        let masses: Vec<_> = (0..n).map(|_| ratio(1 + self.below(4), 1)).collect();
        let factor: Vec<Vec<_>> =
            (0..n).map(|_| (0..n).map(|_| ratio(self.below(9) - 4, 4)).collect()).collect();
        let entry = |i: usize, j: usize| factor.iter().map(|row| &row[i] * &row[j]).sum::<Rational>();
        let stiffness = Symmetric::try_from(&DMatrix::from_fn(n, n, entry)).unwrap();
        let potential = Potential::new(stiffness, ratio(1 + self.below(40), 10));
        System::new(Symmetric::diagonal(&masses), vec![potential]).unwrap()
    }

    /// Two to six bars in a row on a wall, the last node free or held: elements are numbers of lengths.
    fn bars(&mut self) -> (Vec<i64>, bool) {
        ((0..2 + self.below(5)).map(|_| 1 + self.below(4)).collect(), self.below(2) == 0)
    }
}

/// The largest |λ| of a period that begins and ends between kicks of all: `kicks` has how much of the whole step each force takes a substep, how many
/// ticks lie between its kicks, and M⁻¹ times it.
fn radius(kicks: &[(f64, u32, DMatrix<f64>)], ticks: u32, dt: f64) -> f64 {
    let n = kicks[0].2.nrows();
    let mut q = DMatrix::<f64>::identity(2 * n, 2 * n);
    for tick in 0..ticks {
        let x = q.rows(0, n).into_owned();
        for (share, _, force) in kicks.iter().filter(|own| tick % own.1 == 0) {
            let mut v = q.rows_mut(n, n);
            v -= force * &x * (dt * share);
        }
        let moved = q.rows(n, n) * (dt / f64::from(ticks));
        let mut x = q.rows_mut(0, n);
        x += moved;
    }
    q.complex_eigenvalues().iter().fold(0.0, |most: f64, z| most.max(z.norm()))
}

/// Doubles know a pair of nearly equal multipliers to half of their digits.
const STILL: f64 = 1e-9;
const GROWING: f64 = 1e-5;

/// Whether a radius is that of a stable period; `None` where doubles do not tell, as at an edge, where growth is linear.
fn told(radius: f64) -> Option<bool> {
    (!(1.0 + STILL..=1.0 + GROWING).contains(&radius)).then_some(radius < 1.0 + STILL)
}

/// What a verdict and a run both say of stability; `None` where the run does not tell. Exactly at an edge doubles see a radius of 1, give or take
/// the root of their rounding.
fn agreed(found: &Analysis, radius: f64, what: &str) -> Option<bool> {
    if found.kind == Some(Kind::Parabolic) {
        assert!(radius < 1.0 + GROWING, "{radius}");
        return None;
    }
    let stable = told(radius)?;
    assert_eq!(found.is_stable(), stable, "{what}");
    Some(stable)
}

/// Subcycling run by its own words: each degree of freedom kicks when its step is over, by its row of M⁻¹K.
fn held_velocities(plain: &System, levels: &[Level], dt: f64) -> f64 {
    let (n, stiffness) = (plain.size(), &plain.clocks()[0].stiffness);
    let ticks: u32 = levels.iter().map(|own| own.substeps).product();
    let row = |i: usize| {
        let inside = levels.iter().filter(|own| own.fine.contains(&i));
        let substeps: u32 = inside.map(|own| own.substeps).product();
        let entry = |r, j| if r == i { to_f64(&(stiffness.get(r, j) / plain.mass().get(r, r))) } else { 0.0 };
        (1.0 / f64::from(substeps), ticks / substeps, DMatrix::from_fn(n, n, entry))
    };
    radius(&(0..n).map(row).collect::<Vec<_>>(), ticks, dt)
}

#[test]
fn verdicts_on_subcycling_are_those_of_the_scheme_run() {
    let (mut numbers, mut seen) = (Numbers(3), [0, 0]);
    for _ in 0..600 {
        let plain = numbers.plain();
        let levels = numbers.levels(plain.size());
        let (own, clocks) = Subcycles::newmark(plain.clone(), levels.clone()).unwrap();
        assert_eq!(own.levels(), levels);
        let found = clocks.decide(Route::Cheapest, &Limits::default()).unwrap();
        assert!(found.is_proof(), "{plain:?} {levels:?}");
        let radius = held_velocities(&plain, &levels, to_f64(&plain.clocks()[0].step));
        if let Some(stable) = agreed(&found, radius, &format!("{plain:?} {levels:?}")) {
            seen[usize::from(stable)] += 1;
        }
    }
    assert!(seen.iter().all(|&n| n > 100), "{seen:?}");
}

type Exact = DMatrix<Rational>;

fn product(a: &Exact, b: &Exact) -> Exact {
    let entry = |i, j| (0..a.ncols()).map(|k| &a[(i, k)] * &b[(k, j)]).sum::<Rational>();
    DMatrix::from_fn(a.nrows(), b.ncols(), entry)
}

/// Positions after a step from rest, kick by kick in rationals; kicks of half weight at both ends.
fn from_rest(plain: &System, levels: &[Level]) -> Exact {
    let n = plain.size();
    let clock = &plain.clocks()[0];
    let force = DMatrix::from_fn(n, n, |i, j| clock.stiffness.get(i, j) / plain.mass().get(i, i));
    let ticks: u32 = levels.iter().map(|own| own.substeps).product();
    let is_in = |i| move |own: &&Level| own.fine.contains(&i);
    let substeps = |i: usize| levels.iter().filter(is_in(i)).map(|own| own.substeps).product::<u32>();
    let every: Vec<u32> = (0..n).map(|i| ticks / substeps(i)).collect();
    let mut x = DMatrix::from_fn(n, n, |i, j| ratio(i64::from(i == j), 1));
    let mut v = DMatrix::from_fn(n, n, |_, _| ratio(0, 1));
    for tick in 0..=ticks {
        let half = ratio(1, if tick % ticks == 0 { 2 } else { 1 });
        let pull = product(&force, &x);
        for i in (0..n).filter(|&i| tick % every[i] == 0) {
            let step = &clock.step * &half * ratio(every[i].into(), ticks.into());
            (0..n).for_each(|j| v[(i, j)] -= &step * &pull[(i, j)]);
        }
        if tick < ticks {
            let drift = &clock.step / ratio(ticks.into(), 1);
            x.iter_mut().zip(v.iter()).for_each(|(x, v)| *x += &drift * v);
        }
    }
    x
}

/// Whether a matrix is diagonalizable with eigenvalues in (−1, 1): its characteristic polynomial (Faddeev, Le Verrier) without multiple factors has all roots
/// there and is 0 at the matrix.
fn is_within_one(q: &Exact) -> bool {
    let n = q.nrows();
    let plus = |m: &Exact, c: &Rational| {
        DMatrix::from_fn(n, n, |i, j| if i == j { &m[(i, j)] + c } else { m[(i, j)].clone() })
    };
    let zero = DMatrix::from_fn(n, n, |_, _| ratio(0, 1));
    let (mut coefficients, mut m) = (vec![ratio(1, 1)], plus(&zero, &ratio(1, 1)));
    for k in 1..=n {
        let image = product(q, &m);
        let c = -(0..n).map(|i| image[(i, i)].clone()).sum::<Rational>() / ratio(k as i64, 1);
        m = plus(&image, &c);
        coefficients.push(c);
    }
    coefficients.reverse();
    let own = Polynomial::new(coefficients).squarefree();
    let [below, above] = [ratio(-1, 1), ratio(1, 1)];
    let at_matrix = own.coefficients().iter().rev().fold(zero, |sum, c| plus(&product(&sum, q), c));
    [&below, &above].iter().all(|x| own.eval(x) != ratio(0, 1))
        && Some(Sturm::new(&own).count(&below, &above)) == own.degree()
        && at_matrix.iter().all(|x| *x == ratio(0, 1))
}

/// A positive definite stiffness, one to three levels.
fn nested(numbers: &mut Numbers) -> (System, Vec<Level>) {
    loop {
        let plain = numbers.plain();
        let n = plain.size();
        let mut fine: Vec<usize> = (0..n).collect();
        let levels = (0..[1, 2, 3, 3][numbers.below(4) as usize]).map(|_| {
            fine.retain(|_| numbers.below(6) > 0);
            let substeps = [1, 2, 2, 2, 3, 3][numbers.below(6) as usize];
            Level { fine: fine.iter().copied().collect(), substeps }
        });
        let levels: Vec<_> = levels.collect();
        let stiffness = DMatrix::from_fn(n, n, |i, j| to_f64(&plain.clocks()[0].stiffness.get(i, j)));
        if stiffness.symmetric_eigenvalues().min() > 1e-6 {
            return (plain, levels);
        }
    }
}

#[test]
fn exact_verdicts_on_nested_levels_are_those_of_the_scheme_run_in_exact_arithmetic() {
    let (mut numbers, mut seen) = (Numbers(17), [[0; 2]; 4]);
    for case in 0..600 {
        let (plain, levels) = nested(&mut numbers);
        let (_, clocks) = Subcycles::newmark(plain.clone(), levels.clone()).unwrap();
        let stable = is_within_one(&from_rest(&plain, &levels));
        let routes: &[Route] =
            if case % 4 == 0 { &[Route::Cheapest, Route::Exact] } else { &[Route::Cheapest] };
        for &route in routes {
            let found = clocks.decide(route, &Limits::default()).unwrap();
            assert!(found.is_proof() && found.is_stable() == stable, "{plain:?} {levels:?}");
        }
        // Levels that hold something and take substeps.
        let depth = levels.iter().filter(|own| own.substeps > 1 && !own.fine.is_empty()).count();
        seen[depth][usize::from(stable)] += 1;
    }
    assert!(seen.iter().flatten().all(|&n| n >= 15), "{seen:?}");
}

#[test]
fn exact_arithmetic_agrees_with_discs_on_subcycling() {
    let mut numbers = Numbers(5);
    for _ in 0..60 {
        let plain = numbers.plain();
        let levels = numbers.levels(plain.size());
        let (_, clocks) = Subcycles::newmark(plain, levels).unwrap();
        let [cheapest, exact] = [Route::Cheapest, Route::Exact]
            .map(|route| clocks.decide(route, &Limits::default()).unwrap().kind);
        assert_eq!(cheapest, exact);
    }
}

/// A system file of bars in a row, E = ρ = 1.
fn file((lengths, held): &(Vec<i64>, bool), levels: &[Level], step: &str, scheme: &str) -> Value {
    let ends = lengths.iter().scan(0, |x, own| {
        *x += own;
        Some(json!([*x]))
    });
    let nodes: Vec<Value> = std::iter::once(json!([0])).chain(ends).collect();
    let elements: Vec<_> = (0..lengths.len()).map(|e| [e, e + 1]).collect();
    let fixed = if *held { vec![0, lengths.len()] } else { vec![0] };
    let levels: Vec<_> =
        levels.iter().map(|own| json!({"elements": own.fine, "substeps": own.substeps})).collect();
    json!({
        "schema": "kickdrift/system/1", "scheme": scheme, "levels": levels,
        "mesh": {"nodes": nodes, "elements": elements, "fixed": fixed, "young": 1, "density": 1, "step": step},
    })
}

/// AVI run element by element: each kicks both of its nodes when its own step is over.
fn element_by_element((lengths, held): &(Vec<i64>, bool), levels: &[Level], dt: f64) -> f64 {
    let n = lengths.len() - usize::from(*held);
    let length = |e: usize| lengths.get(e).map_or(0.0, |own| *own as f64);
    // Node i + 1 is between elements i and i + 1.
    let mass = |i: usize| (length(i) + length(i + 1)) / 2.0;
    let ticks: u32 = levels.iter().map(|own| own.substeps).product();
    let element = |e: usize| {
        let inside = levels.iter().filter(|own| own.fine.contains(&e));
        let substeps: u32 = inside.map(|own| own.substeps).product();
        let along = |i: usize| f64::from(i + 1 == e) - f64::from(i == e);
        let force = DMatrix::from_fn(n, n, |i, j| along(i) * along(j) / (length(e) * mass(i)));
        (1.0 / f64::from(substeps), ticks / substeps, force)
    };
    radius(&(0..lengths.len()).map(element).collect::<Vec<_>>(), ticks, dt)
}

#[test]
fn verdicts_on_avi_are_those_of_its_elements_run() {
    let (mut numbers, mut seen) = (Numbers(9), [0, 0]);
    for _ in 0..400 {
        let bars = numbers.bars();
        let (levels, step) = (numbers.levels(bars.0.len()), ratio(1 + numbers.below(40), 10));
        let scene = SystemScene::read(&file(&bars, &levels, &step.to_string(), "avi").to_string()).unwrap();
        let found = scene.model().decide(Route::Cheapest, &Limits::default()).unwrap();
        assert!(found.is_proof(), "{bars:?} {levels:?} {step}");
        let radius = element_by_element(&bars, &levels, to_f64(&step));
        if let Some(stable) = agreed(&found, radius, &format!("{bars:?} {levels:?} {step}")) {
            seen[usize::from(stable)] += 1;
        }
    }
    assert!(seen.iter().all(|&n| n > 100), "{seen:?}");
}

#[test]
fn without_substeps_all_schemes_are_verlets() {
    let mut numbers = Numbers(13);
    for _ in 0..40 {
        let (bars, step) = (numbers.bars(), ratio(1 + numbers.below(40), 10).to_string());
        let levels = [Level { fine: [0, 1].into(), substeps: 1 }];
        let kinds = ["lts", "newmark", "avi"].map(|scheme| {
            let scene = SystemScene::read(&file(&bars, &levels, &step, scheme).to_string()).unwrap();
            let told = scene.model().local_steps_summary().unwrap();
            assert_eq!(told.scheme.name(), scheme);
            (scene.model().decide(Route::Cheapest, &Limits::default()).unwrap().kind, told.plain_limit)
        });
        assert!(kinds.iter().all(|own| own.0 == kinds[0].0), "{bars:?} {step}");
        let limits = kinds.map(|own| own.1.unwrap());
        assert!(limits.iter().all(|own| own.0 <= limits[0].1 && limits[0].0 <= own.1), "{limits:?}");
    }
}

/// Two masses of THEORY section 18, A = [[1, −1], [−1, 9]], the second one takes two substeps.
#[test]
fn two_masses_have_two_bands_of_unstable_steps_below_their_limit() {
    let file = json!({
        "schema": "kickdrift/system/1", "masses": [1, 1], "scheme": "newmark",
        "potentials": [{"step": "1/2", "stiffness": [[1, -1], [-1, 9]]}],
        "levels": [{"fine": [1], "substeps": 2}],
    });
    let scene = SystemScene::read(&file.to_string()).unwrap();
    let found =
        scene.intervals(&"outer=1/2..3/2".parse::<Span>().unwrap(), 1e-5, &Limits::default()).unwrap();
    let told: Vec<_> = found.stretches.iter().filter(|own| own.verdict != Holds::NotTold).collect();
    let verdicts: Vec<_> = told.iter().map(|own| own.verdict).collect();
    let [s, u] = [Holds::Stable, Holds::Unstable];
    assert_eq!(verdicts, [s, u, s, u, s, u], "{told:?}");
    // The scheme run on both sides of each edge; what is not told is narrow.
    let (one, levels) = (ratio(1, 1), [Level { fine: [1].into(), substeps: 2 }]);
    let stiffness = Symmetric::try_from(&DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 9.0])).unwrap();
    let plain =
        System::new(Symmetric::diagonal(&[one.clone(), one.clone()]), vec![Potential::new(stiffness, one)]);
    let plain = plain.unwrap();
    for pair in told.windows(2) {
        let (before, after) = (pair[0].hi, pair[1].lo);
        assert!(after - before < 1e-4, "{pair:?}");
        for (dt, own) in [(before - 1e-3, pair[0]), (after + 1e-3, pair[1])] {
            assert_eq!(told_of(held_velocities(&plain, &levels, dt)), own.verdict, "{dt}");
        }
    }
    // Beyond 4/3 the second mass alone, 9 dt²/4 = 4, is at its limit.
    let last = told.last().unwrap();
    assert!((last.lo - 4.0 / 3.0).abs() < 1e-3, "{last:?}");
}

fn told_of(radius: f64) -> Holds {
    told(radius).map_or(Holds::NotTold, |stable| if stable { Holds::Stable } else { Holds::Unstable })
}

#[test]
fn intervals_of_the_bars_in_the_scenes_are_those_of_the_schemes_run() {
    let levels = [Level { fine: [2, 3].into(), substeps: 2 }];
    let bars = (vec![2, 2, 1, 1, 2, 2], true);
    let nodes = [Level { fine: [1, 2, 3].into(), substeps: 2 }];
    let plain = SystemScene::read(&file(&bars, &levels, "1", "lts").to_string()).unwrap();
    let plain = plain.model().local_steps().unwrap().plain().clone();
    for (path, is_avi) in [("data/scenes/bar-avi.json", true), ("data/scenes/subcycled.json", false)] {
        let scene = SystemScene::read(&std::fs::read_to_string(path).unwrap()).unwrap();
        let span = "outer=1..5/2".parse::<Span>().unwrap();
        let found = scene.intervals(&span, 1e-5, &Limits::default()).unwrap();
        let (mut seen, mut open) = ([0, 0], 0);
        for k in 1..300 {
            let dt = 1.0 + 0.005 * f64::from(k);
            let run = if is_avi {
                element_by_element(&bars, &levels, dt)
            } else {
                held_velocities(&plain, &nodes, dt)
            };
            let own = found.stretches.iter().find(|own| own.lo <= dt && dt <= own.hi);
            let verdict = own.map_or(Holds::NotTold, |own| own.verdict);
            match (told(run), verdict) {
                (_, Holds::NotTold) => open += 1,
                (Some(stable), verdict) => {
                    assert_eq!(verdict == Holds::Stable, stable, "{path}: {dt}");
                    seen[usize::from(stable)] += 1;
                }
                (None, _) => {}
            }
        }
        assert!(seen.iter().all(|&n| n > 20) && open < 10, "{path}: {seen:?}, {open} not told");
    }
}

#[test]
fn a_step_of_another_ratio_is_decided_as_a_file_of_that_step() {
    let text = std::fs::read_to_string("data/scenes/subcycled.json").unwrap();
    let scene = SystemScene::read(&text).unwrap();
    for dt in ["169/100", "1697/1000", "17/10", "11/5"] {
        let mut other: Value = serde_json::from_str(&text).unwrap();
        other["mesh"]["step"] = dt.into();
        let other = SystemScene::read(&other.to_string()).unwrap();
        let step: Rational = kickdrift::number::parse::parse_rational("step", dt).unwrap();
        let [here, there] = [
            scene.model().decide_at(&step, &Limits::default()).unwrap(),
            other.model().decide(Route::Cheapest, &Limits::default()).unwrap(),
        ];
        assert_eq!(here.kind, there.kind, "{dt}");
    }
    assert!(matches!(scene.model(), Model::Subcycled(..)));
}

#[test]
fn sparse_subcycling_is_decided_below_its_first_resonance_as_by_exact_arithmetic() {
    let (mut numbers, mut seen, mut edges) = (Numbers(11), [[[0; 3]; 2]; 4], [0; 4]);
    for case in 0..320 {
        let (plain, levels) = nested(&mut numbers);
        let n = plain.size();
        let entry = |i: usize, j: usize| (i, j, to_f64(&plain.clocks()[0].stiffness.get(i, j)));
        let entries: Vec<_> = (0..n).flat_map(|i| (0..=i).map(move |j| entry(i, j))).collect();
        let masses: Vec<f64> = (0..n).map(|i| to_f64(&plain.mass().get(i, i))).collect();
        let sparse = SparseSubcycles::new(&masses, &entries, levels.clone()).unwrap();
        let depth = levels.iter().filter(|own| own.substeps > 1 && !own.fine.is_empty()).count();
        let first = sparse.first_unstable();
        // Of the system in rationals, rounded: the same, or a little wider.
        let (own, _) = Subcycles::newmark(plain.clone(), levels.clone()).unwrap();
        let near = |a: (f64, f64), b: (f64, f64)| a.0 <= b.1 && b.0 <= a.1;
        assert!(own.first_unstable().zip(first).is_none_or(|(a, b)| near(a, b)), "{case}");
        assert_eq!(own.first_unstable().is_some(), first.is_some(), "{case}");
        edges[depth] += usize::from(first.is_some());
        let (lo, hi) = first.unwrap_or((1.0, 1.0));
        assert!(lo <= hi && hi < lo * (1.0 + 1e-5), "{lo} {hi}");
        for share in [0.4, 0.8, 0.999, 1.001, 1.03, 1.2] {
            let dt = (lo * share * 1e6).round();
            let at = vec![Potential::new(plain.clocks()[0].stiffness.clone(), ratio(dt as i64, 1_000_000))];
            let system = System::new(plain.mass().clone(), at).unwrap();
            let truth =
                if is_within_one(&from_rest(&system, &levels)) { Holds::Stable } else { Holds::Unstable };
            let told = sparse.verdict(dt / 1e6);
            seen[depth][usize::from(share < 1.0)][told as usize] += 1;
            assert!(told == Holds::NotTold || told == truth, "{case} {share}: {told:?} {truth:?}");
            assert!(first.is_none() || share > 1.0 || told == Holds::Stable, "{case} {share}");
        }
    }
    // Of every depth.
    for (edges, [above, below]) in edges.into_iter().zip(seen) {
        assert!(edges > 15 && below[Holds::Stable as usize] > 45, "{edges} {below:?}");
        assert!(above[Holds::Unstable as usize] > 20, "{above:?}");
    }
}

#[test]
fn intervals_of_sparse_subcycling_hold_what_is_stable_and_end_where_nothing_is_told() {
    // A chain on walls, its left half fine.
    let stiffness: Vec<_> = (0..40).map(|i| (i, i, 2.0)).chain((1..40).map(|i| (i, i - 1, -1.0))).collect();
    for substeps in 2..6 {
        let level = Level { fine: (0..20).collect(), substeps };
        let masses: Vec<f64> = (0..40).map(|i| if i < 20 { 0.5 } else { 1.0 }).collect();
        let own = SparseSubcycles::new(&masses, &stiffness, vec![level]).unwrap();
        let (lo, hi) = own.first_unstable().unwrap();
        let (plain, _) = own.plain().plain_limit().unwrap();
        assert!(lo > plain && hi < plain * std::f64::consts::FRAC_PI_2 * 1.01, "{substeps}: {lo} {plain}");
        let all = own.stretches((0.1, 3.0)).unwrap();
        let verdicts: Vec<_> = all.iter().map(|own| own.verdict).collect();
        assert_eq!(verdicts[..3], [Holds::Stable, Holds::NotTold, Holds::Unstable], "{substeps}");
        assert_eq!(verdicts.last(), Some(&Holds::NotTold));
        assert_eq!((all[0].lo, all[0].hi, all[2].lo, all[all.len() - 1].hi), (0.1, lo, hi, 3.0));
        for own_stretch in &all {
            let middle = own_stretch.lo + (own_stretch.hi - own_stretch.lo) / 2.0;
            // Between the first two a single step may be told.
            let is_open = own_stretch.verdict == Holds::NotTold;
            assert!(is_open || own.verdict(middle) == own_stretch.verdict, "{middle}");
        }
    }
    assert!(SparseSubcycles::new(&[1.0; 40], &stiffness, Vec::new()).is_err());
    let apart = [0..20, 10..30].map(|fine| Level { fine: fine.collect(), substeps: 2 });
    let error = SparseSubcycles::new(&[1.0; 40], &stiffness, apart.into()).unwrap_err();
    assert_eq!(error.field(), "levels[1].fine");
}

#[test]
fn what_grows_under_sparse_subcycling_grows_as_in_the_scheme_run() {
    let (mut numbers, mut found) = (Numbers(23), 0);
    for case in 0..200 {
        let (plain, levels) = nested(&mut numbers);
        let n = plain.size();
        let stiffness = |i: usize, j: usize| to_f64(&plain.clocks()[0].stiffness.get(i, j));
        let entries: Vec<_> = (0..n).flat_map(|i| (0..=i).map(move |j| (i, j, stiffness(i, j)))).collect();
        let masses: Vec<f64> = (0..n).map(|i| to_f64(&plain.mass().get(i, i))).collect();
        let sparse = SparseSubcycles::new(&masses, &entries, levels.clone()).unwrap();
        let Some((_, hi)) = sparse.first_unstable() else { continue };
        for share in [1.002, 1.02, 1.1] {
            let dt = ratio((hi * share * 1e6).round() as i64, 1_000_000);
            let model = SparseSystem::with_subcycles(sparse.clone(), &dt).unwrap();
            let own = Model::Sparse(Box::new(model)).decide(Route::Cheapest, &Limits::default()).unwrap();
            let modes = &own.parts[0].instabilities;
            assert!(modes.is_empty() || !own.is_stable(), "{case}");
            let radius = held_velocities(&plain, &levels, to_f64(&dt));
            // Proven or not: what grows by as much as that is seen.
            assert!(radius < 1.0 + 1e-3 || !modes.is_empty(), "{case} {share}: {radius}");
            for mode in modes {
                found += 1;
                // Both are known to the root of rounding at worst, near the circle.
                let size = mode.multiplier.size();
                assert!((size / radius - 1.0).abs() < 1e-6, "{case} {share}: {size} {radius}");
                let longest = mode.shape.iter().fold(0.0f64, |most, x| most.max(x.abs()));
                assert_eq!((mode.shape.len(), longest), (n, 1.0));
            }
        }
    }
    assert!(found > 200, "{found}");
}

#[test]
fn the_first_unstable_step_is_told_where_a_resonance_is_hardly_coupled() {
    // The fastest fine motion is at the far wall, sixty springs away from what is coarse: what grows before its half turn is thinner than doubles are.
    let spring = |i: usize| if i < 4 { 40.0 } else { [16.0, 1.0][usize::from(i > 60)] };
    let stiffness: Vec<_> = (0..90)
        .flat_map(|i| [(i, i, spring(i) + spring(i + 1)), (i + 1, i, -spring(i + 1))])
        .filter(|own| own.0 < 90)
        .collect();
    let fine = |i: usize, j: usize| match i.abs_diff(j) {
        0 => spring(i) + spring(i + 1),
        1 => -spring(i.max(j)),
        _ => 0.0,
    };
    let largest = DMatrix::from_fn(70, 70, fine).symmetric_eigenvalues().max();
    for substeps in 2..6 {
        let level = Level { fine: (0..70).collect(), substeps };
        let own = SparseSubcycles::new(&[1.0; 90], &stiffness, vec![level]).unwrap();
        let (lo, hi) = own.first_unstable().expect("proven");
        // p θ = π of the largest eigenvalue, which nalgebra rounds.
        let p = f64::from(substeps);
        let half_turn = 2.0 * p * (std::f64::consts::PI / (2.0 * p)).sin() / largest.sqrt();
        assert!(lo < half_turn * (1.0 + 1e-13) && half_turn * (1.0 - 1e-13) < hi, "{lo} {half_turn} {hi}");
        assert!(hi < lo * (1.0 + 1e-11), "{substeps}: {lo} {hi}");
        let verdicts = [lo, hi * (1.0 + 1e-9)].map(|dt| own.verdict(dt));
        assert_eq!(verdicts, [Holds::Stable, Holds::NotTold], "{substeps}");
        let last = own.stretches((lo / 2.0, 2.0 * hi)).unwrap();
        assert_eq!(last.iter().map(|own| own.verdict).collect::<Vec<_>>(), [Holds::Stable, Holds::NotTold]);
    }
}

#[test]
fn what_these_schemes_have_not_is_refused_by_its_field() {
    let with = |scheme: &str, changes: &[(&str, Value)]| {
        let mut file =
            file(&(vec![1, 1, 2], true), &[Level { fine: [1].into(), substeps: 2 }], "1/2", scheme);
        changes.iter().for_each(|(key, value)| file[*key] = value.clone());
        SystemScene::read(&file.to_string())
    };
    let masses = json!([1, 1]);
    let springs = json!([{"step": 1, "springs": [[0, 1, 1]]}]);
    let nested = json!([{"elements": [1], "substeps": 2}, {"elements": [0], "substeps": 2}]);
    for (scheme, changes, field) in [
        ("newmark", vec![("friction", json!("1/10"))], "friction"),
        ("newmark", vec![("method", json!("molly-short"))], "method"),
        ("newmark", vec![("levels", json!([{"substeps": 2}]))], "levels[0]"),
        ("avi", vec![("method", json!("implicit-explicit"))], "method"),
        ("avi", vec![("levels", json!([{"fine": [0], "substeps": 2}]))], "levels[0]"),
        ("avi", vec![("levels", json!([{"elements": [3], "substeps": 2}]))], "levels[0].elements"),
        ("avi", vec![("levels", json!([{"elements": [0], "substeps": 0}]))], "levels[0].substeps"),
        ("avi", vec![("levels", nested)], "levels[1].fine"),
        ("avi", vec![("mesh", Value::Null), ("masses", masses), ("potentials", springs)], "scheme"),
        ("asynchronous", vec![], "scheme"),
    ] {
        let error = with(scheme, &changes).unwrap_err();
        assert_eq!(error.field(), field, "{error}");
        assert!(!error.to_string().contains('\n'), "{error}");
    }
    let own = with("newmark", &[]).unwrap();
    let error = own.linear_simulation(vec![0.0; 2], vec![0.0; 2]).err().unwrap();
    assert_eq!(error.field(), "scheme");
    // AVI with friction is a system of clocks as any.
    let damped = with("avi", &[("friction", json!("1/10"))]).unwrap();
    assert!(damped.friction(&Limits::default()).unwrap().is_some());
}

/// A document of large subcycling is held by the scheme run from rest, and none of its numbers can be another.
#[test]
fn a_document_of_sparse_subcycling_is_verified_and_no_other_is() {
    use kickdrift::question::{Question, System, Work};
    use kickdrift::recheck::{Claim, Options};
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/input");
    let file: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.join("held.json")).unwrap()).unwrap();
    let asked: System = serde_json::from_value(json!({"file": "held.json", "system": file})).unwrap();
    let arrays = kickdrift::scene::Arrays::from(folder.as_path());
    let work = Work { arrays: Some(&arrays), ..Work::default() };
    let answer = asked.answer(&work).unwrap();
    let text = asked.document(&answer).render(kickdrift::format::Format::Json).unwrap();
    let options = Options { folder: folder.clone(), ..Options::default() };
    let is_held = |text: &str| {
        Claim::read(text)
            .is_ok_and(|own| own.recheck(&options, None).is_ok_and(|own| own.failures.is_empty()))
    };
    assert!(is_held(&text), "{text}");
    let said: Value = serde_json::from_str(&text).unwrap();
    for (place, value) in [
        ("/stable", json!(false)),
        ("/kind", json!("hyperbolic")),
        ("/parts/0/kind", json!("hyperbolic")),
        ("/local_steps/scheme", json!("lts")),
        ("/local_steps/first_unstable/lo", json!(0.7168)),
        ("/local_steps/first_unstable/hi", json!(0.7166)),
        ("/local_steps/plain_limit/lo", json!(0.6)),
        ("/input/system/potentials/0/step", json!("13/20")),
        ("/input/system/levels/0/substeps", json!(3)),
    ] {
        let mut other = said.clone();
        let own = other.pointer_mut(place).unwrap_or_else(|| panic!("{place}: {text}"));
        assert_ne!(*own, value, "{place}");
        *own = value;
        assert!(!is_held(&other.to_string()), "{place}");
    }
}
