//! What is published stands where it is valid, and nothing is called safe without a fast period.

use super::*;
use kickdrift::advise::unit::TimeUnit;
use kickdrift::advise::{Beads, FAST, OF_ONE, Place, Typical, shortest_of};

fn question(modes: &[&str], schemes: &[&str]) -> Question {
    let modes = modes.iter().map(|text| Mode::from_period(text).unwrap()).collect();
    Question::new(modes, schemes.iter().map(|steps| scheme(steps)).collect(), ratio(1, 20)).unwrap()
}

#[test]
fn without_a_fast_period_nothing_is_called_safe() {
    let cases: [(&[&str], &str); 6] = [
        (&["slow=water"], "1/2,4"),
        (&["slow=40fs"], "1/2,4"),
        (&["slow=40fs"], "4"),
        (&["peptide"], "4"),
        (&["slow1=40fs", "slow2=100fs"], "1/2,1,4"),
        (&["Slow=5fs"], "1/2,4"),
    ];
    for (modes, steps) in cases {
        let advice = question(modes, &[steps]).with_levers(true).answer().unwrap();
        let own = &advice.schemes[0];
        assert!(advice.lacks_fast && own.status == Status::Undecided, "{modes:?} {steps}: {:?}", own.status);
        assert_eq!((&own.safe, &own.largest, own.needs), (&None, &None, None), "{modes:?}");
        assert!(advice.levers.unwrap().rows.is_empty(), "{modes:?}");
    }
    // What is put on the fast clock is there.
    let mut mode = Mode::from_period("slow=40fs").unwrap();
    mode.clock = Some(0);
    let advice = Question::new(vec![mode], vec![scheme("1/2,4")], ratio(1, 20)).unwrap().answer().unwrap();
    assert!(!advice.lacks_fast && advice.schemes[0].status == Status::Safe);
}

#[test]
fn a_mode_that_is_called_fast_or_slow_is_on_that_clock_wherever_it_stands() {
    for modes in [["slow=40fs", "OH=10fs"], ["40fs", "fast=10fs"], ["slow=water", "fast=water"]] {
        let advice = question(&modes, &["1/2,4"]).answer().unwrap();
        let clocks: Vec<usize> = advice.modes.iter().map(|mode| mode.clock.unwrap()).collect();
        assert_eq!(clocks, [1, 0], "{modes:?}");
    }
}

/// Every name is one of a mode, on the fast clock; held bonds are slower than free ones, and hydrogens that
/// are heavy too.
#[test]
fn typical_fast_periods_are_asked_for_by_name() {
    for own in &FAST {
        let mode = Mode::from_period(&own.asked()).unwrap();
        assert_eq!(mode.stiffness, Mode::from_period(&format!("{}fs", own.period)).unwrap().stiffness);
        assert!(mode.is_called_fast() && mode.origin.name() == own.origin && !own.source.is_empty());
    }
    let period = |name: &str| Typical::of("fast", name).unwrap().period.parse::<f64>().unwrap();
    for kind in ["protein", "dna", "lipid"] {
        let [free, held, heavy] = ["", ",h-bonds", ",hmr3"].map(|way| period(&format!("{kind}{way}")));
        assert!(free < heavy && heavy < held, "{kind}");
    }
    // The water that moves in data/scenes/flexible-water.json has 8.914 fs as its shortest.
    assert!((period("water") / 8.914 - 1.0).abs() < 0.01);
    let error = Mode::from_period("fast=proteins").unwrap_err().to_string();
    assert!(error.contains("fast=protein,h-bonds") && error.contains("slow=water"), "{error}");
}

/// At each published step velocity Verlet is back where it began after k steps, and none lies beyond T/π.
#[test]
fn the_resonances_of_one_clock_stand_at_the_turns_of_the_method() {
    let mode = Mode::from_period("10fs").unwrap();
    let w = 2.0 * std::f64::consts::PI / 10.0;
    for own in OF_ONE {
        let Place::Turn(k) = own.place else { panic!("of one clock: {own:?}") };
        let (lo, hi) = mode.at(own.place);
        assert!(hi < 10.0 / std::f64::consts::PI && hi - lo < 1e-14, "{lo} {hi}");
        let (mut x, mut v) = (1.0, 0.3);
        for _ in 0..k {
            v -= lo / 2.0 * w * w * x;
            x += lo * v;
            v -= lo / 2.0 * w * w * x;
        }
        // A few roundings.
        assert!((x - 1.0f64).abs() < 1e-12 && (v - 0.3f64).abs() < 1e-12, "{k}: {x} {v}");
    }
}

