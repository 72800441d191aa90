//! Nested dissection: an order of rows in which the factor of a body in space fills up less than in one of
//! least degrees.
//!
//! A part of the graph is cut across its longest way, the nodes on one side of the cut with neighbours on the
//! other come last, and so on with what is left on both sides (George, SIAM J. Numer. Anal. 10, 1973). Along
//! the way stands the difference of the distances from both ends, smoothed. Rows with the same neighbours, as
//! the three of an atom, are one node. Any order serves a proof: none rests on what is done here.

use std::collections::HashMap;

/// Parts of no more rows are left in their order.
const SMALL: usize = 300;

/// Rounds of smoothing.
const ROUNDS: usize = 12;

/// Parts of the rows below a cut that are tried.
const CUTS: [f64; 7] = [0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65];

/// Rows with the same neighbours, and which of these nodes are next to each other.
struct Graph {
    rows: Vec<Vec<usize>>,
    near: Vec<Vec<usize>>,
}

impl Graph {
    /// That of the lower triangle of a symmetric matrix, column by column.
    fn new(columns: &[usize], rows: &[usize]) -> Graph {
        let n = columns.len() - 1;
        let lower = || (0..n).flat_map(|j| rows[columns[j]..columns[j + 1]].iter().map(move |&i| (i, j)));
        // A sum of numbers without a pattern, one a neighbour: rows of one sum are taken for alike, at worst
        // a poor order.
        let number = |i: usize| {
            (i as u64 + 1)
                .wrapping_mul(0x9e37_79b9_7f4a_7c15)
                .rotate_left(29)
                .wrapping_mul(0xbf58_476d_1ce4_e5b9)
        };
        let mut sums: Vec<u64> = (0..n).map(number).collect();
        for (i, j) in lower().filter(|(i, j)| i != j) {
            sums[i] = sums[i].wrapping_add(number(j));
            sums[j] = sums[j].wrapping_add(number(i));
        }
        let mut nodes: HashMap<u64, usize> = HashMap::new();
        let mut members: Vec<Vec<usize>> = Vec::new();
        let indexes: Vec<usize> = (sums.iter().enumerate())
            .map(|(i, sum)| {
                let node = *nodes.entry(*sum).or_insert(members.len());
                if node == members.len() {
                    members.push(Vec::new());
                }
                members[node].push(i);
                node
            })
            .collect();
        let mut near = vec![Vec::new(); members.len()];
        let is_first = |i: usize| members[indexes[i]][0] == i;
        for (i, j) in lower().filter(|&(i, j)| indexes[i] != indexes[j] && is_first(i) && is_first(j)) {
            near[indexes[i]].push(indexes[j]);
            near[indexes[j]].push(indexes[i]);
        }
        Graph { rows: members, near }
    }
}

/// The rows of a symmetric matrix in the order in which they are to be eliminated, from its lower triangle,
/// column by column.
pub(super) fn dissected(columns: &[usize], rows: &[usize]) -> Vec<usize> {
    let Graph { mut rows, near } = Graph::new(columns, rows);
    let mut parts = Parts::new(rows.iter().map(Vec::len).collect(), near);
    // From the end on.
    let mut order = Vec::new();
    let mut left = parts.all();
    while let Some(indexes) = left.pop() {
        parts.begin(&indexes);
        let (last, rest) = parts.divided(indexes);
        order.extend(last);
        left.extend(rest);
    }
    order.into_iter().rev().flat_map(|v| std::mem::take(&mut rows[v])).collect()
}

/// What is known of the nodes: which part each is in, and where.
struct Parts {
    weights: Vec<usize>,
    near: Vec<Vec<usize>>,
    count: usize,
    part: Vec<usize>,
    distance: Vec<usize>,
    along: Vec<f64>,
    is_above: Vec<bool>,
}

impl Parts {
    fn new(weights: Vec<usize>, near: Vec<Vec<usize>>) -> Parts {
        let n = weights.len();
        let (part, distance) = (vec![0; n], vec![0; n]);
        Parts { weights, near, count: 0, part, distance, along: vec![0.0; n], is_above: vec![false; n] }
    }

    /// One part of all nodes.
    fn all(&self) -> Vec<Vec<usize>> {
        vec![(0..self.weights.len()).collect()]
    }

    /// Makes these nodes a part.
    fn begin(&mut self, indexes: &[usize]) {
        self.count += 1;
        indexes.iter().for_each(|&v| self.part[v] = self.count);
    }

    fn weight(&self, nodes: &[usize]) -> usize {
        nodes.iter().map(|&v| self.weights[v]).sum()
    }

