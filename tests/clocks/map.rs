//! Maps: Figure 1 of the paper, and agreement with tiers that share nothing with the kernel.

use crate::stress::random;
use kickdrift::error::Kind as ErrorKind;
use kickdrift::map::{
    Band, Counters, Grid, Map, Pairs, Products, Resources, Shard, Store, instruction_sets, merge,
};
use kickdrift::number::Laurent;
use kickdrift::number::parse::parse;
use kickdrift::number::rational::ratio;
use kickdrift::propagator::Oscillator;
use kickdrift::verdict::{Kind, Limits, Tier, decide, decide_from, growth};
use rayon::prelude::*;

const BOTH: Products = Products { label: true, growth: true };

fn grid(lambda1: &str, lambda2: &str, d: &str, (h1, h2): ((&str, &str), (&str, &str))) -> Grid {
    let x = |text: &str| parse("x", text).unwrap();
    let range = |(lo, hi): (&str, &str)| (x(lo), x(hi));
    Grid::new(x(lambda1), x(lambda2), [x(d), x(d)], range(h1), range(h2)).unwrap()
}

fn figure_1(d: &str) -> Grid {
    grid("pi^2", "pi^2/25", d, ((d, "2/pi"), (d, "7/2")))
}

#[test]
fn a_map_beyond_the_budget_is_refused_before_room_is_made_for_it() {
    let error = Map::of(&figure_1("1/400000")).verdicts().unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Budget);
    assert!(error.to_string().contains("days of one core"), "{error}");
}

fn bands(grid: &Grid, products: Products, shard: Shard, threads: usize) -> (Vec<(u64, Band)>, Counters) {
    let mut bands = Vec::new();
    let resources = Resources { threads, ..Resources::default() };
    let counters = Map::of(grid).with(products).shard(shard).within(resources).for_each_band(|n, band| {
        bands.push((n, band));
        Ok(())
    });
    (bands, counters.unwrap())
}

/// Pairs, unstable pairs, pairs beyond the filter.
fn count(d: &str) -> (u64, usize, usize) {
    let (bands, counters) = bands(&figure_1(d), Products::default(), Shard::WHOLE, 0);
    let sum = |f: &dyn Fn(&Band) -> usize| bands.iter().map(|(_, band)| f(band)).sum();
    let unstable =
        sum(&|band| (0..band.verdicts.len()).filter(|&n| !band.decision(n).verdict.is_stable()).count());
    (counters.pairs, unstable, sum(&|band| band.tiers.iter().filter(|&&tier| tier > 0).count()))
}

/// Every `stride`-th verdict of the grid against the ladder from `tier` up.
fn agrees(grid: &Grid, tier: Tier, stride: usize) {
    for (_, band) in bands(grid, Products::default(), Shard::WHOLE, 0).0 {
        for n in (0..band.verdicts.len()).step_by(stride) {
            let (i, j) = band.multipliers(grid, n);
            let clocks = grid.clocks(i, j).unwrap();
            let other = decide_from(tier, &clocks, &Limits::default()).unwrap();
            assert_eq!(band.decision(n).verdict, other.verdict, "i = {i}, j = {j} of {}", grid.fingerprint());
        }
    }
}

#[test]
fn figure_1_at_a_hundredth() {
    assert_eq!(count("1/100"), (22_050, 2_075, 0));
}

#[test]
#[ignore = "long in unoptimized builds"]
fn figure_1_at_a_five_hundredth_and_a_thousandth() {
    assert_eq!(count("1/500"), (556_500, 55_092, 0));
    assert_eq!(count("1/1000"), (2_226_000, 218_848, 0));
}

#[test]
fn kicks_and_drifts_one_by_one_agree() {
    agrees(&figure_1("1/100"), Tier::Refine, 41);
}

#[test]
#[ignore = "long"]
fn kicks_and_drifts_one_by_one_agree_everywhere() {
    agrees(&figure_1("1/100"), Tier::Refine, 1);
    agrees(&figure_1("1/1000"), Tier::Refine, 223);
}

