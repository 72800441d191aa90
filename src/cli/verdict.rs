//! `kickdrift verdict`: is this pair stable?

use std::path::{Path, PathBuf};

use super::args::{Columns, Common};
use clocks::propagator::Oscillator;
use clocks::schedule::Schedule;
use clocks::verdict::Verdict;
use documents::format::Format;
use documents::question::{self, Question};
use documents::report::certificate;
use documents::report::file::write_output;
use number::{Error, Laurent, Result, rational};

/// Flags of `verdict`.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    question: question::Verdict,
    /// Read the steps as doubles: each as the simplest number that rounds to it (0.3333333333333333 is 1/3).
    #[arg(long)]
    simplest: bool,
    /// Also write a Coq proof of the verdict (fractions times powers of pi); proofs/tools/certificate.sh
    /// checks it.
    #[arg(long, value_name = "FILE.v")]
    certificate: Option<PathBuf>,
    /// Exit with 0 if stable, 1 if unstable; with --quiet and without --output that is all the answer.
    #[arg(long)]
    exit_code: bool,
    #[command(flatten)]
    columns: Columns,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<u8> {
        self.certificate.as_ref().map_or(Ok(()), |path| common.apart_from_output("certificate", path))?;
        let verdict = self.answer(common)?;
        Ok(u8::from(self.exit_code && !verdict.is_stable()))
    }

    /// The verdict; the rest of the answer is computed only where it is shown.
    fn answer(&self, common: &Common) -> Result<Verdict> {
        let [h1, h2] = [&self.question.h1, &self.question.h2].map(|step| self.step(step));
        let asked = question::Verdict { h1, h2, ..self.question.clone() };
        let oscillator = asked.oscillator()?;
        if self.exit_code && common.quiet && common.output.is_none() {
            let verdict = asked.decision(&oscillator, &common.work())?.verdict;
            return self.certified(&oscillator, verdict, common);
        }
        let answer = asked.answer(&common.work())?;
        let verdict = self.certified(&oscillator, answer.decision.verdict, common)?;
        common.write(&self.columns.of(asked.document(&answer))?, Format::Text)?;
        Ok(verdict)
    }

    /// A step as given, or the simplest number that its double stands for; powers of π stand for themselves.
    fn step(&self, given: &Laurent) -> Laurent {
        let rounded = given.as_rational().filter(|_| self.simplest).map(|exact| rational::to_f64(&exact));
        rounded.and_then(rational::simplest_beside).map_or_else(|| given.clone(), Laurent::from_rational)
    }

    /// The verdict, its proof written where that is asked for.
    fn certified(&self, oscillator: &Oscillator, verdict: Verdict, common: &Common) -> Result<Verdict> {
        if let Some(path) = &self.certificate {
            certify(oscillator, verdict, path, common.budget)?;
            common.wrote(path.display());
        }
        Ok(verdict)
    }
}

/// Checking a certificate costs Coq some 2 s at 400 kicks, in exact numbers; by intervals, where 128 bits do,
/// 20 s at 5,000.
const WORTH_CERTIFYING: u64 = 5000;
/// A tongue's edges are doubles, so exact numbers gain 53 bits at every kick: Coq takes some 20 s at 300
/// kicks, and the square of that.
pub const EDGES_WORTH_CERTIFYING: u64 = 1000;

/// That a certificate of so many kicks, `most` if no budget is given, is worth its while.
pub fn within(kicks: u64, most: u64, budget: Option<u64>) -> Result<()> {
    if kicks <= budget.unwrap_or(most) {
        return Ok(());
    }
    Err(Error::budget(format!("Coq would need minutes to check a certificate of {kicks} kicks"), kicks))
}

fn certify(oscillator: &Oscillator, verdict: Verdict, path: &Path, budget: Option<u64>) -> Result<()> {
    let ratio = oscillator.clocks()?.ratio();
    within(ratio.kicks(), WORTH_CERTIFYING, budget)?;
    Schedule::two_clocks(ratio)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let text = certificate::coq(oscillator, verdict, &name)?;
    write_output(Some(path), text.as_bytes())
}
