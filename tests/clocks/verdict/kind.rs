//! The four signs and the verdict.

use kickdrift::number::Sign::{self, Negative, Positive, Zero};
use kickdrift::verdict::*;

const ALL: [Sign; 3] = [Negative, Zero, Positive];

fn every_quadruple() -> impl Iterator<Item = [Sign; 4]> {
    (0..81).map(|i| [ALL[i % 3], ALL[i / 3 % 3], ALL[i / 9 % 3], ALL[i / 27]])
}

/// Whether some real matrix with AD − BC = 1 has these signs: entries of size 1/2, 1, 2 suffice to try
/// AD − BC > 0, and scaling a row gives 1.
fn realizable([a, b, c, d]: [Sign; 4]) -> bool {
    let sizes = [0.5, 1.0, 2.0];
    let value = |sign: Sign, size: f64| sign.to_i8() as f64 * size;
    sizes
        .iter()
        .any(|x| sizes.iter().any(|y| value(a, *x) * value(d, 1.0) - value(b, *y) * value(c, 1.0) > 0.0))
}

#[test]
fn all_seven_rows_are_reached_and_agree_with_the_trace() {
    let mut rows = std::collections::HashSet::new();
    for signs in every_quadruple().filter(|&s| realizable(s)) {
        let [a, b, c, d] = signs;
        let verdict = HalfSigns::new(a, b, c, d).verdict();
        // Tr - 2 = 4 BC and Tr + 2 = 4 AD, by sign.
        let side = if (b * c) != Negative {
            1
        } else if (a * d) != Positive {
            -1
        } else {
            0
        };
        assert_eq!(verdict.side(), side, "{signs:?}");
        let identity = (b == Zero && c == Zero) || (a == Zero && d == Zero);
        let on_edge = b * c == Zero || a * d == Zero;
        assert_eq!(verdict.is_stable(), side == 0 || identity, "{signs:?}");
        assert_eq!(matches!(verdict.kind(), Kind::Parabolic | Kind::Coexistence), on_edge, "{signs:?}");
        rows.insert((verdict.kind(), verdict.side()));
    }
    assert_eq!(rows.len(), 7);
}

#[test]
fn every_verdict_is_where_its_index_says() {
    assert!(Verdict::ALL.iter().zip(0..).all(|(verdict, index)| verdict.index() == index));
}

#[test]
fn impossible_signs_are_refused() {
    for [a, b, c, d] in every_quadruple() {
        let refused = std::panic::catch_unwind(|| HalfSigns::new(a, b, c, d)).is_err();
        assert_eq!(refused, !realizable([a, b, c, d]));
    }
}

#[test]
fn partial_signs_never_say_more_than_every_completion_says() {
    for [a, b, c, d] in every_quadruple().filter(|&s| realizable(s)) {
        let truth = HalfSigns::new(a, b, c, d).verdict();
        for known in 0..16 {
            let keep = |bit: u8, sign| (known >> bit & 1 == 1).then_some(sign);
            let partial = PartialSigns { a: keep(0, a), b: keep(1, b), c: keep(2, c), d: keep(3, d) };
            assert!(partial.verdict().is_none_or(|verdict| verdict == truth));
        }
    }
}
