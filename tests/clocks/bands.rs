//! Sectors in which every ratio is proven unstable, held against the ladder.

use std::sync::OnceLock;

use kickdrift::band::{Bands, Sector, Window};
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

/// Those of figure 1 after 40,000 trials: seconds, once for all tests.
fn of_figure1() -> (Window, &'static Bands) {
    static BANDS: OnceLock<Bands> = OnceLock::new();
    (figure1(), BANDS.get_or_init(|| search(&figure1(), 40_000)))
}

/// Verdict and label.
fn kind(window: &Window, h1: &Laurent, ratio: &Rational) -> (Kind, Option<u64>) {
    let [lambda1, lambda2] = window.lambdas().clone();
    let h2 = h1 * &Laurent::from_rational(ratio.clone());
    let clocks = Oscillator::new(lambda1, lambda2, h1.clone(), h2).unwrap().clocks().unwrap();
    let answer = decide(&clocks, &Limits::default()).unwrap();
    (answer.verdict.kind(), answer.label().unwrap())
}

fn ends(sector: &Sector) -> [Rational; 2] {
    sector.ratios.map(|(p, q)| Rational::new(p.into(), q.into()))
}

/// A rational number p/q near a share of the way from lo to hi, between them.
fn ratio_between([lo, hi]: &[Rational; 2], share: f64, q: u64) -> Option<Rational> {
    let at = lo + (hi - lo) * rational::from_f64_exact(share).unwrap();
    let ratio = (at * Rational::from_integer(q.into())).round() / Rational::from_integer(q.into());
    (*lo <= ratio && ratio <= *hi).then_some(ratio)
}

