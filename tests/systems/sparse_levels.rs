//! Sparse levels of many degrees of freedom against the dense kernel of the same numbers.

use kickdrift::scene::{Array, Scan, SystemScene};
use kickdrift::system::levels::sparse::SparseLevels;
use kickdrift::system::levels::{Hessians, Kernel, Outer, rigid_motions};
use kickdrift::system::{Holds, Limits, Route};
use nalgebra::DMatrix;
use serde_json::json;

/// Numbers that repeat, in (−1/2, 1/2).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    }
}

/// Three-atom molecules on a lattice: stiff springs within each, softer ones to atoms of others that are
/// near.
struct Droplet {
    masses: Vec<f64>,
    positions: Vec<[f64; 3]>,
    fast: DMatrix<f64>,
    slow: DMatrix<f64>,
}

impl Droplet {
    fn new(side: usize, numbers: &mut Numbers) -> Droplet {
        let mut positions = Vec::new();
        for k in 0..side.pow(3) {
            let corner = [k % side, k / side % side, k / side / side].map(|x| 0.31 * x as f64);
            (0..3).for_each(|_| positions.push(corner.map(|x| x + 0.1 * numbers.next())));
        }
        let n = 3 * positions.len();
        let masses = (0..n).map(|i| if i / 3 % 3 == 0 { 16.0 } else { 1.0 }).collect();
        let (mut fast, mut slow) = (DMatrix::zeros(n, n), DMatrix::zeros(n, n));
        for (a, b) in (0..positions.len()).flat_map(|a| (0..a).map(move |b| (a, b))) {
            let apart = nalgebra::Vector3::from(positions[a]) - nalgebra::Vector3::from(positions[b]);
            let (is_bond, distance) = (a / 3 == b / 3, apart.norm());
            if !is_bond && distance > 0.6 {
                continue;
            }
            let (to, stiffness) = match is_bond {
                true => (&mut fast, 4e5 + 1e4 * numbers.next()),
                false => (&mut slow, 3000.0 * (-distance / 0.1).exp() * (1.0 + numbers.next())),
            };
            let block = stiffness * apart * apart.transpose() / distance.powi(2);
            for (i, j, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
                for (x, y) in (0..3).flat_map(|x| (0..3).map(move |y| (x, y))) {
                    to[(3 * i + x, 3 * j + y)] += sign * block[(x, y)];
                }
            }
        }
        Droplet { masses, positions, fast, slow }
    }

    fn rigid(&self) -> faer::Mat<f64> {
        rigid_motions(&self.positions, &self.masses.iter().step_by(3).copied().collect::<Vec<_>>())
    }

    fn sparse(&self) -> SparseLevels {
        let triplets = |m: &DMatrix<f64>| -> Vec<(usize, usize, f64)> {
            let lower = (0..m.nrows()).flat_map(|i| (0..=i).map(move |j| (i, j)));
            lower.filter(|&at| m[at] != 0.0).map(|(i, j)| (i, j, m[(i, j)])).collect()
        };
        SparseLevels::new(&self.masses, [&triplets(&self.fast), &triplets(&self.slow)], self.rigid()).unwrap()
    }

    fn dense(&self) -> Kernel {
        let hessians = Hessians::weighted(&self.masses, &self.fast, &self.slow, 1e-9).unwrap();
        Kernel::new(&hessians.without(&self.rigid(), "positions")).unwrap()
    }
}

#[test]
fn the_first_region_is_that_of_the_dense_kernel() {
    let mut numbers = Numbers(1);
    for side in [2, 3] {
        for inner_steps in [1, 4, 9] {
            let droplet = Droplet::new(side, &mut numbers);
            let (sparse, dense) = (droplet.sparse(), droplet.dense());
            let first = dense.first_unstable(inner_steps);
            let Some((lo, hi)) = sparse.first_unstable(inner_steps) else {
                panic!("{side} {inner_steps}: nothing is found, where {first:?} is")
            };
            // The dense kernel's own edge is sharp to 10^-8; the line below a/b loses a part of a hundredth.
            let edge = first.unwrap().0;
            assert!(lo <= edge && edge < hi && hi < 1.01 * lo, "{side} {inner_steps}: {lo}..{hi}, {edge}");
            for k in 1..40 {
                let outer = Outer::new(edge * 1.5 * f64::from(k) / 40.0, inner_steps).unwrap();
                let (own, truth) = (sparse.verdict(&outer, 0.0), dense.verdict_within(&outer, 0.0));
                assert!(own == truth || own == Holds::Undecided, "{} {own:?} {truth:?}", outer.step());
                assert!(own == Holds::Stable || outer.step() > lo, "{}", outer.step());
            }
            let outer = Outer::new(0.9 * lo, inner_steps).unwrap();
            // Of norms that are no smaller: the margin is no larger, but for what its search leaves.
            let [own, truth] = [sparse.margin(&outer), dense.margin(&outer)].map(Option::unwrap);
            assert!(own > 0.05 * truth && own < 1.02 * truth, "{own} {truth}");
            assert_eq!(sparse.verdict(&outer, own), Holds::Stable);
        }
    }
}

