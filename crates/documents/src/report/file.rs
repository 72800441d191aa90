//! Files that appear whole or not at all.
//!
//! The bytes go to a temporary file in the *same directory* (a rename across file systems would be a copy),
//! are flushed to the disk, and only then take the final name in one step. Whoever looks at that name sees
//! the old content or the new one, never a half.
//!
//! A temporary file is called `.NAME.PID-N.part` and is locked as long as it is open. What a process leaves
//! behind that is ended by a signal it can catch, it removes by itself, see [`abandon`]; what another one
//! left is known by its missing lock, and the next process that writes to the directory removes it.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use number::{Error, Result};

/// Writes `bytes` to `path`, or to standard output where there is no path.
///
/// # Errors
/// [`Kind::Io`](number::error::Kind::Io) naming the path and a remedy. A closed pipe on standard output is
/// not an error: the reader has had what it wanted.
pub fn write_output(path: Option<&Path>, bytes: &[u8]) -> Result<()> {
    write_with(path, |sink| sink.write_all(bytes).map_err(Error::stream))
}

/// As [`write_output`], for content that is produced piece by piece.
///
/// `content` writes to a buffered sink; when it fails, no file appears.
///
/// # Errors
/// Those of the content as they are, and those of the sink, which the content hands on by [`Error::stream`],
/// as [`write_output`].
pub fn write_with(path: Option<&Path>, content: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    match path {
        None => to_stdout(content),
        Some(path) => to_path(path, content).map_err(|error| explained(path, error)),
    }
}

/// Whether what is written to standard output is lost, though nobody says so.
static IS_STDOUT_CLOSED: AtomicBool = AtomicBool::new(false);

/// From now on what would go to standard output is an error: the process was started without it.
pub fn stdout_is_closed() {
    IS_STDOUT_CLOSED.store(true, Ordering::Relaxed);
}

/// That standard output is there. Rust takes what is written to a closed one for written.
fn stdout_is_open() -> io::Result<()> {
    if IS_STDOUT_CLOSED.load(Ordering::Relaxed) {
        return Err(io::Error::new(ErrorKind::NotConnected, "it is closed"));
    }
    #[cfg(unix)]
    {
        use std::os::fd::AsFd;
        io::stdout().as_fd().try_clone_to_owned()?;
    }
    Ok(())
}

fn to_stdout(content: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    stdout_is_open().map_err(|cause| {
        let text = format!("cannot write ({cause}): name a file with --output, or leave it open");
        Error::io("standard output", text).caused_by(cause)
    })?;
    let mut sink = BufWriter::new(io::stdout().lock());
    let written = content(&mut sink).and_then(|()| sink.flush().map_err(Error::stream));
    // The rest of the buffer has no reader, or belongs to a failed write; dropping it must not try again.
    drop(sink.into_parts());
    match written {
        Err(error) if error.lost_stream().is_some_and(|cause| cause.kind() == ErrorKind::BrokenPipe) => {
            Ok(())
        }
        Err(error) if error.lost_stream().is_some() => Err(error.at("standard output")),
        other => other,
    }
}

fn to_path(path: &Path, content: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    // A link keeps pointing where it points: the file behind it is what gets replaced.
    let target = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let old = fs::metadata(&target).ok();
    if let Some(old) = &old
        && !old.is_file()
    {
        // A device or a pipe cannot be renamed over; a directory fails right here.
        let file = OpenOptions::new().write(true).open(&target).map_err(Error::stream)?;
        let mut sink = BufWriter::new(file);
        return content(&mut sink).and_then(|()| sink.flush().map_err(Error::stream));
    }
    replaceable(&target)?;
    let (temporary, file) = Temporary::beside(&target).map_err(Error::stream)?;
    let mut sink = BufWriter::new(file);
    content(&mut sink)?;
    let finish = || {
        let file = sink.into_inner().map_err(io::IntoInnerError::into_error)?;
        if let Some(old) = old {
            file.set_permissions(permissions(&old))?;
        }
        file.sync_all()?;
        // The file is open, and so locked, until it has its name.
        temporary.take_name(&target)
    };
    finish().map_err(Error::stream)
}

