//! An integrator as a word: its orders, its longest stable step, and what a swapped pair of coefficients
//! costs.
//!
//! `cargo run --release --example word`

use kickdrift::error::Result;
use kickdrift::word::{Forces, Stability, Word, method};

fn main() -> Result<()> {
    let published = method("ruth-3")?.word();
    let swapped: Word = "K(3/4) D(2/3) K(7/24) D(-2/3) K(-1/24) D(1)".parse()?;
    for word in [published, swapped] {
        println!("{word}");
        println!("  order {} on oscillators", word.order().order);
        if let Ok(orders) = word.general_order() {
            println!(
                "  order {} on all problems, {} with quadratic kinetic energy",
                orders.general.order, orders.nystrom.order
            );
        }
        let stability = Stability::of(&word.polynomials(&Forces::one()));
        match stability.first_edge() {
            Some(edge) => println!("  stable until (omega h)^2 is in {:?}", edge.s().to_f64_enclosure()),
            None => println!("  no stable interval ends"),
        }
    }
    Ok(())
}
