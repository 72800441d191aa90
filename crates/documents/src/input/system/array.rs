//! Arrays by reference: NumPy's `.npy` files, the members of `.npz` archives, and Matrix Market's files (see
//! `market`).
//!
//! A `.npy` file is the magic bytes, a header that is a Python dictionary, and the elements in C order (or
//! Fortran's).

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::DMatrix;
use serde::Deserialize;
use serde_json::{Map, Value};

use super::market;
use super::part::Part;
use crate::report::shape::Shape;
use number::error::room;
use number::{Error, Result, file};

/// The most elements read: 16,384 x 16,384, or the entries of 30,000 waters within 0.9 nm of each other.
const MOST_ELEMENTS: usize = 1 << 28;

/// The longest header of a `.npy` file, in bytes; NumPy's own have some hundred.
const LONGEST_HEADER: usize = 1 << 16;

/// The bytes that an element takes while it is read: as it stands, as a double, in the other order, and kept
/// for who reads it again.
const BYTES_AN_ELEMENT: u128 = 32;

/// `{"npy": "h.npy"}`, `{"npz": "data.npz", "array": "fast"}`, `{"mm": "k.mtx"}` or, of a sparse stiffness,
/// `{"npz": "k.npz", "csr": ""}`; paths are relative to the file that holds them.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq, PartialOrd, Ord)]
#[serde(try_from = "Value")]
pub(crate) enum Reference {
    Npy {
        npy: String,
    },
    Npz {
        npz: String,
        array: String,
    },
    Mm {
        mm: String,
    },
    /// Compressed rows, by the name of their three arrays (see `sparse`).
    Csr {
        npz: String,
        csr: String,
    },
}

impl Part for Reference {
    const SHAPE: Shape = Shape::Named(
        "reference",
        r#"{
            "description": "An array of NumPy's or a matrix of Matrix Market's, by the name of its file, relative to the folder of this one; csr: a sparse matrix by compressed rows, CSR.data, CSR.indices and CSR.indptr, or without a name those of scipy.sparse.save_npz.",
            "type": "object",
            "additionalProperties": {"type": "string"},
            "oneOf": [
                {"required": ["npy"], "properties": {"npy": true}, "additionalProperties": false},
                {"required": ["mm"], "properties": {"mm": true}, "additionalProperties": false},
                {"required": ["npz", "array"], "properties": {"npz": true, "array": true}, "additionalProperties": false},
                {"required": ["npz", "csr"], "properties": {"npz": true, "csr": true}, "additionalProperties": false}
            ]
        }"#,
    );
}

impl TryFrom<Value> for Reference {
    type Error = String;

    fn try_from(value: Value) -> std::result::Result<Self, String> {
        let text = |key: &str| value.get(key).and_then(Value::as_str).map(String::from);
        let reference = match value.as_object().map_or(0, Map::len) {
            1 => text("npy").map(|npy| Reference::Npy { npy }).or(text("mm").map(|mm| Reference::Mm { mm })),
            2 => text("npz").and_then(|npz| {
                let array = text("array").map(|array| Reference::Npz { npz: npz.clone(), array });
                array.or(text("csr").map(|csr| Reference::Csr { npz, csr }))
            }),
            _ => None,
        };
        reference.ok_or_else(|| {
            format!(
                "{value} names no array: write {{\"npy\": \"h.npy\"}}, {{\"npz\": \"h.npz\", \"array\": \"fast\"}} or {{\"mm\": \"h.mtx\"}}"
            )
        })
    }
}

/// The elements as doubles, in C order.
#[derive(Clone, Debug)]
pub struct Array {
    shape: Vec<usize>,
    values: Vec<f64>,
}

/// Where the arrays are that a system refers to: in files, paths taken from a folder, or in memory by the
/// names that they have in their archive.
#[derive(Clone, Debug)]
pub enum Arrays {
    In(Folder),
    Held(Arc<BTreeMap<String, Array>>),
}

impl<P: AsRef<Path> + ?Sized> From<&P> for Arrays {
    fn from(folder: &P) -> Self {
        Arrays::In(Folder { path: folder.as_ref().into(), read: Arc::default() })
    }
}

/// A folder, and the arrays that were read from it: of one file, and of all that differ from it in some
/// number, each once.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
    read: Arc<Mutex<BTreeMap<Reference, Array>>>,
}

impl Reference {
    /// Reads the array.
    ///
    /// # Errors
    /// An I/O error; bad input by `field` where the file is no such array, where none of this name is held,
    /// and where a number is not finite.
    pub fn read(&self, field: &str, arrays: &Arrays) -> Result<Array> {
        let array = self.read_unchecked(field, arrays)?;
        match array.values.iter().position(|x| !x.is_finite()) {
            Some(at) => {
                Err(Error::input(&array.place(field, at), array.values[at], "every number must be finite"))
            }
            None => Ok(array),
        }
    }

