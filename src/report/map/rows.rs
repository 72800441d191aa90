//! The pairs that are not plainly stable, as rows.

use crate::map::{Band, Grid, Growing, Products};
use crate::number::Ratio;
use crate::report::table::{Cell, Column, Table};
use crate::verdict::Decision;

/// A pair whose verdict is not "elliptic": (i, j) names h1 = i D1 and h2 = j D2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marked {
    pub i: u64,
    pub j: u64,
    pub ratio: Ratio,
    /// h1, within two roundings.
    pub h1: f64,
    pub decision: Decision,
    /// What was asked for of a pair that grows exponentially.
    pub growing: Option<Growing>,
}

/// The marked pairs of a band, in order.
pub fn marked<'a>(grid: &'a Grid, band: &'a Band) -> impl Iterator<Item = Marked> + 'a {
    let mut growing = band.growing.iter().peekable();
    let step = grid.steps().0.to_f64();
    // Verdict 0 is "elliptic".
    (0..band.verdicts.len()).filter(|&n| band.verdicts[n] != 0).map(move |n| {
        let (i, j) = band.multipliers(grid, n);
        let ratio = grid.ratio(i, j);
        let growing = growing.next_if(|found| found.position as usize == n).copied();
        Marked { i, j, ratio, h1: i as f64 * step, decision: band.decision(n), growing }
    })
}

/// What was asked for of one pair.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Found {
    /// The tongue's label.
    pub m: Option<u64>,
    /// Its dominant family.
    pub family: Option<(i64, i64)>,
    /// The growth rate per unit time, rounded.
    pub rate: Option<f64>,
    /// Slow steps until the amplitude has grown tenfold, rounded.
    pub tenfold: Option<f64>,
}

impl Marked {
    /// What was asked for.
    pub fn found(&self) -> Found {
        let Some(growing) = self.growing else { return Found::default() };
        Found {
            m: growing.label,
            family: growing.family(self.ratio),
            // T = p h1.
            rate: growing.rate(self.ratio.p() as f64 * self.h1),
            tenfold: growing.steps_until_tenfold(self.ratio.q()),
        }
    }
}

/// Turns marked pairs into rows of cells, in the columns that were asked for.
pub struct Rows<'a> {
    grid: &'a Grid,
    products: Products,
    /// The last h1 in writing.
    h1: (u64, String),
    /// The h2 in writing, as far as they were needed; too many rows are written anew each time.
    h2: Vec<Option<String>>,
}

/// More texts than these are not kept.
const MOST_TEXTS: usize = 1 << 16;

impl<'a> Rows<'a> {
    pub fn new(grid: &'a Grid, products: Products) -> Self {
        let kept = if grid.shape().1 <= MOST_TEXTS { grid.shape().1 } else { 0 };
        Rows { grid, products, h1: (0, String::new()), h2: vec![None; kept] }
    }

    /// `h1, h2, p, q, kind, side, decided_by`, with labels `m, a, b`, with growth `growth_rate,
    /// steps_until_tenfold`.
    pub fn columns(&self) -> Vec<Column> {
        let mut columns = vec![
            Column::new("h1").titled("h1", "$h_1$"),
            Column::new("h2").titled("h2", "$h_2$"),
            Column::new("p").titled("p", "$p$"),
            Column::new("q").titled("q", "$q$"),
            Column::new("kind").left(),
            Column::new("side"),
            Column::new("decided_by").titled("decided by", "decided by").left(),
        ];
        if self.products.label {
            columns.extend(["m", "a", "b"].map(|key| Column::new(key).titled(key, &format!("${key}$"))));
        }
        if self.products.growth {
            columns.push(Column::new("growth_rate").titled("growth rate", "growth rate"));
            columns.push(
                Column::new("steps_until_tenfold").titled("steps until tenfold", "steps until tenfold"),
            );
        }
        columns
    }

    /// The cells of one pair.
    pub fn cells(&mut self, pair: &Marked) -> Vec<Cell> {
        let verdict = pair.decision.verdict;
        let mut cells = vec![
            Cell::Exact(self.h1(pair.i)),
            Cell::Exact(self.h2(pair.j)),
            Cell::Integer(pair.ratio.p() as i64),
            Cell::Integer(pair.ratio.q() as i64),
            Cell::Text(verdict.kind().name().into()),
            Cell::Integer(verdict.side().into()),
            Cell::Text(pair.decision.decided_by.name().into()),
        ];
        let found = pair.found();
        let integer = |n: Option<i64>| n.map_or(Cell::Missing, Cell::Integer);
        if self.products.label {
            let family = [found.family.map(|(a, _)| a), found.family.map(|(_, b)| b)];
            cells.push(integer(found.m.map(|m| m as i64)));
            cells.extend(family.map(integer));
        }
        if self.products.growth {
            cells.extend([found.rate, found.tenfold].map(|x| x.map_or(Cell::Missing, Cell::Float)));
        }
        cells
    }

    /// The rows as a table in memory.
    pub fn table<'b>(mut self, pairs: impl IntoIterator<Item = &'b Marked>) -> Table {
        let mut table = Table::new("pairs", "Pairs that are unstable or on an edge", self.columns());
        pairs.into_iter().for_each(|pair| table.push(self.cells(pair)));
        table
    }

    fn h1(&mut self, i: u64) -> String {
        if self.h1.0 != i {
            self.h1 = (i, self.grid.h1(i).to_string());
        }
        self.h1.1.clone()
    }

    fn h2(&mut self, j: u64) -> String {
        let write = || self.grid.h2(j).to_string();
        match self.h2.get_mut((j - self.grid.rows().0) as usize) {
            Some(kept) => kept.get_or_insert_with(write).clone(),
            None => write(),
        }
    }
}