/// The verdicts of a whole grid by column and row, and how to find one.
fn verdicts(grid: &Grid) -> impl Fn((u64, u64)) -> u8 + Sync {
    let all: Vec<u8> = bands(grid, Products::default(), Shard::WHOLE, 0)
        .0
        .into_iter()
        .flat_map(|(_, band)| band.verdicts)
        .collect();
    let ((first, _), (low, high)) = (grid.columns(), grid.rows());
    move |(i, j)| all[((i - first) * (high - low + 1) + j - low) as usize]
}

/// The pairs' verdicts against kicks and drifts one by one in 128 bits and more.
fn agree_with_refine(grid: &Grid, pairs: &[(u64, u64)]) {
    let verdict = verdicts(grid);
    pairs.par_iter().for_each(|&(i, j)| {
        let other = decide_from(Tier::Refine, &grid.clocks(i, j).unwrap(), &Limits::default()).unwrap();
        assert_eq!(verdict((i, j)), other.verdict.index(), "i = {i}, j = {j}");
    });
}

#[test]
#[ignore = "a minute or two"]
fn a_hundred_thousand_random_pairs_agree() {
    let grid = figure_1("1/1000");
    let ((first, last), (low, high)) = (grid.columns(), grid.rows());
    let mut numbers = random::Random::new(20_261_121);
    let mut random = |lo: u64, hi: u64| lo + numbers.below(hi - lo + 1);
    let pairs: Vec<(u64, u64)> = (0..100_000).map(|_| (random(first, last), random(low, high))).collect();
    agree_with_refine(&grid, &pairs);
}

#[test]
#[ignore = "half a minute"]
fn the_ten_thousand_pairs_nearest_to_an_edge_agree() {
    let grid = figure_1("1/1000");
    let ((first, last), (low, high)) = (grid.columns(), grid.rows());
    let mut near: Vec<(f64, (u64, u64))> = (first..=last)
        .into_par_iter()
        .flat_map_iter(|i| (low..=high).map(move |j| (distance_to_edge(i, j), (i, j))))
        .collect();
    near.select_nth_unstable_by(10_000, |x, y| x.0.total_cmp(&y.0));
    let (near, rest) = near.split_at(10_000);
    assert!(near.iter().all(|(distance, _)| distance <= &rest[0].0 && *distance < 1e-2));
    agree_with_refine(&grid, &near.iter().map(|&(_, pair)| pair).collect::<Vec<_>>());
}

/// ||Tr| - 2| of the pair (i, j)/1000 of Figure 1 as a loop in doubles has it: good enough to choose by.
fn distance_to_edge(i: u64, j: u64) -> f64 {
    let common = num_integer::gcd(i, j);
    let (p, q) = (j / common, i / common);
    let pi2 = std::f64::consts::PI.powi(2);
    // The common unit of time d gcd; in it h1 = q, h2 = p.
    let unit = common as f64 * 1e-3;
    let (fast, slow) = (unit * q as f64 * pi2, unit * p as f64 * pi2 / 25.0);
    let (mut even, mut odd, mut now, mut next) = ([1.0, 0.0], [0.0, 1.0], 0, [0, 0]);
    loop {
        let t = next[0].min(next[1]);
        if 2 * t > p * q {
            break;
        }
        let half = if t == 0 || 2 * t == p * q { 0.5 } else { 1.0 };
        let mut kick = 0.0;
        for (n, step, strength) in [(0, q, fast), (1, p, slow)] {
            if next[n] == t {
                kick += half * strength;
                next[n] += step;
            }
        }
        let drift = (t - now) as f64 * unit;
        for state in [&mut even, &mut odd] {
            state[0] += drift * state[1];
            state[1] -= kick * state[0];
        }
        now = t;
    }
    let rest = (p * q) as f64 / 2.0 - now as f64;
    let [a, b] = [even, odd].map(|state| state[0] + rest * unit * state[1]);
    let distance = (4.0 * b * even[1]).abs().min((4.0 * a * odd[1]).abs());
    if distance.is_nan() { f64::INFINITY } else { distance }
}

