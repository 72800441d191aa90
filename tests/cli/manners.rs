//! How the program behaves towards those who type: slips, notes, citations, figures for papers.

use super::support::{Desk, run, stdout, words};

const MAP: &str =
    "map --lambda1 pi^2 --lambda2 pi^2/25 --step 1/20 --h1-range 1/20..2/pi --h2-range 1/20..7/2";

#[test]
fn a_slip_in_a_command_is_answered_by_the_command_that_was_meant() {
    for (slip, meant) in
        [("verdct", "verdict"), ("verdicts", "verdict"), ("sytem", "system"), ("advice", "advise")]
    {
        let ended = run(&[slip]);
        let expected = format!("kickdrift: command = {slip}: unknown; did you mean {meant}?\n");
        assert_eq!((ended.code, ended.stderr), (Some(2), expected));
    }
}

#[test]
fn whoever_names_a_file_reads_that_it_is_written() {
    let desk = Desk::new();
    let certificate = "verdict --lambda1 10 --lambda2 1 --h1 1/10 --h2 1/5 --certificate v.v";
    for (line, said) in [
        (format!("{MAP} --output m.png"), "kickdrift: wrote m.png\n"),
        (format!("{MAP} --output m.npz"), "kickdrift: wrote m.npz\n"),
        (format!("{MAP} --output m.json"), "kickdrift: wrote m.json\n"),
        ("tongues --ratio 7/3 --rho 1/25 --output t.csv".into(), "kickdrift: wrote t.csv\n"),
        ("closings --max-sum 6 --output c.json".into(), "kickdrift: wrote c.json\n"),
        (certificate.into(), "kickdrift: wrote v.v\n"),
        ("generate man".into(), "kickdrift: wrote 23 files to out/man\n"),
        (format!("{MAP} --output m.svg --quiet"), ""),
    ] {
        let ended = desk.run(&words(&line, &[]));
        assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), said), "{line}");
    }
}

#[test]
fn columns_are_chosen_by_the_names_that_csv_has() {
    let rows = |line: &str| -> Vec<Vec<String>> {
        let text = stdout(&words(line, &["--format", "csv"]));
        text.lines().map(|line| line.split(',').map(String::from).collect()).collect()
    };
    for line in [
        format!("{MAP} --label --growth"),
        "tongues --ratio 7/3 --rho 1/25 --lambda1 pi^2".into(),
        "verdict --lambda1 10 --lambda2 2/5 --h1 0.631 --h2 3.499".into(),
    ] {
        let all = rows(&line);
        for (i, name) in all[0].iter().enumerate() {
            let own = rows(&format!("{line} --columns {name}"));
            // What a comma parts stands in quotes there: such a column is compared by its name alone.
            assert_eq!(own[0], [name.as_str()], "{line}");
            let column: Vec<&str> = all.iter().map(|row| row[i].as_str()).collect();
            assert_eq!(own.iter().map(|row| row[0].as_str()).collect::<Vec<_>>(), column, "{line} {name}");
        }
    }
}

#[test]
fn what_the_columns_of_a_map_need_is_computed() {
    let chosen = stdout(&words(MAP, &["--columns", "h1,m,growth_rate_hi", "--format", "csv"]));
    let full = stdout(&words(MAP, &["--label", "--growth", "--format", "csv"]));
    assert_eq!(chosen.lines().next(), Some("h1,m,growth_rate_hi"));
    assert!(chosen.lines().count() == full.lines().count() && !chosen.contains(",,"), "{chosen}");
    let refused = run(&words(MAP, &["--columns", "h3", "--format", "csv"]));
    assert!(refused.stderr.contains("columns = h3: choose among h1, h2, p, q"), "{}", refused.stderr);
    for form in [&["--format", "json"][..], &["--output", "m.png"]] {
        let refused = run(&words(MAP, &[&["--columns", "h1"], form].concat()));
        assert!(refused.code == Some(2) && refused.stderr.contains("is for rows"), "{}", refused.stderr);
    }
}

#[test]
fn steps_that_were_doubles_are_taken_for_the_numbers_that_they_stand_for() {
    let asked = |[h1, h2]: [&str; 2], flags: &[&str]| {
        let steps = ["verdict", "--lambda1", "pi^2", "--lambda2", "pi^2/25", "--h1", h1, "--h2", h2];
        stdout(&[&steps[..], flags, &["--format", "json"]].concat())
    };
    let (rounded, meant, of_pi) = (["0.3333333333333333", "0.98"], ["1/3", "0.98"], ["1/pi", "3/pi"]);
    assert_eq!(asked(rounded, &["--simplest"]), asked(meant, &[]));
    assert_ne!(asked(rounded, &[]), asked(meant, &[]));
    assert_eq!(asked(of_pi, &["--simplest"]), asked(of_pi, &[]));
}

#[test]
fn a_citation_has_the_authors_and_the_version_of_the_citation_file() {
    let file = include_str!("../../CITATION.cff");
    assert_eq!(stdout(&["cite", "cff"]), file);
    let bibtex = stdout(&["cite"]);
    for piece in [
        "@software{kickdrift,\n",
        concat!("version = {", env!("CARGO_PKG_VERSION"), "}"),
        "author  = {Fong, William and Darve, Eric and Lew, Adrian}",
        "doi     = {10.1016/j.jcp.2008.05.017}",
    ] {
        assert!(bibtex.contains(piece), "{piece}: {bibtex}");
    }
    let desk = Desk::new();
    assert_eq!(desk.run(&["cite", "cff", "--output", "CITATION.cff"]).code, Some(0));
    assert_eq!(desk.read("CITATION.cff"), file.as_bytes());
}

