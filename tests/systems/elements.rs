//! AVI on levels of elements, against the scheme run step by step.

use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::scene::{Span, SystemScene};
use kickdrift::system::{Analysis, Holds, Level, Limits, Route};
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

    /// Two to six bars in a row on a wall, the last node free or held: elements are numbers of lengths.
    fn bars(&mut self) -> (Vec<i64>, bool) {
        ((0..2 + self.below(5)).map(|_| 1 + self.below(4)).collect(), self.below(2) == 0)
    }
}

/// The largest |λ| of a period that begins and ends between kicks of all: `kicks` has how much of the whole
/// step each force takes a substep, how many ticks lie between its kicks, and M⁻¹ times it.
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

/// Whether a radius is that of a stable period; `None` where doubles do not tell, as at an edge, where growth
/// is linear.
fn told(radius: f64) -> Option<bool> {
    (!(1.0 + STILL..=1.0 + GROWING).contains(&radius)).then_some(radius < 1.0 + STILL)
}

/// What a verdict and a run both say of stability; `None` where the run does not tell. Exactly at an edge
/// doubles see a radius of 1, give or take the root of their rounding.
fn agreed(found: &Analysis, radius: f64, what: &str) -> Option<bool> {
    if found.kind == Some(Kind::Parabolic) {
        assert!(radius < 1.0 + GROWING, "{radius}");
        return None;
    }
    let stable = told(radius)?;
    assert_eq!(found.is_stable(), stable, "{what}");
    Some(stable)
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

// Ledger: asynchronous elements; 400 random bars, seed 9; the scheme run element by element
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
fn without_substeps_both_schemes_are_verlets() {
    let mut numbers = Numbers(13);
    for _ in 0..40 {
        let (bars, step) = (numbers.bars(), ratio(1 + numbers.below(40), 10).to_string());
        let levels = [Level { fine: [0, 1].into(), substeps: 1 }];
        let kinds = ["lts", "avi"].map(|scheme| {
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

#[test]
fn intervals_of_the_bar_in_the_scenes_are_those_of_the_scheme_run() {
    let levels = [Level { fine: [2, 3].into(), substeps: 2 }];
    let bars = (vec![2, 2, 1, 1, 2, 2], true);
    let path = "data/scenes/bar-avi.json";
    let scene = SystemScene::read(&std::fs::read_to_string(path).unwrap()).unwrap();
    let span = "outer=1..5/2".parse::<Span>().unwrap();
    let found = scene.intervals(&span, 1e-5, &Limits::default()).unwrap();
    let (mut seen, mut open) = ([0, 0], 0);
    for k in 1..300 {
        let dt = 1.0 + 0.005 * f64::from(k);
        let own = found.stretches.iter().find(|own| own.lo <= dt && dt <= own.hi);
        let verdict = own.map_or(Holds::Undecided, |own| own.verdict);
        match (told(element_by_element(&bars, &levels, dt)), verdict) {
            (_, Holds::Undecided) => open += 1,
            (Some(stable), verdict) => {
                assert_eq!(verdict == Holds::Stable, stable, "{dt}");
                seen[usize::from(stable)] += 1;
            }
            (None, _) => {}
        }
    }
    assert!(seen.iter().all(|&n| n > 20) && open < 10, "{seen:?}, {open} not told");
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
        ("newmark", vec![], "scheme"),
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
    // AVI with friction is a system of clocks as any.
    let damped = with("avi", &[("friction", json!("1/10"))]).unwrap();
    assert!(damped.friction(&Limits::default()).unwrap().is_some());
}