/// O-H of q-TIP4P/F: the quartic bond, from 48 phases of an energy in kT at 298 K, under velocity Verlet.
/// Whether one leaves in 20,000 steps.
fn loses(step: f64, energy: f64) -> bool {
    // kJ/mol, 1/nm, amu, ps.
    let (d, a, mu, kt): (f64, f64, f64, f64) = (485.72, 22.87, 0.94825, 2.4777);
    let force = |x: f64| {
        let y = a * x;
        -d * a * (2.0 * y - 3.0 * y * y + 7.0 / 3.0 * y * y * y)
    };
    let (k, h) = (2.0 * d * a * a, step / 1000.0);
    (0..48).any(|phase| {
        let angle = 2.0 * std::f64::consts::PI * (f64::from(phase) + 0.5) / 48.0;
        let mut x = (2.0 * energy * kt / k).sqrt() * angle.cos();
        let mut v = (2.0 * energy * kt / mu).sqrt() * angle.sin();
        (0..20_000).any(|_| {
            v += h / 2.0 * force(x) / mu;
            x += h * v;
            v += h / 2.0 * force(x) / mu;
            x.is_nan() || x.abs() > 1.0
        })
    })
}

#[test]
fn a_single_step_is_advised_where_an_anharmonic_bond_stays() {
    let of = |harmonic: bool| {
        let advice = question(&["OH=8.5836fs"], &["1", "2"]).with_harmonic_bonds(harmonic).answer().unwrap();
        let status: Vec<Status> = advice.schemes.iter().map(|own| own.status).collect();
        (to_f64(advice.schemes[0].safe.as_ref().unwrap()), advice.schemes[0].bound.unwrap(), status)
    };
    let (safe, bound, status) = of(false);
    assert_eq!((bound, &status[..]), (Bound::Turn, &[Status::Safe, Status::Caution][..]));
    assert!((safe - 8.5836 / (2.0 * std::f64::consts::PI)).abs() < 1e-12, "{safe}");
    // 20 kT is what a bond in a box of 10,000 sees in 100 ns; at the proven limit 1 kT is too much.
    let (proven, by_band, status) = of(true);
    assert_eq!((by_band, &status[..]), (Bound::Band, &[Status::Safe, Status::Safe][..]));
    assert!(!loses(safe, 20.0) && loses(proven, 1.0), "{safe} {proven}");
}

#[test]
fn an_inner_step_is_advised_below_its_own_bound_too() {
    // 1.65 fs is above 10 fs/6.28 = 1.59 fs, 3.3 fs below 10 fs/3.
    let of = |harmonic: bool| {
        question(&["10fs", "100fs"], &["1.65,3.3"])
            .with_harmonic_bonds(harmonic)
            .answer()
            .unwrap()
            .schemes
            .remove(0)
    };
    let (own, lifted) = (of(false), of(true));
    assert_eq!((own.status, &own.safe, &own.largest), (Status::Caution, &None, &Some(ratio(33, 10))));
    assert_eq!((lifted.status, &lifted.safe), (Status::Safe, &Some(ratio(33, 10))));
    // A clock between has forces of its own.
    let own = question(&["10fs", "5fs", "100fs"], &["1/2,1,2"]).answer().unwrap().schemes.remove(0);
    assert!(own.status > Status::Safe && own.safe.is_none(), "{:?}", own.status);
}

#[test]
fn the_slow_force_has_one_bound_whatever_moves_the_fast_ones() {
    let all = super::levers::of(&["10fs", "12fs"], "1/4,1", |own| own.with_harmonic_bonds(true));
    // 12 fs/6.28 = 1.9099 fs is below 10 fs/3.
    for own in all.rows.iter().filter(|own| !own.name.starts_with("ratio ")) {
        let (step, bound) = own.step.clone().unwrap();
        assert!(
            bound == Bound::SlowTurn && step < ratio(191, 100) && step >= ratio(7, 4),
            "{}: {step} {bound:?}",
            own.name
        );
    }
    assert_eq!(question(&["10fs", "12fs"], &["1/4,2"]).answer().unwrap().schemes[0].status, Status::Caution);
}

