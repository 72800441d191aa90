//! The contract: keys, formats, exit codes.

#[cfg(unix)]
use super::support::at_a_terminal;
use super::support::{Desk, json, keys, run, stdout, words};

/// h2 just below T½: resonant. And a plainly stable neighbour.
const UNSTABLE: &str = "verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 1/100 --h2 0.98";
const STABLE: &str = "verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 1/100 --h2 1/2";
/// A closed tongue, Q = I, and an exactly rational edge.
const CLOSED: &str = "verdict --lambda1 11/4 --lambda2 57/10 --h1 1 --h2 5/3";
const EDGE: &str = "verdict --lambda1 1 --lambda2 0.1 --h1 1 --h2 3";

const GRID: &str = "--lambda1 10 --lambda2 2/5 --step 1/10 --h1-range 1/10..3/5 --h2-range 0.1..3";

#[test]
fn a_verdict_has_the_keys_of_the_contract_in_their_order() {
    let verdict = json(&words(UNSTABLE, &[]));
    let contract = [
        "schema",
        "kickdrift",
        "input",
        "p",
        "q",
        "kind",
        "stable",
        "side",
        "trace",
        "growth_rate",
        "resonance",
        "bias",
        "decided_by",
    ];
    assert_eq!(keys(&verdict), contract);
    assert_eq!(verdict["schema"], "kickdrift/verdict/1");
    assert_eq!(
        verdict["kickdrift"],
        serde_json::json!({"version": env!("CARGO_PKG_VERSION"), "command": "verdict"})
    );
    assert_eq!(keys(&verdict["resonance"]), ["m", "a", "b"]);
    assert_eq!((verdict["p"].as_u64(), verdict["q"].as_u64()), (Some(98), Some(1)));
    assert_eq!(verdict["resonance"].to_string(), r#"{"m":1,"a":0,"b":1}"#);
    let rate = &verdict["growth_rate"];
    assert!(rate["lo"].as_f64() > Some(0.0) && rate["lo"].as_f64() <= rate["hi"].as_f64());
}

#[test]
fn every_kind_of_verdict_comes_out_with_its_side() {
    let seen = |line: &str| {
        let verdict = json(&words(line, &[]));
        let kind = verdict["kind"].as_str().unwrap().to_string();
        (kind, verdict["stable"].as_bool().unwrap(), verdict["side"].as_i64().unwrap())
    };
    assert_eq!(seen(UNSTABLE), ("hyperbolic".into(), false, -1));
    assert_eq!(seen(STABLE), ("elliptic".into(), true, 0));
    assert_eq!(seen(CLOSED), ("coexistence".into(), true, 1));
    assert_eq!(seen(EDGE), ("parabolic".into(), false, -1));
}

#[test]
fn inputs_are_echoed_as_exact_strings_however_they_were_typed() {
    let line = "verdict --lambda1 1e1 --lambda2 0.4 --h1 .5 --h2 (1+1/2)/2*3";
    let input = json(&words(line, &[]))["input"].to_string();
    assert_eq!(input, r#"{"lambda1":"10","lambda2":"2/5","h1":"1/2","h2":"9/4"}"#);
    let curves =
        json(&words("curves --h1-range 0.1..0.5 --h2-range 0.5..2 --a 0..0 --b 1..1 --samples 9", &[]));
    let input = &curves["input"];
    assert_eq!((&input["h1_range"], &input["h2_range"]), (&"1/10..1/2".into(), &"1/2..2".into()));
    assert_eq!((&input["a"], &input["samples"]), (&"0..0".into(), &"9".into()));
    let map = json(&words("map", &words(GRID, &[])));
    assert_eq!(map["input"]["h1_range"], "1/10..3/5");
    assert_eq!(map["input"]["h2_range"], "1/10..3");
}

#[test]
fn the_exit_code_tells_stable_from_unstable_only_when_asked() {
    for (line, code) in [(STABLE, 0), (CLOSED, 0), (UNSTABLE, 1), (EDGE, 1)] {
        assert_eq!(run(&words(line, &[])).code, Some(0), "{line}");
        assert_eq!(run(&words(line, &["--exit-code"])).code, Some(code), "{line}");
    }
    let nonsense = run(&words("verdict --lambda1 x --lambda2 1 --h1 1 --h2 1 --exit-code", &[]));
    assert_eq!(nonsense.code, Some(2));
}

/// One update decides; trace and label, which nobody sees, would take half a million kicks more.
#[test]
fn a_quiet_exit_code_is_the_verdict_alone() {
    for (line, code) in [(STABLE, 0), (CLOSED, 0), (UNSTABLE, 1), (EDGE, 1)] {
        let quiet = run(&words(line, &["--exit-code", "--quiet"]));
        assert_eq!(
            (quiet.code, quiet.stdout.as_str(), quiet.stderr.as_str()),
            (Some(code), "", ""),
            "{line}"
        );
    }
    let long = "verdict --lambda1 1/7 --lambda2 1/175000000 --h1 1 --h2 100003/101 --budget 1000 --exit-code";
    let quiet = run(&words(long, &["--quiet"]));
    assert!(matches!(quiet.code, Some(0 | 1)), "{}", quiet.stderr);
    let asked = run(&words(long, &[]));
    assert_eq!(asked.code, Some(2));
    assert!(asked.stderr.contains("50052"), "{}", asked.stderr);
}

/// Rational systems by their ladder, measured ones without an eigenbasis where the chord tells.
#[test]
fn the_exit_code_of_a_system_is_its_proven_verdict() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("system.json");
    let line = ["system", file.to_str().unwrap(), "--exit-code"];
    let answers = |system: &str, code: i32| {
        std::fs::write(&file, system).unwrap();
        let loud = run(&line);
        assert_eq!(loud.code, Some(code), "{system}: {}", loud.stderr);
        assert!(loud.stdout.starts_with(["stable", "unstable"][usize::from(code == 1)]), "{}", loud.stdout);
        let quiet = run(&words("--quiet", &line));
        assert_eq!((quiet.code, quiet.stdout.as_str(), quiet.stderr.as_str()), (Some(code), "", ""));
    };
    for (step, code) in [("1", 0), ("25/8", 1)] {
        answers(
            &format!(
                r#"{{"schema": "kickdrift/system/1", "masses": ["1"], "potentials": [
                {{"name": "fast", "step": "1/8", "stiffness": [["1"]]}}, {{"name": "slow", "step": "{step}", "stiffness": [["1/25"]]}}]}}"#
            ),
            code,
        );
    }
    let scene = std::fs::read_to_string("data/scenes/flexible-water.json").unwrap();
    let arrays = std::fs::canonicalize("data/hessians").unwrap();
    let here = scene.replace("../hessians", arrays.to_str().unwrap());
    answers(&here, 0);
    answers(&here.replace("1/250", "9/2000"), 1);
}

