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
    for word in ["  proven ", "  published ", "  unknown ", "Ma, Izaguirre, Skeel 2003"] {
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
    assert!(ended.stdout.contains("dt is the outermost step; 0.5 fs: bond; 4 fs: pair"), "{}", ended.stdout);
    let document =
        desk.run(&words("advise --engine in.lmp --period OH=10fs --period 40fs --format json", &[]));
    desk.write("d.json", &document.stdout);
    assert_eq!(desk.run(&["verify", "d.json"]).code, Some(0));
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
            "scheme = lts: advice is for molecules: `kickdrift system FILE --intervals",
        ),
        ("advise data/scenes/bar-avi.json", "scheme = avi: advice is for molecules"),
        ("advise data/scenes/water4.json --steps 0.7fs,4fs", "a multiple of the inner one"),
        ("advise data/scenes/water4.json --period 10fs", "cannot be used with"),
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
    let said = "4.2 fs is no multiple of 0.5 fs, so no engine runs it; 4 fs (8) and 4.5 fs (9) are";
    assert!(text.starts_with("4.2 fs") && text.lines().next().unwrap().contains(said), "{text}");
    assert!(text.contains(&format!("advice: {said}")) && !text.contains("do not use"), "{text}");
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
    let line = "advise --period OH=10fs --period 40fs --steps 0.48fs,4.8fs --friction";
    let first =
        |rate: &str| stdout(&words(&format!("{line} {rate}"), &[])).lines().next().unwrap().to_string();
    assert!(
        first("1/ps").contains("only a friction above 38.")
            && first("1/ps").contains("the one given does not"),
        "{}",
        first("1/ps")
    );
    assert!(
        first("40/ps").contains("masked by the friction given") && first("40/ps").ends_with("do not use")
    );
}

#[test]
fn constrained_bonds_are_on_no_clock() {
    let line = "advise --bond OH:K=450kcal/mol/A^2,15.999,1.008 --period angle=19.45fs --period 60fs --steps 2fs,4fs";
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
    let water = "--bond OH:K=450kcal/mol/A^2,15.999,1.008 --period angle=19.45fs --period 60fs --no-levers";
    let held = desk.run(&words(&format!("advise --engine run.conf {water}"), &[])).stdout;
    assert!(
        held.contains("  assumed    OH") && held.contains("  write      fullElectFrequency 3\n"),
        "{held}"
    );
    // Which of the periods are bonds is asked for.
    let line = "advise --engine run.conf --period OH=10fs --period 60fs --no-levers";
    let periods = desk.run(&words(line, &[])).stdout;
    assert!(periods.contains("periods do not say which of them are bonds"), "{periods}");
    desk.write("md.mdp", "dt = 0.002\nmts = yes\nmts-level2-factor = 2\nmass-repartition-factor = 3\n");
    let line = "advise --engine md.mdp --bond CH:K=340kcal/mol/A^2,12.011,1.008,3 --period 60fs --no-levers";
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
    let mut command = desk.command(&words("advise --period OH=10fs --period 40fs --no-levers --engine", &[]));
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
