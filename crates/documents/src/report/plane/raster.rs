//! A grid of pairs reduced to what a figure can show.

use clocks::map::Grid;

/// The most cells along a side: at 110 mm of paper each is a third of a point, and nothing smaller is drawn.
const MOST_CELLS: usize = 900;

/// One value for each cell of at most 900 x 900, a cell standing for one pair of a small grid and for a block
/// of a large one. Of the values put into a cell the largest stays.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Raster<T> {
    /// The multipliers of the first pair, the numbers of pairs and of cells: of columns, of rows.
    first: [u64; 2],
    pairs: [usize; 2],
    cells: [usize; 2],
    /// By column.
    values: Vec<Option<T>>,
}

impl<T: Copy + PartialOrd> Raster<T> {
    pub fn new(grid: &Grid) -> Self {
        let (columns, rows) = grid.shape();
        let cells = [columns.min(MOST_CELLS), rows.min(MOST_CELLS)];
        Raster {
            first: [grid.columns().0, grid.rows().0],
            pairs: [columns, rows],
            cells,
            values: vec![None; cells[0] * cells[1]],
        }
    }

    pub fn put(&mut self, i: u64, j: u64, value: T) {
        let cell =
            |axis: usize, n: u64| (n - self.first[axis]) as usize * self.cells[axis] / self.pairs[axis];
        let slot = &mut self.values[cell(0, i) * self.cells[1] + cell(1, j)];
        if slot.is_none_or(|old| old < value) {
            *slot = Some(value);
        }
    }

    /// The cells that hold a value: (column, row, value), by column.
    pub fn filled(&self) -> impl Iterator<Item = (u32, u32, T)> + '_ {
        let place = |n: usize| ((n / self.cells[1]) as u32, (n % self.cells[1]) as u32);
        let held = self.values.iter().enumerate();
        held.filter_map(move |(n, value)| value.map(|value| (place(n).0, place(n).1, value)))
    }

    /// The centre of cell (0, 0) and the distance of its neighbours, for pairs at multiples of `steps`.
    pub fn geometry(&self, steps: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let pitch = [0, 1].map(|axis| steps[axis] * self.pairs[axis] as f64 / self.cells[axis] as f64);
        let edge = |axis: usize| (self.first[axis] as f64 - 0.5) * steps[axis];
        ([0, 1].map(|axis| edge(axis) + pitch[axis] / 2.0), pitch)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use number::parse::parse;

    fn grid(last: &str) -> Grid {
        let x = |text: &str| parse("x", text).unwrap();
        let ranges = [(x("3"), x(last)), (x("1"), x("2"))];
        let [h1, h2] = ranges;
        Grid::new(x("1"), x("1"), [x("1"), x("1")], h1, h2).unwrap()
    }

    #[test]
    fn a_small_grid_keeps_its_pairs_and_their_places() {
        let mut raster = Raster::new(&grid("7"));
        raster.put(4, 2, 1.0);
        assert_eq!(raster.filled().collect::<Vec<_>>(), [(1, 1, 1.0)]);
        assert_eq!(raster.geometry([0.5, 2.0]), ([1.5, 2.0], [0.5, 2.0]));
    }

    #[test]
    fn a_cell_of_a_large_grid_takes_the_strongest_of_its_pairs() {
        let mut raster = Raster::new(&grid("1802"));
        for (i, value) in [(3, 5), (4, 7), (5, 6), (1802, 1)] {
            raster.put(i, 1, value);
        }
        assert_eq!(raster.filled().collect::<Vec<_>>(), [(0, 0, 7), (1, 0, 6), (899, 0, 1)]);
        assert_eq!(raster.geometry([1.0, 1.0]), ([3.5, 1.0], [2.0, 1.0]));
    }
}
