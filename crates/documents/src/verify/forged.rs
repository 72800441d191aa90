//! Answers that are wrong from the start: the comparison with the document computed again would be one with
//! another wrong document, so the other route has to find them.

use serde_json::{Value, json};

use super::context::{Context, Options};
use super::kind::Verify;
use crate::question::{
    Advised, Bands, Closings, Compare, CompareMethods, Curves, Family, Half, Methods, Polynomial,
    Proposition, Safe, Simulate, Survey, System, SystemAnswer, SystemFound, SystemVerdict, Tongues, Verdict,
    Word,
};
use clocks::propagator::{TwoClocks, half_period};
use clocks::verdict::{Kind, Side, Verdict as Decided};
use number::{Rational, rational};
use words::Bounded;

type Forgery<Q> = fn(&mut <Q as crate::question::Question>::Answer);

/// The other route agrees with the answer, and with none of the forged ones.
fn finds<Q: Verify>(input: Value, forgeries: &[Forgery<Q>]) {
    finds_in_copies(input, forgeries, |question: &Q, context, _| question.answer(&context.work()).unwrap());
}

/// The same for advice on periods, which is dear: asked once, and forged in copies.
fn finds_in_advice(input: Value, forgeries: &[Forgery<Advised>]) {
    finds_in_copies(input, forgeries, |_: &Advised, _, safe| match safe {
        Safe::Periods(advice) => Safe::Periods(advice.clone()),
        _ => panic!("advice on periods"),
    });
}

fn finds_in_copies<Q: Verify>(
    input: Value,
    forgeries: &[Forgery<Q>],
    copied: impl Fn(&Q, &Context, &Q::Answer) -> Q::Answer,
) {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/cli/data").into();
    let options = Options { folder, ..Options::default() };
    let (question, context): (Q, _) =
        (Q::read(input.as_object().unwrap()).unwrap(), Context::new(&options, None));
    let honest = question.answer(&context.work()).unwrap();
    assert_eq!(question.check(&honest, &context).unwrap().failures, [], "{}", Q::NAME);
    for (n, forge) in forgeries.iter().enumerate() {
        let mut forged = copied(&question, &context, &honest);
        forge(&mut forged);
        let found = question.check(&forged, &context).unwrap().failures;
        assert!(!found.is_empty(), "forgery {n} of {:?}", question.input());
    }
}

/// A hundredth more.
fn more((lo, hi): &mut (f64, f64)) {
    (*lo, *hi) = (*lo * 1.01, *hi * 1.01);
}

#[test]
fn forged_numbers_of_two_clocks_are_found() {
    finds::<Half>(
        json!({"ratio": "5/4", "s": "3/2", "rho": "1/7"}),
        &[|half| {
            let ratio = "5/4".parse().unwrap();
            *half = half_period(&TwoClocks::with_rho(ratio, rational::ratio(8, 5), rational::ratio(1, 7)));
        }],
    );
    finds::<Polynomial>(
        json!({"ratio": "5/3"}),
        &[
            |all| all[0].1 = all[1].1.clone(),
            |all| all[4].1 += number::Polynomial::constant(number::Polynomial::variable()),
            |all| all[3].1 = all[3].1.shift(9),
        ],
    );
    finds::<Proposition>(
        json!({"max": "6"}),
        &[
            |(_, all)| all[4].b += 17,
            |(_, all)| all.truncate(7),
            |(_, all)| all.swap(0, 1),
            |(check, _)| check.forward += 1,
            |(check, _)| check.backward += 1,
            |(check, all)| check.failures.push(all[0]),
        ],
    );
    finds::<Curves>(
        json!({"samples": "12", "a": "0..2", "b": "-2..2"}),
        &[
            |curves| shown(curves)[0].pieces[0][3].h2 *= 1.0 + 1e-14,
            |curves| shown(curves)[0].pieces[0][3].theta_over_pi *= 1.0 + 1e-14,
            |curves| shown(curves)[0].pieces.clear(),
            |curves| shown(curves)[0].pieces[0].truncate(2),
            |curves| drop(shown(curves)[0].pieces[0].drain(..1)),
            |curves| curves.reverse(),
        ],
    );
}

fn shown(curves: &mut [clocks::resonance::Curve]) -> Vec<&mut clocks::resonance::Curve> {
    curves.iter_mut().filter(|curve| !curve.pieces.is_empty()).collect()
}

