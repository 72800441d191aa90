//! CSV, against a reader of RFC 4180.

use kickdrift::report::csv::*;
use kickdrift::report::table::{Cell, Column, Table};
use proptest::prelude::*;

/// The end of a line as the RFC has it.
const LINE_END: &str = "\r\n";

fn one_row(cells: Vec<Cell>) -> String {
    let columns = (0..cells.len()).map(|i| Column::new(&format!("c{i}"))).collect();
    let mut table = Table::new("t", "", columns);
    table.push(cells);
    document(&table).split_once(LINE_END).unwrap().1.to_string()
}

/// A reader of RFC 4180 written from the grammar's side, to check the writer against.
fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut quoted) = (vec![String::new()], false);
    let mut letters = line.strip_suffix(LINE_END).unwrap().chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if quoted && letters.peek() == Some(&'"') => {
                fields.last_mut().unwrap().extend(letters.next())
            }
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            other => fields.last_mut().unwrap().push(other),
        }
    }
    fields
}

#[test]
fn fields_are_quoted_only_where_they_must_be() {
    let text = |text: &str| Cell::Text(text.into());
    let row =
        one_row(vec![text("plain"), text("a,b"), text("say \"no\""), text("two\nlines"), Cell::Missing]);
    assert_eq!(row, "plain,\"a,b\",\"say \"\"no\"\"\",\"two\nlines\",\r\n");
}

#[test]
fn enclosures_take_two_columns_and_exact_values_fill_both() {
    let mut table = Table::new("t", "", vec![Column::new("s").enclosure(), Column::new("open")]);
    table.push(vec![Cell::Enclosure { lo: 2.0, hi: 2.5 }, Cell::Flag(true)]);
    table.push(vec![Cell::Exact("11/4".into()), Cell::Flag(false)]);
    assert_eq!(document(&table), "s_lo,s_hi,open\r\n2.0,2.5,true\r\n11/4,11/4,false\r\n");
}

proptest! {
    #[test]
    fn any_text_comes_back(texts in prop::collection::vec(any::<String>(), 1..5)) {
        let row = one_row(texts.iter().cloned().map(Cell::Text).collect());
        prop_assert_eq!(fields(&row), texts);
    }

    #[test]
    fn any_float_comes_back_bit_by_bit(bits in any::<u64>()) {
        let value = f64::from_bits(bits);
        prop_assume!(!value.is_nan());
        let row = one_row(vec![Cell::Float(value)]);
        prop_assert_eq!(row.trim_end().parse::<f64>().unwrap().to_bits(), bits);
    }
}