#[test]
fn a_total_that_is_not_definite_is_never_stable() {
    let mut droplet = Droplet::new(2, &mut Numbers(5));
    droplet.slow *= -1.0;
    let sparse = droplet.sparse();
    let outer = Outer::new(1e-4, 4).unwrap();
    assert_eq!(sparse.verdict(&outer, 0.0), Holds::Undecided);
    assert_eq!((sparse.margin(&outer), sparse.first_unstable(4)), (None, None));
}

#[test]
fn compressed_rows_are_read_and_refused_by_name() {
    let droplet = Droplet::new(2, &mut Numbers(9));
    let n = droplet.masses.len();
    let mut arrays = std::collections::BTreeMap::new();
    let mut hold = |name: &str, values: Vec<f64>| {
        arrays.insert(name.to_string(), Array::new(vec![values.len()], values).unwrap());
    };
    hold("masses", droplet.masses.clone());
    hold("positions", droplet.positions.concat());
    for (name, matrix) in [("fast", &droplet.fast), ("slow", &droplet.slow)] {
        let (mut data, mut indices, mut ends) = (Vec::new(), Vec::new(), vec![0.0]);
        for i in 0..n {
            for j in (0..n).filter(|&j| matrix[(i, j)] != 0.0) {
                data.push(matrix[(i, j)]);
                indices.push(j as f64);
            }
            ends.push(data.len() as f64);
        }
        hold(&format!("{name}.data"), data);
        hold(&format!("{name}.indices"), indices);
        hold(&format!("{name}.indptr"), ends);
    }
    let file = |slow: &str, outer: &str| {
        json!({
            "schema": "kickdrift/system/1", "time_unit": "ps",
            "masses": {"npz": "a.npz", "array": "masses"}, "positions": {"npz": "a.npz", "array": "positions"},
            "accuracy": 1e-9,
            "potentials": [
                {"step": "1/2000", "stiffness": {"npz": "a.npz", "csr": "fast"}},
                {"step": outer, "stiffness": {"npz": "a.npz", "csr": slow}},
            ],
        })
    };
    let held = kickdrift::scene::Arrays::Held(std::sync::Arc::new(arrays));
    let read = |slow: &str, outer: &str| SystemScene::from_json_in(held.clone(), file(slow, outer));
    let scene = read("slow", "1/1000").unwrap();
    let found = scene.model().decide(Route::Cheapest, &Limits::default()).unwrap();
    let measured = found.measured.as_ref().unwrap();
    assert!(found.is_stable() && measured.holds == Holds::Stable && found.size == n);
    assert_eq!(measured.removed.as_ref().map(|own| own.count), Some(6));
    let (lo, hi) = measured.first_unstable.unwrap();
    assert!(0.001 < lo && lo < hi);
    let limits = Limits::default();
    let with = |key: &str, value: serde_json::Value| {
        let mut source = file("slow", "1/1000");
        source[key] = value;
        SystemScene::from_json_in(held.clone(), source)
    };
    // What names atoms is taken; what dense stiffnesses alone have is refused by its name.
    assert!(with("elements", json!(vec!["O"; n / 3])).is_ok() && with("bonded", json!([[0, 1]])).is_ok());
    for (key, value) in [
        ("constraints", json!([[0, 1]])),
        ("hydrogen_mass", json!(3)),
        ("symmetric", json!(false)),
        ("method", json!("impulse")),
        ("mass_weighted", json!(true)),
        ("elements", json!(["O"])),
    ] {
        let error = with(key, value).unwrap_err();
        assert_eq!(error.field(), key, "{error}");
    }
    // A scan over steps keeps the stiffnesses, whichever is the fast one, and the accuracy: each point is
    // what its own file has.
    let asked = scene.clone().asked(Some(1e-7), false, None, None).unwrap();
    for path in ["potentials.1.step", "potentials.0.step"] {
        let range = format!("{path}=1/2000..3/1000:1/2000");
        let scan = Scan::new(asked.clone(), range.parse().unwrap(), None).unwrap();
        for x in scan.x.values() {
            let mut source = file("slow", "1/1000");
            let own = scan.at(&x, &x);
            source["potentials"][if path == "potentials.1.step" { 1 } else { 0 }]["step"] =
                json!(x.to_string());
            source["accuracy"] = json!(1e-7);
            let other = SystemScene::from_json_in(held.clone(), source);
            let decided = |scene: SystemScene| {
                format!("{:?}", scene.model().decide(Route::Cheapest, &limits).unwrap().measured)
            };
            // An outer step that is no multiple of the inner one is refused.
            assert_eq!(own.is_ok(), other.is_ok(), "{path} {x}");
            if let (Ok(own), Ok(other)) = (own, other) {
                assert_eq!(decided(own), decided(other), "{path} {x}");
            }
        }
    }
    // All steps in their ratios, by the longest one.
    let scan = Scan::new(asked, "outer=1/2000..1/500:1/2000".parse().unwrap(), None).unwrap();
    let ratio_of = |steps: Vec<kickdrift::number::Rational>| &steps[1] / &steps[0];
    for x in scan.x.values() {
        let own = scan.at(&x, &x).unwrap();
        assert_eq!(own.model().steps()[1], x);
        assert_eq!(ratio_of(own.model().steps()), ratio_of(scene.model().steps()));
    }
    let mut source = file("slow", "1/1000");
    source["potentials"][1]["stiffness"] = json!({"npz": "a.npz", "array": "slow.data"});
    let error = SystemScene::from_json_in(held.clone(), source).unwrap_err();
    assert_eq!(error.field(), "potentials[1].stiffness", "{error}");
    let refusals = [
        read("nothing", "1/1000").map(|_| ()),
        read("slow", "3/4000").map(|_| ()),
        read("slow", "0").map(|_| ()),
        scene.model().decide(Route::Exact, &limits).map(|_| ()),
        scene.model().moving().map(|_| ()),
        scene.nearest_unstable(1e-3, &limits).map(|_| ()),
        scene.intervals(&"outer=1/1000..1/500".parse().unwrap(), 1e-3, &limits).map(|_| ()),
        scene.model().decide(Route::Cheapest, &Limits { products: 10, ..limits }).map(|_| ()),
    ];
    for refused in refusals {
        let error = refused.unwrap_err().to_string();
        assert!(!error.contains('\n'), "{error}");
    }
}