    fn read_unchecked(&self, field: &str, arrays: &Arrays) -> Result<Array> {
        match arrays {
            Arrays::Held(held) => self.held(field, held),
            Arrays::In(folder) => {
                let mut read = folder.read.lock().unwrap_or_else(PoisonError::into_inner);
                if let Some(array) = read.get(self) {
                    return Ok(array.clone());
                }
                let array = self.in_folder(field, &folder.path)?;
                read.insert(self.clone(), array.clone());
                Ok(array)
            }
        }
    }

    fn in_folder(&self, field: &str, folder: &Path) -> Result<Array> {
        let io = |path: &Path, cause: std::io::Error| Error::io(path.display(), &cause).caused_by(cause);
        let (name, read) = match self {
            Reference::Mm { mm } => {
                let path = folder.join(mm);
                let text = file::text(&path, file::LONGEST).map_err(|cause| io(&path, cause))?;
                let read = market::parse(&text).map_err(|why| Error::input(field, mm, why));
                return read.map(|(shape, values)| Array { shape, values });
            }
            Reference::Npy { npy } => {
                let path = folder.join(npy);
                (npy.clone(), parse(&mut file::open(&path).map_err(|cause| io(&path, cause))?))
            }
            Reference::Npz { npz, array } => {
                let path = folder.join(npz);
                let file = file::open(&path).map_err(|cause| io(&path, cause))?;
                (format!("{npz}, {array}"), member(file, array))
            }
            Reference::Csr { csr, .. } => return Err(no_array(field, csr)),
        };
        read.map_err(|why| Error::input(field, name, why))
    }

    fn held(&self, field: &str, held: &BTreeMap<String, Array>) -> Result<Array> {
        let name = match self {
            Reference::Npz { array: name, .. }
            | Reference::Npy { npy: name }
            | Reference::Mm { mm: name } => name,
            Reference::Csr { csr, .. } => return Err(no_array(field, csr)),
        };
        held.get(name).cloned().ok_or_else(|| {
            let names: Vec<&str> = held.keys().map(String::as_str).collect();
            Error::input(field, name, format!("is no array given: there are {}", names.join(", ")))
        })
    }
}

fn no_array(field: &str, csr: &str) -> Error {
    Error::input(field, csr, "names compressed rows, as stiffnesses alone have: give one array")
}

type Told<T> = std::result::Result<T, String>;

fn member(file: File, name: &str) -> Told<Array> {
    let mut archive = zip::ZipArchive::new(file).map_err(|cause| format!("is no .npz archive ({cause})"))?;
    let names: Vec<String> = archive
        .file_names()
        .filter_map(|name| Some(name.ok()?.trim_end_matches(".npy").to_string()))
        .collect();
    let missing = |_| format!("holds no array {name}: it has {}", names.join(", "));
    parse(&mut archive.by_name(&format!("{name}.npy")).map_err(missing)?)
}

/// What is wrong, and how to save an array.
fn bad(what: &str) -> String {
    format!("{what}: save it with numpy.save, as float64")
}

/// `N` bytes more.
fn next<const N: usize>(bytes: &mut impl Read) -> Told<[u8; N]> {
    let mut all = [0; N];
    bytes.read_exact(&mut all).map_err(|cause| bad(&format!("is no .npy file ({cause})")))?;
    Ok(all)
}

/// The array that a `.npy` file's bytes begin with, or why there is none: they are counted by the header
/// before there is room for them.
fn parse(bytes: &mut impl Read) -> Told<Array> {
    let [0x93, b'N', b'U', b'M', b'P', b'Y', version, _] = next(bytes)? else {
        return Err(bad("is no .npy file"));
    };
    let length = match version {
        1 => usize::from(u16::from_le_bytes(next(bytes)?)),
        2 | 3 => u32::from_le_bytes(next(bytes)?) as usize,
        _ => return Err(bad("is no .npy file")),
    };
    if length > LONGEST_HEADER {
        return Err(bad("its header is too long"));
    }
    let header = taken(bytes, length).ok_or_else(|| bad("its header is cut off"))?;
    let (kind, is_fortran, shape) = described(&String::from_utf8_lossy(&header))?;
    let count = shape.iter().try_fold(1usize, |n, &k| n.checked_mul(k)).filter(|&n| n <= MOST_ELEMENTS);
    // An axis may be long beside one of no length, and whoever counts along it would not end.
    let count = count.filter(|_| shape.iter().all(|&k| k <= MOST_ELEMENTS));
    let count = count.ok_or_else(|| format!("has more than {MOST_ELEMENTS} elements"))?;
    room(count as u128 * BYTES_AN_ELEMENT, "a smaller array").map_err(|error| error.to_string())?;
    let width = kind.chars().last().and_then(|digit| digit.to_digit(10)).unwrap_or(0) as usize;
    let data = taken(bytes, count * width);
    let values = data.and_then(|data| elements(&kind, &data));
    let values = values.ok_or_else(|| bad(&format!("its elements are {kind} or cut off")))?;
    Ok(Array { values: if is_fortran { c_order(&values, &shape) } else { values }, shape })
}

