//! Which steps are safe: the worked cases, bands of periods, and what the engines write.

mod levers;
mod molecules;
mod published;
mod units;

use kickdrift::advise::{
    Advice, Bound, Levels, Lever, Levers, Mode, Question, Scheme, Status, Unstable, Way,
};
use kickdrift::number::rational::{from_f64_exact, ratio, to_f64};
use kickdrift::number::{Rational, parse::parse_rational};
use kickdrift::report::advise::View;
use kickdrift::system::Limits;
use kickdrift::verdict::Kind;

fn scheme(steps: &str) -> Scheme {
    Scheme::new(steps.split(',').map(|step| parse_rational("step", step).unwrap()).collect()).unwrap()
}

fn ask(modes: &[&str], schemes: &[&str]) -> Advice {
    let read = |text: &&str| match text.contains(':') {
        true => Mode::from_bond(text, None).unwrap(),
        false => Mode::from_period(text).unwrap(),
    };
    let schemes = schemes.iter().map(|steps| scheme(steps)).collect();
    Question::new(modes.iter().map(read).collect(), schemes, ratio(1, 20)).unwrap().answer().unwrap()
}

/// Six significant digits, the enclosure being narrower.
fn six((lo, hi): (f64, f64)) -> String {
    let digits = |x: f64| format!("{x:.*}", (5 - x.abs().log10().floor() as i32) as usize);
    assert_eq!(digits(lo), digits(hi));
    digits(lo)
}

fn ends(interval: &Unstable) -> [String; 2] {
    [interval.lower, interval.upper.unwrap()].map(six)
}

const TWO: [&str; 2] = ["10fs", "40fs"];

#[test]
fn periods_of_10_and_40_fs_are_unstable_where_they_are_known_to_be() {
    for (steps, lower, upper) in
        [("1/2,4", "4.67680", "4.96793"), ("1/2,2", "4.58797", "4.87248"), ("1/2,5", "4.68754", "4.97946")]
    {
        let advice = ask(&TWO, &[steps]);
        assert_eq!(ends(advice.schemes[0].rows[0].first.as_ref().unwrap()), [lower, upper], "{steps}");
    }
    let advice = ask(&TWO, &["1/2,4"]);
    let row = &advice.schemes[0].rows[0];
    assert_eq!((row.found.kind, six(row.found.trace).as_str()), (Kind::Elliptic, "-1.72237"));
    let worst = row.first.as_ref().unwrap().worst.unwrap();
    assert_eq!(format!("{:.1}", worst.steps), "23.9");
    assert_eq!(row.above.as_ref().map(ends), row.first.as_ref().map(ends));
    assert_eq!((row.below.is_none(), advice.schemes[0].status), (true, Status::Caution));
}

#[test]
fn a_step_above_the_first_tongue_is_not_recommended_though_stable() {
    let advice = ask(&TWO, &["1/2,5"]);
    let (answer, row) = (&advice.schemes[0], &advice.schemes[0].rows[0]);
    assert_eq!((row.found.kind, answer.status), (Kind::Elliptic, Status::Island));
    assert_eq!(six(row.found.trace), "-1.99723");
    assert_eq!(row.below.as_ref().map(ends), row.first.as_ref().map(ends));
    assert_eq!((&answer.largest, &answer.safe), (&Some(ratio(4, 1)), &Some(ratio(3, 1))));
}

/// Of every ratio between the ends that are told, tried by trace, none is stable; a hundredth beyond them one
/// is.
#[test]
fn no_other_ratio_helps_where_all_between_two_ends_are_unstable() {
    for text in ["1/2,9/2", "1/2,24/5", "1/2,19/2", "1,14"] {
        let steps = scheme(text);
        let advice = ask(&TWO, &[text]);
        let row = &advice.schemes[0].rows[0];
        let Some((lo, hi)) = &row.ratios else {
            assert_ne!(row.found.kind, Kind::Hyperbolic, "{steps:?}");
            continue;
        };
        assert!(*lo <= steps.outer() / steps.inner() && steps.outer() / steps.inner() <= *hi);
        let unstable = |times: &Rational| {
            let outer = steps.inner() * times;
            let scheme = Scheme::new(vec![steps.inner().clone(), outer]).unwrap();
            let stiffness = TWO.map(|period| Mode::from_period(period).unwrap().stiffness).to_vec();
            let found = Levels { scheme: &scheme, stiffness }.decide(&Limits::default()).unwrap();
            found.kind == Kind::Hyperbolic
        };
        let width = hi - lo;
        assert!(to_f64(&width) > 0.5, "{steps:?}: only {lo} to {hi}");
        assert!((0..=60).all(|n| unstable(&(lo + &width * ratio(n, 60)))), "{steps:?}");
        let beyond = (1..40).any(|n| {
            let off = ratio(n, 1000);
            !unstable(&(lo - &off)) || !unstable(&(hi + &off))
        });
        assert!(beyond, "{steps:?}: {lo} to {hi} could be longer");
    }
}

