//! Parts of a map on disk: one file a band, written whole or not at all, so that work can stop at any moment,
//! go on later, be shared out, and be joined to the bytes of a single run.
//!
//! ```text
//!     file = "kickdrift band 3\n" question "\n" payload check
//! ```
//!
//! The question names the band by its number and its columns, its grid and products, all exactly; the payload
//! is the band in little-endian fields; the check is a 64-bit FNV hash of all before it, which finds damage
//! and proves no origin. A file that does not match in every byte of that, or whose fields no band of this
//! question can have, is not there.

use std::fs;
use std::path::{Path, PathBuf};

use super::band::{Band, Counters};
use super::grid::Grid;
use super::products::{Growing, Products};
use super::shard::columns_of;
use super::work::{LANES, MOST_TOGETHER};
use crate::verdict::{Kind, Tier, Verdict};
use number::{Error, Interval, Result, file};

/// The bands of one map in one directory.
#[derive(Clone, Debug)]
pub struct Store {
    directory: PathBuf,
    grid: Grid,
    products: Products,
}

/// The bytes of a pair that grows: position, label, two ends.
const GROWING_BYTES: u64 = 32;

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
        Ok(Store { directory: directory.to_owned(), grid: grid.clone(), products })
    }

    fn path(&self, n: u64) -> PathBuf {
        self.directory.join(format!("band-{n:08}"))
    }

    /// What band n begins with.
    fn header(&self, n: u64, (first, columns): (u64, usize)) -> String {
        let last = first + columns as u64 - 1;
        let (grid, products) = (self.grid.fingerprint(), self.products);
        format!("kickdrift band 3\nband {n}, columns {first}..{last}; {grid}; {products:?}\n")
    }

    /// Band n, if it is here, whole, and of this map.
    pub fn load(&self, n: u64) -> Option<Band> {
        let columns = columns_of(&self.grid, n)?;
        let header = self.header(n, columns);
        let pairs = columns.1 as u64 * self.grid.shape().1 as u64;
        // Eight numbers of shape and counters, a verdict and a tier a pair, the pairs that grow, the check.
        let most = header.len() as u64 + 64 + pairs * (2 + GROWING_BYTES) + 8;
        let bytes = file::bytes(&self.path(n), most).ok()?;
        let (content, check) = bytes.split_last_chunk::<8>()?;
        let payload = content.strip_prefix(header.as_bytes())?;
        let band = (u64::from_le_bytes(*check) == hash(content))
            .then(|| decode(&mut Reader(payload), pairs))
            .flatten()?;
        let is_here = (band.first, band.columns, band.rows) == (columns.0, columns.1, self.grid.shape().1);
        (is_here && is_possible(&band, &self.grid, self.products)).then_some(band)
    }

    /// Writes band n under another name first: it appears whole or not at all.
    ///
    /// # Errors
    /// An I/O error that names the file, and a band that the map does not have.
    pub fn save(&self, n: u64, band: &Band) -> Result<()> {
        let (path, draft) =
            (self.path(n), self.directory.join(format!("draft-{n:08}-{}", std::process::id())));
        let columns = columns_of(&self.grid, n).filter(|columns| *columns == (band.first, band.columns));
        let columns = columns.ok_or_else(|| Error::input("band", n, "is no band of this map"))?;
        let mut bytes = self.header(n, columns).into_bytes();
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

/// Whether a band of this grid can hold these values when these products are asked for: who forges a valid
/// check may write a wrong verdict, but none that means nothing.
fn is_possible(band: &Band, grid: &Grid, products: Products) -> bool {
    let pairs = band.verdicts.len() as u64;
    let Counters { pairs: counted, kicks, kicks_again, escalated } = band.counters;
    // Every kick that is composed is one of a pair that runs beside others, in places that are empty where
    // there are no others.
    let most_kicks = u128::from(pairs) * u128::from(MOST_TOGETHER) * LANES as u128;
    let counts = counted == pairs
        && escalated <= pairs
        && [kicks, kicks_again].iter().all(|&n| u128::from(n) <= 2 * most_kicks);
    let codes = band.verdicts.iter().all(|&code| usize::from(code) < Verdict::ALL.len())
        && band.tiers.iter().all(|&code| usize::from(code) < Tier::ALL.len());
    // With codes that mean something it can be asked which pairs grow.
    counts && codes && grows_where_it_says(band, grid, products)
}

/// Whether what grows is listed, each pair once and in order, with the products that were asked for.
fn grows_where_it_says(band: &Band, grid: &Grid, products: Products) -> bool {
    let verdict = |n: usize| Verdict::ALL[usize::from(band.verdicts[n])];
    let growing = (0..band.verdicts.len()).filter(|&n| verdict(n).kind() == Kind::Hyperbolic);
    let growing = growing.filter(|_| products.growing());
    let is_label = |n: usize, m: u64| {
        let (i, j) = band.multipliers(grid, n);
        let ratio = grid.ratio(i, j);
        // Half turns: at most one a kick, and an even number where the growing motion comes back with its
        // sign.
        products.label && m <= ratio.p() + ratio.q() + 1 && m.is_multiple_of(2) == (verdict(n).side() > 0)
    };
    let is_growth = |ln: &Interval| products.growth && 0.0 <= ln.lo && ln.lo <= ln.hi && ln.hi.is_finite();
    let is_found = |(found, n): (&Growing, usize)| {
        found.position as usize == n
            && found.label.is_none_or(|m| is_label(n, m))
            && found.ln_multiplier.as_ref().is_none_or(is_growth)
    };
    band.growing.len() == growing.clone().count() && band.growing.iter().zip(growing).all(is_found)
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

/// A band of so many pairs; `None` where the bytes are those of no such band.
fn decode(reader: &mut Reader, pairs: u64) -> Option<Band> {
    let [first, columns, rows, growing] = read_four(reader)?;
    let [counted, kicks, kicks_again, escalated] = read_four(reader)?;
    if columns.checked_mul(rows) != Some(pairs) || growing > pairs {
        return None;
    }
    let count = usize::try_from(pairs).ok()?;
    let (verdicts, tiers) = (reader.bytes(count)?, reader.bytes(count)?);
    let mut found = Vec::new();
    for _ in 0..growing {
        let [position, label, lo, hi] = read_four(reader)?;
        let ln = || Interval { lo: f64::from_bits(lo), hi: f64::from_bits(hi) };
        let ln_multiplier = (lo != u64::MAX).then(ln);
        let position = u32::try_from(position).ok()?;
        found.push(Growing { position, label: label.checked_sub(1), ln_multiplier });
    }
    let counters = Counters { pairs: counted, kicks, kicks_again, escalated };
    let (columns, rows) = (usize::try_from(columns).ok()?, usize::try_from(rows).ok()?);
    reader.0.is_empty().then_some(Band { first, columns, rows, verdicts, tiers, growing: found, counters })
}

fn read_four(reader: &mut Reader) -> Option<[u64; 4]> {
    Some([reader.number()?, reader.number()?, reader.number()?, reader.number()?])
}
