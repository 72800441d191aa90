//! The golden corpus: every command in every format on small inputs, texts of errors and files too, held by a
//! hash of all that a run leaves behind. A change of bytes is a change of `hashes.txt`, in a commit that says
//! which and why:
//!
//! ```text
//! GOLDEN=write cargo test --release --test golden
//! ```

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use tempfile::TempDir;

const COMMANDS: &str = include_str!("commands.txt");
const FORMATS: [&str; 4] = ["text", "json", "csv", "latex"];

fn here() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The command lines. `* line` is the line in every format; `#` begins a comment; `line && line` runs on one
/// desk.
fn lines() -> Vec<String> {
    let lines = COMMANDS.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    let formats = |line: &str| FORMATS.map(|format| format!("{line} --format {format}")).to_vec();
    lines.flat_map(|line| line.strip_prefix("* ").map_or(vec![line.to_string()], formats)).collect()
}

/// A folder with the shipped data and the inputs of this corpus beside it.
fn desk() -> TempDir {
    let desk = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink(here().join("data"), desk.path().join("data")).unwrap();
    for folder in ["tests/golden/input", "tests/cli/data"] {
        for entry in fs::read_dir(here().join(folder)).unwrap() {
            let path = entry.unwrap().path();
            fs::copy(&path, desk.path().join(path.file_name().unwrap())).unwrap();
        }
    }
    desk
}

/// All files below `folder`, sorted; links are not followed.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let below = |path: PathBuf| if path.is_dir() { files(&path) } else { vec![path] };
    paths.into_iter().filter(|path| !path.is_symlink()).flat_map(below).collect()
}

/// FNV-1a, 64 bits: enough to see a change, and the same on every machine.
#[derive(Clone, Copy)]
struct Hash(u64);

impl Hash {
    fn add(&mut self, bytes: &[u8]) {
        // The length parts what is added from what comes next.
        for byte in (bytes.len() as u64).to_le_bytes().iter().chain(bytes) {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
        }
    }
}

/// The hash of all that `line` leaves behind: exit codes, both streams, every file made or changed.
fn hash(line: &str) -> u64 {
    let desk = desk();
    let given: Vec<(PathBuf, Vec<u8>)> =
        files(desk.path()).into_iter().map(|path| (path.clone(), fs::read(&path).unwrap())).collect();
    let mut hash = Hash(0xcbf2_9ce4_8422_2325);
    for part in line.split(" && ") {
        let output = Command::new(env!("CARGO_BIN_EXE_kickdrift"))
            .args(part.split_whitespace())
            .current_dir(desk.path())
            .stdin(Stdio::null())
            .output()
            .unwrap();
        hash.add(format!("{:?}", output.status.code()).as_bytes());
        hash.add(&output.stdout);
        hash.add(&output.stderr);
    }
    for path in files(desk.path()) {
        let bytes = fs::read(&path).unwrap();
        if !given.iter().any(|(known, old)| *known == path && *old == bytes) {
            hash.add(path.strip_prefix(desk.path()).unwrap().to_str().unwrap().as_bytes());
            hash.add(&bytes);
        }
    }
    hash.0
}

/// One line of `hashes.txt` a command, in the order of `commands.txt`; computed on all cores.
fn hashes() -> Vec<String> {
    let lines = lines();
    let (next, done) = (AtomicUsize::new(0), Mutex::new(vec![String::new(); lines.len()]));
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().unwrap().get() {
            scope.spawn(|| {
                while let Some((at, line)) =
                    Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|at| Some((at, lines.get(at)?)))
                {
                    let entry = format!("{:016x} {line}", hash(line));
                    done.lock().unwrap()[at] = entry;
                }
            });
        }
    });
    done.into_inner().unwrap()
}

#[test]
fn every_command_writes_the_bytes_that_it_wrote() {
    let path = here().join("tests/golden/hashes.txt");
    let now = hashes();
    if std::env::var_os("GOLDEN").is_some_and(|value| value == "write") {
        fs::write(&path, now.join("\n") + "\n").unwrap();
    }
    let kept = fs::read_to_string(&path).unwrap();
    let kept: Vec<&str> = kept.lines().collect();
    let other: Vec<&String> = now.iter().filter(|line| !kept.contains(&line.as_str())).collect();
    assert!(other.is_empty(), "{} of {} commands write other bytes:\n{other:#?}", other.len(), now.len());
    assert_eq!(kept.len(), now.len(), "hashes.txt holds commands that are not in commands.txt");
}