#[test]
fn people_get_text_from_verdict_and_scripts_get_json_from_tables() {
    assert!(stdout(&words(UNSTABLE, &[])).starts_with("unstable: hyperbolic, Tr Q < -2"));
    assert!(stdout(&words(CLOSED, &[])).contains("stable: coexistence, Q = I"));
    assert!(stdout(&words("map", &words(GRID, &[]))).starts_with("{\n  \"schema\": \"kickdrift/map/1\""));
    assert!(stdout(&words("curves --samples 5", &[])).starts_with("{\n  \"schema\": \"kickdrift/curves/1\""));
}

#[cfg(unix)]
#[test]
fn a_table_is_text_at_a_terminal() {
    let map = at_a_terminal(&format!("map {GRID}"), None, &[]);
    assert!(map.contains(" pairs, each decided: ") && !map.contains("schema"), "{map}");
    let tongues = at_a_terminal("tongues --ratio 7/3 --rho 1/25", None, &[]);
    assert!(tongues.starts_with("9 tongues of h2/h1 = 7/3"), "{tongues}");
}

#[test]
fn csv_is_a_header_and_one_line_a_row() {
    let csv = stdout(&words(UNSTABLE, &["--format", "csv"]));
    let lines: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines.len(), 2);
    assert_eq!(lines[0].len(), lines[1].len());
    assert_eq!(lines[0][..5], ["h1", "h2", "p", "q", "kind"]);
    assert_eq!(lines[1][..5], ["1/100", "49/50", "98", "1", "hyperbolic"]);
    let map = stdout(&words("map --format csv", &words(GRID, &[])));
    assert_eq!(map.lines().next(), Some("h1,h2,p,q,kind,side,decided_by"));
}

#[test]
fn a_small_window_shows_every_curve_through_it_and_verify_agrees() {
    let count = |flags: &str| {
        let desk = Desk::new();
        let ended = desk.run(&words("curves --output c.json --quiet --samples 20", &words(flags, &[])));
        assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
        let curves: serde_json::Value = serde_json::from_slice(&desk.read("c.json")).unwrap();
        let checked = desk.run(&["verify", "c.json"]);
        assert_eq!(checked.code, Some(0), "{flags}: {}", checked.stderr);
        curves["curves"].as_array().unwrap().len()
    };
    // One of them leaves through h2 = 7/2 between 0.3 and 0.301.
    assert_eq!(count("--h1-range 0.3..0.301"), 35);
    assert_eq!(count("--h1-range 0.301..0.302"), 34);
    assert_eq!(count("--h1-range 0.301..0.301000001"), 34);
    assert_eq!((count("--h2-range 1..1.001"), count("--h2-range 1..1.1")), (32, 32));
}

