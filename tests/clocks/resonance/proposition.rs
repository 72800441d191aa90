//! Witnesses of the Proposition.

use kickdrift::number::Ratio;
use kickdrift::resonance::proposition::{Witness, witness};

#[test]
fn the_gap_in_the_papers_proof_is_closed() {
    // p = 1: the Bézout pair (1, 0) would give h2 = 0/0. θ < π leaves m = 0 only, but the identity
    // m = a p + b q holds for every m with b != 0.
    for q in 1..20 {
        for m in 1..20 {
            assert_ne!(witness(Ratio::new(1, q).unwrap(), m).b, 0);
        }
    }
}

#[test]
fn a_wrong_witness_fails() {
    let right = witness("7/3".parse().unwrap(), 4);
    assert!(!Witness { a: right.a + 1, ..right }.lies_on_its_curve());
    assert!(!Witness { m: 3, ..right }.lies_on_its_curve());
}
