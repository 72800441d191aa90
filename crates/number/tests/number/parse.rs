use proptest::prelude::*;

use crate::laurent::any_laurent;
use kickdrift_number::Rational;
use kickdrift_number::parse::*;
use rustix::time::{ClockId, clock_gettime};

fn shown(text: &str) -> String {
    parse("x", text).map_or_else(|error| error.to_string(), |value| value.to_string())
}

#[test]
fn what_is_typed_is_what_is_meant() {
    let cases = [
        ("0.3", "3/10"),
        (" 7 / 2 ", "7/2"),
        ("pi^2/25", "pi^2/25"),
        ("π^2/25", "pi^2/25"),
        ("2/pi", "2/pi"),
        ("1e-3", "1/1000"),
        ("1.5E+2", "150"),
        (".5", "1/2"),
        ("-2^2", "-4"),
        ("(-2)^2", "4"),
        ("2^-2", "1/4"),
        ("2^(1+1)", "4"),
        ("--1", "1"),
        ("2*-3", "-6"),
        ("1-2-3", "-4"),
        ("8/4/2", "1"),
        ("(1+pi)^2", "1 + 2*pi + pi^2"),
        ("pi/3+1", "1 + pi/3"),
        ("(pi+1)/(2*pi)", "1/(2*pi) + 1/2"),
        ("pi-pi", "0"),
        ("0^0", "1"),
        ("π²/25", "pi^2/25"),
        ("−2⁻¹⁰", "-1/1024"),
        ("(1 + pi)² × 2", "2 + 4*pi + 2*pi^2"),
    ];
    for (text, meant) in cases {
        assert_eq!(shown(text), meant, "{text}");
    }
}

#[test]
fn bad_input_gets_one_clear_line_and_no_wait() {
    let cases = [
        ("", "empty"),
        ("   ", "empty"),
        ("1/0", "divides by zero"),
        ("0^-1", "divides by zero"),
        ("1/(pi-pi)", "divides by zero"),
        ("1/(1+pi)", "sum involving pi"),
        ("(1+pi)^-1", "sum involving pi"),
        ("NaN", "not a number"),
        ("-inf", "not a number"),
        ("tau", "numbers have none but pi"),
        ("2pi", "unexpected 'p'"),
        ("2 pi", "write * for a product"),
        ("1 000", "write * for a product"),
        ("1.", "decimal point"),
        ("1e", "without an exponent"),
        ("(1", "closing parenthesis"),
        ("1)", "unexpected ')'"),
        ("1+", "ends too early"),
        ("1,5", "unexpected ','"),
        ("2^pi", "must be an integer"),
        ("2^(1/2)", "must be an integer"),
        ("2^3^2", "two powers in a row"),
        ("2²^2", "two powers in a row"),
        ("2⁻", "must be an integer"),
        ("2⁻⁻¹", "must be an integer"),
        ("²", "unexpected"),
        ("2⁹⁹⁹⁹⁹⁹⁹⁹⁹⁹⁹", "200000 bits"),
        ("2^1000000000", "200000 bits"),
        ("2^100000000000", "200000 bits"),
        ("1e999999999999", "200000 bits"),
        ("pi^1001", "pi^1000"),
        ("(1+pi)^100000", "200000 bits"),
    ];
    let seconds = || clock_gettime(ClockId::ThreadCPUTime).tv_sec;
    let start = seconds();
    for (text, reason) in cases {
        let message = parse("h1", text).expect_err(text).to_string();
        assert!(message.starts_with("h1 = ") && message.contains(reason), "{text}: {message}");
        assert!(!message.contains('\n') && message.len() < 300, "{message}");
    }
    for long in ["9".repeat(100_000), "(".repeat(19_000), "-".repeat(19_000), "((1+pi)^9*".repeat(1_900)] {
        assert!(parse("h1", &long).is_err());
    }
    // Processor time of this thread, generous: the whole list takes milliseconds; what must not happen is
    // minutes.
    assert!(seconds() - start < 20, "{} s", seconds() - start);
}

#[test]
fn ratios_ranges_and_integers() {
    assert_eq!(parse_ratio("ratio", "14/4").unwrap().terms(), (7, 2));
    assert_eq!(parse_ratio("ratio", "3").unwrap().terms(), (3, 1));
    for bad in ["0", "-7/2", "pi", "1/2^64", "2^64"] {
        assert!(parse_ratio("ratio", bad).is_err(), "{bad}");
    }
    let (lo, hi) = parse_range("h1-range", "1/100..2/pi").unwrap();
    assert_eq!((lo.to_string(), hi.to_string()), ("1/100".into(), "2/pi".into()));
    assert!(parse_range("h1-range", "22/7..pi").unwrap_err().to_string().contains("smaller number first"));
    assert!(parse_range("h1-range", "1").unwrap_err().to_string().contains("LO..HI"));
    assert_eq!(parse_integer_range("a", "-3..4").unwrap(), (-3, 4));
    assert!(parse_integer("a", "1/2").is_err() && parse_integer("a", "2^63").is_err());
}

proptest! {
    #[test]
    fn printing_and_reading_are_inverse(x in any_laurent()) {
        prop_assert_eq!(parse("x", &x.to_string()).unwrap(), x);
    }

    #[test]
    fn any_string_is_answered(text in ".{0,40}", formula in "[-0-9.e+*/^()pi π²⁻¹]{0,30}") {
        for text in [text, formula] {
            let _ = parse_ratio("x", &text);
            let _ = parse_range("x", &text);
            let _ = parse_integer_range("x", &text);
        }
    }

    #[test]
    fn plain_decimals_are_what_the_grammar_makes_of_them(
        text in "-?[0-9]{0,14}[.]?[0-9]{0,14}(e[-+]?[0-9]{1,3})?",
    ) {
        // Within parentheses a number is read by the grammar.
        prop_assert_eq!(parse("x", &text).ok(), parse("x", &format!("({text})")).ok());
    }

    #[test]
    fn decimals_are_exact(p: i64, places in 0usize..25) {
        let digits = format!("{:0>width$}", p.unsigned_abs(), width = places + 1);
        let (whole, fraction) = digits.split_at(digits.len() - places);
        let sign = if p < 0 { "-" } else { "" };
        let text = if places == 0 { format!("{sign}{whole}") } else { format!("{sign}{whole}.{fraction}") };
        let exact = Rational::new(p.into(), num_bigint::BigInt::from(10).pow(places as u32));
        prop_assert_eq!(parse_rational("x", &text).unwrap(), exact);
    }
}