#[test]
fn exact_arithmetic_agrees_where_stiffnesses_are_rational() {
    // lambda1 = 100, d = 1/20: s = i²/4 meets s = 1 and s = 4 exactly, and goes beyond Verlet's limit.
    for lambda2 in ["1/10", "50", "100", "400", "4", "-4", "-120"] {
        let grid = grid("100", lambda2, "1/20", (("1/20", "1/4"), ("1/20", "3/2")));
        agrees(&grid, Tier::Exact, 1);
    }
    // Kicks too strong for the filter, and a force that is not there.
    agrees(&grid("10^6", "10^9", "1/20", (("1/20", "1/4"), ("1/20", "1/2"))), Tier::Exact, 1);
    agrees(&grid("100", "0", "1/20", (("1/20", "1/4"), ("1/20", "1"))), Tier::Exact, 1);
}

#[test]
fn exact_ties_are_found_and_named() {
    let grid = grid("100", "4", "1/20", (("1/20", "1/4"), ("1/20", "3/2")));
    let (bands, _) = bands(&grid, Products::default(), Shard::WHOLE, 0);
    let ties = |kind| {
        let in_band = |band: &Band| {
            (0..band.verdicts.len()).filter(|&n| band.decision(n).verdict.kind() == kind).count()
        };
        bands.iter().map(|(_, band)| in_band(band)).sum::<usize>()
    };
    // h1 = 1/10: th = pi/3, so that h2 = 3/10, 6/10, ... sit on the edge of a tongue.
    assert!(ties(Kind::Parabolic) >= 5);
    assert_eq!(ties(Kind::Coexistence), 0);
}

#[test]
fn windows_with_steps_of_their_own_agree() {
    let x = |text: &str| parse("x", text).unwrap();
    for (d1, d2) in [("1/7", "3/35"), ("pi/90", "7*pi/300"), ("1/1000", "1/10")] {
        let range = |lo, hi| (x(lo), x(hi));
        let grid =
            Grid::new(x("9"), x("1/3"), [x(d1), x(d2)], range("0.2", "0.66"), range("0.1", "2.2")).unwrap();
        agrees(&grid, Tier::Refine, 1 + grid.pairs() as usize / 300);
    }
}

#[test]
fn a_wide_grid_agrees() {
    // h1 a million times h2: the tables of turns are those of a band, not of the whole row.
    let grid = grid("10^-14", "100", "1/1000", (("1/1000", "700"), ("1/1000", "2/1000")));
    assert_eq!(grid.shape(), (700_000, 2));
    let (all, counters) = bands(&grid, Products::default(), Shard::WHOLE, 0);
    assert!(all.len() > 10);
    // One or two slow steps in a fast one: an update a pair at most, and the ladder for next to none.
    assert!(counters.kicks <= 2 * counters.pairs && counters.escalated < 100, "{counters:?}");
    for (_, band) in all.iter().step_by(all.len() / 3) {
        let (i, j) = band.multipliers(&grid, 1);
        let other = decide_from(Tier::Refine, &grid.clocks(i, j).unwrap(), &Limits::default()).unwrap();
        assert_eq!(band.decision(1).verdict, other.verdict, "i = {i}, j = {j}");
    }
}

#[test]
fn labels_and_growth_are_those_of_the_single_pair() {
    assert!(compared_with_single_pairs(&figure_1("1/60")) > 100);
}

/// Where no clock has Floquet coordinates: one beyond its Verlet limit, the other too, or pulling the wrong
/// way.
#[test]
fn labels_and_growth_without_floquet_coordinates_are_those_of_the_single_pair() {
    let beyond = grid("pi^2", "pi^2/25", "1/40", (("13/20", "1"), ("33/10", "4")));
    assert!(compared_with_single_pairs(&beyond) > 80);
    let repelled = grid("pi^2", "-2", "1/40", (("13/20", "1"), ("1/10", "1")));
    assert!(compared_with_single_pairs(&repelled) > 80);
}

