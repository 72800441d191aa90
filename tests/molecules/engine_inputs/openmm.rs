//! OpenMM's scripts. Each of those with steps ran in OpenMM 8.6; `dt/n` of a group is half its number of
//! kicks in the integrator that was made.

use super::{all_are_refused, all_have_their_steps, of, steps, thread_time};
use kickdrift::advise::Constraints;
use kickdrift::advise::engine::{Engine, read};
use kickdrift::number::rational::ratio;

/// Integrators alone, as OpenMM's manual writes them.
const SCRIPTS: [(&str, &str); 17] = [
    (
        "from openmm import *\nfrom openmm.unit import *\nintegrator = VerletIntegrator(1.0*femtoseconds)\n",
        "1",
    ),
    (
        "import openmm as mm\nfrom openmm import unit\nintegrator = mm.LangevinMiddleIntegrator(300*unit.kelvin, 1/unit.picosecond, 0.004*unit.picoseconds)\n",
        "4",
    ),
    (
        "import openmm as mm\nimport openmm.unit as u\nintegrator = mm.LangevinIntegrator(300, 1, 2.0*u.femtosecond)\n",
        "2",
    ),
    ("from openmm import *\nintegrator = NoseHooverIntegrator(0.001)\n", "1"),
    (
        "from openmm import *\nfrom openmm.unit import *\nintegrator = NoseHooverIntegrator(300*kelvin, 1/picosecond, 2e-3*picoseconds)\n",
        "2",
    ),
    (
        "from openmm import *\nfrom openmm.unit import *\nintegrator = VerletIntegrator(Quantity(value=0.5, unit=femtosecond))\n",
        "0.5",
    ),
    // Comments and strings hold no calls.
    (
        "\"\"\"As MTSIntegrator(9*femtoseconds, [(0,1)]), but\nnot.\"\"\"\nfrom openmm import *\n# VerletIntegrator(7)\ntitle = 'VerletIntegrator(8) # it\\'s'\nintegrator = VerletIntegrator( 0.002 )\n",
        "2",
    ),
    (
        "from openmm import *\nfrom openmm.unit import *\nintegrator = MTSIntegrator(4*femtoseconds, [(0,1), (1,2), (2,8)])\n",
        "0.5,2,4",
    ),
    (
        "from openmm import *\nfrom openmm.unit import *\nintegrator = MTSLangevinIntegrator(300*kelvin, 1/picosecond, 4*femtoseconds, [(1,1), (0,2)])\n",
        "2,4",
    ),
    (
        "from openmm import *\nfrom openmm.unit import *\nintegrator = MTSIntegrator(groups=[(3,1),\n  (0,6)], dt=0.003*picoseconds)\n",
        "0.5,3",
    ),
    // A group on each of two equal levels.
    (
        "from openmm import *\nfrom openmm.unit import *\nintegrator = MTSIntegrator(2*femtoseconds, [(0,1),(1,1)])\n",
        "2",
    ),
    // The outermost group twice in dt.
    (
        "from openmm import *\nfrom openmm.unit import *\nintegrator = MTSIntegrator(12*femtoseconds, [(2,2), (0,6)])\n",
        "2,6",
    ),
    // Names that are set once, to a number.
    (
        "from openmm import *\nfrom openmm.unit import *\ndt = 2*femtoseconds\nintegrator = MTSIntegrator(dt, [(0,4),(1,1)])\n",
        "0.5,2",
    ),
    (
        "from openmm import *\nfrom openmm.unit import *\nstep = 4 # in fs\ninner = 8\ngroups = [(0, 1), (1, inner)]\nintegrator = MTSLangevinIntegrator(300*kelvin, 1/picosecond, step*femtoseconds, groups)\n",
        "0.5,4",
    ),
    (
        "from openmm import *\nfrom openmm.unit import *\nn = 4\nintegrator = MTSIntegrator(n*0.5*femtoseconds, [(1,1), (0,n)])\n",
        "0.5,2",
    ),
    (
        "from openmm import *\nfrom openmm.unit import *\nstep = (0.004)*picosecond\nintegrator = VerletIntegrator(step/picosecond)\n",
        "4",
    ),
    (
        "from openmm import *\nfrom openmm.unit import *\nintegrator = VerletIntegrator(3/2*femtoseconds)\n",
        "1.5",
    ),
];

#[test]
fn steps_are_those_of_the_integrators_that_openmm_makes() {
    all_have_their_steps(Engine::OpenMm, &SCRIPTS);
}

