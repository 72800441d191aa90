//! Intervals of numbers of exact systems hold what exact verdicts say, and the point itself parts its neighbourhood.

use kickdrift::number::Rational;
use kickdrift::number::rational::{from_f64_exact, ratio};
use kickdrift::scene::SystemScene;
use kickdrift::system::levels::{Hessians, Kernel, Outer};
use kickdrift::system::nearest::Nearest;
use kickdrift::system::stretches::Stretch;
use kickdrift::system::{Holds, Limits, exact_kind};
use nalgebra::DMatrix;
use serde_json::{Value, json};

/// Numbers that repeat.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, n: u64) -> i64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n) as i64
    }

    /// One to four degrees of freedom under one to three clocks, some stiffnesses indefinite.
    fn system(&mut self) -> Value {
        let (n, clocks) = (1 + self.below(4) as usize, 1 + self.below(3));
        let masses: Vec<String> = (0..n).map(|_| (1 + self.below(3)).to_string()).collect();
        let step = |k: i64| ["1", "3/2", "2"][k as usize];
        let potentials: Vec<Value> = (0..clocks)
            .map(|k| {
                let mut rows = vec![vec![String::new(); n]; n];
                for (i, j) in (0..n).flat_map(|i| (0..=i).map(move |j| (i, j))) {
                    let (size, off) = if k == 0 { (24, if i == j { 0 } else { 12 }) } else { (12, 5) };
                    let entry = format!("{}/{}", self.below(size) - off, if i == j { 10 } else { 40 });
                    (rows[i][j], rows[j][i]) = (entry.clone(), entry);
                }
                json!({"step": step(k), "scale": "1", "stiffness": rows})
            })
            .collect();
        json!({"schema": "kickdrift/system/1", "masses": masses, "potentials": potentials})
    }
}

fn scene(source: &Value) -> SystemScene {
    SystemScene::from_json_in("", source.clone()).unwrap()
}

/// The file with one number replaced.
fn with(source: &Value, path: &str, value: &Rational) -> SystemScene {
    let mut file = source.clone();
    if path != "outer" {
        let keys: Vec<&str> = path.split('.').collect();
        let mut turned = keys.clone();
        if keys[0] == "mass_matrix" {
            turned.swap(1, 2);
        }
        for keys in [keys, turned] {
            *file.pointer_mut(&format!("/{}", keys.join("/"))).unwrap() = value.to_string().into();
        }
        return scene(&file);
    }
    let steps: Vec<Rational> =
        file["potentials"].as_array().unwrap().iter().map(|own| number(&own["step"])).collect();
    let outer = steps.iter().max().unwrap().clone();
    for (own, step) in file["potentials"].as_array_mut().unwrap().iter_mut().zip(steps) {
        own["step"] = (step * value / &outer).to_string().into();
    }
    scene(&file)
}

fn number(value: &Value) -> Rational {
    value.as_str().unwrap().parse().unwrap()
}

/// How much of a range is left open by stretches that cover it, in order, from lo to hi.
fn open(all: &[Stretch], (lo, hi): (f64, f64), what: &str) -> f64 {
    assert!(all[0].lo == lo && all[all.len() - 1].hi == hi, "{what}: {all:?}");
    for pair in all.windows(2) {
        let [a, b] = pair else { unreachable!("two") };
        assert!(a.hi == b.lo && a.verdict != b.verdict, "{what}: {pair:?}");
    }
    let open = all.iter().filter(|own| own.verdict == Holds::NotTold);
    open.map(|own| own.hi - own.lo).sum()
}

/// Each stretch with a verdict holds at this many numbers in it, its ends among them, by characteristic polynomials.
fn assert_true(source: &Value, path: &str, all: &[Stretch], count: i64, numbers: &mut Numbers) -> usize {
    let mut seen = 0;
    for own in all.iter().filter(|own| own.verdict != Holds::NotTold) {
        let (lo, hi) = (from_f64_exact(own.lo).unwrap(), from_f64_exact(own.hi).unwrap());
        let inside = (0..count).map(|_| &lo + (&hi - &lo) * ratio(1 + numbers.below(998), 999));
        for value in [lo.clone(), hi.clone()].into_iter().chain(inside) {
            let kind = exact_kind(with(source, path, &value).model().system(), &Limits::default()).unwrap();
            let stable = kind.is_stable();
            assert_eq!(stable, own.verdict == Holds::Stable, "{path} = {value}: {kind:?} {own:?} {source}");
            seen += 1;
        }
    }
    seen
}

