//! Files read up to a size: a device without an end is no input.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// The longest document or engine's input, in bytes: the reader of XML takes 4 GiB, and JSON takes ten times
/// its size in memory.
pub const LONGEST: u64 = 1 << 30;

/// Bytes that are read before they are looked at.
const AT_ONCE: u64 = 1 << 16;

/// The text of a file, or of a pipe, of at most so many bytes.
///
/// # Errors
/// Those of the file; more bytes; a zero byte, which no text holds but devices and binary files do; bytes
/// that are not UTF-8.
pub fn text(path: &Path, most: u64) -> io::Result<String> {
    let bytes = characters(path, most)?;
    String::from_utf8(bytes).map_err(|_| io::Error::new(ErrorKind::InvalidData, "it is not UTF-8"))
}

/// The same, or else in Latin-1: letters in comments are then not those meant, which matters to no engine.
///
/// # Errors
/// Those of the file; more bytes; a zero byte.
pub fn any_text(path: &Path, most: u64) -> io::Result<String> {
    let latin = |bytes: Vec<u8>| bytes.into_iter().map(char::from).collect();
    Ok(String::from_utf8(characters(path, most)?).unwrap_or_else(|error| latin(error.into_bytes())))
}

/// The bytes of a text, read to the first zero byte at most.
fn characters(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let (mut file, mut bytes) = (File::open(path)?.take(most + 1), Vec::new());
    while file.by_ref().take(AT_ONCE).read_to_end(&mut bytes)? > 0 {
        if bytes[bytes.len().saturating_sub(AT_ONCE as usize)..].contains(&0) {
            return Err(io::Error::new(ErrorKind::InvalidData, "it holds a zero byte: it is no text"));
        }
    }
    bounded(bytes.len(), most)?;
    Ok(bytes)
}

/// The bytes of a regular file of at most so many.
///
/// # Errors
/// As [`open`]; more bytes.
pub fn bytes(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(path)?.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    bounded(bytes.len(), most)?;
    Ok(bytes)
}

/// A regular file, open: a device need not end, and opening a pipe waits for who writes to it.
///
/// # Errors
/// Those of the file, and anything but a regular one.
pub fn open(path: &Path) -> io::Result<File> {
    let regular = |is_file: bool| {
        let refused = || io::Error::new(ErrorKind::InvalidInput, "it is no regular file");
        is_file.then_some(()).ok_or_else(refused)
    };
    regular(fs::metadata(path)?.is_file())?;
    let file = File::open(path)?;
    // Another one may stand there since.
    regular(file.metadata()?.is_file())?;
    Ok(file)
}

fn bounded(length: usize, most: u64) -> io::Result<()> {
    if length as u64 <= most {
        return Ok(());
    }
    let size = if most < 1 << 20 { format!("{most} bytes") } else { format!("{} MiB", most >> 20) };
    Err(io::Error::new(ErrorKind::FileTooLarge, format!("it has more than {size}")))
}