#[test]
fn forged_verdicts_are_found() {
    let exact =
        json!({"lambda1": "10", "lambda2": "2/5", "h1": "631/1000", "h2": "3499/1000", "exact": "true"});
    let growing = json!({"lambda1": "10", "lambda2": "2/5", "h1": "3/5", "h2": "3"});
    let long =
        json!({"lambda1": "pi^2", "lambda2": "pi^2/25", "h1": "1/100000000", "h2": "77777777/100000000"});
    let elsewhere: Forgery<Verdict> = |decided| decided.growth.trace = decided.growth.trace.scale2(1);
    let turned: Forgery<Verdict> = |decided| {
        let is_stable = decided.decision.verdict.is_stable();
        decided.decision.verdict =
            if is_stable { Decided::Hyperbolic(Side::Plus) } else { Decided::Elliptic };
    };
    finds::<Verdict>(
        exact,
        &[turned, elsewhere, |decided| {
            *decided.exact_trace.as_mut().unwrap() += rational::ratio(1, 1_000_000);
        }],
    );
    finds::<Verdict>(
        json!({"lambda1": "1", "lambda2": "1/25", "h1": "1/2", "h2": "3/4"}),
        &[
            turned,
            |decided| decided.bias = None,
            |decided| decided.bias.as_mut().unwrap().at_kicks = number::Ball::one(),
            |decided| decided.bias.as_mut().unwrap().in_drifts = number::Ball::one(),
        ],
    );
    finds::<Verdict>(
        growing,
        &[
            turned,
            elsewhere,
            |decided| decided.growth.ln_multiplier = None,
            |decided| {
                decided.growth.ln_multiplier = decided.growth.ln_multiplier.as_ref().map(|ln| ln.scale2(1))
            },
            |decided| decided.growth.label = decided.growth.label.map(|label| label + 2),
            |decided| decided.growth.label = None,
        ],
    );
    finds::<Verdict>(long, &[turned, elsewhere]);
}

#[test]
fn forged_tongues_are_found() {
    finds::<Closings>(
        json!({"max_sum": "9"}),
        &[
            |all| all.iter_mut().for_each(|found| drop(found.closings.pop())),
            |all| first(all).m += 2,
            |all| first(all).below_verlet ^= true,
            |all| first(all).exact = None,
            |all| {
                let rho = &mut inexact(all).rho;
                rho.hi = &rho.hi * rational::ratio(1_000_001, 1_000_000);
                rho.lo = rho.hi.clone();
            },
            |all| inexact(all).s = first(all).s.clone(),
            |all| inexact(all).exact = Some((rational::ratio(1, 3), rational::ratio(1, 3))),
        ],
    );
    finds::<Closings>(
        json!({"ratio": "17/8", "m": "13..16", "samples": "60"}),
        &[|all| {
            all[0].closings.remove(0);
        }],
    );
    finds::<Survey>(
        json!({"max_sum": "9", "rho": "1/25", "thinnest": "5"}),
        &[
            |survey| more(&mut survey.thinnest[1].width),
            |survey| survey.thinnest[1].s *= 1.0 + 1e-9,
            |survey| survey.thinnest[1].m += 1,
        ],
    );
}

fn first(all: &mut [clocks::tongue::Found]) -> &mut clocks::tongue::Closing {
    all.iter_mut().flat_map(|found| &mut found.closings).find(|closing| closing.exact.is_some()).unwrap()
}

fn inexact(all: &mut [clocks::tongue::Found]) -> &mut clocks::tongue::Closing {
    all.iter_mut().flat_map(|found| &mut found.closings).find(|closing| closing.exact.is_none()).unwrap()
}

#[test]
fn forged_bands_and_comparisons_are_found() {
    let window = json!({"lambda1": "pi^2", "lambda2": "pi^2/25", "h1_range": "1/5..1/4", "h2_range": "9/10..1", "sectors": "60"});
    finds::<Bands>(
        window,
        &[
            |bands| bands.certified[0].sides[1][0] = bands.certified[0].sides[1][0] * 21 / 20,
            |bands| bands.certified[0].sides[0] = bands.certified[0].sides[1],
            |bands| bands.certified[0].family[0] += 1,
            |bands| bands.certified.push(bands.certified[0].clone()),
        ],
    );
    finds::<Compare>(
        json!({"max_sum": "8", "rho": "1/25", "samples": "20"}),
        &[
            |found| found.tally.hits += 1,
            |found| drop(found.offenders.pop()),
            |found| found.offenders[1].comparison.trace.verdict = Decided::Parabolic(Side::Plus),
            |found| found.offenders[1].comparison.tan = Decided::Parabolic(Side::Plus),
            |found| found.offenders[1].comparison.nearest.as_mut().unwrap().m += 1,
            |found| found.offenders[1].place[0] = number::Laurent::from_integer(1),
        ],
    );
    let grid = json!({"lambda1": "16", "lambda2": "16/25", "step1": "1/10", "step2": "1/10", "h1_range": "1/10..3/5", "h2_range": "1/10..2"});
    finds::<Compare>(grid, &[|found| found.tally.unstable += 1, |found| found.offenders.swap(0, 1)]);
}

