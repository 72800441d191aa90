//! The pairs that are not plainly stable, as rows.

use crate::report::record::Record;
use crate::report::table::{Cell, Choice, Column, Table};
use clocks::map::{Band, Enclosure, Grid, Growing, Products};
use clocks::verdict::Decision;
use number::{Ratio, Result};

/// A pair whose verdict is not "elliptic": (i, j) names h1 = i D1 and h2 = j D2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marked {
    pub i: u64,
    pub j: u64,
    pub ratio: Ratio,
    /// h1, within two roundings.
    pub h1: f64,
    pub decision: Decision,
    /// Label and growth of a pair that grows exponentially, as far as they were asked for.
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

/// Label, family and growth of one pair, as far as they were asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Found {
    /// The tongue's label.
    pub m: Option<u64>,
    /// Its dominant family.
    pub family: Option<(i64, i64)>,
    /// The growth rate per unit time.
    pub rate: Option<Enclosure>,
    /// Slow steps until the amplitude has grown tenfold.
    pub tenfold: Option<Enclosure>,
}

impl Marked {
    /// Its label, family and growth, as far as they were asked for.
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
    record: Record<'static, Written>,
    choice: Option<Choice>,
    /// The last h1 in writing.
    h1: (u64, String),
    /// The h2 in writing, as far as they were needed; too many rows are written anew each time.
    h2: Vec<Option<String>>,
}

/// A pair, its steps in writing, and what was asked for of it.
struct Written {
    steps: [String; 2],
    pair: Marked,
    found: Found,
}

/// More texts than these are not kept.
const MOST_TEXTS: usize = 1 << 16;

/// `h1, h2, p, q, kind, side, decided_by`, with labels `m, a, b`, with growth `growth_rate` and
/// `steps_until_tenfold`, both enclosed.
fn record(products: Products) -> Record<'static, Written> {
    type Of<'a> = &'a Written;
    let mut record = Record::new()
        .field(Column::math("h1", "h_1"), |written: Of| Cell::exact(&written.steps[0]))
        .field(Column::math("h2", "h_2"), |written| Cell::exact(&written.steps[1]))
        .field(Column::math("p", "p"), |written| written.pair.ratio.p().into())
        .field(Column::math("q", "q"), |written| written.pair.ratio.q().into())
        .field(Column::new("kind").left(), |written| written.pair.decision.verdict.kind().name().into())
        .field(Column::new("side").aside(), |written| i64::from(written.pair.decision.verdict.side()).into())
        .field(Column::new("decided_by").in_words("decided by").left().aside(), |written| {
            written.pair.decision.decided_by.name().into()
        });
    if products.label {
        record = record
            .field(Column::math("m", "m"), |written| written.found.m.into())
            .field(Column::math("a", "a"), |written| written.found.family.map(|(a, _)| a).into())
            .field(Column::math("b", "b"), |written| written.found.family.map(|(_, b)| b).into());
    }
    if products.growth {
        let ends = |found: Option<Enclosure>| Cell::from(found.map(|Enclosure { lo, hi }| (lo, hi)));
        let enclosed = |key, title| Column::new(key).in_words(title).enclosure();
        record = record
            .field(enclosed("growth_rate", "growth rate"), move |written| ends(written.found.rate))
            .field(enclosed("steps_until_tenfold", "steps until tenfold"), move |written| {
                ends(written.found.tenfold)
            });
    }
    record
}

/// The products that columns of these names need.
pub fn needed(names: &[String]) -> Products {
    let has = |products: Products| {
        let more = record(products).columns().split_off(record(Products::default()).columns().len());
        names.iter().any(|name| Choice::new(&more, std::slice::from_ref(name)).is_ok())
    };
    let none = Products::default();
    Products { label: has(Products { label: true, ..none }), growth: has(Products { growth: true, ..none }) }
}

impl<'a> Rows<'a> {
    /// The rows of a grid.
    pub fn new(grid: &'a Grid, products: Products) -> Self {
        let kept = if grid.shape().1 <= MOST_TEXTS { grid.shape().1 } else { 0 };
        let (record, h1) = (record(products), (0, String::new()));
        Rows { grid, record, choice: None, h1, h2: vec![None; kept] }
    }

    /// These columns alone, by the names that CSV has.
    ///
    /// # Errors
    /// A name that no column of a map has.
    pub fn choosing(self, names: &[String]) -> Result<Self> {
        let choice = Choice::new(&self.record.columns(), names)?;
        Ok(Rows { choice: Some(choice), ..self })
    }

    /// The columns that were asked for.
    pub fn columns(&self) -> Vec<Column> {
        self.choice.as_ref().map_or_else(|| self.record.columns(), |choice| choice.columns().to_vec())
    }

    /// The cells of one pair.
    pub fn cells(&mut self, pair: &Marked) -> Vec<Cell> {
        let steps = [self.h1(pair.i), self.h2(pair.j)];
        let row = self.record.row(&Written { steps, pair: *pair, found: pair.found() });
        match &self.choice {
            Some(choice) => choice.row(&row),
            None => row,
        }
    }

    /// The rows as a table in memory.
    pub fn table<'b>(mut self, pairs: impl IntoIterator<Item = &'b Marked>) -> Table {
        let mut table = Table::new("pairs", "Pairs that are unstable or on an edge", self.columns())
            .captioned("Pairs of steps that are unstable or on an edge");
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
