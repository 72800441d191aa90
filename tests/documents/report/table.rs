//! Tables.

use kickdrift::report::table::*;

fn columns() -> Vec<Column> {
    vec![Column::new("z"), Column::new("s").enclosure(), Column::new("a").left()]
}

#[test]
fn json_keeps_the_order_of_the_columns_and_the_kind_of_each_cell() {
    let mut table = Table::new("t", "", columns());
    table.push(vec![Cell::Integer(-3), Cell::Enclosure { lo: 0.1, hi: 0.25 }, Cell::Text("a\"b".into())]);
    table.push(vec![Cell::Float(f64::INFINITY), Cell::Exact("11/4".into()), Cell::Missing]);
    assert_eq!(
        serde_json::to_string(&table).unwrap(),
        r#"[{"z":-3,"s":{"lo":0.1,"hi":0.25},"a":"a\"b"},{"z":null,"s":"11/4","a":null}]"#
    );
}

#[test]
#[should_panic(expected = "one cell a column")]
fn a_short_row_is_a_bug() {
    Table::new("t", "", columns()).push(vec![Cell::Missing]);
}

#[test]
#[should_panic(expected = "column a is not for enclosures")]
fn an_enclosure_in_a_plain_column_is_a_bug() {
    let wide = Cell::Enclosure { lo: 0.0, hi: 1.0 };
    Table::new("t", "", columns()).push(vec![Cell::Missing, Cell::Missing, wide]);
}
