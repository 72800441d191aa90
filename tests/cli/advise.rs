//! `advise`: what a person is told, and what the program refuses.

use super::support::{Desk, json, run, stdout, words};

const WATER: &str = "advise --period OH=10fs --period slow=40fs --steps 0.5fs,4fs --steps 0.5fs,5fs";

#[test]
fn the_first_lines_can_be_acted_on() {
    let text = stdout(&words(WATER, &[]));
    let lines: Vec<&str> = text.lines().take(3).collect();
    assert_eq!(
        lines,
        [
            "4 fs    stable; next unstable interval 4.6768-4.9679 fs, margin 0.677 fs; caution: not below T/3 = 3.33 fs",
            "5 fs    stable, but 0.021 fs above the unstable 4.6875-4.9795 fs (worst: tenfold in 116 fs): do not use",
            "advice: outer step 3 fs (6 of 0.5 fs): below T/3 = 3.33 fs and proven stable for all periods within 5 %; 4 fs (8 of 0.5 fs) is \
             proven too, but drift is published beyond T/3",
        ]
    );
    // What runs of our own show stands beside what is published.
    let text = stdout(&words(WATER, &["--details"]));
    for word in [
        "  proven ",
        "  published ",
        "  measured   27 flexible waters",
        "  unknown ",
        "Ma, Izaguirre, Skeel 2003",
    ] {
        assert!(text.contains(word), "{word}: {text}");
    }
}

#[test]
fn an_engine_s_line_is_rewritten() {
    let desk = Desk::new();
    desk.write(
        "in.lmp",
        "units real\npair_style lj/cut 10\ntimestep 4.0\nrun_style respa 2 8 bond 1 pair 2\n",
    );
    let ended = desk.run(&words("advise --engine in.lmp --period OH=10fs --period 40fs", &[]));
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    assert!(
        ended.stdout.contains("  write      timestep 3\n  write      run_style respa 2 6 bond 1 pair 2\n"),
        "{}",
        ended.stdout
    );
    let line = "advise --engine in.lmp --period OH=10fs --period 40fs --details";
    let all = desk.run(&words(line, &[])).stdout;
    assert!(all.contains("dt is the outermost step; 0.5 fs: bond; 4 fs: pair"), "{all}");
    let document =
        desk.run(&words("advise --engine in.lmp --period OH=10fs --period 40fs --format json", &[]));
    desk.write("d.json", &document.stdout);
    assert_eq!(desk.run(&["verify", "d.json"]).code, Some(0));
}

#[test]
fn the_exit_code_says_whether_all_steps_are_proven_stable() {
    let periods = "advise --period OH=10fs --period slow=40fs --no-levers --exit-code";
    let code = |steps: &str| run(&words(&format!("{periods} {steps}"), &[])).code;
    // Proven for all periods within the band, below what is published or not.
    assert_eq!(code("--steps 0.5fs,3fs"), Some(0));
    assert_eq!(code("--steps 0.5fs,3fs --steps 0.5fs,4fs"), Some(0));
    // Stable above an unstable interval, unstable, and below it by less than the band.
    assert_eq!(code("--steps 0.5fs,3fs --steps 0.5fs,5fs"), Some(1));
    assert_eq!(code("--steps 0.48fs,4.8fs"), Some(1));
    assert_eq!(code("--steps 0.46fs,4.6fs"), Some(1));
    let none = run(&words(periods, &[]));
    assert_eq!(none.code, Some(2), "{}", none.stdout);
    let desk = Desk::new();
    let lines = "units real\npair_style lj/cut 10\ntimestep 4.0\nrun_style respa 2 8 bond 1 pair 2\n";
    for (step, code) in [("4.0", 0), ("5.0", 1)] {
        desk.write("in.lmp", &lines.replace("4.0", step));
        let asked = "advise --engine in.lmp --period OH=10fs --period 40fs --exit-code";
        assert_eq!(desk.run(&words(asked, &[])).code, Some(code), "{step}");
    }
}

