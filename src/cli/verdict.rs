//! `kickdrift verdict`: is this pair stable?

use std::path::{Path, PathBuf};

use super::args::{Columns, Common, Stiffness, of};
use super::progress::announce;
use crate::error::{Error, Result};
use crate::format::Format;
use crate::number::parse::{parse, parse_rational};
use crate::number::{Laurent, Rational};
use crate::propagator::Oscillator;
use crate::report::certificate;
use crate::report::document::Document;
use crate::report::file::write_output;
use crate::report::verdict::Answer;
use crate::system::friction::{Friction, damped_pair};
use crate::verdict::{Tier, Verdict, decide_from};

/// Flags of `verdict`.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    stiffness: Stiffness,
    /// The fast step.
    #[arg(long, value_name = "A", allow_hyphen_values = true, value_parser = of(parse))]
    h1: Laurent,
    /// The slow step; h2/h1 must be rational.
    #[arg(long, value_name = "B", allow_hyphen_values = true, value_parser = of(parse))]
    h2: Laurent,
    /// Decide in exact arithmetic alone, and show the exact trace where it is rational.
    #[arg(long)]
    exact: bool,
    /// Also write a Coq proof of the verdict (fractions times powers of pi); proofs/tools/certificate.sh checks it.
    #[arg(long, value_name = "FILE.v")]
    certificate: Option<PathBuf>,
    /// Friction per unit time, v times exp(-G t) amid every drift between any two kicks (BAOAB): is it enough?
    #[arg(long, value_name = "G", value_parser = of(parse_rational))]
    friction: Option<Rational>,
    /// Exit with 0 if stable, 1 if unstable; with --quiet and without --output that is all the answer.
    #[arg(long)]
    exit_code: bool,
    #[command(flatten)]
    columns: Columns,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<u8> {
        self.certificate.as_ref().map_or(Ok(()), |path| common.apart_from_output("certificate", path))?;
        let Stiffness { lambda1, lambda2 } = self.stiffness.clone();
        let oscillator = Oscillator::new(lambda1, lambda2, self.h1.clone(), self.h2.clone())?;
        let stable = self.answer(&oscillator, common)?;
        Ok(u8::from(self.exit_code && !stable))
    }

    /// Whether the pair is stable; the rest of the answer is computed only where it is shown.
    fn answer(&self, oscillator: &Oscillator, common: &Common) -> Result<bool> {
        let first = if self.exact { Tier::Exact } else { Tier::Filter };
        let clocks = oscillator.clocks();
        let answer = decide_from(first, &clocks, &common.limits())?;
        let silent = self.exit_code && common.quiet && common.output.is_none();
        let document = (!silent).then(|| -> Result<Document> {
            let (decision, growth) = (answer.decision(), answer.growth()?.clone());
            let exact_trace = Answer::exact_trace(&clocks, self.exact);
            let friction = self.friction.as_ref().map(|rate| damped(oscillator, rate, common)).transpose()?;
            let answer = Answer { oscillator: oscillator.clone(), decision, growth, exact_trace, friction };
            let document = answer.document();
            Ok(if self.exact { document.input("exact", "true") } else { document })
        });
        let document = document.transpose()?;
        if let Some(path) = &self.certificate {
            certify(oscillator, answer.verdict, path, common.budget)?;
            common.wrote(path.display());
        }
        document.map_or(Ok(()), |document| common.write(&self.columns.of(document)?, Format::Text))?;
        Ok(answer.verdict.is_stable())
    }
}

/// About a microsecond a kick at each of some ten precisions.
fn damped(oscillator: &Oscillator, rate: &Rational, common: &Common) -> Result<Friction> {
    let kicks = oscillator.ratio().kicks();
    announce(common.quiet, &format!("friction over {kicks} kicks"), kicks as f64 * 1e-5);
    damped_pair(oscillator, rate, &common.limits())
}

/// Checking a certificate costs Coq some 2 s at 400 kicks, in exact numbers; by intervals, where 128 bits do, 20 s at 5,000.
const WORTH_CERTIFYING: u64 = 5000;
/// Of a tongue's edges, whose numbers gain the bits of a double at every kick: some 20 s at 300 kicks, growing with the square.
pub const EDGES_WORTH_CERTIFYING: u64 = 1000;

/// That a certificate of so many kicks, `most` if no budget is given, is worth its while.
///
/// # Errors
/// More kicks than the budget, or than Coq checks in minutes.
pub fn within(kicks: u64, most: u64, budget: Option<u64>) -> Result<()> {
    if kicks <= budget.unwrap_or(most) {
        return Ok(());
    }
    Err(Error::budget(format!("Coq would need minutes to check a certificate of {kicks} kicks"), kicks))
}

fn certify(oscillator: &Oscillator, verdict: Verdict, path: &Path, budget: Option<u64>) -> Result<()> {
    within(oscillator.ratio().kicks(), WORTH_CERTIFYING, budget)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let text = certificate::coq(oscillator, verdict, &name)?;
    write_output(Some(path), text.as_bytes())
}
