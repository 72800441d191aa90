//! Tongues, closings, the survey and the atlas as a user sees them.

use kickdrift::number::Ratio;
use kickdrift::number::parse::parse_rational;
use kickdrift::number::rational::{from_f64_exact, ratio};
use kickdrift::tongue::Tongues;
use serde_json::Value;

use super::support::{Desk, json, keys, stdout, words};

const ALL: &str = "tongues --ratio 7/3 --rho 1/25";
const PLANE: &str =
    "tongues --max-sum 9 --lambda1 pi^2 --lambda2 pi^2/25 --h1-range 1/10..2/pi --h2-range 1/10..7/2";

fn rows(line: &str) -> Vec<Value> {
    json(&words(line, &[]))["tongues"].as_array().unwrap().clone()
}

fn labels(rows: &[Value]) -> Vec<u64> {
    rows.iter().map(|row| row["m"].as_u64().unwrap()).collect()
}

#[test]
fn a_row_has_the_keys_of_the_contract_and_the_known_edges() {
    let document = json(&words(ALL, &[]));
    assert_eq!(keys(&document)[..4], ["schema", "kickdrift", "input", "tongues"]);
    assert_eq!(document["schema"], "kickdrift/tongues/1");
    assert_eq!(document["input"].to_string(), r#"{"ratio":"7/3","rho":"1/25"}"#);
    let row = &document["tongues"][3];
    let contract = ["p", "q", "m", "a", "b", "lower", "upper", "closed", "width"];
    assert_eq!(keys(row)[..9], contract);
    assert_eq!(keys(row)[9..], ["growth", "predicted", "first_order"]);
    assert_eq!(keys(&row["lower"]), ["lo", "hi", "entry", "exact", "on"]);
    assert_eq!((row["m"].as_u64(), row["a"].as_i64(), row["b"].as_i64()), (Some(4), Some(1), Some(-1)));
    // Known to 17 digits from a full-period product, the last of them perhaps off by one.
    for (edge, s) in [("lower", 2.3645889194144734), ("upper", 2.40607004934166f64)] {
        let end = |side: &str| row[edge][side].as_f64().unwrap();
        assert!(end("lo").next_down() <= s && s <= end("hi").next_up(), "{edge}: {}", row[edge]);
    }
    assert_eq!(row["predicted"]["side"], "outside");
    assert!(row["predicted"]["distance"].as_f64() > Some(0.038));
}

#[test]
fn there_are_p_plus_q_minus_2_finite_tongues_and_one_without_end() {
    for (p, q) in [(7, 3), (1, 6), (9, 2), (4, 5)] {
        let rows = rows(&format!("tongues --ratio {p}/{q} --rho 3/4 --columns edges"));
        assert_eq!(labels(&rows), (1..p + q).collect::<Vec<u64>>());
        let endless: Vec<bool> = rows.iter().map(|row| row["upper"].is_null()).collect();
        assert!(endless.iter().rev().skip(1).all(|endless| !endless) && endless.last() == Some(&true));
        assert!(rows.iter().all(|row| row.get("growth").is_none() && row["lower"].get("exact").is_none()));
    }
}

#[test]
fn only_what_is_selected_comes_and_is_the_same_as_among_all() {
    let all = rows(ALL);
    let some = rows(&format!("{ALL} --m 2,4..6"));
    assert_eq!(labels(&some), [2, 4, 5, 6]);
    assert!(some.iter().all(|row| all.contains(row)));
    let family = rows(&format!("{ALL} --a 1..2 --b -3..0"));
    let expected =
        |row: &&Value| matches!((row["a"].as_i64(), row["b"].as_i64()), (Some(1..=2), Some(-3..=0)));
    assert_eq!(labels(&family), labels(&all.iter().filter(expected).cloned().collect::<Vec<_>>()));
    assert!(!family.is_empty() && family.len() < all.len());
}

/// A table was of one ratio or of all.
#[test]
fn several_ratios_are_one_table_that_verify_takes() {
    let desk = Desk::new();
    let run =
        |ratio: &str, rest: &[&str]| desk.run(&words(&format!("tongues --ratio {ratio} --rho 1/25"), rest));
    assert_eq!(run("5/2,3/2", &["--output", "d.json"]).code, Some(0));
    let document: Value = serde_json::from_slice(&desk.read("d.json")).unwrap();
    assert_eq!(document["input"].to_string(), r#"{"ratio":"5/2,3/2","rho":"1/25"}"#);
    let alone = ["5/2", "3/2"].map(|ratio| rows(&format!("tongues --ratio {ratio} --rho 1/25"))).concat();
    assert_eq!(document["tongues"].as_array().unwrap(), &alone);
    assert!(desk.run(&["verify", "d.json"]).stdout.starts_with("10 of 10 rows hold"));
    let mut left_out = document.clone();
    left_out["tongues"].as_array_mut().unwrap().pop();
    desk.write("d.json", &left_out.to_string());
    assert_eq!(desk.run(&["verify", "d.json"]).code, Some(2));
    let csv = run("5/2,3/2", &["--format", "csv"]).stdout;
    assert!(
        csv.lines().nth(1).unwrap().starts_with("5,2,1,")
            && csv.lines().last().unwrap().starts_with("3,2,4,")
    );
    assert!(run("5/2,3/2", &["--format", "latex"]).stdout.contains("$h_2/h_1 = 5/2,3/2$"));
    let twice = run("5/2,10/4", &[]);
    assert!(twice.code == Some(2) && twice.stderr.contains("name each ratio once"), "{}", twice.stderr);
}

/// The upper edge at the second ratio went to a table of its own.
#[test]
fn a_band_on_paper_has_both_sides_in_one_row_within_the_exact_ones() {
    let line = "bands --lambda1 pi^2 --lambda2 pi^2/25 --h1-range 1/5..1/4 --h2-range 9/10..1 --sectors 40";
    let [latex, csv] = ["latex", "csv"].map(|format| stdout(&words(line, &["--format", format])));
    let cells = |row: &str| -> Vec<f64> {
        let joined = row.trim_end_matches(" \\\\").replace("$ & $.", ".").replace('$', "");
        joined.split(" & ").skip(4).map(|cell| cell.trim().parse().unwrap()).collect()
    };
    let paper: Vec<Vec<f64>> = latex.lines().filter(|row| row.starts_with("    $0$")).map(cells).collect();
    let exact: Vec<Vec<f64>> = csv
        .lines()
        .skip(1)
        .map(|row| row.split(',').skip(4).map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert!(!paper.is_empty() && paper.len() == exact.len(), "{latex}");
    for (shown, whole) in paper.iter().zip(&exact) {
        // Rounded in the tenth decimal, to the inside.
        let inwards: Vec<f64> = [1.0, 1.0, -1.0, -1.0]
            .iter()
            .zip(shown.iter().zip(whole))
            .map(|(side, (a, b))| side * (a - b))
            .collect();
        assert!(
            shown.len() == 4 && inwards.iter().all(|off| (0.0..1e-10).contains(off)),
            "{shown:?} {whole:?}"
        );
    }
}

#[test]
fn a_window_of_steps_holds_the_tongues_that_meet_it() {
    let all = rows("tongues --max-sum 9 --lambda1 pi^2 --lambda2 pi^2/25");
    let some = rows(PLANE);
    let end = |row: &Value, edge: &str, side: &str| row[edge]["h1"][side].as_f64().unwrap_or(1e9);
    // Along the ray h2 = h1 p/q both ranges are ranges of h1.
    let meets = |row: &&Value| {
        let back = row["q"].as_f64().unwrap() / row["p"].as_f64().unwrap();
        let (lo, hi) = (f64::max(0.1, 0.1 * back), f64::min(std::f64::consts::FRAC_2_PI, 3.5 * back));
        lo <= hi && end(row, "lower", "lo") <= hi && lo <= end(row, "upper", "hi")
    };
    let expected: Vec<Value> = all.iter().filter(meets).cloned().collect();
    let names = |rows: &[Value]| {
        rows.iter()
            .map(|row| [&row["p"], &row["q"], &row["m"]].map(|n| n.as_u64().unwrap()))
            .collect::<Vec<_>>()
    };
    assert_eq!(names(&some), names(&expected));
    assert!(some == expected);
    assert!(expected.len() > 50 && expected.len() < all.len());
}

#[test]
fn steps_are_those_of_s() {
    for row in rows(&format!("{ALL} --lambda1 10 --digits 30")) {
        for edge in ["lower", "upper"].map(|edge| &row[edge]).into_iter().filter(|edge| !edge.is_null()) {
            let decimal = |key: &Value, side: &str| {
                parse_rational(side, key["decimal"][side].as_str().unwrap()).unwrap()
            };
            // h1² 10 = s and h2 = 7/3 h1, in thirty digits: exactly, but for their roundings outward.
            let [lo, hi] = ["lo", "hi"].map(|side| decimal(&edge["h1"], side));
            let s = ["lo", "hi"].map(|side| decimal(edge, side));
            assert!(&lo * &lo * ratio(10, 1) <= s[1] && s[0] <= &hi * &hi * ratio(10, 1), "{edge}");
            assert!(lo * ratio(7, 3) <= decimal(&edge["h2"], "hi"));
            let width = &s[1] - &s[0];
            assert!(width <= &s[0] / ratio(10, 1).pow(28), "{edge}");
            let [from, upto] = ["lo", "hi"].map(|side| from_f64_exact(edge[side].as_f64().unwrap()).unwrap());
            assert!(from <= s[1] && s[0] <= upto);
        }
    }
}

#[test]
fn edges_in_closed_form_say_so() {
    // q = 1: the upper edge of every tongue m < p is on the resonance; 3 | p makes s = 1 and 3 of some.
    let rows = rows("tongues --ratio 6/1 --rho 1/10 --columns exact");
    for (row, exact) in rows.iter().zip([None, Some("1"), Some("2"), Some("3"), None]) {
        assert_eq!(row["upper"]["on"], "p theta = m pi");
        assert_eq!(row["upper"]["exact"].as_str(), exact);
    }
    let closed = &self::rows("tongues --ratio 5/3 --rho 114/55 --m 4 --columns exact")[0];
    assert_eq!((&closed["closed"], &closed["lower"]["exact"]), (&true.into(), &"11/4".into()));
    assert_eq!(closed["width"].to_string(), r#"{"lo":0.0,"hi":0.0}"#);
}

#[test]
fn the_label_of_a_map_is_the_tongue_that_holds_the_pair() {
    let grid = "--lambda1 10 --lambda2 2/5 --step 1/20 --h1-range 1/20..3/5 --h2-range 1/20..7/2";
    let csv = stdout(&words("map --label --format csv", &words(grid, &[])));
    let mut seen = 0;
    for row in csv.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>()) {
        let [h1, _, p, q, kind, _, _, m, a, b] = row[..] else { panic!("{row:?}") };
        if kind != "hyperbolic" {
            continue;
        }
        seen += 1;
        let [p, q, m] = [p, q, m].map(|n| n.parse::<u64>().unwrap());
        let h1 = parse_rational("h1", h1).unwrap();
        let s = &h1 * &h1 * ratio(10, 1);
        let tongues = Tongues::new(Ratio::new(p, q).unwrap(), &ratio(1, 25)).unwrap();
        let gap = tongues.gap(m).unwrap();
        let exact = |x: f64| from_f64_exact(x).unwrap();
        assert!(exact(gap.lower.lo) < s && gap.upper.is_none_or(|upper| s < exact(upper.hi)), "{row:?}");
        let family = tongues.row(&gap, &kickdrift::tongue::Wanted::all()).unwrap().family.unwrap();
        assert_eq!([family.0.to_string(), family.1.to_string()], [a, b]);
    }
    assert!(seen > 50, "{seen}");
}

#[test]
fn tables_have_a_header_and_every_row() {
    let csv = stdout(&words(ALL, &["--format", "csv"]));
    assert!(
        csv.starts_with("p,q,m,a,b,lower_lo,lower_hi,lower_entry,lower_exact,lower_on,upper_lo,"),
        "{csv}"
    );
    let columns: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
    assert!(columns.len() == 10 && columns.iter().all(|&n| n == columns[0]), "{columns:?}");
    let text = stdout(&words(ALL, &["--format", "text"]));
    assert!(
        text.starts_with("9 tongues of h2/h1 = 7/3 at rho = 1/25: 9 open, 0 closed\n  thinnest     "),
        "{text}"
    );
    assert!(text.contains("  predicted    6 points p theta = m pi: 6 outside their own tongue"), "{text}");
    let latex = stdout(&words(PLANE, &["--format", "latex"]));
    assert!(latex.contains("\\label{tab:tongues-") && latex.matches("\\\\").count() > 50);
}

#[test]
fn the_threads_do_not_change_a_byte() {
    let desk = Desk::new();
    let survey = "tongues --survey --max-sum 20 --rho 1/25";
    let closings = "closings --max-sum 9 --samples 60";
    for (i, line) in [PLANE, survey, closings].into_iter().enumerate() {
        let made = |threads: &str| {
            let name = format!("{i}-{threads}");
            assert_eq!(desk.run(&words(line, &["--threads", threads, "--output", &name])).code, Some(0));
            desk.read(&name)
        };
        assert_eq!(made("1"), made("2"), "{line}");
    }
}

#[test]
fn known_closings_are_found_and_the_rational_ones_are_exact() {
    let document = json(&words("closings --max-sum 9", &[]));
    let closings = document["closings"].as_array().unwrap();
    let of = |p: u64, q: u64| {
        closings.iter().filter(|row| row["p"] == p && row["q"] == q).cloned().collect::<Vec<Value>>()
    };
    let [closing] = &of(5, 3)[..] else { panic!("{closings:?}") };
    assert_eq!(closing["m"], 4);
    assert_eq!((&closing["s"]["exact"], &closing["rho"]["exact"]), (&"11/4".into(), &"114/55".into()));
    assert_eq!(closing["below_verlet"], true);
    let [closing] = &of(5, 4)[..] else { panic!("{closings:?}") };
    assert_eq!((closing["m"].as_u64(), closing["rho"]["exact"].as_str()), (Some(7), None));
    let rho = closing["rho"]["lo"].as_f64().unwrap();
    // Seen near 0.785 on a grid of 3.5 %.
    assert!((rho / 0.785 - 1.0).abs() < 0.035, "{rho}");
    assert!(document["ratios"].as_array().unwrap().iter().all(|of| of["complete"] == true));
    let one = json(&words("closings --ratio 5/3 --m 4", &[]));
    assert_eq!(one["closings"][0], of(5, 3)[0]);
}

#[test]
fn a_survey_counts_every_tongue() {
    let survey = json(&words("tongues --survey --max-sum 24 --rho 1/25 --thinnest 3", &[]));
    let n = |key: &str| survey[key].as_u64().unwrap();
    assert_eq!((n("ratios"), n("tongues")), (179, n("open")));
    let predicted = |key: &str| survey["predicted"][key].as_u64().unwrap();
    assert_eq!(predicted("points"), predicted("outside") + predicted("on_edge") + predicted("inside"));
    let counted = survey["width_ratios"].as_array().unwrap().iter().map(|row| row["count"].as_u64().unwrap());
    assert_eq!(counted.sum::<u64>(), predicted("points"));
    assert_eq!(survey["thinnest"].as_array().unwrap().len(), 3);
}

#[test]
fn the_survey_for_papers_is_two_tables() {
    let latex =
        stdout(&words("tongues --survey --max-sum 9 --rho 1/25 --thinnest 2", &["--format", "latex"]));
    assert_eq!(latex, include_str!("survey.tex"));
}

#[test]
fn figures_are_drawn_and_hold_every_tongue() {
    let desk = Desk::new();
    for (name, more) in [
        ("family.svg", &[][..]),
        ("growth.svg", &["--colour", "growth"]),
        ("atlas.png", &["--a", "0..1", "--b", "-4..4"]),
        ("strength.svg", &["--figure", "strength"]),
    ] {
        let line = if name == "strength.svg" { "tongues --max-sum 30 --rho 1/1000" } else { PLANE };
        let ended = desk.run(&words(line, &[more, &["--quiet", "--output", name]].concat()));
        assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""), "{name}");
    }
    let text = |name: &str| String::from_utf8(desk.read(name)).unwrap();
    for name in ["family.svg", "growth.svg", "strength.svg"] {
        assert!(text(name).contains("<svg") && text(name).trim_end().ends_with("</svg>"), "{name}");
        assert!(!text(name).contains("NaN"), "{name}");
    }
    // The number of tongues is in the name of the figure.
    let count = rows(PLANE).len();
    assert!(text("family.svg").contains(&format!("Atlas of tongues; {count}")), "{count}");
    assert!(desk.read("atlas.png").starts_with(b"\x89PNG"));
}

#[test]
fn the_atlas_beside_the_readme_is_what_its_scene_writes() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut scene: Value =
        serde_json::from_slice(&std::fs::read(root.join("data/scenes/atlas.json")).unwrap()).unwrap();
    scene["want"] = serde_json::json!(["atlas.svg"]);
    let desk = Desk::new();
    desk.write("atlas.json", &scene.to_string());
    assert_eq!(desk.run(&["run", "atlas.json", "--output", "out"]).code, Some(0));
    let kept = std::fs::read(root.join("data/figures/atlas.svg")).unwrap();
    assert!(desk.read("out/atlas.svg") == kept, "data/figures/atlas.svg is not what its scene writes");
}

