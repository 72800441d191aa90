//! Boxes in which every ratio is proven unstable, held against the ladder.

use kickdrift::band::{Bands, Cell, Window};
use kickdrift::number::parse::parse;
use kickdrift::number::{Laurent, Rational, rational};
use kickdrift::propagator::Oscillator;
use kickdrift::verdict::{Kind, Limits, decide};

fn x(text: &str) -> Laurent {
    parse("quantity", text).unwrap()
}

fn figure1() -> Window {
    Window::new([x("pi^2"), x("pi^2/25")], [(x("0"), x("2/pi")), (x("0"), x("7/2"))]).unwrap()
}

fn search(window: &Window, tries: u64) -> Bands {
    window.search(tries, None, &|_| ()).unwrap()
}

fn kind(window: &Window, h1: &Laurent, ratio: &Rational) -> Kind {
    let [lambda1, lambda2] = window.lambdas().clone();
    let h2 = h1 * &Laurent::from_rational(ratio.clone());
    let clocks = Oscillator::new(lambda1, lambda2, h1.clone(), h2).unwrap().clocks().unwrap();
    decide(&clocks, &Limits::default()).unwrap().verdict.kind()
}

/// A rational number p/q near a share of the way from lo to hi, between them.
fn ratio_between(lo: f64, hi: f64, share: f64, q: u64) -> Option<Rational> {
    let p = ((lo + share * (hi - lo)) * q as f64).round();
    let ratio = Rational::new((p as u64).into(), q.into());
    let near = rational::to_f64(&ratio);
    (lo < near && near < hi && p > 0.0).then_some(ratio)
}

/// Thousands of pairs at random places of boxes of all sizes, with periods up to some thousands of kicks: every one is unstable.
fn all_pairs_are_unstable(window: &Window, bands: &Bands, pairs: usize) {
    // splitmix64 (Steele, Lea, Flood 2014).
    let mut state = 29u64;
    let mut share = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    };
    let (mut decided, count) = (0, bands.certified.len());
    for n in 0.. {
        if decided == pairs {
            break;
        }
        assert!(n < 40 * pairs, "only {decided} pairs found");
        // From the largest to the smallest ones.
        let cell = &bands.certified[n * 7919 % count];
        let [(lo1, hi1), (lo2, hi2)] = [0, 1].map(|step| window.range(cell, step));
        let along = rational::from_f64_exact(share()).unwrap();
        let h1 = &lo1 + &(&(&hi1 - &lo1) * &Laurent::from_rational(along));
        let (h, lo, hi) = (h1.to_f64(), lo2.to_f64(), hi2.to_f64());
        let q = 1 + (1000.0 * share() * share()) as u64;
        let Some(ratio) = ratio_between(lo / h, hi / h, share(), q) else { continue };
        assert_eq!(kind(window, &h1, &ratio), Kind::Hyperbolic, "{cell:?}: h1 = {h1}, h2/h1 = {ratio}");
        decided += 1;
    }
}

#[test]
fn every_pair_in_a_box_is_unstable() {
    let window = figure1();
    let bands = search(&window, 100_000);
    // The share that two maps of one level alone reach at level 4 is 4.5 %, after far more work.
    assert!(bands.share() > rational::ratio(3, 100), "{}", rational::to_f64(&bands.share()));
    all_pairs_are_unstable(&window, &bands, 2500);
}

#[test]
fn strong_kicks_equal_stiffnesses_and_negative_ones() {
    for [lambda1, lambda2] in [["1", "1"], ["10", "6"], ["1", "-1/9"], ["1/9", "1"]] {
        let ranges = [(x("1/10"), x("21/10")), (x("1/10"), x("3"))];
        let window = Window::new([x(lambda1), x(lambda2)], ranges).unwrap();
        let bands = search(&window, 20_000);
        assert!(!bands.certified.is_empty(), "{lambda1}, {lambda2}");
        all_pairs_are_unstable(&window, &bands, 150);
    }
}

#[test]
fn no_stable_pair_lies_in_a_box() {
    let window = figure1();
    let bands = search(&window, 60_000);
    let ends = |cell: &Cell, step: usize| {
        let (lo, hi) = window.range(cell, step);
        (lo.to_f64(), hi.to_f64())
    };
    let boxes: Vec<[(f64, f64); 2]> =
        bands.certified.iter().map(|cell| [ends(cell, 0), ends(cell, 1)]).collect();
    // All pairs of a coarse grid: h1 = 2 i/(97 pi), h2/h1 = j/23.
    let mut stable = 0;
    for i in 1..97 {
        let h1 = &x("2/pi") * &Laurent::from_rational(rational::ratio(i, 97));
        for j in (1..400).step_by(7) {
            let ratio = rational::ratio(j, 23);
            let h2 = rational::to_f64(&ratio) * h1.to_f64();
            if h2 > 3.5 || kind(&window, &h1, &ratio) != Kind::Elliptic {
                continue;
            }
            stable += 1;
            let holds = |(lo, hi): &(f64, f64), h: f64| *lo <= h && h <= *hi;
            let at = h1.to_f64();
            let inside = boxes.iter().find(|own| holds(&own[0], at) && holds(&own[1], h2));
            assert_eq!(inside, None, "h1 = {h1}, h2/h1 = {ratio}");
        }
    }
    assert!(stable > 1000, "{stable}");
}

#[test]
fn more_trials_keep_every_box_and_add_to_the_area() {
    let window = figure1();
    let mut before = search(&window, 0);
    assert!(before.certified.is_empty() && before.share() == Rational::default());
    for tries in [1000, 10_000, 30_000, 60_000] {
        let bands = search(&window, tries);
        assert!(bands.tried <= tries && bands.share() >= before.share());
        assert!(before.certified.iter().all(|cell| bands.certified.contains(cell)));
        before = bands;
    }
    // A goal ends the search as soon as it is reached.
    let goal = rational::ratio(1, 100);
    let bands = window.search(60_000, Some(&goal), &|_| ()).unwrap();
    assert!(bands.share() >= goal && bands.tried < before.tried);
}

#[test]
fn boxes_do_not_overlap_and_lie_in_the_window() {
    let window = figure1();
    let bands = search(&window, 40_000);
    for cell in &bands.certified {
        assert!((0..2).all(|step| cell.places[step] < 1 << cell.depths[step]));
        assert!(window.proves(cell), "{cell:?}");
    }
    // Two dyadic boxes overlap where in both steps one interval holds the other.
    let meet = |a: &Cell, b: &Cell, step: usize| {
        let depth = a.depths[step].min(b.depths[step]);
        a.places[step] >> (a.depths[step] - depth) == b.places[step] >> (b.depths[step] - depth)
    };
    for (n, a) in bands.certified.iter().enumerate() {
        for b in &bands.certified[..n] {
            assert!(!(meet(a, b, 0) && meet(a, b, 1)), "{a:?}, {b:?}");
        }
    }
}

#[test]
fn windows_without_sense_are_refused() {
    let refused = |lambdas: [&str; 2], h1: [&str; 2]| {
        let ranges = [(x(h1[0]), x(h1[1])), (x("0"), x("1"))];
        Window::new(lambdas.map(x), ranges).unwrap_err().to_string()
    };
    assert!(refused(["1", "1"], ["1", "1"]).starts_with("h1-range = 1..1: "));
    assert!(refused(["1", "1"], ["-1", "1"]).starts_with("h1-range = -1..1: "));
    assert!(refused(["-1", "0"], ["0", "1"]).starts_with("lambda1 = -1: "));
}
