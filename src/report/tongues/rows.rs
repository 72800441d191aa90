//! Tongues as cells.

use super::json::{decimal, side};
use crate::report::digits::rounded;
use crate::report::table::{Cell, Column, Table};
use crate::tongue::{Quantity, Request, Tongue, TongueEdge};

/// Turns tongues into rows of cells.
#[derive(Clone, Debug)]
pub struct Rows {
    request: Request,
    /// For people and paper: the columns that fit a line, rounded numbers in a few digits.
    short: bool,
}

/// Digits that people need of a number that is rounded anyway.
const FEW: usize = 4;

impl Rows {
    /// Every column.
    pub fn all(request: &Request) -> Self {
        Rows { request: request.clone(), short: false }
    }

    /// The columns that fit a line.
    pub fn short(request: &Request) -> Self {
        Rows { request: request.clone(), short: true }
    }

    /// An empty table.
    pub fn table(&self) -> Table {
        Table::new(
            "tongues",
            "Unstable intervals (tongues) in s, the fast stiffness times the square of the fast step",
            self.columns(),
        )
    }

    /// The columns, in order.
    pub fn columns(&self) -> Vec<Column> {
        let math = |key: &str| Column::new(key).titled(key, &format!("${key}$"));
        let mut columns: Vec<Column> = ["p", "q", "m", "a", "b"].map(math).into();
        for (end, sign) in [("lower", "-"), ("upper", "+")] {
            columns.push(Column::new(end).titled(&format!("{end} edge"), &format!("$s_{sign}$")).enclosure());
            columns.push(Column::new(&format!("{end}_entry")).titled("of", "of").left());
            if self.request.wanted.exact {
                columns.push(Column::new(&format!("{end}_exact")).titled("exact", "exact").left());
                if !self.short {
                    columns.push(Column::new(&format!("{end}_on")).left());
                }
            }
            self.add_digits(&mut columns, end);
            self.add_steps(&mut columns, end, sign);
        }
        columns.push(Column::new("closed"));
        columns.push(Column::new("width").enclosure());
        self.add_wanted(&mut columns);
        if self.short {
            columns.retain(|column| column.key != "closed");
        }
        columns
    }

    fn add_digits(&self, columns: &mut Vec<Column>, end: &str) {
        if self.request.digits.is_some() {
            columns.extend(["lo", "hi"].map(|side| {
                Column::new(&format!("{end}_decimal_{side}")).titled(&format!("{end} {side}"), side)
            }));
        }
    }

    fn add_steps(&self, columns: &mut Vec<Column>, end: &str, sign: &str) {
        if self.request.lambda1.is_some() {
            columns.extend([1, 2].map(|i| {
                let title = format!("h{i} {end}");
                Column::new(&format!("{end}_h{i}")).titled(&title, &format!("$h_{i}^{sign}$")).enclosure()
            }));
        }
    }

    fn add_wanted(&self, columns: &mut Vec<Column>) {
        let (wanted, short) = (&self.request.wanted, self.short);
        let mut add = |key: &str, title: &str, only_long: bool| {
            if !(short && only_long) {
                columns
                    .push(Column::new(key).titled(title, &title.replace("√lambda1", "$\\sqrt{\\Lambda_1}$")));
            }
        };
        if wanted.growth {
            add("growth_s", "fastest at s", true);
            add("ln_multiplier", "ln multiplier", true);
            add("rate", "growth/√lambda1", self.request.lambda1.is_some());
            if self.request.lambda1.is_some() {
                add("growth_rate", "growth rate", false);
            }
            add("steps_until_tenfold", "tenfold in", false);
        }
        if wanted.predicted {
            add("predicted_s", "predicted s", true);
            add("side", "predicted point", false);
            add("position", "position", true);
            add("distance", "distance", true);
        }
        if wanted.first_order {
            add("first_order_centre", "centre to first order", true);
            add("centre_error", "its error", true);
            add("first_order_width", "width to first order", true);
            add("width_error", "its error", true);
            add("width_ratio", "width/first order", false);
        }
    }

