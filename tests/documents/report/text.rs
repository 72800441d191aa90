//! Text.

use kickdrift::report::table::{Cell, Column, Table};
use kickdrift::report::text::*;

#[test]
fn numbers_line_up_on_the_right_and_words_on_the_left() {
    let columns = vec![
        Column::new("m"),
        Column::new("kind").left(),
        Column::new("h").titled("h₁", "$h_1$").in_unit("s").enclosure(),
    ];
    let mut table = Table::new("t", "Two rows.", columns);
    table.push(vec![
        Cell::Integer(7),
        Cell::Text("hyperbolic".into()),
        Cell::Enclosure { lo: 2.31828, hi: 2.31829 },
    ]);
    table.push(vec![Cell::Integer(-12), Cell::Missing, Cell::Exact("1/3".into())]);
    let expected = "\
Two rows.

  m  kind             h₁ (s)
---  ----------  -----------
  7  hyperbolic  2.318285(6)
-12  -                   1/3
";
    assert_eq!(document(&table), expected);
}