#[test]
fn traces_and_widths_are_drawn() {
    let desk = Desk::new();
    let draw = |line: &str| desk.run(&words(line, &["--quiet", "--text", "--output", "f.svg"]));
    let text = || String::from_utf8(desk.read("f.svg")).unwrap();
    let ended = draw("tongues --ratio 5/3 --rho 1/25 --m 4 --figure trace");
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    // Tongue 4 of 5/3 is between zeros of C and B, 0.0526 apart.
    for piece in [">entry C<", ">entry B<", "width 0.05264", ">Tongue 4: half a period<"] {
        assert!(text().contains(piece), "no {piece}");
    }
    let ended = draw("tongues --max-sum 12 --rho 1/1000 --figure widths");
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    assert!(text().contains(">first-order law for long periods<"));
    for (line, message) in [
        ("tongues --ratio 5/3 --rho 1/25 --m 3,4 --figure trace", "m = 3,4: give one label"),
        ("tongues --ratio 5/3 --rho 1/25 --m 99 --figure trace", "m = 99"),
        ("tongues --ratio 5/3 --rho 114/55 --m 4 --figure trace", "m = 4: is closed at this rho"),
        ("tongues --max-sum 9 --rho 1/25 --figure trace", "missing: ratio"),
        ("tongues --ratio 5/3 --rho 1/25 --figure widths", "max-sum"),
        ("tongues --max-sum 9 --rho 0 --figure widths", "rho = 0"),
        ("tongues --max-sum 2 --rho 1 --figure widths", "max-sum = 2"),
    ] {
        let ended = draw(line);
        assert!(
            ended.code == Some(2) && ended.stderr.contains(message.split(':').next().unwrap()),
            "{}",
            ended.stderr
        );
    }
}