/// A document of sparse levels by its compressed rows.
fn small(matrices: [&DMatrix<f64>; 2], steps: [&str; 2]) -> kickdrift::error::Result<SystemScene> {
    let mut arrays = std::collections::BTreeMap::new();
    let mut hold = |name: String, values: Vec<f64>| {
        arrays.insert(name, Array::new(vec![values.len()], values).unwrap());
    };
    for (k, own) in matrices.into_iter().enumerate() {
        let (n, mut ends, mut held) = (own.nrows(), vec![0.0], Vec::new());
        for i in 0..n {
            held.extend((0..n).filter(|&j| own[(i, j)] != 0.0).map(|j| (j as f64, own[(i, j)])));
            ends.push(held.len() as f64);
        }
        hold(format!("k{k}.indices"), held.iter().map(|own| own.0).collect());
        hold(format!("k{k}.data"), held.iter().map(|own| own.1).collect());
        hold(format!("k{k}.indptr"), ends);
    }
    let held = kickdrift::scene::Arrays::Held(std::sync::Arc::new(arrays));
    let potential =
        |k: usize| json!({"step": steps[k], "stiffness": {"npz": "a.npz", "csr": format!("k{k}")}});
    let file = json!({
        "schema": "kickdrift/system/1", "masses": vec![1; matrices[0].nrows()], "accuracy": 1e-9,
        "potentials": [potential(0), potential(1)],
    });
    SystemScene::from_json_in(held, file)
}