#[test]
fn latex_is_a_booktabs_table() {
    for line in [
        UNSTABLE,
        "curves --a 0..0 --b 1..1 --samples 4",
        "compare --max-sum 4 --rho 1/25",
        "proposition --max 3",
    ] {
        let table = stdout(&words(line, &["--format", "latex"]));
        for part in
            ["\\begin{table", "\\begin{tabular}", "\\toprule", "\\midrule", "\\bottomrule", "\\end{table"]
        {
            assert!(table.contains(part), "{line}: no {part} in {table}");
        }
    }
    let equations = stdout(&words("polynomial --ratio 3/2", &["--format", "latex"]));
    let trace = "\\operatorname{Tr} Q &= 2 - 9 s - 9 \\rho s + 6 s^{2}";
    assert!(equations.contains("\\begin{align}") && equations.contains(trace), "{equations}");
}

#[test]
fn the_exact_tier_shows_the_exact_trace() {
    let verdict = json(&words("verdict --lambda1 10 --lambda2 2/5 --h1 0.631 --h2 3.499 --exact", &[]));
    assert_eq!(verdict["decided_by"], "exact");
    let trace = verdict["trace"]["exact"].as_str().unwrap();
    // An integer over a power of 10, far beyond doubles in both parts.
    let (above, below) = trace.split_once('/').unwrap();
    assert!(above.len() > 1000 && below.len() > 1000);
    let plain = json(&words("verdict --lambda1 10 --lambda2 2/5 --h1 0.631 --h2 3.499", &[]));
    assert!(plain["trace"].get("exact").is_none());
    assert_eq!((&plain["kind"], &plain["resonance"]), (&verdict["kind"], &verdict["resonance"]));
}

