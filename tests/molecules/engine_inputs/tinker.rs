//! Tinker 8 and 26, Tinker-HP 1.2 and its version for GPUs, by the rules of their `mdinit`. Each run is
//! started with 3 fs.

use super::{all_are_refused, all_have_their_steps, of};
use kickdrift::advise::Constraints;
use kickdrift::advise::engine::Engine;

#[test]
fn steps_are_those_that_tinker_takes() {
    all_have_their_steps(
        Engine::Tinker,
        &[
            ("parameters amoeba\nintegrator verlet\n", "3"),
            ("parameters amoeba\nINTEGRATOR BEEMAN\n", "3"),
            ("parameters amoeba\nintegrator nose-hoover\nverbose\n", "3"),
            ("parameters amoeba\nintegrator stochastic\n", "3"),
            // Tinker 8: int(3/(0.25 + 1e-5)) + 1 = 12 steps of 0.25 fs; 0.4 gives 8 of 0.375.
            ("parameters amoeba\nintegrator respa\nrespa-inner 0.25\n", "0.25,3"),
            ("parameters amoeba\nintegrator RESPA\nRESPA-INNER 0.4\n", "0.375,3"),
            ("parameters amoeba\nintegrator respa\nrespa-inner 1.0\n", "1,3"),
            ("parameters amoeba\nintegrator respa\nrespa-inner 3.0\n", "3"),
            // Tinker 26: so many inner steps, by default nint(3/0.5).
            ("parameters amoeba\nintegrator vrespa\nrespa-inner 4\n", "0.75,3"),
            ("parameters amoeba\nintegrator brespa\n", "0.5,3"),
            ("parameters amoeba\nintegrator srespa # stochastic\nrespa-inner 12\n", "0.25,3"),
        ],
    );
}

#[test]
fn steps_are_those_that_tinker_hp_takes() {
    all_have_their_steps(
        Engine::TinkerHp,
        &[
            ("parameters a.prm\nintegrator respa\ndshort 0.0005\n", "0.5,3"),
            ("parameters a.prm\nintegrator baoabrespa\ndshort 0.001\n", "1,3"),
            ("parameters a.prm\nintegrator respa\nDSHORT 0.5e-3\n", "0.5,3"),
            ("parameters a.prm\nintegrator respa1\ndshort 0.0002\ndinter 0.001\n", "0.2,1,3"),
            ("parameters a.prm\nintegrator baoabrespa1\ndshort 0.25d-3\ndinter 0.0015\n", "0.25,1.5,3"),
            // Its defaults: 2 fs gives two steps of 1.5 fs, and eight of 0.25 fs in 2 fs.
            ("parameters a.prm\nintegrator respa1\npolar-alg 1\n", "0.1875,1.5,3"),
            ("parameters a.prm\nintegrator verlet\npolar-alg 1\n", "3"),
            ("parameters a.prm\nintegrator baoab\nnlupdate 10\n", "3"),
            ("parameters a.prm\nintegrator bbk\n", "3"),
            // A middle step as long as the outer one.
            ("parameters a.prm\nintegrator respa1\ndshort 0.001\ndinter 0.003\n", "1,3"),
            ("parameters a.prm\nintegrator verlet\ndshort 0.0005\n", "3"),
        ],
    );
}

#[test]
fn what_versions_read_differently_is_asked_for() {
    all_are_refused(&[
        ("integrator respa\n", "RESPA-INNER", "its default differs"),
        ("integrator respa\nrespa-inner 8\n", "RESPA-INNER", "8 inner steps in Tinker 26"),
        ("integrator baoabrespa\n", "DSHORT", "0.001 ps in its version for GPUs"),
        ("integrator respa\npolar-alg 1\n", "DSHORT", "write it"),
        ("integrator respa\nrespa-inner 0.25\ndshort 0.0005\n", "key file", "Tinker-HP"),
        ("parameters a\nintegrator vrespa\nrespa-inner 0.25\n", "RESPA-INNER", "0.25"),
        ("integrator rigidbody\n", "integrator", "RIGIDBODY"),
        ("integrator ghmc\n", "integrator", "GHMC"),
        ("integrator respa1\ndshort x\n", "DSHORT", "x"),
    ]);
}

#[test]
fn the_remedies_that_are_named_work() {
    let forces = |text: &str| of(text).unwrap().forces.len();
    for text in [
        "integrator respa\nRESPA-INNER 0.25\n",
        "INTEGRATOR BRESPA\n",
        "integrator respa\nDSHORT 0.00025\n",
        "integrator respa\nrespa-inner 2.0\n",
    ] {
        assert_eq!(forces(text), 2, "{text}");
    }
}

#[test]
fn bonds_that_are_held_are_read_and_heavy_hydrogens_asked_for() {
    let with = |more: &str| of(&format!("integrator verlet\n{more}\n")).unwrap();
    for (more, held) in [
        ("rattle", Some(Constraints::HBonds)),
        ("RATTLE BONDS", Some(Constraints::AllBonds)),
        ("freeze angles", Some(Constraints::AllBonds)),
        ("rattle water", None),
        ("#rattle", None),
    ] {
        assert_eq!(with(more).constraints, held, "{more}");
    }
    for (more, words) in [
        ("rattle water", "RATTLE WATER holds some bonds"),
        ("heavy-hydrogen", "up to 4 amu"),
        ("heavy-hydrogen 3.0", "up to 3 amu"),
        ("nbeads 32", "32 beads"),
    ] {
        assert!(with(more).remarks.iter().any(|remark| remark.contains(words)), "{more}");
    }
}
