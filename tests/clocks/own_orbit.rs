//! About the integrator's own periodic orbit beside an equilibrium.

use kickdrift::avi::Ends;
use kickdrift::scene::SystemScene;
use kickdrift::system::{Instability, Limits, Origin, OwnOrbit, Route, middle};

/// Two stiff bonds in tension, ten inner steps in an outer one of `thousandths`/1000.
fn in_tension(thousandths: u32) -> SystemScene {
    let text = std::fs::read_to_string("data/scenes/tension.json").unwrap();
    let text = text
        .replace("\"3/100\"", &format!("\"{thousandths}/10000\""))
        .replace("\"3/10\"", &format!("\"{thousandths}/1000\""));
    SystemScene::read(&text).unwrap()
}

fn orbit(scene: &SystemScene) -> OwnOrbit {
    scene.own_orbit(&Limits::default()).unwrap().expect("beside the equilibrium")
}

fn fastest(own: &OwnOrbit) -> &Instability {
    let all = own.analysis.parts[0].instabilities.iter();
    all.max_by(|a, b| a.multiplier.size().total_cmp(&b.multiplier.size())).expect("something grows")
}

/// The growth rate of a small deviation from the orbit along its unstable mode, over four decades from 10^-8
/// on, where the mode that decays has left it.
fn measured(scene: &SystemScene, own: &OwnOrbit) -> f64 {
    let shape = &fastest(own).shape;
    let start: Vec<f64> = own.start.iter().zip(shape).map(|(y, v)| y + 1e-11 * v).collect();
    let mut run = scene.nonlinear_simulation(start, vec![0.0; shape.len()]).unwrap().unwrap();
    let ticks = run.clocks().period();
    let deviation = |x: &[f64], p: &[f64]| {
        x.iter().zip(&own.start).map(|(x, y)| x - y).chain(p.iter().copied()).fold(0.0, f64::hypot)
    };
    let mut reached = Vec::new();
    for period in 0..20_000 {
        run.run(ticks, Ends::Symmetric);
        let size = deviation(&run.state().x, &run.state().p);
        if size > 1e-8 {
            reached.push((f64::from(period), size.ln()));
        }
        if reached.first().is_some_and(|(_, first)| size.ln() > first + 1e4f64.ln()) {
            break;
        }
    }
    let ((first, low), (last, high)) = (reached[0], *reached.last().unwrap());
    assert!(high - low > 1e4f64.ln(), "four decades");
    (high - low) / ((last - first) * own.analysis.period.to_f64())
}

#[test]
fn twelve_unstable_steps_grow_as_predicted_about_the_own_orbit_within_one_percent() {
    let (mut compared, mut farthest) = (0, 0.0f64);
    for thousandths in 240..270 {
        let scene = in_tension(thousandths);
        let own = orbit(&scene);
        assert!(own.displacement > 1e-5, "{}", own.displacement);
        let predicted = middle(own.analysis.growth_rate().unwrap());
        if predicted < 0.01 || fastest(&own).origin != Origin::RealPair {
            continue;
        }
        let found = measured(&scene, &own);
        let equilibrium = scene.model().decide(Route::Cheapest, &Limits::default()).unwrap();
        let about_equilibrium = middle(equilibrium.growth_rate().unwrap());
        assert!(
            (found / predicted - 1.0).abs() < 0.01,
            "{thousandths}: {found} measured, {predicted} predicted"
        );
        farthest = farthest.max((about_equilibrium / found - 1.0).abs());
        compared += 1;
    }
    assert!(compared >= 12, "{compared}");
    // About the equilibrium it is another matter.
    assert!(farthest > 0.03, "{farthest}");
}

#[test]
fn an_equilibrium_where_every_force_vanishes_is_its_own_orbit() {
    for name in ["fpu", "fpu-quartic"] {
        let text = std::fs::read_to_string(format!("data/scenes/{name}.json")).unwrap();
        let scene = SystemScene::read(&text).unwrap();
        assert!(scene.own_orbit(&Limits::default()).unwrap().is_none(), "{name}");
    }
}

#[test]
fn equal_hessians_at_every_kick_give_the_verdict_of_the_linear_system() {
    use kickdrift::number::rational::{ratio, to_f64};
    use kickdrift::schedule::Schedule;
    use kickdrift::system::{builders, decide_along, decide_system};
    use nalgebra::DMatrix;
    let mut unstable = 0;
    for twentieths in 4..24 {
        let steps = [ratio(1, 4), ratio(twentieths, 20)];
        let chain =
            builders::alternating_chain(5, [&ratio(10, 1), &ratio(1, 1)], [&steps[0], &steps[1]]).unwrap();
        let linear = decide_system(&chain, &Limits::default()).unwrap();
        let clocks = chain.clocks();
        let own: Vec<_> = clocks.iter().map(|clock| clock.step.clone()).collect();
        let schedule = Schedule::new(&own, &vec![ratio(0, 1); own.len()]).unwrap();
        let matrix = |k: usize| DMatrix::from_fn(5, 5, |i, j| to_f64(&clocks[k].stiffness.get(i, j)));
        let hessians: Vec<Vec<_>> =
            schedule.half_period().map(|event| event.clocks().map(matrix).collect()).collect();
        let along = decide_along(&[1.0; 5], &schedule, &hessians, &Limits::default()).unwrap();
        assert_eq!(along.kind.unwrap(), linear.kind.unwrap());
        let [(a, b), (c, d)] = [&along, &linear].map(|own| own.growth_rate().unwrap());
        assert!(a <= d && c <= b && b - a < 1e-9, "{a} {b} {c} {d}");
        unstable += usize::from(!linear.is_stable());
        let mut few = hessians.clone();
        few.pop();
        assert_eq!(
            decide_along(&[1.0; 5], &schedule, &few, &Limits::default()).unwrap_err().field(),
            "hessians"
        );
    }
    assert!((2..18).contains(&unstable), "{unstable}");
}