#[test]
fn stiffnesses_far_beyond_doubles_are_answered_too() {
    for (lambda2, kind, side) in
        [("1e100", "hyperbolic", -1), ("-1e400", "hyperbolic", 1), ("1e-400", "elliptic", 0)]
    {
        let line = ["verdict", "--lambda1", "1", "--lambda2", lambda2, "--h1", "1", "--h2", "1"];
        let verdict = json(&line);
        assert_eq!(
            (verdict["kind"].as_str(), verdict["side"].as_i64()),
            (Some(kind), Some(side)),
            "{lambda2}"
        );
        assert!(verdict["growth_rate"]["hi"].is_f64(), "{lambda2}");
        assert_eq!(verdict["resonance"].is_object(), kind == "hyperbolic", "{lambda2}");
    }
    // Over Q[pi] too, with a hundred kicks a period.
    let verdict = json(&words("verdict --lambda1 pi^2 --lambda2 1e100 --h1 0.5 --h2 9.8", &[]));
    assert_eq!(verdict["resonance"].to_string(), r#"{"m":60,"a":0,"b":12}"#);
}

/// No machine follows 10^12 kicks one by one within a test: s = 1 turns by π/3, so that they come to a turn
/// by a multiple of π/3.
#[test]
fn a_slow_step_of_ever_so_many_fast_ones_is_leapt_over() {
    let desk = Desk::new();
    for (step, same) in
        [("1000000000001", "1000001"), ("1000000000002", "1000002"), ("1000000000000", "1000000")]
    {
        let kind = |step: &str| {
            let ended =
                desk.run(&["verdict", "--lambda1", "1", "--lambda2", "1/10", "--h1", "1", "--h2", step]);
            assert_eq!(ended.code, Some(0), "{}", ended.stderr);
            ended.stdout.lines().next().unwrap().to_string()
        };
        assert_eq!(kind(step), kind(same), "{step}");
    }
}

#[test]
fn compare_agrees_with_tan_everywhere_and_lists_its_offenders() {
    for line in [format!("compare {GRID}"), "compare --max-sum 9 --rho 1/25 --samples 30".into()] {
        let compare = json(&words(&line, &[]));
        let count = |key: &str| compare["resonance"][key].as_u64().unwrap();
        assert_eq!(compare["tan"]["disagree"], 0);
        assert_eq!(compare["tan"]["agree"], compare["pairs"]);
        let offenders = compare["offenders"].as_array().unwrap();
        assert_eq!(offenders.len() as u64, count("misses") + count("false_alarms"));
        assert_eq!(
            compare["pairs"].as_u64().unwrap(),
            ["hits", "quiet", "misses", "false_alarms", "beyond_verlet"].map(count).iter().sum::<u64>()
        );
    }
}

#[test]
fn the_polynomials_of_one_fast_and_one_slow_kick_are_those_of_velocity_verlet() {
    // p/q = 1: Tr Q = 2 - s (1 + rho).
    let polynomial = json(&words("polynomial --ratio 3/3", &[]));
    assert_eq!((polynomial["p"].as_u64(), polynomial["q"].as_u64()), (Some(1), Some(1)));
    assert_eq!(polynomial["polynomials"]["trace"], "(-rho - 1)*s + 2");
}

#[test]
fn the_proposition_holds_with_a_witness_for_every_resonant_point() {
    let document = json(&words("proposition --max 9", &[]));
    assert_eq!(document["holds"], true);
    let witnesses = document["witnesses"].as_array().unwrap();
    assert_eq!(witnesses.len() as u64, document["resonant_points"].as_u64().unwrap());
    for w in witnesses {
        let n = |key: &str| w[key].as_i64().unwrap();
        assert_eq!(n("m"), n("a") * n("p") + n("b") * n("q"), "{w}");
        assert_ne!(n("b"), 0, "{w}");
    }
}

#[test]
fn every_command_explains_itself() {
    let commands = [
        "verdict",
        "curves",
        "compare",
        "proposition",
        "polynomial",
        "half",
        "map",
        "run",
        "tongues",
        "closings",
        "aperture",
        "bands",
        "word",
        "verify",
        "system",
        "simulate",
        "advise",
        "merge",
    ];
    for command in commands {
        let help = stdout(&[command, "--help"]);
        assert!(help.contains(&format!("Usage: kickdrift {command}")), "{help}");
        assert!(help.lines().all(|line| line.chars().count() <= 140), "{help}");
    }
    let all = stdout(&["--help"]);
    assert!(all.contains("verdict") && all.contains("--budget"));
    assert!(stdout(&["--version"]).starts_with("kickdrift "));
}

#[test]
fn an_aperture_has_the_same_bytes_on_any_number_of_threads() {
    let bond = "OH:morse:D=485.72kJ/mol,a=22.87/nm,15.999,1.008";
    let asked = |threads| {
        let line =
            ["aperture", "--bond", bond, "--h-range", "1.9fs..2.3fs", "--step", "0.1fs", "--format", "json"];
        stdout(&[&line[..], &["--threads", threads]].concat())
    };
    let alone = asked("1");
    assert!(alone.contains("no proof") && asked("2") == alone && asked("5") == alone);
}

const README: &str = include_str!("../../README.md");

/// Every answer in the README is the program's own; "..." stands for the rest.
#[test]
fn the_readme_shows_what_the_program_prints() {
    let tidy = |text: &str| text.trim_end().lines().map(str::trim_end).collect::<Vec<_>>().join("\n");
    let blocks = README.split("```console\n").skip(1).map(|block| block.split("```").next().unwrap());
    let mut held = 0;
    for one in blocks.flat_map(|block| block.split("$ kickdrift ").skip(1)) {
        let (command, answer) = one.split_once('\n').unwrap();
        let printed = tidy(&stdout(&command.split_whitespace().collect::<Vec<_>>()));
        match tidy(answer).strip_suffix("...") {
            Some(beginning) => assert!(printed.starts_with(beginning), "{command}\n{printed}"),
            None => assert_eq!(printed, tidy(answer), "{command}"),
        }
        held += 1;
    }
    assert!(held >= 2, "{held}");
}

/// The commands without an answer do what the reader hopes for: with an input of GROMACS where one is named.
#[test]
fn the_commands_of_the_readme_run() {
    let desk = Desk::new();
    let input = "integrator = md\ndt = 0.0005\nmts = yes\nmts-levels = 2\nmts-level2-factor = 4\n";
    std::fs::write(desk.path().join("md.mdp"), input).unwrap();
    std::fs::create_dir(desk.path().join("out")).unwrap();
    let commands = README.lines().filter_map(|line| line.strip_prefix("kickdrift "));
    let mut held = 0;
    for command in commands {
        let program = concat!(env!("CARGO_BIN_EXE_kickdrift"), " ");
        let line = program.to_string() + command;
        let done =
            std::process::Command::new("sh").args(["-c", &line]).current_dir(desk.path()).output().unwrap();
        assert!(done.status.success(), "{command}\n{}", String::from_utf8_lossy(&done.stderr));
        held += 1;
    }
    assert!(held >= 9, "{held}");
}

/// A page that is read to its end by someone who has five minutes.
#[test]
fn the_readme_is_short() {
    assert!(README.lines().count() <= 160);
}

#[test]
fn digits_asked_for_shorten_the_numbers_of_a_text_that_is_all_summary() {
    let whole = stdout(&words(UNSTABLE, &[]));
    let short = stdout(&words(UNSTABLE, &["--digits", "4"]));
    let longest = |text: &str| {
        let uncertain = text.split_whitespace().filter(|word| word.contains('(') && word.contains('.'));
        uncertain.map(|word| word.chars().filter(char::is_ascii_digit).count()).max()
    };
    // Four digits, one of their error, and the zeros before 0.06.
    assert!(longest(&whole) > Some(12) && longest(&short) <= Some(7), "{whole}{short}");
    assert_eq!(whole.lines().count(), short.lines().count());
}

/// 1/100 is no double: its nearest one is the one point.
#[test]
fn a_range_of_one_step_has_one_point_of_each_curve() {
    let line = "curves --h1-range 1/100..1/100 --a 0..1 --b 1..2 --format csv";
    let points: Vec<String> = stdout(&words(line, &[])).lines().skip(1).map(String::from).collect();
    assert_eq!(points.len(), 2, "{points:?}");
    assert!(points.iter().all(|row| row.split(',').nth(2) == Some("0.01")), "{points:?}");
}

/// h2 at a thousand places of curves far from the resonance, where 1e-14 is less than doubles can hold.
#[test]
fn points_of_curves_are_the_nearest_doubles_and_hold_the_curve_to_what_doubles_can() {
    let curves = json(&words("curves --a 900..901 --b -3..-2 --samples 9", &[]));
    let mut seen = 0;
    for curve in curves["curves"].as_array().unwrap() {
        let (a, b) = (curve["a"].as_f64().unwrap(), curve["b"].as_f64().unwrap());
        for point in curve["points"].as_array().unwrap() {
            let [h1, h2, share] = ["h1", "h2", "theta_over_pi"].map(|key| point[key].as_f64().unwrap());
            // b h1/h2 in doubles has two more roundings of a number of size a.
            assert!((share - (a + b * h1 / h2)).abs() <= f64::EPSILON * (2.0 * a + 2.0), "{point}");
            seen += 1;
        }
    }
    assert!(seen > 4, "{seen}");
}

#[test]
fn what_is_refused_for_its_cost_names_a_budget_that_is_taken() {
    let refused = |line: &str| run(&words(line, &[])).stderr;
    // 10^10 kicks: hours.
    let told = refused("compare --max-sum 500 --samples 999 --rho 1/25");
    assert!(told.contains("kicks") && told.contains("--budget "), "{told}");
    let told = refused("compare --max-sum 6 --rho 1/25 --samples 10 --budget 1000");
    let budget = told.split("--budget ").nth(1).unwrap().split(',').next().unwrap().to_string();
    let taken = run(&words("compare --max-sum 6 --rho 1/25 --samples 10 --quiet --budget", &[&budget]));
    assert_eq!(taken.code, Some(0), "{}", taken.stderr);
    // Beyond what any budget counts.
    let [p, q, most] = ["4611686018427387903", "4611686018427387902", "18446744073709551615"];
    for line in ["polynomial", "half --s 1 --rho 1"] {
        let ended = run(&words(&format!("{line} --ratio {p}/{q} --budget {most}"), &[]));
        assert_eq!(ended.code, Some(2), "{}", ended.stderr);
        assert!(ended.stderr.contains("choose") && !ended.stderr.contains("--budget"), "{}", ended.stderr);
    }
}

#[test]
fn a_sum_that_lacks_little_says_how_much() {
    let text = stdout(&["word", "K(1/2) D(0.9999999999999999999) K(1/2)"]);
    assert!(text.contains("consistent   no: the coefficients sum to D 1 - 1.0e-19, K 1"), "{text}");
}

/// 71, 97 and 310 steps of 0.01 fs meet after 2.1 million kicks, and edges take a thousand orbits: the cost
/// is told before any of it.
#[test]
fn advice_on_steps_that_rarely_meet_is_refused_with_its_cost() {
    let line = "advise --period 10fs --period 20fs --period 60fs --steps 0.71fs,0.97fs,3.1fs --band 0";
    let ended = run(&words(line, &[]));
    assert!(ended.code == Some(2) && ended.stderr.contains("allow it with --budget"), "{}", ended.stderr);
}
