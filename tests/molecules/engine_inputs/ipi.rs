//! i-PI: `Dynamics` nests `nmts`, level 0 outermost, half a step of each level around those below
//! (`ipi/engine/motion/dynamics.py`).

use super::{all_are_refused, all_have_their_steps, of, steps, thread_time};
use kickdrift::advise::engine::Engine;
use kickdrift::number::rational::ratio;

/// A file with this inside of `<system>`, and this inside of `<dynamics>`.
macro_rules! file {
    ($mode:literal, $system:literal, $dynamics:literal) => {
        concat!(
            "<?xml version='1.0'?>\n<simulation verbosity='medium'>\n  <total_steps>1000</total_steps>\n  <ffsocket name='driver' mode='unix'/>\n",
            "  <system>\n    ", $system, "\n    <motion mode='dynamics'>\n      <dynamics mode='", $mode, "'>\n        ", $dynamics,
            "\n      </dynamics>\n    </motion>\n  </system>\n</simulation>\n"
        )
    };
}

const PLAIN: &str = file!("nve", "", "<timestep units='femtosecond'> 0.5 </timestep>");

const SPLIT: &str = concat!(
    "<forces><force forcefield='bonds'><mts_weights>[0,1]</mts_weights></force>",
    "<force forcefield='rest'><mts_weights>[1.0, 0.0]</mts_weights></force></forces>"
);

#[test]
fn steps_are_those_that_ipi_takes() {
    let split = |dynamics: &str| {
        PLAIN
            .replace("<system>\n", &format!("<system>\n{SPLIT}"))
            .replace("<timestep units='femtosecond'> 0.5 </timestep>", dynamics)
    };
    let idle =
        split("<timestep units='femtosecond'>4</timestep><nmts>[1,8]</nmts>").replace("[0,1]", "[1,0]");
    let texts = [
        (PLAIN, "0.5"),
        (
            file!(
                "nvt",
                "",
                "<timestep units='picosecond'>5e-4</timestep><thermostat mode='langevin'><tau units='femtosecond'>100</tau></thermostat>"
            ),
            "0.5",
        ),
        (
            file!("npt", "", "<barostat mode='isotropic'/><timestep units='attosecond'> 250 </timestep>"),
            "0.25",
        ),
        (file!("nst", "", "<timestep units='second'>1e-15</timestep>"), "1"),
        // 1 atomic unit is 2.4188843265857e-17 s, 1 of ASE's 1.01805057e-14 s.
        (file!("nve", "", "<timestep>20</timestep>"), "24188843265857/50000000000000"),
        (file!("nve", "", "<timestep units='atomic_unit'>10</timestep>"), "24188843265857/100000000000000"),
        (file!("nvt", "", "<timestep units='ase'> 0.05 </timestep>"), "0.509025285"),
        (
            file!(
                "nvt",
                "",
                "<!-- fs --><timestep units='femtosecond'><!-- small --> 2.0 </timestep><nmts> [1, 4] </nmts>"
            ),
            "0.5,2",
        ),
        (file!("nvt", "", "<timestep units='femtosecond'>6</timestep><nmts>[3,2]</nmts>"), "1,2"),
        // Of one level, four times in a step.
        (file!("nvt", "", "<timestep units='femtosecond'>2</timestep><nmts>[4]</nmts>"), "0.5"),
        // The steps of rings are another number.
        (
            file!(
                "nvt",
                "<normal_modes propagator='bab'><nmts> 10 </nmts></normal_modes>",
                "<timestep units='femtosecond'> 1.0 </timestep>"
            ),
            "1",
        ),
        (
            file!(
                "nvt",
                "<normal_modes propagator='bab'><nmts> 10 </nmts></normal_modes>",
                "<timestep units='femtosecond'> 2.0 </timestep><nmts> [1,4] </nmts>"
            ),
            "0.5,2",
        ),
        (&split("<timestep units='femtosecond'>4</timestep><nmts>[1,8]</nmts>"), "0.5,4"),
        // A level without a force is no clock.
        (&idle, "4"),
    ];
    all_have_their_steps(Engine::Ipi, &texts);
    assert!(of(&idle).unwrap().remarks[0].contains("no force on level 1"));
}

/// i-PI reads its step by `float()`.
#[test]
fn a_step_without_an_end_is_rewritten_as_a_shorter_decimal() {
    let text = file!("nve", "", "<timestep units='femtosecond'> 2.0 </timestep><nmts> [1,7] </nmts>");
    let reading = of(text).unwrap();
    assert_eq!(steps(&reading), "2/7,2");
    let new = reading.rewritten(&ratio(22, 7)).unwrap();
    assert!(new.contains("> 3.14285 <") && new.contains("[1,11]"), "{new}");
    let again = of(&new).unwrap();
    assert!(again.scheme.outer() <= &ratio(22, 7) && again.scheme.inner() <= reading.scheme.inner());
}