#[test]
fn every_form_is_written() {
    let desk = Desk::new();
    for (name, begins) in [
        ("a.csv", "scheme,outer"),
        ("a.tex", "\\begin{table}"),
        ("a.svg", "<svg"),
        ("a.pdf", "%PDF"),
        ("a.png", "\u{fffd}PNG"),
    ] {
        let ended = desk.run(&words(WATER, &["--output", name]));
        assert_eq!((ended.code, ended.stderr), (Some(0), format!("kickdrift: wrote {name}\n")));
        // The advice stays where the person is who has asked.
        assert!(ended.stdout.contains("\nadvice: outer step 3 fs"), "{name}: {}", ended.stdout);
        let quiet = desk.run(&words(WATER, &["--quiet", "--output", name]));
        assert_eq!((quiet.stdout.as_str(), quiet.stderr.as_str()), ("", ""), "{name}");
        let bytes = desk.read(name);
        assert!(String::from_utf8_lossy(&bytes).contains(begins), "{name}");
    }
}

#[test]
fn what_is_missing_is_named_with_a_remedy() {
    let cases = [
        ("advise --steps 1fs,2fs", "period missing"),
        ("advise --period 10fs", "steps missing"),
        ("advise --period 10 --steps 1fs", "period = 10: has no unit: write 10fs"),
        ("advise --period 10fs --steps 1,2fs", "steps = 1: has no unit: write 1fs"),
        (
            "advise --period 10fs --period 40fs --steps 1e300fs,2e300fs",
            "is far from all steps that these periods allow",
        ),
        ("advise --period OH=10fs --steps 1fs,2fs --on OH=3", "choose a clock from 1 to 2"),
        ("advise --period OH=10fs --steps 1fs,2fs --on NH=1", "there is no mode of this name"),
        ("advise --period OH=10fs --steps 1fs,2fs --band 100%", "band"),
        ("advise --period OH=10fs --steps 1fs,2fs --hmr 3.024", "a period has no masses"),
        ("advise --period OH=10fs --steps 1fs,2fs --constraints OH", "give the fastest period that is left"),
        ("advise --period OH=10fs --steps 1fs,2fs --constraints NH", "there is no mode of this name"),
        ("advise --period OH=10fs --steps 1fs,2fs --friction 1", "friction = 1: has no unit: write 1/ps"),
        ("advise data/scenes/ring24.json", "stiffness = given in place"),
        (
            "advise data/scenes/local-steps.json",
            "scheme = lts: advice has no place in a scheme of local steps: `kickdrift system FILE --intervals",
        ),
        ("advise data/scenes/bar-avi.json", "scheme = avi: advice has no place in a scheme of local steps"),
        ("advise data/scenes/water4.json --steps 0.7fs,4fs", "a multiple of the inner one"),
        ("advise data/scenes/water4.json --period 10fs", "stands for Hessians in place of periods"),
        (
            "advise data/scenes/water4.json --constraints h-bonds",
            "potentials[0].force missing: give the force of each potential",
        ),
        ("advise data/scenes/water4.json --constraints OH", "write h-bonds, or pairs of particles"),
        ("advise data/scenes/water4.json --hmr 30", "leaves every heavy particle some"),
        ("advise data/scenes/water4.json --friction 0/ps", "friction = 0/ps: must be positive"),
        ("advise data/hessians/water4.npz", "steps missing: give the inner and the outer step"),
        ("advise data/hessians/water4.npz --steps 1fs", "steps missing: give the inner and the outer step"),
        ("advise data/hessians/nowhere.npz --steps 0.5fs,4fs", "nowhere.npz"),
        ("advise --engine nowhere.mdp --period 10fs", "nowhere.mdp"),
    ];
    for (line, expected) in cases {
        let line = line.replace(" data/", concat!(" ", env!("CARGO_MANIFEST_DIR"), "/data/"));
        let line = line.as_str();
        let ended = run(&words(line, &[]));
        assert_eq!((ended.code, ended.stdout.as_str()), (Some(2), ""), "{line}");
        assert!(
            ended.stderr.contains(expected) && ended.stderr.trim_end().lines().count() == 1,
            "{line}: {}",
            ended.stderr
        );
    }
}

#[test]
fn an_outer_step_that_is_no_multiple_is_named_with_those_that_are() {
    let text = stdout(&words("advise --period OH=10fs --period 40fs --steps 0.5fs,4.2fs", &[]));
    let said =
        "no multiple of 0.5 fs, so no engine runs it: ask for 4 fs (8 of 0.5 fs) or 4.5 fs (9 of 0.5 fs)";
    assert!(text.starts_with(&format!("4.2 fs  {said}; asynchronous, as it stands, it is stable")), "{text}");
    assert!(text.contains(&format!("advice: 4.2 fs is {said}")) && !text.contains("do not use"), "{text}");
}