/// Random systems: intervals of a mass, of a scale and of the outer step, true, and nine tenths of all decided.
fn compared(count: usize, points: i64) -> usize {
    let (mut numbers, mut seen) = (Numbers(11), 0);
    let (mut left_open, mut whole) = (0.0, 0.0);
    for _ in 0..count {
        let source = numbers.system();
        for (path, range, ends) in [
            ("masses.0", "1/2..3", (0.5, 3.0)),
            ("potentials.0.scale", "1/4..2", (0.25, 2.0)),
            ("outer", "1/2..4", (0.5, 4.0)),
        ] {
            let span = format!("{path}={range}").parse().unwrap();
            let found = scene(&source).intervals(&span, 1e-2, &Limits::default()).unwrap();
            left_open += open(&found.stretches, ends, &format!("{path} of {source}")) / ends.1;
            whole += (ends.1 - ends.0) / ends.1;
            seen += assert_true(&source, path, &found.stretches, points, &mut numbers);
        }
    }
    assert!(left_open < 0.1 * whole, "{left_open} of {whole}");
    seen
}

#[test]
fn intervals_of_random_exact_systems_agree_with_exact_verdicts() {
    assert!(compared(25, 2) > 300);
}

#[test]
#[ignore = "some minutes"]
fn intervals_of_a_thousand_random_exact_systems_agree_with_exact_verdicts() {
    println!("{} numbers in the intervals of 1,000 systems, all equal", compared(1000, 4));
}

#[test]
fn masses_and_steps_of_the_tethered_molecule_are_decided_to_the_resolution() {
    let text = std::fs::read_to_string("data/scenes/diatomic-tether.json").unwrap();
    let source: Value = serde_json::from_str(&text).unwrap();
    for (path, range, ends) in [("masses.0", "1/2..1", (0.5, 1.0)), ("outer", "3/10..9/20", (0.3, 0.45))] {
        let found = scene(&source)
            .intervals(&format!("{path}={range}").parse().unwrap(), 1e-2, &Limits::default())
            .unwrap();
        // Edges are open by far less than the resolution.
        assert!(open(&found.stretches, ends, path) < 1e-2 * ends.1, "{found:?}");
        assert!(assert_true(&source, path, &found.stretches, 20, &mut Numbers(3)) > 20);
    }
}

/// One entry of a mass matrix that is not diagonal, on the diagonal and off it.
#[test]
fn intervals_of_masses_off_the_diagonal_agree_with_exact_verdicts() {
    let (mut numbers, mut seen) = (Numbers(23), 0);
    for _ in 0..12 {
        let mut source = numbers.system();
        let n = source["masses"].as_array().unwrap().len();
        if n == 1 {
            continue;
        }
        // Rows that their diagonal exceeds.
        let entry = |i: usize, j: usize| if i == j { 2 + n as i64 } else { 1 };
        let rows: Vec<Vec<String>> =
            (0..n).map(|i| (0..n).map(|j| format!("{}/2", entry(i, j))).collect()).collect();
        source.as_object_mut().unwrap().remove("masses");
        source["mass_matrix"] = json!(rows);
        for (path, range, ends) in
            [("mass_matrix.0.0", "3/2..4", (1.5, 4.0)), ("mass_matrix.1.0", "-3/4..5/4", (-0.75, 1.25))]
        {
            let span = format!("{path}={range}").parse().unwrap();
            let found = scene(&source).intervals(&span, 1e-2, &Limits::default()).unwrap();
            open(&found.stretches, ends, &format!("{path} of {source}"));
            seen += assert_true(&source, path, &found.stretches, 2, &mut numbers);
        }
    }
    assert!(seen > 20, "{seen}");
}

/// Fast frequencies of 1 and of √−0.001, both in the slow field: stable at seven and a half, unstable a little below.
#[test]
fn the_unstable_intervals_next_to_a_stable_number_do_not_hold_it() {
    let (fast, slow) =
        (DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, -0.001]), DMatrix::from_diagonal_element(2, 2, 0.05));
    let kernel = Kernel::new(&Hessians::new(&fast, &slow, 0.0).unwrap()).unwrap();
    let (number, inner) = (7.5, 6);
    let own = kernel.decide(&Outer::new(number, inner).unwrap(), &ratio(15, 2), 1e-9).holds();
    assert_eq!(own, Holds::Stable);
    let found = Nearest::search((number, own), |range| kernel.stretches(inner, range, 1e-4, 0.0)).unwrap();
    assert!(found.own.is_none(), "{found:?}");
    let below = found.below.unwrap();
    assert!(below.proven.0 < 5.73 && below.proven.1 > 5.99 && below.proven.1 < 7.5, "{below:?}");
    assert!(below.within.1.unwrap() < 7.5, "{below:?}");
    let open: f64 = found.untold.iter().map(|(lo, hi)| hi - lo).sum();
    assert!(open < 1e-2, "{found:?}");
}