    /// The cells of one tongue.
    pub fn cells(&self, tongue: &Tongue) -> Vec<Cell> {
        let row = &tongue.row;
        let integer = |n: Option<i64>| n.map_or(Cell::Missing, Cell::Integer);
        let mut cells = vec![
            Cell::Integer(row.ratio.p() as i64),
            Cell::Integer(row.ratio.q() as i64),
            Cell::Integer(row.gap.m as i64),
            integer(row.family.map(|(a, _)| a)),
            integer(row.family.map(|(_, b)| b)),
        ];
        self.add_edge(&mut cells, Some(&tongue.lower));
        self.add_edge(&mut cells, tongue.upper.as_ref());
        if !self.short {
            cells.push(Cell::Flag(row.gap.closed));
        }
        let (lo, hi) = row.gap.width;
        cells.push(match row.gap.upper {
            Some(_) if row.gap.closed && self.short => Cell::Text("closed".into()),
            Some(_) => Cell::Enclosure { lo, hi },
            None => Cell::Missing,
        });
        self.add_numbers(&mut cells, tongue);
        cells
    }

    fn add_edge(&self, cells: &mut Vec<Cell>, edge: Option<&TongueEdge>) {
        let enclosed = |q: &Quantity| Cell::Enclosure { lo: q.lo, hi: q.hi };
        cells.push(edge.map_or(Cell::Missing, |edge| enclosed(&edge.s)));
        cells.push(edge.map_or(Cell::Missing, |edge| Cell::Text(edge.entry.name().into())));
        if self.request.wanted.exact {
            let rational = edge.and_then(|edge| edge.exact.as_ref()).map(|s| Cell::Exact(s.to_string()));
            let on = edge.and_then(|edge| edge.on).map(|on| Cell::Text(on.name().into()));
            cells.push(if self.short { rational.or(on.clone()) } else { rational }.unwrap_or(Cell::Missing));
            if !self.short {
                cells.push(on.unwrap_or(Cell::Missing));
            }
        }
        if self.request.digits.is_some() {
            let decimal = edge.and_then(|edge| decimal(&edge.s, &self.request));
            cells.extend(decimal.map_or([Cell::Missing, Cell::Missing], |ends| ends.map(Cell::Exact)));
        }
        if self.request.lambda1.is_some() {
            let steps = edge.and_then(|edge| edge.steps.as_ref());
            cells
                .extend(steps.map_or([Cell::Missing, Cell::Missing], |steps| steps.each_ref().map(enclosed)));
        }
    }

    fn add_numbers(&self, cells: &mut Vec<Cell>, tongue: &Tongue) {
        let (wanted, row, short) = (&self.request.wanted, &tongue.row, self.short);
        let float = |x: Option<f64>| {
            x.map_or(Cell::Missing, |x| Cell::Float(if short { rounded(x, FEW) } else { x }))
        };
        let mut add = |cell: Cell, only_long: bool| {
            if !(short && only_long) {
                cells.push(cell);
            }
        };
        if wanted.growth {
            let peak = row.peak.as_ref();
            add(float(peak.map(|peak| peak.s)), true);
            add(float(peak.map(|peak| peak.ln_multiplier)), true);
            add(float(peak.map(|peak| peak.rate)), self.request.lambda1.is_some());
            if self.request.lambda1.is_some() {
                add(float(tongue.growth_rate), false);
            }
            add(float(peak.map(|peak| peak.slow_steps_to_tenfold)), false);
        }
        if wanted.predicted {
            let predicted = row.predicted.as_ref();
            let text = |words: Option<&str>| words.map_or(Cell::Missing, |words| Cell::Text(words.into()));
            add(float(predicted.map(|p| p.s)), true);
            add(text(predicted.map(|p| side(p.side))), false);
            add(text(predicted.map(|p| p.side.name())), true);
            add(float(predicted.map(|p| p.distance)), true);
        }
        if wanted.first_order {
            let law = row.first_order.as_ref();
            add(float(law.map(|l| l.law.centre)), true);
            add(float(law.map(|l| l.centre_error)), true);
            add(float(law.map(|l| l.law.width)), true);
            add(float(law.map(|l| l.width_error)), true);
            add(float(law.map(|l| l.width_ratio)), false);
        }
    }
}
