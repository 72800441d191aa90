//! Files whole or not at all, pipes that close, the same bytes always.

use std::io::Read;
use std::process::Stdio;

use super::support::{Desk, stdout, words};

const MAP: &str =
    "map --lambda1 pi^2 --lambda2 pi^2/25 --step 1/20 --h1-range 1/20..2/pi --h2-range 1/20..7/2";
const VERDICT: &str = "verdict --lambda1 10 --lambda2 2/5 --h1 1/10 --h2 1";

#[test]
fn the_number_of_threads_changes_no_byte() {
    let compare = "compare --max-sum 12 --rho 1/25 --samples 20";
    for line in [MAP, "curves --samples 50", compare] {
        for format in ["json", "csv", "latex", "text"] {
            let with = |n| stdout(&words(line, &["--format", format, "--threads", n]));
            assert_eq!(with("1"), with("2"), "{line} --format {format}");
        }
    }
}

#[test]
fn an_output_file_holds_what_standard_output_would() {
    let desk = Desk::new();
    let ended = desk.run(&words(MAP, &["--format", "csv", "--output", "map.csv"]));
    assert_eq!(
        (ended.code, ended.stdout.as_str(), ended.stderr.as_str()),
        (Some(0), "", "kickdrift: wrote map.csv\n")
    );
    assert_eq!(desk.read("map.csv"), stdout(&words(MAP, &["--format", "csv"])).into_bytes());
    assert_eq!(desk.files(), ["map.csv"]);
}

#[test]
fn the_extension_of_the_output_is_its_form_unless_a_format_is_asked_for() {
    let desk = Desk::new();
    for (name, format) in [("v.json", "json"), ("v.csv", "csv"), ("v.tex", "latex"), ("v.txt", "text")] {
        assert_eq!(desk.run(&words(VERDICT, &["--output", name])).code, Some(0));
        assert_eq!(desk.read(name), stdout(&words(VERDICT, &["--format", format])).into_bytes(), "{name}");
    }
    desk.run(&words(VERDICT, &["--format", "csv", "--output", "v.json"]));
    assert_eq!(desk.read("v.json"), desk.read("v.csv"));
    for name in ["v.svg", "v.PNG", "v.npz"] {
        let ended = desk.run(&words(VERDICT, &["--output", name]));
        assert_eq!((ended.code, ended.stdout.as_str()), (Some(2), ""));
        assert!(
            ended.stderr.contains(name) && ended.stderr.contains(".json, .csv, .tex or .txt"),
            "{}",
            ended.stderr
        );
    }
    assert_eq!(desk.files(), ["v.csv", "v.json", "v.tex", "v.txt"]);
}

#[test]
fn two_results_do_not_share_a_file() {
    let desk = Desk::new();
    let line = words(VERDICT, &["--certificate", "a.txt", "--output", "a.txt"]);
    let ended = desk.run(&line);
    assert_eq!(ended.code, Some(2));
    assert!(ended.stderr.contains("certificate = a.txt") && desk.is_empty(), "{}", ended.stderr);
}

/// Some seconds of work, its arrays growing beside the output from the beginning.
#[cfg(unix)]
const LONG: &str = "map --lambda1 pi^2 --lambda2 pi^2/25 --step 1/6000 --h1-range 1/6000..2/pi \
                    --h2-range 1/6000..7/2 --output map.npz";

/// The command with signals as a terminal leaves them. A script's background job ignores SIGINT, `nohup`
/// ignores SIGHUP, and whatever runs these tests hands that on: the program would go on, as it should.
#[cfg(unix)]
fn hearing(mut command: std::process::Command) -> std::process::Command {
    use std::os::unix::process::CommandExt;
    let reset = || {
        for signal in [libc::SIGHUP, libc::SIGINT, libc::SIGTERM, libc::SIGXCPU] {
            // SAFETY: `signal` may be called between fork and exec, and the default action runs no code of
            // ours.
            unsafe { libc::signal(signal, libc::SIG_DFL) };
        }
        Ok(())
    };
    // SAFETY: the closure calls `signal` alone and takes no memory.
    unsafe { command.pre_exec(reset) };
    command
}

