//! A system from nalgebra's matrices: is it stable, what grows, and a Hessian in doubles with its margin.
//!
//! `cargo run --release --example system`

use kickdrift::error::Result;
use kickdrift::number::rational::ratio;
use kickdrift::system::levels::{Hessians, Kernel, Outer};
use kickdrift::system::{Limits, Potential, Symmetric, System, decide_system};
use nalgebra::DMatrix;

fn main() -> Result<()> {
    // Two masses of 1: a stiff bond kicks every 1/8, soft tethers every 1/2, exactly as the doubles stand.
    let bond = DMatrix::from_row_slice(2, 2, &[40.0, -40.0, -40.0, 40.0]);
    let tethers = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 0.5]);
    let potentials = vec![
        Potential::new(Symmetric::try_from(&bond)?, ratio(1, 8)),
        Potential::new(Symmetric::try_from(&tethers)?, ratio(1, 2)),
    ];
    let mass = Symmetric::diagonal(&[ratio(1, 1), ratio(1, 1)]);
    let analysis = decide_system(&System::new(mass, potentials)?, &Limits::default())?;
    println!("stable: {}, proven: {}", analysis.is_stable(), analysis.is_proof());
    for mode in analysis.parts.iter().flat_map(|part| &part.instabilities) {
        println!("grows at a rate in {:?}: {:?}", mode.growth_rate, mode.shape);
    }

    // The same as measured Hessians, known to 1e-6: how far the verdict stands.
    let kernel = Kernel::new(&Hessians::new(&bond, &tethers, 1e-6)?)?;
    let outer = Outer::new(0.4, 4)?;
    println!(
        "at an outer step of 0.4: {:?}, margin {:?}",
        kernel.verdict_within(&outer, 1e-6),
        kernel.margin(&outer)
    );
    Ok(())
}