#[test]
fn forged_integrators_are_found() {
    let steps = json!({"methods": "respa-4,impulse,molly-long", "lambda1": "pi^2/25", "h_range": "0..8", "h_step": "1",
        "rho_range": "0..1/4", "rho_step": "1/16"});
    finds::<CompareMethods>(
        steps,
        &[
            |sides| sides[0].rows[2][3] = other(sides[0].rows[2][3]),
            |sides| sides[2].rows[0][1] = other(sides[2].rows[0][1]),
            |sides| drop(sides[1].rows.pop()),
        ],
    );
    let stiff = |method: &str| json!({"method": method, "lambda1": "pi^2", "lambda2": "pi^2/25"});
    finds::<Word>(
        stiff("avi-3-2"),
        &[
            |linted| linted.order.order += 1,
            |linted| linted.general.as_mut().unwrap().general.order += 1,
            |linted| linted.general.as_mut().unwrap().nystrom.order -= 1,
            |linted| linted.stability.as_mut().unwrap().intervals[0].stable ^= true,
        ],
    );
    finds::<Word>(stiff("molly-long"), &[|linted| linted.pieces.as_mut().unwrap().all[0].stable ^= true]);
    let family = json!({"word": "K(b) D(1/2) K(1-2*b) D(1/2) K(b)", "parameter": "b=0.15..0.25:1/20", "minimize": "bias"});
    finds::<Family>(
        family,
        &[
            |members| members.all[0].values = members.all[1].values.clone(),
            |members| members.all[1].linted.order.order += 1,
            |members| members.all[1].linted.stability.as_mut().unwrap().intervals[0].stable ^= true,
            |members| members.all[0].bias = members.all[1].bias.clone(),
            |members| members.best.as_mut().unwrap().member.values = members.all[2].values.clone(),
        ],
    );
    finds::<Methods>(
        json!({}),
        &[|all| {
            let mut forged = all.to_vec();
            forged[0].linted.word = forged[1].linted.word.clone();
            *all = forged.leak();
        }],
    );
}

fn other(bounded: Bounded) -> Bounded {
    if bounded == Bounded::Stable { Bounded::Unstable } else { Bounded::Stable }
}

