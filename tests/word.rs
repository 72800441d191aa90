//! Words: what is known of published integrators, and random words against products of the test's own.

use kickdrift::word::{Forces, Stability, Word};

fn word(text: &str) -> Word {
    text.parse().unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// The first edge of ω h in doubles that enclose it.
fn edge(text: &str) -> (f64, f64) {
    let stability = Stability::of(&word(text).polynomials(&Forces::one()));
    let edge = stability.first_edge().unwrap_or_else(|| panic!("{text} has no edge"));
    edge.s().sqrt(96).unwrap().to_f64_enclosure()
}

#[test]
fn try_them() {
    let l = "-0.2123418310626054";
    let (xi, chi) = ("0.1786178958448091", "-0.06626458266981849");
    let pefrl = |k: [&str; 4]| format!("D({xi}) K({}) D({chi}) K({}) D(1-2*({chi}+{xi})) K({}) D({chi}) K({}) D({xi})", k[0], k[1], k[2], k[3]);
    let out = format!("1-2*({l})");
    let half = format!("(1-2*({l}))/2");
    for text in [
        "K(1/2) D(1) K(1/2)".to_string(),
        "K(0.1931833275037836) D(1/2) K(1-2*0.1931833275037836) D(1/2) K(0.1931833275037836)".into(),
        "K(0.21178) D(1/2) K(1-2*0.21178) D(1/2) K(0.21178)".into(),
        "K((3-sqrt(3))/6) D(1/2) K(1-(3-sqrt(3))/3) D(1/2) K((3-sqrt(3))/6)".into(),
        "K(0.11888010966548) D(0.29619504261126) K(1/2-0.11888010966548) D(1-2*0.29619504261126) K(1/2-0.11888010966548) D(0.29619504261126) K(0.11888010966548)".into(),
        "K(1/2/(2-2^(1/3))) D(1/(2-2^(1/3))) K((1-2^(1/3))/2/(2-2^(1/3))) D(-2^(1/3)/(2-2^(1/3))) K((1-2^(1/3))/2/(2-2^(1/3))) D(1/(2-2^(1/3))) K(1/2/(2-2^(1/3)))".into(),
        pefrl([&half, l, l, &half]),
        "K(0.08398315262876693) D(0.2539785108410595) K(0.6822365335719091) D(-0.03230286765269967) K(0.5-0.08398315262876693-0.6822365335719091) D(1-2*(0.2539785108410595-0.03230286765269967)) K(0.5-0.08398315262876693-0.6822365335719091) D(-0.03230286765269967) K(0.6822365335719091) D(0.2539785108410595) K(0.08398315262876693)".into(),
        "K(1/6) D(1/2) K(2/3, -1/36) D(1/2) K(1/6)".into(),
        pefrl([l, &out, l, l]),
        pefrl([l, l, &out, l]),
        pefrl([&out, l, l, l]),
        "C(1)".into(),
    ] {
        let w = word(&text);
        let st = Stability::of(&w.polynomials(&Forces::one()));
        eprintln!("{text}\n   {w}\n   order {} sums {:?} pal {:?} cost {:?} stable0 {}", w.order().order, w.sums().iter().map(|(n, s)| format!("{n} {s}")).collect::<Vec<_>>(), w.asymmetry(), w.cost(), st.begins_stable());
        eprintln!("  freq {:?} imp {:?}", w.order().frequency.map(|(k, c)| format!("{k} {}", c)), w.order().impedance.map(|(k, c)| format!("{k} {}", c)));
        for i in &st.intervals {
            let e = |e: &Option<kickdrift::word::Edge>| e.as_ref().map(|e| (e.s().sqrt(96).unwrap().mid_f64(), e.rational().map(|r| r.to_string()), e.side, e.coexistence));
            eprintln!("    {} {:?} {:?} {:?}", i.stable, e(&i.lower), e(&i.upper), i.includes);
        }
    }
    let _ = edge;
}
