//! Files that appear whole or not at all.
//!
//! The bytes go to a temporary file in the *same directory* (a rename across file systems would be a copy),
//! are flushed to the disk, and only then take the final name in one step. Whoever looks at that name sees
//! the old content or the new one, never a half.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// Writes `bytes` to `path`, or to standard output where there is no path.
///
/// # Errors
/// [`Kind::Io`](crate::error::Kind::Io) naming the path and a remedy. A closed pipe on standard output is not an
/// error: the reader has had what it wanted.
pub fn write_output(path: Option<&Path>, bytes: &[u8]) -> Result<()> {
    write_with(path, |sink| sink.write_all(bytes))
}

/// As [`write_output`], for content that is produced piece by piece.
///
/// `content` writes to a buffered sink; when it fails, no file appears.
///
/// # Errors
/// As [`write_output`].
pub fn write_with(path: Option<&Path>, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    match path {
        None => to_stdout(content),
        Some(path) => to_path(path, content).map_err(|cause| explained(path, cause)),
    }
}

/// As [`write_with`], for content that may fail by itself: the outer error is its own and comes back as it is, the
/// inner one is the sink's.
///
/// # Errors
/// Those of the content, and as [`write_output`].
pub fn write_or_stop(
    path: Option<&Path>,
    content: impl FnOnce(&mut dyn Write) -> Result<io::Result<()>>,
) -> Result<()> {
    let mut stopped = None;
    let written = write_with(path, |sink| {
        content(sink).unwrap_or_else(|error| {
            stopped = Some(error);
            Err(io::Error::other("the content was not finished"))
        })
    });
    stopped.map_or(written, Err)
}

fn to_stdout(content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    let mut sink = BufWriter::new(io::stdout().lock());
    match content(&mut sink).and_then(|()| sink.flush()) {
        Err(cause) if cause.kind() != ErrorKind::BrokenPipe => {
            Err(Error::io("standard output", &cause).caused_by(cause))
        }
        _ => {
            // What the buffer still holds has no reader; dropping it must not try again.
            drop(sink.into_parts());
            Ok(())
        }
    }
}

fn to_path(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    // A link keeps pointing where it points: the file behind it is what gets replaced.
    let target = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let old = fs::metadata(&target).ok();
    if let Some(old) = &old
        && !old.is_file()
    {
        // A device or a pipe cannot be renamed over; a directory fails right here.
        let mut sink = BufWriter::new(OpenOptions::new().write(true).open(&target)?);
        return content(&mut sink).and_then(|()| sink.flush());
    }
    let (temporary, file) = Temporary::beside(&target)?;
    let mut sink = BufWriter::new(file);
    content(&mut sink)?;
    let file = sink.into_inner().map_err(io::IntoInnerError::into_error)?;
    if let Some(old) = old {
        file.set_permissions(old.permissions())?;
    }
    file.sync_all()?;
    drop(file);
    temporary.take_name(&target)
}

/// A temporary file that is removed again unless it takes its final name.
pub(super) struct Temporary(Option<PathBuf>);

impl Temporary {
    /// A new file in the directory of `target`, under a name that nobody else has.
    pub(super) fn beside(target: &Path) -> io::Result<(Self, File)> {
        let name = target.file_name().ok_or(ErrorKind::IsADirectory)?;
        for attempt in 0..1000 {
            let mut hidden = OsString::from(".");
            hidden.push(name);
            hidden.push(format!(".{}-{attempt}.part", std::process::id()));
            let path = target.with_file_name(hidden);
            match OpenOptions::new().read(true).write(true).create_new(true).open(&path) {
                Err(cause) if cause.kind() == ErrorKind::AlreadyExists => continue,
                file => return Ok((Temporary(Some(path)), file?)),
            }
        }
        Err(ErrorKind::AlreadyExists.into())
    }

    fn take_name(mut self, target: &Path) -> io::Result<()> {
        if let Some(path) = &self.0 {
            fs::rename(path, target)?;
        }
        self.0 = None;
        Ok(())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if let Some(path) = &self.0 {
            // The error that brought us here is the one to report, not this one.
            let _ = fs::remove_file(path);
        }
    }
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
    /// [`Kind::Io`](crate::error::Kind::Io) naming the path and a remedy.
    pub fn make(path: &Path) -> Result<Self> {
        let missing = |part: &&Path| !part.as_os_str().is_empty() && !part.exists();
        let made = path.ancestors().take_while(missing).map(Path::to_path_buf).collect();
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
        self.made.clear();
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        for path in &self.made {
            // Only an empty folder goes; the error that brought us here is the one to report.
            let _ = fs::remove_dir(path);
        }
    }
}

/// The cause with a remedy beside it.
pub(super) fn explained(path: &Path, cause: io::Error) -> Error {
    let remedy = match cause.kind() {
        ErrorKind::NotFound => "create the directory first, or name another file",
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "name a file in a directory you may write to"
        }
        ErrorKind::IsADirectory => "this is a directory: name a file in it",
        ErrorKind::NotADirectory => "a part of this path is a file: name another path",
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => "make room, or name a file on another disk",
        _ => "name another file",
    };
    Error::io(path.display(), format!("cannot write ({cause}): {remedy}")).caused_by(cause)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Kind;

    /// A fresh directory that goes away with its owner.
    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("kickdrift-{name}-{}", std::process::id()));
            fs::create_dir_all(&path).unwrap();
            Folder(path)
        }

        fn names(&self) -> Vec<OsString> {
            fs::read_dir(&self.0).unwrap().map(|entry| entry.unwrap().file_name()).collect()
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            fs::remove_dir_all(&self.0).unwrap();
        }
    }

    #[test]
    fn a_file_is_written_and_replaced_and_nothing_else_is_left() {
        let folder = Folder::new("replaced");
        let path = folder.0.join("table.csv");
        for text in ["first", "a second, longer one", "third"] {
            write_output(Some(&path), text.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
        }
        assert_eq!(folder.names(), ["table.csv"]);
    }

    #[test]
    fn content_that_fails_leaves_the_old_file_and_no_fragment() {
        let folder = Folder::new("fails");
        let path = folder.0.join("map.svg");
        write_output(Some(&path), b"old").unwrap();
        let failed = write_with(Some(&path), |sink| {
            sink.write_all(&[b'x'; 100_000])?;
            Err(ErrorKind::StorageFull.into())
        });
        assert_eq!(failed.unwrap_err().kind(), Kind::Io);
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(folder.names(), ["map.svg"]);
    }

    #[test]
    fn an_unwritable_place_is_named_with_a_remedy() {
        let folder = Folder::new("unwritable");
        let missing = write_output(Some(&folder.0.join("no/such/file")), b"x").unwrap_err().to_string();
        assert!(missing.contains("no/such/file") && missing.contains("create the directory"), "{missing}");
        let directory = write_output(Some(&folder.0), b"x").unwrap_err().to_string();
        assert!(directory.contains("name a file in it"), "{directory}");
        assert!(folder.names().is_empty());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_and_the_permissions_of_the_old_file_survive() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = Folder::new("link");
        let (real, link) = (folder.0.join("real"), folder.0.join("link"));
        write_output(Some(&real), b"old").unwrap();
        fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&real, &link).unwrap();
        write_output(Some(&link), b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&real).unwrap(), "new");
        assert_eq!(fs::metadata(&real).unwrap().permissions().mode() & 0o777, 0o640);
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_written_through() {
        write_output(Some(Path::new("/dev/null")), b"gone").unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
}