    fn near(&self, v: usize) -> impl Iterator<Item = usize> + '_ {
        self.near[v].iter().copied().filter(move |&w| self.part[w] == self.part[v])
    }

    /// What comes last of a part, and the parts of the rest: its pieces where it has several, both sides of a
    /// cut, or nothing where it is small or has no cut.
    fn divided(&mut self, indexes: Vec<usize>) -> (Vec<usize>, Vec<Vec<usize>>) {
        if self.weight(&indexes) <= SMALL {
            return (indexes, Vec::new());
        }
        self.distance_from_none(&indexes);
        let mut pieces = Vec::new();
        for &v in &indexes {
            if self.distance[v] == usize::MAX {
                pieces.push(self.reached(v));
            }
        }
        if pieces.len() > 1 {
            return (Vec::new(), pieces);
        }
        match self.cut(&indexes) {
            Some([separator, below, above]) => (separator, vec![below, above]),
            None => (indexes, Vec::new()),
        }
    }

    fn distance_from_none(&mut self, indexes: &[usize]) {
        indexes.iter().for_each(|&v| self.distance[v] = usize::MAX);
    }

    /// The nodes of a part that paths from one reach, the nearest first, each then with its distance.
    fn reached(&mut self, from: usize) -> Vec<usize> {
        self.distance[from] = 0;
        let mut reached = vec![from];
        let mut next = 0;
        while let Some(&v) = reached.get(next) {
            for k in 0..self.near[v].len() {
                let w = self.near[v][k];
                if self.part[w] == self.part[v] && self.distance[w] == usize::MAX {
                    self.distance[w] = self.distance[v] + 1;
                    reached.push(w);
                }
            }
            next += 1;
        }
        reached
    }

    /// The nodes of a part along its longest way; those that no path reaches from the first one are
    /// start_vector.
    fn sorted(&mut self, indexes: &[usize]) -> Vec<usize> {
        // An end, the end farthest from it, and that from which this one is farthest.
        let mut end = indexes[0];
        indexes.iter().for_each(|&v| self.along[v] = 0.0);
        for sign in [0.0, 1.0, -1.0] {
            self.distance_from_none(indexes);
            let reached = self.reached(end);
            end = reached[reached.len() - 1];
            indexes.iter().for_each(|&v| self.along[v] += sign * self.distance[v] as f64);
        }
        for _ in 0..ROUNDS {
            let mean = |&v: &usize| {
                let (sum, count) =
                    self.near(v).fold((self.along[v], 1.0), |(s, c), w| (s + self.along[w], c + 1.0));
                sum / count
            };
            let means: Vec<f64> = indexes.iter().map(mean).collect();
            let middle = means.iter().sum::<f64>() / means.len() as f64;
            indexes.iter().zip(means).for_each(|(&v, mean)| self.along[v] = mean - middle);
        }
        let mut sorted = indexes.to_vec();
        sorted.sort_by(|&v, &w| self.along[v].total_cmp(&self.along[w]));
        sorted
    }

    /// A separator of a connected part and what is on both sides of it; `None` where nothing is.
    fn cut(&mut self, indexes: &[usize]) -> Option<[Vec<usize>; 3]> {
        let sorted = self.sorted(indexes);
        let total = sorted.len() as f64;
        let mut best: Option<(f64, [Vec<usize>; 3])> = None;
        for (part, is_above) in CUTS.iter().flat_map(|part| [(part, false), (part, true)]) {
            let found = self.separated(&sorted, (part * total) as usize, is_above);
            let [s, a, b] = [0, 1, 2].map(|k| self.weight(&found[k]) as f64);
            // Rows of the separator times what they fill of either side, and their own block.
            let cost = s * (a * a + b * b) + s * s * (a + b) + s * s * s / 3.0;
            if a > 0.0 && b > 0.0 && best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, found));
            }
        }
        best.map(|(_, found)| found)
    }

    /// The nodes of one side of a cut that have neighbours on the other, and the rest of both.
    fn separated(&mut self, sorted: &[usize], below: usize, is_above: bool) -> [Vec<usize>; 3] {
        sorted.iter().enumerate().for_each(|(k, &v)| self.is_above[v] = k >= below);
        let side = &self.is_above;
        let is_next = |&v: &usize| side[v] == is_above && self.near(v).any(|w| side[w] != is_above);
        let (separator, rest): (Vec<_>, Vec<_>) = sorted.iter().copied().partition(is_next);
        let (above, below) = rest.into_iter().partition(|&v| side[v]);
        [separator, below, above]
    }
}