/// How many labels and growths of the map were compared.
fn compared_with_single_pairs(grid: &Grid) -> usize {
    let mut seen = 0;
    for (_, band) in bands(grid, BOTH, Shard::WHOLE, 0).0 {
        let hyperbolic = |&n: &usize| band.decision(n).verdict.kind() == Kind::Hyperbolic;
        assert_eq!(band.growing.len(), (0..band.verdicts.len()).filter(hyperbolic).count());
        for found in band.growing.iter().step_by(5) {
            let n = found.position as usize;
            let (i, j) = band.multipliers(grid, n);
            let single =
                growth(&grid.clocks(i, j).unwrap(), band.decision(n).verdict, &Limits::default()).unwrap();
            assert_eq!(found.label, single.label);
            // m = a p + b q.
            let ratio = grid.ratio(i, j);
            let ((p, q), (a, b)) = (ratio.terms(), found.family(ratio).unwrap());
            assert_eq!(a * p as i64 + b * q as i64, found.label.unwrap() as i64);
            let (ours, exact) =
                (found.ln_multiplier.unwrap(), single.ln_multiplier.unwrap().to_f64_enclosure());
            // The single pair's is known to 60 bits.
            assert!(ours.lo <= exact.0 && exact.1 <= ours.hi, "{ours:?} {exact:?} at ({i}, {j})");
            assert!(ours.width() <= 1e-6 * ours.lo, "{ours:?} at ({i}, {j})");
            seen += 1;
        }
    }
    seen
}

/// Growth next to edges, where BC or AD loses its digits in doubles: the enclosures hold and are narrow all
/// the same.
#[test]
fn growth_next_to_an_edge_is_enclosed() {
    // Edges that sit on p th = m pi: s = 1, th = pi/3 for 3/1; s = 3, th = 2 pi/3 for 3/2.
    for (h1, h2, s) in [("1", "3", 1), ("2", "3", 3)] {
        for k in 3..16 {
            let lambda1 = format!("{s}*(1 - 1/10^{k})/{h1}^2");
            let grid = grid(&lambda1, "1/25", "1", ((h1, h1), (h2, h2)));
            let (all, _) = bands(&grid, Products { growth: true, label: false }, Shard::WHOLE, 1);
            let [found] = all[0].1.growing[..] else { panic!("{lambda1}: a pair in a tongue") };
            let (i, j) = (grid.columns().0, grid.rows().0);
            let single =
                growth(&grid.clocks(i, j).unwrap(), all[0].1.decision(0).verdict, &Limits::default());
            let (ours, exact) =
                (found.ln_multiplier.unwrap(), single.unwrap().ln_multiplier.unwrap().to_f64_enclosure());
            assert!(ours.lo <= exact.0 && exact.1 <= ours.hi, "{lambda1}: {ours:?} {exact:?}");
            assert!(ours.width() <= 1e-6 * ours.lo, "{lambda1}: {ours:?}");
        }
    }
}

#[test]
fn threads_and_shards_change_nothing() {
    let grid = figure_1("1/150");
    let (whole, counters) = bands(&grid, BOTH, Shard::WHOLE, 1);
    assert!(whole.len() > 1);
    assert_eq!(bands(&grid, BOTH, Shard::WHOLE, 3).0, whole);
    let mut parts: Vec<_> =
        (1..=3).flat_map(|k| bands(&grid, BOTH, Shard::new(k, 3).unwrap(), 2).0).collect();
    parts.sort_by_key(|(n, _)| *n);
    assert_eq!(parts, whole);
    assert_eq!(counters.pairs, grid.pairs());
}