/// Who may read and write a file that replaces an old one: those who could, but nobody runs what is new as
/// the owner or the group of what was old.
fn permissions(old: &fs::Metadata) -> fs::Permissions {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::Permissions::from_mode(old.permissions().mode() & 0o777)
    }
    #[cfg(not(unix))]
    old.permissions()
}

/// Checks that a file may be replaced, if there is one: a rename alone would ignore its write protection.
///
/// # Errors
/// [`Kind::Io`](number::error::Kind::Io) naming a file that is read-only, for all or for this process.
fn replaceable(path: &Path) -> Result<()> {
    let old = fs::metadata(path).ok().filter(fs::Metadata::is_file);
    let Some(old) = old else { return Ok(()) };
    let opened = if old.permissions().readonly() {
        Err(ErrorKind::PermissionDenied.into())
    } else {
        OpenOptions::new().write(true).open(path).map(drop)
    };
    opened.map_err(|cause| {
        let text =
            format!("is not replaced, being read-only ({cause}): name another file, or make it writable");
        Error::io(path.display(), text).caused_by(cause)
    })
}

/// That a file can be made where there is none, and else that it may be replaced: asked before the work.
///
/// # Errors
/// [`Kind::Io`](number::error::Kind::Io) naming a file that is read-only, a directory, or a path in no
/// folder.
pub fn writable(path: &Path) -> Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let cause = if path.is_dir() {
        ErrorKind::IsADirectory
    } else if folder.is_some_and(|folder| !folder.exists()) {
        ErrorKind::NotFound
    } else {
        return replaceable(path);
    };
    Err(explained(path, Error::stream(cause.into())))
}

/// The files and folders of this process that are not finished, those within others behind them.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes the files and folders that are not finished, then calls `end`, which is to end the process:
/// meanwhile no file begins and none takes its name. For whoever has caught a signal.
pub fn abandon(end: impl FnOnce()) {
    let unfinished = unfinished();
    for path in unfinished.iter().rev() {
        // It is one of the two, and there is nobody left to report an error to.
        let _ = fs::remove_file(path).or_else(|_| fs::remove_dir(path));
    }
    end();
}

/// A file that its owner alone may read, among temporary ones, with an end such as `.html`. It goes when a
/// signal ends this process; what is in it is worth nothing after that.
///
/// # Errors
/// Those of the file.
pub fn private(end: &str, bytes: &[u8]) -> io::Result<PathBuf> {
    let mut options = OpenOptions::new();
    // A link that waits there is not followed.
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    let mut unfinished = unfinished();
    for attempt in 0..1000 {
        let path = std::env::temp_dir().join(format!("kickdrift-{}-{attempt}{end}", std::process::id()));
        let mut file = match options.open(&path) {
            Err(cause) if cause.kind() == ErrorKind::AlreadyExists => continue,
            file => file?,
        };
        unfinished.push(path.clone());
        return file.write_all(bytes).map(|()| path);
    }
    Err(ErrorKind::AlreadyExists.into())
}

/// A temporary file that is removed again unless it takes its final name.
pub(super) struct Temporary(PathBuf);

impl Temporary {
    /// A new file in the directory of `target`, under a name that nobody else has.
    pub(super) fn beside(target: &Path) -> io::Result<(Self, File)> {
        let name = target.file_name().ok_or(ErrorKind::IsADirectory)?;
        sweep(target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new(".")));
        let mut unfinished = unfinished();
        for attempt in 0..1000 {
            let mut hidden = OsString::from(".");
            hidden.push(name);
            hidden.push(format!(".{}-{attempt}.part", std::process::id()));
            let path = target.with_file_name(hidden);
            let file = match OpenOptions::new().read(true).write(true).create_new(true).open(&path) {
                Err(cause) if cause.kind() == ErrorKind::AlreadyExists => continue,
                file => file?,
            };
            // Another process's sweep may have come between, which has the lock or has removed the file.
            if matches!(file.try_lock(), Err(TryLockError::WouldBlock)) || !path.exists() {
                continue;
            }
            unfinished.push(path.clone());
            return Ok((Temporary(path), file));
        }
        Err(ErrorKind::AlreadyExists.into())
    }

    fn take_name(self, target: &Path) -> io::Result<()> {
        let _unfinished = unfinished();
        fs::rename(&self.0, target)
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // It has its name by now, or the error that brought us here is the one to report.
        let _ = fs::remove_file(&self.0);
        unfinished().retain(|path| *path != self.0);
    }
}

