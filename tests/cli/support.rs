//! Running the program in an empty folder of its own.

use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::Value;
use tempfile::TempDir;

/// A run that has ended.
pub struct Ended {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

/// An empty folder in which the program runs.
pub struct Desk(pub TempDir);

impl Desk {
    pub fn new() -> Desk {
        Desk(tempfile::tempdir().unwrap())
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    /// These files of tests/cli/data.
    pub fn copy(&self, names: &[&str]) {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli/data");
        for name in names {
            std::fs::copy(folder.join(name), self.path().join(name)).unwrap();
        }
    }

    pub fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_kickdrift"));
        command.args(args).current_dir(self.path()).stdin(Stdio::null());
        command
    }

    pub fn run(&self, args: &[&str]) -> Ended {
        ended(self.command(args))
    }

    /// Ends without a code where it takes more processor time than so many seconds; a busy machine makes no
    /// difference.
    #[cfg(unix)]
    pub fn run_within(&self, seconds: u32, args: &[&str]) -> Ended {
        let program = self.command(args);
        let mut shell = Command::new("sh");
        shell.args(["-c", &format!("ulimit -t {seconds}; exec \"$0\" \"$@\"")]);
        shell.arg(program.get_program()).args(args).current_dir(self.path()).stdin(Stdio::null());
        ended(shell)
    }

    #[cfg(not(unix))]
    pub fn run_within(&self, _seconds: u32, args: &[&str]) -> Ended {
        self.run(args)
    }

    /// All files below the folder, sorted, their paths relative to it.
    pub fn files(&self) -> Vec<String> {
        let mut files = Vec::new();
        list(self.path(), self.path(), &mut files);
        files.sort();
        files
    }

    /// Whether not even a folder was made.
    pub fn is_empty(&self) -> bool {
        std::fs::read_dir(self.path()).unwrap().next().is_none()
    }

    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path().join(name), text).unwrap();
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path().join(name)).unwrap()
    }
}

fn ended(mut command: Command) -> Ended {
    let output = command.output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Ended { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
}

fn list(root: &Path, folder: &Path, files: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            list(root, &path, files);
        } else {
            files.push(path.strip_prefix(root).unwrap().to_str().unwrap().to_string());
        }
    }
}

/// Runs on an empty desk.
pub fn run(args: &[&str]) -> Ended {
    Desk::new().run(args)
}

/// The standard output of a run that must end well and say nothing on standard error.
pub fn stdout(args: &[&str]) -> String {
    let ended = run(args);
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""), "{args:?}");
    ended.stdout
}

/// The same, as JSON.
pub fn json(args: &[&str]) -> Value {
    serde_json::from_str(&stdout(&[args, &["--format", "json"]].concat())).unwrap()
}

/// `text` split at white space, and `more` behind it.
pub fn words<'a>(text: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    text.split_whitespace().chain(more.iter().copied()).collect()
}

/// The keys of a JSON object, in order.
pub fn keys(object: &Value) -> Vec<&str> {
    object.as_object().unwrap().keys().map(String::as_str).collect()
}

/// A terminal of its own, on which the command's standard output is; so many columns wide, where it says.
#[cfg(unix)]
pub fn at_a_terminal(line: &str, columns: Option<usize>, variables: &[(&str, &str)]) -> String {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    use std::io::Read;
    let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&master).and_then(|()| unlockpt(&master)).unwrap();
    let name = ptsname(&master, Vec::new()).unwrap().into_string().unwrap();
    let desk = Desk::new();
    let terminal = std::fs::OpenOptions::new().write(true).open(&name).unwrap();
    if let Some(columns) = columns {
        let set =
            Command::new("stty").args(["-F", &name, "cols", &columns.to_string(), "rows", "40"]).status();
        assert!(set.unwrap().success());
    }
    let mut command = desk.command(&words(line, &[]));
    command.env_remove("NO_COLOR").env("TERM", "xterm").envs(variables.iter().copied());
    assert!(command.stdout(terminal).status().unwrap().success());
    // The terminal must be closed on our side: then its reader comes to an end, which Linux tells by an
    // error.
    drop(command);
    let (mut shown, mut screen) = (Vec::new(), std::fs::File::from(master));
    let _ = screen.read_to_end(&mut shown);
    String::from_utf8(shown).unwrap()
}
