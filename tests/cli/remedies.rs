//! Every remedy that a message names works: whoever does as it says gets an answer.

use super::support::Desk;

const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes");

/// A command line as the shell takes it: words between quotes are one, and `data/` is the folder of scenes.
fn parts(line: &str) -> Vec<String> {
    let words = line.split('"').enumerate().flat_map(|(k, part)| match k % 2 {
        1 => vec![part],
        _ => part.split_whitespace().collect(),
    });
    words.map(|word| word.replace("data/", &format!("{DATA}/"))).collect()
}

/// The budget that is refused, and what else is asked.
fn with_budget(line: &str, budget: &str) -> Vec<String> {
    [parts(line), vec!["--budget".into(), budget.into()]].concat()
}

fn run(desk: &Desk, args: &[String]) -> (Option<i32>, String) {
    let ended = desk.run(&args.iter().map(String::as_str).collect::<Vec<_>>());
    (ended.code, ended.stderr)
}

#[test]
fn the_budget_that_a_message_names_is_enough() {
    let desk = Desk::new();
    for (budget, line) in [
        ("50", "verdict --lambda1 10 --lambda2 1 --h1 0.01 --h2 1.01 --exact"),
        ("100", "verdict --lambda1 1 --lambda2 1/3 --h1 1 --h2 203/201 --friction 1/10"),
        ("1500", "verdict --lambda1 1 --lambda2 1/3 --h1 1 --h2 2003 --certificate verdict.v"),
        ("1", "word \"K(1/2) D(1) K(1/2)\""),
        ("1", "half --ratio 5/3 --s 11/4 --rho 1/25"),
        ("1", "polynomial --ratio 5/3"),
        ("100", "proposition --max 5"),
        ("100", "closings --ratio 5/3 --samples 20"),
        ("10", "tongues --ratio 11/9 --rho 1"),
        ("10", "tongues --max-sum 9 --rho 1"),
        ("20", "tongues --ratio 31/29 --rho 1 --m 3 --certificate tongue.v"),
        ("0", "map --lambda1 10 --lambda2 1 --step 1/20 --h1-range 1/10..1 --h2-range 1/10..1"),
        ("10", "bands --lambda1 pi^2 --lambda2 pi^2/25 --h1-range 1/5..1/4 --h2-range 9/10..1 --sectors 100"),
        ("10", "aperture --bond OH:K=553kcal/mol/A^2,15.999,1.008 --steps 4fs"),
        ("10", "compare --max-sum 5 --rho 1 --samples 3"),
        ("10", "advise --period 10fs --period 40fs --steps 1fs,4fs"),
        ("10", "system data/three-clocks.json"),
        ("10", "system data/two-bars.json"),
        ("10", "system data/fpu.json --exact"),
        ("10", "system data/no-gradient.json"),
        ("10", "system data/membrane.json"),
        ("10", "system data/fpu.json --scan outer=1/10..1/2:1/10"),
    ] {
        let (code, message) = run(&desk, &with_budget(line, budget));
        assert_eq!(code, Some(2), "{line}: {message}");
        let (_, named) = message.split_once("--budget ").unwrap_or_else(|| panic!("{line}: {message}"));
        let needed: String = named.chars().take_while(char::is_ascii_digit).collect();
        let (code, other) = run(&desk, &with_budget(line, &needed));
        assert_eq!(code, Some(0), "{line}: {message}{other}");
    }
}

/// Doubles do not reach the end of this period, whatever they may cost: the first refusal named a budget
/// after which came another one.
#[test]
fn kicks_beyond_both_limits_name_what_exact_numbers_cost() {
    let line = "verdict --lambda1 1000 --lambda2 10 --h1 0.12345 --h2 100003";
    let (code, message) = run(&Desk::new(), &parts(line));
    assert!(code == Some(2) && message.contains("the exact tier"), "{message}");
}

