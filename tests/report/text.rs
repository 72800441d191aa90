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
    let narrow = "\
Two rows.

  m  kind
---  ----------
  7  hyperbolic
-12  -
no room for: h₁ (s)
";
    assert_eq!(document(&table, Some(20)), narrow);
}

#[test]
fn lines_are_broken_at_spaces_and_hang_below_the_text_behind_their_label() {
    let broken = |line: &str, room: usize| wrapped(line, Some(room));
    assert_eq!(broken("short", 40), "short");
    assert_eq!(wrapped("as long as it comes", None), "as long as it comes");
    let label = broken("  unknown    whether a faster mode exists than those given", 40);
    assert_eq!(label, "  unknown    whether a faster mode\n             exists than those given");
    let step = broken("4 fs    stable; next unstable interval 4.6768-4.9679 fs", 40);
    assert_eq!(step, "4 fs    stable; next unstable interval\n        4.6768-4.9679 fs");
    assert_eq!(broken("advice: keep the step below that", 20), "advice: keep the\n  step below that");
    // A word is never broken.
    assert_eq!(broken("a doi:10.1016/j.jcp.2008.05.017 b", 12), "a\n  doi:10.1016/j.jcp.2008.05.017\n  b");
}

#[test]
fn the_word_of_a_verdict_has_a_colour_and_other_words_have_none() {
    let (red, green, yellow) = ("\u{1b}[31m", "\u{1b}[32m", "\u{1b}[33m");
    let end = "\u{1b}[0m";
    assert_eq!(coloured("unstable: hyperbolic"), format!("{red}unstable{end}: hyperbolic"));
    assert_eq!(
        coloured("5 fs    stable, but above the unstable 4-5 fs: do not use"),
        format!("5 fs    {green}stable{end}, but above the unstable 4-5 fs: {red}do not use{end}")
    );
    assert_eq!(
        coloured("4 fs    stable; caution: not below T/3"),
        format!("4 fs    {green}stable{end}; {yellow}caution{end}: not below T/3")
    );
    for plain in ["advice: stable steps", "  proven     every step is stable", "stableness"] {
        assert_eq!(coloured(plain), plain);
    }
}
