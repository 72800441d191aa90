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
    let expected = r"\begin{table}
  \centering
  \caption{Edges of R\&D}
  \label{tab:edges}
  \begin{tabular}{rrl}
    \toprule
    $\Lambda_2$ & $s$ & note \\
    \midrule
    $\pi^{2}/25$ & $2.318285(6)$ & a\_b \\
    \bottomrule
  \end{tabular}
\end{table}
";
    assert_eq!(document(&table), expected);
}