/// 1 and 0.01 on the fast clock, 0.1 and -0.02 on the slow one: the first mode resonates, the second falls,
/// and faster.
#[test]
fn where_the_total_falls_nothing_is_counted_and_no_smaller_step_is_called_stable() {
    use kickdrift::question::{Question, System, Work};
    let diagonal = |own: [f64; 2]| DMatrix::from_diagonal(&own.to_vec().into());
    let (fast, slow) = (diagonal([1.0, 0.01]), diagonal([0.1, -0.02]));
    for (steps, told) in [(["0.376", "3.008"], Some(false)), (["1/80", "1/10"], None)] {
        let scene = small([&fast, &slow], steps).unwrap();
        let found = scene.model().decide(Route::Cheapest, &Limits::default()).unwrap();
        assert_eq!(found.holds().is_stable(), told, "{found:?}");
        let measured = found.measured.as_ref().unwrap();
        assert_eq!((measured.margin, measured.first_unstable, found.growth_rate()), (None, None, None));
        let falls = &found.warnings[1];
        assert!(falls.starts_with("along 1 direction, ") && falls.contains("may fall"), "{falls}");
        let [resonance] = &found.warnings[2..] else { panic!("{:?}", found.warnings) };
        assert!(resonance.starts_with("apart from such falls"), "{resonance}");
    }
    // In a scan, too, and in words.
    let scene = small([&fast, &slow], ["0.376", "3.008"]).unwrap();
    assert!(!scene.model().at_point(Route::Cheapest, &Limits::default()).unwrap().is_stable());
    let folder = tempfile::tempdir().unwrap();
    for (name, own) in [("f", &fast), ("s", &slow)] {
        npz_of(&folder.path().join(format!("{name}.npz")), own);
    }
    let potential = |name: &str, step: &str| json!({"step": step, "stiffness": {"npz": format!("{name}.npz"), "csr": ""}});
    let file = json!({
        "schema": "kickdrift/system/1", "masses": [1, "1"],
        "potentials": [potential("f", "0.376"), potential("s", "3.008")],
    });
    let asked: System = serde_json::from_value(json!({"file": "a.json", "system": file})).unwrap();
    let arrays = kickdrift::scene::Arrays::from(folder.path());
    let answer = asked.answer(&Work { arrays: Some(&arrays), ..Work::default() }).unwrap();
    let text = asked.document(&answer).render(kickdrift::format::Format::Text).unwrap();
    assert!(text.starts_with("unstable") && text.contains("growth rate not enclosed"), "{text}");
    assert!(!text.contains("no other") && !text.contains("every smaller"), "{text}");
}

/// A matrix as `scipy.sparse.save_npz` writes it, but for its shape.
fn npz_of(path: &std::path::Path, own: &DMatrix<f64>) {
    use kickdrift::report::npz::{self, Element};
    let n = own.nrows();
    let row = |i: usize| (0..n).filter(move |&j| own[(i, j)] != 0.0).map(move |j| (j as f64, own[(i, j)]));
    let (indices, data): (Vec<f64>, Vec<f64>) = (0..n).flat_map(row).unzip();
    let ends = std::iter::once(0).chain((0..n).map(|i| row(i).count())).scan(0.0, |end, count| {
        *end += count as f64;
        Some(*end)
    });
    let arrays = [("data", data), ("indices", indices), ("indptr", ends.collect())].map(|(name, values)| {
        let mut array = npz::Array::new(path, name, Element::F64, &[values.len()]).unwrap();
        array.put_f64(values).unwrap();
        array
    });
    npz::write(path, arrays.into()).unwrap();
}