#[test]
fn forged_advice_on_periods_is_found() {
    let mode = |name: &str, clock: u32, stiffness: &str| json!({"name": name, "from": "period", "clock": clock, "stiffness": stiffness});
    let asked = json!({"band": "1/20", "modes": [mode("OH", 1, "pi^2/25"), mode("slow", 2, "pi^2/400")],
        "schemes": [["1/2", "4"], ["1/2", "24/5"], ["1/2", "5"]], "length": "10000000", "friction": "1/1000"});
    finds_in_advice(
        asked,
        &[
            |safe| more(&mut row(safe, 0).found.trace),
            |safe| row(safe, 0).found.kind = Kind::Hyperbolic,
            |safe| more(row(safe, 0).bias.as_mut().unwrap()),
            |safe| row(safe, 0).bias = None,
            |safe| row(safe, 1).bias = Some((1.0, 1.0)),
            |safe| more(&mut row(safe, 1).found.rate),
            |safe| row(safe, 1).masking.as_mut().unwrap().grows *= 1.1,
            |safe| row(safe, 1).masking.as_mut().unwrap().ranges[0].0 *= 0.9,
            |safe| row(safe, 1).is_damped = row(safe, 1).is_damped.map(|is_damped| !is_damped),
            |safe| row(safe, 1).ratios.as_mut().unwrap().1 += Rational::from_integer(1.into()),
            |safe| more(&mut row(safe, 0).first.as_mut().unwrap().lower),
            |safe| more(row(safe, 1).inside.as_mut().unwrap().upper.as_mut().unwrap()),
            |safe| row(safe, 1).inside.as_mut().unwrap().worst.as_mut().unwrap().steps *= 1.01,
            |safe| more(&mut row(safe, 1).intervals[1].lower),
            |safe| row(safe, 1).intervals[1].label += 1,
            |safe| row(safe, 2).below = row(safe, 2).above.clone(),
            |safe| more(&mut advice(safe).schemes[0].band_edge),
            |safe| advice(safe).schemes[2].status = molecules::Status::Safe,
            |safe| advice(safe).schemes[0].status = molecules::Status::Safe,
            |safe| *advice(safe).schemes[0].largest.as_mut().unwrap() += rational::ratio(1, 2),
            |safe| *advice(safe).schemes[0].safe.as_mut().unwrap() += rational::ratio(1, 2),
            |safe| more(&mut advice(safe).schemes[0].safe_bias.as_mut().unwrap().1),
            |safe| advice(safe).schemes[0].safe_bias = None,
            |safe| advice(safe).schemes[0].needs = Some(20.0),
            |safe| levers(safe).iter_mut().flat_map(|lever| &mut lever.first).for_each(more),
            |safe| levers(safe).iter_mut().flat_map(|lever| &mut lever.band_edge).for_each(more),
        ],
    );
    // Nothing is known of the slow clock.
    let silent = json!({"band": "1/20", "modes": [mode("OH", 1, "pi^2/25")], "schemes": [["1/2", "2"]]});
    finds_in_advice(
        silent,
        &[|safe| advice(safe).schemes[0].needs = advice(safe).schemes[0].needs.map(|x| 1.01 * x)],
    );
}

#[test]
fn a_forged_step_at_which_a_hot_bond_is_lost_is_found() {
    // O-H of q-TIP4P/F, a thousand of them for a nanosecond: E* falls steeply there.
    let hot = json!({"band": "1/20", "bonds": "1000", "length": "1000000", "no_levers": "true", "schemes": [["1"]],
        "modes": [{"name": "OH", "from": "curvature at rest", "clock": 1, "stiffness": "360051629878123/671958000000000",
            "bond": {"masses": ["15999/1000", "126/125"], "hydrogens": 1},
            "shape": "OH:poly:k2=254049.483068kJ/mol/nm^2,k3=-5810111.67776516kJ/mol/nm^3,k4=77511731.5411187kJ/mol/nm^4,15.999,1.008"}]});
    finds_in_advice(
        hot,
        &[
            |safe| edge(safe, 0).share *= 1.01,
            |safe| edge(safe, 1).share *= 0.99,
            |safe| edge(safe, 0).aperture *= 0.5,
            |safe| advice(safe).cold[1].first = None,
        ],
    );
}

fn edge(safe: &mut Safe, kind: usize) -> &mut molecules::aperture::Edge {
    advice(safe).cold[kind].first.as_mut().unwrap()
}

fn advice(safe: &mut Safe) -> &mut molecules::Advice {
    if let Safe::Periods(advice) = safe { advice } else { panic!("advice on periods") }
}

fn levers(safe: &mut Safe) -> &mut [molecules::Lever] {
    &mut advice(safe).levers.as_mut().unwrap().rows
}

fn row(safe: &mut Safe, scheme: usize) -> &mut molecules::Row {
    &mut advice(safe).schemes[scheme].rows[0]
}

#[test]
fn forged_systems_are_found() {
    let springs = json!({"schema": "kickdrift/system/1", "title": "", "masses": ["1", "3/2", "2"], "potentials": [
        {"step": "1/8", "springs": [[0, 1, "10"], [1, 2, "20"]]}, {"step": "1/4", "springs": [[0, null, "5"], [2, null, "7"]]}]});
    let asked = |more: Value| {
        let mut asked = json!({"file": "a.json", "system": springs});
        more.as_object().unwrap().iter().for_each(|(key, value)| asked[key] = value.clone());
        asked
    };
    finds::<System>(
        asked(json!({})),
        &[
            |answer| system_verdict(answer).analysis.kind = Some(Kind::Hyperbolic),
            |answer| system_verdict(answer).bias = None,
            |answer| biased(answer)[0].bias.at_kicks *= 1.01,
            |answer| biased(answer)[1].bias.in_drifts *= 1.01,
            |answer| biased(answer)[0].period *= 1.01,
            |answer| biased(answer)[1].turn *= 1.01,
            |answer| biased(answer)[1].pair.swap(0, 1),
            |answer| drop(biased(answer).pop()),
            |answer| biased(answer)[0] = biased(answer)[1].clone(),
        ],
    );
    finds::<System>(
        asked(json!({"scan_x": "potentials.0.step=1/8..3/4:1/8"})),
        &[|answer| {
            let SystemFound::Map(map) = &mut answer.found else { panic!("a map") };
            map.points[1].kind = Some(Kind::Parabolic);
        }],
    );
    finds::<System>(
        asked(json!({"intervals": "outer=1/8..1/2", "width": "1e-2"})),
        &[|answer| {
            let SystemFound::Intervals(found) = &mut answer.found else { panic!("intervals") };
            found.stretches.swap(0, 1);
        }],
    );
    finds::<Simulate>(asked(json!({"periods": "4"})), &[|answer| answer.run.series[3].amplitude *= 1.01]);
}