/// What is typed before any help is read: each message names what to type in its place.
#[test]
fn slips_of_a_first_command_are_told_what_to_type() {
    let desk = Desk::new();
    desk.write("md.mdp", "dt = 0.002\n");
    desk.write("notes.md", "import openmm\n");
    desk.write("curves.csv", "a,b\n");
    desk.write("proof.v", "Theorem\n");
    for (line, said) in [
        (
            "advise --period OH=10fs --period 40fs --steps 0.5fs 4fs",
            "argument = 4fs: join the values of a list by commas, as --steps 0.5fs,4fs",
        ),
        ("advise --period OH=10fs slow=40fs --steps 0.5fs,4fs", "as --period OH=10fs --period slow=40fs"),
        ("advise md.mdp --period OH=10fs --steps 2fs", "file = md.mdp: stands for Hessians"),
        ("advise --period OH=10fs,slow=40fs --steps 0.5fs,4fs", "is a list: give each period by itself"),
        ("advise --bond OH:450kcal/mol/A^2,15.999,1.008 --steps 1fs", "write k=450kcal/mol/A^2 where"),
        (
            "advise --bond CH:K=340kcal/mol/A^2,12.011,1.008 --hmr 13 --steps 1fs",
            "leave its heavy atom 0.019 amu, less than a hydrogen has",
        ),
        ("advise --engine notes.md --period OH=10fs", "names OpenMM and makes no integrator"),
        ("advise --engine curves.csv --period OH=10fs", "engine = a text that begins with \"a,b\""),
        ("advise --period 10fs --steps 1fs -o a.json", "flag = -o: unknown; did you mean --output?"),
        (
            "verdict 1 1/25 1/2 3",
            "argument = 1: follows no flag: --help lists all; for example kickdrift verdict --l",
        ),
        (
            "verdict --lambda1 1 --lambda2 1/25 --h1 0.5fs --h2 3",
            "h1 = 0.5fs: has a unit, and numbers here have none",
        ),
        ("advise --period 10fs --steps 1fs --friction 1ps", "write a number such as 10/ps"),
        ("verify", "add <FILE>; for example kickdrift verify data/"),
        ("aperture", "add --bond <NAME:SHAPE,M1,M2>; for example kickdrift aperture --bond OH:"),
        ("map --lambda1 1 --lambda2 1 --color growth", "; --colour says what the colours of the figure show"),
        ("verify curves.csv", "let the command that made it write curves.json too"),
        ("verify proof.v", "proof.v: is a proof for Coq: proofs/tools/certificate.sh checks it"),
    ] {
        let (code, message) = run(&desk, &parts(line));
        assert!(code == Some(2) && message.contains(said), "{line}: no {said:?} in {message}");
    }
    let small = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/small.json");
    let ended = desk.run(&["run", small, "--output", "small.svg"]);
    assert!(
        ended.code == Some(2) && ended.stderr.contains("name a folder for them, as small"),
        "{}",
        ended.stderr
    );
    assert!(!desk.path().join("small.svg").exists());
}

