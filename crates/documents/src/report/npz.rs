//! NumPy's `.npz`: arrays that grow piece by piece, each in a temporary file beside the output, then joined
//! into a zip archive and deflated there. Memory does not grow with their size.
//!
//! An array is a `.npy` file of format 1.0: the magic bytes, a header that is a Python dictionary padded to a
//! multiple of 64 bytes, and the elements in C order, little-endian.

use std::fs::File;
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::file::{Temporary, explained, write_with};
use number::{Error, Result};

/// Few distinct values in long runs: the least effort does.
const LEVEL: i64 = 1;

/// The type of an array's elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    U8,
    I64,
    F64,
    /// Bytes of a text, filled up with zeros to this length.
    Text(usize),
}

impl Element {
    fn descr(self) -> String {
        match self {
            Element::U8 => "|u1".into(),
            Element::I64 => "<i8".into(),
            Element::F64 => "<f8".into(),
            Element::Text(length) => format!("|S{length}"),
        }
    }
}

/// An array under construction.
pub struct Array {
    name: &'static str,
    file: BufWriter<File>,
    path: PathBuf,
    /// Removes the file in the end.
    _temporary: Temporary,
}

impl Array {
    /// An array `name` for an archive at `archive`, without its elements.
    ///
    /// # Errors
    /// An I/O error that names the archive.
    pub fn new(archive: &Path, name: &'static str, element: Element, shape: &[usize]) -> Result<Array> {
        let open = || {
            let (temporary, file) = Temporary::beside(archive)?;
            let mut file = BufWriter::new(file);
            file.write_all(&header(element, shape))?;
            Ok(Array { name, file, path: archive.to_owned(), _temporary: temporary })
        };
        open().map_err(|cause: io::Error| explained(archive, Error::stream(cause)))
    }

    /// Appends elements.
    ///
    /// # Errors
    /// An I/O error that names the archive.
    pub fn put(&mut self, bytes: &[u8]) -> Result<()> {
        self.file.write_all(bytes).map_err(|cause| explained(&self.path, Error::stream(cause)))
    }

    /// Appends doubles.
    ///
    /// # Errors
    /// As [`Array::put`].
    pub fn put_f64(&mut self, values: impl IntoIterator<Item = f64>) -> Result<()> {
        values.into_iter().try_for_each(|value| self.put(&value.to_le_bytes()))
    }

    /// Appends integers.
    ///
    /// # Errors
    /// As [`Array::put`].
    pub fn put_i64(&mut self, values: impl IntoIterator<Item = i64>) -> Result<()> {
        values.into_iter().try_for_each(|value| self.put(&value.to_le_bytes()))
    }

    /// Appends texts of at most `length` bytes.
    ///
    /// # Errors
    /// As [`Array::put`].
    pub fn put_texts<T: AsRef<str>>(&mut self, length: usize, texts: &[T]) -> Result<()> {
        texts.iter().try_for_each(|text| {
            let mut bytes = text.as_ref().as_bytes().to_vec();
            bytes.resize(length, 0);
            self.put(&bytes)
        })
    }

    fn archive(self, zip: &mut ZipWriter<impl Write + Seek>) -> io::Result<()> {
        // The date of the files is the earliest that a zip knows: same arrays, same bytes.
        let options = SimpleFileOptions::DEFAULT
            .compression_method(CompressionMethod::Deflated)
            .compression_level(Some(LEVEL))
            .large_file(true)
            .unix_permissions(0o644);
        zip.start_file(format!("{}.npy", self.name), options).map_err(io::Error::other)?;
        let mut file = self.file.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.rewind()?;
        io::copy(&mut file, zip).map(drop)
    }
}

/// Joins finished arrays into the archive, which appears whole or not at all.
///
/// # Errors
/// An I/O error that names the archive.
pub fn write(archive: &Path, arrays: Vec<Array>) -> Result<()> {
    write_with(Some(archive), |sink| {
        let mut zip = ZipWriter::new_stream(sink);
        let parts = arrays.into_iter().try_for_each(|array| array.archive(&mut zip));
        parts.and_then(|()| zip.finish().map(drop).map_err(io::Error::other)).map_err(Error::stream)
    })
}

/// Everything before the elements.
fn header(element: Element, shape: &[usize]) -> Vec<u8> {
    let lengths: String = shape.iter().map(|length| format!("{length},")).collect();
    let mut text =
        format!("{{'descr': '{}', 'fortran_order': False, 'shape': ({lengths}), }}", element.descr());
    // Magic bytes, version and length take 10; the last letter is a line end.
    let padding = 64 - (10 + text.len() + 1) % 64;
    text.push_str(&" ".repeat(padding % 64));
    text.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((text.len() as u16).to_le_bytes());
    bytes.extend(text.bytes());
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_end_on_a_multiple_of_64() {
        for shape in [&[7][..], &[636, 3500], &[1 << 26, 1 << 26], &[]] {
            let bytes = header(Element::F64, shape);
            assert!(bytes.len().is_multiple_of(64) && bytes.ends_with(b"\n"), "{shape:?}");
            assert_eq!(usize::from(u16::from_le_bytes([bytes[8], bytes[9]])) + 10, bytes.len());
        }
        let text = String::from_utf8_lossy(&header(Element::Text(12), &[7])[10..]).into_owned();
        assert!(text.starts_with("{'descr': '|S12', 'fortran_order': False, 'shape': (7,), }"), "{text}");
    }
}
