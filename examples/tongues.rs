//! Every unstable interval of one ratio of steps, its fastest growth, and the widest tongue of many ratios.
//!
//! `cargo run --release --example tongues`

use kickdrift::error::Result;
use kickdrift::number::Ratio;
use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::tongue::{
    Listing, Request, Search, Selection, StepWindow, Stiffness, Tongues, Wanted, closings,
};

fn main() -> Result<()> {
    // h2/h1 = 5/3 and lambda2 = lambda1/25; s = h1^2 lambda1.
    let tongues = Tongues::new("5/3".parse()?, &ratio(1, 25))?;
    for gap in tongues.below(4)? {
        let Some(upper) = gap.upper else { continue };
        let growth = tongues.peak(&gap)?.map_or(0.0, |peak| peak.ln_multiplier);
        println!(
            "m = {}: s from {} to {}, the amplitude grows by e^{growth:.3} per period",
            gap.m, gap.lower.hi, upper.lo
        );
    }

    // One edge to thirty digits: an interval with rational ends.
    let edge = tongues.gap(4)?.lower;
    let precise = tongues.refine(&edge, 30)?;
    println!("m = 4 begins at {}, known to within {:.0e}", edge.lo, to_f64(&precise.width()));

    // Where that tongue closes: a resonance that does not destabilize.
    let found = closings("5/3".parse()?, &Search { m: Some(4), ..Search::default() })?;
    let (s, rho) = found.closings[0].exact.as_ref().expect("a rational closing");
    println!("it closes at s = {s}, rho = {rho}");

    // The widest of all tongues that begin below s = 4, of all ratios with p + q <= 20.
    let stiffness = Stiffness::new(Some(ratio(1, 25)), None, None)?;
    let request = Request { wanted: Wanted { family: true, ..Wanted::default() }, ..Request::default() };
    let ratios = Ratio::up_to(20).collect();
    let question = Listing::new(ratios, stiffness, StepWindow::default(), Selection::below(4.0), request)?;
    let mut widest: Option<(f64, Ratio, u64)> = None;
    question.each(&(), |tongues| {
        for tongue in tongues.iter().filter(|tongue| tongue.upper.is_some()) {
            let (width, gap) = (tongue.row.gap.width.1, &tongue.row.gap);
            if widest.is_none_or(|(most, ..)| width > most) {
                widest = Some((width, tongue.row.ratio, gap.m));
            }
        }
        Ok(())
    })?;
    let (width, ratio, m) = widest.expect("there are tongues");
    println!("the widest with p + q <= 20 is tongue {m} of {ratio}: {width:.3} in s");
    Ok(())
}
