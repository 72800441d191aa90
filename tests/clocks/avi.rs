//! Algorithm 1 against the propagators.

use kickdrift::avi::{self, Bond, Clocks, Ends, Force, Form, Linear, Simulation, State};
use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::number::{Ratio, Rational};
use kickdrift::propagator::{TwoClocks, methods};
use kickdrift::system::{Limits, Potential, Symmetric, System, builders, decide_system, full_period, middle};
use num_traits::Zero;
use proptest::prelude::*;

/// The same system for the simulation: each clock's potential as one force.
fn forces(system: &System) -> Vec<Linear<Rational>> {
    let force = |clock: &Potential| {
        let particles = clock.stiffness.support();
        let row = |&i: &usize| particles.iter().map(|&j| clock.stiffness.get(i, j)).collect();
        let rows = particles.iter().map(row).collect();
        Linear::new(particles, rows).unwrap()
    };
    system.clocks().iter().map(force).collect()
}

fn clocks(system: &System) -> Clocks {
    let steps: Vec<_> = system.clocks().iter().map(|c| c.step.clone()).collect();
    let phases: Vec<_> = system.clocks().iter().map(|c| c.phase.clone()).collect();
    Clocks::new(&steps, &phases).unwrap()
}

fn masses(system: &System) -> Vec<Rational> {
    (0..system.size()).map(|i| system.mass().get(i, i)).collect()
}

/// Random systems of few kicks a period: exact orbits grow longer with each.
fn any_system() -> impl Strategy<Value = System> {
    every_system().prop_filter("a long period", |system| system.schedule().strikes() <= 60)
}

