//! Intervals of numbers of exact systems leave nothing open, and the point itself parts its neighbourhood.

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

/// Stretches that are closed, in order, from lo to hi, with nothing but neighbouring doubles between them and
/// nothing open.
fn assert_whole(all: &[Stretch], (lo, hi): (f64, f64), what: &str) {
    assert!(all[0].lo == lo && all[all.len() - 1].hi == hi, "{what}: {all:?}");
    assert!(all.iter().all(|own| own.verdict != Holds::Undecided && own.lo <= own.hi), "{what}: {all:?}");
    for pair in all.windows(2) {
        let [a, b] = pair else { unreachable!("two") };
        assert!(a.hi.next_up() == b.lo && a.verdict != b.verdict, "{what}: {pair:?}");
    }
}

/// Each stretch holds at this many numbers in it, its ends among them, by characteristic polynomials.
fn assert_true(source: &Value, path: &str, all: &[Stretch], count: i64, numbers: &mut Numbers) -> usize {
    let mut seen = 0;
    for own in all {
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

/// Random systems: intervals of a mass, of a scale and of the outer step, whole and true.
fn compared(count: usize, points: i64) -> usize {
    let (mut numbers, mut seen) = (Numbers(11), 0);
    for _ in 0..count {
        let source = numbers.system();
        for (path, range, ends) in [
            ("masses.0", "1/2..3", (0.5, 3.0)),
            ("potentials.0.scale", "1/4..2", (0.25, 2.0)),
            ("outer", "1/2..4", (0.5, 4.0)),
        ] {
            let span = format!("{path}={range}").parse().unwrap();
            let found = scene(&source).intervals(&span, 1e-2, &Limits::default()).unwrap();
            assert_whole(&found.stretches, ends, &format!("{path} of {source}"));
            seen += assert_true(&source, path, &found.stretches, points, &mut numbers);
        }
    }
    seen
}

#[test]
fn intervals_of_random_exact_systems_leave_nothing_open_and_agree_with_exact_verdicts() {
    assert!(compared(25, 2) > 300);
}

#[test]
#[ignore = "some minutes"]
fn intervals_of_a_thousand_random_exact_systems_agree_with_exact_verdicts() {
    println!("{} numbers in the intervals of 1,000 systems, all equal", compared(1000, 4));
}

#[test]
fn all_masses_of_the_tethered_molecule_are_decided() {
    let text = std::fs::read_to_string("data/scenes/diatomic-tether.json").unwrap();
    let source: Value = serde_json::from_str(&text).unwrap();
    for (path, range, ends) in [("masses.0", "1/2..1", (0.5, 1.0)), ("outer", "3/10..9/20", (0.3, 0.45))] {
        let found = scene(&source)
            .intervals(&format!("{path}={range}").parse().unwrap(), 1e-2, &Limits::default())
            .unwrap();
        assert_whole(&found.stretches, ends, path);
        assert_true(&source, path, &found.stretches, 20, &mut Numbers(3));
    }
}

#[test]
fn an_edge_that_is_a_double_belongs_to_the_stretch_whose_verdict_it_has() {
    // Velocity Verlet: h² k = 4 at h = 2 is linear growth.
    let source = json!({
        "schema": "kickdrift/system/1", "masses": ["1"], "potentials": [{"step": "1", "stiffness": [["1"]]}],
    });
    let found = scene(&source).intervals(&"outer=1..3".parse().unwrap(), 1e-2, &Limits::default()).unwrap();
    let [stable, unstable] = found.stretches[..] else { panic!("{found:?}") };
    assert_eq!((stable.lo, stable.hi, stable.verdict), (1.0, 2f64.next_down(), Holds::Stable));
    assert_eq!((unstable.lo, unstable.hi, unstable.verdict), (2.0, 3.0, Holds::Unstable));
    // A tongue that closes: with both kicks alike nothing is unstable at the resonance.
    let source = json!({
        "schema": "kickdrift/system/1", "masses": ["1"], "potentials": [
            {"step": "1", "stiffness": [["1"]]}, {"step": "2", "scale": "1", "stiffness": [["1"]]},
        ],
    });
    let found =
        scene(&source).intervals(&"potentials.1.scale=-1/4..1/4".parse().unwrap(), 1e-2, &Limits::default());
    let found = found.unwrap().stretches;
    assert_true(&source, "potentials.1.scale", &found, 10, &mut Numbers(5));
}

/// diag(own, rest), the first coordinate turned by (3, 4, 5) into the third last, so that no zero parts them.
fn turned(own: &[&[i64]], rest: [[i64; 2]; 2], denominator: i64) -> Value {
    let (m, n) = (own.len(), own.len() + 2);
    let entry = |i: usize, j: usize| match (i < m, j < m) {
        (true, true) => own[i][j],
        (false, false) => rest[i - m][j - m],
        _ => 0,
    };
    let turn = |i: usize, k: usize| match (i == 0 || i == m, k == 0 || k == m) {
        (true, true) if i == k => 3,
        (true, true) => {
            if i == 0 {
                4
            } else {
                -4
            }
        }
        _ => {
            if i == k {
                5
            } else {
                0
            }
        }
    };
    let product = |i: usize, j: usize| -> i64 {
        (0..n)
            .flat_map(|k| (0..n).map(move |l| (k, l)))
            .map(|(k, l)| turn(i, k) * entry(k, l) * turn(j, l))
            .sum()
    };
    (0..n)
        .map(|i| (0..n).map(|j| format!("{}/{}", product(i, j), 25 * denominator)).collect::<Vec<_>>())
        .collect()
}

/// Modes that do not change with the number, some of their multipliers at 1 or −1 or twice on the circle,
/// with Jordan blocks or without: beside two modes that do change and that no rational direction parts from
/// them.
#[test]
fn what_stays_at_an_edge_for_all_numbers_leaves_nothing_open() {
    let mut numbers = Numbers(17);
    // Stiffnesses in tenths under both clocks, and the longer step.
    type Rows<'a> = &'a [&'a [i64]];
    let edges: [(&str, Rows, Rows, &str); 9] = [
        ("kicks that cancel over the period: a block at 1", &[&[10]], &[&[-15]], "2"),
        ("Verlet's limit: a block at 1", &[&[40]], &[&[0]], "2"),
        ("an edge: a block at −1", &[&[10]], &[&[5]], "2"),
        ("−1 twice", &[&[20]], &[&[0]], "2"),
        ("1 twice", &[&[30]], &[&[0]], "3"),
        ("1 twice and −1 twice", &[&[30, 0], &[0, 10]], &[&[0, 0], &[0, 0]], "3"),
        ("a block at 1, −1 twice", &[&[10, 0], &[0, 20]], &[&[-15, 0], &[0, 0]], "2"),
        ("two pairs alike on the circle", &[&[20, 5], &[5, 20]], &[&[-5, -5], &[-5, -5]], "2"),
        ("two pairs that meet: blocks on the circle", &[&[2, 0], &[0, 38]], &[&[0, 1], &[1, 2]], "2"),
    ];
    for (what, first, second, step) in edges {
        let n = first.len() + 2;
        let zero = vec![vec![0; first.len()]; first.len()];
        let zero: Vec<&[i64]> = zero.iter().map(Vec::as_slice).collect();
        let source = json!({
            "schema": "kickdrift/system/1", "masses": vec!["1"; n], "potentials": [
                {"step": "1", "stiffness": turned(first, [[3, 1], [1, 7]], 10)},
                {"step": step, "stiffness": turned(second, [[2, -1], [-1, 1]], 10)},
                {"step": step, "scale": "1", "stiffness": turned(&zero, [[4, 2], [2, 1]], 10)},
            ],
        });
        let mass = format!("masses.{}", n - 1);
        for (path, range, ends) in
            [("potentials.2.scale", "-1..4", (-1.0, 4.0)), (mass.as_str(), "1/4..3", (0.25, 3.0))]
        {
            let span = format!("{path}={range}").parse().unwrap();
            let found = scene(&source).intervals(&span, 1e-2, &Limits::default()).unwrap();
            assert_whole(&found.stretches, ends, &format!("{what}, {path}"));
            assert_true(&source, path, &found.stretches, 4, &mut numbers);
        }
    }
}

/// A bond of 6 turns by a third of a half turn in each step of 1/3, and D = Aᵀ under 3:2 whatever the slow
/// force: motions without any symmetry cross at irrational numbers without growth.
#[test]
fn crossings_where_the_half_period_is_the_whole_of_a_shorter_one_leave_nothing_open() {
    let mut numbers = Numbers(31);
    for n in [2, 3, 3, 4] {
        let mut pick = || (1 + numbers.below(9)).to_string();
        let walls = (0..n).map(|i| json!([i, null, pick()])).collect::<Vec<_>>();
        let slow: Vec<Value> = walls.into_iter().chain((2..n).map(|i| json!([i - 1, i, "7"]))).collect();
        let masses: Vec<&str> = ["1", "2", "2", "1"].into_iter().take(n).collect();
        let source = json!({
            "schema": "kickdrift/system/1", "masses": masses, "potentials": [
                {"name": "fast", "step": "1/3", "springs": [[0, 1, "6"]]},
                {"name": "slow", "step": "1/2", "scale": "1", "springs": slow},
            ],
        });
        let (path, ends) = ("potentials.1.scale", (0.125, 4.0));
        let span = format!("{path}=1/8..4").parse().unwrap();
        let found = scene(&source).intervals(&span, 1e-2, &Limits::default()).unwrap();
        assert_whole(&found.stretches, ends, &source.to_string());
        assert_true(&source, path, &found.stretches, 3, &mut numbers);
    }
}

/// Motions of different symmetry cross at irrational numbers without growth: a mirror's two families in
/// chains, the families of equal arms about one atom, of which two are alike and leave everything unstable at
/// the same place, and rings of five and eight molecules of two atoms, whose eigenspaces lie over Q(sqrt 5)
/// and Q(sqrt 2). A bond of 6 turns by a third of a half turn in a step of 1/3: there motions of one symmetry
/// cross.
#[test]
fn crossings_of_different_symmetries_leave_nothing_open() {
    let mut numbers = Numbers(29);
    for k in 0..36 {
        let mut pick = |n: u64| (1 + numbers.below(n)).to_string();
        let is_ring = k >= 24;
        let n = if is_ring { [10, 16][k % 2] } else { 3 + k % 3 };
        let (mut fast, mut slow, mut masses) = (Vec::new(), Vec::new(), vec![String::from("1"); n]);
        if is_ring {
            let (bond, wall, around) = (if k % 4 < 2 { pick(12) } else { "6".into() }, pick(12), pick(12));
            for i in (0..n).step_by(2) {
                masses[i + 1] = "2".into();
                fast.push(json!([i, i + 1, bond]));
                slow.extend([json!([i + 1, null, wall]), json!([i, (i + 2) % n, around])]);
            }
        } else if k % 2 == 0 {
            for i in 0..n.div_ceil(2) {
                let (mass, wall, bond) = (pick(3), pick(12), pick(12));
                for i in [i, n - 1 - i] {
                    masses[i].clone_from(&mass);
                    slow.push(json!([i, null, wall]));
                    fast.push(json!([i, if i < n / 2 { i + 1 } else { i - 1 }, bond]));
                }
            }
        } else {
            let (bond, wall) = (pick(12), pick(12));
            masses[0] = pick(4);
            slow.push(json!([0, null, pick(12)]));
            fast.extend((1..n).map(|i| json!([0, i, bond])));
            slow.extend((1..n).map(|i| json!([i, null, wall])));
        }
        let steps = [if is_ring { ["1/5", "3/10"] } else { ["1/4", "3/4"] }, ["1/3", "1/2"]];
        let [step, outer] = steps[k / 2 % 2];
        let source = json!({
            "schema": "kickdrift/system/1", "masses": masses, "potentials": [
                {"name": "fast", "step": step, "scale": "1", "springs": fast},
                {"name": "slow", "step": outer, "scale": "1", "springs": slow},
            ],
        });
        for (path, range, ends) in
            [("potentials.0.scale", "1/4..3", (0.25, 3.0)), ("potentials.1.scale", "1/4..5", (0.25, 5.0))]
        {
            let span = format!("{path}={range}").parse().unwrap();
            let found = scene(&source).intervals(&span, 1e-2, &Limits::default()).unwrap();
            assert_whole(&found.stretches, ends, &format!("{path} of {source}"));
            assert_true(&source, path, &found.stretches, 2, &mut numbers);
        }
    }
}

/// Two modes under two clocks, one of them at −1 with a Jordan block for all strengths of the slow force: all
/// entries of the matrices that show the block stand in pairs of opposite sign.
#[test]
fn a_block_whose_entries_cancel_leaves_nothing_open() {
    let source = json!({
        "schema": "kickdrift/system/1", "masses": ["2", "2"], "potentials": [
            {"step": "1/4", "springs": [[0, 1, "16"]]},
            {"step": "3/4", "scale": "1", "springs": [[0, null, "4"], [1, null, "1"]]},
        ],
    });
    let span = "potentials.1.scale=1/4..5".parse().unwrap();
    let found = scene(&source).intervals(&span, 1e-2, &Limits::default()).unwrap().stretches;
    assert_eq!(found, [Stretch { lo: 0.25, hi: 5.0, verdict: Holds::Unstable }]);
    assert_true(&source, "potentials.1.scale", &found, 20, &mut Numbers(7));
}

/// One entry of a mass matrix that is not diagonal, on the diagonal and off it.
#[test]
fn intervals_of_masses_off_the_diagonal_leave_nothing_open_and_agree_with_exact_verdicts() {
    let (mut numbers, mut changes) = (Numbers(23), 0);
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
            assert_whole(&found.stretches, ends, &format!("{path} of {source}"));
            changes += found.stretches.len() - 1;
            assert_true(&source, path, &found.stretches, 2, &mut numbers);
        }
    }
    assert!(changes > 5, "{changes}");
}

/// Fast frequencies of 1 and of √−0.001, both in the slow field: stable at seven and a half, unstable a
/// little below.
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

/// Where many modes are in one resonance, counts at both ends of a cell decide; the exact polynomials are
/// beyond the budget here.
#[test]
fn chains_beyond_the_exact_budget_are_unstable_where_counts_prove_it_and_every_number_agrees() {
    let steps = ["1/4", "3/10", "7/20"];
    let own = scene(&json!({
        "schema": "kickdrift/system/1",
        "build": {"kind": "chain", "masses": 30, "stiffness": ["4", "2", "1/2"], "steps": steps},
    }));
    let limits = Limits { products: 1_100_000_000, ..Limits::default() };
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
                (_, true) => Holds::Undecided,
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
    let text = include_str!("../../data/scenes/water4.json");
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