#[test]
fn a_friction_that_stops_all_velocities_does_not_panic() {
    for line in [
        "verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 1/100 --h2 0.98 --friction 2^60",
        "system DATA/diatomic-tether.json --friction 2^60",
        "system DATA/water4.json --friction 10^30",
        "advise --period OH=10fs --period 40fs --steps 0.5fs,4fs --friction 1e30/ps",
        "advise DATA/water4.json --friction 1e30/ps",
    ] {
        let line = line.replace("DATA", concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes"));
        let ended = run(&words(&line, &[]));
        assert_eq!(ended.code, Some(0), "{line}: {}", ended.stderr);
    }
}

#[test]
fn a_friction_that_masks_is_told_and_is_no_advice() {
    let line = "advise --period OH=10fs --period 40fs --steps 0.48fs,4.8fs --no-levers --friction";
    let first =
        |rate: &str| stdout(&words(&format!("{line} {rate}"), &[])).lines().next().unwrap().to_string();
    assert!(
        first("1/ps").contains("(a friction above 38.") && first("1/ps").contains("the one given does not"),
        "{}",
        first("1/ps")
    );
    assert!(
        first("40/ps").contains("masked by the friction given") && first("40/ps").ends_with("do not use")
    );
}

#[test]
fn constrained_bonds_are_on_no_clock() {
    let line = "advise --bond OH:K=450kcal/mol/A^2,15.999,1.008 --period angle=19.45fs --period 60fs --details --steps 2fs,4fs";
    let free = stdout(&words(line, &[]));
    let text = stdout(&words(&format!("{line} --constraints h-bonds"), &[]));
    assert!(!free.starts_with("4 fs    safe") && text.starts_with("4 fs    safe"), "{text}");
    assert!(text.contains("  assumed    OH (T = 9.97"), "{text}");
    // GROMACS says it in its own file.
    let desk = Desk::new();
    desk.write("md.mdp", "dt = 0.002\nmts = yes\nmts-level2-factor = 2\nconstraints = h-bonds\n");
    let line = line.replace("--steps 2fs,4fs", "--engine md.mdp");
    let ended = desk.run(&words(&line, &[]));
    assert!(
        ended.stdout.starts_with("4 fs    safe") && ended.stdout.contains("  assumed    OH"),
        "{}",
        ended.stdout
    );
}

#[test]
fn held_bonds_and_heavy_hydrogens_of_an_engine_s_text_are_those_of_the_answer() {
    let desk = Desk::new();
    desk.write(
        "run.conf",
        "structure a.psf\nPME yes\ntimestep 2.0\nrigidBonds all; # held\nfullElectFrequency 2\n",
    );
    let water =
        "--bond OH:K=450kcal/mol/A^2,15.999,1.008 --period angle=19.45fs --period 60fs --no-levers --details";
    let held = desk.run(&words(&format!("advise --engine run.conf {water}"), &[])).stdout;
    assert!(
        held.contains("  assumed    OH") && held.contains("  write      fullElectFrequency 3\n"),
        "{held}"
    );
    // Which of the periods are bonds is asked for.
    let line = "advise --engine run.conf --period OH=10fs --period 60fs --no-levers --details";
    let periods = desk.run(&words(line, &[])).stdout;
    assert!(periods.contains("periods do not say which of them are bonds"), "{periods}");
    desk.write("md.mdp", "dt = 0.002\nmts = yes\nmts-level2-factor = 2\nmass-repartition-factor = 3\n");
    let line = "advise --engine md.mdp --bond CH:K=340kcal/mol/A^2,12.011,1.008,3 --period 60fs --no-levers --details";
    let heavy = desk.run(&words(line, &[])).stdout;
    assert!(heavy.contains("CH (T = 16.69") && heavy.contains("hydrogens of 3.024 amu"), "{heavy}");
    // grompp wants a mesh's forces on the second level and no other integrator: then nothing is written.
    desk.write("sd.mdp", "integrator = sd\ndt = 0.0005\nmts = yes\nmts-level2-factor = 10\n");
    let text =
        desk.run(&words("advise --engine sd.mdp --period OH=10fs --period 40fs --no-levers", &[])).stdout;
    assert!(
        text.contains("  write      nothing: grompp refuses this text: mts is for integrator = md"),
        "{text}"
    );
}

#[cfg(target_os = "linux")]
#[test]
fn an_engine_s_file_may_have_any_name_a_mark_before_its_text_and_latin_letters_in_comments() {
    use std::os::unix::ffi::OsStrExt;
    let desk = Desk::new();
    let name = std::ffi::OsStr::from_bytes(b"md\xff.mdp");
    std::fs::write(desk.path().join(name), b"\xef\xbb\xbfdt = 0.002 ; \xe9quilibration\nnstlist = 10\n")
        .unwrap();
    let mut command =
        desk.command(&words("advise --details --period OH=10fs --period 40fs --no-levers --engine", &[]));
    let output = command.arg(name).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("  used       dt = 0.002\n"), "{text} {}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn exact_inputs_are_echoed() {
    let document = json(&words(WATER, &[]));
    assert_eq!(document["input"]["modes"][0]["stiffness"], "pi^2/25");
    assert_eq!(document["schemes"][0]["safe"], "3");
    assert_eq!(document["schemes"][1]["status"], "island");
}

/// Arrays in an archive, and a system file that refers to them.
#[test]
fn an_archive_is_advised_as_its_system_file_is() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/data");
    let desk = Desk::new();
    // Behind what is safe, what limits it, what would let it grow.
    let verdict = |line: &str| {
        let ended = desk.run(&words(line, &[]));
        assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""), "{line}");
        let lines: Vec<&str> = ended.stdout.lines().collect();
        let begins = [("advice: outer step 2.5 fs", 0), ("limit: O-H stretch of H", 1), ("longer: ", 2)];
        assert!(begins.iter().all(|(words, n)| lines[*n].starts_with(words)), "{}", ended.stdout);
        lines[3].to_string()
    };
    let bare = format!("advise {folder}/hessians/water4.npz --steps 0.5fs,4fs");
    let (bare, file) = (verdict(&bare), verdict(&format!("advise {folder}/scenes/water4.json")));
    assert!(bare == file && bare.starts_with("4 fs    stable; next unstable interval 4.4"), "{bare}\n{file}");
}

