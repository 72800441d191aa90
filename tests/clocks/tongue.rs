//! Tongues: by strings, by polynomials, by verdicts; known values; every corner of the input.

use kickdrift::error::Kind as ErrorKind;
use kickdrift::map::{Grid, Map, Products};
use kickdrift::number::parse::parse;
use kickdrift::number::rational::{from_f64_exact, ratio, to_f64};
use kickdrift::number::{Laurent, Polynomial, Ratio, Rational};
use kickdrift::propagator::TwoClocks;
use kickdrift::resonance::dominant_family;
use kickdrift::tongue::{
    Closing, Edge, Entry, ExactEdge, Gap, Search, Selection, Side, Tongues, Wanted, closings, entries, survey,
};
use kickdrift::verdict::{Decidable, Kind, Limits, decide, growth};
use num_integer::Integer;
use num_traits::Zero;
use proptest::prelude::*;

fn tongues(p: u64, q: u64, rho: &Rational) -> Tongues {
    Tongues::new(Ratio::new(p, q).unwrap(), rho).unwrap()
}

fn lowest_terms(p: u64, q: u64) -> (u64, u64) {
    let g = p.gcd(&q);
    (p / g, q / g)
}

fn exact(x: f64) -> Rational {
    from_f64_exact(x).unwrap()
}

fn holds(edge: &Edge, s: f64) -> bool {
    edge.lo <= s && s <= edge.hi
}

/// All edges of one entry.
fn all_edges(tongues: &Tongues, entry: Entry) -> Vec<Edge> {
    let zeros = tongues.zeros(entry);
    if zeros == 0 { Vec::new() } else { tongues.edges(entry, 1, zeros).unwrap() }
}

#[test]
fn known_edges_at_rho_one_twenty_fifth() {
    // Edges computed independently with a full-period product, 17 digits.
    let known = [
        (7, 2, 4, 2.3150964145691537, 2.4450418679126287),
        (7, 3, 4, 2.3645889194144734, 2.40607004934166),
        (5, 3, 3, 2.4943473293988725, 2.6172555028316578),
    ];
    for (p, q, m, lower, upper) in known {
        let gap = tongues(p, q, &ratio(1, 25)).gap(m).unwrap();
        // The published digits may be off by one in the last.
        let near = |edge: &Edge, s: f64| edge.lo.next_down() <= s && s <= edge.hi.next_up();
        assert!(near(&gap.lower, lower) && near(&gap.upper.unwrap(), upper), "{p}/{q}: {gap:?}");
    }
}

#[test]
fn there_are_p_plus_q_minus_2_finite_tongues_and_an_infinite_one_none_overlapping() {
    for (p, q) in Ratio::up_to(16).map(Ratio::terms) {
        for rho in [ratio(1, 25), ratio(7, 10), ratio(9, 2)] {
            let tongues = tongues(p, q, &rho);
            let gaps = tongues.all().unwrap();
            assert_eq!(gaps.len() as u64, p + q - 1);
            let (last, finite) = gaps.split_last().unwrap();
            assert!(last.upper.is_none() && finite.iter().all(|gap| gap.upper.is_some()));
            for pair in gaps.windows(2) {
                // Tr is 2 and -2 in turn, so neighbouring tongues cannot touch; their enclosures can, where
                // the stable band between them is thinner than a double shows.
                let (upper, next) = (pair[0].upper.unwrap(), pair[1].lower);
                assert!(upper.lo <= next.lo && upper.hi <= next.hi, "{p}/{q}, {rho}: {pair:?}");
                if upper.hi > next.lo {
                    let [upper, next] = [&upper, &next].map(|edge| tongues.refine(edge, 60).unwrap());
                    assert!(upper.hi < next.lo, "{p}/{q}, {rho}: {pair:?}");
                }
            }
        }
    }
}

#[test]
fn one_tongue_costs_two_edges_and_is_the_same_as_among_all() {
    for (p, q) in [(7, 4), (1, 9), (12, 25), (40, 1)] {
        let all = tongues(p, q, &ratio(1, 3)).all().unwrap();
        for gap in &all {
            let alone = tongues(p, q, &ratio(1, 3));
            let one = alone.gap(gap.m).unwrap();
            assert_eq!((one.m, one.lower.entry, one.closed), (gap.m, gap.lower.entry, gap.closed));
            let meet = |a: &Edge, b: &Edge| a.lo <= b.hi && b.lo <= a.hi;
            assert!(meet(&one.lower, &gap.lower));
            assert!(alone.effort().doubles + alone.effort().precise <= 4);
        }
    }
}