/// R = 1/(1 − (π h/T)²) of one clock. With a slow force beside it the mean squares of the period's own
/// ellipse, over an orbit of it, say the same.
#[test]
fn a_stable_step_has_the_potential_energy_of_its_ellipse() {
    let advice = ask(&["10fs"], &["1/2", "1", "2", "3", "3.2"]);
    let told = advice.schemes.iter().map(|answer| answer.rows[0].bias.map(six));
    let exact = [0.5f64, 1.0, 2.0, 3.0].map(|h| 1.0 / (1.0 - (std::f64::consts::PI * h / 10.0).powi(2)));
    let exact = exact.map(|r| Some(six((r, r))));
    assert_eq!(exact[..3], ["1.02530", "1.10950", "1.65230"].map(|r| Some(r.into())));
    // Beyond T/π there is none.
    assert_eq!(told.collect::<Vec<_>>(), exact.into_iter().chain([None]).collect::<Vec<_>>());
    // Advised is h w = 1, rounded down: 1/(1 - 1/4).
    assert_eq!(
        advice.schemes[0].safe_bias.map(|(mode, bias)| (mode, six(bias))),
        Some((0, "1.33333".into()))
    );

    for (periods, steps, outer, count) in [(TWO, "1/2,4", 4.0, 8), (TWO, "2/3,2", 2.0, 3)] {
        let bias = ask(&periods, &[steps]).schemes[0].rows[0].bias.unwrap();
        let [fast, slow] = [10.0, 40.0].map(|t: f64| (2.0 * std::f64::consts::PI / t).powi(2));
        let (inner, mut x, mut v) = (outer / f64::from(count), 1.0, 0.0);
        let (mut xx, mut vv) = (0.0, 0.0);
        for _ in 0..200_000 {
            v -= outer / 2.0 * slow * x;
            for _ in 0..count {
                v -= inner / 2.0 * fast * x;
                x += inner * v;
                v -= inner / 2.0 * fast * x;
            }
            v -= outer / 2.0 * slow * x;
            (xx, vv) = (xx + x * x, vv + v * v);
        }
        // Means over 200,000 periods are off by their inverse over the sine of a turn.
        assert!((bias.0 / ((fast + slow) * xx / vv) - 1.0).abs() < 1e-4, "{steps}: {bias:?}");
    }
}

#[test]
fn flexible_water_is_fine_at_3_fs_cautioned_at_4_fs_refused_from_the_first_tongue_on() {
    let outer = ["3/8,3", "1/2,4", "0.5846,4.6768", "0.58461,4.67688", "0.6,4.8"];
    let advice = ask(&TWO, &outer);
    let status: Vec<Status> = advice.schemes.iter().map(|answer| answer.status).collect();
    use Status::{Caution, Near, Safe, Unstable};
    // 4.6768 fs is still below the edge, 4.67680...: but not for shorter periods.
    assert!(matches!(status[..], [Safe, Caution, Near | Unstable, Unstable, Unstable]), "{status:?}");
    let water = &advice.modes[0];
    assert_eq!([2, 3, 4].map(|parts| format!("{:.2}", water.part(parts).0)), ["5.00", "3.33", "2.50"]);
    assert_eq!(advice.fastest, 0);
}

