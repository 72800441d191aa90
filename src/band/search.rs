//! A window of steps, bisected where a band may be.

use std::collections::BTreeMap;

use super::frame::{Base, Frame};
use super::taylor::Taylor;
use super::walk::Found;
use crate::error::{Error, Result};
use crate::number::{Ball, ExactSign, Laurent, Rational, Real, Sign};
use crate::parallel::{go_on, try_map};

/// Boxes that are tried side by side. The goal is looked at between them.
const BATCH: usize = 4096;

/// The most bisections of one step.
const DEEPEST: u32 = 40;

/// How much thinner a box may be than the window, in the first step and in the second, as powers of two.
const THINNEST: [u32; 2] = [3, 6];

/// Bits of constants.
pub(super) const BITS: u32 = 96;

/// Two stiffnesses and closed ranges of both steps.
#[derive(Clone, Debug)]
pub struct Window {
    lambdas: [Laurent; 2],
    ranges: [(Laurent, Laurent); 2],
    bases: [Option<Base>; 2],
    /// Lower ends and lengths.
    sides: [(Taylor, Taylor); 2],
}

/// A box of a window: lo + (hi − lo) k/2^d to lo + (hi − lo) (k + 1)/2^d in each step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Cell {
    /// d, of both steps.
    pub depths: [u32; 2],
    /// k, of both steps.
    pub places: [u64; 2],
}

/// The result of a search.
#[derive(Clone, Debug)]
pub struct Bands {
    /// Where it looked.
    pub window: Window,
    /// Boxes in which every ratio is unstable, the largest first; no two of them overlap.
    pub certified: Vec<Cell>,
    /// Boxes that are left: parts of them may be unstable for every ratio.
    pub open: Vec<Cell>,
    /// Boxes that were tried.
    pub tried: u64,
}

impl Window {
    /// # Errors
    /// A range that is empty or begins below zero, and stiffnesses neither of which is positive.
    pub fn new(lambdas: [Laurent; 2], ranges: [(Laurent, Laurent); 2]) -> Result<Window> {
        for ((lo, hi), field) in ranges.iter().zip(["h1-range", "h2-range"]) {
            if lo.sign() == Sign::Negative || (hi - lo).sign() != Sign::Positive {
                return Err(Error::input(field, format!("{lo}..{hi}"), "give LO..HI with 0 <= LO < HI"));
            }
        }
        let bases = bases(lambdas.each_ref());
        if bases.iter().all(Option::is_none) {
            return Err(Error::input(
                "lambda1",
                &lambdas[0],
                "one of the two stiffnesses has to be positive",
            ));
        }
        let sides = ranges
            .each_ref()
            .map(|(lo, hi)| (enclosed(&lo.enclosure(BITS)), enclosed(&(hi - lo).enclosure(BITS))));
        Ok(Window { lambdas, ranges, bases, sides })
    }

    /// The stiffnesses.
    pub fn lambdas(&self) -> &[Laurent; 2] {
        &self.lambdas
    }

    /// The closed range of one step in a box, exactly.
    pub fn range(&self, cell: &Cell, step: usize) -> (Laurent, Laurent) {
        let ((lo, hi), unit) =
            (&self.ranges[step], Rational::new(1.into(), num_bigint::BigInt::from(1) << cell.depths[step]));
        let length = hi - lo;
        let at = |k: u64| lo + &(&length * &Laurent::from_rational(&unit * Rational::from_integer(k.into())));
        (at(cell.places[step]), at(cell.places[step] + 1))
    }

    /// The area of the window.
    pub fn area(&self) -> Laurent {
        let [first, second] = self.ranges.each_ref().map(|(lo, hi)| hi - lo);
        &first * &second
    }

    /// Whether a box is proven: every ratio in it is unstable.
    pub fn proves(&self, cell: &Cell) -> bool {
        // As far from being proven as the search may have thought.
        [0, u32::MAX].into_iter().any(|to_go| self.prove(cell, to_go) == Found::Certified)
    }

    fn prove(&self, cell: &Cell, to_go: u32) -> Found {
        // The base's step moves by u₁, the other one by u₂.
        let step = |step: usize, slope: usize| {
            // k + 1/2 and 1/2 over 2^d, exact in doubles.
            let half = 0.5f64.powi(cell.depths[step] as i32 + 1);
            let place =
                Taylor::constant((2 * cell.places[step] + 1) as f64 * half, 0.0).with_slope(slope, half);
            self.sides[step].0.plus(&self.sides[step].1.times(&place))
        };
        prove(&self.bases, to_go, step)
    }