#[test]
fn all_columns_of_a_lever_belong_to_one_ratio() {
    let mut seen = 0;
    for (modes, steps) in [
        (TWO, "1/2,4"),
        (TWO, "1/2,8"),
        (["10fs", "12fs"], "1/4,1"),
        (["11fs", "20fs"], "1,3"),
        (["10fs", "14fs"], "3/2,3"),
    ] {
        let all = super::levers::of(&modes, steps, |own| own);
        for own in &all.rows {
            let (Some((step, _)), Some(edge)) = (&own.step, own.band_edge) else { continue };
            assert!(to_f64(step) < edge.0, "{} of {steps}: {step} {edge:?}", own.name);
            let Some(inner) = own.inner.as_ref().filter(|inner| own.way == Way::Respa && **inner < *step)
            else {
                continue;
            };
            let at = ask(&modes, &[&format!("{inner},{step}")]);
            let (here, there) = (at.schemes[0].rows[0].first.as_ref().unwrap().lower.0, own.first.unwrap().0);
            // Both are ends of enclosures, scaled from steps of different lengths: a few roundings apart.
            assert!((here / there - 1.0).abs() < 1e-14, "{} of {steps}: {here} {there}", own.name);
            seen += 1;
        }
    }
    assert!(seen > 40, "{seen}");
}

#[test]
fn the_advice_on_ring_polymers_is_of_their_centroids_alone() {
    let beads = Beads { count: 16, kelvin: Some(ratio(300, 1)) };
    let of = |count: u64| {
        question(&TWO, &["1/2,3"]).with_beads(Some(Beads { count, ..beads.clone() })).answer().unwrap()
    };
    let (one, many) = (of(1), of(16));
    assert_eq!([one.schemes[0].status, many.schemes[0].status], [Status::Safe, Status::Undecided]);
    assert!(many.schemes[0].safe.is_none() && many.beads.is_some());
    // 16 beads at 300 K are unstable up to 2.4996 fs, half the period of the top ring mode.
    assert_eq!(format!("{:.4}", beads.ends().unwrap()[0] / 2.0), "2.4996");
}

#[test]
fn a_clock_between_without_a_period_makes_the_answer_depend_on_it() {
    let of = |middle: Option<f64>| {
        let mut modes = vec![Mode::from_period("10fs").unwrap(), Mode::from_period("slow=100fs").unwrap()];
        modes.extend(middle.map(|period| Mode {
            clock: Some(1),
            ..Mode::from_period(&format!("m={period:.6}fs")).unwrap()
        }));
        Question::new(modes, vec![scheme("1/2,1,3")], ratio(1, 20))
            .unwrap()
            .answer()
            .unwrap()
            .schemes
            .remove(0)
    };
    let open = of(None);
    let needs = open.needs.unwrap();
    assert!(open.status == Status::Safe && open.safe.is_none() && open.largest.is_none());
    assert!(
        of(Some(1.0001 * needs)).status <= Status::Caution && of(Some(0.99 * needs)).status > Status::Caution,
        "{needs}"
    );
    assert!((shortest_of(1.0) - 2.0 * std::f64::consts::PI).abs() < 1e-14);
}

#[test]
fn plain_times_are_answered_as_femtoseconds_are() {
    let of = |plain: bool| {
        let read = |text: &str| {
            if plain { Mode::from_plain_period(text) } else { Mode::from_period(&format!("{text}fs")) }
        };
        let modes = ["bond=0.2", "slow=0.8"].map(|text| read(text).unwrap()).to_vec();
        let question =
            Question::new(modes, vec![scheme("0.01,0.08")], ratio(1, 20)).unwrap().with_levers(true);
        let unit = if plain { TimeUnit::Plain } else { TimeUnit::Femtoseconds };
        question.in_units_of(unit).answer().unwrap()
    };
    let (plain, fs) = (of(true), of(false));
    assert_eq!(
        (plain.schemes[0].status, &plain.schemes[0].safe),
        (fs.schemes[0].status, &fs.schemes[0].safe)
    );
    assert_eq!(plain.schemes[0].rows[0].first, fs.schemes[0].rows[0].first);
    // In fs no multiple of 0.01 fs would do; a plain step is a multiple of about a thousandth of the period.
    let ratio_4 = plain.levers.unwrap().rows.into_iter().find(|own| own.name == "ratio 4").unwrap();
    assert_eq!(ratio_4.step, Some((ratio(664, 10_000), Bound::Third)));
    let error = Mode::from_plain_period("bond=0.2fs").unwrap_err().to_string();
    assert!(error.contains("write all times as plain numbers"), "{error}");
}