// Ledger: sparse levels; 700 random systems, seed 21; the dense period
/// Small systems whose stiffnesses are singular, indefinite, or cancel: whatever is proven is what a dense
/// period does.
#[test]
fn what_is_proven_of_small_systems_is_what_their_dense_period_does() {
    let (mut numbers, mut seen, mut first) = (Numbers(21), [0; 3], 0);
    for case in 0..700 {
        let n = 2 + case % 3;
        let mut matrix = |size: f64| {
            let raw = DMatrix::from_fn(n, n, |_, _| numbers.next());
            let own: DMatrix<f64> = match case % 5 {
                // Definite, of rank 1, indefinite.
                0 | 1 => &raw * raw.transpose() + DMatrix::identity(n, n) * 0.05,
                2 => raw.column(0) * raw.column(0).transpose(),
                _ => (&raw + raw.transpose()) / 2.0,
            };
            // Symmetric to the last digit.
            DMatrix::from_fn(n, n, |i, j| size * own[(i.max(j), i.min(j))])
        };
        let fast = matrix(1.0);
        let slow = if case % 7 == 0 { -&fast } else { matrix(0.2) };
        let lower = |own: &DMatrix<f64>| -> Vec<_> {
            (0..n).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| (i, j, own[(i, j)])).collect()
        };
        let [a, b] = [&fast, &slow].map(lower);
        let levels = SparseLevels::new(&vec![1.0; n], [&a, &b], faer::Mat::zeros(n, 0)).unwrap();
        let least = (&fast + &slow).symmetric_eigenvalues().min();
        let inner_steps = 1 + case as u64 % 6;
        let radius = |outer: f64| {
            let inner = outer / inner_steps as f64;
            let shear = |up: bool, by: DMatrix<f64>| {
                let mut own = DMatrix::identity(2 * n, 2 * n);
                own.view_mut(if up { (0, n) } else { (n, 0) }, (n, n)).copy_from(&by);
                own
            };
            let (kick, half) = (shear(false, -outer / 2.0 * &slow), shear(false, -inner / 2.0 * &fast));
            let step = &half * shear(true, DMatrix::identity(n, n) * inner) * &half;
            let period = &kick * step.pow(inner_steps as u32) * &kick;
            period.complex_eigenvalues().iter().fold(0.0f64, |most, own| most.max(own.norm()))
        };
        for _ in 0..3 {
            let step = 8.0 * (numbers.next() + 0.5) + 1e-3;
            let told = levels.verdict(&Outer::new(step, inner_steps).unwrap(), 0.0);
            seen[told as usize] += 1;
            // Doubles know a pair of nearly equal multipliers to half of their digits.
            match told {
                Holds::Stable => assert!(radius(step) < 1.0 + 1e-6 && least > 0.0, "{case} {step} {least}"),
                Holds::Unstable => assert!(radius(step) > 1.0, "{case} {step} {least}"),
                Holds::Undecided => {}
            }
        }
        if let Some((lo, _)) = levels.first_unstable(inner_steps) {
            first += 1;
            assert!(least > 0.0, "{case} {least}");
            (1..20).for_each(|k| assert!(radius(lo * f64::from(k) / 20.0) < 1.0 + 1e-6, "{case} {k}"));
        }
    }
    assert!(seen.iter().all(|&count| count > 50) && first > 100, "{seen:?} {first}");
}

