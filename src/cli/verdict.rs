//! `kickdrift verdict`: is this pair stable?

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::args::{Common, Stiffness};
use crate::error::{Error, Result};
use crate::format::Format;
use crate::number::Laurent;
use crate::number::parse::parse;
use crate::propagator::{Oscillator, TwoClocks};
use crate::report::certificate;
use crate::report::file::write_output;
use crate::report::verdict::Answer;
use crate::verdict::{Decidable, Limits, Tier, decide_from, growth};

/// Flags of `verdict`.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    stiffness: Stiffness,
    /// The fast step.
    #[arg(long, value_name = "A", allow_hyphen_values = true)]
    h1: String,
    /// The slow step; h2/h1 must be rational.
    #[arg(long, value_name = "B", allow_hyphen_values = true)]
    h2: String,
    /// Decide in exact arithmetic alone, and show the exact trace where it is rational.
    #[arg(long)]
    exact: bool,
    /// Also write a Coq proof of the verdict, for rational input; check it with proofs/tools/certificate.sh.
    #[arg(long, value_name = "FILE.v")]
    certificate: Option<PathBuf>,
    /// Exit with 0 if stable, 1 if unstable.
    #[arg(long)]
    exit_code: bool,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<ExitCode> {
        self.certificate.as_ref().map_or(Ok(()), |path| common.apart_from_output("certificate", path))?;
        let (lambda1, lambda2) = self.stiffness.quantities()?;
        let oscillator = Oscillator::new(lambda1, lambda2, parse("h1", &self.h1)?, parse("h2", &self.h2)?)?;
        let answer = self.answer(oscillator, &common.limits())?;
        let unstable = !answer.decision.verdict.is_stable();
        if let Some(path) = &self.certificate {
            certify(&answer, path, common.budget)?;
        }
        common.write(&answer.document(), Format::Text)?;
        Ok(ExitCode::from(u8::from(self.exit_code && unstable)))
    }

    fn answer(&self, oscillator: Oscillator, limits: &Limits) -> Result<Answer> {
        let clocks = oscillator.clocks();
        // Rational strengths make every tier cheaper, whatever the stiffnesses and steps look like.
        match clocks.as_rational() {
            Some(rational) => self.decided(oscillator, &rational, &clocks, limits),
            None => self.decided(oscillator, &clocks, &clocks, limits),
        }
    }

    fn decided<S: Decidable>(
        &self,
        oscillator: Oscillator,
        clocks: &TwoClocks<S>,
        given: &TwoClocks<Laurent>,
        limits: &Limits,
    ) -> Result<Answer> {
        let first = if self.exact { Tier::Exact } else { Tier::Filter };
        let decision = decide_from(first, clocks, limits)?;
        let growth = growth(clocks, decision.verdict, limits)?;
        let exact_trace = Answer::exact_trace(given, self.exact);
        Ok(Answer { oscillator, decision, growth, exact_trace })
    }
}

/// Checking a certificate costs Coq about (p + q)² steps: some 2 s at 400 kicks, 90 s at 4,000.
const WORTH_CERTIFYING: u64 = 5000;

fn certify(answer: &Answer, path: &Path, budget: Option<u64>) -> Result<()> {
    let clocks = answer.oscillator.clocks();
    let kicks = clocks.p().saturating_add(clocks.q());
    if kicks > budget.unwrap_or(WORTH_CERTIFYING) {
        return Err(Error::budget(
            format!("Coq would need minutes to check a certificate of {kicks} kicks"),
            kicks,
        ));
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let text = certificate::coq(&answer.oscillator, answer.decision.verdict, &name)?;
    write_output(Some(path), text.as_bytes())
}
