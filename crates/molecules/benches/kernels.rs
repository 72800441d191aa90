//! One kernel by name, a fixed piece of work on one thread, for counting instructions:
//!
//!     tests/bench/instructions.sh
//!
//! `cargo bench --bench kernels` lists the names; a second argument (`portable`, `avx2`, `avx512`) forces
//! that form.

use kickdrift_molecules::aperture::{Bond, Measurement};
use kickdrift_molecules::clocks::map::{Grid, Map, Pairs, Products, Resources};
use kickdrift_molecules::clocks::propagator::TwoClocks;
use kickdrift_molecules::clocks::tongue::Tongues;
use kickdrift_molecules::clocks::verdict::{Limits, Tier, decide_from};
use kickdrift_molecules::number::parse::parse;
use kickdrift_molecules::number::rational::ratio;
use kickdrift_molecules::number::vector::instructions::force_instructions;
use kickdrift_molecules::number::{Laurent, Ratio};

/// A name, and the work.
const KERNELS: [(&str, fn()); 12] = [
    ("start", || ()),
    ("short", || tier(Tier::Filter, 21, 19, 1000)),
    ("filter", || tier(Tier::Filter, 17_711, 10_946, 1)),
    // Long enough for return maps.
    ("returns", || tier(Tier::Filter, 1_000_000_007, 618_033_989, 1)),
    ("refine", || tier(Tier::Refine, 619, 381, 1)),
    ("exact", || tier(Tier::Exact, 619, 381, 1)),
    ("map", || map(Products::default())),
    ("scattered", scattered),
    ("map-growth", || map(Products { label: true, growth: true })),
    ("tongues", || {
        Tongues::new("61/39".parse().unwrap(), &ratio(1, 25))
            .and_then(|tongues| tongues.all())
            .expect("a ratio");
    }),
    ("aperture", || {
        aperture("OH:poly:k2=254049kJ/mol/nm^2,k3=-5810111kJ/mol/nm^3,k4=77511731kJ/mol/nm^4,15.999,1.008");
    }),
    ("aperture-morse", || aperture("OH:morse:D=485.72kJ/mol,a=22.87/nm,15.999,1.008")),
];

/// One step of 1.8 fs, at which most phases stay: some 10^8 steps of a bond.
fn aperture(bond: &str) {
    let verlet = "K(1/2) D(1) K(1/2)".parse().expect("a word");
    let bond = Bond::read(bond).expect("a bond");
    let measurement = Measurement::new(&bond, &ratio(298, 1), &verlet, None).expect("a bond and a word");
    std::hint::black_box(measurement.at(&ratio(9, 5)).expect("nobody stops it"));
}

fn tier(first: Tier, p: u64, q: u64, times: usize) {
    let clocks = TwoClocks::with_rho(Ratio::new(p, q).unwrap(), ratio(1, 3), ratio(1, 25));
    for _ in 0..times {
        std::hint::black_box(decide_from(first, &clocks, &Limits::default()).expect("a short period"));
    }
}

fn map(products: Products) {
    // Figure 1 of the paper with steps of 1/100.
    let x = |text: &str| parse("x", text).expect("a number");
    let (h1, h2) = ((x("1/100"), x("2/pi")), (x("1/100"), x("7/2")));
    let figure_1 = Grid::new(x("pi^2"), x("pi^2/25"), [x("1/100"), x("1/100")], h1, h2).expect("a grid");
    let see = |_, band| {
        std::hint::black_box(band);
        Ok(())
    };
    let one = Resources { threads: 1, ..Resources::default() };
    Map::of(&figure_1).with(products).within(one).for_each_band(see).expect("within the budget");
}

/// Pairs on no grid, each step with a denominator of its own.
fn scattered() {
    let whole = |n| Laurent::from_rational(ratio(n, 1));
    let steps = (0..512).map(|n| [ratio(1 + n % 30, 50 + n % 41), ratio(1 + n * 7 % 160, 70 + n % 29)]);
    let pairs = Pairs::of_steps(whole(10), whole(1), steps.map(|pair| pair.map(Laurent::from_rational)));
    let one = Resources { threads: 1, ..Resources::default() };
    std::hint::black_box(pairs.and_then(|pairs| pairs.verdicts(&one)).expect("within the budget"));
}

fn main() {
    let mut words = std::env::args().skip(1).filter(|argument| !argument.starts_with("--"));
    let (name, form) = (words.next(), words.next());
    if let Some(form) = form.filter(|form| !force_instructions(form)) {
        eprintln!("this processor lacks {form}");
        std::process::exit(2);
    }
    match KERNELS.iter().find(|(kernel, _)| Some(*kernel) == name.as_deref()) {
        Some((_, work)) => work(),
        None => KERNELS.iter().for_each(|(kernel, _)| println!("{kernel}")),
    }
}