#[test]
fn steps_that_the_file_has_or_that_are_given_twice_are_answered_once() {
    let advice = |line: &str| stdout(&words(line, &[]));
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/water4.json");
    let own = advice(&format!("advise {file}"));
    assert_eq!(advice(&format!("advise {file} --steps 0.5fs,4fs --steps 1/2fs,4fs")), own);
    assert_ne!(advice(&format!("advise {file} --steps 0.5fs,3fs")), own);
    let once = "advise --period OH=10fs --period 40fs --steps 0.5fs,4fs";
    assert_eq!(advice(&format!("{once} --steps 0.5fs,4fs")), advice(once));
}

#[test]
fn a_molecule_is_drawn_and_its_advice_verified() {
    let desk = Desk::new();
    desk.copy(&["tiny.json", "tiny-fast.npy", "tiny-slow.npy"]);
    let line = "advise tiny.json --steps 0.5fs,4.5fs --steps 0.5fs,5fs --length 1ns";
    for name in ["a.svg", "a.json", "a.csv", "a.tex"] {
        let ended = desk.run(&words(line, &["--output", name]));
        assert_eq!((ended.code, ended.stderr), (Some(0), format!("kickdrift: wrote {name}\n")));
    }
    assert!(desk.read("a.svg").starts_with(b"<svg"));
    let ended = desk.run(&["verify", "a.json"]);
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    assert!(ended.stdout.contains("the action as one matrix over the paths"), "{}", ended.stdout);
}