/// Starts LONG, sends it a signal as soon as its first file is there, and waits for its end.
#[cfg(unix)]
fn stopped(desk: &Desk, signal: &str) -> std::process::ExitStatus {
    let mut child = hearing(desk.command(&words(LONG, &[]))).spawn().unwrap();
    while desk.files().is_empty() {
        assert!(child.try_wait().unwrap().is_none(), "it has ended before it could be stopped");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let kill = std::process::Command::new("kill").args([signal, &child.id().to_string()]).status();
    assert!(kill.unwrap().success());
    child.wait().unwrap()
}

#[cfg(unix)]
#[test]
fn a_process_that_is_interrupted_or_terminated_leaves_nothing_behind() {
    use std::os::unix::process::ExitStatusExt;
    for (signal, number) in [("-HUP", 1), ("-INT", 2), ("-TERM", 15), ("-XCPU", 24)] {
        let desk = Desk::new();
        assert_eq!(stopped(&desk, signal).signal(), Some(number));
        assert!(desk.is_empty(), "{signal}: {:?}", desk.files());
    }
}

/// The program under `sh`, which first does what `before` says.
#[cfg(target_os = "linux")]
fn under_shell(desk: &Desk, before: &str, line: &str) -> std::process::Command {
    let mut command = std::process::Command::new("sh");
    let script = format!("{before}; exec {} {line}", env!("CARGO_BIN_EXE_kickdrift"));
    command.args(["-c", &script]).current_dir(desk.path()).stdin(Stdio::null());
    command
}

#[cfg(target_os = "linux")]
#[test]
fn a_hangup_that_is_ignored_as_nohup_has_it_stays_so() {
    use std::os::unix::process::ExitStatusExt;
    let desk = Desk::new();
    let mut child = under_shell(&desk, "trap '' HUP", LONG).spawn().unwrap();
    while desk.files().is_empty() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    // Signals come one after the other: were the first heard, it would be the end.
    for signal in ["-HUP", "-TERM"] {
        std::process::Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(100));
    }
    assert_eq!(child.wait().unwrap().signal(), Some(15));
    assert!(desk.is_empty());
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_that_may_not_grow_so_large_is_an_error_and_nothing_is_left() {
    let desk = Desk::new();
    let output = under_shell(&desk, "ulimit -f 8", LONG).output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("map.npz") && desk.is_empty(), "{message} {:?}", desk.files());
}

#[cfg(target_os = "linux")]
#[test]
fn a_map_that_memory_has_no_room_for_is_refused() {
    let desk = Desk::new();
    for line in [
        // A column of 4e7 rows, and 6e7 columns side by side.
        "map --lambda1 pi^2 --lambda2 1 --step1 1/20000 --step2 1/10000000 --h1-range 0..0.6 --h2-range 0..4",
        "compare --lambda1 pi^2 --lambda2 1 --step1 1/60000000 --step2 1/60000000 --h1-range 0..1 --h2-range 1/60000000..1/60000000",
    ] {
        let line = format!("{line} --budget 1000000000000000000");
        let output = under_shell(&desk, "ulimit -v 2000000", &line).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {message}");
        assert!(
            message.contains("there is no memory for it: choose") && message.lines().count() == 1,
            "{message}"
        );
    }
}

#[cfg(target_os = "linux")]
#[test]
fn an_input_without_an_end_is_refused() {
    let desk = Desk::new();
    for command in ["system", "verify", "advise", "advise --engine", "run", "explore --no-open"] {
        let output =
            under_shell(&desk, "ulimit -v 8000000", &format!("{command} /dev/zero")).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{command}: {message}");
        assert!(message.contains("/dev/zero") && message.contains("it is no text"), "{command}: {message}");
    }
}

#[test]
fn a_read_only_file_is_not_replaced() {
    for (line, flag, name) in [
        (VERDICT, "--output", "kept.json"),
        (MAP, "--output", "kept.npz"),
        (VERDICT, "--certificate", "kept.v"),
    ] {
        let desk = Desk::new();
        desk.write(name, "old");
        let path = desk.path().join(name);
        let mut permissions = std::fs::metadata(&path).unwrap().permissions();
        permissions.set_readonly(true);
        std::fs::set_permissions(&path, permissions).unwrap();
        let ended = desk.run(&words(line, &[flag, name]));
        assert!(ended.code == Some(2) && ended.stderr.contains("read-only"), "{name}: {}", ended.stderr);
        assert_eq!((desk.read(name), desk.files()), (b"old".to_vec(), vec![name.to_string()]));
    }
}

#[cfg(unix)]
#[test]
fn what_a_killed_process_left_is_removed_by_the_next_one_in_that_folder() {
    let desk = Desk::new();
    stopped(&desk, "-KILL");
    assert!(!desk.is_empty());
    assert_eq!(desk.run(&words(VERDICT, &["--output", "v.json"])).code, Some(0));
    assert_eq!(desk.files(), ["v.json"]);
}

