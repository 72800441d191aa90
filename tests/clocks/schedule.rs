//! Schedules.

use kickdrift::number::{Ratio, Rational};
use kickdrift::schedule::*;

fn r(n: i64, d: i64) -> Rational {
    Rational::new(n.into(), d.into())
}

/// The kick times of a span as (time, kicks, weight), events without kicks left out.
fn kicks(events: Events) -> Vec<(u64, u64, Weight)> {
    let timed = events.scan(0, |now, e| {
        *now += e.drift;
        Some((*now, e.kicks, e.weight))
    });
    timed.filter(|&(_, kicks, _)| kicks != 0).collect()
}

#[test]
fn one_period_holds_p_fast_and_q_slow_kicks_at_p_plus_q_minus_1_times() {
    for (p, q) in [(1, 1), (2, 1), (1, 3), (7, 5), (12, 35), (3499, 631)] {
        let schedule = Schedule::two_clocks(Ratio::new(p, q).unwrap()).unwrap();
        let times = kicks(schedule.staggered_period());
        assert_eq!(times.len() as u64, p + q - 1);
        assert_eq!(times.iter().filter(|t| t.1 & 1 != 0).count() as u64, p);
        assert_eq!(times.iter().filter(|t| t.1 & 2 != 0).count() as u64, q);
        assert_eq!(schedule.strikes(), p + q);
    }
}

#[test]
fn phases_0_and_one_half_make_palindromes_and_others_do_not() {
    let mirrored = |schedule: &Schedule| {
        let times = kicks(schedule.symmetric_period());
        let back = times.iter().rev().map(|&(t, k, w)| (schedule.period() - t, k, w)).collect::<Vec<_>>();
        times == back
    };
    for (steps, phases) in [
        ([r(1, 1), r(7, 3)], [r(0, 1), r(0, 1)]),
        ([r(1, 1), r(7, 3)], [r(0, 1), r(1, 2)]),
        ([r(2, 5), r(6, 1)], [r(1, 2), r(1, 2)]),
        ([r(2, 5), r(6, 1)], [r(1, 3), r(1, 2)]),
        ([r(1, 1), r(1, 1)], [r(0, 1), r(1, 4)]),
    ] {
        let schedule = Schedule::new(&steps, &phases).unwrap();
        assert_eq!(mirrored(&schedule), schedule.is_palindrome(), "{steps:?} {phases:?}");
    }
}

#[test]
fn a_kick_stands_at_half_time_iff_p_or_q_is_even() {
    for (p, q) in [(3, 2), (2, 3), (5, 3), (1, 1), (4, 1)] {
        let schedule = Schedule::two_clocks(Ratio::new(p, q).unwrap()).unwrap();
        let last = schedule.half_period().last().unwrap();
        assert_eq!(last.kicks != 0, p % 2 == 0 || q % 2 == 0, "{p}/{q}");
    }
}

#[test]
fn bad_clocks_are_refused() {
    assert!(Schedule::new(&[], &[]).is_err());
    assert!(Schedule::new(&[r(0, 1)], &[r(0, 1)]).is_err());
    assert!(Schedule::new(&[r(1, 1)], &[r(1, 1)]).is_err());
    assert!(Schedule::two_clocks(Ratio::new((1 << 40) + 1, 1 << 40).unwrap()).is_err());
}