    /// Bisects the window until so many boxes were tried, or boxes of a share of the window are certified. Boxes whose largest parts may
    /// soon be proven come first. `see` is called with the number of boxes tried since its last call. The result is the same on any number
    /// of threads.
    ///
    /// # Errors
    /// Where the work was stopped.
    pub fn search(&self, tries: u64, share: Option<&Rational>, see: &dyn Fn(u64)) -> Result<Bands> {
        let mut queue: BTreeMap<u32, Vec<(Cell, u32)>> = BTreeMap::from([(0, vec![(Cell::WHOLE, u32::MAX)])]);
        let mut bands = Bands { window: self.clone(), certified: Vec::new(), open: Vec::new(), tried: 0 };
        let mut certified = Rational::default();
        while let Some((key, cells)) = queue.pop_first() {
            for (n, batch) in cells.chunks(BATCH).enumerate() {
                let left = (tries - bands.tried).min(batch.len() as u64) as usize;
                let is_enough = share.is_some_and(|share| certified >= *share);
                if left == 0 || is_enough {
                    let left = cells[n * BATCH..].iter().copied().chain(queue.into_values().flatten());
                    bands.open.extend(left.map(|(cell, _)| cell));
                    return Ok(bands.sorted());
                }
                go_on()?;
                let found = try_map(&batch[..left], |(cell, to_go)| Ok(self.prove(cell, *to_go)))?;
                see(left as u64);
                bands.tried += left as u64;
                bands.open.extend(batch[left..].iter().map(|(cell, _)| *cell));
                for ((cell, _), found) in batch.iter().zip(found) {
                    match found {
                        Found::Certified => {
                            certified += cell.share();
                            bands.certified.push(*cell);
                        }
                        Found::Open { direction, to_go } => match cell.halves(direction) {
                            Some(halves) => {
                                let to_go = to_go.max(1);
                                let next = (cell.depths[0] + cell.depths[1] + to_go).max(key);
                                queue.entry(next).or_default().extend(halves.map(|half| (half, to_go)));
                            }
                            None => bands.open.push(*cell),
                        },
                        Found::Dropped => {}
                    }
                }
            }
        }
        Ok(bands.sorted())
    }
}

impl Cell {
    /// All of the window.
    pub const WHOLE: Cell = Cell { depths: [0, 0], places: [0, 0] };

    /// The share of the window, 2^-(d1 + d2).
    pub fn share(&self) -> Rational {
        Rational::new(1.into(), num_bigint::BigInt::from(1) << (self.depths[0] + self.depths[1]))
    }

    /// Both halves in one of the steps, or in the other one where they would be too thin; `None` where they would be too small.
    fn halves(&self, direction: usize) -> Option<[Cell; 2]> {
        let other = 1 - direction;
        let is_thin = self.depths[direction] >= self.depths[other] + THINNEST[direction];
        let direction = if is_thin { other } else { direction };
        let mut halves = [*self; 2];
        for (n, half) in halves.iter_mut().enumerate() {
            half.depths[direction] += 1;
            half.places[direction] = 2 * half.places[direction] + n as u64;
        }
        (halves[0].depths[direction] <= DEEPEST).then_some(halves)
    }
}

impl Bands {
    /// The share of the window that is certified.
    pub fn share(&self) -> Rational {
        self.certified.iter().map(Cell::share).sum()
    }

    /// The largest boxes first.
    fn sorted(mut self) -> Self {
        let order = |cell: &Cell| (cell.depths[0] + cell.depths[1], *cell);
        self.certified.sort_unstable_by_key(order);
        self.open.sort_unstable_by_key(order);
        self
    }
}

/// Whether every ratio in a box is unstable, with the steps `step(clock, slope)`: affine in the direction `slope`, 0 for the clock that
/// is the base, 1 for the other.
pub(super) fn prove(bases: &[Option<Base>; 2], to_go: u32, step: impl Fn(usize, usize) -> Taylor) -> Found {
    let frames = [0, 1].map(|own| Frame::new(&step(own, 0), &step(1 - own, 1), bases[own].as_ref()?));
    let distortion = |frame: &Option<Frame>| frame.as_ref().map_or(f64::INFINITY, Frame::distortion);
    let own = usize::from(distortion(&frames[1]) < distortion(&frames[0]));
    match &frames[own] {
        None => Found::Open { direction: own, to_go: 1 },
        Some(frame) => match frame.prove(to_go) {
            Found::Open { direction, to_go } => Found::Open { direction: direction ^ own, to_go },
            found => found,
        },
    }
}

/// Either clock as the base, where its stiffness is positive.
pub(super) fn bases([first, second]: [&Laurent; 2]) -> [Option<Base>; 2] {
    [base(first, second), base(second, first)]
}

/// √Λ/2 and Λ'/(2 √Λ); `None` unless Λ is positive.
fn base(own: &Laurent, other: &Laurent) -> Option<Base> {
    let root = own.enclosure(BITS).sqrt(BITS)?.scale2(-1);
    (own.sign() == Sign::Positive).then_some(())?;
    let weight = other.enclosure(BITS).scale2(-2).div(&root, BITS)?;
    Some(Base { root: enclosed(&root), weight: enclosed(&weight) })
}

/// A constant of a box.
pub(super) fn enclosed(ball: &Ball) -> Taylor {
    let (lo, hi) = ball.to_f64_enclosure();
    Taylor::constant(lo, hi - lo)
}
