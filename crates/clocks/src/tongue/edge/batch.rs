//! Eigenvalues that are being looked for, side by side.

use crate::tongue::string::Entry;
use crate::tongue::string::lanes::{LANES, Lanes, lanes};

/// An eigenvalue in each lane.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Batch {
    /// The problem: 1 where the end is free, else 0.
    pub starts_free: Lanes,
    pub ends_free: Lanes,
    /// The eigenvalue's index, 1, 2, ... from below.
    pub index: Lanes,
    /// The sign, 1 or −1, that the zero's entry has below it: its x or, where the end is free, v on arrival.
    pub sign: Lanes,
    /// By computed counts no other eigenvalue lies between these.
    pub alone: [Lanes; 2],
    /// The part of it where the eigenvalue is.
    pub inside: [Lanes; 2],
    /// Where it is believed to be.
    pub kappa: Lanes,
    /// The node where the mode lives.
    pub at: Lanes,
    /// The last proof's radius: a wider enclosure is better than none where another trial gains no more.
    pub radius: Lanes,
}

impl Batch {
    const NOTHING: Batch = Batch {
        starts_free: [0.0; LANES],
        ends_free: [0.0; LANES],
        index: [0.0; LANES],
        sign: [0.0; LANES],
        alone: [[0.0; LANES]; 2],
        inside: [[0.0; LANES]; 2],
        kappa: [0.0; LANES],
        at: [0.0; LANES],
        radius: [0.0; LANES],
    };

    /// Sets κ to the middle of the intervals where nothing better is known: a mode that proved something, if
    /// only a little, is.
    #[inline(always)]
    pub fn guess(&mut self) {
        let [lo, hi] = &self.inside;
        let (kappa, radius) = (&self.kappa, &self.radius);
        self.kappa = lanes(|i| {
            let keeps = (radius[i] < f64::INFINITY) & (lo[i] < kappa[i]) & (kappa[i] < hi[i]);
            if keeps { kappa[i] } else { 0.5 * (lo[i] + hi[i]) }
        });
    }

    /// The problem and the index of a lane's eigenvalue.
    #[inline(always)]
    pub fn eigenvalue(&self, lane: usize) -> (Entry, u32) {
        let entry = Entry::of_ends(self.starts_free[lane] > 0.0, self.ends_free[lane] > 0.0);
        (entry, self.index[lane] as u32)
    }

    /// An eigenvalue between lo and hi, alone there, in a lane.
    #[inline(always)]
    fn set(&mut self, lane: usize, entry: Entry, index: usize, [lo, hi]: [f64; 2]) {
        self.starts_free[lane] = f64::from(u8::from(entry.starts_free()));
        self.ends_free[lane] = f64::from(u8::from(entry.ends_free()));
        self.index[lane] = index as f64;
        // One change for each zero below, the zero s = 0 of C included.
        let changes = index - 1 + usize::from(entry == Entry::C);
        self.sign[lane] = [1.0, -1.0][changes % 2];
        for [low, high] in [&mut self.alone, &mut self.inside] {
            (low[lane], high[lane]) = (lo, hi);
        }
        self.radius[lane] = f64::INFINITY;
    }

    #[inline(always)]
    fn copy(&mut self, lane: usize, from: &Batch, other: usize) {
        self.starts_free[lane] = from.starts_free[other];
        self.ends_free[lane] = from.ends_free[other];
        self.index[lane] = from.index[other];
        self.sign[lane] = from.sign[other];
        for end in 0..2 {
            self.alone[end][lane] = from.alone[end][other];
            self.inside[end][lane] = from.inside[end][other];
        }
        self.kappa[lane] = from.kappa[other];
        self.at[lane] = from.at[other];
        self.radius[lane] = from.radius[other];
    }
}

/// A list of them, which keeps its memory.
#[derive(Debug, Default)]
pub(crate) struct Batches {
    memory: Vec<Batch>,
    /// How many eigenvalues there are.
    len: usize,
}

impl Batches {
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Adds an eigenvalue between two ends, alone there.
    #[inline(always)]
    pub fn push(&mut self, entry: Entry, index: usize, ends: [f64; 2]) {
        let (batch, lane) = self.room();
        batch.set(lane, entry, index, ends);
    }

    /// Adds a lane of another list's batch.
    #[inline(always)]
    pub fn push_lane(&mut self, from: &Batch, other: usize) -> (&mut Batch, usize) {
        let (batch, lane) = self.room();
        batch.copy(lane, from, other);
        (batch, lane)
    }

    /// The place of the next one.
    #[inline(always)]
    fn room(&mut self) -> (&mut Batch, usize) {
        let (batch, lane) = (self.len / LANES, self.len % LANES);
        if batch == self.memory.len() {
            self.memory.push(Batch::NOTHING);
        }
        self.len += 1;
        (&mut self.memory[batch], lane)
    }

    /// Fills the lanes left over in the last batch with its first one.
    pub fn fill(&mut self) {
        let rest = self.len % LANES;
        if rest > 0 {
            let last = &mut self.memory[self.len / LANES];
            let first = *last;
            (rest..LANES).for_each(|lane| last.copy(lane, &first, 0));
        }
    }

    /// All batches.
    pub fn all_mut(&mut self) -> &mut [Batch] {
        &mut self.memory[..self.len.div_ceil(LANES)]
    }

    /// The batches and how many lanes of each count.
    pub fn iter(&self) -> impl Iterator<Item = (&Batch, usize)> {
        let lanes_left = (0..self.len).step_by(LANES).map(|done| LANES.min(self.len - done));
        self.memory.iter().zip(lanes_left)
    }

    /// Becomes another list in the order of the nodes where the modes live, `nodes` in number.
    pub fn sort_by_place(&mut self, others: &Batches, nodes: usize, order: &mut Order) {
        let Order { starts, sorted } = order;
        starts.clear();
        starts.resize(nodes + 1, 0);
        for (batch, lanes) in others.iter() {
            batch.at[..lanes].iter().for_each(|&at| starts[at as usize + 1] += 1);
        }
        (0..nodes).for_each(|at| starts[at + 1] += starts[at]);
        sorted.resize(others.len, 0);
        for (b, (batch, lanes)) in others.iter().enumerate() {
            for (i, &at) in batch.at[..lanes].iter().enumerate() {
                let place = &mut starts[at as usize];
                sorted[*place as usize] = (b * LANES + i) as u32;
                *place += 1;
            }
        }
        self.clear();
        for &i in sorted.iter() {
            self.push_lane(&others.memory[i as usize / LANES], i as usize % LANES);
        }
        self.fill();
    }
}

/// Memory for sorting.
#[derive(Debug, Default)]
pub struct Order {
    /// Where the modes of a node begin among all.
    starts: Vec<u32>,
    sorted: Vec<u32>,
}