#[test]
fn an_error_leaves_the_old_file_as_it_was() {
    let desk = Desk::new();
    desk.write("old.json", "old");
    let line = "verdict --lambda1 10 --lambda2 1 --h1 1/10 --h2 pi --output old.json";
    assert_eq!(desk.run(&words(line, &[])).code, Some(2));
    assert_eq!(desk.read("old.json"), b"old");
    assert_eq!(desk.files(), ["old.json"]);
}

#[test]
fn an_unwritable_output_is_named_and_nothing_is_left() {
    for (output, remedy) in
        [("no/such/folder.json", "there is no folder no/such: make it first"), (".", "name a file in it")]
    {
        let desk = Desk::new();
        let ended = desk.run(&words(VERDICT, &["--output", output]));
        assert_eq!((ended.code, ended.stdout.as_str()), (Some(2), ""));
        assert_eq!(ended.stderr.lines().count(), 1, "{}", ended.stderr);
        assert!(ended.stderr.contains(output) && ended.stderr.contains(remedy), "{}", ended.stderr);
        assert!(desk.is_empty());
    }
}

#[test]
fn a_reader_who_goes_away_early_is_no_error() {
    let desk = Desk::new();
    // Some megabytes, more than any pipe holds.
    let line = "curves --samples 2000";
    let mut child =
        desk.command(&words(line, &[])).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut few = [0; 10];
    child.stdout.take().unwrap().read_exact(&mut few).unwrap(); // and dropped
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let desk = Desk::new();
    let full = || std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = desk.command(&words(VERDICT, &[])).stdout(full()).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8(output.stderr).unwrap().contains("standard output"));
    for line in [&["--help"][..], &["--version"], &["map", "--help"]] {
        assert_eq!(desk.command(line).stdout(full()).output().unwrap().status.code(), Some(2), "{line:?}");
    }
    // Where even the message cannot be written, the code still tells.
    let status = desk.command(&["verdict"]).stderr(full()).status().unwrap();
    assert_eq!(status.code(), Some(2));
}

/// Rust's runtime opens the null device where a descriptor is closed: nothing written there is an error.
#[cfg(any(target_os = "linux", target_os = "macos"))]
#[test]
fn a_closed_standard_output_is_an_error_and_the_null_device_is_none() {
    let desk = Desk::new();
    for (line, code) in [
        (format!("{VERDICT} >&-"), 2),
        ("--help >&-".into(), 2),
        (format!("{VERDICT} --output v.json >&-"), 0),
        (format!("{VERDICT} > /dev/null"), 0),
        (format!("{VERDICT} 1<> /dev/null"), 0),
    ] {
        let script = format!("exec {} {line}", env!("CARGO_BIN_EXE_kickdrift"));
        let output =
            std::process::Command::new("sh").args(["-c", &script]).current_dir(desk.path()).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{line}: {message}");
        assert_eq!(
            message.contains("standard output: cannot write (it is closed)"),
            code == 2,
            "{line}: {message}"
        );
    }
    assert_eq!(desk.files(), ["v.json"]);
}

#[cfg(unix)]
#[test]
fn a_file_that_is_replaced_keeps_who_may_read_it_and_not_whom_it_runs_as() {
    use std::os::unix::fs::PermissionsExt;
    let desk = Desk::new();
    let path = desk.path().join("v.json");
    for (old, new) in [(0o6751, 0o751), (0o1640, 0o640), (0o600, 0o600)] {
        desk.write("v.json", "old");
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(old)).unwrap();
        assert_eq!(desk.run(&words(VERDICT, &["--output", "v.json"])).code, Some(0));
        assert_eq!(std::fs::metadata(&path).unwrap().permissions().mode() & 0o7777, new, "{old:o}");
    }
}

/// A name of a file, and a title that a file brings, may move the cursor of whoever reads it.
#[cfg(unix)]
#[test]
fn names_and_titles_reach_a_terminal_without_control_characters() {
    let desk = Desk::new();
    let name = "a\u{1b}[31m\u{202e}b\nc.json";
    let ended = desk.run(&words(VERDICT, &["--output", name]));
    assert_eq!(
        (ended.code, ended.stderr.as_str()),
        (Some(0), "kickdrift: wrote a\\u{1b}[31m\\u{202e}b c.json\n")
    );
    assert_eq!(desk.files(), [name]);
    let scene = r#"{"schema": "kickdrift/scene/1", "title": "a\u001b]0;b\u0007", "lambda1": 1, "lambda2": 1,
        "grid": {"step": 1, "h1": "1..2", "h2": "1..2"}, "want": ["map.csv"]}"#;
    desk.write("s.json", scene);
    let ended = desk.run(&["run", "s.json", "--output", "o\u{1b}"]);
    let is_control = |c: char| c != '\n' && c.is_control();
    assert!(
        ended.code == Some(0) && ended.stdout.contains("a\\u{1b}]0;b"),
        "{}{}",
        ended.stdout,
        ended.stderr
    );
    assert!(!ended.stdout.contains(is_control) && !ended.stderr.contains(is_control));
}