#[test]
fn a_name_is_rewritten_where_it_is_set() {
    let reading = of(SCRIPTS[12].0).unwrap();
    assert_eq!(reading.used, ["MTSIntegrator(dt, [(0,4),(1,1)])", "dt = 2*femtoseconds"]);
    let expected = SCRIPTS[12].0.replace("2*femto", "3*femto").replace("(0,4)", "(0,6)");
    assert_eq!(reading.rewritten(&ratio(3, 1)).unwrap(), expected);
    // n stands for two things here.
    assert!(of(SCRIPTS[14].0).unwrap().rewritten(&ratio(3, 1)).is_err());
}

#[test]
fn what_openmm_refuses_or_cannot_be_read_is_refused() {
    let script = |line: &str| format!("from openmm import *\nfrom openmm.unit import *\n{line}\n");
    let mts = |groups: &str| script(&format!("i = MTSIntegrator(4*femtoseconds, {groups})"));
    all_are_refused(&[
        // OpenMM: ValueError.
        (&mts("[(2,2), (1,3), (0,6)]"), "groups", "OpenMM refuses this: 3 is no multiple of 2"),
        (&mts("[]"), "groups", "at least one"),
        (&mts("[(32,1)]"), "groups", "from 0 to 31"),
        // It takes this, and kicks with the group by both rules.
        (&mts("[(0,1), (0,2)]"), "groups", "listed twice"),
        (&mts("[(g, 1) for g in range(3)]"), "groups", "(group, evaluations"),
        (&mts("make_groups()"), "groups", "is not followed"),
        (&script("i = VariableVerletIntegrator(0.001)"), "integrator", "--steps"),
        (&script("i = BrownianIntegrator(300, 1, 0.002)"), "integrator", "--steps"),
        (&script("i = CustomIntegrator(0.002)"), "integrator", "--steps"),
        (
            &script("i = CompoundIntegrator()\ni.addIntegrator(VerletIntegrator(0.002))"),
            "integrator",
            "CompoundIntegrator",
        ),
        (
            &script(
                "i = LangevinIntegrator(temperature=300, timestep=2*femtoseconds, splitting='V0 V1 R O R V1 V0')",
            ),
            "integrator",
            "--steps",
        ),
        (&script("for dt in [1*femtoseconds]:\n  i = VerletIntegrator(dt)"), "dt", "names that are set once"),
        (
            &script("dt = 2\nif fast:\n  dt = 4\ni = VerletIntegrator(dt*femtoseconds)"),
            "dt",
            "names that are set once",
        ),
        (&script("def run(dt=0.002):\n  i = VerletIntegrator(dt)"), "dt", "names that are set once"),
        (&script("dt = dt * 2\ni = VerletIntegrator(dt)"), "dt", "names that are set once"),
        (&script("i = VerletIntegrator(float(argv[1])*femtoseconds)"), "dt", "names that are set once"),
        (&script("i = VerletIntegrator(2*femtoseconds**2)"), "dt", "names that are set once"),
        (&script("i = VerletIntegrator(0.001)\ni.setStepSize(0.004)"), "dt", "setStepSize(0.004)"),
        (&script("i = VerletIntegrator()"), "VerletIntegrator", "write VerletIntegrator(4*femtoseconds)"),
        (
            &script("a = VerletIntegrator(0.001)\nb = VerletIntegrator(0.002)"),
            "integrator",
            "different steps",
        ),
        ("import openmm\n", "integrator", "makes no integrator"),
        ("x = 1.0\ndt = 0.1\ny = x + dt\n", "engine", "no engine"),
        // Another library's.
        ("i = VerletIntegrator(0.001)\n", "engine", "no engine"),
    ]);
}

#[test]
fn a_listed_group_without_a_force_is_an_error_where_the_forces_are_known() {
    let run = |more: &str| {
        format!(
            "system = ff.createSystem(top, rigidWater=False)\n{more}i = MTSIntegrator(4*femtoseconds, [(0,1),(1,8)])\n"
        )
    };
    all_are_refused(&[
        (&run(""), "force groups", "group 1 has no force"),
        (&run("system.getForce(0).setForceGroup(0)\n"), "force groups", "group 1 has no force"),
        (
            &run("f.setForceGroup(1)\ng.setForceGroup(2)\n"),
            "force groups",
            "group 2 would never be integrated",
        ),
    ]);
    assert!(of(&run("f.setForceGroup(1)\n")).unwrap().remarks.is_empty());
    // Where they are not: a remark.
    for (more, words) in [
        ("f.setForceGroup(k)\n", "by variables"),
        ("setGroupsOf(f)\ntools.set_force_group(f)\n", "by variables"),
    ] {
        assert!(of(&run(more)).unwrap().remarks[0].contains(words), "{more}");
    }
    let alone = of("i = MTSIntegrator(4*femtoseconds, [(1,1),(2,8)])\n").unwrap();
    assert!(
        alone.remarks[0].contains("all are in group 0") && alone.remarks[1].contains("group 0 is not listed"),
        "{:?}",
        alone.remarks
    );
}

