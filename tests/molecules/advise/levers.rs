//! What would let the step grow.

use super::*;
use kickdrift::advise::unit::TimeUnit;

pub fn of(modes: &[&str], steps: &str, change: impl Fn(Question) -> Question) -> Levers {
    let read = |text: &&str| match text.contains(':') {
        true => Mode::from_bond(text, None).unwrap(),
        false => Mode::from_period(text).unwrap(),
    };
    let question =
        Question::new(modes.iter().map(read).collect(), vec![scheme(steps)], ratio(1, 20)).unwrap();
    change(question.with_levers(true)).answer().unwrap().levers.unwrap()
}

fn named<'a>(levers: &'a Levers, name: &str) -> &'a Lever {
    levers.rows.iter().find(|own| own.name == name).unwrap_or_else(|| panic!("no row {name}"))
}

/// Periods 10 and 40.
#[test]
fn what_lets_the_step_grow_of_periods_of_10_and_40_fs() {
    let all = of(&TWO, "1/2,4", |own| own);
    let first = |name: &str| six(named(&all, name).first.unwrap());
    // The step that is taken is 6 of 0.5 fs: all columns are of that ratio.
    assert_eq!(first("as given"), first("ratio 6"));
    assert_eq!(first("ratio 8"), "4.67680");
    assert_eq!(first("ratio 4"), "4.58797");
    assert_eq!(first("ratio 10"), "4.68754");
    let four = |name: &str| format!("{:.4}", named(&all, name).first.unwrap().0);
    assert_eq!(["short-average MOLLY", "linear-average MOLLY"].map(four), ["4.8703", "4.9470"]);
    let long = named(&all, "long-average MOLLY");
    assert!(long.is_free && long.first.is_none());
    // Half the shortest period: beyond it two modes might meet.
    assert_eq!(six(long.band_edge.unwrap()), "4.75000");
    let implicit = named(&all, "implicit-explicit");
    assert_eq!(implicit.exact.as_ref().unwrap().to_string(), "40/pi");
    assert_eq!(six(implicit.first.unwrap()), "12.7324");
    assert_eq!(implicit.step, Some((ratio(636, 100), Bound::SlowTurn)));
    assert_eq!(
        (implicit.inner.clone(), implicit.solves_per_ps(TimeUnit::Femtoseconds)),
        (None, Some(ratio(100_000, 636)))
    );
    let given = named(&all, "as given");
    assert_eq!(
        (given.step.clone(), given.fast_per_ps(TimeUnit::Femtoseconds)),
        (Some((ratio(3, 1), Bound::Third)), Some(ratio(2000, 1)))
    );
    // Today's longest step is 3.33 at the ratio 3.
    assert_eq!(implicit.gain, Some(ratio(636, 333)));
    assert_eq!(all.rows.iter().filter(|own| own.name.starts_with("ratio")).count(), 15);
    assert!(all.rows.iter().all(|own| own.gain.as_ref().is_some_and(|gain| *gain > ratio(1, 2))));
}

/// The edges of the band, decided by the ladder at a thousandth to either side, at the corner of the band;
/// all steps taken are stable.
#[test]
fn the_rows_of_kicks_and_drifts_hold_at_the_corner_of_the_band() {
    let bond = "OH:K=450kcal/mol/A^2,15.999,1.008";
    let all = of(&[bond, "40fs"], "1/2,3", |own| own);
    let mut seen = 0;
    for own in all.rows.iter().filter(|own| matches!(own.way, Way::Respa | Way::Hydrogens)) {
        let mass = own.name.strip_prefix("hydrogens of ").and_then(|rest| rest.strip_suffix(" amu"));
        let mass = mass.map(|mass| parse_rational("mass", mass).unwrap());
        let modes = [Mode::from_bond(bond, mass.as_ref()).unwrap(), Mode::from_period("40fs").unwrap()];
        let (taken, _) = own.step.clone().unwrap();
        let p = &taken / own.inner.as_ref().unwrap();
        let shorter = kickdrift::number::Laurent::from_rational(ratio(400, 361));
        let stiffness = modes.iter().map(|mode| &mode.stiffness * &shorter).collect::<Vec<_>>();
        let stable = |outer: Rational| {
            let scheme = Scheme::new(vec![&outer / &p, outer]).unwrap();
            let found =
                Levels { scheme: &scheme, stiffness: stiffness.clone() }.decide(&Limits::default()).unwrap();
            found.kind == Kind::Elliptic
        };
        let edge = from_f64_exact(own.band_edge.unwrap().0).unwrap();
        assert!(stable(&edge * ratio(999, 1000)) && !stable(&edge * ratio(1001, 1000)), "{}", own.name);
        assert!(taken < edge && stable(taken), "{}", own.name);
        seen += 1;
    }
    assert_eq!(seen, 18);
}

#[test]
fn what_cannot_be_computed_is_left_out_with_its_reason() {
    let left = |all: &Levers, what: &str| all.left_out.iter().any(|own| own.contains(what));
    let all = of(&TWO, "1/2,4", |own| own);
    assert!(
        left(&all, "heavy hydrogens: 10fs without masses")
            && left(&all, "h-bonds held: no mode is given as a bond")
    );
    let all = of(&["OH:K=450kcal/mol/A^2,15.999,1.008", "40fs"], "1/2,3", |own| own);
    assert!(left(&all, "h-bonds held: no other mode is on the fast clocks"));
    let all = of(&["10fs"], "1/2,4", |own| own);
    assert!(all.rows.is_empty() && left(&all, "a clock has no period"));
    let all = of(&["10fs"], "1/2", |own| own);
    assert!(all.rows.len() == 1 && left(&all, "there is one clock"));
    assert_eq!(all.rows[0].step, Some((ratio(159, 100), Bound::Turn)));
    let all = of(&["10fs", "40fs", "100fs"], "0.7,1,3", |own| own);
    assert!(left(&all, "no multiple") && left(&all, "computed for two clocks"));
    // Four hydrogens of 4 amu would leave an atom of 10 no mass.
    let all = of(&["XH:K=340kcal/mol/A^2,10,1.008,4", "40fs"], "1/2,3", |own| own);
    assert!(all.rows.iter().any(|own| own.name == "hydrogens of 3.024 amu"));
    assert!(left(&all, "hydrogens of 4 amu"), "{:?}", all.left_out);
}

/// With 1/ps: every multiple up to the step is damped, the next one is not.
#[test]
fn a_friction_masks_up_to_a_step() {
    let rate = ratio(1, 1000);
    let all = of(&TWO, "0.48,4.8", |own| own.with_friction(ratio(1, 1000)).unwrap());
    let own = named(&all, "friction 1/ps");
    assert_eq!(own.step, Some((ratio(432, 100), Bound::Friction)));
    let modes = TWO.map(|text| Mode::from_period(text).unwrap().stiffness);
    let damped = |p: i64| {
        let scheme = Scheme::new(vec![ratio(48, 100), ratio(48 * p, 100)]).unwrap();
        Levels { scheme: &scheme, stiffness: modes.to_vec() }.is_damped_by(&rate)
    };
    assert!((2..=9).all(|p| damped(p) == Some(true)) && damped(10) == Some(false));
}