/// What is refused, a part of the message, and what it says to do instead.
const REMEDIES: &[(&str, &str, &str)] = &[
    ("verdict --lambda1 1 --h1 1 --h2 1", "add --lambda2", "verdict --lambda1 1 --lambda2 1 --h1 1 --h2 1"),
    (
        "verdict --lambda1 1 --lambda2 1 --h1 1 --h2 1 --float table",
        "add --format latex",
        "verdict --lambda1 1 --lambda2 1 --h1 1 --h2 1 --float table --format latex",
    ),
    (
        "verdict --lambda1 8 --lambda2 1 --h1 1 --h2 1.000000000000000000000001 --exact",
        "simpler ratio",
        "verdict --lambda1 8 --lambda2 1 --h1 1 --h2 1.001 --exact",
    ),
    (
        "word \"K(a)D(1/2)K(1-2*a)D(1/2)K(a)\" --parameter a=0.1..0.3",
        "as a=0.1..0.3:1/100",
        "word \"K(a)D(1/2)K(1-2*a)D(1/2)K(a)\" --parameter a=0.1..0.3:1/100",
    ),
    (
        "word \"K(a)D(1/2)K(1-2*a)D(1/2)K(a)\" --parameter a=0.1:0.3:0.1",
        "write b=LO..HI:STEP",
        "word \"K(a)D(1/2)K(1-2*a)D(1/2)K(a)\" --parameter a=0.1..0.3:0.1",
    ),
    (
        "word \"K(a)D(b)K(1-2*a)D(b)K(a)\" --parameter a=0.2 --parameter b=1/2",
        "further names behind commas",
        "word \"K(a)D(b)K(1-2*a)D(b)K(a)\" --parameter a=0.2,b=1/2",
    ),
    (
        "word \"K(a)D(1/2)K(1-2*a)D(1/2)K(a)\" --parameter a=0.2 --minimize error",
        "ask about the word with these values",
        "word \"K(0.2)D(1/2)K(0.6)D(1/2)K(0.2)\"",
    ),
    (
        "word \"K(a)D(1/2)K(1-2*a)D(1/2)K(a)\" --parameter a=0.1..0.3:0.1 --minimize edge",
        "--maximize edge",
        "word \"K(a)D(1/2)K(1-2*a)D(1/2)K(a)\" --parameter a=0.1..0.3:0.1 --maximize edge",
    ),
    (
        "word --method forest-ruth --lambda1 1 --h 1 --certificate word.v",
        "write roots as decimals",
        "word \"K(0.675603595979829) D(1.351207191959658) K(-0.175603595979829) D(-1.702414383919316) K(-0.175603595979829) D(1.351207191959658) K(0.675603595979829)\" --lambda1 1 --h 1 --certificate word.v",
    ),
    (
        "word --method respa-4 --h 1",
        "add --lambda1",
        "word --method respa-4 --h 1 --lambda1 1 --lambda2 1/16",
    ),
    ("word PEFRL", "did you mean --method pefrl?", "word --method pefrl"),
    ("word --method PEFRL", "did you mean pefrl?", "word --method pefrl"),
    (
        "compare --methods pefrl,forest-ruth --by-cost",
        "add --h-range <LO..HI>",
        "compare --methods pefrl,forest-ruth --by-cost --h-range 0..4 --h-step 1",
    ),
    (
        "compare --methods pefrl forest-ruth --h-range 0..4 --h-step 1",
        "join the values of a list by commas, as --methods pefrl,forest-ruth",
        "compare --methods pefrl,forest-ruth --h-range 0..4 --h-step 1",
    ),
    (
        "compare --methods respa-4,pefrl --h-range 0..4 --h-step 1",
        "rho-range missing: two forces",
        "compare --methods respa-4,pefrl --h-range 0..4 --h-step 1 --rho-range 0..1 --rho-step 1/2",
    ),
    (
        "compare --methods respa-4,pefrl --h-range 0..4 --h-step 1",
        "or --h1-range, --h2-range and --step",
        "compare --methods respa-4,pefrl --h1-range 0..4 --h2-range 0..4 --step 1",
    ),
    (
        "system data/two-bars.json --scan courant=1/2..1:1/2",
        "did you mean mesh.courant?",
        "system data/two-bars.json --scan mesh.courant=1/2..1:1/2",
    ),
    (
        "system data/fpu.json --intervals outer=1/10..1/5:1/10",
        "without a spacing: write 1/10..1/5",
        "system data/fpu.json --intervals outer=1/10..1/5",
    ),
    (
        "tongues --ratio 5/3 --rho -1/25",
        "use `map` or `verdict`",
        "verdict --lambda1 10 --lambda2 -2/5 --h1 1 --h2 5/3",
    ),
    (
        "tongues --ratio 5/3 --rho 1 --h1-range 1..2",
        "lambda1 missing",
        "tongues --ratio 5/3 --rho 1 --h1-range 1..2 --lambda1 1",
    ),
    (
        "tongues --ratio 11/9 --rho 1 --budget 10",
        "labels by --m",
        "tongues --ratio 11/9 --rho 1 --budget 10 --m 3",
    ),
    (
        "tongues --max-sum 9 --rho 1 --budget 10",
        "--survey",
        "tongues --max-sum 9 --rho 1 --budget 10 --survey",
    ),
    (
        "tongues --max-sum 5 --rho 1 --theta pi/2",
        "--figure strength",
        "tongues --max-sum 5 --rho 1 --theta pi/2 --figure strength --output a.svg",
    ),
    (
        "tongues --max-sum 5 --rho 1 --thinnest 3",
        "--survey",
        "tongues --max-sum 5 --rho 1 --thinnest 3 --survey",
    ),
    ("tongues --ratio 5/3 --rho 1 --survey", "--max-sum N", "tongues --max-sum 5 --rho 1 --survey"),
    (
        "tongues --max-sum 5 --rho 1 --figure diagram --output a.svg",
        "--ratio P/Q,P/Q",
        "tongues --ratio 3/2,2/1 --rho 1 --figure diagram --output a.svg",
    ),
    (
        "tongues --max-sum 5 --rho 1 --figure atlas --output a.svg",
        "lambda1 missing",
        "tongues --max-sum 5 --rho 1 --figure atlas --output a.svg --lambda1 pi^2 --h1-range 0..2/pi --h2-range 0..7/2",
    ),
    (
        "tongues --ratio 5/3 --rho 1 --certificate t.v",
        "add --m",
        "tongues --ratio 5/3 --rho 1 --certificate t.v --m 3",
    ),
    ("closings --max-sum 5 --m 3", "leave --m out", "closings --max-sum 5 --samples 20"),
    (
        "map --lambda1 1 --lambda2 1 --step 1/5 --h1-range 1/5..1 --h2-range 1/5..1 --shard 1/1",
        "--resume DIR",
        "map --lambda1 1 --lambda2 1 --step 1/5 --h1-range 1/5..1 --h2-range 1/5..1 --shard 1/1 --resume parts",
    ),
    (
        "map --lambda1 1 --lambda2 1 --step 1/5 --h1-range 1/5..1 --h2-range 1/5..1 --shard 1/1 --resume parts --format csv",
        "kickdrift merge makes the rest",
        "merge parts --format csv",
    ),
    (
        "merge parts --colour growth --output a.svg",
        "--growth: compute them with it",
        "map --lambda1 1 --lambda2 1 --step 1/5 --h1-range 1/5..1 --h2-range 1/5..1 --growth --shard 1/1 --resume growing",
    ),
    (
        "map --lambda1 1 --lambda2 1 --step 1/5 --h1-range 1/5..1 --h2-range 1/5..1 --a 0..1 --output a.svg",
        "add --curves",
        "map --lambda1 1 --lambda2 1 --step 1/5 --h1-range 1/5..1 --h2-range 1/5..1 --a 0..1 --curves --output a.svg",
    ),
    ("word", "K(1/2) D(1) K(1/2)", "word \"K(1/2) D(1) K(1/2)\""),
    (
        "word --method respa-4 --lambda1 1 --h 1",
        "both stiffnesses",
        "word --method respa-4 --lambda1 1 --lambda2 1/9 --h 1",
    ),
    (
        "word \"K(1/2) D(1) K(1/2)\" --certificate w.v",
        "--lambda1 and --h",
        "word \"K(1/2) D(1) K(1/2)\" --certificate w.v --lambda1 1 --h 1",
    ),
    (
        "system data/fpu.json --resolution 1e-2",
        "--intervals PATH=LO..HI",
        "system data/fpu.json --resolution 1e-2 --intervals outer=1/10..1/2",
    ),
    (
        "system data/fpu.json --resolution 1e-2",
        "--nearest",
        "system data/fpu.json --resolution 1e-2 --nearest",
    ),
    (
        "system data/diatomic-tether.json --colour growth",
        "--scan twice",
        "system data/diatomic-tether.json --colour growth --scan potentials.0.step=1/10..1:1/2 --scan potentials.1.step=1/10..1:1/2 --output a.svg",
    ),
    ("system data/small.json", "kickdrift run FILE", "run data/small.json --output small"),
    ("run data/fpu.json", "kickdrift system FILE", "system data/fpu.json"),
    ("verify data/fpu.json", "kickdrift system FILE", "system data/fpu.json"),
    (
        "system data/membrane.json --intervals outer=1/10..1",
        "--scan the steps",
        "system data/membrane.json --scan outer=1/10..1:1/2",
    ),
    (
        "system data/no-gradient.json --intervals outer=1/10..1",
        "--scan outer=LO..HI:BY",
        "system data/no-gradient.json --scan outer=1/10..1:1/2",
    ),
    (
        "system data/edge-pi.json --nearest",
        "--scan outer=LO..HI:BY",
        "system data/edge-pi.json --scan outer=1/10..1:1/2",
    ),
    (
        "simulate data/fpu.json --budget 100000",
        "fewer periods",
        "simulate data/fpu.json --budget 100000 --periods 1",
    ),
    ("advise data/fpu.json", "`kickdrift system` takes numbers", "system data/fpu.json"),
    ("advise data/membrane.json --steps 1fs,2fs", "`kickdrift system FILE`", "system data/membrane.json"),
];

#[test]
fn whoever_does_as_a_message_says_gets_an_answer() {
    let desk = Desk::new();
    for (wrong, part, right) in REMEDIES {
        let (code, message) = run(&desk, &parts(wrong));
        assert!(code == Some(2) && message.contains(part), "{wrong}: {message}");
        let (code, other) = run(&desk, &parts(right));
        assert_eq!(code, Some(0), "{wrong}: {message}{right}: {other}");
    }
}