fn every_system() -> impl Strategy<Value = System> {
    (1usize..=4, 1usize..=4).prop_flat_map(|(n, clocks)| {
        let spring = (0..n, 0..=n, -5i64..40);
        let one = (prop::collection::vec(spring, 1..=n + 2), 1i64..8, 1i64..4, any::<bool>());
        (prop::collection::vec(1i64..6, n), prop::collection::vec(one, clocks)).prop_map(
            move |(masses, potentials)| {
                let mass = Symmetric::diagonal(&masses.iter().map(|&m| ratio(m, 3)).collect::<Vec<_>>());
                let build = |(springs, p, q, late): (Vec<(usize, usize, i64)>, i64, i64, bool)| {
                    let mut stiffness = Symmetric::zero(n);
                    for (i, j, k) in springs {
                        stiffness.add_spring(i, (j < n && j != i).then_some(j), &ratio(k, 20));
                    }
                    Potential { stiffness, step: ratio(p, 2 * q), phase: ratio(i64::from(late), 2) }
                };
                System::new(mass, potentials.into_iter().map(build).collect()).unwrap()
            },
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn one_period_of_the_simulation_is_the_propagator_exactly(system in any_system()) {
        let n = system.size();
        let q = full_period::<Rational>(&system);
        let tick = system.tick();
        for column in 0..2 * n {
            let unit = |from: usize| (from..from + n).map(|i| ratio(i64::from(i == column), 1)).collect::<Vec<_>>();
            let clocks = clocks(&system);
            let period = clocks.period();
            // The propagator's momenta are in the unit of time one tick.
            let p: Vec<_> = unit(n).into_iter().map(|p| p / tick).collect();
            let mut simulation =
                Simulation::new(&masses(&system), forces(&system), clocks, State::new(unit(0), p)).unwrap();
            simulation.run(period, Ends::Symmetric);
            for i in 0..n {
                prop_assert_eq!(&simulation.state().x[i], &q[(i, column)]);
                prop_assert_eq!(&(&simulation.state().p[i] * tick), &q[(n + i, column)]);
            }
        }
    }

    #[test]
    fn the_staggered_form_is_the_staggered_product(p in 1u64..9, q in 1u64..9, s in 1i64..90, k in 1i64..50) {
        let g = num_integer::gcd(p, q);
        let (p, q) = (p / g, q / g);
        let two = TwoClocks::new(Ratio::new(p, q).unwrap(), ratio(s, 20), ratio(k, 30));
        let h2 = ratio(p as i64, q as i64);
        let springs = || vec![Linear::tether(0, ratio(s, 20)), Linear::tether(0, ratio(k, 30) / &h2)];
        let matrix = methods::avi::staggered(&two);
        for column in 0..2 {
            let clocks = Clocks::new(&[ratio(1, 1), h2.clone()], &[ratio(0, 1), ratio(0, 1)]).unwrap();
            let period = clocks.period();
            let start = State::new(vec![ratio(i64::from(column == 0), 1)], vec![ratio(i64::from(column == 1), 1)]);
            let mut simulation = Simulation::new(&[ratio(1, 1)], springs(), clocks, start).unwrap();
            prop_assert_eq!(simulation.run(period, Ends::Staggered), p + q);
            prop_assert_eq!(&simulation.state().x[0], &matrix[(0, column)]);
            prop_assert_eq!(&simulation.state().p[0], &matrix[(1, column)]);
        }
    }

    #[test]
    fn running_back_leads_to_the_start_exactly(system in any_system()) {
        let n = system.size();
        let clocks = clocks(&system);
        let period = clocks.period();
        let start: Vec<_> = (0..n).map(|i| ratio(i as i64 + 1, 3)).collect();
        let p: Vec<_> = (0..n).map(|i| ratio(2 - i as i64, 5)).collect();
        let mut simulation =
            Simulation::new(&masses(&system), forces(&system), clocks, State::new(start.clone(), p.clone())).unwrap();
        simulation.run(period, Ends::Symmetric);
        prop_assume!(simulation.state().x != start);
        simulation.reverse();
        simulation.run(period, Ends::Symmetric);
        simulation.reverse();
        prop_assert_eq!(&simulation.state().x, &start);
        prop_assert_eq!(&simulation.state().p, &p);
    }
}

/// A simulation in doubles of a linear system.
fn in_doubles(system: &System) -> Simulation<f64, Linear<f64>> {
    let convert = |force: &Potential| {
        let particles = force.stiffness.support();
        let row = |&i: &usize| particles.iter().map(|&j| to_f64(&force.stiffness.get(i, j))).collect();
        Linear::new(particles.clone(), particles.iter().map(row).collect()).unwrap()
    };
    let n = system.size();
    let start = State::new((0..n).map(|i| 1.0 + 0.1 * i as f64).collect(), vec![0.3; n]);
    let forces = system.clocks().iter().map(convert).collect();
    Simulation::new(&masses(system), forces, clocks(system), start).unwrap()
}

#[test]
fn measured_growth_is_the_predicted_one() {
    // A chain of six with one soft clock on a resonance.
    let stiff_soft = |h: &Rational| {
        builders::alternating_chain(6, [&ratio(4, 1), &ratio(1, 2)], [&ratio(1, 4), h]).unwrap()
    };
    let mut unstable = 0;
    for h in [ratio(1, 1), ratio(5, 4), ratio(3, 2), ratio(7, 4)] {
        let system = stiff_soft(&h);
        let analysis = decide_system(&system, &Limits::default()).unwrap();
        let predicted = middle(analysis.growth_rate().unwrap());
        let rest = vec![0.0; system.size()];
        let measured = avi::growth_rate(&mut in_doubles(&system), &rest, 1.0, (4000, Ends::Symmetric));
        // The staggered form is conjugate to the symmetric one.
        let staggered = avi::growth_rate(&mut in_doubles(&system), &rest, 1.0, (4000, Ends::Staggered));
        // A bounded or linearly growing amplitude still changes by a factor over the measured time.
        let time = 2000.0 * to_f64(&system.period());
        for measured in [measured, staggered] {
            assert!(
                (predicted - measured).abs() < 1e-6 * predicted + 8.0 / time,
                "{h}: {predicted} {measured}"
            );
        }
        unstable += usize::from(predicted > 20.0 / time);
    }
    assert!(unstable > 0);
}

#[test]
fn nonlinear_forms_conserve_what_they_should() {
    // A free Fermi-Pasta-Ulam molecule of three: momentum is conserved, energy oscillates by h².
    let quartic = |i| Bond::between(i, i + 1, Form::Quartic { k: 1.0, beta: 0.5 });
    let energies = [ratio(1, 20), ratio(1, 40)].map(|h| {
        let clocks = Clocks::new(&[h.clone(), &h * ratio(3, 2)], &[ratio(0, 1), ratio(0, 1)]).unwrap();
        let start = State::new(vec![0.0, 0.3, -0.2], vec![0.5, -0.25, 0.0]);
        let mut simulation =
            Simulation::new(&vec![ratio(1, 1); 3], vec![quartic(0), quartic(1)], clocks, start).unwrap();
        let period = simulation.clocks().period();
        let off = avi::irreversibility(&mut simulation, 20 * period);
        // Roundoff of some hundred kicks, little amplified.
        assert!(off < 1e-11, "{off}");
        let samples = avi::series(&mut simulation, &[0.0; 3], 400, (period, Ends::Symmetric));
        assert!(samples.iter().all(|s| (s.momentum - 0.25).abs() < 1e-12));
        let (first, worst) =
            (samples[0].energy, samples.iter().map(|s| (s.energy - samples[0].energy).abs()));
        worst.fold(0.0, f64::max) / first
    });
    // Second order: half the step, a quarter of the error; sampled at other times, so within a factor 2.
    let order = energies[0] / energies[1];
    assert!(order > 2.0 && order < 8.0, "{energies:?}");
}

#[test]
fn hessians_at_an_equilibrium_are_a_linear_system() {
    // A Lennard-Jones pair tethered by a spring: equilibrium at the tether's 0 and the pair's minimum.
    let bonds = vec![
        Bond::wall(0, Form::Harmonic { k: 1.0 }),
        Bond::between(0, 1, Form::LennardJones { epsilon: 1.0, sigma: 1.0 }),
    ];
    let x = avi::equilibrium(&bonds, &[0.1, 1.2]).unwrap();
    assert!(x[0].abs() < 1e-12 && (x[1] - 2f64.powf(1.0 / 6.0)).abs() < 1e-12);
    let curvature = bonds[1].curvature(&x);
    assert!((curvature - 72.0 / 2f64.powf(1.0 / 3.0)).abs() < 1e-9);
    assert!(avi::equilibrium(&bonds[1..], &[0.0, 1.2]).is_err());
    let _ = bonds[0].particles();
}

#[test]
fn bad_simulations_are_refused_by_name() {
    let one = || vec![ratio(1, 1)];
    let zero = || vec![Rational::zero()];
    let message = |masses: &[Rational], particle: usize, steps: &[Rational]| {
        let clocks = Clocks::new(steps, &vec![ratio(0, 1); steps.len()])?;
        let spring = vec![Linear::tether(particle, ratio(1, 1))];
        Simulation::new(masses, spring, clocks, State::new(zero(), zero())).map(drop)
    };
    let text = |result: kickdrift::error::Result<()>| result.unwrap_err().to_string();
    assert!(text(message(&one(), 3, &one())).starts_with("potentials[0] = 3: particles are 0 to 0"));
    assert!(text(message(&zero(), 0, &one())).starts_with("masses[0] = 0"));
    assert!(text(message(&one(), 0, &zero())).starts_with("step[0] = 0"));
    assert!(text(message(&one(), 0, &[ratio(1, 1), ratio(2, 1)])).starts_with("steps = 2"));
}

proptest! {
    #[test]
    fn slopes_and_curvatures_are_derivatives(r in 0.8f64..2.5, k in 0.1f64..3.0, beta in 0.1f64..3.0) {
        let h = 1e-5;
        for form in [
            Form::Harmonic { k },
            Form::Quartic { k, beta },
            Form::LennardJones { epsilon: k, sigma: 0.9 },
        ] {
            let slope = (form.energy(r + h) - form.energy(r - h)) / (2.0 * h);
            let curvature = (form.slope(r + h) - form.slope(r - h)) / (2.0 * h);
            // Central differences: h² times a third derivative (up to 10^4 at r = 0.8), and roundoff/h.
            let scale = 1.0 + form.curvature(r).abs() * 20.0;
            prop_assert!((slope - form.slope(r)).abs() < 1e-6 * scale);
            prop_assert!((curvature - form.curvature(r)).abs() < 1e-5 * scale);
        }
    }
}