#[test]
fn bonds_that_are_held_and_heavy_hydrogens_are_read() {
    let text = "system = prmtop.createSystem(constraints=HBonds, hydrogenMass=3.024*amu)\nnonbonded.setReciprocalSpaceForceGroup(1)\n\
                integrator = MTSLangevinIntegrator(310*kelvin, 1/picosecond, 6*femtoseconds, [(1,1), (0,2)])\n";
    let reading = of(text).unwrap();
    assert_eq!((steps(&reading).as_str(), reading.constraints.clone()), ("3,6", Some(Constraints::HBonds)));
    assert_eq!(reading.used[1..], ["constraints=HBonds", "hydrogenMass=3.024"]);
    assert_eq!(reading.hydrogen, Some(ratio(378, 125)));
    // As OpenMM Setup writes it.
    let setup = "from openmm.app import *\nconstraints = HBonds\nhydrogenMass = 1.5*amu\ndt = 0.004*picoseconds\n\
                 system = ff.createSystem(top, constraints=constraints, rigidWater=True, hydrogenMass=hydrogenMass)\n\
                 integrator = LangevinMiddleIntegrator(300*kelvin, 1/picosecond, dt)\n";
    let reading = of(setup).unwrap();
    assert_eq!((steps(&reading).as_str(), reading.constraints.clone()), ("4", Some(Constraints::HBonds)));
    assert!(reading.used.contains(&"hydrogenMass=1.5".into()));
    let other = |from: &str, to: &str| of(&setup.replace(from, to)).unwrap();
    assert_eq!(other("HBonds", "app.AllBonds").constraints, Some(Constraints::AllBonds));
    for (from, to, words) in
        [("= HBonds", "= None", "water is rigid"), ("constraints=constraints, ", "", "--constraints")]
    {
        let reading = other(from, to);
        assert!(reading.constraints.is_none() && reading.remarks.iter().any(|remark| remark.contains(words)));
    }
    let flexible =
        of(&setup.replace("= HBonds", "= None").replace("rigidWater=True", "rigidWater=False")).unwrap();
    assert!(!flexible.remarks.iter().any(|remark| remark.contains("rigid")), "{:?}", flexible.remarks);
    let groups = other("dt = 0", "i.setIntegrationForceGroups({0})\ndt = 0");
    assert!(groups.remarks.iter().any(|remark| remark.contains("never integrated")), "{:?}", groups.remarks);
    // What was not read is asked for.
    for (from, to, words) in [
        ("constraints=constraints", "**{'constraints': HBonds}", "--constraints"),
        ("= HBonds", "= pick('bonds')", "--constraints"),
        ("1.5*amu", "float(argv[1])", "--hmr"),
        ("dt = 0", "system.setParticleMass(0, 2)\nhydrogenMass = 2\ndt = 0", "--hmr"),
    ] {
        let reading = other(from, to);
        assert!(reading.remarks.iter().any(|remark| remark.contains(words)), "{to}: {:?}", reading.remarks);
    }
}

#[test]
fn long_scripts_are_read_in_proportion_to_their_length() {
    let begun = thread_time();
    let head = "from openmm import *\n";
    let last = "i = VerletIntegrator(0.001)\n";
    for (many, is_read) in [
        ("MTSIntegrator ".repeat(80_000), true),
        ("x.setForceGroup(1);".repeat(80_000), true),
        ("MTSIntegrator(".repeat(80_000), true),
        (format!("{}\n", "lambda for import ".repeat(80_000)), true),
        (format!("{}{}\n", "(".repeat(80_000), ")".repeat(80_000)), true),
        (format!("i = VerletIntegrator({}1{})\n", "(1*".repeat(80_000), ")".repeat(80_000)), false),
        (
            (0..2000).map(|n| format!("a{n} = a{}*a{}\n", n + 1, n + 1)).collect::<String>()
                + "i = VerletIntegrator(a0)\n",
            false,
        ),
        ("'".repeat(200_000) + "\n", true),
        (last.repeat(80_000), false),
    ] {
        assert_eq!(read(&[&format!("{head}{many}{last}")], None).is_ok(), is_read, "{}", &many[..20]);
    }
    // A square of 80,000 lines takes hours where nothing is optimized, these a few seconds.
    let took = thread_time() - begun;
    assert!(took.as_secs() < 120, "{took:?}");
}