#[test]
fn a_window_of_steps_ends_where_it_is_said_to_end() {
    let count = |h1: &str, h2: &str| {
        let line = format!("tongues --ratio 2/1 --rho 1 --lambda1 2/3 {h1} {h2}");
        rows(&line).len()
    };
    // The first tongue begins at h1 = 1, h2 = 2 exactly.
    assert_eq!(count("--h1-range 0..0.9999999999999999", ""), 0);
    assert_eq!(count("--h1-range 0..1", ""), 1);
    assert_eq!(count("", "--h2-range 0..1.99999999999999999999"), 0);
    assert_eq!(count("", "--h2-range 0..2"), 1);
}

/// 3/2, m = 1: s = 4 sin²(pi/6) = 1. And the law at rho = 1e-9, whose tongue is not known to the digits that
/// it misses.
#[test]
fn points_and_laws_are_the_nearest_doubles_and_what_they_miss_is_enclosed() {
    let line = "tongues --ratio 3/2 --rho 2/3 --columns predicted,first-order";
    let [first, second] = [0, 1].map(|k| rows(line)[k].clone());
    assert_eq!(first["predicted"]["s"], 1.0);
    assert_eq!(second["predicted"]["s"], 3.0);
    // By hand: s (1 - rho S0) and 2 s rho |S| with S0 = 7/8, |S| = 1/8.
    assert_eq!(first["first_order"]["centre"], 5.0 / 12.0);
    assert_eq!(first["first_order"]["width"], 1.0 / 6.0);
    let law = &rows("tongues --ratio 3/2 --rho 1e-9 --columns first-order")[0]["first_order"];
    let ends = |key: &str| ["lo", "hi"].map(|end| law[key][end].as_f64().unwrap());
    // To second order the tongue of 3/2 is off by some rho², far below what the edges' doubles tell.
    for key in ["centre_error", "width_error"] {
        let [lo, hi] = ends(key);
        assert!(lo < 0.0 && 0.0 < hi && hi - lo < 1e-14, "{key}: {law}");
    }
    let [lo, hi] = ends("width_ratio");
    assert!(lo <= 1.0 && 1.0 <= hi && hi - lo < 1e-5, "{law}");
}

#[test]
fn the_survey_in_csv_has_the_digits_of_json() {
    let line = "tongues --survey --max-sum 9 --rho 1/25";
    let document = json(&words(line, &[]));
    let table = stdout(&words(line, &["--format", "csv"]));
    let medians: Vec<f64> =
        table.lines().skip(1).map(|row| row.split(',').nth(4).unwrap().parse().unwrap()).collect();
    let told = document["width_ratios"].as_array().unwrap().iter().map(|row| row["median"].as_f64().unwrap());
    assert_eq!(medians, told.collect::<Vec<f64>>());
}
