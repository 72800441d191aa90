//! Two sparse matrices in the blocks of the first: those rows that its entries join.

use std::collections::BTreeMap;

use faer::Mat;

use super::matrix::Pattern;

/// F and S in the blocks of F.
#[derive(Debug)]
pub(super) struct Blocks {
    /// The rows of each.
    pub rows: Vec<Vec<usize>>,
    pub fast: Vec<Mat<f64>>,
    /// S between two of them, the one with the larger number first.
    pub slow: Vec<([usize; 2], Mat<f64>)>,
    /// All of S's blocks, and those on the diagonal.
    pub pattern: Pattern,
    pub alone: Pattern,
}

/// Rows of a block at most.
const LARGEST: usize = 300;

/// Entries of whole blocks at most, over those of the matrices given.
const FILLED: usize = 6;

impl Blocks {
    /// From the patterns of F and of both, F in its own and S in that of both. `None` where a block is large, or whole ones are far more than what is given.
    pub fn new([own, both]: [&Pattern; 2], [fast_values, slow_values]: [&[f64]; 2]) -> Option<Blocks> {
        let (n, rows) = (own.size(), own.components());
        let mut place = vec![(0, 0); n];
        for (k, own) in rows.iter().enumerate() {
            own.iter().enumerate().for_each(|(at, &i)| place[i] = (k, at));
        }
        if rows.iter().any(|own| own.len() > LARGEST) {
            return None;
        }
        let zero = |k: usize, l: usize| Mat::<f64>::zeros(rows[k].len(), rows[l].len());
        let mut fast: Vec<_> = (0..rows.len()).map(|k| zero(k, k)).collect();
        for (i, j, x) in own.triplets(fast_values) {
            let ((k, a), (_, b)) = (place[i], place[j]);
            (fast[k][(a, b)], fast[k][(b, a)]) = (x, x);
        }
        let mut slow: BTreeMap<[usize; 2], Mat<f64>> =
            (0..rows.len()).map(|k| ([k, k], zero(k, k))).collect();
        let mut entries = 0;
        for (i, j, x) in both.triplets(slow_values) {
            let ((k, a), (l, b)) = (place[i], place[j]);
            let own = slow.entry([k.max(l), k.min(l)]).or_insert_with(|| {
                entries += rows[k].len() * rows[l].len();
                zero(k.max(l), k.min(l))
            });
            if k >= l {
                own[(a, b)] = x;
            }
            if k <= l {
                own[(b, a)] = x;
            }
        }
        if entries > FILLED * both.entries() {
            return None;
        }
        let all = |pairs: &mut dyn Iterator<Item = [usize; 2]>| -> Option<Pattern> {
            let whole = |[k, l]: [usize; 2]| {
                let (rows, columns) = (&rows[k], &rows[l]);
                rows.iter().flat_map(move |&i| columns.iter().map(move |&j| (i.max(j), i.min(j), 0.0)))
            };
            let triplets: Vec<_> = pairs.flat_map(whole).collect();
            Some(Pattern::of(n, [&triplets[..]]).ok()?.0)
        };
        let alone = all(&mut (0..rows.len()).map(|k| [k, k]))?;
        let pattern = all(&mut slow.keys().copied())?;
        Some(Blocks { rows, fast, slow: slow.into_iter().collect(), pattern, alone })
    }
}