#[test]
fn stopped_work_goes_on_and_parts_join_to_the_same_map() {
    let grid = figure_1("1/150");
    let directory = std::env::temp_dir().join(format!("kickdrift-map-{}", std::process::id()));
    let store = Store::open(&directory, &grid, BOTH).unwrap();
    let shard = |k| Shard::new(k, 2).unwrap();
    // Stopped after the first band of the first shard; the second is missing.
    let stop = |_, _| Err(kickdrift::error::Error::io("output", "stopped"));
    let one = Resources { threads: 1, ..Resources::default() };
    let kept = Map::of(&grid).with(BOTH).kept_in(&store);
    kept.shard(shard(1)).within(one).for_each_band(stop).unwrap_err();
    assert!(
        merge(&grid, std::slice::from_ref(&store), |_, _| Ok(()))
            .unwrap_err()
            .to_string()
            .contains("is whole in no part")
    );
    for k in [1, 2] {
        kept.shard(shard(k)).for_each_band(|_, _| Ok(())).unwrap();
    }
    // A damaged file is not there, nor is that of another map.
    let (whole, counters) = bands(&grid, BOTH, Shard::WHOLE, 0);
    let file = directory.join("band-00000001");
    let mut bytes = std::fs::read(&file).unwrap();
    bytes[300] ^= 1;
    std::fs::write(&file, bytes).unwrap();
    assert!(store.load(1).is_none() && store.load(0).is_some());
    assert!(Store::open(&directory, &grid, Products::default()).unwrap().load(0).is_none());
    kept.for_each_band(|_, _| Ok(())).unwrap();
    let mut joined = Vec::new();
    let sums = merge(&grid, std::slice::from_ref(&store), |n, band| {
        joined.push((n, band));
        Ok(())
    });
    assert_eq!((joined, sums.unwrap()), (whole, counters));
    std::fs::remove_dir_all(directory).unwrap();
}

#[test]
fn wanting_less_does_less() {
    let grid = figure_1("1/100");
    let (bare, full) =
        (bands(&grid, Products::default(), Shard::WHOLE, 0), bands(&grid, BOTH, Shard::WHOLE, 0));
    assert_eq!((bare.1.kicks_again, bare.1.kicks), (0, full.1.kicks));
    assert!(bare.0.iter().all(|(_, band)| band.growing.is_empty()));
    // Only pairs in tongues are run again.
    assert!(0 < full.1.kicks_again && 4 * full.1.kicks_again < full.1.kicks);
}

#[test]
fn impossible_grids_are_refused_by_name() {
    let x = |text: &str| parse("x", text).unwrap();
    let grid = |l1, d1, d2, hi| {
        Grid::new(x(l1), x("1"), [x(d1), x(d2)], (x("1"), x(hi)), (x("1"), x("2"))).unwrap_err()
    };
    assert!(grid("0", "1", "1", "2").to_string().starts_with("lambda1 = 0"));
    assert!(grid("1", "-1", "1", "2").to_string().starts_with("step1 = -1"));
    assert!(grid("1", "1", "pi/9", "2").to_string().starts_with("step2/step1 = (pi/9)/(1)"));
    assert!(grid("1", "3", "3", "2").to_string().starts_with("h1-range = 1..2"));
    assert_eq!(grid("1", "10^-9", "1", "2").kind(), ErrorKind::Budget);
}

#[test]
fn the_cost_is_told_before_the_work_begins() {
    let x = |text: &str| parse("x", text).unwrap();
    for (d1, d2) in [("1/150", "1/150"), ("1/200", "3/400"), ("1/100", "1/130")] {
        let range = |lo, hi| (x(lo), x(hi));
        let grid =
            Grid::new(x("9"), x("1/3"), [x(d1), x(d2)], range("1/100", "0.66"), range("1/100", "3")).unwrap();
        let (told, counters) = (grid.kicks(), Map::of(&grid).for_each_band(|_, _| Ok(())).unwrap());
        assert!((told / counters.kicks as f64 - 1.0).abs() < 0.02, "{told} for {}", counters.kicks);
    }
    // 2.2 million pairs take 2.45e8 kicks, a million times as many 2.4e17, and 6.2e16 where none counts more
    // than 2^15.
    let fine = figure_1("1/1000000");
    assert!((fine.kicks() / 6.2e16 - 1.0).abs() < 0.02, "{:e}", fine.kicks());
    let refused = Map::of(&fine).for_each_band(|_, _| panic!("no band is computed")).unwrap_err();
    assert_eq!(refused.kind(), ErrorKind::Budget);
    assert!(refused.to_string().contains("2228166500000 pairs"), "{refused}");
    // What it asks for is enough.
    let needed = refused.needed().unwrap();
    assert!(needed as f64 * 1e4 >= fine.kicks() && (needed as f64) < 1.01e-4 * fine.kicks(), "{needed}");
}