#[test]
fn a_force_field_s_bond_has_the_limits_that_grompp_checks() {
    let advice = ask(&["OH:K=450kcal/mol/A^2,15.999,1.008", "40fs"], &["0.5,3"]);
    let bond = &advice.modes[0];
    let shown = [1, 3, 5, 10].map(|parts| format!("{:.2}", bond.part(parts).0));
    assert_eq!(shown, ["9.97", "3.32", "1.99", "1.00"]);
    assert_eq!(advice.schemes[0].status, Status::Safe);
    // A rational stiffness beside one with π²: their ratio is irrational, and enclosed.
    let first = advice.schemes[0].rows[0].first.as_ref().unwrap();
    assert!(first.lower.1 - first.lower.0 < 1e-14 && first.lower.0 > 4.5);
}

#[test]
fn constrained_hydrogens_leave_room_for_an_outer_step_of_4_fs() {
    // GROMACS: dt = 2 fs, factor 2; nothing is said of the slow forces.
    let advice = ask(&["19.45fs"], &["2,4"]);
    let answer = &advice.schemes[0];
    assert!(advice.silent && answer.status == Status::Safe);
    assert_eq!(format!("{:.2}", advice.modes[0].part(4).0), "4.86");
    // Stable for every slow force whose period is above this, proven: a slow force just below it takes it out
    // of the region.
    let needs = answer.needs.unwrap();
    let with = |slow: f64| {
        let modes = ["19.45fs".to_string(), format!("slow={slow:.6}fs")];
        let advice = ask(&modes.each_ref().map(String::as_str), &["2,4"]);
        advice.schemes[0].status
    };
    assert!(with(1.00001 * needs) == Status::Caution && with(0.99 * needs) > Status::Caution, "{needs}");
    // Its own step is 4 fs: h w <= 1 where its period is above 8 pi fs.
    assert!(with(25.14) == Status::Safe && with(25.12) == Status::Caution);
}

#[test]
fn a_period_alone_is_limited_by_half_of_it_less_the_coarseness_of_the_inner_step() {
    // T = 19.45 fs: T/2 = 9.725 fs for ever finer inner steps; p inner steps of T/pi sin(pi/2p) at the ratio
    // p.
    let edge = |steps: &str| {
        let advice = ask(&["19.45fs"], &[steps]);
        let lower = advice.schemes[0].rows[0].first.as_ref().unwrap().lower;
        six(lower)
    };
    assert_eq!([edge("2,4"), edge("1/2,4"), edge("1/10,4")], ["8.75558", "9.66263", "9.72250"]);
}

#[test]
fn on_three_clocks_every_unstable_interval_is_listed() {
    let base = [ratio(7, 10), ratio(1, 1), ratio(3, 1)];
    let periods = ["10fs", "40fs", "100fs"];
    let advice = ask(&periods, &["0.7,1,3"]);
    let row = &advice.schemes[0].rows[0];
    assert!(row.intervals.len() > 1, "{:?}", row.intervals);
    assert_eq!(row.first.as_ref(), row.intervals.first());
    // Between two neighbours it is stable, within each it is not: by the ladder, at the same ratios.
    let stiffness = periods.map(|text| Mode::from_period(text).unwrap().stiffness).to_vec();
    let kind = |outer: f64| {
        let factor = from_f64_exact(outer).unwrap() / &base[2];
        let scheme = Scheme::new(base.iter().map(|step| step * &factor).collect()).unwrap();
        let levels = Levels { scheme: &scheme, stiffness: stiffness.clone() };
        levels.decide(&Limits::default()).unwrap().kind
    };
    for (n, own) in row.intervals.iter().enumerate() {
        let upper = own.upper.unwrap();
        assert!(own.lower.1 - own.lower.0 < 1e-12 && upper.1 - upper.0 < 1e-12);
        assert_eq!(kind((own.lower.1 + upper.0) / 2.0), Kind::Hyperbolic, "{own:?}");
        if let Some(next) = row.intervals.get(n + 1) {
            assert!(own.label < next.label && upper.1 < next.lower.0);
            assert_eq!(kind((upper.1 + next.lower.0) / 2.0), Kind::Elliptic, "{own:?}");
        }
    }
}

