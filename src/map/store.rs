//! Parts of a map on disk: one file a band, written whole or not at all, so that work can stop at any moment, go
//! on later, be shared out, and be joined to the bytes of a single run.
//!
//! ```text
//!     file = "kickdrift band 2\n" fingerprint "\n" payload check
//! ```
//!
//! The fingerprint names grid and products exactly; the payload is the band in little-endian fields; the check is a
//! 64-bit FNV hash of all before it. A file that does not match in every byte of that is not there.

use std::fs;
use std::path::{Path, PathBuf};

use super::band::{Band, Counters};
use super::enclosure::Enclosure;
use super::grid::Grid;
use super::products::{Growing, Products};
use crate::error::{Error, Result};

/// The bands of one map in one directory.
#[derive(Clone, Debug)]
pub struct Store {
    directory: PathBuf,
    header: String,
}

impl Store {
    /// The store of this map, in a directory that is made where there is none.
    ///
    /// # Errors
    /// An I/O error that names the directory.
    pub fn open(directory: &Path, grid: &Grid, products: Products) -> Result<Store> {
        fs::create_dir_all(directory).map_err(|cause| {
            let text = format!("cannot make this directory ({cause}): name another one");
            Error::io(directory.display(), text).caused_by(cause)
        })?;
        let header = format!("kickdrift band 2\n{}; {products:?}\n", grid.fingerprint());
        Ok(Store { directory: directory.to_owned(), header })
    }

    fn path(&self, n: u64) -> PathBuf {
        self.directory.join(format!("band-{n:08}"))
    }

    /// Band n, if it is here, whole, and of this map.
    pub fn load(&self, n: u64) -> Option<Band> {
        let bytes = fs::read(self.path(n)).ok()?;
        let (content, check) = bytes.split_last_chunk::<8>()?;
        let payload = content.strip_prefix(self.header.as_bytes())?;
        (u64::from_le_bytes(*check) == hash(content)).then(|| decode(&mut Reader(payload))).flatten()
    }

    /// Writes band n under another name first: it appears whole or not at all.
    ///
    /// # Errors
    /// An I/O error that names the file.
    pub fn save(&self, n: u64, band: &Band) -> Result<()> {
        let (path, draft) =
            (self.path(n), self.directory.join(format!("draft-{n:08}-{}", std::process::id())));
        let mut bytes = self.header.clone().into_bytes();
        encode(band, &mut bytes);
        bytes.extend(hash(&bytes).to_le_bytes());
        fs::write(&draft, bytes).and_then(|()| fs::rename(&draft, &path)).map_err(|cause| {
            // Half a draft is of no use; the error that brought us here is the one to report.
            let _ = fs::remove_file(&draft);
            let remedy = "make room, or name another directory";
            Error::io(path.display(), format!("cannot write ({cause}): {remedy}")).caused_by(cause)
        })
    }
}

/// FNV-1a.
fn hash(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

fn encode(band: &Band, bytes: &mut Vec<u8>) {
    let Counters { pairs, kicks, kicks_again, escalated } = band.counters;
    let shape = [band.first, band.columns as u64, band.rows as u64, band.growing.len() as u64];
    for number in shape.into_iter().chain([pairs, kicks, kicks_again, escalated]) {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(&band.verdicts);
    bytes.extend(&band.tiers);
    for found in &band.growing {
        bytes.extend(u64::from(found.position).to_le_bytes());
        bytes.extend(found.label.map_or(0, |label| label + 1).to_le_bytes());
        let ends = found.ln_multiplier.map_or([u64::MAX; 2], |ln| [ln.lo.to_bits(), ln.hi.to_bits()]);
        ends.iter().for_each(|end| bytes.extend(end.to_le_bytes()));
    }
}

/// Bytes yet to be read.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn number(&mut self) -> Option<u64> {
        let (number, rest) = self.0.split_first_chunk::<8>()?;
        self.0 = rest;
        Some(u64::from_le_bytes(*number))
    }

    fn bytes(&mut self, count: usize) -> Option<Vec<u8>> {
        let (bytes, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(bytes.to_vec())
    }
}

fn decode(reader: &mut Reader) -> Option<Band> {
    let [first, columns, rows, growing] = read_four(reader)?;
    let [pairs, kicks, kicks_again, escalated] = read_four(reader)?;
    let (columns, rows) = (columns as usize, rows as usize);
    let (verdicts, tiers) = (reader.bytes(columns * rows)?, reader.bytes(columns * rows)?);
    let mut found = Vec::new();
    for _ in 0..growing {
        let [position, label, lo, hi] = read_four(reader)?;
        let ln = || Enclosure { lo: f64::from_bits(lo), hi: f64::from_bits(hi) };
        let ln_multiplier = (lo != u64::MAX).then(ln);
        found.push(Growing { position: position as u32, label: label.checked_sub(1), ln_multiplier });
    }
    let counters = Counters { pairs, kicks, kicks_again, escalated };
    reader.0.is_empty().then_some(Band { first, columns, rows, verdicts, tiers, growing: found, counters })
}

fn read_four(reader: &mut Reader) -> Option<[u64; 4]> {
    Some([reader.number()?, reader.number()?, reader.number()?, reader.number()?])
}
