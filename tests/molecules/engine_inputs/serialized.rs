//! OpenMM's serialized integrators and systems, as `XmlSerializer` of OpenMM 8.6 writes them; the steps are
//! those of the objects.

use super::{all_are_refused, all_have_their_steps, of, steps};
use kickdrift::advise::Constraints;
use kickdrift::advise::engine::{Engine, read};

macro_rules! one {
    ($kind:literal, $size:literal) => {
        concat!("<?xml version=\"1.0\" ?>\n<Integrator constraintTolerance=\"1e-05\" friction=\"1\" integrationForceGroups=\"-1\" randomSeed=\"0\" stepSize=\"", $size, "\" temperature=\"300\" type=\"", $kind, "\" version=\"1\"/>\n")
    };
}

/// `MTSIntegrator` and its kind, whose computations are written out as its class writes them.
fn grouped(size: &str, groups: &[(u64, u64)], is_langevin: bool) -> String {
    let mut text = String::new();
    substeps(&mut text, 1, groups, is_langevin);
    let end = computation(4, "", "");
    format!(
        "<?xml version=\"1.0\" ?>\n<Integrator constraintTolerance=\"1e-05\" integrationForceGroups=\"-1\" kineticEnergyExpression=\"m*v*v/2\" randomSeed=\"0\" \
         stepSize=\"{size}\" type=\"CustomIntegrator\" version=\"3\">\n\t<Computations>\n{}{text}{end}\t</Computations>\n\t<Functions/>\n</Integrator>\n",
        computation(5, "", "")
    )
}

fn computation(kind: u8, variable: &str, expression: &str) -> String {
    format!(
        "\t\t<Computation computationExpression=\"{expression}\" computationType=\"{kind}\" computationVariable=\"{variable}\"/>\n"
    )
}

fn substeps(text: &mut String, parent: u64, groups: &[(u64, u64)], is_langevin: bool) {
    let Some(((group, n), below)) = groups.split_first() else { return };
    let kick = computation(1, "v", &format!("v+0.5*(dt/{n})*f{group}/m"));
    for _ in 0..n / parent {
        *text += &kick;
        if below.is_empty() {
            if is_langevin {
                let half = computation(1, "x", &format!("x+(dt/{})*v", 2 * n));
                *text += &(half.clone() + &computation(1, "v", "a*v + b*sqrt(kT/m)*gaussian") + &half);
            } else {
                *text += &computation(1, "x", &format!("x+(dt/{n})*v"));
            }
            *text += &(computation(1, "x1", "x") + &computation(3, "", ""));
            *text += &(computation(1, "v", &format!("v+(x-x1)/(dt/{n})")) + &computation(4, "", ""));
        }
        substeps(text, *n, below, is_langevin);
        *text += &kick;
    }
}

#[test]
fn steps_are_those_of_the_objects() {
    let texts = [
        (one!("VerletIntegrator", ".001").to_string(), "1"),
        (one!("LangevinIntegrator", ".002").into(), "2"),
        (one!("LangevinMiddleIntegrator", ".004").into(), "4"),
        (one!("NoseHooverIntegrator", ".0005").into(), "0.5"),
        (one!("QTBIntegrator", ".001").into(), "1"),
        // 9 fs as 3*0.003 ps in doubles.
        (one!("VerletIntegrator", ".009000000000000001").into(), "9"),
        (grouped(".004", &[(0, 1), (1, 2), (2, 8)], false), "0.5,2,4"),
        (grouped(".004", &[(1, 1), (0, 2)], true), "2,4"),
        (grouped(".012", &[(2, 2), (0, 6)], false), "2,6"),
        (grouped(".002", &[(0, 1), (1, 1)], false), "2"),
        (grouped(".003", &[(0, 6)], true), "0.5"),
    ];
    let texts: Vec<(&str, &str)> = texts.iter().map(|(text, steps)| (text.as_str(), *steps)).collect();
    all_have_their_steps(Engine::OpenMm, &texts);
}