#[test]
fn a_figure_carries_the_version_and_the_command_that_made_it() {
    let desk = Desk::new();
    let version = concat!("kickdrift ", env!("CARGO_PKG_VERSION"));
    let asked = "kickdrift map --lambda1 pi^2 --lambda2 pi^2/25 --step1 1/20 --step2 1/20 --h1-range 1/20..2/pi \
                 --h2-range 1/20..7/2 --curves";
    for name in ["m.svg", "m.png", "m.pdf"] {
        let ended = desk.run(&words(MAP, &["--threads", "2", "--quiet", "--curves", "--output", name]));
        assert_eq!(ended.code, Some(0), "{}", ended.stderr);
        let bytes = desk.read(name);
        let text = String::from_utf8_lossy(&bytes);
        assert!(text.contains(version) && text.contains(asked), "{name}");
    }
    // Neither where it lies nor how it was computed.
    let bytes = desk.read("m.svg");
    std::fs::create_dir(desk.path().join("deep")).unwrap();
    desk.run(&words(MAP, &["--curves", "--resume", "part", "--output", "deep/m.svg"]));
    assert_eq!(desk.read("deep/m.svg"), bytes);
    desk.run(&["merge", "part", "--curves", "--output", "merged.svg"]);
    assert_eq!(desk.read("merged.svg"), bytes);
}

#[test]
fn a_figure_for_a_paper_has_no_words_around_it_or_one_heading() {
    let desk = Desk::new();
    let drawn = |flags: &[&str]| {
        let ended = desk.run(&words(MAP, &[flags, &["--text", "--output", "m.svg"]].concat()));
        assert_eq!(ended.code, Some(0), "{}", ended.stderr);
        String::from_utf8(desk.read("m.svg")).unwrap()
    };
    let (counts, foot) = (">48 of 840 pairs unstable<", "by 1/20; <");
    let count = |svg: &str, piece: &str| svg.matches(piece).count();
    let plain = drawn(&[]);
    assert!(plain.contains("pairs unstable<") && plain.contains(foot), "{counts}");
    let bare = drawn(&["--bare"]);
    assert_eq!((count(&bare, "pairs unstable<"), count(&bare, foot)), (0, 0));
    let titled = drawn(&["--title", "Mine"]);
    assert_eq!((count(&titled, ">Mine</tspan>"), count(&titled, "pairs unstable<")), (1, 0));
    let both = desk.run(&words(MAP, &["--bare", "--title", "A", "--output", "m.svg"]));
    assert_eq!(both.code, Some(2));
}

#[test]
fn a_table_stands_in_the_environment_that_is_asked_for() {
    let narrow = "closings --max-sum 8 --format latex";
    let wide = "tongues --ratio 5/3 --rho 1/25 --m 3 --format latex";
    let map = "map --lambda1 pi^2 --lambda2 pi^2/25 --step 1/20 --h1-range 1/20..1/10 --h2-range 1/20..7/2 --format latex";
    for (line, flags, begins) in [
        (narrow, &[][..], "\\begin{table}\n"),
        (narrow, &["--float", "table*"], "\\begin{table*}\n"),
        (wide, &[], "\\begin{table*}\n"),
        (wide, &["--float", "table"], "\\begin{table}\n"),
        (map, &["--float", "table*"], "\\begin{table*}\n"),
        (map, &["--float", "table", "--columns", "h1,h2"], "\\begin{table}\n"),
    ] {
        let text = stdout(&words(line, flags));
        assert!(text.contains(begins), "{line} {flags:?}: {text}");
    }
    let refused = run(&words("closings --max-sum 8 --format json --float table", &[]));
    assert!(refused.code == Some(2) && refused.stderr.contains("--float = given"), "{}", refused.stderr);
}

#[test]
fn the_axes_of_a_scan_are_named_in_words_with_their_units() {
    let desk = Desk::new();
    let system = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/diatomic-tether.json");
    let drawn = |flags: &[&str]| {
        let ended = desk.run(&[&["system", system], flags, &["--text", "--output", "s.svg"]].concat());
        assert_eq!(ended.code, Some(0), "{}", ended.stderr);
        let svg = String::from_utf8(desk.read("s.svg")).unwrap();
        // The foot repeats what was typed; the axes do not.
        let shown: String =
            svg.split('<').filter_map(|part| part.split_once('>')).map(|(_, text)| text).collect();
        shown
    };
    let map = [
        "--scan",
        "potentials.tether.step=1/10..1/2:1/10",
        "--scan",
        "potentials.bond.springs.0.2=10..50:10",
    ];
    let map = drawn(&map);
    assert!(map.contains("step of tether (time)") && map.contains("spring 0–1 of bond"), "{map}");
    let line = drawn(&["--scan", "masses.1=1..2:1/2"]);
    assert!(line.contains("mass of particle 1"), "{line}");
    let stretches = drawn(&["--intervals", "outer=1/10..2/10", "--time-unit", "ps"]);
    assert!(stretches.contains("outer step (ps)"), "{stretches}");
}