/// So many bytes more; `None` where there are fewer.
fn taken(bytes: &mut impl Read, count: usize) -> Option<Vec<u8>> {
    let mut all = Vec::new();
    bytes.take(count as u64).read_to_end(&mut all).ok()?;
    (all.len() == count).then_some(all)
}

/// The kind of the elements, whether the first index runs fastest, and the shape, as a header has them.
fn described(header: &str) -> Told<(String, bool, Vec<usize>)> {
    let after = |key: &str| header.split_once(key).map(|(_, rest)| rest.trim_start_matches([' ', ':']));
    let kind = after("'descr'").and_then(|rest| rest.split('\'').nth(1)).unwrap_or_default().to_string();
    let is_fortran = after("'fortran_order'").is_some_and(|rest| rest.starts_with("True"));
    let shape =
        after("'shape'").and_then(|rest| rest.strip_prefix('(')?.split_once(')')).map(|(inside, _)| inside);
    let sizes = shape
        .ok_or_else(|| bad("its header has no shape"))?
        .split(',')
        .map(str::trim)
        .filter(|s| !s.is_empty());
    let shape =
        sizes.map(|s| s.parse().map_err(|_| bad("its shape is not understood"))).collect::<Told<_>>()?;
    Ok((kind, is_fortran, shape))
}

/// Little-endian elements as doubles.
fn elements(kind: &str, data: &[u8]) -> Option<Vec<f64>> {
    fn each<const N: usize>(data: &[u8], read: impl Fn([u8; N]) -> f64) -> Vec<f64> {
        data.chunks_exact(N).map(|chunk| read(chunk.try_into().expect("N bytes"))).collect()
    }
    match kind {
        "<f8" => Some(each(data, f64::from_le_bytes)),
        "<f4" => Some(each(data, |bytes| f32::from_le_bytes(bytes).into())),
        "<i8" => Some(each(data, |bytes| i64::from_le_bytes(bytes) as f64)),
        "<i4" => Some(each(data, |bytes| i32::from_le_bytes(bytes).into())),
        _ => None,
    }
}

/// Elements whose first index runs fastest, in the order in which the last one does.
fn c_order(values: &[f64], shape: &[usize]) -> Vec<f64> {
    let place = |k: usize| {
        let (mut left, mut index) = (k, vec![0; shape.len()]);
        for (own, size) in index.iter_mut().zip(shape).rev() {
            (*own, left) = (left % size, left / size);
        }
        index.iter().zip(shape).rev().fold(0, |at, (index, size)| at * size + index)
    };
    (0..values.len()).map(|k| values[place(k)]).collect()
}

impl Array {
    /// An array of a shape, its elements in C order; the same bounds hold as for one in a file.
    ///
    /// # Errors
    /// Another number of elements than the shape says, or too many.
    pub fn new(shape: Vec<usize>, values: Vec<f64>) -> Result<Array> {
        let count = shape.iter().try_fold(1usize, |n, &k| n.checked_mul(k));
        if shape.iter().chain([&values.len()]).any(|&k| k > MOST_ELEMENTS) || count != Some(values.len()) {
            let remedy = format!("give as many elements as the shape says, {MOST_ELEMENTS} at most");
            return Err(Error::input(
                "array",
                format!("{} elements of shape {shape:?}", values.len()),
                remedy,
            ));
        }
        Ok(Array { shape, values })
    }

    /// The name of an element, `fast[3, 4]`; of three coordinates or one mass each the atom.
    fn place(&self, field: &str, at: usize) -> String {
        match (field, &*self.shape) {
            ("positions", _) => format!("positions of atom {} (from 0), {}", at / 3, ["x", "y", "z"][at % 3]),
            (_, [_, columns]) => format!("{field}[{}, {}]", at / columns, at % columns),
            _ => format!("{field}[{at}]"),
        }
    }

    /// As a matrix.
    ///
    /// # Errors
    /// Names the shape where it is not of two axes.
    pub fn matrix(self, field: &str) -> Result<DMatrix<f64>> {
        match *self.shape {
            [rows, columns] => Ok(DMatrix::from_row_slice(rows, columns, &self.values)),
            _ => Err(Error::input(
                field,
                format!("shape {:?}", self.shape),
                "give a matrix, an array of two axes",
            )),
        }
    }