/// Values that a file says it has, counted before there is room for them: within the memory that a shell
/// allows, and at once.
#[cfg(target_os = "linux")]
#[test]
fn a_file_of_more_values_than_memory_holds_is_refused() {
    let desk = Desk::new();
    let ones = |n: usize| format!("[{}1]", "1,".repeat(n - 1));
    let system = |rest: String| format!("{{\"schema\": \"kickdrift/system/1\", {rest}, \"potentials\": []}}");
    desk.write("masses.json", &system(format!("\"masses\": {}", ones(5_000_000))));
    desk.write("rows.json", &system(format!("\"masses\": [1], \"labels\": {}", ones(5_000_000))));
    let head = "\"kickdrift\": {\"version\": \"0\", \"command\": \"verdict\"}";
    desk.write(
        "v.json",
        &format!("{{\"schema\": \"kickdrift/verdict/1\", {head}, \"input\": {}}}", ones(20_000_000)),
    );
    desk.write("scene.json", &format!("{{\"a\": {}}}", ones(20_000_000)));
    for (line, says) in [
        ("system masses.json", "masses = 5000000: at most 4096 degrees of freedom"),
        ("system rows.json", "there is no memory for it"),
        ("verify v.json", "there is no memory for it"),
        ("explore --no-open scene.json", "a scene has at most 1 MiB"),
    ] {
        let output = under_shell(&desk, "ulimit -v 600000", line).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {message}");
        assert!(message.contains(says) && message.lines().count() == 1, "{line}: {message}");
    }
}

#[test]
fn packagers_get_a_page_of_each_command_and_completions_for_each_shell() {
    let desk = Desk::new();
    assert_eq!(desk.run(&["generate", "man", "--output", "man"]).code, Some(0));
    let page = |name: &str| String::from_utf8(desk.read(name)).unwrap();
    assert!(page("man/kickdrift.1").contains(".TH kickdrift 1"));
    assert!(page("man/kickdrift-verdict.1").contains("\\-\\-lambda1"));
    assert!(desk.files().len() >= 15, "{:?}", desk.files());
    assert_eq!(desk.run(&["generate", "completions"]).code, Some(0));
    let shells = desk.files().into_iter().filter(|file| file.starts_with("out/completions/"));
    assert!(shells.map(|file| page(&file)).filter(|script| script.contains("lambda1")).count() == 5);
}

#[test]
fn figures_take_the_width_the_title_and_the_unit_asked_for() {
    let desk = Desk::new();
    let flags =
        ["--width", "85mm", "--title", "Run of *h*_1", "--time-unit", "fs", "--text", "--output", "m.svg"];
    let ended = desk.run(&words(MAP, &flags));
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    let svg = String::from_utf8(desk.read("m.svg")).unwrap();
    for piece in
        ["width=\"85mm\"", ">Run of </tspan>", "> (fs)</tspan>", "by 1/20; </tspan>", "> = π</tspan>"]
    {
        assert!(svg.contains(piece), "no {piece} in {svg}");
    }
    desk.run(&words(MAP, &["--output", "m.svg"]));
    assert!(!String::from_utf8(desk.read("m.svg")).unwrap().contains("<text"));
    let diagram = "tongues --ratio 2/1 --rho 1 --figure diagram --output d.svg";
    for (line, flags, field) in [
        (MAP, &["--width", "85"][..], "width = 85"),
        (MAP, &["--outlines"], "--outlines = given"),
        (MAP, &["--title", "A", "--output", "m.csv"], "--title = given"),
        (diagram, &["--time-unit", "fs"], "time-unit = fs"),
        ("advise --period 10fs --period 40fs --steps 1fs,4fs", &["--width", "9cm"], "--width = given"),
    ] {
        let ended = desk.run(&words(line, flags));
        assert!(ended.code == Some(2) && ended.stderr.contains(field), "{}", ended.stderr);
    }
    assert_eq!(desk.files(), ["m.svg"]);
}