/// Two atoms on a bond: with tethers, or where both stiffnesses hold a translation and their sum does not,
/// nothing is set apart.
#[test]
fn motions_that_a_sparse_stiffness_holds_are_not_set_apart() {
    let folder = tempfile::tempdir().unwrap();
    let bond = |by: f64| {
        DMatrix::from_fn(6, 6, |i, j| match (i % 3, j % 3) {
            (0, 0) => {
                if i == j {
                    by
                } else {
                    -by
                }
            }
            _ => 0.0,
        })
    };
    let read = |fast: &DMatrix<f64>, slow: &DMatrix<f64>, more: serde_json::Value| {
        npz_of(&folder.path().join("f.npz"), fast);
        npz_of(&folder.path().join("s.npz"), slow);
        let potential = |name: &str, step: &str| json!({"step": step, "stiffness": {"npz": format!("{name}.npz"), "csr": ""}});
        let mut file = json!({
            "schema": "kickdrift/system/1", "masses": [1, 2], "accuracy": 1e-6, "positions": {"npy": "x.npy"},
            "potentials": [potential("f", "1/8"), potential("s", "1/2")],
        });
        file.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        SystemScene::from_json_in(kickdrift::scene::Arrays::from(folder.path()), file)
    };
    npy_of(&folder.path().join("x.npy"), &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    let tether = DMatrix::identity(6, 6) * 0.1;
    let soft = DMatrix::identity(6, 6) * 1e-3;
    let none = json!({});
    let free = read(&bond(1.0), &bond(0.1), none.clone()).unwrap();
    let free = free.model().decide(Route::Cheapest, &Limits::default()).unwrap();
    assert_eq!(free.measured.unwrap().removed.map(|own| own.count), Some(5));
    for (fast, slow) in [
        (bond(1.0), tether.clone()),
        (bond(1.0), bond(0.1) + &soft),
        (bond(1.0) + &tether, bond(0.1) - &tether),
    ] {
        let error = read(&fast, &slow, none.clone()).unwrap_err();
        assert_eq!(error.field(), "rigid motions", "{error}");
        assert!(error.to_string().contains("say \"keep_rigid\": true"), "{error}");
        // The remedy works.
        let kept = read(&fast, &slow, json!({"keep_rigid": true})).unwrap();
        assert!(
            kept.model()
                .decide(Route::Cheapest, &Limits::default())
                .unwrap()
                .measured
                .unwrap()
                .removed
                .is_none()
        );
    }
    // Asked for with another accuracy it is the same question.
    let scene = read(&bond(1.0), &(bond(0.1) + &soft * 1e-4), json!({"accuracy": 1e-3})).unwrap();
    assert!(scene.asked(Some(1e-8), false, None, None).is_err());
}

/// Positions of three numbers each.
fn npy_of(path: &std::path::Path, values: &[f64]) {
    let mut header =
        format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, 3), }}", values.len() / 3);
    while (10 + header.len() + 1) % 64 > 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.bytes());
    bytes.extend(values.iter().flat_map(|x| x.to_le_bytes()));
    std::fs::write(path, bytes).unwrap();
}

/// One triangle of a matrix is no symmetric matrix, and nothing is made so in silence.
#[test]
fn what_is_not_symmetric_is_refused_with_the_entry_and_the_difference() {
    let whole = DMatrix::from_row_slice(2, 2, &[2.0, -1.0, -1.0, 2.0]);
    for (i, j) in [(0, 1), (1, 0)] {
        let mut triangle = whole.clone();
        triangle[(i, j)] = 0.0;
        let error = small([&whole, &triangle], ["1/8", "1/2"]).unwrap_err();
        assert_eq!(error.field(), "potentials[1].stiffness[1][0]", "{error}");
        assert!(
            error.to_string().contains("is not symmetric: entry [0][1] is")
                && error.to_string().contains("differ by 1e0"),
            "{error}"
        );
    }
    let own = |entries: &[(usize, usize, f64)]| {
        SparseLevels::new(&[1.0; 2], [&[(0, 0, 1.0), (1, 1, 1.0)], entries], faer::Mat::zeros(2, 0))
    };
    // In Rust each pair may be given once, in either triangle, and means both.
    let pairs = [vec![(1, 0, -0.5)], vec![(0, 1, -0.5)], vec![(0, 1, -0.5), (1, 0, -0.5)]].map(|own| {
        let mut entries = vec![(0, 0, 1.0), (1, 1, 1.0)];
        entries.extend(own);
        entries
    });
    let first = pairs.map(|entries| own(&entries).unwrap().first_unstable(4).unwrap());
    assert!(first[0] == first[1] && first[1] == first[2], "{first:?}");
    let error = own(&[(0, 1, -0.5), (1, 0, -0.25)]).unwrap_err();
    assert_eq!(error.field(), "stiffness[1][0]", "{error}");
}

