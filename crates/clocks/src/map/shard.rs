//! A grid cut into bands of columns, and its bands dealt out to the parts of a map.

use std::fmt;
use std::str::FromStr;

use super::grid::Grid;
use number::{Error, Result};

/// Part k of n of a map, k = 1..n: every n-th band.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    k: u64,
    n: u64,
}

impl Shard {
    /// The whole map.
    pub const WHOLE: Shard = Shard { k: 1, n: 1 };

    /// Part k of n.
    ///
    /// # Errors
    /// Unless 1 ≤ k ≤ n.
    pub fn new(k: u64, n: u64) -> Result<Shard> {
        if 1 <= k && k <= n {
            return Ok(Shard { k, n });
        }
        Err(Error::input("shard", format!("{k}/{n}"), "the parts of n are 1/n, 2/n, ..., n/n"))
    }
}

impl FromStr for Shard {
    type Err = Error;

    /// `k/n`.
    ///
    /// # Errors
    /// Another text, and as [`Shard::new`].
    fn from_str(text: &str) -> Result<Shard> {
        let terms = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
        let (k, n) = terms.ok_or_else(|| Error::input("shard", text, "write part and parts as 2/16"))?;
        Shard::new(k, n)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.k, self.n)
    }
}

/// About as many pairs make a band: enough to find company for each number of updates.
const PAIRS: usize = 1 << 15;

/// The columns of each band of a grid: (first, count). Depends on the grid alone.
pub(super) fn bands(grid: &Grid) -> impl ExactSizeIterator<Item = (u64, usize)> + Clone + use<> {
    let (columns, rows) = grid.shape();
    let width = (PAIRS / rows).clamp(1, columns);
    let first = grid.columns().0;
    (0..columns.div_ceil(width)).map(move |n| {
        let start = n * width;
        (first + start as u64, width.min(columns - start))
    })
}

/// The columns of band n, if there is one.
pub(super) fn columns_of(grid: &Grid, n: u64) -> Option<(u64, usize)> {
    bands(grid).nth(usize::try_from(n).ok()?)
}

/// A band's number and its columns: the first one and how many.
pub(super) type Numbered = (u64, (u64, usize));

impl Shard {
    pub(super) fn bands(self, grid: &Grid) -> impl Iterator<Item = Numbered> + Clone + use<> {
        (0..).zip(bands(grid)).filter(move |(n, _)| n % self.n == self.k - 1)
    }

    /// The number of pairs in this part of the grid.
    pub fn pairs(self, grid: &Grid) -> u64 {
        self.bands(grid).map(|(_, (_, columns))| columns as u64 * grid.shape().1 as u64).sum()
    }
}