#[test]
fn three_clocks_with_one_all_but_silent_have_the_intervals_of_two() {
    let (two, three) = (ask(&TWO, &["1/2,4"]), ask(&["10fs", "1000000000fs", "40fs"], &["1/2,1,4"]));
    let [two, three] = [&two, &three].map(|advice| &advice.schemes[0].rows[0].intervals);
    assert!(!two.is_empty() && two.len() <= three.len());
    for (a, b) in two.iter().zip(three) {
        let off = [a.lower.0 - b.lower.0, a.upper.unwrap().0 - b.upper.unwrap().0];
        assert!(a.label == b.label && off.iter().all(|off| off.abs() < 1e-10), "{a:?} {b:?}");
        let [x, y] = [a, b].map(|own| own.worst.unwrap().steps);
        assert!((x / y - 1.0).abs() < 1e-4, "{x} {y}");
    }
}

#[test]
fn friction_masks_a_resonance_from_where_it_is_told() {
    let modes = TWO.map(|text| Mode::from_period(text).unwrap()).to_vec();
    let ask = |rate: Rational| {
        let question = Question::new(modes.clone(), vec![scheme("0.48,4.8")], ratio(1, 20)).unwrap();
        question.with_friction(rate).unwrap().answer().unwrap().schemes.remove(0).rows.remove(0)
    };
    let mask = ask(ratio(1, 1000)).masking.unwrap();
    let (lo, hi) = (mask.grows, mask.least());
    // Between 38 and 39/ps, bisected to 10^-10.
    assert!(mask.stays() && 0.038 < lo && hi < 0.039 && hi - lo < 1e-11, "{mask:?}");
    let at = |x: f64| ask(from_f64_exact(x).unwrap()).is_damped;
    assert_eq!([at(0.999 * lo), at(1.001 * hi)], [Some(false), Some(true)]);
}

/// Periods of 1 and 1.0733 ps with steps of 310 and 2,480 fs are damped at 1.484 to 1.767/ps, and at no
/// larger friction.
#[test]
fn a_friction_beyond_those_that_mask_is_not_said_to() {
    let modes = ["bead=1ps", "slow=1.0733ps"].map(|text| Mode::from_period(text).unwrap()).to_vec();
    let question = Question::new(modes, vec![scheme("310,2480")], ratio(1, 20)).unwrap();
    let answer = question.with_friction(ratio(3, 1000)).unwrap().answer().unwrap();
    let masked: Vec<_> = answer.schemes[0].rows.iter().filter_map(|row| row.masking.as_ref()).collect();
    assert!(!masked.is_empty() && masked.iter().any(|mask| !mask.stays()), "{masked:?}");
    let rows =
        answer.schemes[0].rows.iter().filter(|row| row.masking.as_ref().is_some_and(|mask| !mask.stays()));
    assert!(rows.into_iter().all(|row| row.is_damped == Some(false)));
    let document = kickdrift::report::advise::document(View::Periods(&answer), None, &[]);
    let text = document.summary_text();
    assert!(text.contains("frictions of") && !text.contains("only a friction"), "{text}");
}

#[test]
fn three_clocks_that_are_no_multiples_are_still_decided() {
    let advice = ask(&["10fs", "40fs", "100fs"], &["0.7,1,3"]);
    let row = &advice.schemes[0].rows[0];
    assert_eq!((row.found.kind, six(row.found.trace).as_str()), (Kind::Elliptic, "0.715252"));
    assert_eq!(advice.schemes[0].rows.len(), 2);
}

/// 30,001 fast steps in a period: a silent slow clock has closed tongues only, which are not looked for one
/// by one.
#[test]
fn steps_that_all_but_agree_are_answered_by_what_is_shown_of_them() {
    let advice = ask(&["11fs"], &["3,3.0001"]);
    let row = &advice.schemes[0].rows[0];
    assert_eq!((row.found.kind, row.intervals.len(), row.below.is_none()), (Kind::Elliptic, 0, true));
    // The fast clock's own limit T/π, to which no further interval comes.
    let verlet = 11.0 / std::f64::consts::PI * 30001.0 / 30000.0;
    let lone = row.above.as_ref().unwrap();
    assert!((lone.lower.0 / verlet - 1.0).abs() < 1e-14 && lone.upper.is_none(), "{lone:?}");
}