/// What falls by itself falls at any step; the resonances of the steps are those of the same system without
/// it.
#[test]
fn resonances_are_proven_where_the_forces_hold_no_minimum() {
    let n = 40;
    let fast: Vec<_> = (0..n).map(|i| (i, i, if i < 2 { 0.0 } else { 1.0 })).collect();
    let slow = |falls: f64| -> Vec<_> {
        let own = |i: usize| if i < 2 { falls } else { 0.02 };
        (0..n).map(|i| (i, i, own(i))).chain((3..n).map(|i| (i, i - 1, -0.01))).collect()
    };
    let levels =
        |falls| SparseLevels::new(&vec![1.0; n], [&fast, &slow(falls)], faer::Mat::zeros(n, 0)).unwrap();
    let [held, falling] = [0.02, -0.02].map(levels);
    assert_eq!((held.unproven_directions(), falling.unproven_directions()), (Some(0), Some(2)));
    assert_eq!(held.first_unstable(8), held.first_resonance(8));
    assert_eq!(falling.first_unstable(8), None);
    let ((lo, hi), (other, end)) = (held.first_resonance(8).unwrap(), falling.first_resonance(8).unwrap());
    assert!(lo < end && other < hi, "{lo} {hi} {other} {end}");
    let verdict = |levels: &SparseLevels, step: f64| levels.verdict(&Outer::new(step, 8).unwrap(), 0.0);
    assert_eq!([verdict(&held, 2.0), verdict(&held, 1.01 * hi)], [Holds::Stable, Holds::Unstable]);
    assert_eq!([verdict(&falling, 2.0), verdict(&falling, 1.01 * end)], [Holds::Undecided, Holds::Unstable]);
    // The multipliers of the dense period: positive where they grow below, and one below −1 beyond.
    let dense = |own: &[(usize, usize, f64)]| {
        let mut matrix = DMatrix::zeros(n, n);
        own.iter().for_each(|&(i, j, x)| (matrix[(i, j)], matrix[(j, i)]) = (x, x));
        matrix
    };
    let (stiff, soft) = (dense(&fast), dense(&slow(-0.02)));
    let grown = |outer: f64| {
        let inner = outer / 8.0;
        let shear = |up: bool, by: &DMatrix<f64>| {
            let mut own = DMatrix::identity(2 * n, 2 * n);
            own.view_mut(if up { (0, n) } else { (n, 0) }, (n, n)).copy_from(by);
            own
        };
        let (kick, drift) =
            (shear(false, &(-outer / 2.0 * &soft)), shear(true, &(DMatrix::identity(n, n) * inner)));
        let half = shear(false, &(-inner / 2.0 * &stiff));
        let step = &half * drift * &half;
        let period = &kick * step.pow(8) * &kick;
        period.complex_eigenvalues().iter().filter(|own| own.norm() > 1.0 + 1e-6).copied().collect::<Vec<_>>()
    };
    let below = grown(0.999 * other);
    assert!(below.len() == 2 && below.iter().all(|own| own.re > 1.0 && own.im.abs() < 1e-6), "{below:?}");
    assert!(grown(1.01 * end).iter().any(|own| own.re < -1.0));
}

/// What is said of all stiffnesses within an accuracy is true of those at its ends, and is never the opposite
/// of what the dense kernel says of all.
#[test]
fn verdicts_for_all_stiffnesses_within_an_accuracy_are_those_at_its_ends() {
    let (mut numbers, mut seen) = (Numbers(11), [[0; 3]; 2]);
    for (side, inner_steps) in [(2, 1), (2, 4), (3, 9)] {
        let droplet = Droplet::new(side, &mut numbers);
        let roots = DMatrix::from_diagonal(
            &DMatrix::from_vec(droplet.masses.len(), 1, droplet.masses.clone()).column(0).map(f64::sqrt),
        );
        let inverse = roots.map(|x| if x > 0.0 { 1.0 / x } else { 0.0 });
        let norm = |own: &DMatrix<f64>| (&inverse * own * &inverse).symmetric_eigenvalues().amax();
        let norms = [norm(&droplet.fast), norm(&droplet.slow)];
        let mass = &roots * &roots;
        let (sparse, dense) = (droplet.sparse(), droplet.dense());
        let (_, first) = sparse.first_unstable(inner_steps).unwrap();
        for above in [0.9, 0.99, 1.0001, 1.003, 1.03, 1.2, 1.8] {
            let outer = Outer::new(above * first, inner_steps).unwrap();
            for (k, epsilon) in [3e-10, 1e-6, 1e-4].into_iter().enumerate() {
                let told = sparse.verdict(&outer, epsilon);
                seen[k.min(1)][told as usize] += 1;
                if told == Holds::Undecided {
                    continue;
                }
                let within = dense.verdict_within(&outer, epsilon);
                assert!(
                    within == told || within == Holds::Undecided,
                    "{side} {above} {epsilon}: {told:?} {within:?}"
                );
                for signs in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
                    let [fast, slow] = [0, 1]
                        .map(|k| [&droplet.fast, &droplet.slow][k] + &mass * (signs[k] * epsilon * norms[k]));
                    let (masses, positions) = (droplet.masses.clone(), droplet.positions.clone());
                    let truth = Droplet { masses, positions, fast, slow }.dense().verdict_within(&outer, 0.0);
                    assert!(
                        truth == told || truth == Holds::Undecided,
                        "{side} {above} {epsilon}: {told:?} {truth:?}"
                    );
                }
            }
        }
    }
    // Below the first region's end and a little above it; larger accuracies are not proven everywhere.
    let of = |k: usize, holds: Holds| seen[k][holds as usize];
    assert!((0..2).all(|k| of(k, Holds::Unstable) > 2 && of(k, Holds::Stable) > 2), "{seen:?}");
}