/// Where many modes are in one resonance, counts at both ends of a cell decide.
#[test]
fn chains_are_unstable_where_counts_prove_it_and_every_number_agrees() {
    let steps = ["1/4", "3/10", "7/20"];
    let own = scene(&json!({
        "schema": "kickdrift/system/1",
        "build": {"kind": "chain", "masses": 30, "stiffness": ["4", "2", "1/2"], "steps": steps},
    }));
    let limits = Limits { products: 200_000_000, ..Limits::default() };
    let found = own.intervals(&"outer=22/25..19/20".parse().unwrap(), 1e-2, &limits).unwrap();
    let unstable = || found.stretches.iter().filter(|own| own.verdict == Holds::Unstable);
    let length: f64 = unstable().map(|own| own.hi - own.lo).sum();
    assert!(length > 0.05, "{found:?}");
    for stretch in unstable() {
        for k in 0..=20 {
            let outer = stretch.lo + (stretch.hi - stretch.lo) * f64::from(k) / 20.0;
            let own = own.model().decide_at(&from_f64_exact(outer).unwrap(), &Limits::default()).unwrap();
            assert!(!own.is_stable(), "{outer} in {stretch:?}");
        }
    }
}

/// The search alone, on intervals that are known.
mod nearest {
    use kickdrift::system::Holds;
    use kickdrift::system::nearest::{Nearest, Unstable};
    use kickdrift::system::stretches::{Stretch, merged};

    /// Unstable in the given intervals and untold in the last, cells of one piece each.
    fn covered(unstable: &[(f64, f64)], untold: &[(f64, f64)], (lo, hi): (f64, f64)) -> Vec<Stretch> {
        let mut marks: Vec<f64> = unstable.iter().chain(untold).flat_map(|(a, b)| [*a, *b]).collect();
        marks.extend([lo, hi]);
        marks.retain(|x| (lo..=hi).contains(x));
        marks.sort_by(f64::total_cmp);
        marks.dedup();
        let holds = |x: f64| {
            let is_in = |all: &[(f64, f64)]| all.iter().any(|(a, b)| *a < x && x < *b);
            match (is_in(unstable), is_in(untold)) {
                (true, _) => Holds::Unstable,
                (_, true) => Holds::NotTold,
                _ => Holds::Stable,
            }
        };
        let stretch =
            |ends: &[f64]| Stretch { lo: ends[0], hi: ends[1], verdict: holds((ends[0] + ends[1]) / 2.0) };
        merged(marks.windows(2).map(stretch))
    }

    #[test]
    fn the_next_intervals_are_found_whole_and_what_holds_the_number_is_no_neighbour() {
        let unstable = [(0.6, 0.7), (1.5, 1.6), (1.8, 1.85)];
        let untold = [(0.59, 0.6), (0.7, 0.71), (1.49, 1.5), (1.6, 1.61), (1.2, 1.21)];
        let found =
            Nearest::search((1.0, Holds::Stable), |range| Ok(covered(&unstable, &untold, range))).unwrap();
        let below = Unstable { proven: (0.6, 0.7), within: (Some(0.59), Some(0.71)) };
        let above = Unstable { proven: (1.5, 1.6), within: (Some(1.49), Some(1.61)) };
        assert_eq!((found.own, found.below, found.above), (None, Some(below), Some(above)));
        assert_eq!(found.untold, [(1.2, 1.21)]);
        assert!(found.searched.0 < 0.59 && found.searched.1 > 1.61 && found.searched.1 <= 2.0, "{found:?}");
        let inside =
            Nearest::search((1.55, Holds::Unstable), |range| Ok(covered(&unstable, &untold, range))).unwrap();
        assert_eq!(inside.own, Some(above));
        assert_eq!(inside.above.unwrap().proven, (1.8, 1.85));
        // 0.6 is below half of it.
        assert!(inside.below.is_none() && inside.searched.0 == 1.55 / 2.0, "{inside:?}");
        let alone =
            Nearest::search((1.0, Holds::Stable), |range| Ok(covered(&[(1.7, 3.0)], &[], range))).unwrap();
        assert_eq!(alone.above, Some(Unstable { proven: (1.7, 2.0), within: (Some(1.7), None) }));
        assert_eq!((alone.below, alone.searched), (None, (0.5, 2.0)));
    }
}

#[test]
fn what_intervals_cost_is_asked_before_them_by_the_library_too() {
    let text = include_str!("../data/scenes/water4.json");
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes");
    let scene = SystemScene::from_json_in(folder, serde_json::from_str(text).unwrap()).unwrap();
    let limits = Limits { products: 30_000_000, ..Limits::default() };
    let span = "outer=0.001..0.005".parse().unwrap();
    for error in [
        scene.intervals(&span, 1e-4, &limits).unwrap_err(),
        scene.nearest_unstable(1e-4, &limits).unwrap_err(),
    ] {
        assert!(
            error.kind() == kickdrift::error::Kind::Budget && error.needed() > Some(30_000_000),
            "{error}"
        );
        assert!(error.to_string().contains("choose a shorter range or a larger resolution"), "{error}");
    }
}
