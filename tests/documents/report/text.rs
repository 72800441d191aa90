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
    assert_eq!(document(&table, None), expected);
}

#[test]
fn a_narrow_table_loses_digits_and_empty_columns_before_others() {
    let edge = |name| Column::new(name).enclosure();
    let columns = vec![edge("lower"), Column::new("exact"), edge("upper")];
    let mut table = Table::new("t", "", columns);
    let edge = |x: f64| Cell::Enclosure { lo: x, hi: x + 2e-15 };
    table.push(vec![edge(0.190_516_204_998_483_9), Cell::Missing, edge(0.190_742_711_064_138_47)]);
    let shorter = "        lower  exact          upper\n-------------  -----  -------------\n0.19051620(1)      -  0.19074271(1)\n";
    let narrow = document(&table, Some(40));
    assert_eq!(
        narrow,
        format!("{shorter}\nat most 8 digits here; a wider terminal or --format json has them\n")
    );
    let narrow = document(&table, Some(30));
    assert!(
        narrow.contains("lower") && narrow.contains("upper") && narrow.contains("left out here: exact;"),
        "{narrow}"
    );
}

#[test]
fn tables_fold_headings_and_name_the_columns_left_out() {
    let columns = vec![
        Column::new("mode").left(),
        Column::new("first").in_words("first unstable from").in_unit("fs"),
        Column::new("moving").left(),
    ];
    let mut table = Table::new("t", "", columns);
    table.push(vec![Cell::Text("OH".into()), Cell::Exact("4.6768".into()), Cell::Text("atom one".into())]);
    let text = "mode  first unstable from (fs)  moving\n----  ------------------------  --------\nOH                      4.6768  atom one\n";
    assert_eq!([document(&table, None), document(&table, Some(60))], [text, text]);
    let folded = "         first\n      unstable\n          from\nmode      (fs)  moving\n----  --------  --------\nOH      4.6768  atom one\n";
    assert_eq!(document(&table, Some(25)), folded);
    let narrow = document(&table, Some(16));
    let (rows, note) = narrow.split_once("\n\n").unwrap();
    assert!(rows.lines().all(|line| line.chars().count() <= 16), "{narrow}");
    assert!(note.starts_with("left out here:") && note.contains("moving"), "{narrow}");
}
