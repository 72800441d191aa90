use super::*;

/// A matrix of n rows with entries up to so far from its diagonal, numbers without a pattern.
fn banded(n: usize, width: usize) -> (Vec<(usize, usize, f64)>, Mat<f64>) {
    let entry = |i: usize, j: usize| ((i * n + j + 1) as f64 * 0.754_877_666_246_692_7).fract() - 0.5;
    let near = |i: usize| (i.saturating_sub(width)..=i).map(move |j| (i, j, entry(i, j)));
    let triplets: Vec<_> = (0..n).flat_map(near).collect();
    let mut dense = Mat::zeros(n, n);
    triplets.iter().for_each(|&(i, j, x)| (dense[(i, j)], dense[(j, i)]) = (x, x));
    (triplets, dense)
}

/// A cubic lattice with entries up to a distance.
fn lattice(side: usize, far: i64) -> Vec<(usize, usize, f64)> {
    let place = |i: usize| [i % side, i / side % side, i / side / side].map(|x| x as i64);
    let apart =
        |i: usize, j: usize| -> i64 { place(i).iter().zip(place(j)).map(|(a, b)| (a - b).pow(2)).sum() };
    let n = side.pow(3);
    let near = |i: usize| (0..i).filter(move |&j| apart(i, j) <= far * far).map(move |j| (i, j, -0.01));
    (0..n).flat_map(|i| near(i).chain([(i, i, 2.0)])).collect()
}

#[test]
fn bodies_in_space_are_dissected_where_that_fills_less() {
    for side in [12, 16] {
        let triplets = lattice(side, 2);
        let n = side.pow(3);
        let (pattern, [values]) = Pattern::of(n, [&triplets]).unwrap();
        let mut order = dissected(&pattern.columns, &pattern.rows);
        let amd = factorize_symbolic_cholesky(
            SymbolicSparseColMatRef::new_checked(n, n, &pattern.columns, None, &pattern.rows),
            Side::Lower,
            SymmetricOrdering::Amd,
            Default::default(),
        );
        let amd = products(&amd.unwrap());
        assert!(amd > WORTH_AN_ORDER * pattern.rows.len() as f64 && pattern.products() < amd, "{side}");
        order.sort_unstable();
        assert!(order.into_iter().eq(0..n));
        let x = Mat::from_fn(n, 1, |i, _| (i % 7) as f64 - 2.5);
        let solved = pattern.factored(0.0, &[(1.0, &values)], 0.0).unwrap().solve(x.clone()).unwrap();
        // The shift that makes the factors a proof is some 10^-9 of the matrix here.
        assert!((pattern.times(&values, &solved) - &x).norm_l2() < 1e-6 * x.norm_l2());
        assert!(pattern.is_definite(0.0, &[(1.0, &values)], 0.0));
    }
}

#[test]
fn orders_hold_every_row_once() {
    // Parts without a path between them, rows that all meet, rows without any entry beside the diagonal.
    let apart: Vec<_> = (0..2000).map(|i| (i, i, 1.0)).collect();
    let chains: Vec<_> = apart.iter().copied().chain((5..2000).map(|i| (i, i - 5, 1.0))).collect();
    let full: Vec<_> = (0..400).flat_map(|i| (0..=i).map(move |j| (i, j, 1.0))).collect();
    for (n, triplets) in [(2000, apart), (2000, chains), (400, full)] {
        let (pattern, _) = Pattern::of(n, [&triplets]).unwrap();
        let mut order = dissected(&pattern.columns, &pattern.rows);
        order.sort_unstable();
        assert!(order.into_iter().eq(0..n));
    }
}

#[test]
fn fronts_count_what_is_negative_in_bodies_apart() {
    // Three lattices that do not meet, each large enough to be eliminated by supernodes; one is twice as
    // stiff.
    let (body, n) = (lattice(9, 2), 729);
    let moved = |k: usize| {
        let by = if k == 2 { 2.0 } else { 1.0 };
        body.iter().map(move |&(i, j, x)| (i + k * n, j + k * n, by * x))
    };
    let all: Vec<_> = (0..3).flat_map(moved).collect();
    let (pattern, [values]) = Pattern::of(3 * n, [&all]).unwrap();
    assert!(matches!(pattern.symbolic.raw(), SymbolicCholeskyRaw::Supernodal(_)));
    let mut matrix = Mat::zeros(n, n);
    body.iter().for_each(|&(i, j, x)| (matrix[(i, j)], matrix[(j, i)]) = (x, x));
    let eigenvalues = matrix.self_adjoint_eigenvalues(Side::Lower).unwrap();
    for c in [1.4, 1.9, 2.0001, 2.3, 4.1, 5.0] {
        let (negative, off) = pattern.negative(c, &[(1.0, &values)]).expect("no pivot vanishes");
        let below = |c: f64| eigenvalues.iter().filter(|&&x| x < c).count();
        let count = |by: f64| 2 * below(c + by) + below((c + by) / 2.0);
        assert!(off < 1e-3 && count(-off) <= negative && negative <= count(off), "{c} {off}");
        assert_eq!(pattern.is_definite(-c, &[(1.0, &values)], 0.0), negative == 0, "{c}");
    }
}

#[test]
fn counts_products_and_solutions_are_those_of_the_dense_matrix() {
    let mut kinds = [0, 0];
    for (n, width) in [(1, 0), (40, 0), (60, 1), (90, 2), (30, 30), (70, 70), (120, 40), (400, 400)] {
        let (triplets, dense) = banded(n, width);
        let (pattern, [values]) = Pattern::of(n, [&triplets]).unwrap();
        kinds[usize::from(matches!(pattern.symbolic.raw(), SymbolicCholeskyRaw::Supernodal(_)))] += 1;
        let x = Mat::from_fn(n, 2, |i, j| (i + 3 * j) as f64 - 1.5);
        // Some hundred roundings of numbers up to some hundreds.
        assert!((pattern.times(&values, &x) - &dense * &x).norm_l2() < 1e-9);
        let eigenvalues = dense.self_adjoint_eigenvalues(Side::Lower).unwrap();
        let beyond = pattern.size_of(&values).0 + 1.0;
        for shift in [-3.0, -0.3, 0.1, 1.7, beyond] {
            let Some((negative, off)) = pattern.negative(shift, &[(1.0, &values)]) else { continue };
            let below = |by: f64| eigenvalues.iter().filter(|&&x| x < shift + by).count();
            // Without exchanges pivots can be small and the bound large: it holds all the same.
            assert!(below(-off) <= negative && negative <= below(off), "{n} {width} {shift} {off}");
            assert!(shift < beyond || negative == n && off < 1e-7, "{n} {width} {off}");
        }
        let positive = |c: f64| pattern.is_definite(c, &[(1.0, &values)], 0.0);
        // Below the least eigenvalue, and above it, by far more than what elimination may be off by.
        assert!(positive(1e-6 - eigenvalues[0]) && !positive(-1e-6 - eigenvalues[0]), "{n} {width}");
        let factors = pattern.factored(beyond, &[(1.0, &values)], 1e-3).expect("above all eigenvalues");
        let solved = factors.solve(x.clone()).unwrap();
        let back = pattern.times(&values, &solved) + &solved * faer::Scale(beyond);
        assert!((back - &x).norm_l2() < 0.01 * x.norm_l2());
        assert!(pattern.factored(-beyond, &[(1.0, &values)], 0.0).is_none());
    }
    assert!(kinds.iter().all(|&count| count > 0), "{kinds:?}");
}