#[test]
fn both_routes_find_the_same_first_edge() {
    // Two clocks by the vibrating string; the same as three, the middle one all but silent, by positive
    // orbits.
    let two = ask(&TWO, &["1/2,4"]);
    let three = ask(&["10fs", "1000000000fs", "40fs"], &["1/2,1,4"]);
    let edge = |advice: &Advice| advice.schemes[0].rows[0].first.as_ref().unwrap().lower;
    let (a, b) = (edge(&two), edge(&three));
    assert!((a.0 - b.0).abs() < 1e-12, "{a:?} {b:?}");
    assert!(a.1 - a.0 < 1e-14 && b.1 - b.0 < 1e-14);
}

/// |Tr Q| of velocity Verlet with n inner steps and a slow kick, in doubles: no part of the library.
fn trace(fast: f64, slow: f64, inner: f64, n: u64) -> f64 {
    let square = |period: f64| (2.0 * std::f64::consts::PI / period).powi(2);
    let (k, l) = (square(fast), square(slow));
    let mut sum = 0.0;
    for start in 0..2 {
        let mut state = [f64::from(1 - start), f64::from(start)];
        state[1] -= inner * n as f64 * l * state[0];
        for _ in 0..n {
            state[1] -= inner * k * state[0];
            state[0] += inner * state[1];
        }
        sum += state[start as usize];
    }
    sum
}

// Ledger: advice; 100_000 random members of four bands; the trace of a plain loop
#[test]
fn no_member_of_the_band_is_unstable_at_the_steps_that_are_recommended() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut members = 0;
    for (fast, slow, inner) in [(10.0, 40.0, 0.5), (9.0, 25.0, 0.25), (20.0, 31.0, 2.0), (10.1, 100.0, 1.0)] {
        let advice =
            ask(&[&format!("f={fast}fs"), &format!("s={slow}fs")], &[&format!("{inner},{}", 2.0 * inner)]);
        let largest = to_f64(advice.schemes[0].largest.as_ref().unwrap());
        let n = (largest / inner).round() as u64;
        for _ in 0..25_000 {
            let member = [fast, slow].map(|period| period * (0.95 + 0.1 * random()));
            // Longer slow periods than the band's are covered too, and so are all shorter steps.
            let size = random();
            let of = trace(member[0], member[1] * (1.0 + 9.0 * random() * random()), inner * size, n);
            assert!(of.abs() < 2.0 - 1e-9 || (size < 1e-3 && of < 2.0), "{member:?} {inner} {n}: {of}");
            members += 1;
        }
        // One inner step more and the shortest periods are unstable, or beyond an unstable interval.
        let more = ask(
            &[&format!("f={}fs", 0.95 * fast), &format!("s={}fs", 0.95 * slow)],
            &[&format!("{inner},{}", inner * (n + 1) as f64)],
        );
        assert!(more.schemes[0].status >= Status::Island, "{fast} {slow}");
    }
    assert_eq!(members, 100_000);
}

#[test]
fn the_bound_of_the_band_is_the_best_possible() {
    let advice = ask(&TWO, &["1/2,4"]);
    let (lo, hi) = advice.schemes[0].band_edge;
    assert!(hi - lo < 1e-14);
    // At a step a millionth above, the shortest periods of the band are unstable.
    let inner = Rational::from_integer(8.into()).recip() * from_f64_exact(hi * 1.000_001).unwrap();
    let outer = &inner * Rational::from_integer(8.into());
    let modes = ["9.5fs", "38fs"].map(|text| Mode::from_period(text).unwrap()).to_vec();
    let question = Question::new(modes, vec![Scheme::new(vec![inner, outer]).unwrap()], ratio(0, 1)).unwrap();
    assert_eq!(question.answer().unwrap().schemes[0].status, Status::Unstable);
}

#[test]
fn a_single_step_is_held_against_velocity_verlet() {
    let advice = ask(&["10fs"], &["1", "3.2"]);
    let [one, three] = &advice.schemes[..] else { unreachable!() };
    assert_eq!((one.status, three.status), (Status::Safe, Status::Unstable));
    let first = one.rows[0].first.as_ref().unwrap();
    assert!((first.lower.0 - 10.0 / std::f64::consts::PI).abs() < 1e-14 && first.upper.is_none());
}