/// Documents of a droplet on both sides of its first unstable step, and above all that is decided.
#[test]
fn documents_are_held_against_a_run_kick_by_kick_and_say_what_it_does_not_see() {
    use kickdrift::question::{Question, System, Work};
    use kickdrift::recheck::{CheckedDocument, Options};
    use kickdrift::report::npz::{self, Element};
    let droplet = Droplet::new(2, &mut Numbers(9));
    let (n, folder) = (droplet.masses.len(), tempfile::tempdir().unwrap());
    let archive = folder.path().join("a.npz");
    let array = |name, values: Vec<f64>| {
        let mut array = npz::Array::new(&archive, name, Element::F64, &[values.len()]).unwrap();
        array.put_f64(values).unwrap();
        array
    };
    let rows = |names: [&'static str; 3], matrix: &DMatrix<f64>| {
        let held =
            |i: usize| (0..n).filter(move |&j| matrix[(i, j)] != 0.0).map(move |j| (j, matrix[(i, j)]));
        let (indices, data) = (0..n).flat_map(held).map(|(j, x)| (j as f64, x)).unzip();
        let ends = std::iter::once(0).chain((0..n).map(|i| held(i).count())).scan(0.0, |end, count| {
            *end += count as f64;
            Some(*end)
        });
        names
            .into_iter()
            .zip([data, indices, ends.collect()])
            .map(|(name, own)| array(name, own))
            .collect::<Vec<_>>()
    };
    let mut arrays = rows(["fast.data", "fast.indices", "fast.indptr"], &droplet.fast);
    arrays.extend(rows(["slow.data", "slow.indices", "slow.indptr"], &droplet.slow));
    arrays.push(array("masses", droplet.masses.clone()));
    arrays.push(array("positions", droplet.positions.concat()));
    npz::write(&archive, arrays).unwrap();
    let (_, first) = droplet.sparse().first_unstable(4).unwrap();
    let potential = |name: &str, step: u64| json!({"step": format!("{step}/1000000000"), "stiffness": {"npz": "a.npz", "csr": name}});
    let by_reference = |name: &str| json!({"npz": "a.npz", "array": name});
    let arrays = kickdrift::scene::Arrays::from(folder.path());
    let work = Work { arrays: Some(&arrays), ..Work::default() };
    for (part, told, what) in [
        (0.9, Some(true), "that nothing grows"),
        (1.0002, Some(false), "that it grows: too slowly"),
        (3.0, None, "where the first region ends"),
    ] {
        let inner = (part * first / 4.0 * 1e9).round() as u64;
        let file = json!({
            "schema": "kickdrift/system/1", "time_unit": "ps", "masses": by_reference("masses"),
            "positions": by_reference("positions"), "accuracy": 1e-9,
            "potentials": [potential("fast", inner), potential("slow", 4 * inner)],
        });
        let asked: System = serde_json::from_value(json!({"file": "a.json", "system": file})).unwrap();
        let answer = asked.answer(&work).unwrap();
        let text = asked.document(&answer).render(kickdrift::format::Format::Json).unwrap();
        let found: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(found["stable"].as_bool(), told, "{text}");
        assert!(
            told.is_some() || found["warnings"][0].as_str().unwrap().contains("nothing above it"),
            "{text}"
        );
        let options = Options { folder: folder.path().into(), ..Options::default() };
        let outcome = CheckedDocument::read(&text).unwrap().verify(&options, None).unwrap();
        assert!(outcome.failures.is_empty() && outcome.route.contains("kick by kick"), "{outcome:?}");
        assert!(outcome.not_rechecked.iter().any(|own| own.starts_with(what)), "{outcome:?}");
    }
}