#[test]
fn what_ipi_refuses_or_is_no_such_scheme_is_refused() {
    let split = |list: &str| {
        PLAIN
            .replace("<system>\n", &format!("<system>\n{SPLIT}"))
            .replace("</timestep>", &format!("</timestep>{list}"))
    };
    all_are_refused(&[
        (&PLAIN.replace("nve", "sc"), "dynamics mode", "no scheme"),
        (&PLAIN.replace("nve", "nvt-cc"), "dynamics mode", "no scheme"),
        (&PLAIN.replace("'dynamics'", "'minimize'"), "motion", "minimize"),
        (&PLAIN.replace("'dynamics'", "'driven_dynamics'"), "motion", "driven_dynamics"),
        (&PLAIN.replace("femtosecond", "fs"), "timestep units", "femtosecond"),
        (&PLAIN.replace("0.5", "DT"), "timestep", "DT"),
        (&PLAIN.replace("0.5", "0.5<!-- or -->1"), "timestep", "comment"),
        (&PLAIN.replace("timestep", "time_step"), "timestep", "missing"),
        // Two levels of forces and one, or three, of iterations.
        (&split(""), "mts_weights", "i-PI refuses this"),
        (&split("<nmts>[1,2,2]</nmts>"), "mts_weights", "i-PI refuses this"),
        (&split("<nmts>[1,two]</nmts>"), "nmts", "two"),
        ("<simulation><output/></simulation>", "motion", "no <motion>"),
        ("<topology><system/></topology>", "engine", "<topology>"),
    ]);
}

#[test]
fn motions_of_different_steps_are_refused_and_of_equal_ones_rewritten_together() {
    let motion = &PLAIN[PLAIN.find("<motion").unwrap()..PLAIN.find("</system>").unwrap()];
    let two = PLAIN
        .replace(motion, &format!("<motion mode='multi'>{motion}{motion}<motion mode='atomswap'/></motion>"));
    let reading = of(&two).unwrap();
    assert_eq!((steps(&reading).as_str(), &reading.remarks[0][..]), ("0.5", "not read: motion atomswap"));
    assert_eq!(reading.rewritten(&ratio(1, 4)).unwrap().matches("> 0.25 <").count(), 2);
    let error = of(&two.replacen("0.5", "0.25", 1)).unwrap_err();
    assert!(error.field() == "dynamics" && error.to_string().contains("different steps"), "{error}");
}

/// n beads at T: omega_n = n k T/hbar, and the fastest mode of a ring has 2 omega_n sin(pi
/// floor(n/2)/n): 2.4996 fs of 32 at 300 K.
#[test]
fn modes_of_rings_are_named_with_their_fastest_period() {
    let beads =
        |system: &str| PLAIN.replace("<system>\n", &format!("<system><initialize nbeads='32'/>{system}"));
    let hot = "<ensemble><temperature units='kelvin'> 300 </temperature></ensemble>";
    for (text, words) in [
        (beads(hot), ["32 beads", "down to 2.500 fs at 300 K", "exact resonates"]),
        (
            beads(&format!("{hot}<normal_modes propagator='cayley'/>")),
            ["32 beads", "2.500 fs", "cayley is stable"],
        ),
        (
            beads(&format!("{hot}<normal_modes propagator='bab'><nmts>5</nmts></normal_modes>")),
            ["32 beads", "2.500 fs", "5 times"],
        ),
        // Other frequencies, or no temperature: no period is claimed.
        (
            beads(&format!(
                "{hot}<normal_modes><frequencies style='pa-cmd'>[1]</frequencies></normal_modes>"
            )),
            ["32 beads", "rings vibrate", "exact"],
        ),
        (beads(""), ["32 beads", "rings vibrate", "exact"]),
    ] {
        let remark = &of(&text).unwrap().remarks[0];
        assert!(words.iter().all(|word| remark.contains(word)), "{text}: {remark}");
    }
    assert!(of(&PLAIN.replace("<system>\n", "<system><initialize nbeads='1'/>")).unwrap().remarks.is_empty());
}

#[test]
fn xml_is_read_behind_a_byte_order_mark_and_refused_with_its_reason() {
    assert_eq!(steps(&of(&format!("\u{feff}{PLAIN}")).unwrap()), "0.5");
    all_are_refused(&[
        (&PLAIN.replace("</system>", "</sistem>"), "engine", "expected 'system' tag, not 'sistem'"),
        (&PLAIN.replace("verbosity=", "verbosity"), "engine", "cannot be read"),
        (&PLAIN.replace(" 0.5 ", " &dt; "), "engine", "dt"),
    ]);
}

#[test]
fn what_would_take_the_square_of_its_length_is_refused_at_once() {
    let begun = thread_time();
    let attributes: String = (0..60_000).map(|n| format!(" a{n}='1'")).collect();
    let deep = |n: usize| {
        format!("<simulation>{}<!-- </a></a> -->{}</simulation>", "<a>".repeat(n), "</a>".repeat(n))
    };
    all_are_refused(&[
        (&"<".repeat(400_000), "engine", "cannot be read"),
        (&format!("<simulation{attributes}/>"), "engine", "attributes"),
        (&format!("<simulation>{}", "<!-- ".repeat(400_000)), "engine", "cannot be read"),
        (&deep(300), "engine", "nested too deeply"),
        // Closing tags in a comment close nothing; brackets in quotes and comments open nothing.
        (&format!("<simulation>{}", "<a><!-- </a> -->".repeat(300)), "engine", "nested too deeply"),
        (
            &format!("<simulation a='{}'><!-- {} --></simulation>", ">".repeat(300), "<a>".repeat(300)),
            "motion",
            "no <motion>",
        ),
    ]);
    // A square of 400,000 brackets takes far longer; all of these take a second where nothing is optimized.
    let took = thread_time() - begun;
    assert!(took.as_secs() < 120, "{took:?}");
}