/// Removes the temporary files of processes that are no more from a folder.
fn sweep(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        // Whatever cannot be opened, locked or removed is somebody else's.
        if is_temporary(&entry.file_name())
            && let Ok(file) = File::open(entry.path())
            && file.try_lock().is_ok()
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Whether a file's name is `.NAME.PID-N.part`.
fn is_temporary(name: &OsStr) -> bool {
    let hidden = name.to_str().and_then(|name| name.strip_prefix('.')?.strip_suffix(".part"));
    let numbers = hidden.and_then(|name| name.rsplit_once('.')?.1.split_once('-'));
    numbers.is_some_and(|(pid, n)| pid.parse::<u32>().is_ok() && n.parse::<u32>().is_ok())
}

/// A folder for files to come; what of it was not there before goes again unless it is kept.
pub struct Folder {
    path: PathBuf,
    /// The folders made for it, the innermost first.
    made: Vec<PathBuf>,
}

impl Folder {
    /// Makes the folder and those around it, where they are missing.
    ///
    /// # Errors
    /// [`Kind::Io`](number::error::Kind::Io) naming the path and a remedy.
    pub fn make(path: &Path) -> Result<Self> {
        let missing = |part: &&Path| !part.as_os_str().is_empty() && !part.exists();
        let made: Vec<_> = path.ancestors().take_while(missing).map(Path::to_path_buf).collect();
        unfinished().extend(made.iter().rev().cloned());
        let folder = Folder { path: path.to_path_buf(), made };
        fs::create_dir_all(path).map_err(|cause| {
            let text = format!("cannot make this folder ({cause}): name another one");
            Error::io(path.display(), text).caused_by(cause)
        })?;
        Ok(folder)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Leaves it where it is.
    pub fn keep(mut self) {
        let made = std::mem::take(&mut self.made);
        unfinished().retain(|path| !made.contains(path));
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        for path in &self.made {
            // Only an empty folder goes; the error that brought us here is the one to report.
            let _ = fs::remove_dir(path);
        }
        unfinished().retain(|path| !self.made.contains(path));
    }
}

/// An error of a stream that goes to this path, with the path and a remedy; any other error as it is.
pub(super) fn explained(path: &Path, error: Error) -> Error {
    let Some(cause) = error.lost_stream() else { return error };
    let remedy = match cause.kind() {
        ErrorKind::NotFound => {
            let folder = path.parent().unwrap_or(Path::new("")).display();
            let text = format!("there is no folder {folder}: make it first, or name another file");
            return error.at(path.display()).or(text);
        }
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "name a file in a directory you may write to"
        }
        ErrorKind::IsADirectory => "this is a directory: name a file in it",
        ErrorKind::NotADirectory => "a part of this path is a file: name another path",
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => "make room, or name a file on another disk",
        _ => "name another file",
    };
    let text = format!("cannot write ({cause}): {remedy}");
    error.at(path.display()).or(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_in_the_making_is_left_alone_and_what_a_dead_process_left_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        for (name, stale) in [(".a.npz.4194305-0.part", true), (".a.part", false), ("a.1-0.part", false)] {
            fs::write(folder.path().join(name), "x").unwrap();
            let (temporary, _file) = Temporary::beside(&folder.path().join("b")).unwrap();
            let (_other, _second) = Temporary::beside(&folder.path().join("b")).unwrap();
            assert!(temporary.0.exists());
            assert_eq!(folder.path().join(name).exists(), !stale, "{name}");
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }
}