    /// As matrices of one size, one after the other.
    ///
    /// # Errors
    /// Names the shape where it is not of three axes.
    pub fn matrices(self, field: &str) -> Result<Vec<DMatrix<f64>>> {
        let [_, rows, columns] = *self.shape else {
            let remedy = "give a matrix for each kick of half a period, an array of three axes";
            return Err(Error::input(field, format!("shape {:?}", self.shape), remedy));
        };
        let all = self.values.chunks_exact((rows * columns).max(1));
        Ok(all.map(|values| DMatrix::from_row_slice(rows, columns, values)).collect())
    }

    /// The diagonal of a square matrix, all elements of any other array.
    ///
    /// # Errors
    /// A square matrix that is not diagonal.
    pub fn into_diagonal(self, field: &str) -> Result<Vec<f64>> {
        let n = match *self.shape {
            [rows, columns] if rows == columns => rows,
            _ => return Ok(self.values),
        };
        match (0..n * n).find(|k| k / n != k % n && self.values[*k] != 0.0) {
            Some(k) => {
                let remedy = "beside a stiffness from a file a mass matrix is diagonal: lump it, or write both in the file by their numbers";
                Err(Error::input(&self.place(field, k), self.values[k], remedy))
            }
            None => Ok(self.values.into_iter().step_by(n + 1).collect()),
        }
    }

    /// All elements, by rows.
    pub fn into_values(self) -> Vec<f64> {
        self.values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(header: &str, data: &[f64]) -> Vec<u8> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        data.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes
    }

    #[test]
    fn matrices_are_read_in_either_order_and_bad_files_refused() {
        let data = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let header =
            |order: &str| format!("{{'descr': '<f8', 'fortran_order': {order}, 'shape': (2, 3), }}\n");
        let rows = parse(&mut &*file(&header("False"), &data)).unwrap().matrix("k").unwrap();
        assert_eq!((rows[(0, 2)], rows[(1, 0)]), (3.0, 4.0));
        let columns = parse(&mut &*file(&header("True"), &data)).unwrap().matrix("k").unwrap();
        assert_eq!((columns[(0, 2)], columns[(1, 0)]), (5.0, 2.0));
        // Two matrices of one row each.
        let three =
            |order: &str| format!("{{'descr': '<f8', 'fortran_order': {order}, 'shape': (2, 1, 3), }}\n");
        let of = |order: &str| parse(&mut &*file(&three(order), &data)).unwrap().matrices("k").unwrap();
        let [last, first] = [of("False"), of("True")];
        assert_eq!((last[0][(0, 1)], last[1][(0, 0)], last[1][(0, 2)]), (2.0, 4.0, 6.0));
        assert_eq!((first[0][(0, 1)], first[1][(0, 0)], first[1][(0, 2)]), (3.0, 2.0, 6.0));
        assert_eq!(
            parse(&mut &*file(&header("True"), &data)).unwrap().matrices("k").unwrap_err().field(),
            "k"
        );
        assert!(parse(&mut &*file(&header("False"), &data[..5])).is_err());
        assert!(parse(&mut &b"not an array"[..]).is_err());
        let held = |shape: &[usize]| Array::new(shape.to_vec(), data.to_vec());
        assert_eq!(held(&[2, 3]).unwrap().matrix("k").unwrap(), rows);
        assert!(held(&[2, 2]).is_err() && held(&[usize::MAX, 2]).is_err());
        assert!(
            parse(&mut &*file("{'descr': '<c16', 'fortran_order': False, 'shape': (1,), }", &data)).is_err()
        );
    }

    /// Sizes of nothing: rows would be counted one after the other, and a header has no elements behind it.
    #[test]
    fn an_array_is_as_large_as_its_elements_whatever_its_header_says() {
        for shape in [
            "(18446744073709551615, 0)",
            "(0, 18446744073709551615)",
            "(268435457,)",
            "(4294967296, 4294967296)",
        ] {
            let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
            assert!(parse(&mut &*file(&header, &[])).unwrap_err().contains("more than"), "{shape}");
        }
        let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (16384, 16384), }\n";
        assert!(parse(&mut &*file(header, &[1.0; 8])).unwrap_err().contains("cut off"));
        let long = [b"\x93NUMPY\x02\x00".to_vec(), u32::MAX.to_le_bytes().to_vec()].concat();
        assert!(
            parse(&mut (&*long).chain(std::io::repeat(b' '))).unwrap_err().contains("header is too long")
        );
        assert!(Array::new(vec![usize::MAX, 0], Vec::new()).is_err());
    }
}
