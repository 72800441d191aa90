//! What the page is told is what the program and the library say.

use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use kickdrift::explore::{Reply, Session, ask};
use kickdrift::map::{Enclosure, Grid, Map, Products};
use kickdrift::number::parse::parse;
use kickdrift::number::rational::{enclose_f64, ratio, to_f64};
use kickdrift::number::{Laurent, Rational};
use kickdrift::propagator::Oscillator;
use kickdrift::tongue::Tongues;
use kickdrift::verdict::{Kind, Limits, Tier, Verdict, decide_with_growth};
use num_bigint::BigInt;
use serde_json::Value;

const STIFFNESS: [&str; 4] = ["--lambda1", "pi^2", "--lambda2", "pi^2/25"];

fn reply(path: &str, query: &str) -> Reply {
    ask(&Session::figure1(), path, query, &Arc::default()).expect("a question that there is")
}

fn told(path: &str, query: &str) -> Value {
    let reply = reply(path, query);
    assert_eq!(reply.status, 200, "{path}?{query}: {}", String::from_utf8_lossy(&reply.bytes));
    serde_json::from_slice(&reply.bytes).unwrap()
}

/// What the program says to the same words.
fn program(words: &[&str]) -> Vec<u8> {
    let output = Command::new(env!("CARGO_BIN_EXE_kickdrift")).args(words).output().unwrap();
    assert!(output.status.success(), "{words:?}: {}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

/// Every entry of the program's verdict is in what the page is told.
fn is_verdict_of_program(h1: &str, h2: &str) -> Value {
    let own = told("point", &format!("h1={h1}&h2={h2}"));
    let words = [&["verdict", "--h1", h1, "--h2", h2, "--format", "json"], &STIFFNESS[..]].concat();
    let text = program(&words);
    let theirs: Value = serde_json::from_slice(&text).unwrap();
    for (key, value) in theirs.as_object().unwrap() {
        assert_eq!(&own[key], value, "{key} of {h1}, {h2}");
    }
    // The line that the page offers to copy is that command.
    let line: Vec<&str> = own["command"].as_str().unwrap().split(' ').collect();
    let again = program(&[&line[1..], &["--format", "json"]].concat());
    assert!(again == text, "{line:?}");
    assert_eq!(reply("document", &format!("h1={h1}&h2={h2}")).bytes, text);
    own
}

#[test]
fn a_point_is_the_verdict_of_the_program() {
    let mut unstable = 0;
    for (h1, h2) in
        [("1/100", "49/50"), ("1/10", "3/10"), ("1/pi", "3/pi"), ("0.4", "1"), ("1/2", "7/6"), ("3/7", "9/5")]
    {
        let own = is_verdict_of_program(h1, h2);
        let tongue = &own["tongue"];
        assert_eq!(tongue.is_null(), own["kind"] == "elliptic", "{own}");
        if own["kind"] == "hyperbolic" {
            unstable += 1;
            assert_eq!((&tongue["m"], &tongue["a"]), (&own["resonance"]["m"], &own["resonance"]["a"]));
            let h1 = parse("h1", h1).unwrap().to_f64();
            assert!(tongue["lower"]["h1"]["lo"].as_f64().unwrap() <= h1);
            assert!(tongue["upper"].is_null() || h1 <= tongue["upper"]["h1"]["hi"].as_f64().unwrap());
            assert!(own["tenfold"]["steps"].as_f64().unwrap() > 0.0);
        }
    }
    assert!(unstable >= 2);
    // On the resonance 3 theta = pi: an edge of tongue 1.
    assert_eq!(told("point", "h1=1/pi&h2=3/pi")["tongue"]["m"], 1);
}

/// h1 within 2^-200 of the lower edge of a tongue of 7/2, on either side of it, as exact texts of 210 bits.
fn beside_an_edge() -> (Rational, Rational) {
    let tongues = Tongues::new("7/2".parse().unwrap(), &ratio(1, 25)).unwrap();
    let lower = tongues.refine(&tongues.gap(3).unwrap().lower, 80).unwrap();
    // At L1 = 1, ρ = 1/25: h1 = √s, by the integer root of s 4^210.
    let scale = BigInt::from(1) << 210u32;
    let root = |s: &Rational| ((s.numer() << 420u32) / s.denom()).sqrt();
    let (below, above) = (root(&lower.lo) - 1, root(&lower.hi) + 2);
    (Rational::new(below, scale.clone()), Rational::new(above, scale))
}

#[test]
fn two_hundred_levels_deep_points_and_tongues_are_exact() {
    let (below, above) = beside_an_edge();
    let stiffness = "lambda1=1&lambda2=1/25";
    let slope = ratio(7, 2);
    let kind = |h1: &Rational| told("point", &format!("{stiffness}&h1={h1}&h2={}", h1 * &slope));
    let (stable, unstable) = (kind(&below), kind(&above));
    assert_eq!((&stable["kind"], &unstable["kind"]), (&"elliptic".into(), &"hyperbolic".into()));
    assert_eq!((&stable["nearest"]["above"]["m"], &unstable["tongue"]["m"]), (&3.into(), &3.into()));
    let h2 = (&above * &slope).to_string();
    let words = [
        "verdict",
        "--lambda1",
        "1",
        "--lambda2",
        "1/25",
        "--h1",
        &above.to_string(),
        "--h2",
        &h2,
        "--format",
        "json",
    ];
    let theirs: Value = serde_json::from_slice(&program(&words)).unwrap();
    assert!(theirs.as_object().unwrap().iter().all(|(key, value)| &unstable[key] == value));
    // A window of 2^-190 about the edge: the tongue enters it in the middle, to the last digit that a double
    // has.
    let half = Rational::new(1.into(), BigInt::from(1) << 191u32);
    let range = |x: &Rational| format!("{}..{}", x - &half, x + &half);
    let window = format!("h1={}&h2={}", range(&above), range(&(&above * &slope)));
    let told = told("tongues", &format!("{stiffness}&{window}"));
    let [segment] = told["segments"].as_array().unwrap().as_slice() else { panic!("{told}") };
    assert_eq!(
        (&segment["ratio"], &segment["m"], &segment["ends"][0]),
        (&"7/2".into(), &3.into(), &true.into())
    );
    let line: Vec<f64> = segment["line"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    // The points lie within 2^-208 of the edge, 2^-18 of the window.
    assert!((line[0] - 0.5).abs() < 1e-5 && (line[1] - 0.5).abs() < 1e-4 && line[3] == 1.5, "{line:?}");
    // A pixel beside the ray is moved onto it, no farther than it says.
    let off = &h2.parse::<Rational>().unwrap() + &half;
    let moved = told_at(&format!("{stiffness}&h1={above}&h2={off}&within={}", &half * ratio(2, 1)));
    assert_eq!((&moved["input"]["h2"], &moved["p"]), (&h2.into(), &7.into()));
    // Without that the period is too long for any computer, and the answer says so.
    assert_eq!(reply("point", &format!("{stiffness}&h1={above}&h2={off}")).status, 422);
}

fn told_at(query: &str) -> Value {
    told("point", query)
}

/// The values of a tile after its header.
fn tile(query: &str, width: usize) -> (f32, Vec<Vec<u8>>) {
    let reply = reply("tile", query);
    assert_eq!((reply.status, &reply.bytes[..4]), (200, &b"KDT1"[..]), "{query}");
    let word = |at: usize| reply.bytes[at..at + 4].try_into().unwrap();
    let size = u32::from_le_bytes(word(4)) as usize;
    let values: Vec<Vec<u8>> = reply.bytes[16..].chunks(width).map(<[u8]>::to_vec).collect();
    assert_eq!(values.len(), size * size);
    (f32::from_le_bytes(word(12)), values)
}

#[test]
fn a_tile_is_the_map_of_its_pairs() {
    let x = |text: &str| parse("x", text).unwrap();
    // Spacings 1/512 and 1/128: tile (1, 1) of level 3 and size 64.
    let query = "unit=1&unit2=4&level=3&x=1&y=1&size=64";
    let times = |n: i64, d: i64| Laurent::from_rational(ratio(n, d));
    let ranges = ((times(65, 512), times(128, 512)), (times(65, 128), times(128, 128)));
    let grid = Grid::new(x("pi^2"), x("pi^2/25"), [x("1/512"), x("1/128")], ranges.0, ranges.1).unwrap();
    assert_eq!(grid.shape(), (64, 64));
    let verdicts = Map::of(&grid).verdicts().unwrap();
    let mine = tile(&format!("{query}&what=verdict"), 1).1;
    let (largest, rates) = tile(&format!("{query}&what=growth"), 4);
    let families = tile(&format!("{query}&what=family"), 4).1;
    let (mut expected_rates, mut expected_families) = (vec![0f32; 64 * 64], vec![(i16::MIN, 0i16); 64 * 64]);
    let products = Products { label: true, growth: true };
    Map::of(&grid)
        .with(products)
        .for_each_band(|_, band| {
            for growing in &band.growing {
                let (i, j) = band.multipliers(&grid, growing.position as usize);
                let place = (j - 65) as usize * 64 + (i - 65) as usize;
                let period = grid.ratio(i, j).p() as f64 * (i as f64 / 512.0);
                expected_rates[place] = growing.rate(period).map_or(0.0, Enclosure::middle) as f32;
                let (a, b) = growing.family(grid.ratio(i, j)).unwrap();
                expected_families[place] = (a as i16, b as i16);
            }
            Ok(())
        })
        .unwrap();
    let code = |verdict: Verdict| {
        let kind = [Kind::Elliptic, Kind::Hyperbolic, Kind::Parabolic, Kind::Coexistence];
        let kind = kind.iter().position(|kind| *kind == verdict.kind()).unwrap() as u8;
        if verdict.side() < 0 { kind + 4 } else { kind }
    };
    let mut unstable = 0;
    for (n, verdict) in verdicts.iter().enumerate() {
        let place = n % 64 * 64 + n / 64;
        assert_eq!(mine[place], [code(*verdict)], "{place}");
        assert_eq!(rates[place], expected_rates[place].to_le_bytes(), "{place}");
        let (a, b) = expected_families[place];
        assert_eq!(families[place], [a.to_le_bytes(), b.to_le_bytes()].concat(), "{place}");
        unstable += usize::from(verdict.kind() == Kind::Hyperbolic);
    }
    assert!(unstable > 50, "{unstable}");
    assert_eq!(largest, expected_rates.iter().copied().fold(0.0, f32::max));
}

/// 2^26 and more multiples away from 0: fewer cells, each with the verdict and the rate of its own pair.
#[test]
fn deep_tiles_have_the_verdicts_of_their_pairs() {
    for level in [20, 40, 70] {
        let (at, side) = (BigInt::from(2) << level, 16);
        // Beside the ratio 2, whose cells cost 256 bits where they are deepest, and there beside √5.
        let above = if level < 70 { &at * 2 } else { BigInt::sqrt(&(&at * &at * 5)) };
        let query = format!("unit=1/4&level={level}&x={at}&y={above}&size=32");
        let kinds = tile(&format!("{query}&what=verdict"), 1).1;
        let rates = tile(&format!("{query}&what=growth"), 4).1;
        assert_eq!(kinds.len(), side * side);
        let step = Rational::new(1.into(), BigInt::from(4 * side) << level);
        let times =
            |at: &BigInt, n: usize| Laurent::from_rational(Rational::from_integer(at * side + n + 1) * &step);
        for (n, (kind, rate)) in kinds.iter().zip(&rates).enumerate().step_by(7) {
            let (h1, h2) = (times(&at, n % side), times(&above, n / side));
            let x = |text: &str| parse("x", text).unwrap();
            let oscillator = Oscillator::new(x("pi^2"), x("pi^2/25"), h1, h2).unwrap();
            let (decision, growth) =
                decide_with_growth(&oscillator, Tier::Filter, &Limits::default()).unwrap();
            assert_eq!(kind[0] & 3 == 0, decision.verdict.is_stable(), "level {level}, cell {n}");
            let rate = f32::from_le_bytes(rate[..].try_into().unwrap());
            assert_eq!(rate, growth.rate(&oscillator) as f32, "level {level}, cell {n}");
        }
    }
}

#[test]
fn tiles_that_cost_too_much_are_refused_with_their_cost() {
    let cost = |query: &str| {
        let reply = reply("tile", query);
        assert_eq!(reply.status, 422);
        let body: Value = serde_json::from_slice(&reply.bytes).unwrap();
        assert!(body["too_costly"]["limit"].as_f64().unwrap() < body["too_costly"]["cost"].as_f64().unwrap());
        body["too_costly"]["cost"].as_f64().unwrap()
    };
    // The law for random pairs: a level doubles the cost.
    let deep = |level: u32| {
        let at = BigInt::from(2) << level;
        cost(&format!("unit=1/4&level={level}&x={at}&y={at}"))
    };
    assert!((deep(200) / deep(199) - 2.0).abs() < 1e-6);
    assert!(deep(200) > 1e60);
}

#[test]
fn tongues_lie_on_unstable_pixels_and_on_no_others() {
    // All pairs of a grid whose ratio has p + q ≤ 24: unstable exactly where a segment of their ratio says
    // so.
    let told = told("tongues", "h1=0..3/5&h2=0..3&max_sum=24");
    assert_eq!((&told["max_sum"], &told["complete"]), (&24.into(), &true.into()));
    let segments = told["segments"].as_array().unwrap();
    let x = |text: &str| parse("x", text).unwrap();
    let grid = Grid::new(
        x("pi^2"),
        x("pi^2/25"),
        [x("1/60"), x("1/60")],
        (x("1/60"), x("3/5")),
        (x("1/60"), x("3")),
    )
    .unwrap();
    let verdicts = Map::of(&grid).verdicts().unwrap();
    let rows = grid.shape().1 as u64;
    let (mut seen, mut unstable) = (0, 0);
    for (n, verdict) in (0..).zip(&verdicts) {
        let (i, j) = (1 + n / rows, 1 + n % rows);
        let own = grid.ratio(i, j);
        if own.kicks() > 24 || !matches!(verdict.kind(), Kind::Elliptic | Kind::Hyperbolic) {
            continue;
        }
        let (lo, hi) = enclose_f64(&ratio(i as i64, 60));
        let inside = |segment: &&Value| {
            let to = segment["to"][0].as_f64().unwrap_or(f64::INFINITY);
            segment["ratio"] == own.to_string() && segment["from"][0].as_f64().unwrap() < lo && hi < to
        };
        let found = segments.iter().find(inside);
        assert_eq!(found.is_some(), verdict.kind() == Kind::Hyperbolic, "({i}, {j})/60");
        seen += 1;
        unstable += usize::from(found.is_some());
    }
    assert!(seen > 1000 && unstable > 50, "{unstable} of {seen}");
    // Fractions of the window are where the steps are.
    let checked = segments.iter().filter(|segment| segment["ends"][0] == true).map(|segment| {
        let (from, line) = (&segment["from"], &segment["line"]);
        let [u, v] = [0, 1].map(|n| line[n].as_f64().unwrap());
        let [h1, h2] = [0, 1].map(|n| from[n].as_f64().unwrap());
        assert!((u - h1 / 0.6).abs() < 1e-12 && (v - h2 / 3.0).abs() < 1e-12, "{segment}");
    });
    assert!(checked.count() > 100);
}

#[test]
fn stiffnesses_and_windows_beyond_doubles_are_refused() {
    let x = |text| kickdrift::number::parse::parse("x", text).unwrap();
    for (lambda1, lambda2) in [("1e-700", "1"), ("1e700", "1"), ("1", "1e700"), ("1", "-1e700")] {
        let error = Session::new(x(lambda1), x(lambda2)).unwrap_err();
        assert!(error.to_string().contains("another unit of time"), "{error}");
        for path in ["start", "point", "tile", "curves", "tongues", "picture", "scene", "cut", "strip"] {
            let query = format!("lambda1={lambda1}&lambda2={lambda2}&h1=1/2..3/5&h2=1/2..3/5");
            let reply = reply(path, &query);
            assert!(reply.status >= 400 && reply.status < 500, "{path}?{query}: {}", reply.status);
        }
    }
    for path in ["tile", "curves", "tongues", "picture", "scene"] {
        assert_eq!(reply(path, "h1=1/2..pi*1e400&h2=1/2..3/5").status, 400, "{path}");
    }
    // A scene of one column has no width to show.
    let narrow = Session::figure1().within([(x("1"), x("1")), (x("1"), x("2"))]);
    assert_eq!(ask(&narrow, "start", "", &Arc::default()).unwrap().status, 200);
}

#[test]
fn curves_deep_down_continue_those_above() {
    // The same curve in a window and in one 2^-40 as wide about one of its points.
    let shallow = told("curves", "a=0..0&b=1..1&h1=1/4..1/2&h2=1/2..3/2");
    let line = &shallow["curves"][0]["lines"][0];
    let [u, v] = [40, 41].map(|n| line[n].as_f64().unwrap());
    let (h1, h2) = (0.25 + u / 4.0, 0.5 + v);
    let around = |x: f64| {
        let (x, half) = (
            Laurent::try_from(x).unwrap(),
            Laurent::from_rational(Rational::new(1.into(), BigInt::from(1) << 41u32)),
        );
        format!("{}..{}", x.clone() - half.clone(), x + half)
    };
    let deep = told("curves", &format!("a=0..0&b=1..1&h1={}&h2={}", around(h1), around(h2)));
    let line = deep["curves"][0]["lines"][0].as_array().unwrap();
    let middle = line.chunks(2).find(|point| point[0] == 0.5).unwrap()[1].as_f64().unwrap();
    // Doubles place the point within some 1e-16, 2e-4 of the window.
    assert!((middle - 0.5).abs() < 2e-3, "{middle}");
}

#[test]
fn cuts_and_strips_agree_with_points_and_tongues() {
    let cut = told("cut", "kind=ratio&value=7/2&lo=0&hi=2/3&samples=60");
    let xs = cut["x"].as_array().unwrap();
    assert_eq!((xs.len(), cut["axis"].as_str()), (60, Some("h1")));
    let mut unstable = 0;
    for (k, x) in (0..).zip(xs) {
        let h1 = ratio(2 * k + 1, 180);
        assert_eq!(x.as_f64().unwrap(), to_f64(&h1));
        let point = told("point", &format!("h1={h1}&h2={}", &h1 * ratio(7, 2)));
        let grows = point["kind"] == "hyperbolic";
        assert_eq!(cut["kind"][k as usize].as_u64().unwrap() % 4 == 1, grows);
        let rate = cut["rate"][k as usize].as_f64().unwrap();
        let enclosed = &point["growth_rate"];
        assert!(enclosed["lo"].as_f64().unwrap() <= rate && rate <= enclosed["hi"].as_f64().unwrap());
        unstable += usize::from(grows);
    }
    assert!(unstable > 5);
    let strip = told("strip", "ratio=5/3&rho=1/25..3&samples=3");
    let tongues = Tongues::new("5/3".parse().unwrap(), &ratio(1, 25)).unwrap().all().unwrap();
    for (own, gap) in strip["tongues"].as_array().unwrap().iter().zip(&tongues) {
        let lower = own["lower"][0].as_f64().unwrap();
        assert!(own["m"] == gap.m && gap.lower.lo <= lower && lower <= gap.lower.hi);
    }
    assert_eq!(strip["tongues"].as_array().unwrap().len(), tongues.len());
    // A resonance that does not destabilize: 5/3, m = 4 at s = 11/4, rho = 114/55.
    let closing = &strip["closings"][0];
    assert_eq!(
        (&closing["m"], closing["s"].as_f64(), closing["rho"].as_f64()),
        (&4.into(), Some(2.75), Some(114.0 / 55.0))
    );
}

#[test]
fn what_is_shown_can_be_kept() {
    let window = "h1=1/50..3/5&h2=1/50..3&step=1/50&step2=1/25";
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("own.svg");
    let flags = [
        "--step1",
        "1/50",
        "--step2",
        "1/25",
        "--h1-range",
        "1/50..3/5",
        "--h2-range",
        "1/50..3",
        "--colour",
        "growth",
    ];
    program(&[&["map", "--curves", "--output", picture.to_str().unwrap()], &flags[..], &STIFFNESS].concat());
    let own = reply("picture", &format!("{window}&what=growth&curves=1&format=svg"));
    assert_eq!((own.file, &*own.bytes), (Some("map.svg"), &*std::fs::read(picture).unwrap()));
    let scene = folder.path().join("scene.json");
    std::fs::write(&scene, &reply("scene", window).bytes).unwrap();
    let out = folder.path().join("out");
    program(&["run", scene.to_str().unwrap(), "--output", out.to_str().unwrap()]);
    let map: Value = serde_json::from_slice(&std::fs::read(out.join("map.json")).unwrap()).unwrap();
    assert_eq!(map["pairs"], 30 * 75);
    let certificate = reply("certificate", "lambda1=11/4&lambda2=57/10&h1=1&h2=5/3");
    assert!(String::from_utf8_lossy(&certificate.bytes).contains("verdict (Coexistence Plus) 5 3"));
}

#[test]
fn a_system_grows_where_its_own_verdict_says() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/fpu.json");
    let scene = kickdrift::scene::SystemScene::read(&std::fs::read_to_string(file).unwrap()).unwrap();
    let stop = Arc::default();
    let session = Session::of_system(scene);
    let reply = ask(&session, "system", "outer=3/100..9/100&samples=3", &stop).unwrap();
    let told: Value = serde_json::from_slice(&reply.bytes).unwrap();
    // The middle sample is the file's own step.
    assert_eq!((told["own"].as_f64(), told["outer"][1].as_f64()), (Some(0.06), Some(0.06)));
    let own = &told["verdict"]["growth_rate"];
    let (sampled, lo, hi) = (&told["rate"][1], &own["lo"], &own["hi"]);
    let [sampled, lo, hi] = [sampled, lo, hi].map(|x| x.as_f64().unwrap());
    // The sample is the double nearest to the step.
    assert!(lo * (1.0 - 1e-9) <= sampled && sampled <= hi * (1.0 + 1e-9), "{sampled} {lo} {hi}");
    let proven = ask(&session, "stretches", "outer=3/100..9/100", &stop).unwrap();
    let proven: Value = serde_json::from_slice(&proven.bytes).unwrap();
    let stretches = proven["stretches"].as_array().unwrap();
    let holds = stretches
        .iter()
        .find(|of| of["lo"].as_f64() <= Some(0.06) && Some(0.06) <= of["hi"].as_f64())
        .unwrap();
    // A stretch may not tell; it does not contradict.
    let opposite = if told["verdict"]["stable"] == true { "unstable" } else { "stable" };
    assert_ne!(holds["verdict"], opposite, "{holds}");
    // The same step, chosen: the same verdict.
    let chosen = ask(&session, "modes", "at=3/50", &stop).unwrap();
    let chosen: Value = serde_json::from_slice(&chosen.bytes).unwrap();
    assert_eq!(chosen["at"], 0.06);
    for key in ["stable", "kind", "growth_rate", "parts"] {
        assert_eq!(chosen["verdict"][key], told["verdict"][key], "{key}");
    }
    assert_eq!(ask(&session, "modes", "at=0", &stop).unwrap().status, 400);
    let start: Value = serde_json::from_slice(&ask(&session, "start", "", &stop).unwrap().bytes).unwrap();
    assert!(start["lambda1"].is_null() && start["system"].is_object());
}

#[test]
fn a_large_system_shows_the_growth_that_its_cost_allows() {
    let scenes = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes"));
    for name in ["flexible-water.json", "bar-resonant.json"] {
        let text = std::fs::read_to_string(scenes.join(name)).unwrap();
        let scene = kickdrift::scene::SystemScene::read_in(scenes, &text).unwrap();
        let reply = ask(&Session::of_system(scene), "system", "samples=201", &Arc::default()).unwrap();
        let told: Value = serde_json::from_slice(&reply.bytes).unwrap();
        let (steps, rates) = (told["outer"].as_array().unwrap(), told["rate"].as_array().unwrap());
        assert!(steps.len() >= 20 && steps.len() == rates.len(), "{name}: {told}");
        assert!(rates.iter().any(|rate| rate.as_f64() > Some(0.0)), "{name}: {rates:?}");
    }
}

#[test]
fn stopped_work_is_not_begun() {
    let stopped = Arc::new(AtomicBool::new(true));
    for (path, query) in [
        ("tile", "unit=1/4&level=0&x=0&y=0"),
        ("picture", "step=1/50"),
        ("cut", "kind=h1&value=1/50&lo=0&hi=1"),
        ("strip", "ratio=5/3&rho=1/10..1"),
    ] {
        let reply = ask(&Session::figure1(), path, query, &stopped).unwrap();
        let body: Value = serde_json::from_slice(&reply.bytes).unwrap();
        assert_eq!(
            (reply.status, body["error"]["remedy"].as_str()),
            (400, Some("stopped before its end")),
            "{path}"
        );
    }
}