#[test]
fn a_map_is_a_vector_and_stops_when_told() {
    let grid = figure_1("1/150");
    let all = Map::of(&grid).verdicts().unwrap();
    let verdict = verdicts(&grid);
    let rows = grid.shape().1 as u64;
    assert!((0..).zip(&all).all(|(n, found)| found.index() == verdict((1 + n / rows, 1 + n % rows))));
    // A part into a slice of the caller's, with progress.
    let part = Map::of(&grid).shard(Shard::new(2, 2).unwrap());
    let mut slice = vec![all[0]; Shard::new(2, 2).unwrap().pairs(&grid) as usize];
    let mut done = Vec::new();
    part.fill(&mut slice, |pairs| done.push(pairs)).unwrap();
    assert_eq!(done.last(), Some(&(slice.len() as u64)));
    assert!(all.windows(slice.len().min(1000)).any(|window| *window == slice[..window.len()]));
    assert!(part.fill(&mut slice[1..], |_| ()).unwrap_err().to_string().contains("must hold"));
    let stopped = std::sync::atomic::AtomicBool::new(false);
    let resources = Resources { threads: 1, stopped: Some(&stopped), ..Resources::default() };
    let mut seen = 0;
    let error = Map::of(&grid).within(resources).for_each_band(|_, _| {
        seen += 1;
        stopped.store(true, std::sync::atomic::Ordering::Relaxed);
        Ok(())
    });
    // The bands that were under way are handed on.
    assert!(seen >= 1, "{seen}");
    assert!(error.is_ok() || error.unwrap_err().kind() == ErrorKind::Stopped);
    assert_eq!(Map::of(&grid).within(resources).verdicts().unwrap_err().kind(), ErrorKind::Stopped);
}

#[test]
fn scattered_pairs_side_by_side_are_those_of_the_ladder() {
    let mut numbers = random::Random::new(20_261_122);
    let mut pair = || {
        // Beyond Verlet's limit, with no slow force and with a repelling one too.
        let lambda1 = ratio(1 + numbers.below(4300) as i64, 1000);
        let lambda2 = &lambda1 * ratio(numbers.below(1000) as i64 - 100, 500);
        let h2 = ratio(1 + numbers.below(200) as i64, 1 + numbers.below(200) as i64);
        [lambda1, lambda2, ratio(1, 1), h2].map(Laurent::from_rational)
    };
    let all: Vec<[Laurent; 4]> = (0..3000).map(|_| pair()).collect();
    let picked = std::array::from_fn(|_| (0..all.len()).collect());
    let quantities = std::array::from_fn(|k| all.iter().map(|own| own[k].clone()).collect());
    let pairs = Pairs::new(quantities, picked).unwrap();
    let found = pairs.verdicts(&Resources::default()).unwrap();
    assert_eq!(found.len(), all.len());
    for (own, found) in all.into_iter().zip(found) {
        let shown = format!("{own:?}");
        let [lambda1, lambda2, h1, h2] = own;
        let oscillator = Oscillator::new(lambda1, lambda2, h1, h2).unwrap();
        let truth = decide(&oscillator.clocks().unwrap(), &Limits::default()).unwrap().verdict;
        assert_eq!(found.verdict, truth, "{shown}");
    }
    let few = Resources { limits: Limits { kicks: 3 }, ..Resources::default() };
    assert_eq!(pairs.verdicts(&few).unwrap_err().kind(), ErrorKind::Budget);
}