/// Numbers from 0 to 1: splitmix64 (Steele, Lea, Flood 2014).
fn shares() -> impl FnMut() -> f64 {
    let mut state = 29u64;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Thousands of pairs at random places of sectors of all sizes, with periods up to some thousands of kicks:
/// every one is unstable, in the tongue that the sector names.
fn all_pairs_are_unstable(window: &Window, bands: &Bands, pairs: usize) {
    let mut share = shares();
    let count = bands.certified.len();
    for n in 0..pairs {
        let sector = &bands.certified[n * 7919 % count];
        let q = 1 + (1000.0 * share() * share()) as u64;
        // Ends are as simple as there are where no ratio q is between them.
        let end = ends(sector)[n % 2].clone();
        let ratio = ratio_between(&ends(sector), share(), q).unwrap_or(end);
        let [lower, upper] = sector.sides_at(&ratio);
        let along = rational::from_f64_exact(share()).unwrap();
        let h1 = Laurent::from_rational(&lower + (&upper - &lower) * along);
        let [a, b] = sector.family;
        let label = ratio.numer() * a + ratio.denom() * b;
        let (kind, found) = kind(window, &h1, &ratio);
        assert_eq!(kind, Kind::Hyperbolic, "{sector:?}: h1 = {h1}, h2/h1 = {ratio}");
        assert_eq!(label, found.unwrap().into(), "{sector:?}: h1 = {h1}, h2/h1 = {ratio}");
    }
}

#[test]
fn every_pair_in_a_sector_is_unstable() {
    let (window, bands) = of_figure1();
    assert!(bands.share().0 > 0.06, "{:?}", bands.share());
    all_pairs_are_unstable(&window, bands, 2500);
}

#[test]
fn strong_kicks_and_equal_stiffnesses() {
    for [lambda1, lambda2] in [["1", "1"], ["10", "6"], ["1/9", "1"], ["1/100000", "1"]] {
        let ranges = [(x("1/10"), x("21/10")), (x("1/10"), x("3"))];
        let window = Window::new([x(lambda1), x(lambda2)], ranges).unwrap();
        let bands = search(&window, 10_000);
        assert!(!bands.certified.is_empty(), "{lambda1}, {lambda2}");
        all_pairs_are_unstable(&window, &bands, 150);
    }
}

#[test]
fn windows_of_any_size_and_unit() {
    // The same window in seconds, in a unit with more digits than a double holds exactly, and a small one
    // about h1 = 0.249, h2 = 0.94.
    let windows = [
        (["10^28*pi^2", "10^28*pi^2/25"], ["1/5*10^-14..1/4*10^-14", "9/10*10^-14..10^-14"]),
        (["10^58*pi^2", "10^58*pi^2/25"], ["1/5*10^-29..1/4*10^-29", "9/10*10^-29..10^-29"]),
        (["pi^2", "pi^2/25"], ["0.249..0.2490001", "0.94..0.9400001"]),
    ];
    for (lambdas, ranges) in windows {
        let ranges = ranges.map(|range| {
            let (lo, hi) = range.split_once("..").unwrap();
            (x(lo), x(hi))
        });
        let window = Window::new(lambdas.map(x), ranges).unwrap();
        let bands = search(&window, 200);
        assert!(bands.share().0 > 0.2, "{lambdas:?}: {:?}", bands.share());
        all_pairs_are_unstable(&window, &bands, 50);
    }
}

// Ledger: bands; all pairs of a grid, sectors of figure 1; the verdict on each pair
#[test]
fn no_stable_pair_lies_in_a_sector() {
    let (window, bands) = of_figure1();
    // All pairs of a coarse grid: h1 = 2 i/(97 pi), h2/h1 = j/23.
    let mut stable = 0;
    for j in (1..400).step_by(7) {
        let ratio = rational::ratio(j, 23);
        let about: Vec<[f64; 2]> = bands
            .certified
            .iter()
            .filter(|sector| ends(sector)[0] <= ratio && ratio <= ends(sector)[1])
            .map(|sector| sector.sides_at(&ratio).map(|h1| rational::to_f64(&h1)))
            .collect();
        for i in 1..97 {
            let h1 = &x("2/pi") * &Laurent::from_rational(rational::ratio(i, 97));
            let at = h1.to_f64();
            if rational::to_f64(&ratio) * at > 3.5 || kind(&window, &h1, &ratio).0 != Kind::Elliptic {
                continue;
            }
            stable += 1;
            let inside = about.iter().find(|[lower, upper]| *lower <= at && at <= *upper);
            assert_eq!(inside, None, "h1 = {h1}, h2/h1 = {ratio}");
        }
    }
    assert!(stable > 1000, "{stable}");
}

#[test]
fn more_trials_add_to_the_area() {
    let window = figure1();
    let mut before = search(&window, 0);
    assert!(before.certified.is_empty() && before.share() == (0.0, 0.0));
    for tries in [1000, 3000, 10_000, 20_000] {
        let bands = search(&window, tries);
        assert!(bands.tried <= tries && bands.share().0 >= before.share().1);
        before = bands;
    }
    // A goal ends the search as soon as it is reached.
    let goal = rational::ratio(1, 100);
    let bands = window.search(20_000, Some(&goal), &|_| ()).unwrap();
    assert!(bands.share().0 >= 0.01 && bands.tried < before.tried);
}

#[test]
fn sectors_are_proven_lie_in_the_window_and_do_not_overlap() {
    let (window, bands) = of_figure1();
    let (mut proven, mut area) = (0, 0.0);
    for sector in &bands.certified {
        for ratio in ends(sector) {
            for h1 in sector.sides_at(&ratio).map(|h1| rational::to_f64(&h1)) {
                let h2 = h1 * rational::to_f64(&ratio);
                assert!(h1 > 0.0 && h1 <= window.range(0).1.to_f64() && h2 > 0.0 && h2 <= 3.5, "{sector:?}");
            }
        }
        let (lo, hi) = sector.area().to_f64_enclosure();
        assert!(0.0 < lo && lo <= hi && hi <= lo * (1.0 + 1e-12), "{sector:?}");
        area += lo;
        proven += usize::from(window.proves(sector));
        // Neither beyond an edge nor in another tongue.
        let mut wrong = sector.clone();
        wrong.family[1] += 1;
        assert!(!window.proves(&wrong), "{sector:?}");
        if sector.family[0] == 0 {
            wrong.clone_from(sector);
            wrong.sides[1] = wrong.sides[1].map(|h1| h1 + h1 / 2);
            assert!(!window.proves(&wrong), "{sector:?}");
        }
    }
    // A part of a range may have the steps of Euclid's algorithm for its ends where the whole has none:
    // nearly all are proven again.
    assert!(100 * proven >= 98 * bands.certified.len(), "{proven} of {}", bands.certified.len());
    let (lo, hi) = bands.area();
    assert!(lo <= area * (1.0 + 1e-9) && area <= hi * (1.0 + 1e-9));
    // Sorted by curves and ratios.
    for pair in bands.certified.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        assert!(a.family != b.family || ends(a)[1] <= ends(b)[0], "{a:?}, {b:?}");
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
    assert!(refused(["-1", "1"], ["0", "1"]).starts_with("lambda1 = -1: "));
    assert!(refused(["1", "0"], ["0", "1"]).starts_with("lambda2 = 0: "));
    let ranges = [(x("1/4"), x("0.250000000001")), (x("1"), x("1.000000000001"))];
    let refused = Window::new([x("1"), x("1")], ranges).unwrap_err().to_string();
    assert!(refused.starts_with("h2-range = ") && refused.contains("widen"), "{refused}");
}