#[test]
fn computations_of_other_integrators_are_refused() {
    let mts = grouped(".004", &[(0, 1), (1, 2)], false);
    all_are_refused(&[
        (one!("BrownianIntegrator", ".002"), "Integrator", "BrownianIntegrator"),
        (one!("VariableVerletIntegrator", "0"), "Integrator", "VariableVerletIntegrator"),
        (one!("VerletIntegrator", "0"), "stepSize", "positive"),
        (
            "<Integrator type=\"CompoundIntegrator\" version=\"1\"><Integrators/></Integrator>",
            "Integrator",
            "CompoundIntegrator",
        ),
        // A splitting of openmmtools, velocity Verlet, a group that kicks once, distances that do not fill a
        // step.
        (&mts.replace("v+0.5*(dt/1)*f0/m", "v + (dt / 2) * f0 / m"), "CustomIntegrator", "--steps"),
        (&mts.replace("v+0.5*(dt/2)*f1/m", "v+0.5*dt*f/m"), "CustomIntegrator", "--steps"),
        (&mts.replacen(&computation(1, "v", "v+0.5*(dt/2)*f1/m"), "", 1), "CustomIntegrator", "kicks"),
        (&mts.replacen("x+(dt/2)*v", "x+(dt/4)*v", 1), "CustomIntegrator", "computations"),
        (&mts.replacen("x+(dt/2)*v", "x+(dt/2)*v*1", 1), "CustomIntegrator", "x+(dt/2)*v*1"),
        (&mts.replace("f1/m", "f0/m"), "CustomIntegrator", "kicks"),
        (&mts.replace("f1/m", "f32/m"), "computationExpression", "0 to 31"),
    ]);
}

/// Bonds of 0 and 1 (O-H), of 0 and 2; the system holds what is no bond.
fn system(held: &str, bonds: &str, forces: &str) -> String {
    format!(
        "<System openmmVersion=\"8.6.1\" type=\"System\" version=\"1\"><Particles><Particle mass=\"15.99943\"/><Particle mass=\"1.007947\"/><Particle mass=\"12.01\"/></Particles>\
         <Constraints>{held}</Constraints><Forces><Force forceGroup=\"0\" type=\"HarmonicBondForce\" version=\"2\"><Bonds>{bonds}</Bonds></Force>{forces}</Forces></System>"
    )
}

const HELD: &str = "<Constraint d=\".1\" p1=\"0\" p2=\"1\"/>";

#[test]
fn a_system_tells_which_bonds_are_held() {
    let own = |text: &str| read(&[one!("VerletIntegrator", ".002"), text], None).unwrap();
    let (light, heavy) =
        ("<Bond d=\".1\" k=\"1\" p1=\"0\" p2=\"1\"/>", "<Bond d=\".1\" k=\"1\" p1=\"0\" p2=\"2\"/>");
    assert_eq!(own(&system(HELD, heavy, "")).constraints, Some(Constraints::HBonds));
    assert_eq!(own(&system(HELD, "", "")).constraints, Some(Constraints::AllBonds));
    assert_eq!(own(&system("", light, "")).constraints, None);
    for text in
        [system(HELD, light, ""), system(HELD, heavy, "<Force forceGroup=\"0\" type=\"CustomBondForce\"/>")]
    {
        let reading = own(&text);
        assert!(
            reading.constraints.is_none() && reading.remarks[0].contains("--constraints"),
            "{:?}",
            reading.remarks
        );
    }
}

#[test]
fn groups_of_a_system_are_all_integrated_and_none_is_empty() {
    let mts = grouped(".004", &[(0, 1), (1, 2)], false);
    let pme = "<Force forceGroup=\"0\" method=\"4\" recipForceGroup=\"1\" type=\"NonbondedForce\"/><Force forceGroup=\"0\" type=\"CMMotionRemover\"/>";
    let reading = read(&[&mts, &system("", "", pme)], None).unwrap();
    assert_eq!(
        reading.forces,
        ["group 1 (NonbondedForce, reciprocal space)", "group 0 (HarmonicBondForce, NonbondedForce)"]
    );
    // What exerts no force need not be listed.
    let remover = system(
        "",
        "",
        "<Force forceGroup=\"1\" type=\"NonbondedForce\"/><Force forceGroup=\"7\" type=\"MonteCarloBarostat\"/>",
    );
    assert!(read(&[&mts, &remover], None).is_ok());
    for (text, words) in [
        (system("", "", ""), "group 1 has no force"),
        // Without Ewald sums there is no reciprocal space.
        (system("", "", &pme.replace("\"4\"", "\"0\"")), "group 1 has no force"),
        (
            system("", "", &pme.replace("recipForceGroup=\"1\"", "recipForceGroup=\"2\"")),
            "group 2 would never be integrated",
        ),
    ] {
        let error = read(&[&mts, &text], None).unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
    }
    // A plain integrator that was told its groups: bits 0 and 2.
    let some = one!("VerletIntegrator", ".002").replace("\"-1\"", "\"5\"");
    assert_eq!(of(&some).unwrap().forces, ["group 0, group 2"]);
    // A system alone has no steps.
    assert!(of(&system("", "", pme)).unwrap_err().to_string().contains("no steps"));
    let error = read(&[&some, &system("", "", &pme.replace("\"1\"", "\"3\""))], None).unwrap_err();
    assert!(error.to_string().contains("group 3 would never be integrated"), "{error}");
    assert!(read(&[&some, &some], None).unwrap_err().to_string().contains("second one"));
    assert_eq!(steps(&of(&some).unwrap()), "2");
}