fn system_verdict(answer: &mut SystemAnswer) -> &mut SystemVerdict {
    let SystemFound::Verdict(verdict) = &mut answer.found else { panic!("a verdict") };
    verdict
}

fn biased(answer: &mut SystemAnswer) -> &mut Vec<systems::BiasedMode> {
    system_verdict(answer).bias.as_mut().unwrap().as_mut().unwrap()
}

#[test]
fn forged_advice_on_hessians_is_found() {
    let read = |name: &str| -> Value {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
        serde_json::from_str(&std::fs::read_to_string(format!("{folder}/{name}")).unwrap()).unwrap()
    };
    let asked = |name: &str, steps: Value| json!({"band": "1/20", "schemes": [steps], "file": "a.json", "system": read(name), "no_levers": "true"});
    finds::<Advised>(
        asked("tests/cli/data/tiny.json", json!(["11/5", "22/5"])),
        &[
            |safe| more(findings(safe).first.as_mut().unwrap()),
            |safe| findings(safe).rate = findings(safe).rate.map(|rate| rate + 1e-3),
            |safe| *findings(safe).band_edge.as_mut().unwrap() *= 1.2,
        ],
    );
    finds::<Advised>(
        asked("tests/cli/data/tiny.json", json!(["1/2", "4"])),
        &[
            |safe| findings(safe).bias.as_mut().unwrap().bias *= 1.01,
            |safe| findings(safe).bias = None,
            |safe| findings(safe).safe_bias.as_mut().unwrap().bias *= 1.01,
            |safe| findings(safe).safe_bias = None,
        ],
    );
    finds::<Advised>(
        asked("data/scenes/no-gradient.json", json!(["40", "80"])),
        &[|safe| {
            let Safe::Direct(pair) = safe else { panic!("no gradient") };
            let (lo, hi) = pair.1.schemes[0].rate.unwrap();
            pair.1.schemes[0].rate = Some((lo + 1e-3, hi + 1e-3));
        }],
    );
}

fn findings(safe: &mut Safe) -> &mut molecules::Finding {
    if let Safe::Hessians(pair) = safe { &mut pair.1.schemes[0] } else { panic!("Hessians") }
}

#[test]
fn forged_rows_of_tongues_are_found() {
    finds::<Tongues>(
        json!({"ratio": "7/3", "rho": "1/25", "lambda1": "pi^2", "digits": "30"}),
        &[
            |found| drop(found.tongues.remove(3)),
            |found| found.tongues.swap(1, 2),
            |found| found.tongues[2].row.family = Some((1, 1)),
            |found| (found.tongues[2].lower.s.lo, found.tongues[2].lower.s.hi) = (0.5, 0.6),
            |found| found.tongues[4].row.gap.closed = true,
            |found| more(&mut found.tongues[2].row.gap.width),
            |found| found.tongues[2].row.peak.as_mut().unwrap().ln_multiplier *= 1.01,
            |found| found.tongues[2].row.peak.as_mut().unwrap().s *= 1.001,
            |found| found.tongues[2].growth_rate = None,
            |found| found.tongues[2].row.predicted.as_mut().unwrap().distance *= 1.01,
            |found| found.tongues[2].row.first_order.as_mut().unwrap().width *= 1.01,
            |found| more(&mut found.tongues[2].row.first_order.as_mut().unwrap().width_ratio),
            |found| found.tongues[2].upper.as_mut().unwrap().steps = None,
            |found| found.tongues[2].lower.exact = Some(rational::ratio(1, 2)),
        ],
    );
}
