//! LaTeX.

use kickdrift::report::latex::*;
use kickdrift::report::table::{Cell, Column, Table};

#[test]
fn exact_numbers_are_typeset() {
    let pairs = [
        ("pi^2/25", "\\pi^{2}/25"),
        ("-7/2", "-7/2"),
        ("3*pi^-2/25", "3\\pi^{-2}/25"),
        ("2*3", "2 \\cdot 3"),
        ("1 + 2*pi", "1 + 2\\pi"),
        ("pi^10", "\\pi^{10}"),
        ("_", "\\_"),
        ("^", "^{}"),
    ];
    for (plain, typeset) in pairs {
        assert_eq!(exact(plain), typeset);
    }
}

#[test]
fn every_special_letter_is_escaped() {
    let special = "\\&%$#_{}~^<>|\n";
    let harmless = "\\textbackslash{}\\&\\%\\$\\#\\_\\{\\}\\textasciitilde{}\\textasciicircum{}\
                    \\textless{}\\textgreater{}\\textbar{} ";
    assert_eq!(escaped(special), harmless);
}

#[test]
fn floats_use_powers_of_ten() {
    assert_eq!(float(1.5e-7), "1.5 \\times 10^{-7}");
    assert_eq!(float(f64::NEG_INFINITY), "-\\infty");
    assert_eq!(float(0.25), "0.25");
    assert_eq!(enclosure(1e-300, 1e-300 + 2e-304), "1.0001(2) \\times 10^{-300}");
    assert_eq!(enclosure(0.0, f64::INFINITY), "[0.0, \\infty]");
}

#[test]
fn a_table_is_a_booktabs_float() {
    let columns = vec![
        Column::new("lambda2").titled("lambda2", "$\\Lambda_2$"),
        Column::new("s").titled("s", "$s$").enclosure(),
        Column::new("note").left(),
    ];
    let mut table = Table::new("edges", "Edges of R&D", columns);
    let edge = Cell::Enclosure { lo: 2.31828, hi: 2.31829 };
    table.push(vec![Cell::Exact("pi^2/25".into()), edge, Cell::Text("a_b".into())]);
    let expected = r"% needs \usepackage{amsmath,booktabs}
\begin{table}
  \centering
  \caption{Edges of R\&D. $h_2/h_1 = 5/3$, $\rho \in [1/4, 2]$.}
  \label{tab:edges-ratio-5-3-rho-range-1-4--2-FORM}
  \begin{tabular}{@{}rr@{}ll@{}}
    \toprule
    $\Lambda_2$ & \multicolumn{2}{c}{$s$} & note \\
    \midrule
    $\pi^{2}/25$ & $2$ & $.318285(6)$ & a\_b \\
    \bottomrule
  \end{tabular}
\end{table}
";
    assert_eq!(form_left_out(&document(&table, &input(), None, None).unwrap()), expected);
    let short = document(&table, &input(), Some(3), None).unwrap();
    assert!(short.contains("$2$ & $.32(1)$ &"), "{short}");
    assert_ne!(label(&short), label(&document(&table, &input(), None, None).unwrap()));
}

fn input() -> serde_json::Map<String, serde_json::Value> {
    [("ratio", "5/3"), ("rho_range", "1/4..2")]
        .map(|(key, value)| (key.into(), value.into()))
        .into_iter()
        .collect()
}

fn label(table: &str) -> &str {
    table.split("\\label{").nth(1).unwrap().split('}').next().unwrap()
}

/// The table with the checksum over its columns and digits replaced.
fn form_left_out(table: &str) -> String {
    let label = label(table);
    table.replace(label, &format!("{}-FORM", label.rsplit_once('-').unwrap().0))
}

fn many(rows: i64, columns: usize) -> Table {
    let columns = (0..columns).map(|i| Column::new(&format!("c{i}"))).collect();
    let mut table = Table::new("many", "", columns);
    for i in 0..rows {
        table.push(table.columns().iter().map(|_| Cell::Float(i as f64 + 1.0 / 7.0)).collect());
    }
    table
}

#[test]
fn wide_tables_take_both_columns_then_smaller_letters_then_more_tables() {
    let of = |columns| document(&many(2, columns), &input(), Some(10), None).unwrap();
    assert!(of(2).contains("\\begin{table}\n  \\centering\n"));
    assert!(of(4).contains("\\begin{table*}"));
    assert!(of(6).contains("\\scriptsize") || of(6).contains("\\footnotesize"));
    let parts = of(12);
    assert!(parts.contains("(continued)") && parts.matches("c11").count() == 1, "{parts}");
    let labels: Vec<&str> =
        parts.split("\\label{").skip(1).map(|rest| rest.split('}').next().unwrap()).collect();
    assert!(labels.len() > 1 && labels[0] != labels[1], "{labels:?}");
}

/// Ten digits were all, however much room a column had for more.
#[test]
fn digits_fill_the_place_that_ten_have() {
    let table = |columns: usize| {
        let headings = (0..columns).map(|n| Column::new(&format!("x{n}"))).collect();
        let mut table = Table::new("t", "T", headings);
        table.push(vec![Cell::Float(2.0 / 3.0); columns]);
        let latex = document(&table, &serde_json::Map::new(), None, None).unwrap();
        let digits = latex.split("$.").nth(1).and_then(|rest| rest.split('$').next()).unwrap().len();
        (latex.contains("begin{table}") && !latex.contains("small") && !latex.contains("size"), digits)
    };
    // A double has sixteen; two columns have room for them, three for some, and no letters become smaller.
    assert_eq!([1, 2, 3].map(table), [(true, 16), (true, 16), (true, 11)]);
}

#[test]
fn more_rows_than_a_page_holds_go_over_pages() {
    let of = |rows| document(&many(rows, 2), &input(), None, None).unwrap();
    assert!(of(40).contains("\\begin{tabular}"));
    assert!(of(41).contains("\\begin{longtable}") && of(41).contains("\\endhead"));
}

#[test]
fn equations_break_where_a_column_ends() {
    let terms: Vec<String> = (0..30).map(|i| format!(" + \\tfrac{{{i}}}{{7}} s^{{{i}}}")).collect();
    let own = Equation { name: "A".into(), key: "A".into(), terms };
    let text = equations(&[own], &input()).unwrap();
    assert!(text.matches("\\notag").count() > 3 && text.matches("\\label").count() == 1, "{text}");
    let long = Equation { name: "A".into(), key: "A".into(), terms: vec![format!(" {}", "7".repeat(99))] };
    assert!(equations(&[long], &input()).is_err());
}

/// It left ". ." behind the caption.
#[test]
fn captions_have_no_empty_title() {
    let mut input = input();
    input.insert("title".into(), "".into());
    let table = document(&many(2, 2), &input, Some(10), None).unwrap();
    assert!(!table.contains(". .") && !table.contains(", ."), "{table}");
}