/// Periods that are left when bonds are held, or that are called slow, say nothing of the fastest motion.
#[test]
fn without_a_fast_period_the_answer_asks_for_one_and_offers_typical_ones() {
    for line in [
        "advise --period slow=water --steps 0.5fs,4fs",
        "advise --period OH=10fs --period slow=40fs --constraints OH --steps 2fs,12fs",
        "advise --period OH=10fs --period 40fs --constraints OH --steps 2fs,12fs",
        "advise --period slow=40fs --steps 4fs",
    ] {
        let text = stdout(&words(line, &[]));
        let first = text.lines().next().unwrap();
        assert!(
            first.contains("not told: the fastest period is not given, so nothing is called safe"),
            "{line}: {text}"
        );
        assert!(
            !text.contains("    safe") && text.contains("advice: none: give the fastest period that is left"),
            "{text}"
        );
        for offered in [
            "fast=protein,h-bonds 17.7 fs",
            "fast=water,rigid",
            "fast=protein,h-bonds,hmr3",
            "measured on villin",
        ] {
            assert!(text.contains(offered), "{offered}: {text}");
        }
        let document = json(&words(line, &[]));
        assert_eq!(document["schemes"][0]["status"], "not told");
    }
    // What it offers works, wherever it stands.
    let text =
        stdout(&words("advise --period slow=water --period fast=protein,h-bonds --steps 2fs,4fs", &[]));
    assert!(text.starts_with("4 fs    safe") && text.contains("fast=protein,h-bonds is 17.7 fs"), "{text}");
    let text = stdout(&words(
        "advise --period OH=10fs --period angle=19.45fs --constraints OH --on angle=1 --steps 2fs,4fs",
        &[],
    ));
    assert!(text.starts_with("4 fs    safe if no period of the forces every 4 fs is below 25"), "{text}");
    assert!(text.contains("give the shortest period of the forces every 4 fs, which has none yet"), "{text}");
}

#[test]
fn a_single_clock_is_advised_below_its_own_turn_unless_its_bonds_are_harmonic() {
    let line = "advise --period OH=8.5836fs --steps 1fs --steps 2fs";
    let text = stdout(&words(line, &["--details"]));
    for said in [
        "1 fs    safe",
        "2 fs    stable; unstable from 2.7322 fs on, margin 0.732 fs; caution: not below T/6.28 = 1.36 fs",
        "advice: keep the step below 1.36 fs = T/6.28 of OH (T = 8.584 fs), that is h w <= 1",
        "1 fs with flexible O-H, 2 fs with O-H held, 4 fs with heavy hydrogens too",
        "T/3.63 = 2.366 fs, T/4.44 = 1.932 fs, T/5.34 = 1.606 fs, T/6.28 = 1.366 fs",
    ] {
        assert!(text.contains(said), "{said}: {text}");
    }
    assert!(!text.contains("T/3 =") && !text.contains("grompp"), "{text}");
    let text = stdout(&words(line, &["--harmonic"]));
    assert!(text.contains("\nadvice: keep the step below 2.59 fs (proven for all periods within 5 %, bonds said to be harmonic)"), "{text}");
    let desk = Desk::new();
    for more in [&["--output", "d.json"][..], &["--harmonic", "--output", "d.json"]] {
        assert_eq!(desk.run(&words(line, more)).code, Some(0));
        assert_eq!(desk.run(&["verify", "d.json"]).code, Some(0), "{more:?}");
    }
    assert_eq!(json(&words(line, &["--harmonic"]))["input"]["harmonic"], "true");
}

#[test]
fn an_inner_step_that_is_too_long_is_named_and_no_line_is_written() {
    let text = stdout(&words("advise --period OH=10fs --period 100fs --steps 1.65fs,3.3fs", &[]));
    assert!(
        text.contains("caution: the step of 1.65 fs is not below T/6.28 = 1.59 fs of its own forces"),
        "{text}"
    );
    assert!(text.contains("advice: none with a step of 1.65 fs inside"), "{text}");
    let desk = Desk::new();
    desk.write(
        "in.lmp",
        "units real\npair_style lj/cut 10\ntimestep 6.6\nrun_style respa 2 4 bond 1 pair 2\n",
    );
    let ended = desk.run(&words("advise --engine in.lmp --period OH=10fs --period 100fs", &[]));
    assert!(ended.code == Some(0) && !ended.stdout.contains("  write "), "{}{}", ended.stdout, ended.stderr);
}

