//! Files that appear whole or not at all.

use std::ffi::OsString;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use kickdrift::error::{Error, Kind};
use kickdrift::report::file::{write_output, write_with};

fn names(folder: &Path) -> Vec<OsString> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect()
}

#[test]
fn a_file_is_written_and_replaced_and_nothing_else_is_left() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.csv");
    for text in ["first", "a second, longer one", "third"] {
        write_output(Some(&path), text.as_bytes()).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), text);
    }
    assert_eq!(names(folder.path()), ["table.csv"]);
}

#[test]
fn content_that_fails_leaves_the_old_file_and_no_fragment() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.svg");
    write_output(Some(&path), b"old").unwrap();
    let failed = write_with(Some(&path), |sink| {
        sink.write_all(&[b'x'; 100_000]).map_err(Error::stream)?;
        Err(Error::stream(ErrorKind::StorageFull.into()))
    });
    assert_eq!(failed.unwrap_err().kind(), Kind::Io);
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    assert_eq!(names(folder.path()), ["map.svg"]);
}

#[test]
fn an_unwritable_place_is_named_with_a_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let missing = write_output(Some(&folder.path().join("no/such/file")), b"x").unwrap_err().to_string();
    assert!(missing.contains("no/such/file") && missing.contains("make it first"), "{missing}");
    let directory = write_output(Some(folder.path()), b"x").unwrap_err().to_string();
    assert!(directory.contains("name a file in it"), "{directory}");
    assert!(names(folder.path()).is_empty());
}

#[cfg(unix)]
#[test]
fn a_link_and_the_permissions_of_the_old_file_survive() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = tempfile::tempdir().unwrap();
    let (real, link) = (folder.path().join("real"), folder.path().join("link"));
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