#[test]
fn growth_is_told_per_time_and_against_the_length_of_the_run() {
    let modes = TWO.map(|text| Mode::from_period(text).unwrap()).to_vec();
    let ask = |length: i64| {
        let question = Question::new(modes.clone(), vec![scheme("0.48,4.8")], ratio(1, 20)).unwrap();
        question.of_length(ratio(length, 1)).unwrap().answer().unwrap().schemes.remove(0)
    };
    let answer = ask(1_000_000);
    let (lo, hi) = answer.rows[0].found.rate;
    // 19.43/ps.
    assert!(0.019_425 < lo && hi < 0.019_435 && hi - lo < 1e-12, "{lo} {hi}");
    assert_eq!(
        (answer.status, answer.within_run, ask(100).within_run),
        (Status::Unstable, Some(true), Some(false))
    );
    assert_eq!(answer.rows[0].inside.as_ref().map(|inside| inside.label), Some(1));
}

#[test]
fn sums_of_two_modes_lie_between_their_own_resonances() {
    let advice = ask(&["OH=9fs", "CH=11fs", "40fs"], &["0.5,4"]);
    let pairs = &advice.schemes[0].pairs;
    assert_eq!((pairs.len(), pairs[0].modes), (1, [0, 1]));
    assert!(4.5 < pairs[0].near && pairs[0].near < 5.5, "{pairs:?}");
    assert_eq!(advice.schemes[0].rows.len(), 2);
}

#[test]
fn a_question_that_makes_no_sense_says_what_would() {
    let mode = |text: &str| Mode::from_period(text).unwrap();
    let ask = |modes: Vec<Mode>, schemes: Vec<Scheme>| {
        Question::new(modes, schemes, ratio(1, 20)).unwrap_err().to_string()
    };
    let one = || vec![scheme("1,2")];
    let on = |clock| vec![Mode { clock: Some(clock), ..mode("10fs") }];
    let cases = [
        (ask(vec![], one()), "period missing"),
        (ask(vec![mode("1fs")], vec![]), "steps missing"),
        (ask(on(7), one()), "choose a clock from 1 to 2"),
        (ask(vec![mode("1fs"), mode("1fs")], one()), "give each its own"),
        (ask(vec![mode("1fs")], vec![scheme("1"), scheme("1,2")]), "as many steps"),
    ];
    for (message, expected) in cases {
        assert!(message.contains(expected), "{message}");
    }
    for steps in [vec![], vec![ratio(2, 1), ratio(1, 1)], vec![ratio(0, 1)], vec![ratio(1, 1), ratio(1, 1)]] {
        assert!(Scheme::new(steps).unwrap_err().field().contains("steps"));
    }
}

/// With friction a clock that nothing is known to be on parts the drifts all the same.
#[test]
fn a_silent_clock_damps_as_one_that_is_hardly_heard() {
    let damped = |slow: &str| {
        let modes = ["OH=10fs", slow].into_iter().map(|text| Mode::from_period(text).unwrap());
        let modes = modes.take(if slow.is_empty() { 1 } else { 2 }).collect();
        // Above the limit of the inner step alone: growth that only friction stops.
        let scheme = Scheme::new(vec![ratio(33, 10), ratio(66, 10)]).unwrap();
        let question = Question::new(modes, vec![scheme], ratio(1, 20)).unwrap();
        let answer = question.with_friction(ratio(1, 2)).unwrap().answer().unwrap();
        let row = &answer.schemes[0].rows[0];
        (row.is_damped, row.masking.clone())
    };
    let ((alone, mask), (heard, near)) = (damped(""), damped("x=1000000000fs"));
    assert_eq!(alone, heard);
    if let (Some(a), Some(b)) = (mask, near) {
        assert!((a.least() / b.least() - 1.0).abs() < 1e-6, "{a:?} {b:?}");
    }
}

#[test]
fn a_length_that_is_not_positive_is_refused() {
    let question = || {
        let scheme = Scheme::new(vec![ratio(1, 2), ratio(4, 1)]).unwrap();
        Question::new(vec![Mode::from_period("OH=10fs").unwrap()], vec![scheme], ratio(1, 20)).unwrap()
    };
    for bad in [ratio(0, 1), ratio(-7, 1)] {
        assert!(question().of_length(bad.clone()).unwrap_err().to_string().starts_with("length = "));
        assert!(question().with_friction(bad).is_err());
    }
}