#[test]
fn pairs_made_of_few_quantities_are_decided_as_each_alone() {
    let mut numbers = random::Random::new(20_261_123);
    let pi = |k: i32, c| Laurent::monomial(c, k);
    // Rational ones and powers of pi, a sum of both, none and repelling; steps in units of pi too, one too
    // long for doubles.
    let sum = &pi(2, ratio(1, 30)) + &pi(0, ratio(1, 7));
    let lambda1 = vec![pi(2, ratio(1, 1)), pi(0, ratio(10, 1)), sum.clone()];
    let lambda2 = vec![pi(2, ratio(1, 25)), pi(0, ratio(0, 1)), pi(0, ratio(-3, 10)), sum];
    let long = Laurent::from_rational(ratio(4001, 4003));
    let mut steps: Vec<Laurent> =
        (0..60).map(|_| pi(0, ratio(1 + numbers.below(400) as i64, 1 + numbers.below(500) as i64))).collect();
    steps.extend((1..20).map(|n| pi(0, ratio(2, n))));
    let upto = |n: usize, numbers: &mut random::Random| numbers.below(n as u64) as usize;
    let mut picked: [Vec<usize>; 4] = Default::default();
    for _ in 0..800 {
        for (picked, count) in picked.iter_mut().zip([3, 4, steps.len(), steps.len()]) {
            picked.push(upto(count, &mut numbers));
        }
    }
    let lists = [lambda1, lambda2, steps.clone(), steps];
    let exact = |lists: &[Vec<Laurent>; 4], picked: &[Vec<usize>; 4], n: usize| {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| lists[k][picked[k][n]].clone());
        Oscillator::new(a, b, c, d).unwrap().clocks().unwrap()
    };
    let found = Pairs::new(lists.clone(), picked.clone()).unwrap().verdicts(&Resources::default()).unwrap();
    assert_eq!(found.len(), 800);
    for (n, found) in found.iter().enumerate() {
        let clocks = exact(&lists, &picked, n);
        assert_eq!(found.verdict, decide(&clocks, &Limits::default()).unwrap().verdict, "{clocks:?}");
    }
    let first = |x: &Laurent| vec![x.clone()];
    let one = Laurent::from_rational(ratio(1, 1));
    let of_steps =
        |h1: &Laurent, h2: &Laurent| Pairs::of_steps(one.clone(), one.clone(), [[h1.clone(), h2.clone()]]);
    let few = Resources { limits: Limits { kicks: 1000 }, ..Resources::default() };
    let refused = |pairs: Pairs| pairs.verdicts(&few).unwrap_err();
    assert_eq!(refused(of_steps(&one, &long).unwrap()).kind(), ErrorKind::Budget);
    assert_eq!(refused(of_steps(&one, &pi(1, ratio(1, 3))).unwrap()).field(), "h2/h1");
    assert_eq!(of_steps(&one, &pi(0, ratio(-1, 3))).unwrap_err().field(), "h2");
    let uneven = [first(&one), first(&one), first(&one), first(&one)];
    assert!(Pairs::new(uneven.clone(), [vec![0], vec![0], vec![0], vec![]]).is_err());
    assert_eq!(Pairs::new(uneven, [vec![0], vec![1], vec![0], vec![0]]).unwrap_err().field(), "lambda2");
    // The doubles 2.5 and 2.54: both clocks beyond their own limits, for a period of 2^52 kicks and more.
    let steps = [[0.5, 0.25], [2.5456041358732118, 1.8315760255619316]];
    let steps = steps.map(|pair| pair.map(|h| Laurent::try_from(h).unwrap()));
    let [fast, slow] = ["10", "1"].map(|text| parse("quantity", text).unwrap());
    let strong = Pairs::of_steps(fast, slow, steps).unwrap().verdicts(&Resources::default()).unwrap_err();
    assert!(strong.field().starts_with("pair 1: 256 bits do not decide the verdict"), "{strong}");
    let none = Pairs::of_steps(one.clone(), one.clone(), []).unwrap();
    assert_eq!(none.verdicts(&Resources::default()).unwrap(), []);
}

/// All instruction sets give the same bits: verdicts, tiers, labels and the ends of every enclosure.
#[test]
fn every_instruction_set_gives_the_same_map() {
    let grid = figure_1("1/60");
    let sets = instruction_sets();
    let forced = |set: &String| {
        assert!(kickdrift::force_instructions(set), "{set}");
        bands(&grid, BOTH, Shard::WHOLE, 1)
    };
    let maps: Vec<_> = sets.iter().map(forced).collect();
    assert!(kickdrift::force_instructions(&sets[0]));
    assert!(maps.windows(2).all(|two| two[0] == two[1]));
}