#[test]
fn edges_are_as_narrow_as_doubles_get() {
    let rho = ratio(1, 25);
    for (p, q) in Ratio::up_to(40).map(Ratio::terms) {
        let tongues = tongues(p, q, &rho);
        for entry in Entry::ALL {
            for edge in all_edges(&tongues, entry) {
                assert!(edge.hi <= edge.lo.next_up().next_up(), "{p}/{q}: {edge:?}");
            }
        }
    }
}

/// Each edge's enclosure holds exactly one root of the entry's polynomial, and they are all its positive
/// roots.
fn roots_are_edges(p: u64, q: u64, rho: &Rational) {
    let tongues = tongues(p, q, rho);
    let polynomials = entries(Ratio::new(p, q).unwrap(), rho);
    for (entry, polynomial) in Entry::ALL.into_iter().zip(polynomials) {
        let edges = all_edges(&tongues, entry);
        assert_eq!(polynomial.degree(), Some(edges.len()), "{p}/{q}, rho = {rho}, {entry:?}");
        if edges.is_empty() {
            continue;
        }
        let sturm = kickdrift::number::polynomial::Sturm::new(&polynomial);
        for edge in &edges {
            assert_eq!(sturm.count(&exact(edge.lo), &exact(edge.hi)), 1, "{p}/{q}, rho = {rho}: {edge:?}");
            let below = sturm.count(&Rational::zero(), &exact(edge.lo));
            let on_lo = usize::from(polynomial.eval(&exact(edge.lo)).is_zero());
            assert_eq!(below - on_lo + 1, edge.index as usize);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    // Ledger: edges; 60 random ratios and rho, new in each run; exact roots of the half period's entries
    #[test]
    fn string_edges_are_the_roots_of_the_entries(p in 1u64..16, q in 1u64..16, n in 1i64..3000, d in 1i64..3000) {
        let (p, q) = lowest_terms(p, q);
        roots_are_edges(p, q, &ratio(n, d));
    }

    #[test]
    fn extreme_rho_is_no_different(p in 1u64..9, q in 1u64..9, decade in -12i32..=12) {
        let (p, q) = lowest_terms(p, q);
        let power = Rational::from_integer(10.into()).pow(decade);
        roots_are_edges(p, q, &power);
    }

    // Ledger: label; 60 random places in tongues, new in each run; the number of the tongue
    #[test]
    fn the_verdict_and_its_label_are_those_of_the_tongue(
        p in 1u64..25, q in 1u64..25, n in 1i64..200, gap in 0usize..48, share in 1i64..1000,
    ) {
        let (p, q) = lowest_terms(p, q);
        let rho = ratio(n, 100);
        let gaps = tongues(p, q, &rho).all().unwrap();
        let (gap, next) = (&gaps[gap % gaps.len()], gaps.get(gap % gaps.len() + 1));
        let blend = |lo: f64, hi: f64| exact(lo) + (exact(hi) - exact(lo)) * ratio(share, 1000);
        let at = |s: Rational| {
            let clocks = TwoClocks::with_rho(Ratio::new(p, q).unwrap(), s, rho.clone());
            let verdict = decide(&clocks, &Limits::default()).unwrap().verdict;
            (verdict, growth(&clocks, verdict, &Limits::default()).unwrap().label)
        };
        // Inside: hyperbolic with the tongue's label and the sign of (-1)^m.
        let top = gap.upper.map_or(2.0 * gap.lower.hi, |upper| upper.lo);
        if gap.lower.hi < top {
            let (verdict, label) = at(blend(gap.lower.hi, top));
            prop_assert_eq!(verdict.kind(), Kind::Hyperbolic);
            prop_assert_eq!(verdict.side(), if gap.m % 2 == 0 { 1 } else { -1 });
            prop_assert_eq!(label, Some(gap.m));
        }
        // Between tongues: elliptic.
        if let (Some(upper), Some(next)) = (gap.upper, next) && upper.hi < next.lower.lo {
            prop_assert_eq!(at(blend(upper.hi, next.lower.lo)).0.kind(), Kind::Elliptic);
        }
    }

    #[test]
    fn many_digits_hold_the_few(p in 1u64..40, q in 1u64..40, n in 1i64..100, m in 1u64..79) {
        let (p, q) = lowest_terms(p, q);
        let tongues = tongues(p, q, &ratio(n, 50));
        let edge = tongues.gap(1 + (m - 1) % tongues.last()).unwrap().lower;
        let precise = tongues.refine(&edge, 50).unwrap();
        prop_assert!(exact(edge.lo) <= precise.lo && precise.hi <= exact(edge.hi));
        let goal = &precise.lo / Rational::from_integer(num_bigint::BigInt::from(10).pow(50));
        prop_assert!(precise.width() <= goal);
        // The exact signs at both ends differ, or the zero is known exactly.
        let sign = |s: &Rational| {
            let clocks = TwoClocks::with_rho(Ratio::new(p, q).unwrap(), s.clone(), ratio(n, 50));
            Decidable::half_signs(&clocks).all()[edge.entry as usize].to_i8()
        };
        prop_assert!(sign(&precise.lo) * sign(&precise.hi) < 0 || sign(&precise.lo) == 0);
    }

    #[test]
    fn swapping_the_clocks_maps_edges(p in 1u64..20, q in 1u64..20, n in 1i64..400) {
        // s' = h2² L2 = s rho (p/q)², rho' = 1/rho.
        let ((p, q), rho) = (lowest_terms(p, q), ratio(n, 100));
        let (own, other) = (tongues(p, q, &rho).all().unwrap(), tongues(q, p, &rho.recip()).all().unwrap());
        let factor = to_f64(&(&rho * Rational::new((p * p).into(), (q * q).into())));
        for (a, b) in own.iter().zip(&other) {
            prop_assert_eq!((a.m, a.lower.entry), (b.m, b.lower.entry));
            // Two enclosures of one ulp, and three roundings.
            prop_assert!((a.lower.lo * factor - b.lower.lo).abs() <= 4.0 * f64::EPSILON * b.lower.lo);
        }
    }
}

/// The label of the open tongue of p/q that holds s, its edges being left out; by exact comparison.
fn tongue_around(gaps: &[Gap], s: &Rational) -> Option<u64> {
    let holds = |gap: &&Gap| {
        exact(gap.lower.hi) < *s && gap.upper.is_none_or(|upper| *s < exact(upper.lo)) && !gap.closed
    };
    gaps.iter().find(holds).map(|gap| gap.m)
}

#[test]
fn the_map_labels_each_pair_by_the_tongue_that_holds_it() {
    let x = |text: &str| parse("x", text).unwrap();
    let products = Products { label: true, ..Products::default() };
    // Rational stiffnesses, so that s = h1² L1 is compared exactly: weak, equal and strong coupling.
    for (lambda2, rho) in [("2/5", ratio(1, 25)), ("10", ratio(1, 1)), ("30", ratio(3, 1))] {
        let (d, h1, h2) = (x("1/24"), (x("1/24"), x("4/5")), (x("1/24"), x("5/2")));
        let grid = Grid::new(x("10"), x(lambda2), [d.clone(), d], h1, h2).unwrap();
        let mut unstable = 0;
        Map::of(&grid)
            .with(products)
            .for_each_band(|_, band| {
                let mut labels = vec![None; band.verdicts.len()];
                band.growing.iter().for_each(|pair| labels[pair.position as usize] = pair.label);
                for (n, label) in labels.into_iter().enumerate() {
                    let (i, j) = band.multipliers(&grid, n);
                    let (p, q) = lowest_terms(j, i);
                    let s = ratio((i * i) as i64, 24 * 24) * ratio(10, 1);
                    let gaps = tongues(p, q, &rho).all()?;
                    assert_eq!(label, tongue_around(&gaps, &s), "{p}/{q}, rho = {rho}, s = {s}");
                    unstable += u64::from(label.is_some());
                }
                Ok(())
            })
            .unwrap();
        assert!(unstable > 50, "{unstable}");
    }
}

#[test]
fn one_slow_kick_or_two_leave_an_edge_on_the_resonance() {
    let rho = ratio(3, 7);
    for p in 1..30 {
        let tongues = tongues(p, 1, &rho);
        for m in 1..p {
            let gap = tongues.gap(m).unwrap();
            let resonance = tongues.resonance(m, 200);
            let upper = gap.upper.unwrap();
            assert!(holds(&upper, resonance.mid_f64()));
            // Exactly, not nearly: sixty digits of the edge still hold it.
            let precise = tongues.refine(&upper, 50).unwrap();
            assert!(precise.lo <= resonance.upper() && resonance.lower() <= precise.hi);
            let row =
                tongues.row(&gap, &Wanted { exact: true, predicted: true, ..Wanted::default() }).unwrap();
            assert!(row.exact[1].is_some() && row.predicted.unwrap().side == Side::OnUpper);
        }
    }
    for p in (3..30).step_by(2) {
        let tongues = tongues(p, 2, &rho);
        for m in (2..p).step_by(2) {
            let gap = tongues.gap(m).unwrap();
            assert!(holds(&gap.upper.unwrap(), tongues.resonance(m, 100).mid_f64()));
            let row = tongues.row(&gap, &Wanted { predicted: true, ..Wanted::default() }).unwrap();
            assert_eq!(row.predicted.unwrap().side, Side::OnUpper);
        }
    }
}

#[test]
fn rational_edges_are_recognized() {
    // th = pi/3, pi/2, 2 pi/3: s = 1, 2, 3.
    for (p, m, s) in [(3, 1, 1), (2, 1, 2), (3, 2, 3), (9, 3, 1), (4, 2, 2)] {
        let tongues = tongues(p, 1, &ratio(1, 10));
        let gap = tongues.gap(m).unwrap();
        let row = tongues.row(&gap, &Wanted { exact: true, ..Wanted::default() }).unwrap();
        assert_eq!(row.exact[1], Some(ExactEdge::Rational(ratio(s, 1))));
    }
}

#[test]
fn without_a_slow_force_every_tongue_is_closed_on_its_resonance() {
    for (p, q) in [(5, 3), (1, 4), (8, 1), (3, 11), (30, 7)] {
        let tongues = tongues(p, q, &Rational::zero());
        let gaps = tongues.all().unwrap();
        assert_eq!(gaps.len() as u64, p);
        for gap in &gaps[..p as usize - 1] {
            let resonance = tongues.resonance(gap.m, 100).mid_f64();
            assert!(gap.closed && holds(&gap.lower, resonance) && holds(&gap.upper.unwrap(), resonance));
        }
        let last = gaps.last().unwrap();
        assert!(holds(&last.lower, 4.0) && last.upper.is_none());
    }
}

#[test]
fn a_tongue_lies_at_or_below_its_resonance() {
    // Edges fall as rho grows (masses do) and start on the resonance: the predicted point is never inside.
    for (p, q) in Ratio::up_to(14).map(Ratio::terms) {
        let tongues = tongues(p, q, &ratio(3, 4));
        for m in 1..p {
            let gap = tongues.gap(m).unwrap();
            let row = tongues.row(&gap, &Wanted { predicted: true, ..Wanted::default() }).unwrap();
            assert!(matches!(row.predicted.unwrap().side, Side::Above | Side::OnUpper), "{p}/{q}, m = {m}");
        }
    }
}

#[test]
fn the_peak_is_a_peak() {
    for (p, q, m) in [(7, 2, 4), (7, 1, 1), (5, 3, 3), (3, 8, 6)] {
        let rho = ratio(1, 25);
        let tongues = tongues(p, q, &rho);
        let gap = tongues.gap(m).unwrap();
        let peak = tongues.row(&gap, &Wanted { growth: true, ..Wanted::default() }).unwrap().peak.unwrap();
        let rate = |s: f64| {
            let clocks = TwoClocks::with_rho(Ratio::new(p, q).unwrap(), exact(s), rho.clone());
            let verdict = decide(&clocks, &Limits::default()).unwrap().verdict;
            let ln = growth(&clocks, verdict, &Limits::default())
                .unwrap()
                .ln_multiplier
                .map_or(0.0, |ln| ln.mid_f64());
            ln / (p as f64 * s.sqrt())
        };
        // The same number by the verdict's route; and no sample of the tongue exceeds it.
        assert!((rate(peak.s) - peak.rate).abs() < 1e-12 * peak.rate);
        let upper = gap.upper.unwrap().lo;
        let best = (1..200)
            .map(|k| rate(gap.lower.hi + (upper - gap.lower.hi) * f64::from(k) / 200.0))
            .fold(0.0, f64::max);
        assert!(best <= peak.rate * (1.0 + 1e-12) && best > 0.99 * peak.rate);
    }
}

/// Over all zeros s_k of the tongue's two entries: d ln E/d ln s = Σ s/(s − s_k), and 1 for the factor s of
/// C.
fn rise(tongues: &Tongues, m: u64, s: f64) -> f64 {
    let [a, b, c, d] = tongues.all_edges().unwrap();
    let (zeros, factor) = if m % 2 == 1 { ([a, d].concat(), 0.0) } else { ([b, c].concat(), 1.0) };
    zeros.iter().map(|edge| s / (s - 0.5 * (edge.lo + edge.hi))).sum::<f64>() + factor
}

#[test]
fn the_peak_is_where_the_zeros_of_the_entries_put_it_for_edges_decades_apart_too() {
    let wanted = Wanted { growth: true, ..Wanted::default() };
    let mut seen = 0;
    for decade in -12..=12 {
        let rho = Rational::from_integer(10.into()).pow(decade);
        for (p, q) in [(3, 2), (7, 3), (5, 6), (1, 4), (9, 8)] {
            let tongues = tongues(p, q, &rho);
            for gap in tongues.all().unwrap() {
                // Closer edges than that leave no nine digits to this test's differences.
                let Some(upper) = gap.upper.filter(|upper| upper.lo > 1.1 * gap.lower.hi) else { continue };
                let peak = tongues.row(&gap, &wanted).unwrap().peak.unwrap();
                let name = format!("{p}/{q}, m = {}, 10^{decade}: {peak:?}", gap.m);
                assert!(gap.lower.lo < peak.s && peak.s < upper.hi, "{name}");
                // The rate is largest where rise = w coth w, w = ln mu/2: nine digits of s, then.
                let w = 0.5 * peak.ln_multiplier;
                let balance = |s: f64| rise(&tongues.clone(), gap.m, s) - w / w.tanh();
                assert!(
                    balance(peak.s * (1.0 - 1e-9)) > 0.0 && balance(peak.s * (1.0 + 1e-9)) < 0.0,
                    "{name}"
                );
                // And that is ln mu there, by the verdict's route.
                let clocks = TwoClocks::with_rho(Ratio::new(p, q).unwrap(), exact(peak.s), rho.clone());
                let verdict = decide(&clocks, &Limits::default()).unwrap().verdict;
                let ln =
                    growth(&clocks, verdict, &Limits::default()).unwrap().ln_multiplier.unwrap().mid_f64();
                assert!((ln - peak.ln_multiplier).abs() < 1e-13 * ln, "{name}: {ln}");
                let rate = peak.ln_multiplier / (p as f64 * peak.s.sqrt());
                assert!((rate - peak.rate).abs() <= 2.0 * f64::EPSILON * rate, "{name}");
                let steps = std::f64::consts::LN_10 * q as f64 / peak.ln_multiplier;
                assert!((steps - peak.slow_steps_to_tenfold).abs() <= 2.0 * f64::EPSILON * steps, "{name}");
                seen += 1;
            }
        }
    }
    assert!(seen > 250, "{seen}");
}

#[test]
fn growth_next_to_a_closing_falls_with_the_width_and_never_to_zero() {
    // 5/3, m = 4 closes at rho = 114/55; on both sides ln mu is as the distance, to first order in it.
    let wanted = Wanted { growth: true, ..Wanted::default() };
    let ln = |hair: &Rational| {
        let tongues = tongues(5, 3, &(ratio(114, 55) + hair));
        let gap = tongues.gap(4).unwrap();
        tongues.row(&gap, &wanted).unwrap().peak.unwrap().ln_multiplier
    };
    let hair = |k: i32| Rational::from_integer(10.into()).pow(-k);
    let unit = ln(&hair(12)) / 1e-12;
    for k in 4..24 {
        for hair in [hair(k), -hair(k)] {
            let share = ln(&hair) / to_f64(&hair).abs() / unit;
            assert!((share - 1.0).abs() < 20.0 * 10f64.powi(-k) + 1e-10, "{k}: {share}");
        }
    }
}

#[test]
fn the_peak_of_a_tongue_thinner_than_any_double_is_told() {
    // Large multipliers in tongues of 1e-94 of their place: at their middle, by the digits of the edges.
    let tongues = tongues(47, 51, &ratio(1, 25));
    let thinnest = |a: &Gap, b: &Gap| a.width.0.total_cmp(&b.width.0);
    let gap = tongues.all().unwrap().into_iter().min_by(thinnest).unwrap();
    assert!(gap.width.1 < 1e-94 * gap.lower.lo);
    let peak = tongues.row(&gap, &Wanted { growth: true, ..Wanted::default() }).unwrap().peak.unwrap();
    let [lower, upper] = [gap.lower, gap.upper.unwrap()].map(|edge| tongues.refine(&edge, 110).unwrap());
    let middle = (lower.middle() + upper.middle()) / ratio(2, 1);
    let clocks = TwoClocks::with_rho("47/51".parse().unwrap(), middle, ratio(1, 25));
    let verdict = decide(&clocks, &Limits::default()).unwrap().verdict;
    let ln = growth(&clocks, verdict, &Limits::default()).unwrap().ln_multiplier.unwrap().mid_f64();
    assert!((ln - peak.ln_multiplier).abs() < 1e-15 * ln, "{ln}: {peak:?}");
}

#[test]
fn first_order_widths_and_growth_become_exact_as_rho_vanishes() {
    let wanted = Wanted { first_order: true, growth: true, ..Wanted::default() };
    let mut seen = 0;
    for (p, q) in [(7, 1), (7, 2), (7, 3), (23, 10), (19, 8), (16, 9)] {
        let tongues = tongues(p, q, &ratio(1, 1_000_000));
        for m in 1..p {
            let gap = tongues.gap(m).unwrap();
            let row = tongues.row(&gap, &wanted).unwrap();
            let (law, peak) = (row.first_order.unwrap(), row.peak.unwrap());
            let growth_ratio = peak.ln_multiplier / law.ln_multiplier;
            // The law's relative error is of order rho times the period's length.
            assert!(
                (law.width_ratio.0 - 1.0).abs() < 1e-3 && (law.width_ratio.1 - 1.0).abs() < 1e-3,
                "{p}/{q}, {m}: {law:?}"
            );
            assert!((growth_ratio - 1.0).abs() < 1e-3, "{p}/{q}, {m}: {growth_ratio}");
            seen += 1;
        }
    }
    assert_eq!(seen, 73);
}

fn found(p: u64, q: u64) -> Vec<Closing> {
    let found = closings(Ratio::new(p, q).unwrap(), &Search::default()).unwrap();
    assert!(found.complete, "{p}/{q}");
    found.closings
}

/// Far beyond the Verlet limit, where the two entries' zeros are nearly parallel.
#[test]
fn closings_of_high_tongues_end() {
    let high = closings(Ratio::new(11, 7).unwrap(), &Search { m: Some(16), ..Search::default() }).unwrap();
    assert!(high.complete && high.closings.len() == 1 && !high.closings[0].below_verlet);
}

/// Their half periods have so many kicks that balls in 512 bits lose all digits over a box, and edges so
/// close that doubles do not tell them.
#[test]
fn closings_of_longer_periods_end() {
    for (p, q) in [(29, 21), (31, 29)] {
        let (ratio, search) = (Ratio::new(p, q).unwrap(), Search { samples: 60, ..Search::default() });
        let found = closings(ratio, &search).unwrap();
        assert!(!found.complete && found.closings.len() > 2, "{p}/{q}: {}", found.closings.len());
        for own in &found.closings {
            let clocks = TwoClocks::with_rho(ratio, own.s.middle(), own.rho.middle());
            // The middle of the box is no closing but for rational ones, and Q is all but 1 or −1 there.
            let answer = decide(&clocks, &Limits::default()).unwrap();
            let off = answer.growth().unwrap().trace.mid_f64().abs() - 2.0;
            assert!(off.abs() < 1e-9, "{p}/{q}, m = {}: {off}", own.m);
        }
    }
}

// Ledger: closings; three ratios on a grid of rho and one exact closing; tongues computed before
#[test]
fn known_closings_come_out() {
    let closing = &found(5, 3)[0];
    assert_eq!((closing.m, closing.exact.clone()), (4, Some((ratio(11, 4), ratio(114, 55)))));
    assert!(closing.below_verlet);
    // Seen on a coarse grid of rho before: 5/4 m = 7 near 0.785 and 7/4 m = 5 near 0.68, 8/3 m = 4 near 2.0.
    for (p, q, m, rho) in [(5, 4, 7, 0.785), (7, 4, 5, 0.68), (8, 3, 4, 2.0)] {
        let closings = found(p, q);
        let closing = closings.iter().find(|closing| closing.m == m).unwrap();
        let at = to_f64(&closing.rho.middle());
        // That grid's spacing is 3.5 % of rho.
        assert!((at / rho - 1.0).abs() < 0.035, "{p}/{q}: {at}");
        let width = to_f64(&(closing.s.width() / &closing.s.lo));
        assert!(width < 1e-30);
    }
}

#[test]
fn one_or_two_slow_kicks_never_close() {
    for (p, q) in Ratio::up_to(11).map(Ratio::terms).filter(|(p, q)| p.min(q) <= &2) {
        assert!(found(p, q).is_empty(), "{p}/{q}");
    }
}

// Ledger: closings; all closings of four ratios; the clocks swapped
#[test]
fn swapping_the_clocks_inverts_the_closing_rho() {
    for (p, q) in [(5, 3), (5, 4), (7, 4), (8, 3)] {
        let mut own: Vec<(u64, f64)> = found(p, q).iter().map(|c| (c.m, to_f64(&c.rho.middle()))).collect();
        let wide = Search { rho: (ratio(1, 100), ratio(10_000, 1)), ..Search::default() };
        let other = closings(Ratio::new(q, p).unwrap(), &wide).unwrap().closings;
        let mut other: Vec<(u64, f64)> = other.iter().map(|c| (c.m, 1.0 / to_f64(&c.rho.middle()))).collect();
        own.sort_by(|a, b| a.partial_cmp(b).unwrap());
        other.sort_by(|a, b| a.partial_cmp(b).unwrap());
        assert_eq!(own.len(), other.len());
        for (a, b) in own.iter().zip(&other) {
            assert!(a.0 == b.0 && (a.1 / b.1 - 1.0).abs() < 1e-15);
        }
    }
}

#[test]
fn a_closed_tongue_is_proven_closed_and_its_neighbours_open() {
    let tongues = tongues(5, 3, &ratio(114, 55));
    let gaps = tongues.all().unwrap();
    let closed: Vec<u64> = gaps.iter().filter(|gap| gap.closed).map(|gap| gap.m).collect();
    assert_eq!(closed, [4]);
    let verdict =
        Decidable::half_signs(&TwoClocks::with_rho("5/3".parse().unwrap(), ratio(11, 4), ratio(114, 55)))
            .verdict();
    assert_eq!(verdict.kind(), Kind::Coexistence);
    // A hair beside, it is open, and thin.
    let beside = ratio(114, 55) + Rational::new(1.into(), num_bigint::BigInt::from(10).pow(30));
    let gap: Gap = Tongues::new("5/3".parse().unwrap(), &beside).unwrap().gap(4).unwrap();
    assert!(!gap.closed && gap.width.0 > 0.0 && gap.width.1 < 1e-28, "{gap:?}");
}

#[test]
fn tongues_far_thinner_than_doubles_are_open_all_the_same() {
    // Beyond the Verlet limit light masses vibrate alone: the two edges differ by tunnelling.
    let gaps = tongues(23, 20, &ratio(1, 1000)).all().unwrap();
    let thinnest = gaps.iter().map(|gap| gap.width).fold((1.0, 1.0), |a, b| if b.0 < a.0 { b } else { a });
    assert!(thinnest.0 > 0.0 && thinnest.1 < 1e-25, "{thinnest:?}");
    assert!(thinnest.1 <= 1.01 * thinnest.0 && gaps.iter().all(|gap| !gap.closed));
}

#[test]
fn a_survey_decides_every_tongue() {
    let survey = survey(24, &ratio(1, 25), 4).unwrap();
    assert_eq!(survey.ratios, Ratio::up_to(24).count() as u64);
    assert_eq!(survey.tongues, survey.open + survey.closed.len() as u64);
    assert_eq!(
        survey.predicted,
        survey.predicted_outside + survey.predicted_on_edge + survey.predicted_inside
    );
    assert_eq!(survey.predicted_inside, 0);
    assert_eq!(survey.thinnest.len(), 4);
    let counted: u64 = survey.width_ratios.iter().map(|spread| spread.count).sum();
    assert_eq!(counted, survey.predicted);
    // Every tongue m < p lies below s = 4, and m = p begins there or below.
    let at_least: u64 = Ratio::up_to(24).map(Ratio::p).sum();
    assert!(survey.tongues >= at_least);
}

#[test]
fn bad_input_is_told_so() {
    let negative = Tongues::new("7/3".parse().unwrap(), &ratio(-1, 25)).unwrap_err();
    assert_eq!(negative.kind(), ErrorKind::Input);
    assert!(negative.to_string().contains("map"), "{negative}");
    // One slow kick in 2^40 fast ones: too many to lay out, and no long period of both clocks.
    let long = Tongues::new(Ratio::new(1 << 40, 1).unwrap(), &ratio(1, 2)).unwrap();
    assert_eq!(long.gap(1).unwrap_err().kind(), ErrorKind::Budget);
    assert_eq!(long.select(&Selection::default()).unwrap_err().kind(), ErrorKind::Budget);
    let tongues = tongues(5, 3, &ratio(1, 2));
    assert!(tongues.gap(0).is_err() && tongues.gap(8).is_err());
    assert!(tongues.edges(Entry::B, 0, 1).is_err() && tongues.edges(Entry::B, 1, 9).is_err());
    let empty = Search { rho: (ratio(2, 1), ratio(1, 1)), ..Search::default() };
    assert!(closings("5/3".parse().unwrap(), &empty).is_err());
}

#[test]
#[ignore = "seconds in release mode"]
fn all_ratios_up_to_100_have_only_open_tongues_below_the_verlet_limit() {
    let survey = survey(100, &ratio(1, 25), 10).unwrap();
    assert!(survey.closed.is_empty());
    assert_eq!(survey.ratios, 3043);
}

#[test]
#[ignore = "seconds in release mode"]
fn string_edges_are_the_roots_of_the_entries_for_longer_periods() {
    for (p, q, rho) in [(29, 23, ratio(1, 25)), (31, 2, ratio(7, 3)), (19, 30, ratio(1, 1000))] {
        roots_are_edges(p, q, &rho);
    }
}

#[test]
fn polynomials_have_the_expected_degrees() {
    let polynomials: [Polynomial<Rational>; 4] = entries("5/3".parse().unwrap(), &ratio(2, 7));
    let total: usize = polynomials.iter().map(|f| f.degree().unwrap()).sum();
    assert_eq!(total, 2 * (5 + 3) - 3);
}

#[test]
fn windows_hold_what_all_tongues_show() {
    for (p, q, rho) in [(7, 3, ratio(1, 25)), (3, 11, ratio(2, 1)), (40, 1, ratio(1, 2)), (9, 4, ratio(0, 1))]
    {
        let all = Tongues::new(Ratio::new(p, q).unwrap(), &rho).unwrap().all().unwrap();
        for (lo, hi) in [(0.0, 1e300), (1.0, 1.5), (2.4, 2.4), (3.9, 400.0), (-1.0, 1e-9), (2.0, 1.0)] {
            let meets = |gap: &&Gap| gap.lower.lo <= hi && gap.upper.is_none_or(|upper| lo <= upper.hi);
            let expected: Vec<u64> = all.iter().filter(meets).map(|gap| gap.m).filter(|_| lo <= hi).collect();
            let exact = |x: f64| Laurent::from_rational(Rational::from_float(x).unwrap());
            let selection = Selection { s: Some((exact(lo), exact(hi))), ..Selection::default() };
            let found = Tongues::new(Ratio::new(p, q).unwrap(), &rho).unwrap().select(&selection).unwrap();
            assert_eq!(found.iter().map(|gap| gap.m).collect::<Vec<_>>(), expected, "{p}/{q}: {lo}..{hi}");
        }
    }
}

/// 2/1 at rho = 1: the first tongue begins at s = 2/3 and ends on the resonance s = 2.
#[test]
fn a_closed_window_holds_a_tongue_that_it_touches_and_none_that_is_a_hair_beyond() {
    let tongues = Tongues::new("2/1".parse().unwrap(), &ratio(1, 1)).unwrap();
    let labels = |lo: &Rational, hi: &Rational| -> Vec<u64> {
        let window = [lo, hi].map(|x| Laurent::from_rational(x.clone()));
        let [lo, hi] = window;
        let selection = Selection { s: Some((lo, hi)), ..Selection::default() };
        tongues.select(&selection).unwrap().iter().map(|gap| gap.m).collect()
    };
    let (begin, end, zero) = (ratio(2, 3), ratio(2, 1), ratio(0, 1));
    let hair = Rational::new(1.into(), num_bigint::BigInt::from(10).pow(60));
    assert_eq!(labels(&zero, &begin), [1]);
    assert_eq!(labels(&zero, &(&begin - &hair)), [0; 0]);
    assert_eq!(labels(&end, &end), [1]);
    assert_eq!(labels(&(&end + &hair), &(&end + &hair)), [0; 0]);
    // An irrational edge, 4 sin²(2 pi/7).
    let tongues = Tongues::new("7/2".parse().unwrap(), &ratio(1, 25)).unwrap();
    let upper = tongues.refine(&tongues.gap(4).unwrap().upper.unwrap(), 60).unwrap();
    let begins = |lo: &Rational| {
        let window = (Laurent::from_rational(lo.clone()), Laurent::from_rational(ratio(5, 2)));
        let found = tongues.select(&Selection { s: Some(window), ..Selection::default() }).unwrap();
        found.first().map(|gap| gap.m)
    };
    assert_eq!(begins(&upper.lo), Some(4));
    assert_ne!(begins(&(&upper.hi + &hair)), Some(4));
}

#[test]
fn a_family_is_that_of_the_labels() {
    let tongues = Tongues::new("31/12".parse().unwrap(), &ratio(1, 25)).unwrap();
    let selection = Selection { a: Some((1, 2)), b: Some((-9, -1)), ..Selection::default() };
    let found = tongues.select(&selection).unwrap();
    let expected: Vec<u64> = (1..=tongues.last())
        .filter(|&m| matches!(dominant_family("31/12".parse().unwrap(), m), (1..=2, -9..=-1)))
        .collect();
    assert!(!expected.is_empty());
    assert_eq!(found.iter().map(|gap| gap.m).collect::<Vec<_>>(), expected);
}