#[test]
fn times_without_a_unit_are_plain_numbers() {
    let line = "advise --period bond=0.2 --period slow=0.8 --steps 0.01,0.09 --friction 1/2 --length 50";
    let text = stdout(&words(line, &["--details"]));
    assert!(
        text.starts_with("0.09    ")
            && text.contains("\nadvice: outer step 0.06 (6 of 0.01): below T/3 = 0.0667"),
        "{text}"
    );
    assert!(!text.contains(" fs") && !text.contains("/ps") && text.contains("per unit of time"), "{text}");
    let desk = Desk::new();
    desk.run(&words(line, &["--output", "d.json"]));
    assert_eq!(desk.run(&["verify", "d.json"]).code, Some(0));
    // So are those of LAMMPS's lj units.
    desk.write("in.lj", "units lj\npair_style lj/cut 2.5\nbond_style fene\ntimestep 0.04\nrun_style respa 2 4 bond 1 pair 2\n");
    let ended = desk.run(&words("advise --engine in.lj --period bond=0.2 --period slow=0.8", &[]));
    assert!(
        ended.code == Some(0) && ended.stdout.starts_with("0.04    safe"),
        "{}{}",
        ended.stdout,
        ended.stderr
    );
    for (line, expected) in [
        ("advise --period bond=0.2 --period slow=0.8fs --steps 0.01,0.08", "has no unit"),
        (
            "advise --period bond=0.2 --period slow=0.8 --steps 0.01,0.08 --length 5ns",
            "write all times as plain numbers",
        ),
    ] {
        let ended = run(&words(line, &[]));
        assert!(ended.code == Some(2) && ended.stderr.contains(expected), "{line}: {}", ended.stderr);
    }
    let ended = desk.run(&words("advise --engine in.lj --period bond=10fs --period slow=40fs", &[]));
    assert!(
        ended.code == Some(2) && ended.stderr.contains("write all times as plain numbers"),
        "{}",
        ended.stderr
    );
}

#[test]
fn equal_steps_are_told_to_be_one_clock() {
    let line = "advise --period a=20fs --period b=30fs --period c=60fs --steps 2fs,2fs,4fs";
    let ended = run(&words(line, &[]));
    let remedy =
        "equal steps are one clock: write 2fs,4fs, and put the modes of both on it, as --on OH=1,angle=1";
    assert!(ended.code == Some(2) && ended.stderr.contains(remedy), "{}", ended.stderr);
    let text = stdout(&words(&line.replace("2fs,2fs,4fs", "2fs,4fs --on a=1,b=1"), &[]));
    assert!(text.starts_with("4 fs    safe"), "{text}");
}

#[test]
fn a_system_in_atomic_units_is_advised_as_in_femtoseconds() {
    let desk = Desk::new();
    // Frequencies of 10 and 40 fs; 1 au of time is 0.0241888... fs.
    let au = 0.024_188_843_265_864;
    let square = |period: f64, unit: f64| (2.0 * std::f64::consts::PI * unit / period).powi(2);
    for (name, unit, inner, outer) in [("au", au, "20", "120"), ("fs", 1.0, "1/2", "3")] {
        let potential = |force: &str, period: f64, step: &str| {
            let file = format!("{name}-{force}.mtx");
            desk.write(
                &file,
                &format!("%%MatrixMarket matrix array real general\n1 1\n{:e}\n", square(period, unit)),
            );
            format!("{{\"name\": \"{force}\", \"step\": \"{step}\", \"stiffness\": {{\"mm\": \"{file}\"}}}}")
        };
        let (fast, slow) = (potential("f", 10.0, inner), potential("s", 40.0, outer));
        let text = format!(
            "{{\"schema\": \"kickdrift/system/1\", \"title\": \"t\", \"masses\": [1], \"time_unit\": \"{name}\", \"potentials\": [{fast}, {slow}]}}"
        );
        desk.write(&format!("{name}.json"), &text);
    }
    let first = |name: &str| {
        let ended = desk.run(&["advise", name, "--steps", "0.5fs,4fs", "--no-levers"]);
        assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""), "{name}");
        ended.stdout.lines().find(|line| line.starts_with("4 fs")).unwrap().to_string()
    };
    assert_eq!(first("au.json"), first("fs.json"));
}

#[test]
fn what_grompp_warns_of_is_told_of_gromacs_alone() {
    let desk = Desk::new();
    desk.write("md.mdp", "integrator = md\ndt = 0.0005\nmts = yes\nmts-levels = 2\nmts-level2-factor = 6\n");
    desk.write(
        "in.lmp",
        "units real\npair_style lj/cut 10\ntimestep 3.0\nrun_style respa 2 6 bond 1 pair 2\n",
    );
    let of = |engine: &str| {
        desk.run(&["advise", "--details", "--engine", engine, "--period", "OH=10fs", "--period", "40fs"])
            .stdout
    };
    assert!(
        of("md.mdp").contains(
            "grompp warns where dt is longer than T/5 = 2 fs, notes where dt is longer than T/10 = 1 fs"
        ),
        "{}",
        of("md.mdp")
    );
    assert!(!of("in.lmp").contains("grompp") && !stdout(&words(WATER, &[])).contains("grompp"));
}

/// i-PI's rings of 32 beads have modes of their own, and a kick every 1.25 fs meets the fastest.
#[test]
fn ring_modes_are_named_and_nothing_is_called_safe_of_ring_polymers() {
    let desk = Desk::new();
    let input = |beads: u32| {
        format!(
            "<simulation><system><initialize nbeads='{beads}'/><ensemble><temperature units='kelvin'> 300 </temperature></ensemble><motion mode='dynamics'>\
             <dynamics mode='nvt'><timestep units='femtosecond'> 1 </timestep></dynamics></motion></system></simulation>"
        )
    };
    for beads in [1, 32] {
        desk.write("input.xml", &input(beads));
        let ended = desk.run(&words("advise --engine input.xml --period OH=10fs", &[]));
        let text = &ended.stdout;
        assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
        assert_eq!(text.starts_with("1 fs    safe"), beads == 1, "{text}");
        assert_eq!(
            text.contains("32 at 300 K: ring modes 1 to 16 have periods of 25.5 down to 2.5 fs"),
            beads == 32,
            "{text}"
        );
        assert_eq!(text.contains("advice: none: 32 beads"), beads == 32, "{text}");
        desk.run(&words("advise --engine input.xml --period OH=10fs --output d.json", &[]));
        assert_eq!(desk.run(&["verify", "d.json"]).code, Some(0));
    }
}

/// A period without a name is called by its length, one clock has no outer steps, a bound has three digits.
#[test]
fn what_has_no_name_is_called_by_its_period() {
    let text = stdout(&words("advise --period 10fs --steps 2fs --steps 4fs", &[]));
    for said in [
        "T/6.28 of the period of 10 fs, that is h w <= 1: beyond it bonds",
        "limit: the period of 10 fs: T/6.28",
        "1.65 at 2 fs, 1.33 at the advised 1.59 fs for the period of 10 fs",
        "tenfold in 1.64 steps = 6.56 fs",
        "longer: nothing that was looked at lets the step grow; forces that are slow may have",
    ] {
        assert!(text.contains(said), "{said}: {text}");
    }
    assert!(!text.contains("10fs (T"), "{text}");
    let text = stdout(&words("advise --period OH=10fs --period 40fs --steps 0.48fs,4.8fs", &["--no-levers"]));
    // 38.7593.
    assert!(text.contains("(a friction above 38.8/ps masks it)"), "{text}");
}

/// Steps of four digits had no colour and hung beneath two spaces.
#[test]
fn a_long_step_stands_apart_from_its_verdict() {
    let line =
        "advise --period bead=1ps --period other=1.0733ps --steps 310fs,2480fs --no-levers --color always";
    assert!(stdout(&words(line, &[])).starts_with("2480 fs  \u{1b}[1;31munstable\u{1b}[0m, within"));
}

/// grompp's refusal stood beneath "write" and once more as a note.
#[test]
fn why_nothing_is_written_is_said_once() {
    let desk = Desk::new();
    desk.write("sd.mdp", "integrator = sd\ndt = 0.0005\nmts = yes\nmts-level2-factor = 10\n");
    let text =
        desk.run(&words("advise --engine sd.mdp --period OH=10fs --period 40fs --no-levers", &[])).stdout;
    assert_eq!(text.matches("mts is for integrator = md").count(), 1, "{text}");
}

/// A friction of 0.05/ps masks it, one of 3/ps does not: "above" is said only where all larger ones are
/// proven.
#[test]
fn a_friction_that_masks_is_no_bound_unless_all_larger_ones_do() {
    let line = "advise --period bead=1ps --period other=1.0733ps --steps 310fs,2480fs --no-levers --friction";
    let text = stdout(&words(line, &["3/ps"]));
    assert!(text.contains("(frictions of ") && text.contains("mask it, the one given does not"), "{text}");
    assert!(!text.contains("friction above"), "{text}");
    assert!(stdout(&words(line, &["8/5/ps"])).contains("masked by the friction given"));
}

#[test]
fn levels_whose_innermost_forces_are_held_are_limited_by_the_next() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/water4-levels.json");
    let text = stdout(&["advise", file, "--constraints", "h-bonds", "--no-levers"]);
    // 15.1 fs is the angles' shortest period; rounding left modes of 8e6 fs of the bonds.
    assert!(text.contains("\nlimit: level 2 (T = 15.") && text.contains("near T/3 = 5.0"), "{text}");
    assert!(!text.contains("e6"), "{text}");
}
